"""What must hold for every pressed and sliding sole."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from underfoot.core import Status
from underfoot.core.sparse import back_ends
from underfoot.rough_contact.pressure_gap_law import ExponentialLaw
from underfoot.shoe import Facet, Heel, Tread, heel_map
from underfoot.shoe.row_division import row_cells
from underfoot.sole_contact import march
from underfoot.sole_contact.compliance import ConvolutionCompliance, layered_compliance
from underfoot.sole_contact.solver import SolverSettings, solve_sliding
from underfoot.sole_contact.stepping import SlidingSole

MODULUS = 5e6


def sole(spacing=2e-3, tread=None, padding=4e-3):
    heel = Heel(
        length=0.06,
        width=0.06,
        rear_radius=0.028,
        outsole_thickness=0.025,
        profile=Facet(math.radians(10), 0.03),
        edge_radius=0.002,
        tread=tread,
    )
    return heel_map(heel, shoe_angle=math.radians(10), spacing=spacing, padding=padding)


def solve(
    shape,
    *,
    viscosity: float | None = 0.05,
    speed=0.5,
    force=400.0,
    rq=12e-6,
    stiffer=1.0,
    **options,
):
    body = layered_compliance(shape, modulus=stiffer * MODULUS, poisson_ratio=0.49, thickness=0.02)
    return solve_sliding(
        shape,
        body,
        ExponentialLaw(stiffer * MODULUS, 0.5, rq),
        viscosity=viscosity,
        speed=speed,
        normal_force=force,
        settings=SolverSettings(**options),
    )


@pytest.mark.slow
@settings(max_examples=4, deadline=None)
@given(
    viscosity=st.floats(1e-3, 0.3),
    speed=st.floats(-1.0, 1.0),
    force=st.floats(50, 800),
    rq=st.floats(4e-6, 30e-6),
)
@example(0.001, -6e-5, 429.0, 18.9e-6)  # hardly a film: cells leave and join it in turn
@example(0.1875, 1.0, 140.0, 12.8e-6)  # two thirds of 170 kPa lay on one side of a symmetric sole
def test_load_pressure_and_film_are_physical(viscosity, speed, force, rq):
    shape = sole()
    solved = solve(shape, viscosity=viscosity, speed=speed, force=force, rq=rq)
    assert solved.status is Status.CONVERGED
    assert solved.fluid_load + solved.contact_load == pytest.approx(force, rel=2e-4)
    assert (solved.fluid_pressure >= 0).all()
    assert (solved.contact_pressure > -1e-3 * solved.total_pressure.max()).all()
    assert (solved.fluid_pressure[~solved.wet] == 0).all()
    assert (solved.fluid_pressure[solved.cavitated] == 0).all()
    assert (solved.film_thickness <= 0.6e-3).all()
    assert np.isfinite(solved.film_thickness).all()
    assert solved.residuals[-1] < 1e-4
    for field in (solved.fluid_pressure, solved.contact_pressure):
        assert field == pytest.approx(field[:, ::-1], abs=1e-6 * solved.total_pressure.max())


def test_a_symmetric_sole_has_a_symmetric_answer_on_cells_along_the_sliding():
    tread = Tread("hexagons", lug_width=8e-3, channel_width=5e-3, depth=2e-3)
    shape = sole(tread=tread)
    heel = Heel(
        length=0.06,
        width=0.06,
        rear_radius=0.028,
        outsole_thickness=0.025,
        profile=Facet(math.radians(10), 0.03),
        edge_radius=0.002,
        tread=tread,
    )
    fine = heel_map(heel, shoe_angle=math.radians(10), spacing=2e-3, columns=4)
    solved = solve(dataclasses.replace(shape, cells=row_cells(shape, fine)), viscosity=0.2)
    assert solved.status is Status.CONVERGED
    fluid = solved.fluid_pressure
    assert fluid == pytest.approx(fluid[:, ::-1], abs=1e-6 * solved.total_pressure.max())


def test_the_mirror_is_none_where_sole_or_body_is_not_its_own_image():
    shape = sole()
    body = layered_compliance(shape, modulus=MODULUS, poisson_ratio=0.49, thickness=0.02)

    def mirror(shape, body):
        law = ExponentialLaw(MODULUS, 0.5, 12e-6)
        return SlidingSole(shape, body, law, viscosity=0.05)._march.problem.mirror

    image = mirror(shape, body)
    assert image is not None
    assert np.array_equal(image[image], np.arange(image.size))
    leaning = shape.clearance + 1e-6 * (shape.y - shape.y.min())
    assert mirror(dataclasses.replace(shape, clearance=leaning), body) is None
    weight = np.linspace(1.0, 1.001, shape.y.size) * np.ones(shape.clearance.shape)
    influence = body._convolution.influence[0]
    askew = ConvolutionCompliance(
        shape.clearance.shape, [(influence, weight)], body.symbol, modulus=MODULUS
    )
    assert mirror(shape, askew) is None


def test_thin_fluid_tends_to_the_dry_contact():
    shape = sole()
    dry = solve(shape, viscosity=None)
    loads = [
        solve(shape, viscosity=value, start_film=1e-5).fluid_load for value in (0.05, 1e-3, 1e-6)
    ]
    assert loads[0] > loads[1] > loads[2]
    nearly = solve(shape, viscosity=1e-6, start_film=1e-5)
    assert nearly.fluid_load < 1.0
    assert nearly.contact_pressure == pytest.approx(
        dry.contact_pressure, abs=0.01 * dry.contact_pressure.max()
    )
    assert dry.fluid_load == 0.0
    assert dry.approach == pytest.approx(nearly.approach, rel=0.01)


def test_pressures_scale_with_modulus_and_viscosity():
    shape = sole()
    plain = solve(shape)
    twice = solve(shape, viscosity=0.1, force=800.0, stiffer=2.0)
    assert twice.total_pressure == pytest.approx(
        2 * plain.total_pressure, abs=1e-3 * twice.total_pressure.max()
    )
    assert twice.approach == pytest.approx(plain.approach, rel=1e-4)


def test_time_scales_with_speed_and_viscosity():
    shape = sole()
    plain = solve(shape)
    hasty = solve(shape, viscosity=0.025, speed=1.0, rise_time=0.015, end_time=0.06)
    assert hasty.fluid_load == pytest.approx(plain.fluid_load, rel=1e-4)


def test_backward_is_forward_of_the_mirrored_sole():
    shape = sole()
    mirrored = dataclasses.replace(
        shape,
        x=-shape.x[::-1],
        clearance=shape.clearance[::-1].copy(),
        inside=shape.inside[::-1].copy(),
        land=shape.land[::-1].copy(),
        tread_depth=shape.tread_depth[::-1].copy(),
    )
    backward = solve(shape, speed=-0.7)
    forward = solve(mirrored, speed=0.7)
    assert backward.status is forward.status is Status.CONVERGED
    assert forward.fluid_pressure[::-1] == pytest.approx(
        backward.fluid_pressure, abs=2e-3 * backward.total_pressure.max()
    )


def test_squeezed_fluid_leaves_in_time():
    shape = sole()
    loads = [solve(shape, speed=0.0, end_time=end).fluid_load for end in (0.1, 0.5, 2.5)]
    assert loads[0] > loads[1] > loads[2]


def test_steady_state_forgets_the_start():
    # on 2 mm cells the rim of the film is not resolved and two steady states exist
    shape = sole(1e-3)
    found = [
        solve(shape, viscosity=0.2, end_time=None, start_film=film).fluid_load
        for film in (20e-6, 80e-6)
    ]
    assert found[1] == pytest.approx(found[0], rel=0.005)


def test_steady_state_with_cells_at_the_brink_of_the_pool():
    solved = solve(sole(1e-3), viscosity=0.219, speed=0.7, force=500.0, rq=5.6e-6, end_time=None)
    assert solved.status is Status.CONVERGED
    assert solved.history.fluid_load[-1] == pytest.approx(solved.history.fluid_load[-2], rel=1e-3)


def test_result_does_not_depend_on_padding():
    narrow = solve(sole(padding=4e-3), rq=8e-6)
    wide = solve(sole(padding=16e-3), rq=8e-6)
    assert wide.fluid_load == pytest.approx(narrow.fluid_load, rel=2e-3)
    assert wide.approach == pytest.approx(narrow.approach, rel=2e-3)
    assert wide.total_pressure.max() == pytest.approx(narrow.total_pressure.max(), rel=2e-3)


def test_both_factorizations_give_the_same_contact():
    tread = Tread("grid", lug_width=8e-3, channel_width=6e-3, depth=2e-3)
    found = [solve(sole(tread=tread), backend=name) for name in back_ends()]
    for other in found[1:]:
        assert other.fluid_load == pytest.approx(found[0].fluid_load, rel=1e-3)
        assert other.total_pressure == pytest.approx(
            found[0].total_pressure, abs=2e-3 * found[0].total_pressure.max()
        )


def test_channels_drain():
    tread = Tread("grid", lug_width=5e-3, channel_width=2.5e-3, depth=2e-3)
    plain = solve(sole(1e-3), viscosity=0.2).fluid_load
    assert solve(sole(1e-3, tread=tread), viscosity=0.2).fluid_load < 0.5 * plain


@pytest.mark.slow
def test_refinement_settles():
    """True fluid load of a sole whose film is resolved: changes shrink with the spacing."""
    loads = [solve(sole(spacing), rq=20e-6).fluid_load for spacing in (1e-3, 0.5e-3, 0.25e-3)]
    assert abs(loads[2] - loads[1]) < 0.7 * abs(loads[1] - loads[0]) or loads[2] == pytest.approx(
        loads[1], rel=0.02
    )
    assert loads[2] == pytest.approx(loads[1], rel=0.08)


@pytest.mark.slow
def test_krylov_iterations_do_not_grow_with_the_grid():
    counts = [solve(sole(spacing)).counts for spacing in (2e-3, 1e-3, 0.7e-3)]
    each = [count.krylov / count.newton for count in counts]
    assert max(each) < 10
    assert each[-1] < 1.5 * each[0]


def test_gap_of_a_raised_sole_is_open():
    """A film that the load hardly squeezes keeps the height it started with."""
    shape = sole()
    solved = solve(shape, speed=0.0, viscosity=50.0, force=1.0, end_time=0.031, rq=4e-6)
    assert solved.film_thickness.min() == pytest.approx(50e-6, rel=0.2)


def test_deep_channels_are_left_out_of_the_cells_of_a_step(monkeypatch):
    """Cells far over the pool bear nothing: with them in it the march is the same, and dearer."""
    tread = Tread("grid", lug_width=5e-3, channel_width=5e-3, depth=3e-3)
    exact = {"tolerance": 1e-8, "krylov_tolerance": 1e-5, "end_time": 0.04}
    few = solve(sole(tread=tread), **exact)
    monkeypatch.setattr(march, "DEEP", 1.0)
    all_near = solve(sole(tread=tread), **exact)
    assert few.fluid_load == pytest.approx(all_near.fluid_load, rel=1e-7)
    assert few.approach == pytest.approx(all_near.approach, rel=1e-7)
    assert few.counts.cells < 0.5 * all_near.counts.cells
    # the pole's field goes on beside the cells: the preconditioner stays as good
    assert few.counts.krylov < 1.2 * all_near.counts.krylov
