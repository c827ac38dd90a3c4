"""Terms that the law of a pair lacks, each scored with one laboratory left out in turn.

``python -m benchmarks.pair_terms [TERM ...]``: a term earns its place by a gain of 1 in the log
density of everybody else and no lower rank; about ten minutes of CPU each. Lengths are those of
the devices, fixed beforehand.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from underfoot.core.arrays import Array
from underfoot.friction.pair_contact import contact_terms, relative_area
from underfoot.studies.pair_law import (
    FAMILIES,
    PairConstants,
    PairLaw,
    corpus_score,
    fit_law,
    laboratory_left_out,
    law_named,
    middle,
)
from underfoot.studies.sources import PublishedCondition, Span, corpus

LENGTHS = {
    "pendulum": 2e-3,
    "whole shoe": 6e-3,
    "pin": 10e-3,
    "slipmeter": 12e-3,
    "tyre": 12e-3,
    "block": 25e-3,
}
"""Contact along the sliding (m) by device: a trailing edge, a lug, a pin, a pad, a block."""
LUG = LENGTHS["whole shoe"]
STEPS = 400
REPORT = "report"
Numbers = dict[str, Array]
Factors = Callable[[Array, Numbers], Array]


def _none(extra: Array, numbers: Numbers) -> Array:
    return np.zeros(np.broadcast_shapes(extra.shape, numbers["speed"].shape))


def _drag(numbers: Numbers) -> Array:
    return numbers["viscosity"] * np.abs(numbers["speed"])


def _gap(extra: Array, numbers: Numbers) -> Array:
    """Return a film thickness (m): ``exp(extra)`` times the roughness of both sides."""
    return np.exp(extra) * np.hypot(numbers["sole_rq"], numbers["floor_rq"])


def _slow_pad(extra: Array, numbers: Numbers) -> Array:
    return extra * np.log(numbers["length"] / LUG)


def _pad(extra: Array, numbers: Numbers) -> Array:
    """Return ln of drag on a pad that drains as Reynolds says, whatever ``extra``."""
    return _slow_pad(np.ones_like(extra), numbers)


def _sole_share(extra: Array, numbers: Numbers) -> Array:
    """Return ln of drag with a sole that drains by the share ``exp(extra)`` of its roughness."""
    full = np.hypot(numbers["sole_rq"], numbers["floor_rq"])
    part = np.hypot(np.exp(extra) * numbers["sole_rq"], numbers["floor_rq"])
    return np.log(full / part)


def _floating(extra: Array, numbers: Numbers) -> Array:
    """Return ln of the load share on the contact: a square pad's film carries 0.08 eta V L / h2.

    Half of the 0.16 of the best infinitely wide slider (Rayleigh): a square one leaks sideways.
    """
    carried = 0.08 * _drag(numbers) * numbers["length"] / _gap(extra, numbers) ** 2
    return -np.log1p(carried / numbers["pressure"])


def _slower_rubber(extra: Array, numbers: Numbers) -> Array:
    return -extra * np.log1p(np.abs(numbers["speed"]) / 0.3)


def _sheared(extra: Array, numbers: Numbers) -> Array:
    """Return a COF: the fluid of the valleys is sheared over a depth of some roughnesses."""
    return _drag(numbers) / _gap(extra, numbers) / numbers["pressure"]


def _law(
    name: str,
    parameter: str,
    prior: tuple[float, float],
    *,
    drag: Factors = _none,
    load: Factors = _none,
    rest: Factors = _none,
    shear: Factors = _none,
    power: float = 1.0,
) -> PairLaw:
    """Return the law with a term: ln of what drag, wet load or dry-like part is times, or a COF."""
    pair = law_named("pair")

    def ln_cof(theta: Array, numbers: Numbers, fluid: str) -> Array:
        columns = theta.T[..., None]
        extra = columns[-1]
        constants = PairConstants(*np.exp(columns[:5]), *columns[5:-1])
        terms = contact_terms(constants, numbers, family=FAMILIES[fluid])
        terms = replace(terms, rest=terms.rest * np.exp(rest(extra, numbers)))
        if fluid == "dry":
            area = relative_area(numbers["pressure"], terms.full_contact)
            return np.log(terms.rest * area**power + terms.hysteresis)
        dragged = _drag(numbers) * np.exp(drag(extra, numbers))
        cof = terms.adhesion(numbers["pressure"], dragged) + terms.hysteresis
        return np.log(cof * np.exp(load(extra, numbers)) + shear(extra, numbers))

    return PairLaw(name, (*pair.parameters, parameter), (*pair.prior, prior), ln_cof, pair.dry)


FILM = (np.log(3.0), 0.7)
"""ln of a film over the roughness of both sides: mixed lubrication ends near 3."""
TERMS = {
    "none": law_named("pair"),
    "length": _law("a pad drains along its length", "length exponent", (1.0, 0.7), drag=_slow_pad),
    "sole": _law("the sole drains by a share", "ln share", (np.log(0.3), 0.7), drag=_sole_share),
    "floating": _law("pads float on their film", "ln film / Rq", FILM, load=_floating),
    "speed": _law(
        "dry adhesion falls with speed", "speed exponent", (0.0, 0.3), rest=_slower_rubber
    ),
    "shear": _law("valleys are sheared", "ln depth / Rq", FILM, shear=_sheared),
    "float and shear": _law(
        "pads float on a film that is sheared", "ln film / Rq", FILM, load=_floating, shear=_sheared
    ),
    "float, shear and length": _law(
        "the same, and a pad drains along its length",
        "ln film / Rq",
        FILM,
        drag=_pad,
        load=_floating,
        shear=_sheared,
    ),
    "float, shear and dry area": _law(
        "the same, and dry area to a power of 0.3",
        "ln film / Rq",
        FILM,
        load=_floating,
        shear=_sheared,
        power=0.3,
    ),
    "length and shear": _law(
        "length of exponent 1 and sheared valleys",
        "ln depth / Rq",
        FILM,
        drag=_pad,
        shear=_sheared,
    ),
}


def conditions() -> list[PublishedCondition]:
    """Return every reading of the corpus with the length of its device."""

    def with_length(condition: PublishedCondition) -> PublishedCondition:
        length = LENGTHS[condition.labels["device"]]
        numbers = {**condition.numbers, "length": Span(length, length)}
        members = tuple(map(with_length, condition.members))
        return replace(condition, numbers=numbers, members=members)

    return [with_length(each) for source in corpus() for each in source.conditions]


def learned(term: PairLaw, rows: Sequence[PublishedCondition]) -> str:
    """Return what a law learns of its last parameter and of the film, with and without the report.

    ln of both, their sd, and by how much ln COF of the report's readings is too high in the mean.
    """
    report = [row for row in rows if row.laboratory == REPORT]
    told = []
    for name, left in (("of all", ""), ("of everybody else", REPORT)):
        training = [row for row in rows if row.laboratory != left]
        posterior = fit_law(term, training, steps=STEPS, left=left)
        numbers = [
            f"{term.parameters[at]} {posterior.theta[:, at].mean():.2f} "
            f"± {posterior.theta[:, at].std():.2f}"
            for at in (-1, 0)
        ]
        high = np.nanmean(posterior.expected(report) - middle(report))
        told.append(f"  {name}: {', '.join(numbers)}; the report's {high:+.2f}")
    return "\n".join(told)


def main(chosen: Sequence[str] = ()) -> None:
    """Print the score of each term, and what it learns; ``chosen``: names, all where empty."""
    rows = conditions()
    laboratories = sorted({row.laboratory for row in rows})
    print("term | density, everybody else; all | R2, everybody else; all | rank | inside 50, 95 %")
    for name in chosen or TERMS:
        begun = time.process_time()
        scores = [
            laboratory_left_out(TERMS[name], rows, each, steps=STEPS) for each in laboratories
        ]
        every = corpus_score(name, scores)
        others = corpus_score(name, [each for each in scores if each.laboratory != REPORT])
        print(
            f"{TERMS[name].name} | {others.log_density:.1f}; {every.log_density:.1f} | "
            f"{others.r2:.3f}; {every.r2:.3f} | {every.rank_correlation:.2f} | "
            f"{100 * others.inside_50:.0f}, {100 * others.inside_95:.0f} | "
            f"{time.process_time() - begun:.0f} s",
            flush=True,
        )
        print(learned(TERMS[name], rows), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
