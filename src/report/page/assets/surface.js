// --- surface.js: which faces are to be seen: of the boundary, of walls beside what is hidden, and of the cut.
//
// A cut shows whole elements: an element stays if one of its corners does. Then a face between one that stays and one
// that goes has all its corners beyond the plane, so the cut is made of the elements with exactly three corners beyond,
// a face each: no element has to know its neighbours, and a million of them are cut in some milliseconds.

/** A growing list of faces: half-face, and patch (0: none, else patch + 1). */
class FaceList {
  constructor() {
    this.count = 0;
    this.half = new Uint32Array(1 << 14);
    this.patch = new Uint32Array(1 << 14);
  }
  add(half, patch) {
    if (this.count === this.half.length) {
      for (const key of ["half", "patch"]) {
        const wider = new Uint32Array(2 * this.count);
        wider.set(this[key]);
        this[key] = wider;
      }
    }
    this.half[this.count] = half;
    this.patch[this.count++] = patch;
  }
}

// Or it is smooth: the faces go on to the plane, where the picture ends them, and slice() fills the hole.
const isSmooth = (state) => state.clip.on && state.clip.smooth && !state.filter;
/** What the picture ends: all that lies beyond. */
const planeOf = (state) => (isSmooth(state) ? [...state.clip.normal, state.clip.offset] : [0, 0, 0, 1]);

const MOST_FILTERED = 400000; // elements drawn one by one at once

/** 1 for each point beyond the plane, or null without a cut. */
function pointsBeyond(mesh, clip) {
  if (!clip.on) return null;
  const [x, y, z] = clip.normal, p = mesh.points;
  const beyond = new Uint8Array(p.length / 3);
  for (let v = 0, i = 0; v < beyond.length; ++v, i += 3) beyond[v] = x * p[i] + y * p[i + 1] + z * p[i + 2] > clip.offset ? 1 : 0;
  return beyond;
}

/**
 * The faces to draw, those of the boundary that only hint at the body while a filter is on, and how many elements are
 * there, and drawn.
 */
function visibleFaces(mesh, state) {
  const { tets, region, boundary, walls } = mesh;
  const beyond = pointsBeyond(mesh, state.clip);
  const numberBeyond = (t) =>
    beyond ? beyond[tets[4 * t]] + beyond[tets[4 * t + 1]] + beyond[tets[4 * t + 2]] + beyond[tets[4 * t + 3]] : 0;
  const stays = (t) => !state.hiddenRegions.has(region[t]) && numberBeyond(t) < 4;
  const solid = new FaceList(), ghost = new FaceList();
  const shell = state.filter ? ghost : solid;
  for (let f = 0; f < boundary.low.length; ++f) {
    const h = boundary.low[f], patch = boundary.number[f];
    if (!state.hiddenPatches.has(patch) && stays(h >>> 2)) shell.add(h, patch + 1);
  }
  for (let f = 0; f < walls.low.length; ++f) {
    const a = walls.low[f], b = walls.high[f], patch = walls.number[f];
    const first = stays(a >>> 2);
    if (first !== stays(b >>> 2) && !(patch > 0 && state.hiddenPatches.has(patch - 1))) shell.add(first ? a : b, patch);
  }
  let passed = 0;
  const count = tets.length / 4;
  if (state.filter) {
    const { quantity, low, high } = state.filter, values = mesh.values[quantity];
    for (let t = 0; t < count; ++t) {
      if (values[t] < low || values[t] > high || !stays(t) || ++passed > MOST_FILTERED) continue;
      for (let i = 0; i < 4; ++i) solid.add(4 * t + i, 0);
    }
  } else if (beyond && !isSmooth(state)) {
    for (let t = 0; t < count; ++t) {
      const a = beyond[tets[4 * t]], b = beyond[tets[4 * t + 1]], c = beyond[tets[4 * t + 2]], d = beyond[tets[4 * t + 3]];
      if (a + b + c + d !== 3 || state.hiddenRegions.has(region[t])) continue;
      solid.add(4 * t + (a ? (b ? (c ? 3 : 2) : 1) : 0), 0);
    }
  }
  return { solid, ghost, passed };
}

/** r, g, b of a face, by what the user chose. */
function faceColours(mesh, quantity) {
  if (quantity === "region") return (t) => paletteColour(mesh.region[t]);
  if (quantity === "patch") return (t, patch) => (patch > 0 ? paletteColour(patch - 1) : [200, 200, 196]);
  const table = scaleOf(QUANTITIES[quantity].stops), values = mesh.values[quantity], ends = fittedEnds(mesh, quantity);
  return (t) => {
    const i = 3 * placeOf(ends, values[t]);
    return [table[i], table[i + 1], table[i + 2]];
  };
}

/** Where the plane of the cut goes through elements: triangles and quadrilaterals, as corners on edges of elements. */
function slice(mesh, state) {
  const { tets, points, region } = mesh, [x, y, z] = state.clip.normal;
  const height = (v) => x * points[3 * v] + y * points[3 * v + 1] + z * points[3 * v + 2] - state.clip.offset;
  const heights = new Float32Array(points.length / 3);
  for (let v = 0; v < heights.length; ++v) heights[v] = height(v);
  const polygons = [];
  for (let t = 0; t < tets.length / 4; ++t) {
    const below = [], above = [];
    for (let i = 0; i < 4; ++i) (heights[tets[4 * t + i]] > 0 ? above : below).push(tets[4 * t + i]);
    if (below.length === 0 || above.length === 0 || state.hiddenRegions.has(region[t])) continue;
    // Around the polygon: of two above and two below each edge shares an end with the next.
    const edges = below.length === 2 ? [[0, 0], [0, 1], [1, 1], [1, 0]].map(([i, k]) => [below[i], above[k]]) : below.flatMap((a) => above.map((b) => [a, b]));
    polygons.push({ element: t, corners: edges.map(([a, b]) => pointBetween(mesh, a, b, heights[a] / (heights[a] - heights[b]))) });
  }
  return polygons;
}

/** Its coordinates, then the lengths around it. */
function pointBetween({ points, around }, a, b, share) {
  const at = (i) => points[3 * a + i] + share * (points[3 * b + i] - points[3 * a + i]);
  return [at(0), at(1), at(2), around[a] + share * (around[b] - around[a])];
}

// Position 3 x float, colour 3 x byte and the sides that are no edges, element as a whole number, length around.
const BYTES_PER_VERTEX = 24, FLOATS_PER_VERTEX = 6;

/** Vertices as the graphics card wants them, three for each triangle. */
class VertexData {
  constructor(triangles) {
    this.buffer = new ArrayBuffer(triangles * 3 * BYTES_PER_VERTEX);
    this.floats = new Float32Array(this.buffer);
    this.bytes = new Uint8Array(this.buffer);
    this.words = new Uint32Array(this.buffer);
    this.at = 0;
  }
  add(x, y, z, around, colour, element, hidden = 0) {
    const { at, floats, bytes } = this;
    floats[at] = x;
    floats[at + 1] = y;
    floats[at + 2] = z;
    bytes[4 * at + 12] = colour[0];
    bytes[4 * at + 13] = colour[1];
    bytes[4 * at + 14] = colour[2];
    bytes[4 * at + 15] = hidden;
    this.words[at + 4] = element;
    floats[at + 5] = around;
    this.at += FLOATS_PER_VERTEX;
  }
}

/** Faces, and polygons of a slice if there is one. */
function vertexData(mesh, faces, quantity, polygons = null) {
  const triangles = (polygons ?? []).reduce((sum, p) => sum + p.corners.length - 2, faces.count);
  const data = new VertexData(triangles), colourOf = faceColours(mesh, quantity);
  const { tets, points, around } = mesh;
  for (let f = 0; f < faces.count; ++f) {
    const h = faces.half[f], t = h >>> 2, i = h & 3;
    const colour = colourOf(t, faces.patch[f]);
    for (let k = 0; k < 3; ++k) {
      const v = tets[4 * t + FACES[3 * i + k]];
      data.add(points[3 * v], points[3 * v + 1], points[3 * v + 2], around[v], colour, t);
    }
  }
  for (const { element, corners } of polygons ?? []) addPolygon(data, corners, colourOf(element, 0), element);
  return data.buffer;
}

/** Diagonals are no edges. */
function addPolygon(data, corners, colour, element) {
  for (let i = 2; i < corners.length; ++i) {
    const hidden = (i < corners.length - 1 ? 2 : 0) | (i > 2 ? 4 : 0);
    for (const corner of [corners[0], corners[i - 1], corners[i]]) data.add(...corner, colour, element, hidden);
  }
}
