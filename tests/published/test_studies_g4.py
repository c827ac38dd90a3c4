"""Study G.4: the arithmetic on made-up readings, and the command as a process."""

import json
import math
import os
import subprocess
import sys

import numpy as np
import pytest

from underfoot.assess.outcomes import Outcome
from underfoot.core import SourcedValue, Status
from underfoot.studies.g4_conditions import DepthRow, Reading, conditions, inputs_of
from underfoot.studies.g4_judged import Banded, against, grid_factor, judged, right_side
from underfoot.studies.g4_lines import all_lines, split, threshold, variance_p
from underfoot.studies.verdict import Verdict

PLAN = conditions()
X, Y = np.arange(0.0, 0.06, 0.7e-3), np.linspace(-0.03, 0.03, 7)
COMMAND = [sys.executable, "-c", "from underfoot.cli import main; main()"]
UNITS = {
    "cof": "1", "fluid_load": "N", "fluid_load_sensor": "N", "peak_fluid_pressure_sensor": "Pa",
}  # fmt: skip


def made_up(condition, load, peak=100e3, place=(0.020, 0.0), status=Status.CONVERGED):
    values = {"cof": 0.1, "fluid_load": 2 * load, "fluid_load_sensor": load,
              "peak_fluid_pressure_sensor": peak}  # fmt: skip
    scalars = {
        name: SourcedValue(value, UNITS[name], source="made up", uncertainty=0.01)
        for name, value in values.items()
    }
    spread = (X[:, None] - place[0]) ** 2 + (Y[None, :] - place[1]) ** 2
    outcome = Outcome(condition.name, "h", scalars, {}, status, "finer grid", (), (), 1.0)
    pressure = peak * np.exp(-spread / 0.005**2)
    reading = Reading(condition, outcome, X, Y, pressure, np.zeros((4, 2)), 1.0)
    return judged(reading, None, refinement=1.0)


def as_printed(condition):
    load = 1.0 if condition.printed_load is None else condition.printed_load
    return made_up(condition, load, condition.printed_peak or 1e3, (0.027, 0.0))


def test_twelve_conditions_two_of_them_printed():
    assert len(PLAN) == 12
    printed = {one.name: (one.printed_load, one.printed_peak) for one in PLAN if one.printed_load}
    assert printed == {
        "work, untreaded, glycerol": (201.0, 234e3),
        "athletic, untreaded, glycerol": (83.0, 214e3),
    }


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
        "shoe.heel.facet_angle", "interface.roughness_beyond_cutoff", "motion.start_film",
        "shoe.tread.lug_width",
    }  # fmt: skip
    assert {"shoe.heel.width", "shoe.heel.facet_length", "contaminant.viscosity"} <= {
        one.path for one in inputs_of(untreaded)
    }


def test_the_reports_own_numbers_are_reproduced():
    depths = [DepthRow(d, load, 100.0, 1e3, 0.1) for d, load in ((0, 200), (1e-3, 1), (3e-3, 1))]
    lines = all_lines([as_printed(one) for one in PLAN], depths)
    found = {line.quantity: line.verdict for line in lines}
    sides = [verdict for name, verdict in found.items() if name.startswith("side of 5 N")]
    assert sides == [Verdict.REPRODUCED] * 12
    assert found["fluid load: work, untreaded, glycerol"] is Verdict.REPRODUCED
    assert found["peak pressure: athletic, untreaded, glycerol"] is Verdict.REPRODUCED
    assert found["threshold of tread depth"] is Verdict.REPRODUCED
    assert found["place of the peak: athletic shoe"] is Verdict.REPRODUCED
    assert found["side of the peak: athletic shoe"] is Verdict.NOT_AVAILABLE


def test_wrong_sides_and_sizes_are_said():
    results = [
        made_up(one, 50.0 if one.printed_load is None else 3.0, place=(0.010, 0.0)) for one in PLAN
    ]
    found = {line.quantity: line.verdict for line in all_lines(results, [])}
    sides = [verdict for name, verdict in found.items() if name.startswith("side of 5 N")]
    assert sides == [Verdict.DISAGREES] * 12
    assert found["fluid load: work, untreaded, glycerol"] is Verdict.DISAGREES
    assert found["load falls with viscosity, no tread"] is Verdict.DISAGREES
    assert found["place of the peak: athletic shoe"] is Verdict.DISAGREES


def test_a_case_without_result_is_no_number():
    results = [as_printed(one) for one in PLAN]
    results[0] = made_up(PLAN[0], 201.0, status=Status.NOT_CONVERGED)
    lines = all_lines(results, [])
    found = {line.quantity: line for line in lines}
    assert found["side of 5 N: work, untreaded, glycerol"].verdict is Verdict.NOT_AVAILABLE
    assert found["side of 5 N: work, untreaded, glycerol"].ours == "-"
    assert not any(line.quantity.startswith("analysis") for line in lines)


@pytest.mark.parametrize(
    ("value", "verdict"),
    [
        (Banded(250.0, math.nan, math.nan), Verdict.REPRODUCED),
        (Banded(270.0, 250.0, 300.0), Verdict.WITHIN_SCATTER),
        (Banded(300.0, 280.0, 320.0), Verdict.TREND_ONLY),
        (Banded(math.nan, math.nan, math.nan), Verdict.NOT_AVAILABLE),
    ],
)
def test_verdict_against_a_printed_load(value, verdict):
    assert against(201.0, 0.30, value, right=True) is verdict


def test_sides_of_five_newton():
    assert right_side(4.9, printed=None)
    assert not right_side(5.1, printed=None)
    assert right_side(5.1, printed=83.0)
    assert not right_side(math.nan, printed=83.0)


def test_grid_factor_of_first_order_error():
    """N(h) = N_0 exp(c h): the factor from 1 and 0.5 mm is the one that 0.5 mm still lacks."""
    at = {h: 10.0 * math.exp(0.4 * h) for h in (1.0, 0.5)}
    assert grid_factor(at[0.5], at[1.0], 2.0, 0.01) == pytest.approx(at[0.5] / 10.0)
    assert grid_factor(3.0, 5.0, 1.0, 0.01) == 1.0


def test_threshold_lies_between_two_depths():
    rows = [DepthRow(d * 1e-3, load, 0.0, 0.0, 0.1) for d, load in ((0, 90), (0.3, 20), (0.5, 2))]
    assert threshold(rows) == pytest.approx((0.3e-3, 0.5e-3))
    assert threshold([*rows, DepthRow(1e-3, 8.0, 0, 0, 0.1)]) is None


def test_before_and_behind_the_arc_channel():
    one = made_up(PLAN[6], 83.0, 200e3, (0.03, 0.0))
    ahead, behind = split(one, 0.020, 0.030)
    assert ahead == pytest.approx(200e3, rel=0.01)
    assert behind < 0.1 * ahead


def test_printed_p_values_need_more_than_the_printed_loads():
    """Two shoes as repeats: F = 5.8 for tread (2, 6), by hand."""
    from scipy.stats import f

    results = [as_printed(one) for one in PLAN]
    found = variance_p(results, [one.condition.printed_load or 0.0 for one in results])
    within = 2 * 59.0**2 / 6
    between = 4 * (2 * (71.0 / 3) ** 2 + (142.0 / 3) ** 2) / 2
    assert found["tread"] == pytest.approx(float(f.sf(between / within, 2, 6)))
    assert 0.01 < found["tread"] < 0.05


def test_figures_of_made_up_readings():
    from underfoot.document.g4_figures import g4_figures

    depths = [DepthRow(d * 1e-3, 100 - 50 * d, 200 - 50 * d, 1e5, 0.1) for d in (0.0, 1.0, 2.0)]
    made = g4_figures({"results": [as_printed(o) for o in PLAN], "varied": {}, "depths": depths})
    assert set(made) == {"fig29", "fig30", "tread_depth"}
    bars = made["fig30"].axes[0].patches
    assert bars[0].get_height() == pytest.approx(201.0)
    assert made["fig29"].axes[0].get_title().startswith("work shoe, untreaded\n201 N")


def test_options_of_other_studies_are_refused_as_a_process():
    done = subprocess.run(
        [*COMMAND, "studies", "run", "g4", "--explicit"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert "--explicit" in done.stderr


@pytest.mark.slow
def test_the_quick_study_as_a_process(tmp_path):
    """All twelve on the right side; loads within 30 %; files for each figure."""
    out = tmp_path / "g4"
    done = subprocess.run(
        [*COMMAND, "studies", "run", "g4", "--quick", "--json",
         "--out", str(out)],
        capture_output=True, text=True, check=False,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    sides = [line for line in found["lines"] if line["quantity"].startswith("side of 5 N")]
    assert [line["verdict"] for line in sides] == ["reproduced"] * 12
    loads = [line for line in found["lines"] if line["quantity"].startswith("fluid load")]
    assert [line["verdict"] for line in loads] == ["reproduced"] * 2
    names = {path.name for path in out.iterdir()}
    assert {"fig29.png", "fig30.png", "tread_depth.png", "verdicts.csv", "study.json"} <= names
