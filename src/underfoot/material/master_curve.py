"""Time-temperature superposition: one master curve from tests at many temperatures."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from underfoot.core import DataError, InputError, RangeError

from ._kernels.shift import best_shift
from .curves import DynamicSweep, RelaxationCurve
from .shift_laws import ArrheniusShift, WlfShift, fit_arrhenius, fit_wlf
from .spectrum_fit import SpectrumFit, fit_dynamic, fit_relaxation

Test = TypeVar("Test", DynamicSweep, RelaxationCurve)


@dataclass(frozen=True, slots=True, eq=False)
class ShiftTable:
    """Shift factors found between neighbouring temperatures, at the reference temperature.

    ``log10_errors`` are standard errors of the step from the next temperature towards the
    reference, added up from there; ``mismatch`` the rms difference (relative) of each pair of
    neighbours after shifting, (n - 1,).
    """

    temperatures: np.ndarray
    log10_shift_factors: np.ndarray
    log10_errors: np.ndarray
    mismatch: np.ndarray
    reference_temperature: float

    @property
    def wlf(self) -> WlfShift:
        """The WLF law through the shift factors."""
        return fit_wlf(self.temperatures, self.log10_shift_factors, self.reference_temperature)

    @property
    def arrhenius(self) -> ArrheniusShift:
        """The Arrhenius law through the shift factors."""
        return fit_arrhenius(
            self.temperatures, self.log10_shift_factors, self.reference_temperature
        )

    @property
    def law(self) -> WlfShift | ArrheniusShift:
        """Whichever of the two leaves the smaller residual."""
        if self.temperatures.size < 3:
            return self.arrhenius
        return min((self.wlf, self.arrhenius), key=lambda law: law.rms)


@dataclass(frozen=True, slots=True, eq=False)
class DynamicMasterCurve:
    """E' and E'' (Pa) against reduced angular frequency (rad/s), ascending, with the shifts."""

    angular_frequency: np.ndarray
    storage_modulus: np.ndarray
    loss_modulus: np.ndarray
    temperature: np.ndarray
    shifts: ShiftTable

    def spectrum(self, **settings: Any) -> SpectrumFit:
        """Return ``fit_dynamic`` of the master curve."""
        name = f"DMA master curve at {self.shifts.reference_temperature:.2f} K"
        return fit_dynamic(
            self.angular_frequency,
            self.storage_modulus,
            self.loss_modulus,
            **{"source": name, **settings},
        )


@dataclass(frozen=True, slots=True, eq=False)
class RelaxationMasterCurve:
    """E(t) (Pa) against reduced time (s), ascending, with the shifts."""

    time: np.ndarray
    modulus: np.ndarray
    temperature: np.ndarray
    shifts: ShiftTable

    def spectrum(self, **settings: Any) -> SpectrumFit:
        """Return ``fit_relaxation`` of the master curve."""
        name = f"relaxation master curve at {self.shifts.reference_temperature:.2f} K"
        return fit_relaxation(
            self.time,
            self.modulus,
            **{"source": name, **settings},
        )


def dynamic_master_curve(
    sweeps: Sequence[DynamicSweep],
    reference_temperature: float | None = None,
    *,
    shift_by: str = "storage",
) -> DynamicMasterCurve:
    """Return the master curve of frequency sweeps at two or more temperatures.

    Each sweep is shifted along log frequency onto its colder neighbour so that both follow one
    common cubic best; the steps add up. There is no vertical shift.

    Parameters:
        sweeps: In any order.
        reference_temperature: K, within the temperatures tested (by default the middle one);
            between two of them the shift is interpolated.
        shift_by: "storage": E' decides, E'' then shows whether superposition holds; "both": each
            counts by its own scatter. Where the two disagree (resonance of the instrument, a
            material that is not thermorheologically simple), E' is the safer one.

    Raises:
        InputError: Another ``shift_by``.
        DataError: Fewer than two temperatures, a temperature missing or given twice, neighbours
            whose moduli do not overlap.
        RangeError: Reference temperature outside those tested.
    """
    if shift_by not in ("storage", "both"):
        raise InputError(f'"{shift_by}"', where="shift_by", allowed='"storage" or "both"')
    ordered, temperatures = _by_temperature(sweeps)
    x = [np.log10(s.angular_frequency) for s in ordered]
    used = slice(0, 1 if shift_by == "storage" else 2)
    y = [np.log10(np.array([s.storage_modulus, s.loss_modulus])[used]) for s in ordered]
    shifts = _shift_table(x, y, temperatures, reference_temperature)
    w = np.concatenate(
        [10.0 ** (a + s) for a, s in zip(x, shifts.log10_shift_factors, strict=True)]
    )
    order = np.argsort(w, kind="stable")
    return DynamicMasterCurve(
        w[order],
        np.concatenate([s.storage_modulus for s in ordered])[order],
        np.concatenate([s.loss_modulus for s in ordered])[order],
        np.repeat(temperatures, [a.size for a in x])[order],
        shifts,
    )


def relaxation_master_curve(
    curves: Sequence[RelaxationCurve], reference_temperature: float | None = None
) -> RelaxationMasterCurve:
    """Return the master curve of relaxation tests at two or more temperatures.

    As ``dynamic_master_curve``, with log E(t) against log time. Readings that fall on the same
    reduced time are averaged.
    """
    ordered, temperatures = _by_temperature(curves)
    x = [-np.log10(c.time) for c in ordered]
    y = [np.log10(c.modulus)[None, :] for c in ordered]
    shifts = _shift_table(x, y, temperatures, reference_temperature)
    time = np.concatenate(
        [10.0 ** (-a - s) for a, s in zip(x, shifts.log10_shift_factors, strict=True)]
    )
    reduced, place = np.unique(time, return_inverse=True)
    count = np.bincount(place)
    modulus = np.bincount(place, np.concatenate([c.modulus for c in ordered])) / count
    kelvin = np.bincount(place, np.repeat(temperatures, [a.size for a in x])) / count
    return RelaxationMasterCurve(reduced, modulus, kelvin, shifts)


def _by_temperature(
    tests: Sequence[Test],
) -> tuple[list[Test], np.ndarray]:
    if len(tests) < 2:
        raise DataError(
            f"{len(tests)} temperature(s)", where="master curve", allowed="two temperatures or more"
        )
    known = [(test.temperature, i) for i, test in enumerate(tests) if test.temperature is not None]
    if len(known) < len(tests):
        raise DataError(
            f"{len(tests) - len(known)} of {len(tests)} tests have no temperature",
            where="master curve",
            allowed="a temperature in K for each test",
        )
    known.sort()
    temperatures = np.array([t for t, _ in known])
    if np.any(np.diff(temperatures) <= 0.0):
        twice = temperatures[int(np.flatnonzero(np.diff(temperatures) <= 0.0)[0])]
        raise DataError(
            f"two tests at {twice:g} K", where="master curve", remedy="Average or drop one of them"
        )
    return [tests[i] for _, i in known], temperatures


def _shift_table(
    x: Sequence[np.ndarray],
    y: Sequence[np.ndarray],
    temperatures: np.ndarray,
    reference: float | None,
) -> ShiftTable:
    if reference is None:
        reference = float(temperatures[temperatures.size // 2])
    if not temperatures[0] <= reference <= temperatures[-1]:
        raise RangeError(
            f"reference temperature {reference:g} K",
            where="reference_temperature",
            allowed=f"{temperatures[0]:g} K to {temperatures[-1]:g} K, the temperatures tested",
            remedy="Make the master curve inside, then move the spectrum with the fitted law",
        )
    steps, errors, mismatch = [], [], []
    for i in range(len(x) - 1):
        _check_overlap(y[i], y[i + 1], temperatures[i], temperatures[i + 1])
        step, error, rms = best_shift(x[i], y[i], x[i + 1], y[i + 1])
        gap = max(x[i].min(), x[i + 1].min() + step) - min(x[i].max(), x[i + 1].max() + step)
        if gap > 0.0:
            raise _no_overlap(temperatures[i], temperatures[i + 1])
        steps.append(step)
        errors.append(error)
        mismatch.append(rms * np.log(10.0))
    log_shift = np.concatenate([[0.0], np.cumsum(steps)])
    log_shift -= np.interp(reference, temperatures, log_shift)
    nearest = int(np.argmin(np.abs(temperatures - reference)))
    variance = np.concatenate([[0.0], np.cumsum(np.square(errors))])
    return ShiftTable(
        temperatures,
        log_shift,
        np.sqrt(np.abs(variance - variance[nearest])),
        np.array(mismatch),
        float(reference),
    )


def _check_overlap(colder: np.ndarray, hotter: np.ndarray, t_cold: float, t_hot: float) -> None:
    # A modulus that rises with frequency overlaps in frequency only where it overlaps in size.
    if hotter[0].max() < colder[0].min():
        raise _no_overlap(t_cold, t_hot)


def _no_overlap(t_cold: float, t_hot: float) -> DataError:
    return DataError(
        f"the moduli at {t_cold:.2f} K and {t_hot:.2f} K do not overlap",
        where="master curve",
        remedy="Test a temperature between them, or widen the frequencies",
    )
