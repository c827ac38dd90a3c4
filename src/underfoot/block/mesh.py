"""Structured mesh of hexahedra: graded layers, a rough lower face, one-point mean gradients."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from underfoot.core import InputError

from ._kernels.hexahedron import CORNERS, MODES, mean_gradient
from .inputs import MicroBlock, MicroSurface

FEWEST_ELEMENTS = {"triangular": 2}
"""Elements a wavelength below which a form can't be drawn; 4 for all others."""


@dataclass(frozen=True, slots=True, eq=False)
class BlockMesh:
    """Nodes and elements; node (i, j, k) has the number (k ny1 + j) nx1 + i."""

    nodes: np.ndarray  # m, (3, n), undeformed; z = 0 is the mean plane of the lower face
    shape: tuple[int, int, int]  # nodes along x, y, z
    elements: np.ndarray  # number of the lowest corner's node of each element, (m,)
    volume: np.ndarray  # m^3, (m,)
    gradient: np.ndarray  # 1/m, (m, 3, 7): mean reference gradient by modes
    hourglass_shape: np.ndarray  # m, (m, 4, 3): coordinates by non-linear modes, over 8
    lower_area: np.ndarray  # m^2, (nx1 * ny1,): share of the nominal area; 0 on sides that repeat

    @property
    def offsets(self) -> np.ndarray:
        """Node numbers of the eight corners less the lowest one's."""
        nx, ny, _ = self.shape
        return CORNERS @ np.array([1, nx, nx * ny])

    def deformation_gradient(self, displacement: np.ndarray) -> np.ndarray:
        """Return the mean F of each element, (m, 3, 3); ``displacement`` (3, n), m."""
        corners = displacement[:, self.elements[:, None] + self.offsets]
        return np.eye(3) + np.einsum("iea,qa,ejq->eij", corners, MODES, self.gradient)

    def largest_gradient_square(self, displacement: np.ndarray | None = None) -> np.ndarray:
        """Return the largest eigenvalue of B B^T in each element, 1/m^2, at rest or deformed."""
        b = self.gradient
        if displacement is not None:
            b = np.linalg.solve(self.deformation_gradient(displacement).transpose(0, 2, 1), b)
        return 8.0 * np.linalg.eigvalsh(b @ b.transpose(0, 2, 1))[:, -1]


def layer_heights(block: MicroBlock) -> np.ndarray:
    """Return the heights of the node planes, m, (nz + 1,): one ratio from layer to layer."""
    height, n, bottom = block.size[2], block.elements[2], block.bottom_layer
    if bottom is None or n == 1:
        return np.linspace(0.0, height, n + 1)

    def excess(ratio: float) -> float:
        return bottom * float(np.sum(ratio ** np.arange(n))) - height

    ratio: Any = brentq(excess, 1e-3, 1e3)
    if not 0.5 <= ratio <= 2.0:
        raise InputError(
            f"a bottom layer of {block.bottom_layer:g} m among {n} layers asks for a ratio of "
            f"{ratio:.3g} from layer to layer",
            where="MicroBlock.bottom_layer",
            allowed="a ratio of 0.5 to 2",
            remedy="Change the number of layers or the bottom layer's thickness",
        )
    steps = bottom * ratio ** np.arange(n)
    planes = np.concatenate([[0.0], np.cumsum(steps)])
    planes[-1] = height
    return planes


def block_mesh(block: MicroBlock) -> BlockMesh:
    """Return the mesh of a block.

    Raises:
        InputError: Wavelength longer than the block, elements too coarse for the roughness,
            roughness larger than the layers that carry it, or a pattern that does not repeat on
            periodic sides.
    """
    nx, ny, nz = block.elements
    check_pattern(block, block.roughness, "MicroBlock.roughness")
    x = np.linspace(0.0, block.size[0], nx + 1)
    y = np.linspace(0.0, block.size[1], ny + 1)
    planes = layer_heights(block)
    xx, yy = np.meshgrid(x, y, indexing="xy")
    heights = np.asarray(block.roughness.height(xx, yy))
    if block.sides == "periodic":
        heights[:, -1] = heights[:, 0]
        heights[-1, :] = heights[0, :]
    depth = planes[block.roughness_layers]
    if float(np.abs(heights).max()) > 0.75 * depth:
        raise InputError(
            f"roughness of {np.abs(heights).max():.3g} m about its mean on bottom layers of "
            f"{depth:.3g} m together",
            where="MicroBlock.roughness",
            allowed="at most 3/4 of the layers that it fades out over",
            remedy="Raise roughness_layers or bottom_layer",
        )
    fade = np.maximum(1.0 - planes / depth, 0.0)
    z = planes[:, None, None] - fade[:, None, None] * heights
    nodes = np.stack([np.broadcast_to(xx, z.shape), np.broadcast_to(yy, z.shape), z])
    numbers = np.arange(z.size).reshape(z.shape)
    shape = (nx + 1, ny + 1, nz + 1)
    cell = block.size[0] / nx * block.size[1] / ny
    shares = np.ones(ny + 1), np.ones(nx + 1)
    for share in shares:
        share[[0, -1]] = (1.0, 0.0) if block.sides == "periodic" else 0.5
    area = cell * np.outer(*shares)
    elements = numbers[:-1, :-1, :-1].ravel()
    flat = nodes.reshape(3, -1)
    offsets = CORNERS @ np.array([1, shape[0], shape[0] * shape[1]])
    corners = flat[:, elements[:, None] + offsets].transpose(1, 2, 0)
    volume, gradient = mean_gradient(corners)
    if not float(volume.min()) > 0.0:
        raise InputError(
            "the roughness turns elements inside out",
            where="MicroBlock.roughness",
            remedy="Raise roughness_layers or bottom_layer",
        )
    shapes = np.einsum("qa,eaj->eqj", MODES[3:], corners) / 8.0
    return BlockMesh(flat, shape, elements, volume, gradient, shapes, area.ravel())


def check_pattern(block: MicroBlock, surface: MicroSurface, where: str) -> None:
    """Refuse a pattern that the block's mesh can't carry."""
    if not surface.rough or surface.form == "paraboloid":
        return
    axes = (0,) if surface.form == "wave" else (0, 1)
    lengths = (surface.wavelength, surface.wavelength)
    if surface.form == "map":
        assert surface.height_map is not None
        lengths = surface.height_map.size
    for axis in axes:
        name = "xy"[axis]
        size, length = block.size[axis], lengths[axis]
        step = size / block.elements[axis]
        if length > size * (1.0 + 1e-9) and surface.form != "map":
            raise InputError(
                f"a wavelength of {length:g} m on a block of {size:g} m along {name}",
                where=where,
                allowed=f"at most {size:g} m",
                remedy="The report prints 4 and 5 mm for a block of 0.8 mm; 0.4 and 0.5 mm fit",
            )
        fewest = FEWEST_ELEMENTS.get(surface.form, 4)
        if surface.form != "map" and length / step < fewest * (1.0 - 1e-6):
            raise InputError(
                f"{length / step:.3g} elements a wavelength along {name}",
                where=where,
                allowed=f"{fewest} or more for the form {surface.form}",
                remedy=f"Use {int(np.ceil(size / length * 13))} elements along {name} or more",
            )
        waves = size / length
        if block.sides == "periodic" and abs(waves - round(waves)) > 1e-6 * waves:
            raise InputError(
                f"{waves:.6g} waves between periodic sides along {name}",
                where=where,
                allowed="a whole number",
            )
