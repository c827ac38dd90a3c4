"""Make the program as a folder that needs no Python, and hold it to what it is for.

python packaging/bundle.py           make out/bundle/underfoot
python packaging/bundle.py --check   start its app, fetch a page, compute a quick case; no Python
"""

import http.cookiejar
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "out" / "bundle"
PROGRAM = FOLDER / "underfoot" / ("underfoot.exe" if sys.platform == "win32" else "underfoot")
EXTRAS = ("", "app", "cad", "study", "trials", "paraview", "recordings")
"""Extras of the package that the program has; MKL (``fast``) would add 400 MB."""
LEFT_OUT = (
    "babel", "dask", "distributed", "duckdb", "hypothesis", "netgen", "ngsolve", "playwright",
    "pyngcore", "pyright", "pytest", "sklearn", "sphinx", "SurfaceTopography", "tkinter", "torch",
    "uvloop", "zstandard", "PIL._avif",
)  # fmt: skip
"""Packages that the program does without; NGSolve (STEP, finite elements) would add 250 MB."""
UNUSED = ("aggrid", "codemirror", "echart", "json_editor", "mermaid", "plotly", "xterm")
"""Elements of NiceGUI that no page has: 18 MB of scripts."""
STRIPPED = 3e5
"""Bytes of a library from which its symbols are taken out."""


def make() -> None:
    """Make the folder: every module and data file, and the versions that results name."""
    import PyInstaller.__main__

    options = ["--name=underfoot", "--noconfirm", "--log-level=WARN", "--onedir"]
    options += [
        f"--distpath={FOLDER}",
        f"--workpath={ROOT / 'build'}",
        f"--specpath={ROOT / 'build'}",
    ]
    for name in ("underfoot", "SALib", "pymoo.functions"):  # parts are imported by name
        options += [f"--collect-submodules={name}"]
    options += ["--collect-data=underfoot", "--collect-data=nicegui", "--copy-metadata=underfoot"]
    for line in metadata.requires("underfoot") or ():
        name, extra = re.match(r"[\w.-]+", line), re.search(r"extra == .(\w+)", line)
        if name and (extra[1] if extra else "") in EXTRAS and name[0] not in LEFT_OUT:
            options += [f"--recursive-copy-metadata={name[0]}"]
    options += [f"--hidden-import={name}" for name in _optional()]
    options += [f"--exclude-module={name}" for name in LEFT_OUT]
    PyInstaller.__main__.run([*options, str(ROOT / "packaging" / "launch.py")])
    for name in UNUSED:
        shutil.rmtree(FOLDER / "underfoot" / "_internal" / "nicegui" / "elements" / name)
    if sys.platform == "linux" and (strip := shutil.which("strip")):
        for library in FOLDER.rglob("*.so*"):
            # these were patched and would break
            patched = library.resolve().parent.name.endswith(".libs") or "pool" in library.name
            if not patched and library.stat().st_size > STRIPPED:
                subprocess.run([strip, library], check=True)
    size = sum(path.stat().st_size for path in FOLDER.rglob("*") if not path.is_symlink())
    print(f"{FOLDER / 'underfoot'}: {size / 1e6:.0f} MB")


def _optional() -> list[str]:
    """Return the modules that are imported by name where they are installed."""
    texts = [path.read_text("utf-8") for path in (ROOT / "src").rglob("*.py")]
    found = set(re.findall(r'optional_module\(\s*"([\w.]+)"', "".join(texts)))
    found |= {f"matplotlib.backends.backend_{form}" for form in ("agg", "pdf", "svg")}
    return sorted(name for name in found if name.partition(".")[0] not in LEFT_OUT)


def check() -> None:
    """Start the app of the bundle and fetch its first page; compute a case on the quick grid."""
    with tempfile.TemporaryDirectory() as folder:
        bare = {"HOME": folder, "PATH": "", "SYSTEMROOT": os.environ.get("SYSTEMROOT", "")}
        command = [PROGRAM, "app", f"{folder}/project", "--port", "0", "--no-browser"]
        began = time.monotonic()
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=bare)
        assert process.stdout is not None
        try:
            link = next(m[0] for line in process.stdout if (m := re.search(r"http\S+", line)))
            link = re.sub("//[^:]+", "//127.0.0.1", link)  # Python knows no names below localhost
            cookies = urllib.request.HTTPCookieProcessor(http.cookiejar.CookieJar())
            page = urllib.request.build_opener(cookies).open(link, timeout=60).read().decode()
            assert "Underfoot" in page, page[:500]
            print(f"its first page after {time.monotonic() - began:.1f} s")
        finally:
            process.terminate()
            process.wait()
            process.stdout.close()
        case = ROOT / "examples" / "work_shoe_untreaded_glycerol.toml"
        out = f"{folder}/out"
        subprocess.run([PROGRAM, "run", case, "--quick", "--out", out], check=True, env=bare)
        assert all((Path(out) / name).exists() for name in ("result.nc", "report.html"))
    print("the bundle serves its page and computes")


if __name__ == "__main__":
    check() if "--check" in sys.argv else make()
