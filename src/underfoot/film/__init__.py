"""Fluid film between sole and floor: Reynolds equation with cavitation, wedge and squeeze."""

from ._kernels.flux import Flow, Stencil, Upwinding, film_flow, upwinding
from ._kernels.pattern import Pattern
from .linear import Factorization, available_backends, factorization
from .reynolds import FilmPressure, film_pressure

__all__ = [
    "Factorization",
    "FilmPressure",
    "Flow",
    "Pattern",
    "Stencil",
    "Upwinding",
    "available_backends",
    "factorization",
    "film_flow",
    "film_pressure",
    "upwinding",
]
