"""Error of the tread model: like treads share it, unlike ones don't, and no order is too sure."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.stats import norm

from underfoot.case import Case
from underfoot.compute.contact_friction import place_of_tread, sole_errors
from underfoot.compute.resolve import resolve_context
from underfoot.compute.run import run
from underfoot.compute.sole import sole_map
from underfoot.friction.tread_error import (
    READING,
    SharedError,
    TreadPair,
    learned_deviation,
    range_density,
    tread_deviation,
    tread_error,
    tread_pairs,
    variance_between,
)
from underfoot.questions.comparison import chance_higher, compare
from underfoot.studies.tread_pairs import computed_pairs, tread_contrasts

SHOE = Case.load("examples/work_shoe_full_tread_glycerol.toml").replace("friction", "pair")
ERROR = SharedError("tread, test", 0.4, of_tread=True)


def tread(pattern="grid", lug=5.0, channel=2.5, depth=3.0, **more):
    lengths = {"lug_width": lug, "channel_width": channel, "depth": depth}
    return {"pattern": pattern, **{k: f"{v} mm" for k, v in lengths.items()}, **more}


def treaded(*args, **more):
    return SHOE.replace("shoe.tread", tread(*args, **more))


def place(case):
    return place_of_tread(case, sole_map(case, 1e-3))


def test_equal_treads_have_no_error_between_them_like_ones_little_and_unlike_ones_all():
    grid, wider, shifted, bars, along, hexagons = (
        place(case)
        for case in (
            treaded(),
            treaded(lug=5.2),
            treaded(offset_along="6 mm"),
            treaded("transverse"),
            treaded("longitudinal"),
            treaded("hexagons"),
        )
    )
    assert variance_between(grid, place(treaded())) == 0.0
    for like in (wider, shifted):
        assert variance_between(grid, like) ** 0.5 < 0.15
    for one, other in ((bars, hexagons), (bars, along), (grid, bars)):
        assert 1.5 < variance_between(one, other) < 2.3
    angles = ("20 deg", "-20 deg")
    mirrored = (place(treaded("bars", angle=angle)) for angle in angles)
    assert variance_between(*mirrored) < 0.02


def test_a_tread_is_the_same_on_finer_cells_and_a_sole_without_one_has_no_error():
    case = treaded("transverse", 6, 3, 4)
    coarse, fine = (place_of_tread(case, sole_map(case, cell)) for cell in (1e-3, 0.5e-3))
    assert variance_between(coarse, fine) ** 0.5 < 0.1
    # bars of 6 mm: 2 / W = 6 mm, channels 3 mm, 4 mm deep, walls all across
    assert coarse[:3] == pytest.approx(np.log2([1 + 10, 1 + 3, 1 + 4]), abs=0.2)
    assert coarse[3] > 1.7
    bare = place(SHOE.replace("shoe.tread", {"pattern": "none"}))
    assert not bare.any()
    assert not ERROR.draws(bare, samples=2000, seed=3).any()


def test_the_field_has_its_deviation_and_correlation_and_is_one_for_all():
    places = [place(treaded(*args)) for args in ((), ("grid", 8), ("transverse",), ("grid", 5.1))]
    drawn = [ERROR.draws(each, samples=2000, seed=3) for each in places]
    for z, at in zip(drawn, places, strict=True):
        assert z.std() == pytest.approx(0.4 * variance_between(at, 0 * at) ** 0.5, rel=1e-6)
        assert z.mean() == pytest.approx(0.0, abs=1e-9)
    for (z, at), (other, there) in pairwise(zip(drawn, places, strict=True)):
        between = 0.4**2 * variance_between(at, there)
        assert (z - other).var() == pytest.approx(between, rel=1e-6)
    assert np.array_equal(drawn[0], ERROR.draws(places[0], samples=2000, seed=3))
    other = replace(ERROR, subject="tread, other").draws(places[0], samples=2000, seed=3)
    assert abs(np.corrcoef(drawn[0], other)[0, 1]) < 0.1


def test_what_a_reading_taught_of_a_tread_holds_for_it_less_for_others():
    read, like, unlike = (place(treaded(*a)) for a in ((), ("grid", 5.2), ("transverse",)))
    known = {ERROR.name(read): 0.3 + 0.05 * np.random.default_rng(1).standard_normal(2000)}
    errors = [ERROR.draws(at, known=known, samples=2000, seed=3) for at in (read, like, unlike)]
    assert errors[0] == pytest.approx(known[ERROR.name(read)], abs=1e-3)
    assert errors[1].mean() == pytest.approx(0.3, abs=0.03)
    assert errors[1].std() < 0.1
    assert abs(errors[2].mean()) < 0.1
    assert errors[2].std() > 0.35


def test_the_deviation_is_that_of_pairs_made_with_it():
    generator, far = np.random.default_rng(2), np.array([3.0, 2, 2, 2, 0, 0])
    apart = variance_between(far, -far)
    for s in (0.2, 0.6):
        ratios = generator.normal(0.0, np.hypot(s * apart**0.5, 2**0.5 * READING), 100)
        pairs = [
            TreadPair(f"{k}", "", "thin", x, x, 0.0, 0.0, far, -far) for k, x in enumerate(ratios)
        ]
        assert learned_deviation(pairs, 0.5) == pytest.approx(s, rel=0.2)
        orders = [replace(pair, low=0.0, high=np.inf, computed=abs(pair.low)) for pair in pairs]
        assert learned_deviation(orders, 0.5) < 0.3  # every order as computed
    assert learned_deviation([], 0.5) == pytest.approx(0.5, rel=0.01)


def test_the_highest_and_lowest_of_many_tell_less_of_each():
    widths = np.linspace(0, 9, 2001)
    for count, mean in ((2, 1.128), (25, 3.931)):  # tables of control charts
        density = range_density(widths, count)
        assert np.trapezoid(density, widths) == pytest.approx(1, abs=1e-3)
        assert np.trapezoid(widths * density, widths) == pytest.approx(mean, rel=0.01)


def test_no_published_order_of_two_treads_is_contradicted_above_90_percent():
    pairs = [pair for pair in tread_pairs() if pair.second.any()]
    assert len({pair.source for pair in pairs}) >= 7
    for pair in pairs:
        between = tread_deviation(pair.fluid) ** 2 * variance_between(pair.first, pair.second)
        higher = norm.cdf(pair.computed / np.hypot(between**0.5, pair.sd))
        rises = pair.low + pair.high > 0
        assert (higher if rises else 1 - higher) > 0.10, pair.effect


def test_the_table_of_pairs_holds_what_the_corpus_publishes():
    published = [(one.source, one.effect) for one in tread_contrasts()]
    assert [(p.source, p.effect) for p in tread_pairs() if p.second.any()] == published


@pytest.mark.study
def test_the_table_of_pairs_is_what_is_computed():
    for found, kept in zip(computed_pairs(), tread_pairs(), strict=True):
        assert found.computed == pytest.approx(kept.computed, abs=0.01), kept.effect
        assert (found.low, found.high) == pytest.approx((kept.low, kept.high), abs=0.02)


def test_draws_of_a_run_hold_the_error_of_its_tread():
    case = treaded().replace("numerics.tread_positions", 1)
    result = run(case, quick=True)
    at, seed = place(case), case.numerics.seed
    samples = result.fields["cof_draws"].size
    error = sole_errors(case, resolve_context(case))["tread_error"]
    assert error == tread_error(0.219)
    off = error.draws(at, samples=samples, seed=seed)
    drawn = np.log(result.fields["cof_draws"].values)
    assert np.polyfit(off, drawn, 1)[0] == pytest.approx(1.0, abs=0.25)
    assert "the model of the tread" in result.labels["cof_spread_from"]


NEAR = (
    ((), (("grid", 5.02), ("grid", 5, 2.52), ("grid", 5, 2.5, 3.02), {"offset_along": "1.3 mm"},
          {"offset_across": "1 mm"}, {"angle": "0.3 deg"})),
    (("transverse",), (("transverse", 5.02), ("transverse", 5, 2.48), ("transverse", 5, 2.5, 2.98),
                       {"offset_along": "3 mm"}, {"offset_along": "6 mm"}, {"angle": "0.3 deg"})),
    (("bars", 6, 2.4, 2.5), (("bars", 6.02, 2.4, 2.5), {"angle": "0.3 deg"})),
    (("hexagons",), (("hexagons", 5.02), {"offset_along": "2 mm"}, {"angle": "0.2 deg"})),
    (("longitudinal",), (("longitudinal", 5.02), {"offset_across": "2 mm"},
                         ("longitudinal", 5, 2.52))),
)  # fmt: skip


@pytest.mark.study
@pytest.mark.parametrize("fluid", ["glycerol_90pct", "water"])
def test_treads_that_nobody_could_tell_apart_are_not_told_apart(fluid):
    """Twenty pairs that differ by 0.02 mm, a third of a degree, or where the pattern begins."""
    count = 0
    for first, others in NEAR:
        one = run(treaded(*first).replace("contaminant", fluid), quick=True)
        for other in others:
            case = treaded(*first, **other) if isinstance(other, dict) else treaded(*other)
            higher = chance_higher(one, run(case.replace("contaminant", fluid), quick=True))
            assert higher is not None
            assert 0.25 < higher < 0.75, other
            count += 1
    assert count == 20


@pytest.mark.slow
def test_a_comparison_that_can_t_tell_names_what_would():
    bars, hexagons = (
        treaded(pattern).replace(
            {"name": pattern, "contaminant": "water", "numerics.tread_positions": 2}
        )
        for pattern in ("transverse", "hexagons")
    )
    unlike = compare(bars, hexagons, quick=True)
    assert "has more friction is open" in unlike.headline()[0]
    assert "COF of both on one tester" in unlike.headline()[1]
    like = compare(bars, bars.replace({"name": "b", "shoe.tread.depth": "3.02 mm"}), quick=True)
    assert "equal for every purpose" in like.headline()[0]
    assert "too small to see" in like.headline()[0]
