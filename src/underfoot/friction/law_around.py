"""A friction law that is another one with something changed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from underfoot.core import Breach, SourcedValue
from underfoot.core.remark import Message

from .law import FrictionLaw


@dataclass(frozen=True, slots=True)
class LawAround:
    """Everything of ``law`` but what a class derived from this one says: its call and ``at``."""

    law: FrictionLaw

    def __getattr__(self, name: str) -> Any:
        return getattr(self.law, name)

    @property
    def name(self) -> str:
        """Name of the law."""
        return self.law.name

    @property
    def source(self) -> str:
        """Source of the law."""
        return self.law.source

    @property
    def assumptions(self) -> tuple[Message, ...]:
        """Assumptions behind the law."""
        return self.law.assumptions

    @property
    def inputs(self) -> Mapping[str, SourcedValue]:
        """Inputs of the law, with their standard deviations."""
        return self.law.inputs

    @property
    def error_of_model(self) -> float | None:
        """Error of the law itself, relative; None where it is not known."""
        return self.law.error_of_model

    def breaches(
        self, *, contact_pressure: ArrayLike, speed: ArrayLike, film_thickness: ArrayLike
    ) -> list[Breach]:
        """Return what leaves the range on which the law was measured.

        Parameters:
            contact_pressure: Of the solid contact, Pa.
            speed: Of sliding, m/s.
            film_thickness: m.
        """
        return self.law.breaches(
            contact_pressure=contact_pressure, speed=speed, film_thickness=film_thickness
        )
