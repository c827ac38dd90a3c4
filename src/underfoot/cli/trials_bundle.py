"""``underfoot trials bundle``: everything a court needs of an analysis, and its check."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .guard import say
from .options import CatalogueFolders, Overwrite, PlateFrame, RampAngle, optional


def bundle(
    folder: Annotated[Path | None, typer.Argument(help="Folder of trial files.")] = None,
    protocol: Annotated[str | None, optional("As in `trials analyse`.")] = None,
    out: Annotated[Path | None, optional("Folder for the bundle.")] = None,
    check: Annotated[
        Path | None, optional("A bundle: compare its files with their checksums, its numbers anew.")
    ] = None,
    names: Annotated[str, optional("Pattern of file names that gives conditions.")] = "",
    merge_spelling: Annotated[
        bool, typer.Option("--merge-spelling", help="Take spellings of one name as one.")
    ] = False,
    ramp: RampAngle = None,
    plate_frame: PlateFrame = None,
    folders: CatalogueFolders = None,
    overwrite: Overwrite = False,
) -> None:
    """Write recordings, checksums, edits, calibration, method, numbers with u and a page to sign.

    Profile, conditions, edits and calibration are those that stand in the folder.
    """
    from underfoot.core import InputError
    from underfoot.core.catalogue import catalogue_folders
    from underfoot.core.files import whole_folder
    from underfoot.core.progress import bar
    from underfoot.trials.pages.court_bundle import PAGE, bundle_faults, write_bundle
    from underfoot.trials.recording.protocols import protocol as protocol_named
    from underfoot.trials.study import analyse_folder

    if check is not None:
        faults = bundle_faults(check)
        for fault in faults:
            print(fault)
        say("not as it was written" if faults else "as it was written: files and numbers agree")
        raise typer.Exit(3 if faults else 0)
    if folder is None or protocol is None or out is None:
        option = "FOLDER" if folder is None else "--protocol" if protocol is None else "--out"
        raise InputError("is missing", where=option, remedy="See underfoot trials bundle --help")
    if out.resolve().is_relative_to(folder.resolve()):
        raise InputError("the folder of the trials can't take the bundle", where="--out")
    known = catalogue_folders(Path.cwd(), folders or ())
    slope = {"ramp": ramp, "plate_frame": plate_frame}
    method = {key: value for key, value in slope.items() if value is not None}
    chosen = protocol_named(protocol, known).with_settings(method)
    options = {"names": names, "merge_spelling": merge_spelling}
    settings = {"protocol": protocol, "method": method, "options": options}
    with bar("analysing trials") as progress, whole_folder(out, overwrite=overwrite) as made:
        analysis = analyse_folder(folder, chosen, **options, progress=progress)
        write_bundle(analysis, folder, made, settings, list(map(Path, known)), progress=progress)
    for doubt in analysis.doubts:
        say(f"doubt: {doubt}")
    say(f"{len(analysis.files)} files; read and sign {out / PAGE}")
