"""One case of a study: what is to be computed, and what came of it, each as one line of text."""

from __future__ import annotations

import base64
import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields
from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.core import SourcedValue, content_hash
from underfoot.core.arrays import Array
from underfoot.core.fields import Fields
from underfoot.core.identity import files_hash, program_hash

from .lines import FORMAT


@cache
def program() -> str:
    """Return a hash of what computes records: the program and this package."""
    return content_hash(program_hash(), files_hash((str(Path(__file__).parent),)))[:16]


class Ending(StrEnum):
    """How a case of a study ended. All but COMPUTED have no numbers, but a reason."""

    OPEN = "open"
    COMPUTED = "computed"
    NOT_CONVERGED = "not converged"
    INFEASIBLE = "infeasible"
    CRASHED = "crashed"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class CaseJob:
    """A case that is to be computed: the changes of the base case, by dotted path.

    Attributes:
        key: Hash of what decides the numbers; equal keys are computed once.
        design, condition, draw: Which design, in which condition, with which of the common draws.
        batch: Designs of one batch are proposed together; the next needs all their records.
        point: Place of the design in the unit cube of what is varied.
        quick: On the coarse grid.
        fields: Keep the maps too.
    """

    key: str
    design: int
    condition: int
    draw: int
    batch: int
    point: tuple[float, ...]
    changes: Mapping[str, Any]
    quick: bool = True
    fields: bool = False

    def line(self) -> str:
        """Return the job as a line of JSON."""
        return json.dumps({"format": FORMAT, **asdict(self)}, ensure_ascii=False)

    @classmethod
    def from_line(cls, text: str | bytes) -> CaseJob:
        """Return the job of a line."""
        plain = json.loads(text)
        return cls(**{**_known_fields(cls, plain), "point": tuple(plain["point"])})


@dataclass(frozen=True, slots=True)
class Record:
    """What came of a case.

    Attributes:
        key: Of its job.
        ending, reason: How it ended, and why it has no numbers.
        numbers: Name of a scalar: its value in SI; None where it was not determined.
        spreads: Name of a scalar: its standard deviation, where it was estimated.
        errors: The part of it that is the run's own: grid, steps, positions of the tread.
        units: Name of a scalar: its SI unit.
        law: Friction law; draws of COF of one law are shared between cases.
        draws: (n,) joint draws of COF, empty where the law has no spread.
        breaches: Inputs outside a tested range, in words.
        seconds, cpu_seconds: That the case took, as the wall clock and as the processor counts.
        memory: Most that its worker had up to then, bytes; 0 where the system doesn't tell.
        program: Hash of the package's text, so that numbers of two versions are not mixed unseen.
        worker: Process that computed it.
        ended: When, s since 1970.
        maps: Fields on the sole; never in the line, but in the study's ``fields.zarr``.
    """

    key: str
    ending: Ending
    reason: str = ""
    numbers: Mapping[str, float | None] = field(default_factory=dict)
    spreads: Mapping[str, float] = field(default_factory=dict)
    errors: Mapping[str, float] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    law: str = ""
    draws: Array = field(default_factory=lambda: np.empty(0))
    breaches: tuple[str, ...] = ()
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    memory: float = 0.0
    program: str = ""
    worker: str = ""
    ended: float = 0.0
    maps: Fields | None = field(default=None, compare=False)

    @property
    def usable(self) -> bool:
        """Whether there are numbers."""
        return self.ending is Ending.COMPUTED

    def number(self, name: str) -> float:
        """Return a number in SI, nan where there is none."""
        value = self.numbers.get(name)
        return float("nan") if value is None else value

    def sourced_value(self, name: str) -> SourcedValue:
        """Return a number with its standard deviation."""
        return SourcedValue(
            self.numbers.get(name),
            self.units.get(name, "1"),
            "design study",
            self.spreads.get(name),
            reason=self.reason,
        )

    def line(self, place: tuple[int, int, int]) -> str:
        """Return the record as a line of JSON.

        Its draws are binary (float32): ``place`` is their first byte in the file of draws beside,
        their number and the CRC-32 of their bytes.
        """
        plain = {one.name: getattr(self, one.name) for one in fields(self) if one.name != "maps"}
        del plain["draws"]
        plain |= {"breaches": list(self.breaches), "draws": place}
        return json.dumps({"format": FORMAT, **plain}, ensure_ascii=False, allow_nan=False)

    @property
    def packed_draws(self) -> bytes:
        """The draws as float32."""
        return np.asarray(self.draws, "<f4").tobytes()

    @classmethod
    def from_line(cls, text: str | bytes, draws: Callable[[int, int, int], bytes]) -> Record:
        """Return the record of a line; ``draws`` reads the bytes of a place.

        Lines of version 1 have them in base64.
        """
        plain = json.loads(text)
        one = plain["draws"]
        packed = base64.b64decode(one) if plain["format"] == 1 else draws(*one)
        plain |= {"draws": np.frombuffer(packed, "<f4").astype(float)}
        plain |= {"ending": Ending(plain["ending"]), "breaches": tuple(plain["breaches"])}
        return cls(**_known_fields(cls, plain))


def draws_place(line: bytes) -> tuple[int, int, int]:
    """Return where the draws of a line are: first byte, number, check sum. Not of version 1."""
    first, count, check = line[line.rindex(b"[") + 1 : -2].split(b",")
    return int(first), int(count), int(check)


def _known_fields(kind: Any, plain: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a class has a field for: a later program of this format may have written more."""
    return {one.name: plain[one.name] for one in fields(kind) if one.name in plain}
