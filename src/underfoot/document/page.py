"""One self-contained HTML page for a result: opens offline, prints to PDF from any browser."""

from __future__ import annotations

import base64
import io
from typing import TYPE_CHECKING, Any

from .maps import map_figure
from .quantities import quantities
from .risk_sentences import change_lines, limit_words
from .sentences import summary_rows, verdict
from .viewer import viewer_script, viewer_section

if TYPE_CHECKING:
    from jinja2 import Environment
    from matplotlib.figure import Figure

    from underfoot.assess.risk import RiskReport
    from underfoot.case.result import Result


def result_page(
    result: Result, maps: dict[str, bytes] | None = None, advice: RiskReport | None = None
) -> str:
    """Return the page of one result as HTML text; ``maps`` are PNG by quantity, if drawn."""
    found = quantities([result.fields])
    if maps is None:
        maps = {quantity.name: png(map_figure(result.fields, quantity)) for quantity in found}
    template = environment().get_template("result.html")
    return template.render(
        result=result,
        verdict=verdict(result),
        rows=summary_rows(result),
        limit=limit_words(result) if result.status.usable else "",
        changes=change_lines(advice) if advice is not None else (),
        viewer=viewer_section([result]),
        script=viewer_script(),
        maps=[(quantity.title, embedded(maps[quantity.name])) for quantity in found],
        history=embedded(png(history_figure(result))) if "time" in result.fields.dims else None,
        provenance=result.provenance.as_dict(),
    )


def history_figure(result: Result) -> Figure:
    """Return how the load is shared between fluid and contact over time."""
    from matplotlib.figure import Figure

    fields = result.fields
    figure = Figure(figsize=(7.5, 2.8), layout="constrained")
    axes = figure.add_subplot()
    time = fields["time"].values * 1e3
    for name, label, colour, line in (
        ("load_history", "applied load", "0.3", "--"),
        ("fluid_load_history", "carried by the fluid", "tab:blue", "-"),
    ):
        if name in fields:
            axes.plot(time, fields[name].values, label=label, color=colour, linestyle=line)
    axes.set_xlabel("time after the heel meets the film (ms)")
    axes.set_ylabel("load (N)")
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def png(figure: Figure, dpi: int = 130) -> bytes:
    """Return a figure as a PNG file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, dpi=dpi, format="png")
    return buffer.getvalue()


def embedded(picture: bytes) -> str:
    """Return a PNG file as a data address for an ``img`` element."""
    return "data:image/png;base64," + base64.b64encode(picture).decode("ascii")


def environment() -> Environment:
    """Return the template environment of this room, escaping everything by default."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    settings: dict[str, Any] = {"trim_blocks": True, "lstrip_blocks": True}
    return Environment(
        loader=PackageLoader("underfoot.document"),
        autoescape=True,
        undefined=StrictUndefined,
        **settings,
    )
