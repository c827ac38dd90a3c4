// Words of the package in the language of the page, and its decimal sign: every text and label, from
// wherever it comes. "{}" of a catalogue's sentence stands for a part that changes and is itself put
// into the language; user's names and files carry translate="no", and stay in a sentence too where
// they stand in quotes, look like a file, or are among the project's.
const LABELS = ["aria-label", "aria-valuetext", "title", "alt", "label"];
const FILE = /^[^\s{}]*[^\s\d{}][^\s{}]*\.[A-Za-z]\w{1,4}$/;
const exactWords = new Map(), sentenceForms = [], translations = new Map(), written = new WeakMap();
const ownNames = new Set(typeof namesOfUser === "undefined" ? [] : namesOfUser);

for (const [english, other] of Object.entries(spoken.words)) {
  if (!english.includes("{}")) { exactWords.set(english, other); continue; }
  const pieces = english.split("{}"), text = pieces.join("");
  const between = !/\w/.test(pieces[0] + pieces.at(-1)) && /^\W*(\w+|\w{1,5} \w{1,5})\W*$/.test(text);
  const beside = english.includes("{} {}") && text.length < 9; // "over {} {}" takes any three words
  const short = between || beside || text.length < 6, words = /\w/.test(text), marks = /[^\w\s]/.test(text);
  const joins = short || !/[A-Za-z]{4}|[A-Z]{2}/.test(text), withWords = joins && /[a-z]/.test(text);
  // marks part a text before words do: "a; b of the c"
  const fixed = short && !words ? 0 : short && !marks ? text.length / 1e3 - 1 : text.length;
  const within = short && words && !text.includes(";"); // what words join ends at a semicolon
  sentenceForms.push({ english, pieces, form: null, other, joins, withWords, within, fixed });
}
sentenceForms.sort((a, b) => b.fixed - a.fixed); // what joins any two parts comes last, as the file has it

// Places of the forms by their longest word that touches no part: a text is held against few forms.
const byWord = new Map(), anywhere = [];
sentenceForms.forEach(({ english }, place) => {
  const words = english.toLowerCase().match(/(?<![a-z'}])[a-z']+(?![a-z'{])/g);
  if (!words) { anywhere.push(place); return; }
  const longest = words.reduce((most, word) => (word.length > most.length ? word : most));
  if (!byWord.has(longest)) byWord.set(longest, []);
  byWord.get(longest).push(place);
});

function capital(text) { return text[0].toUpperCase() + text.slice(1); }

const NUMBER = /(?<![\d.\w])([1-9]\d{0,2}(?:,\d{3})+(?!\d)|\d+)(?:\.(\d+)(?![\w]*\.\d))?/g;
function withDecimals(text) { // 1,200.5 is 1.200,5 where the decimal sign is a comma
  if (spoken.decimal === ".") return text;
  return text.replace(NUMBER, (_, whole, part) => whole.replaceAll(",", ".") + (part ? spoken.decimal + part : ""));
}

const BREAK = /(?<=[.!?]) (?=[A-Z]|\d+ of \d)/; // between two sentences
function inLanguage(text, depth = 0) {
  const core = text.trim(), plain = core.replaceAll("\u00a0", " ");
  if (!core || depth > 20) return text;
  if (!translations.has(core)) {
    translations.set(core, withDecimals(core)); // what a form of itself would come back to
    const said = formed(plain, depth);
    const held = core.includes("\u00a0%") ? said.replaceAll(" %", "\u00a0%") : said; // no % alone on a line
    if (said !== plain) translations.set(core, held); // blanks that hold together stay where nothing is put in
  }
  return text.replace(core, () => translations.get(core));
}

function formed(core, depth) {
  if (exactWords.has(core)) return exactWords.get(core);
  const small = core[0].toLowerCase() + core.slice(1);
  if (small !== core && exactWords.has(small)) return capital(exactWords.get(small));
  const bare = core.replace(/\.$/, ""), dot = core.slice(bare.length);
  if (dot && exactWords.has(bare)) return exactWords.get(bare) + dot;
  if (dot && exactWords.has(small.slice(0, -1))) return capital(exactWords.get(small.slice(0, -1))) + dot;
  if (!/[A-Za-z]{2}/.test(core)) return withDecimals(core);
  const whole = asForm(core, small, depth, (joins) => !joins);
  if (whole !== null) return whole;
  const [, where, what] = /^([^:]+): (.+)$/s.exec(core) ?? []; // of an error
  if (exactWords.has(where)) return `${exactWords.get(where)}: ${inLanguage(what, depth + 1)}`;
  const sentences = core.split(BREAK);
  if (sentences.length > 1) return runs(sentences).map((each) => inLanguage(each, depth + 1)).join(" ");
  if (dot) return inLanguage(bare, depth + 1) + dot;
  return asForm(core, small, depth, (joins) => joins) ?? withDecimals(core);
}

// Sentences of a text, those together that the catalogue has together.
function runs(sentences) {
  const told = [];
  for (let start = 0, end; start < sentences.length; start = end) {
    const upTo = (last) => sentences.slice(start, last).join(" ");
    const isOne = (text) => exactWords.has(text) || exactWords.has(text.replace(/\.$/, ""));
    end = sentences.length - (start === 0);
    while (end > start + 1 && !isOne(upTo(end))) end -= 1;
    told.push(upTo(end));
  }
  return told;
}

function asForm(core, small, depth, wanted) {
  const spellings = [core, small, ...(core.endsWith(".") ? [core.slice(0, -1), small.slice(0, -1)] : [])];
  const places = [...new Set(core.toLowerCase().match(/[a-z']+/g))].flatMap((word) => byWord.get(word) ?? []);
  for (const place of [...anywhere, ...places].sort((a, b) => a - b)) {
    const { pieces, other, joins, withWords, within } = sentenceForms[place];
    if (!wanted(joins)) continue;
    const form = (sentenceForms[place].form ??= formOf(pieces)), as = spellings.find((each) => form.test(each));
    if (as === undefined) continue;
    const parts = form.exec(as).slice(1);
    if (!joins && parts.some((part) => BREAK.test(part))) continue; // each sentence for itself
    if (within && parts.some((part) => part.includes("; "))) continue;
    if (withWords && parts.some((part) => !isKnown(part, depth))) continue;
    const quoted = (k) => /["„]$/.test(pieces[k]) && /^["“]/.test(pieces[k + 1]);
    const put = (k) => (quoted(k) || isOwn(parts[k]) ? parts[k] : inLanguage(parts[k], depth + 1));
    const said = other.replace(/\{(\d+)\}/g, (_, k) => put(Number(k)));
    return (as[0] === core[0] ? said : capital(said)) + core.slice(as.length);
  }
  return null;
}

function formOf(pieces) {
  const fixed = pieces.map((piece) => piece.replace(/[.*+?^${}()|[\]\\]/g, "\\$&"));
  return new RegExp(`^${fixed.join("(.+?)")}$`, "s");
}

// Whether a part is a name of the user's: of a variant of the project, or of a file.
function isOwn(part) { return ownNames.has(part.trim()) || FILE.test(part.trim()); }

// Whether the catalogue has words for a part, or it has none: "to" in a sentence that is not known joins nothing.
function isKnown(part, depth) {
  return isOwn(part) || !/[A-Za-z]{4}/.test(part) || inLanguage(part, depth + 1) !== withDecimals(part) || exactWords.has(part.trim());
}

// A message of the package: the template of its code in the language, with its values; what has
// no template is a text like any other. What stands in quotes is as somebody wrote it.
const FIELD = /\{(\w+)(?::([^}]*))?\}/g, asWritten = (value) => value;
function messageInLanguage(message) {
  const { about, code, values } = message;
  const said = isKnownCode(code) ? filled(spoken.messages[code] ?? code, values) : inLanguage(filled(code, values, asWritten));
  return about ? `${isOwn(about) ? about : inLanguage(about)}: ${said}` : said;
}

// A template without words is the same in all languages.
function isKnownCode(code) { return code in spoken.messages || !/[A-Za-z]{2}/.test(code.replace(FIELD, "")); }

function filled(template, values, put = (value) => (isOwn(value) ? value : inLanguage(value))) {
  return template.replace(FIELD, (field, name, form, at) => {
    const quoted = /["„“]$/.test(template.slice(0, at)) && /^["“”]/.test(template.slice(at + field.length));
    return valueIn(values[name], form, quoted ? asWritten : put);
  });
}

function valueIn(value, form = "", put = asWritten) {
  if (Array.isArray(value)) return value.map((each) => valueIn(each, "", put)).join(form || ", ");
  if (form.includes("|")) return form.split("|")[value === "1" ? 0 : 1];
  const said = typeof value !== "object" ? put(value) : put === asWritten ? filled(value.code, value.values, put) : messageInLanguage(value);
  return form === "capital" ? capital(said) : form === "small" ? said[0].toLowerCase() + said.slice(1) : said;
}

// The text of an element that holds template and values.
function elementInLanguage(element, text) {
  const message = element.dataset.message && JSON.parse(element.dataset.message);
  return message && isKnownCode(message.code) ? messageInLanguage(message).replaceAll(" %", "\u00a0%") : inLanguage(text);
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
  const other = elementInLanguage(node.parentElement, text);
  written.set(node, other);
  if (other !== text) node.data = other;
}

function speakLabels(element) {
  if (element.closest(UNSPOKEN)) return;
  if (!written.has(element)) written.set(element, {});
  const own = written.get(element); // 1.234 is written as 1,234, which read again is a thousand
  for (const label of LABELS) {
    const text = element.getAttribute(label);
    if (!text || own[label] === text) continue;
    own[label] = inLanguage(text);
    if (own[label] !== text) element.setAttribute(label, own[label]);
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
