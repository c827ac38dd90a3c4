"""Film and COF of ten soles by layers and by finite elements, on three grids, sliding steadily.

``python -m benchmarks.compliances [SOLE ...]``: one position of the tread at the shoe's own
angle; half an hour of CPU for all. ``squares`` in place of a sole: film and COF by layers, with
long waves put right by bricks of other sides.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from underfoot import Case, run
from underfoot.core import UnderfootError
from underfoot.sole_contact import long_waves

MODELS = "layered", "finite_element"
GRIDS = ("1 mm", "0.6 mm", "0.4 mm")
SIDES = (6e-3, 5e-3, 4.375e-3, 3.5e-3, 2.9e-3)  # m
FILM_WITHIN, COF_WITHIN, LOAD_LEAST = 0.03, 0.02, 2.0  # relative, relative, N
PLAIN = "work_shoe_untreaded"
SLOW: dict[str, Any] = {"speed": "0.3 m/s"}
SOLES: dict[str, dict[str, Any]] = {
    "plain": {},
    "athletic, arc channel": {"shoe.from": "athletic_shoe_untreaded"},
    "full tread": {"shoe.from": "work_shoe_full_tread"},
    "half tread": {"shoe.from": "work_shoe_half_tread"},
    "rocker 120 mm": {
        "heel.profile": {"model": "rocker", "radius": "120 mm", "start": "40 mm"},
    },
    "facet 9 deg at 7": {
        "heel.profile.angle": "9 deg",
        "contaminant": {"viscosity": "80 cP"},
        "motion": SLOW | {"shoe_angle": "7 deg"},
    },
    "bars, facet 5 deg": {
        "shoe.from": "work_shoe_full_tread",
        "tread": {"pattern": "bars", "lug_width": "8 mm", "channel_width": "3 mm"},
        "heel.profile.angle": "5 deg",
        "contaminant": {"viscosity": "60 cP"},
        "motion": {"shoe_angle": "5 deg", "speed": "0.5 m/s"},
    },
    "midsole": {
        "sole": {
            "outsole_thickness": "15 mm",
            "midsole": {"modulus": "2 MPa", "thickness": "10 mm"},
        },
    },
    "facet 45 mm, 300 N": {
        "heel.profile.length": "45 mm",
        "motion": {"normal_force": "300 N"},
    },
    "flat, 50 cP": {
        "heel.profile": {"model": "flat"},
        "contaminant": {"viscosity": "50 cP"},
        "motion": SLOW | {"shoe_angle": "0 deg"},
    },
}


def case(sole: str, grid: str, model: str) -> Case:
    """Return the case of a sole on a grid."""
    given = dict(SOLES[sole])
    shoe: dict[str, Any] = {"from": given.pop("shoe.from", PLAIN)}
    motion = {"from": "slip_tester_g4", "steady": True} | given.pop("motion", {})
    fluid = given.pop("contaminant", {"from": "glycerol_90pct"})
    for path, value in given.items():
        table, *names = [shoe, *path.split(".")]
        for name in names[:-1]:
            table = table.setdefault(name, {})
        table[names[-1]] = value
    return Case.from_mapping(
        {
            "file_version": 2,
            "shoe": shoe,
            "floor": {"from": "vinyl_g4"},
            "contaminant": fluid,
            "motion": motion,
            "numerics": {"tread_positions": 1, "grid_spacing": grid},
            "compliance": {"model": model},
        }
    )


def numbers(sole: str, grid: str, model: str) -> tuple[float, float]:
    """Return COF and load on the film, N."""
    result = run(case(sole, grid, model))
    return result.value("cof"), result.value("fluid_load")


def squares() -> None:
    """Print what the side of a brick, which no input sets, does to heels and treads on 1 mm."""
    usual = long_waves.SIDE, long_waves.MOST_SQUARES
    print("| sole | side, mm | COF | film, N |")
    print("|---|---|---|---|")
    for sole in ("plain", "facet 9 deg at 7", "full tread", "bars, facet 5 deg"):
        for side in SIDES:
            long_waves.SIDE, long_waves.MOST_SQUARES = side, 2000
            cof, film = numbers(sole, GRIDS[0], MODELS[0])
            print(f"| {sole} | {1e3 * side:.2f} | {cof:.4f} | {film:.1f} |", flush=True)
    long_waves.SIDE, long_waves.MOST_SQUARES = usual


def main(chosen: Sequence[str] = ()) -> None:
    """Print one line for each sole and grid; ``chosen``: names of soles, all where empty."""
    if "squares" in chosen:
        return squares()
    print("| sole | grid | COF by layers, elements | film, N | agree |")
    print("|---|---|---|---|---|")
    for sole in chosen or SOLES:
        for grid in GRIDS:
            try:
                rows = [numbers(sole, grid, model) for model in MODELS]
            except UnderfootError as error:
                print(f"| {sole} | {grid} | {error} | | |", flush=True)
                continue
            cof, film = zip(*rows, strict=True)
            near = abs(cof[0] / cof[1] - 1) < COF_WITHIN
            near &= abs(film[0] - film[1]) < max(FILM_WITHIN * film[1], LOAD_LEAST)
            print(
                f"| {sole} | {grid} | {', '.join(f'{c:.4f}' for c in cof)} "
                f"| {', '.join(f'{f:.1f}' for f in film)} | {'yes' if near else 'no'} |",
                flush=True,
            )


if __name__ == "__main__":
    main(sys.argv[1:])
