"""Is the answer of a default case that of steady sliding, and free of the film at touch-down?

``python -m benchmarks steadiness``: 15 plain and 15 treaded soles drawn at random, each with one of
5 fluids at one of 3 speeds, at their own place on 1 mm (some 4 minutes of CPU). The default is
compared with five times the time that it marched (60 s at most), and with other start films. Prints
the largest differences, and the processor time over that of 0.12 s.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from underfoot import Case
from underfoot.case.sole import usual_tread
from underfoot.compute.positions import place_numbers
from underfoot.compute.prepare import prepare_case
from underfoot.compute.solve import solved_motion
from underfoot.core import UnderfootError
from underfoot.shoe.tread import PATTERNS

FLUIDS = ("water", "glycerol_50pct", "glycerol_75pct", "canola_oil", "glycerol_90pct")
SPEEDS = (0.1, 0.3, 0.7)  # m/s
SOLES, SEED, SPACING = 30, 41, 1e-3
COF_WITHIN, FILM_WITHIN, FILM_LEAST = 0.01, 0.02, 1.0  # relative, relative, N: of five times
START_WITHIN = 0.005  # relative: of another start film
START_FILMS = ("15 um", "200 um")  # the default is 50 um
LONGEST = 60.0  # s, that a case may last
EARLY = {"motion.duration": "0.12 s"}


class Numbers(NamedTuple):
    """COF, load on the film (N), time that was marched and processor time (s)."""

    cof: float
    film: float
    time: float
    cpu: float

    @classmethod
    def of(cls, case: Case, changes: Mapping[str, str]) -> Numbers:
        """Return the numbers of a march of the changed case; nan where it did not converge."""
        parts = prepare_case(case.replace(changes), SPACING)
        began = time.process_time()
        contact = solved_motion(parts)
        cpu = time.process_time() - began
        if not contact.status.usable:
            return cls(np.nan, np.nan, contact.time, cpu)
        numbers = place_numbers(parts, contact)
        return cls(numbers["cof"], numbers["fluid_load"], contact.time, cpu)


def soles() -> Iterator[tuple[str, Case]]:
    """Yield name and case, the plain soles first."""
    rng, number = np.random.default_rng(SEED), 0
    patterns = [name for name in PATTERNS if name != "lettering"]
    while number < SOLES:
        fluid, speed = FLUIDS[number % 5], SPEEDS[number % 15 // 5]
        tread: dict[str, object] = {"pattern": "none"}
        if number >= SOLES // 2:
            pattern = str(rng.choice(patterns))
            tread = {"pattern": pattern, **usual_tread(pattern), "depth": "3 mm"}
            tread["lug_width"] = f"{rng.uniform(4, 12):.2f} mm"
            tread["channel_width"] = f"{rng.uniform(2, 6):.2f} mm"
        facet = f"{rng.uniform(0, 12):.1f} deg", f"{rng.uniform(20, 45):.0f} mm"
        radius = f"{np.exp(rng.uniform(np.log(80), np.log(300))):.0f} mm"
        heel: dict[str, object] = {"model": "facet", "angle": facet[0], "length": facet[1]}
        if rng.random() > 0.75:
            heel = {"model": "rocker", "radius": radius, "start": "25 mm"}
        try:
            case = Case(
                shoe={"from": "work_shoe_full_tread", "tread": tread},
                floor="vinyl_g4",
                contaminant=fluid,
                motion="slip_tester_g4",
            ).replace(
                {
                    "shoe.heel.profile": heel,
                    "shoe.material.shore_a": f"{rng.uniform(50, 90):.0f}",
                    "motion.speed": f"{speed} m/s",
                    "motion.normal_force": f"{rng.uniform(200, 700):.0f} N",
                    "motion.shoe_angle": f"{rng.uniform(0, 14):.1f} deg",
                }
            )
        except UnderfootError:
            continue
        number += 1
        yield f"{number} {tread['pattern']}, {heel['model']}, {fluid}, {speed} m/s", case


def main() -> None:
    """Print the table and how many soles lie within the limits."""
    head = f"{'COF':>8}{'film N':>8}{'0.12 s':>8}{'':>8}{'t, s':>7}"
    print(f"{'':<48}{head}{'five times':>16}{'15 um':>9}{'200 um':>9}{'CPU':>6}")
    later_within = start_within = 0
    worst, ratio = np.zeros(2), np.zeros(2)
    for name, case in soles():
        own = Numbers.of(case, {})
        early = Numbers.of(case, EARLY)
        lasting = f"{min(max(5 * own.time, 0.6), LONGEST)!r} s"
        later = Numbers.of(case, {"motion.duration": lasting})
        starts = [Numbers.of(case, {"motion.start_film": film}) for film in START_FILMS]
        off, film_off = abs(later.cof / own.cof - 1), abs(later.film - own.film)
        later_within += off < COF_WITHIN and film_off < max(FILM_WITHIN * own.film, FILM_LEAST)
        moved = [abs(start.cof / own.cof - 1) for start in starts]
        start_within += max(moved) < START_WITHIN
        worst = np.fmax(worst, [off, max(moved)])
        ratio += own.cpu, early.cpu
        print(
            f"{name:<48}{own.cof:>8.4f}{own.film:>8.1f}{early.cof:>8.4f}{early.film:>8.1f}"
            f"{own.time:>7.2f}{100 * off:>8.2f} %{film_off:>4.1f} N"
            + "".join(f"{100 * each:>7.2f} %" for each in moved)
            + f"{own.cpu / early.cpu:>6.2f}",
            flush=True,
        )
    print(f"five times the time: within {COF_WITHIN:.0%} of COF, and {FILM_WITHIN:.0%} or ")
    print(f"{FILM_LEAST:g} N of film: {later_within} of {SOLES}, worst {100 * worst[0]:.2f} %")
    print(f"start films: {start_within} of {SOLES} within 0.5 %, worst {100 * worst[1]:.2f} %")
    print(f"processor time over that of 0.12 s with what becomes of it: {ratio[0] / ratio[1]:.2f}")


if __name__ == "__main__":
    main()
