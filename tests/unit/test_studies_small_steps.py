"""Steps of studies with a value of their own: a strip's film by quadrature, nested paths, grids."""

import math
from dataclasses import astuple
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from scipy.stats import halfnorm, norm

from underfoot.core import ConvergenceError, SourcedValue
from underfoot.studies import corpus, g1, g2, g3, g4, g5, pair_law, tread_pairs
from underfoot.studies.calibration import profile_figure
from underfoot.studies.corpus import Side, _effects
from underfoot.studies.corpus_cases import _nest_path
from underfoot.studies.runner import Options
from underfoot.studies.validation import _strip_load
from underfoot.studies.verdict import ComputedQuantity, grid_value


@pytest.mark.parametrize(("corner", "slope", "pool"), [(2e-3, 0.02, 1e-4), (5e-3, 0.1, 3e-4)])
def test_a_strip_carries_what_its_pressure_adds_up_to(corner, slope, pool):
    film, viscosity, speed = 2e-5, 0.2, 0.5
    inlet = corner + (pool - film) / slope
    x = np.unique(
        np.concatenate([np.linspace(0, corner, 20001), np.linspace(corner, inlet, 20001)])
    )
    h = film + slope * np.maximum(x - corner, 0.0)
    still = np.trapezoid(h**-2.0, x) / np.trapezoid(h**-3.0, x)
    pressure = 6 * viscosity * speed * cumulative_trapezoid((still - h) / h**3, x, initial=0)
    assert abs(pressure[-1]) < 1e-6 * pressure.max()
    load = _strip_load(film, corner, slope, pool, viscosity=viscosity, speed=speed)
    assert abs(load) == pytest.approx(abs(np.trapezoid(pressure, x)), rel=1e-4)


def test_a_path_is_tables_in_tables():
    assert _nest_path("shoe.tread.lug_width", "5 mm") == {"shoe": {"tread": {"lug_width": "5 mm"}}}
    assert _nest_path("shoe", 1) == {"shoe": 1}


def test_a_probability_is_the_share_of_draws_between_two_ends():
    drawn = ComputedQuantity.of(0.5, draws=np.linspace(0, 1, 100_001))
    assert drawn.probability(0.2, 0.5) == pytest.approx(0.3, abs=0.01)
    assert drawn.probability(-1.0, 0.5) == pytest.approx(0.5, abs=0.01)
    assert drawn.probability(0.9, 2.0) == pytest.approx(0.1, abs=0.01)
    assert drawn.probability(2.0, 3.0) == 0.0
    assert ComputedQuantity.of([1.0, 2.0, 3.0, 4.0]).probability(1.5, 3.5) == 0.5
    assert ComputedQuantity.of(1.0).probability(0.5, 1.5) is None


def test_the_value_of_one_grid_is_that_grid_s_and_not_converged():
    one = grid_value([(1e-3, 7.0)], 1.0)
    assert (one.value, one.converged) == (7.0, False)
    assert math.isnan(grid_value([], 1.0).value)


def effect(name, rises, over, under):
    """Return a published effect of 2 mm and its computed sides."""
    contrast = SimpleNamespace(
        source="s", effect=name, fluid="water", topic="depth", published="", rises=rises, step=2.0
    )
    return contrast, over, under


def test_an_effect_is_judged_by_both_of_its_sides():
    under = Side(0.2, np.full(4, 0.2))
    over = Side(0.3, 0.2 * np.array([2.0, 2.0, 1.0, 0.5]))
    none = Side(math.nan, np.array([math.nan]), "no steady state")
    table, quantities = _effects(
        cast(
            Any,
            [
                effect("rises", True, over, under),
                effect("falls", False, over, under),
                effect("without over", True, none, under),
                effect("without under", True, over, none),
            ],
        )
    )
    rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
    assert [row["verdict"] == "not computed" for row in rows] == [False, False, True, True]
    chances = [row["probability of the sign"] for row in rows]
    assert chances == [0.625, 0.375, None, None]  # a draw that ties counts half
    assert rows[0]["computed ratio"] == pytest.approx(1.5)
    assert rows[0]["per mm"] == pytest.approx(0.05)
    low, high = np.quantile([2.0, 2.0, 1.0, 0.5], (0.025, 0.975))
    assert (rows[0]["low 95 %"], rows[0]["high 95 %"]) == pytest.approx((low, high))
    assert quantities["effects.right_sign"].values[0] == 0.5  # of the two that are computed


def test_a_profile_is_drawn_over_its_parameter_and_no_higher_than_a_thousand():
    profile = SimpleNamespace(
        name="area", unit="1", grid=np.array([1.0, 2.0, 3.0]), profile=np.array([4.0, 0.0, 5e4]),
        misfit=0.0, low=1.5, high=None, fixed="fixed", text=lambda: "",
    )  # fmt: skip
    figure = profile_figure(cast(Any, [SimpleNamespace(profile=profile, default=2.0)]))
    (panel,) = figure.panels
    drawn, _, *ends = panel.layers
    assert [(*one.x, one.label) for one in ends] == [(1.5, "end of 95 %"), (2.0, "default")]
    np.testing.assert_array_equal(drawn.x, [1, 2, 3])
    np.testing.assert_array_equal(drawn.y, [4, 0, 1e3])


def pair(place, low, high):
    """Return a reading of a source, ln COF of ``low`` and ``high`` about a middle."""
    return SimpleNamespace(
        source=place, reading=SimpleNamespace(low=math.exp(low), high=math.exp(high))
    )


def test_a_source_counts_once_and_what_lies_at_an_end_lies_inside():
    """Of a, three of four readings are in -1 to 1, ends among them; b has one, below its interval.

    Rows: known, foretold, median, low, high. Middles of ln COF are 0, 1, 0.5, 3 and -2.
    """
    a = [pair("a", m - 0.1, m + 0.1) for m in (0.0, 1.0, 0.5, 3.0)]
    conditions = [*a, pair("b", -2.1, -1.9)]
    after = [(0, k, 0.5, -1.0, 1.0 + 1e-9) for k in (1, 2, 3, 0)] + [(0, 4, 0.5, -1.0, 2.0)]
    left = SimpleNamespace(draws=np.zeros((3, 5)), conditions=conditions, after=np.array(after))
    table, quantities = corpus._after(cast(Any, [left]))
    rows = [dict(zip(table.columns, row, strict=True)) for row in table.rows]
    assert [(row["source"], row["pairs of readings"]) for row in rows] == [("a", 4.0), ("b", 1.0)]
    assert [row["inside 95 %"] for row in rows] == [0.75, 0.0]
    squares = np.array([1.0, 0.25, 9.0, 0.0])
    assert rows[0]["rms of ln COF, before"] == pytest.approx(math.sqrt(squares.mean()))
    assert rows[0]["the same as the reading"] == pytest.approx(math.sqrt(squares.mean()))
    assert rows[0]["after"] == pytest.approx(math.sqrt((0.25 + 0.0 + 6.25 + 0.25) / 4))
    assert rows[0]["95 % interval, factor"] == pytest.approx(math.exp(2.0))
    assert rows[1]["95 % interval, factor"] == pytest.approx(math.exp(3.0))
    assert quantities["after.inside_95"].values[0] == pytest.approx((0.75 + 0.0) / 2)


def test_the_errors_of_mechanisms_are_two_bars_to_a_line_the_first_on_top():
    def errors(name, *two):
        fluids = [SimpleNamespace(error=error) for error in two]
        return SimpleNamespace(fluids=fluids, mechanism=SimpleNamespace(label=name))

    tests = {"a": errors("A", 0.1, 0.2), "b": errors("B", 0.3, 0.4)}
    (panel,) = g2._error_figure(cast(Any, SimpleNamespace(tests=tests))).panels
    assert list(panel.y_ticks) == ["B", "A"]
    measured, alone = panel.layers
    assert measured.x == [0.3, 0.1]
    assert alone.x == [0.4, 0.2]
    for upper, lower in zip(measured.y, alone.y, strict=True):
        assert upper > lower
        assert round(upper) == round(lower)  # at the line's place, side by side
        assert upper - lower >= measured.width


def test_what_one_input_does_stands_at_its_name_the_largest_on_top():
    def outcome(load, peak):
        return SimpleNamespace(number={g4.LOAD: load, g4.PEAK: peak}.get)

    ranked = [
        SimpleNamespace(path=path, low=outcome(load, 1e3), high=outcome(2 * load, 2e3))
        for path, load in (("shoe.tread.lug_width", 9.0), ("motion.speed", 4.0), ("fluid", 1.0))
    ]
    varied = SimpleNamespace(nominal=outcome(5.0, 1.5e3), ranked_effects=lambda _: ranked)
    figure = g4.inputs_figure(cast(Any, SimpleNamespace(name="c")), cast(Any, varied), count=2)
    for panel, values, nominal in zip(
        figure.panels, ([4, 9, 8, 18], [1, 1, 2, 2]), (5.0, 1.5), strict=True
    ):
        assert list(panel.y_ticks) == ["speed", "lug width"]
        level, low, high = panel.layers
        assert level.x == [nominal]
        assert (low.label, high.label) == ("low end", "high end")
        assert low.x + high.x == pytest.approx(values)
        assert low.y == high.y == [0, 1]


def test_the_pairs_of_the_report_are_the_ends_where_all_others_lie_between():
    """Four draws: so; the first below one other; the last above one other; one other below it."""
    pairs = [("polyurethane", "marble"), ("x", "marble"), ("x", "vinyl"), ("hard rubber", "vinyl")]
    draws = [[9, 5.5, 9, 9], [5, 5, 5, 5], [6, 6, 6, 3], [1, 1, 5.5, 4]]
    splits = {
        name: SimpleNamespace(
            hysteresis=10 * g3.TIE * np.array(drawn), medians=(0.0, float(drawn[0]), {})
        )
        for name, drawn in zip(pairs, draws, strict=True)
    }
    told = g3._ends_of_the_pairs(cast(Any, splits), "hysteresis")
    assert list(told.values) == [9.0, 6.0, 5.0, 1.0]
    assert told.chance == 0.25


def test_a_film_is_compared_by_its_share_at_the_ends_of_what_varies():
    """1 % of a film is left a millisecond a second: by viscosity, by time, by speed."""
    thick, middle, thin = g5.CURVES
    kept = {
        (thin, 0.5): (10, 5), (middle, 0.5): (40, 24), (thick, 0.5): (80, 70),
        (middle, g5.HELD_SPEEDS[0]): (5, 1), (middle, g5.HELD_SPEEDS[-1]): (85, 80),
    }  # fmt: skip
    films = [
        g5.HeldFilm(v, s, np.array([0.0, 0.05, 0.2, g5.HELD_FOR]), np.array([100, 90, early, late]))
        for (v, s), (early, late) in kept.items()
    ]
    told = {name: each.values[0] for name, each in g5._wedge_squeeze_quantities(films).items()}
    assert told == pytest.approx(
        {"film.viscosity": 0.70, "film.dwell": 0.24 - 0.90, "film.speed": 0.80}
    )


@pytest.mark.parametrize("processes", [1, 2, None])
def test_full_slips_are_computed_side_by_side_where_processes_may_be_started(
    monkeypatch, processes
):
    """Then they are 0.8 of the work; with one process each population is a fourth of all."""
    filled, seen, solved = [], [], []

    def side_by_side(_, function, cases, keys, **__):
        assert function is g5.fill_cache
        assert keys == [case.hash for case in cases]
        filled.extend(case.hash for case in cases)
        return iter(cases)

    def slips(case, *, progress):
        solved.append(case.hash)
        progress("slips", 1.0)
        if len(solved) == len(g5.GRIDS) * len(g5.COUNTS):
            raise ConvergenceError("enough", where="test")

    monkeypatch.setattr(g5, "cached_arrays", side_by_side)
    monkeypatch.setattr(g5, "slips", slips)
    options = Options(processes=processes, progress=lambda _, share, *__: seen.append(share))
    with pytest.raises(ConvergenceError, match="enough"):
        g5.compute(options)
    assert len(set(solved)) == 4
    if processes == 1:
        assert filled == []
        assert seen == pytest.approx([0.25, 0.5, 0.75, 1.0])
    else:
        assert filled == solved
        assert seen == pytest.approx([0.2, 0.4, 0.6, 0.8, 0.84, 0.88, 0.92, 0.96])


def test_the_error_of_a_pair_of_treads_is_half_of_what_two_thirds_of_its_draws_span(monkeypatch):
    """Draws whose logarithms are normal: their standard deviation."""
    share = (np.arange(4000) + 0.5) / 4000
    drawn = np.append(1.5, np.exp(0.4 + 0.3 * norm.ppf(share)))
    monkeypatch.setattr(
        tread_pairs, "resolve_context", lambda _: SimpleNamespace(viscosity_value=0.2)
    )
    monkeypatch.setattr(tread_pairs, "_place", lambda _: ())
    pair = tread_pairs._pair("made", "up", cast(Any, None), (0.1, 0.2), drawn, np.zeros(6))
    assert pair.sd == pytest.approx(0.3, rel=0.01)
    assert pair.computed == pytest.approx(math.log(1.5))


def test_a_line_through_the_origin_has_the_slope_of_the_weighted_least_squares():
    x, weight = np.array([[1.0], [2.0], [4.0]]), np.array([1.0, 0.5, 2.0])
    at = np.array([[3.0], [-1.0]])
    np.testing.assert_allclose(pair_law._line(x, 0.7 * x[:, 0], weight, at), [2.1, -0.7])
    bent = np.array([1.0, 2.0, 0.0])  # slope (1 + 0.5 * 4) / (1 + 0.5 * 4 + 2 * 16)
    np.testing.assert_allclose(pair_law._line(x, bent, weight, at), at[:, 0] * 3 / 35)


def test_the_decay_speeds_of_a_figure_lie_about_their_product_with_the_viscosity():
    fluids = {
        name: SimpleNamespace(
            cof_boundary=SourcedValue(0.2, uncertainty=0.02),
            tau_hydro=SourcedValue(2e-3 / viscosity, "m/s", uncertainty=0.1),
            viscosity=viscosity,
        )
        for name, viscosity in zip(g2.LABELS, (5e-4, 1e-3, 2e-3, 4e-3, 6e-3, 8e-3), strict=True)
    }
    figure = g2._levels_figure(cast(Any, fluids))
    (curve,) = [each for each in figure.panels[1].layers if each.label.startswith("viscosity ×")]
    np.testing.assert_allclose(np.array(curve.x) * np.array(curve.y), 2.0)  # mPa m
    assert "= 2.00 mPa m" in curve.label


def test_films_over_the_roughness_are_those_of_five_hundredths_to_one_metre_a_second(monkeypatch):
    asked: list[float] = []

    def film(viscosity, entrainment_speed, **_):
        asked.append(entrainment_speed)
        return None, viscosity * entrainment_speed

    monkeypatch.setattr(g2, "soft_ehl_film", film)
    pin = SimpleNamespace(sole_rq=3e-6, floor_rq=4e-6, normal_force=1, radius=1, modulus=1)
    points = {name: SimpleNamespace(viscosity=0.1) for name in g2.LABELS}
    ratios = g2.lambda_ratios(cast(Any, SimpleNamespace(pin=pin, points=points)), count=3)
    ends = asked[0], asked[2]
    assert ends == pytest.approx((0.05, 1.0))
    for name in g2.LABELS:
        assert ratios[name][[0, 2]] == pytest.approx(0.1 * np.array(ends) / 5e-6)


def test_the_prior_of_the_law_is_normal_and_its_spreads_are_half_normal_but_the_first():
    prior = np.array([[0.5, 2.0], [-1.0, 0.3]])
    theta = np.array([[0.5, -1.0], [2.0, -1.4], [-1.0, -0.5]])
    ln_spread = np.array(
        [[-1.1, -0.9, -1.6, -1.0], [-0.7, -1.5, -2.0, -0.4], [-1.5, -0.3, -1.0, -2]]
    )
    exact = norm.logpdf(theta, *prior.T).sum(axis=1)
    exact += norm.logpdf(ln_spread[:, 0], np.log(pair_law.SD_SOURCE), 0.35)
    spread = np.exp(ln_spread[:, 1:])
    density = halfnorm.logpdf(spread, scale=pair_law.SPREAD_PRIOR[1:])
    exact += (density + ln_spread[:, 1:]).sum(axis=1)  # over the logarithm
    told = pair_law._log_prior(prior, theta, ln_spread)
    np.testing.assert_allclose(told - told[0], exact - exact[0])


def test_the_analysis_of_variance_has_a_row_for_each_effect_beside_what_is_printed(monkeypatch):
    chances = {"sole": 1e-6, "floor": 0.2, "sole:floor": 0.03}
    monkeypatch.setattr(g3, "expected_analysis", lambda splits, take: chances)
    table = g3._analysis_table({})
    assert table.name == "analysis_of_variance"
    assert table.title.startswith("Analysis of variance")
    assert [row[2] for row in table.rows[:3]] == ["below 0.0001", "0.2", "0.03"]
    assert [row[3] for row in table.rows[:3]] == ["p < 0.01", "not named", "p < 0.01"]


def test_every_series_of_the_matrix_has_its_quantities(monkeypatch):
    def outcomes(cases, mesh, processes):
        for case in cases:
            row = g1.MatrixRow(*astuple(case), *[0.1 * case.speed] * 7, "converged", "", 1.0)
            yield row, {name: np.arange(3.0) for name in g1.HISTORY}

    monkeypatch.setattr(g1, "outcomes", outcomes)
    monkeypatch.setattr(g1, "figures", lambda *_: ())
    quantities = g1.compute(Options(quick=True)).quantities
    for name in g1.SERIES:
        own = {each: quantities[each] for each in quantities if each.startswith(f"{name}.")}
        assert f"{name}.hysteresis.largest" in own
        assert len(own) > 1
