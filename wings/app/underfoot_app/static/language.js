// Words of the package in the language of the page, and its decimal sign: every text and label, from
// wherever it comes. "{}" of a catalogue's sentence stands for a part that changes and is itself put
// into the language; user's names and files carry translate="no".
const LABELS = ["aria-label", "aria-valuetext", "title", "alt", "label"];
const exactWords = new Map(), sentenceForms = [], translations = new Map(), written = new WeakMap();

for (const [english, other] of Object.entries(spoken.words)) {
  if (!english.includes("{}")) { exactWords.set(english, other); continue; }
  const form = english.split("{}").map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")).join("(.+?)");
  const fixed = english.replaceAll("{}", "").length; // what joins any two parts comes last, as the file has it
  sentenceForms.push([new RegExp(`^${form}$`, "s"), other, fixed < 6 ? 0 : fixed]);
}
sentenceForms.sort((a, b) => b[2] - a[2]);

function capital(text) { return text[0].toUpperCase() + text.slice(1); }

function withDecimals(text) {
  return spoken.decimal === "." ? text : text.replace(/(?<![\d.\w])(\d+)\.(\d+)(?![\w]*\.\d)/g, `$1${spoken.decimal}$2`);
}

function inLanguage(text, depth = 0) {
  const core = text.trim(), plain = core.replaceAll("\u00a0", " ");
  if (!core || depth > 20) return text;
  if (!translations.has(core)) {
    translations.set(core, withDecimals(core)); // what a form of itself would come back to
    translations.set(core, formed(plain, depth));
  }
  return text.replace(core, () => translations.get(core));
}

function formed(core, depth) {
  if (exactWords.has(core)) return exactWords.get(core);
  const small = core[0].toLowerCase() + core.slice(1);
  if (small !== core && exactWords.has(small)) return capital(exactWords.get(small));
  if (!/[A-Za-z]{2}/.test(core)) return withDecimals(core);
  const whole = asForm(core, small, depth, (fixed) => fixed > 0);
  if (whole !== null) return whole;
  const sentences = core.split(/(?<=[.!?]) (?=[A-Z])/);
  if (sentences.length > 1) return sentences.map((each) => inLanguage(each, depth + 1)).join(" ");
  return asForm(core, small, depth, (fixed) => fixed === 0) ?? withDecimals(core);
}

function asForm(core, small, depth, wanted) {
  for (const [form, other, fixed] of sentenceForms) {
    const as = form.test(core) ? core : small, parts = wanted(fixed) && form.exec(as);
    if (!parts) continue;
    const said = other.replace(/\{(\d)\}/g, (_, k) => inLanguage(parts[Number(k) + 1], depth + 1));
    return as === core ? said : capital(said);
  }
  return null;
}

function speakAll(root) {
  if (root.nodeType === Node.TEXT_NODE) { speakText(root); return; }
  if (root.nodeType !== Node.ELEMENT_NODE || root.closest(UNSPOKEN)) return;
  speakLabels(root);
  for (const each of root.querySelectorAll(LABELS.map((label) => `[${label}]`).join())) speakLabels(each);
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) speakText(walker.currentNode);
}
const UNSPOKEN = "[translate=no], script, style, pre, code, textarea";

function speakText(node) {
  const text = node.data;
  if (written.get(node) === text || !node.parentElement || node.parentElement.closest(UNSPOKEN)) return;
  const other = inLanguage(text);
  written.set(node, other);
  if (other !== text) node.data = other;
}

function speakLabels(element) {
  if (element.closest(UNSPOKEN)) return;
  for (const label of LABELS) {
    const text = element.getAttribute(label), other = text && inLanguage(text);
    if (text !== other) element.setAttribute(label, other);
  }
}

if (spoken.decimal !== "." || exactWords.size) {
  new MutationObserver((changes) => {
    for (const change of changes) {
      if (change.type === "characterData") speakText(change.target);
      else if (change.type === "attributes") speakLabels(change.target);
      else change.addedNodes.forEach(speakAll);
    }
  }).observe(document, { subtree: true, childList: true, characterData: true, attributes: true, attributeFilter: LABELS });
}
