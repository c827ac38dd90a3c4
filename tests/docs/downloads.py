"""Runs what built pages of the gallery offer, as a reader would: files alone in an empty folder.

``python tests/docs/downloads.py out/docs`` runs every script, notebook and TOML file of the gallery
of a site that ``make docs`` made; names after it choose pages.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from urllib.parse import unquote

CELLS = """import json
names = {"__name__": "__main__"}
for cell in json.load(open("FILE"))["cells"]:
    if cell["cell_type"] == "code":
        exec(cell["source"], names)
"""


def offered(page: Path) -> list[Path]:
    """Return the files that a built page offers."""
    links = re.findall(r'href="(\.\./_downloads/[^"]+)"', page.read_text("utf-8"))
    return [page.parent / unquote(link) for link in links]


def command(file: Path) -> list[str]:
    """Return how a reader runs a file; a notebook's cells go one after the other."""
    if file.suffix == ".toml":
        program = str(Path(sys.executable).with_name("underfoot"))
        is_study = "\n[vary]" in file.read_text("utf-8")
        return [program, *(["study"] if is_study else []), "check", file.name]
    if file.suffix == ".ipynb":
        return [sys.executable, "-c", CELLS.replace("FILE", file.name)]
    return [sys.executable, file.name]


def problems(page: Path) -> dict[str, str]:
    """Run each script, notebook and TOML file of a page; return what went wrong, "" if nothing.

    Beside a script or notebook lie only the page's data: they write their TOML files themselves.
    """
    files = offered(page)
    result = {}
    for file in files:
        if file.suffix not in (".py", ".ipynb", ".toml"):
            continue
        beside = [each for each in files if (each.suffix == ".toml") == (file.suffix == ".toml")]
        with tempfile.TemporaryDirectory() as folder:
            for each in {file, *(e for e in beside if e.suffix not in (".py", ".ipynb"))}:
                shutil.copy(each, folder)
            done = subprocess.run(
                command(file), cwd=folder, capture_output=True, text=True, check=False,
                env={**os.environ, "MPLBACKEND": "Agg", "PYTHONPATH": ""},
            )  # fmt: skip
            wrong = done.stderr or done.stdout if done.returncode else ""
            if not wrong and file.suffix == ".py" and not list(Path(folder).glob("*.png")):
                wrong = "no picture"
            result[file.name] = wrong
    return result


if __name__ == "__main__":
    gallery = Path(sys.argv[1]) / "gallery"
    bad = 0
    for page in sorted(gallery.glob("*.html")):
        if page.stem == "index" or (sys.argv[2:] and page.stem not in sys.argv[2:]):
            continue
        for name, wrong in problems(page).items():
            print(f"{name}: {wrong or 'runs'}", flush=True)
            bad += bool(wrong)
    sys.exit(bad > 0)
