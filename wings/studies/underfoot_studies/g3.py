"""Report G.3: adhesion left under fluids in boundary lubrication (Eq. 26, Table 5)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core.catalogue import Catalogue
from underfoot.fluid import BLOCKING
from underfoot.friction import self_affine_scale
from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION
from underfoot.material import youngs_modulus_gent
from underfoot.studies.figure import Figure, Panel, grouped_bars
from underfoot.studies.runner import Computed, Options, Table
from underfoot.studies.verdict import Quantity

STATEMENTS = Path(__file__).with_name("g3.toml")

SOLES = {
    "polyurethane": "polyurethane_40a",
    "soft rubber": "rubber_60a",
    "hard rubber": "rubber_70a",
}
FLOORS = {"vinyl": "vinyl_g3", "marble": "marble_g3"}
RQ_PER_RA = float(np.sqrt(np.pi / 2))
CONTACT_PRESSURE = 266.1e3


def compute(options: Options) -> Computed:
    """Return Eq. 26 at its best beside the printed ranges, and real contact area of the pairs."""
    catalogue = Catalogue.load()
    published = catalogue.entry("published", "boundary_g3")
    left: dict[str, np.ndarray] = {}
    quantities: dict[str, Quantity] = {}
    dry: dict[str, float] = {}
    for sole in SOLES:
        name = sole.replace(" ", "_")
        low, high = published.numbers(f"lubricated_adhesion_{name}", "N")
        dry[sole] = nearest_dry_adhesion(low, high)
        left[sole] = np.array([float(b.lubricated_adhesion(dry[sole])) for b in BLOCKING.values()])
        quantities[f"eq26.{name}.lowest"] = Quantity.of(left[sole].min(), "N")
        quantities[f"eq26.{name}.highest"] = Quantity.of(left[sole].max(), "N")
    options.progress("contact area", 0.5)
    area = contact_areas(catalogue)
    by_sole = [float(np.mean([area[sole, floor] for floor in FLOORS])) for sole in SOLES]
    quantities["contact_area"] = Quantity.of(by_sole, names=tuple(SOLES))
    alpha = {fluid: float(blocking.alpha) for fluid, blocking in BLOCKING.items()}
    beta = {fluid: float(blocking.beta) for fluid, blocking in BLOCKING.items()}
    rest = [value for name, value in alpha.items() if name not in ("water", "canola oil")]
    # the middle of an order that names both ends only: nearest to being out of it
    ends = (alpha["water"] - max(rest), min(rest) - alpha["canola oil"])
    middle = max(rest) if ends[0] < ends[1] else min(rest)
    quantities["alpha"] = Quantity.of(
        [alpha["water"], middle, alpha["canola oil"]], names=("water", "other fluids", "canola oil")
    )
    ends = (
        min(value for name, value in beta.items() if name.startswith("glycerol")),
        max(value for name, value in beta.items() if not name.startswith("glycerol")),
    )
    quantities["beta"] = Quantity.of(ends, names=("glycerols", "other fluids"))
    return Computed(
        quantities,
        (
            Table.of(
                "eq26",
                "Adhesion left under each fluid by Eq. 26, N at 20.9 N, at the dry adhesion that "
                "fits best",
                [
                    {"fluid": fluid, **{f"{k} ({dry[k]:.1f} N dry)": left[k][i] for k in SOLES}}
                    for i, fluid in enumerate(BLOCKING)
                ],
            ),
            Table.of(
                "contact_area",
                "Share of real contact at 266.1 kPa (Persson 2001), which times one shear strength "
                "would be the dry adhesion",
                [{"sole": s, **{floor: area[s, floor] for floor in FLOORS}} for s in SOLES],
            ),
        ),
        {
            "fig22_contact_area": _bars(
                {floor: [area[sole, floor] for sole in SOLES] for floor in FLOORS},
                [*SOLES],
                "real over apparent contact",
                "Fig. 22: in its place the share of real contact",
            ),
            "fig24_adhesion": _bars(
                left,
                [fluid.replace("_", " ") for fluid in BLOCKING],
                "adhesion (N)",
                "Fig. 24: adhesion left under each fluid by Eq. 26",
            ),
        },
        (
            f"Eq. 26 with Table 5 leaves at least {alpha['water']:.2f} N under water and "
            f"{alpha['canola oil']:.2f} N under canola oil on every pair, whatever the dry "
            "adhesion: alpha and beta are means over soles that behave differently (R2 0.49).",
            "Its use is a fluid's rank and a rough size; for one pair, measured friction goes "
            "first.",
        ),
    )


def nearest_dry_adhesion(lowest: float, highest: float) -> float:
    """Return the dry adhesion (N) at which Eq. 26 over six fluids comes nearest to a range (N)."""
    dry = np.linspace(0.0, 30.0, 3001)
    left = np.array([b.lubricated_adhesion(dry) for b in BLOCKING.values()])
    error = np.maximum(np.abs(left.min(axis=0) - lowest), np.abs(left.max(axis=0) - highest))
    return float(dry[int(np.argmin(error))])


def contact_areas(catalogue: Catalogue) -> dict[tuple[str, str], float]:
    """Return the share of real contact of each sole on each floor."""
    found = {}
    for sole, entry_name in SOLES.items():
        entry = catalogue.entry("material", entry_name)
        modulus = float(youngs_modulus_gent(float(entry.leaf("shore_a").given))) / 0.75
        for floor, floor_name in FLOORS.items():
            other = catalogue.entry("floor", floor_name)
            ra = [e.sourced("roughness.ra", "m").value or 0.0 for e in (entry, other)]
            scale = self_affine_scale(
                STYLUS_RESOLUTION, rq=RQ_PER_RA * float(np.hypot(ra[0], ra[1])), longest_wave=0.8e-3
            )
            found[sole, floor] = float(scale.contact_fraction(CONTACT_PRESSURE / modulus))
    return found


def _bars(groups: Mapping[str, ArrayLike], names: list[str], label: str, title: str) -> Figure:
    panel = Panel(grouped_bars(groups), y_label=label, x_ticks=names)
    return Figure([panel], title, size=(8.2, 4.2))
