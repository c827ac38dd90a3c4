"""The chance of a slip and what would help: arithmetic, and the command as a person uses it."""

from __future__ import annotations

import csv
import json
import signal
import subprocess
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import norm

from commands import COMMAND, called
from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.core import Cancelled, InputError
from underfoot.core.presentation import percent
from underfoot.questions.changes import Change, possible_changes
from underfoot.questions.effects import STAGE
from underfoot.questions.risk import odds, risk_assessment
from underfoot.slip import MODELS, Chang2004, RcofPopulation, needed_acof, slip_model, slip_risk

TEXT = """
name = "Worn work shoe"
shoe = "work_shoe_untreaded"
floor = "vinyl_g4"
contaminant = "glycerol_90pct"
motion = "slip_tester_g4"
numerics.quick_grid_spacing = "2.5 mm"
numerics.cells_along = 1
numerics.tread_positions = 1
"""


@pytest.fixture(autouse=True)
def _own_cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path_factory.mktemp("cache")))


@given(
    risk=st.floats(0.001, 0.5),
    mean=st.floats(0.15, 0.35),
    sd=st.floats(0.01, 0.05),
    name=st.sampled_from(sorted(MODELS)),
)
def test_needed_friction_gives_back_the_risk(risk, mean, sd, name) -> None:
    rcof, model = RcofPopulation(mean, sd), slip_model(name)
    acof = needed_acof(risk, rcof=rcof, model=model)
    assert model.population(acof, mean, sd) == pytest.approx(risk, rel=1e-6)


def test_needed_friction_of_two_normals_in_closed_form() -> None:
    rcof = RcofPopulation(0.2, 0.03)
    expected = 0.2 + norm.isf(0.05) * 0.03  # ACOF taken as certain
    assert needed_acof(0.05, rcof=rcof, model=Chang2004()) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("risk", [0.0, 1.0, -0.1, 1.5])
def test_impossible_risks_are_refused(risk) -> None:
    with pytest.raises(InputError, match="above 0 and below 1"):
        needed_acof(risk)
    with pytest.raises(InputError, match="above 0 and below 1"):
        risk_assessment(Case.from_text(TEXT), target=risk)


def test_changes_fit_the_case() -> None:
    worn = Case.from_text(TEXT.replace("2.5 mm", "1 mm"))
    names = {change.name for change in possible_changes(worn)}
    assert "new_tread" in names
    assert "wider_channels" not in names
    treaded = worn.replace({"shoe": "work_shoe_full_tread", "contaminant": "water"})
    names = {change.name for change in possible_changes(treaded)}
    assert "wider_channels" in names
    assert not names & {"new_tread", "rinse", "dilute"}
    oily = {one.name: one for one in possible_changes(worn.replace("contaminant", "canola_oil"))}
    assert "stays on the floor under the water" in oily["rinse"].reason
    assert "dilute" in oily
    unknown = {
        one.name: one
        for one in possible_changes(worn.replace("contaminant", {"viscosity": "75 cP"}))
    }
    assert "contaminant.family" in unknown["rinse"].reason
    known = {one.name: one for one in possible_changes(worn)}
    assert not known["rinse"].reason
    assert "as a clean wet floor" in known["rinse"].action
    for case in (worn, treaded):
        for change in possible_changes(case):
            assert case.replace(change.values) != case


@pytest.mark.parametrize("fluid", ["canola_oil", {"viscosity": "75 cP"}])
def test_rinsing_what_does_not_mix_with_water_is_never_ranked(fluid) -> None:
    case = Case.from_text(TEXT).replace("contaminant", fluid)
    changes = [one for one in possible_changes(case) if one.lever == "cleaning"]
    found = risk_assessment(case, changes=changes)
    assert "rinse" not in [each.change.name for each in found.best]
    (row,) = (row for row in found.table().rows if "rinse" in row[1])
    assert row[0] == "-"
    assert "water" in row[-1]
    assert all(0 <= each.higher <= 1 for each in found.best)


@pytest.mark.slow
def test_changes_are_computed_and_ranked_by_the_chance_they_leave() -> None:
    # at an instant: the film of steady sliding carries too little here to be the limit
    case = Case.from_text(TEXT).replace("motion.duration", "0.12 s")
    rougher = Change("rougher", "rougher", "shoe", {"interface.roughness_beyond_cutoff": 4})
    slower = Change("slower", "slower", "walking", {"risk.rcof_mean": 0.15})
    wrong = Change("wrong", "wrong", "shoe", {"shoe.material.shore_a": 1000})
    found = risk_assessment(case, changes=[rougher, wrong, slower])
    assert [one.change.name for one in found.changes] == ["rougher", "wrong", "slower"]
    assert not found.changes[1].computed
    assert "100" in found.changes[1].reason
    chances = [one.number("slip_probability") for one in found.best]
    assert chances == sorted(chances)
    assert all(each < found.outcome.number("slip_probability") for each in chances)
    assert found.changes[2].number("cof") == found.outcome.number("cof")
    assert found.limit.kind == "film"
    share = found.limit.film_share
    solid = found.outcome.number("cof") - found.outcome.number("cof_viscous")
    assert found.limit.cof_without_film * (1 - share) == pytest.approx(solid)
    assert found.missing_friction is not None
    own = next(one for one in found.models if one.name == case.risk.name)
    assert own.probability == found.outcome.number("slip_probability")
    needed = found.missing_friction + found.outcome.number("cof")
    assert needed == pytest.approx(own.needed_acof)
    draws = run(case, quick=True).data["cof_draws"].values
    enough = draws * needed / found.outcome.number("cof")
    assert slip_risk(needed, samples=enough).probability.value == pytest.approx(0.05, abs=1e-4)
    assert f"{100 * share:.0f} % of the load" in " ".join(found.headline())
    assert len(found.change_sentences()) == len(found.best[:3])
    assert [row[0] for row in found.table().rows] == ["1.", "2.", "-"]


def test_no_change_gives_back_the_result_and_other_walkers_take_its_friction() -> None:
    tread = {"pattern": "grid", "depth": "3 mm", "lug_width": "12 mm", "channel_width": "6 mm"}
    case = Case.from_text(TEXT).replace({f"shoe.tread.{key}": tread[key] for key in tread})
    fine = case.replace({"numerics.grid_spacing": "2 mm", "numerics.tread_positions": 2})
    result = run(fine)
    viscosity = fine.value("contaminant.viscosity")
    same = Change("same", "same", "cleaning", {"contaminant.viscosity": viscosity})
    slower = Change("slower", "slower", "walking", {"risk.rcof_mean": 0.15})
    kept, walked = risk_assessment(fine, result=result, changes=[same, slower]).changes
    for name in ("cof", "fluid_load"):
        assert kept.number(name) == pytest.approx(result.value(name), rel=1e-6)
    # by draws about the preview of the coarse grid
    assert kept.number("slip_probability") == pytest.approx(
        result.value("slip_probability"), abs=0.02
    )
    assert walked.scalars["cof"] == result.scalars["cof"]
    assert (
        walked.scalars["slip_probability"]
        == (run(fine.replace(slower.values)).scalars["slip_probability"])
    )
    with pytest.raises(InputError, match="not of this case"):
        risk_assessment(case, result=result)


@pytest.mark.slow
def test_a_motion_with_a_history_is_run_for_each_change() -> None:
    case = Case.from_text(TEXT).replace("motion", "heel_strike_to_flat")
    rougher = Change("rougher", "rougher", "floor", {"floor.roughness.rq": 5e-6})
    (found,) = risk_assessment(case, changes=[rougher]).changes
    alone = run(case.replace(rougher.values), quick=True)
    for name, scalar in found.scalars.items():
        assert scalar.value == pytest.approx(alone.value(name), rel=1e-9)
    assert found.error is None


def test_cancel_ends_the_changes() -> None:
    def stop(stage: str, fraction: float, residual: float | None = None) -> None:
        if stage == STAGE:
            raise Cancelled(stage)

    with pytest.raises(Cancelled):
        risk_assessment(Case.from_text(TEXT), progress=stop)


@pytest.mark.parametrize(
    "shoe",
    [
        pytest.param("work_shoe_full_tread", marks=pytest.mark.slow),
        pytest.param("work_shoe_untreaded", marks=pytest.mark.study),
    ],
)
def test_changes_are_those_of_whole_runs(shoe) -> None:
    case = Case.load(f"examples/{shoe}_glycerol.toml")
    if "untreaded" in shoe:  # whose film needs cells along the sliding: dear at every angle
        one = {"numerics.quick_grid_spacing": "1.2 mm", "numerics.tread_positions": 1}
        case = case.replace(one)
    found = risk_assessment(case)
    slips = {"own": found.outcome.number("slip_probability")}
    for effect in found.changes:
        alone = run(case.replace(effect.change.values), quick=True)
        off = abs(effect.number("cof") - alone.value("cof"))
        assert off <= max(0.01, effect.error or 0.0), effect.change.name
        slips[effect.change.name] = alone.value("slip_probability")
        off = abs(effect.number("slip_probability") - slips[effect.change.name])
        assert off <= 0.03, effect.change.name
    best = [each.change.name for each in found.best]
    assert best[:3] == sorted(best, key=lambda name: slips[name])[:3]
    assert all(slips[name] < slips["own"] for name in best[:3])


def test_without_a_film_the_fluid_limits() -> None:
    found = risk_assessment(Case.from_text(TEXT).replace("contaminant", "detergent"), changes=[])
    if found.limit.film_share < 0.05:
        assert found.limit.kind == "boundary"
    assert found.limit.cof == found.outcome.number("cof")


@pytest.mark.parametrize(
    ("probability", "text"),
    [
        (1e-5, "fewer than 1 in 1000 steps"),
        (0.01, "1 in 100 steps"),
        (0.199, "1 in 5 steps"),
        (0.54, "54 % of steps"),
    ],
)
def test_probabilities_as_odds(probability, text) -> None:
    assert odds(probability) == text


def test_percent_has_no_false_digits() -> None:
    assert [percent(p) for p in (1e-6, 0.0234, 0.54, 0.9999)] == [
        "below 0.1 %",
        "2.3 %",
        "54 %",
        "above 99.9 %",
    ]


@pytest.mark.slow
def test_command(tmp_path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(TEXT, encoding="utf-8")
    done = called("risk", path, "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert "Slip probability" in done.stdout
    stored = json.loads((tmp_path / "out" / "risk.json").read_text(encoding="utf-8"))
    assert {one["name"] for one in stored["models"]} >= set(MODELS)
    with (tmp_path / "out" / "changes.csv").open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == len(stored["changes"]) > 4
    wrong = called("risk", path, "--target", "150 %")
    assert wrong.returncode != 0
    assert "above 0 and below 1" in wrong.stderr


@pytest.mark.slow
def test_a_full_run_ends_with_what_would_help(tmp_path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(TEXT + 'numerics.grid_spacing = "2.5 mm"\n', encoding="utf-8")
    done = called("run", path, "--out", tmp_path / "full")
    assert done.returncode == 0, done.stderr
    stored = json.loads((tmp_path / "full" / "risk.json").read_text(encoding="utf-8"))
    best = min(
        (one for one in stored["changes"] if one["slip_probability"] is not None),
        key=lambda one: one["slip_probability"],
    )
    page = (tmp_path / "full" / "report.html").read_text(encoding="utf-8")
    for text in (done.stdout.replace("\n", " "), page):
        assert best["action"] in " ".join(text.split())
        assert "The film carries" in text
    assert called("run", path, "--out", tmp_path / "plain", "--no-advice").returncode == 0
    assert not (tmp_path / "plain" / "risk.json").exists()


@pytest.mark.slow
def test_a_run_that_is_stopped_in_its_advice_has_stored_its_answer(tmp_path) -> None:
    path, stored = tmp_path / "case.toml", tmp_path / "full" / "result.json"
    path.write_text(TEXT + 'numerics.grid_spacing = "2.5 mm"\n', encoding="utf-8")
    command = [*COMMAND, "run", str(path), "--out", str(tmp_path / "full")]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as running:
        while not stored.exists() and running.poll() is None:  # stored before advice begins
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        _, said = running.communicate(timeout=180)
    assert running.returncode == 130, said
    assert json.loads(stored.read_text(encoding="utf-8"))["cof"]["value"] > 0
    assert not (tmp_path / "full" / "risk.json").exists()
