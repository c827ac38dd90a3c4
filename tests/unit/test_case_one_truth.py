"""The fields of a case are the truth: each way of changing it gives a new hash, text, result."""

import copy
import pickle
import tomllib

import pytest

from underfoot.case import Case, CaseError
from underfoot.case.contaminant import GlycerolWater, MeasuredFluid
from underfoot.case.friction import ConstantOption
from underfoot.core import InputError, SourcedValue

PARTS = {
    "shoe": "work_shoe_untreaded",
    "floor": "vinyl_g4",
    "contaminant": "glycerol_90pct",
    "motion": "slip_tester_g4",
    "numerics": {
        "grid_spacing": "3 mm",
        "quick_grid_spacing": "4 mm",
        "cells_along": 1,
        "tread_positions": 1,
    },
}
THIN = 0.002


@pytest.fixture(scope="module")
def thick():
    return Case(**PARTS)


def sections(case):
    names = (
        "name description shoe floor contaminant motion interface hardness rough_contact film "
        "compliance friction numerics sensor risk slip"
    )
    return {name: getattr(case, name) for name in names.split()}


def thin_contaminant(case):
    return case.contaminant.model_copy(update={"viscosity": THIN})


WAYS = {
    "replace by a number": lambda c: c.replace("contaminant.viscosity", THIN),
    "replace by text": lambda c: c.replace("contaminant.viscosity", "2 cP"),
    "replace several": lambda c: c.replace({"contaminant.viscosity": THIN, "name": "thin"}),
    "replace by a sourced value": lambda c: c.replace(
        "contaminant.viscosity", SourcedValue(THIN, "Pa*s")
    ),
    "replace a section": lambda c: c.replace("contaminant", thin_contaminant(c)),
    "replace by a section of one's own": lambda c: c.replace(
        "contaminant", MeasuredFluid(viscosity=THIN)
    ),
    "replace by a mapping": lambda c: c.replace("contaminant", {"viscosity": THIN}),
    "model_copy": lambda c: c.model_copy(update={"contaminant": thin_contaminant(c)}),
    "__replace__": lambda c: c.__replace__(contaminant=thin_contaminant(c)),
    "** of the parts": lambda c: Case(**{**sections(c), "contaminant": thin_contaminant(c)}),
    "a changed copy": lambda c: copy.copy(c).replace("contaminant.viscosity", THIN),
    "a changed deep copy": lambda c: copy.deepcopy(c).replace("contaminant.viscosity", THIN),
    "pickled, then changed": lambda c: pickle.loads(pickle.dumps(c)).model_copy(
        update={"contaminant": thin_contaminant(c)}
    ),
    "changed, then pickled": lambda c: pickle.loads(
        pickle.dumps(c.replace("contaminant.viscosity", THIN))
    ),
    "pydantic's own copy of a section": lambda c: c.replace(
        "contaminant",
        MeasuredFluid.model_construct(
            _fields_set={"viscosity"}, viscosity=THIN, pool_depth=c.contaminant.pool_depth
        ),
    ),
    "text and back": lambda c: Case.from_text(
        c.replace("contaminant.viscosity", THIN).to_toml(complete=True)
    ),
}


@pytest.mark.parametrize("way", WAYS.values(), ids=list(WAYS))
def test_every_way_of_changing_changes_hash_and_text(thick, way):
    thin = way(thick)
    assert thin.contaminant.viscosity == THIN
    assert thick.contaminant.viscosity == 0.219
    assert thin != thick
    assert thin.hash != thick.hash
    for complete in (True, False):
        text = thin.to_toml(complete=complete)
        assert "219 cP" not in text
        again = Case.from_text(text)
        assert again.contaminant.viscosity == THIN
        assert again == thin


def test_a_changed_case_computes_what_it_says(thick):
    from underfoot.compute.run import run

    base = run(thick, quick=True)
    changed = thick.model_copy(update={"contaminant": thin_contaminant(thick)})
    written = Case.from_text(changed.to_toml())
    results = [run(case, quick=True) for case in (changed, written)]
    for result in results:
        assert result.provenance.case_hash == changed.hash != base.provenance.case_hash
        assert result.value("fluid_load") < 0.5 * base.value("fluid_load")
        table = tomllib.loads(result.case_text)
        assert Case.from_mapping({k: v for k, v in table.items() if k != "file_version"}) == changed
    assert results[0].value("cof") == results[1].value("cof")


@pytest.mark.parametrize(
    "same",
    [
        copy.copy,
        copy.deepcopy,
        lambda case: pickle.loads(pickle.dumps(case)),
        lambda case: case.model_copy(),
        lambda case: Case(**sections(case)),
        lambda case: case.replace({}),
        lambda case: case.replace("contaminant", case.contaminant),
        lambda case: case.replace("contaminant.viscosity", THIN).replace(
            "contaminant.viscosity", None
        ),
    ],
)
def test_an_unchanged_case_keeps_hash_sources_and_marks(thick, same):
    again = same(thick)
    assert again == thick
    assert again.sourced_value("contaminant.viscosity") == thick.sourced_value(
        "contaminant.viscosity"
    )
    assert again.sourced_value("shoe.heel.width").assumed
    assert again.origins == thick.origins
    assert Case.from_text(again.to_toml()) == thick


def test_a_slot_takes_the_name_of_an_option_in_text_too():
    names = {key: value for key, value in PARTS.items() if key != "numerics"}
    text = Case(**names).to_toml()
    short = Case.from_text(text.replace("file_version", 'friction = "boundary"\nfile_version', 1))
    beside = short.replace("friction.cof_bl", 0.3)
    assert tomllib.loads(beside.to_toml())["friction"] == {"model": "boundary", "cof_bl": 0.3}
    chosen = beside.replace("rough_contact", "contact_table").replace("friction", "stribeck")
    written = tomllib.loads(chosen.to_toml())
    assert written["rough_contact"] == {"model": "contact_table"}
    assert written["friction"] == {"model": "stribeck"}  # what was set before goes with the old
    assert Case.from_text(beside.to_toml()) == beside
    assert Case.from_text(chosen.to_toml()) == chosen


def test_the_source_of_a_value_does_not_outlive_the_value():
    case = Case(**{**PARTS, "contaminant": "canola_oil"}, friction="stribeck")
    assert case.sourced_value("friction.cof_bl").uncertainty == 0.02
    own = case.friction.model_copy(update={"cof_bl": 0.3})
    changed = case.replace("friction", own)
    assert changed.sourced_value("friction.cof_bl").source == "given in the case"
    assert changed.sourced_value("friction.cof_bl").uncertainty is None
    assert changed.origins["friction.cof_bl"].kind == "given"
    assert changed.origins["friction.pair"] == case.origins["friction.pair"]
    assert changed != case.replace("friction.cof_bl", {"value": 0.3, "uncertainty": 0.02})


def test_what_was_measured_with_a_fluid_goes_with_the_fluid(thick):
    measured = thick.replace("friction", "stribeck")
    oil = measured.replace("contaminant", "canola_oil")
    assert oil.value("friction.cof_bl") is not None
    parts = {**sections(oil), "contaminant": "detergent"}
    assert Case(**parts) == measured.replace("contaminant", "detergent")
    assert Case(**parts).value("friction.tau_hydro") is not None


def test_validation_runs_on_every_way_in(thick):
    with pytest.raises(ValueError, match="outside the physical range"):
        thick.contaminant.model_copy(update={"viscosity": -1.0})
    broken = MeasuredFluid.model_construct(_fields_set={"viscosity"}, viscosity=-1.0)
    for way in (
        lambda: Case(**{**PARTS, "contaminant": broken}),
        lambda: thick.model_copy(update={"contaminant": broken}),
        lambda: thick.replace("contaminant", broken),
        lambda: thick.replace("contaminant.viscosity", -1.0),
    ):
        with pytest.raises(CaseError, match="outside the physical range"):
            way()
    with pytest.raises(CaseError, match="goes through the outsole"):
        thick.model_copy(
            update={"shoe": thick.shoe.model_copy(update={"sole": {"outsole_thickness": "1 mm"}})}
        ).replace("shoe.wear.depth", "2 mm")


def test_a_case_can_not_be_set_in_place(thick):
    with pytest.raises(InputError, match=r"case.replace"):
        thick.contaminant = MeasuredFluid(viscosity=THIN)
    with pytest.raises(InputError, match="frozen"):
        del thick.shoe


def test_a_case_shows_no_clutter(thick):
    names = set(dir(thick))
    clutter = {"dict", "json", "parse_obj", "parse_raw", "copy", "schema", "construct", "from_orm"}
    assert not names & clutter
    assert {"replace", "save", "hash", "summary", "plot", "to_frame", "report"} <= names
    assert len(repr(thick)) < 200
    assert "glycerol_90pct" in repr(thick)
    assert "<table>" in thick._repr_html_()
    frame = thick.to_frame()
    assert "contaminant.viscosity" in set(frame.iloc[:, 0])


def test_numbers_in_python_are_si_and_text_may_have_units():
    parts = {**PARTS, "motion": {"speed": 0.5, "normal_force": "0.3 kN", "shoe_angle": "10 deg"}}
    case = Case(**parts)
    assert (case.motion.speed, case.motion.normal_force) == (0.5, 300.0)
    assert 'speed = "0.5 m/s"' in case.to_toml()
    assert Case.from_text(case.to_toml()) == case
    with pytest.raises(CaseError, match="has no unit"):
        Case.from_mapping({**PARTS, "motion": {"from": "slip_tester_g4", "speed": 0.5}})


def test_slots_take_names_mappings_and_objects(thick):
    given = [
        thick.replace("friction", {"model": "constant", "cof": 0.3}),
        thick.replace("friction", ConstantOption(cof=0.3)),
        thick.replace({"friction.model": "constant", "friction.cof": 0.3}),
        Case(**PARTS, friction=ConstantOption(cof=0.3)),
        Case(**PARTS, friction={"model": "constant", "cof": 0.3}),
        thick.replace({"models.friction": "constant", "interface.constant_cof": 0.3}),
    ]
    assert len({case.hash for case in given}) == 1
    assert thick.replace("friction", "boundary").friction.name == "boundary"
    mixture = thick.replace(
        {"contaminant.glycerol_fraction": 0.85, "contaminant.fraction_basis": "mass"}
    )
    assert isinstance(mixture.contaminant, GlycerolWater)


def test_comments_survive_replace_and_save(tmp_path):
    text = (
        '# kitchen\nfile_version = 2\nshoe = "work_shoe_untreaded"  # worn\n'
        'floor = "vinyl_g4"\ncontaminant = "glycerol_90pct"\n[motion]\nfrom = "slip_tester_g4"\n'
        'speed = "0.5 m/s"  # of the film\n'
    )
    file = tmp_path / "case.toml"
    file.write_text(text)
    case = Case.load(file)
    changed = case.replace("contaminant", thin_contaminant(case)).replace("motion.speed", 0.3)
    changed.save(file, overwrite=True)
    assert "# kitchen" in file.read_text()
    assert "# worn" in file.read_text()
    assert 'speed = "0.3 m/s"  # of the film' in file.read_text()
    assert Case.load(file) == changed


def test_a_copy_of_a_case_costs_a_small_part_of_reading_it_as_text():
    """A ratio within one run: a sweep must not parse and write TOML with its comments."""
    import time

    import tomlkit

    text = Case(**PARTS).to_toml(complete=True)
    case = Case.from_text(text)
    start = time.process_time()
    for number in range(20):
        case.replace("contaminant.viscosity", 0.01 + number * 1e-3)
    copies = time.process_time() - start
    start = time.process_time()
    for _ in range(20):
        tomlkit.dumps(tomlkit.parse(text))
    assert copies < 0.5 * (time.process_time() - start)


def test_the_package_offers_a_clean_face():
    import types

    import underfoot as uf

    names = ["Case", "Result", "Study", "__version__", "catalogue", "compare", "explain", "load"]
    names += ["optimise", "run", "sweep"]
    assert dir(uf) == names
    assert not any(isinstance(getattr(uf, name), types.ModuleType) for name in names)
    assert "friction.cof" in repr(uf.explain("friction.cof"))
    assert repr(uf.catalogue()).startswith("<Catalogue of")
