"""Structured mesh of hexahedra: graded layers, a rough lower face, one-point mean gradients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from underfoot.core import InputError

from .inputs import MicroBlock, MicroSurface

CORNERS = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
)
SIGNS = 2.0 * CORNERS - 1.0
MODES = np.stack(
    [
        SIGNS[:, 0],
        SIGNS[:, 1],
        SIGNS[:, 2],
        SIGNS[:, 1] * SIGNS[:, 2],
        SIGNS[:, 0] * SIGNS[:, 2],
        SIGNS[:, 0] * SIGNS[:, 1],
        SIGNS.prod(axis=1),
    ]
)
"""Sign of each mode at each corner, (7, 8)."""
FEWEST_ELEMENTS = {"triangular": 2}
"""Elements a wavelength below which a form can't be drawn; 4 for all others."""


@dataclass(frozen=True, slots=True, eq=False)
class BlockMesh:
    """Nodes and elements; node (i, j, k) has the number (k ny1 + j) nx1 + i.

    Parameters:
        nodes: m, (3, n), undeformed; z = 0 is the mean plane of the lower face.
        shape: Nodes along x, y, z.
        elements: Number of the lowest corner's node of each element, (m,).
        volume: m^3, (m,).
        gradient: 1/m, (m, 3, 7): mean reference gradient by modes.
        hourglass_shape: m, (m, 4, 3): coordinates by non-linear modes, over 8.
        lower_area: m^2, (nx1 * ny1,): share of the nominal area; 0 on the sides that repeat others.
    """

    nodes: np.ndarray
    shape: tuple[int, int, int]
    elements: np.ndarray
    volume: np.ndarray
    gradient: np.ndarray
    hourglass_shape: np.ndarray
    lower_area: np.ndarray

    @property
    def offsets(self) -> np.ndarray:
        """Node numbers of the eight corners less the lowest one's."""
        nx, ny, _ = self.shape
        return CORNERS @ np.array([1, nx, nx * ny])

    @property
    def largest_gradient_square(self) -> np.ndarray:
        """Largest eigenvalue of B B^T in each element, 1/m^2."""
        return 8.0 * np.linalg.eigvalsh(self.gradient @ self.gradient.transpose(0, 2, 1))[:, -1]

    def deformed_gradient_square(self, displacement: np.ndarray) -> np.ndarray:
        """Return the same on the deformed shape; ``displacement`` (3, n), m."""
        corners = displacement[:, self.elements[:, None] + self.offsets]
        h = np.einsum("iea,qa,ejq->eij", corners, MODES, self.gradient)
        b = np.linalg.solve((np.eye(3) + h).transpose(0, 2, 1), self.gradient)
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
    fade = np.clip(1.0 - planes / depth, 0.0, None)
    z = planes[:, None, None] - fade[:, None, None] * heights
    nodes = np.stack([np.broadcast_to(xx, z.shape), np.broadcast_to(yy, z.shape), z])
    numbers = np.arange(z.size).reshape(z.shape)
    shape = (nx + 1, ny + 1, nz + 1)
    area = np.zeros((ny + 1, nx + 1))
    cell = block.size[0] / nx * block.size[1] / ny
    if block.sides == "periodic":
        area[:-1, :-1] = cell
    else:
        for a in (slice(0, -1), slice(1, None)):
            for b in (slice(0, -1), slice(1, None)):
                area[a, b] += 0.25 * cell
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


def mean_gradient(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return volumes (m,) and mean gradients by modes (m, 3, 7) of hexahedra, corners (m, 8, 3).

    2 x 2 x 2 Gauss points integrate the gradient of trilinear shape functions exactly.
    """
    point = 1.0 / np.sqrt(3.0)
    volume = np.zeros(len(corners))
    total = np.zeros((len(corners), 3, 8))
    for sign in SIGNS:
        t = point * sign
        factor = 1.0 + SIGNS * t
        local = np.empty((8, 3))
        for j in range(3):
            others = [k for k in range(3) if k != j]
            local[:, j] = SIGNS[:, j] * factor[:, others[0]] * factor[:, others[1]] / 8.0
        jacobian = np.einsum("eai,aj->eij", corners, local)
        weight = np.linalg.det(jacobian)
        volume += weight
        slopes = np.linalg.solve(jacobian.transpose(0, 2, 1), local.T[None])
        total += weight[:, None, None] * slopes
    return volume, np.einsum("eja,qa->ejq", total, MODES) / (8.0 * volume[:, None, None])


def check_pattern(block: MicroBlock, surface: MicroSurface, where: str) -> None:
    """Refuse a pattern that the block's mesh can't carry."""
    if not surface.rough or surface.form == "paraboloid":
        return
    axes = (0,) if surface.form == "wave" else (0, 1)
    if surface.form == "map":
        assert surface.height_map is not None
        lengths = surface.height_map.size
        shortest = surface.height_map.resolution or 2.0 * surface.height_map.spacing
    else:
        lengths = (surface.wavelength, surface.wavelength)
        shortest = surface.wavelength
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
        if surface.form != "map" and shortest / step < fewest * (1.0 - 1e-6):
            raise InputError(
                f"{shortest / step:.3g} elements a wavelength along {name}",
                where=where,
                allowed=f"{fewest} or more for the form {surface.form}",
                remedy=f"Use {int(np.ceil(size / shortest * 13))} elements along {name} or more",
            )
        waves = size / length
        if block.sides == "periodic" and abs(waves - round(waves)) > 1e-6 * waves:
            raise InputError(
                f"{waves:.6g} waves between periodic sides along {name}",
                where=where,
                allowed="a whole number",
            )
