"""Does the numerical error of a motion that ends hold its steps in time?

``python -m benchmarks history_steps``: 16 soles of ``steadiness`` drawn anew, in turn with a step
of level walking, a history of a few points, a load that is held for a time and a history of forty
points, each at its own place on 1 mm with the steps of a run, twice and four times as many. Prints
by how much four times as many move a number, over the standard deviation that is printed, and what
``IN_TIME`` has to be of the film (five minutes).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks import steadiness
from underfoot import Case
from underfoot.compute.numerical_error import errors_by_steps
from underfoot.compute.position_draws import LOADS, TreadPlace, TreadPositions, log_film_odds
from underfoot.compute.positions import place_numbers
from underfoot.compute.prepare import prepare_case
from underfoot.compute.solve import solved_at
from underfoot.core import UnderfootError

SEEDS, SOLES, SPACING = (900, 901), 8, 1e-3
NUMBERS = "cof", "fluid_load", "peak_fluid_pressure"


def history(rng: np.random.Generator, force: float, count: int) -> dict[str, Any]:
    """Return a step of ``count`` points: the load comes up, the foot comes down and brakes."""
    end = rng.uniform(0.08, 0.4)
    time = np.r_[0.0, np.sort(rng.uniform(0.1, 0.9, count - 2)), 1.0]
    load = force * np.interp(time, [0.0, 0.3, 1.0], [0.0, 1.0, rng.uniform(0.5, 1.1)])
    speed = np.interp(time, [0.0, 0.3, 1.0], rng.uniform(0.05, 0.6, 3))
    angle = np.interp(time, [0.0, 1.0], [rng.uniform(8, 20), rng.uniform(0, 8)])
    points = [
        {
            "time": f"{end * t:.6f} s",
            "normal_force": f"{f:.2f} N",
            "speed": f"{v:.4f} m/s",
            "shoe_angle": f"{a:.3f} deg",
        }
        for t, f, v, a in zip(time, load, speed, angle, strict=True)
    ]
    return {"model": "history", "history_points": points}


def motions(seed: int) -> Any:
    """Yield name and case of the soles of a seed, each with its motion."""
    rng = np.random.default_rng(seed)
    steadiness.SEED, steadiness.SOLES = seed, SOLES
    for number, (name, case) in enumerate(steadiness.soles()):
        kind = ("step", "few points", "held", "forty points")[number % 4]
        end, count = rng.uniform(0.1, 0.3), 40 if "forty" in kind else int(rng.integers(3, 7))
        drawn = history(rng, case.motion.normal_force, count)
        change: dict[str, Any] = {
            "step": {"motion": "heel_strike_to_flat"},
            "held": {"motion.duration": f"{end:.4f} s"},
        }.get(kind, {"motion": drawn})
        yield f"{kind}, {name}", case.replace(change)


def ends(case: Case) -> list[dict[str, float]]:
    """Return the numbers with the steps of a run, twice and four times as many."""
    parts, found = prepare_case(case, SPACING), []
    for finer in (1, 2, 4):
        here, contact = solved_at(parts, TreadPlace(finer=finer), SPACING)
        if not contact.status.usable:
            raise UnderfootError(f"not converged with {finer} times the steps")
        found.append(place_numbers(here, contact))
    return found


def over_printed(own: dict[str, float], finer: dict[str, float], finest: dict[str, float]) -> Any:
    """Return what four times the steps move ``NUMBERS``, over what is printed of the first two."""
    values = {name: np.array([value]) for name, value in own.items()}
    one = TreadPositions((TreadPlace(),), values, 0, own, in_time=(own, finer))
    errors = errors_by_steps(one, NUMBERS, sum(own[load] for load in LOADS))
    return [abs(finest[name] - own[name]) / errors[name] for name in NUMBERS]


def beside(own: dict[str, float], finer: dict[str, float], finest: dict[str, float]) -> float:
    """Return the standard deviation of film odds that takes what was off to the end of 95 %.

    Beside what the first two tell, by the first order; 0 where these hold it.
    """
    odds = [log_film_odds(*(each[load] for load in LOADS)) for each in (own, finer, finest)]
    told, off = 2 * (odds[1] - odds[0]), odds[2] - odds[0]
    return float(np.sqrt(max((off / 1.96) ** 2 - told**2, 0.0)))


def main() -> None:
    """Print the table of each half."""
    for seed in SEEDS:
        rows, over = [], []
        print(f"{f'seed {seed}: off over printed':<66}{'COF':>6}{'film':>6}{'peak':>6}")
        for name, case in motions(seed):
            try:
                rows.append(ends(case))
            except UnderfootError as error:
                print(f"{name:<66} {error}", flush=True)
                continue
            over.append(over_printed(*rows[-1]))
            print(f"{name:<66}" + "".join(f"{each:>6.2f}" for each in over[-1]), flush=True)
        inside = (np.array(over) < 1.96).sum(axis=0)
        counts = ", ".join(f"{n} {k}" for n, k in zip(NUMBERS, inside, strict=True))
        print(f"within 95 % of {len(rows)}: {counts}")
        print(f"film odds beside it: {max(beside(*row) for row in rows):.4f} at most")


if __name__ == "__main__":
    main()
