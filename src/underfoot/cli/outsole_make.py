"""``underfoot outsole make``: a sole from a few lengths and angles as STEP, STL, OBJ or PLY."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from underfoot.core.remark import Message

from .guard import say
from .options import AsJson, Overwrite, Settings, setting
from .output import print_json

if TYPE_CHECKING:
    from underfoot.shoe.parametric import SoleFile
    from underfoot.shoe.shape import SoleShape

LENGTHS = {
    "lug": "tread.lug_width",
    "channel": "tread.channel_width",
    "depth": "tread.depth",
    "lug_length": "tread.lug_length",
    "arm": "tread.arm_length",
    "wave_length": "tread.wave_length",
    "wave_height": "tread.wave_height",
    "ring": "tread.ring_width",
    "front_lug": "tread.front_lug_width",
    "graded_length": "tread.graded_length",
    "angle": "tread.angle",
    "edge": "tread.edge_radius",
    "text": "tread.text",
    "chamfer": "tread.edge_chamfer",
}


def _option(text: str) -> Any:
    return typer.Option(help=text)


PATTERNS = (
    "none, grid, blocks, transverse, longitudinal, bars, chevrons (zigzag), waves, circles, "
    "graded_circles, hexagons, rings, lettering."
)


def make(
    spec: Annotated[Path | None, typer.Argument(help="Outsole file or case file (TOML).")] = None,
    pattern: Annotated[str | None, _option(PATTERNS)] = None,
    lug: Annotated[str | None, _option('Width of a lug, as "6 mm".')] = None,
    channel: Annotated[str | None, _option("Width of a channel.")] = None,
    pitch: Annotated[str | None, _option("Lug and channel together.")] = None,
    depth: Annotated[str | None, _option("Height of the lugs.")] = None,
    lug_length: Annotated[str | None, _option("Of blocks.")] = None,
    arm: Annotated[str | None, _option("Of chevrons, across.")] = None,
    wave_length: Annotated[str | None, _option("Of waves, across.")] = None,
    wave_height: Annotated[str | None, _option("Of waves, along.")] = None,
    ring: Annotated[str | None, _option("Wall of rings.")] = None,
    front_lug: Annotated[str | None, _option("Of graded circles, in front.")] = None,
    graded_length: Annotated[str | None, _option("Over which they change.")] = None,
    angle: Annotated[str | None, _option("Of the pattern.")] = None,
    edge: Annotated[str | None, _option("Radius of the lugs' edges.")] = None,
    chamfer: Annotated[str | None, _option("Width of a 45 degree chamfer instead.")] = None,
    text: Annotated[str | None, _option('Of lettering, as "GRIP"; --lug is its height.')] = None,
    sipes: Annotated[str | None, _option('Width, depth and spacing: "0.5 mm, 2 mm, 4 mm".')] = None,
    whole: Annotated[
        bool, typer.Option("--whole", help="A whole sole of common widths, not a heel.")
    ] = False,
    set_: Settings = None,
    out: Annotated[Path | None, _option("File: .step, .stl, .obj or .ply (mm).")] = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Make a sole: the same description serves the solver (in a case) and the CAD.

    Give an outsole file, or a pattern; lengths that are not given are assumed and said. The file
    is read back and its volume compared with the solid's; meshes must be watertight.
    """
    from underfoot.core import InputError
    from underfoot.shoe.parametric import write_sole

    waves, round_lugs = (wave_length, wave_height), (ring, front_lug, graded_length)
    sizes = (lug, channel, depth, lug_length, arm, *waves, *round_lugs, angle, edge, text, chamfer)
    given = dict(zip(LENGTHS, sizes, strict=True))
    if (spec is None) == (pattern is None):
        raise InputError(
            "no sole" if spec is None else "a file and --pattern together",
            where="underfoot outsole make",
            allowed="an outsole file, or --pattern, as hexagons",
        )
    if out is not None and out.exists() and not overwrite:
        raise InputError(
            Message("{out} exists", out=out),
            where="--out",
            remedy="Choose another name, or add --overwrite.",
        )
    shape = (
        _from_file(spec, set_)
        if spec is not None
        else _from_options(pattern or "", given, pitch, sipes, whole, set_)
    )
    written = None if out is None else write_sole(shape, out)
    measures = measures_of(shape, written)
    if json:
        print_json(measures)
    else:
        _show(measures, written)


def measures_of(shape: SoleShape, written: SoleFile | None) -> dict[str, Any]:
    """Return the measures of a sole and of its file as plain data, SI."""
    from underfoot.shoe import heel_surface

    surface = heel_surface(shape, spacing=0.25e-3)
    measures: dict[str, Any] = {
        "length_m": shape.length,
        "width_m": shape.width,
        "plan_area_m2": shape.plan_area,
        "land_ratio": surface.land_ratio,
        "tread_depth_m": 0.0 if shape.tread is None else shape.tread.depth,
    }
    if written is not None:
        measures |= {
            "file": str(written.path),
            "volume_m3": written.volume,
            "file_volume_m3": written.read_volume,
            "triangles": written.triangles,
            "lugs": written.lugs,
            "remarks": list(written.remarks),
        }
    return measures


def _show(measures: dict[str, Any], written: SoleFile | None) -> None:
    print(
        f"{measures['length_m'] * 1e3:.0f} x {measures['width_m'] * 1e3:.0f} mm, "
        f"{measures['plan_area_m2'] * 1e4:.1f} cm2, {measures['land_ratio']:.0%} of it land, "
        f"tread {measures['tread_depth_m'] * 1e3:g} mm"
    )
    if written is None:
        print("Nothing written: name a file with --out sole.step")
        return
    kind = f"{written.triangles} triangles, watertight" if written.triangles else "a solid"
    print(f"wrote {written.path}: {kind}, {written.volume * 1e6:.2f} cm3", end="")
    print(f" (read back: {written.read_volume / written.volume - 1:+.2%})")
    for remark in written.remarks:
        print(f"note: {remark}")


def _from_file(spec: Path, settings: list[str] | None) -> SoleShape:
    from underfoot.case import text as toml
    from underfoot.compute.sole import new_sole, read_outsole

    from .options import load_case

    if spec.is_file() and "shoe" in toml.parse_toml(toml.read_text(spec), str(spec)):
        return new_sole(load_case(spec, None, settings))
    return read_outsole(spec, _settings(settings)).shape()


def _from_options(
    pattern: str,
    given: dict[str, str | None],
    pitch: str | None,
    sipes: str | None,
    whole: bool,
    settings: list[str] | None,
) -> SoleShape:
    from underfoot.case.sole import TreadPattern, usual_tread
    from underfoot.compute.sole import outsole_from
    from underfoot.core import InputError, to_si, unknown_name

    patterns = TreadPattern.options()
    if pattern not in patterns and ":" not in pattern:  # module:Class of another package
        raise unknown_name("pattern", pattern, patterns, where="--pattern")
    if pitch is not None and given["lug"] is not None:
        if given["channel"] is not None:
            raise InputError("--pitch and --channel say the same thing twice", where="--pitch")
        lug = to_si(given["lug"], "m", where="--lug")
        whole_pitch = to_si(pitch, "m", where="--pitch")
        if lug >= whole_pitch:
            raise InputError(
                f"a lug of {lug * 1e3:g} mm leaves no channel in {whole_pitch * 1e3:g} mm",
                where="--lug",
                allowed=f"below {whole_pitch * 1e3:g} mm",
            )
        given["channel"] = f"{whole_pitch - lug!r} m"
    chosen = _settings(settings)
    fields = usual_tread(pattern)
    keys = {name: path.removeprefix("tread.") for name, path in LENGTHS.items()}
    usual = {name: fields[key] for name, key in keys.items() if key in fields}
    missing = [n for n in usual if given[n] is None and LENGTHS[n] not in chosen]
    if missing:
        given |= {name: usual[name] for name in missing}
        named = ", ".join(f'--{name.replace("_", "-")} "{usual[name]}"' for name in missing)
        say(f"Assumed: {named}")
    tread: dict[str, Any] = {"pattern": pattern}
    for name, path in LENGTHS.items():
        if given[name] is not None:
            tread[path.removeprefix("tread.")] = given[name]
    if sipes is not None:
        parts = [part.strip() for part in sipes.split(",")]
        if len(parts) != 3:
            raise InputError(
                f'"{sipes}"', where="--sipes", allowed='width, depth, spacing: "0.5 mm, 2 mm, 4 mm"'
            )
        tread["sipes"] = dict(zip(("width", "depth", "spacing"), parts, strict=True))
    mapping: dict[str, Any] = {"heel": {"profile": "flat"}, "tread": tread}
    if whole:
        mapping["heel"] |= {"plan": "sole", "length": "290 mm", "width": "68 mm"}
        mapping["heel"] |= {"waist_width": "58 mm", "ball_width": "100 mm"}
        mapping["sole"] = {"outsole_thickness": "12 mm"}
    for key, value in chosen.items():
        section, _, name = key.rpartition(".")
        mapping.setdefault(section or "heel", {})[name] = value
    return outsole_from(mapping).shape()


def _settings(settings: list[str] | None) -> dict[str, Any]:
    return dict(map(setting, settings or ()))
