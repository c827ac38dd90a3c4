"""How far a value travels through the files of the program, on eight ways: ``make ways``.

A real run is watched call by call (``sys.setprofile``). What is counted:

- The *value* is an object of a way's types: what goes in, and what it is made into, one after the
  other (a ``Trial``, its ``Walkway``, a ``Stance``, the ``RequiredFriction``). Arrays and numbers
  taken out of it have no type of their own and are not followed; what is written for a type is.
- A function *handles* the value when it gets it as an argument (itself, or in a list, tuple or
  dictionary), or hands it back. A call that stands in one place of the code counts once, in the
  order of the first time, however often a loop or a second step comes by.
- A *stay* is a file in which functions handle the value, one after the other; the next file begins
  the next stay. ``files`` are the different ones; a *return* is a stay in a file that the value had
  left; a *climb* is a stay in a higher room (layers of ``pyproject.toml``) than the one before.
- Reading a field or property of the value is no handling (what the property hands it on to is), and
  neither is making, comparing or printing it. A function inside another belongs to that one.

``python tests/ways.py`` prints the counts; with the key of one way each stay with its functions.
"""

import json
import os
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from types import CodeType, FrameType, MappingProxyType
from typing import Any

import numpy as np

REPOSITORY = Path(__file__).parents[1]
PACKAGE = REPOSITORY / "src" / "underfoot"
WALK = REPOSITORY / "tests/data/trials/kineticstoolkit/c3d_sample.c3d"


class Journey:
    """Follows the calls of a run; ``stays``: each file (below ``src/underfoot``), its functions."""

    def __init__(self, types: str) -> None:
        self.types, self.stays = frozenset(types.split()), list[tuple[str, list[str]]]()
        self._seen: set[tuple[CodeType | None, int, CodeType]] = set()
        self._files: dict[CodeType, str] = {}

    @property
    def counts(self) -> dict[str, int]:
        """Stays, files, climbs and returns."""
        files = [file for file, _ in self.stays]
        climbs = sum(a < b for a, b in pairwise(map(_floor(), files)))
        returns = len(files) - len(set(files))
        return {"stays": len(files), "files": len(set(files)), "climbs": climbs, "returns": returns}

    def __call__(self, frame: FrameType, event: str, result: Any) -> None:
        """Note a call or an answer that carries the value (``sys.setprofile``)."""
        code, caller = frame.f_code, frame.f_back
        if event not in ("call", "return"):
            return
        if code not in self._files:
            self._files[code] = _counted(code)
        place = (caller.f_code, caller.f_lineno, code) if caller else (None, 0, code)
        making = caller is not None and caller.f_code.co_name.startswith("__")
        if not self._files[code] or place in self._seen or making or _is_property(frame):
            return
        count = code.co_argcount + code.co_kwonlyargcount
        names = code.co_varnames[: count + bool(code.co_flags & 4) + bool(code.co_flags & 8)]
        given = [frame.f_locals[name] for name in names if name in frame.f_locals]
        if any(map(self._carries, given if event == "call" else [result])):
            self._seen.add(place)
            if not self.stays or self.stays[-1][0] != self._files[code]:
                self.stays.append((self._files[code], []))
            self.stays[-1][1].append(code.co_qualname)

    def _carries(self, value: Any) -> bool:
        """Whether a value is followed, or is a list, tuple or dictionary that begins with one."""
        if isinstance(value, dict | MappingProxyType):
            value = [*value, *value.values()][:: len(value) or 1]
        held = [value, *value[:4]] if isinstance(value, list | tuple) else [value]
        return any(kind.__name__ in self.types for each in held for kind in type(each).__mro__)


def _floor() -> Callable[[str], tuple[int, int]]:
    """Return what gives the height of a file's room among the layers, and of that in ``trials``."""
    settings = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = settings["tool"]["importlinter"]["contracts"]
    kinds = [each["layers"][::-1] for each in contracts if each["type"] == "layers"]
    whole, evidence = (
        {name.strip(" ()"): n for n, line in enumerate(each) for name in line.split("|")}
        for each in kinds
    )

    def floor(file: str) -> tuple[int, int]:
        room, below = file.split("/")[:2]
        return whole[room], evidence.get(below, len(evidence)) if room == "trials" else 0

    return floor


def _counted(code: CodeType) -> str:
    """The file of a function that counts, below ``src/underfoot``; "" of one that does not."""
    special = code.co_name.startswith("__") and code.co_name != "__call__"
    if special or "<" in code.co_qualname or not code.co_filename.startswith(str(PACKAGE)):
        return ""
    return Path(code.co_filename).relative_to(PACKAGE).as_posix()


def _is_property(frame: FrameType) -> bool:
    code, holder = frame.f_code, frame.f_locals.get("self")
    return code.co_argcount == 1 and not callable(getattr(type(holder), code.co_name, len))


def _case(**more: Any) -> Any:
    """A case on the coarsest grid."""
    from underfoot.case import Case

    sections = {
        "name": "way",
        "shoe": "work_shoe_untreaded",
        "floor": "vinyl_g4",
        "contaminant": "glycerol_90pct",
        "motion": {"from": "slip_tester_g4"},
        "numerics": {"grid_spacing": "5 mm", "quick_grid_spacing": "5 mm"},
    }
    return Case.from_mapping({**sections, **more})


def _viscosity(_: Path) -> Callable[[], object]:
    from underfoot.compute.prepare import prepare_case

    return lambda: prepare_case(_case(), 5e-3)


def _sole(_: Path) -> Callable[[], object]:
    from underfoot.compute.prepare import prepare_case
    from underfoot.compute.solve import solved_motion

    return lambda: solved_motion(prepare_case(_case(), 5e-3))


def _vertex(_: Path) -> Callable[[], object]:
    from underfoot.shoe.files import outsole_from_file

    return lambda: outsole_from_file(REPOSITORY / "tests/data/soles/multi_last.stl")


def _sample(_: Path) -> Callable[[], object]:
    from underfoot.trials import read_trial

    return lambda: read_trial(WALK)


def _trial(_: Path) -> Callable[[], object]:
    from underfoot.trials import read_trial, required_frictions, walkway_of

    trial = read_trial(WALK)
    return lambda: required_frictions(walkway_of(trial))


def _scan(folder: Path) -> Callable[[], object]:
    from underfoot.compute.run import run
    from underfoot.surface import HeightMap, write_surface

    heights = np.random.default_rng(1).normal(scale=2e-6, size=(200, 200))
    write_surface(HeightMap(heights, 10e-6), folder / "floor.sdf")
    floor = {"from": "vinyl_g4", "roughness": {"file": str(folder / "floor.sdf")}}
    return lambda: run(_case(floor=floor), quick=True)


def _reading(_: Path) -> Callable[[], object]:
    from underfoot.places.calibration import calibrated_floor

    case = _case(friction={"model": "pair"})
    return lambda: calibrated_floor(case, "pendulum-96", 36.0)


def _slider(folder: Path) -> Callable[[], object]:
    from underfoot.app import work
    from underfoot.app.inputs import changes
    from underfoot.app.pages.answer import LIVE
    from underfoot.core import silent

    tread = {"lug_width": "15 mm", "channel_width": "10 mm"}
    case = _case(shoe={"from": "work_shoe_full_tread", "tread": tread}, contaminant="water")
    file, result = str(folder / "case.toml"), str(folder / "result")
    case.save(file)
    work.computed(file, result, quick=True, progress=silent)
    moved = {"contaminant.viscosity": 1.2}
    return lambda: work.previewed(file, result, changes(LIVE, moved), progress=silent)


WAYS = {
    "viscosity": ("viscosity of a case → solver", _viscosity, "MeasuredFluid Context"),
    "sole": (
        "sole → contact pressure",
        _sole,
        "Shoe SoleShape Heel SoleMap LayeredCompliance ConvolutionCompliance",
    ),
    "vertex": (
        "vertex of an STL → outsole",
        _vertex,
        "MeshFile Mesh _Bodies Found View Shape TreadMap SoleSurface FileOutsole",
    ),
    "sample": ("C3D sample → `Trial`", _sample, "C3DFile RecordingDraft _RawPlate Trial"),
    "trial": (
        "`Trial` → RCOF",
        _trial,
        "Trial Plate Marker Walkway Belt Contact Stance Step HeelMotion Slip RequiredFriction",
    ),
    "scan": (
        "roughness scan → COF",
        _scan,
        "Heights Scan ProfileSpectrum IsotropicSpectrum Texture Directions ProfileRoughness",
    ),
    "reading": ("tester reading → posterior", _reading, "FloorReading PlaceDraws FloorCalibration"),
    "slider": ("slider → answer in the app", _slider, "Input Case Continuation Preview"),
}
"""Key: name, what prepares a cheap run and returns it, types of the value."""


def journey(key: str) -> Journey:
    """Return the journey of a value, in a process that has made none before (nothing is cached)."""
    _, prepare, types = WAYS[key]
    with tempfile.TemporaryDirectory() as folder:
        os.environ["UNDERFOOT_CACHE"] = str(Path(folder) / "cache")
        run, watch = prepare(Path(folder)), Journey(types)
        sys.setprofile(watch)
        try:
            run()
        finally:
            sys.setprofile(None)
    return watch


def main(words: list[str]) -> None:
    """Print the counts of all ways; of one that is named each stay too."""
    for key in () if words else WAYS:
        subprocess.run([sys.executable, __file__, key, "counts"], check=True)
    for key in words[:1]:
        watched = journey(key)
        print(f"{WAYS[key][0]:30}", json.dumps(watched.counts), flush=True)
        for file, functions in watched.stays if len(words) == 1 else ():
            print(f"  {file}: {', '.join(dict.fromkeys(functions))}")


if __name__ == "__main__":
    main(sys.argv[1:])
