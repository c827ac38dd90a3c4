"""The grant report's micro model (G.1.1): block, faces, materials, loading as printed or corrected.

Left open by the report and assumed here: density, phase of the patterns, number of layers, width of
26 instead of 25.6 elements, hourglass control.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import TypeVar

from underfoot.core import unknown_name
from underfoot.core.checks import choice
from underfoot.material import report_elastomer, shear_from_young
from underfoot.material.few_terms import POISSON_RATIO
from underfoot.material.spectrum import RelaxationSpectrum

from .inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface

T = TypeVar("T")

PRINTED_BULK_MODULUS: Mapping[str, float] = MappingProxyType({"neolite": 9324e6, "rubber": 2180e6})
"""K of Table 2, Pa; rubber's is ten times what nu = 0.499 gives."""
SHOE_ROUGHNESS: Mapping[str, float] = MappingProxyType({"low": 12.1e-6, "high": 35.1e-6})
"""R_z of Table 1, m: neolite's and rubber's."""
FLOOR_ROUGHNESS: Mapping[str, float] = MappingProxyType(
    {"low": 16.6e-6, "medium": 24.3e-6, "high": 35.1e-6}
)
"""R_z of Table 1, m."""
WAVELENGTHS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"tenths": (0.5e-3, 0.4e-3), "nodes": (62.5e-6, 125e-6)}
)
"""Of shoe and floor, m: a tenth of the printed 5 and 4 mm, which do not fit the block of 0.8 mm;
or every other node raised, on the report's meshes of 31.25 and 62.5 micrometres."""
SPEEDS = (0.1, 0.25, 0.5, 0.75, 1.0)
"""m/s."""


def report_block(shoe: str, *, asperities: str = "tenths") -> MicroBlock:
    """Return the block of 0.8 x 0.5 x 0.5 mm with "low" or "high" shoe roughness.

    ``asperities``: "tenths" (cosines of 0.5 mm) or "nodes" (the checkerboard of single nodes; 26
    elements of 31.25 micrometres, so 0.8125 mm long).
    """
    height = _entry(SHOE_ROUGHNESS, shoe, "shoe roughness")
    wavelength = _entry(WAVELENGTHS, asperities, "asperities")[0]
    nodes = asperities == "nodes"
    return MicroBlock(
        size=(0.8125e-3 if nodes else 0.8e-3, 0.5e-3, 0.5e-3),
        elements=(26, 16, 9),
        bottom_layer=31.25e-6,
        roughness=MicroSurface.checkerboard(
            height, wavelength, form="triangular" if nodes else "cosine"
        ),
    )


def report_floor(floor: str, *, asperities: str = "tenths") -> MicroSurface:
    """Return the rigid floor with "low", "medium" or "high" roughness; ``asperities`` as above."""
    height = _entry(FLOOR_ROUGHNESS, floor, "floor roughness")
    wavelength = _entry(WAVELENGTHS, asperities, "asperities")[1]
    form = "triangular" if asperities == "nodes" else "cosine"
    return MicroSurface.checkerboard(height, wavelength, form=form)


def report_material(name: str, *, bulk: str = "corrected") -> MicroMaterial:
    """Return "neolite" or "rubber" of Table 2 with one relaxation term.

    ``bulk``: "corrected" takes K from G_inf and nu = 0.499 (rubber 220 MPa, neolite as printed),
    "printed" takes Table 2's 2180 MPa for rubber.
    """
    elastomer = report_elastomer(name)
    choice(bulk, ("corrected", "printed"), "bulk")
    if bulk == "corrected":
        return MicroMaterial.from_elastomer(elastomer)
    assert isinstance(elastomer.modulus, RelaxationSpectrum)
    shear = shear_from_young(elastomer.modulus, POISSON_RATIO)
    return MicroMaterial(
        shear, _entry(PRINTED_BULK_MODULUS, name, "material"), name=name, source=elastomer.source
    )


def report_loading(speed: float, *, wavelengths: int = 2) -> MicroLoading:
    """Return 160 kPa reached in 1 ms, then sliding at fixed height over whole floor wavelengths."""
    return MicroLoading(
        mean_pressure=160e3,
        speed=speed,
        slide_distance=wavelengths * WAVELENGTHS["tenths"][1],
        control="displacement",
        press_time=1e-3,
    )


def _entry(table: Mapping[str, T], name: str, kind: str) -> T:
    if name not in table:
        raise unknown_name(kind, name, table)
    return table[name]
