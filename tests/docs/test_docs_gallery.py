"""Every page of the gallery answers with a picture and numbers; its downloads run as they are."""

import json
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

from example_pages import cells, files_beside, fresh_folder, notebook, question, script
from pages import ROOT, blocks_of, numbers_compared

PAGES = [page for page in sorted((ROOT / "docs/gallery").glob("*.md")) if page.stem != "index"]
SLOW = (
    "add_my_fluid add_my_law etch_the_floor how_deep_a_tread is_my_grid_fine_enough one_reading "
    "pass_the_test soft_or_hard sweep_on_a_cluster what_to_measure_first when_is_it_worn_out "
    "what_would_help which_floor which_lug_in_oil which_pattern which_spill"
).split()


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.slow] * (page.stem in SLOW))
        for page in PAGES
    ],
)
def test_an_example_prints_and_draws_what_its_page_shows(page):
    from matplotlib import pyplot

    pyplot.switch_backend("Agg")
    pyplot.close("all")
    with fresh_folder(page) as folder:
        assert numbers_compared(page, folder) >= 3
        assert len(pyplot.get_fignums()) == 1


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_script_and_notebook_hold_the_blocks_of_the_page(page):
    text = page.read_text()
    compile(script(text, page.stem), page.stem, "exec")
    stored = json.loads(notebook(text))["cells"]
    code = [cell["source"] for cell in stored if cell["cell_type"] == "code"]
    assert code == [body for kind, body in cells(text) if kind == "code"]
    for block in blocks_of(page):
        if block.language in ("python", "toml"):
            assert block.text.strip() in "\n".join(code)
    assert all(file.is_file() for file in files_beside(page))


def test_the_first_page_of_the_gallery_shows_every_question_once():
    index = (ROOT / "docs" / "gallery" / "index.md").read_text()
    shown = [line for line in index.splitlines() if line in {page.stem for page in PAGES}]
    assert sorted(shown) == [page.stem for page in PAGES]
    assert len(PAGES) >= 30
    assert all(question(page) for page in PAGES)


@pytest.mark.parametrize("folder", ["guide", "tutorials", "gallery"])
def test_no_page_is_without_a_picture(folder):
    for page in (ROOT / "docs" / folder).glob("*.md"):
        text = page.read_text()
        assert any(sign in text for sign in ("{plot}", "{picture}", "{cards}", "![")), page.stem


def test_pictures_are_used_and_small():
    pages = "".join(page.read_text() for page in (ROOT / "docs").rglob("*.md"))
    pages += (ROOT / "README.md").read_text()
    for picture in (ROOT / "docs" / "images").iterdir():
        assert f"images/{picture.name}" in pages, picture.name
        limit = 1_000_000 if picture.suffix == ".gif" else 150_000
        assert picture.stat().st_size <= limit, picture.name
