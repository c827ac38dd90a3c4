"""``underfoot risk``: the chance of a slip, what limits it, what would help most."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson, CasePath, CatalogueFolders, FullGrid, OutFolder, Overwrite, Settings

if TYPE_CHECKING:
    from underfoot.assess.risk import RiskReport


def risk(
    case: CasePath,
    wanted: Annotated[
        str, typer.Option("--wanted", help="Chance of a slip to aim at, as 5 % or 0.05.")
    ] = "5 %",
    full: FullGrid = False,
    out: OutFolder = None,
    set_: Settings = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Say how likely a step slips, what limits the friction and which changes help most.

    Every change (another tread, compound, floor, cleaning, shorter steps) is computed with the
    whole model. With --out: risk.json and changes.csv.
    """
    from underfoot.assess.risk import risk_report
    from underfoot.core import to_si
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar

    from .options import loaded

    chance = to_si(wanted, "1", where="--wanted")
    given = loaded(case, catalogue, set_)
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with bar(given.name) as progress:
        found = risk_report(given, wanted=chance, quick=not full, processes=None, progress=progress)
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_risk(found, staging)
    if json:
        import json as json_text

        print(json_text.dumps(as_dict(found), indent=2, ensure_ascii=False))
    else:
        _show(found, out)
    if not found.outcome.usable:
        raise typer.Exit(4)


def as_dict(found: RiskReport) -> dict[str, Any]:
    """Return a risk report as plain data."""
    from underfoot.document.risk_sentences import risk_sentences

    return {
        "case": found.case,
        "sentences": risk_sentences(found),
        "cof": found.outcome.scalars["cof"].as_dict(),
        "slip_probability": found.outcome.scalars["slip_probability"].as_dict(),
        "limit": {
            "kind": found.limit.kind,
            "film_share": found.limit.film_share if found.limit.kind != "dry" else None,
            "cof_drained": found.limit.drained,
        },
        "wanted": found.wanted,
        "more_friction": found.more_friction,
        "models": [
            {
                "name": one.name,
                "source": one.source,
                "probability": one.probability,
                "interval_95": [one.low, one.high],
                "needed_acof": one.needed_acof,
            }
            for one in found.models
        ],
        "changes": [
            {
                "name": one.change.name,
                "words": one.change.words,
                "lever": one.change.lever,
                "values": dict(one.change.values),
                "cof": one.number("cof") if one.computed else None,
                "slip_probability": one.number("slip_probability") if one.computed else None,
                "fluid_load": one.number("fluid_load") if one.computed else None,
                "reason": one.reason,
            }
            for one in found.changes
        ],
    }


def write_risk(found: RiskReport, folder: Path) -> None:
    """Write risk.json and changes.csv into an existing folder."""
    import csv
    import json

    content = as_dict(found)
    text = json.dumps(content, indent=2, ensure_ascii=False)
    (folder / "risk.json").write_text(text + "\n", encoding="utf-8")
    with (folder / "changes.csv").open("w", newline="", encoding="utf-8") as stream:
        names = ("name", "lever", "words", "cof", "slip_probability", "fluid_load", "reason")
        table = csv.DictWriter(stream, names, extrasaction="ignore")
        table.writeheader()
        table.writerows(content["changes"])


def _show(found: RiskReport, out: Path | None) -> None:
    from rich.console import Console

    from underfoot.document.risk_sentences import bought_words, risk_sentences
    from underfoot.document.sentences import percent

    from .show import table

    console = Console(highlight=False)
    console.print(f"\n[bold]{found.case}[/bold]")
    for line in risk_sentences(found):
        console.print(line, markup=False)
    if found.outcome.usable:
        best = {id(one): place for place, one in enumerate(found.best, 1)}
        console.print("\nWhat it would take, each computed:")
        rows = [
            (f"{best[id(one)]}." if id(one) in best else "-", one.change.words, bought_words(one))
            for one in sorted(found.changes, key=lambda each: best.get(id(each), 99))
        ]
        console.print(table((), rows))
        console.print("\nThe same friction by every model:")
        heads = ("model", "chance of a slip", f"friction for {percent(found.wanted)}")
        models = [
            (
                one.name,
                percent(one.probability),
                "-" if one.needed_acof is None else f"{one.needed_acof:.3f}",
            )
            for one in found.models
        ]
        console.print(table(heads, models))
    if out is not None:
        console.print(f"\nFiles in {out}", markup=False)
