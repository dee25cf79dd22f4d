"use strict";

/** What shows motions in the elements of motion.html: `show` may be called as often as there is another one. */
function motionView() {
  const at = (id) => document.getElementById(id);

  // ---- The motion: points that straight lines join, as the engine found them

  /** What the engine wrote, with its columns as numbers. */
  function decode(data) {
    const column = ({ quantum, values }, start = 0, sum = 0) => Float64Array.from(values, (difference) => start + (sum += difference) * quantum);
    const time = column(data.time, data.start);
    const values = Object.fromEntries(data.columns.map(([name, of]) => [name, column(of)]));
    if (data.parameters.floors?.length === 1) for (const { name } of data.quantities) if (values[`${name}[1]`]) values[name] = values[`${name}[1]`]; // as of one mass
    const peaks = (list) => Object.fromEntries(list.map(([name, magnitude, instant]) => [name, { magnitude, instant }]));
    const most = (values) => values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    return {
      ...data,
      quantities: data.quantities.map((of) => ({ ...of, unit: of.unit.replace(".", " ") })),
      time,
      end: time.at(-1), // as exact as the instants of the transitions, the last of which may be there
      values,
      /** The largest magnitude of each history, that of a fall, too. */
      largest: Object.fromEntries(Object.entries(values).map(([name, values]) => [name, most(values)])),
      transitions: data.transitions.map(([sum, kind]) => ({ instant: data.start + sum * data.time.quantum, kind })),
      peaks: peaks(data.peaks),
      fixed: peaks(data.fixed),
    };
  }

  let motion; // the one that is shown
  let beside = []; // those that are drawn beside it, each with its `colour`
  let floor; // the one whose histories are shown, from 1
  const floors = () => motion.parameters.floors;
  const givesWay = () => motion.parameters.points.length > 0;
  /** The output `name`, of the floor that is shown if floors have it. */
  const own = (name) => (`${name}[${floor}]` in motion.peaks ? `${name}[${floor}]` : name);
  const peakOf = (name) => motion.peaks[own(name)];
  /** What `place` shows of the motion, in its order. */
  const shownIn = (place) => motion.quantities.filter(({ name, places }) => places.includes(place) && peakOf(name));

  /** How many of the rising numbers are at most `value`. */
  function countUpTo(numbers, value, of = (number) => number) {
    let [low, high] = [0, numbers.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (of(numbers[middle]) <= value) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Everything at the instant `t`; at a transition, just after it. */
  function stateAt(t) {
    const { time, values, phases, ending, end } = motion;
    const i = Math.max(0, countUpTo(time, t) - 1);
    const j = Math.min(i + 1, time.length - 1);
    const part = time[j] > time[i] ? (t - time[i]) / (time[j] - time[i]) : 0;
    const value = (values) => values[i] + part * (values[j] - values[i]);
    const state = Object.fromEntries(Object.entries(values).map(([name, values]) => [name, value(values)]));
    const overturned = ending === "overturned" && t >= end;
    const phase = overturned ? "overturned" : phases[countUpTo(phases, i, ([first]) => first) - 1][1];
    const read = shownIn("Numbers").map(({ name }) => [name, state[own(name)]]);
    return { ...state, ...Object.fromEntries(read), phase };
  }

  /** The peak of `name` with its sign, which the largest of the points about its `instant` has. */
  function signed(name, instant) {
    const i = countUpTo(motion.time, instant);
    const about = [...motion.values[own(name)].subarray(Math.max(0, i - 3), i + 2)];
    const largest = about.reduce((most, value) => (Math.abs(value) > Math.abs(most) ? value : most), 0);
    return Math.sign(largest) * peakOf(name).magnitude;
  }

  // ---- Numbers

  const minus = (text) => text.replace("-", "−");
  const fixed = (value, decimals) => {
    const text = value.toFixed(decimals);
    return minus(Number(text) === 0 ? text.replace("-", "") : text);
  };
  /** 10 to the power of a whole `exponent`. */
  const power = (exponent) => (exponent === 0 ? "1" : `10${[...`${exponent}`].map((digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit] ?? "⁻").join("")}`);
  /** `value` with this `count` of significant digits, very large and very small ones with a power of ten. */
  function significant(value, count = 3) {
    if (!Number.isFinite(value)) return minus(String(value).replace("Infinity", "∞"));
    const rounded = Number(value.toPrecision(count));
    const isPlain = rounded === 0 || (Math.abs(rounded) >= 1e-4 && Math.abs(rounded) < 1e6);
    const [digits, exponent] = String(isPlain ? rounded : rounded.toExponential()).split("e");
    if (isPlain) return minus(digits);
    return digits === "1" ? power(Number(exponent)) : minus(`${digits}·${power(Number(exponent))}`);
  }

  /** How many decimals show `magnitude` with as many digits as the motion is exact to. */
  function decimalsFor(magnitude) {
    const digits = -Math.round(Math.log10(motion.part));
    return magnitude > 0 ? Math.max(0, Math.min(8, digits - 1 - Math.floor(Math.log10(magnitude)))) : digits - 1;
  }

  /** [1, 2 or 5 times a power of ten] not below `step`. */
  function nice(step) {
    const power = 10 ** Math.floor(Math.log10(step));
    return [1, 2, 5, 10].find((factor) => factor * power >= step * (1 - 1e-9)) * power;
  }

  function ticks(from, to, count) {
    let step = nice((to - from) / count);
    if (from <= 0 && step > to) {
      const power = 10 ** Math.floor(Math.log10(to));
      step = Math.floor(to / power) * power; // 0 alone is no scale
    }
    const found = [];
    for (let k = Math.ceil(from / step - 1e-9); k * step <= to + 1e-9 * step; k++) found.push(k * step);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return found.map((value) => ({ value, text: fixed(value, decimals) }));
  }

  const quantity = (name) => motion.quantities.find((of) => of.name === name);
  /** `value` of the quantity `name` in its unit, in as many digits as its peak has. */
  function inUnit(name, value) {
    const { per } = quantity(name);
    return fixed(value / per, decimalsFor(peakOf(name).magnitude / per));
  }
  const withUnit = (name, value) => `${inUnit(name, value)} ${quantity(name).unit}`;
  const meaningOf = (name) => (own(name) === name ? quantity(name).label : `${quantity(name).label} of floor ${floor}`);

  // ---- Drawing by elements

  function element(parent, name, attributes = {}, text = "") {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    parent.append(made);
    return made;
  }
  const set = (of, attributes) => Object.entries(attributes).forEach(([key, value]) => of.setAttribute(key, value));

  // ---- The structure, in metres, the middle of its base at (0, 0), y down as on a screen

  let exaggerations = [1];
  let exaggeration = 1;
  let isChosen = false; // by hand; else it follows the motion

  /** The strut bent as a cantilever is by a force at its end, which a cubic holds exactly, and the block at its end. */
  function structure(parent) {
    const { H, B } = motion.parameters;
    const foundation = Math.min(0.11 * H, 0.4 * places()[0]);
    const { width, height } = block();
    parent.replaceChildren();
    const line = element(parent, "path", { class: "strut" });
    const tendon = motion.parameters.ties.some(([name]) => name === "P_t") ? element(parent, "path", { class: "tendon" }) : null;
    element(parent, "rect", { class: "mass", x: -B, y: -foundation, width: 2 * B, height: foundation });
    const masses = places().map(() => element(parent, "rect", { class: "mass", x: -width / 2, y: -height / 2, width, height }));
    if (floors()) {
      return (displacements) => {
        const along = places().map((height, i) => [displacements[i], -height]);
        for (const of of [line, tendon]) if (of) set(of, { d: `M0 0${along.map(([x, y]) => `L${x} ${y}`).join("")}` });
        along.forEach(([x, y], i) => set(masses[i], { transform: `translate(${x} ${y})` }));
      };
    }
    const [top] = masses;
    return ([u]) => {
      const bent = `M0 0C0 ${-H / 3} ${u / 2} ${(-2 * H) / 3} ${u} ${-H}`;
      set(line, { d: bent });
      if (tendon) set(tendon, { d: bent });
      set(top, { transform: `translate(${u} ${-H}) rotate(${(Math.atan((1.5 * u) / H) * 180) / Math.PI})` });
    };
  }
  /** Heights of the masses that are drawn; without floors the height of the one centre of mass. */
  const places = () => (floors()?.length ? floors().map(([, height]) => height) : [motion.parameters.H]);
  /** Displacements of these masses in a `state`, or any of its kind. */
  const displacements = (state) => places().map((_, i) => (floors() ? (state[`u[${i + 1}]`] ?? 0) : state.u));
  const largestDisplacement = () => Math.max(...displacements(motion.largest));
  /** The ties as lines from the ground to the base, and their forces below, from left to right. */
  function drawTies(state, place) {
    const { x, y } = stage;
    const [lines, forces] = [at("ties"), at("pulls")];
    lines.replaceChildren();
    forces.replaceChildren();
    const text = element(forces, "text", { x, y: y + 56, "text-anchor": "middle" });
    for (const [name, along, per, unit] of [...motion.parameters.ties].sort((one, other) => one[1] - other[1])) {
      const top = place(along);
      element(lines, "line", { class: name === "P_t" ? "tendon" : "dissipator", x1: along, y1: 0, x2: top.x, y2: top.y });
      element(text, "tspan", { dx: 10, "data-name": name }, `${name} ${significant(state[name] / per)} ${unit}`);
    }
    // a spring of the ground ends at the base, or at the surface if the base is above it
    for (const xi of motion.parameters.points) {
      const [foot, end] = [12 / stage.scale, place(xi)];
      const part = (Math.max(0, end.y) - foot) / 4;
      element(lines, "path", { class: "spring", d: `M${end.x} ${foot}l${foot / 3} ${part}l${-foot / 1.5} ${part}l${foot / 1.5} ${part}l${-foot / 3} ${part}` });
    }
  }

  function block() {
    const { B, H } = motion.parameters;
    const size = Math.min(2 * B, H);
    if (floors()?.length > 1) return { width: 0.8 * size, height: Math.min(0.28 * size, (0.3 * H) / floors().length) };
    return { width: 0.42 * size, height: 0.28 * size };
  }
  let bend; // draws the structure with its top displaced

  function layOutStructure() {
    structure(at("rest"))(places().map(() => 0));
    bend = structure(at("body"));
    const largestMotion = Math.max(motion.largest.theta, largestDisplacement() / motion.parameters.H);
    exaggerations = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].filter(
      (factor) => factor === 1 || (largestMotion > 0 && factor * largestMotion < 0.6),
    );
    if (!isChosen || !exaggerations.includes(exaggeration)) {
      exaggeration = exaggerations.filter((factor) => factor === 1 || factor * largestMotion <= 0.25).at(-1);
    }
    const options = at("exaggeration");
    if (options.length !== exaggerations.length) {
      options.replaceChildren(...exaggerations.map((factor) => new Option(`${factor} ×`, `${factor}`)));
    }
    options.value = exaggeration;
  }

  let sizes; // of both drawings: to ask for them at each change would lay out the page twice
  const measure = () => (sizes = Object.fromEntries(["scene", "histories", "profile"].map((id) => [id, at(id).getBoundingClientRect()])));
  measure();

  let stage = {};
  function layOutScene() {
    const { width, height } = sizes.scene;
    const { H, B } = motion.parameters;
    set(at("scene"), { viewBox: `0 0 ${width} ${height}` }); // on paper it takes the width of the page
    const theta = Math.min(Math.PI / 2, exaggeration * motion.largest.theta);
    const u = exaggeration * largestDisplacement();
    const reach = B * (1 - Math.cos(theta)) + (H + block().height) * Math.sin(theta) + u + block().width / 2;
    const tall = Math.hypot(H + block().height, theta > 0.5 ? 2 * B : 0);
    const [left, right, top, below] = [64, 40, 64, motion.parameters.ties.length > 0 ? 74 : 58];
    const scale = Math.min((width - left - right) / (2 * Math.max(1.25 * B, reach)), (height - top - below) / tall);
    stage = { x: (width + left - right) / 2, y: height - below, scale, width };
    const { x, y } = stage;
    at("world").setAttribute("transform", `translate(${x} ${y}) scale(${scale})`);
    set(at("surface"), { x1: 0, x2: width, y1: y, y2: y });
    set(at("earth"), { x: 0, y, width, height: 12 });
    set(at("pivot"), { r: 5 / scale });
    const dimensions = at("dimensions");
    dimensions.replaceChildren();
    const lift = 90; // room for the words about the uplift
    const [side, line] = [Math.max(20, x - Math.max(scale * B + lift, scale * reach + 14)), y + 26];
    const [roof, half] = [y - scale * H, scale * B];
    element(dimensions, "path", { d: `M${side - 4} ${y}h8m-4 0V${roof}m-4 0h8` });
    element(dimensions, "text", {
      class: "muted", transform: `translate(${side - 9} ${(y + roof) / 2}) rotate(-90)`, "text-anchor": "middle",
    }, `H = ${significant(H)} m`);
    element(dimensions, "path", { d: `M${x - half} ${line - 4}v8m0 -4H${x + half}m0 -4v8` });
    element(dimensions, "text", { class: "muted", x, y: line + 16, "text-anchor": "middle" }, `2B = ${significant(2 * B)} m`);
    at("stated").textContent = exaggeration === 1 ? "true to scale" : "as large; lengths true to scale";
  }

  function drawScene(state) {
    const { x, y, scale, width } = stage;
    const { B } = motion.parameters;
    const side = state.theta < 0 ? -1 : 1;
    const theta = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, exaggeration * state.theta));
    // about an edge; on ground that gives about the middle, which moves vertically, and sideways if the base may slide
    const [pivot, rise, way] = givesWay() ? [0, exaggeration * state.y, exaggeration * (state.x ?? 0)] : [side * B, 0, 0];
    const place = (along) => ({ x: way + pivot + (along - pivot) * Math.cos(theta), y: (along - pivot) * Math.sin(theta) - rise });
    at("body").setAttribute("transform", `${rise || way ? `translate(${way} ${-rise}) ` : ""}rotate(${(theta * 180) / Math.PI} ${pivot} 0)`);
    bend(displacements(state).map((u) => exaggeration * u));
    const lifts = state.theta !== 0;
    set(at("pivot"), { cx: pivot, visibility: lifts && pivot ? "visible" : "hidden" });
    const edge = place(-side * B);
    const isSeen = lifts && -edge.y * scale > 2;
    set(at("gap"), { x1: edge.x, x2: edge.x, y1: 0, y2: edge.y, visibility: isSeen ? "visible" : "hidden" });
    const lift = at("lift");
    lift.textContent = isSeen ? withUnit("uplift", state.uplift) : "";
    set(lift, { x: x + scale * edge.x - 8 * side, y: y + Math.min((scale * edge.y) / 2 + 4, -5), "text-anchor": side > 0 ? "end" : "start" });
    drawTies(state, place);
    drawShaking(state.a_g, width);
    const fallen = at("fallen");
    fallen.textContent = state.phase === "overturned" ? `overturned at ${fixed(motion.end, 3)} s, peaks until ${fixed(motion.fall, 3)} s` : "";
    set(fallen, { x, y: 62, "text-anchor": "middle" });
  }

  /** The ground acceleration as an arrow; the largest is a quarter of the width. */
  function drawShaking(a_g, width) {
    const [line, head, text] = at("shaking").children;
    const length = motion.largest.a_g > 0 ? (0.24 * width * a_g) / motion.largest.a_g : 0;
    const [x, y, tip] = [stage.x, stage.y + 6, Math.sign(length) * Math.min(9, Math.abs(length))];
    set(line, { x1: x, x2: x + length - tip, y1: y, y2: y });
    set(head, { d: `M${x + length} ${y}l${-tip} -5v10z` });
    text.textContent = motion.largest.a_g > 0 ? `a_g = ${withUnit("a_g", a_g)}` : "ground at rest";
    set(text, { x: width - 12, y: stage.y + 32, "text-anchor": "end", class: "muted" });
  }

  // ---- Numbers at the cursor

  let rows = {};
  function layOutNumbers() {
    const names = shownIn("Numbers").map(({ name }) => name);
    if (`${Object.keys(rows)}` !== `${["phase", ...names]}`) {
      const made = (html) => Object.assign(document.createElement("tr"), { innerHTML: html });
      rows = { phase: made('<th scope="row">phase</th><td colspan="3"></td>') };
      rows.phase.className = "phase";
      for (const name of names) {
        rows[name] = made('<th scope="row"><span class="meaning"></span><span></span></th><td></td><td></td><td><button type="button"></button></td>');
        rows[name].dataset.name = name;
        rows[name].cells[3].firstChild.addEventListener("click", () => moveTo(peakOf(name).instant));
      }
      at("readings").replaceChildren(...Object.values(rows));
    }
    for (const { name, symbol, unit } of shownIn("Numbers")) {
      const { magnitude, instant } = peakOf(name);
      rows[name].cells[0].firstChild.textContent = `${meaningOf(name)} `;
      rows[name].cells[0].lastChild.textContent = `${symbol} (${unit})`;
      rows[name].cells[2].textContent = inUnit(name, magnitude);
      const button = rows[name].cells[3].firstChild;
      button.textContent = `${fixed(instant, 3)} s`;
      button.setAttribute("aria-label", `To the peak of the ${meaningOf(name)} at ${fixed(instant, 3)} seconds`);
    }
  }

  function drawNumbers(state) {
    rows.phase.cells[1].textContent = state.phase;
    for (const { name } of shownIn("Numbers")) rows[name].cells[1].textContent = inUnit(name, state[name]);
    at("clock").textContent = `${fixed(t, 3)} of ${fixed(motion.end, 3)} s`;
    const slider = at("time");
    slider.value = t;
    slider.setAttribute("aria-valuetext", `${fixed(t, 3)} seconds, ${state.phase}`);
  }

  // ---- Peaks over the height

  /** Values of floors or storeys `v` and the peak of the ground as points over the heights `h` from the base on, by place. */
  const overHeight = {
    Floors: (v, h, a_g) => [a_g, ...v].map((x, i) => [x, h[i]]),
    Storeys: (v, h) => v.flatMap((x, i) => [[x, h[i]], [x, h[i + 1]]]),
    Feet: (v, h) => [...v, 0].map((x, i) => [x, h[i]]),
  };
  const profiles = () => Object.entries(overHeight).flatMap(([place, points]) =>
    shownIn(place).map((of) => ({ ...of, points, title: `${of.label.replace("storey ", "")} (${of.unit})` })));

  /** The choice of a floor, and the table of peaks, from the top down. */
  function layOutFloors() {
    const count = floors()?.length ?? 0;
    at("choice").hidden = at("heights").hidden = count <= 1;
    if (!(floor >= 1 && floor <= count) || floor === at("floor").length) floor = count; // the top stays the top
    if (at("floor").length !== count) {
      at("floor").replaceChildren(...Array.from({ length: count }, (_, i) => new Option(i + 1 === count ? `${count}, the top` : `${i + 1}`, `${i + 1}`)).reverse());
    }
    at("floor").value = floor;
    const cell = (content, of) => Object.assign(document.createElement(of), { textContent: content });
    const hasFixed = "V_t" in motion.fixed;
    const columns = profiles();
    const headings = ["floor", "height (m)", ...columns.flatMap(({ symbol, unit }) => [`${symbol} (${unit})`, "fixed base"])];
    at("columns").replaceChildren(...headings.map((of) => Object.assign(cell(of, "th"), { scope: "col" })));
    at("peaks").replaceChildren(...Array.from({ length: count }, (_, k) => {
      const [i, row] = [count - k, document.createElement("tr")];
      const peaks = columns.flatMap(({ name, per }) => {
        const value = (of) => significant(of[`${name}[${i}]`].magnitude / per);
        return [value(motion.peaks), hasFixed ? value(motion.fixed) : "–"];
      });
      row.append(Object.assign(cell(i, "th"), { scope: "row" }), ...[significant(floors()[i - 1][1]), ...peaks].map((of) => cell(of, "td")));
      return row;
    }));
  }

  /** The largest magnitudes over the height, and those on a fixed base. */
  function drawProfile() {
    if (at("heights").hidden) return;
    const svg = at("profile");
    const { width, height } = sizes.profile;
    set(svg, { viewBox: `0 0 ${width} ${height}` });
    svg.replaceChildren();
    const columns = width <= 540 ? 2 : 4; // as in the style
    const [left, gap, high] = [44, 24, (height * columns) / 4];
    const wide = (width - left - columns * gap) / columns;
    const drawn = profiles();
    drawn.forEach(({ name, title, per, points }, k) => {
      const from = left + (k % columns) * (wide + gap);
      const [top, bottom] = [24, high - 20].map((y) => y + Math.floor(k / columns) * high);
      const y = (height) => bottom - (height / motion.parameters.H) * (bottom - top);
      for (const { value, text } of ticks(0, motion.parameters.H, 4)) {
        element(svg, "line", { class: "grid", x1: from, x2: from + wide, y1: y(value), y2: y(value) });
        if (k % columns === 0) element(svg, "text", { x: left - 6, y: y(value) + 4, "text-anchor": "end" }, text);
      }
      if (k % columns === 0) element(svg, "text", { class: "muted", x: 2, y: top - 12 }, "h (m)");
      const heights = [0, ...floors().map(([, height]) => height)].map(y);
      const of = (peaks) => points(floors().map((_, i) => (peaks[`${name}[${i + 1}]`]?.magnitude ?? 0) / per), heights, peaks.a_g?.magnitude / per);
      const curves = [[motion.fixed, "--orange", "6 4"], [motion.peaks, "--blue", ""]].filter(([peaks]) => "V_t" in peaks);
      const most = Math.max(...curves.flatMap(([peaks]) => of(peaks).map(([value]) => value))) || 1;
      const x = (value) => from + (value / (1.05 * most)) * wide;
      for (const { value, text } of ticks(0, 1.05 * most, Math.max(2, wide / 60))) {
        element(svg, "line", { class: "grid", x1: x(value), x2: x(value), y1: top, y2: bottom });
        element(svg, "text", { x: x(value), y: bottom + 16, "text-anchor": "middle" }, text);
      }
      element(svg, "text", { x: from, y: top - 12 }, title);
      for (const [peaks, colour, dashes] of curves) {
        const d = `M${of(peaks).map(([value, y]) => `${x(value)} ${y}`).join("L")}`;
        element(svg, "path", { class: "curve", style: `stroke:var(${colour});stroke-dasharray:${dashes}`, d });
      }
    });
    const titles = drawn.map(({ title }) => title).join(", ");
    set(svg, { "aria-label": `Largest magnitudes over the height: ${titles}; the table has the numbers` });
  }

  // ---- Histories

  let panels = [];
  let lanes = [];
  function layOutPanels() {
    const most = (name) => Math.max(...[motion, ...beside].map(({ largest }) => largest[own(name)] ?? largest[name] ?? 0));
    const coloured = { Page: "--blue", ...(givesWay() && { PageOnGround: "--green" }) };
    const all = Object.entries(coloured).flatMap(([place, colour]) => shownIn(place).map((of) => ({ ...of, colour })));
    const panel = ({ name, symbol, unit, per, axes, colour }) => {
      const largest = most(name);
      const [read, size] = axes.find(([, , from, below]) => from <= largest && largest < (below ?? Infinity)) ?? [unit, per];
      const multiple = all.find(({ over }) => over?.[0] === name);
      const right = multiple && { meaning: multiple.label, title: `${multiple.symbol} (${multiple.unit})`, factor: (multiple.over[1] * size) / multiple.per };
      return { name, title: `${symbol} (${read})`, per: size, colour: name === "a_g" ? "--grey" : colour, right, meaning: meaningOf(name), largest };
    };
    panels = all.filter(({ over }) => !over).map(panel).filter(({ name, largest }) => ["theta", "a_t"].includes(name) || largest > 0);
    document.body.style.setProperty("--panels", `${panels.length}`);
    lanes = kinds
      .map((kind) => ({ ...kind, times: motion.transitions.filter((each) => kind.is(each.kind)).map((each) => each.instant) }))
      .filter((lane) => lane.times.length > 0);
  }
  const kinds = [
    { name: "uplift", colour: "--green", is: (kind) => kind.startsWith("uplift") },
    { name: "impact", colour: "--orange", is: (kind) => kind.startsWith("impact") },
    { name: "release", colour: "--green", is: (kind) => kind === "release" },
    { name: "touch", colour: "--orange", is: (kind) => kind === "touch" },
    { name: "landing", colour: "--ink", is: (kind) => kind === "landing" || kind === "settling" },
    { name: "overturning", colour: "--purple", is: (kind) => kind.startsWith("overturning") },
    { name: "yielding", colour: "--orange", is: (kind) => kind.startsWith("yielding") },
    { name: "unloading", colour: "--green", is: (kind) => kind.startsWith("unloading") },
  ];

  let shown; // the time that the histories show
  let chart = {};
  const across = (instant) => chart.left + ((instant - shown[0]) / (shown[1] - shown[0])) * chart.width;
  const instantAt = (x) => shown[0] + ((x - chart.left) / chart.width) * (shown[1] - shown[0]);

  const tenth = (pixels) => Math.round(10 * pixels) / 10;

  /** Of the points in each column of pixels the first, the least, the largest and the last. */
  function path(time, values, height) {
    const first = Math.max(0, countUpTo(time, shown[0]) - 1);
    const last = Math.min(time.length - 1, countUpTo(time, shown[1]));
    let drawn = "";
    const add = (i) => (drawn += `${drawn ? "L" : "M"}${tenth(across(time[i]))} ${tenth(height(values[i]))}`);
    for (let i = first; i <= last; ) {
      const x = Math.floor(2 * across(time[i]));
      let [least, most, next] = [i, i, i + 1];
      for (; next <= last && Math.floor(2 * across(time[next])) === x; next++) {
        if (values[next] < values[least]) least = next;
        if (values[next] > values[most]) most = next;
      }
      const [earlier, later] = least < most ? [least, most] : [most, least];
      add(i);
      if (earlier > i) add(earlier);
      if (later > earlier) add(later);
      if (next - 1 > later) add(next - 1);
      i = next;
    }
    return drawn;
  }

  function drawHistories() {
    const svg = at("histories");
    const { width, height } = sizes.histories;
    set(svg, { viewBox: `0 0 ${width} ${height}` });
    const isNarrow = width < 500;
    const longest = Math.max(0, ...lanes.map(({ name }) => name.length)); // its letters are at most 7.5 pixels wide
    const [left, right, gap] = [isNarrow ? 46 : 58, Math.max(isNarrow ? 56 : 76, 10 + 7.5 * longest), 26];
    const laneHeight = 15;
    const below = 40 + laneHeight * lanes.length;
    const high = (height - below) / panels.length;
    chart = { left, width: Math.max(50, width - left - right), top: gap, bottom: height - below };
    svg.replaceChildren();
    const defs = element(svg, "defs");
    const clip = element(defs, "clipPath", { id: "inside" });
    element(clip, "rect", { x: left, y: 0, width: chart.width, height });
    const inside = element(svg, "g", { "clip-path": "url(#inside)" });
    const titleOf = ({ meaning, title }) => (isNarrow ? title : `${meaning} ${title}`);
    const times = ticks(shown[0], shown[1], Math.max(3, chart.width / 90));

    motion.phases.forEach(([first, phase], k) => {
      const next = motion.phases[k + 1];
      const [from, to] = [motion.time[first], next ? motion.time[next[0]] : motion.end];
      if (!phase.startsWith("rocking") || to < shown[0] || from > shown[1]) return;
      const [x0, x1] = [across(from), across(to)];
      element(inside, "rect", { class: "rocking", x: x0, width: Math.max(0.5, x1 - x0), y: gap, height: height - below - gap });
    });

    const edge = left + chart.width;
    let cursor = "";
    panels.forEach((panel, k) => {
      const [top, bottom] = [k * high + gap, (k + 1) * high];
      const { magnitude, instant } = peakOf(panel.name);
      const most = (panel.largest > 0 ? panel.largest / panel.per : 1) * 1.12;
      const y = (value) => (top + bottom) / 2 - ((value / panel.per / most) * (bottom - top)) / 2;
      panel.y = y;
      cursor += `M0 ${top}V${bottom}`;
      for (const { value } of times) element(svg, "line", { class: "grid", x1: across(value), x2: across(value), y1: top, y2: bottom });
      for (const { value, text } of ticks(-most, most, Math.max(3, (bottom - top) / 24))) {
        const line = y(value * panel.per);
        element(svg, "line", { class: "grid", x1: left, x2: left + chart.width, y1: line, y2: line });
        element(svg, "text", { x: left - 6, y: line + 4, "text-anchor": "end" }, text);
      }
      element(svg, "line", { class: "axis", x1: left, x2: left, y1: top, y2: bottom });
      element(svg, "text", { x: left, y: top - 8 }, titleOf(panel));
      if (panel.right) {
        const { factor } = panel.right;
        element(svg, "line", { class: "axis", x1: edge, x2: edge, y1: top, y2: bottom });
        element(svg, "text", { x: edge, y: top - 8, "text-anchor": "end" }, titleOf(panel.right));
        for (const { value, text } of ticks(-most * factor, most * factor, Math.max(3, (bottom - top) / 24))) {
          const line = y((value / factor) * panel.per);
          element(svg, "line", { class: "axis", x1: edge, x2: edge + 4, y1: line, y2: line });
          element(svg, "text", { x: edge + 7, y: line + 4 }, text);
        }
      }
      const g = element(svg, "g", { "clip-path": "url(#inside)" });
      const drawn = (values) => values[own(panel.name)] ?? values[panel.name];
      const curve = ({ time, values }, colour) => drawn(values) &&
        element(g, "path", { class: "curve", "data-name": panel.name, style: `stroke:var(${colour})`, d: path(time, drawn(values), y) });
      for (const other of beside) curve(other, other.colour);
      curve(motion, panel.colour);
      if (magnitude > 0) {
        element(g, "circle", { class: "peak", cx: across(instant), cy: y(signed(panel.name, instant)), r: 3.5 });
      }
      panel.dot = element(g, "circle", { class: "dot", r: 3.5, style: `fill:var(${panel.colour})` });
    });

    element(svg, "rect", { class: "rocking key", x: edge - 122, y: gap - 18, width: 14, height: 11 });
    element(svg, "text", { x: edge - 104, y: gap - 8 }, "rocking");
    element(svg, "circle", { class: "peak", cx: edge - 42, cy: gap - 12.5, r: 3.5 });
    element(svg, "text", { x: edge, y: gap - 8, "text-anchor": "end" }, "peak");

    lanes.forEach(({ name, colour, times }, k) => {
      const y = chart.bottom + 6 + k * laneHeight;
      element(svg, "text", {
        x: left + chart.width + 6, y: y + 11, style: `fill:var(${colour})`, "data-kind": name,
      }, name);
      for (const instant of times) {
        if (instant < shown[0] || instant > shown[1]) continue;
        const x = across(instant);
        element(svg, "line", { class: "tick", "data-kind": name, x1: x, x2: x, y1: y + 2, y2: y + 13, style: `stroke:var(${colour})` });
      }
    });
    const axis = chart.bottom + 8 + laneHeight * lanes.length;
    element(svg, "line", { class: "axis", x1: left, x2: left + chart.width, y1: axis, y2: axis });
    for (const { value, text } of times) {
      element(svg, "text", { x: across(value), y: axis + 15, "text-anchor": "middle" }, text);
    }
    element(svg, "text", { class: "muted", x: width - 4, y: axis + 15, "text-anchor": "end" }, isNarrow ? "s" : "time (s)");
    chart.cursor = element(svg, "path", { class: "cursor", d: `${cursor}M0 ${chart.bottom + 4}V${axis}` });
    drawCursor(stateAt(t));
  }

  function drawCursor(state) {
    const x = across(t);
    const isShown = t >= shown[0] && t <= shown[1];
    set(chart.cursor, { transform: `translate(${x})`, visibility: isShown ? "visible" : "hidden" });
    for (const panel of panels) set(panel.dot, { cx: x, cy: panel.y(state[panel.name]) });
  }

  // ---- Time

  let t = 0;
  let isPlaying = false;
  let last = 0; // when the last frame was drawn, ms
  const speeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
  let speed = 1;

  function draw() {
    const state = stateAt(t);
    drawScene(state);
    drawNumbers(state);
    drawCursor(state);
  }

  function moveTo(instant) {
    t = Math.min(motion.end, Math.max(motion.start, instant));
    const length = shown[1] - shown[0];
    if (t < shown[0] || t > shown[1]) {
      showTime(t - 0.1 * length, t + 0.9 * length);
    }
    draw();
  }

  function play(yes) {
    if (yes && t >= motion.end) moveTo(motion.start);
    isPlaying = yes;
    const button = at("play");
    button.setAttribute("aria-label", yes ? "Pause" : "Play");
    button.querySelector("path").setAttribute("d", yes ? "M3 2h4v12H3zM9 2h4v12H9z" : "M3 1.5v13L14 8z");
    last = performance.now();
    if (yes) requestAnimationFrame(frame);
  }

  function frame(instant) {
    if (!isPlaying) return;
    const passed = Math.max(0, instant - last) / 1000;
    last = instant;
    moveTo(t + speed * passed);
    if (t >= motion.end) play(false);
    else requestAnimationFrame(frame);
  }

  function toTransition(step) {
    const instants = motion.transitions.map(({ instant }) => instant);
    const found = step > 0 ? instants.find((instant) => instant > t + 1e-9) : instants.findLast((instant) => instant < t - 1e-9);
    moveTo(found ?? (step > 0 ? motion.end : motion.start));
  }

  /** Shows the time from `from` to `to`, moved and cut so that it is part of the motion. */
  function showTime(from, to) {
    const { start, end } = motion;
    const length = Math.min(end - start, Math.max(1e-3 * (end - start), to - from));
    const first = Math.min(end - length, Math.max(start, from));
    shown = [first, first === end - length ? end : first + length];
    drawHistories();
  }

  const zoom = (factor, about) => showTime(about - factor * (about - shown[0]), about + factor * (shown[1] - about));

  // ---- Controls

  function choose(factor) {
    exaggeration = factor;
    isChosen = true;
    at("exaggeration").value = factor;
    layOutScene();
    draw();
  }
  function chooseSpeed(factor) {
    speed = factor;
    at("speed").value = factor;
  }
  /** The entry `step` further in a list than `present`, if there is one. */
  const next = (list, present, step) => list[list.indexOf(present) + step] ?? present;

  const prefersDark = matchMedia("(prefers-color-scheme: dark)");
  let theme = null; // chosen by hand
  const isDark = () => (theme ?? (prefersDark.matches ? "dark" : "light")) === "dark";
  function showTheme() {
    document.documentElement.style.colorScheme = theme ?? "";
    at("theme").textContent = isDark() ? "Light" : "Dark";
  }
  function otherTheme() {
    theme = isDark() ? "light" : "dark";
    showTheme();
  }
  prefersDark.addEventListener("change", showTheme);

  for (const factor of speeds) at("speed").append(new Option(`${factor} ×`, `${factor}`));
  at("exaggeration").addEventListener("change", (event) => choose(Number(event.target.value)));
  at("floor").addEventListener("change", (event) => {
    floor = Number(event.target.value);
    showMotion();
  });
  at("speed").addEventListener("change", (event) => chooseSpeed(Number(event.target.value)));
  at("time").addEventListener("input", (event) => moveTo(Number(event.target.value)));
  at("play").addEventListener("click", () => play(!isPlaying));
  at("previous").addEventListener("click", () => toTransition(-1));
  at("next").addEventListener("click", () => toTransition(1));
  at("theme").addEventListener("click", otherTheme);
  at("keys").addEventListener("click", () => at("help").showModal());

  const histories = at("histories");
  const scrub = (event) => moveTo(Math.min(shown[1], Math.max(shown[0], instantAt(event.offsetX))));
  histories.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    histories.setPointerCapture(event.pointerId);
    scrub(event);
  });
  histories.addEventListener("pointermove", (event) => {
    if (histories.hasPointerCapture(event.pointerId)) scrub(event);
  });
  histories.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(0.0015 * event.deltaY), instantAt(event.offsetX));
  }, { passive: false });
  histories.addEventListener("dblclick", () => showTime(motion.start, motion.end));

  const step = (part) => moveTo(t + part * (shown[1] - shown[0]));
  const keys = {
    " ": () => play(!isPlaying),
    ArrowLeft: (event) => step(event.shiftKey ? -0.1 : -0.01),
    ArrowRight: (event) => step(event.shiftKey ? 0.1 : 0.01),
    ArrowUp: () => chooseSpeed(next(speeds, speed, 1)),
    ArrowDown: () => chooseSpeed(next(speeds, speed, -1)),
    Home: () => moveTo(motion.start),
    End: () => moveTo(motion.end),
    ",": () => toTransition(-1),
    ".": () => toTransition(1),
    "+": () => zoom(0.5, t),
    "=": () => zoom(0.5, t),
    "-": () => zoom(2, t),
    0: () => showTime(motion.start, motion.end),
    e: () => choose(next(exaggerations, exaggeration, 1)),
    E: () => choose(next(exaggerations, exaggeration, -1)),
    d: otherTheme,
    "?": () => at("help").showModal(),
  };
  document.addEventListener("keydown", (event) => {
    const isTaken = event.target.closest("select, dialog, textarea, input:not(#time)") || (event.target.closest("button") && event.key === " ");
    if (isTaken || event.ctrlKey || event.metaKey || event.altKey || !Object.hasOwn(keys, event.key)) return;
    event.preventDefault();
    keys[event.key](event);
  });
  // a button that was clicked with a pointer leaves the keys to the page
  document.addEventListener("click", (event) => {
    if (event.detail > 0) event.target.closest("button")?.blur();
  });

  const layOut = () => {
    layOutScene();
    drawProfile();
    drawHistories();
    draw();
  };
  chooseSpeed(1);
  showTheme();
  const observer = new ResizeObserver(() => {
    measure();
    if (motion) layOut();
  });
  for (const id of ["stage", "charts", "heights"]) observer.observe(at(id));

  /** Shows the motion `data`, in place of the one before at the same instant, with the decoded motions `others` beside it. */
  function show(data, others = []) {
    const before = motion;
    [motion, beside] = [data, others];
    const isWhole = !before || (shown[0] === before.start && shown[1] === before.end);
    const { start, end } = motion;
    layOutFloors();
    if (isWhole || shown[1] > end || shown[0] < start) shown = [start, end];
    t = before ? Math.min(end, Math.max(start, t)) : start;
    set(at("time"), { min: start, max: end });
    layOutStructure();
    showMotion();
  }

  function showMotion() {
    layOutPanels();
    describe();
    layOutNumbers();
    layOut();
  }

  function describe() {
    const { title, ending, transitions, parameters } = motion;
    const { m, m0, H, B, f_fc } = parameters;
    const mass = (kilograms) => (kilograms < 1e4 ? `${significant(kilograms)} kg` : `${significant(kilograms / 1e3)} t`);
    const count = transitions.length;
    document.title = `${title}: rocking structure`;
    const peaks = panels.map(({ name, meaning }) => {
      const { magnitude, instant } = peakOf(name);
      return `${meaning}, peak ${withUnit(name, magnitude)} at ${fixed(instant, 3)} s`;
    });
    set(at("histories"), { "aria-label": `Histories: ${peaks.join("; ")}` });
    at("title").textContent = title;
    const masses = floors()?.length > 1 ? `${floors().length} floors, ${mass(m)} on a base of` : `masses ${mass(m)} and`;
    at("about").textContent =
      `${masses} ${mass(m0)}, H = ${significant(H)} m, 2B = ${significant(2 * B)} m, ` +
      `${significant(f_fc)} Hz in full contact; ${count} transition${count === 1 ? "" : "s"}` +
      { "at rest": ", base down for good", overturned: ", overturned", "still rocking": ", still rocking in the end", "at time": "" }[ending];
  }

  play(false);
  return { decode, show, play, isPlaying: () => isPlaying, significant };
}
