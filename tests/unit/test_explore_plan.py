"""Study files: what they mean, and what a person is told who wrote one that can't be."""

import math
import time
import tracemalloc
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from machine import slowness
from underfoot.case import Case, CaseError
from underfoot.compute.positions import places, position_count
from underfoot.explore.goals import Condition, Goal, read_goal, read_requirement
from underfoot.explore.proposals import next_batch
from underfoot.explore.record import Ending, Record
from underfoot.explore.result import StudyResult
from underfoot.explore.study_file import UNITS, load_plan, read_plan

EXAMPLES = Path(__file__).parents[2] / "examples"
GOOD = """\
file_version = 1
base = "work_shoe_full_tread_glycerol.toml"
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
shoe.tread.channel_width = { from = "2.5 mm", to = "4 mm" }
"shoe.tread.lug_width" = { times = 1.5, of = "shoe.tread.channel_width" }
"shoe.tread.pattern" = ["grid", "hexagons"]
[uncertain]
"interface.roughness_beyond_cutoff" = { lognormal = 2.0, factor = 1.3 }
[conditions]
contaminant = ["glycerol_90pct", "canola_oil"]
wear = ["0 mm", "0.5 mm"]
[outputs]
maximise = ["quantile(cof, 0.1) over conditions", "wear_life(cof > 0.1)"]
minimise = ["rubber_volume"]
require = ["cof > 0.05 in canola_oil", "rubber_volume < 200 cm^3"]
[method]
kind = "robust"
budget = 160
draws = 2
"""


def plan(text=GOOD):
    return read_plan(text, EXAMPLES, "study.toml")


def test_a_study_file_is_read_as_it_says():
    made = plan()
    assert [one.path for one in made.vary] == [
        "shoe.tread.depth",
        "shoe.tread.channel_width",
        "shoe.tread.pattern",
    ]
    assert (len(made.states), len(made.draws), made.cases_per_design) == (4, 2, 8)
    assert made.designs == 20
    assert made.states[1].parts == ("glycerol_90pct", "0.5 mm")
    changes = made.design_changes((0.5, 1.0, 0.9))
    assert changes["shoe.tread.depth"] == pytest.approx(2.5e-3)
    assert changes["shoe.tread.lug_width"] == pytest.approx(6e-3)
    assert changes["shoe.tread.pattern"] == "hexagons"
    jobs = list(made.jobs(0, (0.5, 0.5, 0.2), 0))
    assert len({job.key for job in jobs}) == 8
    assert made.require[1].bound == pytest.approx(200e-6)


def test_draws_are_common_to_all_designs():
    made = plan()
    rough = "interface.roughness_beyond_cutoff"
    one, other = (
        [job.changes[rough] for job in made.jobs(k, point, 0)]
        for k, point in enumerate([(0.1, 0.1, 0.1), (0.9, 0.9, 0.9)])
    )
    assert one == other
    assert len(set(one)) == 2


def test_jobs_are_the_same_whenever_the_file_is_read():
    first, second = (list(next_batch(p, StudyResult(p, [], {}))) for p in (plan(), plan()))
    assert first == second


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"shoe.tread.depth"', '"shoe.tread.dept"', ["line 4", 'Did you mean "shoe.tread.depth"']),
        ('from = "1 mm", to = "4 mm"', 'from = "4 mm", to = "1 mm"', ["line 4", "from < to"]),
        ('to = "4 mm" }\nshoe', 'to = "4 m" }\nshoe', ["line 4", "outside the physical range"]),
        ('"1 mm", to = "4 mm"', '1, to = "4 mm"', ["line 4", "unit"]),
        ('"hexagons"]', '"hexagon"]', ["line 7", 'Did you mean "hexagons"']),
        ('"canola_oil"]', '"canola"]', ["line 11", "canola_oil"]),
        ("quantile(cof, 0.1) over", "quantile(friction, 0.1) over", ["line 14", "cof"]),
        ("quantile(cof, 0.1)", "quantile(cof, 7)", ["line 14", "between 0 and 1"]),
        ("over conditions", "over oils", ["line 14", "draws"]),
        ("in canola_oil", "in milk", ["line 16", "glycerol_90pct"]),
        ('"rubber_volume <', '"rubber_volume > 300 cm^3", "rubber_volume <', ["both hold"]),
        ('"rubber_volume <', '"min(cof) > 0.4", "max(cof) < 0.3", "rubber_volume <', ["both hold"]),
        ('from = "2.5 mm"', 'from = "0.05 mm"', ["line 5", "needs a finer grid", "low end"]),
        ('minimise = ["rubber_volume"]', 'minimise = ["mass"]', ["density", "rubber_volume"]),
        ("draws = 2", "draw = 2", ["line 20", 'Did you mean "draws"']),
        ('"rubber_volume <', '"sd(cof) < 10 %", "rubber_volume <', ["line 16", "of the value"]),
        ("wear_life(cof > 0.1)", "wear_life(cof in 0 mm > 0.1)", ["line 14", "two states of wear"]),
        (
            '"rubber_volume <',
            '"sd(fluid_load) in canola_oil, 0 mm over conditions < 5 N", "rubber_volume <',
            ["line 13", "sd(fluid_load)", "of one number"],
        ),
        ("budget = 160", "budget = 3", ["less than one design", "from 8"]),
        ('kind = "robust"', 'kind = "robots"', ["line 18", 'Did you mean "robust"']),
        ("file_version = 1", "file_version = 9", ["line 1", "Update underfoot"]),
        ("[uncertain]", "[uncertian]", ['Did you mean "uncertain"']),
        ("factor = 1.3", "factor = 0.3", ["line 9", "above 1"]),
        ("lognormal = 2.0, factor = 1.3", "normal = 2.0, sd = 1.5", ["line 9", "Narrow it"]),
        ("lognormal = 2.0, factor = 1.3", 'normal = 2.0, sd = "10 %"', ["line 9", "of the value"]),
        ('of = "shoe.tread.channel_width"', 'of = "shoe.heel.width"', ["line 6", "channel_width"]),
        ('{ from = "1 mm", to', '{ form = "1 mm", to', ["line 4", "is no range"]),
        ("wear = [", '"shoe.tread.depth" = ["1 mm"]\nwear = [', ["set twice"]),
        ("work_shoe_full_tread_glycerol", "work_shoe_full_tread_glycerine", ["Did you mean"]),
    ],
)
def test_what_is_wrong_is_said_with_its_place_and_the_remedy(old, new, words):
    assert old in GOOD
    with pytest.raises(Exception, match=r".") as caught:
        plan(GOOD.replace(old, new, 1))
    text = str(caught.value)
    for word in words:
        assert word in text, text


def test_a_condition_that_stands_twice_is_asked():
    pools = '"contaminant.pool_depth" = ["0.5 mm", "1 mm"]\nwear = ['
    text = GOOD.replace("wear = [", pools)
    assert len(plan(text.replace("budget = 160", "budget = 320")).states) == 8
    with pytest.raises(CaseError, match="mm stands under several conditions") as caught:
        plan(text.replace("in canola_oil", "in canola_oil, 0.5 mm"))
    assert "line 17" in str(caught.value)


def test_all_errors_come_at_once():
    with pytest.raises(CaseError) as caught:
        plan(GOOD.replace("hexagons", "hexagon").replace("in canola_oil", "in milk"))
    assert len(caught.value.errors) == 2


AGAIN = """\
base = "BASE.toml"
[set]
"numerics.tread_positions" = COUNT
[vary]
"motion.speed" = { from = "0.3 m/s", to = "0.7 m/s" }
[outputs]
maximise = ["cof"]
[method]
kind = "optimise"
budget = 20
grid = "quick"
front_grid = "GRID"
"""


def again(base, count, grid):
    text = AGAIN.replace("BASE", base).replace("COUNT", str(count)).replace("GRID", grid)
    made = plan(text)
    return made, *(next(made.jobs(3, (0.25,), 0, again=again)) for again in (False, True))


@pytest.mark.parametrize("count", [2, 3, 6, 7, 8, 63, 64])
@pytest.mark.parametrize("grid", ["quick", "standard"])
def test_run_again_a_tread_lies_elsewhere_whatever_the_grid(count, grid):
    made, first, second = again("work_shoe_full_tread_glycerol", count, grid)
    numbers = [
        position_count(made.base.replace(one.changes), quick=one.quick) for one in (first, second)
    ]
    assert numbers[0] != numbers[1]
    periods = np.array([[7e-3, 0.0], [0.0, 5e-3]])
    shared = set(places(periods, numbers[0])) & set(places(periods, numbers[1]))
    assert len(shared) <= math.gcd(*numbers)
    assert not made.remarks


@pytest.mark.parametrize(
    ("base", "count"),
    [("work_shoe_untreaded_glycerol", 8), ("work_shoe_full_tread_glycerol", 1)],
)
def test_what_has_no_other_positions_is_run_again_on_a_finer_grid_or_not_at_all(base, count):
    made, first, second = again(base, count, "standard")
    assert first.key != second.key
    assert (first.quick, second.quick) == (True, False)
    assert not made.remarks
    made, first, second = again(base, count, "quick")
    assert first.key == second.key
    assert 'Take front_grid = "standard"' in " ".join(made.remarks)
    repeated = [*made.jobs(0, (0.1,), 0), first, *made.jobs(0, (0.1,), 1, again=True), second]
    records = {
        one.key: Record(
            one.key, Ending.COMPUTED, numbers={"cof": one.point[0]}, errors={"cof": 0.01}
        )
        for one in repeated
    }
    more = [next(made.jobs(k, (k / 20,), 0)) for k in range(6, 15)]
    records |= {
        one.key: Record(one.key, Ending.COMPUTED, numbers={"cof": 0.3}, errors={"cof": 0.01})
        for one in more
    }
    result = StudyResult(made, [*repeated[:2], *more, *repeated[2:]], records)
    (surrogate,) = result.surrogates(made.goals)
    assert len(surrogate.runs.values) == 11  # a run that stands twice is one run
    assert not surrogate.runs.finer.any()


def test_a_narrow_channel_refines_the_grid_of_every_design_and_says_so():
    made = plan(GOOD.replace('from = "2.5 mm"', 'from = "1.2 mm"'))
    assert made.base.numerics.quick_grid_spacing == pytest.approx(0.6e-3)
    assert "finer grid" in made.remarks[0]


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, id=path.stem, marks=[pytest.mark.slow] * (path.stem == "free_tread"))
        for path in sorted((EXAMPLES / "studies").glob("*.toml"))
    ],
)
def test_every_example_is_read_and_its_first_designs_can_be_built(path):
    made = load_plan(path)
    for job in islice(next_batch(made, StudyResult(made, [], {})), 6):
        assert isinstance(made.base.replace(job.changes), Case)


# --- goals on records ---

STATES = (
    Condition(("oil",), {"shoe.wear.depth": 0.0}),
    Condition(("oil", "2 mm"), {"shoe.wear.depth": 2e-3}),
)


def records(*values, draws=None):
    return {
        (k, 0): Record(
            str(k), Ending.COMPUTED, numbers={"cof": v}, draws=np.array(draws or [v - 0.1, v + 0.1])
        )
        for k, v in enumerate(values)
    }


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("cof", 0.25),
        ("cof in 2 mm", 0.2),
        ("min(cof) over conditions", 0.2),
        ("min(cof)", 0.1),  # the law's draws count
        ("max(cof) over draws", 0.35),
        ("quantile(cof, 0.5) over conditions", 0.25),
        ("sd(cof) over conditions", 0.05),
        ("wear_life(cof > 0.25)", 1e-3),
        ("wear_life(cof > 0.4)", 0.0),
        ("wear_life(cof > 0.1)", 2e-3),  # to the last wear: a lower bound
        ("wear_life(min(cof) over conditions > 0.25)", 1e-3),  # of each wear the mean over draws
        ("wear_life(min(cof) > 0.15)", 1e-3),
    ],
)
def test_goals_are_statistics_over_conditions_and_draws(text, value):
    goal = read_goal(text, UNITS, STATES)
    assert goal.value(records(0.3, 0.2), STATES) == pytest.approx(value)


@pytest.mark.parametrize("turned", [False, True])
def test_wear_life_is_that_of_the_first_condition_that_fails(turned):
    states = [
        Condition((fluid, f"{1e3 * wear:g} mm"), {"contaminant": fluid, "shoe.wear.depth": wear})
        for fluid in ("oil", "water")
        for wear in (0.0, 2e-3)
    ]
    cof = [0.3, 0.2, 0.3, 0.1]  # at 0.25 after 1 mm in oil, after 0.5 mm in water
    if turned:
        states, cof = states[2:] + states[:2], cof[2:] + cof[:2]
    goal = read_goal("wear_life(cof > 0.25)", UNITS, states)
    assert goal.value(records(*cof), states) == pytest.approx(0.5e-3)


def test_a_goal_of_a_design_with_a_failed_case_is_nan():
    failed = records(0.3, 0.2) | {(1, 0): Record("1", Ending.CRASHED, "killed")}
    assert np.isnan(Goal("cof", "1").value(failed, STATES))
    assert np.isnan(Goal("cof", "1", "min", over="conditions").value(failed, STATES))


def test_a_requirement_holds_on_the_right_side():
    low = read_requirement("cof > 0.2", UNITS, STATES)
    high = read_requirement("fluid_load < 90 N", UNITS, STATES)
    assert low.margin(0.25) == pytest.approx(0.05)
    assert high.margin(100.0) == pytest.approx(-10.0)


def test_a_list_of_one_is_set_for_all_designs_but_not_for_the_start():
    text = """
    base = "work_shoe_full_tread_glycerol.toml"
    [vary]
    "shoe.tread.pattern" = ["hexagons"]
    "shoe.tread.channel_width" = ["2.6 mm"]
    "shoe.tread.depth" = { from = "1 mm", to = "4 mm" }
    [method]
    budget = 4
    """
    plan = read_plan(text, Path(__file__).parents[2] / "examples")
    assert [one.path for one in plan.dimensions] == ["shoe.tread.depth"]
    changes = plan.design_changes((0.0,))
    assert changes["shoe.tread.pattern"] == "hexagons"
    assert changes["shoe.tread.channel_width"] == pytest.approx(2.6e-3)
    assert plan.design_changes(()) == {}
    # the channel counts for the grid of the study, too
    assert plan.base.numerics.quick_grid_spacing <= 1.3e-3


BIG = """\
base = "work_shoe_full_tread_glycerol.toml"
[vary]
"shoe.tread.depth" = { from = "1 mm", to = "4 mm", steps = 1000 }
"shoe.tread.channel_width" = { from = "2.5 mm", to = "4 mm", steps = 1000 }
"shoe.material.shore_a" = { from = 50, to = 70, steps = 1000 }
"""
WEARS, SPEEDS, LOADS = (
    [f"{first + k / scale} {unit}" for k in range(1000)]
    for first, scale, unit in ((0, 1000, "mm"), (0.3, 10_000, "m/s"), (400, 1, "N"))
)
THREE = f"wear = {WEARS}\n'motion.speed' = {SPEEDS}\n'motion.normal_force' = {LOADS}\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            BIG,
            ["vary", "line 2", "1e+09 cases", "years of one processor", "at most 1e+06", "budget"],
        ),
        (BIG + "[method]\nbudget = 1000000000\n", ["method.budget", "line 7", "at most 1000000"]),
        (
            f"{BIG}[conditions]\n{THREE}[method]\nbudget = 1000\n",
            ["conditions", "line 6", "1e+09 conditions", "at most 1e+06", "Fewer"],
        ),
    ],
)
def test_a_thousand_million_designs_are_refused_before_any_is_made(text, words):
    tracemalloc.start()
    began = time.process_time()
    with pytest.raises(CaseError) as caught:
        plan(text)
    assert time.process_time() - began < 1.0 * slowness()
    assert tracemalloc.get_traced_memory()[1] < 100e6
    tracemalloc.stop()
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "[uncertain]",
            'shoe.tread.depth = { from = "2 mm", to = "3 mm" }\n[uncertain]',
            ["vary.shoe.tread.depth", "line 4", "stands twice", "Drop one"],
        ),
        ("wear = [", '"shoe.wear.depth" = ["1 mm"]\nwear = [', ["stands twice", "Drop one"]),
        ('["rubber_volume"]', '["land", "mean(land)"]', ["line 15", "land stands twice"]),
        ('["grid", "hexagons"]', '["grid", "grid"]', ["line 7", "different values"]),
        ('"canola_oil"]', '"glycerol_90pct"]', ["line 11", "different values"]),
        ('from = "1 mm", to = "4 mm"', 'from = "1 mm", to = "0.001 m"', ["line 4", "from < to"]),
    ],
)
def test_inputs_that_are_the_same_are_refused(old, new, words):
    assert old in GOOD
    with pytest.raises(CaseError) as caught:
        plan(GOOD.replace(old, new, 1))
    for word in words:
        assert word in str(caught.value)


def test_a_condition_whose_name_holds_a_comma_is_one():
    states = [
        Condition((floor, fluid), {"contaminant": fluid})
        for floor in ("vinyl", "vinyl, worn") for fluid in ("oil", "water")
    ]  # fmt: skip
    read = {text: read_goal(f"cof in {text}", UNITS, states).within for text in (
        "vinyl, oil", "vinyl, worn, oil", "oil, vinyl, worn", "vinyl",
    )}  # fmt: skip
    assert read == {
        "vinyl, oil": ("vinyl", "oil"),
        "vinyl, worn, oil": ("vinyl, worn", "oil"),
        "oil, vinyl, worn": ("oil", "vinyl, worn"),
        "vinyl": ("vinyl",),
    }
