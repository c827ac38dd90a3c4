"""``python tests/random_cases.py [COUNT [SEED]]``: valid cases drawn at random, on the quick grid.

Each must end in an answer, in an error that says what to change, or in a result that is none and
says what in the physics is the reason. Prints those that are none and a count of each; ends with 1
where one has no reason.
"""

import sys
import time
from collections import Counter

import numpy as np

from underfoot import Case, run
from underfoot.case.sole import usual_tread
from underfoot.core import UnderfootError
from underfoot.shoe.tread import PATTERNS


def drawn_case(rng: np.random.Generator) -> Case:
    """Return a case within what its fields allow."""

    def log(low: float, high: float) -> float:
        return float(np.exp(rng.uniform(np.log(low), np.log(high))))

    pattern = str(rng.choice(["none", *PATTERNS]))
    tread: dict[str, object] = {"pattern": pattern}
    if pattern != "none":
        tread |= usual_tread(pattern)
        tread |= {"angle": f"{rng.uniform(-40, 40):.1f} deg", "depth": f"{log(1, 6):.2f} mm"}
        if pattern != "lettering":
            tread |= {
                "lug_width": f"{rng.uniform(4, 14):.2f} mm",
                "channel_width": f"{rng.uniform(2, 7):.2f} mm",
            }
    rear = {"model": "facet", "angle": f"{rng.uniform(0, 14):.1f} deg", "length": "25 mm"}
    rocker = {"model": "rocker", "radius": f"{log(60, 400):.0f} mm", "start": "25 mm"}
    return Case(
        shoe={"from": "work_shoe_full_tread", "tread": tread},
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion="slip_tester_g4",
    ).replace(
        {
            "shoe.heel.profile": rear if rng.random() < 0.7 else rocker,
            "shoe.material.shore_a": f"{rng.uniform(30, 95):.0f}",
            "contaminant.viscosity": f"{log(0.5, 2000):.3g} cP",
            "motion.speed": f"{log(0.02, 3):.3g} m/s",
            "motion.normal_force": f"{log(20, 1500):.0f} N",
            "motion.shoe_angle": f"{rng.uniform(-2, 20):.1f} deg",
            "numerics.tread_positions": 1,
        }
    )


def main(count: int = 300, seed: int = 0) -> int:
    """Run the cases; return 1 where one has neither an answer nor a reason."""
    rng, ends, unanswered = np.random.default_rng(seed), Counter(), 0
    for number in range(count):
        began = time.process_time()
        try:
            case = drawn_case(rng)
            result = run(case, quick=True)
        except UnderfootError as error:
            ends[f"refused: {type(error).__name__}"] += 1
            if not str(error).strip():
                unanswered += 1
            print(f"{number:4} refused: {str(error).splitlines()[0][:150]}", flush=True)
            continue
        ends[result.status.value] += 1
        if not result.usable:
            reason = result.labels.get("no_result", "")
            unanswered += not reason
            seconds = time.process_time() - began
            print(f"{number:4} {result.status.value}, {seconds:.0f} s: {reason or 'NO REASON'}")
            print(
                f"     {case.shoe.tread!r} {case.motion!r} {case.contaminant!r}"[:400], flush=True
            )
    for end, times in ends.most_common():
        print(f"{times:4} {end}")
    print(f"{unanswered} of {count} without an answer or a reason")
    return int(unanswered > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
