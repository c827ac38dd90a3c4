"""Settings and arrays of an explicit march: element constants in chunks, nodes, contact, state."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core import InputError
from underfoot.core.checks import choice, not_negative, positive

from ._kernels import generate, names
from ._kernels.loops import element_loops
from .inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from .mesh import BlockMesh, block_mesh, check_pattern, layer_heights

MASS_SCALING_FACTOR = 5.0
"""Relative error of area over force per (speed / shear wave speed)^2; measured, see the page."""
MASS_SCALING_ALLOWED = 0.01
IMPACT_ALLOWED = 1e-4
"""Friction that the meeting of lower nodes and floor may add, over normal force."""
LARGEST_MASS_SCALING = 1000.0


@dataclass(frozen=True, slots=True)
class ExplicitSettings:
    """Settings of ``explicit_sliding``.

    Parameters:
        cfl: Time step over the critical one of the undeformed mesh; None: 0.6 (squeezed elements
            ask for less than 0.7), or 0.4 with a viscous form, which lowers the critical step.
        time_step: s; None takes ``cfl``.
        hourglass: "stiffness" (elastic, from a potential) or "viscous" (Flanagan and Belytschko
            1981, what explicit codes do by default: it makes friction of its own).
        hourglass_coefficient: None: 2 (about the stiffness of eight-point integration), or 0.1 for
            the viscous form.
        hourglass_modulus: Pa; None: G'(omega) at the frequency of the floor's asperities passing.
        penalty_factor: Contact stiffness in units of (K + 4 G / 3) / bottom layer. None: the larger
            of 0.5 and what sinks by 0.3 % of the roughness under the mean pressure, at most 1.5. A
            bulk modulus lowered for speed would soften the contact with it.
        penalty_stiffness: Pa/m, in place of ``penalty_factor``.
        contact_damping: Share of critical damping at the contact nodes, only while they press.
            Without it nodes chatter as they meet the floor, and 2 % of the real contact area is
            lost; it takes no energy to speak of (the ledger has it).
        bulk_viscosity: Linear coefficient, in compression only (0.06 in common codes; makes
            friction of its own).
        mass_scaling: Factor on the density; "auto" takes the largest one (up to 1000) with an error
            bound of 1 % on area over force and of 1e-4 on the COF (``impact_friction``).
        precision: "double" or "single" (element arithmetic and history only).
        samples_per_wavelength: Of the history; every value is the mean of all steps since the last.
    """

    cfl: float | None = None
    time_step: float | None = None
    hourglass: str = "stiffness"
    hourglass_coefficient: float | None = None
    hourglass_modulus: float | None = None
    penalty_factor: float | None = None
    penalty_stiffness: float | None = None
    contact_damping: float = 0.3
    bulk_viscosity: float = 0.0
    mass_scaling: float | str = 1.0
    precision: str = "double"
    samples_per_wavelength: int = 200

    def __post_init__(self) -> None:
        choice(self.hourglass, ("stiffness", "viscous"), "hourglass")
        choice(self.precision, ("double", "single"), "precision")
        if self.cfl is not None and not 0.0 < self.cfl < 1.0:
            raise InputError(f"{self.cfl:g}", where="cfl", allowed="0 to 1; 0.6 is sound")
        if isinstance(self.mass_scaling, str):
            if self.mass_scaling != "auto":
                raise InputError(
                    f'"{self.mass_scaling}"', where="mass_scaling", allowed='a factor or "auto"'
                )
        elif not (math.isfinite(self.mass_scaling) and self.mass_scaling >= 1.0):
            raise InputError(
                f"{self.mass_scaling:g}", where="mass_scaling", allowed="1 or more, or auto"
            )
        for name in (
            "time_step",
            "hourglass_coefficient",
            "hourglass_modulus",
            "penalty_factor",
            "penalty_stiffness",
        ):
            if getattr(self, name) is not None:
                positive(getattr(self, name), name)
        for name in ("contact_damping", "bulk_viscosity"):
            not_negative(getattr(self, name), name)
        if self.samples_per_wavelength < 20:
            raise InputError(
                f"{self.samples_per_wavelength}",
                where="samples_per_wavelength",
                allowed="20 or more",
            )

    @property
    def viscous(self) -> bool:
        """True when hourglass control or bulk viscosity takes energy."""
        return self.hourglass == "viscous" or self.bulk_viscosity > 0.0


def mass_scaling_error(speed: float, shear_wave_speed: float, factor: float) -> float:
    """Return the bound on the relative error of area over force, 5 factor (v / c_s)^2."""
    return MASS_SCALING_FACTOR * factor * (speed / shear_wave_speed) ** 2


def largest_mass_scaling(speed: float, shear_wave_speed: float, impact: float = 0.0) -> float:
    """Return the largest factor within both bounds, at least 1 and at most 1000.

    1 % on area over force, and 1e-4 on the COF; ``impact`` is ``impact_friction`` unscaled.
    """
    error = mass_scaling_error(speed, shear_wave_speed, 1.0)
    allowed = [LARGEST_MASS_SCALING]
    allowed += [MASS_SCALING_ALLOWED / error] if error > 0.0 else []
    allowed += [IMPACT_ALLOWED / impact] if impact > 0.0 else []
    return max(min(allowed), 1.0)


LANES = generate.LANES
SINKING = 0.003
"""Share of the roughness that the mean pressure may press into the contact's springs."""


@dataclass(frozen=True, slots=True, eq=False)
class Assembly:
    """Everything that ``advance`` takes; ``nodes``, ``history`` and ``state`` change."""

    mesh: BlockMesh
    nodes: tuple[np.ndarray, ...]  # displacement, velocity, internal force: each axis by axis
    arrays: tuple[np.ndarray, ...]  # as the kernels take them, and the floor
    floor: tuple[int, np.ndarray, np.ndarray, float]
    constants: np.ndarray  # of the elements, by chunks, and their history
    history: np.ndarray
    parameters: np.ndarray  # numbers of the material
    work: np.ndarray  # scratch
    state: np.ndarray  # as ``_kernels.names`` names it, and what controls it
    control: np.ndarray
    terms: np.ndarray  # G_i and b_i of each term
    time_step: float  # s
    density: float  # kg/m^3, scaled
    penalty: float  # Pa/m
    mass_scaling: float
    impact_friction: float  # bound on the COF that lower nodes meeting the floor add
    kernel: str

    @property
    def displacement(self) -> np.ndarray:
        """Displacement of the mesh's nodes, m, (3, n)."""
        return self.nodes[0].reshape(3, -1)[:, : self.mesh.nodes.shape[1]]

    @property
    def velocity(self) -> np.ndarray:
        """Velocity of the mesh's nodes, m/s, (3, n)."""
        return self.nodes[1].reshape(3, -1)[:, : self.mesh.nodes.shape[1]]

    def advance(self, count: int) -> None:
        """March ``count`` steps."""
        getattr(element_loops(), self.kernel)(
            count,
            self.nodes,
            self.arrays,
            self.constants,
            self.history,
            self.parameters,
            self.work,
            self.floor,
            self.state,
            self.control,
            self.terms,
        )


def assemble_march(
    block: MicroBlock,
    floor: MicroSurface,
    material: MicroMaterial,
    loading: MicroLoading,
    settings: ExplicitSettings,
) -> Assembly:
    """Return the arrays of a march at rest, the block's lowest point touching the floor.

    Raises:
        InputError: A mesh that can't carry a roughness, a time step above the critical one, a
            contact stiffer than the step allows.
    """
    mesh = block_mesh(block)
    check_pattern(block, floor, "floor")
    spectrum = material.shear
    g0, bulk = spectrum.instantaneous_modulus, material.bulk_modulus
    shear_speed = material.wave_speeds[1]
    scaling = settings.mass_scaling
    unscaled = impact_friction(block, floor, material.density, loading)
    if isinstance(scaling, str):
        scaling = largest_mass_scaling(loading.speed, shear_speed, unscaled)
    density = material.density * scaling
    confined = bulk + 4.0 / 3.0 * g0
    critical = critical_time_step(mesh.largest_gradient_square(), confined, density)
    cfl = settings.cfl or (0.4 if settings.viscous else 0.6)
    dt = cfl * critical if settings.time_step is None else settings.time_step
    if dt >= critical:
        raise InputError(
            f"a time step of {dt:.4g} s",
            where="ExplicitSettings.time_step",
            allowed=f"below the critical {critical:.4g} s of this mesh and material",
            remedy=f"Use {0.6 * critical:.3g} s, or leave it out",
        )
    frequency = 2.0 * math.pi * loading.speed / floor.wavelength
    modulus = settings.hourglass_modulus or float(spectrum.storage_modulus(frequency))
    dtype = np.float64 if settings.precision == "double" else np.float32
    viscous = settings.viscous
    constants, real = _element_constants(
        mesh, settings, modulus, density, math.sqrt(confined / density), dt, dtype
    )

    stride = constants.shape[0] * LANES + int(mesh.offsets.max()) + 1
    stride = max(stride, mesh.nodes.shape[1])
    rates = 1.0 / spectrum.relaxation_times
    terms = np.stack([spectrum.term_moduli, rates], axis=1)
    terms = np.ascontiguousarray(terms[terms[:, 0] > 0.0])
    kind = {0: "none", 1: "one"}.get(len(terms), "many")
    rows = 6 * len(terms) + (generate.VISCOUS_ROWS if viscous else 0)
    share = terms[:, 0] / g0
    numbers = [0.5, 1.0 / 3.0, 1.0, 4.0, 0.125, g0, bulk]
    for g, b in zip(share, terms[:, 1], strict=True):
        numbers += [math.exp(-b * dt), -g * math.expm1(-b * dt)]

    mass = _lumped_mass(mesh, density, stride, block.sides == "periodic")
    unit = confined / float(layer_heights(block)[1])
    penalty = settings.penalty_stiffness
    if penalty is None:
        factor = settings.penalty_factor
        if factor is None:
            rough = [s.peak_to_valley for s in (block.roughness, floor) if s.peak_to_valley > 0.0]
            stiff_enough = loading.mean_pressure / (SINKING * min(rough)) / unit if rough else 0.0
            factor = min(max(0.5, stiff_enough), 1.5)
        penalty = factor * unit
    arrays, floor_arrays = _contact_arrays(mesh, floor, penalty, mass, real)
    worst = float(np.max(arrays[5] * mass[1][: arrays[5].size])) * dt**2
    if worst > 1.5:
        raise InputError(
            f"a contact stiffness of {penalty:.3g} Pa/m",
            where="ExplicitSettings.penalty_stiffness",
            allowed=f"at most {1.5 / worst * penalty:.3g} Pa/m at this time step",
        )
    control = np.zeros(names.CONTROL_SIZE)
    weight = density * block.nominal_area * block.size[2]
    # The softer of the block and of its rough contact: with more drag a hard block only creeps.
    spring = 3.0 * g0 * block.nominal_area / block.size[2]
    deepest = max(s.peak_to_valley for s in (block.roughness, floor))
    if deepest > 0.0:
        spring = min(spring, loading.mean_pressure * block.nominal_area / (0.5 * deepest))
    control[names.DT] = dt
    control[names.PLATE_MASS] = weight
    control[names.PLATE_DAMPING] = 1.4 * math.sqrt(2.0 * weight * spring)
    control[names.SPEED] = loading.speed
    control[names.SLIDE_START] = math.inf
    control[names.ZETA] = settings.contact_damping
    control[[names.COLUMNS, names.ROWS, names.LAYERS]] = mesh.shape
    control[names.PERIODIC] = float(block.sides == "periodic")
    control[names.G0], control[names.BULK] = g0, bulk
    return Assembly(
        mesh=mesh,
        nodes=(np.zeros(3 * stride), np.zeros(3 * stride), np.zeros(3 * stride)),
        arrays=arrays,
        floor=floor_arrays,
        constants=constants,
        history=np.zeros((constants.shape[0], rows * LANES), dtype),
        parameters=np.array(numbers, dtype),
        work=np.zeros(generate.WORK_ROWS * LANES, dtype),
        state=np.zeros(names.STATE_SIZE),
        control=control,
        terms=terms,
        time_step=dt,
        density=density,
        penalty=penalty,
        mass_scaling=float(scaling),
        impact_friction=float(scaling) * unscaled,
        kernel=generate.kernel_name(kind, viscous).replace("element_forces", "advance"),
    )


def impact_friction(
    block: MicroBlock, floor: MicroSurface, density: float, loading: MicroLoading
) -> float:
    """Return a bound on the COF that inertia adds: rho h (v s)^2 / (p w); 0 without waves.

    Every wavelength w each lower node meets the floor once, with the floor's slope s times the
    speed; what it and the lowest layer (thickness h) then have of kinetic energy goes to waves in
    the block, which nothing brings back. s^2 is the mean square slope times 4 (the square of the
    largest slope of a checkerboard), p the mean pressure.
    Measured in loss-free neolite: 0.07 to 0.6 of the bound, see the page.
    """
    if not floor.rough or floor.form == "paraboloid":
        return 0.0
    x, y = (size * (np.arange(128) + 0.5) / 128 for size in block.size[:2])
    slope = floor.height_and_slope(x[:, None], y[None, :])[1]
    energy = density * float(layer_heights(block)[1]) * 4.0 * float(np.mean(slope**2))
    return energy * loading.speed**2 / (loading.mean_pressure * floor.wavelength)


def critical_time_step(gradient_square: np.ndarray, modulus: float, density: float) -> float:
    """Return 2 / omega_max with omega^2 = 8 (K + 4 G / 3) / rho * largest eigenvalue of B B^T."""
    return 2.0 / math.sqrt(8.0 * modulus / density * float(gradient_square.max()))


def _element_constants(
    mesh: BlockMesh,
    settings: ExplicitSettings,
    modulus: float,
    density: float,
    sound: float,
    dt: float,
    dtype: Any,
) -> tuple[np.ndarray, np.ndarray]:
    """Return constants by chunks; elements past the end of a row are all zero."""
    count = mesh.elements.size
    rows = np.zeros((count, generate.ELEMENT_ROWS))
    rows[:, :21] = mesh.gradient.reshape(count, 21)
    rows[:, 21:33] = mesh.hourglass_shape.reshape(count, 12)
    rows[:, 33] = mesh.volume
    length = np.cbrt(mesh.volume)
    if settings.hourglass == "stiffness":
        coefficient = settings.hourglass_coefficient or 2.0
        square = 8.0 * np.sum(mesh.gradient**2, axis=(1, 2))
        rows[:, 34] = coefficient * modulus * mesh.volume * square
    else:
        coefficient = settings.hourglass_coefficient or 0.1
        rows[:, 35] = 16.0 * coefficient * density * length**2 * sound / dt
    rows[:, 36] = settings.bulk_viscosity * density * sound * length / dt
    chunks = int(mesh.elements.max()) // LANES + 1
    constants = np.zeros((chunks, generate.ELEMENT_ROWS, LANES), dtype)
    constants[mesh.elements // LANES, :, mesh.elements % LANES] = rows
    return constants.reshape(chunks, -1), mesh.elements.astype(np.int64)


def _lumped_mass(
    mesh: BlockMesh, density: float, stride: int, periodic: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Return mass, its inverse, mass counted once (stride,), and the mass of the top."""
    mass = np.zeros(stride)
    for offset in mesh.offsets:
        mass[mesh.elements + offset] += density * mesh.volume / 8.0
    nx, ny, nz = mesh.shape
    count = nx * ny * nz
    top = float(mass[count - nx * ny : count].sum())
    once = mass.copy()
    if periodic:
        grid = mass[:count].reshape(nz, ny, nx)
        grid[:, :, 0] += grid[:, :, -1]
        grid[:, :, -1] = grid[:, :, 0]
        grid[:, 0, :] += grid[:, -1, :]
        grid[:, -1, :] = grid[:, 0, :]
        once = mass.copy()
        single = once[:count].reshape(nz, ny, nx)
        single[:, :, -1] = 0.0
        single[:, -1, :] = 0.0
    inverse = np.divide(1.0, mass, out=np.zeros_like(mass), where=mass > 0.0)
    return mass, inverse, once, top


def _contact_arrays(
    mesh: BlockMesh,
    floor: MicroSurface,
    penalty: float,
    mass: tuple[np.ndarray, np.ndarray, np.ndarray, float],
    real: np.ndarray,
) -> tuple[tuple[np.ndarray, ...], tuple[int, np.ndarray, np.ndarray, float]]:
    plane = mesh.shape[0] * mesh.shape[1]
    x, y, z = (np.ascontiguousarray(axis[:plane]) for axis in mesh.nodes)
    form, numbers, coefficients = floor.kernel_arrays()
    gap = z - floor.height(x, y)
    z = z - float(gap[mesh.lower_area > 0.0].min())
    highest = float(np.abs(coefficients).max()) if floor.form == "map" else float(numbers[0])
    stiffness = penalty * mesh.lower_area
    root = np.sqrt(stiffness * mass[0][:plane])
    arrays = (
        mesh.offsets.astype(np.int64),
        x,
        y,
        z,
        mesh.lower_area,
        stiffness,
        root,
        mass[1],
        mass[2],
        np.array([mass[3]]),
        real,
        np.ones((3, plane)),
    )
    return arrays, (form, numbers, coefficients, highest)
