"""Distance and months walked until a volume of sole is lost."""

from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.core import InputError
from underfoot.questions.walked import DAYS_A_MONTH, Walked, WearWalker, WornPair, worn_pair

OUTSOLES = Path(__file__).parents[2] / "examples" / "outsoles"
VOLUMES, LOST = [0.0, 100e-9, 400e-9], [0.0, 1e-3, 2e-3]


def test_distance_by_archard_is_volume_over_what_a_landing_takes():
    # DIN 150 mm3: 0.375 mm3/(N m); 180 N over 12.6 mm take 0.8505 mm3, over 2.2 mm 0.1485
    found = WearWalker(0.375e-9).walk_until(1e-6, VOLUMES, LOST)
    assert found.distance[0] == pytest.approx(1000 / 0.8505 * 2 * 0.5)
    assert found.distance[1] == pytest.approx(1000 / 0.1485 * 2 * 0.75)
    assert found.months[0] == pytest.approx(2 * 1000 / 0.8505 / 18000 / DAYS_A_MONTH)
    assert found.months[1] == pytest.approx(2 * 1000 / 0.1485 / 4000 / DAYS_A_MONTH)


def test_distance_is_inverse_to_abrasion_and_proportional_to_volume():
    one = WearWalker(1e-10).walk_until(1e-7, VOLUMES, LOST)
    other = WearWalker(2e-10).walk_until(4e-7, VOLUMES, LOST)
    assert np.array(other.distance) == pytest.approx(2 * np.array(one.distance))
    assert np.array(other.months) == pytest.approx(2 * np.array(one.months))


def test_a_measured_pair_sets_the_distance():
    walker = WearWalker(1e-10, WornPair(1.5e-3, 300e3))
    # the pair has lost 250 mm3
    found = walker.walk_until(500e-9, VOLUMES, LOST)
    assert found.distance == pytest.approx((600e3, 600e3))
    assert found.months[0] == pytest.approx(600e3 / 0.75 / 18000 / DAYS_A_MONTH)
    assert found.text.startswith("600 km, ")
    with pytest.raises(InputError, match="--to"):
        WearWalker(1e-10, WornPair(2.5e-3, 3e5)).walk_until(1e-7, VOLUMES, LOST)


def test_ranges_have_one_figure():
    assert Walked((1234.0, 87654.0), (0.0321, 2.6)).text == "1 to 90 km, 0.03 to 3 months"
    assert Walked((0.0, 0.0), (0.0, 0.0)).text == "0 km, 0 months"


def test_a_pair_is_read_from_text():
    assert worn_pair("1.2 mm after 300 km") == WornPair(pytest.approx(1.2e-3), pytest.approx(3e5))
    assert worn_pair(None) is None
    for text in ("1,2 mm in 300km", "1 1/5 mm after 300 km"):
        assert worn_pair(text) == WornPair(pytest.approx(1.2e-3), pytest.approx(3e5))
    assert worn_pair("0.05 in after 1 year").months == pytest.approx(12)
    for text in (
        "1.2 mm",
        "300 km after 1 mm",
        "0 mm after 300 km",
        "old",
        "1 mm after 1,200 km",
        "NaN mm after 5 km",
        "1 mm after 5",
        "1 mm after 5 kg",
    ):
        with pytest.raises(InputError, match="worn-pair"):
            worn_pair(text)


def test_a_wear_rate_of_the_case_is_taken():
    case = Case.load(OUTSOLES / "heel_hexagons_glycerol.toml")
    assert not case.value("shoe.wear.wear_rate")
    changes = {"mode": "archard", "angle": "10 deg", "abrasion": "DIN 250 mm3"}
    worn = case.replace({f"shoe.wear.{name}": value for name, value in changes.items()})
    assert worn.value("shoe.wear.wear_rate") == pytest.approx(0.625e-9)


def test_a_pair_worn_for_months_tells_the_life_in_months():
    known = worn_pair("1.5 mm after 6 months")
    assert known.walked is None
    assert known.months == pytest.approx(6, rel=1e-3)
    half = WearWalker(1e-10, known).walk_until(VOLUMES[-1], VOLUMES, LOST)
    first = WearWalker(1e-10, WornPair(1.5e-3, 300e3)).walk_until(VOLUMES[-1], VOLUMES, LOST)
    times = first.distance[0] / 300e3
    assert half.months == pytest.approx((6 * times, 6 * times), rel=1e-3)
    assert half.distance[0] < half.distance[1]
