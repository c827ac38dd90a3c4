"""What grid, positions and steps in time leave open: its size, in spread, words and draws."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute import numerical_error
from underfoot.compute.numbers import GRID_NAMES
from underfoot.compute.numerical_error import (
    IN_TIME,
    NumericalErrors,
    errors_by_steps,
    with_numerical_error,
)
from underfoot.compute.position_draws import ShoeAngles, TreadPlace
from underfoot.compute.positions import remembers, tread_positions
from underfoot.compute.run import run
from underfoot.compute.solve import solved_motion
from underfoot.core import SourcedValue, Status
from underfoot.friction.sampled_cof import LawDraws, SampledCof

EXAMPLES = Path(__file__).parents[2] / "examples"
COARSE = {"numerics.grid_spacing": "2 mm", "numerics.quick_grid_spacing": "3 mm"}
CHECKED = {**COARSE, "numerics.tread_positions": 1, "numerics.grid_check": True}


def test_the_error_joins_spread_and_interval_and_is_told():
    values = {
        "cof": SourcedValue(0.04, uncertainty=0.003, interval=(0.036, 0.05)),
        "fluid_load": SourcedValue(100.0, "N", uncertainty=30.0, interval=(50.0, 160.0)),
        "fluid_load_sensor": SourcedValue(40.0, "N", source="s", uncertainty=5.0, note="tracks"),
        "normal_force": SourcedValue(1e9, "N"),
        "peak_fluid_pressure": SourcedValue(2e5, "Pa", reason="not known"),
        "peak_fluid_pressure_sensor": SourcedValue(0.0, "Pa", uncertainty=0.0),
    }
    errors = NumericalErrors(
        dict(zip(GRID_NAMES, (0.003, 40.0, 12.0, 3e4, 0.0), strict=True)),
        dict(zip(GRID_NAMES, (0.0, 0.0, 0.0, 4e4, 0.0), strict=True)),
        "difference to cells of 1 mm",
    )
    found = errors.widen_numbers(values)
    assert found["cof"].interval == values["cof"].interval  # its draws hold the error
    assert found["fluid_load"].uncertainty == pytest.approx(50.0)
    low, high = found["fluid_load"].interval
    assert 0 < low < 50.0
    assert math.log(high / 100) == pytest.approx(math.hypot(math.log(1.6), 1.96 * 0.4))
    pressed = values | {"normal_force": SourcedValue(200.0, "N")}
    assert 160.0 < errors.widen_numbers(pressed)["fluid_load"].interval[1] < 200.0
    assert found["fluid_load_sensor"].uncertainty == pytest.approx(13.0)
    assert "tracks; numerical error 12 N" in found["fluid_load_sensor"].note
    assert found["peak_fluid_pressure"].uncertainty == pytest.approx(5e4)
    assert found["peak_fluid_pressure"].reason == ""
    words = errors.sentence(found)
    assert "fluid load ± 40 N" in words
    assert "difference to cells of 1 mm" in words
    assert "steps in time: cof ± 0" in words


def test_draws_of_cof_carry_the_error_and_two_soles_do_not_share_it():
    parts = {name: np.full(4000, 0.04) for name in ("adhesion", "hysteresis", "viscous")}
    sampled = SampledCof(
        cof=np.full(4000, 0.12),
        **parts,
        share={},
        left_out=(),
        confidence=0.95,
        seed=0,
        contact=np.full(4000, 0.5),
        law=LawDraws(*np.ones((3, 4000))),
    )
    first, again, other = (
        with_numerical_error(sampled, 0.012, cof=0.12, sole=sole) for sole in ("a", "a", "b")
    )
    assert np.std(first.cof) == pytest.approx(0.012, rel=0.05)
    assert first.cof == pytest.approx(first.adhesion + first.hysteresis + first.viscous)
    assert first.share == {"numerical": 1.0}
    assert (first.cof == again.cof).all()
    assert abs(np.corrcoef(first.cof, other.cof)[0, 1]) < 0.05
    assert with_numerical_error(sampled, 0.0, cof=0.12, sole="a") is sampled
    wide = with_numerical_error(sampled, 0.5, cof=0.12, sole="a")  # twice the contact is all
    assert (wide.adhesion + wide.hysteresis).max() == pytest.approx(2 * 0.08)
    assert wide.contact.max() == pytest.approx(1.0)


@pytest.mark.slow
@pytest.mark.parametrize("quick_grid", ["3 mm", "3.2 mm"])
def test_a_grid_is_not_compared_with_itself(quick_grid):
    """The difference of a grid to its like is 0: an error of a tenth of the truth was printed."""
    case = Case.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(
        {
            "numerics.grid_spacing": "3 mm",
            "numerics.quick_grid_spacing": quick_grid,
            "shoe.heel.profile.length": "30 mm",  # with 45 mm it nearly floats on 3 mm
        }
    )
    cells = {"numerics.cells_along": 2, "numerics.grid_check": True}
    found = run(case.replace(cells))
    alone = run(case.replace({**cells, "numerics.quick_grid_spacing": "3 mm"}), quick=True)
    finer = run(case.replace({**cells, "numerics.grid_spacing": "1.5 mm"}))
    for name in ("cof", "fluid_load"):
        assert found[name].numerical == pytest.approx(alone[name].numerical), name
        off = abs(found.value(name) - finer.value(name))
        assert off < 3 * found[name].numerical, name  # a heel that nearly floats
    assert "difference" not in found.labels["grid_error"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["untreaded_glycerol", "full_tread_dry"])
def test_every_run_tells_its_numerical_error(name):
    grid = COARSE if "untreaded" in name else {"numerics.grid_spacing": "1.2 mm"}  # of its lugs
    case = Case.load(EXAMPLES / f"work_shoe_{name}.toml").replace(grid)
    result = run(case)
    words, cof = result.labels["grid_error"], result.scalars["cof"]
    if "untreaded" in name:  # a corner of the sole is resolved, and compared with the quick grid
        assert "difference to cells of 3 mm, 8 along the sliding" in words
        assert result.scalars["fluid_load"].interval is not None
    else:
        assert "6 positions of the tread, and finer grids" in words
    assert "numerical error" in cof.note


def test_a_grid_check_looks_at_finer_cells_and_steps():
    case = Case.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(CHECKED)
    words = run(case).labels["grid_error"]
    assert "cells of 3 mm, 16 along the sliding" in words
    assert "steps in time" in words


def test_a_march_that_does_not_converge_leaves_the_error_unknown(monkeypatch):
    def fails_with_more_steps(*given, finer=1, **options):
        contact = solved_motion(*given, finer=finer, **options)
        return replace(contact, status=Status.NOT_CONVERGED) if finer > 1 else contact

    monkeypatch.setattr("underfoot.compute.solve.solved_motion", fails_with_more_steps)
    case = Case.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(CHECKED)
    assert run(case).labels["grid_error"].startswith("not estimated: a march on cells of 3 mm")


def test_the_error_by_steps_is_that_of_the_first_order(monkeypatch):
    """Numbers 5 + 0.4 / n with n times the steps are 0.4 off with one times."""
    parts = SimpleNamespace(case=Case.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml"),
                            viscosity=0.2, sole=None)  # fmt: skip

    def at(here, place, spacing, *, progress=None):
        return here, SimpleNamespace(steps=place.finer, status=Status.CONVERGED)

    monkeypatch.setattr(numerical_error, "solved_at", at)
    monkeypatch.setattr(numerical_error, "_read", lambda _, one: {"cof": 5 + 0.4 / one.steps})
    monkeypatch.setattr(numerical_error, "cells_along", lambda *_: 1)
    found = numerical_error._grid_differences(parts, {"cof": 5.7}, lambda *_: None)
    assert found.steps["cof"] == pytest.approx(0.4)
    assert found.grid["cof"] == pytest.approx(0.3)


def test_a_motion_that_ends_has_the_error_of_its_steps_from_twice_as_many():
    """Numbers a (1 + 0.1 / n) with n times the steps: what is left of one times is a tenth."""
    parts = {"cof_adhesion": 0.05, "cof_hysteresis": 0.03, "cof_viscous": 0.02}
    whole = {**parts, "cof": 0.1, "contact_load": 300.0, "peak_fluid_pressure": 1e5}

    def with_steps(n):
        moved = {name: value * (1 + 0.1 / n) for name, value in whole.items()}
        return {**moved, "contact_load": 300.0, "fluid_load": 100.0 * (1 + 0.1 / n)}

    own, finer = with_steps(1), with_steps(2)
    at = {name: np.full(3, value) for name, value in own.items()}
    steady = ShoeAngles((TreadPlace(),) * 3, at, 0, own)
    names, force = ("cof", "fluid_load", "peak_fluid_pressure"), 410.0
    assert errors_by_steps(steady, names, force) == {}
    ended = replace(steady, in_time=(own, finer))
    found = errors_by_steps(ended, names, force)
    left = 0.1 / 1.1  # of the numbers with one times
    peak = math.hypot(left, IN_TIME) * at["peak_fluid_pressure"][0]
    assert found["peak_fluid_pressure"] == pytest.approx(peak)
    share = 110 / force
    film = share * (1 - share) * force
    assert found["fluid_load"] == pytest.approx(
        film * math.hypot(2 * math.log(1.1 / 1.05), IN_TIME)
    )
    solid = own["cof_adhesion"] + own["cof_hysteresis"]
    assert found["cof"] == pytest.approx(math.hypot(left * own["cof"], IN_TIME * share * solid))
    unmoved = errors_by_steps(replace(steady, in_time=(own, own)), names, force)
    assert unmoved["fluid_load"] == pytest.approx(film * IN_TIME)  # no error vanishes by accident
    assert unmoved["cof"] > 0


@pytest.mark.parametrize(
    ("changes", "marched"),
    [({}, False), ({"motion.duration": "0.12 s"}, True), ({"motion": "heel_strike_to_flat"}, True)],
)
def test_only_a_motion_that_ends_is_marched_with_more_steps(changes, marched):
    case = Case.load(EXAMPLES / "work_shoe_untreaded_glycerol.toml").replace(changes)
    own = {"cof": 0.1, "fluid_load": 100.0, "contact_load": 300.0,
           **dict.fromkeys(("cof_adhesion", "cof_hysteresis", "cof_viscous"), 0.03)}  # fmt: skip
    asked = []

    def at_places(places):
        asked.extend(places)
        return ((k, own) for k in range(len(places)))

    spacing = case.numerics.grid_spacing
    made = tread_positions(case, {TreadPlace(): own}, at_places, spacing=spacing, quick=False)
    finer = (TreadPlace(finer=2), case.numerics.quick_grid_spacing)
    assert (finer in asked) == marched
    assert made.in_time == ((own, own) if marched else ())
    assert all(place.finer == 1 for place in made.places)
    assert not remembers(case.replace("contaminant", "none"))
