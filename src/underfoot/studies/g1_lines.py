"""Every printed statement of G.1.2 beside ours, with a verdict and its reason."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from underfoot.core.catalogue import Catalogue

from .g1_cases import BROAD, FLOOR_RZ, MATERIALS, OWN_SHOE_RZ, G1Row, changes
from .verdict import ComparedLine, Verdict, compared_range, compared_sign, percent_range

LEAST_COF = 1e-3
"""Smaller hysteresis COF is none: without loss the condensed block leaves 2e-5 by sampling, the
explicit elements up to 9e-4 by inertia, ringing and mass scaling."""
HYSTERESIS, AREA = "hysteresis COF", "contact area over force"
ALONG = {"shoe_rz": "rougher shoe", "floor_rz": "rougher floor", "speed": "faster"}

_GEOMETRY = (
    "an effect of elastic contact geometry: it needs no loss, and depends on the wavelengths, "
    "which are assumed"
)
NO_RESULT = "a case of this line has no result; the table of cases says why"
_NOT_RUBBER = (
    "one term that relaxes in 40 or 77 s loses next to nothing: what is left is inertia, ringing "
    "or hourglass control, and no property of the rubber"
)
REASONS = {
    **{("report", HYSTERESIS, along): _NOT_RUBBER for along in ALONG},
    ("report", AREA, "speed"): (
        "one term that relaxes in 40 or 77 s is frozen while a slide lasts milliseconds, so the "
        "area can't depend on speed"
    ),
    ("report", AREA, "shoe_rz"): _GEOMETRY,
    ("report", AREA, "floor_rz"): _GEOMETRY,
    ("broad", AREA, "speed"): (
        "the modulus at the frequency of passing asperities grows with speed; "
        "the height kept while sliding lets the load relax more at low speed, which adds to it"
    ),
    ("broad", AREA, "shoe_rz"): "contact geometry at the stiffness that sliding meets",
    ("broad", AREA, "floor_rz"): "contact geometry at the stiffness that sliding meets",
    ("broad", HYSTERESIS, "speed"): (
        "the loss tangent assumed is the same at every frequency, so that hysteresis hardly "
        "depends on speed; a measured spectrum decides its sign and size"
    ),
    ("broad", HYSTERESIS, "shoe_rz"): (
        "over a rigid floor the shoe's roughness rests in the rubber and loses nothing by "
        "itself; it only spreads the load"
    ),
    ("broad", HYSTERESIS, "floor_rz"): (
        "energy lost grows with the square of the floor's height in full contact, less in "
        "partial contact"
    ),
}


def printed_lines(rows: Sequence[G1Row], series: str) -> list[ComparedLine]:
    """Return the lines of G.1.2 for one series of rows."""
    entry = Catalogue.load().entry("published", "micro_fe_g1")
    mine = [row for row in rows if row.series == series]
    slow = min(row.speed for row in mine)
    lines = []
    for quantity, key, attribute in (
        (HYSTERESIS, "hysteresis_cof_change", "cof_hysteresis"),
        (AREA, "contact_area_per_force_change", "area_per_force"),
    ):
        for along, name in (
            ("shoe_rz", "shoe_roughness_up"),
            ("floor_rz", "floor_roughness_up"),
            ("speed", "speed_up"),
        ):
            if quantity == HYSTERESIS and along == "speed":
                continue
            for material in MATERIALS:
                low, high = entry.numbers(f"{key}.{name}_{material}")
                some = [row for row in mine if row.material == material]
                ours = changes(some, attribute, along, speed=None if along == "speed" else slow)
                lines.append(
                    _line(
                        series,
                        quantity,
                        along,
                        material,
                        some,
                        (low, high),
                        ours,
                        entry.leaf(f"{key}.{name}_{material}").source,
                    )
                )
    lines += _speed_lines(mine, series, entry)
    return lines + _worded_lines(mine, series, slow, entry)


def _line(
    series: str,
    quantity: str,
    along: str,
    material: str,
    rows: Sequence[G1Row],
    printed: tuple[float, float],
    ours: tuple[float, ...],
    source: str,
) -> ComparedLine:
    condition = f"{material}, {ALONG[along]}" if along != "speed" else _speeds(material, rows)
    if quantity == HYSTERESIS and not _has_loss(rows):
        ours, verdict, reason = (), Verdict.NOT_AVAILABLE, _no_loss(rows, along)
    else:
        verdict = compared_range(printed, ours)
        missing = verdict is Verdict.NOT_AVAILABLE
        reason = NO_RESULT if missing else REASONS[series, quantity, along]
    return ComparedLine(
        series, quantity, condition, source, printed, percent_range(printed), ours, verdict, reason
    )


def _speeds(who: str, rows: Sequence[G1Row]) -> str:
    speeds = [row.speed for row in rows]
    return f"{who}, {min(speeds):g} to {max(speeds):g} m/s"


def _speed_lines(rows: Sequence[G1Row], series: str, entry) -> list[ComparedLine]:
    """Return the two statements on hysteresis against speed."""
    lines = []
    odd = [
        row
        for row in rows
        if row.material == "neolite"
        and row.shoe_rz == max(OWN_SHOE_RZ.values())
        and row.floor_rz == FLOOR_RZ[0]
    ]
    rest = [row for row in rows if row not in odd]
    most = entry.numbers("hysteresis_cof_change.speed_up_most_pairs")
    one = entry.sourced("hysteresis_cof_change.speed_up_rough_neolite_on_low_floor").value or 0.0
    for chosen, printed, who in (
        (rest, (most[0], most[1]), "most pairs"),
        (odd, (one, one), "rough neolite, low floor"),
    ):
        ours = tuple(
            value
            for material in MATERIALS
            for value in changes(
                [row for row in chosen if row.material == material], "cof_hysteresis", "speed"
            )
        )
        lines.append(
            _line(
                series,
                HYSTERESIS,
                "speed",
                who,
                chosen,
                printed,
                ours,
                f"{entry.leaf('hysteresis_cof_change.speed_up_most_pairs').source}, Fig. 6",
            )
        )
    return lines


def _worded_lines(rows: Sequence[G1Row], series: str, slow: float, entry) -> list[ComparedLine]:
    """Return the statements that are printed as words, and the experiment's."""
    lines = []
    lossy = _has_loss(rows)
    own = [row for row in rows if row.shoe_rz == OWN_SHOE_RZ[row.material]]

    def add(quantity, condition, text, ours, verdict, reason, printed=None) -> None:
        if quantity == HYSTERESIS and not lossy:
            ours, verdict, reason = (), Verdict.NOT_AVAILABLE, _no_loss(rows, "")
        elif verdict is Verdict.NOT_AVAILABLE and ours:
            ours, reason = (), NO_RESULT
        lines.append(
            ComparedLine(
                series,
                quantity,
                condition,
                entry.leaf("hysteresis_cof_change.speed_up_most_pairs").source,
                printed,
                text,
                ours,
                verdict,
                reason,
            )
        )

    shoes = _ratios(own, slow)
    add(
        HYSTERESIS,
        "rubber to neolite, own shoes",
        "higher",
        shoes,
        compared_sign(1, shoes),
        "the soft rubber follows more of the floor, and its loss tangent is assumed to be larger",
    )
    stiff = tuple(
        1.0 / (1.0 + value) - 1.0
        for shoe in sorted({row.shoe_rz for row in rows})
        for value in _ratios([row for row in rows if row.shoe_rz == shoe], slow)
    )
    add(
        HYSTERESIS,
        "neolite to rubber, same shoe",
        "higher",
        stiff,
        compared_sign(1, stiff),
        "a stiffer material touches the peaks only, and the exponents assumed give it less loss; "
        "key finding 3 of the report says the opposite of G.1.3",
    )
    for quantity, attribute, path, along, sign, text, reason in (
        (
            AREA,
            "area_per_force",
            "experiment.adhesion_change_with_speed",
            "speed",
            -1,
            "",
            "the experiment is wet: its fall contains the fluid's lift, which is not in this model",
        ),
        (
            HYSTERESIS,
            "cof_hysteresis",
            "",
            "speed",
            -1,
            "falls",
            "as the report's own model, which it names a failure: the oil of the experiment lifts "
            "the shoe with speed, and no fluid is in this model",
        ),
        (
            HYSTERESIS,
            "cof_hysteresis",
            "",
            "floor_rz",
            1,
            "rises",
            "deeper floor asperities deform more rubber",
        ),
    ):
        ours = tuple(
            value
            for material in MATERIALS
            for value in changes(
                [row for row in own if row.material == material],
                attribute,
                along,
                speed=None if along == "speed" else slow,
            )
        )
        condition = f"experiment, {ALONG[along]}"
        if path:
            low, high = entry.numbers(path)
            verdict = compared_range((low, high), ours)
            add(quantity, condition, percent_range((low, high)), ours, verdict, reason, (low, high))
        else:
            add(quantity, condition, text, ours, compared_sign(sign, ours), reason)
    add(
        "values of Fig. 3 and 5 to 11",
        "every pair",
        "no numbers",
        (),
        Verdict.NOT_AVAILABLE,
        "the figures print no numbers, and none are read off them; ours are in the table of cases",
    )
    return lines


def _ratios(rows: Sequence[G1Row], speed: float) -> tuple[float, ...]:
    """Return rubber over neolite less one, for each floor, in hysteresis COF."""
    found = []
    for floor in sorted({row.floor_rz for row in rows}):
        cof = {
            row.material: row.cof_hysteresis
            for row in rows
            if row.floor_rz == floor and row.speed == speed
        }
        with np.errstate(divide="ignore", invalid="ignore"):
            found.append(float(np.float64(cof["rubber"]) / np.float64(cof["neolite"]) - 1.0))
    return tuple(found)


def _has_loss(rows: Sequence[G1Row]) -> bool:
    return _largest(rows) >= LEAST_COF


def _largest(rows: Sequence[G1Row]) -> float:
    """Return the largest |COF|; NaN where a case has no result."""
    return float(np.max(np.abs([row.cof_hysteresis for row in rows])))


def _no_loss(rows: Sequence[G1Row], along: str) -> str:
    largest = _largest(rows)
    if largest != largest:
        return NO_RESULT
    reason = (
        f"there is no hysteresis to compare: |COF| is at most {largest:.0e} (below {LEAST_COF:g}). "
        "One term that relaxes in 40 or 77 s has a loss tangent of 4e-6 or less at the frequency "
        "of passing asperities"
    )
    if along in ("shoe_rz", "floor_rz"):
        slow = min(row.speed for row in rows)
        unsigned = percent_range(changes(rows, "cof_absolute", along, speed=slow))
        reason += f"; the mean of |shear|, which is no friction, changes by {unsigned}"
    return reason


def series_notes(series: str) -> str:
    """Return what stands behind a series in one sentence."""
    if series == "report":
        return "Table 2 as printed but for the rubber's bulk modulus"
    parts = [f"{name} {g * 1e-6:g} MPa (i w s)^{n:g}" for name, (g, n) in BROAD.items()]
    return "G*(w) = " + ", ".join(parts) + " from 1 to 1e7 rad/s; the exponents are assumed"
