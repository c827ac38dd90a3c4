"""Inputs of a sliding contact: checks, complex modulus, resolution."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol, cast

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import Breach, InputError, ValidityRange, breaches, display
from underfoot.core.arrays import AnyArray
from underfoot.core.checks import host_array, positive
from underfoot.core.checks import poisson_ratio as check_poisson_ratio
from underfoot.core.device import free_memory
from underfoot.core.remark import Amount, Message
from underfoot.core.threads import namespace
from underfoot.surface import HeightMap


class HasComplexModulus(Protocol):
    """A material: E*(angular frequency, rad/s) in Pa."""

    def complex_modulus(self, angular_frequency: Any) -> Any:
        """Return E* (Pa, complex) at the angular frequencies (rad/s)."""
        ...


Modulus = float | HasComplexModulus | Callable[[AnyArray], Any]

_RANGES = {
    "rms slope": ValidityRange(0.0, 0.5, "1", "small-slope theory, limit assumed"),
    "share of the mean square slope in waves shorter than 4 grid spacings": ValidityRange(
        0.0, 0.1, "1", "resolution, limit assumed"
    ),
}
FEWEST_NODES = 30
"""Nodes in contact below which area, gap and friction rest on too few spots (assumed)."""
ARRAYS = 10
"""Most double arrays of its grid that a contact takes beside the heights (measured)."""
BATCH_ARRAYS = 24
"""The same for each contact of a batch, which holds whole fields as search directions."""
_BATCH = 2**25
"""Points of a batch (assumed): 128 contacts of 512 x 512, more than a card computes at once."""
_NEGLIGIBLE_LOSS_TANGENT = 1e-3
_SMALL = 128 * 128
"""Points below which a contact takes a few hundredths of a second on a grid of any size."""
_HALVED = 16


def check_map(surface: HeightMap, where: str) -> None:
    """Refuse a map that a contact on a periodic grid of one spacing can't take."""
    if not surface.periodic:
        raise InputError(
            "the surface is not periodic",
            where=where,
            remedy="Make it periodic first (underfoot.surface.make_periodic), or generate surfaces "
            "from its spectrum",
        )
    along, across = surface.spacings
    if not math.isclose(along, across):
        raise InputError(
            Message(
                "cells of {along} by {across}", along=Amount(along, "m"), across=Amount(across, "m")
            ),
            where=where,
            allowed="square cells",
            remedy="Divide them first (underfoot.surface.square_cells)",
        )


def checked_contact_input(
    height: ArrayLike,
    spacing: float | tuple[float, float],
    speed: float,
    pressure: float,
    poisson_ratio: float,
    layer_thickness: float | None,
    members: int = 1,
) -> tuple[AnyArray, tuple[float, float]]:
    """Return (heights as floats, (dx, dy)) or raise InputError with the remedy.

    ``members`` contacts must fit into the memory together.
    """
    h, finite = _as_floats(height)
    shape = tuple(h.shape)
    if h.ndim != 2:
        raise InputError(
            f"height has {h.ndim} dimension(s)",
            where="height",
            allowed="a map (nx, ny)",
            remedy="Give a profile as (n, 4) equal columns: np.repeat(profile[:, None], 4, axis=1)",
        )
    if min(shape) < 4 or max(shape) < 8:
        raise InputError(
            f"height has shape {shape}", where="height", allowed="at least 8 x 4 nodes"
        )
    xp = namespace(h)
    if not finite:
        rows, columns = xp.nonzero(~xp.isfinite(h))
        first = int(rows[0]), int(columns[0])
        raise InputError(
            Message(
                "{count} of {total} heights are missing or infinite, the first at {first}",
                count=rows.shape[0],
                total=shape[0] * shape[1],
                first=str(first),
            ),
            where="height",
            allowed="a finite height at every node",
            remedy="Fill or cut them away first (underfoot.surface.fill_missing_heights)",
        )
    pair = isinstance(spacing, tuple | list) or np.ndim(spacing) > 0
    steps: Any = spacing if pair else (spacing, spacing)
    if (steps.shape[0] if hasattr(steps, "shape") else len(steps)) != 2:
        raise InputError(f"spacing {spacing}", where="spacing", allowed="one length or two, m")
    dx, dy = (_positive("spacing", steps[axis], "m") for axis in (0, 1))
    check_load(pressure, speed)
    _single_number("poisson_ratio", poisson_ratio)
    check_poisson_ratio(poisson_ratio)
    if layer_thickness is not None:
        _positive("layer_thickness", layer_thickness, "m")
    _check_memory(h, members)
    return h, (dx, dy)


def check_load(pressure: float, speed: float) -> None:
    """Refuse a pressure (Pa) that is not above zero, and a speed (m/s) that is not finite."""
    _positive("pressure", pressure, "Pa")
    _single_number("speed", speed)
    if not math.isfinite(speed):
        raise InputError(f"speed {speed} m/s", where="speed", allowed="a finite speed, m/s")


def batch_size(points: int, free: int | None) -> int:
    """Return how many contacts of so many points a batch holds: its points fill a card, and fit."""
    fits = _BATCH if free is None else free // (8 * BATCH_ARRAYS)
    return max(min(_BATCH, fits) // max(points, 1), 1)


def _check_memory(height: AnyArray, members: int) -> None:
    """Refuse a grid that does not fit beside what is in memory where it lies."""
    points, free = math.prod(height.shape), free_memory(height)
    arrays = ARRAYS if members == 1 else members * BATCH_ARRAYS
    needed = 8 * arrays * points
    if free is not None and needed > free:
        side = math.isqrt(free // (8 * arrays))
        raise InputError(
            f"a contact of {points} points takes {needed / 1e9:.1f} GB, "
            f"{free / 1e9:.1f} GB are free on {getattr(height, 'device', 'cpu')}",
            where="height",
            allowed=f"{needed} bytes free, {arrays} double arrays of the grid",
            remedy=f"Take a coarser grid (about {side} x {side} points fit)",
        )


def modulus_function(modulus: Modulus, frequencies: AnyArray) -> Callable[[AnyArray], AnyArray]:
    """Return E*(w) as a vectorised function, after checking it at ``frequencies`` (rad/s)."""
    if isinstance(modulus, int | float | np.integer | np.floating):
        value = _positive("modulus", float(modulus), "Pa")
        return lambda w: np.full(np.shape(w), value, dtype=complex)
    call = getattr(modulus, "complex_modulus", modulus)
    if not callable(call):
        raise InputError(
            f"modulus is a {type(modulus).__name__}",
            where="modulus",
            allowed="a number (Pa), a material with complex_modulus, or a callable E*(rad/s)",
        )

    def young(w: AnyArray) -> AnyArray:
        answer = call(np.asarray(w, dtype=float))
        values = host_array(answer, "modulus", "E* as an array of NumPy").astype(complex)
        return np.broadcast_to(values, np.shape(w))

    values = young(frequencies)
    wrong = ~(np.isfinite(values) & (values.real > 0.0))
    if np.any(wrong):
        at = int(np.flatnonzero(wrong)[0])
        raise InputError(
            f"E* = {values[at]:.4g} Pa at {frequencies[at]:.4g} rad/s",
            where="modulus",
            allowed="a finite modulus with a positive real part at every frequency, 0 included",
            remedy="A liquid (no equilibrium modulus) can't carry the mean pressure; "
            "a fitted spectrum must not have negative terms",
        )
    if np.any(values.imag < -1e-9 * values.real):
        at = int(np.argmin(values.imag / values.real))
        raise InputError(
            f"E* = {values[at]:.4g} Pa at {frequencies[at]:.4g} rad/s gives energy back",
            where="modulus",
            allowed="a loss modulus E'' >= 0 (convention E' + i E'')",
            remedy="Take the conjugate if your convention is E' - i E''",
        )
    return young


def loss_reason(moduli: AnyArray, frequencies: AnyArray) -> str:
    """Return why the hysteresis is (nearly) zero if the material hardly loses energy, else "".

    ``moduli`` are E* (Pa) at ``frequencies`` (rad/s).
    """
    w, values = frequencies[frequencies > 0.0], moduli[frequencies > 0.0]
    if w.size == 0:
        return ""
    tangent = float(np.max(values.imag / values.real))
    if tangent >= _NEGLIGIBLE_LOSS_TANGENT:
        return ""
    low, high = (display(x / (2.0 * math.pi), "Hz") for x in (w.min(), w.max()))
    return (
        f"hysteresis is negligible because the material is: its loss tangent is at most "
        f"{tangent if tangent >= 1e-6 else 0:.1g} between {low} and {high}, the frequencies this "
        "surface excites at this speed; a spectrum with relaxation times near those is needed"
    )


@dataclass(frozen=True, slots=True)
class SlowTransform:
    """A grid whose Fourier transform is slow: a side has a prime factor of 13 or more.

    ``better`` is the next grid whose sides have none and halve four times, for the coarser grids
    on which a contact starts.
    """

    shape: tuple[int, int]
    better: tuple[int, int]

    def __str__(self) -> str:
        given, better = ("{} x {}".format(*sides) for sides in (self.shape, self.better))
        return (
            f"the Fourier transform of {given} points is slow (a prime factor of 13 or more): the "
            f"next good size is {better}"
        )


def slow_transform(shape: tuple[int, int]) -> SlowTransform | None:
    """Return that the transform of a grid is slow, None where it isn't or the grid is small."""
    from scipy.fft import next_fast_len

    def good(n: int) -> int:
        if next_fast_len(n) == n:
            return n
        return _HALVED * cast(int, next_fast_len(-(-n // _HALVED)))

    better = good(shape[0]), good(shape[1])
    small = shape[0] * shape[1] < _SMALL
    return None if small or better == shape else SlowTransform(shape, better)


def resolution_breaches(rms_slope: float, short_share: float, nodes: int) -> list[Breach]:
    """Return whether slopes are too steep for the theory or too short for the grid, and whether
    the contact (``nodes`` in contact) is too small for it.
    """
    values = dict(zip(_RANGES, (rms_slope, short_share), strict=True))
    enough = ValidityRange(
        FEWEST_NODES, math.inf, "1", "resolution of the contact itself, limit assumed"
    )
    return [
        *breaches("steady_sliding", _RANGES, values),
        *breaches("steady_sliding", {"nodes in contact": enough}, {"nodes in contact": nodes}),
    ]


def _as_floats(height: Any) -> tuple[Any, bool]:
    """Return heights in double precision, left on their device if not NumPy's; are all finite?"""
    refused = {
        "where": "height",
        "allowed": "an array of heights, m",
        "remedy": "Give the heights of a map: map.heights",
    }
    if type(height).__module__.partition(".")[0] not in ("torch", "cupy", "array_api_strict"):
        height = host_array(height, **refused)
    xp = namespace(height)
    if xp.isdtype(height.dtype, "complex floating"):
        raise InputError(f"the heights are complex ({height.dtype})", **refused)
    if xp.isdtype(height.dtype, "bool"):
        raise InputError("the heights are true or false, no lengths", **refused)
    if getattr(height, "requires_grad", False):
        refused["remedy"] = "Give height.detach(): a contact has no derivative by its heights"
        raise InputError("the heights ask for their gradient", **refused)
    try:
        floats = xp.astype(height, xp.float64, copy=False)
        return floats, bool(xp.all(xp.isfinite(floats)))
    except (TypeError, ValueError, RuntimeError) as error:
        what = f"the heights ({type(height).__name__} of {height.dtype}) can't be read as doubles"
        raise InputError(Message("{what} ({error})", what=what, error=error), **refused) from error


def _single_number(name: str, value: Any) -> None:
    if np.ndim(value) == 0 and isinstance(value, int | float | np.number | np.ndarray):
        return
    several = np.ndim(value) > 0
    raise InputError(
        f"{math.prod(np.shape(value))} values"
        if several
        else f"{value!r} is a {type(value).__name__}",
        where=name,
        allowed="one number",
        remedy="Call it once for each; ContactTable.from_surfaces makes a table over pressures "
        "and speeds"
        if several
        else None,
    )


def _positive(name: str, value: float, unit: str) -> float:
    _single_number(name, value)
    return positive(value, name, unit)
