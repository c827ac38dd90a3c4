"""Primal-dual active set for p >= 0, gap >= 0, p gap = 0, mean p = p0 with a Fourier operator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .transforms import RealTransform

Array = Any


@dataclass(slots=True)
class ContactSolution:
    """Pressure, gap and how the solution was reached; lengths and pressures are scaled."""

    pressure: Array
    gap: Array
    iterations: int
    operator_applications: int
    error: float
    converged: bool
    history: list[float]


def contact_error(pressure: Array, gap: Array) -> float:
    """Return max(deepest penetration, p-weighted |gap|), in the unit of ``gap``."""
    carried = float(np.sum(np.abs(gap) * pressure)) / max(float(pressure.sum()), 1e-300)
    return max(-float(gap.min()), carried)


def solve_contact(
    height: Array,
    compliance: Array,
    stiffness: Array,
    mean_pressure: float,
    transform: RealTransform,
    *,
    tolerance: float = 1e-6,
    max_iterations: int = 100,
    report: Callable[[float], None] = lambda error: None,
) -> ContactSolution:
    """Return the contact of a rigid surface ``height`` with the compliance symbol.

    Outside: primal-dual active set. Inside: GMRES on the contact, preconditioned by the inverse
    symbol ``stiffness`` restricted to the contact and bordered by the mean-pressure condition.
    ``tolerance`` bounds ``contact_error``.
    """
    count = 0

    def displacement(p: Array) -> Array:
        nonlocal count
        count += 1
        return transform.apply(compliance, p)

    p = transform.apply(stiffness, height - height.mean()) + mean_pressure
    count += 1
    if p.min() >= 0.0:
        return ContactSolution(p, np.zeros_like(p), 0, count, 0.0, True, [0.0])
    p = np.maximum(p, 0.0)
    p *= mean_pressure / p.mean()
    contact = p > 0.0
    history: list[float] = []
    error = np.inf
    gap = displacement(p) - height
    gap -= np.average(gap, weights=p)
    for iteration in range(1, max_iterations + 1):
        index = np.flatnonzero(contact)

        def spread(values: Array, index: Array = index) -> Array:
            field = np.zeros(height.shape)
            field.ravel()[index] = values
            return field

        def restricted(symbol: Array, values: Array, index: Array = index) -> Array:
            nonlocal count
            count += 1
            return transform.apply(symbol, spread(values)).ravel()[index]

        response = restricted(stiffness, np.ones(index.size))
        total = float(response.sum())
        p_c = p.ravel()[index]
        p_c = p_c + response * ((mean_pressure * p.size - p_c.sum()) / total)
        residual = -(restricted(compliance, p_c) - height.ravel()[index])

        def precondition(r: Array, response: Array = response, total: float = total) -> Array:
            z = restricted(stiffness, r)
            z -= response * (float(z.sum()) / total)
            return z

        target = 0.1 * tolerance if not history else max(0.05 * history[-1], 0.1 * tolerance)
        p_c += _gmres(lambda z: restricted(compliance, z), precondition, residual, target, 60)
        p = np.maximum(spread(p_c), 0.0)
        p *= mean_pressure / p.mean()
        gap = displacement(p) - height
        inside = p > 0.0
        gap -= float(gap[inside].mean())
        error = contact_error(p, gap)
        history.append(error)
        report(error)
        if error <= tolerance:
            return ContactSolution(p, gap, iteration, count, error, True, history)
        contact = inside | (gap < 0.0)
    return ContactSolution(p, gap, max_iterations, count, error, False, history)


def _gmres(
    operator: Callable[[Array], Array],
    precondition: Callable[[Array], Array],
    residual: Array,
    target: float,
    steps: int,
) -> Array:
    """Return the correction of flexible GMRES until the rms of the residual is below ``target``.

    The mean of the residual is free (it shifts the body), so it is taken out everywhere.
    """
    r = residual - residual.mean()
    beta = float(np.linalg.norm(r))
    goal = target * np.sqrt(r.size)
    if beta <= goal:
        return np.zeros_like(r)
    basis = [r / beta]
    directions: list[Array] = []
    hessenberg = np.zeros((steps + 1, steps))
    rhs = np.zeros(steps + 1)
    rhs[0] = beta
    solution = np.zeros(0)
    for k in range(steps):
        z = precondition(basis[k])
        directions.append(z)
        w = operator(z)
        w = w - w.mean()
        for i, v in enumerate(basis):
            hessenberg[i, k] = float(w @ v)
            w -= hessenberg[i, k] * v
        hessenberg[k + 1, k] = float(np.linalg.norm(w))
        solution, *_ = np.linalg.lstsq(hessenberg[: k + 2, : k + 1], rhs[: k + 2], rcond=None)
        left = float(np.linalg.norm(hessenberg[: k + 2, : k + 1] @ solution - rhs[: k + 2]))
        if left <= goal or hessenberg[k + 1, k] <= 1e-14 * beta:
            break
        basis.append(w / hessenberg[k + 1, k])
    correction = np.zeros_like(r)
    for weight, z in zip(solution, directions, strict=True):
        correction += weight * z
    return correction
