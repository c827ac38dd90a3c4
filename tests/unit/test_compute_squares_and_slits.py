"""Stresses of finer cells on their squares; slits that leave no lug."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import load
from underfoot.compute import contact_friction as module
from underfoot.compute import micro_contact as micro
from underfoot.compute.contact_friction import _on_squares
from underfoot.core import InputError, SourcedValue
from underfoot.film.regimes import fluid_load_share
from underfoot.fluid.temperature import sliding_heat, viscosity_slope
from underfoot.friction import FrictionParts
from underfoot.friction.pair_contact import PairContactLaw
from underfoot.rough_contact import ExponentialLaw
from underfoot.shoe import Heel, Sipes
from underfoot.shoe.parametric.solid import check_printable

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_full_tread_glycerol.toml"


def test_a_square_has_the_mean_of_its_cells_part_by_part():
    """Two squares of area 1 and 2: three cells on the first, two on the second, one of it dry."""
    square, area = np.array([0, 0, 0, 1, 1]), np.array([0.5, 0.25, 0.25, 1.5, 0.5])
    wet = np.array([True, True, True, True, False])
    parts = (np.array([4.0, 8, 0, 2, 6]), np.array([1.0, 1, 1, 3, 3]), np.array([2.0, 2, 2, 4, 4]))
    shown = _on_squares(
        FrictionParts(*parts),
        cast(Any, SimpleNamespace(square=square, area=area, wet=wet)),
        cast(Any, SimpleNamespace(areas={"area": np.array([[1.0], [2.0]])})),
    )
    assert shown.adhesion.ravel().tolist() == [4.0, 3.0]
    assert shown.hysteresis.ravel().tolist() == [1.0, 3.0]
    assert shown.viscous.ravel().tolist() == [2.0, 3.0]


@pytest.mark.parametrize(("width", "fits"), [(0.99e-3, True), (1e-3, False), (1.9e-3, False)])
def test_slits_take_less_than_half_of_their_spacing(width, fits):
    if fits:
        assert Sipes(width, 1e-3, 2e-3).width == width
    else:
        with pytest.raises(InputError, match="leave no lug"):
            Sipes(width, 1e-3, 2e-3)


@pytest.mark.parametrize(("thickness", "fits"), [(9e-3, False), (11e-3, True)])
def test_the_crown_of_a_heel_is_half_its_width_squared_over_twice_its_radius(thickness, fits):
    """30 mm squared over 2 x 45 mm: the rim stands 10 mm above the middle."""
    heel = Heel(
        length=0.06, width=0.06, rear_radius=0.02, outsole_thickness=thickness, crown_radius=0.045
    )
    if fits:
        check_printable(heel)
    else:
        with pytest.raises(InputError, match=r"reach 10 mm"):
            check_printable(heel)


def test_a_film_of_no_thickness_leaves_the_load_to_the_asperities():
    law = ExponentialLaw(3e6, 0.5, 2e-6)
    pressure = float(law.pressure(0.0))
    assert fluid_load_share(0.0, law, 2 * pressure) == pytest.approx(0.5)
    assert fluid_load_share([0.0, 1.0], law, pressure) == pytest.approx([0.0, 1.0])
    with pytest.raises(InputError, match="film_thickness"):
        fluid_load_share(-1e-9, law, pressure)


@pytest.mark.parametrize("wear", [0.0, 1e-3])
def test_a_slip_class_was_tested_on_the_new_sole(monkeypatch, wear):
    case = load(EXAMPLE).replace("shoe.wear.depth", wear)
    law, worn, new = object.__new__(PairContactLaw), SimpleNamespace(spacing=2e-3), object()
    known = SimpleNamespace(fails=True)
    monkeypatch.setattr(type(case.shoe), "known_class", lambda shoe: known)
    monkeypatch.setattr(module, "sole_map", lambda one, spacing: new)
    monkeypatch.setattr(module, "place_of_tread", lambda one, sole: (one.shoe.wear.depth, sole))
    monkeypatch.setattr(module, "of_class", lambda *given: SimpleNamespace(law=given))
    found = module.of_known_class(cast(Any, law), case, cast(Any, worn))
    assert cast(Any, found)[:3] == (law, known, (0.0, new if wear else worn))


@pytest.mark.parametrize("film_share", [0.0, 0.6, 1.0])
@pytest.mark.parametrize("rows", [2, 6])
def test_a_film_is_warmed_by_the_pressure_over_the_length_that_is_loaded(rows, film_share):
    """Two columns of cells of 2 mm; more of them bear the same load for longer, less warm.

    What the film itself heats falls as it thins.
    """
    case = load(EXAMPLE)
    loaded = np.zeros((9, 5))
    loaded[1 : 1 + rows, 1:3] = 1e5
    contact = SimpleNamespace(total_pressure=loaded, spacing=2e-3)
    context = SimpleNamespace(viscosity_value=0.2)
    heat, samples = 0.05, 200
    found = module.film_warmth(
        case, cast(Any, context), heat, cast(Any, contact), film_share=film_share, samples=samples
    )
    assert found is not None
    force, speed, seed = case.motion.normal_force, abs(case.motion.speed), case.numerics.seed
    warmer = sliding_heat(heat, force / (2 * rows * 4e-6), speed, 2e-3 * rows)
    room = module.ROOM_DEVIATION * module.normal_draws(
        seed, "temperature of the laboratory", samples
    )
    share = module.named_shares(seed, "share of the heat of sliding", samples)
    slope = viscosity_slope(0.2, oil=case.contaminant.chemistry == "oil")
    warmed = found + slope * room  # ln of what heat leaves of the shear stress
    left = 1 - film_share + film_share * np.exp(warmed)
    assert warmed == pytest.approx(-slope * warmer * share * left)
    assert np.std(warmer * share) > 0.01 * np.std(room)


def test_a_rough_contact_is_told_at_the_mean_pressure_over_the_load(monkeypatch):
    """Cells at 1, 1 and 4 bar: (1 + 1 + 16) / 6 = 3 bar, inside the table of 1 to 2 bar only 2."""
    asked = []

    def sourced(quantity, *at):
        asked.append((quantity, *at))
        return SourcedValue(2.0, uncertainty=0.4)

    table = SimpleNamespace(
        pressure=np.array([1e5, 2e5]), speed=np.array([0.1, 0.5]),
        realizations=np.array([4.0, 9.0]), sourced_value=sourced,
    )  # fmt: skip
    context = SimpleNamespace(rough_contact=lambda _: table, rq_deviation=0.3)
    parts = SimpleNamespace(
        context=context, objects={}, case=SimpleNamespace(motion=SimpleNamespace(speed=-0.7))
    )
    contact = SimpleNamespace(contact_pressure=np.array([[1e5, 1e5], [4e5, 0.0]]))
    monkeypatch.setattr(micro, "contact_deviation", lambda *given: given[1:3])
    found = micro.micro_contact(cast(Any, parts), cast(Any, contact))
    assert (found.pressure, found.speed) == (pytest.approx(3e5), -0.7)
    assert found.contact_deviation == (2e5, 0.5)
    assert asked == [("mean_gap", 2e5, 0.5), ("flow_factor_along", 2e5, 0.5)]
    expected = [np.sqrt(0.1**2 + 0.3**2 + e**2) for e in (micro.GAP_ERROR, micro.FLOW_ERROR)]
    assert (found.gap_deviation, found.flow_deviation) == pytest.approx(
        (expected[0], min(expected[1], 1.0))
    )
