"""Sections for the roughness of sole and floor, and for the interface that both make."""

import math
from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, ClassVar

from pydantic import Field

from underfoot.core import InputError, RangeError, SourcedValue, display

from .quantity import Length, Quantity, default, optional
from .section import CaseView, Option, Section

Roughness = Annotated[float, Quantity("m", 1e-9, 1e-3)]
Cutoff = Annotated[float, Quantity("m", 1e-6, 0.1)]
_mm, _um = 1e-3, 1e-6
RQ_PER_RA = math.sqrt(math.pi / 2)
"""Rq over Ra of Gaussian heights, 1.253."""
SOLE_RQ, FLOOR_RQ = (1.25e-6, 10e-6), (0.3e-6, 4e-6)
"""Rq (m) of soles (Ra 1 to 8 um) and of smooth to matt floors, where none is given (assumed)."""
STEEPEST = 0.5
"""Largest rms slope of the interface's longest waves (small-slope theory, assumed)."""


WAVES = ("interface.hurst", "interface.longest_wave", "interface.shortest_wave")
"""What options that need the self-affine interface read of it."""


class SurfaceRoughness(Section):
    """Roughness numbers of a profile after the cut-off."""

    ra: Roughness | None = optional("mean deviation")
    rq: Roughness | None = optional("root-mean-square deviation")
    rz: Roughness | None = optional("mean peak-to-valley height")
    rp: Roughness | None = optional("highest peak")
    rt: Roughness | None = optional("total height")
    cutoff: Cutoff | None = optional("cut-off wavelength of the filter")

    @property
    def rq_or_estimate(self) -> float | None:
        """Rq as given, else 1.25 Ra (Gaussian heights: sqrt(pi/2) = 1.253), m; None if unknown."""
        if self.rq is not None:
            return self.rq
        return None if self.ra is None else RQ_PER_RA * self.ra

    @property
    def rq_uncertainty(self) -> float | None:
        """Standard deviation of ``rq_or_estimate``, m; None when not given."""
        if self.rq is not None:
            return self.sourced("rq").uncertainty
        spread = self.sourced("ra").uncertainty
        return spread and RQ_PER_RA * spread


class Floor(Section):
    """Hard floor."""

    roughness: SurfaceRoughness
    shore_a: Annotated[float, Quantity("1", 0.0, 100.0, open_low=True)] | None = None


class Interface(Option):
    """What sole and floor make together; the least known part of a case."""

    slot: ClassVar[str] = "interface"
    usual: ClassVar[str | None] = "composite"

    hurst: Annotated[float, Quantity("1", 0.1, 1.0)] = default(
        0.8, 0.8, "common for worn and abraded surfaces", assumed=True
    )
    longest_wave: Length = default(
        2 * _mm,
        "2 mm",
        "where a roughness that grows as the length to the power 0.8 has doubled "
        "since the stylus' cut-off of 0.8 mm",
        assumed=True,
    )
    shortest_wave: Annotated[float, Quantity("m", 1e-6, 1e-2)] = default(
        125 * _um,
        "0.125 mm",
        "what a grid of 128 cells holds; sets contact area, hardly the gap",
        assumed=True,
    )

    @abstractmethod
    def rq(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> SourcedValue:
        """Return Rq of the interface, m."""

    @abstractmethod
    def rq_deviation(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> float | None:
        """Return the standard deviation of Rq over itself; None when not given."""

    def _too_rough(self, case: CaseView, where: str) -> Iterator[InputError]:
        rq = self.rq(case.shoe.roughness, case.floor.roughness).value or 0.0
        waves = self.longest_wave
        limits = {
            f"its waves of up to {display(waves, 'm')} would be steeper than the theory of rough "
            "contact holds for": STEEPEST * waves / (2 * math.pi)
        }
        if case.contaminant is not None:
            pool = case.contaminant.pool_depth
            limits[f"its summits (3 Rq) would stand out of {display(pool, 'm')} of fluid"] = (
                pool / 3
            )
        why, limit = min(limits.items(), key=lambda item: item[1])
        if rq > limit:
            yield RangeError(
                f"an Rq of {display(rq, 'm')} is no roughness of a sole on a floor: {why}",
                where=where,
                allowed=f"at most {display(limit, 'm')}",
                remedy="Soles and floors have a few to some tens of micrometres; a deeper pattern "
                "belongs to shoe.tread",
            )
        if self.shortest_wave >= self.longest_wave:
            yield RangeError(
                "the shortest wave of the interface is not shorter than the longest",
                where="interface.shortest_wave",
                allowed=f"below {display(self.longest_wave, 'm')} (interface.longest_wave)",
            )


class CompositeInterface(Interface):
    """Rq = f sqrt(Rq_shoe^2 + Rq_floor^2) of the stylus, with f = ``roughness_beyond_cutoff``.

    A roughness that is not given takes the middle of its usual range; the result says so.
    """

    name: ClassVar[str] = "composite"
    source: ClassVar[str] = "composite of the stylus Rq of shoe and floor"

    roughness_beyond_cutoff: Annotated[float, Quantity("1", 1.0, 10.0)] = default(
        2.0,
        2.0,
        "chosen on one reading of the report (G.4, untreaded work shoe in glycerol, 201 N); "
        "the stylus sees no waves beyond its cut-off of 0.8 mm, the leaking fluid does",
        assumed=True,
    )

    def rq(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> SourcedValue:
        ours = shoe.rq_or_estimate or math.sqrt(math.prod(SOLE_RQ))
        theirs = floor.rq_or_estimate or math.sqrt(math.prod(FLOOR_RQ))
        return SourcedValue(
            self.roughness_beyond_cutoff * math.hypot(ours, theirs),
            "m",
            source=f"{self.source}, times {self.roughness_beyond_cutoff:g}",
            assumed=True,
            note="the stylus' cut-off hides long waves, through which fluid leaks",
        )

    def rq_deviation(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> float | None:
        heights = [(part.rq_or_estimate or 0.0, part.rq_uncertainty) for part in (shoe, floor)]
        squares = math.fsum(rq**2 for rq, _ in heights)
        known = [rq * spread for rq, spread in heights if spread is not None]
        return math.hypot(*known) / squares if known and squares > 0 else None

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from self._too_rough(case, f"{where}.roughness_beyond_cutoff")


class MeasuredInterface(Interface):
    """Rq of the interface as given."""

    name: ClassVar[str] = "measured"
    source: ClassVar[str] = "given in the case"
    chosen_by: ClassVar[tuple[str, ...]] = ("effective_rq",)

    effective_rq: Roughness = Field(
        description="roughness that lets fluid leak and asperities touch"
    )

    def rq(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> SourcedValue:
        return self.sourced("effective_rq")

    def rq_deviation(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> float | None:
        spread = self.sourced("effective_rq").uncertainty
        return None if spread is None else spread / self.effective_rq

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from self._too_rough(case, f"{where}.effective_rq")
