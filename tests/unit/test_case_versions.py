"""Case files of version 1 are read, what moved is said, and written as version 2."""

import tomllib
from pathlib import Path

import pytest

from underfoot.case import Case, CaseError
from underfoot.case.versions import RENAMED

OLD = Path(__file__).parents[1] / "data" / "case_v1"
EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize("file", sorted(OLD.glob("*.toml")), ids=lambda file: file.stem)
def test_every_old_file_is_read_and_upgraded(file, tmp_path):
    case = Case.load(file)
    text = case.to_toml()
    assert tomllib.loads(text)["file_version"] == 2
    again = Case.from_text(text)
    assert again == case
    assert again.changes == ()
    comments = [line for line in file.read_text().splitlines() if line.startswith("# ")]
    assert all(line in text for line in comments)
    present = EXAMPLES / file.name
    if not present.exists():
        present = EXAMPLES / "outsoles" / file.name
    if present.exists():
        chosen = {"interface.roughness_beyond_cutoff": 2.0}  # on other readings since
        assert Case.load(present).replace(chosen) == case.replace(chosen)


def test_what_moved_and_what_was_in_vain_is_said():
    case = Case.load(OLD / "every_slot.toml")
    told = "\n".join(case.changes)
    assert "models.friction is friction.model in case files of version 2" in told
    assert "friction.alpha is left out: not used by model" in told
    assert "interface.roughness_beyond_cutoff is left out" in told
    assert "interface.hurst is left out: not read by any chosen option" in told
    assert case.value("friction.hysteresis_cof") == 0.05
    # marks that a table handed down travel with the value that moves out of it
    assert case.sourced_value("friction.hysteresis_cof").source == "own reading"
    assert case.sourced_value("friction.cof_bl").uncertainty == 0.02
    assert case.sensor.array.rows == 3
    assert case.shoe.sole.midsole.modulus == 2e6
    assert case.hardness.name == "ruess"
    assert case.compliance.name == "half_space"


@pytest.mark.parametrize("old", RENAMED)
def test_old_paths_answer_in_python(old):
    from underfoot.case import unit_at

    case = Case.load(OLD / "every_slot.toml")
    assert case.value(old) == case.value(RENAMED[old])
    assert unit_at(old) == unit_at(RENAMED[old])


def test_old_paths_are_taken_by_replace_and_settings():
    case = Case.load(
        OLD / "work_shoe_untreaded_glycerol.toml",
        settings={"models.friction": "constant", "interface.constant_cof": 0.4},
    )
    assert case.friction.cof == 0.4
    rocker = case.replace(
        {
            "shoe.heel.profile": "rocker",
            "shoe.heel.rocker_radius": "80 mm",
            "shoe.heel.rocker_start": 0.025,
        }
    )
    assert rocker.shoe.heel.profile.radius == 0.08


def test_a_file_of_version_2_is_held_to_it():
    text = Case.load(OLD / "work_shoe_full_tread_dry.toml").to_toml()
    with pytest.raises(CaseError, match='unknown key "models"'):
        Case.from_text(text + '\n[models]\nfriction = "stribeck"\n')
    with pytest.raises(CaseError, match=r'alpha: is not used by model = "constant".*write model'):
        Case.from_text(text.replace("cof = 0.8", 'cof = 0.8\nalpha = "2 N"'))
