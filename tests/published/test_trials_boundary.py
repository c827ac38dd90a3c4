"""Eq. 22-26 against R 4.2.2."""

from dataclasses import replace

import pytest

from underfoot.core import DataError
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study.boundary import alpha_beta, friction_split
from underfoot.trials.study.file_result import FileResult, Number
from underfoot.trials.study.study import study_of

_DRY = [10, 12, 15, 18, 20, 25]
_WET = {
    "water": [4.607, 5.037, 4.789, 5.920, 5.520, 5.326],
    "gly50": [4.023, 4.328, 4.571, 4.527, 5.459, 5.524],
    "oil": [1.613, 0.997, 2.365, 1.928, 1.961, 2.398],
}


def _fit():
    fluid = [name for name in _WET for _ in _DRY]
    return alpha_beta(fluid, _DRY * 3, [v for values in _WET.values() for v in values])


def test_alpha_and_beta():
    fit = _fit()
    assert [row.alpha for row in fit.fluids] == pytest.approx(
        [4.266389868, 3.017264317, 0.803982379], abs=5e-10
    )
    assert [row.beta for row in fit.fluids] == pytest.approx(
        [0.056006608, 0.103284141, 0.064381057], abs=5e-10
    )
    assert [row.alpha_error for row in fit.fluids] == pytest.approx([0.535738295] * 3, abs=5e-10)
    assert [row.beta_error for row in fit.fluids] == pytest.approx([0.030777361] * 3, abs=5e-10)
    assert fit.model.r_squared == pytest.approx(0.96029326, abs=5e-9)
    assert fit.model.adjusted_r_squared == pytest.approx(0.94374879, abs=5e-9)
    assert fit.mean_absolute_residual == pytest.approx(0.2322068, abs=5e-8)


def test_types_two_and_three_differ_for_the_fluid():
    fit = _fit()
    three = fit.type_three
    assert three["fluid"].sum_of_squares == pytest.approx(3.0712, abs=5e-5)
    assert three["fluid"].f == pytest.approx(10.7121, abs=5e-5)
    assert three["fluid"].p == pytest.approx(0.002142, abs=5e-7)
    assert three["dry adhesion"].f == pytest.approx(17.6051, abs=5e-5)
    assert three["dry adhesion"].p == pytest.approx(0.001241, abs=5e-7)
    assert three["fluid:dry adhesion"].f == pytest.approx(0.6719, abs=5e-5)
    assert three["fluid:dry adhesion"].p == pytest.approx(0.528943, abs=5e-7)
    assert fit.type_two["fluid"].sum_of_squares == pytest.approx(38.886, abs=5e-4)
    assert fit.type_two["fluid"].f == pytest.approx(135.63, abs=5e-3)
    assert any("dry adhesion = 0" in text for text in three.warnings)


def test_split_adds_errors_in_squares():
    split = friction_split([10.0, 11.0, 12.0], [4.0, 4.4, 4.2], {"water": [6.0, 6.2, 6.4]})
    assert split.adhesion.value == pytest.approx(11.0 - 4.2)
    assert split.adhesion.uncertainty == pytest.approx((1.0 / 3 + 0.04 / 3) ** 0.5)
    assert split.lubricated_adhesion["water"].value == pytest.approx(2.0)
    assert split.dry.value == pytest.approx(split.adhesion.value + split.hysteresis.value)
    single = friction_split([10.0], [4.0])
    assert single.adhesion.uncertainty is None
    assert friction_split([3.0, 3.1], [4.0, 4.1]).adhesion.flags


def test_one_dry_adhesion_has_no_slope():
    with pytest.raises(DataError, match="no slope"):
        alpha_beta(["a", "a", "b", "b", "b"], [1, 1, 1, 2, 3], [1, 2, 3, 4, 5])


def test_a_study_of_boundary_lubrication_has_a_table_of_parts_and_one_of_fluids():
    """Each fluid leaves what its friction is beyond that of the oil, of both shoes."""
    forces = {
        "x": {"dry": 10.0, "sae_75w140": 4.0, "water": 7.0, "brine": 5.0},
        "y": {"dry": 6.0, "sae_75w140": 2.0, "water": 4.0, "brine": 3.0},
        "z": {"dry": 9.0, "sae_75w140": 1.0, "water": 2.5, "brine": 3.0},
    }
    files = [
        FileResult(
            f"{shoe} {fluid} {turn}",
            numbers=(Number("friction_force", force + turn, main="friction_force"),),
            conditions={"shoe": shoe, "floor": "tile", "fluid": fluid},
        )
        for shoe, by_fluid in forces.items()
        for fluid, force in by_fluid.items()
        for turn in (-0.1, 0.1)
    ]
    incomplete = replace(files[0], conditions={**files[0].conditions, "floor": "wood"})
    made = study_of([*files, incomplete], protocol("report_g3"))
    tables = {table.name: table for table in made.tables}
    assert {"friction_split", "alpha_beta", "fluid_range"} <= {*tables}
    assert all(table.title and table.title != name for name, table in tables.items())
    parts = {(row[0], row[2]): (row[3], row[5]) for row in tables["friction_split"].rows}
    fitted = [(row[0], row[-1]) for row in tables["alpha_beta"].rows]
    assert sorted(fitted) == [("brine", 3), ("water", 3)]
    for shoe, by_fluid in forces.items():
        oiled = by_fluid["sae_75w140"]
        assert parts[shoe, "dry"] == (pytest.approx(by_fluid["dry"]), 2)
        assert parts[shoe, "hysteresis"] == (pytest.approx(oiled), 2)
        assert parts[shoe, "adhesion"][0] == pytest.approx(by_fluid["dry"] - oiled)
        for fluid in ("water", "brine"):
            left = parts[shoe, f"adhesion with {fluid}"][0]
            assert left == pytest.approx(by_fluid[fluid] - oiled)
    ranges = {row[0]: row[1:] for row in tables["fluid_range"].rows}
    assert ranges["x"] == (pytest.approx(1), "brine", pytest.approx(3), "water", pytest.approx(2))
    assert ranges["y"] == (pytest.approx(1), "brine", pytest.approx(2), "water", pytest.approx(1))
    assert ranges["z"][1::2] == ("water", "brine")
    assert any("x on wood" in note for note in made.notes)
