"""What a fluid-pressure sensor in the floor reads under a sliding sole."""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import sparse

from underfoot.core import InputError, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive
from underfoot.core.remark import Message

_SOURCE = "pocket at uniform pressure in the computed film, Eq. (27)"
GAP_CAP = 0.3e-3
"""m, gap from which a pocket vents freely (assumed)."""
_SMALLEST_GAP = 1e-7
"""m: keeps the weights of a fully sealed rim defined; far below any computed mean gap."""
REACH = 15e-3
"""m, distance from the inlet's middle at which the film does not feel the pocket (assumed)."""
BLIND = 0.5
"""Share of the film's own pressure that an inlet must read to see the film at a place."""


@dataclass(frozen=True)
class SensorReading:
    """Reading of one instrument, averaged over where its tracks may lie across the shoe.

    ``load`` (N) and ``peak_pressure`` (Pa) are means over the lateral offsets with their standard
    deviation as uncertainty. ``pressure`` (len(x), len(scan_y)) is the map for the central offset,
    with ``peak_position`` (x, y) in m. ``outermost_share`` is the share of the load read by the
    first and last scan: when it is not small, the scans do not cover the film.
    """

    load: SourcedValue
    peak_pressure: SourcedValue
    peak_position: tuple[float, float]
    x: Array
    scan_y: Array
    pressure: Array
    outermost_share: float
    loads: Array
    peaks: Array
    _film: tuple[Array, Array, Array, Array] = field(repr=False)  # x, y, pressure and thickness
    _pocket: dict[str, float] = field(repr=False)

    @cached_property
    def seen(self) -> float:
        """Share of the film's load where the inlet reads at least half of the film's pressure."""
        x, y, pressure, gap = self._film
        read, _ = pocket_pressure(x, y, pressure, gap, x, y, **self._pocket)
        return seen_share(pressure, read)


def floor_sensor_reading(
    x: ArrayLike,
    y: ArrayLike,
    fluid_pressure: ArrayLike,
    film_thickness: ArrayLike,
    *,
    inlet_diameter: float = 10e-3,
    scan_spacing: float = 10e-3,
    scans: int = 7,
    sampling_step: float = 0.7e-3,
    gap_cap: float = GAP_CAP,
    offsets: int = 11,
    compliance: float = 0.0,
    viscosity: float = 0.0,
    speed: float = 0.0,
) -> SensorReading:
    """Return the fluid load and the peak pressure as a sensor in the floor would give them.

    The inlet is a pocket of one pressure, filled and vented through its rim: the reading is the
    mean of the film pressure over the rim weighted by h^3, with p = 0 outside the film. The load
    is that of Eq. (27): sum of p * scan_spacing * sampling_step over all scans. Scans are centred
    on y = 0; the whole set is shifted sideways to ``offsets`` places within one scan spacing.

    Parameters:
        x, y: Cell centres of a square grid, m.
        fluid_pressure: (nx, ny), Pa, 0 outside the film.
        film_thickness: (nx, ny), mean gap, m.
        inlet_diameter: m; 0 is a point. The report: 10 mm (G.4.1) and 4 mm (G.5.1).
        scan_spacing, scans: Distance of the tracks, m, and their number (G.4.1: 10 mm, 7).
        sampling_step: Way between two samples, m: sliding speed times sampling interval (G.4.1: 0.7
            m/s x 1 ms).
        gap_cap: Largest gap in the weights, m (assumed): in a gap this deep the pocket vents
            freely.
        offsets: Number of lateral places, odd.
        compliance: Volume that the instrument takes in under pressure, C, m^3/Pa; 0 follows the
            film at once.
        viscosity, speed: Of the fluid, Pa s, and of the shoe along +x, m/s; needed with
            ``compliance``.

    The pocket does not change the film. With a compliance C dp/dt = K (p_rim - p), where
    K = 2 pi <h^3> / (12 eta ln(15 mm / r)) is the conductance of the film around an inlet of
    radius r. Source of Eq. (27): final progress report on shoe-floor friction, G.4.1; the pocket
    model is assumed, not tested by measurement.

    Raises:
        InputError: Shapes that don't match, a pressure or gap that is not finite, an instrument
            that can't be.
    """
    film = along, *_ = _checked_maps(x, y, fluid_pressure, film_thickness)
    not_negative(inlet_diameter, "sensor.inlet_diameter")
    positive(scan_spacing, "sensor.scan_spacing")
    positive(sampling_step, "sensor.sampling_step")
    positive(gap_cap, "sensor.gap_cap")
    if not_negative(compliance, "sensor.compliance"):
        positive(inlet_diameter, "sensor.inlet_diameter")
        positive(viscosity, "sensor.viscosity")
        positive(speed, "sensor.speed")
    for name, count in (("scans", scans), ("offsets", offsets)):
        if int(count) != count or count < 1:
            raise InputError(
                Message("{given} is no count", given=count),
                where=f"sensor.{name}",
                allowed="a whole number, 1 or more",
            )
    if offsets % 2 == 0:
        raise InputError(
            Message("{offsets} is even", offsets=offsets),
            where="sensor.offsets",
            allowed="an odd number",
        )
    spacing = float(along[1] - along[0])
    reach = 0.5 * inlet_diameter + spacing
    count = math.ceil((along[-1] - along[0] + 2 * reach) / sampling_step) + 1
    middle = 0.5 * (along[0] + along[-1])
    places = middle + (np.arange(count, dtype=np.float64) - 0.5 * (count - 1)) * sampling_step
    tracks = (np.arange(scans, dtype=np.float64) - 0.5 * (scans - 1)) * scan_spacing
    shifts = (np.arange(offsets) - offsets // 2) * (scan_spacing / offsets)
    lanes = (tracks[None, :] + shifts[:, None]).ravel()
    pocket = {"inlet_diameter": inlet_diameter, "gap_cap": gap_cap, "spacing": spacing}
    read, cubes = pocket_pressure(*film, places, lanes, **pocket)
    if compliance > 0:
        # the shoe goes forward: a sensor meets its front first
        rate = cubes * conductance_over_cube(inlet_diameter, viscosity) / compliance
        read = lag_pressure(read[::-1], rate[::-1], sampling_step / speed)[::-1]
    read = read.reshape(count, offsets, scans)
    scan_loads = read.sum(axis=0) * scan_spacing * sampling_step
    loads = scan_loads.sum(axis=1)
    peaks = read.max(axis=(0, 2))
    central = np.ascontiguousarray(read[:, offsets // 2, :])
    top = np.unravel_index(int(central.argmax()), central.shape)
    outer = scan_loads[:, [0, -1]].sum() if scans > 1 else scan_loads.sum()
    total = float(loads.sum())
    spread = "spread over where the tracks lie"
    return SensorReading(
        load=over_places(loads, "N", _SOURCE, spread),
        peak_pressure=over_places(peaks, "Pa", _SOURCE, spread),
        peak_position=(float(places[top[0]]), float(tracks[top[1]])),
        x=places,
        scan_y=tracks,
        pressure=central,
        outermost_share=float(outer) / total if total > 0 else 0.0,
        loads=loads,
        peaks=peaks,
        _film=film,
        _pocket=pocket,
    )


def pocket_pressure(
    x: Array,
    y: Array,
    fluid_pressure: Array,
    film_thickness: Array,
    places: Array,
    lanes: Array,
    *,
    inlet_diameter: float,
    gap_cap: float,
    spacing: float,
) -> tuple[Array, Array]:
    """Return reading and mean h^3 at the rim (places x lanes) of pockets at x and y given.

    Mean film pressure over the rim weighted by h^3; lengths in m, maps (nx, ny) as in
    ``floor_sensor_reading``, which checks them.
    """
    along, across = (places - x[0]) / spacing, (lanes - y[0]) / spacing
    quarter = _rim_quarter(inlet_diameter, spacing) / spacing
    points = np.arange(len(quarter), dtype=np.int32)[:, None]
    sides = quarter[:, :, None] * [1.0, -1.0]
    rows = _interpolation(along[:, None, None] + sides[:, 0], x.size, points)
    columns = _interpolation((across[:, None] + sides[:, 1, None]).reshape(-1, 2), y.size)

    def mean_over_rim(field: Array) -> Array:
        lines = (columns @ field.T).reshape(points.size, lanes.size, x.size)
        return (rows @ lines.transpose(0, 2, 1).reshape(-1, lanes.size)) / (4 * points.size)

    cap = gap_cap**3
    cubes = np.clip(np.asarray(film_thickness, dtype=float), _SMALLEST_GAP, gap_cap) ** 3
    # The product is interpolated, not its factors: next to a lug's edge the factors would put the
    # lug's pressure on the channel's conductance. Beyond the grid there is no pressure, but the cap
    flow = mean_over_rim(cubes * np.asarray(fluid_pressure, dtype=float))
    weight = cap + mean_over_rim(cubes - cap)
    return flow / weight, weight


def _interpolation(
    places: Array, count: int, block: NDArray[np.int32] | None = None
) -> sparse.csr_matrix:
    """Return the matrix whose rows sum what linear interpolation gives at ``places`` (rows, ...).

    Of ``count`` values, 0 beyond the first and last; each place in its own ``block`` of them.
    """
    left = np.clip(np.floor(places), 0, count - 2).astype(np.int32)
    share = places - left
    weights = np.stack([1 - share, share], axis=-1)
    weights[(places < 0) | (places > count - 1)] = 0.0
    blocks = 1 if block is None else block.size
    left += 0 if block is None else block * count
    cells = np.stack([left, left + 1], axis=-1)
    starts = np.arange(0, weights.size + 1, weights[0].size, dtype=np.int32)
    shape = len(places), blocks * count
    return sparse.csr_matrix((weights.ravel(), cells.ravel(), starts), shape)


def over_places(values: Array, unit: str, source: str, note: str) -> SourcedValue:
    """Return the mean of what was read at several places, their standard deviation its spread."""
    deviation = float(values.std())
    return SourcedValue(float(values.mean()), unit, source=source, uncertainty=deviation, note=note)


def conductance_over_cube(inlet_diameter: float, viscosity: float) -> float:
    """Return K / <h^3> of an inlet (m) in a film (Pa s): 2 pi / (12 eta ln(15 mm / r))."""
    return 2 * math.pi / (12 * viscosity * math.log(max(2 * REACH / inlet_diameter, 1.5)))


def lag_pressure(pressure: Array, rate: Array, interval: float) -> Array:
    """Return p (n, ...) of dp/dt = rate (pressure - p), from 0, ``interval`` s between samples.

    Exact where the rate (1/s) is constant and the pressure linear between samples.
    """
    change = np.maximum(0.5 * (rate[1:] + rate[:-1]) * interval, 1e-12)
    kept = np.exp(-change)
    lag = np.diff(pressure, axis=0) * -np.expm1(-change) / change
    behind = np.zeros_like(pressure)
    behind[0] = pressure[0]
    for i in range(1, len(pressure)):
        behind[i] = lag[i - 1] + behind[i - 1] * kept[i - 1]
    return pressure - behind


def seen_share(pressure: Array, read: Array) -> float:
    """Return the share of the film's load where an inlet reads half of its pressure or more."""
    film = np.maximum(pressure, 0.0)
    total = float(film.sum())
    return float(film[read >= BLIND * film].sum()) / total if total > 0 else 1.0


def _rim_quarter(diameter: float, spacing: float) -> Array:
    """Return points (n, 2) on a quarter of the rim, no further apart than a cell.

    With their mirror images they are symmetric about both axes; half a step off the axes, so that a
    rim that touches a cell edge is not favoured.
    """
    quarter = max(6, math.ceil(math.pi * diameter / (4 * spacing))) if diameter > 0 else 1
    angle = (np.arange(quarter) + 0.5) * (math.pi / (2 * quarter))
    return 0.5 * diameter * np.column_stack([np.cos(angle), np.sin(angle)])


def _checked_maps(
    x: ArrayLike, y: ArrayLike, fluid_pressure: ArrayLike, film_thickness: ArrayLike
) -> tuple[Array, Array, Array, Array]:
    along, across = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    pressure = np.asarray(fluid_pressure, dtype=float)
    gap = np.asarray(film_thickness, dtype=float)
    shape = (along.size, across.size)
    if along.ndim != 1 or across.ndim != 1 or min(shape) < 2:
        raise InputError(
            Message(
                "x has shape {shape}, y {across_shape}",
                shape=str(along.shape),
                across_shape=str(across.shape),
            ),
            where="floor_sensor_reading",
            allowed="two rows of at least 2 cell centres",
        )
    steps = np.concatenate([np.diff(along), np.diff(across)])
    if not (steps[0] > 0 and np.allclose(steps, steps[0], rtol=1e-6)):
        raise InputError(
            "x and y are not the centres of square cells", where="floor_sensor_reading"
        )
    for name, array in (("fluid_pressure", pressure), ("film_thickness", gap)):
        if array.shape != shape:
            raise InputError(
                Message("shape {shape}", shape=str(array.shape)), where=name, allowed=f"{shape}"
            )
    if not np.isfinite(pressure).all():
        raise InputError("a pressure is not finite", where="fluid_pressure")
    if np.isnan(gap).any():
        raise InputError("a gap is not a number", where="film_thickness")
    return along, across, pressure, gap
