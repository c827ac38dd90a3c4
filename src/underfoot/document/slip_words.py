"""A population's slips in words, rows and tables."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import SourcedValue, display

from .sentences import Row, percent

if TYPE_CHECKING:
    from underfoot.slip.dynamics import SlipMotion, SlipStudy

MASSES = (0.06, 0.114, 0.17)
"""Shares of the body that may move with the heel: foot and shank, the default, the whole leg."""
_NUMBERS = (
    ("peak_speed", "Peak slipping speed", "m/s"),
    ("distance", "Distance slipped", "m"),
    ("peak_pressure", "Peak pressure at the sensors", "Pa"),
    ("duration", "Duration of the pressure", "s"),
)


def slip_sentence(study: SlipStudy) -> str:
    """Return the answer in two or three sentences."""
    count = len(study.subjects)
    share, low, high = study.slipped()
    speed = study.mean("peak_speed", "m/s")
    if count == 1:
        seen = study.subjects[0].seen
        verdict = "slips" if seen.slipped else "does not slip"
        return (
            f"The one walker {verdict} (peak heel speed {seen.peak_speed:.2f} m/s, limit 0.2 m/s; "
            f"{1e3 * seen.distance:.0f} mm: {seen.outcome}). One person has no spread: no band."
        )
    first = (
        f"{round(share * count)} of {count} walkers slip (heel faster than 0.2 m/s): "
        f"{percent(share)}, 95 % band {percent(low)} to {percent(high)}."
    )
    second = f" The heel reaches {_text(speed)} (mean and spread between walkers)."
    if study.setting.viscosity is None:
        return first + second + " The floor is dry: no film."
    model = "full model for everybody" if study.full else "reduced model fitted to full slips"
    return first + second + f" Computed with the {model}."


def slip_rows(study: SlipStudy) -> list[Row]:
    """Return the table's lines: label, value, remark."""
    rows = []
    single = len(study.subjects) < 2
    for outcome, (share, low, high) in study.shares().items():
        band = "one person has no band" if single else f"95 %: {percent(low)} to {percent(high)}"
        rows.append(Row(f"Outcome: {outcome}", percent(share), band))
    for name, label, unit in _NUMBERS:
        if study.setting.viscosity is None and name in ("peak_pressure", "duration"):
            continue
        crossed = name in ("peak_pressure", "duration")
        value = study.mean(name, unit, crossed=crossed)
        rows.append(Row(label, _text(value), _range(study, name, unit) or value.reason))
    if study.setting.viscosity is not None:
        r = study.correlation()
        rows.append(
            Row(
                "Correlation of peak speed and peak pressure",
                "not estimated" if r is None else f"{r:.2f}",
                "fewer than three who crossed, or no scatter" if r is None else "Pearson",
            )
        )
        levels = study.rows()
        if np.isfinite(levels).all():
            rows.append(
                Row(
                    "Peak by row of sensors, first to last",
                    " / ".join(f"{p / 1e3:.3g}" for p in levels) + " kPa",
                    "mean over those whose heel crossed the sensors",
                )
            )
    if study.fit is not None:
        error = study.fit.held_out
        rows.append(
            Row(
                "Reduced model against full runs it did not see",
                f"± {error.peak_speed:.2g} m/s",
                f"{error}; on those it was fitted to, reaching further out: "
                f"± {study.fit.fitted.peak_speed:.2g} m/s",
            )
        )
        if study.pressure_error is not None:
            rows.append(
                Row("  its peak pressure", f"± {percent(study.pressure_error)}", "relative")
            )
    speeds = [study.peak_speed_at(share) for share in MASSES]
    if None not in speeds:
        words = " / ".join(f"{v:.2f}" for v in speeds if v is not None)
        shares = " / ".join(f"{share:g}" for share in MASSES)
        rows.append(
            Row(f"Peak speed if {shares} of the body moved", f"{words} m/s", "assumed mass varied")
        )
    if study.failed:
        rows.append(Row("Slips that could not be solved", str(study.failed), "left out"))
    return rows


def slip_cautions(study: SlipStudy) -> tuple[str, ...]:
    """Return what a reader must know beside the numbers."""
    found = [
        "The load and the drive are those of dry walking: nobody catches himself, so speeds and "
        "distances of long slips are those of a person who does not react.",
        f"The slipping foot weighs {study.population.effective_mass:.3g} of the body (assumed).",
    ]
    lower = sum(s.motion.still_sliding for s in study.subjects)
    if lower:
        found.append(f"{lower} still slide when their step's history ends: lower bounds.")
    if study.fit is not None and study.fit.at_bound:
        found.append(
            "Constants of the reduced model that these slips can't fix: "
            + ", ".join(study.fit.at_bound)
        )
    spreads = (study.population.mass, study.population.rcof, study.population.heel_speed)
    if any(s.assumed for s in spreads):
        found.append(
            f"Assumed of the people: RCOF {study.population.rcof.mean:.3g} ± "
            f"{study.population.rcof.sd:.2g}, heel speed at contact "
            f"{study.population.heel_speed.mean:.3g} ± {study.population.heel_speed.sd:.2g} m/s."
        )
    return (*found, *study.setting.friction.assumptions, *study.breaches)


def slip_data(study: SlipStudy) -> dict[str, Any]:
    """Return the answer as plain data in SI; what is missing is None."""

    def clean(x: float) -> float | None:
        return None if math.isnan(x) else x

    return {
        "sentence": slip_sentence(study),
        "subjects": len(study.subjects),
        "model": "full" if study.full else "reduced",
        "outcomes": {str(k): [clean(x) for x in v] for k, v in study.shares().items()},
        "numbers": study.numbers(),
        "row_peaks_Pa": [clean(float(p)) for p in study.rows()],
        "peak_speed_by_effective_mass": {
            f"{share:g}": study.peak_speed_at(share) for share in MASSES
        },
        "fit_error": None if study.fit is None else str(study.fit.held_out),
        "pressure_error": study.pressure_error,
        "failed": study.failed,
        "cautions": list(slip_cautions(study)),
    }


def write_slip_tables(study: SlipStudy, folder: Path) -> None:
    """Write subjects.csv, slip.json and motion.csv (the median walker) into a folder."""
    (folder / "slip.json").write_text(
        json.dumps(slip_data(study), indent=2, ensure_ascii=False), encoding="utf-8"
    )
    with (folder / "subjects.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(
            ["subject", "history", "mass_kg", "rcof", "walking_speed_m_per_s",
             "heel_speed_m_per_s", "shoe_angle_deg", "landing_mm", "lateral_mm",
             "peak_slipping_speed_m_per_s", "slip_start_s", "distance_m", "outcome", "slipped",
             "crossed_sensors", "peak_pressure_Pa", "pressure_duration_s", "flags"]
        )  # fmt: skip
        for s in study.subjects:
            w, seen = s.walker, s.seen
            writer.writerow(
                [w.name, w.history.name, f"{w.mass:.1f}", f"{w.rcof:.4f}",
                 f"{w.walking_speed or math.nan:.3f}", f"{w.heel_speed:.3f}",
                 f"{math.degrees(w.shoe_angle):.2f}", f"{1e3 * w.landing:.1f}",
                 f"{1e3 * w.lateral:.1f}", f"{seen.peak_speed:.4f}", seen.start,
                 f"{seen.distance:.4f}", str(seen.outcome), seen.slipped, seen.crossed,
                 f"{seen.peak_pressure:.0f}", seen.duration, "; ".join(seen.flags)]
            )  # fmt: skip
    write_motion(shown_motion(study), folder / "motion.csv")


def write_motion(motion: SlipMotion, path: Path) -> None:
    """Write one slip against time."""
    names = ("time", "speed", "distance", "normal", "drive", "friction", "fluid_load")
    units = ("s", "m_per_s", "m", "N", "N", "N", "N")
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow([f"{n}_{u}" for n, u in zip(names, units, strict=True)])
        writer.writerows(zip(*(np.round(getattr(motion, n), 6) for n in names), strict=True))


def shown_motion(study: SlipStudy) -> SlipMotion:
    """Return the motion to draw: the full run of the median walker, else the first one's."""
    if study.representative is not None:
        return study.representative.motion
    speeds = study.of("peak_speed")
    return study.subjects[int(np.argmin(np.abs(speeds - np.median(speeds))))].motion


def _range(study: SlipStudy, name: str, unit: str) -> str:
    values = study.of(name)
    if name in ("peak_pressure", "duration"):
        values = values[np.array([s.seen.crossed for s in study.subjects])]
    values = values[np.isfinite(values)]
    if values.size < 5:
        return ""
    low, high = np.percentile(values, [5, 95])
    return f"90 % of the walkers: {_plain(low, unit)} to {_plain(high, unit)}"


def _text(value: SourcedValue) -> str:
    if value.value is None:
        return f"not determined: {value.reason}"
    spread = "" if value.uncertainty is None else f" ± {_plain(value.uncertainty, value.unit, 2)}"
    return _plain(value.value, value.unit) + spread


def _plain(value: float, unit: str, digits: int = 3) -> str:
    if unit == "m/s":
        return f"{value:.2f} m/s"
    return display(float(value), unit, digits)
