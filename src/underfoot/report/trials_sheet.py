"""Contact sheets: every trial as a small tile, for quality control at a glance."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = {"accepted": "#0b6fa4", "caution": "#b36b00", "refused": "#a32020", "rejected": "#a32020"}
_PER_PAGE, _ACROSS = 60, 6
_SIZE = np.array([0.84, 0.72])  # of a tile in its cell of 1 x 1
_CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)])


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


def contact_sheets(
    tiles: Sequence[Tile],
    *,
    x_range: tuple[float, float],
    y_range: tuple[float, float],
    title: str,
    line: float | None = None,
    line_label: str = "",
) -> list[Figure]:
    """Return pages of at most 60 tiles, all on the same two scales.

    All curves of a page are drawn into one pair of axes: hundreds of trials take seconds.
    """
    pages = [tiles[i : i + _PER_PAGE] for i in range(0, len(tiles), _PER_PAGE)]
    left, right, low, high = (f"{value:.3g}" for value in (*x_range, *y_range))
    dashed = f"; dashed {line_label}" if line is not None else ""
    words = (
        f"each tile: {left} to {right} s across, {low} to {high} up{dashed}; "
        "blue accepted, orange caution, red rejected or refused, with the reason"
    )
    figures = []
    for number, page in enumerate(pages, start=1):
        figure = _page(page, np.array((x_range, y_range)).T, line)
        head = title if len(pages) == 1 else f"{title} ({number} of {len(pages)})"
        figure.text(0.02, 0.995, head, fontsize=10, va="top", weight="bold")
        below = 1 - 0.24 / figure.get_figheight()
        figure.text(0.02, below, words, fontsize=7, va="top", color="0.35")
        figures.append(figure)
    return figures


def _page(tiles: Sequence[Tile], scale: np.ndarray, line: float | None) -> Figure:
    """Draw the tiles; ``scale`` holds the lowest and the highest (x, y)."""
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    across = min(_ACROSS, len(tiles))
    down = -(-len(tiles) // across)
    figure = Figure(figsize=(1.75 * across + 0.5, 1.25 * down + 0.75))
    axes = figure.add_axes((0.02, 0.02, 0.96, 1.0 - 0.62 / (1.25 * down + 0.75)))
    axes.set(xlim=(-0.1, across), ylim=(-down - 0.04, 0.12))
    axes.set_axis_off()
    curves, colours, frames, levels = [], [], [], []
    spots: dict[str, list[np.ndarray]] = {}

    def placed(corner: np.ndarray, points: np.ndarray) -> np.ndarray:
        return corner + _SIZE * np.clip((points - scale[0]) / (scale[1] - scale[0]), 0, 1)

    for i, tile in enumerate(tiles):
        corner = np.array([i % across, -(i // across) - 0.9])
        (left, bottom), (right, top) = corner, corner + _SIZE
        frames.append(corner + _SIZE * _CORNERS)
        colour = COLOURS.get(tile.verdict, "0.3")
        if line is not None:
            levels.append(placed(corner, np.column_stack((scale[:, 0], (line, line)))))
        inside = np.isfinite(tile.y) & (tile.x >= scale[0, 0]) & (tile.x <= scale[1, 0])
        if inside.any():
            curves.append(placed(corner, np.column_stack((tile.x, tile.y))[inside]))
            colours.append(colour)
        for mark in np.array(tile.marks, dtype=float).reshape(-1, 2):
            if np.isfinite(mark).all():
                spots.setdefault(colour, []).append(placed(corner, mark))
        axes.text(left, bottom + 0.81, _short(tile.label), fontsize=5.6, color=colour)
        reason = "\n".join(textwrap.wrap(tile.reason, 30)[:4])
        axes.text(left + 0.02, top - 0.04, reason, fontsize=4.8, color=colour, va="top")
        remark = axes.text(right - 0.02, top - 0.04, tile.remark, fontsize=6.2, color="0.3")
        remark.set(ha="right", va="top")
        if i % across == 0:
            for value, at in zip(scale[:, 1], (bottom, top), strict=True):
                axes.text(left - 0.015, at, f"{value:.3g}", fontsize=4.8, ha="right", va="center")
        if i >= len(tiles) - across:
            for value, at in zip(scale[:, 0], (left, right), strict=True):
                axes.text(at, bottom - 0.02, f"{value:.3g} s", fontsize=4.8, ha="center", va="top")
    for colour, places in spots.items():
        axes.plot(*np.array(places).T, "o", color=colour, markersize=3)
    for lines, style in (
        (frames, {"colors": "0.85", "linewidths": 0.6}),
        (levels, {"colors": "0.6", "linewidths": 0.6, "linestyles": "dashed"}),
        (curves, {"colors": colours, "linewidths": 0.9}),
    ):
        axes.add_collection(LineCollection(lines, **style))
    return figure


def _short(label: str) -> str:
    return label if len(label) <= 34 else label[:12] + "…" + label[-21:]
