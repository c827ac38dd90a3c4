"""One shoe has one COF: what the app computes of a variant and the command of a case is the same.

Files, shoes of the catalogue and changed values, each made once as pages make it (project, fields)
and once as a person types it at the command line.
"""

import json
import shutil
from functools import cache
from pathlib import Path

import pytest

from commands import called

pytest.importorskip("nicegui")

from underfoot.app import work, work_sole
from underfoot.app.pages.design import CONDITIONS, LAYERS, MIDSOLE, TREAD
from underfoot.app.project import Project
from underfoot.app.variant_bar import USUAL
from underfoot.case.template import template
from underfoot.core.catalogue import Catalogue

pytestmark = pytest.mark.slow
SOLES = Path(__file__).parents[1] / "data" / "soles"
COARSE = {
    "numerics.grid_spacing": "2 mm",
    "numerics.quick_grid_spacing": "2 mm",
    "numerics.tread_positions": 1,
}
INPUTS = {each.path: each for each in (*TREAD, *LAYERS, *sum(CONDITIONS.values(), ()))}
MADE = ("b_heel_bars.3mf", "f1_angle20.stl")
WIDE = {"shoe.tread.channel_width": "5 mm"}  # two cells and more
TYPED = (
    {"shoe.tread.channel_width": "4,7"},
    {"shoe.tread.lug_width": "5/16 in"},
    {"shoe.tread.depth": "0.1234567 in", "shoe.tread.angle": "12.5 deg"},
    {"shoe.heel.profile.angle": "9", "shoe.heel.profile.length": "17.3 mm"},
    {"shoe.material.shore_a": "57,5"},
    {"shoe.wear.depth": "1.1 mm"},
    {"shoe.sole.outsole_thickness": "19.7"},
    {"contaminant.viscosity": "41,5"},
    {"motion.speed": "0,7", "motion.normal_force": "83 lbf"},
    {"floor.roughness.rq": "2.35 um"},
)


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    return Project(tmp_path_factory.mktemp("same") / "project")


def new(project, name, **entries):
    """Write a variant as *New* of the app does, on a coarse grid."""
    project.add(name, template(**USUAL | entries, catalogue=Catalogue.load(), name=name))
    project.change(name, COARSE | WIDE)


def typed_in(project, name, values):
    """Give a variant what a person types in its fields."""
    for path, text in values.items():
        each = INPUTS[path]
        project.change(name, {path: each.read(text, "si", comma="," in text)})


def of_the_app(project, name):
    folder = project.result_folder(name)
    work.computed(str(project.path(name)), str(folder), progress=lambda *_: None)
    return json.loads((folder / "result.json").read_text(encoding="utf-8"))


def of_the_command(case, folder, **changes):
    words = [
        word
        for path, value in {**COARSE, **changes}.items()
        for word in ("--set", f"{path}={value}")
    ]
    done = called("run", case, *words, "--json", "--no-advice", folder=folder)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def assert_same(app, command):
    for number in ("cof", "fluid_load", "contact_area", "slip_probability"):
        assert app.get(number) == command.get(number), number


@pytest.mark.parametrize("entry", ["athletic_shoe_untreaded", "work_shoe_half_tread"])
def test_a_shoe_of_the_catalogue(project, tmp_path, entry):
    new(project, entry)
    wide = WIDE if entry == "work_shoe_half_tread" else {}
    project.change(entry, {"shoe": entry, **wide})
    assert called("new", "case.toml", "--shoe", entry, folder=tmp_path).returncode == 0
    assert_same(of_the_app(project, entry), of_the_command("case.toml", tmp_path, **wide))


@pytest.mark.parametrize("values", TYPED, ids=lambda values: " ".join(values))
def test_a_value_that_is_typed(project, tmp_path, values):
    name = project.free_name(" ".join(values))
    new(project, name)
    typed_in(project, name, values)
    written = {
        path: text.replace(",", ".") if any(c.isalpha() for c in text) else
        f"{text.replace(',', '.')} {INPUTS[path].unit}".strip()
        for path, text in values.items()
    }  # fmt: skip
    shoe = USUAL["shoe"]
    assert called("new", "case.toml", "--shoe", shoe, folder=tmp_path).returncode == 0
    assert_same(of_the_app(project, name), of_the_command("case.toml", tmp_path, **WIDE | written))


def from_file(project, name, file, settings=None):
    """Give a new variant a file as *Use this sole* does; return the path in the project."""
    new(project, name)
    path = project.inside("soles", file)
    shutil.copy(SOLES / file, path)
    variants = str(project.inside("variants"))
    read = work_sole.inspected_sole(str(path), settings or {}, variants, progress=lambda *_: None)
    project.take_sole(name, read["shoe"])


@pytest.fixture(scope="module")
def inspected(tmp_path_factory):
    """Return what inspects a file at the command line and returns the case that it writes."""

    @cache
    def case_of(file, *words):
        folder = tmp_path_factory.mktemp("inspected")
        shutil.copy(SOLES / file, folder)
        done = called("outsole", "inspect", file, "--out", "out", *words, folder=folder)
        assert done.returncode == 0, done.stderr
        return folder / "out" / "case.toml"

    return case_of


@pytest.mark.parametrize("file", MADE)
def test_a_sole_from_a_file(project, inspected, tmp_path, file):
    name = Path(file).stem
    from_file(project, name, file)
    assert_same(of_the_app(project, name), of_the_command(inspected(file), tmp_path))


CHANGED = {
    "region": ({"region": "heel"}, ("--region", "heel"), {}),
    "thickness": ({}, (), {"shoe.sole.outsole_thickness": "12.3 mm"}),
    "midsole": ({}, (), {"shoe.sole.midsole.modulus": "0.7 MPa",
                         "shoe.sole.midsole.thickness": "22 mm"}),
    "wear": ({}, (), {"shoe.wear.depth": "0.5 mm"}),
}  # fmt: skip


@pytest.mark.parametrize("kind", CHANGED)
def test_a_sole_from_a_file_with_a_value_of_ones_own(project, inspected, tmp_path, kind):
    settings, words, values = CHANGED[kind]
    from_file(project, kind, MADE[0], settings)
    typed_in(project, kind, values)
    case = inspected(MADE[0], *words)
    assert_same(of_the_app(project, kind), of_the_command(case, tmp_path, **values))


def test_what_a_person_set_stays_when_a_file_is_used(project, inspected, tmp_path):
    own = {
        "shoe.material.shore_a": "57.5",
        "shoe.roughness.rq": "9.3 um",
        "shoe.wear.depth": "1.1 mm",
    }
    new(project, "before")
    typed_in(project, "before", {path: own[path] for path in own})
    path = project.inside("soles", MADE[0])
    shutil.copy(SOLES / MADE[0], path)
    variants = str(project.inside("variants"))
    read = work_sole.inspected_sole(str(path), {}, variants, progress=lambda *_: None)
    project.take_sole("before", read["shoe"])
    case = inspected(MADE[0])
    assert_same(of_the_app(project, "before"), of_the_command(case, tmp_path, **own))


def test_a_midsole_that_is_added(project, tmp_path):
    new(project, "foam")
    project.change("foam", MIDSOLE)
    shoe = USUAL["shoe"]
    assert called("new", "case.toml", "--shoe", shoe, folder=tmp_path).returncode == 0
    foam = {
        f"shoe.sole.midsole.{key}": value for key, value in MIDSOLE["shoe.sole.midsole"].items()
    }
    assert_same(of_the_app(project, "foam"), of_the_command("case.toml", tmp_path, **WIDE | foam))
