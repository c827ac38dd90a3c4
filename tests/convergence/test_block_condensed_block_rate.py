"""Condensed block: contact area and hysteresis as the mesh is refined."""

import numpy as np
import pytest

from underfoot.block import MicroBlock, MicroSurface, condensed_block, edge_corrected_contact_area
from underfoot.block._kernels.active_set import contact_under_load
from underfoot.rough_contact import steady_sliding
from underfoot.surface import checkerboard

WAVE, RZ, YOUNG, NU = 0.4e-3, 35e-6, 3e6, 0.499


def contact_fractions(n):
    """Nodal and edge-corrected contact fraction, mean over positions of the floor."""
    block = MicroBlock(
        size=(WAVE, WAVE, 0.5e-3), elements=(n, n, 9), bottom_layer=WAVE / n, sides="periodic"
    )
    condensed = condensed_block(block, NU)
    compliance = condensed.unit_compliance * 2.0 * (1.0 + NU) / YOUNG
    found = []
    for shift in WAVE / n * np.array([(0.1, 0.1), (0.35, 0.6), (0.6, 0.35), (0.85, 0.85)]):
        floor = MicroSurface.checkerboard(RZ, WAVE, offset=tuple(shift))
        height = floor.height(condensed.points[:, 0], condensed.points[:, 1])
        state = contact_under_load(
            compliance, condensed.points[:, 2] - height, 160e3 * WAVE**2, np.zeros(n * n, bool)
        )
        touching = state.force > 0.0
        found.append((touching.mean(), edge_corrected_contact_area(condensed, touching) / WAVE**2))
    return np.mean(found, axis=0)


def test_nodal_area_converges_at_first_order_and_its_edges_explain_most():
    floor = checkerboard(128, WAVE / 128, RZ, WAVE)
    exact = steady_sliding(
        floor.heights, floor.spacing, YOUNG, 0.0, 160e3, NU
    ).real_contact_fraction_corrected
    coarse, fine = contact_fractions(9), contact_fractions(18)
    order = np.log2((coarse[0] - exact) / (fine[0] - exact))
    assert 0.7 < order < 1.5
    assert fine[0] > exact
    assert fine[1] == pytest.approx(exact, rel=0.05)
