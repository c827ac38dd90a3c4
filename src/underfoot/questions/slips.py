"""Slips of a population of walkers on the floor of a case: who slips, how fast, how far."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from underfoot.compute.run import run
from underfoot.compute.slips import slips
from underfoot.core import InputError, Progress, SourcedValue, silent
from underfoot.core.presentation import (
    Part,
    Presentable,
    Table,
    percent,
    probability_text,
    quantity_text,
    value_text,
)
from underfoot.core.progress import part
from underfoot.core.remark import NOTHING, Message
from underfoot.core.text import decode_text
from underfoot.slip.dynamics import (
    GaitHistory,
    SlipMotion,
    SlipStudy,
    error_text,
    load_history,
    recorded_histories,
)
from underfoot.slip.dynamics.gait import COLUMNS
from underfoot.sole_contact.reading import BLIND

if TYPE_CHECKING:
    from underfoot.case import Case

_BRAKED = {"heel_brake": "constant"}
BANDS: dict[str, tuple[str, str, dict[str, str], tuple[float, ...]]] = {
    "effective_mass": ("moving mass", "of the body mass (assumed)", {}, (0.06, 0.114, 0.17)),
    "weight_transfer": ("load of a slip", "of the dry load (0.35 to 0.75)", {}, (0.35, 0.75, 1.0)),
    "brake_time": ("braking of the heel", "s, time constant", _BRAKED, (0.004, 0.011, 0.025)),
}
"""Fields of a walker that a slip hangs on: what it is, of what, what it takes, values."""
NUMBERS = {
    "peak_speed": ("Peak slipping speed", "m/s"),
    "distance": ("Distance slipped", "m"),
    "peak_pressure": ("Peak pressure at the sensors", "Pa"),
    "duration": ("Duration of the pressure", "s"),
}
AT_SENSORS = ("peak_pressure", "duration")


@dataclass(frozen=True, slots=True)
class SlipPopulation(Presentable):
    """Simulated slips of a population of walkers.

    ``predicted`` is the slip probability of the same people by the slip model of the case, as
    ``run`` gives it on the same grid, and ``model`` the name of that.
    """

    kind: ClassVar[str] = "slip"

    name: str
    study: SlipStudy
    predicted: SourcedValue
    model: str

    def __repr__(self) -> str:
        return f"<SlipPopulation on {self.name!r}: {len(self.study.subjects)} walkers>"

    @property
    def wet(self) -> bool:
        """Whether there is a fluid on the floor."""
        return self.study.setting.viscosity is not None

    @property
    def heard(self) -> bool:
        """Whether a sensor read anybody's film above its own noise."""
        return self.wet and any(
            subject.seen.duration is not None for subject in self.study.subjects
        )

    def headline(self) -> tuple[Message, ...]:
        study = self.study
        count = len(study.subjects)
        if count == 1:
            seen = study.subjects[0].seen
            return (
                Message(
                    "The walker {verdict}: peak heel speed {speed:.2f} m/s (slip above 0.2 m/s), "
                    "distance {distance:.0f} mm ({outcome}).",
                    verdict=Message("slips") if seen.slipped else Message("does not slip"),
                    speed=seen.peak_speed, distance=1e3 * seen.distance, outcome=seen.outcome,
                ),
                Message("One walker has no spread, so no interval."),
            )  # fmt: skip
        shares = zip(
            ("share", "low", "high"), map(probability_text, study.slip_share()), strict=True
        )
        middle, spread = NOTHING, Message("walkers")
        if study.by_friction is not None:
            middle = Message(", at the middle of the friction")
            spread = Message("walkers and friction")
        return (
            Message(
                "{share} of simulated steps slip (heel faster than 0.2 m/s; 95 % of {count} "
                "{spread}: {low} to {high}).",
                **dict(shares), count=count, spread=spread,
            ),
            Message(
                "Peak heel speed {speed} (mean and standard deviation between walkers{middle}).",
                speed=_value_text(study.mean("peak_speed", "m/s")), middle=middle,
            ),
            *(() if self.wet else (Message("The case has no fluid: no film."),)),
        )  # fmt: skip

    def cautions(self) -> tuple[Message, ...]:
        study = self.study
        reasons: list[Message] = [
            Message(
                "Drive is that of dry walking and walkers do not react: speeds and distances of "
                "long slips are upper limits."
            ),
            *self._other_model(),
        ]
        lower = sum(subject.motion.still_sliding for subject in study.subjects)
        if lower:
            reasons.append(
                Message("{count} still slide when their step ends: lower bounds.", count=lower)
            )
        if study.fit is not None and study.fit.at_bound:
            reasons.append(
                Message(
                    "Constants of the reduced model not identified by these slips: {names}.",
                    names=study.fit.at_bound,
                )
            )
        seen = study.highest_seen()
        if self.heard and seen is not None and seen < BLIND:
            reasons.append(
                Message(
                    "Inlets of {inlet:.3g} mm read at most {seen} of the film's highest "
                    "pressure: a low reading does not show that there is no film.",
                    inlet=1e3 * study.array.inlet_diameter, seen=percent(seen),
                )
            )  # fmt: skip
        if study.by_friction is None and len(study.subjects) > 1:
            reasons.append(
                Message(
                    "The interval holds the number of walkers alone, not the spread of the "
                    "friction."
                )
            )
        if study.failed:
            reasons.append(
                Message(
                    "Slips that could not be solved and are left out: {failed} of {count} full "
                    "runs.",
                    failed=study.failed, count=study.failed + len(study.full_runs),
                )
            )  # fmt: skip
        return tuple(reasons)

    def _other_model(self) -> tuple[Message, ...]:
        """Return what ``run`` and ``risk`` answer, and why it is another number."""
        if self.predicted.value is None:
            return ()
        return (
            Message(
                "run and risk answer {chance} for these people on this floor ({model}): a curve "
                "fitted to counted slips, with the spread of film, tread and grid; here it is "
                "that of the contact's friction alone.",
                chance=value_text("slip_probability", self.predicted), model=self.model,
            ),
        )  # fmt: skip

    def table(self) -> Table:
        study = self.study
        single = len(study.subjects) < 2
        rows = []
        for outcome, (share, low, high) in study.shares().items():
            interval = NOTHING
            if not single:
                ends = {"low": percent(low), "high": percent(high)}
                interval = Message("95 %: {low} to {high}", **ends)
            rows.append(
                (Message("Distance slipped: {outcome}", outcome=outcome), percent(share), interval)
            )
        middle = NOTHING
        if study.by_friction is not None:
            middle = Message(", at the middle of the friction")
        for name, (label, unit) in NUMBERS.items():
            if self.heard or name not in AT_SENSORS:
                value = study.mean(name, unit, crossed=name in AT_SENSORS)
                range_text = self._range(name, unit)
                remark: str = value.reason
                if range_text:
                    remark = Message("{range}{middle}", range=range_text, middle=middle)
                rows.append((label, _value_text(value), remark))
        if self.heard:
            rows += self._sensor_rows()
        elif self.wet:
            rows.append((NUMBERS["peak_pressure"][0], "not above their noise", "of no walker"))
        if study.fit is not None:
            error, fitted = study.fit.held_out, study.fit.fitted.peak_speed
            label = "Reduced model on full runs held out"
            remark = Message(
                "{error}; on fitted runs {fitted}", error=error, fitted=error_text(fitted, "m/s")
            )
            rows.append((label, error_text(error.peak_speed, "m/s"), remark))
            if study.pressure_error is not None:
                rows.append(
                    (Part("peak pressure"), f"± {percent(study.pressure_error)}", "relative")
                )
        if (start := study.slip_start()) is not None:
            remark = Message(
                "at {load:.2f} of body weight; in 39 slips of people 20 ms, 0.27 (Iraqi et al. "
                "2018)",
                load=start[1],
            )
            rows.append(("Slip start", Message("{start:.0f} ms", start=1e3 * start[0]), remark))
        for name, (label, unit, _, values) in BANDS.items():
            every = self._by(name).values()
            speeds = [speed for speed in every if speed is not None]
            if len(speeds) == len(every):
                text = Message("{speeds: / } m/s", speeds=[f"{speed:.2f}" for speed in speeds])
                if max(speeds) < 0.005:
                    text = Message("below 0.01 m/s")
                remark = Message(
                    "{values: / } {unit}; without marker",
                    values=[f"{value:g}" for value in values], unit=unit,
                )  # fmt: skip
                rows.append((Message("Peak speed by {label}", label=label), text, remark))
        return Table("Population", ("Quantity", "Value", "Remark"), rows)

    def remarks(self) -> dict[str, Sequence[str]]:
        study = self.study
        people = study.population
        model = "full model for every walker" if study.full else "reduced model fitted to full runs"
        low, high = people.weight_transfer
        lines = [Message("model: {model}", model=model)] if self.wet else []
        lines += [
            Message(
                "moving mass: {mass:.3g} of the body mass (assumed)",
                mass=people.effective_mass,
            ),
            Message(
                "a slipping foot takes on {low:.2g} to {high:.2g} of the dry step's load (assumed)",
                low=low, high=high,
            ),
        ]  # fmt: skip
        if any(spread.assumed for spread in (people.mass, people.rcof, people.heel_speed)):
            lines.append(
                Message(
                    "people: RCOF {mean:.3g} ± {sd:.2g}, heel contact at {speed:.3g} ± "
                    "{spread:.2g} m/s (assumed)",
                    mean=people.rcof.mean, sd=people.rcof.sd, speed=people.heel_speed.mean,
                    spread=people.heel_speed.sd,
                )
            )  # fmt: skip
        return {
            "Outside the tested range": study.breaches,
            "Assumptions": (*lines, *study.setting.friction.assumptions),
        }

    def to_dict(self) -> dict[str, Any]:
        study = self.study

        def finite(value: float) -> float | None:
            return None if math.isnan(value) else float(value)

        return {
            "subjects": len(study.subjects),
            "model": "full" if study.full else "reduced",
            "outcomes": {str(k): [finite(x) for x in v] for k, v in study.shares().items()},
            "numbers": study.numbers(),
            "slip_probability": {**self.predicted.to_dict(), "model": self.model},
            "row_peaks_Pa": [finite(pressure) for pressure in study.rows()],
            **{f"peak_speed_by_{name}": self._by(name) for name in BANDS},
            "fit_error": None if study.fit is None else str(study.fit.held_out),
            "pressure_error": study.pressure_error,
            "failed": study.failed,
            "remarks": {title: list(lines) for title, lines in self.remarks().items()},
        }

    def data_tables(self) -> dict[str, Table]:
        heads = (
            "subject history mass_kg rcof walking_speed_m_per_s heel_speed_m_per_s shoe_angle_deg "
            "landing_mm lateral_mm peak_slipping_speed_m_per_s slip_start_s distance_m outcome "
            "slipped crossed_sensors peak_pressure_Pa pressure_duration_s flags"
        )
        rows = []
        for subject in self.study.subjects:
            walker, seen = subject.walker, subject.seen
            rows.append(
                (
                    *(walker.name, walker.history.name, f"{walker.mass:.1f}", f"{walker.rcof:.4f}"),
                    f"{walker.walking_speed or math.nan:.3f}",
                    f"{walker.heel_speed:.3f}",
                    f"{math.degrees(walker.shoe_angle):.2f}",
                    *(f"{1e3 * place:.1f}" for place in (walker.landing, walker.lateral)),
                    *(f"{seen.peak_speed:.4f}", seen.start, f"{seen.distance:.4f}"),
                    *(str(seen.outcome), seen.slipped, seen.crossed),
                    *(f"{seen.peak_pressure:.0f}", seen.duration),
                    "; ".join(map(str, seen.flags)),
                )
            )
        return {
            "subjects": Table("", tuple(heads.split()), rows),
            "motion": motion_table(shown_motion(self.study)),
        }

    def _by(self, name: str) -> dict[str, float | None]:
        """Return the mean peak speed at each value of a field of ``BANDS``."""
        _, _, others, values = BANDS[name]
        study = self.study
        return {f"{v:g}": study.peak_speed_at(**{name: v}, **others) for v in values}

    def _sensor_rows(self) -> list[tuple[str, str, str]]:
        correlation = self.study.correlation()
        value, remark = (
            "not estimated",
            "fewer than three walkers crossed the sensors, or no scatter",
        )
        if correlation is not None:
            value, remark = f"{correlation:.2f}", "Pearson"
        rows = [("Correlation of peak speed and peak pressure", value, remark)]
        levels = self.study.rows()
        if np.isfinite(levels).all():
            text = Message("{levels: / } kPa", levels=[f"{level / 1e3:.3g}" for level in levels])
            remark = "mean of the walkers whose heel crossed the sensors"
            rows.append(("Peak by row of sensors, first to last", text, remark))
        return rows

    def _range(self, name: str, unit: str) -> Message:
        values = self.study.of(name)
        if name in AT_SENSORS:
            values = values[np.array([subject.seen.crossed for subject in self.study.subjects])]
        values = values[np.isfinite(values)]
        if values.size < 5:
            return NOTHING
        low, high = np.percentile(values, [5, 95])
        return Message(
            "90 % of the walkers: {low} to {high}", low=_text(low, unit), high=_text(high, unit)
        )


def slip_population(
    case: Case,
    *,
    subjects: int | None = None,
    histories: Sequence[GaitHistory] | None = None,
    full_model: bool = False,
    quick: bool = True,
    progress: Progress = silent,
) -> SlipPopulation:
    """Return the slips of a case's population; arguments as for ``compute.slips.slips``.

    Parameters:
        case: Shoe, floor, fluid and people.
        subjects: Number of persons drawn; None takes the number of the case.
        histories: Steps of your own in place of the packaged ones.
        full_model: Solve the contact in each slip, not the reduced model.
        quick: Use the coarse grid.
        progress: Called with stage, fraction and residual; an exception it raises stops the work.
    """
    study = slips(
        case,
        subjects=subjects,
        histories=histories or None,
        full=full_model,
        fine=not quick,
        progress=part(progress, 0.0, 0.9),
    )
    predicted = run(case, quick=quick, progress=part(progress, 0.9, 1.0))
    return SlipPopulation(case.name, study, predicted.scalars["slip_probability"], case.risk.name)


def own_histories(path: Path) -> list[GaitHistory]:
    """Return the steps of a table of load and shear, or those of a force-plate recording."""
    if path.suffix.lower() == ".csv" and path.is_file():
        lines = decode_text(path.read_bytes(), str(path)).splitlines()
        if any(line.startswith(COLUMNS[0]) for line in lines[:50]):
            return [load_history(path)]
    return recorded_histories(path)


SAME_RCOF = 1e-6
"""RCOF apart by less are written alike: their rounding is no spread of people."""


@dataclass(frozen=True, slots=True)
class MeasuredRcof:
    """Required friction of measured walkers.

    Attributes:
        mean, sd: Of the persons; of one person alone those of the steps.
        mean_deviation, sd_deviation: What both may be off by, one standard deviation.
        within: Standard deviation between the steps of one person, pooled; None of single steps.
        persons: Their number; 1: ``sd`` is ``within``, and nobody else's.
        text: Whose they are.
    """

    mean: float
    sd: float
    mean_deviation: float
    sd_deviation: float
    within: float | None
    persons: int
    text: Message

    @classmethod
    def of(cls, steps: Mapping[str, Sequence[float]], who: Message, more: Message) -> Self:
        """Return that of the steps of each person or file; ``who`` names these, ``more`` adds."""
        values = [np.asarray(each, dtype=float) for each in steps.values()]
        count = sum(value.size for value in values)
        freedom = count - len(values)
        squares = sum(float(((value - value.mean()) ** 2).sum()) for value in values)
        within = math.sqrt(squares / freedom) if freedom else None
        one = len(values) == 1
        of = values[0] if one else np.array([value.mean() for value in values])
        mean, sd = float(of.mean()), float(of.std(ddof=1))
        spread = NOTHING
        if one:
            between = Message(
                "{count} steps of one walker: the slip probability is that walker's, nobody else's",
                count=count,
            )
        else:
            groups = {"number": len(values), "who": who}
            between = Message("{number} {who}, {count} steps", **groups, count=count)
            if within is not None:
                spread = Message(", SD {within:.3f} between the steps of one", within=within)
        text = Message(
            "RCOF mean {mean:.3f}, SD {sd:.3f} between {between}{spread}{more}",
            mean=mean, sd=sd, between=between, spread=spread, more=more,
        )  # fmt: skip
        both = sd / math.sqrt(of.size), sd / math.sqrt(2 * (of.size - 1))
        return cls(mean, sd, *both, within, len(values), text)

    def settings(self, *, steps: bool) -> list[str]:
        """Return what to set in a case; ``steps``: the spread between steps has a key of its own.

        There one walker differs from nobody, and his steps from each other.
        """
        sd, off = (0.0, 0.0) if steps and self.persons == 1 else (self.sd, self.sd_deviation)
        numbers = {"mean": (self.mean, self.mean_deviation), "sd": (sd, off)}
        made = [
            f"risk.rcof_{name}={{value = {value:.6g}, uncertainty = {off:.6g}}}"
            for name, (value, off) in numbers.items()
        ]
        return [*made, *([f"slip.rcof_step_sd={self.within:.6g}"] if steps and self.within else [])]


def measured_rcof(path: Path) -> MeasuredRcof:
    """Return the RCOF of measured persons.

    Read from measurements.csv of ``underfoot trials analyse``. The steps of a person count as one
    value, their mean; where no person is named, those of a file do. Where some are named, steps of
    nobody are left out: they may be of one of them. Of one person alone the steps count.

    Raises:
        InputError: No such file, no RCOF in it, or one step only, or all alike.
    """
    from underfoot.trials.recording.measurement import MEAN_OF_STEPS

    try:
        rows = list(csv.DictReader(decode_text(path.read_bytes(), str(path)).splitlines()))
    except FileNotFoundError:
        raise InputError("there is no such file", where=str(path)) from None
    rows = [
        row
        for row in rows
        if row.get("quantity") == "rcof" and row.get("value") and row["item"] != MEAN_OF_STEPS
    ]
    named = [row for row in rows if row.get("person")]
    steps: dict[str, list[float]] = {}
    for row in named or rows:
        steps.setdefault(row.get("person") or row.get("file") or "", []).append(float(row["value"]))
    if not steps:
        raise InputError(
            "holds no RCOF",
            where=str(path),
            allowed='rows with quantity "rcof" and a value, as in measurements.csv',
        )
    values, several = [*steps.values()], len(steps) > 1
    apart = [float(np.mean(value)) for value in values] if several else values[0]
    if np.ptp(apart) < SAME_RCOF:
        alike = Message("one step")
        if len(apart) > 1:
            alike = Message("{count} steps, all alike", count=len(apart))
        if several:
            alike = Message("{count} persons, all alike", count=len(apart))
        raise InputError(
            Message("RCOF of {alike}: there is no spread", alike=alike),
            where=str(path),
            remedy="Record more steps, or set risk.rcof_mean and risk.rcof_sd",
        )
    cautions = sum(row.get("caution") == "yes" for row in named or rows)
    doubted = left_out = NOTHING
    if cautions and len(steps) > 1:
        doubted = Message(", {count} of them with a caution", count=cautions)
    if nobody := len(rows) - len(named) if named else 0:
        left_out = Message("; {count} steps of no named person are left out", count=nobody)
    who = Message("files (no person is named: several may be one person)")
    if named:
        who = Message("persons")
    return MeasuredRcof.of(
        steps, who, Message("{doubted}{left_out}", doubted=doubted, left_out=left_out)
    )


def shown_motion(study: SlipStudy) -> SlipMotion:
    """Return the motion to draw: the full run of the median walker, else the median motion."""
    if study.representative is not None:
        return study.representative.motion
    speeds = study.of("peak_speed")
    return study.subjects[int(np.argmin(np.abs(speeds - np.median(speeds))))].motion


def motion_table(motion: SlipMotion) -> Table:
    """Return one slip against time, in SI."""
    names = ("time", "speed", "distance", "normal", "drive", "friction", "fluid_load")
    units = ("s", "m_per_s", "m", "N", "N", "N", "N")
    heads = tuple(f"{name}_{unit}" for name, unit in zip(names, units, strict=True))
    columns = [np.round(getattr(motion, name), 6).tolist() for name in names]
    return Table("", heads, list(zip(*columns, strict=True)))


def _value_text(value: SourcedValue) -> str:
    if value.value is None:
        return Message("not determined: {reason}", reason=value.reason)
    if value.unit == "m/s":
        spread = "" if value.uncertainty is None else f" ± {_speed_text(value.uncertainty)}"
        return f"{value.value:.2f}{spread} m/s"
    return quantity_text(value.value, value.unit, value.uncertainty)


def _speed_text(value: float) -> str:
    return f"{value:.2f}" if value >= 0.005 else "below 0.01"


def _text(value: float, unit: str) -> str:
    return f"{value:.2f} m/s" if unit == "m/s" else quantity_text(float(value), unit)
