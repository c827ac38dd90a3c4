"""One table of all jobs: cost beside a physical limit and an error, kept and drawn over versions.

A benchmark module takes part with ``rows()``, which returns its ``Row``s.
"""

from __future__ import annotations

import csv
import subprocess
import time
from dataclasses import asdict, dataclass, fields
from pathlib import Path

HISTORY = Path(__file__).parent / "history.csv"
PICTURE = Path("out/benchmarks.png")


@dataclass(frozen=True, slots=True)
class Row:
    """What one job took.

    Attributes:
        job: Its name, the same in every version.
        cpu: Seconds of processor time, one thread.
        memory: Peak of its process, MB; None where the process did other jobs too.
        limit: Seconds that its transforms alone take in the same run, or None.
        growth: Exponent of the cost over cells, where it was measured on two grids.
        error: Deviation in percent of its leading number from ``reference``.
        reference: What the error is against.
    """

    job: str
    cpu: float
    memory: float | None = None
    limit: float | None = None
    growth: float | None = None
    error: float | None = None
    reference: str = ""


def printed(rows: list[Row]) -> str:
    """Return the table as text."""
    head = f"{'job':45} {'CPU s':>7} {'MB':>6} {'limit s':>8} {'ratio':>6} {'growth':>7} error"
    lines = [head]
    for row in rows:
        ratio = None if row.limit is None else row.cpu / row.limit
        error = "" if row.error is None else f"{row.error:+.2f} % of {row.reference}"
        lines.append(
            f"{row.job:45} {row.cpu:7.2f} {_text(row.memory, '6.0f')} {_text(row.limit, '8.3f')} "
            f"{_text(ratio, '6.1f')} {_text(row.growth, '7.2f')} {error}".rstrip()
        )
    return "\n".join([*lines, "limit: the job's Fourier transforms alone, timed in the same run"])


def keep(rows: list[Row]) -> None:
    """Add the rows to the history, each with day and version."""
    names = [field.name for field in fields(Row)]
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    ).stdout.strip()
    new = not HISTORY.exists()
    with HISTORY.open("a", newline="") as stream:
        writer = csv.DictWriter(stream, ["day", "commit", *names], lineterminator="\n")
        if new:
            writer.writeheader()
        for row in rows:
            numbers = {
                name: f"{value:.4g}" if isinstance(value, float) else value
                for name, value in asdict(row).items()
            }
            writer.writerow({"day": time.strftime("%Y-%m-%d"), "commit": commit, **numbers})


def draw() -> Path | None:
    """Draw the history, a line for each job, and return the picture; None without a history."""
    from matplotlib import colormaps
    from matplotlib.figure import Figure

    if not HISTORY.exists():
        return None
    with HISTORY.open() as stream:
        entries = list(csv.DictReader(stream))
    versions = list(dict.fromkeys(entry["commit"] for entry in entries))
    figure = Figure(figsize=(9, 5), layout="constrained")
    axes = figure.add_subplot()
    axes.set_prop_cycle(color=colormaps["tab20"](range(20)))
    for job in dict.fromkeys(entry["job"] for entry in entries):
        own = [entry for entry in entries if entry["job"] == job]
        places = [versions.index(entry["commit"]) for entry in own]
        axes.plot(places, [float(entry["cpu"]) for entry in own], marker="o", label=job)
    axes.set(yscale="log", ylabel="processor time (s)", xlabel="version")
    for axis_format in (axes.yaxis.set_major_formatter, axes.yaxis.set_minor_formatter):
        axis_format("{x:g}")
    axes.set_xticks(range(len(versions)), versions, rotation=45)
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside right upper", frameon=False, fontsize=8)
    PICTURE.parent.mkdir(exist_ok=True)
    figure.savefig(PICTURE, dpi=120)
    return PICTURE


def _text(value: float | None, form: str) -> str:
    return " " * int(form.split(".")[0]) if value is None else format(value, form)
