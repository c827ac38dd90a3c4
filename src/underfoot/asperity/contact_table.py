"""Rough contact over pressure and speed, computed once and interpolated with its limits."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from underfoot.core import (
    Breach,
    Cache,
    DataError,
    InputError,
    Progress,
    Range,
    RangeError,
    SourcedValue,
    breaches,
    silent,
)

from ._kernels.monotone import interpolated_grid
from .tabulated_law import TabulatedLaw

QUANTITIES = {
    "real_contact_fraction": "1",
    "cof_hysteresis": "1",
    "mean_gap": "m",
    "flow_factor_along": "1",
    "flow_factor_across": "1",
}
Outside = Literal["error", "extend"]
Direction = Literal["along", "across", "mean"]
_FORMAT = 1
_REFINEMENT = 8


@dataclass(frozen=True, slots=True, eq=False)
class ContactTable:
    """Averages of one rough contact on a grid of nominal pressures and sliding speeds.

    Between the nodes every quantity is a monotone cubic in ln(pressure) and ln(speed), the
    contact fraction in its logarithm. ``outside="error"`` refuses to leave the grid;
    ``outside="extend"`` holds the edge value, except that below the lowest pressure the contact
    fraction is proportional to pressure and the gap grows as pressure decays exponentially.

    Parameters
    ----------
    pressure, speed
        Pa and m/s, rising, (n,) and (m,).
    values, deviation
        Mean and sample standard deviation over the surfaces, (n, m), per name in QUANTITIES; a
        deviation is not a number where fewer than two surfaces were computed.
    realizations
        Number of surfaces behind every node, (n, m).
    ranges
        Tested box: the grid.
    notes
        What a reader must know: surfaces, missing nodes, assumptions, why friction is zero.
    """

    pressure: np.ndarray
    speed: np.ndarray
    values: Mapping[str, np.ndarray]
    deviation: Mapping[str, np.ndarray]
    realizations: np.ndarray
    description: str = ""
    key: str = ""
    notes: tuple[str, ...] = ()
    out_of_range: tuple[str, ...] = ()
    name: str = field(default="contact table", init=False)

    @classmethod
    def from_surfaces(
        cls,
        surfaces: Sequence[Any],
        modulus: Any,
        pressure: ArrayLike,
        speed: ArrayLike,
        *,
        shoe_surfaces: Sequence[Any] | None = None,
        poisson_ratio: float = 0.5,
        layer_thickness: float | None = None,
        processes: int = 1,
        cache: Cache | None = None,
        description: str = "",
        progress: Progress = silent,
    ) -> ContactTable:
        """Return the table of periodic height maps of one texture (an ensemble of seeds).

        See ``contact_table_run.computed`` for arguments and errors.
        """
        from .contact_table_run import computed

        return computed(
            surfaces,
            modulus,
            pressure,
            speed,
            shoe_surfaces=shoe_surfaces,
            poisson_ratio=poisson_ratio,
            layer_thickness=layer_thickness,
            processes=processes,
            cache=cache,
            description=description,
            progress=progress,
        )

    @property
    def ranges(self) -> dict[str, Range]:
        """Return the validity box: the pressures and speeds of the grid."""
        return {
            "pressure": Range(float(self.pressure[0]), float(self.pressure[-1]), "Pa", "grid"),
            "speed": Range(float(self.speed[0]), float(self.speed[-1]), "m/s", "grid"),
        }

    def breaches(self, *, pressure: ArrayLike, speed: ArrayLike) -> list[Breach]:
        """Return what leaves the grid (speed by its magnitude)."""
        given = {"pressure": pressure, "speed": np.abs(np.asarray(speed, dtype=float))}
        return breaches(self.name, self.ranges, given)

    def real_contact_fraction(
        self, pressure: ArrayLike, speed: ArrayLike, outside: Outside = "error"
    ) -> NDArray[np.float64]:
        """Return the real over the nominal contact area at p (Pa) and v (m/s)."""
        p, x, y = self._at(pressure, speed, outside)
        floor = np.finfo(float).tiny
        logarithm = np.log(np.maximum(self.values["real_contact_fraction"], floor))
        value, _ = interpolated_grid(*self._axes, logarithm, x, y)
        return np.exp(value) * np.minimum(p / self.pressure[0], 1.0)

    def cof_hysteresis(
        self, pressure: ArrayLike, speed: ArrayLike, outside: Outside = "error"
    ) -> NDArray[np.float64]:
        """Return the hysteresis COF; it takes the sign of the speed."""
        _, x, y = self._at(pressure, speed, outside)
        value, _ = interpolated_grid(*self._axes, self.values["cof_hysteresis"], x, y)
        return value * np.where(np.asarray(speed, dtype=float) < 0.0, -1.0, 1.0)

    def mean_gap(
        self, pressure: ArrayLike, speed: ArrayLike, outside: Outside = "error"
    ) -> NDArray[np.float64]:
        """Return the mean gap (m), contact counted as zero.

        In the extension a pressure of zero counts as a millionth of the lowest one.
        """
        p, x, y = self._at(pressure, speed, outside)
        value, slope = interpolated_grid(*self._axes, self.values["mean_gap"], x, y)
        below = np.log(np.clip(p / self.pressure[0], 1e-6, 1.0))
        return value + np.where(below < 0.0, slope * below, 0.0)

    def flow_factor(
        self,
        pressure: ArrayLike,
        speed: ArrayLike,
        direction: Direction = "mean",
        outside: Outside = "error",
    ) -> NDArray[np.float64]:
        """Return the pressure flow factor phi; flow is phi h^3/(12 eta) with h the mean gap."""
        _, x, y = self._at(pressure, speed, outside)
        return interpolated_grid(*self._axes, self._flow(direction), x, y)[0]

    def sourced(self, quantity: str, pressure: float, speed: float) -> SourcedValue:
        """Return one interpolated quantity with the spread between surfaces as uncertainty."""
        if quantity not in QUANTITIES:
            from underfoot.core import unknown_name

            raise unknown_name("quantity", quantity, QUANTITIES, where=self.name)
        _, x, y = self._at(pressure, speed, "error")
        if quantity == "real_contact_fraction":
            value = self.real_contact_fraction(pressure, speed)
        else:
            value, _ = interpolated_grid(*self._axes, self.values[quantity], x, y)
        spread, reason = None, "only one surface was computed"
        if np.all(np.isfinite(self.deviation[quantity])):
            found, _ = interpolated_grid(*self._axes, self.deviation[quantity], x, y)
            spread, reason = max(float(found), 0.0), ""
        return SourcedValue(
            value=float(value),
            unit=QUANTITIES[quantity],
            source=f"{self.name}: {self.description}",
            uncertainty=spread,
            reason=reason,
            note="uncertainty: standard deviation between surfaces of one texture",
        )

    def law(self, speed: float, direction: Direction = "mean") -> TabulatedLaw:
        """Return the pressure-gap law at one speed (m/s; by magnitude, within the grid's edges).

        Nodes at full contact, where the gap no longer falls, are left out. The two directions
        of the flow factor differ by chance for isotropic textures; ``mean`` averages them.
        Raises RangeError when fewer than three pressures of the grid leave an open gap.
        """
        # between the nodes too, so that law and table are one function
        nodes = np.arange(self.pressure.size)
        fine = np.linspace(0, nodes[-1], _REFINEMENT * nodes[-1] + 1)
        pressure = np.exp(np.interp(fine, nodes, np.log(self.pressure)))
        v = np.full(pressure.shape, abs(float(speed)))
        gap = self.mean_gap(pressure, v, "extend")
        flow = self.flow_factor(pressure, v, direction, "extend")
        keep = [0]
        for n in range(1, gap.size):
            if gap[n] < gap[keep[-1]] - 1e-6 * gap[0]:
                keep.append(n)
        if len(keep) < 3:
            raise RangeError(
                f"only {len(keep)} pressures leave an open gap at {speed} m/s",
                where=self.name,
                remedy="Compute the table from a lower pressure on",
            )
        order = keep[::-1]
        return TabulatedLaw(
            name=self.name,
            source=f"{self.description or 'rough contact'}, at {abs(speed):g} m/s",
            gap=gap[order],
            node_pressure=pressure[order],
            node_flow_factor=np.maximum(flow[order], 0.0),
            speed=abs(float(speed)),
            ranges=self.ranges,
        )

    def save(self, path: str | Path) -> None:
        """Write the table as one compressed NumPy archive (.npz)."""
        arrays: dict[str, Any] = dict(self._arrays())
        with Path(path).open("wb") as stream:
            np.savez_compressed(stream, **arrays)

    @classmethod
    def load(cls, path: str | Path) -> ContactTable:
        """Return a table written by ``save``; DataError when the file is no such table."""
        try:
            with np.load(path, allow_pickle=False) as stored:
                return cls._restored({name: stored[name] for name in stored.files})
        except (OSError, ValueError, KeyError, EOFError) as error:
            raise DataError(
                f"{path} is not a contact table ({error})",
                where=str(path),
                allowed="a file written by ContactTable.save",
            ) from error

    @property
    def _axes(self) -> tuple[np.ndarray, np.ndarray]:
        return np.log(self.pressure), np.log(self.speed)

    def _flow(self, direction: Direction) -> np.ndarray:
        along, across = self.values["flow_factor_along"], self.values["flow_factor_across"]
        if direction == "along":
            return along
        if direction == "across":
            return across
        return 0.5 * (along + across)

    def _at(
        self, pressure: ArrayLike, speed: ArrayLike, outside: Outside
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return (pressure, ln p, ln v) broadcast, clipped to the grid if extension is allowed."""
        p, v = np.broadcast_arrays(
            np.asarray(pressure, dtype=float), np.abs(np.asarray(speed, dtype=float))
        )
        if np.any(~(p >= 0.0)) or np.any(~np.isfinite(v)) or np.any(~np.isfinite(p)):
            raise InputError(
                "pressure or speed is negative, missing or infinite",
                where=self.name,
                allowed="pressure >= 0 Pa and a finite speed",
            )
        if outside == "error":
            found = self.breaches(pressure=p, speed=v)
            if found:
                raise RangeError(
                    str(found[0]),
                    where=self.name,
                    remedy='Compute a wider table, or extend it knowingly with outside="extend"',
                )
        x = np.log(np.clip(p, self.pressure[0], self.pressure[-1]))
        return p, x, np.log(np.clip(v, self.speed[0], self.speed[-1]))

    def _arrays(self) -> dict[str, np.ndarray]:
        text = {
            "format": _FORMAT,
            "description": self.description,
            "key": self.key,
            "notes": list(self.notes),
            "out_of_range": list(self.out_of_range),
        }
        arrays = {
            "pressure": self.pressure,
            "speed": self.speed,
            "realizations": self.realizations,
            "text": np.array(json.dumps(text)),
        }
        for name in QUANTITIES:
            arrays[f"value_{name}"] = self.values[name]
            arrays[f"deviation_{name}"] = self.deviation[name]
        return arrays

    @classmethod
    def _restored(cls, arrays: Mapping[str, np.ndarray]) -> ContactTable:
        text = json.loads(str(arrays["text"]))
        if text["format"] != _FORMAT:
            raise ValueError(f"format {text['format']}, this program reads {_FORMAT}")
        return cls(
            pressure=arrays["pressure"],
            speed=arrays["speed"],
            values={name: arrays[f"value_{name}"] for name in QUANTITIES},
            deviation={name: arrays[f"deviation_{name}"] for name in QUANTITIES},
            realizations=arrays["realizations"],
            description=text["description"],
            key=text["key"],
            notes=tuple(text["notes"]),
            out_of_range=tuple(text["out_of_range"]),
        )
