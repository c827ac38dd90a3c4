"""Small parts of studies with made-up runs: joint draws, drawn slips, solved treads, readings."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from test_studies_answers import drawn

from small_pads import pad
from snapshot import held
from underfoot.compute.prepare import prepare_case
from underfoot.core import SourcedValue, Status
from underfoot.friction import packaged_pair_draws
from underfoot.friction.propagation import normal_draws
from underfoot.sole_contact.lug_edges import EdgedLaw
from underfoot.studies import (
    corpus,
    corpus_cases,
    default_law,
    g5,
    g6,
    lug_states,
    pair_law,
    sources,
    transient,
    tread_pairs,
    validation,
)
from underfoot.studies.sources import PublishedReading


@pytest.mark.parametrize(("kind", "low", "high", "text"), [
    ("value", 0.12345, 0.12345, "0.123"), ("lower", 0.5, math.inf, "at least 0.5"),
    ("upper", 0.0, 0.25, "at most 0.25"), ("range", 0.2, 0.31, "0.2 to 0.31"),
])  # fmt: skip
def test_a_reading_in_words(kind, low, high, text):
    assert corpus._reading_text(PublishedReading(kind, low, high, 0.1, "")) == text


def run_of(cof: float, draws: Any, asked: list[Any]) -> Any:
    """Return what stands for ``run``: a COF and its draws."""

    def run(case: Any, *, quick: bool) -> Any:
        asked.append((case, quick))
        data = {"cof_draws": SimpleNamespace(values=np.array(draws))}
        return SimpleNamespace(value={"cof": cof}.__getitem__, data=data)

    return run


def test_draws_of_a_sole_are_those_of_its_law_about_its_value_times_its_hardness(monkeypatch):
    """The quick grid knows the spread, the fine one the value: 0.3 over 0.2 of each draw."""
    asked: list[Any] = []
    draws = 0.2 * np.exp(0.1 * np.cos(np.arange(50.0)))
    monkeypatch.setattr(g6, "run", run_of(0.2, draws, asked))
    friction: Any = g6.SoleFriction(
        "hard", "pair", 60.0, 0.3, math.nan, math.nan, 0.36, 0.25, (), 0.5
    )
    made = g6._with_draws(friction)
    ((case, quick),) = asked
    assert quick
    assert case == g6.sole_case(60.0, "pair").replace("motion.duration", f"{g6.WINDOW[1]!r} s")
    hardness = normal_draws(0, "hardness of the hard outsole", 50)
    spread = 0.5 * math.log(0.36 / 0.25)
    np.testing.assert_allclose(made.draws, 1.5 * draws * np.exp(spread * hardness))
    turned = g6._with_draws(replace(friction, low=0.25, high=0.36))
    np.testing.assert_allclose(turned.draws, made.draws)
    assert (made.cof, made.sole) == (0.3, "hard")


def test_a_sole_of_another_law_than_the_packaged_has_its_draws_in_a_file(monkeypatch, tmp_path):
    few = packaged_pair_draws().rows(np.arange(30))
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "not" / "there"))
    monkeypatch.setattr(default_law, "draws_without_report", lambda seed: few)
    path = default_law.file_without_report(3)
    assert path.is_file()
    assert path.name.startswith("without_report_")
    path.write_text("kept", encoding="utf-8")
    assert default_law.file_without_report(3) == path
    assert path.read_text(encoding="utf-8") == "kept"
    path.unlink()
    default_law.file_without_report(0)
    assert path.read_text(encoding="utf-8").count("\n") > 30
    case = g6.sole_case(60.0, g6.JUDGED)
    assert str(path) in case.to_toml()
    assert str(path) not in g6.sole_case(60.0, "pair").to_toml()


def test_a_slip_over_the_sensors_is_drawn_over_milliseconds(file_regression, monkeypatch):
    """Speeds, forces and the middle column of the sensors, each row of it in kPa."""
    from underfoot.slip import dynamics

    time = np.linspace(0, 0.2, 5)
    motion = SimpleNamespace(
        time=time, speed=5 * time, normal=800 * time, fluid_load=300 * time, friction=60 * time
    )
    run = SimpleNamespace(motion=motion, maps="maps")
    array = SimpleNamespace(rows=3, columns=4)
    seen = 1e3 * np.arange(5 * 3 * 4.0).reshape(5, 3, 4)
    monkeypatch.setattr(
        dynamics, "array_pressures",
        lambda one, maps, other: {(id(motion), "maps", id(array)): seen}[id(one), maps, id(other)],
    )  # fmt: skip
    figure = g5._slip_figure(cast(Any, SimpleNamespace(representative=run, array=array)))
    speed, _, rows = figure.panels
    assert speed.layers[0].x == pytest.approx(1e3 * time)
    assert speed.layers[0].y == pytest.approx(5 * time)
    assert [layer.y[0] for layer in rows.layers] == [2, 6, 10]
    held(file_regression, drawn(figure))


def test_the_law_of_a_study_is_calibrated_to_both_outsoles_of_the_laboratory(monkeypatch):
    asked: list[Any] = []
    few = packaged_pair_draws().rows(np.arange(20))

    def calibrated(readings: Any) -> Any:
        asked.extend((one.case, one.cof) for one in readings)
        return SimpleNamespace(draws=few)

    monkeypatch.setattr(g5, "calibrated_pair", calibrated)
    monkeypatch.setattr(g5, "PairReading", lambda case, cof: SimpleNamespace(case=case, cof=cof))
    law: Any = prepare_case(pad(), 4e-3).law
    study: Any = SimpleNamespace(setting=SimpleNamespace(friction=law))
    made: Any = g5.law_as_g6_leaves_it(study)
    assert made.draws is few
    assert made.medians != law.medians
    assert asked == [(g6.sole_case(g6.SOLES[sole], "pair"), g6.PRINTED_ACOF[sole])
                     for sole in ("hard", "soft")]  # fmt: skip


def test_a_tread_is_solved_once_for_all_states_and_its_law_takes_each(monkeypatch):
    """A law without edges of lugs knows no state; no COF counts as none."""
    solved: list[Any] = []
    edged: Any = EdgedLaw(cast(Any, SimpleNamespace()), cast(Any, None), cast(Any, None), 3e6,
                          0.1, 7e4)  # fmt: skip

    def case(name: str) -> Any:
        spacing = SimpleNamespace(quick_grid_spacing=f"{name} spacing")
        return SimpleNamespace(
            hash=name, numerics=spacing, replace=lambda path, value: (name, path, value)
        )

    def prepared(single: Any, spacing: Any, objects: Any) -> Any:
        solved.append((single, spacing, objects))
        law = edged if single[0] == "lugs" else "plain"
        return SimpleNamespace(case="case", context="context", local_law=law, sole="sole")

    def friction(one: Any, context: Any, law: Any, sole: Any, contact: Any) -> Any:
        assert (one, context, sole, contact) == ("case", "context", "sole", "contact")
        dewetting = getattr(law, "dewetting", None)
        cof = 0.0 if dewetting is None else 0.1 * dewetting
        return SimpleNamespace(
            sums=SimpleNamespace(cof=SourcedValue(cof)),
            sampled=SimpleNamespace(cof=np.array([1.0, dewetting or 9.0])),
        )

    told: list[Any] = []

    def pairs(of_case: Any) -> Any:
        told.extend(of_case(each).tolist() for each in (case("lugs"), case("flat")))
        return iter(())

    monkeypatch.setattr(lug_states, "prepare_case", prepared)
    monkeypatch.setattr(lug_states, "solve_case", lambda parts: SimpleNamespace(contact="contact"))
    monkeypatch.setattr(lug_states, "contact_friction", friction)
    monkeypatch.setattr(lug_states, "computed_pairs", pairs)
    with np.errstate(all="ignore"):
        lug_states.states_scores((0.5, 2.0))
    assert solved == [
        (("lugs", "numerics.tread_positions", 1), "lugs spacing", {}),
        (("flat", "numerics.tread_positions", 1), "flat spacing", {}),
    ]
    assert told == [[0.05, 1.0, 0.5], [0.0, 1.0, 9.0], [0.2, 1.0, 2.0], [0.0, 1.0, 9.0]]


def test_a_case_of_a_tread_is_run_on_the_quick_grid(monkeypatch):
    asked: list[Any] = []
    monkeypatch.setattr(tread_pairs, "run", run_of(0.25, [0.2, 0.3], asked))
    case: Any = SimpleNamespace(numerics=SimpleNamespace(quick_grid_spacing=2e-3))
    assert tread_pairs.cof_and_draws(case).tolist() == [0.25, 0.2, 0.3]
    assert asked == [(case, True)]
    monkeypatch.setattr(tread_pairs, "sole_map", lambda *given: given)
    monkeypatch.setattr(tread_pairs, "place_of_tread", lambda *given: given)
    assert tread_pairs._place(case) == (case, (case, 2e-3))


def test_draws_of_the_law_are_those_of_verified_sources(monkeypatch):
    asked: list[Any] = []

    def fitted(law: Any, conditions: Any, *, steps: int, seed: int) -> Any:
        asked.append((law.name, len(conditions), steps, seed))
        return SimpleNamespace(draws=lambda *given: SimpleNamespace(
            write=lambda path: asked.append((given, path))))  # fmt: skip

    monkeypatch.setattr(pair_law, "fit_law", fitted)
    pair_law.write_draws(cast(Any, "a path"), seed=4)
    verified = [one for one in sources.corpus() if one.verified]
    count = sum(len(one.conditions) for one in verified)
    assert asked == [("pair", count, 3000, 4), ((1000, 4), "a path")]


def test_full_slips_of_a_case_stay_in_the_cache(monkeypatch):
    asked: list[Any] = []
    monkeypatch.setattr(g5, "slips", asked.append)
    assert g5.fill_cache(cast(Any, "case")) == {"done": True}
    assert asked == ["case"]


def test_a_drop_pad_without_lugs_or_fluid_touches_all_the_time():
    """With lugs and a thick fluid it floats for a while, longer in a thicker one."""
    pad = {"device": "drop pad", "fluid": "oil", "speed": "0.3 m/s", "shore_a": 60,
           "sole_rq": "5 um", "floor_rq": "3 um"}  # fmt: skip
    grooves = {"pattern": "grooves", "depth": "2 mm"}
    flat, dry, thin, thick = (
        corpus_cases.stand({**pad, **more})
        for more in ({"viscosity": "1 Pa s"}, {"fluid": "dry", "tread": grooves},
                     {"viscosity": "2 cP", "tread": grooves},
                     {"viscosity": "20 cP", "tread": grooves})
    )  # fmt: skip
    assert flat.contact_time == dry.contact_time == 1.0
    assert 1 > thin.contact_time > thick.contact_time >= 0


def test_a_separation_that_no_load_gives_is_a_failure_once(monkeypatch):
    """The secant gives up after thirty loads; planes above the highest point carry none."""
    march: Any = object.__new__(transient._March)
    march.shape, march.failures, march.tolerance, march.operators = (2, 2), 0, 1e-3, None
    loads: list[float] = []

    def loaded(height: Any, guess: Any, mean: float) -> Any:
        loads.append(mean)
        return SimpleNamespace(pressure=np.full((2, 2), mean))

    march._press = loaded
    monkeypatch.setattr(transient, "_separation", lambda *_: 5.0)
    height = np.array([[0.0, 1.0], [2.0, 3.0]])
    march._at_height(height, np.full((2, 2), 0.5), 1.0)
    assert march.failures == 1
    assert len(loads) == 31
    assert loads[0] == 0.5
    assert loads[1] == pytest.approx(0.5 * math.exp(1.5))
    state = march._at_height(height, height, 3.0)
    assert not state.pressure.any()
    np.testing.assert_array_equal(state.gap, 3.0 - height)
    assert len(loads) == 31
    # a load whose logarithm gives the separation is found by the secant
    monkeypatch.setattr(transient, "_separation", lambda state, *_: -math.log(loads[-1]) + 0.1)
    found = march._at_height(height, np.full((2, 2), 0.5), 1.7)
    assert math.log(float(found.pressure[0, 0])) == pytest.approx(-1.6, abs=1e-2)
    assert march.failures == 1


def test_checks_stand_in_their_order_the_heel_on_both_grids_and_the_fluid_last(monkeypatch):
    """Glycerol of half its mass has 5 mPa s at 25 degC; the heel is that of the report's tester."""
    asked: list[Any] = []

    def check(name: str) -> Any:
        return lambda: validation.Check(name, 1.0, 1.0, 0.1, "")

    slow = ("soft_ball", "pressed_lug", "squeezed_lug", "inlet_of_a_worn_heel", "squeeze_disc",
            "hertz", "westergaard", "sliding_sinusoid", "inclined_bearing")  # fmt: skip
    for name in slow:
        monkeypatch.setattr(validation, name, check(name))

    def solved(parts: Any) -> Any:
        asked.append(parts)
        load = {1e-3: 170.0, 0.75e-3: 165.0}[parts[1]]
        return SimpleNamespace(status=Status.CONVERGED, fluid_load=load)

    monkeypatch.setattr(validation, "prepare_case", lambda *given: given)
    monkeypatch.setattr(validation, "solved_motion", solved)
    *_, fluid = made = validation.checks()
    assert [one.name for one in made[:4]] == list(slow[:4])
    heel = made[4]
    assert (heel.computed, heel.exact, heel.tolerance) == (170.0, 165.0, 0.05)
    assert asked[0][0].numerics.cells_along == 16
    assert asked[0][0].motion.normal_force > 0
    assert [one.name for one in made[5:10]] == [
        "inclined_bearing", "squeeze_disc", "hertz", "westergaard", "sliding_sinusoid",
    ]  # fmt: skip
    assert fluid.exact == 5e-3
    assert fluid.tolerance == 0.01
    assert fluid.passed
