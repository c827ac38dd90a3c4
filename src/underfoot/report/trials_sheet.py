"""Contact sheets: every trial as a small tile, for quality control at a glance."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = {
    "accepted": "#0b6fa4",
    "caution": "#b36b00",
    "refused": "#a32020",
    "rejected": "#a32020",
}
_PER_PAGE = 60
_ACROSS = 6
_GAP = 0.16


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
    return [
        _page(page, x_range, y_range, title, line, line_label, f"{n} of {len(pages)}")
        for n, page in enumerate(pages, start=1)
    ]


def _page(
    tiles: Sequence[Tile],
    x_range: tuple[float, float],
    y_range: tuple[float, float],
    title: str,
    line: float | None,
    line_label: str,
    number: str,
) -> Figure:
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure

    across = min(_ACROSS, len(tiles))
    down = -(-len(tiles) // across)
    figure = Figure(figsize=(1.75 * across + 0.5, 1.25 * down + 0.75))
    axes = figure.add_axes((0.02, 0.02, 0.96, 1.0 - 0.62 / (1.25 * down + 0.75)))
    axes.set_xlim(-0.1, across)
    axes.set_ylim(-down - 0.04, 0.12)
    axes.set_axis_off()
    curves, colours, frames, levels = [], [], [], []
    spots: dict[str, list[np.ndarray]] = {}
    for i, tile in enumerate(tiles):
        left, top = i % across, -(i // across)
        width, height = 1.0 - _GAP, 0.72
        bottom = top - 0.90

        def place(
            x: np.ndarray,
            y: np.ndarray,
            left: float = left,
            bottom: float = bottom,
            width: float = width,
            height: float = height,
        ) -> np.ndarray:
            u = (np.asarray(x, float) - x_range[0]) / (x_range[1] - x_range[0])
            v = (np.asarray(y, float) - y_range[0]) / (y_range[1] - y_range[0])
            return np.column_stack(
                (left + width * np.clip(u, 0, 1), bottom + height * np.clip(v, 0, 1))
            )

        frames.append(
            [
                (left, bottom),
                (left + width, bottom),
                (left + width, bottom + height),
                (left, bottom + height),
                (left, bottom),
            ]
        )
        colour = COLOURS.get(tile.verdict, "0.3")
        if line is not None:
            levels.append(place(np.array(x_range), np.array([line, line])))
        inside = np.isfinite(tile.y) & (tile.x >= x_range[0]) & (tile.x <= x_range[1])
        if inside.any():
            curves.append(place(tile.x[inside], tile.y[inside]))
            colours.append(colour)
        for mark in tile.marks:
            if np.isfinite(mark).all():
                spot = place(np.array([mark[0]]), np.array([mark[1]]))
                spots.setdefault(colour, []).append(spot)
        axes.text(left, top - 0.09, _short(tile.label), fontsize=5.6, color=colour)
        if tile.reason:
            axes.text(
                left + 0.02,
                bottom + height - 0.04,
                "\n".join(textwrap.wrap(tile.reason, 30)[:4]),
                fontsize=4.8,
                color=colour,
                va="top",
            )
        if tile.remark:
            axes.text(
                left + width - 0.02,
                bottom + height - 0.04,
                tile.remark,
                fontsize=6.2,
                color="0.3",
                ha="right",
                va="top",
            )
        if i % across == 0 or tile is tiles[0]:
            for value, at in ((y_range[0], bottom), (y_range[1], bottom + height)):
                axes.text(left - 0.015, at, f"{value:.3g}", fontsize=4.8, ha="right", va="center")
        if i >= len(tiles) - across:
            for value, at in ((x_range[0], left), (x_range[1], left + width)):
                axes.text(at, bottom - 0.02, f"{value:.3g} s", fontsize=4.8, ha="center", va="top")
    for colour, places in spots.items():
        axes.plot(*np.concatenate(places).T, "o", color=colour, markersize=3)
    axes.add_collection(LineCollection(frames, colors="0.85", linewidths=0.6))
    if levels:
        axes.add_collection(
            LineCollection(levels, colors="0.6", linewidths=0.6, linestyles="dashed")
        )
    axes.add_collection(LineCollection(curves, colors=colours, linewidths=0.9))
    page = "" if number == "1 of 1" else f" ({number})"
    figure.text(0.02, 0.995, title + page, fontsize=10, va="top", weight="bold")
    left, right, low, high = (f"{value:.3g}" for value in (*x_range, *y_range))
    scale = f"each tile: {left} to {right} s across, {low} to {high} up"
    key = "blue accepted, orange caution, red rejected or refused, with the reason"
    dashed = f"; dashed {line_label}" if line is not None else ""
    height = figure.get_figheight()
    figure.text(
        0.02, 1 - 0.24 / height, f"{scale}{dashed}; {key}", fontsize=7, va="top", color="0.35"
    )
    return figure


def _short(label: str) -> str:
    return label if len(label) <= 34 else label[:12] + "…" + label[-21:]
