"""What questions say of made-up outcomes: number, unit, uncertainty, then the caution."""

import dataclasses
import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.compute import summary
from underfoot.core import InputError, Remark, SourcedValue, Status
from underfoot.core.presentation import value_text
from underfoot.questions.changes import Change
from underfoot.questions.comparison import ComparedQuantity, Comparison, _reasons
from underfoot.questions.effects import ChangeEffect
from underfoot.questions.order import Order
from underfoot.questions.outcomes import CaseOutcome
from underfoot.questions.risk import ModelRisk, RiskAssessment
from underfoot.questions.sensitivity import QUANTITIES, InputEffect, Sensitivity
from underfoot.questions.wear import WearSeries, deepest_wear, limit_load
from underfoot.questions.wear_limit import Crossing, LimitCrossing, WearPoint
from underfoot.report.question_figures import sensitivity_figure
from underfoot.shoe.worn import WearMeasures


def outcome(cof=0.1, slip=0.6, fluid=100.0, note="", **changes):
    scalars = {
        "cof": SourcedValue(cof, uncertainty=0.02),
        "cof_adhesion": SourcedValue(0.02, uncertainty=0.01),
        "cof_hysteresis": SourcedValue(0.05),
        "cof_viscous": SourcedValue(0.02),
        "normal_force": SourcedValue(500.0, "N"),
        "fluid_load": SourcedValue(fluid, "N", uncertainty=5.0),
        "fluid_load_sensor": SourcedValue(fluid / 10, "N"),
        "peak_fluid_pressure": SourcedValue(2e5, "Pa"),
        "peak_fluid_pressure_sensor": SourcedValue(1e5, "Pa"),
        "minimum_film_thickness": SourcedValue(1e-5, "m"),
        "slip_probability": SourcedValue(slip, interval=(0.4, 0.8), uncertainty=0.1, note=note),
    }
    made = CaseOutcome("Case", "hash", scalars, {}, Status.CONVERGED, "", (), (), 1.0)
    return dataclasses.replace(made, **changes)


FAILED = outcome(status=Status.NOT_CONVERGED)


def test_the_limit_of_the_friction_is_film_blocked_adhesion_or_the_dry_pair():
    film = summary.friction_limit(outcome(cof=0.1, fluid=250.0).scalars)
    # (0.1 - 0.02) / (1 - 0.5)
    assert (film.kind, film.cof_without_film) == ("film", pytest.approx(0.16))
    assert (
        "50 % of the load; without the film the same surfaces would have a COF of about 0.16"
        in (str(film))
    )
    little = summary.friction_limit(outcome(fluid=20.0).scalars)
    assert little.kind == "boundary"
    # 6 % of the load, but the fluid's own shear is what the film gives away
    useless = summary.friction_limit(outcome(cof=0.03, fluid=30.0).scalars)
    assert useless.kind == "boundary"
    # nearly all of the load floats: what the fluid gives is friction too, nothing else is left
    # (0.021 - 0.02) / (1 - 0.98) = 0.05 is more than 0.021, with 0.0203 it is 0.015
    assert summary.friction_limit(outcome(cof=0.021, fluid=490.0).scalars).kind == "film"
    floating = summary.friction_limit(outcome(cof=0.0203, fluid=490.0).scalars)
    assert floating.kind == "shear"
    assert str(floating).endswith("98 % of the load; shearing the fluid makes 99 % of this COF.")
    afloat = summary.friction_limit(outcome(cof=0.02, fluid=500.0).scalars)
    assert str(afloat).endswith("100 % of the load; shearing the fluid makes 100 % of this COF.")
    scalars = outcome().scalars | {"minimum_film_thickness": SourcedValue(None, "m")}
    assert summary.friction_limit(scalars).kind == "no fluid"


def test_the_headline_has_the_number_first_and_marks_what_is_extrapolated():
    note = "extrapolated: ACOF - RCOF = -0.2 is outside the tested -0.1 to 0.1"
    made = outcome(fluid=250.0, note=note)
    first, second, third = summary.headline(made.status, made.scalars, {"regime": "mixed"})
    assert (
        first
        == "Available COF 0.100 ± 0.020, one standard deviation of friction law and film load."
    )
    assert "50 % of the load (mixed)" in second
    assert third == "Slip probability 60 % ± 10 %, extrapolated."
    breaches = (
        Remark("report_g6", "x"),
        Remark("stribeck", "pressure 3"),
        Remark("stribeck", "speed 4"),
    )
    cautions = summary.cautions(
        made.status, made.scalars, breaches, (Remark("interface", "a = 1 (b)"),), "report_g6"
    )
    assert cautions[0].startswith("Slip probability extrapolated: ACOF - RCOF")
    assert cautions[1] == (
        "Beyond what was tested: the friction of this sole on this floor (stribeck)."
    )
    assert "interface roughness" in cautions[2]
    assert summary.cautions(made.status, outcome().scalars, (), (Remark("motion", "a = 1"),)) == ()
    failed = summary.headline(Status.NOT_CONVERGED, made.scalars, {})
    assert failed[0].startswith("No result: not converged.")
    assert summary.cautions(Status.NOT_CONVERGED, made.scalars, breaches, ()) == ()


def assessment(*effects, missing=0.1, present=None):
    present = outcome() if present is None else present
    limit = summary.friction_limit(outcome().scalars)
    models = (
        ModelRisk("a", "b", "As a.", 0.6, None, None, None),
        ModelRisk("c", "d", "Every c slips.", 0.5, 0.4, 0.6, 0.31),
    )
    return RiskAssessment("Case", present, models, limit, 0.05, missing, effects)


def effect(name, cof, slip, **changes):
    scalars = outcome(cof, slip, **changes).scalars
    return ChangeEffect(Change(name, f"do {name}", "shoe", {}), scalars)


def test_a_probability_that_is_not_known_is_never_one_number():
    def spread(value, low, high):
        return SourcedValue(value, uncertainty=(high - low) / 4, interval=(low, high))

    wide, narrow = spread(0.45, 0.002, 0.93), spread(0.45, 0.35, 0.55)
    assert value_text("slip_probability", wide) == "45 % (0.2 % to 93 %)"
    assert value_text("slip_probability", narrow) == "45 % ± 5.0 %"
    present = outcome()
    found = assessment(
        effect("open", 0.3, 0.1),
        present=dataclasses.replace(present, scalars={**present.scalars, "slip_probability": wide}),
    )
    (change,) = found.change_sentences()
    assert change.startswith("do open: COF 0.10 to 0.30, slip probability 45 % (0.2 % to 93 %)")
    models = found.tables()[1].rows
    assert [row[1] for row in models] == ["60 %", "50 %"]
    rare = spread(0.1, 0.001, 0.8)
    odd = dataclasses.replace(present, scalars={**present.scalars, "slip_probability": rare})
    assert "steps" not in assessment(present=odd).headline()[0]


def test_changes_are_ranked_by_the_probability_they_leave_then_by_friction():
    worse, failed = (
        effect("worse", 0.05, 0.9),
        ChangeEffect(Change("x", "do x", "shoe", {}), {}, "not converged"),
    )
    found = assessment(
        worse,
        effect("good", 0.2, 0.3),
        effect("best", 0.3, 0.1),
        failed,
        effect("equal", 0.25, 0.3),
    )
    assert [each.change.name for each in found.best] == ["best", "equal", "good"]
    assert found.change_sentences(1) == ["do best: COF 0.10 to 0.30, slip probability 60 % to 10 %"]
    assert [row[0] for row in found.table().rows] == ["1.", "2.", "3.", "-", "-"]
    assert found.table().rows[0][1] == found.best[0].change.action
    assert found.table().rows[-1][-1].startswith("not computed")
    assert assessment(worse).change_sentences() == [
        "No tested change reduces the slip probability."
    ]
    assert math.isnan(failed.number("cof"))


def test_a_change_that_does_nothing_is_no_row():
    idle, small = effect("idle", 0.1003, 0.6003), effect("small", 0.1006, 0.6)
    found = assessment(idle, small, effect("good", 0.2, 0.3))
    assert [row[1] for row in found.table().rows] == ["do good", "do small"]
    assert found.remarks()["Tried without effect"] == ["do idle"]


def test_a_toss_up_is_no_advice():
    """Wider channels: COF 0.161 to 0.160, 41 % to 40 %, higher with 50 %, stood fourth."""

    def tried(name, cof, slip, higher):
        return dataclasses.replace(effect(name, cof, slip), higher=higher)

    toss_up, same = tried("toss-up", 0.099, 0.59, 0.5), tried("same", 0.102, 0.6, 0.52)
    good, unsure = tried("good", 0.2, 0.3, 0.8), tried("unsure", 0.15, 0.5, 0.56)
    found = assessment(toss_up, same, good, unsure)
    assert [each.change.name for each in found.best] == ["good", "unsure"]
    assert [row[0] for row in found.table().rows] == ["1.", "2.", "-"]
    assert found.remarks()["Tried without effect"] == ["do same"]


def test_a_model_with_another_answer_is_told_with_its_reason():
    (other,) = assessment(present=outcome(slip=0.45)).apart
    assert other.name == "a"
    told = [text for text in assessment(present=outcome(slip=0.3)).cautions() if "nother" in text]
    assert told == [
        "Another model has 60 % for the same friction and people (a): as a.",
        "Another model has 50 % for the same friction and people (c): every c slips.",
    ]
    assert not assessment(present=outcome(slip=0.55)).apart


def test_a_model_by_which_friction_is_not_enough_is_told():
    """1.9 % is below 5 %, 9 % of another model is not, though they differ by less than 0.1."""
    near = ModelRisk("a", "b", "As a.", 0.09, None, None, None)
    low = ModelRisk("c", "d", "As c.", 0.001, None, None, None)
    found = replace(assessment(present=outcome(slip=0.019)), models=(near, low))
    assert [one.name for one in found.apart] == ["a"]
    assert any("Another model has 9.0 %" in text for text in found.cautions())


def test_missing_friction_is_named_and_sufficient_friction_too():
    assert "needs a COF higher by 0.10" in assessment().headline()[-1]
    for slip, enough in ((0.0501, False), (0.05, True), (0.01, True)):
        for missing in (None, 0.0, 0.1):  # the number that is printed decides
            found = assessment(missing=missing, present=outcome(slip=slip)).headline()[-1]
            assert found.startswith("Friction is sufficient for") == enough
    assert assessment(missing=None).headline()[-1].startswith("No COF gives")
    assert assessment().headline()[0].startswith("Slip probability 60 % ± 10 % at an available COF")
    assert "1 in 10 steps" in assessment(present=outcome(slip=0.1)).headline()[0]
    assert "extrapolated" in assessment(present=outcome(note="extrapolated: x")).headline()[0]
    failed = assessment(present=FAILED)
    assert failed.headline()[0].startswith("No result")
    assert not failed.usable
    assert failed.tables() == ()
    table = assessment().tables()[1]
    assert [row[2] for row in table.rows] == ["not reachable", "0.310"]


def test_a_sensitivity_names_the_most_effective_input_and_the_spread_it_gives():
    slope = InputEffect("shoe.a", "r", 1.0, 2.0, "1", outcome(0.06), outcome(0.14))
    flat = InputEffect("shoe.b", "r", 1.0, 2.0, "1", outcome(0.1), outcome(0.11))
    lost = InputEffect("shoe.c", "r", 1.0, 2.0, "1", FAILED, outcome(0.1))
    found = Sensitivity(outcome(), (flat, slope, lost))
    # inputs: 0.04 and 0.01 / sqrt 2; law: 0.02
    inputs = math.hypot(0.04, 0.01 / math.sqrt(2))
    assert found.band("cof").inputs == pytest.approx(inputs)
    total = math.hypot(inputs, 0.02)
    assert found.headline()[0].startswith(f"COF 0.100 ± {total:.3f} (friction law ± 0.020, assumed")
    assert "0.060 to 0.140" in found.headline()[0]
    assert "shoe.a, 1 to 2 changes the COF from 0.06 to 0.14" in found.headline()[1]
    assert any("shoe.c" in caution for caution in found.cautions())
    assert any("Coarse grid" in caution for caution in found.cautions())
    assert len(found.tables()) == 1 + len(QUANTITIES)
    assert [row[0] for row in found.tables()[1].rows] == ["shoe.a", "shoe.b", "shoe.c"]
    assert found.tables()[1].rows[2][3] == "not computed"
    assert len(found.data_tables()["sensitivity"].rows) == 3 * len(QUANTITIES)
    assert Sensitivity(FAILED, ()).tables() == ()
    rows = [label.get_text() for label in sensitivity_figure(found).axes[0].get_yticklabels()]
    assert [row.partition("\n")[0] for row in rows] == ["c", "b", "a"]  # the strongest on top


def series(cofs, crossing=Crossing.WITHIN, variants=()):
    points = tuple(
        WearPoint(
            WearMeasures(k * 1e-3, (3 - k) * 1e-3, 3e-3, k * 1e-4, 0, 0, k * 1e-9),
            outcome(cof) if cof else FAILED,
            variants,
        )
        for k, cof in enumerate(cofs)
    )
    at = {
        "removed_depth": 1e-3,
        "tread_left": 2e-3,
        "mean_tread_left": 2e-3,
        "worn_patch_area": 0.0,
    }
    low, high = dict(at, tread_left=1e-3), dict(at, tread_left=-math.inf)
    one = LimitCrossing(crossing, 0.5, at, low, high)
    return WearSeries(
        "Case", "plane", 5.0, points, {"fluid_load": one, "fluid_load_sensor": one}, ("a",)
    )


def test_wear_says_when_the_limit_is_exceeded_and_when_friction_rises():
    found = series([0.10, 0.11, 0.12])
    assert found.headline()[0] == (
        "The fluid load as floor sensors read it exceeds 5 N with 2 mm (90 %: 1 to beyond the "
        "range) of tread left at the most worn place."
    )
    assert found.headline()[2] == "COF 0.100 new and 0.120 at the last state."
    assert any("still rises" in caution for caution in found.cautions())
    bare = dataclasses.replace(found, untreaded=outcome(0.05))
    assert "0.050 with the tread gone" in bare.headline()[2]
    assert not any("rises" in caution for caution in bare.cautions())
    falling = dataclasses.replace(series([0.12, 0.11, 0.10]), untreaded=outcome(0.05))
    assert falling.headline()[2] == (
        "COF 0.120 new and 0.100 at the last state; 0.050 if that sole had no tread at all."
    )
    assert not any("rises" in caution for caution in series([0.12, 0.11, 0.10]).cautions())
    assert not any("rises" in caution for caution in series([0.100, 0.104]).cautions())
    assert "No result for state 1" in " ".join(series([0.1, None, 0.1]).cautions())
    varied = series([0.1, 0.1], Crossing.NEVER, (("x", outcome(0.05), outcome(0.2)),))
    assert "stays below 5 N within the range (50 % of the draws" in varied.headline()[0]
    assert [list(end) for end in varied.ends("cof")] == [[0.05, 0.05], [0.2, 0.2]]
    assert "already when new" in series([0.1, 0.1], Crossing.FROM_NEW).headline()[0]
    assert "not determined" in series([0.1, 0.1], Crossing.UNKNOWN).headline()[0]
    assert not series([None, None]).usable
    rows = found.data_tables()["wear"].rows
    assert [row[5] for row in rows] == [0.10, 0.11, 0.12]
    patch, _, slight, _ = found.tables()[1].rows
    assert patch[1].startswith(("agrees", "disagrees", "not testable"))
    assert slight[1] == "disagrees"
    for cofs, verdict in (
        ([0.10, 0.12, 0.11, 0.05], "agrees"),
        ([0.10, 0.12, 0.05, 0.06], "disagrees"),
        ([0.10, None, 0.05], "not testable on this series"),
    ):
        assert series(cofs).tables()[1].rows[2][1] == verdict


def test_a_limit_is_a_force_or_a_share_and_a_depth_has_a_unit():
    assert limit_load("5N", 500.0) == 5.0
    assert limit_load("20 %", 500.0) == 100.0
    assert deepest_wear("2 mm", "plane") == 2e-3
    assert deepest_wear("1500 mm^2", "patch") == pytest.approx(1.5e-3)
    assert deepest_wear(None, "patch") is None
    for text in ("five", "x %"):
        with pytest.raises(InputError):
            limit_load(text, 500.0)


def test_old_option_names_answer_with_a_note(capsys):
    import typer
    from typer.testing import CliRunner

    from underfoot.cli.groups import Command

    app, seen = typer.Typer(), SimpleNamespace(target=None)

    def risk(target: str = "5 %"):
        seen.target = target

    app.command("risk", cls=Command)(risk)
    app.command("other")(lambda: None)
    done = CliRunner().invoke(app, ["risk", "--wanted", "2 %"])
    assert done.exit_code == 0, done.output
    assert seen.target == "2 %"
    assert "--wanted is now --target" in done.stderr
    assert CliRunner().invoke(app, ["risk", "--target=3 %"]).stderr == ""
    assert seen.target == "3 %"


def test_files_are_compared_by_their_names_and_checksums_only_where_these_are_alike():
    from underfoot.questions.comparison import with_short_names

    sums = ("shoe.outsole.sha256", "a" * 64, "b" * 64)
    apart = [("shoe.outsole.file", "/x/one.stl", "/x/two.stl"), sums]
    assert with_short_names(apart) == [("shoe.outsole.file", "one.stl", "two.stl")]
    alike = [("shoe.outsole.file", "/x/one.stl", "/y/one.stl"), sums]
    assert with_short_names(alike)[1] == ("shoe.outsole.sha256", "a" * 8, "b" * 8)
    assert with_short_names(alike)[0] == alike[0]
    changed = [sums]
    assert with_short_names(changed) == [("shoe.outsole.sha256", "a" * 8, "b" * 8)]


def test_breaches_begin_with_what_their_model_is_for():
    from underfoot.compute.summary import in_words

    breaches = [Remark("pair", "speed 5 m/s is outside b"), Remark("mine", "a is outside b")]
    pair, own = in_words(breaches)
    assert pair.startswith("The friction of this sole on this floor: speed 5 m/s")
    assert "pair:" not in pair
    assert own == "mine: a is outside b"


@pytest.mark.parametrize(("letters", "begins"), [("AB", "higher"), ("ABC", "B higher")])
def test_a_table_names_what_an_order_is_of_where_there_are_more_than_two(letters, begins):
    values = tuple(SourcedValue(0.2) for _ in letters)
    compared = ComparedQuantity("cof", "COF", values, {"B": Order(0.9, 0.0)})
    results = tuple(SimpleNamespace(name=letter) for letter in letters)
    table = Comparison(cast(Any, results), (), (compared,), (), ()).table()
    assert table.rows[0][-1].startswith(begins)


@pytest.mark.parametrize("versions", [("0.3", "0.3"), ("0.3", "0.4")])
def test_results_of_two_versions_are_told(versions):
    results = [
        SimpleNamespace(
            data={"x": SimpleNamespace(values=np.arange(4))},
            provenance=SimpleNamespace(versions={"underfoot": version}),
            status=Status.CONVERGED,
            breaches=(),
        )
        for version in versions
    ]
    told = any("different versions" in reason for reason in _reasons(cast(Any, results)))
    assert told == (versions[0] != versions[1])
