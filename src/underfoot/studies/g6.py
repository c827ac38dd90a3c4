"""Grant report G.6: friction of three outsoles in 50 % glycerol, and who slips on them."""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np

from underfoot.core import Progress, silent

from .g6_people import (
    PRINTED_ACOF,
    PRINTED_RISK,
    QUICK_SUBJECTS,
    SUBJECTS,
    Slips,
    implied_differences,
    population_risk,
    precision_of_published,
    risk_by_rcof,
    slips,
)
from .g6_soles import ASSUMPTIONS, LAWS, SOLES, SoleFriction, sole_frictions
from .pin_study import PinLine, PinTable
from .study_result import StudyResult
from .verdict import Erratum, Verdict

BAND = (0.159, 0.182)
PRESSURE_BELOW = 10e3
SLIP_RATE, SLOPE, HALF = 0.29, -49.2, -0.06
ERRATA = (
    Erratum(
        "G.6.3, other studies' 50 % points", "0.16 and -0.11", "-0.11; the other is not used",
        "-0.06 is said to lie within them, so the first sign is doubtful",
    ),
    Erratum("G.6, heading", "Scientific Report #4", "G.6", "the fourth report is G.4"),
)  # fmt: skip
PEOPLE = (
    "RCOF 0.20 ± 0.03, normal: derived from the report's own printed risks "
    "(docs/physics/slip_probability.md), so risks at the printed friction test the report's "
    "consistency, not a prediction.",
    "ACOF of the medium outsole: 0.159 as the hard one's, from which it is indistinguishable.",
    "Slips step by step: packaged gait of dry walking, 0.114 of the body moves with the heel, "
    "nobody reacts, no film.",
)
NOTES = (
    "friction: mean over the 200 ms after 250 N, at 0.3 m/s and 7 deg; band: hardness ± 5 Shore A "
    "(assumed); ± : the law's own standard deviation",
    "the printed ± of Fig. 36 and the readings of Fig. 37 are in figures only",
    "precision of the printed logistic: 52 trials drawn from it, fitted again, 200 times",
)


def run(
    *,
    quick: bool = False,
    processes: int | None = 1,
    seed: int = 0,
    progress: Progress = silent,
) -> StudyResult:
    """Return friction, pressures and slips of the three outsoles beside the printed ones.

    Parameters
    ----------
    quick
        Coarse grid, the middle of the averaging window alone, fewer persons.
    processes
        Cases computed at the same time; None takes the cores.
    seed
        Of the drawn studies behind the printed logistic's precision.
    """
    started, used = time.perf_counter(), time.process_time()

    def part(low: float, high: float) -> Progress:
        def told(stage: str, fraction: float, residual: float | None = None) -> None:
            progress(stage, low + (high - low) * fraction, residual)

        return told

    frictions = sole_frictions(quick=quick, processes=processes, progress=part(0.0, 0.7))
    subjects = QUICK_SUBJECTS if quick else SUBJECTS
    steps = {
        "ACOF as printed, at every speed": slips(
            PRINTED_ACOF, own_speed=False, subjects=subjects, progress=part(0.7, 0.8)
        ),
        "ACOF as printed, falling with speed": slips(
            PRINTED_ACOF, own_speed=True, subjects=subjects, progress=part(0.8, 0.9)
        ),
    }
    progress("Precision of the printed logistic", 0.9, None)
    drawn = precision_of_published(draws=60 if quick else 200, seed=seed)
    lines = (
        *_friction_lines(frictions),
        *_risk_lines(frictions, steps),
        *_logistic_lines(steps, drawn),
        *MISSING,
    )
    tables = (_friction_table(frictions), _risk_table(frictions), _step_table(steps))
    progress("done", 1.0, None)
    return StudyResult(
        "g6", lines, tables, _conclusions(frictions, steps, drawn), ERRATA, NOTES,
        (*ASSUMPTIONS, *PEOPLE), time.perf_counter() - started, time.process_time() - used,
        {"frictions": frictions, "steps": steps, "drawn": drawn, "printed_acof": PRINTED_ACOF,
         "printed_risk": PRINTED_RISK},
    )  # fmt: skip


def of_law(frictions: Sequence[SoleFriction], law: str) -> dict[str, SoleFriction]:
    """Return the soles of one law by name."""
    return {one.sole: one for one in frictions if one.law == law}


def _friction_lines(frictions: Sequence[SoleFriction]) -> list[PinLine]:
    lines = []
    for law, words in LAWS.items():
        soles = of_law(frictions, law)
        cofs = [soles[name].cof for name in SOLES]
        least, most = min(cofs), max(cofs)
        spread = float(np.nanmax([0.0, *(one.deviation for one in soles.values())]))
        inside = least >= BAND[0] - 5e-4 and most <= BAND[1] + 5e-4
        reach = spread or max(0.5 * (one.high - one.low) for one in soles.values())
        near = all(cof - reach <= BAND[1] and cof + reach >= BAND[0] for cof in cofs)
        off = max(BAND[0] - least, most - BAND[1], 0.0)
        lines.append(
            PinLine(
                f"whole-shoe ACOF of the three outsoles: {words}", "G.6.3", "0.159 to 0.182",
                f"{least:.3f} to {most:.3f}" + (f" (± {spread:.3f})" if spread else ""),
                Verdict.REPRODUCED if inside
                else Verdict.WITHIN_SCATTER if near
                else Verdict.DISAGREES,
                _why(law), "inside" if off <= 5e-4 else f"up to {off:.3f} beyond",
            )
        )  # fmt: skip
    for law in LAWS:
        soles = of_law(frictions, law)
        order = soles["soft"].cof - soles["hard"].cof
        same = abs(order) < 1e-3
        agrees = soles["soft"].cof > soles["medium"].cof > soles["hard"].cof and not same
        lines.append(
            PinLine(
                f"order soft > medium >= hard: {law}", "G.6.2", "soft highest",
                "no difference" if same
                else " > ".join(sorted(soles, key=lambda name: -soles[name].cof)),
                Verdict.REPRODUCED if agrees else Verdict.DISAGREES,
                _order(law), f"soft - hard {order:+.3f}, printed +0.023",
            )
        )  # fmt: skip
    highest = max(one.sensor_pressure for one in frictions)
    lines.append(
        PinLine(
            "under-shoe fluid pressure, slip tester", "G.6.2", "below 10 kPa",
            f"at most {highest / 1e3:.2g} kPa",
            Verdict.REPRODUCED if highest < PRESSURE_BELOW else Verdict.DISAGREES,
            f"4 mm sensor; the film carries at most "
            f"{100 * max(one.film_share for one in frictions):.1f} % of the load",
        )
    )  # fmt: skip
    return lines


def _why(law: str) -> str:
    return {
        "stribeck": "friction of one polyurethane pin at 0.3 m/s, carried over unchanged; its tau "
        "is printed as 0.19 ± 0.17 m/s, hence the wide spread",
        "asperity_ehl": "calibrated on the pin (2 MPa); stiffer soles get thinner films at their "
        "asperities, so friction rises with hardness and leaves the band",
        "bowden_tabor": "adhesion of the pin scaled by real contact area, hysteresis of the pin "
        "for all: one shear strength for all compounds is assumed",
    }[law]


def _order(law: str) -> str:
    return {
        "stribeck": "the law knows no sole",
        "asperity_ehl": "the film at asperities thickens as the modulus falls faster than contact "
        "grows; real contact area is not in this law",
        "bowden_tabor": "more real contact on a softer sole: the cause the report gives (G.6.3); "
        "G.3 found the opposite order dry, so the strength of the compound must matter too",
    }[law]


def _risk_lines(frictions: Sequence[SoleFriction], steps: dict[str, Slips]) -> list[PinLine]:
    lines = []
    area = of_law(frictions, "bowden_tabor")
    for name, printed in PRINTED_RISK.items():
        at_printed = population_risk(PRINTED_ACOF[name])["report_g6"]
        own = population_risk(area[name].cof)["report_g6"]
        ends = sorted(
            population_risk(end)["report_g6"] for end in (area[name].low, area[name].high)
        )
        off = at_printed - printed
        lines.append(
            PinLine(
                f"slip risk, {name} outsole, by the report's logistic over the population", "G.6.2",
                f"{100 * printed:.3g} %",
                f"{100 * at_printed:.0f} % at the printed ACOF; {100 * own:.0f} % "
                f"({100 * ends[0]:.0f} to {100 * ends[1]:.0f} %) at ours",
                Verdict.REPRODUCED if abs(off) < 0.05
                else Verdict.WITHIN_SCATTER if _likely(at_printed, printed)
                else Verdict.TREND_ONLY,
                "the printed risks are of the model in ACOF alone: from 0.159 to 0.182 its log "
                f"odds change with a slope of {implied_differences()['acof_slope']:.0f}, the "
                "report's own model in ACOF - RCOF has -49.2; both can't hold for one population",
                f"{100 * off:+.0f} points at the printed ACOF",
            )
        )  # fmt: skip
    for label, found in steps.items():
        whole = float(np.mean(list(found.share.values())))
        words = ", ".join(f"{name} {100 * share:.0f} %" for name, share in found.share.items())
        lines.append(
            PinLine(
                f"share of steps that slip, computed step by step: {label}", "G.6.2", "29 %",
                f"{100 * whole:.0f} %",
                Verdict.REPRODUCED if abs(whole - SLIP_RATE) < 0.05
                else Verdict.WITHIN_SCATTER if _likely(whole, SLIP_RATE, 52)
                else Verdict.TREND_ONLY,
                f"{words} (observed 41 % at 0.159, 6 % at 0.182); no parameter was fitted to slips",
                f"{100 * (whole - SLIP_RATE):+.0f} points",
            )
        )  # fmt: skip
    lowest, middle, highest = risk_by_rcof()
    off = np.abs(np.array([lowest - 0.03, middle - 0.26, highest - 0.83]))
    lines.append(
        PinLine(
            "risk at the lowest, median and highest RCOF", "G.6.2", "3, 26, 83 %",
            f"{100 * lowest:.0f}, {100 * middle:.0f}, {100 * highest:.0f} %",
            Verdict.REPRODUCED if off.max() < 0.05 else Verdict.TREND_ONLY,
            "consistency only: mean and spread of RCOF were derived from these and the risks in "
            "ACOF - RCOF; expected extremes of 29 persons",
            f"{100 * (lowest - 0.03):+.0f}, {100 * (middle - 0.26):+.0f}, "
            f"{100 * (highest - 0.83):+.0f} points",
        )
    )  # fmt: skip
    return lines


def _likely(ours: float, printed: float, trials: int = 17) -> bool:
    """Whether a share of ``printed`` among ``trials`` is within 1.96 deviations of ``ours``."""
    return abs(ours - printed) <= 1.96 * float(np.sqrt(max(ours * (1 - ours), 0.01) / trials))


def _logistic_lines(steps: dict[str, Slips], drawn: tuple[np.ndarray, np.ndarray]) -> list[PinLine]:
    slope = np.percentile(drawn[0], [2.5, 97.5])
    half = np.percentile(drawn[1], [2.5, 97.5])
    lines = []
    for label, found in steps.items():
        fit = found.fit
        overlap = fit.slope_low <= slope[1] and fit.slope_high >= slope[0]
        close = half[0] <= fit.half <= half[1]
        lines += [
            PinLine(
                f"slope of the log odds in ACOF - RCOF: {label}", "G.6.3",
                "-49.2 (others -41.2 to -45.1, -54.7)",
                f"{fit.slope:.0f} ({fit.slope_low:.0f} to {fit.slope_high:.0f})",
                Verdict.REPRODUCED if fit.slope_low <= SLOPE <= fit.slope_high
                else Verdict.WITHIN_SCATTER if overlap
                else Verdict.TREND_ONLY if fit.slope < 0 and fit.slope_high < 0
                else Verdict.DISAGREES,
                f"no standard error is printed; 52 trials would give {slope[0]:.0f} to "
                f"{slope[1]:.0f} if -49.2 were true",
                f"{fit.slope - SLOPE:+.0f}",
            ),
            PinLine(
                f"ACOF - RCOF at which half slip: {label}", "G.6.3", "-0.06",
                f"{fit.half:.3f} ± {fit.half_error:.3f}",
                Verdict.WITHIN_SCATTER if close
                else Verdict.TREND_ONLY if fit.half < 0
                else Verdict.DISAGREES,
                f"52 trials would give {half[0]:.3f} to {half[1]:.3f} if -0.06 were true; below 0 "
                "since a short need of friction moves the heel less than 0.2 m/s",
                f"{fit.half - HALF:+.3f}",
            ),
        ]  # fmt: skip
    return lines


def _friction_table(frictions: Sequence[SoleFriction]) -> PinTable:
    return PinTable(
        "whole_shoe_acof",
        "ACOF under the slip tester of G.6; low and high: hardness ± 5 Shore A",
        ("law", "outsole", "Shore A", "ACOF", "±", "low", "high", "sensor Pa", "load on film"),
        tuple(
            (one.law, one.sole, one.shore, one.cof, one.deviation, one.low, one.high,
             one.sensor_pressure, one.film_share)
            for one in frictions
        ),
    )  # fmt: skip


def _risk_table(frictions: Sequence[SoleFriction]) -> PinTable:
    rows = []
    for name, acof in PRINTED_ACOF.items():
        rows.append(("printed", name, acof, *population_risk(acof).values()))
    for one in frictions:
        rows.append((one.law, one.sole, one.cof, *population_risk(one.cof).values()))
    return PinTable(
        "slip_risk",
        "Share of a population with RCOF 0.20 ± 0.03 that slips, by published models",
        ("ACOF from", "outsole", "ACOF", *population_risk(0.17)),
        tuple(rows),
    )


def _step_table(steps: dict[str, Slips]) -> PinTable:
    return PinTable(
        "slips",
        "Steps computed one by one",
        ("friction", *SOLES, "all", "slope", "slope low", "slope high", "half slip at"),
        tuple(
            (label, *(found.share[name] for name in SOLES),
             float(np.mean(list(found.share.values()))), found.fit.slope, found.fit.slope_low,
             found.fit.slope_high, found.fit.half)
            for label, found in steps.items()
        ),
    )  # fmt: skip


def _conclusions(
    frictions: Sequence[SoleFriction], steps: dict[str, Slips], drawn: tuple[np.ndarray, np.ndarray]
) -> tuple[str, ...]:
    area = of_law(frictions, "bowden_tabor")
    constant, falling = steps.values()
    low, high = np.percentile(drawn[0], [2.5, 97.5])
    return (
        "The level of the whole shoes' friction follows from a pin: "
        f"{of_law(frictions, 'stribeck')['medium'].cof:.3f} by Eq. 17 without any whole-shoe data. "
        "The differences between outsoles do not follow with certainty: real contact area gives "
        f"the right order ({area['soft'].cof - area['hard'].cof:+.3f} from hard to soft), films at "
        "asperities the opposite one, and the hardness itself is not printed.",
        "Slips computed from gait and mass alone, with the printed friction at every speed, have "
        f"a slope of {constant.fit.slope:.0f} and half of them slip at {constant.fit.half:.3f}; if "
        "friction falls with the slipping speed as on the pin (0.47 at rest), the outcome hardly "
        f"follows ACOF - RCOF any more (slope {falling.fit.slope:.0f}): the observed slopes speak "
        "for friction that does not rise much towards rest under a real heel.",
        f"Fifty trials fix the slope to {low:.0f} .. {high:.0f} only: the slopes quoted from other "
        "studies (-41 to -55) are not told apart from -49.2.",
    )


MISSING = (
    PinLine(
        "second slip rarer than the first", "G.6.2", "p < 0.05", "-", Verdict.NOT_AVAILABLE,
        "people adapt; the model has no learning",
    ),
    PinLine(
        "RCOF is the same on all outsoles", "G.6.2", "no effect", "-", Verdict.NOT_AVAILABLE,
        "RCOF is an input here",
    ),
    PinLine(
        "risk at the lowest, median and highest ACOF - RCOF", "G.6.2", "0.6, 21, 92.5 %", "-",
        Verdict.NOT_AVAILABLE,
        "used as input: they give ACOF - RCOF of 0.044, -0.033 and -0.111 through the printed "
        "curve; the pairs themselves are not printed",
    ),
    PinLine(
        "50 % points of other studies", "G.6.3", "0.16 and -0.11", "-", Verdict.NOT_AVAILABLE,
        "sign of the first doubtful; their data are not in the report",
    ),
)  # fmt: skip
