"""A shoe's slip class or certificate as a reading: bounds that a test house read of its sole.

The draws of the law of the pair are weighted by how probably the sole passes, and drawn anew by
weight. What carries over from the test to another floor and fluid are the constants, the roughness
of the sole and the error of its tread; laboratory and pair of the test are others than the case's:

    ln COF_test = ln mu_c(test) + u_house + v_test + t_tread + e

The film of the test is left out: with it a passing sole would have still more friction where it
touches, so that the class says rather too little.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
from scipy.special import log_ndtr

from underfoot.core import InputError, to_si, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.remark import Message, Remark

from .pair_contact import (
    CONTACT_PRESSURE,
    TERMS,
    ContactTerms,
    PairContactLaw,
    PairDraws,
    even_rows,
)
from .propagation import named_shares
from .tread_error import READING, tread_error

SPEED = 0.3
"""m/s, of the tests."""
REPEATS, COUNT = 20, 1000
"""Draws of the errors for each draw of the constants, and draws that are kept."""
FEWEST = 50
"""Effective draws below which a class contradicts what else is known."""
KINDS = ("lower", "upper", "value")


@dataclass(frozen=True, slots=True)
class SlipTest:
    """A test on a floor (Rq, low and high, m) under a fluid (Pa s)."""

    name: str
    title: str
    floor_rq: tuple[float, float]
    family: Any
    viscosity: float


@dataclass(frozen=True, slots=True)
class Certified:
    """One bound or value of a test: COF with the standard deviation of a reading."""

    test: SlipTest
    cof: float
    kind: str = "lower"
    sd: float | None = None

    def __str__(self) -> str:
        bound = {"lower": "at least ", "upper": "at most "}.get(self.kind, "")
        return f"{self.test.title} {bound}{self.cof:g}"


@dataclass(frozen=True, slots=True)
class ShoeClass:
    """What a class or certificates say of a sole; ``fails`` where at least one is not reached."""

    name: str
    source: str
    readings: tuple[Certified, ...]
    fails: bool = False


@cache
def _table() -> dict[str, Any]:
    path = resources.files("underfoot") / "data" / "friction" / "shoe_classes.toml"
    return tomllib.loads(path.read_text(encoding="utf-8"))


@cache
def slip_tests() -> Mapping[str, SlipTest]:
    """Return the tests that classes and certificates name."""
    found = {}
    for name, entry in _table()["test"].items():
        low, high = (to_si(end, "m", where=name) for end in entry["floor_rq"])
        viscosity = to_si(entry["viscosity"], "Pa*s", where=name)
        found[name] = SlipTest(name, entry["title"], (low, high), entry["family"], viscosity)
    return found


def shoe_classes() -> tuple[str, ...]:
    """Return the names of every slip class."""
    return tuple(_table()["class"])


def shoe_class(name: str, where: str = "shoe.class") -> ShoeClass:
    """Return a slip class by its name.

    Raises:
        InputError: No such class; the nearest and all are named.
    """
    entry = _table()["class"].get(name)
    if entry is None:
        raise unknown_name("slip class", name, shoe_classes(), where=where)
    how = entry.get("kind", "lower"), entry.get("sd")
    limits = entry["limits"].items()
    readings = tuple(Certified(slip_tests()[test], cof, *how) for test, cof in limits)
    return ShoeClass(name, entry["source"], readings, entry.get("fails", False))


def certificate_line(test: str, cof: float, kind: str, sd: float | None, where: str) -> Certified:
    """Return one line of a certificate.

    Raises:
        InputError: A test or kind that does not exist, a COF that is none.
    """
    if test not in slip_tests():
        raise unknown_name("test", test, slip_tests(), where=f"{where}.test")
    if kind not in KINDS:
        raise unknown_name("kind", kind, KINDS, where=f"{where}.kind")
    if not 0 < cof < 5:
        raise InputError(f"{cof:g}", where=f"{where}.cof", allowed="above 0, below 5")
    return Certified(slip_tests()[test], cof, kind, sd)


def exclusive(readings: Sequence[Certified]) -> tuple[Certified, Certified] | None:
    """Return two bounds of one test that exclude each other, if there are any."""
    pairs = ((low, high) for low in readings for high in readings if low.test == high.test)
    bounds = ((low, high) for low, high in pairs if (low.kind, high.kind) == ("lower", "upper"))
    return next(((low, high) for low, high in bounds if low.cof > high.cof), None)


@dataclass(frozen=True, slots=True)
class Classed:
    """The law of a sole of known class, and what was known of the test before.

    ``passing`` is the probability of what the class says before it was used; ``contradicted`` where
    too few draws agree: then the law is the one that was given.
    """

    law: PairContactLaw
    passing: float
    contradicted: bool = False


def of_class(law: PairContactLaw, known: ShoeClass, place: Array, seed: int) -> Classed:
    """Return the law of the pair for a sole of a class.

    Parameters:
        law: Of the case's pair, with the errors that readings determined, if any.
        known: What the class says.
        place: Of the tread of the new sole (``tread_place``): that was tested.
        seed: Of the draws.
    """
    calibrated = bool(law.draws.errors)
    start = law.draws
    wide = start if calibrated else start.rows(np.tile(np.arange(start.count), REPEATS))
    errors = {**wide.errors}
    subject = law.pair.sole_roughness
    errors.setdefault(subject, named_shares(seed, subject, wide.count))
    for fluid in dict.fromkeys(reading.test.viscosity for reading in known.readings):
        error = tread_error(fluid)
        drawn = error.draws(place, samples=wide.count, seed=seed, known=errors)
        if np.any(place):
            errors[error.name(place)] = drawn
    wide = replace(wide, errors=errors)
    each = [_ln_cof(law, reading.test, wide, place, seed) for reading in known.readings]
    log_weight = np.zeros(wide.count)
    for reading, ln_cof in zip(known.readings, each, strict=True):
        repeat = READING if reading.sd is None else reading.sd / reading.cof
        rest = (ln_cof - np.log(reading.cof)) / np.hypot(repeat, wide.sd_reading)
        log_weight += {"lower": log_ndtr(rest), "upper": log_ndtr(-rest), "value": -0.5 * rest**2}[
            reading.kind
        ]
    if known.fails:
        log_weight = np.log(np.maximum(-np.expm1(log_weight), 1e-12))
    weight = np.exp(log_weight - log_weight.max())
    passing = float(np.mean(np.exp(np.minimum(log_weight, 0.0))))
    weight /= weight.sum()
    if 1 / (weight**2).sum() < FEWEST or (calibrated and passing < 0.05):
        reason = Message(
            "the law goes before a class that hardly any such sole has: check hardness, roughness "
            "and tread of the sole"
        )
        if calibrated:
            reason = Message(
                "the readings of your own tester, on this sole, go before the limits of another "
                "house"
            )
        note = Remark(
            "shoe.class",
            "{name} ({readings:; }) is contradicted: what else is known of the sole leaves it a "
            "probability of {passing:.1%}. It was not used; {reason}.",
            name=known.name,
            readings=map(str, known.readings),
            passing=passing,
            reason=reason,
        )
        draws = replace(start, notes=(*start.notes, note))
        return Classed(PairContactLaw(law.pair, law.viscosity, draws), passing, contradicted=True)
    generator = np.random.default_rng(seed)
    rows = even_rows(weight, COUNT, generator.random())
    draws = wide.rows(generator.permutation(rows))
    draws = replace(draws, source=f"{start.source}; soles of class {known.name}")
    basis = Message("of a sole of class {name}", name=known.name)
    basis += (
        ", calibrated to readings"
        if calibrated
        else ", without a measurement of this sole on this floor"
    )
    note = Remark(
        "shoe.class",
        "{name} ({source}): {readings:; }{failing}. Before that was known, {passing:.0%} of such "
        "soles would have it.",
        name=known.name,
        source=known.source,
        readings=map(str, known.readings),
        failing=Message(" is not reached") if known.fails else "",
        passing=passing,
    )
    draws = replace(draws, basis=basis, notes=(*start.notes, note))
    return Classed(PairContactLaw(law.pair, law.viscosity, draws), passing)


def _ln_cof(
    law: PairContactLaw, test: SlipTest, draws: PairDraws, place: Array, seed: int
) -> Array:
    """Return draws of ln COF of the sole in a test house, without the error of a reading."""
    pair = replace(law.pair, floor_rq=test.floor_rq, family=test.family, floor_slope=None)
    # what goes with the sole into another laboratory
    errors = {name: each for name, each in draws.errors.items() if name.startswith("sole_rq")}
    drawn = pair.draw_inputs(replace(draws, errors=errors), seed + 1)
    terms = ContactTerms(*(drawn[name] for name in TERMS))
    cof = terms.adhesion(CONTACT_PRESSURE, test.viscosity * SPEED) + terms.hysteresis
    error = tread_error(test.viscosity)
    tread = error.draws(place, samples=draws.count, seed=seed, known=draws.errors)
    return np.log(cof * drawn["laboratory"] * drawn["pair"]) + tread
