"""Plots of a trial as plain data: small ones as SVG text, large ones as panels, lines and events.

A plot: ``begin`` and ``end`` (s); ``panels`` with lines (``low`` and ``high`` of equal parts of the
time, or a curve at times ``x``); ``bands`` of steps; ``events``, those with ``least`` and ``most``
(s) may be moved. ``static/trial.js`` draws it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from underfoot.trials.pages.figures import Tile, TileSheet
from underfoot.trials.recording.signals import CONTACT_FORCE
from underfoot.trials.study import FileResult
from underfoot.trials.study.file_result import StepResult
from underfoot.trials.study.record_signals import Envelope, RecordSignals

WIDTH = 900
"""Parts of a signal that are drawn across a page."""
TILE = (160, 70)
"""Size of a small plot (px)."""
TILE_POINTS = 80
BEFORE, AFTER = 0.25, 0.15
"""s shown before the contact and after the toe off of a step."""
RATIOS = ("steps", "rejected", "slipping")
"""Curves of a file that hold a ratio of forces over a contact."""
LOADED = 50.0
"""N above which a ratio of forces is drawn, as in the contact sheets of the report."""
RUNS: dict[str, dict[str, tuple[str, ...]]] = {
    "slide": {"force": ("normal", "shear"), "ratio": ("ratio",)},
    "run": {"cof": ("ratio",)},
    "hold": {"force": ("force",)},
}
"""Panels of the curves of a run, with the series in each."""


def tile_svg(tiles: Sequence[Tile], sheet: TileSheet) -> str:
    """Return the curves of a file as SVG on the sheet's scales, coloured by their verdicts."""
    wide, high = TILE
    (left, right), (low, top) = sheet.x_range, sheet.y_range

    def points(x: np.ndarray, y: np.ndarray) -> str:
        across = wide * (x - left) / (right - left)
        up = high * (1.0 - np.clip((y - low) / (top - low), 0.0, 1.0))
        return " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(across, up, strict=True))

    parts = [f'<svg viewBox="0 0 {wide} {high}" aria-hidden="true">']
    if sheet.line is not None:
        level = points(np.array(sheet.x_range), np.full(2, sheet.line))
        parts.append(f'<polyline class="limit" points="{level}"/>')
    for tile in tiles:
        inside = np.isfinite(tile.y) & (tile.x >= left) & (tile.x <= right)
        x, y = tile.x[inside], tile.y[inside]
        every = max(1, len(x) // TILE_POINTS)
        parts.append(
            f'<polyline class="{tile.verdict}" points="{points(x[::every], y[::every])}"/>'
        )
        for mark in np.array(tile.marks, dtype=float).reshape(-1, 2):
            if np.isfinite(mark).all():
                x, y = points(mark[:1], mark[1:]).split(",")
                parts.append(f'<circle class="{tile.verdict}" cx="{x}" cy="{y}" r="2.5"/>')
    return "".join([*parts, "</svg>"])


def record_plot(record: FileResult, signals: RecordSignals) -> dict[str, Any]:
    """Return the loads of all plates over the whole record, with the contacts as bands."""
    begin = min(each.start for each in signals.force.values())
    end = max(each.end for each in signals.force.values())
    loads = [_line(name, each.envelope(begin, end, WIDTH)) for name, each in signals.force.items()]
    bands = [_band(step) for step in record.steps]
    return {"begin": begin, "end": end, "panels": [_panel("force", loads)], "bands": bands}


def step_plot(record: FileResult, step: StepResult, signals: RecordSignals) -> dict[str, Any]:
    """Return load, ratio and heel speed around a step, with its events."""
    contact, toe_off, plate = step.contact, step.toe_off, signals.force[step.plate]
    begin, end = max(contact - BEFORE, plate.start), min(toe_off + AFTER, plate.end)
    seen = {name: each.envelope(begin, end, WIDTH) for name, each in signals.force.items()}
    loads = [
        _line(name, each)
        for name, each in seen.items()
        if name == step.plate or max(each.high, default=0.0) > CONTACT_FORCE
    ]
    panels = [_panel("force", loads)]
    least = 2.0 / plate.rate
    events: list[dict[str, Any]] = [
        {"id": "contact", "time": contact, "least": plate.start, "most": toe_off - least},
        {"id": "toe off", "time": toe_off, "least": contact + least, "most": plate.end},
    ]
    if "exclude" in step.by_hand:  # its marks show where it was; they are not moved
        events = [{"id": event["id"], "time": event["time"]} for event in events]
    curves = (each for kind in RATIOS for each in record.curves.get(kind, ()))
    for curve in (each for each in curves if each["number"] == step.number):
        loaded = [
            ratio if load is not None and load > LOADED else None
            for ratio, load in zip(curve["ratio"], curve["normal"], strict=True)
        ]
        lines = [_curve("ratio", curve["time"], loaded, contact)]
        peak = curve.get("peak")
        panels.append(_panel("ratio", lines, max(0.4, 1.4 * peak) if peak else 0.6))
        if peak:
            at = contact + curve["peak_time"]
            events.append({"id": "gate", "time": contact + curve["gate"], "panel": 1})
            events.append({"id": "rcof", "time": at, "panel": 1, "value": peak})
    speeds = [_line(s, each.envelope(begin, end, WIDTH)) for s, each in signals.heel_speed.items()]
    if speeds:
        panels.append(_panel("speed", speeds))
    if step.judged_for_slip and speeds and record.curves.get("heel"):
        events += _slip_events(record.curves["heel"][0], contact, len(panels) - 1)
    return {
        "begin": begin, "end": end, "panels": panels, "events": events,
        "bands": [_band(step)], "spacing": 1.0 / plate.rate,
    }  # fmt: skip


def _slip_events(heel: Mapping[str, Any], contact: float, panel: int) -> list[dict[str, Any]]:
    """Return start, peak and end of a slip, which a heel's curve gives in seconds after contact."""
    events = []
    for name, key in (("slip start", "start"), ("slip end", "end"), ("slip peak", "peak_time")):
        if heel[key] is not None:
            event = {"id": name, "time": contact + heel[key], "panel": panel}
            events.append(event | ({"value": heel["peak"]} if key == "peak_time" else {}))
    return events


def run_plot(record: FileResult) -> dict[str, Any] | None:
    """Return the curves of a run without steps, with its window; None where there are none."""
    kind = next((kind for kind in RUNS if record.curves.get(kind)), None)
    if kind is None:
        return None
    curve = record.curves[kind][0]
    time = curve["time"]
    panels = [
        _panel(name, [_curve(key, time, curve[key]) for key in series])
        for name, series in RUNS[kind].items()
    ]
    ends = [{"id": key, "time": curve[key]} for key in ("begin", "end") if key in curve]
    return {"begin": time[0], "end": time[-1], "panels": panels, "events": ends, "bands": []}


def _band(step: StepResult) -> dict[str, Any]:
    ends = {"begin": step.contact, "end": step.toe_off}
    return {"id": step.number, "verdict": step.verdict, **ends}


def _panel(name: str, lines: list[dict[str, Any]], most: float = math.inf) -> dict[str, Any]:
    """Return a panel from 0, or the lowest value, to the highest, at ``most``."""
    values = [v for line in lines for v in (*line["low"], *line["high"]) if v is not None]
    high = min(max([1e-9, *values]), most)
    return {"id": name, "lines": lines, "low": min([0.0, *values]), "high": high}


def _line(name: str, seen: Envelope) -> dict[str, Any]:
    low, high = _plain(seen.low), _plain(seen.high)
    times = {"start": seen.start, "spacing": seen.spacing}
    return {"name": name, **times, "low": low, "high": [] if low == high else high}


def _curve(
    name: str, time: Sequence[float], values: Sequence[float | None], offset: float = 0.0
) -> dict[str, Any]:
    low = _plain(np.array(values, dtype=float))
    return {"name": name, "x": [offset + t for t in time], "low": low, "high": []}


def _plain(values: np.ndarray) -> list[float | None]:
    return [float(f"{v:.5g}") if math.isfinite(v) else None for v in values.tolist()]
