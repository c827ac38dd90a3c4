"""The sole of a case: parametric or from a file, worn, tilted, trimmed and checked."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, ValidationError

from underfoot import shoe
from underfoot.case import Case, CaseError, Section
from underfoot.case.case import with_settings
from underfoot.case.compose import expand_sections
from underfoot.case.context import Context
from underfoot.case.errors import place_error, translate_errors
from underfoot.case.quantity import DOOR, Length, default
from underfoot.case.section import walk
from underfoot.case.sole import SolePlan, TreadPattern, WholePlan
from underfoot.case.tables import meant_file
from underfoot.case.text import Places, parse_toml, read_text
from underfoot.case.wear import ArchardWear
from underfoot.core import (
    Breach,
    Cache,
    ConvergenceError,
    InputError,
    Progress,
    ValidityRange,
    breaches,
    content_hash,
    display,
    silent,
)
from underfoot.core.remark import Message, Remark
from underfoot.shoe import SoleMap, SoleSurface, heel_map, surface_map
from underfoot.shoe.ball_joint import PLACE, BallJoint
from underfoot.shoe.drawn_surface import drawn_surface
from underfoot.shoe.row_division import row_cells
from underfoot.shoe.shape import SoleShape
from underfoot.shoe.worn import ArchardStep, WornMap, archard_wear, worn_surface
from underfoot.sole_contact.edge_peak import MOST_OVERLOADED, overloaded_share
from underfoot.sole_contact.slits import loaded_slits
from underfoot.sole_contact.sole_state import SoleState
from underfoot.sole_contact.solver import SolverSettings, solve_sliding
from underfoot.sole_contact.stepping import rolled_clearance

from .resolve import resolve_context, youngs_modulus

if TYPE_CHECKING:
    from underfoot.shoe.files import FileOutsole, FileSettings

RESOLVED = 8
"""Cells along the sliding in one spacing that hold the inlet of a film at the corner of a sole."""
BOTTOMED = 0.5
"""Share of the outsole's thickness beyond which the load bottoms it out: refused."""
LINEAR_STRAIN = ValidityRange(0.0, 0.25, "1", "linear elasticity of rubber in compression")
SUMMITS = 3.0
"""Times Rq: how far summits stand out of the mean plane."""
FOREFOOT_RIGID = ValidityRange(
    math.radians(-7.5),
    math.radians(60.0),
    "rad",
    "a forefoot bends once the heel rises; slip-resistance tests tilt it by 7 deg at most",
)
"""Shoe angles at which a sole without a joint at the ball stands for a shoe."""
WHOLE = 0.95
"""Share of a file's whole sole from which a region of it has a ball to bend at."""
ROLL_STEP = math.radians(1.0)
"""Between the angles at which the sole is held against the floor to find what comes near it."""
LANDING = 0.1e-3
"""What lies at most this above the lowest quarter of a sole lands first, m."""
WEAR_STEP = 0.25e-3
"""Thickness that Archard wear removes between two contacts, m."""


def bottom_surface(case: Case) -> SoleSurface:
    """Return the bottom of the case's sole in its own frame, worn as the case says.

    On the cells of the file's height map, or of the coarse grid for a parametric sole.
    """
    if case.shoe.outsole is not None:
        return file_surface(case)
    return shoe.heel_surface(sole_shape(case), spacing=case.numerics.quick_grid_spacing)


def sole_map(
    case: Case,
    spacing: float,
    progress: Progress = silent,
    *,
    shift: tuple[float, float] = (0.0, 0.0),
    turn: float = 0.0,
    yaw: float = 0.0,
) -> SoleMap:
    """Return the tilted sole of the case on a grid of ``spacing`` (m).

    ``shift`` (x, y; m) moves the tread under the sole and ``yaw`` (rad, anticlockwise seen from
    above) turns it about the front of what lands first; ``turn`` (rad) adds to the shoe angle. Wear
    stays where it is.
    """
    if case.shoe.outsole is not None:
        return file_sole_map(case, spacing, shift=shift, turn=turn, yaw=yaw)
    shape = sole_shape(case, progress)
    if shape.tread is not None and (any(shift) or yaw):
        tread = shape.tread.shift_grooves(shift)
        if yaw:
            tread = replace(tread, yaw=yaw, pivot=(landing_front(case), 0.0))
        shape = cast("SoleShape", replace(cast("Any", shape), tread=tread))
    angle = case.motion.shoe_angle + turn
    sole = shoe.heel_map(shape, shoe_angle=angle, spacing=spacing)
    plan = case.shoe.heel
    if isinstance(plan, WholePlan):
        sole = trim_map(_add_joint(case, sole, plan.length), plan.reach, rolls(case))
    return _with_cells(
        case,
        _press_slits(case, sole),
        lambda columns: heel_map(shape, shoe_angle=angle, spacing=spacing, columns=columns),
    )


def drawn_map(case: Case, spacing: float, *, surface: SoleSurface | None = None) -> SoleMap:
    """Return the tilted sole on square cells of ``spacing`` (m), to be drawn: no film is solved.

    ``surface`` stands for that of the case's file.
    """
    case = case.replace("numerics.cells_along", 1)
    if surface is not None:
        return _map_of_surface(case, surface, spacing, case.motion.shoe_angle)
    return sole_map(case, spacing)


def drawn_file(case: Case, spacing: float) -> tuple[SoleMap, tuple[NDArray[np.float64], ...]]:
    """Return the ``drawn_map`` of a case's file with lugs up to their rims, and its lines.

    Lines (n, 2, 2; m) are those at which lugs and sides end.
    """
    outsole, surface = file_outsole(case), drawn_surface(file_surface(case))
    lines = shoe.floor_lines(
        surface,
        (outsole.edges, outsole.sides),
        shoe_angle=case.motion.shoe_angle,
        spacing=spacing,
    )
    return drawn_map(case, spacing, surface=surface), lines


def _with_cells(case: Case, sole: SoleMap, fine: Callable[[int], SoleMap]) -> SoleMap:
    """Return the sole with the cells along the sliding that the case asks for."""
    columns = cells_along(case, sole)
    return sole if columns == 1 else replace(sole, cells=row_cells(sole, fine(columns)))


def cells_along(case: Case, sole: SoleMap) -> int:
    """Return the cells along the sliding in one spacing that a sole is solved on.

    A flat sole in a fluid is resolved by ``RESOLVED``. Lugs stay on square cells: their rims are
    not resolved by fine ones either, which cost ten times as much.
    """
    given = case.numerics.cells_along
    if given != "auto":
        return given
    flat = case.contaminant is not None and sole.slits is None and not sole.tread_depth.any()
    return RESOLVED if flat else 1


def _add_joint(case: Case, sole: SoleMap, length: float) -> SoleMap:
    """Return a whole sole of ``length`` (m) with its joint, where the motion rolls it."""
    if not np.ptp(rolls(case)):
        return sole
    joint = BallJoint(PLACE * length, case.motion.shoe_angle)
    return replace(sole, joint=joint)


def rolls(case: Case) -> NDArray[np.float64]:
    """Return by how much (rad) the motion rolls the sole from ``motion.shoe_angle``, in steps."""
    history = case.motion.build()
    if history is None:
        return np.zeros(1)
    low, high = float(history.shoe_angle.min()), float(history.shoe_angle.max())
    count = math.ceil((high - low) / ROLL_STEP) + 1
    return np.linspace(low, high, count) - case.motion.shoe_angle


def new_sole(case: Case) -> SoleShape:
    """Return the parametric heel or sole of the case before any wear."""
    shoe = case.shoe
    if shoe.heel is None or shoe.tread is None:
        raise InputError("the outsole comes from a file", where="shoe.outsole.file")
    return shoe.heel.build(shoe.tread, shoe.sole.outsole_thickness)


def sole_shape(case: Case, progress: Progress = silent) -> SoleShape:
    """Return the parametric heel or sole of the case, worn as it says."""
    new, wear = new_sole(case), case.shoe.wear
    if wear.depth == 0:
        return new
    removed = wear.build()
    if removed is None:
        return new.with_wear(archard_state(case, progress=progress).worn)
    return new.with_wear(removed)


def archard_state(case: Case, *, progress: Progress = silent) -> ArchardStep:
    """Return the sole of the case worn by pressure and sliding to its wear depth.

    The contact is dry, on the quick grid, at three shoe angles. Every ``WEAR_STEP`` is kept on
    disk, so that a sole worn further goes on from there.
    """
    context, new, wear = resolve_context(case), new_sole(case), case.shoe.wear
    if not isinstance(wear, ArchardWear):
        raise InputError(f'mode = "{wear.name}"', where="shoe.wear.mode", allowed="archard")
    spacing = case.numerics.quick_grid_spacing
    force = wear.normal_force or case.motion.normal_force
    half, middle = wear.angle_range / 2, wear.angle
    angles = (middle - half, middle, middle + half) if half > 0 else (middle,)
    identity = (
        new,
        list(angles),
        force,
        context.youngs_modulus,
        context.poisson_ratio,
        context.rq_value,
        case.shoe.sole.model_dump(),
        case.rough_contact,
        case.interface,
        case.compliance,
        case.motion.speed,
        case.numerics.tolerance,
        spacing,
        wear.wear_rate,
    )
    store = Cache("archard_wear")
    state: ArchardStep | None = None
    steps = [*np.arange(WEAR_STEP, wear.depth - 1e-9, WEAR_STEP), wear.depth]
    for number, depth in enumerate(steps):
        key = content_hash("archard", *identity, round(float(depth), 9))
        stored = store.load(key)
        if stored is not None:
            worn = WornMap(stored["x"], stored["y"], stored["removed"])
            state = ArchardStep(worn, float(stored["sliding_distance"]))
            continue
        progress("Wearing the sole", number / len(steps))
        state = archard_wear(
            new,
            angles=angles,
            depth=float(depth),
            contact=lambda shape, angle: _dry_contact(case, context, shape, angle, force),
            wear_rate=wear.wear_rate,
            spacing=spacing,
            step=WEAR_STEP,
            begin=state,
        )
        worn = state.worn
        arrays = {"x": worn.x, "y": worn.y, "removed": worn.removed}
        store.store(key, {**arrays, "sliding_distance": np.array(state.sliding_distance)})
    assert state is not None
    return state


def _dry_contact(
    case: Case, context: Context, shape: SoleShape, angle: float, force: float
) -> tuple[SoleMap, NDArray[np.float64]]:
    sole = heel_map(shape, shoe_angle=angle, spacing=case.numerics.quick_grid_spacing)
    contact = solve_sliding(
        sole,
        case.compliance.build(context, sole),
        case.rough_contact.build(context),
        viscosity=None,
        speed=case.motion.speed,
        normal_force=force,
        settings=SolverSettings(tolerance=case.numerics.tolerance),
    )
    if not contact.status.usable:
        raise ConvergenceError(
            "the dry contact of the worn sole did not converge",
            history=contact.residuals,
            where="shoe.wear",
            remedy="Refine numerics.quick_grid_spacing, or wear at another angle.",
        )
    return sole, contact.contact_pressure


def file_outsole(case: Case) -> "FileOutsole":
    """Return the outsole in the file of the case, as the case says it is to be read."""
    return _read(*_file_key(case))


def _file_key(case: Case) -> "tuple[str, str, FileSettings]":
    """Return path, checksum and settings of the case's outsole file."""
    outsole = case.shoe.outsole
    if outsole is None:
        raise InputError("the case has no outsole file", where="shoe.outsole.file")
    same = (
        *("unit", "down", "forward", "foot", "mirror", "region", "region_length"),
        *("solid", "side", "cut_floor"),
    )
    given: dict[str, Any] = {name: getattr(outsole, name) for name in same}
    from underfoot.shoe.files import FileSettings

    settings = FileSettings(**given, spacing=outsole.map_spacing)
    return outsole.file, outsole.sha256 or "", settings


@lru_cache(maxsize=4)
def _read(path: str, checksum: str, settings: "FileSettings") -> "FileOutsole":
    """Read a file once in a process: the checksum is part of the key."""
    from underfoot.shoe.files import outsole_from_file

    with meant_file(path, checksum, "shoe.outsole.file") as file:
        return outsole_from_file(file, settings)


@lru_cache(maxsize=4)
def _tread(path: str, checksum: str, settings: "FileSettings") -> tuple[NDArray[np.float64], ...]:
    # compiled: numba takes a while to import
    from underfoot.shoe.tread_shift import carried_base, tread_periods, tread_place

    surface = _read(path, checksum, settings).surface
    periods = tread_periods(surface)
    lowest = np.fmin.reduce(np.where(surface.inside, carried_base(surface), np.nan), axis=1)
    return periods, tread_place(surface, periods), surface.x, lowest


def file_periods(case: Case) -> NDArray[np.float64]:
    """Return the periods (n, 2) of the tread in the case's outsole file, m; ``tread_periods``."""
    return _tread(*_file_key(case))[0]


def tread_on_sole(case: Case) -> tuple[NDArray[np.float64], ...]:
    """Return the periods of a tread (n, 2; m), where it begins, and the new sole under it.

    It begins in shares (n,) of them, in a file where it has most land; the sole: x and height, m.
    """
    if case.shoe.outsole is not None:
        return _tread(*_file_key(case))
    shape = cast("Any", new_sole(case))
    periods = shape.tread.periods
    return periods, shape.tread.offset @ np.linalg.pinv(periods), *shape.centre_line()


def landing_front(case: Case) -> float:
    """Return the front of what lands first of the case's new sole, m from its rear end."""
    _, _, x, height = tread_on_sole(case)
    clearance = height + math.tan(case.motion.shoe_angle) * x
    over = np.nan_to_num(clearance, nan=math.inf) - np.nanquantile(clearance, 0.25) - LANDING
    last = int(np.flatnonzero(over < 0)[-1])
    return float(np.interp(0.0, over[last : last + 2], x[last : last + 2]))


def file_surface(
    case: Case, shift: tuple[float, float] = (0.0, 0.0), yaw: float = 0.0
) -> SoleSurface:
    """Return the bottom of the case's outsole file, worn as the case says.

    ``shift`` (x, y; m) and ``yaw`` (rad) move its tread before it is worn, as ``sole_map`` has it.
    """
    surface, wear = file_outsole(case).surface, case.shoe.wear
    if any(shift) or yaw:
        from underfoot.shoe.tread_shift import moved_tread

        pivot = (landing_front(case), 0.0)
        surface = moved_tread(surface, shift, file_periods(case), yaw=yaw, pivot=pivot)
    removed = wear.build() if wear.depth > 0 else None
    return surface if removed is None else worn_surface(surface, removed)


def file_sole_map(
    case: Case,
    spacing: float,
    *,
    shift: tuple[float, float] = (0.0, 0.0),
    turn: float = 0.0,
    yaw: float = 0.0,
) -> SoleMap:
    """Return the tilted outsole of the case's file on the solver's grid, trimmed to its reach.

    ``shift``, ``turn`` and ``yaw`` as in ``sole_map``.

    Raises:
        InputError: Channels below the grid, a region or unit that doesn't fit, tread deeper than
            the outsole, nothing under the load.
    """
    surface = file_surface(case, shift, yaw)
    thickness = case.shoe.sole.outsole_thickness
    deepest = float(np.max(surface.tread_depth))
    if deepest >= thickness:
        raise InputError(
            Message(
                "the tread of {name} is {deepest} deep, the outsole {thickness} thick",
                name=surface.name,
                deepest=display(deepest, "m"),
                thickness=display(thickness, "m"),
            ),
            where="shoe.sole.outsole_thickness",
            allowed=Message("above {limit}", limit=display(deepest, "m")),
        )
    return _map_of_surface(case, surface, spacing, case.motion.shoe_angle + turn)


def _map_of_surface(case: Case, surface: SoleSurface, spacing: float, angle: float) -> SoleMap:
    """Return a surface of the case's file at an angle (rad) on a grid, trimmed to its reach."""
    assert case.shoe.outsole is not None  # file_surface refuses a case without one
    sole = surface_map(surface, shoe_angle=angle, spacing=spacing)
    if surface.length > WHOLE * file_outsole(case).whole_length:
        sole = _add_joint(case, sole, surface.length)
    sole = trim_map(sole, case.shoe.outsole.reach, rolls(case))
    check_load(case, sole)
    return _with_cells(
        case,
        _press_slits(case, sole),
        lambda columns: surface_map(surface, shoe_angle=angle, spacing=spacing, columns=columns),
    )


def _press_slits(case: Case, sole: SoleMap) -> SoleMap:
    """Return the sole with its slits as the load closes them: the mean pressure of a first look."""
    if sole.slits is None:
        return sole
    _, area = spring_contact(case, sole)
    modulus = youngs_modulus(case)[0].value
    assert modulus is not None
    return loaded_slits(
        sole,
        modulus=modulus,
        poisson_ratio=case.shoe.material.poisson_ratio,
        pressure=case.motion.normal_force / area,
    )


def trim_map(
    sole: SoleMap, reach: float, rolled_by: ArrayLike = 0.0, padding: float = 0.004
) -> SoleMap:
    """Return the map without rows and columns that stay more than ``reach`` (m) above the floor.

    A sole that rolls keeps what comes within reach at any of the angles ``rolled_by`` (rad, from
    the map's). The result keeps the whole map for pictures (``SoleMap.whole``).
    """
    angles = np.atleast_1d(np.asarray(rolled_by, dtype=float))
    near = np.any(
        [rolled_clearance(sole.x, sole.clearance, angle, sole.joint) <= reach for angle in angles],
        axis=0,
    )
    margin = max(1, math.ceil(padding / sole.spacing))
    keep = []
    for axis in (0, 1):
        cells = np.nonzero(near.any(axis=1 - axis))[0]
        keep.append(slice(max(int(cells[0]) - margin, 0), int(cells[-1]) + margin + 1))
    part = (keep[0], keep[1])
    return replace(
        sole,
        x=sole.x[keep[0]],
        y=sole.y[keep[1]],
        clearance=sole.clearance[part],
        inside=sole.inside[part],
        land=sole.land[part],
        tread_depth=sole.tread_depth[part],
        cut=sole.cut and sole.cut.part(part),
        slits=sole.slits and sole.slits.part(part),
        whole=sole,
        removed=None if sole.removed is None else sole.removed[part],
    )


def check_load(case: Case, sole: SoleMap) -> None:
    """Refuse a load that bottoms the sole out, or that meets next to nothing of it.

    Of ``spring_contact``; refused is an approach above half the thickness.
    """
    thickness, force = case.shoe.sole.thickness, case.motion.normal_force
    depth, area = spring_contact(case, sole)
    if depth <= BOTTOMED * thickness:
        return
    raise InputError(
        Message(
            "{force:g} N bottoms out the sole: it would press {depth} into {thickness} of "
            "outsole, on {area:.0f} mm² of land",
            force=force,
            depth=display(depth, "m"),
            thickness=display(thickness, "m"),
            area=area * 1000000.0,
        ),
        where="motion.normal_force",
        allowed=Message(
            "an approach of up to {share:.0%} of the outsole's thickness", share=BOTTOMED
        ),
        remedy="Look at the file with: underfoot outsole inspect. Is the right region under the "
        "load (region, forward, down), is the unit right, does a stray point stand out",
    )


def spring_contact(case: Case, sole: SoleMap) -> tuple[float, float]:
    """Return approach (m) and touching land (m^2) by a first look without a solver.

    Each place of the land is a spring of its own, F = E / t sum (d - c) dA over the land with
    clearance c below d, outsole thickness t. The estimate of the approach d is too stiff for a thin
    layer's middle and too soft for none.
    """
    modulus = youngs_modulus(case)[0].value
    assert modulus is not None
    heights = np.sort(sole.clearance[sole.land])
    stiffness = modulus / case.shoe.sole.thickness * sole.spacing**2
    # with the n lowest places in touch: F = k (n d - sum of their clearances)
    count = np.arange(1, heights.size + 1)
    approach = (case.motion.normal_force / stiffness + np.cumsum(heights)) / count
    reached = np.append(heights[1:], np.inf) >= approach
    depth = float(approach[int(np.argmax(reached))])
    return depth, np.count_nonzero(heights < depth) * sole.spacing**2


def compression_breaches(case: Case, approach: float) -> list[Breach]:
    """Return whether the sole was pressed together more than linear elasticity is good for."""
    name = "compression of the sole (approach / thickness)"
    strain = max(approach, 0.0) / case.shoe.sole.thickness
    return breaches("compliance", {name: LINEAR_STRAIN}, {name: strain})


def forefoot_breaches(case: Case, sole: SoleMap) -> list[Breach]:
    """Return whether the motion raises the heel beyond what a rigid forefoot stands for."""
    if sole.joint is not None:
        return []
    name = "shoe angle of a sole whose forefoot does not bend"
    return breaches(
        "forefoot", {name: FOREFOOT_RIGID}, {name: rolls(case) + case.motion.shoe_angle}
    )


def tread_breaches(sole: SoleMap, rq: float) -> list[Breach]:
    """Return whether the summits of a roughness of ``rq`` (m) fill the channels of a tread."""
    depth = float(sole.tread_depth.max())
    deeper = ValidityRange(SUMMITS * rq, math.inf, "m", "summits of the rough surfaces, 3 Rq")
    return (
        breaches("tread", {"depth of the channels": deeper}, {"depth of the channels": depth})
        if depth
        else []
    )


def overload_breaches(contact: SoleState, modulus: float) -> list[Breach]:
    """Return whether more of the load than sharp edges take rests on what rubber cannot bear."""
    name = "share of the load under pressures above the modulus"
    share = overloaded_share(contact.total_pressure, contact.cell_load, modulus)
    return breaches("compliance", {name: MOST_OVERLOADED}, {name: share})


def outsole_notes(case: Case) -> list[Remark]:
    """Return in words what was found, assumed and repaired in the outsole file; else nothing."""
    if case.shoe.outsole is None:
        return []
    return [Remark.of("shoe.outsole", line) for line in file_outsole(case).surface.remarks]


class OutsoleLayer(Section):
    """Thickness of the sole."""

    outsole_thickness: Length = default(25e-3, "25 mm", "assumption", assumed=True)


class Outsole(Section):
    """A sole alone: sections ``heel``, ``tread`` and ``sole`` as under ``shoe`` in a case."""

    name: str = "outsole"
    description: str = ""
    heel: SolePlan = Field(default={"profile": "flat"}, validate_default=True)
    tread: TreadPattern
    sole: OutsoleLayer = OutsoleLayer()

    def shape(self) -> SoleShape:
        """Return the sole as the solver and the exporter take it."""
        return self.heel.build(self.tread, self.sole.outsole_thickness)


def read_outsole(path: Path | str, settings: Mapping[str, Any] | None = None) -> Outsole:
    """Return the sole of an outsole file; every value with its unit.

    Raises:
        CaseError: Everything that is wrong with the file, each with its line.
    """
    path, text = Path(path), read_text(Path(path))
    places = Places(str(path), text, changed=settings or ())
    return outsole_from(parse_toml(text, str(path)), places, settings)


def outsole_from(
    mapping: Mapping[str, Any],
    places: Places | None = None,
    settings: Mapping[str, Any] | None = None,
) -> Outsole:
    """Return the sole of nested mappings, numbers as text with units."""
    places = places or Places()
    if "shoe" in mapping:
        raise InputError(
            "this is a case, not an outsole file",
            where=places("shoe"),
            remedy="Use the file of a sole alone, or give the case to the command as it is.",
        )
    plain = {key: item for key, item in mapping.items() if key in ("name", "description")}
    parts = {key: item for key, item in mapping.items() if key not in plain}
    inside = {f"shoe.{path}": value for path, value in (settings or {}).items()}
    tree = with_settings({"shoe": parts}, inside)["shoe"]
    tree = {key: expand_sections(item, f"shoe.{key}") for key, item in tree.items()}
    try:
        outsole = Outsole.model_validate({**plain, **tree}, context=DOOR)
    except ValidationError as error:
        raise CaseError(translate_errors(error, Outsole, tree, places)) from None
    fine = SimpleNamespace(grid_spacing=0.0, quick_grid_spacing=0.0)  # no grid sets what is small
    view = cast("Any", SimpleNamespace(shoe=outsole, numerics=fine))
    problems = [p for path, part in walk(outsole) for p in part.problems(view, path)]
    if problems:
        raise CaseError([place_error(error, places) for error in problems])
    return outsole
