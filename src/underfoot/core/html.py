"""Empty figures, pictures and templates of a self-contained page."""

from __future__ import annotations

import base64
import io
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from jinja2 import Environment
    from matplotlib.figure import Figure


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure (inches) with constrained layout."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def png(figure: Figure, dpi: int = 130) -> bytes:
    """Return a figure as a PNG file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=dpi, format="png")
    return buffer.getvalue()


def data_address(picture: bytes) -> str:
    """Return a PNG file as a data address for an ``img`` element."""
    return "data:image/png;base64," + base64.b64encode(picture).decode("ascii")


@cache
def environment(*packages: str) -> Environment:
    """Return the templates of rooms, then of this one, escaping everything by default."""
    from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

    blocks: dict[str, Any] = {"trim_blocks": True, "lstrip_blocks": True}
    loader = ChoiceLoader([PackageLoader(name) for name in (*packages, "underfoot.core")])
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined, **blocks)
