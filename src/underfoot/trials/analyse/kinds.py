"""Analysis of one file by the kind of its protocol."""

from collections.abc import Callable, Mapping
from dataclasses import fields

import numpy as np

from underfoot.core import DataError

from ..axes import axes_of
from ..measurement import Measurement
from ..pin_on_disk import friction_point
from ..pressure_map import pressure_scan
from ..protocols import Protocol
from ..readers import Profile
from ..relaxation_test import relaxation_reading
from ..slide_friction import slide_friction
from ..trial import Trial
from .edit_table import EDIT_COLUMNS
from .file_result import Draft, rates
from .steps import STEP_KINDS, analysed_steps


def analysed_trial(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    """Analyse one trial into ``draft`` by the kind of the protocol.

    An `UnderfootError` says what makes the whole file useless; single numbers that can't be
    measured are kept as "not estimated".
    """
    if protocol.kind in STEP_KINDS:
        analysed_steps(trial, draft, protocol, profile)
        return
    for edit in trial.edits:
        draft.refusals.append(f"excluded by hand: {edit.why}")
        excluded = (draft.file, edit.what, "used", "excluded", "", None, None, edit.why)
        draft.edits.append(dict(zip(EDIT_COLUMNS, excluded, strict=True)))
    _KINDS[protocol.kind](trial, draft, protocol, profile)


def _slip_tester(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    found = slide_friction(trial, protocol, axes_of(trial, vertical=profile.vertical))
    rates(trial, draft)
    draft.add("slide", found.cof, main="cof")
    draft.facts.update(found.facts)
    series = {key: getattr(found, key) for key in ("time", "normal", "shear", "ratio")}
    draft.curve("slide", **series, begin=found.window[0], end=found.window[1])
    if not profile.sensors or not trial.markers:
        return
    name, position = next(iter(profile.sensors.items()))
    marker = next(iter(trial.markers.values()))
    sensor = trial.channel(name)
    try:
        scan = pressure_scan(trial, sensor, marker, position=position)
    except DataError as error:
        draft.cautions.append(f"no pressure scan: {error.what}")
        return
    draft.cautions += list(scan.flags)
    highest = float(scan.pressure.max())
    peak = Measurement("peak fluid pressure", highest, "Pa", scan.baseline_sd)
    draft.add("scan", peak, main="scan_peak_pressure")
    stored = {
        f.name: getattr(scan, f.name) for f in fields(scan) if f.name not in ("trial", "flags")
    }
    for name in ("along", "pressure"):
        stored[name] = [float(f"{v:.7g}") for v in stored[name]]
    draft.curves["scan"] = stored


def _pin_on_disk(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    speed = draft.conditions.get("speed")
    point = friction_point(trial, speed=speed if isinstance(speed, float) else None)
    draft.add(trial.name, point.cof, main="cof")
    draft.facts["duration"] = float(point.time[-1] - point.time[0])
    if point.normal is not None:
        draft.facts["normal_force"] = point.normal
    if point.shear is not None:
        draft.main["friction_force"] = point.shear
    if point.speed is not None:
        draft.facts["sliding_speed"] = draft.main["speed"] = point.speed
    begin, end = point.window
    cof = point.cof.value or np.nan
    draft.curve("run", time=point.time, ratio=point.ratio, begin=begin, end=end, cof=cof)


def _relaxation(trial: Trial, draft: Draft, protocol: Protocol, profile: Profile) -> None:
    thickness = draft.conditions.get("thickness")
    if not isinstance(thickness, float):
        raise DataError(
            "the thickness of the block is not known",
            where=trial.name,
            remedy='Add a column "thickness (mm)" to conditions.csv',
        )
    found = relaxation_reading(trial, thickness)
    for name in ("force_2_percent", "peak_force", "final_force"):
        draft.add("test", getattr(found, name), main=name)
    draft.facts["hold_time"] = found.hold_time
    draft.facts["compression"] = found.peak_displacement / (2.0 * thickness)
    time, force = found.hold
    log = np.unique(np.geomspace(1, len(time) - 1, 300).astype(int))
    draft.curve("hold", time=time[log], force=force[log], final=found.final_force.value or 0.0)


_KINDS: Mapping[str, Callable[[Trial, Draft, Protocol, Profile], None]] = {
    "slip_tester": _slip_tester,
    "pin_on_disk": _pin_on_disk,
    "boundary": _pin_on_disk,
    "relaxation": _relaxation,
}
