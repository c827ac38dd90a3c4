// Sentences made of a template and values, as the package's messages: a page puts them into its language.

function sentenceOf(code, values) { return code.replace(/\{(\w+)\}/g, (_, name) => values[name]); }

function say(element, code, values) {
  element.dataset.message = JSON.stringify({ code, values });
  element.textContent = sentenceOf(code, values);
  return element;
}
