"""The three outsoles of G.6 as cases, and their friction by three laws from pin-level inputs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from underfoot.core import Progress, silent

if TYPE_CHECKING:
    from underfoot.assess.outcomes import Outcome
    from underfoot.case import Case

SOLES: dict[str, float] = {"hard": 70.0, "medium": 60.0, "soft": 50.0}
"""Shore A, assumed: the report prints no hardness."""
BAND = 5.0
"""Shore A to either side of each, assumed."""
LAWS: dict[str, str] = {
    "stribeck": "Eq. 17 of the pin as it is: no sole of its own",
    "asperity_ehl": "films at asperities: modulus and roughness of the sole",
    "bowden_tabor": "shear strength of the pin times the sole's real contact area",
}
SETUP = "whole_shoe_g6"
FLUID = "glycerol_50pct"
WINDOW = (0.2, 0.3, 0.4)
"""Beginning, middle and end of the averaging window after first contact, s (G.6.1)."""
ASSUMPTIONS = (
    "Hardness 70, 60 and 50 Shore A, each ± 5: not printed; between the pins of G.3 (40 to 70) and "
    "the shoes of Table 6 (58 to 85).",
    "Ten lugs across the heel: pitch 6 mm, lug 3.6 mm, channel 2.4 mm (that of G.4, "
    "G.5), a grid 3 mm deep: not printed.",
    "The bevel at the rear is the heel's facet of 10 deg over 30 mm, as in G.4; its side part and "
    "that it has no tread are left out: at 7 deg the heel stands on the edge before it.",
    "The cross-hatch texture counts as roughness Ra 7.24 um (treaded work shoe, Table 6): not "
    "printed.",
    "Floor: the vinyl of G.4; that of G.6 is not described.",
    "Pin's friction (polyurethane, Eq. 17) stands for all three compounds unless the law says "
    "otherwise.",
)


@dataclass(frozen=True, slots=True)
class SoleFriction:
    """One sole under the tester of G.6 by one law; numbers of the window's mean.

    ``deviation`` is the law's own standard deviation (nan: none known); ``low`` and ``high`` are
    the COF at the hardness band's ends (middle of the window).
    """

    sole: str
    law: str
    shore: float
    cof: float
    deviation: float
    low: float
    high: float
    sensor_pressure: float
    film_share: float
    breaches: tuple[str, ...]


def sole_case(shore: float, law: str) -> Case:
    """Return the case of one outsole (Shore A) under one friction law."""
    from underfoot.case import Case

    mapping: dict[str, Any] = {
        "file_version": 1,
        "name": f"Outsole of {shore:g} Shore A, 50 % glycerol",
        "shoe": {
            "from": "slip_tester_heel",
            "material": {"shore_a": shore},
            "roughness": {"ra": "7.24 um", "cutoff": "0.8 mm"},
            "tread": {
                "pattern": "grid",
                "depth": "3 mm",
                "lug_width": "3.6 mm",
                "channel_width": "2.4 mm",
            },
        },
        "floor": {"from": "vinyl_g4"},
        "contaminant": {"from": FLUID},
        "motion": {"from": SETUP},
        "sensor": {"from": "human_slip_g5"},
        "models": {"friction": law},
    }
    if law == "bowden_tabor":
        strength, left = pin_strength()
        mapping["interface"] = {"shear_strength": f"{strength!r} Pa", "hysteresis_cof": left}
    return Case.from_mapping(mapping)


def pin_strength() -> tuple[float, float]:
    """Return shear strength (Pa) under the fluid at the tester's speed, and what is hysteresis.

    The adhesion that Eq. 17 leaves on the pin at 0.3 m/s, over the pin's real contact area. The
    pin's asperities follow from its roughness by the rules that the sole's follow from.
    """
    from underfoot.calibrate import pin_on_disk
    from underfoot.case import build
    from underfoot.core.catalogue import Catalogue
    from underfoot.friction import self_affine_scale, shear_strength_from_cof, stribeck_cof
    from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION

    catalogue = Catalogue.load()
    pin = pin_on_disk(catalogue)
    own = next(one for one in build.measured_fluids(catalogue) if one.fluid == FLUID)
    assert own.tau_hydro is not None
    assert own.cof_asymptote is not None
    left = float(own.cof_asymptote.value or 0.0)
    cof = float(stribeck_cof(0.3, own.cof_boundary.value or 0.0, own.tau_hydro.value or 0.0, left))
    rules = sole_case(60.0, "stribeck").interface
    scale = self_affine_scale(
        STYLUS_RESOLUTION,
        rq=rules.roughness_beyond_cutoff * float(np.hypot(pin.sole_rq, pin.floor_rq)),
        longest_wave=rules.longest_wave,
        hurst=min(rules.hurst, 0.99),
    )
    share = float(scale.contact_fraction(pin.pressure / pin.modulus))
    source = "final progress report on shoe-floor friction, G.2.2"
    return shear_strength_from_cof(cof - left, pin.pressure, share, source).strength, left


def sole_frictions(
    *, quick: bool, processes: int | None = 1, progress: Progress = silent
) -> list[SoleFriction]:
    """Return the three soles by the three laws: 45 cases (27 with ``quick``)."""
    from underfoot.assess.outcomes import outcomes

    times = WINDOW[1:2] if quick else WINDOW
    plan = [(sole, law, shore) for law in LAWS for sole, shore in SOLES.items()]
    cases = []
    for _, law, shore in plan:
        base = sole_case(shore, law)
        cases += [base.replace("motion.duration", f"{time!r} s") for time in times]
        cases += [
            sole_case(shore + side * BAND, law).replace("motion.duration", f"{WINDOW[1]!r} s")
            for side in (1, -1)
        ]
    found = outcomes(
        cases, quick=quick, processes=processes, progress=progress, stage="Whole-shoe friction"
    )
    width = len(times) + 2
    return [
        _friction(sole, law, shore, found[i * width : (i + 1) * width])
        for i, (sole, law, shore) in enumerate(plan)
    ]


def _friction(sole: str, law: str, shore: float, found: list[Outcome]) -> SoleFriction:
    window, ends = found[:-2], [one.number("cof") for one in found[-2:]]
    values = np.array([one.number("cof") for one in window])
    weights = np.array([1.0, 4.0, 1.0]) / 6 if values.size == 3 else np.ones(1)
    middle = window[len(window) // 2]
    return SoleFriction(
        sole,
        law,
        shore,
        float(weights @ values),
        middle.spread("cof"),
        min(ends),
        max(ends),
        max(one.number("peak_fluid_pressure_sensor") for one in window),
        middle.number("fluid_load") / middle.number("normal_force"),
        tuple(dict.fromkeys(breach for one in window for breach in one.breaches)),
    )
