"""Whatever two cases may differ in has a name in each language of the app."""

from pathlib import Path

import pytest

from underfoot import Case
from underfoot.app.text import LANGUAGES, catalogue

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
BESIDE = ("shoe.outsole.file", "shoe.outsole.unit", "shoe.outsole.down", "shoe.outsole.forward")


@pytest.mark.parametrize("language", sorted(LANGUAGES))
def test_inputs_of_the_examples_have_labels(language: str) -> None:
    paths = {path for file in EXAMPLES for path, *_ in Case.load(file).rows()} | set(BESIDE)
    assert not {path for path in paths if f"inputs.{path}" not in catalogue(language)}
