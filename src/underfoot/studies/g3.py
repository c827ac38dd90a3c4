"""Report G.3: boundary lubrication at 0.01 m/s, by the default law of a case and by Eq. 26."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from underfoot.case.friction import range_95
from underfoot.core.arrays import Array
from underfoot.core.catalogue import Catalogue
from underfoot.fluid import BLOCKING
from underfoot.friction import Pair, PairDraws, self_affine_scale
from underfoot.friction.asperity_ehl import STYLUS_RESOLUTION
from underfoot.material import youngs_modulus_gent
from underfoot.trials.statistics import analysis_of_variance

from .default_law import (
    FAMILIES,
    RQ_PER_RA,
    chance_of_order,
    cof_draws,
    draws_without_report,
    viscosity_of,
    with_reading_error,
)
from .figure import GREY, OURS, PRINTED, Figure, Layer, Panel, grouped_bars, points
from .runner import Computed, Options, StudyTable
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("g3.toml")

SOLES = {
    "polyurethane": "polyurethane_40a",
    "soft rubber": "rubber_60a",
    "hard rubber": "rubber_70a",
}
FLOORS = {"vinyl": "vinyl_g3", "marble": "marble_g3"}
FLUIDS = {
    "water": "water_g2",
    "detergent 1.5 %": "detergent_g2",
    "glycerol 25 %": "glycerol_25pct",
    "glycerol 50 %": "glycerol_50pct",
    "glycerol 75 %": "glycerol_75pct",
    "canola oil": "canola_oil",
}
"""Of Table 5, by the catalogue's names."""
TICKS = ("water", "detergent", "gly. 25 %", "gly. 50 %", "gly. 75 %", "canola oil")
"""The same, short below an axis."""
OIL = "gear_oil_75w140"
"""Blocks most of the adhesion: what is left counts as hysteresis (Eq. 23)."""
SCATTER, REPEATS = 0.82, 3
"""N: the report's standard deviation of a reading; how often each was taken (assumed)."""
TIE = SCATTER / np.sqrt(REPEATS)
CONTACT_PRESSURE, LOAD, SPEED = 266.1e3, 20.9, 0.01
"""Pa, N, m/s (G.3.1)."""


@dataclass(frozen=True, slots=True)
class PrintedSplit:
    """Friction of one pair by the default law as the report splits it, N.

    ``adhesion`` (dry less oiled), ``hysteresis`` (under the oil) and ``lubricated`` by fluid (less
    the oiled one, none where that is higher) are (draws,);
    ``medians`` are the same three at the medians of the law's inputs. ``loss`` (draws,) is the part
    of the oiled friction that the compound loses, by its loss tangent.
    """

    adhesion: Array
    hysteresis: Array
    lubricated: Mapping[str, Array]
    medians: tuple[float, float, Mapping[str, float]]
    loss: Array


def compute(options: Options) -> Computed:
    """Return the splits of the default law, Eq. 26 at its best, and real contact areas."""
    catalogue = Catalogue.load()
    draws = draws_without_report(options.seed)
    splits = {(s, f): split(catalogue, draws, s, f, options.seed) for s in SOLES for f in FLOORS}
    options.progress("Eq. 26 and contact area", 0.6)
    dry, left = eq26_at_its_best(catalogue)
    area = contact_areas(catalogue)
    by_sole = [float(np.mean([area[sole, floor] for floor in FLOORS])) for sole in SOLES]
    # of one strength: that which gives all pairs together the default law's adhesion
    strength = np.mean([one.medians[0] for one in splits.values()]) / np.mean(by_sole)
    return Computed(
        {
            **default_quantities(splits),
            **{
                f"eq26.{sole.replace(' ', '_')}.{name}": ComputedQuantity.of(end(left[sole]), "N")
                for sole in SOLES
                for name, end in (("lowest", np.min), ("highest", np.max))
            },
            "contact_area": ComputedQuantity.of(
                float(strength) * np.array(by_sole), "N", names=tuple(SOLES)
            ),
            **table_5_orders(),
        },
        (
            _split_table(splits),
            _analysis_table(splits),
            _lubricated_table(splits),
            StudyTable.of(
                "eq26",
                "Adhesion left under each fluid by Eq. 26, N at 20.9 N, at the dry adhesion that "
                "fits best",
                [
                    {"fluid": fluid, **{f"{k} ({dry[k]:.1f} N dry)": left[k][i] for k in SOLES}}
                    for i, fluid in enumerate(FLUIDS)
                ],
            ),
            StudyTable.of(
                "contact_area",
                "Share of real contact at 266.1 kPa (Persson 2001), which times one shear strength "
                "would be the dry adhesion",
                [{"sole": s, **{floor: area[s, floor] for floor in FLOORS}} for s in SOLES],
            ),
        ),
        {
            "fig22_dry_adhesion": _pair_figure(
                {
                    "dry adhesion (N)": {
                        pair: (one.medians[0], one.adhesion) for pair, one in splits.items()
                    }
                },
                "Fig. 22: dry adhesion by sole and floor; printed: hard rubber highest, "
                "polyurethane lowest",
            ),
            "fig23_hysteresis": _pair_figure(
                {
                    "friction under gear oil (N)": {
                        pair: (one.medians[1], one.hysteresis) for pair, one in splits.items()
                    },
                    "of it lost in the compound (N)": {
                        pair: (_middle(one, "loss"), one.loss) for pair, one in splits.items()
                    },
                },
                "Fig. 23: what counts as hysteresis, and what of it the compound loses; printed:\n"
                "most polyurethane on marble, least hard rubber on vinyl",
            ),
            "fig24_fluid_sole": _fluid_figure(catalogue, splits, left),
            "fig25_shoe_floor": _pair_figure(
                {
                    "adhesion, mean of six fluids (N)": {
                        pair: (
                            float(np.mean(list(one.medians[2].values()))),
                            np.mean(list(one.lubricated.values()), axis=0),
                        )
                        for pair, one in splits.items()
                    }
                },
                "Fig. 25: lubricated adhesion by sole and floor; printed: vinyl above marble but "
                "for soft rubber",
            ),
        },
        _conclusions(splits),
    )


def split(catalogue: Catalogue, draws: PairDraws, sole: str, floor: str, seed: int) -> PrintedSplit:
    """Return the friction of a pair without fluid, under the oil and under each fluid."""
    shore, (sole_ra, floor_ra) = _pair_numbers(catalogue, sole, floor)
    rq = [(RQ_PER_RA * ra,) * 2 for ra in (sole_ra, floor_ra)]
    loss = range_95(catalogue.entry("material", SOLES[sole]).sourced_value("loss_tangent"))
    assert loss is not None

    def friction(fluid: str) -> tuple[Array, float, Array]:
        family = "dry" if fluid == "dry" else FAMILIES[fluid]
        viscosity = None if fluid == "dry" else viscosity_of(fluid)
        pair = Pair(
            shore,
            (rq[0][0], rq[0][1]),
            (rq[1][0], rq[1][1]),
            family,
            polymer=sole,
            loss_tangent=loss,
        )
        drawn, lost, median = cof_draws(pair, viscosity, SPEED, CONTACT_PRESSURE, draws, seed)
        name = f"{sole} on {floor}, {fluid}"
        read = with_reading_error(drawn[:, 0], draws, name, seed)
        return LOAD * read, LOAD * float(median[0]), LOAD * lost[:, 0]

    dry, oiled = friction("dry"), friction(OIL)
    wet = {name: friction(fluid) for name, fluid in FLUIDS.items()}
    return PrintedSplit(
        np.maximum(dry[0] - oiled[0], 0.0),
        oiled[0],
        {name: np.maximum(one[0] - oiled[0], 0.0) for name, one in wet.items()},
        (dry[1] - oiled[1], oiled[1], {k: max(one[1] - oiled[1], 0.0) for k, one in wet.items()}),
        oiled[2],
    )


def _pair_numbers(catalogue: Catalogue, sole: str, floor: str) -> tuple[float, tuple[float, float]]:
    """Return Shore A of the sole, and Ra (m) of sole and floor."""
    own = catalogue.entry("material", SOLES[sole])
    other = catalogue.entry("floor", FLOORS[floor])
    ra = [float(entry.sourced_value("roughness.ra", "m")) for entry in (own, other)]
    return float(own.leaf("shore_a").given), (ra[0], ra[1])


def default_quantities(
    splits: Mapping[tuple[str, str], PrintedSplit],
) -> dict[str, ComputedQuantity]:
    """Return orders and ranges of the default law by name."""

    def over_floors(sole: str, take: str) -> tuple[float, Array]:
        own = [splits[sole, floor] for floor in FLOORS]
        medians = [_middle(one, take) for one in own]
        return float(np.mean(medians)), np.mean([getattr(one, take) for one in own], axis=0)

    quantities: dict[str, ComputedQuantity] = {}
    for take, printed in (
        ("adhesion", ("hard rubber", "soft rubber", "polyurethane")),
        ("hysteresis", ("polyurethane", "soft rubber", "hard rubber")),
        ("loss", ("polyurethane", "soft rubber", "hard rubber")),
    ):
        values = {sole: over_floors(sole, take) for sole in SOLES}
        ends = [values[sole] for sole in printed]
        quantities[f"default.{take}"] = ComputedQuantity.of(
            [one[0] for one in ends],
            "N",
            names=printed,
            chance=chance_of_order([one[1] for one in ends], TIE),
        )
    for sole, (first, second) in {
        "hard rubber": ("marble", "vinyl"),
        "soft rubber": ("vinyl", "marble"),
        "polyurethane": ("vinyl", "marble"),
    }.items():
        pair = [splits[sole, floor] for floor in (first, second)]
        quantities[f"default.floor.{sole.replace(' ', '_')}"] = ComputedQuantity.of(
            [one.medians[0] for one in pair],
            "N",
            names=(first, second),
            chance=chance_of_order([one.adhesion for one in pair], TIE),
        )
    for take in ("hysteresis", "loss"):
        quantities[f"default.{take}_pairs"] = _ends_of_the_pairs(splits, take)
        by_floor = [splits["polyurethane", floor] for floor in ("marble", "vinyl")]
        quantities[f"default.{take}_floor"] = ComputedQuantity.of(
            [_middle(one, take) for one in by_floor],
            "N",
            names=("marble", "vinyl"),
            chance=chance_of_order([getattr(one, take) for one in by_floor], TIE),
        )
    spreads = {}
    for sole in SOLES:
        by_fluid = np.array(
            [
                np.mean([splits[sole, floor].lubricated[fluid] for floor in FLOORS], axis=0)
                for fluid in FLUIDS
            ]
        )
        medians_of = np.array(
            [np.mean([splits[sole, f].medians[2][fluid] for f in FLOORS]) for fluid in FLUIDS]
        )
        name = sole.replace(" ", "_")
        for end, take in (("lowest", np.min), ("highest", np.max)):
            drawn = take(by_fluid, axis=0)
            quantities[f"default.{name}.{end}"] = ComputedQuantity.of(
                float(take(medians_of)), "N", draws=drawn
            )
        spreads[sole] = (float(np.ptp(medians_of)), np.ptp(by_fluid, axis=0))
    order = ("hard rubber", "soft rubber", "polyurethane")
    quantities["default.fluid_spread"] = ComputedQuantity.of(
        [spreads[sole][0] for sole in order],
        "N",
        names=order,
        chance=chance_of_order([spreads[sole][1] for sole in order], TIE),
    )
    return quantities


def _middle(split: PrintedSplit, take: str) -> float:
    """Return what a part of the friction is at the medians of the law's inputs, N."""
    if take == "loss":
        return float(np.median(split.loss))
    return split.medians[0] if take == "adhesion" else split.medians[1]


def _ends_of_the_pairs(
    splits: Mapping[tuple[str, str], PrintedSplit], take: str
) -> ComputedQuantity:
    """Return a part of the friction of the pairs that the report names, and of those between."""
    extremes = [("polyurethane", "marble"), ("hard rubber", "vinyl")]
    rest = [pair for pair in splits if pair not in extremes]
    medians = {pair: _middle(one, take) for pair, one in splits.items()}
    others = [getattr(splits[pair], take) for pair in rest]
    first, last = (getattr(splits[pair], take) for pair in extremes)
    above = (first - np.max(others, axis=0) > TIE) & (np.min(others, axis=0) - last > TIE)
    between = [medians[pair] for pair in rest]
    return ComputedQuantity.of(
        [medians[extremes[0]], max(between), min(between), medians[extremes[1]]],
        "N",
        names=("polyurethane on marble", "highest other", "lowest other", "hard rubber on vinyl"),
        chance=float(np.mean(above)),
    )


def eq26_at_its_best(catalogue: Catalogue) -> tuple[dict[str, float], dict[str, Array]]:
    """Return the dry adhesion (N) of each sole nearest to its printed range, and Eq. 26 there."""
    published = catalogue.entry("published", "boundary_g3")
    dry, left = {}, {}
    for sole in SOLES:
        low, high = published.numbers(f"lubricated_adhesion_{sole.replace(' ', '_')}", "N")
        dry[sole] = nearest_dry_adhesion(low, high)
        left[sole] = np.array([float(b.lubricated_adhesion(dry[sole])) for b in BLOCKING.values()])
    return dry, left


def table_5_orders() -> dict[str, ComputedQuantity]:
    """Return the orders of alpha and beta in Table 5."""
    alpha = {fluid: float(blocking.alpha) for fluid, blocking in BLOCKING.items()}
    beta = {fluid: float(blocking.beta) for fluid, blocking in BLOCKING.items()}
    rest = [value for name, value in alpha.items() if name not in ("water", "canola oil")]
    # the middle of an order that names both ends only: nearest to being out of it
    ends = (alpha["water"] - max(rest), min(rest) - alpha["canola oil"])
    middle = max(rest) if ends[0] < ends[1] else min(rest)
    glycerols = (
        min(value for name, value in beta.items() if name.startswith("glycerol")),
        max(value for name, value in beta.items() if not name.startswith("glycerol")),
    )
    return {
        "alpha": ComputedQuantity.of(
            [alpha["water"], middle, alpha["canola oil"]],
            "N",
            names=("water", "other fluids", "canola oil"),
        ),
        "beta": ComputedQuantity.of(glycerols, names=("glycerols", "other fluids")),
    }


def nearest_dry_adhesion(lowest: float, highest: float) -> float:
    """Return the dry adhesion (N) at which Eq. 26 over six fluids comes nearest to a range (N)."""
    dry = np.linspace(0.0, 30.0, 3001)
    left = np.array([b.lubricated_adhesion(dry) for b in BLOCKING.values()])
    error = np.maximum(np.abs(left.min(axis=0) - lowest), np.abs(left.max(axis=0) - highest))
    return float(dry[int(np.argmin(error))])


def contact_areas(catalogue: Catalogue) -> dict[tuple[str, str], float]:
    """Return the share of real contact of each sole on each floor."""
    found = {}
    for sole in SOLES:
        for floor in FLOORS:
            shore, ra = _pair_numbers(catalogue, sole, floor)
            modulus = float(youngs_modulus_gent(shore)) / 0.75
            rq = RQ_PER_RA * float(np.hypot(*ra))
            scale = self_affine_scale(STYLUS_RESOLUTION, rq=rq, longest_wave=0.8e-3)
            found[sole, floor] = float(scale.contact_fraction(CONTACT_PRESSURE / modulus))
    return found


def _interval(drawn: Array) -> tuple[float, float]:
    low, high = np.quantile(drawn, [0.025, 0.975])
    return float(low), float(high)


def _split_table(splits: Mapping[tuple[str, str], PrintedSplit]) -> StudyTable:
    rows = []
    for (sole, floor), one in splits.items():
        row: dict[str, object] = {"sole": sole, "floor": floor}
        for name, drawn, value in (
            ("dry adhesion, N", one.adhesion, one.medians[0]),
            ("under gear oil, N", one.hysteresis, one.medians[1]),
            ("of it lost in the compound, N", one.loss, _middle(one, "loss")),
        ):
            low, high = _interval(drawn)
            row |= {name: value, f"{name}: 95 %": f"{low:.2g} to {high:.2g}"}
        rows.append(row)
    title = "Friction of 20.9 N by the law of the pair, fitted without the report's readings"
    return StudyTable.of("default_split", title, rows)


EFFECTS = {"sole": "sole", "floor": "floor", "sole:floor": "sole with floor"}
PRINTED_EFFECTS = {
    "adhesion": {"sole": "p < 0.01", "floor": "not named", "sole:floor": "p < 0.01"},
    "hysteresis": {"sole": "affected", "floor": "affected", "sole:floor": "not named"},
    "loss": {},
}
"""Of the analyses of variance in G.3.2."""


def expected_analysis(
    splits: Mapping[tuple[str, str], PrintedSplit], take: str
) -> dict[str, float]:
    """Return p of sole, floor and both together, as the report's test would find it.

    Readings are the law's medians, three of each pair about them with the report's scatter: 0.82 N
    is their standard deviation, so that chance moves nothing.
    """
    apart = np.array([-1.0, 0.0, 1.0]) * SCATTER
    readings = [
        (_middle(one, take) + each, *pair) for pair, one in splits.items() for each in apart
    ]
    forces, soles, floors = zip(*readings, strict=True)
    table = analysis_of_variance(
        list(forces),
        {"sole": list(soles), "floor": list(floors)},
        ("sole", "floor", "sole:floor"),
    )
    return {row.term: float(row.p) for row in table.rows if row.p is not None}


def _analysis_table(splits: Mapping[tuple[str, str], PrintedSplit]) -> StudyTable:
    names = {
        "adhesion": "dry adhesion",
        "hysteresis": "under gear oil",
        "loss": "of it lost in the compound",
    }
    rows = [
        {
            "force": name,
            "effect": EFFECTS[term],
            "p": f"{p:.2g}" if p >= 1e-4 else "below 0.0001",
            "printed": PRINTED_EFFECTS[take].get(term, "-"),
        }
        for take, name in names.items()
        for term, p in expected_analysis(splits, take).items()
    ]
    title = (
        "Analysis of variance of the law's medians, three readings a pair with the report's "
        "scatter of 0.82 N"
    )
    return StudyTable.of("analysis_of_variance", title, rows)


def _lubricated_table(splits: Mapping[tuple[str, str], PrintedSplit]) -> StudyTable:
    rows = [
        {
            "fluid": fluid,
            **{
                f"{sole} on {floor}": one.medians[2][fluid] for (sole, floor), one in splits.items()
            },
        }
        for fluid in FLUIDS
    ]
    title = "Adhesion left under a fluid by the same law (friction less that under gear oil), N"
    return StudyTable.of("default_lubricated", title, rows)


def _conclusions(splits: Mapping[tuple[str, str], PrintedSplit]) -> tuple[str, ...]:
    alpha = {fluid: float(blocking.alpha) for fluid, blocking in BLOCKING.items()}
    by_sole = {sole: np.mean([splits[sole, f].medians[0] for f in FLOORS]) for sole in SOLES}
    listed = ", ".join(f"{sole} {value:.1f} N" for sole, value in by_sole.items())
    return (
        f"Dry adhesion by the default law, without any reading of the report: {listed}. The harder "
        "sole is the smoother one, and its real contact area is larger.",
        "Under gear oil, which the report counts as hysteresis, the softest sole has most "
        "friction: a boundary film is left that grows with softness. The floors come out the other "
        "way round: vinyl above marble, since the rougher floor sheds oil sooner and its waves "
        "cost more loss.",
        _words_on_loss(splits),
        f"Eq. 26 with Table 5 leaves at least {alpha['water']:.2f} N under water and "
        f"{alpha['canola oil']:.2f} N under canola oil on every pair, whatever the dry "
        "adhesion: alpha and beta are means over soles that behave differently (R2 0.49).",
        "That polyurethane's adhesion hardly depends on the fluid is not in the law: it knows "
        "hardness and roughness of a compound, not its polymer.",
    )


def _words_on_loss(splits: Mapping[tuple[str, str], PrintedSplit]) -> str:
    loss = {pair: _middle(one, "loss") for pair, one in splits.items()}
    share = max(loss[pair] / one.medians[1] for pair, one in splits.items())
    by_floor = [np.mean([loss[sole, floor] for sole in SOLES]) for floor in ("vinyl", "marble")]
    most = max(_interval(one.loss)[1] for one in splits.values())
    return (
        f"What the compounds lose by their loss tangent is {by_floor[0]:.2f} N on vinyl and "
        f"{by_floor[1]:.2f} N on marble (95 % of the joint draws: up to {most:.1f} N). That is "
        f"{share:.0%} or less of the friction under gear oil: the rest is adhesion that the oil "
        "leaves. What is published does not tell the loss of polyurethane from that of rubber, so "
        "it orders no soles; marble, the smoother floor, gives the least."
    )


def _pair_figure(
    shown: Mapping[str, Mapping[tuple[str, str], tuple[float, Array]]], title: str
) -> Figure:
    """Return bars of each sole on each floor, a panel a force, with 95 % of the joint draws."""
    panels: list[Panel] = []
    for label, values in shown.items():
        ends = {pair: _interval(drawn) for pair, (_, drawn) in values.items()}
        middles, lows, highs = (
            {f"on {floor}": [take[sole, floor] for sole in SOLES] for floor in FLOORS}
            for take in (
                {pair: value for pair, (value, _) in values.items()},
                {pair: low for pair, (low, _) in ends.items()},
                {pair: high for pair, (_, high) in ends.items()},
            )
        )
        bars = grouped_bars(middles, colours=(OURS, "#7fb3d5"), low=lows, high=highs)
        panels.append(Panel(bars, y_label=label, x_ticks=[*SOLES]))
    title = f"{title}\n(default law, 95 %; no values printed)"
    return Figure(panels, title, columns=len(panels), size=(7.4 if len(panels) == 1 else 5.4, 4.2))


def _fluid_figure(
    catalogue: Catalogue, splits: Mapping[tuple[str, str], PrintedSplit], left: Mapping[str, Array]
) -> Figure:
    """Return adhesion by fluid, a panel a sole: default law, Eq. 26 and the printed range."""
    published = catalogue.entry("published", "boundary_g3")
    panels: list[Panel] = []
    places = np.arange(len(FLUIDS))
    highest = 0.0
    for sole in SOLES:
        low, high = published.numbers(f"lubricated_adhesion_{sole.replace(' ', '_')}", "N")
        own = [splits[sole, floor] for floor in FLOORS]
        medians = [np.mean([one.medians[2][fluid] for one in own]) for fluid in FLUIDS]
        ends = [
            _interval(np.mean([one.lubricated[fluid] for one in own], axis=0)) for fluid in FLUIDS
        ]
        panels.append(
            Panel(
                (
                    Layer(
                        "span",
                        low=low,
                        high=high,
                        colour=PRINTED,
                        style="horizontal",
                        label="printed range",
                    ),
                    points(
                        places,
                        medians,
                        "default law, 95 %",
                        low=[end[0] for end in ends],
                        high=[end[1] for end in ends],
                        marker="o",
                    ),
                    points(places, left[sole], "Eq. 26", colour=GREY, marker="s"),
                ),
                y_label="adhesion (N)",
                title=f"{sole}: printed {low:g} to {high:g} N",
                x_ticks=list(TICKS),
            )
        )
        highest = max(highest, *(end[1] for end in ends))
    panels = [replace(panel, y_limits=(0.0, 1.05 * highest)) for panel in panels]
    return Figure(
        panels,
        "Fig. 24: adhesion left under a fluid (friction less that under gear oil)",
        columns=3,
        legend_below=True,
        size=(4.6, 3.6),
        share_y=True,
    )
