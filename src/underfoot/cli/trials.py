"""``underfoot trials ...``: measurement files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .groups import Group
from .guard import guard_command, say
from .options import AsJson, Overwrite, PlateFrame, RampAngle, optional
from .output import print_json
from .trials_analyse import analyse, persons
from .trials_bundle import bundle
from .trials_curves import curves
from .trials_plan import plan
from .trials_steps import definitions, edit, export

trials_app = typer.Typer(
    name="trials",
    cls=Group,
    help="Measurement files: from recordings to the numbers the field publishes.",
    no_args_is_help=True,
)


@trials_app.callback()
def trials() -> None:
    """Measurement files: from recordings to the numbers the field publishes."""


def describe(
    file: Annotated[
        Path,
        typer.Argument(
            help="C3D, TRC, MOT/STO, .forces, BioWare text, CETR or PCS log, CSV or XLSX.",
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
    from underfoot.trials.recording.axes import ramp_from
    from underfoot.trials.walking.describe import described_file

    description = described_file(
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
        print_json([one.as_dict() for one in description])
    else:
        print("\n\n".join(one.text() for one in description))


def simulate(
    kind: Annotated[str, typer.Argument(help="slips, study, tester, pin_on_disk or relaxation.")],
    out: Annotated[Path, optional("Folder to be made.")],
    count: Annotated[int, typer.Option(help="Number of trials, persons, scans or repeats.")] = 12,
    seed: Annotated[int, typer.Option(help="Another seed gives other trials.")] = 1,
    overwrite: Overwrite = False,
) -> None:
    """Write made-up measurements with known truth, to try the analysis out; clearly synthetic."""
    from underfoot.core.files import whole_folder
    from underfoot.core.progress import bar
    from underfoot.trials.simulator import simulated_folder

    with bar("writing made-up trials") as progress, whole_folder(out, overwrite=overwrite) as made:
        paths = simulated_folder(kind, made, count=count, seed=seed, progress=progress)
    say(
        f"{len(paths)} made-up files in {out}: nothing in them was measured; the truth is truth.csv"
    )


for command in (
    describe,
    simulate,
    analyse,
    bundle,
    curves,
    definitions,
    edit,
    export,
    persons,
    plan,
):
    trials_app.command()(guard_command(command))
