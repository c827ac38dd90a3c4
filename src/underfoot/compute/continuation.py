"""An answer while a value changes: a finished march goes on under the changed case.

Two implicit steps from the contact that is there take the place of a march from the air. What they
leave out is the history of the film; it is left out of the unchanged case too, so that

    x(changed) = x(march) + (x(two steps, changed) - x(two steps, unchanged))

is better than either. Its error is estimated from what the steps move the unchanged case by, from
what the second step still changes, and from the change itself.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.core import ConvergenceError, InputError, Progress, SourcedValue, Status, silent
from underfoot.core.arrays import Array
from underfoot.core.deprecation import renamed_member
from underfoot.core.remark import Message
from underfoot.core.threads import threads_limited
from underfoot.shoe import SoleMap
from underfoot.sole_contact.solver import SoleContact

from .contact_friction import ContactFriction, contact_friction
from .position_draws import COF_PARTS, LOADS
from .positions import has_lugs, place_numbers
from .prepare import Prepared, prepare_case
from .solve import continue_contact, film_spreads, law_without, solved_motion, stated_effects
from .stated_spreads import StatedEffects

SAFETY, SHARE = 2.0, 0.1
"""Error per unit of what the steps move, and of the change. Chosen on 21 changes of two treaded
soles, of whose COF and film load they cover 41 of 42; of 29 changes of three other soles 55 of 58
(the worst misses by half)."""
MOST_KEPT = 4
"""Marches that ``preview`` keeps, each some 50 MB."""
MOST_CHANGED = 0.1
"""Share of the land's cells that a change may make or unmake; a shifted lug changes far more."""

_OF_THE_SOLE = ("shoe", "hardness", "compliance", "numerics")
"""Sections of a case that make its sole and compliance."""
_SOLVED: dict[tuple[str, bool], Continuation] = {}


@dataclass(frozen=True, slots=True)
class Preview:
    """Numbers of a changed case by continuation, SI; not a result.

    Attributes:
        changes: What differs from the case that was solved.
        cof: With the spread of the friction law, as a result has it.
        cof_draws: (n,) of that spread; None where the law has none.
        values: Scalars of a result by name, at the tread's own position.
        errors: Estimated error of each against a march of the changed case.
        sole: The undeformed sole on the grid of the fields.
        total_pressure: Fluid and contact pressure, (nx, ny), Pa.
        fluid_pressure: Of that, the fluid's.
        film_thickness: Mean gap, at most the pool, (nx, ny), m.
        status: Always ``Status.PREVIEW``.
        seconds: Processor time that it took.
    """

    changes: Mapping[str, Any]
    cof: SourcedValue
    cof_draws: Array | None
    values: Mapping[str, float]
    errors: Mapping[str, float]
    sole: SoleMap
    total_pressure: Array
    fluid_pressure: Array
    film_thickness: Array
    status: Status
    seconds: float

    def __str__(self) -> str:
        cof, load = (f"{self.values[k]:.3g} (±{self.errors[k]:.1g})" for k in ("cof", "fluid_load"))
        return Message(
            "Preview: COF {cof}, load on the film {load} N. {remedy}",
            cof=cof,
            load=load,
            remedy=self.status.remedy,
        )


class Continuation:
    """A case that is solved once and then answers changes of it in a step or two.

    Parameters:
        case: What to solve; steady motion or a load that rises and stays.
        quick: Use the coarse grid of the case.
        progress: Called with stage, fraction of the time and residual after each step.

    Changes may be of fluid, speed, load, shoe angle, wear, hardness and roughness; a change of the
    plan of the tread or of the grid needs a run. So do shoe angle and speed of a sole without lugs:
    the pool that its facet traps at landing and wipes away hangs on the whole march.

    Raises:
        InputError: A motion that follows a history.
        ConvergenceError: The case itself does not converge.
    """

    @threads_limited(1)
    def __init__(self, case: Case, *, quick: bool = True, progress: Progress = silent) -> None:
        _refuse_history(case)
        self.case = case
        numerics = case.numerics
        self.spacing = numerics.quick_grid_spacing if quick else numerics.grid_spacing
        self._parts = prepare_case(case, self.spacing)
        self.contact = solved_motion(self._parts, progress=progress)
        if not self.contact.status.usable:
            raise ConvergenceError(
                Message("the case gave no result: {status}", status=self.contact.status),
                history=self.contact.residuals,
                where=case.name,
                remedy=self.contact.remedy,
            )

    @cached_property
    @threads_limited(1)
    def values(self) -> dict[str, float]:
        """Scalars of the march by name, SI."""
        return place_numbers(self._parts, self.contact)

    @property
    def cof(self) -> SourcedValue:
        """COF of the march with the spread of its law."""
        return self._drawn.sums.cof

    @property
    def cof_draws(self) -> Array | None:
        """Draws of COF of the march over the spread of its law, (n,); None where it has none."""
        return None if self._drawn.sampled is None else self._drawn.sampled.cof

    @cached_property
    @threads_limited(1)
    def _drawn(self) -> ContactFriction:
        return self._friction(self._parts, self.contact)

    def _friction(self, parts: Prepared, contact: SoleContact) -> ContactFriction:
        """Return the friction of a contact; its film is as unknown as that of the march."""
        on = parts.case, parts.context, parts.local_law, parts.sole, contact
        stated = self.stated.of(parts.case)
        law = law_without(parts, stated)
        return contact_friction(*on, spreads=self.spreads, stated=stated, drawn_law=law)

    @cached_property
    def spreads(self) -> dict[str, tuple[float, float]]:
        """Relative spread of the film (``film_spreads``)."""
        return film_spreads(self._parts, self.contact)

    @cached_property
    def stated(self) -> StatedEffects:
        """What the spreads that the case states do to its numbers (``stated_effects``)."""
        return stated_effects(self._parts, self.contact)

    @threads_limited(1)
    def continue_march(self, changes: Mapping[str, Any], *, drawn: bool = True) -> Preview:
        """Return what the changes (path in the case: new value) make of the contact.

        ``drawn`` False leaves out the spread of the law.

        Raises:
            CaseError, InputError: Changes that are none of this case, or of its grid or plan.
            ConvergenceError: The step does not converge: the case is too far away.
        """
        began = time.process_time()
        case = self.case.replace(changes)
        _refuse_history(case)
        parts, first, second = self._steps(case)
        one, two = (place_numbers(parts, each) for each in (first, second))
        values, errors = {}, {}
        for name in sorted(one.keys() & self.values.keys() & self._unchanged.keys()):
            off = self.values[name] - self._unchanged[name]
            values[name] = two[name] + off
            steps = abs(off) + abs(two[name] - one[name])
            errors[name] = SAFETY * steps + SHARE * abs(two[name] - self._unchanged[name])
        cof, draws = SourcedValue(values["cof"], "1"), None
        if drawn:
            friction = self._friction(parts, second)
            cof = replace(friction.sums.cof, value=values["cof"])
            if (sampled := friction.sampled) is not None:
                film, contact = (max(values[load], 0.0) for load in LOADS)
                each = {name.removeprefix("cof_"): max(values[name], 0.0) for name in COF_PARTS}
                sampled = replace(sampled, **sampled.law.at(contact / (film + contact), **each))
                cof, draws = sampled.sourced_value("cof", cof), sampled.cof
        return Preview(
            dict(changes),
            cof,
            draws,
            values,
            errors,
            parts.sole,
            second.total_pressure,
            second.fluid_pressure,
            second.film_thickness,
            Status.PREVIEW,
            time.process_time() - began,
        )

    continued = renamed_member("continued", "continue_march", gone="0.4")

    @cached_property
    def _unchanged(self) -> dict[str, float]:
        parts, _, second = self._steps(self.case)
        return place_numbers(parts, second)

    def _steps(self, case: Case) -> tuple[Prepared, SoleContact, SoleContact]:
        """Return the contact after one step and after two, on the grid of the march."""
        angle, speed = self.case.motion.shoe_angle, self.case.motion.speed
        if (case.motion.shoe_angle, case.motion.speed) != (angle, speed) and not has_lugs(case):
            raise InputError(
                "the shoe angle or the speed of a sole without lugs changes",
                where="continue_march",
                allowed="fluid, load, wear, hardness, roughness",
                remedy="Run the changed case",
            )
        level = case.replace("motion.shoe_angle", angle)  # the map keeps its angle, the sole rolls
        parts = _change_case(self._parts, level)
        before, land = self._parts.sole.land, parts.sole.land
        same = land.shape == before.shape
        if not same or np.count_nonzero(land != before) > MOST_CHANGED * before.sum():
            raise InputError(
                "the plan of the sole or the grid changes",
                where="continue_march",
                allowed="fluid, speed, load, angle, wear, hardness, roughness",
                remedy="Run the changed case",
            )
        first, second = continue_contact(self.contact, parts, turn=case.motion.shoe_angle - angle)
        return parts, first, second


def preview(
    case: Case, changes: Mapping[str, Any], *, quick: bool = True, progress: Progress = silent
) -> Preview:
    """Return the preview of a changed case; the march of the case is kept for the next call."""
    return kept_continuation(case, quick=quick, progress=progress).continue_march(changes)


def kept_continuation(
    case: Case, *, quick: bool = True, progress: Progress = silent
) -> Continuation:
    """Return the march of a case, kept for the next call."""
    key = (case.hash, quick)
    if key not in _SOLVED:
        if len(_SOLVED) >= MOST_KEPT:
            _SOLVED.pop(next(iter(_SOLVED)))
        _SOLVED[key] = Continuation(case, quick=quick, progress=progress)
    return _SOLVED[key]


def _refuse_history(case: Case) -> None:
    if case.motion.build() is not None:
        raise InputError(
            "a history of the motion can't be continued",
            where="motion",
            allowed="a load that rises and stays",
        )


def _change_case(parts: Prepared, case: Case) -> Prepared:
    """Return another case on the same grid; sole and compliance stay where nothing makes others."""
    same = all(getattr(case, name) == getattr(parts.case, name) for name in _OF_THE_SOLE)
    return prepare_case(
        case, parts.spacing, geometry=(parts.sole, parts.compliance) if same else None
    )
