"""Numbers, units and texts as people write them; messages, tables, catalogues, progress, files."""

import json
import math
import pickle
import sys
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from snapshot import held, refusal, tried
from underfoot.core import (
    InputError,
    checks,
    device,
    errors,
    fields,
    fourier,
    identity,
    leaves,
    missing,
    moved,
    numbers_text,
    presentation,
    progress,
    provenance,
    registry,
    remark,
    status,
    text,
    threads,
    typed,
    unit_text,
    units,
    values,
)
from underfoot.core.arrays import of_python, scalar_or_array
from underfoot.core.cache import Cache, default_folder
from underfoot.core.catalogue import Catalogue, catalogue, catalogue_folders
from underfoot.core.deprecation import package_names, renamed_member
from underfoot.core.files import (
    check_writable_folder,
    checksum,
    named_for,
    read_toml,
    whole_file,
    whole_folder,
)
from underfoot.core.html import data_address, new_figure, png
from underfoot.core.numbers_text import NumberForm, number_forms
from underfoot.core.optional import optional_module
from underfoot.core.page import (
    PageSection,
    Picture,
    page,
    page_part,
    remark_sections,
    table_sections,
)
from underfoot.core.presentation import Part, Presentable, Table
from underfoot.core.progress import TimeLeft, part, time_text
from underfoot.core.remark import Amount, Message, Remark
from underfoot.core.sparse import back_end, factorization, schur_complement, upper_triangle
from underfoot.core.status import Status
from underfoot.core.validity import ValidityRange, breaches
from underfoot.core.values import SourcedValue


@pytest.fixture(autouse=True)
def _folder(tmp_path, monkeypatch):
    """Errors name files without the folder of this run."""
    monkeypatch.chdir(tmp_path)
    for name in ("UNDERFOOT_UNITS", "UNDERFOOT_CATALOGUE", "UNDERFOOT_SPARSE", "UNDERFOOT_FFT"):
        monkeypatch.delenv(name, raising=False)


TYPED = (
    "41,5 cP",
    "3/8 in",
    "1 1/2 in",
    "1½ in",
    "1.234,5 N",
    "1,234 N",
    "1.234 N",
    "0,234 N",
    "1 234 567 mm",
    "1'234.5",
    "-3 mm",
    "−3 mm",
    "+.5 m",
    "5. m",
    "1e-3 m",
    "1e-400 m",
    "1,2,3",
    "1.2.3",
    "1,234,567",
    "12,34,567",
    "3/0",
    "two",
    "",
    "5",
    "7-3 mm",
    "1e3",
    "1 234",
    "12 345,6 N",
    "1234,567 N",
    "1,234.5,6",
    "½",
    "3 1/2",
)
ASKED = (
    ("3 mm", "m"),
    ("20 degC", "K"),
    ("68 degF", "K"),
    ("10 deg", "rad"),
    ("10 %", "1"),
    ("0.5", "1"),
    ("5 MPa", "Pa"),
    ("219 cP", "Pa*s"),
    ("2 in", "m"),
    ('2"', "m"),
    ("3 mil", "m"),
    ("10 mm2", "m^2"),
    ("7 cm³", "m^3"),
    ("60 Hz", "Hz"),
    ("60 rpm", "Hz"),
    ("1 Hz", "rad/s"),
    ("6.283 rad/s", "Hz"),
    ("5 N/mm", "N/m"),
    ("3 MPa s", "Pa*s"),
    ("5 °C", "K"),
    ("5 µm", "m"),
    ("5 kgf", "N"),
    ("3 ppm", "1"),
    ("5 mm", "s"),
    ("5 furlongs", "m"),
    ("5 mmm", "m"),
    ("5", "m"),
    (5, "m"),
    (5.5, "1"),
    ("5 mm", "1"),
    ("3 +- 1 mm", "m"),
    ("inf m", "m"),
    (math.nan, "1"),
    (True, "1"),
    (None, "m"),
    ("1 1/s", "1/s"),
    ("0.3 mm^3/MPa", "m^3/Pa"),
    ("5 grad", "rad"),
    ("3 deg", "1/s"),
    ("1 kB", "B"),
)


def test_numbers_and_units(file_regression, monkeypatch):
    answers = {
        "typed": {
            t: (tried(typed.split_quantity, t), tried(typed.split_quantity, t, comma=True))
            for t in TYPED
        },
        "signs": [typed.plain_signs(t) for t in ("−1 234\u200b mm", "a\tb", "–5")],
        "lost": [typed.is_lost(*each) for each in ((0.0, "1e-400"), (0.0, "0.0e5"), (1.0, "1"))],
        "si": {
            f"{given} in {unit}": tried(units.to_si, given, unit, where="here")
            for given, unit in ASKED
        },
        "unit of": {
            t: tried(units.si_unit, t, where="here")
            for t in ("219 cP", "3 mm", "5", "2 rad/s", "4 1/mm", "70 kg", "5 blub", "x")
        },
        "spread": [
            tried(units.spread_to_si, *each, where="here")
            for each in (
                ("2 degC", "20 degC", "K"),
                ("3.6 degF", "68 degF", "K"),
                ("1 K", 300.0, "K"),
                ("5 %", "50 %", "1"),
                ("5 %", 0.5, "1"),
                ("1 mm", "5 mm", "m"),
                (0.1, 0.5, "1"),
            )
        ],
        "percent": [
            tried(units.refuse_percent, each, where="here") for each in ("5 %", "5", 5, "1,234 %")
        ],
    }
    sizes = (
        0.0,
        1e-10,
        2.4e-7,
        9.994e-4,
        9.996e-4,
        0.0123,
        0.9996,
        1.5,
        123.4,
        1e5,
        2.3e9,
        -0.03,
        math.nan,
    )
    for system in ("si", "us"):
        monkeypatch.setenv("UNDERFOOT_UNITS", system)
        answers[f"in {system}"] = {
            unit: [unit_text.display(size, unit) for size in sizes] + [unit_text.tread_unit(unit)]
            for unit in (
                "m",
                "Pa",
                "s",
                "N",
                "Pa*s",
                "rad",
                "m^2",
                "m^3",
                "N/m",
                "1",
                "K",
                "m/s",
                "kg",
            )
        }
        answers[f"{system} text"] = [
            presentation.quantity_text(size, "N", size / 10) for size in sizes[:-1]
        ] + [presentation.quantity_text(2.5e-6, "m", 1e-7), presentation.quantity_text(3e-5, "m^2")]
    monkeypatch.delenv("UNDERFOOT_UNITS")
    answers["plain"] = [
        unit_text.plain_number(size)
        for size in (*sizes, 9e-7, -9e-7, 1.1e-6, 99e-6, 101e-6, 1e6, -1e6, 999999.0)
    ]
    answers["text"] = [
        unit_text.number_text(v, d)
        for v, d in ((123456, 3), (1e6, 3), (1e-3, 2), (9e-4, 2), (0.5, 4))
    ]
    answers["metres"] = [unit_text.metres(v) for v in (3.125e-5, 0.5, 12.0)]
    held(file_regression, answers)


COLUMNS = (
    ("0.5", "1.25"),
    ("0,5", "1,25"),
    ("1.075,5", "2"),
    ("1,075,200", "3"),
    ("1.075", "1234"),
    ("1.075", "998"),
    ("1,075", "998"),
    ("1.002", "1.003", "1.004", "998"),
    ("1,075",),
    ("1 234", "5"),
    ("1'234,5",),
    ("0 500",),
    ("1,5", "1.5"),
    ("1.5", "1.234.567"),
    ("3d5", "1e5"),
    ("a", ""),
    ("12.03.2024",),
    ("0.001", "1000"),
    ("1.", ".5"),
)


def test_columns_of_numbers(file_regression):
    answers = {
        "alone": {" | ".join(c): tried(number_forms, [c], "a.csv") for c in COLUMNS},
        "beside": [
            tried(number_forms, [list(c), d], "a.csv")
            for c in (("1,075",), ("1.075",))
            for d in (["0.5"], ["0,5"], ["1.234.567"], ["1,234,567"])
        ],
        "plain": [
            NumberForm(d, t).plain(c)
            for c in ("1.075,5", "1,5", "1 234", "-2,5e3", "x", "1.2.3", "1D2")
            for d, t in ((".", False), (",", False), (",", True))
        ],
        "numbers": [
            tried(numbers_text.column_numbers, cells, NumberForm())
            for cells in (["1", "nan", "-", "2.5"], ["1", "x"], ["1e-400"])
        ],
        "lost": [numbers_text.any_lost(rows) for rows in (["1 2e-400"], ["0e-400"], ["1e-300"])],
        "in cells": numbers_text.units_in_cells(
            [["a", "45 %", "3 mm", "1"], ["b", "50 %", "4 cm", "2"], ["", "5%", "5 mm"]],
            lambda word: word in ("%", "mm", "cm"),
        ),
        "without": numbers_text.without_units(["45 %", "a", "5 mm"], {0: "%", 2: "cm", 7: "m"}),
        "one": [
            tried(numbers_text.one_unit, each, lambda a, b: a == b, "c.csv")
            for each in (["", "mm", "mm"], ["mm", "cm"], ["", "[-]"], ["", ""], [])
        ],
        "codes": [
            missing.mask_of_codes(np.array(v, float), **o)
            for v, o in (
                ([1, 2, 3, -9999], {}),
                ([1, 2, 3, 30], {}),
                ([1, 2, 3, 30, 30], {}),
                ([1, 2, 3, 13, 13], {}),
                ([1, 2, 3, -99, 99, np.nan], {}),
                ([1, 2], {}),
                ([5, 5, 5, 1, 2], {"most": 0.2}),
                ([1, 1, 9], {}),
                ([1, 2, 3, -9999], {"least": 1e5}),
                ([1, 2, 3, 52], {"apart": 30}),
            )
        ],
        "cells": [
            text.cells_of(*each)
            for each in (
                ('a; "b; c" ;d', ";"),
                ("a  b\tc", None),
                ('"a b" c', None),
                ("a,b", ","),
                ('"x', None),
                ("", ","),
            )
        ],
        "harmless": [
            text.harmless(c)
            for c in ("=1+1", "@a", "-5", "+49 30", "-cmd|x", "+a(1)", "\tx", "text")
        ],
        "excerpt": [text.excerpt(c) for c in ("short", "x" * 41, "a\x00b", "y" * 40)],
        "content": text.with_content([(1, "a"), (2, " "), (3, "# b"), (4, " #c"), (5, "d#")]),
        "decoded": [
            tried(text.decode_text, d, "f")
            for d in (
                b"abc",
                "ä".encode(),
                "ä".encode("latin-1"),
                "ab".encode("utf-16"),
                b"\xff\xfea",
                b"a\0b",
                b"  ",
                "a longer text".encode("utf-16-le"),
                "a longer text".encode("utf-16-be"),
            )
        ],
        "not there": [tried(text.existing, "x.csv"), tried(text.numbered_lines, "x.csv", "r")],
        "python": of_python({"a": np.float64(1.5), "b": [np.arange(2), (np.int64(3), "c")]}),
        "scalars": (scalar_or_array(np.float64(2)), scalar_or_array(np.arange(2.0))),
    }
    held(file_regression, answers)


LINE = Message("{count} {count:step|steps} in {time}", count=2, time=Amount(0.6, "s"))


def test_messages(file_regression):
    inner = Message("the film of {gap}", gap=Amount(2e-5, "m"))
    several = Message(
        "{parts:; } and {names}: {first:capital}, {second:small}, {n:.2f}",
        parts=["a", inner],
        names=("b", "c"),
        first="up",
        second="Down",
        n=np.float64(2.345),
    )
    about = Remark("shoe.heel", "length = {length}", length=Amount(0.06, "m"))
    here = [Message("{x} of {here}", x=x, here=h) for x, h in ((3, "a"), (9, "b"))]
    lines = (
        LINE,
        inner,
        several,
        about,
        Remark("", "whole {n}", n=1),
        Message.plain("a {b}"),
        remark.NOTHING,
    )
    answers = {
        "lines": [(str(one), one.subject, one.page_data(), one.__html__()) for one in lines],
        "stored": [remark.stored_form(one) for one in lines],
        "back": [
            remark.from_stored(json.loads(json.dumps(remark.stored_form(one)))) == one
            for one in lines
        ],
        "nested": remark.from_stored(
            json.loads(json.dumps(remark.stored_form({"a": [LINE, 1.5, [1.0, 2.0]], "b": None})))
        ),
        "joined": (remark.join_lines(["a", LINE, 3]), remark.together([LINE, "b"])),
        "kinds": [remark.kind_of(one) for one in (LINE, (LINE, 3), "text", 4)],
        "several": [
            remark.of_several(each)
            for each in (
                here,
                [LINE],
                [Message("{t}", t=x) for x in (0.5, 0.5)],
                [several, several],
                [inner, inner],
            )
        ],
        "assumed": (
            remark.assumption_line("{x} taken", x="it"),
            remark.is_assumed(remark.assumption_line("y")),
            remark.is_assumed(about),
            remark.is_assumed("Assumed: x"),
        ),
        "remarks": remark.remarks([about, "text", about, 5, LINE]),
        "subjects": remark.subjects([about, LINE, about]),
        "of": [Remark.of("film", LINE), Remark.of("film", about), Remark.of("film", "plain")],
        "old": [
            Remark.from_stored("a: b: c"),
            Remark.from_stored("no colon"),
            Remark.from_stored(remark.stored_form(about)),
        ],
        "what": about.what,
        "copied": pickle.loads(pickle.dumps([about, LINE])),
        "missing": refusal(Message, "{a} {b}", a=1),
        "breaches": [
            (b, str(b), b.remark.about)
            for b in breaches(
                "film",
                {
                    "gap": ValidityRange(1e-6, 1e-3, "m", "a paper"),
                    "n": ValidityRange(2.0, math.inf),
                    "x": ValidityRange(0, 1),
                    "y": ValidityRange(0, 1),
                    "z": ValidityRange(0, 1),
                },
                {"gap": [5e-7, 2e-3], "n": 1.5, "x": 1 + 2e-9, "y": 1 + 0.5e-9, "w": 7.0, "z": []},
            )
        ],
        "statuses": [(s.value, s.usable, s.remedy) for s in Status],
        "worst": [
            status.worst(*s) for s in ((), (Status.PREVIEW, Status.OUT_OF_RANGE), tuple(Status))
        ],
    }
    held(file_regression, answers)


@dataclass(frozen=True)
class _Shown(Presentable):
    name: str = "a sole"
    kind = "sole"

    def table(self):
        return Table(
            "Numbers", ("what", "value"), [("COF", 0.51234), (Part("from film"), None), ("n", 3)]
        )

    def headline(self):
        return ("It holds.", Message("COF {x}", x=0.5))

    def cautions(self):
        return ("Look again.",)

    def remarks(self):
        return {"Notes": ["one", LINE, "three", "four"], "Empty": []}


@dataclass(frozen=True)
class _Bare(Presentable):
    def table(self):
        return Table("", ("", ""), [("a", "b")])


def test_presentation(file_regression):
    shown, bare = _Shown(), _Bare()
    numbers = [
        SourcedValue(*v[:2], **v[2])
        for v in (
            (0.5, "1", {"uncertainty": 0.02}),
            (0.5, "1", {"interval": (0.1, 0.6)}),
            (0.5, "1", {"interval": (0.4, 0.6)}),
            (0.02, "m", {"uncertainty": 1e-3}),
            (None, "1", {"reason": "no film"}),
            (0.02, "m", {"interval": (0.02, 0.2)}),
            (0.9999, "1", {"uncertainty": 5e-4}),
            (0.3, "1", {"uncertainty": 0.1, "interval": (0.0, 0.7)}),
            (0.5, "1", {"interval": (0.5, 0.5)}),
        )
    ]
    sections = [
        PageSection("Stage", html="<b>x</b>", stage=True),
        PageSection("First", intro="in short", first=True),
        *table_sections(shown),
        *remark_sections(shown),
        PageSection(
            "Pictures",
            pictures=[Picture("a curve", "data:,x"), Picture("wide", "data:,y", True)],
            text="t",
        ),
    ]
    answers = {
        "table": (
            shown.table().cells(),
            shown.table().text(),
            shown.table().html(),
            shown.table().frame(),
        ),
        "shown": (
            shown.summary(),
            shown.heading(),
            shown.to_dict(),
            shown.usable,
            shown._repr_html_(),
            shown.data_tables(),
            shown.to_frame(),
        ),
        "bare": (bare.summary(), bare.heading(), bare.to_dict(), bare.remarks(), bare.headline()),
        "part": (Part("a <b>").label, Part("a <b>").__html__(), Part(LINE).__html__()),
        "percent": [
            presentation.percent(s)
            for s in (0.0, 5e-4, 1e-3, 0.0994, 0.0995, 0.5, 0.9949, 0.995, 0.9991, 1.0)
        ],
        "probability": [presentation.probability_text(s) for s in (0.0, 0.5, 1.0)],
        "drawn": [
            presentation.drawn_probability_text(s) for s in (0.0, 0.009, 0.01, 0.5, 0.99, 0.991)
        ],
        "p": [presentation.p_text(p) for p in (0.99e-4, 1e-4, 0.04999)],
        "values": [
            [presentation.value_text(n, v) for v in numbers] for n in ("cof", "slip_probability")
        ],
        "intervals": [
            [presentation.interval_text(n, v) for v in numbers] for n in ("cof", "slip_probability")
        ],
        "shows": [
            [presentation.shows_interval(n, v) for v in numbers]
            for n in ("cof", "slip_probability")
        ],
        "wide": [presentation.is_wide(i) for i in (None, (0.1, 0.6), (0.1, 0.61))],
        "texts": [str(v) for v in numbers],
        "scaled": [v.scale_value(2.0) for v in numbers[:6]],
        "dict": numbers[0].to_dict(),
        "numbers": [float(v) for v in numbers if v.value is not None],
        "not determined": refusal(float, numbers[4]),
        "negative": refusal(SourcedValue, 1.0, uncertainty=-1.0),
        "page": page(shown, sections, script="x = 1", verdict=("good", "It holds")),
        "without stage": page(shown, sections[2:]),
        "bare page": page(bare, []),
        "part of a page": page_part(sections[3:]),
    }
    held(file_regression, answers)
    picture = png(new_figure(2.0, 1.5), 40)
    assert picture[:4] == b"\x89PNG"
    assert int.from_bytes(picture[16:20]) == 80
    assert int.from_bytes(picture[20:24]) == 60
    assert int.from_bytes(png(new_figure(1.0, 1.0))[16:20]) == 130
    assert data_address(b"abc") == "data:image/png;base64,YWJj"


def test_checks_and_errors(file_regression):
    calls = {
        "positive": (checks.positive, ((1.0, "a"), (0.0, "a"), (-1.0, "a", "m"), (math.inf, "a"))),
        "not negative": (checks.not_negative, ((0.0, "a"), (-1e-9, "a", "N"), (math.nan, "a"))),
        "between": (
            checks.between,
            (
                (1.0, 1.0, 2.0, "a"),
                (2.0, 1.0, 2.0, "a"),
                (2.1, 1.0, 2.0, "a"),
                (0.9, 1.0, 2.0, "a", "1 to 2 m"),
            ),
        ),
        "arrays": (
            checks.positive_array,
            (([1, 2], "a"), ([0], "a"), ([], "a"), ([1, np.nan], "a")),
        ),
        "choice": (
            checks.choice,
            (("b", ("a", "b"), "x.kind_of"), ("c", ("a", "bc"), "x.kind_of")),
        ),
        "one": (
            checks.exactly_one,
            (
                ({"a": 1, "b": None}, "none", "x", "one"),
                ({"a": None}, "none of it", "x", "one"),
                ({"a": 1, "b": 2}, "none", "x", "one"),
            ),
        ),
        "poisson": (checks.poisson_ratio, ((0.5,), (0.0,), (0.51,), (-0.1,))),
        "host": (checks.host_array, (([1, 2], "a", "numbers"),)),
    }
    answers = {
        name: [tried(call, *given) for given in cases] for name, (call, cases) in calls.items()
    }
    answers["zero"] = [tried(checks.positive_array, v, "a", zero=True) for v in ([0, 1], [-1])]
    whole = errors.InputError(
        "x is wrong", where="a.b", allowed="1 to 2", nearest="y", remedy="Write y"
    )
    answers["error"] = (str(whole), whole.parts, whole.exit_code)
    answers["bare"] = [str(errors.UnderfootError(w)) for w in ("what", "what?", "what.")]
    answers["codes"] = {
        name: one.exit_code
        for name, one in sorted(vars(errors).items())
        if isinstance(one, type) and issubclass(one, errors.UnderfootError)
    }
    answers["near"] = [
        errors.nearest_match(w, ["heel", "whole_sole", "shoe"]) for w in ("heal", "HEEL", "zzz", "")
    ]
    answers["unknown"] = str(errors.unknown_name("thing", "sho", ["shoe", "heel"], where="a"))
    answers["extra"] = str(errors.MissingExtraError("torch", "accelerator", "rough contact"))
    answers["module"] = refusal(optional_module, "no_such_module_here.part", "cad", "Reading it")
    held(file_regression, answers)
    assert optional_module("json", "cad", "Reading").loads("1") == 1


class _Colour(Enum):
    RED = 1


class _Old:
    new = 5
    old = property(renamed_member("old", "new", gone="9.9"))

    def made(self, x):
        return x + 1

    before = renamed_member("before", "made", gone="9.9")


def test_hashes_and_names(file_regression):
    things = (
        1,
        1.0,
        True,
        "1",
        None,
        b"a",
        [1, 2],
        (1, 2),
        {"a": 1, "b": 2},
        {1: 2, "a": 3},
        {1, 2},
        np.arange(3),
        1 + 2j,
        np.arange(3.0),
        np.arange(3.0).reshape(1, 3),
        _Colour.RED,
        Path("a"),
        LINE,
        math.sqrt,
        Status,
        np.array([1, "a"], object),
        partial(int, "3"),
        [[1], 2],
        [1, [2]],
        {"a": {"b": 1}},
        frozenset({3}),
        json,
        bytearray(b"a"),
        [],
        (),
        {},
        set(),
    )
    hashes = [identity.content_hash(one) for one in things]
    assert len(set(hashes)) == len(hashes) - 2  # lists and tuples of the same are alike
    assert identity.content_hash({"b": 2, "a": 1}) == identity.content_hash({"a": 1, "b": 2})
    assert identity.content_hash(np.float64(1.0)) == identity.content_hash(1.0)
    assert identity.content_hash(1, 2) != identity.content_hash(2, 1)
    loop = []
    loop.append(loop)
    assert identity.content_hash(loop) == identity.content_hash(loop)
    assert all(len(one) == 64 for one in hashes)
    assert identity.package_version("no-such-package") == identity.UNKNOWN
    assert identity.attributes(_Bare()) == {}
    assert identity.attributes(_Shown("x")) == {"name": "x"}
    with pytest.warns(FutureWarning, match=r"_Old\.old is new now; the old name goes in 9\.9"):
        assert _Old().old == 5
    with pytest.warns(FutureWarning, match=r"_Old\.before is made now"):
        assert _Old().before(2) == 3
    get = package_names("underfoot.core", {"status": ".status"}, gone="9.9", positive_of="positive")
    answers = {
        "moved": [
            moved.new_home(n)
            for n in (
                "underfoot_app",
                "underfoot_block.g1.x",
                "underfoot.trials.gait",
                "underfoot.trials.study",
                "json",
                "underfoot_trial_analysis.report",
                "underfoot_readers.sole_mesh",
                "underfoot.report.html.x",
            )
        ],
        "homes": moved.HOMES,
        "unknown": refusal(get, "nothing"),
        "address": [
            tried(registry.load_address, a)
            for a in ("no_such_module:x", "json:nothing", "underfoot.core.status:nothing")
        ],
        "offers": [
            tried(registry.find_offer, "doors", "x"),
            registry.offers("nothing_of_this_kind"),
        ],
    }
    assert registry.load_address("json:loads") is json.loads
    assert registry.load_address("json") is json
    offer = registry.Offer("closures", "mine", "underfoot:data", "a package")
    answers["offer"] = (
        str(offer),
        offer.folder().name,
        refusal(replace(offer, address="underfoot:dat").folder),
        refusal(replace(offer, address="nomodule:x").load),
    )
    held(file_regression, answers)


def _stages(*steps):
    left = TimeLeft()
    return [left(stage, fraction, now) for stage, fraction, now in steps]


def test_progress(file_regression, capsys, monkeypatch):
    told = []

    def receive(stage, fraction, residual=None):
        told.append((stage, fraction, residual))

    part(receive, 0.2, 0.6)("a", 0.5, 1e-3)
    part(receive, 0.5, 1.0, "b")("a", 1.0)
    even = [("s", k / 10, float(k)) for k in range(11)]
    answers = {
        "parts": told,
        "refused": [refusal(part, receive, *ends) for ends in ((0.6, 0.2), (-0.1, 1), (0, 1.1))],
        "even": _stages(*even),
        "late": _stages(*[("s", f**3, now) for _, f, now in even]),
        "stages": _stages(*even[:6], *[("t", f, now + 5) for _, f, now in even[:6]]),
        "back": _stages(*even[:6], ("s", 0.1, 6.0), ("s", 0.3, 7.0), ("s", 0.6, 8.0)),
        "from half": _stages(
            ("s", 0.5, 0.0), ("s", 0.54, 1.0), ("s", 0.56, 2.0), ("s", 0.9, 8.0), ("s", 1.5, 9.0)
        ),
        "texts": [time_text(s) for s in (0.0, 89.4, 90.0, 5399.0, 5400.0, 9000.0)],
    }
    now = iter([0.0, 1.0, 2.5, 3.0, 8.0, 14.0])
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(now))
    with progress.bar("Work") as report:
        for fraction in (0.1, 0.25, 0.3, 0.8, 1.2):
            report("solving", fraction, 1e-3)
    answers["lines"] = capsys.readouterr().err
    held(file_regression, answers)


TOML = """[floor.mine]
title = "Vinyl"
source = "a paper"
roughness = "2 um"
note = "smooth"
[floor.mine.film]
gap = { value = "3 um", uncertainty = "0.5 um", verified = false, note = "read" }
speeds = ["0.1 m/s", "0.2 m/s"]
kind = "flat"
[floor.soaked]
from = "mine"
title = "Wet vinyl"
roughness = { value = "4 um", source = "another", erratum = "prints 5 um" }
assumed = true
"""


def test_catalogues(file_regression):
    Path("own").mkdir()
    Path("own/mine.toml").write_text(TOML)
    mine = Catalogue.load(["own"]).of(["floor"])
    vinyl, wet = mine.entry("floor", "mine"), mine.entry("floor", "soaked")
    answers = {
        "mine": vinyl,
        "soaked": wet,
        "described": mine.describe("soaked"),
        "value": [wet.sourced_value("roughness"), vinyl.sourced_value("film.gap", "m")],
        "numbers": vinyl.numbers("film.speeds"),
        "word": vinyl.text("film.kind"),
        "under": vinyl.under("film"),
        "names": [n for n in mine.names("floor") if n in ("mine", "soaked")],
        "content": mine.content()["floor.soaked"],
        "refused": [
            tried(call)
            for call in (
                lambda: vinyl.leaf("film.gaps"),
                lambda: vinyl.numbers("film.gap"),
                lambda: mine.names("floors"),
                lambda: mine.entry("floor", "mino"),
                lambda: mine.describe("mino"),
                lambda: vinyl.sourced_value("film.kind"),
                lambda: Catalogue.load(["nowhere"]),
                lambda: vinyl.values.update(a=1),
            )
        ],
        "files": {},
    }
    for name, (old, new) in {
        "kind": ("[floor.soaked]", "[flor.wet]"),
        "circle": ('from = "mine"', 'from = "soaked"'),
        "nowhere": ('from = "mine"', 'from = "mino"'),
        "mark": ("verified", "verifed"),
        "broken": ("= ", "- "),
        "no table": (TOML, 'floor = "x"'),
        "no entry": (TOML, "[floor]\nx = 1\n"),
        "clash": ("[floor.soaked]", "[fluid.canola_oil]"),
        "no source": ('source = "a paper"\n', ""),
        "no title": ('title = "Vinyl"\n', ""),
    }.items():
        Path("own/mine.toml").write_text(TOML.replace(old, new))
        answers["files"][name] = tried(
            lambda: Catalogue.load(["own"]).of(["floor"]).describe("mine")
        )
    Path("catalogue").mkdir()
    answers["folders"] = [str(p.name) for p in catalogue_folders(Path.cwd(), ["own", "own"])]
    answers["none"] = catalogue_folders()
    answers["leaves"] = leaves.leaves(
        {
            "a": 1,
            "note": "n",
            "b": {"source": "s", "c": {"value": [1, {"d": 2}]}, "assumed": True},
            "x": 5,
        },
        source="top",
        skip=["x"],
    )
    held(file_regression, answers)
    whole = catalogue()
    assert pickle.loads(pickle.dumps(whole)) is whole
    assert set(whole.table().columns) == {"kind", "name", "title"}
    assert len(repr(mine)) < 200


def test_files_and_fields(file_regression, monkeypatch):
    answers = {"refused": {}}
    with whole_folder(Path("out")) as staging:
        (staging / "a.txt").write_text("a")
    with whole_folder(Path("out"), overwrite=True) as staging:
        (staging / "b.txt").write_text("b")
    answers["out"] = sorted(path.name for path in Path("out").iterdir())
    with pytest.raises(ZeroDivisionError), whole_folder(Path("broken")) as staging:
        raise ZeroDivisionError
    assert not Path("broken").exists()
    with whole_file(Path("deep/c.txt")) as rest:
        rest.write_text("c")
    assert [path.name for path in Path("deep").iterdir()] == ["c.txt"]
    Path("strange").mkdir()
    for n in range(5):
        Path(f"strange/{n}").touch()
    for name, (path, options) in {
        "file": ("deep/c.txt", {}),
        "full": ("out", {}),
        "strange": ("strange", {"overwrite": True}),
        "below a file": ("deep/c.txt/x", {}),
    }.items():
        told = refusal(check_writable_folder, Path(path), **options)
        answers["refused"][name] = told.replace(str(Path.cwd()), "HERE")
    check_writable_folder(Path("out"), overwrite=True)
    answers["named"] = str(named_for(OSError(28, "No space left on device"), Path("a.txt")))
    assert checksum(Path("deep/c.txt")).startswith("2e7d2c03")
    Path("x.toml").write_text("a = 1.5\n")
    assert read_toml(Path("x.toml")) == {"a": 1.5}
    Path("marked.toml").write_text("a = 1.5", encoding="utf-8-sig")
    assert read_toml(Path("marked.toml")) == {"a": 1.5}
    with pytest.raises(InputError, match=r'no file marked\.tml. Did you mean "marked.toml"'):
        read_toml(Path("marked.tml"))
    Path("x.toml").write_text("a = \n")
    answers["toml"] = tried(read_toml, Path("x.toml")).partition(" (")[0]
    made = fields.labelled_fields(
        {
            "p": (("x", "y"), np.arange(6.0).reshape(2, 3), {"units": "Pa"}),
            "good": ("x", [True, False]),
        },
        {"x": ("x", [0.0, 1.0], {"units": "m"})},
    )
    more = made.assign({"q": ("y", [1, 2, 3])})
    answers["fields"] = (
        made,
        made.sizes,
        more.get("q"),
        more.get("none"),
        "q" in made,
        "x" in more,
        made["p"].size,
        made["p"].transpose("y", "x"),
        made["p"].ndim,
        made["x"].dtype.kind,
    )
    assert made["p"].transpose("x", "y") is made["p"]
    assert fields.from_xarray(made.to_xarray(title="t")).sizes == made.sizes
    made.to_netcdf(Path("a.nc"), title="t")
    import xarray

    with xarray.open_dataset("a.nc") as back:
        answers["netcdf"] = (back.load(), back.attrs, back["good"].dtype.kind, back["p"].attrs)
    cache = Cache("room", Path("kept"))
    assert cache.load("k") is None
    cache.store("k", {"a": np.arange(3), "b": 2.0})
    answers["cached"] = cache.load("k")
    (cache.folder / "k.npz").write_bytes(b"damaged")
    assert cache.load("k") is None
    assert not (cache.folder / "k.npz").exists()
    monkeypatch.setenv("UNDERFOOT_CACHE", "here")
    assert default_folder() == Path("here")
    held(file_regression, answers)


def test_systems_and_transforms(file_regression, monkeypatch):
    import scipy.sparse as sp

    n = 6
    dense = 4 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    matrix, right = sp.csr_matrix(dense), np.arange(float(n))
    answers = {}
    for name in ("superlu", None):
        for kind in ("general", "symmetric", "positive definite"):
            solver = factorization(matrix, name, kind=kind)
            np.testing.assert_allclose(solver.solve(right), np.linalg.solve(dense, right))
            solver.factorise(2 * matrix)
            np.testing.assert_allclose(solver.solve(right), np.linalg.solve(2 * dense, right))
        kept = np.array([1, 4])
        expected = np.linalg.inv(np.linalg.inv(dense)[np.ix_(kept, kept)])
        found = schur_complement(upper_triangle(matrix), kept, name, kind="positive definite")
        np.testing.assert_allclose(found, expected)
    answers["singular"] = refusal(
        factorization, sp.csr_matrix(np.zeros((2, 2)) * np.nan), "superlu", where="film"
    )
    answers["name"] = refusal(back_end, "mumps")
    monkeypatch.setenv("UNDERFOOT_SPARSE", "cholmod")
    answers["variable"] = refusal(back_end)
    monkeypatch.setenv("UNDERFOOT_FFT", "fftw")
    answers["fourier"] = [
        refusal(fourier.fourier_library),
        refusal(fourier.fourier_library, "cufft"),
    ]
    field = np.random.default_rng(1).normal(size=(2, 6, 8))
    for library in ("scipy", "mkl"):
        try:
            one = fourier.transform(field.shape, float, library=library)
        except errors.MissingExtraError:
            continue
        spectrum = one.forward(field)
        np.testing.assert_allclose(spectrum, np.fft.rfft2(field))
        np.testing.assert_allclose(one.backward(spectrum.copy()), field)
    with threads.threads_limited(1):
        assert threads.threads_in_use() == 1
    assert threads.namespace(field) is np
    assert threads.on_host(field) is field
    assert threads.converter(field)([1.0]).shape == (1,)
    monkeypatch.delenv("UNDERFOOT_SPARSE")
    monkeypatch.delenv("UNDERFOOT_FFT")
    made = provenance.Provenance.now("abc", grid=1e-3, closures={"film": "x"}, errata=("e",))
    assert made.to_dict()["closures"] == {"film": "x"}
    assert (len(made.result_hash), made.case_hash, made.threads > 0) == (32, "abc", True)
    assert set(made.versions) == {"underfoot", "numpy", "scipy", "python"}
    other = provenance.Provenance.now("abc", grid=2e-3, closures={})
    assert other.result_hash != made.result_hash
    held(file_regression, answers)
    assert values.SourcedValue(2.0).reason == "uncertainty not estimated"


def test_large_arrays_go_to_a_card_by_themselves(monkeypatch):
    """From 512 x 512 points on, where a card is there; told, always or never."""
    for there in ("A card", None):
        monkeypatch.setattr(device, "card", lambda there=there: there)
        assert device.on_card("auto", 512 * 512) == (there is not None)
        assert not device.on_card("auto", 512 * 512 - 1)
        assert not device.on_card("cpu", 10**9)
    monkeypatch.setattr(device, "card", lambda: "A card")
    assert device.on_card("cuda", 1)


def test_a_bar_on_a_terminal_shows_share_stage_and_residual(capsys, monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "90")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress.bar("Work") as report:
        report("first", 0.4)
        report("second", 1.7, 3e-4)
    drawn = capsys.readouterr().err
    assert "100 %" in drawn
    assert "second" in drawn
    assert "residual 3.0e-04" in drawn
