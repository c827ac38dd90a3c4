"""What somebody gives counts, or the case says that it does not; how it is spelled never counts."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from underfoot.case import Case, Option, assumptions
from underfoot.case.friction import ConstantOption
from underfoot.compute.numbers import heel_name, sole_name
from underfoot.compute.position_draws import UncertainBevel
from underfoot.compute.prepare import prepare_case
from underfoot.compute.resolve import resolve_context
from underfoot.core import SourcedValue, content_hash
from underfoot.questions.comparison import case_differences

EXAMPLES = Path(__file__).parents[2] / "examples"
UNTREADED = EXAMPLES / "work_shoe_untreaded_glycerol.toml"
TREADED = EXAMPLES / "work_shoe_full_tread_glycerol.toml"
COARSE = {"numerics.quick_grid_spacing": "4 mm", "numerics.grid_spacing": "4 mm"}
PATCH = {"mode": "patch", "patch_length": "30 mm", "patch_width": "40 mm"}
MIDSOLE = {"modulus": "2 MPa", "thickness": "10 mm"}


def case_of(path=UNTREADED, **settings):
    case = Case.load(path)
    for name, value in settings.items():
        case = case.replace(name.replace("__", "."), value)
    return case


@pytest.mark.parametrize(
    ("settings", "path"),
    [
        ({"shoe__material__density": "1100 kg/m^3"}, "shoe.material.density"),
        ({"shoe__material__bulk_modulus": "2 GPa"}, "shoe.material.bulk_modulus"),
        ({"shoe__material__fastest_tested": "1000 rad/s"}, "shoe.material.fastest_tested"),
        (
            {"friction": {"model": "constant", "cof": 0.3}, "shoe__material__loss_tangent": 0.2},
            "shoe.material.loss_tangent",
        ),
        (
            {"friction": {"model": "stribeck"}, "shoe__material__modulus": "5 MPa"}
            | {"shoe__material__shore_a": 60},
            "shoe.material.shore_a",
        ),
        ({"shoe__roughness__rp": "9 um"}, "shoe.roughness.rp"),
        ({"floor__roughness__rq": "1 um", "floor__roughness__ra": "1 um"}, None),
        ({"floor__roughness": {"rq": "1 um", "ra": "1 um"}}, "floor.roughness.ra"),
        ({"shoe__roughness__spacing": "1 um"}, "shoe.roughness.spacing"),
        ({"film__lug_edges": False}, "film.lug_edges"),
        ({"film__suction": "50 kPa"}, "film.suction"),
        ({"shoe__wear": PATCH}, "shoe.wear.patch_length"),
        ({"shoe__wear__angle": "5 deg"}, "shoe.wear.angle"),
        (
            {"compliance": "half_space", "shoe__sole__midsole": MIDSOLE},
            "shoe.sole.midsole.modulus",
        ),
        ({"film": "none", "sensor__scans": 3}, "sensor.scans"),
        ({"motion__duration": "1 s", "motion__steady": True}, "motion.duration"),
        ({"slip__heel_brake": "none", "slip__brake_time_mean": "20 ms"}, "slip.brake_time_mean"),
        (
            {"friction": {"model": "stribeck", "hysteresis_cof": 0.05}},
            "friction.hysteresis_cof",
        ),
        ({"friction": {"model": "stribeck", "tau_hydro": "0.1 m/s"}}, "friction.tau_hydro"),
        ({"friction": {"model": "asperity_ehl", "cof_bl": 0.1}}, "friction.cof_bl"),
    ],
)
def test_what_was_given_and_counts_for_nothing_is_told(settings, path):
    case = case_of(**settings)
    section, _, name = (path or "").rpartition(".")
    told = {
        (line.about, each) for line in assumptions(case) for each in line.values.get("names", ())
    }
    assert ((section, name) in told) == (path is not None)
    again = Case.from_text(case.to_toml(complete=True))
    assert again == case
    assert again.idle_given == case.idle_given


def test_nobody_is_told_of_what_he_did_not_give():
    for path in EXAMPLES.glob("*.toml"):
        assert Case.load(path).idle_given == {}


def test_a_law_of_another_package_may_read_what_ours_does_not(monkeypatch):
    monkeypatch.setattr(Option, "_known", {k: dict(v) for k, v in Option._known.items()})

    class Heavy(ConstantOption):
        """A law that the test makes."""

        name = "heavy_of_this_test"

    Heavy.__module__ = "elsewhere"
    law = {"model": "heavy_of_this_test", "cof": 0.3}
    case = case_of(friction=law, shoe__material__density="1100 kg/m^3")
    assert case.idle_given == {}
    assert case.hash != case.replace("shoe.material.density", "900 kg/m^3").hash
    ours = case.replace("friction", {"model": "constant", "cof": 0.3})
    assert ours.hash == ours.replace("shoe.material.density", "900 kg/m^3").hash


@pytest.mark.parametrize(
    ("path", "spelled"),
    [
        ("shoe.heel.length", "7.5 cm"),
        ("shoe.heel.length", 0.075),
        ("shoe.heel.profile.angle", {"value": "0.17453292519943295 rad", "assumed": True}),
        ("shoe.wear.angle", "5 deg"),
        ("shoe.wear", PATCH),
        ("shoe.heel.length", SourcedValue(0.075, "m", uncertainty=1e-3)),
    ],
)
def test_draws_do_not_hang_on_how_a_sole_is_spelled(path, spelled):
    plain, other = case_of(), case_of().replace(path, spelled)
    assert sole_name(other) == sole_name(plain)
    assert heel_name(other) == heel_name(plain)
    assert UncertainBevel.of(other).heel == UncertainBevel.of(plain).heel
    assert sole_name(plain.replace("shoe.heel.width", "71 mm")) != sole_name(plain)


def test_copies_of_an_outsole_file_are_one_sole_and_parts_of_it_are_not(tmp_path):
    names = tmp_path / "alpha.stl", tmp_path / "beta.stl"
    for name in names:
        shutil.copy(EXAMPLES / "measured" / "heel.stl", name)
    fine = {"numerics.quick_grid_spacing": "1 mm"}
    first, copy = (case_of().replace({**fine, "shoe.outsole": {"file": str(n)}}) for n in names)
    assert sole_name(first) == sole_name(copy)
    assert heel_name(first) == heel_name(copy.replace("shoe.outsole.mirror", True))
    assert sole_name(first) != sole_name(copy.replace("shoe.outsole.region", "heel"))
    for key, value in {"unit": "mm", "forward": "+x", "down": "-z", "cut_floor": True}.items():
        assert sole_name(first) == sole_name(copy.replace(f"shoe.outsole.{key}", value))


def test_equal_values_are_no_difference_of_two_cases():
    plain = case_of()
    assert case_differences([plain, plain.replace("shoe.heel.length", "7.5 cm")]) == []
    assert case_differences([plain, plain.replace("shoe.material.density", "1 kg/l")]) == []
    [(path, *values)] = case_differences([plain, plain.replace("shoe.heel.length", "8 cm")])
    assert (path, values) == ("shoe.heel.length", ["75 mm", "8 cm"])
    spread = SourcedValue(0.075, "m", uncertainty=1e-3)
    [(path, *_)] = case_differences([plain, plain.replace("shoe.heel.length", spread)])
    assert path == "shoe.heel.length"


def test_adhesion_left_by_a_fluid_is_over_the_load_of_its_own_test():
    law = {"model": "adhesion_blocking", "dry_adhesion_cof": 0.6, "hysteresis_cof": 0.1}
    law |= {"alpha": "1 N", "beta": 0.2}
    usual, light = (
        case.friction.build(resolve_context(case)).cof_parts[0]
        for case in (case_of(friction=law), case_of(friction={**law, "load": "5 N"}))
    )
    assert usual == pytest.approx(1 / 20.9 + 0.2 * 0.6)
    assert light == pytest.approx(1 / 5 + 0.2 * 0.6)


def test_a_roughness_behind_a_longer_cut_off_is_that_of_shorter_waves_too():
    near, far = (case_of(floor__roughness={"rq": "20 um", "cutoff": cut}) for cut in CUTS)
    smooth = case_of(floor__roughness={"rq": "1 nm"}).effective_rq.value
    part = [(each.effective_rq.value**2 - smooth**2) ** 0.5 for each in (near, far)]
    assert part[1] / part[0] == pytest.approx((0.8 / 2.5) ** 0.8, rel=1e-6)
    short = assumptions(case_of(floor__roughness={"rq": "1 um", "cutoff": "0.25 mm"}))
    assert [line.about for line in short if "longest" in line.values] == ["floor.roughness"]


CUTS = "0.8 mm", "2.5 mm"


@pytest.mark.parametrize(("floor", "told"), [(60, True), (99, False), (None, False)])
def test_a_floor_as_soft_as_the_sole_is_no_rigid_floor(floor, told):
    case = case_of(floor={"roughness": {"rq": "1 um"}, **({"shore_a": floor} if floor else {})})
    marks = [each for each in resolve_context(case).modulus_breaches if each.closure == "floor"]
    assert [each.range.high for each in marks] == [100.0] * told  # Shore A ends there


SWEPT = {
    "shoe.material.shore_a": 70,
    "shoe.roughness.ra": "6 um",
    "shoe.heel.length": "78 mm",
    "shoe.heel.crown_radius": "0.5 m",
    "shoe.wear.depth": "1 mm",
    "shoe.sole.outsole_thickness": "20 mm",
    "floor.roughness.rq": "2 um",
    "contaminant.viscosity": "100 cP",
    "contaminant.family": "oil",
    "interface.roughness_beyond_cutoff": 1.2,
    "risk": {"model": "chang_2004"},
}


def content(case):
    parts = prepare_case(case, 4e-3)
    values = parts.sole.clearance, parts.law, parts.asperities, parts.slip_model, parts.film
    deflection = parts.compliance.apply(np.where(parts.sole.land, 1e5, 0.0))
    return content_hash([*values, deflection])


@pytest.mark.parametrize("path", SWEPT)
def test_what_counts_moves_what_is_solved(path):
    case = case_of(friction="pair").replace(COARSE)
    changed = case.replace(path, SWEPT[path])
    assert path not in changed.idle_paths
    assert content(changed) != content(case)
