"""Checks of single inputs: where they stand and what is allowed."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .arrays import Array
from .errors import InputError, unknown_name
from .remark import Message


def positive(value: float, where: str, unit: str = "") -> float:
    """Return ``value`` as a float; refuse one that is not a finite number above 0."""
    if not (math.isfinite(value) and value > 0):
        raise InputError(
            Message("{value} is not positive", value=_with_unit(value, unit)),
            where=where,
            allowed=Message("a finite number above {bound}", bound=_with_unit(0, unit)),
        )
    return float(value)


def not_negative(value: float, where: str, unit: str = "") -> float:
    """Return ``value`` as a float; refuse one that is not a finite number of at least 0."""
    if not (math.isfinite(value) and value >= 0):
        raise InputError(
            Message("{value} is negative or not finite", value=_with_unit(value, unit)),
            where=where,
            allowed=Message("a finite number, {bound} or more", bound=_with_unit(0, unit)),
        )
    return float(value)


def between(value: float, low: float, high: float, where: str, allowed: str = "") -> float:
    """Return ``value``; refuse one outside [low, high], which ``allowed`` says in words."""
    if not low <= value <= high:
        raise InputError(
            Message("{value:g} is out of range", value=value),
            where=where,
            allowed=allowed or Message("{low:g} to {high:g}", low=low, high=high),
        )
    return float(value)


def positive_array(values: ArrayLike, where: str, *, zero: bool = False) -> Array:
    """Return ``values`` as an array of finite numbers above 0 (with ``zero``: 0 or more)."""
    array = np.asarray(values, dtype=float)
    good = np.isfinite(array) & ((array >= 0) if zero else (array > 0))
    if array.size == 0 or not good.all():
        bound = "of 0 or more" if zero else "above 0"
        what = "an empty array"
        if array.size:
            wrong = array[~good].flat[0]
            what = Message("{wrong:g} is not a finite number above 0", wrong=wrong)
            if zero:
                what = Message("{wrong:g} is not a finite number of 0 or more", wrong=wrong)
        raise InputError(what, where=where, allowed=f"{bound}, in SI")
    return array


def host_array(values: Any, where: str, allowed: str, remedy: str = "") -> Any:
    """Return ``values`` as an array of NumPy; refuse what it can't read, such as a device's."""
    try:
        return np.asarray(values)
    except (TypeError, ValueError, RuntimeError) as error:
        raise InputError(
            Message(
                "{where} ({name}) can't be read by NumPy: {error}",
                where=where,
                name=type(values).__name__,
                error=error,
            ),
            where=where,
            allowed=allowed,
            remedy=remedy or "Bring it to the processor first, for example numpy.asarray(x.cpu())",
        ) from error


def choice(value: str, allowed: Iterable[str], where: str) -> str:
    """Return ``value``; refuse a word that is none of ``allowed``, with the nearest one."""
    allowed = tuple(allowed)
    if value not in allowed:
        kind = where.rpartition(".")[2].replace("_", " ")
        raise unknown_name(kind, str(value), allowed, where=where)
    return value


def exactly_one(given: Mapping[str, object], missing: str, where: str, allowed: str) -> str:
    """Return the key whose value is given; refuse none (``missing`` says of what) and several."""
    names = [name for name, value in given.items() if value is not None]
    if len(names) != 1:
        what = f"{' and '.join(names)} together" if names else missing
        raise InputError(what, where=where, allowed=allowed)
    return names[0]


def poisson_ratio(value: float, where: str = "poisson_ratio") -> float:
    """Return Poisson's ratio; refuse one outside 0 to 0.5."""
    if not 0.0 <= value <= 0.5:
        raise InputError(
            Message("Poisson's ratio {poisson_ratio:g}", poisson_ratio=value),
            where=where,
            allowed="0 to 0.5",
        )
    return float(value)


def _with_unit(value: float, unit: str) -> str:
    return f"{value:g} {unit}".rstrip()
