"""Contacts of nodes that go round in circles, fits of any scale, cases of the command."""

from dataclasses import replace
from itertools import product
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from block_loops import written_loops
from snapshot import held
from underfoot.block import (
    ExplicitSettings,
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroSurface,
    assembly,
)
from underfoot.block._kernels.active_set import (
    NodalContact,
    _by_secant,
    contact_at_height,
    contact_under_load,
)
from underfoot.block.command_input import MicroCase, micro_case
from underfoot.block.one_term_fit import fit_single_exponential
from underfoot.material import RelaxationSpectrum, report_elastomer

CIRCLES = (323, 513, 1162, 1538, 1570, 1814, 1959)
"""Seeds of bodies whose wrong nodes change sides for ever when they do so all at once."""


def nodes(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the compliance of a few nodes of a thin body, their clearances and a first guess."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 8))
    thin = rng.normal(size=(count, int(rng.integers(2, count + 1))))
    compliance = thin @ thin.T + 1e-3 * np.eye(count)
    return compliance, rng.normal(size=count), rng.random(count) < 0.5


def the_only_contact(compliance: np.ndarray, clearance: np.ndarray) -> np.ndarray:
    """Return the forces of the only choice of nodes that neither press and gape nor overlap."""
    for chosen in product((False, True), repeat=clearance.size):
        inside = np.flatnonzero(chosen)
        force = np.zeros(clearance.size)
        force[inside] = np.linalg.solve(compliance[np.ix_(inside, inside)], -clearance[inside])
        gap = clearance + compliance @ force
        if force.min() >= 0 and np.delete(gap, inside).min(initial=0.0) >= 0:
            return force
    raise AssertionError("no contact")


@pytest.mark.parametrize("seed", CIRCLES)
def test_nodes_that_change_sides_in_circles_come_to_rest(seed):
    compliance, clearance, guess = nodes(seed)
    made = contact_at_height(compliance, clearance, 0.0, guess)
    assert made.wrong == 0
    assert 14 < made.steps < 31
    np.testing.assert_allclose(made.force, the_only_contact(compliance, clearance), atol=1e-8)
    other = contact_at_height(compliance, clearance, 0.3, guess)
    np.testing.assert_allclose(
        other.force, the_only_contact(compliance, clearance + 0.3), atol=1e-8
    )


@pytest.mark.parametrize("seed", [*CIRCLES[:4], 5, 7])
@pytest.mark.parametrize("load", [0.02, 0.7, 30.0])
def test_a_load_is_found_from_any_height(seed, load):
    """From heights above all contact, near the answer and far below it."""
    compliance, clearance, guess = nodes(seed)
    direct = contact_under_load(compliance, clearance, load, guess)
    assert direct.force.sum() == pytest.approx(load)
    for height in (-clearance.min() + 1.0, direct.height + 1e-3, direct.height - 5.0):
        near = NodalContact(direct.force, direct.gap, height, 17, 3)
        made = _by_secant(compliance, clearance, load, near)
        assert made.wrong == 0
        assert made.force.sum() == pytest.approx(load, rel=1e-9)
        assert made.height == pytest.approx(direct.height, abs=1e-6 * max(1, abs(direct.height)))
        np.testing.assert_allclose(made.force, direct.force, atol=1e-6 * load)
        assert min(made.force.min(), made.gap.min()) >= 0
        assert abs(made.force * made.gap).max() < 1e-9 * load
        # each solution of the way counts one step at least, and few heights are tried
        assert 19 <= made.steps < 17 + 400
    start = np.zeros(clearance.size, bool)
    again = contact_under_load(compliance, clearance, load, start)
    np.testing.assert_allclose(again.force, direct.force, atol=1e-6 * load)


@pytest.mark.parametrize("scale", [0.1, 1.0, 1e7])
def test_a_fit_of_one_term_knows_no_unit(scale):
    """Errors of moduli go with them, that of the rate stays; so does what can't be told."""
    time = np.geomspace(1e-3, 10, 15)
    noise = 1 + 0.01 * np.cos(7 * np.arange(15))
    made, other = (
        fit_single_exponential(time, factor * noise * (1 + 2 * np.exp(-time / 0.3)))
        for factor in (1.0, scale)
    )
    for name, by in (
        ("instantaneous_modulus", scale), ("equilibrium_modulus", scale), ("decay_rate", 1.0),
    ):  # fmt: skip
        one, two = getattr(made, name), getattr(other, name)
        assert two.value == pytest.approx(by * one.value, rel=1e-5)
        assert two.uncertainty == pytest.approx(by * one.uncertainty, rel=1e-3)
    falls = fit_single_exponential(time, scale * np.exp(-time / 3.0) * (2 - 0.1 * time))
    assert falls.equilibrium_modulus.uncertainty is None
    assert "bound of zero" in falls.equilibrium_modulus.reason


RUBBER = MicroMaterial(RelaxationSpectrum(0.6e6, np.array([]), np.array([])), 1e6)
LOSSY = MicroMaterial(RelaxationSpectrum(0.6e6, np.array([0.4e6]), np.array([1e-4])), 2e7)
BLOCK = MicroBlock((40e-6, 40e-6, 20e-6), (4, 4, 1), None, MicroSurface(), 1, "periodic")
FLOOR = MicroSurface.checkerboard(1e-6, 40e-6, offset=(3e-6, 2e-6))
LOADING = MicroLoading(60e3, 1.0, 3e-6, "load", 1e-7, 1e-7, 1e-7)


def test_a_case_of_elements_goes_on_where_it_was_stopped(monkeypatch, tmp_path):
    """It keeps its state between runs, and nothing after the last; pictures come where asked."""
    monkeypatch.setattr(assembly, "element_loops", lambda: SimpleNamespace(**written_loops()))
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "cache"))
    case = MicroCase(
        "a", "explicit", BLOCK, FLOOR, RUBBER, LOADING, (8.0,), (), False,
        ExplicitSettings(samples_per_wavelength=100),
    )  # fmt: skip
    stages: list[str] = []
    left = tmp_path / "cache" / "micro"

    def dies(stage: str, share: float, *_: Any) -> None:
        if stage == "slide" and share > 0.3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        case.result(8.0, dies)
    (kept,) = left.iterdir()
    # a state that is damaged, or of another version, is left: the march begins anew
    (kept / "restart.npz").write_bytes(b"damaged")
    whole = case.result(8.0, lambda stage, *_: stages.append(stage))
    assert set(stages) == {"press", "hold", "slide"}
    assert 2e-6 < whole.distance[-1] < 4e-6  # steps of 0.7 um
    assert list(left.iterdir()) == []
    with pytest.raises(KeyboardInterrupt):
        case.result(8.0, dies, snapshots=2, folder=tmp_path / "shown")
    (kept,) = left.iterdir()
    assert (kept / "restart.npz").is_file()
    stages.clear()
    rest = case.result(8.0, lambda stage, *_: stages.append(stage), snapshots=2,
                       folder=tmp_path / "shown")  # fmt: skip
    np.testing.assert_array_equal(rest.shear_force, whole.shear_force)
    assert set(stages) == {"hold", "slide"}
    assert sorted(path.name for path in (tmp_path / "shown").iterdir()) == [
        "block.pvd", "block_0001.vtu", "block_0002.vtu",
    ]  # fmt: skip
    assert list(left.iterdir()) == []


def test_a_case_condenses_its_block_once_for_all_speeds(file_regression):
    """About its own compression where that is asked for."""
    block = MicroBlock((0.4e-3, 0.4e-3, 0.2e-3), (4, 4, 2), None, MicroSurface(), 1, "periodic")
    floor = MicroSurface.checkerboard(10e-6, 0.4e-3)
    load = replace(LOADING, control="displacement", slide_distance=0.8e-3, press_time=1e-4)
    said: dict[str, Any] = {}
    for strain in (False, True):
        case = MicroCase("a", "condensed", block, floor, LOSSY, load,
                         (0.1, 1.0), (), strain, ExplicitSettings())  # fmt: skip
        for speed in case.speeds:
            made = case.result(speed, lambda *_: None)
            said[f"{strain} {speed}"] = made.averages, made.notes, made.time[-1]
        assert len(case._condensed) == 1
        said[f"{strain} said"] = case.describe_case()
    held(file_regression, said)


WRITTEN = """
[block]
size = ["0.8 mm", "0.6 mm", "0.4 mm"]
elements = [8, 6, 4]
bottom_layer = "50 um"
roughness_layers = 2
sides = "periodic"
[block.roughness]
file = "scan.xyz"
[floor]
peak_to_valley = "5 um"
wavelength = "0.2 mm"
[material]
spectrum = "prony.csv"
poisson_ratio = 0.48
[loading]
speeds = ["20 mm/s", "1 m/s"]
press_time = "2 ms"
hold_time = "0.5 ms"
ramp_time = "0.2 ms"
slide_distance = "0.4 mm"
mean_pressure = "90 kPa"
[explicit]
mass_scaling = 2.0
precision = "single"
"""


@pytest.mark.parametrize(("heading", "shear"), [
    ("tau / s, E_i / MPa", 2e6 / 2.96), ("tau / s, G_i / MPa", 2e6),
])  # fmt: skip
def test_a_case_takes_its_files_and_units(file_regression, tmp_path, heading, shear):
    """A series of Young's modulus is divided by 2 (1 + nu), one of shear stays as it is."""
    rows = ["x [m] y [m] z [m]"]
    rows += [f"{x}e-4 {y}e-4 {(x + 2 * y) % 4}e-6" for y in range(6) for x in range(8)]
    (tmp_path / "scan.xyz").write_text("\n".join(rows) + "\n", encoding="utf-8")
    (tmp_path / "prony.csv").write_text(f"{heading}\ninf, 2\n0.001, 1\n", encoding="utf-8")
    path = tmp_path / "case.toml"
    path.write_text(WRITTEN, encoding="utf-8")
    case = micro_case(path)
    assert case.material.shear.equilibrium_modulus == pytest.approx(shear)
    assert case.material.bulk_modulus == pytest.approx(2 * shear * 1.48 / (3 * 0.04))
    held(file_regression, [case, case.describe_case()], "case " + heading[9])


@pytest.mark.parametrize("ratio", [0.4, 0.499])
def test_a_rubber_of_the_report_keeps_its_young_s_modulus(tmp_path, ratio):
    path = tmp_path / "case.toml"
    path.write_text(f'[material]\nreport = "rubber"\npoisson_ratio = {ratio}\n', encoding="utf-8")
    shear = micro_case(path).material.shear
    young = report_elastomer("rubber").modulus
    assert 2 * (1 + ratio) * shear.equilibrium_modulus == pytest.approx(young.equilibrium_modulus)
    np.testing.assert_allclose(2 * (1 + ratio) * shear.term_moduli, young.term_moduli)
