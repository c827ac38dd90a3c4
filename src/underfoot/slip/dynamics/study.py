"""A population on one floor: who slips, how fast, how far, and what sensors see."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from underfoot.core import (
    Cache,
    ConvergenceError,
    InputError,
    Progress,
    SourcedValue,
    Status,
    silent,
)
from underfoot.core.arrays import Array
from underfoot.core.deprecation import renamed_member
from underfoot.core.progress import part
from underfoot.core.remark import Message
from underfoot.friction import FrictionLaw, sampled_points

from .full_model import ROOM, FullRun, Setting, full_runs
from .motion import COLUMNS, STEP, SlipMotion
from .observation import ObservedSlip, Outcome, OutcomeLimits, observe_slip
from .reduced_model import (
    NAMES,
    SPEED_SCALE,
    ReducedFit,
    ReducedSole,
    cof_table,
    design,
    fitted_reduced,
)
from .sensors import FloorSensors, PressureShape, array_pressures, pressure_shape
from .walker import Population, Walker

Z95 = 1.959963984540054
DRAWS = 1000
LEVELS = 15
"""Friction levels at which everybody slips again; a draw of the friction takes the nearest."""
MEAN_PRESSURE = 2.5e5
"""Pa, contact pressure at which the spread of a contact's friction is taken: 500 N on 20 cm2."""
FIT_RUNS, HELD_OUT = 12, 4


@dataclass(frozen=True, slots=True)
class SubjectSlip:
    """One person's step."""

    walker: Walker
    motion: SlipMotion
    pressures: Array | None
    seen: ObservedSlip


@dataclass(frozen=True, slots=True)
class FrictionDraws:
    """A study at levels of its contact friction; ``nearest`` (draws,) is the level of each draw.

    ``cof`` (draws,) is the drawn COF of the contact, flat land without edges of lugs.
    """

    levels: tuple[SlipStudy, ...]
    nearest: Array
    cof: Array
    seed: int

    def means(self, name: str, count: int, *, crossed: bool = False) -> Array:
        """Return the mean of a number over ``count`` walkers, (draws,); nan where none has it.

        The walkers are drawn from those at the friction of the draw; ``crossed`` takes only those
        whose heel passed over the sensors.
        """

        def values(study: SlipStudy) -> Array:
            found = study.of(name)
            return found[study.of("crossed") > 0] if crossed else found

        return self.means_of(values, count)

    def means_of(self, values: Callable[[SlipStudy], Array], count: int) -> Array:
        """Return the mean of ``values`` of a study over ``count`` walkers of it, (draws,)."""
        generator = np.random.default_rng(self.seed)
        found = np.full(self.nearest.size, math.nan)
        for level, study in enumerate(self.levels):
            known = values(study)
            rows = np.flatnonzero(self.nearest == level)
            if known.size:
                found[rows] = known[generator.integers(known.size, size=(rows.size, count))].mean(
                    axis=1
                )
        return found


@dataclass(frozen=True, slots=True)
class SlipStudy:
    """A population's slips; ``full`` says that everybody went through the full model.

    ``fit`` and ``pressure_error`` (relative error of the peak reading on held-out full runs) are
    None on a dry floor; ``representative`` is a full run of the person closest to the median.
    ``by_friction`` is the study over the spread of its contact friction: None without a reduced
    model, or where an input of the law has no standard deviation.
    """

    setting: Setting
    population: Population
    array: FloorSensors
    subjects: tuple[SubjectSlip, ...]
    full: bool
    fit: ReducedFit | None = None
    pressure_error: float | None = None
    representative: FullRun | None = None
    full_runs: tuple[FullRun, ...] = ()
    breaches: tuple[str, ...] = ()
    failed: int = 0
    sole: ReducedSole | None = None
    by_friction: FrictionDraws | None = None

    def shares(self) -> dict[Outcome, tuple[float, float, float]]:
        """Return share, lower and upper 95 % bound of each class of distance slipped."""
        return {
            name: self._share(lambda study, name=name: study.outcomes(name)) for name in Outcome
        }

    def slip_share(self) -> tuple[float, float, float]:
        """Return the share of steps that slip, and its 95 % bounds.

        A step slips when the heel's peak speed after its first minimum exceeds 0.2 m/s (G.6.1,
        ``trials.SlipDefinition``): the one definition of a slip in the package. ``of("slipped")``
        has who does at the friction as computed.
        """
        return self._share(lambda study: study.of("slipped"))

    slipped = renamed_member("slipped", "slip_share", gone="0.4")

    def outcomes(self, outcome: Outcome) -> Array:
        """Return 1 for each subject whose slip is of a class, else 0, (n,)."""
        return np.array([float(s.seen.outcome is outcome) for s in self.subjects])

    def _share(self, hits: Callable[[SlipStudy], Array]) -> tuple[float, float, float]:
        """Return the share of hits (n,) with 95 % bounds.

        Where the law of friction has a spread it is the mean over its draws, and the bounds hold
        that and the number of walkers; else they are Wilson's of the walkers alone. A single person
        has no bounds: nan.
        """
        found = hits(self)
        if self.by_friction is None or found.size < 2:
            return (float(found.mean()), *_wilson(int(found.sum()), found.size))
        drawn = self.by_friction.means_of(hits, found.size)
        low, high = np.quantile(drawn, [0.025, 0.975])
        return float(drawn.mean()), float(low), float(high)

    def at_contact_friction(self, factor: float) -> SlipStudy:
        """Return the same walkers if the contact rubbed ``factor`` times as much.

        By the reduced model; without pressures at the sensors.

        Raises:
            InputError: A study without a reduced model (``full``).
        """
        if self.sole is None:
            raise InputError("the study has no reduced model", where="study", allowed="full=False")
        sole = replace(self.sole, cofs=factor * self.sole.cofs)
        walkers = [s.walker for s in self.subjects]
        subjects = _reduced_subjects(sole, None, walkers, self.array, None)
        return replace(self, subjects=tuple(subjects), sole=sole, by_friction=None)

    def at_friction_draws(
        self, law: FrictionLaw | None = None, *, draws: int = DRAWS, seed: int = 0
    ) -> FrictionDraws | None:
        """Return the study over the spread of its contact friction, or that of another ``law``.

        None without a reduced model, or where an input of the law has no standard deviation.
        """
        if self.sole is None:
            return None
        pa = self.setting.friction
        place: dict[str, Any] = {
            "contact_pressure": MEAN_PRESSURE,
            "speed": SPEED_SCALE,
            "film_thickness": 1e-3,
        }
        spread = sampled_points(law or pa, samples=draws, seed=seed, **place)
        if spread is None:
            return None
        cof = np.ravel(spread.draws)
        parts = pa(MEAN_PRESSURE, SPEED_SCALE, place["film_thickness"])
        factors = cof * MEAN_PRESSURE / float(parts.adhesion + parts.hysteresis)
        low, high = np.maximum(np.quantile(factors, [0.005, 0.995]), 0.01)
        levels = np.geomspace(low, high, LEVELS)
        apart = np.log(np.maximum(factors, 0.01))[:, None] - np.log(levels)
        studies = [self.at_contact_friction(float(level)) for level in levels]
        return FrictionDraws(tuple(studies), np.abs(apart).argmin(axis=1), cof, seed)

    def of(self, name: str) -> Array:
        """Return a number of every subject (n,), nan where there is none."""
        values = [getattr(s.seen, name) for s in self.subjects]
        return np.array([math.nan if v is None else float(v) for v in values])

    def mean(self, name: str, unit: str, *, crossed: bool = False) -> SourcedValue:
        """Return the mean of a number over the subjects, their standard deviation as uncertainty.

        ``crossed`` counts only those whose heel passed over the sensors, as the report does.
        """
        values = self.of(name)
        if crossed:
            values = values[np.array([s.seen.crossed for s in self.subjects])]
        values = values[np.isfinite(values)]
        if not values.size:
            return SourcedValue(None, unit, reason="no subject has one")
        single = values.size < 2
        return SourcedValue(
            float(values.mean()),
            unit,
            source="simulated population",
            uncertainty=None if single else float(values.std(ddof=1)),
            reason="one subject has no spread" if single else "",
            note=Message("mean and standard deviation of {size} subjects", size=values.size),
        )

    def correlation(self) -> float | None:
        """Return Pearson's r of peak slipping speed and peak pressure of those who crossed."""
        crossed = np.array([s.seen.crossed for s in self.subjects])
        speed, pressure = self.of("peak_speed")[crossed], self.of("peak_pressure")[crossed]
        if speed.size < 3 or np.ptp(speed) == 0 or np.ptp(pressure) == 0:
            return None
        return float(np.corrcoef(speed, pressure)[0, 1])

    def peak_speed_at(self, **changes: float | str) -> float | None:
        """Return the mean largest heel speed (m/s) if fields of every ``Walker`` were others.

        By the reduced model, whose contact does not know who walks; None without one.
        """
        if self.sole is None:
            return None
        people = [replace(s.walker, **changes) for s in self.subjects]
        return float(np.mean([self.sole.motion(walker).peak_speed for walker in people]))

    def slip_start(self) -> tuple[float, float] | None:
        """Return mean time (s) and load (body weights) at slip start of those who slip, if any."""
        starts = [s.motion.slip_start for s in self.subjects if s.seen.slipped]
        known = [start for start in starts if start is not None]
        return tuple(np.mean(known, axis=0).tolist()) if known else None

    def highest_seen(self) -> float | None:
        """Return the highest reading over the film's highest pressure, median of the full runs."""
        runs = [*self.full_runs, *([self.representative] if self.representative else [])]
        seen = [float(run.maps.max() / run.peaks.max()) for run in runs if run.peaks.max() > 0]
        return float(np.median(seen)) if seen else None

    def sensor_passages(self) -> dict[str, Array]:
        """Return what the report's Table 7 regresses, one value a sensor that a heel passed.

        ``peak`` (Pa), ``row`` (1 is met first), ``lateral`` (m, from the heel's middle, unsigned)
        and ``speed`` (m/s, of the heel when its rear end passes the sensor, IRSS).
        """
        columns: dict[str, list[float]] = {"peak": [], "row": [], "lateral": [], "speed": []}
        for subject in self.subjects:
            if subject.pressures is None or not subject.seen.crossed:
                continue
            motion = subject.motion
            x, y = self.array.places(subject.walker)
            for i, place in enumerate(x):
                if motion.distance[-1] < place:
                    continue
                when = float(np.interp(place, motion.distance, motion.time))
                for j, side in enumerate(y):
                    columns["peak"].append(float(subject.pressures[:, i, j].max()))
                    columns["row"].append(i + 1)
                    columns["lateral"].append(abs(float(side)))
                    columns["speed"].append(float(np.interp(when, motion.time, motion.speed)))
        return {name: np.array(values) for name, values in columns.items()}

    def numbers(self) -> dict[str, float | None]:
        """Return the study's figures in SI by name; None where there is none.

        Peak speed, peak pressure and duration are of those whose heel crossed the sensors.
        """
        numbers: dict[str, float | None] = {}
        for name, unit in (
            ("peak_speed", "m/s"),
            ("distance", "m"),
            ("peak_pressure", "Pa"),
            ("duration", "s"),
        ):
            value = self.mean(name, unit, crossed=True)
            numbers[name], numbers[f"{name}_sd"] = value.value, value.uncertainty
        share, low, high = self.slip_share()
        numbers |= {"slipped": share, "slipped_low": low, "slipped_high": high}
        for name, (share, _, _) in self.shares().items():
            numbers[str(name).replace(" ", "_")] = share
        numbers["correlation"] = self.correlation()
        rows = self.rows()
        numbers["last_over_first_row"] = float(rows[-1] / rows[0]) if rows[0] > 0 else None
        numbers["crossed"] = float(np.mean([s.seen.crossed for s in self.subjects]))
        return {k: None if v is None or math.isnan(v) else v for k, v in numbers.items()}

    def rows(self) -> Array:
        """Return the mean peak (rows,) of each row of sensors over those who crossed, Pa."""
        peaks = [s.seen.row_peaks for s in self.subjects if s.seen.crossed and s.seen.row_peaks]
        if not peaks:
            return np.full(self.array.rows, math.nan)
        return np.mean(np.array(peaks), axis=0)


def slip_study(
    setting: Setting,
    population: Population,
    *,
    array: FloorSensors | None = None,
    full: bool = False,
    fit_runs: int = FIT_RUNS,
    held_out: int = HELD_OUT,
    step: float = STEP,
    limits: OutcomeLimits | None = None,
    cache: Cache | None = None,
    progress: Progress = silent,
) -> SlipStudy:
    """Return the slips of a population on one floor.

    The reduced model is fitted to ``fit_runs`` full slips of made-up persons that span the
    population, tested on ``held_out`` others, and run for everybody; with ``full`` everybody goes
    through the full model. Full slips are kept in the cache: a stopped study goes on.

    Raises:
        ConvergenceError: Too few full slips could be solved to fit to.
    """
    array = array or FloorSensors()
    cache = cache or Cache(ROOM)
    walkers = population.walkers()
    if setting.viscosity is None:
        return _dry_study(setting, population, array, walkers, limits)
    options = {"inlet_diameter": array.inlet_diameter, "step": step, "cache": cache}
    if full:
        runs = full_runs(setting, walkers, progress=progress, **options)
        good = [r for r in runs if r.motion.status is Status.CONVERGED]
        if not good:
            raise ConvergenceError("no slip could be solved", where="slip", remedy=_REMEDY)
        subjects = [
            _subject(r.motion, array_pressures(r.motion, r.maps, array), array, limits, i)
            for i, r in enumerate(good)
        ]
        return SlipStudy(
            setting,
            population,
            array,
            tuple(subjects),
            True,
            representative=good[_middle(subjects)],
            full_runs=tuple(good),
            breaches=_breaches(setting, good),
            failed=len(runs) - len(good),
        )
    people = design(population, fit_runs + held_out)
    runs = full_runs(setting, people, progress=part(progress, 0.0, 0.8), **options)
    good = [r for r in runs if r.motion.status is Status.CONVERGED]
    if len(good) < max(4, len(runs) // 2):
        raise ConvergenceError(
            Message(
                "only {count} of {total} slips could be solved", count=len(good), total=len(runs)
            ),
            where="slip",
            remedy=_REMEDY,
        )
    every = max(len(good) // max(held_out, 1), 2)
    tested = good[every - 1 :: every][:held_out]
    used = [r for r in good if not any(r is t for t in tested)]
    fitted_to, kept_out = ([r.motion for r in some] for some in (used, tested))
    rows = [row for r in used for row in r.area_rows()]
    fit = fitted_reduced(setting, fitted_to, kept_out, rows, progress=part(progress, 0.8, 0.93))
    shape = pressure_shape(used, setting.shoe_angle)
    subjects = _reduced_subjects(fit.sole, shape, walkers, array, limits)
    chosen = walkers[_middle(subjects)]
    middle_run = full_runs(setting, [chosen], progress=part(progress, 0.95, 1.0), **options)
    study = SlipStudy(
        setting,
        population,
        array,
        tuple(subjects),
        False,
        fit,
        _pressure_error(shape, fit.sole, tested, array),
        middle_run[0] if middle_run[0].motion.status is Status.CONVERGED else None,
        tuple(good),
        _breaches(setting, good),
        len(runs) - len(good),
        fit.sole,
    )
    return replace(study, by_friction=study.at_friction_draws())


_REMEDY = "Use a finer grid, a thicker start film, or a narrower population"


def _reduced_subjects(
    sole: ReducedSole,
    shape: PressureShape | None,
    walkers: Sequence[Walker],
    array: FloorSensors,
    limits: OutcomeLimits | None,
) -> list[SubjectSlip]:
    subjects = []
    for i, walker in enumerate(walkers):
        motion = _thin_motion(sole.motion(walker))
        pressures = None if shape is None else array_pressures(motion, shape.maps(motion), array)
        subjects.append(_subject(motion, pressures, array, limits, i))
    return subjects


def _dry_study(
    setting: Setting,
    population: Population,
    array: FloorSensors,
    walkers: Sequence[Walker],
    limits: OutcomeLimits | None,
) -> SlipStudy:
    """Without fluid friction depends on load and speed alone: the reduced model is exact."""
    speeds, cofs = cof_table(setting.friction, 3e5)
    sole = ReducedSole(np.ones(len(NAMES)), None, 1e-3, setting.shoe_angle, speeds, cofs)
    subjects = _reduced_subjects(sole, None, walkers, array, limits)
    study = SlipStudy(setting, population, array, tuple(subjects), False, sole=sole)
    return replace(study, by_friction=study.at_friction_draws())


def _subject(
    motion: SlipMotion,
    pressures: Array | None,
    array: FloorSensors,
    limits: OutcomeLimits | None,
    seed: int,
) -> SubjectSlip:
    seen = observe_slip(motion, pressures, array, limits=limits, seed=seed)
    return SubjectSlip(motion.walker, motion, pressures, seen)


def _thin_motion(motion: SlipMotion, every: int = 4) -> SlipMotion:
    """Return the motion at every fourth instant: what drawings and sensors need."""
    keep = np.unique(np.append(np.arange(0, motion.time.size, every), motion.time.size - 1))
    return replace(motion, **{name: getattr(motion, name)[keep] for name in COLUMNS})


def _pressure_error(
    shape: PressureShape, sole: ReducedSole, tested: Sequence[FullRun], array: FloorSensors
) -> float | None:
    """Return the root-mean-square relative error of the peak reading on held-out full runs."""
    errors = []
    for run in tested:
        true = float(array_pressures(run.motion, run.maps, array).max())
        motion = sole.motion(run.motion.walker)
        reading = float(array_pressures(motion, shape.maps(motion), array).max())
        if true > 1e3:
            errors.append(reading / true - 1)
    return float(np.sqrt(np.mean(np.square(errors)))) if errors else None


def _middle(subjects: Sequence[SubjectSlip]) -> int:
    """Return the subject whose peak speed is nearest to the median of those who crossed."""
    speeds = np.array([s.seen.peak_speed for s in subjects])
    crossed = np.array([s.seen.crossed for s in subjects])
    pool = crossed if crossed.any() else np.ones(speeds.size, dtype=bool)
    middle = float(np.median(speeds[pool]))
    return int(np.argmin(np.where(pool, np.abs(speeds - middle), np.inf)))


def _wilson(hits: int, count: int) -> tuple[float, float]:
    """Return the 95 % bounds of a share; nan for fewer than two."""
    if count < 2:
        return math.nan, math.nan
    share, z = hits / count, Z95
    middle = (share + z * z / (2 * count)) / (1 + z * z / count)
    half = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count**2)) / (1 + z * z / count)
    # the ends of none and of all are exact: rounding leaves 1e-17 of them
    return middle - half if hits else 0.0, middle + half if hits < count else 1.0


def _breaches(setting: Setting, runs: Sequence[FullRun]) -> tuple[str, ...]:
    """Return what left the range of the friction law, over all moving instants."""
    speeds = np.concatenate([run.motion.speed for run in runs])
    moving = speeds[speeds > 1e-2]
    if not moving.size:
        return ()
    extremes = np.array([run.extremes for run in runs])
    outside = setting.friction.breaches(
        contact_pressure=extremes[:, 0].max(),
        speed=np.array([moving.min(), moving.max()]),
        film_thickness=max(float(extremes[:, 1].min()), 1e-9),
    )
    return tuple(dict.fromkeys(str(breach) for breach in outside))
