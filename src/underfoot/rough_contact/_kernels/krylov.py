"""Minimum-residual correction of the pressure on a given contact."""

from __future__ import annotations

from typing import Any

import numpy as np

from underfoot.core.arrays import AnyArray

from .operators import Operators
from .restriction import Restriction

_DEPENDENT = 1e-5
"""Share of an image left after orthogonalisation below which it is rounding."""


class Workspace:
    """Room for the search directions, allocated once and grown when a contact needs more."""

    def __init__(self, steps: int, xp: Any, like: AnyArray = None) -> None:
        self.steps = steps
        self._xp = xp
        device = {} if xp is np else {"device": like.device}
        self._kind: dict[str, Any] = {"dtype": xp.float32, **device}
        self._images: AnyArray = None
        self._directions: AnyArray = None
        self._length = 0

    def rows(self, size: int) -> tuple[AnyArray, AnyArray]:
        """Return two (steps, size) arrays of undefined content."""
        if self.steps * size > self._length:
            self._images = self._directions = None
            self._length = self.steps * size
            self._images = self._xp.empty(self._length, **self._kind)
            self._directions = self._xp.empty(self._length, **self._kind)
        shape, end = (self.steps, size), self.steps * size
        reshape = self._xp.reshape
        return reshape(self._images[:end], shape), reshape(self._directions[:end], shape)


def residual_correction(
    operators: Operators,
    part: Restriction,
    residual: AnyArray,
    response: AnyArray,
    reduction: float,
    floor: float,
    workspace: Workspace,
) -> tuple[AnyArray, int]:
    """Return the correction c with sum c = 0 and A c = residual up to a constant, and the steps.

    Generalised conjugate residuals in single precision: directions z = S r, brought to zero sum
    with ``response`` (S 1 on the contact), images A z orthonormal. Stops when the residual's norm
    has fallen by ``reduction`` or below ``floor``, or after the workspace's steps. ``residual``
    has zero mean and is overwritten.
    """
    xp = operators.xp
    images, directions = workspace.rows(part.size)
    triangle = np.zeros((workspace.steps, workspace.steps))
    weights = np.zeros(workspace.steps)
    r = residual
    left = _norm(r)
    goal = max(reduction * left, floor)
    total = float(xp.sum(response))
    step = 0
    while left > goal and step < workspace.steps:
        z = part.take(operators.pressure(part.spread(r)))
        z -= response * _scalar(xp, float(xp.sum(z)) / total)
        w = part.take(operators.displacement(part.spread(z)))
        part.shift(w, -float(xp.sum(w)) / part.nodes)
        raw = _norm(w)
        if step:
            overlap = images[:step, :] @ w
            w -= overlap @ images[:step, :]
            triangle[:step, step] = overlap if xp is np else [float(o) for o in overlap]
        length = _norm(w)
        if not length > _DEPENDENT * raw:
            break
        triangle[step, step] = length
        weight = float(w @ r) / length
        images[step, :] = w * _scalar(xp, 1.0 / length)
        directions[step, :] = z
        weights[step] = weight
        w *= _scalar(xp, weight / length)
        r -= w
        left = max(left**2 - weight**2, 0.0) ** 0.5  # the images are orthonormal
        step += 1
    if step == 0:
        return xp.zeros_like(r), 0
    y = np.linalg.solve(triangle[:step, :step], weights[:step]).astype(np.float32)
    return operators.asarray(y) @ directions[:step, :], step


def _norm(vector: AnyArray) -> float:
    return float(vector @ vector) ** 0.5


def _scalar(xp: Any, value: float) -> AnyArray:
    return xp.asarray(value, dtype=xp.float32)
