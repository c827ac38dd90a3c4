"""Press, hold, slide: the stages of an explicit march, its history, restarts and snapshots."""

import math
from dataclasses import dataclass, field, fields
from pathlib import Path
from xml.sax.saxutils import quoteattr
from zipfile import BadZipFile

import numpy as np

from underfoot.core import ConvergenceError, DataError, Progress
from underfoot.core.cache import default_folder
from underfoot.core.files import whole_file
from underfoot.core.optional import optional_module

from ._kernels import generate, names
from .assembly import Assembly, critical_time_step
from .inputs import MicroLoading
from .result import EnergyLedger, MicroAverages, edge_excess_area, whole_wavelength_averages

SETTLED = 0.01
"""Largest relative difference of contact force and load before sliding."""
HOLDS = 12
"""Most times that the hold is repeated."""
WATCH = 50
"""Samples between two copies of the state and checks of the step."""


@dataclass(slots=True, eq=False)
class BlockMarch:
    """A run in progress.

    ``stage``: 0 press, 1 hold, 2 slide, 3 done; ``holds`` counts holds.
    """

    assembly: Assembly
    loading: MicroLoading
    area: float
    wavelength: float
    samples_per_wavelength: int
    confined_modulus: float
    key: str
    progress: Progress
    output: Path | None = None
    snapshots: int = 0
    rows: list[np.ndarray] = field(default_factory=list)
    stage: int = 0
    holds: int = 0
    steps: int = 0
    settled: bool = True
    _rate: float = 0.0
    _good: dict[str, np.ndarray] = field(default_factory=dict)
    _since: int = 0
    _shown: list[tuple[float, str]] = field(default_factory=list)

    @property
    def periods(self) -> tuple[float, float, float]:
        """Press, hold and ramp, s: as asked for, but no shorter than the block's shear wave needs.

        Its lowest shear mode lasts 4 H / c_s, longer when the mass is scaled.
        """
        slowest = self.shear_period
        load = self.loading
        return (
            max(load.press_time, 2.0 * slowest),
            max(load.hold_time, slowest),
            max(load.ramp_time, slowest) if self.assembly.mass_scaling > 1.0 else load.ramp_time,
        )

    @property
    def shear_period(self) -> float:
        """4 H / c_s, s."""
        g0 = self.assembly.control[names.G0]
        speed = math.sqrt(g0 / self.assembly.density)
        return 4.0 * float(self.assembly.mesh.nodes[2].max()) / speed

    def run(self) -> None:
        """BlockMarch to the end; ``stage`` and ``holds`` tell where a restart goes on."""
        c, s = self.assembly.control, self.assembly.state
        press, hold, ramp = self.periods
        c[names.FREE] = 1.0
        c[names.LOAD] = self.loading.mean_pressure * self.area
        c[names.LOAD_TIME] = press
        c[names.RAMP] = ramp
        if self.stage < 2:
            c[names.ALPHA] = 2.0 * math.pi / self.shear_period
        if self.stage == 0:
            self._until_time("press", press, press / 100.0)
            self.stage = 1
        while self.stage == 1:
            end = press + hold * (self.holds + 1)
            self._until_time("hold", end, hold / 20.0)
            self.holds += 1
            recent = float(np.mean([row[2] for row in self.rows[-10:]]))
            self.settled = abs(recent / c[names.LOAD] - 1.0) < SETTLED
            if self.settled or self.holds >= HOLDS:
                self.stage = 2
        if self.stage == 2 and self.loading.speed > 0.0:
            c[names.ALPHA] = 0.0
            if not math.isfinite(c[names.SLIDE_START]):
                c[names.SLIDE_START] = s[names.TIME]
                if self.loading.control == "displacement":
                    s[names.TOP_SPEED] = 0.0
            c[names.FREE] = float(self.loading.control == "load")
            self._slide()
        self.stage = 3

    def _until_time(self, name: str, end: float, sample: float) -> None:
        s = self.assembly.state
        count = max(1, round(sample / self.assembly.time_step))
        while s[names.TIME] < end - 0.5 * self.assembly.time_step:
            left = max(1, round((end - s[names.TIME]) / self.assembly.time_step))
            self._sample(min(count, left))
            self.progress(name, min(s[names.TIME] / end, 1.0))

    def _slide(self) -> None:
        s, goal = self.assembly.state, self.loading.slide_distance
        sample = self.wavelength / self.loading.speed / self.samples_per_wavelength
        count = max(1, round(sample / self.assembly.time_step))
        while s[names.SLID] < goal:
            step = self.loading.speed * self.assembly.time_step
            ahead = math.ceil((goal - s[names.SLID]) / step) + 1
            self._sample(max(1, min(count, ahead)))
            self.progress("slide", min(s[names.SLID] / goal, 1.0))
            due = self.snapshots * s[names.SLID] / goal
            if self.output is not None and len(self._shown) < math.floor(due):
                self._show()

    def _sample(self, count: int) -> None:
        assembly = self.assembly
        if self._since % WATCH == 0:
            self._watch()
        self._since += 1
        assembly.advance(count)
        self.steps += count
        row = new_row(assembly, self.rows[-1] if self.rows else None, self._rate)
        self._rate = float(assembly.state[names.LOSS_RATE])
        self._check(row)
        self.rows.append(row)

    def state(self) -> dict[str, np.ndarray]:
        """Return copies of all that a restart needs."""
        u, v, _ = self.assembly.nodes
        rows = np.array(self.rows) if self.rows else np.empty((0, len(COLUMNS)))
        return {
            "key": np.array(self.key),
            "displacement": u.copy(),
            "velocity": v.copy(),
            "history": self.assembly.history.copy(),
            "state": self.assembly.state.copy(),
            "control": self.assembly.control.copy(),
            "rows": rows,
            "counts": np.array([self.stage, self.holds, self.steps, int(self.settled)]),
            "rate": np.array(self._rate),
            "shown": np.array([time for time, _ in self._shown]),
        }

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Go on from the state of a restart file."""
        u, v, _ = self.assembly.nodes
        u[:], v[:] = arrays["displacement"], arrays["velocity"]
        self.assembly.history[:] = arrays["history"]
        self.assembly.state[:] = arrays["state"]
        self.assembly.control[:] = arrays["control"]
        self.rows = list(arrays["rows"])
        self.stage, self.holds, self.steps = (int(n) for n in arrays["counts"][:3])
        self.settled = bool(arrays["counts"][3])
        self._rate = float(arrays["rate"])
        self._shown = [(float(t), _name(n)) for n, t in enumerate(arrays["shown"], start=1)]

    def _watch(self) -> None:
        """Keep a copy of a state known to be sound; stop when squeezed elements ask for less."""
        assembly = self.assembly
        square = assembly.mesh.largest_gradient_square(assembly.displacement)
        critical = critical_time_step(square, self.confined_modulus, assembly.density)
        if assembly.time_step > critical:
            self._stop(
                f"squeezed elements ask for a step below {critical:.3g} s, and this one is "
                f"{assembly.time_step:.3g} s",
                "Lower cfl, or spread the roughness over more layers",
            )
        self._good = self.state()
        if self.output is not None:
            saved_state(self.output / "restart.npz", self._good)

    def _check(self, row: np.ndarray) -> None:
        if not np.all(np.isfinite(row)):
            self._stop("the numbers became NaN or infinite: the march is unstable", "Lower cfl")
        least = float(self.assembly.state[names.LEAST_J])
        if not least > 0.0:
            self._stop(
                "an element turned inside out",
                "Refine the lower layers, lower the pressure or the roughness, or lower cfl",
            )
        held = float(row[11] + row[12] + row[13] + row[14])
        supplied = abs(float(row[9])) + abs(float(row[10]))
        peak = max([float(r[10]) for r in self.rows[-1:]], default=0.0)
        if held > 2.0 * max(supplied, abs(peak)) + 1e-18:
            self._stop(
                f"the block holds {held:.3g} J after work of {supplied:.3g} J: the march makes "
                "energy",
                "Lower cfl or penalty_factor",
            )

    def _stop(self, what: str, remedy: str) -> None:
        s = self.assembly.state
        folder = default_folder() / "finite_element" if self.output is None else self.output
        saved = ""
        if self._good:
            path = saved_state(folder / "last_good_state.npz", self._good)
            saved = f"; the last good state, step {int(self._good['counts'][2])}, is in {path}"
        raise ConvergenceError(
            f"{what} (step {self.steps}, {s[names.TIME]:.4g} s, slid {s[names.SLID]:.4g} m){saved}",
            where="explicit_sliding",
            history=[float(row[2]) for row in self.rows[-20:]],
            remedy=remedy,
        )

    def _show(self) -> None:
        assert self.output is not None
        name = _name(len(self._shown) + 1)
        snapshot(self.output / name, self.assembly)
        self._shown.append((float(self.assembly.state[names.TIME]), name))
        collection(self.output / "block.pvd", self._shown)


def _name(number: int) -> str:
    return f"block_{number:04d}.vtu"


COLUMNS = (
    "time distance normal shear lateral area absolute resultant top floor_work top_work kinetic "
    "strain hourglass contact material_loss hourglass_loss contact_loss damping_loss edges"
).split()
"""Of a row; forces and area are means over the steps since the row before, ``edges`` is the area
that the edges of contact spots count too much at the row's end."""


def new_row(assembly: Assembly, before: np.ndarray | None, rate: float) -> np.ndarray:
    """Return the row of the sample just marched, and start the next one.

    ``rate`` is the loss rate at the row before: the loss is integrated by trapezoids.
    """
    s = assembly.state
    count = s[names.COUNT]
    # State holds the moment after the last move; energies and forces belong to the one before it.
    time = s[names.TIME] - assembly.time_step
    distance = s[names.SLID] - s[names.LAST_STEP]
    lost = 0.0
    if before is not None:
        lost = before[15] + 0.5 * (rate + s[names.LOSS_RATE]) * (time - before[0])
    held = (names.KINETIC, names.STRAIN, names.HOURGLASS, names.CONTACT_ENERGY)
    row = np.array(
        [
            time,
            distance,
            *(s[names.NORMAL : names.COUNT] / count),
            *s[[names.TOP, names.SAMPLE_FLOOR_WORK, names.SAMPLE_TOP_WORK, *held]],
            lost,
            *s[[names.HOURGLASS_LOSS, names.CONTACT_LOSS, names.DAMPING_LOSS]],
            _edges(assembly),
        ]
    )
    s[names.NORMAL : names.COUNT + 1] = 0.0
    return row


def _edges(assembly: Assembly) -> float:
    """Return the edge excess of the nodes that touch now, m^2."""
    nx, ny, _ = assembly.mesh.shape
    periodic = assembly.control[names.PERIODIC] != 0.0
    touching = (assembly.arrays[11][0] < 0.0).reshape(ny, nx)
    if periodic:
        touching = touching[:-1, :-1]
    dx, dy = (
        float(axis[-1]) / (count - 1)
        for axis, count in ((assembly.arrays[1], nx), (assembly.arrays[2], ny))
    )
    return edge_excess_area(touching, dx, dy, periodic=periodic)


def ledger(rows: np.ndarray) -> EnergyLedger:
    """Return the energies of rows (n, columns)."""
    columns: dict[str, np.ndarray] = dict(zip(COLUMNS, rows.T, strict=True))
    return EnergyLedger(**{field.name: columns[field.name] for field in fields(EnergyLedger)})


def averages(rows: np.ndarray, wavelength: float, area: float) -> MicroAverages | None:
    """Return the means over whole wavelengths of the sliding rows."""
    c = dict(zip(COLUMNS, rows[rows[:, 1] > 0.0].T, strict=True))
    forces = (c[name] for name in ("normal", "shear", "absolute", "resultant", "area"))
    corrected = np.maximum(c["area"] - c["edges"], 0.0)
    return whole_wavelength_averages(c["distance"], [*forces, corrected], wavelength, area)


def saved_state(path: Path, arrays: dict[str, np.ndarray]) -> Path:
    """Write arrays to ``path`` and return it; an older file stays until the new one is whole."""
    with whole_file(path) as part, part.open("wb") as stream:
        np.savez_compressed(stream, **arrays)  # pyright: ignore[reportArgumentType]  # arrays only
    return path


def loaded_state(path: Path, key: str) -> dict[str, np.ndarray]:
    """Return the arrays of a restart file that was written for the same inputs.

    Raises:
        DataError: A file that can't be read, or that belongs to another case.
    """
    try:
        with np.load(path, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
    except (OSError, ValueError, EOFError, KeyError, BadZipFile) as problem:
        raise DataError(
            f"{path} can't be read as a restart file: {problem}",
            where="restart",
            remedy="Give a file that explicit_sliding wrote, or leave restart out",
        ) from problem
    if str(arrays.get("key", "")) != key:
        raise DataError(
            f"{path} belongs to another block, floor, material, loading or settings",
            where="restart",
            remedy="Restart with the inputs that the file was written with",
        )
    return arrays


def snapshot(path: Path, assembly: Assembly) -> None:
    """Write the block as a VTU file: displacement, velocity, pressure, J, von Mises stress.

    Stresses are those of the fast (unrelaxed) response, Pa.
    """
    meshio = optional_module("meshio", "paraview", "Writing snapshots")
    mesh = assembly.mesh
    corners = mesh.elements[:, None] + mesh.offsets
    numbers = np.full(mesh.nodes.shape[1], -1)
    used = np.unique(corners)
    numbers[used] = np.arange(used.size)
    jac, mises = _stresses(assembly)
    bulk = float(assembly.parameters[generate.PARAMETERS.index("bulk")])
    lift = assembly.arrays[3][0] - mesh.nodes[2, 0]
    points = (mesh.nodes + assembly.displacement)[:, used].T
    points[:, 2] += lift
    written = meshio.Mesh(
        points,
        [("hexahedron", numbers[corners])],
        point_data={
            "displacement": assembly.displacement[:, used].T,
            "velocity": assembly.velocity[:, used].T,
        },
        cell_data={
            "pressure": [bulk * (1.0 - jac)],
            "volume_ratio": [jac],
            "von_mises_stress": [mises],
        },
    )
    with whole_file(path) as part:
        written.write(part, file_format="vtu")


def collection(path: Path, shown: list[tuple[float, str]]) -> None:
    """Write a ParaView collection (PVD) that gives each snapshot its time."""
    rows = "\n".join(
        f'    <DataSet timestep="{time:.9e}" file={quoteattr(name)}/>' for time, name in shown
    )
    text = (
        '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
        f"{rows}\n  </Collection>\n</VTKFile>\n"
    )
    with whole_file(path) as part:
        part.write_text(text, encoding="utf-8")


def _stresses(assembly: Assembly) -> tuple[np.ndarray, np.ndarray]:
    """Return J and the von Mises equivalent of the isochoric Cauchy stress of each element."""
    f = assembly.mesh.deformation_gradient(assembly.displacement)
    jac = np.linalg.det(f)
    g0 = float(assembly.parameters[generate.PARAMETERS.index("g0")])
    left = f @ f.transpose(0, 2, 1)
    trace = np.trace(left, axis1=1, axis2=2)
    deviator = left - trace[:, None, None] / 3.0 * np.eye(3)
    stress = g0 * jac[:, None, None] ** (-5.0 / 3.0) * deviator
    return jac, np.sqrt(1.5 * np.sum(stress**2, axis=(1, 2)))
