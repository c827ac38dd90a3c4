"""Soles on square cells: in their own frame, and tilted over the floor."""

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from underfoot.core import Breach, ConvergenceError, InputError, ValidityRange, breaches
from underfoot.core.arrays import Array, Mask
from underfoot.core.checks import between, not_negative, positive
from underfoot.core.remark import Message

from ._kernels.regions import distance_to, nearest_true
from .cut_cells import Cells, cut_cells
from .geometry import (
    BESIDE_A_WALL,
    CELLS_REFUSED,
    CELLS_WANTED,
    SoleMap,
    SoleSurface,
    centred_places,
)
from .shape import Heel, SoleShape
from .slits import Slits, slits_of, without_slits
from .tread import Sipes

HALF, NARROW = 50.0, 10.0
"""Percentiles of the local width by area: what is refused, and what is listed."""
_EXACT = 1e-15  # m
_FAR = 1.0
"""m: the distance to a channel where there is none."""


def heel_map(
    heel: SoleShape, *, shoe_angle: float, spacing: float, padding: float = 0.004, columns: int = 1
) -> SoleMap:
    """Return the heel, tilted by the shoe angle, on a grid of cells in the floor's frame.

    A point (x, z) of the heel goes to x' = x cos a - z sin a, z' = x sin a + z cos a. The map
    follows the land surface exactly; a channel keeps its depth straight above the land it cuts.
    Tread and land are decided in the untilted frame.

    Parameters:
        heel: The heel in its own frame.
        shoe_angle: a, rad, toe up positive, -30 to 60 deg.
        spacing: Side of a cell, m. A channel or lug of fewer than 2 cells is refused, one of fewer
            than 4 is listed in ``SoleMap.breaches``.
        padding: Free margin around the plan form, m.
        columns: Cells along x in one spacing: 1 makes square cells.

    Raises:
        InputError: Grid too coarse for the plan form, a channel or a lug; angle out of range.
    """
    _check_grid(heel, shoe_angle, spacing, padding)
    breaches_of_grid = _resolution(heel, spacing)
    cosine, sine = math.cos(shoe_angle), math.sin(shoe_angle)

    def along(x: Array, y: Array) -> Array:
        return x * cosine - heel.land_height(x, y) * sine

    ends = along(np.array([0.0, heel.length]), np.zeros(2))
    rear = float(ends[0])
    margin = max(1, math.ceil(padding / spacing - 1e-9))
    count_x = math.ceil((ends[1] - rear) / spacing - 1e-9) + 2 * margin
    count_y = math.ceil(heel.width / spacing - 1e-9) + 2 * margin
    x_floor = _centres(count_x, margin, spacing, columns)
    y = centred_places(count_y, spacing)
    target, y_map = (np.asarray(each) for each in np.meshgrid(x_floor + rear, y, indexing="ij"))
    if sine == 0.0:
        x = target
    else:
        x = _solve_place(along, target, y_map, -2 * margin * spacing - heel.length, 3 * heel.length)
    inside = heel.inward_distance(x, y_map) > 0
    height, land, tread_depth = cut_heel(heel, x, y_map, spacing)
    stretch = np.gradient(x, axis=0)

    def level_at(i: Cells, j: Cells, along: Array, across: Array) -> Array:
        place = (x[i, j] + along * stretch[i, j], y_map[i, j] + across * spacing)
        return channel_level(heel, *place, spacing)

    cut = cut_cells(channel_level(heel, x, y_map, spacing), inside, level_at)
    land &= inside
    slits = _heel_slits(heel, (x, y_map, stretch), (inside, land), spacing)
    if slits is not None:
        cut = without_slits(cut, slits, land)
    clearance = np.where(inside, x * sine + height * cosine, np.inf)
    if inside.any():
        clearance -= clearance.min()
    rim = plan_outline(heel)
    return SoleMap(
        x=x_floor,
        y=y,
        clearance=clearance,
        inside=inside,
        land=land,
        tread_depth=np.where(land, tread_depth, 0.0),
        spacing=float(spacing),
        columns=columns,
        outline=np.column_stack([along(rim[:, 0], rim[:, 1]) - rear, rim[:, 1]]),
        breaches=tuple(breaches_of_grid),
        cut=cut,
        slits=slits,
        removed=None if heel.wear is None else heel.worn_off(x, y_map),
    )


def _heel_slits(
    heel: SoleShape, places: tuple[Array, Array, Array], masks: tuple[Mask, Mask], spacing: float
) -> Slits | None:
    """Return the sipes that the grid is too coarse for, at ``places`` (x, y, dx per cell)."""
    tread = heel.tread
    if (
        tread is None
        or tread.depth == 0
        or tread.sipes is None
        or _shows_slits(tread.sipes, spacing)
    ):
        return None
    x, y, stretch = places
    inside, land = masks
    sipes = tread.sipes

    def level_at(i: Cells, j: Cells, along: Array, across: Array) -> Array:
        return tread.slit_distance(x[i, j] + along * stretch[i, j], y[i, j] + across * spacing)

    angle = sipes.angle + tread.yaw
    return slits_of(
        tread.slit_distance(x, y) > -1.5 * spacing,
        land,
        inside,
        spacing,
        level_at,
        depth=np.maximum(sipes.depth - heel.worn_off(x, y), 0.0),
        width=np.full(x.shape, sipes.width),
        tangent=(np.full(x.shape, math.sin(angle)), np.full(x.shape, math.cos(angle))),
    )


def _shows_slits(sipes: Sipes, spacing: float) -> bool:
    """Return whether cells of ``spacing`` (m) show slits as channels."""
    return spacing <= sipes.width / CELLS_REFUSED * (1 + 1e-9)


def _centres(count: int, margin: int, spacing: float, columns: int) -> Array:
    """Return the centres along x of ``count`` spacings in ``columns`` cells each, m."""
    return ((np.arange(count * columns, dtype=np.float64) + 0.5) / columns - margin) * spacing


def _check_grid(
    sole: SoleShape | SoleSurface, shoe_angle: float, spacing: float, padding: float
) -> None:
    positive(spacing, "grid.spacing")
    not_negative(padding, "grid.padding")
    between(shoe_angle, math.radians(-30), math.radians(60), "shoe_angle", "-30 deg to 60 deg")
    smallest = min(sole.length, sole.width)
    if smallest < CELLS_WANTED * spacing:
        raise InputError(
            Message(
                "the plan form is {smallest:g} mm small, the grid spacing {spacing:g} mm",
                smallest=smallest * 1000.0,
                spacing=spacing * 1000.0,
            ),
            where="grid.spacing",
            allowed=Message(
                "at most {smallest:.3g} mm for this plan form",
                smallest=smallest / CELLS_WANTED * 1000.0,
            ),
        )


_ACROSS = {
    "channel": Message("cells of the grid across the channel"),
    "lug": Message("cells of the grid across the lug"),
    "groove": Message("cells of the grid across the groove"),
    "sipe": Message("cells of the grid across the sipe"),
    "arc channel": Message("cells of the grid across the arc channel"),
}
_NARROWEST = {
    "channel": Message("cells of the grid across the narrowest tenth of the channels"),
    "lug": Message("cells of the grid across the narrowest tenth of the lugs"),
}


def _few_cells(quantity: str, cells: float) -> list[Breach]:
    tested = ValidityRange(CELLS_WANTED, math.inf, "1", "grid refinement of the tread")
    return breaches("grid", {quantity: tested}, {quantity: cells})


def _solve_place(
    along: Callable[[Array, Array], Array], target: Array, y: Array, low: float, high: float
) -> Array:
    """Return the x of the sole whose place on the floor is ``target``, between two x."""
    from scipy.optimize.elementwise import find_root

    rich_result = find_root(
        lambda x, place, across: along(x, across) - place,
        (np.full_like(target, low), np.full_like(target, high)),
        args=(target, y),
        tolerances={"xatol": _EXACT, "xrtol": 0.0, "fatol": 0.0, "frtol": 0.0},
    )
    if not rich_result.success.all():
        raise ConvergenceError("a place on the floor was not found on the sole", where="shoe")
    return rich_result.x


def cut_heel(
    heel: SoleShape, x: Array, y: Array, spacing: float = 0.0
) -> tuple[Array, Mask, Array]:
    """Return height over the sole plane, land and lug height, all in the frame of the sole.

    Sipes narrower than two cells of ``spacing`` are left out: ``SoleMap.slits`` has them.
    """
    unworn = heel.unworn_height(x, y)
    base = heel.land_height(x, y)
    height, land, lug = base.copy(), np.ones(x.shape, dtype=bool), np.zeros_like(x)
    tread = heel.tread
    if tread is not None and tread.depth > 0:
        into = tread.channel_distance(x, y)
        if tread.edge_radius > 0:
            edge = np.clip(tread.edge_radius + into, 0.0, tread.edge_radius)
            rounding = tread.edge_radius - np.sqrt(tread.edge_radius**2 - edge**2)
            height = np.maximum(unworn + rounding, base)
        if tread.edge_chamfer > 0:
            rise = np.clip(tread.edge_chamfer + into, 0.0, tread.edge_chamfer)
            height = np.maximum(unworn + rise, base)
        lug = np.maximum(tread.depth - (base - unworn), 0.0)
        channel = into > 0
        height, land = _cut(height, land, channel, unworn + tread.depth, base)
        sipes = tread.sipes
        if sipes is not None and _shows_slits(sipes, spacing):
            slit = ~channel & (tread.slit_distance(x, y) > 0)
            height, land = _cut(height, land, slit, unworn + sipes.depth, base)
    arc = heel.arc_channel
    if arc is not None and arc.depth > 0:
        into = arc.channel_distance(x, y)
        height, land = _cut(height, land, into > 0, unworn + arc.depth, base)
    return height, land, lug


def channel_level(heel: SoleShape, x: Array, y: Array, spacing: float = 0.0) -> Array:
    """Return the distance (m) into the open channels of ``cut_heel``: 0 or less on land."""
    depth, level = -heel.worn_off(x, y), np.full(x.shape, -_FAR)
    tread, arc = heel.tread, heel.arc_channel
    if tread is not None and tread.depth > 0:
        sipes = tread.sipes
        level = np.minimum(tread.channel_distance(x, y), depth + tread.depth)
        if sipes is not None and _shows_slits(sipes, spacing):
            slit = np.minimum(tread.slit_distance(x, y), depth + sipes.depth)
            level = np.maximum(level, slit)
    if arc is not None and arc.depth > 0:
        level = np.maximum(level, np.minimum(arc.channel_distance(x, y), depth + arc.depth))
    return level


def _cut(
    height: Array, land: Mask, channel: Mask, bottom: Array, base: Array
) -> tuple[Array, Mask]:
    """Return height and land with a channel; where wear has reached its bottom it is land."""
    open_channel = channel & (bottom > base)
    height = np.where(channel, np.maximum(np.where(open_channel, height, base), base), height)
    return np.where(open_channel, np.maximum(height, bottom), height), land & ~open_channel


def _resolution(heel: SoleShape, spacing: float) -> list[Breach]:
    """Return what the grid resolves with too few cells; refuse what it cannot show at all."""
    features: list[tuple[str, str, float]] = []
    unresolved: list[Breach] = []
    tread = heel.tread
    if tread is not None and tread.depth > 0:
        features.append(("tread.channel_width", "channel", tread.channel_width))
        features.append(("tread.lug_width", "lug", tread.smallest_lug))
        features += [("tread.grooves", "groove", groove.width) for groove in tread.grooves]
        if tread.sipes is not None and _shows_slits(tread.sipes, spacing):
            features.append(("tread.sipes.width", "sipe", tread.sipes.width))
    if heel.arc_channel is not None and heel.arc_channel.depth > 0:
        features.append(("arc_channel.width", "arc channel", heel.arc_channel.width))
    for where, name, width in features:
        cells = width / spacing
        if cells < CELLS_REFUSED * (1 - 1e-9):
            raise InputError(
                Message(
                    "the {name} of {width:g} mm spans {cells:.2g} cells of {spacing:g} mm",
                    name=name,
                    width=width * 1000.0,
                    cells=cells,
                    spacing=spacing * 1000.0,
                ),
                where=where,
                allowed=Message(
                    "at least {least:g} cells, {wanted:g} for a result to trust",
                    least=CELLS_REFUSED,
                    wanted=CELLS_WANTED,
                ),
                remedy=Message(
                    "Use a grid spacing of {spacing:.3g} mm or less",
                    spacing=width / CELLS_WANTED * 1000.0,
                ),
            )
        unresolved += _few_cells(_ACROSS[name], cells)
    return unresolved


def plan_outline(heel: SoleShape, nodes: int = 24) -> Array:
    """Return the closed polygon (n, 2) of the plan form in its own plane, m; anticlockwise."""
    if not isinstance(heel, Heel):
        from ._kernels.arcs import points_on

        return points_on(heel.rim_arcs(), 2e-3)
    half = heel.width / 2
    corners = (  # centre of the corner's circle, its radius, first angle; anticlockwise
        (heel.length - heel.front_radius, half - heel.front_radius, heel.front_radius, 0.0),
        (heel.rear_radius, half - heel.rear_radius, heel.rear_radius, 0.5),
        (heel.rear_radius, heel.rear_radius - half, heel.rear_radius, 1.0),
        (heel.length - heel.front_radius, heel.front_radius - half, heel.front_radius, 1.5),
    )
    points = []
    for x, y, radius, first in corners:
        angle = math.pi * (first + np.linspace(0.0, 0.5, nodes if radius > 0 else 1))
        points.append(np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)]))
    rim = np.concatenate(points)
    return np.concatenate([rim, rim[:1]])


def heel_surface(heel: SoleShape, *, spacing: float) -> SoleSurface:
    """Return the heel in its own frame on square cells of ``spacing`` (m).

    The cells begin at the rear end and are symmetric about the centre line. What ``heel_map`` makes
    of a heel at an angle, ``surface_map`` makes of this within the size of a cell.
    """
    positive(spacing, "spacing")
    count_x = math.ceil(heel.length / spacing - 1e-9)
    count_y = math.ceil(heel.width / spacing - 1e-9)
    x = (np.arange(count_x, dtype=np.float64) + 0.5) * spacing
    y = centred_places(count_y, spacing)
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    inside = heel.inward_distance(grid_x, grid_y) > 0
    height, land, tread_depth = cut_heel(heel, grid_x, grid_y, spacing)
    land &= inside
    return SoleSurface(
        x=x,
        y=y,
        height=np.where(inside, height, np.nan),
        land=land,
        tread_depth=np.where(land, tread_depth, 0.0),
        spacing=float(spacing),
        outline=plan_outline(heel),
        name="parametric heel",
        base=np.where(inside, heel.land_height(grid_x, grid_y), np.nan),
    )


def surface_map(
    surface: SoleSurface,
    *,
    shoe_angle: float,
    spacing: float,
    padding: float = 0.004,
    columns: int = 1,
) -> SoleMap:
    """Return the surface, tilted by the shoe angle, on a grid of cells in the floor's frame.

    A point (x, z) of the sole goes to x' = x cos a - z sin a, z' = x sin a + z cos a. The map
    follows the land (bilinear between cells) exactly, of several points over one cell the lowest;
    a channel keeps its depth straight above the land it cuts, as in ``heel_map``.

    Parameters:
        surface: The sole in its own frame.
        shoe_angle: a, rad, toe up positive, -30 to 60 deg.
        spacing: Side of a cell, m.
        padding: Free margin around the plan form, m.
        columns: Cells along x in one spacing: 1 makes square cells.

    Raises:
        InputError: Grid too coarse for the plan form or for most of the channels; angle out of
            range.
    """
    # compiled: numba takes a while to import
    from ._kernels.height_buffer import tilted_rows
    from .tread_measures import surface_without_slits

    _check_grid(surface, shoe_angle, spacing, padding)
    cosine, sine = math.cos(shoe_angle), math.sin(shoe_angle)
    surface, cuts = surface_without_slits(surface, CELLS_REFUSED * spacing)
    inside, base = surface.inside, _land_everywhere(surface)
    outline, rear = _outline_on_floor(surface, base, shoe_angle)
    margin = max(1, math.ceil(padding / spacing - 1e-9))
    count_x = math.ceil(float(outline[:, 0].max()) / spacing - 1e-9) + 2 * margin
    low, high = float(outline[:, 1].min()), float(outline[:, 1].max())
    count_y = math.ceil((high - low) / spacing - 1e-9) + 2 * margin
    x = _centres(count_x, margin, spacing, columns)
    y = (low + high) / 2 + centred_places(count_y, spacing)
    clearance, origin = tilted_rows(
        (surface.x, surface.y), base, inside, (x + rear, y), cosine, sine
    )
    covered = np.isfinite(clearance)
    cells = _cells(
        surface, np.where(covered, origin, surface.x[0]), np.broadcast_to(y, x.shape + y.shape)
    )
    above = _above_land(surface, base)
    clearance = np.where(covered, clearance + above[cells] * cosine, np.inf)
    if covered.any():
        clearance -= clearance.min()
    land = covered & surface.land[cells]
    origin = np.where(covered, origin, surface.x[0])
    stretch = np.gradient(origin, axis=0)
    into = _signed_distance(surface, surface.land, surface.inside & ~surface.land)

    def near(into: Callable[[Array, Array], Array]) -> Callable[..., Array]:
        def level_at(i: Cells, j: Cells, along: Array, across: Array) -> Array:
            return into(origin[i, j] + along * stretch[i, j], y[j] + across * spacing)

        return level_at

    level = into(origin, np.broadcast_to(y, origin.shape))
    level = np.where(land, np.minimum(level, 0.0), np.maximum(level, np.finfo(float).tiny))
    cut, slits = cut_cells(level, covered, near(into)), None
    if cuts is not None:
        into_slit = _signed_distance(surface, ~cuts.mask, cuts.mask)
        slits = slits_of(
            into_slit(origin, np.broadcast_to(y, origin.shape)) > -1.5 * spacing,
            land,
            covered,
            spacing,
            near(into_slit),
            depth=cuts.depth[cells],
            width=cuts.width[cells],
            tangent=(cuts.tangent[0][cells], cuts.tangent[1][cells]),
        )
        if slits is not None:
            cut = without_slits(cut, slits, land)
    return SoleMap(
        x=x,
        y=y,
        clearance=clearance,
        inside=covered,
        land=land,
        tread_depth=np.where(land, surface.tread_depth[cells], 0.0),
        spacing=float(spacing),
        columns=columns,
        outline=outline,
        breaches=tuple(resolution_breaches(surface, spacing)),
        cut=cut,
        slits=slits,
        removed=None if surface.removed is None else surface.removed[cells],
    )


def _above_land(surface: SoleSurface, base: Array) -> Array:
    """Return the height over the land's ``base`` (nx, ny), m: of channels that of their floor.

    Their walls, and tips of lugs too small to be land, move with the lugs beside them. At their
    own height they would be rigid studs where the lugs give way.
    """
    from scipy.ndimage import maximum_filter

    above = np.where(surface.inside, surface.height - base, 0.0)
    channel = surface.inside & ~surface.land
    window = 1 + 2 * max(1, round(BESIDE_A_WALL / surface.spacing))
    return np.where(channel, maximum_filter(np.where(channel, above, 0.0), window), above)


def floor_lines(
    surface: SoleSurface, sets: Sequence[Array], *, shoe_angle: float, spacing: float
) -> tuple[Array, ...]:
    """Return lines (n, 2, 2; m) in the plane of a surface as they lie on its ``surface_map``."""
    from .tread_measures import surface_without_slits

    surface, _ = surface_without_slits(surface, CELLS_REFUSED * spacing)
    base = _land_everywhere(surface)
    _, rear = _outline_on_floor(surface, base, shoe_angle)

    def on_floor(lines: Array) -> Array:
        x, y = np.moveaxis(lines, -1, 0)
        risen = base[_cells(surface, x, y)] * math.sin(shoe_angle)
        return np.stack([x * math.cos(shoe_angle) - risen - rear, y], axis=-1)

    return tuple(on_floor(lines) for lines in sets)


def _signed_distance(
    surface: SoleSurface, land: Mask, channel: Mask
) -> Callable[[Array, Array], Array]:
    """Return the distance (m) into ``channel`` from ``land`` at points (x, y)."""
    from scipy.ndimage import map_coordinates

    level = np.full(land.shape, -_FAR)
    if channel.any():
        to_land, to_channel = distance_to(land) - 0.5, distance_to(channel) - 0.5
        level = np.where(land, -to_channel, to_land) * surface.spacing

    def at(x: Array, y: Array) -> Array:
        place = [(x - surface.x[0]) / surface.spacing, (y - surface.y[0]) / surface.spacing]
        return np.asarray(
            map_coordinates(level, np.broadcast_arrays(*place), order=1, mode="nearest")
        )

    return at


def _cells(surface: SoleSurface, x: Array, y: Array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the indices of the cells that hold the points (x, y), the nearest where none does."""
    indices = []
    for value, centres in ((x, surface.x), (y, surface.y)):
        place = np.rint((value - centres[0]) / surface.spacing).astype(np.intp)
        indices.append(np.clip(place, 0, centres.size - 1))
    return indices[0], indices[1]


def resolution_breaches(surface: SoleSurface, spacing: float) -> list[Breach]:
    """Return what a grid of ``spacing`` (m) resolves with too few cells.

    By local width (the largest disc that covers a place), because a sole has no single channel
    width: listed when more than a tenth of the area of channels or of lugs is narrower than 4
    cells.

    Raises:
        InputError: More than half of the channels' or of the lugs' area is narrower than 2 cells.
    """
    channel = surface.inside & ~surface.land
    if not channel.any():
        return []
    from ._kernels.covering_discs import local_width  # compiled

    unresolved: list[Breach] = []
    for name, mask in (("channel", channel), ("lug", surface.land)):
        widths = local_width(mask, surface.spacing)[mask]
        narrow, half = (float(value) for value in np.percentile(widths, (NARROW, HALF)))
        # the width itself is known within half a cell of the height map
        if half + surface.spacing / 2 < CELLS_REFUSED * spacing * (1 - 1e-9):
            raise InputError(
                Message(
                    "half of the {name} area of {surface} is narrower than {width:.2g} mm, "
                    "{cells:.2g} cells of {spacing:g} mm",
                    name=name,
                    surface=surface.name,
                    width=half * 1000.0,
                    cells=half / spacing,
                    spacing=spacing * 1000.0,
                ),
                where="grid.spacing",
                allowed=Message(
                    "at least {least:g} cells, {wanted:g} for a result to trust",
                    least=CELLS_REFUSED,
                    wanted=CELLS_WANTED,
                ),
                remedy=Message(
                    "Use a grid spacing of {spacing:.2g} mm or less",
                    spacing=half / CELLS_WANTED * 1000.0,
                ),
            )
        cells = (narrow + surface.spacing / 2) / spacing
        unresolved += _few_cells(_NARROWEST[name], cells)
    return unresolved


def place_on_floor(surface: SoleSurface, shoe_angle: float) -> Array:
    """Return where along the floor each cell of a surface lies in its tilted map, (nx, ny), m.

    That of ``surface_map``; in the map that ``heel_map`` makes of the same sole within the size of
    a cell. Channels lie straight above the land that they cut.
    """
    base = _land_everywhere(surface)
    _, rear = _outline_on_floor(surface, base, shoe_angle)
    return surface.x[:, None] * math.cos(shoe_angle) - base * math.sin(shoe_angle) - rear


def _land_everywhere(surface: SoleSurface) -> Array:
    """Return the height of the land (m), that of the nearest cell where there is none."""
    base = surface.land_base
    return base[nearest_true(np.isfinite(base))]


def _outline_on_floor(surface: SoleSurface, base: Array, shoe_angle: float) -> tuple[Array, float]:
    """Return the tilted outline (n, 2) from its rear end on, and where that end lay, m."""
    outline = surface.outline.copy()
    rim = _cells(surface, outline[:, 0], outline[:, 1])
    outline[:, 0] = outline[:, 0] * math.cos(shoe_angle) - base[rim] * math.sin(shoe_angle)
    rear = float(outline[:, 0].min())
    outline[:, 0] -= rear
    return outline, rear
