"""Surface and rubber of ``underfoot contact`` from its options."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from underfoot.surface import HeightMap


@dataclass(frozen=True, slots=True)
class SurfaceChoice:
    """The options that describe the floor's surface; lengths as text with units."""

    file: Path | None = None
    rms: str | None = None
    hurst: float = 0.8
    longest: str | None = None
    shortest: str | None = None
    checkerboard: tuple[str, str] | None = None
    points: int = 256
    seed: int = 0


@dataclass(frozen=True, slots=True)
class RubberChoice:
    """The options that describe the rubber; exactly one is given."""

    modulus: str | None = None
    shore: float | None = None
    spectrum: Path | None = None
    material: str | None = None


def surface_from(choice: SurfaceChoice) -> HeightMap:
    """Return the periodic height map; InputError unless exactly one kind of surface is given."""
    from underfoot.core import InputError

    given = {
        "a file": choice.file is not None,
        "--rms": choice.rms is not None,
        "--checkerboard": choice.checkerboard is not None,
    }
    if sum(given.values()) != 1:
        named = [name for name, there in given.items() if there]
        raise InputError(
            "no surface" if not named else f"{' and '.join(named)} together",
            where="underfoot contact",
            allowed='one of: FILE, --rms "5 um", --checkerboard "24.3 um" "0.4 mm"',
        )
    if not 8 <= choice.points <= 8192:
        raise InputError(f"{choice.points}", where="--points", allowed="8 to 8192 a side")
    if choice.file is not None:
        return _measured(choice)
    if choice.checkerboard is not None:
        return _checkerboard(choice, *choice.checkerboard)
    return _random(choice)


def rubber_from(choice: RubberChoice) -> tuple[Any, str, list[str]]:
    """Return (modulus for ``steady_sliding``, its description, what is assumed about it)."""
    from underfoot.core import InputError, to_si

    given = [name for name in choice.__slots__ if getattr(choice, name) is not None]
    if len(given) != 1:
        raise InputError(
            "no rubber" if not given else "--" + " and --".join(given) + " together",
            where="underfoot contact",
            allowed='one of: --modulus "5 MPa", --shore 60, --spectrum FILE, --material NAME',
        )
    if choice.modulus is not None:
        young = to_si(choice.modulus, "Pa", where="--modulus")
        return young, f"elastic, Young's modulus {choice.modulus}", []
    if choice.shore is not None:
        from underfoot.material import gent_breaches, youngs_modulus_gent

        young = float(youngs_modulus_gent(choice.shore))
        notes = [str(breach) for breach in gent_breaches(choice.shore)]
        notes.append("Young's modulus from hardness (Gent 1958): static, tens of percent uncertain")
        return young, f"elastic, Shore A {choice.shore:g}: {young * 1e-6:.3g} MPa", notes
    if choice.material is not None:
        from underfoot.material import report_elastomer

        rubber = report_elastomer(choice.material)
        return rubber.spectrum, f"{rubber.name}, {rubber.source}", []
    assert choice.spectrum is not None
    return _spectrum(choice.spectrum)


def _spectrum(path: Path) -> tuple[Any, str, list[str]]:
    """Return a Prony series, or the spectrum fitted to one dynamic sweep."""
    from underfoot.core import DataError
    from underfoot.material import fit_dynamic, read_dynamic, read_prony

    try:
        return read_prony(path), f"Prony series of {path.name}", []
    except DataError as first:
        try:
            sweeps = read_dynamic(path)
        except DataError as second:
            raise DataError(
                f"{path} is neither a Prony series ({first.what}) nor a dynamic sweep "
                f"({second.what})",
                where="--spectrum",
                allowed="TOML or CSV with tau and E_i; CSV with frequency, E' and E''",
            ) from second
    if len(sweeps) > 1:
        raise DataError(
            f"{path} holds sweeps at {len(sweeps)} temperatures",
            where="--spectrum",
            allowed="one temperature",
            remedy="Make a master curve first (underfoot.material.dynamic_master_curve)",
        )
    sweep = sweeps[0]
    fit = fit_dynamic(sweep.angular_frequency, sweep.storage_modulus, sweep.loss_modulus)
    low, high = fit.frequency_range
    note = f"spectrum fitted to {low:.3g} to {high:.3g} rad/s, {100 * fit.rms_residual:.2g} % rms"
    return fit.spectrum, f"dynamic sweep of {path.name}", [note]


def _random(choice: SurfaceChoice) -> HeightMap:
    from underfoot.core import to_si
    from underfoot.surface import self_affine

    rms = to_si(choice.rms, "m", where="--rms")
    longest = to_si(choice.longest or "0.5 mm", "m", where="--longest")
    side = 2.0 * longest
    spacing = side / choice.points
    if choice.shortest is None:
        shortest = 8.0 * spacing
    else:
        shortest = to_si(choice.shortest, "m", where="--shortest")
    return self_affine(choice.points, spacing, rms, choice.hurst, longest, shortest, choice.seed)


def _checkerboard(choice: SurfaceChoice, height: str, wavelength: str) -> HeightMap:
    from underfoot.core import to_si
    from underfoot.surface import checkerboard

    rz = to_si(height, "m", where="--checkerboard")
    wave = to_si(wavelength, "m", where="--checkerboard")
    return checkerboard(choice.points, wave / choice.points, rz, wave)


def _measured(choice: SurfaceChoice) -> HeightMap:
    from underfoot.surface import Profile, read_surface

    assert choice.file is not None
    surface = read_surface(choice.file)
    if isinstance(surface, Profile):
        return _from_profile(surface, choice)
    return surface if surface.periodic else mirrored(surface)


def _from_profile(profile: Any, choice: SurfaceChoice) -> HeightMap:
    """Return an isotropic random surface with the spectrum of a measured profile.

    Two longest reliable waves make a side; without --shortest, eight grid points make the
    shortest wave. What is left out is said.
    """
    from dataclasses import replace

    import numpy as np

    from underfoot.core import display, to_si
    from underfoot.surface import (
        isotropic_from_profile,
        levelled,
        profile_spectrum,
        surface_from_spectrum,
    )

    flat = levelled(profile)
    spectrum = isotropic_from_profile(profile_spectrum(flat))
    low, high = spectrum.reliable
    if choice.longest is not None:
        low = max(low, 2.0 * np.pi / to_si(choice.longest, "m", where="--longest"))
    spacing = 4.0 * np.pi / low / choice.points
    wanted = 8.0 * spacing
    if choice.shortest is not None:
        wanted = to_si(choice.shortest, "m", where="--shortest")
    part = spectrum.within(low, min(high, 2.0 * np.pi / wanted))
    surface = surface_from_spectrum(part, choice.points, spacing, choice.seed)
    note = (
        f"the levelled profile has an rms height of {display(float(np.std(flat.heights)), 'm')}, "
        f"this surface {display(surface.rms_height, 'm')}: it keeps waves from "
        f"{display(2.0 * np.pi / part.reliable[1], 'm')} to {display(2.0 * np.pi / low, 'm')}"
    )
    return replace(surface, processing=(*surface.processing, note))


def mirrored(surface: HeightMap) -> HeightMap:
    """Return the levelled map with its mirror images beside it: periodic, nothing invented."""
    import numpy as np

    from underfoot.surface import HeightMap, levelled

    flat = levelled(surface)
    row = np.concatenate([flat.heights, flat.heights[::-1]], axis=0)
    return HeightMap(
        np.concatenate([row, row[:, ::-1]], axis=1),
        flat.spacing,
        periodic=True,
        resolution=flat.resolution,
        source=flat.source,
        processing=(
            *flat.processing,
            "mirrored along both axes to close its edges: four times the area, and what differs "
            "between sliding forwards and backwards is averaged out",
        ),
    )
