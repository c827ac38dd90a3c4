"""Every printed statement of G.4.2 and G.4.3 beside ours, with a verdict and its reason."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise, product

import numpy as np

from .g4_conditions import KINDS, TREADS, DepthRow
from .g4_judged import LOAD_WITHIN, PEAK_WITHIN, SMALL, Banded, Judged, against
from .pin_study import PinLine
from .verdict import Verdict

TRACKS = 10e-3
"""Distance of the tracks, m: no place across the shoe is known better."""
EVERY_CHANCE = 0.95
ALPHA = 0.01

By = Mapping[tuple[str, str, str], Judged]


def all_lines(results: Sequence[Judged], depths: Sequence[DepthRow]) -> tuple[PinLine, ...]:
    """Return the lines in the order of the report."""
    by = {(r.condition.kind, r.condition.tread, r.condition.fluid): r for r in results}
    return (
        *(side_line(one) for one in results),
        *(line for kind in KINDS for line in _sizes(by[kind, "untreaded", "glycerol"])),
        *_places(by),
        *_trends(by),
        *(_depth_lines(depths) if depths else ()),
        *variance_lines(results),
    )


def side_line(one: Judged) -> PinLine:
    """Return the line that says whether a load lies on the report's side of 5 N."""
    printed = one.condition.printed_load
    chance = "" if one.probability is None else f"; probability {_chance(one.probability)}"
    ours = f"{_load(one.load)}{chance}"
    if not one.reading.outcome.usable:
        return PinLine(
            f"side of 5 N: {one.condition.name}", "G.4.2", _printed_load(printed), "-",
            Verdict.NOT_AVAILABLE, one.reading.outcome.remedy,
        )  # fmt: skip
    verdict = Verdict.REPRODUCED if one.right else Verdict.DISAGREES
    reason = "right side of 5 N" if one.right else "wrong side of 5 N"
    if one.right and one.probability is not None and one.probability < EVERY_CHANCE:
        reason += ", but the open inputs can move it over"
    return PinLine(
        f"side of 5 N: {one.condition.name}", "G.4.2", _printed_load(printed), ours, verdict, reason
    )


def _sizes(one: Judged) -> list[PinLine]:
    """Return load and peak of an untreaded shoe in glycerol against the printed numbers."""
    load, peak = one.condition.printed_load, one.condition.printed_peak
    assert load is not None
    assert peak is not None
    found = []
    for what, printed, within, value, chance, factor, unit in (
        ("fluid load", load, LOAD_WITHIN, one.load, one.load_within, 1.0, "N"),
        ("peak pressure", peak, PEAK_WITHIN, one.peak, one.peak_within, 1e-3, "kPa"),
    ):
        off = value.value / printed - 1.0
        reason = f"{100 * off:+.0f} %, {100 * within:.0f} % wanted"
        if chance is not None:
            reason += f"; the open inputs leave a probability of {_chance(chance)} for that"
        found.append(
            PinLine(
                f"{what}: {one.condition.name}", "G.4.2", f"{printed * factor:.0f} {unit}",
                _text(value, factor, unit), against(printed, within, value, right=one.right),
                reason, f"{100 * off:+.0f} %",
            )
        )  # fmt: skip
    return found


def _places(by: By) -> list[PinLine]:
    work, athletic = (by[kind, "untreaded", "glycerol"] for kind in KINDS)
    x, y = work.reading.place
    near = abs(y) <= TRACKS and abs(x - 20e-3) <= TRACKS
    lines = [
        PinLine(
            "place of the peak: work shoe", "G.4.3",
            "about 20 mm from the back of the heel, near the centre line",
            f"{1e3 * x:.0f} mm from the back, {_side(y)}",
            Verdict.REPRODUCED if near else Verdict.DISAGREES,
            "within the 10 mm between two tracks" if near
            else "the peak stands at the front end of the ground facet, whose length is assumed",
        )
    ]  # fmt: skip
    arc = athletic.condition.case.shoe.tread.arc_channel
    assert arc is not None
    x, y = athletic.reading.place
    channel = arc.position + arc.radius - math.sqrt(max(arc.radius**2 - y**2, 0.0))
    ahead, behind = split(athletic, arc.position, arc.radius)
    lines += [
        PinLine(
            "place of the peak: athletic shoe", "G.4.2", "anterior of the arc channel",
            f"{1e3 * x:.0f} mm from the back, {_side(y)}; channel at {1e3 * channel:.0f} mm there",
            Verdict.REPRODUCED if x > channel else Verdict.DISAGREES,
            "the channel vents what lies behind it" if x > channel
            else "the channel's place is assumed",
        ),
        PinLine(
            "side of the peak: athletic shoe", "G.4.2", "medial", "-", Verdict.NOT_AVAILABLE,
            "the assumed heel is the same on both sides, so that it has no medial one",
        ),
        PinLine(
            "two regions: athletic shoe", "G.4.2", "on either side of the arc channel",
            f"highest before it {ahead / 1e3:.0f} kPa, behind it {behind / 1e3:.0f} kPa",
            Verdict.REPRODUCED if min(ahead, behind) > 0.1 * max(ahead, behind)
            else Verdict.DISAGREES,
            "a region counts from a tenth of the peak",
        ),
    ]  # fmt: skip
    return lines


def split(one: Judged, position: float, radius: float) -> tuple[float, float]:
    """Return the highest readings before and behind the arc channel's middle line, Pa."""
    x, y = one.reading.x[:, None], one.reading.y[None, :]
    line = position + radius - np.sqrt(np.maximum(radius**2 - y**2, 0.0))
    pressure = one.reading.pressure
    ahead = np.where(x > line, pressure, 0.0).max()
    return float(ahead), float(np.where(x <= line, pressure, 0.0).max())


def _trends(by: By) -> list[PinLine]:
    def load(kind: str, tread: str, fluid: str) -> float:
        return by[kind, tread, fluid].load.value

    falls = [
        load(k, "untreaded", "glycerol") > 5 * load(k, "half_tread", "glycerol") for k in KINDS
    ]
    same = [
        abs(load(k, "half_tread", f) - load(k, "full_tread", f)) < SMALL
        for k, f in product(KINDS, ("glycerol", "detergent"))
    ]
    thinner = [
        load(k, "untreaded", "glycerol") > 5 * load(k, "untreaded", "detergent") for k in KINDS
    ]
    only = [
        abs(load(k, t, "glycerol") - load(k, t, "detergent")) < SMALL
        for k, t in product(KINDS, TREADS[1:])
    ]
    pairs = [
        ("load falls from no tread to half tread, glycerol", "decreases dramatically", falls,
         [f"{load(k, 'untreaded', 'glycerol'):.0f} to {load(k, 'half_tread', 'glycerol'):.1f} N"
          for k in KINDS]),
        ("load from half to full tread", "does not change", same,
         [f"{load(k, 'half_tread', 'glycerol'):.1f} to {load(k, 'full_tread', 'glycerol'):.1f} N"
          for k in KINDS]),
        ("load falls with viscosity, no tread", "only with the high viscosity", thinner,
         [f"{load(k, 'untreaded', 'glycerol'):.0f} to {load(k, 'untreaded', 'detergent'):.1f} N"
          for k in KINDS]),
        ("viscosity matters without tread only", "interaction of fluid and tread", only,
         [f"with tread at most {max(load(k, t, 'glycerol') for k in KINDS for t in TREADS[1:]):.1f}"
          " N in either fluid"]),
    ]  # fmt: skip
    return [
        PinLine(
            name, source, printed, "; ".join(words),
            Verdict.REPRODUCED if all(holds) else Verdict.DISAGREES, "by the sensor",
        )
        for (name, printed, holds, words), source in zip(
            pairs, ("G.4.3", "G.4.3", "G.4.2", "G.4.2"), strict=True
        )
    ]  # fmt: skip


def threshold(depths: Sequence[DepthRow], below: float = SMALL) -> tuple[float, float] | None:
    """Return the two neighbouring depths (m) between which the sensor's load falls below 5 N."""
    rows = sorted(depths, key=lambda row: row.depth)
    for shallow, deep in pairwise(rows):
        if shallow.sensor_load >= below and all(
            row.sensor_load < below for row in rows if row.depth >= deep.depth
        ):
            return shallow.depth, deep.depth
    return None


def _depth_lines(depths: Sequence[DepthRow]) -> list[PinLine]:
    deep = [row for row in depths if 1.5e-3 <= row.depth <= 3e-3]
    change = max(row.sensor_load for row in deep) - min(row.sensor_load for row in deep)
    found = threshold(depths)
    true = [row.fluid_load for row in deep]
    return [
        PinLine(
            "tread of 1.5 to 3 mm, one compound", "G.4.3", "no change",
            f"by the sensor {min(r.sensor_load for r in deep):.1f} to "
            f"{max(r.sensor_load for r in deep):.1f} N",
            Verdict.REPRODUCED if change < SMALL else Verdict.DISAGREES,
            f"under the lugs {min(true):.0f} to {max(true):.0f} N: a 10 mm inlet always lies over "
            "a channel",
        ),
        PinLine(
            "threshold of tread depth", "G.4.3", "there is one, below 1.5 mm",
            "none found" if found is None
            else f"{1e3 * found[0]:g} to {1e3 * found[1]:g} mm for 5 N by the sensor",
            Verdict.REPRODUCED if found is not None and found[1] <= 1.5e-3
            else Verdict.DISAGREES,
            "the channel must drain what the wedge drags in",
        ),
    ]  # fmt: skip


def variance_lines(results: Sequence[Judged]) -> list[PinLine]:
    """Return the analysis of variance of our twelve loads, and of the printed ones beside it.

    Load against tread, fluid and their interaction, the two shoes as repeats (G.4.1, Data
    Analysis); the report's own twelve with 0 N for "below 5 N".
    """
    names = {
        "tread": "tread depth", "fluid": "fluid", "fluid:tread": "interaction of fluid and tread",
    }  # fmt: skip
    loads = [one.load.value for one in results]
    if any(math.isnan(load) for load in loads):
        return []
    ours = variance_p(results, loads)
    theirs = variance_p(results, [one.condition.printed_load or 0.0 for one in results])
    lines = []
    for term, name in names.items():
        p, printed = ours[term], theirs[term]
        verdict = Verdict.REPRODUCED if p < ALPHA else Verdict.TREND_ONLY
        lines.append(
            PinLine(
                f"analysis of variance: {name}", "G.4.2", "p < 0.01", f"p = {p:.2g}",
                verdict if p < 0.05 or printed > ALPHA else Verdict.DISAGREES,
                f"the report's own twelve loads give p = {printed:.2g} by this test with the two "
                "shoes as its only repeats; single trials, which would lower p, are not printed",
            )
        )  # fmt: skip
    return lines


def variance_p(results: Sequence[Judged], loads: Sequence[float]) -> dict[str, float]:
    """Return p of tread, fluid and their interaction ("fluid:tread")."""
    from underfoot.trials.statistics import analysis_of_variance

    table = analysis_of_variance(
        list(loads),
        {
            "fluid": [one.condition.fluid for one in results],
            "tread": [one.condition.tread for one in results],
        },
        ("fluid", "tread", "fluid:tread"),
    )
    return {row.term: row.p for row in table.rows if row.p is not None}


def _printed_load(printed: float | None) -> str:
    return "< 5 N" if printed is None else f"{printed:.0f} N"


def _load(value: Banded) -> str:
    return _text(value, 1.0, "N")


def _text(value: Banded, factor: float, unit: str) -> str:
    def number(one: float) -> str:
        shown = one * factor
        return f"{shown:.0f}" if shown >= 20 else f"{shown:.1f}"

    band = f" ({number(value.low)} to {number(value.high)})" if value.has_band else ""
    return f"{number(value.value)} {unit}{band}"


def _side(y: float) -> str:
    if abs(y) < 0.5e-3:
        return "on the centre line"
    return f"{1e3 * abs(y):.0f} mm {'left' if y > 0 else 'right'} of it"


def _chance(value: float) -> str:
    if value > 0.995:
        return "above 0.99"
    return "below 0.01" if value < 0.005 else f"{value:.2f}"
