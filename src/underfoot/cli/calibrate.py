"""``underfoot calibrate``: from measurements to what a case uses."""

from pathlib import Path
from typing import Annotated

import typer

from underfoot.core.remark import Message

from .groups import Group
from .guard import guard_command, say
from .options import AsJson, Overwrite, Quick
from .output import finish
from .places import calibrate_machine
from .study import posterior

calibrate_app = typer.Typer(
    name="calibrate",
    cls=Group,
    help="Make laws of trials and readings, with their uncertainty.",
    no_args_is_help=True,
)


def law(
    folder: Annotated[Path, typer.Argument(help='Results of "underfoot trials analyse".')],
    out: Annotated[Path, typer.Option("--out", help="Law file (CSV).")],
    where: Annotated[
        list[str] | None,
        typer.Option(
            "--where",
            metavar="CONDITION=VALUE",
            help="Trials that count, as fluid=water; may be given several times.",
        ),
    ] = None,
    form: Annotated[
        str, typer.Option("--form", help="fit (Eq. 17) or readings (mean at each speed).")
    ] = "fit",
    pressure: Annotated[
        str | None,
        typer.Option("--pressure", help='Contact pressure of the tests, as "266 kPa".'),
    ] = None,
    overwrite: Overwrite = False,
) -> None:
    """Write the friction law of one pair and fluid from analysed pin-on-disk trials.

    A case uses it with friction.model = "table" and friction.table_file = "FILE".
    """
    from underfoot.calibrate.law_file import law_file_text, law_table, trial_readings
    from underfoot.case.text import save
    from underfoot.core import InputError, to_si

    chosen = {}
    for text in where or ():
        name, sign, value = text.partition("=")
        if not sign or not name.strip() or not value.strip():
            raise InputError(
                f'"{text}" is no condition', where="--where", allowed="CONDITION=VALUE"
            )
        if name.strip() in chosen:
            raise InputError(
                f"{name.strip()} is chosen twice", where="--where", allowed="one value of each"
            )
        chosen[name.strip()] = value.strip()
    load = None if pressure is None else to_si(pressure, "Pa", where="--pressure")
    if load is not None and not load > 0:
        raise InputError(f"{pressure}", where="--pressure", allowed="above 0")
    table = law_table(trial_readings(folder, chosen), form=form)
    save(law_file_text(table, pressure=load), out, overwrite=overwrite)
    for note in table.notes:
        say(note)
    worst = float(table.deviation.max())
    print(
        f"wrote {out}: COF {table.cof[0]:.3f} at {table.speed[0]:.3g} m/s to {table.cof[-1]:.3f} "
        f"at {table.speed[-1]:.3g} m/s, standard deviation up to {worst:.3f}\n"
        f'Use it: friction.model = "table", friction.table_file = "{out.name}"'
    )


def pair(
    readings: Annotated[Path, typer.Argument(help="Readings (TOML), each with the case of it.")],
    out: Annotated[Path, typer.Option("--out", help="File of draws (CSV).")],
    quick: Quick = True,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Narrow the friction of a pair by readings of your own tester or a certificate.

    READINGS has tables named reading, each with case = "my_case.toml", cof = 0.24 and, where known,
    sd = 0.02 and kind = "lower" (a certificate's limit). A case uses what it writes with
    friction.draws_file = "FILE".
    """
    from underfoot.calibrate.pair_readings import calibrated_pair, read_pair_readings
    from underfoot.core import InputError
    from underfoot.core.progress import bar

    if out.exists() and not overwrite:
        raise InputError(
            Message("{out} exists", out=out), where="--out", remedy="Add --overwrite to replace it"
        )
    given = read_pair_readings(readings)
    with bar("Calibrating the law of the pair") as progress:
        calibration = calibrated_pair(given, quick=quick, progress=progress)
    out.parent.mkdir(parents=True, exist_ok=True)
    calibration.draws.write(out)
    finish(calibration, None, json=json)
    if not json:
        print(f'\nwrote {out}\nUse it: friction.draws_file = "{out.name}"')


calibrate_app.command()(guard_command(law))
calibrate_app.command()(guard_command(pair))
calibrate_app.command()(guard_command(posterior))
calibrate_app.command("machine")(guard_command(calibrate_machine))


@calibrate_app.callback()
def _group() -> None:
    """Make laws of trials and readings, with their uncertainty."""
