"""The complete description of one computation: schema, TOML in and out, composition, run."""

from __future__ import annotations

from .case import Case, paths, unit_at
from .describe import assumptions
from .errors import CaseError
from .schema import FILE_VERSION

__all__ = ["FILE_VERSION", "Case", "CaseError", "assumptions", "paths", "unit_at"]
