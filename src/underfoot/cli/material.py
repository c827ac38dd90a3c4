"""``underfoot material``: from tests of a rubber to the compound of a case."""

from pathlib import Path
from typing import Annotated

import typer

from underfoot.core.remark import Message

from .options import Shared, number, optional, sharing


@sharing(without=("quick", "set_", "processes", "catalogue", "out"))
def material(
    shared: Shared,
    files: Annotated[
        list[Path] | None,
        typer.Argument(help="Tests: dynamic sweeps, relaxation, Prony series, compression."),
    ] = None,
    out: Annotated[
        Path | None,
        optional(
            "File of the compound (TOML); data and figures stand beside it. Or a deck with its "
            "Prony series: .inp (Abaqus), .k (LS-DYNA), .feb (FEBio), .mac (ANSYS)."
        ),
    ] = None,
    shore: Annotated[str | None, optional('Hardness, as "68 A" or "40 Shore D".')] = None,
    temperature: Annotated[
        str | None, optional('Of use, as "23 degC"; tests at several are shifted to it.')
    ] = None,
    thickness: Annotated[
        str | None, optional('Of one block of a compression test, as "5.5 mm".')
    ] = None,
    area: Annotated[str | None, optional('Of its face, as "1.6 cm^2".')] = None,
    shear: Annotated[
        bool | None, typer.Option("--shear/--young", help="Moduli are of shear, else as headed.")
    ] = None,
    poisson: Annotated[
        float, typer.Option("--poisson", parser=number, help="Poisson's ratio.")
    ] = 0.49,
    polymer: Annotated[str | None, optional("TPU, PU, SBR, NBR, ...")] = None,
    unit: Annotated[str | None, optional("Of moduli, where a file has none: MPa.")] = None,
    at_once: Annotated[
        str | None, optional('Modulus that fixes a Prony series without one, as "8 MPa".')
    ] = None,
    at_rest: Annotated[str | None, optional('Or its modulus at rest, as "0.8 MPa".')] = None,
) -> None:
    """Moduli (Eq. 13 to 16), Prony terms, shift factors and loss tangent of a rubber's tests.

    A relaxation test, a dynamic sweep (DMA), a hardness, or several of them. What --out writes is
    taken by a case as shoe.material.file.
    """
    from underfoot.calibrate.compound import Compound, compound_from_files
    from underfoot.core import InputError, Progress, to_si
    from underfoot.core.files import whole_file
    from underfoot.material.durometer_scales import durometer_reading
    from underfoot.material.write_decks import FORMS, deck_text

    from .output import answer

    if out is not None and out.exists() and not shared.overwrite:
        raise InputError(
            Message("{out} exists", out=out), where="--out", remedy="Add --overwrite to replace it"
        )

    def si(name: str, text: str | None, unit: str) -> float | None:
        return None if text is None else to_si(text, unit, where=f"--{name}")

    sizes = {
        "temperature": si("temperature", temperature, "K"),
        "thickness": si("thickness", thickness, "m"),
        "area": si("area", area, "m^2"),
    }
    reading = None if shore is None else durometer_reading(shore, where="--shore")
    levels = {
        "instantaneous_modulus": si("at-once", at_once, "Pa"),
        "equilibrium_modulus": si("at-rest", at_rest, "Pa"),
    }
    more = {
        "modulus_unit": unit,
        **levels,
        "shear": shear,
        "poisson_ratio": poisson,
        "polymer": polymer,
        "hardness": reading,
    }

    def make_compound(progress: Progress) -> Compound:
        progress("Reading the tests", 0.0)
        found = compound_from_files(files or [], **sizes, **more)
        if out is not None:
            written = found.toml() if form is None else deck_of(found)
            with whole_file(out) as part:
                part.write_text(written, encoding="utf-8")
        return found

    form = None if out is None else FORMS.get(out.suffix.casefold())

    def deck_of(compound: Compound) -> str:
        if compound.spectrum is None:
            raise InputError("no relaxation was measured: a deck needs its terms", where="--out")
        return deck_text(
            compound.spectrum, form or "", poisson_ratio=compound.poisson_ratio, unit=unit or "MPa"
        )

    answer(
        "compound",
        make_compound,
        out=out.with_suffix("") if out is not None and files else None,
        overwrite=shared.overwrite,
        json=shared.json,
        everything=shared.everything,
    )
    if out is not None and form is not None and not shared.json:
        print(f"\n{out} is written: moduli in {unit or 'MPa'}, times in s.")
    elif out is not None and not shared.json:
        print(f"\n{out} is written. A case beside it takes it with these lines:\n")
        print(f'[shoe.material]\nfile = "{out.name}"')
