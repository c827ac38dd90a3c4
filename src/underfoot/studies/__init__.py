"""Published studies run again: computed beside printed numbers, with a verdict for each."""

from .figure import Figure, Layer, Panel
from .runner import Computed, Options, StudyResult, Table, run_all, run_study
from .statements import Claim, Kind, Statement, Study, read_study, studies, study
from .summary import headline, read_results, summary_markdown, write_summary
from .verdict import Judgement, Quantity, Verdict, counts, judge, judged

__all__ = [
    "Claim",
    "Computed",
    "Figure",
    "Judgement",
    "Kind",
    "Layer",
    "Options",
    "Panel",
    "Quantity",
    "Statement",
    "Study",
    "StudyResult",
    "Table",
    "Verdict",
    "counts",
    "headline",
    "judge",
    "judged",
    "read_results",
    "read_study",
    "run_all",
    "run_study",
    "studies",
    "study",
    "summary_markdown",
    "write_summary",
]
