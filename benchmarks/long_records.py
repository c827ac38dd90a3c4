"""Long recordings: CPU time and memory of ``describe`` against the size of a C3D file.

Two recorded walks that come with the tests, each repeated to a size: 291 points and 24 channels a
frame, and 33 points and 28 channels, both 100 Hz and two plates at 1000 Hz. Asked of 1 GB: 60 CPU
s, 1.5 GB, and a cost that grows as the size.
"""

import math
import sys
import tempfile
import time
from pathlib import Path

from underfoot.trials.readers.c3d import BLOCK, parse
from underfoot.trials.walking.describe import described_file

from ._separate import peak_memory, separate

_WALKS = Path(__file__).parents[1] / "tests/data/trials"
WALKS = {
    "291 points": _WALKS / "biomechzoo/HC030A05.c3d",
    "40 points": _WALKS / "opensim/walking5.c3d",
}
SIZES = (50, 200, 600)
CPU_LIMIT, MEMORY_LIMIT = 0.060, 1.5  # s/MB, MB/MB


def write_repeated(walk: Path, megabytes: float, out: Path) -> None:
    """Write a C3D file whose frames are those of a recorded walk again and again."""
    data = walk.read_bytes()
    raw = parse(data, walk.name)
    words = [int.from_bytes(data[2 * i : 2 * i + 2], "little") for i in range(10)]
    width = (4 * words[1] + words[2]) * 4
    begin = BLOCK * (words[8] - 1)
    frames = data[begin : begin + len(raw.points) * width]
    with out.open("wb") as file:
        file.write(data[:begin])
        for _ in range(max(round(1e6 * megabytes / len(frames)), 1)):
            file.write(frames)
        file.write(b"\0" * (-file.tell() % BLOCK))


def cost(path: str) -> dict[str, float]:
    """CPU time (s) and memory (MB) of a description and its text."""
    begin = time.process_time()
    (told,) = described_file(path)
    read = time.process_time() - begin
    text = told.text()
    return {
        "cpu": time.process_time() - begin,
        "described": read,
        "memory": peak_memory(),
        "steps": len(told.steps),
        "lines": text.count("\n"),
    }


def main(sizes: tuple[float, ...] = SIZES) -> None:
    """Print the table."""
    print(
        f"{'':<14}{'MB':>8}{'steps':>8}{'CPU s':>8}{'s/MB':>8}{'MB RAM':>8}{'MB/MB':>8}{'power':>8}"
    )
    with tempfile.TemporaryDirectory() as place:
        for name, walk in WALKS.items():
            before = None
            for size in sizes:
                path = Path(place) / "long.c3d"
                write_repeated(walk, size, path)
                mb = path.stat().st_size / 1e6
                found = separate("benchmarks.long_records", "cost", str(path))
                cpu, memory = found["cpu"], found["memory"]
                power = math.nan if before is None else math.log(cpu / before[1], mb / before[0])
                print(
                    f"{name:<14}{mb:>8.0f}{found['steps']:>8.0f}{cpu:>8.1f}{cpu / mb:>8.3f}"
                    f"{memory:>8.0f}{memory / mb:>8.2f}{power:>8.2f}",
                    flush=True,
                )
                before = mb, cpu
    print(f"asked: {CPU_LIMIT:g} s/MB and {MEMORY_LIMIT:g} MB/MB at 1 GB")


if __name__ == "__main__":
    main(tuple(float(size) for size in sys.argv[1:]) or SIZES)
