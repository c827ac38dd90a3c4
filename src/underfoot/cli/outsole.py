"""``underfoot outsole ...``: outsoles from files, and files from a few lengths."""

from pathlib import Path
from shlex import quote
from typing import Annotated

import typer

from .guard import guard_command
from .options import AsJson, Overwrite, ShowAll
from .output import answer
from .outsole_make import make

outsole_app = typer.Typer(
    name="outsole",
    help="Inspect outsole files (CAD, meshes, scans) and make parametric ones.",
    no_args_is_help=True,
)
Direction = Annotated[
    str, typer.Option(metavar="+x|-x|+y|-y|+z|-z|flip", help="In the file's axes; auto finds it.")
]


@outsole_app.callback()
def outsole() -> None:
    """Inspect outsole files (CAD, meshes, scans) and make parametric ones."""


def inspect(
    file: Annotated[
        Path,
        typer.Argument(help="STEP, IGES, BREP, 3DM, STL, OBJ, PLY, OFF, GLB or 3MF."),
    ],
    unit: Annotated[str, typer.Option(help="auto, mm, cm, m or inch.")] = "auto",
    down: Direction = "auto",
    forward: Direction = "auto",
    foot: Annotated[str, typer.Option(help="Foot the file shows: auto, left, right.")] = "auto",
    mirror: Annotated[bool, typer.Option("--mirror", help="Take the other of the pair.")] = False,
    region: Annotated[str, typer.Option(help="whole, heel or forepart.")] = "whole",
    region_length: Annotated[str | None, typer.Option(help='Of the region, as "80 mm".')] = None,
    spacing: Annotated[str, typer.Option(help="Of the height map.")] = "0.25 mm",
    solid: Annotated[str | None, typer.Option(help="Name of the body that is the outsole.")] = None,
    side: Annotated[str, typer.Option(help="Of a pair in one file: left or right.")] = "auto",
    cut_floor: Annotated[bool, typer.Option("--cut-floor", help="Cut a floor plane.")] = False,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for picture, tables and a case file."),
    ] = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
) -> None:
    """Measure the tread of an outsole file; list what was determined, assumed and repaired.

    With --out: report.html, outsole.png, measures.csv, heights.csv.gz and a case named after
    the sole, ready to run.
    """
    from underfoot.core import to_si
    from underfoot.report.outsole import case_text, inspect_outsole
    from underfoot.report.writing import write_text
    from underfoot.shoe.files import FileSettings

    case = f"{file.stem}.toml"  # a run of it has the sole's name too
    length = None if region_length is None else to_si(region_length, "m", where="--region-length")
    settings = FileSettings(
        unit=unit,
        down=down,
        forward=forward,
        foot=foot,
        mirror=mirror,
        region=region,
        region_length=length,
        spacing=to_si(spacing, "m", where="--spacing"),
        solid=solid,
        side=side,
        cut_floor=cut_floor,
    )
    answer(
        file.name,
        lambda progress: inspect_outsole(file, settings),
        out=out,
        overwrite=overwrite,
        json=json,
        everything=everything,
        further=lambda inspection, folder: {case: write_text(case_text(inspection, folder))},
    )
    if out is not None and not json:
        # each inspection has a folder of its own, and so has the run of its case: soles in two
        # folders may have one name
        inside = not out.is_absolute() and ".." not in out.parts
        results = Path("out") / out if inside else out / "run"
        into = "" if results == Path("out") / file.stem else f" --out {quote(str(results))}"
        print(f"Next: underfoot run {quote(str(out / case))}{into}")


outsole_app.command()(guard_command(inspect))
outsole_app.command()(guard_command(make))
