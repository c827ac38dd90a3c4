"""The complete description of one computation: sections and slots, TOML in and out, hash."""

from .case import Case
from .describe import assumptions
from .errors import CaseError
from .free_tread import FreeTread as FreeTread
from .parts import FILE_VERSION, paths, unit_at
from .section import Option, Origin, Section

load = Case.load

__all__ = [
    "FILE_VERSION",
    "Case",
    "CaseError",
    "Option",
    "Origin",
    "Section",
    "assumptions",
    "load",
    "paths",
    "unit_at",
]
