"""Figures of an analysis of trials: each reads curves from the results, nothing is computed."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .trials_sheet import Tile, contact_sheets

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
            stem = re.sub(r"[^\w.-]+", "_", one.file.replace("#", "step_"))
            words = caption.format(file=one.file)
            figure = maker(one)
            figure.suptitle(one.file, fontsize=9, color="0.35", x=0.01, ha="left")
            made.append(TrialFigure(f"{stem}_{key}", words, figure, "trials"))
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
    axes.legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
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
    axes.legend(
        frameon=False,
        fontsize=7,
        loc="lower center",
        bbox_to_anchor=(0.5, 1.0),
        ncols=3,
        handletextpad=0.3,
        columnspacing=0.8,
    )
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
        low.legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    for axes in (top, low):
        axes.axvspan(slide["begin"], slide["end"], color="tab:blue", alpha=0.12, linewidth=0)
        plain(axes)
    top.set_ylabel("force (N)")
    top.legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
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
            [
                one
                for one in analysis.files
                if key in one.curves or (key == "steps" and "rejected" in one.curves)
            ]
        )
        empty = [one for one in analysis.files if not one.curves]
        tiles += [
            Tile(one.file, one.verdict, np.empty(0), np.empty(0), reason="; ".join(one.reasons))
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
    """Every contact in the order of the steps, rejected ones with their reason."""
    tiles = []
    for one in files:
        for step in one.curves.get("steps", []):
            ratio = np.where(array(step["normal"]) > 50, array(step["ratio"]), np.nan)
            mark = ((step["peak_time"], step["peak"]),)
            label, verdict = f"{one.file}, {step['step']}", step.get("verdict", one.verdict)
            time = array(step["time"])
            tiles.append(Tile(label, verdict, time, ratio, mark, f"{step['peak']:.3f}"))
        for step in one.curves.get("rejected", []):
            ratio = np.where(array(step["normal"]) > 50, array(step["ratio"]), np.nan)
            label = f"{one.file}, {step['step']}"
            time = array(step["time"])
            tiles.append(Tile(label, "rejected", time, ratio, reason=step["reason"]))
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


_NAMES = {
    "acof": "available friction, ACOF",
    "rcof": "required friction, RCOF",
    "acof_minus_rcof": "ACOF − RCOF",
    "cof": "COF",
    "peak_slipping_speed": "peak slipping speed (m/s)",
    "peak_force": "peak force (N)",
    "cof_bl": "COF_BL",
    "tau_hydro": "tau_hydro (m/s)",
    "cof_asymptote": "COF_asymptote",
}


def study_figures(analysis: FolderAnalysis) -> list[tuple[str, str, Figure]]:
    """Return (name, caption, figure) of what the folder says as a whole."""
    curves = analysis.study.curves
    made: list[tuple[str, str, Figure]] = []
    if curves.get("risk"):
        words = (
            "Slip outcomes (points, spread a little for the eye) and curves with 95 % bands: "
            + "; ".join(dict.fromkeys(one["method"] for one in curves["risk"]))
        )
        made.append(("risk", words, _risk(curves["risk"])))
    if curves.get("maps"):
        words = "Fluid pressure under the shoe; white lines are the scans, the cross is the peak"
        made.append(("maps", words, _maps(curves["maps"])))
    if curves.get("fits"):
        words = "COF against sliding speed with the fit of Eq. 17, and its residuals"
        made.append(("stribeck", words, _fits(curves["fits"])))
    if curves.get("master"):
        words = "All COF against viscosity × speed, and one falling curve through them"
        made.append(("master_curve", words, _master(curves["master"])))
    if curves.get("line"):
        words = "Peak slipping speed against the largest pressure of a trial"
        made.append(("speed_pressure", words, _line(curves["line"])))
    if curves.get("alpha_beta"):
        words = "Adhesion with a fluid against dry adhesion, lines of Eq. 26"
        made.append(("alpha_beta", words, _alpha_beta(curves["alpha_beta"])))
    made += _groups(analysis)
    return made


def _risk(risk: Sequence[dict[str, Any]]) -> Figure:
    figure = new_figure(3.4 * len(risk), 3.1)
    grid: Any = figure.subplots(1, len(risk), squeeze=False, sharey=True)
    for axes, one in zip(grid[0], risk, strict=True):
        axes.fill_between(one["grid"], one["low"], one["high"], color="tab:blue", alpha=0.18, lw=0)
        axes.plot(one["grid"], one["risk"], color="tab:blue")
        y = np.array(one["y"], dtype=float)
        # A fixed pattern instead of random numbers: the same folder gives the same picture.
        shift = 0.035 * ((np.arange(len(y)) * 0.618034) % 1.0)
        axes.plot(
            one["x"], np.where(y > 0.5, y + shift, y - shift), "o", ms=3.5, color="0.2", alpha=0.6
        )
        axes.set_xlabel(_NAMES.get(one["name"], one["name"]))
        slope = f"slope {one['slope']:.1f}"
        inside = one["grid"][0] < one["half"] < one["grid"][-1]
        axes.set_title(slope + (f", 50 % at {one['half']:.3f}" if inside else ""), fontsize=9)
        axes.set_ylim(-0.06, 1.06)
        axes.locator_params(axis="x", nbins=5)
        plain(axes)
    grid[0][0].set_ylabel("slip (1) or not (0), risk")
    return figure


def _maps(maps: Sequence[dict[str, Any]]) -> Figure:
    figure = new_figure(3.3 * len(maps) + 0.6, 4.6)
    grid: Any = figure.subplots(1, len(maps), squeeze=False, sharey=True)
    top = max(1e-3 * float(np.max(one["pressure"])) for one in maps)
    image = None
    for axes, one in zip(grid[0], maps, strict=True):
        lateral, along = 1e3 * np.array(one["lateral"]), 1e3 * np.array(one["along"])
        pressure = 1e-3 * np.array(one["pressure"])
        # Each scan stands for the strip around it: no smoothing between scans.
        image = axes.pcolormesh(
            -lateral,
            along,
            pressure.T,
            cmap="viridis",
            vmin=0,
            vmax=top,
            shading="nearest",
            rasterized=True,
        )
        for x in -lateral:
            axes.axvline(x, color="white", linewidth=0.4, alpha=0.6)
        axes.plot(-1e3 * one["peak_lateral"], 1e3 * one["peak_along"], "+", color="red", ms=9)
        words = f"{one['load']:.3g} N, peak {1e-3 * one['peak']:.3g} kPa"
        axes.set_title(f"{one['label']}\n{words}", fontsize=9)
        axes.set_aspect("equal")
        axes.locator_params(axis="x", nbins=3)
        axes.set_xlabel("right of heel's middle (mm)")
    grid[0][0].set_ylabel("forward of the heel's back (mm)")
    if image is not None:
        figure.colorbar(image, ax=grid[0].tolist(), label="fluid pressure (kPa)", shrink=0.8)
    return figure


def _fits(fits: Sequence[dict[str, Any]]) -> Figure:
    groups = list(dict.fromkeys(one["group"] for one in fits))
    across = min(3, len(groups))
    down = -(-len(groups) // across)
    figure = new_figure(3.3 * across, 3.3 * down)
    outer: Any = figure.subfigures(down, across, squeeze=False)
    highest = max(max(one["cof"]) for one in fits)
    for i, group in enumerate(groups):
        inner: Any = outer[i // across][i % across].subplots(
            2, 1, sharex=True, height_ratios=(2.6, 1)
        )
        for number, one in enumerate(f for f in fits if f["group"] == group):
            colour = f"C{number % 10}"
            speed, cof = np.array(one["speed"]), np.array(one["cof"])
            grid = np.linspace(0, 1.02 * speed.max(), 120)
            inner[0].plot(grid, _curve(one, grid), color=colour, linewidth=0.9)
            inner[0].plot(speed, cof, "o", ms=2.6, color=colour)
            inner[1].plot(speed, cof - _curve(one, speed), "o", ms=2.2, color=colour)
        verdicts = [f["verdict"] for f in fits if f["group"] == group]
        words = ", ".join(f"{verdicts.count(v)} {v}" for v in dict.fromkeys(verdicts))
        inner[0].set_title(f"{group or 'all files'} ({words})", fontsize=9)
        inner[0].set_ylim(0, 1.1 * highest)
        inner[1].axhline(0, color="0.7", linewidth=0.8)
        inner[1].set_xlabel("sliding speed (m/s)", fontsize=8)
        if i % across == 0:
            inner[0].set_ylabel("COF", fontsize=8)
            inner[1].set_ylabel("residual", fontsize=8)
        for axes in inner:
            axes.tick_params(labelsize=7)
            plain(axes)
    return figure


def _curve(one: dict[str, Any], speed: np.ndarray) -> np.ndarray:
    if one["verdict"] == "mean":
        return np.full(len(speed), one["mean"])
    boundary, tau, asymptote = one["raw"]
    return asymptote + (boundary - asymptote) * np.exp(-speed / tau)


def _master(master: dict[str, Any]) -> Figure:
    figure = new_figure(6.2, 3.6)
    axes = figure.add_subplot()
    product, cof = np.array(master["product"]), np.array(master["cof"])
    labels = np.array(master["label"])
    for number, label in enumerate(dict.fromkeys(master["label"])):
        mine = labels == label
        axes.semilogx(product[mine], cof[mine], "o", ms=3, color=f"C{number % 10}", label=label)
    axes.semilogx(master["grid"], master["fitted"], color="black", linewidth=1.2, label="one curve")
    axes.set_xlabel("viscosity × speed (N/m)")
    axes.set_ylabel("COF")
    axes.set_ylim(bottom=0)
    words = f"R² {master['r_squared']:.3f}, residual sd {master['residual_sd']:.3f}"
    axes.set_title(words, fontsize=9)
    axes.legend(frameon=False, fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    plain(axes)
    return figure


def _line(line: dict[str, Any]) -> Figure:
    figure = new_figure(4.4, 3.2)
    axes = figure.add_subplot()
    x = np.array(line["x"])
    axes.plot(x, line["y"], "o", ms=4, color="0.2")
    ends = np.array([0.0, 1.05 * x.max()])
    axes.plot(ends, line["intercept"] + line["slope"] * ends, color="tab:blue")
    axes.set_xlabel("peak pressure (kPa)")
    axes.set_ylabel("peak slipping speed (m/s)")
    axes.set_ylim(bottom=0)
    axes.set_title(f"r = {line['r']:.2f}", fontsize=9)
    plain(axes)
    return figure


def _alpha_beta(found: dict[str, Any]) -> Figure:
    figure = new_figure(5.4, 3.4)
    axes = figure.add_subplot()
    fluids, dry, wet = np.array(found["fluid"]), np.array(found["dry"]), np.array(found["wet"])
    ends = np.array([dry.min(), dry.max()])
    for number, (fluid, alpha, beta) in enumerate(found["lines"]):
        colour = f"C{number % 10}"
        axes.plot(dry[fluids == fluid], wet[fluids == fluid], "o", ms=4, color=colour, label=fluid)
        axes.plot(ends, alpha + beta * ends, color=colour)
    axes.set_xlabel("dry adhesion (N)")
    axes.set_ylabel("adhesion with the fluid (N)")
    axes.legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    plain(axes)
    return figure


def _groups(analysis: FolderAnalysis) -> list[tuple[str, str, Figure]]:
    """Group means with SD, the units' own values, and Tukey's letters where a factor was tested.

    Where persons repeat, points are persons' means and grey lines join one person's.
    """
    made = []
    for finding in analysis.study.findings:
        if not finding.marks:
            continue
        response, factor, letters = finding.response, finding.factor, finding.marks
        values = _values(analysis, response, factor)
        if len(values) < 2:
            continue
        figure = new_figure(max(3.2, 1.05 * len(values) + 1.3), 3.1)
        axes = figure.add_subplot()
        names = list(values)
        persons: dict[str, list[tuple[float, float]]] = {}
        for i, name in enumerate(names):
            points = np.array(list(values[name].values()))
            axes.bar(i, points.mean(), width=0.62, color="tab:blue", alpha=0.35)
            spread = points.std(ddof=1) if len(points) > 1 else 0.0
            axes.errorbar(i, points.mean(), spread, color="0.2", capsize=3, linewidth=1)
            shift = 0.3 * ((np.arange(len(points)) * 0.618034) % 1.0) - 0.15
            axes.plot(i + shift, points, "o", ms=2.6, color="0.2", alpha=0.5)
            for x, (who, y) in zip(i + shift, values[name].items(), strict=True):
                persons.setdefault(who, []).append((float(x), y))
            height = max(points.max(), points.mean() + spread)
            axes.annotate(
                letters.get(name, ""),
                (i, height),
                textcoords="offset points",
                xytext=(0, 5),
                ha="center",
                weight="bold",
            )
        lines = [path for path in persons.values() if len(path) > 1]
        for path in lines:
            axes.plot(*zip(*path, strict=True), color="0.6", linewidth=0.5, zorder=0)
        axes.set_xticks(range(len(names)), [name.replace(", ", "\n") for name in names])
        longest = max(len(part) for name in names for part in name.split(", "))
        axes.tick_params(axis="x", labelsize=9 if longest < 14 else 7)
        label = _NAMES.get(response, response.replace("_", " "))
        axes.set_ylabel(label)
        axes.margins(y=0.14)
        axes.set_ylim(bottom=0)
        plain(axes)
        units = "means of persons (lines join one person)" if lines else "single values"
        words = (
            f"{label} by {factor}: means, standard deviations, {units}; groups that share a "
            "letter do not differ (Tukey, 0.05)"
        )
        made.append((f"groups_{response}_{factor}", words, figure))
    return made


def _values(analysis: FolderAnalysis, response: str, factor: str) -> dict[str, dict[str, float]]:
    """Return the mean of each person (or file) by level of a factor."""
    parameters = analysis.study.curves.get("parameters", {})
    if response in parameters:
        found: dict[str, dict[str, float]] = {}
        for number, (group, value) in enumerate(parameters[response]):
            found.setdefault(group, {})[str(number)] = value
        return found
    usable = [f for f in analysis.files if f.usable and response in f.main]
    person = analysis.person
    values: dict[str, dict[str, list[float]]] = {}
    for one in usable:
        if factor in one.conditions:
            who = str(one.conditions.get(person, one.file)) if person else one.file
            own = values.setdefault(str(one.conditions[factor]), {})
            own.setdefault(who, []).append(one.main[response])
    return {
        level: {who: float(np.mean(v)) for who, v in own.items()} for level, own in values.items()
    }
