"""Minimum-residual correction of the pressure on a given contact, a part of the grid."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from operator import gt
from typing import Any

import numpy as np
from scipy.sparse import csr_array

from underfoot.core.arrays import AnyArray
from underfoot.core.threads import on_host

from .members import count_true, each, flat, products, sums
from .operators import Operators

_DEPENDENT = 1e-5
"""Share of an image left after orthogonalisation below which it is rounding."""
_GATHER_BELOW = 0.7
"""Share of the grid below which gathering costs less than masked fields (measured, NumPy)."""
_LARGEST_INT32 = 2**31 - 1
_NEAR_BELOW = 0.15
"""Share of the grid below which neighbours alone precondition a contact (measured, NumPy)."""
_NEAR_FROM = 2**16
"""Points from which they do: below, a product costs no more than to find them."""


_NEAR_STEPS = 2
"""Times as many steps then: each makes one product for two."""


class Restriction:
    """Single-precision vectors on the nodes where ``inside`` (members, nx, ny) is true.

    A row a member. Gathered: it holds the nodes of the one member. Masked: it is the whole field,
    zero elsewhere; so are those of several members, whose nodes differ in number. NumPy puts a
    gathered vector back by assignment into one buffer; the array API has none by index, so that
    other arrays take each point from the vector by its number there, a zero behind it elsewhere.
    """

    def __init__(self, inside: AnyArray, xp: Any) -> None:
        self.xp = xp
        rows = flat(inside, xp)
        self.points = rows.shape[1]
        self.nodes = count_true(rows, xp)
        self.gathered = rows.shape[0] == 1 and self.nodes[0] < _GATHER_BELOW * self.points
        self._shape = inside.shape
        self._buffer: AnyArray = None
        if not self.gathered:
            self._mask = xp.astype(rows, xp.float32)
            self.size = self.points
            return
        self.size = self.nodes[0]
        only = rows[0, :]
        self._index = xp.nonzero(only)[0]
        if xp is np:
            self._buffer = np.empty(inside.shape, np.float32)
        else:
            integer = xp.int32 if self.points <= _LARGEST_INT32 else xp.int64
            number = xp.cumulative_sum(xp.astype(only, integer), dtype=integer)
            self._number = xp.where(only, number - 1, xp.full_like(number, self.size))
            self._zero = xp.zeros_like(only[:1], dtype=xp.float32)

    def take(self, field: AnyArray) -> AnyArray:
        """Return a new vector with the values of ``field`` on the nodes."""
        if self.gathered:
            return self.xp.reshape(field, (-1,))[self._index][None, :]
        return flat(field, self.xp) * self._mask

    def through(self, product: Callable[..., AnyArray], vector: AnyArray) -> AnyArray:
        """Return ``product`` of the field of a vector as a new vector."""
        field = product(self.full_field(vector), self._buffer)
        if self.gathered:
            return self.take(field)
        rows = flat(field, self.xp)
        rows *= self._mask
        return rows

    def full_field(self, vector: AnyArray) -> AnyArray:
        """Return the field of a vector: a shared buffer or a view, not to be written to."""
        xp = self.xp
        if not self.gathered:
            return xp.reshape(vector, self._shape)
        if xp is np:
            self._buffer[...] = 0.0
            xp.reshape(self._buffer, (-1,))[self._index] = vector[0]
            return self._buffer
        return xp.reshape(xp.concat((vector[0, :], self._zero))[self._number], self._shape)

    def centre(self, vector: AnyArray) -> None:
        """Take the mean over the nodes off a vector, in place."""
        mean = self.mean(vector)
        vector -= mean if self.gathered else self._mask * mean

    def mean(self, vector: AnyArray) -> AnyArray:
        """Return the mean over the nodes (members, 1) of a vector."""
        return self.xp.sum(vector, axis=1, keepdims=True) / each(self.nodes, vector)

    def near(self, kernel: np.ndarray) -> Callable[[AnyArray], AnyArray]:
        """Return the convolution with ``kernel`` (3, 3) on the nodes of a gathered contact.

        Vectors have a zero behind them, that of neighbours out of contact.
        """
        xp, (_, rows, columns) = self.xp, self._shape
        if xp is np:
            number = np.full(self.points, self.size, np.int32)
            number[self._index] = np.arange(self.size, dtype=np.int32)
            zero = np.zeros(1, np.float32)
        else:
            number, zero = self._number, self._zero
        # with a rim of the other side, neighbours lie at fixed distances
        number = xp.reshape(number, (rows, columns))
        number = xp.concat((number[-1:, :], number, number[:1, :]), axis=0)
        number = xp.concat((number[:, -1:], number, number[:, :1]), axis=1)
        number = xp.reshape(number, (-1,))
        first = self._index + 2 * (self._index // columns)
        weights = kernel[::-1, ::-1].ravel()
        shifts = [a * (columns + 2) + b for a in range(3) for b in range(3)]
        if xp is np:
            neighbours = np.empty((self.size, 9), np.int32)
            for n, shift in enumerate(shifts):
                neighbours[:, n] = number[shift:][first]
            ends = np.arange(0, neighbours.size + 1, 9, dtype=np.int32)
            parts = np.tile(weights, self.size), neighbours.ravel(), ends
            matrix = csr_array(parts, shape=(self.size, self.size + 1))
            return lambda vector: (matrix @ np.concat((vector[0], zero)))[None]
        table = xp.concat([number[shift:][first] for shift in shifts])
        factors = xp.asarray(np.ascontiguousarray(weights), device=zero.device)

        def convolve_near(vector: AnyArray) -> AnyArray:
            around = xp.concat((vector[0, :], zero))[table]
            return (factors @ xp.reshape(around, (9, -1)))[None, :]

        return convolve_near


class Workspace:
    """Room for the search directions, allocated once and grown when a contact needs more.

    ``steps`` of their images at most; fewer, down to 3, where contact is so large that they would
    take more than ``arrays`` double arrays of the grid. The directions have room beside them or
    none: then a product finds their sum.
    """

    def __init__(
        self, steps: int, xp: Any, like: AnyArray = None, *, arrays: float = math.inf
    ) -> None:
        self.steps, self._arrays = steps, arrays
        self._xp = xp
        device = {} if xp is np else {"device": like.device}
        self._kind: dict[str, Any] = {"dtype": xp.float32, **device}
        self._images: AnyArray = None
        self._directions: AnyArray = None
        self._length = 0

    def rows(self, members: int, size: int, points: int, times: int) -> tuple[AnyArray, AnyArray]:
        """Return (members, steps, size) of undefined content for images, and for directions or
        None. ``points`` are those of the grid; ``times`` as many steps as usual.
        """
        room, most = self._arrays * points, times * self.steps
        both = most * size <= room
        steps = min(most, max(3, int(min(2.0 * room / size, 1e6))))
        shape, end = (members, steps, size), members * steps * size
        if end > self._length or (both and self._directions is None):
            self.release()
            self._length = end
            self._images = self._xp.empty(end, **self._kind)
        if not both:
            self._directions = None
        elif self._directions is None:
            self._directions = self._xp.empty(self._length, **self._kind)
        reshape = self._xp.reshape
        images = reshape(self._images[:end], shape)
        return images, reshape(self._directions[:end], shape) if both else None

    def release(self) -> None:
        """Give the memory back until rows are asked for again."""
        self._images = self._directions = None
        self._length = 0


def residual_correction(
    operators: Operators,
    part: Restriction,
    residual: AnyArray,
    reduction: Sequence[float],
    workspace: Workspace,
) -> AnyArray:
    """Return the correction c with sum c = 0 and A c = residual up to a constant, a row a member.

    Generalised conjugate residuals in single precision: directions z = S r, brought to zero
    sum, images A z orthonormal. Of S the part between neighbours suffices where contact is a small
    share of the grid: spots are small, and it costs no transform. A member stops when its
    residual's norm has fallen by its ``reduction``, all after the workspace's steps. ``residual``
    has zero mean and is overwritten. The host waits for the device once a step.
    """
    xp = operators.xp
    r = residual
    few = part.gathered and part.size < _NEAR_BELOW * part.points
    near = few and part.points >= _NEAR_FROM and not operators.soft
    stiff = part.near(operators.near()) if near else partial(part.through, operators.pressure)
    times = _NEAR_STEPS if near else 1
    images, directions = workspace.rows(r.shape[0], part.size, part.points, times)
    steps = images.shape[1]
    triangle = np.zeros((r.shape[0], steps, steps))
    weights = np.zeros((r.shape[0], steps))
    left = [square**0.5 for square in on_host(xp.vecdot(r, r)).tolist()]
    goal = [share * size for share, size in zip(reduction, left, strict=True)]
    step = 0
    while step < steps and any(map(gt, left, goal)):
        z = stiff(r)
        part.centre(z)
        w = part.through(operators.displacement, z)
        part.centre(w)
        raw = xp.vecdot(w, w)
        overlap = products(images[:, :step, :], w)
        if step:
            w -= sums(overlap, images[:, :step, :])
        sizes = (size[:, None] for size in (raw, xp.vecdot(w, w), xp.vecdot(w, r)))
        scale = []
        for n, row in enumerate(on_host(xp.concat((overlap, *sizes), axis=1)).tolist()):
            *before, raw, square, along = row
            if not (left[n] > goal[n] and square > _DEPENDENT**2 * raw):
                # no image and a direction of no weight for a member that has stopped
                left[n], triangle[n, step, step] = 0.0, 1.0
                scale.append(0.0)
                continue
            length = square**0.5
            triangle[n, :step, step], triangle[n, step, step] = before, length
            weights[n, step] = weight = along / length
            # the images are orthonormal
            left[n] = max(left[n] ** 2 - weight**2, 0.0) ** 0.5
            scale.append(1.0 / length)
        if not any(scale):
            break
        w *= each(scale, w)
        images[:, step, :] = w
        if directions is not None:
            directions[:, step, :] = z
        w *= each(weights[:, step].tolist(), w)
        r -= w
        step += 1
    if step == 0:
        return xp.zeros_like(r)
    y = np.linalg.solve(triangle[:, :step, :step], weights[:, :step, None])[:, :, 0]
    if directions is not None:
        return sums(operators.asarray(y.astype(np.float32)), directions[:, :step, :])
    # the sum of y times the residuals of each step, by their images; S of it is that of y times z
    r *= each(y.sum(axis=1).tolist(), r)
    factors = (weights[:, :step] * np.cumsum(y, axis=1)).astype(np.float32)
    r += sums(operators.asarray(factors), images[:, :step, :])
    z = stiff(r)
    part.centre(z)
    return z
