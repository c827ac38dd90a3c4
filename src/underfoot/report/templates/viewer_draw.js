// One canvas: the sole drawn by WebGL 2, seen by a camera that turns about a point.

const VERTEX = `#version 300 es
layout(location = 0) in vec4 place; layout(location = 1) in vec2 cell; layout(location = 2) in float kind;
uniform mat4 camera; uniform vec3 plane; uniform float stretch, load;
out vec3 world; out vec2 at; out float level; flat out float sort;
void main() {
  float base = plane.x + plane.y * place.x + plane.z * place.y;
  world = vec3(place.xy, base + stretch * (mix(place.z, place.w, load) - base));
  at = cell; sort = kind; level = place.z; gl_Position = camera * vec4(world, 1.0);
}`;

const FRAGMENT = `#version 300 es
precision highp float; precision highp sampler2D;
in vec3 world; in vec2 at; in float level; flat in float sort; out vec4 colour;
uniform sampler2D cells, colours; uniform vec3 light, rubber, line; uniform vec2 limits;
uniform vec4 computed; uniform bool logarithmic, picking; uniform float spacing;
const float NONE = -1e29;
void main() {
  ivec2 own = ivec2(at), size = textureSize(cells, 0).yx;
  if (picking) {
    if (sort > 3.5) discard;
    int n = own.x * size.y + own.y + 1;
    colour = vec4(float(n & 255), float((n >> 8) & 255), float((n >> 16) & 255), 255.0) / 255.0;
    return;
  }
  if (sort > 3.5) { colour = vec4(line, 1.0); return; }
  vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
  float shade = abs(dot(normal, light));
  bool solved = all(greaterThanEqual(at, computed.xy)) && all(lessThan(at, computed.zw));
  vec3 base = mix(line, rubber, solved ? 1.0 : 0.4) * (sort > 2.5 ? 0.8 : sort > 1.5 ? 0.7 : 1.0);
  if (sort < 1.5) {
    // between cells of the same kind and level, never across the wall of a lug
    vec2 p = at - 0.5, f = p - floor(p);
    float sum = 0.0, weight = 0.0, all = 0.0, nearest = 2.3, nearby = -1e30;
    for (int k = 0; k < 16; k++) {
      ivec2 step = ivec2(k >> 2, k & 3) - 1, c = ivec2(floor(p)) + step;
      if (any(lessThan(c, ivec2(0))) || any(greaterThanEqual(c, size))) continue;
      vec3 there = texelFetch(cells, c.yx, 0).rgb; // height, land, value
      if (there.r < NONE || abs(there.g - sort) > 0.5 || abs(there.r - level) > 2.0 * spacing) continue;
      vec2 off = abs(vec2(step) - f);
      float w = max(1.0 - off.x, 0.0) * max(1.0 - off.y, 0.0), away = length(off);
      all += w;
      if (there.b > NONE) { sum += w * there.b; weight += w; }
      if (away < nearest) { nearest = away; nearby = there.b; }
    }
    float value = all < 1e-4 ? nearby : weight >= 0.5 * all ? sum / weight : -1e30;
    if (value > NONE) {
      float t = logarithmic ? log(value / limits.x) / log(limits.y / limits.x)
                            : (value - limits.x) / (limits.y - limits.x);
      base = texture(colours, vec2((clamp(t, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
      colour = vec4(base * (0.72 + 0.28 * shade), 1.0);
      return;
    }
  }
  colour = vec4(base * (0.55 + 0.45 * shade), 1.0);
}`;

function program(gl) {
  const made = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  return made;
}

function multiply(a, b) {
  const c = new Float32Array(16);
  for (let i = 0; i < 4; i++) for (let j = 0; j < 4; j++) for (let k = 0; k < 4; k++) c[j * 4 + i] += a[k * 4 + i] * b[j * 4 + k];
  return c;
}

// Camera: tilt 0 looks straight up from below the floor with the walking direction up.
function axes(view) {
  const s = Math.sin(view.tilt), c = Math.cos(view.tilt), sp = Math.sin(view.turn), cp = Math.cos(view.turn);
  return { forward: [s * cp, s * sp, c], up: [c * cp, c * sp, -s], right: [-sp, cp, 0] };
}

function cameraMatrix(view, aspect) {
  const { forward: f, up: u, right: r } = axes(view), d = view.distance;
  const eye = view.target.map((t, k) => t - d * f[k]);
  const dot = (a) => -(a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2]);
  const look = [r[0], u[0], -f[0], 0, r[1], u[1], -f[1], 0, r[2], u[2], -f[2], 0, dot(r), dot(u), -dot(f), 1];
  const zoom = 1 / Math.tan(view.opening / 2), near = d * 0.05, far = d * 6;
  const lens = [zoom / Math.max(aspect, 1e-3), 0, 0, 0, 0, zoom, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
  return multiply(lens, look);
}

// Smooth edges double the work of each pixel: for graphics processors, not for their imitations.
// Asked once: a page has few contexts.
let smooth = null;
function smoothEdges() {
  if (smooth !== null) return smooth;
  const gl = document.createElement("canvas").getContext("webgl2"), told = gl && gl.getExtension("WEBGL_debug_renderer_info");
  smooth = !told || !/SwiftShader|llvmpipe|Basic Render/.test(gl.getParameter(told.UNMASKED_RENDERER_WEBGL));
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return smooth;
}

class Drawing {
  constructor(canvas, pane, colours) {
    this.canvas = canvas; this.pane = pane;
    const gl = this.gl = canvas.getContext("webgl2", { antialias: smoothEdges(), alpha: true });
    if (!gl) throw new Error("WebGL 2 is not available");
    this.program = program(gl);
    gl.useProgram(this.program);
    this.place = {};
    for (const name of ["camera", "plane", "stretch", "cells", "colours", "load", "computed", "light", "rubber", "line", "limits", "logarithmic", "picking", "spacing"]) {
      this.place[name] = gl.getUniformLocation(this.program, name);
    }
    this.shape();
    const { lines, arrow, tip, far } = gridLines(pane, this.top);
    this.lineCount = lines.length / 7; this.arrowCount = arrow.length / 7; this.arrow = tip; this.far = far;
    this.grid = this.buffer(lines, null);
    this.pointer = this.buffer(arrow, null);
    this.tables = {};
    for (const [name, bytes] of Object.entries(colours)) this.tables[name] = this.texture(1, gl.RGB8, gl.RGB, gl.UNSIGNED_BYTE, bytes, 256, 1);
    gl.enable(gl.DEPTH_TEST);
  }

  // Take the shape of the sole from its pane, again where it has worn.
  shape() {
    const { gl, pane } = this, mesh = soleMesh(pane);
    if (this.sole) gl.deleteVertexArray(this.sole);
    this.count = mesh.faces.length;
    this.top = mesh.top;
    this.sole = this.buffer(mesh.points, mesh.faces);
    this.cells = new Float32Array(pane.nx * pane.ny * 3); // height, land, value: one look-up each
    pane.height.forEach((h, k) => this.cells.set([Number.isNaN(h) ? -1e30 : h, pane.land[k]], 3 * k));
  }

  buffer(points, faces) {
    const gl = this.gl, made = gl.createVertexArray();
    gl.bindVertexArray(made);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, points, gl.STATIC_DRAW);
    [[4, 0], [2, 16], [1, 24]].forEach(([size, start], k) => {
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, size, gl.FLOAT, false, 28, start);
    });
    if (faces) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, faces, gl.STATIC_DRAW);
    }
    return made;
  }

  texture(unit, inner, outer, type, data, width, height, old) {
    const gl = this.gl, made = old || gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, made);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, outer, type, data);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    for (const wrap of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, wrap, gl.CLAMP_TO_EDGE);
    return made;
  }

  show(values, quantity) {
    const { gl, cells, pane } = this;
    this.values = values; this.quantity = quantity;
    values.forEach((v, k) => { cells[3 * k + 2] = Number.isNaN(v) ? -1e30 : v; });
    this.field = this.texture(0, gl.RGB32F, gl.RGB, gl.FLOAT, cells, pane.ny, pane.nx, this.field);
  }

  resize() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2), { canvas } = this;
    const w = Math.max(1, Math.round(canvas.clientWidth * ratio)), h = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
  }

  draw(view, theme, picking = false) {
    const gl = this.gl, at = this.place, q = this.quantity, { forward: f, up: u, right: r } = axes(view);
    this.resize();
    this.matrix = cameraMatrix(view, this.canvas.width / this.canvas.height);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(at.camera, false, this.matrix);
    gl.uniform3fv(at.plane, this.pane.plane);
    gl.uniform1f(at.stretch, view.stretch);
    gl.uniform1f(at.load, view.load);
    gl.uniform1f(at.spacing, this.pane.spacing);
    const [i0, i1, j0, j1] = this.pane.computed || [-1, 1e6, -1, 1e6];
    gl.uniform4f(at.computed, i0, j0, i1, j1);
    gl.uniform3fv(at.light, [0, 1, 2].map((k) => (-f[k] + 0.45 * u[k] - 0.35 * r[k]) / 1.152));
    gl.uniform3fv(at.rubber, theme.rubber);
    gl.uniform3fv(at.line, theme.line);
    gl.uniform2f(at.limits, q.low, q.high);
    gl.uniform1i(at.logarithmic, q.log ? 1 : 0);
    gl.uniform1i(at.picking, picking ? 1 : 0);
    [[0, this.field], [1, this.tables[q.colours]]].forEach(([unit, texture]) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    });
    gl.uniform1i(at.cells, 0); gl.uniform1i(at.colours, 1);
    gl.bindVertexArray(this.sole);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
    if (picking) return;
    gl.bindVertexArray(this.grid);
    gl.drawArrays(gl.LINES, 0, this.lineCount);
    gl.uniform3fv(at.line, theme.arrow);
    gl.bindVertexArray(this.pointer);
    gl.drawArrays(gl.TRIANGLES, 0, this.arrowCount);
  }

  // The cell under a point of the canvas (CSS pixels), or -1.
  cellAt(x, y, view, theme) {
    const gl = this.gl, w = this.canvas.width, h = this.canvas.height, scale = w / this.canvas.clientWidth;
    if (!this.target) {
      this.target = gl.createFramebuffer();
      this.shades = gl.createRenderbuffer(); this.depths = gl.createRenderbuffer();
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target);
    for (const [buffer, format, slot] of [[this.shades, gl.RGBA8, gl.COLOR_ATTACHMENT0], [this.depths, gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, w, h);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, slot, gl.RENDERBUFFER, buffer);
    }
    this.draw(view, theme, true);
    const seen = new Uint8Array(4);
    gl.readPixels(Math.round(x * scale), h - 1 - Math.round(y * scale), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, seen);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return seen[3] ? seen[0] + (seen[1] << 8) + (seen[2] << 16) - 1 : -1;
  }

  // Where a point of space (m) is on the canvas, in CSS pixels, as last drawn.
  placeOf(point) {
    const m = this.matrix, p = [...point, 1];
    const clip = [0, 1, 3].map((row) => p.reduce((sum, v, k) => sum + m[k * 4 + row] * v, 0));
    return [(clip[0] / clip[2] + 1) / 2 * this.canvas.clientWidth, (1 - clip[1] / clip[2]) / 2 * this.canvas.clientHeight];
  }

  placeOfCell(cell, view) {
    const { ny, x0, y0, spacing: d, plane } = this.pane;
    const height = (view.load && this.pane.pressed) || this.pane.height;
    const x = x0 + Math.floor(cell / ny) * d, y = y0 + (cell % ny) * d, base = plane[0] + plane[1] * x + plane[2] * y;
    return this.placeOf([x, y, base + view.stretch * (height[cell] - base)]);
  }
}
