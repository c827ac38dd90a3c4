"""Fluid film between sole and floor: Reynolds equation with cavitation, wedge and squeeze."""

from ._kernels.flux import Flow, Stencil, Upwinding, film_flow, upwinding
from ._kernels.pattern import Pattern
from .linear import Factorization, available_backends, factorization
from .mass_conserving import (
    MassConservingFilm,
    mass_conserving_film,
    mass_conserving_history,
)
from .reynolds import FilmPressure, film_pressure

__all__ = [
    "Factorization",
    "FilmPressure",
    "Flow",
    "MassConservingFilm",
    "Pattern",
    "Stencil",
    "Upwinding",
    "available_backends",
    "factorization",
    "film_flow",
    "film_pressure",
    "mass_conserving_film",
    "mass_conserving_history",
    "upwinding",
]
