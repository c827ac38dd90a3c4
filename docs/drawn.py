"""The directive ``{plot}``: a figure drawn by the Matplotlib code of its block.

Matplotlib's own directive cannot be used from Markdown (it writes reStructuredText).
"""

import os
from pathlib import Path

import matplotlib
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.util.docutils import SphinxDirective

STYLE = {
    "figure.figsize": (7.0, 3.6),
    "figure.constrained_layout.use": True,
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "legend.frameon": False,
}


class Plot(SphinxDirective):
    """Run the block and show the figure that it leaves."""

    has_content = True
    option_spec = {"alt": directives.unchanged_required}  # noqa: RUF012

    def run(self) -> list[nodes.Node]:
        """Return the image, or nothing where figures are not to be drawn (``-D draw=0``)."""
        if not self.config.draw:
            return []
        matplotlib.use("Agg")
        os.environ.setdefault("UNDERFOOT", str(Path(__file__).parents[1]))
        from matplotlib import pyplot

        number = self.env.new_serialno("drawn")
        name = f"_drawn/{self.env.docname.replace('/', '_')}_{number}.svg"
        path = Path(self.env.srcdir) / name
        path.parent.mkdir(exist_ok=True)
        with matplotlib.rc_context(STYLE):
            exec(
                compile("\n".join(self.content), self.env.docname, "exec"), {"__name__": "__main__"}
            )
            pyplot.savefig(path)
            pyplot.close("all")
        return [nodes.image(uri=f"/{name}", alt=self.options["alt"])]


def setup(app):
    """Called by Sphinx."""
    app.add_directive("plot", Plot)
    app.add_config_value("draw", True, "env", bool)
    return {"parallel_read_safe": True}
