"""What a study varies: ranges and lists that a designer chooses, distributions that nobody does."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtri

from underfoot.case import unit_at
from underfoot.case.parts import CATALOGUE_SECTIONS, field_at, keys, path_kind
from underfoot.case.section import quantity_of
from underfoot.core import InputError, RangeError, display, to_si, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.catalogue import Catalogue
from underfoot.core.errors import missing_file
from underfoot.core.remark import Message
from underfoot.core.units import spread_to_si

TAIL = 1e-3
"""Share of a distribution beyond either end that a study leaves out."""
WIDEST = 1e6
"""Factor of a lognormal distribution at most."""
OUTSIDE = 0.025
"""Share of a distribution that may lie beyond the physical range, where it is held."""


@dataclass(frozen=True, slots=True)
class Range:
    """Values between two ends (SI), even on a linear or a logarithmic scale."""

    path: str
    low: float
    high: float
    logarithmic: bool = False
    steps: int | None = None

    def value(self, share: float) -> float:
        """Return the value at a share of the way from the low end."""
        if self.logarithmic:
            return float(self.low * (self.high / self.low) ** share)
        return float(self.low + share * (self.high - self.low))

    def shares(self) -> list[float]:
        """Return the places of the steps of a grid."""
        return np.linspace(0.0, 1.0, self.steps or 0).tolist()


@dataclass(frozen=True, slots=True)
class Choice:
    """One of several values or names."""

    path: str
    options: tuple[Any, ...]

    def value(self, share: float) -> Any:
        """Return the option in whose equal part of 0 to 1 the share lies."""
        return self.options[min(int(share * len(self.options)), len(self.options) - 1)]

    def shares(self) -> list[float]:
        """Return the middle of each part."""
        return [(k + 0.5) / len(self.options) for k in range(len(self.options))]


@dataclass(frozen=True, slots=True)
class Follow:
    """A value that keeps its ratio to a varied one."""

    path: str
    of: str
    times: float


@dataclass(frozen=True, slots=True)
class Distribution:
    """A value that nobody chooses: normal (mean, sd), log-normal (median, factor) or even.

    Draws beyond ``low`` and ``high``, the physical range, are held there.
    """

    path: str
    kind: str
    centre: float
    spread: float
    low: float = -math.inf
    high: float = math.inf

    def value(self, share: float) -> float:
        """Return the quantile at a share, the outermost ``TAIL`` at either end left out."""
        z = float(ndtri(TAIL + (1 - 2 * TAIL) * share))
        drawn = {
            "uniform": self.centre + self.spread * share,
            "normal": self.centre + self.spread * z,
            "lognormal": self.centre * self.spread**z,
        }[self.kind]
        return min(max(drawn, self.low), self.high)


Input = Range | Choice


@dataclass(frozen=True, slots=True)
class JointDraws:
    """Draws of several values together, (draws, paths), as a calibration left them."""

    paths: tuple[str, ...]
    values: Array

    def rows(self, count: int) -> list[dict[str, float]]:
        """Return ``count`` rows, evenly taken, as path and value."""
        chosen = np.linspace(0, len(self.values) - 1, count).round().astype(int)
        return [dict(zip(self.paths, map(float, self.values[k]), strict=True)) for k in chosen]


def read_input(path: str, given: Any, known: Catalogue) -> Input | Follow:
    """Return what ``[vary]`` says of one path."""
    path_kind(path)  # refuses a path that no case has
    if isinstance(given, list | tuple):
        return read_choice(path, given, known)
    if isinstance(given, Mapping) and set(given) <= {"times", "of"} and given:
        if not isinstance(given.get("of"), str):
            raise InputError("is missing", where=".of", allowed="a path of [vary]")
        return Follow(path, given["of"], _number(given.get("times", 1.0), ".times", 0.0))
    form = '{ from = "1 mm", to = "4 mm" }, a list, or { times = 1.5, of = "path" }'
    if not isinstance(given, Mapping) or not {"from", "to"} <= set(given):
        raise InputError(Message("{given} is no range", given=repr(given)), allowed=form)
    allowed = ("from", "to", "log", "steps")
    for key in set(given) - set(allowed):
        raise unknown_name("key", key, allowed)
    low, high = (value_at(path, given[end], known, f".{end}") for end in ("from", "to"))
    if not isinstance(low, float) or not isinstance(high, float):
        raise InputError("is no number", allowed="a list of names")
    if not low < high:
        raise RangeError(
            Message("from {low} to {high} is no range", low=given["from"], high=given["to"]),
            allowed="from < to",
        )
    logarithmic, steps = given.get("log", False), given.get("steps")
    if not isinstance(logarithmic, bool):
        raise InputError(f"{logarithmic!r}", where=".log", allowed="true or false")
    if logarithmic and low <= 0:
        raise RangeError(f"{given['from']}", where=".from", allowed="above 0 with log")
    if steps is not None and (
        isinstance(steps, bool) or not isinstance(steps, int) or not 2 <= steps <= 10**6
    ):
        raise InputError(f"{steps!r}", where=".steps", allowed="a whole number from 2 to 10^6")
    return Range(path, low, high, logarithmic, steps)


def read_choice(path: str, given: Sequence[Any], known: Catalogue) -> Choice:
    """Return the values or names of a list."""
    options = tuple(value_at(path, item, known, f"[{k}]") for k, item in enumerate(given))
    if not options or len(set(map(str, options))) < len(options):
        raise InputError(f"{list(given)!r}", allowed="different values, at least one")
    return Choice(path, options)


def read_distribution(path: str, given: Any, known: Catalogue) -> Distribution:
    """Return what ``[uncertain]`` says of one path."""
    path_kind(path)
    forms = {"normal": "sd", "lognormal": "factor", "from": "to"}
    kind = next((name for name in forms if isinstance(given, Mapping) and name in given), None)
    if kind is None or set(given) != {kind, forms[kind]}:
        raise InputError(
            Message("{given} is no distribution", given=repr(given)),
            allowed='{ normal = "60 cP", sd = "5 cP" }, { lognormal = 2.0, factor = 1.3 } or '
            '{ from = "1 mm", to = "2 mm" } (even)',
        )
    centre = value_at(path, given[kind], known, f".{kind}")
    if not isinstance(centre, float):
        raise InputError("is no number", where=f".{kind}", allowed="the path of a number")
    unit, second, place = unit_at(path), given[forms[kind]], f".{forms[kind]}"
    if kind == "lognormal":
        spread = _number(second, place, 1.0)
        if spread > WIDEST:
            raise RangeError(
                f"{second}", where=place, allowed=Message("up to {most:g}", most=WIDEST)
            )
        if centre <= 0:
            raise RangeError(f"{given[kind]}", where=f".{kind}", allowed="above 0")
    else:
        spread = (
            to_si(second, unit, where=place) - centre
            if kind == "from"
            else spread_to_si(second, given[kind], unit, where=place)
        )
        if spread <= 0:
            raise RangeError(f"{second}", where=place, allowed="above 0, from < to")
    distribution = Distribution(path, "uniform" if kind == "from" else kind, centre, spread)
    field = field_at(path)
    quantity = None if field is None else quantity_of(field)
    if quantity is None:
        return distribution
    for share in (OUTSIDE, 1 - OUTSIDE):
        value = distribution.value(share)
        if not quantity.low <= value <= quantity.high:
            raise RangeError(
                Message(
                    "reaches {value} at {share:.1%} of it", value=display(value, unit), share=share
                ),
                allowed=quantity.range_text(),
                remedy="Narrow it, or take lognormal for what is positive",
            )
    return replace(distribution, low=quantity.low, high=quantity.high)


def value_at(path: str, given: Any, known: Catalogue, where: str = "") -> Any:
    """Return a given value in SI, or a name that is known at its path; ``where`` is for errors."""
    path_kind(path)
    field = field_at(path)
    if path in keys():
        options = keys()[path].options()
        if str(given) not in options and ":" not in str(given):
            raise unknown_name("choice", str(given), options, where=where)
        return given
    if field is None:
        kind = CATALOGUE_SECTIONS.get(path.removesuffix(".from"), ("", ""))[0]
        if not kind or not isinstance(given, str):
            raise InputError(
                Message("{given} can't be used here", given=repr(given)),
                where=where,
                allowed="the name of an entry",
            )
        names = [*known.names(kind), *(["none"] if kind == "fluid" else [])]
        if given not in names:
            raise unknown_name(kind, given, names, where=where)
        return given
    quantity = quantity_of(field)
    if quantity is None:
        return given
    value = to_si(given, quantity.unit, where=where)
    if not quantity.low <= value <= quantity.high or (quantity.open_low and value == quantity.low):
        raise RangeError(
            Message("{text} is outside the physical range", text=given),
            where=where,
            allowed=quantity.range_text(),
        )
    return value


def read_joint_draws(path: Path) -> JointDraws:
    """Return the draws of a posterior file: CSV, one column a path (SI), ``#`` lines before it."""
    import pandas

    try:
        table = pandas.read_csv(path, comment="#")
        values = table.to_numpy(dtype=float)
    except FileNotFoundError:
        raise missing_file(path, "*.csv") from None
    except (OSError, ValueError) as error:
        raise InputError(
            Message("{path} can't be read ({strerror})", path=path, strerror=error)
        ) from error
    if len(values) < 2 or not np.isfinite(values).all():
        raise InputError(Message("{path} holds no table of finite draws", path=path))
    for name in table.columns:
        path_kind(str(name))
    return JointDraws(tuple(map(str, table.columns)), values)


def _number(given: Any, where: str, above: float) -> float:
    good = isinstance(given, int | float) and not isinstance(given, bool)
    if not good or not above < float(given) < math.inf:
        raise InputError(
            f"{given!r}", where=where, allowed=Message("a number above {above:g}", above=above)
        )
    return float(given)
