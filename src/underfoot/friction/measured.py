"""Measured boundary friction of fluids on one pair, and what can be told of fluids between them."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError, SourcedValue
from underfoot.core.checks import positive

AT_BOUND = 0.01
"""A fitted COF_asymptote below this lies at the bound of the fit (the report's 0.001 for water and
detergent, "not as reliable": G.2.2) and says nothing about the friction that is left."""


@dataclass(frozen=True, slots=True)
class BoundaryFriction:
    """Friction of one fluid on one pair of sole and floor, as measured on a pin.

    Parameters:
        fluid, pair: Names.
        viscosity: Pa s.
        cof_boundary: COF_BL of Eq. 17, 1.
        tau_hydro, cof_asymptote: Of Eq. 17, m/s and 1; None without a fit.
        alpha, beta: Of Eq. 26, N and 1; None when not known.
        load: At which alpha was measured, N.
    """

    fluid: str
    pair: str
    viscosity: float
    cof_boundary: SourcedValue
    tau_hydro: SourcedValue | None = None
    cof_asymptote: SourcedValue | None = None
    alpha: SourcedValue | None = None
    beta: SourcedValue | None = None
    load: SourcedValue | None = None

    def __post_init__(self) -> None:
        positive(self.viscosity, f"{self.fluid}.viscosity", "Pa s")


def friction_left(measured: Sequence[BoundaryFriction]) -> SourcedValue:
    """Return the friction left when adhesion is blocked: the mean COF_asymptote, 1.

    Only fluids whose asymptote was reached count (see ``AT_BOUND``). The uncertainty is the
    largest of theirs, not reduced by averaging: they share sole, floor and device.

    Raises:
        InputError: No fluid with a fitted asymptote.
    """
    asymptotes = [
        m.cof_asymptote
        for m in measured
        if m.cof_asymptote is not None and float(m.cof_asymptote) >= AT_BOUND
    ]
    if not asymptotes:
        raise InputError(
            "no fluid was measured up to its friction at high speed",
            where="cof_hysteresis",
            remedy="Give the hysteresis coefficient of the pair",
        )
    deviations = [a.uncertainty for a in asymptotes if a.uncertainty is not None]
    complete = len(deviations) == len(asymptotes)
    return SourcedValue(
        float(np.mean([a.value for a in asymptotes if a.value is not None])),
        "1",
        source="; ".join(dict.fromkeys(a.source for a in asymptotes)),
        uncertainty=max(deviations) if complete else None,
        reason="" if complete else "a measurement came without one",
        assumed=True,
        note="Friction that stays at high speed, taken as hysteresis",
    )


def viscous_decay(measured: Sequence[BoundaryFriction]) -> SourcedValue:
    """Return viscosity times tau_hydro of Eq. 17, Pa m, the mean of the fitted fluids.

    One constant makes COF a function of viscosity times speed (Fig. 16 of the report). The
    uncertainty is the scatter between the fluids.

    Raises:
        InputError: Fewer than two fluids with a fit.
    """
    products = [
        m.viscosity * m.tau_hydro.value
        for m in measured
        if m.tau_hydro is not None and m.tau_hydro.value is not None
    ]
    if len(products) < 2:
        raise InputError(
            f"{len(products)} of the fluids has a fitted decay with speed",
            where="tau_hydro",
            allowed="at least 2 fluids",
        )
    return SourcedValue(
        float(np.mean(products)),
        "Pa*m",
        source="mean over fluids of viscosity x tau_hydro (Eq. 17)",
        uncertainty=float(np.std(products, ddof=1)),
        assumed=True,
        note="One decay constant for all fluids is computed from the published fits, not published",
    )


def boundary_friction_at(
    viscosity: float, measured: Sequence[BoundaryFriction], *, fluid: str = ""
) -> BoundaryFriction:
    """Return an assumed boundary friction for a fluid of which only the viscosity is known.

    COF_BL runs linearly in the logarithm of the viscosity between the measured fluids; below the
    thinnest and above the thickest the nearest one is kept. The uncertainty joins that of the
    fluids used and half of the step between the two nearest fluids, since viscosity is not what
    makes a boundary lubricant: fluids of equal viscosity differ by such steps.

    Parameters:
        viscosity: Pa s.
        measured: At least two fluids on the same pair.
        fluid: Name of the fluid, for reports.

    Raises:
        InputError: Fewer than two fluids, different pairs, a fluid without COF_BL, viscosity not
            positive.
    """
    positive(viscosity, "viscosity", "Pa s")
    if len(measured) < 2 or len({m.pair for m in measured}) != 1:
        raise InputError(
            f"{len(measured)} fluids on {len({m.pair for m in measured})} pairs",
            where="measured",
            allowed="at least 2 fluids on one pair",
        )
    fluids = sorted(measured, key=lambda m: m.viscosity)
    place = int(np.searchsorted([m.viscosity for m in fluids], viscosity))
    low = min(max(place - 1, 0), len(fluids) - 2)
    below, above = fluids[low], fluids[low + 1]
    cofs = [m.cof_boundary.value for m in (below, above)]
    if cofs[0] is None or cofs[1] is None:
        raise InputError("a fluid has no COF_BL", where="measured")
    ratio = math.log(viscosity / below.viscosity) / math.log(above.viscosity / below.viscosity)
    share = min(max(ratio, 0.0), 1.0)
    deviations = [m.cof_boundary.uncertainty for m in (below, above)]
    deviation = None
    if deviations[0] is not None and deviations[1] is not None:
        mixed = math.hypot((1 - share) * deviations[0], share * deviations[1])
        deviation = math.hypot(mixed, 0.5 * (cofs[1] - cofs[0]))
    how = (
        f"{(below if ratio < 0 else above).fluid} kept as the nearest measured fluid"
        if ratio != share
        else f"between {below.fluid} and {above.fluid}, linear in the logarithm of the viscosity"
    )
    name = fluid or f"a fluid of {viscosity * 1e3:.3g} cP"
    return BoundaryFriction(
        fluid=name,
        pair=fluids[0].pair,
        viscosity=viscosity,
        cof_boundary=SourcedValue(
            (1 - share) * cofs[0] + share * cofs[1],
            "1",
            source="; ".join(dict.fromkeys(m.cof_boundary.source for m in (below, above))),
            uncertainty=deviation,
            reason="" if deviation is not None else "a measurement came without one",
            assumed=True,
            note=f"COF_BL of {name} was not measured: {how}",
        ),
    )
