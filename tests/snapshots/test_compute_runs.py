"""Whole answers of small soles: numbers, maps, draws, sentences, tables, cautions, provenance."""

from dataclasses import replace
from typing import Any

import pytest

from small_pads import ARRAY, BARS, DRY, STEP, TWO_GRIDS, pad
from snapshot import held, refusal
from underfoot.compute import answer
from underfoot.compute.check import case_check
from underfoot.compute.continuation import Continuation, kept_continuation, preview
from underfoot.compute.positions import run_cost
from underfoot.compute.result import Result
from underfoot.compute.run import run
from underfoot.core import Status
from underfoot.core.remark import Remark
from underfoot.slip import Chang2004

SQUARE = {"numerics.cells_along": 1}
THICK = {"value": "30 cP", "uncertainty": "6 cP"}
BEVEL = {"shoe.heel.profile": {"model": "facet", "angle": "5 deg", "length": "10 mm"}}
SHORT = {"motion.duration": "60 ms"}
COARSE = {"numerics.grid_spacing": "4 mm", **SQUARE}

CASES: dict[str, Any] = {
    "dry": pad(DRY, {"floor.slope": "3 deg"}),
    "spread": pad(TWO_GRIDS, SQUARE, BEVEL, {"contaminant.viscosity": THICK}),
    "bars": pad(
        BARS,
        {
            "numerics.tread_positions": 2,
            "shoe.material.shore_a": {"value": 65, "uncertainty": 2},
            "shoe.wear.depth": "0.5 mm",
        },
    ),
    "ends": pad(SHORT, SQUARE, {"numerics.grid_check": True, "risk.model": "chang_2004"}),
    "history": pad(STEP, ARRAY, COARSE),
}


def whole(result: Result, *, more: bool = False) -> dict[str, Any]:
    """Return what a result holds and says, without the time that it took."""
    made = result.provenance
    rest = {
        "errata": made.errata,
        "frame": result.to_frame().reset_index(),
        "case": result.case_text,
        "meanings": {name: one.attrs for name, one in result.fields.variables.items()},
    }
    return {
        "summary": str(result),
        "short": repr(result),
        "tables": result.tables(),
        "remarks": result.remarks(),
        "cautions": result.cautions(),
        "verdict": result.verdict(),
        "scalars": result.scalars,
        "labels": result.labels,
        "status": result.status,
        "closures": made.closures,
        "citations": made.citations,
        "objects": made.objects,
        "fields": result.fields,
        **(rest if more else {}),
    }


@pytest.mark.parametrize("name", CASES)
def test_answers_of_small_soles(file_regression, name):
    held(file_regression, whole(run(CASES[name]), more=name == "history"), f"run_{name}")


def test_a_quick_run_and_what_cases_cost(file_regression):
    held(file_regression, whole(run(pad(COARSE), quick=True)), "run_quick")
    costs = {
        f"{name} {quick}": run_cost(case, quick=quick)
        for name, case in CASES.items()
        for quick in (True, False)
    }
    held(file_regression, costs, "costs")


def test_a_sole_whose_rubber_gives_way_has_no_peak_of_the_film(file_regression):
    """The sensor's, a mean over its face, it has."""
    steep = {
        "motion.shoe_angle": "20 deg",
        "motion.normal_force": "400 N",
        "shoe.material.shore_a": 40,
    }
    made = run(pad(COARSE, steep, {"numerics.quick_grid_spacing": "4 mm",
                                   "contaminant.viscosity": "1 Pa s"}), quick=True)  # fmt: skip
    assert made.scalars["peak_fluid_pressure"].value is None
    assert made.value("peak_fluid_pressure_sensor") > 0
    held(
        file_regression,
        [made.headline(), made.cautions(), made.scalars, made.labels],
        "run_crushed",
    )


def test_objects_stand_in_for_options(file_regression):
    case = pad(COARSE)
    made = run(case, quick=True, risk=Chang2004(), viscosity="50 cP", friction="stribeck")
    told = made.cautions(), made.labels, made.provenance.objects, made.provenance.closures
    held(file_regression, [*told, made.assumptions, made.scalars], "run_objects")
    refused = {
        "slot": refusal(run, case, shoes=3),
        "risk": refusal(run, case, risk=3),
        "text": refusal(run, case, friction="no such"),
        "memory": refusal(
            run, pad({"numerics.grid_spacing": "0.05 mm", "numerics.most_memory": "0.2 GB"})
        ),
    }
    held(file_regression, refused, "objects_refused")


def test_nothing_is_said_of_lugs_whose_film_bears_little():
    """A twentieth of the load or less: how they drain it moves nothing."""
    thin = run(pad(BARS, {"contaminant.viscosity": "1 cP"}), quick=True)
    assert 0.005 < thin.value("fluid_load") / thin.value("normal_force") < 0.05
    assert "drainage" not in thin.labels


def test_a_contact_table_takes_time_where_no_file_brings_it(tmp_path):
    file = tmp_path / "made.npz"
    file.touch()
    model = pad({"rough_contact": {"model": "contact_table"}})
    check = case_check(pad(COARSE))
    (_, dear) = replace(check, case=model).headline()
    assert "contact table takes about" in dear
    brought = model.replace("rough_contact.file", str(file))
    assert len(replace(check, case=brought).headline()) == 1


def test_cases_before_they_are_computed(file_regression):
    checks = {}
    for name, case in CASES.items():
        check = case_check(case)
        checks[name] = {
            "text": str(check) if name == "ends" else None,
            "remarks": check.remarks(),
            "short": repr(check),
            "dict": check.to_dict() if name == "ends" else None,
            "cautions": check.cautions(),
            "headline": check.headline(),
        }
    huge = case_check(pad({"numerics.grid_spacing": "0.05 mm", "numerics.most_memory": "0.2 GB"}))
    checks["huge"] = huge.headline(), huge.cautions()
    finite = case_check(pad({"compliance": "finite_element"}))
    checks["finite"] = finite.headline(), finite.cautions()
    held(file_regression, checks, "checks")


def test_a_march_goes_on_under_changes(file_regression):
    case = pad(COARSE, {"numerics.quick_grid_spacing": "4 mm"}, {"contaminant.viscosity": "20 cP"})
    begun = Continuation(case)
    seen = {
        "own": begun.values,
        "cof": begun.cof,
        "draws": begun.cof_draws,
        "spreads": begun.spreads,
        "stated": begun.stated,
    }
    for change, drawn in (
        ({"contaminant.viscosity": "30 cP"}, True),
        ({"motion.normal_force": "60 N"}, False),
    ):
        told = begun.continue_march(change, drawn=drawn)
        parts = {name: getattr(told, name) for name in told.__dataclass_fields__}
        parts.pop("seconds")
        seen[str(change)] = parts, str(told)
    for change in (
        {"motion.speed": "0.4 m/s"},
        {"motion.shoe_angle": "4 deg"},
        {"shoe.heel.length": "32 mm"},
        STEP,
    ):
        seen[f"refused {change}"] = refusal(begun.continue_march, change)
    seen["history"] = refusal(preview, pad(STEP), {})
    held(file_regression, seen, "continued")
    assert kept_continuation(case) is kept_continuation(case)


@pytest.mark.parametrize("solved", [Status.CONVERGED, Status.NOT_CONVERGED])
@pytest.mark.parametrize("breached", [False, True])
def test_a_run_that_did_not_converge_is_never_only_out_of_range(monkeypatch, solved, breached):
    real = answer.answer

    def with_status(parts, solution, *more):
        contact = replace(solution.contact, status=solved)
        return real(parts, replace(solution, contact=contact), *more)

    told = [Remark("shoe", "odd")] if breached else []
    monkeypatch.setattr(answer, "_breaches", lambda *_: told)
    monkeypatch.setattr("underfoot.compute.run.answer", with_status)
    status = run(pad(DRY), quick=True).status
    beyond = breached and solved is Status.CONVERGED
    assert status is (Status.OUT_OF_RANGE if beyond else solved)
