"""Free treads: symmetries, smallest widths and share of land of drawn ones; what is refused."""

from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from underfoot.case import Case, load
from underfoot.case.free_tread import TERMS, keeps
from underfoot.compute.sole import new_sole, sole_map
from underfoot.core import InputError
from underfoot.shoe.free_land import free_land

ROOT = Path(__file__).parents[2]
CELL, LAND, CHANNEL = (0.022, 0.018), 3e-3, 2.5e-3
TREAD = {
    "pattern": "free",
    "depth": "3 mm",
    "lug_width": "3 mm",
    "channel_width": "2.5 mm",
    "land": 0.6,
    "cell_length": "22 mm",
    "cell_width": "18 mm",
}
SPACING = 1e-4


def drawn(symmetry, seed, land=0.6):
    """Return the land of drawn coefficients that keep a symmetry; of the first that has one."""
    generator = np.random.default_rng(seed)
    for _ in range(10):
        terms = tuple((n, generator.uniform(-1, 1)) for n in TERMS if keeps(symmetry, n))
        try:
            return free_land(terms, CELL, land, LAND, CHANNEL)
        except InputError:
            continue
    raise AssertionError("no draw has both widths")


def case(**tread) -> Case:
    return load(ROOT / "examples" / "work_shoe_full_tread_detergent.toml").replace(
        {"shoe.tread": TREAD | {"cos1_cos1": 1.0} | tread}
    )


IMAGES = {
    "mirror": lambda x, y: (x, -y),
    "two_fold": lambda x, y: (-x, -y),
    "both": lambda x, y: (-x, y),
    "glide": lambda x, y: (x + CELL[0] / 2, -y),
}


@pytest.mark.slow
@pytest.mark.parametrize("symmetry", IMAGES)
def test_a_tread_is_its_own_image(symmetry):
    x, y = np.random.default_rng(1).uniform(-0.03, 0.03, (2, 3000))
    land = drawn(symmetry, 2)
    here = land.channel_distance(x, y)
    assert land.channel_distance(*IMAGES[symmetry](x, y)) == pytest.approx(here, abs=2e-6)
    for shift in np.diag(CELL):
        assert land.channel_distance(x + shift[0], y + shift[1]) == pytest.approx(here, abs=1e-9)
    others = drawn("none", 2)  # ... and not by itself
    apart = others.channel_distance(*IMAGES[symmetry](x, y)) - others.channel_distance(x, y)
    assert np.abs(apart).max() > 1e-3


def beyond_discs(mask, width):
    """Return how far (m) the farthest place of a mask lies from the discs of a width within it."""
    inside = (distance_transform_edt(mask) - 0.5) * SPACING >= width / 2 - SPACING / 2
    assert inside.any()
    away = distance_transform_edt(~inside) * SPACING - (width / 2 - SPACING / 2)
    edge = round(6e-3 / SPACING)  # discs that are cut at the border of the picture
    part = np.s_[edge:-edge, edge:-edge]
    return float(away[part][mask[part]].max())


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_land_and_channels_are_made_of_discs_of_the_smallest_widths(seed):
    land = drawn("none" if seed % 2 else "mirror", seed)
    x, y = (np.arange(-6e-3, side + 6e-3, SPACING) for side in CELL)
    into = land.channel_distance(*np.meshgrid(x, y, indexing="ij"))
    assert beyond_discs(into <= 0, LAND) < 1.5 * SPACING
    assert beyond_discs(into > 0, CHANNEL) < 1.5 * SPACING
    # a measure that would see it: discs half a millimetre wider do not fit everywhere
    assert max(beyond_discs(into <= 0, LAND + 2e-3), beyond_discs(into > 0, CHANNEL + 2e-3)) > 2e-4


@pytest.mark.slow
def test_share_of_land_is_what_was_asked_and_what_the_outlines_hold():
    x, y = (np.arange(SPACING / 2, side, SPACING) for side in CELL)
    place = np.meshgrid(x, y, indexing="ij")
    areas = []
    for share in (0.45, 0.55, 0.65):
        land = drawn("mirror", 3, share)
        areas.append(land.area / np.prod(CELL))
        assert areas[-1] == pytest.approx(share, abs=0.0101)
        assert (land.channel_distance(*place) <= 0).mean() == pytest.approx(areas[-1], abs=2e-3)
    assert areas == sorted(areas)


@pytest.mark.slow
def test_distances_are_those_to_the_nearest_wall():
    land = drawn("none", 5)
    rng = np.random.default_rng(0)
    x, y = rng.uniform(0, 0.02, (2, 400))
    walls = land.segments.reshape(-1, 2, 2)
    walls = np.concatenate(
        [walls + np.multiply(CELL, (i, j)) for i in range(-2, 3) for j in range(-2, 3)]
    )
    begin, way = walls[:, 0], walls[:, 1] - walls[:, 0]
    place = np.stack([x, y], axis=-1)[:, None]
    share = np.clip(((place - begin) * way).sum(axis=2) / (way * way).sum(axis=1), 0, 1)
    beside = place - begin - share[..., None] * way
    nearest = np.hypot(beside[..., 0], beside[..., 1]).min(axis=1)
    assert np.abs(land.channel_distance(x, y)) == pytest.approx(nearest, abs=2e-5)


def test_one_wave_along_the_shoe_is_bars_across_it():
    free = case(cos1_cos1=0.0, cos1_cos0=1.0, land=0.5)
    lug = free.shoe.tread.letters().area / CELL[1]
    assert lug == pytest.approx(0.5 * CELL[0], abs=0.01 * CELL[0])
    bars = case().replace(
        {
            "shoe.tread": {
                "pattern": "transverse",
                "depth": "3 mm",
                "lug_width": lug,
                "channel_width": CELL[0] - lug,
                "offset_along": -lug / 2,
            }
        }
    )
    ours, theirs = (sole_map(one, 1e-3) for one in (free, bars))
    assert np.array_equal(ours.land, theirs.land)
    assert ours.land_area == pytest.approx(theirs.land_area, rel=1e-4)
    inside = ours.inside
    assert ours.clearance[inside] == pytest.approx(theirs.clearance[inside], abs=1e-9)
    assert ours.cut.area == pytest.approx(theirs.cut.area, abs=0.01)


def test_a_factor_of_all_coefficients_changes_nothing():
    one = case(cos1_cos1=1.0, sin1_cos0=0.5).shoe.tread.letters()
    assert case(cos1_cos1=0.5, sin1_cos0=0.25).shoe.tread.letters() == one


def test_a_file_holds_it(tmp_path):
    one = case(sin1_cos2=-0.25, mould_draft="2 deg")
    one.save(tmp_path / "free.toml")
    again = load(tmp_path / "free.toml")
    assert again == one
    assert again.hash == one.hash
    assert again.hash != case(sin1_cos2=-0.24, mould_draft="2 deg").hash
    assert new_sole(again).tread == new_sole(one).tread


@pytest.mark.parametrize(
    ("wrong", "where", "words"),
    [
        ({"land": 0.0}, "land", 'pattern = "none"'),
        ({"land": 1.0}, "land", 'pattern = "none"'),
        ({"channel_width": "19.5 mm"}, "channel_width", "below 19 mm"),
        ({"cos1_cos1": 0.0}, "tread", "cos1_cos0 = 1"),
        ({"mould_draft": "20 deg"}, "mould_draft", "depth up to 2.75 mm"),
        ({"sin1_sin1": 0.5}, "sin1_sin1", 'symmetry = "none"'),
        ({"channel_width": "8 mm", "lug_width": "8 mm"}, "land", "Take smaller lug_width"),
        ({"cell_width": "101 mm"}, "cell_width", "up to 100 mm"),
        ({"cos1_cos1": 1.5}, "cos1_cos1", "-1 to 1"),
        ({"depth": "30 mm"}, "depth", "outsole"),
    ],
)
def test_what_is_no_tread_is_refused_with_a_remedy(wrong, where, words):
    with pytest.raises(InputError) as refused:
        case(**wrong)
    assert words in str(refused.value)
    assert where in str(refused.value)


def test_one_land_and_one_channel_fit_the_longer_side_of_the_cell():
    """22 mm by 18 mm: 16.5 mm of land leave 5.5 mm for a channel along it."""

    for channel, room in (("3 mm", True), ("5.4 mm", True), ("5.6 mm", False)):
        with pytest.raises(InputError) as refused:
            case(lug_width="16.5 mm", channel_width=channel)
        assert ("no room" not in str(refused.value)) == room, channel
