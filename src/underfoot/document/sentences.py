"""Results in words a person understands, each number with its spread."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from underfoot.core import SourcedValue, display

if TYPE_CHECKING:
    from underfoot.case.result import Result


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the summary table."""

    label: str
    value: str
    remark: str


SKEWED = 0.25
"""Difference of an interval's two sides over its width, from which it is given in place of one
standard deviation."""
_ROWS = (
    ("cof", "Coefficient of friction", "available between this shoe and floor"),
    ("cof_adhesion", "  from adhesion", ""),
    ("cof_hysteresis", "  from hysteresis", ""),
    ("cof_viscous", "  from shearing the fluid", ""),
    ("fluid_load", "Load carried by the fluid", "under the whole sole"),
    ("fluid_load_sensor", "  as floor sensors would read it", ""),
    ("peak_fluid_pressure", "Peak fluid pressure", "anywhere under the sole"),
    ("peak_fluid_pressure_sensor", "  as a floor sensor would read it", ""),
    ("array_peak", "  highest in the sensor array", "G.5's sensors stay in the floor"),
    *((f"array_peak_row_{n}", f"  row {n} of the array", "") for n in range(1, 10)),
    ("array_duration", "  pressure lasts in the array", ""),
    ("contact_area", "Contact area", "where the rough surfaces touch"),
    ("minimum_film_thickness", "Thinnest film", "mean gap between the surfaces"),
    ("slip_probability", "Probability of a slip", "for the walkers described in the case"),
)
_LABELS = (
    ("grid_error", "What the grid leaves"),
    ("edge_peak", "Caution on pressures"),
    ("given_in_vain", "Given, but looked at by no chosen model"),
)


def summary_rows(result: Result) -> list[Row]:
    """Return the summary table's lines: label, value with spread, remark."""
    rows: list[Row] = []
    for name, label, remark in _ROWS:
        scalar = result.scalars.get(name)
        if scalar is None:
            continue
        text = value_text(name, scalar)
        share = _share(result, name)
        remark = f"{share} of the load" if share else remark
        rows.append(Row(label, text, _likely(name, scalar) or scalar.note or remark))
    if "regime" in result.labels:
        rows.insert(4, Row("Regime", result.labels["regime"], result.labels.get("regime_rule", "")))
    if "cof_spread_from" in result.labels:
        place = next((i for i, row in enumerate(rows) if row.label == "Regime"), len(rows))
        origin = result.labels["cof_spread_from"]
        how = result.labels.get("cof_spread_how", "")
        rows.insert(place, Row("  its spread comes from", origin, how))
    rows += [Row(label, result.labels[key], "") for key, label in _LABELS if key in result.labels]
    return rows


def value_text(name: str, scalar: SourcedValue) -> str:
    """Return a scalar as people read it: COF with two decimals, probability in percent."""
    if scalar.value is None:
        return f"not determined: {scalar.reason}"
    if name.startswith("cof") or name == "slip_probability":
        text = _number(name, scalar.value)
        spread = "" if scalar.uncertainty is None else f" ± {_number(name, scalar.uncertainty)}"
        if scalar.interval is not None and _skewed(scalar.value, scalar.interval):
            low, high = (_number(name, end) for end in scalar.interval)
            spread = f" ({low} to {high})" if low != high else spread
    else:
        text = _shown(scalar.value, scalar.unit)
        spread = (
            "" if scalar.uncertainty is None else f" ± {_shown(scalar.uncertainty, scalar.unit, 2)}"
        )
    text = _typeset(text + spread)
    return text + (" (assumed)" if scalar.assumed else "")


def _shown(value: float, unit: str, digits: int = 3) -> str:
    """Return a number with its unit; forces in newtons, however small."""
    if unit == "N" and abs(value) < 1:
        return f"{value:.2f} N" if abs(value) >= 0.005 else "below 0.01 N"
    return display(value, unit, digits)


def _number(name: str, value: float) -> str:
    return percent(value) if name == "slip_probability" else f"{value:.3f}"


def _skewed(value: float, interval: tuple[float, float]) -> bool:
    """Return True where a single standard deviation would tell the interval wrongly."""
    below, above = value - interval[0], interval[1] - value
    return abs(above - below) > SKEWED * (interval[1] - interval[0])


def _likely(name: str, scalar: SourcedValue) -> str:
    """Return the 95 % interval of a sampled number as a remark."""
    if scalar.interval is None:
        return ""
    low, high = (_number(name, end) for end in scalar.interval)
    if low == high:
        return ""
    return f"95 %: {low} to {high}"


def _typeset(text: str) -> str:
    return text.replace("um", "µm").replace("^2", "²").replace("*", "·")


def percent(share: float) -> str:
    """Return a share as percent without false digits."""
    value = 100.0 * share
    if 0.0 < value < 0.1:
        return "below 0.1 %"
    if 99.9 < value < 100.0:
        return "above 99.9 %"
    return f"{value:.1f} %" if value < 9.95 else f"{value:.0f} %"


def verdict(result: Result) -> str:
    """Return the answer in two or three sentences."""
    if not result.status.usable:
        return f"No result: {result.status}. {result.status.remedy}"
    scalars = result.scalars
    cof = scalars["cof"]
    sentences = [f"Available friction {value_text('cof', cof)}."]
    share = _share(result, "fluid_load")
    regime = result.labels.get("regime")
    if share and regime:
        sentences.append(f"The film carries {share} of the load ({regime}).")
    slip = scalars.get("slip_probability")
    if slip is not None and slip.value is not None:
        chance = value_text("slip_probability", slip)
        sentences.append(f"For the walkers described, the chance of a slip is {chance}.")
    return " ".join(sentences)


def _share(result: Result, name: str) -> str:
    if name not in ("fluid_load", "fluid_load_sensor"):
        return ""
    load, total = result.scalars.get(name), result.scalars.get("normal_force")
    if load is None or total is None or load.value is None or not total.value:
        return ""
    return percent(load.value / total.value)
