// --- panels.js: the numbers. What comes from files reaches the page as text only, never as markup.

/** An element; strings among the children become text. */
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key === "style") element.style.cssText = value;
    else if (value !== false && value !== undefined) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.filter((c) => c !== null && c !== undefined));
  return element;
}

/** Characters that would not be seen, or turn the text around, by their number. */
function shown(text) {
  return String(text).replace(/[\u0000-\u001f\u007f-\u009f\u2028-\u202e\u2066-\u2069\u200b-\u200f\ufeff]/g, (c) => {
    const code = c.codePointAt(0).toString(16);
    return code.length <= 2 ? "\\x" + code.padStart(2, "0") : "\\u{" + code + "}";
  });
}
const brief = (text, most = 200) => (text.length > most ? text.slice(0, most) + "…" : text);
const name = (text) => make("span", { class: "name", title: brief(shown(text)) }, shown(text));

const grouped = (n) => Number(n).toLocaleString("en-US").replaceAll(",", "\u202f");
const digits = (x, n = 4) => (Number.isFinite(x) ? String(Number(x.toPrecision(n))) : String(x));
const percent = (x) => (100 * x).toFixed(x > 0 && x < 0.01 ? 3 : 1) + " %";
const seconds = (s) => (s < 10 ? s.toFixed(2) : s < 100 ? s.toFixed(1) : s.toFixed(0));
const bytesInWords = (b) => (b >= 1e9 ? (b / 1e9).toFixed(2) + " GB" : Math.round(b / 1e6) + " MB");

/** A number with what it is exactly, for programs and for the curious. */
const number = (value, text) => make("span", { class: "number", "data-value": String(value), title: String(value) }, text);

const panel = (title, ...content) => make("details", { open: true, class: "panel" }, make("summary", {}, title), ...content);

function table(rows, heads = null, kind = "") {
  const line = (cells, tag) => make("tr", {}, ...cells.map((c) => make(tag, {}, c instanceof Node ? c : String(c))));
  return make("table", { class: kind }, heads ? make("thead", {}, line(heads, "th")) : null,
    make("tbody", {}, ...rows.map((r) => (r instanceof Node ? r : line(r, "td")))));
}

/** Bars side by side: [label, count, colour], above an axis from the first to the last of `ends`; each count beneath the pointer. */
function histogram(id, bars, label, ends) {
  const most = Math.max(1, ...bars.map((b) => b[1])), total = bars.reduce((sum, b) => sum + b[1], 0) || 1;
  const plot = make("div", { class: "histogram", id, role: "img", "aria-label": label + ": " + bars.map(([l, n]) => `${l}: ${n}`).join(", ") },
    ...bars.map(([l, n, colour]) =>
      make("div", { class: "bar", title: `${l}: ${grouped(n)} (${percent(n / total)})`, "data-value": String(n) },
        make("i", { style: `height:${n > 0 ? Math.max(1.5, (100 * n) / most) : 0}%;background:${colour}` }))));
  return make("div", { class: "plot" }, make("div", { class: "counts", "aria-hidden": "true" }, make("span", {}, grouped(most)), make("span", {}, "0")), plot, axis(...ends));
}
const axis = (...labels) => make("div", { class: "axis" }, ...labels.map((l) => make("span", {}, l)));

/** The colour that the picture has for a value. */
function colourOfValue(mesh, facts, quantity, value) {
  const [low, high] = facts.scales[quantity];
  const t = scaleOf(QUANTITIES[quantity].stops), i = 3 * placeOf(endsOfColours(mesh, quantity), (255 * (value - low)) / (high - low));
  return css([t[i], t[i + 1], t[i + 2]]);
}

/** Places in a sentence, as "(1.5, 2, -3e-4)", become buttons that lead there. */
function withPlaces(sentence, goTo) {
  const parts = make("span", { class: "note" });
  const pattern = /\((-?[\d.]+(?:e[-+]?\d+)?), (-?[\d.]+(?:e[-+]?\d+)?), (-?[\d.]+(?:e[-+]?\d+)?)\)/gi;
  let last = 0;
  const text = shown(sentence);
  for (const found of text.matchAll(pattern)) {
    const at = found.slice(1, 4).map(Number);
    if (!at.every(Number.isFinite)) continue;
    parts.append(text.slice(last, found.index), place(at, goTo, found[0]));
    last = found.index + found[0].length;
  }
  parts.append(text.slice(last));
  return parts;
}
const place = (at, goTo, text = `(${at.map((x) => digits(x)).join(", ")})`) =>
  make("button", { class: "place", type: "button", title: "show this place", onclick: () => goTo(at) }, text);

/** A true volume, and how far one that was made is from it. */
const besideCad = (made, sure) => `${digits(sure, 6)}, ${made < sure ? "\u2212" : "+"}${Math.abs(100 * (made / sure - 1)).toFixed(3)} %`;

function solidsPanel(report) {
  const solids = (report.regions ?? []).filter((r) => r.true_volume);
  if (solids.length === 0) return null;
  const row = (r) => [name(r.name), number(r.tets, grouped(r.tets)), number(r.volume, digits(r.volume, 6)), number(r.true_volume, besideCad(r.volume + (r.layers_volume ?? 0), r.true_volume))];
  return panel("CAD solids", make("div", { class: "scroll" }, table(solids.map(row), ["solid", "elements", "volume", "true volume"], "numbers list")));
}

function summaryPanel(report, facts, mesh) {
  const rows = [["elements", number(facts.tets, grouped(facts.tets))]];
  const add = (key, label, text) => key in report && report[key] !== 0 && rows.push([label, number(report[key], text(report[key]))]);
  add("points", "points", grouped);
  add("boundary_faces", "boundary faces", grouped);
  add("bodies", "bodies", grouped);
  add("volume", "volume", (v) => digits(v, 6) + (report.true_volume ? ` (CAD ${besideCad(v, report.true_volume)})` : report.input_volume ? ` (input ${digits(report.input_volume, 6)})` : ""));
  if (mesh) rows.push(["extent x, y, z", extentOf(mesh).map((x) => digits(x)).join(" × ") + (report.unit ? " " + shown(report.unit) : "")]);
  add("unit", "lengths in", shown);
  add("wall_seconds", "made in", (s) => seconds(s) + " s");
  add("peak_memory_bytes", "peak memory", bytesInWords);
  add("hash", "hash", String);
  return panel("Mesh", table(rows, null, "pairs"));
}

function extentOf({ outline, radius, facts }) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < outline.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], outline[i]);
    high[i % 3] = Math.max(high[i % 3], outline[i]);
  }
  return low.map((l, axis) => (high[axis] - l) * radius * facts.step);
}

function betaHistogram(mesh, facts) {
  const BARS = 40, counts = new Array(BARS).fill(0), values = mesh.values.beta;
  for (let t = 0; t < values.length; ++t) ++counts[Math.min(BARS - 1, Math.floor((values[t] / 256) * BARS))];
  const bars = counts.map((n, i) => [`${(i / BARS).toFixed(3)} – ${((i + 1) / BARS).toFixed(3)}`, n, colourOfValue(mesh, facts, "beta", (i + 0.5) / BARS)]);
  return histogram("beta-histogram", bars, "elements by β", ["0", "¼", "½", "¾", "β = 1"]);
}

function qualityPanel(quality, mesh) {
  if (!quality) return null;
  const facts = json("facts"), middleColour = (quantity, value) => colourOfValue(mesh, facts, quantity, value);
  const classes = quality.beta_classes, total = classes.reduce((a, b) => a + b, 0) || 1, bounds = quality.beta_class_bounds;
  const label = (i) => `${bounds[i].toFixed(1)} – ${bounds[i + 1].toFixed(1)}`;
  const angles = quality.dihedral_histogram.map((n, i) => {
    const degrees = 10 * i + 5;
    const colour = middleColour(degrees < 70 ? "min_dihedral" : "max_dihedral", degrees);
    return [`${10 * i}° – ${10 * i + 10}°`, n, colour];
  });
  return panel("Quality",
    make("h3", {}, "β = 3 r / R, radius inside over radius around; 1 is regular"),
    mesh ? betaHistogram(mesh, facts) : null,
    table(classes.map((n, i) => [label(i), make("span", { class: "swatch", style: `background:${middleColour("beta", (bounds[i] + bounds[i + 1]) / 2)}` }),
      number(n, grouped(n)), percent(n / total)]), null, "numbers classes"),
    table([["mean β", number(quality.beta_mean, quality.beta_mean.toFixed(4))], ["least β", number(quality.beta_min, quality.beta_min.toFixed(4))],
      ["dihedral angles", make("span", {}, number(quality.dihedral_min_degrees, quality.dihedral_min_degrees.toFixed(1) + "°"), " to ",
        number(quality.dihedral_max_degrees, quality.dihedral_max_degrees.toFixed(1) + "°"))]], null, "pairs"),
    make("h3", {}, "All dihedral angles, classes of 10°"),
    histogram("dihedral-histogram", angles, "dihedral angles", ["0°", "45°", "90°", "135°", "180°"]));
}

function sizeHistogram(mesh) {
  const counts = new Array(24).fill(0), values = mesh.values.size_ratio;
  for (let t = 0; t < values.length; ++t) ++counts[Math.min(23, Math.floor((values[t] / 256) * 24))];
  return counts.map((n, i) => {
    const from = 2 ** (-2 + i / 6), to = 2 ** (-2 + (i + 1) / 6);
    return [`× ${from.toFixed(2)} – ${to.toFixed(2)}`, n, colourOfValue(mesh, mesh.facts, "size_ratio", -2 + (i + 0.5) / 6)];
  });
}

function sizesPanel(report, mesh) {
  const rows = [];
  if (report.expected_tets) rows.push(["elements expected", number(report.expected_tets, grouped(Math.round(report.expected_tets)))], ["elements made", number(report.tets, grouped(report.tets))]);
  const counters = (report.stages ?? []).map((s) => s.counters ?? {}).find((c) => "smallest size" in c);
  if (counters) rows.push(["sizes asked", make("span", {}, number(counters["smallest size"], digits(counters["smallest size"])), " to ", number(counters["largest size"], digits(counters["largest size"])))]);
  for (const [key, label] of [["surface_edges", "edges of the surface"], ["volume_edges", "all edges"]]) {
    const s = report[key];
    if (s) rows.push([label, make("span", {}, number(s.mean_ratio, s.mean_ratio.toFixed(3)), " of the length asked, ", number(s["share_within_0.7_1.4"], percent(s["share_within_0.7_1.4"])), " within 0.7 – 1.4")]);
  }
  if (rows.length === 0 && !mesh) return null;
  return panel("Sizes: asked and made", table(rows, null, "pairs"),
    ...(mesh?.facts.has_sizes ? [make("h3", {}, "Elements by size made over asked"), histogram("size-histogram", sizeHistogram(mesh), "size made over asked", ["× ¼", "× ½", "× 1", "× 2", "× 4"])] : []));
}

function worstPanel(report, goToElement) {
  const worst = report.worst_elements ?? [];
  const row = (e) => make("tr", { class: "worst", tabindex: "0", role: "button", "data-element": String(e.number), onclick: () => goToElement(e.number),
    onkeydown: (event) => (event.key === "Enter" || event.key === " ") && (event.preventDefault(), goToElement(e.number)) },
    make("td", {}, String(e.number)), make("td", {}, number(e.beta, e.beta.toFixed(4))),
    make("td", {}, number(e.dihedral_min_degrees, e.dihedral_min_degrees.toFixed(1) + "°")), make("td", {}, number(e.dihedral_max_degrees, e.dihedral_max_degrees.toFixed(1) + "°")));
  return panel("Worst elements", make("p", { class: "hint" }, "A click flies there and cuts the mesh open at the element."),
    make("div", { class: "scroll" }, table(worst.map(row), ["element", "β", "least angle", "largest"], "numbers list")));
}

function stagesPanel(report) {
  const stages = report.stages ?? [];
  if (stages.length === 0) return null;
  const most = Math.max(...stages.map((s) => s.wall_seconds), 1e-9);
  const counters = (s) => Object.entries(s.counters ?? {}).map(([k, v]) => `${k}: ${digits(v, 6)}`).join("\n");
  const row = (s) => make("tr", { title: brief(counters(s), 2000) }, make("td", {}, shown(s.name)),
    make("td", { class: "gauge" }, make("i", { style: `width:${(100 * s.wall_seconds) / most}%` })),
    make("td", {}, number(s.wall_seconds, seconds(s.wall_seconds))), make("td", {}, number(s.cpu_seconds, seconds(s.cpu_seconds))));
  const total = make("tr", { class: "total" }, make("td", {}, "total"), make("td"), make("td", {}, number(report.wall_seconds, seconds(report.wall_seconds))), make("td", {}, number(report.cpu_seconds, seconds(report.cpu_seconds))));
  return panel("Stages", table([...stages.map(row), total], ["", "", "wall s", "CPU s"], "numbers stages"));
}

function repairPanel(report, goTo) {
  if (!report.repairs) return null;
  const item = (r) => make("li", {}, `${shown(r.what)}: `, number(r.count, grouped(r.count)), placesOf(r, goTo));
  return panel("What repair changed", report.repairs.length === 0 ? make("p", { class: "hint" }, "Nothing: the input was meshed as it is.") : make("ul", {}, ...report.repairs.map(item)));
}

/** A few at once, many when they are asked for. */
function placesOf({ count, places = [] }, goTo) {
  const FEW = 3, buttons = places.map((p) => place(p, goTo));
  if (count > places.length && buttons.length > 0) buttons.push(" …");
  if (places.length <= FEW) return buttons.length ? make("div", { class: "places" }, ...buttons) : null;
  return make("details", {}, make("summary", {}, `${places.length} places`), make("div", { class: "places" }, ...buttons));
}

function notesPanel(report, goTo) {
  const notes = (report.stages ?? []).flatMap((s) => (s.notes ?? []).map((n) => [s.name, n]));
  for (const [key, from] of [["output", "writing"], ["reading", "reading"]]) for (const n of report[key]?.notes ?? []) notes.push([from, n]);
  if (notes.length === 0) return null;
  return panel("Notes", make("ul", {}, ...notes.map(([stage, note]) => make("li", {}, make("b", {}, shown(stage) + ": "), withPlaces(note, goTo)))));
}

function repeatPanel(report) {
  const rows = Object.entries(report.options ?? {}).map(([option, value]) => [name("--" + option), name(value)]);
  const command = report.command_line && make("pre", { id: "command", tabindex: "0" }, shown(report.command_line));
  const copy = make("button", { type: "button", onclick: async () => {
    try {
      await navigator.clipboard.writeText(report.command_line);
      copy.textContent = "copied";
    } catch {
      getSelection().selectAllChildren(document.getElementById("command"));
      copy.textContent = "selected: copy it";
    }
  } }, "copy");
  if (!command && rows.length === 0 && !report.version) return null;
  return panel("Repeat it", ...(command ? [command, copy] : []), rows.length ? table(rows, ["option", "value"], "pairs") : null,
    make("p", { class: "hint" }, `${report.program ?? "octafront"} ${shown(report.version ?? "")}`));
}
