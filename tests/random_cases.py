"""``python tests/random_cases.py [COUNT [SEED]]``: valid cases drawn at random, on the quick grid.

Each must end in an answer within what physics allows, in an error that says what to change, or in
a result that is none and says what in the physics is the reason. Prints those that are none and a
count of each; ends with 1 where one has no reason or lies beyond physics.
"""

import sys
import time
from collections import Counter

import numpy as np

from small_pads import PAD
from underfoot import Case, Result, run
from underfoot.case.sole import usual_tread
from underfoot.compute.contact_friction import place_of_tread, sole_errors
from underfoot.compute.prepare import prepare_case
from underfoot.core import UnderfootError
from underfoot.friction.sampled_cof import HIGHEST, SAMPLES, VACUUM, sampled_points
from underfoot.shoe.tread import PATTERNS

GRID_OF_CONTACT = 1.2
"""Factor that the numerical error of a contact may put on what its law draws."""


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
            "numerics.tread_positions": 4,
        }
    )


def drawn_pad(rng: np.random.Generator) -> Case:
    """Return a plain pad under a tester, 25 to 300 mm long, at 0 to 10 degrees."""
    length = rng.uniform(25, 300)
    width = min(length, 76.0)
    pressure, viscosity = np.exp(rng.uniform(np.log([5e3, 1.0]), np.log([2e5, 500.0])))
    return Case.from_text(PAD).replace(
        {
            "shoe.material.shore_a": f"{rng.uniform(50, 95):.0f}",
            "shoe.heel.length": f"{length:.1f} mm",
            "shoe.heel.width": f"{width:.1f} mm",
            "contaminant.viscosity": f"{viscosity:.3g} cP",
            "motion.normal_force": f"{min(max(pressure * length * width * 1e-6, 20), 1500):.1f} N",
            "motion.shoe_angle": f"{rng.uniform(0, 10):.2f} deg",
        }
    )


def beyond_physics(case: Case, result: Result) -> list[str]:
    """Return which numbers of a quick result no draw of its law and no load allow."""
    said, load = [], case.motion.normal_force
    film = result["fluid_load"]
    ends = (*(film.interval or ()), float(film))
    if not -1e-9 <= min(ends) <= max(ends) <= load * (1 + 1e-6):
        said.append(f"film {float(film):.4g} N, {min(ends):.4g} to {max(ends):.4g} N of {load:g} N")
    if "cof_draws" not in result.data:
        return said
    draws, parts = (
        result.data["cof_draws"].values,
        prepare_case(case, case.numerics.quick_grid_spacing),
    )
    pressure = np.logspace(2.5, 8, 23)
    law = sampled_points(
        parts.law, contact_pressure=pressure, speed=case.motion.speed, film_thickness=1.0
    )
    assert law is not None
    tread = sole_errors(case, parts.context)["tread_error"].draws(
        place_of_tread(case, parts.sole), samples=SAMPLES, seed=case.numerics.seed
    )
    pull = case.value("film.suction") or VACUUM
    solid = float(law.draws.max()) * float(np.exp(np.max(tread))) * max(VACUUM / pull, 1.0)
    fluid = float(result.data["position_cof"].values.max()) if "position_cof" in result.data else 0
    most = GRID_OF_CONTACT * min(solid + 3 * fluid, getattr(parts.law, "highest", HIGHEST))
    for name, number in (("draws", draws.max()), ("95 %", (result["cof"].interval or (0, 0))[1])):
        if not 0 <= number <= most:
            said.append(f"COF {number:.3g} ({name}), its law at most {most:.3g}")
    if draws.min() < 0:
        said.append(f"COF {draws.min():.3g} in a draw")
    return said


def main(count: int = 300, seed: int = 0) -> int:
    """Run the cases; return 1 where one has neither an answer nor a reason."""
    rng, ends, unanswered = np.random.default_rng(seed), Counter(), 0
    for number in range(count):
        began = time.process_time()
        try:
            case = drawn_pad(rng) if number % 10 == 0 else drawn_case(rng)
            result = run(case, quick=True)
        except UnderfootError as error:
            ends[f"refused: {type(error).__name__}"] += 1
            if not str(error).strip():
                unanswered += 1
            print(f"{number:4} refused: {str(error).splitlines()[0][:150]}", flush=True)
            continue
        ends[result.status.value] += 1
        if result.usable and (wrong := beyond_physics(case, result)):
            unanswered += 1
            print(f"{number:4} {case.shoe!r} {case.motion!r}: {'; '.join(wrong)}", flush=True)
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
    print(f"{unanswered} of {count} without an answer or a reason, or beyond physics")
    return int(unanswered > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
