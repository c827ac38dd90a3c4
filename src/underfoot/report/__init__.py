"""Figures, tables and pages made from results; nothing here computes."""

from __future__ import annotations

from .dispatch import figures, page_text, plot, write_report
from .writing import Written

__all__ = ["Written", "figures", "page_text", "plot", "write_report"]
