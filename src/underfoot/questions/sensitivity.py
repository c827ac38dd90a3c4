"""Effect of the least known inputs of a case on its results."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

from underfoot.case import unit_at
from underfoot.core import Progress, display, silent
from underfoot.core.deprecation import renamed_member
from underfoot.core.presentation import Presentable, Table, quantity_text
from underfoot.core.remark import Message

from .outcomes import CaseOutcome, outcomes

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
        "contaminant.pool_depth", 2.0, "of the fluid that the sole lands in", ratio=True, low=1e-5
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
class InputEffect:
    """Outcomes with one input at either end of its spread, everything else unchanged."""

    path: str
    reason: str
    low_value: float
    high_value: float
    unit: str
    low: CaseOutcome
    high: CaseOutcome

    def deviation(self, name: str, nominal: CaseOutcome) -> float:
        """Return the standard deviation that this input gives to a number.

        Root mean square of both departures from the nominal, so that an optimum within the
        spread counts; nan when an end could not be computed.
        """
        centre = nominal.number(name)
        departures = (self.low.number(name) - centre, self.high.number(name) - centre)
        return math.sqrt(sum(departure**2 for departure in departures) / 2)

    def ends(self) -> tuple[str, str]:
        """Return the input's low and high value as text."""
        return display(self.low_value, self.unit), display(self.high_value, self.unit)

    def results(self, name: str) -> tuple[str, str]:
        """Return a number at the low and at the high value as text."""

        def text(end: CaseOutcome) -> str:
            if not end.usable:
                return "not computed"
            value, unit = end.scalars[name].value, end.scalars[name].unit
            return "no film" if value is None else quantity_text(value, unit)

        return text(self.low), text(self.high)


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


QUANTITIES = {
    "cof": "Coefficient of friction",
    "fluid_load": "Load carried by the fluid",
    "fluid_load_sensor": "Load as floor sensors read it",
    "peak_fluid_pressure_sensor": "Peak pressure as a floor sensor reads it",
}
"""What the tables, files and figures of a sensitivity are about."""
MOST_INPUTS = 4
"""Inputs of one quantity in a table, the most effective first."""


@dataclass(frozen=True, slots=True)
class Sensitivity(Presentable):
    """A case and the effect of its open inputs, one at a time."""

    kind: ClassVar[str] = "sensitivity"

    nominal: CaseOutcome
    effects: tuple[InputEffect, ...]
    quick: bool = True

    def __repr__(self) -> str:
        return f"<Sensitivity of {self.nominal.name!r} to {len(self.effects)} inputs>"

    @property
    def usable(self) -> bool:
        return self.nominal.usable

    def heading(self) -> str:
        return self.nominal.name

    def headline(self) -> tuple[Message, ...]:
        if not self.usable:
            return (
                Message(
                    "No result: {status}. {remedy}",
                    status=self.nominal.status, remedy=self.nominal.remedy,
                ),
            )  # fmt: skip
        band = self.band("cof")
        sentences = [
            Message(
                "COF {value:.3f} ± {deviation:.3f} (friction law ± {law:.3f}, assumed inputs ± "
                "{inputs:.3f}); over all variants {lowest:.3f} to {highest:.3f}.",
                value=band.value, deviation=band.deviation, law=band.law, inputs=band.inputs,
                lowest=band.lowest, highest=band.highest,
            )
        ]  # fmt: skip
        if self.effects:
            first = self.ranked_effects("cof")[0]
            sentences.append(
                Message(
                    "Most effective input: {path}, {inputs: to } changes the COF from "
                    "{results: to }.",
                    path=first.path, inputs=first.ends(), results=first.results("cof"),
                )
            )  # fmt: skip
        return tuple(sentences)

    def cautions(self) -> tuple[Message, ...]:
        if not self.usable:
            return ()
        reasons: list[Message] = []
        if self.quick:
            reasons.append(
                Message("Coarse grid: use the differences; take values from underfoot run.")
            )
        if missing := self.band("cof").not_computed:
            reasons.append(Message("Not computed, so not in the ±: {missing}.", missing=missing))
        return tuple(reasons)

    def table(self) -> Table:
        rows = []
        for name, label in QUANTITIES.items():
            band, unit = self.band(name), self.nominal.scalars[name].unit
            value = quantity_text(band.value, unit, band.deviation)
            low, high = (quantity_text(end, unit) for end in (band.lowest, band.highest))
            rows.append((label, value, Message("{low} to {high}", low=low, high=high)))
        return Table("Law and inputs together", ("Quantity", "Value ± 1 sd", "Variants"), rows)

    def tables(self) -> tuple[Table, ...]:
        if not self.usable:
            return ()
        heads = ("Input", "Low", "High", "Result at low", "Result at high")
        tables = [self.table()]
        for name, label in QUANTITIES.items():
            rows = [
                (effect.path, *effect.ends(), *effect.results(name))
                for effect in self.ranked_effects(name)[:MOST_INPUTS]
            ]
            tables.append(
                Table(
                    Message("{label}: one standard deviation to either side", label=label),
                    heads,
                    rows,
                )
            )
        return tuple(tables)

    def remarks(self) -> dict[str, Sequence[str]]:
        reasons = [
            Message("{path}: {reason}", path=effect.path, reason=effect.reason)
            for effect in self.ranked_effects("cof")
        ]
        return {"Reasons for the ranges": reasons}

    def to_dict(self) -> dict[str, Any]:
        quantities = {}
        for name in QUANTITIES:
            band = self.band(name)
            quantities[name] = {
                "value": band.value,
                "unit": self.nominal.scalars[name].unit,
                "uncertainty": band.deviation,
                "from_inputs": band.inputs,
                "from_law": band.law,
                "lowest": band.lowest,
                "highest": band.highest,
                "not_computed": list(band.not_computed),
                "effects": [
                    {
                        "path": effect.path,
                        "low": [effect.low_value, effect.low.number(name)],
                        "high": [effect.high_value, effect.high.number(name)],
                        "deviation": effect.deviation(name, self.nominal),
                        "reason": effect.reason,
                    }
                    for effect in self.ranked_effects(name)
                ],
            }
        return {"quantities": quantities}

    def data_tables(self) -> dict[str, Table]:
        heads = tuple(
            "quantity unit nominal input low_input high_input input_unit at_low at_high deviation "
            "reason".split()
        )
        nominal = self.nominal
        rows = [
            (
                *(name, nominal.scalars[name].unit, nominal.number(name)),
                *(effect.path, effect.low_value, effect.high_value, effect.unit),
                *(effect.low.number(name), effect.high.number(name)),
                *(effect.deviation(name, nominal), effect.reason),
            )
            for name in QUANTITIES
            for effect in self.ranked_effects(name)
        ]
        return {"sensitivity": Table("", heads, rows)}

    def band(self, name: str) -> Band:
        """Return the band of a number: first-order, inputs taken as independent."""
        value = self.nominal.number(name)
        deviations = [effect.deviation(name, self.nominal) for effect in self.effects]
        ends = [end.number(name) for effect in self.effects for end in (effect.low, effect.high)]
        values = [value, *(end for end in ends if not math.isnan(end))]
        inputs = math.sqrt(
            sum(deviation**2 for deviation in deviations if not math.isnan(deviation))
        )
        law = self.nominal.standard_deviation(name)
        law = 0.0 if math.isnan(law) else law
        pairs = zip(self.effects, deviations, strict=True)
        failed = tuple(effect.path for effect, each in pairs if math.isnan(each))
        both = math.hypot(inputs, law)
        return Band(value, both, inputs, law, min(values), max(values), failed)

    def ranked_effects(self, name: str) -> list[InputEffect]:
        """Return the effects on a number, largest first."""

        def size(effect: InputEffect) -> float:
            deviation = effect.deviation(name, self.nominal)
            return 0.0 if math.isnan(deviation) else -deviation

        return sorted(self.effects, key=size)

    ranked = renamed_member("ranked", "ranked_effects", gone="0.4")


def open_inputs(case: Case, inputs: Sequence[OpenInput] = OPEN_INPUTS) -> list[OpenInput]:
    """Return the inputs of ``inputs`` that the case uses.

    A value that came with a standard deviation of its own is varied by that.
    """
    chosen = []
    for each in inputs:
        if each.path in case.idle_paths or case.value(each.path) is None:
            continue
        if each.path == "contaminant.pool_depth" and case.motion.end_time is None:
            continue  # steady sliding has forgotten it
        if each.only_assumed and not case.sourced_value(each.path).assumed:
            continue
        if each.path == "shoe.material.shore_a" and case.shoe.material.modulus is not None:
            continue
        if uncertainty := case.sourced_value(each.path).uncertainty:
            each = replace(
                each, deviation=uncertainty, reason="its stated uncertainty", ratio=False
            )
        chosen.append(each)
    return chosen


def variants(
    case: Case, inputs: Sequence[OpenInput] | None = None
) -> list[tuple[OpenInput, float, float, Case, Case]]:
    """Return each open input with its two ends and the two cases there."""
    plan = []
    for each in open_inputs(case) if inputs is None else inputs:
        low, high = each.ends(float(case.value(each.path)))
        at_low, at_high = (_at(case, each, value) for value in (low, high))
        plan.append((each, low, high, at_low, at_high))
    return plan


def _at(case: Case, varied: OpenInput, value: float) -> Case:
    """Return the case with an open input at a value (SI), and what keeps its ratio to it."""
    ratio = value / float(case.value(varied.path))
    along = {path: ratio * float(case.value(path)) for path in varied.along}
    return case.replace({varied.path: value, **along})


def sensitivity(
    case: Case,
    *,
    inputs: Sequence[OpenInput] | None = None,
    quick: bool = True,
    processes: int | None = 1,
    progress: Progress = silent,
) -> Sensitivity:
    """Return the results of a case and the effect of its open inputs, one at a time.

    Parameters:
        case: What to vary.
        inputs: What to vary in it; None takes ``open_inputs(case)``.
        quick: Use the coarse grid: differences need less resolution than values.
        processes, progress: As for ``outcomes``; progress sees every case of the plan.

    Two runs an input, at one standard deviation to either side. First order: effects of two
    inputs together are not looked for, and their independence is assumed.
    """
    plan = variants(case, inputs)
    cases = [case, *(end for *_, low, high in plan for end in (low, high))]
    stage = "Simulating variants"
    results = outcomes(cases, quick=quick, processes=processes, progress=progress, stage=stage)
    effects = [
        InputEffect(each.path, each.reason, low, high, unit_at(each.path), *results[k : k + 2])
        for k, (each, low, high, _, _) in zip(range(1, len(cases), 2), plan, strict=True)
    ]
    return Sensitivity(results[0], tuple(effects), quick)
