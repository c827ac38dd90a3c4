"""Doors for other packages: what they offer by entry point, each loaded alone and by its name.

A room of this package that stands above the room that asks enters by a door too.

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
from .remark import Message

PREFIX = "underfoot."
OWN = "underfoot"


@dataclass(frozen=True, slots=True)
class Offer:
    """What a package offers behind a door."""

    door: str
    name: str
    address: str
    package: str

    @property
    def message(self) -> Message:
        """Who offers what, and where it stands."""
        return Message(
            '{door} "{name}" of {package} ({address})',
            door=self.door,
            name=self.name,
            package=self.package,
            address=self.address,
        )

    def __str__(self) -> str:
        return self.message

    def load(self) -> Any:
        """Return what is offered; InputError in one line where it can't be had."""
        try:
            return load_address(self.address)
        except InputError as error:
            remedy = Message("Mend or remove {package}", package=self.package)
            raise InputError(
                Message("{name}: {error}", name=self, error=error.what), remedy=remedy
            ) from error

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
        raise InputError(
            Message("{folder}: there is no such folder", folder=self), allowed="package:folder"
        )


def load_address(address: str) -> Any:
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
            Message(
                '"{address}" can\'t be imported ({reason:.200})', address=address, reason=reason
            ),
            allowed="module:Name of a module on Python's path",
            remedy="Set PYTHONPATH to the folder of the module",
        ) from error


def offers(door: str) -> dict[str, Offer]:
    """Return what other packages offer behind a door, by name; nothing is imported."""
    return {offer.name: offer for offer in all_offers() if offer.door == door}


def find_offer(door: str, name: str, check: Callable[[Any], str] = lambda _item: "") -> Any:
    """Return what is offered by a name; None where nobody does.

    ``check`` says what is wrong with an object, "" for nothing.

    Raises:
        InputError: Two packages offer it, it can't be imported, or ``check`` says so.
    """
    chosen = [offer for offer in all_offers() if (offer.door, offer.name) == (door, name)]
    # our name stays ours
    chosen = [offer for offer in chosen if offer.package == OWN] or chosen
    if len(chosen) > 1:
        raise InputError(
            Message(
                'two packages offer the {door} "{name}": {offers: and }',
                door=door,
                name=name,
                offers=[offer.message for offer in chosen],
            ),
            remedy="Remove one of them",
        )
    for offer in chosen:
        item = offer.load()
        if wrong := check(item):
            raise InputError(
                f"{offer} {wrong}",
                remedy=Message("Mend or remove {package}", package=offer.package),
            )
        return item
    return None


def broken_offers() -> Iterator[str]:
    """Yield a line for each offer that can't be loaded; this imports all but catalogues."""
    for offer in all_offers():
        if offer.door == "catalogues":
            continue
        try:
            find_offer(offer.door, offer.name)
        except InputError as error:
            yield error.what


@cache
def all_offers() -> tuple[Offer, ...]:
    """Return what the packages on Python's path offer; ``all_offers.cache_clear`` looks again."""
    offers = {
        Offer(
            entry.group.removeprefix(PREFIX),
            entry.name,
            entry.value,
            distribution.name or "a package",
        )
        for distribution in metadata.distributions()
        for entry in distribution.entry_points
        if entry.group.startswith(PREFIX)
    }
    return tuple(sorted(offers, key=str))
