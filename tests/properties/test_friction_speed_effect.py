"""Limits that every mechanism of the speed effect keeps, whatever its inputs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.core import InputError, SourcedValue
from underfoot.friction import (
    AsperityEHL,
    BowdenTaborLaw,
    ConstantLaw,
    MeanFilmSharing,
    ShearStrength,
    SpeedEffectLaw,
    ViscoelasticArea,
    asperity_ehl_law,
    cof_with_speed,
    sampled_cof,
    self_affine_scale,
)

SCALE = self_affine_scale(2.5e-6, rq=8.3e-6, longest_wave=0.8e-3)  # near the report's pin (G.2.1)
FLUID = {
    "bearing": AsperityEHL(SCALE, 2e6, 0.5, 15e-9),
    "sharing": AsperityEHL(SCALE, 2e6, 0.5, 15e-9, "sharing"),
    "mean film": MeanFilmSharing(23.3e-3, 20.9, 5.3e6, 1.34e-6),
}
EFFECTS = {**FLUID, "area": ViscoelasticArea(0.2)}
PRESSURE = 2e5
cofs = st.floats(0.0, 1.5)
speeds = st.floats(1e-3, 10.0)
viscosities = st.floats(1e-4, 1.0)


def law(effect, boundary=0.5, left=0.1, viscosity=5e-3):
    rest = SourcedValue(boundary, "1", "made up", 0.03)
    return SpeedEffectLaw(effect, rest, SourcedValue(left, "1", "made up", 0.02), viscosity, 0.03)


@pytest.mark.parametrize("name", EFFECTS)
@settings(max_examples=30, deadline=None)
@given(boundary=cofs, left=cofs, viscosity=viscosities)
def test_at_rest_the_friction_is_the_boundary_value(name, boundary, left, viscosity):
    parts = law(EFFECTS[name], boundary, left, viscosity)(PRESSURE, 0.0, 1e-3)
    assert float(parts.total) == pytest.approx(boundary * PRESSURE, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", FLUID)
@settings(max_examples=30, deadline=None)
@given(boundary=cofs, left=cofs, viscosity=viscosities)
def test_at_high_speed_hysteresis_and_the_film_are_left(name, boundary, left, viscosity):
    speed, film = 1e6, 1e-3
    parts = law(FLUID[name], boundary, left, viscosity)(PRESSURE, speed, film)
    assert float(parts.adhesion) == pytest.approx(0.0, abs=1e-6 * PRESSURE)
    assert float(parts.hysteresis) == pytest.approx(min(left, boundary) * PRESSURE)
    assert float(parts.viscous) == pytest.approx(viscosity * speed / film)


@pytest.mark.parametrize("name", EFFECTS)
@settings(max_examples=30, deadline=None)
@given(speed=speeds, viscosity=viscosities, pressure=st.floats(0.0, 5e6))
def test_parts_sum_to_the_whole_and_stay_within_the_levels(name, speed, viscosity, pressure):
    parts = law(EFFECTS[name], viscosity=viscosity)(pressure, speed, 1e-4)
    solid = parts.adhesion + parts.hysteresis
    assert np.all(parts.total == parts.adhesion + parts.hysteresis + parts.viscous)
    assert np.all(solid <= 0.5 * pressure * (1 + 1e-12))
    assert np.all(solid >= 0.1 * pressure * (1 - 1e-12))


@pytest.mark.parametrize("name", EFFECTS)
@settings(max_examples=30, deadline=None)
@given(slow=speeds, factor=st.floats(1.0, 100.0), viscosity=viscosities)
def test_contact_friction_never_rises_with_speed_and_knows_no_direction(
    name, slow, factor, viscosity
):
    left = EFFECTS[name].adhesion_left(
        viscosity=viscosity,
        speed=np.array([slow, factor * slow, -slow]),
        contact_pressure=np.full(3, PRESSURE),
    )
    assert left[1] <= left[0] + 1e-12
    assert left[2] == left[0]


@pytest.mark.parametrize("name", FLUID)
@settings(max_examples=30, deadline=None)
@given(speed=speeds, viscosity=viscosities, factor=st.floats(0.1, 10.0))
def test_only_viscosity_times_speed_counts(name, speed, viscosity, factor):
    """The collapse of the report's Fig. 16 is exact for every mechanism with a film."""
    one, other = (
        FLUID[name].adhesion_left(viscosity=eta, speed=v, contact_pressure=PRESSURE)
        for eta, v in ((viscosity, speed), (viscosity * factor, speed / factor))
    )
    assert float(other) == pytest.approx(float(one), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("name", FLUID)
def test_a_dry_floor_is_one_without_fluid(name):
    dry = law(FLUID[name], viscosity=None)(PRESSURE, np.array([0.1, 1.0]), 1e-4)
    thin = law(FLUID[name], viscosity=1e-30)(PRESSURE, np.array([0.1, 1.0]), 1e-4)
    constant = ConstantLaw(0.4, 0.1, "made up")(PRESSURE, np.array([0.1, 1.0]), 1e-4)
    assert dry.total == pytest.approx(constant.total)
    assert dry.total == pytest.approx(thin.total, rel=1e-6)
    assert not dry.viscous.any()


@settings(max_examples=30, deadline=None)
@given(finer=st.floats(1.0, 10.0), viscosity=viscosities, speed=speeds)
def test_rougher_asperities_keep_more_adhesion(finer, viscosity, speed):
    rough, smooth = (
        float(
            AsperityEHL(SCALE, 2e6, 0.5, s).adhesion_left(
                viscosity=viscosity, speed=speed, contact_pressure=PRESSURE
            )
        )
        for s in (20e-9, 20e-9 / finer)
    )
    assert smooth <= rough + 1e-15


@settings(max_examples=20, deadline=None)
@given(speed=speeds, light=st.floats(10.0, 1e3))
def test_at_light_load_the_asperities_do_not_feel_the_load(speed, light):
    """Real area grows with load and the pressure of the spots stays (Persson, Archard)."""
    one, other = FLUID["bearing"].film_thickness(
        viscosity=5e-3, speed=speed, contact_pressure=np.array([light, 10 * light])
    )
    assert other == pytest.approx(one, rel=1e-3)


def test_a_measured_boundary_value_is_used_and_a_mean_is_not():
    from underfoot.friction import ONE_CURVE, BoundaryFriction

    value = SourcedValue(0.58, "1", "made up", 0.03)
    tau = SourcedValue(0.68, "m/s", "made up", 0.17)
    limit = BoundaryFriction("a", "b on c", 1.8e-3, value, tau, value)
    mean = BoundaryFriction("a", "b on c", 1.8e-3, value)
    kwargs = {"modulus": 2e6, "viscosity": 1.8e-3}
    assert asperity_ehl_law(SCALE, friction=limit, **kwargs).cof_boundary.value == 0.58
    for unknown in (mean, None):
        found = asperity_ehl_law(SCALE, friction=unknown, **kwargs)
        assert found.cof_boundary == ONE_CURVE.cof_boundary
        assert any("viscosity" in text for text in found.assumptions)


def test_breaches_and_deviation_are_carried():
    made = law(FLUID["bearing"])
    at = {"contact_pressure": 5e5, "speed": 2.0, "film_thickness": 1e-5}
    assert {b.quantity for b in made.breaches(**at)} == {"contact pressure", "sliding speed"}
    rest = sampled_cof(made, [[1e5]], [[0.0]], [[1.0]], speed=0.0)
    assert rest.cof.std() == pytest.approx(np.hypot(0.03, 0.03), rel=0.03)
    assert rest.share["model"] == pytest.approx(0.5, abs=0.05)
    fast = sampled_cof(made, [[1e5]], [[0.0]], [[1e9]], speed=1e6)
    assert fast.hysteresis.std() + fast.adhesion.std() > 0.02


def test_bowden_tabor_with_area_proportional_to_load_is_a_coefficient():
    strength = ShearStrength(3e5, "made up")
    proportional = BowdenTaborLaw(strength, lambda p, _: p / 1e6, 0.1, None)
    pressure = np.array([0.0, 1e4, 2e5])
    parts = proportional(pressure, 0.3, 1e-4)
    assert parts.total == pytest.approx(0.4 * pressure)
    assert parts.real_contact_fraction == pytest.approx(pressure / 1e6)
    saturated = proportional(np.array([5e6]), 0.3, 1e-4)
    assert saturated.adhesion == pytest.approx([3e5])  # full contact: no more area


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: AsperityEHL(SCALE, 0.0), "modulus"),
        (lambda: AsperityEHL(SCALE, 2e6, 0.5, -1e-9), "fine_roughness"),
        (lambda: AsperityEHL(SCALE, 2e6, 0.5, 1e-9, "bearings"), '"bearing"'),
        (lambda: MeanFilmSharing(0.0, 20.9, 5e6, 1e-6), "radius"),
        (lambda: ViscoelasticArea(-0.1), "exponent"),
        (lambda: ShearStrength(1e5, " "), "no source"),
        (lambda: law(FLUID["bearing"], viscosity=0.0), "viscosity"),
        (lambda: law(FLUID["bearing"], boundary=-0.1), "cof_boundary"),
        (lambda: self_affine_scale(1e-3, rq=8e-6, longest_wave=0.8e-3), "wavelength"),
    ],
)
def test_bad_input_is_named(make, word):
    with pytest.raises(InputError, match=word):
        make()


def test_cof_with_speed_is_a_number_for_numbers():
    found = cof_with_speed(
        FLUID["bearing"], viscosity=5e-3, speed=0.3, cof_boundary=0.5, cof_hysteresis=0.1
    )
    assert isinstance(found, float)
    assert 0.1 < found < 0.5
