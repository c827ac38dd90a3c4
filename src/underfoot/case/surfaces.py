"""Sections for the roughness of sole and floor, and for the interface that both make."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from underfoot.core import DataError, InputError, RangeError, SourcedValue, display, to_si
from underfoot.core.arrays import Array
from underfoot.core.remark import Message

from .quantity import Length, Quantity, default, optional
from .section import CATALOGUE, FILE, GIVEN, CaseView, Option, Section, origin_of, with_file_values
from .tables import meant_file, plain, with_checksum

if TYPE_CHECKING:
    from underfoot.surface import Scan

Roughness = Annotated[float, Quantity("m", 1e-9, 1e-3)]
Cutoff = Annotated[float, Quantity("m", 1e-6, 0.1)]
_mm, _um = 1e-3, 1e-6
RQ_PER_RA = math.sqrt(math.pi / 2)
"""Rq over Ra of Gaussian heights, 1.253."""
RZ_SPREAD = (4.0, 8.0)
"""Rz over Rq of profiles (95 %); of steel of EN ISO 13287 in the catalogue 6."""
SOLE_RQ, FLOOR_RQ = (1.25e-6, 10e-6), (0.3e-6, 4e-6)
"""Rq (m) of soles (Ra 1 to 8 um) and of smooth to matt floors, where none is given (assumed)."""
BEYOND_DEVIATION = math.log(2) / 1.96
"""Standard deviation of ln ``roughness_beyond_cutoff`` where it is assumed: 2, between 1 (no waves
beyond the stylus' cut-off) and 4 (Hurst 0.8, waves up to 4.5 mm) in 95 %."""
STEEPEST = 0.5
"""Largest rms slope of the interface's longest waves (small-slope theory, assumed)."""
STEEPEST_RAMP = math.radians(15.0)
"""Steepest floor that people walk as they do on the level (1 in 4; assumed)."""
STYLUS_WAVES = (2.5e-6, 0.8e-3)
"""Shortest and longest wave (m) of a stylus as standards filter it."""
_AS_READ = ("cutoff", "length_unit", "height_unit", "spacing")

WAVES = ("interface.hurst", "interface.longest_wave", "interface.shortest_wave")
"""What options that need the self-affine interface read of it."""


class SurfaceRoughness(Section):
    """Roughness numbers of a profile after the cut-off, or the scan that they are computed from.

    A number that is given goes before that of the scan, whose spectrum is then scaled to it.
    """

    file_paths: ClassVar[tuple[str, ...]] = ("file",)

    ra: Roughness | None = optional("mean deviation")
    rq: Roughness | None = optional("root-mean-square deviation")
    rz: Roughness | None = optional("mean peak-to-valley height")
    rp: Roughness | None = optional("highest peak")
    rt: Roughness | None = optional("total height")
    cutoff: Cutoff | None = optional("cut-off wavelength of the filter")
    file: str | None = optional(
        "scan of the surface, profile or map, in any format of underfoot surface; the path counts "
        "from the case file's folder"
    )
    sha256: str | None = optional("checksum of the scan that is meant; another file is refused")
    length_unit: str | None = optional("of positions, where the scan does not name it")
    height_unit: str | None = optional("of heights, where the scan does not name it")
    spacing: Annotated[float, Quantity("m", 1e-9, 1e-3)] | None = optional(
        "between points, where the scan has no positions"
    )

    @classmethod
    def complete_data(cls, table: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
        table = with_checksum(table, "file", folder, where)
        if not isinstance(plain(table.get("file")), str):
            return table
        given = {name: plain(table.get(name)) for name in ("file", "sha256", *_AS_READ)}
        for name in ("spacing", "cutoff"):
            origin = origin_of(table.get(name))
            if origin is not None and origin.kind in (CATALOGUE, FILE):
                given[name] = None
            elif isinstance(given[name], str):
                given[name] = to_si(given[name], "m", where=f"{where}.{name}")
        scan = _scan(given, where)
        heights = {name: scan.values[name] for name in ("ra", "rq", "rz", "rp", "rt")}
        origin = origin_of(table.get("ra"))
        if origin is not None and origin.kind == GIVEN:
            del heights["rq"]
        cutoff = SourcedValue(scan.cutoff, "m", source="longest of ISO 21920-3 in the scan")
        return with_file_values(table, {**heights, "cutoff": cutoff}, scan.name)

    def scan(self) -> Scan | None:
        """Return the scan as read; None without one. Its spectrum is that of its own Rq."""
        return None if self.file is None else _scan(vars(self), "roughness")

    @property
    def rq_or_estimate(self) -> float | None:
        """Rq (m) as given, else 1.25 Ra (Gaussian heights: sqrt(pi/2) = 1.253), else Rz / 5.7.

        None if none of them is known.
        """
        if self.rq is not None:
            return self.rq
        if self.ra is not None:
            return RQ_PER_RA * self.ra
        return None if self.rz is None else self.rz / math.sqrt(math.prod(RZ_SPREAD))

    def share_up_to(self, longest: float, hurst: float) -> float:
        """Return Rq of waves up to ``longest`` (m) over the Rq of the case, where no scan tells it.

        Behind a longer cut-off waves are left out, self-affine with ``hurst``; what a shorter one
        hides is not known, and its Rq stands as it is.
        """
        return min(1.0, (longest / (self.cutoff or longest)) ** hurst)

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        forms = ("rq", "ra", "rz")  # the first that is known counts
        known = [name for name in forms if getattr(self, name) is not None]
        scan = ("length_unit", "height_unit", "spacing") if self.file is None else ()
        filtered = ("cutoff",) if self.file is None and not known else ()
        return ("rp", "rt", *known[1:], *filtered, *scan)

    @property
    def rq_uncertainty(self) -> float | None:
        """Standard deviation of ``rq_or_estimate``, m; None when not given.

        That of Rz / 5.7 holds that it may be Rz / 8 to Rz / 4 (95 %).
        """
        if self.rq is not None:
            return self.sourced_value("rq").uncertainty
        if self.ra is None and self.rz is not None:
            form = math.log(RZ_SPREAD[1] / RZ_SPREAD[0]) / (2 * 1.96)
            read = (self.sourced_value("rz").uncertainty or 0.0) / self.rz
            return math.hypot(form, read) * (self.rq_or_estimate or 0.0)
        spread = self.sourced_value("ra").uncertainty
        return spread and RQ_PER_RA * spread

    def density(self, wavenumber: ArrayLike) -> Array:
        """Return C(q) (m^4) of the scan at wave numbers (rad/m), scaled to the Rq of the case."""
        scan = self.scan()
        assert scan is not None
        assert self.rq_or_estimate is not None
        scanned = float(scan.values["rq"])
        return scan.density(wavenumber) * (self.rq_or_estimate / scanned) ** 2

    def directions(self, wavenumber: ArrayLike) -> tuple[Array, Array] | None:
        """Return how a scan with a lay shares C(q) between directions from sliding (its x axis).

        ``Scan.directions_at``; None where all directions are alike, or without a scan.
        """
        scan = self.scan()
        return None if scan is None else scan.directions_at(wavenumber)

    def moment(self, order: int, shortest: float, longest: float) -> float:
        """Return rms height (order 0, m) or rms slope (order 1, 1) of the scan between two waves.

        Both directions together: sqrt(2 pi int q^(1 + 2 n) C dq).
        """
        q = np.geomspace(2 * math.pi / longest, 2 * math.pi / shortest, 200)
        return math.sqrt(2 * math.pi * np.trapezoid(q ** (1 + 2 * order) * self.density(q), q))


def _scan(given: Mapping[str, Any], where: str) -> Scan:
    """Return the scan of a section as its content was when the case was made."""
    with meant_file(given["file"], given["sha256"], f"{where}.file") as path:
        try:
            return _read(path, given["sha256"], *(given[name] for name in _AS_READ))
        except (DataError, InputError) as error:
            what = f"{path.name}: {error.what}"
            rest = {name: getattr(error, name) for name in ("allowed", "nearest", "remedy")}
            raise InputError(what, where=f"{where}.file", **rest) from error


@lru_cache(maxsize=32)
def _read(path: Path, content: str, *settings: Any) -> Scan:
    from underfoot.surface import read_scan

    return read_scan(path, strict=True, **dict(zip(_AS_READ, settings, strict=True)))


class Floor(Section):
    """Hard floor; people walk down its slope."""

    roughness: SurfaceRoughness
    shore_a: Annotated[float, Quantity("1", 0.0, 100.0, open_low=True)] | None = None
    slope: Annotated[float, Quantity("rad", 0.0, STEEPEST_RAMP)] | None = optional(
        "of a ramp, as it is walked down: a step needs that much more friction; level if not given"
    )


class Interface(Option):
    """What sole and floor make together; the least known part of a case."""

    slot: ClassVar[str] = "interface"
    usual: ClassVar[str | None] = "composite"
    own_roughness: ClassVar[tuple[str, ...]] = ("shoe", "floor")
    """Sections whose roughness makes that of the interface."""

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

    def leak_deviation(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> float:
        """Return the standard deviation of ln of the Rq that lets fluid leak; 0 if not known."""
        return self.rq_deviation(shoe, floor) or 0.0

    def _too_rough(self, case: CaseView, where: str) -> Iterator[InputError]:
        rq = float(self.rq(case.shoe.roughness, case.floor.roughness))
        waves, what = self.longest_wave, f"an Rq of {display(rq, 'm')}"
        steepest = STEEPEST * waves / (2 * math.pi)
        own = {
            name: getattr(case, name).roughness.rq_or_estimate or 0.0 for name in self.own_roughness
        }
        rougher = max(own, key=own.__getitem__, default="")
        pool = math.inf if case.contaminant is None else case.contaminant.pool_depth
        if own and own[rougher] > steepest:
            rq, what = own[rougher], f"an Rq of {display(own[rougher], 'm')}"
            where = f"{rougher}.roughness"
        elif own and rq > steepest:
            what = (
                f"an Rq of {display(own[rougher], 'm')}, which makes one of {display(rq, 'm')} "
                f"between sole and floor ({where}),"
            )
            where = f"{rougher}.roughness"
        if rq > steepest:
            yield RangeError(
                f"{what} is no roughness of a sole on a floor: its waves of up to "
                f"{display(waves, 'm')} would be steeper than the theory of rough contact allows",
                where=where,
                allowed=Message(
                    "at most {most}", most=display(steepest * own.get(rougher, rq) / rq, "m")
                ),
                remedy="Soles and floors have a few to some tens of micrometres; a deeper pattern "
                "belongs to shoe.tread",
            )
        elif rq > pool / 3:
            yield RangeError(
                f"{display(pool, 'm')} of fluid do not cover the summits (3 Rq) of a roughness of "
                f"{display(rq, 'm')} between sole and floor: what holds the film is not known",
                where="contaminant.pool_depth",
                allowed=Message("at least {least}", least=display(3 * rq, "m")),
                remedy="Give the depth of the fluid, or leave contaminant out for a floor that is "
                "only damp",
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
        heights = self._height(shoe, SOLE_RQ), self._height(floor, FLOOR_RQ)
        measured = bool(shoe.file and floor.file)
        waves = f"waves of the scans up to {display(self.longest_wave, 'm')}"
        return SourcedValue(
            math.hypot(*heights),
            "m",
            source=waves if measured else f"{self.source}, times {self.roughness_beyond_cutoff:g}",
            assumed=not measured,
            note=""
            if measured
            else "the stylus' cut-off hides long waves, through which fluid leaks",
        )

    def _height(self, roughness: SurfaceRoughness, usual: tuple[float, float]) -> float:
        """Return Rq with waves up to the longest, m: of the scan, else the factor times Rq."""
        if roughness.sha256 is None:
            rq = roughness.rq_or_estimate
            if rq is None:
                rq = math.sqrt(math.prod(usual))
            else:
                rq *= roughness.share_up_to(STYLUS_WAVES[1], self.hurst)
            return self.roughness_beyond_cutoff * rq
        return roughness.moment(0, STYLUS_WAVES[0], self.longest_wave)

    def unused_keys(self, case: CaseView) -> tuple[str, ...]:
        if not (case.shoe.roughness.file and case.floor.roughness.file):
            return ()
        read = WAVES[0] in case.friction.reads
        return ("roughness_beyond_cutoff",) if read else ("roughness_beyond_cutoff", "hurst")

    def rq_deviation(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> float | None:
        heights = [(part.rq_or_estimate or 0.0, part.rq_uncertainty) for part in (shoe, floor)]
        squares = math.fsum(rq**2 for rq, _ in heights)
        known = [rq * spread for rq, spread in heights if spread is not None]
        return math.hypot(*known) / squares if known and squares > 0 else None

    def leak_deviation(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> float:
        beyond, parts = self.sourced_value("roughness_beyond_cutoff"), []
        assumed = BEYOND_DEVIATION if beyond.assumed else 0.0
        factor = (beyond.uncertainty or 0.0) / self.roughness_beyond_cutoff or assumed
        scanned = 0.0
        for roughness, usual in ((shoe, SOLE_RQ), (floor, FLOOR_RQ)):
            square, rq = self._height(roughness, usual) ** 2, roughness.rq_or_estimate
            drawn = math.log(usual[1] / usual[0]) / (2 * 1.96)
            given = (roughness.rq_uncertainty or 0.0) / rq if rq else drawn
            parts.append(square * given)
            scanned += square * (roughness.sha256 is not None)
        whole = float(self.rq(shoe, floor))
        return math.hypot(*parts, (whole**2 - scanned) * factor) / whole**2 if whole else 0.0

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from self._too_rough(case, f"{where}.roughness_beyond_cutoff")


class MeasuredInterface(Interface):
    """Rq of the interface as given."""

    name: ClassVar[str] = "measured"
    source: ClassVar[str] = "given in the case"
    chosen_by: ClassVar[tuple[str, ...]] = ("effective_rq",)
    own_roughness: ClassVar[tuple[str, ...]] = ()

    effective_rq: Roughness = Field(
        description="roughness that lets fluid leak and asperities touch"
    )

    def rq(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> SourcedValue:
        return self.sourced_value("effective_rq")

    def rq_deviation(self, shoe: SurfaceRoughness, floor: SurfaceRoughness) -> float | None:
        spread = self.sourced_value("effective_rq").uncertainty
        return None if spread is None else spread / self.effective_rq

    def problems(self, case: CaseView, where: str) -> Iterator[InputError]:
        yield from self._too_rough(case, f"{where}.effective_rq")
