"""What people wait for in the app: the link, pages, a preview of a slider; memory of its processes.

    python -m benchmarks app_times

In headless Chromium with software rendering. On a machine where others compute beside, wall times
say little: processor time of the app and the browser stands beside them.
"""

from __future__ import annotations

import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
SLIDERS = (
    "motion.speed", "contaminant.viscosity", "motion.normal_force", "shoe.material.shore_a",
    "motion.shoe_angle",
)  # fmt: skip
STEPS = 8
ASKED = "Number(document.querySelector('.sliders').dataset.asked || 0)"
WATCH = """(name) => {
  const slider = document.querySelector(`.sliders [name='${name}']`), seen = window.seen = [];
  const live = document.querySelector("[data-live=preview]");
  let began = 0;
  window.step = () => { // moved, not let go: no full run begins
    began = performance.now();
    slider.stepDown(slider.dataset.log ? 5 : 1);
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  };
  new MutationObserver(() => requestAnimationFrame(() => setTimeout(() => {
    seen.push({ began, shown: performance.now() });
  }))).observe(live, { childList: true });
}"""
"""Moves a slider; notes when the frame with its number was drawn."""
LET_GO = """() => document.querySelector(".sliders [name]")
  .dispatchEvent(new Event("change", { bubbles: true }))"""
"""Lets a slider go, which begins a full run."""
PARTS = """() => {
  const { began, shown } = seen.at(-1), asks = (each) => each.name.includes("/api/ask/");
  const asked = performance.getEntriesByType("resource").filter(asks).at(-1);
  const { took } = document.querySelector(".sliders").dataset;
  return { shown: shown - began, answered: asked.responseEnd - began, drawn: Number(took),
    bytes: asked.encodedBodySize };
}"""


def measured() -> tuple[dict[str, str], dict[str, list[dict[str, Any]]]]:
    """Return times and memory by name, and the parts of each step of each slider (ms)."""
    sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "app")]
    from web_app import Cost, begin, drawn, helped, page_of, served

    times: dict[str, str] = {}
    steps: dict[str, list[dict[str, Any]]] = {}
    with ExitStack() as stack:
        page = stack.enter_context(page_of("about:blank"))
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        with Cost() as cost:
            app = stack.enter_context(served(folder / "project", folder))
        times["command to link"] = str(cost)
        with Cost() as cost:
            page.goto(app.link)
            page.get_by_role("heading", name="I design outsoles").wait_for()
        times["link to first page"] = str(cost)
        begin(page, app.base)
        shares = stack.enter_context(app.memory_watched())
        page.get_by_role("button", name="Compute friction").click()
        helped(page)
        with Cost() as cost:
            page.reload()
            drawn(page)
        times["page of a result, drawn"] = str(cost)
        for name in SLIDERS:
            page.reload()  # each slider from the case as it is
            drawn(page)
            page.wait_for_timeout(1000)
            page.evaluate(WATCH, name)
            for number in range(1, STEPS + 1):
                with Cost() as cost:
                    page.evaluate("window.step()")
                    page.wait_for_function(f"seen.length === {number} && {ASKED} >= {number}")
                part = page.evaluate(PARTS)
                steps.setdefault(name, []).append({**part, "cpu": 1e3 * cost.cpu})
        page.evaluate(LET_GO)
        for number in range(STEPS + 1, 2 * STEPS + 1):  # previews beside the full run
            page.evaluate("window.step()")
            page.wait_for_function(f"seen.length >= {number}")
        times["memory of the server"] = f"{app.memory():.0f} MB"
    parts = ", ".join(f"{share:.0f}" for share in shares)
    times["most memory of the app and its processes"] = f"{sum(shares):.0f} MB ({parts})"
    return times, steps


def main() -> None:
    """Print times and memory, then the medians of the parts of a preview."""
    times, steps = measured()
    for name, value in times.items():
        print(f"{name}: {value}")
    for name, parts in steps.items():
        middle = {key: np.median([part[key] for part in parts]) for key in parts[0]}
        print(
            f"{name}: answered after {middle['answered']:.0f} ms ({middle['bytes'] / 1e3:.0f} kB), "
            f"number shown after {middle['shown']:.0f} ms, picture after {middle['drawn']:.0f} ms; "
            f"{middle['cpu']:.0f} ms of CPU"
        )


if __name__ == "__main__":
    main()
