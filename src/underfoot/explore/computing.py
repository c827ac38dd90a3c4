"""The numbers of one case of a study: all that a worker does, on whichever machine it runs."""

from __future__ import annotations

import math
import os
import platform
import time
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.case import Case
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.compute.sole import file_surface, sole_shape
from underfoot.core import ConvergenceError, InputError, SourcedValue, Status
from underfoot.shoe import heel_surface

from .plan import job_key
from .record import CaseJob, Ending, Record, program

MEASURES = {
    "land": "1",
    "rubber_volume": "m^3",
    "mass": "kg",
    "stiffness": "N/m",
}
"""Numbers of a study that a result does not have, and their SI units."""
SURFACE = 0.5e-3
"""m: grid of the sole on which rubber and land are measured."""


def compute_job(base: Case, job: CaseJob) -> Record:
    """Return the record of a job: the base case with its changes, run. Never raises."""
    wall, cpu = time.perf_counter(), time.process_time()
    outcome: dict[str, Any] = {}
    try:
        case = base.replace(job.changes)
        if job_key(case, job.quick) != job.key:
            raise InputError(
                "a file, the catalogue or the code of an option has changed since the "
                "study set this case",
                remedy="Run the study in a new folder",
            )
        result = run(case, quick=job.quick)
        outcome = _outcome(case, result, job.fields)
    except InputError as error:
        outcome = {"ending": Ending.INFEASIBLE, "reason": str(error)}
    except ConvergenceError as error:
        outcome = {"ending": Ending.NOT_CONVERGED, "reason": str(error)}
    except Exception as error:
        outcome = {"ending": Ending.FAILED, "reason": f"{type(error).__name__}: {error}"}
    return Record(
        job.key,
        **outcome,
        seconds=time.perf_counter() - wall,
        cpu_seconds=time.process_time() - cpu,
        memory=peak_memory(),
        program=program(),
        worker=worker_name(),
        ended=time.time(),
    )


def crash_record(job: CaseJob) -> Record:
    """Return the record of a job that two workers in turn did not survive."""
    reason = "its worker process ended without an answer, twice: killed, or out of memory"
    return Record(job.key, Ending.CRASHED, reason, program=program(), ended=time.time())


def peak_memory() -> float:
    """Return the largest memory that this process had, bytes; 0 where the system doesn't tell."""
    return status_bytes("/proc/self/status", "VmHWM:")


def status_bytes(file: str, name: str) -> float:
    """Return a size that Linux tells of a process or of the machine, bytes; else 0."""
    try:
        text = Path(file).read_text(encoding="ascii", errors="replace")
        return 1024.0 * int(text.split(name)[1].split()[0])
    except (OSError, IndexError, ValueError):
        return 0.0


@cache
def worker_name() -> str:
    """Return a name of this process: machine and process number."""
    return f"{platform.node() or 'host'}-{os.getpid()}"


def _outcome(case: Case, result: Result, keep_fields: bool) -> dict[str, Any]:
    if not result.usable:
        ending = Ending.NOT_CONVERGED if result.status is Status.NOT_CONVERGED else Ending.FAILED
        return {"ending": ending, "reason": f"{result.status}. {result.status.remedy}"}
    scalars = {**result.scalars, **measures(case, result)}
    drawn = result.data.get("cof_draws")
    return {
        "ending": Ending.COMPUTED,
        "numbers": {name: _finite(each.value) for name, each in scalars.items()},
        "spreads": {
            name: each.uncertainty for name, each in scalars.items() if each.uncertainty is not None
        },
        "errors": {
            name: each.numerical for name, each in scalars.items() if each.numerical is not None
        },
        "units": {name: each.unit for name, each in scalars.items()},
        "law": result.provenance.closures["friction"],
        "draws": np.empty(0) if drawn is None else drawn.values,
        "breaches": result.breaches,
        "maps": result.data if keep_fields else None,
    }


def measures(case: Case, result: Result) -> Mapping[str, SourcedValue]:
    """Return what a designer trades against friction.

    Land over plan area, 1; volume of the outsole's rubber above its channels, m^3, and its mass by
    ``shoe.material.density``, kg; normal force over approach of the foot at the end, N/m. All of
    the sole as worn.
    """
    file = case.shoe.outsole is not None
    surface = file_surface(case) if file else heel_surface(sole_shape(case), spacing=SURFACE)
    left = np.maximum(case.shoe.sole.outsole_thickness - surface.height, 0.0)
    volume = float(np.nansum(left)) * surface.spacing**2
    density = case.shoe.material.density
    approach = float(result.data["approach_history"].values[-1])
    values = {
        "land": surface.land_ratio,
        "rubber_volume": volume,
        "mass": None if density is None else volume * density,
        "stiffness": case.motion.normal_force / approach if approach > 0 else None,
    }
    return {
        name: SourcedValue(
            value,
            MEASURES[name],
            "geometry of the sole",
            numerical=None if name == "stiffness" else 0.0,
        )
        for name, value in values.items()
    }


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
