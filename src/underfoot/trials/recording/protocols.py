"""Protocols as data: how numbers are taken, and which rules every trial has to keep."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

from underfoot.core import InputError, content_hash, to_si, unknown_name
from underfoot.core.catalogue import Catalogue, Entry, Leaf
from underfoot.core.remark import Amount, Message

KINDS = {
    "pin_on_disk": "pin on disk, COF against speed",
    "boundary": "pin on disk, boundary lubrication",
    "slip_tester": "slip tester",
    "human_slip": "human slips",
    "gait": "walking",
    "relaxation": "compression relaxation",
    "readings": "readings of a machine",
}
# What rules can be about, with the SI unit.
QUANTITIES = {
    "normal_force": "N", "sliding_speed": "m/s", "static_contact_time": "s", "force_rate": "Hz",
    "marker_rate": "Hz", "duration": "s", "baseline_samples": "1", "hold_time": "s",
    "compression": "1", "repeats": "1",
}  # fmt: skip
SEVERITIES = ("refuse", "caution")


@dataclass(frozen=True, slots=True)
class Rule:
    """A measured quantity has to lie between ``low`` and ``high`` (SI; None: no limit)."""

    quantity: str
    low: float | None
    high: float | None
    severity: str
    source: str
    verified: bool
    assumed: bool
    note: str = ""

    def statement(self) -> Message:
        """Return the rule in words."""
        name, unit = self.quantity.replace("_", " "), QUANTITIES[self.quantity]
        if self.low is None:
            assert self.high is not None  # a rule has a limit
            high = Amount(self.high, unit)
            return Message("{quantity} at most {high}", quantity=name, high=high)
        low = Amount(self.low, unit)
        if self.high is None:
            return Message("{quantity} at least {low}", quantity=name, low=low)
        high = Amount(self.high, unit)
        return Message("{quantity} from {low} to {high}", quantity=name, low=low, high=high)

    def broken_by(self, value: float) -> Message:
        """Return why ``value`` breaks the rule, or nothing."""
        slack = 1e-6 * abs(value)
        below = self.low is not None and value < self.low - slack
        above = self.high is not None and value > self.high + slack
        if not (below or above):
            return Message("")
        return Message(
            "{quantity} {value}; rule: {rule}",
            quantity=self.quantity.replace("_", " "),
            value=Amount(value, QUANTITIES[self.quantity]), rule=self.statement(),
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Protocol:
    """One protocol; ``method`` holds its settings as written."""

    name: str
    title: str
    kind: str
    source: str
    note: str
    method: Mapping[str, Leaf]
    rules: tuple[Rule, ...]

    @property
    def where(self) -> Message:
        """The protocol as the place of an error."""
        return Message("protocol {protocol}", protocol=self.name)

    def number(self, key: str, unit: str, default: float | None = None) -> float:
        """Return a setting in SI, or ``default`` when the protocol does not say."""
        if key not in self.method:
            if default is None:
                raise unknown_name("setting", key, self.method, where=self.where)
            return default
        return to_si(self.method[key].given, unit, where=f"protocol.{self.name}.method.{key}")

    def text(self, key: str, default: str = "") -> str:
        """Return a setting that is a word."""
        return str(self.method[key].given) if key in self.method else default

    def texts(self, key: str) -> tuple[str, ...]:
        """Return a setting that is a word or a list of words."""
        if key not in self.method:
            return ()
        given = self.method[key].given
        return tuple(str(item) for item in (given if isinstance(given, list | tuple) else [given]))

    def with_settings(self, settings: Mapping[str, object]) -> Self:
        """Return the protocol with settings of its method replaced."""
        changed = {key: Leaf(value, source="command line") for key, value in settings.items()}
        return replace(self, method={**self.method, **changed})

    @property
    def key(self) -> str:
        """Return a hash of all that decides the numbers."""
        return content_hash(
            self.kind,
            [[name, str(leaf.given)] for name, leaf in sorted(self.method.items())],
            [[r.quantity, r.low, r.high, r.severity] for r in self.rules],
        )

    def standing(self) -> list[Message]:
        """Return what the source does not stand behind: not verified, or assumed; a sentence each.

        Values with a source of their own are verified against it, and it is named.
        """
        settings = [(name.replace("_", " "), leaf) for name, leaf in self.method.items()]
        settings += [(rule.quantity.replace("_", " "), rule) for rule in self.rules]
        memory = [name for name, one in settings if not one.verified]
        assumed = [
            Message("{name} ({note})", name=name, note=one.note) if one.note else name
            for name, one in settings
            if one.assumed
        ]
        read: dict[str, list[str]] = {}
        for name, one in settings:
            if one.verified and not one.assumed and one.source not in ("", self.source):
                read.setdefault(one.source, []).append(name)
        found = [
            Message("{names}: {source}.", names=names, source=source)
            for source, names in read.items()
        ]
        if memory:
            found.append(
                Message(
                    "Not verified against the text of {source}, which was not at hand: {names}.",
                    source=self.source, names=dict.fromkeys(memory),
                )
            )  # fmt: skip
        if assumed:
            found.append(Message("Assumed: {settings:; }.", settings=assumed))
        return found


def protocol(name: str, folders: Iterable[Path | str] = ()) -> Protocol:
    """Return a protocol of the catalogue (built in, or from a user's folders).

    InputError: unknown name (with the nearest one), kind, quantity or severity; a limit without
    unit.
    """
    catalogue = Catalogue.load(folders)
    return _from_entry(catalogue.entry("protocol", name, where="--protocol"))


def protocol_names(folders: Iterable[Path | str] = ()) -> dict[str, str]:
    """Return all protocols as name and title."""
    catalogue = Catalogue.load(folders)
    return {name: catalogue.entry("protocol", name).title for name in catalogue.names("protocol")}


def _from_entry(entry: Entry) -> Protocol:
    kind_leaf = entry.leaf("kind")
    kind = str(kind_leaf.given)
    if kind not in KINDS:
        raise unknown_name("kind of protocol", kind, KINDS, where=f"protocol.{entry.name}.kind")
    grouped: dict[str, dict[str, Leaf]] = {}
    for path, leaf in entry.under("rules").items():
        quantity, _, key = path.partition(".")
        grouped.setdefault(quantity, {})[key] = leaf
    rules = tuple(_rule(entry.name, quantity, parts) for quantity, parts in grouped.items())
    return Protocol(
        entry.name, entry.title, kind, kind_leaf.source, entry.note, entry.under("method"), rules
    )


def _rule(name: str, quantity: str, parts: Mapping[str, Leaf]) -> Rule:
    where = f"protocol.{name}.rules.{quantity}"
    if quantity not in QUANTITIES:
        raise unknown_name("quantity", quantity, QUANTITIES, where=where)
    for key in parts:
        if key not in ("low", "high", "severity"):
            raise unknown_name("key", key, ("low", "high", "severity"), where=where)
    unit = QUANTITIES[quantity]
    some = {key: parts[key] for key in ("low", "high") if key in parts}
    limits = {key: to_si(leaf.given, unit, where=f"{where}.{key}") for key, leaf in some.items()}
    if not limits:
        raise InputError("the rule has no limit", where=where, allowed="low, high or both")
    severity = str(parts["severity"].given) if "severity" in parts else "caution"
    if severity not in SEVERITIES:
        raise unknown_name("severity", severity, SEVERITIES, where=where)
    leaf, verified = next(iter(some.values())), all(leaf.verified for leaf in some.values())
    assumed = any(leaf.assumed for leaf in some.values())
    ends = limits.get("low"), limits.get("high")
    return Rule(quantity, *ends, severity, leaf.source, verified, assumed, leaf.note)
