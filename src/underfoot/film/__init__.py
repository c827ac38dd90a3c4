"""Fluid film between sole and floor: Reynolds and cavitation, wedge, squeeze, soft EHL, regimes."""

from ._kernels.faces import Upwinding, upwinding
from .operator import Cavity, Conductance, FilmOperator, Stencil, divergence, film_operator
from .patir_cheng_1978 import (
    patir_cheng_breaches,
    patir_cheng_mean_gap,
    patir_cheng_pressure_factors,
)
from .patir_cheng_1979 import patir_cheng_shear_factor, patir_cheng_shear_flow
from .pattern import Pattern
from .pressure import Film, FilmPressure, film_history, film_pressure
from .regimes import (
    SHARE_LIMITS,
    Lubrication,
    RegimeComparison,
    RegimeMap,
    compare_regimes,
    fluid_load_share,
    lubrication_by_lambda,
    lubrication_by_load_share,
    regime_map,
)
from .soft_ehl import (
    FilmRegime,
    SoftEhlFilm,
    effective_modulus,
    film_regime,
    lambda_ratio,
    radius_of_parabola,
    soft_ehl,
)
from .squeeze_times import (
    rectangle_torsion_constant,
    squeeze_gap,
    squeeze_time_disc,
    squeeze_time_rectangle,
)
from .tapered_wedge import (
    TaperedWedge,
    side_leakage,
    tapered_wedge,
    wedge_film,
    wedge_load_factor,
)
from .wall_shear import wall_shear

__all__ = [
    "SHARE_LIMITS",
    "Cavity",
    "Conductance",
    "Film",
    "FilmOperator",
    "FilmPressure",
    "FilmRegime",
    "Lubrication",
    "Pattern",
    "RegimeComparison",
    "RegimeMap",
    "SoftEhlFilm",
    "Stencil",
    "TaperedWedge",
    "Upwinding",
    "compare_regimes",
    "divergence",
    "effective_modulus",
    "film_history",
    "film_operator",
    "film_pressure",
    "film_regime",
    "fluid_load_share",
    "lambda_ratio",
    "lubrication_by_lambda",
    "lubrication_by_load_share",
    "patir_cheng_breaches",
    "patir_cheng_mean_gap",
    "patir_cheng_pressure_factors",
    "patir_cheng_shear_factor",
    "patir_cheng_shear_flow",
    "radius_of_parabola",
    "rectangle_torsion_constant",
    "regime_map",
    "side_leakage",
    "soft_ehl",
    "squeeze_gap",
    "squeeze_time_disc",
    "squeeze_time_rectangle",
    "tapered_wedge",
    "upwinding",
    "wall_shear",
    "wedge_film",
    "wedge_load_factor",
]
