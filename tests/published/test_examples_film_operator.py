"""The examples before and after the liquid of ruptured film was followed."""

import json
from pathlib import Path

import pytest

from underfoot import Case, run

ROOT = Path(__file__).parents[2]
EXAMPLES = json.loads((ROOT / "tests/data/examples_film_operator.json").read_text())
"""{example: {scalar: [before, after]}}; SI. After, of soles without channels: with steps in time
that squeeze a plate exactly."""


@pytest.mark.parametrize("name", EXAMPLES)
def test_following_the_liquid_makes_no_load(name):
    """Liquid that is not made at a reformation can't carry: the fluid's load falls or stays."""
    before, after = EXAMPLES[name]["fluid_load"]
    assert after <= before * (1 + 1e-6)
    first, second = EXAMPLES[name]["cof"]
    assert second >= first - 1e-6


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [name for name in EXAMPLES if name.startswith(("work_shoe_untreaded", "human_slip_untreaded"))],
)
def test_soles_without_channels_give_the_stored_values(name):
    """To the solver's tolerance, which one factorization and another share.

    Beside channels the numbers are others since outlines cut cells.
    """
    case = Case.load(ROOT / f"examples/{name}.toml")
    # law, instant, cells and one shoe angle that were the default then
    numerics = {"numerics.cells_along": 1, "numerics.tread_positions": 1}
    result = run(case.replace({"friction": "stribeck", "motion.duration": "0.12 s", **numerics}))
    after = {scalar: pair[1] for scalar, pair in EXAMPLES[name].items()}
    for scalar, (allowed, relative) in {
        "cof": (1e-4, 1e-3),
        "fluid_load": (0.02, 2e-3),
        "fluid_load_sensor": (0.005, 5e-3),
        "peak_fluid_pressure": (50.0, 2e-3),
    }.items():
        assert result.value(scalar) == pytest.approx(after[scalar], rel=relative, abs=allowed)
