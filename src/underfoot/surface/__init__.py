"""Heights and profiles: read, level, filter, roughness numbers, spectrum, generate."""

from .areal_numbers import ArealRoughness, areal_roughness, rms_slope
from .autocorrelation import autocorrelation, correlation_length
from .filter import long_waves, short_waves
from .from_spectrum import surface_from_spectrum
from .height_map import HeightMap
from .isotropic_inversion import isotropic_from_profile
from .moments import Asperities, SpectralMoments, asperities, spectral_moments
from .patterns import checkerboard, sinusoidal
from .periodise import periodised
from .prepare import filled, levelled
from .profile import Profile, profile_from_positions
from .profile_numbers import (
    HeightNumbers,
    ProfileRoughness,
    height_numbers,
    profile_roughness,
)
from .read_dektak import InstrumentResult, read_dektak
from .read_instrument import read_instrument, read_surface
from .read_text import read_map, read_profile
from .resolution import Resolution, shortest_reliable_wavelength
from .self_affine import self_affine
from .spectrum import IsotropicSpectrum, ProfileSpectrum, isotropic_spectrum, profile_spectrum

__all__ = [
    "ArealRoughness",
    "Asperities",
    "HeightMap",
    "HeightNumbers",
    "InstrumentResult",
    "IsotropicSpectrum",
    "Profile",
    "ProfileRoughness",
    "ProfileSpectrum",
    "Resolution",
    "SpectralMoments",
    "areal_roughness",
    "asperities",
    "autocorrelation",
    "checkerboard",
    "correlation_length",
    "filled",
    "height_numbers",
    "isotropic_from_profile",
    "isotropic_spectrum",
    "levelled",
    "long_waves",
    "periodised",
    "profile_from_positions",
    "profile_roughness",
    "profile_spectrum",
    "read_dektak",
    "read_instrument",
    "read_map",
    "read_profile",
    "read_surface",
    "rms_slope",
    "self_affine",
    "short_waves",
    "shortest_reliable_wavelength",
    "sinusoidal",
    "spectral_moments",
    "surface_from_spectrum",
]
