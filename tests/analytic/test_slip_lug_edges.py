"""A slipping foot whose lugs have edges, against the friction of a steady run."""

from dataclasses import replace

import pytest

from underfoot.case import Case
from underfoot.compute.slips import slip_setting
from underfoot.friction import cof
from underfoot.slip.dynamics.full_model import SoleFoot


def test_a_slipping_lug_has_the_friction_of_a_steady_run():
    case = Case(
        shoe="slip_resistant_shoe_treaded",
        floor="vinyl_g4",
        contaminant="glycerol_90pct",
        motion={"from": "slip_tester_g4"},
        numerics={"quick_grid_spacing": "1.2 mm"},
    )
    setting = slip_setting(case)
    angle = setting.shoe_angle
    instant = SoleFoot(setting, angle).advance(
        0.02, normal_force=300.0, speed=0.3, shoe_angle=angle
    )
    state = instant.state
    assert setting.edged is not None
    shear = setting.edged.on(state)(state.contact_pressure, 0.3, state.film_thickness)
    pressures = state.contact_pressure, state.fluid_pressure
    steady = cof(shear, *pressures, spacing=state.spacing, wet=state.wet, **state.areas)
    assert instant.friction(0.3) == pytest.approx(steady.friction_force, rel=1e-9)
    bare = replace(instant, law=setting.friction)
    # edges need sliding: at rest there is neither film nor suction
    assert instant.friction(0.0) == pytest.approx(bare.friction(0.0), rel=0.02)
    assert instant.friction(0.3) > bare.friction(0.3)
    assert slip_setting(case.replace("film.lug_edges", False)).edged is None
    assert slip_setting(case.replace("shoe.tread.pattern", "none")).edged is None
