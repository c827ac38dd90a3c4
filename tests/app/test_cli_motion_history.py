"""A case that follows a history of motion, and one with an array of sensors, as files."""

import csv

import pytest

from commands import called, process

CASE = """\
file_version = 1
contaminant = "glycerol_90pct"
[shoe]
from = "work_shoe_untreaded"
[floor]
from = "vinyl_g4"
[motion]
{motion}
[numerics]
quick_grid_spacing = "2 mm"
{rest}
"""
TABLE = """\
time (ms),normal force (N),speed (m/s),shoe angle (deg)
0,10,0.4,12
20,300,0.3,10
60,450,0.2,6
"""


@pytest.mark.slow
def test_history_and_array_from_files(tmp_path):
    (tmp_path / "gait.csv").write_text(TABLE)
    array = """[sensor]
rows = 3
columns = 3
array_spacing = "30 mm"
array_inlet_diameter = "4 mm"
"""
    text = CASE.format(motion='history = "gait.csv"', rest=array)
    (tmp_path / "case.toml").write_text(text)
    done = process("run", "case.toml", "--quick", "--out", "out", folder=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    import xarray

    with xarray.open_dataset(tmp_path / "out" / "result.nc") as fields:
        time = fields.time.values
        assert time[-1] == pytest.approx(0.06)
        assert fields.load_history.values[-1] == pytest.approx(450)
        assert fields.shoe_angle_history.values[-1] == pytest.approx(0.10472, rel=1e-3)
        assert (fields.cof_history.values > 0).all()
        parts = sum(
            fields[f"cof_{part}_history"].values for part in ("adhesion", "hysteresis", "viscous")
        )
        assert parts == pytest.approx(fields.cof_history.values, rel=1e-6, nan_ok=True)
        assert fields.array_pressure.shape[1:] == (3, 3)
    with (tmp_path / "out" / "summary.csv").open(encoding="utf-8-sig") as stream:
        names = {row[0] for row in csv.reader(line for line in stream if not line.startswith("#"))}
    assert {"array_peak", "array_peak_row_1", "array_duration"} <= names


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("time,normal force,speed\n0,10,0.3\n", "2 or more"),
        ("time,normal force,speed\n0,10,0.3\n0,20,0.3\n", "rise"),
        ("time,normal force,speed\n0,10,0.3\n0.1,0,0.3\n", "history ends with 0 N"),
        ("time,normal force\n0,10\n0.1,20\n", "speed"),
        ("time (kg),normal force,speed\n0,10,0.3\n0.1,20,0.3\n", "time"),
    ],
)
def test_a_history_that_cannot_be_is_refused(tmp_path, table, said):
    (tmp_path / "gait.csv").write_text(table)
    text = CASE.format(motion='history = "gait.csv"\nshoe_angle = "8 deg"', rest="")
    (tmp_path / "case.toml").write_text(text)
    done = called("check", "case.toml", folder=tmp_path)
    assert done.returncode == 2
    assert said in done.stderr


def test_points_in_the_case_are_the_same_case(tmp_path):
    from underfoot.case import Case

    (tmp_path / "gait.csv").write_text(TABLE)
    (tmp_path / "one.toml").write_text(CASE.format(motion='history = "gait.csv"', rest=""))
    points = [
        '{time = "0 s", normal_force = "10 N", speed = "0.4 m/s", shoe_angle = "12 deg"}',
        '{time = "20 ms", normal_force = "300 N", speed = "0.3 m/s", shoe_angle = "10 deg"}',
        '{time = "60 ms", normal_force = "450 N", speed = "0.2 m/s", shoe_angle = "6 deg"}',
    ]
    inline = f"history_points = [{', '.join(points)}]"
    (tmp_path / "two.toml").write_text(CASE.format(motion=inline, rest=""))
    one, two = (Case.load(tmp_path / f"{name}.toml") for name in ("one", "two"))
    assert one.motion.normal_force == two.motion.normal_force == 450
    assert one.motion.duration == pytest.approx(0.06)
    assert [p.speed for p in one.motion.history_points] == [0.4, 0.3, 0.2]
    assert [p.shoe_angle for p in one.motion.history_points] == pytest.approx(
        [p.shoe_angle for p in two.motion.history_points]
    )


def test_check_says_the_memory_and_a_fine_grid_is_refused(tmp_path):
    text = CASE.format(motion='from = "slip_tester_g4"', rest="").replace(
        "quick_grid", 'grid_spacing = "0.05 mm"\nquick_grid'
    )
    (tmp_path / "case.toml").write_text(text)
    checked = called("check", "case.toml", folder=tmp_path)
    assert "MB" in checked.stdout
    assert "A run would be refused: numerics.most_memory" in " ".join(checked.stdout.split())
    done = called("run", "case.toml", "--out", "out", folder=tmp_path)
    assert done.returncode == 2
    assert "most_memory" in done.stderr
    assert "Traceback" not in done.stderr
