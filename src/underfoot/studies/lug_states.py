"""Two states under a lug: the dewetting stress, fitted to two sources and scored on all others.

python -m underfoot.studies.lug_states
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from underfoot.case import Case
from underfoot.compute.contact_friction import contact_friction
from underfoot.compute.prepare import Prepared, prepare_case
from underfoot.compute.solve import solve_case
from underfoot.core.arrays import Array
from underfoot.friction.tread_error import PRIOR, TreadPair, log_posterior
from underfoot.sole_contact.lug_edges import EdgedLaw
from underfoot.sole_contact.solver import SoleContact

from .tread_pairs import FITTED, computed_pairs

STRESSES = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0)
"""S, Pa; at 0 lugs are in one mean state."""


@dataclass(frozen=True, slots=True)
class StatesScore:
    """How well one S foresees treads: ln p of the fitted sources, of all others, and of those of
    them in thin fluids.
    """

    stress: float
    fitted: float
    left_out: float
    left_out_thin: float
    pairs: tuple[TreadPair, ...]


def states_scores(stresses: Sequence[float] = STRESSES) -> list[StatesScore]:
    """Return the score of each S over the published treads, every case solved once as drawn."""
    solutions: dict[str, tuple[Prepared, SoleContact]] = {}

    def cof_at(case: Case, stress: float) -> Array:
        if case.hash not in solutions:
            single = case.replace("numerics.tread_positions", 1)
            parts = prepare_case(single, case.numerics.quick_grid_spacing, {})
            solutions[case.hash] = parts, solve_case(parts).contact
        parts, contact = solutions[case.hash]
        law = parts.local_law
        if isinstance(law, EdgedLaw):
            law = replace(law, dewetting=stress)
        friction = contact_friction(parts.case, parts.context, law, parts.sole, contact)
        assert friction.sampled is not None
        return np.append(float(friction.sums.cof), friction.sampled.cof)

    scores = []
    for stress in stresses:
        pairs = tuple(computed_pairs(lambda case, at=stress: cof_at(case, at)))
        fitted = [pair for pair in pairs if pair.source in FITTED]
        others = [pair for pair in pairs if pair.source not in FITTED]
        thin = [pair for pair in others if pair.fluid == "thin"]
        evidence = (_evidence(fitted), _evidence(others), _evidence(thin))
        scores.append(StatesScore(stress, *evidence, pairs))
    return scores


def _evidence(pairs: Sequence[TreadPair]) -> float:
    """Return ln p of published pairs over all s: how well a tread model foresees them."""
    total = 0.0
    for fluid, prior in PRIOR.items():
        s, log_density = log_posterior([pair for pair in pairs if pair.fluid == fluid], prior)
        highest = log_density.max()
        of_prior = np.exp(-0.5 * (s / prior) ** 2).sum()
        total += float(highest + np.log(np.exp(log_density - highest).sum() / of_prior))
    return total


if __name__ == "__main__":
    print("S, Pa   ln p: fitted sources   others   of these in thin fluids")
    for score in states_scores():
        left_out = f"{score.left_out:12.2f} {score.left_out_thin:12.2f}"
        print(f"{score.stress:5g} {score.fitted:20.2f} {left_out}")
