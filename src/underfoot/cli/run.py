"""``underfoot run``: one case from file to friction."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .guard import say
from .options import AsJson, CasePath, CatalogueFolders, Overwrite, Settings, loaded

if TYPE_CHECKING:
    from underfoot.assess.risk import RiskReport
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
    no_changes: Annotated[
        bool,
        typer.Option(
            "--no-changes",
            help="Leave out which changes would help most (also left out with --quick).",
        ),
    ] = False,
    json: AsJson = False,
    set_: Settings = None,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Compute a case: table on the screen; files, maps and a page in a folder.

    Then the changes that would help most, each computed on the quick grid. With --json and no
    --out the result goes to standard output and nothing is written.
    """
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.document import write_outputs

    found = loaded(case, catalogue, set_)
    folder = out if out is not None or json else Path("out") / case.stem
    if folder is not None:
        check_writable_folder(folder, overwrite=overwrite)
    result = computed(found, quick=quick)
    wanted = result.status.usable and not (quick or no_changes)
    advice = changes_of(found) if wanted else None
    if folder is not None:
        with whole_folder(folder, overwrite=overwrite) as staging:
            write_outputs(result, staging, advice)
            if advice is not None:
                from .risk import write_risk

                write_risk(advice, staging)
    if json:
        import json as json_text

        from .risk import as_dict

        shown = result.as_dict()
        shown |= {} if advice is None else {"advice": as_dict(advice)}
        print(json_text.dumps(shown, indent=2, ensure_ascii=False))
    else:
        from .show import show_result

        show_result(result, folder, advice)
    if not result.status.usable:
        raise typer.Exit(4)


def changes_of(case: Case) -> RiskReport:
    """Return what limits the friction of a case and which changes help most."""
    import sys

    from underfoot.assess.risk import risk_report
    from underfoot.core.progress import bar

    if not sys.stderr.isatty():
        say("computing what would help")
        return risk_report(case, processes=None)
    with bar("What would help") as progress:
        return risk_report(case, processes=None, progress=progress)


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
