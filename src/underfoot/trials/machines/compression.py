"""Short and long time modulus from a compression relaxation test: Eq. 13 to 16."""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError

from .relaxation_test import RelaxationReading

SOURCE = "Grant report G.1.1, Eq. 13-16 (test method of its reference 39)"
PRINTED_TRAVEL = 0.18
BONDED = (0.75, 0.15)
"""k of E_apparent = E (1 + 2 k S^2) for bonded blocks, and its standard deviation: 0.93 of soft
gum to 0.53 of hard filled rubber (Gent and Lindley 1959; from memory)."""


@dataclass(frozen=True, slots=True)
class CompressionModuli:
    """Stiffness (N/m) and apparent modulus (Pa) at short and long time."""

    short_time_stiffness: float
    short_time_modulus: float
    long_time_stiffness: float
    long_time_modulus: float
    source: str = SOURCE
    note: str = (
        "apparent moduli of blocks bonded to plates: they contain the shape factor and are above "
        "Young's modulus of the rubber"
    )


def compression_moduli(
    force_2_percent: float,
    peak_force: float,
    asymptotic_force: float,
    thickness: float,
    area: float,
    *,
    travel: float = PRINTED_TRAVEL,
) -> CompressionModuli:
    """Return K_0, E_0, K_inf and E_inf of two stacked bonded blocks, as printed.

    K_0 = (F_0 - F_0.02) / (0.18 T), E_0 = K_0 2T / A (Eq. 13, 14) and the same with F_inf
    (Eq. 15, 16).

    Parameters:
        force_2_percent, peak_force, asymptotic_force: F_0.02, F_0 and F_inf, N.
        thickness, area: T of one block, m, and A, m^2.
        travel: Displacement between F_0.02 and F_0 in units of T. The printed 0.18 holds when the
            pair (2 T thick) is compressed by 10 %, 0.2 T, and F_0.02 is read at 0.02 T. If F_0.02
            is read at 2 % of the pair it is 0.16.

    Raises:
        InputError: Sizes not positive, forces not in the order F_0.02 <= F_inf <= F_0.
    """
    for name, value in (("thickness", thickness), ("area", area), ("travel", travel)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"{name} {value:g}", where=name, allowed="above 0")
    forces = (force_2_percent, asymptotic_force, peak_force)
    if not (np.all(np.isfinite(forces)) and 0.0 <= forces[0] < forces[1] <= forces[2]):
        raise InputError(
            f"F_0.02 = {force_2_percent:g} N, F_inf = {asymptotic_force:g} N, F_0 = "
            f"{peak_force:g} N",
            where="forces",
            allowed="0 <= F_0.02 < F_inf <= F_0",
            remedy="Compression counts positive; F_inf is read at the end of the hold",
        )
    short = (peak_force - force_2_percent) / (travel * thickness)
    long = (asymptotic_force - force_2_percent) / (travel * thickness)
    to_modulus = 2.0 * thickness / area
    return CompressionModuli(short, short * to_modulus, long, long * to_modulus)


@dataclass(frozen=True, slots=True)
class Compression:
    """A compression test of two stacked bonded blocks: its reading, Eq. 13 to 16, Young's modulus.

    ``shape_factor``: loaded over free area of one block, taken as square. ``factor``: apparent over
    Young's modulus, 1 + 2 k S^2.
    """

    name: str
    reading: RelaxationReading
    moduli: CompressionModuli
    shape_factor: float

    @property
    def factor(self) -> float:
        """Apparent over Young's modulus, 1."""
        return 1 + 2 * BONDED[0] * self.shape_factor**2

    @property
    def deviation(self) -> float:
        """Relative standard deviation of ``factor``."""
        return 2 * BONDED[1] * self.shape_factor**2 / self.factor


def compression(
    reading: RelaxationReading, thickness: float, area: float, name: str
) -> Compression:
    """Return the moduli of Eq. 13 to 16 of a reading.

    Blocks of ``thickness`` (m) and ``area`` (m^2), taken as square for their shape factor. The
    travel between F_0.02 and F_0 is that recorded.
    """
    moduli = compression_moduli(
        float(reading.force_2_percent),
        float(reading.peak_force),
        float(reading.final_force),
        thickness,
        area,
        travel=reading.peak_displacement / thickness - 0.02,
    )
    return Compression(name, reading, moduli, math.sqrt(area) / (4 * thickness))
