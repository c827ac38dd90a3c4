"""Cases with a known exact answer, computed with the same code as every run.

The closed forms stand in ``underfoot.reference``; here the solvers are held against them.
"""

import math
from dataclasses import dataclass

import numpy as np

from underfoot.core.threads import threads_limited
from underfoot.film import Film, film_pressure
from underfoot.fluid import glycerol_water_viscosity
from underfoot.material import RelaxationSpectrum
from underfoot.reference import contact, lubrication
from underfoot.rough_contact import steady_sliding


@dataclass(frozen=True, slots=True)
class Check:
    """One computed number beside its exact value."""

    name: str
    computed: float
    exact: float
    tolerance: float
    source: str

    @property
    def relative_error(self) -> float:
        """|computed - exact| / |exact|, 1."""
        return abs(self.computed - self.exact) / abs(self.exact)

    @property
    def passed(self) -> bool:
        """True within the tolerance."""
        return self.relative_error <= self.tolerance


@threads_limited(1)
def checks() -> list[Check]:
    """Compute every check, from film to contact to fluid."""
    glycerol = Check(
        "glycerol 50 % by mass at 25 degC, viscosity (Pa s)",
        glycerol_water_viscosity(0.5, 298.15, "mass"),
        5.00e-3,
        0.01,
        "Cheng 2008, table",
    )
    solved = (inclined_bearing, squeeze_disc, hertz, westergaard, sliding_sinusoid)
    return [*(check() for check in solved), glycerol]


def inclined_bearing() -> Check:
    """Load of a wide inclined bearing by the film solver."""
    length, cells, rows = 0.02, 256, 3
    spacing = length / cells
    x = np.arange(cells + 1) * spacing  # the outermost cell centres are the edges of the pad
    low, high = 20e-6, 45e-6
    gap = np.repeat((low + (high - low) * x / length)[:, None], rows, axis=1)
    film = np.zeros(gap.shape, dtype=bool)
    film[1:-1, :] = True
    solved = film_pressure(Film(gap, spacing=spacing, viscosity=0.219, speed=0.7, mask=film))
    exact = lubrication.inclined_bearing_load(
        viscosity=0.219, speed=0.7, length=length, leading_gap=high, trailing_gap=low
    )
    return Check(
        "wide inclined bearing, load per width (N/m)",
        solved.load / (rows * spacing),
        exact,
        1e-3,
        "Reynolds 1886",
    )


def squeeze_disc() -> Check:
    """Load of a disc that sinks through a film."""
    radius, cells = 0.015, 384
    spacing = 2.2 * radius / cells
    place = (np.arange(cells) + 0.5) * spacing - 1.1 * radius
    inside = np.hypot(*np.meshgrid(place, place, indexing="ij")) < radius
    film = Film(np.full(inside.shape, 50e-6), spacing, viscosity=0.219, speed=0.0, mask=inside)
    step = 1e-6  # s; the gap falls by a thousandth of a micrometre
    solved = film_pressure(film, before=50e-6 + 1e-3 * step, time_step=step)
    exact = lubrication.squeeze_disc_load(
        viscosity=0.219, radius=radius, gap=50e-6, closing_speed=1e-3
    )
    return Check("squeeze disc, load (N)", solved.load, exact, 0.01, "Stefan 1874")


def hertz() -> Check:
    """Contact radius of a sphere on an elastic half-space, from the contact area."""
    cells, side, radius, modulus = 256, 1e-3, 1e-3, 2e6
    spacing = side / cells
    place = (np.arange(cells) - cells / 2) * spacing
    x, y = np.meshgrid(place, place, indexing="ij")
    force = 2e-3
    solved = steady_sliding(-(x**2 + y**2) / (2 * radius), spacing, modulus, 0.0, force / side**2)
    exact = contact.hertz_point(force, radius, modulus / 0.75)
    area = solved.real_contact_fraction_corrected * side**2
    return Check(
        "sphere on a half-space, contact radius (m)",
        math.sqrt(area / math.pi),
        exact.half_width,
        5e-3,
        "Hertz 1882; periodic images add to it",
    )


def westergaard() -> Check:
    """Contact fraction of a sinusoid in partial contact."""
    cells, wavelength, amplitude, modulus = 512, 1e-3, 10e-6, 2e6
    x = np.arange(cells) * wavelength / cells
    height = np.repeat((amplitude * np.cos(2 * np.pi * x / wavelength))[:, None], 8, axis=1)
    full = contact.sinusoid_full_contact_pressure(amplitude, wavelength, modulus / 0.75)
    solved = steady_sliding(height, wavelength / cells, modulus, 0.0, 0.3 * full)
    exact = float(contact.sinusoid_contact_fraction(0.3 * full, full))
    return Check(
        "sinusoid in partial contact, contact fraction",
        solved.real_contact_fraction,
        exact,
        2e-3,
        "Westergaard 1939",
    )


def sliding_sinusoid() -> Check:
    """Hysteresis friction of a sinusoid in full contact with a viscoelastic half-space."""
    cells, wavelength, amplitude, speed, pressure = 64, 0.4e-3, 2e-6, 0.1, 3e5
    rubber = RelaxationSpectrum(1.2e6, np.array([0.8e6, 0.6e6]), np.array([1e-3, 1e-4]))
    x = np.arange(cells) * wavelength / cells
    height = np.repeat((amplitude * np.cos(2 * np.pi * x / wavelength))[:, None], 8, axis=1)
    solved = steady_sliding(height, wavelength / cells, rubber, speed, pressure)
    modulus = rubber.complex_modulus(np.array(2 * np.pi / wavelength * speed)) / 0.75
    exact = float(contact.sliding_sinusoid_cof(pressure, amplitude, wavelength, modulus))
    return Check(
        "sliding sinusoid, hysteresis COF",
        solved.cof_hysteresis,
        exact,
        1e-3,
        "q^2 a^2 Im E*(qv) / (4 p)",
    )
