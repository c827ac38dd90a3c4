"""Small studies of made-up results, one of every kind of protocol, without a recording."""

from typing import Any

import numpy as np

from underfoot.core.remark import Message
from underfoot.trials.recording.measurement import MEAN_OF_STEPS, caution
from underfoot.trials.study.file_result import (
    CAUTION,
    REFUSED,
    FileResult,
    FileResultDraft,
    LoggedEdit,
    Number,
    StepResult,
)
from underfoot.trials.study.person_measures import FORCE, HEIGHT

SHOES = {"soft": 0.22, "hard": 0.19, "worn": 0.20}
SAID = {
    "filter": Message("no filter"),
    "gate": Message("normal force above 100 N"),
    "shear": Message("resultant"),
    "peak": Message("largest local maximum"),
    "direction": Message("any"),
    "searched": Message("first 50 % of the stance"),
    "baseline": Message("not subtracted"),
    "walking direction": Message("given"),
}


def main(name: str, value: float, unit: str = "1", item: str = "", **more: Any) -> Number:
    """Return a number that counts in tables."""
    return Number(name, float(value), unit, 0.01 * abs(value), main=name, item=item, **more)


def curves_of(rng: np.random.Generator, rcof: float) -> dict[str, Any]:
    """Return forces over a stance, and the same over percent of it."""
    share = np.linspace(0.0, 1.0, 161)
    normal = 700.0 * np.sin(np.pi * share) ** 0.5 + rng.normal(0, 0.5, 161)
    ratio = rcof * np.exp(-(((share - 0.17) / 0.1) ** 2)) - 0.15 * np.exp(
        -(((share - 0.8) / 0.1) ** 2)
    )
    percent = np.interp(np.linspace(0, 1, 101), share, ratio)
    step = {
        "step": "step 1 on plate 1",
        "number": 1,
        "time": 0.65 * share,
        "ratio": np.abs(ratio),
        "normal": normal,
        "along": -ratio * normal + rng.normal(0, 3.0, 161),
        "across": 0.1 * ratio * normal,
        "gate": 0.02,
        "peak_time": 0.11,
        "peak": rcof,
        "verdict": "accepted",
    }
    normalised = {
        "step": "step 1 on plate 1",
        "vertical": normal[::16],
        "braking": ratio[::16],
        "to the left": 0.1 * ratio[::16],
        "ratio": np.abs(percent),
    }
    for name in ("vertical", "braking", "to the left"):
        normalised[name] = np.interp(np.arange(101), np.linspace(0, 100, 11), normalised[name])
    return {"steps": [step], "normalised": [normalised]}


def gait_files(persons: int = 6, trials: int = 2, seed: int = 1) -> list[FileResult]:
    """Return walks of persons in three shoes on two floors."""
    rng = np.random.default_rng(seed)
    files = []
    for person in range(persons):
        level, size = rng.normal(0, 0.01), float(np.exp(rng.normal(0, 0.08)))
        for shoe, mean in SHOES.items():
            for trial in range(trials):
                rcof = mean + level + rng.normal(0, 0.004) + 0.01 * trial
                flags = (caution("a doubt"),) if person == 0 else ()
                number = Number(
                    "rcof",
                    rcof,
                    "1",
                    0.003,
                    item="step 1 on plate 1",
                    flags=flags,
                    conventions=SAID,
                )
                mean_of = main("rcof", rcof, item=MEAN_OF_STEPS)
                step = StepResult(
                    number=1,
                    item="step 1 on plate 1",
                    plate="plate 1",
                    side="left",
                    contact=0.1,
                    toe_off=0.75,
                    stance_time=0.65,
                    peak_force=700.0 * size,
                    rcof=rcof,
                    rcof_uncertainty=0.003,
                    verdict="accepted",
                    walking_speed=1.3 + rng.normal(0, 0.03),
                    step_length=0.7,
                    step_time=0.54,
                    cadence=1.85,
                    foot_angle=0.3,
                    heel_speed=0.5,
                )
                other = StepResult(
                    number=2,
                    item="step 2 on plate 2",
                    plate="plate 2",
                    side="right",
                    contact=0.7,
                    toe_off=1.3,
                    stance_time=0.6,
                    peak_force=690.0 * size,
                    reason=Message("partial"),
                )
                body = {FORCE: 550.0 * size, HEIGHT: 1.0 * size, "A to B (m)": 0.3 * size}
                body = {k: v * float(np.exp(rng.normal(0, 0.004))) for k, v in body.items()}
                draft = FileResultDraft("", {})
                for name, curves in curves_of(rng, rcof).items():
                    for curve in curves:
                        draft.curve(name, **curve)
                files.append(
                    FileResult(
                        f"P{person + 1}_{shoe}_{trial + 1}.c3d",
                        f"{len(files):02d}",
                        CAUTION if person == 0 else "accepted",
                        ("a doubt",) if person == 0 else (),
                        numbers=(number, mean_of, Number("steps", 1.0, "1", fact="steps")),
                        curves=draft.curves,
                        steps=(step, other),
                        body=body,
                        conditions={
                            "subject": f"P{person + 1}",
                            "shoe": shoe,
                            "floor": ("dry", "wet")[trial % 2],
                            "mass": 60.0 * size,
                            "n": str(trial + 1),
                        },
                    )
                )
    return files


def slip_files(
    persons: int = 5, seed: int = 2, outsoles: tuple[str, ...] = ("hard", "soft")
) -> list[FileResult]:
    """Return slips of persons, two walks each, with pressures of an array."""
    rng = np.random.default_rng(seed)
    files = []
    for person in range(persons):
        for order in ("first", "second"):
            outsole = outsoles[(person + (order == "second")) % len(outsoles)]
            acof = {"hard": 0.15, "soft": 0.19}.get(outsole, 0.17) + rng.normal(0, 0.004)
            rcof = 0.18 + rng.normal(0, 0.015)
            slips = float(rng.random() < 1 / (1 + np.exp(80 * (acof - rcof))))
            speed = rng.uniform(0.4, 1.2) if slips else rng.uniform(0.05, 0.19)
            pressure = 6e4 * speed + rng.normal(0, 3e3)
            time = np.linspace(-0.1, 0.8, 91)
            heel = {
                "time": time,
                "start": 0.04,
                "end": 0.4,
                "peak_time": 0.2,
                "speed": speed * np.exp(-(((time - 0.2) / 0.1) ** 2)) + 0.02,
                "peak": speed,
                "threshold": 0.2,
            }
            rows = [
                {
                    "sensor": f"P{k}",
                    "row": k,
                    "pressure": pressure * (1 - 0.1 * k) + rng.normal(0, 900),
                    "irss": speed * (0.8 + 0.1 * k),
                    "ml": rng.normal(0, 0.01),
                }
                for k in (1, 2, 3)
            ]
            numbers = [
                main("slip", slips),
                main("rcof", rcof, item="step 1 on plate 1", conventions=SAID),
                main("acof", acof),
                main("peak_slipping_speed", speed, "m/s", "slip on plate 2"),
                main("slip_distance", 0.1 * speed, "m"),
                main("slip_margin", speed - 0.2, "m/s"),
                main("peak_pressure", pressure, "Pa", "sensor array"),
                main("crossed_array", 1.0),
            ]
            step = StepResult(
                number=2,
                item="slip on plate 2",
                plate="plate 2",
                side="left",
                contact=2.2,
                toe_off=2.8,
                judged_for_slip=True,
                slipped=bool(slips),
                peak_slipping_speed=speed,
                verdict="accepted",
                slip_distance=0.1 * speed,
                outcome="slide" if slips else "no slip",
                walking_speed=1.4,
                slip_direction="forward" if slips else "",
                recovery_or_fall="recovery" if slips else "",
            )
            draft = FileResultDraft("", {})
            draft.curve("heel", **heel)
            for name, curves in curves_of(rng, rcof).items():
                for curve in curves:
                    draft.curve(name, **curve)
            files.append(
                FileResult(
                    f"slip_{person + 1:02d}_{order}.c3d",
                    f"s{len(files)}",
                    numbers=tuple(numbers),
                    curves={**draft.curves, "sensor_rows": rows},
                    steps=(step,),
                    conditions={
                        "subject": f"S{person + 1:02d}",
                        "outsole": outsole,
                        "order": order,
                        "tread": ("none", "full")[person % 2],
                    },
                )
            )
    return files


def pin_files(seed: int = 3) -> list[FileResult]:
    """Return runs of a pin: three fluids, two roughnesses, six speeds."""
    rng = np.random.default_rng(seed)
    fluids = {"water": (0.001, 0.6, 0.5), "oil": (0.1, 0.4, 0.15), "honey": (5.0, 0.2, 0.1)}
    files = []
    for fluid, rough, repeat in (
        ("water", "fine", "1"),
        ("water", "fine", "2"),
        ("oil", "fine", "1"),
        ("oil", "coarse", "1"),
        ("honey", "fine", "1"),
    ):
        viscosity, boundary, tau = fluids[fluid]
        level = boundary * (1.1 if rough == "coarse" else 1.0) * (1 + 0.02 * rng.normal())
        for speed in (0.05, 0.1, 0.2, 0.4, 0.7, 1.0):
            cof = 0.1 + (level - 0.1) * np.exp(-speed / tau) + 0.003 * rng.normal()
            if fluid == "honey":
                cof = 0.12 + 0.02 * rng.normal()
            time = np.linspace(0, 9, 31)
            draft = FileResultDraft("", {})
            draft.curve(
                "run", time=time, ratio=cof * (1 + 0.3 * np.exp(-time)), begin=2.0, end=9.0, cof=cof
            )
            numbers = (main("cof", cof, item="run"), main("speed", speed, "m/s"))
            files.append(
                FileResult(
                    f"{fluid}_{rough}_{repeat}_{speed}.csv",
                    numbers=numbers,
                    curves=draft.curves,
                    conditions={
                        "fluid": fluid,
                        "roughness": rough,
                        "repeat": repeat,
                        "viscosity": viscosity,
                        "speed": speed,
                    },
                )
            )
    return files


def boundary_files(seed: int = 4) -> list[FileResult]:
    """Return friction forces dry, with an oil that blocks adhesion, and with two fluids."""
    rng = np.random.default_rng(seed)
    dry = {
        ("a", "steel"): 12.0,
        ("a", "tile"): 10.0,
        ("b", "steel"): 8.0,
        ("b", "tile"): 9.0,
        ("c", "steel"): 6.0,
        ("c", "tile"): 5.0,
    }
    files = []
    for (shoe, floor), force in dry.items():
        parts = {
            "dry": force,
            "sae_75w140": 1.5,
            "water": 1.5 + 0.6 * (force - 1.5),
            "soap": 1.2 + 0.1 * force,
        }
        for fluid, mean in parts.items():
            for repeat in range(2):
                if (shoe, floor, fluid) == ("c", "tile", "sae_75w140"):
                    continue
                value = mean + 0.2 * rng.normal()
                files.append(
                    FileResult(
                        f"{shoe}_{floor}_{fluid}_{repeat}.csv",
                        numbers=(main("friction_force", value, "N"),),
                        conditions={"shoe": shoe, "floor": floor, "fluid": fluid},
                    )
                )
    return files


def slide_files(seed: int = 5) -> list[FileResult]:
    """Return slides with pressure scans of two shoes, six places each."""
    rng = np.random.default_rng(seed)
    files = []
    for shoe, (cof, pressure) in {"x": (0.08, 2e5), "y": (0.12, 4e3)}.items():
        for k, lateral in enumerate((-0.025, -0.015, -0.005, 0.005, 0.015, 0.025)):
            along = np.linspace(-0.01, 0.12, 131)
            field = pressure * np.exp(-(((along - 0.02) / 0.02) ** 2) - (lateral / 0.012) ** 2)
            scan = {
                "along": along.tolist(),
                "pressure": field.tolist(),
                "lateral": lateral,
                "speed": 0.7,
                "speed_change": 0.02,
                "baseline_sd": 200.0,
                "sample_load": float(field.sum() * 1e-3),
            }
            time = np.linspace(0, 1, 51)
            draft = FileResultDraft("", {})
            normal = 500.0 * np.clip(5 * time, 0, 1)
            value = cof * (1 + 0.01 * rng.normal()) * (1.5 if shoe == "y" and k == 3 else 1.0)
            draft.curve(
                "slide",
                time=time,
                normal=normal,
                shear=value * normal,
                ratio=np.where(normal > 20, value, np.nan),
                begin=0.5,
                end=0.7,
            )
            numbers = (
                main("cof", value, item="slide"),
                main("scan_peak_pressure", field.max(), "Pa"),
            )
            files.append(
                FileResult(
                    f"{shoe}_{k + 1}.csv",
                    numbers=numbers,
                    curves={**draft.curves, "scan": scan},
                    conditions={"map": shoe, "shoe": shoe},
                )
            )
    return files


def relaxation_files() -> list[FileResult]:
    """Return relaxation tests of two materials."""
    names = (
        "force_2_percent",
        "peak_force",
        "final_force",
        "short-time modulus",
        "long-time modulus",
    )
    files = []
    for material, size in (("rubber", 1.0), ("neolite", 20.0)):
        for repeat in range(3):
            values = np.array([2.0, 120.0, 80.0, 2e6, 1.3e6]) * size * (1 + 0.02 * repeat)
            units = ("N", "N", "N", "Pa", "Pa")
            numbers = tuple(
                main(n, v, u, "test") for n, v, u in zip(names, values, units, strict=True)
            )
            draft = FileResultDraft("", {})
            time = np.geomspace(0.1, 200, 25)
            draft.curve("hold", time=time, force=80.0 + 40.0 * np.exp(-time / 9), final=80.0)
            files.append(
                FileResult(
                    f"{material}_{repeat}.csv",
                    numbers=numbers,
                    curves=draft.curves,
                    conditions={"material": material, "thickness": 0.0055, "area": 1.6e-4},
                )
            )
    return files


def refused_file(name: str = "bad.c3d", reason: str = "can't be read") -> FileResult:
    """Return a file without a number."""
    return FileResult(name, "b", REFUSED, (reason,), kinds=(reason,))


EDITED = FileResult(
    "edited.c3d",
    "e",
    numbers=(main("rcof", 0.21),),
    conditions={"subject": "P9", "shoe": "soft"},
    edits=(
        LoggedEdit("step 1 on plate 1", "contact", "0.1 s", "0.12 s", "late", "rcof", 0.2, 0.21),
        LoggedEdit("step 2 on plate 2", "exclude", "step", "no step: why", "slipped", "rcof", 0.2),
    ),
)
