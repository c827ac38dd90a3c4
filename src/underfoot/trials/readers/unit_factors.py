"""Units written in measurement files, as factors to SI.

A table instead of a unit library: files are read by the hundred, and the units that
instruments write are few. Masses used as forces follow standard gravity, 9.80665 m/s^2.
"""

from __future__ import annotations

import math

_GRAVITY = 9.80665
_FACTORS: dict[str, tuple[str, float]] = {
    "n": ("N", 1.0),
    "newton": ("N", 1.0),
    "newtons": ("N", 1.0),
    "kn": ("N", 1e3),
    "mn": ("N", 1e-3),
    "g": ("N", _GRAVITY * 1e-3),
    "gf": ("N", _GRAVITY * 1e-3),
    "kgf": ("N", _GRAVITY),
    "lbf": ("N", 4.4482216152605),
    "nm": ("N*m", 1.0),
    "n*m": ("N*m", 1.0),
    "nmm": ("N*m", 1e-3),
    "n*mm": ("N*m", 1e-3),
    "ncm": ("N*m", 1e-2),
    "m": ("m", 1.0),
    "meter": ("m", 1.0),
    "meters": ("m", 1.0),
    "cm": ("m", 1e-2),
    "mm": ("m", 1e-3),
    "um": ("m", 1e-6),
    "micron": ("m", 1e-6),
    "in": ("m", 0.0254),
    "inch": ("m", 0.0254),
    "s": ("s", 1.0),
    "sec": ("s", 1.0),
    "second": ("s", 1.0),
    "seconds": ("s", 1.0),
    "ms": ("s", 1e-3),
    "msec": ("s", 1e-3),
    "us": ("s", 1e-6),
    "min": ("s", 60.0),
    "h": ("s", 3600.0),
    "m/s": ("m/s", 1.0),
    "m/sec": ("m/s", 1.0),
    "mm/s": ("m/s", 1e-3),
    "mm/sec": ("m/s", 1e-3),
    "cm/s": ("m/s", 1e-2),
    "pa": ("Pa", 1.0),
    "kpa": ("Pa", 1e3),
    "mpa": ("Pa", 1e6),
    "gpa": ("Pa", 1e9),
    "bar": ("Pa", 1e5),
    "mbar": ("Pa", 1e2),
    "psi": ("Pa", 6894.757293168361),
    "deg": ("rad", math.pi / 180.0),
    "rad": ("rad", 1.0),
    "rpm": ("rad/s", math.pi / 30.0),
    "hz": ("Hz", 1.0),
    "khz": ("Hz", 1e3),
    "v": ("V", 1.0),
    "mv": ("V", 1e-3),
    "%": ("1", 1e-2),
    "-": ("1", 1.0),
    "1": ("1", 1.0),
    "k": ("K", 1.0),
}
# Spellings in which capitals decide between two units.
_EXACT: dict[str, tuple[str, float]] = {
    "MN": ("N", 1e6),
    "nm": ("m", 1e-9),
    "mPa": ("Pa", 1e-3),
    "Nm": ("N*m", 1.0),
    "NM": ("N*m", 1.0),
}
_CELSIUS = {"degc", "c", "deg c", "celsius"}


def si_unit(text: str) -> tuple[str, float, float] | None:
    """Return (SI unit, factor, offset) of a unit as written in a file, or None if unknown.

    ``si = factor * value + offset``.
    """
    plain = text.strip().strip("[]()").replace("µ", "u").replace("μ", "u").replace("°", "deg")
    plain = plain.replace("Â", "").replace("·", "*").replace(".", "*").replace("−", "-")
    if plain in _EXACT:
        return (*_EXACT[plain], 0.0)
    lowered = plain.casefold().replace("^", "").replace(" ", "")
    if lowered in _CELSIUS:
        return "K", 1.0, 273.15
    found = _FACTORS.get(lowered)
    return (*found, 0.0) if found else None


def known_units() -> list[str]:
    """Return the spellings understood, for messages."""
    return sorted({*_FACTORS, *_EXACT, "degC"})
