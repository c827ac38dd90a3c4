"""Steps of a case by their values: what two roughnesses make, what counts as an assumption."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.case import load
from underfoot.case.describe import assumptions
from underfoot.case.explanation import _equation_text, _summary
from underfoot.compute.resolve import resolved
from underfoot.core import InputError

HEEL = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


@pytest.fixture(scope="module")
def heel():
    return load(HEEL)


def test_the_spread_of_two_roughnesses_is_that_of_their_root_sum(heel):
    def part(rq, spread):
        return cast(Any, SimpleNamespace(rq_or_estimate=rq, rq_uncertainty=spread))

    told = heel.interface.rq_deviation(part(3e-6, 0.3e-6), part(4e-6, 0.2e-6))
    drawn = np.random.default_rng(2).normal((3, 4), (0.3, 0.2), (200_000, 2))
    whole = np.hypot(*drawn.T)
    assert told == pytest.approx(whole.std() / whole.mean(), rel=0.01)
    assert heel.interface.rq_deviation(part(5e-6, 0.5e-6), part(0.0, None)) == pytest.approx(0.1)
    assert heel.interface.rq_deviation(part(5e-6, None), part(4e-6, None)) is None


@pytest.mark.parametrize("part", [None, 0.05])
def test_a_measured_coefficient_is_the_sum_of_its_parts(heel, part):
    changes = {"friction.model": "constant", "friction.cof": 0.3}
    case = heel.replace(changes | ({} if part is None else {"friction.hysteresis_cof": part}))
    law: Any = case.friction.build(resolved(case))
    assert law.cof_adhesion + law.cof_hysteresis == pytest.approx(0.3)
    assert law.cof_hysteresis == (part or 0.0)
    with pytest.raises(InputError):
        heel.replace(changes | {"friction.hysteresis_cof": 0.31})


def test_only_what_nobody_measured_or_read_is_an_assumption(heel):
    path = "floor.roughness.rq"

    def told(**marks):
        case = heel.replace({path: {"value": "5 um", "source": "a stylus", **marks}})
        about = [one for one in assumptions(case) if one.about == "floor.roughness"]
        return any("rq = 5 um" in one.what for one in about)

    assert not told()
    assert told(assumed=True)
    assert told(verified=False)


def test_equations_and_summaries_are_said_in_short():
    assert _equation_text([]) == "not in the report"
    assert _equation_text([4, 5]) == "Eq. 4, 5 of the report"

    def told():
        """One two three four five six.

        More.
        """

    assert _summary(told, 80) == "One two three four five six."
    cut = _summary(told, 20)
    assert len(cut) <= 20
    assert cut.endswith(" …")
