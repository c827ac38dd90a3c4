"""How a sole lies in its file: each decision just below and just above its limit.

Of ``underfoot.shoe.files.orientation``.
"""

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from underfoot.shoe.files import orientation as way
from underfoot.shoe.files.settings import FileSettings
from underfoot.shoe.files.view import View

STEP = 1e-3
AUTO = FileSettings()


def seen(lowest, highest, facing=None, axes=None):
    facing = np.where(np.isfinite(lowest), -1, 0) if facing is None else facing
    return View(np.eye(3) if axes is None else axes, (0.0, 0.0), STEP, lowest, highest,
                facing.astype(np.int8))  # fmt: skip


FLAT = np.zeros((80, 50))


def test_a_rim_rises_by_the_difference_of_its_lower_fifth():
    """Ring and core of a full map: percentile 20 of both, two cells wide."""
    generator = np.random.default_rng(1)
    height = generator.random(FLAT.shape)
    core = np.zeros(FLAT.shape, bool)
    core[2:-2, 2:-2] = True
    height[~core] += 0.3
    expected = np.percentile(height[~core], 20) - np.percentile(height[core], 20)
    assert way._rim_rise(height) == pytest.approx(expected, rel=1e-12)
    assert way._rim_rise(np.full((20, 20), np.nan)) == 0.0
    assert way._rim_rise(np.zeros((4, 20))) == 0.0  # nothing is within
    assert way._rim_rise(np.full((7, 7), 1.0)) == 0.0  # specks of fewer than 50 cells


def bars(share, depth=3e-3, width=8):
    """Land with channels 8 cells wide over a share of its length."""
    height = FLAT.copy()
    count = round(share * FLAT.shape[0] / width)
    for n in range(count):
        height[(n + 1) * FLAT.shape[0] // (count + 1) - width // 2 :][:width] = depth
    return height


def ground(view, **settings):
    return way.ground_side(view, FileSettings(**settings))


def test_the_side_of_more_channels_is_the_ground():
    above = FLAT + 0.02
    for lowest, highest, sign in ((bars(0.3), above, 1), (FLAT, above - bars(0.3), -1),
                                  (bars(0.3), above - bars(0.1), 1)):  # fmt: skip
        made = ground(seen(lowest, highest))
        assert (made.sign, made.assumed) == (sign, False)
        assert "from the tread" in str(made.remark)
        turned = ground(seen(lowest, highest), down="flip")
        assert (turned.sign, "option down" in str(turned.remark)) == (-sign, True)
    # 30 % against 20 % is the ratio of 1.5, which does not decide; nor do too few channels
    shares = [way.tread_share(bars(share), STEP) for share in (0.3, 0.2)]
    assert shares == pytest.approx([0.3, 0.2])
    told = str(ground(seen(bars(0.3), above - bars(0.2))).remark)
    assert "from the tread" not in told
    few = FLAT.copy()
    for width, decides in ((2, False), (3, True)):
        few[40 : 40 + width] = 3e-3
        assert way.tread_share(few, STEP) == pytest.approx(width / 80)
        assert ("from the tread" in str(ground(seen(few, above)).remark)) == decides
    assert (ground(seen(FLAT, above), down="+z").sign, str(
        ground(seen(FLAT, above), down="+z").remark)) == (-1, "")  # fmt: skip


def test_channels_are_narrower_than_fifty_and_shallower_than_twelve_millimetres():
    assert way.tread_share(bars(0.3, 11.9e-3), STEP) == pytest.approx(0.3)
    assert way.tread_share(bars(0.3, 12.1e-3), STEP) == 0.0


def test_a_rim_that_turns_up_is_the_ground_where_no_tread_tells():
    rim = np.full(FLAT.shape, 1.0)
    rim[2:-2, 2:-2] = 0.0
    for rise, sign, assumed in ((0.51e-3, 1, False), (0.49e-3, 1, True), (-0.51e-3, -1, False)):
        lowest = FLAT + max(rise, 0.0) * rim
        highest = FLAT + 0.02 - max(-rise, 0.0) * rim
        made = ground(seen(lowest, highest))
        assert (made.sign, made.assumed) == (sign, assumed)


def test_normals_tell_the_side_of_a_sheet():
    for apart, thin in ((0.049e-3, True), (0.051e-3, False)):
        for share, sign in ((0.2, 1), (0.8, -1)):
            facing = np.where(np.arange(80)[:, None] < 80 * share, 1, -1) + 0 * FLAT
            made = ground(seen(FLAT, FLAT + apart, facing))
            assert made.assumed != thin
            assert made.sign == (sign if thin else 1)
    for share, told in ((20 / 80, False), (19 / 80, True), (60 / 80, False), (61 / 80, True)):
        facing = np.where(np.arange(80)[:, None] < 80 * share, 1, -1) + 0 * FLAT
        assert ground(seen(FLAT, FLAT, facing)).assumed != told
    for axes, sign in ((np.eye(3), 1), (-np.eye(3), -1), (np.eye(3)[[1, 2, 0]], 1),
                       (np.eye(3)[[1, 2, 0]] * [[1], [1], [-1]], -1)):  # fmt: skip
        assert ground(seen(FLAT, FLAT + 0.02, axes=axes)).sign == sign


def plan(length, width, *, near=True, far=True):
    """A rectangle of cells with its ends square, or round (half an ellipse) where not."""
    x = np.arange(length)[:, None] + 0.5
    y = np.abs(np.arange(width)[None] + 0.5 - width / 2) / (width / 2)
    round_ = width / 2 * (1 - np.sqrt(np.maximum(1 - y**2, 0)))
    inside = np.ones((length, width), bool)
    if not near:
        inside &= x > round_
    if not far:
        inside &= length - x > round_
    return inside


def toe(mask, **settings):
    return way.toe_end(mask, STEP, FileSettings(**settings))


def test_a_piece_with_one_straight_end_is_a_heel_up_to_its_size():
    """A heel is cut at its front, a forepart at its rear; longer pieces are whole soles."""
    # lengths are between the first and the last cell
    for length, width, forepart in (
        (110, 80, False), (112, 80, True), (90, 85, False), (90, 87, True),
    ):  # fmt: skip
        made = toe(plan(length, width, far=False))
        assert made.assumed
        assert ("forepart" in str(made.remark)) == forepart
        assert made.sign == (1 if forepart else -1)
        turned = toe(plan(length, width, near=False))
        assert turned.sign == -made.sign
        assert toe(plan(length, width, near=False), forward="flip").sign == made.sign
        assert str(toe(plan(length, width), forward="+x").remark) == ""
    for length, piece in ((2.15 * 40, True), (2.3 * 40, False)):
        made = toe(plan(round(length), 40, near=False))
        assert made.assumed == piece


def test_the_broader_end_is_the_toe_where_it_is_broader_by_enough():
    for share, told in ((0.09, False), (0.1, True)):
        x = np.arange(780)[:, None]
        y = np.abs(np.arange(300)[None] + 0.5 - 150)
        inside = y < 120 * (1 + share * (x / 780 - 0.5))
        inside &= plan(780, 300, near=False, far=False)
        offset = way.off_centre(inside, 0)
        assert (offset > 0.005) == told
        assert toe(inside).assumed != told
        assert toe(inside).sign == 1
        assert toe(inside[::-1]).sign == -1
        assert way.off_centre(inside[::-1], 0) == pytest.approx(-offset, abs=1e-12)


def test_how_far_off_its_middle_a_centroid_lies():
    mask = np.zeros((9, 4), bool)
    mask[2:4, :1] = mask[4:6] = True
    assert way.off_centre(mask, 0) == pytest.approx((37.0 / 10 + 0.4 - 3.5) / 4 - 0.15, abs=0.2)
    counts = np.array([1, 1, 4, 4])
    centroid = float((counts * np.arange(2, 6)).sum() / 10)
    assert way.off_centre(mask, 0) == pytest.approx((centroid - 3.5) / 4)


def test_an_end_is_cut_where_it_is_nearly_as_wide_at_four_as_at_sixteen_millimetres():
    for wide, cut in ((41, True), (40, False)):
        mask = np.zeros((60, 50), bool)
        mask[:] = True
        mask[:5] = np.abs(np.arange(50) + 0.5 - 25) < 1 + 5 * np.arange(5)[:, None]
        mask[4] = np.arange(50) < wide
        assert way.cut_ends(mask, 0, STEP)[0] == cut
        assert way.cut_ends(mask[::-1], 0, STEP)[1] == cut
        assert way.cut_ends(mask.T, 1, STEP)[0] == cut
    short = np.ones((3, 50), bool)
    assert way.cut_ends(short, 0, STEP) == (True, True)


def test_a_line_may_lie_up_to_twenty_five_degrees_off_square():
    x, y = np.arange(200)[:, None], np.arange(60)[None]
    for degrees, line in ((24.0, True), (26.0, False)):
        mask = x >= math.tan(math.radians(degrees)) * y
        shares = way._line_shares(mask)
        assert (shares[0] > 0.8) == line
        assert shares == ((1.0, 1.0) if line else (0.0, 0.0))
    # a line over part of the width: shares of the rim near that end, and of the width
    part = x >= np.where(y < 45, 0, 4 * (y - 45) + 20)
    near = np.flatnonzero(np.argmax(part, axis=0) < 50)
    rim, width = way._line_shares(part)
    assert rim == pytest.approx(45 / len(near), abs=0.02)
    assert width == pytest.approx(45 / 60, abs=0.02)
    for straight, told in ((19, False), (22, True)):
        narrow = x >= np.where(y < straight, 0, 100)
        assert (way._line_shares(narrow)[0] > 0) == told


def test_the_foot_is_told_by_a_bend_of_six_thousandths_of_the_length():
    x, y = np.arange(1500)[:, None], np.arange(200)[None]
    for sagitta, told in ((0.0059, ""), (0.0064, "right"), (-0.0064, "left"), (-0.0059, "")):
        # middle = 4 s L (x/L - 1/2)^2: its coefficient is 4 s L, and |c| L^2 / 4 is s L
        inner = 4 * sagitta * 1410 * ((x - 749.5) / 1410) ** 2
        mask = np.abs(y - 100 - inner) < 60
        found = way.foot_of(mask, STEP, AUTO)[0]
        assert found == told
        for stated in ("left", "right"):
            foot, remark = way.foot_of(mask, STEP, FileSettings(foot=stated))
            assert foot == stated
            assert (str(remark) != "") == (told not in ("", stated))


def test_what_stands_is_within_two_millimetres_of_the_floor():
    height = FLAT.copy()
    height[40:] = 1.9e-3
    assert way.standing_share(height, STEP) == pytest.approx(1.0)
    height[40:] = 60e-3
    assert way.standing_share(height, STEP) < 0.65


def lies(slope, share=0.0):
    """A sole whose land slopes, but for a level part of its length at its rear."""
    x = np.arange(120)[:, None] * STEP
    level = share * 0.12
    return np.maximum(x - level, 0.0) * slope + np.zeros((120, 60))


def test_a_sole_that_lies_level_on_a_fifth_of_its_plan_stays_so():
    slope = 0.1
    for share, level in ((0.15, False), (0.27, True)):
        a, b, _ = way.resting_plane(lies(slope, share), STEP)
        assert b == pytest.approx(0.0, abs=1e-9)
        assert a == pytest.approx(0.0 if level else slope, abs=1e-6)
    # a tilt below 0.05 degrees is level
    assert math.isclose(way.LEVEL, math.radians(0.05))
    assert way.resting_plane(lies(0.0008, 0.0), STEP)[0] == pytest.approx(0.0008, abs=1e-6)


def test_low_points_are_those_of_blocks_of_three_millimetres():
    height = np.arange(81.0).reshape(9, 9)
    points = way._low_points(height, STEP)
    assert points.shape == (9, 3)
    assert points[:, 0].tolist() == pytest.approx(np.repeat([1.5, 4.5, 7.5], 3) * STEP)
    assert points[:, 2].tolist() == [0, 3, 6, 27, 30, 33, 54, 57, 60]
    fine = way._low_points(np.arange(900.0).reshape(30, 30), 3e-3 / 30)
    # 5 % of 900 cells: the 45th smallest
    assert fine[:, 2].tolist() == [45.0]
    half = height.copy()
    half[0, :3] = half[1, :2] = np.nan  # 4 of 9 are left of the first block
    assert len(way._low_points(half, STEP)) == 8
    half[1, 1] = 5.0
    assert len(way._low_points(half, STEP)) == 9


def test_another_face_to_stand_on_is_a_fifth_of_the_plan_and_three_degrees_off():
    for degrees, share, told in ((3.1, 0.3, True), (2.9, 0.3, False), (6.0, 0.25, True),
                                 (6.0, 0.15, False)):  # fmt: skip
        height = lies(math.tan(math.radians(degrees)), 1 - share)
        other = way.other_rest(height, STEP)
        assert (other is not None) == told
        if other is not None:
            assert other[0] == pytest.approx(share, abs=0.03)
            assert math.degrees(other[1]) == pytest.approx(degrees, rel=1e-6)
    for share, broad in ((0.45, False), (0.56, True)):
        assert way.broad_rest(lies(0.1, share), STEP, (0.0, 0.0, 0.0)) == broad
    assert way.broad_rest(lies(0.1, 0.3), STEP, (0.1, 0.0, 0.0))
    assert way.broad_rest(lies(0.1, 0.3), STEP, (0.1 + 0.015, 0.0, 0.0))
    assert not way.broad_rest(lies(0.1, 0.3), STEP, (0.1 + 0.02, 0.0, 0.0))


def prism(tilt=0.0, about=0):
    """A wedge-free slab of 120 x 60 x 10 mm, turned about one axis by an angle in degrees."""
    corners = np.array([[x, y, z] for x in (0, 120) for y in (0, 60) for z in (0, 10)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    c, s = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
    turn = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]] if about == 0 else
                    [[1, 0, 0], [0, c, -s], [0, s, c]])  # fmt: skip
    return (corners @ turn.T)[faces].astype(np.float32)


@pytest.mark.parametrize("about", [0, 1])
def test_a_sole_is_turned_onto_the_faces_it_was_drawn_with(about):
    for tilt in (0.0, 0.04, 2.0, 4.9, 5.1, 19.5):
        axes, angle = way.on_its_faces(prism(tilt, about), np.eye(3))
        if tilt < 0.05:
            assert angle == 0.0
        else:
            assert math.degrees(angle) == pytest.approx(tilt, abs=1e-3)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-9)
        if about == 0 and angle > 0:
            assert axes[0] == pytest.approx(
                [math.cos(angle), 0.0, math.sin(angle)], abs=1e-4)  # fmt: skip
    assert way.on_its_faces(prism(20.5, about), np.eye(3))[1] == 0.0


def test_the_thin_way_is_that_of_the_file_within_twenty_degrees():
    for tilt, snapped in ((19.0, True), (21.0, False)):
        thin = way.box_axes(prism(tilt), AUTO)[2]
        assert (abs(thin[2]) == 1.0) == snapped
    # a box along the file's axes may be a tenth larger than the smallest
    for degrees, drawn in ((2.0, True), (4.0, False)):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        soup = prism() @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]], np.float32)
        grown = (120 * c + 60 * s) * (120 * s + 60 * c) / 7200
        assert (grown < 1.10) == drawn
        along = way.box_axes(soup.astype(np.float32), FileSettings())[0]
        wide = np.array([c, s, 0.0])
        assert abs(along @ wide) == pytest.approx(1.0, abs=1e-6)


def test_the_body_that_stands_best_has_a_third_more_on_the_floor():
    axes, told = way.standing_axes(prism(), np.eye(3), 1e-3)
    assert told.assumed
    around, up = np.meshgrid(np.linspace(0, 2 * math.pi, 49)[:-1], np.linspace(0, 1.4, 9))
    points = np.stack(
        [60 * np.cos(around) * np.cos(up), 30 * np.sin(around) * np.cos(up), 25 * np.sin(up)], -1
    ).reshape(-1, 3)
    dome = points[ConvexHull(points).simplices].astype(np.float32)
    axes, told = way.standing_axes(dome, np.eye(3), 1e-3)
    assert not told.assumed
    assert axes.tolist() == np.eye(3).tolist()
    turned, _ = way.standing_axes(dome * np.array([1, 1, -1], np.float32), np.eye(3), 1e-3)
    assert turned.tolist() == [[1, 0, 0], [0, -1, 0], [0, 0, -1]]
    side = dome[:, :, [0, 2, 1]] * np.array([1, 1, -1], np.float32)
    third, _ = way.standing_axes(side, np.eye(3), 1e-3)
    assert third[2].tolist() == [0, 1, 0]


def test_axes_are_turned_until_a_plane_is_level():
    axes, angle = way.level_axes(np.eye(3), (0.3, -0.4, 7.0))
    up = np.array([-0.3, 0.4, 1.0]) / math.sqrt(1.25)
    assert axes[2] == pytest.approx(up)
    assert angle == pytest.approx(math.acos(1 / math.sqrt(1.25)))
    assert axes[0] @ up == pytest.approx(0.0, abs=1e-12)
    assert axes[0][0] > 0.9
    assert np.cross(axes[0], axes[1]) == pytest.approx(up)
    assert way.named_direction(np.array([0, 0, -1.0])) == "-z"
    assert way.named_direction(np.array([0.0, 0.6, 0.8])) == "(0.00, 0.60, 0.80)"


@pytest.mark.parametrize("quarter", range(4))
def test_a_sole_drawn_askew_has_its_length_along_the_way_nearest_the_axes(quarter):
    """A plate turned by 8 degrees about its width: whichever of its four ways lies along x."""
    tilt, turn = math.radians(8), math.radians(-10)
    plate = np.array([[x, y, 0.0] for x in (-0.14, 0.14) for y in (-0.05, 0.05)])
    rotation = np.array([[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0],
                         [0, 0, 1]])  # fmt: skip
    lean = np.array([[math.cos(tilt), 0, math.sin(tilt)], [0, 1, 0],
                     [-math.sin(tilt), 0, math.cos(tilt)]])  # fmt: skip
    corners = plate @ rotation.T @ lean.T
    faces = corners[np.array([[0, 2, 1], [1, 2, 3]])].astype(np.float32)
    first = (np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([-1.0, 0, 0]),
             np.array([0, -1.0, 0]))[quarter]  # fmt: skip
    up = np.array([0.0, 0.0, 1.0])
    axes, angle = way.on_its_faces(faces, np.stack([first, np.cross(up, first), up]))
    assert angle == pytest.approx(tilt, abs=1e-4)
    assert axes[0] @ first > math.cos(math.radians(15))
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-6)
    along = lean @ rotation @ (np.array([1.0, 0, 0]), np.array([0, 1.0, 0]))[quarter % 2]
    assert abs(axes[0] @ along) == pytest.approx(1.0, abs=1e-4)
