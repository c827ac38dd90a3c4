"""How a fluid thins as it warms, and how warm sliding makes it."""

import math

import numpy as np

from .cheng_2008 import glycerol_water_viscosity

ROOM = 295.65
"""K: middle of the "approximately 20-25 C" at which viscosities were read (report, G.2.1)."""
ROOM_DEVIATION = 5 / math.sqrt(12)
"""K: standard deviation of a temperature anywhere between 20 and 25 C."""
OIL_ENERGY = 25.5e3
"""J/mol: activation energy of the viscosity of vegetable oils, 21 to 30 kJ/mol (L. M. Diamante and
T. Lan, J. Food Process. 2014:234583); taken for other oils too (assumed)."""
GAS_CONSTANT = 8.314
SOLE, FLOOR = math.sqrt(0.17 * 1500 * 1470), math.sqrt(0.19 * 1200 * 1470)
"""W s^0.5 / (m^2 K): effusivity of rubber and of vinyl tiles (CIBSE Guide A, Table 3.36)."""


def viscosity_slope(viscosity: float, *, oil: bool = False) -> float:
    """Return -d ln(viscosity) / dT at 22.5 C, 1/K.

    Of an oil E / (R T^2), E = 25.5 kJ/mol; of any other fluid that of glycerol in water of the same
    ``viscosity`` (Pa s; Cheng 2008): 0.024 of water, 0.07 of 90 % glycerol.
    """
    if oil:
        return OIL_ENERGY / (GAS_CONSTANT * ROOM**2)
    shares = np.linspace(0.0, 1.0, 201)
    cold, warm = (np.log(glycerol_water_viscosity(shares, ROOM + d)) for d in (-0.5, 0.5))
    return float(np.interp(math.log(viscosity), 0.5 * (cold + warm), cold - warm))


def sliding_heat(cof: float, pressure: float, speed: float, length: float) -> float:
    """Return by how much sliding warms the two faces, K, if all heat goes into them.

    2 q sqrt(t / pi) / (e_sole + e_floor), q = cof p V the heat of friction (pressure in Pa, speed
    in m/s), t = length / V the time in which a place of the floor is passed (length of contact
    along the sliding, m): two half-spaces under an even source (Carslaw and Jaeger 1959, 2.9).
    """
    return 2 * cof * pressure * math.sqrt(speed * length / math.pi) / (SOLE + FLOOR)
