"""``underfoot explain``: a formula, a catalogue entry, a key of case files or a word."""

from __future__ import annotations

import inspect
import re
from typing import TYPE_CHECKING, Annotated, Any

import typer

from .options import CatalogueFolders

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

WIDTH = 80
"""Characters of a line in a list of formulas."""
FIRST_SCREEN = 20
"""Lines of a formula's own words in the short form."""
LAST_EQUATION = 27
"""Of the report; other numbers belong to other papers."""
_EQUATION = re.compile(r"eq(?:uation)?\.?\s*\(?(\d+)\)?", re.IGNORECASE)
_IN_TEXT = re.compile(r"Eqs?\.\s*\(?(\d+)\)?(?:\s*(to|-|,|and)\s*\(?(\d+)\)?)?")
_SOURCE = re.compile(r"Source: .*?(?=\n\n|$)", re.DOTALL)
_SECTION = re.compile(r"\n\n(?=[A-Z][a-z]+\n-{3,})")
_ROOMS = "reference material surface fluid asperity film friction outsole slip trials".split()


def explain(
    name: Annotated[
        str,
        typer.Argument(
            help="A formula (glycerol_water_viscosity), a catalogue entry (canola_oil), "
            'a key (contaminant.viscosity), a word (acof) or an equation ("Eq. 17").',
            show_default=False,
        ),
    ],
    full: Annotated[
        bool, typer.Option("--full", help="Also parameters, notes and errors of a formula.")
    ] = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Explain a formula, an equation of the report, a catalogue entry, a key or a word.

    The short form has formula, equation of the report, tested range and source.
    """
    from underfoot.core.errors import unknown_name

    from .options import catalogue_for
    from .terms import TERMS

    known = catalogue_for(None, catalogue)
    found = []
    if name.casefold() in TERMS:
        found.append(f"{name}: {TERMS[name.casefold()]}")
    if any(entry == name for _, entry in known.entries):
        found.append(known.describe(name))
    key = _key(name)
    if key:
        found.append(key)
    closures = dict(_closures())
    chosen = [name] if name in closures else _named(name, closures)
    main = [one for one in chosen if name.replace("_", "").casefold() in one.casefold()]
    if len(chosen) > 1 and len(main) == 1:
        found.append(_documented(main[0], closures[main[0]], full=full))
        chosen = [one for one in chosen if one not in main]
    elif len(chosen) == 1:
        found.append(_documented(chosen[0], closures[chosen[0]], full=full))
        chosen = []
    if chosen:
        width = max(map(len, chosen))
        lines = [f"  {one:{width}}  {_summary(closures[one], WIDTH - width - 4)}" for one in chosen]
        found.append("Formulas (underfoot explain NAME):\n" + "\n".join(lines))
    if not found:
        from underfoot.case import paths

        names = {*TERMS, *(entry for _, entry in known.entries), *closures, *paths()}
        raise unknown_name("name", name, names)
    print("\n\n".join(found))


def _key(path: str) -> str:
    from underfoot.case import Case, paths, unit_at
    from underfoot.case.quantity import Quantity, default_of
    from underfoot.case.schema import field_at, marks_of

    field = field_at(Case, path)
    if field is None:
        keys = [key for key in paths() if key.startswith(path + ".")]
        return f"{path} holds: {', '.join(keys)}" if keys else ""
    lines = [f"{path}: {field.description or 'a value of case files'}"]
    quantity = next((mark for mark in marks_of(field) if isinstance(mark, Quantity)), None)
    if quantity is not None:
        unit = unit_at(path)
        lines.append(f"  unit {unit if unit != '1' else 'none'}, {quantity.allowed()}")
    default = default_of(field)
    if default is not None:
        mark = ", assumed" if default.assumed else ""
        lines.append(f"  default {default.text} ({default.source}{mark})")
    return "\n".join(lines)


def _closures() -> Iterator[tuple[str, Any]]:
    """Yield the public functions and classes of the physics."""
    from importlib import import_module
    from importlib.util import find_spec

    for room in _ROOMS:
        if find_spec(f"underfoot.{room}") is None:
            continue
        module = import_module(f"underfoot.{room}")
        for name in getattr(module, "__all__", ()):
            item = getattr(module, name)
            if callable(item):
                yield name, item


def _named(name: str, closures: Mapping[str, Any]) -> list[str]:
    """Return the formulas that a word, an author or an equation of the report stands for."""
    wanted = _EQUATION.fullmatch(name.strip())
    if wanted is not None:
        number = int(wanted.group(1))
        return [one for one, item in closures.items() if number in equations(item)]
    word = name.casefold()
    return [
        one
        for one, item in closures.items()
        if word in {*one.casefold().split("_"), item.__module__.rpartition(".")[2]}
    ]


def equations(item: Any) -> list[int]:
    """Return the numbers of the report's equations that a formula's own words name."""
    document = inspect.getdoc(item) or ""
    module = inspect.getdoc(inspect.getmodule(item)) or ""
    texts = (document.partition("\n\n")[0], document, module)
    text = next((one for one in texts if _IN_TEXT.search(one)), "")
    found: set[int] = set()
    for match in _IN_TEXT.finditer(text):
        first, last = int(match.group(1)), int(match.group(3) or match.group(1))
        found |= {first, last} if match.group(2) == "," else set(range(first, last + 1))
    return sorted(number for number in found if number <= LAST_EQUATION)


def _equation_text(numbers: list[int]) -> str:
    if not numbers:
        return "not in the report"
    return "Eq. " + ", ".join(map(str, numbers)) + " of the report"


def _summary(item: Any, longest: int) -> str:
    first = (inspect.getdoc(item) or "not documented").partition("\n\n")[0]
    text = " ".join(first.split())
    return text if len(text) <= longest else text[: longest - 2].rstrip() + " …"


def _documented(name: str, item: Any, *, full: bool) -> str:
    try:
        signature = str(inspect.signature(item)).replace("'", "")
    except (TypeError, ValueError):
        signature = ""
    document = inspect.getdoc(item) or "not documented"
    heading = f"{item.__module__}.{name}: {_equation_text(equations(item))}"
    if full:
        return "\n\n".join([heading, f"{name}{signature}", document, *_origin(item)])
    paragraphs = _SECTION.split(document)[0].rstrip().split("\n\n")
    shown = [one for one in paragraphs if not one.startswith("Source:")]
    while len(shown) > 1 and len("\n\n".join(shown).splitlines()) > FIRST_SCREEN:
        shown.pop()
    if len(shown) < len(paragraphs) and shown[-1].endswith(":"):
        shown[-1] += " …"
    origin = list(_origin(item))
    if not any("Source:" in one for one in (*origin, *shown)):
        written = _SOURCE.search(document)
        module = (inspect.getdoc(inspect.getmodule(item)) or "").partition("\n\n")[0]
        origin.append(written.group(0) if written else f"From: {module}")
    more = f"Parameters, notes and errors: underfoot explain {name} --full"
    return "\n\n".join([heading, *shown, *origin, more])


def _origin(item: Any) -> Iterator[str]:
    """Yield source and tested ranges of a closure that is a class, as its module holds them."""
    import sys
    from dataclasses import fields, is_dataclass

    from underfoot.core import display

    if not (inspect.isclass(item) and is_dataclass(item)):
        return
    source = next((field.default for field in fields(item) if field.name == "source"), None)
    if isinstance(source, str):
        yield f"Source: {source}"
    ranges = getattr(sys.modules[item.__module__], "RANGES", {})
    for quantity, tested in ranges.items():
        low, high = display(tested.low, tested.unit), display(tested.high, tested.unit)
        yield f"Tested: {quantity} {low} to {high} ({tested.source})"
