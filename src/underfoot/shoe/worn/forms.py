"""What is removed from a sole: a plane cut, a patch of given size, a map."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.checks import between, not_negative, positive
from underfoot.core.remark import Message

from ..shape import SoleShape


@dataclass(frozen=True, slots=True)
class WearPlane:
    """Material removed by a plane, as if ground against a floor at the wear angle.

    The plane first meets the point that would touch a floor at this shoe angle and then removes
    ``depth`` there; this also makes the worn facet at the rear of a heel.

    Parameters:
        depth: Largest thickness removed, normal to the sole, m.
        angle: Shoe angle at which the sole wears, rad, toe up positive; 0 wears the sole evenly.
    """

    depth: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        not_negative(self.depth, "wear.depth")
        between(self.angle, 0.0, math.radians(45), "wear.angle", "0 deg to 45 deg")

    def worn_height(self, x: Array, y: Array, unworn: Array, shape: SoleShape) -> Array:
        """Return the height (m) of the worn land at (x, y): the higher of sole and plane."""
        return np.maximum(unworn, self.height(x, *shape.centre_line()))

    def height(self, x: Array, centre_line_x: Array, centre_line_height: Array) -> Array:
        """Return the height (m) of the plane over the sole plane at ``x`` (m).

        z_p(x) = depth + min(z + x tan(angle)) - x tan(angle), the minimum over the centre line of
        the unworn sole: the surface after wear is the higher of z and z_p.
        """
        slope = math.tan(self.angle)
        first_contact = float(np.min(centre_line_height + slope * centre_line_x))
        return self.depth + first_contact - slope * x


PATCHES = ("ellipse", "rectangle")


@dataclass(frozen=True, slots=True)
class WornPatch:
    """Material removed to one depth within an ellipse or a rectangle.

    Outside the patch the removed thickness falls off as a slope: removed = depth - tan(taper) d,
    not below 0, with the distance d from the patch.

    Parameters:
        depth: Removed within the patch, m: the depth of the tread wears it down to the channel
            floor.
        length, width: Of the patch along and across the shoe, m.
        position: Distance of its middle from the rear end, m; None: it begins at the rear end.
        lateral: Place of its middle across, m, positive to the left.
        form: "ellipse" or "rectangle".
        taper: Angle between the worn slope around the patch and the unworn sole, rad.
    """

    depth: float
    length: float
    width: float
    position: float | None = None
    lateral: float = 0.0
    form: str = "ellipse"
    taper: float = math.radians(3)

    def __post_init__(self) -> None:
        not_negative(self.depth, "wear.depth")
        positive(self.length, "wear.patch_length")
        positive(self.width, "wear.patch_width")
        between(self.taper, math.radians(0.5), math.radians(60), "wear.taper", "0.5 deg to 60 deg")
        if self.form not in PATCHES:
            raise unknown_name("patch form", self.form, PATCHES, where="wear.patch_form")

    @property
    def area(self) -> float:
        """Area of the patch, m^2."""
        share = math.pi / 4 if self.form == "ellipse" else 1.0
        return share * self.length * self.width

    def worn_height(self, x: Array, y: Array, unworn: Array, shape: SoleShape) -> Array:
        """Return the height (m) of the worn land at (x, y)."""
        removed = self.depth - math.tan(self.taper) * self.distance(x, y)
        return unworn + np.clip(removed, 0.0, self.depth)

    def distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) from the patch, 0 within it; along the ray to its middle."""
        along = x - (self.length / 2 if self.position is None else self.position)
        across = y - self.lateral
        if self.form == "rectangle":
            aside = np.maximum(np.abs(along) - self.length / 2, 0.0)
            return np.hypot(aside, np.maximum(np.abs(across) - self.width / 2, 0.0))
        share = np.hypot(2 * along / self.length, 2 * across / self.width)
        return np.hypot(along, across) * np.maximum(1 - 1 / np.maximum(share, 1e-9), 0.0)

    def on(self, shape: SoleShape) -> "WornPatch":
        """Return the patch, unless it is larger than the shoe or has its middle beside it."""
        for name, value, most in (
            ("patch_length", self.length, shape.length),
            ("patch_width", self.width, shape.width),
        ):
            if value > most * (1 + 1e-9):
                raise InputError(
                    f"a worn patch of {value * 1e3:g} mm is larger than the shoe",
                    where=f"wear.{name}",
                    allowed=Message(
                        "at most {most}, the extent of the sole", most=f"{most * 1e3:g} mm"
                    ),
                )
        middle = np.array([self.length / 2 if self.position is None else self.position])
        if shape.inward_distance(middle, np.array([self.lateral]))[0] <= 0:
            raise InputError(
                "the middle of the worn patch lies beside the sole",
                where="wear.patch_position",
                allowed=f"0 mm to {shape.length * 1e3:g} mm on the centre line",
            )
        return self


@dataclass(frozen=True, slots=True)
class WornMap:
    """Removed thickness of the land on a grid in the frame of the sole, bilinear between nodes.

    Parameters:
        x, y: Evenly spaced nodes, m.
        removed: (nx, ny), normal to the sole, m; beyond the grid its nearest value holds.
    """

    x: Array
    y: Array
    removed: Array

    def __post_init__(self) -> None:
        if self.removed.shape != (self.x.size, self.y.size):
            raise InputError(
                Message("removed has shape {shape}", shape=str(self.removed.shape)),
                where="wear.removed",
                allowed=f"{(self.x.size, self.y.size)}",
            )
        if not (np.isfinite(self.removed).all() and (self.removed >= 0).all()):
            raise InputError(
                "a removed thickness is negative or not finite",
                where="wear.removed",
                allowed="0 m or more everywhere",
            )

    @property
    def depth(self) -> float:
        """Largest thickness removed, m."""
        return float(self.removed.max())

    def thickness(self, x: Array, y: Array) -> Array:
        """Return the removed thickness (m) at (x, y)."""
        from scipy.ndimage import map_coordinates

        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        at = [
            (value - nodes[0]) / (nodes[1] - nodes[0])
            for value, nodes in ((x, self.x), (y, self.y))
        ]
        flat = [np.ravel(each) for each in at]
        depth = map_coordinates(self.removed, flat, order=1, mode="nearest")
        return depth.reshape(x.shape)

    def worn_height(self, x: Array, y: Array, unworn: Array, shape: SoleShape) -> Array:
        """Return the height (m) of the worn land at (x, y)."""
        return unworn + self.thickness(x, y)
