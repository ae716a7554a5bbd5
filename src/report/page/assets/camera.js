// --- camera.js: looks at a point from a distance. `axes` are right, up and back, as rows.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((x) => x / (Math.hypot(...a) || 1));
const along = (a, b, s) => a.map((x, i) => x + s * b[i]);

const VIEW_ANGLE = Math.PI / 7;
const START = { back: unit([1.1, -1.5, 0.9]), up: [0, 0, 1] };

/** Of half the angle from top to bottom. A narrow picture sees as much as a square one. */
const tangentOf = (canvas) => Math.tan(VIEW_ANGLE / 2) / Math.min(1, canvas.clientWidth / Math.max(1, canvas.clientHeight));

class Camera {
  constructor() {
    this.look(START.back, START.up);
    this.target = [0, 0, 0];
    this.distance = 0.98 / Math.sin(VIEW_ANGLE / 2);
  }
  /** Seen from the direction `back`, with `up` upward. */
  look(back, up) {
    const right = unit(cross(up, back));
    this.axes = [right, cross(back, right), back];
  }
  get back() {
    return this.axes[2];
  }
  /** By angles about its own upward and sideward axis. */
  turn(sideward, upward) {
    const about = (axis, angle, v) => {
      const c = Math.cos(angle), s = Math.sin(angle), k = cross(axis, v), d = dot(axis, v) * (1 - c);
      return v.map((x, i) => x * c + k[i] * s + axis[i] * d);
    };
    const [right, up] = this.axes;
    let back = about(up, -sideward, this.back);
    back = about(right, -upward, back);
    this.look(unit(back), about(right, -upward, up));
  }
  /** By parts of the picture's height. */
  shift(sideward, upward) {
    const height = 2 * this.distance * Math.tan(VIEW_ANGLE / 2);
    this.target = along(along(this.target, this.axes[0], -sideward * height), this.axes[1], upward * height);
  }
  zoom(factor) {
    this.distance = Math.min(40, Math.max(1e-5, this.distance * factor));
  }
  /**
   * Looks from where it does at all these points, so near that they just lie between lines of sight of these slopes
   * sideward and upward.
   */
  frame(points, slopes) {
    const [r, u, b] = this.axes;
    this.target = [0, 0, 0];
    // The picture's middle is moved to that of what is seen, which changes as the camera comes nearer.
    for (let round = 0; round < 3; ++round) {
      // How far the lines of sight of the four sides have to go back for each point to lie between them.
      const reach = [-Infinity, -Infinity, -Infinity, -Infinity], [t0, t1, t2] = this.target;
      for (let i = 0; i < points.length; i += 3) {
        const p0 = points[i] - t0, p1 = points[i + 1] - t1, p2 = points[i + 2] - t2;
        const z = b[0] * p0 + b[1] * p1 + b[2] * p2;
        const x = (r[0] * p0 + r[1] * p1 + r[2] * p2) / slopes[0], y = (u[0] * p0 + u[1] * p1 + u[2] * p2) / slopes[1];
        if (z + x > reach[0]) reach[0] = z + x;
        if (z - x > reach[1]) reach[1] = z - x;
        if (z + y > reach[2]) reach[2] = z + y;
        if (z - y > reach[3]) reach[3] = z - y;
      }
      this.target = along(along(this.target, r, ((reach[0] - reach[1]) / 2) * slopes[0]), u, ((reach[2] - reach[3]) / 2) * slopes[1]);
      this.distance = Math.max((reach[0] + reach[1]) / 2, (reach[2] + reach[3]) / 2, 1e-3);
    }
  }
  /** Column by column, for a picture `aspect` times as wide as high. A narrow picture sees as much as a square one. */
  matrices(aspect) {
    const eye = along(this.target, this.back, this.distance);
    const [r, u, b] = this.axes;
    const view = [r[0], u[0], b[0], 0, r[1], u[1], b[1], 0, r[2], u[2], b[2], 0, -dot(r, eye), -dot(u, eye), -dot(b, eye), 1];
    const reach = Math.hypot(...this.target) + 1.05;
    const near = Math.max(this.distance * 0.01, this.distance - reach), far = this.distance + reach;
    const f = (1 / Math.tan(VIEW_ANGLE / 2)) * Math.min(1, aspect);
    const projection = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
    return { view, projection };
  }
  copy() {
    return Object.assign(Object.create(Camera.prototype), {
      axes: this.axes.map((a) => [...a]), target: [...this.target], distance: this.distance });
  }
}

/** From the camera as it is to another target and distance, in half a second. */
function fly(camera, target, distance, draw) {
  const from = camera.copy(), start = performance.now(), length = 500;
  const step = (now) => {
    const t = Math.min(1, Math.max(0, (now - start) / length)), s = t * t * (3 - 2 * t);
    camera.target = from.target.map((x, i) => x + s * (target[i] - x));
    camera.distance = from.distance * (distance / from.distance) ** s;
    draw();
    if (t < 1) requestAnimationFrame(step);
  };
  step(start);
}

/** Mouse, wheel and fingers move the camera of `cameraOf()`, if there is one; `click(x, y, event)` hears of what moved nothing. */
function followPointers(canvas, cameraOf, redraw, click = () => {}) {
  const fingers = new Map(), STILL = 4; // pixels
  let moved = 0;
  const spread = () => {
    const [a, b] = [...fingers.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, width: Math.hypot(a.x - b.x, a.y - b.y) || 1 };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    moved = fingers.size > 1 ? Infinity : 0;
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId), camera = cameraOf();
    if (!last || !camera) return;
    const height = canvas.clientHeight, before = fingers.size > 1 ? spread() : null;
    const x = event.offsetX - last.x, y = event.offsetY - last.y;
    moved += Math.abs(x) + Math.abs(y);
    fingers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    if (before) {
      const now = spread();
      camera.zoom(before.width / now.width);
      camera.shift((now.x - before.x) / height, (now.y - before.y) / height);
    } else if (event.buttons & 6 || event.shiftKey) camera.shift(x / height, y / height);
    else camera.turn((3 * x) / height, (3 * y) / height);
    redraw();
  });
  const up = (event) => {
    const last = fingers.get(event.pointerId);
    fingers.delete(event.pointerId);
    if (last && moved <= STILL && event.type === "pointerup" && event.button === 0) click(last.x, last.y, event);
  };
  for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, up);
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    cameraOf()?.zoom(Math.exp(Math.max(-1, Math.min(1, event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)))));
    redraw();
  }, { passive: false });
}
