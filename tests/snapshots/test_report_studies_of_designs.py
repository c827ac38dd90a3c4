"""Pages of design studies, at work and done, of made-up numbers of cases."""

import dataclasses
import os
import time
from typing import Any, cast

import numpy as np
import pytest
from benchmarks.study_page import ROBUST, SWEEP, TEXT, made

from small_soles import fake, sole
from snapshot import held
from underfoot.core import DataError
from underfoot.core.progress import silent
from underfoot.explore.study import Study
from underfoot.report import design_study
from underfoot.report import live_study as live
from underfoot.report.dispatch import figures, sections
from underfoot.report.studies_page import _cell

HIDDEN = r'"data": "[^"]*"|"(?:viridis|RdBu_r|cividis|YlGnBu_r)": "[^"]*"|src="data:[^"]*"'
NOW = 1.7e9 + 500.0
LIVE = live.live_study


@pytest.fixture(scope="module")
def sweep(tmp_path_factory):
    return made(tmp_path_factory.mktemp("sweep"), TEXT + SWEEP, 60)


@pytest.fixture(scope="module")
def robust(tmp_path_factory):
    text = (TEXT + ROBUST).replace("quantile(cof, 0.1) over conditions", "quantile(cof, 0.1)")
    return made(tmp_path_factory.mktemp("robust"), text, 320, 0.75)


def at(study, **changes) -> Any:
    """Return the live study at one time, worked on by two workers until a while ago."""
    shown = LIVE(study)
    sessions = [{"began": NOW - 400, "ended": NOW - 100, "workers": 2, "host": "a", "pid": 1}]
    if shown.cost:  # its bytes are those of the libraries
        changes = {"cost": dataclasses.replace(shown.cost, disk=6e3)} | changes
    return dataclasses.replace(shown, now=NOW, sessions=sessions, **changes)


@pytest.mark.parametrize("name", ["sweep", "robust"])
def test_a_study_at_work(file_regression, request, name):
    shown = at(request.getfixturevalue(name))
    parts = live.live_sections(shown)
    told = {
        "headline": shown.headline(), "cautions": shown.cautions(), "remarks": shown.remarks(),
        "usable": shown.usable, "running": shown.running_seconds, "drawn": shown.drawn_text(),
        "table": shown.table(), "cost": shown.cost_table(),
        "runs": [len(each) for each in (shown.ended_runs, shown.front_runs, shown.shown_runs)],
        "front": [each.number for each in shown.front],
        "values": shown.values(shown.shown[:9], shown.plan.shown_goals),
        "believed": shown.goal_estimates(shown.shown[:3], shown.plan.goals),
        "sections": [(p.title, p.intro, p.html, p.items, p.first) for p in parts],
    }  # fmt: skip
    held(file_regression, told, hide=HIDDEN)


def test_a_study_without_goals_or_before_its_first_case(file_regression, tmp_path):
    plain = made(tmp_path / "plain", TEXT + "[method]\nbudget = %d\n", 12, 0.5)
    empty = made(tmp_path / "empty", TEXT + SWEEP, 12, 0.0)
    told = {}
    for name, study in (("plain", plain), ("empty", empty)):
        shown = at(study, cost=None)
        parts = live.live_sections(shown)
        told[name] = [
            shown.usable,
            shown.table(),
            shown.cost_table(),
            shown.cautions(),
            shown.front_runs,
            [(p.title, p.intro, bool(p.html)) for p in parts],
        ]
    held(file_regression, told)


def test_of_many_designs_some_are_drawn(file_regression, sweep, monkeypatch):
    monkeypatch.setattr(live, "MOST_SHOWN", 30)
    monkeypatch.setattr(live, "MOST_FRONT", 2)
    monkeypatch.setattr(live, "LATEST", 4)
    shown = at(sweep)
    held(file_regression, [shown.drawn_text(), shown.shown_runs, shown.table()])


@pytest.mark.parametrize("report", [False, True])
def test_the_live_page(file_regression, sweep, monkeypatch, report):
    monkeypatch.setattr(live, "live_study", at)
    if report:
        (sweep.store.folder / "report.html").touch()
    page = live.live_page(sweep).partition("<body>")[2]
    head, _, rest = page.partition('<div class="study')
    told = {"head": head, "steps": rest.rpartition("Stop, widen")[2], "length": len(page) > 5000}
    folder = str(sweep.store.folder.absolute())
    told = {k: v.replace(folder, "HERE") if isinstance(v, str) else v for k, v in told.items()}
    held(file_regression, told, hide=HIDDEN)


def test_when_a_page_is_due(sweep, monkeypatch, tmp_path):
    """The first look comes after ten seconds; 0.3 s of CPU are allowed from the thirtieth on."""
    clock, written = [0.0], []
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])
    monkeypatch.setattr(time, "process_time", lambda: 0.0)
    monkeypatch.setattr(live, "write_live_page", lambda study: written.append(clock[0]))
    for workers, first in ((1, [30.5]), (3, [10.5]), (None, None)):
        clock[0] = 0.0
        written.clear()
        with live.with_live_page(sweep, silent, workers) as told:
            for half in range(1, 70):
                clock[0] = half / 2 + 0.5
                told("Cases", 0.5)
                if written:
                    break
        assert first is None or written[:1] == pytest.approx(first, abs=0.5)
    page = tmp_path / "page.html"
    assert not live._fresh(page)
    page.touch()
    for age, fresh in ((0.0, True), (9.0, True), (11.0, False), (-11.0, False)):
        os.utime(page, (time.time() - age,) * 2)
        assert live._fresh(page) is fresh


def ready(study) -> Any:
    """Return a study that is done, with soles; its surrogates are not fitted."""
    result = study.result()
    plan = result.plan
    soles = {design.number: sole(side=4e-3, long=0.04, sensors=0) for design in result.designs[:2]}
    return design_study.ShownStudy(plan, result.jobs, result.records, result.sessions, soles=soles,
                                   missing="no surrogate")  # fmt: skip


def test_the_page_of_a_study_that_is_done(file_regression, tmp_path):
    study = made(tmp_path / "done", TEXT + SWEEP, 8, 1.0)
    shown = ready(study)
    parts, script = sections(shown, {"front": b"png"})
    told = {
        "sections": [(p.title, p.intro, p.html, p.table, p.items, p.folded) for p in parts[:-1]],
        "script": len(script) > 1000, "figures": list(figures(shown)),
        "plain": list(figures(study.result())),
        "centre": design_study._centre(shown),
    }  # fmt: skip
    held(file_regression, told, hide=HIDDEN)


def test_soles_of_designs(file_regression, sweep):
    heard = []
    result = sweep.result()
    few = fake(front=[], designs=[result.designs[k] for k in (3, 0, 3)], jobs=result.jobs)
    study = Study(sweep.plan, sweep.store.folder)
    soles = design_study._soles(study, few, lambda *parts: heard.append(parts))
    held(
        file_regression,
        {
            "told": heard,
            "soles": {
                str(k): [v["land"].values.sum(), v["clearance"].values[v["inside"].values].mean()]
                for k, v in soles.items()
            },
        },
    )


def test_numbers_of_an_explorer(file_regression):
    """Numbers and names, not finite ones, and units that are typeset."""
    dimensions = [fake(path="shoe.tread.depth"), fake(path="shoe.tread.pattern")]
    goals = [fake(phrase="area", unit="m^2"), fake(phrase="volume", unit="m^3"),
             fake(phrase="cof", unit="1")]  # fmt: skip
    designs = [fake(number=k, changes={"shoe.tread.depth": 1e-3 * k, "shoe.tread.pattern": "grid"},
                    reason="why <b>" * (k == 1)) for k in range(3)]  # fmt: skip
    values = np.array([[1e-4, 2.0, 0.1], [np.nan, 1.0, 0.2], [3e-4, np.inf, 0.3]])
    result = fake(plan=fake(dimensions=dimensions, shown_goals=goals, goals=goals[:1]),
                  front=designs[:1], meets_requirements=lambda _: np.array([True, False, True]),
                  goal_estimates=lambda designs, goals: (values, None))  # fmt: skip
    held(file_regression, design_study.explorer(result, designs))


@pytest.mark.parametrize("kind", ["sensitivity", "sweep"])
@pytest.mark.parametrize("on", ["runs", "surrogate"])
@pytest.mark.parametrize("goals", [(), ("a", "b")])
def test_what_a_study_is_shown_with(monkeypatch, kind, on, goals):
    """Indices of a sensitivity alone; surrogates of all but one on its own runs."""
    monkeypatch.setattr(design_study, "effects", lambda result, goal: ("effect of", goal))
    plan = fake(goals=goals, method=fake(kind=kind, on=on))
    result: Any = fake(plan=plan, jobs=1, records=2, sessions=3, surrogates=list)
    shown = design_study.shown_study(result)
    wanted = [*goals] or [design_study.Goal("cof", "1")]
    assert shown.indices == [("effect of", one) for one in wanted if kind == "sensitivity"]
    assert shown.models == ([] if kind == "sensitivity" and on == "runs" else wanted)
    assert (shown.soles, shown.missing, shown.jobs, shown.sessions) == ({}, "", 1, 3)

    def none(_):
        raise DataError("too few runs")

    result.surrogates = none
    told = design_study.shown_study(result, {1: cast(Any, "sole")})
    assert told.missing == ("" if kind == "sensitivity" and on == "runs" else "too few runs.")
    assert told.soles == {1: "sole"}


def test_a_report_of_a_study_in_its_folder(file_regression, tmp_path, monkeypatch):
    study = made(tmp_path / "s", TEXT + SWEEP, 6, 1.0)
    given: dict[str, Any] = {}

    def shown(result, soles):
        given["soles"] = list(soles)
        models = [fake(to_dict=lambda: {"name": "cof"})]
        return fake(plan=result.plan, models=models)

    monkeypatch.setattr(design_study, "shown_study", shown)
    monkeypatch.setattr(design_study, "figures", lambda ready: {"front": lambda: "a figure"})
    monkeypatch.setattr(design_study, "png", lambda figure: figure.encode())
    monkeypatch.setattr(design_study, "page_text", lambda ready, drawn: f"page of {drawn}")
    written = design_study.write_study_report(study, study.result())
    folder = study.store.folder
    told = {
        "names": sorted(name for name in os.listdir(folder) if "-" not in name),
        "given": given,
        "failures": written.failures,
        "page": (folder / "report.html").read_text(),
        "at": written.page == folder / "report.html",
        "surrogates": (folder / "surrogate.json").read_text(),
        "results": (folder / "results.csv").read_text().splitlines()[0],
    }
    held(file_regression, told)


def test_small_numbers_of_a_table_have_four_digits_and_the_smallest_three():
    assert [_cell(value)[0] for value in (0.0012345, 0.00099911, 12345.6, 123456.7, 0.0)] == [
        "0.001234", "0.000999", "1.235e+04", "1.23e+05", "0"]  # fmt: skip
