"""Mass-conserving film (JFO): cost, sets, residual and order against grid size.

    python -m benchmarks mass_conserving

A 10 mm square slider in 0.1 Pa s at 0.5 m/s: a parabolic one that converges and diverges
(10 to 50 um), and the same with 4 x 4 smooth dimples 20 um deep; about a third of both cavitates.
CPU seconds of the process; order of the load by least squares against the finest grid.
Limit: 512 x 512 cells below 5 s on one thread.
"""

from __future__ import annotations

import time

import numpy as np

LENGTH, LEAST_GAP = 0.01, 10e-6
LIMIT = 5.0  # s at 512 x 512
CELLS = (64, 96, 128, 192, 256, 512)


def gap(cells: int, dimpled: bool) -> np.ndarray:
    """Return the gap at the nodes, whose outermost lie on the rim."""
    place = np.arange(cells + 1) / cells
    x, y = np.meshgrid(place, place, indexing="ij")
    profile = LEAST_GAP * (1 + 4 * (2 * x - 1) ** 2)
    if not dimpled:
        return profile
    u, v = (4 * x) % 1 - 0.5, (4 * y) % 1 - 0.5
    return profile + 2 * LEAST_GAP * np.clip(1 - (u * u + v * v) / 0.35**2, 0.0, None) ** 2


def main() -> None:
    from threadpoolctl import threadpool_limits

    from underfoot.core.sparse import back_ends
    from underfoot.film import Film, film_pressure

    print("slider     cells  backend   CPU s  sets  mass residual    load N  cavitated")
    slowest, leakiest = 0.0, 0.0
    for dimpled in (False, True):
        for backend in back_ends():
            loads = []
            for cells in CELLS if backend == "pardiso" else CELLS[:-1]:
                given = gap(cells, dimpled)
                with threadpool_limits(1):
                    began = time.process_time()
                    walls = Film(given, spacing=LENGTH / cells, viscosity=0.1, speed=0.5)
                    film = film_pressure(walls, backend=backend)
                    took = time.process_time() - began
                loads.append(film.load)
                leakiest = max(leakiest, film.mass_residual)
                print(
                    f"{'dimpled' if dimpled else 'parabolic':9s} {cells:6d}  {backend:8s}"
                    f"{took:6.2f} {film.iterations:5d} {film.mass_residual:14.1e} {film.load:9.5f}"
                    f" {film.cavitated[1:-1, 1:-1].mean():9.1%}",
                    flush=True,
                )
                if cells == 512:
                    slowest = max(slowest, took)
            if len(loads) == len(CELLS):
                error = np.abs(np.array(loads[:-1]) / loads[-1] - 1)
                order = -np.polyfit(np.log(CELLS[:-1]), np.log(error), 1)[0]
                print(f"   order of the load: {order:.2f}")
    print(f"largest mass residual {leakiest:.1e} of the largest flow of a face")
    if slowest:
        verdict = "holds" if slowest < LIMIT else "BROKEN"
        print(f"limit of {LIMIT:g} s at 512 x 512: {slowest:.2f} s, {verdict}")


if __name__ == "__main__":
    main()
