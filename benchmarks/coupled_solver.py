"""Coupled solver: cost, iterations and memory against grid size, and both sparse back ends.

    python -m benchmarks coupled_solver

A 60 mm x 60 mm heel with a worn facet (10 deg, 30 mm), plain and with 5 mm lugs, 500 N, 0.7 m/s,
219 mPa s, to 0.12 s. CPU seconds of one thread; each run in a process of its own, so that the peak
memory is its own. Then the report's twelve slip-tester conditions (examples/) against the limits
that the solver is held to: 15 s at 0.5 mm, 60 s at 0.25 mm, 2 GB.
"""

from __future__ import annotations

import math
import time
from pathlib import Path

from benchmarks._separate import peak_memory, separate

HERE = "benchmarks.coupled_solver"
SPACINGS = (1.0e-3, 0.7e-3, 0.5e-3, 0.35e-3)
LIMITS = {0.5e-3: 15.0, 0.25e-3: 60.0}
"""Spacing, m: CPU seconds that a condition may take."""
MEMORY_LIMIT = 2000.0
"""MB."""
FINE = ("work_shoe_untreaded_glycerol", "work_shoe_half_tread_glycerol")


def measured(spacing: float, treaded: bool, backend: str | None) -> dict[str, float]:
    """Return what one run took, in this process."""

    from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
    from underfoot.shoe import Facet, Heel, Tread, heel_map
    from underfoot.sole_contact.compliance import layered_compliance
    from underfoot.sole_contact.solver import SolverSettings, solve_sliding

    tread = Tread("grid", lug_width=5e-3, channel_width=2.4e-3, depth=1.5e-3)
    heel = Heel(
        length=0.06,
        width=0.06,
        rear_radius=0.028,
        outsole_thickness=0.025,
        profile=Facet(math.radians(10), 0.03),
        edge_radius=0.002,
        tread=tread if treaded else None,
    )
    began = time.process_time()
    sole = heel_map(heel, shoe_angle=math.radians(10), spacing=spacing)
    body = layered_compliance(sole, modulus=5e6, poisson_ratio=0.49, thickness=0.025)
    solved = solve_sliding(
        sole,
        body,
        ExponentialLaw(5e6, 0.5, 5.5e-6),
        viscosity=0.219,
        speed=0.7,
        normal_force=500.0,
        settings=SolverSettings(backend=backend),
    )
    counts = solved.counts
    return {
        "cells": counts.cells,
        "newton": counts.newton,
        "krylov": counts.krylov / counts.newton,
        "cpu": time.process_time() - began,
        "peak": peak_memory(),
        "fluid_load": solved.fluid_load,
    }


def condition(name: str, spacing: float) -> dict[str, float]:
    """Return what one of the example cases took, in this process."""

    from underfoot.case import Case
    from underfoot.compute.position_draws import TreadPlace
    from underfoot.compute.prepare import prepare_case
    from underfoot.compute.solve import solved_at

    case = Case.load(f"examples/{name}.toml")
    began = time.process_time()
    _, solved = solved_at(prepare_case(case, spacing), TreadPlace(), spacing)
    counts = solved.counts
    return {
        "cells": counts.cells,
        "newton": counts.newton,
        "krylov": counts.krylov / counts.newton,
        "cpu": time.process_time() - began,
        "peak": peak_memory(),
        "fluid_load": solved.fluid_load,
    }


def limits(head: str) -> None:
    """Print the report's conditions against the limits of time and memory."""
    names = sorted(
        path.stem
        for path in Path("examples").glob("*_shoe_*.toml")
        if path.stem.endswith(("glycerol", "detergent"))
    )
    for spacing, limit in LIMITS.items():
        print(f"report's conditions, limit {limit:g} s and {MEMORY_LIMIT:g} MB\n{head}")
        rows = []
        for name in names if spacing == max(LIMITS) else FINE:
            row = separate(HERE, "condition", name, spacing)
            rows.append(row)
            print(f"{_line(spacing, row)}  {name}", flush=True)
        slowest = max(row["cpu"] for row in rows)
        largest = max(row["peak"] for row in rows)
        print(
            f"slowest {slowest / limit:.2f} of the time, {largest / MEMORY_LIMIT:.2f} of the memory"
        )


def main() -> None:
    """Print the tables."""
    head = f"{'mm':>5} {'cells':>6} {'Newton':>6} {'GMRES/N':>8} {'CPU s':>6} {'MB':>5} {'N':>6}"
    for label, treaded in (("plain heel", False), ("treaded heel", True)):
        print(f"{label}\n{head}")
        rows = []
        for spacing in SPACINGS:
            row = separate(HERE, "measured", spacing, treaded, None)
            rows.append(row)
            print(_line(spacing, row), flush=True)
        first, last = rows[0], rows[-1]
        order = math.log(
            (last["cpu"] / last["newton"]) / (first["cpu"] / first["newton"])
        ) / math.log(last["cells"] / first["cells"])
        print(f"CPU per Newton step grows as cells^{order:.2f} (N log N: about 1.1)")
    print(f"plain heel, SuperLU instead of PARDISO\n{head}")
    for spacing in SPACINGS[:3]:
        print(
            _line(
                spacing,
                separate(HERE, "measured", spacing, False, "superlu"),
            ),
            flush=True,
        )
    limits(head)


def _line(spacing: float, row: dict[str, float]) -> str:
    return (
        f"{spacing * 1e3:5.2f} {row['cells']:6.0f} {row['newton']:6.0f} {row['krylov']:8.1f} "
        f"{row['cpu']:6.1f} {row['peak']:5.0f} {row['fluid_load']:6.1f}"
    )


if __name__ == "__main__":
    main()
