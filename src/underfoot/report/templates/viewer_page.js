// Controls: quantity, view, height, time, theme; mouse, touch and keyboard; values of a point.

async function startViewer(root) {
  const scene = JSON.parse(root.querySelector("script[type='application/json']").textContent);
  const find = (name) => root.querySelector(`[data-part="${name}"]`);
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const colours = Object.fromEntries(Object.entries(scene.colours).map(([k, v]) => [k, bytes(v)]));
  for (const pane of scene.panes) {
    const count = pane.nx * pane.ny;
    pane.height = await unpack(pane.height, count);
    pane.land = await unpack(pane.land, count);
    pane.ready = {};
    for (const [name, stored] of Object.entries(pane.fields)) pane.ready[name] = await unpack(stored, count);
  }
  const stages = [...root.querySelectorAll(".stage")];
  const drawings = stages.map((stage, k) => new Drawing(stage.querySelector("canvas"), scene.panes[k], colours));
  const state = { quantity: scene.quantities[0], frame: -1, cell: -1, pane: 0 };
  const view = { opening: 0.5, stretch: 1 };
  const views = { below: [0, 0], oblique: [-0.5, 0.75], side: [-Math.PI / 2, 1.45] };
  let waiting = false;

  // Corners of the box about all soles and their grids, in m.
  function corners() {
    const found = [];
    scene.panes.forEach((p, k) => {
      const q = p.plane, ends = [p.y0 - 0.003, p.y0 + p.ny * p.spacing + 0.003], top = drawings[k].top;
      for (const x of [p.x0 - 0.003, drawings[k].far]) for (const y of ends) for (const z of [0, top]) {
        found.push([x, y, q[0] + q[1] * x + q[2] * y + z]);
      }
    });
    return found;
  }

  // Where to stand so that everything just fits, seen from a side.
  function fit(turn, tilt) {
    const points = corners(), { canvas } = drawings[0], lens = Math.tan(view.opening / 2) * 0.96;
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
    if (waiting) return;
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
        put(stages[k].querySelector(".toe"), drawing.placeOf(drawing.arrow));
      });
    });
  }

  // The picked place in another pane, by its coordinates.
  function cellIn(k) {
    const from = scene.panes[state.pane], to = scene.panes[k];
    if (k === state.pane) return state.cell;
    const x = from.x0 + Math.floor(state.cell / from.ny) * from.spacing, y = from.y0 + (state.cell % from.ny) * from.spacing;
    const i = Math.round((x - to.x0) / to.spacing), j = Math.round((y - to.y0) / to.spacing);
    return i >= 0 && j >= 0 && i < to.nx && j < to.ny ? i * to.ny + j : -1;
  }

  async function choose(quantity) {
    state.quantity = quantity;
    for (const drawing of drawings) {
      const past = drawing.pane.histories[quantity.name], frame = past && state.frame >= 0 ? past.frames[Math.min(state.frame, past.frames.length - 1)] : null;
      const values = frame ? await unpack(frame, drawing.pane.nx * drawing.pane.ny) : drawing.pane.ready[quantity.name];
      if (state.quantity !== quantity) return;
      drawing.show(values, quantity);
    }
    legend(quantity);
    timeline(quantity);
    tell();
    redraw();
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
    const none = scene.panes.some((pane) => pane.ready[q.name].some((v, k) => Number.isNaN(v) && !Number.isNaN(pane.height[k])));
    const unit = q.unit ? ` ${q.unit}` : "";
    find("bar-note").textContent = [none ? "Plain rubber: none." : "", q.cut ? `A few cells are above the scale, up to ${shortNumber(q.peak)}${unit}.` : ""].join(" ").trim();
    drawings.forEach((d) => d.canvas.setAttribute("aria-label", `Sole of ${d.pane.name} from below, coloured by ${q.title}. Arrow keys turn it, Enter shows the values at its centre.`));
  }

  function timeline(q) {
    const past = scene.panes[0].histories[q.name], row = find("time-row"), slider = find("time");
    row.hidden = !past;
    if (!past) return;
    slider.max = past.frames.length - 1;
    const at = state.frame < 0 ? past.frames.length - 1 : Math.min(state.frame, past.frames.length - 1);
    slider.value = at;
    find("time-value").textContent = `${shortNumber(past.time[at] * 1e3)} ms`;
  }

  function tell() {
    const box = find("values");
    if (state.cell < 0) { box.hidden = true; return; }
    box.hidden = false;
    const pane = scene.panes[state.pane], { ny, spacing, x0, y0 } = pane;
    const x = (x0 + Math.floor(state.cell / ny) * spacing) * 1e3, y = (y0 + (state.cell % ny) * spacing) * 1e3;
    const row = (tag, cells) => {
      const made = document.createElement("tr");
      cells.forEach((text, k) => {
        const cell = document.createElement(k ? tag : "th");
        if (!k) cell.scope = "row";
        cell.textContent = text; made.append(cell);
      });
      return made;
    };
    const rows = scene.panes.length > 1 ? [row("th", ["", ...scene.panes.map((_, k) => "ABCDEFGH"[k])])] : [];
    for (const q of scene.quantities) {
      rows.push(row("td", [q.title, ...drawings.map((drawing, k) => {
        const cell = cellIn(k), values = q === state.quantity ? drawing.values : drawing.pane.ready[q.name];
        const v = cell < 0 || Number.isNaN(drawing.pane.height[cell]) ? null : values[cell];
        return v === null ? "no sole" : Number.isNaN(v) ? "none" : `${shortNumber(v)} ${q.unit}`.trim();
      })]));
    }
    find("values-place").textContent = `At x ${x.toFixed(1)} mm, y ${y.toFixed(1)} mm`;
    find("values-table").replaceChildren(...rows);
  }

  function pick(k, x, y) {
    const cell = drawings[k].cellAt(x, y, view, theme());
    state.pane = k; state.cell = cell;
    tell(); redraw();
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
    let moved = 0;
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      pointers.set(e.pointerId, [e.clientX, e.clientY]);
      if (pointers.size === 1) moved = 0;
    });
    canvas.addEventListener("pointermove", (e) => {
      const before = pointers.get(e.pointerId);
      if (!before) return;
      const dx = e.clientX - before[0], dy = e.clientY - before[1];
      moved += Math.abs(dx) + Math.abs(dy);
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
      if (!pointers.delete(e.pointerId) || e.type === "pointercancel" || moved > 5) return;
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
      else if (e.key === "Escape") { state.cell = -1; tell(); redraw(); }
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
  // a canvas of WebGL prints empty: it is drawn once more and copied at once
  const snapshot = (drawing) => { drawing.draw(view, theme()); return drawing.canvas.toDataURL("image/png"); };
  find("save").addEventListener("click", () => drawings.forEach((drawing) => {
    const link = document.createElement("a");
    link.href = snapshot(drawing); link.download = `${drawing.pane.name}, ${state.quantity.title}.png`; link.click();
  }));
  addEventListener("beforeprint", () => stages.forEach((stage, k) => { stage.querySelector("img.print").src = snapshot(drawings[k]); }));
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
}

for (const root of document.querySelectorAll(".viewer")) {
  startViewer(root).catch((problem) => {
    const note = root.querySelector('[data-part="loading"]');
    note.textContent = `The 3-D picture can't be shown here (${problem.message}). The maps of the page show the same fields.`;
    note.hidden = false;
    root.querySelector(".body").hidden = true;
    root.dataset.ready = "no";
  });
}
