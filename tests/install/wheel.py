"""Install the wheel as a person would and run the main example, on newest and lowest versions.

    python tests/install/wheel.py

Builds the wheel, then for each leg makes a fresh environment without the lock and without extras
(so without MKL and numba), and runs the example as a process that does not see the repository.
"""

import csv
import json
import os
import subprocess
import sys
import tempfile
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
EXAMPLE = "work_shoe_untreaded_glycerol.toml"
FILES = ("case.toml", "report.html", "result.json", "result.nc", "summary.csv")
LARGEST_MB = 430
SAME = 1e-3  # relative difference of the friction of two legs
EVERY_HELP = """
from typer.main import get_command
from typer.testing import CliRunner

from underfoot.cli.app import app


def names(group, above=()):
    for name in group.list_commands(None):
        command = group.get_command(None, name)
        yield (*above, name)
        if hasattr(command, "list_commands"):
            yield from names(command, (*above, name))


every = list(names(get_command(app)))
for words in every:
    ended = CliRunner().invoke(app, [*words, "--help"])
    assert ended.exit_code == 0, (words, ended.output)
print(len(every))
"""
"""Asks each command for its help: none needs an extra for that."""
ARM = [f"--platform=manylinux_2_{minor}_aarch64" for minor in (17, 26, 27, 28, 34)]
PIP = ("-m", "pip", "--disable-pip-version-check", "--quiet")


def call(*command, code=0, **options):
    """Run a command that ends with ``code``; its output is shown only when it does not."""
    environment = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("PYTHON", "UNDERFOOT_", "VIRTUAL_ENV"))
    }
    environment["UNDERFOOT_CACHE"] = str(options["cwd"] / "cache")
    ended = subprocess.run(
        [str(part) for part in command],
        env=environment, text=True, capture_output=True, timeout=600, check=False, **options,
    )  # fmt: skip
    if ended.returncode != code:
        said = f"{ended.stdout[-3000:]}\n{ended.stderr[-3000:]}"
        raise SystemExit(f"exit {ended.returncode}: {' '.join(map(str, command))}\n{said}")
    return ended.stdout if code == 0 else ended.stderr


def lowest_versions():
    """Return the dependencies of the project, each at its lowest allowed version."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    assert all(">=" in line and "," not in line for line in project["dependencies"])
    return [line.replace(">=", "==") for line in project["dependencies"]]


def leg(name, wheel, pinned, folder):
    """Install the wheel with the pinned versions, run the example and return its friction."""
    began = time.monotonic()
    folder.mkdir()
    call(sys.executable, "-m", "venv", folder / "venv", cwd=folder)
    scripts = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
    bare = folder_size(folder / "venv")
    python = scripts / "python"
    call(python, *PIP, "install", "--no-compile", "--prefer-binary", wheel, *pinned, cwd=folder)
    size = folder_size(folder / "venv") - bare
    (folder / EXAMPLE).write_bytes((REPOSITORY / "examples" / EXAMPLE).read_bytes())
    installed = time.monotonic() - began
    call(scripts / "underfoot", "run", EXAMPLE, "--quick", "--out", "out", cwd=folder)
    missing = [file for file in FILES if not (folder / "out" / file).stat().st_size]
    assert not missing, f"{name}: empty {missing}"
    with (folder / "out" / "summary.csv").open(newline="") as stream:
        (cof,) = (float(row["value"]) for row in csv.DictReader(stream) if row["quantity"] == "cof")
    versions = json.loads((folder / "out" / "result.json").read_text())["provenance"]["versions"]
    # a unit that needs the unit library, which the example does not
    call(
        python,
        "-c",
        "from underfoot.core import to_si; to_si('1 km/h', 'm/s', where='')",
        cwd=folder,
    )
    doctor = call(scripts / "underfoot", "doctor", cwd=folder)
    assert "superlu" in doctor, doctor
    helped = call(python, "-c", EVERY_HELP, cwd=folder)
    missing = call(scripts / "underfoot", "app", "project", "--no-browser", code=5, cwd=folder)
    assert 'pip install "underfoot[app]"' in missing, missing
    assert size < LARGEST_MB, f"{name}: {size:.0f} MB, more than {LARGEST_MB} MB"
    print(
        f"{name}: COF {cof:.6f}, {size:.0f} MB, help of {helped.strip()} commands, "
        f"numpy {versions['numpy']}, scipy {versions['scipy']}; "
        f"{installed:.0f} s of {time.monotonic() - began:.0f} s to install"
    )
    return cof


def folder_size(folder):
    """Return the size of a folder's files in MB."""
    return sum(file.lstat().st_size for file in folder.rglob("*") if file.is_file()) / 1e6


def resolved_on_arm(wheel, folder):
    """Check that each dependency has a wheel for Linux on ARM."""
    folder.mkdir()
    call(
        sys.executable, *PIP, "install", "--dry-run", "--target", folder, "--only-binary=:all:",
        *ARM, wheel, cwd=folder,
    )  # fmt: skip
    print("Linux on ARM: each dependency has a wheel")


def main():
    """Build, then both legs and the look at ARM side by side."""
    with tempfile.TemporaryDirectory(prefix="underfoot-wheel-") as made:
        folder = Path(made)
        build = (*PIP, "wheel", "--no-deps", "--wheel-dir", folder, REPOSITORY)
        call(sys.executable, *build, cwd=folder)
        (wheel,) = folder.glob("underfoot-*.whl")
        # wheels of the lowest versions exist for the lowest Python alone
        lowest = sys.version_info[:2] == (3, 11)
        with ThreadPoolExecutor(2) as pool:
            legs = [pool.submit(leg, "newest versions", wheel, (), folder / "newest")]
            if lowest:
                pinned = lowest_versions()
                legs.append(pool.submit(leg, "lowest versions", wheel, pinned, folder / "lowest"))
            resolved_on_arm(wheel, folder / "arm")
            cofs = [job.result() for job in legs]
        if not lowest:
            print(f"NOT RUN on Python {sys.version.split()[0]}: the lowest versions (Python 3.11)")
        assert abs(cofs[0] - cofs[-1]) < SAME * cofs[0], f"the legs disagree: {cofs}"


if __name__ == "__main__":
    main()
