"""``underfoot surface``: roughness of a scan, and the lines of a case that take it."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from .options import Shared, optional, sharing


@sharing(without=("quick", "set_", "processes", "catalogue"))
def surface(
    shared: Shared,
    scan: Annotated[
        Path, typer.Argument(help="Scan of a floor or sole: profile or map.", show_default=False)
    ],
    cutoff: Annotated[
        str | None, optional('Cut-off wavelength, as "0.8 mm"; else the longest that fits.')
    ] = None,
    length_unit: Annotated[
        str | None, optional("Of positions, where the file does not say: mm, um.")
    ] = None,
    height_unit: Annotated[
        str | None, optional("Of heights, where the file does not say: um, nm.")
    ] = None,
    spacing: Annotated[
        str | None, optional('Between points, where the file has no positions: "4 um".')
    ] = None,
) -> None:
    """Ra, Rq, Rz, slope, spectrum and Hurst exponent of a scan; a case takes it as it is.

    Dektak CSV, GSF, X3P, SDF, text (positions and heights, x y z, or a matrix; decimal commas), and
    the formats of instruments that SurfaceTopography reads.
    """
    from underfoot.core import to_si
    from underfoot.surface import read_scan

    def length(name: str, text: str | None) -> float | None:
        return to_si(text, "m", where=f"--{name}") if text else None

    lengths = {"cutoff": length("cutoff", cutoff), "spacing": length("spacing", spacing)}
    read = partial(read_scan, scan, length_unit=length_unit, height_unit=height_unit, **lengths)
    shared.answer(scan.name, lambda progress: read())
    if shared.json:
        return
    print("\nA case beside it takes the scan with these lines ([shoe.roughness] for a sole):\n")
    print("[floor.roughness]")
    given = {"file": scan.name, "cutoff": cutoff, "spacing": spacing}
    for name, value in (given | {"length_unit": length_unit, "height_unit": height_unit}).items():
        if value:
            print(f'{name} = "{value}"')
