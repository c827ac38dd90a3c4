"""Where the film of a flat heel enters is said where nothing resolves it, and nowhere else."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute import read

CASE = Case(shoe="work_shoe_untreaded", floor="vinyl_g4", contaminant="glycerol_90pct",
            motion={"from": "slip_tester_g4"})  # fmt: skip


@pytest.mark.parametrize(
    ("cells", "depth", "said"),
    [(None, 0.0, True), ("rows", 0.0, False), (None, 3e-3, False), ("rows", 3e-3, False)],
)
def test_where_the_film_enters_is_said_of_square_cells_without_tread(
    monkeypatch, cells, depth, said
):
    monkeypatch.setattr(read, "peak_pressure", lambda *_, **__: SimpleNamespace(remark=""))
    monkeypatch.setattr(read, "blind_sensor", lambda *_: "")
    sole = SimpleNamespace(slits=None, cells=cells, tread_depth=np.array([[0.0, depth]]))
    parts = SimpleNamespace(case=CASE, sole=sole, objects={}, law=None)
    contact = SimpleNamespace(total_pressure=None, cell_load=None)
    solution = SimpleNamespace(contact=contact, friction=SimpleNamespace(lugs=None), sensor=None)
    found = read._remarks(cast(Any, parts), cast(Any, solution), {})
    assert ("film_inlet" in found) == said
