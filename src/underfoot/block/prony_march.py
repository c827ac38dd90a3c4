"""Exact step of a generalised Maxwell surface whose displacement is linear within the step."""

from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import AnyArray


@dataclass(frozen=True, slots=True)
class PronyStep:
    """Coefficients of one step of length dt, E(t) = E0 [1 - sum g_i (1 - exp(-b_i t))].

    ``stiffening`` m = 1 - sum g_i (1 - phi_i): the step is elastic with modulus m E0.
    """

    decay: np.ndarray
    fraction: np.ndarray
    mean_decay: np.ndarray
    stiffening: float


def prony_step(fractions: AnyArray, rates: AnyArray, time_step: float) -> PronyStep:
    """Return the coefficients e_i = exp(-b_i dt), phi_i = (1 - e_i)/(b_i dt) and m."""
    x = np.asarray(rates, dtype=float) * time_step
    decay = np.exp(-x)
    mean_decay = np.where(x > 1e-8, -np.expm1(-x) / np.where(x > 1e-8, x, 1.0), 1.0 - 0.5 * x)
    g = np.asarray(fractions, dtype=float)
    return PronyStep(decay, g, mean_decay, float(1.0 - np.sum(g * (1.0 - mean_decay))))


def known_displacement(memory: AnyArray, displacement: AnyArray, step: PronyStep) -> AnyArray:
    """Return U, the displacement at the end of the step under no pressure (memory (n, nx, ny))."""
    carried = np.tensordot(step.decay, memory, axes=1)
    carried += float(np.sum(step.fraction * (step.mean_decay - step.decay))) * displacement
    return carried / step.stiffening


def advance_memory(memory: AnyArray, old: AnyArray, new: AnyArray, step: PronyStep) -> None:
    """Advance the terms' memory w_i, in place, over a step from displacement old to new."""
    for i in range(memory.shape[0]):
        memory[i] *= step.decay[i]
        memory[i] += step.fraction[i] * (1.0 - step.mean_decay[i]) * new
        memory[i] += step.fraction[i] * (step.mean_decay[i] - step.decay[i]) * old


def relaxed_memory(displacement: AnyArray, fractions: AnyArray) -> AnyArray:
    """Return the memory after a long rest under ``displacement``: w_i = g_i u."""
    return np.asarray(fractions, dtype=float)[:, None, None] * displacement[None]
