"""What people wait for: runs of a treaded shoe, previews, positions of a tread, a whole sole.

    python -m benchmarks sole_jobs

The fully treaded work shoe in 90 % glycerol. Errors are of the load on the film, over positions of
its mean; reference of a march is one of four times the time steps and a quarter of the tolerance.
"""

from __future__ import annotations

import math
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks._separate import THREADS, peak_memory, separate
from benchmarks._table import Row, printed

HERE = "benchmarks.sole_jobs"
CASE = "examples/work_shoe_full_tread_glycerol.toml"
WHOLE = {
    "shoe.heel.length": "300 mm",
    "shoe.heel.width": "100 mm",
    "shoe.heel.rear_radius": "40 mm",
    "motion.shoe_angle": "13 deg",
    "motion.normal_force": "400 N",
}
CHANGES: tuple[Mapping[str, Any], ...] = (
    {"contaminant.viscosity": "150 cP"},
    {"motion.speed": "0.5 m/s"},
    {"motion.normal_force": "600 N"},
    {"shoe.tread.depth": "2 mm"},
    {"shoe.material.shore_a": 54},
    {"motion.shoe_angle": "9 deg"},
)
PHASES = 8


def march(
    spacing: float, changes: Mapping[str, Any], finer: int = 1, shift: Any = (0.0, 0.0)
) -> dict[str, float]:
    """Return what one march took, in this process."""
    from underfoot.case import Case
    from underfoot.compute.resolve import resolve_context
    from underfoot.compute.sole import sole_map
    from underfoot.compute.solve import solver_settings
    from underfoot.sole_contact.compliance import compliance_within
    from underfoot.sole_contact.solver import solve_sliding

    case = Case.load(CASE).replace(changes)
    began = time.process_time()
    context, sole = resolve_context(case), sole_map(case, spacing, shift=shift)
    body = case.compliance.build(context, sole)
    settings = solver_settings(case)
    settings = replace(
        settings,
        tolerance=settings.tolerance / finer,
        time_resolution=settings.time_resolution * finer,
    )
    solved = solve_sliding(
        sole,
        body,
        case.rough_contact.build(context),
        viscosity=case.film.build(context).viscosity,
        speed=case.motion.speed,
        normal_force=case.motion.normal_force,
        settings=settings,
    )
    cpu, counts = time.process_time() - began, solved.counts
    # the transforms: one product a GMRES iteration and a Newton step on the box of the wet cells,
    # one a time step on the whole grid
    pressure = solved.total_pressure
    rows, columns = (np.flatnonzero(solved.wet.any(axis=axis)) for axis in (1, 0))
    box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    of_box = _seconds(compliance_within(body, box).apply, pressure[box])
    of_grid = _seconds(body.apply, pressure)
    return {
        "cpu": cpu,
        "limit": (counts.krylov + counts.newton) * of_box + counts.time_steps * of_grid,
        "memory": peak_memory(),
        "cells": float(sole.clearance.size),
        "newton": float(counts.newton),
        "fluid_load": solved.fluid_load,
    }


def warm() -> dict[str, float]:
    """Return what runs take in one process after a first, with one position and with PHASES."""
    from underfoot.case import Case
    from underfoot.compute.run import run

    case = Case.load(CASE)
    run(case, quick=True)

    def taken(positions: int, quick: bool) -> float:
        began = time.process_time()
        run(case.replace("numerics.tread_positions", positions), quick=quick)
        return time.process_time() - began

    return {
        "quick": taken(4, True),
        "one, quick": taken(1, True),
        "phases, quick": taken(2 * PHASES, True),  # a quick run takes half of them
        "one": taken(1, False),
        "phases": taken(PHASES, False),
    }


def error_over_positions() -> dict[str, float]:
    """Return the error in percent of the mean load on the film over positions of the tread."""
    from underfoot.case import Case
    from underfoot.compute.positions import places

    pattern = Case.load(CASE).shoe.tread
    tread = None if pattern is None else pattern.build()
    assert tread is not None
    shifts = [place.shift for place in places(tread.periods, PHASES)]
    default, fine = (
        sum(march(1e-3, {}, finer, shift)["fluid_load"] for shift in shifts) for finer in (1, 4)
    )
    return {"error": 100 * (default / fine - 1)}


def previews() -> dict[str, float]:
    """Return the mean cost of a preview, and the worst errors against marches, in percent."""
    from underfoot.case import Case
    from underfoot.compute.continuation import Continuation

    case = Case.load(CASE)
    solved = Continuation(case)
    solved.continue_march({})
    seconds, cof, load = [], 0.0, 0.0
    for change in CHANGES:
        seen, full = solved.continue_march(change), Continuation(case.replace(change)).values
        seconds.append(seen.seconds)
        cof = max(cof, 100 * (seen.values["cof"] / full["cof"] - 1), key=abs)
        load = max(load, 100 * (seen.values["fluid_load"] / full["fluid_load"] - 1), key=abs)
    return {"cpu": sum(seconds) / len(seconds), "worst": max(seconds), "cof": cof, "load": load}


def command(*options: str) -> tuple[float, float]:
    """Return processor time and peak memory (MB) of ``underfoot run`` as a process.

    Of a second call: like an installed program's, its modules are compiled already.
    """
    code = (
        "import atexit; from benchmarks._separate import peak_memory; "
        "atexit.register(lambda: print(peak_memory())); from underfoot.cli import main; main()"
    )
    call = [sys.executable, "-c", code, "run", CASE]
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | THREADS | {"PYTHONPYCACHEPREFIX": f"{folder}/compiled"}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        for name in ("first", "second"):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            done = subprocess.run(
                [*call, "--out", f"{folder}/{name}", *options],
                env=environment,
                capture_output=True,
                text=True,
                check=True,
            )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    user, system = after.ru_utime - before.ru_utime, after.ru_stime - before.ru_stime
    return user + system, float(done.stdout.splitlines()[-1])


def rows() -> list[Row]:
    """Return the jobs of the sole solver."""
    quick_run, run = command("--quick"), command("--no-advice")
    found = [Row("run, quick, cold process", *quick_run), Row("run, cold process", *run)]
    within = separate(HERE, "warm")
    found.append(Row("run, quick, warm process", within["quick"]))
    seen = separate(HERE, "previews")
    found.append(
        Row("preview of a change", seen["cpu"], error=seen["load"], reference="its march, worst")
    )
    found.append(
        Row(
            f"{PHASES} positions of the tread, quick",
            within["phases, quick"],
            error=separate(HERE, "error_over_positions")["error"],
            reference="time and tolerance 4 times finer, mean",
        )
    )
    found.append(Row("one position of the tread, quick", within["one, quick"]))
    found.append(Row(f"run, {PHASES} positions of the tread, warm process", within["phases"]))
    found.append(Row("run, one position of the tread, warm process", within["one"]))
    marches = {side: separate(HERE, "march", side, {}) for side in (1e-3, 0.6e-3)}
    coarse, fine = marches.values()
    growth = math.log(fine["cpu"] / coarse["cpu"]) / math.log(fine["cells"] / coarse["cells"])
    for side, one in marches.items():
        finer = separate(HERE, "march", side, {}, 4)
        found.append(
            Row(
                f"march at {side * 1e3:g} mm",
                one["cpu"],
                one["memory"],
                one["limit"],
                growth if one is fine else None,
                100 * (one["fluid_load"] / finer["fluid_load"] - 1),
                "time and tolerance 4 times finer",
            )
        )
    whole = separate(HERE, "march", 0.6e-3, WHOLE)
    found.append(Row("march of a 300 mm sole at 0.6 mm", *_cost(whole)))
    return found


def main() -> None:
    """Print the table of these jobs."""
    print(printed(rows()))


def _cost(one: Mapping[str, float]) -> tuple[float, float, float]:
    return one["cpu"], one["memory"], one["limit"]


def _seconds(function: Any, argument: Any, times: int = 20) -> float:
    function(argument)
    began = time.process_time()
    for _ in range(times):
        function(argument)
    return (time.process_time() - began) / times
