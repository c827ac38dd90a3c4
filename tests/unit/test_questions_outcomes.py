"""Many cases at once: the same numbers as one run each, computed once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.core import ConvergenceError, SourcedValue, Status
from underfoot.questions import outcomes as run_of_outcomes
from underfoot.questions.outcomes import CaseOutcome, outcomes
from underfoot.questions.sensitivity import (
    InputEffect,
    OpenInput,
    Sensitivity,
    open_inputs,
    sensitivity,
)

TEXT = """
shoe = "work_shoe_untreaded"
floor = "vinyl_g4"
contaminant = "glycerol_90pct"
motion = "slip_tester_g4"
numerics.quick_grid_spacing = "3 mm"
numerics.cells_along = 1
numerics.tread_positions = 1
"""


@pytest.fixture
def case() -> Case:
    return Case.from_text(TEXT)


@pytest.fixture(autouse=True)
def _own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path))


@pytest.fixture
def each_solved_once(monkeypatch):
    """Solve a case once for all tests; each counts and keeps outcomes for itself."""

    def known(case, **options):
        if case.hash not in SOLVED:
            SOLVED[case.hash] = run(case, **options)
        return SOLVED[case.hash]

    monkeypatch.setattr("underfoot.questions.outcomes.run", known)


SOLVED = {}


def test_outcomes_are_those_of_single_runs_and_are_kept(case, tmp_path) -> None:
    softer = case.replace("shoe.material.shore_a", 60)
    seen: list[float] = []

    def watch(stage: str, fraction: float, residual: float | None = None) -> None:
        seen.append(fraction)

    found = outcomes([case, softer, case], quick=True, progress=watch)
    alone = run(softer, quick=True)
    assert found[1].number("cof") == alone.value("cof")
    assert found[0] == found[2]
    assert seen == [0.0, 0.5, 1.0]
    assert len(list(tmp_path.rglob("*.npz"))) == 2
    seen.clear()
    assert outcomes([softer], quick=True, progress=watch) == [found[1]]
    assert seen[0] == 1.0


@pytest.mark.usefixtures("each_solved_once")
def test_a_case_that_can_not_even_start_leaves_the_others_their_numbers(case, monkeypatch) -> None:
    solved = run_of_outcomes.run
    softer = case.replace("shoe.material.shore_a", 60)

    def fails_when_soft(one, **options):
        if one == softer:
            raise ConvergenceError("could not be solved", where="sole_contact")
        return solved(one, **options)

    monkeypatch.setattr("underfoot.questions.outcomes.run", fails_when_soft)
    found = outcomes([softer, case], quick=True)
    assert found[0].status is Status.NOT_CONVERGED
    assert "could not be solved" in found[0].remedy
    assert math.isnan(found[0].number("cof"))
    assert found[1].number("cof") > 0


@pytest.mark.slow
def test_processes_change_nothing(case) -> None:
    cases = [case, case.replace("motion.speed", "0.3 m/s")]
    one = outcomes(cases, quick=True, cached=False)
    two = outcomes(cases, quick=True, cached=False, processes=2)
    for left, right in zip(one, two, strict=True):
        assert left.scalars == right.scalars


@pytest.mark.usefixtures("each_solved_once")
def test_cancel_keeps_what_is_done(case, tmp_path) -> None:
    class Stop(Exception):
        pass

    def stop(stage: str, fraction: float, residual: float | None = None) -> None:
        if fraction > 0:
            raise Stop

    with pytest.raises(Stop):
        outcomes([case, case.replace("motion.speed", "0.3 m/s")], quick=True, progress=stop)
    assert len(list(tmp_path.rglob("*.npz"))) == 1


@pytest.mark.usefixtures("each_solved_once")
def test_outcome_survives_its_text(case) -> None:
    outcome = outcomes([case], quick=True, cached=False)[0]
    assert CaseOutcome.from_text(outcome.as_text()) == outcome


def test_what_did_not_converge_is_no_number() -> None:
    value = SourcedValue(0.2, uncertainty=0.01)
    outcome = CaseOutcome("a", "h", {"cof": value}, {}, Status.NOT_CONVERGED, "", (), (), 0.1)
    assert math.isnan(outcome.number("cof"))
    assert math.isnan(outcome.standard_deviation("cof"))


def _outcome(value: float, spread: float = 0.0) -> CaseOutcome:
    scalar = SourcedValue(value, uncertainty=spread)
    return CaseOutcome("a", "h", {"cof": scalar}, {}, Status.CONVERGED, "", (), (), 0.1)


def test_band_adds_independent_spreads_in_quadrature() -> None:
    # f = 0.2 + 0.03 a + 0.04 b with a and b of standard deviation 1, and a law's spread of 0.12
    effects = tuple(
        InputEffect("p", "r", -1, 1, "1", _outcome(0.2 - slope), _outcome(0.2 + slope))
        for slope in (0.03, 0.04)
    )
    band = Sensitivity(_outcome(0.2, 0.12), effects).band("cof")
    assert band.inputs == pytest.approx(0.05)
    assert band.deviation == pytest.approx(0.13)
    assert (band.lowest, band.highest) == pytest.approx((0.16, 0.24))
    assert Sensitivity(_outcome(0.2), effects).ranked_effects("cof")[0] is effects[1]


def test_an_input_that_can_not_be_computed_is_named() -> None:
    failed = CaseOutcome(
        "a", "h", {"cof": SourcedValue(None)}, {}, Status.NOT_CONVERGED, "", (), (), 0.1
    )
    found = Sensitivity(_outcome(0.2), (InputEffect("p", "r", 0, 1, "1", failed, _outcome(0.3)),))
    assert found.band("cof").not_computed == ("p",)


def test_only_inputs_in_use_are_varied(case) -> None:
    names = {one.path for one in open_inputs(case)}
    assert "shoe.heel.facet_angle" in names
    flat = case.replace({"shoe.heel.profile": "flat", "interface.effective_rq": "20 um"})
    fewer = {one.path for one in open_inputs(flat)}
    assert "shoe.heel.facet_angle" not in fewer
    assert "interface.roughness_beyond_cutoff" not in fewer


@pytest.mark.usefixtures("each_solved_once")
def test_sensitivity_has_the_signs_of_physics(case) -> None:
    chosen = [
        OpenInput("contaminant.viscosity", 1.5, "t", ratio=True),
        OpenInput("interface.roughness_beyond_cutoff", 1.4, "t", ratio=True, low=1.0),
    ]
    found = sensitivity(case, inputs=chosen)
    viscosity, roughness = found.effects
    assert viscosity.low.number("fluid_load") < viscosity.high.number("fluid_load")
    assert roughness.low.number("fluid_load") > roughness.high.number("fluid_load")
    assert np.isfinite(found.band("fluid_load").deviation)
