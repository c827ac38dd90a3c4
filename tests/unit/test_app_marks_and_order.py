"""What the app lists and marks: the newest result first, marks where they are known."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from underfoot.app.project import Project
from underfoot.app.trials_plots import tile_svg
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
