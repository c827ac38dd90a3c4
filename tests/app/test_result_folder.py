"""What a run leaves behind: files another program can read, a page that opens offline."""

import csv
import json
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray

from underfoot.compute.result import Result
from underfoot.core import DataError, InputError, Status, to_si
from underfoot.questions.comparison import compare
from underfoot.report import write_report

REQUIRED = (
    "cof cof_adhesion cof_hysteresis cof_viscous normal_force fluid_load fluid_load_sensor "
    "peak_fluid_pressure peak_fluid_pressure_sensor contact_area minimum_film_thickness "
    "slip_probability status"
).split()


@pytest.fixture(scope="module")
def folder(worn_shoe_result, tmp_path_factory):
    written = write_report(worn_shoe_result, tmp_path_factory.mktemp("run") / "out", maps=True)
    assert written.failures == ()
    return written.folder


def test_json_gives_each_number_its_unit_spread_and_marks(folder):
    stored = json.loads((folder / "result.json").read_text())
    for name in REQUIRED:
        entry = stored[name]
        assert {"value", "unit", "uncertainty", "assumed"} <= set(entry), name
        if entry["uncertainty"] is None and name != "status":
            assert entry["reason"], name


def test_the_parts_of_the_cof_and_of_the_load_add_up(worn_shoe_result):
    value = worn_shoe_result.value
    parts = value("cof_adhesion") + value("cof_hysteresis") + value("cof_viscous")
    assert parts == pytest.approx(value("cof"), rel=1e-12)
    fields = worn_shoe_result.fields
    area = float(np.diff(fields.x[:2])[0]) ** 2
    stands_for, of_film = fields.cell_area, fields.cell_film_area
    load = float((fields.contact_pressure * stands_for + fields.fluid_pressure * of_film).sum())
    load *= area
    assert load == pytest.approx(value("normal_force"), rel=1e-3)
    friction = float((fields.shear_stress * stands_for).sum())
    assert friction * area / load == pytest.approx(float(fields.position_cof[0]), rel=1e-6)


def test_netcdf_is_labelled_with_units(folder):
    with xarray.open_dataset(folder / "result.nc", engine="h5netcdf") as fields:
        assert fields.attrs["Conventions"].startswith("CF-")
        for name, variable in fields.variables.items():
            assert variable.attrs.get("units"), name
        assert fields.contact_pressure.dims == ("x", "y")


def test_csv_holds_every_scalar(folder, worn_shoe_result):
    with (folder / "summary.csv").open() as stream:
        rows = {row["quantity"]: row for row in csv.DictReader(stream)}
    assert set(worn_shoe_result.scalars) <= set(rows)
    assert float(rows["cof"]["value"]) == worn_shoe_result.value("cof")


def test_a_folder_reads_back_as_the_same_result(folder, worn_shoe_result):
    again = Result.load(folder)
    assert again.scalars == worn_shoe_result.scalars
    assert again.provenance == worn_shoe_result.provenance
    assert again.status == worn_shoe_result.status
    xarray.testing.assert_identical(again.fields.drop_attrs(), worn_shoe_result.fields.drop_attrs())


def test_a_damaged_folder_is_a_data_error(folder, tmp_path):
    with pytest.raises(DataError, match="can't be read as a result"):
        Result.load(tmp_path)
    (tmp_path / "result.json").write_text("{")
    (tmp_path / "case.toml").write_text("")
    (tmp_path / "result.nc").write_bytes((folder / "result.nc").read_bytes())
    with pytest.raises(DataError, match="can't be read as a result"):
        Result.load(tmp_path)


def test_the_page_is_self_contained(folder):
    page = (folder / "report.html").read_text()
    outside = re.findall(r"""(?:src|href)=["'](?!data:|#)([^"']+)""", page)
    assert outside == []
    assert len(page.encode()) < 3e6
    # one map for each quantity; the load over time is drawn by the page
    assert page.count("data:image/png;base64,") == 5
    drawn = re.sub("<script.*?</script>", "", page, flags=re.DOTALL)
    assert drawn.count("<polyline") == 2


@pytest.mark.parametrize("name", ["contact_pressure", "fluid_pressure", "film_thickness", "maps"])
def test_maps_are_pictures_with_something_on_them(folder, name):
    from matplotlib.image import imread

    picture = imread(folder / f"{name}.png")
    assert min(picture.shape[:2]) > 400
    colours = np.rint(picture * 255).astype(int) @ 256 ** np.arange(picture.shape[2])
    assert len(np.unique(colours)) > 30


def test_an_unconverged_result_gives_no_number(worn_shoe_result):
    failed = replace(worn_shoe_result, status=Status.NOT_CONVERGED)
    assert "No result" in failed.headline()[0]
    assert "No comparison" in compare(worn_shoe_result, failed).headline()[0]
    with pytest.raises(DataError, match="not converged"):
        failed.value("cof")


def test_the_summary_reads_in_units_people_use(worn_shoe_result):
    rows = {label.strip(): value for label, value, _ in worn_shoe_result.table().rows}
    assert "%" in rows["Slip probability"]
    assert rows["Peak fluid pressure"].endswith("kPa")
    assert "µm" in rows["Thinnest film"]
    assert "um" not in rows["Thinnest film"].replace("µm", "")


def test_a_result_compared_with_itself_has_no_order(worn_shoe_result):
    assert "cases are the same" in compare(worn_shoe_result, worn_shoe_result).headline()[0]


def test_saving_refuses_a_folder_that_holds_something(worn_shoe_result, tmp_path):
    (tmp_path / "mine.txt").write_text("keep")
    with pytest.raises(InputError, match="not empty"):
        worn_shoe_result.save(tmp_path)
    assert (tmp_path / "mine.txt").read_text() == "keep"


def test_saved_case_runs_to_the_same_case(worn_shoe_result, worn_shoe_case):
    from underfoot.case import Case

    assert Case.from_text(worn_shoe_result.case_text) == worn_shoe_case
    assert to_si("2 mm", "m", where="") == worn_shoe_case.numerics.grid_spacing
