"""The verdict engine: each rule has a test that fails where the rule is taken away."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from underfoot.core import InputError
from underfoot.studies import (
    ComputedQuantity,
    StatementKind,
    Verdict,
    counts,
    judge,
    judge_study,
    read_study,
    studies,
    study,
)
from underfoot.studies.verdict import grid_value


def statement(**given):
    base = {
        "id": "a", "text": "a load", "place": "G.9", "claim": "value", "printed": "100",
        "unit": "N", "tolerance": 10, "reason": "made up", "quantity": "load",
    }  # fmt: skip
    table = {key: value for key, value in (base | given).items() if value is not None}
    return read_study("g9", {"title": "t", "source": "s", "statement": [table]}).statements[0]


def verdict(quantity, **given):
    return judge(statement(**given), {"load": quantity}).verdict


N = "N"


@pytest.mark.parametrize(
    ("value", "wanted"),
    [(100.0, "agrees"), (90.0, "agrees"), (89.9, "disagrees"), (110.1, "disagrees")],
)
def test_a_value_agrees_within_its_tolerance(value, wanted):
    assert verdict(ComputedQuantity.of(value, N)) == wanted


def test_a_probability_below_one_half_never_agrees():
    """100 N lies inside 90 to 110 N; with 20 N of uncertainty it is more likely outside."""
    sure, unsure = (ComputedQuantity.of(100.0, N, deviation=sd) for sd in (10.0, 20.0))
    assert sure.probability(90.0, 110.0) == pytest.approx(0.683, abs=0.005)
    assert unsure.probability(90.0, 110.0) == pytest.approx(0.383, abs=0.005)
    assert verdict(sure) == "agrees"
    assert verdict(unsure) == "overlaps"
    reading = ComputedQuantity.of(
        2.7, N, draws=np.concatenate([np.full(40, 2.7), np.full(60, 100.0)])
    )
    # 40 % lie below 5 N, and the rest twenty times above: nothing is told
    assert verdict(reading, claim="below", printed="5", tolerance=0) == "undecided"


def test_draws_and_deviation_give_the_same_distribution():
    draws = np.random.default_rng(0).normal(100.0, 30.0, 40_000)
    a, b = ComputedQuantity.of(100.0, N, draws=draws), ComputedQuantity.of(100.0, N, deviation=30.0)
    assert a.probability(90, 110) == pytest.approx(b.probability(90, 110), abs=0.01)
    assert a.interval == pytest.approx(b.interval, abs=1.5)


def test_an_interval_that_reaches_the_tolerance_overlaps():
    assert verdict(ComputedQuantity.of(113.0, N, deviation=6.0)) == "overlaps"
    assert verdict(ComputedQuantity.of(120.0, N, deviation=4.0)) == "disagrees"


def test_every_condition_of_a_range_must_lie_in_it():
    given = {"claim": "range", "printed": ["-29", "-16"], "unit": "%", "tolerance": "digits",
             "effect": True}  # fmt: skip
    for values, wanted in (
        ((-0.20, -0.17), "agrees"),
        ((-0.294, -0.156), "agrees"),  # half of the last printed digit
        ((-0.35, -0.17), "overlaps"),
        ((-0.10, -0.02), "trend only"),
        ((-0.10, 0.02), "disagrees"),
        ((-0.10, -0.001), "disagrees"),  # below the digits: no effect
    ):
        assert verdict(ComputedQuantity.of(values), **given) == wanted, values


def test_a_trend_is_there_for_changes_only():
    half = ComputedQuantity.of(0.5)
    assert verdict(half, printed="2", unit="", tolerance=0.1, effect=True) == "trend only"
    assert verdict(half, printed="2", unit="", tolerance=0.1) == "disagrees"


@pytest.mark.parametrize(
    ("claim", "value", "wanted"),
    [("rises", 6.0, "agrees"), ("rises", 4.0, "disagrees"), ("falls", -6.0, "agrees"),
     ("falls", 6.0, "disagrees")],
)  # fmt: skip
def test_signs_need_more_than_the_resolution(claim, value, wanted):
    given = {"claim": claim, "printed": None, "tolerance": None, "resolution": 5}
    assert verdict(ComputedQuantity.of(value, N), **given) == wanted


def test_bounds_are_exclusive_of_what_lies_beyond():
    assert verdict(ComputedQuantity.of(4.9, N), claim="below", printed="5", tolerance=0) == "agrees"
    assert (
        verdict(ComputedQuantity.of(5.1, N), claim="below", printed="5", tolerance=0) == "disagrees"
    )
    assert verdict(ComputedQuantity.of(5.1, N), claim="above", printed="5", tolerance=0) == "agrees"


def on_grids(*values, spacings=(1e-3, 0.5e-3, 0.25e-3)):
    levels = list(zip(spacings[: len(values)], values, strict=True))
    return ComputedQuantity.of(values[-1], N, levels=levels)


def test_one_grid_gives_no_verdict():
    assert verdict(on_grids(100.0)) == "not converged"


def test_a_grid_counts_as_fine_where_the_next_moves_less_than_a_third_of_the_tolerance():
    assert verdict(on_grids(103.3, 100.0)) == "agrees"  # 3.3 N of 10 N
    assert verdict(on_grids(103.4, 100.0)) == "not converged"


def test_a_coarse_grid_that_agrees_does_not_decide():
    """What passes on the first grid and leaves on the next is not judged on the first."""
    assert verdict(on_grids(108.0, 112.0, 112.5)) == "disagrees"


def test_a_steady_approach_is_extrapolated_with_its_error():
    """130, 115, 107.5 on halved grids: Richardson's value is 100 with an error of 7.5."""
    found = grid_value([(1e-3, 130.0), (0.5e-3, 115.0), (0.25e-3, 107.5)], 10.0)
    assert (found.value, found.error, found.converged) == (pytest.approx(100.0), 7.5, True)
    assert verdict(on_grids(130.0, 115.0, 107.5)) == "agrees"
    # 7.5 N of error at 95 N reaches beyond 90 N: it can't be more than an overlap
    assert verdict(on_grids(125.0, 110.0, 102.5)) == "overlaps"


def test_a_value_far_below_any_grid_is_not_extrapolated_to():
    """268, 198, 147 on grids that shrink by 0.6 and 0.7 would end at 28."""
    found = grid_value([(1e-3, 268.0), (0.6e-3, 198.0), (0.42e-3, 147.0)], 10.0)
    assert (found.value, found.converged) == (147.0, False)


def test_what_jumps_between_grids_is_not_extrapolated():
    assert verdict(on_grids(90.0, 115.0, 100.0)) == "not converged"
    assert verdict(on_grids(100.0, 105.0, 115.0)) == "not converged"  # growing steps


def test_a_bound_far_away_needs_no_fine_grid():
    far = {"claim": "below", "printed": "500", "tolerance": 0}
    assert verdict(on_grids(100.0, 130.0), **far) == "agrees"
    near = {"claim": "below", "printed": "132", "tolerance": 0}
    assert verdict(on_grids(100.0, 130.0), **near) == "not converged"


def test_each_condition_of_a_range_needs_its_grid():
    levels = [(1e-3, [-0.20, -0.20]), (0.5e-3, [-0.20, -0.28])]
    quantity = ComputedQuantity.of([-0.20, -0.28], levels=levels)
    given = {"claim": "range", "printed": ["-29", "-16"], "unit": "%", "tolerance": "digits"}
    assert verdict(quantity, **given) == "not converged"


def test_a_solver_without_result_is_no_number_and_no_verdict():
    lost = judge(statement(), {"load": ComputedQuantity.of(math.nan, N)})
    assert lost.verdict is Verdict.NOT_CONVERGED
    assert lost.ours == "-"
    none = judge(statement(), {"load": ComputedQuantity.none("the model has no left side", N)})
    assert none.verdict is Verdict.NOT_COMPARABLE
    assert "no left side" in none.reason


def order(values, chance=None):
    quantity = ComputedQuantity.of(values, names=("hard", "medium", "soft"), chance=chance)
    given = {"claim": "order", "printed": ["soft", "medium", "hard"], "unit": None}
    return verdict(quantity, tolerance=None, resolution=0.1, **given)


def test_orders():
    assert order([1.0, 2.0, 3.0]) == "agrees"
    assert order([2.0, 1.0, 3.0]) == "disagrees"
    assert order([1.0, 1.0, 1.0]) == "disagrees"
    assert order([1.0, 2.0, 3.0], chance=0.4) == "overlaps"
    assert order([2.0, 1.0, 3.0], chance=0.3) == "overlaps"
    assert order([2.0, 1.0, 3.0], chance=0.19) == "undecided"
    assert order([2.0, 1.0, 3.0], chance=0.01) == "disagrees"


def test_a_tie_is_no_agreement():
    """A step below the smallest difference has no sign."""
    assert order([1.0, 1.05, 1.3]) == "disagrees"
    assert order([1.0, 1.11, 1.3]) == "agrees"
    with pytest.raises(InputError, match="tie"):
        statement(claim="order", printed=["a", "b"], unit=None, tolerance=None)
    with pytest.raises(InputError, match="tie"):
        statement(claim="rises", printed=None, tolerance=None)


def test_what_reaches_the_print_by_chance_alone_is_undecided():
    """100 N +- 10: an overlap lies there with a probability of 0.2 and is no wider than 110 N."""
    near, far = (ComputedQuantity.of(v, N, deviation=8.0) for v in (115.0, 120.0))
    assert near.probability(90.0, 110.0) == pytest.approx(0.265, abs=0.005)
    assert verdict(near) == "overlaps"
    assert far.probability(90.0, 110.0) == pytest.approx(0.105, abs=0.005)
    assert verdict(far) == "undecided"
    wide = ComputedQuantity.of(100.0, N, deviation=40.0)
    assert wide.probability(90.0, 110.0) == pytest.approx(0.197, abs=0.005)
    assert verdict(wide) == "undecided"
    share = {"unit": "%", "printed": "54", "tolerance": 20}
    drawn = np.random.default_rng(0).beta(1.0, 1.5, 4000)  # 2 to 90 %
    assert verdict(ComputedQuantity.of(0.4, draws=drawn), **share) == "undecided"


def test_values_of_both_signs_are_no_trend_of_one():
    given = {"claim": "rises", "printed": None, "tolerance": None, "resolution": 5}
    assert verdict(ComputedQuantity.of((6.0, 7.0, -6.0), N), **given) == "overlaps"
    assert (
        verdict(ComputedQuantity.of((6.0, -7.0, -6.0, -8.0, -9.0, -9.0), N), **given) == "undecided"
    )


def quick(value, **given):
    """A quantity of one grid, and a statement that knows that grid's error: 20 % or 3 N."""
    return verdict(on_grids(value), quick_error=["20 %", 3], **given)


def test_a_quick_run_is_judged_with_its_grids_error():
    assert quick(100.0, tolerance=30) == "agrees"  # 80 to 120 within 70 to 130
    assert quick(100.0) == "overlaps"  # beyond 90 to 110
    assert quick(130.0) == "overlaps"  # 104 to 156
    assert quick(150.0) == "disagrees"
    assert quick(4.0, claim="below", printed="5", tolerance=0) == "overlaps"  # 3 N at least
    assert quick(1.0, claim="below", printed="5", tolerance=0) == "agrees"
    assert verdict(on_grids(100.0)) == "not converged"  # no error is known


def test_verdicts_are_steps_from_agreement_to_disagreement():
    assert Verdict.AGREES.step < Verdict.OVERLAPS.step < Verdict.UNDECIDED.step
    assert Verdict.UNDECIDED.step < Verdict.DISAGREES.step
    assert Verdict.NOT_COMPARABLE.step is None


@pytest.mark.parametrize(("scale", "low", "high"), [("log", 0.0, np.inf), ("logit", 0.0, 1.0)])
@given(value=st.floats(0.01, 0.99), deviation=st.floats(0.001, 0.6))
def test_an_interval_stays_within_the_bounds_of_its_quantity(scale, low, high, value, deviation):
    one = ComputedQuantity.of(value, deviation=deviation, scale=scale)
    assert low <= one.interval[0] <= value <= one.interval[1] <= high
    # to first order the spread is the one given
    small = ComputedQuantity.of(value, deviation=1e-4, scale=scale)
    assert small.interval[1] - value == pytest.approx(1.96e-4, rel=0.05)


@pytest.mark.parametrize(
    ("given", "accepted"),
    [
        ({"printed": "0.41", "unit": "", "tolerance": "digits"}, (0.405, 0.415)),
        ({"printed": "-18", "unit": "%", "tolerance": "digits"}, (-0.185, -0.175)),
        ({"printed": "200", "tolerance": "15 %"}, (170.0, 230.0)),
        # 1.96 x 75 / sqrt(11)
        ({"printed": "124", "tolerance": "mean", "deviation": 75, "count": 11}, (79.68, 168.32)),
        # none of 6: 1 - 0.025^(1/6)
        ({"printed": "0", "unit": "%", "tolerance": "share", "count": 6}, (0.0, 0.4593)),
        # tanh(atanh 0.87 -+ 1.96 / sqrt(8))
        ({"printed": "0.87", "unit": "", "tolerance": "correlation", "count": 11},
         (0.5656, 0.9658)),
    ],
)  # fmt: skip
def test_tolerances_follow_from_what_is_printed(given, accepted):
    assert statement(**given).accepted == pytest.approx(accepted, abs=5e-3 * max(accepted))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"tolerance": None}, "tolerance"),
        ({"reason": None}, "reason"),
        ({"tolerance": "mean"}, "count"),
        ({"kind": "nice"}, "nice"),
        ({"unit": "furlong"}, "unknown unit"),
        ({"quantity": None}, "no computed quantity"),
        ({"kind": "restates", "of": "b"}, "unknown statement"),
        ({"claim": "range"}, "printed"),
        ({"claim": "range", "printed": ["3", "2"]}, "lowest first"),
        ({"tolerence": 3}, "Did you mean"),
    ],
)
def test_statements_without_a_reason_or_reference_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        statement(**given)


def tables(*kinds):
    base = {"text": "x", "place": "G.9", "claim": "value", "printed": "1", "tolerance": 0.1,
            "reason": "made up"}  # fmt: skip
    rows = [{**base, "id": f"s{k}", **kind} for k, kind in enumerate(kinds)]
    return read_study("g9", {"title": "t", "source": "s", "statement": rows}).statements


def test_one_reading_can_not_count_twice():
    with pytest.raises(InputError, match="counts once"):
        tables({"quantity": "a"}, {"quantity": "a"})
    tables({"quantity": "a"}, {"quantity": "a", "kind": "restates", "of": "s0"})


def test_the_headline_counts_independent_statements_alone():
    statements = tables(
        {"quantity": "a"}, {"quantity": "b"}, {"quantity": "a", "kind": "restates", "of": "s0"},
        {"quantity": "c", "kind": "report_against_itself"}, {"quantity": "d", "kind": "own_goal"},
        {"quantity": "e", "kind": "calibrated_on"},
        {"quantity": "f", "kind": "alternative", "of": "s0"},
    )  # fmt: skip
    values = dict.fromkeys("acdef", ComputedQuantity.of(1.0)) | {"b": ComputedQuantity.of(2.0)}
    found = counts(judge_study(statements, values))
    assert found[Verdict.AGREES] == 1
    assert found[Verdict.DISAGREES] == 1
    assert sum(found.values()) == 2


def test_a_rival_model_stands_apart():
    """One printed statement, three models tried: only the default one is counted."""
    content = {
        "title": "t", "source": "s",
        "statement": [{
            "id": "a", "text": "x", "place": "G.9", "claim": "value", "printed": "1",
            "tolerance": "digits", "quantity": "default", "alternatives": {"rival": "rival"},
        }],
    }  # fmt: skip
    found = judge_study(
        read_study("g9", content).statements,
        {"default": ComputedQuantity.of(3.0), "rival": ComputedQuantity.of(1.0)},
    )
    assert [one.verdict for one in found] == [Verdict.DISAGREES, Verdict.AGREES]
    assert found[1].statement.kind is StatementKind.ALTERNATIVE
    assert counts(found)[Verdict.AGREES] == 0


def test_units_and_names_must_fit():
    with pytest.raises(InputError, match="Pa"):
        judge(statement(), {"load": ComputedQuantity.of(1.0, "Pa")})
    with pytest.raises(InputError, match='"load"'):
        judge(statement(quantity="laod"), {"load": ComputedQuantity.of(1.0, N)})


def test_quantities_survive_their_file():
    draws = np.random.default_rng(1).lognormal(size=1000)
    one = ComputedQuantity.of(1.0, N, draws=draws, levels=[(1e-3, 1.1), (5e-4, 1.0)])
    other = ComputedQuantity.from_dict(one.to_dict())
    assert other == one
    assert other.probability(0.5, 2.0) == one.probability(0.5, 2.0)


@pytest.mark.parametrize("name", studies())
def test_packaged_statements_are_complete(name):
    chosen = study(name)
    assert chosen.title
    assert "report" in chosen.source
    for one in chosen.statements:
        assert one.not_comparable or one.tolerance_reason, one.name
        low, high = one.accepted
        assert one.claim in ("order", "words") or one.not_comparable or low < high, one.name


def test_studies_are_found_by_name():
    assert study("G1").name == "g1"
    with pytest.raises(InputError, match="unknown study"):
        study("h1")
