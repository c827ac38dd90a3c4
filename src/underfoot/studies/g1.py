"""Report G.1: the micro finite-element model's matrix, condensed or by explicit finite elements."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, astuple, dataclass, fields, replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas

import underfoot.block
from underfoot import material as materials
from underfoot.block import condensed, explicit
from underfoot.core import Cache, InputError, Status, content_hash, unknown_name
from underfoot.core.catalogue import Catalogue

from .figure import (
    OURS,
    PRINTED,
    SECOND,
    Figure,
    Layer,
    Panel,
    grouped_bars,
    level,
    line,
    points,
)
from .runner import Computed, Options, StudyTable, cached_arrays
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("g1.toml")

MATERIALS = ("neolite", "rubber")
SHOE_RZ = (12.1e-6, 35.1e-6)
"""m, Table 1: neolite's own (low) and the rubber's own (high); both are run on both materials."""
FLOOR_RZ = (16.6e-6, 24.3e-6, 35.1e-6)
OWN_SHOE_RZ = {"neolite": 12.1e-6, "rubber": 35.1e-6}
SPEEDS = (0.1, 0.25, 0.5, 0.75, 1.0)
SHOE_WAVELENGTH, FLOOR_WAVELENGTH = 0.5e-3, 0.4e-3
"""m; assumed, see the errata."""
POISSON_RATIO = 0.499
BLOCK_LENGTH = 0.8e-3
PRINTED_BULK_MODULUS = {"neolite": 9324e6, "rubber": 2180e6}
"""Pa, Table 2."""
BROAD = {"neolite": (18.66e6, 0.10), "rubber": (0.44e6, 0.12)}
"""|G*| at 1 rad/s (Table 2's relaxed modulus) and exponent (assumed) of the broad spectrum."""
SERIES = {"report": "report's parameters", "broad": "assumed broad spectrum"}
HOLD_TIME = {"condensed": 0.3e-3, "explicit": 1.0e-3}
"""s; stiff neolite with scaled mass settles to 1 % of the load in the longer one."""
HISTORY = ("time", "distance", "normal_force", "shear_force", "real_contact_area")
FINE, COARSE = (26, 16, 9), (20, 13, 7)
"""Elements of the block: the report's mesh, and the coarser one that tells whether it matters."""
LEAST_COF = 1e-3
"""Smaller hysteresis COF is none: without loss the condensed block leaves 2e-5 by sampling, the
explicit elements up to 9e-4 by inertia, ringing and mass scaling."""
ROOM = "g1_explicit-2"
FIGURE_3 = ("rubber", 35.1e-6, 35.1e-6)
"""Material, shoe and floor roughness (m) of Fig. 3."""
QUANTITIES = {
    "hysteresis": ("cof_hysteresis", "hysteresis COF", 1.0),
    "area": ("area_per_force", "$A_c / F_N$ (mm²/N)", 1e6),
}
"""Column of a row, its axis, and shown over SI."""


@dataclass(frozen=True, slots=True)
class Settings:
    """How the matrix is run.

    Parameters:
        series: "report", "broad" or both.
        solver: "condensed" or "explicit".
        control: "displacement" (the report's: height kept while sliding) or "load".
        bulk_modulus: "corrected" (from Poisson's ratio 0.499) or "printed" (Table 2).
        shoe_wavelength, floor_wavelength: m.
        speeds: m/s.
        slide_distance: m; the floor is 2.125 mm long, which leaves 1.3 mm.
        steps_per_wavelength: Of the condensed solver.
        elements: Of the block.
    """

    series: tuple[str, ...] = ("report", "broad")
    solver: str = "condensed"
    control: str = "displacement"
    bulk_modulus: str = "corrected"
    shoe_wavelength: float = SHOE_WAVELENGTH
    floor_wavelength: float = FLOOR_WAVELENGTH
    speeds: tuple[float, ...] = SPEEDS
    slide_distance: float = 1.2e-3
    steps_per_wavelength: int = 64
    elements: tuple[int, int, int] = FINE

    def __post_init__(self) -> None:
        for name in self.series:
            if name not in SERIES:
                raise unknown_name("series of G.1", name, SERIES, where="series")
        for name, value, known in (
            ("solver", self.solver, ("condensed", "explicit")),
            ("control", self.control, ("displacement", "load")),
            ("bulk_modulus", self.bulk_modulus, ("corrected", "printed")),
        ):
            if value not in known:
                raise unknown_name(name.replace("_", " "), value, known, where=name)
        if len(self.speeds) < 2 or sorted(self.speeds) != list(self.speeds):
            raise InputError(
                f"{self.speeds}", where="speeds", allowed="two or more speeds, ascending"
            )
        if self.slide_distance / self.floor_wavelength < 1.0 - 1e-9:
            raise InputError(
                f"a slide of {self.slide_distance:g} m over waves of {self.floor_wavelength:g} m",
                where="slide_distance",
                allowed="one whole wavelength or more",
                remedy="The report prints 4 and 5 mm for a block of 0.8 mm; 0.4 and 0.5 mm fit",
            )

    @property
    def quick(self) -> Settings:
        """The same with the end speeds only, a coarser mesh and shorter slides."""
        return replace(
            self,
            speeds=(self.speeds[0], self.speeds[-1]),
            slide_distance=2.0 * self.floor_wavelength,
            steps_per_wavelength=32,
            elements=COARSE,
        )


@dataclass(frozen=True, slots=True)
class MatrixCell:
    """One cell of the matrix; lengths in m, speed in m/s."""

    series: str
    material: str
    shoe_rz: float
    floor_rz: float
    speed: float


@dataclass(frozen=True, slots=True)
class MatrixRow(MatrixCell):
    """One cell of the matrix with its averages over whole floor wavelengths (Eq. 8 to 12).

    ``area_per_force`` in m^2/N, ``mean_pressure`` in Pa, ``seconds`` of process time; NaN where
    the run gave no result (then ``status`` and ``note`` say why).
    """

    cof_hysteresis: float
    cof_absolute: float
    cof_resultant: float
    area_per_force: float
    area_per_force_corrected: float
    real_contact_fraction: float
    mean_pressure: float
    status: str
    note: str
    seconds: float


History = dict[str, np.ndarray]
FIG_3 = "Fig. 3: rubber, high shoe roughness on the high floor; dotted: sliding begins"


def compute(options: Options) -> Computed:
    """Return the matrix: materials x shoe roughness x floors x speeds for each series.

    The condensed block is run on two meshes, so that every change is judged on a converged one.
    Explicit cases are kept as they end: a run stopped early goes on from there.
    """
    settings: Settings = options.settings or Settings()
    if options.quick:
        settings = settings.quick
    cases = list(matrix(settings))
    meshes = [settings]
    if settings.solver == "condensed" and settings.elements == FINE:
        meshes.insert(0, replace(settings, elements=COARSE))
    before = kept_cases(settings, cases)
    levels: list[tuple[float, list[MatrixRow]]] = []
    histories: dict[tuple[str, float], History] = {}
    for number, mesh in enumerate(meshes):
        rows = []
        for row, history in outcomes(cases, mesh, options.processes):
            rows.append(row)
            done = (number + len(rows) / len(cases)) / len(meshes)
            options.progress(f"{row.series}: {row.material}, {row.speed:g} m/s", done)
            which = (row.material, row.shoe_rz, row.floor_rz)
            if which == FIGURE_3 and row.speed == max(settings.speeds):
                histories[row.series, row.speed] = history
        place = {astuple(case): i for i, case in enumerate(cases)}
        rows.sort(key=lambda row: place[astuple(row)[:5]])
        levels.append((BLOCK_LENGTH / mesh.elements[0], rows))
    rows = levels[-1][1]
    quantities: dict[str, ComputedQuantity] = {}
    for name in SERIES:
        quantities |= series_quantities(name, levels)
    return Computed(
        quantities,
        [cases_table(rows)],
        figures(rows, histories, settings.floor_wavelength),
        notes=_notes(rows, settings, before),
    )


def cases_table(rows: Sequence[MatrixRow]) -> StudyTable:
    """Return every case in the units of the report; what was said of a run is in the notes."""
    return StudyTable.of(
        "cases",
        "Averages over whole floor wavelengths",
        [
            {
                "series": SERIES[row.series],
                "material": row.material,
                "shoe Rz, µm": 1e6 * row.shoe_rz,
                "floor Rz, µm": 1e6 * row.floor_rz,
                "speed, m/s": row.speed,
                "hysteresis COF": row.cof_hysteresis,
                "mean |shear| over load": row.cof_absolute,
                "area over load, mm²/N": 1e6 * row.area_per_force,
                "without edges, mm²/N": 1e6 * row.area_per_force_corrected,
                "real contact, %": 100.0 * row.real_contact_fraction,
                "pressure, kPa": 1e-3 * row.mean_pressure,
                "status": row.status,
            }
            for row in rows
        ],
    )


def matrix(settings: Settings) -> Iterator[MatrixCell]:
    """Yield every case; those that share a block follow one another."""
    every = product(SHOE_RZ, settings.series, MATERIALS, FLOOR_RZ, settings.speeds)
    for shoe, series, material, floor, speed in every:
        yield MatrixCell(series, material, shoe, floor, speed)


def material_of(case: MatrixCell, bulk: str = "corrected") -> explicit.MicroMaterial:
    """Return the rubber of a case; density assumed."""
    if case.series == "report":
        young = materials.report_elastomer(case.material).modulus
        assert isinstance(young, materials.RelaxationSpectrum)
        shear = materials.shear_from_young(young, POISSON_RATIO)
    else:
        shear = materials.power_law_spectrum(*BROAD[case.material], terms_per_decade=2)
    relaxed = materials.youngs_modulus_from_shear(shear.equilibrium_modulus, POISSON_RATIO)
    k = float(materials.bulk_modulus(relaxed, POISSON_RATIO))
    if bulk == "printed":
        k = PRINTED_BULK_MODULUS[case.material]
    return explicit.MicroMaterial(shear, k, name=case.material, source=shear.source)


def parts_of(
    case: MatrixCell, settings: Settings
) -> tuple[
    explicit.MicroBlock, explicit.MicroSurface, explicit.MicroMaterial, explicit.MicroLoading
]:
    """Return block, floor, material and loading of a case."""
    rough = explicit.MicroSurface.checkerboard(case.shoe_rz, settings.shoe_wavelength)
    return (
        explicit.MicroBlock(elements=settings.elements, roughness=rough),
        explicit.MicroSurface.checkerboard(case.floor_rz, settings.floor_wavelength),
        material_of(case, settings.bulk_modulus),
        explicit.MicroLoading(
            speed=case.speed,
            slide_distance=settings.slide_distance,
            control=settings.control,
            hold_time=HOLD_TIME[settings.solver],
        ),
    )


def outcomes(
    cases: Sequence[MatrixCell], settings: Settings, processes: int | None = 1
) -> Iterator[tuple[MatrixRow, History]]:
    """Yield row and history of every case; explicit ones in the order in which they end."""
    if settings.solver == "explicit":
        items = [(case, settings) for case in cases]
        keys = [_key(case, settings) for case in cases]
        for _, arrays in cached_arrays(ROOM, explicit_outcome, items, keys, processes=processes):
            yield MatrixRow(**json.loads(str(arrays.pop("row")))), arrays
        return
    block: condensed.CondensedBlock | None = None
    last: tuple[float, float] | None = None
    steps = settings.steps_per_wavelength
    for case in cases:
        shape, floor, rubber, loading = parts_of(case, settings)
        ratio = condensed.condensed_poisson_ratio(rubber)
        key = (case.shoe_rz, round(ratio, 9))
        if block is None or key != last:
            block, last = condensed.condensed_block(shape, ratio), key
        result = condensed.condensed_sliding(
            block, floor, rubber, loading, steps_per_wavelength=steps
        )
        yield row_of(case, result), {name: getattr(result, name) for name in HISTORY}


def explicit_outcome(item: tuple[MatrixCell, Settings]) -> dict[str, np.ndarray]:
    """Return one case by explicit finite elements, mass scaled within its error bounds."""
    scaled = explicit.ExplicitSettings(mass_scaling="auto")
    result = explicit.explicit_sliding(*parts_of(*item), scaled)
    row = np.array(json.dumps(asdict(row_of(item[0], result))))
    return {"row": row, **{name: getattr(result, name) for name in HISTORY}}


def row_of(case: MatrixCell, result: explicit.MicroResult) -> MatrixRow:
    """Return the averages of a case as one row."""
    averages = result.averages if result.status.usable else None
    names = [field.name for field in fields(MatrixRow)][5:12]
    values = [math.nan if averages is None else float(getattr(averages, n)) for n in names]
    status = result.status
    if averages is None and status.usable:
        status = Status.NOT_CONVERGED
    note = "; ".join((*result.notes, *(str(breach) for breach in result.breaches)))
    seconds = result.process_seconds
    return MatrixRow(
        *asdict(case).values(), *values, status=str(status), note=note, seconds=seconds
    )


def kept_cases(settings: Settings, cases: Sequence[MatrixCell]) -> int:
    """Return how many of the explicit cases an earlier run has left."""
    if settings.solver != "explicit":
        return 0
    folder = Cache(ROOM).folder
    return sum((folder / f"{_key(case, settings)}.npz").is_file() for case in cases)


def _key(case: MatrixCell, settings: Settings) -> str:
    # What other cases are run changes nothing in this one.
    alone = replace(settings, series=(case.series,), speeds=(0.0, case.speed))
    return content_hash(case, alone, _source())


@cache
def _source() -> str:
    """Return a hash of the program text that the explicit numbers come from."""
    files = sorted(Path(str(underfoot.block.__file__)).parent.rglob("*.py"))
    return content_hash(*[path.read_text(encoding="utf-8") for path in (*files, Path(__file__))])


def changes(
    rows: Any, quantity: str, along: str, *, speed: float | None = None
) -> tuple[float, ...]:
    """Return the relative change of ``quantity`` from the lowest to the highest of ``along``.

    One value for each combination of the other conditions; ``speed`` keeps one speed only.
    ``rows`` are a sequence of ``MatrixRow`` or a frame of them.
    """
    frame: Any = pandas.DataFrame(rows)
    others = [name for name in ("material", "shoe_rz", "floor_rz", "speed") if name != along]
    chosen = frame if speed is None else frame[frame.speed == speed]
    groups = chosen.sort_values(along).groupby(others)[quantity]
    with np.errstate(divide="ignore", invalid="ignore"):
        return tuple(float(same.iloc[-1] / same.iloc[0] - 1.0) for _, same in groups)


def series_changes(rows: Sequence[MatrixRow]) -> dict[str, tuple[float, ...]]:
    """Return every change of G.1.2 for the rows of one series, by name."""
    frame: Any = pandas.DataFrame(rows)
    slow = frame.speed.min()
    own = frame[frame.shoe_rz == frame.material.map(OWN_SHOE_RZ)]
    rough, smooth = frame.shoe_rz == SHOE_RZ[1], frame.floor_rz == FLOOR_RZ[0]
    odd = (frame.material == "neolite") & rough & smooth
    found = {}
    for name, (column, *_) in QUANTITIES.items():
        for along in ("shoe_rz", "floor_rz", "speed"):
            speed = None if along == "speed" else slow
            for material, some in frame.groupby("material"):
                found[f"{name}.{along}.{material}"] = changes(some, column, along, speed=speed)
            if along != "shoe_rz":
                found[f"experiment.{name}.{along}"] = changes(own, column, along, speed=speed)
    found["hysteresis.speed.most_pairs"] = changes(frame[~odd], "cof_hysteresis", "speed")
    found["hysteresis.speed.rough_neolite"] = changes(frame[odd], "cof_hysteresis", "speed")
    for name, some, floors in (
        ("own", own, ["floor_rz"]),
        ("same", frame, ["shoe_rz", "floor_rz"]),
    ):
        slowest = some[some.speed == slow]
        cof = slowest.pivot(index=floors, columns="material", values="cof_hysteresis")
        over, under = (cof.rubber, cof.neolite) if name == "own" else (cof.neolite, cof.rubber)
        found[f"hysteresis.material.{name}"] = tuple((over / under - 1.0).tolist())
    return found


def series_quantities(
    series: str, levels: Sequence[tuple[float, Sequence[MatrixRow]]]
) -> dict[str, ComputedQuantity]:
    """Return the quantities of one series from its rows on meshes from coarse to fine."""
    meshes = [(spacing, [row for row in rows if row.series == series]) for spacing, rows in levels]
    if not meshes[-1][1]:
        names = [*series_changes(levels[-1][1]), "hysteresis.largest"]
        return {
            f"{series}.{name}": ComputedQuantity.none("this series was not run") for name in names
        }
    largest = [
        (spacing, float(np.max(np.abs([row.cof_hysteresis for row in rows]))))
        for spacing, rows in meshes
    ]
    found = {f"{series}.hysteresis.largest": ComputedQuantity.of(largest[-1][1], levels=largest)}
    each = [(spacing, series_changes(rows)) for spacing, rows in meshes]
    lossless = largest[-1][1] < LEAST_COF
    for name, values in each[-1][1].items():
        if lossless and "hysteresis" in name:
            text = f"no hysteresis to compare: |COF| at most {largest[-1][1]:.0e}"
            found[f"{series}.{name}"] = ComputedQuantity.none(text)
        else:
            steps = [(spacing, changed[name]) for spacing, changed in each]
            found[f"{series}.{name}"] = ComputedQuantity.of(values, levels=steps)
    return found


def _notes(rows: Sequence[MatrixRow], settings: Settings, before: int) -> list[str]:
    pressures = np.array([row.mean_pressure for row in rows]) * 1e-3
    notes = []
    if np.isfinite(pressures).any():
        kept_height = " (160 kPa at the end of pressing; the height, not the load, is kept)"
        notes.append(
            f"Mean pressure while sliding {np.nanmin(pressures):.0f} to "
            f"{np.nanmax(pressures):.0f} kPa"
            f"{kept_height if settings.control == 'displacement' else ''}."
        )
    said: dict[str, int] = {}
    for row in rows:
        if row.note:
            said[row.note] = said.get(row.note, 0) + 1
    notes += [f"{count} of {len(rows)} cases: {note}." for note, count in said.items()]
    if before:
        notes.append(f"{before} of {len(rows)} cases were kept from an earlier run.")
    lost = sum(math.isnan(row.cof_hysteresis) for row in rows)
    if lost:
        notes.append(f"{lost} of {len(rows)} cases gave no result.")
    return notes


def figures(
    rows: Sequence[MatrixRow], histories: dict[tuple[str, float], History], wavelength: float
) -> dict[str, Figure]:
    """Return Fig. 3, 5 to 8, 10 and 11."""
    frame = pandas.DataFrame(rows)
    drawn = {
        "fig05_hysteresis_roughness": _figure(frame, "hysteresis", "5", "floor_rz"),
        "fig06_hysteresis_speed": _figure(frame, "hysteresis", "6", "speed"),
        "fig07_area_speed": _figure(frame, "area", "7", "speed"),
        "fig08_area_roughness": _figure(frame, "area", "8", "floor_rz"),
        "fig10_area_speed_own": _figure(frame, "area", "10", "speed", own_roughness=True),
        "fig11_area_roughness_own": _figure(frame, "area", "11", "floor_rz", own_roughness=True),
    }
    drawn = {name: figure for name, figure in drawn.items() if figure.panels}
    if histories:
        drawn["fig03_history"] = history_figure(histories, wavelength)
    return drawn


def _figure(
    frame: Any, quantity: str, number: str, along: str, *, own_roughness: bool = False
) -> Figure:
    """Return a panel a series and material: a quantity over speed, or at the lowest speed over the
    floor's roughness; ``own_roughness`` keeps each material's own roughness."""
    column, label, scale = QUANTITIES[quantity]
    slow = frame.speed.min()
    if along == "floor_rz":
        frame = frame[frame.speed == slow]
    panels, left_out = [], []
    for series, material in product(frame.series.unique(), MATERIALS):
        some = frame[(frame.series == series) & (frame.material == material)]
        if own_roughness:
            some = some[some.shoe_rz == OWN_SHOE_RZ[material]]
        largest = some[column].abs().max()
        if quantity == "hysteresis" and largest < LEAST_COF:
            left_out.append(f"{material} {largest:.0e}")
            continue
        # friction of the materials is compared, areas differ tenfold
        highest = scale * (frame if quantity == "hysteresis" else some)[column].max()
        printed = _printed_change(quantity, along, material, own_roughness=own_roughness)
        if along == "floor_rz":
            bars = {
                f"shoe Rz {1e6 * shoe:g} µm": scale * row[column].to_numpy()
                for shoe, row in some.sort_values(along).groupby("shoe_rz")
            }
            layers = grouped_bars(
                bars, colours=("#2e75b6",) if own_roughness else ("#9db8cc", OURS)
            )
            names = [f"{1e6 * floor:g}" for floor in FLOOR_RZ]
            axis: dict[str, Any] = {"x_label": "floor Rz (µm)", "x_ticks": names}
            last = len(FLOOR_RZ) - 0.45
        else:
            layers = [
                line(
                    curve.speed,
                    scale * curve[column],
                    f"floor {1e6 * floor:g}" + ("" if own_roughness else f", shoe {1e6 * shoe:g}"),
                    colour=(SECOND, "#2e75b6", OURS)[FLOOR_RZ.index(floor)],
                    marker="o" if own_roughness else "os"[SHOE_RZ.index(shoe)],
                    style="-" if own_roughness else ("-", "--")[SHOE_RZ.index(shoe)],
                )
                for (shoe, floor), curve in some.sort_values(along).groupby(["shoe_rz", "floor_rz"])
            ]
            axis = {"x_label": "sliding speed (m/s)", "x_limits": (0.0, None)}
            last = 1.04 * frame.speed.max()
        first = scale * some[some[along] == some[along].min()][column].mean()
        if printed is not None:
            low, high = (first * (1.0 + change) for change in printed)
            style = {"low": [low], "high": [high], "colour": PRINTED, "marker": "D"}
            layers.append(points([last], [0.5 * (low + high)], PRINTED_LABEL, **style))
            highest = max(highest, high)
        panels.append(
            Panel(
                layers,
                y_label=label,
                title=f"{SERIES[series]}: {material}",
                y_limits=(0.0, 1.05 * highest if highest > 0.0 else 1.05),
                **axis,
            )
        )
    title = f"Fig. {number}: {label}"
    title += f" at {slow:g} m/s" if along == "floor_rz" else " against speed (Rz in µm)"
    title += ", own shoes" if own_roughness else ""
    if left_out:
        title += "\nreport's parameters not drawn, |COF| at most: " + ", ".join(left_out)
    return Figure(panels, title, columns=2, legend_below=True, size=(4.4, 3.2))


PRINTED_LABEL = "printed change, from our mean at the first place"


def _printed_change(
    quantity: str, along: str, material: str, *, own_roughness: bool
) -> tuple[float, float] | None:
    """Return the printed change (lowest, highest) that a panel's last place stands for."""
    published = Catalogue.load().entry("published", "micro_fe_g1")
    name = {"hysteresis": "hysteresis_cof_change", "area": "contact_area_per_force_change"}[
        quantity
    ]
    if own_roughness and along == "speed":
        key = "experiment.adhesion_change_with_speed"
    elif along == "speed" and quantity == "hysteresis":
        key = f"{name}.speed_up_most_pairs"
    else:
        key = f"{name}.{'speed' if along == 'speed' else 'floor_roughness'}_up_{material}"
    low, high = published.numbers(key, "1")
    return float(low), float(high)


def history_figure(
    histories: dict[tuple[str, float], History], wavelength: float, title: str = FIG_3
) -> Figure:
    """Return area and forces over time, one line a (series, speed), and the mean shear force."""
    panels = []
    for name, label, scale, colour in (
        ("real_contact_area", "Real contact area (mm²)", 1e6, OURS),
        ("normal_force", "Normal force (mN)", 1e3, "#2e75b6"),
        ("shear_force", "Shear force (mN)", 1e3, PRINTED),
    ):
        for (series, speed), history in histories.items():
            time, values = 1e3 * history["time"], scale * history[name]
            layers = [line(time, values, colour=colour)]
            sliding = time[history["distance"] > 0.0]
            if sliding.size:
                layers.append(Layer("limit", sliding[0], style=":", colour="0.6"))
            heading, bottom = "", 0.0
            if name == "real_contact_area":
                heading = f"{SERIES.get(series, series)}, {speed:g} m/s"
            elif name == "shear_force":
                bottom = None
                mean = whole_wavelength_mean(history["distance"], values, wavelength)
                if mean is not None:
                    text = f"mean over whole floor waves {mean:.2f} mN".replace("-0.00", "0.00")
                    layers.append(level(mean, text, colour=colour, style="--"))
            panels.append(Panel(layers, "time (ms)", label, heading, y_limits=(bottom, None)))
    return Figure(panels, title, columns=len(histories), size=(4.6, 2.2))


def whole_wavelength_mean(
    distance: np.ndarray, values: np.ndarray, wavelength: float
) -> float | None:
    """Return the mean over the whole wavelengths after the first (of one: over it), or None."""
    slid = np.flatnonzero(distance > 0.0)
    whole = int(distance[-1] / wavelength * (1.0 + 1e-6)) if slid.size else 0
    if whole < 1:
        return None
    start = wavelength * min(1, whole - 1)
    end = min(wavelength * whole, float(distance[-1]))
    places = np.linspace(start, end, 4001)
    x = np.concatenate([[0.0], distance[slid]])
    y = np.concatenate([values[slid[:1]], values[slid]])
    return float(np.trapezoid(np.interp(places, x, y), places) / (end - start))
