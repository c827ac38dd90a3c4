"""Fillets in a process of their own: where the kernel fails it may end the volume program.

Run as ``python -m underfoot.shoe.parametric.rounding IN OUT fillet|chamfer MM EDGE ...`` with BREP
files and the indices of edges in the order of the shape.
"""

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .modelling import MM, kernel

LONGEST = 120.0
"""s, after which the attempt is given up."""


def round_edges(
    body: Any, edges: Sequence[int], radius: float, *, chamfer: bool = False
) -> Any | None:
    """Return the body with fillets of ``radius`` (m) on the edges of these indices.

    ``chamfer``: flat at 45 degrees instead, of that width.

    None where the kernel cannot make them: they don't fit, or it does not end.
    """
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder) / "before.brep", Path(folder) / "after.brep"
        body.WriteBrep(str(before), withTriangles=False, withNormals=False)
        kind = "chamfer" if chamfer else "fillet"
        command = [sys.executable, "-m", __name__, str(before), str(after), kind, repr(radius * MM)]
        try:
            subprocess.run(
                [*command, *(str(index) for index in edges)],
                capture_output=True,
                timeout=LONGEST,
                check=True,
            )
        except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
            return None
        rounded_body = kernel().OCCGeometry(str(after)).shape
    volume = float(body.mass)
    return rounded_body if 0.5 * volume < float(rounded_body.mass) < 1.0001 * volume else None


def main(arguments: Sequence[str]) -> None:
    """Read, round, write."""
    before, after, kind, radius, *indices = arguments
    body = kernel().OCCGeometry(before).shape
    edges = list(body.edges)
    make = body.MakeChamfer if kind == "chamfer" else body.MakeFillet
    rounded_body = make([edges[int(index)] for index in indices], float(radius))
    rounded_body.WriteBrep(after, withTriangles=False, withNormals=False)


if __name__ == "__main__":
    main(sys.argv[1:])
