"""Bad case files and values: an answer that names the remedy, never a traceback."""

import pytest

from underfoot.case import Case, CaseError
from underfoot.core import InputError
from underfoot.core.catalogue import Catalogue

GOOD = (
    'file_version = 2\nshoe = "work_shoe_untreaded"\nfloor = "vinyl_g4"\n'
    'contaminant = "glycerol_90pct"\nmotion = {from = "slip_tester_g4", speed = "0.5 m/s"}\n'
)


def test_a_byte_order_mark_is_no_part_of_a_file(tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(b"\xef\xbb\xbf" + GOOD.encode())
    assert Case.load(file) == Case.from_text(GOOD) == Case.from_text("\ufeff" + GOOD)
    assert Case.load(file).replace("motion.speed", 0.3).to_toml().startswith("file_version")
    file.write_bytes(GOOD.encode("utf-16"))
    with pytest.raises(InputError, match="Save the file as UTF-8"):
        Case.load(file)


def test_brackets_within_brackets_end_in_an_answer(tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(GOOD + "deep = " + "[" * 2000 + "]" * 2000)
    with pytest.raises(InputError, match=r"nested too deeply.*Close the brackets"):
        Case.load(file)


@pytest.mark.parametrize(
    ("path", "value", "answer"),
    [
        ("motion.normal_force", "1 mN", "Allowed: from 1 N to 10 kN. Did you mean"),
        ("motion.normal_force", 1e-3, "Allowed: from 1 N to 10 kN"),
        ("shoe.material.shore_a", "62 HV", '"62 Asker C"'),
        ("shoe.material.shore_a", "62,500 A", "can be 62.500 or 62500"),
        ("shoe.material.shore_a", "20 Shore D", "30 to 49 Shore D"),
        ("shoe.wear", {"mode": "archard", "angle": "9 deg", "abrasion": "150"}, "DIN 150 mm3"),
        ("motion.normal_force", "1,234 N", "can be 1.234 or 1234"),
        ("contaminant.viscosity", float("nan"), "nan"),
        ("contaminant.viscosity", True, "True is not a number"),
        ("contaminant.viscosity", {"value": "2 cP", "uncertainty": "1 kg"}, "viscosity.uncert"),
        ("contaminant.viscosity", {"value": "2 cP", "uncertainty": "-1 cP"}, "0 or more"),
        ("shoe.material.shore_a", {"value": 62, "uncertainty": "10 %"}, "10 % can be of the value"),
        ("risk.rcof_sd", "15 %", "rcof_sd: 15 % can be of the value"),
        ("contaminant.viscosity", {"value": "2 cP", "sorce": "own"}, 'Did you mean "source"?'),
    ],
)
def test_a_bad_value_is_answered_with_the_remedy(path, value, answer):
    with pytest.raises(InputError) as caught:
        Case.from_text(GOOD).replace(path, value)
    assert answer in str(caught.value)
    assert path in str(caught.value)


def test_an_own_catalogue_is_read_again_only_when_a_file_changed(tmp_path):
    file = tmp_path / "oils.toml"
    file.write_text('[fluid.mine]\nsource = "own"\nviscosity = "30 cP"\n')
    first = Catalogue.load([tmp_path])
    assert Catalogue.load([tmp_path]) is first
    file.write_text('[fluid.mine]\nsource = "own"\nviscosity = "31.5 cP"\n')
    second = Catalogue.load([tmp_path])
    assert second is not first
    assert Case(
        shoe="work_shoe_untreaded",
        floor="vinyl_g4",
        contaminant="mine",
        motion="slip_tester_g4",
        catalogue=second,
    ).contaminant.viscosity == pytest.approx(0.0315)


def test_all_that_is_wrong_comes_at_once():
    with pytest.raises(CaseError) as caught:
        Case(shoe="work_shoe_untreaded", floor={}, contaminant="oil", motion={"speed": -1.0}, x=1)
    text = str(caught.value)
    for part in ("contaminant.from", "floor.roughness", "motion.speed", "motion.shoe_angle", "x:"):
        assert part in text
