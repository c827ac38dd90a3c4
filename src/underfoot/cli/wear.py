"""``underfoot wear``: friction and film as a sole wears, and when it is worn out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import AsJson, CasePath, CatalogueFolders, FullGrid, OutFolder, Overwrite, Settings

if TYPE_CHECKING:
    from underfoot.assess.wear import WearSeries


def wear(
    case: CasePath,
    mode: Annotated[
        str | None,
        typer.Option(
            "--mode",
            help="archard (pressure times sliding; the default), plane (the default for an outsole "
            "from a file) or patch.",
            show_default=False,
        ),
    ] = None,
    steps: Annotated[int, typer.Option("--steps", help="Worn states to compute.", min=2)] = 6,
    limit: Annotated[
        str, typer.Option("--limit", help='Fluid load looked for: "5 N" or "20 %" of the load.')
    ] = "5 N",
    to: Annotated[
        str | None,
        typer.Option(
            "--to", help='How far: "2 mm" lost, or "1500 mm^2" of patch.', show_default=False
        ),
    ] = None,
    band: Annotated[
        bool, typer.Option("--band/--no-band", help="Vary the least known inputs (4 runs a state).")
    ] = True,
    seed: Annotated[int, typer.Option("--seed", help="Of the band's draws.", min=0)] = 0,
    full: FullGrid = False,
    out: OutFolder = None,
    set_: Settings = None,
    json: AsJson = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Wear the sole of a case step by step and say when the fluid's load passes a limit.

    Every state is kept on disk: a cancelled series goes on where it stopped. With --out:
    report.html, wear.png and wear.csv.
    """
    from underfoot.assess.wear import MODES, wear_series
    from underfoot.core import unknown_name
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.core.progress import bar

    from .options import loaded

    given = loaded(case, catalogue, set_)
    if mode is None:
        mode = "archard" if given.shoe.outsole.file is None else "plane"
    if mode not in MODES:
        raise unknown_name("mode", mode, MODES, where="--mode")
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    threshold = limit_of(limit, given.motion.normal_force)
    deepest = _deepest(to, mode)
    with bar(given.name) as progress:
        found = wear_series(
            given,
            mode=mode,
            steps=steps,
            deepest=deepest,
            limit=threshold,
            band=band,
            seed=seed,
            quick=not full,
            processes=None,
            progress=progress,
        )
    if out is not None:
        from underfoot.document.wear_figure import save_wear

        with whole_folder(out, overwrite=overwrite) as staging:
            save_wear(found, staging)
    if json:
        import json as json_text

        print(json_text.dumps(as_dict(found), indent=2, ensure_ascii=False))
    else:
        _show(found, full, out)
    if not any(point.outcome.usable for point in found.points):
        raise typer.Exit(4)


def limit_of(text: str, normal_force: float) -> float:
    """Return a limit in N from text: a force, or a share of the normal force."""
    from underfoot.core import InputError, to_si

    words = text.strip()
    try:
        if words.endswith("%"):
            return float(words[:-1]) / 100 * normal_force
        import re

        return to_si(re.sub(r"(?<=\d)(?=[A-Za-z])", " ", words), "N", where="--limit")
    except ValueError:
        raise InputError(
            f'"{text}" is no load',
            where="--limit",
            allowed='a force or a share, as "5 N" or "20 %"',
        ) from None


def as_dict(found: WearSeries) -> dict[str, Any]:
    """Return the series as plain data, SI."""
    from dataclasses import asdict

    names = ("cof", "fluid_load", "fluid_load_sensor")
    names += ("peak_fluid_pressure", "peak_fluid_pressure_sensor")
    return {
        "case": found.name,
        "mode": found.mode,
        "limit_N": found.limit,
        "states": [
            {
                **asdict(point.measures),
                **{name: _plain(point.outcome.number(name)) for name in names},
                "status": str(point.outcome.status),
            }
            for point in found.points
        ],
        "passings": {
            name: {
                "words": passing.words,
                "share_of_draws": _plain(passing.passed),
                **{
                    measure: [
                        _plain(each[measure]) for each in (passing.at, passing.low, passing.high)
                    ]
                    for measure in passing.at
                },
            }
            for name, passing in found.passings.items()
        },
        "assumptions": list(found.assumptions),
    }


def _plain(value: float) -> float | None:
    import math

    return value if math.isfinite(value) else None


def _deepest(to: str | None, mode: str) -> float | None:
    from underfoot.core import to_si

    if to is None:
        return None
    return to_si(to, "m^2" if mode == "patch" else "m", where="--to")


def _show(found: WearSeries, full: bool, out: Path | None) -> None:
    from rich.console import Console
    from rich.table import Table

    from underfoot.document.wear_figure import wear_sentences

    console = Console(highlight=False)
    console.print(f"\n[bold]{found.name}[/bold]  {found.mode}, {'full' if full else 'quick'} grid")
    table = Table(box=None, header_style="bold")
    for head in ("lost mm", "tread left mm", "patch mm2", "COF", "fluid N", "sensor N", "peak kPa"):
        table.add_column(head, justify="right")
    for point in found.points:
        state, outcome = point.measures, point.outcome
        cells = [f"{state.removed_depth * 1e3:.2f}", f"{state.tread_left * 1e3:.2f}"]
        cells.append(f"{state.worn_patch_area * 1e6:.0f}")
        if outcome.usable:
            cells.append(f"{outcome.number('cof'):.3f}")
            cells += [f"{outcome.number(name):.1f}" for name in ("fluid_load", "fluid_load_sensor")]
            cells.append(f"{outcome.number('peak_fluid_pressure_sensor') / 1e3:.0f}")
        else:
            cells += [str(outcome.status), "", "", ""]
        table.add_row(*cells)
    console.print(table)
    for sentence in wear_sentences(found):
        console.print(sentence)
    if out is not None:
        console.print(f"report in {out / 'report.html'}")
