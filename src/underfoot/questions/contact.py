"""Rubber on one rough surface, dry, at rest or sliding: real contact, hysteresis, gap, leakage."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from underfoot import material, surface
from underfoot.core import Cache, DataError, InputError, Progress, display, silent, to_si
from underfoot.core.checks import exactly_one
from underfoot.core.device import card, on_card
from underfoot.core.files import read_toml
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Amount, Message
from underfoot.rough_contact import (
    ContactTable,
    SteadySliding,
    contacts_on_card,
    steady_sliding,
    table_over_scales,
)
from underfoot.rough_contact.cutoff import CutoffDependence, cutoff_dependence
from underfoot.rough_contact.flow_factor import FlowFactors, flow_factors
from underfoot.surface import HeightMap, Profile, level_surface, read_scan
from underfoot.surface.scan import height_cautions

ROWS = (
    ("Mean pressure", "pressure_Pa", "Pa", ""),
    ("Sliding speed", "speed_m_per_s", "m/s", ""),
    ("Surface, rms height", "rms_height_m", "m", ""),
    ("Surface, rms slope", "rms_slope", "1", "both directions together"),
    ("Shortest wave", "shortest_wave_m", "m", "contact and friction refer to it"),
    ("Real contact fraction", "real_contact_fraction", "1", "edges of patches corrected"),
    ("Hysteresis COF", "cof_hysteresis", "1", ""),
    ("Mean gap", "mean_gap_m", "m", "contact counted as zero"),
    ("Flow factor along", "flow_factor_along", "1", "of a smooth gap of that mean; 0: sealed"),
    ("Flow factor across", "flow_factor_across", "1", ""),
)


LONGEST_WAVE, SHORTEST_WAVE = 2e-3, 2.5e-6
"""Waves (m) of a table: those of a case by default."""
PRESSURES = (1e3, 2e6, 12)
"""Lowest and highest nominal pressure of a table, Pa, and their number."""


@dataclass(frozen=True, slots=True)
class RoughContact(Presentable):
    """One rough contact: the surface, the solution, the leakage of its gap."""

    kind: ClassVar[str] = "contact"
    name: ClassVar[str] = "Rough contact"

    rubber: str
    floor: HeightMap
    contact: SteadySliding
    flow: FlowFactors
    scales: CutoffDependence | None
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<RoughContact of {self.rubber:.120}: {self.contact.status}>"

    @property
    def usable(self) -> bool:
        return self.contact.status.usable

    @property
    def _at(self) -> Message:
        contact = self.contact
        return Message(
            "{pressure}, {speed}",
            pressure=Amount(contact.nominal_pressure, "Pa"), speed=Amount(contact.speed, "m/s"),
        )  # fmt: skip

    @property
    def answer(self) -> Message:
        """The real contact and hysteresis of a usable solution, with pressure and speed."""
        return Message(
            "Real contact {contact:.3g} %, hysteresis COF {cof_hysteresis:.3g} at {at}",
            contact=100.0 * self.contact.real_contact_fraction_corrected,
            cof_hysteresis=self.contact.cof_hysteresis, at=self._at,
        )  # fmt: skip

    def headline(self) -> tuple[Message, ...]:
        if not self.usable:
            return (
                Message(
                    "No result at {at}: {status}. {remedy}",
                    at=self._at, status=self.contact.status, remedy=self.contact.status.remedy,
                ),
            )  # fmt: skip
        return (Message("{answer} ({rubber}).", answer=self.answer, rubber=self.rubber),)

    def cautions(self) -> tuple[str, ...]:
        """Return why the heights are none of a floor."""
        return height_cautions(self.floor.rms_height)

    def table(self) -> Table:
        content = self.to_dict()
        rows = [
            (label, _value_text(content[key], unit, "not estimated"), remark)
            for label, key, unit, remark in ROWS
        ]
        status = (
            str(self.contact.status),
            Message("{iterations} iterations", iterations=self.contact.iterations),
        )
        return Table("Contact", ("Quantity", "Value", "Remark"), [*rows, ("Status", *status)])

    def tables(self) -> tuple[Table, ...]:
        if self.scales is None:
            return (self.table(),)
        rows = [
            [
                _value_text(value, "m" if name.endswith("_m") else "1", "not converged")
                for name, value in row.items()
            ]
            for row in self._scale_entries(self.scales)
        ]
        heads = ("Shortest wave", "Real contact fraction", "Hysteresis COF")
        return self.table(), Table("Dependence on the shortest wave", heads, rows)

    def remarks(self) -> dict[str, Sequence[str]]:
        return {
            "Notes": self._notes(),
            "Outside the tested range": tuple(map(str, self.contact.breaches)),
        }

    def to_dict(self) -> dict[str, Any]:
        contact, floor, flow = self.contact, self.floor, self.flow
        values = {
            "real_contact_fraction": contact.real_contact_fraction_corrected,
            "cof_hysteresis": contact.cof_hysteresis,
            "mean_gap_m": contact.mean_gap,
            "flow_factor_along": flow.along,
            "flow_factor_across": flow.across,
        }
        content: dict[str, Any] = {
            "rubber": self.rubber,
            "pressure_Pa": contact.nominal_pressure,
            "speed_m_per_s": contact.speed,
            "rms_height_m": floor.rms_height,
            "rms_slope": surface.rms_slope(floor),
            "grid": list(floor.shape),
            "spacing_m": floor.spacing,
            "shortest_wave_m": floor.resolution,
            **{name: float(value) if self.usable else None for name, value in values.items()},
            "status": str(contact.status),
            "iterations": contact.iterations,
            "complementarity_error": contact.complementarity_error,
            "notes": list(self._notes()),
            "breaches": [str(breach) for breach in contact.breaches],
        }
        if self.scales is not None:
            content["shortest_waves"] = self._scale_entries(self.scales)
        return content

    def _notes(self) -> tuple[str, ...]:
        return self.notes if self.scales is None else (self.scales.note, *self.notes)

    def _scale_entries(self, scales: CutoffDependence) -> list[dict[str, Any]]:
        columns = {
            "shortest_wave_m": scales.shortest_wave,
            "real_contact_fraction": scales.real_contact_fraction,
            "cof_hysteresis": scales.cof_hysteresis,
        }
        return [
            {
                name: None if np.isnan(values[k]) else float(values[k])
                for name, values in columns.items()
            }
            for k in range(scales.shortest_wave.size)
        ]


def _value_text(value: float | None, unit: str, missing: str) -> str:
    return missing if value is None else display(value, unit)


def rough_contact(
    floor: HeightMap,
    rubber: tuple[Any, str, Sequence[str]],
    *,
    pressure: float,
    speed: float = 0.0,
    poisson_ratio: float = 0.5,
    scales: bool = False,
    device: str = "cpu",
) -> RoughContact:
    """Return the contact of a rubber on a surface at a mean pressure (Pa) and speed (m/s).

    ``rubber`` is as ``rubber_from`` returns it; ``scales`` also computes the contact for up to five
    shortest waves, each half the one before, on the processor; ``device`` is as in
    ``ContactTable.from_surfaces``.
    """
    modulus, described, assumed = rubber
    contact, flow = solve_contact(floor, modulus, speed, pressure, poisson_ratio, device)
    dependence = None
    if scales:
        last, side = max(floor.resolution or 0.0, 4.0 * floor.spacing), min(floor.size)
        waves = [last * 2.0**n for n in range(4, -1, -1) if last * 2.0**n < 0.5 * side]
        if len(waves) < 2:
            raise InputError(
                Message(
                    "waves from {last:.3g} m on a side of {side:.3g} m: nothing to compare",
                    last=last,
                    side=side,
                ),
                where="--cutoffs",
                remedy="Take more --points or a surface with several scales",
            )
        dependence = cutoff_dependence(floor, modulus, speed, pressure, waves, poisson_ratio)
    notes = (*assumed, *contact.notes, *floor.processing)
    return RoughContact(described, floor, contact, flow, dependence, notes)


def measured_table(
    floor: Path,
    rubber: tuple[Any, str, Sequence[str]],
    *,
    speed: float,
    shoe: Path | None = None,
    poisson_ratio: float = 0.5,
    longest: float = LONGEST_WAVE,
    device: str = "cpu",
    progress: Progress = silent,
) -> ContactTable:
    """Return the contact table of a scanned floor and, where given, a scanned sole.

    Waves from ``longest`` to that of a stylus, 2.5 um (``table_over_scales``), at one speed (m/s).

    Raises:
        DataError: A scan that is none of a floor or sole.
        InputError: No sliding: a table at rest is no friction.
    """
    if not speed > 0:
        raise InputError(
            "a contact table at rest has no friction",
            where="--speed",
            allowed="above 0 m/s",
            remedy='Give the speed of the case, as --speed "0.3 m/s"',
        )
    scans = [read_scan(path, strict=True) for path in (floor, shoe) if path is not None]
    name = " on ".join(scan.name for scan in reversed(scans)) + f", {rubber[1]}"
    if any(scan.directions is not None for scan in scans):
        name += ", a lay left out (C(q) as its mean over directions)"
    return table_over_scales(
        scans[0].density,
        (longest, SHORTEST_WAVE),
        rubber[0],
        np.geomspace(*PRESSURES),
        [speed],
        shoe=scans[1].density if shoe is not None else None,
        poisson_ratio=poisson_ratio,
        device=device,
        cache=Cache("contact_table"),
        description=name,
        progress=progress,
    )


def solve_contact(
    floor: HeightMap,
    rubber: Any,
    speed: float,
    pressure: float,
    poisson_ratio: float,
    device: str = "cpu",
) -> tuple[SteadySliding, FlowFactors]:
    """Return the contact and the flow factors of its gap."""
    accelerated, began = on_card(device, floor.heights.size), time.perf_counter()
    if not accelerated:
        given = floor.heights, floor.spacing, rubber, speed, pressure, poisson_ratio
        contact = steady_sliding(*given)
    else:
        given = floor.heights, floor.spacing, rubber, [(pressure, speed)], poisson_ratio
        (contact,) = contacts_on_card(*given)
        cost = Message(
            "contact solved on {card}, {time:.1f} s",
            card=card(), time=time.perf_counter() - began,
        )  # fmt: skip
        contact = replace(contact, notes=(*contact.notes, cost))
    if not contact.status.usable:
        return contact, FlowFactors(np.nan, np.nan, np.nan, np.nan, np.nan)
    gap = np.where(contact.pressure > 0.0, 0.0, contact.gap)
    return contact, flow_factors(gap, floor.spacing)


def surface_from(
    file: Path | None = None,
    *,
    rms: str | None = None,
    hurst: float = 0.8,
    longest: str | None = None,
    shortest: str | None = None,
    checkerboard: tuple[str, str] | None = None,
    points: int = 256,
    seed: int = 0,
) -> HeightMap:
    """Return the periodic height map that the options of ``underfoot contact`` describe.

    Lengths are text with units. Exactly one of ``file``, ``rms`` and ``checkerboard`` is given. A
    profile becomes a random surface with its spectrum; a map that is not periodic is mirrored.
    """
    kinds = {"a file": file, "--rms": rms, "--checkerboard": checkerboard}
    allowed = 'one of: FILE, --rms "5 um", --checkerboard "24.3 um" "0.4 mm"'
    exactly_one(kinds, "no surface", "underfoot contact", allowed)
    if not 8 <= points <= 8192:
        raise InputError(f"{points}", where="--points", allowed="8 to 8192 a side")
    last = None if shortest is None else to_si(shortest, "m", where="--shortest")
    first = None if longest is None else to_si(longest, "m", where="--longest")
    if checkerboard is not None:
        height, wave = (to_si(text, "m", where="--checkerboard") for text in checkerboard)
        return surface.checkerboard(points, wave / points, height, wave)
    if rms is not None:
        height, first = to_si(rms, "m", where="--rms"), 0.5e-3 if first is None else first
        spacing = 2.0 * first / points
        last = 8.0 * spacing if last is None else last
        return surface.self_affine(points, spacing, height, hurst, first, last, seed)
    assert file is not None
    measured = surface.read_surface(file)
    if isinstance(measured, Profile):
        return _from_profile(measured, points, seed, first, last)
    measured = surface.square_cells(measured)
    return measured if measured.periodic else mirror_map(measured)


def _from_profile(
    profile: Profile, points: int, seed: int, longest: float | None, shortest: float | None
) -> HeightMap:
    """Return an isotropic random surface with the spectrum of a measured profile.

    Two longest reliable waves make a side, eight grid points by default the shortest wave.
    """
    flat = level_surface(profile)
    spectrum = surface.isotropic_from_profile(surface.profile_spectrum(flat))
    low, high = spectrum.reliable
    if longest is not None:
        low = max(low, 2.0 * np.pi / longest)
    spacing = 4.0 * np.pi / low / points
    shortest = 8.0 * spacing if shortest is None else shortest
    part = spectrum.within(low, min(high, 2.0 * np.pi / shortest))
    random = surface.surface_from_spectrum(part, points, spacing, seed)
    note = Message(
        "the levelled profile has an rms height of {rms}, this surface "
        "{surface}: it keeps waves from {shortest} to {longest}",
        rms=Amount(float(np.std(flat.heights)), "m"), surface=Amount(random.rms_height, "m"),
        shortest=Amount(2.0 * np.pi / part.reliable[1], "m"),
        longest=Amount(2.0 * np.pi / low, "m"),
    )  # fmt: skip
    return replace(random, processing=(*random.processing, note))


def mirror_map(measured: HeightMap) -> HeightMap:
    """Return the levelled map with its mirror images beside it: periodic, nothing invented."""
    flat = level_surface(measured)
    row = np.concatenate([flat.heights, flat.heights[::-1]], axis=0)
    note = (
        "mirrored along both axes to close its edges: four times the area, and what differs "
        "between sliding forwards and backwards is averaged out"
    )
    heights = np.concatenate([row, row[:, ::-1]], axis=1)
    return replace(flat, heights=heights, periodic=True, processing=(*flat.processing, note))


def rubber_from(
    *,
    modulus: str | None = None,
    shore: float | None = None,
    spectrum: Path | None = None,
    name: str | None = None,
) -> tuple[Any, str, list[str]]:
    """Return (modulus for ``steady_sliding``, its description, what is assumed about it).

    Exactly one is given: Young's modulus as text, hardness, a file, or a measured material.
    """
    kinds = {"--modulus": modulus, "--shore": shore, "--spectrum": spectrum, "--material": name}
    allowed = 'one of: --modulus "5 MPa", --shore 60, --spectrum FILE, --material NAME'
    exactly_one(kinds, "no rubber", "underfoot contact", allowed)
    if modulus is not None:
        young = to_si(modulus, "Pa", where="--modulus")
        return young, Message("elastic, Young's modulus {modulus}", modulus=modulus), []
    if shore is not None:
        young = float(material.youngs_modulus_gent(shore))
        notes = [str(breach) for breach in material.gent_breaches(shore)]
        notes.append("Young's modulus from hardness (Gent 1958): static, tens of percent uncertain")
        values = {"shore": shore, "young": young * 1e-6}
        return young, Message("elastic, Shore A {shore:g}: {young:.3g} MPa", **values), notes
    if name is not None:
        rubber = material.report_elastomer(name)
        return (
            rubber.spectrum,
            Message("{rubber}, {source}", rubber=rubber.name, source=rubber.source),
            [],
        )
    assert spectrum is not None
    return _spectrum(spectrum)


def _compound(path: Path) -> tuple[Any, str, list[str]] | None:
    """Return the spectrum of a compound of ``underfoot material``; None where the file is none."""
    from underfoot.case.shoe import Material

    if path.suffix.lower() != ".toml" or not path.is_file():
        return None
    read = read_toml(path)
    if "relaxation" not in read:
        return None
    compound = Material.model_validate(read)
    assert compound.relaxation is not None
    return (
        compound.relaxation.young(compound.poisson_ratio),
        Message("compound of {path}", path=path.name),
        [],
    )


def _spectrum(path: Path) -> tuple[Any, str, list[str]]:
    """Return a compound, a Prony series, or the spectrum fitted to one dynamic sweep."""
    if (compound := _compound(path)) is not None:
        return compound
    try:
        return material.read_prony(path), Message("Prony series of {path}", path=path.name), []
    except DataError as first:
        try:
            sweeps = material.read_dynamic(path)
        except DataError as second:
            raise DataError(
                Message(
                    "{path} is neither a Prony series ({what}) nor a dynamic sweep ({second_what})",
                    path=path,
                    what=first.what,
                    second_what=second.what,
                ),
                where="--spectrum",
                allowed="TOML or CSV with tau and E_i; CSV with frequency, E' and E''",
            ) from second
    if len(sweeps) > 1:
        raise DataError(
            Message("{path} holds sweeps at {count} temperatures", path=path, count=len(sweeps)),
            where="--spectrum",
            allowed="one temperature",
            remedy="Make a master curve first (underfoot.material.dynamic_master_curve)",
        )
    sweep = sweeps[0]
    fit = material.fit_dynamic(sweep.angular_frequency, sweep.storage_modulus, sweep.loss_modulus)
    low, high = fit.frequency_range
    note = Message(
        "spectrum fitted to {low:.3g} to {high:.3g} rad/s, {residual:.2g} % rms",
        low=low, high=high, residual=100 * fit.rms_residual,
    )  # fmt: skip
    return fit.spectrum, Message("dynamic sweep of {path}", path=path.name), [note]
