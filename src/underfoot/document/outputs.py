"""Everything a run leaves in its folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .maps import save_maps
from .page import result_page

if TYPE_CHECKING:
    from underfoot.assess.risk import RiskReport
    from underfoot.case.result import Result


def write_outputs(result: Result, folder: Path, advice: RiskReport | None = None) -> None:
    """Write a result's data files, maps and page into an existing folder.

    Files: case.toml, result.nc, summary.csv, result.json, a PNG for each quantity on the sole
    (contact_pressure.png ...), maps.png with all, and report.html (self-contained, with the sole
    in three dimensions, and ``advice``: what would help).
    """
    result.write_files(folder)
    maps = {path.stem: path.read_bytes() for path in save_maps(result.fields, folder)}
    (folder / "report.html").write_text(result_page(result, maps, advice), encoding="utf-8")
