"""Steps of a case by their values: what two roughnesses make, what counts as an assumption."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.stats import norm

from underfoot.case import Case, load
from underfoot.case.describe import assumptions
from underfoot.case.explanation import FIRST_SCREEN, _document_item, _equation_text, _summary
from underfoot.case.friction import range_95
from underfoot.case.lettering import text_rings
from underfoot.case.motion import AnySpeed
from underfoot.case.people import Transfer
from underfoot.case.quantity import Quantity, default_of
from underfoot.case.section import Section
from underfoot.case.template import _overrides, _remark
from underfoot.compute.resolve import resolve_context
from underfoot.core import InputError, SourcedValue, UnderfootError, to_si


def every_kind(kind=Section):
    """Yield each section and option of a case that the package has."""
    for one in kind.__subclasses__():
        if one.__module__.startswith("underfoot."):
            yield one
        yield from every_kind(one)


FIELDS = {
    f"{section.__name__}.{name}": field
    for section in set(every_kind())
    for name, field in section.model_fields.items()
}
HEEL = Path(__file__).parents[2] / "examples" / "work_shoe_untreaded_glycerol.toml"


@pytest.fixture(scope="module")
def heel():
    return load(HEEL)


def of_unit(number, unit):
    return f"{number:g}" if unit == "1" else f"{number:g} {unit}"


def test_a_default_is_what_its_text_says_in_si_and_within_its_range():
    checked = 0
    for path, field in FIELDS.items():
        ranges = [one for one in field.metadata if isinstance(one, Quantity)]
        said = default_of(field)
        if said is None or not ranges:
            continue
        (kind,) = ranges
        text = said.text if isinstance(said.text, str) else of_unit(said.text, kind.unit)
        assert to_si(text, kind.unit, where=path) == pytest.approx(field.default, abs=1e-30), path
        assert kind.low <= field.default <= kind.high, path
        checked += 1
    assert checked > 150


def test_a_range_has_a_unit_and_two_ends_in_their_order():
    for path, field in FIELDS.items():
        for kind in (one for one in field.metadata if isinstance(one, Quantity)):
            assert kind.low < kind.high, path
            assert to_si(of_unit(2, kind.unit), kind.unit, where=path) == 2.0, path


@pytest.mark.parametrize(
    ("name", "unit", "low", "high"), [("Speed", "m/s", -20, 20), ("Transfer", "1", 0, 1)]
)
def test_what_walks_or_slides_may_stand_still(name, unit, low, high):
    """Speeds of a history go both ways; none or all of the weight may be on one foot."""
    kind = {"Speed": AnySpeed, "Transfer": Transfer}[name].__metadata__[0]
    assert (kind.unit, kind.low, kind.high) == (unit, low, high)


def test_a_remark_beside_a_value_says_what_it_is_and_that_it_is_assumed():
    field = FIELDS["ConstantOption.cof"]
    assert _remark(field, assumed=False) == "# measured coefficient of friction, all parts"
    assert _remark(field, assumed=True).endswith("all parts; assumed")
    assert _remark(None, assumed=True) == "# assumed"
    assert _remark(None, assumed=False) == ""


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
    law: Any = case.friction.build(resolve_context(case))
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


def test_what_is_cut_off_after_a_colon_is_marked():
    def shortened():
        """Return the first of three, in this order:

        Source: A paper of 1999.
        """

    def whole():
        """Return the first of three.

        Source: A paper of 1999.
        """

    text = _document_item("shortened", shortened, full=False)
    assert "in this order: …" in text
    assert " …" not in _document_item("whole", whole, full=False)


@pytest.mark.parametrize(("paragraphs", "left"), [(1, 1), (2, 2), (3, 2), (9, 2)])
def test_a_first_screen_holds_whole_paragraphs_and_the_first_of_any_length(paragraphs, left):
    """Of 9 lines and a blank each: two fit into 20 lines."""

    def told():
        pass

    lines = [f"line {k}" for k in range(9)]
    told.__doc__ = "\n\n".join("\n".join(lines) for _ in range(paragraphs))
    assert FIRST_SCREEN == 20
    assert _document_item("told", told, full=False).count("line 8") == left
    told.__doc__ = "\n".join(lines * 3)
    assert _document_item("told", told, full=False).count("line 8") == 3


@pytest.mark.parametrize("deviation", [0.05, 0.3])
def test_a_range_holds_95_percent_of_what_scatters_by_a_factor(deviation):
    given = SourcedValue(2.0, "m", uncertainty=deviation * 2.0)
    low, high = cast(tuple[float, float], range_95(given))
    ends = np.log(np.array([low, high]) / 2.0) / deviation
    assert np.diff(norm.cdf(ends)) == pytest.approx(0.95, abs=1e-4)
    assert low * high == pytest.approx(4.0)
    assert range_95(SourcedValue(2.0, "m")) == (2.0, 2.0)
    assert range_95(SourcedValue(None, "m", reason="unknown")) is None


HOLES = {0: "CLS3!i/", 1: "ADOPR069aegá", 2: "B8"}


def test_letters_have_the_holes_that_they_are_written_with():
    for count, letters in HOLES.items():
        for letter in letters:
            shells, holes = text_rings(letter, 8e-3, 2e-3)
            assert len(holes) == count, letter
            assert len(shells) == (1 + (letter in "i!á")), letter
            for ring in holes:
                inside = [np.ptp(ring[:, k]) < np.ptp(shells[0][:, k]) for k in (0, 1)]
                assert all(inside), letter


def test_a_template_names_keys_of_an_old_entry_as_a_case_has_them_now():
    leaf = SimpleNamespace(given="round", assumed=False)
    entry = SimpleNamespace(values={"heel.profile": leaf, "heel.length": leaf})
    catalogue = cast(Any, SimpleNamespace(entry=lambda kind, name: entry))
    first, second = _overrides("shoe", "own", catalogue)
    assert first.startswith("# heel.profile.model = ")
    assert second.startswith("# heel.length = ")


@pytest.mark.parametrize(
    ("length", "width", "refused"),
    [("20 mm", "20 mm", ""), ("400 mm", "20 mm", "patch_length"), ("20 mm", "200 mm", "width")],
)
def test_a_worn_patch_is_no_larger_than_its_heel(length, width, refused):
    case = load(HEEL)
    changes = {
        "shoe.wear.mode": "patch",
        "shoe.wear.depth": "1 mm",
        "shoe.wear.patch_length": length,
        "shoe.wear.patch_width": width,
    }
    if refused:
        with pytest.raises(UnderfootError, match=f"{refused}.*larger than the shoe"):
            case.replace(changes)
    else:
        assert case.replace(changes).shoe.wear.patch_length == pytest.approx(0.02)


def test_numbers_of_numpy_are_those_of_python_in_a_case_and_in_its_file(heel):
    given = {
        "motion.speed": np.float64(0.3),
        "contaminant.viscosity": np.float32(0.25),
        "shoe.material.shore_a": np.int64(62),
        "motion.shoe_angle": np.array(0.125),
        "numerics.tread_positions": np.int32(3),
        "motion.steady": np.bool_(True),
    }
    case = heel.replace(given)
    plain = heel.replace({path: value.item() for path, value in given.items()})
    assert case == plain
    assert case.to_toml() == plain.to_toml()
    assert 'speed = "0.3 m/s"' in case.to_toml()
    read = Case.from_text(case.to_toml(complete=True))
    assert read.hash == plain.hash
    with pytest.raises(InputError, match=r"motion.speed: \[0.3, 0.4\] is not a quantity"):
        heel.replace("motion.speed", np.array([0.3, 0.4]))


def test_a_spread_beside_an_si_number_is_one_too(heel):
    told = {"value": "50 cP", "uncertainty": "3 cP"}
    plain = {"value": 0.05, "uncertainty": np.float64(0.003)}
    case, same = (heel.replace("contaminant.viscosity", each) for each in (told, plain))
    assert same.sourced_value("contaminant.viscosity").uncertainty == pytest.approx(0.003)
    assert same == case
    assert Case.from_text(same.to_toml()) == case
    warm = {"value": 293.15, "uncertainty": 2.0}
    glycerol = {"glycerol_fraction": 0.9, "fraction_basis": "volume", "temperature": warm}
    spread = heel.replace("contaminant", glycerol)
    assert spread.sourced_value("contaminant.temperature").uncertainty == pytest.approx(2.0)
    assert Case.from_text(spread.to_toml()) == spread
    for mixed in ({"value": "50 cP", "uncertainty": 0.003}, {"value": 0.05, "uncertainty": True}):
        with pytest.raises(InputError, match="uncertainty"):
            heel.replace("contaminant.viscosity", mixed)


@pytest.mark.parametrize(
    ("speeds", "known"), [((0.1, 0.1, 0.3, 0.3), True), ((0.1, 0.1, 0.3), False)]
)
def test_readings_without_a_spread_have_that_of_their_repeats_where_each_is_repeated(speeds, known):
    readings = [{"speed": v, "cof": 0.3 + 0.02 * n} for n, v in enumerate(speeds)]
    case = load(HEEL).replace({"friction": {"model": "table", "readings": readings}})
    law = case.friction.build(resolve_context(case))
    assert law.speed.tolist() == [0.1, 0.3]
    if known:
        assert law.cof_deviation == pytest.approx([0.02 / 2**0.5] * 2)
    else:
        assert law.cof_deviation is None
