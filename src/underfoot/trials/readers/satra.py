"""SATRA's slip tester STM 603: its text log by its own column names."""

import re
from dataclasses import replace

from ..recording.trial import Trial
from .columns import trial_from_sheet
from .draft import RecordingDraft
from .profile import PlateColumns
from .sheet import sheet_from

_NORMAL = re.compile(r"(vertical|normal) *(force|load)", re.I)
_FRICTION = re.compile(r"(horizontal|friction(al)?|shear|traction) *(force|load)", re.I)


def read_stm603(draft: RecordingDraft) -> Trial:
    """Return the log of a slip test as a tester with friction and normal force.

    Columns are known by their words (vertical or normal force; horizontal or friction force); a
    profile that names them goes first. From memory of SATRA TM144 logs, not verified on a file of
    the maker: the columns taken stand in the notes.
    """
    profile = draft.profile
    sheet = sheet_from(
        draft.data, draft.name, profile.sheet, profile.delimiter, profile.header_line
    )
    if not profile.plates:
        columns = [
            next((n for n in sheet.numbers if p.search(n)), "") for p in (_FRICTION, _NORMAL)
        ]
        if not all(columns):
            raise draft.error(
                "no column of vertical and of horizontal force",
                allowed=", ".join(sheet.columns[:8]),
                remedy="Name them in a profile",
            )
        tester = PlateColumns((columns[0], "", columns[1]))
        draft.profile = replace(
            profile, plates={"tester": tester}, vertical=profile.vertical or "z"
        )
        draft.notes.append(f'friction is "{columns[0]}", normal force "{columns[1]}"')
    return trial_from_sheet(draft, sheet, "SATRA STM 603")
