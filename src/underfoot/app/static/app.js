// The page's own scripts: soles that are fetched, sliders that ask, files that are dropped.

// Show the viewer at an address; where it is of the same kind as the one there, view and colour stay.
async function showSole(id, address) {
  const place = document.getElementById(id), response = place && await fetch(address);
  if (!response || !response.ok) return;
  place.classList.remove("unanswered");
  await putSole(place, await response.text());
}

async function putSole(place, html) {
  const fresh = document.createElement("div");
  fresh.innerHTML = html;
  const scene = () => JSON.parse(fresh.querySelector("script[type='application/json']").textContent);
  if (place.sole && await place.sole.update(scene())) return;
  const before = place.sole;
  for (const canvas of place.querySelectorAll("canvas")) canvas.getContext("webgl2")?.getExtension("WEBGL_lose_context")?.loseContext();
  place.replaceChildren(...fresh.childNodes);
  place.sole = await openViewer(place.querySelector(".viewer"));
  if (before && place.sole) place.sole.colour(before.quantity);
}

// Show the plots of a design study at an address; a click on a design sends "chosen" with its number.
// The axes and the design that a person chose stay.
async function showStudy(id, address) {
  const place = document.getElementById(id), response = place && await fetch(address);
  if (!response || !response.ok) return;
  const before = place.querySelector(".study"), axes = () => [...place.querySelectorAll(".study select")];
  const chosen = before?.dataset.chosen, names = axes().map((axis) => axis.value);
  place.innerHTML = await response.text();
  const root = place.querySelector(".study");
  if (!root) return;
  if (chosen) root.dataset.chosen = chosen;
  startStudy(root);
  if (before) axes().forEach((axis, k) => { axis.value = names[k]; axis.dispatchEvent(new Event("change")); });
}

// Show a part of a page at an address.
async function showPart(id, address) {
  const place = document.getElementById(id), response = place && await fetch(address);
  if (response && response.ok) place.innerHTML = await response.text();
}

// Send files one after the other into a folder of the project; "files" says where they are.
const unopened = new Map(); // what waits for its place: in tabs not opened yet, or not drawn yet
new MutationObserver(() => unopened.forEach((begin, id) => {
  if (document.getElementById(id)) { unopened.delete(id); begin(); }
})).observe(document.documentElement, { childList: true, subtree: true });

function takeFiles(id, settings, words) {
  const { folder, most, multiple, accept } = settings;
  const zone = document.getElementById(id), state = zone?.querySelector(".drop-state");
  if (!zone) { unopened.set(id, () => takeFiles(id, settings, words)); return; }
  const input = Object.assign(document.createElement("input"), { type: "file", multiple, accept, hidden: true });
  zone.append(input);
  const say = (text, ...values) => { state.textContent = values.reduce((t, v, k) => t.replace(`%${k + 1}`, v), text); };
  async function send(files) {
    const paths = [];
    for (const file of files) {
      if (file.size > most) { say(words.too_large, file.name, Math.round(file.size / 1e6), Math.round(most / 1e6)); return; }
      say(words.sending, file.name, (file.size / 1e6).toFixed(1));
      const name = (file.webkitRelativePath || file.name).split("/").map(encodeURIComponent).join("/");
      try {
        const response = await fetch(`/api/files/${folder}/${name}`, { method: "POST", body: file });
        const answer = response.ok ? await response.json() : { problem: (await response.text()).replace(/<[^>]*>/g, "") };
        if (answer.problem) { say("%1", answer.problem); return; }
        paths.push(answer.path);
      } catch (problem) { say(words.failed, file.name, problem.message); return; }
    }
    say("");
    input.value = "";
    zone.dispatchEvent(new CustomEvent("files", { detail: { paths } }));
  }
  input.addEventListener("change", () => send([...input.files]));
  zone.addEventListener("click", (e) => { if (e.target !== input) input.click(); });
  zone.addEventListener("keydown", (e) => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); input.click(); } });
  for (const kind of ["dragenter", "dragover"]) zone.addEventListener(kind, (e) => { e.preventDefault(); zone.classList.add("over"); });
  for (const kind of ["dragleave", "drop"]) zone.addEventListener(kind, () => zone.classList.remove("over"));
  zone.addEventListener("drop", (e) => { e.preventDefault(); send([...e.dataTransfer.files].slice(0, multiple ? undefined : 1)); });
}

// A page that puts what it shows into the address is built anew when one goes back.
addEventListener("popstate", () => location.reload());

// Ctrl+Z undoes, Ctrl+Shift+Z and Ctrl+Y redo, but for the text in a field.
addEventListener("keydown", (e) => {
  const key = e.key.toLowerCase(), typing = e.target.matches?.("textarea, input:not([type=range], [type=radio], [type=checkbox]), [contenteditable]");
  if (!(e.ctrlKey || e.metaKey) || typing || (key !== "z" && key !== "y")) return;
  const step = key === "y" || e.shiftKey ? "redo" : "undo", button = document.querySelector(`[data-step=${step}]`);
  if (button) { e.preventDefault(); button.click(); }
});

// A lug that is chosen on the sole: its lengths are those of the sliders. They are typed here, or its
// edge is dragged; every change goes the way of a slider.
// A number as a field of the page writes it, and what a person typed there, read as in a case file.
const numberText = (value) => String(Number(value.toPrecision(3))).replace(".", spoken.decimal);
async function readQuantity(text, unit) {
  const body = JSON.stringify({ text, unit, comma: spoken.decimal === "," });
  const answer = await fetch("/api/quantity", { method: "POST", body, headers: { "content-type": "application/json" } });
  return answer.json();
}
const LENGTHS = ["lug_width", "lug_length", "channel_width", "depth", "edge_chamfer"].map((name) => `shoe.tread.${name}`);
const lengthSlider = (name) => document.querySelector(`.sliders input[name="${name}"]`);
function sliderValue(slider) {
  const { moved, typed, given, log } = slider.dataset;
  if (!moved) return Number(given);
  if (typed) return Number(typed);
  return log ? Number((10 ** Number(slider.value)).toPrecision(3)) : Number(slider.value);
}
// The thumb goes to the nearest step; a value that is typed stays as it is typed.
function setSlider(slider, shown, done, typed) {
  const step = Number(slider.step), low = Number(slider.min);
  slider.value = String(low + Math.round((shown - low) / step) * step);
  slider.dispatchEvent(new CustomEvent("input", { bubbles: true, detail: typed ? String(shown) : "" }));
  if (done) slider.dispatchEvent(new Event("change", { bubbles: true }));
}
addEventListener("lug", ({ target: viewer }) => {
  const place = viewer.closest(".sole-view"), sliders = LENGTHS.map(lengthSlider).filter(Boolean);
  const card = Object.assign(document.createElement("div"), { className: "lug-card" });
  if (sliders.length) viewer.dataset.editable = "yes";
  const note = Object.assign(document.createElement("p"), { textContent: sliders.length ? place.dataset.lugs : place.dataset.fileLugs });
  card.append(note);
  for (const slider of sliders) {
    const label = document.createElement("label"), field = Object.assign(document.createElement("input"), { inputMode: "decimal" });
    const size = Number(slider.dataset.size), unit = slider.dataset.unit;
    field.name = `lug ${slider.name}`;
    field.value = numberText(sliderValue(slider) / size);
    field.addEventListener("change", async () => {
      const { value, problem } = await readQuantity(field.value, unit), low = Number(slider.min) / size, high = Number(slider.max) / size;
      const outside = value < low || value > high ? `${numberText(low)} - ${numberText(high)} ${unit}` : "";
      field.setAttribute("aria-invalid", String(Boolean(problem || outside)));
      note.textContent = problem || outside || place.dataset.lugs;
      note.role = problem || outside ? "alert" : "";
      if (!problem && !outside) setSlider(slider, value * size, true, true);
    });
    label.append(document.querySelector(`label[for="${slider.id}"]`).firstChild.data, field, slider.dataset.unit);
    card.append(label);
  }
  place.querySelector(".lug-card")?.remove();
  viewer.querySelector(".scene").after(card);
});
let dragged = null;
addEventListener("edge", ({ target: viewer, detail: { out, normal, done } }) => {
  const long = lengthSlider("shoe.tread.lug_length"), slider = long && Math.abs(normal[0]) > Math.abs(normal[1]) ? long : lengthSlider("shoe.tread.lug_width");
  if (!slider) return;
  dragged ??= sliderValue(slider);
  setSlider(slider, dragged + 2e3 * out, done); // mm; it grows to both sides
  const field = viewer.querySelector(`[name="lug ${slider.name}"]`);
  if (field) field.value = numberText(Number(slider.value) / Number(slider.dataset.size));
  if (done) dragged = null;
});

// Put words into every element that waits for them by name.
function showTexts(texts) {
  for (const [name, text] of Object.entries(texts)) {
    for (const part of document.querySelectorAll(`[data-live="${name}"]`)) {
      if (text.message) part.dataset.message = text.message; // by which it is put into the language
      else delete part.dataset.message;
      part.textContent = text.text ?? text;
    }
  }
}

// Sliders that ask: the next question goes out only when the last answer is drawn, and it carries
// the newest values. An answer sets texts by name and the sole; "problem" says why there is none.
// Where a slider has come to rest the question says "last": at once where values are kept, so that
// none is lost to who goes on quickly, else after a moment.
function askLive(id, address, soleId, keep) {
  const root = document.getElementById(id);
  if (!root) { unopened.set(id, () => askLive(id, address, soleId, keep)); return; }
  const inputs = [...root.querySelectorAll("input[type=range]")];
  let asked = "{}", settled = "{}", busy = false, telling = false, held = false, resting = 0;
  const values = () => JSON.stringify(Object.fromEntries(inputs.filter((i) => i.dataset.moved)
    .map((i) => [i.name, sliderValue(i)])));
  const show = (input) => {
    const words = `${numberText(sliderValue(input) / Number(input.dataset.size))} ${input.dataset.unit}`.trim();
    root.querySelector(`output[for="${input.id}"]`).textContent = words;
    input.setAttribute("aria-valuetext", words);
  };
  let unkept = ""; // why the last value is not in the file: said until it is
  const tell = (words) => { root.querySelector("[data-part=problem]").textContent = unkept || words || ""; };
  async function send(now, last) {
    const body = `{"values": ${now}, "last": ${last}}`, headers = { "content-type": "application/json" };
    try {
      const response = await fetch(address, { method: "POST", body, headers, keepalive: last });
      return response.ok ? await response.json() : { problem: response.statusText };
    } catch (problem) { return { problem: problem.message }; }
  }
  async function ask() {
    if (busy) return;
    busy = true;
    for (let now = values(); now !== asked; now = values()) {
      const began = performance.now(), answer = await send(now, false), place = document.getElementById(soleId);
      asked = now;
      tell(answer.problem);
      showTexts(answer.texts || {});
      place?.classList.toggle("unanswered", Boolean(answer.unanswered || answer.problem));
      if (answer.html && place) await putSole(place, answer.html);
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      root.dataset.took = String(performance.now() - began);
      root.dataset.asked = String(Number(root.dataset.asked || 0) + 1);
    }
    busy = false;
    later();
  }
  // Where nothing is kept, half a second after the last answer to a slider that was let go.
  function later() {
    clearTimeout(resting);
    if (!keep && !held && !busy) resting = setTimeout(rest, 500);
  }
  async function rest() { // one at a time, in order
    if (telling) return;
    telling = true;
    for (let now = values(); now !== settled; now = values()) {
      const answer = await send(now, true);
      unkept = answer.problem || "";
      tell();
      if (answer.again && document.body.contains(root)) { setTimeout(rest, 1000); break; } // a full disk: until there is room
      settled = now;
    }
    telling = false;
  }
  if (keep) addEventListener("pagehide", () => { if (values() !== settled) send(values(), true); });
  for (const input of inputs) {
    show(input);
    input.addEventListener("input", (e) => { input.dataset.moved = "yes"; input.dataset.typed = e instanceof CustomEvent ? e.detail : ""; input.labels[0].querySelector("small").textContent = root.dataset.own; held = true; clearTimeout(resting); show(input); ask(); });
    input.addEventListener("change", () => { held = false; if (keep) rest(); else later(); });
  }
}

// A form that is built anew takes away the field that is typed in: the new one goes on with the text.
let typing = null;
const isField = (e) => e instanceof Element && e.matches("input:not([type=range]), textarea") && e.ariaLabel;
addEventListener("focusin", ({ target }) => {
  if (isField(target)) typing = { field: target, label: target.ariaLabel, text: null };
});
addEventListener("input", ({ target }) => {
  if (isField(target)) typing = { field: target, label: target.ariaLabel, text: target.value };
}, true);
addEventListener("change", ({ target }) => setTimeout(() => { // a field that is taken away changes, too
  if (typing && typing.field === target && target.isConnected) typing.text = null;
}), true);
addEventListener("focusout", ({ target }) => {
  if (typing && typing.field === target && target.isConnected) setTimeout(() => {
    if (typing && typing.field === target && target.isConnected) typing = null;
  });
});
new MutationObserver(() => {
  if (!typing || typing.field.isConnected) return;
  const { label, text } = typing;
  const field = [...document.querySelectorAll("input, textarea")]
    .find((e) => isField(e) && e.ariaLabel === label && e.checkVisibility());
  if (!field) return;
  typing = null;
  field.focus();
  if (text === null) { field.select(); return; }
  field.value = text;
  field.dispatchEvent(new Event("input", { bubbles: true }));
  // A browser says nothing of a change that a script wrote: the field tells it itself when it is left.
  let told = false;
  const tell = () => setTimeout(() => {
    if (!told && field.isConnected) field.dispatchEvent(new Event("change", { bubbles: true }));
  });
  field.addEventListener("change", () => { told = true; });
  field.addEventListener("blur", tell);
  field.addEventListener("keydown", ({ key }) => { if (key === "Enter") tell(); });
}).observe(document, { childList: true, subtree: true });
