"""Rubber: hardness to modulus, relaxation spectra and how to get them from tests."""

from .gent_1958 import gent_breaches, shore_a_gent, youngs_modulus_gent
from .spectrum import RelaxationSpectrum

__all__ = ["RelaxationSpectrum", "gent_breaches", "shore_a_gent", "youngs_modulus_gent"]
