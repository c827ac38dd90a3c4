"""The twelve conditions of G.4 as cases, each with its readings, its map and its open inputs."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Progress, silent
from underfoot.core.catalogue import Catalogue

if TYPE_CHECKING:
    from underfoot.assess.outcomes import Outcome
    from underfoot.assess.sensitivity import OpenInput, Sensitivity
    from underfoot.case import Case

KINDS = ("work", "athletic")
TREADS = ("untreaded", "half_tread", "full_tread")
FLUIDS = {"glycerol": "glycerol_90pct", "detergent": "detergent"}
FLOOR, SETUP = "vinyl_g4", "slip_tester_g4"
LOWER_FORCE, LOWER_FORCE_ABOVE = 250.0, 0.11
"""N, and the COF above which the tester of the report pressed with no more (G.4.1)."""
DECIDING = (
    "shoe.heel.facet_angle",
    "interface.roughness_beyond_cutoff",
    "motion.start_film",
    "shoe.tread.lug_width",
)
"""Open inputs that are varied under treaded shoes: the others move readings near 0 by less."""
LEAST = {"fluid_load_sensor": 0.01, "fluid_load": 0.01, "peak_fluid_pressure_sensor": 100.0}
"""N, Pa: smaller readings are none."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Condition:
    """One shoe in one fluid, and what the report prints of it (None: below 5 N, no peak)."""

    kind: str
    tread: str
    fluid: str
    printed_load: float | None
    printed_peak: float | None

    @property
    def name(self) -> str:
        """As a reader sees it."""
        return f"{self.kind}, {self.tread.replace('_', ' ')}, {self.fluid}"

    @property
    def untreaded(self) -> bool:
        """Whether the tread is ground off."""
        return self.tread == "untreaded"

    @cached_property
    def case(self) -> Case:
        """The case: catalogue entries only, nothing set for this condition alone."""
        from underfoot.case import Case

        return Case.from_mapping(
            {
                "file_version": 1,
                "name": self.name,
                "shoe": {"from": f"{self.kind}_shoe_{self.tread}"},
                "floor": {"from": FLOOR},
                "contaminant": {"from": FLUIDS[self.fluid]},
                "motion": {"from": SETUP},
                "sensor": {"from": SETUP},
            }
        )


@dataclass(frozen=True, slots=True, eq=False)
class Reading:
    """What one condition gave; map and places (m) as the tracks in the middle position see them.

    ``x``, ``y`` and ``pressure`` (len(x), len(y)) in m and Pa, ``outline`` (n, 2) of the plan form.
    """

    condition: Condition
    outcome: Outcome
    x: Array
    y: Array
    pressure: Array
    outline: Array
    process_seconds: float

    @property
    def place(self) -> tuple[float, float]:
        """Where the highest reading lies: from the back of the heel, and left of the middle, m."""
        top = np.unravel_index(int(self.pressure.argmax()), self.pressure.shape)
        return float(self.x[top[0]]), float(self.y[top[1]])

    def number(self, name: str) -> float:
        """Return a scalar in SI."""
        return self.outcome.number(name)


def conditions() -> list[Condition]:
    """Return the twelve: work and athletic shoe, three depths of tread, two fluids."""
    entry = Catalogue.load().entry("published", "slip_tester_g4")

    def printed(quantity: str, unit: str, kind: str, tread: str, fluid: str) -> float | None:
        name = f"{quantity}_{kind}_shoe_{tread}_{fluid}"
        return entry.sourced(name, unit).value if name in entry.values else None

    return [
        Condition(
            kind, tread, fluid,
            printed("fluid_load", "N", kind, tread, fluid),
            printed("peak_pressure", "Pa", kind, tread, fluid),
        )
        for kind in KINDS for tread in TREADS for fluid in FLUIDS
    ]  # fmt: skip


def reading(condition: Condition, *, quick: bool = False) -> Reading:
    """Return what a condition gives, with the map as the sensors see it."""
    from underfoot.assess.outcomes import Outcome
    from underfoot.case.run import run

    begun = time.process_time()
    result = run(condition.case, quick=quick)
    fields = result.fields
    return Reading(
        condition,
        Outcome.of(result),
        fields["sensor_x"].values,
        fields["sensor_y"].values,
        fields["sensor_pressure"].values,
        np.column_stack([fields["outline_x"].values, fields["outline_y"].values]),
        time.process_time() - begun,
    )


def inputs_of(condition: Condition) -> list[OpenInput]:
    """Return the open inputs that are varied: all of an untreaded shoe, the deciding ones else."""
    from underfoot.assess.sensitivity import open_inputs

    found = open_inputs(condition.case)
    return found if condition.untreaded else [one for one in found if one.path in DECIDING]


def sensitivities(
    chosen: list[Condition], *, processes: int | None = 1, progress: Progress = silent
) -> tuple[dict[str, Sensitivity], list[str]]:
    """Return what the open inputs do to each condition, by its name, and what gave no result.

    On the quick grid. An end at which the contact can't be solved takes its input out of the band.
    """
    from underfoot.assess.sensitivity import sensitivity
    from underfoot.core import ConvergenceError

    found: dict[str, Sensitivity] = {}
    lost: list[str] = []
    for number, one in enumerate(chosen):
        progress(f"Open inputs: {one.name}", number / len(chosen))
        inputs = inputs_of(one)
        try:
            found[one.name] = sensitivity(one.case, inputs=inputs, processes=processes)
            continue
        except ConvergenceError:
            whole = sensitivity(one.case, inputs=[])
        for each in inputs:  # what is solved already comes from the cache
            try:
                more = sensitivity(one.case, inputs=[each], processes=processes)
                whole = replace(whole, effects=(*whole.effects, *more.effects))
            except ConvergenceError:
                lost.append(f"{one.name}: {each.path}")
        found[one.name] = whole
    return found, lost


def at_lower_force(
    readings: list[Reading], *, processes: int | None = 1, progress: Progress = silent
) -> dict[str, Outcome]:
    """Return the conditions above COF 0.11 at 250 N, where the tester gave no more; by name."""
    from underfoot.assess.outcomes import outcomes

    high = [one for one in readings if one.number("cof") > LOWER_FORCE_ABOVE]
    cases = [one.condition.case.replace("motion.normal_force", f"{LOWER_FORCE} N") for one in high]
    found = outcomes(cases, quick=True, processes=processes, progress=progress)
    return {one.condition.name: each for one, each in zip(high, found, strict=True)}


@dataclass(frozen=True, slots=True)
class DepthRow:
    """Readings of one shoe at one depth of tread (m): loads in N, peak in Pa."""

    depth: float
    sensor_load: float
    fluid_load: float
    peak: float
    cof: float


def depth_series(
    depths: tuple[float, ...], *, processes: int | None = 1, progress: Progress = silent
) -> list[DepthRow]:
    """Return the half-treaded work shoe in glycerol with its tread at other depths.

    One compound, one roughness and one set of channels, so that the depth alone changes; on the
    quick grid. A depth of 0 is the shoe without channels.
    """
    from underfoot.assess.outcomes import outcomes

    base = next(c for c in conditions() if (c.kind, c.tread) == ("work", "half_tread")).case
    cases = [
        base.replace("shoe.tread.depth", f"{depth!r} m")
        if depth > 0
        else base.replace("shoe.tread.pattern", "none")
        for depth in depths
    ]
    found = outcomes(cases, quick=True, processes=processes, progress=progress)
    names = ("fluid_load_sensor", "fluid_load", "peak_fluid_pressure_sensor", "cof")
    return [
        DepthRow(depth, *(one.number(name) for name in names))
        for depth, one in zip(depths, found, strict=True)
    ]
