"""The studies there are."""

from __future__ import annotations

from dataclasses import dataclass

from underfoot.core import unknown_name


@dataclass(frozen=True, slots=True)
class Study:
    """One publication that can be run again; ``module`` under this room holds ``run``."""

    name: str
    title: str
    source: str
    module: str


STUDIES: tuple[Study, ...] = (
    Study(
        "g1",
        "Micro-model of shoe-floor friction: hysteresis and real contact area of a rough block",
        "final progress report on shoe-floor friction, G.1",
        "underfoot.studies.g1",
    ),
    Study(
        "g2",
        "Friction falling with speed under fluids: which mechanism predicts the others blind",
        "final progress report on shoe-floor friction, G.2",
        "underfoot.studies.g2",
    ),
    Study(
        "g3",
        "Adhesion left under fluids in boundary lubrication: Eq. 26 and its order of soles",
        "final progress report on shoe-floor friction, G.3",
        "underfoot.studies.g3",
    ),
    Study(
        "g4",
        "Fluid pressure under six shoes in two fluids: who is on the right side of 5 N",
        "final progress report on shoe-floor friction, G.4",
        "underfoot.studies.g4",
    ),
    Study(
        "g5",
        "Fluid pressure and speed in unexpected slips: untreaded against treaded",
        "final progress report on shoe-floor friction, G.5",
        "underfoot.studies.g5",
    ),
    Study(
        "g6",
        "Three outsoles in 50 % glycerol: friction from pin-level inputs, and who slips",
        "final progress report on shoe-floor friction, G.6",
        "underfoot.studies.g6",
    ),
    Study(
        "calibration",
        "Which parameters the report's data can fix, and which they can't",
        "final progress report on shoe-floor friction, G.2, G.4, G.5, G.6",
        "underfoot.studies.calibration",
    ),
)


def study(name: str) -> Study:
    """Return a study by its name; an unknown name is answered with the nearest one."""
    for one in STUDIES:
        if one.name == name.strip().lower():
            return one
    raise unknown_name("study", name, [one.name for one in STUDIES])
