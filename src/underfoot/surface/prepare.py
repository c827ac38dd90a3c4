"""Fill missing heights, remove form, make a map periodic; each says what it did."""

from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, InputError
from underfoot.core.remark import Message
from underfoot.core.unit_text import metres

from .heights import HeightMap, Heights

Surface = TypeVar("Surface", bound=Heights)
SPIKE = 10.0
"""Robust standard deviations by which a dead point stands out of its neighbours."""


def fill_missing_heights(
    heights: ArrayLike, *, largest_share: float = 0.05
) -> tuple[np.ndarray, str]:
    """Return heights with missing ones filled, and a line that says how many.

    Profiles are interpolated linearly; maps linearly between their neighbours, and by the
    nearest one at the rim. More than ``largest_share`` missing is refused: the result would be
    invented.

    Raises:
        DataError: Too many heights missing.
    """
    z = np.array(heights, dtype=float)
    missing = ~np.isfinite(z)
    count = int(missing.sum())
    if count == 0:
        return z, "no heights were missing"
    if count > largest_share * z.size:
        raise DataError(
            Message(
                "{count} of {total} heights are missing ({percent:.1f} %)",
                count=count,
                total=z.size,
                percent=100 * count / z.size,
            ),
            where="heights",
            allowed=Message("up to {largest_share:g} %", largest_share=100 * largest_share),
            remedy="Measure again, cut the part away, or raise the share knowingly",
        )
    if z.ndim == 1:
        x = np.arange(z.size)
        z[missing] = np.interp(x[missing], x[~missing], z[~missing])
    else:
        from scipy.interpolate import griddata
        from scipy.ndimage import binary_dilation

        # what lies around the gaps decides; all heights of a large map would take minutes
        near = binary_dilation(missing, iterations=2) & ~missing
        known, gaps = np.argwhere(near), np.argwhere(missing)
        values = griddata(known, z[near], gaps, method="linear")
        rim = ~np.isfinite(values)
        if rim.any():
            values[rim] = griddata(known, z[near], gaps[rim], method="nearest")
        z[missing] = values
    return z, Message("{count} of {size} missing heights interpolated", count=count, size=z.size)


def held_level(heights: ArrayLike) -> tuple[float, float]:
    """Return which share of the heights is one number, and the number; (0, 0) of usual heights.

    That number stands in 1 % of the points and more, and five times as often as any of the three
    numbers on either side: missing heights written as one, or the end of an instrument's range.
    The steps of an instrument are as frequent as their neighbours.
    """
    values, counts = np.unique(np.asarray(heights, dtype=float), return_counts=True)
    k = int(counts.argmax())
    beside = np.concatenate([counts[max(k - 3, 0) : k], counts[k + 1 : k + 4]])
    share = float(counts[k] / counts.sum())
    if len(values) < 8 or share < 0.01 or counts[k] < 5 * beside.max():
        return 0.0, 0.0
    return share, float(values[k])


def level_surface(surface: Surface, degree: int = 1) -> Surface:
    """Return the surface without its least squares polynomial of ``degree`` in x (and y).

    0 removes the mean, 1 the line or plane, 2 and more also a curved form; on a map all terms up
    to the total degree.

    Raises:
        InputError: Degree negative, or more coefficients than heights.
    """
    if degree < 0:
        raise InputError(
            Message("degree {degree}", degree=degree), where="degree", allowed="0 or more"
        )
    z = surface.heights
    axes = [np.linspace(-1.0, 1.0, n) for n in z.shape]
    if surface.axes == 1:
        basis = np.polynomial.legendre.legvander(axes[0], degree)
    else:
        x, y = np.meshgrid(axes[0], axes[1], indexing="ij")
        full = np.polynomial.legendre.legvander2d(x, y, [degree, degree])
        total = np.add.outer(np.arange(degree + 1), np.arange(degree + 1)).ravel()
        basis = full.reshape(z.size, -1)[:, total <= degree]
    if basis.shape[1] >= z.size:
        raise InputError(
            Message("{shape} coefficients for {size} heights", shape=basis.shape[1], size=z.size),
            where="degree",
            allowed="fewer",
        )
    coefficients, *_ = np.linalg.lstsq(basis, z.ravel(), rcond=None)
    form = {0: "mean", 1: "line" if z.ndim == 1 else "plane"}.get(
        degree, Message("polynomial of degree {degree}", degree=degree)
    )
    rest = (z.ravel() - basis @ coefficients).reshape(z.shape)
    return surface.replace_heights(rest, Message("least squares {form} removed", form=form))


def without_spikes(surface: Surface) -> tuple[Surface, Surface]:
    """Return a surface with dead points interpolated, which it says, and the same levelled.

    Dead: a point that stands ten robust standard deviations out of its neighbours.
    """
    from scipy.ndimage import median_filter

    flat = level_surface(surface)
    z = flat.heights
    robust = 1.4826 * float(np.median(np.abs(z - np.median(z))))
    dead = np.abs(z - median_filter(z, size=5, mode="nearest")) > SPIKE * robust
    if not dead.any() or robust == 0.0:
        return surface, flat
    marked = np.where(dead, np.nan, surface.heights)
    heights, _ = fill_missing_heights(marked)
    count = int((~np.isfinite(marked)).sum())
    whole = surface.replace_heights(
        heights,
        Message(
            "{count} of {size} points stand out of their neighbours (dead pixels) and are "
            "interpolated",
            count=count,
            size=dead.size,
        ),
    )
    return whole, level_surface(whole)


def square_cells(surface: HeightMap) -> HeightMap:
    """Return a map of square cells; oblong ones are divided along their longer side by splines.

    Nothing shorter than the coarser spacing resolves is added; ``resolution`` says so.
    """
    from scipy.interpolate import make_interp_spline

    fine, coarse = min(surface.spacings), max(surface.spacings)
    if fine == coarse:
        return surface
    axis = surface.spacings.index(coarse)
    n = surface.shape[axis]
    z = np.moveaxis(surface.heights, axis, 0)
    if surface.periodic:
        count = round(
            n * coarse / fine
        )  # a whole number of cells: stretched by half of one at most
        z, at, between = np.concatenate([z, z[:1]]), np.arange(n + 1), np.arange(count) * n / count
    else:
        at, between = np.arange(n), np.arange(0.0, (n - 1) * (1 + 1e-12), fine / coarse)
    spline = make_interp_spline(
        at, z, k=min(3, n - 1), bc_type="periodic" if surface.periodic else None
    )
    return surface.replace_heights(
        np.moveaxis(spline(between), 0, axis),
        Message(
            "oblong cells of {across} by {along} made square",
            across=metres(surface.spacings[0]),
            along=metres(surface.spacings[1]),
        ),
        spacing=fine,
        spacing_y=None,
        resolution=max(surface.resolution or 0.0, 2.0 * coarse),
    )


METHODS = ("taper", "mirror")


def make_periodic(surface: HeightMap, method: str = "taper", *, share: float = 0.1) -> HeightMap:
    """Return a periodic map made from one that is not; a periodic one comes back unchanged.

    - "taper": the plane is removed and the heights are faded to their mean over ``share`` of each
      side with a cosine. The rim is smoother and lower than the surface: rms height falls by
      about 0.63 ``share`` a side, and contact numbers of the rim don't count.
    - "mirror": the plane is removed and the map is continued by its mirror image along both axes
      (four times as many points). Heights keep their distribution; slopes change sign at the
      seams, and directions that are not along an axis get mirrored partners.

    What was done, with the rms height before and after, stands in ``processing``.

    Raises:
        InputError: Another method; ``share`` outside 0 to 0.5.
    """
    if surface.periodic:
        return surface
    if method not in METHODS:
        raise InputError(f'"{method}"', where="method", allowed=", ".join(METHODS))
    flat = level_surface(surface, 1)
    z = flat.heights
    if method == "mirror":
        closed = np.concatenate([z, z[::-1]], axis=0)
        closed = np.concatenate([closed, closed[:, ::-1]], axis=1)
        note = "made periodic by mirroring along both axes"
    else:
        if not 0.0 < share <= 0.5:
            raise InputError(
                f"share {share:g}", where="share", allowed="above 0, at most 0.5 of a side"
            )
        closed = z * np.outer(*(_fade(n, share) for n in z.shape))
        note = f"made periodic by a cosine taper over {100 * share:g} % of each side"
    return flat.replace_heights(
        closed,
        f"{note}; rms height {metres(float(np.std(z)))} before, "
        f"{metres(float(np.std(closed)))} after",
        periodic=True,
    )


def _fade(n: int, share: float) -> np.ndarray:
    from_end = np.minimum(np.arange(n), np.arange(n)[::-1]) + 0.5
    reach = np.clip(from_end / (share * n), 0.0, 1.0)
    return 0.5 - 0.5 * np.cos(np.pi * reach)
