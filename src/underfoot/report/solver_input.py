"""The sole of a result under its load, as an input file of Abaqus and CalculiX."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from underfoot.core import DataError

from .quantities import AREAS, raw, spacing
from .sole_export import Exported

if TYPE_CHECKING:
    from underfoot.compute.result import Result

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
EDGES = np.array([(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)])
"""Edges of a prism in the order of their middle nodes in C3D15; the first three of a triangle."""


def write_solver_input(result: Result, path: Path | str) -> Exported:
    """Write the sole as quadratic prisms bonded to the foot, with its load as forces on nodes.

    In N, mm and MPa, in the frame of the floor (z up). Sets of nodes: FOOT (held) and LAND; of
    elements: OUTSOLE, MIDSOLE. Each cell of contact and film loads the nodes of the land
    triangle below which it lies by their shape functions, upwards: load and centre of pressure are
    kept, the friction is left out. The rubber is linear elastic with the modulus of the run: small
    strain, as in the run itself.

    Parameters:
        result: A run with its fields, of a sole that the case can make again.
        path: The file, ``.inp``.

    Returns:
        What was written; its remark tells the load.

    Raises:
        DataError: A result without pressures, or cells that are not those of its case.
        InputError: A sole that can't be meshed (``finite_element_compliance``).
        MissingExtraError: No netgen (extra ``cad``).
    """
    from underfoot.case import Case
    from underfoot.compute.resolve import resolve_context
    from underfoot.compute.sole import sole_map
    from underfoot.sole_contact.finite_element import Layers, sole_prisms

    if not all(name in result.data for name in AREAS):
        raise DataError(
            "the result has no pressures on the sole",
            where=result.name,
            remedy="Run the case again with --out; its folder must hold result.nc",
        )
    case = Case.from_text(result.case_text)
    sole, context = sole_map(case, spacing(result.data)), resolve_context(case)
    load = sum(raw(result.data, name) * raw(result.data, area) for name, area in AREAS.items())
    load = np.asarray(load) * sole.spacing**2
    if load.shape != sole.clearance.shape:
        raise DataError(
            f"the cells of the result, {load.shape}, are not those of its case, "
            f"{sole.clearance.shape}",
            where=result.name,
            remedy="It was made by an older version: run the case again",
        )
    layers = context.shoe.sole
    midsole = layers.midsole.thickness if layers.midsole else 0.0
    angle = context.motion.shoe_angle
    mesh = sole_prisms(sole, Layers(layers.outsole_thickness, midsole, angle))
    nodes, prisms, land, foot = with_middle_nodes(mesh.nodes, mesh.prisms, mesh.land, mesh.foot)
    forces = forces_on_nodes(nodes, land, sole.x, sole.y, load)
    rubbers = {"OUTSOLE": (context.youngs_modulus, context.poisson_ratio)}
    if layers.midsole:
        rubbers["MIDSOLE"] = (layers.midsole.modulus, layers.midsole.poisson_ratio)
    lines = [
        f"** {result.name}: sole under {load.sum():.6g} N of contact and film, upwards",
        "** N, mm, MPa; floor's frame, z up, x forward; made by Underfoot",
        "*NODE, NSET=ALL",
        *_rows(np.arange(1, len(nodes) + 1), 1e3 * nodes),
    ]
    for number, name in enumerate(rubbers):
        chosen = np.flatnonzero(mesh.material == number)
        lines.append(f"*ELEMENT, TYPE=C3D15, ELSET={name}")
        lines += [", ".join(map(str, (k + 1, *(prisms[k] + 1)))) for k in chosen]
    for name, members in (("FOOT", foot), ("LAND", land)):
        lines += [f"*NSET, NSET={name}", *_wrap_numbers(np.unique(members) + 1)]
    for name, (modulus, ratio) in rubbers.items():
        lines += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{1e-6 * modulus:.9g}, {ratio:.9g}"]
        lines.append(f"*SOLID SECTION, ELSET={name}, MATERIAL={name}")
    loaded = np.flatnonzero(forces)
    lines += ["*BOUNDARY", "FOOT, 1, 3", "*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{k + 1}, 3, {forces[k]:.9g}" for k in loaded]
    lines += ["*NODE PRINT, NSET=FOOT, TOTALS=ONLY", "RF", "*NODE FILE", "U", "*EL FILE", "S, E"]
    path = Path(path)
    path.write_text("\n".join([*lines, "*END STEP", ""]), encoding="utf-8")
    fields = {"force on nodes": "N"}
    remark = f"{len(prisms)} prisms, {len(nodes)} nodes, load {load.sum():.4g} N"
    return Exported(path, "mm", "z up, x forward", "", fields, remark)


def with_middle_nodes(nodes: Floats, *bodies: Ints) -> tuple[Floats, *tuple[Ints, ...]]:
    """Return nodes (m, 3) with one in the middle of each edge, and each body of second order.

    A body is of prisms (n, 6) or triangles (n, 3), with their edges in the order of ``EDGES``.
    """
    ends = [np.sort(body[:, EDGES[: 3 if body.shape[1] == 3 else 9]], axis=2) for body in bodies]
    edges, place = np.unique(
        np.concatenate([end.reshape(-1, 2) for end in ends]), axis=0, return_inverse=True
    )
    parts = np.split(len(nodes) + place.ravel(), np.cumsum([end[..., 0].size for end in ends]))
    made = [np.hstack([body, part.reshape(len(body), -1)])
            for body, part in zip(bodies, parts, strict=False)]  # fmt: skip
    return np.vstack([nodes, nodes[edges].mean(axis=1)]), *made


def forces_on_nodes(nodes: Floats, land: Ints, x: Floats, y: Floats, load: Floats) -> Floats:
    """Return the force (N) on each node from the load (nx, ny) of cells (N).

    ``land``: triangles (n, 6) of second order. A cell loads the nodes of the triangle around its
    centre by their shape functions there; one beside all triangles loads the nearest corner.
    """
    from scipy.spatial import KDTree

    tri = import_module("matplotlib.tri")
    at = np.argwhere(load > 0)
    places, loads = np.column_stack([x[at[:, 0]], y[at[:, 1]]]), load[load > 0]
    members, local = np.unique(land[:, :3], return_inverse=True)
    plane = tri.Triangulation(*nodes[members, :2].T, local.reshape(-1, 3))
    found = plane.get_trifinder()(*places.T)
    inside = found >= 0
    around = land[found[inside]]
    first, *others = nodes[around[:, :3], :2].transpose(1, 0, 2)
    sides = np.stack([other - first for other in others], axis=-1)
    share = np.linalg.solve(sides, (places[inside] - first)[..., None])[..., 0]
    corner = np.column_stack([1 - share.sum(axis=1), share])
    shapes = np.hstack([corner * (2 * corner - 1), 4 * corner * np.roll(corner, -1, axis=1)])
    forces = np.zeros(len(nodes))
    np.add.at(forces, around, shapes * loads[inside, None])
    if not inside.all():
        nearest = members[KDTree(nodes[members, :2]).query(places[~inside])[1]]
        np.add.at(forces, nearest, loads[~inside])
    return forces


def _rows(numbers: Ints, values: Floats) -> Iterable[str]:
    return (f"{n}, " + ", ".join(f"{v:.9g}" for v in row)
            for n, row in zip(numbers, values, strict=True))  # fmt: skip


def _wrap_numbers(members: Ints) -> list[str]:
    """Return lines of sixteen numbers, as many as a line may hold."""
    return [", ".join(map(str, members[k : k + 16])) for k in range(0, len(members), 16)]
