"""Plan form of a whole shoe sole from a few widths."""

from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError, unknown_name
from underfoot.core.arrays import Array
from underfoot.core.checks import positive

SIDES = ("left", "right")
HEEL_AT, WAIST_AT, LATERAL_BALL_AT, MEDIAL_BALL_AT = 0.16, 0.42, 0.62, 0.72
"""Places of the widths along the sole, as shares of its length (assumed: common lasts)."""
WAIST_INSET = 0.62
"""Share of the waist's inset that lies on the medial side, under the arch (assumed)."""
TOE_OFFSET = 0.12
"""Place of the tip towards the medial side as a share of the ball width (assumed)."""


@dataclass(frozen=True, slots=True)
class ShoeOutline:
    """Rim of a sole: arcs without a kink through the heel, both waists, both balls and the tip.

    Parameters:
        length: m.
        heel_width, waist_width, ball_width: Across the heel, the narrowest place and the ball of
            the foot, m. The ball width is the sum of its largest extents on both sides, which lie
            at different places along the sole.
        side: "left" or "right": the left sole, as seen from above, has its medial side at y < 0.
    """

    length: float
    heel_width: float
    waist_width: float
    ball_width: float
    side: str = "right"

    def __post_init__(self) -> None:
        for name in ("length", "heel_width", "waist_width", "ball_width"):
            positive(getattr(self, name), f"heel.{name}")
        if self.side not in SIDES:
            raise unknown_name("side", self.side, SIDES, where="heel.side")
        if self.waist_width > min(self.heel_width, self.ball_width):
            raise InputError(
                f"the waist of {self.waist_width * 1e3:g} mm is wider than heel or ball",
                where="heel.waist_width",
                allowed=f"at most {min(self.heel_width, self.ball_width) * 1e3:g} mm",
            )
        if self.length < 2 * self.ball_width:
            raise InputError(
                f"a sole of {self.length * 1e3:g} mm is too short for its ball width",
                where="heel.length",
                allowed=f"at least {2e3 * self.ball_width:g} mm (twice heel.ball_width)",
            )
        if 2 * HEEL_AT * self.length < 0.5 * self.heel_width:
            raise InputError(
                f"a heel of {self.heel_width * 1e3:g} mm is too wide for the length",
                where="heel.heel_width",
                allowed=f"at most {4e3 * HEEL_AT * self.length:g} mm",
            )

    def arcs(self) -> Array:
        """Return the rim as arcs (n, 7), anticlockwise; see ``_kernels.arcs``."""
        from .._kernels.arcs import biarc

        length, inset = self.length, self.heel_width / 2 - self.waist_width / 2
        medial_inset, lateral_inset = 2 * WAIST_INSET * inset, 2 * (1 - WAIST_INSET) * inset
        heel, ball = self.heel_width / 2, self.ball_width / 2
        # of a right sole, whose medial side is on the left (y > 0); anticlockwise from the rear
        forward, backward = np.array([1.0, 0.0]), np.array([-1.0, 0.0])
        stations = [
            (np.array([0.0, 0.0]), np.array([0.0, -1.0])),
            (np.array([HEEL_AT * length, -heel]), forward),
            (np.array([WAIST_AT * length, lateral_inset - heel]), forward),
            (np.array([LATERAL_BALL_AT * length, -ball]), forward),
            (np.array([length, TOE_OFFSET * self.ball_width]), np.array([0.0, 1.0])),
            (np.array([MEDIAL_BALL_AT * length, ball]), backward),
            (np.array([WAIST_AT * length, heel - medial_inset]), backward),
            (np.array([HEEL_AT * length, heel]), backward),
        ]
        if self.side == "left":
            mirror = np.array([1.0, -1.0])
            stations = [(point * mirror, -tangent * mirror) for point, tangent in stations[::-1]]
        arcs = []
        for (start, leaving), (end, arriving) in zip(
            stations, [*stations[1:], stations[0]], strict=True
        ):
            arcs += biarc(start, leaving, end, arriving)
        return np.array(arcs)
