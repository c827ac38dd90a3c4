"""What must hold for a sliding block: no loss without loss, energy kept, restart, bad input."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from underfoot.block import (
    ExplicitSettings,
    MicroBlock,
    MicroLoading,
    MicroMaterial,
    MicroResult,
    MicroSurface,
    explicit_sliding,
)
from underfoot.block.assembly import assemble_march, mass_scaling_error
from underfoot.block.result import EDGE_EXCESS, edge_excess_area
from underfoot.core import Cancelled, ConvergenceError, DataError, InputError, Status
from underfoot.material import Elastomer, RelaxationSpectrum

pytestmark = pytest.mark.slow  # the element loops are compiled on their first use, 20 s each

# The grant report's block, rubber and roughness (G.1.1, Tables 1 and 2) with nu = 0.45: K low for
# speed, on a coarser mesh.
REPORT = RelaxationSpectrum(0.44e6, np.array([0.15e6]), np.array([40.0]))
RUBBER = MicroMaterial.from_poisson(REPORT, 0.45)
FLOOR = MicroSurface.checkerboard(35.1e-6, 0.4e-3)
BLOCK = MicroBlock(
    elements=(16, 10, 6), bottom_layer=50e-6, roughness=MicroSurface.checkerboard(12.1e-6, 0.5e-3)
)
FAST = MicroLoading(speed=1.0, slide_distance=0.85e-3, press_time=0.4e-3, hold_time=0.1e-3)


@pytest.fixture(scope="module")
def report_slide() -> MicroResult:
    return explicit_sliding(BLOCK, FLOOR, RUBBER, FAST)


def test_report_material_has_no_hysteresis_friction(report_slide: MicroResult):
    means = report_slide.averages
    assert means is not None
    assert abs(means.cof_hysteresis) < 1e-4
    assert means.cof_absolute > 0.005  # what an unsigned mean would have reported
    assert means.cof_resultant >= means.cof_absolute
    assert means.mean_pressure == pytest.approx(160e3, rel=0.03)


def test_energy_ledger_closes(report_slide: MicroResult):
    energy = report_slide.energy
    assert energy is not None
    moving = report_slide.distance > 0.0
    scale = float(report_slide.normal_force[moving].mean()) * float(report_slide.distance[-1])
    assert np.ptp(energy.residual[moving]) < 1e-5 * scale
    # From the first touch: against all the work done by pressing.
    assert np.abs(energy.residual).max() < 1e-3 * np.abs(energy.top_work).max()


def test_shear_never_exceeds_the_steepest_slope(report_slide: MicroResult):
    slope = np.pi * FLOOR.peak_to_valley / FLOOR.wavelength
    assert np.all(np.abs(report_slide.shear_force) <= slope * report_slide.normal_force + 1e-15)


def test_mass_scaling_stays_within_its_bound():
    slow = replace(FAST, speed=0.1, slide_distance=0.41e-3, control="load")
    block = replace(BLOCK, elements=(12, 8, 5), bottom_layer=60e-6)
    both = []
    for factor in (1.0, 100.0):
        settings = ExplicitSettings(mass_scaling=factor)
        means = explicit_sliding(block, FLOOR, RUBBER, slow, settings).averages
        assert means is not None
        both.append(means.area_per_force)
    bound = mass_scaling_error(0.1, RUBBER.wave_speeds[1], 100.0)
    assert bound == pytest.approx(0.01, rel=0.05)
    assert both[1] == pytest.approx(both[0], rel=bound)


def test_restart_goes_on_as_if_never_stopped(tmp_path: Path):
    loading = replace(FAST, slide_distance=0.2e-3)
    block = replace(BLOCK, elements=(9, 6, 4), bottom_layer=80e-6, roughness_layers=2)
    whole = explicit_sliding(block, FLOOR, RUBBER, loading)

    def stop(stage: str, fraction: float, residual: float | None = None) -> None:
        if stage == "slide" and fraction > 0.4:
            raise Cancelled("stopped")

    folder = tmp_path / "run"
    part = explicit_sliding(block, FLOOR, RUBBER, loading, output=folder, progress=stop)
    assert part.status is Status.CANCELLED
    rest = explicit_sliding(
        block, FLOOR, RUBBER, loading, output=folder, snapshots=2, restart=folder / "restart.npz"
    )
    assert np.array_equal(rest.shear_force, whole.shear_force)
    assert rest.steps == whole.steps
    other = replace(loading, speed=0.5)
    with pytest.raises(DataError, match="another"):
        explicit_sliding(block, FLOOR, RUBBER, other, restart=folder / "restart.npz")
    broken = tmp_path / "broken.npz"
    broken.write_bytes(b"not an archive")
    with pytest.raises(DataError, match="can't be read"):
        explicit_sliding(block, FLOOR, RUBBER, loading, restart=broken)


def test_snapshots_open_again(tmp_path: Path):
    meshio = pytest.importorskip("meshio")
    block = replace(BLOCK, elements=(9, 6, 4), bottom_layer=80e-6, roughness_layers=2)
    loading = replace(FAST, slide_distance=0.1e-3)
    explicit_sliding(block, FLOOR, RUBBER, loading, output=tmp_path / "run", snapshots=2)
    files = sorted(path.name for path in (tmp_path / "run").iterdir())
    assert files == ["block.pvd", "block_0001.vtu", "block_0002.vtu", "restart.npz"]
    mesh = meshio.read(tmp_path / "run" / "block_0002.vtu")
    assert mesh.points.shape == (10 * 7 * 5, 3)
    assert len(mesh.cells_dict["hexahedron"]) == 9 * 6 * 4
    assert set(mesh.cell_data) == {"pressure", "volume_ratio", "von_mises_stress"}
    # Pressed on the floor: the lowest points lie on it within the contact's springs.
    assert -17.6e-6 < mesh.points[:, 2].min() < 17.6e-6


def test_a_march_that_fails_keeps_its_last_good_state(tmp_path: Path):
    crushing = replace(FAST, mean_pressure=30e6)
    with pytest.raises(ConvergenceError, match="last good state") as caught:
        explicit_sliding(BLOCK, FLOOR, RUBBER, crushing, output=tmp_path / "run")
    assert (tmp_path / "run" / "last_good_state.npz").is_file()
    assert caught.value.remedy


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"roughness": MicroSurface.checkerboard(12e-6, 5e-3)}, "wavelength of 0.005 m"),
        ({"roughness": MicroSurface.checkerboard(12e-6, 0.1e-3)}, "elements a wavelength"),
        (
            {"roughness": MicroSurface.checkerboard(150e-6, 0.5e-3), "roughness_layers": 1},
            "bottom layers",
        ),
        ({"bottom_layer": 0.4e-3}, "ratio of"),
        ({"sides": "periodic"}, "periodic sides"),
    ],
)
def test_meshes_that_are_refused(change: dict[str, object], words: str):
    with pytest.raises(InputError, match=words):
        explicit_sliding(replace(BLOCK, **change), FLOOR, RUBBER, FAST)


def test_floor_longer_than_the_block_is_refused():
    with pytest.raises(InputError, match=r"4 and 5 mm .* fit"):
        explicit_sliding(BLOCK, MicroSurface.checkerboard(35.1e-6, 4e-3), RUBBER, FAST)


def test_time_step_above_critical_is_refused():
    with pytest.raises(InputError, match="below the critical"):
        explicit_sliding(BLOCK, FLOOR, RUBBER, FAST, ExplicitSettings(time_step=1e-5))


def test_contact_too_stiff_for_the_step_is_refused():
    with pytest.raises(InputError, match="contact stiffness"):
        explicit_sliding(BLOCK, FLOOR, RUBBER, FAST, ExplicitSettings(penalty_factor=50.0))


@pytest.mark.parametrize("ratio", [0.5, 0.0, 0.7, float("nan")])
def test_poisson_ratios_that_are_refused(ratio: float):
    with pytest.raises(InputError, match="Poisson"):
        MicroMaterial.from_poisson(REPORT, ratio)


def test_materials_that_are_refused():
    with pytest.raises(InputError, match="no relaxation data"):
        MicroMaterial.from_elastomer(Elastomer(2e6, 0.49, name="sole"))
    assert len(MicroMaterial.from_elastomer(Elastomer(2e6, 0.49), elastic=True).shear) == 0
    with pytest.raises(InputError, match="no stable step"):
        MicroMaterial(REPORT, float("inf"))


def test_bulk_modulus_of_table_2():
    """Neolite's printed 9324 MPa is 2 G_inf (1 + nu) / (3 (1 - 2 nu)) with nu = 0.499."""
    neolite = RelaxationSpectrum(18.66e6, np.array([11.58e6]), np.array([1.0 / 0.013]))
    assert MicroMaterial.from_poisson(neolite, 0.499).bulk_modulus == pytest.approx(
        9324e6, rel=1e-3
    )


def test_mass_is_scaled_within_both_bounds():
    neolite = MicroMaterial.from_poisson(RelaxationSpectrum(30e6), 0.49)
    for speed in (0.1, 1.0):
        loading = replace(FAST, speed=speed)
        plain = assemble_march(BLOCK, FLOOR, neolite, loading, ExplicitSettings())
        scaled = assemble_march(
            BLOCK, FLOOR, neolite, loading, ExplicitSettings(mass_scaling="auto")
        )
        assert scaled.mass_scaling > 1.2
        assert scaled.impact_friction == pytest.approx(1e-4, rel=1e-9)
        assert scaled.impact_friction == pytest.approx(
            scaled.mass_scaling * plain.impact_friction, rel=1e-9
        )
        assert mass_scaling_error(speed, neolite.wave_speeds[1], scaled.mass_scaling) <= 0.01
    asked = ExplicitSettings(mass_scaling=2.0 * scaled.mass_scaling)
    slow = replace(FAST, slide_distance=0.0, press_time=2e-5, hold_time=0.0)
    result = explicit_sliding(replace(BLOCK, elements=(9, 6, 4)), FLOOR, neolite, slow, asked)
    assert any(breach.quantity == "COF of scaled inertia" for breach in result.breaches)


def test_friction_of_scaled_inertia_stays_within_its_bound():
    """Loss-free neolite: what the lower nodes lose as they meet the floor, energies and all."""
    neolite = MicroMaterial.from_poisson(RelaxationSpectrum(30e6), 0.49)
    block = replace(BLOCK, elements=(14, 9, 5), bottom_layer=50e-6)
    loading = replace(FAST, speed=0.1, slide_distance=0.41e-3, hold_time=1e-3)
    result = explicit_sliding(block, FLOOR, neolite, loading, ExplicitSettings(mass_scaling="auto"))
    assert result.averages is not None
    assert abs(result.averages.cof_hysteresis) < 1e-4
    assert any("on the COF" in note for note in result.notes)


def test_edges_of_contact_spots():
    touching = np.zeros((8, 10), dtype=bool)
    touching[2:5, 3:7] = True  # 3 by 4 nodes: 6 sides along x, 8 along y
    expected = EDGE_EXCESS * (6 * 2.0 + 8 * 1.0) * np.sqrt(2.0)
    for periodic in (True, False):
        assert edge_excess_area(touching, 1.0, 2.0, periodic=periodic) == pytest.approx(expected)
    assert edge_excess_area(np.ones((8, 10), dtype=bool), 1.0, 2.0, periodic=True) == 0.0
    assert edge_excess_area(np.ones((8, 10), dtype=bool), 1.0, 2.0, periodic=False) == 0.0
