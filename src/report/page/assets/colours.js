// --- colours.js: scales that eyes with colour blindness tell apart: what is poor is dark and warm, what is good light and
// cool, as in pictures (report/picture); sizes orange against blue, through a light middle; the palette of Okabe and Ito
// for what has no order.

/** What a page says of its mesh: scales, and the colours of pictures. */
let FACTS = null;
const takeFacts = (facts) => (FACTS = facts);
const PALETTE = ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#0072b2", "#d55e00", "#f0e442", "#9a9a9a"];

const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

/** 256 colours between stops, as bytes r, g, b. */
function scaleOf(stops) {
  const colours = stops.map(rgb);
  const table = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (colours.length - 1);
    const k = Math.min(Math.floor(at), colours.length - 2);
    for (let c = 0; c < 3; ++c) table[3 * i + c] = Math.round(colours[k][c] + (at - k) * (colours[k + 1][c] - colours[k][c]));
  }
  return table;
}

/** The eight colours, then the same lighter, then darker. */
function paletteColour(number) {
  const colour = rgb(PALETTE[number % PALETTE.length]);
  const round = Math.floor(number / PALETTE.length) % 3;
  return colour.map((c) => Math.round(round === 0 ? c : round === 1 ? c + (255 - c) * 0.5 : c * 0.55));
}

const css = (colour) => `rgb(${colour.join(" ")})`;

/** What elements can be coloured by. `stops` go from the least value of `ends` to the largest. */
const QUANTITIES = {
  beta: { title: "quality β", ends: [0, 1], get stops() { return FACTS.poor_to_good; }, text: (v) => v.toFixed(2) },
  min_dihedral: { title: "smallest dihedral angle", ends: [0, 70], get stops() { return FACTS.poor_to_good; }, text: (v) => v.toFixed(0) + "°" },
  max_dihedral: { title: "largest dihedral angle", ends: [70, 180], get stops() { return [...FACTS.poor_to_good].reverse(); }, worstIsHigh: true, text: (v) => v.toFixed(0) + "°" },
  size_ratio: {
    title: "size: made over asked",
    ends: [-1, 1],
    stops: ["#1b4f8f", "#4f97d6", "#a9cce8", "#f2efe8", "#f5b26b", "#d9650f", "#8c2d04"],
    worstIsHigh: true,
    text: (v) => "× " + (2 ** v).toFixed(2),
  },
  layers: { title: "boundary layers at walls", ends: [0, 1], get stops() { return FACTS.poor_to_good; }, text: (v) => (100 * v).toFixed(0) + " %" },
};

/**
 * The bytes between which the colours of a quantity change: the same in all meshes, so that they tell what a value is
 * worth; or, stretched, those that the mesh has.
 */
let isStretched = false;
function endsOfColours(mesh, quantity) {
  if (isStretched) return fittedEnds(mesh, quantity);
  const [low, high] = FACTS.scales[quantity];
  return QUANTITIES[quantity].ends.map((value) => Math.round((255 * (value - low)) / (high - low)));
}

/**
 * Of those that the mesh has: all but the outermost two in a thousand elements, for a few
 * would leave the others one colour. Without a mesh the whole scale.
 */
function fittedEnds(mesh, quantity) {
  if (!mesh?.values[quantity]) return [0, 255];
  mesh.ends ??= {};
  return (mesh.ends[quantity] ??= endsOf(countsOf(mesh.values[quantity], 256)));
}
function endsOf(counts) {
  const few = 0.002 * counts.reduce((a, b) => a + b, 0);
  const reach = (from, step) => {
    let sum = 0, byte = from;
    while ((sum += counts[byte]) <= few && byte + step >= 0 && byte + step <= 255) byte += step;
    return byte;
  };
  const [low, high] = [reach(0, 1), reach(255, -1)];
  const LEAST = 12; // a regular mesh is not to look like a poor one
  return high - low >= LEAST ? [low, high] : high >= LEAST ? [high - LEAST, high] : [0, LEAST];
}
function countsOf(numbers, length) {
  const counts = new Array(length).fill(0);
  for (const n of numbers) if (n < length) ++counts[n];
  return counts;
}

/** The place of a byte in the 256 colours. */
const placeOf = ([low, high], byte) => Math.round(255 * Math.min(1, Math.max(0, (byte - low) / (high - low))));

/** byte of a value -> value */
function valueOf(mesh, quantity, byte) {
  const [low, high] = mesh.facts.scales[quantity];
  return low + ((high - low) * byte) / 255;
}
