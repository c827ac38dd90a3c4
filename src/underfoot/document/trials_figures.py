"""Figures of an analysis of trials: each reads curves from the results, nothing is computed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .trials_sheet import COLOURS, Tile, contact_sheets
from .trials_study_figures import study_figures

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from underfoot.trials.analyse import FileResult, FolderAnalysis


@dataclass(frozen=True, slots=True)
class TrialFigure:
    """A figure with its file name (without ending), caption and chapter of the report."""

    name: str
    caption: str
    figure: Figure
    chapter: str = "study"


def trial_figures(analysis: FolderAnalysis, *, details: int = 4) -> list[TrialFigure]:
    """Return the figures of an analysis: the study, single trials in detail, contact sheets.

    Parameters
    ----------
    details
        Number of single trials drawn in detail: first those with cautions, then accepted ones.
    """
    figures = [TrialFigure(*made) for made in study_figures(analysis)]
    chosen = _chosen(analysis.files, details)
    for one in chosen:
        figures += _details(one)
    figures += _sheets(analysis)
    return figures


def _chosen(files: Sequence[FileResult], details: int) -> list[FileResult]:
    drawn = [one for one in files if one.curves]
    slips = [one for one in drawn if one.main.get("slip") == 1.0]
    others = [one for one in drawn if one not in slips]
    # A slip first, then one without, then what needs a second look.
    order = [*slips[:1], *others[:1], *(f for f in drawn if f.verdict == "caution"), *drawn]
    unique: dict[str, FileResult] = {}
    for one in order:
        unique.setdefault(one.file, one)
    return list(unique.values())[:details]


def _details(one: FileResult) -> list[TrialFigure]:
    made: list[TrialFigure] = []
    makers: Mapping[str, tuple[Callable[[FileResult], Figure], str]] = {
        "steps": (
            _steps,
            "{file}: force components (unfiltered) and ratio of shear to normal force (filtered), "
            "with the gate and the peak taken as required friction",
        ),
        "heel": (_heel, "{file}: heel speed after contact with both minima and the peak"),
        "track": (
            _track,
            "{file}: heel trajectory over the sensor array, and the pressures in its layout",
        ),
        "slide": (_slide, "{file}: forces and ratio, the averaging window shaded"),
        "run": (_run, "{file}: COF against time, the averaging window shaded"),
        "hold": (_hold, "{file}: force during the hold"),
    }
    for key, (maker, caption) in makers.items():
        if key in one.curves:
            stem = one.file.replace(" ", "_").replace("#", "step_")
            words = caption.format(file=one.file)
            made.append(TrialFigure(f"{stem}_{key}", words, maker(one), "trials"))
    return made


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure with constrained layout."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def plain(axes: Axes) -> None:
    """Take away the frame's upper and right side."""
    axes.spines[["top", "right"]].set_visible(False)


def array(values: Sequence[float | None]) -> np.ndarray:
    """Return a stored curve as floats; gaps are NaN."""
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def _steps(one: FileResult) -> Figure:
    steps = one.curves["steps"]
    figure = new_figure(3.3 * min(len(steps), 3) + 2.2, 4.4)
    grid: Any = figure.subplots(2, min(len(steps), 3), squeeze=False, sharex="col", sharey="row")
    for column, step in enumerate(steps[:3]):
        time = 1e3 * array(step["time"])
        top, low = grid[0][column], grid[1][column]
        top.plot(time, array(step["normal"]), color="0.25", label="normal")
        top.plot(time, array(step["along"]), color="tab:blue", label="along the walk")
        top.plot(time, array(step["across"]), color="tab:orange", label="across")
        top.axhline(0, color="0.8", linewidth=0.8)
        top.set_title(step["step"], fontsize=9)
        ratio = np.where(array(step["normal"]) > 20, array(step["ratio"]), np.nan)
        low.plot(time, ratio, color="tab:green")
        low.axvline(1e3 * step["gate"], color="0.6", linestyle=":", label="gate passed")
        low.plot(
            1e3 * step["peak_time"], step["peak"], "o", color="black", label="required friction"
        )
        low.annotate(
            f"{step['peak']:.3f}",
            (1e3 * step["peak_time"], step["peak"]),
            textcoords="offset points",
            xytext=(6, 4),
            fontsize=9,
        )
        low.set_xlabel("time after contact (ms)")
        low.set_ylim(0, max(0.4, 1.4 * step["peak"]))
        for axes in (top, low):
            plain(axes)
    grid[0][0].set_ylabel("force on the foot (N)")
    grid[1][0].set_ylabel("shear / normal")
    for row in grid:
        row[-1].legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _heel(one: FileResult) -> Figure:
    heel = one.curves["heel"][0]
    figure = new_figure(6.4, 3.0)
    axes = figure.add_subplot()
    time, speed = 1e3 * array(heel["time"]), array(heel["speed"])
    shown = time > -60
    axes.plot(time[shown], speed[shown], color="tab:blue")
    axes.axvline(0, color="0.5", linewidth=0.8)
    axes.axhline(heel["threshold"], color="0.6", linestyle="--", linewidth=0.8)
    axes.annotate(
        f"slip above {heel['threshold']:g} m/s",
        (1, heel["threshold"]),
        xycoords=("axes fraction", "data"),
        ha="right",
        va="bottom",
        fontsize=8,
        color="0.35",
    )
    for key, label, style in (("start", "slip start", "v"), ("end", "end of search", "^")):
        if heel[key] is not None:
            at = 1e3 * heel[key]
            axes.plot(at, np.interp(at, time, speed), style, color="tab:red", label=label)
    if heel["peak"] is not None and heel["peak_time"] is not None:
        label = f"peak {heel['peak']:.2f} m/s"
        axes.plot(1e3 * heel["peak_time"], heel["peak"], "o", color="black", label=label)
    inside = (time > -5) & (time < 1e3 * (heel["end"] or 0.5) + 120)
    top = float(np.nanmax(np.append(speed[inside], heel["threshold"])))
    axes.set_ylim(0, 1.15 * top)
    axes.set_xlabel("time after heel contact (ms)")
    axes.set_ylabel("heel speed (m/s)")
    axes.legend(frameon=False, fontsize=8)
    plain(axes)
    return figure


def _track(one: FileResult) -> Figure:
    track = one.curves["track"][0]
    pulses = track["pulses"]
    figure = new_figure(8.6, 3.9)
    parts: Any = figure.subfigures(1, 2, width_ratios=(1, 1.9))
    left, right = parts
    axes = left.add_subplot()
    across, along = 1e3 * array(track["across"]), 1e3 * array(track["along"])
    # The walker's left is drawn on the left, the walk goes up, as seen from above.
    axes.plot(-across, along, color="tab:blue", linewidth=2, label="heel")
    if len(along):
        axes.plot(-across[0], along[0], "o", color="tab:blue", label="heel contact")
    axes.plot(
        [-1e3 * p["across"] for p in pulses],
        [1e3 * p["along"] for p in pulses],
        "x",
        color="0.2",
        linestyle="none",
        label="sensor",
    )
    axes.set_aspect("equal")
    axes.set_xlim(-70, 70)
    axes.set_xlabel("right of the middle (mm)")
    axes.set_ylabel("along the walk (mm)")
    axes.legend(frameon=False, fontsize=7, loc="upper left")
    plain(axes)
    rows = sorted({round(p["along"], 4) for p in pulses}, reverse=True)
    columns = sorted({round(p["across"], 4) for p in pulses}, reverse=True)
    grid: Any = right.subplots(len(rows), len(columns), squeeze=False, sharex=True, sharey=True)
    for p in pulses:
        cell = grid[rows.index(round(p["along"], 4))][columns.index(round(p["across"], 4))]
        cell.plot(1e3 * array(p["time"]), array(p["kPa"]), color="tab:blue", linewidth=1)
        cell.set_title(p["sensor"], fontsize=7, pad=2)
        cell.tick_params(labelsize=7)
        plain(cell)
    right.supxlabel("time after heel contact (ms)", fontsize=8)
    right.supylabel("fluid pressure (kPa)", fontsize=8)
    return figure


def _slide(one: FileResult) -> Figure:
    slide = one.curves["slide"][0]
    figure = new_figure(6.4, 4.2)
    top, low = figure.subplots(2, 1, sharex=True)
    time = array(slide["time"])
    top.plot(time, array(slide["normal"]), color="0.25", label="normal")
    top.plot(time, array(slide["shear"]), color="tab:blue", label="shear, resultant")
    low.plot(time, array(slide["ratio"]), color="tab:green")
    cof = one.main.get("cof")
    if cof is not None:
        low.set_ylim(0, 2.2 * cof)
        low.plot([slide["begin"], slide["end"]], [cof, cof], color="black", label=f"COF {cof:.3f}")
        low.legend(frameon=False, fontsize=8)
    for axes in (top, low):
        axes.axvspan(slide["begin"], slide["end"], color="tab:blue", alpha=0.12, linewidth=0)
        plain(axes)
    top.set_ylabel("force (N)")
    top.legend(frameon=False, fontsize=8)
    low.set_ylabel("shear / normal")
    low.set_xlabel("time (s)")
    return figure


def _run(one: FileResult) -> Figure:
    run = one.curves["run"][0]
    figure = new_figure(6.4, 2.6)
    axes = figure.add_subplot()
    ratio = array(run["ratio"])
    axes.plot(array(run["time"]), ratio, color="tab:blue", linewidth=0.8)
    axes.axvspan(run["begin"], run["end"], color="tab:blue", alpha=0.12, linewidth=0)
    axes.axhline(run["cof"], color="black", linewidth=1)
    axes.set_ylim(0, 1.15 * float(np.nanmax(ratio)))
    axes.set_xlabel("time (s)")
    axes.set_ylabel("COF")
    plain(axes)
    return figure


def _hold(one: FileResult) -> Figure:
    hold = one.curves["hold"][0]
    figure = new_figure(6.0, 2.8)
    axes = figure.add_subplot()
    time = array(hold["time"])
    axes.semilogx(time[time > 0], array(hold["force"])[time > 0], color="tab:blue")
    axes.axhline(hold["final"], color="0.4", linestyle="--", linewidth=0.9, label="F∞, last tenth")
    axes.set_xlabel("time since the peak (s)")
    axes.set_ylabel("force (N)")
    axes.legend(frameon=False, fontsize=8)
    plain(axes)
    return figure


def _sheets(analysis: FolderAnalysis) -> list[TrialFigure]:
    made: list[TrialFigure] = []
    for key, title, maker in (
        ("steps", "Shear / normal of every step", _step_tiles),
        ("heel", "Heel speed after contact of every trial (m/s)", _heel_tiles),
        ("slide", "Shear / normal of every slide", _slide_tiles),
        ("run", "COF of every run", _run_tiles),
        ("hold", "Force of every hold, share of its start", _hold_tiles),
    ):
        tiles, x_range, y_range, line, words = maker(
            [one for one in analysis.files if key in one.curves]
        )
        empty = [one for one in analysis.files if not one.curves]
        tiles += [
            Tile(one.file, one.verdict, np.empty(0), np.empty(0), remark="refused")
            for one in empty
            if tiles
        ]
        pages = contact_sheets(
            tiles, x_range=x_range, y_range=y_range, title=title, line=line, line_label=words
        )
        for number, page in enumerate(pages, start=1):
            caption = f"Contact sheet, {title[0].lower()}{title[1:]}"
            made.append(TrialFigure(f"sheet_{key}_{number}", caption, page, "sheets"))
    return made


_Sheet = tuple[list[Tile], tuple[float, float], tuple[float, float], float | None, str]


def _step_tiles(files: Sequence[FileResult]) -> _Sheet:
    tiles = []
    for one in files:
        for step in one.curves["steps"]:
            ratio = np.where(array(step["normal"]) > 50, array(step["ratio"]), np.nan)
            tiles.append(
                Tile(
                    one.file,
                    one.verdict,
                    array(step["time"]),
                    ratio,
                    ((step["peak_time"], step["peak"]),),
                    f"{step['peak']:.3f}",
                )
            )
    return tiles, (0.0, 0.8), (0.0, 0.5), None, ""


def _heel_tiles(files: Sequence[FileResult]) -> _Sheet:
    tiles, tops = [], [0.3]
    threshold = 0.2
    for one in files:
        heel = one.curves["heel"][0]
        threshold = heel["threshold"]
        marks = ()
        remark = "not judged"
        if heel["peak"] is not None and heel["peak_time"] is not None:
            marks = ((heel["peak_time"], heel["peak"]),)
            remark = f"{heel['peak']:.2f}"
            tops.append(heel["peak"])
        time, speed = array(heel["time"]), array(heel["speed"])
        until = (heel["end"] or 0.8) + 0.03
        tiles.append(
            Tile(one.file, one.verdict, time[time < until], speed[time < until], marks, remark)
        )
    top = float(np.ceil(10 * max(tops)) / 10)
    return tiles, (0.0, 0.8), (0.0, top), threshold, f"slip above {threshold:g} m/s"


def _slide_tiles(files: Sequence[FileResult]) -> _Sheet:
    tiles, highest, ends = [], 0.05, [0.5]
    for one in files:
        slide = one.curves["slide"][0]
        cof = one.main.get("cof")
        remark = "no COF" if cof is None else f"{cof:.3f}"
        highest = max(highest, cof or 0.0)
        time = array(slide["time"])
        ends.append(float(time[-1]))
        ratio = np.where(array(slide["normal"]) > 50, array(slide["ratio"]), np.nan)
        tiles.append(Tile(one.file, one.verdict, time, ratio, (), remark))
    return tiles, (0.0, max(ends)), (0.0, 2.0 * highest), None, ""


def _run_tiles(files: Sequence[FileResult]) -> _Sheet:
    tiles, highest, ends = [], 0.05, [0.5]
    for one in files:
        run = one.curves["run"][0]
        time = array(run["time"])
        highest = max(highest, run["cof"] or 0.0)
        ends.append(float(time[-1]))
        marks = ((run["begin"], run["cof"]), (run["end"], run["cof"]))
        tiles.append(
            Tile(one.file, one.verdict, time, array(run["ratio"]), marks, f"{run['cof']:.3f}")
        )
    return tiles, (0.0, max(ends)), (0.0, 1.5 * highest), None, ""


def _hold_tiles(files: Sequence[FileResult]) -> _Sheet:
    tiles, ends = [], [1.0]
    for one in files:
        hold = one.curves["hold"][0]
        time, force = array(hold["time"]), array(hold["force"])
        ends.append(float(time[-1]))
        share = hold["final"] / force[0]
        tiles.append(Tile(one.file, one.verdict, time, force / force[0], (), f"{share:.2f}"))
    return tiles, (0.0, max(ends)), (0.0, 1.1), None, ""


__all__ = ["COLOURS", "TrialFigure", "trial_figures"]
