"""``underfoot trials ...``: measurement files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .groups import Group
from .guard import guarded
from .options import AsJson, PlateFrame, RampAngle, optional
from .trials_analyse import analyse, persons, simulate
from .trials_bundle import bundle
from .trials_steps import definitions, edit, export

trials_app = typer.Typer(
    name="trials",
    cls=Group,
    help="Measurement files: from recordings to the numbers the field publishes.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


@trials_app.callback()
def trials() -> None:
    """Measurement files: from recordings to the numbers the field publishes."""


def describe(
    file: Annotated[
        Path,
        typer.Argument(
            help="C3D, TRC, MOT/STO, .forces, BioWare text, CETR or PCS log, CSV or XLSX.",
            show_default=False,
        ),
    ],
    companion: Annotated[
        Path | None,
        optional("Second file of the same recording, as .forces beside .trc.", "--with"),
    ] = None,
    profile: Annotated[Path | None, optional("Profile (TOML) of columns, axes and heels.")] = None,
    definition: Annotated[str, typer.Option(help="Definition of RCOF.")] = "default",
    vertical: Annotated[str | None, optional("Vertical axis, as z.")] = None,
    walking: Annotated[str | None, optional("Walking direction, as +x.")] = None,
    baseline: Annotated[
        bool, typer.Option(help="Subtract the force of the unloaded plate.")
    ] = True,
    ramp: RampAngle = None,
    plate_frame: PlateFrame = None,
    as_json: AsJson = False,
) -> None:
    """Show plates, rates, axes, signs, baselines, heels and every step, taken or left and why."""
    from underfoot.trials.axes import ramp_from
    from underfoot.trials.describe import described_file

    found = described_file(
        file,
        companion=companion,
        profile=profile,
        definition=definition,
        vertical=vertical,
        walking=walking,
        subtract_baseline=baseline,
        ramp=ramp_from(ramp or "0 deg", plate_frame or "", where="--ramp"),
    )
    if as_json:
        import json

        print(json.dumps([one.as_dict() for one in found], indent=2, allow_nan=False))
    else:
        print("\n\n".join(one.text() for one in found))


trials_app.command()(guarded(describe))
trials_app.command()(guarded(analyse))
trials_app.command()(guarded(simulate))
trials_app.command()(guarded(persons))
trials_app.command()(guarded(edit))
trials_app.command()(guarded(definitions))
trials_app.command()(guarded(export))
trials_app.command()(guarded(bundle))
