"""Text as outlines of lugs: DejaVu Sans Bold, the font that comes with Matplotlib."""

import re

import numpy as np

from underfoot.core import InputError

_ALLOWED = re.compile(
    r"[A-Za-z0-9À-ÖØ-öø-ÿ &+\-!?./:]*[A-Za-z0-9À-ÖØ-öø-ÿ][A-Za-z0-9À-ÖØ-öø-ÿ &+\-!?./:]*"
)
_SIZE = 40.0
"""Font size at which curves become straight pieces: 20 to 50 a letter."""
_SPACE = 0.3  # width of a blank in heights of a capital
LONGEST = 24


def check_text(text: str, where: str) -> None:
    """Refuse text that can't be moulded as separate letters."""
    if len(text) > LONGEST or not _ALLOWED.fullmatch(text):
        raise InputError(
            f"{text!r} can't be lettering",
            where=where,
            allowed=f"1 to {LONGEST} letters, digits, blanks and & + - ! ? . / :",
        )


def text_rings(
    text: str, height: float, gap: float
) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
    """Return outer and inner walls (n, 2) of a line of text that reads from heel to toe, m.

    Seen from below; the foot of its capitals at y = +height/2, their top at -height/2. Letters
    stand ``gap`` apart.

    Parameters:
        text: As ``check_text`` allows.
        height: Of a capital, m.
        gap: Between neighbours, m.
    """
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    font = FontProperties(family="DejaVu Sans", weight="bold")

    def rings(letter: str) -> list[np.ndarray]:
        return [
            np.asarray(ring)[:-1]
            for ring in TextPath((0, 0), letter, _SIZE, prop=font).to_polygons()
        ]

    scale = height / np.ptp(rings("H")[0][:, 1])
    shells, holes, at = [], [], 0.0
    for letter in text:
        if letter == " ":
            at += _SPACE * height
            continue
        walls = [ring * scale for ring in rings(letter)]
        left, right = (
            end(ring[:, 0])
            for end, ring in ((np.min, np.vstack(walls)), (np.max, np.vstack(walls)))
        )
        for ring in walls:
            x, y = ring.T
            placed = np.column_stack([x - left + at, height / 2 - y])
            # outer walls of a TrueType glyph run clockwise, inner ones anticlockwise
            outer = np.dot(x, np.roll(y, -1)) < np.dot(y, np.roll(x, -1))
            (shells if outer else holes).append(placed)
        at += right - left + gap
    return tuple(shells), tuple(holes)
