"""A sole with its load for Abaqus and CalculiX: read back, and solved where CalculiX is."""

import re
import shutil
import subprocess

import numpy as np
import pytest

from underfoot.compute.prepare import prepare_case
from underfoot.compute.result import Result
from underfoot.core import DataError
from underfoot.report.quantities import AREAS, raw, spacing
from underfoot.report.solver_input import write_solver_input

pytest.importorskip("netgen")


@pytest.fixture(scope="module")
def deck(worn_shoe_result, tmp_path_factory):
    path = tmp_path_factory.mktemp("deck") / "sole.inp"
    written = write_solver_input(worn_shoe_result, path)
    assert written.length_unit == "mm"
    return path


def block(path, keyword):
    """Return the rows of numbers below a keyword."""
    _, _, below = path.read_text(encoding="utf-8").partition(keyword + "\n")
    rows = [line.split(",") for line in below.partition("*")[0].splitlines()]
    return [[float(one) for one in row] for row in rows]


def forces_of(path):
    """Return the numbers of nodes and their forces, N."""
    rows = np.array(block(path, "*CLOAD"))
    assert set(rows[:, 1]) == {3}
    return rows[:, 0].astype(int) - 1, rows[:, 2]


def test_load_and_centre_of_pressure_are_those_of_the_run(deck, worn_shoe_result):
    data, side = worn_shoe_result.data, spacing(worn_shoe_result.data)
    load = sum(raw(data, name) * raw(data, area) for name, area in AREAS.items()) * side**2
    points = np.array(block(deck, "*NODE, NSET=ALL"))[:, 1:]
    nodes, force = forces_of(deck)
    assert force.sum() == pytest.approx(worn_shoe_result.value("normal_force"), rel=1e-3)
    assert force.sum() == pytest.approx(load.sum(), rel=1e-8)
    along, across = data["x"].values, data["y"].values
    centre = [(load.sum(axis=1) @ along) / load.sum(), (load.sum(axis=0) @ across) / load.sum()]
    # cells beside the triangles move their load by half a cell at most
    assert force @ points[nodes, :2] / force.sum() == pytest.approx(
        np.multiply(centre, 1e3), abs=0.1
    )


def test_prisms_fill_the_sole_and_middles_lie_in_the_middle(deck, worn_shoe_result):
    points = np.array(block(deck, "*NODE, NSET=ALL"))[:, 1:]
    prisms = np.array(block(deck, "*ELEMENT, TYPE=C3D15, ELSET=OUTSOLE"), int)[:, 1:] - 1
    assert prisms.shape[1] == 15
    corners = points[prisms[:, :6]]
    low, high = corners[:, :3], corners[:, 3:]
    plane = np.cross(low[:, 1] - low[:, 0], low[:, 2] - low[:, 0]) / 2
    assert (np.einsum("ij,ij->i", plane, high.mean(axis=1) - low.mean(axis=1)) > 0).all()
    for middle, (one, two) in {6: (0, 1), 11: (5, 3), 12: (0, 3)}.items():
        half = (points[prisms[:, one]] + points[prisms[:, two]]) / 2
        np.testing.assert_allclose(points[prisms[:, middle]], half, atol=1e-6)
    held = np.concatenate([np.array(row, int) - 1 for row in block(deck, "*NSET, NSET=FOOT")])
    nodes, _ = forces_of(deck)
    assert not np.isin(nodes, held).any()
    assert points[held, 2].min() > points[nodes, 2].max()


# a check by the program itself, which desks and CI seldom have; the numbers are held above
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_presses_the_sole_as_the_run_does(deck, worn_shoe_result, worn_shoe_case):
    subprocess.run(
        ["ccx", deck.stem], cwd=deck.parent, check=True, capture_output=True, timeout=300
    )
    told = deck.with_suffix(".dat").read_text(encoding="utf-8")
    total = [float(one) for one in re.findall(r"-?\d\.\d+E[+-]\d+", told)][-3:]
    nodes, force = forces_of(deck)
    assert total == pytest.approx([0, 0, -force.sum()], abs=1e-3)
    rows = re.findall(r"^ -1\s*(\d+)(.{12})(.{12})(.{12})$",
                      deck.with_suffix(".frd").read_text(encoding="utf-8")
                      .partition("DISP")[2].partition(" -3")[0], re.M)  # fmt: skip
    rise = np.zeros(max(int(row[0]) for row in rows))
    for number, *_, up in rows:
        rise[int(number) - 1] = 1e-3 * float(up)
    work = float(force @ rise[nodes])
    data, side = worn_shoe_result.data, spacing(worn_shoe_result.data)
    pressure = sum(raw(data, name) * raw(data, area) for name, area in AREAS.items())
    parts = prepare_case(worn_shoe_case, side)
    ours = float((parts.compliance.apply(pressure) * pressure).sum() * side**2)
    assert work == pytest.approx(ours, rel=0.1)


def test_a_result_without_pressures_is_refused(worn_shoe_result, tmp_path):
    worn_shoe_result.save(tmp_path / "run")
    for name in ("result.nc", "fields.nc"):
        (tmp_path / "run" / name).unlink(missing_ok=True)
    with pytest.raises(DataError, match="no pressures"):
        write_solver_input(Result.load(tmp_path / "run"), tmp_path / "a.inp")
