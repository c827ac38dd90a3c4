"""What the examples gave before the code was rebuilt, and what the film operator moved since.

``examples_before_rebuild.json`` holds all numbers from before; ``examples_film_operator.json`` what
moved since, beside the number from before (``test_examples_film_operator.py`` computes it).
"""

import json
from pathlib import Path

import pytest

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.slip import slip_risk

ROOT = Path(__file__).parents[2]
BEFORE = json.loads((ROOT / "tests/data/examples_before_rebuild.json").read_text())
FILM = json.loads((ROOT / "tests/data/examples_film_operator.json").read_text())
UNMOVED = ("work_shoe_untreaded_glycerol",)
"""Example of which the stored film numbers are those of the present operator and steps in time."""
APART = {"contact_area": 1e-3}
"""Cells that bear less than 1 Pa no longer count as touching."""


def test_both_tables_begin_with_the_same_numbers():
    assert set(BEFORE) == set(FILM)
    for name, moved in FILM.items():
        for key, (before, _) in moved.items():
            assert before == pytest.approx(BEFORE[name][key], rel=1e-6, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("name", UNMOVED)
def test_an_example_gives_what_it_gave(name):
    case = Case.load(ROOT / "examples" / f"{name}.toml")
    if case.contaminant is not None:  # law, lugs and instant that were the default then
        then = {"friction": "stribeck", "film.lug_edges": False, "motion.duration": "0.12 s"}
        case = case.replace(then)
    squares = {"numerics.tread_positions": 1, "numerics.cells_along": 1}
    scalars = dict(run(case.replace(squares)).scalars)
    risk = slip_risk(scalars["cof"].value)  # at the best estimate, as it was stored
    scalars["slip_probability"] = risk.probability
    assert set(scalars) - {"later_time", "later_cof", "later_fluid_load"} == set(BEFORE[name])
    for key, (_, value) in FILM[name].items():
        wanted = pytest.approx(value, rel=APART.get(key, 1e-5), abs=1e-9)
        assert scalars[key].value == wanted, key
