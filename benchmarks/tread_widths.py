"""Film load and COF against the width of lugs and channels: do they move smoothly?

``python -m benchmarks.tread_widths [--quick] [--vary lug|channel|both] [--begin MM] [--count N]
[KEY=VALUE ...]``, as ``--quick --vary lug --begin 5.9 --count 8 numerics.cells_along=16``. Bars in
glycerol, 60 lug widths from 5 to 7 mm and 60 channel widths from 2 to 6 mm; ``--count`` takes that
many neighbours of them. The step is always that of the whole range, so that parts of it compare.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from underfoot import Case, run
from underfoot.cli.options import setting

MM = 1e-3
WIDTHS = {
    "lug": np.linspace(5 * MM, 7 * MM, 60),
    "channel": np.linspace(2 * MM, 6 * MM, 60),
}
ALLOWED = {"film load": 0.03, "COF": 0.005}
"""Second differences that a designer's steps stand out from."""


def bars(settings: dict[str, object]) -> Case:
    """Return the case whose widths vary: bars 6 mm wide, channels 4 mm, under the work heel."""
    return Case(
        shoe={
            "from": "work_shoe_full_tread",
            "tread": {
                "pattern": "transverse",
                "depth": "3 mm",
                "lug_width": "6 mm",
                "channel_width": "4 mm",
            },
        },
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion="slip_tester_g4",
    ).replace({"contaminant.viscosity": "150 cP", **settings})


def second_differences(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return |f_(i-1) - 2 f_i + f_(i+1)| over the mean of the three, 1."""
    low, middle, high = values[:-2], values[1:-1], values[2:]
    return np.abs(low - 2 * middle + high) / ((low + middle + high) / 3)


def table(case: Case, name: str, widths: NDArray[np.float64], *, quick: bool) -> None:
    """Print film load and COF at each width, and their second differences."""
    print(f"\n{name} mm   film N      COF   CPU s")
    found: list[tuple[float, float]] = []
    for width in widths:
        began = time.process_time()
        result = run(case.replace(f"shoe.tread.{name}_width", float(width)), quick=quick)
        cpu = time.process_time() - began
        film, cof = result["fluid_load"].value, result["cof"].value
        if film is None or cof is None:
            film = cof = float("nan")
        found.append((film, cof))
        print(f"{width / MM:6.3f}  {film:7.2f}  {cof:.5f}  {cpu:6.2f}", flush=True)
    for what, values in zip(ALLOWED, np.transpose(found), strict=True):
        if values.size < 3:
            continue
        differences = second_differences(values)
        worst = float(np.max(differences))
        verdict = "holds" if worst <= ALLOWED[what] else "fails"
        print(
            f"{what}: second difference {np.median(differences):.2%} in the median, "
            f"{worst:.2%} at most ({verdict}: below {ALLOWED[what]:.1%})"
        )


def main(arguments: Sequence[str] = ("--count", "6", "--quick")) -> None:
    """Print the tables that the arguments ask for; without any a small part of both."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.tread_widths")
    parser.add_argument("--quick", action="store_true", help="the coarse grid of the case")
    parser.add_argument("--vary", choices=(*WIDTHS, "both"), default="both")
    parser.add_argument("--begin", type=float, default=0.0, help="first width, mm")
    parser.add_argument("--count", type=int, default=60, help="widths of each table")
    parser.add_argument("settings", nargs="*", help="KEY=VALUE of the case")
    chosen = parser.parse_args(arguments)
    case = bars(dict(setting(each) for each in chosen.settings))
    for name in WIDTHS if chosen.vary == "both" else (chosen.vary,):
        widths = WIDTHS[name]
        table(case, name, widths[widths >= chosen.begin * MM][: chosen.count], quick=chosen.quick)


if __name__ == "__main__":
    import sys

    main(sys.argv[1:])
