"""Report G.1: the micro finite-element model's matrix, condensed or by explicit finite elements."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from underfoot.core import InputError, Status, content_hash, unknown_name

from .figure import (
    OURS,
    PRINTED,
    SECOND,
    Figure,
    Layer,
    Panel,
    grouped_bars,
    line,
    names_as_ticks,
)
from .runner import Computed, Options, Table, kept, number_kept
from .verdict import Quantity

if TYPE_CHECKING:
    from underfoot.block.condensed import CondensedBlock
    from underfoot.block.explicit import (
        MicroBlock,
        MicroLoading,
        MicroMaterial,
        MicroResult,
        MicroSurface,
    )

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
QUANTITIES = {"hysteresis": "cof_hysteresis", "area": "area_per_force"}


@dataclass(frozen=True, slots=True)
class Settings:
    """How the matrix is run.

    Parameters
    ----------
    series
        "report", "broad" or both.
    solver
        "condensed" or "explicit".
    control
        "displacement" (the report's: height kept while sliding) or "load".
    bulk_modulus
        "corrected" (from Poisson's ratio 0.499) or "printed" (Table 2).
    shoe_wavelength, floor_wavelength
        m.
    speeds
        m/s.
    slide_distance
        m; the floor is 2.125 mm long, which leaves 1.3 mm.
    steps_per_wavelength
        Of the condensed solver.
    elements
        Of the block.
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
class Case:
    """One cell of the matrix; lengths in m, speed in m/s."""

    series: str
    material: str
    shoe_rz: float
    floor_rz: float
    speed: float


@dataclass(frozen=True, slots=True)
class Row:
    """One cell of the matrix with its averages over whole floor wavelengths (Eq. 8 to 12).

    ``area_per_force`` in m^2/N, ``mean_pressure`` in Pa, ``seconds`` of process time; NaN where
    the run gave no result (then ``status`` and ``note`` say why).
    """

    series: str
    material: str
    shoe_rz: float
    floor_rz: float
    speed: float
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
    levels: list[tuple[float, list[Row]]] = []
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
        place = {case: i for i, case in enumerate(cases)}
        rows.sort(key=lambda r: place[Case(r.series, r.material, r.shoe_rz, r.floor_rz, r.speed)])
        levels.append((BLOCK_LENGTH / mesh.elements[0], rows))
    rows = levels[-1][1]
    quantities: dict[str, Quantity] = {}
    for name in SERIES:
        quantities |= series_quantities(name, levels)
    columns = tuple(field.name for field in fields(Row))
    table = Table(
        "cases",
        "Averages over whole floor wavelengths, SI units",
        columns,
        tuple(tuple(_cell(getattr(row, c)) for c in columns) for row in rows),
    )
    return Computed(
        quantities,
        (table,),
        figures(rows, histories, settings.floor_wavelength),
        (),
        _notes(rows, settings, before),
    )


def matrix(settings: Settings) -> Iterator[Case]:
    """Yield every case; those that share a block follow one another."""
    for shoe in SHOE_RZ:
        for series in settings.series:
            for material in MATERIALS:
                for floor in FLOOR_RZ:
                    for speed in settings.speeds:
                        yield Case(series, material, shoe, floor, speed)


def material_of(case: Case, bulk: str = "corrected") -> MicroMaterial:
    """Return the rubber of a case; density assumed."""
    from underfoot.block.explicit import MicroMaterial
    from underfoot.material import (
        RelaxationSpectrum,
        bulk_modulus,
        power_law_spectrum,
        report_elastomer,
        shear_from_young,
        youngs_modulus_from_shear,
    )

    if case.series == "report":
        young = report_elastomer(case.material).modulus
        assert isinstance(young, RelaxationSpectrum)
        shear = shear_from_young(young, POISSON_RATIO)
    else:
        shear = power_law_spectrum(*BROAD[case.material], terms_per_decade=2)
    if bulk == "printed":
        k = PRINTED_BULK_MODULUS[case.material]
    else:
        relaxed = youngs_modulus_from_shear(shear.equilibrium_modulus, POISSON_RATIO)
        k = float(bulk_modulus(relaxed, POISSON_RATIO))
    return MicroMaterial(shear, k, name=case.material, source=shear.source)


def parts_of(
    case: Case, settings: Settings
) -> tuple[MicroBlock, MicroSurface, MicroMaterial, MicroLoading]:
    """Return block, floor, material and loading of a case."""
    from underfoot.block.explicit import MicroBlock, MicroLoading, MicroSurface

    rough = MicroSurface.checkerboard(case.shoe_rz, settings.shoe_wavelength)
    return (
        MicroBlock(elements=settings.elements, roughness=rough),
        MicroSurface.checkerboard(case.floor_rz, settings.floor_wavelength),
        material_of(case, settings.bulk_modulus),
        MicroLoading(
            speed=case.speed,
            slide_distance=settings.slide_distance,
            control=settings.control,
            hold_time=HOLD_TIME[settings.solver],
        ),
    )


def outcomes(
    cases: Sequence[Case], settings: Settings, processes: int | None = 1
) -> Iterator[tuple[Row, History]]:
    """Yield row and history of every case; explicit ones in the order in which they end."""
    if settings.solver == "explicit":
        items = [(case, settings) for case in cases]
        keys = [_key(case, settings) for case in cases]
        for _, arrays in kept(ROOM, explicit_outcome, items, keys, processes=processes):
            yield Row(**json.loads(str(arrays.pop("row")))), arrays
        return
    block: CondensedBlock | None = None
    last: tuple[float, float] | None = None
    for case in cases:
        from underfoot.block.condensed import (
            condensed_block,
            condensed_poisson_ratio,
            condensed_sliding,
        )

        shape, floor, material, loading = parts_of(case, settings)
        key = (case.shoe_rz, round(condensed_poisson_ratio(material), 9))
        if block is None or key != last:
            block, last = condensed_block(shape, condensed_poisson_ratio(material)), key
        result = condensed_sliding(
            block, floor, material, loading, steps_per_wavelength=settings.steps_per_wavelength
        )
        yield row_of(case, result), {name: getattr(result, name) for name in HISTORY}


def explicit_outcome(item: tuple[Case, Settings]) -> dict[str, np.ndarray]:
    """Return one case by explicit finite elements, mass scaled within its error bounds."""
    from underfoot.block.explicit import ExplicitSettings, explicit_sliding

    result = explicit_sliding(*parts_of(*item), ExplicitSettings(mass_scaling="auto"))
    row = np.array(json.dumps(asdict(row_of(item[0], result))))
    return {"row": row, **{name: getattr(result, name) for name in HISTORY}}


def row_of(case: Case, result: MicroResult) -> Row:
    """Return the averages of a case as one row."""
    averages = result.averages if result.status.usable else None
    names = [field.name for field in fields(Row)][5:12]
    values = [math.nan if averages is None else float(getattr(averages, n)) for n in names]
    status = result.status
    if averages is None and status.usable:
        status = Status.NOT_CONVERGED
    note = "; ".join((*result.notes, *(str(breach) for breach in result.breaches)))
    seconds = result.process_seconds
    return Row(*asdict(case).values(), *values, status=str(status), note=note, seconds=seconds)


def kept_cases(settings: Settings, cases: Sequence[Case]) -> int:
    """Return how many of the explicit cases an earlier run has left."""
    if settings.solver != "explicit":
        return 0
    return number_kept(ROOM, [_key(case, settings) for case in cases])


def _key(case: Case, settings: Settings) -> str:
    # What other cases are run changes nothing in this one.
    alone = replace(settings, series=(case.series,), speeds=(0.0, case.speed))
    return content_hash(case, alone, _source())


@cache
def _source() -> str:
    """Return a hash of the program text that the explicit numbers come from."""
    import underfoot.block

    files = sorted(Path(str(underfoot.block.__file__)).parent.rglob("*.py"))
    return content_hash(*[path.read_text(encoding="utf-8") for path in (*files, Path(__file__))])


def changes(
    rows: Sequence[Row], quantity: str, along: str, *, speed: float | None = None
) -> tuple[float, ...]:
    """Return the relative change of ``quantity`` from the lowest to the highest of ``along``.

    One value for each combination of the other conditions; ``speed`` keeps one speed only.
    """
    others = [name for name in ("material", "shoe_rz", "floor_rz", "speed") if name != along]
    chosen = [row for row in rows if speed is None or row.speed == speed]
    found = []
    for key in sorted({tuple(getattr(row, name) for name in others) for row in chosen}):
        same = [row for row in chosen if tuple(getattr(row, name) for name in others) == key]
        same.sort(key=lambda row: getattr(row, along))
        first, last = (np.float64(getattr(same[i], quantity)) for i in (0, -1))
        with np.errstate(divide="ignore", invalid="ignore"):
            found.append(float(last / first - 1.0))
    return tuple(found)


def series_changes(rows: Sequence[Row]) -> dict[str, tuple[float, ...]]:
    """Return every change of G.1.2 for the rows of one series, by name."""
    slow = min(row.speed for row in rows)
    own = [row for row in rows if row.shoe_rz == OWN_SHOE_RZ[row.material]]
    odd = [
        row
        for row in rows
        if (row.material, row.shoe_rz, row.floor_rz) == ("neolite", SHOE_RZ[1], FLOOR_RZ[0])
    ]
    found = {}
    for name, attribute in QUANTITIES.items():
        for along in ("shoe_rz", "floor_rz", "speed"):
            speed = None if along == "speed" else slow
            for material in MATERIALS:
                some = [row for row in rows if row.material == material]
                found[f"{name}.{along}.{material}"] = changes(some, attribute, along, speed=speed)
            found[f"experiment.{name}.{along}"] = (
                () if along == "shoe_rz" else changes(own, attribute, along, speed=speed)
            )
    rest = [row for row in rows if row not in odd]
    found["hysteresis.speed.most_pairs"] = changes(rest, "cof_hysteresis", "speed")
    found["hysteresis.speed.rough_neolite"] = changes(odd, "cof_hysteresis", "speed")
    found["hysteresis.material.own"] = _ratios(own, slow)
    found["hysteresis.material.same"] = tuple(
        1.0 / (1.0 + value) - 1.0
        for shoe in SHOE_RZ
        for value in _ratios([row for row in rows if row.shoe_rz == shoe], slow)
    )
    return {name: values for name, values in found.items() if values}


def _ratios(rows: Sequence[Row], speed: float) -> tuple[float, ...]:
    """Return rubber over neolite less one, for each floor, in hysteresis COF."""
    found = []
    for floor in FLOOR_RZ:
        cof = {
            row.material: np.float64(row.cof_hysteresis)
            for row in rows
            if row.floor_rz == floor and row.speed == speed
        }
        with np.errstate(divide="ignore", invalid="ignore"):
            found.append(float(cof["rubber"] / cof["neolite"] - 1.0))
    return tuple(found)


def series_quantities(
    series: str, levels: Sequence[tuple[float, Sequence[Row]]]
) -> dict[str, Quantity]:
    """Return the quantities of one series from its rows on meshes from coarse to fine."""
    meshes = [(spacing, [row for row in rows if row.series == series]) for spacing, rows in levels]
    if not meshes[-1][1]:
        names = [*series_changes(levels[-1][1]), "hysteresis.largest"]
        return {f"{series}.{name}": Quantity.none("this series was not run") for name in names}
    largest = [
        (spacing, float(np.max(np.abs([row.cof_hysteresis for row in rows]))))
        for spacing, rows in meshes
    ]
    found = {f"{series}.hysteresis.largest": Quantity.of(largest[-1][1], levels=largest)}
    each = [(spacing, series_changes(rows)) for spacing, rows in meshes]
    lossless = largest[-1][1] < LEAST_COF
    for name, values in each[-1][1].items():
        if lossless and "hysteresis" in name:
            text = f"no hysteresis to compare: |COF| at most {largest[-1][1]:.0e}"
            found[f"{series}.{name}"] = Quantity.none(text)
        else:
            steps = [(spacing, changed[name]) for spacing, changed in each]
            found[f"{series}.{name}"] = Quantity.of(values, levels=steps)
    return found


def _notes(rows: Sequence[Row], settings: Settings, before: int) -> tuple[str, ...]:
    pressures = np.array([row.mean_pressure for row in rows]) * 1e-3
    notes = []
    if np.isfinite(pressures).any():
        notes.append(
            f"Mean pressure while sliding {np.nanmin(pressures):.0f} to "
            f"{np.nanmax(pressures):.0f} kPa"
            + (
                " (160 kPa at the end of pressing; the height, not the load, is kept)."
                if settings.control == "displacement"
                else "."
            )
        )
    if before:
        notes.append(f"{before} of {len(rows)} cases were kept from an earlier run.")
    lost = sum(row.cof_hysteresis != row.cof_hysteresis for row in rows)
    if lost:
        notes.append(f"{lost} of {len(rows)} cases gave no result.")
    return tuple(notes)


def _cell(value: str | float) -> str | float | None:
    return None if value != value else value


def figures(
    rows: Sequence[Row], histories: dict[tuple[str, float], History], wavelength: float
) -> dict[str, Figure]:
    """Return Fig. 3, 5 to 8, 10 and 11."""
    drawn = {
        "fig05_hysteresis_roughness": _roughness_figure(rows, "hysteresis", "5"),
        "fig06_hysteresis_speed": _speed_figure(rows, "hysteresis", "6"),
        "fig07_area_speed": _speed_figure(rows, "area", "7"),
        "fig08_area_roughness": _roughness_figure(rows, "area", "8"),
        "fig10_area_speed_own": _speed_figure(rows, "area", "10", own=True),
        "fig11_area_roughness_own": _roughness_figure(rows, "area", "11", own=True),
    }
    if histories:
        drawn["fig03_history"] = history_figure(histories, wavelength)
    return drawn


LABELS = {"hysteresis": "hysteresis COF", "area": "$A_c / F_N$ (mm²/N)"}
SCALES = {"hysteresis": 1.0, "area": 1e6}


def _some(rows: Sequence[Row], own: bool) -> Iterator[tuple[str, str, list[Row]]]:
    for series in dict.fromkeys(row.series for row in rows):
        for material in MATERIALS:
            some = [row for row in rows if (row.series, row.material) == (series, material)]
            if own:
                some = [row for row in some if row.shoe_rz == OWN_SHOE_RZ[material]]
            yield series, material, some


def _panel(
    layers: tuple[Layer, ...],
    some: Sequence[Row],
    quantity: str,
    series: str,
    material: str,
    highest: float,
    **axes,
) -> Panel:
    largest = max(abs(getattr(row, QUANTITIES[quantity])) for row in some)
    nothing = quantity == "hysteresis" and largest < LEAST_COF
    return Panel(
        () if nothing else layers,
        y_label=LABELS[quantity],
        title=f"{SERIES[series]}: {material}",
        y_limits=(0.0, 1.05 * highest),
        legend="" if nothing else "best",
        note=f"no hysteresis friction:\n|COF| at most {largest:.0e}" if nothing else "",
        **axes,
    )


def _highest(rows: Sequence[Row], quantity: str, some: Sequence[Row]) -> float:
    """Return the top of the axis: friction of the materials is compared, areas differ tenfold."""
    over = rows if quantity == "hysteresis" else some
    values = [getattr(row, QUANTITIES[quantity]) * SCALES[quantity] for row in over]
    return max([value for value in values if value == value], default=0.0) or 1.0


def _roughness_figure(
    rows: Sequence[Row], quantity: str, number: str, *, own: bool = False
) -> Figure:
    slow = min(row.speed for row in rows)
    rows = [row for row in rows if row.speed == slow]
    panels = []
    for series, material, some in _some(rows, own):
        shoes = sorted({row.shoe_rz for row in some})
        bars = {
            f"shoe Rz {1e6 * shoe:g} µm": [
                getattr(row, QUANTITIES[quantity]) * SCALES[quantity]
                for row in sorted(some, key=lambda row: row.floor_rz)
                if row.shoe_rz == shoe
            ]
            for shoe in shoes
        }
        layers = grouped_bars(bars, colours=("#9db8cc", OURS) if len(shoes) > 1 else ("#2e75b6",))
        ticks = names_as_ticks([f"{1e6 * floor:g}" for floor in FLOOR_RZ])
        panels.append(
            _panel(
                layers,
                some,
                quantity,
                series,
                material,
                _highest(rows, quantity, some),
                x_label="floor Rz (µm)",
                x_ticks=ticks,
            )
        )
    title = f"Fig. {number}: {LABELS[quantity]} at {slow:g} m/s" + (", own shoes" if own else "")
    return Figure(tuple(panels), title, columns=2)


def _speed_figure(rows: Sequence[Row], quantity: str, number: str, *, own: bool = False) -> Figure:
    panels = []
    for series, material, some in _some(rows, own):
        layers = []
        for j, shoe in enumerate(sorted({row.shoe_rz for row in some})):
            for i, floor in enumerate(FLOOR_RZ):
                curve = sorted(
                    (row for row in some if (row.shoe_rz, row.floor_rz) == (shoe, floor)),
                    key=lambda row: row.speed,
                )
                shoes = "" if own else f", shoe {1e6 * shoe:g}"
                layers.append(
                    line(
                        [row.speed for row in curve],
                        [getattr(row, QUANTITIES[quantity]) * SCALES[quantity] for row in curve],
                        f"floor {1e6 * floor:g}{shoes}",
                        colour=(SECOND, "#2e75b6", OURS)[i],
                        marker="os"[j],
                        style=("-", "--")[j],
                    )
                )
        panels.append(
            _panel(
                tuple(layers),
                some,
                quantity,
                series,
                material,
                _highest(rows, quantity, some),
                x_label="sliding speed (m/s)",
                x_limits=(0.0, None),
            )
        )
    title = f"Fig. {number}: {LABELS[quantity]} against speed (Rz in µm)"
    return Figure(tuple(panels), title, columns=2, legend_below=True, size=(4.4, 3.2))


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
                layers.append(Layer("limit", [float(sliding[0])], style=":", colour="0.6"))
            mean = (
                whole_wavelength_mean(history["distance"], values, wavelength)
                if name == "shear_force"
                else None
            )
            if mean is not None:
                text = f"mean over whole floor waves {mean:.2f} mN".replace("-0.00", "0.00")
                layers.append(Layer("level", (), [mean], label=text, colour=colour, style="--"))
            heading = (
                f"{SERIES.get(series, series)}, {speed:g} m/s"
                if name == "real_contact_area"
                else ""
            )
            bottom = None if name == "shear_force" else 0.0
            panels.append(
                Panel(tuple(layers), "time (ms)", label, heading, y_limits=(bottom, None))
            )
    return Figure(
        tuple(panels),
        title,
        columns=len(histories),
        size=(4.6, 2.2),
    )


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
