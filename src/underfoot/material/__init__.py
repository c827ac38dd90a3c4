"""Rubber: hardness to modulus, relaxation spectra and how to get them from tests."""

from underfoot.core.deprecation import package_names

from .bs903_1950 import bs903_breaches as bs903_breaches
from .bs903_1950 import youngs_modulus_bs903 as youngs_modulus_bs903
from .curves import DynamicSweep as DynamicSweep
from .curves import RelaxationCurve as RelaxationCurve
from .elastomer import Elastomer as Elastomer
from .elastomer import bulk_modulus as bulk_modulus
from .elastomer import plane_strain_modulus as plane_strain_modulus
from .elastomer import poisson_ratio_from_moduli as poisson_ratio_from_moduli
from .elastomer import shear_from_young as shear_from_young
from .elastomer import shear_modulus as shear_modulus
from .elastomer import young_from_shear as young_from_shear
from .elastomer import youngs_modulus_from_shear as youngs_modulus_from_shear
from .few_terms import power_law_spectrum as power_law_spectrum
from .few_terms import report_elastomer as report_elastomer
from .few_terms import single_exponential_spectrum as single_exponential_spectrum
from .gent_1958 import gent_breaches as gent_breaches
from .gent_1958 import shore_a_gent as shore_a_gent
from .gent_1958 import youngs_modulus_gent as youngs_modulus_gent
from .master_curve import ArrheniusShift as ArrheniusShift
from .master_curve import DynamicMasterCurve as DynamicMasterCurve
from .master_curve import RelaxationMasterCurve as RelaxationMasterCurve
from .master_curve import ShiftTable as ShiftTable
from .master_curve import WlfShift as WlfShift
from .master_curve import dynamic_master_curve as dynamic_master_curve
from .master_curve import fit_arrhenius as fit_arrhenius
from .master_curve import fit_wlf as fit_wlf
from .master_curve import relaxation_master_curve as relaxation_master_curve
from .read import read_dynamic as read_dynamic
from .read import read_prony as read_prony
from .read import read_relaxation as read_relaxation
from .ruess import ruess_breaches as ruess_breaches
from .ruess import youngs_modulus_ruess as youngs_modulus_ruess
from .spectrum import RelaxationSpectrum as RelaxationSpectrum
from .spectrum_fit import ModulusBand as ModulusBand
from .spectrum_fit import ReducedSpectrum as ReducedSpectrum
from .spectrum_fit import SpectrumFit as SpectrumFit
from .spectrum_fit import fit_dynamic as fit_dynamic
from .spectrum_fit import fit_relaxation as fit_relaxation
from .spectrum_fit import reduce_spectrum as reduce_spectrum
from .write_decks import write_deck as write_deck

__getattr__ = package_names(__name__, gone="0.5", reduced="reduce_spectrum")
