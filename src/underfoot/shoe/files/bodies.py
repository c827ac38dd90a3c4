"""Which bodies of a file are the outsole: by name, by place, by what carries the tread."""

import re
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, unknown_name
from underfoot.core.arrays import Array, Mask
from underfoot.core.remark import ASSUMED, Message, Remark, assumption_line

from .._kernels.components import MOST_FACES, components, extents_of_bodies
from .carriers import group_bodies
from .floor import without_floor
from .mesh import Mesh
from .orientation import box_axes, tread_share
from .settings import DIRECTIONS, FileSettings, likely_unit
from .view import view

OUTSOLE_NAMES = re.compile(
    r"out.?sole|tread|rubber|lauf.?sohle|semelle|suela|suola|solado|bottom|^sole", re.IGNORECASE
)
_FLOOR_NAMES = re.compile(
    r"floor|ground|boden|\btable\b|tisch|suelo|build.?plate|print.?bed", re.IGNORECASE
)
OTHER_NAMES = re.compile(
    r"mid.?sole|in.?sole|sock.?liner|upper|shaft|leisten|\blast\b|horma|strobel|"
    r"\beva\b|foam|lace|tongue|zwischen.?sohle|brand.?sohle|einlege|" + _FLOOR_NAMES.pattern,
    re.IGNORECASE,
)
_PLAINLY = re.compile(r"out.?sole|lauf.?sohle", re.IGNORECASE)
_STRAY_REACH = 3.0  # sizes of the box around nearly all corners
_ISLAND, _APART = 1e-4, 0.3  # of the area; of the size, from the box of all else
_STRAY_SHARE = 1e-3  # of the corners
_ON_TABLE = 0.1  # of a plate: what stands on it
_BIG = (0.5, 0.4)  # of the longest body's extent along and across
_SLENDER = 3.0  # height over width: a support, no lug
_SAME = 0.03  # relative difference of the sizes of a pair
_PARTED = 0.3  # of two bodies' heights that don't overlap: less is bodies that cross
_BESIDE = 0.3  # of the shorter of two bodies: what they overlap at most, seen from above
_SHEET = 1e-3  # of the length: a body thinner than it is a surface
_CLEAR, _CLEARER = 0.03, 1.5  # share of channels that tells the ground's side, and its ratio
_COARSE = 300  # cells along a body
_BOX, _PLATE = 1e-3, 0.2  # of a box's surface; height of a plate over its width


_AWAY = Message("Ground side: away from the rest of the file")


@dataclass(frozen=True, slots=True)
class Found:
    """The triangles of the outsole, and what told them.

    Parameters:
        meshes: One, or both shoes of a pair.
        down: Direction of the ground in the file's axes, None if the bodies don't tell.
        remarks: Sentences.
        ground: How the bodies tell ``down``.
        ground_assumed: Whether that is a guess.
    """

    meshes: tuple[Mesh, ...]
    down: Array | None
    remarks: tuple[Message, ...]
    ground: Message = _AWAY
    ground_assumed: bool = False


@dataclass(frozen=True, slots=True)
class _Bodies:
    """Extents (m, 3) of the bodies along ``axes``, their names and areas."""

    axes: Array
    names: tuple[str, ...]
    low: Array
    high: Array
    area: Array

    def part(self, keep: Mask) -> "_Bodies":
        names = tuple(name for name, taken in zip(self.names, keep, strict=True) if taken)
        return _Bodies(self.axes, names, self.low[keep], self.high[keep], self.area[keep])

    @property
    def size(self) -> Array:
        return self.high - self.low


def found_outsole(mesh: Mesh, settings: FileSettings, where: str) -> Found:
    """Return the triangles of the outsole among the bodies of a file.

    In turn: corners far off all others are left out; a floor plane is cut; lugs and the body that
    carries them are one; the bodies that the user or their names tell; slender bodies (print
    supports) are left out; a pair is refused or given as both; of bodies stacked one on the other
    (outsole, midsole, last) the one at the end of the stack whose outer side carries the tread,
    with the small ones on it.

    Raises:
        InputError: No body of the name asked for.
        DataError: A pair without a choice.
    """
    mesh, remarks = _without_strays(mesh)
    mesh, away, floor_remarks = without_floor(mesh, settings)
    remarks += floor_remarks
    if mesh.body is None and mesh.triangles.shape[0] <= MOST_FACES:
        body, count = components(mesh.triangles)
        mesh = replace(mesh, body=body, bodies=("",) * count)
    if mesh.body is None or np.ptp(mesh.body) == 0:
        _refuse_unknown(mesh.bodies, settings, where)
        return Found((mesh,), away, tuple(remarks))
    group = np.arange(len(mesh.bodies)) if settings.solid is not None else group_bodies(mesh)
    keep, told = _find_outsole(_measure_bodies(mesh), group, settings, where)
    remarks += told
    mesh, keep, told = _join_groups(mesh, group, keep)
    remarks += told
    if mesh.body is None or np.ptp(mesh.body) == 0:
        return Found((mesh,), away, tuple(remarks))
    bodies = _measure_bodies(mesh)
    others = ~keep
    for without in (_without_islands, _without_supports, _without_plates):
        keep, told = without(bodies, keep)
        remarks += told
    down = None
    if settings.solid is None:
        pair = _pair(bodies, keep)
        if pair is not None:
            return _of_pair(mesh, pair, settings, where, remarks)
        keep, down, told = _without_stack(mesh, bodies, keep, settings)
        remarks += told
    found = Found((_part(mesh, keep),), away if down is None else down, tuple(remarks))
    if down is None and others.any() and keep.any() and settings.down not in DIRECTIONS:
        found = _beside(found, bodies, keep, others)
    if found.down is not None and settings.down == "flip":
        turned = "Ground side: turned over by the option down = flip."
        found = replace(found, down=-found.down, ground=turned)
    return found


def _join_groups(
    mesh: Mesh, group: NDArray[np.intp], keep: Mask
) -> tuple[Mesh, Mask, list[Message]]:
    """Return the mesh with each group of bodies as one, which are kept, and what was joined."""
    assert mesh.body is not None
    first, number = np.unique(group, return_inverse=True)
    if first.size == group.size:
        return mesh, keep, []
    names, told = [], []
    for each in range(first.size):
        members = [mesh.bodies[n] for n in np.flatnonzero(number == each)]
        names.append(" + ".join(dict.fromkeys(filter(None, members))))
        if len(members) > 1:
            named = [name for name in members if name]
            told.append(
                Message(
                    "{count} bodies are one sole, lugs and what they hang on{names}; told by the "
                    "contact of their faces.",
                    count=len(members),
                    names=Message(": {names}", names=_list_names(named)) if named else "",
                )
            )
    together = np.bincount(number, keep) > 0
    body = np.asarray(number[mesh.body], dtype=np.int32)
    return replace(mesh, body=body, bodies=tuple(names)), together, told


def _part(mesh: Mesh, keep: Mask) -> Mesh:
    assert mesh.body is not None
    if keep.all():
        return mesh
    chosen = keep[mesh.body]
    return replace(mesh, triangles=mesh.triangles[chosen], body=mesh.body[chosen])


def _without_strays(mesh: Mesh) -> tuple[Mesh, list[Message]]:
    corners = mesh.triangles.reshape(-1, 3)
    sample = corners[:: max(1, corners.shape[0] // 100_000)]
    sample = sample[np.isfinite(sample).all(axis=1)]
    if sample.shape[0] < 1000:
        return mesh, []
    low, high = np.percentile(sample, (1, 99), axis=0)
    reach = _STRAY_REACH * float((high - low).max())
    off = ((corners < low - reach) | (corners > high + reach)).any(axis=1)
    count = int(np.count_nonzero(off))
    if count == 0 or count > _STRAY_SHARE * corners.shape[0]:
        return mesh, []
    faces = off.reshape(-1, 3).any(axis=1)
    places = np.unique(corners[off], axis=0) + np.array(mesh.origin)
    remark = Message(
        "{count} stray {count:corner|corners} far off all others, {count:|the first }at ({place}) "
        "in the file, left out with {faces} faces.",
        count=places.shape[0],
        place=[f"{value:.6g}" for value in places[0]],
        faces=np.count_nonzero(faces),
    )
    body = None if mesh.body is None else mesh.body[~faces]
    return replace(mesh, triangles=mesh.triangles[~faces], body=body), [remark]


def _without_islands(bodies: _Bodies, keep: Mask) -> tuple[Mask, list[Message]]:
    """Leave out specks of a scan that lie apart from all that has a size."""
    speck = keep & (bodies.area < _ISLAND * bodies.area[keep].sum())
    rest = keep & ~speck
    if not speck.any() or not rest.any():
        return keep, []
    low, high = bodies.low[rest].min(axis=0), bodies.high[rest].max(axis=0)
    gap = np.maximum(low - bodies.high, bodies.low - high).max(axis=1)
    off = speck & (gap > _APART * float((high - low).max()))
    if not off.any():
        return keep, []
    return keep & ~off, [
        Message(
            "{count} {count:speck|specks} apart from all else {count:was|were} left out.",
            count=np.count_nonzero(off),
        )
    ]


def _measure_bodies(mesh: Mesh) -> _Bodies:
    """Return extents and areas; unnamed bodies are named by their rank in area."""
    assert mesh.body is not None
    axes = box_axes(mesh.triangles, FileSettings())
    count = len(mesh.bodies)
    low, high, area = extents_of_bodies(mesh.triangles, mesh.body, axes, count)
    low, high = (np.where(np.isfinite(low), each, 0.0) for each in (low, high))  # empty bodies
    rank = np.empty(count, dtype=int)
    rank[np.argsort(-area)] = np.arange(1, count + 1)
    names = tuple(name or f"body {n}" for name, n in zip(mesh.bodies, rank, strict=True))
    return _Bodies(axes, names, low, high, area)


def _refuse_unknown(bodies: tuple[str, ...], settings: FileSettings, where: str) -> None:
    names = [name or "body 1" for name in bodies[:1]]
    if settings.solid is not None and not _matching(tuple(names), settings.solid).any():
        raise unknown_name("body", settings.solid, names, where=where)
    if settings.solid is None and names and _other(names[0]):
        raise _no_outsole(names, where)


def _other(name: str) -> bool:
    """Return whether a name tells another part of a shoe."""
    return bool(OTHER_NAMES.search(name)) and not _PLAINLY.search(name)


def _no_outsole(names: list[str], where: str) -> DataError:
    return DataError(
        Message("by its name no body of the file is an outsole: {names}", names=_list_names(names)),
        where=where,
        remedy=Message(
            'Export the outsole; or choose a body by its name, --solid "{name}"', name=names[0]
        ),
    )


def _matching(names: tuple[str, ...], wanted: str) -> Mask:
    folded = [name.casefold() for name in names]
    wanted = wanted.casefold()
    exact = np.array([wanted in (name, name.rsplit("/", 1)[-1]) for name in folded])
    return exact if exact.any() else np.array([wanted in name for name in folded])


def _find_outsole(
    bodies: _Bodies, group: NDArray[np.intp], settings: FileSettings, where: str
) -> tuple[Mask, list[Message]]:
    """Return the bodies that the user or their names tell to be outsole; all if none are told.

    A body that is one with another (the same number in ``group``) is told with it.
    """

    def with_group(told: Mask) -> Mask:
        return np.isin(group, group[told])

    sized = bodies.area > 0
    if settings.solid is not None:
        keep = _matching(bodies.names, settings.solid) & sized
        if not keep.any():
            named = {name for name, is_there in zip(bodies.names, sized, strict=True) if is_there}
            raise unknown_name("body", settings.solid, named, where=where)
        return keep, [_taken_remark(bodies, keep, sized, Message("as chosen"))]
    other = np.array([_other(name) for name in bodies.names])
    by_name = np.array([bool(OUTSOLE_NAMES.search(name)) for name in bodies.names]) & ~other
    by_name, other = with_group(by_name), ~with_group(~other)
    if (by_name & sized).any():
        if (sized & ~by_name).any():
            return by_name & sized, [
                _taken_remark(bodies, by_name & sized, sized, Message("by name"))
            ]
        return sized, []
    if sized.any() and not (sized & ~other).any():
        raise _no_outsole([n for n, t in zip(bodies.names, sized, strict=True) if t], where)
    if (other & sized).any():
        return sized & ~other, [
            _taken_remark(bodies, sized & ~other, sized, Message("by the others' names"))
        ]
    return sized, []


def _taken_remark(bodies: _Bodies, keep: Mask, sized: Mask, how: Message) -> Message:
    left = _list_names(
        [n for n, k, t in zip(bodies.names, keep, sized, strict=True) if t and not k]
    )
    taken = _list_names([n for n, k in zip(bodies.names, keep, strict=True) if k])
    rest = Message("; left out: {names}", names=left) if left else ""
    return Message("Outsole {how}: {names}{rest}.", how=how, names=taken, rest=rest)


def _list_names(names: list[str]) -> Message:
    quoted = [Message('"{name}"', name=name) for name in dict.fromkeys(names)]
    more = Message(" and {count} more", count=len(quoted) - 4) if len(quoted) > 4 else ""
    return Message("{names}{more}", names=quoted[:4], more=more)


def _without_supports(bodies: _Bodies, keep: Mask) -> tuple[Mask, list[Message]]:
    """Return the bodies without slender ones that stand out upright, and where those stand."""
    size = bodies.size
    slender = keep & (size[:, 2] > _SLENDER * size[:, :2].max(axis=1))
    slender &= size[:, 0] < 0.1 * size[keep, 0].max()
    rest = keep & ~slender
    if not slender.any() or not rest.any():
        return keep, []
    beyond = np.maximum(
        bodies.low[rest, 2].min() - bodies.low[:, 2], bodies.high[:, 2] - bodies.high[rest, 2].max()
    )
    slender &= beyond > size[:, :2].max(axis=1)
    if not slender.any():
        return keep, []
    first = int(np.flatnonzero(slender)[0])
    middle = (bodies.low[first] + bodies.high[first]) / 2 @ bodies.axes
    told = Message(
        "{count} slender {count:body|bodies} (print supports), up to {thickness:.3g} thick, "
        "{count:|the first }at ({place}) in the file, left out.",
        count=slender.sum(),
        thickness=size[slender, :2].max(),
        place=[f"{value:.4g}" for value in middle],
    )
    return keep & ~slender, [told]


def _without_plates(bodies: _Bodies, keep: Mask) -> tuple[Mask, list[Message]]:
    """Return the bodies without flat boxes as large as the rest: a build plate, a table."""
    length, width, height = bodies.size.T
    box = 2 * (length * width + (length + width) * height)
    plates = keep & (np.abs(bodies.area - box) < _BOX * box) & (height < _PLATE * width)
    # a base is one with its lugs, so that what is left of plates carries nothing
    others = bodies.size[keep & ~plates, :2].max(axis=0, initial=0.0)
    plates &= (others > _ON_TABLE * bodies.size[:, :2]).all(axis=1)
    plates &= (bodies.size[:, :2] > _BIG[1] * others).all(axis=1)
    rest = keep & ~plates
    middle = (bodies.low + bodies.high)[:, 2] / 2
    # what lies within the rest is a cavity or a core
    plates &= (middle < bodies.low[rest, 2].min(initial=np.inf)) | (
        middle > bodies.high[rest, 2].max(initial=-np.inf)
    )
    if not plates.any():
        return keep, []
    rest = keep & ~plates
    named = _list_names([n for n, p in zip(bodies.names, plates, strict=True) if p])
    return rest, [
        assumption_line("{names} is a plate under or over the sole and was left out.", names=named)
    ]


def _pair(bodies: _Bodies, keep: Mask) -> tuple[Mask, Mask] | None:
    """Return the bodies of both shoes where a gap parts two groups of the same size."""
    number = np.flatnonzero(keep)
    for axis in (1, 0, 2):
        order = number[np.argsort(bodies.low[number, axis])]
        reached = np.maximum.accumulate(bodies.high[order, axis])
        for cut in np.flatnonzero(bodies.low[order[1:], axis] > reached[:-1]) + 1:
            groups = np.zeros_like(keep), np.zeros_like(keep)
            groups[0][order[:cut]], groups[1][order[cut:]] = True, True
            sizes = [bodies.high[g].max(axis=0) - bodies.low[g].min(axis=0) for g in groups]
            areas = [float(bodies.area[g].sum()) for g in groups]
            same = np.abs(sizes[0] - sizes[1]) <= _SAME * np.maximum(*sizes)
            # one above the other: a plate and its lugs are as long and wide, but not as high
            alike = same if axis == 2 else same[:2]
            if alike.all() and abs(areas[0] - areas[1]) <= 0.1 * max(areas):
                return groups
    return None


def _of_pair(
    mesh: Mesh, pair: tuple[Mask, Mask], settings: FileSettings, where: str, remarks: list[Message]
) -> Found:
    if settings.side == "auto":
        raise DataError(
            "the file holds a pair: two soles of the same size beside each other",
            where=where,
            allowed="one sole",
            remedy='Choose one with --side left or --side right (in a case: side = "left"), or '
            "export one alone",
        )
    told = Message(
        "Of the pair in the file the {side} shoe was taken, as chosen.", side=settings.side
    )
    return Found(tuple(_part(mesh, one) for one in pair), None, (*remarks, told))


def _without_stack(
    mesh: Mesh, bodies: _Bodies, keep: Mask, settings: FileSettings
) -> tuple[Mask, Array | None, list[Message]]:
    """Return the bodies of the outsole of a stack, where the ground is, and how it was told."""
    sorted_size = np.sort(bodies.size, axis=1)[:, ::-1]
    longest = float(sorted_size[keep, 0].max())
    big = keep & (sorted_size[:, 0] > _BIG[0] * longest)
    big &= sorted_size[:, 1] > _BIG[1] * sorted_size[big, 1].max()
    big &= sorted_size[:, 2] > _SHEET * longest
    if big.sum() < 2:
        return keep, None, []
    part = {axis: _parting(bodies.low[big, axis], bodies.high[big, axis]) for axis in (1, 2)}
    axis = max(part, key=lambda name: part[name])
    if part[axis] < _PARTED:
        return keep, None, []
    middle = (bodies.low + bodies.high)[:, axis] / 2
    number = np.flatnonzero(big)
    low_end, high_end = number[np.argmin(middle[number])], number[np.argmax(middle[number])]
    groups = (
        keep & ~big & (middle <= bodies.high[low_end, axis]),
        keep & ~big & (middle >= bodies.low[high_end, axis]),
    )
    for each, end in zip(groups, (low_end, high_end), strict=True):
        each[end] = True
        each |= big & _level_with(bodies, end, axis)
    unit = mesh.unit or likely_unit(longest, float(sorted_size[big, 1].max()))
    ends = [_part(mesh, one) for one in groups]
    shares = [_treads(each, bodies.axes, axis, unit, longest)[n] for n, each in enumerate(ends)]
    most, least = max(shares), min(shares)
    sure = _clear(shares)
    up = bodies.axes[axis]
    upward = bool(up[int(np.argmax(np.abs(up)))] > 0)
    below = shares[0] == most if sure else upward
    group = groups[0] if below else groups[1]
    down = None if settings.down in DIRECTIONS else -up if below else up
    how = Message("the lower one of the file; no tread tells")
    if sure:
        how = Message(
            "determined as the end of the stack that carries the tread (channels over {most:.0%} "
            "of it, {least:.0%} at the other end)",
            most=most,
            least=least,
        )
    taken = _taken_remark(bodies, group, keep, Message("of a stack of bodies"))
    told = Remark("" if sure else ASSUMED, "{taken} It is {how}.", taken=taken, how=how)
    return group, down, [told]


def _level_with(bodies: _Bodies, number: int, axis: int) -> Mask:
    """Return the bodies at the height of a body and beside it, as heel and forepart of a sole."""
    overlap = np.minimum(bodies.high, bodies.high[number]) - np.maximum(
        bodies.low, bodies.low[number]
    )
    share = overlap / np.maximum(np.minimum(bodies.size, bodies.size[number]), 1e-12)
    beside = np.delete(share, axis, axis=1).min(axis=1) < _BESIDE
    return (share[:, axis] > 1 - _PARTED) & beside


def _parting(low: Array, high: Array) -> float:
    """Return how far bodies lie apart along an axis: 1 minus the mean overlap of neighbours."""
    order = np.argsort(low + high)
    low, high = low[order], high[order]
    overlap = np.minimum(high[:-1], high[1:]) - np.maximum(low[:-1], low[1:])
    shortest = np.minimum(high - low, np.inf)
    shortest = np.minimum(shortest[:-1], shortest[1:])
    return float(np.mean(1 - np.clip(overlap / shortest, 0, 1)))


def _beside(outsole: Found, bodies: _Bodies, keep: Mask, others: Mask) -> Found:
    """Return what was found with the ground's side, where the other bodies lie on one side.

    The ground lies towards a floor and away from another part of a shoe. Where no name tells which
    of them the others are, the tread does, if it is on one side only; else they are parts of a
    shoe.
    """
    box = bodies.low[keep].min(axis=0), bodies.high[keep].max(axis=0)
    big = others & (bodies.size[:, 0] > _BIG[0] * (box[1] - box[0])[0])
    floor = np.array([bool(_FLOOR_NAMES.search(name)) for name in bodies.names])
    shoe = np.array([_other(name) for name in bodies.names]) & ~floor
    telling = next((each for each in (big & shoe, big & floor, big) if each.any()), None)
    if telling is None:
        return outsole
    rest = bodies.low[telling].min(axis=0), bodies.high[telling].max(axis=0)
    offset = box[0] + box[1] - rest[0] - rest[1]
    parted = [_parting(np.stack([box[0], rest[0]])[:, n], np.stack([box[1], rest[1]])[:, n])
              for n in (1, 2)]  # fmt: skip
    axis = 1 + int(np.argmax(parted))
    if parted[axis - 1] < 0.5:
        return outsole
    away = np.sign(offset[axis]) * bodies.axes[axis]
    if (telling & shoe).any():
        return replace(outsole, down=away)
    if (telling & floor).any():
        return replace(
            outsole, down=-away, ground=Message("Ground side: towards the floor in the file")
        )
    mesh, (length, width) = outsole.meshes[0], (box[1] - box[0])[:2]
    unit = mesh.unit or likely_unit(float(length), float(width))
    shares = _treads(mesh, bodies.axes, axis, unit, float(length))
    towards = shares[0] > shares[1] if offset[axis] > 0 else shares[1] > shares[0]
    if _clear(shares) and towards:
        told = Message("the ground side is the one with the tread, towards the rest of the file")
        return replace(outsole, down=-away, ground=told, ground_assumed=True)
    return replace(outsole, down=away)


def _treads(mesh: Mesh, axes: Array, axis: int, unit: float, length: float) -> list[float]:
    """Return the share of channels below and above, seen along an axis of the bodies."""
    frame = axes if axis == 2 else axes[[0, 2, 1]] * [[1], [-1], [1]]
    seen = view(mesh.triangles, frame * unit, length * unit / _COARSE)
    return [tread_share(each, seen.spacing) for each in (seen.lowest, -seen.highest)]


def _clear(shares: list[float]) -> bool:
    return max(shares) > _CLEAR and max(shares) > _CLEARER * min(shares)
