"""Parameters of a case from readings: made of known values, they come back."""

from pathlib import Path

import numpy as np
import pytest

from underfoot.core import InputError, to_si
from underfoot.explore import Study, posterior
from underfoot.explore.record import Ending, Record
from underfoot.explore.store import Store
from underfoot.explore.study_file import read_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
TEXT = """\
base = "work_shoe_untreaded_glycerol.toml"
[uncertain]
"interface.roughness_beyond_cutoff" = { lognormal = 2.0, factor = 1.4 }
"shoe.material.shore_a" = { normal = 58, sd = 4 }
[[reading]]
fluid_load = "310 N"
sd = "2 N"
[[reading]]
name = "slow"
when = { "motion.speed" = "0.3 m/s" }
fluid_load = "150 N"
sd = "2 N"
[method]
budget = 40
"""
TRUE = {"interface.roughness_beyond_cutoff": 2.5, "shoe.material.shore_a": 60.0}


def load(changes):
    """Return a made-up load: roughness lowers it, hardness raises it, both at another rate."""
    rough, shore = changes["interface.roughness_beyond_cutoff"], changes["shoe.material.shore_a"]
    slow = "motion.speed" in changes
    return (100 * (4 - rough) if slow else 40 * (5 - rough)) + (0.0 if slow else 3.5 * shore)


@pytest.fixture
def study(tmp_path):
    """Return a study all of whose cases are finished with made-up loads."""
    plan = read_plan(TEXT, EXAMPLES)
    made = Study(plan, tmp_path)
    made.store = Store.open_folder(tmp_path)
    made.store.adopt(plan)
    while made._begin_next():
        for job in made.store.jobs():
            numbers = {"fluid_load": load(job.changes)}
            made.store.add_record(Record(job.key, Ending.COMPUTED, numbers=numbers))
    made.store.close()
    return made


@pytest.mark.slow
def test_known_parameters_come_back_and_a_study_takes_their_draws(study, tmp_path):
    found = posterior.posterior(study)
    assert found.usable
    for path, draws in zip(found.paths, found.draws.T, strict=True):
        low, high = np.quantile(draws, [0.025, 0.975])
        assert low < TRUE[path] < high
    rough = found.paths.index("interface.roughness_beyond_cutoff")
    assert found.draws[:, rough].std() < 0.8 * found.prior[:, rough].std()
    assert abs(np.median(found.discrepancy)) < 0.15
    found.write(tmp_path / "posterior.csv")
    text = (
        f'base = "{EXAMPLES.as_posix()}/work_shoe_untreaded_glycerol.toml"\n[vary]\n'
        '"motion.speed" = ["0.3 m/s", "0.5 m/s"]\n[uncertain]\nposterior = "posterior.csv"\n'
        "[method]\ndraws = 4\n"
    )
    plan = read_plan(text, tmp_path)
    assert [sorted(draw) for draw in plan.draws] == [sorted(TRUE)] * 4
    assert plan.cases_per_design == 4


def test_a_study_without_readings_is_no_calibration(tmp_path):
    text = TEXT.split("[[reading]]")[0] + '[method]\nkind = "sensitivity"\nbudget = 40\n'
    with pytest.raises(InputError, match=r"\[\[reading\]\]"):
        posterior.posterior(Study(read_plan(text, EXAMPLES), tmp_path))


def test_a_reading_without_its_spread_is_refused():
    with pytest.raises(InputError, match=r"with its sd"):
        read_plan(TEXT.replace('sd = "2 N"\n', "", 1), EXAMPLES)


def told(value, sd="1 N", apart=()):
    """Return the cautions of a reading of a load that is predicted as 300 N (280 to 320)."""
    draws, ends = np.linspace(-0.5, 0.5, 101), np.array([[280.0, 300.0, 320.0]])
    reading = ("wet", value, to_si(sd, "N", where=""), "N")
    made = posterior.Posterior(
        *("made up", ("motion.speed",), draws[:, None], 2 * draws[:, None], 0.1 + 0 * draws),
        *([reading], ends, ends, 100.0, [], apart),
    )
    return made.cautions()


@pytest.mark.parametrize(
    ("value", "sd", "outside"),
    [
        (300.0, "1 N", False),
        (405.0, "1 N", False),  # the model misses by 15 %
        (415.0, "1 N", True),
        (195.0, "1 N", False),
        (185.0, "1 N", True),
        (415.0, "60 N", False),
    ],
)
def test_a_reading_that_the_model_can_not_reach_is_a_caution(value, sd, outside):
    cautions = told(value, sd)
    assert len(cautions) == outside
    assert all("280 N to 320 N" in text for text in cautions)


def test_readings_of_one_condition_that_contradict_each_other_are_a_caution():
    (caution,) = told(300.0, apart=[("wet", "wet again")])
    assert "wet and wet again are of one condition" in caution
