"""``underfoot outsole ...``: outsoles from files, and files from a few lengths."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .guard import guarded
from .options import AsJson, Overwrite
from .outsole_make import make

if TYPE_CHECKING:
    from underfoot.outsole.files import FileOutsole, FileSettings
    from underfoot.outsole.tread_measures import TreadMeasures

outsole_app = typer.Typer(
    name="outsole",
    help="Outsoles: look into STEP, STL, OBJ and PLY files, or make some.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
Direction = Annotated[
    str, typer.Option(metavar="+x|-x|+y|-y|+z|-z|flip", help="In the file's axes; auto finds it.")
]


@outsole_app.callback()
def outsole() -> None:
    """Outsoles: look into STEP, STL, OBJ and PLY files, or make some."""


def inspect(
    file: Annotated[Path, typer.Argument(help="STEP, STL, OBJ or PLY.", show_default=False)],
    unit: Annotated[str, typer.Option(help="auto, mm, cm, m or inch.")] = "auto",
    down: Direction = "auto",
    forward: Direction = "auto",
    foot: Annotated[str, typer.Option(help="Foot the file shows: auto, left, right.")] = "auto",
    mirror: Annotated[bool, typer.Option("--mirror", help="Take the other of the pair.")] = False,
    region: Annotated[str, typer.Option(help="whole, heel or forepart.")] = "whole",
    region_length: Annotated[
        str | None, typer.Option(help='Of the region, as "80 mm".', show_default=False)
    ] = None,
    spacing: Annotated[str, typer.Option(help="Of the height map.")] = "0.25 mm",
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for picture, tables and a case file.", show_default=False),
    ] = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Read an outsole file: size, what was found, assumed and repaired, measures of its tread.

    With --out: outsole.png, measures.csv, heights.csv.gz, and case.toml, ready to run.
    """
    from underfoot.core import to_si
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.outsole.files import FileSettings, outsole_from_file
    from underfoot.outsole.tread_measures import tread_measures

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
    )
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    found = outsole_from_file(file, settings)
    measures = tread_measures(found.surface)
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            _write(staging, out, file, settings, found, measures)
    if json:
        import json as json_text

        print(json_text.dumps(as_data(file, found, measures), indent=2, ensure_ascii=False))
        return
    _show(file, found, measures, out)


outsole_app.command()(guarded(inspect))
outsole_app.command()(guarded(make))


def as_data(file: Path, found: FileOutsole, measures: TreadMeasures) -> dict[str, Any]:
    """Return what was found as plain data in SI; what there is none of is None."""
    from dataclasses import asdict

    return {
        "file": str(file),
        "format": found.format,
        "faces": found.faces,
        "unit_m": found.unit,
        "down": found.down,
        "forward": found.forward,
        "foot": found.foot or None,
        "whole_length": found.whole_length,
        "thickness": found.thickness,
        "mesh": asdict(found.soundness),
        "measures": asdict(measures),
        "remarks": list(found.surface.remarks),
    }


def rows(measures: TreadMeasures) -> list[tuple[str, str]]:
    """Return (name, value with unit) of every measure, for people."""

    def spread(values: tuple[float, float, float] | None, factor: float, unit: str) -> str:
        if values is None:
            return "none"
        low, middle, high = (value * factor for value in values)
        return f"{middle:.3g} {unit}  (10 to 90 %: {low:.3g} to {high:.3g})"

    drained = measures.drained_share
    return [
        ("Length x width", f"{measures.length * 1e3:.4g} x {measures.width * 1e3:.4g} mm"),
        ("Plan area", f"{measures.plan_area * 1e4:.4g} cm²"),
        ("Land", f"{measures.land_ratio:.0%} of it"),
        ("Channel depth, median", spread(measures.channel_depth, 1e3, "mm")),
        ("Channel width, median", spread(measures.channel_width, 1e3, "mm")),
        ("Channels open to the rim", "none" if drained is None else f"{drained:.0%} of their area"),
        ("Lugs", f"{measures.lug_count}"),
        ("Lug area, median", spread(measures.lug_area, 1e6, "mm²")),
        ("Largest untreaded patch", f"{measures.patch_area * 1e6:.4g} mm²"),
        (
            "  length x width",
            f"{measures.patch_length * 1e3:.3g} x {measures.patch_width * 1e3:.3g} mm",
        ),
        ("  largest circle in it", f"{measures.patch_circle * 1e3:.3g} mm"),
        ("Largest circle without channel", f"{measures.free_circle * 1e3:.3g} mm"),
    ]


def _show(file: Path, found: FileOutsole, measures: TreadMeasures, out: Path | None) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    console.print(f"\n{file.name}: {found.format}, {found.faces} faces", style="bold", markup=False)
    table = Table(box=None, show_header=False, pad_edge=False)
    for name, value in rows(measures):
        table.add_row(name, value)
    if found.thickness is not None:
        table.add_row("Thickness over the land, median", f"{found.thickness * 1e3:.3g} mm")
    console.print(table)
    console.print("\nFound, assumed and repaired:")
    for line in found.surface.remarks:
        console.print(f"  - {line}", markup=False)
    if out is not None:
        console.print(
            f"\nFiles in {out}; look at {out / 'outsole.png'}, then: underfoot check "
            f"{out / 'case.toml'}",
            markup=False,
        )


def _write(
    folder: Path,
    out: Path,
    file: Path,
    settings: FileSettings,
    found: FileOutsole,
    measures: TreadMeasures,
) -> None:
    import csv

    import numpy as np

    from underfoot.document.outsole_figure import outsole_figure

    outsole_figure(found.surface, measures).savefig(folder / "outsole.png", dpi=110)
    with (folder / "measures.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["measure", "value"])
        for name, value in _flat(as_data(file, found, measures)["measures"]):
            writer.writerow([name, "" if value is None else f"{value:.6g}"])
    surface = found.surface
    # np.savetxt compresses by the ending; rows run from the heel to the toe
    header = (
        f"height above the sole plane (mm), nan outside; rows: x from the heel, columns: y from "
        f"right to left seen from above, spacing {surface.spacing * 1e3:g} mm; first row x = "
        f"{surface.x[0] * 1e3:g} mm, first column y = {surface.y[0] * 1e3:g} mm"
    )
    np.savetxt(
        folder / "heights.csv.gz", surface.height * 1e3, fmt="%.4f", delimiter=",", header=header
    )
    (folder / "case.toml").write_text(case_text(out, file, settings, found), encoding="utf-8")


def _flat(measures: dict[str, Any]) -> list[tuple[str, float | None]]:
    from underfoot.outsole.tread_measures import SHARES

    units = {"area": "_m2", "length": "_m", "width": "_m", "depth": "_m", "circle": "_m"}
    found: list[tuple[str, float | None]] = []
    for name, value in measures.items():
        unit = next((units[end] for end in units if name.endswith(end)), "")
        if isinstance(value, tuple):
            shares = zip(SHARES, value, strict=True)
            found += [(f"{name}_{share}pct{unit}", one) for share, one in shares]
        else:
            found.append((f"{name}{unit}", value))
    return found


def case_text(out: Path, file: Path, settings: FileSettings, found: FileOutsole) -> str:
    """Return a case file that uses the outsole as it was read, with the settings given."""
    import os

    from underfoot.outsole.files import FileSettings
    from underfoot.outsole.files.checksum import checksum

    plain = FileSettings()
    path = Path(os.path.relpath(file.resolve(), out.resolve())).as_posix()
    lines = [
        f"name = {_quoted(file.stem)}",
        "",
        "[shoe]",
        'from = "work_shoe_half_tread"  # compound and roughness; set your own',
        "",
        "[shoe.outsole]",
        f"file = {_quoted(path)}",
        f'sha256 = "{checksum(file)}"',
    ]
    for name in ("unit", "down", "forward", "foot", "region"):
        value = getattr(settings, name)
        mark = "" if value != getattr(plain, name) else "# "
        lines.append(f'{mark}{name} = "{value}"')
    if settings.mirror:
        lines.append("mirror = true")
    if settings.region_length is not None:
        lines.append(f'region_length = "{settings.region_length * 1e3:g} mm"')
    if settings.spacing != plain.spacing:
        lines.append(f'map_spacing = "{settings.spacing * 1e3:g} mm"')
    lines += ["", "[shoe.sole]"]
    if found.thickness is None:
        lines.append('outsole_thickness = "15 mm"  # not in the file: set your own')
    else:
        lines.append(f'outsole_thickness = "{found.thickness * 1e3:.3g} mm"  # as in the file')
    lines += [
        '# midsole_modulus = "2 MPa"',
        '# midsole_thickness = "15 mm"',
        "",
        "[floor]",
        'from = "vinyl_g4"',
        "",
        "[contaminant]",
        'from = "glycerol_90pct"',
        "",
        "[motion]",
        'from = "slip_tester_g4"',
    ]
    return "\n".join(lines) + "\n"


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
