"""What must fit together in the motion of a case and in its sensors."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from underfoot.core import InputError, RangeError, display

from .motion_table import motion_history

if TYPE_CHECKING:
    from .case import Case
    from .places import Places

_ARRAY = ("rows", "columns", "array_spacing", "array_inlet_diameter")


def motion_mismatches(case: Case, places: Places) -> Iterator[InputError]:
    """Yield what does not fit together in ``[motion]`` and ``[sensor]``."""
    motion = case.motion
    if motion.history_points is None and motion.duration < motion.force_rise_time:
        yield RangeError(
            f"{display(motion.duration, 's')} ends before the force has risen",
            where=places("motion.duration"),
            allowed=f"at least {display(motion.force_rise_time, 's')} (motion.force_rise_time)",
            remedy=f'Write motion.duration = "{motion.force_rise_time * 1e3 + 90:.0f} ms"',
        )
    if motion.history_points is not None:
        yield from _history(case, places)
    sensor = case.sensor
    given = [name for name in _ARRAY if getattr(sensor, name) is not None]
    if given and len(given) < len(_ARRAY):
        missing = next(name for name in _ARRAY if name not in given)
        yield InputError(
            "is missing: an array needs rows, columns, array_spacing and array_inlet_diameter",
            where=places(f"sensor.{missing}"),
            remedy='The report\'s array (G.5.1): rows = 3, columns = 3, array_spacing = "30 mm", '
            'array_inlet_diameter = "4 mm"',
        )


def _history(case: Case, places: Places) -> Iterator[InputError]:
    motion = case.motion
    where = places("motion.history" if motion.history else "motion.history_points")
    if motion.steady:
        yield InputError("a history has an end and no steady state", where=places("motion.steady"))
    try:
        history = motion_history(case)
    except InputError as error:
        yield InputError(error.what, where=where, allowed=error.allowed, remedy=error.remedy)
        return
    assert history is not None
    if abs(history.time[-1] - motion.duration) > 1e-9:
        yield InputError(
            f"the history lasts {display(float(history.time[-1]), 's')}",
            where=places("motion.duration"),
            remedy="Leave motion.duration out: the history says it",
        )
    if abs(history.normal_force[-1] - motion.normal_force) > 1e-6:
        yield InputError(
            f"the history ends with {history.normal_force[-1]:g} N",
            where=places("motion.normal_force"),
            allowed="above 0 N at the end, where the result is taken",
            remedy="Leave motion.normal_force out: the history says it",
        )
