"""Tables of the study of G.4."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from underfoot.core import display

from .g4_conditions import Condition, DepthRow
from .g4_judged import Judged, right_side
from .pin_study import PinTable

if TYPE_CHECKING:
    from underfoot.assess.outcomes import Outcome
    from underfoot.assess.sensitivity import Sensitivity


def conditions_table(results: Sequence[Judged]) -> PinTable:
    """Return loads, peaks, places and COF of the twelve, with bands."""
    rows = []
    for one in results:
        x, y = one.reading.place
        printed = one.condition.printed_load
        peak = one.peak.value > 1e3  # no place for a peak that is none
        rows.append(
            (
                one.condition.name,
                "< 5" if printed is None else f"{printed:.0f}",
                one.load.value, _or_none(one.load.low), _or_none(one.load.high),
                "yes" if one.right else "no", one.probability,
                one.true_load.value, _or_none(one.true_load.low), _or_none(one.true_load.high),
                one.peak.value / 1e3,
                _or_none(one.peak.low / 1e3), _or_none(one.peak.high / 1e3),
                1e3 * x if peak else None, 1e3 * y if peak else None,
                one.cof.value, _or_none(one.cof.low), _or_none(one.cof.high),
                one.reading.process_seconds,
            )
        )  # fmt: skip
    columns = (
        "condition", "report N", "sensor N", "low", "high", "right side of 5 N", "probability",
        "under the sole N", "true low", "true high", "peak kPa", "peak low", "peak high",
        "peak from back mm", "peak left of middle mm", "COF", "COF low", "COF high", "processor s",
    )  # fmt: skip
    return PinTable(
        "conditions", "Six shoes in two fluids: sensor's and true load, peak and its place, COF; "
        "central 95 % of what is open", columns, tuple(rows),
    )  # fmt: skip


def lower_table(results: Sequence[Judged], lower: Mapping[str, Outcome]) -> PinTable:
    """Return the readings at 250 N."""
    rows = []
    for one in results:
        if one.condition.name not in lower:
            continue
        found = lower[one.condition.name]
        load = found.number("fluid_load_sensor")
        side = right_side(load, printed=one.condition.printed_load)
        rows.append(
            (one.condition.name, load, found.number("fluid_load"), found.number("cof"),
             "yes" if side else "no")
        )  # fmt: skip
    return PinTable(
        "lower_force", "The same at 250 N where COF is above 0.11, as the tester was run (G.4.1; "
        "quick grid)",
        ("condition", "sensor N", "under the sole N", "COF", "right side of 5 N"), tuple(rows),
    )  # fmt: skip


def inputs_table(condition: Condition, found: Sensitivity) -> PinTable:
    """Return what each open input does to load and peak of one condition."""
    rows = []
    for effect in found.ranked("peak_fluid_pressure_sensor"):
        loads = [end.number("fluid_load_sensor") for end in (effect.low, effect.high)]
        peaks = [
            end.number("peak_fluid_pressure_sensor") / 1e3 for end in (effect.low, effect.high)
        ]
        rows.append(
            (effect.path, display(effect.low_value, effect.unit),
             display(effect.high_value, effect.unit), *loads, *peaks, effect.reason)
        )  # fmt: skip
    load = found.nominal.number("fluid_load_sensor")
    peak = found.nominal.number("peak_fluid_pressure_sensor") / 1e3
    return PinTable(
        f"open_inputs_{condition.kind}",
        f"What one standard deviation of each open input does ({condition.name}; quick grid, where "
        f"the sensor reads {load:.0f} N and {peak:.0f} kPa)",
        ("input", "low", "high", "N at low", "N at high", "kPa at low", "kPa at high", "why open"),
        tuple(rows),
    )  # fmt: skip


def depth_table(depths: Sequence[DepthRow]) -> PinTable:
    """Return readings against depth of tread."""
    return PinTable(
        "tread_depth", "Work shoe of 71 Shore A in glycerol, lugs of 5 mm, channels of 2.4 mm; "
        "quick grid",
        ("depth mm", "sensor N", "under the sole N", "peak by sensor kPa", "COF"),
        tuple(
            (1e3 * row.depth, row.sensor_load, row.fluid_load, row.peak / 1e3, row.cof)
            for row in depths
        ),
    )  # fmt: skip


def _or_none(value: float) -> float | None:
    return None if value != value else value
