"""A whole sole that rolls: straight up to the flat foot, then bent at the ball."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.arrays import Array

PLACE = 0.66
"""Of the sole's length: where lasts for shoes put the bend (63 or 66 %; the joint of the big toe
lies at 70 to 79 % of the bare foot; flexion location of general purpose women's footwear)."""
ZONE = 12e-3
"""m: half of the zone over which soles should bend (same source: 24 mm)."""
MOST_BEND = math.radians(30.0)
"""Largest bend of the toes at push-off in a stiff shoe, 25 to 30 deg; 45 to 50 in soft shoes, 60 in
none (Bojsen-Moller and Lamoreux, Acta Orthop. Scand. 50:471, 1979). Work shoes are stiff."""


@dataclass(frozen=True, slots=True)
class BallJoint:
    """Where a sole bends across its full width, and the shoe angle at which its map was made.

    The foot is rigid behind the joint and before it. Below a shoe angle of 0 the forepart stays
    level and the joint bends, until it is bent by ``MOST_BEND``; then the forepart rises with the
    rest and the shoe rolls over its toe.

    Attributes:
        place: From the rear end of the map, m.
        map_angle: rad, toe up positive.
    """

    place: float
    map_angle: float

    def forepart(self, shoe_angle: float) -> float:
        """Return the angle of the forepart (rad), the rest of the shoe at ``shoe_angle``."""
        return shoe_angle if shoe_angle >= 0 else min(shoe_angle + MOST_BEND, 0.0)


def rolled_height(x: Array, height: Array, roll: float, joint: BallJoint | None) -> Array:
    """Return the height (nx, ny) of a sole over the floor, rolled by ``roll`` (rad) from its map.

    A point (x, z) goes to z' = x sin a + z cos a; with a joint at j, and the forepart rolled by b,
    the slope goes from sin a to sin b linearly over the zone of half-width w about j:

        z' = j sin b + (x - j) sin a + (sin b - sin a) g + z cos(a, b),
        g = 0 before the zone, (x - j + w)^2 / (4 w) in it, x - j beyond it
    """
    fore = roll if joint is None else joint.forepart(joint.map_angle + roll) - joint.map_angle
    if joint is None or fore == roll:
        return height * math.cos(roll) + x[:, None] * math.sin(roll)
    ahead = x - joint.place
    into = np.clip((ahead + ZONE) / (2 * ZONE), 0.0, 1.0)
    bent = np.where(ahead > ZONE, ahead, ZONE * into**2)
    slope = math.sin(fore) - math.sin(roll)
    lift = joint.place * math.sin(fore) + ahead * math.sin(roll) + slope * bent
    level = math.cos(roll) + into * (math.cos(fore) - math.cos(roll))
    return height * level[:, None] + lift[:, None]
