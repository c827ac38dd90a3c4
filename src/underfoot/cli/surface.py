"""``underfoot surface``: roughness of a scan, and the lines of a case that take it."""

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from underfoot.core.remark import Message

from .options import Shared, optional, sharing


@sharing(without=("quick", "set_", "processes", "catalogue", "out"))
def surface(
    shared: Shared,
    scan: Annotated[Path, typer.Argument(help="Scan of a floor or sole: profile or map.")],
    out: Annotated[
        Path | None,
        optional("Folder for data, figures and report.html; or the heights as .x3p or .sdf."),
    ] = None,
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

    Dektak CSV, GSF, X3P, SDF, text (positions and heights, x y z, or a matrix; decimal commas),
    arrays of NumPy, and the formats of instruments that SurfaceTopography reads.
    """
    from underfoot.core import InputError, to_si
    from underfoot.surface import Scan, read_scan, write_surface
    from underfoot.surface.write import FORMS

    from .output import answer

    def length(name: str, text: str | None) -> float | None:
        return to_si(text, "m", where=f"--{name}") if text else None

    lengths = {"cutoff": length("cutoff", cutoff), "spacing": length("spacing", spacing)}
    read = partial(read_scan, scan, length_unit=length_unit, height_unit=height_unit, **lengths)
    file = out if out is not None and out.suffix.casefold() in FORMS else None
    if file is not None and file.exists() and not shared.overwrite:
        raise InputError(
            Message("{out} exists", out=out), where="--out", remedy="Add --overwrite to replace it"
        )

    def make_scan() -> Scan:
        found = read()
        if file is not None:
            write_surface(found.surface, file)
        return found

    answer(
        scan.name,
        lambda progress: make_scan(),
        out=None if file is not None else out,
        overwrite=shared.overwrite,
        json=shared.json,
        everything=shared.everything,
    )
    if shared.json:
        return
    if file is not None:
        print(f"\nwrote {file}: the heights as they were read, in double precision")
    print("\nA case beside it takes the scan with these lines ([shoe.roughness] for a sole):\n")
    print("[floor.roughness]")
    given = {"file": scan.name, "cutoff": cutoff, "spacing": spacing}
    for name, value in (given | {"length_unit": length_unit, "height_unit": height_unit}).items():
        if value:
            print(f'{name} = "{value}"')
