"""Compression relaxation test: loading, hold and unloading found, forces of Eq. 13-16 read."""

from dataclasses import dataclass

import numpy as np

from underfoot.core import DataError, InputError
from underfoot.core.remark import NOTHING, Message

from ..recording.measurement import Flag, Measurement, caution
from ..recording.trial import Trial

FORCE = ("force", "load", "normal force", "fz", "axial force")
DISPLACEMENT = ("displacement", "compression", "position", "crosshead", "axial displacement", "z")


@dataclass(frozen=True, slots=True)
class RelaxationReading:
    """What a ramp and hold says, compression positive.

    ``force_2_percent``, ``peak_force``, ``final_force``: F_0.02, F_0 and F_inf (N) of Eq. 13 and
    15. ``time``, ``displacement``, ``force``: loading and hold, without unloading (s, m, N), shape
    (n,); time from the first load. ``hold_start``: index at which the displacement reaches its
    level (the peak, if that comes first). ``peak_displacement``: compression held (m).
    ``ramp_time`` and ``hold_time``: durations (s). ``thickness``: of what is compressed between the
    plates (m). ``notes``: what was found odd.
    """

    force_2_percent: Measurement
    peak_force: Measurement
    final_force: Measurement
    time: np.ndarray
    displacement: np.ndarray
    force: np.ndarray
    hold_start: int
    peak_displacement: float
    ramp_time: float
    hold_time: float
    thickness: float
    notes: tuple[str, ...]

    @property
    def hold(self) -> tuple[np.ndarray, np.ndarray]:
        """Time since the peak (s) and force (N) during the hold."""
        held = slice(self.hold_start, None)
        return self.time[held] - self.time[self.hold_start], self.force[held]


def relaxation_reading(
    trial: Trial, thickness: float, *, force: str | None = None, displacement: str | None = None
) -> RelaxationReading:
    """Return the loading and the hold of a compression relaxation test.

    Signs are turned so that compression is positive; the force before contact is subtracted;
    displacement counts from the first load above 1 % of the peak. The hold ends where the
    displacement leaves its level by 2 % of the compression. F_0.02 is interpolated on the ramp,
    F_0 is the largest force, F_inf the mean over the last tenth of the hold.

    ``thickness``: of one block, T in Eq. 13-16 (m): F_0.02 is the force at a displacement of 0.02
    T. ``force`` and ``displacement``: channel names; by default usual names are tried.

    DataError: channels missing or broken, no load, no hold of ten samples, ramp not recorded.
    InputError: a thickness that is not positive.
    """
    where = trial.name
    if not thickness > 0:
        raise InputError(
            Message("thickness {thickness}", thickness=thickness),
            where="thickness",
            allowed="above 0",
        )
    load = trial.channel(*((force,) if force else FORCE))
    travel = trial.channel(*((displacement,) if displacement else DISPLACEMENT))
    if load.unit not in ("N", "") or travel.unit not in ("m", ""):
        text = Message(
            'force is in "{unit}", displacement in "{travel_unit}"',
            unit=load.unit,
            travel_unit=travel.unit,
        )
        raise DataError(text, where=where, allowed="N and m")
    f, d, t = load.values.astype(float), travel.values.astype(float), load.time
    if len(f) != len(d) or len(f) < 20:
        raise DataError("force and displacement must have the same 20 samples or more", where=where)
    finite = np.isfinite(f) & np.isfinite(d)
    notes: list[Message] = []
    if lost := int((~finite).sum()):
        notes.append(Message("{count} samples without a number left out", count=lost))
    f, d, t = f[finite], d[finite], t[finite]
    if len(f) < 20:
        raise DataError("fewer than 20 samples with numbers", where=where)
    first = max(3, len(f) // 200)
    rest = float(np.median(f[:first]))
    if rest - f.min() > f.max() - rest:
        f = -f
        notes.append(Message("force turned: compression positive"))
    peak_guess = int(np.argmax(f))
    zero = float(np.median(f[:first]))
    if f[peak_guess] - zero < 10 * float(np.std(f[:first])) or f[peak_guess] <= zero:
        raise DataError("the force does not rise above its start", where=where)
    f = f - zero
    if abs(zero) > 0.002 * f[peak_guess]:
        notes.append(Message("force of {zero:.3g} N before contact subtracted", zero=zero))
    peak = int(np.argmax(f))
    touching = np.flatnonzero(f[: peak + 1] < 0.01 * f[peak])
    begin = int(touching[-1]) if len(touching) else 0
    if peak - begin < 3:
        raise DataError(
            "the loading is not recorded: fewer than three samples before the peak",
            where=where,
            remedy="Sample faster or give the recording from before contact",
        )
    d = d - d[begin]
    if d[peak] < 0:
        d = -d
    level = float(np.median(d[peak : peak + max(5, (len(d) - peak) // 4)]))
    away = np.flatnonzero(np.abs(d[peak:] - level) > 0.02 * abs(level))
    # The peak may come a moment before the crosshead stands still, and noise may put it after.
    away = away[away > 5]
    arrived = begin + int(np.argmax(d[begin : peak + 1] >= 0.995 * level))
    hold = arrived if d[arrived] >= 0.995 * level else peak
    end = peak + (int(away[0]) if len(away) else len(d) - peak)
    if end < len(d):
        notes.append(
            Message("unloading cut off {early:.3g} s after the peak", early=t[end] - t[peak])
        )
    if end - peak < 10:
        raise DataError(
            Message("only {end} samples of hold", end=end - peak),
            where=where,
            allowed="ten or more",
        )
    ramp_d, ramp_f = np.maximum.accumulate(d[begin : peak + 1]), f[begin : peak + 1]
    at = 0.02 * thickness
    if ramp_d[-1] <= at:
        text = Message(
            "compressed by {ramp_d:.3g} mm only, 2 % of the thickness is",
            ramp_d=1000.0 * ramp_d[-1],
        )
        raise DataError(f"{text} {1e3 * at:.3g} mm", where=where)
    keep = np.concatenate(([True], np.diff(ramp_d) > 0))
    low_force = float(np.interp(at, ramp_d[keep], ramp_f[keep]))
    tail = f[end - max(3, (end - peak) // 10) : end]
    final = float(tail.mean())
    noise = _noise(f[peak:end])
    still = float(np.polyfit(np.linspace(0, 1, len(tail)), tail, 1)[0])
    fall = float(f[peak] - final)
    flags: tuple[Flag, ...] = ()
    if fall > 0 and abs(still) > max(0.02 * fall, 3 * noise / np.sqrt(len(tail))):
        flags = (
            caution(
                "still falling by {share:.0f} % of the relaxation in the last tenth of the hold",
                share=100 * abs(still) / fall,
            ),
        )
    choices = {
        "sign": Message("compression positive"),
        "zero": Message("force before contact subtracted"),
    }
    meant = {**choices, "final force": Message("mean over the last tenth of the hold")}
    settled = noise / float(np.sqrt(len(tail)))
    return RelaxationReading(
        Measurement("force at 2 %", low_force, "N", noise, conventions=choices),
        Measurement("peak force", float(f[peak]), "N", noise, conventions=choices),
        Measurement("final force", final, "N", settled, NOTHING, len(tail), flags, meant),
        *(t[begin:end] - t[begin], d[begin:end], f[begin:end]),
        *(hold - begin, level, float(t[hold] - t[begin]), float(t[end - 1] - t[hold])),
        *(thickness, tuple(notes)),
    )


def _noise(force: np.ndarray) -> float:
    """Standard deviation of the noise, from second differences (they don't see the decay)."""
    second = np.diff(force, 2)
    return float(1.4826 * np.median(np.abs(second)) / np.sqrt(6.0)) if len(second) else 0.0
