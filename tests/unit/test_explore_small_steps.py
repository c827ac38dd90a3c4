"""Files of joint draws, what a crash has taken and what comes next, by their values."""

from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.stats import halfnorm, norm

from underfoot.core import InputError
from underfoot.explore import proposals, study, study_file
from underfoot.explore.computing import crash_record
from underfoot.explore.inputs import TAIL, Choice, Range, read_joint_draws
from underfoot.explore.posterior import DISCREPANCY, _log_density
from underfoot.explore.record import CaseJob, Ending
from underfoot.explore.study_file import _Reader
from underfoot.explore.surrogate import feature_columns

HEAD = "# a posterior\ncontaminant.viscosity,motion.speed\n"


def draws_of(tmp_path, rows):
    path = tmp_path / "draws.csv"
    path.write_text(HEAD + "".join(f"{a},{b}\n" for a, b in rows))
    return read_joint_draws(path)


def test_joint_draws_are_the_rows_of_their_file(tmp_path):
    draws = draws_of(tmp_path, [(0.1, 0.5), (0.2, 0.7)])
    assert draws.paths == ("contaminant.viscosity", "motion.speed")
    np.testing.assert_array_equal(draws.values, [[0.1, 0.5], [0.2, 0.7]])
    both = {"contaminant.viscosity": 0.2, "motion.speed": 0.7}
    assert draws.rows(2)[1] == both
    # evenly from the first to the last
    many = draws_of(tmp_path, [(0.1 * k, 0.5) for k in range(1, 10)])
    taken = [row["contaminant.viscosity"] for row in many.rows(3)]
    assert taken == pytest.approx([0.1, 0.5, 0.9])


@pytest.mark.parametrize(
    "rows", [[], [(0.1, 0.5)], [(0.1, 0.5), (0.2, "")], [(0.1, 0.5), ("inf", 0.5)], [("a", 1)] * 2]
)
def test_one_draw_or_one_that_is_no_number_makes_no_posterior(tmp_path, rows):
    with pytest.raises(InputError, match=r"draws\.csv"):
        draws_of(tmp_path, rows)


def test_a_case_that_crashed_has_no_number_and_took_no_time_that_is_known():
    record = crash_record(CaseJob("k", 0, 0, 0, 0, (0.5,), {}))
    assert record.ending is Ending.CRASHED
    assert not record.usable
    assert (record.seconds, record.cpu_seconds, record.memory) == (0.0, 0.0, 0.0)
    assert np.isnan(record.number("cof"))


@pytest.mark.parametrize(
    ("kind", "active", "run", "batch", "then"),
    [
        ("optimise", 0.0, 6, 3, ("promising", 3)),
        ("robust", 0.0, 8, 3, ("promising", 2)),  # of ten
        ("optimise", 0.0, 9, 3, ("promising", 1)),
        ("sweep", 0.5, 6, 9, ("least known", 4)),
        ("sweep", 0.0, 6, 9, "again"),  # its places do not follow from results
        ("optimise", 0.0, 10, 3, "again"),
        ("sweep", 0.5, 10, 3, "again"),
        ("sensitivity", 0.0, 10, 3, "again"),
    ],
)
@pytest.mark.parametrize("ended", [False, True])
def test_what_comes_next_follows_from_the_kind_and_from_what_is_left(
    monkeypatch, kind, active, run, batch, then, ended
):
    asked = []

    def asks(name):
        return lambda so_far, count: asked.append((name, count)) or [(0.5,)] * count

    monkeypatch.setattr(proposals, "_promising", asks("promising"))
    monkeypatch.setattr(proposals, "_least_known", asks("least known"))
    plan = SimpleNamespace(
        designs=10,
        goals=("cof",),
        method=SimpleNamespace(
            kind=kind, active=active, batch=batch, again=1, again_on="full", quick=True
        ),
        jobs=lambda number, point, batch, again=False: [(number, point, batch, again)],
    )
    best = SimpleNamespace(number=4, point=(0.4,))
    so_far = SimpleNamespace(
        # the start on the finer grid is what a study ends with
        jobs=[SimpleNamespace(batch=2, design=run - 1, point=() if ended else (0.1,), quick=True)],
        designs=[None] * run,
        again=[],
        best=lambda count: [best] * count,
    )
    jobs = list(proposals.next_batch(cast(Any, plan), cast(Any, so_far)))
    if then == "again":
        assert not asked
        again = [(4, (0.4,), 3, True), (run, (), 3, True)]
        assert jobs == ([] if ended and run == 10 else again)
    else:
        assert asked == [then]
        assert jobs == [(run + k, (0.5,), 3, False) for k in range(then[1])]


def test_a_name_has_a_column_a_value_and_a_number_its_share_of_the_range():
    dimensions = (
        Range("shoe.tread.depth", 1e-3, 4e-3),
        Choice("shoe.tread.pattern", ("grid", "bars", "none")),
        Choice("shoe.material.shore_a", (50.0, 55.0, 70.0)),
    )
    points = np.array([[0.2, 0.1, 0.1], [0.7, 0.5, 0.5], [1.0, 1.0, 1.0]])
    np.testing.assert_allclose(
        feature_columns(dimensions, points),
        [[0.2, 1, 0, 0, 0.0], [0.7, 0, 1, 0, 0.25], [1.0, 0, 0, 1, 1.0]],
    )
    alone = Choice("shoe.material.shore_a", (60.0,))
    np.testing.assert_array_equal(feature_columns((alone,), np.array([[0.5]])), [[0.0]])


@pytest.mark.parametrize("leads", [True, False])
def test_cases_that_tell_the_cost_are_computed_by_one_worker_and_only_where_nobody_leads(
    monkeypatch, leads
):
    workers, added, told = [], [], []
    store: Any = SimpleNamespace(
        folder="a", leading=lambda: nullcontext(leads), adopt=lambda _: None,
        working=lambda count: workers.append(count) or nullcontext(),
        records=lambda: {"b": "known"}, add_record=added.append,
    )  # fmt: skip
    jobs = [SimpleNamespace(key=key) for key in "abc"]
    monkeypatch.setattr(study, "spread_jobs", lambda _, count: jobs[:count])
    monkeypatch.setattr(study, "compute_job", lambda base, job: f"{job.key} of {base}")
    monkeypatch.setattr(study.Store, "open_folder", lambda _: store)
    of: Any = SimpleNamespace(plan=SimpleNamespace(base="base"), store=store)
    study.Study.compute_some(of, 3, lambda _, share: told.append(share))
    assert workers == [1]
    assert added == (["a of base", "c of base"] if leads else [])
    assert told == pytest.approx([1 / 3, 2 / 3, 1] if leads else [])


@pytest.mark.parametrize("given", ["own", None])
def test_the_base_of_a_study_has_the_catalogue_that_is_given_else_that_beside_it(
    monkeypatch, given
):
    loaded = []
    found = SimpleNamespace(load=lambda path, catalogue: loaded.append((path, catalogue)) or "case")
    beside = SimpleNamespace(load=lambda folders: f"beside {folders}")
    monkeypatch.setattr(study_file, "Case", found)
    monkeypatch.setattr(study_file, "Catalogue", beside)
    monkeypatch.setattr(study_file, "catalogue_folders", lambda folder: folder.name)
    reader = _Reader('base = "cases/own.toml"', None)
    assert reader.base(Path("studies"), cast(Any, given)) == "case"
    assert loaded == [(Path("studies/cases/own.toml"), given or "beside cases")]


def test_a_posterior_is_the_prior_by_the_normal_likelihood_of_its_readings():
    """Three variances add: of the reading, of its surrogate, of the model's discrepancy."""
    models = [
        SimpleNamespace(prediction=lambda at: (1.0 + at[:, 0], 0.1 + 0.2 * at[:, 1])),
        SimpleNamespace(prediction=lambda at: (5.0 * at[:, 1], np.full(len(at), 0.3))),
    ]
    readings = [SimpleNamespace(value=1.4, sd=0.05), SimpleNamespace(value=3.0, sd=0.4)]
    places = np.random.default_rng(4).uniform(0.02, 0.98, (50, 3))
    expected = np.zeros(50)
    within = TAIL + (1 - 2 * TAIL) * places[:, 2]  # as of every input, without its outermost
    delta = halfnorm.ppf(within, scale=DISCREPANCY)
    for model, reading in zip(models, readings, strict=True):
        mean, error = model.prediction(places[:, :2])
        spread = np.sqrt(reading.sd**2 + error**2 + (delta * mean) ** 2)
        expected += norm.logpdf(reading.value, mean, spread)
    told = _log_density(places, cast(Any, models), cast(Any, readings))
    assert np.ptp(told - expected) < 1e-9
    outside = places[:6].copy()
    outside[[0, 1, 2], [0, 1, 2]] = -0.1
    outside[[3, 4, 5], [0, 1, 2]] = 1.1
    assert (_log_density(outside, cast(Any, models), cast(Any, readings)) == -np.inf).all()
