"""Faults of tables and channels that no list held: each is told, or the number stays right."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trial_testers import sound_log, write_log
from underfoot.core import InputError
from underfoot.trials import (
    Plate,
    Trial,
    finished_plate,
    read_trial,
    required_frictions,
    walkway_of,
)
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.study import analyse_folder
from underfoot.trials.study.conditions import study_folder

WALK = Path(__file__).parents[1] / "data" / "trials" / "biomechzoo" / "HC030A05.c3d"
TRUTH = {"plate 2": 0.216, "plate 1": 0.252}
HEAD = "surface,slider,condition,direction,PTV"
FIVE = ("34", "36", "35", "35", "36")


# ------------------------------------------------------------- tables of readings
def readings(values=FIVE, before="tile,96,wet,along", head=HEAD) -> str:
    return "\n".join([head, *(f"{before},{value}" for value in values)])


READINGS = {
    "unquoted decimal comma": (readings(("0,45",) * 5), "line 2 has 6 cells"),
    "a cell too many in one row": (readings() + "\ntile,96,wet,dusty,along,36", "line 7 has 6"),
    "two columns of one name": (
        readings([f"{v},48" for v in FIVE], head=HEAD + ",PTV"), 'called "ptv"'
    ),
    "two columns of readings": (
        readings([f"{v},24" for v in FIVE], head=HEAD + ",SRV"), "several columns of readings"
    ),
    "a mark at a reading": (readings(("34", "36*", "35", "35", "36")), 'line 3: PTV is "36*"'),
    "a unit in the cells": (readings([f"{v} PTV" for v in FIVE]), 'line 2: PTV is "34 PTV"'),
    "thousands": (readings([f'"1.23{v},5"' for v in FIVE]), "line 2: PTV is"),
    "not a number": (readings(("34", "inf", "35", "35", "36")), 'line 3: PTV is "inf"'),
    "an unknown slider": (readings(before="tile,69,wet,along"), 'unknown slider "69"'),
    "one COF among the readings": (readings(("34", "36", "0.35", "35", "36")), "differ by"),
    "a mean as a last row": (readings() + "\nmean,,,,35.2", '"mean" is no sample'),
    "readings across": (
        "surface,slider,condition,direction,1,2\ntile,96,wet,along,34,36", "no column of readings"
    ),
}  # fmt: skip
OTHERS = {
    "a ramp of 60 degrees": ("en_16165_shod_ramp", "surface,angle (deg)\ntile,60", "0 to 45"),
    "an angle in percent": ("en_16165_shod_ramp", "surface,angle (%)\ntile,20", '"%"'),
    "negative friction": (
        "en_16165_tribometer", "surface,COF\n" + "tile,-0.05\n" * 4, "a mean of -0.05"
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", [*READINGS, *OTHERS])
def test_a_fault_of_readings_is_told(fault, tmp_path):
    named = OTHERS.get(fault) or ("en_16165_pendulum", *READINGS[fault])
    (tmp_path / "hall.csv").write_text(named[1])
    files = analyse_folder(tmp_path, protocol(named[0]), processes=1).files
    told = " ".join(reason for one in files for reason in one.reasons)
    assert named[2] in told
    assert "accepted" not in {one.verdict for one in files}


def test_sliders_have_their_usual_names(tmp_path):
    (tmp_path / "hall.csv").write_text(readings(before="tile,Four S,wet,along"))
    (one,) = analyse_folder(tmp_path, protocol("en_16165_pendulum"), processes=1).files
    assert one.verdict == "accepted"


# ------------------------------------------------------------- tables of conditions
FILES = [f"S0{person}_{shoe}.c3d" for person in (1, 2) for shoe in ("hard", "soft")]
HEADING = "file,subject,shoe,body mass (kg)"


def conditions(head=HEADING, mass="61", files=FILES, change=lambda lines: lines) -> str:
    return "\n".join(change([head, *(f"{f},{f[:3]},{f[4:8]},{mass}" for f in files)]))


def with_line(at: int, line: str) -> Callable[[list[str]], list[str]]:
    return lambda lines: [*lines[:at], line, *lines[at:]]


CONDITIONS = {
    "a comma in a cell": (
        conditions(change=with_line(2, "S01_hard.c3d,S01,hard,old,61")), "line 3 has 5 cells"
    ),
    "two columns of one name": (conditions("file,subject,subject,mass (kg)"), '"subject"'),
    "the unit in the cells": (conditions("file,subject,shoe,mass", "61 kg"), 'mass is "61 kg"'),
    "a row of units": (conditions(change=with_line(1, ",,,kg")), 'line 2: body mass is "kg"'),
    "the headings twice": (conditions(change=with_line(3, HEADING)), "line 4: body mass"),
    "mass in g": (conditions(mass="61000"), "10 to 300 kg"),
    "weight in N": (conditions(mass="598"), "10 to 300 kg"),
    "no mass": (conditions(mass="0"), "10 to 300 kg"),
    "another ending": (conditions(files=[f.replace("c3d", "csv") for f in FILES]), "none of its 4"),
    "semicolons below commas": (
        conditions(change=lambda rows: [rows[0], *(row.replace(",", ";") for row in rows[1:])]),
        "none of its 4 files",
    ),
    "headings only": (HEADING, "no row with a file"),
    "a title above": (conditions(change=with_line(0, "Study 2026,,,")), 'no column "file"'),
}  # fmt: skip


def noted(folder: Path, table: bytes) -> dict[str, object]:
    for name in FILES:
        (folder / name).touch()
    (folder / "conditions.csv").write_bytes(table)
    return dict(study_folder(folder).recordings[0].conditions)


@pytest.mark.parametrize("fault", CONDITIONS)
def test_a_fault_of_the_conditions_is_refused(fault, tmp_path):
    text, words = CONDITIONS[fault]
    with pytest.raises(InputError) as found:
        noted(tmp_path, text.encode())
    assert words in str(found.value)


GERMAN = conditions("Datei,Proband,Schuh,Gewicht (kg)", "61.5")
ENCODINGS = {
    "as it is": conditions(mass="61.5").encode(),
    "names without their ending": conditions(mass="61.5").replace(".c3d", "").encode(),
    "names in capitals": conditions(mass="61.5").replace(".c3d", ".C3D").encode(),
    "German": GERMAN.replace(",", ";").replace("61.5", "61,5").encode("latin-1"),
    "German, UTF-16": GERMAN.replace(",", ";").replace("61.5", "61,5").encode("utf-16"),
    "German, BOM, tabs": GERMAN.replace(",", "\t").replace("61.5", "61,5").encode("utf-8-sig"),
    "pounds": conditions("file,subject,shoe,mass (lb)", "135.584").encode(),
}


@pytest.mark.parametrize("case", ENCODINGS)
def test_the_persons_mass_is_found_in_any_spreadsheet(case, tmp_path):
    found = noted(tmp_path, ENCODINGS[case])
    (mass,) = [value for value in found.values() if isinstance(value, float)]
    assert mass == pytest.approx(61.5, abs=0.01)
    assert len(found) == 3


def test_the_table_of_a_report_in_the_folder_is_none_of_conditions(tmp_path):
    report = tmp_path / "report"
    report.mkdir()
    (report / "analysis.txt").touch()
    (report / "conditions.csv").write_text("persons,trials\n1,2")
    assert noted(tmp_path, conditions().encode())["shoe"] == "hard"


@pytest.mark.parametrize(("mass", "verdict"), [("45.8", "accepted"), ("60", "caution")])
def test_the_mass_of_the_conditions_is_used(mass, verdict, tmp_path):
    (tmp_path / WALK.name).symlink_to(WALK)
    (tmp_path / "conditions.csv").write_text(f"file,body mass (kg)\n{WALK.name},{mass}")
    (one,) = analyse_folder(tmp_path, protocol("level_walking"), processes=1).files
    assert one.verdict == verdict
    assert any("45.8 kg in the recording" in reason for reason in one.reasons) == (mass == "60")


# ------------------------------------------------------------- channels of a real walk
Change = Callable[[np.ndarray, Plate], np.ndarray]


@pytest.fixture(scope="module")
def walk() -> Trial:
    return read_trial(WALK)


def standing(force: np.ndarray) -> slice:
    on = np.flatnonzero(force[:, 2] > 20.0)
    return slice(int(on[0]), int(on[-1]))


def switched(force: np.ndarray, plate: Plate) -> np.ndarray:
    at = standing(force).start
    force[at + 30 : at + 150, :2] *= 1.4
    return force


def gains_of_two_halves(force: np.ndarray, plate: Plate) -> np.ndarray:
    stance = standing(force)
    middle = (stance.start + stance.stop) // 2
    force[middle:, :2] *= 2.0
    force[:middle, :2] *= 0.6
    return force


def one_cell_dead(force: np.ndarray, plate: Plate) -> np.ndarray:
    assert plate.corners is not None
    assert plate.centre_of_pressure is not None
    way = np.nan_to_num(plate.centre_of_pressure[:, 1]) - plate.corners[:, 1].min()
    force[:, 2] *= np.clip(1.0 - 0.5 * way / np.ptp(plate.corners[:, 1]), 0.0, 1.0)
    return force


def wrapped(force: np.ndarray, plate: Plate) -> np.ndarray:
    top = 0.8 * force[:, 2].max()
    force[:, 2] = (force[:, 2] + top) % (2 * top) - top
    return force


def slow(force: np.ndarray, plate: Plate) -> np.ndarray:
    for i in range(1, len(force)):
        force[i, :2] = force[i - 1, :2] + 0.04 * (force[i, :2] - force[i - 1, :2])
    return force


FORCES: dict[str, Change] = {
    "range switched in the stance": switched,
    "another gain in each half": gains_of_two_halves,
    "normal force wraps around": wrapped,
    "rectified shear": lambda f, _: f * [0, 0, 1] + np.abs(f) * [1, 1, 0],
    "the resultant for one component": lambda f, _: np.column_stack(
        (0 * f[:, 0], np.sign(f[:, 1]) * np.hypot(f[:, 0], f[:, 1]), f[:, 2])
    ),
    "one load cell dead": one_cell_dead,
    "one polarity weak": lambda f, _: np.where((f < 0) & [True, True, False], 0.4 * f, f),
    "a dead band": lambda f, _: np.where(np.abs(f) < 25.0, 0.0, f),
    "shear follows slowly": slow,
    "normal force too large at large loads": lambda f, _: (
        f * np.column_stack((f[:, :2] ** 0, 1 + 0.35 * f[:, 2] / f[:, 2].max()))
    ),
    "neighbouring samples exchanged": lambda f, _: f[np.arange(len(f)) ^ 1],
}


@pytest.mark.parametrize("fault", FORCES)
def test_a_fault_of_the_forces_is_noticed(walk, fault):
    plates = tuple(
        finished_plate(
            p.name, FORCES[fault](p.force.copy(), p), rate=p.rate, start=p.start,
            up=np.array([0.0, 0.0, 1.0]), corners=p.corners,
            centre_of_pressure=p.centre_of_pressure,
        )
        for p in walk.plates
    )  # fmt: skip
    for step in required_frictions(walkway_of(replace(walk, plates=plates))):
        right = abs((step.measurement.value or 0.0) - TRUTH[step.stance.plate]) < 0.015
        assert step.verdict != "accepted" or right


MARKERS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "a tenth of their size": lambda places: 0.1 * places,
    "mirrored": lambda places: places * [1, -1, 1],
    "backward in time": lambda places: places[::-1],
    "too large by 30 %": lambda places: 1.3 * places,
}


@pytest.mark.parametrize("fault", MARKERS)
def test_a_fault_of_the_markers_is_noticed(walk, fault):
    markers = {
        n: replace(m, positions=MARKERS[fault](m.positions)) for n, m in walk.markers.items()
    }
    steps = required_frictions(walkway_of(replace(walk, markers=markers)))
    assert "accepted" not in {step.verdict for step in steps}


# ------------------------------------------------------------- logs of a tester, as text
def cells(change: Callable[[list[str]], list[str]]) -> Callable[[str], str]:
    def changed(text: str) -> str:
        head, *rows = text.splitlines()
        return "\n".join([head, *(",".join(change(row.split(","))) for row in rows)])

    return changed


def part_of(change: Callable[[list[str], int], list[str]]) -> Callable[[str], str]:
    def changed(text: str) -> str:
        lines = text.splitlines()
        return "\n".join(change(lines, len(lines) // 2))

    return changed


LOGS: dict[str, tuple[Callable[[str], str], str]] = {
    "decimal commas between commas": (lambda text: text.replace(".", ","), "utf-8"),
    "no time": (
        lambda text: "\n".join(row.split(",", 1)[1] for row in text.splitlines()),
        "utf-8",
    ),
    "every row twice": (part_of(lambda rows, _: [rows[0], *np.repeat(rows[1:], 2)]), "utf-8"),
    "backward": (part_of(lambda rows, _: [rows[0], *rows[:0:-1]]), "utf-8"),
    "a block twice": (part_of(lambda rows, at: rows[:at] + rows[at - 150 :]), "utf-8"),
    "headings in the middle": (part_of(lambda rows, at: [*rows[:at], *rows[:1], *rows[at:]]), ""),
    "words for numbers": (
        part_of(
            lambda rows, at: [
                f"{row.split(',')[0]}{',OVL' * row.count(',')}" if at < i < at + 4 else row
                for i, row in enumerate(rows)
            ]
        ),
        "",
    ),
    "times of 10 ms": (cells(lambda row: [f"{float(row[0]):.2f}", *row[1:]]), ""),
    "forces of two digits": (
        cells(lambda row: [row[0], *(f"{float(c):.2g}" for c in row[1:])]), ""
    ),
    "zeros after the slide begins": (
        part_of(
            lambda rows, at: [
                f"{row.split(',')[0]}{',0' * row.count(',')}" if i > 1.2 * at else row
                for i, row in enumerate(rows)
            ]
        ),
        "",
    ),
}  # fmt: skip
SAME: dict[str, tuple[Callable[[str], str], str]] = {
    "German": (lambda text: text.replace(",", ";").replace(".", ","), "latin-1"),
    "German, UTF-16": (lambda text: text.replace(",", ";").replace(".", ","), "utf-16"),
    "BOM": (lambda text: text, "utf-8-sig"),
    "exponents": (cells(lambda row: [f"{float(cell):.6E}" for cell in row]), "utf-8"),
}


def log_of(folder: Path, how: tuple[Callable[[str], str], str]):
    log = sound_log(50003)
    write_log(log, folder)
    path = folder / "log.csv"
    path.write_bytes(how[0](path.read_text()).encode(how[1] or "utf-8"))
    (one,) = analyse_folder(folder, protocol(log.protocol), processes=1).files
    return one, log.cof


@pytest.mark.parametrize("fault", LOGS)
def test_a_fault_of_a_log_is_told(fault, tmp_path):
    one, _ = log_of(tmp_path, LOGS[fault])
    assert one.verdict != "accepted"
    assert one.reasons


@pytest.mark.parametrize("case", SAME)
def test_a_log_of_any_spreadsheet_gives_the_same(case, tmp_path):
    one, cof = log_of(tmp_path, SAME[case])
    assert one.verdict == "accepted"
    assert one.main["cof"] == pytest.approx(cof, abs=0.001)
