"""A rough rubber block over a rough rigid floor: faces, material, block, loading."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import spline_filter

from underfoot.core import InputError
from underfoot.core.checks import choice, not_negative, positive
from underfoot.core.remark import Message
from underfoot.material import Elastomer, RelaxationSpectrum, bulk_modulus, shear_from_young
from underfoot.surface import HeightMap

from ._kernels.floor import floor_at_points

FORMS = ("flat", "cosine", "triangular", "wave", "paraboloid", "map")


@dataclass(frozen=True, slots=True, eq=False)
class MicroSurface:
    """Heights h(x, y) above the mean line, positive out of the body; periodic except "paraboloid".

    Parameters:
        form: "flat"; "cosine", the checkerboard (R_z / 2) cos(2 pi x / w) cos(2 pi y / w);
            "triangular", the same with straight flanks (nodes raised and lowered by turns); "wave",
            along x only; "paraboloid", -(x^2 + y^2) / (2 radius), to indent with; "map", a measured
            or generated height map (cubic B-spline through its points).
        peak_to_valley: R_z, m.
        wavelength: w, m.
        offset: m, (x, y): where the pattern's origin lies.
        radius: m, of the paraboloid's tip.
        height_map: Of the form "map"; periodic.

    Raises:
        InputError: Another form, lengths not positive, a map that is missing or not periodic.
    """

    form: str = "flat"
    peak_to_valley: float = 0.0
    wavelength: float = 1.0e-3
    offset: tuple[float, float] = (0.0, 0.0)
    radius: float = math.inf
    height_map: HeightMap | None = None

    def __post_init__(self) -> None:
        choice(self.form, FORMS, "MicroSurface.form")
        not_negative(self.peak_to_valley, "MicroSurface.peak_to_valley", "m")
        for name, value in (("wavelength", self.wavelength), ("radius", self.radius)):
            if not value > 0.0:
                raise InputError(
                    f"{name} {value:g} m", where=f"MicroSurface.{name}", allowed="above 0 m"
                )
        if self.form == "map":
            if self.height_map is None:
                raise InputError("no height map", where="MicroSurface.height_map")
            if not self.height_map.periodic:
                raise InputError(
                    "the height map is not periodic",
                    where="MicroSurface.height_map",
                    remedy="Make it periodic with underfoot.surface.make_periodic",
                )

    @classmethod
    def checkerboard(
        cls,
        peak_to_valley: float,
        wavelength: float,
        *,
        form: str = "cosine",
        offset: tuple[float, float] = (0.0, 0.0),
    ) -> MicroSurface:
        """Return peaks and valleys by turns along x and y (grant report G.1.1, Fig. 2)."""
        return cls(form, peak_to_valley, wavelength, offset)

    @classmethod
    def of_map(cls, height_map: HeightMap, *, offset: tuple[float, float] = (0, 0)) -> MicroSurface:
        """Return the surface of a periodic height map, its mean taken off."""
        heights = height_map.heights
        return cls(
            "map", float(np.ptp(heights)), min(height_map.size), offset, math.inf, height_map
        )

    @property
    def rough(self) -> bool:
        """True when the heights are not all the same."""
        return self.form == "paraboloid" or (self.form != "flat" and self.peak_to_valley > 0.0)

    def height(self, x: ArrayLike, y: ArrayLike) -> Any:
        """Return h, m, at points of any shape."""
        return self.height_and_slope(x, y)[0]

    def height_and_slope(self, x: ArrayLike, y: ArrayLike) -> tuple[Any, Any, Any]:
        """Return h (m), dh/dx and dh/dy at points of any shape."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        shape = x.shape
        h, hx, hy = floor_at_points(x.ravel(), y.ravel(), *self.kernel_arrays())
        return h.reshape(shape), hx.reshape(shape), hy.reshape(shape)

    def kernel_arrays(self) -> tuple[int, np.ndarray, np.ndarray]:
        """Return form number, numbers and spline coefficients as the kernels take them."""
        coefficients = np.zeros((1, 1))
        steps = (1.0, 1.0)
        if self.form == "map":
            assert self.height_map is not None
            heights = self.height_map.heights
            coefficients = np.ascontiguousarray(
                spline_filter(heights - heights.mean(), order=3, mode="grid-wrap")
            )
            steps = self.height_map.spacings
        rate = 0.0 if math.isinf(self.radius) else 1.0 / self.radius
        numbers = np.array(
            [0.5 * self.peak_to_valley, 1.0 / self.wavelength, *self.offset, rate, *steps]
        )
        return FORMS.index(self.form), numbers, coefficients


RUBBER_DENSITY = 1150.0
"""kg/m^3, of a filled rubber compound; assumed, the report prints none."""


@dataclass(frozen=True, slots=True, eq=False)
class MicroMaterial:
    """Nearly incompressible rubber: G(t) = G_inf + sum G_i exp(-t / tau_i) (Eq. 7), constant K.

    Parameters:
        shear: Spectrum of the shear modulus, Pa, any number of terms.
        bulk_modulus: K, Pa.
        density: kg/m^3.
        name, source: Words.

    Raises:
        InputError: K not above two thirds of G(0) (Poisson's ratio not positive), infinite
            (Poisson's ratio of 0.5), or density not positive.
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
        positive(self.density, "MicroMaterial.density", "kg/m^3")

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
        choice(at, ("equilibrium", "instantaneous"), "at")
        if not 0.0 < poisson_ratio < 0.5:
            raise InputError(
                Message("Poisson's ratio {poisson_ratio:g}", poisson_ratio=poisson_ratio),
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

        Raises:
            InputError: Poisson's ratio of 0.5, or an elastomer without relaxation data unless
                ``elastic``.
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

    Parameters:
        size: m, along x (sliding), y and z.
        elements: Number along x, y and z.
        bottom_layer: m, thickness of the lowest layer; each layer above is thicker by one ratio.
            None: all alike.
        roughness: Of the block's lower face, positive downwards, out of the rubber.
        roughness_layers: Number of layers over which the displacement of the lower face's nodes
            fades out linearly.
        sides: "free" or "periodic" (x and y).
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
        choice(self.sides, ("free", "periodic"), "MicroBlock.sides")
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

    Parameters:
        mean_pressure: Pa, over the nominal area.
        speed: m/s, of the block towards +x over the floor at rest.
        slide_distance: m.
        control: "displacement": the height reached under the load is kept while sliding (grant
            report); "load": the load stays on.
        press_time, hold_time, ramp_time: s: to reach the load, to settle, to reach the speed.
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
            positive(getattr(self, name), f"MicroLoading.{name}")
        for name in ("speed", "slide_distance", "hold_time", "ramp_time"):
            not_negative(getattr(self, name), f"MicroLoading.{name}")
        choice(self.control, ("displacement", "load"), "MicroLoading.control")
