"""The page of a population's slips: answer, table, figure and the moving picture, offline."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .page import embedded, environment, png
from .slip_figure import slip_figure
from .slip_words import shown_motion, slip_cautions, slip_rows, slip_sentence, write_slip_tables

if TYPE_CHECKING:
    from underfoot.slip.dynamics import SlipStudy

FRAMES = 110


def write_slip_outputs(study: SlipStudy, name: str, folder: Path) -> None:
    """Write slip.html, slip.png, subjects.csv, motion.csv and slip.json into a folder."""
    picture = png(slip_figure(study))
    write_slip_tables(study, folder)
    (folder / "slip.png").write_bytes(picture)
    (folder / "slip.html").write_text(slip_page(study, name, picture), encoding="utf-8")


def slip_page(study: SlipStudy, name: str, picture: bytes | None = None) -> str:
    """Return the page as HTML text; ``picture`` is the figure as PNG, if drawn."""
    data = json.dumps(animation_data(study), separators=(",", ":")).replace("<", "\\u003c")
    return (
        environment()
        .get_template("slip.html")
        .render(
            name=name,
            sentence=slip_sentence(study),
            rows=slip_rows(study),
            cautions=slip_cautions(study),
            figure=embedded(picture or png(slip_figure(study))),
            animation=data,
            wet=study.setting.viscosity is not None,
            who=shown_motion(study).walker,
        )
    )


def animation_data(study: SlipStudy) -> dict[str, Any]:
    """Return what the moving picture draws, rounded: SI but for film (um) and pressure (kPa)."""
    motion = shown_motion(study)
    run = study.representative
    times = np.linspace(0.0, float(motion.time[-1]), FRAMES)

    def at(values: np.ndarray, digits: int) -> list[float]:
        return np.round(np.interp(times, motion.time, values), digits).tolist()

    walker = motion.walker
    x, _ = study.array.places(walker)
    data: dict[str, Any] = {
        "time": np.round(times, 4).tolist(),
        "speed": at(motion.speed, 4),
        "distance": at(motion.distance, 5),
        "normal": at(motion.normal, 1),
        "film_load": at(motion.fluid_load, 1),
        "friction": at(motion.friction, 1),
        "drive": at(motion.drive, 1),
        "angle": at(motion.shoe_angle, 4),
        "sensors": np.round(x, 4).tolist(),
        "wet": study.setting.viscosity is not None,
        "pool": 1e6 * study.setting.settings.pool_depth,
    }
    if run is not None:
        from underfoot.slip.dynamics.sensors import MAP_X, MAP_Y

        nearest = np.clip(np.searchsorted(motion.time, times), 1, motion.time.size - 1)
        every = max(run.profile_x.size // 90, 1)
        films = 1e6 * run.profiles[nearest][:, ::every].astype(float)
        middle = int(np.argmin(np.abs(MAP_Y)))
        pressure = run.maps[nearest][:, :, middle].astype(float) / 1e3
        data |= {
            "sole_x": np.round(run.profile_x[::every], 4).tolist(),
            "films": [[None if v != v else round(v, 1) for v in row] for row in films],
            "map_x": np.round(MAP_X, 4).tolist(),
            "pressures": np.round(pressure, 1).tolist(),
            "highest": round(float(pressure.max()), 1),
        }
    return data
