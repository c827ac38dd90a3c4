"""Numbers of a result as numbers: by name, as a frame, from a file's name; frozen sections."""

import math

import numpy as np
import pytest

import underfoot as uf
from underfoot.core import DataError, InputError, SourcedValue


def test_a_frame_holds_numbers_with_unit_interval_and_source(worn_shoe_result):
    result, frame = worn_shoe_result, worn_shoe_result.to_frame()
    assert list(frame.columns) == "value unit uncertainty low high assumed source note".split()
    assert list(frame.index) == list(result.scalars)
    assert frame.dtypes[["value", "uncertainty", "low", "high"]].eq(np.float64).all()
    cof = frame.loc["cof"]
    assert cof.value == result.value("cof")
    assert cof.unit == "1"
    assert cof.low < cof.value < cof.high
    assert cof.low == result["cof"].interval[0]
    assert frame.loc["fluid_load", "unit"] == "N"
    assert frame.loc["fluid_load", "low"] < result.value("fluid_load")
    assert math.isnan(frame.loc["contact_area", "uncertainty"])
    parts = frame.loc[["cof_adhesion", "cof_hysteresis", "cof_viscous"], "value"]
    assert parts.sum() == pytest.approx(cof.value)


def test_a_scalar_by_its_name_or_the_nearest_one(worn_shoe_result):
    result = worn_shoe_result
    assert isinstance(result["cof"], SourcedValue)
    assert float(result["cof"]) == result.value("cof")
    for ask in (result.value, result.__getitem__):
        with pytest.raises(InputError, match=r'unknown quantity "coff".*cof'):
            ask("coff")
    with pytest.raises(DataError, match="was not determined: dry"):
        float(SourcedValue(None, reason="dry"))
    assert str(result) == result.summary()
    assert "0.0" in str(result)


@pytest.mark.slow
def test_a_run_of_a_file(worn_shoe_case, tmp_path):
    case = worn_shoe_case.replace({"numerics.tread_positions": 1, "numerics.cells_along": 1})
    case.save(tmp_path / "case.toml")
    for file in (tmp_path / "case.toml", str(tmp_path / "case.toml")):
        result = uf.run(file, quick=True)
        assert result.provenance.case_hash == case.hash


def test_folders_of_older_and_newer_versions_are_read(worn_shoe_result, tmp_path):
    import json

    result = worn_shoe_result
    for change, folder in (("older", tmp_path / "old"), ("newer", tmp_path / "new")):
        result.save(folder)
        stored = json.loads((folder / "result.json").read_text())
        if change == "older":
            for key in ("result_hash", "threads", "objects", "errata"):
                del stored["provenance"][key]
            del stored["cof"]["interval"]
        else:
            stored["provenance"]["machine"] = "a newer key"
            stored["cof"]["bias"] = 0.1
            stored["calibration"] = {"laboratory": "x"}
        (folder / "result.json").write_text(json.dumps(stored))
        again = type(result).load(folder)
        assert again.value("cof") == result.value("cof")
        assert list(again.scalars) == list(result.scalars)
        assert again.provenance.case_hash == result.provenance.case_hash
    (folder / "result.json").write_text(json.dumps(stored | {"format": 99}))
    with pytest.raises(DataError, match="newer version"):
        type(result).load(folder)


def test_a_frozen_section_says_what_to_do(worn_shoe_case):
    for section, name in (
        (worn_shoe_case.motion, "speed"),
        (worn_shoe_case.shoe.material, "shore_a"),
    ):
        with pytest.raises(
            InputError, match=rf'frozen: {name} can\'t be set.*case\.replace\("'
        ) as told:
            setattr(section, name, 0.3)
        assert "pydantic" not in str(told.value)
    with pytest.raises(InputError, match="frozen"):
        del worn_shoe_case.motion.speed
