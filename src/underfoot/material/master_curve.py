"""Time-temperature superposition: one master curve, and the laws of its shift factors."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError, RangeError
from underfoot.core.arrays import scalar_or_array
from underfoot.core.remark import Message

from .curves import DynamicSweep, RelaxationCurve, minimum_on
from .spectrum_fit import SpectrumFit, fit_dynamic, fit_relaxation

DEGREE = 3
LEAST_SCATTER = 4e-4
"""0.1 % in log10: no reading is trusted further."""
FLAT = 5 * LEAST_SCATTER
"""Change of a storage modulus over two sweeps below which it says nothing of their shift."""


def common_polynomial_cost(
    shift: float, x: np.ndarray, y: np.ndarray, x_other: np.ndarray, y_other: np.ndarray
) -> tuple[float, int]:
    """Return the sum of squares about one polynomial through both curves, and free values.

    The second curve is moved by ``shift``. ``y`` and ``y_other`` are (q, n): quantities that
    share the abscissa and the shift, each with its own polynomial. All points count whatever the
    overlap, so the cost does not favour small overlaps.
    """
    both = np.concatenate([x, x_other + shift])
    degree = min(DEGREE, both.size // 4)
    rest = _about_polynomial(both, np.concatenate([y, y_other], axis=1), degree)
    return float(np.sum(rest * rest)), rest.size - rest.shape[1] * (degree + 1) - 1


def _about_polynomial(x: np.ndarray, y: np.ndarray, degree: int) -> np.ndarray:
    """Return what polynomials in x leave of each row of y, (n, q)."""
    unit = 2.0 * (x - x.min()) / np.ptp(x) - 1.0
    q, _ = np.linalg.qr(np.polynomial.chebyshev.chebvander(unit, degree))
    return y.T - q @ (q.T @ y.T)


def best_shift(
    x: np.ndarray, y: np.ndarray, x_other: np.ndarray, y_other: np.ndarray
) -> tuple[float, float, float]:
    """Return the shift of the second curve onto the first, its standard error, rms residual.

    Searched over every shift at which the two still touch, then refined. Each quantity counts by
    its own scatter: a noisy loss modulus does not decide against a precise storage modulus. The
    rms residual is that of the quantities as given, each weighted equally.
    """
    scatter = np.sqrt(0.5 * (own_scatter(x, y) ** 2 + own_scatter(x_other, y_other) ** 2))
    scatter = np.maximum(scatter, LEAST_SCATTER)
    y, y_other = y / scatter[:, None], y_other / scatter[:, None]

    def cost_of(shift: float) -> float:
        return common_polynomial_cost(shift, x, y, x_other, y_other)[0]

    low, high = x.min() - x_other.max(), x.max() - x_other.min()
    shift = minimum_on(np.linspace(low, high, 121), cost_of, 1e-9)
    cost, free = common_polynomial_cost(shift, x, y, x_other, y_other)
    variance = cost / max(free, 1)
    step = 0.02 * (high - low)
    curvature = (cost_of(shift - step) + cost_of(shift + step) - 2.0 * cost) / step**2
    # Flat curves fit at any shift: the error must say so, however smooth they are.
    error = np.sqrt(2.0 * max(variance, 1.0) / curvature) if curvature > 0.0 else np.inf
    return shift, float(error), float(np.sqrt(variance * np.mean(scatter**2)))


def own_scatter(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the rms of each quantity about its own cubic (or less), (q,)."""
    degree = min(3, max(x.size - 3, 1))
    rest = _about_polynomial(x, y, degree)
    return np.sqrt(np.sum(rest * rest, axis=0) / max(x.size - degree - 1, 1))


GAS_CONSTANT = 8.314462618
"""J/(mol K), CODATA 2018."""


class _ShiftLaw(ABC):
    __slots__ = ()

    @abstractmethod
    def log10_shift_factor(self, temperature: ArrayLike) -> Any:
        """Return log10 a_T for temperatures in K, any shape."""

    def shift_factor(self, temperature: ArrayLike) -> Any:
        """Return a_T: times at T are a_T times those at the reference temperature."""
        return scalar_or_array(10.0 ** np.asarray(self.log10_shift_factor(temperature)))


@dataclass(frozen=True, slots=True)
class WlfShift(_ShiftLaw):
    """log10 a_T = -C1 (T - T_ref) / (C2 + T - T_ref) (Williams, Landel, Ferry 1955).

    ``c1`` (1), ``c2`` (K), ``reference_temperature`` (K); ``rms`` is the residual in decades of
    the fit that gave it (NaN when given directly); ``tested`` the temperatures it was fitted on.
    """

    c1: float
    c2: float
    reference_temperature: float
    rms: float = float("nan")
    tested: tuple[float, float] | None = None

    def log10_shift_factor(self, temperature: ArrayLike) -> Any:
        """Return log10 a_T for temperatures in K, any shape.

        Raises:
            RangeError: At or below T_ref - C2, where the law has its pole.
        """
        away = np.asarray(temperature, dtype=float) - self.reference_temperature
        if not np.all(self.c2 + away > 0.0):
            raise RangeError(
                Message("temperature {temperature:g} K", temperature=np.min(temperature)),
                where="temperature",
                allowed=Message(
                    "above {reference_temperature:g} K, the pole of this WLF",
                    reference_temperature=self.reference_temperature - self.c2,
                ),
            )
        return scalar_or_array(-self.c1 * away / (self.c2 + away))

    def __str__(self) -> str:
        return Message(
            "WLF C1 {c1:.4g}, C2 {c2:.4g} K, residual {rms:.2g} decades",
            c1=self.c1,
            c2=self.c2,
            rms=self.rms,
        )


@dataclass(frozen=True, slots=True)
class ArrheniusShift(_ShiftLaw):
    """ln a_T = E_a / R (1/T - 1/T_ref); ``activation_energy`` in J/mol."""

    activation_energy: float
    reference_temperature: float
    rms: float = float("nan")
    tested: tuple[float, float] | None = None

    def log10_shift_factor(self, temperature: ArrayLike) -> Any:
        """Return log10 a_T for temperatures in K, any shape, above 0."""
        t = np.asarray(temperature, dtype=float)
        if not np.all(t > 0.0):
            raise RangeError(
                Message("temperature {temperature:g} K", temperature=np.min(t)),
                where="temperature",
                allowed="above 0 K",
            )
        factor = self.activation_energy / (GAS_CONSTANT * np.log(10.0))
        return scalar_or_array(factor * (1.0 / t - 1.0 / self.reference_temperature))

    def __str__(self) -> str:
        energy = f"{self.activation_energy / 1e3:.4g} kJ/mol"
        return f"Arrhenius {energy}, residual {self.rms:.2g} decades"


def fit_wlf(
    temperatures: ArrayLike, log10_shift_factors: ArrayLike, reference_temperature: float
) -> WlfShift:
    """Return the WLF law through measured shift factors, by least squares in decades.

    ``temperatures`` K and ``log10_shift_factors`` (n,), n >= 3. C2 is searched over a grid (C1 is
    linear once C2 is fixed) and refined, so no starting value is needed.
    """
    t, shifts = _check_shifts(temperatures, log10_shift_factors, 3)
    away = t - reference_temperature
    lowest = max(-float(away.min()), 0.0)

    def fit_margin(log_margin: float) -> tuple[float, float, float]:
        c2 = lowest + float(np.exp(log_margin))
        shape = -away / (c2 + away)
        c1 = float(shape @ shifts / (shape @ shape))
        return float(np.sum((c1 * shape - shifts) ** 2)), c1, c2

    grid = np.linspace(np.log(1.0), np.log(3000.0), 200)
    cost, c1, c2 = fit_margin(minimum_on(grid, lambda g: fit_margin(g)[0], 1e-10))
    tested = (float(t.min()), float(t.max()))
    return WlfShift(c1, c2, float(reference_temperature), float(np.sqrt(cost / t.size)), tested)


def fit_arrhenius(
    temperatures: ArrayLike, log10_shift_factors: ArrayLike, reference_temperature: float
) -> ArrheniusShift:
    """Return the Arrhenius law through measured shift factors, by least squares in decades.

    ``temperatures`` K and ``log10_shift_factors`` (n,), n >= 2.
    """
    t, shifts = _check_shifts(temperatures, log10_shift_factors, 2)
    inverse = (1.0 / t - 1.0 / reference_temperature) / (GAS_CONSTANT * np.log(10.0))
    energy = float(inverse @ shifts / (inverse @ inverse))
    rms = float(np.sqrt(np.mean((energy * inverse - shifts) ** 2)))
    tested = (float(t.min()), float(t.max()))
    return ArrheniusShift(energy, float(reference_temperature), rms, tested)


def _check_shifts(
    temperatures: ArrayLike, shifts: ArrayLike, least: int
) -> tuple[np.ndarray, np.ndarray]:
    t, s = np.asarray(temperatures, dtype=float), np.asarray(shifts, dtype=float)
    if t.ndim != 1 or t.shape != s.shape or np.unique(t).size < least:
        raise DataError(
            Message("{size} temperatures and {s_size} shift factors", size=t.size, s_size=s.size),
            where="shift factors",
            allowed=Message(
                "the same number of each, {least} different temperatures or more", least=least
            ),
        )
    if not (np.all(np.isfinite(t)) and np.all(np.isfinite(s)) and np.all(t > 0.0)):
        raise DataError(
            "a temperature or shift factor is missing", where="shift factors", allowed="kelvin"
        )
    return t, s


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
        shifts = self.log10_shift_factors
        return fit_arrhenius(self.temperatures, shifts, self.reference_temperature)

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
        name = Message(
            "DMA master curve at {reference_temperature:.2f} K",
            reference_temperature=self.shifts.reference_temperature,
        )
        moduli = self.storage_modulus, self.loss_modulus
        return fit_dynamic(self.angular_frequency, *moduli, **{"source": name, **settings})


@dataclass(frozen=True, slots=True, eq=False)
class RelaxationMasterCurve:
    """E(t) (Pa) against reduced time (s), ascending, with the shifts."""

    time: np.ndarray
    modulus: np.ndarray
    temperature: np.ndarray
    shifts: ShiftTable

    def spectrum(self, **settings: Any) -> SpectrumFit:
        """Return ``fit_relaxation`` of the master curve."""
        name = Message(
            "relaxation master curve at {reference_temperature:.2f} K",
            reference_temperature=self.shifts.reference_temperature,
        )
        return fit_relaxation(self.time, self.modulus, **{"source": name, **settings})


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
            counts by its own scatter. Where E' of two neighbours is flat within 0.5 % (a glass),
            both decide anyhow. Where the two disagree (resonance of the instrument, a
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
    y = [np.log10(np.array([s.storage_modulus, s.loss_modulus])) for s in ordered]
    used = 1 if shift_by == "storage" else 2
    shifts = _shift_table(x, y, temperatures, reference_temperature, used)
    w = _shift_abscissae(x, shifts)
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
    reduced, place = np.unique(_shift_abscissae(x, shifts, -1.0), return_inverse=True)
    count = np.bincount(place)
    modulus = np.bincount(place, np.concatenate([c.modulus for c in ordered])) / count
    kelvin = np.bincount(place, np.repeat(temperatures, [a.size for a in x])) / count
    return RelaxationMasterCurve(reduced, modulus, kelvin, shifts)


def _shift_abscissae(x: Sequence[np.ndarray], shifts: ShiftTable, sign: float = 1.0) -> np.ndarray:
    pairs = zip(x, shifts.log10_shift_factors, strict=True)
    return np.concatenate([10.0 ** (sign * (a + shift)) for a, shift in pairs])


def _by_temperature(tests: Sequence[Test]) -> tuple[list[Test], np.ndarray]:
    if len(tests) < 2:
        raise DataError(
            Message("{count} temperature(s)", count=len(tests)),
            where="master curve",
            allowed="two temperatures or more",
        )
    known = [(test.temperature, i) for i, test in enumerate(tests) if test.temperature is not None]
    if len(known) < len(tests):
        raise DataError(
            Message(
                "{count} of {total} tests have no temperature",
                count=len(tests) - len(known),
                total=len(tests),
            ),
            where="master curve",
            allowed="a temperature in K for each test",
        )
    known.sort()
    temperatures = np.array([t for t, _ in known])
    if np.any(np.diff(temperatures) <= 0.0):
        twice = temperatures[int(np.flatnonzero(np.diff(temperatures) <= 0.0)[0])]
        raise DataError(
            Message("two tests at {twice:g} K", twice=twice),
            where="master curve",
            remedy="Average or drop one of them",
        )
    return [tests[i] for _, i in known], temperatures


def _shift_table(
    x: Sequence[np.ndarray],
    y: Sequence[np.ndarray],
    temperatures: np.ndarray,
    reference: float | None,
    used: int = 1,
) -> ShiftTable:
    if reference is None:
        reference = float(temperatures[temperatures.size // 2])
    if not temperatures[0] <= reference <= temperatures[-1]:
        raise RangeError(
            Message("reference temperature {reference:g} K", reference=reference),
            where="reference_temperature",
            allowed=Message(
                "{coldest:g} K to {warmest:g} K, the temperatures tested",
                coldest=temperatures[0],
                warmest=temperatures[-1],
            ),
            remedy="Make the master curve inside, then move the spectrum with the fitted law",
        )
    steps, errors, mismatch = [], [], []
    for i in range(len(x) - 1):
        # A modulus that rises with frequency overlaps in frequency only where it does in size.
        apart = y[i + 1][0].max() < y[i][0].min()
        flat = np.ptp(np.concatenate([y[i][0], y[i + 1][0]])) < FLAT
        rows = slice(0, None if flat else used)
        step, error, rms = best_shift(x[i], y[i][rows], x[i + 1], y[i + 1][rows])
        gap = max(x[i].min(), x[i + 1].min() + step) - min(x[i].max(), x[i + 1].max() + step)
        if apart or gap > 0.0:
            raise DataError(
                Message(
                    "the moduli at {colder:.2f} K and {warmer:.2f} K do not overlap",
                    colder=temperatures[i],
                    warmer=temperatures[i + 1],
                ),
                where="master curve",
                remedy="Test a temperature between them, or widen the frequencies",
            )
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
