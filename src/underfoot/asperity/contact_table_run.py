"""Computing a contact table: every surface, speed and pressure, cached part by part."""

from __future__ import annotations

import pickle
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from underfoot.core import (
    Cache,
    ConvergenceError,
    InputError,
    Progress,
    content_hash,
    silent,
)

from ._kernels.monotone import interpolated, pchip_slopes
from .composite import RESTING
from .contact_table import QUANTITIES, ContactTable
from .contact_table_part import Part, part_column, surface_part
from .steady_checks import Modulus

ROOM = "contact_table-1"


def computed(
    surfaces: Sequence[Any],
    modulus: Modulus,
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
    """Return the contact table of an ensemble of surfaces of one texture.

    Every node is ``steady_sliding`` followed by ``flow_factors`` on its gap, with contact closed.
    The contact fraction is the perimeter-corrected one.

    Parameters
    ----------
    surfaces
        Periodic height maps (``HeightMap``), one or more; the spread between them becomes the
        uncertainty. Their shortest wave decides the contact fraction: see
        ``cutoff_dependence``.
    modulus
        As in ``steady_sliding``.
    shoe_surfaces
        The rubber's own roughness, one periodic map for each of ``surfaces``: contact, gap and
        flow are those of ``composite_surface`` at each speed, hysteresis that of the floor alone;
        its limits are noted.
    pressure, speed
        Nodes: Pa and m/s, rising, > 0; at least 4 pressures, 1 speed.
    processes
        Worker processes; with more than 1 the modulus must be picklable (no lambda).
    cache
        Where finished parts are kept; None takes the user's cache.
    progress
        Receives the fraction done; may raise ``Cancelled``: finished parts stay in the cache.

    Errors
    ------
    InputError
        No surface, not periodic, nodes not rising, modulus that can't be sent to a process.
    ConvergenceError
        A node where no surface converged.
    """
    p, v = _nodes("pressure", pressure, 4), _nodes("speed", speed, 1)
    _check_surfaces(surfaces)
    store = Cache(ROOM) if cache is None else cache
    pairs = _pairs(surfaces, shoe_surfaces)
    parts = [
        surface_part(floor, shoe, modulus, float(u), p, poisson_ratio, layer_thickness)
        for floor, shoe in pairs
        for u in v
    ]
    results: dict[int, dict[str, np.ndarray]] = {}
    missing: list[int] = []
    keys = [part.key for part in parts]
    for n, key in enumerate(keys):
        found = store.load(key)
        if found is None:
            missing.append(n)
        else:
            results[n] = found
    progress("contact table", len(results) / len(parts))
    for n, column in _columns(parts, missing, processes):
        store.store(keys[n], column)
        results[n] = column
        progress("contact table", len(results) / len(parts))
    about = [_about(surfaces)] + ([RESTING] if shoe_surfaces is not None else [])
    return _table(about, p, v, [results[n] for n in range(len(parts))], keys, description)


def _columns(
    parts: list[Part], missing: list[int], processes: int
) -> Iterator[tuple[int, dict[str, np.ndarray]]]:
    if processes <= 1 or len(missing) < 2:
        for n in missing:
            yield n, part_column(parts[n])
        return
    try:
        pickle.dumps(parts[missing[0]].modulus)
    except Exception as error:
        raise InputError(
            f"the modulus can't be sent to another process ({error})",
            where="modulus",
            remedy="Use a material or a named function instead of a lambda, or processes=1",
        ) from error
    pool = ProcessPoolExecutor(max_workers=min(processes, len(missing)))
    try:
        waiting = {pool.submit(part_column, parts[n]): n for n in missing}
        while waiting:
            done, _ = wait(waiting, return_when=FIRST_COMPLETED)
            for future in done:
                yield waiting.pop(future), future.result()
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _table(
    about: list[str],
    p: np.ndarray,
    v: np.ndarray,
    columns: list[dict[str, np.ndarray]],
    keys: Iterable[str],
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
        kept = np.where(usable, array, 0.0)
        mean = kept.sum(axis=0) / np.maximum(count, 1)
        for row, hole in enumerate(holes):
            if hole.any():
                slopes = pchip_slopes(np.log(p[~hole]), mean[row, ~hole])
                mean[row, hole], _ = interpolated(
                    np.log(p[~hole]), mean[row, ~hole], slopes, np.log(p[hole])
                )
        square = np.where(usable, (array - mean) ** 2, 0.0).sum(axis=0)
        spread = np.sqrt(square / np.maximum(count - 1, 1))
        values[name] = mean.T
        deviation[name] = np.where(count > 1, spread, np.nan).T
    said = dict.fromkeys(str(text) for column in columns for text in column["notes"])
    notes = [text.removeprefix("note|") for text in said if text.startswith("note|")]
    notes = about + notes
    dropped = int((~usable).sum())
    if dropped:
        notes.append(f"{dropped} of {usable.size} solutions did not converge and were left out")
    notes += [
        f"no solution at {p[n]:.3g} Pa and {v[row]:.3g} m/s: interpolated between its neighbours"
        for row, n in np.argwhere(holes)
    ]
    return ContactTable(
        pressure=p,
        speed=v,
        values=values,
        deviation=deviation,
        realizations=count.T,
        description=description,
        key=content_hash(list(keys)),
        notes=tuple(notes),
        out_of_range=tuple(
            text.removeprefix("breach|") for text in said if text.startswith("breach|")
        ),
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
        raise ConvergenceError(
            f"no surface converged at {p[at[1]]:.4g} Pa and {v[at[0]]:.4g} m/s "
            f"({int(lost.sum())} such nodes)",
            history=[float(np.max(column["error"])) for column in columns],
            where="contact table",
            remedy="Leave out the highest pressures (near full contact) or take finer surfaces",
        )
    return holes


def _about(surfaces: Sequence[Any]) -> str:
    first = surfaces[0]
    shortest = [s.resolution if s.resolution is not None else 2.0 * s.spacing for s in surfaces]
    nx, ny = first.heights.shape
    return (
        f"{len(surfaces)} surface(s) of {nx} x {ny} points, spacing {first.spacing * 1e6:.3g} um, "
        f"shortest wave {max(shortest) * 1e6:.3g} um: contact fraction and "
        "hysteresis belong to this shortest wave"
    )


def _nodes(name: str, given: ArrayLike, least: int) -> np.ndarray:
    values = np.atleast_1d(np.asarray(given, dtype=float))
    good = values.ndim == 1 and values.size >= least and np.all(np.isfinite(values))
    if not (good and values[0] > 0.0 and np.all(np.diff(values) > 0.0)):
        raise InputError(
            f"{name} nodes {given}",
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
        raise InputError(
            f"{len(shoes)} shoe surfaces for {len(floors)} floors",
            where="shoe_surfaces",
            allowed="one for each floor",
        )
    return list(zip(floors, shoes, strict=True))


def _check_surfaces(surfaces: Sequence[Any]) -> None:
    if len(surfaces) == 0:
        raise InputError("no surface", where="surfaces", allowed="one height map or more")
    for n, surface in enumerate(surfaces):
        if not surface.periodic:
            raise InputError(
                f"surface {n + 1} is not periodic",
                where="surfaces",
                remedy="Make it periodic first (taper or mirror its edges), or generate surfaces "
                "from its spectrum",
            )
