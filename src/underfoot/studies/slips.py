"""Shares of steps that slipped, in four publications, against the slip model.

    P = E logistic(slope (ACOF e^u - RCOF - x50))

over persons (RCOF ~ normal), over the available friction that is printed or computed, and over u,
by which the friction read in one laboratory is off on the scale of another; the report's own curve
holds in its own laboratory and has none. Slope and x50 are free as far as other studies printed
them; the source that is predicted never counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import binom

from underfoot.core.arrays import Array
from underfoot.slip import ADULTS_LEVEL_WALKING, ReportG6

from .pair_law import SD_SOURCE

SLOPE = (np.log(48.0), 0.2)
"""ln of minus the slope: -41.2 to -45.1, -49.2 and -54.7 are printed (report, G.6.3)."""
HALF = (-0.085, 0.05)
"""ACOF - RCOF at even odds: -0.06 and -0.11 are printed (report, G.6.3; a third has no sign)."""
POINTS = 15


@dataclass(frozen=True, slots=True)
class SlipShare:
    """One share of slips: ``acof`` are equally probable values of the available friction.

    ``low`` and ``high`` bound the printed share; ``steps`` are those it is a share of.
    ``own_scale``: the friction is in the interval already, laboratory and all.
    """

    source: str
    printed: str
    acof: Array
    low: float
    high: float
    steps: int
    own_scale: bool = False


def published_shares(computed: Array) -> tuple[SlipShare, ...]:
    """Return the four sources; ``computed`` are draws of ACOF of the shoe of G.5."""
    spread = np.linspace(0.0, 1.0, 9)
    return (
        SlipShare("report, G.6", "COF 0.159: 41 %", np.array([0.159]), 0.41, 0.41, 29),
        SlipShare("report, G.6", "COF 0.182: 6 %", np.array([0.182]), 0.06, 0.06, 29),
        SlipShare(
            "Liu 2013",
            "COF 0.12 to 0.15: 77 slips of 240 steps, 122 with slides",
            0.12 + 0.03 * spread,
            77 / 240,
            122 / 240,
            240,
        ),
        SlipShare("McGorry 2010", "COF 0.12 to 0.21: half", 0.12 + 0.09 * spread, 0.5, 0.5, 20),
        SlipShare(
            "report, G.5", "treaded shoe, 90 % glycerol: none of 6", computed, 0.0, 0.0, 6, True
        ),
    )


def _grid() -> tuple[Array, Array, Array]:
    """Return slopes, points of even odds and their prior weight, each (points,)."""
    z = np.linspace(-2.5, 2.5, 11)
    first, second = (each.ravel() for each in np.meshgrid(z, z))
    weight = np.exp(-0.5 * (first**2 + second**2))
    return -np.exp(SLOPE[0] + SLOPE[1] * first), HALF[0] + HALF[1] * second, weight / weight.sum()


def share(slips: SlipShare, slope: Array, half: Array, u: Array) -> Array:
    """Return the share of slips (points, errors) at slopes and points of even odds (points,)."""
    acof = slips.acof * np.exp(np.zeros(1) if slips.own_scale else u)[:, None]
    mean, sd = ADULTS_LEVEL_WALKING.mean, ADULTS_LEVEL_WALKING.sd
    shares = [
        ReportG6(s, x).population(acof, mean, sd).mean(axis=1)
        for s, x in zip(slope, half, strict=True)
    ]
    return np.broadcast_to(np.array(shares), (slope.size, u.size))


def predict_shares(sources: Sequence[SlipShare]) -> list[dict[str, Any]]:
    """Return each share as predicted from the other publications, with the report's own curve."""
    slope, half, prior = _grid()
    z = np.linspace(-2.5, 2.5, 15)
    errors, weight = SD_SOURCE * z, np.exp(-0.5 * z**2) / np.exp(-0.5 * z**2).sum()
    shares = [share(source, slope, half, errors) for source in sources]
    rows: list[dict[str, Any]] = []
    for slips, computed in zip(sources, shares, strict=True):
        log_weight = np.log(prior)
        for name in dict.fromkeys(other.source for other in sources):
            if name == slips.source:
                continue
            likelihood = np.ones((slope.size, errors.size))
            for other, p in zip(sources, shares, strict=True):
                if other.source == name:
                    likelihood = likelihood * _likelihood(other, p)
            log_weight = log_weight + np.log(np.maximum(likelihood @ weight, 1e-12))
        posterior = np.exp(log_weight - log_weight.max())
        posterior /= posterior.sum()
        joint = posterior[:, None] * weight
        mean = float((joint * computed).sum())
        order = np.argsort(computed, axis=None)
        ends = np.searchsorted(np.cumsum(joint.ravel()[order]), (0.025, 0.975))
        low, high = computed.ravel()[order][ends]
        report = ReportG6()
        alone = np.mean(
            report.population(slips.acof, ADULTS_LEVEL_WALKING.mean, ADULTS_LEVEL_WALKING.sd)
        )
        rows.append(
            {
                "source": slips.source,
                "published": slips.printed,
                "share of slips, %": 100 * slips.low,
                "or up to, %": 100 * slips.high,
                "predicted from the others, %": 100 * mean,
                "low 95 %, %": 100 * low,
                "high 95 %, %": 100 * high,
                "report's curve, %": 100 * float(alone),
                "off by, points": 100 * _off(mean, slips),
                "report's curve off by, points": 100 * _off(float(alone), slips),
            }
        )
    return rows


def _off(p: float, slips: SlipShare) -> float:
    return p - float(np.clip(p, slips.low, slips.high))


def _likelihood(slips: SlipShare, p: Array) -> Array:
    """Return the probability of the printed count, or of a count within the printed bounds."""
    low, high = round(slips.low * slips.steps), round(slips.high * slips.steps)
    return binom.cdf(high, slips.steps, p) - binom.cdf(low - 1, slips.steps, p)
