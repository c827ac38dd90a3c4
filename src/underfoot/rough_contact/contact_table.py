"""Rough contact over pressure and speed, computed once and interpolated with its limits."""

from __future__ import annotations

import json
import pickle
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby, islice
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from underfoot import core
from underfoot.core.arrays import Array
from underfoot.core.deprecation import renamed_member
from underfoot.core.device import card, on_card
from underfoot.core.pool import in_processes
from underfoot.core.presentation import Presentable, Table
from underfoot.core.remark import Amount, Message
from underfoot.surface import HeightMap

from ._kernels.monotone import interpolated_grid
from .composite import RESTING, composite_surface
from .flow_factor import flow_factors
from .pressure_gap_law import TabulatedLaw
from .sliding_input import Modulus, check_map, modulus_function, slow_transform
from .steady import SteadySliding, contacts_on_card, steady_sliding

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
_ARRAYS = ("pressure", "speed", "realizations")
_TEXTS = ("description", "key", "notes", "out_of_range")
ROOM = "contact_table-4"
"""Of the cache; raised when the numbers or the form of a part change."""
_REFINEMENT = 8
SEALED = 1e-6
"""Flow factor of a contact without an open path on its grid (assumed): waves below the shortest one
leak, and a film solver needs a way for every cell."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ContactTable(Presentable):
    """Averages of one rough contact on a grid of nominal pressures and sliding speeds.

    Between the nodes every quantity is a monotone cubic in ln(pressure) and ln(speed), the
    contact fraction in its logarithm. ``outside="error"`` refuses to leave the grid;
    ``outside="extend"`` holds the edge value, except that below the lowest pressure the contact
    fraction is proportional to pressure and the gap grows as pressure decays exponentially.

    ``pressure`` (Pa, (n,)) and ``speed`` (m/s, (m,)) rise. ``values`` and ``deviation`` hold mean
    and sample standard deviation over the surfaces, (n, m), per name in QUANTITIES (a deviation is
    not a number where fewer than two surfaces were computed), ``realizations`` the number of
    surfaces behind every node. ``notes`` say what a reader must know: surfaces, missing nodes,
    assumptions, why friction is zero.
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
        surfaces: Sequence[HeightMap],
        modulus: Modulus,
        pressure: ArrayLike,
        speed: ArrayLike,
        *,
        shoe_surfaces: Sequence[HeightMap] | None = None,
        finer: ContactTable | None = None,
        poisson_ratio: float = 0.5,
        layer_thickness: float | None = None,
        processes: int = 1,
        device: str = "cpu",
        cache: core.Cache | None = None,
        description: str = "",
        progress: core.Progress = core.silent,
    ) -> ContactTable:
        """Return the contact table of an ensemble of surfaces of one texture.

        Every node is ``steady_sliding`` followed by ``flow_factors`` on its gap, with contact
        closed. The contact fraction is the perimeter-corrected one.

        Parameters:
            surfaces: Periodic height maps (``HeightMap``), one or more (seeds of one texture); the
                spread between them becomes the uncertainty. Their shortest wave decides the contact
                fraction: see ``cutoff_dependence``.
            modulus, poisson_ratio, layer_thickness: As in ``steady_sliding``.
            pressure, speed: Nodes: Pa and m/s, rising, > 0; at least 4 pressures, 1 speed.
            shoe_surfaces: The rubber's own roughness, one periodic map for each of ``surfaces``:
                contact, gap and flow are those of ``composite_surface`` at each speed, hysteresis
                that of the floor alone; its limits are noted.
            finer: Table of the waves that the surfaces leave out, at the same speeds: what they do
                at the pressure of each point of contact counts (``table_over_scales``).
            processes: Worker processes; with more than 1 the modulus must be picklable (no lambda).
            device: "cpu"; "cuda", contacts on the graphics card, all of a surface side by side
                (extra ``accelerator``); "auto": there from 512 x 512 points on where there is one.
                Flow factors are the processor's. A note tells the card and the time.
            cache: Where finished parts are kept; None takes the user's cache.
            progress: Receives the fraction done; may raise ``Cancelled``: finished parts stay in
                the cache.

        Raises:
            InputError: No surface, not periodic, oblong cells, nodes not rising, modulus that can't
                be sent to a process, no such device.
            ConvergenceError: A node where no surface converged.
        """
        p, v = _nodes("pressure", pressure, 4), _nodes("speed", speed, 1)
        _check_surfaces(surfaces)
        accelerated = on_card(device, max(surface.heights.size for surface in surfaces))
        store = core.Cache(ROOM) if cache is None else cache
        parts = []
        for floor, shoe in _pairs(surfaces, shoe_surfaces):
            alone = np.asarray(floor.heights)
            for u in v.tolist():
                both = None if shoe is None else composite_surface(floor, shoe, modulus, u).heights
                given = (floor.spacing, modulus, u, p, poisson_ratio, layer_thickness)
                heights = (alone, None) if both is None else (both, alone)
                parts.append(_Part(heights[0], *given, heights[1], finer, accelerated))
        keys = [part.key for part in parts]
        columns = [store.load(key) for key in keys]
        missing = [n for n, column in enumerate(columns) if column is None]
        if processes > 1 and len(missing) > 1:
            _check_sendable(modulus)
        done = len(parts) - len(missing)
        progress("contact table", done / len(parts))
        rest = [parts[n] for n in missing]
        began = time.perf_counter()
        columns_of = (
            _columns_on_card(rest)
            if accelerated
            else in_processes(_column, rest, max(processes, 1))
        )
        for index, column in columns_of:
            columns[missing[index]] = column
            store.store(keys[missing[index]], column)
            done += 1
            progress("contact table", done / len(parts))
        about = [_about(surfaces, finer), *([RESTING] if shoe_surfaces is not None else [])]
        slow = {slow_transform(surface.heights.shape) for surface in surfaces} - {None}
        about += sorted(map(str, slow))
        if accelerated:
            took = time.perf_counter() - began
            cost = {"count": len(rest) * p.size, "card": card(), "time": took}
            about.append(Message("{count} contacts on {card}, {time:.1f} s", **cost))
        finished = [column for column in columns if column is not None]
        return _table(about, p, v, finished, keys, description)

    def table(self) -> Table:
        """Return the nodes, one row a pressure and speed, with the spread between surfaces."""
        columns = [
            label for name in QUANTITIES for label in (f"{name.replace('_', ' ')}", f"{name} ±")
        ]
        numbers = [part[name] for name in QUANTITIES for part in (self.values, self.deviation)]
        rows = [
            [p, v, *(array[i, j] for array in numbers)]
            for i, p in enumerate(self.pressure.tolist())
            for j, v in enumerate(self.speed.tolist())
        ]
        title = f"Contact table: {self.description or 'rough contact'}"
        return Table(title, ("pressure Pa", "speed m/s", *columns), rows)

    def heading(self) -> str:
        """Return what is in contact."""
        return f"Contact table: {self.description or 'rough contact'}"

    def headline(self) -> tuple[Message, ...]:
        """Return the contact at the middle pressure and speed."""
        p, v = (float(nodes[nodes.size // 2]) for nodes in (self.pressure, self.speed))
        return (
            Message(
                "At {pressure} and {speed}: real contact {contact:.3g} %, hysteresis COF "
                "{hysteresis:.2g}, mean gap {gap}, flow factor {flow:.2g}.",
                pressure=Amount(p, "Pa"), speed=Amount(v, "m/s"),
                contact=100 * float(self.real_contact_fraction(p, v)),
                hysteresis=float(self.cof_hysteresis(p, v)),
                gap=Amount(float(self.mean_gap(p, v)), "m"), flow=float(self.flow_factor(p, v)),
            ),
        )  # fmt: skip

    def tables(self) -> tuple[Table, ...]:
        """Return the nodes without their spread, units for people."""
        rows = [
            (
                core.display(p, "Pa"),
                core.display(v, "m/s"),
                f"{100 * float(self.real_contact_fraction(p, v)):.3g} %",
                f"{float(self.cof_hysteresis(p, v)):.2g}",
                core.display(float(self.mean_gap(p, v)), "m"),
                f"{float(self.flow_factor(p, v)):.2g}",
            )
            for v in self.speed.tolist()
            for p in self.pressure.tolist()
        ]
        heads = ("Pressure", "Speed", "Real contact", "Hysteresis COF", "Mean gap", "Flow factor")
        return (Table("Nodes", heads, rows),)

    def remarks(self) -> dict[str, Sequence[str]]:
        """Return what a reader must know, and what left a tested range."""
        return {"Notes": self.notes, "Outside the tested range": self.out_of_range}

    def __repr__(self) -> str:
        p, v = (
            f"{core.display(nodes[0], unit)} to {core.display(nodes[-1], unit)}"
            for nodes, unit in ((self.pressure, "Pa"), (self.speed, "m/s"))
        )
        count = int(self.realizations.max())
        return f"ContactTable({self.description[:60]!r}, {p}, {v}, {count} surfaces)"

    @property
    def ranges(self) -> dict[str, core.ValidityRange]:
        """Return the validity box: the pressures and speeds of the grid."""
        return {
            "pressure": core.ValidityRange(
                float(self.pressure[0]), float(self.pressure[-1]), "Pa", "grid"
            ),
            "speed": core.ValidityRange(float(self.speed[0]), float(self.speed[-1]), "m/s", "grid"),
        }

    def breaches(self, *, pressure: ArrayLike, speed: ArrayLike) -> list[core.Breach]:
        """Return what leaves the grid (speed by its magnitude)."""
        values = {"pressure": pressure, "speed": np.abs(np.asarray(speed, dtype=float))}
        return core.breaches(self.name, self.ranges, values)

    def real_contact_fraction(
        self, pressure: ArrayLike, speed: ArrayLike, outside: Outside = "error"
    ) -> Array:
        """Return the real over the nominal contact area at p (Pa) and v (m/s)."""
        p, *at = self._at(pressure, speed, outside)
        floor = np.finfo(float).tiny
        value, _ = self._through(
            np.log(np.maximum(self.values["real_contact_fraction"], floor)), at
        )
        return np.exp(value) * np.minimum(p / self.pressure[0], 1.0)

    def cof_hysteresis(
        self, pressure: ArrayLike, speed: ArrayLike, outside: Outside = "error"
    ) -> Array:
        """Return the hysteresis COF; it takes the sign of the speed."""
        _, *at = self._at(pressure, speed, outside)
        value, _ = self._through(self.values["cof_hysteresis"], at)
        return value * np.where(np.asarray(speed, dtype=float) < 0.0, -1.0, 1.0)

    def mean_gap(self, pressure: ArrayLike, speed: ArrayLike, outside: Outside = "error") -> Array:
        """Return the mean gap (m), contact counted as zero.

        In the extension a pressure of zero counts as a millionth of the lowest one.
        """
        p, *at = self._at(pressure, speed, outside)
        value, slope = self._through(self.values["mean_gap"], at)
        below = np.log(np.clip(p / self.pressure[0], 1e-6, 1.0))
        return value + np.where(below < 0.0, slope * below, 0.0)

    def flow_factor(
        self,
        pressure: ArrayLike,
        speed: ArrayLike,
        direction: Direction = "mean",
        outside: Outside = "error",
    ) -> Array:
        """Return the pressure flow factor phi; flow is phi h^3/(12 eta) with h the mean gap."""
        _, *at = self._at(pressure, speed, outside)
        chosen = ("along", "across") if direction == "mean" else (direction,)
        nodes = np.mean([self.values[f"flow_factor_{name}"] for name in chosen], axis=0)
        return self._through(nodes, at)[0]

    def sourced_value(self, quantity: str, pressure: float, speed: float) -> core.SourcedValue:
        """Return one interpolated quantity with the spread between surfaces as uncertainty."""
        if quantity not in QUANTITIES:
            raise core.unknown_name("quantity", quantity, QUANTITIES, where=self.name)
        _, *at = self._at(pressure, speed, "error")
        value, _ = self._through(self.values[quantity], at)
        if quantity == "real_contact_fraction":
            value = self.real_contact_fraction(pressure, speed)
        spread, reason = None, "only one surface was computed"
        if np.all(np.isfinite(self.deviation[quantity])):
            deviation, _ = self._through(self.deviation[quantity], at)
            spread, reason = max(float(deviation), 0.0), ""
        return core.SourcedValue(
            value=float(value),
            unit=QUANTITIES[quantity],
            source=f"{self.name}: {self.description}",
            uncertainty=spread,
            reason=reason,
            note="uncertainty: standard deviation between surfaces of one texture",
        )

    sourced = renamed_member("sourced", "sourced_value", gone="0.4")

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
            keep += [n] if gap[n] < gap[keep[-1]] - 1e-6 * gap[0] else []
        if len(keep) < 3:
            raise core.RangeError(
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
            node_flow_factor=np.maximum(flow[order], SEALED),
            speed=abs(float(speed)),
            ranges=self.ranges,
        )

    def scale_contact(self, gap: float, pressure: float, speed: float) -> ContactTable:
        """Return the table of an elastic contact alike, gaps and pressures times factors above 0.

        Heights times a make gaps times a, and pressures times a and the ratio of E / (1 - nu^2).
        Elastic contacts are the same at every speed: the nodes are moved to ``speed`` (m/s).
        """
        factors = {name: gap if name == "mean_gap" else 1.0 for name in QUANTITIES}
        values, deviation = (
            {name: factors[name] * nodes for name, nodes in part.items()}
            for part in (self.values, self.deviation)
        )
        nodes = {"pressure": pressure * self.pressure, "speed": np.array([abs(speed)])}
        return replace(self, **nodes, values=values, deviation=deviation)

    scaled = renamed_member("scaled", "scale_contact", gone="0.4")

    def save(self, path: str | Path) -> None:
        """Write the table as one compressed NumPy archive (.npz)."""
        text = {name: getattr(self, name) for name in _TEXTS}
        arrays: dict[str, Any] = {
            "text": np.array(json.dumps({"format": _FORMAT, **text})),
            **{name: getattr(self, name) for name in _ARRAYS},
            **{f"value_{name}": self.values[name] for name in QUANTITIES},
            **{f"deviation_{name}": self.deviation[name] for name in QUANTITIES},
        }
        with Path(path).open("wb") as stream:
            np.savez_compressed(stream, **arrays)

    @classmethod
    def load(cls, path: str | Path) -> ContactTable:
        """Return a table written by ``save``; DataError when the file is no such table."""
        try:
            with np.load(path, allow_pickle=False) as stored:
                text = json.loads(str(stored["text"]))
                if text["format"] != _FORMAT:
                    raise ValueError(f"format {text['format']}, this program reads {_FORMAT}")
                return cls(
                    **{name: stored[name] for name in _ARRAYS},
                    values={name: stored[f"value_{name}"] for name in QUANTITIES},
                    deviation={name: stored[f"deviation_{name}"] for name in QUANTITIES},
                    description=text["description"],
                    key=text["key"],
                    notes=tuple(text["notes"]),
                    out_of_range=tuple(text["out_of_range"]),
                )
        except (OSError, ValueError, KeyError, EOFError) as error:
            raise core.DataError(
                f"{path} is not a contact table ({error})",
                where=str(path),
                allowed="a file that underfoot contact --table wrote, or ContactTable.save",
            ) from error

    def _through(self, nodes: np.ndarray, at: Sequence[np.ndarray]) -> tuple[Array, Array]:
        """Return value and slope by ln(pressure) of the cubic through ``nodes``."""
        return interpolated_grid(np.log(self.pressure), np.log(self.speed), nodes, *at)

    def _at(
        self, pressure: ArrayLike, speed: ArrayLike, outside: Outside
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return (pressure, ln p, ln v) broadcast, clipped to the grid if extension is allowed."""
        p, v = np.broadcast_arrays(
            np.asarray(pressure, dtype=float), np.abs(np.asarray(speed, dtype=float))
        )
        if np.any(~(p >= 0.0)) or np.any(~np.isfinite(v)) or np.any(~np.isfinite(p)):
            raise core.InputError(
                "pressure or speed is negative, missing or infinite",
                where=self.name,
                allowed="pressure >= 0 Pa and a finite speed",
            )
        if outside == "error":
            outside_grid = self.breaches(pressure=p, speed=v)
            if outside_grid:
                raise core.RangeError(
                    str(outside_grid[0]),
                    where=self.name,
                    remedy="Compute one there (underfoot contact --speed), or extend it with "
                    'outside="extend"',
                )
        x = np.log(np.clip(p, self.pressure[0], self.pressure[-1]))
        return p, x, np.log(np.clip(v, self.speed[0], self.speed[-1]))


class _Part(NamedTuple):
    """One surface at one speed: the unit of work and of the cache.

    ``floor_heights`` is the floor alone where ``heights`` is a composite: its hysteresis counts.
    """

    heights: np.ndarray
    spacing: float
    modulus: Any
    speed: float
    pressure: np.ndarray
    poisson_ratio: float
    layer_thickness: float | None
    floor_heights: np.ndarray | None = None
    finer: ContactTable | None = None
    on_card: bool = False

    @property
    def key(self) -> str:
        """Return the content key: heights, loads, modulus at every frequency."""
        q = 2.0 * np.pi * np.fft.rfftfreq(self.heights.shape[0], self.spacing)
        young = modulus_function(self.modulus, q * self.speed)(q * self.speed)
        finer = self.finer and self.finer.key
        *fields, on_card = self._replace(modulus=young, finer=finer)
        return core.content_hash(*fields, *(["cuda"] if on_card else []))


def _column(part: _Part) -> dict[str, np.ndarray]:
    """Return the averages of one surface at one speed over all pressures, with their remarks."""

    def contacts_of(heights: np.ndarray) -> Iterator[SteadySliding]:
        for p in part.pressure.tolist():
            given = (part.spacing, part.modulus, part.speed, p, part.poisson_ratio)
            yield steady_sliding(heights, *given, layer_thickness=part.layer_thickness)

    floor = part.floor_heights
    return _average_part(
        part, contacts_of(part.heights), None if floor is None else contacts_of(floor)
    )


def _columns_on_card(parts: list[_Part]) -> Iterator[tuple[int, dict[str, np.ndarray]]]:
    """Yield (number, ``_column``) of parts whose contacts the graphics card solves in batches."""

    def contacts_of(name: str) -> Iterator[SteadySliding]:
        for _, run in groupby(parts, lambda part: id(getattr(part, name))):
            first, *others = run
            loads = [(p, part.speed) for part in (first, *others) for p in part.pressure.tolist()]
            given = (first.spacing, first.modulus, loads, first.poisson_ratio)
            thickness = first.layer_thickness
            yield from contacts_on_card(getattr(first, name), *given, layer_thickness=thickness)

    contacts, frictions = contacts_of("heights"), contacts_of("floor_heights")
    for n, part in enumerate(parts):
        yield n, _average_part(part, contacts, None if part.floor_heights is None else frictions)


def _average_part(
    part: _Part, contacts: Iterator[SteadySliding], frictions: Iterator[SteadySliding] | None
) -> dict[str, np.ndarray]:
    """Return the column of a part from the next contacts, one for each pressure."""
    rows: list[list[float]] = []
    errors: list[float] = []
    remarks: list[str] = []
    out_of_range: list[str] = []
    for contact in islice(contacts, part.pressure.size):
        friction = contact if frictions is None else next(frictions)
        errors.append(max(contact.complementarity_error, friction.complementarity_error))
        if not (contact.status.usable and friction.status.usable):
            rows.append([np.nan] * len(QUANTITIES))
            continue
        rows.append(_averages(contact, friction, part))
        out_of_range += [str(breach) for breach in contact.breaches]
        remarks += [contact.negligible_loss] if contact.negligible_loss else []
    column = dict(zip(QUANTITIES, np.array(rows).T, strict=True))
    column["error"] = np.array(errors)
    column["remarks"] = np.array(list(dict.fromkeys(remarks)), dtype=np.str_)
    column["out_of_range"] = np.array(list(dict.fromkeys(out_of_range)), dtype=np.str_)
    return column


def _averages(contact: SteadySliding, friction: SteadySliding, part: _Part) -> list[float]:
    """Return the QUANTITIES of a contact; the hysteresis is that of ``friction``.

    Finer waves meet the pressure of each point of contact: area and hysteresis are the means of
    theirs over the contact, the gap is theirs on top of that of the grid, and fluid crosses points
    of contact through what they leave open. Points out of contact stand off by their gap at the
    mean pressure of the contact; their effect on the flow there fades with the square of the gap.
    """
    gap, finer = np.where(contact.pressure > 0.0, 0.0, contact.gap), part.finer
    if finer is None:
        flow = flow_factors(gap, part.spacing)
        area, hysteresis = contact.real_contact_fraction_corrected, friction.cof_hysteresis
        return [area, hysteresis, contact.mean_gap, flow.along, flow.across]
    pressure, loaded, speed = contact.pressure, friction.pressure, part.speed
    area = float(finer.real_contact_fraction(pressure, speed, "extend").mean())
    # above the nodes the finer waves are in full contact: their loss no longer grows with pressure
    bearing = np.minimum(loaded, finer.pressure[-1])
    more = float(np.vdot(bearing, finer.cof_hysteresis(bearing, speed, "extend")) / loaded.sum())
    closed = pressure > 0.0
    felt = np.where(closed, pressure, pressure.sum() / max(int(closed.sum()), 1))
    below = np.maximum(finer.mean_gap(felt, speed, "extend"), 0.0)
    factor = finer.flow_factor(felt, speed, outside="extend")
    whole, hysteresis = gap + below, friction.cof_hysteresis + more
    mean = float(whole.mean())
    if mean == 0.0:
        return [area, hysteresis, 0.0, 0.0, 0.0]
    share = np.divide(below, whole, out=np.ones_like(whole), where=whole > 0)
    factor = np.clip(1.0 - (1.0 - factor) * share**2, 0.0, 1.0)
    flow = flow_factors(whole * np.cbrt(factor), part.spacing)
    scale = (flow.mean_gap / mean) ** 3
    return [area, hysteresis, mean, scale * flow.along, scale * flow.across]


def _check_sendable(modulus: Modulus) -> None:
    try:
        pickle.dumps(modulus)
    except Exception as error:
        raise core.InputError(
            f"the modulus can't be sent to another process ({error})",
            where="modulus",
            remedy="Use a material or a named function instead of a lambda, or processes=1",
        ) from error


def _table(
    about: list[str],
    p: np.ndarray,
    v: np.ndarray,
    columns: list[dict[str, np.ndarray]],
    keys: list[str],
    description: str,
) -> ContactTable:
    shape = (len(columns) // v.size, v.size, p.size)
    stacked = {
        name: np.array([column[name] for column in columns]).reshape(shape) for name in QUANTITIES
    }
    usable = np.isfinite(stacked["mean_gap"])
    count = usable.sum(axis=0)
    holes = _holes(count, p, v, columns)
    values, deviation = {}, {}
    for name, array in stacked.items():
        mean = np.where(usable, array, 0.0).sum(axis=0) / np.maximum(count, 1)
        for row, hole in enumerate(holes):
            if hole.any():
                from scipy.interpolate import PchipInterpolator

                through = PchipInterpolator(np.log(p[~hole]), mean[row, ~hole])
                mean[row, hole] = through(np.log(p[hole]))
        square = np.where(usable, (array - mean) ** 2, 0.0).sum(axis=0)
        spread = np.sqrt(square / np.maximum(count - 1, 1))
        values[name] = mean.T
        deviation[name] = np.where(count > 1, spread, np.nan).T
    remarks, out_of_range = (
        list(dict.fromkeys(str(text) for column in columns for text in column[name]))
        for name in ("remarks", "out_of_range")
    )
    notes = about + remarks
    dropped = int((~usable).sum())
    if dropped:
        notes.append(
            Message(
                "{dropped} of {count} solutions did not converge and were left out",
                dropped=dropped, count=usable.size,
            )
        )  # fmt: skip
    notes += [
        Message(
            "no solution at {pressure:.3g} Pa and {speed:.3g} m/s: interpolated between its "
            "neighbours",
            pressure=p[n],
            speed=v[row],
        )
        for row, n in np.argwhere(holes)
    ]
    return ContactTable(
        pressure=p,
        speed=v,
        values=values,
        deviation=deviation,
        realizations=count.T,
        description=description,
        key=core.content_hash(keys),
        notes=tuple(notes),
        out_of_range=tuple(out_of_range),
    )


def _holes(
    count: np.ndarray, p: np.ndarray, v: np.ndarray, columns: list[dict[str, np.ndarray]]
) -> np.ndarray:
    """Return the nodes without a solution; they are bridged only one by one and not at an end."""
    holes = count == 0
    bridged = holes.copy()
    bridged[:, [0, -1]] = False
    bridged[:, 1:] &= ~holes[:, :-1]
    bridged[:, :-1] &= ~holes[:, 1:]
    lost = holes & ~bridged
    if lost.any():
        at = np.argwhere(lost)[0]
        raise core.ConvergenceError(
            f"no surface converged at {p[at[1]]:.4g} Pa and {v[at[0]]:.4g} m/s "
            f"({int(lost.sum())} such nodes)",
            history=[float(np.max(column["error"])) for column in columns],
            where="contact table",
            remedy="Leave out the highest pressures (near full contact) or take finer surfaces",
        )
    return holes


def _about(surfaces: Sequence[Any], finer: ContactTable | None) -> Message:
    first = surfaces[0]
    shortest = [s.resolution if s.resolution is not None else 2.0 * s.spacing for s in surfaces]
    nx, ny = first.heights.shape
    several = Message(
        "{count} surface(s) of {nx} x {ny} points, spacing {spacing}, shortest wave {wave}",
        count=len(surfaces), nx=nx, ny=ny, spacing=Amount(first.spacing, "m"),
        wave=Amount(max(shortest), "m"),
    )  # fmt: skip
    if finer is not None:
        return Message("{several}; in it {fine}", several=several, fine=finer.notes[0])
    return Message(
        "{several}: contact fraction and hysteresis belong to this shortest wave", several=several
    )


def _nodes(name: str, nodes: ArrayLike, least: int) -> np.ndarray:
    values = np.atleast_1d(np.asarray(nodes, dtype=float))
    good = values.ndim == 1 and values.size >= least and np.all(np.isfinite(values))
    if not (good and values[0] > 0.0 and np.all(np.diff(values) > 0.0)):
        raise core.InputError(
            f"{name} nodes {nodes}",
            where=name,
            allowed=f"{least} or more rising values above zero",
            remedy="For example numpy.geomspace(low, high, 8)",
        )
    return values


def _pairs(floors: Sequence[Any], shoes: Sequence[Any] | None) -> list[tuple[Any, Any]]:
    if shoes is None:
        return [(floor, None) for floor in floors]
    _check_surfaces(shoes)
    if len(shoes) != len(floors):
        raise core.InputError(
            f"{len(shoes)} shoe surfaces for {len(floors)} floors",
            where="shoe_surfaces",
            allowed="one for each floor",
        )
    return list(zip(floors, shoes, strict=True))


def _check_surfaces(surfaces: Sequence[Any]) -> None:
    if len(surfaces) == 0:
        raise core.InputError("no surface", where="surfaces", allowed="one height map or more")
    for n, surface in enumerate(surfaces):
        check_map(surface, f"surfaces[{n}]")


def leave_out_errors(table: ContactTable, axis: str = "pressure") -> dict[str, float]:
    """Return the largest interpolation error at every second node when those are left out.

    The contact fraction is relative; the mean gap relative to the largest gap of the table;
    the others absolute. ``axis`` is "pressure" or "speed". The node distance is doubled, so that
    the table itself is several times better than this between its nodes.

    Raises:
        InputError: Fewer than 5 pressures or 5 speeds.
    """
    nodes = {"pressure": table.pressure, "speed": table.speed}[axis]
    if nodes.size < 5:
        raise core.InputError(
            f"{nodes.size} {axis} nodes", where="leave_out_errors", allowed="5 or more"
        )
    removed = np.arange(1, nodes.size - 1, 2)
    retained = np.setdiff1d(np.arange(nodes.size), removed)
    index = (retained, slice(None)) if axis == "pressure" else (slice(None), retained)
    coarse = replace(
        table,
        pressure=table.pressure[index[0]],
        speed=table.speed[index[1]],
        values={name: array[index] for name, array in table.values.items()},
        deviation={name: array[index] for name, array in table.deviation.items()},
        realizations=table.realizations[index],
    )
    p, v = np.meshgrid(table.pressure, table.speed, indexing="ij")
    at_nodes = {name: getattr(coarse, name)(p, v) for name in list(QUANTITIES)[:3]}
    for direction in ("along", "across"):
        at_nodes[f"flow_factor_{direction}"] = coarse.flow_factor(p, v, direction)
    errors = {name: np.abs(at_nodes[name] - table.values[name]) for name in QUANTITIES}
    errors["real_contact_fraction"] /= table.values["real_contact_fraction"]
    errors["mean_gap"] /= table.values["mean_gap"].max()
    return {name: float(error.max()) for name, error in errors.items()}
