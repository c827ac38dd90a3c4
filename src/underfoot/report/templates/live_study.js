// The page of a study that runs: how old it is, a new one now and then, and what a person chose stays.

addEventListener("DOMContentLoaded", () => {
  const line = document.querySelector("p.live"), refresh = line.querySelector("input"), root = document.querySelector(".study");
  const kept = `underfoot ${location.pathname}`, axes = () => [...document.querySelectorAll(".study select")];
  const before = JSON.parse(sessionStorage.getItem(kept) ?? "{}");
  const told = () => {
    const made = new Date(Number(line.dataset.now)), minutes = Math.floor((Date.now() - made) / 60000);
    line.querySelector("time").textContent = made.toLocaleString() + (minutes > 0 ? ` (${minutes} min ago)` : "");
  };
  axes().forEach((axis, k) => {
    const option = [...axis.options].find((one) => one.text === before.axes?.[k]);
    if (option) { axis.value = option.value; axis.dispatchEvent(new Event("change")); }
  });
  if (before.chosen) root?.querySelector(`circle[data-number="${before.chosen}"]`)?.dispatchEvent(new Event("click"));
  if (refresh && before.refresh === false) refresh.checked = false;
  told();
  setInterval(told, 10000);
  addEventListener("pagehide", () => sessionStorage.setItem(kept, JSON.stringify({
    chosen: root?.dataset.chosen, axes: axes().map((axis) => axis.selectedOptions[0]?.text), refresh: refresh?.checked,
  })));
  if (refresh) setInterval(() => { if (refresh.checked && !document.hidden) location.reload(); }, Number(line.dataset.period));
});
