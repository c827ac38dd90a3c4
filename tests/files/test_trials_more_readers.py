"""Exports of motion-capture, pose and insole systems; encodings; damaged files."""

import subprocess
import sys

import numpy as np
import pytest

from trial_exports import EXPORTS, FORCE, HEEL, LOAD
from underfoot.core import DataError
from underfoot.trials import read_trial, read_trials


@pytest.fixture
def exports(tmp_path):
    for name, made in EXPORTS.items():
        (tmp_path / name).write_bytes(made())
    return tmp_path


@pytest.mark.parametrize(
    ("name", "source", "marker"),
    [
        ("walk.tsv", "Qualisys TSV", "LHEE"),
        ("walk.csv", "Vicon CSV", "LHEE"),
        ("arrays.mat", "MATLAB", "LHEE"),
        ("qtm.mat", "Qualisys MATLAB", "LHEE"),
        ("pose.json", "JSON", "LHeel"),
        ("open.json", "JSON", "LHeel"),
    ],
)
def test_markers_are_in_metres(exports, name, source, marker):
    trial = read_trial(exports / name)
    assert trial.source == source
    found = trial.markers[marker]
    step = round(500 / found.rate)
    expected = HEEL[::step]
    seen = np.isfinite(found.positions).all(axis=1)
    assert seen.sum() >= len(expected) - 1
    assert found.positions[seen] == pytest.approx(expected[seen], abs=1e-6)


@pytest.mark.parametrize("name", ["walk_f_1.tsv", "walk.csv", "arrays.mat", "qtm.mat", "new.mat"])
def test_forces_are_those_on_the_foot(exports, name):
    trial = read_trial(exports / name, subtract_baseline=False)
    (plate,) = trial.plates
    assert plate.usable
    assert plate.rate == pytest.approx(500)
    assert np.abs(plate.force) == pytest.approx(np.abs(FORCE), abs=1e-3)
    # Pushing forward: shear along and vertical force keep their relation in sign.
    along = plate.force[:, 0] * np.sign(plate.force[:, 2].sum())
    assert along == pytest.approx(FORCE[:, 0], abs=1e-3)


def test_insoles(exports):
    pedar = read_trial(exports / "anna.asc")
    assert pedar.channel("left insole, largest pressure").values == pytest.approx(
        100 * LOAD, abs=60
    )
    assert pedar.channel("right 99").values == pytest.approx(5e3)
    assert pedar.channel("right insole, largest pressure").unit == "Pa"
    fscan = read_trial(exports / "anna.asf")
    force = fscan.channel("insole, force").values
    assert force == pytest.approx([10e3 * i * 0.00508**2 for i in range(20)])
    centre = fscan.channel("insole, centre along rows").values
    assert centre[1:] == pytest.approx(0.00508)
    assert any("20 saturated" in note for note in fscan.notes)


def test_points_in_pixels_are_refused(tmp_path):
    (tmp_path / "a.json").write_text('{"frames": [{"people": [{"pose_keypoints_2d": [1, 2, 1]}]}]}')
    with pytest.raises(DataError, match="pixels"):
        read_trial(tmp_path / "a.json")
    (tmp_path / "a.json").write_text('{"version": 1.3, "people": []}')
    with pytest.raises(DataError, match="single frame"):
        read_trial(tmp_path / "a.json")


def test_xls_is_read_as_xlsx(tmp_path):
    # The smallest BIFF workbook: written by hand, as no kept package writes XLS.
    from underfoot.trials.readers.sheet import workbook_sheets

    with pytest.raises(DataError, match="workbook is damaged"):
        workbook_sheets(b"\xd0\xcf\x11\xe0" + bytes(600), "old.xls")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-8-sig"])
@pytest.mark.parametrize("name", ["walk.tsv", "walk.csv", "pose.json", "anna.asc", "anna.asf"])
def test_every_encoding_gives_the_same_numbers(exports, name, encoding):
    plain = read_trial(exports / name)
    text = (exports / name).read_bytes().decode()
    (exports / name).write_bytes(text.encode(encoding))
    wide = read_trial(exports / name)
    assert set(wide.channels) == set(plain.channels)
    assert set(wide.markers) == set(plain.markers)
    for key, channel in plain.channels.items():
        assert np.array_equal(wide.channels[key].values, channel.values, equal_nan=True)


@pytest.mark.parametrize("folder", ["cetr", "pcs"])
def test_tribometer_logs_in_utf16(folder, tmp_path, request):
    source = request.path.parents[1] / "data" / "trials" / folder
    path = next(
        p
        for p in sorted(source.iterdir())
        if p.suffix in (".txt", ".csv") and "LICEN" not in p.name
    )
    data = path.read_bytes()
    text = data.decode("utf-8", errors="strict") if b"\xb5" not in data else data.decode("latin-1")
    (tmp_path / path.name).write_bytes(text.encode("utf-16"))
    plain, wide = read_trials(path), read_trials(tmp_path / path.name)
    assert [t.source for t in wide] == [t.source for t in plain]
    for one, two in zip(plain, wide, strict=True):
        assert set(one.channels) == set(two.channels)


def test_rows_of_a_pcs_log_that_are_left_out_are_named(tmp_path, request):
    source = request.path.parents[1] / "data" / "trials" / "pcs"
    path = next(p for p in sorted(source.iterdir()) if p.suffix == ".txt" and "LICEN" not in p.name)
    lines = path.read_text(encoding="latin-1").split("\n")
    at = max(i for i, line in enumerate(lines) if line.count("\t") > 8 and line[0].isdigit())
    cells = lines[at].split("\t")
    lines[at] = "\t".join(["#REF!", *cells[1:]])
    (tmp_path / path.name).write_text("\n".join(lines), encoding="latin-1")
    trials = read_trials(tmp_path / path.name)
    assert any("#REF!" in note for trial in trials for note in trial.notes)


def damaged(data: bytes, rng: np.random.Generator) -> bytes:
    kind = rng.integers(8)
    out = bytearray(data)
    if kind == 0:
        return bytes(out[: rng.integers(1, len(out))])
    if kind == 1:
        for at in rng.integers(0, len(out), 5):
            out[at] = rng.integers(256)
    elif kind == 2:
        for at in rng.integers(0, min(len(out), 400), 3):
            out[at] = rng.integers(256)
    elif kind == 3:
        at = int(rng.integers(0, len(out)))
        del out[at : at + int(rng.integers(1, 200))]
    elif kind == 4:
        return bytes(out) + bytes(out)
    elif kind == 5:
        return bytes(out).replace(b".", b",")
    elif kind == 6:
        at = int(rng.integers(0, len(out)))
        out[at:at] = (
            b"#REF!" if rng.random() < 0.5 else bytes(rng.integers(0, 256, 50, dtype=np.uint8))
        )
    else:
        return bytes(out).replace(b"1", b"99999999999", int(rng.integers(1, 9)))
    return bytes(out)


FUZZ = """
import sys, time, warnings, numpy as np
sys.path[:0] = sys.argv[1:2]
from pathlib import Path
from underfoot.core import UnderfootError
from underfoot.trials import read_trials
warnings.simplefilter("ignore")
slowest = 0.0
for path in sorted(Path(sys.argv[2]).iterdir()):
    begin = time.monotonic()
    try:
        read_trials(path)
    except UnderfootError as error:
        assert str(error)
    slowest = max(slowest, time.monotonic() - begin)
    assert time.monotonic() - begin < 20, path
# of this program alone: the highest that getrusage knows may be that of the process before it
peak = int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0]) / 1024
assert peak < 500, peak
print(slowest, peak)
"""


@pytest.mark.study
def test_760_damaged_files(tmp_path):
    rng = np.random.default_rng(7)
    folder = tmp_path / "bad"
    folder.mkdir()
    for name, made in EXPORTS.items():
        data = made()
        for number in range(20 if name.endswith(".mat") else 100):
            (folder / f"{number:03d}_{name}").write_bytes(damaged(data, rng))
    done = subprocess.run(
        [sys.executable, "-c", FUZZ, "", str(folder)], capture_output=True, text=True, timeout=900
    )
    assert done.returncode == 0, done.stderr[-3000:]
