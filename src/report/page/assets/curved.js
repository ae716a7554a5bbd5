// --- curved.js: edges and faces of second order. An edge that bends is a parabola through its mid-side node; faces and elements
// that have such edges are drawn as the small flat ones into which their sides divide.

/**
 * Edges that bend: by their ends how far the mid-side node is from the middle of these; which points have such edges, and
 * into how many parts a side is divided. null where all edges are straight.
 */
function decodeBends(bytes, mesh) {
  if (bytes.length === 0) return null;
  const numbers = new Numbers(bytes), { tets, points, radius } = mesh;
  const bends = { of: new Map(), at: new Uint8Array(points.length / 3), points: points.length / 3, parts: 2 };
  const ratios = [];
  for (let last = 0; numbers.more; ) {
    last += numbers.next();
    const t = Math.floor(last / 6), e = 2 * (last % 6), a = tets[4 * t + EDGES[e]], b = tets[4 * t + EDGES[e + 1]];
    const bend = [0, 1, 2].map(() => numbers.difference() / radius);
    bends.of.set(edgeKey(bends, a, b), bend);
    bends.at[a] = bends.at[b] = 1;
    ratios.push(Math.hypot(...bend) / Math.hypot(...[0, 1, 2].map((i) => points[3 * a + i] - points[3 * b + i])));
  }
  const most = ratios.sort((a, b) => a - b)[Math.floor(0.98 * ratios.length)];
  // The parts of an edge leave the parabola by its bend over the square of their number.
  const NOT_SEEN = 0.003, MOST_EDGES = 200000;
  while (bends.parts < 8 && most / bends.parts ** 2 > NOT_SEEN && bends.of.size * bends.parts < MOST_EDGES) bends.parts *= 2;
  return bends;
}
const edgeKey = (bends, a, b) => (a < b ? a * bends.points + b : b * bends.points + a);

/** Of an edge: how far its mid-side node is from the middle of its ends; null if it is straight. */
function bendOf({ bends }, a, b) {
  return bends && bends.at[a] && bends.at[b] ? bends.of.get(edgeKey(bends, a, b)) ?? null : null;
}
/** Of a face, or an element, by its corners: [i, k, bend] of each edge that is not straight. */
function bendsAmong(mesh, corners) {
  const found = [];
  if (!mesh.bends) return found;
  for (let k = 1; k < corners.length; ++k)
    for (let i = 0; i < k; ++i) {
      const bend = bendOf(mesh, corners[i], corners[k]);
      if (bend) found.push([i, k, bend]);
    }
  return found;
}

/** What a picture of the mesh has to hold: its points, and the mid-side nodes of edges that bend. */
function withMiddles({ bends, points }) {
  if (!bends) return points;
  const all = new Float32Array(points.length + 3 * bends.of.size);
  all.set(points);
  let at = points.length;
  for (const [key, bend] of bends.of) {
    const a = Math.floor(key / bends.points), b = key % bends.points;
    for (let i = 0; i < 3; ++i) all[at++] = (points[3 * a + i] + points[3 * b + i]) / 2 + bend[i];
  }
  return all;
}

/** The point of a face or element with `shares` in its corners: its coordinates, then the lengths around it. */
function pointAmong({ points, around }, corners, bends, shares) {
  const at = [0, 0, 0, 0];
  corners.forEach((v, i) => {
    for (let k = 0; k < 3; ++k) at[k] += shares[i] * points[3 * v + k];
    at[3] += shares[i] * around[v];
  });
  for (const [i, k, bend] of bends) for (let c = 0; c < 3; ++c) at[c] += 4 * shares[i] * shares[k] * bend[c];
  return at;
}

/** A face as parts^2 triangles: the corners of each, [x, y, z, length around, shares in the face's three corners, 1]. */
function partsOfFace(mesh, corners, bends) {
  const n = mesh.bends.parts, triangles = [], rows = [];
  for (let i = 0; i <= n; ++i) {
    rows.push([]);
    for (let k = 0; k <= n - i; ++k) {
      const shares = [(n - i - k) / n, i / n, k / n];
      rows[i].push([...pointAmong(mesh, corners, bends, shares), ...shares, 1]);
    }
  }
  for (let i = 0; i < n; ++i)
    for (let k = 0; k < n - i; ++k) {
      triangles.push([rows[i][k], rows[i + 1][k], rows[i][k + 1]]);
      if (i + k < n - 1) triangles.push([rows[i + 1][k + 1], rows[i][k + 1], rows[i + 1][k]]);
    }
  return triangles;
}

/** The elements of n^3 into which one divides: their corners by shares in its four. n is a power of two. */
const partsOfElement = (() => {
  const made = new Map([[1, [[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]]]]);
  const eight = ([a, b, c, d]) => {
    const middle = (p, q) => p.map((x, i) => (x + q[i]) / 2);
    const [ab, ac, ad, bc, bd, cd] = [middle(a, b), middle(a, c), middle(a, d), middle(b, c), middle(b, d), middle(c, d)];
    return [[a, ab, ac, ad], [ab, b, bc, bd], [ac, bc, c, cd], [ad, bd, cd, d], [ab, ac, ad, bd], [ab, ac, bc, bd], [ac, ad, bd, cd], [ac, bc, bd, cd]];
  };
  return (n) => {
    if (!made.has(n)) made.set(n, partsOfElement(n / 2).flatMap(eight));
    return made.get(n);
  };
})();

/** Where the plane of the cut goes through an element with edges that bend, as slice() has it. */
function sliceOfCurved(mesh, element, corners, bends, heightOf) {
  const polygons = [], known = new Map();
  const nodeAt = (shares) => {
    const key = shares.join();
    if (!known.has(key)) {
      const at = pointAmong(mesh, corners, bends, shares);
      known.set(key, { at: [...at, ...shares], height: heightOf(...at) });
    }
    return known.get(key);
  };
  for (const part of partsOfElement(mesh.bends.parts)) {
    const edges = crossings(part.map(nodeAt), (node) => node.height);
    if (!edges) continue;
    const between = (a, b) => a.at.map((x, i) => x + (a.height / (a.height - b.height)) * (b.at[i] - x));
    polygons.push({ element, corners: edges.map(([a, b]) => between(a, b)) });
  }
  return polygons;
}
