"""Mass-conserving film against exact solutions with moving and standing cavities."""

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, minimize_scalar

from film_between_walls import film_in_time, solved_film
from underfoot.core import InputError
from underfoot.core.sparse import back_ends
from underfoot.film import Film, film_pressure

LENGTH, H0, ETA, SPEED = 0.01, 10e-6, 0.1, 0.5


def parabola(place):
    """Gap (m) that narrows from 50 um to 10 um and widens again; place 0 to 1."""
    return H0 * (1 + 4 * (2 * place - 1) ** 2)


def slope(place, flow):
    """dp/d(place) of a full film that carries ``flow`` (m^2/s) towards rising place."""
    h = parabola(place)
    return 12 * ETA * (SPEED / 2 * h - flow) / h**3 * LENGTH


def slope_integral(start, end, flow):
    return quad(slope, start, end, args=(flow,), epsrel=1e-12, epsabs=1e-7, limit=200)[0]


@pytest.fixture(scope="module")
def exact():
    """Rupture where p = dp/dx = 0; the flow there passes the cavity; reform against 2 bar."""
    rupture = brentq(
        lambda s: slope_integral(0, s, SPEED / 2 * parabola(s)), 0.501, 0.999, xtol=1e-14
    )
    flow = SPEED / 2 * parabola(rupture)
    outlet = 2e5
    reform = brentq(lambda s: slope_integral(s, 1, flow) - outlet, rupture, 0.9999, xtol=1e-14)
    moment = quad(lambda s: (rupture - s) * slope(s, flow), 0, rupture, epsrel=1e-12)[0]
    behind = quad(lambda s: (1 - s) * slope(s, flow), reform, 1, epsrel=1e-12)[0]
    return {
        "rupture": rupture,
        "flow": flow,
        "outlet": outlet,
        "reform": reform,
        "load": moment * LENGTH,
        "load_with_reform": (moment + behind) * LENGTH,
    }


def wide(cells, **more):
    """The slider on a grid that is closed on both sides; liquid flows towards -x."""
    place = np.arange(cells + 1) / cells
    gap = np.repeat(parabola(place)[::-1, None], 3, axis=1)
    film = np.ones(gap.shape, bool)
    film[[0, -1]] = False
    given = {"spacing": LENGTH / cells, "viscosity": ETA, "speed": SPEED, "mask": film}
    return solved_film(gap, **(given | more)), gap, film


def test_parabolic_slider_ruptures_where_it_must(exact):
    cells = 256
    solved, gap, _ = wide(cells)
    assert solved.load / (3 * LENGTH / cells) == pytest.approx(exact["load"], rel=5e-4)
    assert solved.mass_residual < 1e-12
    place = 1 - np.arange(cells + 1) / cells  # from the inlet
    cavity = place[solved.cavitated[:, 1]]
    assert cavity.min() == pytest.approx(exact["rupture"], abs=1.5 / cells)
    # the cavity holds the flow: theta h V / 2 on the faces between cells
    inside = solved.cavitated[:-1, 1] & solved.cavitated[1:, 1]
    face = 0.5 * (gap[:-1, 1] + gap[1:, 1])
    carried = SPEED / 2 * face * solved.fraction[1:, 1]
    assert carried[inside] == pytest.approx(exact["flow"], rel=2e-3)


def test_half_sommerfeld_loses_a_quarter_of_that_load(exact):
    # full film everywhere, suctions cut off: neither rupture nor flow is right
    inverse = [
        quad(lambda s, n=n: parabola(s) ** -n, 0, 1, epsrel=1e-12, points=[0.5])[0] for n in (2, 3)
    ]
    flow = SPEED / 2 * inverse[0] / inverse[1]
    place = np.linspace(0, 1, 4001)
    steps = 0.5 * (slope(place[1:], flow) + slope(place[:-1], flow)) * np.diff(place)
    pressure = np.concatenate([[0.0], np.cumsum(steps)])
    assert pressure[-1] == pytest.approx(0, abs=1e-4 * pressure.max())
    half = np.clip(pressure, 0, None).sum() * LENGTH / 4000
    assert half / exact["load"] == pytest.approx(0.753, abs=0.002)
    solved, _, _ = wide(128)
    assert solved.load * 128 / (3 * LENGTH) > 1.3 * half


def test_film_reforms_against_the_outlet_pressure(exact):
    cells = 256
    rim = np.zeros((cells + 1, 3))
    rim[0] = exact["outlet"]
    solved, _, _ = wide(cells, rim_pressure=rim)
    place = 1 - np.arange(cells + 1) / cells
    cavity = place[solved.cavitated[:, 1]]
    assert cavity.max() == pytest.approx(exact["reform"], abs=1.5 / cells)
    spacing = LENGTH / cells
    load = solved.load / (3 * spacing) + exact["outlet"] * spacing / 2
    assert load == pytest.approx(exact["load_with_reform"], rel=5e-4)
    assert solved.mass_residual < 1e-12


def dimpled(cells):
    place = np.arange(cells + 1) / cells
    x, y = np.meshgrid(place, place, indexing="ij")
    u, v = (3 * x) % 1 - 0.5, (3 * y) % 1 - 0.5
    return parabola(x) + 2 * H0 * np.clip(1 - (u * u + v * v) / 0.35**2, 0, None) ** 2


@pytest.mark.parametrize("cells", [40, 131])
def test_dimpled_slider_keeps_every_condition(cells):
    solved = solved_film(dimpled(cells), spacing=LENGTH / cells, viscosity=ETA, speed=SPEED)
    inner = (slice(1, -1), slice(1, -1))
    assert 0.2 < solved.cavitated[inner].mean() < 0.5
    assert solved.mass_residual < 1e-12
    assert solved.pressure.min() == 0.0
    assert solved.fraction.min() >= 0.0
    assert solved.fraction.max() == 1.0
    assert (solved.pressure * (1 - solved.fraction)).max() == 0.0
    assert abs(solved.rim_outflow) < 1e-12 * SPEED * H0 * LENGTH


def test_dimples_between_parallel_walls_carry_nothing_without_ambient_pressure():
    """Liquid isn't made at a reformation: with p >= 0 alone this pad carries more than 1 N."""
    gap = dimpled(60) - parabola(np.arange(61) / 60)[:, None] + H0
    given = {"spacing": LENGTH / 60, "viscosity": ETA, "speed": SPEED}
    assert solved_film(gap, **given).load < 1e-9
    # ambient pressure above that of the cavities draws liquid in, and the dimples work
    around = solved_film(gap, rim_pressure=1e5, **given)
    assert around.cavitated.any()
    assert around.pressure.max() > 1.5e5


def test_starved_inlet_stays_starved():
    gap = np.full((20, 6), H0)
    solved = solved_film(gap, spacing=1e-3, viscosity=ETA, speed=SPEED, rim_fraction=0.4)
    assert solved.fraction[1:-1, 1:-1] == pytest.approx(0.4)
    assert solved.load == 0.0
    full = solved_film(gap, spacing=1e-3, viscosity=ETA, speed=SPEED)
    assert full.fraction == pytest.approx(1)
    assert full.load == pytest.approx(0, abs=1e-6)


def test_walls_at_rest_under_a_pressure_difference():
    gap = np.full((11, 3), H0)
    film = np.ones(gap.shape, bool)
    film[[0, -1]] = False
    rim = np.zeros(gap.shape)
    rim[0] = 1e5
    solved = solved_film(gap, spacing=1e-3, viscosity=ETA, speed=0.0, mask=film, rim_pressure=rim)
    assert solved.pressure[:, 1] == pytest.approx(np.linspace(1e5, 0, 11))


def test_rolling_walls_entrain_what_sliding_twice_as_fast_does():
    gap = dimpled(24)
    given = {"spacing": LENGTH / 24, "viscosity": ETA}
    rolling = solved_film(gap, speed=0.0, upper_speed=-0.25, **given)
    sliding = solved_film(gap, speed=0.5, **given)
    assert rolling.pressure == pytest.approx(sliding.pressure)
    still = solved_film(gap, speed=0.5, upper_speed=0.25, **given)  # walls in opposition
    assert still.load == 0.0


def test_shear_flow_of_roughness_makes_a_wedge():
    # k p'' = V s' / 2 with s falling along x: p = -V s' x (L - x) / (4 k)
    cells, fall = 100, 2e-6
    place = np.linspace(0, LENGTH, cells + 1)
    flow = np.repeat((fall * (1 - place / LENGTH))[:, None], 3, axis=1)
    film = np.ones(flow.shape, bool)
    film[[0, -1]] = False
    solved = solved_film(
        np.full(flow.shape, H0),
        spacing=LENGTH / cells,
        viscosity=ETA,
        speed=SPEED,
        mask=film,
        shear_flow=flow,
        flow_factor=(0.8, 1.0),
    )
    k = 0.8 * H0**3 / (12 * ETA)
    exact = SPEED * fall / LENGTH / (4 * k) * place * (LENGTH - place)
    assert solved.pressure[:, 1] == pytest.approx(exact, abs=1e-9 * exact.max())


def test_liquid_travels_with_the_walls():
    """Without pressure the content moves at the walls' mean speed, and none is lost."""
    shape, spacing, step = (80, 4), 1e-3, 2e-3
    start = np.zeros(shape)
    start[10:20] = 0.6
    film = np.ones(shape, bool)
    film[[0, -1]] = False
    steps = film_in_time(
        lambda _: np.full(shape, H0),
        np.arange(41) * step,
        spacing=spacing,
        viscosity=ETA,
        speed=0.5,
        upper_speed=0.5,  # grid on the lower wall: liquid moves at V / 2
        mask=film,
        rim_fraction=0.0,
        start_fraction=start,
    )
    *_, last = steps
    place = np.arange(80) * spacing
    inside = last.content[:, 1]
    assert inside.sum() == pytest.approx(10 * 0.6 * H0, rel=1e-6)
    centre = (inside * place).sum() / inside.sum()
    assert centre == pytest.approx(14.5 * spacing + 0.25 * 80e-3, rel=1e-5)
    assert last.time == pytest.approx(0.08)
    assert last.load == 0.0


class OscillatingSqueeze:
    """Parallel plates, half length 1, h = 0.375 + 0.125 cos(4 pi t), ends at 0.025, 12 eta = 2.

    The pure-squeeze case of Ausas, Jai and Buscaglia (2009, J. Tribol. 131:031702; numbers from
    memory). The cavity opens from the middle, p = p' = 0 at its border b: 1 - b =
    (p0 h^3 / h')^(1/2). What ruptured at b keeps its liquid c(b); when the plates slow down the
    border returns at b' = -Q / (h - c), Q the inflow that p0 drives.
    """

    p0 = 0.025
    eta = 1 / 6

    def __init__(self):
        self.opens = brentq(lambda t: self.width(t) - 1, 0.25 + 1e-8, 0.3)
        self.turns = minimize_scalar(
            self.width, bounds=(0.26, 0.49), method="bounded", options={"xatol": 1e-12}
        ).x
        self.widest = 1 - self.width(self.turns)
        d = 1e-4
        bend = (
            self.width(self.turns + d) - 2 * self.width(self.turns) + self.width(self.turns - d)
        ) / d**2
        # close to the turn b_max - b = bend s^2 / 8: the equation is singular there
        self.soon = 2e-3
        self.bend = bend
        self.back = solve_ivp(
            self.border_speed,
            (self.turns + self.soon, 0.75),
            [self.widest - bend * self.soon**2 / 8],
            rtol=1e-8,
            atol=1e-10,
            events=[self.collapsing],
            dense_output=True,
        )
        self.collapse = float(self.back.t_events[0][0])

    @staticmethod
    def collapsing(_, b):
        return b[0] - 1e-3

    collapsing.terminal = True

    @staticmethod
    def gap(t):
        return 0.375 + 0.125 * math.cos(4 * math.pi * t)

    @staticmethod
    def rate(t):
        return -0.5 * math.pi * math.sin(4 * math.pi * t)

    def width(self, t):
        return math.sqrt(self.p0 * self.gap(t) ** 3 / (6 * self.eta * self.rate(t)))

    def content(self, b):
        if b <= 0:
            return self.gap(self.opens)
        return self.gap(brentq(lambda t: 1 - self.width(t) - b, self.opens, self.turns))

    def inflow(self, t, b):
        drive = self.p0 * self.gap(t) ** 3 / (12 * self.eta)
        return (drive - self.rate(t) * (1 - b) ** 2 / 2) / (1 - b)

    def border_speed(self, t, b):
        here = min(max(b[0], 0.0), self.widest)
        return [-self.inflow(t, here) / (self.gap(t) - self.content(here))]

    def border(self, t):
        if t <= self.turns:
            return max(1 - self.width(t), 0.0)
        if t < self.turns + self.soon:
            return self.widest - self.bend * (t - self.turns) ** 2 / 8
        return float(self.back.sol(t)[0])

    def load(self, t):
        b = self.border(t)
        inflow = self.inflow(t, b) if t > self.turns else 0.0
        g = 1 - b
        moment = self.rate(t) * g**3 / 6 + inflow * g**2 / 2
        return moment * 12 * self.eta / self.gap(t) ** 3


@pytest.fixture(scope="module")
def squeeze():
    return OscillatingSqueeze()


def squeezed(exact, cells, steps):
    """RMS errors of border and load until shortly before the collapse, and its time."""
    film = np.ones((cells + 1, 3), bool)
    film[-1] = False
    end = np.where(film, 1.0, np.inf)
    border, load, truth, collapse, leak = [], [], [], None, 0.0
    for now in film_in_time(
        lambda t: exact.gap(t) * end,
        np.linspace(0.25, 0.75, steps + 1),
        spacing=1 / cells,
        viscosity=exact.eta,
        speed=0.0,
        mask=film,
        rim_pressure=exact.p0,
    ):
        leak = max(leak, now.mass_residual)
        cavity = now.cavitated[:, 1].sum() / cells
        if 0.26 < now.time < 0.72:
            border.append(cavity - exact.border(now.time))
            load.append(now.load * cells / 3 - exact.load(now.time))
            truth.append(exact.load(now.time))
        if cavity == 0 and now.time > 0.5 and collapse is None:
            collapse = now.time
    relative = np.linalg.norm(load) / np.linalg.norm(truth)
    return float(np.sqrt(np.mean(np.square(border)))), float(relative), collapse, leak


def test_oscillating_squeeze_ruptures_reforms_and_collapses(squeeze):
    coarse = squeezed(squeeze, 50, 200)
    fine = squeezed(squeeze, 100, 400)
    finer = squeezed(squeeze, 200, 800)
    assert finer[0] < 0.003
    assert fine[1] < 0.6 * coarse[1]
    assert finer[1] < 0.6 * fine[1]
    assert finer[1] < 0.02
    assert finer[2] == pytest.approx(squeeze.collapse, abs=2 * 0.5 / 800)
    assert max(coarse[3], fine[3], finer[3]) < 1e-12


def test_step_keeps_the_volume():
    rng = np.random.default_rng(2)
    gap = H0 * (1 + rng.random((20, 30)))
    before = gap * rng.random(gap.shape) * 1.2
    solved = solved_film(
        gap, spacing=(1e-3, 5e-4), viscosity=ETA, speed=SPEED, before=before, time_step=1e-3
    )
    inner = (slice(1, -1), slice(1, -1))
    gained = (solved.content - before)[inner].sum() * 5e-7
    assert solved.cavitated.any()
    assert solved.load > 0
    assert gained == pytest.approx(-solved.rim_outflow * 1e-3, rel=1e-9)


def test_back_ends_agree():
    gap = dimpled(40)
    given = {"spacing": LENGTH / 40, "viscosity": ETA, "speed": SPEED}
    loads = [solved_film(gap, backend=b, **given).load for b in back_ends()]
    assert loads == pytest.approx([loads[0]] * len(loads), rel=1e-10)


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"viscosity": 0.0}, "viscosity"),
        ({"speed": math.nan}, "speed"),
        ({"upper_speed": math.inf}, "upper_speed"),
        ({"spacing": (1e-3, 0.0)}, "spacing"),
        ({"gap": np.zeros((5, 5))}, "gap"),
        ({"gap": np.full((5, 5), np.nan)}, "gap"),
        ({"gap": np.ones(5)}, "mask"),
        ({"flow_factor": (1.0, -1.0)}, "flow_factor"),
        ({"flow_factor": np.ones((2, 2))}, "flow_factor"),
        ({"shear_flow": math.nan}, "shear_flow"),
        ({"rim_pressure": -1.0}, "rim_pressure"),
        ({"rim_fraction": 1.5}, "rim_fraction"),
        ({"rim_fraction": 0.5, "rim_pressure": 1.0}, "rim_fraction"),
        ({"time_step": 1e-3}, "before"),
        ({"before": 1e-5}, "time_step"),
        ({"before": -1e-5, "time_step": 1e-3}, "before"),
        ({"before": 1e-5, "time_step": 0.0}, "time_step"),
        ({"mask": np.ones((5, 5), bool)}, "mask"),
    ],
)
def test_bad_input_is_refused(change, where):
    given = {"gap": np.full((5, 5), 1e-5), "spacing": 1e-3, "viscosity": 0.1, "speed": 0.5}
    given |= change
    with pytest.raises(InputError) as caught:
        solved_film(given.pop("gap"), **given)
    assert caught.value.where == where


@pytest.mark.parametrize("times", [[0.0], [0.0, 0.0], [1.0, 0.5]])
def test_times_must_rise(times):
    steps = film_in_time(
        lambda _: np.full((5, 5), 1e-5), times, spacing=1e-3, viscosity=0.1, speed=0.5
    )
    with pytest.raises(InputError, match="times"):
        next(steps)


@pytest.mark.parametrize(
    ("shape", "cells", "phase"),
    [("cosine", 320, 0.0), ("cosine", 512, 0.25), ("straight", 400, 0.0), ("straight", 512, 0.75)],
)
def test_a_film_that_forms_again_on_a_face_settles(shape, cells, phase):
    """Two wedges in a row: rupture between them, and a front that lies between two cells."""
    spacing = 0.04 / cells
    place = 2 * (np.arange(cells + 2) - 0.5 + phase) / cells
    if shape == "cosine":
        gap = 20e-6 * (1 + 0.6 * np.cos(2 * np.pi * place))
    else:
        gap = 15e-6 + 20e-6 * np.abs(2 * (place % 1) - 1)
    loads = []
    for wider in (1.0, 1.0 + 1e-7):  # the front lies next to the face there
        film = Film(
            np.repeat(wider * gap[:, None], 3, axis=1),
            spacing,
            viscosity=0.2,
            speed=0.7,
            mask=np.pad(np.ones((cells, 3), dtype=bool), ((1, 1), (0, 0))),
        )
        solved = film_pressure(film)
        assert solved.mass_residual < 1e-8
        assert solved.cavitated.any()
        loads.append(solved.load)
    assert loads[0] == pytest.approx(loads[1], rel=1e-5)
