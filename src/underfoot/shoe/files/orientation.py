"""How an outsole lies in its file: axes, ground side, heel end, foot and resting plane."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import Message

from .._kernels.covering_discs import local_width
from .._kernels.regions import shrunk, without_specks
from .._kernels.rolling import rolled_base
from ..tread_measures import ROLLING_RADIUS, STEEPEST_RIM, WIDEST_CHANNEL, tread_map
from .settings import DIRECTIONS, HEEL, FileSettings
from .view import View, extents, view

_COARSE = 300  # cells along a body that is looked at from four sides
_SAMPLE = 200_000  # triangles: more change the axes by less than the snapping
_ANGLE_CLASS = 1e-3  # rad
_SNAP = math.cos(math.radians(20))
_NEARLY = 1.10  # a box along the file's axes may be this much larger than the smallest one
_TREAD_SHARE = 0.03  # of the plan form: fewer channels decide nothing
_TREAD_RATIO = 1.5  # channels on the ground's side against the other
_RIM_RISE = 0.5e-3  # m by which a ground side's rim must turn up more than the other's
_SHEET = 0.05e-3  # m between both sides: a scan of one side
OFF_CENTRE = 0.005
"""Of the length: a centroid less off the middle decides nothing."""
_WHOLE = 2.2  # lengths over width: a longer plan form has both ends of a sole
_WIDEST_HEEL = 0.085  # m
_CUT_PLACES, _CUT = (4e-3, 16e-3), 0.8  # m from an end; width there over that farther in
_END = 0.25  # of the length: where its end is looked for
_LINE_OVER, _LINE = 0.8, 0.02  # of the width: over which, and within which, an end is a line
ONE_STRAIGHT_END = 0.2
"""More of the width straight at one end than at the other: a cut against a rounded end."""
_MOST_OBLIQUE = math.tan(math.radians(25))
_FARTHEST_TURN = math.radians(16)
_AS_DRAWN, _ALIKE = 0.999, 0.995
"""Share of a plan form on which its mirror image lies: drawn along an axis of the file, and alike
about another."""
_LEFT_UNLIKE = 0.25
"""Of what is unlike about an axis of the file: a scan is never quite alike."""
_BEND = 0.006  # of the length
_BLOCK = 3e-3  # m: one low point a block, so that noise and single spikes don't carry the sole
_NEAR_FLOOR = 2e-3  # m
_STANDS = 1.3  # share on the floor against the next side's
_LOW = 5.0  # percentile of the heights in a block that counts as its low point


def unit_vector(direction: str) -> Array:
    """Return the unit vector of a direction such as "-z"."""
    vector = np.zeros(3)
    vector["xyz".index(direction[1])] = 1.0 if direction[0] == "+" else -1.0
    return vector


def named_direction(vector: Array) -> str:
    """Return "+x" and so on for a vector along an axis of the file, else its components."""
    for name in DIRECTIONS:
        if float(vector @ unit_vector(name)) > 1 - 1e-6:
            return name
    return "(" + ", ".join(f"{value:.2f}" for value in vector) + ")"


def box_axes(
    triangles: NDArray[np.float32], settings: FileSettings, down: Array | None = None
) -> Array:
    """Return rows (long, across, thin), a right-handed frame; signs still mean nothing.

    Thin: the direction in which the area spreads least (second moments of the triangles, A / 12
    (sum of the corners' squares + 9 times their mean's)), taken
    as the file's axis when within 20 degrees of it. Long and across: the smallest rectangle around
    the plan form, or the file's axes when that rectangle is less than 10 % larger; of a piece that
    is alike on both sides its own axis there. ``down``, where the file's bodies tell it, is thin as
    it stands.
    """
    corners, weights = _sample(triangles)
    if settings.down in DIRECTIONS:
        thin = unit_vector(settings.down)
    elif down is not None:
        thin = down
    else:
        points = np.concatenate([corners, 3 * corners.mean(axis=1, keepdims=True)], axis=1)
        weighted = weights[:, None, None] * points
        moments = weighted.reshape(-1, 3).T @ points.reshape(-1, 3)
        _, vectors = np.linalg.eigh(moments)
        thin = _snap_to_axis(np.asarray(vectors[:, 0], dtype=np.float64))
        if settings.forward in DIRECTIONS:
            forward = unit_vector(settings.forward)
            thin = thin - (thin @ forward) * forward
            thin = _snap_to_axis(thin / np.linalg.norm(thin))
    if settings.forward in DIRECTIONS:
        along = unit_vector(settings.forward)
        along = along - (along @ thin) * thin
        along /= np.linalg.norm(along)
        return np.stack([along, np.cross(thin, along), thin])
    along = _long_axis(corners.reshape(-1, 3), thin)
    return np.stack([along, np.cross(thin, along), thin])


def _sample(triangles: NDArray[np.float32]) -> tuple[Array, Array]:
    """Return corners (n, 3, 3) about the centroid, and areas."""
    chosen = triangles[:: math.ceil(triangles.shape[0] / _SAMPLE) or 1].astype(np.float64)
    if not np.isfinite(chosen).all():
        chosen = chosen[np.isfinite(chosen).all(axis=(1, 2))]
    sides = chosen[:, 1:] - chosen[:, :1]
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    centre = np.average(chosen.mean(axis=1), axis=0, weights=np.maximum(areas, 1e-30))
    return chosen - centre, areas


def _snap_to_axis(vector: Array) -> Array:
    axis = int(np.argmax(np.abs(vector)))
    if abs(vector[axis]) < _SNAP:
        return vector
    axis_vector = np.zeros(3)
    axis_vector[axis] = math.copysign(1.0, vector[axis])
    return axis_vector


def _long_axis(corners: Array, thin: Array) -> Array:
    """Return the longer side of the smallest rectangle around the points seen along ``thin``."""
    from scipy.spatial import ConvexHull, QhullError

    start = np.eye(3)[int(np.argmin(np.abs(thin)))]
    u = start - (start @ thin) * thin
    u /= np.linalg.norm(u)
    v = np.cross(thin, u)
    points = np.asarray(np.column_stack([corners @ u, corners @ v]), dtype=np.float64)
    try:
        hull = points[ConvexHull(points).vertices]
    except (QhullError, ValueError):  # on a line, or too few: any frame will do for a refusal
        return u
    edges = np.roll(hull, -1, axis=0) - hull
    every = np.mod(np.arctan2(edges[:, 1], edges[:, 0]), math.pi / 2)
    angles = np.unique(every.round(3))
    areas = np.prod(_extents(hull, angles), axis=0)
    # an edge of the hull lies on the smallest rectangle: its own angle, not that of its class
    angles = every[np.abs(every - angles[np.argmin(areas)]) < _ANGLE_CLASS]
    areas = np.prod(_extents(hull, angles), axis=0)
    best, least = float(angles[np.argmin(areas)]), float(np.min(areas))
    for axis in np.eye(3):
        if abs(axis @ thin) > 1e-6:
            continue
        angle = math.atan2(float(axis @ v), float(axis @ u))
        if np.prod(_extents(hull, np.array([angle]))) <= _NEARLY * least:
            best = angle + _from_mirror_axis(hull, angle)
            break
    length, width = _extents(hull, np.array([best]))[:, 0]
    if width > length:
        best += math.pi / 2
    return math.cos(best) * u + math.sin(best) * v


def _from_mirror_axis(hull: Array, angle: float) -> float:
    """Return how far (rad) from an axis of the file the sides of a piece are alike; 0 as drawn.

    A heel is alike on both sides. Turned by some degrees its rectangle hardly grows, but its
    length, its land and the way it slides change. A whole sole is not alike: there it is 0.
    """
    import shapely

    length, width = sorted(_extents(hull, np.array([angle]))[:, 0], reverse=True)
    plan = shapely.Polygon(hull)
    if length > _WHOLE * width or plan.area == 0:
        return 0.0
    middle = np.array(plan.centroid.coords[0])

    def likeness(turn: float) -> float:
        both = []
        for axis in (angle + turn, angle + turn + math.pi / 2):
            along = np.array([math.cos(axis), math.sin(axis)])
            mirrored = 2 * np.outer((hull - middle) @ along, along) - (hull - middle) + middle
            both.append(plan.intersection(shapely.Polygon(mirrored)).area / plan.area)
        return max(both)

    drawn = likeness(0.0)
    if drawn >= _AS_DRAWN:
        return 0.0
    turn, step = 0.0, _FARTHEST_TURN / 16
    near = np.linspace(-_FARTHEST_TURN, _FARTHEST_TURN, 33)
    while step > 1e-6:
        turn = float(near[np.argmax([likeness(one) for one in near])])
        near, step = turn + np.linspace(-step, step, 9), step / 4
    best = likeness(turn)
    return turn if best >= _ALIKE and 1 - best < _LEFT_UNLIKE * (1 - drawn) else 0.0


def _extents(points: Array, angles: Array) -> Array:
    """Return the length along and across each angle, (2, angles)."""
    cosine, sine = np.cos(angles), np.sin(angles)
    ways = ([cosine, sine], [-sine, cosine])
    return np.stack([np.ptp(points @ np.stack(way), axis=0) for way in ways])


@dataclass(frozen=True, slots=True)
class AxisDecision:
    """A decision: its sign (1 keep, -1 turn), how it was made ("" when stated by the user; no full
    stop), and whether that is a guess.
    """

    sign: int
    remark: Message
    assumed: bool = False


def ground_side(seen: View, settings: FileSettings) -> AxisDecision:
    """Return whether the ground is below the view (1) or above it (-1).

    In turn: the side the user names; the side with more channels (by area, narrower than 50 mm, 0.3
    to 12 mm deep); the side whose rim turns away (rounded edges, toe spring, side walls); for a
    surface without thickness the side its normals point to; else the file's own lower side.
    """
    if settings.down in DIRECTIONS:
        return AxisDecision(-1, Message(""))
    choice = _ground_side(seen)
    if settings.down == "flip":
        return AxisDecision(
            -choice.sign, Message("Ground side: turned over by the option down = flip")
        )
    return choice


def _ground_side(seen: View) -> AxisDecision:
    below, above = seen.lowest, -seen.highest
    covered = seen.covered
    thin = np.median((seen.highest - seen.lowest)[covered]) < _SHEET
    turned = float(np.count_nonzero(seen.facing > 0)) / max(1, np.count_nonzero(covered))
    rise = _rim_rise(below) - _rim_rise(above)
    if not thin:
        shares = [tread_share(height, seen.spacing) for height in (below, above)]
        most, least = max(shares), min(shares)
        if most > _TREAD_SHARE and most > _TREAD_RATIO * least:
            sign = 1 if shares[0] > shares[1] else -1
            return AxisDecision(
                sign,
                Message(
                    "Ground side: determined from the tread, channels over {most:.0%} of it, "
                    "{least:.0%} on the other side",
                    most=most,
                    least=least,
                ),
            )
    if abs(rise) > _RIM_RISE:
        remark = Message("Ground side: determined from the rim, which turns up from the floor")
        return AxisDecision(1 if rise > 0 else -1, remark)
    if thin and abs(turned - 0.5) > 0.25:
        remark = Message("Ground side: the side to which the normals of the scan point")
        return AxisDecision(1 if turned < 0.5 else -1, remark)
    return AxisDecision(
        1 if _file_side(seen) else -1,
        Message("the ground side is the lower one of the file; both sides look alike"),
        assumed=True,
    )


def _file_side(seen: View) -> bool:
    """Return whether the view's down is the file's -z, -y or -x (its largest component)."""
    up = seen.axes[2]
    return bool(up[int(np.argmax(np.abs(up)))] > 0)


def tread_share(height: Array, spacing: float) -> float:
    """Return the share of the plan form that is channel: narrower than 50 mm, 0.3 to 12 mm deep."""
    inside = np.isfinite(height)
    if not inside.any():
        return 0.0
    tread = tread_map(height, spacing)
    depth = np.where(inside, height - tread.base, 0.0)
    channel = inside & ~tread.land & (depth < 12e-3)
    channel &= local_width(inside & ~tread.land, spacing) < WIDEST_CHANNEL
    return float(np.count_nonzero(channel)) / np.count_nonzero(inside)


def _rim_rise(height: Array) -> float:
    """Return how much higher the outermost ring is than the land within, m."""
    inside = without_specks(np.isfinite(height), 50)
    core = shrunk(inside, 2)
    ring = inside & ~core
    if not core.any() or not ring.any():
        return 0.0
    # the same low percentile on both: a ring half of channels is no rim that turns up
    return float(np.percentile(height[ring], 20) - np.percentile(height[core], 20))


def toe_end(plan: Mask, spacing: float, settings: FileSettings) -> AxisDecision:
    """Return whether the toe is at the far end of axis 0 (1) or at the near one (-1).

    The toe side of a whole sole is the heavier one: the forepart is broader, so the area's centroid
    lies beyond the middle. A piece with one end cut straight is a heel or a forepart, which its
    form doesn't tell: wider than 85 mm or longer than 110 mm it is assumed to be a forepart.

    Parameters:
        plan: The plan form on cells of ``spacing`` (m).
    """
    if settings.forward in DIRECTIONS:
        return AxisDecision(1, Message(""))
    choice = _toe_end(plan, spacing)
    if settings.forward == "flip":
        return AxisDecision(-choice.sign, Message("Heel end: swapped by the option forward = flip"))
    return choice


def _toe_end(plan: Mask, spacing: float) -> AxisDecision:
    length, width = (np.ptp(np.nonzero(plan)[n]) * spacing for n in (0, 1))
    cut = cut_ends(plan, 0, spacing)
    offset = off_centre(plan, 0)
    if cut[0] != cut[1] and length < _WHOLE * width:
        forepart = width > _WIDEST_HEEL or length > HEEL[1]
        kind = Message("heel piece, cut at its front")
        if forepart:
            kind = Message("forepart, cut at its rear")
        told = Message(
            'a {kind}, by its size of {length:.0f} x {width:.0f} mm; forward = "flip" (--forward '
            "flip) swaps heel and toe",
            kind=kind,
            length=length * 1e3,
            width=width * 1e3,
        )
        return AxisDecision(1 if cut[0] == forepart else -1, told, True)
    if abs(offset) < OFF_CENTRE or all(cut):
        return AxisDecision(
            1 if offset >= 0 else -1,
            Message(
                'which end is the heel; both look alike; forward = "flip" (--forward flip) '
                "swaps heel and toe"
            ),
            True,
        )
    return AxisDecision(
        1 if offset > 0 else -1,
        Message("Heel end: determined from the plan form, which is rounder or narrower there"),
    )


def cut_ends(plan: Mask, axis: int, spacing: float) -> tuple[bool, bool]:
    """Return whether the near and the far end along ``axis`` are cut straight, not rounded.

    4 mm from a cut the plan form is more than 0.8 times as wide as 16 mm from it; or its rim there
    is a line, up to 25 degrees off square, over 80 % of what lies near that end.
    """
    widths = np.trim_zeros(plan.sum(axis=1 - axis))
    near, far = (min(round(place / spacing), widths.size - 1) for place in _CUT_PLACES)
    turned = plan if axis == 0 else plan.T
    low, high = (
        bool(each[near] > _CUT * each[far]) or _line_shares(rim)[0] > _LINE_OVER
        for each, rim in ((widths, turned), (widths[::-1], turned[::-1]))
    )
    return low, high


def straight_ends(plan: Mask, axis: int) -> tuple[float, float]:
    """Return the shares of the width over which the near and the far end along ``axis`` are a line.

    A cut runs over the whole width, square or up to 25 degrees off it; the sides of a rounded heel
    are lines over a part.
    """
    turned = plan if axis == 0 else plan.T
    return _line_shares(turned)[1], _line_shares(turned[::-1])[1]


def _line_shares(plan: Mask) -> tuple[float, float]:
    """Return the share of the rim at the first rows that is a line: of that rim, of the width."""
    columns = np.flatnonzero(plan.any(axis=0))
    rim_row = np.argmax(plan[:, columns], axis=0).astype(np.float64)
    end = rim_row < _END * plan.shape[0]
    columns, rim_row, width = columns[end], rim_row[end], columns.size
    near, off, slope = np.ones(columns.size, dtype=bool), np.zeros(columns.size), 0.0
    for _ in range(5):  # the sides of the end fall out
        if np.count_nonzero(near) < 3:
            return 0.0, 0.0
        slope, level = np.polyfit(columns[near], rim_row[near], 1)
        off = np.abs(rim_row - slope * columns - level)
        near = off < max(_LINE * width, np.quantile(off, _LINE_OVER)) + 1e-9
    straight = int(np.count_nonzero(off < _LINE * width + 1))
    if abs(slope) >= _MOST_OBLIQUE or columns.size <= width / 3:
        return 0.0, 0.0
    return straight / columns.size, straight / width


def off_centre(plan: Mask, axis: int) -> float:
    """Return the offset of the plan form's centroid from its middle, in lengths along ``axis``."""
    counts = plan.sum(axis=1 - axis).astype(float)
    places = np.nonzero(counts)[0]
    middle = (places[0] + places[-1]) / 2
    centroid = float((np.arange(counts.size) * counts).sum() / counts.sum())
    return (centroid - middle) / (places[-1] - places[0] + 1)


def foot_of(plan: Mask, spacing: float, settings: FileSettings) -> tuple[str, Message]:
    """Return "left", "right" or "" (not determined) and a remark on how it was determined.

    The middle line of a sole bends towards the inner side of the foot: c, the coefficient of
    y = a + b x + c x^2 through the middles of its rows (x along, y to the left), is positive for a
    right foot. Determined when the sagitta |c| L^2 / 4 is more than 0.6 % of the length L.
    """
    told, how = _foot_by_bend(plan, spacing)
    if settings.foot == "auto":
        return told, how
    if told in ("", settings.foot):
        return settings.foot, Message("")
    return settings.foot, Message(
        "Foot: {foot}, as stated; the plan form bends as that of the other foot.",
        foot=settings.foot,
    )


def _foot_by_bend(plan: Mask, spacing: float) -> tuple[str, Message]:
    """Return the foot that the bend of a plan form tells, "" where it tells none, and how."""
    rows = np.nonzero(plan.any(axis=1))[0]
    rows = rows[int(0.03 * rows.size) : rows.size - int(0.03 * rows.size)]
    y = np.arange(plan.shape[1], dtype=float)
    middle = [(y[plan[row]].min() + y[plan[row]].max()) / 2 for row in rows]
    length = float(rows[-1] - rows[0])
    bend = float(np.polyfit(rows / length, middle, 2)[0]) / 4 / length
    if abs(bend) < _BEND:
        return "", Message("The foot is not determined: the plan form is nearly symmetric.")
    foot = "right" if bend > 0 else "left"
    return foot, Message("Foot: {foot}, from the bend of the plan form.", foot=foot)


def standing_share(height: Array, spacing: float) -> float:
    """Return the share of the plan form within 2 mm of the resting plane, gaps bridged."""
    inside = np.isfinite(height)
    if not inside.any():
        return 0.0
    a, b, c = resting_plane(height, spacing)
    x, y = (np.arange(count) * spacing for count in height.shape)
    base = rolled_base(height, spacing, ROLLING_RADIUS, STEEPEST_RIM)
    above = base - (a * x[:, None] + b * y[None] + c)
    return float(np.count_nonzero(inside & (above < _NEAR_FLOOR)) / np.count_nonzero(inside))


def standing_axes(
    triangles: NDArray[np.float32], axes: Array, unit: float
) -> tuple[Array, AxisDecision]:
    """Return the frame in which a body too tall for a sole stands best, the ground below it.

    A shoe with its upper or last in one piece: of the four sides along the shoe the one with most
    of its plan form on the floor.
    """
    frames = [
        axes,
        axes * [[1], [-1], [-1]],
        axes[[0, 2, 1]] * [[1], [-1], [1]],
        axes[[0, 2, 1]] * [[1], [1], [-1]],
    ]
    shares = []
    for frame in frames:
        low, high = extents(triangles, frame * unit)
        spacing = float(max(high[:2] - low[:2])) / _COARSE
        seen = view(triangles, frame * unit, spacing)
        shares.append(standing_share(seen.lowest, spacing))
    order = np.argsort(shares)[::-1]
    best = frames[int(order[0])]
    if shares[order[0]] > _STANDS * shares[order[1]]:
        told = Message(
            "Ground side: the side that stands flat, {share:.0%} of it on the floor",
            share=shares[order[0]],
        )
        return best, AxisDecision(1, told)
    return best, AxisDecision(1, Message("the ground side is the one that stands flattest"), True)


LEVEL = math.radians(0.05)
"""A tilt (rad) below it is that of noise and roundings."""
_DRAWN_LEVEL = 0.2
_BROAD = 0.5  # of the plan form: a sole's own land
_DRAWN_FACES = 0.1  # of all faces' area
_LIES_ASKEW = math.radians(5.0)
_OTHER_FACE, _ALIKE = math.radians(3.0), math.radians(1.0)


def resting_plane(height: Array, spacing: float) -> tuple[float, float, float]:
    """Return (a, b, c) of the plane z = a x + b y + c that the sole rests on under its own centre.

    The lower convex hull of the low points (5 % of the heights in blocks of 3 mm); of its faces the
    one over the centroid of the plan form: a sole pressed there stands on that face's corners. A
    sole that lies level on a fifth of its plan form was drawn so and stays so, however long its
    bevel is. x and y count from the first cell, m.

    Parameters:
        height: (nx, ny) m, z up, nan outside.
        spacing: Of its cells, m.
    """
    (a, b, c), plan, centre = _lower_faces(height, spacing)
    # every lower face lies below the points: over the centre the highest of them is the hull
    best = int(np.argmax(a * centre[0] + b * centre[1] + c))
    level = np.hypot(a, b) < LEVEL
    if plan[level].sum() > _DRAWN_LEVEL * plan.sum():
        best = int(np.argmax(np.where(level, plan, 0.0)))
    return float(a[best]), float(b[best]), float(c[best])


def on_its_faces(triangles: NDArray[np.float32], axes: Array) -> tuple[Array, float]:
    """Return the axes turned onto the plane in which a sole was drawn, and the angle, rad.

    The plane of most area among the faces within 20 degrees of the frame, where it is
    ``_DRAWN_FACES`` of all, and hardly any lie level as the axes are. A scan has no such plane. A
    sole that a file's axes miss by more than ``_LIES_ASKEW`` has its length from the rectangle
    around its plan form alone, not along an axis of the file.
    """
    corners, _ = _sample(triangles)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    upward = normals @ axes[2]
    normals = normals * np.where(upward < 0, -1.0, 1.0)[:, None]
    near = np.abs(upward) > _SNAP * area
    if not near.any():
        return axes, 0.0
    units, of_unit = np.unique(
        np.round(normals[near] / area[near, None], 3), axis=0, return_inverse=True
    )
    heaviest = units[int(np.argmax(np.bincount(of_unit.ravel(), area[near])))]
    drawn = near & (normals @ heaviest > math.cos(LEVEL) * np.linalg.norm(heaviest) * area)
    level = np.abs(upward) > math.cos(LEVEL) * area
    share = float(area[drawn].sum())
    if share < _DRAWN_FACES * area.sum() or area[level].sum() > _DRAWN_LEVEL * share:
        return axes, 0.0
    up = normals[drawn].sum(axis=0)
    up /= np.linalg.norm(up)
    angle = math.acos(min(1.0, float(up @ axes[2])))
    along = axes[0] - (axes[0] @ up) * up
    if angle > _LIES_ASKEW:
        long = _long_axis(corners.reshape(-1, 3), up)
        ways = [long, -long, np.cross(up, long), -np.cross(up, long)]
        along = max(ways, key=lambda way: float(way @ along))
    along /= np.linalg.norm(along)
    return np.stack([along, np.cross(up, along), up]), angle


def broad_rest(height: Array, spacing: float, plane: tuple[float, float, float]) -> bool:
    """Return whether the lower hull's faces in the direction of a plane are half of the plan form.

    A sole that lies tilted in its file has its land there, one that stands on a stud a small face.
    """
    (a, b, _), plan, _ = _lower_faces(height, spacing)
    normals, wanted = (
        np.stack([-x, -y, np.ones_like(x)]) / np.sqrt(x**2 + y**2 + 1)
        for x, y in ((a, b), (np.array(plane[0]), np.array(plane[1])))
    )
    alike = wanted @ normals > math.cos(_ALIKE)
    return bool(plan[alike].sum() > _BROAD * plan.sum())


def other_rest(height: Array, spacing: float) -> tuple[float, float] | None:
    """Return (share of the plan form, angle from level in rad) of another face it could stand on.

    None where no face is a fifth of the plan form and 3 degrees off: of a sole that stands level.
    """
    (a, b, _), plan, _ = _lower_faces(height, spacing)
    normals = np.stack([-a, -b, np.ones_like(a)]) / np.sqrt(a**2 + b**2 + 1)
    off = np.arccos(np.minimum(normals[2], 1.0)) > _OTHER_FACE
    largest = int(np.argmax(np.where(off, plan, 0.0)))
    alike = off & (normals.T @ normals[:, largest] > math.cos(_ALIKE))
    share = float(plan[alike].sum() / plan.sum())
    angle = math.acos(min(1.0, float(normals[2, largest])))
    return (share, angle) if share > _DRAWN_LEVEL else None


def _lower_faces(height: Array, spacing: float) -> tuple[Array, Array, Array]:
    """Return (a, b, c) of the faces of the lower hull, their area in plan, and the sole's centre.

    The one plane that fits, where there are too few points for a hull or all lie in one plane.
    """
    from scipy.spatial import ConvexHull, QhullError

    points = _low_points(height, spacing)
    inside = np.isfinite(height)
    centre = np.array([float(index.mean()) for index in np.nonzero(inside)]) * spacing
    whole = np.ones(1)
    if points.shape[0] < 4:
        return np.array([[0.0], [0.0], [float(np.nanmin(height))]]), whole, centre
    try:
        hull = ConvexHull(points)
    except QhullError:
        coefficients, *_ = np.linalg.lstsq(
            np.column_stack([points[:, :2], np.ones(points.shape[0])]), points[:, 2], rcond=None
        )
        return np.asarray(coefficients, dtype=np.float64)[:, None], whole, centre
    down = hull.equations[:, 2] < -1e-9
    lower = hull.equations[down]
    corners = points[hull.simplices[down], :2]
    (x1, y1), (x2, y2) = (corners[:, n].T - corners[:, 0].T for n in (1, 2))
    return -lower[:, [0, 1, 3]].T / lower[:, 2], np.abs(x1 * y2 - x2 * y1), centre


def _low_points(height: Array, spacing: float) -> Array:
    size = max(1, round(_BLOCK / spacing))
    count = [math.ceil(n / size) for n in height.shape]
    padded = np.full([n * size for n in count], np.nan)
    padded[: height.shape[0], : height.shape[1]] = height
    blocks = padded.reshape(count[0], size, count[1], size).transpose(0, 2, 1, 3)
    blocks = blocks.reshape(count[0], count[1], -1)
    filled = np.isfinite(blocks).sum(axis=2)
    i, j = np.nonzero(filled >= 0.5 * blocks.shape[2])
    if i.size == 0:
        return np.zeros((0, 3))
    ranked = np.sort(blocks[i, j], axis=1)  # nan comes last
    rank = np.rint(_LOW / 100 * (filled[i, j] - 1)).astype(int)
    low = ranked[np.arange(i.size), rank]
    places = (i + 0.5) * size * spacing, (j + 0.5) * size * spacing
    return np.asarray(np.column_stack([*places, low]), dtype=np.float64)


def level_axes(axes: Array, plane: tuple[float, float, float]) -> tuple[Array, float]:
    """Return the axes turned so that the plane is level, and the angle of the turn, rad."""
    slope_x, slope_y, _ = plane
    up = np.array([-slope_x, -slope_y, 1.0])
    up /= np.linalg.norm(up)
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    forward /= np.linalg.norm(forward)
    turn = np.stack([forward, np.cross(up, forward), up])
    return turn @ axes, math.acos(min(1.0, float(up[2])))
