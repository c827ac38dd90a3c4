"""Measurements: files to trials, trials to the numbers the field publishes."""

from underfoot.core.deprecation import package_names

from .machines.pressures import (
    Passage,
    Pulse,
    PulseDefinition,
    SensorArrayReading,
    heel_track,
    passages,
    pressure_pulse,
    sensor_array_reading,
    sensor_rows,
)
from .machines.slip_friction import (
    ACOF_WINDOWS,
    available_friction,
    available_frictions,
    mean_friction,
)
from .readers import (
    PlateColumns,
    Sheet,
    TrialsProfile,
    profile_from,
    read_profile,
    read_sheet,
    read_trial,
    read_trials,
)
from .recording.axes import Axes, Ramp, axes_of, axis_name, axis_vector, ramp_from
from .recording.marker_names import heel_candidates
from .recording.measurement import Flag, Measurement, mean_of
from .recording.plates import finished_plate
from .recording.signals import (
    FILTERS,
    FORCE_FILTER,
    MARKER_FILTER,
    LowPass,
    contacts,
    low_passed,
    velocity,
)  # fmt: skip
from .recording.trial import (
    Channel,
    Edit,
    Event,
    Marker,
    Plate,
    PlateAccuracy,
    Trial,
    file_checksum,
    join_trials,
)
from .walking.belts import Belt
from .walking.body_weight import body_mass, body_weight
from .walking.describe import Description, describe_trial, described_file
from .walking.events import EditError, Stance, stances
from .walking.gait import (
    DEFINITIONS,
    RcofDefinition,
    RequiredFriction,
    required_friction,
    required_frictions,
    stance_frictions,
)
from .walking.gait_context import (
    GaitContext,
    SlipCourse,
    foot_angle,
    gait_context,
    slip_course,
    stance_curves,
)
from .walking.slips import (
    HeelMotion,
    Outcome,
    OutcomeLimits,
    Slip,
    SlipDefinition,
    contact_from_heel,
    heel_motion,
    slip,
    slip_of,
)
from .walking.walkway import Walkway, walkway_of

__all__ = [
    "ACOF_WINDOWS",
    "DEFINITIONS",
    "FILTERS",
    "FORCE_FILTER",
    "MARKER_FILTER",
    "Axes",
    "Belt",
    "Channel",
    "Description",
    "Edit",
    "EditError",
    "Event",
    "Flag",
    "GaitContext",
    "HeelMotion",
    "LowPass",
    "Marker",
    "Measurement",
    "Outcome",
    "OutcomeLimits",
    "Passage",
    "Plate",
    "PlateAccuracy",
    "PlateColumns",
    "Pulse",
    "PulseDefinition",
    "Ramp",
    "RcofDefinition",
    "RequiredFriction",
    "SensorArrayReading",
    "Sheet",
    "Slip",
    "SlipCourse",
    "SlipDefinition",
    "Stance",
    "Trial",
    "TrialsProfile",
    "Walkway",
    "available_friction",
    "available_frictions",
    "axes_of",
    "axis_name",
    "axis_vector",
    "body_mass",
    "body_weight",
    "contact_from_heel",
    "contacts",
    "describe_trial",
    "described_file",
    "file_checksum",
    "finished_plate",
    "foot_angle",
    "gait_context",
    "heel_candidates",
    "heel_motion",
    "heel_track",
    "join_trials",
    "low_passed",
    "mean_friction",
    "mean_of",
    "passages",
    "pressure_pulse",
    "profile_from",
    "ramp_from",
    "read_profile",
    "read_sheet",
    "read_trial",
    "read_trials",
    "required_friction",
    "required_frictions",
    "sensor_array_reading",
    "sensor_rows",
    "slip",
    "slip_course",
    "slip_of",
    "stance_curves",
    "stance_frictions",
    "stances",
    "velocity",
    "walkway_of",
]  # fmt: skip

__getattr__ = package_names(
    __name__, gone="0.5", described="describe_trial", joined="join_trials", Profile="TrialsProfile"
)
