"""What options of a case are built of: rates, moduli, paths, patches, values that are left out."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.case.contact import PerssonContact, _passing
from underfoot.case.parts import fields, keys, paths
from underfoot.compute.resolve import resolve_context
from underfoot.core import InputError

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"
PATCH = {"shoe.wear.mode": "patch", "shoe.wear.depth": "1 mm", "shoe.wear.patch_length": "20 mm",
         "shoe.wear.patch_width": "20 mm"}  # fmt: skip


@pytest.fixture(scope="module")
def case():
    return Case.load(EXAMPLE)


def test_every_section_around_a_value_has_a_path():
    known = set(paths())
    for path in {*fields(), *keys()}:
        parents = path.split(".")[:-1]
        assert {".".join(parents[: k + 1]) for k in range(len(parents))} <= known, path


@pytest.mark.parametrize("speed", [0.5, -0.25])
def test_a_theory_takes_the_modulus_at_the_rate_of_the_longest_wave_and_the_whole_roughness(speed):
    told = {}

    def modulus(rate):
        told["rate"] = rate
        return 3e6 + 4e6j

    wave, rq = 0.1e-3, 4e-6
    smooth = SimpleNamespace(file=None)
    context = SimpleNamespace(
        interface=SimpleNamespace(longest_wave=wave, hurst=0.8), rq_value=rq, poisson_ratio=0.5,
        shoe=SimpleNamespace(roughness=smooth), floor=SimpleNamespace(roughness=smooth),
        motion=SimpleNamespace(speed=speed),
        rubber=lambda: SimpleNamespace(complex_modulus=modulus),
    )  # fmt: skip
    option: Any = SimpleNamespace(_law=lambda *given: given)
    q, density, magnitude, _ = cast(Any, PerssonContact.build(option, cast(Any, context)))
    assert told["rate"] == pytest.approx(2 * math.pi * abs(speed) / wave)
    assert magnitude == pytest.approx(5e6)
    assert 2 * math.pi * np.trapezoid(q * density, q) == pytest.approx(rq**2)
    assert np.polyfit(np.log(q), np.log(density), 1)[0] == pytest.approx(-3.6)


def test_fluid_passes_freely_far_from_a_rough_wall_and_is_held_near_it():
    q = np.geomspace(1e4, 1e6, 200)
    share = _passing(q, 1e-24 * (q / q[0]) ** -3.6)(np.geomspace(1e-9, 1e-3, 30))
    assert share[-1] == pytest.approx(1.0, abs=1e-3)
    assert share[0] < 0.5 * share[-1]
    assert ((share >= 0) & (share <= 1)).all()
    assert (np.diff(share) >= -1e-12).all()


def test_the_film_of_a_pin_has_twice_the_plane_strain_modulus_of_its_rubber(case):
    """E' of Eq. 18 is 2 E*, E* = E / (1 - nu^2) against a rigid floor."""
    chosen = case.replace({"friction.model": "mean_film_sharing", "floor.roughness.rq": "3 um"})
    context = resolve_context(chosen)
    effect = chosen.friction.build(context).effect
    star = context.youngs_modulus / (1 - context.poisson_ratio**2)
    assert effect.effective_modulus == pytest.approx(2 * star)
    assert effect.stiffness == pytest.approx(star)
    assert effect.rq == pytest.approx(3e-6)


def test_what_a_new_option_does_not_take_goes_and_what_is_set_must_be_taken(case):
    worn = case.replace(PATCH)
    assert worn.value("shoe.wear.patch_length") == 0.02
    plane = worn.replace("shoe.wear.mode", "plane")
    assert plane.value("shoe.wear.depth") == 1e-3
    left = [line.split(" ")[0] for line in plane.changes]
    assert sorted(left) == ["shoe.wear.patch_length", "shoe.wear.patch_width"]
    with pytest.raises(InputError, match="patch_length"):
        plane.replace("shoe.wear.patch_length", "20 mm")


@pytest.mark.parametrize(("depth", "fits"), [("1 mm", False), ("0 mm", True)])
def test_a_patch_larger_than_the_shoe_is_refused_where_anything_is_worn(case, depth, fits):
    wide = {**PATCH, "shoe.wear.depth": depth, "shoe.wear.patch_width": "150 mm"}
    if fits:
        assert case.replace(wide).value("shoe.wear.depth") == 0.0
    else:
        with pytest.raises(InputError, match="larger than the shoe"):
            case.replace(wide)
