"""Which unit a file is in: a sole is 150 to 350 mm long, a heel piece 40 to 110 mm."""

from __future__ import annotations

from underfoot.core import InputError

from .settings import UNITS

SOLE = (0.150, 0.350)
"""Length of a whole sole, m."""
HEEL = (0.040, 0.110)
"""Length of a heel piece, m."""
SLENDER = 1.7
"""A whole sole is longer than this many widths, a heel piece shorter."""
_POSSIBLE = (0.020, 0.500)  # m: beyond it a unit given by hand is refused


def length_unit(
    length: float, width: float, *, given: str = "auto", told: float | None = None, where: str
) -> tuple[float, str]:
    """Return the file's unit in m and how it was found, in words.

    Parameters
    ----------
    length, width
        Longest extent and the one across, in the file's unit.
    given
        Unit the user names, or "auto".
    told
        Unit the format itself tells (STEP), m.

    Errors
    ------
    InputError
        No unit makes it as long as a sole, or the unit given makes it absurd.
    """
    if given != "auto":
        unit = UNITS[given]
        if not _POSSIBLE[0] <= length * unit <= _POSSIBLE[1]:
            raise InputError(
                f"in {given} the sole is {_shown(length * unit)} long",
                where=where,
                allowed="20 mm to 500 mm",
                remedy=_suggestion(length, width),
            )
        return unit, f"Unit {given}, as given: {_shown(length * unit)} long."
    if told is not None:
        if not _POSSIBLE[0] <= length * told <= _POSSIBLE[1]:
            raise InputError(
                f"by the unit in the file the sole is {_shown(length * told)} long",
                where=where,
                allowed="20 mm to 500 mm",
                remedy=_suggestion(length, width),
            )
        return told, f"The file tells its unit: {_shown(length * told)} long."
    likely = _likely(length, width)
    if not likely:
        lengths = ", ".join(f"{_shown(length * unit)} in {name}" for name, unit in UNITS.items())
        raise InputError(
            f"no unit makes it a sole: its length of {length:.4g} would be {lengths}",
            where=where,
            allowed="150 to 350 mm for a sole, 40 to 110 mm for a heel piece",
            remedy="Give the unit, if it is right all the same, or check that the file holds one "
            "outsole alone",
        )
    name = likely[0]
    metres = length * UNITS[name]
    kind = "sole" if metres >= SOLE[0] else "heel piece"
    words = (
        f"Assumed: the file is in {name} (it tells no unit): {_shown(metres)} long, as a {kind} is."
    )
    if len(likely) > 1:
        words += f" It could also be {likely[1]} ({_shown(length * UNITS[likely[1]])})."
    return UNITS[name], words


def _likely(length: float, width: float) -> list[str]:
    slender = length > SLENDER * width
    ranges = (SOLE, HEEL) if slender else (HEEL, SOLE)
    return [
        name
        for low, high in ranges
        for name in ("mm", "m", "inch", "cm")
        if low <= length * UNITS[name] <= high
    ]


def _suggestion(length: float, width: float) -> str | None:
    likely = _likely(length, width)
    return f"It would be {_shown(length * UNITS[likely[0]])} in {likely[0]}" if likely else None


def _shown(metres: float) -> str:
    return f"{metres * 1e3:.4g} mm" if metres < 1 else f"{metres:.4g} m"
