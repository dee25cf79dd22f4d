// Computations that last longer than a frame. A newer job ends the job before it.
let explorer;
let current = 0;

const work = {
  compare: (fields, answer) => answer(JSON.parse(explorer.compare(fields))),
  spectra: (fields, answer) => answer(JSON.parse(explorer.spectra(fields))),

  async map(fields, answer) {
    const spectrum = new wasm_bindgen.MapComputation(fields);
    let going = await answer({ axes: JSON.parse(spectrum.axes()) });
    while (going) {
      const points = spectrum.next(24);
      going = (await answer({ points })) && points.length > 0;
    }
    spectrum.free();
  },
};

onmessage = async ({ data }) => {
  if (data.module) {
    wasm_bindgen.initSync({ module: data.module });
    explorer = new wasm_bindgen.Explorer();
    explorer.take_el_centro(data.elCentro.name, data.elCentro.bytes);
  } else if (data.record) {
    explorer.take_record(data.record.name, data.record.bytes);
  } else {
    current = data.job;
    await new Promise((next) => setTimeout(next)); // a newer job may wait
    if (current !== data.job) return;
    /** Sends a part of the answer. Returns whether the page still needs the rest. */
    const answer = async (part) => {
      postMessage({ job: data.job, part });
      await new Promise((next) => setTimeout(next));
      return current === data.job;
    };
    try {
      await work[data.kind](data.fields, answer);
    } catch (problem) {
      postMessage({ job: data.job, problem: String(problem) });
    }
  }
};
