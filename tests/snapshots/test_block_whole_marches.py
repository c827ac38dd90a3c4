"""Whole explicit marches of tiny blocks by the written loops: stages, ends, restarts, refusals."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from block_loops import plain, written_loops
from snapshot import held, refusal
from underfoot.block import assembly
from underfoot.block._kernels import names as at
from underfoot.block._kernels.energy import element_energies
from underfoot.block.assembly import ExplicitSettings, assemble_march
from underfoot.block.explicit import _breaches, explicit_sliding
from underfoot.block.inputs import MicroBlock, MicroLoading, MicroMaterial, MicroSurface
from underfoot.block.march import COLUMNS, BlockMarch, averages, ledger
from underfoot.core import Cancelled, Status
from underfoot.material import RelaxationSpectrum

ELASTIC = MicroMaterial(RelaxationSpectrum(0.6e6, np.array([]), np.array([])), 1e6)
LOSSY = MicroMaterial(RelaxationSpectrum(0.5e6, np.array([0.3e6]), np.array([2e-6])), 1.5e6)
SIDELESS = MicroBlock((40e-6, 40e-6, 20e-6), (4, 4, 1), None, MicroSurface(), 1, "periodic")
FREE = replace(SIDELESS, sides="free", size=(40e-6, 50e-6, 20e-6), elements=(4, 5, 1))
WAVES = MicroSurface.checkerboard(1e-6, 40e-6, offset=(3e-6, 2e-6))
PRESSED = MicroLoading(60e3, 1.0, 2e-6, "load", 1e-7, 1e-7, 1e-7)
SLID = replace(PRESSED, speed=8.0, slide_distance=81e-6)
FEW = ExplicitSettings(samples_per_wavelength=20)


@pytest.fixture
def written(monkeypatch):
    """Let blocks march by the loops as they are written."""
    monkeypatch.setattr(assembly, "element_loops", lambda: SimpleNamespace(**written_loops()))


def told(result: Any) -> dict[str, Any]:
    """Return a result without the time that it took."""
    hidden = "process_seconds"
    return {name: getattr(result, name) for name in result.__slots__ if name != hidden}


@pytest.mark.usefixtures("written")
def test_a_flat_block_carries_its_load_and_slides_without_friction():
    """Between periodic sides it is compressed along z alone: W(J) = p H, exactly."""
    made = explicit_sliding(SIDELESS, MicroSurface(), ELASTIC, PRESSED)
    area = SIDELESS.nominal_area
    assert made.nominal_area == area
    sliding = made.distance > 0
    assert made.normal_force[sliding] == pytest.approx(60e3 * area, rel=0.01)
    assert abs(made.shear_force).max() < 1e-12 * 60e3 * area
    assert made.real_contact_area[sliding] == pytest.approx(area)
    assert np.diff(made.distance[sliding])[3:] == pytest.approx(made.time_step * 1.0)
    # uniaxial strain of J: p = -(dW/dJ) with W = G/2 (J^(-2/3) (2 + J^2) - 3) + K/2 (J - 1)^2
    g, k, j = 0.6e6, 1e6, np.linspace(0.9, 1.0, 20001)
    stored = g / 2 * (j ** (-2 / 3) * (2 + j**2) - 3) + k / 2 * (j - 1) ** 2
    stress = -np.gradient(stored, j)
    there = np.interp(60e3, stress[::-1], j[::-1])
    pressed = -made.height[-1] / 20e-6
    sunk = 60e3 / assemble_march(SIDELESS, MicroSurface(), ELASTIC, PRESSED, FEW).penalty / 20e-6
    assert pressed == pytest.approx(1 - there + sunk, rel=0.02)
    work = made.energy.top_work[-1]
    assert work > 0
    assert abs(made.energy.residual).max() < 2e-3 * work
    assert abs(made.energy.residual[-1]) < 1e-4 * work
    assert made.energy.strain[-1] == pytest.approx(
        area * 20e-6 * np.interp(there, j, stored), rel=0.03
    )
    assert abs(made.energy.floor_work[-1]) < 1e-12 * work
    assert made.status is Status.CONVERGED
    assert made.notes[-1] == "no whole floor wavelength was slid: there is no mean"


KINDS: dict[str, tuple[MicroBlock, MicroMaterial, MicroLoading, ExplicitSettings]] = {
    "load": (SIDELESS, LOSSY, SLID, FEW),
    "kept": (
        FREE, LOSSY, replace(SLID, control="displacement", slide_distance=42e-6),
        ExplicitSettings(samples_per_wavelength=25, mass_scaling=4.0, hourglass="viscous"),
    ),
    "short": (SIDELESS, ELASTIC, replace(SLID, slide_distance=10e-6),
              ExplicitSettings(bulk_viscosity=0.06, mass_scaling="auto")),
    "still": (replace(FREE, roughness=WAVES), LOSSY,
              replace(SLID, speed=0.0, press_time=2e-6, hold_time=6e-6), FEW),
}  # fmt: skip


@pytest.mark.usefixtures("written")
@pytest.mark.parametrize("name", KINDS)
def test_marches(file_regression, name):
    block, material, load, settings = KINDS[name]
    stages: list[tuple[str, float]] = []
    made = explicit_sliding(
        block, WAVES, material, load, settings,
        progress=lambda stage, share, *_: stages.append((stage, share)),
    )  # fmt: skip
    seen = list(dict.fromkeys(stage for stage, _ in stages))
    assert all(0 < share <= 1 for _, share in stages)
    said = told(made) | {"stages": seen, "last": stages[-1], "reports": len(stages)}
    held(file_regression, said, f"march_{name}")


@pytest.mark.usefixtures("written")
def test_three_terms_that_relax_alike_are_one():
    """The same rubber by one term or by three: forces, way and energies are alike."""
    split = MicroMaterial(
        RelaxationSpectrum(0.5e6, np.array([0.05e6, 0.1e6, 0.15e6]), np.full(3, 2e-6)), 1.5e6
    )
    load = replace(SLID, slide_distance=6e-6)
    one, three = (explicit_sliding(SIDELESS, WAVES, rubber, load, FEW) for rubber in (LOSSY, split))
    for name in ("normal_force", "shear_force", "height", "real_contact_area"):
        values = getattr(one, name)
        assert getattr(three, name) == pytest.approx(values, rel=1e-9, abs=1e-9 * abs(values).max())
    for name in ("strain", "material_loss", "residual"):
        energy = getattr(one.energy, name)
        scale = abs(one.energy.strain).max()
        assert getattr(three.energy, name) == pytest.approx(energy, rel=1e-7, abs=1e-9 * scale)


@pytest.mark.usefixtures("written")
def test_a_march_goes_on_where_it_was_stopped(file_regression, tmp_path):
    load = replace(PRESSED, speed=8.0, slide_distance=6e-6)
    parts = SIDELESS, WAVES, LOSSY, load, ExplicitSettings(samples_per_wavelength=100)
    whole = explicit_sliding(*parts)
    said: dict[str, Any] = {}
    for stage, share in (("hold", 0.7), ("slide", 0.4)):

        def stops(name: str, fraction: float, *_: Any, stage=stage, share=share) -> None:
            if name == stage and fraction > share:
                raise Cancelled("enough")

        folder = tmp_path / stage
        half = explicit_sliding(*parts, output=folder, snapshots=3, progress=stops)
        said[stage] = half.status, half.notes, half.time.size, sorted(
            path.name for path in folder.iterdir()
        )  # fmt: skip
        rest = explicit_sliding(*parts, output=folder, snapshots=3, restart=folder / "restart.npz")
        for field in ("shear_force", "time", "height", "corrected_contact_area"):
            np.testing.assert_array_equal(getattr(rest, field), getattr(whole, field))
        assert np.array_equal(rest.energy.residual, whole.energy.residual)
        assert (rest.steps, rest.notes, rest.averages) == (whole.steps, whole.notes, whole.averages)
    said["made"] = sorted(path.name for path in folder.iterdir())
    said["pictures"] = (folder / "block.pvd").read_text(encoding="utf-8")
    again = explicit_sliding(*parts, output=folder, overwrite=True, progress=stops)
    said["again"] = again.steps, again.status
    said["full folder"] = refusal(explicit_sliding, *parts, output=folder)
    said["other load"] = refusal(
        explicit_sliding, *parts[:3], replace(load, speed=7.0), restart=folder / "restart.npz"
    )
    held(file_regression, said)


def test_a_march_that_goes_wrong_stops_and_says_where_its_last_good_state_is(
    file_regression, tmp_path, monkeypatch
):
    """Loops that give a state make each of the faults in the third sample."""
    good = dict.fromkeys((at.COUNT, at.LEAST_J), 1.0) | {at.SAMPLE_TOP_WORK: 1e-9}
    wrong = {
        "numbers": {at.NORMAL: np.nan}, "inside out": {at.LEAST_J: 0.0},
        "energy": {at.KINETIC: 2.1e-9}, "squeezed": {},
    }  # fmt: skip
    said: dict[str, Any] = {}
    for name, values in wrong.items():
        calls = []

        def given(
            count: int, nodes: Any, *others: Any, name=name, values=values, calls=calls
        ) -> None:
            calls.append(count)
            state = others[7 - 1]
            state[at.TIME] += count * others[7][at.DT]
            for place, value in (good | (values if len(calls) == 3 else {})).items():
                state[place] = value
            if name == "squeezed":
                third = nodes[0].size // 3
                nodes[0][2 * third + 16 : 2 * third + 32] = -18e-6

        monkeypatch.setattr(assembly, "element_loops", lambda f=given: SimpleNamespace(
            advance_none=f))  # fmt: skip
        parts = SIDELESS, WAVES, ELASTIC, PRESSED
        folder = tmp_path / name
        said[name] = refusal(explicit_sliding, *parts, output=folder), calls
        said[f"{name} files"] = sorted(path.name for path in folder.iterdir())
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "cache"))
    said["no output"] = refusal(explicit_sliding, *parts)
    assert (tmp_path / "cache" / "finite_element" / "last_good_state.npz").is_file()
    held(file_regression, said)


def test_a_load_that_never_settles_is_said_after_twelve_holds(monkeypatch):
    """A force 2 % off is held twelve times; one 0.5 % off once."""
    for off, holds in ((0.98, 12), (0.995, 1), (1.005, 1), (1.02, 12)):

        def given(count: int, *others: Any, off=off) -> None:
            state, control = others[7], others[8]
            state[at.TIME] += count * control[at.DT]
            state[at.SLID] += count * control[at.DT] * control[at.SPEED] * np.isfinite(
                control[at.SLIDE_START])  # fmt: skip
            state[at.LEAST_J] = 1.0
            state[at.COUNT] = count
            state[at.NORMAL] = off * count * control[at.LOAD]

        monkeypatch.setattr(assembly, "element_loops", lambda f=given: SimpleNamespace(
            advance_none=f))  # fmt: skip
        made = explicit_sliding(SIDELESS, WAVES, ELASTIC, PRESSED, FEW)
        period = 4 * 20e-6 / np.sqrt(0.6e6 / 1150)
        first = made.time[np.flatnonzero(made.distance > 0)[0] - 1]
        assert first == pytest.approx((2 + holds) * period, rel=0.02)
        settled = not any("had not settled" in note for note in made.notes)
        assert settled == (holds == 1)
        assert made.normal_force[-1] == pytest.approx(off * 60e3 * SIDELESS.nominal_area)


def march_of(load: MicroLoading, scaling: float = 1.0, material: MicroMaterial = ELASTIC) -> Any:
    made = assemble_march(SIDELESS, WAVES, material, load, ExplicitSettings(mass_scaling=scaling))
    return BlockMarch(made, load, 1.6e-9, 40e-6, 20, 1e6, "a", lambda *_: None)


def test_stages_last_as_long_as_asked_for_and_as_the_shear_wave_needs():
    period = 4 * 20e-6 / np.sqrt(0.6e6 / 1150)
    short = replace(PRESSED, press_time=1e-9, hold_time=1e-9, ramp_time=1e-9)
    assert march_of(short).periods == pytest.approx((2 * period, period, 1e-9))
    assert march_of(short, 4.0).periods == pytest.approx((4 * period, 2 * period, 2 * period))
    long = replace(PRESSED, press_time=1e-3, hold_time=2e-3, ramp_time=3e-3)
    assert march_of(long, 4.0).periods == pytest.approx((1e-3, 2e-3, 3e-3))


def test_the_ledger_drift_and_one_wavelength_are_said(file_regression, monkeypatch):
    """Loops that give forces and works: what is said is decided by the drift alone."""
    said: dict[str, Any] = {}
    for name, drift, waves, floor in (
        ("closed", 0.9e-3, 2.2, WAVES), ("open", 1.1e-3, 2.2, WAVES), ("one wave", 0.0, 1.9, WAVES),
        ("no wave", 0.0, 0.9, WAVES), ("flat", 0.0, 0.9, MicroSurface()),
        ("free", 0.0, 2.2, MicroSurface("paraboloid", radius=1e-3)),
    ):  # fmt: skip
        load = replace(PRESSED, slide_distance=waves * 40e-6, speed=3.0)

        def given(count: int, *others: Any, load=load, drift=drift) -> None:
            state, control = others[7], others[8]
            state[at.TIME] += count * control[at.DT]
            if np.isfinite(control[at.SLIDE_START]):
                state[at.SLID] += count * control[at.DT] * 3.0
            state[at.LEAST_J], state[at.COUNT] = 1.0, count
            state[at.NORMAL], state[at.SHEAR] = count * control[at.LOAD], 1e-6 * count
            state[at.AREA], state[at.ABSOLUTE] = 0.8e-9 * count, 2e-6 * count
            state[at.RESULTANT] = 3e-6 * count
            share = state[at.SLID] / load.slide_distance
            work = control[at.LOAD] * load.slide_distance
            state[at.SAMPLE_TOP_WORK] = work
            state[at.SAMPLE_FLOOR_WORK] = drift * work * share
            state[at.STRAIN] = 0.5 * work

        monkeypatch.setattr(assembly, "element_loops", lambda f=given: SimpleNamespace(
            advance_none=f))  # fmt: skip
        made = explicit_sliding(SIDELESS, floor, ELASTIC, load, FEW)
        drifts = [note for note in made.notes if "drifts" in note]
        assert bool(drifts) == (name == "open")
        if made.averages:
            assert made.averages.cof_hysteresis == pytest.approx(1e-6 / (60e3 * 1.6e-9))
            assert made.averages.real_contact_fraction == pytest.approx(0.5)
        said[name] = made.status, made.notes, made.breaches, made.averages
    held(file_regression, said)


def test_what_leaves_the_range_is_marked_on_both_sides_of_each_limit():
    def marked(**change: Any) -> list[str]:
        given: dict[str, Any] = {"elements": 12, "sunk": 0.019, "scaling": 1.0, "speed": 0.1}
        given |= change
        fine = replace(SIDELESS, elements=(given["elements"], given["elements"], 1),
                       roughness=given.get("roughness", MicroSurface()))  # fmt: skip
        load = replace(PRESSED, speed=given["speed"])
        settings = ExplicitSettings(mass_scaling=given["scaling"])
        made = assemble_march(fine, WAVES, ELASTIC, load, settings)
        march = BlockMarch(made, load, 1.6e-9, 40e-6, 20, 1e6, "a", lambda *_: None)
        row = np.zeros((1, len(COLUMNS)))
        row[-1, 2], row[-1, 5] = given["sunk"] * made.penalty * 1e-6 * 1e-9, given.get("area", 1e-9)
        found = _breaches(march, fine, given.get("floor", WAVES), ELASTIC, row)
        return [one.quantity for one in found]

    assert marked() == []
    assert marked(elements=11) == ["elements a wavelength"]
    halved = MicroSurface.checkerboard(1e-6, 20e-6)
    assert marked(roughness=halved, floor=WAVES, elements=23) == ["elements a wavelength"]
    assert marked(roughness=WAVES, floor=halved, elements=24) == []
    assert marked(sunk=0.021) == ["penetration over roughness"]
    assert marked(sunk=0.021, area=0.0) == []
    assert marked(floor=MicroSurface(), sunk=0.021, elements=11) == []
    # 5 factor (v / c_s)^2 = 0.01 at c_s = 22.84 m/s, v = 0.1 m/s: a factor of 104
    speed = np.sqrt(0.6e6 / 1150)
    factor = 0.01 / 5 * (speed / 0.1) ** 2
    assert marked(scaling=0.99 * factor) == []
    assert "mass scaling error" in marked(scaling=1.01 * factor)


def test_rows_become_ledgers_and_means():
    """Each column is itself; of what touches, the edges are taken off, but not below nothing."""
    rows = np.zeros((60, len(COLUMNS)))
    column = {name: n for n, name in enumerate(COLUMNS)}
    rows[:, column["time"]] = np.arange(60)
    rows[10:, column["distance"]] = 0.1 * np.arange(1, 51)
    rows[:, 2:] = 1.0 + 0.1 * np.arange(2, len(COLUMNS))
    made = ledger(rows)
    for name in ("top_work", "strain", "material_loss", "damping_loss", "contact"):
        assert getattr(made, name)[0] == pytest.approx(1.0 + 0.1 * column[name])
    rows[:, column["area"]], rows[:, column["edges"]] = 3.0, 1.0
    rows[:10, column["normal"]] = 1e9  # pressing is no part of the means
    means = averages(rows, 1.0, 6.0)
    assert means is not None
    assert means.wavelengths == 4
    assert means.cof_hysteresis == pytest.approx(1.3 / 1.2)
    assert means.real_contact_fraction == pytest.approx(0.5)
    assert means.real_contact_fraction_corrected == pytest.approx(2 / 6)
    rows[:, column["edges"]] = 4.0
    assert np.isnan(averages(rows, 1.0, 6.0).real_contact_fraction_corrected)


def test_an_element_turned_inside_out_has_the_least_volume_of_all():
    made = assemble_march(SIDELESS, MicroSurface(), ELASTIC, PRESSED, FEW)
    size = made.nodes[0].size
    for squeeze, least in ((-0.5, 0.5), (-2.0, -1.0), (-1.0, -1.0)):
        u = np.zeros((3, size // 3))
        u[2, : made.mesh.nodes.shape[1]] = squeeze * made.mesh.nodes[2]
        state = np.zeros(at.STATE_SIZE)
        plain(element_energies)(
            u.ravel(), made.arrays, made.constants, made.history, made.control, made.terms, False,
            state,
        )  # fmt: skip
        assert state[at.LEAST_J] == pytest.approx(least)
