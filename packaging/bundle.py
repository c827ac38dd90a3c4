"""Make the program as a folder that needs no Python, and hold it to what it is for.

python packaging/bundle.py           make out/bundle/underfoot
python packaging/bundle.py --check   start its app, fetch a page, compute a quick case
"""

import http.cookiejar
import re
import subprocess
import sys
import tempfile
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "out" / "bundle"
PROGRAM = FOLDER / "underfoot" / ("underfoot.exe" if sys.platform == "win32" else "underfoot")
LEFT_OUT = ("torch", "pytest", "playwright", "sphinx", "pyright", "SurfaceTopography", "babel")
"""Packages of this environment that the program does without."""


def make() -> None:
    """Make the folder: every module and data file, and the versions that results name."""
    import PyInstaller.__main__

    options = ["--name=underfoot", "--noconfirm", "--log-level=WARN", "--onedir"]
    options += [
        f"--distpath={FOLDER}",
        f"--workpath={ROOT / 'build'}",
        f"--specpath={ROOT / 'build'}",
    ]
    options += ["--collect-submodules=underfoot"]
    for wing in sorted((ROOT / "wings").iterdir()):
        options += [f"--collect-submodules=underfoot_{wing.name}"]
        options += [f"--collect-data=underfoot_{wing.name}"]
        options += [f"--copy-metadata=underfoot-{wing.name.replace('_', '-')}"]
    options += ["--collect-data=underfoot"]
    options += ["--collect-data=nicegui", "--recursive-copy-metadata=underfoot"]
    options += [f"--exclude-module={name}" for name in LEFT_OUT]
    PyInstaller.__main__.run([*options, str(ROOT / "packaging" / "launch.py")])
    size = sum(path.stat().st_size for path in FOLDER.rglob("*") if not path.is_symlink())
    print(f"{FOLDER / 'underfoot'}: {size / 1e6:.0f} MB")


def check() -> None:
    """Start the app of the bundle and fetch its first page; compute a case on the quick grid."""
    with tempfile.TemporaryDirectory() as folder:
        command = [PROGRAM, "app", f"{folder}/project", "--port", "0", "--no-browser"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        assert process.stdout is not None
        try:
            link = next(m[0] for line in process.stdout if (m := re.search(r"http\S+", line)))
            cookies = urllib.request.HTTPCookieProcessor(http.cookiejar.CookieJar())
            page = urllib.request.build_opener(cookies).open(link, timeout=60).read().decode()
            assert "Underfoot" in page, page[:500]
        finally:
            process.terminate()
            process.wait()
            process.stdout.close()
        case = ROOT / "examples" / "work_shoe_untreaded_glycerol.toml"
        out = f"{folder}/out"
        subprocess.run([PROGRAM, "run", case, "--quick", "--out", out], check=True)
        assert (Path(out) / "result.nc").exists()
    print("the bundle serves its page and computes")


if __name__ == "__main__":
    check() if "--check" in sys.argv else make()
