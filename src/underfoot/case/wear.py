"""Slot for the wear of the sole: by walking, a plane cut, a patch, or pressure times sliding."""

from __future__ import annotations

import math
import re
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field

from underfoot.core import InputError, RangeError, display, to_si
from underfoot.core.remark import Amount, Message

from .quantity import Angle, Depth, Force, Length, Quantity, Rounding, default, optional
from .section import GIVEN, CaseView, Option, Origin, leaf_of, refused_at
from .sole import is_bare, through_outsole

if TYPE_CHECKING:
    from underfoot.shoe.shape import SoleWear, WearOnSole

WearAngle = Annotated[float, Quantity("rad", 0.0, math.radians(45))]
Place = Annotated[float, Quantity("m", -0.2, 0.2)]
Taper = Annotated[float, Quantity("rad", math.radians(0.5), math.radians(60))]
DIN_FORCE, DIN_WAY = 10.0, 40.0
"""N and m: load and way of the abrasion test, ISO 4649 (DIN 53516)."""
USUAL_WEAR_RATE = 3.7500000000000005e-10
"""m^2/N: the float that "0.375 mm^3/(N*m)" becomes, one rounding above 3.75e-10."""
_ABRASION = re.compile(r"\s*(?:(?:DIN|ISO)(?:\s*(?:53516|4649))?\s+)?(?P<volume>\d.*[^\W\d_].*)")
WearRate = Annotated[float, Quantity("m^2/N", 1e-20, 1e-6)]


class Wear(Option):
    """How much of the sole is worn away, and how."""

    slot: ClassVar[str] = "wear"
    key: ClassVar[str] = "mode"
    usual: ClassVar[str | None] = "plane"

    depth: Depth = default(0.0, "0 mm", "unworn beyond the heel shape given")
    edge_radius: Rounding = default(
        0.15e-3,
        "0.15 mm",
        "largest round that wear gives lug edges: as deep as the edge yields under traction; "
        "nobody measured it, 0.1 to 0.5 mm are plausible",
        assumed=True,
    )

    @abstractmethod
    def build(self) -> SoleWear | WearOnSole | None:
        """Return what is worn away as geometry; None where a contact must be solved for it."""

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        edges = ("edge_radius",) if is_bare(case) else ()
        if self.depth > 0:
            return edges
        generator = (name for name in type(self).model_fields if name not in Wear.model_fields)
        return (*generator, *edges)

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from through_outsole(case, self.depth, f"{where}.depth")


class PlaneWear(Wear):
    """Ground off at one angle."""

    name: ClassVar[str] = "plane"
    source: ClassVar[str] = "ground at one angle"

    angle: WearAngle = default(0.0, "0 deg", "even wear")

    def build(self) -> SoleWear | None:
        from underfoot.shoe import WearPlane

        return WearPlane(self.depth, self.angle)


class WalkWear(Wear):
    """Cut by the floor at every angle from heel contact to flat, as walkers load it."""

    name: ClassVar[str] = "walk"
    source: ClassVar[str] = "load and angle of ten recorded steps that come with the package"

    def build(self) -> WearOnSole:
        from underfoot.shoe.worn import WalkingWear

        return WalkingWear(self.depth)


class PatchWear(Wear):
    """A worn patch of given size."""

    name: ClassVar[str] = "patch"

    patch_form: Literal["ellipse", "rectangle"] = default("ellipse", "ellipse", "patch")
    patch_length: Length = Field(description="along the shoe")
    patch_width: Length = Field(description="across the shoe")
    patch_position: Length | None = optional(
        "its middle from the rear end; default: it begins there"
    )
    patch_lateral: Place = default(0.0, "0 mm", "its middle on the centre line")
    patch_taper: Taper = default(
        math.radians(3), "3 deg", "slope of the wear around it", assumed=True
    )

    def build(self) -> WearOnSole:
        from underfoot.shoe.worn import WornPatch

        return WornPatch(
            depth=self.depth,
            length=self.patch_length,
            width=self.patch_width,
            position=self.patch_position,
            lateral=self.patch_lateral,
            form=self.patch_form,
            taper=self.patch_taper,
        )

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from super().problems(case, where)
        heel = case.shoe.heel
        if heel is None or self.depth == 0.0:
            return
        for name, most in (("patch_length", heel.length), ("patch_width", heel.widest)):
            if getattr(self, name) > most * (1 + 1e-9):
                yield RangeError(
                    f"a worn patch of {display(getattr(self, name), 'm')} is larger than the shoe",
                    where=f"{where}.{name}",
                    allowed=Message(
                        "at most {most}, the extent of the sole", most=Amount(most, "m")
                    ),
                )


class ArchardWear(Wear):
    """Pressure times sliding, step by step, at three angles of early stance."""

    name: ClassVar[str] = "archard"

    angle: WearAngle = Field(description="shoe angle at which the sole wears, as 12 deg")
    angle_range: Angle = default(
        math.radians(10),
        "10 deg",
        "the shoe wears at three angles of early stance; their span",
        assumed=True,
    )
    normal_force: Force | None = optional("while wearing; default motion.normal_force")
    abrasion: str | None = optional('volume lost in ISO 4649, as "DIN 150 mm3": sets wear_rate')
    wear_rate: WearRate = default(
        USUAL_WEAR_RATE,
        "0.375 mm^3/(N*m)",
        "150 mm^3 lost on the abrasive sheet of ISO 4649 (10 N, 40 m), the limit for good soles; "
        "floors are far gentler, and only the sliding distance depends on it",
        assumed=True,
    )

    @classmethod
    def in_own_terms(cls, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """Return ``abrasion``, the volume lost in the abrasion test, as ``wear_rate``.

        k = V / (10 N x 40 m), the load and the way of ISO 4649 (DIN 53516), method A.
        """
        leaf = leaf_of(given.get("abrasion"))
        if leaf.given is None:
            return given
        match = _ABRASION.fullmatch(leaf.given) if isinstance(leaf.given, str) else None
        try:
            if leaf_of(given.get("wear_rate")).given is not None:
                raise InputError("abrasion and wear_rate say the same thing twice")
            if match is None:
                example = 'the volume lost, as "DIN 150 mm3"'
                raise InputError(
                    Message("{given} is no abrasion", given=repr(leaf.given)), allowed=example
                )
            volume = 1e9 * to_si(match["volume"], "m^3", where="")
        except InputError as error:
            raise refused_at(cls, ("abrasion",), error, leaf.given) from error
        rate = f"{volume / (DIN_FORCE * DIN_WAY):.6g} mm^3/(N*m)"
        source = Message(
            "{volume:g} mm^3 lost on the abrasive sheet of ISO 4649; floors are far gentler",
            volume=volume,
        )
        leaf = replace(leaf, given=rate, source=source)
        return {**given, "abrasion": None, "wear_rate": Origin(GIVEN, leaf)}

    def build(self) -> SoleWear | None:
        return None

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from super().problems(case, where)
        if case.shoe.outsole is not None and self.depth > 0:
            yield InputError(
                'wear by pressure and sliding (mode = "archard") needs a parametric sole',
                where=f"{where}.mode",
                allowed='"plane" or "patch" with an outsole file',
            )
