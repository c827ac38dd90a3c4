"""Options that several commands share, each defined once."""

from __future__ import annotations

import inspect
import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from underfoot.core.remark import Message

from .output import answer

if TYPE_CHECKING:
    from underfoot.case import Case
    from underfoot.core.catalogue import Catalogue
    from underfoot.core.presentation import Presentable

CasePath = Annotated[Path, typer.Argument(help="Case file (TOML).")]
CatalogueFolders = Annotated[
    list[Path] | None,
    typer.Option(
        "--catalogue",
        help="Folder with catalogue entries of your own; may be repeated.",
    ),
]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help='Change an input, for example --set "contaminant.viscosity=41 cP"; may be repeated.',
    ),
]
Quick = Annotated[
    bool, typer.Option("--quick/--full", help="Coarse grid (first look) or fine grid.")
]
Processes = Annotated[
    int | None,
    typer.Option(
        "--processes",
        min=1,
        help="Cases, or positions of a tread, computed at the same time; by default the cores, "
        "at most 4.",
    ),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace the output folder or file.")]
OutFolder = Annotated[
    Path | None,
    typer.Option("--out", help="Folder for data, figures and report.html."),
]
RampAngle = Annotated[
    str | None,
    typer.Option(
        "--ramp",
        help='Slope of the walkway, as "5 deg" (walking up) or "-5 deg" (walking down).',
    ),
]
PlateFrame = Annotated[
    str | None,
    typer.Option(
        help="On a ramp, the axes of the plates: surface (normal and tangential to the ramp) or "
        "horizontal.",
    ),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON in SI units instead of tables.")]
ShowAll = Annotated[
    bool, typer.Option("--all", help="Print every assumption and remark, not the first three.")
]


Workers = Annotated[
    int | None,
    typer.Option("--workers", min=1, help="Processes; by default one a processor."),
]
On = Annotated[
    str | None,
    typer.Option(
        "--on",
        help='Where: "dask" (a cluster in this process) or "dask:tcp://host:8786".',
    ),
]


def number(text: str | float) -> float:
    """Return the number of an option, read as ``underfoot.core.typed`` says: "0,5", "50 %".

    Raises:
        typer.BadParameter: No number, or one that can be two.
    """
    from underfoot.core import InputError, to_si

    try:
        return to_si(text, "1", where="")
    except InputError as error:
        raise typer.BadParameter(str(error)) from error


def optional(text: str, *names: str) -> Any:
    """Return an option with its help text."""
    return typer.Option(*names, help=text)


@dataclass
class Shared:
    """Options of most commands as given; those that a command does not have keep their default."""

    out: OutFolder = None
    quick: Quick = False
    set_: Settings = None
    processes: Processes = None
    json: AsJson = False
    everything: ShowAll = False
    overwrite: Overwrite = False
    catalogue: CatalogueFolders = None

    def case(self, path: Path, settings: Sequence[str] = ()) -> Case:
        """Return the case of a file with ``settings`` and the changes of ``--set``."""
        return load_case(path, self.catalogue, [*(self.set_ or ()), *settings])

    def answer(self, title: str, compute: Callable[..., Presentable]) -> None:
        """Compute, write and print the answer of ``compute(progress)``."""
        answer(
            title,
            compute,
            out=self.out,
            overwrite=self.overwrite,
            json=self.json,
            everything=self.everything,
        )

    def ask(self, case: Case, question: Callable[..., Presentable], **arguments: Any) -> None:
        """Answer a question about a case that is computed on several processes."""
        arguments |= {"quick": self.quick, "processes": self.processes}
        self.answer(case.name, lambda progress: question(case, progress=progress, **arguments))


def sharing(
    *, quick: bool = False, without: tuple[str, ...] = ()
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command the options of ``Shared`` after its own, and them as its first argument.

    ``quick`` is the default of that option; ``without`` names the options that it does not have.
    """
    options = inspect.signature(Shared, eval_str=True).parameters.values()
    options = [option for option in options if option.name not in without]
    further = [each.replace(default=quick) if each.name == "quick" else each for each in options]

    def decorate(command: Callable[..., None]) -> Callable[..., None]:
        @wraps(command)
        def run(**given: Any) -> None:
            shared = Shared(**{option.name: given.pop(option.name) for option in options})
            command(shared, **given)

        _, *parameters = inspect.signature(command, eval_str=True).parameters.values()
        vars(run)["__signature__"] = inspect.Signature([*parameters, *further])
        return run

    return decorate


def catalogue_for(folders: list[Path] | None, case: Path | None = None) -> Catalogue:
    """Return the catalogue with the user's folders and that beside the case."""
    from underfoot.core.catalogue import Catalogue, catalogue_folders

    beside = Path.cwd() if case is None else case.parent
    return Catalogue.load(catalogue_folders(beside, folders or ()))


def load_case(path: Path, folders: list[Path] | None, settings: Sequence[str] | None) -> Case:
    """Return the case of a file with the changes of ``--set``."""
    from underfoot.case import Case
    from underfoot.core import InputError

    if path.is_dir():
        inner = next(iter(sorted(path.glob("*.toml"))), None)
        raise InputError(
            Message("{path} is a folder", path=path),
            where="case",
            allowed="a case file (TOML)",
            nearest=None if inner is None else str(inner),
        )
    changes = dict(map(setting, settings or ()))
    return Case.load(path, catalogue=catalogue_for(folders, path), settings=changes)


def setting(text: str) -> tuple[str, Any]:
    """Return path and value of one ``--set``."""
    from underfoot.core import InputError
    from underfoot.core.typed import float_of_text

    path, sign, value = text.partition("=")
    if not sign or not path.strip():
        raise InputError(
            f'"{text}" is not a setting',
            where="--set",
            allowed='PATH=VALUE, for example "motion.speed=0.3 m/s"',
        )
    value = value.strip()
    try:
        return path.strip(), tomllib.loads(f"x = {value}", parse_float=float_of_text)["x"]
    except tomllib.TOMLDecodeError:
        return path.strip(), value
