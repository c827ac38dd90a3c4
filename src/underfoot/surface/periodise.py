"""Make a measured map periodic, saying what was done."""

import numpy as np

from underfoot.core import InputError
from underfoot.core.units import metres

from .height_map import HeightMap
from .prepare import levelled

METHODS = ("taper", "mirror")


def periodised(surface: HeightMap, method: str = "taper", *, share: float = 0.1) -> HeightMap:
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
    flat = levelled(surface, 1)
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
    return flat.changed(
        closed,
        f"{note}; rms height {metres(float(np.std(z)))} before, "
        f"{metres(float(np.std(closed)))} after",
        periodic=True,
    )


def _fade(n: int, share: float) -> np.ndarray:
    from_end = np.minimum(np.arange(n), np.arange(n)[::-1]) + 0.5
    reach = np.clip(from_end / (share * n), 0.0, 1.0)
    return 0.5 - 0.5 * np.cos(np.pi * reach)
