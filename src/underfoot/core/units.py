"""Units at the door: text with a unit becomes an SI float; SI floats become readable text."""

import math
import re
from decimal import Decimal
from functools import cache
from typing import Any

from .errors import InputError, nearest_match
from .remark import Message
from .typed import split_quantity

_EXAMPLES = {
    "m": "3 mm",
    "m/s": "0.7 m/s",
    "m/s^2": "9.81 m/s^2",
    "N": "500 N",
    "Pa": "5.0 MPa",
    "Pa*s": "219 cP",
    "rad": "10 deg",
    "rad/s": "100 rad/s",
    "Hz": "1 kHz",
    "s": "30 ms",
    "1/s": "0.013 1/s",
    "K": "20 degC",
    "kg": "70 kg",
    "kg/m^3": "1100 kg/m^3",
    "m^2": "10 mm^2",
    "m^3": "100 cm^3",
    "N/m": "200 N/mm",
    "m^3/Pa": "0.3 mm^3/MPa",
    "1/m": "4 1/mm",
    "1": "0.5",
}
_ALIASES = {
    "%": "percent",
    "deg C": "degC",
    "deg F": "degF",
    "cps": "cP",
    "mPas": "mPa*s",
    "Pas": "Pa*s",
    '"': "inch",
    "in": "inch",
    "in.": "inch",
    "''": "inch",
    "lbs": "lb",
    "Grad": "deg",
    "mil": "thou",
}
_SHARES = {"percent", "permille", "ppm"}
_SIGNS = str.maketrans(
    {"µ": "u", "μ": "u", "°": "deg", "²": "^2", "³": "^3", "⁻": "^-", "¹": "1",
     "·": "*", "⋅": "*", "∙": "*", "×": "*", "″": '"', "”": '"'}
)  # fmt: skip
_NO_UNIT = re.compile(r"(?!1 ?/)[\d+\-/*.,;:=<>~#±≈≤≥!?]|[A-Za-z]+\d\d")
"""What no unit begins with: behind a number it makes of it a range, a tolerance, a sum, a code."""
_KNOWN = (
    "m mm um nm cm inch N kN mN kgf lbf Pa kPa MPa GPa psi bar cP mPa*s Pa*s P m/s mm/s cm/s "
    "s ms us min rad deg degC degF K kg g Hz kHz rad/s mm^2 cm^2 m^2 cm^3 N/mm 1/s 1/mm kg/m^3 "
    "g/cm^3 "
    "percent"
).split()
# Powers of ten of the units people write most: a unit library takes a second to start, and moving
# the decimal point is exact.
_POWERS: dict[str, dict[str, int]] = {
    "m": {"m": 0, "mm": -3, "um": -6, "nm": -9, "cm": -2},
    "m/s": {"m/s": 0, "mm/s": -3, "cm/s": -2},
    "N": {"N": 0, "kN": 3, "mN": -3},
    "Pa": {"Pa": 0, "kPa": 3, "MPa": 6, "GPa": 9},
    "Pa*s": {"Pa*s": 0, "cP": -3, "mPa*s": -3},
    "s": {"s": 0, "ms": -3, "us": -6},
    "kg": {"kg": 0, "g": -3},
    "kg/m^3": {"kg/m^3": 0, "g/cm^3": 3},
    "Hz": {"Hz": 0, "kHz": 3},
    "rad": {"rad": 0},
    "1/s": {"1/s": 0},
    "1/m": {"1/m": 0, "1/mm": 3},
    "K": {"K": 0},
    "m^2": {"m^2": 0, "cm^2": -4, "mm^2": -6},
    "m^3": {"m^3": 0, "cm^3": -6, "mm^3": -9},
    "m^3/Pa": {"m^3/Pa": 0, "mm^3/MPa": -15},
    "N/m": {"N/m": 0, "N/mm": 3, "kN/mm": 6},
    "B": {"B": 0, "kB": 3, "MB": 6, "GB": 9},
    "1": {"percent": -2},
}


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True, cache_folder=None)


def to_si(given: object, unit: str, *, where: str, usual: str = "", comma: bool = False) -> float:
    """Return ``given`` (text such as ``"219 cP"``) as a float in the SI unit ``unit``.

    Numbers are read as ``underfoot.core.typed.split_quantity`` says. Plain numbers are accepted
    only where ``unit`` is ``"1"`` (dimensionless) or ``usual`` stands beside the field: elsewhere a
    number without a unit is refused, because guessing it would change results silently.

    Parameters:
        given: Text, or a number.
        unit: The SI unit that is wanted.
        where: Named in errors.
        usual: Unit of a number without one, "" for none.
        comma: The writer's decimal sign is the comma.

    Raises:
        InputError: Unit missing, unknown or of another dimension; text that is no number or can be
            read as two; not finite.

    >>> to_si("219 cP", "Pa*s", where="contaminant.viscosity")
    0.219
    """
    example = f"5 {usual}" if usual else _EXAMPLES.get(unit, f"1 {unit}")
    if isinstance(given, bool):
        raise InputError(
            Message("{given} is not a number", given=given),
            where=where,
            allowed=Message('for example "{example}"', example=example),
        )
    if isinstance(given, int | float):
        if unit == "1":
            return _finite(float(given), given, where)
        raise _no_unit(given, unit, where, example)
    if not isinstance(given, str):
        raise InputError(
            Message("{given} is not a quantity", given=repr(given)),
            where=where,
            allowed=Message('text such as "{example}"', example=example),
        )
    number, text = _split(given, where, comma, example)
    text = text or usual
    if not text and unit != "1":
        raise _no_unit(given, unit, where, example)
    if not text:
        return _finite(number, given, where)
    if unit == "K" and text in ("C", "F"):
        text = "deg" + text
    value = _convert(number, text, unit, given, where, example, usual or unit)
    return _finite(value, given, where)


def spread_to_si(given: object, of: object, unit: str, *, where: str) -> float:
    """Return a standard deviation as written beside a value, in the SI unit ``unit``.

    Degrees of temperature are differences (2 degC is 2 K). Percent are shares of a value in
    percent, else a share of what is asked: 10 % of 68 is no 0.1.

    Parameters:
        given: Text, or a number.
        of: The value as written.
        unit: The SI unit that is wanted.
        where: Named in errors.

    Raises:
        InputError: As ``to_si``; percent beside a value without.

    >>> spread_to_si("3.6 degF", "68 degF", "K", where="temperature")
    2.0
    """
    if unit == "1" and not _in_percent(of):
        refuse_percent(given, where=where)
    value = to_si(given, unit, where=where)
    if unit != "K" or not isinstance(given, str):
        return value
    name = _split(given, where, False, "2 K")[1]
    return round(value - to_si(f"0 {name}", unit, where=where), 9)


def _in_percent(given: object) -> bool:
    """Return whether a value is written in percent, or is this unit."""
    if not isinstance(given, str):
        return False
    try:
        parts = split_quantity(given)
    except InputError:  # whoever reads the number says what is wrong with it
        return False
    return (given if parts is None else parts[1]).strip() == "%"


def refuse_percent(given: object, *, where: str) -> None:
    """Refuse a standard deviation in percent beside a plain number: of the value, or hundredths?

    Parameters:
        given: As written.
        where: Named in the error.

    Raises:
        InputError: It is in percent.
    """
    if _in_percent(given):
        raise InputError(
            Message("{given} can be of the value or in its unit", given=given),
            where=where,
            allowed="the standard deviation in the unit of the value",
        )


def si_unit(given: str, *, where: str) -> str:
    """Return the SI unit (as used by ``to_si``) that fits a text such as ``"219 cP"``.

    Errors:
        InputError: No number, or a unit that fits none of the units in use.
    """
    _, text = _split(given, where, False, "219 cP")
    if not text:
        return "1"
    for unit, names in _POWERS.items():
        if unit in _EXAMPLES and text in names:
            return unit
    for unit in _EXAMPLES:
        try:
            to_si(given, unit, where=where)
        except InputError:
            continue
        return unit
    raise InputError(_unknown_unit(given, text), where=where, nearest=nearest_match(text, _KNOWN))


def _unknown_unit(given: str, unit: str) -> Message:
    return Message('"{given}": unknown unit "{unit}"', given=given, unit=unit)


def _no_unit(given: object, unit: str, where: str, example: str) -> InputError:
    return InputError(
        Message("{given} has no unit", given=given),
        where=where,
        allowed=Message("a number with a unit of {unit}", unit=unit),
        remedy=Message('Write it as text with its unit, for example "{example}"', example=example),
    )


def _split(given: str, where: str, comma: bool, example: str) -> tuple[float, str]:
    """Return number and unit of a text, the unit as this module writes it."""
    try:
        parts = split_quantity(given, comma=comma)
    except InputError as error:
        error.where = where
        raise
    if parts is None or _NO_UNIT.match(parts[1]):
        raise InputError(
            Message('"{given}" is not a number with a unit', given=given),
            where=where,
            allowed=Message('for example "{example}"', example=example),
        )
    number, text = parts
    text = re.sub(r"(?<=[A-Za-z])[ .](?=[A-Za-z])", "*", text.translate(_SIGNS).strip())
    text = re.sub(r"(?<=[a-z])([23])(?!\d)", r"^\1", text)  # cm3
    text = re.sub(r"^deg\*", "deg ", text.replace("^-^", "^-"))
    return number, _ALIASES.get(text, text)


def _convert(
    number: float, text: str, unit: str, given: str, where: str, example: str, shown: str
) -> float:
    power = _POWERS.get(unit, {}).get(text)
    if power is not None:
        return float(Decimal(repr(number)).scaleb(power))
    if unit == "K" and text == "degC":
        return float(Decimal(repr(number)) + Decimal("273.15"))
    if unit == "rad" and text == "deg":
        return math.radians(number)
    if unit == "1":
        raise InputError(
            Message('"{given}" has a unit, this quantity has none', given=given),
            where=where,
            allowed=Message('for example "{example}"', example=example),
            remedy=Message('Write {number:g}, without "{text}"', number=number, text=text),
        )
    import pint

    registry = _registry()
    try:
        quantity = registry.Quantity(number, text)
    except Exception as error:
        raise InputError(
            _unknown_unit(given, text),
            where=where,
            allowed=Message('a unit of {si}, for example "{example}"', si=unit, example=example),
            nearest=nearest_match(text, _KNOWN),
        ) from error
    target = {"K": "kelvin"}.get(unit, unit)
    refused = InputError(
        Message('"{given}" is not a value in {shown}', given=given, shown=shown),
        where=where,
        allowed=Message('for example "{example}"', example=example),
    )
    try:
        value = float(quantity.to(target).magnitude)
    except pint.DimensionalityError as error:
        raise refused from error
    # what the library takes for pure numbers: shares, and angles beside none
    units = {registry.parse_unit_name(name)[0][1] for name, _ in quantity.unit_items()}
    if text == "grad" or units & _SHARES:  # degrees, or gon
        raise refused
    roots = registry.Quantity(1.0, registry.get_root_units(quantity.units)[1])
    angles = "radian" in dict(roots.unit_items())
    if angles == ("rad" in unit):
        return value
    if unit == "Hz" and angles:
        return value / math.tau
    if unit == "rad/s" and "hertz" in units:
        return math.tau * value
    if unit in ("rad", "1/s", "Hz"):
        raise refused
    return value


def _finite(value: float, given: object, where: str) -> float:
    if not math.isfinite(value):
        raise InputError(
            Message("{given} is not finite", given=given), where=where, allowed="a finite number"
        )
    return value
