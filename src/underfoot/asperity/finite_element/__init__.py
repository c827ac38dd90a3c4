"""A rubber block pressed on a rough rigid floor and slid, by explicit finite elements."""

from .inputs import (
    EnergyLedger,
    MicroAverages,
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroResult,
)
from .surface import MicroSurface

__all__ = [
    "EnergyLedger",
    "MicroAverages",
    "MicroBlock",
    "MicroLoading",
    "MicroMaterial",
    "MicroResult",
    "MicroSurface",
]
