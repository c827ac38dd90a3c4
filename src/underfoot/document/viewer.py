"""The 3-D sole on a page: drawn by a small WebGL 2 program of our own, offline, no library."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING

from .scene import viewer_scene

if TYPE_CHECKING:
    from underfoot.case.result import Result

SCRIPTS = ("viewer_data.js", "viewer_draw.js", "viewer_page.js")


def viewer_section(results: Sequence[Result]) -> str:
    """Return the viewer of one result, or of several side by side, as a part of a page.

    The page needs ``viewer_script`` once, after its sections, and the style sheets of this room.
    """
    from .page import environment

    scene = viewer_scene(results)
    # "<" would let a name in the data end the script element
    data = json.dumps(scene, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    return environment().get_template("viewer.html").render(scene=scene, data=data)


def viewer_script() -> str:
    """Return the program that brings every viewer of a page to life."""
    from .page import environment

    templates = environment()
    parts = [templates.get_template(name).render() for name in SCRIPTS]
    return "(() => {\n" + "\n".join(parts) + "\n})();"
