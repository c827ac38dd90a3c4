"""A law for any compound, floor and fluid of the catalogue, or a refusal that says what to do."""

from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.resolve import resolve_context
from underfoot.core import InputError
from underfoot.core.catalogue import Catalogue

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"
BASE = Case.load(EXAMPLE)
KNOWN = Catalogue.load()
CHOICES = [
    (section, name)
    for section, kind in (
        ("contaminant", "fluid"),
        ("floor", "floor"),
        ("shoe.material", "material"),
    )
    for name in KNOWN.names(kind)
    if name != "dry"
]


def test_a_law_that_needs_the_floor_s_own_roughness_asks_for_it():
    case = Case(
        shoe="work_shoe_untreaded",
        floor={"shore_a": 99, "roughness": {}},
        contaminant="glycerol_90pct",
        motion="slip_tester_g4",
        friction="mean_film_sharing",
    )
    with pytest.raises(InputError, match="own roughness is not given"):
        case.friction.build(resolve_context(case))


@pytest.mark.parametrize("law", ["stribeck", "asperity_ehl", "boundary", "mean_film_sharing"])
def test_every_entry_gives_a_law_or_a_remedy(law):
    for section, name in CHOICES:
        case = BASE.replace({section: name, "models.friction": law})
        found = case.friction.build(resolve_context(case))
        speed = np.array([0.0, 0.05, 0.3, 1.0])
        parts = found(np.full(4, 2e5), speed, np.full(4, 1.0))
        solid = (parts.adhesion + parts.hysteresis) / 2e5
        assert np.isfinite(solid).all(), name
        assert ((solid >= 0) & (solid < 1.5)).all(), name
        assert (np.diff(solid) <= 1e-12).all(), name
        assert found.source, name
        assert found.assumptions, name
