"""Every command and Python block of the tutorials runs, and prints what the page says."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

import generated
from pages import ROOT, agrees, blocks_of, held, numbers_compared, reader

from machine import cpu_seconds, slowness

TUTORIALS = sorted((ROOT / "docs" / "tutorials").glob("*.md"))
PHYSICS = [p for p in sorted((ROOT / "docs/physics").glob("*.md")) if p.stem != "index"]
LONG_TUTORIALS = {"designer", "ergonomist", "laboratory"}
"""Minutes each; `make test-studies` runs them. The quick tests run the same commands."""
LONG_PAGES = {"lug_edges", "block", "coupled_contact"}


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(
            page, id=page.stem,
            marks=pytest.mark.study if page.stem in LONG_TUTORIALS else pytest.mark.slow,
        )
        for page in TUTORIALS
    ],
)  # fmt: skip
def test_a_tutorial_prints_what_it_says_in_the_time_it_says(page, tmp_path):
    assert f"{{minutes}}`{page.stem}`" in page.read_text()
    before = cpu_seconds()
    assert numbers_compared(page, tmp_path) >= 20
    assert cpu_seconds() - before < 60 * generated.MINUTES[page.stem] * slowness()


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.slow] * (page.stem in LONG_PAGES))
        for page in PHYSICS
    ],
)
def test_a_page_of_physics_computes_its_numbers_and_figures(page, tmp_path):
    languages = [block.language for block in blocks_of(page)]
    assert languages.count("{plot}") >= 1
    assert numbers_compared(page, tmp_path) >= 3


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("trials_analysis", marks=pytest.mark.slow),
        pytest.param("design_studies", marks=pytest.mark.slow),
        pytest.param("risk", marks=pytest.mark.study),
    ],
)
def test_a_guide_prints_what_it_says(name, tmp_path):
    assert numbers_compared(ROOT / "docs" / "guide" / f"{name}.md", tmp_path) >= 1


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.slow] * (page.stem == "performance"))
        for page in sorted((ROOT / "docs" / "guide").glob("*.md"))
        if "{plot}" in page.read_text() and page.stem != "design_studies"  # run above
    ],
)
def test_a_guide_draws_its_figures(page, tmp_path):
    with reader(tmp_path) as session:
        for block in blocks_of(page):
            if block.language == "{plot}":
                session.output(block)


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_every_block_of_a_tutorial_shows_what_it_prints_or_prints_nothing(page):
    shown = [block for block in blocks_of(page) if block.shown is not None]
    assert len(shown) >= (6 if page.stem == "app" else 8)
    for block in shown:
        assert any(character.isdigit() for character in block.shown or ""), block.line


def test_pages_are_held_to_words_and_numbers():
    assert agrees("COF 0.100 ± 0.02", "COF   0.101 ± 0.02")
    assert not agrees("COF 0.100", "COF 0.105")
    assert not agrees("COF 0.100", "ACOF 0.100")
    assert held("a 1\n...\nb 2", "a 1\nx 9\nb 2") == 2
    with pytest.raises(AssertionError, match="not printed"):
        held("b 2\na 1", "a 1\nb 2")
