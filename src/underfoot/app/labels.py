"""Labels of what the package says, which a page puts into its language."""

from __future__ import annotations

from nicegui import ui

from underfoot.core.remark import MARK, Message


def package_label(text: str) -> ui.label:
    """Return a label of a text of the package, which the page puts into its language."""
    made = ui.label(text)
    if isinstance(text, Message):
        made.props[MARK] = text.page_mark()
    return made
