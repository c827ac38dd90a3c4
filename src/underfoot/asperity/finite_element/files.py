"""Restart files and snapshots for ParaView; each is whole or absent."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from xml.sax.saxutils import quoteattr
from zipfile import BadZipFile

import numpy as np

from underfoot.core import DataError, MissingExtraError

from ._kernels import generate
from .assembly import Assembly
from .mesh import MODES


def saved_state(path: Path, arrays: dict[str, np.ndarray]) -> Path:
    """Write arrays to ``path`` and return it; an older file stays until the new one is whole."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
    try:
        with os.fdopen(handle, "wb") as stream:
            np.savez_compressed(stream, **arrays)  # pyright: ignore[reportArgumentType]  # arrays only
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    return path


def loaded_state(path: Path, key: str) -> dict[str, np.ndarray]:
    """Return the arrays of a restart file that was written for the same inputs.

    Errors
    ------
    DataError
        A file that can't be read, or that belongs to another case.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
    except (OSError, ValueError, EOFError, KeyError, BadZipFile) as problem:
        raise DataError(
            f"{path} can't be read as a restart file: {problem}",
            where="restart",
            remedy="Give a file that explicit_sliding wrote, or leave restart out",
        ) from problem
    if str(arrays.get("key", "")) != key:
        raise DataError(
            f"{path} belongs to another block, floor, material, loading or settings",
            where="restart",
            remedy="Restart with the inputs that the file was written with",
        )
    return arrays


def snapshot(path: Path, assembly: Assembly) -> Path:
    """Write the block as a VTU file: displacement, velocity, pressure, J, von Mises stress.

    Stresses are those of the fast (unrelaxed) response, Pa.
    """
    try:
        import meshio
    except ImportError as problem:
        raise MissingExtraError("meshio", "paraview", "writing snapshots") from problem
    mesh = assembly.mesh
    corners = mesh.elements[:, None] + mesh.offsets
    numbers = np.full(mesh.nodes.shape[1], -1)
    used = np.unique(corners)
    numbers[used] = np.arange(used.size)
    jac, mises = _stresses(assembly)
    bulk = float(assembly.parameters[generate.PARAMETERS.index("bulk")])
    lift = assembly.arrays[3][0] - mesh.nodes[2, 0]
    points = (mesh.nodes + assembly.displacement)[:, used].T
    points[:, 2] += lift
    written = meshio.Mesh(
        points,
        [("hexahedron", numbers[corners])],
        point_data={
            "displacement": assembly.displacement[:, used].T,
            "velocity": assembly.velocity[:, used].T,
        },
        cell_data={
            "pressure": [bulk * (1.0 - jac)],
            "volume_ratio": [jac],
            "von_mises_stress": [mises],
        },
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part.vtu")
    written.write(part, file_format="vtu")
    os.replace(part, path)
    return path


def collection(path: Path, times: list[float], files: list[str]) -> Path:
    """Write a ParaView collection (PVD) that gives each snapshot its time."""
    rows = "\n".join(
        f'    <DataSet timestep="{time:.9e}" file={quoteattr(name)}/>'
        for time, name in zip(times, files, strict=True)
    )
    text = (
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
        f"{rows}\n  </Collection>\n</VTKFile>\n"
    )
    part = path.with_suffix(".part")
    part.write_text(text, encoding="utf-8")
    os.replace(part, path)
    return path


def _stresses(assembly: Assembly) -> tuple[np.ndarray, np.ndarray]:
    """Return J and the von Mises equivalent of the isochoric Cauchy stress of each element."""
    mesh = assembly.mesh
    corners = assembly.displacement[:, mesh.elements[:, None] + mesh.offsets]
    f = np.eye(3) + np.einsum("iea,qa,ejq->eij", corners, MODES, mesh.gradient)
    jac = np.linalg.det(f)
    g0 = float(assembly.parameters[generate.PARAMETERS.index("g0")])
    left = f @ f.transpose(0, 2, 1)
    trace = np.trace(left, axis1=1, axis2=2)
    deviator = left - trace[:, None, None] / 3.0 * np.eye(3)
    stress = g0 * jac[:, None, None] ** (-5.0 / 3.0) * deviator
    return jac, np.sqrt(1.5 * np.sum(stress**2, axis=(1, 2)))
