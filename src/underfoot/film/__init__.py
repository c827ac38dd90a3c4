"""Fluid film between sole and floor: Reynolds equation with cavitation, wedge and squeeze."""

from ._kernels.flux import Flow, Stencil, film_flow
from ._kernels.pattern import Pattern
from .factorization import Factorization, available_backends, factorization

__all__ = [
    "Factorization",
    "Flow",
    "Pattern",
    "Stencil",
    "available_backends",
    "factorization",
    "film_flow",
]
