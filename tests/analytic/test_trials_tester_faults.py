"""Logs of slip testers: faults are noticed or leave the number right, and sound logs are accepted.

`tests/trial_testers.py` makes both and scores them on more seeds.
"""

import numpy as np
import openpyxl
import pytest

from trial_testers import (
    DATE,
    FAULTS,
    NOTICED,
    PROFILE,
    RIGHT,
    SILENT,
    faulty_outcome,
    outcome,
    sound_log,
    write_log,
)
from underfoot.core import InputError
from underfoot.trials.machines.tester_checks import log_kind
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.recording.tester_calibration import FAILED, read_calibration
from underfoot.trials.simulator import simulated_folder
from underfoot.trials.study import analyse_folder

SEEDS = (7001, 7002, 7003)


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_noticed_or_leaves_the_number_right(fault, tmp_path):
    seeds = set(SEEDS) - {SEEDS[list(FAULTS).index(fault) % 3]}  # two, not always the same
    found = [faulty_outcome(fault, seed, tmp_path / str(seed)) for seed in sorted(seeds)]
    assert found.count(SILENT) == 0, found


def test_there_are_more_than_seventy_faults():
    assert len(FAULTS) >= 70


@pytest.mark.slow
def test_sound_logs_are_accepted_and_right(tmp_path):
    logs = [sound_log(seed) for seed in range(7100, 7180)]
    found = [outcome(log, log.cof, tmp_path / str(log.seed)) for log in logs]
    assert SILENT not in found
    assert found.count(NOTICED) <= 2  # 2.5 %
    assert found.count(RIGHT) >= 78


def test_the_tester_of_the_report_is_not_doubted(tmp_path):
    simulated_folder("tester", tmp_path, count=3, seed=4)
    analysis = analyse_folder(tmp_path, protocol("report_g4"), processes=1)
    assert {one.verdict for one in analysis.files} == {"accepted"}


@pytest.mark.parametrize("name", ["level_walking", "report_g6"])
def test_a_slide_is_no_walk(name, tmp_path):
    write_log(sound_log(3), tmp_path)
    (one,) = analyse_folder(tmp_path, protocol(name), processes=1).files
    assert one.verdict == "refused"
    assert "slide of a slip tester" in one.reasons[0]
    assert "en_iso_13287" in one.reasons[0]


def test_steps_of_the_package_are_walks(tmp_path):
    (path,) = simulated_folder("slips", tmp_path, count=1)
    from underfoot.trials import read_trial

    trial = read_trial(path)
    assert log_kind(trial.plates[0], np.array([0.0, 0.0, 1.0])) == "walk"


RECORD = """
[tester]
name = "STM"
certificate = "K-1"
date = 2026-01-15
[channels.friction]
reference = ["0 N", "10 kg", "20 kg"]
reading = ["2 N", "100.0665 N", "198.133 N"]
uncertainty = "0.3 %"
"""


def record(tmp_path, text=RECORD):
    path = tmp_path / "calibration.toml"
    path.write_text(text)
    return read_calibration(path)


def test_a_record_gives_factor_and_uncertainty(tmp_path):
    found = record(tmp_path)
    # 10 kg weigh 98.0665 N at standard gravity; the zero of 2 N is no gain.
    assert found.channel("friction").factor == pytest.approx(1.0, abs=1e-9)
    assert found.channel("friction").uncertainty == pytest.approx(0.003, rel=1e-6)
    assert found.channel("normal").factor == 1.0
    low = record(tmp_path, RECORD.replace("100.0665", "51.03325").replace("198.133", "100.0665"))
    assert low.channel("friction").factor == pytest.approx(2.0, rel=1e-9)


def test_factor_and_uncertainty_reach_the_cof(tmp_path):
    log = sound_log(12)
    write_log(log, tmp_path)
    plain = analyse_folder(tmp_path, protocol(log.protocol), processes=1).files[0]
    path = tmp_path / "calibration.toml"
    text = path.read_text().replace("99.9 N", "50 N").replace("300.2 N", "150 N")
    text = text.replace("599.8 N", "300 N").replace(f'range = "{log.friction_range} N"', "")
    path.write_text(text.split("[[checks]]")[0])
    twice = analyse_folder(tmp_path, protocol(log.protocol), processes=1).files[0]
    assert twice.main["cof"] == pytest.approx(2.0 * plain.main["cof"], rel=2e-3)
    m = plain.measurements[0]
    assert m.uncertainty >= m.value * 0.002 * np.sqrt(2.0)
    assert "certificate K-117 of 2026-01-15" in m.conventions["calibration"]


def test_without_a_record_the_study_says_so_once(tmp_path):
    log = sound_log(12)
    for number in range(3):
        write_log(sound_log(12 + number), tmp_path, record=False, name=f"log{number}.csv")
    analysis = analyse_folder(tmp_path, protocol(log.protocol), processes=1)
    told = [doubt for doubt in analysis.doubts if "calibration record" in doubt.message]
    assert len(told) == 1
    assert "no record" in analysis.files[0].measurements[0].conventions["calibration"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("2026-01-15", '"15 January"'), "is no date"),
        (("reading = ", "readings = "), 'unknown key "readings"'),
        (("[channels.friction]", "[channels.frictoin]"), "friction"),
        (('uncertainty = "0.3 %"', ""), "no uncertainty"),
        (('"198.133 N"', '"150 N"'), "rising line"),
        (('"198.133 N"', '"198.133"'), "reading|unit"),
        (('"20 kg"]', "]"), "equal length"),
    ],
)
def test_a_wrong_record_is_refused_with_the_place(change, words, tmp_path):
    with pytest.raises(InputError, match=words) as caught:
        record(tmp_path, RECORD.replace(*change))
    assert "calibration.toml" in str(caught.value)


def test_a_check_of_the_day_is_judged_both_ways(tmp_path):
    for error, failed in ((1.0, False), (1.019, False), (0.981, False), (1.03, True), (0.97, True)):
        check = f"""
[[checks]]
date = 2026-03-12
channel = "friction"
reference = "20 kg"
reading = "{error * 196.133} N"
"""
        flags = record(tmp_path, RECORD + check).flags(DATE)
        assert [flag.name for flag in flags] == ([FAILED] if failed else [])
        assert record(tmp_path, RECORD + check).flags("12.03.2026") == flags


@pytest.mark.parametrize(
    ("heading", "factor"),
    [
        ("speed (mm/s)", 1e3),
        ("Geschwindigkeit (m/min)", 60.0),
        ("velocity (in/s)", 1 / 0.0254),
        ("Speed (ft/min)", 60 / 0.3048),
    ],
)
@pytest.mark.parametrize(("share", "verdict"), [(1.0, "accepted"), (1 / 3, "refused")])
def test_a_speed_is_judged_in_the_units_of_testers(tmp_path, heading, factor, share, verdict):
    """A shoe that slid at 0.1 m/s was accepted where the log was in feet a minute or German."""
    log = next(log for log in map(sound_log, range(7100, 7180)) if "speed (m/s)" in log.columns)
    speed = log.columns.pop("speed (m/s)")
    log.columns[heading] = share * factor * speed
    write_log(log, tmp_path)
    (one,) = analyse_folder(tmp_path, protocol("en_iso_13287"), processes=1).files
    assert one.verdict == verdict
    assert one.facts["sliding_speed"] == pytest.approx(0.3 * share, rel=0.02)


def test_a_speed_in_no_known_unit_is_said(tmp_path):
    log = next(log for log in map(sound_log, range(7100, 7180)) if "speed (m/s)" in log.columns)
    log.columns["speed (knots)"] = log.columns.pop("speed (m/s)")
    write_log(log, tmp_path)
    (one,) = analyse_folder(tmp_path, protocol("en_iso_13287"), processes=1).files
    assert one.verdict == "caution"
    assert "no known unit of speed" in str(one.reasons)


@pytest.mark.slow
def test_every_sheet_of_a_workbook_is_a_slide(tmp_path):
    """The second of two slides was lost; only `describe` named its sheet."""
    logs = [log for log in map(sound_log, range(7100, 7180)) if "speed (m/s)" in log.columns]
    logs = [log for log in logs if "normal force (N)" in log.columns][:2]
    book = openpyxl.Workbook(write_only=True)
    book.create_sheet("Info").append(["operator", "A"])
    for number, log in enumerate(logs, start=1):
        sheet = book.create_sheet(f"Run {number}")
        sheet.append(list(log.columns))
        for row in zip(*log.columns.values(), strict=True):
            sheet.append([float(value) for value in row])
    book.save(tmp_path / "runs.xlsx")
    (tmp_path / "profile.toml").write_text(PROFILE, encoding="utf-8")
    files = analyse_folder(tmp_path, protocol("en_iso_13287"), processes=1).files
    found = [file.main["cof"] for file in files]
    assert found == pytest.approx([log.cof for log in logs], rel=0.01)
