"""Published studies run again: our numbers beside the printed ones, with a verdict for each."""

from .registry import STUDIES, Study, study
from .verdict import ComparedLine, Erratum, Verdict, compared_range, compared_sign

__all__ = [
    "STUDIES",
    "ComparedLine",
    "Erratum",
    "Study",
    "Verdict",
    "compared_range",
    "compared_sign",
    "study",
]
