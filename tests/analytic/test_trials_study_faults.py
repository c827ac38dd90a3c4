"""Faults of a study's folder: each is told before the statistics, and a sound study is not doubted.

The study is simulated: five persons of other masses, three shoes, three trials each.
"""

from __future__ import annotations

import csv
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.trials import Plate, read_trial
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.simulator import walk_c3d
from underfoot.trials.simulator.folder import simulated_study
from underfoot.trials.simulator.walk import WalkRecording
from underfoot.trials.study import FolderAnalysis, analyse_folder

Rows = list[dict[str, str]]
MASSES = ("69.3", "82.8", "80.2", "85.7", "87.1")  # those that the recordings hold
HEIGHTS = ("1.64", "1.81", "1.70", "1.75", "1.90")
SEX = ("f", "m", "m", "f", "m")


@pytest.fixture(scope="module")
def study(tmp_path_factory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("study")
    simulated_study(folder, persons=5, trials=3, seed=3)
    return folder, tmp_path_factory.mktemp("store")


def rows_of(folder: Path) -> Rows:
    rows = []
    for path in sorted(folder.glob("*.c3d")):
        person, shoe, _ = path.stem.split("_")
        i = int(person[1:]) - 1
        noted = {"file": path.name, "subject": person, "shoe": shoe, "floor": "vinyl"}
        body = {"body mass (kg)": MASSES[i], "height (m)": HEIGHTS[i], "sex": SEX[i]}
        rows.append({**noted, **body})
    return rows


def analysed(
    study: tuple[Path, Path], place: Path, change: Callable[[Path, Rows], Rows | None]
) -> FolderAnalysis:
    source, store = study
    folder = place / "study"
    folder.mkdir()
    for path in source.iterdir():
        if path.suffix in (".c3d", ".toml"):
            os.link(path, folder / path.name)
    rows = rows_of(folder)
    rows = change(folder, rows) or rows
    with (folder / "conditions.csv").open("w", newline="") as stream:
        writer = csv.DictWriter(stream, list(rows[0]))
        writer.writeheader()
        writer.writerows(rows)
    return analyse_folder(folder, protocol("level_walking"), store=store, processes=1)


def setting(which: Callable[[dict[str, str]], bool], **values: str) -> Callable[[Path, Rows], None]:
    def change(_: Path, rows: Rows) -> None:
        for row in filter(which, rows):
            row.update({key.replace("_", " "): value for key, value in values.items()})

    return change


def of(*starts: str) -> Callable[[dict[str, str]], bool]:
    return lambda row: row["file"].startswith(starts)


def swapped(first: str, second: str) -> Callable[[Path, Rows], None]:
    """Exchange the recordings behind two beginnings of names."""

    def change(folder: Path, _: Rows) -> None:
        for path in sorted(folder.glob(f"{first}*.c3d")):
            other = folder / path.name.replace(first, second)
            aside = folder / "aside"
            path.rename(aside)
            other.rename(path)
            aside.rename(other)

    return change


def copied(source: str, target: str, *, tail: bytes = b"") -> Callable[[Path, Rows], None]:
    def change(folder: Path, _: Rows) -> None:
        data = (folder / source).read_bytes()
        (folder / target).unlink()
        (folder / target).write_bytes(data + tail)

    return change


def in_a_backup_folder(folder: Path, _: Rows) -> None:
    (folder / "old").mkdir()
    shutil.copy(folder / "S02_hard_1.c3d", folder / "old" / "walk_17.c3d")


def exported_again(
    source: str,
    target: str = "",
    *,
    part: tuple[float, float] = (0.0, 1.0),
    force: Callable[[np.ndarray], np.ndarray] = lambda force: force,
) -> Callable[[Path, Rows], None]:
    """A recording written anew: a part of it, with other forces (n, 3)."""

    def change(folder: Path, _: Rows) -> None:
        trial = read_trial(folder / source, subtract_baseline=False)
        count = len(next(iter(trial.markers.values())).positions)
        ratio = len(trial.plates[0].force) // count
        first, last = (round(share * count) for share in part)
        samples = slice(first * ratio, last * ratio)
        first_plate, second_plate = trial.plates
        written = WalkRecording(
            markers={name: m.positions[first:last] for name, m in trial.markers.items()},
            force=(force(first_plate.force[samples]), force(second_plate.force[samples])),
            centre=(_centre(first_plate, samples), _centre(second_plate, samples)),
            corners=(first_plate.corners, second_plate.corners),
            pressures={},
            sensors={},
        )
        path = folder / (target or source)
        path.unlink()
        path.write_bytes(walk_c3d(written))

    return change


def _centre(plate: Plate, samples: slice) -> np.ndarray:
    return np.nan_to_num(plate.centre_of_pressure[samples])


def two_tables(folder: Path, _: Rows) -> None:
    shutil.copy(Path(__file__), folder / "conditions.xlsx")


def without_rows(folder: Path, rows: Rows) -> Rows:
    return [row for row in rows if not row["file"].startswith("S04_soft")]


def one_person_noted(folder: Path, rows: Rows) -> None:
    for row in rows:
        row["socks"] = "wool" if row["subject"] == "S03" else ""


# What is done, and words of the doubt that must tell it.
FAULTS: dict[str, tuple[Callable[[Path, Rows], Rows | None], str]] = {
    "exported again under another trial": (
        copied("S02_hard_1.c3d", "S02_hard_3.c3d", tail=b"\0" * 512),
        "the same numbers as",
    ),
    "one recording under two shoes": (
        copied("S01_soft_1.c3d", "S01_hard_2.c3d"),
        "the same bytes, noted differently",
    ),
    "one recording of two persons, exported again": (
        copied("S01_soft_1.c3d", "S04_soft_1.c3d", tail=b"\0" * 512),
        "the same numbers, noted differently",
    ),
    "a copy in a folder of its own": (in_a_backup_folder, "the same bytes"),
    "mass noted in two ways": (
        setting(of("S02_hard_1"), **{"body_mass_(kg)": "92"}),
        "body mass of S02",
    ),
    "height noted in two ways": (
        setting(of("S03_soft"), **{"height_(m)": "1.81"}),
        "height of S03",
    ),
    "sex noted in two ways": (setting(of("S05_hard_3"), sex="f"), "sex of S05"),
    "two persons exchanged in one trial": (
        swapped("S01_hard_2", "S02_hard_2"),
        "another person in the place of S01",
    ),
    "a person's shoe recorded with another person": (
        swapped("S01_soft", "S05_soft"),
        "another person in the place of S0",
    ),
    "typing slip in a shoe": (
        setting(of("S02_medium_1"), shoe="meduim"),
        '"meduim" (1) is one letter',
    ),
    "letter missing in a floor": (
        setting(of("S04_hard_2"), floor="vinl"),
        '"vinl" (1) is one letter',
    ),
    "a level of one trial": (
        setting(of("S03_hard_1"), shoe="prototype"),
        '"prototype" has one trial',
    ),
    "shoe empty in two rows": (
        setting(of("S02_hard_1", "S03_soft_2"), shoe=""),
        '"shoe" is noted for 43',
    ),
    "person empty in one row": (setting(of("S02_hard_1"), subject=""), '"subject" is noted for 44'),
    "rows of one person's shoe missing": (without_rows, "is noted for 42 of 45"),
    "a copy cut short": (
        exported_again("S01_soft_1.c3d", "S01_soft_3.c3d", part=(0.0, 0.72)),
        "the same steps as S01_soft_1.c3d",
    ),
    "a copy with another start": (
        exported_again("S01_soft_1.c3d", "S03_soft_1.c3d", part=(0.08, 1.0)),
        "the same steps, noted differently",
    ),
    "a copy in whole newtons": (
        exported_again("S01_soft_1.c3d", "S01_hard_1.c3d", force=np.round),
        "the same steps, noted differently",
    ),
    "a copy with noise": (
        exported_again(
            "S02_soft_1.c3d",
            "S02_medium_1.c3d",
            force=lambda f: f + np.random.default_rng(1).normal(0.0, 0.3, f.shape),
        ),
        "the same steps, noted differently",
    ),
    "a copy with another gain": (
        exported_again("S02_soft_1.c3d", "S04_soft_1.c3d", force=lambda f: 0.95 * f),
        "the same steps, noted differently",
    ),
    "another gain of the shear in one file": (
        exported_again("S03_soft_1.c3d", force=lambda f: f * [0.6, 0.6, 1.0]),
        "against the other trials of S03",
    ),
    "a question mark for a shoe": (
        setting(of("S02_hard_1", "S03_soft_2", "S04_medium_1"), shoe="?"),
        '"shoe" is noted for 42',
    ),
    "n/a for a shoe": (
        setting(of("S02_hard_1", "S03_soft_2", "S04_medium_1"), shoe="n/a"),
        '"shoe" is noted for 42',
    ),
    "unknown persons": (
        setting(of("S02_hard_1", "S03_soft_2", "S04_medium_1"), subject="unknown"),
        '"subject" is noted for 42',
    ),
    "one shoe noted for all trials of a person": (
        setting(of("S03"), shoe="hard"),
        'S03 has 9 trials with shoe "hard" and none with "medium"',
    ),
    "person and shoe exchanged in a row": (
        setting(of("S02_hard_1"), subject="hard", shoe="S02"),
        'subject "hard" has one trial',
    ),
    "mass missing for one person": (
        setting(of("S03"), **{"body_mass_(kg)": ""}),
        '"body mass" is noted for 36',
    ),
    "a condition of one person only": (one_person_noted, '"socks" is noted for 9 of 45 files only'),
}
SPELLINGS: dict[str, Callable[[Path, Rows], None]] = {
    "leading zeros": setting(of("S02_hard"), subject="S002"),
    "letters before the number": setting(of("S04_soft"), subject="4"),
    "an accent": lambda folder, rows: (
        [
            row.update(subject="Jos\u00e9" if "soft" in row["file"] else "Jose")
            for row in rows
            if row["subject"] == "S01"
        ]
        and None
    ),
    "oe": lambda folder, rows: (
        [row.update(floor="Sch\u00f6n" if "soft" in row["file"] else "Schoen") for row in rows]
        and None
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_told_with_its_files(study, tmp_path, fault):
    change, words = FAULTS[fault]
    analysis = analysed(study, tmp_path, change)
    told = [doubt for doubt in analysis.doubts if words in str(doubt)]
    assert told, [str(doubt) for doubt in analysis.doubts]
    assert told[0].files
    assert analysis.tables[0].name == "doubts"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (two_tables, "two tables of conditions"),
        (setting(of("S03"), **{"height_(m)": "170"}), "0.5 to 2.5 m"),
        (setting(of("S03"), **{"body_mass_(kg)": "-70"}), "10 to 300 kg"),
        (lambda _, rows: [*rows, {**rows[0], "shoe": "soft"}], "named twice"),
    ],
)
def test_a_wrong_table_is_refused(study, tmp_path, change, words):
    with pytest.raises(InputError, match=words):
        analysed(study, tmp_path, change)


@pytest.mark.parametrize("fault", SPELLINGS)
def test_spellings_of_one_name_are_refused(study, tmp_path, fault):
    with pytest.raises(InputError, match="is written"):
        analysed(study, tmp_path, SPELLINGS[fault])


def test_there_are_thirty_faults_of_a_study():
    assert len(FAULTS) + len(SPELLINGS) >= 30


def unbalanced(folder: Path, rows: Rows) -> Rows:
    """A person came once only, another left a trial out: sound, and told by nobody."""
    for name in ("S02_hard_2", "S03_soft_1", "S03_soft_2", "S05_medium_3"):
        (folder / f"{name}.c3d").unlink()
    return [row for row in rows if (folder / row["file"]).exists()]


SOUND: dict[str, Callable[[Path, Rows], Rows | None]] = {
    "as made": lambda folder, rows: None,
    "unbalanced": unbalanced,
    "numbers as names": lambda folder, rows: (
        [row.update(subject=str(10 + int(row["subject"][1:]))) for row in rows] and None
    ),
    "similar names of persons": lambda folder, rows: (
        [
            row.update(
                subject=("Meier", "Meyer", "Maier", "Mayer", "Beier")[int(row["subject"][1:]) - 1]
            )
            for row in rows
        ]
        and None
    ),
    "similar names of shoes": lambda folder, rows: (
        [
            row.update(shoe={"hard": "shoe1", "medium": "shoe2", "soft": "shoe11"}[row["shoe"]])
            for row in rows
        ]
        and None
    ),
    "mass weighed again": setting(of("S02_soft"), **{"body_mass_(kg)": "84"}),
}


@pytest.mark.parametrize("case", SOUND)
def test_a_sound_study_is_not_doubted(study, tmp_path, case):
    assert not analysed(study, tmp_path, SOUND[case]).doubts


def test_copies_do_not_count_and_the_factor_stays(study, tmp_path):
    change, _ = FAULTS["exported again under another trial"]
    analysis = analysed(study, tmp_path, change)
    verdicts = {one.file: one.verdict for one in analysis.files}
    assert verdicts["S02_hard_3.c3d"] == "refused"
    assert verdicts["S02_hard_1.c3d"] == "accepted"
    assert any(
        "shoe" in finding.table.title or finding.factor == "shoe"
        for finding in analysis.study.findings
    )


def test_missing_rows_no_longer_take_a_factor_away(study, tmp_path):
    analysis = analysed(study, tmp_path, without_rows)
    table = next(t for t in analysis.study.tables if t.name.startswith("conditions"))
    assert "shoe" in table.columns
    assert len({row[0] for row in table.rows} - {"all"}) == 3
    persons = next(t for t in analysis.study.tables if t.name == "persons")
    assert {row[0] for row in persons.rows} == {"S01", "S02", "S03", "S04", "S05"}
