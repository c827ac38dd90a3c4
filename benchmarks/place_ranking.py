"""``underfoot choose``: whether shoes rank the same on another grid and with treads moved."""

import tomllib
from pathlib import Path

from underfoot.places.choice import choose_shoe
from underfoot.places.place import place_of

FOLDER = Path(__file__).parents[1] / "examples" / "places"
PLACES = ("hospital_corridor", "kitchen")
SHIFTS = ("2 mm", "4 mm")
ALIKE = 0.1
"""Difference of two chances of being best within which an order says nothing."""


def main() -> None:
    for name in PLACES:
        text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
        ways = {"coarse grid": chances(text), "fine grid": chances(text, quick=False)}
        ways |= {f"tread {shift} on": chances(text, shift=shift) for shift in SHIFTS}
        first = ways["coarse grid"]
        print(f"{name}: chance that each shoe is best")
        for way, best in ways.items():
            told = ", ".join(f"{shoe} {chance:.2f}" for shoe, chance in best.items())
            order = "the same order" if ordered_alike(first, best) else "ANOTHER ORDER"
            print(f"  {way}: {told}: {order}")


def chances(text: str, *, quick: bool = True, shift: str = "0 mm") -> dict[str, float]:
    """Return the chance of each shoe to be best, treads moved along the sole by ``shift``."""
    table = tomllib.loads(text)
    for shoe in table["shoe"]:
        if "untreaded" not in shoe.get("from", "untreaded"):
            shoe["tread"] = {**shoe.get("tread", {}), "offset_along": shift}
    return {each.shoe.name: each.best for each in choose_shoe(place_of(table), quick=quick).shoes}


def ordered_alike(first: dict[str, float], other: dict[str, float]) -> bool:
    """Return whether no two shoes that one way tells apart are turned round by the other."""
    return not any(
        first[one] - first[two] > ALIKE and other[two] - other[one] > ALIKE
        for one in first
        for two in first
    )
