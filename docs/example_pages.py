"""Pages of the gallery: ``{picture}`` runs the blocks of its page, shows the figure that they leave
and offers them as script and notebook; ``{cards}`` shows pages by question and picture.

A page is its script: ``toml`` and ``csv`` blocks whose first line is ``# name`` are files,
``python`` blocks go on in one session, files to put beside it are named by ``{download}``.
"""

import contextlib
import io
import json
import os
import posixpath
import re
import shutil
import tempfile
from pathlib import Path

import matplotlib
from docutils import nodes
from docutils.parsers.rst import directives
from drawn import STYLE, drawn_page
from sphinx import addnodes
from sphinx.util.docutils import SphinxDirective

FENCE = re.compile(r"^```(\{?\w+\}?)\n(.*?)^```$\n?", flags=re.DOTALL | re.MULTILINE)
ROLE = re.compile(r"\{[\w:]+\}`([^`<]*?)\s*(?:<[^`]*>)?`")
DOWNLOAD = re.compile(r"\{download\}`[^`<]*<([^`>]+)>`")


def cells(text: str) -> list[tuple[str, str]]:
    """Return the prose ("markdown") and the code ("code") of a page in their order."""
    found, end = [], 0
    for block in [*FENCE.finditer(text), None]:
        prose = ROLE.sub(r"\1", text[end : block.start() if block else len(text)]).strip()
        if prose:
            found.append(("markdown", prose))
        if block is None:
            break
        end, (language, body) = block.end(), block.groups()
        name = re.match(r"# ([\w.]+)\n", body)
        if language == "python":
            found.append(("code", body.strip()))
        elif language in ("toml", "csv") and name:
            written = f'"""\\\n{body if language == "toml" else body[name.end() :]}"""'
            code = f'from pathlib import Path\n\nPath("{name[1]}").write_text({written})'
            found.append(("code", code))
    return found


def script(text: str, name: str) -> str:
    """Return a page as a Python script that stores its figure as ``name.png``."""
    parts = [
        body if kind == "code" else "\n".join(f"# {line}".rstrip() for line in body.splitlines())
        for kind, body in cells(text)
    ]
    stored = f'import matplotlib.pyplot as plt\n\nplt.savefig("{name}.png")'
    return "\n\n".join([*parts, stored]) + "\n"


def notebook(text: str) -> str:
    """Return a page as a Jupyter notebook (format 4)."""
    made = []
    for kind, body in cells(text):
        cell = {"cell_type": kind, "metadata": {}, "source": body}
        made.append(cell | ({"execution_count": None, "outputs": []} if kind == "code" else {}))
    whole = {"cells": made, "metadata": {}, "nbformat": 4, "nbformat_minor": 4}
    return json.dumps(whole, indent=1)


def files_beside(page: Path) -> list[Path]:
    """Return the files of the repository that a page reads."""
    return [(page.parent / place).resolve() for place in DOWNLOAD.findall(page.read_text())]


@contextlib.contextmanager
def fresh_folder(page: Path):
    """Be in a new folder with nothing but the files that a page reads."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        for file in files_beside(page):
            shutil.copy(file, folder)
        os.chdir(folder)
        try:
            yield Path(folder)
        finally:
            os.chdir(before)


def question(page: Path) -> str:
    """Return the title of a page."""
    return page.read_text().partition("\n")[0].removeprefix("# ")


_made: set[Path] = set()


def draw(page: Path, source: Path) -> None:
    """Run a page once in a build; leave picture, script, notebook and its files in ``_drawn``."""
    if page in _made:
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot

    text, target = page.read_text(), source / "_drawn" / page.stem
    target.mkdir(parents=True, exist_ok=True)
    with fresh_folder(page) as folder, matplotlib.rc_context(STYLE):
        with contextlib.redirect_stdout(io.StringIO()):
            code = "\n\n".join(body for kind, body in cells(text) if kind == "code")
            exec(compile(code, page.name, "exec"), {"__name__": "__main__"})
        pyplot.savefig("picture.svg")
        pyplot.close("all")
        for file in [folder / "picture.svg", *folder.glob("*.toml")]:
            shutil.copy(file, target)
    (target / f"{page.stem}.py").write_text(script(text, page.stem))
    (target / f"{page.stem}.ipynb").write_text(notebook(text))
    _made.add(page)


class Picture(SphinxDirective):
    """The figure of the page's own code, and its files."""

    option_spec = {"alt": directives.unchanged_required}  # noqa: RUF012

    def run(self) -> list[nodes.Node]:
        """Return image and downloads, or nothing where the page is not to be drawn."""
        if not drawn_page(self.env):
            return []
        page, source = Path(self.env.doc2path(self.env.docname)), Path(self.env.srcdir)
        draw(page, source)
        made, line = source / "_drawn" / page.stem, nodes.paragraph(classes=["downloads"])
        for file in sorted(set(made.iterdir()) - {made / "picture.svg"}, reverse=True):
            target = f"/_drawn/{page.stem}/{file.name}"
            link = addnodes.download_reference(reftarget=target, refdoc=self.env.docname)
            line += [link, nodes.Text(" ")]
            link += nodes.literal(text=file.name)
        image = nodes.image(uri=f"/_drawn/{page.stem}/picture.svg", alt=self.options["alt"])
        return [image, line]


class Cards(SphinxDirective):
    """Pages by their paths from this one, each as its picture over its question."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return one card for each line of the content."""
        source = Path(self.env.srcdir)
        folder = Path(self.env.doc2path(self.env.docname)).parent
        cards = nodes.container(classes=["cards"])
        for name in self.content:
            page = folder / f"{name}.md"
            self.env.note_dependency(str(page))
            target = posixpath.join(posixpath.dirname(self.env.docname), name)
            address = self.env.app.builder.get_relative_uri(self.env.docname, target)
            link = nodes.reference("", "", internal=True, refuri=address, classes=["card"])
            if drawn_page(self.env, target):
                draw(page, source)
                link += nodes.image(uri=f"/_drawn/{page.stem}/picture.svg", alt="")
            link += nodes.inline(text=question(page))
            cards += nodes.paragraph("", "", link)
        return [cards]


def setup(app):
    """Called by Sphinx."""
    app.add_directive("picture", Picture)
    app.add_directive("cards", Cards)
    return {"parallel_read_safe": True}
