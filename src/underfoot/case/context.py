"""What the options of a case are built from: its sections and what was resolved from them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from underfoot.core import Breach, Progress, SourcedValue, silent
from underfoot.core.catalogue import Catalogue

from .contaminant import ContaminantSection
from .motion import Motion
from .shoe import Shoe
from .surfaces import Floor, Interface

if TYPE_CHECKING:
    from underfoot.material import Elastomer
    from underfoot.rough_contact import ContactTable


@dataclass(frozen=True, slots=True)
class Context:
    """Materials and roughness of a case, each resolved once.

    Attributes:
        modulus: Young's modulus of the outsole, Pa; ``modulus_breaches`` says what it leaves.
        viscosity: Of the contaminant, Pa s; None on a dry floor.
        rq: Rq of the interface, m; ``rq_deviation`` is its standard deviation over itself.
        leak_deviation: Standard deviation of ln of the Rq that lets fluid leak, 1.
        fluid: Name of the contaminant.
        catalogue: Entries of the kinds that the options of the case name in ``consults``.
        rough_contact: Returns the rough contact that friction shares, from a context; or None.
    """

    shoe: Shoe
    floor: Floor
    contaminant: ContaminantSection | None
    motion: Motion
    interface: Interface
    modulus: SourcedValue
    modulus_breaches: tuple[Breach, ...]
    viscosity: SourcedValue | None
    rq: SourcedValue
    rq_deviation: float | None
    leak_deviation: float
    fluid: str
    catalogue: Catalogue
    progress: Progress = silent
    rough_contact: Callable[[Context], ContactTable | None] = lambda _: None

    @property
    def youngs_modulus(self) -> float:
        """Young's modulus of the outsole, Pa."""
        assert self.modulus.value is not None
        return self.modulus.value

    @property
    def poisson_ratio(self) -> float:
        """Poisson's ratio of the outsole."""
        return self.shoe.material.poisson_ratio

    @property
    def plane_strain_modulus(self) -> float:
        """E / (1 - nu^2), Pa."""
        return self.youngs_modulus / (1 - self.poisson_ratio**2)

    @property
    def rq_value(self) -> float:
        """Rq of the interface, m."""
        assert self.rq.value is not None
        return self.rq.value

    @property
    def viscosity_value(self) -> float | None:
        """Viscosity, Pa s; None on a dry floor."""
        return None if self.viscosity is None else self.viscosity.value

    def rubber(self) -> Elastomer:
        """Return the outsole's compound: its relaxation spectrum where given, else elastic."""
        from underfoot import material

        relaxation = self.shoe.material.relaxation
        if relaxation is None:
            return material.Elastomer(self.youngs_modulus, self.poisson_ratio)
        return material.Elastomer(relaxation.young(self.poisson_ratio), self.poisson_ratio)
