"""Units of what a laboratory noted: those that numbers hang on are given, and of the right kind."""

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.conditions import conditions_of


def noted(folder, head, *cells):
    """Return the column of a table of conditions, by file."""
    rows = "".join(f"{n}.csv;{cell}\n" for n, cell in enumerate(cells))
    (folder / "conditions.csv").write_text(f"file;{head}\n{rows}", encoding="utf-8")
    (name,) = {key for row in conditions_of(folder).values() for key in row}
    return [row.get(name) for row in conditions_of(folder).values()]


@pytest.mark.parametrize("name", ["viscosity", "thickness", "area"])
@pytest.mark.parametrize("cells", [("6", "219"), ("6", "6", "219", "219")])
def test_a_number_without_a_unit_is_asked_where_it_is_computed_with(tmp_path, name, cells):
    """6 stood for 6 Pa s, and for a level "6" where it repeats; 5.5 for 5.5 m."""
    with pytest.raises(InputError, match=rf"{name} has no unit. Write .* heading: {name} \("):
        noted(tmp_path, name, *cells)


@pytest.mark.parametrize(
    ("head", "cell"),
    [
        ("area (mm)", "161"),  # was 0.161 m^2: a modulus a thousand times too small
        ("thickness (mm^2)", "5.5"),
        ("viscosity (mm)", "6"),
        ("speed (rpm)", "300"),  # was 31.4 m/s
        ("mass (cm)", "1700"),
        ("height (kg)", "1.7"),
        ("rcof (N)", "0.2"),
    ],
)
def test_a_unit_of_something_else_is_refused(tmp_path, head, cell):
    with pytest.raises(InputError, match=r'column .*: is in "'):
        noted(tmp_path, head, cell)


@pytest.mark.parametrize(
    ("head", "cells", "values"),
    [
        ("area (mm²)", ("161",), [161e-6]),
        ("area (cm2)", ("1.61",), [161e-6]),
        ("viscosity (mPa·s)", ("6",), [6e-3]),
        ("viscosity", ("6 cP", "", "0.219 Pa*s"), [6e-3, None, 0.219]),
        ("speed", ("300 mm/s", "0.5 m/s"), [0.3, 0.5]),
        ("speed (km/h)", ("3.6",), [1.0]),
        ("speed", ("0.3",), [0.3]),
        ("speed", ("slow", "300 mm/s"), ["slow", "300 mm/s"]),
        ("viscosity", ("low", "high"), ["low", "high"]),
        ("mass (lb)", ("150",), [68.04]),
        ("mass (g)", ("70000",), [70.0]),
        ("mass", ("70",), [70.0]),
        ("acof (%)", ("15",), [0.15]),
        ("acof", ("0.15",), [0.15]),
    ],
)
def test_units_of_the_right_kind_are_read(tmp_path, head, cells, values):
    found = noted(tmp_path, head, *cells)
    numbers = [one for one in values if isinstance(one, float)]
    assert [one for one in found if isinstance(one, float)] == pytest.approx(numbers, rel=1e-4)
    assert [one for one in found if not isinstance(one, float)] == [
        one for one in values if not isinstance(one, float)
    ]


def pin(folder, speed):
    """Write a log of 20 s at 0.3 m/s and a COF of 0.2, with the speed that is noted."""
    t = np.arange(0, 20, 0.01)
    noise = np.random.default_rng(1).standard_normal((2, t.size))
    rows = np.column_stack([t, 21 + 0.05 * noise[0], 4.2 + 0.05 * noise[1], np.full(t.size, 0.3)])
    head = "time (s),normal force (N),friction force (N),sliding speed (m/s)"
    np.savetxt(folder / "a.csv", rows, fmt="%.6g", delimiter=",", header=head, comments="")
    (folder / "conditions.csv").write_text(f"file,fluid,speed (m/s)\na.csv,water,{speed}\n")
    (file,) = analyse_folder(folder, protocol("report_g2"), processes=1).files
    return file


@pytest.mark.parametrize(("speed", "told"), [("0.3", False), ("0.31", False), ("0.5", True)])
def test_a_speed_that_the_log_contradicts_is_a_caution(tmp_path, speed, told):
    """Two conditions exchanged gave each COF the other's speed without a word."""
    file = pin(tmp_path, speed)
    assert file.main["speed"] == float(speed)
    assert file.main["cof"] == pytest.approx(0.2, abs=0.001)
    assert any("0.3 m/s in the log" in str(each) for each in file.reasons) is told
    assert file.verdict == ("caution" if told else "accepted")
