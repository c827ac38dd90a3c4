"""``underfoot export``: a result, or the sole of a case, for CAD and other programs."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from underfoot.core.remark import Message

from .options import Overwrite

if TYPE_CHECKING:
    from underfoot.case import Case


class ExportKind(StrEnum):
    """Kinds of file."""

    GLB = "glb"
    PLY = "ply"
    OBJ = "obj"
    VTU = "vtu"
    CSV = "csv"
    STEP = "step"
    INP = "inp"


def export(
    run: Annotated[
        Path,
        typer.Argument(
            metavar="RUN",
            help="Result folder of underfoot run; for step also a case file.",
        ),
    ],
    to: Annotated[ExportKind, typer.Option("--to", help="Kind of file.")],
    field: Annotated[
        str | None,
        typer.Option("--field", help="What the colours show, as fluid_pressure."),
    ] = None,
    pressed: Annotated[
        bool, typer.Option("--pressed", help="The sole under load, not undeformed.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="File; by default sole.KIND in the folder."),
    ] = None,
    overwrite: Overwrite = False,
) -> None:
    """Write the sole with its fields as GLB, PLY, OBJ, VTU or CSV, or the worn solid as STEP.

    GLB is in m and upright (y up); PLY, OBJ and STEP are in mm; VTU and CSV hold values in SI. INP
    is the sole under its load for Abaqus and CalculiX, in N, mm and MPa.
    """
    from underfoot.case import Case
    from underfoot.compute.result import Result
    from underfoot.core import InputError
    from underfoot.report.sole_export import export_result
    from underfoot.report.solver_input import write_solver_input

    folder = run if run.is_dir() else run.parent
    path = out or folder / f"{'sole' if run.is_dir() else run.stem}.{to}"
    if path.exists() and not overwrite:
        raise InputError(
            Message("{out} exists", out=path),
            where="--out",
            remedy="Choose another name, or add --overwrite.",
        )
    if path.suffix.lower().lstrip(".") not in (to, "stp"):
        raise InputError(
            f'"{path.name}" does not end with .{to}', where="--out", allowed=f"a name with .{to}"
        )
    if to is ExportKind.STEP:
        _write_solid(Case.load(run / "case.toml" if run.is_dir() else run), path)
        return
    if not run.is_dir():
        raise InputError(
            f"{run} is no result folder",
            where="underfoot export",
            allowed="a folder that underfoot run made; a case file with --to step",
            remedy=f"First: underfoot run {run}",
        )
    if to is ExportKind.INP:
        print(f"wrote {write_solver_input(Result.load(run), path).sentence()}")
        return
    written = export_result(Result.load(run), path, field=field, pressed=pressed)
    print(f"wrote {written.sentence()}")


def _write_solid(case: "Case", path: Path) -> None:
    from underfoot.compute.sole import sole_shape
    from underfoot.core import InputError
    from underfoot.shoe.parametric import write_sole

    if case.shoe.outsole is not None:
        raise InputError(
            f"the sole is that of the file {Path(case.shoe.outsole.file).name}: it has no other "
            "solid",
            where="--to step",
            allowed="a parametric sole (shoe.heel and shoe.tread)",
            remedy="The file itself is the new sole; --to glb or ply shows it worn and with fields",
        )
    written = write_sole(sole_shape(case), path)
    state = f"worn by {case.shoe.wear.depth * 1e3:g} mm" if case.shoe.wear.depth else "new"
    print(f"wrote {path}: lengths in mm, {state}, {written.volume * 1e6:.2f} cm3")
    for remark in written.remarks:
        print(f"note: {remark}")
