"""Contact friction of a pair: its limits and signs, and what the fit recovers."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

from underfoot.friction.law import PIN_PRESSURE
from underfoot.friction.pair_contact import (
    FULL_CONTACT,
    STEEPEST,
    Pair,
    PairConstants,
    PairDraws,
    contact_terms,
    real_slope,
    relative_area,
)
from underfoot.studies.corpus import readings
from underfoot.studies.pair_law import (
    FEATURE_RIVALS,
    _covariance,
    features,
    fit_law,
    laboratory_left_out,
    law_named,
    log_likelihood,
    middle,
    one_reading,
    r2,
    score_predictions,
    weights,
)
from underfoot.studies.sources import PublishedCondition, PublishedReading, Span

ONE = PairConstants(*(np.array([value]) for value in (0.10, 0.08, 0.35, 8e-4, 0.8, 1.2, 0.15)))
PAIR = {"viscosity": 5e-3, "speed": 0.3, "sole_rq": 8e-6, "floor_rq": 2e-6, "shore_a": 60.0}


def terms(family="aqueous", **changes):
    return contact_terms(ONE, {**PAIR, **changes}, family=family)


def cof(family="aqueous", **changes):
    numbers = {**PAIR, **changes}
    one = terms(family, **changes)
    drag = numbers["viscosity"] * abs(numbers["speed"])
    return (one.adhesion(PIN_PRESSURE, drag) + one.hysteresis).item()


HYSTERESIS_2UM = 0.0125 * 2 / np.hypot(1, 0.105 * 2 / STEEPEST)


def test_limits_of_drag():
    """At 8.2 um and 2 um the area is a little below that of 8.3 um alone."""
    area = relative_area(PIN_PRESSURE, terms().full_contact).item()
    assert 0.95 < area < 1
    assert cof(speed=0.0) == pytest.approx(area * 0.45 + HYSTERESIS_2UM)
    assert cof(speed=1e6) == pytest.approx(0.10 + HYSTERESIS_2UM)
    assert cof(speed=1e6, family="oil") == pytest.approx(0.08 + HYSTERESIS_2UM)
    assert cof(speed=0.0, family="detergent") == pytest.approx(0.8 * area * 0.45 + HYSTERESIS_2UM)


def test_at_the_reference_roughness_the_dry_part_falls_to_1_over_e_at_kappa():
    one = terms(sole_rq=1e-12, floor_rq=8.3e-6)
    assert one.kappa == pytest.approx(8e-4)
    assert one.adhesion(PIN_PRESSURE, 8e-4) == pytest.approx(0.45 / np.e + 0.10 * (1 - 1 / np.e))
    assert terms(floor_rq=1e-12).hysteresis == pytest.approx(0.0, abs=1e-6)


def test_signs_of_speed_roughness_hardness_and_direction():
    assert cof(speed=0.1) > cof(speed=0.3) > cof(speed=1.0)
    assert cof(sole_rq=12e-6) > cof(sole_rq=2e-6)
    assert cof(floor_rq=8e-6) > cof(floor_rq=0.5e-6)
    assert cof(shore_a=50.0) > cof(shore_a=80.0)
    assert cof(speed=-0.3) == cof(speed=0.3)
    assert cof(floor_rq=1e-3, speed=1e9) == pytest.approx(
        0.25, rel=1e-3
    )  # of which 0.15 hysteresis


def made_up(source, drag, cof, kind="value"):
    """A reading of a pair on which nothing but the drag varies."""
    numbers = {
        name: Span(value, value) for name, value in {**PAIR, "viscosity": drag / 0.3}.items()
    }
    high = cof if kind == "value" else np.inf
    reading = PublishedReading(kind, cof, high, 0.05)
    name = f"{kind} {drag:g}"
    return PublishedCondition(
        source, name, numbers, {"fluid": "aqueous"}, reading, laboratory=source
    )


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
    posterior = fit_law(law_named("pair"), rows, steps=3000)
    film, dry = np.exp(posterior.theta[:, 0]), np.exp(posterior.theta[:, 2])
    for draws, truth in ((film, 0.10), (dry, 0.35), (posterior.spreads[:, 0], 0.3)):
        low, high = np.quantile(draws, (0.01, 0.99))
        assert low < truth < high
        assert high < 4 * low
    # an unseen laboratory lies inside the interval about as often as it says
    latent, noise = posterior.predicted(rows)
    score = score_predictions(latent + noise * generator.normal(size=latent.shape), rows)
    assert 0.9 <= score.inside_95.mean() <= 1.0
    assert 0.4 <= score.inside_50.mean() <= 0.8


def test_a_bound_scores_by_the_probability_beyond_it():
    draws = np.random.default_rng(0).normal(np.log(0.2), 0.5, (4000, 1))
    row = made_up("lab", 1e-3, 0.2, kind="lower")
    score = score_predictions(draws, [row])
    assert np.exp(score.log_density[0]) == pytest.approx(0.5, abs=0.03)
    assert score.error[0] == pytest.approx(0.0, abs=0.03)


@pytest.mark.parametrize("median", [0.8, 0.2, 0.08])
def test_a_bound_is_inside_by_the_share_of_the_draws_it_allows(median):
    """A bound of 0.2 below, at and above the median: half of an interval, less, or nothing."""
    draws = np.random.default_rng(0).normal(np.log(median), 0.5, (40_000, 1))
    score = score_predictions(draws, [made_up("lab", 1e-3, 0.2, kind="lower")])
    allowed = norm.sf(np.log(0.2), np.log(median), 0.5)
    for found, level in ((score.inside_50, 0.5), (score.inside_95, 0.95)):
        high, low = (1 + level) / 2, max((1 - level) / 2, 1 - allowed)
        assert found[0] == pytest.approx(max(0.0, high - low) / allowed, abs=0.02)


def test_two_studies_of_one_laboratory_are_two_testers():
    """The first error of a study moves all of its readings, and none of another's."""
    rows = [made_up(name, 1e-3, 0.2) for name in ("one", "one", "two")]
    rows = [replace(row, laboratory="one laboratory", labels={**row.labels, "floor": str(at)})
            for at, row in enumerate(rows)]  # fmt: skip
    law = law_named("one constant")
    posterior = fit_law(law, [])
    fixed = replace(posterior, theta=np.zeros_like(posterior.theta),
                    spreads=np.tile([0.3, 0.1, 0.1, 0.0], (len(posterior.theta), 1)))  # fmt: skip
    latent, _ = fixed.predicted(rows)
    together = np.cov(latent.T)
    assert together[0, 1] == pytest.approx(0.09, rel=0.1)
    assert abs(together[0, 2]) < 0.01


def test_skewed_draws_score_by_mean_and_spread_and_err_by_their_median():
    draws = np.log([[0.1], [0.1], [0.1], [0.8]])
    score = score_predictions(draws, [made_up("lab", 1e-3, 0.2)])
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


def test_values_and_bounds_of_one_laboratory_have_their_joint_probability():
    """Values exactly; bounds as scipy integrates them, to a percent at a correlation of 0.6."""
    covariance = 0.3 * np.array([[1.0, 0.6, 0.6], [0.6, 1.0, 0.6], [0.6, 0.6, 1.0]])
    mean = np.array([-1.0, -1.4, -0.8])
    low, high = np.array([-1.2, -1.3, -np.inf]), np.array([-1.2, np.inf, -0.7])

    def found(low, high):
        return log_likelihood(mean[None], covariance[None], low, high)[0]

    alone = np.array([-1.2, -1.1, -0.9])
    joint = multivariate_normal(mean, covariance)
    assert found(alone, alone) == pytest.approx(joint.logpdf(alone))
    gain = covariance[1:, 0] / covariance[0, 0]
    rest = multivariate_normal(
        mean[1:] + gain * (low[0] - mean[0]),
        covariance[1:, 1:] - np.outer(gain, gain) * covariance[0, 0],
    )
    both = rest.cdf([np.inf, -0.7]) - rest.cdf([-1.3, -0.7])
    value = norm.logpdf(low[0], mean[0], covariance[0, 0] ** 0.5)
    assert found(low, high) == pytest.approx(value + np.log(both), abs=0.01)
    far = found(np.array([-1.2, 5.0, -np.inf]), np.array([-1.2, np.inf, np.inf]))
    assert -np.inf < far < -20


def test_a_laboratory_counts_once_and_a_curve_of_it_once():
    rows = [made_up("one", 1e-3, 0.2), made_up("two", 1e-3, 0.2), made_up("two", 2e-3, 0.2)]
    curve = [replace(made_up("two", d, 0.2), id="curve") for d in (3e-3, 4e-3)]
    found = weights([*rows, *curve])
    assert found == pytest.approx([1, 1 / 3, 1 / 3, 1 / 6, 1 / 6])
    y = np.log([0.1, 0.2, np.nan])
    assert r2(y, y, np.ones(3)) == 1.0
    assert r2(y, np.full(3, y[:2].mean()), np.ones(3)) == pytest.approx(0.0)


def test_a_bound_has_no_middle_and_a_range_its_own():
    lower, value = made_up("one", 1e-3, 0.2, kind="lower"), made_up("one", 1e-3, 0.3)
    ranged = replace(value, reading=PublishedReading("range", 0.1, 0.4, 0.1))
    assert np.exp(middle([lower, value, ranged])) == pytest.approx([np.nan, 0.3, 0.2], nan_ok=True)
    assert features([value])[0] == pytest.approx(
        [np.log(1e-3), np.log(8e-6), np.log(2e-6), 60.0, 0.0]
    )


def test_one_reading_moves_the_rest_of_its_source_by_what_they_share():
    """Two readings with a common error: the conjugate normal mean, and the interval about it."""
    generator = np.random.default_rng(1)
    shared = generator.normal(size=(40_000, 1))
    latent = np.log(0.2) + 0.5 * shared * np.ones((1, 2))
    noise = np.full((40_000, 2), 0.25)
    rows = [made_up("lab", 1e-3, 0.4), made_up("lab", 2e-3, 0.3)]
    (first, second) = one_reading(rows, latent, noise)
    gain = 0.5**2 / (0.5**2 + 0.25**2)
    assert first[2] == pytest.approx(np.log(0.2) + gain * np.log(2), abs=0.03)
    sd = np.hypot(0.5 * np.sqrt(1 - gain), 0.25)
    assert second[4] - second[3] == pytest.approx(2 * 1.96 * sd, rel=0.05)
    curve = [replace(row, id="one curve") for row in rows]
    assert len(one_reading(curve, latent, noise)) == 0


@pytest.mark.parametrize(("rival", "off"), [*zip(FEATURE_RIVALS, (1e-9, 0.4, 0.1), strict=True)])
def test_a_regression_foretells_a_laboratory_that_lies_on_its_line(rival, off):
    """Seven laboratories on one power law of the drag; other features are noise."""
    generator = np.random.default_rng(2)
    rows = []
    for source in range(7):
        for drag in np.geomspace(1e-4, 1e-1, 8):
            row = made_up(f"lab {source}", drag, 0.05 * drag**-0.2)
            for name in ("sole_rq", "floor_rq", "shore_a"):
                middle_value = row.numbers[name].low * float(np.exp(generator.normal(0, 0.1)))
                row.numbers[name] = Span(middle_value, middle_value)
            row.labels["fluid"] = "oil" if generator.random() < 0.5 else "aqueous"
            rows.append(row)
    left = laboratory_left_out(rival, rows, "lab 3")
    assert left.expected == pytest.approx(middle(left.conditions), abs=off)
    # the error is that of the six others, each left out in turn: as small as this one's
    assert left.draws.std(axis=0).max() < max(off, 1e-6)


def test_the_priors_alone_hold_no_answer():
    """About the mean of each source of three and more values they explain nothing.

    Of two values an order is all there is, and the form of the law has one: rough floors grip more.
    """
    every = readings()
    law, found = law_named("pair"), {}
    for laboratory in dict.fromkeys(c.laboratory for c in every):
        left = laboratory_left_out(law, every, laboratory, data=False)
        median = np.median(left.draws, axis=0)
        for source in dict.fromkeys(c.source for c in left.conditions):
            at = [i for i, c in enumerate(left.conditions) if c.source == source]
            measured = middle([left.conditions[i] for i in at])
            if np.isfinite(measured).sum() > 2:
                found[source] = r2(measured, median[at], np.ones(len(at)))
    assert len(found) >= 4
    assert max(found.values()) <= 0.0, found


def test_hardness_acts_on_adhesion_alone():
    """Hysteresis hardly depends on the modulus where contact is partial (Persson theory)."""
    soft, hard = (terms("oil", shore_a=a) for a in (50.0, 75.0))
    assert soft.film / hard.film == pytest.approx(soft.rest / hard.rest)
    assert soft.film > 1.05 * hard.film
    assert soft.hysteresis == hard.hysteresis


def test_sole_and_floor_make_one_area_and_drain_apart():
    one, other = (terms("oil", sole_rq=a, floor_rq=b) for a, b in ((3e-6, 7e-6), (7e-6, 3e-6)))
    assert one.full_contact == pytest.approx(other.full_contact)
    assert one.kappa > other.kappa


COUNT = 4000
DRAWS = PairDraws(
    PairConstants(*(np.full(COUNT, getattr(ONE, name).item()) for name in ONE.__slots__)),
    np.full(COUNT, 0.3), np.full(COUNT, 0.5), np.full(COUNT, 0.1), np.full(COUNT, 0.1),
)  # fmt: skip
KNOWN = Pair(60.0, (8e-6, 8e-6), (2e-6, 2e-6), "aqueous")


def test_errors_of_laboratory_dry_part_and_pair_have_their_own_spread_and_draws():
    drawn = KNOWN.draw_inputs(DRAWS, 3)
    errors = np.log([drawn[name] for name in ("laboratory", "rest", "pair")])
    errors[1] = np.log(drawn["rest"] - drawn["film"])
    assert errors.std(axis=1) == pytest.approx([0.3, 0.5, 0.1], rel=0.02)
    assert np.abs(np.corrcoef(errors) - np.eye(3)).max() < 0.05


def test_hardness_and_roughness_that_are_not_known_are_drawn():
    exact = KNOWN.draw_inputs(DRAWS, 3)["film"]
    assert np.ptp(exact) == 0.0
    spread = replace(KNOWN, shore_a_deviation=3.0, polymer="P").draw_inputs(DRAWS, 3)["film"]
    one_more = replace(KNOWN, shore_a=63.0).draw_inputs(DRAWS, 3)["film"][0]
    slope = np.log(exact[0] / one_more)
    assert np.log(spread).std() == pytest.approx(slope, rel=0.03)
    dry = replace(KNOWN, family="dry", sole_rq=(1e-12, 1e-12), floor_rq=(1e-6, 100e-6))
    slope = dry.draw_inputs(DRAWS, 3)["full_contact"] / FULL_CONTACT
    quartiles = np.quantile(slope, [0.25, 0.5, 0.75])
    expected = [real_slope(1e-6 * 100**share) for share in (0.25, 0.5, 0.75)]
    assert quartiles == pytest.approx(expected, rel=0.01)
