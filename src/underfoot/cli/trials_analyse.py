"""``underfoot trials analyse`` and ``underfoot trials persons``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from .guard import say
from .options import CatalogueFolders, Overwrite, PlateFrame, RampAngle, number, optional

_REASONS = 3  # printed for a file; all stand in the report


def analyse(
    folder: Annotated[Path | None, typer.Argument(help="Folder of trial files.")] = None,
    protocol: Annotated[
        str | None, optional("How numbers are taken and judged; --list shows all.")
    ] = None,
    out: Annotated[Path | None, optional("Folder for report, tables and figures.")] = None,
    profile: Annotated[
        Path | None,
        optional("What columns, axes and markers are called; else profile.toml in the folder."),
    ] = None,
    conditions: Annotated[
        Path | None,
        optional(
            'Table (CSV, XLSX) with a column "file"; by default conditions.csv in the folder.'
        ),
    ] = None,
    names: Annotated[
        str,
        optional(
            r"Pattern of file names that gives conditions, as "
            r"'S(?P<subject>\d+)_(?P<shoe>\w+?)_(?P<n>\d+)'; else the protocol's."
        ),
    ] = "",
    merge_spelling: Annotated[
        bool, typer.Option("--merge-spelling", help='Take "hard", "Hard" and "HARD" as one level.')
    ] = False,
    ramp: RampAngle = None,
    plate_frame: PlateFrame = None,
    equivalence: Annotated[
        float | None,
        typer.Option(
            parser=number,
            help="Test pairs for equivalence within this difference of RCOF or COF, as 0.02.",
        ),
    ] = None,
    details: Annotated[int, typer.Option(help="Number of single trials drawn in detail.")] = 4,
    processes: Annotated[
        int | None, typer.Option(help="Files analysed at once.", show_default="all processors")
    ] = None,
    folders: CatalogueFolders = None,
    overwrite: Overwrite = False,
    listed: Annotated[bool, typer.Option("--list", help="Show the protocols and stop.")] = False,
) -> None:
    """Analyse a folder of trials: a verdict for each file, tables, figures and one report.

    An interrupted analysis goes on where it stopped; one bad file never stops the rest.
    """
    from underfoot.core import InputError
    from underfoot.core.catalogue import catalogue_folders
    from underfoot.trials.recording.protocols import protocol as protocol_named
    from underfoot.trials.recording.protocols import protocol_names

    known = catalogue_folders(Path.cwd(), folders or ())
    if listed:
        for name, title in protocol_names(known).items():
            print(f"{name:<22} {title}")
        return
    if folder is None or protocol is None or out is None:
        option = "FOLDER" if folder is None else "--protocol" if protocol is None else "--out"
        raise InputError("is missing", where=option, remedy="See underfoot trials analyse --help")
    if equivalence is not None and not equivalence > 0:
        raise InputError(f"{equivalence:g}", where="--equivalence", allowed="above 0, as 0.02")
    slope = {"ramp": ramp, "plate_frame": plate_frame, "equivalence": equivalence}
    settings = {key: value for key, value in slope.items() if value is not None}
    chosen = protocol_named(protocol, known).with_settings(settings)
    if details < 0:
        raise InputError(f"{details}", where="--details", allowed="0 or more")
    if processes is not None and processes < 1:
        raise InputError(f"{processes}", where="--processes", allowed="1 or more")
    if out.resolve() == folder.resolve():
        raise InputError("the folder of the trials can't take the results", where="--out")
    from underfoot.core.progress import bar
    from underfoot.trials.pages.report import STORE, check_report_folder, write_trials_report
    from underfoot.trials.study import CAUTION, REFUSED, analyse_folder

    check_report_folder(out, overwrite=overwrite)
    with bar("analysing trials") as progress:
        analysis = analyse_folder(
            folder,
            chosen,
            profile=profile,
            conditions=conditions,
            names=names,
            merge_spelling=merge_spelling,
            store=out / STORE,
            processes=processes,
            progress=progress,
        )
        write_trials_report(analysis, out, details=details, processes=processes, progress=progress)
    for file in analysis.files:
        more = len(file.reasons) - _REASONS
        reasons = [*file.reasons[:_REASONS], *([f"{more} more in the report"] if more > 0 else [])]
        print(f"{file.verdict:<9} {file.file}" + (f": {'; '.join(reasons)}" if reasons else ""))
    for doubt in analysis.doubts:
        say(f"doubt: {doubt}")
    for note in (*analysis.notes, *analysis.study.notes):
        say(f"note: {note}")
    verdicts = [file.verdict for file in analysis.files]
    usable = len(verdicts) - verdicts.count(REFUSED)
    say(
        f"{usable} of {len(verdicts)} files usable, {verdicts.count(CAUTION)} with cautions; "
        f"read {out / 'report.html'}"
    )
    if not usable:
        raise typer.Exit(3)


NEEDED_OF = {
    **dict.fromkeys(("paired", "groups", "repeated"), ("difference", "sd")),
    "slips": ("shares",),
    "slips_equivalent": ("shares", "difference"),
}
"""Options that the number of persons of a design hangs on."""


def persons(
    design: Annotated[
        str, typer.Argument(help="paired, groups, repeated, slips or slips_equivalent.")
    ],
    difference: Annotated[
        float | None,
        typer.Option(
            parser=number, help="Difference of means to be found; margin (slips_equivalent)."
        ),
    ] = None,
    sd: Annotated[
        float | None,
        typer.Option(
            parser=number,
            help="SD of differences within persons (paired), of a person's mean in one condition "
            "(repeated), between persons (groups).",
        ),
    ] = None,
    shares: Annotated[
        tuple[float, float] | None, typer.Option(help="Shares of slips in both groups.")
    ] = None,
    conditions: Annotated[int, typer.Option(help="Number of conditions (repeated).")] = 2,
    power: Annotated[float, typer.Option(parser=number, help="Chance to find it.")] = 0.8,
) -> None:
    """Print how many persons a study needs (in each group, for groups and slips)."""
    from underfoot.core import InputError
    from underfoot.trials import statistics

    stated = {"difference": difference, "sd": sd, "shares": shares}
    for name in NEEDED_OF.get(design, ()):
        if stated[name] is None:
            raise InputError(
                "is missing", where=f"--{name}", remedy="See underfoot trials persons --help"
            )
    settings: dict[str, Any] = {k: v for k, v in stated.items() if v is not None}
    settings["conditions"] = conditions

    def chance(count: int) -> float:
        return statistics.power(design, count, **settings)

    count = statistics.persons_needed(chance, power)
    each = " in each group" if design in ("groups", "slips", "slips_equivalent") else ""
    of = f", {conditions} conditions" if design == "repeated" else ""
    print(f"{count} persons{each}{of}: power {chance(count):.3f} at alpha 0.05, two-sided")
