"""``underfoot sensitivity``: effect of the least known inputs of a case."""

from __future__ import annotations

from .options import (
    AsJson,
    CasePath,
    CatalogueFolders,
    OutFolder,
    Overwrite,
    Processes,
    Quick,
    Settings,
    ShowAll,
    loaded,
)
from .output import answer


def sensitivity(
    case: CasePath,
    out: OutFolder = None,
    quick: Quick = True,
    set_: Settings = None,
    processes: Processes = None,
    json: AsJson = False,
    everything: ShowAll = False,
    overwrite: Overwrite = False,
    catalogue: CatalogueFolders = None,
) -> None:
    """Vary the assumed inputs of a case one at a time and show the effect on its results.

    Two runs an input, each kept on disk: a second call answers at once, a stopped one continues.
    """
    from underfoot.questions.sensitivity import sensitivity as effects

    given = loaded(case, catalogue, set_)
    answer(
        given.name,
        lambda progress: effects(given, quick=quick, processes=processes, progress=progress),
        out=out,
        overwrite=overwrite,
        json=json,
        everything=everything,
    )
