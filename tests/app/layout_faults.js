// What of a page is cut, covered or empty as it stands: a list of sentences.
() => {
  const found = new Set(), say = (what, text) => found.add(`${what}: ${text.trim().slice(0, 60)}`);
  const beyond = document.documentElement.scrollWidth - document.documentElement.clientWidth;
  if (beyond > 1) found.add(`the page is ${beyond} px wider than the window`);
  const forEars = (e) => e && (getComputedStyle(e).clipPath === "inset(50%)" || forEars(e.parentElement));
  const shown = (e) => e.checkVisibility({ opacityProperty: true, visibilityProperty: true })
    && !e.closest("[aria-hidden=true], .q-icon, noscript") && !forEars(e);
  const inside = (e) => { // what scrolls shows the rest; what hides cuts it off
    const boxes = [];
    for (let a = e; a && a !== document.body; a = a.parentElement) {
      const style = getComputedStyle(a), box = a.getBoundingClientRect();
      if (style.position === "fixed") break;
      if (style.overflowX !== "visible" || style.overflowY !== "visible") {
        boxes.push({ a, box, x: style.overflowX, y: style.overflowY });
      }
    }
    return boxes;
  };
  const rects = [], walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode, e = node.parentElement;
    if (!node.data.trim() || e.closest("script, style, textarea, option, select") || !shown(e)) continue;
    const range = document.createRange(), boxes = inside(e);
    range.selectNodeContents(node);
    for (const r of range.getClientRects()) {
      if (r.width < 1 || r.height < 1) continue;
      let [left, top, right, bottom] = [r.left, r.top, r.right, r.bottom], seen = true;
      for (const { a, box, x, y } of boxes) {
        const field = a.closest(".q-field, .q-btn, .q-tab, output, label");
        if ((x === "hidden" || x === "clip" || field) && (right > box.right + 1.5 || left < box.left - 1.5)) say("cut at the side", node.data);
        if ((y === "hidden" || y === "clip") && bottom - box.bottom > 0.35 * r.height && top < box.bottom) say("cut below", node.data);
        left = Math.max(left, box.left); right = Math.min(right, box.right);
        top = Math.max(top, box.top); bottom = Math.min(bottom, box.bottom);
        if (right - left < 1 || bottom - top < 1) seen = false;
      }
      if (seen) rects.push({ left, top, right, bottom, node, text: node.data });
    }
  }
  for (const e of document.querySelectorAll("input, textarea")) {
    if (!shown(e) || ["range", "radio", "checkbox", "file", "hidden"].includes(e.type)) continue;
    if (e.tagName === "INPUT" && e.scrollWidth > e.clientWidth + 1) say("longer than its field", e.value);
    const r = e.getBoundingClientRect();
    if (e.tagName === "INPUT" && e.value && r.width) {
      const style = getComputedStyle(e), pen = document.createElement("canvas").getContext("2d");
      pen.font = style.font;
      const wide = pen.measureText(e.value).width, left = r.left + parseFloat(style.paddingLeft);
      rects.push({ left, top: r.top + parseFloat(style.paddingTop), right: left + wide, bottom: r.bottom - parseFloat(style.paddingBottom), node: e, text: e.value });
    }
  }
  rects.sort((a, b) => a.top - b.top);
  for (let i = 0; i < rects.length; i += 1) {
    const a = rects[i];
    for (let j = i + 1; j < rects.length && rects[j].top < a.bottom; j += 1) {
      const b = rects[j], tall = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      if (a.node === b.node || wide < 2 || tall < 0.4 * Math.min(a.bottom - a.top, b.bottom - b.top)) continue;
      const x = (Math.max(a.left, b.left) + Math.min(a.right, b.right)) / 2, y = Math.max(a.top, b.top) + tall / 2;
      const over = (n) => { const e = n.nodeType === 3 ? n.parentElement : n; return document.elementsFromPoint(x, y).some((p) => p === e || e.contains(p)); };
      const high = document.elementFromPoint(x, y), own = (n) => n.nodeType === 3 ? n.parentElement : n;
      if (high && !over(a.node) && !over(b.node)) continue;
      // a bar that stays over the page, or a dialog over it, hides what is below it
      const floor = (n) => own(n).closest(".q-dialog, .q-menu, .q-tooltip, .q-header, .stage-side");
      if (floor(a.node) !== floor(b.node)) continue;
      say("one on the other", `"${a.text.trim().slice(0, 24)}" and "${b.text.trim().slice(0, 24)}"`);
    }
  }
  for (const e of document.querySelectorAll("div, section, svg, img, canvas, fieldset, table")) {
    const r = e.getBoundingClientRect(), style = getComputedStyle(e);
    const framed = style.borderTopWidth !== "0px" || (style.backgroundColor !== "rgba(0, 0, 0, 0)" && e.parentElement && style.backgroundColor !== getComputedStyle(e.parentElement).backgroundColor);
    if (!framed || r.width * r.height < 6000 || !shown(e) || e.closest("svg, .q-focus-helper, .q-linear-progress")) continue;
    if (e.innerText?.trim() || e.querySelector("svg, img, canvas, input, textarea, button, iframe") || ["svg", "IMG", "CANVAS"].includes(e.tagName)) continue;
    if ([e, ...e.querySelectorAll("*")].some((each) => getComputedStyle(each, "::after").content !== "none")) continue;
    say("an empty box", `${e.tagName}.${e.className}`);
  }
  return [...found];
}
