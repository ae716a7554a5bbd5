// --- main.js: the page as a whole: what the user sees now, and what moves it.

const byId = (id) => document.getElementById(id);
const canvas = byId("canvas"), overlay = byId("overlay");

function say(text) {
  byId("message").textContent = text;
  byId("message").hidden = text === "";
}

/** What is shown, and how. */
const state = {
  quantity: "beta",
  clip: { on: false, smooth: false, normal: [1, 0, 0], offset: 0, axis: "x" }, // what lies beyond is taken away
  hiddenPatches: new Set(),
  hiddenRegions: new Set(),
  filter: null,
  edges: true,
  selected: -1,
  marked: null,
};
const camera = new Camera();
let mesh = null, picture = null, waiting = false, facesWaiting = false;

// --- drawing: at most once a frame

function redraw() {
  if (waiting || !picture) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    drawNow();
  });
}
function drawNow() {
  if (facesWaiting) {
    facesWaiting = false;
    const faces = visibleFaces(mesh, state);
    picture.fill(picture.solid, vertexData(mesh, faces.solid, state.quantity, isSmooth(state) ? slice(mesh, state) : null));
    picture.fill(picture.ghost, vertexData(mesh, faces.ghost, state.quantity));
    tellFilter(faces.passed);
  }
  picture.fit();
  picture.draw(camera, { edges: state.edges, background: background(), plane: planeOf(state) });
  drawOverlay();
}
function rebuild() {
  facesWaiting = true;
  redraw();
}
function background() {
  return [...getComputedStyle(document.documentElement).getPropertyValue("--canvas").trim().split(/\s+/).map((c) => Number(c) / 255), 1];
}

/** The element that was chosen, and a place that was asked for. */
function drawOverlay() {
  const project = projector(camera, canvas);
  const written = (at) => at.map((x) => x.toFixed(1));
  // Of edges that bend, on the canvas.
  const middleOfEdge = (t, e) => {
    const [a, b] = [mesh.tets[4 * t + EDGES[e]], mesh.tets[4 * t + EDGES[e + 1]]], bend = bendOf(mesh, a, b);
    return bend && project(middleOf([pointOf(a), pointOf(b)]).map((x, i) => x + bend[i]));
  };
  let path = "";
  if (state.selected >= 0) {
    const corners = [0, 1, 2, 3].map((i) => project(pointOf(mesh.tets[4 * state.selected + i])));
    for (let e = 0; e < 12; e += 2) {
      const [a, b] = [corners[EDGES[e]], corners[EDGES[e + 1]]], middle = middleOfEdge(state.selected, e);
      if (a && b) path += `M${written(a)}${middle ? `Q${written(a.map((x, i) => 2 * middle[i] - (x + b[i]) / 2))} ` : "L"}${written(b)}`;
    }
  }
  byId("chosen").setAttribute("d", path);
  const at = state.marked && project(state.marked);
  byId("mark").setAttribute("transform", at ? `translate(${at[0].toFixed(1)} ${at[1].toFixed(1)})` : "translate(-100 -100)");
  drawTriad();
  drawScaleBar();
}

/** Which way x, y and z go; what points away from the viewer comes first. */
function drawTriad() {
  const LENGTH = 30;
  const ends = ["x", "y", "z"].map((axis, i) => ({ axis, x: camera.axes[0][i], y: -camera.axes[1][i], depth: camera.axes[2][i] }));
  for (const { axis, x, y } of ends) {
    const group = byId("triad-" + axis), [line, text] = group.children;
    line.setAttribute("d", `M0 0L${(LENGTH * x).toFixed(1)} ${(LENGTH * y).toFixed(1)}`);
    text.setAttribute("x", ((LENGTH + 9) * x).toFixed(1));
    text.setAttribute("y", ((LENGTH + 9) * y).toFixed(1));
  }
  for (const { axis } of ends.sort((a, b) => a.depth - b.depth)) byId("triad").append(byId("triad-" + axis));
}

/** A round length, where the camera looks at. */
function drawScaleBar() {
  const pixels = canvas.clientHeight / (2 * camera.distance * tangentOf(canvas)) / (mesh.radius * mesh.facts.step);
  const most = 120 / pixels, power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((n) => n * power).find((n) => n <= most) ?? power;
  byId("bar").style.width = (length * pixels).toFixed(1) + "px";
  byId("bar-text").textContent = `${digits(length)}${report.unit ? " " + shown(report.unit) : ""}`;
}

const pointOf = (v) => [mesh.points[3 * v], mesh.points[3 * v + 1], mesh.points[3 * v + 2]];
const cornersOf = (t) => [0, 1, 2, 3].map((i) => pointOf(mesh.tets[4 * t + i]));
const middleOf = (corners) => [0, 1, 2].map((axis) => corners.reduce((sum, c) => sum + c[axis], 0) / corners.length);

// --- going to places

/** The plane of the cut lies through `at` and faces the viewer, or the other way if wanted. */
function cutAt(at) {
  Object.assign(state.clip, { on: true, axis: "view", normal: [...camera.back], offset: dot(camera.back, at) });
  showClip();
}
function goToElement(t) {
  if (!mesh || t >= mesh.facts.tets) return;
  const corners = cornersOf(t), middle = middleOf(corners);
  const size = Math.max(...corners.map((c) => Math.hypot(...c.map((x, i) => x - middle[i]))), 1e-6);
  state.marked = null;
  choose(t);
  cutAt(middle);
  rebuild();
  fly(camera, middle, (size * 14) / Math.sin(VIEW_ANGLE / 2) / 2, redraw);
}
function goToPlace(at) {
  if (!mesh) return;
  state.marked = toPicture(mesh, at);
  choose(-1);
  state.clip.on = false;
  showClip();
  // From outside: the place is likely on the surface.
  const outward = unit(state.marked);
  if (Math.hypot(...state.marked) > 0.05) camera.look(outward, Math.abs(outward[2]) > 0.95 ? [0, 1, 0] : [0, 0, 1]);
  rebuild();
  fly(camera, state.marked, 0.6, redraw);
}

function choose(t) {
  state.selected = t;
  const box = byId("element");
  box.hidden = t < 0;
  if (t < 0) return;
  const corners = [0, 1, 2, 3].map((i) => exactPoint(mesh.tets[4 * t + i]));
  const shape = shapeOf(corners);
  const worst = (report.worst_elements ?? []).find((e) => e.number === t);
  const at = worst?.at ?? middleOf(corners);
  const rows = [["element", String(t)], ["β", digits(worst?.beta ?? shape.beta)],
    ["dihedral angles", `${(worst?.dihedral_min_degrees ?? shape.least).toFixed(1)}° to ${(worst?.dihedral_max_degrees ?? shape.most).toFixed(1)}°`],
    ["edges", `${digits(shape.shortest)} to ${digits(shape.longest)}`]];
  if (mesh.facts.has_sizes) rows.push(["made over asked", QUANTITIES.size_ratio.text(valueOf(mesh, "size_ratio", mesh.values.size_ratio[t]))]);
  if (mesh.facts.regions.length > 1) rows.push(["region", name(mesh.facts.regions[mesh.region[t]] ?? String(mesh.region[t]))]);
  rows.push(["middle", at.map((x) => digits(x, 6)).join(", ")]);
  box.replaceChildren(table(rows, null, "pairs"), make("button", { type: "button", onclick: () => (choose(-1), redraw()) }, "close"));
}
const exactPoint = (v) => [0, 1, 2].map((axis) => mesh.facts.origin[axis] + mesh.facts.step * mesh.steps[3 * v + axis]);

function shapeOf([a, b, c, d]) {
  const minus = (p, q) => p.map((x, i) => x - q[i]);
  const points = [a, b, c, d];
  const normals = [0, 1, 2, 3].map((i) => {
    const [p, q, r] = [0, 1, 2].map((k) => points[FACES[3 * i + k]]);
    return cross(minus(q, p), minus(r, p));
  });
  const angles = [];
  for (let i = 0; i < 4; ++i) for (let k = 0; k < i; ++k) angles.push((Math.acos(Math.max(-1, Math.min(1, -dot(unit(normals[i]), unit(normals[k]))))) * 180) / Math.PI);
  const lengths = [];
  for (let e = 0; e < 12; e += 2) lengths.push(Math.hypot(...minus(points[EDGES[e]], points[EDGES[e + 1]])));
  const volume = Math.abs(dot(minus(b, a), cross(minus(c, a), minus(d, a)))) / 6;
  const area = normals.reduce((sum, n) => sum + Math.hypot(...n) / 2, 0);
  const [p, q, r] = [lengths[0] * lengths[5], lengths[1] * lengths[4], lengths[2] * lengths[3]];
  const around = Math.sqrt(Math.max(0, (p + q + r) * (p + q - r) * (p - q + r) * (-p + q + r))) / (24 * volume);
  return { least: Math.min(...angles), most: Math.max(...angles), shortest: Math.min(...lengths), longest: Math.max(...lengths), beta: volume > 0 ? (9 * volume) / area / around : 0 };
}

// --- controls

function showLegend() {
  const legend = byId("legend"), q = QUANTITIES[state.quantity];
  byId("filter-row").hidden = byId("stretch-label").hidden = !q;
  if (!q) return legend.replaceChildren();
  const ends = endsOfColours(mesh, state.quantity), [low, high] = ends.map((byte) => valueOf(mesh, state.quantity, byte));
  const counts = countsOf(mesh.values[state.quantity], 256), some = (bytes) => bytes.some((n) => n > 0);
  legend.replaceChildren(make("i", { style: `background:linear-gradient(to right, ${q.stops.join(", ")})` }),
    axis((some(counts.slice(0, ends[0])) ? "≤ " : "") + q.text(low), q.text((low + high) / 2), (some(counts.slice(ends[1] + 1)) ? "≥ " : "") + q.text(high)));
}
function setQuantity(quantity) {
  state.quantity = quantity;
  if (!QUANTITIES[quantity]) state.filter = null;
  showLegend();
  proposeFilter();
  readFilter();
}

/** The worst element in a hundred, to begin with. */
function proposeFilter() {
  const q = QUANTITIES[state.quantity];
  if (!q) return;
  const counts = countsOf(mesh.values[state.quantity], 256);
  const enough = mesh.facts.tets / 100;
  const until = (bytes) => {
    let sum = 0;
    return bytes.find((byte) => (sum += counts[byte]) >= enough) ?? 255;
  };
  const bytes = [...Array(256).keys()];
  byId("filter-low").value = String(q.worstIsHigh ? until([...bytes].reverse()) : 0);
  byId("filter-high").value = String(q.worstIsHigh ? 255 : until(bytes));
}

function readFilter() {
  const on = byId("filter").checked && QUANTITIES[state.quantity] !== undefined;
  const ends = [Number(byId("filter-low").value), Number(byId("filter-high").value)];
  state.filter = on ? { quantity: state.quantity, low: Math.min(...ends), high: Math.max(...ends) } : null;
  byId("filter-ends").hidden = !on;
  rebuild();
}
function tellFilter(passed) {
  if (!state.filter) return;
  const { quantity, low, high } = state.filter, text = QUANTITIES[quantity].text;
  byId("filter-text").textContent = `${text(valueOf(mesh, quantity, low))} to ${text(valueOf(mesh, quantity, high))}: ${grouped(passed)} elements` +
    (passed > MOST_FILTERED ? `, ${grouped(MOST_FILTERED)} of them drawn` : "");
}

const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** The least and largest offset at which the plane meets the mesh. */
function clipReach() {
  const n = state.clip.normal, p = mesh.points;
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < p.length; i += 3) {
    const s = n[0] * p[i] + n[1] * p[i + 1] + n[2] * p[i + 2];
    if (s < low) low = s;
    if (s > high) high = s;
  }
  return [low, high];
}
function showClip() {
  byId("clip").checked = state.clip.on;
  byId("clip-row").hidden = !state.clip.on;
  for (const button of document.querySelectorAll("[data-axis]")) button.setAttribute("aria-pressed", String(button.dataset.axis === state.clip.axis));
  const [low, high] = clipReach();
  byId("clip-at").value = String(Math.round((1000 * (state.clip.offset - low)) / (high - low || 1)));
}
function setClipAxis(axis) {
  const [low, high] = clipReach();
  const share = state.clip.on ? (state.clip.offset - low) / (high - low || 1) : 0.5;
  Object.assign(state.clip, { on: true, axis, normal: towardsViewer(axis === "view" ? [...camera.back] : AXES[axis]) });
  const reach = clipReach();
  state.clip.offset = reach[0] + share * (reach[1] - reach[0]);
  showClip();
  rebuild();
}
/** The viewer should look at the cut. */
function towardsViewer(normal) {
  return dot(normal, camera.back) < 0 ? normal.map((x) => -x) : normal;
}
/** The axis across which the cut is likely the largest. */
function firstClip() {
  const extents = Object.entries(AXES).map(([axis, normal]) => {
    state.clip.normal = normal;
    const [low, high] = clipReach();
    return [high - low, axis, normal];
  });
  const [, axis, normal] = extents.sort((a, b) => a[0] - b[0])[0];
  Object.assign(state.clip, { axis, normal: towardsViewer(normal), offset: 0 });
}
function moveClip(share) {
  const [low, high] = clipReach();
  state.clip.offset = low + Math.min(1, Math.max(0, share)) * (high - low);
  rebuild();
}
function flipClip() {
  Object.assign(state.clip, { normal: state.clip.normal.map((x) => -x), offset: -state.clip.offset });
  showClip();
  rebuild();
}
function toggleClip(on) {
  state.clip.on = on;
  showClip();
  rebuild();
}

/** From where it looks: so near that all of the mesh just fills the picture, but for what stands at its edges. */
function frame() {
  const SIDES = 24, TOP_AND_BOTTOM = 52, width = canvas.clientWidth, height = Math.max(1, canvas.clientHeight);
  const room = (length, edge) => Math.max(0.5, 1 - (2 * edge) / length), tangent = tangentOf(canvas);
  camera.frame(mesh.outline, [((tangent * width) / height) * room(width, SIDES), tangent * room(height, TOP_AND_BOTTOM)]);
}

const VIEWS = { "+x": [[1, 0, 0], [0, 0, 1]], "−x": [[-1, 0, 0], [0, 0, 1]], "+y": [[0, 1, 0], [0, 0, 1]], "−y": [[0, -1, 0], [0, 0, 1]], "+z": [[0, 0, 1], [0, 1, 0]], "−z": [[0, 0, -1], [0, 1, 0]] };
function lookFrom(view) {
  const [back, up] = VIEWS[view] ?? [START.back, START.up];
  camera.look(back, up);
  frame();
  redraw();
}

/** A list of parts to hide: name, colour, size. */
function partsPanel(title, names, counts, hidden) {
  if (names.length < 2) return null;
  const MOST = 500;
  const used = names.map((text, i) => i).filter((i) => counts[i] > 0);
  const boxes = new Map();
  const row = (i) => {
    const box = make("input", { type: "checkbox", checked: true, onchange: (event) => {
      event.target.checked ? hidden.delete(i) : hidden.add(i);
      rebuild();
    } });
    boxes.set(i, box);
    return make("label", { class: "part" }, box, make("span", { class: "swatch", style: `background:${css(paletteColour(i))}` }), name(names[i]), make("span", { class: "count" }, grouped(counts[i])));
  };
  const all = (on) => () => {
    for (const i of used) on ? hidden.delete(i) : hidden.add(i);
    for (const box of boxes.values()) box.checked = on;
    rebuild();
  };
  return panel(title, make("div", { class: "buttons" }, make("button", { type: "button", onclick: all(true) }, "all"), make("button", { type: "button", onclick: all(false) }, "none")),
    make("div", { class: "scroll" }, ...used.slice(0, MOST).map(row)), used.length > MOST ? make("p", { class: "hint" }, `${grouped(used.length - MOST)} more are not listed`) : null);
}
function listenToControls() {
  const choices = [...Object.keys(QUANTITIES).filter((q) => mesh.values[q]), ...(mesh.facts.regions.length > 1 ? ["region"] : []), ...(mesh.facts.patches.length > 1 ? ["patch"] : [])];
  const select = byId("quantity");
  select.replaceChildren(...choices.map((q) => make("option", { value: q }, QUANTITIES[q]?.title ?? q)));
  select.value = state.quantity;
  select.addEventListener("change", () => setQuantity(select.value));
  byId("stretch").addEventListener("change", (event) => {
    isStretched = event.target.checked;
    showLegend();
    byId("numbers").replaceChildren();
    showNumbers();
    rebuild();
  });
  byId("edges").addEventListener("change", (event) => ((state.edges = event.target.checked), redraw()));
  byId("clip").addEventListener("change", (event) => toggleClip(event.target.checked));
  byId("clip-smooth").addEventListener("change", (event) => ((state.clip.smooth = event.target.checked), rebuild()));
  byId("clip-at").addEventListener("input", (event) => moveClip(event.target.value / 1000));
  byId("clip-flip").addEventListener("click", flipClip);
  for (const button of document.querySelectorAll("[data-axis]")) button.addEventListener("click", () => setClipAxis(button.dataset.axis));
  for (const id of ["filter", "filter-low", "filter-high"]) byId(id).addEventListener("input", readFilter);
  byId("views").append(...Object.keys(VIEWS).map((v) => make("button", { type: "button", onclick: () => lookFrom(v) }, v)), make("button", { type: "button", onclick: () => lookFrom("") }, "reset"));
}

// --- mouse, fingers, keys

function listenToPointers() {
  followPointers(canvas, () => camera, redraw, (x, y) => {
    state.marked = null;
    choose(picture.elementAt(camera, x, y));
    redraw();
  });
  canvas.addEventListener("dblclick", () => state.selected >= 0 && (fly(camera, middleOf(cornersOf(state.selected)), camera.distance / 2, redraw)));
}

function listenToKeys() {
  const STEP = 0.12;
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
  const others = {
    "+": () => camera.zoom(0.85), "=": () => camera.zoom(0.85), "-": () => camera.zoom(1 / 0.85), 0: () => lookFrom(""), Home: () => lookFrom(""),
    x: () => setClipAxis("x"), y: () => setClipAxis("y"), z: () => setClipAxis("z"), v: () => setClipAxis("view"), c: () => toggleClip(!state.clip.on), f: flipClip,
    "[": () => nudgeClip(-1), "]": () => nudgeClip(1), e: () => byId("edges").click(), s: () => byId("clip-smooth").click(), Escape: () => choose(-1),
  };
  const nudgeClip = (by) => {
    byId("clip-at").value = String(Number(byId("clip-at").value) + 10 * by);
    moveClip(byId("clip-at").value / 1000);
  };
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = arrows[event.key];
    if (arrow) event.shiftKey ? camera.shift(-arrow[0] * STEP, -arrow[1] * STEP) : camera.turn(arrow[0] * STEP, arrow[1] * STEP);
    else if (others[event.key]) others[event.key]();
    else return;
    event.preventDefault();
    redraw();
  });
}

function listenToTheme() {
  const button = byId("theme"), root = document.documentElement;
  const dark = () => (root.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  button.addEventListener("click", () => {
    root.dataset.theme = dark() ? "light" : "dark";
    redraw();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

// --- start

const report = json("report");
takeFacts(json("facts"));

function showNumbers() {
  const inputs = report.inputs ?? [report.input ?? "mesh"];
  const title = inputs.map((input) => String(input).split("/").pop()).join(" + ");
  document.title = "Octafront: " + brief(shown(title), 80);
  byId("title").replaceChildren(name(title));
  const facts = json("facts");
  byId("numbers").append(...[summaryPanel(report, facts, mesh), solidsPanel(report), worstPanel(report, goToElement), qualityPanel(report.quality, mesh), sizesPanel(report, mesh), stagesPanel(report), repairPanel(report, goToPlace), notesPanel(report, goToPlace), repeatPanel(report)].filter(Boolean));
}

async function start() {
  listenToTheme();
  try {
    say("unpacking the mesh …");
    mesh = await decodeMesh();
    picture = new Picture(canvas);
  } catch (error) {
    const why = typeof DecompressionStream === "undefined" ? "this browser is older than 2023" : error.message;
    say(`a still picture, and the numbers: ${why}`);
    for (const id of ["canvas", "triad", "scale-bar", "help"]) byId(id).style.display = "none";
    return showNumbers();
  }
  picture.onRestored = rebuild;
  if (mesh.facts.regions.length > 1) state.quantity = "region";
  frame();
  firstClip();
  listenToControls();
  showLegend();
  proposeFilter();
  facesWaiting = true;
  drawNow();
  picture.finish();
  performance.measure("first picture", { start: 0, end: performance.now() });
  say("");
  byId("still").hidden = true;
  byId("controls").hidden = false;
  listenToPointers();
  listenToKeys();
  const { regions, patches } = mesh.facts;
  const patchCounts = countsOf(mesh.boundary.number, patches.length);
  for (const n of mesh.walls.number) if (n > 0 && n <= patchCounts.length) ++patchCounts[n - 1];
  byId("parts").append(...[partsPanel("Regions", regions, countsOf(mesh.region, regions.length), state.hiddenRegions), partsPanel("Patches", patches, patchCounts, state.hiddenPatches)].filter(Boolean));
  showNumbers();
  new ResizeObserver(redraw).observe(canvas);
}

// For programs that test the page.
window.octafront = {
  state, camera, get mesh() { return mesh; }, get vertices() { return picture ? picture.solid.vertices : 0; },
  draw: () => drawNow(), finish: () => picture.finish(), rebuild: () => (facesWaiting = true), visibleFaces: () => visibleFaces(mesh, state),
  inner: { along, countsOf, cross, dot, endsOfColours, fittedEnds, moveClip, placeOf, planeOf, projector, setClipAxis, slice, valueOf, vertexData },
};
start();
