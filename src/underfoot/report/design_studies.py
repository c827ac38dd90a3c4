"""Tables, pictures and the page of a design study, written into its folder."""

from __future__ import annotations

from underfoot.core import Progress, silent
from underfoot.core.files import whole_file
from underfoot.explore import Study, StudyResult

from .dispatch import page_text
from .writing import Written


def write_study_report(
    study: Study, result: StudyResult, *, progress: Progress = silent
) -> Written:
    """Write results.csv, results.parquet and report.html into the folder of a study."""
    failures = study.store.write_views(result.jobs)
    path = study.store.folder / "report.html"
    with whole_file(path) as part:
        part.write_text(page_text(result, {}), encoding="utf-8")
    return Written(study.store.folder, path, tuple(failures))
