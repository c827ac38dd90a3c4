"""Report G.4: fluid pressure under six shoes in two fluids on the slip tester."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.core import ConvergenceError, Progress, display, silent
from underfoot.core.catalogue import Catalogue
from underfoot.questions.outcomes import CaseOutcome, outcomes
from underfoot.questions.sensitivity import OpenInput, Sensitivity, open_inputs, sensitivity
from underfoot.trials.statistics import analysis_of_variance

from .figure import (
    OURS,
    PRINTED,
    SECOND,
    Figure,
    Layer,
    Panel,
    level,
    line,
    points,
)
from .runner import Computed, Options, StudyTable, part
from .sampled import sample_inputs
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("g4.toml")

KINDS = ("work", "athletic")
TREADS = ("untreaded", "half_tread", "full_tread")
FLUIDS = {"glycerol": "glycerol_90pct", "detergent": "detergent"}
FLOOR, SETUP = "vinyl_g4", "slip_tester_g4"
FINER = 0.7
"""Spacing of the finest grid over the default one."""
SMALL = 5.0
"""N: what the report calls negligible."""
LOWER_FORCE, LOWER_FORCE_ABOVE = 250.0, 0.11
"""N, and the COF above which the tester of the report pressed with no more (G.4.1)."""
DEPTHS = (0.0, 0.1e-3, 0.2e-3, 0.3e-3, 0.5e-3, 0.8e-3, 1.5e-3, 2.0e-3, 3.0e-3)
QUICK_DEPTHS = (0.0, 0.3e-3, 0.8e-3, 1.5e-3, 3.0e-3)
DECIDING = (
    "shoe.heel.facet_angle",
    "interface.roughness_beyond_cutoff",
    "shoe.tread.lug_width",
)
"""Open inputs varied under treaded shoes, where others move readings near 0 by less, and with
``quick``."""
ROUGHNESS_BEYOND_CUTOFF = {
    "value": 1.5,
    "assumed": True,
    "source": "chosen on G.4.2: 201 N and 234 kPa",
}
LOAD, TRUE_LOAD, PEAK = "fluid_load_sensor", "fluid_load", "peak_fluid_pressure_sensor"
LEAST = {LOAD: 0.01, TRUE_LOAD: 0.01, PEAK: 100.0}
"""N, Pa: smaller readings are none."""

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ShoeInFluid:
    """One shoe in one fluid; ``squares``: without finer cells along the sliding, for a look."""

    kind: str
    tread: str
    fluid: str
    squares: bool = False

    @property
    def path(self) -> str:
        """Beginning of the names of its quantities."""
        return f"{self.kind}.{self.tread}.{self.fluid}"

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
        """The case: catalogue entries and what all share, nothing set for this condition alone."""
        return Case.from_mapping(
            {
                "file_version": 1,
                "name": self.name,
                "shoe": {"from": f"{self.kind}_shoe_{self.tread}"},
                "floor": {"from": FLOOR},
                "contaminant": {"from": FLUIDS[self.fluid]},
                "motion": {"from": SETUP},
                "interface": {"roughness_beyond_cutoff": ROUGHNESS_BEYOND_CUTOFF},
                "sensor": {"from": SETUP},
                "numerics": {"cells_along": 1} if self.squares else {},
            }
        )


@dataclass(frozen=True, slots=True, eq=False)
class GridReading:
    """What one condition gave on grids from coarse to fine, and the finest one's map.

    ``x``, ``y`` and ``pressure`` (len(x), len(y)) in m and Pa as the tracks in the middle position
    see them, ``outline`` (n, 2) of the plan form; ``draws`` of each number over the open inputs.
    """

    condition: ShoeInFluid
    levels: tuple[tuple[float, CaseOutcome], ...]
    x: Array
    y: Array
    pressure: Array
    outline: Array
    draws: Mapping[str, Array]

    @property
    def outcome(self) -> CaseOutcome:
        """On the finest grid."""
        return self.levels[-1][1]

    @property
    def place(self) -> tuple[float, float]:
        """Where the highest reading lies: from the back of the heel, and left of the middle, m."""
        top = np.unravel_index(int(self.pressure.argmax()), self.pressure.shape)
        return float(self.x[top[0]]), float(self.y[top[1]])

    def number(self, name: str) -> float:
        """Return a scalar of the finest grid in SI."""
        return self.outcome.number(name)

    def band(self, name: str) -> tuple[float, float]:
        """Return the central 95 % of the draws, which holds the value itself; nan without draws."""
        if name not in self.draws:
            return math.nan, math.nan
        low, high = np.percentile(self.draws[name], [2.5, 97.5])
        return min(float(low), self.number(name)), max(float(high), self.number(name))

    def quantity(self, name: str, unit: str) -> ComputedQuantity:
        """Return a scalar with its grids and its distribution over the open inputs."""
        levels = [(spacing, outcome.number(name)) for spacing, outcome in self.levels]
        return ComputedQuantity.of(
            self.number(name), unit, draws=self.draws.get(name), levels=levels
        )


def conditions(*, squares: bool = False) -> list[ShoeInFluid]:
    """Return the twelve: work and athletic shoe, three depths of tread, two fluids."""
    return [ShoeInFluid(k, t, fluid, squares) for k in KINDS for t in TREADS for fluid in FLUIDS]


def compute(options: Options) -> Computed:
    """Return the twelve conditions on three grids, with bands from what the report leaves open.

    ``quick``: squares of the coarse grid alone, no bands under treaded shoes, fewer inputs and
    depths. Variants are kept on disk, so that a run stopped early goes on.
    """
    plan = conditions(squares=options.quick)
    varied, lost = sensitivities(
        [one for one in plan if one.untreaded or not options.quick],
        quick=options.quick,
        processes=options.processes,
        progress=part(options.progress, 0.0, 0.5),
    )
    readings = []
    for number, condition in enumerate(plan):
        options.progress(condition.name, 0.5 + 0.35 * number / len(plan))
        readings.append(reading(condition, varied.get(condition.name), quick=options.quick))
    options.progress("Tread depth and lower force", 0.9)
    base = ShoeInFluid("work", "half_tread", "glycerol", options.quick).case
    tried = QUICK_DEPTHS if options.quick else DEPTHS
    depths = depth_series(base, tried, processes=options.processes)
    lower = at_lower_force(readings, processes=options.processes)
    by = {one.condition.path: one for one in readings}
    untreaded = [by[f"{kind}.untreaded.glycerol"] for kind in KINDS]
    drawn = {"fig29_maps": map_figure(untreaded), "fig30_loads": load_figure(readings)}
    drawn["tread_depth"] = depth_figure(depths)
    tables = [conditions_table(readings), lower_table(lower), depth_table(depths)]
    for bare in untreaded:
        found = varied[bare.condition.name]
        tables.append(inputs_table(bare.condition, found))
        drawn[f"open_inputs_{bare.condition.kind}"] = inputs_figure(bare.condition, found)
    return Computed(
        quantities(by, depths),
        tables,
        drawn,
        conclusions(readings, varied, depths),
        [f"Not computed, not in a band: {each}." for each in lost],
    )


def reading(
    condition: ShoeInFluid, varied: Sensitivity | None, *, quick: bool = False
) -> GridReading:
    """Return what a condition gives on the quick grid, or on quick, default and finer ones."""
    numerics = condition.case.numerics
    spacings = [numerics.quick_grid_spacing]
    if not quick:
        spacings += [numerics.grid_spacing, FINER * numerics.grid_spacing]
    results = [
        run(condition.case.replace("numerics.grid_spacing", f"{spacing!r} m"))
        for spacing in spacings
    ]
    levels = tuple(zip(spacings, map(CaseOutcome.of, results), strict=True))
    fields = results[-1].data
    x, y, pressure = (fields[f"sensor_{name}"].values for name in ("x", "y", "pressure"))
    outline = np.column_stack([fields["outline_x"].values, fields["outline_y"].values])
    draws = {} if varied is None else {name: _draws(name, levels[-1][1], varied) for name in LEAST}
    return GridReading(condition, levels, x, y, pressure, outline, draws)


def _draws(name: str, outcome: CaseOutcome, varied: Sensitivity) -> Array:
    """Return draws of a number over open inputs and place of the tracks, about the finest grid."""
    value, spread = outcome.number(name), outcome.standard_deviation(name)
    factors = [1.0 + spread / value] if value > LEAST[name] and spread > 0 else []
    most = 500.0
    if name == PEAK:  # no pocket reads more than the highest pressure under the sole
        ends = [end for effect in varied.effects for end in (effect.low, effect.high)]
        highest = [one.number("peak_fluid_pressure") for one in (outcome, varied.nominal, *ends)]
        most = max(value * (1.0 + 1e-6), float(np.nanmax(highest)))
    return sample_inputs(varied, name, value=value, factors=factors, least=LEAST[name], most=most)


def inputs_of(condition: ShoeInFluid, *, quick: bool = False) -> list[OpenInput]:
    """Return the open inputs that are varied: all of an untreaded shoe, the deciding ones else."""
    inputs = open_inputs(condition.case)
    if condition.untreaded and not quick:
        return inputs
    return [open_input for open_input in inputs if open_input.path in DECIDING]


def sensitivities(
    chosen: list[ShoeInFluid],
    *,
    quick: bool = False,
    processes: int | None = 1,
    progress: Progress = silent,
) -> tuple[dict[str, Sensitivity], list[str]]:
    """Return what the open inputs do to each condition, by its name, and what gave no result.

    On the quick grid, without a tread at the shoe's own angle: that of the facet is an input. An
    end at which the contact can't be solved takes its input out of the band.
    """
    by_condition: dict[str, Sensitivity] = {}
    lost: list[str] = []
    for number, condition in enumerate(chosen):
        progress(f"Open inputs: {condition.name}", number / len(chosen))
        inputs = inputs_of(condition, quick=quick)
        case = (
            condition.case.replace("numerics.tread_positions", 1)
            if condition.untreaded
            else condition.case
        )
        try:
            by_condition[condition.name] = sensitivity(case, inputs=inputs, processes=processes)
            continue
        except ConvergenceError:
            whole = sensitivity(case, inputs=[])
        for each in inputs:  # what is solved already comes from the cache
            try:
                more = sensitivity(case, inputs=[each], processes=processes)
                whole = replace(whole, effects=(*whole.effects, *more.effects))
            except ConvergenceError:
                lost.append(f"{condition.name}: {each.path}")
        by_condition[condition.name] = whole
    return by_condition, lost


def at_lower_force(
    readings: Sequence[GridReading], *, processes: int | None = 1
) -> dict[str, CaseOutcome]:
    """Return the conditions above COF 0.11 at 250 N, where the tester gave no more; by name."""
    high = [one.condition for one in readings if one.number("cof") > LOWER_FORCE_ABOVE]
    cases = [
        condition.case.replace("motion.normal_force", f"{LOWER_FORCE} N") for condition in high
    ]
    found = outcomes(cases, quick=True, processes=processes)
    return {condition.name: each for condition, each in zip(high, found, strict=True)}


def depth_series(
    base: Case, depths: Sequence[float], *, processes: int | None = 1
) -> list[tuple[float, CaseOutcome]]:
    """Return the half-treaded work shoe in glycerol with its tread at other depths (m).

    One compound, one roughness and one set of channels, so that the depth alone changes; on the
    quick grid. A depth of 0 is the shoe without channels.
    """
    cases = [
        base.replace("shoe.tread.depth", f"{depth!r} m")
        if depth > 0
        else base.replace("shoe.tread.pattern", "none")
        for depth in depths
    ]
    found = outcomes(cases, quick=True, processes=processes)
    return list(zip(depths, found, strict=True))


def threshold(depths: Sequence[tuple[float, CaseOutcome]]) -> tuple[float, float] | None:
    """Return the two neighbouring depths (m) between which the sensor's load falls below 5 N."""
    loads = [(depth, outcome.number(LOAD)) for depth, outcome in sorted(depths, key=lambda d: d[0])]
    for (shallow, before), (deep, _) in pairwise(loads):
        if before >= SMALL and all(load < SMALL for depth, load in loads if depth >= deep):
            return shallow, deep
    return None


def quantities(
    by: Mapping[str, GridReading], depths: Sequence[tuple[float, CaseOutcome]]
) -> dict[str, ComputedQuantity]:
    """Return every quantity of the study by name."""
    by_name: dict[str, ComputedQuantity] = {}
    for path, one in by.items():
        by_name[f"{path}.load"] = one.quantity(LOAD, "N")
        by_name[f"{path}.peak"] = one.quantity(PEAK, "Pa")
    for kind in KINDS:
        for name, first, second in (
            ("tread_step", "untreaded.glycerol", "half_tread.glycerol"),
            ("half_to_full", "half_tread.glycerol", "full_tread.glycerol"),
            ("viscosity_step", "untreaded.detergent", "untreaded.glycerol"),
            ("viscosity_step_half_tread", "half_tread.detergent", "half_tread.glycerol"),
        ):
            a, b = by[f"{kind}.{first}"], by[f"{kind}.{second}"]
            levels = [
                (spacing, last.number(LOAD) - before.number(LOAD))
                for (spacing, last), (_, before) in zip(b.levels, a.levels, strict=True)
            ]
            by_name[f"{kind}.{name}"] = ComputedQuantity.of(levels[-1][1], "N", levels=levels)
    work, athletic = (by[f"{kind}.untreaded.glycerol"] for kind in KINDS)
    by_name["work.place"] = ComputedQuantity.of(work.place[0], "m")
    by_name["athletic.ahead_of_channel"] = ComputedQuantity.of(
        athletic.place[0] - channel_at(athletic, athletic.place[1]), "m"
    )
    deep = [outcome.number(LOAD) for depth, outcome in depths if 1.5e-3 <= depth <= 3e-3]
    by_name["depth.change"] = ComputedQuantity.of(max(deep) - min(deep), "N")
    limit = threshold(depths)
    none = ComputedQuantity.none("no depth that was computed brings it below 5 N", "m")
    by_name["depth.threshold"] = none if limit is None else ComputedQuantity.of(limit[1], "m")
    loads = [one.number(LOAD) for one in by.values()]
    terms = {"tread": "tread", "fluid": "fluid", "fluid:tread": "interaction"}
    p = dict.fromkeys(terms, math.nan)
    if all(math.isfinite(load) for load in loads):
        p = variance_p([one.condition for one in by.values()], loads)
    none = ComputedQuantity.none("the loads do not scatter")
    return by_name | {
        f"p.{n}": ComputedQuantity.of(p[t]) if t in p else none for t, n in terms.items()
    }


def channel_at(sensor_reading: GridReading, y: float) -> float:
    """Return where the arc channel's middle line lies at y (m), from the back of the heel."""
    tread = sensor_reading.condition.case.shoe.tread
    assert tread is not None
    arc = tread.arc_channel
    assert arc is not None
    return arc.position + arc.radius - math.sqrt(max(arc.radius**2 - y**2, 0.0))


def variance_p(chosen: Sequence[ShoeInFluid], loads: Sequence[float]) -> dict[str, float]:
    """Return p of tread, fluid and their interaction ("fluid:tread"); the shoes are repeats."""
    table = analysis_of_variance(
        list(loads),
        {
            "fluid": [condition.fluid for condition in chosen],
            "tread": [condition.tread for condition in chosen],
        },
        ("fluid", "tread", "fluid:tread"),
    )
    return {row.term: row.p for row in table.rows if row.p is not None}


def conclusions(
    readings: Sequence[GridReading],
    varied: Mapping[str, Sensitivity],
    depths: Sequence[tuple[float, CaseOutcome]],
) -> tuple[str, ...]:
    """Return what the study says, in sentences."""
    treaded = [one for one in readings if not one.condition.untreaded]
    most = max(treaded, key=lambda one: one.number(TRUE_LOAD))
    sentences = [
        f"The sensor does not see the film under lugs: up to {most.number(TRUE_LOAD):.0f} N "
        f"({most.condition.name}), of which it reads {most.number(LOAD):.1f} N. "
        "'Below 5 N' is a statement on the sensor."
    ]
    for one in readings:
        if one.condition.untreaded and one.condition.fluid == "glycerol":
            load, peak = (
                varied[one.condition.name].ranked_effects(name)[0] for name in (LOAD, PEAK)
            )
            sentences.append(
                f"{one.condition.name}: the load depends most on {load.path}, the peak depends "
                f"most on {peak.path}."
            )
    limit = threshold(depths)
    if limit is not None:
        sentences.append(
            f"Tread of {1e3 * limit[1]:g} mm is enough to bring the sensor below 5 N, "
            f"{1e3 * limit[0]:g} mm is not (lugs of 5 mm, channels of 2.4 mm)."
        )
    return tuple(sentences)


def conditions_table(readings: Sequence[GridReading]) -> StudyTable:
    """Return loads, peaks, places and COF of the twelve, with bands, on the finest grid."""
    rows = []
    for row in readings:
        bands = {name: row.band(name) for name in LEAST}
        # no place for a peak that is none
        x, y = row.place if row.number(PEAK) > 1e3 else (math.nan, math.nan)
        grids = [(f"{1e3 * spacing:.2g} mm", outcome) for spacing, outcome in row.levels]
        rows.append(
            {
                "condition": row.condition.name,
                "sensor N": row.number(LOAD),
                "low": bands[LOAD][0],
                "high": bands[LOAD][1],
                "under the sole N": row.number(TRUE_LOAD),
                "true low": bands[TRUE_LOAD][0],
                "true high": bands[TRUE_LOAD][1],
                "peak kPa": row.number(PEAK) / 1e3,
                "peak low": bands[PEAK][0] / 1e3,
                "peak high": bands[PEAK][1] / 1e3,
                "peak from back mm": 1e3 * x,
                "peak left of middle mm": 1e3 * y,
                "COF": row.number("cof"),
                **{f"N at {grid}": outcome.number(LOAD) for grid, outcome in grids},
                **{f"kPa at {grid}": outcome.number(PEAK) / 1e3 for grid, outcome in grids},
                "status": str(row.outcome.status),
            }
        )
    return StudyTable.of(
        "conditions",
        "Six shoes in two fluids on the finest grid: sensor's and true load, peak "
        "and its place, COF; central 95 % of what is open; load and peak on every grid",
        rows,
    )


def lower_table(lower: Mapping[str, CaseOutcome]) -> StudyTable:
    """Return the readings at 250 N."""
    return StudyTable(
        "lower_force",
        "The same at 250 N where COF is above 0.11, as the tester was run (G.4.1; quick grid)",
        ("condition", "sensor N", "under the sole N", "COF"),
        [
            (n, *(outcome.number(key) for key in (LOAD, TRUE_LOAD, "cof")))
            for n, outcome in lower.items()
        ],
    )


def inputs_table(condition: ShoeInFluid, varied: Sensitivity) -> StudyTable:
    """Return what each open input does to load and peak of one condition."""
    rows = [
        {
            "input": effect.path,
            "low": display(effect.low_value, effect.unit),
            "high": display(effect.high_value, effect.unit),
            "N at low": effect.low.number(LOAD),
            "N at high": effect.high.number(LOAD),
            "kPa at low": effect.low.number(PEAK) / 1e3,
            "kPa at high": effect.high.number(PEAK) / 1e3,
            "why open": effect.reason,
        }
        for effect in varied.ranked_effects(PEAK)
    ]
    return StudyTable.of(
        f"open_inputs_{condition.kind}",
        f"What one standard deviation of each open input does ({condition.name}; quick grid, where "
        f"the sensor reads {varied.nominal.number(LOAD):.0f} N and "
        f"{varied.nominal.number(PEAK) / 1e3:.0f} kPa)",
        rows,
    )


def depth_table(depths: Sequence[tuple[float, CaseOutcome]]) -> StudyTable:
    """Return readings against depth of tread."""
    return StudyTable.of(
        "tread_depth",
        "Work shoe of 71 Shore A in glycerol, lugs of 5 mm, channels of 2.4 mm; quick grid",
        [
            {
                "depth mm": 1e3 * depth,
                "sensor N": outcome.number(LOAD),
                "under the sole N": outcome.number(TRUE_LOAD),
                "peak by sensor kPa": outcome.number(PEAK) / 1e3,
                "COF": outcome.number("cof"),
            }
            for depth, outcome in depths
        ],
    )


def printed_value(name: str, kind: str, unit: str) -> float:
    """Return what the report prints for an untreaded shoe in glycerol."""
    published = Catalogue.load().entry("published", "slip_tester_g4")
    return float(published.sourced_value(f"{name}_{kind}_shoe_untreaded_glycerol", unit))


def map_figure(readings: Sequence[GridReading]) -> Figure:
    """Return Fig. 29: fluid pressure as seven tracks read it, heel's back at the bottom."""
    panels = []
    for shown in readings:
        kind = shown.condition.kind
        load, peak = (
            printed_value("fluid_load", kind, "N"),
            printed_value("peak_pressure", kind, "Pa"),
        )
        x, y = shown.place
        layers = (
            Layer("map", 1e3 * shown.y, 1e3 * shown.x, shown.pressure.T / 1e3),
            Layer("outline", 1e3 * shown.outline[:, 1], 1e3 * shown.outline[:, 0], colour="white"),
            points(1e3 * y, 1e3 * x, colour="white", marker="o"),
        )
        panels.append(
            Panel(
                layers,
                "across, left positive (mm)",
                "from the back of the heel (mm)",
                f"{kind} shoe: {shown.number(LOAD):.0f} N, "
                f"peak {shown.number(PEAK) / 1e3:.0f} kPa\n"
                f"(report {load:.0f} N, {peak / 1e3:.0f} kPa)",
                # left of the shoe on the left: the axis across is turned
                x_limits=(1e3 * float(shown.y.max()) + 5, 1e3 * float(shown.y.min()) - 5),
                y_limits=(-8.0, min(1e3 * float(shown.x.max()), 60.0)),
                legend="",
            )
        )
    return Figure(
        panels,
        "Fig. 29: untreaded shoes in glycerol, seven tracks 10 mm apart; ring: highest reading\n"
        "(map at the shoe's own angle; numbers are means over neighbouring angles)",
        columns=2,
        size=(4.4, 5.2),
        share_y=True,
        colour_bar="fluid pressure read by a 10 mm inlet (kPa)",
    )


def load_figure(readings: Sequence[GridReading]) -> Figure:
    """Return Fig. 30: load by the sensor with its 95 % band, report's values and 5 N beside it."""
    panels = []
    for kind in KINDS:
        layers: list[Layer] = []
        for fluid, side, colour in (("glycerol", -0.2, OURS), ("detergent", 0.2, "#9db8d2")):
            some = [r for r in readings if (r.condition.kind, r.condition.fluid) == (kind, fluid)]
            bands = [one.band(LOAD) for one in some]
            low, high = np.transpose(bands) if np.isfinite(bands).all() else ((), ())
            places = [TREADS.index(one.condition.tread) + side for one in some]
            loads = [one.number(LOAD) for one in some]
            style: dict[str, Any] = {"label": fluid, "colour": colour, "width": 0.36}
            layers.append(Layer("bars", places, loads, low=low, high=high, **style))
        load = printed_value("fluid_load", kind, "N")
        layers.append(points(-0.2, load, "report", colour=PRINTED, marker="D"))
        layers.append(level(SMALL, "report: all others below", colour=PRINTED, style="--"))
        panels.append(
            Panel(
                layers,
                "",
                "load read by the sensor (N)",
                f"{kind} shoe",
                y_scale="symlog",
                y_limits=(0.0, 700.0),
                y_ticks=(0, 1, 5, 10, 50, 100, 500),
                x_ticks=[tread.replace("_", " ") for tread in TREADS],
            )
        )
    return Figure(
        panels,
        "Fig. 30: tread, fluid and the load that the sensor reads, of 500 N",
        columns=2,
        size=(4.8, 4.2),
        share_y=True,
        legend_below=True,
    )


def depth_figure(depths: Sequence[tuple[float, CaseOutcome]]) -> Figure:
    """Return load against depth of tread: by the sensor and under the sole."""
    depth = [1e3 * each for each, _ in depths]
    sole, sensor = ([outcome.number(name) for _, outcome in depths] for name in (TRUE_LOAD, LOAD))
    layers = (
        Layer("span", low=1.5, high=3.0, label="report: no change", colour="0.9"),
        line(depth, sole, "under the sole", colour=SECOND, marker="s"),
        line(depth, sensor, "by the 10 mm sensor", marker="o"),
        level(SMALL, "5 N", colour=PRINTED, style="--"),
    )
    limits: dict[str, Any] = {"x_limits": (-0.05, None), "y_limits": (-6.0, None)}
    panel = Panel(layers, "depth of tread (mm)", "load carried by the fluid (N)", **limits)
    return Figure([panel], "Half-treaded work shoe in glycerol, 500 N, 0.7 m/s", size=(6.6, 4.2))


def inputs_figure(condition: ShoeInFluid, varied: Sensitivity, count: int = 8) -> Figure:
    """Return what one standard deviation of the open inputs does to load and peak."""
    panels = []
    for name, label, scale in ((LOAD, "load by the sensor (N)", 1.0), (PEAK, "peak (kPa)", 1e-3)):
        effects = varied.ranked_effects(name)[:count][::-1]
        layers = [
            Layer("limit", varied.nominal.number(name) * scale, colour="0.4", label="nominal")
        ]
        for end, colour in (("low", SECOND), ("high", OURS)):
            values = [getattr(effect, end).number(name) * scale for effect in effects]
            places = range(len(effects))
            layers.append(points(values, places, f"{end} end", colour=colour, marker="o"))
        names = [effect.path.split(".")[-1].replace("_", " ") for effect in effects]
        panels.append(Panel(layers, label, y_ticks=names))
    title = f"{condition.name}: one standard deviation of each open input (quick grid)"
    return Figure(panels, title, columns=2, size=(5.2, 3.8))
