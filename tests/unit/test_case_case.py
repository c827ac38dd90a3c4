"""Cases: composition, provenance, changing a value, hash, what is assumed."""

import math

import pytest

from underfoot.case import Case, CaseError, assumptions, describe, paths, unit_at
from underfoot.case.parts import fields
from underfoot.case.quantity import default_of
from underfoot.case.section import quantity_of
from underfoot.core import InputError, to_si
from underfoot.questions.comparison import case_differences

TEXT = """\
# my shoe
name = "test"  # its name
[shoe]
from = "work_shoe_half_tread"
material.shore_a = 70  # durometer
[floor]
from = "vinyl_g4"
[contaminant]
from = "glycerol_90pct"
[motion]
from = "slip_tester_g4"
speed = {value = "500 mm/s", uncertainty = "5 mm/s", source = "encoder"}
"""


@pytest.fixture
def case():
    return Case.from_text(TEXT)


def test_values_come_from_the_file_the_catalogue_and_defaults(case):
    assert case.shoe.material.shore_a == 70
    assert case.shoe.tread.depth == 1.5e-3
    assert case.contaminant.viscosity == 0.219
    assert case.motion.speed == 0.5
    assert case.motion.shoe_angle == pytest.approx(math.radians(10))
    assert case.hardness.name == "gent"


def test_every_value_knows_where_it_comes_from(case):
    hardness, depth = (
        case.sourced_value("shoe.material.shore_a"),
        case.sourced_value("shoe.tread.depth"),
    )
    assert hardness.source == "given in the case"
    assert "Table 6" in depth.source
    assert not depth.assumed
    speed = case.sourced_value("motion.speed")
    assert (speed.uncertainty, speed.source) == (0.005, "encoder")
    assert case.sourced_value("shoe.heel.facet_angle").assumed
    oil = case.replace({"contaminant": "canola_oil", "friction": "stribeck"})
    assert oil.sourced_value("contaminant.boundary.cof_bl").uncertainty == 0.02
    assert case.sourced_value("shoe.material.modulus").value is None
    assert case.entries["shoe"] == "work_shoe_half_tread"


def test_the_composition_shows_every_value_and_its_origin(case):
    text = str(case)
    assert "catalogue: shoe work_shoe_half_tread" in text
    assert "500 mm/s ± 5 mm/s" in text
    assert "given (encoder)" in text
    assert "catalogue: fluid glycerol_90pct" in text
    assert "effective Rq" in text


def test_what_was_assumed_is_listed_and_what_is_unused_is_not(case):
    text = "\n".join(assumptions(case))
    assert "shoe.heel.profile: model = facet, angle = 10 deg" in text
    assert "1.25 Ra" in text
    assert "effective_rq" in text
    assert "temperature" not in text
    assert "midsole" not in text
    given = case.replace("interface.effective_rq", "20 um")
    assert "effective_rq" not in "\n".join(assumptions(given))
    assert given.effective_rq.value == 20e-6
    assert not given.effective_rq.assumed


def test_the_effective_roughness_is_the_composite_of_both(case):
    stylus = math.hypot(math.sqrt(math.pi / 2) * 5.74e-6, 0.45e-6)
    assert case.effective_rq.value == pytest.approx(2.0 * stylus)
    plain = case.replace("interface.roughness_beyond_cutoff", 1.0)
    assert plain.effective_rq.value == pytest.approx(stylus)
    assert case.effective_rq.assumed


def test_replace_returns_a_new_case_and_keeps_comments(case):
    thin = case.replace("contaminant.viscosity", "41 cP")
    assert thin.contaminant.viscosity == 0.041
    assert case.contaminant.viscosity == 0.219
    assert thin != case
    faster = case.replace("motion.speed", "0.7 m/s")
    assert "# my shoe" in faster.to_toml()
    assert "# its name" in faster.to_toml()
    assert "# durometer" in case.replace("shoe.material.shore_a", 60).to_toml()
    assert case.replace("shoe.material.shore_a", 60).shoe.material.shore_a == 60
    both = case.replace({"motion.speed": "0.3 m/s", "motion.normal_force": "250 N"})
    assert (both.motion.speed, both.motion.normal_force) == (0.3, 250)


def test_replace_takes_sections_out_of_the_catalogue(case):
    other = case.replace("shoe", "athletic_shoe_untreaded")
    assert other.shoe.material.shore_a == 79
    kept = case.replace("shoe.from", "athletic_shoe_untreaded")
    assert kept.shoe.material.shore_a == 70
    assert kept.shoe.tread.arc_channel.width == 4e-3
    rubber = case.replace("shoe.material", "neolite")
    assert rubber.shoe.material.shore_a == 95
    assert rubber.shoe.material.relaxation.terms[0].shear_modulus == 11.58e6


def test_none_gives_the_catalogue_its_value_back(case):
    assert case.replace("shoe.material.shore_a", None).shoe.material.shore_a == 71
    assert case.replace("shoe.sole.outsole_thickness", None) == case


def test_replace_works_on_short_forms():
    case = Case.from_text(
        'shoe = "work_shoe_untreaded"\nfloor = "vinyl_g4"\ncontaminant = "water"\n'
        'motion = "slip_tester_g4"\n'
    )
    assert case.replace("motion.speed", "1 m/s").motion.speed == 1.0
    assert case.replace("shoe.heel.facet_angle", "9 deg").shoe.material.shore_a == 68
    assert case.replace("contaminant", "canola_oil").contaminant.viscosity == 0.0746
    assert case.replace("interface.effective_rq", "9 um").interface.effective_rq == 9e-6


def test_an_unknown_path_gets_the_nearest(case):
    with pytest.raises(InputError) as caught:
        case.replace("contaminant.viscocity", "41 cP")
    assert caught.value.nearest == "contaminant.viscosity"
    with pytest.raises(InputError, match="unknown path"):
        case.value("motion.speed.x")
    with pytest.raises(InputError, match="can't stand for a section"):
        case.replace("shoe", 5)


def test_a_dry_floor_is_said_not_left_out(case):
    with pytest.raises(CaseError, match="law boundary needs a fluid"):
        case.replace({"contaminant": "none", "friction": "boundary"})
    dry = case.replace(
        {
            "contaminant": "none",
            "models.friction": "constant",
            "interface.constant_cof": 0.8,
        }
    )
    assert dry.contaminant is None
    assert "dry floor" in str(dry)
    with pytest.raises(CaseError, match=r"contaminant: this section is missing.*\"none\""):
        Case.from_text('shoe = "work_shoe_untreaded"')


def test_the_hash_follows_content_only(case):
    same = Case.from_text(TEXT.replace("# my shoe", "# other").replace('"test"', '"else"'))
    assert same.hash == case.hash
    assert hash(same) == hash(case)
    assert case.replace("contaminant.viscosity", "0.219 Pa*s") == case
    assert case.replace("contaminant.viscosity", "219.1 cP") != case
    # the spread of an input changes that of the result
    assert case.replace("motion.speed", "0.5 m/s") != case
    assert case.replace("slip.subjects", 7) != case  # who walks decides who slips


def test_the_hash_of_an_example_is_the_same_on_every_machine():
    text = (
        'contaminant = "none"\nmotion = {speed = "1 m/s", normal_force = "500 N", '
        'shoe_angle = "0 deg"}\nmodels.friction = "constant"\ninterface = {constant_cof = 0.5, '
        'effective_rq = "9 um"}\nfloor.roughness.rq = "1 um"\nshoe = {material.shore_a = 60, '
        'roughness.rq = "5 um", tread.pattern = "none", heel.profile = "flat"}'
    )
    first, second = Case.from_text(text), Case.from_text(text)
    assert first.hash == second.hash
    assert len(first.hash) == 32


def test_a_complete_text_needs_no_catalogue_and_is_the_same_case(case):
    text = case.to_toml(complete=True)
    assert "\nfrom =" not in text
    again = Case.from_text(text)
    assert again == case
    assert (
        again.sourced_value("shoe.tread.depth").source
        == case.sourced_value("shoe.tread.depth").source
    )
    assert again.sourced_value("motion.speed") == case.sourced_value("motion.speed")
    assert sorted(assumptions(again)) == sorted(assumptions(case))
    assert again.to_toml(complete=True).splitlines()[4:] == text.splitlines()[4:]


def test_a_complete_text_leaves_out_what_the_shape_does_not_use(case):
    rocker = case.replace(
        {
            "shoe.heel.profile": "rocker",
            "shoe.heel.rocker_radius": "80 mm",
            "shoe.heel.rocker_start": "25 mm",
        }
    )
    text = rocker.to_toml(complete=True)
    assert "facet_angle" not in text
    assert Case.from_text(text) == rocker


def test_saving_keeps_the_file_as_it_is_and_does_not_overwrite(case, tmp_path):
    target = tmp_path / "deep" / "case.toml"
    case.save(target)
    assert target.read_text() == TEXT
    assert Case.load(target) == case
    with pytest.raises(InputError, match="exists"):
        case.save(target)
    case.replace("motion.speed", "1 m/s").save(target, overwrite=True)
    assert Case.load(target).motion.speed == 1.0
    assert [path.name for path in target.parent.iterdir()] == ["case.toml"]


def test_an_own_catalogue_beside_the_case_is_read(tmp_path, monkeypatch):
    monkeypatch.delenv("UNDERFOOT_CATALOGUE", raising=False)
    (tmp_path / "catalogue").mkdir()
    (tmp_path / "catalogue" / "oils.toml").write_text(
        '[fluid.fryer_oil]\nfrom = "canola_oil"\nsource = "own"\nviscosity = "30 cP"\n'
    )
    file = tmp_path / "case.toml"
    file.write_text(TEXT.replace("glycerol_90pct", "fryer_oil"))
    case = Case.load(file)
    assert case.contaminant.viscosity == 0.03
    assert case.replace("motion.speed", "1 m/s").contaminant.viscosity == 0.03
    assert Case.from_text(case.to_toml(complete=True)) == case


def test_a_given_value_puts_its_alternative_aside(case):
    mixed = case.replace(
        {"contaminant.glycerol_fraction": "85 %", "contaminant.fraction_basis": "mass"}
    )
    assert mixed.value("contaminant.viscosity") is None
    assert mixed.contaminant.glycerol_fraction == 0.85
    harder = case.replace("shoe.material", "polyurethane_g2").replace("shoe.material.shore_a", 60)
    assert harder.shoe.material.modulus is None


def test_a_case_is_frozen(case):
    with pytest.raises(InputError, match="frozen"):
        case.motion.speed = 3.0


def test_differences_name_the_changed_values(case):
    other = case.replace({"contaminant.viscosity": "41 cP", "motion.normal_force": "250 N"})
    assert case_differences([case, other]) == [
        ("contaminant.viscosity", "219 cP", "41 cP"),
        ("motion.normal_force", "500 N", "250 N"),
    ]
    assert case_differences([case, case]) == []


def test_tested_ranges_are_known_before_a_run(case):
    assert describe.tested_range_breaches(case) == []
    assert (
        "gent"
        in describe.tested_range_breaches(case.replace("shoe.material.shore_a", 97))[0].lower()
    )


DEFAULTS = [
    pytest.param(field, path, id=path)
    for path, field in fields().items()
    if default_of(field) is not None
]


@pytest.mark.parametrize(("field", "path"), DEFAULTS)
def test_every_default_says_the_same_in_text_and_in_si_and_has_a_source(field, path):
    default = default_of(field)
    assert default.source.strip()
    quantity = quantity_of(field)
    if quantity is None:
        assert default.text == field.default
    else:
        # exactly: a case and its own text must compute the same
        assert to_si(default.text, quantity.unit, where=path) == field.default
        assert unit_at(path) == quantity.unit


def test_paths_list_sections_and_values():
    known = paths()
    assert {"shoe", "shoe.tread", "shoe.tread.arc_channel.width", "motion.speed"} <= set(known)


def test_from_mapping_is_the_same_as_a_file(case):
    mapping = {
        "shoe": {"from": "work_shoe_half_tread", "material": {"shore_a": 70}},
        "floor": "vinyl_g4",
        "contaminant": {"from": "glycerol_90pct"},
        "motion": {
            "from": "slip_tester_g4",
            "speed": {"value": "500 mm/s", "uncertainty": "5 mm/s", "source": "encoder"},
        },
    }
    assert Case.from_mapping(mapping) == case
