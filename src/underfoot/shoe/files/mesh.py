"""Triangles as a file holds them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Mesh:
    """Triangles as a file holds them.

    Parameters:
        triangles: (n, 3, 3) float32: triangle, corner, coordinate, in the unit of the file.
        format: "STL (binary)", "STL (text)", "STEP", "OBJ" and so on.
        unit: Length of the file's unit in m, None when the format does not say.
        remarks: Remarks of the reader, sentences.
        bodies: Names of the bodies in the file, "" where it has none; () when it tells no bodies.
        body: (n,) number of the body of each triangle; None when the file tells no bodies.
    """

    triangles: NDArray[np.float32]
    format: str
    unit: float | None = None
    remarks: tuple[str, ...] = ()
    bodies: tuple[str, ...] = ()
    body: NDArray[np.int32] | None = None
