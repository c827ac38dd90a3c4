"""The fast slip: one film height under the whole sole, its constants fitted to the full model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import ndtri

from underfoot.core import InputError, Progress, Status, silent
from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import Message
from underfoot.friction import FrictionLaw
from underfoot.trials.walking.slips import SlipDefinition

from ._kernels import reduced as kernel
from .full_model import LOWEST_SPEED, Setting
from .motion import SlipMotion, still_sliding_notes
from .walker import Population, Spread, Walker

STEP = 0.5e-3
NAMES = (
    "area",
    "area_power",
    "area_angle",
    "stiffness",
    "decay",
    "leak",
    "leak_angle",
    "wedge",
    "wedge_angle",
    "length",
    "start_film",
    "shear",
    "leak_bend",
    "wedge_bend",
)
UNITS = (
    "m^2",
    "1",
    "1/rad",
    "Pa",
    "m",
    "1/m^2",
    "1/rad",
    "1",
    "1/rad",
    "m",
    "m",
    "1",
    "1/rad^2",
    "1/rad^2",
)
TABLE_SPEEDS = np.concatenate([[0.0], np.geomspace(LOWEST_SPEED, 10.0, 96)])


MARGIN = 0.25
"""Share of the fitted range by which a motion may leave it: persons are drawn from tails that the
fit's runs stop short of."""


@dataclass(frozen=True, slots=True)
class FittedRange:
    """Fluid, and (lowest, highest) of load (N), speed (m/s) and shoe angle (rad) of fitted runs."""

    viscosity: float | None
    load: tuple[float, float]
    speed: tuple[float, float]
    shoe_angle: tuple[float, float]

    @classmethod
    def of(cls, viscosity: float | None, runs: Sequence[SlipMotion]) -> FittedRange:
        """Return the range of full runs; loads and speeds begin at 0."""
        angles = np.concatenate([run.shoe_angle for run in runs])
        return cls(
            viscosity,
            (0.0, max(float(run.normal.max()) for run in runs)),
            (0.0, max(float(run.speed.max()) for run in runs)),
            (float(angles.min()), float(angles.max())),
        )


@dataclass(frozen=True, slots=True)
class ReducedSole:
    """One sole on one floor with one fluid, in fourteen constants.

    p = F / A,  A = area (F / 500 N)^area_power,  p_c = stiffness exp(-h / decay) (at most p)
    dh/dt = -leak h^3 p_f / (12 eta) + V / (2 length) (h_w - h),  p_f = p - p_c
    1 / h_w = 1 / pool + p_f / (wedge eta V),  FF = COF(V) p_c A + shear eta V A / h

    A carries exp(area_angle a), leakage and wedge exp(angle a + bend a^2), a the shoe angle against
    ``shoe_angle``. ``speeds``, ``cofs`` tabulate the contact's friction over pressure.

    Its constants are those of one fluid and of the loads, speeds and angles of the runs behind
    them (``fitted``): slips that ride on a full film do not show how the contact takes over. What
    lies beyond is refused (``carried_at``), or named in the motion's notes where a walker leaves
    the range on the way.
    """

    constants: Array
    viscosity: float | None
    pool_depth: float
    shoe_angle: float
    speeds: Array
    cofs: Array
    fitted: FittedRange | None = None

    def __post_init__(self) -> None:
        if self.constants.shape != (kernel.COUNT,) or not np.isfinite(self.constants).all():
            raise InputError("fourteen finite constants are needed", where="reduced.constants")
        if self.fitted is not None and self.viscosity != self.fitted.viscosity:
            raise InputError(
                f"{self.viscosity} Pa s",
                where="reduced.viscosity",
                allowed=Message(
                    "{viscosity:g} Pa s, of the slips it was fitted to",
                    viscosity=self.fitted.viscosity,
                ),
                remedy="Fit one to full slips in this fluid, or take the full model (SoleFoot)",
            )

    def motion(self, walker: Walker, *, step: float = STEP) -> SlipMotion:
        """Return the slip of a walker (see ``motion.slip_motion`` for the rules)."""
        history = walker.step
        if not (math.isfinite(step) and 0 < step <= history.duration / 10):
            raise InputError(
                f"{step:g} s", where="step", allowed=f"above 0, up to {history.duration / 10:.3g} s"
            )
        times = np.linspace(0.0, history.duration, math.ceil(history.duration / step) + 1)
        normals, drives, angles = walker.demands(times)
        out = self._carry_slip(
            times,
            normals,
            drives,
            angles,
            walker.dry_speed(times),
            walker.weight_transfer,
            np.full(times.size, np.nan),
            walker.moving_mass,
            history.end_of_braking,
        )
        speed, _, friction, fluid, work, lost, normals, drives, end = out
        keep = slice(0, end + 1)
        moved = 0.5 * (speed[1:] + speed[:-1]) * np.diff(times)
        distance = np.concatenate([[0.0], np.cumsum(moved)])
        columns: Any = (
            times,
            speed,
            distance,
            normals,
            drives,
            friction,
            fluid,
            angles,
            work,
            lost,
        )
        return SlipMotion(
            walker,
            *(column[keep] for column in columns),
            status=Status.CONVERGED,
            model="reduced",
            notes=(
                *still_sliding_notes(float(speed[end]), history.duration),
                *self._beyond(normals[keep], speed[keep], angles[keep]),
            ),
        )

    def carried_at(self, motion: SlipMotion) -> tuple[Array, Array]:
        """Return film load and friction (n,) if the foot moved as in ``motion``.

        Raises:
            InputError: Loads, speeds or angles beyond those of the runs it was fitted to.
        """
        beyond = self._beyond(motion.normal, motion.speed, motion.shoe_angle)
        if beyond:
            raise InputError(
                "; ".join(beyond),
                where="reduced model",
                remedy="Take the full model (slip_study with full=True, SoleFoot)",
            )
        out = self._carry_slip(
            motion.time,
            motion.normal,
            motion.drive,
            motion.shoe_angle,
            motion.speed,
            1.0,
            motion.speed,
            motion.walker.moving_mass,
            0.0,
        )
        return out[3], out[2]

    def _beyond(self, normal: Array, speed: Array, angle: Array) -> tuple[str, ...]:
        """Return what of a motion lies outside the runs behind the constants, in words."""
        if self.fitted is None:
            return ()
        given = {"load": normal, "speed": speed, "shoe_angle": angle}
        found = []
        for name, (values, unit, scale) in {
            "load": (given["load"], "N", 1.0),
            "speed": (given["speed"], "m/s", 1.0),
            "shoe_angle": (given["shoe_angle"], "deg", math.degrees(1.0)),
        }.items():
            low, high = getattr(self.fitted, name)
            margin = MARGIN * (high - low)
            if values.min() < low - margin or values.max() > high + margin:
                found.append(
                    Message(
                        "{name} {low:.3g} to {high:.3g} {unit} beyond the fit's "
                        "{least:.3g} to {most:.3g} {unit}",
                        name=name.replace("_", " "),
                        low=scale * values.min(),
                        high=scale * values.max(),
                        unit=unit,
                        least=scale * low,
                        most=scale * high,
                    )
                )
        return tuple(found)

    def _carry_slip(
        self,
        times: Array,
        normals: Array,
        drives: Array,
        angles: Array,
        dry_speeds: Array,
        transfer: float,
        speeds: Array,
        mass: float,
        over: float,
    ) -> tuple[Array, Array, Array, Array, Array, Array, Array, Array, int]:
        return kernel.carry_slip(
            times,
            normals,
            drives,
            angles - self.shoe_angle,
            dry_speeds,
            transfer,
            speeds,
            mass,
            self.constants,
            self.viscosity or 0.0,
            self.pool_depth,
            self.speeds,
            self.cofs,
            over,
        )


def cof_table(law: FrictionLaw, pressure: float) -> tuple[Array, Array]:
    """Return speeds (m/s) and the contact's friction over a contact pressure (Pa) at them, 1."""
    speeds = np.maximum(TABLE_SPEEDS, LOWEST_SPEED)
    parts = law(np.full(speeds.size, pressure), speeds, np.full(speeds.size, 1e-3))
    return TABLE_SPEEDS.copy(), (parts.adhesion + parts.hysteresis) / pressure


SPEED_SCALE = SlipDefinition().threshold
"""m/s, the heel speed that makes a slip: an error of that size weighs one."""
POINTS = 60
SIGNED = (kernel.LEAK_ANGLE, kernel.WEDGE_ANGLE, kernel.LEAK_BEND, kernel.WEDGE_BEND)
# factors on the first guess; the first start is the guess itself
STARTS = ((1.0, 1.0, 1.0), (0.3, 1.0, 3.0), (3.0, 0.5, 0.5), (1.0, 2.0, 0.3))
FIRST_LOOK, POLISH = 8, 40  # evaluations of the slope from each start, and from the best
LEAST_LOAD = 30.0  # N, below which shares say nothing


def error_text(value: float, unit: str) -> str:
    """Return an error as "± 0.02 m/s"; one below a thousandth of the unit is told as that."""
    return f"below 0.001 {unit}" if value < 1e-3 else f"± {value:.2g} {unit}"


@dataclass(frozen=True, slots=True)
class FitError:
    """How far the reduced model is from full runs; SI."""

    runs: int
    peak_speed: float
    speed: float
    distance: float
    fluid_share: float
    same_outcome: float

    def __str__(self) -> str:
        return (
            f"{self.runs} runs: peak speed {error_text(self.peak_speed, 'm/s')}, speed in time "
            f"{error_text(self.speed, 'm/s')}, distance {error_text(1e3 * self.distance, 'mm')}, "
            f"load on the film {error_text(100 * self.fluid_share, '%')} of the load, same side of "
            "0.2 m/s in "
            f"{100 * self.same_outcome:.0f} %"
        )


@dataclass(frozen=True, slots=True)
class ReducedFit:
    """A fitted reduced model; ``held_out`` is its error on runs that the fit did not see."""

    sole: ReducedSole
    fitted: FitError
    held_out: FitError
    at_bound: tuple[str, ...]


def design(population: Population, count: int, seed: int = 7) -> tuple[Walker, ...]:
    """Return walkers that span a population to two standard deviations, by a Latin hypercube."""
    names = ("mass", "rcof", "walking_speed", "heel_speed", "shoe_angle", "brake_time")
    generator = np.random.default_rng(seed)
    columns = [generator.permutation(count) for _ in range(len(names) + 2)]
    places = (np.column_stack(columns) + generator.random((count, len(columns)))) / count
    walkers = []
    for row in places:
        values = {}
        low, high = population.weight_transfer
        for name, share in zip(names, row, strict=False):
            spread: Spread = getattr(population, name)
            # normal between its 5 and 95 %, stretched to two standard deviations
            at = spread.mean + 2 * spread.sd * float(ndtri(0.05 + 0.9 * share)) / 1.645
            values[name] = float(np.clip(at, spread.low, spread.high))
        pick = population.histories[int(row[-2] * len(population.histories))]
        walkers.append(
            Walker(
                history=pick,
                effective_mass=population.effective_mass,
                recorded_angle=population.recorded_angle,
                heel_brake=population.heel_brake,
                weight_transfer=low + (high - low) * float(row[-1]),
                name=f"design {len(walkers) + 1}",
                **values,
            )
        )
    return tuple(walkers)


def fitted_reduced(
    setting: Setting,
    runs: Sequence[SlipMotion],
    held_out: Sequence[SlipMotion],
    areas: Sequence[tuple[float, float, float]],
    *,
    progress: Progress = silent,
) -> ReducedFit:
    """Return the reduced model that follows full runs best.

    Parameters:
        setting: Shoe, floor and fluid of the runs.
        runs, held_out: Full motions to fit to, and others to test on.
        areas: (load, shoe angle, (sum p)^2 / sum p^2 dA) of the full runs' instants: the loaded
            area.

    Area constants by regression on ``areas``. The others by least squares on the film's share of
    the load (full speed imposed) and on the speed in time (foot set free), over 0.2 m/s, from
    four starts.

    Raises:
        InputError: Fewer than three runs or areas.
    """
    from scipy.optimize import least_squares

    if len(runs) < 3 or len(areas) < 3:
        raise InputError(
            Message("{count} runs", count=len(runs)), where="runs", allowed="3 or more"
        )
    area = _area_constants(areas, setting.shoe_angle)
    mean_pressure = 500.0 / area[0]
    speeds, cofs = cof_table(setting.friction, mean_pressure)
    if (edged := setting.edged) is not None:
        slow = np.maximum(speeds, LOWEST_SPEED)
        cofs *= [edged.mean_factor(mean_pressure, float(speed)) for speed in slow]
    blank = ReducedSole(
        np.ones(kernel.COUNT),
        setting.viscosity,
        setting.settings.pool_depth,
        setting.shoe_angle,
        speeds,
        cofs,
    )
    side = math.sqrt(area[0])
    guess = np.array(
        [
            *area,
            5 * mean_pressure,
            0.5 * _gap_decay(setting),
            12 * 2.4 / side**2,
            0.0,
            30.0,
            0.0,
            side,
            max(setting.settings.start_film, 2e-6),
            1.0,
            0.0,
            0.0,
        ]
    )
    if setting.viscosity is None:
        sole = replace(blank, constants=guess)
        return ReducedFit(sole, error_of(sole, runs), error_of(sole, held_out), ())
    low, high = _bounds(guess)
    free = [i for i in range(kernel.COUNT) if i > kernel.AREA_ANGLE]
    signed = [i in SIGNED for i in free]

    def constants(z: Array) -> Array:
        out = guess.copy()
        for i, value, sign in zip(free, z, signed, strict=True):
            out[i] = value if sign else math.exp(value)
        return out

    lows = np.array([low[i] if s else math.log(low[i]) for i, s in zip(free, signed, strict=True)])
    highs = np.array(
        [high[i] if s else math.log(high[i]) for i, s in zip(free, signed, strict=True)]
    )

    def residual(z: Array) -> Array:
        return _residual(replace(blank, constants=constants(z)), runs)

    def improve_fit(z: Array, most: int) -> Any:
        return least_squares(
            residual, z, bounds=(lows, highs), loss="soft_l1", diff_step=1e-4, max_nfev=most
        )

    best = None
    for number, (leak, decay, wedge) in enumerate(STARTS):
        progress("Fitting the reduced model", 0.6 * number / len(STARTS), None)
        start = guess.copy()
        start[kernel.LEAK] *= leak
        start[kernel.DECAY] *= decay
        start[kernel.WEDGE] *= wedge
        z = np.array(
            [start[i] if s else math.log(start[i]) for i, s in zip(free, signed, strict=True)]
        )
        trial = improve_fit(np.clip(z, lows + 1e-6, highs - 1e-6), FIRST_LOOK)
        if best is None or trial.cost < best.cost:
            best = trial
    assert best is not None
    progress("Fitting the reduced model", 0.6, None)
    best = improve_fit(np.clip(best.x, lows + 1e-9, highs - 1e-9), POLISH)
    sole = replace(
        blank,
        constants=constants(best.x),
        fitted=FittedRange.of(setting.viscosity, [*runs, *held_out]),
    )
    stuck = tuple(NAMES[i] for i, s in zip(free, at_bounds(best.x, lows, highs), strict=True) if s)
    return ReducedFit(sole, error_of(sole, runs), error_of(sole, held_out), stuck)


def at_bounds(values: Array, lows: Array, highs: Array) -> Mask:
    """Return which values (n,) lie within a thousandth of their range of either bound (n,)."""
    return np.minimum(values - lows, highs - values) < 1e-3 * (highs - lows)


def error_of(sole: ReducedSole, runs: Sequence[SlipMotion]) -> FitError:
    """Return the root-mean-square errors of the reduced model against full runs."""
    peaks, speeds, distances, shares, same = [], [], [], [], []
    for run in runs:
        motion = sole.motion(run.walker)
        peaks.append(motion.peak_speed - run.peak_speed)
        speeds.append(np.interp(run.time, motion.time, motion.speed, right=0.0) - run.speed)
        distances.append(motion.distance[-1] - run.distance[-1])
        fluid, _ = sole.carried_at(run)
        loaded = run.normal > LEAST_LOAD
        shares.append((fluid - run.fluid_load)[loaded] / run.normal[loaded])
        same.append((motion.peak_speed > SPEED_SCALE) == (run.peak_speed > SPEED_SCALE))

    def rms(values: Sequence[float] | Array) -> float:
        return float(np.sqrt(np.mean(np.square(values)))) if len(values) else math.nan

    return FitError(
        len(runs),
        rms(peaks),
        rms(np.concatenate(speeds)) if speeds else math.nan,
        rms(distances),
        rms(np.concatenate(shares)) if shares else math.nan,
        float(np.mean(same)) if same else math.nan,
    )


def _residual(sole: ReducedSole, runs: Sequence[SlipMotion]) -> Array:
    out = []
    for run in runs:
        at = np.unique(np.linspace(1, run.time.size - 1, POINTS).astype(int))
        fluid, _ = sole.carried_at(run)
        load = np.maximum(run.normal[at], LEAST_LOAD)
        out.append((fluid[at] - run.fluid_load[at]) / load / math.sqrt(at.size))
        motion = sole.motion(run.walker, step=1e-3)
        speed = np.interp(run.time[at], motion.time, motion.speed, right=0.0)
        out.append((speed - run.speed[at]) / SPEED_SCALE / math.sqrt(at.size))
    residuals = np.concatenate(out)
    return np.where(np.isfinite(residuals), residuals, 1e3)


def _area_constants(
    areas: Sequence[tuple[float, float, float]], middle: float
) -> tuple[float, float, float]:
    """Return area at 500 N, its power of the load and its growth with the angle."""
    rows = np.array([row for row in areas if row[0] > LEAST_LOAD and row[2] > 0])
    lean = rows[:, 1] - middle
    columns = [np.ones(len(rows)), np.log(rows[:, 0] / kernel.REFERENCE_LOAD)]
    if np.ptp(lean) > 1e-4:
        columns.append(lean)
    fit, *_ = np.linalg.lstsq(np.column_stack(columns), np.log(rows[:, 2]), rcond=None)
    return float(math.exp(fit[0])), float(fit[1]), float(fit[2]) if len(fit) > 2 else 0.0


def _gap_decay(setting: Setting) -> float:
    """Return twice the gap over which the asperities' pressure falls by e."""
    gaps = np.geomspace(1e-7, 1e-3, 200)
    pressure = setting.asperities.pressure(gaps)
    near = int(np.argmin(np.abs(np.log(np.maximum(pressure, 1e-300) / 3e5))))
    slope = float(setting.asperities.stiffness(gaps[near : near + 1])[0])
    return 2 * float(pressure[near]) / max(slope, 1e-300)


def _bounds(guess: Array) -> tuple[Array, Array]:
    low, high = guess * 1e-3, guess * 1e3
    low[kernel.DECAY], high[kernel.DECAY] = guess[kernel.DECAY] / 20, guess[kernel.DECAY] * 20
    low[kernel.LENGTH], high[kernel.LENGTH] = guess[kernel.LENGTH] / 30, guess[kernel.LENGTH] * 30
    low[kernel.START], high[kernel.START] = 1e-6, 6e-4
    low[kernel.SHEAR], high[kernel.SHEAR] = 0.05, 20.0
    for i in SIGNED:
        most = 400.0 if i in (kernel.LEAK_BEND, kernel.WEDGE_BEND) else 40.0
        low[i], high[i] = -most, most
    return low, high
