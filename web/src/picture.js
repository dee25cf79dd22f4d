/** The motion as a picture: structure, histories, title and peaks as the page shows them, drawn to a canvas. */
function motionPicture() {
  const at = (id) => document.getElementById(id);
  const margin = 16; // pixels
  const escape = (text) => text.replace(/[<&]/g, (letter) => `&#${letter.charCodeAt(0)};`);

  /** The drawing `id` of the page at x and y, as SVG. */
  function drawing(id, x, y) {
    const svg = at(id).cloneNode(true);
    const { width, height } = at(id).getBoundingClientRect();
    svg.removeAttribute("id"); // the rules of the page for its place there
    for (const [name, value] of Object.entries({ x, y, width, height })) svg.setAttribute(name, value);
    return new XMLSerializer().serializeToString(svg);
  }

  /** Size of the picture in pixels, and its content as SVG. */
  function compose() {
    const [stage, charts] = [at("scene"), at("histories")].map((svg) => svg.getBoundingClientRect());
    const isBeside = charts.left >= stage.right - 1;
    const rows = [...at("readings").rows].filter((row) => row.dataset.name);
    const [head, table] = [58, 20 * rows.length + 30];
    const left = Math.max(stage.width, 300);
    const width = isBeside ? left + charts.width : Math.max(left, charts.width);
    const below = head + stage.height + table;
    const height = isBeside ? Math.max(head + charts.height, below) : below + charts.height;
    const text = (x, y, content, style = "") => `<text x="${x}" y="${y}" style="${style}">${escape(content)}</text>`;
    const line = (row, i) => {
      const [name, , peak, instant] = [...row.cells].map((cell) => cell.textContent);
      const y = head + stage.height + 40 + 20 * i;
      const end = "text-anchor:end";
      return text(margin, y, name) + text(left - 80, y, peak, end) + text(left - margin, y, instant, end);
    };
    const y = head + stage.height + 20;
    const content = [
      text(margin, 24, at("title").textContent, "font-size:16px;font-weight:600"),
      text(margin, 44, at("about").textContent, "fill:var(--muted)"),
      drawing("scene", 0, head),
      text(left - 80, y, "peak", "text-anchor:end;fill:var(--muted)") + text(left - margin, y, "at", "text-anchor:end;fill:var(--muted)"),
      ...rows.map(line),
      isBeside ? drawing("histories", left, head) : drawing("histories", 0, below),
    ];
    const scheme = `:root{color-scheme:${at("theme").textContent === "Dark" ? "light" : "dark"}}`;
    const style = `<style>${escape(document.querySelector("style").textContent)}${scheme}</style>`;
    const paper = '<rect width="100%" height="100%" style="fill:var(--paper)"/>';
    const size = `width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"`;
    const svg = `<svg xmlns="http://www.w3.org/2000/svg" ${size}>${style}${paper}${content.join("")}</svg>`;
    return { width, height, svg };
  }

  /** Draws the picture of this instant to `canvas`, `scale` times as large as on the page. */
  async function draw(canvas, scale) {
    const { width, height, svg } = compose();
    const image = new Image(width, height);
    image.src = `data:image/svg+xml,${encodeURIComponent(svg)}`;
    await image.decode();
    const even = (pixels) => 2 * Math.ceil((scale * pixels) / 2); // films have pixels in pairs
    if (canvas.width !== even(width) || canvas.height !== even(height)) {
      [canvas.width, canvas.height] = [even(width), even(height)];
    }
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  }

  /** The picture as PNG. */
  async function png() {
    const canvas = document.createElement("canvas");
    await draw(canvas, 2);
    return new Promise((done) => canvas.toBlob(done, "image/png"));
  }

  const type = "video/webm";
  const hasFilm = () => "MediaRecorder" in window && MediaRecorder.isTypeSupported(type);

  /** A film of the page, drawn anew while `isPlaying()`. */
  async function film(isPlaying) {
    const canvas = document.createElement("canvas");
    await draw(canvas, 1);
    const parts = [];
    const recorder = new MediaRecorder(canvas.captureStream(), { mimeType: type, videoBitsPerSecond: 4e6 });
    recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
    const stopped = new Promise((done) => recorder.addEventListener("stop", done));
    recorder.start();
    do {
      await draw(canvas, 1);
      await new Promise(requestAnimationFrame);
    } while (isPlaying());
    await draw(canvas, 1);
    recorder.stop();
    await stopped;
    return new Blob(parts, { type });
  }

  return { png, film, hasFilm };
}
