"""How far the sole's surface gives way under pressure.

A ``Compliance`` maps a pressure field to a deflection field. The contact solver needs nothing else
than this map, its diagonal and a radial symbol to precondition with, so a finite-element compliance
can take the place of the layers below.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol, cast, runtime_checkable

import numpy as np
import scipy.sparse as sp

from underfoot.core import InputError
from underfoot.core.arrays import Array
from underfoot.core.remark import Message
from underfoot.shoe.cut_cells import CutCells
from underfoot.shoe.geometry import SoleMap

from ._kernels.elastic import (
    Convolution,
    attenuation,
    balanced_weights,
    block_compression,
    bonded_layer_symbol,
    fast_length,
    free_sided_symbol,
    half_space_influence,
    influence_from_symbol,
    wavenumbers,
)
from .long_waves import BodyCorrection, LongWaves, SoleBody, body_correction

Symbol = Callable[[Array], Array]
Box = tuple[slice, slice]
BOX_THICKNESSES = 16.0  # side of the box on which a layer's influence coefficients are found
LEAST_OWN = 0.05  # of the layers' self compliance is left by what the long waves take
THINNEST = 0.1  # share of the outsole left above the deepest profile
REACHED = 1e-3
"""m: a channel deeper than this neither touches the floor nor holds a film (pools: 0.6 mm)."""
TREADED_SHARE = 0.5  # of the land that must be lugs for the tread to be modelled as lugs


@runtime_checkable
class Compliance(Protocol):
    """Linear map from surface pressure to surface deflection on one grid."""

    @property
    def self_compliance(self) -> Array:
        """Deflection of a cell under unit pressure on itself alone, (nx, ny), m/Pa."""
        ...

    def apply(self, pressure: Array) -> Array:
        """Return the deflection (nx, ny) in m of a pressure field (nx, ny) in Pa."""
        ...

    def symbol(self, wavenumber: Array) -> Array:
        """Return the approximate deflection over pressure (m/Pa) of a wave of |k| (rad/m)."""
        ...


class ConvolutionCompliance:
    """Sum of convolutions, each w * K(w * p) with an optional weight field w."""

    def __init__(
        self,
        shape: tuple[int, int],
        parts: list[tuple[Array, Array | None]],
        symbol: Symbol,
        *,
        modulus: float,
    ) -> None:
        """``modulus`` (E / (1 - nu^2), Pa) is that of the half-space which short waves meet."""
        self._symbol = symbol
        self._long_waves: tuple[LongWaves, ...] = ()
        self.body: BodyCorrection | None = None
        self._modulus = modulus
        plain = np.ones(shape)
        self._weights = np.stack([plain if weight is None else weight for _, weight in parts])
        self._convolution = Convolution(np.stack([influence for influence, _ in parts]), shape)
        middle = self._convolution.influence[:, shape[0] - 1, shape[1] - 1]
        own = np.tensordot(middle, self._weights**2, axes=1)
        # A cell of weight zero (a channel) carries no pressure; keep its diagonal positive.
        self._self = np.maximum(own, own.max() * 1e-3)

    @property
    def self_compliance(self) -> Array:
        """Deflection of a cell under unit pressure on itself alone, (nx, ny), m/Pa."""
        return self._self

    def symbol(self, wavenumber: Array) -> Array:
        """Return the deflection over pressure (m/Pa) of a wave far from free edges."""
        return self._symbol(np.asarray(wavenumber, dtype=float))

    @property
    def short_waves(self) -> tuple[Array, float]:
        """Weight (nx, ny) and modulus (Pa) of the half-space that short waves meet."""
        sharpest = self._convolution.influence.max(axis=(1, 2)).argmax()
        return self._weights[sharpest], self._modulus

    def apply(self, pressure: Array) -> Array:
        """Return the deflection (nx, ny) in m of a pressure field (nx, ny) in Pa."""
        weights = self._weights
        risen = np.einsum("kij,kij->ij", weights, self._convolution(weights * pressure))
        for correction in self._long_waves:
            risen += correction.apply(pressure)
        return risen

    def correct_body(self, body: BodyCorrection | None, sole: SoleMap) -> ConvolutionCompliance:
        """Return the compliance with the long waves of its body put right; itself for None."""
        if body is None:
            return self
        result = self.plus(body.on(sole))
        result.body = body
        return result

    def plus(self, long_waves: LongWaves) -> ConvolutionCompliance:
        """Return the compliance with one more correction of its long waves."""
        result = copy(self)
        result._long_waves = (*self._long_waves, long_waves)
        own = self._self + long_waves.self_compliance(self._self.shape)
        result._self = np.maximum(own, LEAST_OWN * self._self)
        return result

    def under_waves(self, waves: sp.csr_matrix) -> Array:
        """Return B^T C B (m/Pa) of fields B (cells, n), in single precision."""
        shape = self._self.shape
        loaded = (np.diff(waves.indptr) > 0).reshape(shape)
        rows, columns = (np.flatnonzero(loaded.any(axis=axis)) for axis in (1, 0))
        box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        cells = np.arange(loaded.size).reshape(shape)[box]
        near: Any = waves[cells.ravel()]
        fields = cast("Any", sp.csc_matrix(near))
        part = self.within(box, np.float32)
        risen = np.empty((cells.size, fields.shape[1]))
        for k in range(fields.shape[1]):
            field = fields[:, [k]].toarray().reshape(cells.shape).astype(np.float32)
            risen[:, k] = part.apply(field).ravel()
        return fields.T @ risen

    def within(self, box: Box, dtype: Any = float) -> ConvolutionCompliance:
        """Return the compliance between the cells of a box, whose cost is that of the box.

        ``dtype`` is the precision of the transforms.
        """
        part = object.__new__(ConvolutionCompliance)
        part._symbol, part._self, part.body = self._symbol, self._self[box], self.body
        part._modulus = self._modulus
        shape = self._self.shape
        part._long_waves = tuple(long.within(shape, box, dtype) for long in self._long_waves)
        part._weights = self._weights[:, *box].astype(dtype)
        part._convolution = self._convolution.within(part._self.shape, dtype)
        return part


@dataclass(frozen=True, slots=True)
class BoxedCompliance:
    """Any compliance between the cells of a box, with the rest of its grid unloaded."""

    whole: Compliance
    box: Box

    @property
    def self_compliance(self) -> Array:
        """Deflection of a cell under unit pressure on itself alone, (nx, ny), m/Pa."""
        return self.whole.self_compliance[self.box]

    def symbol(self, wavenumber: Array) -> Array:
        """Return the approximate deflection over pressure (m/Pa) of a wave."""
        return self.whole.symbol(wavenumber)

    def apply(self, pressure: Array) -> Array:
        """Return the deflection (nx, ny) in m of a pressure field (nx, ny) in Pa."""
        field = np.zeros(self.whole.self_compliance.shape)
        field[self.box] = pressure
        return self.whole.apply(field)[self.box]


def compliance_within(compliance: Compliance, box: Box, dtype: Any = float) -> Compliance:
    """Return a compliance between the cells of a box (rows, columns).

    ``dtype`` is the precision of the transforms, where it has any.
    """
    if isinstance(compliance, ConvolutionCompliance):
        return compliance.within(box, dtype)
    return BoxedCompliance(compliance, box)


def half_space_compliance(
    shape: tuple[int, int], spacing: float, *, modulus: float, poisson_ratio: float
) -> ConvolutionCompliance:
    """Return the compliance of an elastic half-space, exact for cell-wise constant pressure.

    Parameters:
        shape, spacing: Grid (nx, ny) and cell size in m.
        modulus, poisson_ratio: Of the body, Pa and 1 (0 to 0.5). For two bodies pass E* and 0.

    Source: Love 1929; symbol 2 / (E* k).
    """
    _check_elastic(modulus, poisson_ratio)
    plane = modulus / (1 - poisson_ratio**2)
    influence = half_space_influence(shape, spacing, plane)
    longest = 2 * np.pi / (max(shape) * spacing)
    return ConvolutionCompliance(
        shape,
        [(influence, None)],
        lambda k: 2 / (plane * np.maximum(k, 0.5 * longest)),
        modulus=plane,
    )


def layered_compliance(
    sole: SoleMap,
    *,
    modulus: float,
    poisson_ratio: float,
    thickness: float,
    shoe_angle: float | None = None,
    midsole_modulus: float | None = None,
    midsole_thickness: float | None = None,
    midsole_poisson_ratio: float = 0.3,
    free_edges: bool = True,
    known: BodyCorrection | None = None,
) -> ConvolutionCompliance:
    """Return the compliance of an outsole layer, its tread and the midsole under it.

    Parameters:
        sole: Plan form and tread.
        modulus, poisson_ratio, thickness: Of the outsole: Pa, 1 (0 to 0.5), m.
        shoe_angle: Tilt of the sole's plane against the floor, rad; then the thickness is that from
            this plane to the midsole and profile and lugs are taken off. None: the thickness above
            the lugs, the same everywhere.
        midsole_modulus, midsole_thickness, midsole_poisson_ratio: Of the layer between outsole and
            rigid foot; both None for none. A Poisson's ratio of 0.3 stands for a foam (assumed).
        free_edges: Let the plan form and the lugs bulge at their edges. Without it the layer is
            endless and pressure peaks at edges are too high.
        known: ``body`` of the compliance of another map of the same shoe, whose elements serve this
            one too; None solves them.

    Bonded layer by its Fourier symbol; a midsole adds its own symbol, attenuated by
    (1 + k T) exp(-k T) through the outsole. Free edges: the part of the response that a block of
    the plan form or a lug has with free sides is split off, 1 / (1 / f + E* k / 2), and balanced on
    its mask so that a uniform pressure compresses it as ``block_compression`` says: by its own
    height at each place, more near a free side than in the middle. Lugs stand in series on the
    layer, which feels what of a wave of pressure gets through their mean height; where lugs are
    worn down to less of it, and in channels worn nearly through, it feels short waves too. Slits
    (``SoleMap.slits``) are free sides of the lugs as far as they are deep and open. With free edges
    the long waves of the body above the lugs are put right by elements of its real shape
    (``long_waves``).
    """
    _check_elastic(modulus, poisson_ratio)
    _check_positive(thickness, "thickness")
    if (midsole_modulus is None) != (midsole_thickness is None):
        raise InputError(
            "a midsole needs both its modulus and its thickness",
            where="midsole_modulus" if midsole_modulus is None else "midsole_thickness",
        )
    shape = (sole.x.size, sole.y.size)
    body = np.full(shape, float(thickness))
    if shoe_angle is not None:
        body = body_thickness(sole, thickness, shoe_angle)
        thickness = float(body[sole.inside & sole.land].mean())
    total = thickness + (midsole_thickness or 0.0)
    extent = 2 * max(shape) * sole.spacing
    box = 2 * fast_length(math.ceil(max(extent, BOX_THICKNESSES * total) / (2 * sole.spacing)))
    k = wavenumbers(box, sole.spacing)

    def influence(symbol: Symbol) -> Array:
        return influence_from_symbol(symbol(k), shape)

    def midsole(q: Array) -> Array:
        if midsole_modulus is None or midsole_thickness is None:
            return np.zeros_like(q)
        give = bonded_layer_symbol(q, midsole_modulus, midsole_poisson_ratio, midsole_thickness)
        return give * attenuation(q, thickness)

    if midsole_modulus is not None and midsole_thickness is not None:
        _check_elastic(midsole_modulus, midsole_poisson_ratio)
        _check_positive(midsole_thickness, "midsole_thickness")
    elastic = {"modulus": modulus, "poisson_ratio": poisson_ratio}
    plane = modulus / (1 - poisson_ratio**2)
    layer = partial(bonded_layer_symbol, **elastic, thickness=thickness)

    def whole(q: Array) -> Array:
        return layer(q) + midsole(q)

    if not free_edges:
        return ConvolutionCompliance(shape, [(influence(whole), None)], whole, modulus=plane)

    depth = mean_lug_depth(sole)
    land = sole.inside & sole.land
    plan = sole.inside  # a channel is shallow beside the body, whose real shape the elements have
    give = block_compression(plan, sole.spacing, body, modulus, poisson_ratio)
    footprint = partial(free_sided_symbol, **elastic, uniform=float(give[plan].mean()))

    def rest(q: Array) -> Array:
        return np.maximum(layer(q) - footprint(q), 0.0) + midsole(q)

    block = influence(footprint)
    plan_weight = balanced_weights(block, plan, give)
    base: list[tuple[Array, Array | None]] = [(influence(rest), None), (block, plan_weight)]
    layers = ConvolutionCompliance(shape, base, lambda q: rest(q) + footprint(q), modulus=plane)
    soft = None
    if midsole_modulus is not None and midsole_thickness is not None:
        soft = midsole_modulus, midsole_poisson_ratio, midsole_thickness
    real = SoleBody(sole, body, shoe_angle or 0.0, modulus, poisson_ratio, soft)
    correction = body_correction(real, layers.under_waves, known)
    if depth == 0.0:
        return layers.correct_body(correction, sole)

    height = lug_height(sole)
    cut = sole.cut or CutCells.none(shape)
    edges = cut.along, cut.across
    lug_give = block_compression(
        land, sole.spacing, height, modulus, poisson_ratio, edges, sole.slits
    )
    uniform = float(np.average(lug_give[land], weights=cut.area[land]))
    lug = partial(free_sided_symbol, **elastic, uniform=uniform)
    smooth = partial(attenuation, depth=depth)
    parts: list[tuple[Array, Array | None]] = [
        (influence(lambda q: rest(q) * smooth(q)), None),
        (influence(lambda q: footprint(q) * smooth(q)), plan_weight),
    ]
    lugs = influence(lug)
    parts.append((lugs, balanced_weights(lugs, land, lug_give, cut.area)))
    # short waves meet the layer itself under what is left of low lugs and in channels beside them
    low = bool((sole.tread_depth[land] < REACHED).any())
    bare = np.where(land, np.clip(1 - sole.tread_depth / depth, 0.0, 1.0), sole.inside & low)
    if bare.any():
        short = influence(lambda q: (rest(q) + footprint(q)) * (1 - smooth(q)))
        parts.append((short, np.sqrt(bare)))
    return ConvolutionCompliance(
        shape, parts, lambda q: (rest(q) + footprint(q)) * smooth(q) + lug(q), modulus=plane
    ).correct_body(correction, sole)


def body_thickness(sole: SoleMap, thickness: float, shoe_angle: float) -> Array:
    """Return the outsole (m) above lugs and profile, (nx, ny), of ``thickness`` from its plane.

    The plane lies at ``shoe_angle`` against the floor and touches the lowest land. At least a tenth
    of the thickness: land that rises higher (an arch, a toe) does not come near the floor.
    """
    land = sole.inside & sole.land
    height = sole.clearance - math.tan(shoe_angle) * sole.x[:, None]
    over = np.where(land, (height - height[land].min()) * math.cos(shoe_angle), 0.0)
    above = thickness - over - np.where(land, sole.tread_depth, 0.0)
    above = np.maximum(above, THINNEST * thickness)
    from scipy.ndimage import distance_transform_edt

    nearest = distance_transform_edt(~land, return_distances=False, return_indices=True)
    assert isinstance(nearest, np.ndarray)
    filled = above[nearest[0], nearest[1]]
    mirrored = filled[:, ::-1]
    # of two places as near the transform takes either: a sole that is its image has a body that is
    return 0.5 * (filled + mirrored) if np.array_equal(above, above[:, ::-1]) else filled


def mean_lug_depth(sole: SoleMap) -> float:
    """Return the mean tread depth of the lugs in m, 0 when less than half the land is lugs."""
    land = sole.inside & sole.land
    depth = np.asarray(sole.tread_depth)[land]
    lugs = depth[depth > 0]
    return float(lugs.mean()) if lugs.size > TREADED_SHARE * depth.size else 0.0


def lug_height(sole: SoleMap) -> Array:
    """Return the height (m) of the lugs as blocks, (nx, ny).

    Untreaded land beside the lugs is as stiff as a lug of the least height the grid can tell.
    """
    return np.maximum(sole.tread_depth, min(0.5 * sole.spacing, mean_lug_depth(sole)))


def _check_positive(value: float, where: str) -> None:
    if not (math.isfinite(value) and value > 0):
        raise InputError(
            Message("{value} is not positive", value=value),
            where=where,
            allowed="a finite value above 0",
        )


def _check_elastic(modulus: float, poisson_ratio: float) -> None:
    _check_positive(modulus, "modulus")
    if not 0 <= poisson_ratio <= 0.5:
        raise InputError(
            Message(
                "Poisson's ratio {poisson_ratio} is outside the physical range",
                poisson_ratio=poisson_ratio,
            ),
            where="poisson_ratio",
            allowed="0 to 0.5",
        )
