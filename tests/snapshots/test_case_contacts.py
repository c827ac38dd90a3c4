"""Tables of contact that a case asks for: spectrum, waves, pressures, modulus, scales."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot import rough_contact
from underfoot.case.contact import (
    ContactTableOption,
    FiniteElementCompliance,
    HalfSpaceCompliance,
    LayeredCompliance,
    NoFilm,
    ReynoldsFilm,
)
from underfoot.material import Elastomer
from underfoot.sole_contact import compliance, finite_element

WAVE, RQ, NU, SPEED = 0.2e-3, 4e-6, 0.48, 0.3
SCAN = {"shoe": lambda q: 1e-20 * q**-1.0, "floor": lambda q: 2e-20 * q**-1.0}


def context(modulus=6e6, relaxation=None, files=("", "")) -> Any:
    """What the options read of a case."""
    shoe, floor = (
        SimpleNamespace(file=file, density=SCAN[name])
        for name, file in zip(("shoe", "floor"), files, strict=True)
    )
    return SimpleNamespace(
        interface=SimpleNamespace(longest_wave=WAVE, hurst=0.7), rq_value=RQ, poisson_ratio=NU,
        youngs_modulus=modulus, motion=SimpleNamespace(speed=SPEED), progress="told",
        shoe=SimpleNamespace(material=SimpleNamespace(relaxation=relaxation), roughness=shoe),
        floor=SimpleNamespace(roughness=floor), rubber=lambda: Elastomer(modulus, NU),
    )  # fmt: skip


@pytest.fixture
def asked(monkeypatch):
    """What a table is computed of; the table tells how it is scaled."""
    told: dict[str, Any] = {}

    def computed(floor, waves, rubber, pressure, speeds, **more):
        told.update(
            floor=floor, waves=waves, rubber=rubber, pressure=pressure, speeds=speeds, **more
        )
        return SimpleNamespace(
            scale_contact=lambda *by: SimpleNamespace(by=by, law=lambda speed: ("law", by, speed)),
            law=lambda speed: ("law", None, speed),
        )

    monkeypatch.setattr(rough_contact, "table_over_scales", computed)
    return told


def option(**more) -> Any:
    given = {"file": None, "sha256": None, **more}
    plain = cast(Any, SimpleNamespace(**given))
    for name in ("build", "table", "_self_affine", "_new_table"):
        setattr(plain, name, getattr(ContactTableOption, name).__get__(plain))
    return plain


def check_spectrum(density, rq):
    low, high = 2 * math.pi / WAVE, 2 * math.pi / 2.5e-6
    q = np.geomspace(low, high, 4000)
    assert math.sqrt(2 * math.pi * np.trapezoid(q * density(q), q)) == pytest.approx(rq, rel=1e-3)
    assert np.polyfit(np.log(q), np.log(density(q)), 1)[0] == pytest.approx(-3.4)


def test_interfaces_of_an_elastic_compound_share_one_table(asked):
    """Of 1 um and 1 MPa: lengths scale by Rq, pressures by Rq times the modulus."""
    law = option().build(context())
    check_spectrum(asked["floor"], 1e-6)
    assert asked["waves"] == (WAVE, 2.5e-6)
    assert asked["rubber"].modulus == 1e6
    assert asked["rubber"].poisson_ratio == asked["poisson_ratio"] == NU
    assert asked["pressure"] == pytest.approx(np.geomspace(1.0, 3e4, 22))
    assert (asked["speeds"], asked["shoe"], asked["progress"]) == ([1.0], None, "told")
    assert "4 um" in asked["description"] or "4 µm" in asked["description"]
    assert law == ("law", (4.0, pytest.approx(4.0 * 6.0), SPEED), SPEED)


def test_a_viscoelastic_compound_has_a_table_of_its_own(asked):
    law = option().build(context(relaxation="a spectrum"))
    check_spectrum(asked["floor"], RQ)
    assert asked["rubber"].modulus == 6e6
    assert asked["pressure"] == pytest.approx(np.geomspace(1e3, 2e6, 12))
    assert asked["speeds"] == [SPEED]
    assert law == ("law", None, SPEED)


@pytest.mark.parametrize(("modulus", "near"), [(1e6, 1.0), (6e6, 10**0.8), (6.6e6, 10**0.8),
                                               (0.5e6, 10**-0.3)])  # fmt: skip
def test_two_scans_have_a_table_at_pressures_near_their_modulus(asked, modulus, near):
    made = option().table(context(modulus, files=("a/shoe.x3p", "b/floor.sdf")))
    assert asked["description"] == "shoe.x3p on floor.sdf"
    assert (asked["floor"], asked["shoe"]) == (SCAN["floor"], SCAN["shoe"])
    assert asked["pressure"] == pytest.approx(np.geomspace(1e3 / near, 2e6 / near, 12))
    assert made.by == (1.0, pytest.approx(modulus / 1e6), SPEED)
    option().table(context(modulus, "a spectrum", ("shoe.x3p", "floor.sdf")))
    assert asked["pressure"] == pytest.approx(np.geomspace(1e3, 2e6, 12))
    for files in (("shoe.x3p", ""), ("", "floor.sdf")):
        assert option().table(context(files=files)) is None


@pytest.mark.parametrize("midsole", [False, True])
def test_layers_of_a_sole_reach_its_compliance(monkeypatch, midsole):
    told = {}

    def made(name):
        return lambda *sole, **given: told.update({name: (sole, given)})

    for module, name in ((compliance, "layered_compliance"), (compliance, "half_space_compliance"),
                         (finite_element, "finite_element_compliance")):  # fmt: skip
        monkeypatch.setattr(module, name, made(name))
    layer = SimpleNamespace(modulus=2e6, thickness=0.02, poisson_ratio=0.2) if midsole else None
    known = SimpleNamespace(
        youngs_modulus=5e6, poisson_ratio=NU, motion=SimpleNamespace(shoe_angle=0.1),
        shoe=SimpleNamespace(sole=SimpleNamespace(outsole_thickness=8e-3, midsole=layer)),
        progress="told",
    )  # fmt: skip
    grid = SimpleNamespace(x=np.arange(7.0), y=np.arange(5.0), spacing=(1e-3, 2e-3))
    nothing = cast(Any, None)
    LayeredCompliance.build(nothing, cast(Any, known), cast(Any, grid))
    layers = {
        "modulus": 5e6, "poisson_ratio": NU, "thickness": 8e-3, "shoe_angle": 0.1,
        "midsole_modulus": layer and 2e6, "midsole_thickness": layer and 0.02,
    }  # fmt: skip
    layers |= {"midsole_poisson_ratio": 0.2} if midsole else {}
    assert told["layered_compliance"] == ((grid,), layers)
    for before, body in ((SimpleNamespace(body="body"), "body"), (SimpleNamespace(), None)):
        LayeredCompliance.rebuilt(nothing, cast(Any, before), cast(Any, known), cast(Any, grid))
        assert told["layered_compliance"] == ((grid,), {"known": body, **layers})
    FiniteElementCompliance.build(nothing, cast(Any, known), cast(Any, grid))
    (sole, given) = told["finite_element_compliance"]
    assert sole == (grid,)
    assert given.pop("cache") is not None
    assert given == {**layers, "progress": "told"}
    HalfSpaceCompliance.build(nothing, cast(Any, known), cast(Any, grid))
    assert told["half_space_compliance"] == (
        ((7, 5), (1e-3, 2e-3)), {"modulus": 5e6, "poisson_ratio": NU}
    )  # fmt: skip


def test_a_film_bears_where_there_is_a_fluid():
    film = SimpleNamespace()
    wet, dry = SimpleNamespace(viscosity_value=0.2), SimpleNamespace(viscosity_value=None)
    assert ReynoldsFilm.build(cast(Any, film), cast(Any, dry)) is None
    made = ReynoldsFilm.build(cast(Any, film), cast(Any, wet))
    assert made is not None
    assert NoFilm.build(cast(Any, film), cast(Any, wet)) is None
    assert (ReynoldsFilm.bears, NoFilm.bears) == (True, False)
    assert (LayeredCompliance.layers, LayeredCompliance.cut) == (True, True)
    assert (HalfSpaceCompliance.layers, HalfSpaceCompliance.cut) == (False, False)
    assert (FiniteElementCompliance.layers, FiniteElementCompliance.cut) == (True, False)


@pytest.mark.parametrize("edges", [True, False])
def test_what_a_film_does_not_read(edges):
    def unused(fluid, tread="transverse", arc=None):
        pattern = SimpleNamespace(name=tread, arc_channel=arc)
        case = SimpleNamespace(contaminant=fluid, shoe=SimpleNamespace(tread=pattern))
        option = cast(Any, SimpleNamespace(lug_edges=edges))
        return ReynoldsFilm.unused_keys(option, cast(Any, case))

    every = ("lug_edges", "suction", "dewetting")
    assert unused(None) == unused("glycerol", "none") == every
    assert unused("glycerol", "none", "an arc") == unused("glycerol")
    assert unused("glycerol") == (() if edges else every[1:])
