"""Everything a run leaves in its folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .maps import save_maps
from .page import result_page

if TYPE_CHECKING:
    from underfoot.case.result import Result


def write_outputs(result: Result, folder: Path) -> None:
    """Write a result's data files, maps and page into an existing folder.

    Files: case.toml, result.nc, summary.csv, result.json, contact_pressure.png,
    fluid_pressure.png, film_thickness.png, maps.png and report.html (self-contained).
    """
    result.write_files(folder)
    save_maps(result.fields, folder)
    page = result_page(result, (folder / "maps.png").read_bytes())
    (folder / "report.html").write_text(page, encoding="utf-8")
