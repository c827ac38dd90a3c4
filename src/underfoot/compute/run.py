"""From a case to its result: prepare, solve, average, read, answer."""

import time
from itertools import pairwise
from pathlib import Path
from typing import Any

from underfoot.case import Case
from underfoot.core import Progress, silent
from underfoot.core.pool import workers
from underfoot.core.progress import part
from underfoot.core.threads import threads_limited
from underfoot.sole_contact.cost import refuse_too_large

from .answer import answer
from .cost import cost
from .positions import first_share, run_cost
from .prepare import case_and_objects, prepare_case
from .read import readings
from .result import Result
from .solve import average_positions, solve_case

LONG = 5.0
"""s, at least, of a run whose positions are worth the start of processes of their own."""


@threads_limited(1)
def run(
    case: Case | Path | str,
    *,
    quick: bool = False,
    processes: int | None = 1,
    progress: Progress = silent,
    **objects: Any,
) -> Result:
    """Return the friction of a case with everything that explains it.

    Parameters:
        case: What to compute, or its file.
        quick: Use the coarse grid of the case: a first look.
        processes: Positions of the tread solved at the same time, each on one thread: the same
            digits. None takes the cores, at most 4, for what takes over ``LONG`` s; never more
            than ``numerics.most_memory`` holds. With more than one, a script needs
            ``if __name__ == "__main__":`` around its work.
        progress: Receives stage, fraction and residual; an exception it raises stops the work.
        objects: Slot: what to take in place of the case's option. An option, its name or a mapping
            changes the case; an object of physics is used as it is: ``friction`` a ``FrictionLaw``,
            ``rough_contact`` a ``PressureGapLaw``, ``compliance`` a ``Compliance`` on the grid of
            the run, ``film`` a ``FilmModel``, ``risk`` a ``SlipModel``. ``viscosity`` takes Pa s or
            text. The result names such objects, and its hash holds their content and code.

    Returns:
        COF with its parts, load on the film, slip probability and further numbers in SI, each with
        unit, uncertainty and source; maps; status; provenance.

    Raises:
        InputError: A case whose parts don't fit together on this grid, a slot that is none, an
            object that can't stand in its slot.
        ConvergenceError: Not even the first contact could be solved.
    """
    case = case if isinstance(case, Case) else Case.load(case)
    case, given = case_and_objects(case, objects)
    moments = [time.perf_counter()]
    grid = "numerics.quick_grid_spacing" if quick else "numerics.grid_spacing"
    spacing, most = case.value(grid), case.numerics.most_memory
    expected = cost(case, spacing)
    refuse_too_large(expected, most_memory=most, where=grid, spacing=spacing)
    parts = prepare_case(case, spacing, given, progress=progress)
    moments.append(time.perf_counter())
    first = first_share(case, quick=quick)
    if processes is None and run_cost(case, quick=quick).seconds[0] < LONG:
        processes = 1
    beside = min(workers(processes), max(int(most / expected.memory), 1))
    solution = solve_case(parts, part(progress, 0.0, first), processes=beside)
    rest = part(progress, first, 1.0)
    positions = average_positions(parts, solution, quick=quick, processes=beside, progress=rest)
    moments.append(time.perf_counter())
    reading = readings(parts, solution, positions, progress)
    moments.append(time.perf_counter())
    stages = ("preparation_s", "solution_s", "evaluation_s")
    seconds = (after - before for before, after in pairwise(moments))
    timings: dict[str, float] = dict(zip(stages, seconds, strict=True))
    return answer(parts, solution, positions, reading, timings)
