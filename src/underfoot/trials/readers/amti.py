"""AMTI NetForce: its binary recordings (.bsf) and its text exports that say who wrote them."""

import struct

import numpy as np

from underfoot.core.remark import Message

from ..recording.trial import Trial
from .columns import trial_from_sheet
from .draft import RecordingDraft
from .sheet import sheet_from

_MAIN = struct.Struct("<4i100s12s12sdds3xid7id4xi150s200s150s150s100s2xi")
_INSTRUMENT = struct.Struct("<3i20s5i5f32f" + 32 * "h2x" + "16f3f96f5f32ii2f")
_POUND, _NAMES = 4.4482216152605, ("Fx", "Fy", "Fz", "Mx", "My", "Mz")


def read_netforce(draft: RecordingDraft) -> Trial:
    """Return the plates of a NetForce recording as a trial.

    Binary: counts times 1e6 / (sensitivity gain excitation range), in pounds, turned from the force
    on the plate to that on the foot; layout as BTK's reader has it (BSD licence), not verified on a
    file of the maker. Text: columns by their names.
    """
    if not draft.data.startswith(b"\x64\0\0\0"):
        return trial_from_sheet(draft, sheet_from(draft.data, draft.name), "AMTI text")
    try:
        main = _MAIN.unpack_from(draft.data)
        count, more, rate, seconds = main[2], main[3], main[20], main[11]
        if not 0 < count + more < 64 or not 0 < rate < 1e6 or not 0 < seconds < 1e6:
            raise draft.error(
                Message(
                    "{count} plates, {rate} Hz and {seconds:g} s can't be",
                    count=count,
                    rate=rate,
                    seconds=seconds,
                )
            )
        at, heads = _MAIN.size, []
        for _ in range(count + more):
            heads.append(_INSTRUMENT.unpack_from(draft.data, at))
            at += _INSTRUMENT.size
    except struct.error as error:
        raise draft.error("truncated: the headers are not complete") from error
    widths = [head[4] for head in heads]
    if any(width != 6 for width in widths[:count]) or not all(0 <= w <= 32 for w in widths):
        raise draft.error(
            Message("plates of {widths} channels", widths=widths), allowed="six channels a plate"
        )
    raw = np.frombuffer(draft.data[at : at + (len(draft.data) - at) // 2 * 2], "<i2")
    samples = round(seconds * rate)
    if raw.size < samples * sum(widths):
        draft.count(str(samples), raw.size // sum(widths), "samples of the header")
    draft.rate = float(rate)
    raw = raw[: samples * sum(widths)].reshape(samples, sum(widths)).astype(float)
    first = 0
    for number, (head, width) in enumerate(zip(heads, widths, strict=True), start=1):
        sensitivity = np.array(head[14 : 14 + width])
        settings = np.array(head[97:193]).reshape(3, 32)[:, :width].prod(axis=0)
        with np.errstate(divide="ignore"):
            values = -raw[:, first : first + width] * 1e6 / (sensitivity * settings)
        first += width
        if not np.isfinite(values).all():
            raise draft.error(
                Message("the calibration of instrument {number} is damaged", number=number)
            )
        if number > count:
            continue
        for i, name in enumerate(_NAMES):
            scale, unit = (_POUND, "N") if i < 3 else (0.0254 * _POUND, "N*m")
            draft.channel(f"{name}{number}", values[:, i], unit=unit, scale=scale, note="")
        force = values[:, :3] * _POUND
        draft.plate(force, kind="AMTI BSF, force on the plate turned to the foot")
    return draft.trial("AMTI BSF")
