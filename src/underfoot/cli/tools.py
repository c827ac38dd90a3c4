"""Commands beside a computation: case files, catalogue, explanations, checks of the program."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from .guard import say
from .options import AsJson, CasePath, CatalogueFolders, Overwrite, catalogue_for, load_case
from .output import print_json, print_table


def new(
    file: Annotated[Path, typer.Argument(help="File to write.")],
    shoe: Annotated[str, typer.Option(help="Shoe of the catalogue.")] = "work_shoe_half_tread",
    floor: Annotated[str, typer.Option(help="Floor of the catalogue.")] = "vinyl_g4",
    fluid: Annotated[
        str, typer.Option(help='Fluid of the catalogue, or "none".')
    ] = "glycerol_90pct",
    setup: Annotated[
        str, typer.Option(help="Set-up that gives speed, force, angle.")
    ] = "slip_tester_g4",
    name: Annotated[str, typer.Option(help="Name of the case.")] = "",
    catalogue: CatalogueFolders = None,
    overwrite: Overwrite = False,
) -> None:
    """Write a new case file, with comments, from parts of the catalogue."""
    from underfoot.case.template import template
    from underfoot.case.text import save

    text = template(
        shoe=shoe,
        floor=floor,
        contaminant=fluid,
        motion=setup,
        catalogue=catalogue_for(catalogue, file),
        name=name,
        file=file.name,
    )
    save(text, file, overwrite=overwrite)
    print(f"wrote {file}; next: underfoot check {file}")


def explain(
    name: Annotated[
        str,
        typer.Argument(
            help="A formula (glycerol_water_viscosity), a catalogue entry (canola_oil), "
            'a key (contaminant.viscosity), a term (acof) or an equation ("Eq. 17").',
        ),
    ],
    everything: Annotated[
        bool, typer.Option("--all", help="Also parameters, notes and errors of a formula.")
    ] = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Explain a formula, an equation of the report, a catalogue entry, a key or a term.

    The short form has formula, equation of the report, tested range and source.
    """
    from underfoot.case.explanation import explanation

    print(explanation(name, catalogue_for(catalogue), full=everything))


def catalogue(
    kind: Annotated[
        str,
        typer.Argument(help="fluid, floor, material, setup, shoe or published."),
    ] = "",
    catalogue: CatalogueFolders = None,
    json: AsJson = False,
) -> None:
    """List the entries of the catalogue; underfoot explain NAME shows one with its sources."""
    from underfoot.core.catalogue import BUILT_IN, KINDS
    from underfoot.core.errors import unknown_name
    from underfoot.core.presentation import Table

    known = catalogue_for(catalogue)
    if kind.removesuffix("s") in KINDS:
        kind = kind.removesuffix("s")
    if kind and kind not in KINDS:
        raise unknown_name("kind of catalogue entry", kind, KINDS, where="catalogue")
    chosen = {group: known.names(group) for group in ([kind] if kind else KINDS)}
    if json:
        print_json(chosen)
        return
    for group, names in chosen.items():
        entries = [known.entry(group, name) for name in names]
        origins = ["" if each.origin == BUILT_IN else f" ({each.origin})" for each in entries]
        rows = [
            (f"  {entry.name}", entry.title + origin)
            for entry, origin in zip(entries, origins, strict=True)
        ]
        print_table(Table(group, ("", ""), rows))


def schema(
    out: Annotated[Path | None, typer.Option("--out", help="File to write instead.")] = None,
    overwrite: Overwrite = False,
) -> None:
    """Print the JSON Schema of case files, for editors and other programs."""
    from underfoot.case.schema import schema_text
    from underfoot.case.text import save

    if out is None:
        print(schema_text(), end="")
        return
    save(schema_text(), out, overwrite=overwrite)
    print(f"wrote {out}")


def migrate(
    case: CasePath,
    out: Annotated[
        Path | None,
        typer.Option("--out", help="File to write; default: the case itself."),
    ] = None,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Write a case file in the present version of the format; comments are kept."""
    read = load_case(case, catalogue, None)
    if read.to_toml() == case.read_text(encoding="utf-8") and out is None:
        print(f"{case} is up to date")
        return
    target = case if out is None else out
    read.save(target, overwrite=overwrite)
    for change in read.changes:
        print(change)
    print(f"wrote {target}")


def validate(json: AsJson = False) -> None:
    """Compute cases with a known exact solution and print the errors."""
    from underfoot.core.presentation import Table
    from underfoot.studies.validation import checks

    rows = checks()
    failed = [check.name for check in rows if not check.passed]
    if json:
        content = [asdict(check) | {"relative_error": check.relative_error} for check in rows]
        print_json(content)
    else:
        cells = [
            (
                check.name,
                f"{check.computed:.6g}",
                f"{check.exact:.6g}",
                f"{100 * check.relative_error:.2g} %",
                f"{100 * check.tolerance:.2g} %",
                "yes" if check.passed else "no",
                check.source,
            )
            for check in rows
        ]
        heads = ("Check", "Computed", "Exact", "Error", "Tolerance", "Within", "Source")
        print_table(Table("", heads, cells))
        print(f"{len(rows) - len(failed)} of {len(rows)} within their tolerance")
    if failed:
        say(f"error: outside the tolerance: {', '.join(failed)}")
        raise typer.Exit(1)


def doctor() -> None:
    """Print versions, solver, threads, cache and which optional packages are missing."""
    from underfoot.core.installation import installation

    for label, value in installation():
        print(f"{label:20} {value}")
