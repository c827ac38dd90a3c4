"""``underfoot studies run all``: every study, one page, one table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .guard import say

if TYPE_CHECKING:
    from underfoot.studies.summary import StudyRun


def run_all_studies(
    *, quick: bool, out: Path | None, json: bool, overwrite: bool, processes: int
) -> bool:
    """Run every study; return whether all gave a result.

    With ``out``: studies.html, summary.csv, summary.md and a folder for each study.
    """
    import sys

    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar
    from underfoot.studies.summary import run_all, summary_lines, write_summary

    folder = out if out is not None or json else Path("out") / "studies"
    if folder is not None:
        check_writable_folder(folder, overwrite=overwrite)
    try:
        if sys.stderr.isatty():
            with bar("studies") as progress:
                runs = run_all(quick=quick, processes=processes, progress=progress)
        else:
            runs = run_all(quick=quick, processes=processes, progress=_spoken())
    except KeyboardInterrupt:
        say("stopped: what is finished is kept; the same command goes on from there")
        raise
    if folder is not None:
        with whole_folder(folder, overwrite=overwrite) as staging:
            pictures = write_all(runs, staging)
            write_summary(runs, staging, quick=quick)
            write_page(runs, pictures, staging, quick=quick)
    if json:
        import json as json_text
        from dataclasses import asdict

        print(
            json_text.dumps(
                [asdict(line) for line in summary_lines(runs)], indent=2, ensure_ascii=False
            )
        )
    else:
        _show(runs, folder)
    return not any(run.error for run in runs)


def write_all(runs: list[StudyRun], folder: Path) -> dict[str, list[str]]:
    """Write each study into its own folder; return its pictures' names without ending."""
    pictures: dict[str, list[str]] = {}
    for run in runs:
        if run.error:
            continue
        place = folder / run.study.name
        place.mkdir()
        _writer(run.study.name)(run.result, place)
        if run.study.name in ("g2", "g3"):
            from underfoot.document.pin_figures import pin_figures

            for name, figure in pin_figures(run.result).items():
                figure.savefig(place / f"{name}.png", dpi=130)
        pictures[run.study.name] = sorted(path.stem for path in place.glob("*.png"))
    return pictures


def write_page(
    runs: list[StudyRun], pictures: dict[str, list[str]], folder: Path, *, quick: bool
) -> None:
    """Write studies.html, which holds every table and picture and needs no network."""
    from underfoot.document.studies_page import studies_page
    from underfoot.studies.figure_list import FIGURES, figure_rows
    from underfoot.studies.summary import summary_lines, verdict_counts
    from underfoot.studies.verdict import Verdict

    images = {
        (study, name): (folder / study / f"{name}.png").read_bytes()
        for study, names in pictures.items()
        for name in names
    }
    lines = summary_lines(runs)
    page = studies_page(
        runs,
        lines,
        counts=verdict_counts(lines),
        rules={str(verdict): verdict.rule for verdict in Verdict},
        figures=figure_rows(pictures),
        remarks={(one.study, one.file): one.remark for one in FIGURES if one.file},
        images=images,
        quick=quick,
    )
    (folder / "studies.html").write_text(page, encoding="utf-8")


def _writer(name: str) -> Callable[[Any, Path], None]:
    if name == "g1":
        from .studies import write_study

        return write_study
    if name in ("g2", "g3"):
        from .studies_pin import write_pin_study

        return write_pin_study
    if name == "g4":
        from .studies_g4 import write_g4_study

        return write_g4_study
    from .studies_people import write_people_study

    return write_people_study


def _spoken() -> Callable[..., None]:
    """Return a progress receiver that says each stage once."""
    said = [""]

    def told(stage: str, fraction: float, residual: float | None = None) -> None:
        name = stage.partition(":")[0]
        if name != said[0]:
            said[0] = name
            say(f"study {name} ({100 * fraction:.0f} %)")

    return told


def _show(runs: list[StudyRun], folder: Path | None) -> None:
    from rich.console import Console
    from rich.table import Table

    from underfoot.studies.summary import summary_lines, verdict_counts
    from underfoot.studies.verdict import Verdict

    console = Console(highlight=False)
    counts = verdict_counts(summary_lines(runs))
    table = Table(box=None, pad_edge=False)
    table.add_column("study")
    for verdict in Verdict:
        table.add_column(str(verdict), justify="right")
    table.add_column("s", justify="right")
    for run in runs:
        row = counts.get(run.study.name, {})
        table.add_row(
            run.study.name, *(str(row.get(str(v), "-")) for v in Verdict), f"{run.seconds:.0f}"
        )
    console.print(table)
    for run in runs:
        if run.error:
            console.print(f"{run.study.name} failed: {run.error}", style="red", markup=False)
    if folder is not None:
        console.print(f"Files in {folder}; open {folder / 'studies.html'}", markup=False)
