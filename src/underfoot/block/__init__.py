"""The report's rubber block on a rough floor (G.1) by explicit or condensed finite elements."""

from .assembly import ExplicitSettings
from .compliance import CondensedBlock, condensed_block, pressed_block
from .condensed import (
    condensed_poisson_ratio,
    condensed_sliding,
    edge_corrected_contact_area,
    nodal_contact_area,
    pressure_ratio_of,
)
from .explicit import explicit_sliding
from .inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from .report_g1 import report_block, report_floor, report_loading, report_material
from .result import EnergyLedger, MicroAverages, MicroResult

__all__ = [
    "CondensedBlock",
    "EnergyLedger",
    "ExplicitSettings",
    "MicroAverages",
    "MicroBlock",
    "MicroLoading",
    "MicroMaterial",
    "MicroResult",
    "MicroSurface",
    "condensed_block",
    "condensed_poisson_ratio",
    "condensed_sliding",
    "edge_corrected_contact_area",
    "explicit_sliding",
    "nodal_contact_area",
    "pressed_block",
    "pressure_ratio_of",
    "report_block",
    "report_floor",
    "report_loading",
    "report_material",
]
