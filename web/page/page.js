// --- page.js: a part comes in, is seen, is meshed, and goes out; what the user sees now, and what moves it. Camera, picture
// and little helpers are those of the report page (src/report/page/assets), which shows the finished mesh in a frame.

const byId = (id) => document.getElementById(id);
const canvas = byId("canvas");

/** Text in the page that was packed by scripts/web.sh: base64 of gzip. */
async function unpacked(id) {
  const element = byId(id), text = atob(element.textContent.trim());
  element.remove();
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer());
}

let workerAddress = null;
const engine = createEngine({
  compiled: async () => WebAssembly.compile(await unpacked("packed-module")),
  start: async () => {
    workerAddress ??= URL.createObjectURL(new Blob([await unpacked("packed-worker")], { type: "text/javascript" }));
    return browserWorker(new Worker(workerAddress));
  },
});

/** The whole state: a part or none, a mesh of it or none, and what is going on. */
const now = { part: null, names: [], mesh: null, work: null, info: null, view: null, files: 0 };
const MOST_FORESEEN = 300000; // triangles up to which sizes are foreseen unasked

// --- work: one thing at a time, which can be cancelled

function tell(text, fraction = null) {
  byId("busy-text").textContent = text;
  const bar = byId("progress");
  if (fraction === null) bar.removeAttribute("value");
  else bar.value = fraction;
}
function complain(error) {
  const box = byId("trouble");
  box.hidden = !error;
  if (!error) return;
  const defects = error.report?.defects;
  box.textContent = shown(error.message).replaceAll("\\x0a", "\n") + (defects?.described ? "\n" + shown(defects.described) : "");
  box.scrollIntoView({ block: "nearest" });
}

/** Runs `task(given)` after ending what is going on; returns its result, or null if it failed or was cancelled. */
async function work(title, task) {
  const before = now.work;
  before?.stop.abort();
  const mine = (now.work = { stop: new AbortController(), begun: performance.now() });
  await before?.done;
  let finished;
  mine.done = new Promise((done) => (finished = done));
  if (now.work === mine) complain(null);
  const clock = () => `${seconds((performance.now() - mine.begun) / 1000)} s`;
  let stage = title, fraction = null;
  const tick = () => now.work === mine && tell(`${stage} · ${clock()}`, fraction);
  const timer = setInterval(tick, 200);
  byId("busy").hidden = false;
  byId("go").disabled = true;
  tick();
  try {
    return await task({ signal: mine.stop.signal, progress: (name, part) => ((stage = name), (fraction = part), tick()) });
  } catch (error) {
    if (!mine.stop.signal.aborted) complain(error);
    return null;
  } finally {
    clearInterval(timer);
    finished();
    if (now.work === mine) {
      now.work = null;
      byId("busy").hidden = true;
      byId("go").disabled = false;
    }
  }
}

// --- the part

async function openPart(files) {
  if (files.length === 0) return;
  const part = await work("reading", (given) => engine.open(files, {}, given));
  if (!part) return;
  now.part?.close();
  dropMesh();
  Object.assign(now, { part, names: files.map((file) => file.name) });
  await showPart();
  foresee();
}

async function showPart() {
  const { part } = now;
  const [points, triangles] = await Promise.all([part.array("points"), part.array("triangles")]);
  const { low, high } = boundsOf(points), extent = low.map((l, i) => high[i] - l);
  now.shape = { points, triangles, low, high, extent };
  const { report } = part, unit = report.unit ? " " + shown(report.unit) : "";
  const rows = [["extent", extent.map((x) => digits(x)).join(" × ") + unit], ["triangles", grouped(triangles.length / 3)]];
  const volume = (report.regions ?? []).reduce((sum, region) => sum + (region.volume ?? 0), 0) || volumeOf(points, triangles);
  if (volume > 0) rows.push(["volume", digits(volume, 5)]);
  if (report.regions?.length > 1) rows.push(["regions", String(report.regions.length)]);
  const notes = (report.notes ?? []).map((note) => make("li", {}, shown(note)));
  byId("part").replaceChildren(make("span", { class: "name" }, shown(now.names.join(" + "))), table(rows, null, "pairs"),
    ...(notes.length ? [make("ul", { class: "hint" }, ...notes)] : []));
  byId("part").hidden = false;
  byId("step-mesh").hidden = false;
  byId("empty").hidden = true;
  byId("dimensions").hidden = false;
  byId("dimensions").textContent = extent.map((x) => digits(x)).join(" × ") + unit;
  byId("size").value = String(Number((Math.hypot(...extent) / 40).toPrecision(2)));
  drawPart();
}

function boundsOf(points) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    if (points[i] < low[i % 3]) low[i % 3] = points[i];
    if (points[i] > high[i % 3]) high[i % 3] = points[i];
  }
  return { low, high };
}

/** Of a closed surface. */
function volumeOf(p, triangles) {
  let sum = 0;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2]];
    sum += p[a] * (p[b + 1] * p[c + 2] - p[b + 2] * p[c + 1]) + p[a + 1] * (p[b + 2] * p[c] - p[b] * p[c + 2]) + p[a + 2] * (p[b] * p[c + 1] - p[b + 1] * p[c]);
  }
  return sum / 6;
}

/** The part as vertices for the picture: points between -1 and 1, and the mean length of the edges around each. */
function partVertices({ points, triangles, low, high, extent }) {
  const radius = Math.hypot(...extent) / 2 || 1, middle = low.map((l, i) => (l + high[i]) / 2);
  const placed = Float32Array.from(points, (x, i) => (x - middle[i % 3]) / radius);
  const sums = new Float32Array(points.length / 3), counts = new Uint32Array(points.length / 3);
  for (let i = 0; i < triangles.length; ++i) {
    const a = triangles[i], b = triangles[i % 3 === 2 ? i - 2 : i + 1];
    const length = Math.hypot(placed[3 * a] - placed[3 * b], placed[3 * a + 1] - placed[3 * b + 1], placed[3 * a + 2] - placed[3 * b + 2]);
    for (const v of [a, b]) (sums[v] += length), ++counts[v];
  }
  const colour = getComputedStyle(document.documentElement).getPropertyValue("--part").trim().split(/\s+/).map(Number);
  const data = new VertexData(triangles.length / 3);
  for (let i = 0; i < triangles.length; ++i) {
    const v = triangles[i];
    data.add(placed[3 * v], placed[3 * v + 1], placed[3 * v + 2], sums[v] / (counts[v] || 1), ...SHARES_OF_CORNER[i % 3], colour, 0);
  }
  return { placed, buffer: data.buffer };
}

function drawPart() {
  if (!now.shape) return;
  try {
    now.view ??= { picture: new Picture(canvas), camera: new Camera(), waiting: false };
  } catch (error) {
    byId("empty").hidden = false;
    byId("empty").firstChild.textContent = error.message;
    return;
  }
  const { picture, camera } = now.view, { placed, buffer } = partVertices(now.shape);
  picture.fill(picture.solid, buffer);
  picture.onRestored = drawPart;
  now.view.placed = placed;
  camera.look(START.back, START.up);
  frame();
  redraw();
}
/** So near that the part just fills the picture. */
function frame() {
  const { camera, placed } = now.view, tangent = tangentOf(canvas), ROOM = 0.88;
  camera.frame(placed, [((tangent * canvas.clientWidth) / Math.max(1, canvas.clientHeight)) * ROOM, tangent * ROOM]);
}
function redraw() {
  const { view } = now;
  if (!view || view.waiting) return;
  view.waiting = true;
  requestAnimationFrame(() => {
    view.waiting = false;
    if (canvas.clientWidth === 0) return;
    const background = [...getComputedStyle(document.documentElement).getPropertyValue("--canvas").trim().split(/\s+/).map((c) => Number(c) / 255), 1];
    view.picture.fit();
    view.picture.draw(view.camera, { edges: true, background, plane: [0, 0, 0, 1] });
  });
}

function listenToPicture() {
  followPointers(canvas, () => now.view?.camera, redraw);
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }, zooms = { "+": 0.85, "=": 0.85, "-": 1 / 0.85 };
    if (!now.view || event.ctrlKey || event.metaKey || event.altKey) return;
    if (turns[event.key]) now.view.camera.turn(...turns[event.key].map((t) => 0.12 * t));
    else if (zooms[event.key]) now.view.camera.zoom(zooms[event.key]);
    else if (event.key === "0") drawPart();
    else return;
    event.preventDefault();
    redraw();
  });
  new ResizeObserver(() => {
    if (now.view && canvas.clientWidth > 0) frame();
    redraw();
  }).observe(canvas);
}

// --- options

const chosenBy = () => document.querySelector("[name=by]:checked").value;
const factor = () => 2 ** (-byId("fineness").value / 5);

/** Those that differ from what the library does by itself. */
function chosenOptions() {
  const options = {};
  const by = chosenBy();
  if (by !== "auto") {
    const value = Number(byId(by).value);
    if (!(value > 0)) throw new Error(by === "size" ? "the edge length is a number above 0" : "the number of elements is at least 1");
    options[by] = by === "elements" ? Math.round(value) : value;
  } else if (factor() !== 1) options.automatic_factor = Number(factor().toPrecision(3));
  if (byId("order").value === "2") options.order = 2;
  if (byId("patches").checked) options.patches = true;
  for (const field of byId("options").querySelectorAll("[data-option]")) {
    const { option, kind } = field.dataset;
    if (kind === "flag") {
      if (field.checked !== (field.dataset.usual === "true")) options[option] = field.checked;
    } else if (field.value !== "") options[option] = kind === "number" || kind === "whole" ? Number(field.value) : field.value;
  }
  return options;
}

/** As the command line writes them. */
const commandOf = (names, options, target) => ["octafront mesh", ...names.map(quoted), "-o", quoted(target), ...Object.entries(options).map(([name, value]) => {
  const flag = "--" + name.replaceAll("_", "-");
  return value === true ? flag : `${flag} ${quoted(String(value))}`;
})].join(" ");
const quoted = (text) => (/^[\w./+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

const SHOWN_ELSEWHERE = new Set(["size", "elements", "automatic_factor", "order", "patches"]);
function optionRow({ name, kind, choices, default: usual, help }) {
  const common = { "data-option": name, "data-kind": kind, title: help, id: "option-" + name, onchange: foresee };
  const title = make("label", { for: "option-" + name, title: help }, name.replaceAll("_", " "));
  if (kind === "flag") return make("div", { class: "row" }, title, make("span", {}, make("input", { ...common, type: "checkbox", checked: usual === true, "data-usual": String(usual === true) })));
  if (kind === "choice") return make("div", { class: "row" }, title, make("select", common, make("option", { value: "" }, usual ?? "automatic"), ...choices.filter((c) => c !== usual).map((c) => make("option", { value: c }, c))));
  const isNumber = kind === "number" || kind === "whole";
  return make("div", { class: "row" }, title, make("input", { ...common, type: isNumber ? "number" : "text", step: kind === "whole" ? "1" : "any", placeholder: usual === null || usual === "" ? "automatic" : String(usual) }));
}
function listOptions(options) {
  const rows = options.filter((o) => o.tasks.split(" ").includes("mesh") && !SHOWN_ELSEWHERE.has(o.name));
  const groups = [...new Set(rows.map((o) => o.group))];
  byId("options").replaceChildren(...groups.flatMap((group) => [make("h3", {}, group), ...rows.filter((o) => o.group === group).map(optionRow)]));
}
function showFineness() {
  for (const by of ["auto", "elements", "size"]) byId("by-" + by).hidden = chosenBy() !== by;
  byId("fineness-text").textContent = "× " + digits(factor(), 2);
}

/** What the options come to, a moment after the last change. */
let foreseeing = 0;
function foresee() {
  showFineness();
  const mine = ++foreseeing;
  const box = byId("estimate");
  if (!now.part || now.shape.triangles.length / 3 > MOST_FORESEEN) return (box.textContent = "");
  const { part } = now;
  setTimeout(async () => {
    if (mine !== foreseeing || now.work || now.part !== part) return;
    let report;
    try {
      box.textContent = "…";
      report = await part.estimate(chosenOptions());
    } catch (error) {
      if (mine === foreseeing && now.part === part) box.textContent = shown(error.message);
      return;
    }
    if (mine !== foreseeing) return;
    const sizes = (report.stages ?? []).map((stage) => stage.counters ?? {}).find((counters) => "smallest size" in counters);
    box.textContent = (report.expected_tets ? `about ${grouped(Number(report.expected_tets.toPrecision(2)))} elements` : "") +
      (sizes ? `, edges ${digits(sizes["smallest size"], 3)} to ${digits(sizes["largest size"], 3)}` : "");
  }, 350);
}

// --- the mesh

function dropMesh() {
  now.mesh?.close();
  now.mesh = null;
  byId("step-save").hidden = true;
  byId("report").hidden = true;
  byId("report").srcdoc = "";
}

async function makeMesh() {
  let options;
  try {
    options = chosenOptions();
  } catch (error) {
    return complain(error);
  }
  ++foreseeing;
  byId("estimate").textContent = "";
  const begun = performance.now();
  const result = await work("meshing", async (given) => {
    const mesh = await now.part.mesh(options, given);
    try {
      given.progress("packing the picture", null);
      const about = { inputs: now.names, options: undefined, command_line: commandOf(now.names, options, "mesh.msh") };
      return { mesh, page: new TextDecoder().decode(await mesh.page(about, given)) };
    } catch (error) {
      mesh.close();
      throw error;
    }
  });
  if (!result) return;
  dropMesh();
  now.mesh = result.mesh;
  now.page = result.page;
  showMesh((performance.now() - begun) / 1000);
}

function showMesh(took) {
  const { report } = now.mesh, quality = report.quality ?? {};
  byId("made").replaceChildren(make("b", {}, `${grouped(report.tets)} elements`), ` in ${seconds(took)} s; mean β ${quality.beta_mean?.toFixed(3)}, dihedral angles ${quality.dihedral_min_degrees?.toFixed(1)}° to ${quality.dihedral_max_degrees?.toFixed(1)}°`);
  byId("step-save").hidden = false;
  byId("notes").replaceChildren();
  const frame = byId("report");
  frame.hidden = false;
  frame.onload = () => {
    passTheme();
    performance.measure("mesh shown", { start: 0, end: performance.now() });
  };
  frame.srcdoc = now.page;
  showTab("stage");
}

/** Gives bytes to the user as a file. */
function download(name, parts, type = "application/octet-stream") {
  const link = make("a", { href: URL.createObjectURL(new Blob(parts, { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  now.saved = { name, bytes: parts.reduce((sum, part) => sum + (part.length ?? 0), 0) };
}
const stem = () => (now.names[0] ?? "mesh").replace(/(\.nii)?\.[^.]*$/, "");

/** Gmsh's older format is known by its content; OpenFOAM has a folder. */
const endingOf = ({ name, endings }) => (name === "msh22" ? ".msh" : endings.split(" ")[0]);
const BOUNDARY = new Set(["stl", "obj", "off", "ply"]);

async function save() {
  const format = now.info.formats.find((f) => f.name === byId("format").value), name = stem() + endingOf(format);
  const written = await work("writing", (given) => now.mesh.write(name, { format: format.name, ascii: byId("ascii").checked, cells_only: byId("cells").checked }, given));
  if (!written) return;
  byId("notes").replaceChildren(...written.notes.map((note) => make("li", {}, shown(note))));
  if (written.files.length === 1) download(written.files[0].name, [written.files[0].data]);
  else download(stem() + "-" + format.name + ".zip", zipOf(written.files), "application/zip");
}

// --- the page around it

function showTab(tab) {
  document.querySelector("main").dataset.tab = tab;
  for (const button of document.querySelectorAll("[data-show]")) button.setAttribute("aria-current", String(button.dataset.show === tab));
  redraw();
}
function passTheme() {
  const root = byId("report").contentDocument?.documentElement, { theme } = document.documentElement.dataset;
  root?.querySelector("#theme")?.setAttribute("hidden", ""); // one is enough
  if (!root || !theme) return;
  root.dataset.theme = theme;
  const inside = byId("report").contentWindow.octafront;
  if (inside?.mesh) inside.draw();
}
function listenToTheme() {
  const root = document.documentElement;
  const dark = () => (root.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  byId("theme").addEventListener("click", () => {
    root.dataset.theme = dark() ? "light" : "dark";
    passTheme();
    drawPart();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawPart);
}

/** Files are taken wherever they are dropped. */
function listenToFiles() {
  byId("files").addEventListener("change", (event) => {
    const files = [...event.target.files];
    event.target.value = ""; // the same file may be chosen again
    openPart(files);
  });
  const over = (on) => (event) => {
    event.preventDefault();
    document.body.classList.toggle("over", on);
  };
  addEventListener("dragover", over(true));
  addEventListener("dragleave", over(false));
  addEventListener("drop", (event) => {
    over(false)(event);
    openPart([...event.dataTransfer.files]);
  });
  for (const element of document.querySelectorAll("[id^=packed-sample-]")) {
    const file = element.dataset.file;
    let data = null;
    byId("samples").append(make("button", { type: "button", onclick: async () => openPart([{ name: file, data: (data ??= await unpacked(element.id)) }]) }, element.dataset.title), " ");
  }
}

function listenToControls() {
  byId("cancel").addEventListener("click", () => now.work?.stop.abort());
  byId("go").addEventListener("click", makeMesh);
  byId("save").addEventListener("click", save);
  byId("save-page").addEventListener("click", () => download(stem() + ".html", [new TextEncoder().encode(now.page)], "text/html"));
  for (const radio of document.querySelectorAll("[name=by]")) radio.addEventListener("change", foresee);
  for (const id of ["fineness", "elements", "size", "order", "patches"]) byId(id).addEventListener("input", foresee);
  for (const button of document.querySelectorAll("[data-show]")) button.addEventListener("click", () => showTab(button.dataset.show));
}

async function start() {
  listenToTheme();
  listenToPicture();
  listenToFiles();
  listenToControls();
  showFineness();
  showTab("setup");
  try {
    now.info = await engine.info();
  } catch (error) {
    return complain(typeof DecompressionStream === "undefined" ? new Error("this page needs a browser of 2023 or later") : error);
  }
  byId("version").textContent = now.info.version;
  listOptions(now.info.options);
  const writable = now.info.formats.filter((format) => format.writes_mesh), of = (wanted) => writable.filter((format) => BOUNDARY.has(format.name) === wanted);
  const option = (format) => make("option", { value: format.name }, `${format.title} (${endingOf(format) || "folder"})`);
  byId("format").replaceChildren(make("optgroup", { label: "elements" }, ...of(false).map(option)), make("optgroup", { label: "the boundary alone" }, ...of(true).map(option)));
  byId("format").value = "msh";
  performance.measure("ready", { start: 0, end: performance.now() });
}

// For programs that test the page.
window.octafront = { now, engine, openPart, chosenOptions };
start();
