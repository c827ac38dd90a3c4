"""Outsole files: plan form, profile and tread of a sole alone, in the words of a case."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from underfoot.core import InputError

from . import toml
from .build_sole import shape_from
from .errors import CaseError, translated
from .places import Places
from .quantity import DOOR, default
from .sections_base import Length, Section
from .sections_sole import HeelShape
from .sections_tread import Tread

if TYPE_CHECKING:
    from underfoot.outsole.shape import SoleShape


class OutsoleLayer(Section):
    """Thickness of the sole."""

    outsole_thickness: Length = default(25e-3, "25 mm", "assumption", assumed=True)


class OutsoleFile(Section):
    """A sole: sections ``heel``, ``tread`` and ``sole`` as under ``shoe`` in a case."""

    name: str = "outsole"
    description: str = ""
    heel: HeelShape = HeelShape(profile="flat")
    tread: Tread
    sole: OutsoleLayer = OutsoleLayer()

    def shape(self) -> SoleShape:
        """Return the sole as the solver and the exporter take it."""
        _check_plan(self.heel)
        _check_tread(self.tread)
        return shape_from(self.heel, self.tread, self.sole.outsole_thickness)


def read_outsole(path: Path | str, settings: Mapping[str, Any] | None = None) -> OutsoleFile:
    """Return the sole of an outsole file; every value with its unit.

    Errors
    ------
    CaseError
        Everything that is wrong with the file, each with its line.
    """
    path = Path(path)
    text = toml.read(path)
    mapping = toml.parsed(text, str(path))
    for key, value in (settings or {}).items():
        _put(mapping, key, value)
    return outsole_from(mapping, Places(str(path), text, changed=settings or ()))


def outsole_from(mapping: Mapping[str, Any], places: Places | None = None) -> OutsoleFile:
    """Return the sole of nested mappings, numbers as text with units."""
    if "shoe" in mapping:
        raise InputError(
            "this is a case, not an outsole file",
            where=places("shoe") if places else "shoe",
            remedy="Use the file of a sole alone, or give the case to the command as it is.",
        )
    try:
        return OutsoleFile.model_validate(dict(mapping), context=DOOR)
    except ValidationError as error:
        found = translated(error, OutsoleFile, places or Places())
        raise CaseError(found) from None


def _check_plan(heel: HeelShape) -> None:
    for name in ("waist_width", "ball_width") if heel.plan == "sole" else ():
        if getattr(heel, name) is None:
            raise InputError('is missing for a whole sole (plan = "sole")', where=f"heel.{name}")
    needed = {"facet": ("facet_angle", "facet_length"), "rocker": ("rocker_radius", "rocker_start")}
    for name in needed.get(heel.profile, ()):
        if getattr(heel, name) is None:
            raise InputError(f'is missing for the profile "{heel.profile}"', where=f"heel.{name}")


def _check_tread(tread: Tread) -> None:
    for name in ("depth", "lug_width", "channel_width") if tread.pattern != "none" else ():
        if not getattr(tread, name):
            raise InputError(
                f'is missing for the pattern "{tread.pattern}"',
                where=f"tread.{name}",
                allowed="a length above 0, as 2.4 mm",
            )


def _put(mapping: Any, key: str, value: Any) -> None:
    *parents, last = key.split(".")
    for parent in parents:
        mapping = mapping.setdefault(parent, {})
    mapping[last] = value
