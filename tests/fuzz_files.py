"""Damage the files of every reader, and see that each is read as numbers or refused in words.

``python tests/fuzz_files.py COUNT SEED`` tries COUNT damaged files in this process, in turns of the
readers, and prints a line a reader and everything that was neither; it ends with 1 where there was
anything. A warning counts: a person would see it. Whole files are read first.
"""

from __future__ import annotations

import signal
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "properties"))
from test_trials_damage import damaged

from reader_files import MORE, SEEDS, refusal

SLOW = 20
"""s that no file may take."""


class Slow(Exception):
    """A file took too long."""


def _slow(*_: object) -> None:
    raise Slow


def main(count: int, seed: int) -> int:
    """Return 1 where a file was neither read nor refused in words."""
    generator, tried = np.random.default_rng(seed), Counter[tuple[str, str]]()
    readers, faults, spent = SEEDS | MORE, dict[str, str](), Counter[str]()
    signal.signal(signal.SIGALRM, _slow)
    with tempfile.TemporaryDirectory() as place:
        for number in range(-len(readers), count):
            name = list(readers)[number % len(readers)]
            make, read = readers[name]
            data, text = make(), Path(name).suffix in (".toml", ".csv", ".txt", ".json", ".trc")
            for _ in range(0 if number < 0 else 1 + (generator.random() < 0.3)):
                data = damaged(data, text, generator) or b"\0"
            path = Path(place) / name
            path.write_bytes(data)
            began = time.process_time()
            signal.alarm(SLOW)
            try:
                with warnings.catch_warnings(record=True) as told:
                    warnings.simplefilter("always")
                    warnings.simplefilter("ignore", ImportWarning)  # of a library's own choices
                    ending = "read" if refusal(read, path) is None else "refused"
                if told:
                    source = Path(told[0].filename)
                    raise told[0].category(f"{told[0].message} ({source.name}:{told[0].lineno})")
                assert ending == "read" or number >= 0, "a whole file is refused"
            except Exception as error:
                ending = "fault"
                place_of = f"{name}, {_place(error)}"
                if place_of not in faults:
                    faults[place_of] = f"{name}, input {number}: {type(error).__name__}: {error}"
                    kept = Path(f"fault_{number}_{name}")
                    kept.write_bytes(data)
            finally:
                signal.alarm(0)
            spent[name] += time.process_time() - began
            tried[name, ending] += 1
    for name in readers:
        counts = ", ".join(f"{tried[name, end]} {end}" for end in ("read", "refused", "fault"))
        print(f"{name}: {counts}; {spent[name]:.0f} s")
    for where, text in faults.items():
        print(f"FAULT {where}: {text[:300]}")
    print(f"{count} damaged files, {sum(n for (_, e), n in tried.items() if e == 'fault')} faults")
    return int(bool(faults))


def _place(error: BaseException) -> str:
    """Return the last line of this program that an error came through."""
    trace, last = error.__traceback__, ""
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if "underfoot" in file or not last:
            last = f"{Path(file).name}:{trace.tb_lineno}"
        trace = trace.tb_next
    return f"{last} {type(error).__name__}"


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), int(sys.argv[2])))
