"""``underfoot compare``: results side by side."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .options import AsJson, CatalogueFolders, Overwrite

if TYPE_CHECKING:
    from underfoot.case.result import Result
    from underfoot.document.comparison import Comparison

_ORDINALS = "first second third fourth fifth sixth seventh eighth".split()


def compare(
    paths: Annotated[
        list[Path],
        typer.Argument(
            metavar="A B [C ...]", help="Result folders or case files.", show_default=False
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            help="Folder for compare.html, with the soles side by side and maps of differences.",
            show_default=False,
        ),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="For case files: coarser grid.")] = False,
    json: AsJson = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Say which of two to eight grips best, how sure that is, and in what their cases differ."""
    from underfoot.case import Case
    from underfoot.core.files import check_writable_folder, whole_folder
    from underfoot.document import case_differences, comparison, write_comparison

    from .options import catalogue_for

    _check(paths)
    if out is not None:
        check_writable_folder(out, overwrite=overwrite)
    results = [_result(path, quick, catalogue) for path in paths]
    known = catalogue_for(None, catalogue)
    cases = [Case.from_text(result.case_text, catalogue=known) for result in results]
    changed = case_differences(cases)
    compared = comparison(*results)
    if out is not None:
        with whole_folder(out, overwrite=overwrite) as staging:
            write_comparison(results, compared, changed, staging)
    if json:
        _print_json(results, compared, changed)
    else:
        _show(results, compared, changed)
        if out is not None:
            print(f"\nFiles in {out}; open {out / 'compare.html'}")
        else:
            print("\nWith --out FOLDER: the soles side by side and maps of the differences.")


def _check(paths: list[Path]) -> None:
    """Refuse before anything is computed."""
    from underfoot.core import InputError
    from underfoot.core.errors import nearest_match

    if not 2 <= len(paths) <= len(_ORDINALS):
        count = f"{len(paths)} result" + ("" if len(paths) == 1 else "s")
        raise InputError(f"{count} given", where="compare", allowed=f"2 to {len(_ORDINALS)}")
    for path in paths:
        if path.is_dir() and not (path / "result.json").is_file():
            raise InputError(
                f"the folder {path} holds no result (there is no result.json in it)",
                where="compare",
                allowed="folders that underfoot run made, or case files",
            )
        if not path.exists():
            beside = path.parent.iterdir() if path.parent.is_dir() else ()
            near = nearest_match(path.name, [entry.name for entry in beside])
            raise InputError(
                f"there is no result folder or case file {path}",
                where="compare",
                nearest=None if near is None else str(path.parent / near),
                remedy="Give folders that underfoot run made, or case files",
            )


def _print_json(
    results: list[Result], compared: Comparison, changed: list[tuple[str, ...]]
) -> None:
    import json

    heads = ["path", *_ORDINALS[: len(results)]]
    content = {
        "verdict": compared.verdict,
        "beyond": compared.beyond,
        "cautions": list(compared.cautions),
        "ranking": [
            {"letter": r.letter, "name": r.name, "cof": r.cof, "interval": r.interval,
             "better_than_next": r.chance}
            for r in compared.ranking
        ],
        "differences": [dict(zip(heads, row, strict=True)) for row in changed],
        **{head: result.as_dict() for head, result in zip(heads[1:], results, strict=True)},
    }  # fmt: skip
    print(json.dumps(content, indent=2, ensure_ascii=False))


def _show(results: list[Result], compared: Comparison, changed: list[tuple[str, ...]]) -> None:
    from rich.console import Console

    from underfoot.document.comparison import letters

    from .show import LONGEST_VALUE, table

    console = Console(highlight=False)
    console.print(" ".join([compared.verdict, compared.beyond]).strip(), markup=False)
    named = letters(results)
    for letter, result in zip(named, results, strict=True):
        console.print(f"  {letter}  {result.name}", markup=False)
    for caution in compared.cautions:
        console.print(f"Caution: {caution}", markup=False)
    if compared.ranking:
        rows = [(r.letter, r.cof, r.interval, r.chance) for r in compared.ranking]
        heads = ("", "COF", "95 % interval", "better than the next")
        console.print("\nRanked", table(heads, rows), sep="\n")
    console.print()
    rows = [
        (row.label, *row.values, row.beyond.replace(" the band", "").replace(" estimated", ""))
        for row in compared.rows
        if max(map(len, row.values)) <= LONGEST_VALUE
    ]
    console.print(table(("Results", *named, "against A"), rows))
    console.print()
    if changed:
        console.print(table(("Cases differ in", *named), changed))
    else:
        console.print("The cases do not differ.")


def _result(path: Path, quick: bool, catalogue: list[Path] | None) -> Result:
    if path.is_dir():
        from underfoot.case.result import Result

        return Result.load(path)
    from .options import loaded
    from .run import computed

    return computed(loaded(path, catalogue, None), quick=quick)
