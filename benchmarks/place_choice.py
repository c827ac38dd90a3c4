"""``underfoot choose``: five shoes, three floors and four fluids against a minute of CPU."""

import time
import tomllib
from pathlib import Path

from benchmarks._table import Row
from underfoot.places.choice import choose_shoe
from underfoot.places.place import place_of

KITCHEN = Path(__file__).parents[1] / "examples" / "places" / "kitchen.toml"
FLUIDS = {"dry": 0.8, "water": 0.06, "detergent": 0.05, "canola_oil": 0.05, "glycerol_50pct": 0.04}
LIMIT = 60.0
"""s of CPU."""


def main() -> None:
    row = rows()[0]
    print(f"{row.job}: {row.cpu:.1f} s of CPU, limit {LIMIT:.0f} s")
    print("within the limit" if row.cpu < LIMIT else "TOO MUCH")


def rows() -> list[Row]:
    """Return the job of the common table."""
    table = tomllib.loads(KITCHEN.read_text(encoding="utf-8"))
    for floor in table["floor"]:
        floor["fluids"] = FLUIDS
    place = place_of(table)
    start = time.process_time()
    choose_shoe(place, quick=False)
    seconds = time.process_time() - start
    shape = f"{len(place.shoes)} shoes x {len(place.floors)} floors x {len(place.fluids())} fluids"
    return [Row(f"choose, {shape}, fine grid", seconds)]
