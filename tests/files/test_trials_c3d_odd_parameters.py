"""C3D files whose parameters are odd, damaged, lacking or told in another way: what is read."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from trials_c3d_writing import c3d_bytes

from recording_texts import changes, read_lines
from snapshot import held
from underfoot.trials.readers import c3d

FRAMES, SAMPLES = 60, 600


def content(**changed: Any) -> tuple[np.ndarray, np.ndarray, dict[str, dict[str, Any]]]:
    """Return points, samples and groups of a step on a plate; ``GROUP_NAME`` takes their place."""
    time = np.arange(FRAMES) / 100.0
    points = np.full((FRAMES, 2, 3), np.nan)
    points[:, 0] = np.column_stack((700 * time, 50 + 0 * time, 100 + 40 * np.cos(7 * time)))
    points[5:, 1] = points[5:, 0] + np.array([200.0, 10, -30])
    load = np.zeros(SAMPLES)
    load[150:450] = np.sin(np.linspace(0, np.pi, 300))
    force = np.outer(load, [20.0, -90.0, -640.0])
    moment = np.cross(np.broadcast_to([0.02, 0.01, 0.04], force.shape), force)
    corners = np.array([[500.0, 300, 0], [500, 0, 0], [0, 0, 0], [0, 300, 0]])
    groups: dict[str, dict[str, Any]] = {
        "POINT": {"LABELS": ["LHEE", "LTOE"], "UNITS": ["mm"], "USED": np.array([2]),
                  "FRAMES": np.array([FRAMES]), "RATE": np.array([100.0]),
                  "SCALE": np.array([-0.1]), "DESCRIPTIONS": ["a", "b"]},
        "ANALOG": {"LABELS": ["Fx", "Fy", "Fz", "Mx", "My", "Mz"],
                   "UNITS": ["N"] * 3 + ["Nmm"] * 3, "SCALE": np.ones(6), "RATE": np.array([1e3]),
                   "GEN_SCALE": np.array([1.0]), "OFFSET": np.zeros(6, dtype=int),
                   "USED": np.array([6])},
        "FORCE_PLATFORM": {"USED": np.array([1]), "TYPE": np.array([2]), "ZERO": np.array([1, 100]),
                           "CORNERS": corners.T[:, :, None].astype(float),
                           "ORIGIN": np.array([[1.0], [-2.0], [40.0]]),
                           "CHANNEL": np.arange(1, 7)[:, None]},
        "EVENT": {"USED": np.array([2]), "LABELS": ["Foot Strike", "Foot Off"],
                  "CONTEXTS": ["Left", "Right"],
                  "TIMES": np.array([[0.0, 0.0], [0.16, 0.44]])},
    }  # fmt: skip
    for key, value in changed.items():
        group, _, name = key.partition("__")
        groups[group].pop(name, None)
        if value is not None:
            groups[group][name] = value
    return points, np.column_stack((force, 1e3 * moment)), groups


SWAPPED = np.array([[500.0, 300, 0], [0, 0, 0], [500, 0, 0], [0, 300, 0]]).T[:, :, None]
FORMS: dict[str, dict[str, Any]] = {
    "no origin": {"FORCE_PLATFORM__ORIGIN": None},
    "origin of two": {"FORCE_PLATFORM__ORIGIN": np.array([[1.0], [2.0]])},
    "origin lost": {"FORCE_PLATFORM__ORIGIN": np.array([[1.0], [np.nan], [40.0]])},
    "origin below": {"FORCE_PLATFORM__ORIGIN": np.array([[1.0], [-2.0], [-40.0]])},
    "corners crossed": {"FORCE_PLATFORM__CORNERS": SWAPPED},
    "corners alike": {"FORCE_PLATFORM__CORNERS": np.ones((3, 4, 1))},
    "no corners": {"FORCE_PLATFORM__CORNERS": None},
    "zero lost": {"FORCE_PLATFORM__ZERO": None},
    "zero turned": {"FORCE_PLATFORM__ZERO": np.array([100, 1])},
    "zero at none": {"FORCE_PLATFORM__ZERO": np.array([0, 0])},
    "type 1": {"FORCE_PLATFORM__TYPE": np.array([1])},
    "type 3": {"FORCE_PLATFORM__TYPE": np.array([3])},
    "type 4": {"FORCE_PLATFORM__TYPE": np.array([4])},
    "type 4 calibrated": {"FORCE_PLATFORM__TYPE": np.array([4]),
                          "FORCE_PLATFORM__CAL_MATRIX": (2.0 * np.eye(6))[:, :, None]},
    "type 0": {"FORCE_PLATFORM__TYPE": np.array([0])},
    "channel 0": {"FORCE_PLATFORM__CHANNEL": np.arange(0, 6)[:, None]},
    "channel 7": {"FORCE_PLATFORM__CHANNEL": np.arange(2, 8)[:, None]},
    "five channels": {"FORCE_PLATFORM__CHANNEL": np.arange(1, 6)[:, None]},
    "no plate": {"FORCE_PLATFORM__USED": np.array([0])},
    "two plates told": {"FORCE_PLATFORM__USED": np.array([2])},
    "metres": {"POINT__UNITS": ["m"]}, "no unit": {"POINT__UNITS": None},
    "inches": {"POINT__UNITS": ["in"]}, "Nm": {"ANALOG__UNITS": ["N"] * 3 + ["Nm"] * 3},
    "volts": {"ANALOG__UNITS": ["V"] * 6}, "few units": {"ANALOG__UNITS": ["N"]},
    "no units": {"ANALOG__UNITS": None}, "one label": {"POINT__LABELS": ["LHEE"]},
    "no labels": {"POINT__LABELS": None}, "labels twice": {"POINT__LABELS": ["A", "A"]},
    "angles": {"POINT__LABELS": ["LHEE", "LKneeAngle"], "POINT__ANGLES": ["LKneeAngle"]},
    "scaled": {"ANALOG__SCALE": 0.5 * np.ones(6)}, "few scales": {"ANALOG__SCALE": np.ones(2)},
    "general scale": {"ANALOG__GEN_SCALE": np.array([2.0])},
    "offset": {"ANALOG__OFFSET": np.full(6, 10)},
    "unsigned": {"ANALOG__FORMAT": ["UNSIGNED"], "ANALOG__OFFSET": np.full(6, -3)},
    "signed": {"ANALOG__FORMAT": ["SIGNED"]},
    "no rate": {"POINT__RATE": None}, "frames told": {"POINT__FRAMES": np.array([59])},
    "more frames told": {"POINT__FRAMES": np.array([65535])},
    "events beyond": {"EVENT__TIMES": np.array([[0.0, 1.0], [0.16, 0.44]])},
    "one time": {"EVENT__TIMES": np.array([[0.0], [0.16]])},
    "no contexts": {"EVENT__CONTEXTS": None}, "no events": {"EVENT__USED": np.array([0])},
    "heel strikes": {"EVENT__LABELS": ["Heel Strike", "Toe Off"]},
    "other events": {"EVENT__LABELS": ["Event", "General"]},
}  # fmt: skip
STORAGE: dict[str, dict[str, Any]] = {
    "whole numbers": {"real": False}, "DEC": {"processor": 85}, "MIPS": {"processor": 86},
    "later": {"first_frame": 31}, "no rate in the head": {"point_rate": 0.0},
}  # fmt: skip


def test_parameters_that_are_odd(file_regression, tmp_path: Path):
    def read(forms, **storage):
        points, analog, groups = content(**forms)
        data = c3d_bytes(points, analog, groups=groups, **storage)
        return read_lines(tmp_path, "a.c3d", data, subtract_baseline=False)

    whole = read({})
    told = {name: changes(whole, read(forms)) for name, forms in FORMS.items()}
    told |= {f"stored {name}": changes(whole, read({}, **how)) for name, how in STORAGE.items()}
    told |= {
        f"whole numbers, {name}": changes(whole, read(FORMS[name], real=False))
        for name in ("unsigned", "offset", "scaled", "general scale", "signed", "few scales")
    }
    held(file_regression, {"read": whole, "with": told})


@pytest.mark.parametrize(
    ("group", "name", "needed"),
    [("POINT", "DESCRIPTIONS", False), ("POINT", "LABELS", True), ("EVENT", "LABELS", False),
     ("ANALOG", "SCALE", True), ("FORCE_PLATFORM", "CORNERS", True)],
)  # fmt: skip
def test_a_damaged_parameter_is_left_out_or_loses_the_file(tmp_path, group, name, needed):
    points, analog, groups = content()
    data = bytearray(c3d_bytes(points, analog, groups=groups))
    number = [*groups].index(group) + 1
    entry = bytes([len(name), number]) + name.encode()
    at = data.index(entry) + len(entry) + 2
    assert data[at] in (255, 4, 2, 1)
    data[at] = 99  # no kind of value
    lines = read_lines(tmp_path, "a.c3d", bytes(data))
    assert ("refused" in lines) == (needed and group in c3d._NEEDED)
    if "refused" not in lines:
        assert any(f"{group}:{name} is left out" in line for line in lines.values())
