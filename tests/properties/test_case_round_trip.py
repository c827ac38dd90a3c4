"""Any case survives writing and reading with an equal hash; replacing is exact."""

from hypothesis import given, settings
from hypothesis import strategies as st

from underfoot.case import Case
from underfoot.core.catalogue import Catalogue

BOOK = Catalogue.load()
SHOES = [name for name in BOOK.names("shoe") if name != "slip_tester_heel"]
FLOORS = [name for name in BOOK.names("floor") if not name.startswith("ceramic")]
# a history fixes load, speed and angle, which the changes below alter
SETUPS = [
    n
    for n in BOOK.names("setup")
    if (motion := BOOK.entry("setup", n).under("motion"))
    and "history_points" not in motion
    and "backward" not in motion  # refused with the steady motion of the changes
]


def quantities(low, high, *units):
    number = st.floats(low, high, allow_nan=False).map(lambda value: f"{value:.6g}")
    return st.tuples(number, st.sampled_from(units)).map(" ".join)


def sourced(values):
    marks = st.fixed_dictionaries(
        {},
        optional={
            "source": st.text(max_size=8),
            "note": st.text(max_size=8),
            "assumed": st.booleans(),
        },
    )
    return st.tuples(values, marks).map(lambda pair: {"value": pair[0], **pair[1]}) | values


CHANGES = st.fixed_dictionaries(
    {},
    optional={
        "contaminant.viscosity": sourced(quantities(0.5, 900, "cP", "mPa*s"))
        | st.floats(5e-4, 0.9),
        "motion.speed": sourced(quantities(0.01, 5, "m/s")) | st.floats(0.01, 5),
        "motion.normal_force": quantities(10, 900, "N"),
        "motion.shoe_angle": quantities(-20, 40, "deg"),
        "shoe.material.shore_a": st.integers(20, 95),
        "shoe.material.poisson_ratio": st.floats(0.1, 0.5),
        "shoe.heel.facet_angle": quantities(0, 50, "deg", "degree"),
        "shoe.sole.outsole_thickness": quantities(6, 40, "mm"),
        "hardness.model": st.sampled_from(["gent", "ruess"]),
        "friction.model": st.sampled_from(["boundary", "stribeck", "asperity_ehl"]),
        "friction.cof_bl": sourced(st.floats(0.0, 1.5)),
        "rough_contact": st.sampled_from(["exponential", "contact_table"]),
        "compliance": st.sampled_from(["layered", "half_space"]),
        "risk.model": st.sampled_from(["report_g6", "chang_2004"]),
        "shoe.wear": st.sampled_from([{"mode": "plane", "depth": 2e-4}, {"depth": "0.1 mm"}]),
        "sensor.scans": st.integers(1, 20),
        "motion.duration": quantities(0.25, 1, "s"),
    },
)


@st.composite
def pool_and_roughness(draw):
    """A pool, and a roughness whose summits (3 Rq) it covers: a case refuses others."""
    found, pool = {}, 0.6
    if draw(st.booleans()):
        pool = draw(st.floats(0.1, 3))
        found["contaminant.pool_depth"] = f"{pool!r} mm"
    if draw(st.booleans()):
        highest = min(90.0, 0.999 * pool * 1000 / 3)
        found["interface.effective_rq"] = draw(sourced(quantities(0.1, highest, "um")))
    return found


@st.composite
def cases(draw):
    mapping = {
        "name": draw(st.text(max_size=20)),
        "shoe": draw(st.sampled_from(SHOES)),
        "floor": draw(st.sampled_from(FLOORS)),
        "contaminant": draw(st.sampled_from(BOOK.names("fluid"))),
        "motion": draw(st.sampled_from(SETUPS)),
    }
    return Case.from_mapping(mapping).replace({**draw(CHANGES), **draw(pool_and_roughness())})


@settings(deadline=None, max_examples=25)
@given(cases())
def test_case_to_toml_to_case_keeps_the_hash(case):
    assert Case.from_text(case.to_toml()).hash == case.hash
    assert case.model_copy() == case
    assert Case.from_text(case.model_copy().to_toml()) == case
    complete = Case.from_text(case.to_toml(complete=True))
    assert complete.hash == case.hash
    assert complete.name == case.name
    for path in ("motion.speed", "contaminant.viscosity", "shoe.material.shore_a"):
        ours, theirs = case.sourced_value(path), complete.sourced_value(path)
        assert ours.value == theirs.value
        assert ours.assumed == theirs.assumed


@settings(deadline=None, max_examples=40)
@given(cases(), CHANGES)
def test_replacing_and_taking_back_is_the_case_before(case, changes):
    changed = case.replace(changes)
    for path, given_value in changes.items():
        if isinstance(given_value, int | float):
            assert changed.value(path) == given_value
    base = case.replace(dict.fromkeys(changes))
    assert changed.replace(dict.fromkeys(changes)) == base
