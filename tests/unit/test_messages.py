"""Every message of the package is a template with named values, and every language has it."""

import ast
import json
import pickle
import re
import tomllib
from copy import deepcopy
from functools import cache
from importlib.resources import files
from pathlib import Path
from string import Formatter

import pytest

import underfoot
from source_trees import nodes
from underfoot.core.remark import (
    Amount,
    Message,
    Remark,
    from_stored,
    kind_of,
    of_several,
    remarks,
    stored_form,
    subjects,
)

SOURCE = Path(underfoot.__file__).parent
TEXT = files("underfoot").joinpath("app", "text")
CODE_AT = {"Message": 0, "assumption_line": 0, "caution": 0, "remark": 0, "Remark": 1}
"""Makers of messages, and which of their arguments is the template."""
OWN = ("core/remark.py", "trials/recording/measurement.py")
"""Where makers are made."""
LETTERS = re.compile("[A-Za-z]{2}")
FIELDS = re.compile(r"\{\w+[^}]*\}")
SCRIPTS = SOURCE / "report" / "templates"
IN_SCRIPT = re.compile(r'"([^"$\n]*\{\w+\}[^"$\n]*)"')
"""Templates of messages that a script of a page makes."""


def fields(code):
    """Return the names of a template's fields and how each is formatted."""
    parts = [(name, spec) for _, name, spec, _ in Formatter().parse(code) if name is not None]
    return {name: [spec for other, spec in parts if other == name] for name, _ in parts}


def faults(nodes):
    """Yield why a call among nodes makes a message of something else than a template and values."""
    for call in nodes:
        if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Name):
            continue
        if (name := call.func.id) not in CODE_AT:
            continue
        code = call.args[CODE_AT[name]] if len(call.args) > CODE_AT[name] else None
        if not (isinstance(code, ast.Constant) and isinstance(code.value, str)):
            yield call.lineno, "its text is no template"
            continue
        given = {keyword.arg for keyword in call.keywords}
        if None not in given and given != fields(code.value).keys():
            yield call.lineno, "its values are not those of the template"
        if None in given and not given - {None} <= fields(code.value).keys():
            yield call.lineno, "it has a value that the template lacks"


KINDS = {"assumed", "assumptions", "cautions", "conventions", "explanation", "reason", "warnings"}
"""Arguments that take messages alone."""


def put_together(node):
    """Yield the places of a tree where text is made of parts, but for the values of messages."""
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") in CODE_AT:
        return
    method = node.func.attr if isinstance(getattr(node, "func", None), ast.Attribute) else ""
    sides = [node.left, node.right] if isinstance(node, ast.BinOp) else ()
    texts = [side for side in sides if isinstance(getattr(side, "value", None), str)]
    if isinstance(node, ast.JoinedStr) or texts or method in ("format", "join"):
        yield node.lineno
        return
    for child in ast.iter_child_nodes(node):
        yield from put_together(child)


def takes_messages(annotation):
    return annotation is not None and "Message" in ast.unparse(annotation)


def places_of_messages(nodes):
    """Yield what stands where messages are asked for: arguments, fields, what functions return."""
    for node in nodes:
        if isinstance(node, ast.Call):
            yield from (each.value for each in node.keywords if each.arg in KINDS)
            if isinstance(node.func, ast.Attribute) and node.func.attr == "not_estimated":
                yield from node.args[1:2]
        elif isinstance(node, ast.AnnAssign) and takes_messages(node.annotation):
            yield from [node.value] if node.value else []
        elif isinstance(node, ast.FunctionDef) and takes_messages(node.returns):
            within = (one for each in node.body for one in ast.walk(each))
            told = (one for one in within if isinstance(one, ast.Return | ast.Yield))
            yield from (one.value for one in told if one.value)


def texts_for_messages(nodes):
    return [line for place in places_of_messages(nodes) for line in put_together(place)]


@cache
def nodes_of_files():
    """Return the nodes of each file that makes messages, by its place."""
    return {
        place: nodes(file)
        for file in sorted(SOURCE.rglob("*.py"))
        if (place := file.relative_to(SOURCE).as_posix()) != OWN[0]
    }


@cache
def codes():
    """Return every template of the package."""
    found = {}
    for place, within in nodes_of_files().items():
        for call in within:
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name):
                for code in call.args[CODE_AT.get(call.func.id, len(call.args)) :][:1]:
                    if isinstance(code, ast.Constant):
                        found.setdefault(code.value, f"{place}:{call.lineno}")
    for script in SCRIPTS.glob("*.js"):
        said = IN_SCRIPT.findall(script.read_text("utf-8"))
        found.update(dict.fromkeys(said, script.name))
    return found


@pytest.mark.parametrize(
    "text",
    [
        'Remark("shoe", f"{n} steps")',
        'Remark("shoe", "%d steps" % n)',
        'Remark("shoe", "{} steps".format(n))',
        'Remark("shoe", "steps: " + n)',
        'Message(", ".join(n))',
        "assumption_line(text)",
        'Message("{count} steps")',
        'Message("steps", count=3)',
        'caution("{count} steps", number=3)',
    ],
)
def test_a_text_that_is_no_template_is_seen(text):
    assert list(faults(ast.walk(ast.parse(text))))


def test_a_template_with_its_values_is_taken():
    code = 'Remark(about, "{count} steps", count=len(steps))'
    assert not list(faults(ast.walk(ast.parse(code))))


def test_every_message_is_a_template_and_its_values():
    found = {
        place: list(faults(each)) for place, each in nodes_of_files().items() if place not in OWN
    }
    assert not {place: lines for place, lines in found.items() if lines}


@pytest.mark.parametrize(
    "code",
    [
        'Measurement("rcof", None, reason=f"{n} steps")',
        'Measurement.not_estimated("rcof", "steps: " + n)',
        'Measurement("rcof", 1.0, conventions={"gate": f"{n} N"})',
        'StribeckLaw(assumed=("; ".join(names),))',
        'def why(n) -> Message: return "{} steps".format(n)',
        'parts: tuple[Message, ...] = (f"{n} steps",)',
    ],
)
def test_a_text_where_a_message_is_asked_for_is_seen(code):
    assert texts_for_messages(ast.walk(ast.parse(code)))


def test_the_values_of_a_message_may_be_put_together():
    code = 'def why(n) -> Message: return Message("{size} N", size=[f"{one:.1f}" for one in n])'
    assert not texts_for_messages(ast.walk(ast.parse(code)))


def test_reasons_conventions_and_assumptions_are_messages():
    found = {place: texts_for_messages(each) for place, each in nodes_of_files().items()}
    assert not {place: lines for place, lines in found.items() if lines}


def catalogues():
    """Return the templates of each language by code."""
    return {
        file.name.partition(".")[0]: tomllib.loads(file.read_text("utf-8"))
        for file in TEXT.iterdir()
        if file.name.endswith(".messages.toml")
    }


def test_every_template_has_its_words_in_each_language_and_no_word_is_left_over():
    spoken = {
        code: place for code, place in codes().items() if LETTERS.search(FIELDS.sub("", code))
    }
    assert len(spoken) > 100
    assert catalogues().keys() >= {"de"}
    for language, templates in catalogues().items():
        missing = {code: place for code, place in spoken.items() if code not in templates}
        assert not missing, language
        assert not templates.keys() - spoken.keys(), language
        different = {
            code: words
            for code, words in templates.items()
            if fields(code).keys() != fields(words).keys()
        }
        assert not different, language


def example(name, specs):
    """Return a value that the formats of a field take."""
    if any(spec and "|" not in spec and spec[-1] in "defgn%" for spec in specs):
        return 3
    return 3 if any("|" in spec for spec in specs) else f"QX{name}"


def test_all_templates_are_written_out_in_all_languages():
    for language, templates in {"en": {code: code for code in codes()}, **catalogues()}.items():
        for code, words in templates.items():
            values = {name: example(name, specs) for name, specs in fields(code).items()}
            text = str(Message(words, **values))
            assert "{" not in text, (language, code)
            names = [value for value in values.values() if isinstance(value, str)]
            assert all(name.lower() in text.lower() for name in names), (language, code)


def test_a_message_keeps_template_and_values_wherever_it_goes():
    part = Message("{count} {count:step|steps}", count=1)
    remark = Remark(
        "shoe.heel", "{part:capital} of {length} in {names: and }", part=part,
        length=Amount(0.06, "m"), names=iter("ab"),
    )  # fmt: skip
    assert remark == "shoe.heel: 1 step of 60 mm in a and b"
    whole = stored_form({"lines": (remark, part)})
    again = from_stored(json.loads(json.dumps(whole)))["lines"]
    for copy in (deepcopy(remark), pickle.loads(pickle.dumps(remark)), again[0]):
        assert (copy, copy.about, copy.code) == (remark, remark.about, remark.code)
        assert copy.values == remark.values
        assert type(copy.values["part"]) is Message
    assert whole["lines"][1] == {"code": part.code, "values": {"count": 1}, "text": "1 step"}
    assert Remark.from_stored(whole["lines"][0]) == remark
    assert Remark.from_stored("shoe.heel: 1 step").about == "shoe.heel"
    assert remarks([remark, "a text"])[1].values == {"text": "a text"}
    whole = subjects(remarks([remark, "the whole", remark, "the whole"]))
    assert whole == ("shoe.heel", "the whole")


def test_lines_that_differ_in_numbers_are_told_as_one():
    def bridged(time, name, count):
        here = Message(" ({count} frames)", count=count)
        line = {"gap": Message("{time:g} ms", time=time), "name": name, "here": here}
        return Message("{name}: bridged up to {gap}{here}", **line)

    heel, wider, toe = bridged(8, "heel", 3), bridged(50.0, "heel", 4), bridged(8, "toe", 3)
    assert heel == "heel: bridged up to 8 ms (3 frames)"
    assert kind_of(heel) == kind_of(from_stored(stored_form(wider))) != kind_of(toe)
    assert of_several([wider, heel]) == "heel: bridged up to 8 to 50 ms"
    assert of_several([heel, heel]) == "heel: bridged up to 8 ms"


def test_a_page_gets_formatted_values_and_escaped_text():
    message = Message("{share:.0%} of <{what}>", share=0.123, what=Message("{n:.1f} & more", n=2))
    assert message.page_data() == {
        "code": "{share:.0%} of <{what}>",
        "values": {"share": "12%", "what": {"code": "{n:.1f} & more", "values": {"n": "2.0"}}},
    }
    assert message.__html__().endswith("12% of &lt;2.0 &amp; more&gt;</span>")
