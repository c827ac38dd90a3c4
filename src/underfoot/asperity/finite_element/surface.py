"""The rough face of a block or a floor: height and slope at any point."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, unknown_name
from underfoot.surface import HeightMap

FORMS = ("flat", "cosine", "triangular", "wave", "paraboloid", "map")


@dataclass(frozen=True, slots=True, eq=False)
class MicroSurface:
    """Heights h(x, y) above the mean line, positive out of the body; periodic except "paraboloid".

    Parameters
    ----------
    form
        "flat"; "cosine", the checkerboard (R_z / 2) cos(2 pi x / w) cos(2 pi y / w); "triangular",
        the same with straight flanks (nodes raised and lowered by turns); "wave", along x only;
        "paraboloid", -(x^2 + y^2) / (2 radius), to indent with; "map", a measured or generated
        height map (cubic B-spline through its points).
    peak_to_valley
        R_z, m.
    wavelength
        w, m.
    offset
        m, (x, y): where the pattern's origin lies.
    radius
        m, of the paraboloid's tip.
    height_map
        Of the form "map"; periodic.

    Errors
    ------
    InputError
        Another form, lengths not positive, a map that is missing or not periodic.
    """

    form: str = "flat"
    peak_to_valley: float = 0.0
    wavelength: float = 1.0e-3
    offset: tuple[float, float] = (0.0, 0.0)
    radius: float = math.inf
    height_map: HeightMap | None = None

    def __post_init__(self) -> None:
        if self.form not in FORMS:
            raise unknown_name("surface form", self.form, FORMS, where="MicroSurface.form")
        if not (math.isfinite(self.peak_to_valley) and self.peak_to_valley >= 0.0):
            raise InputError(
                f"peak-to-valley height {self.peak_to_valley:g} m",
                where="MicroSurface.peak_to_valley",
                allowed="a finite height of 0 m or more",
            )
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
                    remedy="Make it periodic with underfoot.surface.periodised",
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
        from ._kernels.floor import floor_at_points

        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        shape = x.shape
        h, hx, hy = floor_at_points(x.ravel(), y.ravel(), *self.kernel_arrays())
        return h.reshape(shape), hx.reshape(shape), hy.reshape(shape)

    def kernel_arrays(self) -> tuple[int, np.ndarray, np.ndarray]:
        """Return form number, numbers and spline coefficients as the kernels take them."""
        coefficients = np.zeros((1, 1))
        steps = (1.0, 1.0)
        if self.form == "map":
            from scipy.ndimage import spline_filter

            assert self.height_map is not None
            heights = self.height_map.heights
            coefficients = np.ascontiguousarray(
                spline_filter(heights - heights.mean(), order=3, mode="grid-wrap")
            )
            steps = (self.height_map.spacing, self.height_map.spacing)
        rate = 0.0 if math.isinf(self.radius) else 1.0 / self.radius
        numbers = np.array(
            [0.5 * self.peak_to_valley, 1.0 / self.wavelength, *self.offset, rate, *steps]
        )
        return FORMS.index(self.form), numbers, coefficients
