"""What of a result can be drawn on the sole: found in the data set by its labels, not by a list."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from underfoot.core.fields import Fields
from underfoot.core.unit_text import display_unit

HEIGHT_NAMES = ("clearance", "height")
_NOT_DRAWN = ("pressed_height", "cell_area", "cell_film_area")
"""Fields that shape the picture or weigh cells instead of colouring it."""
_FIRST = ("contact_pressure", "fluid_pressure", "film_thickness", "shear_stress")
_TITLES = {
    "contact_pressure": "Contact pressure",
    "fluid_pressure": "Fluid pressure",
    "film_thickness": "Film thickness",
    "shear_stress": "Local shear",
    "clearance": "Height above the floor",
}
_COLOURS = {"film_thickness": "YlGnBu_r", **dict.fromkeys(HEIGHT_NAMES, "cividis")}
_LOGARITHMIC = ("film_thickness",)
_LOADS = {
    "contact_pressure": "the load per area that the touching rubber carries",
    "fluid_pressure": "the load per area that the fluid carries",
}
"""Pressures whose integral over the sole is a load, and what they say to a designer."""
AREAS = {"contact_pressure": "cell_area", "fluid_pressure": "cell_film_area"}
"""What a cell stands for of each pressure, in cells."""
_UNLOADED = 1e-3
"""Stress below this share of its peak is drawn as none."""
_PEAK_RATIO = 1.5
"""A scale ends at the 99.5 % quantile when the peak, often one cell at an edge, is this far off."""


@dataclass(frozen=True, slots=True)
class DrawnQuantity:
    """One field on the sole and how it is drawn: ``shown = SI value / factor`` in ``unit``.

    ``meaning`` explains a field to whom its title says little. ``stress``: none drawn is zero.
    """

    name: str
    title: str
    factor: float
    unit: str
    colours: str = "viridis"
    logarithmic: bool = False
    meaning: str = ""
    stress: bool = False


@dataclass(frozen=True, slots=True)
class ColourScale:
    """A colour scale in shown units; ``peak`` is the highest value, above ``high`` if cut."""

    low: float
    high: float
    peak: float

    @property
    def cut(self) -> bool:
        """Whether some values lie above the scale."""
        return self.peak > 1.001 * self.high


def quantities(datasets: Sequence[Fields]) -> tuple[DrawnQuantity, ...]:
    """Return what all of the data sets hold on (x, y), the usual four first, heights last.

    Titles come from ``long_name``, units from ``units``: a field of a later version is drawn
    without being known here. Truth values (inside, land, wet) are no quantities.
    """
    common = [name for name in _names(datasets[0]) if all(name in _names(d) for d in datasets[1:])]
    order = {name: number for number, name in enumerate(_FIRST)}
    common.sort(key=lambda name: (name in HEIGHT_NAMES, order.get(name, len(order))))
    return tuple(_quantity(name, datasets) for name in common)


def drawn_values(dataset: Fields, quantity: DrawnQuantity) -> NDArray[np.float64]:
    """Return a quantity in its shown unit, (nx, ny), nan outside the sole or where there is none.

    A stress below 1e-3 of its peak counts as none.
    """
    return shown_values(np.where(inside(dataset), raw(dataset, quantity.name), np.nan), quantity)


def shown_values(field: NDArray[np.float64], quantity: DrawnQuantity) -> NDArray[np.float64]:
    """Return values (SI) in the shown unit, nan where a stress is below 1e-3 of its peak."""
    values = np.where(np.isfinite(field), field, np.nan) / quantity.factor
    if quantity.stress and np.nanmin(values, initial=0.0) >= 0.0:
        values[values <= _UNLOADED * np.nanmax(values, initial=0.0)] = np.nan
    return values


def raw(dataset: Fields, name: str) -> NDArray[np.float64]:
    """Return a field in SI as (nx, ny)."""
    return np.array(dataset[name].transpose("x", "y").values, dtype=float)


def carried_load(dataset: Fields, quantity: DrawnQuantity) -> float | None:
    """Return the load in N of a pressure that carries one, sum p dA; None for other fields."""
    if quantity.name not in _LOADS:
        return None
    pressure = np.where(inside(dataset), raw(dataset, quantity.name), 0.0)
    area = AREAS[quantity.name]
    cells = raw(dataset, area) if area in dataset else 1.0  # older results count whole cells
    return float((pressure * cells).sum()) * spacing(dataset) ** 2


def inside(dataset: Fields) -> NDArray[np.bool_]:
    """Return where the sole is, (nx, ny)."""
    if "inside" in dataset:
        return np.asarray(dataset["inside"].transpose("x", "y").values, dtype=bool)
    height = next((name for name in HEIGHT_NAMES if name in dataset), None)
    if height is None:
        return np.ones((dataset.sizes["x"], dataset.sizes["y"]), dtype=bool)
    return np.isfinite(raw(dataset, height))


def spacing(dataset: Fields) -> float:
    """Return the side of a cell in m."""
    return float(np.median(np.diff(dataset["x"].values)))


def scale(fields: Sequence[NDArray[np.float64]], quantity: DrawnQuantity) -> ColourScale:
    """Return one colour scale for the drawn values of several results."""
    values = np.concatenate([field[np.isfinite(field)] for field in fields])
    if values.size == 0:
        return ColourScale(0.0, 1.0, 0.0)
    peak = float(values.max())
    if quantity.logarithmic:
        positive = values[values > 0.0]
        low = float(positive.min()) if positive.size else 1.0
        return ColourScale(low, max(peak, 1.01 * low), peak)
    low = min(float(values.min()), 0.0)
    if low < 0.0:
        reach = max(-low, peak)
        return ColourScale(-reach, reach, peak)
    usual = float(np.quantile(values, 0.995))
    high = usual if peak > _PEAK_RATIO * usual > 0.0 else peak
    return ColourScale(0.0, max(high, 1e-12), peak)


def _names(dataset: Fields) -> list[str]:
    return [
        str(name)
        for name, field in dataset.data_vars.items()
        if set(field.dims) == {"x", "y"} and field.dtype.kind in "fiu" and name not in _NOT_DRAWN
    ]


def _quantity(name: str, datasets: Sequence[Fields]) -> DrawnQuantity:
    attributes = datasets[0][name].attrs
    largest = 0.0
    lowest = 0.0
    for dataset in datasets:
        values = np.where(inside(dataset), raw(dataset, name), np.nan)
        values = values[np.isfinite(values)]
        if values.size:
            usual = np.quantile(np.abs(values), 0.5 if name in _LOGARITHMIC else 0.995)
            largest = max(largest, float(usual) or float(np.abs(values).max()))
            lowest = min(lowest, float(values.min()))
    factor, unit = display_unit(largest, str(attributes.get("units", "1")))
    title = _TITLES.get(name) or _title(str(attributes.get("long_name", name)))
    colours = "RdBu_r" if lowest < 0.0 else _COLOURS.get(name, "viridis")
    stress = attributes.get("units") == "Pa"
    meaning, logarithmic = _LOADS.get(name, ""), name in _LOGARITHMIC
    return DrawnQuantity(name, title, factor, _typeset(unit), colours, logarithmic, meaning, stress)


def _title(text: str) -> str:
    text = text.replace("_", " ")
    return text[:1].upper() + text[1:]


def _typeset(unit: str) -> str:
    unit = unit.replace("um", "µm").replace("^2", "²").replace("^3", "³").replace("*", "·")
    return "" if unit == "1" else unit
