"""Contact friction of a pair: its limits and signs, and what the fit recovers."""

import numpy as np
import pytest

from underfoot.calibrate.corpus import Condition, Reading, Span
from underfoot.calibrate.pair_law import fitted, law_named, scored
from underfoot.friction.pair_contact import PairConstants, contact_terms

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
