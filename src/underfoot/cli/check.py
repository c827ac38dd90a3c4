"""``underfoot check``: the whole case before it is computed; solves nothing."""

from __future__ import annotations

from .options import AsJson, CasePath, CatalogueFolders, Settings, ShowAll, loaded
from .output import finish


def check(
    case: CasePath,
    set_: Settings = None,
    json: AsJson = False,
    everything: ShowAll = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Read a case and print its values, sources, assumptions and the cost of a run."""
    from underfoot.questions.check import case_check

    finish(case_check(loaded(case, catalogue, set_)), None, json=json, everything=everything)
