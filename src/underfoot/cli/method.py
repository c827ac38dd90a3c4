"""``underfoot test``: what a test method would find for the shoe of a case."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson, CasePath, CatalogueFolders, OutFolder, Overwrite, Settings

if TYPE_CHECKING:
    from underfoot.assess.method import Condition, MethodPrediction


def by_method(
    case: CasePath,
    method: Annotated[
        str,
        typer.Option(
            "--method",
            help="iso13287, astmf2913, report-slip-tester, report-whole-shoe or a set-up of the "
            "catalogue.",
        ),
    ] = "iso13287",
    keep: Annotated[
        list[str] | None,
        typer.Option(
            "--keep",
            help="What of the case stands against the method: floor, contaminant, normal_force, "
            "shoe_angle or speed; may be given several times.",
            show_default=False,
        ),
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Coarser grid, and the friction law's spread alone.")
    ] = False,
    out: OutFolder = None,
    set_: Settings = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Put a case under the set-up of a test method: predicted COF and chance of passing.

    Angle, load, speed, floor, contaminant and averaging window are the method's; each is listed
    with how sure its source is. With --out: test.json, conditions.csv and requirements.csv.
    """
    from underfoot.assess.method import predict
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar

    from .options import loaded

    given = loaded(case, catalogue, set_)
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with bar(given.name) as progress:
        found = predict(
            given,
            method,
            keep=keep or (),
            with_band=not quick,
            quick=quick,
            processes=None,
            progress=progress,
        )
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_prediction(found, staging)
    if json:
        import json as json_text

        print(json_text.dumps(as_dict(found), indent=2, ensure_ascii=False))
    else:
        _show(found, given.name, out)
    if any(not each.outcome.usable for each in found.conditions):
        raise typer.Exit(4)


def as_dict(found: MethodPrediction) -> dict[str, Any]:
    """Return a prediction as plain data."""
    return {
        "method": found.method,
        "title": found.title,
        "source": found.source,
        "requirements": [
            {"name": one.name, "required": one.required, "used": one.used, "mark": one.mark}
            for one in found.requirements
        ],
        "conditions": [
            {
                "name": one.name,
                "title": one.title,
                "floor": one.floor,
                "contaminant": one.contaminant,
                "cof": one.cof.as_dict(),
                "interval_95": [one.low, one.high],
                "limit": None if one.limit is None else one.limit.as_dict(),
                "probability_of_passing": one.probability,
                "status": str(one.outcome.status),
                "breaches": list(one.outcome.breaches),
                "assumptions": list(one.outcome.assumptions),
            }
            for one in found.conditions
        ],
    }


def write_prediction(found: MethodPrediction, folder: Path) -> None:
    """Write test.json, conditions.csv and requirements.csv into an existing folder."""
    import csv
    import json

    content = as_dict(found)
    text = json.dumps(content, indent=2, ensure_ascii=False)
    (folder / "test.json").write_text(text + "\n", encoding="utf-8")
    with (folder / "requirements.csv").open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream)
        table.writerow(["requirement", "required", "used", "source"])
        table.writerows((r.name, r.required, r.used, r.mark) for r in found.requirements)
    with (folder / "conditions.csv").open("w", newline="", encoding="utf-8") as stream:
        table = csv.writer(stream)
        table.writerow(
            "condition floor contaminant cof uncertainty low high limit limit_source "
            "probability_of_passing status".split()
        )
        for one in found.conditions:
            limit = ("", "") if one.limit is None else (one.limit.value, one.limit.source)
            numbers = (one.cof.value, one.cof.uncertainty, one.low, one.high, *limit)
            table.writerow(
                [one.title, one.floor, one.contaminant]
                + ["" if each is None else each for each in numbers]
                + ["" if one.probability is None else one.probability, str(one.outcome.status)]
            )


def _show(found: MethodPrediction, name: str, out: Path | None) -> None:
    from rich.console import Console

    from .show import table

    console = Console(highlight=False)
    console.print(f"\n[bold]{name}[/bold] by {found.title}")
    for one in found.conditions:
        console.print(f"  {one.title}: {sentence(one)}", markup=False)
    heads = ("the method asks", "required", "used", "how sure")
    rows = [(row.name, row.required, row.used, row.mark) for row in found.requirements]
    console.print()
    console.print(table(heads, rows))
    breaches = list(dict.fromkeys(b for one in found.conditions for b in one.outcome.breaches))
    if breaches:
        console.print("\nOutside a tested range:")
        for line in breaches:
            console.print(f"  - {line}", markup=False)
    if found.note:
        console.print(f"\n{found.note}", markup=False)
    if out is not None:
        console.print(f"\nFiles in {out}", markup=False)


def sentence(one: Condition) -> str:
    """Return the prediction for one condition in words."""
    if one.cof.value is None or one.low is None:
        return f"not determined: {one.cof.reason}"
    text = f"COF {one.cof.value:.3f}, 95 % within {one.low:.2f} to {one.high:.2f} ({one.cof.note})"
    if one.probability is None or one.limit is None:
        return text + "; the method sets no limit"
    chance = one.probability
    shown = (
        "below 1 %" if chance < 0.01 else "above 99 %" if chance > 0.99 else f"{100 * chance:.0f} %"
    )
    return text + f"; at least {one.limit.value:g} with a probability of {shown}"
