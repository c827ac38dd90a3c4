"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.core.catalogue import Catalogue

CasePath = Annotated[Path, typer.Argument(help="Case file (TOML).", show_default=False)]
CatalogueFolders = Annotated[
    list[Path] | None,
    typer.Option(
        "--catalogue",
        help="Folder with entries of your own; may be given several times.",
        show_default=False,
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help='Change a value, as in --set "contaminant.viscosity=41 cP".',
        show_default=False,
    ),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace what is there.")]
OutFolder = Annotated[
    Path | None, typer.Option("--out", help="Folder for files.", show_default=False)
]
FullGrid = Annotated[bool, typer.Option("--full", help="The full grid; the quick one by default.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON for other programs.")]


def catalogue_for(case: Path | None, folders: list[Path] | None) -> Catalogue:
    """Return the catalogue with the user's folders and that beside the case."""
    from underfoot.core.catalogue import Catalogue, catalogue_folders

    beside = Path.cwd() if case is None else case.parent
    return Catalogue.load(catalogue_folders(beside, folders or ()))


def loaded(path: Path, folders: list[Path] | None, settings: list[str] | None) -> Case:
    """Return the case of a file with the changes of ``--set``."""
    from underfoot.case import Case
    from underfoot.core import InputError

    if path.is_dir():
        own = path / "case.toml"
        raise InputError(
            f"{path} is a folder",
            where="case",
            allowed="a case file (TOML)",
            nearest=str(own) if own.is_file() else None,
        )

    changes = dict(_setting(text) for text in settings or ())
    return Case.load(path, catalogue=catalogue_for(path, folders), settings=changes)


def _setting(text: str) -> tuple[str, Any]:
    import tomllib

    from underfoot.core import InputError

    path, sign, value = text.partition("=")
    if not sign or not path.strip():
        raise InputError(
            f'"{text}" is no setting',
            where="--set",
            allowed='PATH=VALUE, as "motion.speed=0.3 m/s"',
        )
    value = value.strip()
    try:
        given: Any = tomllib.loads(f"x = {value}")["x"]
    except tomllib.TOMLDecodeError:
        given = value
    return path.strip(), given
