"""The words of the app: every language has the same, and every word that a page asks for."""

import re
import tomllib
from pathlib import Path
from string import Formatter

import pytest

pytest.importorskip("nicegui")

import underfoot.app
from underfoot.app.text import FOLDER, LANGUAGES, Text, catalogue, chosen_language

SOURCE = Path(underfoot.app.__file__).parent


def placeholders(words):
    return {name for _, name, _, _ in Formatter().parse(words) if name is not None}


@pytest.mark.parametrize("language", [code for code in LANGUAGES if code != "en"])
def test_languages_have_the_same_keys_and_placeholders(language):
    english, other = catalogue("en"), catalogue(language)
    assert english.keys() == other.keys()
    different = [key for key in english if placeholders(english[key]) != placeholders(other[key])]
    assert not different


def test_every_key_that_the_source_names_exists():
    text = "\n".join(path.read_text(encoding="utf-8") for path in SOURCE.rglob("*.py"))
    named = set(re.findall(r'text\(\s*"([a-z_]+\.[\w.]+)"', text))
    assert len(named) > 50
    assert not named - catalogue("en").keys()


def test_words_of_inputs_and_patterns_are_there():
    from underfoot.app.pages import PAGES, answer, design
    from underfoot.case.sole import TreadPattern

    words = Text("en")
    inputs = [
        *design.TREAD,
        *answer.LIVE,
        *(i for part in design.CONDITIONS.values() for i in part),
    ]
    keys = [f"inputs.{each.path}" for each in inputs]
    keys += [f"patterns.{name}" for name in TreadPattern.options()]
    keys += [page.title for page in PAGES]
    assert all(words(key) for key in keys)


def test_what_a_cof_is_unsure_of_has_a_name_in_each_language():
    from underfoot.compute.numbers import INPUTS

    german = tomllib.loads((FOLDER / "de.package.toml").read_text("utf-8"))
    assert not [name for name in INPUTS.values() if f"{name} {{}}" not in german]


def test_language_is_the_chosen_one_then_the_browser_s():
    assert chosen_language(None, "de-AT,de;q=0.9,en;q=0.8") == "de"
    assert chosen_language("en", "de") == "en"
    assert chosen_language("xx", "fr,it") == "en"
