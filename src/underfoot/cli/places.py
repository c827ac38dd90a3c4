"""``underfoot choose``, ``machine``, ``machines`` and ``calibrate machine``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from underfoot.core.remark import Message

from .options import Shared, number, optional, sharing


@sharing(quick=True, without=("set_", "processes", "catalogue"))
def choose(
    shared: Shared,
    place: Annotated[Path, typer.Argument(help="Place: floors, fluids, shoes, people (TOML).")],
) -> None:
    """Rank shoes for a place: chance of being best, slips, when to replace, what to measure.

    Floors and shoes may carry readings (PTV, ramp angle, DCOF, EN values, slip class); each
    narrows every shoe on that floor, or that shoe on every floor.
    """
    from underfoot.places.choice import choose_shoe
    from underfoot.places.place import read_place

    told = read_place(place)
    shared.answer(
        told.name, lambda progress: choose_shoe(told, quick=shared.quick, progress=progress)
    )


@sharing(without=("quick", "set_", "processes", "catalogue"))
def machine(
    shared: Shared,
    name: Annotated[str, typer.Argument(help="Name of the machine (underfoot machines).")],
    rz: Annotated[str | None, optional('Roughness of the floor, as "20 um".')] = None,
    rq: Annotated[str | None, optional('The same as Rq, as "3 um".')] = None,
    scan: Annotated[Path | None, optional("The same from a scan of the floor.")] = None,
    fluid: Annotated[str, optional("dry, water, detergent, oil or ramp oil.")] = "",
) -> None:
    """Predict what a slip test machine prints of a floor: PTV, ramp angle or COF, and its class."""
    from underfoot.core import to_si
    from underfoot.core.checks import exactly_one
    from underfoot.places.machines import predicted_reading, rq_of_rz
    from underfoot.surface import read_scan

    given = {"--rz": rz, "--rq": rq, "--scan": scan}
    span = None
    if any(value is not None for value in given.values()):
        exactly_one(given, "more than one roughness", "machine", "one of --rz, --rq, --scan")
        if rz is not None:
            span = rq_of_rz(to_si(rz, "m", where="--rz"))
        elif rq is not None:
            known = to_si(rq, "m", where="--rq")
            span = known, known
        elif scan is not None:
            known = float(read_scan(scan).values["rq"])
            span = known, known
    shared.answer(name, lambda _: predicted_reading(name, span, fluid=fluid))


@sharing(without=("quick", "set_", "processes", "catalogue"))
def machines(shared: Shared) -> None:
    """List the machines, and published readings beside predictions without their source."""
    from underfoot.places.evidence import machine_scores

    shared.answer("machines", lambda _: machine_scores())


@sharing(without=("quick", "set_", "processes", "catalogue", "out"))
def calibrate_machine(
    shared: Shared,
    case: Annotated[Path, typer.Argument(help="Case whose floor was read (TOML).")],
    out: Annotated[Path, typer.Option("--out", help="File of draws (CSV).")],
    name: Annotated[str, optional("Machine that read it.", "--machine")] = "pendulum-96",
    reading: Annotated[
        float, typer.Option("--reading", parser=number, help="What it read, in its unit.")
    ] = 0.0,
    kind: Annotated[str, typer.Option("--kind", help="value, lower or upper.")] = "value",
    fluid: Annotated[str, optional("By default that of the machine's standard.")] = "",
) -> None:
    """Narrow the law of the pair by a machine's reading of the floor: PTV, ramp angle, DCOF.

    Every case on this floor, whatever its shoe, takes the file with friction.draws_file = "FILE";
    risk, test and compare then know the reading. A case takes readings itself with
    friction.model = "pair_read".
    """
    from underfoot.core import InputError
    from underfoot.places.calibration import calibrated_floor

    from .options import load_case

    if out.exists() and not shared.overwrite:
        raise InputError(
            Message("{out} exists", out=out), where="--out", remedy="Add --overwrite to replace it"
        )
    told = calibrated_floor(load_case(case, None, None), name, reading, kind=kind, fluid=fluid)
    told.draws.write(out)
    shared.answer(told.heading(), lambda _: told)
