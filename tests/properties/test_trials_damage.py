"""A hundred and fifty damaged variants of each recording: no crash, no hang, no silent change.

Every file is tried in a process of its own, which reports the slowest variant, the largest memory
and every accepted step whose RCOF changed without a word.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

DATA = Path(__file__).parents[1] / "data" / "trials"
FILES = (
    "biomechzoo/HC030A05.c3d",
    "bmc/Gait.c3d",
    "btk/ADemo1_rewrite_c3d_pc_integer.c3d",
    "kineticstoolkit/c3d_sample.c3d",
    "opensim/walking5.c3d",
    "bmc/walk1.trc",
    "bmc/walk1.forces",
    "opensim/leg69_stance_grf.mot",
    "simulated/slip.c3d",
    "simulated/walk.csv",
)
VARIANTS = 75
TOLERANCE = 0.015


def damaged(data: bytes, text: bool, rng: np.random.Generator) -> bytes:
    """Cut, overwrite, flip, remove, insert or double; half of it in the first 4 kB."""
    size = len(data)
    near = min(size, 4096) if rng.random() < 0.5 else size
    at = int(rng.integers(0, near))
    kind = int(rng.integers(0, 9 if text else 7))
    changed = bytearray(data)
    if kind == 0:
        return data[:at]
    if kind == 1:
        for _ in range(int(rng.integers(1, 9))):
            changed[int(rng.integers(0, near))] = int(rng.integers(0, 256))
    elif kind == 2:
        changed[at] ^= 1 << int(rng.integers(0, 8))
    elif kind == 3:
        del changed[at : at + int(rng.integers(1, 600))]
    elif kind == 4:
        changed[at:at] = bytes(rng.integers(0, 256, int(rng.integers(1, 40))).astype(np.uint8))
    elif kind == 5:
        changed[at:at] = changed[at : at + 700]
    elif kind == 6:
        changed[at : at + 64] = bytes(64)
    else:
        lines = data.split(b"\n")
        row = int(rng.integers(0, len(lines)))
        cells = lines[row].split(b"\t" if b"\t" in lines[row] else b",")
        words = (b"nan", b"", b"1e999", b"#REF!", b"-", b"1,5", b"12.3.4", b"x", b"-99999")
        cells[int(rng.integers(0, len(cells)))] = words[int(rng.integers(0, len(words)))]
        lines[row] = (b"\t" if b"\t" in lines[row] else b",").join(cells)
        if kind == 8:
            lines.insert(row, lines[row])
        return b"\n".join(lines)
    return bytes(changed)


def _source(name: str, folder: Path) -> Path:
    from underfoot.trials import read_trial
    from underfoot.trials.simulator import Defects, SlipTruth, walk_c3d, walk_with_slip

    if not name.startswith("simulated"):
        return DATA / name
    path = folder / "source" / Path(name).name
    path.parent.mkdir(exist_ok=True)
    if name.endswith(".c3d"):
        recording = walk_with_slip(SlipTruth(), Defects(), np.random.default_rng(1))
        path.write_bytes(walk_c3d(recording))
        return path
    trial = read_trial(DATA / "biomechzoo" / "HC030A05.c3d", subtract_baseline=False)
    columns = {"time (s)": trial.plates[0].time}
    for number, plate in enumerate(trial.plates, start=1):
        columns |= {f"F{a}{number} (N)": plate.force[:, i] for i, a in enumerate("xyz")}
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, delimiter=",", header=",".join(columns), comments="", fmt="%.6g")
    return path


def tried(name: str, count: int, seed: int) -> dict[str, object]:
    """Try ``count`` variants of a file; return what went wrong, the slowest and the memory."""
    from underfoot.core import UnderfootError
    from underfoot.trials import described_file

    def seen(path: Path) -> tuple[list[tuple[str, float, float]], set[str]]:
        found, said = [], set()
        for one in described_file(path):
            one.as_dict()
            said |= {line.strip() for line in one.text().splitlines() if line.strip()[:1] in "!-"}
            said |= {s.measurement.reason for s in one.steps if s.measurement.value is None}
            for step in one.steps:
                if step.verdict == "accepted":
                    value = step.measurement.value or 0.0
                    found.append((step.stance.plate, step.stance.contact, value))
        return found, said

    rng = np.random.default_rng(seed)
    crashes, silent, slowest, read = [], [], 0.0, 0
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        source = _source(name, folder)
        data = source.read_bytes()
        truth, words = seen(source)
        path = folder / source.name
        text = source.suffix != ".c3d"
        for number in range(count):
            path.write_bytes(damaged(data, text, rng))
            begin = time.perf_counter()
            try:
                found, said = seen(path)
            except UnderfootError as error:
                if not error.what or "not foreseen" in error.what:
                    crashes.append(f"{number}: {error}")
                continue
            except Exception as error:
                crashes.append(f"{number}: {error!r}")
                continue
            finally:
                slowest = max(slowest, time.perf_counter() - begin)
            read += 1
            if said - words:
                continue
            for plate, contact, value in found:
                same = [v for p, t, v in truth if p == plate and abs(t - contact) < 0.1]
                if not same or abs(value - same[0]) > TOLERANCE:
                    silent.append(f"{number}: {plate} {contact:.3f} s {value:.3f}")
    # of this program alone: getrusage may hold the peak of the process that started it
    memory = int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1024.0
    return {"crashes": crashes, "silent": silent, "slowest": slowest, "MB": memory, "read": read}


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_damaged_recordings_end_in_an_answer(name):
    command = [sys.executable, __file__, name, str(VARIANTS), "11"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, done.stderr[-2000:]
    found = json.loads(done.stdout)
    assert found["crashes"] == []
    assert found["silent"] == []
    assert found["slowest"] < 20.0
    assert found["MB"] < 500.0


if __name__ == "__main__":
    print(json.dumps(tried(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))))
