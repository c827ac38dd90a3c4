"""Report G.5: pressure and speed in unexpected slips, untreaded against treaded."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, cycle, pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.calibrate.pair_readings import PairReading, calibrated_pair
from underfoot.case import Case
from underfoot.compute.slips import slip_setting, slips
from underfoot.core import ConvergenceError, content_hash
from underfoot.core.catalogue import Catalogue
from underfoot.core.remark import Message
from underfoot.friction import FrictionLaw, PairContactLaw
from underfoot.slip.dynamics import SlipStudy
from underfoot.slip.dynamics.full_model import Setting, SoleFoot
from underfoot.trials.statistics.linear import all_subsets

from .figure import GREY, OURS, PRINTED, SECOND, Figure, Panel, line, points
from .g4 import ROUGHNESS_BEYOND_CUTOFF
from .g6 import PRINTED_ACOF, SOLES, sole_case
from .runner import Computed, Options, StudyTable, cached_arrays, name_progress, part
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("g5.toml")

Array = NDArray[np.float64]
COUNTS = {"untreaded": 11, "treaded": 6}
"""Persons whose heel crossed the sensors (G.5.2)."""
GRIDS, QUICK_GRID = ("1.2 mm", "0.8 mm"), "2 mm"
"""From two cells in a channel of 2.4 mm on."""
EXAMPLE_GRID = "1 mm"
DRAWS = 2000
PREDICTORS = ("row", "lateral", "speed")
UNITS = {"peak_speed": "m/s", "peak_pressure": "Pa", "duration": "s"}
CURVES = (219e-3, 20e-3, 1.89e-3)
"""Pa s, of the curves in Fig. 35."""
HELD_VISCOSITIES = (1.89e-3, 5e-3, 10e-3, 20e-3, 50e-3, 100e-3, 219e-3)
HELD_SPEEDS = (0.05, 0.2, 0.5, 1.0, 2.0)
HELD_FOR = 1.0
"""s: how long the heel of Fig. 35 stands under its load."""
HELD_FROM = 50e-6
"""m above the floor: all load at once from higher up would trap what a landing presses out."""
COLOUR = {"untreaded": OURS, "treaded": "#2e7d4f"}


def slip_case(name: str, *, grid: str = EXAMPLE_GRID, quick: bool = False) -> Case:
    """Return the case of a shoe of G.5, "untreaded" or "treaded"; that of the examples.

    ``quick`` takes 24 persons, fewer full slips behind the reduced model and, untreaded, a grid of
    2 mm.
    """
    people = {"subjects": 24, "fit_runs": 8, "test_runs": 2} if quick else {"subjects": 40}
    mapping: dict[str, Any] = {
        "file_version": 1,
        "name": f"Human slips, {name}, 90 % glycerol",
        "shoe": {"from": f"slip_resistant_shoe_{name}"},
        "floor": {"from": "vinyl_g4"},
        "contaminant": {"from": "glycerol_90pct"},
        "motion": {"from": "slip_tester_g4"},
        "interface": {"roughness_beyond_cutoff": ROUGHNESS_BEYOND_CUTOFF},
        "sensor": {"from": "human_slip_g5"},
        "slip": people,
    }
    if quick and name == "untreaded":
        grid = QUICK_GRID
    if grid != EXAMPLE_GRID:
        mapping["numerics"] = {"quick_grid_spacing": grid}
    return Case.from_mapping(mapping)


def compute(options: Options) -> Computed:
    """Return the slips on both shoes, each population on two grids of the sole.

    The full slips behind the reduced model are kept in the cache: a stopped run goes on.
    """
    grids = (EXAMPLE_GRID,) if options.quick else GRIDS
    plan = [(shoe, grid) for grid in grids for shoe in COUNTS]
    cases = {(s, grid): slip_case(s, grid=grid, quick=options.quick) for s, grid in plan}
    if options.processes != 1:
        keys = [case.hash for case in cases.values()]
        filled = cached_arrays("g5_filled-1", fill_cache, list(cases.values()), keys, processes=2)
        for number, _ in enumerate(filled):
            options.progress("full slips", 0.8 * (number + 1) / len(cases))
    found: dict[tuple[str, str], SlipStudy] = {}
    for number, (key, case) in enumerate(cases.items()):
        share = (0.8 + 0.04 * number, 0.8 + 0.04 * (number + 1))
        if options.processes == 1:
            share = (number / len(cases), (number + 1) / len(cases))
        found[key] = slips(
            case, progress=name_progress(part(options.progress, *share), ", ".join(key))
        )
    fine = {shoe: found[shoe, grids[-1]] for shoe in COUNTS}
    levels = {
        shoe: [(1e-3 * float(grid.split()[0]), numbers_of(found[shoe, grid])) for grid in grids]
        for shoe in COUNTS
    }
    draws = {shoe: population_draws(fine[shoe], COUNTS[shoe], seed=options.seed) for shoe in COUNTS}
    bare = fine["untreaded"]
    friction, words = by_friction(fine["treaded"], law_as_g6_leaves_it(fine["treaded"]))
    passages = bare.sensor_passages()
    films = held_films(options)
    population = bare.population
    rcof, speed = population.rcof, population.heel_speed
    return Computed(
        quantities(levels, draws) | _wedge_squeeze_quantities(films),
        (*tables(fine, levels, draws), friction),
        figures(fine, passages, films),
        (*conclusions(fine, passages), words, wedge_sentence(films)),
        assumptions=(
            Message(
                "{share:.3g} of the body moves with the heel (not printed, not measured).",
                share=population.effective_mass,
            ),
            Message(
                "RCOF {rcof:.2f} ± {rcof_sd:.2f}, heel speed at contact {speed:.2f} ± "
                "{speed_sd:.2f} m/s: not printed.",
                rcof=rcof.mean,
                rcof_sd=rcof.sd,
                speed=speed.mean,
                speed_sd=speed.sd,
            ),
            *bare.setting.friction.assumptions,
        ),
    )


def fill_cache(case: Case) -> dict[str, Any]:
    """Compute the full slips of a case, which stay in the cache."""
    slips(case)
    return {"done": np.array(True)}


def crossing(study: SlipStudy) -> list[Any]:
    """Return the persons whose heel crossed the sensors."""
    return [subject for subject in study.subjects if subject.seen.crossed]


def numbers_of(study: SlipStudy) -> dict[str, float]:
    """Return every judged number of a population, nan where there is none."""
    crossed = crossing(study)
    found = {}
    for name, values in _columns(crossed).items():
        known = values[np.isfinite(values)]
        found[name] = float(known.mean()) if known.size else math.nan
    found["slipped"] = float(study.of("slipped").mean())
    found["correlation"] = math.nan if (r := study.correlation()) is None else r
    rows = study.rows()
    found["last_row_change"] = float(rows[-1] / rows[0] - 1.0) if rows[0] > 0 else math.nan
    return found | regressions(_passages(study, crossed))


def _columns(persons: Sequence[Any]) -> dict[str, Array]:
    """Return what the sensors saw of each person, nan where there is nothing."""
    return {name: np.array([getattr(p.seen, name) for p in persons], float) for name in UNITS}


def _passages(study: SlipStudy, persons: Sequence[Any]) -> dict[str, Array]:
    return replace(study, subjects=tuple(persons)).sensor_passages()


def regressions(passages: Mapping[str, Array]) -> dict[str, float]:
    """Return slopes and adjusted R2 of Table 7; nan where too few sensors were passed."""
    sizes = range(1, len(PREDICTORS) + 1)
    names = [f"r2_{'_'.join(s)}" for size in sizes for s in combinations(PREDICTORS, size)]
    if passages["peak"].size < 6 or any(np.ptp(passages[p]) == 0 for p in PREDICTORS):
        return dict.fromkeys(("slope_lateral", "slope_speed", *names), math.nan)
    subsets = all_subsets(passages["peak"], {name: passages[name] for name in PREDICTORS})
    found = {
        f"r2_{'_'.join(subset.predictors)}": float(subset.adjusted_r_squared) for subset in subsets
    }
    for name in ("lateral", "speed"):
        found[f"slope_{name}"] = float(np.polyfit(passages[name], passages["peak"], 1)[0])
    return found


def population_draws(
    study: SlipStudy, count: int, *, draws: int = DRAWS, seed: int = 0
) -> dict[str, Array]:
    """Return what studies of ``count`` crossing persons would find, (draws,) each.

    Persons are drawn from the simulated population with replacement; shares from all of it. Shares
    and speeds hold the spread of the contact's friction too.
    """
    generator = np.random.default_rng(seed)
    by_friction = study.at_friction_draws(draws=draws, seed=seed)
    assert by_friction is not None  # the law of the pair has a spread
    by_name = {"slipped": by_friction.means("slipped", count)}
    persons = crossing(study)
    if len(persons) < 2:
        return by_name
    drawn = generator.integers(len(persons), size=(draws, count))
    columns = {name: values[drawn] for name, values in _columns(persons).items()}
    for name, values in columns.items():
        known = np.isfinite(values)
        with np.errstate(invalid="ignore"):
            by_name[name] = np.where(known, values, 0.0).sum(axis=1) / known.sum(axis=1)
    by_name["peak_speed"] = by_friction.means("peak_speed", count, crossed=True)
    by_name["correlation"] = correlations(columns["peak_speed"], columns["peak_pressure"])
    rows = np.array([person.seen.row_peaks for person in persons if person.seen.row_peaks])
    if len(rows) == len(persons):
        means = rows[drawn].mean(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            by_name["last_row_change"] = means[:, -1] / means[:, 0] - 1.0
    each = [_passages(study, [person]) for person in persons]
    table = [
        regressions({key: np.concatenate([each[i][key] for i in row]) for key in each[0]})
        for row in drawn[: draws // 5]
    ]
    return by_name | {name: np.array([one[name] for one in table]) for name in table[0]}


def correlations(x: Array, y: Array) -> Array:
    """Return Pearson's r of every row of two arrays (m, n); nan where one does not vary."""
    a = x - x.mean(axis=1, keepdims=True)
    b = y - y.mean(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (a * b).sum(axis=1) / np.sqrt((a * a).sum(axis=1) * (b * b).sum(axis=1))


def law_as_g6_leaves_it(study: SlipStudy) -> FrictionLaw:
    """Return the contact friction of a study, calibrated to G.6's two outsoles.

    Same laboratory, other sole and fluid: the error of the laboratory carries over, that of the
    pair does not. The packaged draws know these readings among 55 others.
    """
    law = study.setting.friction
    assert isinstance(law, PairContactLaw)
    readings = [
        PairReading(sole_case(SOLES[sole], "pair"), PRINTED_ACOF[sole]) for sole in ("hard", "soft")
    ]
    return replace(law, draws=calibrated_pair(readings).draws, medians={})


def by_friction(study: SlipStudy, calibrated: FrictionLaw) -> tuple[StudyTable, str]:
    """Return who slips on the treaded shoe over the spread of its contact friction, and in words.

    By the law of the pair, and by that law ``calibrated`` to readings of the laboratory.
    """
    rows, count = [], COUNTS["treaded"]
    for name, law in (("pair", None), ("pair, calibrated to G.6", calibrated)):
        drawn = study.at_friction_draws(law)
        assert drawn is not None
        each = {
            "contact COF": drawn.cof,
            f"share of {count} who slip": drawn.means("slipped", count),
            "peak speed over the sensors m/s": drawn.means("peak_speed", count, crossed=True),
        }
        row: dict[str, Any] = {"law": name}
        for label, values in each.items():
            low, row[label], high = np.nanquantile(values, [0.025, 0.5, 0.975])
            row[f"{label}, 95 %"] = f"{low:.2g} to {high:.2g}"
        most_stand = np.mean(each[f"share of {count} who slip"] <= 0.5)
        row["probability that at least half do not slip"] = float(most_stand)
        rows.append(row)
    title = "Treaded shoe over the spread of its contact friction: median and 95 %"
    words = (
        "Treaded, with the contact friction that G.6's readings leave (same laboratory): at least "
        f"half of {count} persons do not slip in {100 * most_stand:.0f} % of the draws."
    )
    return StudyTable.of("friction", title, rows), words


def quantities(
    levels: Mapping[str, Sequence[tuple[float, Mapping[str, float]]]],
    draws: Mapping[str, Mapping[str, Array]],
) -> dict[str, ComputedQuantity]:
    """Return every quantity of the study by name, with both grids and what small studies find."""
    units = {**UNITS, "slope_lateral": "Pa/m", "slope_speed": "Pa*s/m"}
    by_name = {}
    for shoe, grids in levels.items():
        for name, value in grids[-1][1].items():
            if name.startswith("r2_") and name != "r2_row_lateral_speed":
                continue
            steps = [(spacing, each[name]) for spacing, each in grids]
            by_name[f"{shoe}.{name}"] = ComputedQuantity.of(
                value, units.get(name, "1"), draws=draws[shoe].get(name), levels=steps
            )
        by_name[f"{shoe}.r2_all"] = by_name.pop(f"{shoe}.r2_row_lateral_speed")
        names, chance = ("lateral", "row", "speed"), None
        if all(f"r2_{name}" in draws[shoe] for name in names):
            first, second, third = (draws[shoe][f"r2_{name}"] for name in names)
            chance = float(np.mean((first > second) & (second > third)))
        single = [grids[-1][1][f"r2_{name}"] for name in names]
        by_name[f"{shoe}.r2_single"] = ComputedQuantity.of(single, names=names, chance=chance)
    bare, tread = (levels[shoe] for shoe in COUNTS)
    ratios = [
        (spacing, b["peak_pressure"] / a["peak_pressure"])
        for (spacing, a), (_, b) in zip(bare, tread, strict=True)
    ]
    by_name["pressure_ratio"] = ComputedQuantity.of(ratios[-1][1], levels=ratios)
    return by_name


def tables(
    studies: Mapping[str, SlipStudy],
    levels: Mapping[str, Sequence[tuple[float, Mapping[str, float]]]],
    draws: Mapping[str, Mapping[str, Array]],
) -> tuple[StudyTable, ...]:
    """Return the population's numbers, the rows of sensors, the grids, and Table 7 beside ours."""
    scales = {
        "peak_speed": ("m/s", 1.0),
        "peak_pressure": ("kPa", 1e3),
        "duration": ("ms", 1e-3),
        "slipped": ("share", 1.0),
        "correlation": ("", 1.0),
    }
    rows = []
    for shoe in studies:
        for name, (unit, scale) in scales.items():
            low, high = (math.nan, math.nan)
            if name in draws[shoe]:
                low, high = np.nanpercentile(draws[shoe][name], [2.5, 97.5]) / scale
            rows.append(
                {
                    "shoe": shoe,
                    "quantity": f"{name.replace('_', ' ')} {unit}".strip(),
                    "mean": levels[shoe][-1][1][name] / scale,
                    "low": low,
                    "high": high,
                    **{f"{1e3 * grid:g} mm": each[name] / scale for grid, each in levels[shoe]},
                }
            )
    published = Catalogue.load().entry("published", "human_slips_g5")
    keys = {"row": "sprwd", "lateral": "ml", "speed": "irss"}
    ours = {
        tuple(n.split("_")[1:]): v for n, v in levels["untreaded"][-1][1].items() if n[:3] == "r2_"
    }
    return (
        StudyTable.of(
            "population",
            "Persons whose heel crossed the sensors: mean, 95 % of the mean of as "
            "many as the report had, and the mean on each grid",
            rows,
        ),
        StudyTable(
            "rows",
            "Mean peak of each row of sensors, kPa",
            ("shoe", "first", "second", "third"),
            [(shoe, *(peak / 1e3 for peak in study.rows())) for shoe, study in studies.items()],
        ),
        StudyTable.of(
            "table7",
            "Adjusted R2 of the peak pressure at single sensors, untreaded",
            [
                {
                    "predictors": ", ".join(names),
                    "printed": published.sourced_value(
                        f"adjusted_r2.{'_'.join(keys[n] for n in names)}", "1"
                    ).value,
                    "ours": value,
                }
                for names, value in ours.items()
            ],
        ),
    )


def conclusions(studies: Mapping[str, SlipStudy], passages: Mapping[str, Array]) -> tuple[str, ...]:
    """Return what the comparison says."""
    bare, tread = studies["untreaded"], studies["treaded"]
    speeds = [bare.peak_speed_at(effective_mass=share) for share in (0.06, 0.114, 0.17)]
    text = " / ".join("-" if v is None else f"{v:.2f}" for v in speeds)
    pressures = [numbers_of(study)["peak_pressure"] / 1e3 for study in (bare, tread)]
    return (
        f"Treaded: {100 * tread.of('slipped').mean():.0f} % slip here, nobody in the report.",
        f"Untreaded: {100 * bare.of('slipped').mean():.0f} % slip. Tread takes the fluid pressure "
        f"at the sensors from {pressures[0]:.0f} to {pressures[1]:.1f} kPa, all else alike.",
        f"Mean peak speed untreaded if 0.06 / 0.114 / 0.17 of the body moved: {text} m/s.",
        f"{passages['peak'].size} passages of a heel over a sensor stand behind Table 7.",
    )


def figures(
    studies: Mapping[str, SlipStudy], passages: Mapping[str, Array], films: Sequence[HeldFilm]
) -> dict[str, Figure]:
    """Return Fig. 32 to 35."""
    bare = studies["untreaded"]
    drawn = {"fig33_speed_pressure": _speed_pressure_figure(studies)}
    if bare.representative is not None:
        drawn["fig32_slip"] = _slip_figure(bare)
    if passages["peak"].size:
        drawn["fig34_effects"] = _effects_figure(passages)
    drawn["fig35_wedge_squeeze"] = _wedge_squeeze_figure(films, passages)
    return drawn


def _slip_figure(study: SlipStudy) -> Figure:
    """Return the representative slip: speeds, loads, and sensors of the middle column."""
    from underfoot.slip.dynamics import array_pressures

    run = study.representative
    assert run is not None
    motion = run.motion
    time = 1e3 * motion.time
    seen = array_pressures(motion, run.maps, study.array)
    middle = study.array.columns // 2
    rows = [
        line(time, seen[:, i, middle] / 1e3, f"row {i + 1}", colour=colour)
        for i, colour in zip(range(study.array.rows), cycle((OURS, "#2e86ab", SECOND, GREY)))
    ]
    forces = (
        line(time, motion.normal, "on the shoe", colour=GREY),
        line(time, motion.fluid_load, "on the film"),
        line(time, motion.friction, "friction", colour=PRINTED),
    )
    return Figure(
        (
            Panel([line(time, motion.speed, "heel")], "time (ms)", "slipping speed (m/s)"),
            Panel(forces, "time (ms)", "force (N)"),
            Panel(rows, "time (ms)", "pressure at the sensors (kPa)"),
        ),
        "Fig. 32: a slip over the sensors, untreaded, computed",
        columns=3,
        size=(3.8, 3.2),
    )


def _speed_pressure_figure(studies: Mapping[str, SlipStudy]) -> Figure:
    published = Catalogue.load().entry("published", "human_slips_g5")
    layers = []
    for shoe, study in studies.items():
        seen = _columns(crossing(study))
        r = study.correlation()
        label = f"{shoe}, computed" + ("" if r is None else f" (r = {r:.2f})")
        style = {"colour": COLOUR[shoe], "marker": "o"}
        layers.append(points(seen["peak_pressure"] / 1e3, seen["peak_speed"], label, **style))
        pressure = published.sourced_value(f"peak_pressure_{shoe}", "Pa")
        speed = published.sourced_value(f"peak_slipping_speed_over_sensors_{shoe}", "m/s")
        x, y = float(pressure) / 1e3, float(speed)
        dx, dy = (pressure.uncertainty or 0.0) / 1e3, speed.uncertainty or 0.0
        style = {"colour": PRINTED, "marker": "s" if shoe == "treaded" else "D"}
        label = f"{shoe}, report (mean ± sd)"
        layers.append(points(x, y, label, low=y - dy, high=y + dy, **style))
        layers.append(line([x - dx, x + dx], [y, y], colour=PRINTED))
    labels = ("peak pressure at the sensors (kPa)", "peak slipping speed (m/s)")
    panel = Panel(layers, *labels, x_limits=(0.0, None), y_limits=(0.0, None))
    title = "Fig. 33: peak speed against peak pressure (report: r = 0.87)"
    return Figure([panel], title, size=(6.4, 4.6))


def _effects_figure(passages: Mapping[str, Array]) -> Figure:
    peak = passages["peak"] / 1e3
    panels = []
    for name, factor, label in (
        ("speed", 1.0, "A: speed as the heel passes (m/s)"),
        ("lateral", 1e3, "B: distance from the heel's middle (mm)"),
    ):
        x = passages[name] * factor
        layers = [points(x, peak, marker=".")]
        if np.ptp(x) > 0:
            slope, start = np.polyfit(x, peak, 1)
            ends = np.array([x.min(), x.max()])
            layers.append(line(ends, start + slope * ends, colour="0.25"))
        panels.append(Panel(layers, label, "peak pressure of a sensor (kPa)", y_limits=(0.0, None)))
    rows = np.unique(passages["row"])
    values = [peak[passages["row"] == n] for n in rows]
    mean, spread = (np.array([f(v) for v in values]) for f in (np.mean, np.std))
    layer = points(rows, mean, low=mean - spread, high=mean + spread, marker="o")
    panels.append(Panel([layer], "C: row of sensors (mean ± sd)", x_ticks=rows.tolist()))
    return Figure(
        panels,
        "Fig. 34: what the pressure at a sensor follows, untreaded, computed",
        columns=3,
        size=(3.6, 3.4),
        share_y=True,
    )


@dataclass(frozen=True, slots=True)
class HeldFilm:
    """Load on the film (%) of 500 N under a heel held at a speed from contact on; time in s."""

    viscosity: float
    speed: float
    time: Array
    share: Array

    def at(self, instant: float) -> float:
        """Share after a time (s)."""
        return float(np.interp(instant, self.time, self.share))


HELD_STEPS = np.concatenate([[1e-3], np.diff(np.geomspace(1e-3, HELD_FOR, 40))])
"""s: finer where the film changes fast."""


def held_film(setting: Setting, viscosity: float, speed: float) -> HeldFilm:
    """Return the film of the full model under 500 N and a speed that are held.

    Raises:
        ConvergenceError: The sole could not be solved.
    """
    begin = replace(setting.settings, start_film=HELD_FROM)
    here = replace(setting, viscosity=viscosity, settings=begin, key="")
    foot = SoleFoot(here, setting.shoe_angle)
    shares = []
    for step in HELD_STEPS:
        held = {"normal_force": 500.0, "speed": speed, "shoe_angle": setting.shoe_angle}
        instant = foot.advance(float(step), **held)
        if not instant.usable:
            raise ConvergenceError(
                f"{1e3 * viscosity:g} mPa s at {speed:g} m/s",
                where="Fig. 35",
                remedy="A finer grid",
            )
        shares.append(instant.fluid_load / 5.0)
    return HeldFilm(viscosity, speed, np.cumsum(HELD_STEPS), np.array(shares))


def held_item(item: tuple[bool, float, float]) -> dict[str, Any]:
    """Return the film of one condition of Fig. 35 by name; (quick, viscosity, speed)."""
    quick, viscosity, speed = item
    film = held_film(slip_setting(slip_case("untreaded", quick=quick)), viscosity, speed)
    return {"time": film.time, "share": film.share}


def held_films(options: Options) -> list[HeldFilm]:
    """Return every condition of Fig. 35, each kept in the cache."""
    plan = [(v, 0.5) for v in HELD_VISCOSITIES]
    plan += [(v, s) for v in CURVES for s in HELD_SPEEDS if s != 0.5]
    items = [(options.quick, viscosity, speed) for viscosity, speed in plan]
    setting_key = slip_setting(slip_case("untreaded", quick=options.quick)).key
    keys = [content_hash(setting_key, *item, HELD_STEPS, HELD_FROM) for item in items]
    found = []
    for number, (item, arrays) in enumerate(
        cached_arrays("g5_held-1", held_item, items, keys, processes=options.processes)
    ):
        options.progress("films under a held heel", (number + 1) / len(items))
        found.append(HeldFilm(item[1], item[2], arrays["time"], arrays["share"]))
    return found


def _wedge_squeeze_figure(films: Sequence[HeldFilm], passages: Mapping[str, Array]) -> Figure:
    """Return film load against dwell time, viscosity, lateral distance and speed (500 N)."""
    by = {(film.viscosity, film.speed): film for film in films}
    dwell, fast = [], []
    for viscosity, style in zip(CURVES, ("-", "--", ":"), strict=True):
        label, one = f"{1e3 * viscosity:g} mPa s", by[viscosity, 0.5]
        dwell.append(line(1e3 * one.time, one.share, label, style=style))
        at_speed = [by[viscosity, speed].at(0.2) for speed in HELD_SPEEDS]
        fast.append(line(HELD_SPEEDS, at_speed, label, style=style, marker="o"))
    thick = [
        line(
            [1e3 * v for v in HELD_VISCOSITIES],
            [by[v, 0.5].at(t) for v in HELD_VISCOSITIES],
            f"0.5 m/s, after {1e3 * t:.0f} ms",
            style=style,
            marker="o",
        )
        for t, style in ((0.05, "--"), (0.2, "-"))
    ]
    middle, peaks = [], []
    for low, high in pairwise(np.arange(0.0, 0.05, 0.005)):
        inside = (passages["lateral"] >= low) & (passages["lateral"] < high)
        if inside.any():
            middle.append(500 * (low + high))
            peaks.append(passages["peak"][inside].mean() / 1e3)
    load: dict[str, Any] = {"y_label": "load on the film (%)", "y_limits": (0.0, 100.0)}
    dwelling: dict[str, Any] = {"x_scale": "log", "x_limits": (1.0, 1e3 * HELD_FOR)}
    distance = "distance from the heel's middle (mm)"
    pressure: dict[str, Any] = {"y_label": "sensor's peak (kPa)", "y_limits": (0.0, None)}
    panels = [
        Panel(dwell, "dwell time at 0.5 m/s (ms)", **dwelling, **load),
        Panel(thick, "viscosity (mPa s)", x_scale="log", **load),
        Panel([line(middle, peaks, marker="o")], distance, **pressure),
        Panel(fast, "sliding speed, held for 200 ms (m/s)", **load),
    ]
    return Figure(
        panels if middle else [panels[0], panels[1], panels[3]],
        "Fig. 35: wedge and squeeze, untreaded heel under 500 N, full model",
        columns=2,
        size=(5.2, 3.2),
    )


def wedge_sentence(films: Sequence[HeldFilm]) -> str:
    """Return in words what speed leaves of the film once the fluid trapped at landing is out."""
    middle = {film.speed: film for film in films if film.viscosity == CURVES[1]}
    shares = ", ".join(
        f"{middle[speed].at(HELD_FOR):.2g} % at {speed:g} m/s" for speed in HELD_SPEEDS
    )
    return f"Fig. 35, {1e3 * CURVES[1]:g} mPa s: after {HELD_FOR:g} s the film carries {shares}."


def _wedge_squeeze_quantities(films: Sequence[HeldFilm]) -> dict[str, ComputedQuantity]:
    """Return the trends that the concept of Fig. 35 draws: more film with each of three."""
    by = {(film.viscosity, film.speed): film for film in films}
    thin, middle, thick = (by[v, 0.5] for v in sorted(CURVES))
    slow, quick = (by[CURVES[1], s].at(0.2) for s in (HELD_SPEEDS[0], HELD_SPEEDS[-1]))
    return {
        "film.viscosity": ComputedQuantity.of((thick.at(0.2) - thin.at(0.2)) / 100.0),
        "film.dwell": ComputedQuantity.of((middle.at(HELD_FOR) - middle.at(0.05)) / 100.0),
        "film.speed": ComputedQuantity.of((quick - slow) / 100.0),
    }
