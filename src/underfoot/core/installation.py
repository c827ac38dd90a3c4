"""State of the installation: versions, libraries in use, missing packages and their remedy."""

import os
import platform
import re
import sys
import tempfile
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path

from .cache import default_folder
from .catalogue import Catalogue, catalogue_folders, offered_catalogues
from .device import described_card
from .fourier import fourier_library
from .identity import UNKNOWN, package_version
from .mkl import mkl_library
from .registry import OWN, all_offers, broken_offers
from .sparse import back_end

# module, package, extra, what it is for
_OPTIONAL = (
    ("mkl", "mkl", "fast", "faster sparse systems and Fourier transforms"),
    ("numba", "numba", "fast", "compiled kernels; soles from files, the block of finite elements"),
    ("netgen", "ngsolve", "cad", "STEP, compliance by finite elements"),
    ("trimesh", "trimesh", "cad", "writing solids"),
    ("emcee", "emcee", "study", "the law of a pair from others' measurements"),
    ("SurfaceTopography", "SurfaceTopography", "instruments", "files of surface instruments"),
    ("nicegui", "nicegui", "app", "the app in the browser, underfoot app"),
    ("meshio", "meshio", "paraview", "snapshots of the block for ParaView"),
)
_GAIN = "; MKL would save 10 to 30 % of a run, the numbers stay the same"
_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


def installation() -> list[tuple[str, str]]:
    """Return the state of the installation as (label, text)."""
    rows = [
        ("underfoot", package_version("underfoot")),
        ("python", f"{platform.python_version()} ({sys.executable})"),
        ("system", f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors"),
        *((name, _required_version(name)) for name in _dependencies()),
        *(_optional(*row) for row in _OPTIONAL),
        # measured on the work shoe in glycerol, grid of 1 mm, one thread
        ("sparse solver", back_end() + ("" if mkl_library() else _GAIN)),
        ("Fourier transform", fourier_library()),
        ("graphics card", described_card()),
        *((name, os.environ.get(name, "not set")) for name in _THREADS),
        ("cache", _cache(default_folder())),
    ]
    rows += [("extension", str(offer)) for offer in all_offers() if offer.package != OWN]
    rows += [("broken extension", line) for line in (*broken_offers(), *offered_catalogues())]
    folders = catalogue_folders(Path.cwd())
    rows.append(("catalogue", f"{len(Catalogue.load(folders).entries)} entries"))
    return rows + [("catalogue folder", str(folder)) for folder in folders]


def _dependencies() -> list[str]:
    """Return the packages that this one cannot do without."""
    try:
        lines = metadata.requires("underfoot") or []
    except metadata.PackageNotFoundError:
        lines = ["numpy", "scipy", "xarray"]
    needed = [line for line in lines if "extra ==" not in line]
    return [re.split(r"[^\w.-]", line, maxsplit=1)[0] for line in needed]


def _required_version(name: str) -> str:
    """Return the version; a package without one may still load, as in a frozen application."""
    version = package_version(name)
    if version == UNKNOWN and find_spec(name.replace("-", "_")) is None:
        return "MISSING; remedy: install underfoot again"
    return version


def _optional(module: str, package: str, extra: str, purpose: str) -> tuple[str, str]:
    missing = mkl_library() is None if module == "mkl" else find_spec(module) is None
    if missing:
        return package, f'not installed ({purpose}); remedy: pip install "underfoot[{extra}]"'
    return package, f"{package_version(package)} ({purpose})"


def _cache(folder: Path) -> str:
    files = [path for path in folder.rglob("*") if path.is_file()] if folder.is_dir() else []
    size = sum(path.stat().st_size for path in files) / 1e6
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        return f"{folder}: CANNOT BE WRITTEN ({reason}); remedy: set UNDERFOOT_CACHE to a folder"
    return f"{folder}: writable, {len(files)} files, {size:.1f} MB"
