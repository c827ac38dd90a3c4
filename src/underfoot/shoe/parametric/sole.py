"""A whole sole described by widths, profile and tread."""

from dataclasses import dataclass, field

import numpy as np

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive

from ..profile import Flat, Profile
from ..shape import SoleShape, SoleWear, check_depths
from ..tread import ArcChannel, Tread
from .outline import ShoeOutline
from .toe_spring import SoleProfile, ToeSpring


@dataclass(frozen=True, slots=True)
class WholeSole(SoleShape):
    """A sole from heel to toe in its own frame: x from the rear end, y to the left, z up.

    Parameters:
        outline: Plan form.
        outsole_thickness: From the bottom of the lugs to the midsole, m.
        rear_profile: ``Flat()``, ``Facet(angle, length)`` or ``Rocker(radius, start)`` at the heel.
        toe_spring: Bend of the toe; None for none.
        edge_radius, crown_radius, tread, arc_channel, wear: As of ``Heel``.
    """

    outline: ShoeOutline
    outsole_thickness: float
    rear_profile: Profile = field(default_factory=Flat)
    toe_spring: ToeSpring | None = None
    edge_radius: float = 0.0
    crown_radius: float | None = None
    tread: Tread | None = None
    arc_channel: ArcChannel | None = None
    wear: SoleWear | None = None
    length: float = field(init=False)
    width: float = field(init=False)
    profile: Profile = field(init=False)

    def __post_init__(self) -> None:
        width = max(self.outline.ball_width, self.outline.heel_width)
        object.__setattr__(self, "length", self.outline.length)
        object.__setattr__(self, "width", width)
        object.__setattr__(self, "profile", SoleProfile(self.rear_profile, self.toe_spring))
        positive(self.outsole_thickness, "heel.outsole_thickness")
        not_negative(self.edge_radius, "heel.edge_radius")
        limit = self.outline.waist_width / 2
        if self.edge_radius > limit:
            raise InputError(
                f"{self.edge_radius * 1e3:g} mm doesn't fit the plan form",
                where="heel.edge_radius",
                allowed=f"at most {limit * 1e3:g} mm (half of the waist)",
            )
        if self.crown_radius is not None:
            positive(self.crown_radius, "heel.crown_radius")
        check_depths(self)

    @property
    def plan_area(self) -> float:
        """Area of the plan form in its own plane, m^2."""
        from .._kernels.arcs import points_on

        x, y = points_on(self.rim_arcs(), 1e-4).T
        return float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2

    def rim_arcs(self) -> Array:
        """Return the rim as arcs (n, 7), anticlockwise; see ``_kernels.arcs``."""
        return self.outline.arcs()

    def inward_distance(self, x: Array, y: Array) -> Array:
        """Return the distance (m) from the rim of the plan form, positive inside."""
        from .._kernels.arcs import inward_distance

        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        flat = inward_distance(x.ravel(), y.ravel(), self.rim_arcs())
        return flat.reshape(x.shape)
