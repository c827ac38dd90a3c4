"""Contact from coarse to fine grids: each grid starts from the contact of the one before."""

from collections.abc import Callable, Sequence
from typing import Any

from underfoot.core.arrays import AnyArray
from underfoot.core.fourier import Transform

from .complementarity import ContactState, Search, solved_contacts
from .krylov import Workspace
from .members import each
from .operators import ElasticBody, Operators

_COARSEST = 4096
"""Points at which coarsening stops: below, a grid costs no less than its overhead."""
_COARSE_TOLERANCE = 0.1
_STEPS = 12
"""Search directions kept by the inner solver."""
_ROOM, _SMALL = 2.0, 8e6
"""Most double arrays of the grid for them, a fifth of a solve; more on small grids (64 MB)."""
_REDUCTION, _COARSE_REDUCTION = 0.15, 0.3
"""Share of the residual that an inner solve leaves; insensitive between 0.1 and 0.3."""


def solve_nested(
    height: AnyArray,
    body: ElasticBody,
    mean_pressure: Sequence[float],
    *,
    exact: Transform,
    tolerance: float,
    max_steps: int,
    report: Callable[[float], None],
) -> tuple[list[ContactState], Operators, list[float]]:
    """Return the contacts of a scaled ``height`` (1, nx, ny), zero mean, unit rms, a member each.

    Those under each of ``mean_pressure`` of its body of the batch. With them, the operators of the
    fine grid and the cost in products with them.

    ``exact`` is the double-precision transform of the heights.
    """
    xp, many = body.xp, len(mean_pressure)
    shape = (height.shape[-2], height.shape[-1])
    points = shape[0] * shape[1]
    room = _ROOM if many == 1 else _STEPS
    workspace = Workspace(_STEPS, xp, height, arrays=max(room, _SMALL / points))
    fine = Operators(body, (many, *shape), exact=exact if many == 1 else None)
    coarsenings = _coarsenings(shape)
    spectrum = exact.forward(height)
    levels = [(factor, low_pass(spectrum, shape, factor, xp)) for factor in coarsenings[:-1]]
    levels.append(((1, 1), height))
    del spectrum
    pressure: AnyArray = None
    before = (1, 1)
    cost = [0.0] * many
    search = Search(tolerance, max_steps, True, True, _REDUCTION, report)
    coarse = Search(max(_COARSE_TOLERANCE, tolerance), max_steps, False, False, _COARSE_REDUCTION)
    states: list[ContactState] = []
    operators = fine
    while levels:
        factor, heights = levels.pop(0)
        last = factor == (1, 1)
        size = (many, *heights.shape[-2:])
        operators = fine if last else Operators(body, size, factor)
        began = operators.count
        if pressure is None:
            guess = operators.pressure(xp.astype(xp.broadcast_to(heights, size), xp.float32))
            guess = guess + each(mean_pressure, guess)
            pressure = xp.clip(guess, 0.0, None)
            del guess
        else:
            pressure = repeat_cells(pressure, (before[0] // factor[0], before[1] // factor[1]), xp)
        guessed = operators.count - began
        states = solved_contacts(
            operators, heights, pressure, mean_pressure, workspace, search if last else coarse
        )
        if not last:
            fields = [state.pressure for state in states]
            pressure = xp.clip(fields[0] if many == 1 else xp.concat(fields), 0.0, None)
            del fields
        before = factor
        share = size[1] * size[2] / points
        cost = [c + share * (guessed + s.products) for c, s in zip(cost, states, strict=True)]
    return states, operators, cost


def low_pass(
    spectrum: AnyArray, shape: tuple[int, int], factor: tuple[int, int], xp: Any
) -> AnyArray:
    """Return the field of the long waves of a half spectrum on the grid coarser by ``factor``."""
    small = (shape[0] // factor[0], shape[1] // factor[1])
    long_waves = spectrum
    if factor[0] > 1:
        half = small[0] // 2
        middle = xp.zeros_like(spectrum[..., :1, :])
        rest = long_waves[..., shape[0] - half + 1 :, :]
        long_waves = xp.concat((long_waves[..., :half, :], middle, rest), axis=-2)
    if factor[1] > 1:
        short = long_waves[..., : small[1] // 2]
        long_waves = xp.concat((short, xp.zeros_like(long_waves[..., :1])), axis=-1)
    field = xp.fft.irfftn(long_waves, s=small, axes=(-2, -1))
    return field / (factor[0] * factor[1])


def repeat_cells(field: AnyArray, factor: tuple[int, int], xp: Any) -> AnyArray:
    """Return the field on the finer grid, constant over each coarse cell."""
    for axis in (-2, -1):
        if factor[axis] > 1:
            field = xp.repeat(field, factor[axis], axis=axis)
    return field


def _coarsenings(shape: tuple[int, int]) -> list[tuple[int, int]]:
    """Return the coarsening factors from the coarsest grid to (1, 1)."""
    factors = [(1, 1)]
    while True:
        factor = factors[-1]
        size = [shape[0] // factor[0], shape[1] // factor[1]]
        halve = [n % 2 == 0 and n >= 32 and (n // 2) % 2 == 0 for n in size]
        if size[0] * size[1] <= _COARSEST or not any(halve):
            return factors[::-1]
        factors.append((factor[0] * (2 if halve[0] else 1), factor[1] * (2 if halve[1] else 1)))
