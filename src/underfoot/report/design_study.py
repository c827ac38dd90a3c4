"""Tables, pictures and the page of a design study, written into its folder."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.case import unit_at
from underfoot.core import Progress, UnderfootError, silent
from underfoot.core.fields import Fields
from underfoot.core.html import data_address, environment, new_figure, png
from underfoot.core.page import PageSection, Picture, remark_sections, table_sections
from underfoot.core.presentation import Table, percent
from underfoot.core.remark import Message, Remark
from underfoot.core.unit_text import display_unit
from underfoot.explore import Study, StudyResult
from underfoot.explore.effects import Effects, effects
from underfoot.explore.goals import AnyGoal, Goal
from underfoot.explore.result import Design
from underfoot.explore.surrogate import Surrogate

from .dispatch import FigureMakers, figures, page_text, sections
from .results import sole_fields
from .viewer import scene_section, viewer_scene, viewer_script
from .writing import Written

if TYPE_CHECKING:
    from jinja2 import Template
    from matplotlib.figure import Figure

MOST_SOLES = 24
"""Designs whose soles a page holds: those of the front, the best or the first."""
SLICE = 60
"""Places along a slice through a surrogate."""


@dataclass(frozen=True)
class ShownStudy(StudyResult):
    """A study's result with what its page needs beside: soles, surrogates and indices.

    ``soles`` has the fields of designs by number; ``missing`` says why there is no surrogate.
    """

    soles: Mapping[int, Fields] = field(default_factory=dict)
    models: Sequence[Surrogate] = ()
    indices: Sequence[Effects] = ()
    missing: str = ""


def shown_study(result: StudyResult, soles: Mapping[int, Fields] | None = None) -> ShownStudy:
    """Return a result with its surrogates and indices, and the soles of some designs."""
    plan = result.plan
    goals: list[AnyGoal] = [*plan.goals] or [Goal("cof", "1")]
    models: list[Surrogate] = []
    indices: list[Effects] = []
    missing = ""
    try:
        if plan.method.kind == "sensitivity":
            indices = [effects(result, goal) for goal in goals]
        if plan.method.kind != "sensitivity" or plan.method.on == "surrogate":
            models = result.surrogates(goals)
    except UnderfootError as error:
        missing = error.message
    own = (plan, result.jobs, result.records, result.sessions)
    return ShownStudy(*own, soles=soles or {}, models=models, indices=indices, missing=missing)


def design_sole(study: Study, result: StudyResult, number: int) -> Fields:
    """Return the maps of a design in its first condition where they are kept, else its sole.

    Raises:
        CaseError: The design can't be built.
    """
    job = next(job for job in result.jobs if job.design == number)
    fields = study.store.maps(job.key)
    return sole_fields(study.plan.base.replace(job.changes)) if fields is None else fields


def _soles(study: Study, result: StudyResult, progress: Progress) -> Mapping[int, Fields]:
    """Return the soles of the best designs that can be built."""
    soles = {}
    chosen = dict.fromkeys(
        design.number for design in (result.front or result.designs)[:MOST_SOLES]
    )
    for count, number in enumerate(chosen, start=1):
        progress("Soles", count / len(chosen))
        with suppress(UnderfootError):
            soles[number] = design_sole(study, result, number)
    return soles


def write_study_report(
    study: Study, result: StudyResult, *, progress: Progress = silent
) -> Written:
    """Write results.csv, results.parquet, surrogate.json and report.html into a study's folder."""
    study.store.write_views(result.cases())
    ready = shown_study(result, _soles(study, result, progress))
    if ready.models:
        models = [model.to_dict() for model in ready.models]
        with study.store.view("surrogate.json") as part:
            part.write_text(json.dumps(models) + "\n", encoding="utf-8")
    path = study.store.folder / "report.html"
    drawn = {name: png(make()) for name, make in figures(ready).items()}
    with study.store.view(path.name) as part:
        part.write_text(page_text(ready, drawn), encoding="utf-8")
    return Written(study.store.folder, path)


@figures.register(StudyResult)
def _study_figures(result: StudyResult) -> FigureMakers:
    """Return slices through the surrogates and bars of the indices, where there are any."""
    makers: FigureMakers = {}
    if isinstance(result, ShownStudy):
        makers |= {
            f"effects_{k}": partial(effects_figure, index) for k, index in enumerate(result.indices)
        }
        if result.models and result.usable:
            makers["slices"] = partial(slices_figure, result.models, _centre(result))
    if len(result.plan.goals) > 1 and result.front:
        makers["front"] = partial(front_figure, result)
    return makers


@sections.register(StudyResult)
def _study_sections(
    result: StudyResult, pictures: dict[str, bytes]
) -> tuple[Sequence[PageSection], str]:
    designs = result.shown or result.designs
    parts = [PageSection("Designs", html=explorer(result, designs)), *table_sections(result)]
    best = result.best(8)
    if len(best) > 1:
        rows = [
            (
                Message("Design {first} above design {second}", first=a.number, second=b.number),
                _chance(result.higher_cof(a, b)),
            )
            for a, b in pairwise(best)
        ]
        intro = "Over shared draws: what both designs have in common cancels."
        parts.append(
            PageSection(
                "How sure the order by COF is", intro, table=Table("", ("", "Probability"), rows)
            )
        )
    if isinstance(result, ShownStudy):
        for k, index in enumerate(result.indices):
            picture = Picture(index.heading(), data_address(pictures[f"effects_{k}"]), True)
            parts.append(
                PageSection(index.heading(), " ".join(index.headline()), pictures=[picture])
            )
            parts.append(PageSection(f"{index.output}: indices", table=index.table(), folded=True))
        if result.models:
            picture = Picture(
                "Slices through the surrogates", data_address(pictures["slices"]), True
            )
            words = [Remark.of(model.name, model.reliability) for model in result.models]
            intro = (
                "Through the marked design; the band is one standard deviation of the surrogate."
            )
            parts.append(PageSection("Slices", intro, pictures=[picture]))
            parts.append(PageSection("Error of the surrogates", items=words))
        elif result.missing:
            parts.append(PageSection("Surrogates", result.missing))
    parts += remark_sections(result)
    parts.append(PageSection("Study file (TOML)", text=result.plan.text, folded=True))
    kept = [p for p in parts if p.html or p.pictures or p.table or p.items or p.text or p.intro]
    return kept, viewer_script(template("design_study.js").render())


def explorer(result: StudyResult, designs: Sequence[Design]) -> str:
    """Return the plots of all designs, with the soles that a click shows."""
    plan = result.plan
    paths = [dimension.path for dimension in plan.dimensions]
    allowed, front = result.meets_requirements(designs), {design.number for design in result.front}
    columns: list[dict[str, Any]] = []
    rows: list[list[Any]] = [[] for _ in designs]

    def add(name: str, unit: str, values: Sequence[Any], goal: bool) -> None:
        numbers = [v for v in values if isinstance(v, float) and np.isfinite(v)]
        factor, shown_unit = display_unit(max(map(abs, numbers), default=1.0), unit)
        columns.append(
            {
                "name": name,
                "unit": ""
                if shown_unit == "1"
                else shown_unit.replace("^2", "²").replace("^3", "³"),
                "goal": goal,
            }
        )
        for row, value in zip(rows, values, strict=True):
            number = isinstance(value, float)
            row.append((value / factor if np.isfinite(value) else None) if number else value)

    for path in paths:
        values = [design.changes.get(path) for design in designs]
        add(path.split(".", 1)[-1].replace("_", " "), unit_at(path), values, False)
    for goal, values in zip(
        plan.shown_goals,
        result.goal_estimates(designs, plan.shown_goals)[0].T.tolist(),
        strict=True,
    ):
        add(goal.phrase, goal.unit, values, goal in plan.goals)
    listed = [
        {
            "number": design.number,
            "values": row,
            "allowed": bool(ok),
            "front": design.number in front,
            "reason": design.reason,
        }
        for design, row, ok in zip(designs, rows, allowed, strict=True)
    ]
    data = json.dumps({"columns": columns, "designs": listed}, allow_nan=False)
    soles = {}
    if isinstance(result, ShownStudy):
        for number, fields in result.soles.items():
            sole: Any = SimpleNamespace(name=f"design {number}", data=fields)
            soles[number] = scene_section(viewer_scene([sole]))
    return template("design_study.html").render(data=data.replace("<", "\\u003c"), soles=soles)


def template(name: str) -> Template:
    """Return a template of this package."""
    return environment(__package__ or "").get_template(name)


def front_figure(result: StudyResult) -> Figure:
    """Return the first two goals of every design, the front joined by a line."""
    goals, designs = result.plan.goals[:2], result.shown
    values, front = (
        result.goal_estimates(each, result.plan.goals)[0] for each in (designs, result.front)
    )
    figure = new_figure(6.5, 4.2)
    axes = figure.add_subplot()
    allowed = result.meets_requirements(designs)
    axes.plot(*values[~allowed, :2].T, "o", mfc="none", color="0.6", label="not allowed")
    axes.plot(*values[allowed, :2].T, "o", color="0.6", label="designs")
    axes.plot(*front[:, :2].T, "o-", color="#0b6fa4", label="front")
    axes.set(xlabel=_axis(goals[0]), ylabel=_axis(goals[1]))
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def slices_figure(models: Sequence[Surrogate], centre: np.ndarray) -> Figure:
    """Return each surrogate along each input, the others as at ``centre`` of the unit cube."""
    dimensions = models[0].dimensions
    figure = new_figure(2.6 * len(dimensions) + 0.6, 2.2 * len(models) + 0.4)
    grid = figure.subplots(len(models), len(dimensions), squeeze=False, sharey="row")
    shares = np.linspace(0.0, 1.0, SLICE)
    for row, model in zip(grid, models, strict=True):
        scale, shown_unit = display_unit(float(np.abs(model.runs.values).max()), model.unit)
        for axes, dimension, k in zip(row, dimensions, range(len(dimensions)), strict=True):
            points = np.tile(centre, (SLICE, 1))
            points[:, k] = shares
            mean, deviation = model.prediction(points)
            values = [dimension.value(float(share)) for share in shares]
            numeric = all(isinstance(value, float) for value in values)
            unit = unit_at(dimension.path)
            factor, name = display_unit(float(values[-1]), unit) if numeric else (1.0, "1")
            places: Any = np.array(values) / factor if numeric else list(map(str, values))
            low, middle, high = (mean + k * deviation for k in (-1, 0, 1))
            axes.plot(places, middle / scale, color="#0b6fa4")
            axes.fill_between(places, low / scale, high / scale, color="#0b6fa4", alpha=0.2)
            axes.axvline(places[int(centre[k] * (SLICE - 1))], color="0.7", linewidth=0.8)
            short = dimension.path.split(".")[-1].replace("_", " ")
            axes.set_xlabel(short + (f" ({name})" if name != "1" else ""), fontsize=8)
            axes.tick_params(labelsize=7)
        named = model.name + (f" ({shown_unit})" if shown_unit != "1" else "")
        row[0].set_ylabel(f"{named}\nQ2 {model.q2:.3f}", fontsize=8)
    return figure


def effects_figure(effects: Effects) -> Figure:
    """Return both indices of every input as bars with their 95 % intervals."""
    order = np.argsort(effects.total)
    figure = new_figure(7.0, 0.5 * len(order) + 1.2)
    axes = figure.add_subplot()
    at = np.arange(len(order))
    for shift, values, half, name, colour in (
        (0.2, effects.total, effects.total_half, effects.heads[1], "#0b6fa4"),
        (-0.2, effects.main, effects.main_half, effects.heads[0], "#9cc8e0"),
    ):
        axes.barh(at + shift, values[order], 0.36, xerr=half[order], label=name, color=colour)
    axes.set_yticks(at, [effects.paths[k] for k in order], fontsize=8)
    axes.set_xlabel(
        "share of the variance" if effects.analysis == "sobol" else f"effect ({effects.unit})"
    )
    axes.set_xlim(left=0)
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def _axis(goal: Any) -> str:
    return goal.phrase if goal.unit == "1" else f"{goal.phrase} ({goal.unit})"


def _centre(result: StudyResult) -> np.ndarray:
    """Return the place of the best design, or of the first that has numbers."""
    usable = [design for design in result.designs if design.usable]
    return np.array((result.best(1) or usable)[0].point)


def _chance(probability: float | None) -> str:
    return "not estimated" if probability is None else percent(probability)
