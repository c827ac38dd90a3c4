"""Cases with a known answer, computed with the same code as every run.

The closed forms stand in ``underfoot.reference``; here the solvers are held against them. A ball, a
lug, a squeezed lug, the inlet of a worn heel and a heel on two grids go through the solver of
soles; film and rough contact have checks of their own.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from underfoot.case import Case
from underfoot.compute.prepare import prepare_case
from underfoot.compute.solve import solved_motion
from underfoot.core import ConvergenceError
from underfoot.core.arrays import Array, Mask
from underfoot.core.threads import threads_limited
from underfoot.film import Film, film_pressure
from underfoot.fluid import glycerol_water_viscosity
from underfoot.material import RelaxationSpectrum
from underfoot.reference import contact, lubrication
from underfoot.rough_contact import steady_sliding
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.shoe import SoleMap
from underfoot.shoe.row_division import row_cells
from underfoot.sole_contact import half_space_compliance, solve_sliding
from underfoot.sole_contact.solver import SoleContact, SolverSettings

SOFT_FILM = 100.0, 0.04088
"""Load parameter M of a ball on a soft film and its film under the centre, h R / a^2, by another
solver extrapolated from 18, 27 and 36 cells in a radius (docs/physics/coupled_contact.md)."""
_SMOOTH = 1e-7  # m, of asperities that do not matter
_RIGID = 1e13  # Pa


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
    """Compute every check, from soles to film to contact to fluid.

    Raises:
        ConvergenceError: A sole whose contact did not converge.
    """
    glycerol = Check(
        "glycerol 50 % by mass at 25 degC, viscosity (Pa s)",
        glycerol_water_viscosity(0.5, 298.15, "mass"),
        5.00e-3,
        0.01,
        "Cheng 2008, table",
    )
    soles = (soft_ball, pressed_lug, squeezed_lug, inlet_of_a_worn_heel, heel_on_two_grids)
    parts = (inclined_bearing, squeeze_disc, hertz, westergaard, sliding_sinusoid)
    return [*(check() for check in (*soles, *parts)), glycerol]


def soft_ball() -> Check:
    """Film under a soft ball that slides on a full film of the load parameter M.

    M = F / (E' R^2) (eta V / (E' R))^(-3/4), E' = 2 E / (1 - nu^2).
    """
    radius, modulus, ratio, viscosity, speed, cells = 20e-3, 3e6, 0.49, 0.219, 0.7, 12
    plane = modulus / (1 - ratio**2)
    number, exact = SOFT_FILM
    force = number * (viscosity * speed / (2 * plane * radius)) ** 0.75 * 2 * plane * radius**2
    size = contact.hertz_point(force, radius, plane).half_width
    behind, ahead, aside = (round(reach * cells) for reach in (1.7, 2.6, 1.8))
    x = np.arange(-behind, ahead + 1, dtype=np.float64) * (size / cells)
    y = np.arange(-aside, aside + 1, dtype=np.float64) * (size / cells)
    sole = _sole(x, y, (x[:, None] ** 2 + y**2) / (2 * radius))
    body = half_space_compliance(
        sole.clearance.shape, sole.spacing, modulus=modulus, poisson_ratio=ratio
    )
    solved = solve_sliding(
        sole,
        body,
        ExponentialLaw(modulus, ratio, 2e-8),
        viscosity=viscosity,
        speed=speed,
        normal_force=force,
        settings=SolverSettings(pool_depth=1.0, start_film=2e-5, end_time=None),
    )
    central = _usable(solved).film_thickness[np.argmin(np.abs(x)), np.argmin(np.abs(y))]
    return Check(
        "sole solver: soft ball on a film, film under its centre (h R / a^2)",
        float(central) * radius / size**2,
        exact,
        0.02,
        "stored reference; Hamrock and Dowson 1978 within 12 %",
    )


def pressed_lug() -> Check:
    """Approach of a dry round lug with a sharp edge: the flat punch, F / (2 a E*)."""
    radius, modulus, ratio, force, cells = 8e-3, 4e6, 0.5, 200.0, 48
    place, inside, radius = _disc(radius, 2.6 * radius / cells, cells)
    sole = _sole(place, place, np.where(inside, 0.0, np.inf))
    body = half_space_compliance(inside.shape, sole.spacing, modulus=modulus, poisson_ratio=ratio)
    solved = solve_sliding(
        sole,
        body,
        ExponentialLaw(modulus, ratio, _SMOOTH),
        viscosity=None,
        speed=0.3,
        normal_force=force,
    )
    return Check(
        "sole solver: lug with a sharp edge, approach (m)",
        _usable(solved).approach,
        force * (1 - ratio**2) / (2 * radius * modulus),
        0.02,
        "Boussinesq 1885, flat punch",
    )


def squeezed_lug() -> Check:
    """Film under a rigid round lug that a constant load presses through it."""
    viscosity, force, start, rise, end, cells = 0.2, 20.0, 100e-6, 1e-4, 2e-2, 33
    place, inside, radius = _disc(8e-3, 8e-3 / 14, cells)
    solved = solve_sliding(
        _sole(place, place, np.where(inside, 0.0, np.inf)),
        half_space_compliance(inside.shape, 8e-3 / 14, modulus=_RIGID, poisson_ratio=0.0),
        ExponentialLaw(1e6, 0.5, _SMOOTH),
        viscosity=viscosity,
        speed=0.0,
        normal_force=force,
        settings=SolverSettings(start_film=start, rise_time=rise, end_time=end, pool_depth=1e-3),
    )
    given = {"viscosity": viscosity, "radius": radius, "start_gap": start, "load": force}
    return Check(
        "sole solver: squeezed lug, film after 20 ms (m)",
        float(_usable(solved).film_thickness[cells // 2, cells // 2]),
        float(lubrication.squeeze_disc_gap(end - rise / 2, **given)),
        0.01,
        "Stefan 1874",
    )


def inlet_of_a_worn_heel(corner: float = 30.3e-3) -> Check:
    """Film under a rigid facet that lies flat, with an inlet of 10 deg, on cells fine along it.

    A plane strip: what flows across is left out. ``corner`` (m) is where the inlet begins.
    """
    spacing, columns, film, slope = 1e-3, 16, 15e-6, math.tan(math.radians(10))
    viscosity, speed, pool = 0.219, 0.7, 0.6e-3
    load = _strip_load(film, corner, slope, pool, viscosity=viscosity, speed=speed)
    square, fine = (_strip(corner, slope, spacing, each) for each in (1, columns))
    none, empty = np.zeros(0, dtype=np.intp), np.zeros(0)
    cells = replace(row_cells(square, fine), south=none, north=none, overlap=empty, crossing=empty)
    solved = solve_sliding(
        replace(square, cells=cells),
        half_space_compliance(cells.shape, spacing, modulus=_RIGID, poisson_ratio=0.0),
        ExponentialLaw(1e6, 0.5, _SMOOTH),
        viscosity=viscosity,
        speed=speed,
        normal_force=spacing * load,
        settings=SolverSettings(pool_depth=pool, start_film=1e-4, end_time=None),
    )
    middle = int(np.searchsorted(square.x, corner / 2))
    return Check(
        "sole solver: rigid worn heel (plane strip), film under its facet (m)",
        float(_usable(solved).film_thickness[middle, 1]),
        film,
        0.02,
        "Reynolds 1886, closed form",
    )


def heel_on_two_grids() -> Check:
    """Load on the film of an untreaded work shoe in glycerol on cells of 1 mm and of 0.75 mm.

    1 mm is the grid for a first look. Coarser ones scatter by some percent about the answer, as
    their rows of cells meet the edges of the facet: 187, 167 and 179 N on 1.7, 1.5 and 1.25 mm.
    """
    case = Case(
        shoe="work_shoe_untreaded",
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion="slip_tester_g4",
        numerics={"cells_along": 16},
    )
    coarse, fine = (
        _usable(solved_motion(prepare_case(case, spacing))).fluid_load
        for spacing in (1e-3, 0.75e-3)
    )
    return Check(
        "sole solver: untreaded heel in glycerol, load on the film (N)",
        coarse,
        fine,
        0.05,
        "the same heel on finer cells",
    )


def _usable(solved: SoleContact) -> SoleContact:
    if not solved.status.usable:
        raise ConvergenceError(
            f"a check did not converge: {solved.status}",
            history=solved.residuals,
            where="validate",
            remedy=solved.remedy,
        )
    return solved


def _sole(x: Array, y: Array, clearance: Array, columns: int = 1) -> SoleMap:
    """Return the sole of a clearance (m), inf beside it."""
    land = np.isfinite(clearance)
    return SoleMap(
        x=x,
        y=y,
        clearance=clearance,
        inside=land,
        land=land,
        tread_depth=np.zeros_like(clearance),
        spacing=float(y[1] - y[0]),
        outline=np.zeros((2, 2)),
        columns=columns,
    )


def _disc(radius: float, spacing: float, cells: int) -> tuple[Array, Mask, float]:
    """Return centres, cells within the radius (m), and the radius of their area, m."""
    place = (np.arange(cells, dtype=np.float64) - (cells - 1) / 2) * spacing
    inside = np.hypot(place[:, None], place) < radius
    return place, inside, math.sqrt(np.count_nonzero(inside) / math.pi) * spacing


def _strip(corner: float, slope: float, spacing: float, columns: int) -> SoleMap:
    """Return one row of cells from 2 spacings behind a flat facet to its inlet and beyond."""
    count = math.ceil(corner / spacing) + 10
    x = ((np.arange(count * columns) + 0.5) / columns - 2) * spacing
    clearance = np.full((x.size, 3), np.inf)
    clearance[:, 1] = np.where(x < 0, np.inf, slope * np.maximum(x - corner, 0.0))
    return _sole(x, np.array([-1.0, 0.0, 1.0]) * spacing, clearance, columns)


def _strip_load(
    film: float, corner: float, slope: float, pool: float, *, viscosity: float, speed: float
) -> float:
    """Return the load per width (N/m) of a facet and its inlet up to the depth of the pool, m.

    dp/dx = 6 eta V (h_0 - h) / h^3 from p = 0 at the rear, x = 0, with h_0 such that p = 0 where h
    is the pool's depth.
    """
    squares = corner / film**2 + (1 / film - 1 / pool) / slope  # of 1 / h
    cubes = corner / film**3 + (1 / film**2 - 1 / pool**2) / (2 * slope)
    still = squares / cubes
    # the load is the moment of the pressure's slope about the rear, int p dx = -int x dp/dx dx;
    # with x = corner + (h - film) / slope, dx = dh / slope in the inlet
    origin = corner - film / slope

    def inlet(power: int) -> float:
        """Return int h^-power dh from the facet to the pool."""
        if power == 1:
            return math.log(pool / film)
        return (film ** (1 - power) - pool ** (1 - power)) / (power - 1)

    moment = 0.5 * corner**2 * (still - film) / film**3
    moment += (still * inlet(3) - inlet(2)) * origin / slope
    moment += (still * inlet(2) - inlet(1)) / slope**2
    return -6 * viscosity * speed * moment


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
