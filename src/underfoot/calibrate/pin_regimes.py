"""Lubrication regimes of a pair and fluid on the report's pin, by lambda and by load share."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .stribeck_points import pin_on_disk

if TYPE_CHECKING:
    from underfoot.case import Case


@dataclass(frozen=True, slots=True, eq=False)
class PinRegimes:
    """Both readings of the regime at each speed, arrays (n,).

    ``lambda_ratio``: thinnest film of a smooth pin over the Rq of sole and floor (Eq. 18, 21);
    ``fluid_share``: of the load, at the central film beside the interface's asperities. ``why``
    says why the two differ where they do; empty where they agree at every speed.
    """

    speed: np.ndarray
    lambda_ratio: np.ndarray
    fluid_share: np.ndarray
    by_lambda: tuple[str, ...]
    by_load_share: tuple[str, ...]
    why: str

    def row(self, index: int) -> dict[str, Any]:
        """Return the columns of one speed."""
        return {
            "lambda_ratio": float(self.lambda_ratio[index]),
            "regime_by_lambda": self.by_lambda[index],
            "fluid_load_share": float(self.fluid_share[index]),
            "regime_by_load_share": self.by_load_share[index],
        }

    def sentences(self) -> tuple[str, str]:
        """Return over which speeds each regime holds, by lambda and by load share."""
        return (
            f"By lambda: {_spans(self.speed, self.by_lambda)}.",
            f"By load share: {_spans(self.speed, self.by_load_share)}.",
        )


def pin_regimes(
    case: Case, viscosity: float, speed: np.ndarray, pressure: float
) -> PinRegimes | None:
    """Return the regimes of the case's pair under a pin like that of G.2 at ``pressure`` (Pa).

    The pin has the report's reduced radius and face; its load is pressure times face. Film of
    Eq. 18 with half the sliding speed. None where the stylus Rq of neither surface is known.
    """
    from underfoot.compute.resolve import resolve_context
    from underfoot.film import (
        compare_regimes,
        effective_modulus,
        fluid_load_share,
        lambda_ratio,
        soft_ehl,
    )

    pin = pin_on_disk(case.catalogue)
    rough = [r.rq_or_estimate for r in (case.shoe.roughness, case.floor.roughness)]
    if rough[0] is None and rough[1] is None:
        return None
    context = resolve_context(case)
    film = soft_ehl(
        viscosity=viscosity,
        speed=speed,
        load=pressure * pin.normal_force / pin.pressure,
        radius=pin.radius,
        effective_modulus=effective_modulus(context.youngs_modulus, context.poisson_ratio),
    )
    ratio = lambda_ratio(film.minimum, rough[0] or 0.0, rough[1] or 0.0)
    share = fluid_load_share(film.central, case.rough_contact.build(context), pressure)
    both = [compare_regimes(float(r), float(s)) for r, s in zip(ratio, share, strict=True)]
    apart = next((comparison.why for comparison in both if not comparison.agree), "")
    return PinRegimes(
        speed=speed,
        lambda_ratio=ratio,
        fluid_share=share,
        by_lambda=tuple(str(comparison.by_lambda) for comparison in both),
        by_load_share=tuple(str(comparison.by_load_share) for comparison in both),
        why=apart,
    )


def _spans(speed: np.ndarray, names: Sequence[str]) -> str:
    """Return names in order with the speeds between which each holds."""
    changes = [i for i in range(1, len(names)) if names[i] != names[i - 1]]
    if not changes:
        return f"{names[0]} at every speed"
    words = []
    for start, end in zip([0, *changes], [*changes, None], strict=True):
        if end is None:
            words.append(f"{names[start]} above")
        else:
            limit = math.sqrt(speed[end - 1] * speed[end])
            words.append(f"{names[start]} up to {limit:.2g} m/s")
    return ", ".join(words)
