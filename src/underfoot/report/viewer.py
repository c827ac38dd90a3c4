"""The 3-D sole on a page: results as packed grids, drawn by a small WebGL 2 program, offline."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Sequence
from dataclasses import asdict
from functools import cache
from importlib.resources import files
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from underfoot.compute.histories import MARCH
from underfoot.core import display
from underfoot.core.fields import Fields
from underfoot.core.html import environment
from underfoot.core.presentation import quantity_text
from underfoot.questions.comparison import LETTERS

from .drawn_sole import DrawnSole, drawn_sole
from .quantities import DrawnQuantity, carried_load, drawn_values, quantities, scale
from .surface_mesh import SurfaceMesh, surface_mesh

SCRIPTS = ("sentences.js", "viewer_data.js", "viewer_draw.js", "viewer_page.js")
_DIFFERENCES = "RdBu_r"
_MOST_HISTORY_CELLS = 1_500_000
"""Cells of all instants of one history; more is thinned in time so that a page stays small."""


class OnSole(Protocol):
    """A name and the fields on a sole: a result, or what is shown before there is one."""

    @property
    def name(self) -> str:
        """What stands above the sole."""
        ...

    @property
    def data(self) -> Fields:
        """Heights and fields on (x, y)."""
        ...


def scene_section(scene: dict[str, Any]) -> str:
    """Return the viewer of a scene as a part of a page.

    The page needs ``viewer_script`` once, after its sections, and the style sheets of this room.
    """
    # "<" would let a name in the data end the script element
    data = json.dumps(scene, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    template = environment(__package__ or "").get_template("viewer.html")
    return template.render(scene=scene, data=data, letters=LETTERS, per_row=_per_row)


def _per_row(count: int, most: int) -> int:
    """Return how many soles stand in a row, at most ``most``, so that the rows are even."""
    return -(-count // -(-count // most))


def viewer_script(*further: str) -> str:
    """Return the program that draws every viewer of a page; ``further`` scripts can start more."""
    parts = [environment(__package__ or "").get_template(name).render() for name in SCRIPTS]
    return "(() => {\n" + "\n".join([*parts, *further]) + "\n})();"


def viewer_scene(
    results: Sequence[OnSole], surfaces: Sequence[SurfaceMesh | None] = ()
) -> dict[str, Any]:
    """Return plain data for the viewer: one pane a result, one colour scale a quantity.

    ``surfaces`` are the designed ones; where there is none it is drawn through the cells. Lengths
    in m, fields in their shown units. Arrays are (nx, ny) in C order as float16 of value over
    ``scale`` (relative error below 5e-4), high bytes first, deflated, base64.
    """
    datasets = [result.data for result in results]
    shown = quantities(datasets)
    fields = {q.name: [drawn_values(dataset, q) for dataset in datasets] for q in shown}
    alone = len(results) == 1
    histories = {q.name: [_history(dataset, q, alone) for dataset in datasets] for q in shown}
    panes = []
    designed = [*surfaces, *[None] * (len(results) - len(surfaces))]
    for number, result in enumerate(results):
        sole = drawn_sole(result.data)
        past = [(q.name, histories[q.name][number]) for q in shown]
        panes.append(
            pane(
                result.name,
                sole,
                {q.name: sole.place_field(fields[q.name][number]) for q in shown},
                designed[number],
                histories={
                    name: history([display(t, "s") for t in times], sole.place_field(frames))
                    for name, each in past
                    if each is not None
                    for times, frames in (each,)
                },
            )
            | {"lugs": _lugs(result.data)}
        )
    listed = []
    for q in shown:
        drawn_ones = [*fields[q.name], *(past[1] for past in histories[q.name] if past)]
        loads = [carried_load(dataset, q) for dataset in datasets]
        listed.append(listed_quantity(q, drawn_ones, loads))
    return scene(panes, listed)


def scene(
    panes: list[dict[str, Any]], listed: list[dict[str, Any]], steps: str = ""
) -> dict[str, Any]:
    """Return the data of a viewer: its panes, what can be coloured, and the colour tables.

    ``steps`` names the slider of the histories; it is time where nothing is said.
    """
    names = {q["colours"] for q in listed} | ({_DIFFERENCES} if len(panes) > 1 else set())
    colours = {name: colour_tables()[name] for name in sorted(names)}
    return {"panes": panes, "quantities": listed, "colours": colours, "steps": steps}


def listed_quantity(
    quantity: DrawnQuantity,
    fields: Sequence[NDArray[np.float64]],
    loads: Sequence[float | None] = (),
) -> dict[str, Any]:
    """Return a quantity for the viewer with the colour scale of all its ``fields``.

    ``loads`` are those that it carries in each pane, N.
    """
    limits = scale([np.ravel(field) for field in fields], quantity)
    return {
        "name": quantity.name,
        "title": quantity.title,
        "unit": quantity.unit,
        "factor": quantity.factor,
        "colours": quantity.colours,
        "log": quantity.logarithmic,
        "stress": quantity.stress,
        "meaning": quantity.meaning,
        "loads": [quantity_text(load, "N") for load in loads if load is not None],
        **asdict(limits),
        "cut": limits.cut,
    }


def pane(
    name: str,
    sole: DrawnSole,
    fields: dict[str, NDArray[np.float64]],
    surface: SurfaceMesh | None = None,
    *,
    histories: dict[str, dict[str, Any]],
    states: Sequence[tuple[NDArray[np.float64], NDArray[np.bool_], SurfaceMesh]] = (),
) -> dict[str, Any]:
    """Return one sole for the viewer with its fields on the grid of the sole.

    ``surface`` is what is drawn; by default that through the sole's cells. ``states`` are heights,
    land and surface at the instants of its histories, where they change.
    """
    x, y = sole.x, sole.y
    rows, columns = sole.computed
    ends = (rows.start, rows.stop, columns.start, columns.stop)
    computed = [int(end) for end in ends] if sole.in_part else None
    return {
        "name": name,
        "nx": int(x.size),
        "ny": int(y.size),
        "x0": float(x[0]),
        "y0": float(y[0]),
        "spacing": sole.spacing,
        "plane": sole.plane,
        "computed": computed,
        "height": pack_array(sole.height),
        "pressed": None if sole.pressed is None else pack_array(sole.pressed),
        "land": pack_array(sole.land.astype(float)),
        "surface": _packed_surface(surface or surface_mesh(x, y, sole.height, sole.land)),
        "states": [
            {
                "height": pack_array(z),
                "land": pack_array(land.astype(float)),
                "surface": _packed_surface(s),
            }
            for z, land, s in states
        ],
        "fields": {name: pack_array(values) for name, values in fields.items()},
        "histories": histories,
    }


def history(labels: Sequence[str], frames: NDArray[np.float64]) -> dict[str, Any]:
    """Return the frames (n, nx, ny) of a field and what each instant is called."""
    return {"labels": list(labels), "frames": [pack_array(frame) for frame in frames]}


def _lugs(dataset: Fields) -> list[list[float]]:
    """Return place (x, y; m), length (m) and side of the best groove of each lug's drainage."""
    if "lug_groove" not in dataset:
        return []
    names = ("x", "y", "groove", "groove_side")
    return np.nan_to_num([dataset[f"lug_{name}"].values for name in names]).T.tolist()


def _history(
    dataset: Fields, quantity: DrawnQuantity, alone: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return (times in s, frames) of ``<name>_history`` on (time, x, y), thinned if long.

    Of a march only where a sole is ``alone``: others have other instants.
    """
    field = dataset.get(f"{quantity.name}_history")
    if field is None or field.ndim != 3 or not {"x", "y"} <= set(field.dims):
        return None
    (axis,) = set(field.dims) - {"x", "y"}
    if axis == MARCH and not alone:
        return None
    values = field.transpose(axis, "x", "y").values
    count = values.shape[0]
    most = max(2, _MOST_HISTORY_CELLS // (values.shape[1] * values.shape[2]))
    chosen = np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
    time = np.asarray(dataset[axis].values if axis in dataset else range(count))
    frames = [
        drawn_values(
            dataset.assign({quantity.name: (("x", "y"), values[number], field.attrs)}), quantity
        )
        for number in chosen
    ]
    return time[chosen].astype(float), np.stack(frames)


def pack_array(values: NDArray[np.float64]) -> dict[str, Any]:
    """Return an array as text: float16 of values / scale, byte planes, deflate, base64."""
    finite = np.isfinite(values)
    largest = float(np.max(np.abs(values), where=finite, initial=0.0)) or 1.0
    halves = np.where(finite, values / largest, np.nan).astype("<f2").ravel()
    planes = halves.view(np.uint8).reshape(-1, 2).T
    data = base64.b64encode(zlib.compress(np.ascontiguousarray(planes).tobytes(), 9))
    return {"scale": largest, "data": data.decode("ascii")}


def _packed_surface(surface: SurfaceMesh) -> dict[str, Any]:
    """Return a surface as text: its points in 65,535 steps of its box, its faces as they are."""
    low, high = surface.points.min(axis=0), surface.points.max(axis=0)
    steps = np.maximum(high - low, 1e-9) / 65_535
    integers = {
        "points": np.rint((surface.points - low) / steps),
        "land": surface.land[:, None],
        "triangles": surface.triangles,
        "walls": surface.walls,
        "sides": surface.sides,
    }
    arrays = {name: _packed_integers(values) for name, values in integers.items()}
    return {"low": low.tolist(), "steps": steps.tolist(), **arrays}


def _packed_integers(values: NDArray[Any]) -> dict[str, Any]:
    """Return whole numbers (n, k), 0 or more, as text: columns, byte planes, deflate, base64."""
    whole = np.ascontiguousarray(values.T).astype("<u4").ravel()
    planes = whole.view(np.uint8).reshape(-1, 4).T
    data = base64.b64encode(zlib.compress(np.ascontiguousarray(planes).tobytes(), 9))
    return {"size": list(values.shape), "data": data.decode("ascii")}


@cache
def colour_tables() -> dict[str, str]:
    """Return the 256 colours (RGB bytes, base64) of each of Matplotlib's maps in use here."""
    return json.loads(files("underfoot.report").joinpath("templates/colours.json").read_text())
