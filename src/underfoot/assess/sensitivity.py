"""What the least known inputs of a case do to its numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from underfoot.core import Progress, display, silent

from .outcomes import Outcome, outcomes

if TYPE_CHECKING:
    from underfoot.case import Case


@dataclass(frozen=True, slots=True)
class OpenInput:
    """An input that was assumed, with the spread that its reason leaves.

    ``deviation`` is a standard deviation in SI, or the factor of one when ``ratio`` is true;
    ``low`` and ``high`` bound what is tried. ``along`` are lengths that keep their ratio to it.
    With ``only_assumed`` it counts as open only where the case's value is marked as assumed.
    """

    path: str
    deviation: float
    reason: str
    ratio: bool = False
    low: float = -math.inf
    high: float = math.inf
    along: tuple[str, ...] = ()
    only_assumed: bool = False

    def ends(self, value: float) -> tuple[float, float]:
        """Return the values one standard deviation below and above, within the bounds."""
        if self.ratio:
            ends = value / self.deviation, value * self.deviation
        else:
            ends = value - self.deviation, value + self.deviation
        return max(ends[0], self.low), min(ends[1], self.high)


OPEN_INPUTS = (
    OpenInput(
        "shoe.heel.facet_angle",
        math.radians(1.0),
        "a heel ground or worn by hand; not printed in the report",
        low=0.0,
    ),
    OpenInput("shoe.heel.facet_length", 5e-3, "not printed in the report", low=2e-3),
    OpenInput("shoe.heel.edge_radius", 1e-3, "not printed in the report", low=0.0),
    OpenInput(
        "shoe.heel.width",
        3e-3,
        "heels of one size are 65 to 75 mm wide",
        low=20e-3,
        along=("shoe.heel.rear_radius",),
        only_assumed=True,
    ),
    OpenInput("shoe.tread.lug_width", 1e-3, "not printed", low=1e-3, only_assumed=True),
    OpenInput("shoe.tread.arc_channel.position", 3e-3, "not printed", low=5e-3, only_assumed=True),
    OpenInput("shoe.tread.arc_channel.width", 1e-3, "not printed", low=1e-3, only_assumed=True),
    OpenInput("shoe.sole.outsole_thickness", 5e-3, "not printed in the report", low=5e-3),
    OpenInput(
        "shoe.material.shore_a",
        3.0,
        "one durometer against another, and modulus from hardness",
        low=20.0,
        high=95.0,
    ),
    OpenInput(
        "interface.roughness_beyond_cutoff",
        math.sqrt(2.0),
        "waves longer than the stylus' cut-off; chosen on one reading",
        ratio=True,
        low=1.0,
    ),
    OpenInput(
        "motion.start_film", 2.0, "film under the sole when loading starts", ratio=True, low=1e-5
    ),
    OpenInput(
        "contaminant.viscosity",
        1.1,
        "1 to 2 K of room temperature in a concentrated glycerol solution",
        ratio=True,
    ),
)
"""Inputs that no source in the catalogue prints for the cases it describes."""


@dataclass(frozen=True, slots=True)
class Effect:
    """Outcomes with one input at either end of its spread, everything else unchanged."""

    path: str
    reason: str
    low_value: float
    high_value: float
    unit: str
    low: Outcome
    high: Outcome

    def deviation(self, name: str, nominal: Outcome) -> float:
        """Return the standard deviation that this input gives to a number.

        Root mean square of both departures from the nominal, so that an optimum within the
        spread counts; nan when an end could not be computed.
        """
        centre = nominal.number(name)
        departures = (self.low.number(name) - centre, self.high.number(name) - centre)
        return math.sqrt(sum(each**2 for each in departures) / 2)

    @property
    def words(self) -> str:
        """Return the two values in words."""
        ends = (display(value, self.unit) for value in (self.low_value, self.high_value))
        return " to ".join(ends)


@dataclass(frozen=True, slots=True)
class Band:
    """A number with the spread of the friction law and of the open inputs together.

    ``inputs`` and ``law`` are the standard deviations of either, ``deviation`` both in quadrature;
    ``lowest`` and ``highest`` are the extremes over all computed variants.
    """

    value: float
    deviation: float
    inputs: float
    law: float
    lowest: float
    highest: float
    not_computed: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Sensitivity:
    """A case and what its open inputs do to it."""

    nominal: Outcome
    effects: tuple[Effect, ...]

    def band(self, name: str) -> Band:
        """Return the band of a number: first-order, inputs taken as independent."""
        value = self.nominal.number(name)
        each = [effect.deviation(name, self.nominal) for effect in self.effects]
        ends = [end.number(name) for effect in self.effects for end in (effect.low, effect.high)]
        seen = [value, *(end for end in ends if not math.isnan(end))]
        inputs = math.sqrt(sum(one**2 for one in each if not math.isnan(one)))
        law = self.nominal.spread(name)
        law = 0.0 if math.isnan(law) else law
        return Band(
            value,
            math.hypot(inputs, law),
            inputs,
            law,
            min(seen),
            max(seen),
            tuple(
                effect.path
                for effect, one in zip(self.effects, each, strict=True)
                if math.isnan(one)
            ),
        )

    def ranked(self, name: str) -> list[Effect]:
        """Return the effects on a number, largest first."""
        return sorted(
            self.effects,
            key=lambda effect: -_or_zero(effect.deviation(name, self.nominal)),
        )


def open_inputs(case: Case, inputs: Sequence[OpenInput] = OPEN_INPUTS) -> list[OpenInput]:
    """Return the inputs of ``inputs`` that the case uses.

    A value that came with a standard deviation of its own is varied by that.
    """
    from underfoot.case.unused import unused

    aside = unused(case)
    found = []
    for one in inputs:
        if one.path in aside or case.value(one.path) is None:
            continue
        if one.only_assumed and not case.sourced(one.path).assumed:
            continue
        if one.path == "interface.roughness_beyond_cutoff" and case.interface.effective_rq:
            continue
        if one.path == "shoe.material.shore_a" and case.shoe.material.modulus is not None:
            continue
        own = case.sourced(one.path).uncertainty
        if own:
            one = replace(one, deviation=own, reason="its stated uncertainty", ratio=False)
        found.append(one)
    return found


def variants(
    case: Case, inputs: Sequence[OpenInput] | None = None
) -> list[tuple[OpenInput, float, float, Case, Case]]:
    """Return each open input with its two ends and the two cases there."""
    from underfoot.case.case import unit_at

    found = []
    for one in open_inputs(case) if inputs is None else inputs:
        low, high = one.ends(float(case.value(one.path)))
        unit = unit_at(one.path)
        at_low, at_high = (_at(case, one, value, unit) for value in (low, high))
        found.append((one, low, high, at_low, at_high))
    return found


def _at(case: Case, one: OpenInput, value: float, unit: str) -> Case:
    """Return the case with an open input at a value, and what goes along with it."""
    from underfoot.case.case import unit_at

    settings: dict[str, object] = {one.path: value if unit == "1" else f"{value!r} {unit}"}
    ratio = value / float(case.value(one.path))
    for path in one.along:
        settings[path] = f"{ratio * float(case.value(path))!r} {unit_at(path)}"
    return case.replace(settings)


def sensitivity(
    case: Case,
    *,
    inputs: Sequence[OpenInput] | None = None,
    quick: bool = True,
    processes: int | None = 1,
    progress: Progress = silent,
) -> Sensitivity:
    """Return the numbers of a case and what its open inputs do to them, one at a time.

    Parameters
    ----------
    case
        What to vary.
    inputs
        What to vary in it; None takes ``open_inputs(case)``.
    quick
        Use the coarse grid: differences need less resolution than values.
    processes, progress
        As for ``outcomes``; progress sees every case of the plan.

    Notes
    -----
    Two runs an input, at one standard deviation to either side. First order: effects of two
    inputs together are not looked for, and their independence is assumed.
    """
    from underfoot.case.case import unit_at

    plan = variants(case, inputs)
    cases = [case, *(each for one in plan for each in one[3:])]
    found = outcomes(cases, quick=quick, processes=processes, progress=progress)
    effects = [
        Effect(
            one.path,
            one.reason,
            low,
            high,
            unit_at(one.path),
            found[1 + 2 * number],
            found[2 + 2 * number],
        )
        for number, (one, low, high, _, _) in enumerate(plan)
    ]
    return Sensitivity(found[0], tuple(effects))


def _or_zero(value: float) -> float:
    return 0.0 if math.isnan(value) else value
