"""Fields of the 3-D viewer, read as its page reads them."""

import base64
import zlib

import numpy as np


def unpacked(stored, shape):
    """The array of ``viewer.packed`` again, as the page reads it."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(stored["data"])), np.uint8)
    halves = np.ascontiguousarray(planes.reshape(2, -1).T).view("<f2").reshape(shape)
    return halves.astype(float) * stored["scale"]
