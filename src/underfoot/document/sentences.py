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


_ROWS = (
    ("cof", "Coefficient of friction", "available between this shoe and floor"),
    ("cof_adhesion", "  from adhesion", ""),
    ("cof_hysteresis", "  from hysteresis", ""),
    ("cof_viscous", "  from shearing the fluid", ""),
    ("fluid_load", "Load carried by the fluid", "under the whole sole"),
    ("fluid_load_sensor", "  as floor sensors would read it", ""),
    ("peak_fluid_pressure", "Peak fluid pressure", "anywhere under the sole"),
    ("peak_fluid_pressure_sensor", "  as a floor sensor would read it", ""),
    ("contact_area", "Contact area", "where the rough surfaces touch"),
    ("minimum_film_thickness", "Thinnest film", "mean gap between the surfaces"),
    ("slip_probability", "Probability of a slip", "for the walkers described in the case"),
)


def summary_rows(result: Result) -> list[Row]:
    """Return the summary table's lines: label, value with spread, remark."""
    rows = []
    for name, label, remark in _ROWS:
        scalar = result.scalars.get(name)
        if scalar is None:
            continue
        text = value_text(name, scalar)
        share = _share(result, name)
        remark = f"{share} of the load" if share else remark
        rows.append(Row(label, text, scalar.note or remark))
    if "regime" in result.labels:
        rows.insert(4, Row("Regime", result.labels["regime"], result.labels.get("regime_rule", "")))
    return rows


def value_text(name: str, scalar: SourcedValue) -> str:
    """Return a scalar as people read it: COF with two decimals, probability in percent."""
    if scalar.value is None:
        return f"not determined: {scalar.reason}"
    if name.startswith("cof"):
        text = f"{scalar.value:.3f}"
        spread = "" if scalar.uncertainty is None else f" ± {scalar.uncertainty:.3f}"
    elif name == "slip_probability":
        text = percent(scalar.value)
        spread = "" if scalar.uncertainty is None else f" ± {percent(scalar.uncertainty)}"
    else:
        text = display(scalar.value, scalar.unit)
        spread = (
            ""
            if scalar.uncertainty is None
            else f" ± {display(scalar.uncertainty, scalar.unit, 2)}"
        )
    text = _typeset(text + spread)
    return text + (" (assumed)" if scalar.assumed else "")


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
