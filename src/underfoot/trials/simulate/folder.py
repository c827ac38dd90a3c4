"""Folders of made-up measurements: files as a laboratory's, conditions, profile and the truth."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from underfoot.core import Progress, silent, unknown_name

from .activities import ACTIVITIES, activity, activity_c3d
from .c3d_file import NOTICE, walk_c3d
from .study import simulated_study
from .tester import SENSOR, ScanTruth, scan_columns
from .tribometer import disk_run, relaxation
from .walk import DURATION, Defects, SlipTruth, walk_with_slip

KINDS = {
    "slips": "human slips over a sensor array (G.5, G.6), C3D",
    "study": "walking of persons in three shoes, conditions in the file names, C3D",
    "tester": "slip-tester scans over one pressure sensor (G.4), CSV",
    "pin_on_disk": "COF against speed with six fluids (G.2), CSV",
    "relaxation": "compression relaxation tests (G.1), CSV",
    "activities": "walking, and jumps, runs, stairs, turns that are no level step, C3D",
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


def simulated_folder(
    kind: str, out: Path, *, count: int = 12, seed: int = 1, progress: Progress = silent
) -> list[Path]:
    """Write made-up measurements into a folder and return the paths of the trial files.

    Beside the trials: conditions.csv (what a laboratory notes), profile.toml, truth.csv and
    SYNTHETIC.txt. The same kind, count and seed give the same bytes.

    Parameters
    ----------
    kind
        A key of ``KINDS``.
    count
        Trials for "slips" and "relaxation"; persons for "study"; repeats of the whole series for
        "pin_on_disk"; scans per shoe for "tester".

    Errors
    ------
    InputError
        Unknown kind; count below one.
    """
    from underfoot.core import InputError

    makers: dict[str, Callable[[Path, int, np.random.Generator, Progress], list[Path]]] = {
        "slips": _slips,
        "study": _study,
        "tester": _tester,
        "pin_on_disk": _pin_on_disk,
        "relaxation": _relaxation,
        "activities": _activities,
    }
    if kind not in makers:
        raise unknown_name("kind of data", kind, KINDS, where="simulate")
    if count < 1:
        raise InputError(f"{count} trials", where="count", allowed="one or more")
    out.mkdir(parents=True, exist_ok=True)
    (out / "SYNTHETIC.txt").write_text(NOTICE, encoding="utf-8")
    return makers[kind](out, count, np.random.default_rng(seed), progress)


def slip_truth(number: int, seed: int) -> tuple[SlipTruth, Defects, dict[str, str]]:
    """Return what is put into trial ``number`` (from 0) and its conditions.

    Subjects slip twice; outsoles rotate. Whether one slips follows the report's risk model,
    log odds = -2.952 - 49.2 (ACOF - RCOF) (G.6).
    """
    subject, order = divmod(number, 2)
    person = np.random.default_rng([seed, 1, subject])
    own = np.random.default_rng([seed, 2, number])
    outsole = list(_OUTSOLES)[(subject + order) % 3]
    mass = float(person.uniform(55, 90))
    rcof = 0.19 + 0.03 * person.standard_normal() + 0.008 * own.standard_normal()
    rcof = float(np.clip(rcof, 0.12, 0.28))
    acof = _OUTSOLES[outsole] + 0.004 * own.standard_normal()
    risk = 1.0 / (1.0 + math.exp(2.952 + 49.2 * (acof - rcof)))
    slips = bool(own.random() < risk)
    speed = float(own.uniform(0.5, 1.7)) if slips else float(own.uniform(0.04, 0.09))
    rise = float(own.uniform(0.14, 0.2)) if slips else 0.09
    truth = SlipTruth(
        rcof=rcof,
        acof=float(acof),
        peak_speed=speed,
        slip_start=float(own.uniform(0.03, 0.06)),
        rise=rise,
        fall=float(own.uniform(0.2, 0.27)) if slips else 0.1,
        angle=float(own.normal(0, 0.06)),
        pressure=float(60e3 * speed) if slips else 600.0,
        width=0.015,
        lateral=float(own.normal(0, 0.008)),
        mass=mass,
    )
    defects = Defects(
        missing_frames=int(own.integers(3, 9)) if own.random() < 0.2 else 0,
        dropped_samples=int(own.integers(2, 20)) if own.random() < 0.1 else 0,
    )
    conditions = {
        "subject": f"S{subject + 1:02d}",
        "outsole": outsole,
        "order": "first" if order == 0 else "second",
        "fluid": "glycerol_50pct",
        "mass (kg)": f"{truth.mass:.1f}",
    }
    return truth, defects, conditions


def _slips(out: Path, count: int, rng: np.random.Generator, progress: Progress) -> list[Path]:
    paths, conditions, truths = [], [], []
    seed = int(rng.integers(2**32))
    sensors: Mapping[str, tuple[float, float, float]] = {}
    for number in range(count):
        truth, defects, noted = slip_truth(number, seed)
        own = np.random.default_rng([seed, number])
        recording = walk_with_slip(truth, defects, own, duration=DURATION)
        sensors = recording.sensors
        path = out / f"slip_{number + 1:03d}.c3d"
        path.write_bytes(walk_c3d(recording))
        paths.append(path)
        conditions.append({"file": path.name, **noted, "acof": f"{truth.acof:.4f}"})
        truths.append({"file": path.name, **{k: f"{v:.6g}" for k, v in recording.truth.items()}})
        progress("writing made-up trials", (number + 1) / count)
    lines = [
        '# Made-up recordings: nothing was measured.\nname = "synthetic walkway"\n',
        '[axes]\nvertical = "+z"\nwalking = "+x"\n',
        '[heel]\nleft = "LHEE"\nright = "RHEE"\n',
        '[sensors]\nunit = "mm"',
    ]
    lines += [f"{n} = [{1e3 * x:g}, {1e3 * y:g}, {1e3 * z:g}]" for n, (x, y, z) in sensors.items()]
    (out / "profile.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    _tables(out, conditions, truths)
    return paths


def _study(out: Path, count: int, rng: np.random.Generator, progress: Progress) -> list[Path]:
    return simulated_study(out, persons=count, seed=int(rng.integers(2**32)), progress=progress)


def _activities(out: Path, count: int, rng: np.random.Generator, progress: Progress) -> list[Path]:
    paths, truths = [], []
    for number, (name, words) in enumerate(ACTIVITIES.items(), start=1):
        path = out / f"{name}.c3d"
        path.write_bytes(activity_c3d(activity(name, rng)))
        paths.append(path)
        truths.append({"file": path.name, "activity": words})
        progress("writing made-up activities", number / len(ACTIVITIES))
    _tables(out, truths, truths)
    return paths


def _tester(out: Path, count: int, rng: np.random.Generator, progress: Progress) -> list[Path]:
    paths, conditions, truths = [], [], []
    scans = max(count, 2) if count != 12 else 7
    places = 0.01 * (np.arange(scans) - (scans - 1) / 2)
    for (shoe, fluid), truth in _SHOES.items():
        for number, lateral in enumerate(places, start=1):
            path = out / f"{shoe}_scan_{number}.csv"
            _write_columns(path, scan_columns(truth, float(lateral), rng))
            paths.append(path)
            conditions.append(
                {"file": path.name, "shoe": shoe, "fluid": fluid, "map": f"{shoe}, {fluid}"}
            )
            truths.append(
                {
                    "file": path.name,
                    "cof": f"{truth.cof:.6g}",
                    "fluid_load": f"{truth.covered_load(places, 0.01):.6g}",
                    "peak_pressure": f"{truth.pressure:.6g}",
                    "lateral": f"{lateral:.6g}",
                }
            )
            progress("writing made-up scans", len(paths) / (len(_SHOES) * scans))
    x, y, z = (1e3 * value for value in SENSOR)
    (out / "profile.toml").write_text(
        "# Made-up recordings: nothing was measured.\n"
        'name = "synthetic slip tester"\n\n[axes]\nvertical = "+z"\nwalking = "+x"\n\n'
        f'[sensors]\nunit = "mm"\npressure = [{x:g}, {y:g}, {z:g}]\n',
        encoding="utf-8",
    )
    _tables(out, conditions, truths)
    return paths


def _pin_on_disk(out: Path, count: int, rng: np.random.Generator, progress: Progress) -> list[Path]:
    repeats = count if count != 12 else 5
    paths, conditions, truths = [], [], []
    for fluid, (viscosity, boundary, tau, asymptote) in _FLUIDS.items():
        for repeat in range(1, repeats + 1):
            level = 1.0 + 0.04 * rng.standard_normal()
            for speed in _SPEEDS:
                cof = level * (asymptote + (boundary - asymptote) * math.exp(-speed / tau))
                cof = max(cof + 0.012 * rng.standard_normal(), 0.02)
                path = out / f"{fluid}_{repeat}_{1e3 * speed:04.0f}.csv"
                _write_columns(path, disk_run(cof, speed, rng))
                paths.append(path)
                conditions.append(
                    {
                        "file": path.name,
                        "fluid": fluid,
                        "repeat": f"run {repeat}",
                        "viscosity (cP)": f"{viscosity:g}",
                        "speed (m/s)": f"{speed:g}",
                    }
                )
                truths.append({"file": path.name, "cof": f"{cof:.6g}"})
        progress("writing made-up runs", len(paths) / (len(_FLUIDS) * repeats * len(_SPEEDS)))
    _tables(out, conditions, truths)
    return paths


def _relaxation(out: Path, count: int, rng: np.random.Generator, progress: Progress) -> list[Path]:
    paths, conditions, truths = [], [], []
    for number in range(1, count + 1):
        material = ("neolite", "rubber")[number % 2]
        peak, share, rate = {"neolite": (3000.0, 0.38, 0.013), "rubber": (120.0, 0.25, 0.025)}[
            material
        ]
        peak *= 1.0 + 0.02 * rng.standard_normal()
        path = out / f"{material}_{number:02d}.csv"
        columns = relaxation(rng, peak=peak, share=share, rate=rate)
        _write_columns(path, columns)
        paths.append(path)
        conditions.append({"file": path.name, "material": material, "thickness (mm)": "5.5"})
        final = peak * (1 - share + share * math.exp(-rate * 228.0))
        truths.append(
            {"file": path.name, "peak_force": f"{peak:.6g}", "final_force": f"{final:.6g}"}
        )
        progress("writing made-up tests", number / count)
    _tables(out, conditions, truths)
    return paths


def _write_columns(path: Path, columns: Mapping[str, np.ndarray]) -> None:
    data = np.column_stack(list(columns.values()))
    rows = "\n".join(",".join(f"{value:.6g}" for value in row) for row in data.tolist())
    path.write_text(",".join(columns) + "\n" + rows + "\n", encoding="utf-8")


def _tables(out: Path, conditions: list[dict[str, str]], truths: list[dict[str, str]]) -> None:
    for name, rows in (("conditions.csv", conditions), ("truth.csv", truths)):
        head = list(rows[0])
        lines = [",".join(head), *(",".join(_cell(row[key]) for key in head) for row in rows)]
        (out / name).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _cell(text: str) -> str:
    return f'"{text}"' if "," in text else text
