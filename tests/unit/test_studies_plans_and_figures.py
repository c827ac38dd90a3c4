"""What studies run and draw, with made-up runs: each condition once, each value at its place."""

import math
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pandas as pd
import pytest

from underfoot.core import silent
from underfoot.core.catalogue import Catalogue
from underfoot.studies import calibration, g1, g5, g6, tread_pairs
from underfoot.studies.identifiability import Fixed


def slips_of(speed_of):
    """Return a study of slips whose people reach a speed by the share of the body that moves."""
    draws = SimpleNamespace(cof=np.linspace(0.1, 0.2, 101))
    return SimpleNamespace(
        peak_speed_at=lambda effective_mass: speed_of(effective_mass), by_friction=draws,
        population=SimpleNamespace(effective_mass=0.114),
    )  # fmt: skip


def test_the_moving_mass_is_told_by_the_mean_of_eleven_persons():
    """A speed off by k standard errors, sd / sqrt(11), has a misfit of k^2."""
    mean, sd = calibration._published_value("peak_slipping_speed_over_sensors_untreaded")
    ends = calibration.MASSES
    found = calibration.mass_profile(
        cast(Any, slips_of(lambda share: mean + (ends.index(share) - 3) * sd / math.sqrt(11)))
    )
    assert found.profile == pytest.approx((np.arange(len(ends)) - 3.0) ** 2)
    assert found.best == pytest.approx(ends[3])


def test_a_calibration_gives_each_parameter_its_own_name_axis_and_share_of_the_progress(
    monkeypatch,
):
    """Loads follow the facet, peaks the roughness, so that each has its own best value."""
    told = []

    def grid(facets, roughness, *, progress, **_):
        progress("grid", 1.0, None)
        shape = (2, len(facets), len(roughness))
        load, peak = (
            [[calibration.printed_value(name, kind, unit)] for kind in calibration.KINDS]
            for name, unit in (("fluid_load", "N"), ("peak_pressure", "Pa"))
        )
        by_facet = 1 + 0.3 * np.abs(np.array(facets) - 10.0)[:, None]
        by_roughness = 1 + 0.5 * np.abs(np.array(roughness) - 2.0)
        whole = np.ones(shape)
        return np.array(load)[:, :, None] * by_facet * whole, np.array(peak)[
            :, :, None
        ] * by_roughness * whole

    def slips(case, *, progress):
        progress("slips", 0.0, None)
        progress("slips", 1.0, None)
        return slips_of(lambda share: 1.0)

    monkeypatch.setattr(calibration, "slip_tester_grid", grid)
    monkeypatch.setattr(calibration, "slips", slips)
    monkeypatch.setattr(calibration, "slip_case", lambda *_, **__: None)
    monkeypatch.setattr(calibration, "_other_conclusions", tuple)
    same = calibration.profile("contact", "1", [1, 2, 3], [9, 0, 9], data=1)
    monkeypatch.setattr(calibration, "contact_profile", lambda _: same)
    seen = {}
    monkeypatch.setattr(calibration, "_tables", lambda *given: seen.update(given=given) or ())
    options = SimpleNamespace(
        quick=False, processes=1, progress=lambda stage, share, *_: told.append((stage, share))
    )
    calibration.compute(cast(Any, options))
    by_angle, by_roughness, *_ = (one.profile for one in seen["given"][-1])
    assert (by_angle.name, by_angle.unit) == ("facet angle", "deg")
    assert (by_roughness.name, by_roughness.unit) == ("roughness beyond the cut-off", "1")
    assert by_angle.grid == pytest.approx(calibration.FACETS)
    assert by_angle.best == pytest.approx(10.0)
    assert by_roughness.best == pytest.approx(2.0)
    shares = [share for _, share in told]
    assert shares == pytest.approx([0.5, 0.5, 0.75, 0.75, 1.0])


def test_ends_of_a_fitted_range_are_drawn_where_they_lie():
    found = calibration.profile("width", "m", [1, 2, 3, 4, 5], [99, 9, 0, 9, 99], data=1)
    assert found.fixed is Fixed.FIXED
    shown = calibration.Calibrated(found, "here", 2.5, 2.0, 3.0)
    (panel,) = calibration.profile_figure([shown]).panels
    limits = [float(np.ravel(layer.x)[0]) for layer in panel.layers if layer.mark == "limit"]
    assert limits == pytest.approx([found.low, found.high, 2.5])
    assert panel.x_label == "width (m)"


@pytest.mark.parametrize("quick", [True, False])
def test_each_sole_has_its_window_its_band_and_its_own_coarse_run(monkeypatch, quick):
    def case(shore, law):
        return SimpleNamespace(replace=lambda _, duration: (shore, law, float(duration.split()[0])))

    def outcomes(cases, *, quick, **_):
        return [(*one, "coarse" if quick else "fine") for one in cases]

    monkeypatch.setattr(g6, "sole_case", case)
    monkeypatch.setattr(g6, "outcomes", outcomes)
    monkeypatch.setattr(g6, "_friction", lambda *given: SimpleNamespace(law=given[1], given=given))
    monkeypatch.setattr(g6, "_with_draws", lambda one: one)
    found: Any = g6.sole_frictions(quick=quick, progress=silent)
    assert [(one.given[0], one.law) for one in found] == [
        (sole, law) for law in g6.LAWS for sole in g6.SOLES
    ]
    times = g6.WINDOW[1:2] if quick else g6.WINDOW
    for one in found:
        sole, law, shore, runs, coarse = one.given
        assert shore == g6.SOLES[sole]
        kind = "coarse" if quick else "fine"
        band = [shore + g6.HARDNESS_BAND, shore - g6.HARDNESS_BAND]
        assert runs == [(shore, law, time, kind) for time in times] + [
            (end, law, g6.WINDOW[1], kind) for end in band
        ]
        assert coarse == (None if quick else (shore, law, g6.WINDOW[1], "coarse"))


def test_a_contrast_stands_at_the_places_of_both_of_its_treads(monkeypatch):
    def stand(place):
        return SimpleNamespace(cases=(place,))

    contrast = SimpleNamespace(
        over=stand(1.0), under=stand(2.0), source="somebody", effect="tread", extremes_of=0
    )
    monkeypatch.setattr(tread_pairs, "tread_contrasts", lambda: [contrast])
    monkeypatch.setattr(tread_pairs, "corpus", list)
    monkeypatch.setattr(
        tread_pairs, "_draw_cof", lambda one, of_case: np.full(3, of_case(one.cases[0]))
    )
    monkeypatch.setattr(tread_pairs, "_published_bounds", lambda one, under: (0.1, under))
    monkeypatch.setattr(tread_pairs, "_place", lambda case: np.full(6, case))
    monkeypatch.setattr(tread_pairs, "_pair", lambda *given: given)
    computed: Any = tread_pairs.computed_pairs(cast(Any, lambda place: 10 * place))
    ((source, effect, case, ends, ratio, second, extremes),) = computed
    assert (source, effect, case, extremes) == ("somebody", "tread", 1.0, 0)
    assert ends == (0.1, 20.0)
    assert ratio == pytest.approx(0.5)
    assert second == pytest.approx(2.0)


def test_every_film_of_fig_35_is_computed_once(monkeypatch):
    asked = []

    def cached(_, function, items, keys, *, processes):
        asked.extend(items)
        assert len(set(keys)) == len(keys)
        return [(item, {"time": np.zeros(1), "share": np.zeros(1)}) for item in items]

    monkeypatch.setattr(g5, "cached_arrays", cached)
    monkeypatch.setattr(g5, "slip_case", lambda *_, **__: None)
    monkeypatch.setattr(g5, "slip_setting", lambda _: SimpleNamespace(key="a"))
    options = SimpleNamespace(quick=True, processes=1, progress=silent)
    films = g5.held_films(cast(Any, options))
    wanted = {(v, 0.5) for v in g5.HELD_VISCOSITIES} | {
        (v, s) for v in g5.CURVES for s in g5.HELD_SPEEDS
    }
    assert {(one.viscosity, one.speed) for one in films} == wanted
    assert len(asked) == len(wanted)


def test_what_the_pressure_follows_is_drawn_over_its_own_axis_with_its_line():
    speed = np.linspace(0.2, 1.0, 12)
    passages = {"speed": speed, "lateral": 1e-3 * np.arange(12) % 7e-3,
                "peak": 1e3 * (3 + 5 * speed), "row": np.arange(12) % 3}  # fmt: skip
    first, second, rows = g5._effects_figure(passages).panels
    assert first.x_label.startswith("A: speed")
    assert second.x_label.startswith("B: distance")
    assert all(panel.y_label.startswith("peak pressure") for panel in (first, second))
    _, fitted = first.layers
    assert np.asarray(fitted.y) == pytest.approx(3 + 5 * np.array([0.2, 1.0]))
    assert list(rows.x_ticks) == [0, 1, 2]


def test_own_shoes_are_drawn_alone_and_beside_their_printed_change():
    rows = [
        {"series": "report", "material": material, "speed": speed, "shoe_rz": shoe,
         "floor_rz": g1.FLOOR_RZ[0], "area_per_force": 1e-6 * (1e6 * shoe + speed),
         "cof_hysteresis": 0.1}
        for material in g1.MATERIALS for shoe in g1.SHOE_RZ for speed in g1.SPEEDS
    ]  # fmt: skip
    own = g1._figure(pd.DataFrame(rows), "area", "10", "speed", own_roughness=True)
    for panel, material in zip(own.panels, g1.MATERIALS, strict=True):
        curve, printed = panel.layers
        shoe = 1e6 * g1.OWN_SHOE_RZ[material]
        assert np.asarray(curve.y) == pytest.approx(shoe + np.array(g1.SPEEDS))
        low, high = cast(Any, g1._printed_change("area", "speed", material, own_roughness=True))
        ends = [float(np.ravel(end)[0]) for end in (printed.low, printed.high)]
        assert ends == pytest.approx([(shoe + 0.1) * (1 + low), (shoe + 0.1) * (1 + high)])


@pytest.mark.parametrize(
    ("quantity", "along", "own", "key"),
    [
        ("area", "speed", True, "experiment.adhesion_change_with_speed"),
        ("hysteresis", "speed", False, "hysteresis_cof_change.speed_up_most_pairs"),
        ("area", "speed", False, "contact_area_per_force_change.speed_up_rubber"),
        ("area", "floor_rz", True, "contact_area_per_force_change.floor_roughness_up_rubber"),
        ("hysteresis", "floor_rz", False, "hysteresis_cof_change.floor_roughness_up_rubber"),
    ],
)
def test_each_figure_has_the_change_that_is_printed_for_it(quantity, along, own, key):
    printed = Catalogue.load().entry("published", "micro_fe_g1").numbers(key, "1")
    found = g1._printed_change(quantity, along, "rubber", own_roughness=own)
    assert found == pytest.approx(tuple(printed))


def test_friction_that_elements_without_loss_leave_is_not_drawn():
    """Those leave up to 9e-4; a material of which that is all is named in the title instead."""
    rows = [
        {"series": "report", "material": material, "speed": speed, "shoe_rz": g1.SHOE_RZ[0],
         "floor_rz": floor, "area_per_force": 1e-6, "cof_hysteresis": cof}
        for material, cof in zip(g1.MATERIALS, (9e-4, 1.1e-3), strict=True)
        for speed in g1.SPEEDS for floor in g1.FLOOR_RZ
    ]  # fmt: skip
    drawn = g1._figure(pd.DataFrame(rows), "hysteresis", "5", "floor_rz")
    assert [panel.title.partition(": ")[2] for panel in drawn.panels] == [g1.MATERIALS[1]]
    assert f"{g1.MATERIALS[0]} 9e-04" in drawn.title
