"""The one-term materials of the grant report: Eq. 7 with Table 2."""

from collections.abc import Mapping
from types import MappingProxyType

from underfoot.core import unknown_name

from .elastomer import Elastomer, young_from_shear
from .single_exponential import single_exponential_spectrum

SOURCE = "Grant report G.1.1, Eq. 7 and Table 2"
POISSON_RATIO = 0.499

SHEAR_CONSTANTS: Mapping[str, tuple[float, float, float]] = MappingProxyType(
    {
        "neolite": (30.24e6, 18.66e6, 0.013),
        "rubber": (0.59e6, 0.44e6, 0.025),
    }
)
"""G_0 (Pa), G_inf (Pa), beta (1/s) of Table 2."""


def report_elastomer(name: str) -> Elastomer:
    """Return "neolite" (Shore A 95) or "rubber" (Shore A 50) of the report as an ``Elastomer``.

    One term with 1 / beta = 77 s and 40 s: at 0.1 to 1 m/s over asperities of 0.4 mm its loss
    tangent is 1e-7 to 1e-5, so that this material has practically no hysteresis friction. The
    bulk modulus follows from nu = 0.499; Table 2's 2180 MPa for rubber is ten times what that
    rule gives (neolite's 9324 MPa obeys it).

    Raises:
        InputError: Another name.
    """
    if name not in SHEAR_CONSTANTS:
        raise unknown_name("material of the report", name, SHEAR_CONSTANTS)
    g0, ginf, beta = SHEAR_CONSTANTS[name]
    shear = single_exponential_spectrum(g0, ginf, beta, source=SOURCE)
    return Elastomer(
        young_from_shear(shear, POISSON_RATIO), POISSON_RATIO, name=name, source=SOURCE
    )
