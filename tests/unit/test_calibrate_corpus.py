"""The corpus of published measurements: what is read, and what is refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.studies.sources import KINDS, NUMBERS, Span, corpus, read_source, sampled_numbers

GOOD = """
reference = "Someone 2020"
read = "abstract"
[conditions]
shore_a = 60
sole_ra = { range = ["2 um", "8 um"], note = "not printed" }
floor_rq = "3 um"
fluid = "aqueous"
viscosity = "200 cP"
speed = "0.3 m/s"
[[condition]]
id = "first"
measured = { kind = "value", cof = 0.2, sd = 0.02 }
"""


def written(folder, text):
    path = folder / "someone_2020.toml"
    path.write_text(text)
    return path


def test_every_packaged_source_has_its_reference_and_computable_conditions():
    sources = corpus()
    assert len(sources) >= 20
    assert len({source.reference for source in sources}) == len(sources)
    conditions = [condition for source in sources for condition in source.conditions]
    assert len(conditions) >= 190
    assert len({condition.laboratory for condition in conditions}) >= 30
    assert sum(not c.members and c.fluid == "dry" for c in conditions) >= 50
    for condition in conditions:
        for member in condition.members or (condition,):
            assert {"shore_a", "sole_rq", "floor_rq", "speed"} <= set(member.numbers), condition.id
            for name, span in member.numbers.items():
                least = 0.0 if name == "shoe_angle" else 1e-9
                assert least <= span.low <= span.high, (condition.id, name)
        low, high = condition.reading.low, condition.reading.high
        assert 0 <= low <= high
        assert condition.reading.kind in KINDS


def test_readings_stand_in_a_sentence():
    """The report's own tables are named at their head, two abstracts print a table alone."""
    without = {"moore_2012", "strobel_2012", "report_g6", "liu_2013", "mcgorry_2010"}
    for source in corpus():
        for condition in source.conditions:
            assert condition.labels.get("quote") or source.name in without, condition.id


def test_laboratories_are_named_or_are_their_source(tmp_path):
    path = written(tmp_path, GOOD)
    assert read_source(path).conditions[0].laboratory == "someone_2020"
    path.write_text(GOOD.replace('read = "abstract"', 'read = "abstract"\nlaboratory = "A"'))
    assert read_source(path).conditions[0].laboratory == "A"


def test_a_value_and_an_open_range_are_read_in_si(tmp_path):
    (condition,) = read_source(written(tmp_path, GOOD)).conditions
    assert condition.numbers["viscosity"].low == pytest.approx(0.2)
    span = condition.numbers["sole_rq"]
    assert (span.low, span.high) == pytest.approx((2e-6 * math.sqrt(math.pi / 2), 10.0266e-6), 1e-4)
    assert condition.reading.sd_ln == pytest.approx(0.1)
    drawn = sampled_numbers(condition, np.linspace(0, 1, 5)[:, None] * np.ones(len(NUMBERS)))
    assert drawn["sole_ra"][[0, 2, 4]] == pytest.approx([2e-6, 4e-6, 8e-6])
    assert np.ptp(drawn["speed"]) == 0
    longer = replace(condition, numbers={**condition.numbers, "length": Span(6e-3, 6e-3)})
    again = sampled_numbers(longer, np.full((2, len(NUMBERS)), 0.5))
    assert again["length"].tolist() == [6e-3, 6e-3]


def test_a_fit_over_speed_becomes_readings_at_its_speeds():
    moore = next(source for source in corpus() if source.name == "moore_2012")
    water = [c.reading.low for c in moore.conditions if c.id == "water"]
    # Eq. 17 by hand: 0.001 + 0.689 exp(-v / 2.09)
    assert water == pytest.approx([0.6737, 0.5979, 0.4280], abs=2e-4)


def test_a_pendulum_value_is_read_as_test_houses_convert_it(tmp_path):
    for ptv, cof in ((31, 0.31), (36, 0.37), (50, 0.54), (82, 1.00)):
        text = GOOD.replace("cof = 0.2, sd = 0.02", f'cof = "{ptv} PTV"')
        reading = read_source(written(tmp_path, text)).conditions[0].reading
        assert reading.low == reading.high == pytest.approx(cof, abs=0.01)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"200 cP"', "200", r"someone_2020.toml: first.viscosity: 200 has no unit"),
        ('speed = "0.3 m/s"', 'speed = "0.3 s"', "not a value in m/s"),
        ('reference = "Someone 2020"\n', "", "every value needs its source"),
        ('read = "abstract"', 'read = ""', "every value needs its source"),
        ('floor_rq = "3 um"\n', "", "cannot be computed: floor_rq missing"),
        ('floor_rq = "3 um"', 'flor_rq = "3 um"', 'Did you mean "floor_rq"'),
        ('"aqueous"', '"glycerin"', 'unknown fluid "glycerin"'),
        ('kind = "value"', 'kind = "vale"', 'Did you mean "value"'),
        ("cof = 0.2, ", "", "cof missing"),
        ("cof = 0.2", 'cof = "36"', "is no friction"),
        ("cof = 0.2", 'cof = "330 PTV"', "150 PTV"),
        ('["2 um", "8 um"]', '["8 um", "2 um"]', "does not ascend"),
        ("measured =", "measurd =", "nothing was measured"),
        ('id = "first"\n', "", "has no id"),
        ("[conditions]", "[conditions", "cannot be read"),
    ],
)
def test_bad_input_is_named_with_its_place(tmp_path, old, new, message):
    assert old in GOOD
    with pytest.raises(DataError, match=message):
        read_source(written(tmp_path, GOOD.replace(old, new)))
