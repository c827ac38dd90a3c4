"""Triangles as a file holds them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Mesh:
    """Triangles as a file holds them.

    Parameters:
        triangles: (n, 3, 3) float32: triangle, corner, coordinate, in the unit of the file.
        format: "STL (binary)", "STL (text)", "STEP", "OBJ" or "PLY".
        unit: Length of the file's unit in m, None when the format does not say.
        remarks: Remarks of the reader, sentences.
    """

    triangles: NDArray[np.float32]
    format: str
    unit: float | None = None
    remarks: tuple[str, ...] = ()
