"""Contact from coarse to fine grids: each grid starts from the contact of the one before."""

from collections.abc import Callable
from typing import Any

from underfoot.core.arrays import AnyArray
from underfoot.core.fourier import Transform

from .complementarity import ContactState, Search, solved_contact
from .krylov import Workspace
from .operators import Body, Operators

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
    body: Body,
    mean_pressure: float,
    *,
    exact: Transform,
    tolerance: float,
    max_steps: int,
    report: Callable[[float], None],
) -> tuple[ContactState, Operators, float]:
    """Return the contact of a scaled ``height`` (zero mean, unit rms) under ``mean_pressure``.

    With it, the operators of the fine grid and the cost in products with them.

    ``exact`` is the double-precision transform.
    """
    xp = body.xp
    points = height.shape[0] * height.shape[1]
    workspace = Workspace(_STEPS, xp, height, arrays=max(_ROOM, _SMALL / points))
    fine = Operators(body, height.shape, exact=exact)
    coarsenings = _coarsenings(height.shape)
    spectrum = exact.forward(height)
    levels = [(factor, low_pass(spectrum, height.shape, factor, xp)) for factor in coarsenings[:-1]]
    levels.append(((1, 1), height))
    del spectrum
    pressure: AnyArray = None
    before = (1, 1)
    cost = 0.0
    search = Search(tolerance, max_steps, True, True, _REDUCTION, report)
    coarse = Search(max(_COARSE_TOLERANCE, tolerance), max_steps, False, False, _COARSE_REDUCTION)
    state: ContactState | None = None
    operators = fine
    while levels:
        factor, heights = levels.pop(0)
        last = factor == (1, 1)
        operators = fine if last else Operators(body, heights.shape, factor)
        if pressure is None:
            guess = operators.pressure(xp.astype(heights, xp.float32)) + mean_pressure
            pressure = xp.clip(guess, 0.0, None)
        else:
            pressure = repeated(pressure, (before[0] // factor[0], before[1] // factor[1]), xp)
        state = solved_contact(
            operators, heights, pressure, mean_pressure, workspace, search if last else coarse
        )
        pressure = xp.clip(state.pressure, 0.0, None)
        before = factor
        cost += operators.count * heights.shape[0] * heights.shape[1]
    assert state is not None
    return state, operators, cost / points


def low_pass(
    spectrum: AnyArray, shape: tuple[int, int], factor: tuple[int, int], xp: Any
) -> AnyArray:
    """Return the field of the long waves of a half spectrum on the grid coarser by ``factor``."""
    small = (shape[0] // factor[0], shape[1] // factor[1])
    long_waves = spectrum
    if factor[0] > 1:
        half = small[0] // 2
        middle = xp.zeros_like(spectrum[:1, :])
        long_waves = xp.concat(
            (long_waves[:half, :], middle, long_waves[shape[0] - half + 1 :, :]), axis=0
        )
    if factor[1] > 1:
        long_waves = xp.concat(
            (long_waves[:, : small[1] // 2], xp.zeros_like(long_waves[:, :1])), axis=1
        )
    field = xp.fft.irfftn(long_waves, s=small, axes=(0, 1))
    return field / (factor[0] * factor[1])


def repeated(field: AnyArray, factor: tuple[int, int], xp: Any) -> AnyArray:
    """Return the field on the finer grid, constant over each coarse cell."""
    for axis in (0, 1):
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
