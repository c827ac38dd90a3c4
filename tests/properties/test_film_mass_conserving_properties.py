"""What every mass-conserving film must obey, over random gaps, rims and steps."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from film_between_walls import solved_film

H0, ETA = 1e-5, 0.1

seeds = st.integers(0, 2**31 - 1)
roughness = st.floats(0.0, 0.8)
speeds = st.sampled_from([-0.5, 0.5])


def drawn(seed, rough, transient, flooded):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(4, 24, size=2))
    gap = H0 * np.exp(rough * rng.normal(size=shape))
    more = {}
    if flooded:
        more["rim_pressure"] = 2e4 * rng.random(shape)
    else:
        more["rim_fraction"] = rng.random(shape)
    if transient:
        more["before"] = 1.3 * gap * rng.random(shape)
        more["time_step"] = 10.0 ** rng.uniform(-5, 0)
    return gap, more


@settings(max_examples=60, deadline=None)
@given(seeds, roughness, speeds, st.booleans(), st.booleans())
def test_bounds_complementarity_and_volume(seed, rough, speed, transient, flooded):
    gap, more = drawn(seed, rough, transient, flooded)
    solved = solved_film(gap, spacing=1e-3, viscosity=ETA, speed=speed, **more)
    inner = (slice(1, -1), slice(1, -1))
    pressure, fraction = solved.pressure[inner], solved.fraction[inner]
    assert (pressure >= 0).all()
    assert ((fraction >= 0) & (fraction <= 1)).all()
    assert (pressure * (1 - fraction)).max() == 0
    assert solved.mass_residual < 1e-11
    gained = 0.0
    if transient:
        gained = (solved.content - more["before"])[inner].sum() * 1e-6 / more["time_step"]
    flow = 0.5 * 0.5 * H0 * 1e-3 + abs(gained)
    # every cell may miss its balance by the residual of the largest flow, pressure flow included
    largest = flow + solved.pressure.max() * solved.gap.max() ** 3 / (12 * ETA)
    assert abs(solved.rim_outflow + gained) < 1e-9 * largest


@settings(max_examples=25, deadline=None)
@given(seeds, roughness, st.floats(1e-3, 10.0))
def test_pressure_is_proportional_to_viscosity(seed, rough, times):
    gap, more = drawn(seed, rough, transient=False, flooded=False)
    thin, thick = (
        solved_film(gap, spacing=1e-3, viscosity=eta, speed=0.5, **more)
        for eta in (ETA, ETA * times)
    )
    scale = max(thin.pressure.max(), 1e-3)
    assert np.abs(thick.pressure / times - thin.pressure).max() < 1e-8 * scale
    assert np.abs(thick.fraction - thin.fraction).max() < 1e-8


@settings(max_examples=25, deadline=None)
@given(seeds, roughness, st.booleans())
def test_mirrored_film_slides_backward(seed, rough, transient):
    gap, more = drawn(seed, rough, transient, flooded=False)
    mirrored = {k: v[::-1] if isinstance(v, np.ndarray) else v for k, v in more.items()}
    ahead = solved_film(gap, spacing=1e-3, viscosity=ETA, speed=0.5, **more)
    back = solved_film(gap[::-1], spacing=1e-3, viscosity=ETA, speed=-0.5, **mirrored)
    scale = max(ahead.pressure.max(), 1e-3)
    assert np.abs(back.pressure[::-1] - ahead.pressure).max() < 1e-8 * scale
    assert np.abs(back.fraction[::-1] - ahead.fraction).max() < 1e-8


@settings(max_examples=25, deadline=None)
@given(seeds, roughness)
def test_more_supply_never_lowers_pressure_or_fill(seed, rough):
    gap, more = drawn(seed, rough, transient=False, flooded=False)
    starved = solved_film(gap, spacing=1e-3, viscosity=ETA, speed=0.5, **more)
    flooded = solved_film(gap, spacing=1e-3, viscosity=ETA, speed=0.5)
    slack = 1e-9 * max(flooded.pressure.max(), 1e-3)
    assert (flooded.pressure >= starved.pressure - slack).all()
    assert (flooded.fraction >= starved.fraction - 1e-9)[1:-1, 1:-1].all()
