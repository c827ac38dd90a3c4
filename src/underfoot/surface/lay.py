"""Lays of a map: how much its texture runs in one direction or two, and which (ISO 25178-2)."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from underfoot.core.arrays import Array
from underfoot.core.remark import Message

from .heights import HeightMap, Profile
from .prepare import level_surface

DECAY = 0.2
"""Level of the autocorrelation at which ISO 25178-2 takes its lengths."""
ISOTROPIC = 0.5
"""Str from which on a map has no lay."""
COHERENT = 0.3
"""Coherence of slopes of a lay: 40 random isotropic maps of 1 mm at a cut-off of 0.8 mm reach 0.12
(and, by chance, a Str of 0.24); the same stretched to twice their length have 0.5 or more."""
CROSSED = 1.2
"""Share of the slopes' power in a direction, of that of all alike, from which on one of several is
a lay: grinding both ways of unequal depth has 1.3 and more, the second highest of 60 random
isotropic maps 1.5 at most, but these have no direction below 0.5 of the mean."""
VALLEY = 0.4
"""Of the lower of two lays: what lies between them."""
FEWEST_WAVES = 4.0
"""Across the shorter side of a map: the window turns a wave by one in so many, 14 degrees here."""
_KERNEL = math.radians(8.0)  # standard deviation
ALONG_AXIS = math.radians(3.0)
"""Angle within which lines across a lay are rows of the map: heights 0.14 % off."""
MOST_POINTS = 1024
"""Points a side from which the autocorrelation is of every second, third ... point."""
_ANGLES = 90
_BINS = 18


@dataclass(frozen=True, slots=True)
class Texture:
    """Texture aspect ratio and direction of a map.

    Parameters:
        ratio: Str, 1: shortest over longest length at which the autocorrelation falls to 0.2; an
            upper bound where it does not fall so far within the map.
        bounded: Whether ``ratio`` is such a bound.
        direction: rad, 0 to pi: the lay (grooves) from the x axis.
        length: m, that longest length.
        coherence: 0 to 1, (a - b) / (a + b) of the mean square slopes across and along the lay.
        lays: rad, 0 to pi, the strongest first: none, one, or the several of a surface that was
            ground both ways.
    """

    ratio: float
    bounded: bool
    direction: float
    length: float
    coherence: float
    lays: tuple[float, ...] = ()

    @property
    def across(self) -> float:
        """Angle (rad) of lines that see all lays: across one, between those of several."""
        angles = np.arange(180) * math.pi / 180
        seen = np.abs(np.sin(angles[:, None] - np.array(self.lays)))
        return (
            self.lays[0] + 0.5 * math.pi
            if len(self.lays) == 1
            else float(angles[int(np.argmax(seen.min(axis=1)))])
        )

    @property
    def has_lay(self) -> bool:
        """Whether the surface runs in one direction or several."""
        return bool(self.lays)

    @property
    def named_lays(self) -> str:
        """Angles of the lays, such as "0° and 90°"."""
        return " and ".join(f"{math.degrees(lay):.0f}°" for lay in sorted(self.lays))

    def __str__(self) -> str:
        ratio = Message("Str {ratio:.2g}", ratio=self.ratio)
        if self.bounded:
            ratio = Message("Str at most {ratio:.2g}", ratio=self.ratio)
        if not self.lays:
            return ratio
        return Message(
            "{ratio}, {count:lay|lays} at {angles} from x",
            ratio=ratio,
            count=len(self.lays),
            angles=self.named_lays,
        )


def texture(surface: HeightMap) -> Texture | None:
    """Return the texture of a map as it is (filter it first); None of a flat one."""
    z = surface.heights - surface.heights.mean()
    if not z.any():
        return None
    lengths, reached = _decay_lengths(surface, z)
    shortest, longest = int(np.argmin(lengths)), int(np.argmax(lengths))
    zx, zy = np.gradient(z, *surface.spacings)
    twist, lean = 2.0 * float(np.mean(zx * zy)), float(np.mean(zx**2 - zy**2))
    steepest = 0.5 * math.atan2(twist, lean)
    ratio = float(lengths[shortest] / lengths[longest])
    coherence = math.hypot(twist, lean) / float(np.mean(zx**2 + zy**2))
    direction = (steepest + 0.5 * math.pi) % math.pi
    lays = _crossed_lays(surface if surface.periodic else level_surface(surface))
    if not lays and ratio < ISOTROPIC and coherence > COHERENT:
        lays = (direction,)
    return Texture(ratio, not reached[longest], direction, float(lengths[longest]), coherence, lays)


def _crossed_lays(surface: HeightMap) -> tuple[float, ...]:
    """Return the directions of two and more lays of a level map, the strongest first; () of fewer.

    The power of the slopes by direction, of waves that both axes resolve, over a Gauss kernel of 8
    degrees (by its Fourier terms): its peaks, with valleys between them. Waves so long that fewer
    than four fit across the map have no direction of their own; where they hold most of the power,
    several lays can't be told.
    """
    power, qx, qy = _power(surface)
    q = np.hypot(qx[:, None], qy[None, :])
    # a square of wave numbers holds more in its corners
    power = np.where(q < math.pi / max(surface.spacings), power * q**2, 0.0)
    shortest = min(n * h for n, h in zip(surface.shape, surface.spacings, strict=True))
    told = np.where(q >= 2 * math.pi * FEWEST_WAVES / shortest, power, 0.0)
    if not told.sum() > 0.5 * power.sum():
        return ()
    power = told
    angle = np.arctan2(qy[None, :], qx[:, None])
    degrees = np.arange(180)
    share = np.ones(180)
    for k in range(1, 9):
        term = (power * np.exp(2j * k * angle)).sum() / power.sum()
        turn = np.exp(-2j * k * np.radians(degrees))
        share += 2 * math.exp(-2 * (k * _KERNEL) ** 2) * (term * turn).real
    higher = (share > np.roll(share, 1)) & (share >= np.roll(share, -1)) & (share > CROSSED)
    peaks = degrees[higher]
    if peaks.size < 2:
        return ()
    for one, next_one in zip(peaks, np.append(peaks[1:], peaks[0] + 180), strict=True):
        between = share[np.arange(one, next_one + 1) % 180]
        if between.min() > VALLEY * min(between[0], between[-1]):
            return ()
    strongest = peaks[np.argsort(share[peaks])[::-1]]
    return tuple(float(np.radians((peak + 90) % 180)) for peak in strongest)


def _decay_lengths(surface: HeightMap, z: Array) -> tuple[Array, Array]:
    """Return by angle (0 to 180 degrees) where the autocorrelation falls to 0.2, m, and whether
    it does so within half the map."""
    from scipy.ndimage import map_coordinates

    every = [math.ceil(n / MOST_POINTS) for n in z.shape]
    z = z[:: every[0], :: every[1]]
    sizes = [2 * n for n in z.shape]
    power = np.abs(np.fft.rfft2(z, sizes)) ** 2
    pairs = np.abs(np.fft.rfft2(np.ones_like(z), sizes)) ** 2
    sums, counts = np.fft.irfft2(power, sizes), np.fft.irfft2(pairs, sizes)
    # Of the pairs that exist: a mean over the whole map would let every direction decay.
    known = np.fft.fftshift(sums / np.maximum(counts, 0.5))
    middle, steps = list(z.shape), np.array(surface.spacings) * every
    lengths, reached = np.empty(2 * _ANGLES), np.empty(2 * _ANGLES, dtype=bool)
    for k, angle in enumerate(np.arange(2 * _ANGLES) * math.pi / (2 * _ANGLES)):
        along = np.array([math.cos(angle), math.sin(angle)])
        limit = min(
            0.5 * n * h / abs(a) if abs(a) > 1e-9 else math.inf
            for n, h, a in zip(z.shape, steps, along, strict=True)
        )
        r = np.arange(0.0, limit, 0.5 * steps.min())
        places = [m + r * a / h for m, a, h in zip(middle, along, steps, strict=True)]
        value = map_coordinates(known, places, order=1) / known[z.shape]
        below = np.flatnonzero(value <= DECAY)
        reached[k] = below.size > 0
        lengths[k] = r[below[0]] if reached[k] else limit
    return lengths, reached


@dataclass(frozen=True, slots=True, eq=False)
class Directions:
    """How the power of each ring of wave numbers is shared between directions from the x axis.

    ``cosine`` |cos| of the angle and ``share`` (sum 1), (rings, bins); ``wavenumber`` rad/m,
    (rings,).
    """

    wavenumber: Array
    cosine: Array
    share: Array

    def at(self, wavenumber: Array) -> tuple[Array, Array]:
        """Return |cos| and shares of the nearest ring at wave numbers (rad/m), (n, bins) each."""
        middles = np.sqrt(self.wavenumber[1:] * self.wavenumber[:-1])
        ring = np.searchsorted(middles, wavenumber)
        return self.cosine[ring], self.share[ring]


def lines_across(surface: HeightMap, across: float, count: int) -> list[Profile]:
    """Return evenly spaced lines of one length across a lay, at an angle (rad) from the x axis.

    Along an axis they are rows of the map; at an angle heights between points are interpolated by
    splines, and lines shorter than 0.7 of the longest (near corners) are left out.
    """
    from scipy.ndimage import map_coordinates

    more: dict[str, Any] = {"resolution": surface.resolution}
    for axis, square in enumerate((0.0, 0.5 * math.pi)):
        off = abs((across - square + 0.5 * math.pi) % math.pi - 0.5 * math.pi)
        if off < ALONG_AXIS:
            rows = np.moveaxis(surface.heights, axis, 1)
            chosen = np.unique(np.linspace(0, len(rows) - 1, count).astype(int))
            more |= {"periodic": surface.periodic}
            return [Profile(row, surface.spacings[axis], **more) for row in rows[chosen]]
    along = np.array([math.cos(across), math.sin(across)])
    beside = np.array([-along[1], along[0]])
    steps = np.array(surface.spacings)
    half = 0.5 * (np.array(surface.shape) - 1) * steps

    def reach(offset: float) -> tuple[float, float]:
        ends = np.sort((np.array([-half, half]) - offset * beside) / along, axis=0)
        return float(ends[0].max()), float(ends[1].min())

    far = np.linspace(-half.sum(), half.sum(), 401)
    lengths = np.array([np.diff(reach(offset))[0] for offset in far])
    inside = far[lengths >= 0.7 * lengths.max()]
    spacing = float(steps.max())
    size = int(lengths[lengths >= 0.7 * lengths.max()].min() / spacing) + 1
    lines = []
    for offset in np.linspace(inside[0], inside[-1], count):
        middle = 0.5 * sum(reach(float(offset)))
        r = middle + (np.arange(size) - 0.5 * (size - 1)) * spacing
        places = [
            (r * a + offset * b + edge) / h
            for a, b, edge, h in zip(along, beside, half, steps, strict=True)
        ]
        lines.append(
            Profile(map_coordinates(surface.heights, places, mode="nearest"), spacing, **more)
        )
    return lines


def lines_along_axes(surface: Profile | HeightMap, count: int) -> list[Profile]:
    """Return the profile, or up to ``count`` evenly spaced lines along each axis of a map.

    Of a map with oblong cells along the axis with the finer spacing.
    """
    if isinstance(surface, Profile):
        return [surface]
    x, y = surface.spacings
    angles = (0.0, 0.5 * math.pi) if x == y else (0.0,) if x < y else (0.5 * math.pi,)
    return [line for angle in angles for line in lines_across(surface, angle, count)]


def _power(surface: HeightMap) -> tuple[Array, Array, Array]:
    """Return the squared spectrum and its wave numbers along each axis, rad/m.

    Hann window as in ``isotropic_spectrum``; the plane of a surface that is not periodic was
    removed.
    """
    z = surface.heights - surface.heights.mean()
    if not surface.periodic:
        for axis, n in enumerate(z.shape):
            window = 0.5 - 0.5 * np.cos(2.0 * np.pi * (np.arange(n) + 0.5) / n)
            z = z * window.reshape([-1 if a == axis else 1 for a in (0, 1)])
    qx, qy = (
        np.asarray(2.0 * np.pi * np.fft.fftfreq(n, h), dtype=np.float64)
        for n, h in zip(z.shape, surface.spacings, strict=True)
    )
    return np.asarray(np.abs(np.fft.fft2(z)) ** 2, dtype=np.float64), qx, qy


def directions(surface: HeightMap, wavenumber: Array) -> Directions:
    """Return how power is shared between directions, in rings of wave numbers (rad/m, rising).

    ``surface``: without its plane, but for a periodic one.
    """
    power, qx, qy = _power(surface)
    q = np.hypot(qx[:, None], qy[None, :])
    q[0, 0], power[0, 0] = 1.0, 0.0
    cosine = np.abs(qx)[:, None] / q
    ring = np.searchsorted(np.sqrt(wavenumber[1:] * wavenumber[:-1]), q)
    place = np.minimum(np.arccos(np.minimum(cosine, 1.0)) * 2 * _BINS / np.pi, _BINS - 1)
    flat_place = (ring * _BINS + place.astype(int)).ravel()
    count = wavenumber.size * _BINS
    parts = np.bincount(flat_place, power.ravel(), count).reshape(-1, _BINS)
    cosines = np.bincount(flat_place, (power * cosine).ravel(), count).reshape(-1, _BINS)
    return Directions(
        np.asarray(wavenumber, dtype=float),
        np.divide(cosines, parts, out=np.zeros_like(parts), where=parts > 0),
        parts / np.maximum(parts.sum(axis=1, keepdims=True), 1e-300),
    )
