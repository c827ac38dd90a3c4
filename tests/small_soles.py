"""Soles of a few cells with fields on them, and the data of the viewer as lines."""

import base64
import dataclasses
import zlib
from types import SimpleNamespace
from typing import Any

import numpy as np
import xarray

from underfoot.core.fields import from_xarray
from viewer_fields import unpacked


def fake(**parts) -> Any:
    return SimpleNamespace(**parts)


def sole(side=4e-3, shift=0.0, factor=1.0, long=0.1, sensors=2, **more):
    """Return fields of a sole of bars, rounded at its heel, 40 mm wide."""
    x, y = shift + np.arange(side / 2, long, side), np.arange(side / 2, 0.04, side) - 0.02
    along, across = np.meshgrid(x, y, indexing="ij")
    within = (along > 0.01) | (np.abs(across) < 0.012)
    land = within & (np.floor(along / 8e-3) % 3 > 0)
    load = factor * 1e5 * (1 + np.sin(along * 90)) * np.exp(-((across / 0.015) ** 2))
    made: dict[str, Any] = {
        "contact_pressure": (np.where(land, load, 0.0), "Pa", "asperity contact pressure"),
        "fluid_pressure": (np.where(within & ~land, 0.3 * load, 0.0), "Pa", "fluid pressure"),
        "film_thickness": (np.where(within, 2e-5 + 1e-3 * along**2, np.nan), "m", "mean gap"),
        "slope_of_sole": (np.where(within, along - 0.05, np.nan), "1", "slope_of the sole"),
        "clearance": (
            np.where(within, np.where(land, 0.0, 3e-3) + along**2, np.inf),
            "m",
            "height",
        ),
        "pressed_height": (np.where(within, np.where(land, 0.0, 2.9e-3), np.nan), "m", "height"),
        "cell_area": (np.where(land, 0.9, 0.0), "1", "share"),
        "cell_film_area": (np.where(within & ~land, 0.8, 0.0), "1", "share"),
        **more,
    }
    data = {name: (("x", "y"), v, {"units": u, "long_name": t}) for name, (v, u, t) in made.items()}
    data |= {"inside": (("x", "y"), within), "land": (("x", "y"), land)}
    rim = np.array([[0.0, -0.012], [0.01, -0.02], [long, -0.02], [long, 0.02], [0.01, 0.02]])
    data |= {"outline_x": ("outline", rim[:, 0]), "outline_y": ("outline", rim[:, 1])}
    if sensors:
        sensed = np.linspace(0.02, 0.08, sensors), np.array([-0.01, 0.01])
        data["sensor_pressure"] = (("sensor_x", "sensor_y"), np.zeros((sensors, 2)),
                                   {"inlet_diameter": 6e-3} if sensors < 5 else {})  # fmt: skip
        data |= {"sensor_x": ("sensor_x", sensed[0]), "sensor_y": ("sensor_y", sensed[1])}
    return from_xarray(xarray.Dataset(data, coords={"x": x, "y": y}))


def scene_lines(value: Any) -> Any:
    """Return data of a sole or of the viewer: packed arrays as arrays, tables of colours by name.

    Sums that are zero have no noise of the processor.
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return scene_lines(
            {one.name: getattr(value, one.name) for one in dataclasses.fields(value)}
        )
    if isinstance(value, slice):
        return f"{value.start} to {value.stop}"
    if isinstance(value, float | np.floating | np.ndarray):
        values = np.asarray(value, float)
        least = max(1e-12, 1e-10 * float(np.nanmax(np.abs(values), initial=0.0)))
        values = np.where(np.abs(values) < least, 0.0, values)
        return float(values) if values.ndim == 0 else values
    if isinstance(value, dict):
        if set(value) == {"scale", "data"}:
            planes = zlib.decompress(base64.b64decode(value["data"]))
            return unpacked(value, (len(planes) // 2,))
        if set(value) == {"size", "data"}:
            planes = np.frombuffer(zlib.decompress(base64.b64decode(value["data"])), np.uint8)
            whole = np.ascontiguousarray(planes.reshape(4, -1).T).view("<u4").astype(float)
            return whole.reshape(value["size"][::-1])
        return {
            name: list(one) if name == "colours" and isinstance(one, dict) else scene_lines(one)
            for name, one in value.items()
        }
    return [scene_lines(one) for one in value] if isinstance(value, list | tuple) else value
