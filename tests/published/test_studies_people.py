"""Studies g5 and g6 and their calibration: arithmetic, and the cheap lines computed anew."""

from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.case import build
from underfoot.slip import ReportG6
from underfoot.studies import g5, g6_people, g6_soles
from underfoot.studies.g6_people import PRINTED_ACOF, PRINTED_RISK
from underfoot.studies.verdict import Verdict, compared_mean


def law_cof(shore, law):
    case = g6_soles.sole_case(shore, law)
    found = build.friction_law(case, case.catalogue)
    pressure = np.array([266.1e3])
    parts = found(pressure, np.array([0.3]), np.array([1e-3]))
    return float((parts.adhesion + parts.hysteresis)[0] / 266.1e3)


def test_real_contact_area_puts_the_softer_outsole_first_and_films_the_harder_one():
    """The report: soft highest (G.6.2)."""
    area = [law_cof(shore, "bowden_tabor") for shore in (50, 60, 70)]
    films = [law_cof(shore, "asperity_ehl") for shore in (50, 60, 70)]
    assert area[0] > area[1] > area[2]
    assert films[0] < films[1] < films[2]
    assert law_cof(50, "stribeck") == law_cof(70, "stribeck") == pytest.approx(0.185, abs=1e-3)
    assert area[2] > 0.13
    assert area[0] < 0.22  # around the printed 0.159 to 0.182


def test_the_pins_strength_gives_the_pins_friction_back():
    strength, left = g6_soles.pin_strength()
    from underfoot.calibrate import pin_on_disk
    from underfoot.core.catalogue import Catalogue
    from underfoot.friction import self_affine_scale
    from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION

    pin = pin_on_disk(Catalogue.load())
    rules = g6_soles.sole_case(60.0, "stribeck").interface
    scale = self_affine_scale(
        STYLUS_RESOLUTION,
        rq=rules.roughness_beyond_cutoff * np.hypot(pin.sole_rq, pin.floor_rq),
        longest_wave=rules.longest_wave,
        hurst=rules.hurst,
    )
    share = float(scale.contact_fraction(pin.pressure / pin.modulus))
    assert strength * share / pin.pressure + left == pytest.approx(
        0.111 + 0.359 * np.exp(-0.3 / 0.19), abs=1e-6
    )


def test_printed_risks_and_the_printed_logistic_are_not_of_one_population():
    implied = g6_people.implied_differences()
    assert implied["acof_slope"] == pytest.approx(-103.8, abs=0.1)
    assert implied["median"] == pytest.approx(-0.0331, abs=1e-4)
    model = ReportG6()
    assert model(0.2 + implied["highest"], 0.2) == pytest.approx(0.925)
    at = {name: g6_people.population_risk(acof)["report_g6"] for name, acof in PRINTED_ACOF.items()}
    assert at["hard"] == pytest.approx(0.339, abs=1e-3)
    assert at["hard"] < PRINTED_RISK["hard"]
    assert at["soft"] > PRINTED_RISK["soft"]


def test_risk_by_rcof_is_that_of_the_report_to_its_rounding_but_for_the_median():
    lowest, middle, highest = g6_people.risk_by_rcof()
    assert lowest == pytest.approx(0.015, abs=0.002)  # printed 3 %
    assert middle == pytest.approx(0.225, abs=0.005)  # printed 26 %
    assert highest == pytest.approx(0.83, abs=0.005)  # printed 83 %


def test_the_sampled_studies_scatter_around_the_printed_logistic():
    slopes, halves = g6_people.precision_of_published(draws=60, seed=3)
    assert -60 < np.median(slopes) < -40
    assert np.median(halves) == pytest.approx(-0.06, abs=0.01)
    low, high = np.percentile(slopes, [2.5, 97.5])
    assert low < -54.7  # slopes of other studies lie within what 52 trials leave open
    assert high > -41.2


def test_computed_slips_follow_the_difference_of_frictions():
    found = g6_people.slips({"a": 0.10, "b": 0.17, "c": 0.30}, own_speed=False, subjects=20)
    assert found.share["a"] == 1.0
    assert found.share["c"] == 0.0
    assert found.share["a"] > found.share["b"] > found.share["c"]
    assert found.fit.slope < 0
    assert -0.1 < found.fit.half < 0


def test_rows_of_correlations():
    generator = np.random.default_rng(1)
    x, y = generator.normal(size=(2, 5, 11))
    wanted = [np.corrcoef(a, b)[0, 1] for a, b in zip(x, y, strict=True)]
    assert g5.correlations(x, y) == pytest.approx(wanted)
    assert np.isnan(g5.correlations(np.ones((1, 4)), np.arange(4.0)[None]))[0]


def made_up(count, generator):
    speed = generator.normal(1.5, 0.3, count)
    subjects = [
        SimpleNamespace(
            seen=SimpleNamespace(
                crossed=True, peak_speed=v, peak_pressure=1e5 * v, duration=0.07,
                row_peaks=(1e5 * v, 8e4 * v, 5e4 * v),
            )
        )
        for v in speed
    ]  # fmt: skip
    return SimpleNamespace(
        subjects=subjects, of=lambda name: np.array([getattr(s.seen, name) for s in subjects])
    ), speed


def test_bands_of_studies_as_small_as_the_reports():
    study, speed = made_up(400, np.random.default_rng(2))
    bands = g5.study_bands(study, 11, samples=4000)
    half = 1.96 * speed.std() / np.sqrt(11)
    assert bands["peak_speed"] == pytest.approx(
        (speed.mean() - half, speed.mean() + half), abs=0.02
    )
    assert bands["correlation"] == pytest.approx((1.0, 1.0))
    assert bands["last_over_first"] == pytest.approx((0.5, 0.5))
    assert g5.study_bands(study, 11) == g5.study_bands(study, 11)  # seeded


def test_verdicts_on_means():
    assert compared_mean(1.57, 0.80, 11, 1.9) is Verdict.REPRODUCED
    assert compared_mean(1.57, 0.80, 11, 2.3) is Verdict.WITHIN_SCATTER
    assert compared_mean(1.57, 0.80, 11, 2.5, trend=True) is Verdict.TREND_ONLY
    assert compared_mean(1.57, 0.80, 11, 2.5, trend=False) is Verdict.DISAGREES
    assert compared_mean(1.57, 0.80, 11, float("nan")) is Verdict.NOT_AVAILABLE


def test_g5_shares_every_parameter_with_g4():
    from pathlib import Path

    from underfoot.case import Case

    folder = Path(__file__).parents[2] / "examples"
    tester = Case.load(folder / "work_shoe_untreaded_glycerol.toml")
    ours = g5.slip_case("untreaded")
    assert ours.interface == tester.interface
    assert ours.models == tester.models
    assert ours.shoe.heel == tester.shoe.heel
    assert ours.contaminant == tester.contaminant
    example = Case.load(folder / "human_slip_untreaded.toml")
    assert ours.slip == example.slip
    assert ours.shoe == example.shoe
