"""Lines over one axis as SVG text: in a page without a picture, in the page's own colours."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

import numpy as np
from numpy.typing import ArrayLike

WIDTH, HEIGHT, LEFT, BOTTOM, TOP = 720, 270, 56, 40, 32
STYLES = ('stroke="currentColor" stroke-dasharray="6 4"', 'stroke="#2a7fb8"')


def line_chart(
    x: ArrayLike, lines: Sequence[tuple[str, ArrayLike]], x_label: str, y_label: str
) -> str:
    """Return the chart of up to two named lines, y from 0."""
    x = np.asarray(x, dtype=float)
    values = [np.asarray(line, dtype=float) for _, line in lines]
    across = _ticks(float(x.max()))
    up = _ticks(max(float(np.nanmax(line)) for line in values))

    def at_x(value: float) -> float:
        return LEFT + (WIDTH - LEFT - 10) * value / across[-1]

    def at_y(value: float) -> float:
        return HEIGHT - BOTTOM - (HEIGHT - BOTTOM - TOP) * value / up[-1]

    parts = [
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" style="width:100%;max-width:{WIDTH}px" '
        'font-size="12" fill="currentColor">',
        f"<title>{escape(y_label)} over {escape(x_label)}</title>",
    ]
    for value in up:
        parts.append(
            f'<path d="M{LEFT} {at_y(value):.1f}H{WIDTH - 10}" stroke="currentColor" '
            f'opacity="0.15"/><text x="{LEFT - 6}" y="{at_y(value) + 4:.1f}" '
            f'text-anchor="end">{value:.12g}</text>'
        )
    for value in across:
        last = value == across[-1]  # stays inside
        x_text, anchor = (WIDTH - 1, "end") if last else (f"{at_x(value):.1f}", "middle")
        parts.append(
            f'<text x="{x_text}" y="{HEIGHT - BOTTOM + 16}" text-anchor="{anchor}">'
            f"{value:.12g}</text>"
        )
    middle = f'x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 6}"'
    parts.append(f'<text {middle} text-anchor="middle">{escape(x_label)}</text>')
    turned = f'transform="translate(14 {(HEIGHT - BOTTOM + TOP) / 2}) rotate(-90)"'
    parts.append(f'<text {turned} text-anchor="middle">{escape(y_label)}</text>')
    for number, ((name, _), line, style) in enumerate(zip(lines, values, STYLES, strict=False)):
        known = np.isfinite(line)
        points = " ".join(
            f"{at_x(a):.1f},{at_y(b):.1f}" for a, b in zip(x[known], line[known], strict=True)
        )
        parts.append(f'<polyline points="{points}" fill="none" stroke-width="2" {style}/>')
        begin = LEFT + 190 * number  # above the axes, where no line runs
        parts.append(
            f'<path d="M{begin} 12h26" stroke-width="2" {style}/>'
            f'<text x="{begin + 32}" y="16">{escape(name)}</text>'
        )
    return "".join([*parts, "</svg>"])


def _ticks(most: float) -> np.ndarray:
    """Return round numbers from 0 to ``most`` or just beyond."""
    most = most if most > 0 else 1.0
    size = 10 ** math.floor(math.log10(most / 4))
    step = next(size * part for part in (1, 2, 5, 10) if size * part * 5 >= most)
    return step * np.arange(math.ceil(most / step - 1e-9) + 1)
