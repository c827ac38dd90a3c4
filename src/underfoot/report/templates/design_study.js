// Designs of a study: a plot of two quantities, parallel coordinates, and the sole of a chosen one.

function startStudy(root) {
  const find = (name) => root.querySelector(`[data-part="${name}"]`);
  const { columns, designs } = JSON.parse(find("data").textContent);
  const element = (name, attributes, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  const short = (value) => (typeof value === "number" ? Number(value.toPrecision(3)).toString() : String(value ?? ""));
  // A scale of one column: names stand at even places.
  const scale = (column, low, high) => {
    const values = designs.map((d) => d.values[column]).filter((v) => v !== null);
    const names = !values.length || values.some((v) => typeof v === "string") ? [...new Set(values.map(String))] : null;
    const ends = names ? [0, Math.max(names.length - 1, 1)] : [Math.min(...values), Math.max(...values)];
    const span = ends[1] - ends[0] || 1;
    return { names, ends, place: (v) => (v === null ? null : low + (high - low) * ((names ? names.indexOf(String(v)) : v) - ends[0]) / span) };
  };
  const label = (column) => columns[column].name + (columns[column].unit ? ` (${columns[column].unit})` : "");
  const kind = (d) => (d.reason ? "lost" : d.front ? "front" : d.allowed ? "" : "not");
  let chosen = null;

  function mark() {
    for (const shape of root.querySelectorAll("[data-design]")) shape.classList.toggle("chosen", Number(shape.dataset.design) === chosen);
  }

  async function choose(number) {
    chosen = number;
    mark();
    const design = designs[number];
    find("chosen").hidden = false;
    root.dataset.chosen = design.number;
    say(find("title"), design.front ? "Design {number}, on the front" : "Design {number}", { number: String(design.number) });
    const row = (tag, texts) => {
      const made = document.createElement("tr");
      made.append(...texts.map((text) => { const cell = document.createElement(tag); cell.textContent = text; return cell; }));
      return made;
    };
    find("names").replaceChildren(row("th", columns.map((_, k) => label(k))));
    find("values").replaceChildren(row("td", design.values.map(short)));
    find("command").textContent = design.reason || "Its case file: underfoot study export. Check it in full: underfoot run on that file.";
    const place = find("sole"), stored = root.querySelector(`template[data-sole="${design.number}"]`);
    for (const canvas of place.querySelectorAll("canvas")) canvas.getContext("webgl2")?.getExtension("WEBGL_lose_context")?.loseContext();
    place.replaceChildren(...(stored ? [stored.content.cloneNode(true)] : []));
    root.dispatchEvent(new CustomEvent("chosen", { detail: design.number, bubbles: true }));
    const viewer = place.querySelector(".viewer");
    if (viewer) await startViewer(viewer).catch((problem) => { say(viewer.querySelector('[data-part="loading"]'), "No 3-D picture ({problem}).", { problem: problem.message }); });
  }

  function scatter() {
    const across = Number(find("across").value), up = Number(find("up").value), svg = find("scatter");
    const x = scale(across, 60, 500), y = scale(up, 310, 20), shapes = [];
    shapes.push(element("line", { x1: 60, x2: 500, y1: 310, y2: 310, class: "axis" }), element("line", { x1: 60, x2: 60, y1: 20, y2: 310, class: "axis" }));
    [[x, (p, t) => element("text", { x: p, y: 326, "text-anchor": "middle" }, t)], [y, (p, t) => element("text", { x: 55, y: p + 4, "text-anchor": "end" }, t)]].forEach(([s, make]) => {
      const ticks = s.names ?? [0, 0.25, 0.5, 0.75, 1].map((share) => s.ends[0] + share * (s.ends[1] - s.ends[0]));
      for (const tick of ticks) shapes.push(make(s.place(tick), short(tick)));
    });
    shapes.push(element("text", { x: 280, y: 348, "text-anchor": "middle" }, label(across)), element("text", { x: 60, y: 12 }, label(up)));
    designs.map((d, k) => [d, k]).sort((a, b) => a[0].front - b[0].front).forEach(([d, k]) => {
      const at = [x.place(d.values[across]), y.place(d.values[up])];
      if (at.includes(null)) return;
      const dot = element("circle", { cx: at[0], cy: at[1], r: d.front ? 6 : 4, class: kind(d), "data-design": k, "data-number": d.number, tabindex: 0, role: "button", "aria-label": `Design ${d.number}` });
      dot.append(say(element("title", {}), "Design {number}; {across} = {across_value}; {up} = {up_value}", { number: String(d.number),
        across: label(across), across_value: short(d.values[across]), up: label(up), up_value: short(d.values[up]) }));
      dot.addEventListener("click", () => choose(k));
      dot.addEventListener("keydown", (e) => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); choose(k); } });
      shapes.push(dot);
    });
    svg.replaceChildren(...shapes);
    mark();
  }

  function parallel() {
    const svg = find("parallel"), shapes = [], step = 540 / Math.max(columns.length - 1, 1);
    const scales = columns.map((_, k) => scale(k, 310, 50));
    designs.forEach((d, k) => {
      const known = d.values.findIndex((v) => v === null), values = known < 0 ? d.values : d.values.slice(0, known);
      if (values.length < 2 || (known >= 0 && !d.reason)) return;
      const points = values.map((v, c) => `${40 + c * step},${scales[c].place(v)}`).join(" ");
      shapes.push(element("polyline", { points, class: kind(d), "data-design": k }));
    });
    columns.forEach((column, c) => {
      const at = 40 + c * step, s = scales[c], texts = s.names ? [s.names[0], s.names.at(-1)] : s.ends.map(short);
      const ends = [{ x: 4, "text-anchor": "start" }, { x: 616, "text-anchor": "end" }]; // a name at the edge stays inside
      const name = c === 0 ? ends[0] : c === columns.length - 1 ? ends[1] : { x: at, "text-anchor": "middle" };
      shapes.push(element("line", { x1: at, x2: at, y1: 50, y2: 310, class: "axis" }));
      shapes.push(element("text", { ...name, y: c % 2 ? 14 : 28 }, column.name.length > 24 ? `${column.name.slice(0, 23)}…` : column.name));
      shapes.push(element("text", { x: at, y: 44, "text-anchor": "middle" }, texts[1]), element("text", { x: at, y: 324, "text-anchor": "middle" }, texts[0]));
      if (column.unit) shapes.push(element("text", { x: at, y: 338, "text-anchor": "middle" }, column.unit));
    });
    svg.replaceChildren(...shapes);
  }

  for (const name of ["across", "up"]) {
    columns.forEach((_, k) => find(name).append(new Option(label(k), k)));
    find(name).addEventListener("change", scatter);
  }
  const goals = columns.map((c, k) => (c.goal ? k : -1)).filter((k) => k >= 0);
  find("across").value = goals.length > 1 ? goals[1] : 0;
  find("up").value = goals[0] ?? columns.length - 1;
  scatter();
  parallel();
  const wanted = designs.findIndex((d) => String(d.number) === root.dataset.chosen);
  const first = wanted >= 0 ? wanted : designs.findIndex((d) => d.front);
  if (first >= 0) choose(first);
  root.dataset.ready = "yes";
}

for (const root of document.querySelectorAll(".study")) startStudy(root);
