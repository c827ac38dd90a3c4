"""The law of the pair calibrated to what a machine read of the floor of a case."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from underfoot.case import Case
from underfoot.compute.resolve import resolved
from underfoot.core import InputError
from underfoot.core.presentation import Presentable, Table
from underfoot.friction import PairContactLaw, PairDraws

from .joint import JointDraws, floor_name, interval
from .machines import Machine, machine, machine_fluid

KEPT = 1000


@dataclass(frozen=True, slots=True)
class FloorCalibration(Presentable):
    """Draws of the law, and the roughness of the floor (m) before and after the reading."""

    kind: ClassVar[str] = "floor_calibration"

    machine: Machine
    reading: float
    draws: PairDraws
    before: tuple[float, float, float]
    after: tuple[float, float, float]
    effective: float

    def heading(self) -> str:
        """Return the title."""
        return f"Floor by {self.machine.title}: {self.reading:g} {self.machine.scale.unit}"

    def headline(self) -> tuple[str, ...]:
        """Return what the reading says of the floor."""
        texts = [
            "{1:.2g} um (95 %: {0:.2g} to {2:.2g})".format(*(1e6 * x for x in each))
            for each in (self.before, self.after)
        ]
        if self.before[0] == self.before[2]:
            return ("The roughness of the floor is given: the reading narrows the law alone.",)
        return (f"Rq of the floor was {texts[0]} and is {texts[1]}.",)

    def table(self) -> Table:
        """Return the draws that are left."""
        rows = [("equal draws that are left", f"{self.effective:.0f}")]
        return Table("Draws", ("quantity", "value"), rows)


def calibrated_floor(
    case: Case, named: str, reading: float, *, kind: str = "value", fluid: str = "", seed: int = 0
) -> FloorCalibration:
    """Return the draws of the law calibrated to a machine's reading of the floor of a case.

    Raises:
        InputError: Another law of friction; a reading that the machine cannot print, or one that
            hardly any draw agrees with.
    """
    device = machine(named, "--machine")
    liquid = machine_fluid(fluid or device.fluids[0], "--fluid")
    value = device.checked(reading, "--reading")
    law = case.friction.build(resolved(case))
    if not isinstance(law, PairContactLaw) or law.draws.errors:
        raise InputError(
            f'the law is "{law.name}"' if not isinstance(law, PairContactLaw) else "has draws",
            where="friction",
            allowed='model = "pair" without draws_file',
        )
    joint, pair = JointDraws(seed=case.numerics.seed + seed), law.pair
    roughness = "roughness of floor floor"
    before = interval(joint.between(roughness, pair.floor_rq))
    device.learn_anchors(joint)
    log = device.log_likelihood(joint, "floor", pair.floor_rq, liquid, value, kind=kind)
    joint.learn(log, device.name)
    rows = np.arange(KEPT)  # in random order already
    kept = replace(
        joint.constants.rows(rows),
        errors={floor_name(pair): joint.share(roughness)[rows]},
        source=f"{joint.constants.source}; floor read by {device.title}: {value:g} "
        f"{device.scale.unit}",
    )
    after = interval(joint.between(roughness, pair.floor_rq))
    return FloorCalibration(device, value, kept, before, after, joint.fewest)
