"""Study G.4: the arithmetic on made-up readings, and the command."""

import json
import math

import numpy as np
import pytest

from commands import called
from underfoot.core import SourcedValue, Status
from underfoot.core.catalogue import Catalogue
from underfoot.questions.outcomes import CaseOutcome
from underfoot.studies import g4, judge, study
from underfoot.studies.g4 import GridReading, conditions, inputs_of, threshold, variance_p

PLAN = conditions()
X, Y = np.arange(0.0, 0.06, 0.7e-3), np.linspace(-0.03, 0.03, 7)
UNITS = {
    "cof": "1", "fluid_load": "N", "fluid_load_sensor": "N", "peak_fluid_pressure_sensor": "Pa",
}  # fmt: skip
PRINTED = {"work": (201.0, 234e3, 0.020), "athletic": (83.0, 214e3, 0.027)}
SPACINGS = (1e-3, 0.6e-3, 0.42e-3)


def outcome(load, peak=1e3, status=Status.CONVERGED, **more):
    values = {"cof": 0.1, "fluid_load": 2 * load, "fluid_load_sensor": load,
              "peak_fluid_pressure_sensor": peak, **more}  # fmt: skip
    scalars = {
        name: SourcedValue(value, UNITS[name], source="made up", uncertainty=0.01)
        for name, value in values.items()
    }
    return CaseOutcome("made up", "h", scalars, {}, status, "finer grid", (), (), 1.0)


def made_up(
    condition, load, peak=1e3, place=(0.020, 0.0), status=Status.CONVERGED, factors=(1, 1, 1)
):
    levels = tuple(
        (h, outcome(load * f, peak * f, status)) for h, f in zip(SPACINGS, factors, strict=True)
    )
    spread = (X[:, None] - place[0]) ** 2 + (Y[None, :] - place[1]) ** 2
    pressure = peak * np.exp(-spread / 0.005**2)
    return GridReading(condition, levels, X, Y, pressure, np.zeros((4, 2)), {})


def as_printed(condition, **given):
    if condition.untreaded and condition.fluid == "glycerol":
        load, peak, x = PRINTED[condition.kind]
        return made_up(condition, load, peak, (x, 0.0), **given)
    return made_up(condition, 1.0, **given)


DEPTHS = [(0.0, outcome(200.0)), (1e-3, outcome(1.0)), (3e-3, outcome(1.0))]


def said(readings, depths=DEPTHS):
    by = {one.condition.path: one for one in readings}
    found = g4.quantities(by, depths)
    return {s.id: judge(s, found) for s in study("g4").statements}


def test_statements_print_what_the_catalogue_holds():
    """Two transcriptions of G.4.2: that of the statements and that of the catalogue."""
    entry = Catalogue.load().entry("published", "slip_tester_g4")
    statements = {one.id: one for one in study("g4").statements}
    for kind in ("work", "athletic"):
        for name, key, unit in (("load", "fluid_load", "N"), ("peak", "peak_pressure", "Pa")):
            value = entry.sourced_value(f"{key}_{kind}_shoe_untreaded_glycerol", unit).value
            accepted = statements[f"{name}_{kind}"].accepted
            assert accepted == pytest.approx((0.85 * value, 1.15 * value))
    bounds = {one.accepted for one in statements.values() if one.id.startswith("below")}
    assert bounds == {(-math.inf, entry.sourced_value("fluid_load_all_others_below", "N").value)}


def test_one_set_of_assumptions_for_all():
    """Nothing but what Table 6 prints, the fluid, and the arc channel differs between cases."""
    heels = {repr(one.case.shoe.heel) for one in PLAN}
    others = {repr((one.case.interface, one.case.motion, one.case.shoe.sole)) for one in PLAN}
    assert len(heels) == len(others) == 1


def test_cases_are_those_of_the_examples():
    from pathlib import Path

    from underfoot import Case

    folder = Path(__file__).parents[2] / "examples"
    for one in (PLAN[0], PLAN[9]):
        path = folder / f"{one.kind}_shoe_{one.tread}_{one.fluid}.toml"
        assert Case.load(path).hash == one.case.hash


def test_all_open_inputs_where_the_film_is_read():
    untreaded, treaded = PLAN[0], PLAN[2]
    assert {one.path for one in inputs_of(treaded)} == {
        "shoe.heel.facet_angle",
        "interface.roughness_beyond_cutoff",
        "shoe.tread.lug_width",
    }
    assert {"shoe.heel.width", "shoe.heel.facet_length", "contaminant.viscosity"} <= {
        one.path for one in inputs_of(untreaded)
    }


def test_the_reports_own_numbers_agree():
    found = said([as_printed(one) for one in PLAN])
    # p stays above 0.01 even for the report's own loads; two statements print no number
    assert {one.statement.id for one in found.values() if one.verdict != "agrees"} == {
        "centre_work", "side_athletic", "regions_athletic", "p_tread", "p_fluid", "p_interaction",
    }  # fmt: skip


def test_wrong_sides_and_sizes_disagree():
    readings = [made_up(one, 3.0 if one.untreaded and one.fluid == "glycerol" else 50.0,
                        place=(0.010, 0.0)) for one in PLAN]  # fmt: skip
    found = said(readings)
    sides = [one.verdict for name, one in found.items() if name.startswith("below")]
    assert sides == ["disagrees"] * 10
    for name in ("load_work", "peak_athletic", "viscosity_work", "place_work", "place_athletic"):
        assert found[name].verdict == "disagrees", name


def test_a_reading_more_likely_on_the_other_side_does_not_agree():
    """2.7 N with 60 % of its draws at 100 N: inside 5 N, and more likely outside."""
    from dataclasses import replace

    readings = [as_printed(one) for one in PLAN]
    thin = next(i for i, one in enumerate(PLAN) if one.path == "work.untreaded.detergent")
    draws = {"fluid_load_sensor": np.repeat([2.7, 100.0], [400, 600])}
    readings[thin] = replace(made_up(PLAN[thin], 2.7), draws=draws)
    found = said(readings)["below_work_untreaded_detergent"]
    assert found.verdict == "undecided"  # 2.7 to 100 N is twenty times the bound
    assert found.probability == pytest.approx(0.4, abs=0.01)


def test_a_peak_that_passes_on_a_coarse_grid_alone_does_not_agree():
    readings = [as_printed(one, factors=(1.0, 1.2, 1.5)) if one.untreaded else as_printed(one)
                for one in PLAN]  # fmt: skip
    found = said(readings)
    assert found["peak_athletic"].verdict == "not converged"
    assert found["load_work"].verdict == "not converged"


def test_a_case_without_result_is_no_number():
    readings = [as_printed(one) for one in PLAN]
    readings[0] = as_printed(PLAN[0], status=Status.NOT_CONVERGED)
    found = said(readings)
    assert found["load_work"].verdict == "not converged"
    assert found["load_work"].ours == "-"
    assert found["p_tread"].verdict == "not converged"


def test_threshold_lies_between_two_depths():
    rows = [(d * 1e-3, outcome(load)) for d, load in ((0, 90.0), (0.3, 20.0), (0.5, 2.0))]
    assert threshold(rows) == pytest.approx((0.3e-3, 0.5e-3))
    assert threshold([*rows, (1e-3, outcome(8.0))]) is None


def test_highest_reading_ahead_of_the_arc_channel():
    ahead = made_up(PLAN[6], 83.0, 200e3, (0.03, 0.0))
    assert PLAN[6].path == "athletic.untreaded.glycerol"
    assert ahead.place[0] == pytest.approx(0.03, abs=0.4e-3)
    # arc channel: 20 mm from the back on the centre line, radius 30 mm
    assert g4.channel_at(ahead, 0.0) == pytest.approx(0.020)
    assert g4.channel_at(ahead, 0.018) == pytest.approx(0.020 + 0.030 - 0.024)


def test_printed_p_values_need_more_than_the_printed_loads():
    """Two shoes as repeats: F = 5.8 for tread (2, 6), by hand."""
    from scipy.stats import f

    loads = [PRINTED[one.kind][0] if one.untreaded and one.fluid == "glycerol" else 0.0
             for one in PLAN]  # fmt: skip
    found = variance_p(PLAN, loads)
    within = 2 * 59.0**2 / 6
    between = 4 * (2 * (71.0 / 3) ** 2 + (142.0 / 3) ** 2) / 2
    assert found["tread"] == pytest.approx(float(f.sf(between / within, 2, 6)))
    assert 0.01 < found["tread"] < 0.05


def test_figures_of_made_up_readings():
    from underfoot.report.study_figures import draw_figure

    readings = [as_printed(one) for one in PLAN]
    loads = draw_figure(g4.load_figure(readings))
    assert loads.axes[0].patches[0].get_height() == pytest.approx(201.0)
    maps = draw_figure(g4.map_figure([readings[0], readings[6]]))
    assert maps.axes[0].get_title().startswith("work shoe: 201 N, peak 234 kPa")
    left, right = maps.axes[0].get_xlim()
    assert left > right  # left of the shoe on the left
    rows = g4.map_figure([readings[0]]).rows()
    assert max(row[3] for row in rows if row[1].startswith("map")) == pytest.approx(234.0, rel=0.01)


def test_options_of_other_studies_are_refused():
    done = called("studies", "run", "g4", "--explicit")
    assert done.returncode == 2
    assert "--explicit" in done.stderr


@pytest.mark.study
def test_the_quick_study_by_command(tmp_path, monkeypatch):
    """One coarse grid: values of every condition, and no verdict that a grid enters."""
    of_the_study = g4.ShoeInFluid.case.func

    def coarser(one):
        grid = "2 mm" if one.untreaded else "1.2 mm"  # two cells a channel
        return of_the_study(one).replace(
            {"numerics.quick_grid_spacing": grid, "numerics.tread_positions": 1}
        )

    monkeypatch.setattr(g4.ShoeInFluid, "case", property(coarser))
    out = tmp_path / "g4"
    done = called("studies", "run", "g4", "--quick", "--json", "--out", out)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    verdicts = {one["statement"]: one["verdict"] for one in found["statements"]}
    by_grid = {verdicts["g4.load_athletic"], verdicts["g4.peak_work"]}
    assert by_grid <= {"overlaps", "undecided", "not converged"}
    values = {name: q["values"] for name, q in found["quantities"].items()}
    treaded = [v[0] for name, v in values.items() if "tread." in name and name.endswith(".load")]
    assert len(treaded) == 8
    assert max(treaded) < 1.0  # N: a 10 mm inlet always overlaps a channel
    names = {path.name for path in out.iterdir()}
    assert {"fig29_maps.png", "fig30_loads.png", "tread_depth.png", "verdicts.csv"} <= names
