"""Cases whose sole is a pad of a few square centimetres, solved in a fraction of a second."""

from typing import Any

from underfoot.case import Case

PAD = """
file_version = 2
name = "pad"
[shoe]
material.shore_a = 65
roughness = {ra = "2 um", cutoff = "0.8 mm"}
tread.pattern = "none"
[shoe.heel]
length = "24 mm"
width = "16 mm"
rear_radius = "0 mm"
profile.model = "flat"
edge_radius = "0 mm"
[shoe.sole]
outsole_thickness = "10 mm"
[floor]
roughness = {rq = "3 um", cutoff = "0.8 mm"}
[contaminant]
viscosity = "100 cP"
[motion]
speed = "0.3 m/s"
normal_force = "50 N"
shoe_angle = "3 deg"
"""
COARSE = {
    "grid_spacing": "2 mm", "quick_grid_spacing": "4 mm", "tread_positions": 1, "tolerance": 1e-7,
}  # fmt: skip
DRY = {"contaminant": "none", "friction": {"model": "constant", "cof": 0.8}}
TWO_GRIDS = {"numerics.tread_positions": 3}
BARS = {
    "shoe.tread": {"pattern": "bars", "depth": "3 mm", "lug_width": "4 mm",
                   "channel_width": "4 mm"},
    "numerics.grid_spacing": "1 mm",
    "numerics.quick_grid_spacing": "2 mm",
}  # fmt: skip
STEP: dict[str, Any] = {
    "motion": {
        "history_points": [
            {"time": "0 s", "normal_force": "0 N", "speed": "0.1 m/s", "shoe_angle": "6 deg"},
            {"time": "20 ms", "normal_force": "60 N", "speed": "0.3 m/s", "shoe_angle": "3 deg"},
            {"time": "40 ms", "normal_force": "50 N", "speed": "0.2 m/s", "shoe_angle": "2 deg"},
        ],
        "shoe_angle": "3 deg",
    }
}
ARRAY = {"sensor.array": {"rows": 2, "columns": 2, "spacing": "5 mm", "inlet_diameter": "2 mm"}}


def pad(*changes: dict[str, Any]) -> Case:
    """Return the pad with changes, the later ones over the earlier."""
    case = Case.from_text(PAD).replace({"numerics": COARSE})
    return case.replace({key: value for each in changes for key, value in each.items()})
