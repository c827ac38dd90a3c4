"""A result's name is what was computed: other content or code, another hash; the same, the same."""

import copy
import functools
import importlib
import os
import pickle
import shutil
import sys
import textwrap
import threading
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from commands import called
from underfoot.case import Case
from underfoot.case.section import Option
from underfoot.compute.prepare import case_and_objects, case_hash
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.core import Cache, InputError, content_hash
from underfoot.core.catalogue import Catalogue
from underfoot.explore import sweep
from underfoot.friction import ConstantLaw, packaged_pair_draws
from underfoot.rough_contact import ExponentialLaw

PARTS = {
    "shoe": "work_shoe_half_tread",
    "floor": "vinyl_g4",
    "contaminant": "glycerol_90pct",
    "motion": "slip_tester_g4",
    "sensor": "slip_tester_g4",
}
SMOOTH = {
    **PARTS,
    "shoe": "work_shoe_untreaded",
    "numerics": {
        "grid_spacing": "2 mm",
        "quick_grid_spacing": "3 mm",
        "cells_along": 1,
        "tread_positions": 1,
    },
}
CHANGES = {
    "shoe.material.shore_a": 61.0,
    "shoe.material.modulus": 4e6,
    "shoe.material.poisson_ratio": 0.48,
    "shoe.material.polymer": "NBR",
    "shoe.roughness.ra": 5e-6,
    "shoe.heel.length": 0.074,
    "shoe.heel.width": 0.071,
    "shoe.heel.edge_radius": 3e-3,
    "shoe.heel.profile.angle": 0.1,
    "shoe.tread.depth": 1.3e-3,
    "shoe.wear.edge_radius": 2e-4,
    "shoe.sole.outsole_thickness": 0.02,
    "shoe.sole.midsole": {"modulus": 1e6, "thickness": 0.01},
    "floor.roughness.rq": 6e-7,
    "floor.shore_a": 90.0,
    "contaminant.viscosity": 0.2,
    "contaminant.pool_depth": 5e-4,
    "contaminant.family": "oil",
    "motion.speed": 0.6,
    "motion.normal_force": 450.0,
    "motion.shoe_angle": 0.15,
    "motion.duration": 0.1,
    "motion.start_film": 6e-5,
    "motion.backward": True,
    "interface.roughness_beyond_cutoff": 1.5,
    "hardness": "ruess",
    "rough_contact": "contact_table",
    "film.suction": 6e4,
    "film.lug_edges": False,
    "film": "none",
    "compliance": "half_space",
    "friction": {"model": "constant", "cof": 0.3},
    "numerics.grid_spacing": 7e-4,
    "numerics.seed": 3,
    "numerics.tolerance": 1e-5,
    "numerics.grid_check": True,
    "numerics.tread_positions": 5,
    "sensor.inlet_diameter": 8e-3,
    "sensor.scans": 5,
    "risk.rcof_mean": 0.22,
    "risk.rcof_sd": 0.04,
    "risk": {"model": "beschorner_2016"},
    "slip.mass_mean": 72.0,
    "slip.subjects": 41,
    "contaminant": "none",
}
LAW = """
    from typing import ClassVar
    from underfoot.case.friction import FrictionOption
    from underfoot.friction import ConstantLaw
    {top}

    class Sticky(FrictionOption):
        name: ClassVar[str] = "sticky"
        source: ClassVar[str] = "made up"

        def build(self, context):
            from {helper} import level
            return ConstantLaw(level(), 0.0, self.source, context.viscosity_value)
"""


@pytest.fixture(autouse=True)
def options_of_the_package_afterwards():
    """Options that a test defines are gone after it."""
    known = {slot: dict(options) for slot, options in Option._known.items()}
    yield
    Option._known.clear()
    Option._known.update(known)


@pytest.fixture(scope="module")
def case():
    return Case(**PARTS)


@pytest.fixture(scope="module")
def smooth():
    return Case(**SMOOTH)


def test_each_input_of_a_case_changes_its_hash_and_back(case):
    changed = {path: case.replace(path, value) for path, value in CHANGES.items()}
    assert len(changed) >= 40
    hashes = {case.hash, *(each.hash for each in changed.values())}
    assert len(hashes) == 1 + len(CHANGES)
    for path, each in changed.items():
        assert each != case, path
        assert Case.from_text(each.to_toml(complete=True)).hash == each.hash, path
        assert pickle.loads(pickle.dumps(each)).hash == each.hash, path


def test_an_uncertainty_counts_and_a_name_does_not(case):
    given = {"value": "219 cP", "uncertainty": "5 cP"}
    assert case.replace("contaminant.viscosity", given) != case
    assert case.replace("name", "another") == case


@pytest.mark.slow
def test_a_result_has_the_hash_of_its_case_and_one_of_its_own(smooth):
    first, again, fine = run(smooth, quick=True), run(smooth, quick=True), run(smooth)
    assert {each.provenance.case_hash for each in (first, again, fine)} == {smooth.hash}
    assert first.provenance.result_hash == again.provenance.result_hash
    assert fine.provenance.result_hash != first.provenance.result_hash  # another grid
    assert first.provenance.threads >= 1
    assert first.provenance.objects == {}


@pytest.mark.slow
def test_threads_do_not_count(smooth, monkeypatch):
    first = run(smooth, quick=True)
    monkeypatch.setattr("underfoot.core.provenance.threads_in_use", lambda: 7)
    second = run(smooth, quick=True)
    assert second.provenance.threads == 7
    assert second.provenance.result_hash == first.provenance.result_hash


@pytest.mark.slow
def test_another_program_has_another_name_and_finds_no_old_entries(smooth, monkeypatch, tmp_path):
    first = run(smooth, quick=True).provenance
    Cache("room", tmp_path).store("key", {"x": np.ones(2)})
    assert Cache("room", tmp_path).load("key") is not None
    monkeypatch.setattr("underfoot.core.provenance.program_hash", lambda: "another")
    monkeypatch.setattr("underfoot.core.cache.program_hash", lambda: "another")
    later = run(smooth, quick=True).provenance
    assert later.case_hash == first.case_hash
    assert later.result_hash != first.result_hash
    assert Cache("room", tmp_path).load("key") is None


def test_old_entries_of_the_cache_go_in_time(monkeypatch, tmp_path):
    Cache("room", tmp_path).store("key", {"x": np.ones(2)})
    (old,) = (tmp_path / "room").iterdir()
    monkeypatch.setattr("underfoot.core.cache.program_hash", lambda: "second")
    Cache("room", tmp_path).store("key", {"x": np.ones(2)})
    assert old.is_dir()
    os.utime(old, (0, 0))
    monkeypatch.setattr("underfoot.core.cache.program_hash", lambda: "third")
    Cache("room", tmp_path).store("key", {"x": np.ones(2)})
    assert not old.exists()
    assert Cache("room", tmp_path).load("key") is not None


def test_a_grid_check_is_saved_under_the_hash_of_its_case(smooth, tmp_path):
    checked = smooth.replace("numerics.grid_check", True)
    file = tmp_path / "case.toml"
    checked.save(file)
    done = called("run", file, "--no-advice", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    result = Result.load(tmp_path / "out")
    assert result.provenance.case_hash == Case.load(file).hash
    assert result.provenance.objects == {}
    assert result.labels["grid_error"].startswith("grid:")


# objects that are given to run


@dataclass(frozen=True)
class Scaled:
    """An object with a field, and more held beside its fields."""

    factor: float


def law(cof, cls=ConstantLaw):
    return cls(cof, 0.0, "own", 0.219)


def hashes_of(*items):
    return [content_hash(item) for item in items]


def made(factor):
    class Closed:
        def __call__(self, pressure):
            return factor * pressure

    return Closed()


def with_more(factor, more):
    class Held(Scaled):
        pass

    item = Held(factor)
    object.__setattr__(item, "more", more)
    return item


class Slotted:
    __slots__ = ("table",)

    def __init__(self, table):
        self.table = table


@pytest.mark.parametrize(
    ("first", "same", "other"),
    [
        (Scaled(0.3), Scaled(0.3), Scaled(0.3004)),
        (law(0.3), law(0.3), law(0.3004)),
        (
            ExponentialLaw(2e6, 0.49, 3e-6),
            ExponentialLaw(2e6, 0.49, 3e-6),
            ExponentialLaw(9e6, 0.49, 3e-6),
        ),
        (np.arange(3.0), np.arange(3.0), np.arange(3)),
        (np.array([1.0, np.nan]), np.array([1.0, np.nan]), np.array([np.nan, 1.0])),
        (Slotted([1, 2]), Slotted([1, 2]), Slotted([2, 1])),
        ({1: 2.0}, {1: 2.0}, {"1": 2.0}),
        ({"a", "b"}, {"b", "a"}, {"a", "c"}),
        (functools.partial(max, 1), functools.partial(max, 1), functools.partial(max, 2)),
        (made(1.0), made(1.0), made(2.0)),
        (with_more(1.0, 1), with_more(1.0, 1), with_more(1.0, 2)),
        (np.random.default_rng(1), np.random.default_rng(1), np.random.default_rng(2)),
        (lambda p: 2 * p, lambda p: 2 * p, lambda p: 3 * p),
        (b"ab", b"ab", b"ac"),
        (Path("a"), Path("a"), "a"),
        ((1, 2), [1, 2], (2, 1)),
    ],
    ids=lambda each: type(each).__name__,
)
def test_objects_count_by_their_content(first, same, other):
    one, again, another = hashes_of(first, same, other)
    assert one == again or "lambda" in getattr(first, "__name__", "")
    assert one != another


def test_what_cannot_be_read_is_equal_to_itself_alone():
    first, second = threading.Lock(), threading.Lock()
    assert content_hash(first) == content_hash(first)
    assert content_hash(first) != content_hash(second)


def test_a_thing_that_holds_itself_has_a_hash():
    ring = [1]
    ring.append(ring)
    other = [2]
    other.append(other)
    assert content_hash(ring) != content_hash(other)


def test_what_is_computed_when_asked_for_does_not_count():
    class Lazy:
        def __init__(self):
            self.x = 2

        @functools.cached_property
        def square(self):
            return self.x**2

    item = Lazy()
    before = content_hash(item)
    assert item.square == 4
    assert content_hash(item) == before


def test_objects_of_run_are_in_the_hash(smooth):
    laws = [ExponentialLaw(e, 0.49, rq) for e, rq in ((2e6, 3e-6), (9e6, 20e-6), (2e6, 3e-6))]
    results = [run(smooth, quick=True, rough_contact=law) for law in laws]
    hashes = [each.provenance.case_hash for each in results]
    assert hashes[0] == hashes[2] != hashes[1]
    assert smooth.hash not in hashes
    assert results[0].value("cof") == results[2].value("cof") != results[1].value("cof")
    assert "ExponentialLaw" in results[0].provenance.objects["rough_contact"]


def test_an_object_with_nan_or_a_member_missing_is_refused(smooth):
    class Table(ConstantLaw):
        pass

    own = law(0.3, Table)
    object.__setattr__(own, "table", np.array([1.0, np.nan]))
    with pytest.raises(InputError, match=r"Table\.table holds nan at \[1\]"):
        run(smooth, quick=True, friction=own)
    with pytest.raises(InputError, match="Scaled is no Compliance: it has no apply, self_compl"):
        run(smooth, quick=True, compliance=Scaled(1.0))
    with pytest.raises(InputError, match=r"it has no .*population"):
        run(smooth, quick=True, risk=Scaled(1.0))


# files


def test_a_draws_file_counts_by_content_and_must_not_change(smooth, tmp_path):
    file = tmp_path / "draws.csv"
    packaged_pair_draws().write(file)
    pair = smooth.replace("friction", {"model": "pair", "draws_file": str(file)})
    moved = tmp_path / "elsewhere" / "draws.csv"
    moved.parent.mkdir()
    shutil.copy(file, moved)
    assert pair.replace("friction.draws_file", str(moved)).hash == pair.hash
    result = run(pair, quick=True)
    assert result.provenance.case_hash == pair.hash
    file.write_text(file.read_text().replace("0.", "0.1", 40))
    with pytest.raises(InputError, match="has changed since the case was made"):
        run(pair, quick=True)
    assert pair.replace("friction.draws_file", str(file)).hash != pair.hash


CATALOGUE = (
    '[fluid.soap]\ntitle = "Soap"\nsource = "own"\nviscosity = "{} cP"\nfamily = "aqueous"\n'
)


def test_a_catalogue_edited_with_its_date_kept_is_read_again(tmp_path):
    file = tmp_path / "own.toml"
    file.write_text(CATALOGUE.format(18))
    before = file.stat()
    first = Case(**{**PARTS, "contaminant": "soap"}, catalogue=Catalogue.load([tmp_path]))
    file.write_text(CATALOGUE.format(81))
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))
    second = Case(**{**PARTS, "contaminant": "soap"}, catalogue=Catalogue.load([tmp_path]))
    assert (first.contaminant.viscosity, second.contaminant.viscosity) == (0.018, 0.081)
    assert first.hash != second.hash


def test_what_a_law_looks_up_in_the_catalogue_counts(tmp_path):
    """The boundary law reads the fluids that were measured; another fluid there, another law."""
    parts = {**PARTS, "contaminant": {"viscosity": "20 cP"}}
    own = tmp_path / "own.toml"
    own.write_text(
        CATALOGUE.format(18) + '[fluid.soap.boundary]\ncof_bl = 0.2\npair = "TPU on vinyl"\n'
    )
    there = {"catalogue": Catalogue.load([tmp_path])}
    boundary = [Case(**parts, friction="boundary", **more) for more in ({}, there)]
    assert boundary[0].hash != boundary[1].hash
    pair = [Case(**parts, friction="pair", **more) for more in ({}, there)]
    assert pair[0].hash == pair[1].hash


def test_entries_shared_by_cases_cannot_be_changed(case):
    entries = case.catalogue.entries
    water = entries["fluid", "water"]
    for change in (
        lambda: entries.update({}),
        lambda: entries.__setitem__(("fluid", "water"), water),
        lambda: water.values.__setitem__("viscosity", None),
        lambda: water.values.clear(),
    ):
        with pytest.raises(InputError, match="shared by all cases"):
            change()
    assert pickle.loads(pickle.dumps(water)) == water
    assert copy.deepcopy(water) == water


# code of others


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Return what writes a package with a law and imports it anew."""
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def write(level, top=""):
        folder = tmp_path / "tribo_test"
        folder.mkdir(exist_ok=True)
        (folder / "__init__.py").write_text("")
        (folder / "helper.py").write_text(f"def level():\n    return {level}\n")
        text = textwrap.dedent(LAW).format(top=top, helper="tribo_test.helper")
        (folder / "law.py").write_text(text)
        for name in [name for name in sys.modules if name.startswith("tribo_test")]:
            del sys.modules[name]
        Option._known["friction"].pop("sticky", None)
        importlib.invalidate_caches()
        return importlib.import_module("tribo_test.law")

    yield write
    for name in [name for name in sys.modules if name.startswith("tribo_test")]:
        del sys.modules[name]


@pytest.mark.slow
def test_code_of_a_law_counts_with_the_files_beside_it(package, smooth):
    hashes, cofs = [], []
    for level, top in ((0.3, ""), (0.3, ""), (0.5, ""), (0.5, "K = 1")):
        package(level, top)
        own = smooth.replace("friction", "sticky")
        result = run(own, quick=True)
        assert result.provenance.case_hash == own.hash
        hashes.append(own.hash)
        cofs.append(result.value("cof_adhesion"))
    assert hashes[0] == hashes[1]
    assert len(set(hashes)) == 3
    assert cofs[0] == cofs[1] != cofs[2]


@pytest.mark.slow
def test_a_sweep_after_an_edit_of_the_law_computes_again(package, smooth, tmp_path):
    cofs = []
    for level in (0.3, 0.5, 0.5):
        package(level)
        found = sweep(
            smooth.replace("friction", "sticky"),
            {"motion.speed": [0.3, 0.6]},
            folder=tmp_path / "study",
            workers=1,
        )
        cofs.append(found["cof"].values.ravel())
    assert (cofs[1] > cofs[0]).all()
    assert (cofs[1] == cofs[2]).all()


def test_a_law_without_a_file_counts_by_its_code():
    """As in a notebook."""

    def class_of(text):
        room = {"ConstantLaw": ConstantLaw, "__name__": "notebook_room"}
        exec(compile(text, "<cell>", "exec"), room)
        return room["Mine"]

    text = "K = {}\nclass Mine(ConstantLaw):\n    def at(self, values):\n        return K * {}\n"
    first, same, other, number = (
        content_hash(class_of(text.format(*each))) for each in ((1, 2), (1, 2), (3, 2), (1, 4))
    )
    assert first == same
    assert len({first, other, number}) == 3


def test_an_object_is_checked_before_anything_is_computed(smooth):
    given, objects = case_and_objects(smooth, {"friction": law(0.3), "film": "none"})
    assert given.film.name == "none"
    assert set(objects) == {"friction"}
    assert case_hash(given, objects) != given.hash
    assert case_hash(given, {}) == given.hash


def test_code_of_no_module_has_a_hash():
    made = type("Made", (), {"__module__": ""})
    assert content_hash(made()) == content_hash(made())
    assert content_hash(made()) != content_hash(type("Other", (), {"__module__": ""})())
