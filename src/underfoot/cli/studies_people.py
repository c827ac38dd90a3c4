"""What ``underfoot studies run`` prints and writes for g5, g6 and calibration."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from underfoot.studies.registry import Study
    from underfoot.studies.study_result import StudyResult


def run_people_study(
    chosen: Study, *, quick: bool, out: Path | None, json: bool, overwrite: bool, processes: int
) -> None:
    """Run such a study; print it, and write tables and figures to ``out``."""
    from importlib import import_module

    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar

    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with bar(chosen.name) as progress:
        found: StudyResult = import_module(chosen.module).run(
            quick=quick, processes=processes, progress=progress
        )
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_people_study(found, staging)
    if json:
        import json as json_text

        print(json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False))
        return
    _show(found, chosen.source, out, quick)


def write_people_study(found: StudyResult, folder: Path) -> None:
    """Write study.json, tables as CSV, and figures into an existing folder."""
    import csv
    import json as json_text
    from dataclasses import fields

    from underfoot.studies.pin_study import PinLine

    (folder / "study.json").write_text(
        json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False), encoding="utf-8"
    )
    names = [field.name for field in fields(PinLine)]
    tables = [(one.name, one.columns, one.rows) for one in found.tables]
    lines = tuple(tuple(str(getattr(line, name)) for name in names) for line in found.lines)
    tables.append(("verdicts", tuple(names), lines))
    for name, columns, rows in tables:
        with (folder / f"{name}.csv").open("w", newline="", encoding="utf-8-sig") as stream:
            writer = csv.writer(stream)
            writer.writerow(columns)
            writer.writerows(rows)
    if found.name == "g5":
        from underfoot.document.g5_figures import g5_figures as figures
    elif found.name == "g6":
        from underfoot.document.g6_figures import g6_figures as figures
    else:
        from underfoot.document.calibration_figure import calibration_figures as figures
    for name, figure in figures(found.data).items():
        figure.savefig(folder / f"{name}.png", dpi=150)


def _show(found: StudyResult, source: str, out: Path | None, quick: bool) -> None:
    from rich.console import Console
    from rich.table import Table

    from .studies_pin import _rich

    console = Console(highlight=False)
    console.print(f"\n{source}", style="bold", markup=False)
    for table in found.tables:
        console.print(f"\n{table.title}", style="bold", markup=False)
        console.print(_rich(table))
    console.print("\nPrinted, beside ours", style="bold")
    lines = Table(box=None, pad_edge=False)
    for heading in ("", "printed", "ours", "difference", "verdict", "why"):
        lines.add_column(heading)
    for line in found.lines:
        cells = (f"{line.quantity} ({line.source})", line.printed, line.ours, line.difference)
        lines.add_row(
            *(cell.replace("[", "\\[") for cell in cells),
            str(line.verdict),
            line.reason.replace("[", "\\["),
        )
    console.print(lines)
    for title, texts in (
        ("What it says", found.conclusions),
        ("How it was done", found.notes),
        ("Assumed", found.assumptions),
        (
            "Not taken as printed",
            [f"{one.where}: {one.printed} -> {one.used}: {one.why}" for one in found.errata],
        ),
    ):
        console.print(f"\n{title}:", style="bold")
        for text in texts:
            console.print(f"  {text}", markup=False)
    if quick:
        console.print("\n  --quick: coarser; the verdicts can change without it")
    console.print(f"\n{found.seconds:.0f} s ({found.process_seconds:.0f} s of processor time)")
    if out is not None:
        console.print(f"Figures and tables in {out}", markup=False)
