"""Units written in measurement files, as factors to SI.

A table instead of a unit library: files are read by the hundred, and the units that
instruments write are few. Masses used as forces follow standard gravity, 9.80665 m/s^2.
"""

import math

_GRAVITY = 9.80665
_FACTORS: dict[str, tuple[str, float]] = {
    name: (si, factor)
    for si, spellings in {
        "N": {
            "n newton newtons": 1.0, "kn": 1e3, "mn": 1e-3, "g gf": _GRAVITY * 1e-3,
            "kgf": _GRAVITY, "lbf": 4.4482216152605,
        },
        "N*m": {"nm n*m": 1.0, "nmm n*mm": 1e-3, "ncm": 1e-2},
        "m": {
            "m meter meters": 1.0, "cm": 1e-2, "mm": 1e-3, "um micron": 1e-6, "in inch": 0.0254,
        },
        "s": {
            "s sec second seconds": 1.0, "ms msec": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0,
        },
        "m/s": {"m/s m/sec": 1.0, "mm/s mm/sec": 1e-3, "cm/s": 1e-2},
        "Pa": {
            "pa": 1.0, "kpa": 1e3, "mpa": 1e6, "gpa": 1e9, "bar": 1e5, "mbar": 1e2,
            "psi": 6894.757293168361,
        },
        "rad": {"deg": math.pi / 180.0, "rad": 1.0},
        "rad/s": {"rpm": math.pi / 30.0},
        "Hz": {"hz": 1.0, "khz": 1e3},
        "V": {"v": 1.0, "mv": 1e-3},
        "1": {"%": 1e-2, "-": 1.0, "1": 1.0},
        "K": {"k": 1.0},
    }.items()
    for names, factor in spellings.items()
    for name in names.split()
}  # fmt: skip
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


def in_si(text: str) -> tuple[str, float, float]:
    """Return what ``si_unit`` does; an unknown unit is empty and keeps the numbers."""
    return si_unit(text) or ("", 1.0, 0.0)


def known_units() -> list[str]:
    """Return the spellings understood, for messages."""
    return sorted({*_FACTORS, *_EXACT, "degC"})
