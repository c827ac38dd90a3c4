"""An array of pressure sensors that stays in the floor while the shoe slides over it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from underfoot.core import InputError, SourcedValue
from underfoot.core.arrays import Array
from underfoot.core.checks import not_negative, positive
from underfoot.core.remark import Message

from .reading import GAP_CAP, conductance_over_cube, lag_pressure, over_places, pocket_pressure

SOURCE = "pockets at uniform pressure in the computed film, at fixed places in the floor"


@dataclass(frozen=True, slots=True)
class SensorArray:
    """Sensors in ``rows`` along the walking direction (x) and ``columns`` across (y).

    ``spacing`` m between neighbours both ways; ``inlet_diameter`` m; ``position`` x of the first
    row in the floor, m, where the rear end of the shoe's map is at 0 at time 0. Columns are
    centred on y = 0. The report's array (G.5.1): 3 x 3, 30 mm, 4 mm.
    """

    rows: int
    columns: int
    spacing: float
    inlet_diameter: float
    position: float

    def __post_init__(self) -> None:
        for name in ("rows", "columns"):
            if getattr(self, name) < 1:
                raise InputError(
                    Message("{given} is no count", given=getattr(self, name)),
                    where=f"array.{name}",
                    allowed="1 or more",
                )
        positive(self.spacing, "array.spacing")
        not_negative(self.inlet_diameter, "array.inlet_diameter")
        if not np.isfinite(self.position):
            raise InputError("the position is not finite", where="array.position")

    @property
    def x(self) -> Array:
        """Place of each row in the floor, m."""
        return self.position + np.arange(self.rows, dtype=np.float64) * self.spacing

    @property
    def y(self) -> Array:
        """Place of each column, m."""
        return (np.arange(self.columns, dtype=np.float64) - 0.5 * (self.columns - 1)) * self.spacing


@dataclass(frozen=True, slots=True)
class ArrayReading:
    """What each sensor saw in time.

    ``pressure`` (n, rows, columns) Pa for the shoe centred on the array. ``peak`` (Pa) is the
    highest reading of any sensor, ``row_peaks`` the highest in each row, ``duration`` (s) how
    long at least one sensor reads above ``threshold``; each is the mean over the lateral places
    where the shoe may come down, its uncertainty their standard deviation. ``sensor_peaks``
    (rows, columns) is for the centred shoe.
    """

    time: Array
    pressure: Array
    sensor_peaks: Array
    peak: SourcedValue
    row_peaks: tuple[SourcedValue, ...]
    duration: SourcedValue
    threshold: float


def array_reading(
    x: Array,
    y: Array,
    time: Array,
    place: Array,
    fluid_pressure: Sequence[Array],
    film_thickness: Sequence[Array],
    array: SensorArray,
    *,
    threshold: float = 1e3,
    sampling_interval: float = 1e-3,
    gap_cap: float = GAP_CAP,
    offsets: int = 11,
    compliance: float = 0.0,
    viscosity: float = 0.0,
) -> ArrayReading:
    """Return what an array in the floor reads while a shoe slides over it.

    Parameters:
        x, y: Cell centres of the sole's grid, m.
        time, place: (n,) instants in s, rising, and how far the shoe has gone along +x since time
            0, m.
        fluid_pressure, film_thickness: n maps (nx, ny) each, Pa (0 outside the film) and m.
        array: Where the sensors are.
        threshold: Pa, for the duration.
        sampling_interval: s; between the instants given, the maps are interpolated linearly while
            the shoe moves on.
        offsets: Lateral places within one spacing, odd: the shoe is not aimed at the sensors.
        compliance, viscosity: As in ``floor_sensor_reading``: m^3/Pa and, with it, Pa s.

    Each sensor reads the mean film pressure over the rim of its inlet, weighted by h^3, 0 outside
    the film (``floor_sensor_reading``), and lags behind it by its compliance. Pockets don't disturb
    the film.

    Raises:
        InputError: Numbers that don't match, time that doesn't rise.
    """
    time, place = np.asarray(time, dtype=float), np.asarray(place, dtype=float)
    if not (time.ndim == 1 and time.size >= 2 and (np.diff(time) > 0).all()):
        raise InputError("time must rise", where="time", allowed="two or more rising instants, s")
    if place.shape != time.shape or not (len(fluid_pressure) == len(film_thickness) == time.size):
        raise InputError(
            Message(
                "{instants} instants, {places} places, {pressures} pressure and {films} film maps",
                instants=time.size,
                places=place.size,
                pressures=len(fluid_pressure),
                films=len(film_thickness),
            ),
            where="array_reading",
            allowed="as many of each",
        )
    if offsets < 1 or offsets % 2 == 0:
        raise InputError(
            Message("{offsets} is even", offsets=offsets), where="offsets", allowed="an odd number"
        )
    positive(threshold, "threshold")
    positive(sampling_interval, "sampling_interval")
    if not_negative(compliance, "compliance"):
        positive(array.inlet_diameter, "array.inlet_diameter")
        positive(viscosity, "viscosity")
    spacing = float(x[1] - x[0])
    shifts = (np.arange(offsets, dtype=np.float64) - offsets // 2) * (array.spacing / offsets)
    lanes = (array.y[None, :] + shifts[:, None]).ravel()
    count = max(2, int(np.ceil((time[-1] - time[0]) / sampling_interval)) + 1)
    samples = np.linspace(time[0], time[-1], count)
    where = np.interp(samples, time, place)
    after = np.clip(np.searchsorted(time, samples), 1, time.size - 1)
    share = (samples - time[after - 1]) / (time[after] - time[after - 1])
    # reading and mean h^3 at the rim
    read = np.zeros((2, count, array.rows, lanes.size))
    for step in range(time.size - 1):
        chosen = np.flatnonzero(after == step + 1)
        if not chosen.size:
            continue
        # rows under the shoe at each sample, as places on the sole
        on_sole = (array.x[None, :] - where[chosen, None]).ravel()
        ends = [
            np.array(pocket_pressure(
                x, y, fluid_pressure[k], film_thickness[k], on_sole, lanes,
                inlet_diameter=array.inlet_diameter, gap_cap=gap_cap, spacing=spacing,
            )).reshape(2, chosen.size, array.rows, lanes.size)
            for k in (step, step + 1)
        ]  # fmt: skip
        weight = share[chosen][:, None, None]
        read[:, chosen] = (1 - weight) * ends[0] + weight * ends[1]
    read, cubes = read
    if compliance > 0:
        rate = cubes * conductance_over_cube(array.inlet_diameter, viscosity) / compliance
        read = lag_pressure(read, rate, float(samples[1] - samples[0]))
    by_place = read.reshape(count, array.rows, offsets, array.columns)
    central = np.ascontiguousarray(by_place[:, :, offsets // 2, :])
    above = (by_place > threshold).any(axis=(1, 3)).sum(axis=0) * (samples[1] - samples[0])

    spread = "spread over where the shoe comes down"
    above_it = Message(
        "spread over where the shoe comes down; above {threshold:g} Pa", threshold=threshold
    )
    return ArrayReading(
        time=samples,
        pressure=central,
        sensor_peaks=central.max(axis=0),
        peak=over_places(by_place.max(axis=(0, 1, 3)), "Pa", SOURCE, spread),
        row_peaks=tuple(
            over_places(by_place[:, row].max(axis=(0, 2)), "Pa", SOURCE, spread)
            for row in range(array.rows)
        ),
        duration=over_places(above, "s", SOURCE, above_it),
        threshold=threshold,
    )
