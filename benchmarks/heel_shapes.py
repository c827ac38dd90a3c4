"""What the shape of a heel does to its film: marches of one case on its quick grid.

``python -m benchmarks heel_shapes``: by how much ln F / (W - F) moves, F the load on the film of W,
where the shoe or its bevel is turned, and where lengths that nobody measured are others. Three
examples, two minutes.
"""

from __future__ import annotations

import math

from underfoot import Case
from underfoot.compute.position_draws import Place, log_film_odds
from underfoot.compute.prepare import prepared
from underfoot.compute.solve import solved_at
from underfoot.sole_contact.solver import SoleContact

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


def film_odds(contact: SoleContact) -> float:
    """Return ln F / (W - F)."""
    return float(log_film_odds(contact.fluid_load, contact.normal_force - contact.fluid_load))


def march(case: Case, turn: float = 0.0) -> float:
    """Return the film's odds with the shoe turned by ``turn``, degrees."""
    spacing = case.numerics.quick_grid_spacing
    place = Place(turn=math.radians(turn))
    return film_odds(solved_at(prepared(case, spacing), place, spacing)[1])


def main() -> None:
    """Print the table of each example."""
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


if __name__ == "__main__":
    main()
