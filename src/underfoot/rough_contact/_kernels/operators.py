"""The compliance of a sliding body and its inverse on one periodic grid."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core.arrays import AnyArray
from underfoot.core.fourier import Transform, transform
from underfoot.core.threads import on_host

from .members import each, members
from .periodic import wavenumbers


@dataclass(frozen=True, slots=True)
class ElasticBody:
    """A body whose compliance is scale * unit(|q|) / moduli(qx), and what computes with it.

    ``moduli`` returns E*(qx v) for a column of qx of NumPy (real when elastic), ``unit`` the
    compliance for E = 1 on |q| > 0 of any namespace. ``spacing`` is that of the fine grid. A batch
    of bodies has moduli (members, nx, 1) and a scale (members, 1, 1) of NumPy.
    ``asarray`` brings a row or column of NumPy to the namespace ``xp`` and its device. ``library``
    names the FFT (see ``transform``).
    """

    moduli: Callable[[AnyArray], AnyArray]
    unit: Callable[[AnyArray], AnyArray]
    spacing: tuple[float, float]
    scale: Any = 1.0
    xp: Any = np
    asarray: Callable[..., AnyArray] = np.asarray
    threads: int = 1
    library: str = "auto"


class Operators:
    """Displacement of a pressure (A p) and pressure of a displacement (S u) on one grid.

    ``shape`` is (members, nx, ny), a body a member. Single precision; ``exact_displacement`` works
    in double. The mean of every result is zero. ``count`` counts products.
    """

    def __init__(
        self,
        body: ElasticBody,
        shape: tuple[int, ...],
        coarsening: tuple[int, int] = (1, 1),
        exact: Transform | None = None,
    ) -> None:
        self.shape = shape
        self.xp = body.xp
        self.count = 0
        xp, self.asarray = body.xp, body.asarray
        spacing = (body.spacing[0] * coarsening[0], body.spacing[1] * coarsening[1])
        qx, qy = wavenumbers((shape[-2], shape[-1]), spacing)
        rows = np.reshape(body.moduli(qx), (-1, shape[-2], 1))
        self._body = body
        waves = self.asarray(np.repeat(qx[None], shape[0], axis=0))
        self._waves = waves, self.asarray(qy[None])
        self._scale = each(np.reshape(body.scale, -1).tolist(), waves)
        self.rows, self._inverse_rows = self.asarray(rows), self.asarray(1.0 / rows)
        self._lossy = np.iscomplexobj(rows)
        single = xp.complex64 if self._lossy else xp.float32
        unit = self.unit()
        unit[:, 0, 0] = 1.0
        self.stiffness = xp.astype(self.rows, single) / xp.astype(unit, xp.float32)
        del unit
        self.compliance = 1.0 / self.stiffness
        self.stiffness[:, 0, 0] = self.compliance[:, 0, 0] = 0.0
        self.fast = self._transform(xp.float32)
        self._exact = exact
        self._spectrum: AnyArray = None
        self._near: AnyArray = None
        self.soft = False

    def of(self, index: Sequence[int]) -> "Operators":
        """Return those of the members ``index``, which go on with the count."""
        if list(index) == list(range(self.shape[0])):
            return self
        some = copy(self)
        some.shape = (len(index), *self.shape[1:])
        some._waves = members(self._waves[0], index), self._waves[1]
        some._scale = members(self._scale, index)
        some.rows, some._inverse_rows = (members(x, index) for x in (self.rows, self._inverse_rows))
        some.stiffness, some.compliance = (
            members(x, index) for x in (self.stiffness, self.compliance)
        )
        some.fast, some._exact, some._spectrum = some._transform(self.xp.float32), None, None
        return some

    @contextmanager
    def soften_body(self, softness: float) -> Iterator[None]:
        """Add a soft mattress, u = softness p at every node, to the body inside the block.

        It acts on the products in single precision only. ``pressure`` becomes the inverse of the
        compliance in phase: less close to the inverse, but symmetric, so that the minimum-residual
        iteration can't stagnate (the operator is positive in that inner product).
        """
        kept = self.compliance
        self.compliance = kept + softness
        self.compliance[:, 0, 0] = 0.0
        in_phase = self.xp.real(self.compliance) if self._lossy else self.compliance
        self.stiffness = _inverse(in_phase)
        self.soft = True
        try:
            yield
        finally:
            self.compliance, self.stiffness = kept, _inverse(kept)
            self.soft = False

    def near(self) -> AnyArray:
        """Return S of one member between a node and its neighbours, (3, 3) of NumPy."""
        if self._near is None:
            kernel = self.fast.backward(self.xp.astype(self.stiffness, self.stiffness.dtype))
            rows = [kernel[0, a, b] for a in (-1, 0, 1) for b in (-1, 0, 1)]
            self._near = on_host(self.xp.stack(rows)).reshape(3, 3)
        return self._near

    def softness_range(self) -> tuple[float, float]:
        """Return the least and the largest compliance of a wave."""
        size = self.xp.abs(self.compliance)
        largest = float(self.xp.max(size))
        size[:, 0, 0] = largest
        return float(self.xp.min(size)), largest

    def unit(self) -> AnyArray:
        """Return the compliance for E = 1 in double precision, made anew: it is rarely used."""
        qx, qy = self._waves
        q = self.xp.sqrt(qx**2 + qy**2)
        q[:, 0, 0] = 1.0
        unit = self._body.unit(q)
        unit *= self._scale
        unit[:, 0, 0] = 0.0
        return unit

    def displacement(self, pressure: AnyArray, out: AnyArray = None) -> AnyArray:
        """Return A p in single precision; it may lie in ``out``, that of the pressure too."""
        return self._product(self.compliance, pressure, out)

    def pressure(self, displacement: AnyArray, out: AnyArray = None) -> AnyArray:
        """Return S u in single precision; it may lie in ``out``, that of the displacement too."""
        return self._product(self.stiffness, displacement, out)

    def exact_displacement(self, pressure: AnyArray) -> AnyArray:
        """Return A p in double precision."""
        self.count += 1
        self._spectrum = None
        spectrum = self.exact.forward(pressure)
        spectrum *= self.unit()
        spectrum *= self._inverse_rows
        return self.exact.backward(spectrum)

    def exact_pressure(self, displacement: AnyArray) -> AnyArray:
        """Return S u in double precision."""
        self.count += 1
        self._spectrum = None
        spectrum = self.exact.forward(displacement)
        spectrum *= self.rows
        unit = self.unit()
        unit[:, 0, 0] = 1.0
        spectrum /= unit
        spectrum[:, 0, 0] = 0.0
        return self.exact.backward(spectrum)

    @property
    def exact(self) -> Transform:
        """The transform in double precision, planned at first use."""
        if self._exact is None:
            self._exact = self._transform(self.xp.float64)
        return self._exact

    def _product(self, symbol: AnyArray, field: AnyArray, out: AnyArray) -> AnyArray:
        self.count += 1
        spectrum = self.fast.forward(field, self._spectrum)
        if self.xp is np:
            self._spectrum = spectrum
        spectrum *= symbol
        return self.fast.backward(spectrum, out)

    def _transform(self, dtype: Any) -> Transform:
        body = self._body
        return transform(self.shape, dtype, xp=body.xp, threads=body.threads, library=body.library)


def _inverse(symbol: AnyArray) -> AnyArray:
    """Return 1 / symbol, 0 for the mean as in ``symbol``."""
    symbol[:, 0, 0] = 1.0
    inverse = 1.0 / symbol
    symbol[:, 0, 0] = inverse[:, 0, 0] = 0.0
    return inverse
