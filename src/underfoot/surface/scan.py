"""A scan as a case takes it: roughness as a stylus gives it, spectrum, and what was not seen."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import DataError, SourcedValue, display
from underfoot.core.arrays import Array
from underfoot.core.presentation import Presentable, Table, percent
from underfoot.core.remark import NOTHING, Amount, Message

from .filter import holds, short_waves, within_cutoffs
from .heights import HeightMap, Profile, shortest_derivable_wavelength
from .lay import Directions, Texture, directions, lines_across, lines_along_axes, texture
from .prepare import held_level, level_surface, without_spikes
from .read import read_surface
from .roughness import STANDARDS, level_roughness
from .spectrum import (
    IsotropicSpectrum,
    isotropic_from_profile,
    level_spectrum,
    power_law,
    profile_spectrum,
    rises_text,
    smooth_spectrum,
    spectrum_by_decades,
)

CUTOFFS = (0.8e-3, 0.25e-3, 0.08e-3)
"""Cut-offs of ISO 21920-3, m; the longest that the scan holds is taken."""
SHORT_CUTOFF = 2.5e-6
"""lambda_s that goes with a cut-off of 0.8 mm, m; a coarser instrument takes its own resolution."""
SECTIONS, LINES = 5, 32
NO_FLOOR = 50e-9
"""Rq (m) below which a surface is no floor or sole: the smoothest steel read has 90 nm."""
NO_ROUGHNESS = 300e-6
ROUNDING = 1e-6
"""Relative spread between sections that is rounding of what a file prints, not of a surface."""
UNEVEN = 2.0
"""Rq of all sections over that of the middle one from which few of them carry the roughness."""
QUANTITIES = {
    "ra": ("Ra", "m", "mean deviation"),
    "rq": ("Rq", "m", "root mean square"),
    "rz": ("Rz", "m", "mean peak to valley"),
    "rp": ("Rp", "m", "mean highest peak (Rpm of ISO 4287)"),
    "rt": ("Rt", "m", "highest peak to lowest valley"),
    "rdq": ("Rdq", "1", "rms slope"),
}


@dataclass(frozen=True, slots=True, eq=False)
class Scan(Presentable):
    """Roughness numbers of a scan with their standard errors, and its isotropic spectrum.

    ``values`` by the names of ``QUANTITIES`` (m and 1), over lines along both axes of a map; of a
    map with a lay over lines across it, and Rq over the whole map (Sq).
    ``hurst`` with its standard error and ``roll_off`` (m, None where the spectrum keeps rising) are
    the power law C ~ q^(-2 (1 + H)) through ``spectrum``; ``ends`` (m^4) are its values at the
    longest and the shortest measured wave, from which ``density`` goes on by it.
    """

    kind: ClassVar[str] = "scan"

    name: str
    surface: Profile | HeightMap
    cutoff: float
    values: Mapping[str, SourcedValue]
    spectrum: IsotropicSpectrum
    hurst: SourcedValue
    roll_off: float | None
    ends: tuple[float, float]
    notes: tuple[Message, ...]
    doubts: tuple[Message, ...] = ()
    """What a scan shorter than the usual cut-off lacks, and what looks like no roughness."""
    texture: Texture | None = None
    """Texture of a map behind the cut-off; None of a profile."""
    directions: Directions | None = None
    """Of a map with a lay: how the power of its waves is shared between directions."""

    def __repr__(self) -> str:
        return f"<Scan {self.name}: Rq {self.values['rq']}>"[:199]

    @property
    def waves(self) -> tuple[float, float]:
        """Longest and shortest wave (m) that was measured."""
        low, high = self.spectrum.reliable
        return 2 * math.pi / low, 2 * math.pi / high

    def density(self, wavenumber: ArrayLike) -> Array:
        """Return C(q) (m^4): as measured, beyond it the power law; flat above the roll-off."""
        q = np.asarray(wavenumber, dtype=float)
        known = self.spectrum
        inside = np.exp(
            np.interp(np.log(q), np.log(known.wavenumber), np.log(np.maximum(known.density, 1e-99)))
        )
        low, high = known.reliable
        falling = -2 * (1 + float(self.hurst))
        longer = self.ends[0] * (1.0 if self.roll_off else (q / low) ** falling)
        shorter = self.ends[1] * (q / high) ** falling
        return np.where(q < low, longer, np.where(q > high, shorter, inside))

    def directions_at(self, wavenumber: ArrayLike) -> tuple[Array, Array] | None:
        """Return |cos| of directions from x and the share of C(q) in each, (n, bins); None: alike.

        Of a map with a lay, at wave numbers (rad/m); its x is the direction of sliding.
        """
        return None if self.directions is None else self.directions.at(np.asarray(wavenumber))

    def headline(self) -> tuple[Message, ...]:
        """Return Rq, Ra and the waves behind them."""
        rq, waves = self.values["rq"], [Amount(wave, "m") for wave in self.waves]
        numbers = Message(
            "Rq {rq}, Ra {ra} after a cut-off of {cutoff}; waves from {shortest} to {longest} "
            "were measured.",
            rq=Amount(float(rq), "m"), ra=Amount(float(self.values["ra"]), "m"),
            cutoff=Amount(self.cutoff, "m"), shortest=waves[1], longest=waves[0],
        )  # fmt: skip
        if self.texture is None or not self.texture.has_lay:
            return (numbers,)
        lay = Message(
            "The surface has a lay ({texture}): Ra, Rz, Rt are across it, Rq is of the map.",
            texture=str(self.texture),
        )
        if len(self.texture.lays) > 1:
            lay = Message(
                "The surface has crossed lays ({texture}): Ra, Rz, Rt are of lines at "
                "{angle:.0f}°, between them, Rq is of the map.",
                texture=str(self.texture), angle=math.degrees(self.texture.across),
            )  # fmt: skip
        return numbers, lay

    def cautions(self) -> tuple[Message, ...]:
        """Return why the heights are none of a floor or sole, and which waves they lack."""
        return (*height_cautions(float(self.values["rq"])), *self.doubts)

    def table(self) -> Table:
        """Return the numbers with their standard errors."""

        def value_text(value: SourcedValue) -> str:
            if value.value is None:
                return "not estimated"
            spread = (
                "" if value.uncertainty is None else f" ± {display(value.uncertainty, value.unit)}"
            )
            return display(value.value, value.unit) + spread

        rows = [
            (
                QUANTITIES[name][0],
                value_text(value),
                value.reason if value.value is None else QUANTITIES[name][2],
            )
            for name, value in self.values.items()
        ]
        roll = "none" if self.roll_off is None else display(self.roll_off, "m")
        rows += [
            ("Hurst exponent", value_text(self.hurst), self.hurst.note),
            ("Roll-off", roll, "longer waves carry no more height"),
            ("Longest wave", display(self.waves[0], "m"), "half the scan"),
            ("Shortest wave", display(self.waves[1], "m"), "what instrument and spacing resolve"),
        ]
        if self.texture is not None:
            least = "at most " if self.texture.bounded else ""
            rows.append(
                ("Str", f"{least}{self.texture.ratio:.2g}", "texture aspect ratio: 1 without a lay")
            )
            if self.texture.has_lay:
                lay = "of the grooves from x, the direction of sliding (Std)"
                rows.append(("Lay", self.texture.named_lays, lay))
        return Table("Roughness", ("Quantity", "Value", "Remark"), rows)

    def remarks(self) -> dict[str, Sequence[str]]:
        """Return what the instrument did not see and what was done to the heights."""
        return {"Notes": (*self.notes, *self.surface.processing)}

    def to_dict(self) -> dict[str, Any]:
        """Return the numbers in SI."""
        content = {name: value.value for name, value in self.values.items()}
        errors = {f"{name}_error": value.uncertainty for name, value in self.values.items()}
        return {
            "kind": self.kind,
            "file": self.name,
            **content,
            **errors,
            "hurst": self.hurst.value,
            "hurst_error": self.hurst.uncertainty,
            "roll_off_m": self.roll_off,
            "texture_aspect_ratio": None if self.texture is None else self.texture.ratio,
            "lays_deg": [] if self.texture is None else [*map(math.degrees, self.texture.lays)],
            "cutoff_m": self.cutoff,
            "longest_wave_m": self.waves[0],
            "shortest_wave_m": self.waves[1],
            "notes": [*self.notes, *self.surface.processing],
        }

    def data_tables(self) -> Mapping[str, Table]:
        """Return the spectrum: wavelength, wave number, density."""
        q = self.spectrum.wavenumber
        rows = np.column_stack([2 * np.pi / q, q, self.spectrum.density]).tolist()
        return {"spectrum": Table("", ("wavelength m", "wave number rad/m", "density m^4"), rows)}


def unlikely_height(rq: float) -> Message:
    """Return why an Rq (m) is none of a floor or sole; nothing for a likely one."""
    value = Amount(rq, "m")
    if rq < NO_FLOOR:
        return Message(
            "an Rq of {rq} is no floor and no sole (the smoothest steel floor has 90 nm)", rq=value
        )
    return Message("an Rq of {rq} is no roughness", rq=value) if rq > NO_ROUGHNESS else NOTHING


def height_cautions(rq: float) -> tuple[Message, ...]:
    """Return the question that an unlikely Rq (m) asks; nothing of a likely one."""
    unlikely = unlikely_height(rq)
    if not unlikely:
        return ()
    return (Message("{unlikely}: is the unit of the heights right?", unlikely=unlikely),)


def read_scan(
    path: Path,
    *,
    cutoff: float | None = None,
    strict: bool = False,
    length_unit: str | None = None,
    height_unit: str | None = None,
    spacing: float | None = None,
) -> Scan:
    """Return the roughness of a scan (profile or map) in any format of ``read_surface``.

    Parameters:
        cutoff: Lambda_c, m; None takes the longest of ISO 21920-3, at most 0.8 mm, that the scan
            holds.
        strict: Refuse heights that no floor or sole has, instead of warning.
        length_unit, height_unit, spacing: Where the file does not name them; spacing in m.

    Missing heights and single points that stand ten robust standard deviations out of their
    neighbours (dead pixels) are interpolated, up to 5 % of all.

    Raises:
        DataError: Not readable, too many heights missing, shorter than the cut-off, no heights of a
            floor or sole (``strict``).
    """
    units = {"length_unit": length_unit, "height_unit": height_unit, "spacing": spacing}
    given = {name: value for name, value in units.items() if value is not None}
    surface, flat = without_spikes(read_surface(path, fill_missing=True, **given))
    notes: list[Message] = []
    lines, found, lay, areal = lines_along_axes(surface, LINES), None, None, None
    resolved = shortest_derivable_wavelength(lines[0])
    longest = max(line.length for line in lines)
    chosen, short = _cutoff(longest, resolved.wavelength, cutoff, str(path))
    if isinstance(surface, HeightMap) and isinstance(flat, HeightMap):
        shortest = max(shortest_derivable_wavelength(surface).wavelength, SHORT_CUTOFF)
        found = texture(within_cutoffs(flat, shortest, chosen))
        lay = found if found is not None and found.has_lay else None
        if lay is not None:
            lines = lines_across(surface, lay.across, LINES)
            resolved = shortest_derivable_wavelength(lines[0])
            longest = max(line.length for line in lines)
            chosen, short = _cutoff(longest, resolved.wavelength, cutoff, str(path))
            if holds(min(surface.size), chosen):
                areal = within_cutoffs(flat, shortest, chosen).rms_height
        elif len(set(surface.spacings)) > 1:
            finer = "xy"[int(np.argmin(surface.spacings))]
            notes.append(
                Message(
                    "cells of {sides: by }: numbers are of lines along {finer}, which shows more",
                    sides=[display(side, "m") for side in surface.spacings], finer=finer,
                )
            )  # fmt: skip
    cutoff, lines = chosen, [line for line in lines if holds(line.length, chosen)]
    level = [flat] if isinstance(flat, Profile) else [level_surface(line) for line in lines]
    values, sections, uneven = _numbers(
        lines, level, cutoff, max(SHORT_CUTOFF, resolved.wavelength), lay, surface
    )
    if areal is not None:
        source = Message("ISO 25178-2 (Sq), cut-off {cutoff}", cutoff=display(cutoff, "m"))
        values["rq"] = replace(values["rq"], value=areal, source=source)
    if sections < SECTIONS:
        taken = {"count": sections, "length": Amount(cutoff, "m")}
        notes.append(Message("{count} sections of {length} where a standard takes five", **taken))
    if resolved.wavelength > SHORT_CUTOFF:
        unseen = {"wave": Amount(resolved.wavelength, "m"), "reason": resolved.reason}
        notes.append(Message("waves below {wave} not seen: {reason}", **unseen))
    doubts = tuple(filter(None, [short, uneven, _equal_heights_question(surface)]))
    if doubts:
        said = "; ".join(doubts)
        values = {
            name: replace(value, source=f"{value.source}; {said}", assumed=True)
            for name, value in values.items()
        }
    unlikely = unlikely_height(float(values["rq"]))
    if strict and unlikely:
        raise DataError(
            unlikely,
            where=str(path),
            allowed=Message(
                "{low} to {high}", low=display(NO_FLOOR, "m"), high=display(NO_ROUGHNESS, "m")
            ),
            remedy='Name the unit of the heights (height_unit = "mm"), or write rq yourself',
        )
    even = surface if surface.periodic else flat
    if isinstance(flat, Profile):
        measured = profile_spectrum(flat)
        spectrum = smooth_spectrum(isotropic_from_profile(measured))
    else:
        assert isinstance(even, HeightMap)
        measured = level_spectrum(even)
        spectrum = spectrum_by_decades(measured)
    hurst, roll_off, ends = power_law(measured, spectrum)
    if lay is not None:
        notes.append(
            Message(
                "the spectrum is the mean over directions; hysteresis counts sliding along x of "
                "the map"
            )
        )
    if isinstance(surface, Profile):
        notes.append(
            Message("one direction measured: the spectrum counts as that of every direction")
        )
    if rises := spectrum.levelled_rises:
        notes.append(rises_text(rises))
    return Scan(
        *(Path(path).name, surface, cutoff, values, spectrum, hurst, roll_off, ends),
        *(tuple(notes), doubts, found),
        directions(even, spectrum.wavenumber)
        if lay is not None and isinstance(even, HeightMap)
        else None,
    )


def _cutoff(
    length: float, resolved: float, given: float | None, where: str
) -> tuple[float, Message]:
    """Return the cut-off (m) that lines hold, and what a short scan lacks.

    ``length``: of the longest line (m); ``resolved``: its shortest wave (m).
    """
    if given is not None:
        if not holds(length, given):
            raise DataError(
                Message(
                    "a scan of {length} for a cut-off of {given}",
                    length=display(length, "m"),
                    given=display(given, "m"),
                ),
                where=where,
                allowed=Message(
                    "at most {length}; a standard takes six cut-offs", length=display(length, "m")
                ),
                remedy="Measure a longer part, or leave the cut-off out to take the longest that "
                "fits",
            )
        return given, NOTHING
    fitting = [cutoff for cutoff in CUTOFFS if holds(length, cutoff) and cutoff >= 4 * resolved]
    if not fitting:
        raise DataError(
            Message(
                "a scan of {length} that resolves waves of {resolved} holds no cut-off",
                length=display(length, "m"),
                resolved=display(resolved, "m"),
            ),
            where=where,
            allowed=Message(
                "{cutoffs}: at most the length, at least four of the shortest waves",
                cutoffs=", ".join(display(cutoff, "m") for cutoff in CUTOFFS),
            ),
            remedy="Measure a longer part, or with a smaller spacing",
        )
    if fitting[0] == CUTOFFS[0]:
        return fitting[0], NOTHING
    return fitting[0], Message(
        "shorter than the usual cut-off of {usual}: waves beyond {cutoff} are not in Ra and Rq, "
        "which are too low. Measure 4.8 mm or more",
        usual=Amount(CUTOFFS[0], "m"), cutoff=Amount(fitting[0], "m"),
    )  # fmt: skip


def _numbers(
    lines: Sequence[Profile],
    level: Sequence[Profile],
    cutoff: float,
    short: float,
    lay: Texture | None,
    surface: Profile | HeightMap,
) -> tuple[dict[str, SourcedValue], int, Message]:
    """Return the numbers over all lines, which hold the cut-off, and the sections of a line.

    The last is a doubt, where few sections carry most of the roughness.

    ``level``: the same without their straight line, which those of a periodic surface keep.
    Means of the lines, of Rq and Rdq root mean squares. The standard error is the spread of Rq
    between sections over the root of those that do not overlap: lines within a cut-off of each
    other, or within twice the length of a lay, see the same surface. A spread that is no more than
    rounding is none.
    """
    shortest = min(line.length for line in lines)
    count = int((shortest - 2 * max(line.spacing for line in lines)) / cutoff) - 1
    ends, count = ("drop", min(count, SECTIONS)) if count >= 1 else ("regression", 1)
    short_cutoff = short if short < cutoff / 4 else None
    read = [
        level_roughness(
            line if line.periodic else flat, cutoff, short_cutoff, sections=count, ends=ends
        )
        for line, flat in zip(lines, level, strict=True)
    ]
    pieces = []
    for line in level:
        rough = short_waves(line, cutoff, ends).heights
        size = round(cutoff / line.spacing)
        start = (rough.size - count * size) // 2  # of the sections that the numbers are of
        pieces += [np.std(rough[start + n * size : start + (n + 1) * size]) for n in range(count)]
    beside, alike = shortest, cutoff
    if lay is not None and isinstance(surface, HeightMap):
        along = math.sin(lay.across), math.cos(lay.across)
        beside = min(s / max(abs(c), 1e-9) for s, c in zip(surface.size, along, strict=True))
        alike = max(cutoff, 2 * lay.length) if not lay.bounded else math.inf
    apart = max(1, round(beside / alike)) if len(lines) > 1 else 1
    independent = min(len(pieces), count * apart)
    mean = float(np.mean(pieces))
    spread = float(np.std(pieces, ddof=1)) / mean if len(pieces) > 1 and mean > 0 else None
    if spread is not None and spread < ROUNDING:
        spread = None
    source = Message(
        "{standards}, cut-off {cutoff}, {count} sections",
        standards=STANDARDS[0],
        cutoff=display(cutoff, "m"),
        count=count,
    )
    values = {}
    for name, (_, unit, _) in QUANTITIES.items():
        found = [getattr(roughness, name) for roughness in read]
        if any(value is None for value in found):
            values[name] = SourcedValue(None, unit, reason=read[0].not_estimated[name])
            continue
        power = 2 if name in ("rq", "rdq") else 1
        mean = float(np.mean(np.power(found, power)) ** (1 / power))
        error = None if spread is None else mean * spread / math.sqrt(independent)
        values[name] = SourcedValue(mean, unit, source=source, uncertainty=error)
    return values, count, _uneven(np.array(pieces))


def _uneven(sections: np.ndarray) -> Message:
    """Return what sections that carry most of the roughness ask; nothing of ones that are alike.

    ``sections``: Rq of each, (n,), m. A joint, an edge or a scratch makes one far rougher than the
    others; of sections of one surface the root mean square stays near the median.
    """
    usual, whole = float(np.median(sections)), float(np.sqrt(np.mean(sections**2)))
    if len(sections) < 3 or whole <= UNEVEN * usual:
        return NOTHING
    return Message(
        "few sections carry the roughness: Rq of the roughest is {roughest}, of the middle one "
        "{middle}. A joint, an edge or damage? Cut it off, or measure beside it",
        roughest=Amount(float(sections.max()), "m"), middle=Amount(usual, "m"),
    )  # fmt: skip


def _equal_heights_question(surface: Profile | HeightMap) -> Message:
    """Return what many equal heights ask; nothing where no number stands out."""
    share, height = held_level(surface.heights)
    if not share:
        return NOTHING
    return Message(
        "{share} of the heights are one number, {height}: missing ones, or the end of the range? "
        "Leave them empty in the file, or measure again",
        share=percent(share), height=Amount(height, "m"),
    )  # fmt: skip
