// Controls: quantity, view, height, time, theme; mouse, touch and keyboard; values of a point.

const LETTERS = "ABCDEFGHIJKL";

function inMillimetres([x, y]) { return { x: (x * 1e3).toFixed(1), y: (y * 1e3).toFixed(1) }; }

// Turn the stored arrays of a pane into numbers.
async function unpackPane(pane) {
  const count = pane.nx * pane.ny;
  pane.height = await unpack(pane.height, count);
  pane.land = await unpack(pane.land, count);
  if (pane.pressed) pane.pressed = await unpack(pane.pressed, count);
  pane.surface = await unpackSurface(pane.surface);
  pane.ready = {};
  for (const [name, stored] of Object.entries(pane.fields)) pane.ready[name] = await unpack(stored, count);
}

async function startViewer(root) {
  const scene = JSON.parse(root.querySelector("script[type='application/json']").textContent);
  const find = (name) => root.querySelector(`[data-part="${name}"]`);
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const colours = Object.fromEntries(Object.entries(scene.colours).map(([k, v]) => [k, bytes(v)]));
  await Promise.all(scene.panes.map(unpackPane));
  const stages = [...root.querySelectorAll(".stage")];
  const drawings = stages.map((stage, k) => new Drawing(stage.querySelector("canvas"), scene.panes[k], colours));
  const state = { quantity: scene.quantities[0], frame: scene.steps ? 0 : -1, cell: -1, pane: 0, difference: false, lug: null, probes: [], cut: [], cutting: false };
  const view = { opening: 0.5, stretch: 1, load: 0 };
  const views = { below: [0, 0], oblique: [-0.5, 0.75], part: [-0.5, 0.75, true], side: [-Math.PI / 2, 1.45] };
  let waiting = false, printing = 0;

  // Corners of the box about all soles and their grids, in m, or about what was computed of them.
  function corners(part) {
    const found = [];
    scene.panes.forEach((p, k) => {
      const q = p.plane, ends = [p.y0 - 0.003, p.y0 + p.ny * p.spacing + 0.003], top = drawings[k].top;
      const along = part && p.computed ? p.computed.slice(0, 2).map((i) => p.x0 + i * p.spacing) : [p.x0 - 0.003, drawings[k].far];
      for (const x of along) for (const y of ends) for (const z of [0, top]) {
        found.push([x, y, q[0] + q[1] * x + q[2] * y + z]);
      }
    });
    return found;
  }

  // Where to stand so that everything just fits, seen from a side.
  function fit(turn, tilt, part) {
    const points = corners(part), { canvas } = drawings[0], lens = Math.tan(view.opening / 2) * 0.96;
    const { right, up, forward } = axes({ turn, tilt }), dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const wide = lens * canvas.clientWidth / Math.max(canvas.clientHeight, 1);
    let target = [0, 1, 2].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length), distance = 0;
    for (let round = 0; round < 4; round++) {
      const seen = points.map((p) => p.map((v, k) => v - target[k])).map((p) => [dot(right, p), dot(up, p), dot(forward, p)]);
      distance = Math.max(...seen.map(([r, u, f]) => Math.max(Math.abs(r) / wide, Math.abs(u) / lens) - f));
      const middle = [0, 1].map((c) => {
        const shares = seen.map((p) => p[c] / (p[2] + distance));
        return (Math.max(...shares) + Math.min(...shares)) / 2 * distance;
      });
      target = target.map((v, k) => v + middle[0] * right[k] + middle[1] * up[k]);
    }
    return { turn, tilt, target, distance, home: distance };
  }

  function look(name) {
    let found = fit(...views[name]);
    if (name === "oblique") { // a long sole in a wide window lies better across it
      const across = fit(-1.15, views.oblique[1]);
      if (across.distance < 0.85 * found.distance) found = across;
    }
    Object.assign(view, found);
    redraw();
  }

  function theme() {
    const style = getComputedStyle(root);
    const colour = (name) => style.getPropertyValue(name).trim().split(",").map((v) => Number(v) / 255);
    return { rubber: colour("--rubber"), line: colour("--grid-line"), arrow: colour("--arrow") };
  }

  function redraw() {
    if (waiting || !drawings.every((drawing) => drawing.quantity)) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      const shades = theme();
      drawings.forEach((drawing, k) => {
        drawing.draw(view, shades);
        const mark = stages[k].querySelector(".mark"), there = state.cell >= 0 && !Number.isNaN(drawing.pane.height[cellIn(k)]);
        mark.hidden = !there;
        const put = (element, [x, y]) => { element.style.transform = `translate(${x}px, ${y}px)`; };
        if (there) put(mark, drawing.placeOfCell(cellIn(k), view));
        const toe = stages[k].querySelector(".toe");
        drawing.placeOf(drawing.arrow).forEach((v, n) => toe.style.setProperty(["--x", "--y"][n], `${v}px`));
        overlay(k);
      });
      // a canvas of WebGL prints empty: pictures of what is seen lie ready for the printer
      clearTimeout(printing);
      printing = setTimeout(keepForPrint, 1500);
    });
  }

  // The picked place in another pane, by its coordinates.
  function cellIn(k) {
    return k === state.pane ? state.cell : sameCell(scene.panes[state.pane], state.cell, scene.panes[k]);
  }
  function sameCell(from, cell, to) {
    const x = from.x0 + Math.floor(cell / from.ny) * from.spacing, y = from.y0 + (cell % from.ny) * from.spacing;
    const i = Math.round((x - to.x0) / to.spacing), j = Math.round((y - to.y0) / to.spacing);
    return i >= 0 && j >= 0 && i < to.nx && j < to.ny ? i * to.ny + j : -1;
  }

  // The values of a pane at the instant shown; its shape follows where it wears.
  async function valuesNow(drawing, q) {
    const { pane } = drawing, past = pane.histories[q.name], count = pane.nx * pane.ny;
    if (!past || state.frame < 0) return pane.ready[q.name];
    const frame = Math.min(state.frame, past.frames.length - 1);
    if (pane.states.length && pane.frame !== frame) {
      const then = pane.states[frame];
      pane.frame = frame;
      pane.height = await unpack(then.height, count);
      pane.land = await unpack(then.land, count);
      pane.surface = await unpackSurface(then.surface);
      drawing.shape();
    }
    return unpack(past.frames[frame], count);
  }

  // What each sole has more than the first (or, on a logarithmic scale, how many times as much).
  function differences(fields, q) {
    const first = scene.panes[0], part = (v, there) => (Number.isNaN(v) && q.stress && there ? 0 : v);
    const made = fields.map((values, k) => values.map((value, cell) => {
      const pane = scene.panes[k], at = k ? sameCell(pane, cell, first) : -1;
      if (at < 0) return NaN;
      const a = part(fields[0][at], !Number.isNaN(first.height[at])), b = part(value, !Number.isNaN(pane.height[cell]));
      return q.log ? (a > 0 && b > 0 ? b / a : NaN) : a === 0 && b === 0 ? NaN : b - a;
    }));
    const sizes = made.flatMap((values) => [...values].filter((v) => v === v).map((v) => Math.abs(q.log ? Math.log(v) : v))).sort((a, b) => a - b);
    const most = sizes[sizes.length - 1] || 0, usual = sizes[Math.floor(0.995 * (sizes.length - 1))] || 0;
    const reach = Math.max(usual || most, q.log ? 0.05 : 1e-12 * q.high), end = q.log ? Math.exp(reach) : reach;
    const of = { quantity: q.title };
    const title = q.log ? sentenceOf("{quantity}: times that of A", of) : sentenceOf("{quantity}: more than A (red) or less (blue)", of);
    return [made, { ...q, title, unit: q.log ? "" : q.unit, colours: "RdBu_r", low: q.log ? 1 / end : -end, high: end,
      peak: q.log ? Math.exp(most) : most, cut: most > 1.001 * reach, loads: [], meaning: "" }];
  }

  async function choose(quantity) {
    state.quantity = quantity;
    const fields = await Promise.all(drawings.map((drawing) => valuesNow(drawing, quantity)));
    if (state.quantity !== quantity) return;
    drawings.forEach((drawing, k) => { drawing.own = fields[k]; });
    const [shown, scale] = state.difference ? differences(fields, quantity) : [fields, quantity];
    drawings.forEach((drawing, k) => drawing.show(shown[k], scale));
    legend(scale);
    timeline(quantity);
    tell();
    probes();
    profile();
    redraw();
  }

  // The instant that is shown, in words, where it is not the last one of a run.
  function early(q) {
    const past = scene.panes[0].histories[q.name];
    return !scene.steps && past && state.frame >= 0 && state.frame < past.frames.length - 1 ? past.labels[state.frame] : "";
  }

  function legend(q) {
    const table = colours[q.colours], stops = [];
    for (let k = 0; k <= 255; k += 15) stops.push(`rgb(${table[3 * k]},${table[3 * k + 1]},${table[3 * k + 2]})`);
    find("bar").style.background = `linear-gradient(to right, ${stops.join(",")})`;
    find("bar-title").textContent = q.title + (q.unit ? ` (${q.unit})` : "") + (q.log ? ", logarithmic" : "");
    find("bar-ticks").replaceChildren(...ticks(q).map(([at, text]) => {
      const tick = document.createElement("span");
      tick.style.left = `${100 * at}%`; tick.textContent = text;
      return tick;
    }));
    const none = drawings.some(({ values, pane }) => values.some((v, k) => Number.isNaN(v) && !Number.isNaN(pane.height[k])));
    const unit = q.unit ? ` ${q.unit}` : "", letter = (k) => (q.loads.length > 1 ? `${LETTERS[k]} ` : "");
    const told = (code, values) => say(document.createElement("span"), code, values);
    const loads = q.loads.map((load, k) => letter(k) + load).join(", ");
    const notes = [
      q.meaning && !early(q) && told("{meaning}, {loads} in all.", { meaning: q.meaning[0].toUpperCase() + q.meaning.slice(1), loads }),
      none && told(state.difference ? "Plain rubber: none in either." : "Plain rubber: none."),
      scene.panes.some((pane) => pane.computed) && told("Faint: outside the part that was computed."),
      q.cut && told("A few cells are above the scale, up to {peak}.", { peak: shortNumber(q.peak) + unit }),
    ].filter(Boolean);
    find("bar-note").replaceChildren(...notes.flatMap((note, k) => (k ? [" ", note] : [note])));
    drawings.forEach(({ canvas, pane }) => canvas.setAttribute("aria-label",
      sentenceOf("Sole of {sole} from below, coloured by {quantity}. Arrow keys turn it, Enter shows the values at its centre.", { sole: pane.name, quantity: q.title })));
  }

  function timeline(q) {
    const past = scene.panes[0].histories[q.name], row = find("time-row"), slider = find("time");
    row.hidden = !past;
    if (!past) return;
    slider.max = past.frames.length - 1;
    const at = state.frame < 0 ? past.frames.length - 1 : Math.min(state.frame, past.frames.length - 1);
    slider.value = at;
    find("time-value").textContent = past.labels[at];
  }

  function tell() {
    const box = find("values");
    if (state.cell < 0) { box.hidden = true; return; }
    box.hidden = false;
    const pane = scene.panes[state.pane], { ny, spacing, x0, y0 } = pane;
    const at = inMillimetres([x0 + Math.floor(state.cell / ny) * spacing, y0 + (state.cell % ny) * spacing]);
    const row = (tag, cells) => {
      const made = document.createElement("tr");
      cells.forEach((text, k) => {
        const cell = document.createElement(k ? tag : "th");
        if (!k) cell.scope = "row";
        cell.textContent = text; made.append(cell);
      });
      return made;
    };
    const rows = scene.panes.length > 1 ? [row("th", ["", ...scene.panes.map((_, k) => LETTERS[k])])] : [];
    for (const q of scene.quantities) {
      rows.push(row("td", [q.title, ...drawings.map((drawing, k) => {
        const cell = cellIn(k), values = q === state.quantity ? drawing.own : drawing.pane.ready[q.name];
        return valueText(drawing.pane, cell, values, q);
      })]));
    }
    const [rubber, fluid] = ["contact_pressure", "fluid_pressure"].map((name) => scene.quantities.find((q) => q.name === name));
    if (rubber && fluid) {
      rows.push(row("td", ["Share of the load on the fluid", ...scene.panes.map((pane, k) => {
        const [p, f] = [rubber, fluid].map((q) => (pane.ready[q.name][cellIn(k)] || 0) * q.factor);
        return p + f > 0 ? `${shortNumber(100 * f / (p + f))} %` : "no load";
      })]));
    }
    const time = early(state.quantity), place = find("values-place");
    if (time) say(place, "At x {x} mm, y {y} mm; {quantity} after {time}, the rest at the end", { ...at, quantity: state.quantity.title, time });
    else say(place, "At x {x} mm, y {y} mm", at);
    find("values-table").replaceChildren(...rows);
  }

  function valueText(pane, cell, values, q) {
    if (cell < 0 || Number.isNaN(pane.height[cell])) return "no sole";
    const [i, j] = [Math.floor(cell / pane.ny), cell % pane.ny], part = pane.computed;
    if (part && (i < part[0] || i >= part[1] || j < part[2] || j >= part[3])) return "not computed";
    return Number.isNaN(values[cell]) ? "none" : `${shortNumber(values[cell])} ${q.unit}`.trim();
  }

  function pick(k, x, y) {
    const cell = drawings[k].cellAt(x, y, view, theme());
    if (state.cutting) { if (cell >= 0) cutAt(placeOf(scene.panes[k], cell)); return; }
    state.pane = k; state.cell = cell; state.lug = lugAt(k, cell);
    tell(); point(k, x, y); chosenRow(true); redraw();
    if (state.lug) root.dispatchEvent(new CustomEvent("lug", { bubbles: true }));
  }

  const placeOf = (pane, cell) => [pane.x0 + Math.floor(cell / pane.ny) * pane.spacing, pane.y0 + (cell % pane.ny) * pane.spacing];
  const cellOf = (pane, [x, y]) => {
    const i = Math.round((x - pane.x0) / pane.spacing), j = Math.round((y - pane.y0) / pane.spacing);
    return i >= 0 && j >= 0 && i < pane.nx && j < pane.ny ? i * pane.ny + j : -1;
  };

  // The lug at a cell: its cells, and its number in the table of drainage or -1; null: no lug.
  function lugAt(k, cell) {
    const { land, nx, ny, height, lugs = [], surface } = scene.panes[k];
    if (cell < 0 || !land[cell] || surface.land.every((each) => each)) return null; // untreaded
    const cells = new Set([cell]), waiting = [cell];
    while (waiting.length) {
      const at = waiting.pop(), i = Math.floor(at / ny), j = at % ny;
      for (const [a, b] of [[i + 1, j], [i - 1, j], [i, j + 1], [i, j - 1]]) {
        const next = a * ny + b;
        if (a < 0 || b < 0 || a >= nx || b >= ny || cells.has(next) || !land[next] || Number.isNaN(height[next])) continue;
        cells.add(next); waiting.push(next);
      }
    }
    return { pane: k, place: placeOf(scene.panes[k], cell), cells, edges: [], number: lugs.findIndex((lug) => cells.has(cellOf(scene.panes[k], lug))) };
  }

  // The row of the lug that is chosen, in the table of drainage; and the lug of a row.
  function chosenRow(show) {
    for (const row of document.querySelectorAll("tr[data-lug]")) {
      const chosen = Boolean(state.lug) && Number(row.dataset.lug) === state.lug.number;
      row.classList.toggle("chosen", chosen);
      if (chosen && show && row.getBoundingClientRect().bottom > 0) row.scrollIntoView({ block: "nearest" });
    }
  }
  function chooseLug(number) {
    const pane = scene.panes[0], lug = (pane.lugs || [])[number];
    if (!lug) return;
    state.pane = 0; state.cell = cellOf(pane, lug);
    state.lug = lugAt(0, state.cell);
    tell(); chosenRow(false); redraw();
    stages[0].scrollIntoView({ block: "nearest" });
  }
  const rowOf = (e) => root.isConnected && e.target.closest?.("tr[data-lug]");
  document.addEventListener("click", (e) => { const row = rowOf(e); if (row) chooseLug(Number(row.dataset.lug)); });
  document.addEventListener("keydown", (e) => {
    const row = rowOf(e);
    if (row === e.target && (e.key === "Enter" || e.key === " ")) { e.preventDefault(); chooseLug(Number(row.dataset.lug)); }
  });

  // What is drawn over a sole: the lug that is chosen with its best groove, places kept, the section.
  const GROOVE = 0.002, SIDES = [[1, 0], [-1, 0], [0, 1], [0, -1]];
  function overlay(k) {
    const pane = scene.panes[k], drawing = drawings[k], parts = [];
    const seen = (x, y) => {
      const cell = cellOf(pane, [x, y]), heights = (view.load && pane.pressed) || pane.height;
      const base = pane.plane[0] + pane.plane[1] * x + pane.plane[2] * y, z = cell < 0 ? NaN : heights[cell];
      return drawing.placeOf([x, y, Number.isNaN(z) ? base : base + view.stretch * (z - base)]).map((v) => v.toFixed(1));
    };
    const path = (points, kind) => parts.push(`<path class="${kind}" d="M${points.map((p) => p.join(" ")).join("L")}"/>`);
    if (state.lug && state.lug.pane === k) {
      const { points, land, walls, sides } = pane.surface;
      state.lug.edges = [];
      const edge = (a, b) => {
        const ends = [a, b].map((n) => [points[3 * n], points[3 * n + 1]]), middle = [0, 1].map((c) => (ends[0][c] + ends[1][c]) / 2);
        if (!land[a] || ![...beside(pane, middle)].some((cell) => state.lug.cells.has(cell))) return;
        const onto = ([x, y], n) => {
          const z = points[3 * n + 2], base = pane.plane[0] + pane.plane[1] * x + pane.plane[2] * y;
          return drawing.placeOf([x, y, base + view.stretch * (z - base)]);
        };
        const drawn = [onto(ends[0], a), onto(ends[1], b)], along = [0, 1].map((c) => ends[1][c] - ends[0][c]);
        const size = Math.hypot(...along) || 1, out = [-along[1] / size, along[0] / size];
        const inside = state.lug.cells.has(cellOf(pane, middle.map((v, c) => v + out[c] * pane.spacing)));
        const normal = inside ? out.map((v) => -v) : out, moved = onto(ends[0].map((v, c) => v + 1e-3 * normal[c]), a);
        state.lug.edges.push({ drawn, normal, shift: [0, 1].map((c) => (moved[c] - drawn[0][c]) / 1e-3) });
        path(drawn.map((end) => end.map((v) => v.toFixed(1))), "lug");
      };
      for (let n = 0; n < walls.length; n += 4) { edge(walls[n], walls[n + 1]); edge(walls[n + 2], walls[n + 3]); }
      for (let n = 0; n < sides.length; n += 2) edge(sides[n], sides[n + 1]);
      const [x, y, length, side] = (pane.lugs || [])[state.lug.number] || [0, 0, 0, 0];
      if (length > 0) {
        const [u, v] = SIDES[side], half = GROOVE / 2;
        const corners = [[-half, -half], [length, -half], [length, half], [-half, half]];
        path([...corners, corners[0]].map(([a, b]) => seen(x + a * u + b * v, y + a * v + b * u)), "groove");
      }
    }
    if (state.cut.length) path(state.cut.map(([x, y]) => seen(x, y)), "cut");
    for (const [x, y] of state.cut) parts.push(dot(seen(x, y)));
    state.probes.forEach(([x, y], n) => {
      const [a, b] = seen(x, y);
      parts.push(dot([a, b]), `<text x="${a}" y="${b - 9}">${n + 1}</text>`);
    });
    stages[k].querySelector(".overlay").innerHTML = parts.join("");
  }
  const dot = ([x, y]) => `<circle cx="${x}" cy="${y}" r="4.5"/>`;
  function* beside(pane, [x, y]) {
    for (const a of [-0.6, 0, 0.6]) for (const b of [-0.6, 0, 0.6]) yield cellOf(pane, [x + a * pane.spacing, y + b * pane.spacing]);
  }

  // The edge of the chosen lug under a point of the canvas, where the page can move it.
  function edgeAt(k, x, y) {
    if (!root.dataset.editable || !state.lug || state.lug.pane !== k) return null;
    const away = ({ drawn: [[ax, ay], [bx, by]] }) => {
      const dx = bx - ax, dy = by - ay, share = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
      return Math.hypot(ax + share * dx - x, ay + share * dy - y);
    };
    const nearest = state.lug.edges.reduce((best, edge) => (!best || away(edge) < away(best) ? edge : best), null);
    return nearest && away(nearest) < 8 ? nearest : null;
  }

  // Places that are kept: their values of what is shown, at the instant shown.
  function probes() {
    const cell = (tag, text = "") => Object.assign(document.createElement(tag), { textContent: text });
    find("probes").hidden = !state.probes.length;
    find("probes-head").replaceChildren(...["", "Place", ...scene.panes.map((_, k) => (scene.panes.length > 1 ? `${LETTERS[k]}: ` : "") + state.quantity.title), ""].map((text) => cell("th", text)));
    find("probes-rows").replaceChildren(...state.probes.map((place, n) => {
      const row = document.createElement("tr"), away = cell("button", "Remove"), last = document.createElement("td");
      away.type = "button";
      away.addEventListener("click", () => { state.probes.splice(n, 1); probes(); redraw(); });
      last.append(away);
      row.append(cell("th", String(n + 1)), say(cell("td"), "At x {x} mm, y {y} mm", inMillimetres(place)),
        ...drawings.map((d) => cell("td", valueText(d.pane, cellOf(d.pane, place), d.own, state.quantity))), last);
      return row;
    }));
  }
  find("keep").addEventListener("click", () => {
    state.probes.push(placeOf(scene.panes[state.pane], state.cell));
    probes(); redraw();
  });

  // A section along a line: gap, film and pressures under it.
  function cutAt(place) {
    state.cut = state.cut.length === 1 ? [...state.cut, place] : [place];
    if (state.cut.length === 2) cutting(false);
    profile(); redraw();
  }
  function cutting(on) {
    state.cutting = on;
    find("section").setAttribute("aria-pressed", String(on));
    find("profile").hidden = !on && state.cut.length < 2;
    if (on) { say(find("profile-place"), "Click the two ends of the section on the sole."); find("profile-lines").replaceChildren(); }
  }
  find("section").addEventListener("click", () => {
    state.cut = []; state.cell = -1;
    cutting(!state.cutting); tell(); redraw();
  });

  const SECTIONED = ["fluid_pressure", "contact_pressure", "film_thickness"], INKS = ["#0b6fa4", "#d1495b", "#2e8b57", "#8a5fb4"];
  async function profile() {
    if (state.cut.length < 2) return;
    const [a, b] = state.cut, long = Math.hypot(b[0] - a[0], b[1] - a[1]) * 1e3, count = 240;
    const gap = { name: "gap", title: "Gap under load", unit: "mm", factor: 1e-3 };
    const rows = [gap, ...scene.quantities.filter((q) => SECTIONED.includes(q.name))];
    const fields = await Promise.all(rows.map((q) => Promise.all(drawings.map((d) => (q === gap ? (d.pane.pressed || d.pane.height).map((v) => v / gap.factor) : valuesNow(d, q))))));
    find("profile").hidden = false;
    const [from, to] = [a, b].map(inMillimetres), ends = { x_from: from.x, y_from: from.y, x_to: to.x, y_to: to.y };
    say(find("profile-place"), "Section from x {x_from} mm, y {y_from} mm to x {x_to} mm, y {y_to} mm: {length} mm", { ...ends, length: long.toFixed(1) });
    const highest = [];
    find("profile-lines").innerHTML = rows.map((q, n) => {
      const lines = drawings.map(({ pane }, k) => Array.from({ length: count + 1 }, (_, s) => {
        const [x, y] = [0, 1].map((c) => a[c] + (b[c] - a[c]) * s / count), cell = cellOf(pane, [x, y]);
        if (cell < 0 || Number.isNaN(pane.height[cell])) return NaN;
        const v = betweenCells(pane, x, y, pane.land[cell], (at) => fields[n][k][at]);
        return q.stress && Number.isNaN(v) ? 0 : v;
      }));
      const most = Math.max(...lines.flat().filter((v) => v === v), 1e-12);
      const drawn = lines.map((line, k) => line.reduce((made, v, s) => {
        if (v !== v) made.push([]); else made[made.length - 1].push(`${1000 * s / count},${(100 - 96 * v / most).toFixed(1)}`);
        return made;
      }, [[]]).filter((part) => part.length > 1).map((part) => `<polyline stroke="${INKS[k % 4]}" points="${part.join(" ")}"/>`).join("")).join("");
      highest.push(shortNumber(most));
      return `<h4></h4><svg data-section="${q.name}" viewBox="0 0 1000 100" preserveAspectRatio="none" role="img" aria-label="${q.title}"><line class="axis" x1="0" y1="100" x2="1000" y2="100"/>${drawn}</svg>`;
    }).join("");
    find("profile-lines").querySelectorAll("h4").forEach((head, n) => say(head, "{quantity} ({unit}), up to {most}", { quantity: rows[n].title, unit: rows[n].unit, most: highest[n] }));
  }

  // One sole after the other at one place, seen with one camera.
  const blink = find("blink");
  let blinking = 0;
  if (blink) blink.addEventListener("click", () => {
    const on = !blinking, rows = root.querySelector(".stages");
    blink.setAttribute("aria-pressed", String(on));
    rows.classList.toggle("blinking", on);
    clearInterval(blinking);
    let now = 0;
    const turn = () => stages.forEach((stage, k) => stage.classList.toggle("now", k === now % stages.length));
    blinking = on ? setInterval(() => { now += 1; turn(); }, 700) : 0;
    turn(); redraw();
  });

  // The value under the pointer, beside it.
  function point(k, x, y) {
    const tip = stages[k].querySelector(".tip"), { canvas, pane, values, quantity } = drawings[k];
    const cell = drawings[k].cellAt(x, y, view, theme());
    drawings[k].draw(view, theme());
    tip.hidden = cell < 0;
    if (cell < 0) return;
    tip.textContent = valueText(pane, cell, values, quantity);
    const left = x > canvas.clientWidth - 130;
    tip.style.transform = `translate(${x + (left ? -12 : 12)}px, ${Math.max(y - 32, 0)}px) translateX(${left ? "-100%" : "0"})`;
  }

  function orbit(dx, dy) {
    view.turn += dx; view.tilt = Math.min(Math.PI - 0.05, Math.max(0, view.tilt + dy));
    redraw();
  }
  function pan(dx, dy, canvas) {
    const scale = 2 * view.distance * Math.tan(view.opening / 2) / canvas.clientHeight, { right, up } = axes(view);
    view.target = view.target.map((t, k) => t - (dx * right[k] - dy * up[k]) * scale);
    redraw();
  }
  function zoom(factor) {
    view.distance = Math.min(view.home * 4, Math.max(view.home * 0.05, view.distance * factor));
    redraw();
  }

  stages.forEach((stage, k) => {
    const canvas = stage.querySelector("canvas"), pointers = new Map();
    let moved = 0, hovering = false, edge = null, began = [0, 0];
    // how far an edge is dragged outwards (m), told to the page
    const drag = (e, done) => {
      const by = [e.clientX - began[0], e.clientY - began[1]], { shift, normal } = edge;
      const out = (by[0] * shift[0] + by[1] * shift[1]) / (shift[0] ** 2 + shift[1] ** 2 || 1);
      root.dispatchEvent(new CustomEvent("edge", { bubbles: true, detail: { out, normal, done } }));
    };
    canvas.addEventListener("pointerleave", (e) => { if (e.pointerType === "mouse") stage.querySelector(".tip").hidden = true; });
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      pointers.set(e.pointerId, [e.clientX, e.clientY]);
      if (pointers.size === 1) moved = 0;
      const box = canvas.getBoundingClientRect();
      edge = pointers.size === 1 ? edgeAt(k, e.clientX - box.left, e.clientY - box.top) : null;
      began = [e.clientX, e.clientY];
    });
    canvas.addEventListener("pointermove", (e) => {
      const before = pointers.get(e.pointerId), box = canvas.getBoundingClientRect();
      if (!before) {
        canvas.style.cursor = edgeAt(k, e.clientX - box.left, e.clientY - box.top) ? "move" : "";
        if (e.pointerType === "mouse" && !hovering) {
          hovering = true;
          requestAnimationFrame(() => { hovering = false; point(k, e.clientX - box.left, e.clientY - box.top); });
        }
        return;
      }
      stage.querySelector(".tip").hidden = true;
      const dx = e.clientX - before[0], dy = e.clientY - before[1];
      moved += Math.abs(dx) + Math.abs(dy);
      if (edge) { pointers.set(e.pointerId, [e.clientX, e.clientY]); drag(e, false); return; }
      if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== e.pointerId)[1];
        const gap = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
        zoom(gap(before) / Math.max(gap([e.clientX, e.clientY]), 1));
        pan(dx / 2, dy / 2, canvas);
      } else if (e.shiftKey || e.buttons & 6) pan(dx, dy, canvas);
      else orbit(dx * 0.008, dy * 0.008);
      pointers.set(e.pointerId, [e.clientX, e.clientY]);
    });
    const release = (e) => {
      const held = edge && pointers.has(e.pointerId) && moved > 5;
      if (held) drag(e, true);
      edge = null;
      if (!pointers.delete(e.pointerId) || held || e.type === "pointercancel" || moved > 5) return;
      const box = canvas.getBoundingClientRect();
      pick(k, e.clientX - box.left, e.clientY - box.top);
    };
    canvas.addEventListener("pointerup", release);
    canvas.addEventListener("pointercancel", release);
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    // the wheel scrolls the page until the sole has been clicked
    canvas.addEventListener("wheel", (e) => {
      if (document.activeElement !== canvas && !e.ctrlKey) return;
      e.preventDefault();
      zoom(Math.exp(Math.max(-60, Math.min(60, e.deltaY)) * 0.003));
    }, { passive: false });
    canvas.addEventListener("dblclick", () => look("oblique"));
    canvas.addEventListener("keydown", (e) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
      if (step && e.altKey && state.cell >= 0) {
        const pane = scene.panes[state.pane], next = state.cell + step[0] - step[1] * pane.ny;
        if (!Number.isNaN(pane.height[next] ?? NaN)) { state.cell = next; tell(); redraw(); }
      } else if (step && e.shiftKey) pan(step[0] * 20, step[1] * 20, canvas);
      else if (step) orbit(step[0] * 0.09, step[1] * 0.09);
      else if (e.key === "+" || e.key === "=") zoom(0.87);
      else if (e.key === "-") zoom(1.15);
      else if (e.key === "0" || e.key === "Home") look("oblique");
      else if (e.key === "Enter" || e.key === " ") pick(k, canvas.clientWidth / 2, canvas.clientHeight / 2);
      else if (e.key === "Escape") { state.cell = -1; state.lug = null; state.cut = []; cutting(false); tell(); chosenRow(false); redraw(); }
      else return;
      e.preventDefault();
    });
  });

  for (const button of root.querySelectorAll("[data-view]")) button.addEventListener("click", () => look(button.dataset.view));
  for (const input of root.querySelectorAll("input[name='quantity']")) {
    input.addEventListener("change", () => choose(scene.quantities[Number(input.value)]));
  }
  find("stretch").addEventListener("input", (e) => {
    view.stretch = Number(e.target.value);
    find("stretch-value").textContent = `× ${e.target.value}`;
    redraw();
  });
  find("time").addEventListener("input", (e) => { state.frame = Number(e.target.value); choose(state.quantity); });
  const pressed = find("load"), difference = find("difference");
  pressed.hidden = !scene.panes.some((pane) => pane.pressed);
  pressed.addEventListener("click", () => {
    view.load = 1 - view.load;
    pressed.setAttribute("aria-pressed", String(view.load === 1));
    redraw();
  });
  if (difference) difference.addEventListener("click", () => {
    state.difference = !state.difference;
    difference.setAttribute("aria-pressed", String(state.difference));
    choose(state.quantity);
  });
  const snapshot = (drawing) => { drawing.draw(view, theme()); return drawing.canvas; };
  function keepForPrint() {
    stages.forEach((stage, k) => { stage.querySelector("img.print").src = snapshot(drawings[k]).toDataURL("image/png"); });
  }

  // What is seen with its title and colour bar, as one picture of the page's width.
  function picture() {
    const ratio = drawings[0].canvas.width / drawings[0].canvas.clientWidth, head = 76;
    const frame = root.querySelector(".stages").getBoundingClientRect();
    const made = document.createElement("canvas"), pen = made.getContext("2d"), style = getComputedStyle(root);
    made.width = frame.width * ratio; made.height = (frame.height + head) * ratio;
    pen.scale(ratio, ratio);
    pen.fillStyle = style.getPropertyValue("--paper") || "#fff"; pen.fillRect(0, 0, frame.width, frame.height + head);
    pen.fillStyle = style.color; pen.font = `600 15px ${style.fontFamily}`;
    pen.fillText(document.title, 12, 22);
    pen.font = `13px ${style.fontFamily}`;
    const q = drawings[0].quantity, table = colours[q.colours], wide = Math.min(420, frame.width - 24);
    pen.fillText(find("bar-title").textContent, 12, 40);
    for (let k = 0; k < wide; k++) {
      const c = 3 * Math.floor(255 * k / wide);
      pen.fillStyle = `rgb(${table[c]},${table[c + 1]},${table[c + 2]})`; pen.fillRect(12 + k, 46, 1.5, 10);
    }
    pen.fillStyle = style.color; pen.textAlign = "center";
    for (const [at, text] of ticks(q)) pen.fillText(text, 12 + at * wide, 71);
    pen.textAlign = "left";
    drawings.forEach((drawing, k) => {
      const box = stages[k].getBoundingClientRect(), x = box.left - frame.left, y = box.top - frame.top + head;
      pen.drawImage(snapshot(drawing), x, y, box.width, box.height);
      if (drawings.length > 1) pen.fillText(`${LETTERS[k]} ${drawing.pane.name}`, x + 10, y + 18);
    });
    return made;
  }
  find("save").addEventListener("click", () => {
    const link = document.createElement("a");
    link.href = picture().toDataURL("image/png");
    link.download = `${document.title}, ${drawings[0].quantity.title}.png`.replace(/[\\/:*?"<>|]/g, "");
    link.click();
  });
  addEventListener("beforeprint", keepForPrint);
  find("full").addEventListener("click", () => (document.fullscreenElement ? document.exitFullscreen() : root.requestFullscreen()));
  find("full").hidden = !document.fullscreenEnabled;
  new ResizeObserver(redraw).observe(root);
  new MutationObserver(redraw).observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);

  root.querySelector(".body").hidden = false;
  find("loading").hidden = true;
  look("oblique");
  await choose(state.quantity);
  root.dataset.ready = "yes";
  return {
    view,
    get quantity() { return state.quantity.name; },
    // Colour by a quantity, where there is one of this name.
    colour(name) {
      const at = scene.quantities.findIndex((q) => q.name === name);
      if (at > 0) { root.querySelectorAll("input[name=quantity]")[at].checked = true; choose(scene.quantities[at]); }
    },
    // Take other values and shapes on the same soles and quantities; false where they are not the same.
    async update(fresh) {
      const same = fresh.panes.length === scene.panes.length && fresh.quantities.length === scene.quantities.length
        && fresh.quantities.every((q, k) => q.name === scene.quantities[k].name);
      if (!same) return false;
      await Promise.all(fresh.panes.map(unpackPane));
      const chosen = scene.quantities.indexOf(state.quantity);
      const size = () => scene.panes.flatMap((p) => [p.x0, p.y0, p.x0 + p.nx * p.spacing, p.y0 + p.ny * p.spacing]), before = size();
      scene.panes.forEach((pane, k) => {
        Object.assign(pane, fresh.panes[k]);
        const name = stages[k].querySelector(".pane-name");
        if (name) name.lastChild.textContent = ` ${pane.name}`;
        drawings[k].shape();
      });
      scene.quantities = fresh.quantities;
      state.cell = -1;
      if (state.lug) state.lug = lugAt(state.lug.pane, cellOf(scene.panes[state.lug.pane], state.lug.place));
      await choose(scene.quantities[chosen]);
      if (size().some((end, k) => Math.abs(end - before[k]) > 0.01)) { // m; another sole: all of it
        Object.assign(view, fit(view.turn, view.tilt));
        redraw();
      }
      return true;
    },
  };
}

// Start a viewer, or say in words why there is none.
function openViewer(root) {
  return startViewer(root).catch((problem) => {
    const note = root.querySelector('[data-part="loading"]');
    say(note, "The 3-D picture can't be shown here ({problem}). The maps of the page show the same fields.", { problem: problem.message });
    note.hidden = false;
    root.querySelector(".body").hidden = true;
    root.dataset.ready = "no";
  });
}

for (const root of document.querySelectorAll(".viewer")) openViewer(root);
