"""From a file to the bottom of a sole in its own frame, with a remark on every decision."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError, InputError
from underfoot.core.arrays import Array
from underfoot.core.remark import ASSUMED, Message, Remark, assumption_line

from ..geometry import SoleSurface, centred_places
from ..tread_measures import (
    QUIET,
    WIDEST_CHANNEL,
    TreadMap,
    arch_area,
    height_noise,
    lower_lugs,
    tread_map,
    without_noise,
)
from . import orientation
from .bodies import Found, found_outsole
from .cleaning import clean_height_map, plan_outline, without_ledges
from .draft import wall_draft
from .edges import lug_lines, rim_lines
from .mesh import Mesh
from .no_sole import TALL, Shape, check_carried, check_sole, check_surface, check_tread
from .read import read_mesh
from .settings import DIRECTIONS, HEEL, SHARES, FileSettings, length_unit
from .view import Soundness, View, extents, soundness, view, view_remarks

_COARSE = 400  # cells along the sole for finding sides and plane
_NEARLY_SQUARE = 1.3
_MOST_TURN = math.radians(12)  # beyond it the sole stands on a stud or on its side
_SHEET = 0.05e-3
_PLAINLY_OFF = 2.0  # off centre across over that along: a piece is broader than long
_LONGEST_LAG = 1.5e-3  # m: walls stand farther apart
_POINTS_NOISE = math.sqrt(2.0)  # a height within a face weighs three points: mean sum w^2 = 1/2
_NOISY = 10e-6  # m, of heights: a scan's
_ARCH = 0.02  # of the plan form: smaller ones are not told


@dataclass(frozen=True, slots=True)
class FileOutsole:
    """An outsole read from a file.

    Parameters:
        surface: Its bottom in its own frame; ``surface.remarks`` lists what was determined,
            assumed, repaired or tolerated.
        format, unit, down, forward, foot, faces: What the file is; ``unit`` in m, directions in the
            file's axes, ``foot`` "" if not determined.
        soundness: Counts of what is wrong with the mesh.
        thickness: Median distance of both sides of the file's body over the land, m; None for a
            surface without thickness.
        whole_length: Of the sole before the region was cut, m.
        draft: Median angle of the channels' walls from upright, rad; None without walls.
        edges, sides: (n, 2, 2) m, lines in plan at which lugs end, and the body above them; none of
            a scan.
    """

    surface: SoleSurface
    format: str
    unit: float
    down: str
    forward: str
    foot: str
    faces: int
    soundness: Soundness
    thickness: float | None
    whole_length: float
    draft: float | None
    edges: Array
    sides: Array


def outsole_from_file(path: Path | str, settings: FileSettings | None = None) -> FileOutsole:
    """Return the outsole in a file.

    Raises:
        InputError, DataError: See ``read_mesh`` and ``outsole_from_mesh``.
    """
    path = Path(path)
    unit = settings.unit if settings else "auto"
    return outsole_from_mesh(read_mesh(path, unit), settings, name=path.name, where=str(path))


def outsole_from_mesh(
    mesh: Mesh, settings: FileSettings | None = None, *, name: str = "mesh", where: str = "mesh"
) -> FileOutsole:
    """Return the outsole that triangles describe.

    Bodies, unit, ground side, heel end, foot, resting plane, region and tread are determined in
    this order; each decision and each repair is a sentence of ``surface.remarks``, guesses are
    remarks about ``ASSUMED``.

    Raises:
        InputError: No unit makes it a sole; a region it doesn't have; a grid too fine or too
            coarse; no body of the name asked for.
        DataError: No face with an area; a pair; a shape that is no sole.
    """
    chosen = settings or FileSettings()
    mesh = replace(mesh, triangles=np.ascontiguousarray(mesh.triangles, dtype=np.float32))
    sound = soundness(mesh, where)
    check_surface(sound, where)
    outsole = found_outsole(mesh, chosen, where)
    remarks = [*mesh.remarks, *outsole.remarks]
    if len(outsole.meshes) == 1:
        if chosen.side != "auto":
            told = Message("The file holds one shoe: there is no pair to choose from.")
            remarks.append(told)
        return _outsole(outsole.meshes[0], sound, outsole, remarks, chosen, name, where)
    shoes = [_outsole(one, sound, outsole, remarks, chosen, name, where) for one in outsole.meshes]
    matching = [shoe for shoe in shoes if shoe.foot == chosen.side]
    if len(matching) != 1:
        feet = " and ".join(shoe.foot or "not determined" for shoe in shoes)
        raise DataError(
            Message(
                "the {side} shoe of the pair can't be told: the feet are {feet}",
                side=chosen.side,
                feet=feet,
            ),
            where=where,
            remedy="Export one shoe alone",
        )
    return matching[0]


def _outsole(
    mesh: Mesh,
    sound: Soundness,
    told: Found,
    remarks: list[Message],
    chosen: FileSettings,
    name: str,
    where: str,
) -> FileOutsole:
    """Return the outsole that the triangles of one sole describe."""
    remarks = list(remarks)
    axes = orientation.box_axes(mesh.triangles, chosen, told.down)
    axes, askew = orientation.on_its_faces(mesh.triangles, axes)
    low, high = extents(mesh.triangles, axes)
    size = high - low
    stated = None if chosen.unit != "auto" else mesh.unit
    unit, _ = length_unit(
        float(max(size[:2])), float(min(size[:2])), chosen=chosen.unit, in_file=stated, where=where
    )
    lag = _lag(mesh.triangles, unit, chosen.spacing)
    axes, side_remarks, alike = _sides(mesh, axes, unit, chosen, told)
    seen, axes, level_remarks = _level_view(mesh, axes, chosen.spacing, askew)
    height, repaired = clean_height_map(seen.lowest, seen.spacing)
    whole = height
    rows, columns = (np.nonzero(np.isfinite(height).any(axis=n))[0] for n in (1, 0))
    part = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    height = height[part]
    thickness = (seen.highest - seen.lowest)[part]
    whole_length, width = rows.size * seen.spacing, height.shape[1] * seen.spacing
    _, unit_remark = length_unit(
        whole_length / unit, width / unit, chosen=chosen.unit, in_file=stated or unit, where=where
    )
    if stated is None and chosen.unit == "auto":
        _, unit_remark = length_unit(whole_length / unit, width / unit, where=where)
    remarks += [unit_remark, *side_remarks, *level_remarks, *sound.remarks()]
    remarks += [*view_remarks(seen, sound, mesh, where), *repaired]
    foot, foot_remark = chosen.foot if chosen.foot != "auto" else "", ""
    if whole_length > HEEL[1]:  # the bend of a heel tells nothing
        foot, foot_remark = orientation.foot_of(np.isfinite(height), seen.spacing, chosen)
    remarks += [foot_remark] if foot_remark else []
    if chosen.mirror:
        height, thickness = height[:, ::-1], thickness[:, ::-1]
        foot = {"left": "right", "right": "left", "": ""}[foot]
        remarks.append(Message("Mirrored: the other shoe of the pair."))
    low, high = extents(mesh.triangles, axes)
    shape = Shape(
        height=height,
        spacing=seen.spacing,
        thickness=float(np.median(thickness[np.isfinite(height)])),
        tallness=float(high[2] - low[2]),
        standing=orientation.standing_share(height, seen.spacing),
        # bars across one axis are quiet along the other
        noise=min(height_noise(height), height_noise(height.T)),
    )
    check_sole(shape, where)
    height, block, region_remarks = _region(height, seen.spacing, chosen, where)
    thickness = thickness[block]
    remarks += region_remarks
    surface, tread_remarks, tread = _surface(height, seen.spacing, name, lag)
    remarks += tread_remarks
    check_carried(surface.inside, surface.land, seen.spacing, mesh.unmet, where)
    if alike and whole_length > HEEL[1]:
        check_tread(shape, bool((surface.inside & ~surface.land).any()), where)
    body = float(np.median(thickness[surface.land]))
    # the file's faces in the frame of the surface: turned, cropped, mirrored and cut as its heights
    across = np.diag([1.0, -1.0 if chosen.mirror else 1.0, 1.0])
    corner = rows[0], columns[-1] if chosen.mirror else columns[0]
    first = np.append(seen.first + np.array(corner) * seen.spacing, seen.level) @ across
    cut = np.array([each.start or 0 for each in block]) * seen.spacing
    first[:2] += cut - np.array([surface.x[0], surface.y[0]])
    faces = (mesh.triangles, across @ axes, first, surface)
    none, lugs = np.empty((0, 2, 2)), surface.tread_depth[surface.tread_depth > 0]
    quiet = tread.noise <= _NOISY
    deep = float(lugs.max()) if lugs.size else 0.0
    return FileOutsole(
        surface=replace(surface, remarks=tuple(remarks)),
        format=mesh.format,
        unit=unit,
        down=orientation.named_direction(-axes[2] / np.linalg.norm(axes[2])),
        forward=orientation.named_direction(axes[0] / np.linalg.norm(axes[0])),
        foot=foot,
        faces=mesh.triangles.shape[0],
        soundness=sound,
        thickness=body if body > _SHEET else None,
        whole_length=whole_length,
        draft=wall_draft(mesh.triangles, seen, whole),
        edges=lug_lines(*faces, tread.level) if lugs.size and quiet else none,
        sides=rim_lines(*faces, (body + deep) / 2) if body > deep + _SHEET and quiet else none,
    )


def _lag(triangles: NDArray[np.float32], unit: float, spacing: float) -> int:
    """Return how many cells apart heights come from different corners of the mesh."""
    sample = triangles[:: max(1, triangles.shape[0] // 20_000)]
    edges = np.linalg.norm(sample[:, 1] - sample[:, 0], axis=1)
    edges = edges[np.isfinite(edges)]
    apart = float(np.median(edges)) * unit if edges.size else 0.0
    return max(1, math.ceil(min(apart, _LONGEST_LAG) / spacing))


def _sides(
    mesh: Mesh, axes: Array, unit: float, chosen: FileSettings, told: Found
) -> tuple[Array, list[Message], bool]:
    """Return the axes forward, left, up (rows, m per unit of the file), how they were found, and
    whether the ground side is a guess.
    """
    low, high = extents(mesh.triangles, axes * unit)
    ground = None
    if told.down is not None:
        ground = orientation.AxisDecision(-1, told.ground, told.ground_assumed)
    elif chosen.down == "auto" and high[2] - low[2] > TALL * (high[1] - low[1]):
        axes, ground = orientation.standing_axes(mesh.triangles, axes, unit)
        low, high = extents(mesh.triangles, axes * unit)
    coarse = max(float(max(high[:2] - low[:2])) / _COARSE, chosen.spacing)
    seen = view(mesh.triangles, axes * unit, coarse)
    if ground is None:
        ground = orientation.ground_side(seen, chosen)
    plan = seen.covered
    along, across, thin = axes
    if ground.sign < 0:
        across, thin, plan = -across, -thin, plan[:, ::-1]
    size = [float(high[n] - low[n]) for n in range(2)]
    square = max(size) < _NEARLY_SQUARE * min(size)
    free = chosen.forward not in DIRECTIONS and square
    offsets = [abs(orientation.off_centre(plan, axis)) for axis in (0, 1)]
    ends = [np.ptp(orientation.straight_ends(plan, axis)) for axis in (0, 1)]
    if max(ends) > orientation.ONE_STRAIGHT_END:  # the cut of a piece
        turn = ends[1] > ends[0]
    else:
        turn = offsets[1] > _PLAINLY_OFF * max(offsets[0], orientation.OFF_CENTRE)
    if free and turn:
        along, across, plan = across, -along, plan.T[:, ::-1]
    toe = orientation.toe_end(plan, coarse, chosen)
    if toe.sign < 0:
        along, across = -along, -across
    turned = np.stack([along, across, thin])
    remarks: list[Message] = [
        Remark(
            ASSUMED if choice.assumed else "",
            "{how} ({name} is {axis} of the file).",
            how=choice.remark,
            name=name,
            axis=orientation.named_direction(axis),
        )
        for choice, name, axis in ((ground, "down", -thin), (toe, "forward", along))
        if choice.remark
    ]
    return turned * unit, remarks, ground.assumed


def _level_view(
    mesh: Mesh, axes: Array, spacing: float, askew: float
) -> tuple[View, Array, list[Message]]:
    """Return the fine view in the resting plane's frame: z = 0 is the plane.

    ``askew`` (rad): by how much the sole was turned onto its faces before.
    """
    seen = view(mesh.triangles, axes, spacing)
    total = askew
    remarks: list[Message] = []
    for _ in range(3):
        height, _ = clean_height_map(seen.lowest, spacing)
        plane = orientation.resting_plane(height, spacing)
        turned, angle = orientation.level_axes(axes, plane)
        if angle < orientation.LEVEL:
            break
        if angle > _MOST_TURN and not orientation.broad_rest(height, spacing, plane):
            remarks.append(
                Message(
                    "It would rest {angle:.0f}° off level, on few points: left as it lies.",
                    angle=math.degrees(angle),
                )
            )
            break
        total += angle
        axes = turned
        seen = view(mesh.triangles, axes, spacing)
    height, _ = clean_height_map(seen.lowest, spacing)
    if total > 0:
        turn, other = math.degrees(total), orientation.other_rest(height, spacing)
        if other is None:
            remarks.append(
                Message(
                    "Turned by {turn:.2g}° so that it rests on its lowest lugs; toe spring is "
                    "kept.",
                    turn=turn,
                )
            )
        else:  # a file that lies level says itself which of them is the floor's
            share, angle = other
            remarks.append(
                assumption_line(
                    "turned by {turn:.2g}° so that it rests on its lowest lugs; a face of "
                    "{share:.0%} of it, {angle:.2g}° off, could stand on the floor as well. Lay "
                    "the file level in CAD to choose.",
                    turn=turn,
                    share=share,
                    angle=math.degrees(angle),
                )
            )
    a, b, c = orientation.resting_plane(height, spacing)
    centre = [(n - 1) / 2 * spacing for n in height.shape]
    level = a * centre[0] + b * centre[1] + c
    lifted = replace(
        seen, lowest=seen.lowest - level, highest=seen.highest - level, level=float(level)
    )
    return lifted, axes, remarks


def _region(
    height: Array, spacing: float, chosen: FileSettings, where: str
) -> tuple[Array, tuple[slice, slice], list[Message]]:
    length = height.shape[0] * spacing
    everything = (slice(None), slice(None))
    if chosen.region == "whole" and chosen.region_length is None:
        return height, everything, []
    piece = length <= HEEL[1]
    if chosen.region == "forepart" and piece:
        raise InputError(
            Message("a heel piece of {length:.4g} mm has no forepart", length=length * 1000.0),
            where="outsole.region",
            allowed='"heel" or "whole"',
        )
    extent = chosen.region_length
    if extent is None:
        extent = length if piece else SHARES[chosen.region] * length
    if extent > length * (1 + 1e-9):
        raise InputError(
            Message(
                "the region is {extent:.4g} mm long, the sole only {length:.4g} mm",
                extent=extent * 1000.0,
                length=length * 1000.0,
            ),
            where="outsole.region_length",
            allowed=Message("at most {most:.4g} mm", most=length * 1000.0),
        )
    count = max(1, round(extent / spacing))
    cut = slice(height.shape[0] - count, None) if chosen.region == "forepart" else slice(0, count)
    if not np.isfinite(height[cut]).any():
        raise InputError(
            Message(
                "nothing of the sole of {where} lies in the {region} region",
                where=where,
                region=chosen.region,
            ),
            where="outsole.region",
            remedy="Check forward and region_length",
        )
    part = height[cut]
    columns = np.nonzero(np.isfinite(part).any(axis=0))[0]
    block = (cut, slice(int(columns[0]), int(columns[-1]) + 1))
    if count == height.shape[0]:
        return height[block], block, []
    lengths = {"length": count * spacing * 1e3, "whole": length * 1e3}
    if chosen.region == "forepart":
        told = Message(
            "Cut to the forepart {length:.4g} mm of {whole:.4g} mm; channels that cross the cut "
            "count as open there.",
            **lengths,
        )
    else:
        told = Message(
            "Cut to the rear {length:.4g} mm of {whole:.4g} mm; channels that cross the cut count "
            "as open there.",
            **lengths,
        )
    return height[block], block, [told]


def _surface(
    height: Array, spacing: float, name: str, lag: int
) -> tuple[SoleSurface, list[Message], TreadMap]:
    tread = tread_map(height, spacing, lag=lag)
    lugs = tread.tread_depth[tread.tread_depth > 0]
    deep = float(np.median(lugs)) if lugs.size else 0.0
    height, cut_open, remarks = without_ledges(height, tread.land, tread.base, spacing, deep)
    if remarks or cut_open.any() or not np.isfinite(height[tread.land]).all():
        tread = tread_map(height, spacing, channels=cut_open, lag=lag)
    inside = np.isfinite(height)
    x = (np.arange(height.shape[0], dtype=np.float64) + 0.5) * spacing
    y = centred_places(height.shape[1], spacing)
    remarks.append(
        Message(
            "Land is what stands within {height:.2g} mm of the floor side; channels are deeper.",
            height=tread.level * 1e3,
        )
    )
    if tread.noise > _NOISY:
        points = _POINTS_NOISE * tread.noise
        off = Message("; planes through the land take it off") if tread.noise > QUIET else ""
        remarks.append(
            Message(
                "The scan's points carry noise of {noise:.0f} um (standard deviation){off}.",
                noise=points * 1e6,
                off=off,
            )
        )
        height = without_noise(height, tread.land, tread.noise, spacing, lag)
    arch = arch_area(tread, inside, spacing)
    if arch > _ARCH * np.count_nonzero(inside) * spacing**2:
        remarks.append(
            Message(
                "Hollows wider than {width:.0f} mm ({area:.3g} cm², an arch) are "
                "no land; they don't count in depth and width of the channels.",
                width=WIDEST_CHANNEL * 1e3,
                area=arch * 1e4,
            )
        )
    below = np.where(inside, height - tread.base, np.nan)
    lower = lower_lugs(below, inside & ~tread.land, spacing)
    if np.count_nonzero(lower) > _ARCH * np.count_nonzero(inside):
        less = float(np.median(below[lower])) * 1e3
        remarks.append(
            Message(
                "Lugs that stand {depth:.2g} mm lower than those around them "
                "({area:.3g} cm²) are no land; channels beside them count with "
                "their own depth and width.",
                depth=less,
                area=np.count_nonzero(lower) * spacing**2 * 1e4,
            )
        )
    surface = SoleSurface(
        x=x,
        y=y,
        height=height,
        land=tread.land,
        tread_depth=tread.tread_depth,
        spacing=spacing,
        outline=plan_outline(inside, x, y, spacing),
        name=name,
        base=tread.base,
    )
    return surface, remarks, tread
