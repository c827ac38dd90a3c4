"""Numbers and quantities as people read them, in the units that were asked for."""

import math
import os

_SCALES = {
    "m": ((1.0, "m"), (1e-3, "mm"), (1e-6, "um"), (1e-9, "nm")),
    "Pa": ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa"), (1.0, "Pa")),
    "s": ((1.0, "s"), (1e-3, "ms"), (1e-6, "us")),
    "N": ((1e3, "kN"), (1.0, "N"), (1e-3, "mN")),
    "Pa*s": ((1e-3, "cP"),),
    "rad": ((math.pi / 180.0, "deg"),),
    "m^2": ((1e-4, "cm^2"), (1e-6, "mm^2")),
    "m^3": ((1e-6, "cm^3"), (1e-9, "mm^3")),
    "N/m": ((1e6, "kN/mm"), (1e3, "N/mm"), (1.0, "N/m")),
}
_US_SCALES = {
    "m": ((25.4e-3, "in"), (25.4e-6, "mil")),
    "Pa": ((6894.757293168, "psi"),),
    "N": ((4.4482216152605, "lbf"),),
    "m/s": ((0.3048, "ft/s"),),
    "m^2": ((6.4516e-4, "in^2"),),
    "m^3": ((1.6387064e-5, "in^3"),),
    "kg": ((0.45359237, "lb"),),
}
"""Inch, pound and second: scales that take the place of the metric ones in output."""
_LEAST = {"in": 0.01}
"""Size in a unit down to which it is used; 1 elsewhere."""
UNITS_VARIABLE = "UNDERFOOT_UNITS"
"""Environment variable that names the units of output, so that worker processes know them."""
SYSTEMS = ("si", "us")


def display(value: float, unit: str, digits: int = 3) -> str:
    """Return an SI value as short text in a unit people read, for example ``"219 cP"``.

    >>> display(0.219, "Pa*s")
    '219 cP'
    """
    if not math.isfinite(value):
        return "not a number"
    factor, name = display_unit(value, unit)
    number = number_text(value / factor, digits)
    return number if name == "1" else f"{number} {name}"


def number_text(value: float, digits: int) -> str:
    """Return a number with significant digits, without an exponent where people write none."""
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e" in text and 1e-3 <= abs(value) < 1e6 else text


_LEAST_SHOWN, _MOST_SHOWN = 1e-6, 1e6


def plain_number(value: float, digits: int = 3) -> str:
    """Return a number without a unit as people read it: no exponent, bounds of what is too far out.

    >>> plain_number(9.19e-12), plain_number(2.61e-05), plain_number(5.8e16)
    ('below 0.000001', '0.0000261', 'above 1,000,000')
    """
    if math.isnan(value):
        return "not a number"
    size = abs(value)
    if 0.0 < size < _LEAST_SHOWN:
        return f"below {_LEAST_SHOWN:.6f}" if value > 0 else f"above -{_LEAST_SHOWN:.6f}"
    if size >= _MOST_SHOWN:
        return f"above {_MOST_SHOWN:,.0f}" if value > 0 else f"below -{_MOST_SHOWN:,.0f}"
    if 0.0 < size < 1e-4:
        return f"{value:.{digits - 1 - math.floor(math.log10(size))}f}"
    return number_text(value, digits)


def unit_system() -> str:
    """Return the units of output: "si", or "us" where inches and pounds were asked for."""
    return os.environ.get(UNITS_VARIABLE, SYSTEMS[0])


def display_unit(value: float, unit: str) -> tuple[float, str]:
    """Return (factor, name) of the unit in which ``value`` has a readable size."""
    scales = (_US_SCALES.get(unit) if unit_system() == "us" else None) or _SCALES.get(unit)
    if scales is None:
        return 1.0, unit
    if value == 0.0:
        return next((scale for scale in scales if scale[0] == 1.0), scales[0])
    for factor, name in scales:
        if abs(value) >= factor * 0.9995 * _LEAST.get(name, 1.0):
            return factor, name
    return scales[-1]


def tread_unit(unit: str) -> tuple[float, str]:
    """Return (factor, name) of the one unit that a table of treads gives a quantity in.

    Millimetres and their powers, newtons and kilopascals; inches and pounds where asked for.
    """
    if unit_system() == "us" and unit in _US_SCALES:
        return _US_SCALES[unit][0]
    metric = {"m": (1e-3, "mm"), "m^2": (1e-6, "mm^2"), "m^3": (1e-9, "mm^3"), "Pa": (1e3, "kPa")}
    return metric.get(unit, (1.0, unit))


def metres(length: float, digits: int = 4) -> str:
    """Return a length (m) as people write it: 3.125e-5 as "31.25 um"."""
    return display(length, "m", digits)
