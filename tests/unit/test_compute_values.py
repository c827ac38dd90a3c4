"""Small steps of a run by their values: rates beyond a compound's test, what is cut off a sole."""

import math
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import load
from underfoot.compute.prepare import prepared
from underfoot.compute.resolve import _untested_rates
from underfoot.compute.sole import trimmed
from underfoot.film import NewtonianFilm
from underfoot.friction.film_shear import FilmShearLaw
from underfoot.shoe import SoleMap

HEEL = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


def with_compound(speed: float, slowest: float | None, fastest: float | None) -> Any:
    material = SimpleNamespace(relaxation=object(), slowest_tested=slowest, fastest_tested=fastest)
    return SimpleNamespace(
        shoe=SimpleNamespace(material=material), motion=SimpleNamespace(speed=speed)
    )


@pytest.mark.parametrize("speed", [0.5, -0.5])
def test_asperities_work_the_rubber_at_rates_of_the_waves_of_a_stylus(speed):
    least, most = (2 * math.pi * 0.5 / wave for wave in (0.8e-3, 2.5e-6))
    (breach,) = _untested_rates(with_compound(speed, None, 1e5))
    assert (breach.low, breach.high) == pytest.approx((least, most))
    assert (breach.range.low, breach.range.high) == (0.0, 1e5)
    assert _untested_rates(with_compound(speed, None, 1.001 * most)) == []
    assert _untested_rates(with_compound(speed, 0.999 * least, 1.001 * most)) == []
    assert len(_untested_rates(with_compound(speed, 1.001 * least, 1.001 * most))) == 1
    assert _untested_rates(with_compound(speed, 1.0, None)) == []


def sloping() -> SoleMap:
    """Return a sole of 20 x 12 cells of 1 mm, 0.1 mm higher with each row; its sides are out."""
    x, y = 1e-3 * np.arange(20), 1e-3 * np.arange(12)
    inside = np.zeros((20, 12), bool)
    inside[:, 3:9] = True
    clearance = np.where(inside, 1e-4 * np.arange(20)[:, None], np.inf)
    depth = np.zeros((20, 12))
    return SoleMap(x, y, clearance, inside, inside.copy(), depth, 1e-3, np.zeros((4, 2)))


@pytest.mark.parametrize(
    ("padding", "rows", "columns"), [(2e-3, 8, (1, 11)), (2.5e-3, 9, (0, 12)), (0.0, 7, (2, 10))]
)
def test_a_trimmed_sole_keeps_what_comes_within_reach_and_its_padding(padding, rows, columns):
    sole = sloping()
    part = trimmed(sole, 5.5e-4, padding=padding)  # rows 0 to 5 stand that low
    np.testing.assert_array_equal(part.x, sole.x[:rows])
    np.testing.assert_array_equal(part.y, sole.y[slice(*columns)])
    cut = (slice(rows), slice(*columns))
    for name in ("clearance", "inside", "land", "tread_depth"):
        np.testing.assert_array_equal(getattr(part, name), getattr(sole, name)[cut])
    assert part.whole is sole


def test_a_sole_that_rolls_keeps_what_any_angle_brings_down():
    sole = sloping()
    flat = math.atan(-0.1)  # toe down by the slope of the sole: every row lies on the floor
    assert trimmed(sole, 5.5e-4, flat).x.size == 20
    assert trimmed(sole, 5.5e-4, cast(Any, [0.0, flat])).x.size == 20
    assert trimmed(sole, 5.5e-4, 0.0).x.size == 10  # 6 rows and 4 of padding


@dataclass(frozen=True)
class HalfSheared:
    """A film that shears its walls half as much as a Newtonian one."""

    viscosity: float
    name: str = "half_sheared"
    source: str = "made for this test"

    def flow_factor(self, gap, speed):
        return np.ones_like(gap), np.zeros_like(gap)

    def shear(self, speed, film_thickness):
        return 0.5 * self.viscosity * np.asarray(speed) / np.asarray(film_thickness)


def test_only_a_film_of_another_shear_takes_the_place_of_eta_v_over_h():
    case = load(HEEL)
    viscosity, at = 0.2, ([1e5], 0.5, [2e-5])

    first = prepared(case, 4e-3, {"film": NewtonianFilm(viscosity)})

    def law_with(film):
        return prepared(case, 4e-3, {"film": film}, geometry=(first.sole, first.compliance)).law

    plain = first.law
    assert not isinstance(plain, FilmShearLaw)
    assert not isinstance(law_with(None), FilmShearLaw)
    halved = law_with(HalfSheared(viscosity))
    assert halved(*at).viscous == pytest.approx(0.5 * viscosity * 0.5 / 2e-5)
    assert halved(*at).adhesion == pytest.approx(plain(*at).adhesion)
