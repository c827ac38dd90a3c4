"""A preview as the change of a whole run, with the errors of that run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from underfoot.case import Case
from underfoot.compute.continuation import Continuation, Preview, kept_continuation
from underfoot.compute.positions import has_lugs
from underfoot.core import ConvergenceError, InputError, Progress, SourcedValue, silent
from underfoot.core.remark import Message
from underfoot.core.threads import threads_limited

SURE = 1.96
"""Standard deviations of a numerical error in the ± beside a whole run: 95 %."""
DRIFT = (0.46, 0.17)
"""What one position on the quick grid may miss of turning, 1/rad: share of the COF, and of the load
for the film. Chosen on 50 settings of two treaded soles; ``benchmarks/previews.py`` counts on
others."""
USUAL = {"cof": 0.02, "fluid_load": 0.15}
"""Relative numerical error of a whole run that tells of none."""
MOST_UNSURE = 0.25
"""Error beside a whole run, over the COF and over the load for the film, that still says enough."""


@threads_limited(1)
def preview_of_run(
    case: Case,
    changes: Mapping[str, Any],
    whole: Mapping[str, SourcedValue],
    *,
    progress: Progress = silent,
) -> Preview:
    """Return the preview of a changed case as a change of the ``whole`` run of the case.

    Raises:
        InputError: Wear, or a sole without lugs: both hang on the film that is trapped at landing.
            Wear was said to raise the COF where runs lower it; of six previews of a sole without
            lugs one held (``benchmarks/previews.py``).
        ConvergenceError: See ``of_run``.
    """
    worn = case.replace(changes).shoe.wear != case.shoe.wear
    if worn or (changes and not has_lugs(case)):
        raise InputError(
            "wear has no preview" if worn else "a sole without lugs has no preview",
            where="preview",
            remedy="Run the changed case",
        )
    solved = kept_continuation(case, progress=progress)
    return of_run(solved, solved.continue_march(changes), whole)


def of_run(solved: Continuation, seen: Preview, whole: Mapping[str, SourcedValue]) -> Preview:
    """Return a preview as the change of a whole run, in its COF and load on the film.

    ``whole`` are the scalars of the run of the unchanged case; they change by the share that
    the preview changes by, the load on the film by that of its odds. The errors are where 95
    of 100 whole runs of changed cases lie:

        e^2 = (share x e_steps)^2 + 2 (1.96 s)^2 + (drift x change of the angle)^2

    with the numerical error s of a whole run, of grid and positions: once of the run that was
    made and once of the one to come.

    Raises:
        ConvergenceError: An error above ``MOST_UNSURE``.
    """
    case = solved.case.replace(seen.changes)
    load, values, errors = case.motion.normal_force, dict(seen.values), dict(seen.errors)
    for number, (name, usual) in enumerate(USUAL.items()):
        run, before, after = float(whole[name]), solved.values[name], seen.values[name]
        limits = (math.inf, math.inf)
        if name == "fluid_load":
            limits = (solved.case.motion.normal_force, load)
        values[name] = _move_number(run, before, after, limits)
        share = values[name] / after if after else 1.0
        known = whole[name].numerical
        relative = usual if known is None or not run else known / run
        size = values[name] if name == "cof" else load
        turned = case.motion.shoe_angle - solved.case.motion.shoe_angle
        repeated = math.sqrt(2.0) * SURE * relative * values[name]
        drift = DRIFT[number] * turned * size
        errors[name] = math.hypot(share * seen.errors[name], repeated, drift)
    unsure = errors["cof"] > MOST_UNSURE * values["cof"]  # which may be none
    if unsure or errors["fluid_load"] > MOST_UNSURE * load:
        raise ConvergenceError(
            Message(
                "a preview would say COF {cof:.3f} ± {cof_spread:.3f}, film {film:.0f} ± "
                "{film_spread:.0f} N: too little",
                cof=values["cof"],
                cof_spread=errors["cof"],
                film=values["fluid_load"],
                film_spread=errors["fluid_load"],
            ),
            where="preview",
            remedy="Run the changed case",
        )
    share = values["cof"] / seen.values["cof"] if seen.values["cof"] else 1.0
    draws = None if seen.cof_draws is None else share * seen.cof_draws
    cof = seen.cof.scale_value(share)
    return replace(seen, values=values, errors=errors, cof=cof, cof_draws=draws)


def _move_number(run: float, before: float, after: float, limits: tuple[float, float]) -> float:
    """Return a number of a whole run moved as from ``before`` to ``after``, by its odds.

    ``limits`` are what it is at most, of the unchanged case and of the changed one.
    """
    if not (run > 0 and before > 0 and after > 0):
        return after

    def odds(value: float, most: float) -> float:
        return value / (1.0 - min(value / most, 0.999))

    moved = odds(run, limits[0]) / odds(before, limits[0]) * odds(after, limits[1])
    return moved / (1.0 + moved / limits[1])
