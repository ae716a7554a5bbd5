// --- decode.js: the mesh out of the page. How it was packed: mesh_streams.h.

const FACES = [1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1]; // corners of face i, counter-clockwise seen from outside
const EDGES = [0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3];

/** The page that has the mesh: this one, or one that was read. */
let pageOfMesh = document;

function json(id) {
  return JSON.parse(pageOfMesh.getElementById(id).textContent);
}

async function streamOf(name) {
  const element = pageOfMesh.getElementById("mesh-" + name);
  if (!element) return new Uint8Array(0);
  const text = atob(element.textContent);
  element.remove(); // the page need not keep it twice
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const inflated = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(inflated).arrayBuffer());
}

/** Reads numbers of seven bits a byte, one after another. */
class Numbers {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  get more() {
    return this.at < this.bytes.length;
  }
  next() {
    const bytes = this.bytes;
    let byte = bytes[this.at++];
    let value = byte & 127;
    for (let place = 128; byte >= 128; place *= 128) {
      byte = bytes[this.at++];
      value += (byte & 127) * place;
    }
    return value;
  }
  difference() {
    const n = this.next();
    return n % 2 === 1 ? -(n + 1) / 2 : n / 2;
  }
}

function decodeTets(bytes, count) {
  const numbers = new Numbers(bytes);
  const tets = new Uint32Array(4 * count);
  let met = 0;
  for (let i = 0; i < tets.length; ++i) {
    const behind = numbers.next();
    tets[i] = met - behind;
    if (behind === 0) ++met;
  }
  return tets;
}

/** Steps from the origin: x, y, z of each point. */
function decodePoints(bytes, count) {
  const numbers = new Numbers(bytes);
  const points = new Int32Array(3 * count);
  for (let axis = 0; axis < 3; ++axis) {
    let last = 0;
    for (let v = 0; v < count; ++v) points[3 * v + axis] = last += numbers.difference();
  }
  return points;
}

/** Half-faces 4 t + i, those on the other side for faces inside, and what goes with each. */
function decodeFaces(bytes, twoSided) {
  const numbers = new Numbers(bytes);
  const low = [], high = [], number = [];
  for (let last = 0; numbers.more; ) {
    low.push((last += numbers.next()));
    if (twoSided) high.push(last + numbers.next());
    number.push(numbers.next());
  }
  return { low: Uint32Array.from(low), high: Uint32Array.from(high), number: Uint32Array.from(number) };
}

function decodeRegions(bytes, count) {
  const regions = new Uint32Array(count);
  const numbers = new Numbers(bytes);
  for (let t = 0; t < count && numbers.more; ++t) regions[t] = numbers.next();
  return regions;
}

/** Points between -1 and 1, as the graphics card wants them: (p - middle) / radius in steps. */
function normalized(steps) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < steps.length; ++i) {
    const axis = i % 3;
    if (steps[i] < low[axis]) low[axis] = steps[i];
    if (steps[i] > high[axis]) high[axis] = steps[i];
  }
  const middle = low.map((l, axis) => (l + high[axis]) / 2);
  const radius = Math.hypot(...low.map((l, axis) => (high[axis] - l) / 2)) || 1;
  const points = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; ++i) points[i] = (steps[i] - middle[i % 3]) / radius;
  return { points, middle, radius };
}

/** The mesh with everything that is known of it. */
async function decodeMesh(page = document) {
  pageOfMesh = page;
  const facts = json("facts");
  const names = ["tets", "points", "bends", "region", "boundary", "walls", "beta", "min_dihedral", "max_dihedral", "size_ratio", "layers"];
  const bytes = Object.fromEntries(
    await Promise.all(names.map(async (name) => [name, await streamOf(name)])));
  const steps = decodePoints(bytes.points, facts.points);
  const mesh = {
    facts,
    steps,
    ...normalized(steps),
    tets: decodeTets(bytes.tets, facts.tets),
    region: decodeRegions(bytes.region, facts.tets),
    boundary: decodeFaces(bytes.boundary, false),
    walls: decodeFaces(bytes.walls, true),
    values: { beta: bytes.beta, min_dihedral: bytes.min_dihedral, max_dihedral: bytes.max_dihedral },
  };
  if (facts.has_sizes) mesh.values.size_ratio = bytes.size_ratio;
  if (facts.has_layers) mesh.values.layers = bytes.layers;
  mesh.around = lengthsAround(mesh);
  mesh.bends = decodeBends(bytes.bends, mesh);
  mesh.outline = withMiddles(mesh);
  return mesh;
}

/** Of each point the mean length of the edges that elements have there. */
function lengthsAround({ tets, points }) {
  const sums = new Float32Array(points.length / 3), counts = new Uint32Array(points.length / 3);
  for (let t = 0; t < tets.length; t += 4) {
    for (let e = 0; e < 12; e += 2) {
      const a = tets[t + EDGES[e]], b = tets[t + EDGES[e + 1]];
      const length = Math.hypot(points[3 * a] - points[3 * b], points[3 * a + 1] - points[3 * b + 1], points[3 * a + 2] - points[3 * b + 2]);
      sums[a] += length;
      sums[b] += length;
      ++counts[a];
      ++counts[b];
    }
  }
  for (let v = 0; v < sums.length; ++v) sums[v] /= counts[v] || 1;
  return sums;
}

/** From input units to the picture's, and back. */
function toPicture(mesh, at) {
  return at.map((x, axis) => ((x - mesh.facts.origin[axis]) / mesh.facts.step - mesh.middle[axis]) / mesh.radius);
}
function fromPicture(mesh, at) {
  return at.map((x, axis) => mesh.facts.origin[axis] + mesh.facts.step * (x * mesh.radius + mesh.middle[axis]));
}
