"""Hardness on other scales: the lines of the sources, and how a case takes them."""

import pytest

from underfoot.case import Case
from underfoot.core import InputError
from underfoot.material.durometer_scales import SCALES, durometer_reading


@pytest.mark.parametrize(
    ("text", "shore_a"),
    [
        ("62 A", 62),
        ("62", 62),
        ("Shore A 62", 62),
        ("ShA 62.5", 62.5),
        ("40 D", 90),
        ("30 Shore D", 80),
    ],
)
def test_a_reading_is_understood_however_it_is_written(text, shore_a):
    assert durometer_reading(text).shore_a == shore_a


@pytest.mark.parametrize(
    ("asker_c", "shore_a"),
    [(45, 26.7), (50, 30.8), (55, 35.0), (60, 39.2), (65, 43.3), (70, 47.5), (75, 51.7)],
)
def test_asker_c_follows_the_table_of_its_source(asker_c, shore_a):
    assert durometer_reading(f"{asker_c} Asker C").shore_a == pytest.approx(shore_a, abs=0.1)


@pytest.mark.parametrize("scale", SCALES, ids=lambda scale: scale.name)
def test_a_scale_gives_a_shore_a_and_refuses_what_its_source_leaves_out(scale):
    for value in (scale.low, scale.high):
        assert 0 <= durometer_reading(f"{value} {scale.name}").shore_a <= 100
    with pytest.raises(InputError, match="outside"):
        durometer_reading(f"{scale.high + 1} {scale.name}")


def test_a_converted_hardness_carries_its_spread_and_source_through_a_file(worn_shoe_case):
    case = worn_shoe_case.replace("shoe.material.shore_a", "55 Asker C")
    again = Case.from_text(case.to_toml(complete=True))
    assert again.hash == case.hash
    for each in (case, again):
        assert each.shoe.material.shore_a == 35.0
        hardness = each.sourced_value("shoe.material.shore_a")
        assert hardness.uncertainty == 5.0
        assert "Asker C" in hardness.source


def test_the_volume_of_the_abrasion_test_sets_the_wear_rate(worn_shoe_case):
    wear = {"mode": "archard", "angle": "9 deg", "depth": "1 mm"}
    rates = []
    for text in ("DIN 150 mm3", "ISO 4649 150 mm^3", "150 mm³"):
        worn = worn_shoe_case.replace("shoe.wear", {**wear, "abrasion": text})
        rates.append(worn.shoe.wear.wear_rate)
        assert Case.from_text(worn.to_toml(complete=True)).hash == worn.hash
    # 150 mm^3 lost under 10 N over 40 m
    assert rates == pytest.approx([150e-9 / (10 * 40)] * 3)
    both = {**wear, "abrasion": "150 mm3", "wear_rate": "0.3 mm^3/(N*m)"}
    with pytest.raises(InputError, match="twice"):
        worn_shoe_case.replace("shoe.wear", both)
