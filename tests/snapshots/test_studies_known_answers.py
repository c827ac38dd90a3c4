"""Checks of ``validate`` against answers written out here, and the cases that they stand for."""

import math

import pytest

from snapshot import held
from underfoot.case import Case
from underfoot.studies import validation
from underfoot.studies.corpus_cases import contrasts
from underfoot.studies.sources import read_source
from underfoot.studies.validation import Check


def test_a_sinusoid_that_slides_rubs_by_what_its_rubber_loses(file_regression):
    """q^2 a^2 Im E* / (4 p (1 - nu^2)) with E* of the two terms at the frequency q v."""
    q, amplitude, pressure = 2 * math.pi / 0.4e-3, 2e-6, 3e5
    frequency = q * 0.1
    loss = sum(
        modulus * frequency * time / (1 + (frequency * time) ** 2)
        for modulus, time in ((0.8e6, 1e-3), (0.6e6, 1e-4))
    )
    exact = (q * amplitude) ** 2 * loss / 0.75 / (4 * pressure)
    found = validation.sliding_sinusoid()
    assert found.exact == pytest.approx(exact, rel=1e-9)
    assert found.computed == pytest.approx(exact, rel=1e-9)
    assert found.passed
    held(file_regression, found)


def test_a_sinusoid_pressed_by_three_tenths_of_what_closes_it(file_regression):
    """Westergaard 1939: sin^2 of half the width is the share of the full pressure."""
    found = validation.westergaard()
    exact = 2 / math.pi * math.asin(math.sqrt(0.3))
    assert found.exact == pytest.approx(exact)
    assert found.computed == pytest.approx(exact, rel=found.tolerance)
    held(file_regression, found)


@pytest.mark.parametrize(("computed", "error", "passes"), [
    (10.0, 0.0, True), (10.4, 0.04, True), (9.6, 0.04, True), (10.5, 0.05, True),
    (10.6, 0.06, False), (9.4, 0.06, False), (-10.0, 2.0, False),
])  # fmt: skip
@pytest.mark.parametrize("sign", [1, -1])
def test_a_check_passes_up_to_its_tolerance(computed, error, passes, sign):
    check = Check("a", sign * computed, sign * 10.0, 0.05, "")
    assert check.relative_error == pytest.approx(error)
    assert check.passed == passes


EFFECTS = """reference = "a report"
read = "whole"
conditions = { viscosity = "1 cP", sole_rq = "5 um", floor_rq = "3 um", shore_a = 60 }
[[condition]]
id = "thin"
device = "block"
fluid = "water"
speed = "0.3 m/s"
shore_a = { range = [60, 70], note = "not printed" }
measured = { kind = "value", cof = 0.3, sd = 0.03 }
[[condition]]
id = "thick"
device = "whole shoe"
fluid = "oil"
members = [{ speed = "0.3 m/s" }, { speed = "0.5 m/s" }]
measured = { kind = "value", cof = 0.1, sd = 0.03 }
[[effect]]
id = "order"
kind = "order"
conditions = { device = "whole shoe", fluid = "water" }
sequence = [{ wear = "new" }, { wear = "slight", change = "up" },
            { wear = "through", change = "down" }]
[[effect]]
id = "slope"
kind = "slope"
per = "tread.depth"
over = ["2 mm", "4.5 mm"]
low = 0.01
high = 0.02
conditions = { device = "whole shoe", tread = { pattern = "grooves" } }
fluids = ["water", "oil"]
extremes_of = 3
[[effect]]
id = "falls"
kind = "slope"
per = "tread.lug_width"
over = ["4 mm", "5 mm"]
low = -0.02
high = -0.01
conditions = { device = "block", fluid = "detergent" }
[[effect]]
id = "ratio"
kind = "ratio"
ratio = 1.25
numerator = "thin"
denominator = "thick"
[[effect]]
id = "range"
kind = "ratio"
low = 0.5
high = 1.5
numerator_conditions = { sole_ra = "8 um" }
denominator_conditions = { sole_ra = "4 um" }
conditions = { device = "walking", walking = "forwards", fluid = "water" }
[[effect]]
id = "same"
kind = "ratio"
ratio = 1.0
numerator_conditions = { fluid = "dry", shoe_angle = "3 deg" }
denominator_conditions = { fluid = "water", shoe_angle = "7 deg" }
conditions = { device = "whole shoe" }
[[effect]]
id = "sign"
kind = "sign"
higher = { device = "block", fluid = "dry", tread = { direction = "along", pattern = "grooves" } }
lower = { device = "block", fluid = "water", tread = { direction = "across", pattern = "grooves" } }
[[effect]]
id = "nothing alike"
kind = "sign"
higher = { device = "sled", load = "100 N" }
lower = { device = "sled", load = "200 N" }
"""


def test_effects_of_every_kind(file_regression, tmp_path):
    """Each with its sides, once for each fluid and step of an order."""
    path = tmp_path / "made_up.toml"
    path.write_text(EFFECTS, encoding="utf-8")
    source = read_source(path)
    made = contrasts(source)
    assert [(one.effect, one.fluid, one.rises) for one in made[:5]] == [
        ("order: slight", "water", True), ("order: through", "water", False),
        ("slope", "water", True), ("slope", "oil", True), ("falls", "detergent", False),
    ]  # fmt: skip
    assert [one.step for one in made[2:5]] == pytest.approx([2.5, 2.5, 1.0])
    said = {}
    for number, one in enumerate(made):
        sides = [
            [side.reason, ", ".join(side.taken), side.contact_time, *map(told, side.cases)]
            for side in (one.over, one.under)
        ]
        numbers = one.rises, one.low, one.high, one.step, one.extremes_of
        said[f"{number} {one.effect} {one.fluid}"] = [
            one.topic, one.published, one.reason, numbers, *sides
        ]  # fmt: skip
    held(file_regression, said)


def told(case: Case) -> str:
    """Return what a case was given, in a line."""
    return " ".join(line for line in case.to_toml().split("\n")[2:] if line[:1] not in ("", "#"))
