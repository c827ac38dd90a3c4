"""What the page of a place asks."""

from __future__ import annotations

import base64
import io
import json
from pathlib import Path

from underfoot.core import Progress
from underfoot.places.choice import choose_shoe
from underfoot.places.place import read_place
from underfoot.report import write_report
from underfoot.report.places import slips_figure
from underfoot.report.writing import write_text

from .text import put_language
from .work import presented


def chosen_shoe(file: str, folder: str, *, progress: Progress) -> None:
    """Write the choice of a shoe for the place of a file as ``underfoot choose --out`` does.

    ``shown.json`` beside it holds what the page shows, the picture as an address.
    """
    choice = choose_shoe(read_place(Path(file)), quick=False, progress=progress)
    picture = io.BytesIO()
    slips_figure(choice).savefig(picture, format="png", dpi=150)
    address = "data:image/png;base64," + base64.b64encode(picture.getvalue()).decode()
    shown = {**presented(choice), "picture": address}
    further = {"shown.json": write_text(json.dumps(shown))}
    put_language(write_report(choice, folder, overwrite=True, further=further).page)
