// --- job.js: what is wanted, as plain data that is never changed in place: each step is a new one, so that it can be undone.

const NO_JOB = {
  by: "auto", finer: 0, size: "", elements: "50000", order: "1",
  patches: true, // a surface is parted at sharp edges
  names: [], // {name, places}
  sizes: [], // {places, size}
  walls: [], // places that get layers
  pairs: [], // {places: a face and its copy, by: the way from one to the other}
  layers: { n: "3", first: "", growth: "" },
  more: {}, // further options, by the names of the command line
};

/** A place: {kind: "face" | "edge" | "region" | "set", name}, by the name that options take. */
const keyOf = (place) => `${place.kind}:${place.name}`;

/** Steps there and back. */
class History {
  constructor(first) {
    this.steps = [first];
    this.at = 0;
  }
  get now() {
    return this.steps[this.at];
  }
  get canUndo() {
    return this.at > 0;
  }
  get canRedo() {
    return this.at + 1 < this.steps.length;
  }
  change(parts) {
    this.steps.splice(this.at + 1, Infinity, { ...this.now, ...parts });
    this.at = this.steps.length - 1;
  }
  go(by) {
    this.at = Math.min(this.steps.length - 1, Math.max(0, this.at + by));
  }
}

/** Faces together are one set; all else is one each. */
function groupsOf({ name, places }) {
  const faces = places.filter((p) => p.kind === "face").map((p) => p.name), others = places.filter((p) => p.kind !== "face");
  // Between several places are commas: a face whose name has one stands alone.
  const together = faces.length > 1 && faces.every((face) => !face.includes(","));
  const each = [...(together ? ["patches:" + faces.join(",")] : faces), ...others.map((p) => p.name)];
  return each.map((place, i) => `${each.length > 1 ? `${name}_${i + 1}` : name}=${place}`);
}

/** The options of `octafront mesh`, by name; lists where an option is repeated. `isCad`: faces are those of the file. */
function optionsOf(job, isCad) {
  const options = {};
  if (job.by === "size") options.size = positive(job.size, "the edge length");
  if (job.by === "elements") options.elements = positive(job.elements, "the number of elements");
  if (job.by === "auto" && job.finer !== 0) options["automatic-factor"] = Number((2 ** (-job.finer / 5)).toPrecision(3));
  if (job.order !== "1") options.order = job.order;
  if (!isCad && job.patches) options.patches = true;
  const sizes = job.sizes.flatMap(({ places, size }) => places.map((p) => `${p.name}=${positive(size, "a size")}`));
  if (sizes.length) options["size-of"] = sizes;
  if (job.walls.length) {
    options.layers = positive(job.layers.n, "the number of layers");
    options.on = job.walls.map((p) => p.name).join(",");
    const FIRST_PART = 0.2; // of the edge length, where nobody says it
    if (job.layers.first) options.first = positive(job.layers.first, "the height of the first layer");
    else options["first-part"] = FIRST_PART;
    if (job.layers.growth) options.growth = positive(job.layers.growth, "the growth of layers");
  }
  if (job.pairs.length) options.periodic = job.pairs.map(({ places: [a, b], by }) => `${a.name}:${b.name}=${by.join(",")}`).join(";");
  const groups = job.names.flatMap(groupsOf);
  if (groups.length) options.group = groups;
  return { ...options, ...job.more };
}

/** The options that the input is shown by: those that say what it is, and which of its lines part patches. */
function optionsOfInput(job) {
  const SHARED = ["feature-angle", "unit", "cells", "nested", "overlap", "tolerance", "image", "iso", "band", "labels", "ignore", "series", "repair"];
  return Object.fromEntries(Object.entries(job.more).filter(([name]) => SHARED.includes(name)));
}

function positive(text, what) {
  const value = Number(text);
  if (!(value > 0)) throw new Error(`${what} is a number above 0`);
  return value;
}

/** The same job for a shell, for Python, and for programs that speak to the MCP door. */
function asCommand(names, options, target) {
  const words = Object.entries(options).flatMap(([name, value]) => [value].flat().map((one) => (one === true ? `--${name}` : `--${name} ${quoted(String(one))}`)));
  return ["octafront mesh", ...names.map(quoted), "-o", quoted(target), ...words].join(" ");
}
const quoted = (text) => (/^[\w./+=:-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function asPython(names, options, target) {
  const literal = (value) => (value === true ? "True" : JSON.stringify(value));
  const pairs = (list) => `{${list.map((text) => [text.slice(0, text.lastIndexOf("=")), text.slice(text.lastIndexOf("=") + 1)]).map(([place, size]) => `${literal(place)}: ${size}`).join(", ")}}`;
  const groups = (list) => `{${list.map((text) => [text.slice(0, text.indexOf("=")), text.slice(text.indexOf("=") + 1)]).map((pair) => pair.map(literal).join(": ")).join(", ")}}`;
  const value = (name, given) => (name === "size-of" ? pairs(given) : name === "group" ? groups(given) : name === "order" ? given : literal(given));
  const keywords = Object.entries(options).map(([name, given]) => `${name.replaceAll("-", "_")}=${value(name, given)}`);
  const input = names.length === 1 ? literal(names[0]) : `[${names.map(literal).join(", ")}]`;
  return `import octafront\n\nmesh = octafront.mesh(${[input, ...keywords].join(",\n                      ")})\nmesh.save(${literal(target)})`;
}

const asJson = (names, options, target) => JSON.stringify({ tool: "mesh", arguments: { input: names.length === 1 ? names[0] : names, output: target, options } }, null, 2);
