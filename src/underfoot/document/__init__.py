"""Figures, tables and pages made from results; nothing here computes."""

from __future__ import annotations

from .comparison import case_differences, comparison
from .comparison_page import write_comparison
from .outputs import write_outputs
from .sentences import summary_rows, verdict

__all__ = [
    "case_differences",
    "comparison",
    "summary_rows",
    "verdict",
    "write_comparison",
    "write_outputs",
]
