"""Flow through gaps with an exact answer; tables with holes; averages with finer waves."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from snapshot import refusal
from underfoot.rough_contact.contact_table import (
    QUANTITIES,
    _averages,
    _check_surfaces,
    _holes,
    _nodes,
    _pairs,
    _table,
    leave_out_errors,
)
from underfoot.rough_contact.flow_factor import FlowFactors, flow_factors
from underfoot.rough_contact.theory import checked_spectrum


@pytest.mark.parametrize("spacing", [1.0, 2e-6, (1.0, 3.0), (5e-6, 2e-6)])
def test_stripes_lie_in_a_row_or_side_by_side(spacing):
    """Along: one over the mean of (a + b) / (2 a^2 b^2) of neighbours; across: mean of cubes."""
    row = np.array([1.0, 2.0, 4.0, 1.5, 0.5])
    gap = np.repeat(row[:, None], 4, axis=1)
    beside = np.roll(row, -1)
    face = 2 * row**2 * beside**2 / (row + beside)
    in_row, cubes = 1 / (1 / face).mean(), (row**3).mean()
    made = flow_factors(gap, spacing)
    assert made.along == pytest.approx(in_row / row.mean() ** 3)
    assert made.across == pytest.approx(cubes / row.mean() ** 3)
    assert made.coupling == pytest.approx(0, abs=1e-12)
    assert made.mean_gap == pytest.approx(1.8)
    assert made.mean == pytest.approx(0.5 * (made.along + made.across))
    turned = flow_factors(gap.T, spacing)
    assert (turned.across, turned.along) == pytest.approx((made.along, made.across))


def test_a_slanted_channel_drives_flow_sideways():
    """A channel at 45 degrees: what goes along goes across as much, to the side of its slant."""
    n = 8
    i, j = np.indices((n, n))
    up, down = (np.where(np.isin(way % n, (0, 1, 2)), 1.0, 0.0) for way in (i - j, i + j))
    one, other = flow_factors(up), flow_factors(down)
    assert one.along == pytest.approx(one.across)
    assert one.coupling == pytest.approx(one.along)
    assert other.coupling == pytest.approx(-one.coupling)
    assert one.mean_gap == pytest.approx(3 / 8)


def test_what_is_shut_carries_nothing():
    """Pools that no edge cuts carry none; one line of fluid carries along itself alone."""
    line = np.zeros((5, 5))
    line[:, 2] = 2.0
    made = flow_factors(line)
    assert made.along == pytest.approx(8 / 5 / 0.4**3)
    assert made.across == made.coupling == 0.0
    pool = np.zeros((5, 5))
    pool[1:4, 1:4] = 1.0
    assert flow_factors(pool) == FlowFactors(0.0, 0.0, 0.0, pytest.approx(9 / 25), 0.0)
    assert flow_factors(np.zeros((3, 3))) == FlowFactors(0.0, 0.0, 0.0, 0.0, 0.0)
    alone = np.zeros((4, 4))
    alone[::2, ::2] = alone[1::2, 1::2] = 1.0
    assert flow_factors(alone) == FlowFactors(0.0, 0.0, 0.0, 0.5, 0.0)
    floor = np.full((4, 4), 0.1)
    floor[:, 1] = 1.0
    shut = flow_factors(floor, closed=0.1)
    assert shut.across == 0.0
    assert shut.mean_gap == 0.25
    assert flow_factors(floor, closed=0.099).across > 0


def test_gaps_that_are_none_are_refused_and_rounding_is_contact():
    flat = np.ones((3, 3))
    flat[1, 1] = -0.9e-3
    made = flow_factors(flat)
    assert made.mean_gap == pytest.approx(8 / 9)
    flat[1, 1] = -1.1e-3
    assert "the smallest gap is -0.0011 m" in refusal(flow_factors, flat)
    assert "shape (2, 3)" in refusal(flow_factors, np.ones((2, 3)))
    assert "shape (3, 2)" in refusal(flow_factors, np.ones((3, 2)))
    assert "shape (9,)" in refusal(flow_factors, np.ones(9))
    flat[0, :2] = np.nan, np.inf
    assert "2 gaps are not finite" in refusal(flow_factors, flat)


P, V = np.array([1e3, 2e3, 4e3, 8e3, 16e3]), np.array([0.1, 1.0])


def column(level: float, *missing: int, remarks: Any = ()) -> dict[str, np.ndarray]:
    """Return what a part gives at every pressure: each quantity a line in its logarithm."""
    values = {}
    for number, name in enumerate(QUANTITIES):
        row = level * (1 + number) + np.log(P / 1e3)
        row[list(missing)] = np.nan
        values[name] = row
    return {**values, "error": np.full(P.size, 0.25 * level), "remarks": np.array(remarks, str),
            "out_of_range": np.array(["far"] * bool(remarks), str)}  # fmt: skip


def test_a_hole_between_two_solutions_is_bridged_and_counted():
    columns = [column(1.0, 2), column(4.0, remarks=["a"]), column(3.0, 2), column(6.0, 1)]
    made = _table([cast(Any, "about")], P, V, columns, ["k"], "d")
    for number, name in enumerate(QUANTITIES):
        exact = (1 + number) * np.array([2.0, 5.0]) + np.log(P / 1e3)[:, None]
        exact[1, 1] = 4 * (1 + number) + np.log(2)  # one of two
        np.testing.assert_allclose(made.values[name], exact)
        spread = (1 + number) * np.sqrt(2.0) * np.ones((5, 2))
        spread[2, 0] = spread[1, 1] = np.nan
        np.testing.assert_allclose(made.deviation[name], spread)
    assert made.realizations.tolist() == [[2, 2], [2, 1], [0, 2], [2, 2], [2, 2]]
    assert [str(one) for one in made.notes] == [
        "about", "a", "3 of 20 solutions did not converge and were left out",
        "no solution at 4e+03 Pa and 0.1 m/s: interpolated between its neighbours",
    ]  # fmt: skip
    assert made.out_of_range == ("far",)
    whole = _table([cast(Any, "about")], P, V, [columns[1]] * 4, ["k"], "d")
    assert [str(one) for one in whole.notes] == ["about", "a"]
    assert whole.key == made.key != _table([], P, V, [columns[1]] * 4, ["l"], "d").key


@pytest.mark.parametrize(("missing", "bridged"), [
    ([1], True), ([3], True), ([1, 3], True), ([0], False), ([4], False), ([1, 2], False),
    ([2, 3], False),
])  # fmt: skip
def test_holes_are_bridged_one_by_one_and_not_at_an_end(missing, bridged):
    count = np.ones((2, 5), int)
    count[1, missing] = 0
    columns = [column(1.0), column(4.0)]
    if bridged:
        np.testing.assert_array_equal(_holes(count, P, V, columns), count == 0)
        return
    with pytest.raises(Exception, match="no surface converged") as told:
        _holes(count, P, V, columns)
    assert f"at {P[missing[0]]:.4g} Pa and 1 m/s ({len(missing)} such nodes)" in str(told.value)
    assert told.value.history == (0.25, 1.0)


class Finer:
    """Finer waves: a share, a loss and a gap that follow the pressure; nodes to 2e5 Pa."""

    pressure = np.array([1e3, 2e5])

    def real_contact_fraction(self, pressure: Any, speed: float, outside: str) -> Any:
        assert outside == "extend"
        return pressure * speed / 1e6

    def cof_hysteresis(self, pressure: Any, speed: float, outside: str) -> Any:
        return 1e-7 * pressure

    def mean_gap(self, pressure: Any, speed: float, outside: str) -> Any:
        return self.thick - 1e-12 * pressure

    def flow_factor(self, pressure: Any, speed: float, outside: str) -> Any:
        return np.full(pressure.shape, 0.5)

    thick = 1e-6


def contact(pressure: np.ndarray, gap: np.ndarray) -> Any:
    return SimpleNamespace(
        pressure=pressure, gap=gap, real_contact_fraction_corrected=0.125, cof_hysteresis=0.2,
        mean_gap=float(np.where(pressure > 0, 0, gap).mean()),
    )  # fmt: skip


def test_finer_waves_add_their_area_loss_and_gap():
    """Means over the points of contact; what is open stands off by the mean pressure's gap."""
    pressure = np.zeros((4, 4))
    pressure[0] = 1e5, 3e5, 1e5, 3e5
    gap = np.where(pressure > 0, 1e-3, 3e-6)
    part: Any = SimpleNamespace(finer=None, spacing=1e-6, speed=0.5)
    alone = _averages(contact(pressure, gap), contact(pressure, gap), part)
    plain = flow_factors(np.where(pressure > 0, 0, gap), 1e-6)
    assert alone == pytest.approx([0.125, 0.2, 2.25e-6, plain.along, plain.across])
    part.finer = Finer()
    area, loss, mean, along, across = _averages(
        contact(pressure, gap), contact(pressure, gap), part
    )
    assert area == pytest.approx(pressure.mean() * 0.5e-6)
    bearing = np.minimum(pressure, 2e5)
    assert loss == pytest.approx(0.2 + 1e-7 * (bearing**2).sum() / pressure.sum())
    felt = np.where(pressure > 0, pressure, 2e5)
    below = 1e-6 - 1e-12 * felt
    whole = np.where(pressure > 0, 0, gap) + below
    assert mean == pytest.approx(whole.mean())
    left = whole * np.cbrt(1 - 0.5 * (below / whole) ** 2)
    flow = flow_factors(left, 1e-6)
    by = (flow.mean_gap / whole.mean()) ** 3
    assert (along, across) == pytest.approx((by * flow.along, by * flow.across))
    shut = np.full((4, 4), 3e5)
    part.finer.thick = 0.0
    none = _averages(contact(shut, 0 * shut), contact(shut, 0 * shut), part)
    assert none[2:] == [0.0, 0.0, 0.0]
    assert none[0] == pytest.approx(0.15)


def test_nodes_and_surfaces_that_make_no_table():
    assert _nodes("pressure", [1.0, 2.0], 2).tolist() == [1.0, 2.0]
    assert _nodes("speed", 3.0, 1).tolist() == [3.0]
    for bad in ([1.0], [2.0, 1.0], [1.0, 1.0], [0.0, 1.0], [1.0, np.inf], [[1.0, 2.0]]):
        assert "2 or more rising values" in refusal(_nodes, "pressure", bad, 2)
    surface: Any = SimpleNamespace(periodic=True, spacings=(1e-6, 1e-6))
    assert _pairs([surface], None) == [(surface, None)]
    assert _pairs([surface] * 2, [surface] * 2) == [(surface, surface)] * 2
    assert "2 shoe surfaces for 1 floors" in refusal(_pairs, [surface], [surface] * 2)
    assert "no surface" in refusal(_check_surfaces, [])
    other: Any = SimpleNamespace(periodic=False)
    assert "surfaces[1]: the surface is not periodic" in refusal(_check_surfaces, [surface, other])


def test_the_error_of_a_table_is_that_at_the_nodes_that_are_left_out():
    """All quantities are lines in the logarithm of the pressure but one node, off by 0.03."""
    columns = [column(10.0), column(20.0)]
    columns[0]["cof_hysteresis"][3] += 0.03
    made = _table([], P, V, columns, ["k"], "d")
    errors = leave_out_errors(made)
    assert errors["cof_hysteresis"] == pytest.approx(0.03, rel=0.01)
    pressures = np.append(P, 32e3)
    longer = [{k: np.append(c, 2 * c[-1] - c[-2]) if c.size == P.size else c
               for k, c in one.items()} for one in columns]  # fmt: skip
    longer[0]["cof_hysteresis"][[3, 5]] += -0.03, 0.5
    even = leave_out_errors(_table([], pressures, V, longer, ["k"], "d"))
    assert even["cof_hysteresis"] < 0.1  # the last node stays: without it, 0.5 and more
    assert "4 pressure nodes" in refusal(
        leave_out_errors, _table([], P[:4], V, [{k: c[:4] for k, c in columns[0].items()}] * 2,
                                 ["k"], "d")
    )  # fmt: skip
    assert "2 speed nodes" in refusal(leave_out_errors, made, "speed")


def test_a_spectrum_rises_in_steps_of_any_size_from_above_zero():
    waves, density = 0.25 * (1 + np.arange(8.0)), np.full(8, 1e-12)
    found, same = checked_spectrum(waves, density)
    np.testing.assert_array_equal(found, waves)
    np.testing.assert_array_equal(same, density)
    assert "do not rise" in refusal(checked_spectrum, waves - 0.25, density)
    assert "do not rise" in refusal(checked_spectrum, np.maximum(waves, 0.5), density)
    assert "do not fit" in refusal(checked_spectrum, waves[:7], density[:7])
    assert "smallest density" in refusal(checked_spectrum, waves, 0 * density)
    assert "smallest density" in refusal(checked_spectrum, waves, density - 1e-11)
