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
  // Where the picture ends what lies beyond, what bends may come back to this side.
  const bends = isSmooth(state) && mesh.bends ? mesh.bends.at : null;
  const isBent = (t) => bends !== null && bends[tets[4 * t]] + bends[tets[4 * t + 1]] + bends[tets[4 * t + 2]] + bends[tets[4 * t + 3]] > 1;
  const stays = (t) => !state.hiddenRegions.has(region[t]) && (numberBeyond(t) < 4 || isBent(t));
  const solid = new FaceList(), ghost = new FaceList();
  const shell = state.filter ? ghost : solid;
  const cutsAgain = beyond && !state.filter && !isSmooth(state);
  const drawn = new Set(); // of the faces that the cut would draw again
  const show = (list, half, patch) => {
    if (cutsAgain && numberBeyond(half >>> 2) === 3) drawn.add(half);
    list.add(half, patch);
  };
  for (let f = 0; f < boundary.low.length; ++f) {
    const h = boundary.low[f], patch = boundary.number[f];
    if (!state.hiddenPatches.has(patch) && stays(h >>> 2)) show(shell, h, patch + 1);
  }
  for (let f = 0; f < walls.low.length; ++f) {
    const a = walls.low[f], b = walls.high[f], patch = walls.number[f];
    const first = stays(a >>> 2);
    if (first !== stays(b >>> 2) && !(patch > 0 && state.hiddenPatches.has(patch - 1))) show(shell, first ? a : b, patch);
  }
  let passed = 0;
  const count = tets.length / 4;
  if (state.filter) {
    const { quantity, low, high } = state.filter, values = mesh.values[quantity];
    for (let t = 0; t < count; ++t) {
      if (values[t] < low || values[t] > high || !stays(t) || ++passed > MOST_FILTERED) continue;
      for (let i = 0; i < 4; ++i) solid.add(4 * t + i, 0);
    }
  } else if (cutsAgain) {
    for (let t = 0; t < count; ++t) {
      const a = beyond[tets[4 * t]], b = beyond[tets[4 * t + 1]], c = beyond[tets[4 * t + 2]], d = beyond[tets[4 * t + 3]];
      if (a + b + c + d !== 3 || state.hiddenRegions.has(region[t])) continue;
      const half = 4 * t + (a ? (b ? (c ? 3 : 2) : 1) : 0);
      if (!drawn.has(half)) solid.add(half, 0);
    }
  }
  return { solid, ghost, passed };
}

/** r, g, b of a face, by what the user chose. */
function faceColours(mesh, quantity) {
  if (quantity === "region") return (t) => paletteColour(mesh.region[t]);
  if (quantity === "patch") return (t, patch) => (patch > 0 ? paletteColour(patch - 1) : [200, 200, 196]);
  const table = scaleOf(QUANTITIES[quantity].stops), values = mesh.values[quantity], ends = endsOfColours(mesh, quantity);
  return (t) => {
    const i = 3 * placeOf(ends, values[t]);
    return [table[i], table[i + 1], table[i + 2]];
  };
}

/**
 * Where the plane of the cut goes through elements: triangles and quadrilaterals, of elements that bend many small ones; as corners
 * [x, y, z, length around, shares in the element's four corners].
 */
function slice(mesh, state) {
  const { tets, points, region } = mesh, [x, y, z] = state.clip.normal;
  const heightOf = (px, py, pz) => x * px + y * py + z * pz - state.clip.offset;
  const heights = new Float32Array(points.length / 3);
  for (let v = 0; v < heights.length; ++v) heights[v] = heightOf(points[3 * v], points[3 * v + 1], points[3 * v + 2]);
  const polygons = [];
  for (let t = 0; t < tets.length / 4; ++t) {
    if (state.hiddenRegions.has(region[t])) continue;
    const corners = tets.subarray(4 * t, 4 * t + 4), bends = mesh.bends ? bendsNear(mesh, corners, heights) : [];
    if (bends.length > 0) {
      for (const polygon of sliceOfCurved(mesh, t, [...corners], bends, heightOf)) polygons.push(polygon);
      continue;
    }
    const edges = crossings([0, 1, 2, 3], (i) => heights[corners[i]]);
    if (edges) polygons.push({ element: t, corners: edges.map(([i, k]) => pointBetween(mesh, corners, i, k, heights[corners[i]] / (heights[corners[i]] - heights[corners[k]]))) });
  }
  return polygons;
}

/** The edges between four nodes that a plane crosses, each from below to above, in their order around the cut; null if there are none. */
function crossings(nodes, heightOf) {
  const below = [], above = [];
  for (const node of nodes) (heightOf(node) > 0 ? above : below).push(node);
  if (below.length === 0 || above.length === 0) return null;
  // Of two above and two below each edge shares an end with the next.
  return below.length === 2 ? [[0, 0], [0, 1], [1, 1], [1, 0]].map(([i, k]) => [below[i], above[k]]) : below.flatMap((a) => above.map((b) => [a, b]));
}

/** The bends of an element that the plane may meet; none of others. */
function bendsNear(mesh, corners, heights) {
  const bends = bendsAmong(mesh, corners), reach = bends.reduce((most, [, , bend]) => Math.max(most, Math.hypot(...bend)), 0);
  if (bends.length === 0) return bends;
  const of = [...corners].map((v) => heights[v]);
  // 4 s t of two shares s, t, summed over six edges, is at most 3 / 2.
  return Math.min(...of) - 1.5 * reach <= 0 && Math.max(...of) + 1.5 * reach > 0 ? bends : [];
}

/** A corner of a slice on the edge from corner i of an element to corner k. */
function pointBetween({ points, around }, corners, i, k, share) {
  const a = corners[i], b = corners[k], shares = [0, 0, 0, 0];
  const at = (axis) => points[3 * a + axis] + share * (points[3 * b + axis] - points[3 * a + axis]);
  shares[i] = 1 - share;
  shares[k] = share;
  return [at(0), at(1), at(2), around[a] + share * (around[b] - around[a]), ...shares];
}

// Position 3 x float, colour 3 x byte and whether it is of a slice, element as a whole number, length around, shares 4 x 16 bits:
// edges are where one of these is nothing.
const BYTES_PER_VERTEX = 32, FLOATS_PER_VERTEX = 8;
const SHARES_OF_CORNER = [[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]];

/** Vertices as the graphics card wants them, three for each triangle. */
class VertexData {
  constructor(triangles) {
    this.buffer = new ArrayBuffer(triangles * 3 * BYTES_PER_VERTEX);
    this.floats = new Float32Array(this.buffer);
    this.bytes = new Uint8Array(this.buffer);
    this.words = new Uint32Array(this.buffer);
    this.halves = new Uint16Array(this.buffer);
    this.at = 0;
  }
  add(x, y, z, around, s0, s1, s2, s3, colour, element, inSlice = 0) {
    const { at, floats, bytes, halves } = this;
    floats[at] = x;
    floats[at + 1] = y;
    floats[at + 2] = z;
    bytes[4 * at + 12] = colour[0];
    bytes[4 * at + 13] = colour[1];
    bytes[4 * at + 14] = colour[2];
    bytes[4 * at + 15] = inSlice;
    this.words[at + 4] = element;
    floats[at + 5] = around;
    halves[2 * at + 12] = 65535 * s0;
    halves[2 * at + 13] = 65535 * s1;
    halves[2 * at + 14] = 65535 * s2;
    halves[2 * at + 15] = 65535 * s3;
    this.at += FLOATS_PER_VERTEX;
  }
}

/** Faces, and polygons of a slice if there is one. */
function vertexData(mesh, faces, quantity, polygons = null) {
  const { tets, points, around } = mesh;
  const cornersOfFace = (h) => [0, 1, 2].map((k) => tets[4 * (h >>> 2) + FACES[3 * (h & 3) + k]]);
  const bends = new Map();
  if (mesh.bends) {
    for (let f = 0; f < faces.count; ++f) {
      const found = bendsAmong(mesh, cornersOfFace(faces.half[f]));
      if (found.length > 0) bends.set(f, found);
    }
  }
  const flat = faces.count - bends.size, curved = bends.size * (mesh.bends?.parts ?? 0) ** 2;
  const data = new VertexData((polygons ?? []).reduce((sum, p) => sum + p.corners.length - 2, flat + curved)), colourOf = faceColours(mesh, quantity);
  for (let f = 0; f < faces.count; ++f) {
    const h = faces.half[f], t = h >>> 2, i = h & 3;
    const colour = colourOf(t, faces.patch[f]);
    if (bends.has(f)) {
      for (const part of partsOfFace(mesh, cornersOfFace(h), bends.get(f))) for (const corner of part) data.add(...corner, colour, t);
      continue;
    }
    for (let k = 0; k < 3; ++k) {
      const v = tets[4 * t + FACES[3 * i + k]], s = SHARES_OF_CORNER[k];
      data.add(points[3 * v], points[3 * v + 1], points[3 * v + 2], around[v], s[0], s[1], s[2], s[3], colour, t);
    }
  }
  for (const { element, corners } of polygons ?? []) {
    const colour = colourOf(element, 0);
    for (let i = 2; i < corners.length; ++i) for (const corner of [corners[0], corners[i - 1], corners[i]]) data.add(...corner, colour, element, 1);
  }
  return data.buffer;
}
