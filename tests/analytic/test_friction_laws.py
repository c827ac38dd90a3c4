"""Friction laws and Eq. (1) against hand calculations."""

import math

import numpy as np
import pytest

from underfoot.core import InputError, SourcedValue, breaches
from underfoot.fluid import AdhesionBlocking
from underfoot.friction import (
    AdhesionBlockingLaw,
    BoundaryFriction,
    BoundaryLaw,
    BowdenTaborLaw,
    ConstantLaw,
    FrictionLaw,
    FrictionParts,
    ShearStrength,
    SpeedTableLaw,
    StribeckLaw,
    boundary_friction_at,
    cof,
    friction_left,
    sampled_cof,
    stribeck_cof,
    viscous_decay,
)
from underfoot.friction.law import PIN_PRESSURE, PIN_RANGES


def sourced(value, deviation=None, **marks):
    return SourcedValue(value, "1", source="test", uncertainty=deviation, **marks)


def on_one_cell(law, speed):
    """Sampled COF of one cell whose load is all on the contact."""
    return sampled_cof(law, [[1e5]], [[0.0]], [[1.0]], speed=speed)


def laws():
    """One law of each kind; the numbers are arbitrary."""
    return [
        ConstantLaw(0.2, 0.1, "test", 0.2, 0.02, 0.01),
        BoundaryLaw(sourced(0.5, 0.03), sourced(0.1, 0.02), 0.2),
        StribeckLaw(sourced(0.5, 0.03), sourced(0.3, 0.1), sourced(0.1, 0.02), 0.2),
        AdhesionBlockingLaw(
            AdhesionBlocking(2.5, 0.1), sourced(0.6, 0.05), sourced(0.1, 0.02), viscosity=0.2
        ),
    ]


@pytest.mark.parametrize("law", laws(), ids=lambda law: law.name)
def test_every_law_keeps_the_contract(law):
    assert isinstance(law, FrictionLaw)
    assert law.name
    assert law.source
    assert law.assumptions
    pressure = np.array([[0.0, 1e5], [2e5, 3e5]])
    film = np.full((2, 2), 1e-5)
    parts = law(pressure, 0.5, film)
    for part in (parts.adhesion, parts.hysteresis, parts.viscous):
        assert part.shape == (2, 2)
        assert (part >= 0).all()
    assert parts.adhesion[0, 0] == parts.hysteresis[0, 0] == 0.0
    assert parts.viscous == pytest.approx(0.2 * 0.5 / 1e-5)
    assert parts.total == pytest.approx(parts.adhesion + parts.hysteresis + parts.viscous)
    backward = law(pressure, -0.5, film)
    assert np.array_equal(backward.total, parts.total)
    centre = {name: given.value for name, given in law.inputs.items()}
    assert law.inputs
    assert np.array_equal(law.at(centre)(pressure, 0.5, film).total, parts.total)
    assert law.error_of_model is None or law.error_of_model > 0


def test_constant_law():
    parts = ConstantLaw(0.25, 0.15, "own test")(2e5, 0.3, 1e-5)
    assert parts.adhesion == pytest.approx(0.25 * 2e5)
    assert parts.hysteresis == pytest.approx(0.15 * 2e5)
    assert parts.viscous == 0.0


def test_boundary_law_splits_what_was_measured():
    law = BoundaryLaw(sourced(0.47, 0.03), sourced(0.105, 0.027))
    parts = law(1e5, np.array([0.05, 0.7]), 1e-5)
    assert parts.hysteresis == pytest.approx(0.105e5)
    assert parts.total == pytest.approx(0.47e5)
    sampled = on_one_cell(law, 0.7)
    assert sampled.cof.std() == pytest.approx(0.03, rel=0.02)
    assert sampled.hysteresis.std() == pytest.approx(0.027, rel=0.02)
    assert sampled.adhesion.std() == pytest.approx(math.hypot(0.03, 0.027), rel=0.05)
    assert sum(sampled.share.values()) == pytest.approx(1)
    assert sampled.share["cof_boundary"] > 0.97


def test_hysteresis_is_at_most_the_whole():
    law = BoundaryLaw(sourced(0.08), sourced(0.105))
    assert law.cof_parts == pytest.approx((0.0, 0.08))
    assert on_one_cell(law, 0.5) is None  # its inputs have no standard deviation


def test_stribeck_limits_and_decay():
    assert stribeck_cof(0.0, 0.6, 0.2, 0.1) == pytest.approx(0.6)
    assert stribeck_cof(50.0, 0.6, 0.2, 0.1) == pytest.approx(0.1)
    assert stribeck_cof(0.2, 0.6, 0.2, 0.1) == pytest.approx(0.1 + 0.5 / math.e)
    law = StribeckLaw(sourced(0.6, 0.0), sourced(0.2, 0.0), sourced(0.1, 0.0))
    speeds = np.linspace(0.0, 2.0, 21)
    parts = law(1e5, speeds, 1e-5)
    assert parts.total == pytest.approx(1e5 * stribeck_cof(speeds, 0.6, 0.2, 0.1))
    assert (np.diff(parts.adhesion) < 0).all()
    assert parts.hysteresis == pytest.approx(0.1e5)


def test_stribeck_spread_against_plain_sampling():
    """500 stratified draws of the law against 200 000 plain ones of Eq. 17."""
    law = StribeckLaw(sourced(0.6, 0.03), sourced(0.3, 0.015), sourced(0.1, 0.005))
    rng = np.random.default_rng(1)
    n = 200_000
    for speed in (0.0, 0.1, 0.3, 1.0):
        sample = stribeck_cof(
            speed, rng.normal(0.6, 0.03, n), rng.normal(0.3, 0.015, n), rng.normal(0.1, 0.005, n)
        )
        found = on_one_cell(law, speed)
        assert found.cof.std() == pytest.approx(sample.std(), rel=0.06)
        assert np.quantile(found.cof, [0.025, 0.975]) == pytest.approx(
            np.quantile(sample, [0.025, 0.975]), abs=0.15 * sample.std()
        )


def test_adhesion_blocking_law_is_eq_26():
    """alpha 2.8 N, beta 0.1, dry adhesion 0.6 at 20.9 N: (2.8 + 0.1 x 12.54) / 20.9."""
    blocking = AdhesionBlocking(2.8, 0.1)
    law = AdhesionBlockingLaw(blocking, sourced(0.6), sourced(0.2, 0.01))
    assert law.cof_parts == pytest.approx(((2.8 + 0.1 * 12.54) / 20.9, 0.2))
    adhesion = 1.05 * math.sqrt(math.pi / 2) / 20.9  # mean error 1.05 N (G.3.2), normal errors
    assert law.error_of_model == pytest.approx(adhesion)
    given = AdhesionBlockingLaw(blocking, sourced(0.6, 0.0), sourced(0.2, 0.01))
    spread = on_one_cell(given, 0.01).cof.std()
    assert spread == pytest.approx(math.hypot(adhesion, 0.01), rel=0.02)
    barely = AdhesionBlockingLaw(blocking, sourced(0.05), sourced(0.2))
    assert barely.cof_parts[0] == 0.05  # a fluid adds no adhesion


def test_viscous_part_is_bounded_where_the_film_is_clipped():
    law = ConstantLaw(0.0, 0.0, "test", viscosity=0.219)
    thin = law(0.0, 0.7, np.array([-1e-6, 0.0, 1e-9, 2e-7, 2e-5]))
    assert thin.viscous[:4] == pytest.approx(0.219 * 0.7 / 2e-7)
    assert thin.viscous[4] == pytest.approx(0.219 * 0.7 / 2e-5)
    assert law.breaches(contact_pressure=0.0, speed=0.7, film_thickness=1e-9)
    assert not law.breaches(contact_pressure=0.0, speed=0.7, film_thickness=1e-6)


def test_cof_of_a_couette_film():
    """Film of one thickness carrying everything: COF = eta V A / (h F)."""
    law = ConstantLaw(0.3, 0.1, "test", viscosity=0.219)
    contact, fluid, film = np.zeros((10, 20)), np.full((10, 20), 1e5), np.full((10, 20), 2e-5)
    found = cof(law(contact, 0.7, film), contact, fluid, spacing=1e-3)
    assert found.cof.value == pytest.approx(0.219 * 0.7 / 2e-5 / 1e5)
    assert found.cof_viscous.value == found.cof.value
    assert found.normal_force == pytest.approx(200e-6 * 1e5)
    assert found.fluid_load == pytest.approx(found.normal_force)


def test_eq_1_with_half_the_load_on_the_fluid():
    """(COF_asp F_asp + F_fluid) / F_tot with F_asp = F_tot / 2."""
    law = ConstantLaw(0.3, 0.1, "test", 0.05, 0.03, 0.04)
    contact = np.zeros((4, 4))
    contact[:2] = 2e5
    fluid = contact[::-1].copy()
    film = np.full((4, 4), 1e-4)
    parts = law(contact, 0.5, film)
    found = cof(
        parts,
        contact,
        fluid,
        spacing=2e-3,
        wet=fluid > 0,
        sampled=sampled_cof(law, contact, fluid, film, speed=0.5, wet=fluid > 0),
    )
    viscous = 0.05 * 0.5 / 1e-4 / 2e5
    assert found.cof_adhesion.value == pytest.approx(0.15)
    assert found.cof_hysteresis.value == pytest.approx(0.05)
    assert found.cof_viscous.value == pytest.approx(viscous / 2)
    assert found.cof.value == pytest.approx(0.2 + viscous / 2)
    assert found.cof.uncertainty == pytest.approx(0.05 / 2, rel=0.04)
    assert found.cof_adhesion.uncertainty == pytest.approx(0.015, rel=0.04)
    low, high = found.cof.interval
    assert (high - low) / 2 == pytest.approx(1.96 * 0.025, rel=0.06)
    assert found.cof_viscous.uncertainty is None
    assert found.friction_force == pytest.approx(found.cof.value * found.normal_force)


def test_the_sum_of_the_parts_is_the_whole():
    rng = np.random.default_rng(3)
    for law in laws():
        contact, fluid = rng.uniform(0, 3e5, (2, 30, 40))
        film = rng.uniform(1e-6, 1e-4, (30, 40))
        parts = law(contact, 0.4, film)
        found = cof(parts, contact, fluid, spacing=1e-3)
        whole = found.cof_adhesion.value + found.cof_hysteresis.value + found.cof_viscous.value
        assert found.cof.value == pytest.approx(whole, rel=1e-14)
        assert found.cof.value == pytest.approx(parts.total.sum() / (contact + fluid).sum())


def fluid(name, viscosity, cof_boundary, deviation=0.03, **more):
    return BoundaryFriction(name, "a on b", viscosity, sourced(cof_boundary, deviation), **more)


def test_interpolation_in_the_logarithm_of_the_viscosity():
    pair = (fluid("thick", 0.1, 0.2), fluid("thin", 0.001, 0.6))
    middle = boundary_friction_at(0.01, pair)
    assert middle.cof_boundary.value == pytest.approx(0.4)
    assert middle.cof_boundary.uncertainty == pytest.approx(math.hypot(0.03 / math.sqrt(2), 0.2))
    assert middle.cof_boundary.assumed
    for viscosity, value, kept in ((1.0, 0.2, "thick"), (1e-4, 0.6, "thin")):
        beyond = boundary_friction_at(viscosity, pair)
        assert beyond.cof_boundary.value == value
        assert f"{kept} kept" in beyond.cof_boundary.note
    at = boundary_friction_at(0.1, pair).cof_boundary.value
    assert at == pytest.approx(0.2)


def test_friction_left_ignores_fits_at_their_bound():
    measured = (
        fluid("a", 1e-3, 0.6, cof_asymptote=sourced(0.001, 0.0)),
        fluid("b", 2e-3, 0.5, cof_asymptote=sourced(0.10, 0.02)),
        fluid("c", 5e-3, 0.4, cof_asymptote=sourced(0.12, 0.03)),
    )
    left = friction_left(measured)
    assert left.value == pytest.approx(0.11)
    assert left.uncertainty == 0.03
    with pytest.raises(InputError, match="high speed"):
        friction_left(measured[:1])


def test_viscous_decay_is_the_mean_product():
    measured = (
        fluid("a", 1e-3, 0.6, tau_hydro=sourced(1.0)),
        fluid("b", 2e-3, 0.5, tau_hydro=sourced(0.6)),
        fluid("c", 5e-3, 0.4),
    )
    decay = viscous_decay(measured)
    assert decay.value == pytest.approx(1.1e-3)
    assert decay.uncertainty == pytest.approx(np.std([1.0e-3, 1.2e-3], ddof=1))
    with pytest.raises(InputError, match="fitted"):
        viscous_decay(measured[1:])


def test_breaches_of_pressure_and_speed():
    law = BoundaryLaw(sourced(0.5), sourced(0.1))
    film = np.full(3, 1e-5)
    inside = law.breaches(contact_pressure=np.full(3, 2e5), speed=0.5, film_thickness=film)
    assert not inside
    peaky = np.array([1e4, 1e4, 2.6e5])  # one cell may be high: what counts is the mean by load
    assert not law.breaches(contact_pressure=peaky, speed=0.5, film_thickness=film)
    outside = law.breaches(contact_pressure=np.full(3, 6e5), speed=1.5, film_thickness=film)
    assert {b.quantity for b in outside} == {"contact pressure", "sliding speed"}


@pytest.mark.parametrize(
    "build",
    [
        lambda: ConstantLaw(-0.1, 0.1, "test"),
        lambda: ConstantLaw(0.1, math.nan, "test"),
        lambda: ConstantLaw(0.1, 0.1, " "),
        lambda: ConstantLaw(0.1, 0.1, "test", viscosity=0.0),
        lambda: BoundaryLaw(sourced(None), sourced(0.1)),
        lambda: BoundaryLaw(sourced(0.3), sourced(-0.1)),
        lambda: StribeckLaw(sourced(0.3), sourced(0.0), sourced(0.1)),
        lambda: fluid("a", 0.0, 0.3),
        lambda: boundary_friction_at(-1.0, (fluid("a", 1e-3, 0.3), fluid("b", 1e-2, 0.2))),
        lambda: boundary_friction_at(1e-3, (fluid("a", 1e-3, 0.3),)),
        lambda: StribeckLaw.from_measured(fluid("canola oil", 0.0746, 0.1)),
    ],
)
def test_bad_input(build):
    with pytest.raises(InputError):
        build()


@pytest.mark.parametrize("pressure", [-1.0, math.nan])
def test_bad_fields(pressure):
    for law in laws():
        with pytest.raises(InputError):
            law(pressure, 0.5, 1e-5)


def test_dry_floor_needs_given_friction():
    """The report prints no dry friction of any pair: nothing to take."""
    with pytest.raises(InputError, match="dry floor") as caught:
        BoundaryLaw.from_measured(None)
    assert "adhesion and hysteresis" in caught.value.remedy


def test_bad_integration():
    one = np.ones((2, 2))
    parts = FrictionParts(one, one, one)
    with pytest.raises(InputError, match="normal force"):
        cof(parts, 0 * one, 0 * one, spacing=1e-3)
    with pytest.raises(InputError, match="shape"):
        cof(parts, np.ones((3, 2)), np.ones((3, 2)), spacing=1e-3)
    with pytest.raises(InputError, match="spacing"):
        cof(parts, one, one, spacing=0.0)
    with pytest.raises(InputError, match="not finite"):
        cof(parts, one, math.nan * one, spacing=1e-3)


def test_every_law_presents_itself_in_short():
    cof = SourcedValue(0.4, "1", "a pin", 0.03)
    laws = [
        ConstantLaw(0.3, 0.1, "own readings", adhesion_deviation=0.02),
        BoundaryLaw(cof, SourcedValue(0.1), viscosity=0.2),
        StribeckLaw(cof, SourcedValue(0.2, "m/s"), SourcedValue(0.1)),
        SpeedTableLaw([0.1, 0.3, 1.0], [0.5, 0.4, 0.3], "own readings"),
        BowdenTaborLaw(ShearStrength(2e5, "own readings"), lambda p, v: p / 1e6),
    ]
    for law in laws:
        assert len(repr(law)) < 200
        assert type(law).__name__ in repr(law)
        assert law.name in law.summary()
        assert law._repr_html_().startswith("<table>")
    frame = laws[1].to_frame().set_index("input")
    assert frame.loc["cof_boundary", "standard deviation"] == 0.03
    assert frame.loc["viscosity", "value"] == 0.2
    assert list(laws[3].to_frame()["COF"]) == [0.5, 0.4, 0.3]


@pytest.mark.parametrize(
    ("pressure", "speed", "breached"),
    [
        (0.5, 0.5, set()),
        (1e5, 0.5, set()),
        (PIN_PRESSURE, 0.05, set()),
        (PIN_PRESSURE, 1.0, set()),
        (1.01 * PIN_PRESSURE, 0.5, {"contact pressure"}),
        (1e5, 0.04, {"sliding speed"}),
        (1e5, 1.1, {"sliding speed"}),
    ],
)
def test_what_the_pin_was_not_tested_on_is_more_pressure_and_other_speeds(
    pressure, speed, breached
):
    values = {"contact pressure": pressure, "sliding speed": speed, "film thickness": 1e-6}
    assert {each.quantity for each in breaches("law", PIN_RANGES, values)} == breached
