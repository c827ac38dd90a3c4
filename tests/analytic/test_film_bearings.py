"""The film solver against closed forms (sources in ``reference.lubrication``)."""

import numpy as np
import pytest

from film_between_walls import closing_film, film_in_time, solved_film
from underfoot.core import InputError
from underfoot.core.sparse import back_ends
from underfoot.reference import lubrication

OIL = {"viscosity": 0.1, "speed": 0.5}
LENGTH = 0.01
H0 = 20e-6


def wide(profile):
    """A pad of infinite width: the grid's y edges let nothing through. x = 0 trails."""
    gap = np.repeat(np.asarray(profile)[:, None], 3, axis=1)
    film = np.ones(gap.shape, bool)
    film[[0, -1]] = False
    return gap, film


def wide_load(profile, spacing, **more):
    gap, film = wide(profile)
    solved = solved_film(gap, spacing=spacing, mask=film, **(OIL | more))
    return solved.load / (3 * spacing)


def taper(cells, m):
    return H0 * (1 + m * np.linspace(0, 1, cells + 1))


def test_inclined_bearing_load_and_pressure():
    m = lubrication.BEST_TAPER
    exact = lubrication.inclined_bearing_load(
        **OIL, length=LENGTH, leading_gap=H0 * (1 + m), trailing_gap=H0
    )
    assert wide_load(taper(200, m), LENGTH / 200) == pytest.approx(exact, rel=5e-4)
    gap, film = wide(taper(200, m))
    solved = solved_film(gap, spacing=LENGTH / 200, mask=film, **OIL)
    expected = lubrication.inclined_bearing_pressure(
        LENGTH * np.linspace(1, 0, 201),
        **OIL,
        length=LENGTH,
        leading_gap=H0 * (1 + m),
        trailing_gap=H0,
    )
    assert solved.pressure[:, 1] == pytest.approx(expected, abs=1e-3 * expected.max())


def test_best_taper_is_the_best():
    def load(m):
        return lubrication.inclined_bearing_load(
            **OIL, length=LENGTH, leading_gap=H0 * (1 + m), trailing_gap=H0
        )

    best = lubrication.BEST_TAPER
    assert load(best) > max(load(best * 1.01), load(best * 0.99))
    # classical value of the load coefficient 6 K
    unit = OIL["viscosity"] * OIL["speed"] * LENGTH**2 / H0**2
    assert load(best) / unit == pytest.approx(0.1602, abs=2e-4)


def test_parabolic_bearing():
    profile = H0 * (1 + 1.5 * np.linspace(0, 1, 201) ** 2)
    exact = lubrication.parabolic_bearing_load(
        **OIL, length=LENGTH, leading_gap=2.5 * H0, trailing_gap=H0
    )
    assert wide_load(profile, LENGTH / 200) == pytest.approx(exact, rel=3e-4)


def test_step_bearing_is_exact_on_any_grid():
    cells, behind = 25, 7
    spacing = LENGTH / cells
    profile = np.where(np.arange(cells + 1) < behind, H0, 1.866 * H0)
    share = 1 - (behind - 0.5) / cells
    exact = lubrication.step_bearing_load(
        **OIL, length=LENGTH, leading_share=share, leading_gap=1.866 * H0, trailing_gap=H0
    )
    gap, film = wide(profile)
    solved = solved_film(gap, spacing=spacing, mask=film, **OIL)
    # the peak sits on the face between two nodes: compare the slope, exact on both sides
    peak = 2 * exact / LENGTH
    slope = (solved.pressure[-2, 1] - solved.pressure[-1, 1]) / spacing
    assert slope == pytest.approx(peak / (share * LENGTH), rel=1e-10)


@pytest.mark.parametrize("ratio", sorted(lubrication.SIDE_LEAKAGE))
@pytest.mark.parametrize("m", [1.0, 1.189, 2.0])
def test_tapered_wedge_with_side_leakage(ratio, m):
    def load(cells):
        across = round(cells / ratio)
        gap = np.repeat(taper(cells, m)[:, None], across + 1, axis=1)
        return solved_film(gap, spacing=LENGTH / cells, **OIL).load

    coarse, fine = load(32), load(64)
    exact = lubrication.tapered_wedge_load(
        **OIL,
        length=LENGTH,
        width=LENGTH / ratio,
        leading_gap=H0 * (1 + m),
        trailing_gap=H0,
        leakage=lubrication.SIDE_LEAKAGE[ratio][m],
    )
    # three digits in the table: half a unit of the last one is 0.9 % of the smallest factor
    assert (4 * fine - coarse) / 3 == pytest.approx(exact, rel=0.01)


def disc(cells):
    radius = 0.01
    spacing = 2 * radius / cells
    place = (np.arange(cells + 4) - (cells + 3) / 2) * spacing
    distance = np.hypot(place[:, None], place[None, :])
    return radius, spacing, distance


def test_squeeze_disc():
    radius, spacing, distance = disc(128)
    given = {"viscosity": 0.2, "radius": radius, "gap": 1e-4, "closing_speed": 1e-3}
    solved = closing_film(
        np.where(distance < radius, 1e-4, np.inf),
        1e-3,
        spacing=spacing,
        viscosity=0.2,
        mask=distance < radius,
    )
    assert solved.load == pytest.approx(lubrication.squeeze_disc_load(**given), rel=0.01)
    exact = lubrication.squeeze_disc_pressure(distance, **given)
    inner = distance < 0.9 * radius
    assert solved.pressure[inner] == pytest.approx(exact[inner], abs=0.02 * exact.max())


def test_parting_walls_and_diverging_wedges_cavitate():
    gap = np.repeat(taper(20, 1.0)[:, None], 20, axis=1)
    backward = solved_film(gap, spacing=5e-4, viscosity=0.1, speed=-0.5)
    assert backward.load == 0.0
    assert backward.cavitated[1:-1, 1:-1].all()
    # the liquid that enters at the narrow end passes every gap: theta h is the same
    content = (backward.fraction * gap)[1:-1, 1:-1]
    assert (np.ptp(content, axis=0) < 0.06 * content.mean()).all()
    parting = closing_film(gap, -1e-3, step=1e-2, spacing=5e-4, viscosity=0.1)
    assert parting.load == 0.0
    inner = (slice(1, -1), slice(1, -1))
    assert parting.content[inner] == pytest.approx((gap - 1e-5)[inner])


def test_mirror_and_scaling():
    rng = np.random.default_rng(4)
    rough = H0 * (2 + rng.random((16, 12)))
    plain = solved_film(rough, spacing=3e-4, **OIL).pressure
    mirrored = solved_film(rough[::-1], spacing=3e-4, viscosity=0.1, speed=-0.5).pressure
    assert mirrored[::-1] == pytest.approx(plain, rel=1e-9, abs=1e-9 * plain.max())
    thicker = solved_film(rough, spacing=3e-4, viscosity=0.3, speed=0.5).pressure
    assert thicker == pytest.approx(3 * plain, rel=1e-9)
    leakier = solved_film(rough, spacing=3e-4, flow_factor=2.0, **OIL).pressure
    assert leakier == pytest.approx(plain / 2, rel=1e-9)


def test_both_back_ends_agree():
    rng = np.random.default_rng(5)
    rough = H0 * (2 + rng.random((30, 30)))
    found = [solved_film(rough, spacing=3e-4, backend=name, **OIL).pressure for name in back_ends()]
    for other in found[1:]:
        assert other == pytest.approx(found[0], rel=1e-8, abs=1e-8 * found[0].max())


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"viscosity": 0.0}, "viscosity"),
        ({"viscosity": float("nan")}, "viscosity"),
        ({"speed": float("inf")}, "speed"),
        ({"spacing": -1.0}, "spacing"),
        ({"gap": np.zeros((5, 5))}, "gap"),
        ({"gap": np.full((5, 5), np.nan)}, "gap"),
        ({"flow_factor": 0.0}, "flow_factor"),
        ({"mask": np.zeros((5, 5), bool)}, "mask"),
    ],
)
def test_bad_input_is_refused(change, where):
    given = {"gap": np.full((5, 5), 1e-5), "spacing": 1e-3, **OIL} | change
    with pytest.raises(InputError) as caught:
        solved_film(given.pop("gap"), **given)
    assert caught.value.where == where


@pytest.mark.parametrize("speed", [0.5, -0.5])
def test_many_cells_along_and_few_across_settle(speed):
    """Parabolic slider on 1024 x 3 cells: Reynolds' condition by quadrature along the film.

    dp/dx = -6 eta V (h - h*) / h^3 with p = dp/dx = 0 where it ruptures (V along +x, sole above).
    """
    from scipy.integrate import quad
    from scipy.optimize import brentq

    cells, length, thin = 1024, 0.01, 2e-5

    def gap(x):
        return thin * (1 + 4 * (x / length) ** 2)

    def slope(x, end):
        return 6 * 0.1 * 0.5 * (gap(x) - gap(end)) / gap(x) ** 3

    def remaining(end):
        return quad(slope, inlet, end, args=(end,))[0]

    inlet = -0.5 * length + 0.5 * length / cells  # the film's rim: centre of the first cell
    end = brentq(remaining, 1e-5, 0.4 * length)
    load = -quad(lambda x: (x - inlet) * slope(x, end), inlet, end)[0]

    x = (np.arange(cells) + 0.5) / cells * length - 0.5 * length
    film = np.ones((cells, 3), dtype=bool)
    film[[0, -1]] = False
    heights = np.repeat(gap(x)[:, None], 3, axis=1)
    given = {"spacing": length / cells, "viscosity": 0.1, "speed": speed, "mask": film}
    found = solved_film(heights, **given)
    assert found.iterations <= 5
    assert found.load / (3 * length / cells) == pytest.approx(load, rel=1e-4)


def test_mass_conserving_films_settle_on_such_grids_too():
    """Steady, and carried in time while the plates part and come back."""
    cells, length = 1024, 0.01
    x = (np.arange(cells) + 0.5) / cells - 0.5
    shape = np.repeat((2e-5 * (1 + 4 * x**2))[:, None], 3, axis=1)
    film = np.ones((cells, 3), dtype=bool)
    film[[0, -1]] = False
    given = {"spacing": length / cells, "viscosity": 0.1, "speed": 0.5, "mask": film}
    steady = solved_film(shape, **given)
    assert steady.iterations <= 10
    assert steady.mass_residual < 1e-11
    times = np.linspace(0.0, 2e-3, 9)
    history = list(
        film_in_time(lambda t: shape * (1 + 0.2 * np.sin(2 * np.pi * t / 2e-3)), times, **given)
    )
    assert max(one.mass_residual for one in history) < 1e-11
    assert max(one.iterations for one in history) <= 60
