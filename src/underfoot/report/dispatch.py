"""What an object can be drawn as and written to: generic functions that each type registers for.

A module of this room registers its types when it is imported; ``_HOMES`` names the module for the
types of a room of the package, so that nothing is imported before it is needed. Another package
offers the module for its types behind the door ``reports``, by the package's name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial, singledispatch
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from underfoot.core import InputError, unknown_name
from underfoot.core.html import data_address, png
from underfoot.core.page import PageSection, Picture, page, remark_sections, table_sections
from underfoot.core.presentation import Presentable
from underfoot.core.registry import find_offer
from underfoot.core.remark import Message

from .writing import Writer, Written, data_writers, write_folder

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FigureMakers = dict[str, "Callable[[], Figure]"]
_HOMES = {
    "compute": ("results",),
    "case": ("results",),
    "questions": ("results", "question_figures", "slips", "wear_page"),
    "film": ("regime_figure",),
    "report": ("outsole",),
    "calibrate": ("compound",),
    "explore": ("design_study",),
    "places": ("places",),
    **dict.fromkeys(("friction", "rough_contact", "slip", "material", "surface"), ("laws",)),
}
"""Modules of this room that register the types of a room of the package."""


def _registered_function(generic: Any, shown: object) -> Any:
    """Return the function registered for the type of ``shown`` after its module is imported."""
    package, _, rest = type(shown).__module__.partition(".")
    if package != "underfoot":
        find_offer("reports", package)
    else:
        for name in _HOMES.get(rest.partition(".")[0], ()):
            import_module(f".{name}", __package__)
    chosen = generic.dispatch(type(shown))
    return None if chosen is generic.dispatch(object) else chosen


@singledispatch
def figures(shown: object) -> FigureMakers:
    """Return the functions that draw an object, by name; the first is the one of ``plot``."""
    chosen = _registered_function(figures, shown)
    return {} if chosen is None else chosen(shown)


@singledispatch
def plot(shown: object, *args: Any, **options: Any) -> Figure:
    """Return a figure of an object.

    Parameters:
        shown: A result (name of a field on the sole, or nothing for all of them), a comparison
            (name of a field), a sensitivity, a wear series, slips, a case, a contact table, a trial
            ...
        *args, **options: What to draw of it; by default the first of its ``figures``.

    Raises:
        InputError: A type without a figure, or a name that the object has no figure of.
    """
    chosen = _registered_function(plot, shown)
    if chosen is not None:
        return chosen(shown, *args, **options)
    return named_figure(figures(shown), type(shown).__name__, *args, **options)


def named_figure(makers: FigureMakers, kind: str, name: str | None = None) -> Figure:
    """Return the figure of a name among several, the first without a name."""
    if not makers:
        raise InputError(Message("nothing of a {kind} can be drawn", kind=kind), where="plot")
    if name is not None and name not in makers:
        raise unknown_name("figure", name, makers, where="plot")
    return makers[name or next(iter(makers))]()


@singledispatch
def files(shown: Any) -> dict[str, Writer]:
    """Return the data files of an object: the function that writes each of them, by name."""
    chosen = _registered_function(files, shown)
    if chosen is not None:
        return chosen(shown)
    return data_writers(shown)


@singledispatch
def sections(shown: Any, pictures: dict[str, bytes]) -> tuple[Sequence[PageSection], str]:
    """Return the sections of an object's page and its script; ``pictures`` are those drawn."""
    chosen = _registered_function(sections, shown)
    if chosen is not None:
        return chosen(shown, pictures)
    drawn = [
        Picture(name.replace("_", " "), data_address(data), True) for name, data in pictures.items()
    ]
    figure = [PageSection("Figure", pictures=drawn)] if drawn else []
    return [*figure, *table_sections(shown), *remark_sections(shown)], ""


@singledispatch
def write_report(
    shown: Any,
    folder: Path | str,
    *,
    overwrite: bool = False,
    further: dict[str, Writer] | None = None,
    **options: Any,
) -> Written:
    """Write an object's data, figures and page (report.html) into a new folder.

    ``further`` are more data files by name, each with the function that writes it.

    Returns:
        Written: The folder, the page and one line for each file that could not be written.

    Raises:
        InputError: A type without a page; a folder that holds something else.
    """
    chosen = _registered_function(write_report, shown)
    if chosen is not None:
        return chosen(shown, folder, overwrite=overwrite, **options)
    if not isinstance(shown, Presentable):
        raise InputError(
            Message("a {name} has no report", name=type(shown).__name__), where="write_report"
        )
    data = files(shown) | (further or {})
    return write_shown(shown, folder, data, partial(page_text, shown), overwrite=overwrite)


def write_shown(
    shown: Presentable,
    folder: Path | str,
    data: dict[str, Writer],
    text: Callable[[dict[str, bytes]], str],
    *,
    makers: FigureMakers | None = None,
    overwrite: bool,
) -> Written:
    """Write data, figures and the page whose ``text`` is made of the figures as PNG, by name.

    ``makers`` are the figures to draw, None for all that the object has.
    """
    drawn: dict[str, bytes] = {}
    makers = figures(shown) if makers is None else makers

    def draw(name: str, make: Callable[[], Figure], path: Path) -> None:
        drawn[name] = png(make())
        path.write_bytes(drawn[name])

    pictures = {f"{name}.png": partial(draw, name, make) for name, make in makers.items()}

    def write_page(path: Path) -> None:
        path.write_text(text(drawn), encoding="utf-8")

    return write_folder(folder, data, pictures, write_page, overwrite=overwrite)


def page_text(shown: Presentable, pictures: dict[str, bytes]) -> str:
    """Return an object's page as HTML text; ``pictures`` are its figures as PNG, by name."""
    parts, script = sections(shown, pictures)
    return page(shown, parts, script=script)
