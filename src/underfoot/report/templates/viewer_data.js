// Arrays from text, the mesh of a sole, colours, numbers.

async function unpack(stored, count) {
  const packed = Uint8Array.from(atob(stored.data), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const values = new Float32Array(count);
  for (let k = 0; k < count; k++) {
    values[k] = halfFloat(planes[k] | (planes[count + k] << 8)) * stored.scale;
  }
  return values;
}

function halfFloat(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return exponent ? sign * 2 ** (exponent - 15) * (1 + fraction / 1024) : sign * 2 ** -24 * fraction;
}

// Each cell is a quad of its own. Corners are shared in height with neighbours on the same level
// (both land or both channel, slope below 2); where they are not, an upright wall joins them. So
// lugs and channels keep their true, sharp shape. `kind`: 0 coloured cell, 1 wall, 2 side. A point
// is x, y, height, height under load, place among the cells (2), kind.
function soleMesh(pane) {
  const { nx, ny, spacing: d, height, land, x0, y0, plane } = pane, pressed = pane.pressed || height;
  const known = (i, j) => i >= 0 && j >= 0 && i < nx && j < ny && !Number.isNaN(height[i * ny + j]);
  const level = (i, j, k) => known(i, j) && land[i * ny + j] === land[k]
    && Math.abs(height[i * ny + j] - height[k]) < 2 * d;
  const corner = (i, j, ci, cj) => {
    const own = i * ny + j;
    let sum = 0, low = 0, count = 0;
    for (let a = i + ci - 1; a <= i + ci; a++) for (let b = j + cj - 1; b <= j + cj; b++) {
      if (level(a, b, own)) { sum += height[a * ny + b]; low += pressed[a * ny + b]; count++; }
    }
    return [sum / count, low / count];
  };
  const flat = (x, y) => plane[0] + plane[1] * x + plane[2] * y;
  let top = 0;
  for (let k = 0; k < nx * ny; k++) if (!Number.isNaN(height[k])) {
    top = Math.max(top, height[k] - flat(x0 + Math.floor(k / ny) * d, y0 + (k % ny) * d));
  }
  top += 0.004;
  const corners = new Float32Array(nx * ny * 8).fill(NaN); // of each cell: 4 corners, 2 heights
  for (let i = 0; i < nx; i++) for (let j = 0; j < ny; j++) if (known(i, j)) {
    for (let c = 0; c < 4; c++) corners.set(corner(i, j, c >> 1, c & 1), (i * ny + j) * 8 + c * 2);
  }
  const both = (i, j, c) => corners.subarray((i * ny + j) * 8 + c * 2, (i * ny + j) * 8 + c * 2 + 2);
  const points = [], faces = [], rim = onRim(pane, known);
  const point = (i, j, ci, cj, z, kind) => {
    const inset = kind ? 0.5 : 0.002;
    points.push(...rim(i + ci, j + cj), z[0], z[1],
      i + (kind ? 0.5 : ci ? 1 - inset : inset), j + (kind ? 0.5 : cj ? 1 - inset : inset), kind);
    return points.length / 7 - 1;
  };
  const quad = (a, b, c, e) => faces.push(a, b, c, b, e, c);
  for (let i = 0; i < nx; i++) for (let j = 0; j < ny; j++) if (known(i, j)) {
    const z = [0, 1, 2, 3].map((c) => both(i, j, c));
    quad(point(i, j, 0, 0, z[0], 0), point(i, j, 0, 1, z[1], 0),
      point(i, j, 1, 0, z[2], 0), point(i, j, 1, 1, z[3], 0));
    for (const [di, dj, p, q] of [[1, 0, [1, 0], [1, 1]], [0, 1, [0, 1], [1, 1]],
      [-1, 0, [0, 0], [0, 1]], [0, -1, [0, 0], [1, 0]]]) {
      const a = i + di, b = j + dj, zp = z[p[0] * 2 + p[1]], zq = z[q[0] * 2 + q[1]];
      let other, kind = 1;
      if (known(a, b)) {
        if (di < 0 || dj < 0) continue; // the neighbour has drawn it
        other = [p, q].map((c) => both(a, b, (c[0] - di) * 2 + c[1] - dj));
        if (Math.abs(other[0][0] - zp[0]) + Math.abs(other[1][0] - zq[0]) < 1e-7) continue;
      } else {
        kind = 2;
        const up = (c) => flat(x0 + (i + c[0] - 0.5) * d, y0 + (j + c[1] - 0.5) * d) + top;
        other = [p, q].map((c) => [up(c), up(c)]);
      }
      quad(point(i, j, ...p, zp, kind), point(i, j, ...q, zq, kind),
        point(i, j, ...p, other[0], kind), point(i, j, ...q, other[1], kind));
    }
  }
  return { points: new Float32Array(points), faces: new Uint32Array(faces), top };
}

// Where the corner (i, j) of cells is drawn: on the rim of the sole if it is at its edge and the rim
// is near, so that a round heel is not a staircase.
function onRim(pane, known) {
  const { spacing: d, x0, y0, outline: rim } = pane, seen = new Map();
  const nearest = (x, y) => {
    let best = [x, y], least = 0.9 * d;
    for (let k = 0; k < rim.length; k++) {
      const [ax, ay] = rim[k], [bx, by] = rim[(k + 1) % rim.length], dx = bx - ax, dy = by - ay;
      const share = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
      const px = ax + share * dx, py = ay + share * dy, away = Math.hypot(px - x, py - y);
      if (away < least) { least = away; best = [px, py]; }
    }
    return best;
  };
  return (i, j) => {
    const x = x0 + (i - 0.5) * d, y = y0 + (j - 0.5) * d;
    if (known(i - 1, j - 1) && known(i - 1, j) && known(i, j - 1) && known(i, j)) return [x, y];
    const key = i * (pane.ny + 1) + j;
    if (!seen.has(key)) seen.set(key, nearest(x, y));
    return seen.get(key);
  };
}

// A 10 mm grid behind the sole, in its upper plane, and an arrow along the walking direction.
function gridLines(pane, top) {
  const { nx, ny, spacing: d, x0, y0, plane } = pane, step = 0.01, lines = [], arrow = [];
  const low = (v) => Math.floor(v / step) * step, high = (v) => Math.ceil(v / step) * step;
  const xs = [low(x0), high(x0 + (nx - 1) * d)], ys = [low(y0), high(y0 + (ny - 1) * d)];
  const lift = (x, y, up) => [x, y, plane[0] + plane[1] * x + plane[2] * y + up];
  const add = (to, x, y, up = top) => { const at = lift(x, y, up); to.push(...at, at[2], 0, 0, 3); };
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
