"""Figures and pages of results, comparisons and cases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.case import Case
from underfoot.compute.result import Result
from underfoot.compute.sole import drawn_file, drawn_map, sole_shape
from underfoot.core import UnderfootError, content_hash
from underfoot.core.fields import Fields, labelled_fields
from underfoot.core.html import data_address, new_figure
from underfoot.core.page import PageSection, Picture, page, remark_sections, table_sections
from underfoot.core.presentation import Table
from underfoot.core.remark import Message, together
from underfoot.questions.comparison import Comparison
from underfoot.questions.risk import RiskAssessment
from underfoot.shoe import SoleMap

from .chart import line_chart
from .dispatch import FigureMakers, figures, files, plot, sections, write_report, write_shown
from .maps import comparison_figure, draw_map, grid_note, map_figure, overview_figure
from .quantities import quantities
from .surface_mesh import SurfaceMesh, surface_mesh
from .viewer import scene_section, viewer_scene, viewer_script
from .writing import Writer, Written, data_writers

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DESIGNED = 0.3e-3
"""m: side of the cells through which the designed surface is drawn."""
SURFACES_KEPT = 6
_surfaces: dict[str, SurfaceMesh] = {}
SEEN = "Seen through the floor: the heel's back edge is at the bottom, walking direction up."


@figures.register(Result)
def _result_figures(result: Result) -> FigureMakers:
    """Return the overview, a map for each quantity on the sole, and the history of the load."""
    makers: FigureMakers = {"maps": partial(overview_figure, result.data)}
    for quantity in quantities([result.data]):
        makers[quantity.name] = partial(map_figure, result.data, quantity)
    if "time" in result.data.sizes:
        makers["history"] = partial(history_figure, result)
    return makers


@files.register(Result)
def _result_files(result: Result) -> dict[str, Writer]:
    return dict(result.writers())


@sections.register(Result)
def _result_sections(
    result: Result, pictures: dict[str, bytes], advice: RiskAssessment | None = None
) -> tuple[Sequence[PageSection], str]:
    warning = "" if result.usable else "The computation did not converge: for diagnosis only."
    if "cof_tread_position" in result.scalars:
        warning = "The tread lies as the case describes it; the numbers are means over positions."
    parts = [PageSection("Under the sole", warning, html=_viewer([result]), stage=True)]
    if advice is not None:
        caption = "This result, moved by what each change does on the coarse grid."
        parts.append(PageSection(advice.table().title, caption, table=advice.table()))
    parts += table_sections(result)
    titles = {quantity.name: quantity.title for quantity in quantities([result.data])}
    maps = [
        Picture(
            Message("Map of {title} on the sole", title=titles[name].lower()), data_address(data)
        )
        for name, data in pictures.items()
        if name in titles
    ]
    if maps:
        parts.append(PageSection("Maps", SEEN, pictures=maps))
    if "time" in result.data.sizes:
        parts.append(PageSection("Over time", html=history_chart(result)))
    provenance = result.provenance
    models = Table("", ("", ""), list(provenance.closures.items()))
    versions = ", ".join(f"{name} {version}" for name, version in provenance.versions.items())
    made = Message(
        "Case {case_hash}, computed {created} with {versions}.",
        case_hash=provenance.case_hash[:16],
        created=provenance.created,
        versions=versions,
    )
    parts += [
        *remark_sections(result),
        PageSection("Models", made, table=models),
        PageSection("Sources", items=provenance.citations),
        PageSection("Corrections to printed values", items=provenance.errata),
        PageSection("Complete case (TOML)", text=result.case_text),
    ]
    filled = [p for p in parts if p.html or p.pictures or p.table or p.items or p.text]
    return filled, viewer_script()


@write_report.register(Result)
def _write_result(
    result: Result,
    folder: Path | str,
    *,
    overwrite: bool = False,
    advice: RiskAssessment | None = None,
    maps: bool = False,
) -> Written:
    """Write case.toml, result.json, summary.csv, result.nc and report.html.

    ``advice`` adds risk.json, changes.csv and the most effective changes to the page; ``maps`` a
    PNG of each quantity and of the load over time, beside the page and on it.
    """

    def text(drawn: dict[str, bytes]) -> str:
        parts, script = _result_sections(result, drawn, advice)
        return page(result, parts, script=script, verdict=result.verdict())

    data = files(result) | ({} if advice is None else data_writers(advice))
    drawn = None if maps else {}
    return write_shown(result, folder, data, text, makers=drawn, overwrite=overwrite)


@figures.register(Comparison)
def _comparison_figures(comparison: Comparison) -> FigureMakers:
    if not comparison.usable:
        return {}
    datasets = [result.data for result in comparison.results]
    return {q.name: partial(comparison_figure, datasets, q) for q in quantities(datasets)}


@sections.register(Comparison)
def _comparison_sections(
    comparison: Comparison, pictures: dict[str, bytes]
) -> tuple[Sequence[PageSection], str]:
    results = comparison.results
    ranking = table_sections(comparison)
    parts = []
    if comparison.usable:
        datasets = [result.data for result in results]
        note, titles = grid_note(datasets), {q.name: q.title for q in quantities(datasets)}
        scale = together(["One colour scale for all; red is more than A, blue less.", note, SEEN])
        parts = [
            PageSection("Under the soles", html=_viewer(results), stage=True),
            replace(ranking[0], first=True),
            *ranking[1:],
            PageSection("Maps and differences", scale),
            *(
                PageSection(
                    titles[name], pictures=[Picture(titles[name], data_address(data), True)]
                )
                for name, data in pictures.items()
            ),
        ]
    sources = [
        f"{letter}: {result.name}, case {result.provenance.case_hash[:16]}, computed "
        f"{result.provenance.created}"
        for letter, result in zip(comparison.letters, results, strict=True)
    ]
    parts.append(PageSection("Results compared", items=sources))
    return parts, viewer_script() if comparison.usable else ""


def _viewer(results: Sequence[Result]) -> str:
    surfaces = [surface_of_result(result) for result in results]
    return scene_section(viewer_scene(results, surfaces))


def surface_of_result(result: Result) -> SurfaceMesh | None:
    """Return the sole of a result as it was designed; None where its file is not there any more."""
    try:
        return designed_surface(Case.from_text(result.case_text))
    except UnderfootError:
        return None


def designed_surface(case: Case, spacing: float = DESIGNED) -> SurfaceMesh:
    """Return the sole of a case over the floor, its lugs as they are drawn, not as they are solved.

    Made from cells of ``spacing`` (m). The last few are kept in the process.

    Raises:
        InputError, DataError: The sole of the case can't be made: its file is not there.
    """
    shape = case.shoe.outsole or sole_shape(case)
    key = content_hash(shape, case.shoe.wear, case.motion.shoe_angle, spacing)
    if key not in _surfaces:
        if case.shoe.outsole is None:
            sole = drawn_map(case, spacing)
            told: dict[str, Any] = {"cut": (sole.whole or sole).cut}
        else:
            sole, (lugs, sides) = drawn_file(case, spacing)
            told = {"edges": lugs, "rim": sides, "reach": 2.0 * case.shoe.outsole.map_spacing}
        sole = sole.whole or sole
        height = np.where(sole.inside, sole.clearance, np.nan)
        while len(_surfaces) >= SURFACES_KEPT:
            del _surfaces[next(iter(_surfaces))]
        _surfaces[key] = surface_mesh(sole.x, sole.y, height, sole.land, **told)
    return _surfaces[key]


def sole_fields(case: Case, spacing: float | None = None) -> Fields:
    """Return the height of a case's sole above the floor, on the coarse grid or one of its own."""
    return map_fields(drawn_map(case, spacing or case.numerics.quick_grid_spacing))


def map_fields(sole: SoleMap) -> Fields:
    """Return the height of a sole above the floor with its rim and its land."""
    labels = {"units": "m", "long_name": "height of the undeformed sole"}
    return labelled_fields(
        {
            "clearance": (("x", "y"), sole.clearance, labels),
            "inside": (("x", "y"), sole.inside),
            "land": (("x", "y"), sole.land),
            "outline_x": ("outline", sole.outline[:, 0]),
            "outline_y": ("outline", sole.outline[:, 1]),
        },
        {"x": ("x", sole.x), "y": ("y", sole.y)},
    )


@plot.register(Case)
def _plot_case(case: Case) -> Figure:
    """Return the height of a case's sole above the floor, on the coarse grid."""
    fields = sole_fields(case)
    figure = new_figure(9.0, 6.0)
    left, right = figure.subplots(1, 2, width_ratios=[1.0, 1.3])
    draw_map(left, fields, quantities([fields])[0])
    lines = case.summary().splitlines()
    right.text(0.0, 1.0, "\n".join(line[:64] for line in lines[:42]), va="top", fontsize=6)
    right.set_axis_off()
    figure.suptitle(case.name)
    return figure


_LOADS = (("load_history", "applied load"), ("fluid_load_history", "carried by the fluid"))
_THROUGH_A_MOTION = {
    "cof_history": ("coefficient of friction", 1.0),
    "contact_area_history": ("contact area (cm²)", 1e4),
    "centre_of_pressure_history": ("centre of pressure (mm)", 1e3),
}
_TIME = "time after first contact with the film (ms)"


def history_chart(result: Result) -> str:
    """Return load and its share on the film over time, of a history friction and place too, SVG."""
    data = result.data
    lines = [(label, data[name].values) for name, label in _LOADS if name in data]
    time = data["time"].values * 1e3
    charts = [line_chart(time, lines, _TIME, "load (N)")]
    if "picture_time" in data.sizes:
        charts += [
            line_chart(time, [(label, factor * data[name].values)], _TIME, label)
            for name, (label, factor) in _THROUGH_A_MOTION.items()
            if name in data
        ]
    return "".join(charts)


def history_figure(result: Result) -> Figure:
    """Return how the load is shared between fluid and contact over time."""
    fields = result.data
    figure = new_figure(7.5, 2.8)
    axes = figure.add_subplot()
    time = fields["time"].values * 1e3
    styles: tuple[dict[str, Any], ...] = (
        {"color": "0.3", "linestyle": "--"},
        {"color": "tab:blue"},
    )
    for (name, label), style in zip(_LOADS, styles, strict=True):
        if name in fields:
            axes.plot(time, fields[name].values, label=label, **style)
    axes.set(xlabel=_TIME, ylabel="load (N)")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    return figure
