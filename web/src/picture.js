/** The motion as a picture: structure, histories, title and peaks as the page shows them, drawn to a canvas. */
function motionPicture() {
  const at = (id) => document.getElementById(id);
  const margin = 16; // pixels
  const moving = ".cursor, .dot"; // what moves in the histories
  const escape = (text) => text.replace(/[<&]/g, (letter) => `&#${letter.charCodeAt(0)};`);

  /** The elements `children` of the drawing `id` at x and y, as SVG. */
  function drawing(id, x, y, children) {
    const svg = at(id).cloneNode();
    const { width, height } = at(id).getBoundingClientRect();
    svg.removeAttribute("id"); // the rules of the page for its place there
    for (const [name, value] of Object.entries({ x, y, width, height })) svg.setAttribute(name, value);
    svg.append(...children);
    return new XMLSerializer().serializeToString(svg);
  }

  /** Sizes of the picture and its parts, in pixels. */
  function measure() {
    const [stage, charts] = [at("scene"), at("histories")].map((svg) => svg.getBoundingClientRect());
    const isBeside = charts.left >= stage.right - 1;
    const rows = [...at("readings").rows].filter((row) => row.dataset.name);
    const head = 58;
    const left = Math.max(stage.width, 300);
    const table = head + stage.height + 20;
    const below = table + 20 * rows.length + 10;
    return {
      rows, head, left, table,
      histories: isBeside ? [left, head] : [0, below],
      width: isBeside ? left + charts.width : Math.max(left, charts.width),
      height: isBeside ? Math.max(head + charts.height, below) : below + charts.height,
    };
  }

  /** All that does not move while the motion plays. */
  function still({ rows, left, table, histories }) {
    const text = (x, y, content, style = "") => `<text x="${x}" y="${y}" style="${style}">${escape(content)}</text>`;
    const line = (y, cells, style = "") =>
      text(margin, y, cells[0], style) + text(left - 80, y, cells[1], `text-anchor:end;${style}`) +
      text(left - margin, y, cells[2], `text-anchor:end;${style}`);
    const charts = at("histories").cloneNode(true);
    for (const element of charts.querySelectorAll(moving)) element.remove();
    return [
      '<rect width="100%" height="100%" style="fill:var(--paper)"/>',
      text(margin, 24, at("title").textContent, "font-size:16px;font-weight:600"),
      text(margin, 44, at("about").textContent, "fill:var(--muted)"),
      line(table, ["quantity", "peak", "at"], "fill:var(--muted)"),
      ...rows.map(({ cells }, i) => line(table + 20 * (i + 1), [cells[0], cells[2], cells[3]].map((cell) => cell.textContent))),
      drawing("histories", ...histories, charts.children),
    ];
  }

  const copies = (elements) => [...elements].map((element) => element.cloneNode(true));
  const inMotion = ({ head, histories }) => [
    drawing("scene", 0, head, copies(at("scene").children)),
    drawing("histories", ...histories, copies(at("histories").querySelectorAll(moving))),
  ];

  /** The parts of a picture as an image. */
  async function image({ width, height }, parts) {
    const scheme = `:root{color-scheme:${at("theme").textContent === "Dark" ? "light" : "dark"}}`;
    const style = `<style>${escape(document.querySelector("style").textContent)}${scheme}</style>`;
    const size = `width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"`;
    const svg = `<svg xmlns="http://www.w3.org/2000/svg" ${size}>${style}${parts.join("")}</svg>`;
    const made = new Image(width, height);
    made.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
    await made.decode();
    return made;
  }

  /** A canvas `scale` times as large as the page, and what draws the picture of this instant to it. */
  function painter(scale) {
    const [canvas, below] = [document.createElement("canvas"), document.createElement("canvas")];
    let drawn; // an element of the histories that are drawn in `below`
    async function paint() {
      const sizes = measure();
      const charts = at("histories").firstElementChild;
      if (charts !== drawn) {
        const made = await image(sizes, still(sizes));
        for (const each of [canvas, below]) each.width = 2 * Math.ceil((scale * sizes.width) / 2); // films need pairs
        for (const each of [canvas, below]) each.height = 2 * Math.ceil((scale * sizes.height) / 2);
        below.getContext("2d").drawImage(made, 0, 0, canvas.width, canvas.height);
        drawn = charts;
      }
      const made = await image(sizes, inMotion(sizes));
      const context = canvas.getContext("2d");
      context.drawImage(below, 0, 0);
      context.drawImage(made, 0, 0, canvas.width, canvas.height);
    }
    return { canvas, paint };
  }

  /** The picture as PNG. */
  async function png() {
    const { canvas, paint } = painter(2);
    await paint();
    return new Promise((done) => canvas.toBlob(done, "image/png"));
  }

  const type = "video/webm";
  const silence = 3000; // ms without a frame after which the encoder has written all
  const hasFilm = () => "MediaRecorder" in window && MediaRecorder.isTypeSupported(type);

  /** A film of the page, painted again and again while `isPlaying()`. */
  async function film(isPlaying) {
    const { canvas, paint } = painter(1);
    await paint();
    const parts = [];
    const recorder = new MediaRecorder(canvas.captureStream(), { mimeType: type, videoBitsPerSecond: 4e6 });
    let written = performance.now();
    recorder.addEventListener("dataavailable", ({ data }) => {
      parts.push(data);
      written = performance.now();
    });
    const stopped = new Promise((done) => recorder.addEventListener("stop", done));
    recorder.start(200);
    do {
      await new Promise(requestAnimationFrame);
      await paint();
    } while (isPlaying());
    // frames that a slow encoder has not written are lost when the recorder stops
    while (performance.now() < written + silence) await new Promise((next) => setTimeout(next, 200));
    recorder.stop();
    await stopped;
    return new Blob(parts, { type });
  }

  return { png, film, hasFilm };
}
