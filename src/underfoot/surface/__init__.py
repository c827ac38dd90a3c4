"""Heights and profiles: read, level, filter, roughness numbers, spectrum, generate."""

from underfoot.core.deprecation import package_names

from .arrays import read_array as read_array
from .filter import long_waves as long_waves
from .filter import short_waves as short_waves
from .generate import checkerboard as checkerboard
from .generate import self_affine as self_affine
from .generate import sinusoidal as sinusoidal
from .generate import surface_from_spectrum as surface_from_spectrum
from .generate import surface_of_density as surface_of_density
from .heights import HeightMap as HeightMap
from .heights import Profile as Profile
from .heights import Resolution as Resolution
from .heights import profile_from_positions as profile_from_positions
from .heights import shortest_reliable_wavelength as shortest_reliable_wavelength
from .instruments import read_instrument as read_instrument
from .prepare import fill_missing_heights as fill_missing_heights
from .prepare import level_surface as level_surface
from .prepare import make_periodic as make_periodic
from .prepare import square_cells as square_cells
from .read import InstrumentResult as InstrumentResult
from .read import read_dektak as read_dektak
from .read import read_map as read_map
from .read import read_profile as read_profile
from .read import read_surface as read_surface
from .roughness import ArealRoughness as ArealRoughness
from .roughness import HeightNumbers as HeightNumbers
from .roughness import ProfileRoughness as ProfileRoughness
from .roughness import areal_roughness as areal_roughness
from .roughness import height_numbers as height_numbers
from .roughness import profile_roughness as profile_roughness
from .roughness import rms_slope as rms_slope
from .scan import Scan as Scan
from .scan import read_scan as read_scan
from .spectrum import Asperities as Asperities
from .spectrum import IsotropicSpectrum as IsotropicSpectrum
from .spectrum import ProfileSpectrum as ProfileSpectrum
from .spectrum import SpectralMoments as SpectralMoments
from .spectrum import asperities as asperities
from .spectrum import autocorrelation as autocorrelation
from .spectrum import correlation_length as correlation_length
from .spectrum import isotropic_from_profile as isotropic_from_profile
from .spectrum import isotropic_spectrum as isotropic_spectrum
from .spectrum import profile_spectrum as profile_spectrum
from .spectrum import spectral_moments as spectral_moments
from .write import write_surface as write_surface

__getattr__ = package_names(
    __name__,
    gone="0.5",
    filled="fill_missing_heights",
    levelled="level_surface",
    periodised="make_periodic",
    squared="square_cells",
)
