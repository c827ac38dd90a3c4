"""A made-up study of walking: persons in several shoes, the effect of each shoe known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from underfoot.core import Progress, silent

from .c3d_file import NOTICE, walk_c3d
from .walk import Defects, SlipTruth, walk_with_slip

SHOES: Mapping[str, float] = {"hard": 0.195, "medium": 0.205, "soft": 0.225}
"""Mean required friction of all persons in each shoe."""
NAMES = r"S(?P<subject>\d+)_(?P<shoe>[a-z]+)_(?P<n>\d+)"
"""Pattern of the file names."""
BETWEEN, OWN, TRIAL = 0.020, 0.006, 0.008
"""Standard deviations: between persons, of a person's own answer to a shoe, between trials."""


def simulated_study(
    out: Path, *, persons: int = 12, trials: int = 4, seed: int = 1, progress: Progress = silent
) -> list[Path]:
    """Write a study with named files (``S01_hard_1.c3d``) and return their paths.

    RCOF of a trial = mean of the shoe + person + person in the shoe + trial, all normal with the
    standard deviations of this module. Each file holds one step on one plate.

    Parameters
    ----------
    persons, trials
        Number of persons, and of trials of each in each shoe.
    """
    out.mkdir(parents=True, exist_ok=True)
    (out / "SYNTHETIC.txt").write_text(NOTICE, encoding="utf-8")
    paths, lines = [], ["file,rcof"]
    total = persons * len(SHOES) * trials
    for person in range(persons):
        own = np.random.default_rng([seed, 1, person])
        level, mass = BETWEEN * own.standard_normal(), float(own.uniform(55, 90))
        for shoe, mean in SHOES.items():
            answer = OWN * own.standard_normal()
            for trial in range(trials):
                rcof = float(
                    np.clip(mean + level + answer + TRIAL * own.standard_normal(), 0.1, 0.4)
                )
                recording = walk_with_slip(
                    SlipTruth(rcof=rcof, mass=mass, peak_speed=0.05), Defects(), own
                )
                idle = own.normal(0.0, 1.0, recording.force[1].shape)
                recording = replace(recording, force=(recording.force[0], idle), pressures={})
                path = out / f"S{person + 1:02d}_{shoe}_{trial + 1}.c3d"
                path.write_bytes(walk_c3d(recording))
                paths.append(path)
                lines.append(f"{path.name},{recording.truth['rcof']:.6g}")
                progress("writing made-up trials", len(paths) / total)
    (out / "truth.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (out / "profile.toml").write_text(
        '# Made-up recordings: nothing was measured.\nname = "synthetic walkway"\n\n'
        '[axes]\nvertical = "+z"\nwalking = "+x"\n\n[heel]\nleft = "LHEE"\nright = "RHEE"\n',
        encoding="utf-8",
    )
    return paths
