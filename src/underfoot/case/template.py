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
    lines = [_HEAD.format(title=title, file=file)]
    lines.append(f"file_version = {FILE_VERSION}")
    lines.append(f"name = {_text(title)}")
    lines.append(f"description = {_text(description)}\n")
    for section, entry in chosen.items():
        lines.append(f"[{section}]")
        kind, _ = CATALOGUE_SECTIONS[section]
        note = f"# {titles[section]}; others: underfoot catalogue {kind}"
        lines.append(_commented(f'from = "{entry}"', note))
        if entry != DRY or section != "contaminant":
            lines += _overrides(section, entry, catalogue)
        lines.append("")
    if contaminant == DRY:
        lines += ["[friction]", 'model = "constant"']
        lines += ["cof = 0.8  # measured on this shoe and floor, dry: set your own", ""]
    else:
        lines += ["[friction]"]
        about = "# of compound, roughness and fluid; others: underfoot explain friction.model"
        lines += [_commented('# model = "pair"', about), "", "[interface]"]
        about = "# interface against both stylus Rq together; assumed, uncertain: vary it"
        lines += [_commented("# roughness_beyond_cutoff = 2.0", about), ""]
    lines += ["[risk]"]
    lines += ["# rcof_mean = 0.20  # friction that the people who walk there need, and its"]
    lines += ["# rcof_sd = 0.03    # standard deviation between them"]
    return "\n".join(lines) + "\n"


def _overrides(section: str, name: str, catalogue: Catalogue) -> list[str]:
    kind, part = CATALOGUE_SECTIONS[section]
    entry = catalogue.entry(kind, name)
    values = entry.under(part) if part else entry.values
    lines = []
    for path, leaf in values.items():
        full = f"{section}.{path}"
        full = RENAMED.get(full) or SHORT.get(full) or full
        if not full.startswith(f"{section}.") or isinstance(leaf.given, list):
            continue
        remark = _remark(field_at(full), assumed=leaf.assumed)
        path = full.removeprefix(f"{section}.")
        lines.append(_commented(f"# {path} = {_text(leaf.given)}", remark))
    return lines


def _remark(field: FieldInfo | None, *, assumed: bool) -> str:
    parts = [(field.description or "") if field else "", "assumed" if assumed else ""]
    text = "; ".join(part for part in parts if part)
    return f"# {text}" if text else ""


def _commented(line: str, remark: str) -> str:
    return f"{line:{_COLUMN}} {remark}".rstrip()


def _text(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return str(value)
    escaped = str(value).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
