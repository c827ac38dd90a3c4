"""Studies from Python: a sweep over lists and ranges, and an optimisation, without a file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from underfoot.case import Case, unit_at
from underfoot.case import text as toml
from underfoot.case.section import plain_text
from underfoot.core import Progress, silent

from .result import StudyResult
from .study import Study
from .study_file import read_plan

if TYPE_CHECKING:
    import xarray


def sweep(
    case: Case,
    vary: Mapping[str, Any],
    *,
    conditions: Mapping[str, Sequence[Any]] | None = None,
    budget: int | None = None,
    quick: bool = True,
    folder: Path | str | None = None,
    on: str | None = None,
    workers: int | None = 1,
    progress: Progress = silent,
) -> xarray.Dataset:
    """Return every output of a case over (design, condition, draw).

    Parameters:
        case: What is varied.
        vary: Dotted path: a list of values, or (from, to) or (from, to, steps). Numbers are SI
            floats or text with a unit. Lists and steps make a full grid; with ranges ``budget``
            runs are spread evenly.
        conditions: Dotted path, or ``wear``: values; every design is run in each combination.
        budget: Full runs at most.
        quick: Use the coarse grid.
        folder: Where the study is kept and from where it goes on; None keeps nothing.
        on, workers, progress: As for ``Study.run``.

    Raises:
        CaseError: All errors of the inputs that are varied.
    """
    method = {"budget": budget, "grid": "quick" if quick else "standard"}
    tables = {"vary": vary, "conditions": conditions or {}, "method": method}
    return _ran(case, tables, folder, on, workers, progress).to_xarray()


def optimise(
    case: Case,
    vary: Mapping[str, Any],
    *,
    maximise: Sequence[str] = (),
    minimise: Sequence[str] = (),
    require: Sequence[str] = (),
    conditions: Mapping[str, Sequence[Any]] | None = None,
    uncertain: Mapping[str, Mapping[str, Any]] | None = None,
    budget: int = 100,
    quick: bool = True,
    folder: Path | str | None = None,
    on: str | None = None,
    workers: int | None = 1,
    progress: Progress = silent,
) -> StudyResult:
    """Return the front of designs that no other beats in every goal, each run in full.

    Parameters:
        case, vary, conditions, quick, folder, on, workers, progress: As for ``sweep``.
        maximise, minimise: Goals, as ``"quantile(cof, 0.1) over conditions"``.
        require: Requirements, as ``"cof > 0.16 in canola_oil"``.
        uncertain: Dotted path: distribution, as ``{"lognormal": 2.0, "factor": 1.3}``; goals are
            then taken over common draws of them.
        budget: Full runs at most, before the ten best designs and the case are run again on new
            positions of the tread and the standard grid.

    Raises:
        CaseError: All errors of the request.
    """
    method = {"kind": "optimise", "budget": budget, "grid": "quick" if quick else "standard"}
    outputs = {"maximise": list(maximise), "minimise": list(minimise), "require": list(require)}
    tables = {
        "vary": vary,
        "conditions": conditions or {},
        "uncertain": uncertain or {},
        "outputs": outputs,
        "method": method,
    }
    return _ran(case, tables, folder, on, workers, progress)


def _ran(
    case: Case,
    tables: Mapping[str, Mapping[str, Any]],
    folder: Path | str | None,
    on: str | None,
    workers: int | None,
    progress: Progress,
) -> StudyResult:
    tree = {
        name: {
            key: _file_value(name, key, value) for key, value in table.items() if value is not None
        }
        for name, table in tables.items()
    }
    text = toml.toml_text({name: table for name, table in tree.items() if table})
    with TemporaryDirectory(prefix="underfoot-study-") as temporary:
        place = Path(temporary if folder is None else folder)
        study = Study(read_plan(text, place, base=case), place)
        result = study.run(on, workers, progress)
        if folder is None:  # it goes now
            result = replace(result, jobs=list(result.jobs), records=dict(result.records))
        return result


def _file_value(section: str, path: str, value: Any) -> Any:
    """Return what is varied as a study file writes it."""
    if section in ("outputs", "method") or isinstance(value, str):
        return value
    unit = "m" if path == "wear" else unit_at(path) if "." in path else "1"
    if isinstance(value, Mapping):
        factors = ("factor", "times", "log", "steps")
        return {k: v if k in factors else plain_text(v, unit) for k, v in value.items()}
    if section == "vary" and isinstance(value, tuple):
        names = ("from", "to", "steps")
        return dict(
            zip(names, (*(plain_text(v, unit) for v in value[:2]), *value[2:]), strict=False)
        )
    return [plain_text(one, unit) for one in value]
