"""Folders of made-up measurements: files as a laboratory's, conditions, profile and the truth."""

import csv
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from underfoot.core import InputError, Progress, silent, unknown_name
from underfoot.core.remark import Message

from .activities import ACTIVITIES, activity, activity_c3d
from .c3d_file import NOTICE, walk_c3d
from .treadmill import treadmill_walk
from .walk import SENSORS, Defects, SlipTruth, walk_with_slip

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


# Report G.2: viscosity (cP), COF_BL, tau (m/s), asymptote; flat ones as their mean COF.
_FLUIDS = {
    "water": (0.52, 0.69, 2.09, 0.001),
    "detergent_1.5pct": (1.8, 0.58, 0.68, 0.001),
    "glycerol_25pct": (1.9, 0.65, 0.50, 0.099),
    "glycerol_50pct": (5.54, 0.47, 0.19, 0.111),
    "glycerol_75pct": (41.0, 0.16, 1e3, 0.16),
    "canola_oil": (74.6, 0.10, 1e3, 0.10),
}
_SPEEDS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
# Slip-tester truths: the report's loads (N) and peaks (kPa), G.4.
_SHOES = {
    ("work_none", "glycerol_90pct"): ScanTruth(pressure=234e3, widths=(0.0125, 0.0109)),
    ("athletic_none", "glycerol_90pct"): ScanTruth(
        pressure=214e3, widths=(0.0088, 0.007), middle=(0.025, -0.008)
    ),
    ("work_full", "glycerol_90pct"): ScanTruth(cof=0.12, pressure=2e3, normal_force=250.0),
}
# Outsoles of G.6: mean ACOF, chosen so that the report's risk model gives distinct risks.
_OUTSOLES = {"hard": 0.150, "medium": 0.158, "soft": 0.182}


SHOES: Mapping[str, float] = {"hard": 0.195, "medium": 0.205, "soft": 0.225}
"""Study: mean required friction of all persons in each shoe."""
NAMES = r"S(?P<subject>\d+)_(?P<shoe>[a-z]+)_(?P<n>\d+)"
"""Study: pattern of the file names."""
BETWEEN, OWN, TRIAL = 0.020, 0.006, 0.008
"""Study: standard deviations between persons, of a person's own answer to a shoe, of trials."""
_File = tuple[str, bytes, Mapping[str, str], Mapping[str, str]]
"""Name, content, what a laboratory notes about it, the truth."""


def simulated_folder(
    kind: str, out: Path, *, count: int = 12, seed: int = 1, progress: Progress = silent
) -> list[Path]:
    """Write made-up measurements into a folder and return the paths of the trial files.

    Beside the trials: conditions.csv (what a laboratory notes), profile.toml, truth.csv and
    SYNTHETIC.txt. The same kind, count and seed give the same bytes.

    ``kind``: A key of ``KINDS``. ``count``: trials for "slips" and "relaxation"; persons for
    "study"; recordings for "treadmill"; repeats of the whole series for "pin_on_disk"; scans per
    shoe for "tester".

    InputError: unknown kind; count below one.
    """
    if kind not in _MAKERS:
        raise unknown_name("kind of data", kind, KINDS, where="simulate")
    if count < 1:
        raise InputError(
            Message("{count} trials", count=count), where="count", allowed="one or more"
        )
    _, maker, each, usual, profile = _MAKERS[kind]
    count = usual if count == 12 else count
    if kind == "tester":
        count = max(count, 2)
    files = maker(count, np.random.default_rng(seed))
    return _write_study(out, files, count * each or len(ACTIVITIES), profile, progress)


def simulated_study(
    out: Path, *, persons: int = 12, trials: int = 4, seed: int = 1, progress: Progress = silent
) -> list[Path]:
    """Write a study with named files (``S01_hard_1.c3d``) and return their paths.

    RCOF of a trial = mean of the shoe + person + person in the shoe + trial, all normal with the
    standard deviations of this module; ``trials`` of each person in each shoe, each one step on one
    plate.
    """
    total = persons * len(SHOES) * trials
    return _write_study(out, _walks(persons, trials, seed), total, _WALKWAY, progress)


def _write_study(
    out: Path, files: Iterable[_File], total: int, profile: str, progress: Progress
) -> list[Path]:
    out.mkdir(parents=True, exist_ok=True)
    (out / "SYNTHETIC.txt").write_text(NOTICE, encoding="utf-8")
    if profile:
        text = "# Made-up recordings: nothing was measured.\n" + profile
        (out / "profile.toml").write_text(text, encoding="utf-8")
    paths = []
    tables: dict[str, list[Mapping[str, str]]] = {"conditions.csv": [], "truth.csv": []}
    for name, content, *rows in files:
        paths.append(out / name)
        paths[-1].write_bytes(content)
        for table, row in zip(tables.values(), rows, strict=True):
            table += [{"file": name, **row}] if row else []
        progress("writing made-up files", len(paths) / total)
    for name, table in tables.items():
        if table:
            with (out / name).open("w", newline="", encoding="utf-8") as stream:
                writer = csv.DictWriter(stream, list(table[0]), lineterminator="\n")
                writer.writeheader()
                writer.writerows(table)
    return paths


def slip_truth(number: int, seed: int) -> tuple[SlipTruth, Defects, dict[str, str]]:
    """Return what is put into trial ``number`` (from 0) and its conditions.

    Subjects slip twice; outsoles rotate. Whether one slips follows the report's risk model,
    log odds = -2.952 - 49.2 (ACOF - RCOF) (G.6).
    """
    subject, order = divmod(number, 2)
    person = np.random.default_rng([seed, 1, subject])
    generator = np.random.default_rng([seed, 2, number])
    outsole = list(_OUTSOLES)[(subject + order) % 3]
    mass = float(person.uniform(55, 90))
    rcof = 0.19 + 0.03 * person.standard_normal() + 0.008 * generator.standard_normal()
    rcof = float(np.clip(rcof, 0.12, 0.28))
    acof = _OUTSOLES[outsole] + 0.004 * generator.standard_normal()
    risk = 1.0 / (1.0 + math.exp(2.952 + 49.2 * (acof - rcof)))
    slips = bool(generator.random() < risk)
    speed = float(generator.uniform(0.5, 1.7)) if slips else float(generator.uniform(0.04, 0.09))
    rise = float(generator.uniform(0.14, 0.2)) if slips else 0.09
    start = float(generator.uniform(0.03, 0.06))
    fall = float(generator.uniform(0.2, 0.27)) if slips else 0.1
    angle = float(generator.normal(0, 0.06))
    pressure = float(60e3 * speed) if slips else 600.0
    lateral = float(generator.normal(0, 0.008))
    motion = (speed, start, rise, fall, angle)
    truth = SlipTruth(rcof, float(acof), *motion, pressure, lateral=lateral, mass=mass)
    defects = Defects(
        missing_frames=int(generator.integers(3, 9)) if generator.random() < 0.2 else 0,
        dropped_samples=int(generator.integers(2, 20)) if generator.random() < 0.1 else 0,
    )
    conditions = {
        "subject": f"S{subject + 1:02d}",
        "outsole": outsole,
        "order": "first" if order == 0 else "second",
        "fluid": "glycerol_50pct",
        "mass (kg)": f"{truth.mass:.1f}",
    }
    return truth, defects, conditions


def _slips(count: int, rng: np.random.Generator) -> Iterator[_File]:
    seed = int(rng.integers(2**32))
    for number in range(count):
        truth, defects, noted = slip_truth(number, seed)
        recording = walk_with_slip(truth, defects, np.random.default_rng([seed, number]))
        facts = {key: f"{value:.6g}" for key, value in recording.truth.items()}
        conditions = {**noted, "acof": f"{truth.acof:.4f}"}
        yield f"slip_{number + 1:03d}.c3d", walk_c3d(recording), conditions, facts


def _study(count: int, rng: np.random.Generator) -> Iterator[_File]:
    return _walks(count, 4, int(rng.integers(2**32)))


def _walks(persons: int, trials: int, seed: int) -> Iterator[_File]:
    for person in range(persons):
        generator = np.random.default_rng([seed, 1, person])
        level, mass = BETWEEN * generator.standard_normal(), float(generator.uniform(55, 90))
        for shoe, mean in SHOES.items():
            answer = OWN * generator.standard_normal()
            for trial in range(trials):
                rcof = mean + level + answer + TRIAL * generator.standard_normal()
                truth = SlipTruth(rcof=float(np.clip(rcof, 0.1, 0.4)), mass=mass, peak_speed=0.05)
                made = walk_with_slip(truth, Defects(), generator)
                idle = generator.normal(0.0, 1.0, made.force[1].shape)
                made = replace(made, force=(made.force[0], idle), pressures={})
                name = f"S{person + 1:02d}_{shoe}_{trial + 1}.c3d"
                yield name, walk_c3d(made, mass=mass), {}, {"rcof": f"{made.truth['rcof']:.6g}"}


def _activities(_: int, rng: np.random.Generator) -> Iterator[_File]:
    for name, words in ACTIVITIES.items():
        noted = {"activity": words}
        yield f"{name}.c3d", activity_c3d(activity(name, rng)), noted, noted


def _treadmill(count: int, rng: np.random.Generator) -> Iterator[_File]:
    for number in range(1, count + 1):
        speeds = rng.uniform(0.8, 1.5, 2)
        if number % 2:
            speeds[1] = speeds[0]  # every second one walks on belts of two speeds
        mass = float(rng.uniform(55, 90))
        made = treadmill_walk(
            rng, speeds=(float(speeds[0]), float(speeds[1])), rcof=float(rng.normal(0.2, 0.02)),
            mass=mass,
        )  # fmt: skip
        known = {key: f"{value:.6g}" for key, value in made.truth.items()}
        yield f"belt_{number:02d}.c3d", walk_c3d(made, mass=mass), {}, known


def _tester(count: int, rng: np.random.Generator) -> Iterator[_File]:
    places = 0.01 * (np.arange(count) - (count - 1) / 2)
    for (shoe, fluid), truth in _SHOES.items():
        for number, lateral in enumerate(places.tolist(), start=1):
            columns = scan_columns(truth, lateral, rng)
            load = truth.covered_load(places, 0.01)
            facts = {"cof": truth.cof, "fluid_load": load, "peak_pressure": truth.pressure}
            facts["lateral"] = lateral
            noted = {"shoe": shoe, "fluid": fluid, "map": f"{shoe}, {fluid}"}
            known = {key: f"{value:.6g}" for key, value in facts.items()}
            yield f"{shoe}_scan_{number}.csv", _csv(columns), noted, known


def _pin_on_disk(count: int, rng: np.random.Generator) -> Iterator[_File]:
    for fluid, (viscosity, boundary, tau, asymptote) in _FLUIDS.items():
        for repeat in range(1, count + 1):
            level = 1.0 + 0.04 * rng.standard_normal()
            for speed in _SPEEDS:
                cof = level * (asymptote + (boundary - asymptote) * math.exp(-speed / tau))
                cof = max(cof + 0.012 * rng.standard_normal(), 0.02)
                noted = {"fluid": fluid, "repeat": f"run {repeat}"}
                noted |= {"viscosity (cP)": f"{viscosity:g}", "speed (m/s)": f"{speed:g}"}
                name = f"{fluid}_{repeat}_{1e3 * speed:04.0f}.csv"
                yield name, _csv(disk_run(cof, speed, rng)), noted, {"cof": f"{cof:.6g}"}


def _relaxation(count: int, rng: np.random.Generator) -> Iterator[_File]:
    materials = (("neolite", 3000.0, 0.38, 0.013), ("rubber", 120.0, 0.25, 0.025))
    for number in range(1, count + 1):
        material, peak, share, rate = materials[number % 2]
        peak *= 1.0 + 0.02 * rng.standard_normal()
        columns = relaxation(rng, peak=peak, share=share, rate=rate)
        final = peak * (1 - share + share * math.exp(-rate * 228.0))
        noted = {"material": material, "thickness (mm)": "5.5", "area (mm^2)": "161"}
        known = {"peak_force": f"{peak:.6g}", "final_force": f"{final:.6g}"}
        yield f"{material}_{number:02d}.csv", _csv(columns), noted, known


def _csv(columns: Mapping[str, np.ndarray]) -> bytes:
    data = np.column_stack(list(columns.values())).tolist()
    rows = (",".join(f"{value:.6g}" for value in row) for row in data)
    return "\n".join([",".join(columns), *rows, ""]).encode()


def _sensors(places: Mapping[str, tuple[float, float, float]]) -> str:
    rows = (f"{n} = [{1e3 * x:g}, {1e3 * y:g}, {1e3 * z:g}]\n" for n, (x, y, z) in places.items())
    return '\n[sensors]\nunit = "mm"\n' + "".join(rows)


_AXES = '\n[axes]\nvertical = "+z"\nwalking = "+x"\n'
_WALKWAY = f'name = "synthetic walkway"\n{_AXES}\n[heel]\nleft = "LHEE"\nright = "RHEE"\n'
_Maker = Callable[[int, np.random.Generator], Iterator[_File]]
_TESTER = f'name = "synthetic slip tester"\n{_AXES}' + _sensors({"pressure": SENSOR})
# What they are, how files are made, how many for each one counted, the usual count, the profile.
_MAKERS: Mapping[str, tuple[str, _Maker, int, int, str]] = {
    "slips": ("human slips over a sensor array (G.5, G.6), C3D", _slips, 1, 12,
              _WALKWAY + _sensors(SENSORS)),
    "study": ("walking of persons in three shoes, conditions in the file names, C3D", _study,
              4 * len(SHOES), 12, _WALKWAY),
    "treadmill": ("walking on two belts, of one or two speeds, 45 stances each, C3D", _treadmill,
                  1, 4, _WALKWAY),
    "tester": ("slip-tester scans over one pressure sensor (G.4), CSV", _tester, len(_SHOES), 7,
               _TESTER),
    "pin_on_disk": ("COF against speed with six fluids (G.2), CSV", _pin_on_disk,
                    len(_FLUIDS) * len(_SPEEDS), 5, ""),
    "relaxation": ("compression relaxation tests (G.1), CSV", _relaxation, 1, 12, ""),
    "activities": ("walking, and jumps, runs, stairs, turns that are no level step, C3D",
                   _activities, 0, 12, ""),
}  # fmt: skip
KINDS = {name: words for name, (words, *_) in _MAKERS.items()}
