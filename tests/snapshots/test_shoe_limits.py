"""What is a sole, its unit, its bodies, its holes and spikes: each limit, just below and above."""

from dataclasses import replace

import numpy as np
import pytest

from snapshot import refusal
from underfoot.core import DataError, InputError
from underfoot.shoe.files import bodies as told
from underfoot.shoe.files.cleaning import clean_height_map, plan_outline, without_ledges
from underfoot.shoe.files.mesh import Mesh, Unmet
from underfoot.shoe.files.no_sole import (
    Shape,
    check_carried,
    check_sole,
    check_surface,
    check_tread,
)
from underfoot.shoe.files.settings import FileSettings, length_unit, likely_unit
from underfoot.shoe.files.view import Soundness

STEP = 1e-3
SOLE = Shape(np.zeros((280, 100)), STEP, 5e-3, 20e-3, 0.5, 1e-5)


def sized(length, width, **more):
    return replace(SOLE, height=np.zeros((length, width)), **more)


def holed(cells):
    height = np.zeros((100, 100))
    height[10 : 10 + cells // 50, 20:70] = np.nan
    return replace(SOLE, height=height)


FINE = {
    "narrow": sized(60, 20, tallness=15e-3), "wide": sized(300, 150), "slender": sized(279, 40),
    "long and broad": sized(201, 134), "short and broad": sized(200, 149),
    "holes": holed(1500), "noise": replace(SOLE, noise=0.5e-3),
    "low": replace(SOLE, tallness=75e-3, standing=0.08),
    "tall": replace(SOLE, tallness=76e-3, standing=0.35),
    "thin but not flat": replace(SOLE, thickness=0.0, height=np.where(
        np.arange(280)[:, None] < 9, 0.021e-3, 0.0) + np.zeros((280, 100))),
    "flat but thick": replace(SOLE, thickness=0.021e-3),
    "tall and long": sized(200, 100, tallness=90e-3, standing=0.4),
}  # fmt: skip
WRONG = {
    "narrow": (sized(60, 19), "narrower"), "wide": (sized(300, 151), "wider"),
    "slender": (sized(281, 40), "7 times as long"),
    "long and broad": (sized(201, 135), "1.5 times as long"),
    "holes": (holed(1550), "holes take"),
    "noise": (replace(SOLE, noise=0.51e-3), "0.51 mm"),
    "low": (replace(SOLE, tallness=75e-3, standing=0.079), "it is no|only 8%"),
    "tall": (replace(SOLE, tallness=76e-3, standing=0.349), "76 mm high, 100 mm wide"),
    "flat": (replace(SOLE, thickness=0.019e-3), "one flat face"),
    "tall and short": (sized(199, 100, tallness=90e-3, standing=0.4), "90 mm high and only"),
}  # fmt: skip


@pytest.mark.parametrize("name", FINE)
def test_what_may_be_a_sole(name):
    check_sole(FINE[name], "a.stl")


@pytest.mark.parametrize("name", WRONG)
def test_what_is_none(name):
    shape, words = WRONG[name]
    with pytest.raises(DataError, match=f"this is no sole: .*({words})"):
        check_sole(shape, "a.stl")


def test_loose_triangles_and_thick_blocks():
    loose = Soundness(10, 2, 1, 21, 0, 0, 0, 1.0)
    assert "no two of its faces" in refusal(check_surface, loose, "a")
    assert "one triangle" in refusal(check_surface, Soundness(1, 0, 0, 3, 0, 0, 0, 0.0), "a")
    check_surface(replace(loose, open_edges=20), "a")
    check_tread(replace(SOLE, thickness=12e-3), False, "a")
    check_tread(replace(SOLE, thickness=1.0), True, "a")
    assert "12.1 mm thick" in refusal(check_tread, replace(SOLE, thickness=12.1e-3), False, "a")


def lugs(count, gap, lug=10, bare=0):
    """Lugs side by side, gaps between; some cells of them are no land."""
    inside = np.zeros((60, count * (lug + gap) - gap), bool)
    for n in range(count):
        inside[:, n * (lug + gap) :][:, :lug] = True
    land = inside.copy()
    land.ravel()[np.flatnonzero(inside)[:bare]] = False
    return inside, land


def test_lugs_without_what_carries_them():
    unmet = (Unmet("a block", True, "Embed it"),)
    for mask, refused in (
        (lugs(3, 4), True), (lugs(2, 4), False), (lugs(3, 4, bare=18), True),
        (lugs(3, 4, bare=19), False), (lugs(6, 1, 10), True),
        (lugs(4, 1, 10), False),
    ):  # fmt: skip
        call = check_carried, *mask, STEP, (), "a"
        if refused:
            assert "are all land" in refusal(*call)
        else:
            check_carried(*mask, STEP, (), "a")
    text = refusal(check_carried, *lugs(3, 4), STEP, unmet, "a")
    assert "not read: a block" in text
    assert "Embed it" in text


def unit(length, width, **more):
    return length_unit(length, width, where="a", **more)


@pytest.mark.parametrize(
    ("length", "width", "name", "kind"),
    [
        (151, 80, 1e-3, "sole"), (149, 80, 1e-3, "forepart"), (349.9, 100, 1e-3, "sole"),
        (110.1, 60, 1e-3, "forepart"), (109, 60, 1e-3, "heel"), (40, 30, 1e-3, "heel"),
        (0.28, 0.1, 1.0, "sole"), (11.0, 4.0, 0.0254, "sole"), (28.0, 10.0, 1e-2, "sole"),
        (6.0, 4.0, 1e-2, "heel"), (4.0, 3.5, 0.0254, "heel"), (12.0, 8.0, 1e-2, "forepart"),
    ],
)  # fmt: skip
def test_the_unit_is_the_first_that_makes_it_a_sole(length, width, name, kind):
    metres, remark = unit(length, width)
    assert metres == name
    assert f"that of a {kind}" in str(remark)
    assert likely_unit(length, width) == name


def test_units_that_are_stated_or_chosen():
    for length, wrong in ((20, False), (19.9, True), (500, False), (501, True)):
        for more in ({"in_file": 1e-3}, {"chosen": "mm"}, {"chosen": "mm", "in_file": 1.0}):
            if wrong:
                assert "the sole is" in refusal(unit, length, 10, **more)
            else:
                assert unit(length, 10, **more)[0] == 1e-3
    assert unit(1999, 10, in_file=1e-3, longest=2.0)[0] == 1e-3
    assert "1.5 m long" in refusal(unit, 1500, 10, in_file=1e-3)
    for length in (351, 39.9, 13.8, 0.039):
        if length == 13.8:
            assert "could also be" not in str(unit(length, 5)[1])
        else:
            text = refusal(unit, length, length / 3) if length != 39.9 else ""
            assert ("no unit makes it a sole" in text) == (length != 39.9)
    assert likely_unit(1000.0, 500.0) == pytest.approx(0.28e-3)
    # 1.7 widths long: a sole first, else a heel first
    assert "could also be" in str(unit(12.0, 6.9)[1])
    for width, first in ((6.4, 0.0254), (6.6, 0.0254)):
        assert unit(11.0, width)[0] in (first, 1e-2)


def test_settings_that_cannot_be():
    assert FileSettings(spacing=2e-5).spacing == 2e-5
    for wrong in (
        {"spacing": 1.99e-5}, {"spacing": 0.0}, {"spacing": float("nan")}, {"region_length": 0.0},
        {"down": "-z", "forward": "+z"}, {"unit": "ft"}, {"side": "flip"}, {"region": "toe"},
    ):  # fmt: skip
        with pytest.raises(InputError):
            FileSettings(**wrong)
    FileSettings(down="-z", forward="+x")
    FileSettings(down="flip", forward="flip")


def test_stray_parts_are_a_fiftieth_or_less():
    for cells, out in ((19, True), (21, False)):
        height = np.full((60, 50), np.nan)
        height[:20] = 1e-3
        height[30, :cells] = 2e-3
        made, remarks = clean_height_map(height, STEP)
        assert np.isfinite(made[30]).any() != out
        assert len(remarks) == 1
        assert (f"1 separate piece of {cells} mm²" in str(remarks[0])) == out
        assert ("2 separate parts" in str(remarks[0])) != out
    # many parts alike are no accident: half of the largest stays
    alike = np.full((200, 40), np.nan)
    for n in range(60):
        alike[3 * n : 3 * n + 2, : 20 if n else 40] = 0.0
    alike[189, :19] = 0.0
    kept = np.isfinite(clean_height_map(alike, STEP)[0])
    assert kept[3].sum() == 20
    assert not kept[189].any()


def test_holes_of_a_square_centimetre_are_filled():
    x = np.arange(60)[:, None] * 1e-4
    for cells, filled in (((10, 10), True), ((10, 11), False)):
        height = np.zeros((60, 60)) + x
        height[20 : 20 + cells[0], 20 : 20 + cells[1]] = np.nan
        made, remarks = clean_height_map(height, STEP)
        assert np.isfinite(made).all() == filled
        assert ("filled from the surface around" in str(remarks[0])) == filled
        assert f"{100 if filled else 110} mm²" in str(remarks[0])
        assert made[25, 0] == height[25, 0]


def test_spikes_stand_out_by_a_millimetre_and_are_narrower_than_three_cells():
    for depth, width, gone in ((1.01e-3, 1, True), (0.99e-3, 1, False), (2e-3, 2, True),
                               (2e-3, 3, False)):  # fmt: skip
        height = np.full((40, 40), 5e-3)
        height[20, 20 : 20 + width] -= depth
        if width > 1:
            height[21 : 20 + width, 20 : 20 + width] -= depth
        made, remarks = clean_height_map(height, STEP)
        assert (made[20, 20] == 5e-3) == gone
        assert bool(remarks) == gone
        if gone:
            assert f"{width**2} cell" in str(remarks[0])
    rim = np.full((40, 40), 5e-3)
    rim[1, 20] = 0.0
    assert not clean_height_map(rim, STEP)[1]


def test_ledges_along_the_rim_stand_a_millimetre_above_what_lies_beside():
    for rise, out in ((1.05e-3, "cut open"), (0.95e-3, ""), (3.5e-3, "cut open"), (3.7e-3, "gone")):
        height = np.zeros((80, 60))
        height[:, 50:] = rise
        land = np.ones((80, 60), bool)
        made, cut_open, remarks = without_ledges(height, land, 0 * height, 0.4e-3, 3e-3)
        assert cut_open[40, 55] == (out == "cut open")
        assert np.isnan(made[40, 55]) == (out == "gone")
        assert bool(remarks) == (out == "gone")
        assert np.isfinite(made[40, :48]).all()


def test_the_outline_of_a_plan_goes_round_its_rows():
    inside = np.zeros((6, 7), bool)
    inside[1:3, 2:5] = inside[3, 1:6] = True
    ring = plan_outline(inside, np.arange(6.0), np.arange(7.0), 1.0)
    assert ring[0].tolist() == ring[-1].tolist() == [0.5, 1.5]
    x, y = ring.T
    area = 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])
    assert area > 0
    assert (x.min(), x.max(), y.min(), y.max()) == (0.5, 3.5, 0.5, 5.5)


def measured(*boxes, names=None, area=None):
    """Bodies with extents (low, high) and the area of their boxes."""
    low, high = (np.array([box[n] for box in boxes], float) for n in (0, 1))
    length, width, height = (high - low).T
    surface = 2 * (length * width + (length + width) * height)
    names = tuple(names or (f"b{n}" for n in range(len(boxes))))
    return told._Bodies(np.eye(3), names, low, high, surface if area is None else np.array(area))


def all_of(found):
    return np.ones(len(found.names), bool)


BODY = ((0, 0, 0), (280, 100, 20))


def test_specks_apart_are_left_out():
    for area, apart, out in ((0.9e-4, 85, True), (1.1e-4, 85, False), (0.9e-4, 83, False)):
        found = measured(BODY, ((280 + apart, 0, 0), (281 + apart, 1, 1)), area=[1.0, area])
        keep, remarks = told._without_islands(found, all_of(found))
        assert keep.tolist() == [True, not out]
        assert bool(remarks) == out


def test_print_supports_are_slender_thin_and_stand_out():
    for size, top, out in (
        ((9, 9, 28), 51, True), ((9, 9, 26), 51, False), ((29, 9, 90), 120, False),
        ((9, 8, 28), 30, True), ((9, 9, 28), 29, False), ((27, 9, 90), 120, True),
    ):  # fmt: skip
        low = (50, 50, top - size[2])
        found = measured(BODY, (low, tuple(np.add(low, size))))
        keep, remarks = told._without_supports(found, all_of(found))
        assert keep.tolist() == [True, not out], (size, top)
        assert bool(remarks) == out
    two = measured(BODY, ((50, 50, 23), (56, 55, 51)), ((70, 50, 23), (78, 59, 51)))
    _, (remark,) = told._without_supports(two, all_of(two))
    assert str(remark).startswith("2 slender bodies (print supports), up to 9 thick")


def test_plates_are_flat_boxes_as_large_as_the_rest():
    plate = ((-20, -20, -5), (300, 120, -1))
    for box, area, out in (
        (plate, 1.0, True), (plate, 1.0009, True), (plate, 1.0012, False),
        (((-20, -20, -30), (300, 120, -1)), 1.0, False),
        (((0, 0, -5), (115, 42, -1)), 1.0, True), (((0, 0, -5), (110, 42, -1)), 1.0, False),
        (((0, 0, 5), (280, 100, 9)), 1.0, False), (((0, 0, 21), (280, 100, 25)), 1.0, True),
        (((-1500, 0, -9), (1299, 100, -1)), 1.0, True),
        (((-1500, 0, -9), (1301, 100, -1)), 1.0, False),
    ):  # fmt: skip
        found = measured(BODY, box)
        found = replace(found, area=found.area * [1.5, area])
        keep, remarks = told._without_plates(found, all_of(found))
        assert keep.tolist() == [True, not out], (box, area)
        assert bool(remarks) == out


def test_a_pair_is_two_of_one_size_beside_each_other():
    for other, area, pair in (
        (((0, 110, 0), (280, 210, 20)), 1.0, True), (((0, 99, 0), (280, 199, 20)), 1.0, False),
        (((0, 110, 0), (288, 210, 20)), 1.0, True), (((0, 110, 0), (290, 210, 20)), 1.0, False),
        (((0, 110, 0), (280, 210, 40)), 1.0, True), (((0, 0, 30), (280, 100, 50)), 1.0, True),
        (((0, 0, 30), (280, 100, 52)), 1.0, False), (((0, 110, 0), (280, 210, 20)), 1.12, False),
        (((0, 110, 0), (280, 210, 20)), 1.1, True), (((290, 0, 0), (570, 100, 20)), 1.0, True),
    ):  # fmt: skip
        found = measured(BODY, other, area=[1.0, area])
        made = told._pair(found, all_of(found))
        assert (made is not None) == pair, (other, area)
        if made:
            assert [one.tolist() for one in made] == [[True, False], [False, True]]
    assert (
        told._pair(measured(BODY, ((0, 110, 0), (280, 210, 20))), np.array([True, False])) is None
    )


def test_how_far_bodies_are_parted_and_which_lie_level():
    low, high = np.array([0.0, 8.0, 20.0]), np.array([10.0, 14.0, 30.0])
    assert told._parting(low, high) == pytest.approx((1 - 2 / 6 + 1) / 2)
    assert told._parting(low[::-1], high[::-1]) == pytest.approx((1 - 2 / 6 + 1) / 2)
    for bottom, side, level in (
        (2.9, 101, True),
        (3.1, 101, False),
        (2.9, 75, True),
        (2.9, 65, False),
    ):
        found = measured(
            ((0, 0, 0), (280, 100, 10)), ((0, side, bottom), (280, side + 100, bottom + 10))
        )
        assert told._level_with(found, 0, 2).tolist() == [False, level]
    assert told._clear([0.031, 0.02])
    assert not told._clear([0.029, 0.0])
    assert not told._clear([0.06, 0.041])
    assert told._clear([0.039, 0.06])


def test_stray_corners_lie_three_sizes_off_and_are_few():
    generator = np.random.default_rng(2)
    soup = generator.uniform(0, 100, (1000, 3, 3)).astype(np.float32)
    low, high = np.percentile(soup.reshape(-1, 3), (1, 99), axis=0)
    reach = 3 * float((high - low).max())
    for off, count, out in ((1.001, 3, True), (0.999, 3, False), (1.001, 4, False)):
        made = soup.copy()
        made.reshape(-1, 3)[: 3 * count : 3, 0] = high[0] + off * reach
        mesh, remarks = told._without_strays(Mesh(made, "made here"))
        assert len(mesh.triangles) == (1000 - count if out else 1000)
        assert bool(remarks) == out
    few, remarks = told._without_strays(Mesh(made[:333], "made here"))
    assert (len(few.triangles), remarks) == (333, [])


@pytest.mark.parametrize(
    ("length", "width"), [(350.0, 100.0), (110.0, 60.0), (40.0, 50.0), (150.0, 60.0)]
)
def test_the_lengths_that_are_named_are_allowed(length, width):
    for unit, factor in (("mm", 1.0), ("m", 1e-3)):
        scale, remark = length_unit(length * factor, width * factor, where="sole")
        assert length * factor * scale == pytest.approx(length * 1e-3)
        assert remark.values["unit"] == unit
