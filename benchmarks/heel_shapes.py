"""What the shape of a heel does to its film: marches of one case on its quick grid.

``python -m benchmarks heel_shapes``: by how much ln F / (W - F) moves, F the load on the film of W,
where the shoe or its bevel is turned, and where lengths that nobody measured are others: each in
three examples (two minutes), then all at once in 40 soles drawn at random (ten minutes).
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks import steadiness
from underfoot import Case
from underfoot.compute.numbers import FILM_ERROR
from underfoot.compute.position_draws import TreadPlace, log_film_odds
from underfoot.compute.positions import case_places, has_lugs, shoe_angles
from underfoot.compute.prepare import prepare_case
from underfoot.compute.solve import LEAST_FILM, film_odds, solved_at
from underfoot.core import UnderfootError

EXAMPLES = (
    "work_shoe_untreaded_glycerol",
    "athletic_shoe_untreaded_glycerol",
    "work_shoe_half_tread_glycerol",
)
TURNS = (-2.0, -1.5, -1.0, -0.7, 0.7, 1.0, 1.5, 2.0)
"""Of the shoe toe up, degrees; of its bevel the other way."""
CHANGES = {
    "shoe.heel.profile.length": ("37 mm", "53 mm"),
    "shoe.heel.edge_radius": ("1 mm", "3 mm"),
    "shoe.heel.width": ("67 mm", "73 mm"),
    "shoe.sole.outsole_thickness": ("20 mm", "30 mm"),
    "shoe.wear.depth": ("0.3 mm",),
}

DEVIATIONS = {
    "shoe.heel.profile.length": 8e-3,
    "shoe.heel.edge_radius": 1e-3,
    "shoe.heel.width": 3e-3,
    "shoe.sole.outsole_thickness": 5e-3,
}
"""Standard deviations of what nobody measured, m, as ``underfoot sensitivity`` varies it."""
LEAST = 0.2e-3  # m
SOLES, DRAWS, SEED = 40, 2, 51


def march(case: Case, turn: float = 0.0) -> float:
    """Return the film's odds with the shoe turned by ``turn``, degrees."""
    spacing = case.numerics.quick_grid_spacing
    place = TreadPlace(turn=math.radians(turn))
    return film_odds(solved_at(prepare_case(case, spacing), place, spacing)[1])


def mean_odds(case: Case) -> float:
    """Return the odds of the mean film of a quick run, over the places of its tread or angles."""
    spacing = case.numerics.quick_grid_spacing
    parts = prepare_case(case, spacing)
    places = case_places(case, quick=True) if has_lugs(case) else shoe_angles()
    contacts = [solved_at(parts, place, spacing)[1] for place in places]
    if not all(contact.status.usable for contact in contacts):
        raise UnderfootError("a place did not converge")
    film, load = (
        float(np.mean([getattr(contact, name) for contact in contacts]))
        for name in ("fluid_load", "normal_force")
    )
    return float(log_film_odds(film, load - film))


def joint_draws() -> None:
    """Print what joint draws of the lengths do to the film of soles drawn at random."""
    rng, rows = np.random.default_rng(SEED), list[tuple[float, float]]()
    steadiness.SEED, steadiness.SOLES = SEED, SOLES
    for name, case in steadiness.soles():
        own, here = mean_odds(case), list[float]()
        for _ in range(DRAWS):
            drawn = {
                path: max(case.value(path) + rng.normal(0, sd), LEAST)
                for path, sd in DEVIATIONS.items()
                if case.sourced_value(path).value is not None
            }
            try:
                here.append(mean_odds(case.replace(drawn)) - own)
            except UnderfootError as error:  # such a heel can't be, or did not converge
                print(f"  {name}: {error}")
        share = 1 / (1 + math.exp(-own))
        rows += [(share, each) for each in here]
        moves = ", ".join(f"{each:+.2f}" for each in here)
        print(f"  {name}: {share:.2%} of the load; {moves}", flush=True)
    share, moved = np.array(rows).T
    for words, least in (("all", 0.0), (f"films from {LEAST_FILM:.1%} of the load on", LEAST_FILM)):
        these = np.abs(moved[share >= least])
        rms, within = float(np.sqrt(np.mean(these**2))), np.sum(these < 1.96 * FILM_ERROR)
        print(f"{these.size} joint draws ({words}): rms {rms:.2f}, at most {these.max():.2f};")
        print(f"{within} lie within 95 % of the film's error of {FILM_ERROR:.2f}, ", end="")
        print(f"{(rms / FILM_ERROR) ** 2:.0%} of its variance")


def main() -> None:
    """Print the table of each example, and what joint draws do to soles drawn at random."""
    path = "shoe.heel.profile.angle"
    for name in EXAMPLES:
        case = Case.load(f"examples/{name}.toml")
        own, angle = march(case), math.degrees(case.value(path))
        print(f"{name}: ln F / (W - F) = {own:.2f}, and moves by")
        for turn in TURNS:
            bevel = march(case.replace(path, f"{angle - turn} deg")) - own
            print(f"  {turn:+4.1f} deg: shoe {march(case, turn) - own:+.2f}, bevel {bevel:+.2f}")
        for changed, values in CHANGES.items():
            moved = [
                f"{value} {march(case.replace(changed, value)) - own:+.2f}" for value in values
            ]
            print(f"  {changed}: {', '.join(moved)}")
    joint_draws()


if __name__ == "__main__":
    main()
