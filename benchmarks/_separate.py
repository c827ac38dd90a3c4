"""Measuring in processes of their own."""

import json
import os
import subprocess
import sys
from pathlib import Path

THREADS = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")


def peak_memory() -> float:
    """Return the peak memory of this process so far, MB (Linux).

    ``getrusage`` would tell that of the parent where the parent's is larger.
    """
    status = Path("/proc/self/status").read_text()
    return int(status.split("VmHWM:")[1].split()[0]) / 1024


def separate(module: str, function: str, *given: object) -> dict[str, float]:
    """Return what a function of a benchmark returns in a process of its own, one thread."""
    code = (
        f"import json; from {module} import {function}; print(json.dumps({function}(*{given!r})))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | THREADS,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout.splitlines()[-1])
