// --- surface_file.js: the input's surface, as `octafront surface --keep-surface -o part.ply` writes it: binary PLY with the
// patch of each triangle, the regions on both of its sides, and the names of both in comments.

const NO_REGION = -1;

/** {points, triangles, patch, sides: two for each triangle, patches, regions: names}; points as differences from `middle`. */
function readSurface(buffer) {
  const bytes = new Uint8Array(buffer), head = headOf(bytes);
  const view = new DataView(buffer, head.length);
  const points = new Float32Array(3 * head.vertices);
  const middle = middleOfPoints(view, head.vertices);
  for (let i = 0; i < points.length; ++i) points[i] = view.getFloat64(8 * i, true) - middle[i % 3];
  const count = head.faces, triangles = new Uint32Array(3 * count), patch = new Uint32Array(count), sides = new Int32Array(2 * count).fill(NO_REGION);
  const step = 13 + 4 * head.extras.length, begin = 24 * head.vertices;
  const at = Object.fromEntries(head.extras.map((name, i) => [name, 13 + 4 * i]));
  for (let t = 0; t < count; ++t) {
    const face = begin + t * step;
    for (let k = 0; k < 3; ++k) triangles[3 * t + k] = view.getUint32(face + 1 + 4 * k, true);
    if (at.patch) patch[t] = view.getUint32(face + at.patch, true);
    if (at.front) sides[2 * t] = view.getInt32(face + at.front, true);
    sides[2 * t + 1] = at.back ? view.getInt32(face + at.back, true) : 0;
  }
  return { points, triangles, patch, sides, middle, patches: namesOf(head.names.patch, patch, "patch_"), regions: namesOf(head.names.region, sides, "body_") };
}

function headOf(bytes) {
  const MOST = 1 << 24, END = "end_header\n";
  const text = new TextDecoder("latin1").decode(bytes.subarray(0, MOST)), end = text.indexOf(END);
  if (end < 0) throw new Error("the surface of the input could not be read");
  const length = end + END.length, lines = new TextDecoder().decode(bytes.subarray(0, length)).split("\n");
  const countOf = (what) => Number(lines.find((line) => line.startsWith(`element ${what} `))?.split(" ")[2] ?? 0);
  const names = { patch: new Map(), region: new Map() }, extras = [];
  for (const line of lines) {
    const found = /^comment (patch|region) (\d+) (.*)$/.exec(line), extra = /^property (?:uint|int) (\w+)$/.exec(line);
    if (found) names[found[1]].set(Number(found[2]), found[3]);
    if (extra) extras.push(extra[1]);
  }
  return { length, vertices: countOf("vertex"), faces: countOf("face"), names, extras };
}

function middleOfPoints(view, count) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < 3 * count; ++i) {
    const x = view.getFloat64(8 * i, true);
    if (x < low[i % 3]) low[i % 3] = x;
    if (x > high[i % 3]) high[i % 3] = x;
  }
  return low.map((l, axis) => (l + high[axis]) / 2);
}

/** Those without a name are called by their numbers, from 1, as options call them. */
function namesOf(given, used, otherwise) {
  let most = -1;
  for (const n of used) if (n > most) most = n;
  return Array.from({ length: most + 1 }, (_, i) => given.get(i) || otherwise + (i + 1));
}

/** Of each side of each triangle, from its corner k to the next, the triangle on the other side; -1: none. */
function neighboursOf(triangles) {
  const count = triangles.length;
  let size = 4;
  while (size < 2 * count) size *= 2;
  const keys = new Float64Array(size).fill(-1), first = new Int32Array(size), neighbours = new Int32Array(count).fill(-1);
  const WIDE = 2 ** 26;
  for (let side = 0; side < count; ++side) {
    const t = side - (side % 3), a = triangles[side], b = triangles[t + ((side + 1) % 3)];
    const low = Math.min(a, b), high = Math.max(a, b), key = low * WIDE + high;
    let slot = (Math.imul(low, 0x9e3779b1) ^ Math.imul(high, 0x85ebca6b)) & (size - 1);
    while (keys[slot] >= 0 && keys[slot] !== key) slot = (slot + 1) & (size - 1);
    if (keys[slot] < 0) {
      keys[slot] = key;
      first[slot] = side;
    } else {
      const other = first[slot];
      if (neighbours[other] < 0) neighbours[other] = t / 3;
      neighbours[side] = Math.floor(other / 3);
    }
  }
  return neighbours;
}

/** Unit normals, three numbers for each triangle. */
function normalsOf({ points, triangles }) {
  const normals = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[t + k]);
    const u = [0, 1, 2].map((i) => points[b + i] - points[a + i]), v = [0, 1, 2].map((i) => points[c + i] - points[a + i]);
    normals.set(unit(cross(u, v)), t);
  }
  return normals;
}

/**
 * What picking needs to know of a surface: lines between patches, each with its ends and the two patches; and which patches
 * meet where how smoothly: the largest cosine between normals on both sides.
 */
function bordersOf(surface) {
  const { triangles, patch } = surface, neighbours = neighboursOf(triangles), normals = normalsOf(surface);
  const lines = [], smooth = new Map();
  for (let side = 0; side < triangles.length; ++side) {
    const t = Math.floor(side / 3), other = neighbours[side];
    if (other >= 0 && (patch[other] === patch[t] || other < t)) continue;
    const next = 3 * t + ((side + 1) % 3);
    lines.push({ ends: [triangles[side], triangles[next]], patches: [patch[t], other < 0 ? patch[t] : patch[other]] });
    if (other < 0) continue;
    const key = pairOf(patch[t], patch[other]), cosine = Math.abs(dot(normals.subarray(3 * t, 3 * t + 3), normals.subarray(3 * other, 3 * other + 3)));
    smooth.set(key, Math.max(smooth.get(key) ?? 0, cosine));
  }
  return { lines, smooth, normals };
}
const pairOf = (a, b) => (a < b ? `${a},${b}` : `${b},${a}`);

/** A patch and all to which it leads across lines that bend by no more than these degrees. */
function spreadOver(start, { smooth }, degrees) {
  const least = Math.cos((degrees * Math.PI) / 180), found = new Set([start]);
  for (let grows = true; grows; ) {
    grows = false;
    for (const [key, cosine] of smooth) {
      const [a, b] = key.split(",").map(Number);
      if (cosine < least || found.has(a) === found.has(b)) continue;
      found.add(a).add(b);
      grows = true;
    }
  }
  return [...found];
}

/** Normals of the corners of each triangle, the same on all sides within a patch: curved faces look smooth. */
function smoothNormals({ points, triangles, patch }, normals) {
  const order = Uint32Array.from(patch.keys()).sort((a, b) => patch[a] - patch[b]);
  const sums = new Float32Array(points.length), result = new Int8Array(3 * triangles.length);
  for (let begin = 0, end = 0; begin < order.length; begin = end) {
    while (end < order.length && patch[order[end]] === patch[order[begin]]) ++end;
    const ofPatch = order.subarray(begin, end);
    for (const t of ofPatch) for (let k = 0; k < 3; ++k) sums.fill(0, 3 * triangles[3 * t + k], 3 * triangles[3 * t + k] + 3);
    for (const t of ofPatch) for (let k = 0; k < 3; ++k) for (let i = 0; i < 3; ++i) sums[3 * triangles[3 * t + k] + i] += normals[3 * t + i];
    for (const t of ofPatch)
      for (let k = 0; k < 3; ++k) {
        const v = 3 * triangles[3 * t + k], sum = sums.subarray(v, v + 3), own = normals.subarray(3 * t, 3 * t + 3);
        // Within a patch that bends sharply its own normal is the better one.
        const normal = dot(sum, own) > 0.5 * Math.hypot(...sum) ? unit([...sum]) : [...own];
        for (let i = 0; i < 3; ++i) result[9 * t + 3 * k + i] = Math.round(127 * normal[i]);
      }
  }
  return result;
}
