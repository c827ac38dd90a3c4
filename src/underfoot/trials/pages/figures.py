"""Figures and contact sheets of an analysis of trials: curves of the results, none computed."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core.remark import NOTHING, Message, join_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..study import FileResult, Finding, FolderAnalysis

COLOURS = {"accepted": "#0b6fa4", "caution": "#b36b00", "refused": "#a32020", "rejected": "#a32020"}
_PER_PAGE, _ACROSS = 60, 6
_SIZE = np.array([0.84, 0.72])  # of a tile in its cell of 1 x 1


@dataclass(frozen=True, slots=True)
class Tile:
    """One trial or contact: a curve (x, y), label, verdict, marked points, why it was refused."""

    label: str
    verdict: str
    x: np.ndarray
    y: np.ndarray
    marks: tuple[tuple[float, float], ...] = ()
    remark: str = ""
    reason: str = ""


_CELL = 140.0, 104.0  # of a tile with its label, in points of the drawing
_POINTS = 90  # of a curve in a tile: more than its width can show


@dataclass(frozen=True, slots=True)
class SheetPage:
    """One page of a contact sheet as SVG text, with its file name (without ending)."""

    name: str
    svg: str


def contact_sheets(sheet: TileSheet) -> Iterator[SheetPage]:
    """Yield pages of at most 60 tiles, all on the same two scales.

    They are written as text: thousands of tiles take seconds, and a browser draws what is opened.
    """
    pages = [sheet.tiles[i : i + _PER_PAGE] for i in range(0, len(sheet.tiles), _PER_PAGE)]
    left, right, low, high = (f"{value:.3g}" for value in (*sheet.x_range, *sheet.y_range))
    dashed = NOTHING
    if sheet.line is not None:
        dashed = Message("; dashed slip above {limit:g} m/s", limit=sheet.line)
    legend = Message(
        "each tile: {left} to {right} s across, {low} to {high} up{dashed}; blue accepted, orange "
        "caution, red rejected or refused, with the reason",
        left=left,
        right=right,
        low=low,
        high=high,
        dashed=dashed,
    )
    for number, page in enumerate(pages, start=1):
        head = sheet.title if len(pages) == 1 else f"{sheet.title} ({number} of {len(pages)})"
        tiles = [tile for _, tile in page]
        yield SheetPage(f"sheet_{sheet.kind}_{number}", _page(tiles, sheet, head, legend))


def _page(tiles: Sequence[Tile], sheet: TileSheet, head: str, legend: str) -> str:
    across = min(_ACROSS, len(tiles))
    down = -(-len(tiles) // across)
    size = np.array(_CELL) * _SIZE
    low, high = np.array((sheet.x_range, sheet.y_range)).T
    width, height = _CELL[0] * max(across, 4) + 24, _CELL[1] * down + 40
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
        'font-family="sans-serif" font-size="7" fill="#333">',
        _text(4, 10, head, 'font-size="11" font-weight="bold"'),
        _text(4, 21, legend, 'fill="#666"'),
    ]
    frames = []
    for i, tile in enumerate(tiles):
        x, y = 20 + _CELL[0] * (i % across), 40 + _CELL[1] * (i // across)
        colour = COLOURS.get(tile.verdict, "#444")
        frames.append(f"M{x:.0f} {y:.0f}h{size[0]:.0f}v{size[1]:.0f}h-{size[0]:.0f}z")

        def place_points(points: np.ndarray, corner: tuple[float, float] = (x, y)) -> np.ndarray:
            share = np.clip((points - low) / (high - low), 0, 1)
            return np.array(corner) + size * np.column_stack((share[:, 0], 1 - share[:, 1]))

        parts.append(f'<g fill="{colour}">' + _text(x, y - 3, _short(tile.label)))
        inside = np.isfinite(tile.y) & (tile.x >= low[0]) & (tile.x <= high[0])
        path = np.column_stack((tile.x, tile.y))[inside]
        if len(path):
            path = place_points(path[:: -(-len(path) // _POINTS)])
            parts.append(f'<path fill="none" stroke="{colour}" d="{_path(path)}"/>')
        marks = np.array(tile.marks, dtype=float).reshape(-1, 2)
        for cx, cy in place_points(marks[np.isfinite(marks).all(axis=1)]):
            parts.append(f'<circle cx="{cx:.1f}" cy="{cy:.1f}" r="1.8"/>')
        for line, reason in enumerate(textwrap.wrap(tile.reason, 34)[:4]):
            parts.append(_text(x + 3, y + 8 + 7 * line, reason, 'font-size="6"'))
        if tile.remark:
            end = 'text-anchor="end"'
            parts.append(_text(x + size[0] - 3, y + 8, tile.remark, f'{end} fill="#333"'))
        parts.append("</g>")
        if i % across == 0:
            for value, at in ((high[1], y + 5), (low[1], y + size[1])):
                parts.append(_text(x - 2, at, f"{value:.3g}", 'font-size="6" text-anchor="end"'))
        if i >= len(tiles) - across:
            for value, at in ((low[0], x), (high[0], x + size[0])):
                middle = 'font-size="6" text-anchor="middle"'
                parts.append(_text(at, y + size[1] + 8, f"{value:.3g} s", middle))
        if sheet.line is not None:
            level = place_points(np.column_stack(((low[0], high[0]), (sheet.line, sheet.line))))
            parts.append(f'<path stroke="#999" stroke-dasharray="3 2" d="{_path(level)}"/>')
    parts.append(f'<path fill="none" stroke="#ddd" d="{"".join(frames)}"/></svg>')
    return "".join(parts)


def _text(x: float, y: float, text: str, look: str = "") -> str:
    return f'<text x="{x:.0f}" y="{y:.0f}" {look}>{escape(text)}</text>'


def _path(points: np.ndarray) -> str:
    """Return a path in steps of tenths: short text."""
    tenths = np.round(10 * points).astype(int)
    steps = np.diff(tenths, axis=0)
    body = " ".join(f"{a:g} {b:g}" for a, b in (steps / 10).tolist())
    return f"M{tenths[0, 0] / 10:g} {tenths[0, 1] / 10:g}l{body}"


def _short(label: str) -> str:
    return label if len(label) <= 34 else label[:12] + "…" + label[-21:]


Curve = Mapping[str, Any]
_WINDOW = {"color": "tab:blue", "alpha": 0.12, "linewidth": 0}
_SPREAD = 0.618034  # a fixed pattern instead of random numbers: the same folder, the same picture


@dataclass(frozen=True, slots=True)
class TrialFigure:
    """A figure with its file name (without ending), caption and chapter of the report."""

    name: str
    caption: str
    figure: Figure
    chapter: str = "study"


def trial_figures(analysis: FolderAnalysis, *, details: int = 4) -> list[TrialFigure]:
    """Return the figures of an analysis: the study, single trials in detail.

    ``details`` is the number of single trials drawn: first those with cautions, then accepted ones.
    """
    single = [
        made for result in _choose_files(analysis.files, details) for made in _details(result)
    ]
    return [*_study(analysis), *single]


def _choose_files(files: Sequence[FileResult], details: int) -> list[FileResult]:
    drawn = [file for file in files if file.curves]
    slips = [result for result in drawn if result.main.get("slip") == 1.0]
    others = [result for result in drawn if result not in slips]
    # A slip first, then one without, then what needs a second look.
    order = [*slips[:1], *others[:1], *(f for f in drawn if f.verdict == "caution"), *drawn]
    return list({result.file: result for result in order}.values())[:details]


def _details(result: FileResult) -> Iterator[TrialFigure]:
    stem = re.sub(r"[^\w.-]+", "_", result.file.replace("#", "step_"))
    for key, (maker, caption) in _TRIAL.items():
        if key in result.curves:
            figure = maker(result.curves[key], result)
            figure.suptitle(result.file, fontsize=9, color="0.35", x=0.01, ha="left")
            yield TrialFigure(f"{stem}_{key}", f"{result.file}: {caption}", figure, "trials")


def _empty(width: float, height: float) -> Figure:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def _single(width: float, height: float) -> tuple[Figure, Axes]:
    figure = _empty(width, height)
    return figure, figure.add_subplot()


def _row(width: float, height: float, count: int) -> tuple[Figure, Sequence[Axes]]:
    figure = _empty(width, height)
    grid: Any = figure.subplots(1, count, squeeze=False, sharey=True)
    return figure, grid[0]


def _finish(
    axes: Axes, x: str = "", y: str = "", *, beside: int = 0, small: str = "", **settings: Any
) -> None:
    """Name the axes; limits, a small title, a legend ``beside`` of that font size; no frame."""
    axes.set(**settings, **{key: name for key, name in (("xlabel", x), ("ylabel", y)) if name})
    axes.spines[["top", "right"]].set_visible(False)
    if small:
        axes.set_title(small, fontsize=9)
    if beside and axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, fontsize=beside, loc="center left", bbox_to_anchor=(1.0, 0.5))


def _array(values: Sequence[float | None]) -> np.ndarray:
    """Return a stored curve as floats; gaps are NaN."""
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def _loaded_ratio(curve: Curve, least: float) -> np.ndarray:
    """Return the ratio where the normal force is above ``least`` (N), else NaN."""
    return np.where(_array(curve["normal"]) > least, _array(curve["ratio"]), np.nan)


def _steps(steps: Sequence[Curve], _: FileResult) -> Figure:
    count = min(len(steps), 3)
    figure = _empty(3.3 * count + 2.2, 4.4)
    grid: Any = figure.subplots(2, count, squeeze=False, sharex="col", sharey="row")
    for (top, low), step in zip(grid.T, steps, strict=False):
        time, peak = 1e3 * _array(step["time"]), (1e3 * step["peak_time"], step["peak"])
        top.plot(time, _array(step["normal"]), color="0.25", label="normal")
        top.plot(time, _array(step["along"]), color="tab:blue", label="along the walk")
        top.plot(time, _array(step["across"]), color="tab:orange", label="across")
        top.axhline(0, color="0.8", linewidth=0.8)
        _finish(top, small=step["step"])
        low.plot(time, _loaded_ratio(step, 20), color="tab:green")
        low.axvline(1e3 * step["gate"], color="0.6", linestyle=":", label="gate passed")
        low.plot(*peak, "o", color="black", label="required friction")
        low.annotate(f"{peak[1]:.3f}", peak, textcoords="offset points", xytext=(6, 4), fontsize=9)
        _finish(low, "time after contact (ms)", ylim=(0, max(0.4, 1.4 * peak[1])))
    for row, label in zip(grid, ("force on the foot (N)", "shear / normal"), strict=True):
        row[0].set_ylabel(label)
        _finish(row[-1], beside=8)
    return figure


def _heel(curves: Sequence[Curve], _: FileResult) -> Figure:
    heel = curves[0]
    figure, axes = _single(6.4, 3.0)
    time, speed, limit = 1e3 * _array(heel["time"]), _array(heel["speed"]), heel["threshold"]
    shown = time > -60
    axes.plot(time[shown], speed[shown], color="tab:blue")
    axes.axvline(0, color="0.5", linewidth=0.8)
    axes.axhline(limit, color="0.6", linestyle="--", linewidth=0.8)
    label = f"slip above {limit:g} m/s"
    place = axes.annotate(label, (1, limit), xycoords=("axes fraction", "data"), fontsize=8)
    place.set(ha="right", va="bottom", color="0.35")
    for key, label, style in (("start", "slip start", "v"), ("end", "end of search", "^")):
        if heel[key] is not None:
            at = 1e3 * heel[key]
            axes.plot(at, np.interp(at, time, speed), style, color="tab:red", label=label)
    if heel["peak"] is not None and heel["peak_time"] is not None:
        label = f"peak {heel['peak']:.2f} m/s"
        axes.plot(1e3 * heel["peak_time"], heel["peak"], "o", color="black", label=label)
    inside = (time > -5) & (time < 1e3 * (heel["end"] or 0.5) + 120)
    top = float(np.nanmax(np.append(speed[inside], limit)))
    names = "time after heel contact (ms)", "heel speed (m/s)"
    _finish(axes, *names, ylim=(0, 1.15 * top), beside=8)
    return figure


def _track(curves: Sequence[Curve], _: FileResult) -> Figure:
    track = curves[0]
    pulses = track["pulses"]
    figure = _empty(8.6, 3.9)
    parts: Any = figure.subfigures(1, 2, width_ratios=(1, 1.9))
    left, right = parts
    axes = left.add_subplot()
    across, along = 1e3 * _array(track["across"]), 1e3 * _array(track["along"])
    # The walker's left is drawn on the left, the walk goes up, as seen from above.
    axes.plot(-across, along, color="tab:blue", linewidth=2, label="heel")
    axes.plot(-across[:1], along[:1], "o", color="tab:blue", label="heel contact")
    places = 1e3 * np.array([(-p["across"], p["along"]) for p in pulses]).reshape(-1, 2)
    axes.plot(*places.T, "x", color="0.2", linestyle="none", label="sensor")
    names = "right of the middle (mm)", "along the walk (mm)"
    _finish(axes, *names, aspect="equal", xlim=(-70, 70))
    above = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 3}
    axes.legend(frameon=False, fontsize=7, handletextpad=0.3, columnspacing=0.8, **above)
    rows, columns = (
        sorted({round(p[key], 4) for p in pulses}, reverse=True) for key in ("along", "across")
    )
    grid: Any = right.subplots(len(rows), len(columns), squeeze=False, sharex=True, sharey=True)
    for p in pulses:
        cell = grid[rows.index(round(p["along"], 4))][columns.index(round(p["across"], 4))]
        cell.plot(1e3 * _array(p["time"]), _array(p["kPa"]), color="tab:blue", linewidth=1)
        cell.set_title(p["sensor"], fontsize=7, pad=2)
        cell.tick_params(labelsize=7)
        _finish(cell)
    right.supxlabel("time after heel contact (ms)", fontsize=8)
    right.supylabel("fluid pressure (kPa)", fontsize=8)
    return figure


def _slide(curves: Sequence[Curve], result: FileResult) -> Figure:
    slide, cof = curves[0], result.main.get("cof")
    figure = _empty(6.4, 4.2)
    top, low = figure.subplots(2, 1, sharex=True)
    time = _array(slide["time"])
    top.plot(time, _array(slide["normal"]), color="0.25", label="normal")
    top.plot(time, _array(slide["shear"]), color="tab:blue", label="shear, resultant")
    low.plot(time, _array(slide["ratio"]), color="tab:green")
    if cof is not None:
        low.plot([slide["begin"], slide["end"]], [cof, cof], color="black", label=f"COF {cof:.3f}")
        _finish(low, ylim=(0, 2.2 * cof), beside=8)
    for axes in (top, low):
        axes.axvspan(slide["begin"], slide["end"], **_WINDOW)
    _finish(top, ylabel="force (N)", beside=8)
    _finish(low, "time (s)", "shear / normal")
    return figure


def _run(curves: Sequence[Curve], _: FileResult) -> Figure:
    run = curves[0]
    figure, axes = _single(6.4, 2.6)
    ratio = _array(run["ratio"])
    axes.plot(_array(run["time"]), ratio, color="tab:blue", linewidth=0.8)
    axes.axvspan(run["begin"], run["end"], **_WINDOW)
    axes.axhline(run["cof"], color="black", linewidth=1)
    _finish(axes, "time (s)", "COF", ylim=(0, 1.15 * float(np.nanmax(ratio))))
    return figure


def _hold(curves: Sequence[Curve], _: FileResult) -> Figure:
    hold = curves[0]
    figure, axes = _single(6.0, 2.8)
    time, force = _array(hold["time"]), _array(hold["force"])
    axes.semilogx(time[time > 0], force[time > 0], color="tab:blue")
    axes.axhline(hold["final"], color="0.4", linestyle="--", linewidth=0.9, label="F∞, last tenth")
    axes.legend(frameon=False, fontsize=8)
    _finish(axes, "time since the peak (s)", "force (N)")
    return figure


_TRIAL = {
    "steps": (_steps, "force components (unfiltered) and ratio of shear to normal force "
              "(filtered), with the gate and the peak taken as required friction"),
    "heel": (_heel, "heel speed after contact with both minima and the peak"),
    "track": (_track, "heel trajectory over the sensor array, and the pressures in its layout"),
    "slide": (_slide, "forces and ratio, the averaging window shaded"),
    "run": (_run, "COF against time, the averaging window shaded"),
    "hold": (_hold, "force during the hold"),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class TileSheet:
    """Tiles of a folder on common scales: (file, tile) in order; refused files have no curve."""

    kind: str
    title: str
    tiles: tuple[tuple[str, Tile], ...]
    x_range: tuple[float, float]
    y_range: tuple[float, float]
    line: float | None = None


def sheets(files: Sequence[FileResult]) -> Iterator[TileSheet]:
    """Yield the contact sheets of files: steps, heels, slides, runs and holds, where there are."""
    # Curves, title, and the least seconds across and height of the common scales.
    for keys, title, across, up in (
        (("steps", "rejected"), "Shear / normal of every step", 0.8, 0.5),
        (("heel",), "Heel speed after contact of every trial (m/s)", 0.8, 0.3),
        (("slide",), "Shear / normal of every slide", 0.5, 0.1),
        (("run",), "COF of every run", 0.5, 0.075),
        (("hold",), "Force of every hold, share of its start", 1.0, 1.1),
    ):
        curves = [
            (k, result, c) for result in files for k in keys for c in result.curves.get(k, [])
        ]
        if not curves:
            continue
        made = [(result.file, *_tile(key, result, curve)) for key, result, curve in curves]
        ends = [t.x[-1] for _, t, _ in made if keys[0] not in ("steps", "heel")]
        empty = [
            (
                result.file,
                Tile(result.file, result.verdict, *_NO_CURVE, reason=join_lines(result.reasons)),
            )
            for result in files
            if not result.curves
        ]
        yield TileSheet(
            keys[0],
            title,
            (*((file, tile) for file, tile, _ in made), *empty),
            (0.0, float(max([across, *ends]))),
            (0.0, max([up, *(height for *_, height in made)])),
            curves[-1][2].get("threshold"),
        )


_NO_CURVE = (np.empty(0), np.empty(0))


def _tile(key: str, result: FileResult, curve: Curve) -> tuple[Tile, float]:
    """Return the tile of a curve and the height that it needs (0 for the least one)."""
    time = _array(curve["time"])
    if key == "rejected":
        label = f"{result.file}, {curve['step']}"
        return Tile(label, key, time, _loaded_ratio(curve, 50), reason=curve["reason"]), 0.0
    if key == "steps":
        label, verdict = f"{result.file}, {curve['step']}", curve.get("verdict", result.verdict)
        mark = ((curve["peak_time"], curve["peak"]),)
        return Tile(
            label, verdict, time, _loaded_ratio(curve, 50), mark, f"{curve['peak']:.3f}"
        ), 0.0
    marks: tuple[tuple[float, float], ...] = ()
    if key == "heel":
        values, remark, height, peak = _array(curve["speed"]), "not judged", 0.0, curve["peak"]
        if peak is not None and curve["peak_time"] is not None:
            marks, remark = ((curve["peak_time"], peak),), f"{peak:.2f}"
            height = float(np.ceil(10 * peak) / 10)
        until = time < (curve["end"] or 0.8) + 0.03
        time, values = time[until], values[until]
    elif key == "slide":
        values, cof = _loaded_ratio(curve, 50), result.main.get("cof")
        remark, height = ("no COF", 0.0) if cof is None else (f"{cof:.3f}", 2.0 * cof)
    elif key == "run":
        values, cof = _array(curve["ratio"]), curve["cof"]
        marks = ((curve["begin"], cof), (curve["end"], cof))
        remark, height = f"{cof:.3f}", 1.5 * (cof or 0.0)
    else:
        force = _array(curve["force"])
        values, remark, height = force / force[0], f"{curve['final'] / force[0]:.2f}", 0.0
    return Tile(result.file, result.verdict, time, values, marks, remark), height


_NAMES = {
    "acof": "available friction, ACOF", "rcof": "required friction, RCOF", "cof": "COF",
    "acof_minus_rcof": "ACOF − RCOF", "peak_slipping_speed": "peak slipping speed (m/s)",
    "peak_force": "peak force (N)", "cof_bl": "COF_BL", "tau_hydro": "tau_hydro (m/s)",
    "cof_asymptote": "COF_asymptote",
}  # fmt: skip


def _study(analysis: FolderAnalysis) -> Iterator[TrialFigure]:
    """Yield the figures of what the folder says as a whole."""
    curves = analysis.study.curves
    methods = "; ".join(dict.fromkeys(one["method"] for one in curves.get("risk") or ()))
    for key, (name, maker, caption) in _FOLDER.items():
        if curves.get(key):
            yield TrialFigure(name, caption.format(methods=methods), maker(curves[key]))
    for finding in analysis.study.findings:
        if len(finding.values) > 1:
            yield _groups(finding)


def _risk(risk: Sequence[Curve]) -> Figure:
    figure, row = _row(3.4 * len(risk), 3.1, len(risk))
    for axes, curve in zip(row, risk, strict=True):
        axes.fill_between(
            curve["grid"], curve["low"], curve["high"], color="tab:blue", alpha=0.18, lw=0
        )
        axes.plot(curve["grid"], curve["risk"], color="tab:blue")
        y = np.array(curve["y"], dtype=float)
        shift = 0.035 * ((np.arange(len(y)) * _SPREAD) % 1.0)
        spread = np.where(y > 0.5, y + shift, y - shift)
        axes.plot(curve["x"], spread, "o", ms=3.5, color="0.2", alpha=0.6)
        inside = curve["grid"][0] < curve["half"] < curve["grid"][-1]
        title = f"slope {curve['slope']:.1f}" + (f", 50 % at {curve['half']:.3f}" if inside else "")
        _finish(
            axes, _NAMES.get(curve["name"], str(curve["name"])), small=title, ylim=(-0.06, 1.06)
        )
        axes.locator_params(axis="x", nbins=5)
    row[0].set_ylabel("slip (1) or not (0), risk")
    return figure


def _maps(maps: Sequence[Curve]) -> Figure:
    figure, row = _row(3.3 * len(maps) + 0.6, 4.6, len(maps))
    top = max(1e-3 * float(np.max(curve["pressure"])) for curve in maps)
    image: Any = None
    for axes, scan_map in zip(row, maps, strict=True):
        right, along = -1e3 * np.array(scan_map["lateral"]), 1e3 * np.array(scan_map["along"])
        # Each scan stands for the strip around it: no smoothing between scans.
        pressure, scale = 1e-3 * np.array(scan_map["pressure"]).T, {"vmin": 0, "vmax": top}
        look: dict[str, Any] = {"cmap": "viridis", "shading": "nearest", "rasterized": True}
        image = axes.pcolormesh(right, along, pressure, **scale, **look)
        for x in right:
            axes.axvline(x, color="white", linewidth=0.4, alpha=0.6)
        axes.plot(
            -1e3 * scan_map["peak_lateral"], 1e3 * scan_map["peak_along"], "+", color="red", ms=9
        )
        words = f"{scan_map['load']:.3g} N, peak {1e-3 * scan_map['peak']:.3g} kPa"
        axes.set_title(f"{scan_map['label']}\n{words}", fontsize=9)
        axes.set(aspect="equal", xlabel="right of heel's middle (mm)")
        axes.locator_params(axis="x", nbins=3)
    row[0].set_ylabel("forward of the heel's back (mm)")
    figure.colorbar(image, ax=list(row), label="fluid pressure (kPa)", shrink=0.8)
    return figure


def _fits(fits: Sequence[Curve]) -> Figure:
    groups = {name: [f for f in fits if f["group"] == name] for name in [f["group"] for f in fits]}
    across = min(3, len(groups))
    down = -(-len(groups) // across)
    figure = _empty(3.3 * across, 3.3 * down)
    outer: Any = figure.subfigures(down, across, squeeze=False)
    highest = max(max(fit["cof"]) for fit in fits)
    for i, (group, curves) in enumerate(groups.items()):
        top, low = outer.flat[i].subplots(2, 1, sharex=True, height_ratios=(2.6, 1))
        for number, curve in enumerate(curves):
            colour = f"C{number % 10}"
            speed, cof = np.array(curve["speed"]), np.array(curve["cof"])
            grid = np.linspace(0, 1.02 * speed.max(), 120)
            top.plot(grid, _fitted_curve(curve, grid), color=colour, linewidth=0.9)
            top.plot(speed, cof, "o", ms=2.6, color=colour)
            low.plot(speed, cof - _fitted_curve(curve, speed), "o", ms=2.2, color=colour)
        verdicts = [f["verdict"] for f in curves]
        words = ", ".join(f"{verdicts.count(v)} {v}" for v in dict.fromkeys(verdicts))
        low.axhline(0, color="0.7", linewidth=0.8)
        low.set_xlabel("sliding speed (m/s)", fontsize=8)
        if i % across == 0:
            top.set_ylabel("COF", fontsize=8)
            low.set_ylabel("residual", fontsize=8)
        _finish(top, small=f"{group or 'all files'} ({words})", ylim=(0, 1.1 * highest))
        _finish(low)
        for axes in (top, low):
            axes.tick_params(labelsize=7)
    return figure


def _fitted_curve(curve: Curve, speed: np.ndarray) -> np.ndarray:
    if curve["verdict"] == "mean":
        return np.full(len(speed), curve["mean"])
    boundary, tau, asymptote = curve["raw"]
    return asymptote + (boundary - asymptote) * np.exp(-speed / tau)


def _master(master: Curve) -> Figure:
    figure, axes = _single(6.2, 3.6)
    product, cof, labels = (np.array(master[key]) for key in ("product", "cof", "label"))
    for number, label in enumerate(dict.fromkeys(master["label"])):
        mine = labels == label
        axes.semilogx(product[mine], cof[mine], "o", ms=3, color=f"C{number % 10}", label=label)
    axes.semilogx(master["grid"], master["fitted"], color="black", linewidth=1.2, label="one curve")
    words = f"R² {master['r_squared']:.3f}, residual sd {master['residual_sd']:.3f}"
    _finish(axes, "viscosity × speed (N/m)", "COF", ylim=(0, None), small=words, beside=7)
    return figure


def _line(line: Curve) -> Figure:
    figure, axes = _single(4.4, 3.2)
    x = np.array(line["x"])
    axes.plot(x, line["y"], "o", ms=4, color="0.2")
    ends = np.array([0.0, 1.05 * x.max()])
    axes.plot(ends, line["intercept"] + line["slope"] * ends, color="tab:blue")
    names = "peak pressure (kPa)", "peak slipping speed (m/s)"
    _finish(axes, *names, ylim=(0, None), small=f"r = {line['r']:.2f}")
    return figure


def _alpha_beta(curve: Curve) -> Figure:
    figure, axes = _single(5.4, 3.4)
    fluids, dry, wet = (np.array(curve[key]) for key in ("fluid", "dry", "wet"))
    ends = np.array([dry.min(), dry.max()])
    for number, (fluid, alpha, beta) in enumerate(curve["lines"]):
        colour = f"C{number % 10}"
        axes.plot(dry[fluids == fluid], wet[fluids == fluid], "o", ms=4, color=colour, label=fluid)
        axes.plot(ends, alpha + beta * ends, color=colour)
    _finish(axes, "dry adhesion (N)", "adhesion with the fluid (N)", beside=8)
    return figure


_FOLDER = {
    "risk": ("risk", _risk, "Slip outcomes (points, spread a little for the eye) and curves with "
             "95 % bands: {methods}"),
    "maps": ("maps", _maps, "Fluid pressure under the shoe; white lines are the scans, the cross "
             "is the peak"),
    "fits": ("stribeck", _fits, "COF against sliding speed with the fit of Eq. 17, and its "
             "residuals"),
    "master": ("master_curve", _master, "All COF against viscosity × speed, and one falling curve "
               "through them"),
    "line": ("speed_pressure", _line, "Peak slipping speed against the largest pressure of a "
             "trial"),
    "alpha_beta": ("alpha_beta", _alpha_beta, "Adhesion with a fluid against dry adhesion, lines "
                   "of Eq. 26"),
}  # fmt: skip


def _groups(finding: Finding) -> TrialFigure:
    """Draw means with SD, the single values, and Tukey's letters of the levels of a factor.

    Where persons repeat, points are persons' means and grey lines join one person's.
    """
    names = list(finding.values)
    figure, axes = _single(max(3.2, 1.05 * len(names) + 1.3), 3.1)
    persons: dict[str, list[tuple[float, float]]] = {}
    for i, (name, values) in enumerate(finding.values.items()):
        points = np.array(list(values.values()))
        spread = points.std(ddof=1) if len(points) > 1 else 0.0
        axes.bar(i, points.mean(), width=0.62, color="tab:blue", alpha=0.35)
        axes.errorbar(i, points.mean(), spread, color="0.2", capsize=3, linewidth=1)
        places = i + 0.3 * ((np.arange(len(points)) * _SPREAD) % 1.0) - 0.15
        axes.plot(places, points, "o", ms=2.6, color="0.2", alpha=0.5)
        for x, (who, y) in zip(places, values.items(), strict=True):
            persons.setdefault(who, []).append((float(x), y))
        top = (i, max(points.max(), points.mean() + spread))
        mark = axes.annotate(
            finding.marks.get(name, ""), top, textcoords="offset points", xytext=(0, 5)
        )
        mark.set(ha="center", weight="bold")
    lines = [path for path in persons.values() if len(path) > 1]
    for path in lines:
        axes.plot(*zip(*path, strict=True), color="0.6", linewidth=0.5, zorder=0)
    axes.set_xticks(range(len(names)), [name.replace(", ", "\n") for name in names])
    longest = max(len(part) for name in names for part in name.split(", "))
    axes.tick_params(axis="x", labelsize=9 if longest < 14 else 7)
    axes.margins(y=0.14)
    label = _NAMES.get(finding.response, finding.response.replace("_", " "))
    _finish(axes, ylabel=label, ylim=(0, None))
    units = "means of persons" if finding.by_person else "single values"
    units += " (lines join one person)" if lines else ""
    words = (
        f"{label} by {finding.factor}: means, standard deviations, {units}; groups that share a "
        "letter do not differ (Tukey, 0.05)"
    )
    return TrialFigure(f"groups_{finding.response}_{finding.factor}", words, figure)
