"""Other rough-contact solvers, run in an environment of their own.

tamaas (AGPL), ContactMechanics (MIT) and aspher (BSD, builds from source) are peers to compare
with, never dependencies: ``python -m venv peers && peers/bin/pip install tamaas==2.9
ContactMechanics aspher``, then give that environment's python to rough_contact.py with --peers, or
to the table of all jobs as UNDERFOOT_PEERS. This file runs there and needs NumPy alone.
"""

from __future__ import annotations

import json
import os
import sys
import time

os.environ["OMP_NUM_THREADS"] = str(json.loads(sys.argv[1]).get("threads", 1))

import numpy as np

try:
    import tamaas
except ImportError:
    tamaas = None
try:
    import aspher
except ImportError:
    aspher = None
try:
    import ContactMechanics
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import Topography
except ImportError:
    ContactMechanics = None

TASK = json.loads(sys.argv[1])
THREADS = TASK.get("threads", 1)


def tamaas_elastic(height, pressure, tolerance):
    n = height.shape[0]
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E, model.nu = 1.0, 0.0
    solver = tamaas.PolonskyKeerRey(model, height, tolerance)
    solver.max_iter = 10000
    solver.solve(pressure)
    return np.array(model.traction)


def aspher_elastic(height, pressure, tolerance):
    # the fastest of its ways here: coarse to fine, single precision polished in double
    result = aspher.solve_nested(
        grid_size=height.shape[0],
        gap=-height.ravel(),
        p_nominal=pressure,
        domain_size=1.0,
        E_star=1.0,
        backend="periodic",
        tol=tolerance,
        precision="float_then_double",
    )
    return np.array(result.pressure).reshape(height.shape)


def contact_mechanics_elastic(height, pressure, tolerance):
    system = make_system(
        interaction="hardwall",
        substrate=ContactMechanics.PeriodicFFTElasticHalfSpace(height.shape, 1.0, (1.0, 1.0)),
        surface=Topography(height, (1.0, 1.0), periodic=True),
    )
    solved = system.minimize_proxy(
        external_force=pressure, pentol=tolerance * height.std(), maxiter=10000
    )
    return np.array(solved.jac) * height.size


def main() -> None:
    solvers = {
        "tamaas": (tamaas, tamaas_elastic),
        "aspher": (aspher, aspher_elastic),
        "ContactMechanics": (ContactMechanics, contact_mechanics_elastic),
    }
    module, solve = solvers[TASK["peer"]]
    if module is None:
        print(json.dumps({"missing": True}))
        return
    if TASK["peer"] == "tamaas":
        tamaas.set_log_level(tamaas.LogLevel.error)
        tamaas.initialize(THREADS)
    height = np.load(TASK["height"])
    solve(height[:64, :64].copy(), TASK["pressure"], 1e-3)
    clock = time.process_time if THREADS == 1 else time.perf_counter
    best = float("inf")
    for _ in range(TASK["repeats"]):
        start = clock()
        pressure = solve(height, TASK["pressure"], TASK["tolerance"])
        best = min(best, clock() - start)
    np.save(TASK["out"], pressure)
    print(json.dumps({"seconds": best}))


if __name__ == "__main__":
    main()
