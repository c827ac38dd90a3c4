"""A case put together from its parts: contact of measured surfaces, records, texts and files."""

from pathlib import Path
from typing import Any, cast

import pytest

from snapshot import refusal
from underfoot.case import text
from underfoot.case.case import Case
from underfoot.case.compose import Composition, _settle_contact, _settle_hardness, expand_sections
from underfoot.case.section import CATALOGUE, DEFAULT, GIVEN, Origin
from underfoot.core.leaves import Leaf


def origin(value: Any, kind: str = GIVEN, **more: Any) -> Origin:
    return Origin(kind, Leaf(value, source="here", **more))


def composed(tree: dict[str, Any], settle=_settle_contact, lenient=lambda _: False) -> Any:
    nothing, place = cast(Any, None), cast(Any, lambda path: path)
    made = Composition(nothing, place, Path(), lenient, tree=tree)
    settle(made)
    return made


def measured(**more: Any) -> dict[str, Any]:
    shoe = {
        "roughness": {"file": origin("a.x3p")},
        "material": {"relaxation": {"file": origin("a")}},
    }
    return {"shoe": shoe, "floor": {"roughness": {"file": origin("b.x3p")}}, **more}


def test_two_measured_surfaces_and_a_measured_compound_meet_by_their_table():
    found = composed(measured()).tree["rough_contact"]
    assert list(found) == ["model"]
    assert (found["model"].kind, found["model"].value) == (DEFAULT, "contact_table")
    assert found["model"].leaf.source == "both surfaces and the compound are measured"
    for path in (("shoe", "roughness"), ("floor", "roughness"), ("shoe", "material")):
        for wrong in ({}, {"file": origin(None)}, {"file": origin("a", assumed=True)}, None, "a"):
            tree = measured()
            tree[path[0]] = {**tree[path[0]], path[1]: wrong}
            if path[1] == "material":
                tree["shoe"]["material"] = {"relaxation": wrong}
            if path[1] == "material" and wrong == "a":
                continue  # a name of what was measured
            assert "rough_contact" not in composed(tree).tree, (path, wrong)
    two = measured()
    two["shoe"]["material"]["relaxation"]["modulus"] = origin(3.0, assumed=True)
    assert "rough_contact" not in composed(two).tree


def test_a_contact_that_was_chosen_stays_and_one_that_was_not_is_found_anew():
    chosen = {"model": origin("persson")}
    assert composed(measured(rough_contact=chosen)).tree["rough_contact"] is chosen
    usual = {"model": origin("exponential", DEFAULT)}
    assert (
        composed(measured(rough_contact=usual)).tree["rough_contact"]["model"].value
        == "contact_table"
    )
    table = {"model": origin("contact_table", DEFAULT)}
    assert "rough_contact" not in composed({"shoe": {}, "rough_contact": table}).tree
    more = {"model": origin("contact_table", DEFAULT), "file": origin("t.json")}
    assert composed(measured(rough_contact=more)).tree["rough_contact"] is more
    file = {"file": origin("t.json")}
    assert composed(measured(rough_contact=file)).tree["rough_contact"] is file


def test_hardness_goes_where_a_modulus_is_known():
    known = {"shoe": {"material": {"modulus": origin(3e6)}}}
    assert composed({**known, "hardness": {}}, _settle_hardness).tree["hardness"] is None
    made = composed({**known, "hardness": {"model": origin("gent")}}, _settle_hardness)
    assert ["modulus of the compound is given" in str(one) for one in made.errors] == [True]
    soft = composed(
        {**known, "hardness": {"model": origin("gent")}}, _settle_hardness, lambda _: True
    )
    assert (soft.errors, soft.dropped) == (
        [], {"hardness.model": "not used beside a measured modulus"}
    )  # fmt: skip
    for shoe in ({}, {"material": {}}, {"material": {"modulus": origin(None)}}, "a"):
        tree = {"shoe": shoe, "hardness": {"model": "gent"}}
        assert composed(tree, _settle_hardness).tree["hardness"] == {"model": "gent"}


def test_names_of_entries_and_options_become_their_keys():
    assert expand_sections("vinyl_g4", "floor") == {"from": "vinyl_g4"}
    assert expand_sections("persson", "rough_contact") == {"model": "persson"}
    assert expand_sections({"value": 3}, "floor") == {"value": 3}
    assert expand_sections({"material": "rubber"}, "shoe") == {"material": {"from": "rubber"}}
    assert expand_sections("3 m", "motion.speed") == "3 m"


def test_files_are_written_whole_and_not_over_others(tmp_path):
    path = tmp_path / "a.toml"
    text.save("a = 1\n", path)
    assert "exists" in refusal(text.save, "a = 2\n", path)
    assert path.read_text(encoding="utf-8") == "a = 1\n"
    text.save("ä = 2\n", path, overwrite=True)
    assert text.read_text(path) == "ä = 2\n"
    path.write_bytes(b"\xef\xbb\xbfa = 3")
    assert text.read_text(path) == "a = 3"
    path.write_bytes(b"\xff\xfe")
    assert "Save the file as UTF-8 text" in refusal(text.read_text, path)
    assert "Did you mean" in refusal(text.read_text, tmp_path / "b.toml")
    assert "can't be read" in refusal(text.read_text, tmp_path)


def change(before: str, settings: dict[str, Any]) -> str:
    def expand(value: Any, path: str) -> Any:
        return (
            {"from": value}
            if path in ("shoe", "shoe.material") and isinstance(value, str)
            else value
        )

    return text.change_text(before, settings, expand)


def test_values_change_and_comments_stay():
    before = (
        '# head\nshoe = "a"  # my shoe\n[motion]\nspeed = "1 m/s"  # fast\n  angle = 3 # wide\n'
    )
    assert change(before, {"motion.speed": "2 m/s"}) == before.replace("1 m/s", "2 m/s")
    assert change(before, {"motion.angle": 4}) == before.replace("= 3", "= 4")
    assert change(before, {"motion.speed": None}).count("speed") == 0
    assert change(before, {"floor.rq": None}) == before
    assert 'shoe = {from = "a", material = {from = "b"}}' in change(
        before, {"shoe.material": "b"}
    ).replace("'", '"')
    assert "[floor]\nrq = 3" in change(before, {"floor.rq": 3})
    deep = change(before, {"floor.roughness.rq": {"value": 3, "unit": "um"}})
    assert "[floor.roughness]\n" in deep
    assert 'rq = {value = 3, unit = "um"}' in deep
    again = change(before, {"shoe": "b"})
    assert '"b"' in again
    assert "is a value, not a section" in refusal(change, before, {"motion.speed.x": 1})


def test_tables_are_written_with_their_headers():
    tree = {"a": 1, "b": {"c": {"d": [1, "x"], "e": {"value": 2.5}}}, "empty": {}, "odd key": True}
    assert text.toml_text(tree, "said") == (
        '# said\na = 1\n"odd key" = true\n\n[b.c]\nd = [1, "x"]\ne = {value = 2.5}\n\n[empty]\n'
    )
    assert text.toml_text({"b": {"c": 1}}) == "[b]\nc = 1\n"


@pytest.mark.parametrize(
    ("wrong", "words"),
    [("a = ", "Text and numbers with a unit"), ('shoe = "a"\n[shoe.material]\nb = 1', "Beside"),
     ("a = " + "[" * 3000, "nested too deeply|is no TOML")],
)  # fmt: skip
def test_texts_that_are_none(wrong, words):
    import re

    assert re.search(words, refusal(text.parse_toml, wrong, "a.toml"))
    assert text.parse_toml("\ufeffa = 1.5") == {"a": 1.5}


def test_entries_of_another_fluid_leave_their_friction():
    from underfoot.case.compose import _of_another_fluid

    ours = {"contaminant": "water"}
    for kind, entry, other in (
        (CATALOGUE, "fluid oil", True), (CATALOGUE, "fluid water", False),
        (CATALOGUE, "material oil", False), (GIVEN, "fluid oil", False),
    ):  # fmt: skip
        assert _of_another_fluid(Origin(kind, Leaf(1.0, source="a"), entry), ours) == other
    assert _of_another_fluid(Origin(CATALOGUE, Leaf(1.0, source="a"), "fluid oil"), {})


POINT = {"time": "0 ms", "normal_force": "100 N", "speed": "0.3 m/s", "shoe_angle": "5 deg"}


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([POINT], ["motion.duration: 0 ms is outside"]),
        (["x", POINT], ["motion.duration: 0 ms", "history_points.0: 'x' can't be used"]),
        ([POINT, "x"], ["history_points.1: 'x' can't be used"]),
        ([POINT, {**POINT, "normal_force": "0.99 N"}], ["history ends with 0.99 N. Allowed: 1 N"]),
    ],
)
def test_histories_that_cannot_be(points, words):
    given = {
        "shoe": "work_shoe_full_tread", "floor": "vinyl_g4", "contaminant": "glycerol_90pct",
        "motion": {"from": "slip_tester_g4", "history_points": points},
    }  # fmt: skip
    told = refusal(Case.from_mapping, given)
    assert told.startswith("CaseError")
    assert all(one in told for one in words)
    assert ("duration" in told) == (points[-1] is POINT)
