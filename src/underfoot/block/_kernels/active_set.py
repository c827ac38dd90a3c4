"""Contact as a linear complementarity problem of a symmetric positive definite compliance."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

PATIENCE = 10


@dataclass(frozen=True, slots=True, eq=False)
class NodalContact:
    """Forces f (n,) and gaps (n,) of a solved contact, with the height it was solved for.

    ``wrong`` counts the nodes that break f >= 0, gap >= 0, f gap = 0 beyond rounding.
    """

    force: np.ndarray
    gap: np.ndarray
    height: float
    steps: int
    wrong: int


def contact_at_height(
    compliance: np.ndarray, clearance: np.ndarray, height: float, active: np.ndarray
) -> NodalContact:
    """Return f >= 0, gap = clearance + height + C f >= 0, f gap = 0.

    Primal-dual active set (block principal pivoting): all wrong nodes change sides at once; when
    that stops reducing their number, only the last of them does (Murty), which ends surely for a
    positive definite C. ``active`` (n,) bool is the first guess. Source: Judice and Pires (1994)
    Computers Oper. Res. 21:587.
    """
    return _pivot(compliance, clearance, active, height=height)


def contact_under_load(
    compliance: np.ndarray, clearance: np.ndarray, load: float, active: np.ndarray
) -> NodalContact:
    """Return the contact whose forces sum to ``load`` (> 0); the height comes out.

    Pivots as ``contact_at_height`` with the height as one unknown more; where these go round in a
    circle, the height is found by the secant method on the contact at a given height.
    """
    if not active.any():
        active = np.zeros(clearance.size, dtype=bool)
        active[np.argmin(clearance)] = True

    solution = _pivot(compliance, clearance, active, load=load)
    return solution if solution.wrong == 0 else _by_secant(compliance, clearance, load, solution)


def _solve_contact(
    compliance: np.ndarray,
    clearance: np.ndarray,
    contact: np.ndarray,
    height: float,
    load: float | None,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return force, gap and height where the nodes in ``contact`` have no gap."""
    inside = np.flatnonzero(contact)
    force = np.zeros(clearance.size)
    if inside.size:
        factor = cho_factor(
            compliance[np.ix_(inside, inside)], overwrite_a=True, check_finite=False
        )
        if load is None:
            force[inside] = cho_solve(factor, -(clearance[inside] + height), check_finite=False)
        else:
            both = np.column_stack([clearance[inside], np.ones(inside.size)])
            first, second = cho_solve(factor, both, check_finite=False).T
            height = -float((load + first.sum()) / second.sum())
            force[inside] = -first - height * second
    gap = clearance + height + compliance[:, inside] @ force[inside]
    gap[inside] = 0.0
    return force, gap, height


def _pivot(
    compliance: np.ndarray,
    clearance: np.ndarray,
    active: np.ndarray,
    height: float = 0.0,
    load: float | None = None,
) -> NodalContact:
    contact = active.copy()
    fewest, patience = contact.size + 1, PATIENCE
    limit = 20 * contact.size + 100 if load is None else 60
    steps = 0
    while True:
        force, gap, height = _solve_contact(compliance, clearance, contact, height, load)
        steps += 1
        small_force = 1e-13 * float(np.abs(force).max(initial=0.0))
        small_gap = 1e-13 * float(np.abs(gap).max(initial=0.0))
        wrong = np.where(contact, force < -small_force, gap < -small_gap)
        count = int(wrong.sum())
        if count == 0 or steps >= limit:
            return NodalContact(np.maximum(force, 0.0), np.maximum(gap, 0.0), height, steps, count)
        if count < fewest:
            fewest, patience = count, PATIENCE
        else:
            patience -= 1
        if patience > 0:
            contact ^= wrong
        else:
            last = int(np.flatnonzero(wrong)[-1])
            contact[last] = ~contact[last]


def _by_secant(
    compliance: np.ndarray, clearance: np.ndarray, load: float, near: NodalContact
) -> NodalContact:
    """Return the contact under ``load``: regula falsi on the height, force falls as it grows."""
    high = -float(clearance.min())
    low = min(near.height, high) - 1e-3 * float(np.ptp(clearance) + 1e-12)
    solution = contact_at_height(compliance, clearance, low, near.force > 0.0)
    steps = near.steps + solution.steps
    while solution.force.sum() < load:
        low -= max(high - low, 1e-12)
        solution = contact_at_height(compliance, clearance, low, solution.force > 0.0)
        steps += solution.steps
    for _ in range(200):
        # the tangent of the active set; exact once the set no longer changes
        inside = np.flatnonzero(solution.force > 0.0)
        miss = float(solution.force.sum()) - load
        if abs(miss) <= 1e-12 * load:
            break
        low, high = (solution.height, high) if miss > 0.0 else (low, solution.height)
        trial = 0.5 * (low + high)
        if inside.size:
            factor = cho_factor(compliance[np.ix_(inside, inside)], check_finite=False)
            slope = float(cho_solve(factor, np.ones(inside.size), check_finite=False).sum())
            newton = solution.height + miss / slope
            trial = newton if low < newton < high else trial
        solution = contact_at_height(compliance, clearance, trial, solution.force > 0.0)
        steps += solution.steps
    wrong = solution.wrong + int(abs(float(solution.force.sum()) - load) > 1e-9 * load)
    return NodalContact(solution.force, solution.gap, solution.height, steps, wrong)
