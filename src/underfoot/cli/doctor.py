"""``underfoot doctor``: what is installed and how it is set up."""

from __future__ import annotations

from pathlib import Path

_PACKAGES = ("numpy", "scipy", "pydantic", "pint", "tomlkit", "typer", "rich", "xarray", "h5netcdf")
_EXTRAS = {"SurfaceTopography": "surface instruments' files (underfoot[instruments])"}
_THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


def doctor() -> None:
    """Print versions, threads, the sparse solver, the cache and which extras are there."""
    for label, value in findings():
        print(f"{label:22} {value}")


def findings() -> list[tuple[str, str]]:
    """Return what was found, as (label, words)."""
    import os
    import platform
    import sys
    from importlib.util import find_spec

    from underfoot.core.cache import default_folder
    from underfoot.core.catalogue import Catalogue, catalogue_folders
    from underfoot.core.provenance import version

    found = [
        ("underfoot", version()),
        ("python", f"{platform.python_version()} ({sys.executable})"),
        ("system", f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors"),
        *((name, _installed(name)) for name in _PACKAGES),
    ]
    found += [(name, os.environ.get(name, "not set")) for name in _THREADS]
    found.append(("sparse solver", _solver()))
    folder = default_folder()
    found.append(("cache", f"{folder}, {_size(folder)}"))
    folders = catalogue_folders(Path.cwd())
    known = Catalogue.load(folders)
    found.append(("catalogue", f"{len(known.entries)} entries"))
    found += [("catalogue folder", str(one)) for one in folders]
    for name, purpose in _EXTRAS.items():
        state = _installed(name) if find_spec(name) else "not installed"
        found.append((name, f"{state}: {purpose}"))
    return found


def _installed(name: str) -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(name)
    except PackageNotFoundError:
        return "missing: install underfoot again"


def _solver() -> str:
    from underfoot.film import available_backends

    names = available_backends()
    return f"{names[0]}" + ("" if len(names) == 1 else f" (also {', '.join(names[1:])})")


def _size(folder: Path) -> str:
    if not folder.is_dir():
        return "empty"
    files = [path for path in folder.rglob("*") if path.is_file()]
    return f"{len(files)} files, {sum(path.stat().st_size for path in files) / 1e6:.1f} MB"
