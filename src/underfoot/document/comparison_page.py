"""One self-contained page that lays results side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .comparison import Comparison, letters
from .comparison_maps import comparison_figures, grid_note
from .page import embedded, environment, png
from .viewer import viewer_script, viewer_section

if TYPE_CHECKING:
    from underfoot.case.result import Result


def write_comparison(
    results: Sequence[Result],
    compared: Comparison,
    changed: Sequence[tuple[str, ...]],
    folder: Path,
) -> None:
    """Write compare.html (self-contained) and a PNG for each quantity into an existing folder.

    ``changed`` is what ``case_differences`` returns. Results that can't be compared get the page
    without pictures.
    """
    maps = []
    usable = all(result.status.usable for result in results)
    for quantity, figure in comparison_figures(results) if usable else ():
        picture = png(figure)
        (folder / f"compare_{quantity.name}.png").write_bytes(picture)
        maps.append((quantity.title, embedded(picture)))
    page = environment().get_template("comparison.html").render(
        compared=compared,
        results=list(zip(letters(results), results, strict=True)),
        changed=changed,
        maps=maps,
        note=grid_note(results) if usable else "",
        viewer=viewer_section(results) if usable else "",
        script=viewer_script() if usable else "",
    )  # fmt: skip
    (folder / "compare.html").write_text(page, encoding="utf-8")
