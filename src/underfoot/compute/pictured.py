"""Fields of a result that only pictures and exports need: the whole sole, and the sole pressed."""

from typing import Any

import numpy as np

from underfoot.core.arrays import Array
from underfoot.shoe import SoleMap
from underfoot.shoe.ball_joint import rolled_height
from underfoot.sole_contact.compliance import Compliance
from underfoot.sole_contact.sole_state import SoleState

Variable = tuple[tuple[str, ...], Any, dict[str, str]]


def pictured_fields(
    sole: SoleMap, contact: SoleState, compliance: Compliance, map_angle: float
) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Return variables and coordinates that draw the whole sole, undeformed and pressed.

    ``pressed_height`` = c - d + C[p_t], 0 or more, where the contact was solved: clearance c,
    approach d, deflection C under fluid and contact pressure together. The rest of a whole sole
    (``whole_*``) is lowered by d without deflection. Heights in m over the floor, nan outside.

    Parameters:
        sole: Undeformed sole over the floor, at ``map_angle``.
        contact: The instant to be drawn.
        compliance: Deflection under pressure on the grid of ``sole``.
        map_angle: Shoe angle (rad) at which ``sole`` was made; it has rolled from there.
    """
    roll = contact.shoe_angle - map_angle
    lowest = _roll_sole(sole, roll)[sole.inside].min()

    def height(shape: SoleMap) -> Array:
        return np.where(shape.inside, _roll_sole(shape, roll) - lowest - contact.approach, np.nan)

    pressed = height(sole) + compliance.apply(contact.cell_load)
    variables: dict[str, Variable] = {
        "pressed_height": (
            ("x", "y"),
            np.maximum(pressed, 0.0).astype(np.float32),
            {"units": "m", "long_name": "height of the pressed sole over the floor"},
        )
    }
    whole = sole.whole
    if whole is None:
        return variables, {}
    axes = ("whole_x", "whole_y")
    clearance = np.where(whole.inside, whole.clearance, np.nan).astype(np.float32)
    lowered = np.maximum(height(whole), 0.0).astype(np.float32)
    title = "height of the whole sole over the floor,"
    variables |= {
        "whole_clearance": (axes, clearance, {"units": "m", "long_name": f"{title} undeformed"}),
        "whole_pressed_height": (axes, lowered, {"units": "m", "long_name": f"{title} lowered"}),
        "whole_land": (axes, whole.land, {"units": "1", "long_name": "can touch the floor"}),
    }
    return variables, {
        "whole_x": (("whole_x",), whole.x, {"units": "m"}),
        "whole_y": (("whole_y",), whole.y, {"units": "m"}),
    }


def _roll_sole(sole: SoleMap, angle: float) -> Array:
    """Return the height (m) over the floor, inf outside."""
    return np.where(sole.inside, rolled_height(sole.x, sole.clearance, angle, sole.joint), np.inf)
