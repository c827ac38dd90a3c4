"""A law for any compound, floor and fluid of the catalogue, or a refusal that says what to do."""

from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.resolve import resolved
from underfoot.core import InputError
from underfoot.core.catalogue import Catalogue

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"
BASE = Case.load(EXAMPLE)
KNOWN = Catalogue.load()
WITHOUT_ROUGHNESS = {"ceramic_low_g1", "ceramic_medium_g1", "ceramic_high_g1"}
"""Floors of which the report prints neither Rq nor Ra: one law needs the floor's own."""
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


@pytest.mark.parametrize("law", ["stribeck", "asperity_ehl", "boundary", "mean_film_sharing"])
@pytest.mark.parametrize(("section", "name"), CHOICES, ids=lambda value: str(value))
def test_every_entry_gives_a_law_or_a_remedy(section, name, law):
    settings = {section: name, "models.friction": law}
    case = BASE.replace(settings)
    if name in WITHOUT_ROUGHNESS and law == "mean_film_sharing":
        with pytest.raises(InputError, match="own roughness is not given"):
            case.friction.build(resolved(case))
        return
    found = case.friction.build(resolved(case))
    speed = np.array([0.0, 0.05, 0.3, 1.0])
    parts = found(np.full(4, 2e5), speed, np.full(4, 1.0))
    solid = (parts.adhesion + parts.hysteresis) / 2e5
    assert np.isfinite(solid).all()
    assert ((solid >= 0) & (solid < 1.5)).all()
    assert (np.diff(solid) <= 1e-12).all()
    assert found.source
    assert found.assumptions
