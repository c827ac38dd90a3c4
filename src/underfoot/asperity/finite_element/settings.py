"""How the explicit finite elements march: numbers that change cost and error, not the physics."""

from __future__ import annotations

import math
from dataclasses import dataclass

from underfoot.core import InputError, unknown_name

MASS_SCALING_FACTOR = 5.0
"""Relative error of area over force per (speed / shear wave speed)^2; measured, see the page."""
MASS_SCALING_ALLOWED = 0.01
IMPACT_ALLOWED = 1e-4
"""Friction that the meeting of lower nodes and floor may add, over normal force."""
LARGEST_MASS_SCALING = 1000.0


@dataclass(frozen=True, slots=True)
class ExplicitSettings:
    """Settings of ``explicit_sliding``.

    Parameters
    ----------
    cfl
        Time step over the critical one of the undeformed mesh; None: 0.6 (squeezed elements ask for
        less than 0.7), or 0.4 with a viscous form, which lowers the critical step.
    time_step
        s; None takes ``cfl``.
    hourglass
        "stiffness" (elastic, from a potential) or "viscous" (Flanagan and Belytschko 1981, what
        explicit codes do by default: it makes friction of its own).
    hourglass_coefficient
        None: 2 (about the stiffness of eight-point integration), or 0.1 for the viscous form.
    hourglass_modulus
        Pa; None: G'(omega) at the frequency of the floor's asperities passing.
    penalty_factor
        Contact stiffness in units of (K + 4 G / 3) / bottom layer. None: the larger of 0.5 and
        what sinks by 0.3 % of the roughness under the mean pressure, at most 1.5. A bulk modulus
        lowered for speed would soften the contact with it.
    penalty_stiffness
        Pa/m, in place of ``penalty_factor``.
    contact_damping
        Share of critical damping at the contact nodes, only while they press. Without it nodes
        chatter as they meet the floor, and 2 % of the real contact area is lost; it takes no
        energy to speak of (the ledger has it).
    bulk_viscosity
        Linear coefficient, in compression only (0.06 in common codes; makes friction of its own).
    mass_scaling
        Factor on the density; "auto" takes the largest one (up to 1000) with an error bound of 1 %
        on area over force and of 1e-4 on the COF (``impact_friction``).
    precision
        "double" or "single" (element arithmetic and history only).
    samples_per_wavelength
        Of the history; every value is the mean of all steps since the last.
    """

    cfl: float | None = None
    time_step: float | None = None
    hourglass: str = "stiffness"
    hourglass_coefficient: float | None = None
    hourglass_modulus: float | None = None
    penalty_factor: float | None = None
    penalty_stiffness: float | None = None
    contact_damping: float = 0.3
    bulk_viscosity: float = 0.0
    mass_scaling: float | str = 1.0
    precision: str = "double"
    samples_per_wavelength: int = 200

    def __post_init__(self) -> None:
        if self.hourglass not in ("stiffness", "viscous"):
            raise unknown_name(
                "hourglass form", self.hourglass, ("stiffness", "viscous"), where="hourglass"
            )
        if self.precision not in ("double", "single"):
            raise unknown_name("precision", self.precision, ("double", "single"), where="precision")
        if self.cfl is not None and not 0.0 < self.cfl < 1.0:
            raise InputError(f"{self.cfl:g}", where="cfl", allowed="0 to 1; 0.6 is sound")
        if isinstance(self.mass_scaling, str):
            if self.mass_scaling != "auto":
                raise InputError(
                    f'"{self.mass_scaling}"', where="mass_scaling", allowed='a factor or "auto"'
                )
        elif not (math.isfinite(self.mass_scaling) and self.mass_scaling >= 1.0):
            raise InputError(
                f"{self.mass_scaling:g}", where="mass_scaling", allowed="1 or more, or auto"
            )
        for name in (
            "time_step",
            "hourglass_coefficient",
            "hourglass_modulus",
            "penalty_factor",
            "penalty_stiffness",
        ):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{value:g}", where=name, allowed="above 0")
        for name in ("contact_damping", "bulk_viscosity"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(f"{value:g}", where=name, allowed="0 or more")
        if self.samples_per_wavelength < 20:
            raise InputError(
                f"{self.samples_per_wavelength}",
                where="samples_per_wavelength",
                allowed="20 or more",
            )

    @property
    def viscous(self) -> bool:
        """True when hourglass control or bulk viscosity takes energy."""
        return self.hourglass == "viscous" or self.bulk_viscosity > 0.0


def mass_scaling_error(speed: float, shear_wave_speed: float, factor: float) -> float:
    """Return the bound on the relative error of area over force, 5 factor (v / c_s)^2."""
    return MASS_SCALING_FACTOR * factor * (speed / shear_wave_speed) ** 2


def impact_friction(
    speed: float, density: float, layer: float, square_slope: float, pressure: float, length: float
) -> float:
    """Return a bound on the COF that scaled inertia adds: rho h (v s)^2 / (p w).

    Every wavelength w each lower node meets the floor once, with the floor's slope s times the
    speed; what it and the lowest layer (thickness h) then have of kinetic energy goes to waves in
    the block, which nothing brings back. ``square_slope`` is the mean of s^2 times 4 (the square of
    the largest slope of a checkerboard), ``pressure`` the mean one. SI units, result without.
    Measured in loss-free neolite: 0.07 to 0.6 of the bound, see the page.
    """
    return density * layer * square_slope * speed**2 / (pressure * length)


def largest_mass_scaling(speed: float, shear_wave_speed: float, impact: float = 0.0) -> float:
    """Return the largest factor within both bounds, at least 1 and at most 1000.

    1 % on area over force, and 1e-4 on the COF; ``impact`` is ``impact_friction`` unscaled.
    """
    error = mass_scaling_error(speed, shear_wave_speed, 1.0)
    allowed = [LARGEST_MASS_SCALING]
    allowed += [MASS_SCALING_ALLOWED / error] if error > 0.0 else []
    allowed += [IMPACT_ALLOWED / impact] if impact > 0.0 else []
    return max(min(allowed), 1.0)
