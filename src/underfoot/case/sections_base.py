"""Base of the sections of a case, and the quantities that several of them hold."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import BaseModel, ConfigDict

from .quantity import Quantity

Length = Annotated[float, Quantity("m", 0.0, 0.5, open_low=True)]
Depth = Annotated[float, Quantity("m", 0.0, 0.05)]
Rounding = Annotated[float, Quantity("m", 0.0, 0.1)]
LargeRadius = Annotated[float, Quantity("m", 1e-3, 10.0)]
Angle = Annotated[float, Quantity("rad", 0.0, math.radians(60))]
WearAngle = Annotated[float, Quantity("rad", 0.0, math.radians(45))]
Force = Annotated[float, Quantity("N", 0.0, 1e4, open_low=True)]


class Section(BaseModel):
    """Base of all sections."""

    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="constants")
