"""The printed statements of G.5 beside simulated slips."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .pin_study import PinLine, PinTable
from .verdict import Verdict, compared_mean

if TYPE_CHECKING:
    from underfoot.core.catalogue import Entry
    from underfoot.slip.dynamics import SlipStudy
    from underfoot.trials.statistics.subsets import Subset

Array = NDArray[np.float64]
Bands = Mapping[str, Mapping[str, tuple[float, float]]]
CORRELATION, FALL = 0.87, 0.5
CONTACT = (
    "treaded: what slips here is the contact, not the film: no contact friction of 90 % glycerol "
    "is published, and the pin's curve has fallen to 0.11 at this viscosity, below everybody's RCOF"
)
FAST = (
    "the pool trapped at landing carries most of the load and nobody unloads the foot or catches "
    "himself; the mass that moves with the heel is assumed (see calibration)"
)
TABLE7 = {
    ("row",): ("sprwd", "row (SPRWD)"),
    ("lateral",): ("ml", "lateral distance (ML)"),
    ("speed",): ("irss", "speed (IRSS)"),
    ("row", "lateral"): ("sprwd_ml", "row and lateral"),
    ("row", "speed"): ("sprwd_irss", "row and speed"),
    ("lateral", "speed"): ("ml_irss", "lateral and speed"),
    ("row", "lateral", "speed"): ("sprwd_ml_irss", "all three"),
}


def g5_lines(
    found: Mapping[str, SlipStudy], bands: Bands, published: Entry, passages: Mapping[str, Array]
) -> tuple[PinLine, ...]:
    """Return every printed statement with its verdict."""
    bare, tread = found["untreaded"], found["treaded"]
    slower = _mean(tread, "peak_speed") < _mean(bare, "peak_speed")
    lower = _mean(tread, "peak_pressure") < _mean(bare, "peak_pressure")
    lines = [
        _line(
            "peak slipping speed over the sensors, untreaded", published,
            "peak_slipping_speed_over_sensors_untreaded", "m/s", 1.0, 11,
            bare, "peak_speed", bands["untreaded"], slower, FAST,
        ),
        _line(
            "peak slipping speed over the sensors, treaded", published,
            "peak_slipping_speed_over_sensors_treaded", "m/s", 1.0, 6,
            tread, "peak_speed", bands["treaded"], slower, CONTACT,
        ),
        _line(
            "peak slipping speed, clean steps, untreaded", published,
            "peak_slipping_speed_clean_untreaded", "m/s", 1.0, 18,
            bare, "peak_speed", None, slower, FAST,
        ),
        _line(
            "peak slipping speed, clean steps, treaded", published,
            "peak_slipping_speed_clean_treaded", "m/s", 1.0, 18,
            tread, "peak_speed", None, slower, CONTACT,
        ),
        _line(
            "peak sensor pressure, untreaded", published, "peak_pressure_untreaded", "kPa", 1e3, 11,
            bare, "peak_pressure", bands["untreaded"], lower,
            "load and angle of dry walking held through the slip press the heel's facet flat on "
            "the film; G.4's tester read 234 kPa",
        ),
        _line(
            "peak sensor pressure, treaded", published, "peak_pressure_treaded", "kPa", 1e3, 6,
            tread, "peak_pressure", bands["treaded"], lower,
            "sensor noise of 0.24 kPa alone gives a peak near 1 kPa; accuracy 2.5 kPa",
        ),
        _line(
            "duration of the pressure, untreaded", published, "pressure_duration", "ms", 1e-3, 11,
            bare, "duration", bands["untreaded"], None, "above 5 standard deviations of 0.24 kPa",
        ),
    ]  # fmt: skip
    share, least, most = tread.slipped()
    lines.append(
        PinLine(
            "treaded: share of steps that slip (faster than 0.2 m/s)", "G.5.2",
            "none (0.063 ± 0.017 m/s)",
            f"{100 * share:.0f} % ({100 * least:.0f} to {100 * most:.0f} %)",
            Verdict.REPRODUCED if share < 0.05
            else Verdict.WITHIN_SCATTER if least < 0.46  # 0 of 6 leave up to 46 % open
            else Verdict.DISAGREES,
            CONTACT, f"{100 * share:+.0f} points",
        )
    )  # fmt: skip
    ratio = _mean(tread, "peak_pressure") / _mean(bare, "peak_pressure")
    lines.append(
        PinLine(
            "tread takes the pressure away: treaded over untreaded", "G.5.2", "0.009",
            f"{ratio:.2g}", Verdict.REPRODUCED if ratio < 0.02 else
            Verdict.TREND_ONLY if ratio < 0.5 else Verdict.DISAGREES,
            "one parameter set, only the tread differs", f"factor {ratio / 0.00887:.2g}",
        )
    )  # fmt: skip
    return (*lines, *_relations(bare, bands["untreaded"], passages, published))


def _line(
    title: str, published: Entry, path: str, unit: str, scale: float, count: int,
    study: SlipStudy, name: str, bands: Mapping[str, tuple[float, float]] | None,
    trend: bool | None, reason: str,
) -> PinLine:  # fmt: skip
    given = published.sourced(path, unit)
    printed, deviation = given.value or 0.0, given.uncertainty or 0.0
    value = study.mean(name, "1", crossed=bands is not None)
    ours = float("nan") if value.value is None else value.value / scale
    spread = (value.uncertainty or 0.0) / scale
    verdict = compared_mean(printed, deviation, count, ours, trend=trend)
    words = reason if verdict not in (Verdict.REPRODUCED,) else ""
    if bands is not None and np.isfinite(bands[name][0]):
        low, high = (edge / scale for edge in bands[name])
        words = f"means of {count} persons: {low:.3g} to {high:.3g} {unit}; " + words
    return PinLine(
        title, "G.5.2", f"{printed:g} ± {deviation:g} {unit}",
        f"{ours:.3g} ± {_short(spread)} {unit}", verdict, words.rstrip("; "),
        f"{ours - printed:+.3g} {unit}",
    )  # fmt: skip


def _short(value: float) -> str:
    return f"{value:.2g}" if abs(value) < 10 else f"{value:.0f}"


def _mean(study: SlipStudy, name: str) -> float:
    value = study.mean(name, "1", crossed=True).value
    return float("nan") if value is None else value


def _relations(
    study: SlipStudy,
    bands: Mapping[str, tuple[float, float]],
    passages: Mapping[str, Array],
    published: Entry,
) -> list[PinLine]:
    r = study.correlation()
    low, high = bands["correlation"]
    rows = study.rows()
    fall = 1 - float(rows[-1] / rows[0])
    found = [
        PinLine(
            "correlation of peak slipping speed and peak pressure, untreaded", "Fig. 33", "0.87",
            "-" if r is None else f"{r:.2f} (11 persons: {low:.2f} to {high:.2f})",
            Verdict.NOT_AVAILABLE if r is None
            else Verdict.REPRODUCED if low <= CORRELATION <= high and r > 0.7
            else Verdict.WITHIN_SCATTER if low <= CORRELATION <= high
            else Verdict.TREND_ONLY if r > 0.1
            else Verdict.DISAGREES,
            "here all slip and differ in speed by when they brake, which is after the sensors; "
            "with feet that fall flat as in dry walking it rises to 0.71 (slip_dynamics.md)",
            "" if r is None else f"{r - CORRELATION:+.2f}",
        ),
        PinLine(
            "fall of the pressure from the first to the third row", "Fig. 34C", "about 50 %",
            f"{100 * fall:.0f} %" if fall > 0 else f"rises to {1 - fall:.1f} times the first",
            Verdict.REPRODUCED if 0.4 <= fall <= 0.6
            else Verdict.TREND_ONLY if fall > 0.05
            else Verdict.DISAGREES,
            "the load still rises while the heel passes the rows (dry gait), more than squeeze "
            "takes away" if fall <= 0.05 else "",
            f"{100 * (fall - FALL):+.0f} points",
        ),
    ]  # fmt: skip
    found += _table7_lines(passages, published)
    return found


def table7(passages: Mapping[str, Array]) -> list[Subset]:
    """Return adjusted R2 of every subset of row, lateral distance and speed."""
    from underfoot.trials.statistics.subsets import all_subsets

    return all_subsets(
        passages["peak"], {name: passages[name] for name in ("row", "lateral", "speed")}
    )


def _table7_lines(passages: Mapping[str, Array], published: Entry) -> list[PinLine]:
    if passages["peak"].size < 6:
        return [
            PinLine(
                "Table 7", "Table 7", "adjusted R2 0.05 to 0.41", "-", Verdict.NOT_AVAILABLE,
                "too few sensors were passed",
            )
        ]  # fmt: skip
    from scipy.stats import spearmanr

    subsets = {one.predictors: one.adjusted_r_squared for one in table7(passages)}
    printed = {
        names: published.sourced(f"adjusted_r2.{key}", "1").value or 0.0
        for names, (key, _) in TABLE7.items()
    }
    order = list(TABLE7)
    rank = float(np.asarray(spearmanr([printed[k] for k in order], [subsets[k] for k in order])[0]))
    slope = {
        name: float(np.polyfit(passages[name], passages["peak"], 1)[0])
        for name in ("lateral", "speed")
    }
    whole = subsets[("row", "lateral", "speed")]
    mine = sorted((k for k in order if len(k) == 1), key=lambda k: -subsets[k])
    same = mine == [("lateral",), ("row",), ("speed",)]
    return [
        PinLine(
            "pressure highest at the heel's middle, falls to the sides", "Fig. 34B", "falls",
            f"{slope['lateral'] / 1e6:+.2g} kPa/mm",
            Verdict.REPRODUCED if slope["lateral"] < 0 else Verdict.DISAGREES, "by regression",
        ),
        PinLine(
            "pressure rises with the instantaneous speed", "Fig. 34A", "rises",
            f"{slope['speed'] / 1e3:+.3g} kPa per m/s",
            Verdict.REPRODUCED if slope["speed"] > 0 else Verdict.DISAGREES,
            "by regression; settled films do, the pool trapped at landing is swept out by speed",
        ),
        PinLine(
            "adjusted R2: order of the single predictors", "Table 7",
            "lateral 0.14 > row 0.11 > speed 0.05",
            " > ".join(f"{k[0]} {subsets[k]:.2f}" for k in mine),
            Verdict.REPRODUCED if same
            else Verdict.TREND_ONLY if mine[0] == ("lateral",)
            else Verdict.DISAGREES,
            f"rank correlation over all seven subsets {rank:.2f}",
        ),
        PinLine(
            "adjusted R2 of all three", "Table 7", "0.41", f"{whole:.2f}",
            Verdict.REPRODUCED if abs(whole - 0.41) < 0.05
            else Verdict.WITHIN_SCATTER if 0.15 < whole < 0.65
            else Verdict.TREND_ONLY,
            "a model without sensor faults, gaps in the fluid or differences between soles leaves "
            "less unexplained" if whole > 0.46 else "",
            f"{whole - 0.41:+.2f}",
        ),
    ]  # fmt: skip


def g5_tables(
    found: Mapping[str, SlipStudy], bands: Bands, passages: Mapping[str, Array], published: Entry
) -> tuple[PinTable, ...]:
    """Return the population's numbers, the rows, and Table 7 beside ours."""
    scales = {"peak_speed": 1.0, "distance": 1.0, "peak_pressure": 1e3, "duration": 1e-3}
    units = {"peak_speed": "m/s", "distance": "m", "peak_pressure": "kPa", "duration": "ms"}
    rows = []
    for shoe, study in found.items():
        for name, scale in scales.items():
            value = study.mean(name, "1", crossed=True)
            low, high = bands[shoe].get(name, (float("nan"), float("nan")))
            rows.append(
                (shoe, f"{name.replace('_', ' ')} {units[name]}",
                 *(None if v is None or not np.isfinite(v) else v / scale
                   for v in (value.value, value.uncertainty, low, high)))
            )  # fmt: skip
        share, low, high = study.slipped()
        rows.append((shoe, "share that slips", share, None, low, high))
    tables = [
        PinTable(
            "population", "Persons whose heel crossed the sensors: mean, spread, and 95 % band of "
            "the mean of as many as the report had",
            ("shoe", "quantity", "mean", "±", "low", "high"), tuple(rows),
        ),
        PinTable(
            "rows", "Mean peak of each row of sensors, kPa", ("shoe", "first", "second", "third"),
            tuple((shoe, *(float(p) / 1e3 for p in study.rows())) for shoe, study in found.items()),
        ),
    ]  # fmt: skip
    if passages["peak"].size >= 6:
        subsets = {one.predictors: one.adjusted_r_squared for one in table7(passages)}
        tables.append(
            PinTable(
                "table7", "Adjusted R2 of the peak pressure at single sensors, untreaded",
                ("predictors", "printed", "ours"),
                tuple(
                    (words, published.sourced(f"adjusted_r2.{key}", "1").value or 0.0, subsets[k])
                    for k, (key, words) in TABLE7.items()
                ),
            )
        )  # fmt: skip
    return tuple(tables)


def g5_conclusions(
    found: Mapping[str, SlipStudy], passages: Mapping[str, Array]
) -> tuple[str, ...]:
    """Return what the comparison says."""
    bare, tread = found["untreaded"], found["treaded"]
    masses = (0.06, 0.114, 0.17)
    speeds = [bare.peak_speed_at(share) for share in masses]
    words = " / ".join("-" if v is None else f"{v:.2f}" for v in speeds)
    return (
        f"Untreaded: {100 * bare.slipped()[0]:.0f} % slip. Tread takes the fluid pressure at the "
        f"sensors from {_mean(bare, 'peak_pressure') / 1e3:.0f} to "
        f"{_mean(tread, 'peak_pressure') / 1e3:.1f} kPa with nothing else changed.",
        f"Treaded: {100 * tread.slipped()[0]:.0f} % slip here, nobody in the report: " + CONTACT,
        f"Mean peak speed untreaded if 0.06 / 0.114 / 0.17 of the body moved: {words} m/s.",
        f"{passages['peak'].size} passages of a heel over a sensor stand behind Table 7.",
    )
