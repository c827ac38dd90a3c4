"""Made-up logs of slip testers, as different as laboratories are, and what can be wrong with one.

``python tests/trial_testers.py 9000 9012`` scores all faults on these seeds and sound logs beside
them: noticed (refused or a caution), right within max(0.005, 3 %) and unmarked, or silently wrong.

A log is a table: time, two or three forces, a speed or a marker or neither. The controller's
swing, the coloured scatter of sliding, the peak at the start, preload while the shoe is lowered,
drift within what is let pass, converters and rates differ from log to log.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from scipy.signal import lfilter

from underfoot.core import UnderfootError
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import analyse_folder

Columns = dict[str, np.ndarray]
DATE = "2026-03-12"


@dataclass(frozen=True)
class Log:
    """Columns under their headings, the true COF in the window, and what the folder says beside."""

    columns: Columns
    cof: float
    noise: float  # of the unloaded forces on record (N)
    friction: str  # heading of the channel that carries the friction
    normal: str
    protocol: str = "en_iso_13287"
    conditions: str = f"file,shoe,date\n{{name}},A,{DATE}\n"
    checks: tuple[float, float] = (1.0, 1.0)  # gain of normal and friction on the day of the check
    friction_range: float = 1000.0  # N, on record
    crosstalk: float = 0.002  # friction over normal force on the day of the check
    seed: int = 0


def coloured(rng: np.random.Generator, count: int, rate: float, corner: float) -> np.ndarray:
    """Return noise of unit variance with a corner frequency (Hz)."""
    keep = float(np.exp(-2 * np.pi * corner / rate))
    white = rng.normal(size=count)
    after, _ = lfilter([np.sqrt(1 - keep**2)], [1.0, -keep], white[1:], zi=[keep * white[0]])
    return np.append(white[0], after)


def sound_log(seed: int, *, preload: bool = True) -> Log:
    """Return one sound log; seeds give other shoes, machines, rates, noises and lengths."""
    rng = np.random.default_rng([27, seed])
    rate = float(rng.choice([500.0, 1000.0, 2000.0]))
    before, after = float(rng.uniform(0.25, 0.6)), float(rng.uniform(0.2, 0.6))
    rest, slide = float(rng.uniform(0.1, 0.3)), 0.75
    rise, speed = float(rng.uniform(0.03, 0.12)), 0.3
    start = before + rise + rest
    end = start + slide
    count = int((end + 0.25 + after) * rate)
    time = np.arange(count) / rate
    load, cof = float(rng.uniform(492, 508)), float(np.exp(rng.uniform(np.log(0.03), np.log(0.7))))
    up = 0.5 - 0.5 * np.cos(np.pi * np.clip((time - before) / rise, 0, 1))
    down = 0.5 + 0.5 * np.cos(np.pi * np.clip((time - end - 0.1) / 0.08, 0, 1))
    normal = load * up * down
    normal = normal * (1 + rng.uniform(0.002, 0.012) * coloured(rng, count, rate, 6.0))
    moving = np.clip((time - start) / 0.02, 0, 1) * np.clip((end - time) / 0.02, 0, 1)
    fade = 1 + rng.uniform(-0.08, 0.10) * np.exp(-np.clip(time - start, 0, None) / 0.25)
    peak = 1 + rng.uniform(0, 0.5) * np.exp(-np.clip(time - start, 0, None) / 0.015)
    scatter = 1 + rng.uniform(0.008, 0.03) * coloured(rng, count, rate, float(rng.uniform(15, 60)))
    ratio = cof * fade * peak * scatter
    pushed = rng.uniform(-0.3, 0.4) * cof * (normal / load) ** rng.uniform(1.3, 2.0)
    pushed = pushed if preload else 0.0 * pushed
    bump = 1 + 0.15 * np.sin(2 * np.pi * 11 * time + rng.uniform(0, 6))
    left = rng.uniform(0.1, 0.6) * cof * (time > end)  # the shoe stays bent after the slide
    friction = normal * (moving * ratio + (1 - moving) * np.where(time > end, left, pushed * bump))
    inside = (time >= start + 0.3) & (time <= start + 0.6)
    true = float(np.mean(friction[inside] / normal[inside]))
    noise = float(rng.uniform(0.2, 1.2))
    creep = float(rng.uniform(-0.8, 0.8)) * (time / time[-1] - 0.5)

    def measured(values: np.ndarray, offset: float) -> np.ndarray:
        white = noise * rng.normal(size=count)
        slow = 0.15 * noise * coloured(rng, count, rate, 1.0)
        return values + white + slow + offset + creep

    step = float(rng.choice([0.0, 0.0, 0.05, 0.5, 2.0]))
    step = 0.0 if cof < 0.1 and step > 0.5 else step
    columns: Columns = {"time (s)": time}
    sign = float(rng.choice([-1.0, 1.0]))
    if rng.random() < 0.5:
        turn = float(rng.choice([0.0, np.pi / 2, 0.1]))
        parts = {"Fx (N)": np.cos(turn), "Fy (N)": np.sin(turn)}
        for name, share in parts.items():
            columns[name] = measured(sign * share * friction, float(rng.uniform(-8, 8)))
        columns["Fz (N)"] = measured(normal, float(rng.uniform(-8, 8)))
        along, upward = max(parts, key=lambda name: abs(parts[name])), "Fz (N)"
    else:
        along, upward = "friction force (N)", "normal force (N)"
        columns[along] = measured(sign * friction, float(rng.uniform(-8, 8)))
        columns[upward] = measured(normal, float(rng.uniform(-8, 8)))
    if step:
        for name in list(columns)[1:]:
            columns[name] = step * np.round(columns[name] / step)
    how = rng.choice(["speed", "marker", "neither"])
    travel = np.cumsum(speed * moving) / rate
    if how == "speed":
        columns["speed (m/s)"] = speed * moving + 0.002 * rng.normal(size=count)
    elif how == "marker":
        for axis, place in zip("xyz", (travel, 0 * travel, 0 * travel + 0.03), strict=True):
            columns[f"heel_{axis} (mm)"] = 1e3 * place + 0.1 * rng.normal(size=count)
    # As on record: seen through the same converter, on another day.
    idle = columns[along][: round(0.2 * rate)]
    seen = float(np.std(np.diff(idle)) / np.sqrt(2.0) * rng.uniform(0.8, 1.25))
    return Log(columns, true, seen, along, upward, seed=seed)


PROFILE = """
[axes]
vertical = "+z"
[plates.tester]
friction = "friction force"
normal = "normal force"
"""
RECORD = """
[tester]
name = "STM, number 7"
certificate = "K-117"
date = 2026-01-15
valid_until = 2027-01-15
[channels.normal]
reference = ["0 N", "100 N", "300 N", "600 N"]
reading = ["0.1 N", "100.2 N", "299.8 N", "600.3 N"]
uncertainty = "0.2 %"
range = "1000 N"
noise = "{noise} N"
[channels.friction]
reference = ["0 N", "100 N", "300 N", "600 N"]
reading = ["0.0 N", "99.9 N", "300.2 N", "599.8 N"]
uncertainty = "0.2 %"
range = "{range} N"
noise = "{noise} N"
"""
CHECK = """
[[checks]]
date = {date}
channel = "{channel}"
reference = "20 kg"
reading = "{reading:.4f} N"
"""


def write_log(log: Log, folder: Path, *, record: bool = True, name: str = "log.csv") -> None:
    """Write a log as a laboratory's folder: CSV, profile, conditions, calibration record."""
    folder.mkdir(parents=True, exist_ok=True)
    head = ",".join(log.columns)
    data = np.column_stack(list(log.columns.values()))
    np.savetxt(folder / name, data, delimiter=",", header=head, comments="", fmt="%.7g")
    (folder / "conditions.csv").write_text(log.conditions.format(name=name))
    if "normal force (N)" in log.columns:
        (folder / "profile.toml").write_text(PROFILE)
    if record:
        text = RECORD.format(noise=round(log.noise, 3), range=log.friction_range)
        for channel, gain in zip(("normal", "friction"), log.checks, strict=True):
            text += CHECK.format(date=DATE, channel=channel, reading=gain * 20 * 9.80665)
        reading = log.crosstalk * 20 * 9.80665
        text += CHECK.format(date=DATE, channel="crosstalk", reading=reading)
        (folder / "calibration.toml").write_text(text)


def _with(log: Log, **more: Any) -> Log:
    return replace(log, **more)


def _changed(log: Log, **columns: np.ndarray) -> Log:
    names = {"friction": log.friction, "normal": log.normal}
    new = {names.get(name, name): values for name, values in columns.items()}
    return replace(log, columns={**log.columns, **new})


def _forces(log: Log, change: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Log:
    """Return the log with ``change(time, values)`` of every force."""
    time = log.columns["time (s)"]
    return replace(
        log,
        columns={
            name: change(time, values) if name.endswith("(N)") else values
            for name, values in log.columns.items()
        },
    )


def _friction(log: Log, change: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Log:
    """Return the log with ``change(time, values)`` of all horizontal forces."""
    time = log.columns["time (s)"]
    return replace(
        log,
        columns={
            name: change(time, values) if name.endswith("(N)") and name != log.normal else values
            for name, values in log.columns.items()
        },
    )


def _normal(log: Log, change: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Log:
    return _changed(log, normal=change(log.columns["time (s)"], log.columns[log.normal]))


def _rows(log: Log, pick: Callable[[np.ndarray], np.ndarray]) -> Log:
    """Return the log with rows chosen by ``pick(time)``, the clock going on evenly."""
    rows = pick(log.columns["time (s)"])
    columns = {name: values[rows] for name, values in log.columns.items()}
    step = log.columns["time (s)"][1]
    return replace(log, columns={**columns, "time (s)": step * np.arange(len(rows))})


def _middle(log: Log) -> float:
    """Time in the middle of the slide's window."""
    time, normal = log.columns["time (s)"], log.columns[log.normal]
    return float(np.median(time[normal > 0.8 * normal.max()])) + 0.05


def _clip(share: float, names: str) -> Callable[[Log], Log]:
    def clip(log: Log) -> Log:
        def cut(_: np.ndarray, values: np.ndarray) -> np.ndarray:
            rest = float(np.median(values[:80]))
            level = share * (500.0 if names == "normal" else 500.0 * log.cof)
            return np.clip(values, rest - level, rest + level)

        return _normal(log, cut) if names == "normal" else _friction(log, cut)

    return clip


def _amplifier_at_its_range(log: Log) -> Log:
    rng = np.random.default_rng(3)
    cut = _clip(0.6, "friction")(log)
    noisy = _forces(cut, lambda t, v: v + rng.normal(0, log.noise, len(v)))
    return replace(noisy, friction_range=0.6 * 500.0 * log.cof)


def _held(length: float) -> Callable[[Log], Log]:
    def hold(log: Log) -> Log:
        at = _middle(log)

        def change(time: np.ndarray, values: np.ndarray) -> np.ndarray:
            part = (time > at) & (time < at + length)
            return np.where(part, values[np.argmax(part)], values)

        return _forces(log, change)

    return hold


def _gap_filled_straight(log: Log) -> Log:
    at = _middle(log)

    def change(time: np.ndarray, values: np.ndarray) -> np.ndarray:
        part = (time > at - 0.06) & (time < at + 0.06)
        return np.interp(time, time[~part], values[~part])

    return _forces(log, change)


def _drop_out(log: Log) -> Log:
    at = _middle(log)
    return _friction(log, lambda t, v: np.where((t > at) & (t < at + 0.03), v[:50].mean(), v))


def _spikes(log: Log) -> Log:
    def change(time: np.ndarray, values: np.ndarray) -> np.ndarray:
        out = values.copy()
        out[:: max(1, len(out) // 60)] += 400.0
        return out

    return _friction(log, change)


def _low_rate(log: Log) -> Log:
    time = log.columns["time (s)"]
    few = np.arange(0, len(time), round(0.025 / time[1]))
    return _forces(log, lambda t, v: np.interp(t, t[few], v[few]))


def _twice(log: Log) -> Log:
    """A second slide on a wetter floor behind the first."""
    second = _friction(log, lambda t, v: v[:50].mean() + 0.5 * (v - v[:50].mean()))
    step = log.columns["time (s)"][1]
    columns = {k: np.concatenate((v, second.columns[k])) for k, v in log.columns.items()}
    columns["time (s)"] = step * np.arange(len(columns["time (s)"]))
    return replace(log, columns=columns)


def _way_back(log: Log) -> Log:
    """The tester slides back under load, the second half of the slide pushing the other way."""
    at = _middle(log) - 0.05
    rest = float(np.median(log.columns[log.friction][:80]))
    return _friction(log, lambda t, v: np.where(t > at, 2 * rest - v, v))


def _stops(log: Log) -> Log:
    """The drive stalls in the window; where a speed is logged it shows it."""
    at = _middle(log)
    stalled = _friction(
        log, lambda t, v: np.where(t > at, v[:50].mean() + 0.4 * (v - v[:50].mean()), v)
    )
    columns = dict(stalled.columns)
    if "speed (m/s)" in columns:
        columns["speed (m/s)"] = np.where(columns["time (s)"] > at, 0.0, columns["speed (m/s)"])
    return replace(stalled, columns=columns)


def _jump(log: Log) -> Log:
    at = _middle(log) - 0.3
    return _friction(log, lambda t, v: v + 8.0 * (t > at))


def _named(old: str, new: str) -> Callable[[Log], Log]:
    """The heading says another unit than the numbers have."""

    def rename(log: Log) -> Log:
        columns = {name.replace(old, new): values for name, values in log.columns.items()}
        return replace(log, columns=columns)

    return rename


def _gain(normal: float, friction: float, *, checked: bool = False) -> Callable[[Log], Log]:
    def change(log: Log) -> Log:
        both = _normal(_friction(log, lambda t, v: friction * v), lambda t, v: normal * v)
        return replace(both, checks=(normal, friction) if checked else (1.0, 1.0))

    return change


def _crosstalk(share: float, *, preload: bool) -> Callable[[Log], Log]:
    def change(log: Log) -> Log:
        log = log if preload else sound_log(log.seed, preload=False)
        sign = np.sign(log.columns[log.friction][log.columns[log.normal] > 300].mean())
        normal = log.columns[log.normal] - np.median(log.columns[log.normal][:80])
        crossed = _changed(log, friction=log.columns[log.friction] + share * sign * normal)
        return replace(crossed, crosstalk=share) if preload else crossed

    return change


def _lost_rows(log: Log) -> Log:
    """The slide's window is missing, the clock goes on as if nothing was."""
    at = _middle(log)
    return _rows(log, lambda t: np.flatnonzero((t < at - 0.25) | (t > at + 0.1)))


def _end_cut(log: Log) -> Log:
    at = _middle(log)
    return _rows(log, lambda t: np.flatnonzero(t < at - 0.2))


FAULTS: dict[str, Callable[[Log], Log]] = {
    "friction dead": lambda log: _friction(
        log, lambda t, v: 0 * v + v[:200].std() * np.random.default_rng(1).normal(size=len(v))
    ),
    "friction constant": lambda log: _friction(log, lambda t, v: 0 * v + 1.7),
    "friction clipped at 60 %": _clip(0.6, "friction"),
    "friction clipped at 90 %": _clip(0.9, "friction"),
    "normal clipped at 97 %": _clip(0.97, "normal"),
    "amplifier at its range, noise behind it": _amplifier_at_its_range,
    "friction in kgf called N": _gain(1.0, 1 / 9.80665),
    "friction in lbf called N": _gain(1.0, 1 / 4.4482),
    "both in kgf called N": _gain(1 / 9.80665, 1 / 9.80665),
    "normal in daN called N": _gain(0.1, 1.0),
    "N called kN": _named("(N)", "(kN)"),
    "friction N called mN": lambda log: _friction(log, lambda t, v: 1e3 * v),
    "gain of friction 1.3, check of the day": _gain(1.0, 1.3, checked=True),
    "gain of friction 0.8, check of the day": _gain(1.0, 0.8, checked=True),
    "gain of normal 1.04, check of the day": _gain(1.04, 1.0, checked=True),
    "crosstalk of 3 %, no preload": _crosstalk(0.03, preload=False),
    "crosstalk of -4 %, no preload": _crosstalk(-0.04, preload=False),
    "crosstalk of 3 %, preload, check of the day": _crosstalk(0.03, preload=True),
    "drift of 15 N": lambda log: _friction(log, lambda t, v: v + 15.0 * t / t[-1]),
    "drift of -25 N of the normal force": lambda log: _normal(
        log, lambda t, v: v - 25.0 * t / t[-1]
    ),
    "zero jumps by 8 N in the slide": _jump,
    "held for 60 ms": _held(0.06),
    "held for the whole window": _held(0.4),
    "gap filled straight": _gap_filled_straight,
    "40 Hz drawn out to full rate": _low_rate,
    "friction drops out for 30 ms": _drop_out,
    "spikes": _spikes,
    "coarse converter of friction": lambda log: _friction(
        log, lambda t, v: 60.0 * np.round(v / 60.0)
    ),
    "two slides in the file": _twice,
    "back under load": _way_back,
    "drive stalls in the window": _stops,
    "window lost without a trace": _lost_rows,
    "log cut in the slide": _end_cut,
    "time in ms called s": lambda log: _with(
        log, columns={**log.columns, "time (s)": 1e3 * log.columns["time (s)"]}
    ),
    "channels exchanged": lambda log: _changed(
        log, friction=log.columns[log.normal], normal=log.columns[log.friction]
    ),
    "sign of the normal force turned": lambda log: _normal(log, lambda t, v: -v),
    "no unloaded record": lambda log: _rows(
        log, lambda t: np.flatnonzero(log.columns[log.normal] > 450.0)
    ),
    "calibration out of date": lambda log: _with(
        log, conditions="file,shoe,date\n{name},A,2027-03-01\n"
    ),
    "tested before the calibration": lambda log: _with(
        log, conditions="file,shoe,date\n{name},A,2025-12-01\n"
    ),
    "no check on the day": lambda log: _with(
        log, conditions="file,shoe,date\n{name},A,2026-03-20\n"
    ),
    "a walk": lambda log: _a_walk(log),
}


def _a_walk(log: Log) -> Log:
    """A walking step under the tester's headings."""
    time = np.arange(1500) / 1000.0
    phase = np.clip((time - 0.4) / 0.65, 0, 1)
    on = (phase > 0) & (phase < 1)
    rng = np.random.default_rng(8)
    normal = on * 700 * (np.sin(np.pi * phase) ** 0.5) * (1 - 0.25 * np.sin(np.pi * phase) ** 6)
    shear = on * -130.0 * np.sin(2 * np.pi * phase)
    return Log(
        {"time (s)": time, "Fx (N)": shear + rng.normal(0, 0.6, 1500),
         "Fy (N)": 0.1 * shear + rng.normal(0, 0.6, 1500),
         "Fz (N)": normal + rng.normal(0, 0.8, 1500)},
        0.19, log.noise, "Fx (N)", "Fz (N)", conditions=log.conditions,
    )  # fmt: skip


def _rest(values: np.ndarray) -> float:
    return float(np.median(values[:80]))


def _shown(change: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Callable[[Log], Log]:
    """``change(time, friction over its unloaded level)`` of the horizontal forces."""
    return lambda log: _friction(log, lambda t, v: _rest(v) + change(t, v - _rest(v)))


def _lagged(values: np.ndarray, time: np.ndarray, seconds: float) -> np.ndarray:
    """A first-order filter of that time constant, one way."""
    from scipy.signal import lfilter

    keep = float(np.exp(-time[1] / seconds))
    return np.asarray(lfilter([1.0 - keep], [1.0, -keep], values))


def _moved(values: np.ndarray, time: np.ndarray, seconds: float) -> np.ndarray:
    return np.roll(values, round(seconds / time[1]))


def _mean_of(values: np.ndarray, time: np.ndarray, seconds: float) -> np.ndarray:
    count = round(seconds / time[1])
    return np.convolve(values, np.ones(count) / count, "same")


def _backlash(values: np.ndarray, width: float) -> np.ndarray:
    out, state = values.copy(), 0.0
    for i, value in enumerate(values):
        state = min(max(state, value - width), value + width)
        out[i] = state
    return out


def _stairs(seconds: float) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    def change(time: np.ndarray, values: np.ndarray) -> np.ndarray:
        step = max(1, round(seconds / time[1]))
        return values[np.arange(len(values)) // step * step]

    return change


def _no_number(log: Log) -> Log:
    at = _middle(log)
    return _friction(log, lambda t, v: np.where(np.abs(t - at) < 0.06, np.nan, v))


def _slide_ends(log: Log) -> Log:
    at = _middle(log)
    return _friction(log, lambda t, v: np.where(t > at, _rest(v), v))


def _lifts(log: Log) -> Log:
    """The load goes in the window, the friction channel still shows what it was."""
    at = _middle(log)
    return _normal(log, lambda t, v: np.where(t > at, _rest(v) + 0.7 * (v - _rest(v)), v))


def _setpoint(log: Log) -> Log:
    return _normal(log, lambda t, v: np.where(v > 0.5 * v.max(), 450.0, _rest(v)))


def _computed(log: Log) -> Log:
    normal = log.columns[log.normal]
    return _friction(log, lambda t, v: _rest(v) + 1.2 * log.cof * (normal - _rest(normal)))


def _uneven(log: Log) -> Log:
    time = log.columns["time (s)"]
    at = _middle(log) - 0.3
    return _with(log, columns={**log.columns, "time (s)": time + 0.25 * (time > at)})


def _block_back(log: Log) -> Log:
    """A block of rows written twice: the window holds the start of the slide again."""
    at = _middle(log)

    def pick(time: np.ndarray) -> np.ndarray:
        first = np.flatnonzero(time < at)
        return np.concatenate((first, np.flatnonzero((time > at - 0.45) & (time < at)),
                               np.flatnonzero(time >= at)))  # fmt: skip

    return _rows(log, pick)


def _reversed(log: Log) -> Log:
    return _rows(log, lambda t: np.arange(len(t))[::-1])


def _rings(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    on = np.abs(values) > 0.5 * np.abs(values).max()
    return values + on * 0.6 * np.abs(values).max() * np.sin(2 * np.pi * 1.5 * time)


FAULTS |= {
    "friction compressed at its top, check of the day": lambda log: replace(
        _shown(lambda t, v: (top := 0.6 * np.abs(v).max()) * np.tanh(v / top))(log),
        checks=(1.0, 0.6),
    ),
    "friction behind a slow filter": _shown(lambda t, v: _lagged(v, t, 0.4)),
    "friction late by 0.25 s": _shown(lambda t, v: _moved(v, t, 0.25)),
    "friction early by 0.2 s": _shown(lambda t, v: _moved(v, t, -0.2)),
    "friction as a mean of a second": _shown(lambda t, v: _mean_of(v, t, 1.0)),
    "normal force as a mean of a second": lambda log: _normal(
        log, lambda t, v: _mean_of(v, t, 1.0)
    ),
    "stairs of 0.25 s of friction": _shown(_stairs(0.25)),
    "stairs of 50 ms of all": lambda log: _forces(log, _stairs(0.05)),
    "backlash of 15 N": _shown(lambda t, v: _backlash(v, 15.0)),
    "dead band of 12 N": _shown(lambda t, v: np.sign(v) * np.maximum(np.abs(v) - 12.0, 0)),
    "friction without its sign": _shown(lambda t, v: np.abs(v) + 8.0),
    "a bit of 32 N stuck": _shown(lambda t, v: (np.round(v).astype(int) | 32).astype(float)),
    "friction wraps at half its size": _shown(
        lambda t, v: (v + (top := 0.5 * np.abs(v).max())) % (2 * top) - top
    ),
    "friction without numbers in the window": _no_number,
    "friction in gf called N": _gain(1.0, 101.97),
    "normal force in lbf called N": _gain(1 / 4.4482, 1.0),
    "both in lbf called N": _gain(1 / 4.4482, 1 / 4.4482),
    "friction in V called N": _gain(1.0, 0.01),
    "the column of COF as friction": lambda log: _friction(log, lambda t, v: v / 500.0),
    "the column of per cent as friction": lambda log: _friction(log, lambda t, v: v / 5.0 / 9.0),
    "the set value as normal force": _setpoint,
    "friction computed from the normal force": _computed,
    "slide ends in the window": _slide_ends,
    "load goes in the window": _lifts,
    "clock jumps before the window": _uneven,
    "a block of rows twice": _block_back,
    "rows in reverse": _reversed,
    "friction swings by 60 %": _shown(_rings),
    "zero creeps back after the load": _shown(lambda t, v: v - 0.3 * _lagged(v, t, 0.5)),
    "amplifier coupled over a capacitor": _shown(lambda t, v: v - _lagged(v, t, 0.35)),
    "cell tilted by 4 deg": lambda log: _crosstalk(0.07, preload=False)(log),
}


NEVER_RIGHT = ("calibration out of date", "tested before the calibration", "no check on the day")
"""Faults that leave the number as it is, and have to be told all the same."""
NOTICED, RIGHT, SILENT = "noticed", "right", "silently wrong"


def outcome(
    log: Log, true: float, folder: Path, *, always: bool = False, record: bool = True
) -> str:
    """Return whether the analysis of a log notices it, is right, or is silently wrong."""
    write_log(log, folder, record=record)
    try:
        (one,) = analyse_folder(folder, protocol(log.protocol), processes=1).files
    except UnderfootError:
        return NOTICED
    if one.verdict != "accepted":
        return NOTICED
    right = abs(one.main["cof"] - true) <= max(0.005, 0.03 * true)
    return RIGHT if right and not always else SILENT


def faulty_outcome(name: str, seed: int, folder: Path) -> str:
    """Return the outcome of one fault in one log."""
    sound = sound_log(seed)
    return outcome(FAULTS[name](sound), sound.cof, folder, always=name in NEVER_RIGHT)


def _score(first: int, last: int) -> None:
    total: Counter[str] = Counter()
    for name in FAULTS:
        with TemporaryDirectory() as place:
            found = Counter(
                faulty_outcome(name, seed, Path(place, str(seed))) for seed in range(first, last)
            )
        total += found
        print(f"{name:50}", *(f"{key} {n}" for key, n in sorted(found.items())))
    print(f"{len(FAULTS)} faults:", *(f"{key} {n}" for key, n in sorted(total.items())))
    seeds = range(first, first + 20 * (last - first))
    with TemporaryDirectory() as place:
        logs = [sound_log(seed) for seed in seeds]
        sound = Counter(outcome(log, log.cof, Path(place, str(log.seed))) for log in logs)
    print(f"{len(seeds)} sound logs:", *(f"{key} {n}" for key, n in sorted(sound.items())))


if __name__ == "__main__":
    _score(int(sys.argv[1]), int(sys.argv[2]))
