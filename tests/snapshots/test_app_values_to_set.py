"""Values that a person sets on pages: every slider and field, in both systems of units."""

from typing import Any

import pytest

from page_session import MOVING, pages_shown, session_of
from small_soles import fake
from snapshot import held, refusal
from underfoot.app import inputs
from underfoot.app.components import scale, sentences, table
from underfoot.app.pages import answer, design, sole_file, studies
from underfoot.app.pages.trials_folder import SHOWN
from underfoot.app.pages.trials_trial import TrialPlot
from underfoot.app.session import Exchange, address, problem_parts
from underfoot.app.text import Text, as_json, chosen_language
from underfoot.app.variant_bar import new_variant
from underfoot.core import InputError
from underfoot.core.errors import Cancelled
from underfoot.core.presentation import Part

LISTS = {
    "answer": answer.LIVE,
    "layers": design.LAYERS,
    **design.CONDITIONS,
}
SLIDERS = {"answer": answer.LIVE, "tread": design.TREAD}


@pytest.fixture
def session(tmp_path):
    made = session_of(tmp_path)
    new_variant(made, "a", shoe="work_shoe_full_tread")
    return made


@pytest.mark.parametrize("name", SLIDERS)
def test_sliders(file_regression, session, name):
    """At its lowest, in the middle, beyond its ends, in metric and in US units."""
    told = {}
    for each in SLIDERS[name]:
        middle = (each.low * each.high) ** 0.5 if each.log else 0.5 * (each.low + each.high)
        rows = [
            inputs._row(session, each, value, "guess")
            for value in (each.low, middle, each.high * 1.5, each.low / 2)
        ]
        session.units = "us"
        told[each.path] = [*rows, each.shown_in("us"), each.shown_in("si"), each.case_value(middle)]
        session.units = "si"
    held(file_regression, told, hide=MOVING)


def test_what_is_typed(file_regression, session):
    speed, angle, plain = answer.LIVE[0], answer.LIVE[5], answer.LIVE[3]
    told: dict[str, Any] = {
        "si": [speed.read_typed(typed, "si", comma=False) for typed in ("1", "0.5 ft/s", "3 km/h")],
        "us": [speed.read_typed(typed, "us", comma=False) for typed in ("1", "0.5 m/s")],
        "comma": [
            speed.read_typed("1,5", "si", comma=True),
            plain.read_typed("62,5", "si", comma=True),
        ],
        "angle": [angle.read_typed(typed, "us", comma=False) for typed in ("7", "0.1 rad")],
        "number": plain.read_typed("60", "us", comma=False),
        "in unit": [
            inputs.read_in_unit(typed, unit, comma=False)
            for typed, unit in (("3", "mm"), ("1 in", "mm"), ("2", "s"))
        ],
        "counts": [inputs.whole_number(typed, comma=False) for typed in ("1", "12", "3.0")],
        "refused": [
            refusal(speed.read_typed, "fast", "si", comma=False),
            refusal(speed.read_typed, "3 kg", "si", comma=False),
            *(
                refusal(inputs.whole_number, typed, comma=False)
                for typed in ("0", "1.5", "-2", "x")
            ),
            refusal(inputs.read_in_unit, "3 s", "mm", comma=False),
        ],
        "changes": inputs.changes(
            answer.LIVE,
            {"motion.speed": "0.123456789012", "other": 1, "shoe.material.shore_a": 61.5},
        ),
    }
    grooves = [
        {"along": "40 mm", "across": "1 mm", "width": "3 mm", "length": "20 mm", "angle": "90 deg"},
        {"along": "50 mm", "across": "0 mm", "width": "3 mm"},
    ]
    session.project.change("a", {inputs.GROOVES: grooves})
    told["grooves"] = inputs.grooves_of(session.project.case("a"))
    new_variant(session, "b", shoe="work_shoe_untreaded")
    told["none"] = inputs.grooves_of(session.project.case("b"))
    held(file_regression, told)


@pytest.mark.parametrize(("language", "units"), [("en", "si"), ("de", "us")])
def test_fields(file_regression, monkeypatch, tmp_path, language, units):
    session = session_of(tmp_path, language)
    session.units = units
    new_variant(session, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    session.project.change("a", {"motion.speed": "0.3 m/s", "shoe.sole.midsole": None})
    changed: list[Any] = []

    def fields(listed):
        def fill():
            case = session.project.case("a")
            for each in listed:
                inputs.number_field(session, each, case, changed.append)

        return fill

    builds = {name: fields(listed) for name, listed in LISTS.items()}
    held(file_regression, pages_shown(monkeypatch, builds), hide=MOVING)


def test_parts_of_pages(file_regression, monkeypatch, session):
    """Tables, scales, plots: at their ends, with parts, with buttons."""
    marks = [("here", "this <one>", 0.123456), ("needed", "walkers", 0.9), ("known", "b", -0.1)]
    shown = {"title": "A & b", "columns": ["", "X"], "shows": "lug",
             "rows": [["first", "50 %"], [Part("of it"), "2"], ["last", "3"]]}  # fmt: skip
    plain = {"title": "", "columns": ["", ""], "rows": [["a", "b"]]}
    builds = {
        "scale": lambda: scale(marks, (-0.2, 0.4)), "bare scale": lambda: scale(marks[:1], None),
        "table": lambda: table(shown, ("Cut", print), [1, 2]), "plain": lambda: table(plain),
        "sentences": lambda: sentences(["one", "two"], "soft"),
        "plot": lambda: TrialPlot(session, choosing=True).show({"panels": []}, 3),
        "usual plot": lambda: TrialPlot(session, panel=50),
    }  # fmt: skip
    held(file_regression, [pages_shown(monkeypatch, builds), SHOWN], hide=MOVING)


def test_errors_and_addresses(file_regression):
    several: Any = InputError("all of it")
    several.errors = (InputError("one", where="a.b", allowed="1 to 2"),
                      InputError("two", remedy="Mend it"))  # fmt: skip
    near = InputError("odd", where="x", allowed="y")
    exchange = Exchange()
    for k in range(70):
        exchange.keep(str(k), "text/plain")
    held(
        file_regression,
        {
            "parts": [
                problem_parts(one)
                for one in (several, near, ValueError("odd"), KeyError("k"), Cancelled("x"))
            ],
            "addresses": [address("/a"), address("/a", b="c d&e", f="ä")],
            "kept": [len(exchange.content), [text for text, _ in exchange.content.values()][:2]],
            "json": as_json({"a": "</script>", "ä": [1, None]}),
            "languages": [
                chosen_language(*given)
                for given in (
                    ("de", ""),
                    (None, "de-CH;q=0.9,en"),
                    ("xx", "fr, de"),
                    (None, "fr"),
                    ("", ""),
                )
            ],
        },
    )


@pytest.mark.parametrize("language", ["en", "de"])
def test_words(file_regression, language):
    text = Text(language)
    messages = {
        "{a} and {b} lie beside {a}.": "{b} und {a} liegen neben {a}.",
        "{n} {n:lug|lugs} of the whole sole": "{n} {n:Stollen|Stollen} der ganzen Sohle",
        "{a} {b}": "{b} {a}",
    }
    from underfoot.app.text import _as_sentences

    held(
        file_regression,
        {
            "numbers": [text.number(value) for value in (None, 0.0, 1234567.0, 0.012345, 1.5)],
            "digits": text.number(1.23456, 2),
            "comma": text.comma,
            "units": text.unit_systems(),
            "script": text.script()[:60],
            "get": [text.get("no.key", "else"), text.get("jobs.none", "")],
            "sentences": _as_sentences(messages),
            "keys": len(text.sentences()) > 100,
        },
    )


def test_values_of_studies(file_regression):
    typed = studies.typed_value
    rows = {
        "vary": ({"from": "1 mm", "to": "2 mm", "steps": "3"}, {"values": "1 mm, 2 mm; 3 mm"},
                 {"from": "1 mm"}, {"values": " ; "}),
        "uncertain": ({"kind": "normal", "first": "1 mm", "second": "0.1 mm"},
                      {"kind": "lognormal", "first": "1 mm", "second": "1.3"},
                      {"kind": "even", "first": "1 mm", "second": ""}),
        "conditions": ({"values": "vinyl_g4, ceramic"},),
    }  # fmt: skip
    shown = [
        ("vary", ["a", 2]),
        ("vary", {"from": "1 mm", "to": 2, "steps": 3}),
        ("vary", {"odd": 1}),
        ("vary", "x"),
        ("uncertain", {"normal": 1, "sd": 2}),
        ("uncertain", {"lognormal": 1, "factor": 2}),
        ("uncertain", {"from": 1, "to": 2}),
        ("uncertain", {}),
        ("conditions", {"a": 1}),
        ("conditions", {}),
        ("conditions", ["a"]),
    ]
    held(
        file_regression,
        {
            "typed": [
                typed(text, path, comma=comma, names=names)
                for text, path, comma, names in (
                    ("1,5 mm", "shoe.tread.depth", True, False),
                    ("2.0 mm", "shoe.tread.depth", False, False),
                    ("60", "shoe.material.shore_a", False, False),
                    ("60.5", "", False, False),
                    ("grid", "shoe.tread.pattern", False, True),
                    ("3 x", "motion.odd", False, True),
                )
            ],
            "refused": [
                refusal(typed, text, path, comma=False)
                for text, path in (
                    ("thick", "shoe.tread.depth"),
                    ("3", "shoe.tread.depth"),
                    ("3 s", "shoe.tread.depth"),
                )
            ],
            "values": {
                section: [studies._value(section, "shoe.tread.depth", fields) for fields in each]
                for section, each in rows.items()
                if section != "conditions"
            },
            "conditions": studies._value("conditions", "floor", rows["conditions"][0]),
            "with steps": refusal(
                studies._value,
                "vary",
                "shoe.tread.depth",
                {"from": "1 mm", "to": "2 mm", "steps": "0"},
            ),
            "shown": [studies._fields(*one) for one in shown],
            "choices": [sole_file.CHOICES, sole_file.ACCEPT, studies.METHOD, studies.FIELDS],
        },
    )


def test_sipes_are_a_lug_and_a_channel_apart(file_regression):
    def case(**values):
        return fake(value=lambda path: values.get(path.rpartition(".")[2]))

    lug = {"lug_width": 6e-3, "channel_width": 2e-3, "depth": 4e-3}
    held(file_regression, [design._sipes(case(**lug)), design._sipes(case(**lug, lug_length=1e-2))])
