"""Forty spellings of ten quantities at every entry: right, asked or refused; none wrong in silence.

Entries: ``--set``, a case file, a field of the app and a box beside a slider (an English and a
German page), the study form, tables as CSV and XLSX, edits and readings of trials, goals.
"""

import csv

import openpyxl
import pytest
import typer

pytest.importorskip("nicegui")

from underfoot.app.inputs import Input, read_in_unit
from underfoot.app.pages.studies import typed_value
from underfoot.case import Case
from underfoot.case.tables import table_columns
from underfoot.case.template import template
from underfoot.cli.options import number, setting
from underfoot.core import DataError, InputError, to_si
from underfoot.core.catalogue import Catalogue
from underfoot.explore.goals import Condition, Goal, read_goal, read_requirement
from underfoot.questions.wear import limit_load
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study.conditions import conditions_of
from underfoot.trials.study.edit_table import edit_from
from underfoot.trials.study.readings import reading_results
from underfoot.trials.walking.events import EditError

QUANTITIES = {
    "contaminant.viscosity": ("cP", "Pa*s"),
    "motion.speed": ("mm/s", "m/s"),
    "motion.normal_force": ("N", "N"),
    "motion.shoe_angle": ("arcmin", "rad"),
    "motion.duration": ("ms", "s"),
    "shoe.tread.channel_width": ("um", "m"),
    "shoe.roughness.ra": ("nm", "m"),
    "shoe.wear.depth": ("um", "m"),
    "shoe.material.modulus": ("kPa", "Pa"),
    "shoe.material.density": ("kg/m^3", "kg/m^3"),
}
ASKED = None
"""An error in place of a value: what can be two numbers, or is none."""

# What is typed, {} for the unit: its value in that unit where the page or file has a decimal point,
# the same with a decimal comma; alone in a column of a table.
SPELLINGS = {
    "1234.5 {}": (1234.5, 1234.5, 1234.5),
    "1234,5 {}": (1234.5, 1234.5, 1234.5),
    "1234.5{}": (1234.5, 1234.5, 1234.5),
    "1,234.5 {}": (1234.5, 1234.5, 1234.5),
    "1.234,5 {}": (1234.5, 1234.5, 1234.5),
    "1 234,5 {}": (1234.5, 1234.5, 1234.5),
    "1\u2009234.5 {}": (1234.5, 1234.5, 1234.5),
    "1\u202f234,5\u202f{}": (1234.5, 1234.5, 1234.5),
    "1\u00a0234.5\u00a0{}": (1234.5, 1234.5, 1234.5),
    "1\u3000234.5 {}": (1234.5, 1234.5, 1234.5),
    "1'234.5 {}": (1234.5, 1234.5, 1234.5),
    "1\u2019234,5 {}": (1234.5, 1234.5, 1234.5),
    "1,234 {}": (ASKED, 1.234, ASKED),
    "1.234 {}": (1.234, ASKED, 1.234),
    "12,345 {}": (ASKED, 12.345, ASKED),
    "1234,567 {}": (1234.567, 1234.567, 1234.567),
    "  1200 {}  ": (1200.0, 1200.0, 1200.0),
    "\ufeff1200\u200b {}": (1200.0, 1200.0, 1200.0),
    "+1200 {}": (1200.0, 1200.0, 1200.0),
    "1.2e3 {}": (1200.0, 1200.0, 1200.0),
    "1,2E+3 {}": (1200.0, 1200.0, 1200.0),
    "1200. {}": (1200.0, 1200.0, 1200.0),
    "1200 1/2 {}": (1200.5, 1200.5, ASKED),
    "1200\u00bd {}": (1200.5, 1200.5, ASKED),
    "2401/2 {}": (1200.5, 1200.5, ASKED),
    "-1200 {}": (-1200.0, -1200.0, -1200.0),
    "\u22121200 {}": (-1200.0, -1200.0, -1200.0),
    "\u2013 1200 {}": (-1200.0, -1200.0, ASKED),
    "1200": (1200.0, 1200.0, 1200.0),  # a field and a heading have a unit; files don't
    "1200 1300 {}": (ASKED, ASKED, ASKED),
    "1200 {0} 1300 {0}": (ASKED, ASKED, ASKED),
    "1200; 1300 {}": (ASKED, ASKED, ASKED),
    "1200 to 1300 {}": (ASKED, ASKED, ASKED),
    "0 500 {}": (ASKED, ASKED, ASKED),
    "12 34 {}": (ASKED, ASKED, ASKED),
    "1.2.3 {}": (ASKED, ASKED, ASKED),
    "1e400 {}": (ASKED, ASKED, ASKED),
    "1e-400 {}": (ASKED, ASKED, ASKED),
    "NaN {}": (ASKED, ASKED, ASKED),
    "abc": (ASKED, ASKED, ASKED),
    "": (ASKED, ASKED, ASKED),
    "1200 mol": (ASKED, ASKED, ASKED),
    "(1200) {}": (ASKED, ASKED, ASKED),
}
BASE = Case.from_text(
    template(
        shoe="work_shoe_half_tread", floor="vinyl_g4", contaminant="glycerol_90pct",
        motion="slip_tester_g4", catalogue=Catalogue.load(), name="spelled",
    )
)  # fmt: skip


def read_or_asked(read):
    """Return what is read, None where it is asked or refused."""
    try:
        return read()
    except InputError:
        return ASKED


def by_set(path, text, unit, si, comma):
    _, value = setting(f"{path}={text}")
    return to_si(value, si, where=path)


def in_a_file(path, text, unit, si, comma):
    return BASE.replace({path: text}).value(path)


def in_a_field(path, text, unit, si, comma):
    written = Input(path, unit).read_typed(text, "si", comma=comma)
    return to_si(written, si, where=path)


def in_a_box(path, text, unit, si, comma):
    return read_in_unit(text, unit, comma=comma) * to_si(f"1 {unit}", si, where="")


def in_a_study(path, text, unit, si, comma):
    return to_si(typed_value(text, path, comma=comma), si, where="")


def test_there_are_forty_spellings_of_ten_quantities():
    assert len(SPELLINGS) >= 40
    assert len(QUANTITIES) >= 10


@pytest.mark.parametrize("path", QUANTITIES)
@pytest.mark.parametrize("entry", [by_set, in_a_file, in_a_field, in_a_box, in_a_study])
def test_what_is_typed_is_read_right_or_asked(entry, path):
    unit, si = QUANTITIES[path]
    of_one = to_si(f"1 {unit}", si, where="")
    pages = (False, True) if entry in (in_a_field, in_a_box, in_a_study) else (False,)
    with_unit = entry in (in_a_field, in_a_box)
    for spelling, values in SPELLINGS.items():
        text = spelling.format(unit)
        for comma in pages:
            wanted = values[comma] if with_unit or "{" in spelling else ASKED
            if entry is in_a_file and wanted is not None and outside(path, wanted * of_one):
                wanted = ASKED
            seen = read_or_asked(lambda text=text, c=comma: entry(path, text, unit, si, c))
            told = f"{text!r} of {path}, {'comma' if comma else 'point'}: {seen}"
            if wanted is None:
                assert seen is None, told
            else:
                assert seen == pytest.approx(wanted * of_one, rel=1e-12), told


def outside(path, value):
    """Return whether a case refuses a value in SI."""
    return read_or_asked(lambda: BASE.replace({path: value})) is None


def as_csv(folder, rows, separator):
    path = folder / "table.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, delimiter=separator).writerows(rows)
    return path


def as_workbook(folder, rows, _):
    book = openpyxl.Workbook(write_only=True)
    sheet = book.create_sheet()
    for row in rows:
        sheet.append(row)
    book.save(folder / "table.xlsx")
    return folder / "table.xlsx"


@pytest.mark.parametrize(
    ("write", "separator"), [(as_csv, ","), (as_csv, ";"), (as_csv, "\t"), (as_workbook, "")]
)
def test_what_stands_in_a_table_is_read_right_or_asked(tmp_path, write, separator):
    columns = {"speed": ("m/s", ("speed",)), "step": ("1", ("step",))}
    for spelling, (*_, wanted) in SPELLINGS.items():
        cell = spelling.format("").rstrip(" \u00a0\u202f")
        rows = [["speed (mm/s)", "step"], *([cell, str(n)] for n in (1, 2, 3))]
        path = write(tmp_path, rows, separator)
        seen = read_or_asked(
            lambda path=path: table_columns(path, columns, "table", needed=("speed", "step"))
        )
        speeds = None if seen is None else seen["speed"].tolist()
        if wanted is None:
            assert speeds is None, f"{cell!r}: {speeds}"
        else:
            assert speeds == pytest.approx([wanted * 1e-3] * 3, rel=1e-12), f"{cell!r}: {speeds}"


NOTED = (
    (["0,5", "0,6"], [0.5, 0.6]),
    (["1.234,5", "2.000"], [1234.5, 2000.0]),
    (["1 234", "\u2212998"], [1234.0, -998.0]),
    (["1,234", "998"], [1234.0, 998.0]),
    (["1,234", "2,345"], ASKED),
    (["0,5", "0.6"], ASKED),
    (["1e400", "1"], ASKED),
    (["41 cP", "42 cP"], ASKED),
    (["1 2", "1"], ASKED),
    (["1e-400", "1"], ASKED),
)


@pytest.mark.parametrize(("cells", "wanted"), NOTED, ids=lambda value: str(value))
def test_what_is_noted_of_trials_is_read_right_or_asked(tmp_path, cells, wanted):
    rows = [["file", "viscosity (cP)"], *([f"{n}.csv", cell] for n, cell in enumerate(cells))]
    path = as_csv(tmp_path, rows, ";")
    seen = read_or_asked(lambda: conditions_of(tmp_path, path))
    values = seen and [1e3 * each["viscosity"] for each in seen.values()]
    assert values == (wanted and pytest.approx(wanted))


def test_a_column_of_dates_marks_no_thousands(tmp_path):
    """Two points in "01.02.2024" say nothing about that of "1.234"."""
    rows = [["file", "date", "viscosity (cP)"], ["a.csv", "01.02.2024", "1.234"]]
    noted = conditions_of(tmp_path, as_csv(tmp_path, rows, ";"))
    assert noted["a.csv"] == {"date": "2024-02-01", "viscosity": pytest.approx(1.234e-3)}


EDITS = {
    "3.06 s": 3.06, "3,06 s": 3.06, "3060 ms": 3.06, "1 234,5 ms": 1.2345, "0,512 s": 0.512,
    "1,234 s": ASKED, "12,345 s": ASKED, "3.06": ASKED, "1e400 s": ASKED, "1e-400 s": ASKED,
    "3 m": ASKED, "NaN s": ASKED,
}  # fmt: skip


def test_a_time_of_an_edit_is_read_right_or_asked():
    """As its value, in a column with a unit, and as the time that names a step."""
    for text, wanted in EDITS.items():
        bare = text.removesuffix(" s")
        ways = {
            "value": lambda text=text: edit_from("1", "contact", text, "seen", "").value,
            "step": lambda text=text: edit_from(text, "exclude", "", "seen", "").step,
        }
        if bare != text:
            ways["heading"] = lambda bare=bare: (
                edit_from("1", "contact", bare, "seen", "", "s").value
            )
        for way, read in ways.items():
            seen = read_or_asked(read)
            assert seen == (wanted and pytest.approx(wanted)), (way, text, seen)
    with pytest.raises(EditError, match=r"can be 1\.234 or 1234"):
        edit_from("1", "contact", "1,234 s", "seen", "")


READ = (
    (["0,35", "0,41", "0,38"], [0.35, 0.41, 0.38]),
    (["0.35", "0.41", "0.38"], [0.35, 0.41, 0.38]),
    (["1,012", "0,985", "0,9"], [1.012, 0.985, 0.9]),
    (["1,012", "1,985", "1,901"], ASKED),
    (["0,35", "0.41", "0.38"], ASKED),
    (["0.35", "1e-400", "0.38"], ASKED),
)


@pytest.mark.parametrize(("cells", "wanted"), READ, ids=lambda value: str(value))
def test_a_table_of_readings_is_read_right_or_asked(tmp_path, cells, wanted):
    path = as_csv(tmp_path, [["surface", "COF"], *(["tile", cell] for cell in cells)], ";")
    given = protocol("en_16165_tribometer")
    try:
        (sample,) = reading_results("table", path, "", {}, given)
    except DataError:
        assert wanted is None
        return
    assert list(sample.sample.readings) == (wanted and pytest.approx(wanted))


BOUNDS = {
    "0.16": 0.16, "0,16": 0.16, "16 %": 0.16, "4/25": 0.16, "1,234": ASKED, "1e-400": ASKED,
    "NaN": ASKED, "0.1.6": ASKED, "0.16 mm": ASKED,
}  # fmt: skip


def test_numbers_of_goals_are_read_right_or_asked():
    states = (Condition((), {}),)

    def statistic(text):
        goal = read_goal(text, {"cof": "1"}, states)
        assert isinstance(goal, Goal)
        return goal

    for text, wanted in BOUNDS.items():
        asked = (
            lambda text=text: read_requirement(f"cof > {text}", {"cof": "1"}, states).bound,
            lambda text=text: statistic(f"quantile(cof, {text})").share,
        )
        for read in asked:
            assert read_or_asked(read) == (wanted and pytest.approx(wanted)), text


@pytest.mark.parametrize("number", ["1e-400", "1e400", "nan"])
def test_a_bare_number_of_a_file_is_held_or_refused(number):
    """Of a quantity without a unit, whose number stands in TOML without quotes."""
    path = "risk.rcof_mean"
    text = BASE.to_toml().replace("# rcof_mean = 0.20", "rcof_mean = {}")
    ways = (
        lambda: BASE.replace(dict([setting(f"{path}={number}")])),
        lambda: Case.from_text(text.format(number)),
    )
    assert Case.from_text(text.format("0.21")).value(path) == 0.21
    for read in ways:
        assert read_or_asked(read) is None


LIMITS = {
    "5 N": 5.0, "5,5 N": 5.5, "20,5 %": 102.5, "1 1/2 N": 1.5, "1,234 %": ASKED, "NaN %": ASKED,
    "1e400 %": ASKED, "-5 %": ASKED, "5": ASKED, "5 kg": ASKED, "": ASKED,
}  # fmt: skip


def test_a_limit_of_wear_is_read_right_or_asked():
    for text, wanted in LIMITS.items():
        seen = read_or_asked(lambda text=text: limit_load(text, 500.0))
        assert seen == (wanted and pytest.approx(wanted)), text


@pytest.mark.parametrize("text", ["NaN", "1e400", "inf", "1,234", "0.4 0.5", "0.5 mm", ""])
def test_a_number_of_the_command_line_is_one_finite_number(text):
    assert number("0,45") == number("45 %") == number("9/20") == 0.45
    with pytest.raises(typer.BadParameter):
        number(text)


HARDNESSES = {
    "62": 62.0, "62.5": 62.5, "62,5": 62.5, "62,5 A": 62.5, "Shore A 62,5": 62.5,
    "62 Shore-A": 62.0, "62°": 62.0, "62 1/2": 62.5, "Shore D 40,5": 90.5, "-62": ASKED,
    "Shore A -62": ASKED, "−62": ASKED, "62 63": ASKED, "1,234": ASKED, "62 mm": ASKED,
    "NaN": ASKED, "": ASKED, "1e400": ASKED,
}  # fmt: skip


def test_hardnesses_are_read_right_or_asked():
    """A number without a unit, and with the scale of its durometer."""
    path = "shoe.material.shore_a"
    for text, wanted in HARDNESSES.items():
        ways = {
            "--set": lambda text=text: setting(f"{path}={text}")[1],
            "file": lambda text=text: text,
        }
        for way, given in ways.items():
            seen = read_or_asked(lambda given=given: BASE.replace({path: given()}).value(path))
            assert seen == (wanted if wanted is None else pytest.approx(wanted)), (way, text, seen)
