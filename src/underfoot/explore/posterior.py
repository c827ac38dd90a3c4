"""Parameters of a case from a user's own readings: their joint posterior, with a discrepancy.

    y_i ~ N(m_i(theta), s_i^2 + e_i(theta)^2 + (delta m_i(theta))^2)

y_i a reading with its standard deviation s_i, m_i what the model gives under the conditions of that
reading, by a surrogate of full runs with the deviation e_i, delta the model's relative discrepancy,
half-normal (Kennedy and O'Hagan 2001, with a discrepancy that is one number). Sampled by emcee
(Foreman-Mackey et al. 2013) over the quantiles of the priors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from scipy.special import ndtri

from underfoot.case import unit_at
from underfoot.core import DataError, InputError, Progress, display, silent
from underfoot.core.arrays import Array
from underfoot.core.files import whole_file
from underfoot.core.optional import optional_module
from underfoot.core.presentation import Presentable, Table, quantity_text
from underfoot.core.progress import part
from underfoot.core.remark import Message, Remark
from underfoot.core.threads import threads_limited

from .goals import Goal
from .inputs import TAIL
from .plan import Reading
from .study import Study
from .surrogate import Surrogate

DISCREPANCY = 0.15
"""Scale of the half-normal prior of delta: the law of a pair misses its readings by about so much
(docs/physics/pair_friction.md)."""
WALKERS, STEPS, BURNT = 32, 1500, 500
MOST_STEPS = 6 * STEPS
"""Of a chain that is slow to forget where it began."""
PART = 50
"""Steps between two words of progress."""
KEPT = 1000
"""Draws that are written."""
WIDE = 2.0
"""Standard deviations of a reading and of ``DISCREPANCY`` that a reading may lie outside."""
APART = 3.0
"""Standard deviations by which two readings of one condition may differ."""
LONG_ENOUGH = 20
"""Autocorrelation times that a chain must last."""


@dataclass(frozen=True)
class Posterior(Presentable):
    """Joint draws of parameters, and what each reading was predicted before and is after.

    Attributes:
        draws: (draws, parameters) SI. ``prior`` the same before the readings.
        discrepancy: (draws,) of delta.
        before, after: (readings, 3) predictions at 2.5, 50 and 97.5 %.
        lengths: Autocorrelation times that the chain lasted.
        models: The surrogate of each reading, with its error.
        apart: Names of two readings of one condition that differ by more than their spreads.
    """

    kind: ClassVar[str] = "posterior"

    name: str
    paths: tuple[str, ...]
    draws: Array
    prior: Array
    discrepancy: Array
    readings: Sequence[tuple[str, float, float, str]]
    before: Array
    after: Array
    lengths: float
    models: Sequence[Surrogate]
    apart: Sequence[tuple[str, str]] = ()

    @property
    def usable(self) -> bool:
        """Whether the chain is long enough to be trusted."""
        return self.lengths >= LONG_ENOUGH

    def headline(self) -> tuple[str, ...]:
        """Return what the readings taught of each parameter, and the discrepancy."""
        if not self.usable:
            return (
                Message(
                    "No result: the chain lasts {lengths:.0f} autocorrelation times only.",
                    lengths=self.lengths,
                ),
            )
        ratios = self.draws.std(axis=0) / self.prior.std(axis=0)
        best = int(np.argmin(ratios))
        return (
            Message(
                "Readings used: {count}. They narrow {path} most: its standard deviation is "
                "{share:.0%} of the prior's.",
                count=len(self.readings),
                path=self.paths[best],
                share=ratios[best],
            ),
            Message(
                "Discrepancy of the model {median:.0%} (median).",
                median=np.median(self.discrepancy),
            ),
        )

    def cautions(self) -> tuple[str, ...]:
        """Return what contradicts, weak surrogates, and posteriors at the end of a prior."""
        outside = [
            Message(
                "{label} reads {reading}, outside what the model with these priors "
                "reaches ({low} to {high}): check reading, condition "
                "and priors.",
                label=label,
                reading=quantity_text(value, unit),
                low=quantity_text(low, unit),
                high=quantity_text(high, unit),
            )
            for (label, value, sd, unit), (low, middle, high) in zip(
                self.readings, self.after, strict=True
            )
            if not -WIDE < (value - np.clip(value, low, high)) / _off(sd, middle) < WIDE
        ]
        apart = [
            Message(
                "{first} and {second} are of one condition and differ by more than their sd allow.",
                first=first,
                second=second,
            )
            for first, second in self.apart
        ]
        weak = [Remark.of(model.name, model.reliability) for model in self.models if model.q2 < 0.9]
        edge = [
            Message("The posterior of {path} lies at the end of its prior: widen that.", path=path)
            for path, now, then in zip(self.paths, self.draws.T, self.prior.T, strict=True)
            if not then.min() * 1.0001 < np.median(now) < then.max() * 0.9999
        ]
        return (*outside, *apart, *weak, *edge)

    def table(self) -> Table:
        """Return each parameter before and after, at 2.5, 50 and 97.5 %."""
        rows = [
            (path, _interval(then, unit_at(path)), _interval(now, unit_at(path)))
            for path, then, now in zip(self.paths, self.prior.T, self.draws.T, strict=True)
        ]
        rows.append(("discrepancy", "", _interval(self.discrepancy, "1")))
        return Table("Parameters (median, 95 %)", ("Parameter", "Before", "After"), rows)

    def tables(self) -> tuple[Table, ...]:
        """Return parameters and readings."""
        rows = []
        for (label, value, sd, unit), before, after in zip(
            self.readings, self.before, self.after, strict=True
        ):
            texts = [
                f"{quantity_text(row[1], unit)} ({quantity_text(row[0], unit)} to "
                f"{quantity_text(row[2], unit)})"
                for row in (before, after)
            ]
            rows.append((label, quantity_text(value, unit, sd), *texts))
        readings = Table("Readings", ("Reading", "Measured", "Predicted before", "After"), rows)
        return (self.table(), readings)

    def remarks(self) -> Mapping[str, Sequence[str]]:
        """Return the error of the surrogates."""
        return {"Surrogates": [Remark.of(model.name, model.reliability) for model in self.models]}

    def write(self, path: Path) -> None:
        """Write the draws as CSV, one column a path (SI): ``uncertain.posterior`` of a study."""
        with whole_file(path) as temporary, temporary.open("w", encoding="utf-8") as stream:
            stream.write(f"# joint draws of {self.name}; {len(self.readings)} readings\n")
            stream.write(",".join(self.paths) + "\n")
            np.savetxt(stream, self.draws, delimiter=",", fmt="%.10g")


def _log_density(places: Array, models: Sequence[Surrogate], readings: Sequence[Reading]) -> Array:
    """Return ln of a density (n,), less a constant, of places (n, inputs + 1) in the unit cube.

    The last of a place is the share of discrepancies that are smaller. A reading is normal about
    its surrogate's mean; its own variance, the surrogate's and that of the discrepancy add.
    """
    inside = ((places > 0) & (places < 1)).all(axis=1)
    points = np.clip(places, 0.0, 1.0)
    delta = DISCREPANCY * _half_normal(points[:, -1])
    log_density = np.where(inside, 0.0, -np.inf)
    for model, reading in zip(models, readings, strict=True):
        mean, error = model.prediction(points[:, :-1])
        variance = reading.sd**2 + error**2 + (delta * mean) ** 2
        log_density -= 0.5 * ((reading.value - mean) ** 2 / variance + np.log(variance))
    return log_density


@threads_limited(1)  # thousands of small solves, which threads make several times dearer
def posterior(
    study: Study,
    *,
    on: str | None = None,
    workers: int | None = None,
    progress: Progress = silent,
) -> Posterior:
    """Return the joint posterior of the uncertain inputs of a study with readings.

    Its cases are run first, or taken from its folder.

    Raises:
        InputError: A study without readings or without uncertain inputs.
        DataError: Too few usable runs.
    """
    plan = study.plan
    if not plan.readings or not plan.uncertain or plan.vary:
        raise InputError(
            "is no calibration",
            where=str(study.store.folder),
            allowed="a file with [uncertain] and [[reading]], and without [vary]",
        )
    result = study.run(on, workers, part(progress, 0.0, 0.9))
    goals = [
        Goal(reading.output, reading.unit, within=state.parts)
        for reading, state in zip(plan.readings, plan.states, strict=True)
    ]
    models = result.surrogates(goals)
    size = len(plan.uncertain)
    log_probability = partial(_log_density, models=models, readings=plan.readings)
    emcee = optional_module("emcee", "study", "A posterior")
    generator = np.random.default_rng(plan.method.seed)
    sampler = emcee.EnsembleSampler(WALKERS, size + 1, log_probability, vectorize=True)
    sampler.random_state = np.random.RandomState(plan.method.seed).get_state()
    state: Any = generator.uniform(0.05, 0.95, (WALKERS, size + 1))
    lengths, steps = 0.0, 0
    while lengths < LONG_ENOUGH and steps < MOST_STEPS:
        for _ in range(STEPS // PART):
            state = sampler.run_mcmc(state, PART, skip_initial_state_check=steps > 0)
            steps += PART
            progress("Sampling the posterior", 0.9 + 0.1 * steps / MOST_STEPS)
        lengths = steps / float(np.max(sampler.get_autocorr_time(quiet=True)))
    chain = sampler.get_chain(discard=BURNT, flat=True)
    kept = chain[np.linspace(0, len(chain) - 1, KEPT).round().astype(int)]
    flat = generator.uniform(0.0, 1.0, (KEPT, size))
    levels = (0.025, 0.5, 0.975)

    def mean_quantiles(points: Array) -> Array:
        return np.array([np.quantile(model.mean(points), levels) for model in models])

    def in_si(points: Array) -> Array:
        columns = [
            [distribution.value(float(share)) for share in column]
            for distribution, column in zip(plan.uncertain, points.T, strict=True)
        ]
        return np.array(columns).T

    if not np.isfinite(kept).all():
        raise DataError("the sampler left the numbers that there are", where=plan.name)
    return Posterior(
        plan.name,
        tuple(distribution.path for distribution in plan.uncertain),
        in_si(kept[:, :size]),
        in_si(flat),
        DISCREPANCY * _half_normal(kept[:, -1]),
        [
            (state.label, reading.value, reading.sd, reading.unit)
            for reading, state in zip(plan.readings, plan.states, strict=True)
        ],
        mean_quantiles(flat),
        mean_quantiles(kept[:, :size]),
        lengths,
        models,
        [
            (one.label, other.label)
            for (one, first), (other, second) in combinations(
                zip(plan.states, plan.readings, strict=True), 2
            )
            if (one.changes, first.output) == (other.changes, second.output)
            and abs(first.value - second.value) > APART * np.hypot(first.sd, second.sd)
        ],
    )


def _off(sd: float, predicted: float) -> float:
    """Return the standard deviation by which a reading misses what is predicted of it."""
    return float(np.hypot(sd, DISCREPANCY * predicted))


def _half_normal(share: Array) -> Array:
    return ndtri(0.5 + 0.5 * (TAIL + (1 - 2 * TAIL) * share))


def _interval(draws: Array, unit: str) -> str:
    low, middle, high = np.quantile(draws, (0.025, 0.5, 0.975))
    return f"{display(middle, unit)} ({display(low, unit)} to {display(high, unit)})"
