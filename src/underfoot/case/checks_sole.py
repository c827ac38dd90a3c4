"""What must fit together within plan form, tread and wear of a case."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from underfoot.core import InputError, RangeError, display

if TYPE_CHECKING:
    from .case import Case
    from .places import Places

_CELLS = 2.0  # across a channel or lug: fewer and its width is wrong by half or more
_ONLY = {"lug_length": "blocks", "arm_length": "chevrons"}


def sole_mismatches(case: Case, given: Collection[str], places: Places) -> Iterator[InputError]:
    """Yield what does not fit together in the sole; ``given`` are the paths in the file."""
    yield from _plan(case, given, places)
    yield from _tread(case, given, places)
    yield from _wear(case, given, places)
    yield from _through(case, places)


def _plan(case: Case, given: Collection[str], places: Places) -> Iterator[InputError]:
    heel = case.shoe.heel
    if heel.plan == "sole":
        for name in ("waist_width", "ball_width"):
            if getattr(heel, name) is None:
                yield InputError(
                    'is missing for a whole sole (plan = "sole")',
                    where=places(f"shoe.heel.{name}"),
                )
    names = ("rear_radius", "front_radius")
    if heel.plan == "heel":
        names = ("side", "waist_width", "ball_width", "toe_spring", "toe_start")
    for name in names:
        if f"shoe.heel.{name}" in given:
            yield InputError(
                f'is not used by plan = "{heel.plan}"', where=places(f"shoe.heel.{name}")
            )
    if heel.plan == "sole" and (heel.toe_spring is None) != (heel.toe_start is None):
        missing = "toe_spring" if heel.toe_spring is None else "toe_start"
        yield InputError(
            "a toe spring needs both its height and where it starts",
            where=places(f"shoe.heel.{missing}"),
        )


def _tread(case: Case, given: Collection[str], places: Places) -> Iterator[InputError]:
    tread = case.shoe.tread
    if tread.pattern == "none":
        if tread.sipes is not None:
            yield InputError("a sole without tread has no sipes", where=places("shoe.tread.sipes"))
    else:
        needed = ["depth", "lug_width", "channel_width"]
        needed += [name for name, pattern in _ONLY.items() if pattern == tread.pattern]
        for name in needed:
            if getattr(tread, name) is None:
                yield InputError(
                    f'is missing for the pattern "{tread.pattern}"',
                    where=places(f"shoe.tread.{name}"),
                )
        if tread.depth == 0.0:
            yield RangeError(
                "0 mm is no tread",
                where=places("shoe.tread.depth"),
                allowed="above 0 mm",
                remedy='Write pattern = "none" for a sole without tread',
            )
        for name in ("lug_width", "channel_width", "lug_length"):
            yield from _resolved(case, f"shoe.tread.{name}", getattr(tread, name), places)
        smallest = min(tread.lug_width or math.inf, tread.lug_length or math.inf)
        rounding = min(tread.depth or math.inf, smallest / 2)
        if tread.edge_radius > rounding:
            yield RangeError(
                f"{display(tread.edge_radius, 'm')} does not fit on the lug",
                where=places("shoe.tread.edge_radius"),
                allowed=f"at most {display(rounding, 'm')} (the depth and half the lug width)",
            )
        if tread.pattern == "chevrons" and abs(tread.angle) > math.radians(75):
            yield RangeError(
                f"arms at {display(tread.angle, 'rad')} run along the shoe",
                where=places("shoe.tread.angle"),
                allowed="-75 deg to 75 deg for chevrons",
                remedy='Write pattern = "longitudinal" for channels along the shoe',
            )
    for name, pattern in _ONLY.items():
        if tread.pattern != pattern and f"shoe.tread.{name}" in given:
            yield InputError(
                f'is not used by the pattern "{tread.pattern}"',
                where=places(f"shoe.tread.{name}"),
                remedy=f'Remove it, or write pattern = "{pattern}"',
            )
    yield from _sipes(case, places)
    if tread.arc_channel is not None:
        yield from _resolved(case, "shoe.tread.arc_channel.width", tread.arc_channel.width, places)


def _sipes(case: Case, places: Places) -> Iterator[InputError]:
    sipes, depth = case.shoe.tread.sipes, case.shoe.tread.depth
    if sipes is None or case.shoe.tread.pattern == "none":
        return
    if depth is not None and sipes.depth > depth * (1 + 1e-9):
        yield RangeError(
            f"{display(sipes.depth, 'm')} is deeper than the lug",
            where=places("shoe.tread.sipes.depth"),
            allowed=f"at most {display(depth, 'm')} (shoe.tread.depth)",
        )
    if sipes.depth == 0.0:
        yield RangeError(
            "0 mm is no sipe", where=places("shoe.tread.sipes.depth"), allowed="above 0 mm"
        )
    if sipes.width >= sipes.spacing / 2:
        yield RangeError(
            f"slits of {display(sipes.width, 'm')} leave no lug between them",
            where=places("shoe.tread.sipes.width"),
            allowed=f"below {display(sipes.spacing / 2, 'm')} (half of their spacing)",
        )


def _wear(case: Case, given: Collection[str], places: Places) -> Iterator[InputError]:
    wear, heel = case.shoe.wear, case.shoe.heel
    if wear.mode == "patch" and wear.depth > 0:
        width = max(heel.width, heel.ball_width or 0.0) if heel.plan == "sole" else heel.width
        for name, most in (("patch_length", heel.length), ("patch_width", width)):
            value = getattr(wear, name)
            if value is None:
                yield InputError('is missing for mode = "patch"', where=places(f"shoe.wear.{name}"))
            elif value > most * (1 + 1e-9):
                yield RangeError(
                    f"a worn patch of {display(value, 'm')} is larger than the shoe",
                    where=places(f"shoe.wear.{name}"),
                    allowed=f"at most {display(most, 'm')}, the extent of the sole",
                )
    if wear.mode == "archard" and wear.depth > 0 and "shoe.wear.angle" not in given:
        yield InputError(
            'is missing for mode = "archard": the shoe angle at which the sole wears',
            where=places("shoe.wear.angle"),
            remedy='Write angle = "12 deg" (the middle of early stance) with its angle_range',
        )


def _through(case: Case, places: Places) -> Iterator[InputError]:
    tread, thickness = case.shoe.tread, case.shoe.sole.outsole_thickness
    parts: list[tuple[str, float]] = [("shoe.wear.depth", case.shoe.wear.depth)]
    if tread.pattern != "none" and tread.depth is not None:
        parts.append(("shoe.tread.depth", tread.depth))
    if tread.arc_channel is not None:
        parts.append(("shoe.tread.arc_channel.depth", tread.arc_channel.depth))
    for path, depth in parts:
        if depth >= thickness:
            yield RangeError(
                f"{display(depth, 'm')} goes through the outsole",
                where=places(path),
                allowed=f"below {display(thickness, 'm')} (shoe.sole.outsole_thickness)",
            )


def _resolved(case: Case, path: str, width: float | None, places: Places) -> Iterator[InputError]:
    if width is None:
        return
    for name in ("grid_spacing", "quick_grid_spacing"):
        spacing = getattr(case.numerics, name)
        if width < _CELLS * spacing * (1 - 1e-9):
            yield InputError(
                f"{display(width, 'm')} is too narrow for the grid of {display(spacing, 'm')}",
                where=places(path),
                allowed=f"at least {display(_CELLS * spacing, 'm')} (two cells)",
                remedy=f'Write numerics.{name} = "{width / 4 * 1e3:.3g} mm" (four cells)',
            )
