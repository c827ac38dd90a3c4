"""Surface compliance of a meshed sole: elasticity of second order, condensed to the land."""

from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, cast

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from underfoot.core import InputError, Progress, silent
from underfoot.core.remark import Message
from underfoot.core.sparse import schur_complement, upper_triangle

from .mesh import SoleMesh

Array = NDArray[np.float64]
VOLUME_ORDER = 2
"""Of the integration of the change in volume. At 4, which is exact, a block of nu = 0.49 is 4 to
7 % too stiff; so its compression is within 2 % of that by elements of order 4."""
LARGEST_POISSON_RATIO = 0.495
"""Displacement elements of second order lock above it."""


@dataclass(frozen=True, slots=True)
class Rubber:
    """Young's modulus (Pa) and Poisson's ratio of a layer."""

    modulus: float
    poisson_ratio: float


@dataclass(frozen=True, slots=True)
class LandCompliance:
    """What the land does under pressures that vary linearly between its nodes.

    A pressure sum_j p_j f_j(x, y), f_j the hat of land node j, in Pa per area of the floor, normal
    to the floor. ``work[i, j]`` (m^3/Pa) is the integral of f_i times the rise of the land under
    f_j: symmetric. ``area`` (m^2) is the integral of f_i, ``overlap`` that of f_i f_j, all over the
    floor's plane.

    ``nodes`` (n, 2) in m; ``triangles`` (m, 3) indices of nodes.
    """

    nodes: Array
    height: Array
    triangles: NDArray[np.int64]
    work: Array
    unknowns: int
    area: Array = field(init=False)
    overlap: sp.csr_matrix = field(init=False)

    def __post_init__(self) -> None:
        a, b, c = (self.nodes[self.triangles[:, n]] for n in range(3))
        size = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
        count = len(self.nodes)
        each = np.repeat(size / 3, 3)
        area = np.bincount(self.triangles.ravel(), each, minlength=count).astype(float)
        rows = np.repeat(self.triangles, 3, axis=1).ravel()
        columns = np.tile(self.triangles, (1, 3)).ravel()
        values = (size[:, None] * (np.ones((3, 3)) + np.eye(3)).ravel() / 12).ravel()
        overlap = sp.csr_matrix((values, (rows, columns)), shape=(count, count))
        object.__setattr__(self, "area", area)
        object.__setattr__(self, "overlap", overlap)


def land_compliance(
    mesh: SoleMesh,
    outsole: Rubber,
    midsole: Rubber | None,
    *,
    loaded: NDArray[np.bool_] | None = None,
    progress: Progress = silent,
) -> LandCompliance:
    """Return the compliance of the land of a mesh, bonded to a rigid foot at its top.

    Small strain, second-order prisms: work = B^T K^-1 B with K the stiffness and B the loads of the
    hats of the land nodes; K is first condensed to the unknowns that B loads. ``loaded`` (land
    triangles) leaves out land that will never touch.
    """
    for layer in (outsole, midsole):
        if layer is not None and layer.poisson_ratio > LARGEST_POISSON_RATIO:
            raise InputError(
                Message(
                    "Poisson's ratio {poisson_ratio} makes these finite elements lock",
                    poisson_ratio=layer.poisson_ratio,
                ),
                where="poisson_ratio",
                allowed=Message("at most {most}", most=LARGEST_POISSON_RATIO),
                remedy='Use compliance.model = "layered"',
            )
    from scipy.linalg import cho_factor, cho_solve

    progress("Condensing the sole to its land", 0.0)
    stiffness, load = _assemble(mesh, outsole, midsole)
    if loaded is None:
        loaded = np.ones(len(mesh.land), bool)
    chosen = mesh.land[loaded]
    vertices, triangles = np.unique(chosen, return_inverse=True)
    triangles = triangles.reshape(chosen.shape)
    # mm^3/MPa to m^3/Pa, shared evenly between the two factors of the work
    right = sp.csr_matrix(load[:, vertices]) * np.sqrt(1e-15)
    right.eliminate_zeros()  # the assembly also stores the sideways parts, all 0
    retained = np.flatnonzero(np.diff(right.indptr))
    progress("Condensing the sole to its land", 0.3)
    unknowns = int(stiffness.indptr.size) - 1
    upper = upper_triangle(stiffness)
    del stiffness  # a fifth of the memory during the factorization
    surface = schur_complement(
        upper, retained, kind="positive definite", where="sole_contact.finite_element"
    )
    progress("Condensing the sole to its land", 0.9)
    factor = cho_factor(surface, overwrite_a=True)
    carried = sp.csr_matrix(right[retained]).toarray()
    work = carried.T @ cho_solve(factor, carried)
    return LandCompliance(
        mesh.nodes[vertices, :2],
        mesh.nodes[vertices, 2],
        triangles,
        0.5 * (work + work.T),
        unknowns,
    )


def _assemble(
    mesh: SoleMesh, outsole: Rubber, midsole: Rubber | None
) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """Return the stiffness of the free unknowns and their loads by the hats of all nodes.

    Lengths in mm and stresses in MPa inside, so that the matrix is of order one.
    """
    import ngsolve

    body = _ngsolve_mesh(mesh)
    space = ngsolve.VectorH1(body, order=2, dirichlet="foot")
    displacement, test = space.TnT()

    def lame(layer: Rubber) -> tuple[float, float]:
        modulus, ratio = layer.modulus * 1e-6, layer.poisson_ratio
        return modulus / (2 * (1 + ratio)), modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))

    pairs = [lame(outsole), lame(midsole or outsole)]
    shear = body.MaterialCF({"outsole": pairs[0][0], "midsole": pairs[1][0]})
    bulk = body.MaterialCF({"outsole": pairs[0][1], "midsole": pairs[1][1]})

    def strain(field: Any) -> Any:
        gradient = ngsolve.Grad(field)
        return 0.5 * (gradient + gradient.trans)

    form = ngsolve.BilinearForm(space, symmetric=True)
    form += 2 * shear * ngsolve.InnerProduct(strain(displacement), strain(test)) * ngsolve.dx
    few = ngsolve.IntegrationRule(ngsolve.PRISM, VOLUME_ORDER)
    volume = ngsolve.dx(intrules={ngsolve.PRISM: few})
    form += bulk * ngsolve.div(displacement) * ngsolve.div(test) * volume
    form.Assemble()
    free = np.array([bool(bit) for bit in cast(Any, space.FreeDofs())])
    values, columns, starts = form.mat.CSR()
    matrix = sp.csr_matrix(
        (np.asarray(values), np.asarray(columns), np.asarray(starts)), shape=(len(free), len(free))
    )
    if (matrix - matrix.T).nnz and abs(matrix - matrix.T).max() > 1e-9 * abs(matrix).max():
        lower = sp.tril(matrix)
        matrix = sp.csr_matrix(lower + sp.tril(lower, -1).T)
    stiffness = sp.csr_matrix(matrix[free][:, free])

    scalar = ngsolve.H1(body, order=1, definedon=body.Boundaries("land"))
    hat = scalar.TrialFunction()
    up = ngsolve.specialcf.normal(3)[2]
    mixed = ngsolve.BilinearForm(trialspace=scalar, testspace=space)
    mixed += ngsolve.IfPos(up, up, -up) * hat * test[2] * ngsolve.ds("land")
    mixed.Assemble()
    rows, columns, values = mixed.mat.COO()
    full = sp.csr_matrix(
        (np.asarray(values), (np.asarray(rows), np.asarray(columns))),
        shape=(len(free), scalar.ndof),
    )

    return stiffness, sp.csr_matrix(full[free])


def _ngsolve_mesh(mesh: SoleMesh) -> Any:
    import ngsolve

    meshing: Any = import_module("netgen.meshing")
    body = meshing.Mesh()
    body.dim = 3
    points = [body.Add(meshing.MeshPoint(meshing.Pnt(*(1e3 * node)))) for node in mesh.nodes]
    body.SetMaterial(1, "outsole")
    if mesh.material.any():
        body.SetMaterial(2, "midsole")
    names = {1: ("land", 1), 2: ("foot", int(mesh.material.max()) + 1)}
    for number, (name, domain) in names.items():
        body.Add(meshing.FaceDescriptor(surfnr=number, domin=domain, domout=0, bc=number))
        body.SetBCName(number - 1, name)
    for prism, material in zip(mesh.prisms, mesh.material, strict=True):
        body.Add(meshing.Element3D(int(material) + 1, [points[n] for n in prism]))
    for number, triangles in ((1, mesh.land), (2, mesh.foot)):
        for triangle in triangles:
            body.Add(meshing.Element2D(number, [points[n] for n in triangle]))
    return ngsolve.Mesh(body)
