"""Doubts about studies that are drawn at random: bodies, labels, levels, plates, repeats, names."""

from typing import Any

import numpy as np
import pytest

from snapshot import held
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import body_doubts
from underfoot.trials.study import study_guard as guard
from underfoot.trials.study.file_result import FileResult, Number, StepResult
from underfoot.trials.study.person_measures import FORCE, HEIGHT

WALK, TESTER, READINGS = (
    protocol(name) for name in ("level_walking", "en_iso_13287", "machine_cof")
)
DISTANCES = ("A to B (m)", "A to C (m)", "B to C (m)", "C to D (m)")
SHOES, FLOORS = ("soft", "hard", "worn"), ("vinyl", "tiles")


def result(name: str, numbers: dict[str, float], conditions: dict[str, Any], **more: Any):
    return FileResult(
        name, numbers=tuple(Number(key, value, main=key) for key, value in numbers.items()),
        conditions=conditions, **more,
    )  # fmt: skip


def study(seed: int) -> list[FileResult]:
    """Return walks of some persons; the seed decides how many, how unlike, and what is wrong."""
    rng = np.random.default_rng(seed)
    persons, trials = int(rng.integers(2, 8)), int(rng.integers(1, 5))
    scatter, spread = rng.choice([0.004, 0.02, 0.06]), rng.choice([0.01, 0.04, 0.12])
    effect = dict(zip(SHOES, (0.3 * rng.normal(size=3)).tolist(), strict=True))
    bodies = np.exp(spread * rng.normal(size=(persons, 6)))
    if persons > 2 and seed % 3 == 0:  # one person under two names
        bodies[1] = bodies[0]
    exchanged, odd = seed % 4 == 1, seed % 5
    files = []
    for p in range(persons):
        level = rng.normal(0, 0.1)
        for shoe in SHOES[: 2 + seed % 2]:
            for k in range(trials + (p == 1) * (seed % 3)):
                worn = {"soft": "hard", "hard": "soft"}.get(shoe, shoe)
                meant = worn if exchanged and p == 0 else shoe
                rcof = 0.2 * np.exp(level + effect[meant] + scatter * rng.normal())
                if odd == 2 and p == 1 and k == 0:
                    rcof *= 1.0 + 0.3 * rng.normal()
                sizes = bodies[p] * np.exp(0.3 * scatter * rng.normal(size=6))
                if odd == 3 and p == 0 and k == 1:
                    sizes = bodies[-1] * np.exp(0.3 * scatter * rng.normal(size=6))
                measures = (FORCE, HEIGHT, *DISTANCES)
                body = dict(zip(measures, (sizes * (600, 1.8, 0.3, 0.2, 0.4, 0.1)).tolist(),
                                strict=True))  # fmt: skip
                if rng.random() < 0.1:
                    body.pop(HEIGHT)
                conditions: dict[str, Any] = {
                    "person": f"P{p}", "shoe": shoe, "floor": FLOORS[(k + p) % 2],
                    "mass": 60.0 + 5 * p + (4.0 * (k == 2) if odd == 4 else 0.0), "day": f"d{k}",
                    "sole": shoe.upper(),
                }  # fmt: skip
                for key in ("floor", "mass", "day"):
                    if rng.random() < 0.08 * odd:
                        conditions.pop(key)
                if rng.random() < 0.08:
                    conditions["floor"] = "tilse"
                gain = 1.0 + 0.05 * (seed % 4)
                steps = tuple(
                    StepResult(
                        number=n, plate=f"plate {n}", contact=0.5 * n, rcof=rcof * factor,
                        peak_force=650.0 * factor**0.5 * (1 + scatter * rng.normal()),
                        walking_speed=1.2 + 0.1 * (shoe == "hard") * (seed % 3)
                        + 0.02 * rng.normal(), verdict="accepted",
                    )
                    for n, factor in ((1, 1.0), (2, gain * (1 + scatter * rng.normal())))
                )  # fmt: skip
                name = f"{p}{shoe[0]}{k}.c3d"
                files.append(result(name, {"rcof": rcof}, conditions, steps=steps, body=body))
    return files


@pytest.mark.parametrize("first", [0, 6, 12])
def test_doubts_of_walks(file_regression, first):
    told = {
        f"seed {seed}": [str(one) for one in guard.study_doubts(study(seed), WALK)]
        for seed in range(first, first + 6)
    }
    held(file_regression, told, f"walks from {first}")


def repeats(seed: int) -> list[FileResult]:
    """Return repeats of a tester that scatter, drift or leave the others."""
    rng = np.random.default_rng(seed)
    files = []
    for shoe in SHOES:
        scatter, rise = rng.choice([0.002, 0.02]), rng.choice([0.0, 0.01, 0.03, -0.03])
        for k in range(int(rng.integers(3, 8))):
            cof = 0.25 * (1 + rise * k) + scatter * rng.normal()
            if rng.random() < 0.08:
                cof *= 1 + rng.choice([0.12, -0.2, 0.5])
            conditions = {"shoe": shoe, "floor": "tile", "fluid": "soap"}
            if seed % 2:
                conditions["machine"] = f"m{k % 2}"
            files.append(result(f"{shoe} {k}", {"cof": float(cof)}, conditions))
    return files


def test_doubts_of_testers(file_regression):
    told = {
        f"{what} {seed}": [str(one) for one in guard.study_doubts(repeats(seed), how)]
        for what, how in (("tester", TESTER), ("readings", READINGS))
        for seed in range(10)
    }
    held(file_regression, told)


def pair(shift: float, first: int, second: int, *, three: bool = False, scatter: float = 0.004):
    """Return two persons whose bodies differ by a share, with so many trials each."""
    rng = np.random.default_rng(5)
    files = []
    people = [("a", 0.0, first), ("b", shift, second), *([("c", 0.3, 2)] if three else [])]
    for who, away, count in people:
        for k in range(count):
            sizes = np.exp(away + scatter * rng.normal(size=6))
            body = dict(zip((FORCE, HEIGHT, *DISTANCES), sizes.tolist(), strict=True))
            files.append(result(f"{who}{k}", {"rcof": 0.2}, {"person": who}, body=body))
    return files


def test_bodies_are_one_up_to_their_scatter(file_regression):
    """How far two bodies may differ hangs on the trials of both."""
    told = {}
    for first, second in ((3, 3), (6, 1), (1, 6), (2, 9), (9, 9)):
        for three in (False, True):
            widest = [
                shift
                for shift in np.arange(0.0, 0.03, 0.0005)
                if list(body_doubts.one_body(pair(shift, first, second, three=three), "person"))
            ]
            told[f"{first} and {second}, {'three' if three else 'two'}"] = (
                len(widest), max(widest, default=None)
            )  # fmt: skip
    held(file_regression, told)
