"""Connected pieces of masks and their neighbourhoods, with plain types."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask

Labels = NDArray[np.intp]


def pieces(mask: Mask, *, diagonal: bool = False) -> tuple[Labels, int]:
    """Return the number of the connected piece of each cell (0 outside) and how many there are."""
    from scipy import ndimage

    structure = np.ones((3, 3)) if diagonal else None
    labelled: Any = ndimage.label(mask, structure=structure)
    return np.asarray(labelled[0], dtype=np.intp), int(labelled[1])


def grown(mask: Mask, steps: int) -> Mask:
    """Return the mask and its neighbours within ``steps`` cells along the axes."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_dilation(mask, iterations=steps), dtype=np.bool_)


def shrunk(mask: Mask, steps: int) -> Mask:
    """Return the cells of the mask that are more than ``steps`` cells from its edge."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_erosion(mask, iterations=steps), dtype=np.bool_)


def without_holes(mask: Mask) -> Mask:
    """Return the mask with all that it encloses."""
    from scipy import ndimage

    return np.asarray(ndimage.binary_fill_holes(mask), dtype=np.bool_)


def rim(mask: Mask, steps: int = 1) -> Mask:
    """Return the cells of the mask within ``steps`` cells of the outside or the array's edge."""
    return mask & grown(~np.pad(mask, 1), steps)[1:-1, 1:-1]


def without_specks(mask: Mask, fewest: int) -> Mask:
    """Return the mask without connected pieces of fewer cells."""
    numbers, count = pieces(mask)
    if count == 0:
        return mask
    keep = np.bincount(numbers.ravel()) >= fewest
    keep[0] = False
    return keep[numbers]


def distance_within(mask: Mask) -> Array:
    """Return the distance (cells) to the nearest cell outside; beyond the array is outside."""
    from scipy import ndimage

    distance: Any = ndimage.distance_transform_edt(np.pad(mask, 1))
    return np.asarray(distance, dtype=np.float64)[1:-1, 1:-1]


def distance_to(mask: Mask) -> Array:
    """Return the distance (cells) to the nearest cell of the mask."""
    from scipy import ndimage

    distance: Any = ndimage.distance_transform_edt(~mask)
    return np.asarray(distance, dtype=np.float64)
