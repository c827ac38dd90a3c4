"""``underfoot studies``: published studies run again, with verdicts."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from underfoot.core import InputError

from .guard import guard_command, say
from .options import AsJson, OutFolder, Overwrite, Quick, ShowAll
from .output import print_json, print_table, show

if TYPE_CHECKING:
    from collections.abc import Sequence

    from underfoot.studies import PublishedStudyResult

studies_app = typer.Typer(
    name="studies",
    help="Published studies run again: computed numbers beside the printed ones.",
    no_args_is_help=True,
)


def _of_g1(name: str, text: str) -> Any:
    return typer.Option(f"--{name}", help=f"Only of g1: {text}")


def list_studies(json: AsJson = False) -> None:
    """List the studies that can be run."""
    from underfoot.studies import studies, study

    rows = []
    for name in studies():
        try:
            rows.append({"name": name, "title": study(name).title, "source": study(name).source})
        except InputError as error:  # a study of another package that is broken
            say(f"caution: {error.what}")
    if json:
        print_json(rows)
        return
    for row in rows:
        print(f"{row['name']:12s} {row['title']}\n             {row['source']}")


def run_study(
    name: Annotated[str, typer.Argument(help="Name of the study, as g1, or all.")],
    out: OutFolder = None,
    quick: Quick = False,
    explicit: Annotated[
        bool, _of_g1("explicit", "explicit finite elements (15 min and more) in place of seconds.")
    ] = False,
    series: Annotated[
        str, _of_g1("series", "report, broad or both; --explicit: report by default")
    ] = "",
    control: Annotated[str, _of_g1("control", "while sliding keep height or load.")] = "height",
    bulk_modulus: Annotated[
        str, _of_g1("bulk-modulus", "corrected (nu = 0.499) or printed.")
    ] = "corrected",
    shoe_wavelength: Annotated[
        str, _of_g1("shoe-wavelength", "of the shoe's roughness.")
    ] = "0.5 mm",
    floor_wavelength: Annotated[
        str, _of_g1("floor-wavelength", "of the floor's roughness.")
    ] = "0.4 mm",
    processes: Annotated[
        int, typer.Option(min=1, help="Cases, or positions of a tread, computed at the same time.")
    ] = 2,
    json: AsJson = False,
    show_all: ShowAll = False,
    overwrite: Overwrite = False,
) -> None:
    """Run a study: each published number beside the computed one, a verdict and its reason.

    With --out: the page report.html, figures, tables, verdicts.csv, study.json. `all` runs every
    study into one page (studies.html), summary.csv and summary.md; a study that fails does not
    stop the others. What is finished is kept: the same command goes on from there.
    """
    from underfoot.core.files import check_writable_folder
    from underfoot.core.progress import bar
    from underfoot.studies import Options, run_all, study
    from underfoot.studies import run_study as run_one

    everything = name.strip().lower() == "all"
    wavelengths = (shoe_wavelength, floor_wavelength)
    settings = _settings(name, explicit, series, control, bulk_modulus, wavelengths)
    if everything and out is None and not json:
        out = Path("out") / "studies"
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    chosen = None if everything else study(name)
    results: list[PublishedStudyResult]
    try:
        with bar(name) as progress:
            options = Options(quick, processes, 0, settings, progress)
            one = [] if chosen is None else [run_one(chosen, options)]
            results = one or list(run_all(options=options))
    except KeyboardInterrupt:
        say("stopped: what is finished is kept; the same command goes on from there")
        raise
    _deliver(results, out, everything=everything, json=json, overwrite=overwrite, show_all=show_all)
    if any(result.error for result in results):
        raise typer.Exit(4)


def summarise(
    folder: Annotated[Path, typer.Argument(help="Folder of earlier runs.")] = Path("out/studies"),
    out: OutFolder = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
) -> None:
    """Judge finished studies again by the statements of today; nothing is computed."""
    from underfoot.core.files import check_writable_folder
    from underfoot.studies import read_results

    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    _deliver(read_results(folder), out, everything=True, json=json, overwrite=overwrite)


def errata(
    name: Annotated[str, typer.Argument(help="Name of a study, as g1; all by default.")] = "all",
    json: AsJson = False,
) -> None:
    """List what is not taken as printed in the report: where, printed, used, and why."""
    from underfoot.core.presentation import Table
    from underfoot.studies import studies, study

    chosen = studies() if name.strip().lower() == "all" else (name,)
    columns = ("where", "printed", "used", "why")
    rows = [entry for each in chosen for entry in study(each).errata]
    if json:
        print_json([dict(zip(columns, row, strict=True)) for row in rows])
        return
    print_table(Table(f"Not taken as printed ({len(rows)})", columns, rows))


def _settings(
    name: str,
    explicit: bool,
    series: str,
    control: str,
    bulk_modulus: str,
    wavelengths: tuple[str, str],
) -> Any:
    """Return the settings of g1; None where every option is as it is by default."""
    from underfoot.core import InputError, to_si, unknown_name

    given = {
        "--explicit": explicit,
        "--series": series,
        "--control": control != "height",
        "--bulk-modulus": bulk_modulus != "corrected",
        "--shoe-wavelength": wavelengths[0] != "0.5 mm",
        "--floor-wavelength": wavelengths[1] != "0.4 mm",
    }
    used = [option for option, value in given.items() if value]
    if not used:
        return None
    if name.strip().lower() != "g1":
        raise InputError(
            f"study {name} has no such setting", where=used[0], remedy=f"Leave out {used[0]}"
        )
    from underfoot.studies.g1 import Settings as settings

    series = series or ("report" if explicit else "both")
    for option, value, known in (
        ("series", series, ("report", "broad", "both")),
        ("control", control, ("height", "load")),
    ):
        if value not in known:
            raise unknown_name(option, value, known, where=f"--{option}")
    return settings(
        series=("report", "broad") if series == "both" else (series,),
        solver="explicit" if explicit else "condensed",
        control="displacement" if control == "height" else "load",
        bulk_modulus=bulk_modulus,
        shoe_wavelength=to_si(wavelengths[0], "m", where="--shoe-wavelength"),
        floor_wavelength=to_si(wavelengths[1], "m", where="--floor-wavelength"),
    )


def _deliver(
    results: Sequence[PublishedStudyResult],
    out: Path | None,
    *,
    everything: bool,
    json: bool,
    overwrite: bool,
    show_all: bool = False,
) -> None:
    """Write and print results."""
    from underfoot.core.files import whole_folder
    from underfoot.report.studies_page import studies_page, write_study
    from underfoot.studies import write_summary

    page = "studies.html" if everything else "report.html"
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            images = {}
            for result in (r for r in results if not r.error):
                place = staging / result.study.name if everything else staging
                place.mkdir(exist_ok=True)
                for name in write_study(result, place):
                    images[result.study.name, name] = (place / f"{name}.png").read_bytes()
            if everything:
                write_summary(results, staging)
            text = studies_page(results, images, quick=any(r.quick for r in results))
            (staging / page).write_text(text, encoding="utf-8")
    if json:
        content: Any = [
            judgement.to_dict() for result in results for judgement in result.judgements
        ]
        print_json(content if everything else results[0].to_dict())
    elif everything:
        _show_headline(results)
    else:
        show(results[0], everything=show_all)
    if out is not None and not json:
        print(f"Files in {out}; open {out / page}")


def _show_headline(results: Sequence[PublishedStudyResult]) -> None:
    from underfoot.core.presentation import Table
    from underfoot.studies import Verdict, headline

    rows = [(name, *map(str, row)) for name, row in headline(results)]
    print_table(Table("Independent statements", ("study", *map(str, Verdict)), rows))
    for result in results:
        if result.error:
            say(f"{result.study.name} failed: {result.error}")


studies_app.command("list")(guard_command(list_studies))
studies_app.command("run")(guard_command(run_study))
studies_app.command("summary")(guard_command(summarise))
studies_app.command("errata")(guard_command(errata))
