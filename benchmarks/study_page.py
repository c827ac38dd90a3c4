"""The live page of a study of made-up cases: processor time to make it, Chromium's time to show it.

``python -m benchmarks study_page``; UNDERFOOT_BENCH_CASES (100,000) sets the size of two studies: a
sweep of one case a design, and a robust optimisation of sixteen. Nothing is solved.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path

import numpy as np

from underfoot.explore.plan import StudyPlan
from underfoot.explore.record import CaseJob, Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study import Study
from underfoot.explore.study_file import read_plan
from underfoot.report.live_study import PAGE, write_live_page

from .study_store import OUTPUTS

EXAMPLES = Path(__file__).parents[1] / "examples"
CASES = int(os.environ.get("UNDERFOOT_BENCH_CASES", "100000"))
TEXT = """
name = "Tread of a work shoe"
base = "work_shoe_full_tread_glycerol.toml"
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
"shoe.tread.channel_width" = { from = "2.5 mm", to = "4 mm" }
"shoe.material.shore_a" = { from = 50, to = 70 }
"shoe.tread.pattern" = ["grid", "hexagons"]
"""
SWEEP = """
[outputs]
maximise = ["cof"]
minimise = ["rubber_volume"]
require = ["land > 0.4"]
[method]
budget = %d
"""
ROBUST = """
[uncertain]
"interface.roughness_beyond_cutoff" = { lognormal = 2.0, factor = 1.3 }
[conditions]
contaminant = ["glycerol_90pct", "canola_oil"]
[outputs]
maximise = ["quantile(cof, 0.1) over conditions"]
minimise = ["rubber_volume"]
[method]
kind = "robust"
draws = 8
budget = %d
"""
DRAWS = np.random.default_rng(0).normal(0.0, 0.02, 500)


def jobs(plan: StudyPlan, count: int) -> Iterator[CaseJob]:
    """Yield jobs as a plan sets them, with made-up keys: its own take a case each to hash."""
    number = 0
    for design, point in enumerate(plan.sampled_points(-(-count // plan.cases_per_design))):
        own = plan.design_changes(point)
        for state, draw in product(range(len(plan.states)), range(len(plan.draws))):
            key = f"{number * 2654435761 % 2**96:024x}"
            changes = {**own, **plan.draws[draw], **plan.states[state].changes}
            yield CaseJob(key, design, state, draw, 0, point, changes)
            number += 1


def record(job: CaseJob, number: int) -> Record:
    """Return a made-up end of a case; one in fifty has no numbers."""
    times = {"seconds": 1.4, "cpu_seconds": 1.3, "worker": "node-1", "ended": 1.7e9 + number}
    if number % 50 == 7:
        return Record(job.key, Ending.INFEASIBLE, f"lugs overlap in row {number % 350}", **times)
    x, y, z, _ = job.point
    noise = 0.006 * float(np.sin(997.0 * number))
    cof = 0.15 + 0.1 * x * (1 - x) + 0.04 * y + 0.03 * z + noise - 0.02 * job.condition
    numbers = {
        **OUTPUTS,
        "cof": cof,
        "rubber_volume": 1e-4 * (2 - x + 0.3 * y),
        "land": 0.6 - y / 4,
    }
    units = dict.fromkeys(OUTPUTS, "1")
    errors = {"cof": 0.006, "rubber_volume": 0.0, "land": 0.0}
    spreads = {"cof": 0.02}
    return Record(
        job.key, Ending.COMPUTED, "", numbers, spreads, errors, units, "pair", DRAWS + cof, **times
    )


def made(folder: Path, text: str, count: int, ended: float = 0.9) -> Study:
    """Return a study in a folder with so many cases set, of which a share has ended."""
    plan = read_plan(text % count, EXAMPLES)
    study = Study(plan, folder)
    store = study.store = Store.open_folder(folder)
    store.adopt(plan)
    listed = list(jobs(plan, count))
    store.add_batch(store.jobs(), listed)
    store.begin_round(store.jobs(), ended=False)
    with store.working(2):
        for number, job in enumerate(listed[: int(ended * len(listed))]):
            store.add_record(record(job, number))
    return study


def shown(pages: Sequence[Path]) -> list[float]:
    """Return the seconds until Chromium has drawn each page, from the request on."""
    from playwright.sync_api import sync_playwright

    path = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))))
    frame = "requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now())))"
    drawn = f"new Promise((done) => {frame})"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        tab = browser.new_page(viewport={"width": 1366, "height": 768})
        times = []
        for page in pages:
            tab.goto(page.as_uri())
            times.append(tab.evaluate(drawn) / 1e3)
        browser.close()
    return times


def main() -> None:
    """Print what the page of each study takes."""
    with tempfile.TemporaryDirectory() as place:
        pages, spent = [], []
        for name, text in (("sweep", TEXT + SWEEP), ("robust", TEXT + ROBUST)):
            study = made(Path(place) / name, text, CASES)
            write_live_page(study)  # what it imports
            began = time.process_time()
            write_live_page(study)
            spent.append(time.process_time() - began)
            pages.append(study.store.folder / PAGE)
        for page, cpu, wall in zip(pages, spent, shown(pages), strict=True):
            print(
                f"{page.parent.name}, {CASES} made-up cases: {cpu:.2f} s of CPU to make, "
                f"{page.stat().st_size / 1e3:.0f} kB, {wall:.2f} s until Chromium has drawn it"
            )
