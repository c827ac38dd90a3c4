"""The directive ``{plot}``: a figure drawn by the Matplotlib code of its block.

Matplotlib's own directive cannot be used from Markdown (it writes reStructuredText).
"""

import os
from pathlib import Path

import matplotlib
from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.environment import BuildEnvironment
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
    "axes.formatter.min_exponent": 3,  # 10 on a logarithmic axis, not a power of ten
}


def drawn_page(env: BuildEnvironment, page: str | None = None) -> bool:
    """Return whether a page's figures are drawn: all, or those that ``-D draw=PAGE,PAGE`` names."""
    return env.config.draw == "all" or (page or env.docname) in env.config.draw.split(",")


class Plot(SphinxDirective):
    """Run the block and show the figure that it leaves."""

    has_content = True
    option_spec = {"alt": directives.unchanged_required}  # noqa: RUF012

    def run(self) -> list[nodes.Node]:
        """Return the image, or nothing where the page is not to be drawn."""
        if not drawn_page(self.env):
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
    app.add_config_value("draw", "all", "env", str)
    return {"parallel_read_safe": True}
