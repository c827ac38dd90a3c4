"""How far the numbers of a run may lie from those of endlessly fine cells and steps."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from underfoot.core import InputError, Progress, SourcedValue, display, silent
from underfoot.core.remark import NOTHING, Amount, Message, join_lines
from underfoot.friction import SampledCof
from underfoot.friction.propagation import normal_draws
from underfoot.sole_contact.solver import SoleContact

from .contact_friction import friction_sums
from .numbers import readings
from .position_draws import (
    COF_PARTS,
    LOADS,
    ON_CONTACT,
    ShoeAngles,
    TreadPlace,
    TreadPositions,
    log_film_odds,
)
from .positions import CLOSEST, RATES, remembers
from .prepare import Prepared
from .sensors import scan_reading
from .sole import RESOLVED, cells_along, tread_on_sole
from .solve import Solution, solved_at

BETWEEN_GRIDS = {
    True: {"fluid_load": (0.05, 0.2), "cof_viscous": (0.01, 0.02), "cof": (0.002, 0.004)},
    False: {"fluid_load": (0.03, 0.2), "cof_viscous": (0.01, 0.05), "cof": (0.002, 0.04)},
}
"""Standard deviations with lugs and without, of the grid of a run that a coarser one was compared
with, and of one alone with cells of ``ALONE``, in proportion to its cells: of ln F / (W - F), of
the relative viscous friction, of what else moves COF."""
ALONE = 1e-3
"""m"""
PEAKS = {True: 0.3, False: 0.05}
"""Relative standard deviation of peaks and of what a sensor reads."""
IN_TIME = 0.003
"""Standard deviation of ln F / (W - F), and of the logarithm of peaks, that twice the steps in time
don't tell. For 95 % the worst of sixteen motions needs 0.0008 of the film (``python -m benchmarks
history_steps``), the worst of fifteen others 0.0025."""
GRID_OF_CONTACT = 1.1
"""Factor by which cells alone raise the friction of the contact at most."""
NAMES = {
    "cof": Message("cof"),
    "fluid_load": Message("fluid load"),
    "fluid_load_sensor": Message("fluid load sensor"),
    "peak_fluid_pressure": Message("peak fluid pressure"),
    "peak_fluid_pressure_sensor": Message("peak fluid pressure sensor"),
}
"""What a number with a numerical error is called."""
CHECKED = 2 * RESOLVED
"""Cells along the sliding of a grid check, at least."""


@dataclass(frozen=True, slots=True)
class NumericalErrors:
    """Standard deviations of grid and steps in time by name, SI, and what tells them.

    ``steps`` is empty where the steps were not looked at.
    """

    grid: Mapping[str, float]
    steps: Mapping[str, float]
    origin: Message

    def deviation(self, name: str) -> float:
        """Return the standard deviation of a number, grid and steps together."""
        return math.hypot(self.grid[name], self.steps.get(name, 0.0))

    def widen_numbers(self, values: Mapping[str, SourcedValue]) -> dict[str, SourcedValue]:
        """Return the numbers with these errors in their uncertainty, interval and note.

        Not in those of COF, whose draws have it.
        """
        result = dict(values)
        for name in self.grid:
            value, error = values[name], self.deviation(name)
            note = Message("numerical error {error}", error=_error(error, value))
            note = join_lines([value.note, note]) if value.note else note
            change: dict[str, Any] = {"note": note, "numerical": error}
            if name != "cof" and value.value is not None:
                known, ends = value.uncertainty or 0.0, value.interval
                change |= {"uncertainty": math.hypot(known, error), "reason": ""}
                if ends is not None and value.value > 0:
                    most = math.inf
                    if name == "fluid_load":  # by the odds: not above the load
                        most = max(values["normal_force"].value or math.inf, 1.001 * value.value)
                    change["interval"] = _wider(value.value, ends, error, most)
            result[name] = replace(value, **change)
        return result

    def sentence(self, values: Mapping[str, SourcedValue]) -> Message:
        """Return the errors in one sentence."""

        def parts(errors: Mapping[str, float]) -> list[Message]:
            return [
                Message("{name} ± {error}", name=NAMES[name], error=_error(error, values[name]))
                for name, error in errors.items()
            ]

        steps = NOTHING
        if self.steps:
            steps = Message(
                "; steps in time: {errors} (from twice as many)", errors=parts(self.steps)
            )
        return Message(
            "grid: {errors} ({origin}){steps}",
            errors=parts(self.grid), origin=self.origin, steps=steps,
        )  # fmt: skip


def with_numerical_error(sampled: SampledCof, error: float, *, cof: float, sole: str) -> SampledCof:
    """Return the draws of COF with its numerical error, a log-normal factor on all parts.

    ``error`` is the standard deviation of ``cof``; ``sole`` names the sole: two runs of one name
    share the error. A contact does not get more than the whole load by it.
    """
    if not (error > 0 and cof > 0):
        return sampled
    width = math.sqrt(math.log1p((error / cof) ** 2))
    normal = normal_draws(sampled.seed, f"numerical error {sole}", sampled.cof.size)
    factor = np.exp(width * normal)
    variance, law_variance = error**2, float(np.var(sampled.cof))
    share = {
        name: each * law_variance / (law_variance + variance)
        for name, each in sampled.share.items()
    }
    whole = 1 / np.maximum(sampled.contact, 1e-9)
    solid = np.minimum(factor, np.maximum(whole, GRID_OF_CONTACT))
    parts = {"adhesion": solid, "hysteresis": solid, "viscous": factor}
    drawn = {name: getattr(sampled, name) * each for name, each in parts.items()}
    return replace(
        sampled,
        cof=sum(drawn.values()),
        contact=np.minimum(sampled.contact * solid, 1.0),
        share={**share, "numerical": variance / (law_variance + variance)},
        **drawn,
    )


def numerical_errors(
    parts: Prepared,
    solution: Solution,
    positions: TreadPositions | None,
    progress: Progress = silent,
) -> NumericalErrors | str:
    """Return the numerical errors of a solved case, or why they are not known.

    With n positions of a tread

        s^2 = g^2 + d^2 + s_p^2 / n^(2 r) + (m / (n + m) l)^2

    s_p the standard deviation over the positions, r the rate of their rule (``RATES``), d what the
    difference of the two grids leaves open, none where one was solved, l the largest difference of
    a position to their mean: m more that did not converge may be as far off. Without a tread d is
    the difference to the quick grid. g lies between the grid of the run and endlessly fine ones
    (``BETWEEN_GRIDS``):
    c F (1 - F / W) of the load F on the film of W; of COF, since contact loses what the film gains,
    (c F / W) (adhesion + hysteresis) + c_v viscous, and a share of all. Steps: ``errors_by_steps``.
    ``numerics.grid_check`` compares with a coarser quick grid, without lugs with ``CHECKED`` cells
    along the sliding on it, and these with twice the steps in time (first order).

    Raises:
        InputError: A grid check with a compliance of one grid.
    """
    case = parts.case
    numerics = case.numerics
    # a quick run is on the quick grid itself
    checked = numerics.grid_check and numerics.quick_grid_spacing >= CLOSEST * parts.spacing
    if "compliance" in parts.objects:
        if checked:
            raise InputError(
                "a compliance that was given holds for one grid",
                where="numerics.grid_check",
                remedy="Set numerics.grid_check = false",
            )
        return "not estimated: the compliance holds for one grid"
    numbers, columns = _read(parts, solution.contact), cells_along(case, parts.sole)
    if checked:
        # cells along the sliding give the rims of lugs a peak that they don't have
        finer = columns if parts.sole.tread_depth.any() else max(CHECKED, columns)
        finely = replace(parts, case=case.replace("numerics.cells_along", finer))
        return _grid_differences(finely, numbers, progress)
    if positions is None:
        return Message("not estimated with numerics.tread_positions = 1")
    grid, count, lost = {}, len(positions.places), positions.left_out
    lugs, force = not isinstance(positions, ShoeAngles), solution.contact.normal_force
    alone, size = positions.uncompared > 0, positions.uncompared / ALONE or 1.0
    at = positions.values
    share = {name: size * both[alone] for name, both in BETWEEN_GRIDS[lugs].items()}
    film = np.clip(at["fluid_load"] / force, 0.0, 1.0)
    moved = share["fluid_load"] * film
    moved_cof = moved * (at["cof_adhesion"] + at["cof_hysteresis"])
    moved_cof += share["cof_viscous"] * at["cof_viscous"]
    finer = {name: PEAKS[lugs] * positions.answer(name) for name in numbers}
    finer["fluid_load"] = float((moved * (1 - film)).mean()) * force
    finer["cof"] = math.hypot(share["cof"] * positions.answer("cof"), moved_cof.mean())
    rate = RATES[len(tread_on_sole(case)[0])] if lugs else 0.0
    for name, error in finer.items():
        values = at[name]
        rule = float(np.std(values, ddof=1)) / count**rate if lugs and count > 1 else 0.0
        missing = lost / (count + lost) * float(np.abs(values - values.mean()).max())
        grid[name] = math.hypot(error, positions.between.get(name, 0.0), rule, missing)
    origin = Message("{count} {several}", count=count, several=positions.several)
    if not (lugs or alone):
        origin = Message("difference to {cells}", cells=_cells(parts, columns))
    origin = Message("{origin}, and finer grids", origin=origin)
    if remembers(case) and not positions.in_time:
        origin = Message(
            "{origin}; steps in time not estimated: a march with twice as many did not converge",
            origin=origin,
        )
    return NumericalErrors(grid, errors_by_steps(positions, numbers, force), origin)


def errors_by_steps(
    positions: TreadPositions, numbers: Iterable[str], force: float
) -> dict[str, float]:
    """Return standard deviations of the steps in time by name; empty of steady sliding.

    Of the first order: at one place twice as many move a number by half of what is left, the load
    on the film of ``force`` (N) in its odds, which with ``IN_TIME`` move the contact too.
    """
    if not positions.in_time:
        return {}
    own, finer = positions.in_time

    def share_moved(*names: str) -> float:
        whole = sum(own[name] for name in names)
        return 2 * sum(abs(finer[name] - own[name]) for name in names) / whole if whole else 0.0

    at = positions.values
    errors = {
        name: math.hypot(share_moved(name), IN_TIME) * positions.answer(name) for name in numbers
    }
    film, solid = np.clip(at["fluid_load"] / force, 0.0, 1.0), sum(at[name] for name in ON_CONTACT)
    odds = [float(log_film_odds(*(one[load] for load in LOADS))) for one in positions.in_time]
    swing = math.hypot(2 * (odds[1] - odds[0]), IN_TIME)
    errors["fluid_load"] = swing * float((film * (1 - film)).mean()) * force
    errors["cof"] = math.hypot(
        share_moved(*COF_PARTS) * positions.answer("cof"), IN_TIME * float((film * solid).mean())
    )
    return errors


def _grid_differences(
    parts: Prepared, numbers: Mapping[str, float], progress: Progress
) -> NumericalErrors | str:
    """Return the differences of ``numbers`` to the quick grid, and by its steps in time."""
    spacing = parts.case.numerics.quick_grid_spacing
    here, contact = solved_at(parts, TreadPlace(), spacing, progress=progress)
    contacts = [contact]
    if parts.viscosity is not None:  # a dry contact has no memory
        contacts.append(solved_at(parts, TreadPlace(finer=2), spacing, progress=progress)[1])
    cells = _cells(parts, cells_along(parts.case, here.sole))
    if not all(each.status.usable for each in contacts):
        return Message("not estimated: a march on {cells} did not converge", cells=cells)
    coarse = [_read(here, each) for each in contacts]
    grid = {name: abs(value - coarse[0][name]) for name, value in numbers.items()}
    by_steps = {name: 2 * abs(value - coarse[-1][name]) for name, value in coarse[0].items()}
    origin = Message("difference to {cells}", cells=cells)
    return NumericalErrors(grid, by_steps if len(coarse) > 1 else {}, origin)


def _cells(parts: Prepared, columns: int) -> Message:
    spacing = Amount(parts.case.numerics.quick_grid_spacing, "m")
    if columns < 2:
        return Message("cells of {spacing}", spacing=spacing)
    return Message(
        "cells of {spacing}, {columns} along the sliding", spacing=spacing, columns=columns
    )


def _read(parts: Prepared, contact: SoleContact) -> dict[str, float]:
    friction = friction_sums(parts.local_law, contact, parts.case.motion.speed)
    sensor = scan_reading(parts.case, parts.sole, contact, viscosity=parts.viscosity)
    return readings(contact, float(friction.cof), sensor)


def _wider(
    value: float, ends: tuple[float, float], error: float, most: float
) -> tuple[float, float]:
    """Return a 95 % interval of a number from 0 to ``most`` with a further standard deviation.

    Both join as ln v / (1 - v / most), which keeps the ends in between.
    """

    def log_odds(number: float) -> float:
        share = min(max(number / value, 1e-6), (1 - 1e-9) * most / value)
        return math.log(share / (1 - share * value / most))

    width = 1.96 * error / (value * (1 - value / most))
    result = []
    for end, sign in zip(ends, (-1, 1), strict=True):
        odds = math.exp(log_odds(value) + sign * math.hypot(log_odds(end) - log_odds(value), width))
        result.append(value * odds / (1 + odds * value / most))
    return result[0], result[1]


def _error(error: float, value: SourcedValue) -> str:
    return display(float(f"{error:.2g}"), value.unit)
