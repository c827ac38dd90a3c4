"""Sliding of rough rubber over a rough rigid floor, marched in time."""

from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from underfoot.block.prony_march import (
    PronyStep,
    advance_memory,
    known_displacement,
    prony_step,
    relaxed_memory,
)
from underfoot.core import Cancelled, InputError, Progress, Status, silent
from underfoot.core.checks import choice, host_array
from underfoot.core.remark import Message
from underfoot.core.threads import threads_limited
from underfoot.rough_contact._kernels.complementarity import ContactState, Search, solved_contacts
from underfoot.rough_contact._kernels.krylov import Workspace
from underfoot.rough_contact._kernels.operators import ElasticBody, Operators
from underfoot.rough_contact._kernels.periodic import ShiftedMap, unit_compliance
from underfoot.rough_contact.sliding_input import checked_contact_input


@dataclass(frozen=True, slots=True)
class TransientSettings:
    """How ``transient_sliding`` marches.

    ``start`` is "relaxed" (long rest before sliding) or "fresh" (pressed on at the instant sliding
    starts). ``steps_per_spacing`` are the time steps while the floor moves by one spacing: with 8
    nodes to the shortest wave, 2 keep the COF within 2 %, 1 within 5 % (second order). The run ends
    after ``max_periods`` passages of the whole floor map, or when the COF of two periods running
    agrees to ``steady_tolerance``, relative to the larger. ``tolerance`` is that on the contact of
    each step (penetration over rms height); ``threads`` and ``fft`` as in ``SlidingSettings``.
    """

    start: str = "relaxed"
    steps_per_spacing: int = 2
    max_periods: int = 8
    steady_tolerance: float = 5e-3
    tolerance: float = 1e-5
    threads: int = 1
    fft: str = "auto"

    def __post_init__(self) -> None:
        choice(self.start, ("relaxed", "fresh"), "start")
        for name in ("steps_per_spacing", "max_periods"):
            value = getattr(self, name)
            if value < 1:
                raise InputError(f"{name} {value}", where=name, allowed="1 or more")


class MaxwellSpectrum(Protocol):
    """A generalised Maxwell material: E_inf, E_i (Young's moduli, Pa) and tau_i (s)."""

    @property
    def equilibrium_modulus(self) -> float:
        """E_inf, Pa."""
        ...

    @property
    def term_moduli(self) -> np.ndarray:
        """E_i, Pa."""
        ...

    @property
    def relaxation_times(self) -> np.ndarray:
        """tau_i, s."""
        ...


class _March:
    """State of the march in scaled units (height over its rms, pressure over ``unit``).

    ``body`` is Poisson's ratio and layer thickness, ``held`` mean pressure (Pa) or separation (m),
    whichever is constant.
    """

    def __init__(
        self,
        floor: np.ndarray,
        shoe: np.ndarray,
        spacing: tuple[float, float],
        material: MaxwellSpectrum,
        speed: float,
        body: tuple[float, float | None],
        held: tuple[float | None, float | None],
        settings: TransientSettings,
    ) -> None:
        terms = np.asarray(material.term_moduli, dtype=float)
        self.instantaneous = float(material.equilibrium_modulus) + float(terms.sum())
        self.relaxed = float(material.equilibrium_modulus)
        self.fractions = terms / self.instantaneous
        rates = 1.0 / np.asarray(material.relaxation_times, dtype=float)
        self.speed, self.tolerance = speed, settings.tolerance
        self.pressure, self.separation = held
        self.time_step = spacing[0] / (speed * settings.steps_per_spacing)
        self.coefficients: PronyStep = prony_step(self.fractions, rates, self.time_step)
        self.rms = float(np.std(floor + shoe))
        if self.rms == 0.0:
            raise InputError("both surfaces are flat", where="floor_height")
        self.floor = ShiftedMap(floor / self.rms, spacing[0])
        self.shoe = shoe / self.rms
        self.unit = self.instantaneous * self.rms / (spacing[0] * min(floor.shape))
        self._body = ElasticBody(
            moduli=lambda qx: np.ones(qx.shape),
            unit=lambda q: unit_compliance(q, body[1], body[0]),
            spacing=spacing,
            scale=self.unit / self.rms,
            threads=settings.threads,
            library=settings.fft,
        )
        self.shape: tuple[int, int] = floor.shape
        self.workspace = Workspace(10, np)
        self.operators = self._operators(self.instantaneous * self.coefficients.stiffening)
        self.displacement = np.zeros(self.shape)
        self.memory = np.zeros((terms.size, *self.shape))
        self.failures = 0

    def rest(self, start: str) -> ContactState:
        """Press the surfaces together before sliding and return the contact."""
        modulus = self.relaxed if start == "relaxed" else self.instantaneous
        moving, self.operators = self.operators, self._operators(modulus)
        height = self.floor.at(0.0) + self.shoe
        guess = np.maximum(height - np.quantile(height, 0.5), 0.0).astype(np.float32)
        state = self._contact(height, guess)
        self.displacement = np.asarray(_displacement(self.operators, state.pressure), dtype=float)
        if start == "relaxed":
            self.memory = relaxed_memory(self.displacement, self.fractions)
        self.operators = moving
        return state

    def step(self, distance: float, guess: np.ndarray) -> ContactState:
        """Advance by one time step to the floor's position ``distance``."""
        known = known_displacement(self.memory, self.displacement, self.coefficients)
        height = self.floor.at(distance) + self.shoe - known
        state = self._contact(height, guess)
        new = known + _displacement(self.operators, state.pressure)
        advance_memory(self.memory, self.displacement, new, self.coefficients)
        self.displacement = new
        return state

    def physical(self, state: ContactState) -> tuple[np.ndarray, np.ndarray]:
        """Return pressure (Pa) and gap (m), both >= 0 and one of them 0 everywhere."""
        p = np.maximum(np.asarray(state.pressure, dtype=float), 0.0) * self.unit
        return p, np.where(p > 0.0, 0.0, np.maximum(state.gap, 0.0)) * self.rms

    def _contact(self, height: np.ndarray, guess: np.ndarray) -> ContactState:
        if self.pressure is not None:
            return self._press(height, guess, self.pressure / self.unit)
        assert self.separation is not None
        return self._at_height(height, guess, self.separation / self.rms)

    def _press(self, height: np.ndarray, guess: np.ndarray, mean: float) -> ContactState:
        guess = guess * np.float32(mean / max(float(guess.mean()), 1e-30))
        search = Search(self.tolerance, max_steps=40, exact=False)
        batch = height[None], guess[None], [mean]
        (state,) = solved_contacts(self.operators, *batch, self.workspace, search)
        state.pressure, state.gap = state.pressure[0], state.gap[0]
        self.failures += not state.converged
        return state

    def _at_height(self, height: np.ndarray, guess: np.ndarray, goal: float) -> ContactState:
        """Return the contact whose mean planes are ``goal`` apart: secant on the load."""
        if goal >= float(height.max()):
            zero = np.zeros(self.shape, np.float32)
            return ContactState(zero, goal - height, 0, 0.0, True, [])
        mean = max(float(guess.mean()), 1e-6)
        before: tuple[float, float] | None = None
        state = self._press(height, guess, mean)
        for _ in range(30):
            miss = _separation(state, height, self.operators) - goal
            if abs(miss) < 10.0 * self.tolerance:
                return state
            here = np.log(mean)
            slope = -1.0 if before is None else (miss - before[1]) / (here - before[0])
            before = (here, miss)
            change = np.clip(-miss / min(slope, -0.05), -1.5, 1.5)
            mean *= float(np.exp(change))
            state = self._press(height, np.asarray(state.pressure, np.float32), mean)
        self.failures += 1
        return state

    def _operators(self, modulus: float) -> Operators:
        body = replace(self._body, moduli=lambda qx: np.full(qx.shape, modulus))
        return Operators(body, (1, *self.shape))


def _displacement(operators: Operators, pressure: np.ndarray) -> np.ndarray:
    return operators.displacement(pressure[None])[0]


def _separation(state: ContactState, height: np.ndarray, operators: Operators) -> float:
    """Return d of the solved contact: mean of height - A p where the surfaces touch."""
    touching = state.pressure > 0.0
    reach = height - _displacement(operators, state.pressure)
    return float(reach[touching].mean())


@dataclass(frozen=True, slots=True, eq=False)
class TransientSliding:
    """History of a sliding contact; arrays have one value per time step.

    ``time`` (s) and ``distance`` (m) since the start of sliding; ``pressure`` the mean contact
    pressure (Pa); ``shear`` (Pa) the mean of pressure times floor slope: friction by hysteresis,
    positive against sliding; with a rough shoe it also swings elastically about its mean.
    ``real_contact_fraction`` is the share of nodes in contact, ``mean_gap`` in m. ``period_cof`` is
    mean shear over mean pressure in each period of the floor, ``cof_hysteresis`` that of the last
    whole one (NaN when none was finished). ``contact_pressure`` (Pa) and ``gap`` (m) are the last
    state in the frame of the rubber. ``steady``: two periods running agreed within the tolerance
    asked for. ``status`` and ``notes`` tell how it ended.
    """

    time: np.ndarray
    distance: np.ndarray
    pressure: np.ndarray
    shear: np.ndarray
    real_contact_fraction: np.ndarray
    mean_gap: np.ndarray
    period_cof: np.ndarray
    cof_hysteresis: float
    contact_pressure: np.ndarray
    gap: np.ndarray
    steady: bool
    status: Status
    notes: tuple[str, ...]


def transient_sliding(
    floor_height: ArrayLike,
    spacing: float | tuple[float, float],
    modulus: MaxwellSpectrum,
    speed: float,
    *,
    pressure: float | None = None,
    separation: float | None = None,
    shoe_height: ArrayLike | None = None,
    poisson_ratio: float = 0.5,
    layer_thickness: float | None = None,
    settings: TransientSettings | None = None,
    progress: Progress = silent,
) -> TransientSliding:
    """Return the history of rough rubber sliding along +x over a rough floor.

    In the frame of the rubber the floor passes underneath. With E(t) = E0 [1 - sum g_i
    (1 - exp(-b_i t))] and a displacement linear within a step, each step is an elastic contact
    with modulus m E0 and a known displacement U: u = U + A p, gap = d + u - h_floor - h_shoe >= 0,
    p >= 0, p gap = 0. Exact in time for a displacement linear in time, second order otherwise, for
    any number of terms; terms much faster than a step act through E0.

    Parameters:
        floor_height, shoe_height: m, (nx, ny), periodic, each positive out of its own body; None:
            smooth rubber.
        spacing: m, one number or (along axis 0, along axis 1).
        modulus: Generalised Maxwell material (Young's moduli).
        speed: m/s, > 0.
        pressure, separation: Exactly one: mean pressure (Pa, > 0) for a fixed load, or the distance
            of the mean planes of deformed rubber and floor (m) for a fixed height.
        poisson_ratio, layer_thickness: As in ``steady_sliding``.
        settings: Start, steps, periods, tolerances, threads.
        progress: As in ``steady_sliding``; ``Cancelled`` raised by it ends the run early.

    Raises:
        InputError: As ``steady_sliding``; a material without relaxation terms; both or neither of
            pressure and separation; maps of different shape.

    Source: recursive convolution of Taylor, Pister and Goudreau (1970) Int. J. Numer. Methods Eng.
    2:45, with the half-space of Johnson (1985) Contact Mechanics, chapter 13.
    """
    if (pressure is None) == (separation is None):
        raise InputError(
            "give the pressure (fixed load) or the separation (fixed height), one of them",
            where="pressure, separation",
        )
    load = 1.0 if pressure is None else pressure
    floor, steps = checked_contact_input(
        host_array(floor_height, "floor_height", "a map of NumPy, m"),
        spacing,
        speed,
        load,
        poisson_ratio,
        layer_thickness,
    )
    shoe = np.zeros_like(floor)
    if shoe_height is not None:
        shoe, _ = checked_contact_input(
            host_array(shoe_height, "shoe_height", "a map of NumPy, m"),
            spacing,
            speed,
            load,
            poisson_ratio,
            layer_thickness,
        )
    if shoe.shape != floor.shape:
        raise InputError(
            f"shoe map {shoe.shape} on floor map {floor.shape}",
            where="shoe_height",
            allowed="the same shape and spacing",
        )
    _check_material(modulus, speed)
    settings = settings or TransientSettings()
    with threads_limited(settings.threads):
        march = _March(
            floor - floor.mean(),
            shoe - shoe.mean(),
            steps,
            modulus,
            speed,
            (poisson_ratio, layer_thickness),
            (pressure, separation),
            settings,
        )
        return _run(march, settings, progress)


def _run(march: _March, settings: TransientSettings, progress: Progress) -> TransientSliding:
    rows: list[tuple[float, float, float, float, float, float]] = []
    cofs: list[float] = []
    status, steady = Status.CONVERGED, False
    notes: list[str] = []
    state = march.rest(settings.start)
    period = march.shape[0] * settings.steps_per_spacing
    total = period * settings.max_periods
    pixel = march.speed * march.time_step
    try:
        for n in range(1, total + 1):
            progress("transient sliding", n / total, None)
            guess = np.maximum(np.asarray(state.pressure, dtype=np.float32), 0.0)
            # the floor moves towards -x in the frame of the rubber
            guess = np.maximum(guess, 0.5 * np.roll(guess, -1, axis=0))
            state = march.step(n * pixel, guess)
            p, gap = march.physical(state)
            slope = march.floor.slope_at(n * pixel) * march.rms
            rows.append(
                (
                    n * march.time_step,
                    n * pixel,
                    float(p.mean()),
                    float((p * slope).mean()),
                    float(np.count_nonzero(p > 0.0)) / p.size,
                    float(gap.mean()),
                )
            )
            if n % period == 0:
                last = np.array(rows[-period:])
                normal = float(last[:, 2].mean())
                cofs.append(float(last[:, 3].mean()) / normal if normal > 0.0 else float("nan"))
                steady = len(cofs) > 1 and _agree(cofs[-1], cofs[-2], settings.steady_tolerance)
                if steady:
                    break
    except Cancelled:
        status = Status.CANCELLED
        notes.append(f"cancelled after {len(rows)} steps")
    if march.failures:
        status = Status.NOT_CONVERGED
        notes.append(f"{march.failures} of {len(rows)} contact steps did not reach the tolerance")
    elif status is Status.CONVERGED and not steady:
        status = Status.NOT_CONVERGED
        notes.append(
            f"not steady after {settings.max_periods} periods: slow relaxation terms are still "
            "running; raise max_periods or leave out terms slower than the run"
        )
    p, gap = march.physical(state)
    return TransientSliding(
        *np.array(rows).reshape(-1, 6).T,
        period_cof=np.array(cofs),
        cof_hysteresis=cofs[-1] if cofs else float("nan"),
        contact_pressure=p,
        gap=gap,
        steady=steady,
        status=status,
        notes=tuple(notes),
    )


def _agree(first: float, second: float, tolerance: float) -> bool:
    return abs(first - second) <= tolerance * max(abs(first), abs(second), 1e-9)


def _check_material(modulus: Any, speed: float) -> None:
    for name in ("equilibrium_modulus", "term_moduli", "relaxation_times"):
        if not hasattr(modulus, name):
            raise InputError(
                f"modulus is a {type(modulus).__name__} without {name}",
                where="modulus",
                allowed="a generalised Maxwell material, such as material.RelaxationSpectrum",
                remedy="A march in time needs relaxation terms; steady_sliding takes any E*",
            )
    if not modulus.equilibrium_modulus > 0.0:
        raise InputError(
            Message("equilibrium modulus {modulus} Pa", modulus=modulus.equilibrium_modulus),
            where="modulus",
            allowed="above 0 Pa: a liquid can't carry the mean pressure",
        )
    if not speed > 0.0:
        raise InputError(f"speed {speed} m/s", where="speed", allowed="above 0 m/s")
