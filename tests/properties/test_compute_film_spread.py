"""How unknown the film is: roughness that lets fluid leak, in its load, in COF and in previews."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from underfoot import Case, run
from underfoot.calibrate.pair_readings import PairReading, calibrated_pair
from underfoot.case.surfaces import BEYOND_DEVIATION, FLOOR_RQ
from underfoot.compute import solve
from underfoot.compute.continuation import Continuation
from underfoot.compute.numbers import FILM_ERROR, GRID_NAMES, with_film_spread
from underfoot.compute.prepare import prepare_case
from underfoot.compute.resolve import resolve_context
from underfoot.compute.solve import film_spreads, solved_motion
from underfoot.core import SourcedValue
from underfoot.friction.propagation import normal_draws
from underfoot.friction.sampled_cof import LEAK

FACTOR = "interface.roughness_beyond_cutoff"


def heel(shoe: str = "full_tread", **values: Any) -> Case:
    return Case.from_text(
        """
        shoe = {from = "work_shoe_SHOE", roughness.ra = "4 um"}
        floor = {from = "vinyl_g4", roughness.ra = "1 um"}
        contaminant = "glycerol_90pct"
        motion = "slip_tester_g4"
        """.replace("SHOE", shoe)
    ).replace({"numerics.tread_positions": 1, **values})


def flat(**values: Any) -> Case:
    """Return a heel without lugs on coarse squares."""
    return heel("untreaded", **{"numerics.cells_along": 1, **values})


def ends(value: SourcedValue) -> tuple[float, float]:
    """Return the 95 % interval."""
    assert value.interval is not None
    return value.interval


def odds(contact) -> float:
    share = contact.fluid_load / contact.normal_force
    return math.log(share / (1 - share))


def test_an_assumed_factor_lies_between_one_and_four():
    assert 2 * math.exp(1.96 * BEYOND_DEVIATION) == pytest.approx(4)
    assert resolve_context(heel()).leak_deviation == pytest.approx(BEYOND_DEVIATION)
    assert resolve_context(heel("full_tread", **{FACTOR: 2.0})).leak_deviation == 0
    given = heel("full_tread", **{FACTOR: {"value": 2.0, "uncertainty": 0.5}})
    assert resolve_context(given).leak_deviation == pytest.approx(0.25)
    own = heel(
        "full_tread", **{"interface.effective_rq": {"value": "12 um", "uncertainty": "3 um"}}
    )
    assert resolve_context(own).leak_deviation == pytest.approx(0.25)


def test_roughness_that_is_not_given_is_drawn_over_what_is_usual():
    text = """
    shoe = {from = "work_shoe_full_tread", roughness.ra = "4 um"}
    floor.roughness = {}
    contaminant = "glycerol_90pct"
    motion = "slip_tester_g4"
    interface.roughness_beyond_cutoff = 2.0
    """
    sole, usual = math.sqrt(math.pi / 2) * 4e-6, math.sqrt(math.prod(FLOOR_RQ))
    share = usual**2 / (usual**2 + sole**2)
    expected = share * math.log(FLOOR_RQ[1] / FLOOR_RQ[0]) / (2 * 1.96)
    assert resolve_context(Case.from_text(text)).leak_deviation == pytest.approx(expected)


# steady marches end 0.4 to 10 s from the start, by rounding, up to 2 % of film apart: one instant
AT_ONCE = {"motion.steady": False, "motion.duration": "0.5 s"}


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(heel().replace(AT_ONCE), marks=pytest.mark.slow, id="lugs"),
        pytest.param(flat(), id="flat"),
    ],
)
def test_the_spread_is_that_of_marches_on_other_roughness(case):
    spacing = case.numerics.quick_grid_spacing

    def march(factor: float):
        return solved_motion(prepare_case(case.replace(FACTOR, 2 * factor), spacing))

    width = math.exp(BEYOND_DEVIATION)
    contact = march(1.0)
    spreads = film_spreads(prepare_case(case, spacing), contact)
    expected = [odds(march(factor)) - odds(contact) for factor in (1 / width, width)]
    assert expected[0] > 0.1 > -0.1 > expected[1]  # a rougher pair leaks more
    assert spreads[LEAK] == pytest.approx(expected, rel=0.1)


def test_a_history_on_the_quick_grid_is_marched_with_the_changes_alone(monkeypatch):
    """Its own contact is what the changes are compared with: no march more."""
    case = flat().replace("motion", "heel_strike_to_flat")
    marched = []

    def contact(film):
        pressure, status = np.ones((2, 2)), SimpleNamespace(usable=True)
        loads = {"fluid_load": film, "normal_force": 700.0}
        return SimpleNamespace(contact_pressure=pressure, status=status, **loads)

    def march(parts, *, progress):
        marched.append(parts.spacing)
        for done in (0.0, 1.0):
            progress("Following the motion", done)
        return contact(200.0 if len(marched) == 1 else 50.0)

    monkeypatch.setattr(solve, "solved_motion", march)
    told = []
    parts = prepare_case(case, case.numerics.quick_grid_spacing)
    spreads = film_spreads(parts, contact(100.0), lambda _, done, *__: told.append(done))
    assert len(marched) == 2
    assert told == [0.0, 0.5, 0.5, 1.0]  # one after the other, not each from the start
    expected = [math.log(6 * film / (700 - film)) for film in (200.0, 50.0)]
    assert spreads[LEAK] == pytest.approx(expected)
    marched.clear()
    film_spreads(prepare_case(case, 2 * case.numerics.quick_grid_spacing), contact(100.0))
    assert len(marched) == 3  # another grid: what it is compared with, too


@pytest.mark.slow
def test_a_known_roughness_leaves_the_model_alone():
    known, assumed = (run(flat(**more), quick=True) for more in ({FACTOR: 2.0}, {}))
    assert known["cof"].value == assumed["cof"].value
    for name in GRID_NAMES:
        low, high = ends(known[name])
        lower, higher = ends(assumed[name])
        assert lower < low < high < higher, name
    assert "lets fluid leak" in assumed.labels["cof_spread_from"]
    assert "lets fluid leak" not in known.labels["cof_spread_from"]
    assert not any("interface roughness" in line for line in assumed.cautions())
    # the film on the roughness at either end of a standard deviation is inside
    for factor in (math.sqrt(2), 2 * math.sqrt(2)):
        load = run(flat(**{FACTOR: factor}), quick=True).value("fluid_load")
        low, high = ends(assumed["fluid_load"])
        assert low < load < high


def test_the_load_on_the_film_never_leaves_the_load():
    """ln F / (W - F) is off by the draws: 0 leaves it, large ones end at W."""
    values = {"normal_force": SourcedValue(500.0, "N"), "fluid_load": SourcedValue(300.0, "N")}
    values |= {name: SourcedValue(None, "1") for name in GRID_NAMES if name not in values}
    exact = with_film_spread(values, np.zeros(500))["fluid_load"]
    assert exact.interval == pytest.approx((300, 300))
    assert exact.uncertainty == pytest.approx(0)
    draws = FILM_ERROR * normal_draws(0, "film load", 2000)
    low, high = ends(with_film_spread(values, draws)["fluid_load"])
    turned = [300 / (300 + 200 * math.exp(-sign * 1.96 * FILM_ERROR)) for sign in (-1, 1)]
    assert (low, high) == pytest.approx([500 * each for each in turned], rel=0.01)
    low, high = ends(with_film_spread(values, 20 * draws)["fluid_load"])
    assert 0 < low < high <= 500

    def drawn(_: str, count: int) -> np.ndarray:
        return np.resize([200.0, 400.0], count)

    low, high = ends(with_film_spread(values, np.zeros(500), drawn)["fluid_load"])
    assert (low, high) == pytest.approx((200, 400))


@pytest.mark.slow
def test_a_preview_is_as_unsure_as_a_run():
    case = flat()
    march = Continuation(case)
    run_spread = run(case.replace("numerics.tread_positions", 1), quick=True)["cof"].uncertainty
    assert march.cof.uncertainty == pytest.approx(run_spread, rel=0.1)
    seen = march.continue_march({"contaminant.viscosity": "150 cP"})
    assert (seen.cof.uncertainty or 0) > 1.2 * _known(case)


def _known(case: Case) -> float:
    seen = Continuation(case.replace(FACTOR, 2.0)).continue_march(
        {"contaminant.viscosity": "150 cP"}
    )
    return seen.cof.uncertainty or 0.0


@pytest.mark.slow
def test_a_second_calibration_keeps_what_the_first_said_of_the_roughness():
    """Of the untreaded heel's film; a COF above the middle asks for more roughness."""
    case = flat(**{"numerics.tread_positions": 1})
    middle = run(case, quick=True).value("cof")
    first = calibrated_pair([PairReading(case, cof=1.4 * middle, sd=0.003)])
    again = calibrated_pair([PairReading(case, cof=1.4 * middle, sd=0.003)], draws=first.draws)
    leaks = [
        next(values for name, values in each.draws.errors.items() if name.startswith(LEAK))
        for each in (first, again)
    ]
    assert np.median(leaks[0]) > 0.05
    assert np.std(leaks[0]) < 0.95 * BEYOND_DEVIATION
    assert np.median(leaks[1]) > np.median(leaks[0])
