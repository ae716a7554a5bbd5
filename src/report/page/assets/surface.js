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
  } else if (beyond) {
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
  const table = scaleOf(QUANTITIES[quantity].stops), values = mesh.values[quantity];
  return (t) => {
    const i = 3 * values[t];
    return [table[i], table[i + 1], table[i + 2]];
  };
}

const BYTES_PER_VERTEX = 20; // position 3 x float, colour 4 x byte, element as a whole number

/** Faces as the graphics card wants them: three vertices each. */
function vertexData(mesh, faces, quantity) {
  const buffer = new ArrayBuffer(faces.count * 3 * BYTES_PER_VERTEX);
  const floats = new Float32Array(buffer), bytes = new Uint8Array(buffer), words = new Uint32Array(buffer);
  const colourOf = faceColours(mesh, quantity);
  const { tets, points } = mesh;
  for (let f = 0, at = 0; f < faces.count; ++f) {
    const h = faces.half[f], t = h >>> 2, i = h & 3;
    const colour = colourOf(t, faces.patch[f]);
    for (let k = 0; k < 3; ++k, at += 5) {
      const v = 3 * tets[4 * t + FACES[3 * i + k]];
      floats[at] = points[v];
      floats[at + 1] = points[v + 1];
      floats[at + 2] = points[v + 2];
      bytes[4 * at + 12] = colour[0];
      bytes[4 * at + 13] = colour[1];
      bytes[4 * at + 14] = colour[2];
      words[at + 4] = t;
    }
  }
  return buffer;
}
