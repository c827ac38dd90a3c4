"""What the app lists and marks: the newest result first, marks where they are known."""

import asyncio
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.app import work_sole
from underfoot.app.jobs import JobQueue, call_by_name, patiently
from underfoot.app.project import Project
from underfoot.app.trials_plots import tile_svg
from underfoot.app.work_sole import advised_groove
from underfoot.trials.pages.figures import Tile


def test_results_are_listed_from_the_newest_on(tmp_path, monkeypatch):
    project = Project(tmp_path / "project")
    made = {"b": "2026-02-01", "a": "2026-03-01", "c": "2026-01-01", "unread": None}
    for name in made:
        (project.folder / "results" / name).mkdir()

    def summary(self, name):
        return made[name] and SimpleNamespace(name=name, created=made[name])

    monkeypatch.setattr(Project, "summary", summary)
    assert [one.name for one in project.results()] == ["a", "b", "c"]


def test_only_known_places_of_a_curve_are_marked():
    x = np.linspace(0.0, 1.0, 11)
    tile = Tile("one", "accepted", x, x**2, ((0.5, 0.25), (np.nan, 0.3), (0.2, np.nan)))
    sheet = SimpleNamespace(x_range=(0.0, 1.0), y_range=(0.0, 1.0), line=None)
    drawn = tile_svg([tile], cast(Any, sheet))
    assert drawn.count("<circle") == 1
    assert 'cx="80.0" cy="52.5"' in drawn


@pytest.mark.parametrize("side", range(4))
def test_an_advised_groove_lies_where_the_sole_met_the_floor(monkeypatch, side):
    """Land h = 0.1 x + 0.5 y, turned by a: a place x stands at x cos a - h sin a on the floor."""
    lug = {"x": 0.03, "y": 0.012, "groove": 0.008, "groove_side": side}
    data = {f"lug_{name}": np.array([0.0, value]) for name, value in lug.items()}
    step, angle = 1e-3, 0.3
    data["x"] = step * np.arange(5)
    case = SimpleNamespace(
        numerics=SimpleNamespace(grid_spacing=step, quick_grid_spacing=step),
        motion=SimpleNamespace(shoe_angle=angle),
    )
    shape = SimpleNamespace(length=0.1, land_height=lambda x, y: 0.1 * x + 0.5 * y)
    fields = {name: SimpleNamespace(values=values) for name, values in data.items()}
    monkeypatch.setattr(work_sole.Case, "load", lambda _: case)
    monkeypatch.setattr(work_sole.Result, "load", lambda _: SimpleNamespace(data=fields))
    monkeypatch.setattr(work_sole, "sole_shape", lambda _: shape)
    monkeypatch.setattr(work_sole, "grooves_of", lambda _: [])
    ((new,),) = advised_groove("case", "folder", 1, progress=cast(Any, None)).values()
    u, v = ((1, 0), (-1, 0), (0, 1), (0, -1))[side]
    width = 1e-3 * float(new["width"].split()[0])
    middle = 0.5 * (lug["groove"] + step - width / 2)
    stretch = np.cos(angle) - 0.1 * np.sin(angle)
    along = (lug["x"] + u * middle + 0.5 * lug["y"] * np.sin(angle)) / stretch
    long = (lug["groove"] + step + width / 2) / (stretch if u else 1.0)
    found = [1e-3 * float(new[name].split()[0]) for name in ("along", "across", "length")]
    assert found == pytest.approx([along, lug["y"] + v * middle, long], abs=2e-5)
    assert new["angle"] == ("90 deg" if u else "0 deg")


def test_long_jobs_give_way_and_what_a_person_waits_for_does_not(tmp_path):
    async def made():
        jobs = JobQueue(tmp_path)
        return jobs._lane("underfoot.compute")._call, jobs.live._call, jobs.reading._call

    assert asyncio.run(made()) == (patiently, call_by_name, call_by_name)
