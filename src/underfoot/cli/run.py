"""``underfoot run``: one case from file to friction."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .guard import say
from .options import AsJson, CasePath, CatalogueFolders, Overwrite, Settings, loaded

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.case.result import Result


def run(
    case: CasePath,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", help="Folder for the results; out/CASE by default.", show_default=False
        ),
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Coarser grid: a first look in seconds.")
    ] = False,
    json: AsJson = False,
    set_: Settings = None,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Compute a case: table on the screen; files, maps and a page in a folder.

    With --json and no --out the result goes to standard output and nothing is written.
    """
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.document import write_outputs

    found = loaded(case, catalogue, set_)
    folder = out if out is not None or json else Path("out") / case.stem
    if folder is not None:
        check_writable_folder(folder, overwrite=overwrite)
    result = computed(found, quick=quick)
    if folder is not None:
        with whole_folder(folder, overwrite=overwrite) as staging:
            write_outputs(result, staging)
    if json:
        import json as json_text

        print(json_text.dumps(result.as_dict(), indent=2, ensure_ascii=False))
    else:
        from .show import show_result

        show_result(result, folder)
    if not result.status.usable:
        raise typer.Exit(4)


def computed(case: Case, *, quick: bool) -> Result:
    """Return the result of a case, with a progress bar when a person is watching."""
    import sys

    from underfoot.case.run import run as run_case
    from underfoot.core.progress import bar, silent

    if not sys.stderr.isatty():
        say(f"computing: {case.name}")
        return run_case(case, quick=quick, progress=silent)
    with bar(case.name) as progress:
        return run_case(case, quick=quick, progress=progress)
