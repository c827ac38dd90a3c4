"""The theory manual: the pages of the physics as one page, to read or to print."""

from pathlib import Path

from docutils import nodes
from sphinx.builders.singlehtml import SingleFileHTMLBuilder

ROOT = "physics/index"
PAGE = "theory_manual"


class ManualBuilder(SingleFileHTMLBuilder):
    """One page of ``physics/index`` and all below it, written beside the pages of the site."""

    name = "manual"

    def write_documents(self, docnames: set[str]) -> None:
        """Write the page; only here does the manual begin elsewhere than the site."""
        includes, self._inside = self.env.toctree_includes, {ROOT}
        below = [ROOT]
        while below:
            below = [page for each in below for page in includes.get(each, ())]
            self._inside |= set(below)
        site, self.config.root_doc = self.config.root_doc, ROOT
        title, self.config.html_title = self.config.html_title, f"{self.config.html_title}, theory"
        try:
            super().write_documents(docnames)
        finally:
            self.config.root_doc, self.config.html_title = site, title

    def assemble_doctree(self) -> nodes.document:
        """Return the whole page; a link to a place in one of its pages has one anchor, not two."""
        tree = super().assemble_doctree()
        for link in tree.findall(nodes.reference):
            page, _, place = link.get("refuri", "")[1:].partition("#")
            if place and page.startswith("document-"):
                link["refuri"] = f"#{place}"
        return tree

    def get_target_uri(self, docname: str, typ: str | None = None) -> str:
        """Return a place of this page, or the page of the site."""
        inside = docname in getattr(self, "_inside", ())
        return f"#document-{docname}" if inside else f"{docname}{self.out_suffix}"

    def get_output_path(self, page_name: str, /) -> Path:
        """Return the file of a page."""
        return Path(self.outdir) / f"{PAGE}{self.out_suffix}"

    def finish(self) -> None:
        """Copy the figures; everything else is the site's."""
        self.copy_image_files()


def setup(app) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_builder(ManualBuilder)
    return {"parallel_read_safe": True}
