"""The report's rubber block on a rough floor (G.1) by explicit or condensed finite elements."""

from typing import TYPE_CHECKING

from underfoot.core.deprecation import package_names

if TYPE_CHECKING:
    from .assembly import ExplicitSettings as ExplicitSettings
    from .compliance import CondensedBlock as CondensedBlock
    from .compliance import condensed_block as condensed_block
    from .compliance import pressed_block as pressed_block
    from .condensed import condensed_poisson_ratio as condensed_poisson_ratio
    from .condensed import condensed_sliding as condensed_sliding
    from .condensed import edge_corrected_contact_area as edge_corrected_contact_area
    from .condensed import nodal_contact_area as nodal_contact_area
    from .condensed import pressure_ratio_of as pressure_ratio_of
    from .explicit import explicit_sliding as explicit_sliding
    from .inputs import MicroBlock as MicroBlock
    from .inputs import MicroLoading as MicroLoading
    from .inputs import MicroMaterial as MicroMaterial
    from .inputs import MicroSurface as MicroSurface
    from .report_g1 import report_block as report_block
    from .report_g1 import report_floor as report_floor
    from .report_g1 import report_loading as report_loading
    from .report_g1 import report_material as report_material
    from .result import EnergyLedger as EnergyLedger
    from .result import MicroAverages as MicroAverages
    from .result import MicroResult as MicroResult

_HOMES = {
    "ExplicitSettings": ".assembly",
    "CondensedBlock": ".compliance",
    "condensed_block": ".compliance",
    "pressed_block": ".compliance",
    "condensed_poisson_ratio": ".condensed",
    "condensed_sliding": ".condensed",
    "edge_corrected_contact_area": ".condensed",
    "nodal_contact_area": ".condensed",
    "pressure_ratio_of": ".condensed",
    "explicit_sliding": ".explicit",
    "MicroBlock": ".inputs",
    "MicroLoading": ".inputs",
    "MicroMaterial": ".inputs",
    "MicroSurface": ".inputs",
    "report_block": ".report_g1",
    "report_floor": ".report_g1",
    "report_loading": ".report_g1",
    "report_material": ".report_g1",
    "EnergyLedger": ".result",
    "MicroAverages": ".result",
    "MicroResult": ".result",
}

__all__ = [*_HOMES]  # pyright: ignore[reportUnsupportedDunderAll]

__getattr__ = package_names(__name__, _HOMES)
