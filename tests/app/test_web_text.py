"""The words of the app: every language has the same, and every word that a page asks for."""

import ast
import re
import tomllib
from pathlib import Path
from string import Formatter

import pytest
from package_messages import Forms, Piece, Words, filled, messages

from source_trees import nodes

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
    assert not [name for name in INPUTS.values() if name not in german]


OTHERS = {  # NiceGUI's and the system's
    *("Connection lost.", "Trying to reconnect...", "permission denied"),
    "The message is too large for WebSocket transmission.",
}
WORD = re.compile("[A-Za-z]{3}")
MARKS = re.compile(r"""\{\}|[:;,.()"'?=+|·±]| x """)


def said_by_the_package():
    """Return every text and name of the source and its data, what the app says aside."""
    texts = []
    for path in (file for file in SOURCE.parent.rglob("*") if file.suffix in SPEAKING):
        if path.suffix != ".py":
            texts += [path.read_text(encoding="utf-8")] if FOLDER not in path.parents else []
            continue
        for node in nodes(path):
            name = next(
                (getattr(node, key) for key in ("arg", "name", "id") if hasattr(node, key)), ""
            )
            said = node.value if isinstance(node, ast.Constant) else name
            if isinstance(said, str):
                texts += [said, said.replace("_", " ")] if " " not in said else [said]
    return " ".join("\n".join(dict.fromkeys(texts)).lower().split())


SPEAKING = (".py", ".html", ".js", ".toml", ".csv")


def test_the_package_still_says_what_has_a_translation():
    """A word that changes in the source left its German behind, and the page became English."""
    source = said_by_the_package()

    def is_said(chunk):  # whole, or put together of two
        words = chunk.lower().split()
        parts = [(" ".join(words[:k]), " ".join(words[k:])) for k in range(len(words))]
        return any(all(part in source for part in pair) for pair in parts)

    assert is_said("load on the film")
    assert not is_said("load in the film that nobody says")
    for code in LANGUAGES:
        sentences = Text(code).of_package()
        own = {
            english
            for english, other in sentences.items()
            if MARKS.sub("", english) == re.sub(r"\{\d\}", "", MARKS.sub("", other))
        }
        chunks = {each: MARKS.split(each) for each in sentences.keys() - own - OTHERS}
        assert not [
            (each, part)
            for each, parts in chunks.items()
            for part in parts
            if WORD.search(part) and not is_said(part)
        ]


CODE = """
def refused(name, worn):
    where = "at the heel" if worn else "at the toe"
    text = f"{name} is worn {where}"
    if worn:
        text += " by now"
    raise InputError(text, remedy="Take a new one" + f", a {name}")
"""


def test_forms_of_a_message_follow_names_arms_and_pieces():
    function = ast.parse(CODE).body[0]
    piece = Piece("app/project.py", "", function)
    call = next(each for each in ast.walk(function) if isinstance(each, ast.Call))
    told = Forms(piece).of(call.args[0])
    heel, toe = "{} is worn at the heel", "{} is worn at the toe"
    assert told == [heel, toe, f"{heel} by now", f"{toe} by now"]
    assert Forms(piece).of(call.keywords[0].value) == ["Take a new one, a {}"]
    sentences = {"{} is worn {}": "{0} ist {1} abgenutzt", "at the heel": "an der Ferse"}
    sentences["Take {}"] = "{0} nehmen"
    known = [Words(sentences).has(filled(each)) for each in (heel, toe, "Take a shoe.")]
    assert known == [True, False, False]


@pytest.mark.parametrize("language", [code for code in LANGUAGES if code != "en"])
def test_every_message_that_the_app_can_show_has_a_translation(language):
    """A remedy that nobody translated stood in English on a German page."""
    told, words = messages(), Words(Text(language).sentences())
    assert len(told) > 900
    assert {"the file is empty", "step {} on {}", "excluded by hand"} <= told.keys()
    missing = {form: places[0] for form, places in told.items() if not words.has(filled(form))}
    assert not missing, f"{language}.package.toml lacks {missing}"


def test_language_is_the_chosen_one_then_the_browser_s():
    assert chosen_language(None, "de-AT,de;q=0.9,en;q=0.8") == "de"
    assert chosen_language("en", "de") == "en"
    assert chosen_language("xx", "fr,it") == "en"
