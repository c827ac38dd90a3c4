"""Relaxation spectra fitted to measurements: non-negative, smooth, with an error band."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError

from ._kernels import maxwell
from .curves import checked_curve
from .spectrum import RelaxationSpectrum

GOOD, BAD = 0.05, 0.20
SMOOTHINGS = np.logspace(-5.0, 1.0, 25)
SLACK = 1.10
TERMS_PER_DECADE = 4
NOISE = 0.002
SAMPLES = 100


@dataclass(frozen=True, slots=True, eq=False)
class ModulusBand:
    """Band of E' and E'' at given frequencies; ``extrapolated`` marks those never measured."""

    angular_frequency: np.ndarray
    storage_low: np.ndarray
    storage_high: np.ndarray
    loss_low: np.ndarray
    loss_high: np.ndarray
    extrapolated: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class SpectrumFit:
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
    def rms_residual(self) -> float:
        """Root mean square of the relative residuals of all quantities."""
        return float(np.sqrt(np.mean(np.concatenate(list(self.residuals.values())) ** 2)))

    @property
    def largest_residual(self) -> float:
        """Largest relative residual."""
        return max(float(np.max(np.abs(part))) for part in self.residuals.values())

    @property
    def quality(self) -> str:
        """Return "good" (rms residual up to 5 %), "rough" (up to 20 %) or "bad"."""
        return quality(self.rms_residual)

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
            raise InputError(f"level {level:g}", where="level", allowed="between 0 and 1")
        pairs = list(zip(self.samples, self.sample_times, strict=True))
        storage = np.array([maxwell.storage_kernel(w, times) @ x for x, times in pairs])
        loss = np.array([maxwell.loss_kernel(w, times) @ x for x, times in pairs])
        tails = [0.5 * (1.0 - level), 0.5 * (1.0 + level)]
        low, high = self.frequency_range
        storage_band = np.quantile(storage, tails, axis=0)
        loss_band = np.quantile(loss, tails, axis=0)
        outside = (w < low * (1.0 - 1e-9)) | (w > high * (1.0 + 1e-9))
        return ModulusBand(w, storage_band[0], storage_band[1], loss_band[0], loss_band[1], outside)

    def __str__(self) -> str:
        parts = ", ".join(
            f"{name} rms {100 * np.sqrt(np.mean(r**2)):.2g} %, largest "
            f"{100 * np.max(np.abs(r)):.2g} %"
            for name, r in self.residuals.items()
        )
        return f"{len(self.spectrum)} terms, {self.quality} ({parts})"


def quality(rms_residual: float) -> str:
    """Return "good" (up to 5 %), "rough" (up to 20 %) or "bad" for a relative residual."""
    return "good" if rms_residual <= GOOD else "rough" if rms_residual <= BAD else "bad"


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

    def kernels(tau: np.ndarray) -> list[np.ndarray]:
        return [maxwell.relaxation_kernel(t, tau) / values[:, None]]

    scale = np.exp(np.interp(np.log(times), np.log(t), np.log(values)))
    return _fit(
        ("relaxation modulus",),
        kernels,
        times,
        scale,
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

    def kernels(tau: np.ndarray) -> list[np.ndarray]:
        return [
            maxwell.storage_kernel(w, tau) / storage[:, None],
            maxwell.loss_kernel(w, tau) / loss[:, None],
        ]

    return _fit(
        ("storage modulus", "loss modulus"),
        kernels,
        times,
        scale,
        (float(w[0]), float(w[-1])),
        noise,
        source or "generalised Maxwell fit to storage and loss modulus",
        seed,
    )


def _times(shortest: float, longest: float, per_decade: int) -> np.ndarray:
    if per_decade < 1:
        raise InputError(
            f"{per_decade} terms a decade", where="terms_per_decade", allowed="1 or more"
        )
    n = max(2, round(per_decade * np.log10(longest / shortest)) + 1)
    return np.geomspace(shortest, longest, n)


def _fit(
    names: Sequence[str],
    kernels: Callable[[np.ndarray], list[np.ndarray]],
    times: np.ndarray,
    scale: np.ndarray,
    frequency_range: tuple[float, float],
    noise: float,
    source: str,
    seed: int,
) -> SpectrumFit:
    blocks = kernels(times)
    sizes = [block.shape[0] for block in blocks]
    edges = np.cumsum(sizes)[:-1]
    step = float(np.log10(times[-1] / times[0])) / (times.size - 1)
    stacked = np.vstack(blocks)
    weight = np.ones(stacked.shape[0])
    smallest = SMOOTHINGS[0]
    for _ in range(2 if len(blocks) > 1 else 0):
        rough = maxwell.smooth_nonnegative(
            stacked * weight[:, None], weight, scale, step, float(smallest)
        )
        errors = np.split(stacked @ rough - 1.0, edges)
        spread = np.array([max(float(np.sqrt(np.mean(e**2))), 1e-4) for e in errors])
        weight = np.repeat(spread.min() / spread, sizes)
    matrix, goal = stacked * weight[:, None], weight
    smoothing, solution = _smoothest(matrix, goal, scale, step, noise)
    residual = stacked @ solution - 1.0
    samples, sample_times = _repetitions(
        kernels, weight, times, scale, step, smoothing, solution, seed
    )
    spectrum = RelaxationSpectrum(solution[0], solution[1:], times, source=source)
    return SpectrumFit(
        spectrum,
        dict(zip(names, np.split(residual, edges), strict=True)),
        frequency_range,
        smoothing,
        samples,
        sample_times,
    )


def _smoothest(
    matrix: np.ndarray, goal: np.ndarray, scale: np.ndarray, step: float, noise: float
) -> tuple[float, np.ndarray]:
    solutions = [
        maxwell.smooth_nonnegative(matrix, goal, scale, step, float(s)) for s in SMOOTHINGS
    ]
    rms = np.array([np.sqrt(np.mean((matrix @ x - goal) ** 2)) for x in solutions])
    limit = max(SLACK * float(rms.min()), noise, 1e-6)
    best = int(np.flatnonzero(rms <= limit)[-1])
    return float(SMOOTHINGS[best]), solutions[best]


def _repetitions(
    kernels: Callable[[np.ndarray], list[np.ndarray]],
    weight: np.ndarray,
    times: np.ndarray,
    scale: np.ndarray,
    step: float,
    smoothing: float,
    solution: np.ndarray,
    seed: int,
) -> tuple[np.ndarray, np.ndarray]:
    generator = np.random.default_rng(seed)
    blocks = kernels(times)
    sizes = [block.shape[0] for block in blocks]
    fitted = weight * (np.vstack(blocks) @ solution)
    residual = weight - fitted
    active = min(int(np.count_nonzero(solution)), weight.size // 2)
    residual = residual * np.sqrt(weight.size / (weight.size - active))
    runs = [maxwell.run_length(part) for part in np.split(residual, np.cumsum(sizes)[:-1])]
    rows, moved = [], []
    for _ in range(SAMPLES):
        signs = np.concatenate(
            [maxwell.random_signs(n, run, generator) for n, run in zip(sizes, runs, strict=True)]
        )
        strength = smoothing * 10.0 ** generator.uniform(-1.5, 0.5)
        tau = times * 10.0 ** (step * generator.uniform(-0.5, 0.5))
        matrix = np.vstack(kernels(tau)) * weight[:, None]
        goal = fitted + signs * residual
        rows.append(maxwell.smooth_nonnegative(matrix, goal, scale, step, strength))
        moved.append(tau)
    return np.array(rows), np.array(moved)
