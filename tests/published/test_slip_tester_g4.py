"""Six shoes in two fluids against the floor-sensor readings of the report (G.4.2).

One set of assumptions for all twelve. ``interface.roughness_beyond_cutoff`` was chosen on the
untreaded work shoe in glycerol. Whether a printed number agrees is judged by study g4 on three
grids; here the default grid must stay where these bounds, each with its reason, put it.
"""

from functools import cache
from pathlib import Path

import pytest

from underfoot import Case, Result, run
from underfoot.core.catalogue import Catalogue

EXAMPLES = Path(__file__).parents[2] / "examples"
SHOES = [
    f"{kind}_shoe_{tread}"
    for kind in ("work", "athletic")
    for tread in ("full_tread", "half_tread", "untreaded")
]
READINGS = Catalogue.load().entry("published", "slip_tester_g4")
SMALL = READINGS.sourced_value("fluid_load_all_others_below", "N").value

EVERY = [  # a tread that is half worn is run by `make test-studies`
    pytest.param(shoe, marks=pytest.mark.study if "half" in shoe else pytest.mark.slow)
    for shoe in SHOES
]


@cache
def result(shoe: str, fluid: str) -> Result:
    case = Case.load(EXAMPLES / f"{shoe}_{fluid}.toml")
    # the bound below is that of the pin's law, which knows no edges of lugs
    case = case.replace({"friction": "stribeck", "film.lug_edges": False})
    # a thin film under a whole heel takes a minute on the default grid
    return run(case, quick=(shoe == "work_shoe_untreaded" and fluid == "detergent"))


@pytest.mark.parametrize("fluid", ["glycerol", "detergent"])
@pytest.mark.parametrize("shoe", EVERY)
def test_every_condition_converges_and_carries_the_load(shoe, fluid):
    found = result(shoe, fluid)
    assert found.status.usable
    history = found.fields
    assert float(history.load_history[-1]) == pytest.approx(500.0, rel=2e-3)
    # Eq. 17 of the pin at 0.7 m/s leaves 0.21 (detergent) and 0.11 (90 % glycerol) in the
    # contact; a film carries load and lowers it, its shear adds up to a fifth in glycerol
    most = {"detergent": 0.21, "glycerol": 0.14}[fluid]
    assert 0.0 < found.value("cof") <= most


TWO_READINGS = 0.30
"""Two standard deviations of a reading of the tester (15 %, assumed: none is printed)."""


@pytest.mark.slow
def test_the_untreaded_work_shoe_s_load_in_glycerol_is_within_the_reading_error():
    printed = READINGS.sourced_value("fluid_load_work_shoe_untreaded_glycerol", "N").value
    read = result("work_shoe_untreaded", "glycerol").value("fluid_load_sensor")
    assert read == pytest.approx(printed, rel=TWO_READINGS)


@pytest.mark.slow
def test_the_pocket_of_touch_down_gave_the_athletic_shoe_s_load():
    """Half a degree above the flush angle it is met at 0.12 s, but not by steady sliding."""
    case = Case.load(EXAMPLES / "athletic_shoe_untreaded_glycerol.toml")
    tipped = case.replace({"motion.shoe_angle": "10.5 deg", "numerics.tread_positions": 1})
    steady, early = (
        run(tipped.replace({"motion.duration": end}), quick=True) for end in (None, "0.12 s")
    )
    load, peak = (
        READINGS.sourced_value(f"{name}_athletic_shoe_untreaded_glycerol", unit).value
        for name, unit in (("fluid_load", "N"), ("peak_pressure", "Pa"))
    )
    assert steady.value("fluid_load_sensor") < load < early.value("fluid_load_sensor")
    # its peak has not settled with the grid, and is above the printed one on both
    assert peak < steady.value("peak_fluid_pressure_sensor")
    assert steady.value("peak_fluid_pressure_sensor") < early.value("peak_fluid_pressure_sensor")
    assert "later_cof" in early.scalars


@pytest.mark.slow
def test_an_untreaded_shoe_reads_next_to_nothing_in_detergent():
    """The athletic one. The work shoe does not: 7 to 11 N, a miss that the docs tell."""
    assert result("athletic_shoe_untreaded", "detergent").value("fluid_load_sensor") < SMALL
    assert result("work_shoe_untreaded", "detergent").value("fluid_load_sensor") < 4 * SMALL


@pytest.mark.parametrize("fluid", ["glycerol", "detergent"])
@pytest.mark.parametrize("shoe", [one for one in EVERY if not one.values[0].endswith("untreaded")])
def test_treaded_shoes_read_next_to_nothing(shoe, fluid):
    """A pocket of 10 mm is wider than a lug of 5 mm: it always lies over a channel, which holds no
    pressure. A fifth of the printed bound: the sensor must not begin to see the film on the lugs.
    """
    assert result(shoe, fluid).value("fluid_load_sensor") < SMALL / 5


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["work", "athletic"])
def test_viscosity_matters_only_without_tread(kind):
    shoe = f"{kind}_shoe_untreaded"
    thick, thin = (
        result(shoe, fluid).value("fluid_load_sensor") for fluid in ("glycerol", "detergent")
    )
    assert thick > 5 * thin


@pytest.mark.slow
def test_the_peak_lies_between_the_printed_place_and_the_front_end_of_the_facet():
    """G.4.3: about 20 mm anterior of the back of the heel. The film under the ground facet rises to
    the facet's front end, which is assumed at 45 mm; the heel is the same on both sides.
    """
    read = result("work_shoe_untreaded", "glycerol").fields.sensor_pressure
    top = read.where(read == read.max(), drop=True)
    assert float(top.sensor_y[0]) == pytest.approx(0.0, abs=1e-9)
    assert 0.015 <= float(top.sensor_x[0]) <= 0.045
