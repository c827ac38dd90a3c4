"""What a step asks of the floor: load, shear ratio and foot angle against time since contact."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from importlib.resources import files
from pathlib import Path

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.core.text import decode_text, existing

COLUMNS = (
    "time_s",
    "normal_per_body_weight",
    "shear_ratio",
    "foot_angle_deg",
    "heel_velocity_m_per_s",
)
LEAST_LOAD = 0.05  # of body weight: below, the ratio of two small forces is noise
SLOWEST = 0.05  # m/s at contact: a slower heel does not tell how it stops
GATE = 0.15  # of body weight (100 N of 70 kg): RCOF counts above it, as in the report's G.6.1


@dataclass(frozen=True, slots=True)
class GaitHistory:
    """One step of dry walking from heel contact on.

    Parameters:
        name: Of the recording and step.
        time: (n,), s, from 0, rising.
        normal: (n,), normal force over body weight, 1, not negative.
        ratio: (n,), shear over normal force, 1; positive pushes the floor forward (braking), which
            is what slides the foot forward when friction fails. Size: resultant; sign: along the
            walk.
        foot_angle: (n,), rad, toe up positive, 0 with the foot flat; None when not recorded.
        walking_speed: m/s; None when not recorded.
        heel_speed: Horizontal speed of the heel marker at contact, m/s; None when not recorded.
        heel_velocity: (n,), m/s, of the heel over the floor along the walk; None when not recorded.
        source: Recording, licence and how body weight was found.

    Raises:
        InputError: Arrays that don't match, times that don't rise, values that are not finite, a
            negative load, a ratio outside -1.5 to 1.5.
    """

    name: str
    time: Array
    normal: Array
    ratio: Array
    foot_angle: Array | None = None
    walking_speed: float | None = None
    heel_speed: float | None = None
    heel_velocity: Array | None = None
    source: str = ""
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        where = Message("history {name}", name=self.name)
        for label in ("time", "normal", "ratio", "foot_angle", "heel_velocity"):
            values = getattr(self, label)
            if values is None:
                continue
            values = np.asarray(values, dtype=float)
            object.__setattr__(self, label, values)
            if values.ndim != 1 or values.size < 5 or values.shape != np.shape(self.time):
                raise InputError(
                    Message("{label} has shape {shape}", label=label, shape=str(values.shape)),
                    where=where,
                    allowed="5 or more samples",
                )
            if not np.isfinite(values).all():
                raise InputError(
                    Message("{label} holds values that are no numbers", label=label), where=where
                )
        if self.time[0] != 0 or not (np.diff(self.time) > 0).all():
            raise InputError(
                "times do not rise from 0", where=where, allowed="seconds since heel contact"
            )
        if (self.normal < 0).any():
            raise InputError("the normal force is negative", where=where, allowed="0 or more")
        if self.normal.max() > 4:
            raise InputError(
                Message("the normal force reaches {max:.3g} body weights", max=self.normal.max()),
                where=where,
                allowed="up to 4",
                remedy="Divide it by body weight",
            )
        if np.abs(self.ratio).max() > 1.5:
            raise InputError(
                Message("the shear ratio reaches {max:.3g}", max=np.abs(self.ratio).max()),
                where=where,
                allowed="-1.5 to 1.5",
            )

    @property
    def duration(self) -> float:
        """Length of the history, s."""
        return float(self.time[-1])

    @property
    def landing(self) -> Array | None:
        """Share (n,) of its speed at contact that the landing heel still has, 1; None if unknown.

        The least so far of ``heel_velocity``, 0 once the heel stands: what a marker moves later is
        the foot that rolls.
        """
        if self.heel_velocity is None or self.heel_velocity[0] < SLOWEST:
            return None
        least = np.minimum.accumulate(self.heel_velocity)
        return np.maximum(least, 0.0) / self.heel_velocity[0]

    @property
    def rcof(self) -> float:
        """Largest ratio in the first half above 15 % of body weight, 1."""
        early = (self.time <= 0.5 * self.duration) & (self.normal > GATE)
        if not early.any() or self.ratio[early].max() <= 0:
            raise InputError(
                "no braking above 15 % of body weight in the first half",
                where=Message("history {name}", name=self.name),
                remedy="Give a whole stance, with braking as positive ratio",
            )
        return float(self.ratio[early].max())

    @property
    def end_of_braking(self) -> float:
        """Time after which the ratio is positive no more, s; the end when it stays positive."""
        positive = np.flatnonzero((self.ratio > 0) & (self.normal > GATE))
        return float(self.time[positive[-1]]) if positive.size else 0.0

    def asking(self, rcof: float) -> GaitHistory:
        """Return the history with its ratio scaled to another RCOF."""
        if not 0 <= rcof <= 1:
            raise InputError(f"RCOF {rcof:g}", where="rcof", allowed="0 to 1")
        return replace(self, ratio=self.ratio * (rcof / self.rcof))

    def lasting(self, duration: float) -> GaitHistory:
        """Return the history stretched in time to another length, s."""
        if not (math.isfinite(duration) and duration > 0):
            raise InputError(f"{duration:g} s", where="duration", allowed="above 0")
        return replace(self, time=self.time * (duration / self.duration))


def load_history(path: Path | str) -> GaitHistory:
    """Return a history from a table of our own columns (CSV; lines with # are notes).

    Columns: time_s, normal_per_body_weight, shear_ratio and, where known, foot_angle_deg and
    heel_velocity_m_per_s.
    """
    text = decode_text(existing(path).read_bytes(), str(path))
    return history_from_lines(text.splitlines(), Path(path).stem)


def history_from_lines(lines: Iterable[str], name: str) -> GaitHistory:
    """Return the history in the lines of a table."""
    notes: dict[str, str] = {}
    rows = []
    for line in lines:
        if line.startswith("#"):
            key, sign, value = line[1:].partition(":")
            if sign:
                notes[key.strip()] = value.strip()
        elif line.strip():
            rows.append(line)
    table = list(csv.DictReader(rows))
    missing = [c for c in COLUMNS[:3] if not table or c not in table[0]]
    if missing:
        raise InputError(
            Message("the column {missing} is missing", missing=missing[0]),
            where=name,
            allowed=", ".join(COLUMNS),
        )
    try:
        values = {c: np.array([float(row[c]) for row in table]) for c in COLUMNS[:3]}
        angle, heel = (
            np.array(cells, dtype=float) if all(cells) else None
            for cells in ([row.get(column) or "" for row in table] for column in COLUMNS[3:])
        )
    except (TypeError, ValueError) as error:
        raise InputError(
            Message("a cell is no number ({error})", error=error), where=name
        ) from None
    return GaitHistory(
        name,
        values["time_s"],
        values["normal_per_body_weight"],
        values["shear_ratio"],
        None if angle is None else np.radians(angle),
        walking_speed=_number(notes.get("walking speed (m/s)")),
        heel_speed=_number(notes.get("heel speed at contact (m/s)")),
        heel_velocity=heel,
        source="; ".join(notes[k] for k in ("source", "licence", "body weight") if k in notes),
    )


def history_text(history: GaitHistory, notes: dict[str, str]) -> str:
    """Return a table that ``load_history`` reads; ``notes`` become its first lines."""
    lines = [f"# {key}: {value}" for key, value in notes.items()]
    for key, value in (
        ("walking speed (m/s)", history.walking_speed),
        ("heel speed at contact (m/s)", history.heel_speed),
    ):
        if value is not None:
            lines.append(f"# {key}: {value:.3f}")
    lines.append(",".join(COLUMNS))
    angle, heel = history.foot_angle, history.heel_velocity
    for i, (t, n, r) in enumerate(zip(history.time, history.normal, history.ratio, strict=True)):
        turned = "" if angle is None else f"{math.degrees(angle[i]):.2f}"
        moved = "" if heel is None else f"{heel[i]:.3f}"
        lines.append(f"{t:.4f},{n:.4f},{r:.4f},{turned},{moved}")
    return "\n".join(lines) + "\n"


def packaged_histories() -> tuple[GaitHistory, ...]:
    """Return the steps that come with the package: real dry walking of six laboratories."""
    folder = files("underfoot") / "data" / "gait"
    tables = sorted((f for f in folder.iterdir() if f.name.endswith(".csv")), key=lambda f: f.name)
    return tuple(
        history_from_lines(f.read_text(encoding="utf-8").splitlines(), f.name[:-4]) for f in tables
    )


def _number(text: str | None) -> float | None:
    return None if text is None else float(text)
