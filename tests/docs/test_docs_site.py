"""The documentation holds together: no warning, every page reachable, every name there."""

import importlib
import os
import re
import subprocess
import sys
import time
from importlib import metadata
from pathlib import Path
from urllib.parse import quote

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))
sys.path.insert(0, str(Path(__file__).parents[1] / "app"))
sys.path.insert(0, str(Path(__file__).parent))

import generated
from chromium import opened
from downloads import offered, problems

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
DRAWN = (
    "which_regime fit_my_dma fit_my_tribometer read_my_c3d who_slips how_thick_is_my_glycerol"
).split()
QUESTIONS = {
    "Which lug in oil?": "which_lug_in_oil",
    "When is it worn out?": "when_is_it_worn_out",
    "What is this floor?": "what_is_this_floor",
    "Read my C3D": "read_my_c3d",
    "Fit my DMA": "fit_my_dma",
}
TOO_WIDE = (
    "Math.max(...[...document.querySelectorAll('html, .content')]"
    ".map((e) => e.scrollWidth - e.clientWidth))"
)
"""Pixels by which a page scrolls sideways; tables, code and formulas scroll by themselves."""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Return the folder of the built pages; figures but for six are drawn by other tests."""
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html"]
    drawn = ",".join(f"gallery/{name}" for name in DRAWN)
    done = subprocess.run(
        [*command, "-D", f"draw={drawn}", str(DOCS), str(folder)],
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


@pytest.mark.study
@pytest.mark.browser
@pytest.mark.parametrize("width", [1366, 390])
def test_no_page_is_too_long_or_too_wide(site, width):
    pages = [page for page in site.rglob("*.html") if "_static" not in page.parts]
    assert len(pages) > 150
    with opened(site / "index.html", width=width, height=800, touch=width < 800) as session:
        for page in pages:
            session.go(page)
            session.value("window.MathJax?.startup?.promise?.then(() => true)")
            # genindex-all is the index by letters once more, to search in
            if width > 800 and page.name != "genindex-all.html":
                assert session.value("document.documentElement.scrollHeight") < 15_000, page
            assert session.value(TOO_WIDE) <= 0, page
        if width < 800:  # the measure sees tables and code that do not scroll by themselves
            session.go(site / "physics" / "wear.html")
            wide = "document.querySelectorAll('.table-wrapper, pre')"
            session.value(f"{wide}.forEach((e) => {{ e.style.overflow = 'visible' }}), 1")
            assert session.value(TOO_WIDE) > 100


@pytest.mark.slow
@pytest.mark.browser
def test_five_questions_of_a_newcomer_are_one_click_from_the_first_page_and_found_first(site):
    with opened(site / "index.html", width=1366, height=768) as session:
        cards = session.value(
            "Object.fromEntries([...document.querySelectorAll('a.card')]"
            ".map((a) => [a.textContent, a.getAttribute('href')]))"
        )
        assert {text: cards.get(text) for text in QUESTIONS} == {
            text: f"gallery/{page}.html" for text, page in QUESTIONS.items()
        }
        for text, page in QUESTIONS.items():
            session.go(site / "search.html", query=f"?q={quote(text)}")
            first = "document.querySelector('#search-results li a')?.getAttribute('href')"
            limit = time.monotonic() + 60
            while not (target := session.value(first)):
                assert time.monotonic() < limit, text
                time.sleep(0.1)
            assert target.startswith(f"gallery/{page}.html"), text
            session.go(site / "gallery" / f"{page}.html")
            assert session.value("document.querySelector('h1').textContent").startswith(text)


@pytest.mark.slow
@pytest.mark.parametrize("name", DRAWN)
def test_downloads_of_a_built_page_run_as_they_are_in_an_empty_folder(site, name):
    page = site / "gallery" / f"{name}.html"
    assert {".py", ".ipynb"} <= {file.suffix for file in offered(page)}
    found = problems(page)
    assert len(found) >= 2
    assert not any(found.values()), found


@pytest.mark.slow
def test_a_page_names_its_release_and_the_site_has_the_notes_of_every_version(site):
    index = (site / "index.html").read_text("utf-8")
    version = metadata.version("underfoot")
    released = re.search(r'date-released: "(.*)"', (ROOT / "CITATION.cff").read_text("utf-8"))
    assert released
    assert f"Underfoot {version}" in index
    assert f"Released {released[1]}" in index
    assert 'href="reference/changes.html"' in index
    notes = (site / "reference" / "changes.html").read_text("utf-8")
    changes = (ROOT / "CHANGELOG.md").read_text("utf-8")
    versions = re.findall(r"^## (\d\S*)", changes, re.MULTILINE)
    assert version in versions
    for each in versions:
        for part in ("breaks", "mended"):
            assert f'href="versions/{each}_{part}.html"' in notes
            assert (site / "reference" / "versions" / f"{each}_{part}.html").is_file()


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
    assert rooms - {"app", "cli", "data"} <= listed
