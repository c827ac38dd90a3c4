"""The calibration record of a slip tester: factors with uncertainty, daily checks, noise."""

import datetime
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import InputError, nearest_match, to_si
from underfoot.core.files import read_toml
from underfoot.core.remark import Message

from .measurement import Flag

FILE = "calibration.toml"
FAILED = "check failed"
CHANNELS = {"normal": "N", "friction": "N", "pressure": "Pa"}
_GRAVITY = (
    9.80665  # m/s2; the local one differs by up to 0.3 %, and cancels in friction over normal
)
_CROSSTALK = 0.01  # friction over weight that a check may read; assumed
_KEYS = {
    "tester": ("name", "certificate", "date", "valid_until", "tolerance"),
    "channel": ("reference", "reading", "uncertainty", "range", "noise"),
    "check": ("date", "channel", "reference", "reading"),
}


@dataclass(frozen=True, slots=True)
class ChannelCalibration:
    """What a channel's reading is multiplied by, and what is known of the channel (SI).

    ``factor`` is reference over reading, fitted through the points after their zero;
    ``uncertainty`` is its relative standard uncertainty: that of the masses and the scatter of the
    points. ``highest`` is the largest reference, ``range`` the channel's full scale, ``noise`` the
    standard deviation of the unloaded channel; None where the record does not say.
    """

    factor: float
    uncertainty: float
    highest: float
    range: float | None = None
    noise: float | None = None


@dataclass(frozen=True, slots=True)
class DailyCheck:
    """A check with a known mass: relative ``error`` after calibration.

    ``channel`` "crosstalk" is the friction channel under a mass that only presses: its error is
    the friction read over the weight.
    """

    date: datetime.date
    channel: str
    error: float
    allowed: float
    description: str


@dataclass(frozen=True, slots=True)
class TesterCalibration:
    """The calibration record that every reading of a tester refers to."""

    name: str
    certificate: str
    date: datetime.date
    valid_until: datetime.date | None
    tolerance: float
    channels: Mapping[str, ChannelCalibration] = field(default_factory=dict)
    checks: tuple[DailyCheck, ...] = ()

    def channel(self, name: str) -> ChannelCalibration:
        """Return the calibration of a channel; the factor is 1 where the record has none."""
        return self.channels.get(name, ChannelCalibration(1.0, 0.0, np.inf))

    def description(self) -> Message:
        """Return certificate, date and factors."""
        factors = [
            Message(
                "{channel} x {factor:.4f} (u {u:.2g} %)",
                channel=name,
                factor=c.factor,
                u=100 * c.uncertainty,
            )
            for name, c in self.channels.items()
        ]
        return Message(
            "{tester}, {certificate} of {date}: {factors}",
            tester=self.name,
            certificate=self.certificate,
            date=self.date,
            factors=factors,
        )

    def flags(self, noted: object) -> tuple[Flag, ...]:
        """Return what the record says against a reading of the day ``noted`` with it.

        A check of the day outside the tolerance is named ``FAILED``: the reading is not to be used.
        """
        if noted in (None, ""):
            text = Message("no date is noted: calibration and daily check can't be referred to")
            return (Flag("calibration", text),)
        day = day_of(noted, where='condition "date"')
        if not self.date <= day <= (self.valid_until or day):
            end = Message(" to {day}", day=self.valid_until) if self.valid_until else ""
            return (
                Flag(
                    "calibration",
                    Message(
                        "tested {day}, the calibration holds {start}{end}",
                        day=day,
                        start=self.date,
                        end=end,
                    ),
                ),
            )
        that_day = [check for check in self.checks if check.date == day]
        failed = [check for check in that_day if abs(check.error) > check.allowed]
        if failed:
            worst = max(failed, key=lambda check: abs(check.error))
            text = Message(
                "the check of {day} failed: {checks:; }",
                day=day,
                checks=(check.description for check in failed),
            )
            return (Flag(FAILED, text, True, worst.error, worst.allowed, "1"),)
        missing = {check.channel for check in self.checks} - {c.channel for c in that_day}
        if missing:
            return (
                Flag(
                    "calibration",
                    Message("no check of {channels} on {day}", channels=sorted(missing), day=day),
                ),
            )
        return ()


def read_calibration(path: Path) -> TesterCalibration:
    """Return the calibration record in a TOML file.

    ``[tester]``: name, certificate, date, valid_until, tolerance of the daily check ("2 %" by
    default, assumed). ``[channels.NAME]`` (normal, friction, pressure): reference and
    reading as lists of equal length, a mass or a force each ("20 kg", "196 N"), their relative
    standard ``uncertainty``, ``range``, ``noise``. ``[[checks]]``: date, channel, reference,
    reading. Readings are what the log shows: they are multiplied by the factor found.

    InputError: not TOML, an unknown key or channel, a wrong date, points that are no calibration.
    """
    where = path.name
    data = read_toml(path)
    _check_keys(data, ("tester", "channels", "checks"), where)
    tester, named = data.get("tester", {}), data.get("channels", {})
    _check_keys(tester, _KEYS["tester"], f"{where}, tester")
    _check_keys(named, CHANNELS, f"{where}, channels")
    end = tester.get("valid_until")
    record = TesterCalibration(
        str(tester.get("name", "tester")),
        Message("certificate {number}", number=tester["certificate"])
        if "certificate" in tester
        else "calibration",
        day_of(tester.get("date", ""), where=f"{where}, date"),
        None if end is None else day_of(end, where=f"{where}, valid_until"),
        to_si(tester.get("tolerance", "2 %"), "1", where=f"{where}, tolerance"),
        {n: _channel(part, CHANNELS[n], f"{where}, channels.{n}") for n, part in named.items()},
    )
    parts = enumerate(data.get("checks", []), start=1)
    return replace(
        record, checks=tuple(_check(part, record, f"{where}, check {i}") for i, part in parts)
    )


def day_of(given: object, *, where: str) -> datetime.date:
    """Return a date as ``written_day`` reads it; anything else is an `InputError`."""
    if isinstance(given, datetime.date):
        return given.date() if isinstance(given, datetime.datetime) else given
    day = written_day(str(given))
    if day is None:
        allowed = "as 2026-03-05 or 05.03.2026"
        raise InputError(Message('"{given}" is no date', given=given), where=where, allowed=allowed)
    return day


_YEAR_FIRST = re.compile(r"(?P<year>\d{4})([-/.])(?P<month>\d{1,2})\2(?P<day>\d{1,2})")
_DAY_FIRST = re.compile(r"(?P<day>\d{1,2})\. ?(?P<month>\d{1,2})\. ?(?P<year>\d{4}|\d\d)")
_CLOCK = re.compile(r"[ T]+\d{1,2}:\d\d(:\d\d([.,]\d+)?)?$")


def written_day(text: str) -> datetime.date | None:
    """Return the day of a text: 2026-03-05, 2026/3/5, 5.3.2026, 05.03.26, a time after it or not.

    None where it is no day, and where month and day could be exchanged (03/05/2026).
    """
    plain = _CLOCK.sub("", text.strip())
    match = _YEAR_FIRST.fullmatch(plain) or _DAY_FIRST.fullmatch(plain)
    if match is None:
        return None
    year, month, day = (int(match[part]) for part in ("year", "month", "day"))
    try:
        return datetime.date(year + 2000 if year < 100 else year, month, day)
    except ValueError:
        return None


def _check_keys(part: Any, allowed: Collection[str], where: str) -> None:
    if not isinstance(part, Mapping):
        raise InputError(Message("{part} is not a table", part=repr(part)), where=where)
    for key in part:
        if key not in allowed:
            near = nearest_match(str(key), allowed)
            raise InputError(
                Message('unknown key "{key}"', key=key),
                where=where,
                allowed=", ".join(allowed),
                nearest=near,
            )


def _channel(part: Any, unit: str, where: str) -> ChannelCalibration:
    _check_keys(part, _KEYS["channel"], where)
    points = [part.get(key, []) for key in ("reference", "reading")]
    if not all(isinstance(p, list) for p in points) or len(points[0]) != len(points[1]):
        raise InputError("reference and reading are lists of equal length", where=where)
    reference, reading = (np.array([_size(p, unit, where) for p in side]) for side in points)
    if len(reference) < 2 or not np.ptp(reading) > 0 or not np.ptp(reference) > 0:
        raise InputError("two different points at least are a calibration", where=where)
    if "uncertainty" not in part:
        allowed = 'relative, standard: uncertainty = "0.2 %"'
        raise InputError("the references have no uncertainty", where=where, allowed=allowed)
    stated = to_si(part["uncertainty"], "1", where=f"{where}.uncertainty")
    # Reference = factor (reading - zero): the zero is taken off in every log.
    x, y = reading - reading.mean(), reference - reference.mean()
    factor = float(x @ y / (x @ x))
    left = y - factor * x
    free = max(len(x) - 2, 1)
    scatter = float(np.sqrt(left @ left / free / (x @ x))) / abs(factor)
    if not factor > 0 or float(np.abs(left).max()) > 0.05 * float(reference.max()):
        raise InputError("the points do not lie on a rising line within 5 %", where=where)
    full, noise = (
        to_si(part[key], unit, where=f"{where}.{key}") if key in part else None
        for key in ("range", "noise")
    )
    return ChannelCalibration(
        factor, float(np.hypot(stated, scatter)), float(reference.max()), full, noise
    )


def _size(given: object, unit: str, where: str) -> float:
    """Return a force or pressure; a mass counts with its weight."""
    if unit == "N" and isinstance(given, str) and re.search(r"[\d ](k?g)$", given.strip()):
        return to_si(given, "kg", where=where) * _GRAVITY
    return to_si(given, unit, where=where)


def _check(part: Any, record: TesterCalibration, where: str) -> DailyCheck:
    _check_keys(part, _KEYS["check"], where)
    name = str(part.get("channel", ""))
    _check_keys({name: 0}, (*CHANNELS, "crosstalk"), where)
    aside = name == "crosstalk"
    unit = CHANNELS.get(name, "N")
    weight, reading = (_size(part.get(key), unit, where) for key in ("reference", "reading"))
    if not weight > 0:
        raise InputError("a check needs a mass or force above 0", where=where)
    share = reading * record.channel("friction" if aside else name).factor / weight
    error, allowed = (share, _CROSSTALK) if aside else (share - 1.0, record.tolerance)
    words = Message(
        "{name} {reading} for {reference} ({error:+.1f} %)",
        name=name,
        reading=part["reading"],
        reference=part["reference"],
        error=100 * error,
    )
    day = day_of(part.get("date", ""), where=f"{where}, date")
    return DailyCheck(day, name, error, allowed, words)
