"""Previews against the whole runs that they stand in for: are those inside the ± of the preview?

``python -m benchmarks.previews [EXAMPLE ...]``: random settings over the
whole range of the sliders of the app, one or two at once. A setting that has no preview, such as
another tread, is run in full by the app; these are counted apart. Some 10 s of CPU a setting.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from underfoot import Case, run
from underfoot.app.run_preview import preview_of_run
from underfoot.core import UnderfootError

EXAMPLES = (
    "athletic_shoe_full_tread_detergent",
    "athletic_shoe_half_tread_glycerol",
    "work_shoe_half_tread_glycerol",
    "athletic_shoe_untreaded_glycerol",
)
"""Soles on which no constant of the previews was chosen."""
RANGES = {
    "motion.speed": (0.05, 1.5, "m/s"),
    "contaminant.viscosity": (0.5, 1000.0, "cP"),
    "shoe.wear.depth": (0.0, 4.0, "mm"),
    "shoe.material.shore_a": (45.0, 85.0, ""),
    "motion.normal_force": (100.0, 900.0, "N"),
    "motion.shoe_angle": (0.0, 20.0, "deg"),
}
NAMES = ("cof", "fluid_load")
SETTINGS, SEED = 25, 29


def setting(rng: np.random.Generator) -> dict[str, str | float]:
    """Return one or two inputs at random; viscosity by decades."""
    changes: dict[str, str | float] = {}
    for path in rng.choice(list(RANGES), size=int(rng.integers(1, 3)), replace=False):
        path = str(path)
        low, high, unit = RANGES[path]
        value = rng.uniform(low, high)
        if path == "contaminant.viscosity":
            value = float(np.exp(rng.uniform(np.log(low), np.log(high))))
        changes[path] = f"{value:.3g} {unit}" if unit else round(value, 1)
    return changes


def compared(example: str) -> Mapping[str, list[float]]:
    """Return what each preview was off by over its own ±, by name; print every setting."""
    path = Path(__file__).resolve().parents[1] / "examples" / f"{example}.toml"
    case = Case.load(path).replace({"sensor.scans": 1})
    whole, rng = run(case).scalars, np.random.default_rng([SEED, *example.encode()])
    preview_of_run(case, {}, whole)
    off: dict[str, list[float]] = {name: [] for name in (*NAMES, "width", "seconds", "refused")}
    for _ in range(SETTINGS):
        changes, began = setting(rng), time.process_time()
        try:
            seen = preview_of_run(case, changes, whole)
        except UnderfootError as error:
            off["refused"].append(time.process_time() - began)
            print(f"{changes}: no preview ({str(error)[:60]})", flush=True)
            continue
        seconds = time.process_time() - began
        full = run(case.replace(changes))
        if not full.usable:
            print(f"{changes}: the whole run gives no result", flush=True)
            continue
        off["seconds"].append(seconds)
        off["width"].append(seen.errors["cof"] / seen.values["cof"])
        lines = []
        for name in NAMES:
            value = full[name].value or 0.0
            off[name].append((seen.values[name] - value) / seen.errors[name])
            lines.append(f"{name} {seen.values[name]:.4g} ± {seen.errors[name]:.2g}, {value:.4g}")
        print(f"{changes}: {'; '.join(lines)}", flush=True)
    return off


def main(examples: Sequence[str] = ()) -> None:
    """Print each setting, then how many whole runs lie inside the ± of their preview."""
    every: dict[str, list[float]] = {}
    for example in examples or EXAMPLES:
        for name, values in compared(example).items():
            every.setdefault(name, []).extend(values)
    for name in NAMES:
        inside = sum(abs(value) <= 1.0 for value in every[name])
        print(f"{name}: {inside} of {len(every[name])} whole runs inside the ± of their preview")
    width, seconds = (np.median(every[name]) for name in ("width", "seconds"))
    print(f"median ± of the COF {100 * width:.1f} %, {seconds:.2f} s of CPU a preview;", end=" ")
    print(f"no preview of {len(every['refused'])} settings")


if __name__ == "__main__":
    main(sys.argv[1:])
