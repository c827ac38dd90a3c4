"""Rubber: hardness to modulus, relaxation spectra and how to get them from tests."""

from .bs903_1950 import bs903_breaches, youngs_modulus_bs903
from .compression import (
    CompressionForces,
    CompressionModuli,
    compression_forces,
    compression_moduli,
)
from .curves import DynamicSweep, RelaxationCurve
from .elastic import (
    bulk_modulus,
    plane_strain_modulus,
    poisson_ratio_from_moduli,
    shear_modulus,
    youngs_modulus_from_shear,
)
from .elastomer import Elastomer, shear_from_young, young_from_shear
from .gent_1958 import gent_breaches, shore_a_gent, youngs_modulus_gent
from .master_curve import (
    DynamicMasterCurve,
    RelaxationMasterCurve,
    ShiftTable,
    dynamic_master_curve,
    relaxation_master_curve,
)
from .power_law import power_law_spectrum
from .read import read_dynamic, read_prony, read_relaxation
from .reduce import ReducedSpectrum, reduced
from .report_rubber import report_elastomer
from .ruess import ruess_breaches, youngs_modulus_ruess
from .shift_laws import ArrheniusShift, WlfShift, fit_arrhenius, fit_wlf
from .single_exponential import (
    SingleExponentialFit,
    fit_single_exponential,
    single_exponential_spectrum,
)
from .spectrum import RelaxationSpectrum
from .spectrum_fit import ModulusBand, SpectrumFit, fit_dynamic, fit_relaxation

__all__ = [
    "ArrheniusShift",
    "CompressionForces",
    "CompressionModuli",
    "DynamicMasterCurve",
    "DynamicSweep",
    "Elastomer",
    "ModulusBand",
    "ReducedSpectrum",
    "RelaxationCurve",
    "RelaxationMasterCurve",
    "RelaxationSpectrum",
    "ShiftTable",
    "SingleExponentialFit",
    "SpectrumFit",
    "WlfShift",
    "bs903_breaches",
    "bulk_modulus",
    "compression_forces",
    "compression_moduli",
    "dynamic_master_curve",
    "fit_arrhenius",
    "fit_dynamic",
    "fit_relaxation",
    "fit_single_exponential",
    "fit_wlf",
    "gent_breaches",
    "plane_strain_modulus",
    "poisson_ratio_from_moduli",
    "power_law_spectrum",
    "read_dynamic",
    "read_prony",
    "read_relaxation",
    "reduced",
    "relaxation_master_curve",
    "report_elastomer",
    "ruess_breaches",
    "shear_from_young",
    "shear_modulus",
    "shore_a_gent",
    "single_exponential_spectrum",
    "young_from_shear",
    "youngs_modulus_bs903",
    "youngs_modulus_from_shear",
    "youngs_modulus_gent",
    "youngs_modulus_ruess",
]
