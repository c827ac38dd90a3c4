"""Made-up slip-tester slips over a pressure sensor, pin-on-disk runs and relaxation tests."""

from dataclasses import dataclass

import numpy as np

RATE = 1000.0
SENSOR = (0.3, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ScanTruth:
    """A shoe on the tester, with ``normal_force`` (N), ``speed`` (m/s) and ``rise`` (s) of that.

    ``cof`` is shear over normal force while sliding, ``pressure`` the peak of the Gaussian pressure
    field (Pa), ``widths`` its sd along and across (m), ``middle`` its place forward of the heel's
    back and left of the heel's middle (m).
    """

    cof: float = 0.08
    pressure: float = 234e3
    widths: tuple[float, float] = (0.016, 0.014)
    middle: tuple[float, float] = (0.02, 0.0)
    normal_force: float = 500.0
    speed: float = 0.7
    rise: float = 0.03

    @property
    def load(self) -> float:
        """Load of the whole field (N): 2 pi p sd_x sd_y."""
        return float(2 * np.pi * self.pressure * self.widths[0] * self.widths[1])

    def covered_load(
        self, lateral: np.ndarray, spacing: float, back: float = -0.01, front: float = 0.12
    ) -> float:
        """Return the load (N) within the strips around the scans and the scanned length."""
        from scipy.stats import norm

        edges = (float(np.min(lateral)) - spacing / 2, float(np.max(lateral)) + spacing / 2)
        share = norm.cdf(edges, self.middle[1], self.widths[1])
        along = norm.cdf((back, front), self.middle[0], self.widths[0])
        return self.load * float((share[1] - share[0]) * (along[1] - along[0]))


def scan_columns(
    truth: ScanTruth, lateral: float, rng: np.random.Generator, *, noise: float = 1.0
) -> dict[str, np.ndarray]:
    """Return one slip as columns in the units of a laboratory: s, N, mm, kPa.

    The shoe is lowered, slides over the sensor at constant speed and is lifted. ``lateral`` is
    the place of the sensor to the left of the heel's middle (m); ``noise`` scales all noises.
    """
    time = np.arange(1500) / RATE
    down, start = 0.3, 0.45
    loaded = np.clip((time - down) / truth.rise, 0, 1)
    lifted = np.clip((1.2 - time) / 0.05, 0, 1)
    normal = truth.normal_force * 0.5 * (1 - np.cos(np.pi * np.minimum(loaded, lifted)))
    ramp, stop = np.clip((time - start) / 0.03, 0, 1), np.clip((0.95 - time) / 0.03, 0, 1)
    speed = truth.speed * 0.5 * (1 - np.cos(np.pi * np.minimum(ramp, stop)))
    moved = np.cumsum(speed) / RATE
    # The heel's back ends behind the sensor: the sensor is scanned from the toe side to the heel.
    heel = SENSOR[0] - 0.22 + moved
    along = SENSOR[0] - heel
    sliding = speed > 0.02
    field = np.exp(
        -((along - truth.middle[0]) ** 2) / (2 * truth.widths[0] ** 2)
        - (lateral - truth.middle[1]) ** 2 / (2 * truth.widths[1] ** 2)
    )
    pressure = np.where(sliding, truth.pressure * field, 0.0)

    def noisy(values: np.ndarray, sd: float, offset: float = 0.0) -> np.ndarray:
        return values + offset + noise * rng.normal(0, sd, len(time))

    return {
        "time (s)": time,
        "Fx (N)": noisy(-truth.cof * normal * sliding, 0.8, 2.0),
        "Fy (N)": noisy(0.0 * normal, 0.8, -1.0),
        "Fz (N)": noisy(normal, 1.0, 5.0),
        "heel_x (mm)": noisy(1e3 * heel, 0.2),
        "heel_y (mm)": noisy(np.full(len(time), 1e3 * (SENSOR[1] - lateral)), 0.2),
        "heel_z (mm)": noisy(np.full(len(time), 30.0), 0.2),
        "pressure (kPa)": noisy(1e-3 * pressure, 0.25, 0.8),
    }


def disk_run(
    cof: float, speed: float, rng: np.random.Generator, *, load: float = 20.9
) -> dict[str, np.ndarray]:
    """Return ten seconds of a pin-on-disk run at 100 Hz: run-in, then correlated scatter."""
    time = np.arange(1000) / 100.0
    white = rng.normal(0, 0.012, len(time))
    scatter = np.zeros(len(time))
    for i in range(1, len(time)):
        scatter[i] = 0.6 * scatter[i - 1] + 0.8 * white[i]
    ratio = cof * (1 + 0.35 * np.exp(-time / 0.4)) + scatter
    normal = load + rng.normal(0, 0.1, len(time))
    return {
        "time (s)": time,
        "normal force (N)": normal,
        "friction force (N)": ratio * normal,
        "sliding speed (m/s)": np.full(len(time), speed),
    }


def relaxation(
    rng: np.random.Generator,
    *,
    thickness: float = 5.5e-3,
    peak: float = 800.0,
    share: float = 0.35,
    rate: float = 0.025,
) -> dict[str, np.ndarray]:
    """Return a ramp, a hold of 240 s and the unloading of a rubber pair, compression positive.

    F(t) = peak ((1 - share) + share exp(-rate t)) from the end of the ramp; 0.2 thickness is
    taken up in one second.
    """
    time = np.arange(0, 246.0, 0.02)
    travel = np.clip(time - 2.0, 0, 1) * 0.2 * thickness
    travel = np.where(time > 243.0, np.clip(244.0 - time, 0, 1) * 0.2 * thickness, travel)
    relaxed = np.where(time > 3.0, 1 - share + share * np.exp(-rate * (time - 3.0)), 1.0)
    force = peak * travel / (0.2 * thickness) * relaxed
    return {
        "time (s)": time,
        "displacement (mm)": 1e3 * travel + rng.normal(0, 2e-4, len(time)),
        "force (N)": force + rng.normal(0, 0.3, len(time)),
    }
