// --- stage.js: the input and the mesh in 3D, by three.js; the camera is that of the report page.

import {
  BufferAttribute, BufferGeometry, Color, ColorManagement, DirectionalLight, DoubleSide, HemisphereLight, LineBasicMaterial, LinearSRGBColorSpace, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Plane, Raycaster,
  Scene, Vector2, Vector3, WebGLRenderer,
} from "three";

/** Triangles beyond which a page is no place to look at them. */
const MOST_TRIANGLES = 4e6;

/** Lines along the edges of elements, that fade where elements are small on the screen, as the report page has them. */
function withEdges(material, uniforms) {
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader.replace("void main() {", "attribute vec4 shares;\nattribute float around;\nvarying vec4 vShares;\nvarying float vAround;\nvoid main() {\nvShares = shares;\nvAround = around;");
    shader.fragmentShader = shader.fragmentShader.replace("void main() {", "varying vec4 vShares;\nvarying float vAround;\nuniform float edges, pixels;\nvoid main() {")
      .replace("#include <opaque_fragment>", `#include <opaque_fragment>
      vec4 width = max(fwidth(vShares), 1e-6), near = smoothstep(width * 0.25, width * 1.15, vShares);
      float line = 1.0 - min(min(near.x, near.y), min(near.z, near.w)), room = smoothstep(4.0, 22.0, vAround * pixels / vViewPosition.z);
      gl_FragColor.rgb = mix(gl_FragColor.rgb, vec3(0.05, 0.06, 0.09), line * room * edges * 0.62);`);
  };
  return material;
}

const geometryOf = (attributes) => {
  const geometry = new BufferGeometry();
  for (const [name, [array, size, normalized]] of Object.entries(attributes)) geometry.setAttribute(name, new BufferAttribute(array, size, normalized ?? false));
  return geometry;
};

ColorManagement.enabled = false;

class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    try {
      this.renderer = new WebGLRenderer({ canvas, antialias: true });
    } catch {
      throw new Error("this browser cannot draw (no WebGL 2): picking by the lists, meshing and saving work");
    }
    this.renderer.localClippingEnabled = true;
    this.renderer.outputColorSpace = LinearSRGBColorSpace; // colours are those of the legend
    this.scene = new Scene();
    this.eye = new PerspectiveCamera();
    this.light = new DirectionalLight(0xffffff, 1.7);
    this.scene.add(this.eye, new HemisphereLight(0xffffff, 0xb0b4ba, 1.6));
    this.eye.add(this.light);
    this.light.position.set(-0.2, 0.3, 1);
    this.scene.add(this.light.target);
    this.camera = new Camera();
    this.plane = new Plane();
    this.uniforms = { edges: { value: 1 }, pixels: { value: 500 } };
    this.ray = new Raycaster();
    this.waiting = false;
    new ResizeObserver(() => this.redraw()).observe(canvas);
  }

  // --- the input

  /** Takes its place; the frame of the picture, between -1 and 1, is its own. */
  showInput(surface) {
    this.clear();
    this.surface = surface;
    const { points, triangles } = surface, borders = bordersOf(surface);
    this.borders = borders;
    this.radius = radiusOf(points);
    const at = new Float32Array(3 * triangles.length);
    for (let i = 0; i < triangles.length; ++i) for (let k = 0; k < 3; ++k) at[3 * i + k] = points[3 * triangles[i] + k] / this.radius;
    const colour = new Uint8Array(at.length), normal = smoothNormals(surface, borders.normals);
    const material = new MeshLambertMaterial({ vertexColors: true, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.input = this.add(new Mesh(geometryOf({ position: [at, 3], normal: [normal, 3, true], color: [colour, 3, true] }), material));
    const ends = new Float32Array(6 * borders.lines.length), ink = new Uint8Array(ends.length);
    borders.lines.forEach((line, i) => line.ends.forEach((v, e) => [0, 1, 2].forEach((k) => (ends[6 * i + 3 * e + k] = points[3 * v + k] / this.radius))));
    this.lines = this.add(new LineSegments(geometryOf({ position: [ends, 3], color: [ink, 3, true] }), new LineBasicMaterial({ vertexColors: true })));
    this.outline = at;
    this.frame();
  }

  /** colourOf(triangle) and inkOf(line): bytes r, g, b. */
  paint(colourOf, inkOf) {
    if (!this.input) return;
    const colour = this.input.geometry.attributes.color, ink = this.lines.geometry.attributes.color;
    for (let t = 0; t < colour.count / 3; ++t) {
      const c = colourOf(t);
      for (let i = 0; i < 9; ++i) colour.array[9 * t + i] = c[i % 3];
    }
    this.borders.lines.forEach((line, n) => {
      const c = inkOf(line);
      for (let i = 0; i < 6; ++i) ink.array[6 * n + i] = c[i % 3];
    });
    colour.needsUpdate = ink.needsUpdate = true;
    this.redraw();
  }

  /** The triangle of the input, or the line between patches, that is seen there; null: none. */
  inputAt(x, y) {
    return this.input?.visible ? this.hit(this.input, x, y)?.faceIndex ?? null : null;
  }
  lineAt(x, y) {
    if (!this.lines?.visible) return null;
    const NEAR = 7; // pixels
    this.ray.params.Line.threshold = (NEAR * 2 * this.camera.distance * tangentOf(this.canvas)) / this.canvas.clientHeight;
    const found = this.hit(this.lines, x, y), before = this.hit(this.input, x, y);
    const hidden = found && before && before.distance < found.distance - 2 * this.ray.params.Line.threshold;
    return found && !hidden ? this.borders.lines[Math.floor(found.index / 2)] : null;
  }
  /** Of what the cut leaves. */
  hit(object, x, y) {
    this.ray.setFromCamera(new Vector2((2 * x) / this.canvas.clientWidth - 1, 1 - (2 * y) / this.canvas.clientHeight), this.eye);
    const isCut = (object.material.clippingPlanes ?? []).length > 0;
    const found = this.ray.intersectObject(object, false).filter((h) => !isCut || this.plane.distanceToPoint(h.point) >= 0);
    // Of lines the nearest to the pointer, else the nearest to the viewer.
    return object.isLineSegments ? found.sort((a, b) => this.ray.ray.distanceSqToPoint(a.point) - this.ray.ray.distanceSqToPoint(b.point) || a.distance - b.distance)[0] : found[0];
  }

  /** In its place another surface, with the edges of its triangles. */
  showPreview(surface, colourOfPatch) {
    this.drop("preview");
    const { points, triangles, patch, middle } = surface, count = triangles.length;
    const at = new Float32Array(3 * count), colour = new Uint8Array(3 * count), shares = new Uint16Array(4 * count), around = new Float32Array(count);
    const colours = surface.patches.map((_, i) => colourOfPatch(i));
    for (let i = 0; i < count; ++i) {
      const v = 3 * triangles[i], t = Math.floor(i / 3), next = 3 * triangles[3 * t + ((i + 1) % 3)];
      for (let k = 0; k < 3; ++k) {
        at[3 * i + k] = (points[v + k] + middle[k] - this.middle[k]) / this.radius;
        colour[3 * i + k] = colours[patch[t]][k];
      }
      around[i] = Math.hypot(points[v] - points[next], points[v + 1] - points[next + 1], points[v + 2] - points[next + 2]) / this.radius;
      SHARES_OF_CORNER[i % 3].forEach((s, k) => (shares[4 * i + k] = 65535 * s));
    }
    const material = withEdges(new MeshLambertMaterial({ vertexColors: true, side: DoubleSide, flatShading: true }), this.uniforms);
    this.preview = this.add(new Mesh(geometryOf({ position: [at, 3], color: [colour, 3, true], shares: [shares, 4, true], around: [around, 1] }), material));
    this.show("preview");
    this.redraw();
  }
  hidePreview() {
    this.drop("preview");
  }

  // --- the mesh

  /** A mesh of the page of a report, where the input is. */
  showMesh(mesh) {
    this.drop("mesh");
    this.tets = mesh;
    if (!this.surface) this.takeFrameOf(mesh);
    const { origin, step } = mesh.facts;
    this.scale = (step * mesh.radius) / this.radius;
    this.shift = mesh.middle.map((m, i) => (origin[i] + step * m - this.middle[i]) / this.radius);
  }
  takeFrameOf(mesh) {
    this.radius = mesh.facts.step * mesh.radius;
    this.ownMiddle = mesh.middle.map((m, i) => mesh.facts.origin[i] + mesh.facts.step * m);
    this.outline = mesh.outline;
    this.frame();
  }
  get middle() {
    return this.surface?.middle ?? this.ownMiddle;
  }

  /** Draws the faces that `state` leaves (surface.js), and returns how many elements a filter passed. */
  fillMesh(state) {
    this.drop("mesh");
    const mesh = this.tets, clip = state.clip;
    const own = { ...state, clip: { ...clip, offset: (clip.offset - dot(clip.normal, this.shift)) / this.scale } };
    const faces = visibleFaces(mesh, own);
    const buffer = vertexData(mesh, faces.solid, state.quantity, isSmooth(own) ? slice(mesh, own) : null);
    this.mesh = this.add(this.meshOf(buffer));
    this.mesh.material.clippingPlanes = [];
    this.applyCut(clip);
    this.redraw();
    return faces.passed;
  }
  meshOf(buffer) {
    const count = buffer.byteLength / BYTES_PER_VERTEX, floats = new Float32Array(buffer), bytes = new Uint8Array(buffer), halves = new Uint16Array(buffer);
    const at = new Float32Array(3 * count), colour = new Uint8Array(3 * count), shares = new Uint16Array(4 * count), around = new Float32Array(count);
    this.elements = new Uint32Array(count / 3);
    const words = new Uint32Array(buffer);
    for (let v = 0; v < count; ++v) {
      for (let i = 0; i < 3; ++i) {
        at[3 * v + i] = floats[FLOATS_PER_VERTEX * v + i] * this.scale + this.shift[i];
        colour[3 * v + i] = bytes[BYTES_PER_VERTEX * v + 12 + i];
      }
      around[v] = floats[FLOATS_PER_VERTEX * v + 5] * this.scale;
      for (let i = 0; i < 4; ++i) shares[4 * v + i] = halves[2 * FLOATS_PER_VERTEX * v + 12 + i];
      if (v % 3 === 0) this.elements[v / 3] = words[FLOATS_PER_VERTEX * v + 4];
    }
    const material = withEdges(new MeshLambertMaterial({ vertexColors: true, side: DoubleSide, flatShading: true }), this.uniforms);
    return new Mesh(geometryOf({ position: [at, 3], color: [colour, 3, true], shares: [shares, 4, true], around: [around, 1] }), material);
  }
  elementAt(x, y) {
    const found = this.mesh?.visible ? this.hit(this.mesh, x, y) : null;
    return found ? this.elements[found.faceIndex] : -1;
  }
  /** Where a corner of an element is in the picture. */
  placeOf(v) {
    return [0, 1, 2].map((i) => this.tets.points[3 * v + i] * this.scale + this.shift[i]);
  }
  cornersOf(element) {
    return [0, 1, 2, 3].map((i) => this.placeOf(this.tets.tets[4 * element + i]));
  }
  /** Draws an element over all else, so that it shines through; -1: none. */
  mark(element, color) {
    this.drop("marked", "outlined");
    if (element >= 0) {
      const corners = this.cornersOf(element), through = (indices) => geometryOf({ position: [new Float32Array(indices.flatMap((i) => corners[i])), 3] });
      this.marked = this.add(new Mesh(through(FACES), new MeshBasicMaterial({ color, depthTest: false, transparent: true, opacity: 0.45 })));
      this.outlined = this.add(new LineSegments(through(EDGES), new LineBasicMaterial({ color, depthTest: false })));
      this.marked.renderOrder = this.outlined.renderOrder = 1;
    }
    this.redraw();
  }
  goTo(element) {
    const corners = this.cornersOf(element), middle = [0, 1, 2].map((i) => corners.reduce((sum, c) => sum + c[i], 0) / 4);
    const size = Math.max(...corners.map((c) => Math.hypot(...c.map((x, i) => x - middle[i]))), 1e-6);
    fly(this.camera, middle, (size * 14) / Math.sin(VIEW_ANGLE / 2) / 2, () => this.redraw());
    return middle;
  }

  // --- what both have

  add(object) {
    object.frustumCulled = false;
    this.scene.add(object);
    return object;
  }
  drop(...keys) {
    for (const key of keys) {
      if (!this[key]) continue;
      this.scene.remove(this[key]);
      this[key].geometry.dispose();
      this[key].material.dispose();
      this[key] = null;
    }
  }
  clear() {
    this.drop("input", "lines", "mesh", "marked", "outlined", "preview");
    this.surface = this.tets = null;
  }
  /** Either the input or the mesh is seen. */
  show(what) {
    for (const [key, of] of [["input", "input"], ["lines", "input"], ["mesh", "mesh"], ["marked", "mesh"], ["outlined", "mesh"], ["preview", "preview"]]) if (this[key]) this[key].visible = what === of;
    this.redraw();
  }
  /** Of the input what lies beyond the plane is not drawn; of the mesh only where the cut is smooth. */
  applyCut({ on, normal, offset, smooth }) {
    this.plane.set(new Vector3(...normal).negate(), offset);
    for (const object of [this.input, this.lines, this.preview]) if (object) object.material.clippingPlanes = on ? [this.plane] : [];
    // A hair behind the plane, where the faces of a smooth cut lie.
    if (this.mesh) this.mesh.material.clippingPlanes = on && smooth ? [new Plane(this.plane.normal, offset + 1e-5)] : [];
    this.redraw();
  }
  /** The least and largest offset at which a plane of this normal meets what is seen. */
  reachOf(normal) {
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < this.outline.length; i += 3) {
      const s = normal[0] * this.outline[i] + normal[1] * this.outline[i + 1] + normal[2] * this.outline[i + 2];
      if (s < low) low = s;
      if (s > high) high = s;
    }
    return [low, high];
  }
  frame() {
    const ROOM = 0.86, tangent = tangentOf(this.canvas), { clientWidth: width, clientHeight: height } = this.canvas;
    if (this.outline) this.camera.frame(this.outline, [((tangent * width) / Math.max(1, height)) * ROOM, tangent * ROOM]);
    this.redraw();
  }
  lookFrom(back, up) {
    this.camera.look(back, up);
    this.frame();
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }
  draw() {
    const { canvas, camera, eye } = this, width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0 || height === 0) return;
    const ratio = Math.min(2, devicePixelRatio);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    const size = this.renderer.getSize(new Vector2());
    if (size.x !== width || size.y !== height) this.renderer.setSize(width, height, false);
    const reach = Math.hypot(...camera.target) + 1.5;
    Object.assign(eye, { aspect: width / height, fov: (360 / Math.PI) * Math.atan(tangentOf(canvas)), near: Math.max(camera.distance * 0.01, camera.distance - reach), far: camera.distance + reach });
    eye.position.set(...along(camera.target, camera.back, camera.distance));
    eye.up.set(...camera.axes[1]);
    eye.lookAt(...camera.target);
    eye.updateProjectionMatrix();
    eye.updateMatrixWorld();
    this.uniforms.pixels.value = (height * ratio) / (2 * tangentOf(canvas));
    const paper = getComputedStyle(document.documentElement).getPropertyValue("--canvas").trim().split(/\s+/).map((c) => Number(c) / 255);
    this.scene.background = new Color(...paper);
    this.renderer.render(this.scene, eye);
  }
}

function radiusOf(points) {
  let most = 0;
  for (let i = 0; i < points.length; i += 3) most = Math.max(most, Math.hypot(points[i], points[i + 1], points[i + 2]));
  return most || 1;
}
