"""Relaxation spectra fitted to measurements or to longer spectra: non-negative and smooth."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, RangeError
from underfoot.core.remark import Message

from .curves import checked_curve
from .spectrum import RelaxationSpectrum

Kernel = Callable[[np.ndarray, np.ndarray], np.ndarray]
GOOD, BAD = 0.05, 0.20
SMOOTHINGS = np.logspace(-5.0, 1.0, 25)
SLACK = 1.10
TERMS_PER_DECADE = 4
NOISE = 0.002
SAMPLES = 100


def relaxation_kernel(time: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return columns [1, exp(-t / tau_k)], (n, 1 + m)."""
    return np.column_stack([np.ones(time.size), np.exp(-time[:, None] / times)])


def storage_kernel(w: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return columns [1, (w tau)^2 / (1 + (w tau)^2)], (n, 1 + m)."""
    x2 = (w[:, None] * times) ** 2
    return np.column_stack([np.ones(w.size), x2 / (1.0 + x2)])


def loss_kernel(w: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return columns [0, w tau / (1 + (w tau)^2)], (n, 1 + m)."""
    x = w[:, None] * times
    return np.column_stack([np.zeros(w.size), x / (1.0 + x * x)])


def smooth_nonnegative(
    kernel: np.ndarray, target: np.ndarray, scale: np.ndarray, step: float, smoothing: float
) -> np.ndarray:
    """Return x >= 0 minimising mean (kernel x - target)^2 + smoothing^2 mean (s'')^2.

    s = x[1:] / (scale step) is the spectrum per decade relative to the local modulus ``scale``
    (m,), ``step`` the spacing of the relaxation times in decades, '' the derivative by the
    decade. Column 0 is the equilibrium modulus and not smoothed.
    """
    from scipy.optimize import nnls

    n, m = kernel.shape[0], scale.size
    columns = np.concatenate([[scale[-1]], scale])
    rough = (np.diff(np.eye(m), 2, axis=0) if m > 2 else np.zeros((0, m))) / step**3
    penalty = np.hstack([np.zeros((rough.shape[0], 1)), rough])
    matrix = np.vstack([kernel * columns / np.sqrt(n), penalty * (smoothing / np.sqrt(m))])
    goal = np.concatenate([target / np.sqrt(n), np.zeros(rough.shape[0])])
    solution, _ = nnls(matrix, goal, maxiter=50 * (m + 1))
    return solution * columns


def nonnegative(matrix: np.ndarray, goal: np.ndarray) -> np.ndarray:
    """Return x >= 0 minimising |matrix x - goal|, its columns scaled to one size."""
    from scipy.optimize import nnls

    size = np.linalg.norm(matrix, axis=0)
    return nnls(matrix / size, goal)[0] / size


def check_terms(per_decade: int) -> None:
    """Refuse less than one term a decade."""
    if per_decade < 1:
        raise RangeError(
            Message("{per_decade} terms a decade", per_decade=per_decade),
            where="terms_per_decade",
            allowed="1 or more",
        )


def run_length(residual: np.ndarray) -> int:
    """Return over how many neighbours residuals are correlated (first-order autoregression)."""
    if residual.size < 8:
        return 1
    centred = residual - residual.mean()
    power = float(centred @ centred)
    if power == 0.0:
        return 1
    rho = min(max(float(centred[1:] @ centred[:-1]) / power, 0.0), 0.9)
    return max(1, min(round((1.0 + rho) / (1.0 - rho)), residual.size // 8 or 1))


def random_signs(n: int, run: int, generator: np.random.Generator) -> np.ndarray:
    """Return n signs, equal within runs of ``run`` with a random start."""
    count = n // run + 2
    signs = np.repeat(generator.choice([-1.0, 1.0], count), run)
    start = int(generator.integers(run)) if run > 1 else 0
    return signs[start : start + n]


@dataclass(frozen=True, slots=True, eq=False)
class ModulusBand:
    """Band of E' and E'' at given frequencies; ``extrapolated`` marks those never measured."""

    angular_frequency: np.ndarray
    storage_low: np.ndarray
    storage_high: np.ndarray
    loss_low: np.ndarray
    loss_high: np.ndarray
    extrapolated: np.ndarray


class Judged:
    """What the relative residuals of a fit say about it."""

    __slots__ = ()
    residual: Any

    @property
    def rms_residual(self) -> float:
        """Root mean square of the relative residuals."""
        return float(np.sqrt(np.mean(self.residual**2)))

    @property
    def largest_residual(self) -> float:
        """Largest relative residual."""
        return float(np.max(np.abs(self.residual)))

    @property
    def quality(self) -> str:
        """Return "good" (rms residual up to 5 %), "rough" (up to 20 %) or "bad"."""
        rms = self.rms_residual
        return "good" if rms <= GOOD else "rough" if rms <= BAD else "bad"


@dataclass(frozen=True, slots=True, eq=False)
class SpectrumFit(Judged):
    """A fitted spectrum with what a reader must know about it.

    Residuals are relative to the measured values. ``frequency_range`` (rad/s) is where the
    measurement decides; outside it the spectrum is an extrapolation that its band can't judge.
    """

    spectrum: RelaxationSpectrum
    residuals: dict[str, np.ndarray]
    frequency_range: tuple[float, float]
    smoothing: float
    samples: np.ndarray
    """Equilibrium and term moduli of the repeated fits, (repetitions, 1 + terms), Pa."""
    sample_times: np.ndarray
    """Their relaxation times, (repetitions, terms), s."""

    @property
    def residual(self) -> np.ndarray:
        """Relative residuals of all quantities, one after the other."""
        return np.concatenate(list(self.residuals.values()))

    def band(self, angular_frequency: ArrayLike, level: float = 0.95) -> ModulusBand:
        """Return the band of E' and E'' that holds ``level`` of the repeated fits.

        The fit is repeated with the residuals' signs drawn anew (in runs as long as residuals
        are correlated), with other strengths of smoothing and with all relaxation times moved by
        up to half a step, so noise and the freedom of the spectrum both enter. Systematic errors
        of the instrument do not, and for a few sharp terms the band is too narrow.
        """
        w = np.atleast_1d(np.asarray(angular_frequency, dtype=float))
        if w.ndim != 1 or not np.all(np.isfinite(w) & (w > 0.0)):
            raise InputError(
                "a frequency is missing, negative or zero",
                where="angular_frequency",
                allowed="a one-dimensional array above 0 rad/s",
            )
        if not 0.0 < level < 1.0:
            raise InputError(
                Message("level {level:g}", level=level), where="level", allowed="between 0 and 1"
            )
        pairs = list(zip(self.samples, self.sample_times, strict=True))
        tails = [0.5 * (1.0 - level), 0.5 * (1.0 + level)]
        storage, loss = (
            np.quantile([kernel(w, times) @ x for x, times in pairs], tails, axis=0)
            for kernel in (storage_kernel, loss_kernel)
        )
        low, high = self.frequency_range
        outside = (w < low * (1.0 - 1e-9)) | (w > high * (1.0 + 1e-9))
        return ModulusBand(w, storage[0], storage[1], loss[0], loss[1], outside)

    def __str__(self) -> str:
        parts = [
            Message(
                "{name} rms {rms:.2g} %, largest {largest:.2g} %",
                name=name,
                rms=100 * np.sqrt(np.mean(r**2)),
                largest=100 * np.max(np.abs(r)),
            )
            for name, r in self.residuals.items()
        ]
        return Message(
            "{count} terms, {quality} ({parts})",
            count=len(self.spectrum),
            quality=self.quality,
            parts=parts,
        )


def fit_relaxation(
    time: ArrayLike,
    modulus: ArrayLike,
    *,
    terms_per_decade: int = TERMS_PER_DECADE,
    noise: float = NOISE,
    source: str = "",
    seed: int = 0,
) -> SpectrumFit:
    """Return the generalised Maxwell spectrum of a relaxation curve.

    Non-negative least squares on the relative errors of E(t), with relaxation times spread
    evenly over the logarithm of the measured time and the second differences of the spectrum
    kept small. The smoothing is the largest that raises the rms residual by no more than 10 %
    over the unsmoothed one (or up to ``noise``).

    Parameters:
        time: s, ascending, above 0, (n,).
        modulus: Pa, above 0, (n,).
        terms_per_decade: 4 also follows a few sharp terms; 2 is enough for a broad spectrum.
        noise: Relative standard deviation below which residuals are not chased (assumed 0.2 %: no
            rheometer is better); 0 for exact data.
        seed: Of the repetitions behind the error band.

    Frequencies from 1 / longest to 1 / shortest time are taken as measured.

    Raises:
        DataError: Times not ascending, values missing, negative or zero, fewer than four points.
    """
    t, values = checked_curve(time, modulus)
    times = _times(t[0], t[-1], terms_per_decade)

    return _fit(
        t,
        {"relaxation modulus": (relaxation_kernel, values)},
        times,
        np.exp(np.interp(np.log(times), np.log(t), np.log(values))),
        (1.0 / t[-1], 1.0 / t[0]),
        noise,
        source or "generalised Maxwell fit to a relaxation curve",
        seed,
    )


def fit_dynamic(
    angular_frequency: ArrayLike,
    storage_modulus: ArrayLike,
    loss_modulus: ArrayLike,
    *,
    terms_per_decade: int = TERMS_PER_DECADE,
    noise: float = NOISE,
    source: str = "",
    seed: int = 0,
) -> SpectrumFit:
    """Return the generalised Maxwell spectrum of E'(w) and E''(w), fitted together.

    As ``fit_relaxation``, on the relative errors of both; each is then weighted by the rms
    residual that it turned out to have, so that the noisier one does not spoil the other.

    Parameters:
        angular_frequency: rad/s, above 0, in any order, (n,).
        storage_modulus, loss_modulus: Pa, above 0, (n,).

    Raises:
        DataError: Values missing, negative or zero, fewer than four points.
    """
    w, storage = checked_curve(angular_frequency, storage_modulus, quantity="storage modulus")
    _, loss = checked_curve(angular_frequency, loss_modulus, quantity="loss modulus")
    margin = np.sqrt(10.0)
    times = _times(1.0 / (w[-1] * margin), margin / w[0], terms_per_decade)
    size = np.hypot(storage, loss)
    order = np.argsort(-np.log(w), kind="stable")
    scale = np.exp(np.interp(np.log(times), -np.log(w)[order], np.log(size)[order]))

    return _fit(
        w,
        {"storage modulus": (storage_kernel, storage), "loss modulus": (loss_kernel, loss)},
        times,
        scale,
        (float(w[0]), float(w[-1])),
        noise,
        source or "generalised Maxwell fit to storage and loss modulus",
        seed,
    )


def _times(shortest: float, longest: float, per_decade: int) -> np.ndarray:
    check_terms(per_decade)
    n = max(2, round(per_decade * np.log10(longest / shortest)) + 1)
    return np.geomspace(shortest, longest, n)


def _fit(
    axis: np.ndarray,
    measured: Mapping[str, tuple[Kernel, np.ndarray]],
    times: np.ndarray,
    scale: np.ndarray,
    frequency_range: tuple[float, float],
    noise: float,
    source: str,
    seed: int,
) -> SpectrumFit:
    edges = np.arange(1, len(measured)) * axis.size
    step = float(np.log10(times[-1] / times[0])) / (times.size - 1)

    def relative(tau: np.ndarray) -> np.ndarray:
        return np.vstack([kernel(axis, tau) / y[:, None] for kernel, y in measured.values()])

    def solve_weights(matrix: np.ndarray, goal: np.ndarray, smoothing: float) -> np.ndarray:
        return smooth_nonnegative(matrix * weight[:, None], goal, scale, step, float(smoothing))

    stacked = relative(times)
    weight = np.ones(stacked.shape[0])
    for _ in range(2 if len(measured) > 1 else 0):
        rough = solve_weights(stacked, weight, SMOOTHINGS[0])
        errors = np.split(stacked @ rough - 1.0, edges)
        spread = np.array([max(float(np.sqrt(np.mean(e**2))), 1e-4) for e in errors])
        weight = np.repeat(spread.min() / spread, axis.size)
    solutions = [solve_weights(stacked, weight, s) for s in SMOOTHINGS]
    matrix = stacked * weight[:, None]
    rms = np.array([np.sqrt(np.mean((matrix @ x - weight) ** 2)) for x in solutions])
    best = int(np.flatnonzero(rms <= max(SLACK * float(rms.min()), noise, 1e-6))[-1])
    smoothing, solution = float(SMOOTHINGS[best]), solutions[best]

    generator = np.random.default_rng(seed)
    fitted = weight * (stacked @ solution)
    active = min(int(np.count_nonzero(solution)), weight.size // 2)
    residual = (weight - fitted) * np.sqrt(weight.size / (weight.size - active))
    runs = [run_length(part) for part in np.split(residual, edges)]
    samples, sample_times = [], []
    for _ in range(SAMPLES):
        signs = np.concatenate([random_signs(axis.size, run, generator) for run in runs])
        strength = smoothing * 10.0 ** generator.uniform(-1.5, 0.5)
        tau = times * 10.0 ** (step * generator.uniform(-0.5, 0.5))
        samples.append(solve_weights(relative(tau), fitted + signs * residual, strength))
        sample_times.append(tau)
    return SpectrumFit(
        RelaxationSpectrum(solution[0], solution[1:], times, source=source),
        dict(zip(measured, np.split(stacked @ solution - 1.0, edges), strict=True)),
        frequency_range,
        smoothing,
        np.array(samples),
        np.array(sample_times),
    )


@dataclass(frozen=True, slots=True, eq=False)
class ReducedSpectrum:
    """A spectrum with fewer terms and the largest relative errors of E' and E'' in the range."""

    spectrum: RelaxationSpectrum
    frequency_range: tuple[float, float]
    storage_error: float
    loss_error: float


def reduce_spectrum(
    spectrum: RelaxationSpectrum, frequency_range: tuple[float, float], *, terms_per_decade: int = 1
) -> ReducedSpectrum:
    """Return the spectrum with evenly spread terms that follow it over ``frequency_range`` only.

    For methods whose cost grows with the number of terms (time marching). Non-negative least
    squares on the relative errors of E' and E'' at twelve frequencies a decade (rad/s), with half
    a decade of terms beyond each end; faster terms act as part of the last one, slower ones as
    part of the equilibrium modulus.

    Raises:
        InputError: Range not ascending, fewer than one term a decade, no loss in the range.
    """
    low, high = frequency_range
    if not 0.0 < low < high < np.inf:
        raise InputError(
            Message("{low:g} to {high:g} rad/s", low=low, high=high),
            where="frequency_range",
            allowed="0 < lowest < highest",
        )
    check_terms(terms_per_decade)
    w = np.geomspace(low, high, max(round(12 * np.log10(high / low)), 6) + 1)
    storage, loss = spectrum.storage_modulus(w), spectrum.loss_modulus(w)
    if not np.all(loss > 0.0):
        raise InputError(
            "the material has no loss in this range",
            where="frequency_range",
            remedy="Use its elastic modulus",
        )
    edge = np.sqrt(10.0)
    n = max(round((np.log10(high / low) + 1.0) * terms_per_decade), 1) + 1
    times = np.geomspace(1.0 / (high * edge), edge / low, n)
    kernels = ((storage_kernel, storage), (loss_kernel, loss))
    matrix = np.vstack([kernel(w, times) / y[:, None] for kernel, y in kernels])
    solution = nonnegative(matrix, np.ones(2 * w.size))
    keep = solution[1:] > 0.0
    fewer = RelaxationSpectrum(
        solution[0],
        solution[1:][keep],
        times[keep],
        source=f"{spectrum.source}; reduced to {int(keep.sum())} terms, {low:g} to {high:g} rad/s",
        assumed=spectrum.assumed,
    )
    return ReducedSpectrum(
        fewer,
        (float(low), float(high)),
        float(np.max(np.abs(fewer.storage_modulus(w) / storage - 1.0))),
        float(np.max(np.abs(fewer.loss_modulus(w) / loss - 1.0))),
    )
