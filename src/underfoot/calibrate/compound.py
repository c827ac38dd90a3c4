"""From tests of a rubber to the compound of a case: moduli, spectrum, shift factors, loss tangent.

Files are told by what they hold: a sweep (frequency, storage and loss modulus), a relaxation
modulus over time, a Prony series, or the recording of a compression test (time, displacement,
force). A spectrum is that of sweeps, else of relaxation; a hardness stands beside it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from underfoot.core import DataError, InputError, SourcedValue, display
from underfoot.core.presentation import Part, Presentable, Table
from underfoot.core.remark import Amount, Message, Remark
from underfoot.material import (
    DynamicMasterCurve,
    DynamicSweep,
    ModulusBand,
    RelaxationCurve,
    RelaxationMasterCurve,
    RelaxationSpectrum,
    ShiftTable,
    SpectrumFit,
    dynamic_master_curve,
    fit_dynamic,
    fit_relaxation,
    relaxation_master_curve,
    young_from_shear,
)
from underfoot.material.durometer_scales import DurometerReading
from underfoot.material.read import read_rubber
from underfoot.trials import Trial
from underfoot.trials.machines.compression import Compression, compression
from underfoot.trials.machines.relaxation_test import relaxation_reading
from underfoot.trials.readers import read_trial

LOAD_TIME = 0.1
"""s: a heel loads its rubber for about this long; the modulus of a case is that after it."""
RISES = 0.05
"""A relaxation modulus that rises by more than this over an earlier value is none (assumed)."""
ROOM, APART = 296.15, 2.0
"""K: temperature of use where none is given, and what it may be off that of the tests unsaid."""
SLIDING_WAVES = (0.8e-3, 2.5e-6)
"""Longest and shortest wave (m) of a floor that works the rubber at sliding speed."""
SLIDING_SPEED = 0.3
READINGS = 200
SLOWEST_SHOWN = -2
"""Decade of the lowest frequency (Hz) of a spectrum of which nobody says where it was tested."""
STEP_TIMES = (1e-9, 1e6)
"""s: a case keeps the terms between these; faster ones are never stretched, slower ones rest."""
MOST_TERMS = 32
"""Terms that are printed; the file and the data hold all."""


@dataclass(frozen=True, slots=True)
class Compound(Presentable):
    """A compound from its tests.

    ``fit`` is the spectrum of Young's modulus at ``temperature`` (K, None where no file names one),
    ``prony`` one that was given. ``sweeps`` and ``curves`` are the readings behind it, ``shifts``
    their superposition.
    """

    kind: ClassVar[str] = "compound"

    name: str
    spectrum: RelaxationSpectrum | None
    fit: SpectrumFit | None
    sweep: DynamicSweep | DynamicMasterCurve | None
    relaxation: RelaxationCurve | RelaxationMasterCurve | None
    shifts: ShiftTable | None
    compressions: tuple[Compression, ...]
    hardness: DurometerReading | None
    temperature: float | None
    poisson_ratio: float
    polymer: str | None
    notes: tuple[str, ...]
    warnings: tuple[Message, ...]

    def __repr__(self) -> str:
        return f"<Compound {self.name:.60}: {self.spectrum!r:.100}>"

    @property
    def tested(self) -> tuple[float, float] | None:
        """Angular frequencies that were measured, rad/s."""
        return None if self.fit is None else self.fit.frequency_range

    @property
    def _time(self) -> float:
        """Time of load (s) of the modulus."""
        if not self.tested:
            return LOAD_TIME
        return min(max(LOAD_TIME, 1 / self.tested[1]), 1 / self.tested[0])

    def modulus(self) -> SourcedValue:
        """Return Young's modulus after ``LOAD_TIME``, or at the nearest time that was tested."""
        if self.spectrum is None:
            return SourcedValue(None, "Pa", reason="no test gives one; a case takes the hardness")
        value = float(self.spectrum.relaxation_modulus(self._time))
        deviation = 0.0 if self.fit is None else self.fit.rms_residual
        if self.compressions and self.sweep is None:
            deviation = math.hypot(deviation, self.compressions[0].deviation)
        source = f"{self.name}: after {display(self._time, 's')} of load"
        return SourcedValue(value, "Pa", source=source, uncertainty=deviation * value or None)

    def headline(self) -> tuple[Message, ...]:
        """Return modulus, loss tangent and the frequencies tested."""
        if self.spectrum is None:
            assert self.hardness is not None
            shore_a = self.hardness.shore_a
            return (
                Message(
                    "Shore A {shore_a:.0f}: a hardness gives no loss tangent.", shore_a=shore_a
                ),
            )
        values = {
            "modulus": _value_text(self.modulus()),
            "time": Amount(self._time, "s"),
            "count": len(self.spectrum),
        }
        if (fit := self.fit) is None:
            return (
                Message(
                    "Young's modulus {modulus} after {time} of load; {count} terms as given.",
                    **values,
                ),
            )
        return (
            Message(
                "Young's modulus {modulus} after {time} of load; spectrum of {count} terms, "
                "tested from {rates: to }, fit {quality} (rms {rms:.1%}).",
                **values, rates=[display(w / (2 * math.pi), "Hz") for w in fit.frequency_range],
                quality=fit.quality, rms=fit.rms_residual,
            ),
        )  # fmt: skip

    def cautions(self) -> tuple[Message, ...]:
        """Return what the tests leave open for a case."""
        return self.warnings

    def table(self) -> Table:
        """Return the moduli with where they come from."""
        rows = [("Young's modulus", _value_text(self.modulus()), self.modulus().source)]
        if self.spectrum is not None:
            rows += [
                (Part("at once"), display(self.spectrum.instantaneous_modulus, "Pa"), "spectrum"),
                (Part("at rest"), display(self.spectrum.equilibrium_modulus, "Pa"), "spectrum"),
            ]
        for test in self.compressions:
            printed = test.moduli
            rows += [
                ("K_0 (Eq. 13)", display(printed.short_time_stiffness, "N/m"), test.name),
                ("E_0 (Eq. 14)", display(printed.short_time_modulus, "Pa"), "apparent, bonded"),
                ("K_inf (Eq. 15)", display(printed.long_time_stiffness, "N/m"), test.name),
                ("E_inf (Eq. 16)", display(printed.long_time_modulus, "Pa"), "apparent, bonded"),
                (Part("over Young's modulus"),
                 f"{test.factor:.3g} ± {test.factor * test.deviation:.2g}",
                 f"1 + 2 k S^2, shape factor S = {test.shape_factor:.3g}"),
            ]  # fmt: skip
        if self.hardness is not None:
            rows.append(("Shore A", f"{self.hardness.shore_a:.0f}", self.hardness.note() or "read"))
        return Table("Compound", ("Quantity", "Value", "Remark"), rows)

    def tables(self) -> tuple[Table, ...]:
        """Return moduli, loss tangent by frequency, Prony terms and shift factors."""
        tables = [self.table()]
        if self.spectrum is not None:
            tables.append(self._losses())
            tables += [self._terms()] if len(self.spectrum) <= MOST_TERMS else []
        if self.shifts is not None:
            tables.append(self._shifts())
        return tuple(tables)

    def _losses(self) -> Table:
        """Return storage modulus and loss tangent at whole decades, with the 95 % band of a fit."""
        assert self.spectrum is not None
        slow, fast = (math.log10(SLIDING_SPEED / wave) for wave in SLIDING_WAVES)
        low, high = SLOWEST_SHOWN, fast
        if self.tested:
            low, high = (math.log10(w / (2 * math.pi)) for w in self.tested)
        hertz = 10.0 ** np.arange(math.floor(min(low, slow)), math.ceil(max(high, fast)) + 1)
        hertz = hertz[:: max(1, hertz.size // 12)]
        frequency = 2 * math.pi * hertz
        band = None if self.fit is None else self.fit.band(frequency)
        rows = [self._loss(n, w, band) for n, w in enumerate(frequency.tolist())]
        heads = ("Frequency", "Storage modulus", "Loss tangent", "Remark")
        return Table("Loss tangent", heads, rows)

    def _loss(self, n: int, w: float, band: ModulusBand | None) -> tuple[str, ...]:
        assert self.spectrum is not None
        storage, tangent = self.spectrum.storage_modulus(w), self.spectrum.loss_tangent(w)
        shown, remark = f"{float(tangent):.3f}", ""
        if band is not None:
            low, high = (float(loss[n] / storage) for loss in (band.loss_low, band.loss_high))
            ends = Message("{low:.3f} to {high:.3f}", low=low, high=high)
            shown = Message("{tangent} ({ends})", tangent=shown, ends=ends)
            remark = "not tested" if band.extrapolated[n] else ""
        return display(w / (2 * math.pi), "Hz"), display(float(storage), "Pa"), shown, remark

    def _terms(self) -> Table:
        assert self.spectrum is not None
        moduli, times = self.spectrum.term_moduli, self.spectrum.relaxation_times
        kept = moduli > 1e-6 * self.spectrum.instantaneous_modulus
        rows = [
            (display(time, "s"), display(modulus, "Pa"))
            for time, modulus in zip(times[kept].tolist(), moduli[kept].tolist(), strict=True)
        ]
        return Table("Prony terms of Young's modulus", ("Relaxation time", "Modulus"), rows)

    def _shifts(self) -> Table:
        assert self.shifts is not None
        table = self.shifts
        errors = zip(table.log10_shift_factors, table.log10_errors, strict=True)
        rows = [
            (_celsius(kelvin), f"{shift:.2f} ± {error:.2f}")
            for kelvin, (shift, error) in zip(table.temperatures.tolist(), errors, strict=True)
        ]
        at = _celsius(table.reference_temperature)
        title = Message("Shift factors to {at} ({law})", at=at, law=table.law)
        return Table(title, ("Temperature", "log10 of the shift factor"), rows)

    def data_tables(self) -> dict[str, Table]:
        """Return terms, readings and shift factors in SI."""
        tables = {}
        if self.spectrum is not None:
            terms = self.spectrum.relaxation_times, self.spectrum.term_moduli
            tables["prony"] = Table("", ("time s", "modulus Pa"), np.column_stack(terms).tolist())
        if self.sweep is not None:
            parts = (self.sweep.angular_frequency, self.sweep.storage_modulus)
            rows = np.column_stack([*parts, self.sweep.loss_modulus]).tolist()
            heads = ("angular frequency rad/s", "storage modulus Pa", "loss modulus Pa")
            tables["sweep"] = Table("", heads, rows)
        if self.relaxation is not None:
            rows = np.column_stack([self.relaxation.time, self.relaxation.modulus]).tolist()
            tables["relaxation"] = Table("", ("time s", "modulus Pa"), rows)
        if self.shifts is not None:
            parts = self.shifts.temperatures, self.shifts.log10_shift_factors
            rows = np.column_stack([*parts, self.shifts.log10_errors]).tolist()
            heads = ("temperature K", "log10 shift factor", "standard error")
            tables["shift_factors"] = Table("", heads, rows)
        return tables

    def remarks(self) -> dict[str, Sequence[str]]:
        """Return what was done to the readings."""
        return {"Notes": self.notes}

    def to_dict(self) -> dict[str, Any]:
        """Return the compound as a case takes it, in SI, with its tests."""
        content: dict[str, Any] = {"kind": self.kind, "name": self.name}
        content["modulus_Pa"] = self.modulus().value
        if self.spectrum is not None:
            content["equilibrium_modulus_Pa"] = self.spectrum.equilibrium_modulus
            content["term_moduli_Pa"] = self.spectrum.term_moduli.tolist()
            content["relaxation_times_s"] = self.spectrum.relaxation_times.tolist()
        if self.fit is not None:
            content["tested_rad_per_s"] = list(self.fit.frequency_range)
            content["rms_residual"] = self.fit.rms_residual
        for name in ("short_time", "long_time"):
            for part, unit in (("stiffness", "N_per_m"), ("modulus", "Pa")):
                values = [getattr(test.moduli, f"{name}_{part}") for test in self.compressions]
                if values:
                    content[f"{name}_{part}_{unit}"] = values
        return content | {"notes": list(self.notes), "cautions": list(self.warnings)}

    def toml(self) -> str:
        """Return the file that ``shoe.material.file`` of a case takes."""
        lines = [f"# {self.name}: written by underfoot material", ""]
        if self.polymer:
            lines.append(f'polymer = "{self.polymer}"')
        if self.hardness is not None:
            shore, scale = self.hardness.shore_a, self.hardness.scale
            spread = f', uncertainty = "{scale.spread:g}"' if scale.spread else ""
            source = self.hardness.note() or "durometer"
            lines.append(f'shore_a = {{value = {shore:.1f}{spread}, source = "{source}"}}')
        modulus = self.modulus()
        if modulus.value is not None:
            spread = "" if modulus.uncertainty is None else (
                f', uncertainty = "{modulus.uncertainty / 1e6:.4g} MPa"'
            )  # fmt: skip
            lines.append(
                f'modulus = {{value = "{modulus.value / 1e6:.6g} MPa"{spread}, '
                f'source = "{modulus.source}"}}'
            )
        given = "" if self.spectrum is None else ', source = "as for the spectrum"'
        lines.append(f"poisson_ratio = {{value = {self.poisson_ratio:g}, assumed = true{given}}}")
        if self.tested:
            shortest, longest = STEP_TIMES
            for key, w in zip(("slowest_tested", "fastest_tested"), self.tested, strict=True):
                rate = min(max(w, 1 / longest), 1 / shortest)
                lines.append(f'{key} = "{rate:.6g} rad/s"')
        if self.spectrum is not None:
            lines += ["", "[relaxation]", *self._relaxation_lines()]
        return "\n".join([*lines, ""])

    def _relaxation_lines(self) -> list[str]:
        assert self.spectrum is not None
        shear = 1 / (2 * (1 + self.poisson_ratio))
        level = self.spectrum.instantaneous_modulus
        moduli, times = self.spectrum.term_moduli, self.spectrum.relaxation_times
        slow = times > STEP_TIMES[1]  # at rest to a step
        rest = self.spectrum.equilibrium_modulus + float(moduli[slow].sum())
        least = max(rest, 1e-9 * level) * shear
        moving = ~slow & (times >= STEP_TIMES[0])
        terms = zip(moduli[moving], times[moving], strict=True)
        return [
            f'equilibrium_shear_modulus = "{least / 1e6:.8g} MPa"',
            "terms = [",
            *(
                f'  {{shear_modulus = "{modulus * shear / 1e6:.8g} MPa", time = "{time:.8g} s"}},'
                for modulus, time in terms
                if modulus > 1e-9 * level
            ),
            "]",
        ]


def compound_from_files(
    files: Sequence[Path],
    *,
    hardness: DurometerReading | None = None,
    temperature: float | None = None,
    thickness: float | None = None,
    area: float | None = None,
    shear: bool | None = None,
    poisson_ratio: float = 0.49,
    polymer: str | None = None,
    modulus_unit: str | None = None,
    instantaneous_modulus: float | None = None,
    equilibrium_modulus: float | None = None,
) -> Compound:
    """Return the compound of tests on one rubber.

    Parameters:
        files: Sweeps, relaxation moduli, a Prony series, recordings of compression tests.
        hardness: A durometer's reading.
        temperature: Of use, K; None takes 23 C where tests at several temperatures hold it, else
            the middle one. Moduli of another temperature than that of use (23 C) get a warning, and
            those of an unnamed one where that of use is another than 23 C (else a note).
        thickness, area: Of one block of a compression test (m, m^2).
        shear: Whether moduli are those of shear; None takes what the headings say (G', G_stor).
        modulus_unit: Of moduli, where a file has none.
        instantaneous_modulus, equilibrium_modulus: Pa, of the kind of the series: one of them fixes
            the level of a Prony series that has none.

    Raises:
        InputError: Nothing given; a compression test without thickness and area.
        DataError: A file that is none of these, a relaxation that rises, sweeps that do not
            overlap.
    """
    if not files and hardness is None:
        raise InputError(
            "neither a test nor a hardness is given",
            where="underfoot material",
            allowed='FILES of tests, or --shore "68 A"',
        )
    sweeps, curves, compressions, notes = [], [], [], []
    prony: RelaxationSpectrum | None = None
    given = {
        "modulus_unit": modulus_unit,
        "instantaneous_modulus": instantaneous_modulus,
        "equilibrium_modulus": equilibrium_modulus,
    }
    for file in files:
        found, taken = _read(file, thickness, area, poisson_ratio, shear, given)
        notes += taken
        if isinstance(found, RelaxationSpectrum):
            prony = found
        elif isinstance(found, Compression):
            compressions.append(found)
            notes += [Remark.of(file.name, note) for note in found.reading.notes]
        elif isinstance(found[0], DynamicSweep):
            sweeps += found
        else:
            curves += found
    for curve in (*curves, *(relaxation_of(test) for test in compressions)):
        _refuse_rising(curve)
    warnings: list[Message] = []
    sweep, shifts, at, fit = None, None, None, None
    if sweeps:
        sweep, shifts, at = _sweep_spectrum(sweeps, temperature, warnings)
        moduli = sweep.angular_frequency, sweep.storage_modulus, sweep.loss_modulus
        fit = fit_dynamic(*moduli, source="dynamic sweeps of " + _names(files))
    relaxation, relaxed = None, None
    readings = curves or [relaxation_of(test) for test in compressions]
    if readings:
        relaxation, table, own_at = _relaxation_curve(readings, temperature)
        relaxed = fit_relaxation(
            relaxation.time, relaxation.modulus, source="relaxation of " + _names(files)
        )
        if fit is None:
            fit, shifts, at = relaxed, table, own_at
        else:
            notes.append(_beside(fit, relaxed))
    spectrum = prony if fit is None else fit.spectrum
    if fit is not None and prony is not None:
        notes.append(Message("the Prony series is left out: tests go before it"))
    if fit is not None:
        warnings += _fit_warnings(fit)
    elif spectrum is not None:
        warnings += spectrum.cautions()
    used = ROOM if temperature is None else temperature
    if at is None:
        at = temperature
        if spectrum is not None:
            told = Message(
                "no test names its temperature: that of use is assumed, {used}", used=_celsius(used)
            )
            (warnings if abs(used - ROOM) > APART else notes).append(told)
    elif abs(at - used) > APART:
        tested = {"at": _celsius(at), "used": _celsius(used)}
        warnings.append(Message("Tested at {at}, used at {used}: not shifted.", **tested))
    return Compound(
        name=_names(files) or (f"Shore A {hardness.shore_a:.0f}" if hardness else ""),
        spectrum=spectrum,
        fit=fit,
        sweep=sweep,
        relaxation=relaxation,
        shifts=shifts,
        compressions=tuple(compressions),
        hardness=hardness,
        temperature=at,
        poisson_ratio=poisson_ratio,
        polymer=polymer,
        notes=tuple(notes),
        warnings=tuple(warnings),
    )


def relaxation_of(test: Compression) -> RelaxationCurve:
    """Return Young's modulus over the time since the peak, at even steps of its logarithm."""
    time, force = test.reading.hold
    low = float(test.reading.force_2_percent)
    peak = test.reading.peak_force.value or 1.0
    modulus = test.moduli.short_time_modulus * (force - low) / (peak - low) / test.factor
    inside = np.unique(np.geomspace(1, time.size - 1, READINGS).astype(int))
    edges = [inside[0], *((inside[1:] + inside[:-1] + 1) // 2), inside[-1] + 1]
    means = np.add.reduceat(modulus[: edges[-1]], edges[:-1]) / np.diff(edges)
    return RelaxationCurve(time[inside], means, source=test.name)


def _read(
    file: Path,
    thickness: float | None,
    area: float | None,
    poisson_ratio: float,
    shear: bool | None,
    given: Mapping[str, Any],
) -> tuple[
    list[DynamicSweep] | list[RelaxationCurve] | RelaxationSpectrum | Compression, list[Remark]
]:
    """Return what a file holds, moduli as Young's, and what was taken of it."""
    factor = 2 * (1 + poisson_ratio)
    reason = ""
    try:
        test = read_rubber(file, **given)
    except DataError as error:
        if _read_recording(file) is None:
            raise
        test, reason = None, error.what
    if test is not None:
        of_shear = bool(test.shear) if shear is None else shear
        notes = [Remark.of(file.name, note) for note in test.notes]
        if test.shear is None and shear is None:
            notes.append(
                Remark(
                    file.name,
                    "nothing says whether its moduli are of shear or of tension: taken as Young's; "
                    "of shear they are {factor:.3g} times as much (--shear)",
                    factor=factor,
                )
            )
        if test.series is not None:
            series = test.series
            return young_from_shear(series, poisson_ratio) if of_shear else series, notes
        found: list[Any] = [*(test.sweeps or test.curves)]
        if of_shear:
            names = ("storage_modulus", "loss_modulus", "modulus")
            found = [
                replace(one, **{n: factor * getattr(one, n) for n in names if hasattr(one, n)})
                for one in found
            ]
        return found, notes
    trial = _read_recording(file)
    if trial is None:
        what = Message("{file} is no test of a rubber", file=file.name)
        if reason:
            what = Message("{what} ({reason})", what=what, reason=reason)
        raise DataError(
            what,
            where=str(file),
            allowed="columns f, E', E'' (or G', G''; tan delta; phase angle); t, E; tau, E_i; or "
            "time, displacement, force",
            remedy="Name the columns with their units, as f (Hz)",
        )
    if thickness is None or area is None:
        raise InputError(
            Message(
                "{name} is a compression test: moduli need the size of a block", name=file.name
            ),
            where="--thickness and --area",
            remedy='Give them, as --thickness "5.5 mm" --area "1.6 cm^2"',
        )
    read = compression(relaxation_reading(trial, thickness), thickness, area, file.name)
    return read, []


def _read_recording(file: Path) -> Trial | None:
    """Return the recording of a compression test in a file; None where there is no force."""
    try:
        trial = read_trial(file)
        trial.channel("force", "load", "normal force", "fz", "axial force")
    except (DataError, InputError):
        return None
    return trial


def _refuse_rising(curve: RelaxationCurve) -> None:
    lowest = np.minimum.accumulate(curve.modulus)
    rise = curve.modulus / lowest - 1
    at = int(np.argmax(rise))
    if rise[at] > RISES:
        start = int(np.argmin(curve.modulus[: at + 1]))
        raise DataError(
            Message(
                "the modulus rises from {modulus} at {time} to {later_modulus} at {later}: "
                "a relaxation falls",
                modulus=display(curve.modulus[start], "Pa"),
                time=display(curve.time[start], "s"),
                later_modulus=display(curve.modulus[at], "Pa"),
                later=display(curve.time[at], "s"),
            ),
            where=curve.source or "relaxation",
            allowed=Message("rises of at most {rises:.0%} (scatter)", rises=RISES),
            remedy="Cut off what is not the hold (loading, drift of temperature, cure), or check "
            "which column is time",
        )


def _sweep_spectrum(
    sweeps: list[DynamicSweep], temperature: float | None, warnings: list[Message]
) -> tuple[DynamicSweep | DynamicMasterCurve, ShiftTable | None, float | None]:
    if len(sweeps) == 1:
        only = sweeps[0]
        warnings.append(
            Message(
                "One temperature was tested: no shift factors, and nothing is known beyond its "
                "frequencies. Sweeps at 0 °C and below reach the rates of sliding."
            )
        )
        return only, None, only.temperature
    at = _reference([sweep.temperature for sweep in sweeps], temperature)
    master = dynamic_master_curve(sweeps, at)
    return master, master.shifts, master.shifts.reference_temperature


def _relaxation_curve(
    curves: list[RelaxationCurve], temperature: float | None
) -> tuple[RelaxationCurve | RelaxationMasterCurve, ShiftTable | None, float | None]:
    if len({curve.temperature for curve in curves}) == 1:
        if len(curves) == 1:
            return curves[0], None, curves[0].temperature
        low = max(curve.time[0] for curve in curves)
        high = min(curve.time[-1] for curve in curves)
        time = np.geomspace(low, high, READINGS)
        means = np.mean(
            [
                np.interp(time, relaxation_curve.time, relaxation_curve.modulus)
                for relaxation_curve in curves
            ],
            axis=0,
        )
        name = Message("mean of {count} tests", count=len(curves))
        mean = RelaxationCurve(time, means, curves[0].temperature, name)
        return mean, None, mean.temperature
    at = _reference([curve.temperature for curve in curves], temperature)
    master = relaxation_master_curve(curves, at)
    return master, master.shifts, master.shifts.reference_temperature


def _reference(tested: Sequence[float | None], temperature: float | None) -> float | None:
    known = [kelvin for kelvin in tested if kelvin is not None]
    if temperature is None and known and min(known) <= ROOM <= max(known):
        return ROOM
    return temperature


def _fit_warnings(fit: SpectrumFit) -> list[Message]:
    warnings: list[Message] = []
    off = {"rms": fit.rms_residual, "largest": fit.largest_residual}
    if fit.quality == "rough":
        warnings.append(
            Message(
                "The spectrum follows the readings roughly (rms {rms:.0%}, largest "
                "{largest:.0%}): superposition may not hold for this compound.",
                **off,
            )
        )
    elif fit.quality != "good":
        warnings.append(
            Message(
                "The spectrum does not follow the readings (rms {rms:.0%}, largest "
                "{largest:.0%}): do not use its loss. Test fewer temperatures, or check which side "
                "of the glass transition they lie on.",
                **off,
            )
        )
    slow, fast = (2 * math.pi * SLIDING_SPEED / wave for wave in SLIDING_WAVES)
    if fit.frequency_range[1] < fast * (1 - 1e-9):
        rates = [Amount(w / (2 * math.pi), "Hz") for w in (fit.frequency_range[1], slow, fast)]
        warnings.append(
            Message(
                "Tested up to {tested}; asperities at {speed} work the rubber at {slow} to {fast}. "
                "Its loss there is extrapolated: sweep at lower temperatures and take the master "
                "curve.",
                tested=rates[0], speed=Amount(SLIDING_SPEED, "m/s"), slow=rates[1], fast=rates[2],
            )
        )  # fmt: skip
    return warnings


def _beside(fit: SpectrumFit, relaxed: SpectrumFit) -> Message:
    low = max(1 / fit.frequency_range[1], 1 / relaxed.frequency_range[1])
    high = min(1 / fit.frequency_range[0], 1 / relaxed.frequency_range[0])
    if low >= high:
        return Message("sweep and relaxation test share no time: the spectrum is that of the sweep")
    time = math.sqrt(low * high)
    ratio = float(relaxed.spectrum.relaxation_modulus(time) / fit.spectrum.relaxation_modulus(time))
    return Message(
        "the relaxation test gives {ratio:.2f} times the modulus of the sweep at {time}; the "
        "spectrum is that of the sweep",
        ratio=ratio, time=Amount(time, "s"),
    )  # fmt: skip


def _celsius(kelvin: float) -> str:
    return f"{kelvin - 273.15:.0f} °C"


def _names(files: Sequence[Path]) -> str:
    return ", ".join(file.name for file in files)


def _value_text(value: SourcedValue) -> str:
    if value.value is None:
        return Message("not estimated: {reason}", reason=value.reason)
    spread = "" if value.uncertainty is None else f" ± {display(value.uncertainty, 'Pa')}"
    return display(value.value, "Pa") + spread
