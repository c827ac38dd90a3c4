"""The law of the pair, the friction of a case by default, without anything the report read.

The report's readings of friction (G.2, G.3 and G.6, one laboratory) are left out of its fit
together, and the priors that G.2's pin stands behind are made wide: what is judged in the studies
knows nothing of what it is judged by.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Cache, content_hash
from underfoot.core.arrays import Array
from underfoot.core.catalogue import Catalogue
from underfoot.friction import Pair, PairContactLaw, PairDraws, packaged_pair_draws
from underfoot.friction.pair_contact import Family

from .pair_law import PairLaw, fit_law, law_named
from .sources import corpus

LABORATORY = ("moore_2012", "strobel_2012", "report_g6")
"""Sources of the report's own laboratory: G.2, G.3 and G.6."""
STEPS = 1500
"""Of the sampler's walkers: some 5 CPU s, once."""
WIDE = {"ln film, aqueous": 1.0, "ln film, oil": 1.0, "ln dry": 1.0, "ln kappa_0, Pa m": 2.0}
"""Standard deviations of priors whose medians G.2's pin suggested, in place of 0.5."""
RQ_PER_RA = 1.25
"""Gaussian heights."""
FAMILIES: dict[str, Family] = {
    "water_g2": "aqueous",
    "detergent_g2": "detergent",
    "glycerol_25pct": "aqueous",
    "glycerol_50pct": "aqueous",
    "glycerol_75pct": "aqueous",
    "canola_oil": "oil",
    "gear_oil_75w140": "oil",
}


def law_without_report() -> PairLaw:
    """Return the law of the pair with the priors of G.2's pin made wide."""
    law = law_named("pair")
    priors = tuple(
        (median, WIDE.get(name, sd))
        for name, (median, sd) in zip(law.parameters, law.prior, strict=True)
    )
    return replace(law, prior=priors)


@cache
def draws_without_report(seed: int = 0) -> PairDraws:
    """Return draws of the law fitted to everybody's readings but the report's."""
    others = [
        condition
        for source in corpus()
        if source.verified and source.name not in LABORATORY
        for condition in source.conditions
    ]
    law = law_without_report()
    store = Cache("default_law-1")
    key = content_hash(fit_law, [repr(c) for c in others], list(law.prior), STEPS, seed)
    stored = store.load(key)
    if stored is None:
        count = packaged_pair_draws().count
        draws = fit_law(law, others, steps=STEPS, seed=seed).draws(count, seed)
        stored = {name: np.asarray(values) for name, values in draws.columns().items()}
        store.store(key, stored)
    constants = {name: stored[name] for name in stored if not name.startswith("sd_")}
    return PairDraws(
        replace(packaged_pair_draws().constants, **constants),
        stored["sd_laboratory"],
        stored["sd_dry_part"],
        stored["sd_pair"],
        stored["sd_reading"],
        source="law of the pair, fitted to everybody's readings but the report's",
    )


def file_without_report(seed: int = 0) -> Path:
    """Return the file of those draws, as a case takes it (``friction.draws_file``)."""
    draws = draws_without_report(seed)
    folder = Cache("default_law-1").folder
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"without_report_{content_hash(*draws.columns().values())[:16]}.csv"
    if not path.is_file():
        draws.write(path)
    return path


def cof_draws(
    pair: Pair,
    viscosity: float | None,
    speeds: ArrayLike,
    pressure: float,
    draws: PairDraws,
    seed: int = 0,
) -> tuple[Array, Array, Array]:
    """Return COF (draws, speeds), its hysteresis part, and COF (speeds,) at the medians.

    The joint draws hold the law's constants and its errors of laboratory, dry part and pair.
    """
    law = PairContactLaw(pair, viscosity, draws)
    speed = np.atleast_1d(np.asarray(speeds, dtype=float))
    at = np.full(speed.size, pressure)
    joint = law.joint_draws(draws.count, seed)
    found = np.empty((2, draws.count, speed.size))
    for row in range(draws.count):
        drawn = law.at({name: float(values[row]) for name, values in joint.items()})
        found[:, row] = drawn.contact_shear(at, speed)
    adhesion, hysteresis = law.contact_shear(at, speed)
    return found.sum(axis=0) / pressure, found[1] / pressure, (adhesion + hysteresis) / pressure


def viscosity_of(fluid: str) -> float:
    """Return the viscosity of a fluid of the report, Pa s."""
    given = Catalogue.load().entry("fluid", fluid).sourced_value("viscosity", "Pa*s").value
    assert given is not None
    return given


def with_reading_error(values: Array, draws: PairDraws, name: str, seed: int = 0) -> Array:
    """Return draws (draws, ...) times the error of one reading, named so that it is its own."""
    error = np.exp(draws.error(f"reading: {name}", draws.sd_reading, seed))
    return values * error.reshape(-1, *[1] * (values.ndim - 1))


def chance_of_order(columns: Sequence[Array], least: float = 0.0) -> float:
    """Return the probability that each column of draws is above the next by ``least``."""
    steps: Any = [a - b > least for a, b in pairwise(columns)]
    return float(np.mean(np.all(steps, axis=0)))
