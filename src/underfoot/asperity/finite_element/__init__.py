"""A rubber block pressed on a rough rigid floor and slid, by explicit finite elements."""

from .inputs import (
    EnergyLedger,
    MicroAverages,
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroResult,
)
from .model import explicit_sliding
from .settings import ExplicitSettings
from .surface import MicroSurface

__all__ = [
    "EnergyLedger",
    "ExplicitSettings",
    "MicroAverages",
    "MicroBlock",
    "MicroLoading",
    "MicroMaterial",
    "MicroResult",
    "MicroSurface",
    "explicit_sliding",
]
