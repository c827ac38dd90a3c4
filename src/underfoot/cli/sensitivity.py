"""``underfoot sensitivity``: what the least known inputs of a case do to its numbers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from .options import AsJson, CasePath, CatalogueFolders, FullGrid, OutFolder, Overwrite, Settings

if TYPE_CHECKING:
    from underfoot.assess.sensitivity import Sensitivity

SHOWN = (
    ("cof", "coefficient of friction"),
    ("fluid_load", "load carried by the fluid"),
    ("fluid_load_sensor", "load as floor sensors read it"),
    ("peak_fluid_pressure_sensor", "peak as a floor sensor reads it"),
)


def sensitivity(
    case: CasePath,
    full: FullGrid = False,
    out: OutFolder = None,
    set_: Settings = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Vary what was assumed, one input at a time, and show what it does to the numbers.

    Two runs an input, each kept on disk: a second call answers at once, a cancelled one goes on
    where it stopped. With --out: sensitivity.png and sensitivity.csv.
    """
    from underfoot.assess.sensitivity import sensitivity as assessed
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar

    from .options import loaded

    given = loaded(case, catalogue, set_)
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    with bar(given.name) as progress:
        found = assessed(given, quick=not full, processes=None, progress=progress)
    if out is not None:
        from underfoot.document.sensitivity_figure import save_sensitivity

        with whole_folder(out, overwrite=overwrite) as staging:
            save_sensitivity(found, SHOWN, staging)
    if json:
        import json as json_text

        print(json_text.dumps(as_dict(found), indent=2, ensure_ascii=False))
    else:
        _show(found, full, out)
    if not found.nominal.usable:
        raise typer.Exit(4)


def as_dict(found: Sensitivity) -> dict[str, Any]:
    """Return the sensitivity as plain data."""
    quantities = {}
    for name, _ in SHOWN:
        band = found.band(name)
        quantities[name] = {
            "value": band.value,
            "unit": found.nominal.scalars[name].unit,
            "uncertainty": band.deviation,
            "from_inputs": band.inputs,
            "from_law": band.law,
            "lowest": band.lowest,
            "highest": band.highest,
            "not_computed": list(band.not_computed),
            "effects": [
                {
                    "path": effect.path,
                    "low": [effect.low_value, effect.low.number(name)],
                    "high": [effect.high_value, effect.high.number(name)],
                    "deviation": effect.deviation(name, found.nominal),
                    "reason": effect.reason,
                }
                for effect in found.ranked(name)
            ],
        }
    return {"case": found.nominal.name, "quantities": quantities}


def _show(found: Sensitivity, full: bool, out: Path | None) -> None:
    from rich.console import Console

    from underfoot.core import display

    from .show import table

    console = Console(highlight=False)
    console.print(f"\n[bold]{found.nominal.name}[/bold]")
    if not found.nominal.usable:
        console.print(f"The case itself: {found.nominal.status}. {found.nominal.remedy}")
        return
    grid = "full grid" if full else "quick grid: take differences from here, values from a run"
    console.print(f"One input at a time, one standard deviation to either side; {grid}.")
    for name, label in SHOWN:
        band, unit = found.band(name), found.nominal.scalars[name].unit
        console.print(
            f"\n{label}: {display(band.value, unit, 3)} ± {display(band.deviation, unit, 2)}"
            f"   (seen: {display(band.lowest, unit, 3)} to {display(band.highest, unit, 3)})"
        )
        rows = []
        for effect in found.ranked(name)[:4]:
            ends = " and ".join(
                "not computed"
                if not end.usable
                else "no film"
                if end.scalars[name].value is None
                else display(end.number(name), unit, 3)
                for end in (effect.low, effect.high)
            )
            rows.append((f"  {effect.path}", effect.words, ends))
        console.print(table((), rows))
        for path in band.not_computed:
            console.print(f"  not computed, not in the spread: {path}")
    if out is not None:
        console.print(f"\nFiles in {out}", markup=False)
