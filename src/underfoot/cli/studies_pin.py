"""What ``underfoot studies run`` prints and writes for the pin-on-disk studies (g2, g3)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from underfoot.studies.pin_study import PinStudy, PinTable
    from underfoot.studies.registry import Study


def refuse_options(name: str, given: Mapping[str, object]) -> None:
    """Refuse options that only the study g1 has."""
    from underfoot.core import InputError

    for option, value in given.items():
        if value:
            raise InputError(
                f"study {name} has no such setting", where=option, remedy=f"Leave out {option}"
            )


def run_pin_study(chosen: Study, *, out: Path | None, json: bool, overwrite: bool) -> None:
    """Run a pin-on-disk study; print it, and write tables and figures to ``out``."""
    from importlib import import_module

    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar

    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with bar(chosen.title.partition(":")[0]) as progress:
        found: PinStudy = import_module(chosen.module).run(progress=progress)
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_pin_study(found, staging)
    if json:
        import json as json_text

        print(json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False))
        return
    _show(found, chosen.source, out)


def write_pin_study(found: PinStudy, folder: Path) -> None:
    """Write tables, statements and figures of a study into an existing folder."""
    import csv
    import json as json_text

    (folder / "study.json").write_text(
        json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False), encoding="utf-8"
    )
    tables = [(table.name, table.columns, table.rows) for table in found.tables]
    tables.append(
        (
            "verdicts",
            ("quantity", "source", "printed or wanted", "ours", "verdict", "reason"),
            tuple(
                (
                    line.quantity,
                    line.source,
                    line.printed,
                    line.ours,
                    str(line.verdict),
                    line.reason,
                )
                for line in found.lines
            ),
        )
    )
    if found.curves:
        rows = []
        for curve in found.curves:
            for i, speed in enumerate(curve.speed):
                band = (curve.predicted, curve.low, curve.high)
                rows.append(
                    (curve.label, curve.viscosity, float(speed), float(curve.published[i]),
                     curve.kind, *(None if one is None else float(one[i]) for one in band))
                )  # fmt: skip
        tables.append(
            (
                "curves",
                ("fluid", "viscosity_Pa_s", "speed_m_per_s", "published_cof", "published_as",
                 "predicted_cof", "low_95", "high_95"),
                tuple(rows),
            )
        )  # fmt: skip
    for name, columns, rows in tables:
        with (folder / f"{name}.csv").open("w", newline="", encoding="utf-8-sig") as stream:
            writer = csv.writer(stream)
            writer.writerow(columns)
            writer.writerows(rows)
    _write_figures(found, folder)


def _write_figures(found: PinStudy, folder: Path) -> None:
    from underfoot.document.stribeck_figure import blind_figure, error_figure, master_figure

    if found.master is None:
        return
    collapse = next(line for line in found.lines if line.source == "Fig. 16")
    figures = {
        "fig16_master_curve": master_figure(found.curves, found.master, collapse.ours),
        "blind_predictions": blind_figure(found.curves, "50 % glycerol"),
    }
    table = next(table for table in found.tables if table.name == "mechanisms")
    figures["blind_errors"] = error_figure(
        [str(row[1]) for row in table.rows],
        [(float(row[4] or 0.0), float(row[5] or 0.0)) for row in table.rows],
    )
    for name, figure in figures.items():
        figure.savefig(folder / f"{name}.png", dpi=150)


def _show(found: PinStudy, source: str, out: Path | None) -> None:
    from rich.console import Console
    from rich.table import Table

    from underfoot.studies.verdict import Verdict

    console = Console(highlight=False)
    colours = {
        Verdict.REPRODUCED: "green",
        Verdict.WITHIN_SCATTER: "green",
        Verdict.DISAGREES: "red",
    }
    console.print(f"\n{source}", style="bold", markup=False)
    for table in found.tables:
        console.print(f"\n{table.title}", style="bold", markup=False)
        console.print(_rich(table))
    console.print("\nPrinted or wanted, beside ours", style="bold")
    lines = Table(box=None, pad_edge=False)
    for heading in ("", "printed or wanted", "ours", "verdict", "why"):
        lines.add_column(heading)
    for line in found.lines:
        colour = colours.get(line.verdict, "dim")
        cells = (f"{line.quantity} ({line.source})", line.printed, line.ours)
        lines.add_row(
            *(cell.replace("[", "\\[") for cell in cells),
            f"[{colour}]{line.verdict}",
            line.reason.replace("[", "\\["),
        )
    console.print(lines)
    for title, texts in (
        ("What it says", found.conclusions),
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


def _rich(table: PinTable):
    from rich.table import Table

    shown = Table(box=None, pad_edge=False)
    for index, heading in enumerate(table.columns):
        words = all(isinstance(row[index], str) for row in table.rows)
        shown.add_column(heading, justify="left" if words else "right", no_wrap=words)
    for row in table.rows:
        shown.add_row(*(_cell(value) for value in row))
    return shown


def _cell(value: str | float | None) -> str:
    if value is None:
        return "-"
    if isinstance(value, str):
        return value.replace("[", "\\[")
    if value == 0.0 or 1e-3 <= abs(value) < 100:
        return f"{value:.3f}"
    return "0.000" if abs(value) < 1e-12 else f"{value:.3g}"
