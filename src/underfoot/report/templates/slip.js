"use strict";
(() => {
  const d = JSON.parse(document.getElementById("slip-data").textContent);
  const canvas = document.getElementById("slip-stage"), slider = document.getElementById("slip-time");
  const button = document.getElementById("slip-play"), now = document.getElementById("slip-now");
  const n = d.time.length, W = 960, H = canvas.height, scale = Math.min(window.devicePixelRatio || 1, 2);
  canvas.width = W * scale; canvas.height = H * scale;
  const c = canvas.getContext("2d");
  slider.max = n - 1;
  const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const top = 190, reach = Math.max(...d.distance) + 0.42, mm = Math.min((W - 60) / reach, (top - 30) / 0.16);
  const shade = (share) => `hsl(${215 - 205 * Math.min(share, 1)}, 75%, 52%)`;
  function line(points, colour, width) {
    c.strokeStyle = colour; c.lineWidth = width; c.beginPath();
    points.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y)); c.stroke();
  }
  function text(words, x, y, colour, align = "left", size = 13) {
    c.fillStyle = colour; c.textAlign = align; c.font = `${size}px system-ui, sans-serif`; c.fillText(words, x, y);
  }
  function shoe(x, y, angle) {
    c.save(); c.translate(x, y); c.rotate(-angle); c.scale(mm, -mm);
    c.beginPath(); c.moveTo(0.004, 0); c.lineTo(0.075, 0); c.lineTo(0.082, 0.012); c.lineTo(0.125, 0.012); c.lineTo(0.135, 0);
    c.lineTo(0.255, 0); c.quadraticCurveTo(0.29, 0.004, 0.292, 0.03); c.lineTo(-0.002, 0.03); c.lineTo(0, 0.003); c.closePath();
    c.fillStyle = "#3b3f45"; c.fill();
    c.beginPath(); c.moveTo(-0.002, 0.03); c.lineTo(0.292, 0.03); c.quadraticCurveTo(0.285, 0.062, 0.2, 0.075);
    c.quadraticCurveTo(0.13, 0.085, 0.11, 0.14); c.lineTo(0.0, 0.14); c.quadraticCurveTo(-0.008, 0.08, -0.002, 0.03); c.closePath();
    c.fillStyle = "#8a6f52"; c.fill(); c.restore();
  }
  function arrow(x, y, length, colour) {
    if (Math.abs(length) < 3) return;
    const s = Math.sign(length); line([[x, y], [x + length, y]], colour, 3);
    line([[x + length - 7 * s, y - 5], [x + length, y], [x + length - 7 * s, y + 5]], colour, 3);
  }
  function stage(i) {
    const floor = top - 22, x0 = 30, at = x0 + 0.03 * mm;
    c.fillStyle = d.wet ? "#9cc6e8" : ink("--line"); c.fillRect(x0, floor, W - 60, d.wet ? 4 : 2);
    c.fillStyle = ink("--soft"); c.fillRect(x0, floor + 4, W - 60, 3);
    if (d.wet) d.sensors.forEach((s) => { c.fillStyle = ink("--accent"); c.fillRect(at + s * mm - 3, floor + 4, 6, 9); });
    shoe(at + d.distance[i] * mm, floor, d.angle[i]);
    const heel = at + d.distance[i] * mm;
    arrow(heel + 0.10 * mm, 22, d.speed[i] * 60, ink("--accent"));
    text(`${d.speed[i].toFixed(2)} m/s`, W - 30, 27, ink("--accent"), "right"); // clear of the shoe
    text(`${(1000 * d.distance[i]).toFixed(0)} mm`, heel, floor + 20, ink("--soft"), "left", 12);
    if (d.wet) text("sensors", at + d.sensors[d.sensors.length - 1] * mm + 10, floor + 20, ink("--accent"), "left", 11);
  }
  function film(i) {
    const y0 = 390, h = 150, left = 70, right = W - 130, xs = d.sole_x;
    const lo = Math.min(...xs), hi = Math.min(Math.max(...xs), 0.09), sx = (x) => left + (x - lo) / (hi - lo) * (right - left);
    const most = Math.min(d.pool, 300), sy = (f) => y0 - Math.min(f, most) / most * h;
    text(`Under the heel, along its centre line: film (0 to ${most.toFixed(0)} µm) in the colour of its pressure`, left, y0 - h - 12, ink("--ink"));
    const inside = [];
    xs.forEach((x, k) => { if (x <= hi && d.films[i][k] !== null) inside.push([x, d.films[i][k]]); });
    for (let k = 0; k + 1 < inside.length; k++) {
      const [x, f] = inside[k], [x2, f2] = inside[k + 1];
      let best = 0; d.map_x.forEach((m, j) => { if (Math.abs(m - x) < Math.abs(d.map_x[best] - x)) best = j; });
      const p = d.pressures[i][best];
      c.fillStyle = p > 1 ? shade(p / d.highest) : "#9cc6e8"; c.beginPath();
      c.moveTo(sx(x), y0); c.lineTo(sx(x), sy(f)); c.lineTo(sx(x2) + 0.5, sy(f2)); c.lineTo(sx(x2) + 0.5, y0); c.closePath(); c.fill();
    }
    line(inside.map(([x, f]) => [sx(x), sy(f)]), ink("--ink"), 2.5);
    line([[left, y0], [right, y0]], ink("--soft"), 3);
    text("rear end", sx(0), y0 + 17, ink("--soft"), "center", 12); text("toe →", right, y0 + 17, ink("--soft"), "right", 12);
    [0, 0.02, 0.04].forEach((x) => { if (x > 0 && x < hi) text(`${(1000 * x).toFixed(0)} mm`, sx(x), y0 + 17, ink("--soft"), "center", 12); });
    for (let k = 0; k < 60; k++) { c.fillStyle = shade(1 - k / 59); c.fillRect(W - 100, y0 - h + k * h / 60, 14, h / 60 + 1); }
    text(`${d.highest.toFixed(0)} kPa`, W - 82, y0 - h + 10, ink("--soft"), "left", 12); text("0", W - 82, y0, ink("--soft"), "left", 12);
    const share = d.normal[i] > 1 ? d.film_load[i] / d.normal[i] : 0;
    text(`${(100 * share).toFixed(0)} % of ${d.normal[i].toFixed(0)} N on the film`, right, y0 - h - 12, ink("--ink"), "right");
  }
  function curve(values, most, least, x0, y0, w, h, colour, i, label, row) {
    const sx = (t) => x0 + t / d.time[n - 1] * w, sy = (v) => y0 - (v - least) / (most - least) * h;
    line(values.map((v, k) => [sx(d.time[k]), sy(v)]), colour, 1.8);
    c.fillStyle = colour; c.beginPath(); c.arc(sx(d.time[i]), sy(values[i]), 4, 0, 7); c.fill();
    text(label, x0 + w, y0 - h - 4 + 15 * row, colour, "right", 12);
  }
  function graphs(i) {
    const y0 = H - 34, h = 140, w = W / 2 - 90;
    [[60, "m/s"], [W / 2 + 50, "N"]].forEach(([x, unit], g) => {
      const values = g ? [d.drive, d.friction] : [d.speed];
      const most = 1.15 * Math.max(...values.flat(), g ? 10 : 0.25), least = Math.min(0, 1.1 * Math.min(...values.flat()));
      line([[x, y0 - h], [x, y0], [x + w, y0]], ink("--line"), 1.5);
      const zero = y0 - (0 - least) / (most - least) * h; line([[x, zero], [x + w, zero]], ink("--line"), 1);
      text(most.toFixed(most < 10 ? 1 : 0), x - 6, y0 - h + 8, ink("--soft"), "right", 12); text("0", x - 6, zero + 4, ink("--soft"), "right", 12);
      text(unit, x - 6, y0 - h + 24, ink("--soft"), "right", 12);
      text("0", x, y0 + 18, ink("--soft"), "center", 12); text(`${(1000 * d.time[n - 1]).toFixed(0)} ms`, x + w, y0 + 18, ink("--soft"), "right", 12);
      if (!g) { curve(d.speed, most, least, x, y0, w, h, ink("--accent"), i, "heel speed", 0);
        const slip = y0 - (0.2 - least) / (most - least) * h; c.setLineDash([3, 4]); line([[x, slip], [x + w, slip]], "#b3472f", 1); c.setLineDash([]);
        text("slip above 0.2 m/s", x + 8, slip - 4, "#b3472f", "left", 11); }
      else { curve(d.drive, most, least, x, y0, w, h, "#c2603f", i, "push forward, r F", 0); curve(d.friction, most, least, x, y0, w, h, "#3f9664", i, "friction", 1); }
    });
  }
  function draw(i) {
    c.setTransform(scale, 0, 0, scale, 0, 0); c.clearRect(0, 0, W, H);
    stage(i); if (d.films) film(i); graphs(i);
    now.textContent = `${(1000 * d.time[i]).toFixed(0)} ms`;
  }
  let playing = false, began = 0, from = 0;
  function tick(t) {
    if (!playing) return;
    const life = d.time[from] + (t - began) / 10000;
    let i = d.time.findIndex((s) => s >= life); if (i < 0) i = n - 1;
    slider.value = i; draw(i);
    if (i >= n - 1) { playing = false; button.textContent = "Play again"; } else requestAnimationFrame(tick);
  }
  button.addEventListener("click", () => {
    playing = !playing; button.textContent = playing ? "Pause" : "Play";
    if (playing) { from = +slider.value >= n - 1 ? 0 : +slider.value; began = performance.now(); requestAnimationFrame(tick); }
  });
  slider.addEventListener("input", () => { playing = false; button.textContent = "Play"; draw(+slider.value); });
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => draw(+slider.value));
  slider.value = Math.round(n / 3); draw(+slider.value);
})();
