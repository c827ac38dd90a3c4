"""``underfoot contact``: rubber on one rough surface, dry, at rest or sliding."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from underfoot.core.remark import Message

from .options import Shared, number, optional, sharing

if TYPE_CHECKING:
    from underfoot.rough_contact import ContactTable


@sharing(without=("quick", "set_", "processes", "catalogue"))
def contact(
    shared: Shared,
    surface: Annotated[Path | None, typer.Argument(help="Measured profile or height map.")] = None,
    sole: Annotated[
        Path | None, optional("Scan of the sole, for a table of both surfaces (--table).")
    ] = None,
    table: Annotated[
        Path | None,
        optional("Write the contact over pressures as a file (.npz) that a case takes."),
    ] = None,
    pressure: Annotated[
        str, typer.Option("--pressure", help='Mean contact pressure, as "160 kPa".')
    ] = "160 kPa",
    speed: Annotated[
        str, typer.Option("--speed", help='Sliding speed, as "0.3 m/s"; 0 m/s is at rest.')
    ] = "0 m/s",
    modulus: Annotated[
        str | None, typer.Option("--modulus", help='Young\'s modulus, as "5 MPa": elastic.')
    ] = None,
    shore: Annotated[
        float | None,
        typer.Option("--shore", parser=number, help="Shore A hardness: elastic, by Gent."),
    ] = None,
    spectrum: Annotated[
        Path | None, typer.Option("--spectrum", help="Prony series or dynamic sweep: viscoelastic.")
    ] = None,
    material: Annotated[
        str | None, typer.Option("--material", help="Measured material: neolite or rubber.")
    ] = None,
    poisson: Annotated[
        float, typer.Option("--poisson", parser=number, help="Poisson's ratio.")
    ] = 0.5,
    rms: Annotated[
        str | None, typer.Option("--rms", help='Random surface of this rms height, as "5 um".')
    ] = None,
    hurst: Annotated[
        float, typer.Option("--hurst", parser=number, help="Its Hurst exponent.")
    ] = 0.8,
    longest: Annotated[
        str | None, typer.Option("--longest", help="Its longest wave; 0.5 mm by default.")
    ] = None,
    shortest: Annotated[
        str | None,
        typer.Option("--shortest", help="Its shortest wave; eight grid points by default."),
    ] = None,
    checkerboard: Annotated[
        tuple[str, str] | None,
        typer.Option("--checkerboard", help='Peak to valley and wavelength: "24.3 um" "0.4 mm".'),
    ] = None,
    points: Annotated[int, typer.Option("--points", help="Grid points a side.")] = 256,
    seed: Annotated[int, typer.Option("--seed", help="Number of the random surface.")] = 0,
    cutoffs: Annotated[
        bool, typer.Option("--cutoffs", help="Show how it depends on the shortest wave.")
    ] = False,
    device: Annotated[
        str, typer.Option("--device", help="Where it is solved: auto, cpu, or cuda (a card).")
    ] = "auto",
) -> None:
    """Press and slide rubber over a rough surface: real contact, hysteresis, gap, leakage.

    A profile is turned into a random surface with its spectrum; a map whose edges do not meet
    is mirrored. Dry, without adhesion. With --table the answer is a table over pressures, of all
    waves from 2 mm to 2.5 um of one scan or two, which takes about 10 s once.
    """
    from underfoot.core import InputError, Progress, to_si
    from underfoot.questions.contact import (
        LONGEST_WAVE,
        measured_table,
        rough_contact,
        rubber_from,
        surface_from,
    )

    load = to_si(pressure, "Pa", where="--pressure")
    velocity = to_si(speed, "m/s", where="--speed")
    rubber = rubber_from(modulus=modulus, shore=shore, spectrum=spectrum, name=material)
    if table is not None or sole is not None:
        if surface is None or rms is not None or checkerboard is not None:
            raise InputError(
                "a table is one of measured surfaces",
                where="--table" if table is not None else "--sole",
                allowed="a scan of the floor, and --sole with one of the sole",
                remedy="underfoot contact FLOOR --sole SOLE --table contact.npz ...",
            )
        wave = LONGEST_WAVE if longest is None else to_si(longest, "m", where="--longest")
        given = {
            "shoe": sole,
            "speed": velocity,
            "poisson_ratio": poisson,
            "longest": wave,
            "device": device,
        }
        file = Path("contact.npz") if table is None else table
        if file.exists() and not shared.overwrite:
            remedy = "Add --overwrite to replace it"
            raise InputError(Message("{out} exists", out=file), where="--table", remedy=remedy)

        def make_table(progress: Progress) -> "ContactTable":
            contact_table = measured_table(surface, rubber, **given, progress=progress)
            contact_table.save(file)
            return contact_table

        shared.answer(file.stem, make_table)
        if not shared.json:
            print(f"\n{file} is written. A case beside it takes it with these lines:\n")
            print(f'[rough_contact]\nfile = "{file.name}"')
        return
    floor = surface_from(
        surface,
        rms=rms,
        hurst=hurst,
        longest=longest,
        shortest=shortest,
        checkerboard=checkerboard,
        points=points,
        seed=seed,
    )
    shared.answer(
        "rough contact",
        lambda progress: rough_contact(
            floor,
            rubber,
            pressure=load,
            speed=velocity,
            poisson_ratio=poisson,
            scales=cutoffs,
            device=device,
        ),
    )
