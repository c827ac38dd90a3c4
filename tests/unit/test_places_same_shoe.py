"""A shoe that is listed twice is one shoe: its chance to be best is not halved in the answer."""

from types import SimpleNamespace
from typing import Any

import pytest

from underfoot.core import SourcedValue
from underfoot.places.choice import ShoeAnswer, ShoeChoice


def choice(*shoes: tuple[str, str, float]) -> ShoeChoice:
    """Return the answer for shoes (name, what it is, chance of being best)."""
    answers = []
    for name, kind, best in shoes:
        shoe: Any = SimpleNamespace(
            name=name, section=kind, wear_depth=0.0, worn_region="", known_class=None, readings=()
        )
        slips = SourcedValue(0.1, "1", interval=(0.05, 0.2))
        answers.append(ShoeAnswer(shoe, slips, best, "", ""))
    place: Any = SimpleNamespace(name="hall", floors=(), wet_steps=10.0)
    return ShoeChoice(place, tuple(answers), (), (), (), (), answers[0].shoe.name, 500.0)


@pytest.mark.parametrize("turn", [1, -1])
def test_a_shoe_that_is_best_is_so_under_two_names(turn):
    once = choice(*[("A", "plain", 0.1), ("B", "treaded", 0.9)][::turn])
    twice = choice(
        *[("A", "plain", 0.1), ("B", "treaded", 0.45), ("B again", "treaded", 0.45)][::turn]
    )
    assert once.headline()[0].startswith("B is best with a chance of 90 %")
    assert "is best with a chance of 90 %" in twice.headline()[0]
    assert twice.first.shoe.section == "treaded"


def test_the_worse_of_two_is_not_ahead_for_the_other_is_listed_thrice():
    told = choice(("A", "plain", 0.4), *[(f"B{n}", "treaded", 0.2) for n in range(3)])
    assert told.headline()[0].startswith("Which of the 2 shoes is best can't be told: B0 is ahead")
    assert "60 %" in told.headline()[0]


def test_of_one_shoe_under_two_names_none_is_the_best():
    told = choice(("A", "plain", 0.5), ("A again", "plain", 0.5))
    assert "can't be told: all are the same" in told.headline()[0]
