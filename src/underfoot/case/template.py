"""A new case file, commented for someone who has never seen one."""

from typing import Any

from pydantic.fields import FieldInfo

from underfoot.core.catalogue import Catalogue

from .compose import DRY
from .parts import CATALOGUE_SECTIONS, FILE_VERSION, field_at
from .versions import RENAMED, SHORT

_COLUMN = 44
_HEAD = """\
# {title}
#
# Read it, print all of it, solve nothing:  underfoot check {file}
# Compute it:                               underfoot run {file}
#
# A number with a unit stands in quotes: "3 mm", "219 cP", "10 deg".
# "from" takes a part from the catalogue; underfoot catalogue lists what there is. A line that
# begins with # is not read: it shows the catalogue's value. Remove the # to set your own.
"""


_DRY_FRICTION = """\
[friction]
model = "constant"
cof = 0.8  # measured on this shoe and floor, dry: set your own
"""
_FRICTION = """\
[friction]
# model = "pair"                             # of compound, roughness and fluid; others: underfoot \
explain friction.model

[interface]
# roughness_beyond_cutoff = 2.0              # interface against both stylus Rq together; assumed, \
uncertain: vary it
"""
_RISK = """
[risk]
# rcof_mean = 0.20  # friction that the people who walk there need, and its
# rcof_sd = 0.03    # standard deviation between them
"""


def template(
    *,
    shoe: str,
    floor: str,
    contaminant: str,
    motion: str,
    catalogue: Catalogue,
    name: str = "",
    description: str = "",
    file: str = "case.toml",
) -> str:
    """Return the text of a new case made of catalogue entries.

    Errors:
        InputError: A name that is not in the catalogue.
    """
    chosen = {"shoe": shoe, "floor": floor, "contaminant": contaminant, "motion": motion}
    titles = {}
    for section, entry in chosen.items():
        kind, _ = CATALOGUE_SECTIONS[section]
        dry = section == "contaminant" and entry == DRY
        titles[section] = "dry" if dry else catalogue.entry(kind, entry, where=section).title
    title = name or f"{titles['shoe']}; {titles['contaminant']}"
    head = {"file_version": FILE_VERSION, "name": title, "description": description}
    lines = [_HEAD.format(title=title, file=f'"{file}"' if " " in file else file)]
    lines += [*(f"{key} = {_text(value)}" for key, value in head.items()), ""]
    for section, entry in chosen.items():
        lines.append(f"[{section}]")
        kind, _ = CATALOGUE_SECTIONS[section]
        note = f"# {titles[section]}; others: underfoot catalogue {kind}"
        lines.append(_line_with_remark(f'from = "{entry}"', note))
        if entry != DRY or section != "contaminant":
            lines += _overrides(section, entry, catalogue)
        lines.append("")
    lines.append(_DRY_FRICTION if contaminant == DRY else _FRICTION)
    return "\n".join(lines) + _RISK


def _overrides(section: str, name: str, catalogue: Catalogue) -> list[str]:
    kind, part = CATALOGUE_SECTIONS[section]
    entry = catalogue.entry(kind, name)
    values = entry.under(part) if part else entry.values
    lines = []
    for path, leaf in values.items():
        full = f"{section}.{path}"
        full = RENAMED.get(full) or SHORT.get(full) or full
        if not full.startswith(f"{section}.") or isinstance(leaf.given, list | tuple):
            continue
        remark = _remark(field_at(full), assumed=leaf.assumed)
        path = full.removeprefix(f"{section}.")
        lines.append(_line_with_remark(f"# {path} = {_text(leaf.given)}", remark))
    return lines


def _remark(field: FieldInfo | None, *, assumed: bool) -> str:
    described = field.description if field else ""
    text = "; ".join(filter(None, (described, "assumed" if assumed else "")))
    return f"# {text}" if text else ""


def _line_with_remark(line: str, remark: str) -> str:
    return f"{line:{_COLUMN}} {remark}".rstrip()


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return str(value)
    escaped = str(value).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
