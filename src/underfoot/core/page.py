"""One self-contained HTML page for any object: opens offline, prints to PDF from any browser."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from underfoot.core.deprecation import package_names

from .html import environment
from .presentation import Part, Presentable, Table

_NUMERIC = re.compile(r"[-+±]?\d[\d.,]*( ?[^\s()]{1,5})?( ?[±(].*)?|below .*|above .*|-|")
LONGEST_NUMBER = 32
"""Characters up to which a cell that starts with a number is set as one, flush right."""
MOST_ITEMS = 3
"""Lines of a list that are shown; the others fold away."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure of a page: what it shows, and its data address."""

    caption: str
    source: str
    wide: bool = False


@dataclass(frozen=True, slots=True)
class PageSection:
    """A part of a page under a title: ready HTML, pictures, a table or a list.

    ``folded`` hides all of it behind its title until it is asked for. A page shows its first
    section and folds the others; ``stage`` sets that beside the headline, and ``first`` keeps
    another one in sight below the headline.
    """

    title: str
    intro: str = ""
    html: str = ""
    pictures: Sequence[Picture] = ()
    table: Table | None = None
    items: Sequence[str] = ()
    text: str = ""
    folded: bool = False
    stage: bool = False
    first: bool = False


def page(
    shown: Presentable,
    sections: Sequence[PageSection],
    *,
    script: str = "",
    verdict: tuple[str, str] = ("", ""),
) -> str:
    """Return the page of an object: verdict, headline and cautions, then ``sections``.

    What answers stands on one screen; all that follows is folded, and unfolded on paper.
    """
    stage, *rest = sections if sections and sections[0].stage else (None, *sections)
    said = [section for section in rest if section.first]
    open_one = 0 if stage or said else 1
    rest = [section for section in rest if not section.first]
    folded = [replace(section, folded=bool(section.title)) for section in rest[open_one:]]
    return (
        environment()
        .get_template("page.html")
        .render(
            shown=shown,
            title=str(shown.heading()),
            headline=shown.headline(),
            cautions=shown.cautions(),
            script=script,
            verdict=verdict,
            stage=stage,
            said=said,
            **_content([*rest[:open_one], *folded]),
        )
    )


def page_part(sections: Sequence[PageSection]) -> str:
    """Return sections as HTML for a page that has style and scripts already."""
    return environment().get_template("sections.html").render(**_content(sections))


def _content(sections: Sequence[PageSection]) -> dict[str, Any]:
    return {
        "sections": sections,
        "numeric": _is_number,
        "part": lambda cell: isinstance(cell, Part),
        "most": MOST_ITEMS,
    }


def table_sections(shown: Presentable) -> list[PageSection]:
    """Return the tables of an object as sections."""
    return [PageSection(table.title, table=table) for table in shown.tables() if table.rows]


def remark_sections(shown: Presentable) -> list[PageSection]:
    """Return the lists of remarks of an object as sections."""
    return [PageSection(title, items=lines) for title, lines in shown.remarks().items() if lines]


def _is_number(cell: str) -> bool:
    return len(cell) < LONGEST_NUMBER and _NUMERIC.fullmatch(cell) is not None


__getattr__ = package_names(__name__, gone="0.5", Section="PageSection")  # plug-ins import it
