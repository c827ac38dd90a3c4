"""A name does not state what was replaced without saying what stands there now."""

from pathlib import Path

import pytest

from underfoot import Case

EXAMPLE = Path(__file__).parents[2] / "examples" / "work_shoe_half_tread_glycerol.toml"
NAME = Case.load(EXAMPLE).name


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"contaminant": "canola_oil"}, ", contaminant canola oil"),
        ({"contaminant": {"from": "canola_oil"}}, ", contaminant canola oil"),
        ({"contaminant": "none"}, ", contaminant none"),
        ({"shoe": "athletic_shoe_full_tread"}, ", shoe athletic shoe full tread"),
        ({"floor": "glazed_tile"}, ", floor glazed tile"),
        ({"motion.speed": "0.3 m/s"}, ", speed 0.3 m/s"),
        ({"contaminant": "glycerol_90pct"}, ""),
        ({"numerics.grid_spacing": "1.2 mm"}, ""),
        ({"contaminant": "canola_oil", "name": "In oil"}, None),
        ({"risk.rcof_mean": 0.21320612}, ", rcof mean 0.213"),
    ],
)
def test_a_name_tells_what_was_set(settings: dict[str, object], told: str | None) -> None:
    case = Case.load(EXAMPLE, settings=settings)
    assert case.name == ("In oil" if told is None else NAME + told)
    assert Case.from_text(case.to_toml()).name == case.name


def test_a_name_counts_what_it_does_not_tell() -> None:
    speeds = {"shoe.tread.lug_width": "8 mm", "shoe.tread.depth": "2 mm"}
    case = Case.load(
        EXAMPLE, settings={**speeds, "motion.speed": "0.3 m/s", "motion.shoe_angle": "5 deg"}
    )
    assert case.name == f"{NAME}, lug width 8 mm, depth 2 mm, speed 0.3 m/s, and 1 more"


def test_a_case_without_a_name_has_that_of_its_file(tmp_path: Path) -> None:
    lines = EXAMPLE.read_text(encoding="utf-8").splitlines()
    path = tmp_path / "new heel.toml"
    path.write_text("\n".join(x for x in lines if not x.startswith("name")), encoding="utf-8")
    case = Case.load(path)
    assert case.name == "new heel"
    assert case.hash == Case.load(EXAMPLE).hash
    path = path.rename(tmp_path / "case.toml")  # as a result keeps it
    path.write_text(case.to_toml(), encoding="utf-8")
    assert Case.load(path).name == "new heel"
