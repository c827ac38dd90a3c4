"""The 27 equations of the report: what each says, where it stands, which code computes it."""

import tomllib
from dataclasses import dataclass
from importlib.resources import files


@dataclass(frozen=True, slots=True)
class ReportEquation:
    """One numbered equation of the report.

    ``place`` is its section; ``code`` names what computes it as import paths, the first one being
    what ``explain`` shows; ``note`` says where the program departs from the print.
    """

    place: str
    title: str
    formula: str
    code: tuple[str, ...]
    note: str = ""


_TABLE = files("underfoot.case") / "equations.toml"
EQUATIONS = {
    int(number): ReportEquation(**{**entry, "code": tuple(entry["code"])})
    for number, entry in tomllib.loads(_TABLE.read_text("utf-8")).items()
}
