"""``underfoot studies ...``: published studies run again, with verdicts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .guard import guarded, say
from .options import AsJson, Overwrite

if TYPE_CHECKING:
    from underfoot.studies.g1 import G1Study
    from underfoot.studies.g1_cases import G1Settings

studies_app = typer.Typer(
    name="studies",
    help="Published studies run again: our numbers beside the printed ones.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)


@studies_app.callback()
def studies() -> None:
    """Published studies run again: our numbers beside the printed ones."""


def list_studies(json: AsJson = False) -> None:
    """List the studies that can be run."""
    from underfoot.studies import STUDIES

    if json:
        import json as json_text

        print(
            json_text.dumps(
                [{"name": s.name, "title": s.title, "source": s.source} for s in STUDIES], indent=2
            )
        )
        return
    for one in STUDIES:
        print(f"{one.name:6s} {one.title}\n       {one.source}")


def run_study(
    name: Annotated[
        str, typer.Argument(help="Name of the study, as g1, or all.", show_default=False)
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            help="Folder for tables and figures; out/studies by default for all.",
            show_default=False,
        ),
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Coarser grids, fewer speeds and persons.")
    ] = False,
    explicit: Annotated[
        bool,
        typer.Option(
            "--explicit",
            help="Explicit finite elements (15 min and more) in place of seconds; goes on where "
            "it was stopped.",
        ),
    ] = False,
    series: Annotated[
        str,
        typer.Option("--series", help="report, broad or both; --explicit: report by default."),
    ] = "",
    control: Annotated[
        str,
        typer.Option("--control", help="While sliding keep the height (the report's) or the load."),
    ] = "height",
    bulk_modulus: Annotated[
        str,
        typer.Option("--bulk-modulus", help="corrected (nu = 0.499) or printed (Table 2)."),
    ] = "corrected",
    shoe_wavelength: Annotated[
        str, typer.Option("--shoe-wavelength", help="Of the shoe's roughness.")
    ] = "0.5 mm",
    floor_wavelength: Annotated[
        str, typer.Option("--floor-wavelength", help="Of the floor's roughness.")
    ] = "0.4 mm",
    processes: Annotated[
        int, typer.Option("--processes", min=1, help="Cases at the same time.")
    ] = 2,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Run a study and print each published number beside ours, with a verdict and its reason.

    With --out: figures, verdicts.csv, cases.csv, study.json. `all` runs every study and writes one
    page (studies.html), summary.csv and summary.md; a study that fails does not stop the others.
    """
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar
    from underfoot.studies import study
    from underfoot.studies.g1 import run

    if name.strip().lower() == "all":
        from .studies_all import run_all_studies
        from .studies_pin import refuse_options

        refuse_options("all", {"--explicit": explicit, "--series": series})
        if not run_all_studies(
            quick=quick, out=out, json=json, overwrite=overwrite, processes=processes
        ):
            raise typer.Exit(4)
        return
    chosen = study(name)
    if chosen.name == "g4":
        from .studies_g4 import run_g4
        from .studies_pin import refuse_options

        refuse_options(chosen.name, {"--explicit": explicit, "--series": series})
        run_g4(chosen, quick=quick, processes=processes, out=out, json=json, overwrite=overwrite)
        return
    if chosen.name in ("g5", "g6", "calibration"):
        from .studies_people import run_people_study
        from .studies_pin import refuse_options

        refuse_options(chosen.name, {"--explicit": explicit, "--series": series})
        run_people_study(
            chosen, quick=quick, out=out, json=json, overwrite=overwrite, processes=processes
        )
        return
    if chosen.name in ("g2", "g3"):
        from .studies_pin import refuse_options, run_pin_study

        refuse_options(chosen.name, {"--quick": quick, "--explicit": explicit, "--series": series})
        run_pin_study(chosen, out=out, json=json, overwrite=overwrite)
        return
    settings = _settings(
        series or ("report" if explicit else "both"),
        control,
        bulk_modulus,
        (shoe_wavelength, floor_wavelength),
        explicit,
        processes,
    )
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    if quick:
        settings = settings.quick
    try:
        with bar(chosen.title.partition(":")[0]) as progress:
            found = run(settings, progress=progress)
    except KeyboardInterrupt:
        _say_what_is_kept(settings)
        raise
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_study(found, staging)
    if json:
        import json as json_text

        print(json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False))
    else:
        _show(found, chosen.source, out, quick)
    if any(row.cof_hysteresis != row.cof_hysteresis for row in found.rows):
        raise typer.Exit(4)


def _say_what_is_kept(settings: G1Settings) -> None:
    from underfoot.studies.g1_cases import matrix
    from underfoot.studies.g1_kept import kept_cases

    if settings.solver == "explicit":
        cases = list(matrix(settings))
        say(
            f"{kept_cases(settings, cases)} of {len(cases)} cases are finished and kept: the same "
            "command goes on from there"
        )


def write_study(found: G1Study, folder: Path) -> None:
    """Write figures, tables and data of a study into an existing folder."""
    import csv
    import json as json_text
    from dataclasses import asdict

    from underfoot.document.g1_figures import save_g1_figures

    (folder / "study.json").write_text(
        json_text.dumps(found.as_dict(), indent=2, ensure_ascii=False), encoding="utf-8"
    )
    for name, rows in (
        ("verdicts.csv", [line.as_dict() for line in found.lines]),
        ("cases.csv", [asdict(row) for row in found.rows]),
        ("errata.csv", [asdict(erratum) for erratum in found.errata]),
    ):
        with (folder / name).open("w", newline="", encoding="utf-8-sig") as stream:
            table = csv.DictWriter(stream, list(rows[0]))
            table.writeheader()
            table.writerows(rows)
    for history in found.histories:
        with (folder / f"fig03_{history.series}.csv").open("w", newline="") as stream:
            writer = csv.writer(stream)
            writer.writerow(["time_s", "sliding_m", "area_m2", "normal_force_N", "shear_force_N"])
            writer.writerows(
                zip(
                    history.time,
                    history.distance,
                    history.real_contact_area,
                    history.normal_force,
                    history.shear_force,
                    strict=True,
                )
            )
    save_g1_figures(found, folder)


def _settings(
    series: str,
    control: str,
    bulk_modulus: str,
    wavelengths: tuple[str, str],
    explicit: bool,
    processes: int,
) -> G1Settings:
    from underfoot.core import to_si, unknown_name
    from underfoot.studies.g1_cases import G1Settings

    if series not in ("report", "broad", "both"):
        raise unknown_name("series", series, ("report", "broad", "both"), where="--series")
    if control not in ("height", "load"):
        raise unknown_name("control", control, ("height", "load"), where="--control")
    shoe, floor = (
        to_si(text, "m", where=where)
        for text, where in zip(
            wavelengths, ("--shoe-wavelength", "--floor-wavelength"), strict=True
        )
    )
    return G1Settings(
        series=("report", "broad") if series == "both" else (series,),
        solver="explicit" if explicit else "condensed",
        control="displacement" if control == "height" else "load",
        bulk_modulus=bulk_modulus,
        shoe_wavelength=shoe,
        floor_wavelength=floor,
        processes=processes,
    )


def _show(found: G1Study, source: str, out: Path | None, quick: bool) -> None:
    from rich.console import Console
    from rich.table import Table

    from underfoot.studies.g1_cases import SERIES
    from underfoot.studies.verdict import Verdict

    console = Console(highlight=False)
    colours = {
        Verdict.REPRODUCED: "green",
        Verdict.WITHIN_SCATTER: "green",
        Verdict.TREND_ONLY: "yellow",
        Verdict.DISAGREES: "red",
        Verdict.NOT_AVAILABLE: "dim",
    }
    console.print(f"\n{source}", style="bold", markup=False)
    for name in found.settings.series:
        console.print(f"\n{SERIES[name]}", style="bold", markup=False)
        lines = [line for line in found.lines if line.series == name]
        reasons = list(dict.fromkeys(line.reason for line in lines))
        table = Table(box=None, pad_edge=False)
        for heading in ("change in", "printed", "ours", "verdict", "why"):
            table.add_column(heading, no_wrap=heading != "change in")
        for quantity in dict.fromkeys(line.quantity for line in lines):
            table.add_row(f"[bold]{quantity}")
            for line in lines:
                if line.quantity == quantity:
                    table.add_row(
                        f"  {line.condition}",
                        line.printed_text,
                        line.ours_text,
                        f"[{colours[line.verdict]}]{line.verdict}",
                        f"({reasons.index(line.reason) + 1})",
                    )
        console.print(table)
        for number, reason in enumerate(reasons, start=1):
            console.print(f"  ({number}) {reason}", markup=False, style="dim")
    console.print("\nVerdicts:", style="bold")
    for verdict in Verdict:
        console.print(f"  {verdict}: {verdict.rule}", markup=False)
    console.print("\nNot taken as printed:", style="bold")
    for one in found.errata:
        console.print(f"  {one.where}: {one.printed} -> {one.used}: {one.why}", markup=False)
    console.print("\nNotes:", style="bold")
    for note in found.notes:
        console.print(f"  {note}", markup=False)
    if quick:
        console.print("  --quick: coarser mesh; the verdicts can change without it")
    console.print(
        f"\n{len(found.rows)} cases in {found.seconds:.0f} s "
        f"({found.process_seconds:.0f} s of processor time)"
    )
    if out is not None:
        console.print(f"Figures and tables in {out}", markup=False)


studies_app.command("list")(guarded(list_studies))
studies_app.command("run")(guarded(run_study))
