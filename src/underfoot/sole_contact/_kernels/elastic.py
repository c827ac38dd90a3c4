"""Surface deflection under pressure: symbols of layers, coefficients of the half-space."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from underfoot.core.arrays import Array
from underfoot.core.fourier import fourier_library
from underfoot.core.fourier import transform as prepared_transform
from underfoot.core.sparse import factorization
from underfoot.shoe.slits import Slits


def bonded_layer_symbol(
    wavenumber: Array, modulus: float, poisson_ratio: float, thickness: float
) -> Array:
    """Return deflection over pressure (m/Pa) of a layer bonded to a rigid base.

    C(k) = 2 (1 - nu^2) / (E k) ((3 - 4 nu) sinh 2q - 2q)
           / ((3 - 4 nu) cosh 2q + 2 q^2 + 5 - 12 nu + 8 nu^2),   q = k T

    with the limit T (1 + nu)(1 - 2 nu) / (E (1 - nu)) at k = 0 (Johnson, Contact Mechanics, 1985,
    section 5.8; the half-space 2 (1 - nu^2)/(E k) at large q).
    """
    k = np.asarray(wavenumber, dtype=float)
    nu = poisson_ratio
    q = np.clip(k * thickness, 1e-3, 40.0)
    ratio = ((3 - 4 * nu) * np.sinh(2 * q) - 2 * q) / (
        (3 - 4 * nu) * np.cosh(2 * q) + 2 * q * q + 5 - 12 * nu + 8 * nu * nu
    )
    return 2 * (1 - nu**2) * thickness / modulus * ratio / np.maximum(k * thickness, 1e-3)


def free_sided_symbol(
    wavenumber: Array, modulus: float, poisson_ratio: float, uniform: float
) -> Array:
    """Return deflection over pressure (m/Pa) of a block with free sides.

    1 / (1 / f + E* k / 2): a uniform pressure compresses the block by f (m/Pa, its mean over the
    face), a short wave meets the half-space. Positive in real space.
    """
    plane = modulus / (1 - poisson_ratio**2)
    return 1 / (1 / uniform + 0.5 * plane * np.asarray(wavenumber, dtype=float))


BONDED_END = 0.945
"""Compression of a block against the parabolic flow below: the bonded end holds it back. Found from
finite elements of order 4 of single blocks, +-2 % for area / (perimeter height) from 0.4 to 1.5."""


NEAREST = 1e-3
"""Cells: a free side is taken to be no nearer to a cell's centre."""


def block_compression(
    mask: NDArray[np.bool_],
    spacing: float,
    height: Array,
    modulus: float,
    poisson_ratio: float,
    edges: tuple[Array | float, Array | float] = (0.5, 0.5),
    slits: Slits | None = None,
) -> Array:
    """Return the deflection (m/Pa) of blocks under a uniform pressure, 0 outside the mask.

    The blocks cover ``mask`` (nx, ny), are ``height`` (nx, ny, m) high, bonded at their base, free
    at their sides and free of friction on their face. A free side lies where ``edges`` say, places
    along x and y as in ``CutCells``, (nx, ny); half a cell away by default. Rubber flows sideways
    as a parabola over the height; q, the share of the pressure that this flow carries, is 1 at a
    free side and

        lap q = c q / d^2,  c = 3 / (2 (1 + nu)),   f = 0.945 d (q / E + (1 - q) / M)

    with M = E (1 - nu) / ((1 + nu)(1 - 2 nu)) of the confined rest (infinite for nu = 0.5). The
    mean of q falls with the shape factor as Gent and Lindley (1959) found for blocks bonded at both
    ends, here of twice the height; the face near a free side gives way more than its middle.

    ``slits`` are free sides too, as far as they are deep (``slit_openness``) and until their walls
    meet (``Slits.openness``).
    """
    share = free_share(mask, spacing, height, poisson_ratio, edges)
    if slits is not None:
        cut = free_share(mask, spacing, height, poisson_ratio, edges, slits)
        share += slits.openness * (cut - share)
    return np.where(mask, compression(share, height, modulus, poisson_ratio), 0.0)


def compression(share: Array, height: Array, modulus: float, poisson_ratio: float) -> Array:
    """Return f of ``block_compression`` (m/Pa) where the flow carries ``share`` of the pressure."""
    confined = (1 + poisson_ratio) * (1 - 2 * poisson_ratio) / (1 - poisson_ratio)
    return BONDED_END * height / modulus * (share + (1 - share) * confined)


def slit_openness(depth: Array) -> Array:
    """Return b of a slit as deep as ``depth`` of the height: 0 for none, infinite for all of it.

    It takes up 2 b (1 - q) / d of the flow per length, from both sides, with

        b = w^2 (0.8 + (1 - w)^2) / (1 - w)

    Found from plane-strain finite elements of layers with slits 1.5 to 6 heights apart, nu 0.49:
    the gain in compression is met within 0.06 of that of slits through the whole height (0.13 too
    large where they are 0.7 heights apart).
    """
    bounded = np.clip(depth, 0.0, 1 - 1e-6)
    return bounded**2 * (0.8 + (1 - bounded) ** 2) / (1 - bounded)


def free_share(
    mask: NDArray[np.bool_],
    spacing: float,
    height: Array,
    poisson_ratio: float,
    edges: tuple[Array | float, Array | float] = (0.5, 0.5),
    slits: Slits | None = None,
) -> Array:
    """Return q of ``block_compression`` (nx, ny), 0 outside the mask, with its slits wide open."""
    from scipy.sparse import csr_matrix

    inside = np.argwhere(mask) + 1
    count = len(inside)
    number = np.full((mask.shape[0] + 2, mask.shape[1] + 2), -1)
    number[inside[:, 0], inside[:, 1]] = np.arange(count)
    depth = np.broadcast_to(height, mask.shape)[mask]
    diagonal = flow_constant(poisson_ratio) * (spacing / depth) ** 2
    right = np.zeros(count)
    rows, columns = [np.arange(count)], [np.arange(count)]
    values = []
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        along, across = (step, 0) if axis == 0 else (0, step)
        neighbour = number[inside[:, 0] + along, inside[:, 1] + across]
        held = neighbour >= 0
        rows.append(np.flatnonzero(held))
        columns.append(neighbour[held])
        before = inside if step > 0 else inside - (axis == 0, axis == 1)
        at = before[:, 0], before[:, 1]
        place = np.pad(np.broadcast_to(edges[axis], mask.shape), 1, constant_values=0.5)
        free = 1 / np.maximum(np.abs((step < 0) - place[at]), NEAREST)
        link, side = np.where(held, 1.0, 0.0), np.where(held, 0.0, free)
        if slits is not None:
            taken, near, far = (np.pad(part[axis], 1)[at] for part in _slit_flow(slits, height))
            near, far = (near, far) if step > 0 else (far, near)
            cut = held & (taken > 0)
            total = np.where(cut, near + far + taken, 1.0)
            link, side = (
                np.where(cut, near * part / total, plain)
                for part, plain in ((far, link), (taken, side))
            )
        diagonal += link + side
        right += side
        values.append(-link[held])
    entries = np.concatenate([diagonal, *values])
    matrix = csr_matrix(
        (entries, (np.concatenate(rows), np.concatenate(columns))), shape=(count, count)
    )
    matrix.sort_indices()
    result = np.zeros(mask.shape)
    result[mask] = factorization(matrix, kind="positive definite", where="blocks").solve(right)
    return result


def flow_constant(poisson_ratio: float) -> float:
    """Return c of ``block_compression``."""
    return 1.5 / (1 + poisson_ratio)


def _slit_flow(slits: Slits, height: Array) -> tuple[Array, Array, Array]:
    """Return what slits take up and lead to both centres, per difference of q, (2, nx, ny)."""
    tall = np.broadcast_to(height, slits.depth.shape)
    taken = 2 * slit_openness(slits.depth / tall) * slits.length / tall
    return taken, 1 / slits.place, 1 / (1 - slits.place)


def slit_closing(
    share: Array, slits: Slits, height: Array, modulus: float, poisson_ratio: float
) -> float:
    """Return by how much (m/Pa) the walls of open slits move together under a uniform pressure.

    Mean over slits and their depth of what the flow of ``free_share`` brings in from both sides,
    0.945 d^3 / (c E) times the jump of its slope, over the depth of the slit.
    """
    taken, near, far = _slit_flow(slits, height)
    # a slit that ends at the rim of a lug counts where both centres are on it
    taken = taken * np.stack([(share > 0) & (np.roll(share, -1, axis=a) > 0) for a in (0, 1)])
    beside = np.stack([np.roll(share, -1, axis=axis) for axis in (0, 1)])
    at_wall = (near * share + far * beside + taken) / (near + far + taken)
    volume = BONDED_END * height**3 / (flow_constant(poisson_ratio) * modulus)
    flow = (volume * taken * (1 - at_wall)).sum()
    return float(flow / max((slits.depth * slits.length * (taken > 0)).sum(), 1e-30))


def attenuation(wavenumber: Array, depth: float) -> Array:
    """Return the share (1 + k d) exp(-k d) of a surface pressure wave that reaches depth d."""
    reduced = np.asarray(wavenumber, dtype=float) * depth
    return (1 + reduced) * np.exp(-reduced)


def wavenumbers(box: int, spacing: float) -> Array:
    """Return |k| (rad/m) of the waves of a square box of an even number of cells, one quadrant."""
    along = np.pi / (spacing * (box // 2)) * np.arange(box // 2 + 1)
    return np.hypot(along[:, None], along)


def influence_from_symbol(symbol: Array, shape: tuple[int, int]) -> Array:
    """Return the (2 nx - 1, 2 ny - 1) coefficients of a symbol on ``wavenumbers`` of a box.

    The symbol is even, so that its transform is one of cosines.
    """
    nx, ny = shape
    lines: Any = fft.idct(symbol, type=1, axis=1)
    quadrant: Any = fft.idct(lines[:, :ny], type=1, axis=0)
    return quadrant[np.ix_(np.abs(np.arange(-nx + 1, nx)), np.abs(np.arange(-ny + 1, ny)))]


def fast_length(least: int) -> int:
    """Return the next length that the real transform does fast."""
    length = fft.next_fast_len(least, True)
    assert length is not None
    return length


def half_space_influence(shape: tuple[int, int], spacing: float, plane_modulus: float) -> Array:
    """Return the deflection (m/Pa) at offset (i, j) of a unit pressure on one square cell.

    Love (1929): exact for a piecewise constant pressure; (2 nx - 1, 2 ny - 1), its centre at
    (nx - 1, ny - 1).
    """
    nx, ny = shape
    x = np.arange(-nx + 1, nx)[:, None] * spacing
    y = np.arange(-ny + 1, ny)[None, :] * spacing
    half = 0.5 * spacing
    total = np.zeros((2 * nx - 1, 2 * ny - 1))
    for sx in (-1, 1):
        for sy in (-1, 1):
            a, b = x + sx * half, y + sy * half
            total += sx * sy * (a * np.arcsinh(b / np.abs(a)) + b * np.arcsinh(a / np.abs(b)))
    return total / (np.pi * plane_modulus)


def balanced_weights(
    influence: Array, mask: NDArray[np.bool_], uniform: Array, area: Array | float = 1.0
) -> Array:
    """Return weights w, 0 outside the mask, such that w * K(w * area) is ``uniform`` on the mask.

    K is the convolution with the (positive) influence coefficients, ``uniform`` (nx, ny) the
    deflection under a uniform pressure, ``area`` what each cell carries of it, in cells. w K w is
    symmetric, so work done by one pressure on the deflection of another is reciprocal (symmetric
    matrix balancing, Sinkhorn 1964).
    """
    convolution = Convolution(influence, mask.shape)
    weight = mask.astype(float)
    target = np.where(mask, uniform, 1.0)
    for _ in range(80):
        row = weight * convolution(weight * area)
        error = np.abs(row[mask] / target[mask] - 1).max()
        if error < 1e-3:
            break
        safe = np.where(mask, np.maximum(row, 0.02 * target), target)
        weight = np.where(mask, weight * np.sqrt(target / safe), 0.0)
    return weight


class Convolution:
    """Linear (not periodic) convolution of fields (..., nx, ny), each with its own influence."""

    def __init__(self, influence: Array, shape: tuple[int, int], dtype: Any = float) -> None:
        nx, ny = shape
        self.shape = shape
        self.influence = influence
        # the real axis in fours: 240 takes half the time of 225
        self.padded = (fast_length(2 * nx - 1), 4 * fast_length(math.ceil((2 * ny - 1) / 4)))
        wrapped = np.zeros((*influence.shape[:-2], *self.padded), dtype)
        rows = np.arange(-nx + 1, nx) % self.padded[0]
        columns = np.arange(-ny + 1, ny) % self.padded[1]
        wrapped[..., rows[:, None], columns] = influence
        self.spectrum = fft.rfft2(wrapped)
        self._planned = None
        if fourier_library() == "mkl":
            self._planned = prepared_transform(wrapped.shape, dtype)
            self._room = np.zeros_like(wrapped)

    def __call__(self, field: Array) -> Array:
        nx, ny = self.shape
        if self._planned is not None:
            self._room[..., :nx, :ny] = field
            spectrum = self._planned.forward(self._room)
            spectrum *= self.spectrum
            return self._planned.backward(spectrum)[..., :nx, :ny]
        # lines that are all zeros, or cut off in the end, are not transformed
        lines: Any = fft.rfft(field, n=self.padded[1])
        spectrum: Any = fft.fft(lines, n=self.padded[0], axis=-2)
        spectrum *= self.spectrum
        lines = fft.ifft(spectrum, axis=-2, overwrite_x=True)
        deflection: Any = fft.irfft(lines[..., :nx, :], n=self.padded[1])
        return deflection[..., :ny]

    def within(self, shape: tuple[int, int], dtype: Any = float) -> "Convolution":
        """Return the same convolution of the fields on a smaller grid, in a precision."""
        (nx, ny), (mx, my) = self.shape, shape
        part = self.influence[..., nx - mx : nx + mx - 1, ny - my : ny + my - 1]
        return Convolution(part, shape, dtype)
