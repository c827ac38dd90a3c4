"""Figures of the report as they are drawn: every line, area, scale and text of small answers."""

import dataclasses
from typing import Any

import numpy as np
import pytest
import xarray

from figure_lines import figure_lines
from small_soles import fake, sole
from snapshot import held, refusal
from underfoot.core import SourcedValue
from underfoot.core.fields import from_xarray
from underfoot.explore.effects import Effects
from underfoot.film import regime_map
from underfoot.friction import StribeckLaw
from underfoot.material import RelaxationSpectrum
from underfoot.report import chart, compound, design_study, laws, places, slips, study_figures
from underfoot.report.common_grid import common_grid, on_grid, sole_on_grid
from underfoot.report.dispatch import figures, named_figure
from underfoot.report.maps import comparison_figure, grid_note, map_figure, overview_figure
from underfoot.report.outsole import outsole_figure
from underfoot.report.quantities import (
    DrawnQuantity,
    carried_load,
    drawn_values,
    inside,
    quantities,
    scale,
)
from underfoot.report.question_figures import contact_figure, sensitivity_figure, wear_figure
from underfoot.report.regime_figure import regime_figure
from underfoot.report.results import history_chart, history_figure
from underfoot.rough_contact import ExponentialLaw
from underfoot.shoe import Heel, Tread, heel_surface
from underfoot.shoe.tread_measures import tread_measures
from underfoot.slip import ReportG6, slip_risk
from underfoot.slip.dynamics import FloorSensors
from underfoot.studies.figure import Figure as FigureData
from underfoot.studies.figure import Layer, Panel

PEAKED = np.where(np.arange(250).reshape(25, 10) == 120, 9e6, 1e5)
SOLES = {
    "bars": sole(),
    "long, many sensors": sole(side=8e-3, long=0.27, sensors=14),
    "shifted and finer": sole(side=3e-3, shift=1.5e-3, factor=1.6, sensors=0),
    "twice the pressure": sole(factor=2.0, sensors=0),
    "peaked": sole(contact_pressure=(PEAKED, "Pa", "a peak"), sensors=5),
    "nothing": sole(contact_pressure=(np.zeros((25, 10)), "Pa", "none")),
}


@pytest.mark.parametrize("name", ["bars", "long, many sensors", "peaked", "nothing"])
def test_maps_of_a_sole(file_regression, name):
    data = SOLES[name]
    shown = quantities([data])
    held(
        file_regression,
        {
            "quantities": shown,
            "inside": inside(data).sum(),
            "loads": {each.name: carried_load(data, each) for each in shown},
            "scales": {each.name: scale([drawn_values(data, each)], each) for each in shown},
            "drawn": figure_lines(
                overview_figure(data)
                if name == "bars"
                else map_figure(data, shown[name != "peaked"])
            ),
        },
    )


@pytest.mark.parametrize(
    "names",
    [("bars", "twice the pressure"), ("shifted and finer", "bars", "nothing")],
)
def test_maps_of_several_soles(file_regression, names):
    datasets = [SOLES[name] for name in names]
    shown, grid = quantities(datasets), common_grid(datasets)
    drawn = {q.name: figure_lines(comparison_figure(datasets, q)) for q in shown[:3:2]}
    held(
        file_regression,
        {
            "note": grid_note(datasets), "grid": grid,
            "covered": [sole_on_grid(each, grid).sum(axis=1) for each in datasets],
            "on grid": [on_grid(each, shown[0], grid) for each in datasets], "drawn": drawn,
        },
    )  # fmt: skip


def test_loads_over_time(file_regression):
    time = np.array([0.0, 0.01, 0.02, 0.04])
    numbers = {
        "load_history": [0.0, 300.0, 500.0, 480.0], "fluid_load_history": [0.0, 90.0, np.nan, 40.0],
        "cof_history": [0.4, 0.3, 0.2, 0.1], "contact_area_history": [0, 1e-4, 3e-4, 2e-4],
        "centre_of_pressure_history": [0.01, 0.02, 0.03, 0.05],
    }  # fmt: skip
    told = {}
    for kind, names in (("march", list(numbers)[:2]), ("history", list(numbers)), ("one", ["cof"])):
        made = {name: ("time", np.array(numbers[name])) for name in names if name in numbers}
        data = xarray.Dataset(made, coords={"time": time})
        if kind == "history":
            data = data.assign_coords(picture_time=np.array([0.0, 0.02]))
        result = fake(data=from_xarray(data))
        if kind != "one":
            told[kind] = [history_chart(result), figure_lines(history_figure(result))]
    held(file_regression, told)


def test_charts(file_regression):
    lines = [("a & b", [0.0, 0.5, 1.0]), ("<c>", [1.0, np.nan, 0.25])]
    held(
        file_regression,
        {
            "two": chart.line_chart([0, 1, 2], lines, "time < 2", "COF & more"),
            "one": chart.line_chart([0.0, 30.0], [("load", [0.0, 0.0])], "t", "N"),
            "ticks": {str(most): chart._ticks(most)
                      for most in (-1.0, 0.0, 0.04, 0.3, 1.0, 1.01, 4.0, 5.0, 7.0, 9.99, 20.0,
                                   24.0, 26.0, 99.0, 101.0, 510.0)},
        },
    )  # fmt: skip


def wear_series(mode, count, untreaded=None):
    states = np.arange(1.0, count + 1)
    measured = {"worn_patch_area": 1e-4 * states, "removed_depth": 1e-3 * (states - 1),
                "tread_left": 1e-3 * (count - states)}  # fmt: skip
    scales = {"fluid_load": 20.0, "fluid_load_sensor": 10.0, "peak_fluid_pressure": 5e4,
              "peak_fluid_pressure_sensor": 3e4, "cof": 0.05}  # fmt: skip
    return fake(
        mode=mode, wear_measures=measured.__getitem__, limit=75.5, untreaded=untreaded,
        values=lambda name: scales[name] * states,
        ends=lambda name: (0.9 * scales[name] * states, 1.2 * scales[name] * states),
        curve=lambda name: scales[name] * np.append(states, states[-1] / 2),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("mode", "count", "bare"), [("patch", 3, None), ("plane", 9, 1), ("thickness", 4, None)]
)
def test_wear_over_its_states(file_regression, mode, count, bare):
    held(file_regression, figure_lines(wear_figure(wear_series(mode, count, bare))))


def effect(path, low, high, unit, values):
    ends = [fake(number=lambda name, v=v: v * (1e3 if name == "peak" else 1)) for v in values]
    return fake(path=path, low_value=low, high_value=high, unit=unit, low=ends[0], high=ends[1])


def test_sensitivity(file_regression):
    effects = [
        effect(
            f"shoe.part_{k}.a_{k}_name", 1e-3 * k, 2e-3 * k, "m", (0.2 - 0.01 * k, 0.3 + 0.02 * k)
        )
        for k in range(1, 8)
    ]
    effects.append(effect("motion.speed", 0.1, 0.2, "m/s", (np.nan, 0.4)))
    units = {"cof": "1", "load": "N", "peak": "Pa"}
    nominal = fake(
        name="A case", scalars={name: fake(unit=unit) for name, unit in units.items()},
        number=lambda name: 250.0 if name == "peak" else 0.25,
    )  # fmt: skip
    shown = fake(nominal=nominal, ranked_effects=lambda name: effects[::-1],
                 band=lambda name: fake(value=0.25, deviation=0.03))  # fmt: skip
    held(file_regression, figure_lines(sensitivity_figure(shown, [(n, n.upper()) for n in units])))


@pytest.mark.parametrize("touching", ["some", "all", "none"])
def test_a_rough_contact(file_regression, touching):
    heights = 1e-6 * np.sin(np.arange(24.0)).reshape(4, 6)
    where = {"some": heights > 0, "all": heights < 1, "none": heights > 1}[touching]
    contact = fake(pressure=np.where(where, 3e6 * (2 + heights * 1e6), 0.0),
                   gap=np.where(where, 0.0, 1e-6 - heights))  # fmt: skip
    title = "" if touching == "none" else "A contact"
    held(file_regression, figure_lines(contact_figure(heights, 2e-6, contact, title)))


def test_laws_and_tables(file_regression):
    law = StribeckLaw(SourcedValue(0.5), SourcedValue(0.2, "m/s"), SourcedValue(0.1))
    table = fake(
        pressure=np.geomspace(1e4, 1e6, 9), speed=np.array([0.1, 1.0]),
        values={name: np.arange(18.0).reshape(9, 2) * scale for name, scale in
                (("real_contact_fraction", 0.01), ("cof_hysteresis", 0.02), ("mean_gap", 1e-6))},
        deviation={name: np.where(np.arange(18).reshape(9, 2) > 2, 1e-7, np.nan) for name in
                   ("real_contact_fraction", "cof_hysteresis", "mean_gap")},
    )  # fmt: skip
    contact = fake(pressure=np.arange(6.0).reshape(3, 2) * 1e6, gap=np.ones((3, 2)) * 1e-6)
    drawn = {
        "friction": law, "gap": ExponentialLaw(3e6, 0.5, 4e-6), "model": ReportG6(),
        "risk": slip_risk(SourcedValue(0.2, uncertainty=0.02)),
        "bare risk": dataclasses.replace(slip_risk(SourcedValue(0.2)), low=None, high=None),
        "spectrum": RelaxationSpectrum(1e6, [2e6, 1e6], [1e-2, 1.0]),
        "elastic": RelaxationSpectrum(1e6, [], []),
    }  # fmt: skip
    told = {name: figure_lines(named_figure(figures(one), "kind")) for name, one in drawn.items()}
    for name, draw, shown in (
        ("table", laws._contact_table, table), ("sliding", laws._steady_sliding, contact),
    ):  # fmt: skip
        figure = laws.new_figure(9.6, 3.4)
        draw(shown, figure)
        told[name] = figure_lines(figure)
    told["makers"] = {name: list(figures(one)) for name, one in drawn.items()}
    told["refused"] = [
        refusal(named_figure, figures(law), "law", "coff"), refusal(named_figure, {}, "Thing"),
    ]  # fmt: skip
    held(file_regression, told)


def a_compound():
    time = np.array([0.1, 1.0, 10.0, 100.0])
    spectrum = RelaxationSpectrum(1e6, [2e6, 1e6], [1e-2, 1.0])
    sweep = fake(angular_frequency=2 * np.pi * time, storage_modulus=1e6 * (2 + time),
                 loss_modulus=1e5 * (1 + np.sqrt(time)))  # fmt: skip
    band = lambda w: fake(loss_low=0.8e6 * w, loss_high=1.3e6 * w)  # noqa: E731
    law = type("Law", (), {"log10_shift_factor": lambda _, kelvin: 0.1 * (293.15 - kelvin),
                           "__str__": lambda _: "the law"})  # fmt: skip
    shifts = fake(temperatures=np.array([273.15, 293.15, 313.15]), law=law(),
                  log10_shift_factors=np.array([2.0, 0.0, -1.9]), log10_errors=np.full(3, 0.2)
                  )  # fmt: skip
    tests = [
        fake(name=f"test {k}", reading=fake(
            time=time, force=k * time, force_2_percent=SourcedValue(k),
            peak_force=SourcedValue(2 * k), final_force=SourcedValue(0.7)))
        for k in (1, 2)
    ]  # fmt: skip
    return fake(sweep=sweep, fit=fake(spectrum=spectrum, band=band), spectrum=spectrum,
                relaxation=fake(time=time, modulus=1e6 * (3 - np.log10(time))), shifts=shifts,
                compressions=tests)  # fmt: skip


def test_a_compound(file_regression):
    shown = a_compound()
    told = {name: figure_lines(make()) for name, make in compound._(shown).items()}
    alone = fake(**vars(shown) | {"sweep": None})
    told["relaxation alone"] = figure_lines(compound._relaxation(alone))["axes 0"]["legend"]
    told["makers"] = list(compound._(fake(**vars(alone) | {"compressions": [], "shifts": None})))
    held(file_regression, told)


@pytest.mark.parametrize("wet", [True, False])
def test_a_slip(file_regression, monkeypatch, wet):
    time = np.linspace(0, 0.2, 11)
    walker = fake(landing=0.02, lateral=0.01, name="the median")
    motion = fake(walker=walker, time=time, distance=0.6 * time, speed=2 * time, normal=500 - time,
                  fluid_load=300 * time, drive=90 + time, friction=40 - time,
                  shoe_angle=0.3 - time)  # fmt: skip
    walkers = [fake(motion=fake(time=time, speed=k * time)) for k in range(1, 7 if wet else 4)]
    run = fake(profile_x=1e-3 * np.arange(4), profiles=np.arange(44.0).reshape(11, 4) * 1e-6,
               maps=1e3 * np.arange(11 * slips.MAP_X.size * slips.MAP_Y.size, dtype=float)
               .reshape(11, slips.MAP_X.size, slips.MAP_Y.size))  # fmt: skip
    study = fake(
        setting=fake(viscosity=0.2 if wet else None, settings=fake(pool_depth=1e-3)),
        representative=run if wet else None, array=FloorSensors(2, 2), subjects=walkers,
    )  # fmt: skip
    pulse = np.where(time < 0.1, 1e3, 0.0)[:, None, None] * (1.0 + np.arange(4).reshape(2, 2))
    monkeypatch.setattr(slips, "shown_motion", lambda _: motion)
    monkeypatch.setattr(slips, "array_pressures", lambda *_: pulse)
    moving = slips.animation_data(study)
    moving |= {name: np.array(moving[name]) for name in ("films", "pressures") if wet}
    told = {"figure": figure_lines(slips.slip_figure(study)), "moving": moving}
    if wet:
        still = fake(**vars(study) | {"array": FloorSensors(1, 1)})
        monkeypatch.setattr(slips, "array_pressures", lambda *_: 0 * pulse[:, :1, :1])
        told["one sensor that reads nothing"] = figure_lines(slips.slip_figure(still))
    held(file_regression, told)


def test_regimes(file_regression):
    speed, viscosity = np.geomspace(0.05, 1.0, 4), np.geomspace(1e-3, 1.0, 5)[::-1]
    pin = {"load": 20.9, "radius": 23.3e-3, "effective_modulus": 2.0e6, "rq_first": 8.2e-6,
           "rq_second": 1.34e-6}  # fmt: skip
    plain = regime_map(viscosity, speed, **pin)
    law = ExponentialLaw(2e6, 0.5, 8.3e-6)
    share = regime_map(viscosity, speed, **pin, law=law, mean_pressure=266e3)
    thin = regime_map(np.array([1e-6, 2e-6]), speed, **pin)
    held(
        file_regression,
        {
            "plain": figure_lines(regime_figure(plain)),
            "named": figure_lines(regime_figure(share, {"oil": 74.6e-3, "thin": 2e-3}, "Pin")),
            "below all limits": figure_lines(regime_figure(thin)),
            "refused": [refusal(regime_figure, plain, {"honey": 10.0}),
                        refusal(regime_figure, plain, {"gas": 1e-5}),
                        refusal(regime_figure, regime_map(viscosity, [0.1], **pin))],
        },
    )  # fmt: skip


def test_figures_of_a_design_study(file_regression):
    dimensions = [
        fake(path="shoe.tread.depth", value=lambda share: 1e-3 + 3e-3 * share),
        fake(path="shoe.tread.pattern", value=lambda share: "grid" if share < 0.5 else "bars"),
    ]
    models = [
        fake(dimensions=dimensions, name=name, unit=unit, q2=q2,
             runs=fake(values=np.array([size, -2 * size])),
             prediction=lambda points: (points @ [1.0, 2.0], 0.1 + 0 * points[:, 0]))
        for name, unit, q2, size in (("cof", "1", 0.98, 0.2), ("peak", "Pa", 0.5, 3e5))
    ]  # fmt: skip
    goals = [fake(phrase="largest cof", unit="1"), fake(phrase="least load", unit="N")]
    values = {k: np.array([0.1 * k, 50.0 - k]) for k in range(5)}
    result = fake(plan=fake(goals=goals), shown=[0, 1, 2, 3, 4], front=[1, 4],
                  goal_estimates=lambda each, goals: (np.array([values[k] for k in each]), None),
                  meets_requirements=lambda each: np.array([k != 2 for k in each]))  # fmt: skip
    numbers = [np.array(row) for row in ((0.1, 0.5, 0.2), (0.01, 0.02, np.nan), (0.3, 0.6, 0.4),
                                         (0.05, 0.04, 0.03))]  # fmt: skip
    indices = {
        kind: Effects("cof", "N", kind, ("shoe.a", "motion.b", "floor.c"), *numbers, "15 runs")
        for kind in ("sobol", "morris")
    }
    told = {name: figure_lines(design_study.effects_figure(one)) for name, one in indices.items()}
    told["slices"] = figure_lines(design_study.slices_figure(models, np.array([0.2, 0.6])))
    alone = [
        fake(
            **vars(models[1])
            | {
                "dimensions": dimensions[:1],
                "prediction": lambda points: (points[:, 0], points[:, 0]),
            }
        )
    ]
    told["one slice"] = figure_lines(design_study.slices_figure(alone, np.array([0.5])))
    told["front"] = figure_lines(design_study.front_figure(result))
    told["chances"] = [design_study._chance(one) for one in (None, 0.0, 0.004, 0.5, 0.996, 1.0)]
    held(file_regression, told)


def test_figures_of_published_studies(file_regression):
    marks = [
        Layer("line", [0, 1], [2, 3], label="l", colour="#112233", marker="s", style="--"),
        Layer("outline", [0, 1, 1], [0, 0, 1], colour="#112233"),
        Layer("points", [1, 2], [5, 6], low=[4, 5.5], high=[7, 6.1], label="p", marker="s"),
        Layer("points", [1, 2], [5, 6], marker="o"),
        Layer("bars", [0, 1], [2, 3], low=[1, 2], high=[3, 5], width=0.4, label="b"),
        Layer("bars", [0, 1], [2, 3]),
        Layer("across", [2, 3], [0, 1], width=0.5, label="a"),
        Layer("band", [0, 1], low=[1, 2], high=[3, 5]),
        Layer("level", y=[0.3, 0.4], label="level"), Layer("limit", x=[0.6], style=":"),
        Layer("span", low=[1], high=[2], style="horizontal"), Layer("span", low=[1], high=[2]),
    ]  # fmt: skip
    grids = [Layer("map", [0, 1, 2], [0, 1], z=np.array([[0, 1], [2, 3], [4, k]])) for k in (5, 9)]
    stack = [Layer("stack", [0, 1], [k, 2], label=f"s{k}", colour="#445566") for k in (1, 3)]
    panels = [Panel([layer], "x", "y", layer.mark) for layer in marks]
    odd = [
        Panel(stack, "speed", "COF", legend="best", x_scale="log", x_limits=(0.1, 1.0)),
        Panel([marks[0]], y_scale="symlog", y_limits=(-1, 5), x_ticks=["one", "a name of its own"],
              y_ticks=[0.5, 2.0], legend=""),
        Panel([], note="nothing"), Panel([marks[4]], x_ticks=["twelve chars", "b"], y_ticks=["c"]),
    ]  # fmt: skip
    shown = {
        "marks": FigureData(panels, "All", columns=4, size=(2.0, 1.5)),
        "maps": FigureData([Panel([grid]) for grid in grids], columns=2, colour_bar="kPa"),
        "odd": FigureData(odd, columns=2, share_x=False, share_y=True, legend_below=True),
        "many": FigureData(
            [Panel([Layer("line", [0, 1], [0, k], label=f"l{k}") for k in range(7)])],
            legend_below=True,
        ),
    }
    held(file_regression, {k: figure_lines(study_figures.draw_figure(v)) for k, v in shown.items()})


@pytest.mark.parametrize("count", [2, 3])
def test_friction_of_fluids_over_speed(file_regression, count):
    speed = np.array([0.01, 0.1, 1.0])
    curves: Any = [
        fake(
            speed=speed, viscosity=0.05 * (k + 1), label=f"fluid {k}", pair=f"pair {k}",
            parts={"adhesion": 0.3 - 0.1 * speed, "hysteresis": 0.05 + 0 * speed,
                   "viscous": 0.02 * speed * (k + 1)},
            interval=(0.2 + 0 * speed, 0.5 + 0.1 * speed) if k == 0 and count == 3 else None,
            points=None if k == 0 else (np.array([0.2, 0.4]), np.array([0.31, 0.29])),
        )
        for k in range(count)
    ]  # fmt: skip
    held(
        file_regression, figure_lines(study_figures.stribeck_figure(curves, "Fluids"[: 3 * count]))
    )


def test_shoes_of_a_place(file_regression):
    shoes = [fake(best=best, shoe=fake(name=name), slips=SourcedValue(value, interval=ends))
             for name, best, value, ends in (("one", 0.7, 0.1, (0.05, 0.2)),
                                             ("two", 0.2, 0.4, (0.0, 0.9)),
                                             ("three", 0.1, 0.3, (0.2, 0.5)))]  # fmt: skip
    held(file_regression, figure_lines(places.slips_figure(fake(shoes=shoes))))


@pytest.mark.parametrize("pattern", ["grid", "none"])
def test_an_outsole(file_regression, pattern):
    tread = Tread("grid", lug_width=8e-3, channel_width=4e-3, depth=3e-3)
    heel = Heel(length=0.05, width=0.04, rear_radius=0.015, outsole_thickness=0.02,
                **({"tread": tread} if pattern == "grid" else {}))  # fmt: skip
    surface = heel_surface(heel, spacing=1e-3)
    held(file_regression, figure_lines(outsole_figure(surface, tread_measures(surface))))


def test_a_quantity_that_is_odd(file_regression):
    """Values at the limits from which a scale is cut, a stress is none, or a unit changes."""
    plain = DrawnQuantity("p", "P", 1.0, "Pa", stress=True)
    log = DrawnQuantity("f", "F", 1.0, "m", logarithmic=True)
    usual = np.append(np.ones(999), 0.0)
    peaks = {peak: scale([np.append(usual, peak)], plain) for peak in (1.0, 1.49, 1.51, 3.01)}
    told: dict[str, Any] = {f"peak of {peak}": [one, one.cut] for peak, one in peaks.items()}
    told |= {f"log of {top}": scale([np.array([1.0, top, -1.0])], log) for top in (0.5, 1.005, 2.0)}
    told["negative"] = scale([np.array([-2.0, 1.0]), np.array([0.5])], plain)
    named = {
        f"of {size:g}": quantities([sole(heat=(np.full((25, 10), size), unit, ""))])[3:-1]
        for size, unit in ((1e-9, "m"), (3e-4, "m"), (2e7, "Pa"), (1.0, "K*m^3"), (-1.0, "m^2"))
    }
    held(file_regression, {"scales": told, "named": named})
