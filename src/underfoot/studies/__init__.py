"""Published studies run again: computed beside printed numbers, with a verdict for each."""

from underfoot.core.deprecation import package_names

from .figure import Figure, Layer, Panel
from .runner import Computed, Options, PublishedStudyResult, StudyTable, run_all, run_study
from .statements import Claim, PublishedStudy, Statement, StatementKind, read_study, studies, study
from .summary import headline, read_results, summary_markdown, write_summary
from .verdict import ComputedQuantity, Judgement, Verdict, counts, judge, judge_study

__all__ = [
    "Claim",
    "Computed",
    "ComputedQuantity",
    "Figure",
    "Judgement",
    "Layer",
    "Options",
    "Panel",
    "PublishedStudy",
    "PublishedStudyResult",
    "Statement",
    "StatementKind",
    "StudyTable",
    "Verdict",
    "counts",
    "headline",
    "judge",
    "judge_study",
    "read_results",
    "read_study",
    "run_all",
    "run_study",
    "studies",
    "study",
    "summary_markdown",
    "write_summary",
]

__getattr__ = package_names(
    __name__,
    gone="0.5",
    judged="judge_study",
    Kind="StatementKind",
    Quantity="ComputedQuantity",
    Study="PublishedStudy",
    StudyResult="PublishedStudyResult",
    Table="StudyTable",
)
