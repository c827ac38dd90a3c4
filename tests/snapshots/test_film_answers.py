"""Films: closed forms, flow factors, regimes, operators on a grid and on faces, refusals."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from snapshot import held, refusal
from underfoot.core import InputError
from underfoot.film.face_operator import (
    FaceMatrix,
    Faces,
    Inlet,
    RowCavity,
    face_operator,
    leaning,
)
from underfoot.film.film_model import NewtonianFilm
from underfoot.film.operator import (
    Cavity,
    Conductance,
    Pattern,
    SparseLayout,
    Upwinding,
    divergence,
    film_operator,
    series_conductance,
    upwind_blend,
    upwinding,
)
from underfoot.film.pad_strike import Strike, touch_time
from underfoot.film.patir_cheng_1978 import (
    checked_anisotropy,
    patir_cheng_breaches,
    patir_cheng_mean_gap,
    patir_cheng_pressure_factors,
)
from underfoot.film.patir_cheng_1979 import patir_cheng_shear_factor, patir_cheng_shear_flow
from underfoot.film.pressure import Film, _finer, _halve_field, film_history, film_pressure
from underfoot.film.regimes import (
    compare_regimes,
    fluid_load_share,
    lubrication_by_lambda,
    lubrication_by_load_share,
    regime_map,
)
from underfoot.film.soft_ehl import (
    effective_modulus,
    film_regime,
    lambda_ratio,
    radius_of_parabola,
    soft_ehl,
)
from underfoot.film.squeeze_times import (
    rectangle_torsion_constant,
    squeeze_gap,
    squeeze_time_disc,
    squeeze_time_rectangle,
)
from underfoot.film.tapered_wedge import (
    side_leakage,
    tapered_wedge,
    wedge_film,
    wedge_load_factor,
)
from underfoot.film.wall_shear import wall_shear
from underfoot.rough_contact import ExponentialLaw

LAW = ExponentialLaw(2e6, 0.5, 4e-6)
BALL: dict[str, Any] = {"load": 10.0, "radius": 0.01, "effective_modulus": 1e7}
WEDGE: dict[str, Any] = {"viscosity": 0.1, "speed": 1.0, "length": 0.01, "width": 0.02}
PAD: dict[str, Any] = {"viscosity": 0.1, "load": 10.0, "start_gap": 1e-4}


def test_closed_forms(file_regression):
    gaps = np.array([1e-6, 5e-6, 2e-5, 1.1e-4])
    said: dict[str, Any] = {
        "newton": (NewtonianFilm(0.1).flow_factor(gaps, 0.3), NewtonianFilm(0.1).shear(0.3, gaps),
                   NewtonianFilm(0.1)),
        "ehl": soft_ehl(viscosity=[0.01, 0.1], speed=[0.0, 0.5], **BALL),
        "ehl of the report": soft_ehl(viscosity=0.1, speed=0.5, speed_is="sliding",
                                      ellipticity=3.0, **BALL),
        "far": soft_ehl(viscosity=10.0, speed=5.0, ellipticity=0.9, **BALL).breaches,
        "lambda": soft_ehl(viscosity=0.1, speed=0.5, **BALL).lambda_ratio(1e-6, 2e-6),
        "ratio": lambda_ratio([0.0, 1e-5], 3e-6, 0.0),
        "modulus": (effective_modulus(5e6), effective_modulus(5e6, 0.4)),
        "radius": radius_of_parabola(20.0),
        "regimes of films": [
            film_regime(viscosity=0.1, entrainment_speed=u, radius_ratio=a, pressure_viscosity=xi,
                        **BALL)
            for u in (1e-3, 50.0) for a in (1.0, 4.0) for xi in (0.0, 2e-8, 1e-5)
        ],
        "stiff": film_regime(viscosity=0.1, entrainment_speed=5.0, load=1.0, radius=0.01,
                             effective_modulus=2e11, pressure_viscosity=2e-8),
        "wedge": [tapered_wedge(leading_gap=h, trailing_gap=1e-4, **WEDGE)
                  for h in (1.01e-4, 2e-4, 1e-3)],
        "leak": [side_leakage(r, m) for r in (0.1, 1.0, 8.0) for m in (0.05, 1.19)],
        "film of a wedge": wedge_film(load=5.0, taper=1.2, **WEDGE),
        "factor": [wedge_load_factor(m) for m in (1e-3, 9.99e-3, 1e-2, 1.0, 1.189, 20.0)],
        "disc": squeeze_time_disc(radius=0.01, end_gap=[1e-5, 1e-4], **PAD),
        "rectangle": squeeze_time_rectangle(length=0.02, width=0.01, end_gap=1e-5, **PAD),
        "sinks": squeeze_gap([0.0, 0.1, 2.0], torsion_constant=1e-9, **PAD),
        "torsion": [rectangle_torsion_constant(a, b) for a, b in ((1, 1), (1, 3), (9, 1))],
    }  # fmt: skip
    held(file_regression, said)


def test_flow_factors_of_rough_walls(file_regression):
    gaps = np.array([1e-7, 1e-6, 3e-6, 9.9e-6, 1e-5, 1.01e-5, 4e-5])
    kinds = (1 / 9, 0.15, 1 / 3, 1.0, 2.0, 3.0, 5.0, 9.0)
    said = {
        "pressure": [patir_cheng_pressure_factors(gaps, 2e-6, anisotropy=g) for g in kinds],
        "shear": [patir_cheng_shear_factor(gaps, 2e-6, anisotropy=g) for g in kinds],
        "plain": (patir_cheng_pressure_factors(gaps, 2e-6), patir_cheng_shear_factor(gaps, 2e-6)),
        "gap": patir_cheng_mean_gap(gaps, 2e-6),
        "flow": patir_cheng_shear_flow(gaps, 2e-6, 1e-6, anisotropy_lower=3.0),
        "other": patir_cheng_shear_flow(gaps, 1e-6, 2e-6, anisotropy_upper=1 / 3),
        "smooth": patir_cheng_shear_flow(gaps, 0.0, 0.0),
        "ranges": [patir_cheng_breaches(h, 2e-6) for h in (0.99e-6, 1e-6)],
        "kinds": [checked_anisotropy(g) for g in (1 / 9, 9.0)],
    }
    held(file_regression, said)
    # equal walls carry nothing along
    assert np.abs(patir_cheng_shear_flow(gaps, 2e-6, 2e-6)).max() == 0.0


def test_regimes(file_regression):
    said = {
        "lambda": [lubrication_by_lambda(x) for x in (0.0, 0.999, 1.0, 3.0, 3.001)],
        "share": [lubrication_by_load_share(x) for x in (0.0, 0.0999, 0.1, 0.9, 0.9001, 1.0)],
        "compared": [compare_regimes(*x) for x in ((0.5, 0.5), (2.0, 0.5), (5.0, 0.05))],
        "agree": [compare_regimes(*x).agree for x in ((0.5, 0.5), (2.0, 0.5))],
        "carried": fluid_load_share([0.0, 1e-6, 1e-5, 1e-4], LAW, 1e5),
        "map": regime_map([0.01, 0.1], [0.1, 0.3, 1.0], rq_first=1e-6, rq_second=2e-6, law=LAW,
                          mean_pressure=1e5, speed_is="sliding", ellipticity=2.0, **BALL),
        "plain": regime_map(0.1, 0.3, rq_first=1e-6, rq_second=0.0, **BALL),
    }  # fmt: skip
    held(file_regression, said)


STRIKES = {
    "ribs": Strike(3e-3, 2e-3, 5e-3, 0.001),
    "thick": Strike(3e-3, 2e-3, 5e-3, 0.02),
    "wide": Strike(2e-3, 0.5e-3, 10e-3, 0.002, pool=4e-3, speed=0.3, load=60.0, mass=3.0),
    "afloat": Strike(1e-3, 1e-3, 60e-3, 5.0),
    "small": Strike(3e-3, 2e-3, 5e-3, 0.05, side=40e-3, density=1.3e3),
}


def test_pads_that_strike(file_regression):
    said = {name: (touch_time(one, LAW.pressure), one.land) for name, one in STRIKES.items()}
    held(file_regression, said)


def gap_of(shape: tuple[int, int] = (9, 8)) -> np.ndarray:
    x, y = np.meshgrid(np.linspace(-1, 1, shape[0]), np.linspace(-1, 1, shape[1]), indexing="ij")
    return 1e-5 * (1 + 3 * (x + 0.1 * y) ** 2)


def film(**changes: Any) -> Film:
    given = {"gap": gap_of(), "spacing": (1e-3, 1.5e-3), "viscosity": 0.1, "speed": 0.4}
    return Film(**(given | changes))


ONES = np.ones((9, 8))


def cell(field: np.ndarray, value: float, at: int = 3) -> np.ndarray:
    """Return a field with another value in one cell, of its rim where nothing else is said."""
    return np.where(np.arange(72).reshape(9, 8) == at, value, field)


FILMS: dict[str, dict[str, Any]] = {
    "plain": {},
    "back": {"speed": -0.4, "spacing": 1e-3},
    "fed": {"rim_pressure": 2e4, "upper_speed": 0.1},
    "starved": {"rim_fraction": 0.4},
    "rough": {"flow_factor": (0.7, 1.2), "shear_flow": 2e-6},
    "one factor": {"flow_factor": 0.5},
    "still": {"speed": 0.0, "rim_pressure": 1e4 * np.arange(72.0).reshape(9, 8)},
    "odd": {"gap": gap_of((7, 12))},
    "open": {"gap": np.where(np.arange(9)[:, None] > 6, np.inf, gap_of())
             , "mask": np.pad(np.ones((5, 6), bool), ((1, 3), (1, 1)))},
}  # fmt: skip


def test_films_between_walls(file_regression):
    said: dict[str, Any] = {}
    for name, changes in FILMS.items():
        made = film_pressure(film(**changes))
        said[name] = made.pressure, made.fraction, made.cavitated, made.load
        said[f"{name}, leaves"] = round(made.rim_outflow, 16) + 0.0  # 0 but for rounding
        said[f"{name}, solved"] = made.iterations, made.time, made.gap, made.content
        assert made.mass_residual < 1e-9
    step = film_pressure(film(), before=0.9 * gap_of(), time_step=1e-3)
    said["step"] = step.pressure, step.fraction, step.time
    told: list[Any] = []
    history = list(
        film_history(
            film(), lambda t: gap_of() * (1 - 20 * t), [0.0, 1e-3, 3e-3], start_fraction=0.8,
            progress=lambda stage, share, _=None: told.append((stage, share)),
        )
    )  # fmt: skip
    said["history"] = [(one.pressure, one.fraction, one.time, one.load) for one in history]
    said["told"] = told
    whole = [one.load for one in film_history(film(), lambda _: gap_of(), [0.0, 1.0])]
    said["begins full"] = whole
    rng = np.random.default_rng(5)
    field = rng.random((5, 6))
    said["coarse"] = [_halve_field(field, axes) for axes in ((0,), (1,), (0, 1), ())]
    said["fine"] = [_finer(field, shape) for shape in ((9, 12), (10, 6), (5, 11))]
    held(file_regression, said)


def test_shear_of_walls(file_regression):
    pressure = 1e4 * np.arange(12.0).reshape(4, 3) ** 1.5
    gap = np.array(np.broadcast_to(1e-5 * np.arange(1, 4), (4, 3)))
    gap[3, 2] = np.inf
    given: dict[str, Any] = {"spacing": 1e-3, "viscosity": 0.1, "speed": 0.3}
    said: dict[str, Any] = {
        "full": wall_shear(pressure, gap, **given),
        "streamers": wall_shear(pressure, gap, fraction=0.3 * np.ones((4, 3)), **given),
    }
    flat = np.ones((4, 3))
    said["refused"] = [
        refusal(wall_shear, flat, np.ones((3, 4)), **given),
        refusal(wall_shear, np.ones(4), np.ones(4), **given),
        refusal(wall_shear, flat, flat, fraction=np.ones(3), **given),
        refusal(wall_shear, np.ones((1, 3)), np.ones((1, 3)), **given),
        refusal(wall_shear, np.nan * flat, flat, **given),
        refusal(wall_shear, flat, 0 * flat, **given),
        refusal(wall_shear, flat, flat, **(given | {"speed": math.inf})),
        refusal(wall_shear, flat, flat, **(given | {"spacing": 0.0})),
    ]
    held(file_regression, said)


def conductance(gap: np.ndarray, before: np.ndarray | None = None) -> Conductance:
    seen = gap if before is None else 0.5 * (gap + before)
    return Conductance(seen**3 / 1.2, seen**2 / 0.4)


def test_the_operator_on_a_grid(file_regression):
    rng = np.random.default_rng(7)
    gap = 1e-5 * np.exp(rng.normal(size=(6, 5)))
    pressure, fraction = 1e5 * rng.random((6, 5)), rng.random((6, 5))
    mask = np.zeros((6, 5), bool)
    mask[1:5, 1:4] = True
    pattern = Pattern(mask)
    lean = Upwinding(rng.random((5, 5)), 1e-6 * rng.normal(size=(5, 5)))
    said: dict[str, Any] = {}
    for name, more in {
        "forward": {"speed": 0.3},
        "back": {"speed": -0.3, "storage": 1e-4, "upwinding": lean},
        "still": {"speed": 0.0, "roughness_flow": 1e-6 * rng.normal(size=(6, 5))},
        "lean": {"speed": 0.3, "upwinding": lean,
                 "edges": (rng.random((5, 5)), rng.random((6, 4)))},
    }.items():  # fmt: skip
        made = film_operator(gap, conductance(gap), conductance(gap), spacing=(1e-3, 2e-3), **more)
        said[name] = (
            made.by_pressure, made.by_fraction, made.by_gap(pressure, fraction),
            made.flows(pressure, fraction), made.wall_transport(fraction),
            made.imbalance(pressure, fraction, 0.5 * gap), made.imbalance(pressure, fraction),
            made.kx, made.ky, made.carry,
        )  # fmt: skip
    made = film_operator(gap, conductance(gap), conductance(gap), spacing=(1e-3, 2e-3), speed=-0.3)
    rows = pattern.rows_of(made.by_fraction)
    cavity = Cavity(pattern, rows, np.arange(12) % 4 > 0)
    said |= {
        "filled": cavity.filled_by(np.linspace(0, 1e-8, 12)),
        "cells": (pattern.cells, pattern.columns, pattern.beside, pattern.along, pattern.size),
        "gathered": (pattern.gather(gap), pattern.scatter(np.arange(12)), pattern.neighbours_of(
            np.arange(12.0), outside=-3.0), pattern.neighbours_of(np.arange(12))),
        "matrix": pattern.matrix(rows).toarray(),
        "pair": pattern.pair.matrix(np.concatenate([rows, 2 * rows])).toarray(),
        "layout": SparseLayout(np.array([[1, 0], [1, 2]]), np.array([[0, -1], [2, 1]]), (3, 3))
        .matrix(np.array([[1.0, 2.0], [3.0, 4.0]])).toarray(),
        "divergence": divergence(rng.random((5, 5)), rng.random((6, 4))),
        "series": series_conductance(*rng.random((4, 3)), 0.3),
        "halves": series_conductance(*rng.random((4, 3))),
        "upwinding": [upwinding(gap, 1e-9 * gap**0, conductance(gap).value * 1e3, from_a=way)
                      for way in (True, False)],
    }  # fmt: skip
    a, b = np.array([1e-5, 1e-5, 1e-5, 4e-5]), np.array([1.1e-5, 2e-5, 4e-5, 1e-5])
    shear = series_conductance(a, b, 0 * a, 0 * b)
    weights = Upwinding(np.full(4, 0.5), np.full(4, 1e-6))
    for way in (True, False):
        said[f"blend {way}"] = upwind_blend(a, b, shear, weights, from_a=way)
        said[f"steps {way}"] = upwind_blend(
            a, b, shear, weights, from_a=way, steps=np.array([True, False, True, True])
        )
    held(file_regression, said)
    none = np.zeros((5, 12))
    with pytest.raises(np.linalg.LinAlgError, match="neither holds nor passes"):
        Cavity(pattern, none, np.ones(12, bool))


def test_the_operator_on_faces(file_regression):
    rng = np.random.default_rng(46)
    along = np.array([0, 1, 3, 4]), np.array([1, 2, 4, 5])
    across = np.array([0, 1, 2]), np.array([3, 4, 5])
    cells = Faces(
        6, 5, 1e-3, *along, rng.uniform(0.5, 1.5, 4), rng.uniform(0.2, 0.8, 4),
        rng.uniform(0.2, 0.8, (2, 4)), rng.uniform(-5e-6, 5e-6, (2, 4)), *across,
        rng.uniform(0.3, 1.0, 3), rng.uniform(0.3, 0.7, 3),
    )  # fmt: skip
    gap, before = rng.uniform(3e-5, 9e-5, 6), rng.uniform(3e-5, 9e-5, 6)
    pressure, fraction = rng.uniform(0, 1e4, 6), rng.uniform(0.4, 1.0, 6)
    lean = Upwinding(rng.random(4), 1e-6 * rng.normal(size=4))
    inlet = Inlet(rng.uniform(1e-5, 4e-5, 4), rng.random(4), rng.random(4))
    said: dict[str, Any] = {
        "layout": cells.layout, "faces": (cells.ahead, cells.behind, cells.face_to_east),
        "divergence": cells.divergence(np.arange(1.0, 8.0)),
    }  # fmt: skip
    for name, more in {
        "forward": {"speed": 0.3, "before": None},
        "back": {"speed": -0.3, "before": before, "storage": 2e-4, "upstream": lean},
        "edges": {"speed": 0.3, "before": None, "upstream": lean, "inlet": inlet},
        "bounded": {"speed": 0.3, "before": None, "limits": (4e-5, 7e-5)},
    }.items():
        made = face_operator(cells, gap, conductance, **{"limits": (1e-9, 1.0), **more})
        said[name] = (
            made.gap, made.kx, made.ky, made.carry, made.by_pressure.coefficients,
            made.by_fraction.coefficients, made.by_gap(pressure, fraction).coefficients,
            made.wall_transport(fraction), made.imbalance(pressure, fraction, 1e-5),
        )  # fmt: skip
        matrix: FaceMatrix = made.by_pressure
        said[f"{name}, matrix"] = (
            matrix.matrix().toarray(), matrix.sums(), matrix.columns(gap).coefficients,
            matrix.rows(gap).coefficients, matrix.plus(matrix.rows(gap)).coefficients,
        )  # fmt: skip
    both = np.concatenate([matrix.coefficients, 2 * matrix.coefficients])
    said["pair"] = cells.pair.matrix(both).toarray()
    whole = Faces(**({name: getattr(cells, name) for name in cells.__dataclass_fields__}
                     | {"size": 6}))  # fmt: skip
    for speed in (0.3, -0.3):
        made = face_operator(
            whole, gap, conductance, before=None, limits=(1e-9, 1.0), speed=speed, storage=1e-7
        )
        for touched in ([1, 1, 0, 1, 1, 1], [0, 0, 0, 0, 0, 1], [0] * 6):
            cavity = RowCavity(made.by_fraction, np.array(touched, bool))
            said[f"cavity {speed} {touched}"] = cavity.filled_by(np.linspace(1e-9, 1e-8, 6))
    for backward in (True, False):
        said[f"leaning {backward}"] = leaning(
            cells, gap, rng.uniform(0.5, 1.5, 6), np.full(6, 1e-13), conductance(gap).value,
            backward=backward,
        )  # fmt: skip
        said[f"rising {backward}"] = leaning(
            cells, np.array([1.0, 2, 4, 1, 3, 4]) * 1e-5, np.ones(6), np.full(6, 1e-13),
            conductance(gap).value, backward=backward,
        )  # fmt: skip
    held(file_regression, said)


REFUSED: dict[str, Callable[[], Any]] = {
    "half a step": lambda: film_pressure(film(), before=gap_of()),
    "no liquid": lambda: film_pressure(film(), time_step=1.0),
    "no time": lambda: film_pressure(film(), before=gap_of(), time_step=0.0),
    "below 0": lambda: film_pressure(film(), before=-gap_of(), time_step=1.0),
    "shape before": lambda: film_pressure(film(), before=np.ones(3), time_step=1.0),
    "falling times": lambda: next(film_history(film(), lambda _: gap_of(), [1.0, 0.5])),
    "one time": lambda: next(film_history(film(), lambda _: gap_of(), [1.0])),
    "start": lambda: next(
        film_history(film(), lambda _: gap_of(), [0.0, 1.0], start_fraction=1.1)),
    "gap": lambda: film_pressure(film(gap=0 * gap_of())),
    "nan": lambda: film_pressure(film(gap=np.nan * gap_of())),
    "flat": lambda: film_pressure(film(gap=np.ones(5))),
    "mask": lambda: film_pressure(film(mask=np.ones((9, 8), bool))),
    "no mask": lambda: film_pressure(film(mask=np.zeros((9, 8), bool))),
    "shape of mask": lambda: film_pressure(film(mask=np.ones((3, 8), bool))),
    "spacing": lambda: film_pressure(film(spacing=(1e-3, 0.0))),
    "viscosity": lambda: film_pressure(film(viscosity=0.0)),
    "speed": lambda: film_pressure(film(speed=math.nan)),
    "upper": lambda: film_pressure(film(upper_speed=math.inf)),
    "factor": lambda: film_pressure(film(flow_factor=(1.0, 0.0))),
    "shape of factor": lambda: film_pressure(film(flow_factor=np.ones(3))),
    "flow": lambda: film_pressure(film(shear_flow=math.nan)),
    "rim": lambda: film_pressure(film(rim_pressure=-1.0)),
    "fraction": lambda: film_pressure(film(rim_fraction=1.01)),
    "low fraction": lambda: film_pressure(film(rim_fraction=-0.01)),
    "starved": lambda: film_pressure(film(rim_fraction=0.5, rim_pressure=1.0)),
    "one gap": lambda: film_pressure(film(gap=cell(gap_of(), 0.0, 27))),
    "one lost gap": lambda: film_pressure(film(gap=cell(gap_of(), np.nan))),
    "one factor": lambda: film_pressure(film(flow_factor=(cell(ONES, 0.0), 1.0))),
    "one factor across": lambda: film_pressure(film(flow_factor=(1.0, cell(ONES, 0.0)))),
    "one rim": lambda: film_pressure(film(rim_pressure=cell(ONES, -1.0))),
    "one fraction": lambda: film_pressure(film(rim_fraction=cell(ONES, 1.01))),
    "one starved": lambda: film_pressure(
        film(rim_fraction=cell(ONES, 0.5), rim_pressure=cell(0 * ONES, 1.0))),
    "backend": lambda: film_pressure(film(), backend="none such"),
    "speed is": lambda: soft_ehl(viscosity=0.1, speed=0.5, speed_is="slidin", **BALL),
    "no speed": lambda: soft_ehl(viscosity=0.1, speed=-0.5, **BALL),
    "smooth": lambda: lambda_ratio(1e-6, 0.0, 0.0),
    "poisson": lambda: effective_modulus(1e6, 0.6),
    "taper": lambda: wedge_load_factor(0.0),
    "widens": lambda: tapered_wedge(leading_gap=1e-4, trailing_gap=1e-4, **WEDGE),
    "rises": lambda: squeeze_time_disc(radius=0.01, end_gap=1.1e-4, **PAD),
    "before": lambda: squeeze_gap(-1.0, torsion_constant=1e-9, **PAD),
    "lambda": lambda: lubrication_by_lambda(-0.1),
    "share": lambda: lubrication_by_load_share(1.01),
    "law": lambda: regime_map(0.1, 0.3, rq_first=1e-6, rq_second=0.0, law=LAW, **BALL),
    "pressure": lambda: regime_map(
        0.1, 0.3, rq_first=1e-6, rq_second=0.0, mean_pressure=1e5, **BALL),
    "flat grooves": lambda: checked_anisotropy(0.11),
    "long grooves": lambda: checked_anisotropy(9.1),
    "strike": lambda: touch_time(Strike(3e-3, 2e-3, 5e-3, 0.0), LAW.pressure),
    "no rib": lambda: touch_time(Strike(3e-3, 2e-3, 0.0, 0.1), LAW.pressure),
}  # fmt: skip


def test_what_is_refused(file_regression):
    held(file_regression, {name: refusal(call) for name, call in REFUSED.items()})


def test_one_place_that_is_not_possible_is_refused():
    """Not only where all are."""
    with pytest.raises(InputError, match="the pad would have to rise"):
        squeeze_time_disc(radius=0.01, end_gap=[1e-5, 2.0], **PAD)
    before = gap_of()
    before[0, 0] = -1e-9
    with pytest.raises(InputError, match="the liquid before the step is negative"):
        film_pressure(film(), before=before, time_step=1e-3)
