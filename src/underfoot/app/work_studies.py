"""What the pages of design studies and comparisons ask the computing processes."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from underfoot.case import text as toml
from underfoot.compute.result import Result
from underfoot.core import Progress
from underfoot.core.html import png
from underfoot.core.page import PageSection, page_part
from underfoot.core.pool import available_processors
from underfoot.core.presentation import percent
from underfoot.explore import Study
from underfoot.explore.check import study_check
from underfoot.explore.status import study_status
from underfoot.explore.study_file import flat_paths
from underfoot.questions.comparison import chance_higher
from underfoot.report.design_study import design_sole, shown_study, write_study_report
from underfoot.report.dispatch import figures, sections
from underfoot.report.live_study import live_sections, live_study, with_live_page
from underfoot.report.results import designed_surface, surface_of_result
from underfoot.report.sole_export import export_result
from underfoot.report.viewer import scene_section, viewer_scene

from .text import put_language
from .work import Drawn, compared, presented

TRIED = 12
"""Cases that are built while a study file is changed, to see which can't be."""


def form(text: str, *, progress: Progress) -> dict[str, Any]:
    """Return the sections of a study file with flat paths."""
    plain = toml.parse_toml(text)
    return {k: dict(flat_paths(v)) if isinstance(v, Mapping) else v for k, v in plain.items()}


def state(file: str, folder: str, seen: int | None = None, *, progress: Progress) -> dict[str, Any]:
    """Return what a study will take, or how far it is where it was begun as the file is now.

    With the number of cases that are ``seen`` already: ``parts`` of its live page where more have
    ended, and the processor time that this took (``seconds``).
    """
    began = time.process_time()
    study = Study.load(file, folder)
    store, plan = study.store, study.plan
    ended = len(store.records()) if store.exists else 0
    known = store.exists and store.jobs() and store.plan().text == plan.text
    status = study_status(study) if known else None
    if status is None or not (ended or status.working):
        return {**presented(study_check(plan, TRIED)), "ended": ended, "begun": False, "open": True}
    budget = None if plan.method.design in ("grid", "lhs") else plan.method.budget
    so_far = {"ended": ended, "begun": True, "open": status.cases_left > 0, "budget": budget}
    sheet = {**presented(status), **so_far, "working": status.working}
    if seen not in (None, ended):
        sheet["parts"] = results(file, folder, False, progress=progress)
    return {**sheet, "seconds": time.process_time() - began}


def computed(file: str, folder: str, *, progress: Progress) -> None:
    """Compute what is not finished of a study, as ``underfoot study run`` does."""
    study, workers = Study.load(file, folder), available_processors()
    with with_live_page(study, progress, workers) as told:
        result = study.run(workers=workers, progress=told)
    put_language(write_study_report(study, result).page)


def results(file: str, folder: str, whole: bool = True, *, progress: Progress) -> list[str]:
    """Return what is finished of a study as parts of a page: the plots, and all that follows.

    While it runs (not ``whole``) that of its live page.
    """
    study = Study.load(file, folder)
    if whole:
        ready = shown_study(study.result())
        pictures = {name: png(make()) for name, make in figures(ready).items()}
        plots, *rest = sections(ready, pictures)[0]
        return [page_part([plots]), page_part(rest)]
    live = live_study(study)
    plots, *rest = live_sections(live)
    cost = PageSection("Cost", table=live.cost_table())
    plots = replace(plots, intro=" ".join((*live.cautions()[:1], plots.intro)))
    return [page_part([cost, plots]), page_part(rest)]


def stop(file: str, folder: str, *, progress: Progress) -> None:
    """Ask all who work on a study to stop, as ``underfoot study stop`` does."""
    Study.load(file, folder).store.stop()


def design(file: str, folder: str, number: int, *, progress: Progress) -> dict[str, str]:
    """Return a design of a study: its sole as a part of a page and its case file."""
    study = Study.load(file, folder)
    result, name = study.result(), f"{study.plan.name}, design {number}"
    job = next(job for job in result.jobs if job.design == number)
    case = study.plan.base.replace({**job.changes, "name": name})
    sole = Drawn(name, design_sole(study, result, number))
    drawn = scene_section(viewer_scene([sole], [designed_surface(case)]))
    return {"case": case.to_toml(), "html": drawn}


def comparison(folders: Sequence[str], *, progress: Progress) -> dict[str, Any]:
    """Return stored results side by side: words, every pair, and the page's part."""
    found, words = compared(folders, separate=False, progress=progress)
    chances = [[_chance(one, other) for other in found.results] for one in found.results]
    surfaces = [surface_of_result(result) for result in found.results]
    html = scene_section(viewer_scene(found.results, surfaces))
    return {**words, "letters": list(found.letters), "chances": chances, "html": html}


def exported(folder: str, file: str, *, progress: Progress) -> str:
    """Write the sole of a stored result for other programs; return what was written."""
    return export_result(Result.load(folder), Path(file)).sentence()


def _chance(result: Result, other: Result) -> str:
    chance = None if result is other else chance_higher(result, other)
    return "" if chance is None else percent(chance)
