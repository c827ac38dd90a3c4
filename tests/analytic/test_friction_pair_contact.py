"""Contact friction of a pair: its limits and signs, and what the fit recovers."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import norm

from underfoot.friction.pair_contact import (
    FULL_CONTACT,
    Pair,
    PairConstants,
    PairDraws,
    contact_terms,
)
from underfoot_studies.pair_law import _covariance, fitted, law_named, scored
from underfoot_studies.sources import Condition, Reading, Span

ONE = PairConstants(*(np.array([value]) for value in (0.10, 0.08, 0.35, 8e-4, 0.8, 1.2, 0.15)))
PAIR = {"viscosity": 5e-3, "speed": 0.3, "sole_rq": 8e-6, "floor_rq": 2e-6, "shore_a": 60.0}


def parts(numbers, family="aqueous"):
    film, hysteresis, dry, kappa = contact_terms(ONE, numbers, family=family)
    return film, hysteresis, dry * np.exp(-numbers["viscosity"] * abs(numbers["speed"]) / kappa)


def cof(family="aqueous", **changes):
    return sum(parts({**PAIR, **changes}, family)).item()


def test_limits_of_drag():
    assert cof(speed=0.0) == pytest.approx(0.10 + 0.025 + 0.35)
    assert cof(speed=1e6) == pytest.approx(0.10 + 0.025)
    assert cof(speed=1e6, family="oil") == pytest.approx(0.08 + 0.025)
    assert cof(speed=0.0, family="detergent") == pytest.approx(0.8 * (0.10 + 0.35) + 0.025)


def test_at_the_reference_roughness_the_dry_part_falls_to_1_over_e_at_kappa():
    film, hysteresis, dry = parts(
        {**PAIR, "viscosity": 8e-4 / 0.3, "sole_rq": 8.3e-6, "floor_rq": 1e-12}
    )
    assert dry == pytest.approx(0.35 / np.e, rel=1e-6)
    assert film == pytest.approx(0.10)
    assert hysteresis == pytest.approx(0.0, abs=1e-6)


def test_signs_of_speed_roughness_hardness_and_direction():
    assert cof(speed=0.1) > cof(speed=0.3) > cof(speed=1.0)
    assert cof(sole_rq=12e-6) > cof(sole_rq=2e-6)
    assert cof(floor_rq=8e-6) > cof(floor_rq=0.5e-6)
    assert cof(shore_a=50.0) > cof(shore_a=80.0)
    assert cof(speed=-0.3) == cof(speed=0.3)
    assert cof(floor_rq=1e-3) - cof(floor_rq=1e-3, speed=1e9) >= 0  # hysteresis is bounded
    assert cof(floor_rq=1e-3, speed=1e9) == pytest.approx(0.10 + 0.15)


def made_up(source, drag, cof, kind="value"):
    """A reading of a pair on which nothing but the drag varies."""
    numbers = {
        name: Span(value, value) for name, value in {**PAIR, "viscosity": drag / 0.3}.items()
    }
    high = cof if kind == "value" else np.inf
    return Condition(source, kind, numbers, {"fluid": "aqueous"}, Reading(kind, cof, high, 0.05))


@pytest.mark.slow
def test_the_fit_recovers_the_constants_of_made_up_sources():
    generator = np.random.default_rng(4)
    drags = np.geomspace(1e-4, 1e-1, 6)
    rows = []
    for source in range(12):
        shared = generator.normal(0, 0.3)
        for drag in drags:
            truth = np.log(cof(viscosity=drag / 0.3)) + shared + generator.normal(0, 0.08)
            rows.append(made_up(f"lab {source}", drag, float(np.exp(truth))))
    posterior = fitted(law_named("pair"), rows, steps=400)
    film, dry = np.exp(posterior.theta[:, 0]), np.exp(posterior.theta[:, 2])
    for draws, truth in ((film, 0.10), (dry, 0.35), (posterior.spreads[:, 0], 0.3)):
        low, high = np.quantile(draws, (0.01, 0.99))
        assert low < truth < high
        assert high < 4 * low
    # an unseen laboratory lies inside the interval about as often as it says
    score = scored(posterior.predicted(rows), rows)
    assert 0.9 <= score.inside_95.mean() <= 1.0
    assert 0.4 <= score.inside_50.mean() <= 0.8


def test_a_bound_scores_by_the_probability_beyond_it():
    draws = np.random.default_rng(0).normal(np.log(0.2), 0.5, (4000, 1))
    row = made_up("lab", 1e-3, 0.2, kind="lower")
    score = scored(draws, [row])
    assert np.exp(score.log_density[0]) == pytest.approx(0.5, abs=0.03)
    assert score.error[0] == pytest.approx(0.0, abs=0.03)


def test_skewed_draws_score_by_mean_and_spread_and_err_by_their_median():
    draws = np.log([[0.1], [0.1], [0.1], [0.8]])
    score = scored(draws, [made_up("lab", 1e-3, 0.2)])
    expected = norm.logpdf(np.log(0.2), draws.mean(), draws.std())
    assert score.log_density[0] == pytest.approx(expected)
    assert score.error[0] == pytest.approx(np.log(2))


def test_readings_of_a_source_share_laboratory_pair_and_dry_part():
    spread = np.array([[0.3, 0.2, 0.1, 0.5]])
    weight, noise = np.array([[1.0, 0.4]]), np.array([[0.01, 0.02]])
    for same in (0.0, 1.0):
        found = _covariance(spread, weight, np.array([[1.0, same], [same, 1.0]]), noise)[0]
        assert found[0, 1] == found[1, 0] == pytest.approx(0.09 + 0.04 * same + 0.25 * 0.4)
        assert found[0, 0] == pytest.approx(0.09 + 0.04 + 0.25 + 0.01)
        assert found[1, 1] == pytest.approx(0.09 + 0.04 + 0.25 * 0.16 + 0.02)


def test_hardness_acts_on_adhesion_and_hysteresis_alike():
    soft, hard = (contact_terms(ONE, {**PAIR, "shore_a": a}, family="oil") for a in (50.0, 75.0))
    ratios = [(a / b).item() for a, b in zip(soft[:3], hard[:3], strict=True)]
    assert ratios == pytest.approx([ratios[0]] * 3)
    assert ratios[0] > 1.05


def test_sole_and_floor_make_one_roughness():
    one, other = (
        contact_terms(ONE, {**PAIR, "sole_rq": a, "floor_rq": b}, family="oil")[3]
        for a, b in ((3e-6, 7e-6), (7e-6, 3e-6))
    )
    assert one == pytest.approx(other)


COUNT = 4000
DRAWS = PairDraws(
    PairConstants(*(np.full(COUNT, getattr(ONE, name).item()) for name in ONE.__slots__)),
    np.full(COUNT, 0.3), np.full(COUNT, 0.5), np.full(COUNT, 0.1), np.full(COUNT, 0.1),
)  # fmt: skip
KNOWN = Pair(60.0, (8e-6, 8e-6), (2e-6, 2e-6), "aqueous")


def test_errors_of_laboratory_dry_part_and_pair_have_their_own_spread_and_draws():
    drawn = KNOWN.drawn(DRAWS, 3)
    errors = np.log([drawn[name] for name in ("laboratory", "dry", "pair")])
    assert errors.std(axis=1) == pytest.approx([0.3, 0.5, 0.1], rel=0.02)
    assert np.abs(np.corrcoef(errors) - np.eye(3)).max() < 0.05


def test_hardness_and_roughness_that_are_not_known_are_drawn():
    exact = KNOWN.drawn(DRAWS, 3)["film"]
    assert np.ptp(exact) == 0.0
    spread = replace(KNOWN, shore_a_deviation=3.0, polymer="P").drawn(DRAWS, 3)["film"]
    one_more = replace(KNOWN, shore_a=63.0).drawn(DRAWS, 3)["film"][0]
    slope = np.log(exact[0] / one_more)
    assert np.log(spread).std() == pytest.approx(slope, rel=0.03)
    dry = replace(KNOWN, family="dry", sole_rq=(1e-12, 1e-12), floor_rq=(1e-6, 100e-6))
    rq = dry.drawn(DRAWS, 3)["full_contact"] / FULL_CONTACT
    quartiles = np.quantile(rq, [0.25, 0.5, 0.75])
    assert quartiles == pytest.approx([1e-6 * 100**share for share in (0.25, 0.5, 0.75)], rel=0.01)
