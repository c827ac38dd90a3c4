"""Figures, tables and pages made from results; nothing here computes."""

from __future__ import annotations

from .comparison import comparison
from .outputs import write_outputs
from .sentences import summary_rows, verdict

__all__ = ["comparison", "summary_rows", "verdict", "write_outputs"]
