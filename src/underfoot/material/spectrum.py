"""Relaxation spectrum: a generalised Maxwell material with any number of terms."""

from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import InputError, display
from underfoot.core.arrays import scalar_or_array
from underfoot.core.deprecation import renamed_member
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Amount, Message

LEAST_AT_REST = 1e-6
"""Part of the modulus at once below which nothing is left at rest."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RelaxationSpectrum(Presentable):
    """Linear viscoelastic Young's modulus E(t) = E_inf + sum E_i exp(-t / tau_i).

    Parameters:
        equilibrium_modulus: E_inf, Pa, >= 0 (0: a liquid).
        term_moduli: E_i, Pa, (n,), each >= 0.
        relaxation_times: tau_i, s, (n,), each > 0; stored in ascending order.
        source: Where the numbers come from.
        assumed: True when no measurement stands behind them.

    The same object serves for a shear modulus: then every modulus it returns is one of shear
    (``young_from_shear`` and ``shear_from_young`` convert).

    Raises:
        InputError: Negative or non-finite moduli or times, arrays of different length, all moduli
            zero.
    """

    equilibrium_modulus: float
    term_moduli: np.ndarray = field(default_factory=lambda: np.empty(0))
    relaxation_times: np.ndarray = field(default_factory=lambda: np.empty(0))
    source: str = ""
    assumed: bool = False

    def __post_init__(self) -> None:
        equilibrium = float(self.equilibrium_modulus)
        moduli = np.array(self.term_moduli, dtype=float, ndmin=1)
        times = np.array(self.relaxation_times, dtype=float, ndmin=1)
        _check(equilibrium, moduli, times)
        order = np.argsort(times, kind="stable")
        moduli, times = moduli[order], times[order]
        moduli.setflags(write=False)
        times.setflags(write=False)
        object.__setattr__(self, "equilibrium_modulus", equilibrium)
        object.__setattr__(self, "term_moduli", moduli)
        object.__setattr__(self, "relaxation_times", times)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RelaxationSpectrum):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def __len__(self) -> int:
        return self.term_moduli.size

    def __repr__(self) -> str:
        low, high = self.equilibrium_modulus, self.instantaneous_modulus
        return (
            f"RelaxationSpectrum({len(self)} terms, {display(low, 'Pa')} at rest to "
            f"{display(high, 'Pa')} at once, {self.source[:60]!r})"
        )

    def table(self) -> Table:
        """Return the terms."""
        rows: list[tuple[object, float, float]] = [("at rest", np.inf, self.equilibrium_modulus)]
        terms = zip(self.relaxation_times.tolist(), self.term_moduli.tolist(), strict=True)
        rows += [(number, time, modulus) for number, (time, modulus) in enumerate(terms, start=1)]
        columns = ("term", "relaxation time s", "modulus Pa")
        return Table(
            Message("Relaxation spectrum ({source})", source=self.source or "no source"),
            columns,
            rows,
        )

    def cautions(self) -> tuple[Message, ...]:
        """Return that nothing is left at rest, which no cross-linked rubber does."""
        rest, once = self.equilibrium_modulus, self.instantaneous_modulus
        if rest > LEAST_AT_REST * once:
            return ()
        return (
            Message(
                "At rest {rest} of {once} is left: it flows under a load held longer than {time}, "
                "which no cross-linked rubber does. Its fractions sum to 1: fit the series with a "
                "modulus at rest, or add it as a row tau = inf.",
                rest=Amount(rest, "Pa"), once=Amount(once, "Pa"),
                time=Amount(float(self.relaxation_times.max()), "s"),
            ),
        )  # fmt: skip

    @property
    def instantaneous_modulus(self) -> float:
        """E(0) = E_inf + sum E_i, Pa."""
        return self.equilibrium_modulus + float(self.term_moduli.sum())

    def relaxation_modulus(self, time: ArrayLike) -> Any:
        """Return E(t), Pa, for ``time`` (s, >= 0) of any shape."""
        t = np.asarray(time, dtype=float)
        if np.any(~(t >= 0.0)):
            raise InputError("negative or missing time", where="time", allowed="t >= 0 s")
        result = np.full(t.shape, self.equilibrium_modulus)
        for modulus, relaxation_time in zip(self.term_moduli, self.relaxation_times, strict=True):
            result += modulus * np.exp(-t / relaxation_time)
        return scalar_or_array(result)

    def complex_modulus(self, angular_frequency: ArrayLike) -> Any:
        """Return E*(w) = E_inf + sum E_i (i w tau_i) / (1 + i w tau_i), Pa, complex.

        ``angular_frequency`` in rad/s, any shape and either sign: E*(-w) is the conjugate of
        E*(w), and w = 0 and +-inf give E_inf and E(0). A complex number comes back for a scalar.
        """
        w = np.asarray(angular_frequency, dtype=float)
        if np.any(np.isnan(w)):
            raise InputError("a frequency is missing (NaN)", where="angular_frequency")
        storage = np.full(w.shape, self.equilibrium_modulus)
        loss = np.zeros(w.shape)
        for modulus, relaxation_time in zip(self.term_moduli, self.relaxation_times, strict=True):
            # Written with 1/x so that infinite frequency gives the limit and not NaN.
            x = w * relaxation_time
            with np.errstate(divide="ignore", over="ignore"):
                inverse = 1.0 / x
                storage += modulus / (1.0 + inverse * inverse)
                loss += np.where(x == 0.0, 0.0, modulus / (x + inverse))
        result = storage + 1j * loss
        return complex(result) if result.ndim == 0 else result

    def __call__(self, angular_frequency: ArrayLike) -> Any:
        """Return ``complex_modulus(angular_frequency)``: a spectrum is a modulus callable."""
        return self.complex_modulus(angular_frequency)

    def storage_modulus(self, angular_frequency: ArrayLike) -> Any:
        """Return E'(w) = Re E*(w), Pa."""
        return self.complex_modulus(angular_frequency).real

    def loss_modulus(self, angular_frequency: ArrayLike) -> Any:
        """Return E''(w) = Im E*(w), Pa: what hysteresis friction sees."""
        return self.complex_modulus(angular_frequency).imag

    def loss_tangent(self, angular_frequency: ArrayLike) -> Any:
        """Return tan delta = E''/E'; NaN only for a liquid at zero frequency."""
        modulus: Any = np.asarray(self.complex_modulus(angular_frequency))
        with np.errstate(divide="ignore", invalid="ignore"):
            result = modulus.imag / modulus.real
        return scalar_or_array(result)

    def scale_moduli(self, factor: float, *, source: str | None = None) -> Self:
        """Return the spectrum with every modulus times ``factor`` (> 0)."""
        if not (np.isfinite(factor) and factor > 0.0):
            raise InputError(
                Message("factor {factor:g}", factor=factor),
                where="factor",
                allowed="a positive number",
            )
        return type(self)(
            self.equilibrium_modulus * factor,
            self.term_moduli * factor,
            self.relaxation_times,
            source=self.source if source is None else source,
            assumed=self.assumed,
        )

    scaled = renamed_member("scaled", "scale_moduli", gone="0.4")

    def shift_times(self, shift_factor: float, *, source: str | None = None) -> Self:
        """Return the spectrum at another temperature: every time times ``shift_factor`` (a_T)."""
        if not (np.isfinite(shift_factor) and shift_factor > 0.0):
            raise InputError(
                Message("shift factor {shift_factor:g}", shift_factor=shift_factor),
                where="shift_factor",
                allowed="a positive number",
            )
        return type(self)(
            self.equilibrium_modulus,
            self.term_moduli,
            self.relaxation_times * shift_factor,
            source=self.source if source is None else source,
            assumed=self.assumed,
        )

    shifted = renamed_member("shifted", "shift_times", gone="0.4")

    def _key(self) -> tuple[Any, ...]:
        return (
            self.equilibrium_modulus,
            tuple(self.term_moduli.tolist()),
            tuple(self.relaxation_times.tolist()),
            self.source,
            self.assumed,
        )


def _check(equilibrium: float, moduli: np.ndarray, times: np.ndarray) -> None:
    if moduli.ndim != 1 or times.ndim != 1 or moduli.size != times.size:
        raise InputError(
            Message(
                "{size} term moduli and {times_size} relaxation times",
                size=moduli.size,
                times_size=times.size,
            ),
            where="RelaxationSpectrum",
            allowed="two one-dimensional arrays of the same length",
        )
    if not (np.isfinite(equilibrium) and equilibrium >= 0.0):
        raise InputError(
            Message("equilibrium modulus {modulus:g} Pa", modulus=equilibrium),
            where="equilibrium_modulus",
            allowed="a finite modulus of 0 Pa or more",
        )
    bad = np.flatnonzero(~(np.isfinite(moduli) & (moduli >= 0.0)))
    if bad.size:
        raise InputError(
            Message(
                "term {bad} has the modulus {moduli:g} Pa", bad=bad[0] + 1, moduli=moduli[bad[0]]
            ),
            where="term_moduli",
            allowed="finite moduli of 0 Pa or more",
            remedy="A negative term gives energy back: refit with non-negative terms",
        )
    bad = np.flatnonzero(~(np.isfinite(times) & (times > 0.0)))
    if bad.size:
        raise InputError(
            Message(
                "term {bad} has the relaxation time {time:g} s", bad=bad[0] + 1, time=times[bad[0]]
            ),
            where="relaxation_times",
            allowed="finite times above 0 s",
        )
    if equilibrium + moduli.sum() <= 0.0:
        raise InputError("every modulus is zero", where="RelaxationSpectrum")
