// Arrays from text, the surface of a sole, colours, numbers.

async function inflated(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function unpack(stored, count) {
  const planes = await inflated(stored.data), values = new Float32Array(count);
  for (let k = 0; k < count; k++) {
    values[k] = halfFloat(planes[k] | (planes[count + k] << 8)) * stored.scale;
  }
  return values;
}

// Whole numbers (n, k) that are stored column by column, row by row.
async function unpackIntegers({ data, size: [count, width] }) {
  const planes = await inflated(data), all = count * width, values = new Uint32Array(all);
  for (let n = 0; n < count; n++) for (let k = 0; k < width; k++) {
    const at = k * count + n;
    values[n * width + k] = planes[at] | (planes[all + at] << 8) | (planes[2 * all + at] << 16);
  }
  return values;
}

async function unpackSurface({ low, steps, ...arrays }) {
  const made = {};
  for (const [name, stored] of Object.entries(arrays)) made[name] = await unpackIntegers(stored);
  made.points = Float32Array.from(made.points, (v, k) => low[k % 3] + steps[k % 3] * v);
  return made;
}

function halfFloat(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024) : sign * 2 ** -24 * fraction;
}

// The designed surface with its walls and sides. `kind`: 0 channel, 1 lug, 2 wall, 3 side. A vertex
// is x, y, height, height under load, place among the cells (2), kind.
function soleMesh(pane) {
  const { spacing: d, x0, y0, plane, nx, ny, surface } = pane, { points, land, triangles, walls, sides } = surface;
  const count = land.length, flat = (x, y) => plane[0] + plane[1] * x + plane[2] * y;
  const made = [], faces = Array.from(triangles);
  let top = 0;
  const within = (v, n) => Math.min(Math.max(v, 0.002), n - 0.002);
  const vertex = (x, y, z, low, kind) => {
    made.push(x, y, z, low, within((x - x0) / d + 0.5, nx), within((y - y0) / d + 0.5, ny), kind);
    return made.length / 7 - 1;
  };
  for (let k = 0; k < count; k++) {
    const [x, y, z] = points.subarray(3 * k, 3 * k + 3);
    top = Math.max(top, z - flat(x, y));
    vertex(x, y, z, Math.max(0, z + lowering(pane, x, y, land[k])), land[k]);
  }
  top += 0.004;
  const copy = (k, kind) => vertex(...made.slice(7 * k, 7 * k + 4), kind);
  const quad = (a, b, c, e) => faces.push(a, b, c, b, e, c);
  for (let k = 0; k < walls.length; k += 4) quad(...[0, 1, 2, 3].map((n) => copy(walls[k + n], 2)));
  for (let k = 0; k < sides.length; k += 2) {
    const ends = [sides[k], sides[k + 1]], upper = ends.map((n) => {
      const [x, y] = made.slice(7 * n, 7 * n + 2), up = flat(x, y) + top;
      return vertex(x, y, up, up, 3);
    });
    quad(...ends.map((n) => copy(n, 3)), ...upper);
  }
  return { points: new Float32Array(made), faces: new Uint32Array(faces), top };
}

// How far the load moves a place up (m): between the cells of its kind around it.
function lowering(pane, x, y, land) {
  if (!pane.pressed) return 0;
  return betweenCells(pane, x, y, land, (cell) => pane.pressed[cell] - pane.height[cell]) || 0;
}

// A value at a place, linear between the cells of its kind (lug or channel) around it; of the
// nearest one where all four are of the other kind. NaN: none within two cells.
function betweenCells(pane, x, y, land, value) {
  const i = (x - pane.x0) / pane.spacing, j = (y - pane.y0) / pane.spacing, i0 = Math.floor(i), j0 = Math.floor(j);
  let sum = 0, weight = 0, nearest = 2.3, nearby = NaN;
  for (let a = i0 - 1; a <= i0 + 2; a++) for (let b = j0 - 1; b <= j0 + 2; b++) {
    if (a < 0 || b < 0 || a >= pane.nx || b >= pane.ny) continue;
    const cell = a * pane.ny + b, w = Math.max(0, 1 - Math.abs(a - i)) * Math.max(0, 1 - Math.abs(b - j));
    if (pane.land[cell] !== land || Number.isNaN(pane.height[cell])) continue;
    const v = value(cell), away = Math.hypot(a - i, b - j);
    if (w > 0 && !Number.isNaN(v)) { sum += w * v; weight += w; }
    if (away < nearest) { nearest = away; nearby = v; }
  }
  return weight > 1e-4 ? sum / weight : nearby;
}

// A 10 mm grid behind the sole, in its upper plane, and an arrow along the walking direction.
function gridLines(pane, top) {
  const { nx, ny, spacing: d, x0, y0, plane } = pane, step = 0.01, lines = [], arrow = [];
  const low = (v) => Math.floor(v / step) * step, high = (v) => Math.ceil(v / step) * step;
  const xs = [low(x0), high(x0 + (nx - 1) * d)], ys = [low(y0), high(y0 + (ny - 1) * d)];
  const lift = (x, y, up) => [x, y, plane[0] + plane[1] * x + plane[2] * y + up];
  const add = (to, x, y, up = top) => { const at = lift(x, y, up); to.push(...at, at[2], 0, 0, 4); };
  for (let x = xs[0]; x < xs[1] + 1e-9; x += step) { add(lines, x, ys[0]); add(lines, x, ys[1]); }
  for (let y = ys[0]; y < ys[1] + 1e-9; y += step) { add(lines, xs[0], y); add(lines, xs[1], y); }
  const size = 0.04 * (xs[1] - xs[0]) + 0.002, from = xs[1] + 0.3 * size, tip = from + 2.4 * size, mid = (ys[0] + ys[1]) / 2;
  const shape = [[from, -0.2], [from, 0.2], [tip - size, 0.2], [from, -0.2], [tip - size, 0.2], [tip - size, -0.2],
    [tip - size, -0.6], [tip - size, 0.6], [tip, 0]];
  for (const [x, side] of shape) add(arrow, x, mid + side * size, 0);
  return { lines: new Float32Array(lines), arrow: new Float32Array(arrow), tip: lift(tip + 0.8 * size, mid, 0), far: tip + 1.5 * size };
}

function shortNumber(value) {
  if (Number.isNaN(value)) return "none";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(1);
  return String(Number(value.toPrecision(3)));
}

// Ticks at 1, 2 or 5 times a power of ten, as [share of the scale, text].
function ticks(q) {
  const made = [];
  if (q.log) {
    const decades = Math.log10(q.high / q.low), steps = decades > 3.2 ? [1] : decades > 1.6 ? [1, 3] : [1, 2, 5];
    for (let e = Math.floor(Math.log10(q.low)); e <= Math.log10(q.high); e++) for (const s of steps) {
      const v = s * 10 ** e;
      if (v >= q.low * 0.999 && v <= q.high * 1.001) {
        made.push([Math.log(v / q.low) / Math.log(q.high / q.low), shortNumber(v)]);
      }
    }
    return made;
  }
  const rough = (q.high - q.low) / 5, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((s) => s * power).find((s) => s >= rough * 0.999);
  for (let k = Math.ceil(q.low / step - 1e-6); k * step <= q.high * 1.0001; k++) {
    made.push([(k * step - q.low) / (q.high - q.low), shortNumber(k * step)]);
  }
  return made;
}
