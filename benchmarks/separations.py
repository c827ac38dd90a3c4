"""Pairs of treads of which a designer asks the order: what would tell it where it is open?

``python -m benchmarks separations``: five pairs on one heel, each run on the coarse grid. Prints
the probability of the order, the step that ``underfoot compare`` names, the probability then and
by how many points it moved; "none tells" where no step that was tried moves it by 20 points.
"""

from __future__ import annotations

from underfoot import Case, compare, run
from underfoot.questions.separation import MOVES

TREADS = {
    "channels 2.5 mm": {"shoe.tread.channel_width": "2.5 mm"},
    "channels 4 mm": {"shoe.tread.channel_width": "4 mm"},
    "channels 6 mm": {"shoe.tread.channel_width": "6 mm"},
    "hexagons": {"shoe.tread.pattern": "hexagons", "shoe.tread.channel_width": "4 mm"},
    "bars": {"shoe.tread.pattern": "transverse", "shoe.tread.channel_width": "4 mm"},
    "bars along": {"shoe.tread.pattern": "longitudinal", "shoe.tread.channel_width": "4 mm"},
}
PAIRS = (
    ("channels 2.5 mm", "channels 4 mm"),
    ("channels 4 mm", "channels 6 mm"),
    ("channels 4 mm", "hexagons"),
    ("hexagons", "bars"),
    ("bars", "bars along"),
)


def main() -> None:
    """Print what would tell the order of each pair."""
    entries = {"floor": "vinyl_g4", "contaminant": "glycerol_90pct", "motion": "slip_tester_g4"}
    base = Case.from_mapping({"shoe": "work_shoe_full_tread", **entries})
    results = {
        name: run(base.replace({**changes, "name": name}), quick=True)
        for name, changes in TREADS.items()
    }
    print(f"{'pair':<36}{'COF':>14}{'order':>8}  step, order then, points")
    for pair in PAIRS:
        found = compare(*(results[name] for name in pair), separate=True)
        numbers = ", ".join(f"{results[name].scalars['cof'].value:.3f}" for name in pair)
        line = f"{' / '.join(pair):<36}{numbers:>14}"
        if found.order is None:
            print(f"{line}  not estimated", flush=True)
            continue
        line += f"{100 * found.order.told:6.0f} %"
        if not found.separations:
            print(f"{line}  {found.order.verdict}", flush=True)
            continue
        best = found.separations[0]
        moved = best.told - found.order.told
        told = "" if moved >= MOVES else "; none tells"
        print(f"{line}  {best.step}, {100 * best.told:.0f} %, {100 * moved:+.0f}{told}", flush=True)


if __name__ == "__main__":
    main()
