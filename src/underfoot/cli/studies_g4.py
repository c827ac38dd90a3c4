"""What ``underfoot studies run g4`` prints and writes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from underfoot.studies.registry import Study
    from underfoot.studies.study_result import StudyResult


def run_g4(
    chosen: Study, *, quick: bool, processes: int | None, out: Path | None, json: bool,
    overwrite: bool,
) -> StudyResult:  # fmt: skip
    """Run the study; print it, and write tables and figures to ``out``."""
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar
    from underfoot.studies.g4 import run

    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with bar(chosen.title.partition(":")[0]) as progress:
        found = run(quick=quick, processes=processes, progress=progress)
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_g4_study(found, staging)
    if json:
        import json as json_text

        print(json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False))
    else:
        show_g4(found, chosen.source, out)
    return found


def write_g4_study(found: StudyResult, folder: Path) -> None:
    """Write tables, statements, maps and figures into an existing folder."""
    import csv
    import json as json_text

    from underfoot.document.g4_figures import save_g4_figures

    (folder / "study.json").write_text(
        json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False), encoding="utf-8"
    )
    sheets = [(table.name, table.columns, table.rows) for table in found.tables]
    heads = ("quantity", "source", "printed", "ours", "difference", "verdict", "reason")
    lines = tuple(tuple(str(getattr(line, head)) for head in heads) for line in found.lines)
    sheets.append(("verdicts", heads, lines))
    for one in found.data["results"]:
        if one.condition.printed_peak is not None:
            reading = one.reading
            rows = tuple(
                (1e3 * float(x), 1e3 * float(y), float(reading.pressure[i, j]) / 1e3)
                for i, x in enumerate(reading.x)
                for j, y in enumerate(reading.y)
            )
            sheets.append(
                (f"fig29_{one.condition.kind}", ("from_back_mm", "left_mm", "pressure_kPa"), rows)
            )
    for name, columns, rows in sheets:
        with (folder / f"{name}.csv").open("w", newline="", encoding="utf-8-sig") as stream:
            writer = csv.writer(stream)
            writer.writerow(columns)
            writer.writerows(rows)
    save_g4_figures(found.data, folder)


def show_g4(found: StudyResult, source: str, out: Path | None) -> None:
    """Print the study: conditions, lines with verdicts, sentences, assumptions, errata."""
    from rich.console import Console
    from rich.table import Table

    from underfoot.studies.verdict import Verdict

    console = Console(highlight=False)
    colours = {
        Verdict.REPRODUCED: "green",
        Verdict.WITHIN_SCATTER: "green",
        Verdict.TREND_ONLY: "yellow",
        Verdict.DISAGREES: "red",
    }
    console.print(f"\n{source}", style="bold", markup=False)
    _conditions(console, found)
    lines = Table(box=None, pad_edge=False)
    for heading in ("printed beside ours", "printed", "ours", "verdict", "why"):
        lines.add_column(heading)
    for line in found.lines:
        lines.add_row(
            f"{line.quantity} ({line.source})", line.printed, line.ours,
            f"[{colours.get(line.verdict, 'dim')}]{line.verdict}", line.reason,
        )  # fmt: skip
    console.print()
    console.print(lines)
    for title, texts in (
        ("What it says", found.conclusions),
        ("Assumed, the same for all twelve", found.assumptions),
        ("How it was done", found.notes),
        (
            "Not taken as printed",
            [f"{one.where}: {one.printed} -> {one.used}: {one.why}" for one in found.errata],
        ),
    ):
        console.print(f"\n{title}:", style="bold")
        for text in texts:
            console.print(f"  {text}", markup=False)
    console.print(f"\n{found.seconds:.0f} s")
    if out is not None:
        console.print(f"Figures and tables in {out}", markup=False)


def _conditions(console, found: StudyResult) -> None:
    from rich.table import Table

    shown = Table(box=None, pad_edge=False)
    for heading in ("condition", "report N", "sensor N", "under the sole N", "peak kPa", "COF"):
        shown.add_column(heading, justify="left" if heading == "condition" else "right")
    for one in found.data["results"]:
        printed = one.condition.printed_load
        shown.add_row(
            one.condition.name, "< 5" if printed is None else f"{printed:.0f}",
            f"{one.load.value:.1f}", f"{one.true_load.value:.0f}", f"{one.peak.value / 1e3:.0f}",
            f"{one.cof.value:.3f}",
        )  # fmt: skip
    console.print(shown)
