"""What the block models take and give back, shared by every solver of the block."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from underfoot.core import Breach, InputError, Status
from underfoot.material import Elastomer, RelaxationSpectrum, bulk_modulus, shear_from_young

from .surface import MicroSurface

RUBBER_DENSITY = 1150.0
"""kg/m^3, of a filled rubber compound; assumed, the report prints none."""


@dataclass(frozen=True, slots=True, eq=False)
class MicroMaterial:
    """Nearly incompressible rubber: G(t) = G_inf + sum G_i exp(-t / tau_i) (Eq. 7), constant K.

    Parameters
    ----------
    shear
        Spectrum of the shear modulus, Pa, any number of terms.
    bulk_modulus
        K, Pa.
    density
        kg/m^3.
    name, source
        Words.

    Errors
    ------
    InputError
        K not above two thirds of G(0) (Poisson's ratio not positive), infinite (Poisson's ratio
        of 0.5), or density not positive.
    """

    shear: RelaxationSpectrum
    bulk_modulus: float
    density: float = RUBBER_DENSITY
    name: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        g0 = self.shear.instantaneous_modulus
        if not math.isfinite(self.bulk_modulus):
            raise InputError(
                f"bulk modulus {self.bulk_modulus:g} Pa: no stable step exists",
                where="MicroMaterial.bulk_modulus",
                allowed="a finite modulus",
                remedy="Choose Poisson's ratio 0.499 or less",
            )
        if not self.bulk_modulus > 2.0 / 3.0 * g0:
            raise InputError(
                f"bulk modulus {self.bulk_modulus:g} Pa with G(0) = {g0:g} Pa",
                where="MicroMaterial.bulk_modulus",
                allowed="above 2/3 of G(0), so that Poisson's ratio is positive",
            )
        if not (math.isfinite(self.density) and self.density > 0.0):
            raise InputError(
                f"density {self.density:g} kg/m^3", where="MicroMaterial.density", allowed="above 0"
            )

    @classmethod
    def from_poisson(
        cls,
        shear: RelaxationSpectrum,
        poisson_ratio: float,
        *,
        density: float = RUBBER_DENSITY,
        at: str = "equilibrium",
        name: str = "",
    ) -> MicroMaterial:
        """Return the material with K = 2 G (1 + nu) / (3 (1 - 2 nu)).

        ``at``: "equilibrium" takes G_inf (Table 2's rule: exact for neolite), "instantaneous"
        takes G(0).
        """
        if at not in ("equilibrium", "instantaneous"):
            raise InputError(f'"{at}"', where="at", allowed='"equilibrium" or "instantaneous"')
        if not 0.0 < poisson_ratio < 0.5:
            raise InputError(
                f"Poisson's ratio {poisson_ratio:g}",
                where="poisson_ratio",
                allowed="0 to 0.5, both excluded",
                remedy="Choose 0.499 for rubber: at 0.5 the bulk modulus is infinite",
            )
        g = shear.equilibrium_modulus if at == "equilibrium" else shear.instantaneous_modulus
        if not g > 0.0:
            raise InputError(
                "the equilibrium shear modulus is zero",
                where="shear",
                remedy='Use at="instantaneous"',
            )
        young = 2.0 * g * (1.0 + poisson_ratio)
        k = float(bulk_modulus(young, poisson_ratio))
        return cls(shear, k, density, name, shear.source)

    @classmethod
    def from_elastomer(
        cls, elastomer: Elastomer, *, at: str = "equilibrium", elastic: bool = False
    ) -> MicroMaterial:
        """Return the material of an ``Elastomer`` (Young's spectrum and Poisson's ratio).

        Errors
        ------
        InputError
            Poisson's ratio of 0.5, or an elastomer without relaxation data unless ``elastic``.
        """
        spectrum = elastomer.modulus
        if not isinstance(spectrum, RelaxationSpectrum):
            if not elastic:
                raise InputError(
                    f"no relaxation data: {elastomer.name or 'the material'} has one modulus only",
                    where="elastomer",
                    remedy="Fit a spectrum with underfoot.material.fit_dynamic or fit_relaxation, "
                    "or ask for elastic=True: then there is no hysteresis",
                )
            spectrum = elastomer.spectrum
        shear = shear_from_young(spectrum, elastomer.poisson_ratio)
        density = RUBBER_DENSITY if elastomer.density is None else elastomer.density
        return cls.from_poisson(
            shear, elastomer.poisson_ratio, density=density, at=at, name=elastomer.name
        )

    @property
    def poisson_ratio(self) -> float:
        """Poisson's ratio of the fast response, from K and G(0)."""
        k, g = self.bulk_modulus, self.shear.instantaneous_modulus
        return (3.0 * k - 2.0 * g) / (2.0 * (3.0 * k + g))

    @property
    def wave_speeds(self) -> tuple[float, float]:
        """Compression and shear wave speed of the fast response, m/s."""
        g = self.shear.instantaneous_modulus
        return (
            math.sqrt((self.bulk_modulus + 4.0 / 3.0 * g) / self.density),
            math.sqrt(g / self.density),
        )


@dataclass(frozen=True, slots=True, eq=False)
class MicroBlock:
    """A rubber block over a rough rigid floor, with its structured mesh of hexahedra.

    Parameters
    ----------
    size
        m, along x (sliding), y and z.
    elements
        Number along x, y and z.
    bottom_layer
        m, thickness of the lowest layer; each layer above is thicker by one ratio. None: all alike.
    roughness
        Of the block's lower face, positive downwards, out of the rubber.
    roughness_layers
        Number of layers over which the displacement of the lower face's nodes fades out linearly.
    sides
        "free" or "periodic" (x and y).
    """

    size: tuple[float, float, float] = (0.8e-3, 0.5e-3, 0.5e-3)
    elements: tuple[int, int, int] = (26, 16, 9)
    bottom_layer: float | None = 31.25e-6
    roughness: MicroSurface = field(default_factory=MicroSurface)
    roughness_layers: int = 4
    sides: str = "free"

    def __post_init__(self) -> None:
        if len(self.size) != 3 or not all(math.isfinite(s) and s > 0.0 for s in self.size):
            raise InputError(
                f"size {self.size}", where="MicroBlock.size", allowed="three lengths > 0"
            )
        if len(self.elements) != 3 or min(self.elements) < 1:
            raise InputError(
                f"elements {self.elements}",
                where="MicroBlock.elements",
                allowed="three counts >= 1",
            )
        if self.sides not in ("free", "periodic"):
            raise InputError(
                f'sides "{self.sides}"', where="MicroBlock.sides", allowed='"free" or "periodic"'
            )
        if self.bottom_layer is not None and not 0.0 < self.bottom_layer < self.size[2]:
            raise InputError(
                f"bottom layer of {self.bottom_layer:g} m",
                where="MicroBlock.bottom_layer",
                allowed=f"above 0 and below the height {self.size[2]:g} m",
            )
        if not 1 <= self.roughness_layers <= self.elements[2]:
            raise InputError(
                f"{self.roughness_layers} layers",
                where="MicroBlock.roughness_layers",
                allowed=f"1 to {self.elements[2]}, the layers there are",
            )

    @property
    def nominal_area(self) -> float:
        """Lower face, seen from above, m^2."""
        return self.size[0] * self.size[1]


@dataclass(frozen=True, slots=True)
class MicroLoading:
    """Press, hold, slide.

    Parameters
    ----------
    mean_pressure
        Pa, over the nominal area.
    speed
        m/s, of the block towards +x over the floor at rest.
    slide_distance
        m.
    control
        "displacement": the height reached under the load is kept while sliding (grant report);
        "load": the load stays on.
    press_time, hold_time, ramp_time
        s: to reach the load, to settle, to reach the speed.
    """

    mean_pressure: float = 160e3
    speed: float = 0.1
    slide_distance: float = 0.8e-3
    control: str = "displacement"
    press_time: float = 1.0e-3
    hold_time: float = 0.3e-3
    ramp_time: float = 0.1e-3

    def __post_init__(self) -> None:
        for name in ("mean_pressure", "press_time"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{value:g}", where=f"MicroLoading.{name}", allowed="above 0")
        for name in ("speed", "slide_distance", "hold_time", "ramp_time"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise InputError(f"{value:g}", where=f"MicroLoading.{name}", allowed="0 or more")
        if self.control not in ("displacement", "load"):
            raise InputError(
                f'control "{self.control}"',
                where="MicroLoading.control",
                allowed='"displacement" or "load"',
            )


@dataclass(frozen=True, slots=True, eq=False)
class EnergyLedger:
    """Energies of the block in J against ``time`` (n,); in the frame of the block's top.

    ``residual`` is what came in less what is stored, moving or lost: the error of the march, and
    with relaxation terms that of ``strain`` and ``material_loss``, which hold for small strains.

    Parameters
    ----------
    time
        s.
    floor_work
        Done by the floor passing underneath: friction force times distance.
    top_work
        Done by the load on the top.
    kinetic, strain, hourglass, contact
        In motion and stored.
    material_loss, hourglass_loss, contact_loss, damping_loss
        Lost in the rubber, in viscous hourglass control with bulk viscosity, in contact damping, in
        the body damping of pressing.
    """

    time: np.ndarray
    floor_work: np.ndarray
    top_work: np.ndarray
    kinetic: np.ndarray
    strain: np.ndarray
    hourglass: np.ndarray
    contact: np.ndarray
    material_loss: np.ndarray
    hourglass_loss: np.ndarray
    contact_loss: np.ndarray
    damping_loss: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """Work done less everything stored, moving and lost, J."""
        kept = self.kinetic + self.strain + self.hourglass + self.contact
        lost = self.material_loss + self.hourglass_loss + self.contact_loss + self.damping_loss
        return self.floor_work + self.top_work - kept - lost


@dataclass(frozen=True, slots=True)
class MicroAverages:
    """Means over whole floor wavelengths of sliding, the first left out (Eq. 8 to 12).

    Parameters
    ----------
    cof_hysteresis
        Signed mean shear over mean normal force (Eq. 8): friction.
    cof_absolute, cof_resultant
        The same with the mean of |shear|, and of the resultant of shear and lateral force: not
        friction, but what unsigned averages give.
    area_per_force
        A_c / F_N, m^2/N (Eq. 12), with the cells of all nodes in contact, as finite elements do.
    real_contact_fraction
        A_c over the nominal area.
    mean_pressure
        Pa, over the nominal area.
    wavelengths
        How many were averaged.
    scatter
        Largest difference of one wavelength's signed COF from their mean (NaN with only one).
    area_per_force_corrected, real_contact_fraction_corrected
        The same area less what the edges of contact spots count too much (``edge_excess_area``):
        the better estimate. NaN where the edges are more than half of it: spots of a node or two.
    """

    cof_hysteresis: float
    cof_absolute: float
    cof_resultant: float
    area_per_force: float
    real_contact_fraction: float
    mean_pressure: float
    wavelengths: int
    scatter: float
    area_per_force_corrected: float
    real_contact_fraction_corrected: float


@dataclass(frozen=True, slots=True, eq=False)
class MicroResult:
    """History of pressing and sliding a block; arrays of one value per sample.

    Parameters
    ----------
    time, distance
        s since the start of pressing; m of sliding (0 while pressing).
    normal_force, shear_force, lateral_force
        N at the rough interface: on the block, upwards; against sliding (-x); along y.
    real_contact_area
        m^2: cells of the nodes in contact.
    corrected_contact_area
        m^2: the same less its edges (``edge_excess_area``).
    height
        m, displacement of the block's top.
    nominal_area
        m^2.
    averages
        None when no whole wavelength was slid.
    energy
        None where the solver keeps no energies.
    status, notes, breaches
        How it ended.
    steps, time_step, process_seconds
        Count, s, s.
    """

    time: np.ndarray
    distance: np.ndarray
    normal_force: np.ndarray
    shear_force: np.ndarray
    lateral_force: np.ndarray
    real_contact_area: np.ndarray
    corrected_contact_area: np.ndarray
    height: np.ndarray
    nominal_area: float
    averages: MicroAverages | None
    energy: EnergyLedger | None
    status: Status
    notes: tuple[str, ...] = ()
    breaches: tuple[Breach, ...] = ()
    steps: int = 0
    time_step: float = 0.0
    process_seconds: float = 0.0
