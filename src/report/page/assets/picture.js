// --- picture.js: WebGL 2. Light comes from the viewer; the edges of elements are drawn inside their faces, and fade
// where elements are small on the screen: by the lengths around each point, so that neighbours fade alike.

const VERTEX_SHADER = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 colour;
layout(location = 2) in uint element;
layout(location = 3) in float around;
layout(location = 4) in vec4 shares;
uniform mat4 view, projection;
out vec3 seen, place;
out vec4 corner;
out float length_around;
flat out vec3 paint;
flat out uint number, in_slice;
void main() {
  vec4 p = view * vec4(position, 1);
  seen = p.xyz;
  place = position;
  length_around = around;
  corner = shares;
  in_slice = uint(colour.a * 255.0 + 0.5);
  paint = colour.rgb;
  number = element;
  gl_Position = projection * p;
}`;

const FRAGMENT_SHADER = `#version 300 es
precision highp float;
in vec3 seen, place;
in vec4 corner;
in float length_around;
flat in vec3 paint;
flat in uint number, in_slice;
uniform float edges, opacity, pixels;
uniform vec4 plane;
uniform bool picking;
out vec4 result;
void main() {
  if (in_slice == 0u && dot(plane.xyz, place) > plane.w) discard;
  if (picking) {
    uint n = number + 1u;
    result = vec4(n & 255u, n >> 8 & 255u, n >> 16 & 255u, n >> 24) / 255.0;
    return;
  }
  vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
  float light = 0.5 + 0.44 * abs(normal.z) + 0.1 * normal.y - 0.04 * normal.x;
  vec3 tint = gl_FrontFacing || in_slice == 1u ? paint : mix(paint, vec3(0.5), 0.35) * 0.75;
  // Where a share is nothing, an edge is; what is everywhere the same is none.
  vec4 width = max(fwidth(corner), 1e-6);
  vec4 near = smoothstep(width * 0.25, width * 1.15, corner);
  float line = 1.0 - min(min(near.x, near.y), min(near.z, near.w));
  // Where triangles are some pixels wide only, lines would hide all colour.
  float room = smoothstep(4.0, 22.0, length_around * pixels / -seen.z);
  result = vec4(mix(tint * light, vec3(0.05, 0.06, 0.09), line * room * edges * 0.62), opacity);
}`;

class Picture {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", { alpha: false, antialias: true, powerPreference: "high-performance" });
    if (!this.gl) throw new Error("this browser has no WebGL 2");
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => {
      this.prepare();
      this.onRestored?.();
    });
    this.prepare();
  }

  prepare() {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, VERTEX_SHADER], [gl.FRAGMENT_SHADER, FRAGMENT_SHADER]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    this.uniform = {};
    for (const name of ["view", "projection", "edges", "opacity", "picking", "pixels", "plane"]) this.uniform[name] = gl.getUniformLocation(program, name);
    this.solid = this.newLayer();
    this.ghost = this.newLayer();
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  newLayer() {
    const gl = this.gl, layer = { array: gl.createVertexArray(), buffer: gl.createBuffer(), vertices: 0 };
    gl.bindVertexArray(layer.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, layer.buffer);
    for (const place of [0, 1, 2, 3, 4]) gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, BYTES_PER_VERTEX, 0);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, BYTES_PER_VERTEX, 12);
    gl.vertexAttribIPointer(2, 1, gl.UNSIGNED_INT, BYTES_PER_VERTEX, 16);
    gl.vertexAttribPointer(3, 1, gl.FLOAT, false, BYTES_PER_VERTEX, 20);
    gl.vertexAttribPointer(4, 4, gl.UNSIGNED_SHORT, true, BYTES_PER_VERTEX, 24);
    return layer;
  }

  fill(layer, data) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, layer.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    layer.vertices = data.byteLength / BYTES_PER_VERTEX;
  }

  /** As many pixels as the screen has, up to twice those of the style sheet. */
  fit() {
    const scale = Math.min(2, window.devicePixelRatio || 1);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * scale));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * scale));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
  }

  draw(camera, { edges, background, plane = this.plane, picking = false }) {
    this.plane = plane;
    const gl = this.gl;
    const { view, projection } = camera.matrices(this.canvas.width / this.canvas.height);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.uniformMatrix4fv(this.uniform.view, false, view);
    gl.uniformMatrix4fv(this.uniform.projection, false, projection);
    gl.uniform1f(this.uniform.edges, edges ? 1 : 0);
    // Of the style sheet, for a length of one at a distance of one.
    gl.uniform1f(this.uniform.pixels, 0.5 * this.canvas.clientHeight * projection[5]);
    gl.uniform4f(this.uniform.plane, ...plane);
    gl.uniform1f(this.uniform.opacity, 1);
    gl.uniform1i(this.uniform.picking, picking ? 1 : 0);
    gl.disable(gl.BLEND);
    gl.depthMask(true);
    gl.clearColor(...(picking ? [0, 0, 0, 0] : background));
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.drawLayer(this.solid);
    if (picking || this.ghost.vertices === 0) return;
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    gl.uniform1f(this.uniform.opacity, 0.12);
    gl.uniform1f(this.uniform.edges, 0);
    this.drawLayer(this.ghost);
  }
  drawLayer(layer) {
    this.gl.bindVertexArray(layer.array);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, layer.vertices);
  }

  /** The element at a place of the canvas, in pixels of the style sheet; -1 where there is none. */
  elementAt(camera, x, y) {
    const gl = this.gl, { width, height } = this.canvas;
    const frame = gl.createFramebuffer(), colour = gl.createRenderbuffer(), depth = gl.createRenderbuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    for (const [target, format, attachment] of [[colour, gl.RGBA8, gl.COLOR_ATTACHMENT0], [depth, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, target);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, target);
    }
    this.draw(camera, { picking: true });
    const pixel = new Uint8Array(4);
    const scale = width / this.canvas.clientWidth;
    gl.readPixels(Math.round(x * scale), height - 1 - Math.round(y * scale), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    for (const buffer of [colour, depth]) gl.deleteRenderbuffer(buffer);
    gl.deleteFramebuffer(frame);
    return pixel[0] + 256 * pixel[1] + 65536 * pixel[2] + 16777216 * pixel[3] - 1;
  }

  /** Waits until all that was asked for is drawn. */
  finish() {
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
  }
}

/** Places of the picture on the canvas, in pixels of the style sheet; null behind the viewer. */
function projector(camera, canvas) {
  const width = canvas.clientWidth, height = canvas.clientHeight;
  const { view, projection: p } = camera.matrices(width / height);
  return ([x, y, z]) => {
    const s = [0, 1, 2].map((i) => view[i] * x + view[4 + i] * y + view[8 + i] * z + view[12 + i]);
    if (s[2] >= 0) return null;
    return [(1 + (p[0] * s[0]) / -s[2]) * 0.5 * width, (1 - (p[5] * s[1]) / -s[2]) * 0.5 * height];
  };
}
