"""Bad case files: every problem at once, each with its line, what is allowed and a remedy."""

import math

import pytest

from underfoot.case import Case, CaseError, assumptions
from underfoot.case.parts import unit_at
from underfoot.case.text import Places, key_lines
from underfoot.core import InputError, RangeError

GOOD = {
    "shoe": {"from": "work_shoe_half_tread"},
    "floor": {"from": "vinyl_g4"},
    "contaminant": {"from": "glycerol_90pct"},
    "motion": {"from": "slip_tester_g4"},
}


def refused(path, value):
    tree = {key: dict(item) for key, item in GOOD.items()}
    *parents, key = path.split(".")
    table = tree
    for parent in parents:
        table = table.setdefault(parent, {})
    table[key] = value
    with pytest.raises(CaseError) as caught:
        Case.from_mapping(tree)
    return caught.value


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (
            "motion.speed",
            0.7,
            "motion.speed: 0.7 has no unit. Allowed: a number with a unit of m/s. "
            'Write it as text with its unit, for example "0.7 m/s"',
        ),
        ("motion.speed", "0.7", "0.7 has no unit"),
        ("motion.speed", "0.7 m", "is not a value in m/s"),
        ("motion.speed", "0.7 m/z", "unknown unit"),
        ("motion.speed", "fast", "is not a number with a unit"),
        ("motion.speed", "0 m/s", "outside the physical range. Allowed: above 0 m/s to 20 m/s"),
        ("motion.speed", "-1 m/s", "outside the physical range"),
        ("motion.normal_force", "0 N", "outside the physical range"),
        ("motion.normal_force", "-500 N", "outside the physical range"),
        ("motion.normal_force", "nan N", "is not a number"),
        ("motion.shoe_angle", "10 mm", 'is not a value in rad. Allowed: for example "10 deg"'),
        ("motion.steady", "yes", "true or false"),
        ("shoe.sole.outsole_thickness", "0 mm", "outside the physical range"),
        ("shoe.sole.outsole_thickness", "-3 mm", "outside the physical range"),
        ("shoe.from", "work_sho_half_tread", 'Did you mean "work_shoe_half_tread"?'),
        ("shoe.from", 3, "is no name"),
        ("contaminant.from", "glycerin_90pct", 'Did you mean "glycerol_90pct"?'),
        ("contaminant.from", "dry", 'A dry floor is contaminant = "none"'),
        ("floor.from", "lava", "unknown floor"),
        ("motion.from", "micro_fe_g1", "setup with motion"),
        ("floor.roughness.rz", "35.1 m", 'Allowed: from 1 nm to 1 mm. Did you mean "35.1 um"?'),
        ("contaminant.viscosity", "0 cP", "outside the physical range"),
        ("contaminant.viscocity", "3 cP", 'unknown key "viscocity"'),
        ("motoin.speed", "1 m/s", 'Did you mean "motion"?'),
        ("shoe.tread.pattern", "gird", 'unknown choice "gird". Allowed: none, grid'),
        ("shoe.tread.channel_width", "0.3 mm", "too narrow for the grid of"),
        ("shoe.tread.lug_width", "0.5 mm", "two cells"),
        ("shoe.tread.depth", "30 mm", "goes through the outsole"),
        ("shoe.tread.depth", "0 mm", 'pattern = "none"'),
        ("shoe.tread.edge_radius", "2.6 mm", "does not fit on the lug"),
        ("shoe.tread.arc_channel.width", "4 mm", "is missing"),
        ("shoe.heel.profile", "rocker", 'is missing for model = "rocker"'),
        ("shoe.heel.profile.radius", "80 mm", 'is not used by model = "facet"'),
        ("shoe.heel.edge_radius", "40 mm", "does not fit the plan form"),
        ("shoe.sole.midsole_modulus", "1 MPa", "shoe.sole.midsole.thickness: is missing"),
        ("shoe.material.shore_a", 100, "no finite modulus"),
        ("shoe.material.shore_a", 0, "outside the physical range"),
        (
            "shoe.material.relaxation",
            {
                "equilibrium_shear_modulus": "1 MPa",
                "terms": [{"shear_modulus": "-1 MPa", "time": "1 s"}],
            },
            "shoe.material.relaxation.terms.0",
        ),
        ("contaminant.fraction_basis", "mass", 'write model = "glycerol_water"'),
        ("contaminant.glycerol_fraction", "85 %", "contaminant.fraction_basis: is missing"),
        ("motion.duration", "1 ms", "before the force has risen"),
        ("models.friction", "boundry", 'Did you mean "boundary"?'),
        ("models.friction", "constant", "friction.cof: is missing"),
        ("models.friction", "adhesion_blocking", "friction.dry_adhesion_cof: is missing"),
        ("sensor.scans", 1.5, "a whole number"),
        ("sensor.scans", 0, "at least 1"),
        ("numerics.tolerance", 1.0, "outside the physical range"),
        ("risk.rcof_mean", "high", "is not a number"),
        ("shoe.material", "neolit", 'Did you mean "neolite"?'),
        ("shoe.heel", 3, "a section with its own keys"),
        ("file_version", 99, "Update underfoot"),
        ("file_version", "one", "is no version"),
        ("name", 3, "text"),
    ],
)
def test_a_bad_value_is_refused_in_our_words(path, value, message):
    error = refused(path, value)
    assert message in str(error)
    assert isinstance(error, InputError)
    assert error.exit_code == 2
    for word in ("pydantic", "errors.", "validation error", "Input should", "type="):
        assert word not in str(error)


def test_what_is_out_of_range_is_a_range_error():
    (only,) = refused("motion.speed", "0 m/s").errors
    assert isinstance(only, RangeError)
    assert only.where == "motion.speed"


def test_glycerol_and_viscosity_both_given_are_refused():
    tree = {
        **GOOD,
        "contaminant": {"viscosity": "3 cP", "glycerol_fraction": 0.5, "fraction_basis": "mass"},
    }
    with pytest.raises(
        CaseError, match=r"contaminant.viscosity: is not used by model = .glycerol_water"
    ):
        Case.from_mapping(tree)


def test_a_shoe_without_a_catalogue_entry_says_what_is_missing():
    tree = {**GOOD, "shoe": {"heel": {"length": "60 mm"}}}
    with pytest.raises(CaseError) as caught:
        Case.from_mapping(tree)
    text = str(caught.value)
    for section in ("shoe.material", "shoe.roughness", "shoe.tread"):
        assert f"{section}: this section is missing" in text
    tree = {
        **GOOD,
        "shoe": {
            "material": {"poisson_ratio": 0.49},
            "tread": {"pattern": "none"},
            "heel": {"profile": "flat"},
            "roughness": {"rz": "30 um"},
        },
    }
    with pytest.raises(CaseError) as caught:
        Case.from_mapping(tree)
    assert "neither hardness nor modulus" in str(caught.value)


def test_a_roughness_by_rz_alone_counts_and_says_how():
    case = Case.from_mapping({**GOOD, "floor": {"roughness": {"rz": "30 um"}}})
    assert case.floor.roughness.rq_or_estimate == pytest.approx(30e-6 / math.sqrt(8 * 4))
    assert any("floor.roughness: rq = 5.3 um (Rz over 5.7" in line for line in assumptions(case))


BAD_FILE = """\
[shoe]
from = "work_sho_untreaded"
heal.length = "3 mm"

[floor]
from = "vinyl_g4"
roughness = {ra = "35.1 m"}

[contaminant]
from = "glycerol_90pct"

[motion]
speed = 0.7
normal_force = "-3 N"
shoe_angle = "10 deg"

[[extra]]
x = 1
"""


def test_all_problems_of_a_file_come_at_once_with_their_lines(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text(BAD_FILE)
    with pytest.raises(CaseError) as caught:
        Case.load(file)
    where = [error.where for error in caught.value.errors]
    assert where == [
        f"shoe.from ({file}, line 2)",
        f"shoe.heal ({file}, line 3)",
        f"floor.roughness.ra ({file}, line 7)",
        f"motion.speed ({file}, line 13)",
        f"motion.normal_force ({file}, line 14)",
        f"extra ({file}, line 17)",
    ]
    assert str(caught.value).startswith("6 problems:\n  - shoe.from")


def test_what_is_no_toml_or_no_file_is_refused(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text("speed = 0.7 m/s\n")
    with pytest.raises(InputError, match=r"is no TOML file.*line 1.*in quotes"):
        Case.load(file)
    with pytest.raises(InputError, match=r'there is no file.*Did you mean "case.toml"'):
        Case.load(tmp_path / "cas.toml")
    file.write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="can't be read"):
        Case.load(file)


def test_key_lines_read_tables_dotted_keys_and_skip_text_blocks():
    text = 'a = 1\n[b.c]\nd.e = 2\nt = """\n[x]\ny = 3\n"""\n["q"]\nz = 1\n# k = 1\n'
    lines = key_lines(text)
    assert lines == {
        ("a",): 1,
        ("b", "c"): 2,
        ("b", "c", "d"): 3,
        ("b", "c", "d", "e"): 3,
        ("b", "c", "t"): 4,
        ("q",): 8,
        ("q", "z"): 9,
    }
    assert Places("f", text)("b.c.d.e.f") == "b.c.d.e.f (f, line 3)"
    assert Places("f", text)("nowhere") == "nowhere (f)"
    assert Places()("a") == "a"


@pytest.mark.parametrize("part", ["shoe", "floor"])
def test_a_roughness_of_nothing_and_of_a_millimetre_is_refused_where_it_stands(part):
    none, most = (refused(f"{part}.roughness.rq", rq).errors for rq in ("0 um", "1 mm"))
    assert [(e.where, e.allowed) for e in none] == [(f"{part}.roughness.rq", "from 1 nm to 1 mm")]
    assert [e.where for e in most] == [f"{part}.roughness"]
    assert "1 mm is no roughness of a sole on a floor" in most[0].what


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("floor.rz", "floor.roughness.rz"),
        ("shoe.rq", "shoe.roughness.rq"),
        ("shoe.hardness", "shoe.material.shore_a"),
        ("shoe.lug_width", "shoe.tread.lug_width"),
        ("motion.velocity", "motion.speed"),
        ("motion.force", "motion.normal_force"),
        ("motion.angle", "motion.shoe_angle"),
        ("tread.depth", "shoe.tread.depth"),
        ("speed", "motion.speed"),
    ],
)
def test_a_path_that_is_none_names_the_one_that_it_means(written, meant):
    case = Case.load("examples/work_shoe_half_tread_glycerol.toml")
    with pytest.raises(InputError) as caught:
        case.replace(written, "5")
    assert caught.value.nearest == meant


def test_a_key_that_stands_in_another_section_is_named_with_its_path(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(
        'shoe = "work_shoe_half_tread"\nfloor = {from = "vinyl_g4", rq = "3 um"}\n'
        'contaminant = "water"\nmotion = {from = "slip_tester_g4", load = "300 N"}\n',
        "utf-8",
    )
    with pytest.raises(InputError) as caught:
        Case.load(file)
    meant = [error.nearest for error in caught.value.errors]
    assert meant == ["floor.roughness.rq", "motion.normal_force"]


def test_a_section_in_place_of_a_value_is_no_unknown_path():
    with pytest.raises(InputError, match=r'"contaminant" is a section.*contaminant.viscosity'):
        unit_at("contaminant")
