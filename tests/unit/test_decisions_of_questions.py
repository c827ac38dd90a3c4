"""Offers, copies and rankings of questions and places by small cases whose answer is plain."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.core import SourcedValue
from underfoot.places.choice import BINS, _of_bins
from underfoot.places.evidence import ScoredReading, score
from underfoot.places.place import _task
from underfoot.questions import effects
from underfoot.questions.changes import Change, possible_changes
from underfoot.questions.contact import mirror_map
from underfoot.questions.effects import MOST_ERROR, _continue_march, change_effects
from underfoot.questions.sensitivity import OPEN_INPUTS, _at
from underfoot.surface import HeightMap


def changes_at(rq):
    case = Case.load("examples/work_shoe_untreaded_glycerol.toml")
    given = {"shoe.roughness.rq": f"{rq} um", "shoe.roughness.ra": None}
    return {change.name: change.values for change in possible_changes(case.replace(given))}


def test_a_sole_is_abraded_to_twice_its_roughness_where_that_can_be_done():
    assert changes_at(14.9)["abraded_sole"]["shoe.roughness.rq"] == pytest.approx(29.8e-6)
    assert "abraded_sole" not in changes_at(15.1)


def test_a_mirrored_map_holds_the_map_and_is_its_own_mirror_image():
    heights = np.random.default_rng(0).normal(size=(12, 10)) * 1e-6
    whole = mirror_map(HeightMap(heights, 1e-6))
    assert whole.heights.shape == (24, 20)
    assert whole.periodic
    corner = whole.heights[:12, :10]
    for flipped in (whole.heights[::-1], whole.heights[:, ::-1]):
        assert flipped == pytest.approx(whole.heights)
    # the corner is the levelled map: the map less a plane
    x, y = np.meshgrid(np.arange(12), np.arange(10), indexing="ij")
    terms = np.column_stack([np.ones(120), x.ravel(), y.ravel()])
    rest = (corner - heights).ravel()
    assert rest == pytest.approx(terms @ np.linalg.lstsq(terms, rest, rcond=None)[0], abs=1e-15)


def test_a_task_keeps_its_share_and_its_friction_apart():
    task = _task({"name": "carry", "share": 0.25, "rcof": 0.3}, 0.2)
    assert (task.name, task.share, task.rcof) == ("carry", 0.25, 0.3)
    assert (_task({}, 0.2).share, _task({}, 0.2).rcof) == (1.0, 0.2)


def test_a_chance_below_half_a_bin_is_told_as_below_a_bin():
    assert _of_bins(0.6 / BINS) != _of_bins(0.0) == _of_bins(0.4 / BINS)
    assert _of_bins(0.0).startswith("below")


@pytest.mark.parametrize(("order", "rank"), [((1, 2, 3), 1.0), ((3, 2, 1), -1.0)])
def test_machines_are_scored_by_error_rank_and_what_intervals_hold(order, rank):
    rows = [
        ScoredReading(
            cast(Any, SimpleNamespace(middle=float(k), ends=(float(k), float(k)), source=f"{k}")),
            (guess - 0.5, float(guess), guess + 0.5),
            10.0,
        )
        for k, guess in zip((1, 2, 3), order, strict=True)
    ]
    result = score(rows)
    assert result.rank == pytest.approx(rank)
    errors = [abs(guess - k) for k, guess in zip((1, 2, 3), order, strict=True)]
    assert result.error == np.median(errors)
    assert result.inside == np.mean([error <= 0.5 for error in errors])
    assert np.isnan(score(rows[:2]).rank)
    assert np.isnan(score([replace(row, constant=None) for row in rows]).constant_error)


def test_what_keeps_its_ratio_to_an_open_input_keeps_it_at_any_value():
    case = Case.load("examples/work_shoe_untreaded_glycerol.toml")
    (width,) = (each for each in OPEN_INPUTS if each.along)
    (radius,) = width.along
    ratio = case.value(radius) / case.value(width.path)
    for value in (0.6, 0.66, 0.74):
        there = _at(case, width, value / 10)
        assert there.value(width.path) == pytest.approx(value / 10)
        assert there.value(radius) / there.value(width.path) == pytest.approx(ratio)


@pytest.mark.parametrize(
    ("error", "uncertainty", "lugs", "taken"),
    [
        (0.9 * MOST_ERROR, 0.0, False, True),
        (1.1 * MOST_ERROR, 0.0, False, False),
        (1.1 * MOST_ERROR, 4 * MOST_ERROR, False, False),
        (1.9 * MOST_ERROR, 4 * MOST_ERROR, True, True),
        (2.1 * MOST_ERROR, 4 * MOST_ERROR, True, False),
        (1.1 * MOST_ERROR, MOST_ERROR, True, False),
    ],
)
def test_a_preview_stands_for_a_change_where_its_error_is_small(error, uncertainty, lugs, taken):
    """Under lugs up to half of the COF's own standard uncertainty, without them no further."""
    seen = SimpleNamespace(cof=SimpleNamespace(uncertainty=uncertainty), errors={"cof": error})
    march = SimpleNamespace(continue_march=lambda values: seen if values == {"a": 1} else None)
    change = SimpleNamespace(values={"a": 1})
    result = _continue_march(cast(Any, march), cast(Any, change), lugs)
    assert (result is seen) == taken


@pytest.mark.parametrize("lugs", [False, True])
def test_a_run_beside_a_march_goes_on_from_what_the_march_misses(monkeypatch, lugs):
    """March 0.20 and 100 N at the position of 0.25 and 160 N, all positions 0.30 and 200 N.

    Without lugs a run starts from 0.24 and 125 N, by the ratio of all to one: with 50 N 0.4 of the
    film is left, and of 0.06 and 75 N that are missed. With lugs a run of another rubber starts
    from the march itself: 0.5 of 0.10 and 100 N.
    """

    def scalars(cof, load):
        return {"cof": SourcedValue(cof, "1"), "fluid_load": SourcedValue(load, "N")}

    def at_one(value):
        return SimpleNamespace(attrs={"as_described": value})

    case = Case.load("examples/work_shoe_untreaded_glycerol.toml")
    data = {"position_cof": at_one(0.25), "position_fluid_load": at_one(160.0)}
    present = SimpleNamespace(
        scalars=scalars(0.30, 200.0), data=data, value={"cof": 0.30, "fluid_load": 200.0}.get
    )
    march = SimpleNamespace(
        values={"cof": 0.20, "fluid_load": 100.0}, cof=SourcedValue(0.20, "1"), cof_draws=None
    )
    ran = []

    def run(cases, **_):
        ran.extend(cases)
        made = SimpleNamespace(usable=True, scalars=scalars(0.15, 50.0), maps={})
        failed = SimpleNamespace(usable=False, status="not converged")
        return [made, failed][: len(cases)]

    monkeypatch.setattr(effects, "_march", lambda *_: march)
    monkeypatch.setattr(effects, "has_lugs", lambda _: lugs)
    monkeypatch.setattr(effects, "outcomes", run)
    rubbers = [
        Change(f"rubber {a}", f"take {a}", "maker", {"shoe.material.shore_a": a})
        for a in (50.0, 60.0)
    ]
    told, none = change_effects(case, cast(Any, present), rubbers)
    assert [one.value("shoe.material.shore_a") for one in ran] == [50.0, 60.0]
    expected = (0.15 + 0.5 * 0.10, 50 + 0.5 * 100) if lugs else (0.15 + 0.4 * 0.06, 50 + 0.4 * 75)
    assert (told.number("cof"), told.number("fluid_load")) == pytest.approx(expected)
    assert (none.computed, none.reason) == (False, "not converged")
