"""What machines read of floors of known roughness, beside what is predicted without the source."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, ClassVar

import numpy as np

from underfoot.core import to_si
from underfoot.core.presentation import Presentable, Table

from .calibration import FloorReading, class_bounds
from .joint import JointDraws, interval
from .machines import RZ_SPREAD, machine, machines

WANTED = 20
"""Floors from which on a score says something (median error, rank correlation, coverage)."""
ANCHORED = "bands of HSE"
"""The source that the anchors of the pendulum are of."""


@dataclass(frozen=True, slots=True)
class ScoredReading:
    """A published reading and its prediction, median and 95 %, in the machine's unit."""

    source: str
    rz: tuple[float, float]
    bounds: tuple[FloorReading, ...]
    predicted: tuple[float, float, float]

    @property
    def inside(self) -> bool:
        """Whether the interval of the prediction holds the reading, or reaches its bounds."""
        low, _, high = self.predicted
        return all(
            (one.kind == "upper" or high >= one.value) and (one.kind == "lower" or low <= one.value)
            for one in self.bounds
        )

    @property
    def error(self) -> float | None:
        """Median less reading; None of a bound."""
        first = self.bounds[0]
        return self.predicted[1] - first.value if first.kind == "value" else None


@dataclass(frozen=True, slots=True)
class MachineScores(Presentable):
    """The machines, and how their predictions compare with what can be read."""

    kind: ClassVar[str] = "machine_scores"

    rows: tuple[ScoredReading, ...]

    def heading(self) -> str:
        """Return the title."""
        return "Machines that read floors"

    def headline(self) -> tuple[str, ...]:
        """Return the score, or why there is none."""
        errors = [abs(row.error) for row in self.rows if row.error is not None]
        sources = {row.source for row in self.rows}
        inside = sum(row.inside for row in self.rows)
        return (
            f"{len(self.rows)} readings of {len(sources)} sources, each predicted without its "
            f"source: {inside} lie in the 95 % interval or reach it; the {len(errors)} that are no "
            f"bounds are missed by {np.median(errors):.0f} PTV in the median.",
            f"That is no score: {WANTED} floors with roughness and reading are wanted.",
        )

    def table(self) -> Table:
        """Return each reading beside its prediction."""
        rows = []
        for row in self.rows:
            low, median, high = (f"{x:.0f}" for x in row.predicted)
            low_rz, high_rz = (f"{1e6 * x:.0f}" for x in row.rz)
            rz = low_rz if low_rz == high_rz else f"{low_rz} to {high_rz}"
            read = ", ".join(str(one).partition(": ")[2] for one in row.bounds)
            title = row.bounds[0].machine.title
            verdict = "inside" if row.inside else "OUTSIDE"
            rows.append((row.source, title, rz, read, median, f"{low} to {high}", verdict))
        heads = ("Source", "Machine", "Rz, um", "Read", "Predicted", "95 %", "")
        return Table("Readings of floors of known roughness", heads, rows)

    def tables(self) -> tuple[Table, ...]:
        """Return the readings and the machines."""
        rows = [
            (one.name, one.standard, ", ".join(one.fluids), one.reproducibility)
            for one in machines().values()
        ]
        heads = ("Machine", "Standard", "Fluids", "Between laboratories")
        return self.table(), Table("Machines", heads, rows)


def machine_scores(seed: int = 0) -> MachineScores:
    """Return every reading that can be read beside its prediction with the source left out."""
    return MachineScores(tuple(_scored(entry, seed) for entry in _entries()))


@cache
def _entries() -> tuple[Mapping[str, Any], ...]:
    text = resources.files("underfoot_places").joinpath("evidence.toml").read_text("utf-8")
    return tuple(tomllib.loads(text)["reading"])


def _scored(entry: Mapping[str, Any], seed: int) -> ScoredReading:
    device, source = machine(entry["machine"]), entry["source"]
    low, high = (to_si(end, "m", where=source) for end in entry["rz"])
    fluid = device.fluid_of_standard()
    bounds = (
        class_bounds(device, entry["class"], source)
        if "class" in entry
        else (FloorReading(device, fluid, entry["value"], entry.get("kind", "value")),)
    )
    joint = JointDraws(seed=seed)
    if source != ANCHORED:
        device.learn_anchors(joint)
    rq = low / RZ_SPREAD[1], high / RZ_SPREAD[0]
    predicted = interval(device.scale.reading(device.cof(joint, "floor", rq, fluid)))
    return ScoredReading(source, (low, high), bounds, predicted)
