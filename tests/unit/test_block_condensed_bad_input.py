"""Condensed block: what it refuses and what it says."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.block import (
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroSurface,
    condensed_block,
    condensed_sliding,
)
from underfoot.core import Cancelled, InputError, Status
from underfoot.material import RelaxationSpectrum

ROUGH = MicroSurface.checkerboard(35.1e-6, 0.4e-3)
BLOCK = MicroBlock(
    size=(0.4e-3, 0.4e-3, 0.4e-3), elements=(8, 8, 4), bottom_layer=None, sides="periodic"
)
MATERIAL = MicroMaterial(RelaxationSpectrum(1e6), 500e6)
LOADING = MicroLoading(slide_distance=0.4e-3)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"floor": MicroSurface.checkerboard(35.1e-6, 4e-3)}, "wavelength of 0.004 m on a block"),
        ({"floor": MicroSurface.checkerboard(35.1e-6, 0.1e-3)}, "2 elements a wavelength"),
        ({"floor": MicroSurface.checkerboard(35.1e-6, 0.3e-3)}, "waves between periodic sides"),
        ({"loading": replace(LOADING, speed=0.0)}, "to slide"),
        ({"steps_per_wavelength": 15}, "16 or more"),
        # 16 are enough: it is the speed that is refused then
        ({"steps_per_wavelength": 16, "loading": replace(LOADING, speed=0.0)}, "to slide"),
        (
            {"block": replace(BLOCK, roughness=MicroSurface.checkerboard(0.7e-3, 0.4e-3))},
            "bottom layers",
        ),
    ],
)
def test_bad_input_is_refused_in_words(change, words):
    given = {"block": BLOCK, "floor": ROUGH, "material": MATERIAL, "loading": LOADING}
    extra = {key: change.pop(key) for key in list(change) if key not in given}
    with pytest.raises(InputError, match=words):
        condensed_sliding(*(given | change).values(), **extra)


def test_a_block_of_another_poisson_ratio_is_refused():
    with pytest.raises(InputError, match="condensed for Poisson's ratio 0"):
        condensed_sliding(condensed_block(BLOCK, 0.3), ROUGH, MATERIAL, LOADING)


@pytest.mark.parametrize("nu", [0.5, 0.7, -0.1, np.nan])
def test_incompressible_rubber_has_no_finite_elements(nu):
    with pytest.raises(InputError, match="Poisson's ratio"):
        condensed_block(BLOCK, nu)


def test_cancelling_keeps_what_there_is():
    def stop(stage, fraction, residual=None):
        if stage == "condensed block" and fraction > 0.5:
            raise Cancelled("stop")

    found = condensed_sliding(BLOCK, ROUGH, MATERIAL, LOADING, progress=stop)
    assert found.status is Status.CANCELLED
    assert found.averages is None
    assert 0 < found.time.size < 88


def test_rubber_without_loss_is_named():
    found = condensed_sliding(BLOCK, ROUGH, MATERIAL, LOADING)
    assert any("no hysteresis friction" in note for note in found.notes)
    assert np.all(found.normal_force > 0.0)
    assert np.all(np.diff(found.time) > 0.0)


def test_spots_of_a_node_are_not_given_a_corrected_area():
    hard = MicroMaterial(RelaxationSpectrum(30e6), 15e9)
    found = condensed_sliding(BLOCK, ROUGH, hard, LOADING)
    assert found.averages is not None
    assert np.isnan(found.averages.area_per_force_corrected)
    assert found.averages.area_per_force > 0.0
    assert any("node or two" in note for note in found.notes)
