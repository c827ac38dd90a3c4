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
from .report_g1 import report_block, report_floor, report_loading, report_material
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
    "report_block",
    "report_floor",
    "report_loading",
    "report_material",
]
