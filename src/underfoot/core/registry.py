"""Doors for other packages: what they offer by entry point, each loaded alone and by its name.

A package offers ``name = "module:attribute"`` in the entry-point group ``underfoot.DOOR``. Nothing
is imported before it is asked for; what can't be loaded is told in one line and touches only who
asked for it. ``docs/extending.md`` says what stands behind each door.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from importlib import import_module, metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from .errors import InputError

PREFIX = "underfoot."
WINGS = {
    ("commands", "app"): "underfoot-app",
    ("commands", "micro"): "underfoot-block",
    ("commands", "material"): "underfoot-trial-analysis",
    ("commands", "study"): "underfoot-design-studies",
    **{
        ("commands", f"trials.{name}"): "underfoot-trial-analysis"
        for name in ("analyse", "bundle", "definitions", "edit", "export", "persons", "plan")
    },
    ("commands", "calibrate.posterior"): "underfoot-design-studies",
    **{("names", name): "underfoot-design-studies" for name in ("Study", "optimise", "sweep")},
    ("reports", "underfoot_design_studies"): "underfoot-design-studies",
    ("tread", "free"): "underfoot-design-studies",
    ("questions", "machine_reading"): "underfoot-places",
    **{
        ("commands", name): "underfoot-places"
        for name in ("calibrate.machine", "choose", "machine", "machines")
    },
    ("friction", "pair_read"): "underfoot-places",
    ("catalogues", "places"): "underfoot-places",
    ("reports", "underfoot_places"): "underfoot-places",
    ("reports", "underfoot_trial_analysis"): "underfoot-trial-analysis",
    ("studies", "g1"): "underfoot-block",
    **{
        ("studies", name): "underfoot-studies"
        for name in ("g2", "g3", "g4", "g5", "g6", "calibration", "corpus")
    },
    ("simulators", "simulate"): "underfoot-simulator",
    ("trial_formats", "readers"): "underfoot-readers",
    ("commands", "export"): "underfoot-readers",
}
"""Package of this project that offers a name."""


@dataclass(frozen=True, slots=True)
class Offer:
    """What a package offers behind a door."""

    door: str
    name: str
    address: str
    package: str

    def __str__(self) -> str:
        return f'{self.door} "{self.name}" of {self.package} ({self.address})'

    def load(self) -> Any:
        """Return what is offered; InputError in one line where it can't be had."""
        try:
            return loaded(self.address)
        except InputError as error:
            remedy = f"Mend or remove {self.package}"
            raise InputError(f"{self}: {error.what}", remedy=remedy) from error

    def folder(self) -> Path:
        """Return the folder ``package:folder`` that an address names, without importing it.

        Raises:
            InputError: No such package or folder.
        """
        package, _, name = self.address.partition(":")
        spec = find_spec(package.partition(".")[0])
        for place in (spec and spec.submodule_search_locations) or ():
            folder = Path(place, *package.split(".")[1:], name)
            if folder.is_dir():
                return folder
        raise InputError(f"{self}: there is no such folder", allowed="package:folder")


def loaded(address: str) -> Any:
    """Return what stands at ``module:attribute``, or a module.

    Raises:
        InputError: It can't be imported, whatever the module raised.
    """
    module, _, name = address.partition(":")
    try:
        return getattr(import_module(module), name) if name else import_module(module)
    except (Exception, SystemExit) as error:  # a package of others may raise anything
        reason = (str(error).strip().splitlines() or [""])[0]
        if not isinstance(error, ImportError):  # of the package itself
            reason = f"{type(error).__name__}: {reason}"
        raise InputError(
            f'"{address}" can\'t be imported ({reason:.200})',
            allowed="module:Name of a module on Python's path",
            remedy="Set PYTHONPATH to the folder of the module",
        ) from error


def offers(door: str) -> dict[str, Offer]:
    """Return what other packages offer behind a door, by name; nothing is imported."""
    return {offer.name: offer for offer in all_offers() if offer.door == door}


def offered(door: str, name: str, check: Callable[[Any], str] = lambda _item: "") -> Any:
    """Return what is offered by a name; None where nobody does, nor a wing of this project.

    ``check`` says what is wrong with an object, "" for nothing.

    Raises:
        InputError: Two packages offer it, it can't be imported, ``check`` says so, or a wing that
            would offer it is not installed.
    """
    chosen = [offer for offer in all_offers() if (offer.door, offer.name) == (door, name)]
    wing = WINGS.get((door, name))
    if wing:  # our name stays ours
        chosen = [offer for offer in chosen if offer.package == wing]
    if len(chosen) > 1:
        raise InputError(
            f'two packages offer the {door} "{name}": ' + " and ".join(map(str, chosen)),
            remedy="Remove one of them",
        )
    for offer in chosen:
        item = offer.load()
        if wrong := check(item):
            raise InputError(f"{offer} {wrong}", remedy=f"Mend or remove {offer.package}")
        return item
    if wing:
        what = f"{name.replace('.', ' ')} comes with the package {wing}"
        raise InputError(what, remedy=_installing(wing))
    return None


def missing_wings() -> dict[str, str]:
    """Return the remedy for each package of this project that is not installed, by its name."""
    present = {offer.package for offer in all_offers()}
    return {wing: _installing(wing) for wing in sorted({*WINGS.values()} - present)}


def _installing(wing: str) -> str:
    folder = wing.partition("-")[2].replace("-", "_")
    return f"pip install {wing} (in the source: ./wings/{folder})"


def broken_offers() -> Iterator[str]:
    """Yield a line for each offer that can't be loaded; this imports all but catalogues."""
    for offer in all_offers():
        if offer.door == "catalogues":
            continue
        try:
            offered(offer.door, offer.name)
        except InputError as error:
            yield error.what


@cache
def all_offers() -> tuple[Offer, ...]:
    """Return what the packages on Python's path offer; ``all_offers.cache_clear`` looks again."""
    offers = {
        Offer(entry.group.removeprefix(PREFIX), entry.name, entry.value, each.name or "a package")
        for each in metadata.distributions()
        for entry in each.entry_points
        if entry.group.startswith(PREFIX)
    }
    return tuple(sorted(offers, key=str))
