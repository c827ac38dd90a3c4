"""The 3-D sole on a page: results as packed grids, drawn by a small WebGL 2 program, offline."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Sequence
from dataclasses import asdict
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from underfoot.core.fields import Fields

from .html import environment
from .quantities import HEIGHT_NAMES, Quantity, drawn, inside, quantities, raw, scale, spacing

if TYPE_CHECKING:
    from underfoot.compute.result import Result

SCRIPTS = ("viewer_data.js", "viewer_draw.js", "viewer_page.js")
_MOST_HISTORY_CELLS = 1_500_000
"""Cells of all instants of one history; more is thinned in time so that a page stays small."""


def viewer_section(results: Sequence[Result]) -> str:
    """Return the viewer of one result, or of several side by side, as a part of a page.

    The page needs ``viewer_script`` once, after its sections, and the style sheets of this room.
    """
    scene = viewer_scene(results)
    # "<" would let a name in the data end the script element
    data = json.dumps(scene, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    return environment().get_template("viewer.html").render(scene=scene, data=data)


def viewer_script() -> str:
    """Return the program that draws every viewer of a page."""
    templates = environment()
    parts = [templates.get_template(name).render() for name in SCRIPTS]
    return "(() => {\n" + "\n".join(parts) + "\n})();"


def viewer_scene(results: Sequence[Result]) -> dict[str, Any]:
    """Return plain data for the viewer: one pane a result, one colour scale a quantity.

    Lengths in m, fields in their shown units. Arrays are (nx, ny) in C order as float16 of value
    over ``scale`` (relative error below 5e-4), high bytes first, deflated, base64.
    """
    datasets = [result.data for result in results]
    found = quantities(datasets)
    fields = {q.name: [drawn(dataset, q) for dataset in datasets] for q in found}
    histories = {q.name: [_history(dataset, q) for dataset in datasets] for q in found}
    panes = []
    for number, result in enumerate(results):
        own = {name: values[number] for name, values in fields.items()}
        past = {name: values[number] for name, values in histories.items()}
        panes.append(_pane(result, own, past))
    listed = []
    for q in found:
        drawn_ones = [*fields[q.name], *(past[1] for past in histories[q.name] if past)]
        limits = scale([np.ravel(field) for field in drawn_ones], q)
        own = {"name": q.name, "title": q.title, "unit": q.unit, "colours": q.colours}
        listed.append({**own, "log": q.logarithmic, **asdict(limits), "cut": limits.cut})
    return {
        "panes": panes,
        "quantities": listed,
        "colours": {q.colours: colour_tables()[q.colours] for q in found},
    }


def _pane(
    result: Result,
    fields: dict[str, NDArray[np.float64]],
    histories: dict[str, tuple[NDArray[np.float64], NDArray[np.float64]] | None],
) -> dict[str, Any]:
    dataset = result.data
    mask = inside(dataset)
    rows, columns = np.nonzero(mask.any(axis=1))[0], np.nonzero(mask.any(axis=0))[0]
    crop = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    x, y = dataset["x"].values[crop[0]], dataset["y"].values[crop[1]]
    name = next((name for name in HEIGHT_NAMES if name in dataset), None)
    height = np.zeros(mask.shape) if name is None else raw(dataset, name)
    height = np.where(mask & np.isfinite(height), height, np.nan)
    land = np.asarray(dataset["land"].transpose("x", "y"), bool) if "land" in dataset else mask
    return {
        "name": result.name,
        "nx": int(x.size),
        "ny": int(y.size),
        "x0": float(x[0]),
        "y0": float(y[0]),
        "spacing": spacing(dataset),
        "plane": _plane(x, y, height[crop], land[crop]),
        "outline": _outline(dataset),
        "height": packed(height[crop]),
        "land": packed(land[crop].astype(float)),
        "fields": {name: packed(values[crop]) for name, values in fields.items()},
        "histories": {
            name: {
                "time": [float(f"{t:.4g}") for t in past[0]],
                "frames": [packed(frame[crop]) for frame in past[1]],
            }
            for name, past in histories.items()
            if past is not None
        },
    }


def _outline(dataset: Fields) -> list[list[float]]:
    """Return the rim as [x, y] in m, to which the page draws the outermost cells; or nothing."""
    if "outline_x" not in dataset or "outline_y" not in dataset:
        return []
    rim = np.stack([dataset["outline_x"].values, dataset["outline_y"].values], axis=1)
    return [[float(f"{v:.5g}") for v in point] for point in rim[np.isfinite(rim).all(axis=1)]]


def _plane(
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    height: NDArray[np.float64],
    land: NDArray[np.bool_],
) -> list[float]:
    """Return (a, b, c) of a + b x + c y through the land: heights are exaggerated from it."""
    there = land & np.isfinite(height)
    if np.count_nonzero(there) < 3:
        there = np.isfinite(height)
    along, across = np.meshgrid(x, y, indexing="ij")
    design = np.stack([np.ones(there.sum()), along[there], across[there]], axis=1)
    found = np.linalg.lstsq(design, height[there], rcond=None)[0]
    return [float(value) for value in found]


def _history(
    dataset: Fields, quantity: Quantity
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return (times in s, frames) of ``<name>_history`` on (time, x, y), thinned if long."""
    name = f"{quantity.name}_history"
    if name not in dataset or dataset[name].ndim != 3:
        return None
    field = dataset[name]
    instants = [dim for dim in field.dims if dim not in ("x", "y")]
    if len(instants) != 1 or not {"x", "y"} <= set(field.dims):
        return None
    values = field.transpose(instants[0], "x", "y").values
    count = values.shape[0]
    most = max(2, _MOST_HISTORY_CELLS // (values.shape[1] * values.shape[2]))
    chosen = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    time = np.asarray(dataset[instants[0]].values if instants[0] in dataset else range(count))
    frames = [
        drawn(dataset.assign({quantity.name: (("x", "y"), values[number], field.attrs)}), quantity)
        for number in chosen
    ]
    return time[chosen].astype(float), np.stack(frames)


def packed(values: NDArray[np.float64]) -> dict[str, Any]:
    """Return an array as text: float16 of values / scale, byte planes, deflate, base64."""
    finite = np.isfinite(values)
    largest = float(np.max(np.abs(values), where=finite, initial=0.0)) or 1.0
    halves = np.where(finite, values / largest, np.nan).astype("<f2").ravel()
    planes = halves.view(np.uint8).reshape(-1, 2).T
    data = base64.b64encode(zlib.compress(np.ascontiguousarray(planes).tobytes(), 9))
    return {"scale": largest, "data": data.decode("ascii")}


def unpacked(stored: dict[str, Any], shape: tuple[int, int]) -> NDArray[np.float64]:
    """Return the array of ``packed`` again, as the page reads it."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(stored["data"])), np.uint8)
    halves = np.ascontiguousarray(planes.reshape(2, -1).T).view("<f2").reshape(shape)
    return halves.astype(float) * stored["scale"]


@cache
def colour_tables() -> dict[str, str]:
    """Return the 256 colours (RGB bytes, base64) of each of Matplotlib's maps in use here."""
    return json.loads(files(__package__).joinpath("templates/colours.json").read_text())
