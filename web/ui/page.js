// --- page.js: the workbench: a part comes in, faces of it are picked, it is meshed, looked at and saved. Colours, camera, the
// faces of a mesh and little helpers are those of the report page (src/report/page/assets), drawing is in stage.js.

const byId = (id) => document.getElementById(id);
const canvas = byId("canvas");

/** The whole state, but for the job, which can be undone. */
const now = { about: null, inputs: [], info: null, surface: null, mesh: null, page: null, made: null, work: null, picked: new Map(), hovered: null, worst: -1 };
let history = new History(NO_JOB), stage = null;
const look = { quantity: "patch", clip: { on: false, smooth: false, normal: [1, 0, 0], offset: 0, axis: "x" }, hiddenPatches: new Set(), hiddenRegions: new Set(), filter: null, selected: -1 };
const MOST_FORESEEN = 300000; // triangles up to which elements are foreseen unasked
const MOST_SHOWN = 6e6; // elements beyond which the mesh is made and saved, but not shown

const inputNames = () => now.inputs.map((file) => file.name);
const inputPaths = () => now.inputs.map((file) => file.path);
const isCad = () => now.info?.kind === "CAD" || now.info?.cad_patches !== undefined;
const isMesh = () => now.info?.kind === "mesh";
const chosen = (name) => document.querySelector(`[name=${name}]:checked`).value;
const stem = () => (inputNames()[0] ?? "mesh").replace(/(\.nii)?\.[^.]*$/, "");

// --- work: one thing at a time, which can be cancelled

function complain(error) {
  const box = byId("trouble");
  box.hidden = !error;
  if (!error) return;
  const defects = error.report?.defects, advice = (error.next ?? []).slice(0, 1).map((next) => `\nNext: ${next.why}`);
  box.textContent = shown(error.message).replaceAll("\\x0a", "\n") + (defects?.described ? "\n" + shown(defects.described) : "") + advice.map(shown).join("").replaceAll("\\x0a", "\n");
  box.scrollIntoView({ block: "nearest" });
}

/** Runs `task(given)` after ending what is going on; its result, or null if it failed or was cancelled. */
async function work(title, task) {
  const before = now.work;
  before?.stop.abort();
  const mine = (now.work = { stop: new AbortController() }), begun = performance.now();
  await before?.done;
  let finished;
  mine.done = new Promise((done) => (finished = done));
  complain(null);
  let said = title, fraction = null;
  const tick = () => {
    if (now.work !== mine) return;
    byId("busy-text").textContent = `${said} · ${seconds((performance.now() - begun) / 1000)} s`;
    if (fraction === null) byId("progress").removeAttribute("value");
    else byId("progress").value = fraction;
  };
  const timer = setInterval(tick, 200);
  byId("busy").hidden = false;
  tick();
  try {
    return await task({ signal: mine.stop.signal, progress: (name, part) => ((said = name), (fraction = part), tick()) });
  } catch (error) {
    if (!mine.stop.signal.aborted) complain(error);
    return null;
  } finally {
    clearInterval(timer);
    finished();
    if (now.work === mine) {
      now.work = null;
      byId("busy").hidden = true;
    }
  }
}

// --- the part

async function openFiles(files) {
  if (files.length === 0) return;
  const inputs = await work("bringing the files", () => Promise.all(files.map((file) => engine.upload(file))));
  if (inputs) await openPart(inputs);
}

async function openPart(inputs) {
  const opened = await work("reading", async (given) => {
    const info = (await engine.run("info", { input: inputs[0].path }, given)).reports[0];
    if (info.triangles > MOST_TRIANGLES) throw tooLarge();
    return info.kind === "mesh" ? { info } : { info, surface: await readInput(inputs, {}, given) };
  });
  if (!opened) return;
  Object.assign(now, { inputs, info: opened.info, surface: null });
  history = new History(NO_JOB);
  now.picked.clear();
  dropMesh();
  stage?.clear();
  byId("empty").hidden = true;
  byId("setup").hidden = isMesh();
  document.title = "Octafront: " + shown(inputNames().join(" + "));
  if (isMesh()) return lookAtFile();
  takeSurface(opened.surface);
  showJob();
}

/** The input's triangles, with the patches that options name. */
async function readInput(inputs, options, given) {
  const left = await engine.run("surface", { input: inputs.map((file) => file.path), output: "input.ply", options: { ...options, "keep-surface": true, patches: true } }, given);
  return surfaceOf(left, "input.ply", given);
}
async function surfaceOf(left, name, { signal }) {
  const file = left.files.find((one) => one.name === name), MOST_BYTES = 50 * MOST_TRIANGLES;
  if (file.bytes > MOST_BYTES) throw tooLarge();
  const surface = readSurface(await (await engine.made(left.run, name, { signal })).arrayBuffer());
  return { ...surface, report: left.reports[0] };
}
const tooLarge = () => new Error(`the surface has more than ${grouped(MOST_TRIANGLES)} triangles: more than a page can show. \`octafront mesh\` takes it; \`octafront picture\` draws it.`);

function takeSurface(surface) {
  now.surface = surface;
  // Of one region the file with the surface says nothing.
  if (surface.regions.length === 1) surface.regions = [now.info.places?.regions?.[0] ?? "body"];
  now.colours = surface.patches.map((_, i) => paletteColour(i));
  try {
    stage ??= startStage();
    stage?.showInput(surface);
  } catch (error) {
    complain(error);
  }
  showPart();
  for (const id of ["step-look", "step-repeat"]) byId(id).hidden = false;
  listPlaces();
  listQuantities();
  showWhat("input");
}

function showPart() {
  const { info, surface } = now, low = [0, 1, 2].map((k) => extreme(surface.points, k, Math.min)), high = [0, 1, 2].map((k) => extreme(surface.points, k, Math.max));
  const unit = info.lengths ?? info.unit ?? "";
  const rows = [["extent", high.map((h, k) => digits(h - low[k])).join(" × ") + (unit ? " " + shown(unit) : "")],
    [isCad() ? "faces" : "triangles", grouped(isCad() ? surface.patches.length : surface.patch.length)]];
  if (surface.report.input_volume ?? surface.report.volume) rows.push(["volume", digits(surface.report.input_volume ?? surface.report.volume, 5)]);
  if (surface.regions.length > 1) rows.push(["regions", String(surface.regions.length)]);
  const notes = [...(info.notes ?? []), ...(surface.report.stages ?? []).flatMap((s) => s.notes ?? [])].filter((note) => typeof note === "string");
  byId("part").replaceChildren(name(inputNames().join(" + ")), table(rows, null, "pairs"),
    notes.length ? make("details", {}, make("summary", {}, `${notes.length} note${notes.length > 1 ? "s" : ""}`), make("ul", { class: "hint" }, ...notes.map((note) => make("li", {}, shown(note))))) : "");
}
function extreme(points, k, of) {
  let found = points[k];
  for (let i = k; i < points.length; i += 3) found = of(found, points[i]);
  return found;
}

// --- picking

/** Names of edges: the patches that meet there, as options call them. */
function edgeOf({ patches: [a, b] }) {
  if (a === b) return null;
  const both = [now.surface.patches[a], now.surface.patches[b]].sort();
  return both.join(both.some((name) => name.includes("|")) ? " + " : "|");
}
function placesOfKind(kind) {
  const { surface } = now;
  if (kind === "face") return surface.patches.map((name, i) => ({ kind, name, colour: now.colours[i], count: faceCounts()[i] })).filter((place) => place.count > 0);
  if (kind === "set") return (now.info.places?.sets ?? []).map((name) => ({ kind, name })); // of CAD: what has a colour, a layer
  if (kind === "region") return surface.regions.map((name, i) => ({ kind, name, colour: paletteColour(i) }));
  const edges = new Set((stage?.borders ?? bordersOf(surface)).lines.map(edgeOf).filter(Boolean));
  return [...edges].sort((a, b) => a.localeCompare(b, "en", { numeric: true })).map((name) => ({ kind, name }));
}
const faceCounts = () => (now.surface.counts ??= countsOf(now.surface.patch, now.surface.patches.length));

function listPlaces() {
  const MOST = 400, wanted = byId("search").value.toLowerCase();
  const all = placesOfKind(chosen("kind")).filter((place) => place.name.toLowerCase().includes(wanted));
  const shapes = new Map((now.info.cad_patches ?? []).map((patch) => [patch.name, patch.shape]));
  const row = (place) => make("label", { class: "place", "data-key": keyOf(place), onmouseenter: () => hover(place), onmouseleave: () => hover(null) },
    make("input", { type: "checkbox", checked: now.picked.has(keyOf(place)), onchange: () => toggle([place]) }),
    make("span", { class: "swatch", style: place.colour ? `background:${css(place.colour)}` : "visibility:hidden" }), name(place.name), make("small", {}, shapes.get(place.name) ?? ""));
  byId("places").replaceChildren(...all.slice(0, MOST).map(row), ...(all.length > MOST ? [make("p", { class: "hint" }, `${grouped(all.length - MOST)} more: find them by name`)] : []));
  byId("spread-row").hidden = chosen("kind") !== "face";
  byId("kind-set").hidden = !now.info.places?.sets?.length;
}

/** Picks places, or lets them go if all are picked. */
function toggle(places) {
  const all = places.every((place) => now.picked.has(keyOf(place)));
  for (const { kind, name } of places) all ? now.picked.delete(keyOf({ kind, name })) : now.picked.set(keyOf({ kind, name }), { kind, name });
  showPicked();
}
function showPicked() {
  for (const row of byId("places").querySelectorAll("[data-key]")) row.querySelector("input").checked = now.picked.has(row.dataset.key);
  const names = [...now.picked.values()].map((place) => place.name);
  byId("picked").textContent = names.length === 0 ? "Click on the part, or in the list." : `picked: ${brief(names.map(shown).join(", "), 160)}`;
  for (const id of ["do-name", "do-size", "do-walls", "do-clear"]) byId(id).disabled = names.length === 0;
  byId("do-pair").disabled = names.length !== 2 || picks().some((place) => place.kind !== "face");
  paint();
}
function hover(place) {
  if (keyOf(place ?? {}) === keyOf(now.hovered ?? {})) return;
  now.hovered = place;
  byId("hover").hidden = !place;
  byId("hover").textContent = place ? shown(place.name) : "";
  paint();
}

/** What is at a place in the picture: places to pick. */
function placesAt(x, y, spreads) {
  const kind = chosen("kind"), { surface } = now;
  if (kind === "set") return [];
  if (kind === "edge") {
    const line = stage.lineAt(x, y), edge = line && edgeOf(line);
    return edge ? [{ kind, name: edge }] : [];
  }
  const t = stage.inputAt(x, y);
  if (t === null) return [];
  if (kind === "region") {
    const [front, back] = [surface.sides[2 * t], surface.sides[2 * t + 1]], region = back >= 0 ? back : front;
    return region >= 0 ? [{ kind, name: surface.regions[region] }] : [];
  }
  const degrees = spreads ? Number(byId("spread").value) : 0, start = surface.patch[t];
  return (degrees > 0 ? spreadOver(start, stage.borders, degrees) : [start]).map((patch) => ({ kind, name: surface.patches[patch] }));
}

const colourOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim().split(/\s+/).map(Number);
function paint() {
  const { surface } = now;
  if (!stage?.input) return;
  const pick = colourOf("--pick"), ink = colourOf("--ink"), mixed = (a, b, s) => a.map((x, i) => Math.round(x + s * (b[i] - x)));
  const has = (kind, name) => now.picked.has(keyOf({ kind, name })), isHovered = (kind, name) => now.hovered?.kind === kind && now.hovered.name === name;
  const tinted = (colour, kind, name) => (has(kind, name) ? mixed(colour, pick, 0.85) : isHovered(kind, name) ? mixed(colour, pick, 0.4) : mixed(colour, [225, 228, 232], now.picked.size ? 0.55 : 0.25));
  const byRegion = look.quantity === "region" || chosen("kind") === "region";
  const faces = surface.patches.map((name, i) => tinted(now.colours[i], "face", name)), regions = surface.regions.map((name, i) => tinted(paletteColour(i), "region", name));
  const lines = new Map();
  const inkOfEdge = (edge) => (edge && has("edge", edge) ? pick : edge && isHovered("edge", edge) ? mixed(ink, pick, 0.6) : ink);
  stage.paint((t) => (byRegion ? regions[Math.max(surface.sides[2 * t + 1], surface.sides[2 * t], 0)] ?? [200, 200, 200] : faces[surface.patch[t]]), (line) => {
    const key = pairOf(...line.patches);
    if (!lines.has(key)) lines.set(key, inkOfEdge(edgeOf(line)));
    return lines.get(key);
  });
}

// --- the job

function change(parts) {
  history.change(parts);
  showJob();
}
const without = (list, i) => list.filter((_, k) => k !== i);
const picks = () => [...now.picked.values()];

function nameIt() {
  const text = byId("name").value.trim();
  if (!text || text.includes("=")) return complain(new Error("a name has a character at least, and no ="));
  complain(null);
  byId("name").value = "";
  change({ names: [...history.now.names.filter((given) => given.name !== text), { name: text, places: picks() }] });
}
function sizeIt() {
  try {
    positive(byId("local-size").value, "an edge length");
  } catch (error) {
    return complain(error);
  }
  complain(null);
  change({ sizes: [...history.now.sizes, { places: picks(), size: byId("local-size").value }] });
}
function layersThere() {
  if (picks().some((place) => place.kind === "edge" || place.kind === "set")) return complain(new Error("layers grow on faces and around regions, not on edges and sets"));
  complain(null);
  const known = new Set(history.now.walls.map(keyOf));
  change({ walls: [...history.now.walls, ...picks().filter((place) => !known.has(keyOf(place)))] });
}

/** The way from one face to the other, by the middles of their boxes; as exact as pairs have to be. */
function pairThem() {
  const places = picks(), middles = places.map((place) => middleOfPatch(now.surface.patches.indexOf(place.name)));
  const LEAST = 1e-7 * radiusOf(now.surface.points), by = [0, 1, 2].map((i) => middles[1][i] - middles[0][i]).map((x) => (Math.abs(x) < LEAST ? 0 : Number(x.toPrecision(8))));
  change({ pairs: [...history.now.pairs, { places, by }] });
}
function middleOfPatch(number) {
  const { points, triangles, patch } = now.surface, low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < 3 * triangles.length; ++i) {
    const side = Math.floor(i / 3), axis = i % 3;
    if (patch[Math.floor(side / 3)] !== number) continue;
    const x = points[3 * triangles[side] + axis];
    low[axis] = Math.min(low[axis], x);
    high[axis] = Math.max(high[axis], x);
  }
  return low.map((l, axis) => (l + high[axis]) / 2);
}

/** Shows what is set, in all places of the page. */
function showJob() {
  const job = history.now, entry = (text, places, next) => make("li", {},
    make("button", { type: "button", title: "pick these", onclick: () => (now.picked = new Map(places.map((place) => [keyOf(place), place])), showPicked()) }, brief(shown(text), 90)),
    make("button", { type: "button", "aria-label": `remove ${shown(text)}`, onclick: () => change(next) }, "×"));
  const listed = (places) => places.map((place) => place.name).join(", ");
  byId("job").replaceChildren(...job.names.map((given, i) => entry(`${given.name}: ${listed(given.places)}`, given.places, { names: without(job.names, i) })),
    ...job.sizes.map((given, i) => entry(`size ${given.size}: ${listed(given.places)}`, given.places, { sizes: without(job.sizes, i) })),
    ...job.pairs.map((given, i) => entry(`pair: ${listed(given.places)}`, given.places, { pairs: without(job.pairs, i) })),
    ...(job.walls.length ? [entry(`layers: ${listed(job.walls)}`, job.walls, { walls: [] })] : []));
  document.querySelector(`[name=by][value=${job.by}]`).checked = true;
  for (const row of document.querySelectorAll("[data-by]")) row.hidden = row.dataset.by !== job.by;
  for (const [id, value] of [["finer", String(job.finer)], ["elements", job.elements], ["size", job.size], ["order", job.order], ["layers-n", job.layers.n], ["layers-first", job.layers.first], ["layers-growth", job.layers.growth]]) if (byId(id) !== document.activeElement || byId(id).value !== value) byId(id).value = value;
  byId("layers").hidden = job.walls.length === 0;
  byId("patches-row").hidden = isCad();
  byId("patches").checked = job.patches;
  for (const field of byId("options").querySelectorAll("[data-option]")) {
    const value = job.more[field.dataset.option];
    if (field.type === "checkbox") field.checked = value === true;
    else field.value = value === undefined ? "" : [value].flat().join("; ");
  }
  byId("undo").disabled = !history.canUndo;
  byId("redo").disabled = !history.canRedo;
  showRepeat();
  showPicked();
  foresee();
}
function step(by) {
  history.go(by);
  showJob();
}

function showRepeat() {
  const write = { command: asCommand, python: asPython, json: asJson }[chosen("language")];
  try {
    byId("repeat").textContent = shown(write(inputNames(), optionsOf(history.now, isCad()), targetName())).replaceAll("\\x0a", "\n");
  } catch (error) {
    byId("repeat").textContent = error.message;
  }
}

function listOptions() {
  const ELSEWHERE = new Set(["size", "elements", "automatic-factor", "order", "patches", "size-of", "layers", "on", "first", "first-part", "growth", "group", "output", "format", "json", "quiet", "dry-run", "threads", "memory", "max-elements", "cpu-seconds", "within", "report", "ascii", "cells-only"]);
  const REPEATED = /may be repeated|in turn/;
  const row = ([option, { description, const: flag, anyOf, title }]) => {
    const id = "option-" + option, set = (value) => {
      const more = { ...history.now.more };
      if (value === "" || value === false) delete more[option];
      else more[option] = REPEATED.test(description) && String(value).includes(";") ? value.split(";").map((one) => one.trim()) : value;
      change({ more });
      if ("feature-angle" === option || "repair" === option) reread();
    };
    const common = { id, "data-option": option, title: description };
    const field = flag ? make("input", { ...common, type: "checkbox", onchange: (event) => set(event.target.checked) })
      : anyOf ? make("select", { ...common, onchange: (event) => set(event.target.value) }, make("option", { value: "" }, ""), ...anyOf[0].enum.map((choice) => make("option", { value: choice }, choice)))
        : make("input", { ...common, type: "text", onchange: (event) => set(event.target.value.trim()) });
    return make("div", { class: "row", "data-words": `${option} ${title} ${description}`.toLowerCase() }, make("label", { for: id, title: description }, option.replaceAll("-", " ")), make("span", {}, field));
  };
  const rows = Object.entries(now.about.options).filter(([option]) => !ELSEWHERE.has(option)), groups = [...new Set(rows.map(([, about]) => about.title))];
  byId("options").replaceChildren(...groups.flatMap((group) => [make("h3", {}, group), ...rows.filter(([, about]) => about.title === group).map(row)]));
}
function findOption() {
  const wanted = byId("find-option").value.toLowerCase();
  for (const row of byId("options").children) row.hidden = row.dataset.words ? !row.dataset.words.includes(wanted) : wanted !== "";
}

/** Other options may part the surface otherwise. */
async function reread() {
  const surface = await work("reading", (given) => readInput(now.inputs, optionsOfInput(history.now), given));
  if (surface) takeSurface(surface);
  showPicked();
}

// --- what it will take

let foreseeing = null; // null: what is shown holds
function foresee() {
  foreseeing?.abort();
  const mine = (foreseeing = new AbortController()), box = byId("estimate");
  if (!now.surface || now.surface.patch.length > MOST_FORESEEN) return box.replaceChildren();
  const PAUSE = 500; // milliseconds after the last change
  setTimeout(async () => {
    if (mine.signal.aborted || now.work) return;
    try {
      box.setAttribute("aria-busy", "true");
      const plan = await engine.run("plan", { input: inputPaths(), options: optionsOf(history.now, isCad()) }, { signal: mine.signal });
      showPlan(plan);
    } catch (error) {
      if (!mine.signal.aborted) box.textContent = brief(shown(error.message), 300);
    }
    box.removeAttribute("aria-busy");
    if (foreseeing === mine) foreseeing = null;
  }, PAUSE);
}
/** Of options that were changed since nothing is known. */
function dropForesight() {
  if (!foreseeing) return;
  foreseeing.abort();
  foreseeing = now.expected = null;
  byId("estimate").replaceChildren();
}
function showPlan({ reports: [report], sources = [] }) {
  const { expected_tets: tets, seconds: time, memory_bytes: memory, smallest_size: least, largest_size: most } = report.dry_run;
  now.expected = tets;
  const MOST = 5, row = ({ source, percent_of_elements: part }) => make("tr", {}, make("td", {}, shown(source)), make("td", { style: "width:30%" }, make("i", { style: `width:${part}%` })), make("td", {}, `${part.toFixed(0)} %`));
  byId("estimate").replaceChildren(make("p", {}, make("b", {}, `about ${grouped(Number(tets.toPrecision(2)))} elements`), `, edges ${digits(least, 3)} to ${digits(most, 3)}${time ? `, ${seconds(time)} s` : ""}, ${bytesInWords(memory)}`),
    make("table", {}, make("tbody", {}, ...sources.slice(0, MOST).filter((s) => s.percent_of_elements >= 0.5).map(row))));
}

/** The surface as it will be divided: what the sizes look like. */
async function seeSizes() {
  const surface = await work("dividing the surface", async (given) => {
    const { layers, on, first, "first-part": part, growth, order, ...options } = optionsOf(history.now, isCad());
    const known = Object.fromEntries(Object.entries(options).filter(([option]) => option !== "group"));
    return surfaceOf(await engine.run("surface", { input: inputPaths(), output: "sizes.ply", options: known }, given), "sizes.ply", given);
  });
  if (!surface || !stage) return;
  showWhat("input");
  stage.showPreview(surface, (patch) => paletteColour(Math.max(0, now.surface.patches.indexOf(surface.patches[patch]))));
}

// --- the mesh

function dropMesh() {
  Object.assign(now, { mesh: null, page: null, made: null, worst: -1 });
  look.selected = -1;
  for (const id of ["step-save", "of-mesh", "shown", "element"]) byId(id).hidden = true;
}

async function makeMesh() {
  const made = await work("meshing", async (given) => {
    dropForesight();
    const options = optionsOf(history.now, isCad()), isShown = !(now.expected > MOST_SHOWN);
    const left = await engine.run("mesh", { input: inputPaths(), output: "mesh.msh", options: { ...options, ...(isShown ? { report: "report.html" } : {}) } }, given);
    return takeMesh(left, given, asCommand(inputNames(), options, targetName()));
  });
  if (made) showMesh(made);
}
/** A mesh that is a file already. */
async function lookAtFile() {
  const made = await work("reading", async (given) => {
    const left = await engine.run("report", { input: inputPaths()[0], output: "report.html" }, given);
    return { ...(await takeMesh(left, given)), file: now.inputs[0] };
  });
  byId("part").replaceChildren(name(inputNames()[0]));
  if (!made) return;
  try {
    stage ??= startStage();
  } catch (error) {
    complain(error);
  }
  byId("step-look").hidden = false;
  showMesh(made);
}
async function takeMesh(left, given, command = null) {
  given.progress?.("unpacking the mesh", null);
  const made = { run: left.run, report: left.reports[0], file: left.files.find((file) => file.name === "mesh.msh"), text: null, mesh: null };
  const written = left.files.find((file) => file.name === "report.html"), MOST_BYTES = 4e8;
  if (!written || written.bytes > MOST_BYTES) return made;
  made.text = await (await engine.made(left.run, "report.html", given)).text();
  const page = new DOMParser().parseFromString(made.text, "text/html");
  takeFacts(JSON.parse(page.getElementById("facts").textContent));
  // The job as it is written by hand, and files by their names: the folders of the run are nobody's.
  const told = page.getElementById("report").textContent, inJson = (text) => JSON.stringify(text).slice(1, -1), report = JSON.parse(told);
  const plain = now.inputs.reduce((text, { path, name }) => text.replaceAll(inJson(path), inJson(name)), JSON.stringify({ ...report, command_line: command ?? report.command_line }));
  made.report = JSON.parse(plain);
  made.text = made.text.replace(told, () => plain.replaceAll("<", "\\u003c"));
  made.mesh = await decodeMesh(page);
  return made;
}

function showMesh(made) {
  dropMesh();
  Object.assign(now, { made, mesh: made.mesh });
  const { report } = made, quality = report.quality ?? {};
  byId("made").replaceChildren(make("b", {}, `${grouped(report.tets)} elements`), report.wall_seconds ? ` in ${seconds(report.wall_seconds)} s` : "", quality.beta_mean ? `; mean β ${quality.beta_mean.toFixed(3)}, least ${quality.beta_min.toFixed(3)}` : "",
    made.mesh ? "" : ". That is more than a page can show; it can be saved.");
  byId("step-save").hidden = false;
  byId("save-page").hidden = !made.text;
  byId("notes").replaceChildren();
  if (!made.mesh || !stage) return;
  stage.showMesh(made.mesh);
  byId("step-look").scrollIntoView({ block: "start" });
  byId("shown").hidden = !now.surface;
  look.filter = null;
  byId("filter").checked = false;
  showNumbers();
  showWhat("mesh");
}
function showNumbers() {
  const { report } = now.made, notes = notesPanel(report, () => {});
  byId("numbers").replaceChildren(...[qualityPanel(report.quality, now.mesh), sizesPanel(report, now.mesh), notes].filter(Boolean));
  for (const panel of byId("numbers").children) panel.open = false;
}

// --- looking

function showWhat(what) {
  if (!stage) return;
  now.seen = what;
  document.querySelector(`[name=shown][value=${what}]`).checked = true;
  byId("of-mesh").hidden = what !== "mesh";
  hover(null);
  listQuantities();
  if (what === "mesh") refill();
  else stage.hidePreview();
  stage.show(what);
  stage.applyCut(look.clip);
  paint();
  byId("views").hidden = false;
}
function listQuantities() {
  const ofMesh = now.seen === "mesh" && now.mesh, regions = ofMesh ? now.mesh.facts.regions.length > 1 : now.surface?.regions.length > 1;
  const choices = [...(ofMesh ? Object.keys(QUANTITIES).filter((q) => now.mesh.values[q]) : []), ...(regions ? ["region"] : []), "patch"];
  byId("quantity").replaceChildren(...choices.map((q) => make("option", { value: q }, QUANTITIES[q]?.title ?? q)));
  if (!choices.includes(look.quantity)) look.quantity = choices[0];
  if (ofMesh && now.fresh !== now.mesh) (now.fresh = now.mesh), (look.quantity = choices[0]);
  byId("quantity").value = look.quantity;
  showLegend();
}
function showLegend() {
  const q = now.seen === "mesh" ? QUANTITIES[look.quantity] : null;
  byId("filter-row").hidden = !q;
  if (!q) return byId("legend").replaceChildren();
  const ends = endsOfColours(now.mesh, look.quantity).map((byte) => q.text(valueOf(now.mesh, look.quantity, byte)));
  byId("legend").replaceChildren(make("i", { style: `background:linear-gradient(to right, ${q.stops.join(", ")})` }), axis(...ends));
}
function refill() {
  if (!now.mesh || !stage) return;
  const passed = stage.fillMesh(look);
  stage.show(now.seen);
  if (!look.filter) return (byId("filter-text").textContent = "");
  const { quantity, low, high } = look.filter, text = (byte) => QUANTITIES[quantity].text(valueOf(now.mesh, quantity, byte));
  byId("filter-text").textContent = `${text(low)} to ${text(high)}: ${grouped(passed)} elements`;
}
function readFilter() {
  const on = byId("filter").checked && QUANTITIES[look.quantity] !== undefined, ends = [Number(byId("filter-low").value), Number(byId("filter-high").value)];
  look.filter = on ? { quantity: look.quantity, low: Math.min(...ends), high: Math.max(...ends) } : null;
  byId("filter-ends").hidden = !on;
  refill();
}

const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };
function setCut(parts) {
  if (!stage) return;
  const { clip } = look, [low, high] = stage.reachOf(clip.normal), share = clip.on ? (clip.offset - low) / (high - low || 1) : 0.5;
  Object.assign(clip, parts);
  if (parts.axis) {
    clip.on = true;
    clip.normal = dot(AXES[parts.axis], stage.camera.back) < 0 ? AXES[parts.axis].map((x) => -x) : AXES[parts.axis];
  }
  if (parts.share !== undefined || parts.axis || parts.on) {
    const reach = stage.reachOf(clip.normal), at = parts.share ?? share;
    clip.offset = reach[0] + at * (reach[1] - reach[0]);
  }
  showCut();
}
function flipCut() {
  Object.assign(look.clip, { normal: look.clip.normal.map((x) => -x), offset: -look.clip.offset });
  showCut();
}
function showCut() {
  const { clip } = look, [low, high] = stage.reachOf(clip.normal);
  byId("clip").checked = clip.on;
  byId("smooth").checked = clip.smooth;
  byId("clip-row").hidden = !clip.on;
  byId("clip-at").value = String(Math.round((1000 * (clip.offset - low)) / (high - low || 1)));
  for (const button of document.querySelectorAll("[data-axis]")) button.setAttribute("aria-pressed", String(button.dataset.axis === clip.axis));
  stage.applyCut(clip);
  if (now.seen === "mesh") refill();
}

/** The nth worst element: cut open there, near by. */
function goToWorst(by) {
  const worst = now.made?.report.worst_elements ?? [];
  if (worst.length === 0 || now.seen !== "mesh") return;
  now.worst = Math.min(worst.length - 1, Math.max(0, now.worst + by));
  const { number, beta } = worst[now.worst];
  byId("worst").textContent = `${now.worst + 1} of ${worst.length}: β ${beta.toFixed(3)}`;
  choose(number);
  const middle = stage.goTo(number);
  Object.assign(look.clip, { on: true, axis: "view", normal: [...stage.camera.back], offset: dot(stage.camera.back, middle) });
  showCut();
}
function choose(element) {
  look.selected = element;
  stage.mark(element, "#e0007c"); // no scale has it
  const box = byId("element");
  box.hidden = element < 0;
  if (element < 0) return;
  const { mesh, made } = now, known = (made.report.worst_elements ?? []).find((e) => e.number === element);
  const value = (q) => QUANTITIES[q].text(valueOf(mesh, q, mesh.values[q][element]));
  const rows = [["element", String(element)], ["β", known ? known.beta.toFixed(4) : value("beta")], ["dihedral angles", `${known ? known.dihedral_min_degrees.toFixed(1) + "°" : value("min_dihedral")} to ${known ? known.dihedral_max_degrees.toFixed(1) + "°" : value("max_dihedral")}`]];
  if (mesh.values.size_ratio) rows.push(["made over asked", value("size_ratio")]);
  if (known) rows.push(["middle", known.at.map((x) => digits(x)).join(", ")]);
  box.replaceChildren(table(rows, null, "pairs"), make("button", { type: "button", onclick: () => choose(-1) }, "close"));
}

// --- saving

const format = () => now.about.formats.find((f) => f.name === byId("format").value);
/** Some are known by their content alone; others have a folder. */
const BY_CONTENT = { msh22: ".msh", simnibs: ".msh", mfem: ".mesh" };
const endingOf = ({ name, endings }) => BY_CONTENT[name] ?? endings.split(" ")[0];
const targetName = () => stem() + (now.about ? endingOf(format()) : ".msh");

function download(name, blob) {
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
  now.saved = { name, bytes: blob.size };
}
async function save() {
  const as = format(), target = targetName();
  const left = await work("writing", async (given) => {
    const options = { format: as.name, ...(byId("ascii").checked ? { ascii: true } : {}), ...(byId("cells").checked ? { "cells-only": true } : {}) };
    const left = await engine.run("convert", { input: now.made.file.path, output: target, options }, given);
    return { ...left, data: await Promise.all(left.files.map(async (file) => ({ name: file.name, data: new Uint8Array(await (await engine.made(left.run, file.name)).arrayBuffer()) }))) };
  });
  if (!left) return;
  const notes = (left.reports[0].outputs ?? [left.reports[0].output]).flatMap((output) => output?.notes ?? []);
  byId("notes").replaceChildren(...notes.map((note) => make("li", {}, shown(note))));
  if (left.data.length === 1) download(left.data[0].name, new Blob([left.data[0].data]));
  else download(`${stem()}-${as.name}.zip`, new Blob(zipOf(left.data)));
}

// --- the page around it

function startStage() {
  const made = new Stage(canvas);
  followPointers(canvas, () => made.camera, () => made.redraw(), (x, y) => {
    if (now.seen === "mesh") return choose(made.elementAt(x, y));
    const places = placesAt(x, y, true);
    if (places.length) toggle(places);
  });
  listenToBoxes();
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons || event.pointerType !== "mouse" || now.seen !== "input" || !now.surface || now.surface.patch.length > MOST_FORESEEN) return;
    hover(placesAt(event.offsetX, event.offsetY, false)[0] ?? null);
  });
  canvas.addEventListener("pointerleave", () => hover(null));
  const VIEWS = { "+x": [[1, 0, 0], [0, 0, 1]], "+y": [[0, 1, 0], [0, 0, 1]], "+z": [[0, 0, 1], [0, 1, 0]], "−x": [[-1, 0, 0], [0, 0, 1]], "−y": [[0, -1, 0], [0, 0, 1]], "−z": [[0, 0, -1], [0, 1, 0]], all: [START.back, START.up] };
  byId("views").replaceChildren(...Object.entries(VIEWS).map(([view, where]) => make("button", { type: "button", "aria-label": `look from ${view}`, onclick: () => made.lookFrom(...where) }, view)));
  return made;
}

/** With Alt a rectangle is drawn, and all that is seen in it is picked: by samples, as fine as a hand draws. */
function listenToBoxes() {
  const SAMPLES = 24, box = byId("box");
  let from = null;
  const corners = ({ offsetX: x, offsetY: y }) => [Math.min(from[0], x), Math.min(from[1], y), Math.abs(x - from[0]), Math.abs(y - from[1])];
  const only = (does) => (event) => {
    if (!from && !(event.type === "pointerdown" && event.altKey && now.seen === "input" && now.surface)) return;
    event.stopImmediatePropagation();
    does(event);
  };
  canvas.addEventListener("pointerdown", only((event) => {
    from = [event.offsetX, event.offsetY];
    canvas.setPointerCapture(event.pointerId);
  }), true);
  canvas.addEventListener("pointermove", only((event) => {
    const [x, y, width, height] = corners(event);
    box.hidden = false;
    box.style.cssText = `left:${x}px;top:${y}px;width:${width}px;height:${height}px`;
  }), true);
  canvas.addEventListener("pointerup", only((event) => {
    const [x, y, width, height] = corners(event), found = new Map();
    from = null;
    box.hidden = true;
    for (let i = 0; i <= SAMPLES; ++i)
      for (let k = 0; k <= SAMPLES; ++k) for (const place of placesAt(x + (width * i) / SAMPLES, y + (height * k) / SAMPLES, false)) found.set(keyOf(place), place);
    for (const [key, place] of found) now.picked.set(key, place);
    showPicked();
  }), true);
  canvas.addEventListener("pointercancel", () => ((from = null), (box.hidden = true)));
}

function listenToKeys() {
  const STEP = 0.12, arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const nudge = (by) => setCut({ on: true, share: (Number(byId("clip-at").value) + 10 * by) / 1000 });
  const others = {
    "+": () => stage.camera.zoom(0.85), "=": () => stage.camera.zoom(0.85), "-": () => stage.camera.zoom(1 / 0.85), 0: () => stage.lookFrom(START.back, START.up), c: () => setCut({ on: !look.clip.on }), f: flipCut,
    x: () => setCut({ axis: "x" }), y: () => setCut({ axis: "y" }), z: () => setCut({ axis: "z" }), "[": () => nudge(-1), "]": () => nudge(1), e: () => byId("edges").click(),
    n: () => goToWorst(1), p: () => goToWorst(-1), Escape: () => (now.seen === "mesh" ? choose(-1) : (now.picked.clear(), showPicked())),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!stage || event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = arrows[event.key];
    if (arrow) event.shiftKey ? stage.camera.shift(-arrow[0] * STEP, -arrow[1] * STEP) : stage.camera.turn(arrow[0] * STEP, arrow[1] * STEP);
    else if (others[event.key]) others[event.key]();
    else return;
    event.preventDefault();
    stage.redraw();
  });
  addEventListener("keydown", (event) => {
    const isText = /^(text|search|number)$/.test(event.target.type ?? "");
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || isText) return;
    event.preventDefault();
    step(event.shiftKey ? 1 : -1);
  });
}

function listenToFiles() {
  byId("files").addEventListener("change", (event) => {
    const files = [...event.target.files];
    event.target.value = ""; // the same file may be chosen again
    openFiles(files);
  });
  const over = (on) => (event) => (event.preventDefault(), document.body.classList.toggle("over", on));
  addEventListener("dragover", over(true));
  addEventListener("dragleave", over(false));
  addEventListener("drop", (event) => (over(false)(event), openFiles([...event.dataTransfer.files])));
  byId("samples").hidden = engine.samples.length === 0;
  byId("samples").append(...engine.samples.map(({ title, file }) => make("button", { type: "button", onclick: async () => openFiles([await file()]) }, title)));
}

function listenToControls() {
  const on = (id, type, does) => byId(id).addEventListener(type, does), each = (selector, does) => document.querySelectorAll(selector).forEach((element) => element.addEventListener("change", does));
  for (const [id, does] of Object.entries({ undo: () => step(-1), redo: () => step(1), "do-name": nameIt, "do-size": sizeIt, "do-walls": layersThere, "do-pair": pairThem, "do-clear": () => (now.picked.clear(), showPicked()), preview: seeSizes, go: makeMesh, cancel: () => now.work?.stop.abort(),
    save, "save-page": () => download(stem() + ".html", new Blob([now.made.text])), flip: flipCut, worse: () => goToWorst(-1), next: () => goToWorst(1), copy: copyRepeat })) on(id, "click", does);
  on("search", "input", listPlaces);
  on("find-option", "input", findOption);
  on("name", "keydown", (event) => event.key === "Enter" && nameIt());
  on("local-size", "keydown", (event) => event.key === "Enter" && sizeIt());
  each("[name=kind]", () => (listPlaces(), paint()));
  each("[name=by]", () => change({ by: chosen("by") }));
  each("[name=shown]", () => showWhat(chosen("shown")));
  each("[name=language]", showRepeat);
  on("finer", "change", (event) => change({ finer: Number(event.target.value) }));
  on("patches", "change", (event) => change({ patches: event.target.checked }));
  for (const id of ["elements", "size", "order"]) on(id, "change", (event) => change({ [id]: event.target.value }));
  for (const [id, key] of [["layers-n", "n"], ["layers-first", "first"], ["layers-growth", "growth"]]) on(id, "change", (event) => change({ layers: { ...history.now.layers, [key]: event.target.value } }));
  on("quantity", "change", (event) => {
    look.quantity = event.target.value;
    showLegend();
    readFilter();
    paint();
  });
  on("clip", "change", (event) => setCut({ on: event.target.checked }));
  on("smooth", "change", (event) => setCut({ smooth: event.target.checked }));
  on("clip-at", "input", (event) => setCut({ share: event.target.value / 1000 }));
  on("edges", "change", (event) => stage && ((stage.uniforms.edges.value = event.target.checked ? 1 : 0), stage.redraw()));
  for (const button of document.querySelectorAll("[data-axis]")) button.addEventListener("click", () => setCut({ axis: button.dataset.axis }));
  for (const id of ["filter", "filter-low", "filter-high"]) on(id, "input", readFilter);
  on("format", "change", showRepeat);
}
async function copyRepeat() {
  try {
    await navigator.clipboard.writeText(byId("repeat").textContent);
    byId("copy").textContent = "Copied";
  } catch {
    getSelection().selectAllChildren(byId("repeat"));
    byId("copy").textContent = "Selected: copy it";
  }
  setTimeout(() => (byId("copy").textContent = "Copy"), 2000);
}

function listenToTheme() {
  const root = document.documentElement, redraw = () => (paint(), stage?.redraw());
  const dark = () => (root.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  byId("theme").addEventListener("click", () => ((root.dataset.theme = dark() ? "light" : "dark"), redraw()));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

async function start() {
  byId("takes").textContent = engine.takes;
  byId("where").textContent = engine.where;
  listenToTheme();
  listenToFiles();
  listenToControls();
  listenToKeys();
  engine.stay(() => complain(new Error("The program has ended: start `octafront ui` again. What was not saved is lost.")));
  try {
    now.about = await engine.about();
  } catch (error) {
    return complain(error);
  }
  byId("version").textContent = now.about.version;
  const SURFACES = new Set(["stl", "obj", "off", "ply"]), of = (wanted) => now.about.formats.filter((one) => SURFACES.has(one.name) === wanted);
  const option = (one) => make("option", { value: one.name }, `${one.title} (${endingOf(one) || "folder"})`);
  byId("format").replaceChildren(make("optgroup", { label: "elements" }, ...of(false).map(option)), make("optgroup", { label: "the boundary alone" }, ...of(true).map(option)));
  byId("format").value = "msh";
  listOptions();
  showPicked();
  if (now.about.file) await openPart([now.about.file]);
  performance.measure("ready", { start: 0, end: performance.now() });
}

// For programs that test the page.
window.octafront = { now, look, engine, get job() { return history.now; }, get stage() { return stage; }, openPart, placesAt };
start();
