"""Slots for the sole's geometry: plan form, rear profile and tread pattern."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field

from underfoot.core import InputError, RangeError, display
from underfoot.core.remark import Amount, Message

from .lettering import check_text, text_rings
from .quantity import Angle, Depth, LargeRadius, Length, Quantity, Rounding, default, optional
from .section import CaseView, Option, Section

if TYPE_CHECKING:
    from underfoot.shoe import HeelProfile, Tread
    from underfoot.shoe.lettering import Lettering
    from underfoot.shoe.shape import SoleShape

_ASSUMED = "assumption"
_mm = 1e-3
_LUG_SIDES = ("lug_length", "ring_width", "front_lug_width")
_CELLS = 2.0  # across a channel or lug: fewer and its width is wrong by half or more
_USUAL = {"lug_width": "6 mm", "channel_width": "4 mm", "depth": "3 mm"}
"""What a tread is where nothing is said: common work shoes (assumed)."""
_FURTHER = {
    "blocks": {"lug_length": "9 mm"},
    "chevrons": {"arm_length": "12 mm", "angle": "35 deg"},
    "waves": {"wave_length": "20 mm", "wave_height": "6 mm"},
    "rings": {"lug_width": "12 mm", "ring_width": "3 mm"},
    "graded_circles": {"front_lug_width": "4 mm", "graded_length": "60 mm"},
    "lettering": {"lug_width": "16 mm", "channel_width": "3 mm", "text": "GRIP"},
    "free": {"land": "0.6", "cell_length": "20 mm", "cell_width": "20 mm", "cos1_cos0": "1"},
}
"""What some patterns need beyond that (assumed)."""
Turn = Annotated[float, Quantity("rad", -math.pi, math.pi)]
Shift = Annotated[float, Quantity("m", -0.5, 0.5)]


def _at_most(length: float, what: str) -> Message:
    return Message("at most {most} ({what})", most=Amount(length, "m"), what=what)


class RearProfile(Option):
    """Profile of the sole's rear."""

    slot: ClassVar[str] = "profile"
    usual: ClassVar[str | None] = "facet"

    @abstractmethod
    def build(self) -> HeelProfile:
        """Return the profile as geometry."""


class FlatRear(RearProfile):
    """Flat to the rear end."""

    name: ClassVar[str] = "flat"

    def build(self) -> HeelProfile:
        from underfoot.shoe import Flat

        return Flat()


class FacetRear(RearProfile):
    """Ground flat at an angle."""

    name: ClassVar[str] = "facet"
    source: ClassVar[str] = _ASSUMED

    angle: Angle = Field(description="between facet and sole")
    length: Length = Field(description="along the sole, from the rear")

    def build(self) -> HeelProfile:
        from underfoot.shoe import Facet, Flat

        return Facet(self.angle, self.length) if self.angle else Flat()


class RockerRear(RearProfile):
    """Rounded upwards to the rear."""

    name: ClassVar[str] = "rocker"

    radius: LargeRadius = Field(description="radius along x")
    start: Length = Field(description="from the rear end")

    def build(self) -> HeelProfile:
        from underfoot.shoe import Rocker

        return Rocker(self.radius, self.start)

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        if self.start >= self.radius:
            yield RangeError(
                f"{display(self.start, 'm')} reaches beyond the rocker's radius",
                where=f"{where}.start",
                allowed=f"below {display(self.radius, 'm')} (radius)",
            )


class SolePlan(Option):
    """Heel or whole sole in its own frame: x from the rear end towards the toe."""

    slot: ClassVar[str] = "plan"
    key: ClassVar[str] = "plan"
    usual: ClassVar[str | None] = "heel"

    length: Length = default(60 * _mm, "60 mm", _ASSUMED, assumed=True)
    width: Length = default(60 * _mm, "60 mm", _ASSUMED, assumed=True)
    profile: RearProfile = Field(default={}, validate_default=True)
    edge_radius: Rounding = default(2 * _mm, "2 mm", _ASSUMED, assumed=True)
    crown_radius: LargeRadius | None = optional("radius of a sole bulged across")

    @property
    def widest(self) -> float:
        """Largest width, m."""
        return self.width

    @abstractmethod
    def build(self, tread: TreadPattern, outsole_thickness: float) -> SoleShape:
        """Return the new sole with its tread."""

    def _common(self, tread: TreadPattern, outsole_thickness: float) -> dict[str, Any]:
        from underfoot.shoe import ArcChannel

        arc = tread.arc_channel
        return {
            "outsole_thickness": outsole_thickness,
            "edge_radius": self.edge_radius,
            "crown_radius": self.crown_radius,
            "tread": tread.build(),
            "arc_channel": arc and ArcChannel(arc.position, arc.radius, arc.width, arc.depth),
        }


class HeelPlan(SolePlan):
    """Heel alone, which carries a slip tester."""

    name: ClassVar[str] = "heel"
    source: ClassVar[str] = "the heel carries the slip tester"

    rear_radius: Rounding = default(28 * _mm, "28 mm", _ASSUMED, assumed=True)
    front_radius: Rounding = default(0.0, "0 mm", "the heel goes on into the shoe")

    def build(self, tread: TreadPattern, outsole_thickness: float) -> SoleShape:
        from underfoot.shoe import Heel

        return Heel(
            length=self.length,
            width=self.width,
            rear_radius=self.rear_radius,
            front_radius=self.front_radius,
            profile=self.profile.build(),
            **self._common(tread, outsole_thickness),
        )

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        limit = min(self.width, self.length) / 2
        for name in ("rear_radius", "front_radius", "edge_radius"):
            if getattr(self, name) > limit:
                yield RangeError(
                    f"{display(getattr(self, name), 'm')} does not fit the plan form",
                    where=f"{where}.{name}",
                    allowed=_at_most(limit, "half of the smaller of length and width"),
                )


class WholePlan(SolePlan):
    """Whole sole with waist and ball."""

    name: ClassVar[str] = "sole"

    side: Literal["left", "right"] = default("right", "right", "which foot, seen from above")
    waist_width: Length = Field(description="at its narrowest")
    ball_width: Length = Field(description="across the ball")
    toe_spring: Rounding | None = optional("how far the tip is up")
    toe_start: Length | None = optional("where the toe begins to rise, from the rear end")
    reach: Length = default(
        12 * _mm, "12 mm", "parts of the tilted sole higher above the floor are trimmed off"
    )

    @property
    def widest(self) -> float:
        return max(self.width, self.ball_width)

    def build(self, tread: TreadPattern, outsole_thickness: float) -> SoleShape:
        from underfoot.shoe.parametric import ShoeOutline, ToeSpring, WholeSole

        toe = None
        if self.toe_spring and self.toe_start:
            toe = ToeSpring(self.toe_spring, self.toe_start, self.length)
        return WholeSole(
            ShoeOutline(self.length, self.width, self.waist_width, self.ball_width, self.side),
            rear_profile=self.profile.build(),
            toe_spring=toe,
            **self._common(tread, outsole_thickness),
        )

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        if (self.toe_spring is None) != (self.toe_start is None):
            missing = "toe_spring" if self.toe_spring is None else "toe_start"
            yield InputError(
                "a toe spring needs both its height and where it starts", where=f"{where}.{missing}"
            )


class ArcCut(Section):
    """One channel that follows the rounded rear of the heel."""

    width: Length
    depth: Depth
    position: Length = Field(description="from the rear end, on the centre line")
    radius: Length = Field(description="of the channel's middle line")


class SipeCuts(Section):
    """Parallel slits in all lugs."""

    width: Length
    depth: Depth = Field(description="at most the depth of the tread")
    spacing: Length = Field(description="between the middles of two slits")
    angle: Turn = default(0.0, "0 deg", "across the shoe")


class GrooveCut(Section):
    """One straight groove through the lugs, as deep as the channels."""

    along: Shift = Field(description="of its middle, from the rear end")
    across: Shift = Field(description="of its middle, to the left seen from above")
    width: Length
    length: Length | None = optional("right across the sole where nothing is said")
    angle: Turn = default(0.0, "0 deg", "across the shoe")


class TreadPattern(Option):
    """Tread of one pattern; an arc channel may be added."""

    slot: ClassVar[str] = "tread"
    key: ClassVar[str] = "pattern"

    arc_channel: ArcCut | None = None

    @abstractmethod
    def build(self) -> Tread | None:
        """Return the lugs; None for an untreaded sole."""

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        if self.arc_channel is not None:
            yield from through_outsole(case, self.arc_channel.depth, f"{where}.arc_channel.depth")
            yield from _check_resolution(case, f"{where}.arc_channel.width", self.arc_channel.width)


class NoTread(TreadPattern):
    """Sole without tread."""

    name: ClassVar[str] = "none"

    def build(self) -> Tread | None:
        return None


class Lugs(TreadPattern):
    """Lugs between channels of one width; sipes may be added."""

    depth: Depth
    lug_width: Length = Field(
        description="normal to the walls; of circles their diameter, of hexagons flats"
    )
    channel_width: Length
    angle: Turn = default(0.0, "0 deg", "turns the pattern")
    offset_along: Shift = default(0.0, "0 mm", "the first lug begins at the rear end")
    offset_across: Shift = default(0.0, "0 mm", "a lug is centred on the centre line")
    edge_radius: Rounding = default(0.0, "0 mm", "sharp lug edges", assumed=True)
    edge_chamfer: Rounding = default(
        0.0, "0 mm", "no chamfer; 45 deg, width on the land; its film is that of a sharp edge"
    )
    sipes: SipeCuts | None = None
    grooves: tuple[GrooveCut, ...] | None = optional("straight grooves through the lugs")
    kind: ClassVar[str] = ""  # of ``Tread`` where it is not the name

    def letters(self) -> Lettering | None:
        """Return the outlines of lettering and the like; None of other patterns."""
        return None

    def build(self) -> Tread | None:
        from underfoot.shoe import Sipes, Tread
        from underfoot.shoe.tread import FURTHER_LENGTHS, Groove

        cuts = self.sipes
        return Tread(
            self.kind or self.name,
            self.lug_width,
            self.channel_width,
            self.depth,
            self.edge_radius,
            (self.offset_along, self.offset_across),
            self.angle,
            **{name: getattr(self, name) for name in FURTHER_LENGTHS.get(self.name, ())},
            letters=self.letters(),
            edge_chamfer=self.edge_chamfer,
            sipes=cuts and Sipes(cuts.width, cuts.depth, cuts.spacing, cuts.angle),
            grooves=tuple(
                Groove((each.along, each.across), each.width, each.length or math.inf, each.angle)
                for each in self.grooves or ()
            ),
        )

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from super().problems(case, where)
        if self.depth == 0.0:
            yield RangeError(
                "0 mm is no tread",
                where=f"{where}.depth",
                allowed="above 0 mm",
                remedy='Write pattern = "none" for a sole without tread',
            )
        yield from through_outsole(case, self.depth, f"{where}.depth")
        for name in ("lug_width", "channel_width", *_LUG_SIDES):
            if hasattr(self, name):
                yield from _check_resolution(case, f"{where}.{name}", getattr(self, name))
        smallest = min([self.lug_width, *(getattr(self, name, math.inf) for name in _LUG_SIDES)])
        rounding = min(self.depth or math.inf, smallest / 2)
        for name in ("edge_radius", "edge_chamfer"):
            if getattr(self, name) > rounding:
                yield RangeError(
                    f"{display(getattr(self, name), 'm')} does not fit on the lug",
                    where=f"{where}.{name}",
                    allowed=_at_most(rounding, "the depth and half the lug width"),
                )
        if self.edge_radius > 0 and self.edge_chamfer > 0:
            yield InputError(
                "edges of lugs have a radius or a chamfer, not both", where=f"{where}.edge_chamfer"
            )
        if self.sipes is not None:
            yield from self._sipe_problems(self.sipes, f"{where}.sipes")
        plan = case.shoe.heel
        for number, each in enumerate(self.grooves or ()):
            yield from _check_resolution(case, f"{where}.grooves[{number}].width", each.width)
            if not 0 <= each.along <= plan.length or abs(each.across) > plan.widest / 2:
                limits = f"0 to {display(plan.length, 'm')}, {display(plan.widest / 2, 'm')} aside"
                what = "the middle of the groove lies beside the sole"
                yield RangeError(what, where=f"{where}.grooves[{number}]", allowed=limits)

    def _sipe_problems(self, cuts: SipeCuts, where: str) -> Iterator[InputError]:
        if cuts.depth > self.depth * (1 + 1e-9):
            yield RangeError(
                f"{display(cuts.depth, 'm')} is deeper than the lug",
                where=f"{where}.depth",
                allowed=_at_most(self.depth, "shoe.tread.depth"),
            )
        if cuts.depth == 0.0:
            yield RangeError("0 mm is no sipe", where=f"{where}.depth", allowed="above 0 mm")
        if cuts.width >= cuts.spacing / 2:
            yield RangeError(
                f"slits of {display(cuts.width, 'm')} leave no lug between them",
                where=f"{where}.width",
                allowed=f"below {display(cuts.spacing / 2, 'm')} (half of their spacing)",
            )


def is_bare(case: CaseView) -> bool:
    """Return whether the sole of a case has neither tread nor channel; a file may have both."""
    tread = case.shoe.tread
    return tread is not None and tread.name == "none" and tread.arc_channel is None


def usual_tread(pattern: str) -> dict[str, str]:
    """Return the keys that a pattern needs with usual values, all of them assumed."""
    return {} if pattern == "none" else _USUAL | _FURTHER.get(pattern, {})


class GridTread(Lugs):
    """Square lugs with channels on all sides."""

    name: ClassVar[str] = "grid"


class TransverseTread(Lugs):
    """Channels across the shoe."""

    name: ClassVar[str] = "transverse"


class LongitudinalTread(Lugs):
    """Channels along the shoe."""

    name: ClassVar[str] = "longitudinal"


class BlockTread(Lugs):
    """Rectangular lugs."""

    name: ClassVar[str] = "blocks"

    lug_length: Length = Field(description="along the shoe")


class BarTread(Lugs):
    """Bars."""

    name: ClassVar[str] = "bars"


class ChevronTread(Lugs):
    """Chevrons."""

    name: ClassVar[str] = "chevrons"

    arm_length: Length = Field(description="one arm, measured across the shoe")
    angle: Turn = default(0.0, "0 deg", "of the arms against the transverse direction")

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from super().problems(case, where)
        if abs(self.angle) > math.radians(75):
            yield RangeError(
                f"arms at {display(self.angle, 'rad')} run along the shoe",
                where=f"{where}.angle",
                allowed="-75 deg to 75 deg for chevrons",
                remedy='Write pattern = "longitudinal" for channels along the shoe',
            )


class CircleTread(Lugs):
    """Round studs."""

    name: ClassVar[str] = "circles"


class HexagonTread(Lugs):
    """Hexagonal studs."""

    name: ClassVar[str] = "hexagons"


class WaveTread(Lugs):
    """Bars that wave across the shoe, crests forward."""

    name: ClassVar[str] = "waves"

    wave_length: Length = Field(description="across the shoe, crest to crest")
    wave_height: Length = Field(description="along the shoe, trough to crest")


class RingTread(Lugs):
    """Round lugs with a closed hollow that can hold suction or fluid."""

    name: ClassVar[str] = "rings"

    ring_width: Length = Field(description="thickness of the wall")

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from super().problems(case, where)
        if self.ring_width >= self.lug_width / 2:
            yield RangeError(
                f"a wall of {display(self.ring_width, 'm')} leaves no hollow",
                where=f"{where}.ring_width",
                allowed=f"below {display(self.lug_width / 2, 'm')} (half of lug_width)",
                remedy='Write pattern = "circles" for full studs',
            )


class GradedCircleTread(Lugs):
    """Round studs that grow or shrink along the shoe, on one lattice."""

    name: ClassVar[str] = "graded_circles"

    front_lug_width: Length = Field(description="diameter at graded_length and beyond")
    graded_length: Length = Field(description="from the first stud, along the shoe")


class LetteringTread(Lugs):
    """Letters of one line of text, repeated along and across the shoe.

    It reads from heel to toe seen from below; ``lug_width`` is the height of its capitals,
    ``channel_width`` the gap between letters and between lines.
    """

    name: ClassVar[str] = "lettering"

    text: str = Field(description='as "GRIP", in DejaVu Sans Bold')

    def letters(self) -> Lettering:
        from underfoot.shoe.lettering import Lettering

        shells, holes = text_rings(self.text, self.lug_width, self.channel_width)
        return Lettering(_points(shells), _points(holes), self.channel_width)

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        try:
            check_text(self.text, f"{where}.text")
        except InputError as error:
            yield error
            return
        yield from super().problems(case, where)
        stroke = self.letters().stroke
        yield from _check_resolution(case, f"{where}.lug_width", stroke)
        if self.edge_radius > min(self.depth, stroke / 2):
            yield RangeError(
                f"{display(self.edge_radius, 'm')} does not fit on the letters' strokes",
                where=f"{where}.edge_radius",
                allowed=_at_most(min(self.depth, stroke / 2), "half a stroke"),
            )


def _points(rings: tuple[Any, ...]) -> tuple[tuple[tuple[float, float], ...], ...]:
    return tuple(tuple((float(x), float(y)) for x, y in ring) for ring in rings)


def through_outsole(case: CaseView, depth: float, where: str) -> Iterator[InputError]:
    """Yield the error of a depth that reaches through the outsole."""
    thickness = case.shoe.sole.outsole_thickness
    if depth >= thickness:
        yield RangeError(
            Message("{depth} goes through the outsole", depth=display(depth, "m")),
            where=where,
            allowed=Message(
                "below {thickness} (shoe.sole.outsole_thickness)", thickness=display(thickness, "m")
            ),
        )


def _check_resolution(case: CaseView, path: str, width: float) -> Iterator[InputError]:
    for name in ("grid_spacing", "quick_grid_spacing"):
        spacing = getattr(case.numerics, name)
        if width < _CELLS * spacing * (1 - 1e-9):
            yield InputError(
                Message(
                    "{width} is too narrow for the grid of {spacing}",
                    width=display(width, "m"),
                    spacing=display(spacing, "m"),
                ),
                where=path,
                allowed=Message(
                    "at least {cells} (two cells)", cells=display(_CELLS * spacing, "m")
                ),
                remedy=Message(
                    'Write numerics.{name} = "{width:.3g} mm" (four cells)',
                    name=name,
                    width=width / 4 * 1000.0,
                ),
            )
