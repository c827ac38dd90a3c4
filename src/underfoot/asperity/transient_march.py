"""The state of a rough contact that is marched in time."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol

import numpy as np

from underfoot.core import InputError

from ._kernels.complementarity import ContactState, solve_on_grid, solve_with_mattress
from ._kernels.krylov import Workspace
from ._kernels.operators import Body, Operators
from ._kernels.prony_march import (
    PronyStep,
    advance_memory,
    known_displacement,
    prony_step,
    relaxed_memory,
)
from ._kernels.shift import ShiftedMap
from ._kernels.symbols import unit_compliance


class MaxwellSpectrum(Protocol):
    """A generalised Maxwell material (Young's moduli, Pa; relaxation times, s)."""

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


class March:
    """State of the march in scaled units (height over its rms, pressure over ``unit``)."""

    def __init__(
        self,
        floor: np.ndarray,
        shoe: np.ndarray,
        spacing: tuple[float, float],
        material: MaxwellSpectrum,
        speed: float,
        poisson_ratio: float,
        layer_thickness: float | None,
        time_step: float,
        tolerance: float,
        threads: int,
        fft: str,
    ) -> None:
        terms = np.asarray(material.term_moduli, dtype=float)
        self.instantaneous = float(material.equilibrium_modulus) + float(terms.sum())
        self.relaxed = float(material.equilibrium_modulus)
        self.fractions = terms / self.instantaneous
        rates = 1.0 / np.asarray(material.relaxation_times, dtype=float)
        self.time_step, self.tolerance, self.speed = time_step, tolerance, speed
        self.coefficients: PronyStep = prony_step(self.fractions, rates, time_step)
        self.rms = float(np.std(floor + shoe))
        if self.rms == 0.0:
            raise InputError("both surfaces are flat", where="floor_height")
        self.floor = ShiftedMap(floor / self.rms, spacing[0])
        self.shoe = shoe / self.rms
        self.unit = self.instantaneous * self.rms / (spacing[0] * min(floor.shape))
        self._body = Body(
            moduli=lambda qx: np.ones(qx.shape),
            unit=lambda q: unit_compliance(q, layer_thickness, poisson_ratio),
            spacing=spacing,
            scale=self.unit / self.rms,
            threads=threads,
            library=fft,
        )
        self.shape: tuple[int, int] = floor.shape
        self.workspace = Workspace(10, np)
        self.operators = self._operators(self.instantaneous * self.coefficients.stiffening)
        self.displacement = np.zeros(self.shape)
        self.memory = np.zeros((terms.size, *self.shape))
        self.failures = 0

    def rest(self, pressure: float | None, separation: float | None, start: str) -> ContactState:
        """Press the surfaces together before sliding and return the contact."""
        modulus = self.relaxed if start == "relaxed" else self.instantaneous
        moving, self.operators = self.operators, self._operators(modulus)
        height = self.floor.at(0.0) + self.shoe
        guess = np.maximum(height - np.quantile(height, 0.5), 0.0).astype(np.float32)
        state = self._contact(height, guess, pressure, separation)
        self.displacement = np.asarray(self.operators.displacement(state.pressure), dtype=float)
        if start == "relaxed":
            self.memory = relaxed_memory(self.displacement, self.fractions)
        self.operators = moving
        return state

    def step(
        self, distance: float, guess: np.ndarray, pressure: float | None, separation: float | None
    ) -> ContactState:
        """Advance by one time step to the floor's position ``distance``."""
        known = known_displacement(self.memory, self.displacement, self.coefficients)
        height = self.floor.at(distance) + self.shoe - known
        state = self._contact(height, guess, pressure, separation)
        new = known + self.operators.displacement(state.pressure)
        advance_memory(self.memory, self.displacement, new, self.coefficients)
        self.displacement = new
        return state

    def _contact(
        self,
        height: np.ndarray,
        guess: np.ndarray,
        pressure: float | None,
        separation: float | None,
    ) -> ContactState:
        if pressure is not None:
            return self._loaded(height, guess, pressure / self.unit)
        assert separation is not None
        return self._at_height(height, guess, separation / self.rms)

    def _loaded(self, height: np.ndarray, guess: np.ndarray, mean: float) -> ContactState:
        guess = guess * np.float32(mean / max(float(guess.mean()), 1e-30))
        for solver in (solve_on_grid, solve_with_mattress):
            state = solver(
                self.operators,
                height,
                guess,
                mean,
                self.workspace,
                tolerance=self.tolerance,
                max_steps=40,
                exact=False,
            )
            if state.converged:
                return state
        self.failures += 1
        return state  # pyright: ignore[reportPossiblyUnbound]  # the loop runs at least once

    def _at_height(self, height: np.ndarray, guess: np.ndarray, wanted: float) -> ContactState:
        """Return the contact whose mean planes are ``wanted`` apart: secant on the load."""
        if wanted >= float(height.max()):
            zero = np.zeros(self.shape, np.float32)
            return ContactState(zero, wanted - height, 0, 0, 0.0, True, [])
        mean = max(float(guess.mean()), 1e-6)
        before: tuple[float, float] | None = None
        state = self._loaded(height, guess, mean)
        for _ in range(30):
            miss = _separation(state, height, self.operators) - wanted
            if abs(miss) < 10.0 * self.tolerance:
                return state
            here = np.log(mean)
            slope = -1.0 if before is None else (miss - before[1]) / (here - before[0])
            before = (here, miss)
            change = np.clip(-miss / min(slope, -0.05), -1.5, 1.5)
            mean *= float(np.exp(change))
            state = self._loaded(height, np.asarray(state.pressure, np.float32), mean)
        self.failures += 1
        return state

    def _operators(self, modulus: float) -> Operators:
        body = replace(self._body, moduli=lambda qx: np.full(qx.shape, modulus))
        return Operators(body, self.shape)


def _separation(state: ContactState, height: np.ndarray, operators: Operators) -> float:
    """Return d of the solved contact: mean of height - A p where the surfaces touch."""
    touching = state.pressure > 0.0
    reach = height - operators.displacement(state.pressure)
    return float(reach[touching].mean())
