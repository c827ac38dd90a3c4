"""What a published effect becomes when it is computed: cases, or the reason why there are none."""

import math

import pytest

from underfoot.studies.corpus_cases import contrasts, stand, verdict, whole_shoe_stands
from underfoot.studies.sources import corpus, read_source

BLOCK = {"device": "block", "fluid": "water"}


def test_each_packaged_effect_yields_cases_or_a_reason():
    sources = corpus()
    rows = [one for source in sources for one in contrasts(source)]
    assert {one.effect.split(":")[0] for one in rows} == {
        effect.id for source in sources for effect in source.effects
    }
    for one in rows:
        for side in (one.over, one.under):
            assert bool(side.cases) != bool(side.reason), one.effect
        if one.topic != "fluid" and not one.reason:
            pairs = zip(one.over.cases, one.under.cases, strict=True)
            assert all(over.hash != under.hash for over, under in pairs), one.effect
    assert not [one.reason for one in rows if one.reason]


def test_every_condition_of_whole_shoes_has_cases():
    shoes = [one for source in corpus() for one in whole_shoe_stands(source)]
    assert len(shoes) == 25
    assert all(side.cases and not side.reason for _, side in shoes)


def test_open_numbers_take_their_geometric_middle_and_are_named():
    one = stand({**BLOCK, "shore_a": [36, 64], "sole_ra": "4 um", "floor_rq": "2 um"})
    (case,) = one.cases
    assert case.shoe.material.shore_a == pytest.approx(48)
    assert case.shoe.roughness.rq == pytest.approx(4e-6 * math.sqrt(math.pi / 2), rel=1e-3)
    assert case.contaminant.viscosity == pytest.approx(1e-3)
    assert {"shore_a", "viscosity", "speed", "size"} <= set(one.taken)
    assert not {"sole_rq", "floor_rq"} & set(one.taken)


def test_an_open_roughness_becomes_two_cases():
    """A quarter and three quarters of the way from 1.25 to 10 um, evenly in the logarithm."""
    smooth, rough = stand({**BLOCK, "floor_rq": "2 um"}).cases
    assert smooth.shoe.roughness.rq == pytest.approx(1.25e-6 * 8**0.25, rel=1e-3)
    assert rough.shoe.roughness.rq == pytest.approx(1.25e-6 * 8**0.75, rel=1e-3)
    assert smooth.floor.roughness.rq == rough.floor.roughness.rq == pytest.approx(2e-6)


def test_a_drop_pad_touches_longer_with_deeper_grooves():
    pad = {"device": "drop pad", "fluid": "water", "compound": "neolite"}
    shallow, deep = (
        stand({**pad, "tread": {"pattern": "grooves", "depth": depth}})
        for depth in ("1 mm", "5 mm")
    )
    assert 0.5 < shallow.contact_time < deep.contact_time < 1
    assert {"pool", "drop", "pull time"} <= set(deep.taken)
    assert stand(BLOCK).contact_time == 1


def test_grooves_lie_as_printed_and_land_sets_the_grid():
    along, across = (
        stand({**BLOCK, "tread": {"pattern": "grooves", "direction": way}}).cases[0].shoe.tread
        for way in ("along", "across")
    )
    assert (along.name, across.name) == ("longitudinal", "transverse")
    shoe = {"device": "whole shoe", "fluid": "oil", "tread": {"land": 0.36}}
    case = stand(shoe).cases[0]
    assert case.shoe.tread.lug_width == pytest.approx(6e-3)
    assert case.shoe.tread.channel_width == pytest.approx(4e-3)
    assert case.contaminant.chemistry == "oil"
    assert (case.motion.speed, case.motion.normal_force) == (0.3, 500.0)
    assert math.degrees(case.motion.shoe_angle) == pytest.approx(7)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"fluid": None}, "names no fluid"),
        ({"device": "ramp"}, "ramp is no device"),
        ({"shoe_angle": "backwards"}, "is not a number with a unit"),
        ({"wear": "slihgt"}, 'Did you mean "slight"'),
        ({"tread": {"pattern": "grove"}}, 'Did you mean "grooves"'),
        ({"tread": {"edge_radius": "9 mm"}}, "does not fit on the lug"),
    ],
)
def test_a_condition_that_cannot_be_computed_is_named_with_the_reason(change, reason):
    one = stand({**BLOCK, **change})
    assert not one.cases
    assert reason in one.reason


def test_an_order_and_a_slope_become_pairs_of_cases(tmp_path):
    path = tmp_path / "someone_2020.toml"
    path.write_text(
        """
reference = "Someone 2020"
read = "abstract"
[[effect]]
id = "worn"
kind = "order"
sequence = [
  { wear = "new" }, { wear = "slight", change = "up" }, { wear = "through", change = "down" }
]
fluids = ["oil"]
conditions = { device = "whole shoe" }
[[effect]]
id = "depth"
kind = "slope"
per = "tread.depth"
low = 0.02
high = 0.1
over = ["1 mm", "5 mm"]
fluids = ["water"]
conditions = { device = "drop pad", tread = { pattern = "grooves" } }
"""
    )
    slight, through, depth = contrasts(read_source(path))
    assert (slight.rises, through.rises) == (True, False)
    assert slight.over.cases == through.under.cases
    assert [side.cases[0].shoe.wear.depth for side in (slight.under, slight.over)] == [0, 1e-3]
    assert depth.step == pytest.approx(4)
    assert depth.published == "per mm 0.02 to 0.1"
    depths = [side.cases[0].shoe.tread.depth for side in (depth.over, depth.under)]
    assert depths == pytest.approx([5e-3, 1e-3])


@pytest.mark.parametrize(
    ("ratio", "chance", "word"),
    [
        (1.2, 0.8, "right"),
        (0.8, 0.8, "right"),
        (1.2, 0.6, "undecided"),
        (0.7, 0.2, "wrong"),
        (1.01, 0.99, "absent"),
    ],
)
def test_the_verdict_follows_the_probability_unless_nothing_happens(ratio, chance, word):
    assert verdict(ratio, chance) == word
