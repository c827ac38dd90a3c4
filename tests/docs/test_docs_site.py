"""The documentation holds together: no warning, every page reachable, every name there."""

import importlib
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
sys.path.insert(0, str(Path(__file__).parents[1] / "app"))

import generated
from chromium import opened

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Return the folder of the built pages; their figures are drawn by test_docs_pages.py."""
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html"]
    done = subprocess.run(
        [*command, "-D", "draw=0", str(DOCS), str(folder)],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": ""},
    )
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.slow
def test_the_documentation_is_built_without_a_warning(site):
    assert (site / "index.html").is_file()


@pytest.mark.slow
@pytest.mark.browser
def test_no_page_is_too_long_or_too_wide(site):
    pages = [page for page in site.rglob("*.html") if "_static" not in page.parts]
    assert len(pages) > 150
    with opened(site / "index.html", width=1366, height=768) as session:
        for page in pages:
            session.go(page)
            if page.name != "genindex-all.html":  # the index by letters once more, to search in
                assert session.value("document.documentElement.scrollHeight") < 15_000, page
            assert session.value("document.documentElement.scrollWidth") <= 1366, page


def test_every_page_of_the_physics_belongs_to_a_topic():
    filed = (DOCS / "physics" / "index.md").read_text()
    listed = re.findall(r"^[^<\n]+ <([a-z0-9_]+)>$", filed, flags=re.MULTILINE)
    pages = {path.stem for path in (DOCS / "physics").glob("*.md")} - {"index"}
    assert pages - set(listed) == set(), "name these under a topic of docs/physics/index.md"
    assert len(listed) == len(set(listed))


@pytest.mark.parametrize("page", sorted(DOCS.rglob("*.md")), ids=lambda path: path.stem)
def test_every_link_within_the_documentation_leads_to_a_file(page):
    for target in re.findall(r"\]\(([^)#\s]+\.md)(?:#[\w-]*)?\)", page.read_text()):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), target


def test_every_name_of_the_code_that_a_page_links_to_exists():
    count = 0
    for page in DOCS.rglob("*.md"):
        for name in re.findall(r"\{py:\w+\}`~?([\w.]+)`", page.read_text()):
            room, _, member = name.rpartition(".")
            assert hasattr(importlib.import_module(room), member), f"{page.name}: {name}"
            count += 1
    assert count > 15


def test_the_interface_pages_list_every_room():
    listed = {module.split(".")[1] for each in generated.ROOMS.values() for module in each
              if module.startswith("underfoot.")}  # fmt: skip
    rooms = {path.parent.name for path in (ROOT / "src" / "underfoot").glob("*/__init__.py")}
    assert rooms - {"cli", "data"} <= listed
