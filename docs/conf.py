"""Sphinx: the documentation as one offline site (``make docs``)."""

import re
import sys
from importlib import metadata
from pathlib import Path

from docutils import nodes

sys.path.insert(0, str(Path(__file__).parent))

project = "Underfoot"
author = "The Underfoot authors"
copyright = author
release = metadata.version("underfoot")
root = Path(__file__).parents[1]
released = re.search(r'date-released: "(.*)"', (root / "CITATION.cff").read_text("utf-8"))
changed = "(not yet released)\n" in (root / "CHANGELOG.md").read_text("utf-8")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",  # the site loads nothing from elsewhere
    "drawn",
    "example_pages",
    "generated",
    "builders",
]
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "_drawn", "api/examples.md"]
html_theme = "furo"
html_title = f"Underfoot {release}"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_search_scorer = str(Path(__file__).with_name("scorer.js"))
html_split_index = True  # a page a letter
templates_path = ["_templates"]
html_context = {"released": released and released[1], "changed": changed}
html_sidebars = {
    "**": [
        "sidebar/brand.html",
        "version.html",
        "sidebar/search.html",
        "sidebar/scroll-start.html",
        "sidebar/navigation.html",
        "sidebar/scroll-end.html",
    ]
}

napoleon_google_docstring = True
napoleon_numpy_docstring = True
napoleon_use_ivar = True  # attributes as a list: as objects they would be described twice
napoleon_custom_sections = [("Errors", "Raises"), "Source"]
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "all"
autodoc_typehints_format = "short"
autodoc_default_options = {"members": True, "undoc-members": False}
suppress_warnings = ["myst.header", "ref.python", "misc.highlighting_failure"]


def _plain_formulas(app, what, name, object_, options, lines) -> None:
    """Formulas in docstrings are plain text: |E*| is a modulus, no markup; examples are code."""
    shown, in_example = [], False
    for line in lines:
        begins = line.startswith(">>>")
        if begins and ".. rubric:: Examples" not in shown:
            shown += [".. rubric:: Examples", ""]
        in_example = begins or (in_example and bool(line.strip()))
        shown.append(line if in_example else line.replace("|", "\\|").replace("*", "\\*"))
    lines[:] = shown


def _mark_prose(app, tree) -> None:
    """Mark outputs without columns: their lines may be folded, those of a table may not."""
    for block in tree.findall(nodes.literal_block):
        if block.get("language") == "text" and not re.search(r"\S {2,}\S", block.astext()):
            block["classes"].append("prose")


def setup(app) -> None:
    """Called by Sphinx."""
    app.connect("doctree-read", _mark_prose)
    app.connect("autodoc-process-docstring", _plain_formulas)
