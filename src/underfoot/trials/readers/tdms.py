"""National Instruments TDMS (LabVIEW): slip testers and tribometers made in laboratories."""

from io import BytesIO

import numpy as np

from underfoot.core.optional import optional_module
from underfoot.core.remark import Message

from ..recording.trial import Trial
from .columns import trial_from_sheet
from .draft import RecordingDraft
from .sheet import Sheet


def read_tdms(draft: RecordingDraft) -> tuple[Trial, ...]:
    """Return one trial for each group of a TDMS file (npTDMS).

    Columns are the channels with their units; time is a channel of that name, else the increment
    of the waveform (``wf_increment``).
    """
    library = optional_module("nptdms", "recordings", "Reading TDMS")
    try:
        file = library.TdmsFile.read(BytesIO(draft.data))
    except Exception as error:  # the package raises whatever its parser meets
        raise draft.error("damaged") from error
    trials = []
    for group in file.groups():
        columns = {c.name: np.asarray(c[:]) for c in group.channels() if len(c)}
        columns = {name: v.astype(float) for name, v in columns.items() if v.dtype.kind in "fiu"}
        if not columns:
            continue
        lengths = {len(values) for values in columns.values()}
        if len(lengths) > 1:
            raise draft.error(Message('channels of "{name}" differ in length', name=group.name))
        of = {c.name: c.properties for c in group.channels()}
        units = {name: str(of[name].get("unit_string", "")) for name in columns}
        step = float(next((p["wf_increment"] for p in of.values() if "wf_increment" in p), 0.0))
        if step > 0 and not any(name.casefold() in ("time", "t") for name in columns):
            columns = {"time": step * np.arange(float(lengths.pop())), **columns}
            units["time"] = "s"
        label = draft.name if len(file.groups()) == 1 else f"{draft.name}, {group.name}"
        own = RecordingDraft(b"", label, draft.profile, draft.subtract_baseline)
        trials.append(trial_from_sheet(own, Sheet(label, columns, {}, units), "TDMS"))
    if not trials:
        raise draft.error("no group holds channels of numbers")
    return tuple(trials)
