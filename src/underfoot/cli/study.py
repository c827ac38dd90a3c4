"""``underfoot study``: sweeps, sensitivities, optimisations; ``underfoot calibrate posterior``."""

from __future__ import annotations

from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

from underfoot.core.remark import Message

from .guard import guard_command, say
from .options import AsJson, On, Overwrite, ShowAll, Workers, optional
from .output import finish, print_json, print_table

if TYPE_CHECKING:
    from underfoot.explore import Study

study_app = typer.Typer(
    name="study",
    help="Design studies: sweep, sensitivity, robust optimisation; resumed where they stopped.",
    no_args_is_help=True,
)
StudyPath = Annotated[Path, typer.Argument(metavar="STUDY", help="Study file or folder.")]
Folder = Annotated[
    Path | None, optional("Folder of the study; by default out/NAME of the file.", "--out")
]


def _study(path: Path, out: Path | None = None) -> Study:
    from underfoot.explore import Study

    return Study.load(path, out)


def check(
    study: StudyPath,
    out: Folder = None,
    timed: Annotated[
        int, typer.Option("--timed", min=0, help="Compute and keep so many cases, spread evenly.")
    ] = 0,
    json: AsJson = False,
) -> None:
    """Print how many cases a study has, which can't be built, what it takes and where to run it.

    Finished cases tell the cost; without any it is a guess by the size of the grid.
    """
    from underfoot.core.progress import bar
    from underfoot.explore.check import study_check

    chosen = _study(study, out)
    with bar(chosen.plan.name) as progress:
        if timed:
            chosen.compute_some(timed, progress)
    checked = study_check(chosen.plan, store=chosen.store)
    finish(checked, None, json=json, everything=True)
    if not json:
        measure = (
            ""
            if checked.cost
            else f"To measure the cost: underfoot study check {quote(str(study))} --timed 10\n"
        )
        print(f"{measure}Next: underfoot study run {quote(str(study))}")


def run(
    study: StudyPath,
    out: Folder = None,
    on: On = None,
    workers: Workers = None,
    json: AsJson = False,
    everything: ShowAll = False,
) -> None:
    """Compute what is not finished, then write tables and report.html.

    Meanwhile live.html in its folder shows how far it is. The same command goes on where it
    stopped, whatever stopped it.
    """
    from underfoot.core.progress import bar
    from underfoot.report.design_study import write_study_report
    from underfoot.report.live_study import with_live_page

    chosen = _study(study, out)
    with bar(chosen.plan.name) as bare, with_live_page(chosen, bare, workers) as progress:
        result = chosen.run(on, workers, progress)
    with bar("report") as progress:
        written = write_study_report(chosen, result, progress=progress)
    finish(result, written, json=json, everything=everything)


def work(
    study: StudyPath,
    out: Folder = None,
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 1,
) -> None:
    """Take open cases from the study's folder until it is done: for array jobs and second machines.

    Needs no scheduler: any number of these share the folder.
    """
    from underfoot.core.progress import bar
    from underfoot.report.live_study import with_live_page

    chosen = _study(study, out)
    with bar(chosen.plan.name) as bare, with_live_page(chosen, bare, workers) as progress:
        count = chosen.work(workers, progress)
    print(f"computed {count} cases; the study in {chosen.store.folder} is done")


def stop(
    study: StudyPath,
    out: Folder = None,
) -> None:
    """Stop a study wherever it runs: cases that are being computed end first, none is lost.

    ``underfoot study run`` goes on from there.
    """
    chosen = _study(study, out)
    working = sum(session["ended"] is None for session in chosen.store.sessions())
    if not working:
        print(f"nobody works on the study in {chosen.store.folder}")
        return
    chosen.store.stop()
    who = "1 process" if working == 1 else f"{working} processes"
    print(f"asked {who} to stop; underfoot study run goes on from there")


def live(study: StudyPath, out: Folder = None) -> None:
    """Write live.html of what is finished now: front, failures, cost so far and what is left.

    A study that runs writes it by itself.
    """
    from underfoot.core import InputError
    from underfoot.report.live_study import PAGE, write_live_page

    chosen = _study(study, out)
    if not chosen.store.exists:
        what = f"the study in {chosen.store.folder} has not begun"
        raise InputError(what, where="STUDY", remedy=f"Begin it: underfoot study run {study}")
    write_live_page(chosen)
    print(f"Page: {chosen.store.folder / PAGE}")


def status(study: StudyPath, out: Folder = None, json: AsJson = False) -> None:
    """Print how far a study is, its throughput, the time left and why cases have no numbers."""
    from underfoot.explore.status import study_status

    finish(study_status(_study(study, out)), None, json=json, everything=True)


def report(study: StudyPath, out: Folder = None) -> None:
    """Write results.csv, results.parquet, surrogate.json and report.html of what is finished."""
    from underfoot.core.progress import bar
    from underfoot.report.design_study import write_study_report

    chosen = _study(study, out)
    with bar("report") as progress:
        written = write_study_report(chosen, chosen.result(), progress=progress)
    finish(chosen.result(), written, json=False)


def best(
    study: StudyPath,
    out: Folder = None,
    count: Annotated[int, typer.Option("--count", min=1, help="Designs.")] = 5,
    json: AsJson = False,
) -> None:
    """Print the best designs, with the probability that each has a higher COF than the next."""
    from itertools import pairwise

    from underfoot.core.presentation import Table, percent

    result = _study(study, out).result()
    designs = result.best(count)
    chances = [result.higher_cof(design, other) for design, other in pairwise(designs)]
    if json:
        known = {(one["design"], one["again"]): one for one in result.to_dict()["designs"]}
        rows = [known[design.number, design.again] for design in designs]
        for row, chance in zip(rows, [*chances, None], strict=False):
            row["higher_cof_than_next"] = chance
        print_json(rows)
        return
    table = result.design_table(designs, "Best designs")
    texts = ["" if chance is None else percent(chance) for chance in [*chances, None]]
    rows = [[*row, text] for row, text in zip(table.rows, texts, strict=False)]
    print_table(Table(table.title, (*table.columns, "COF above the next"), rows))


def export(
    study: StudyPath,
    to: Annotated[Path, typer.Argument(metavar="FOLDER", help="New folder.")],
    out: Folder = None,
    count: Annotated[int, typer.Option("--count", min=1, help="Best designs.")] = 3,
    step: Annotated[
        bool, typer.Option("--step/--no-step", help="Soles as STEP too (needs the extra cad).")
    ] = True,
    overwrite: Overwrite = False,
) -> None:
    """Write the table of all cases, and of the best designs case files and soles as STEP."""
    from underfoot.explore.export import export_designs

    for line in export_designs(_study(study, out), to, count=count, step=step, overwrite=overwrite):
        say(line)
    print(f"Files in {to}")


def posterior(
    readings: Annotated[
        Path,
        typer.Argument(help="Study file with [uncertain] and [[reading]]."),
    ],
    out: Annotated[Path, typer.Option("--out", help="File of draws (CSV).")],
    folder: Annotated[
        Path | None,
        typer.Option("--study", help="Folder of its runs; by default out/NAME."),
    ] = None,
    on: On = None,
    workers: Workers = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Find parameters of a case from your own readings: their joint posterior.

    The model is run where a surrogate needs it; its own discrepancy is found too. A study uses
    the draws with posterior = "FILE" under [uncertain].
    """
    from underfoot.core import InputError
    from underfoot.core.progress import bar
    from underfoot.explore import Study
    from underfoot.explore.posterior import posterior as joint

    if out.exists() and not overwrite:
        raise InputError(
            Message("{out} exists", out=out), where="--out", remedy="Add --overwrite to replace it"
        )
    study = Study.load(readings, folder)
    with bar(study.plan.name) as progress:
        answer = joint(study, on=on, workers=workers, progress=progress)
    if answer.usable:
        out.parent.mkdir(parents=True, exist_ok=True)
        answer.write(out)
    finish(answer, None, json=json)
    if answer.usable and not json:
        print(f'\nwrote {out}\nUse it: posterior = "{out.name}" under [uncertain] of a study')


for command in (check, run, work, stop, status, live, report, best, export):
    study_app.command()(guard_command(command))
