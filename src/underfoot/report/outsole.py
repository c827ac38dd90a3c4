"""An outsole from a file: its measures, what was read and repaired, and its picture."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from underfoot.case import text as toml
from underfoot.core.files import checksum
from underfoot.core.html import data_address, new_figure
from underfoot.core.page import PageSection, Picture, remark_sections, table_sections
from underfoot.core.presentation import Part, Presentable, Table
from underfoot.core.remark import Message
from underfoot.core.unit_text import tread_unit, unit_system
from underfoot.shoe import SoleSurface
from underfoot.shoe.files import FileOutsole, FileSettings
from underfoot.shoe.tread_measures import (
    SHARES,
    TreadMeasures,
    channel_depth,
    draining,
    largest_patch,
    tread_measures,
)

from .dispatch import FigureMakers, figures, files, sections
from .drawn_sole import DrawnSole
from .maps import frame_sole
from .quantities import DrawnQuantity
from .surface_mesh import surface_mesh
from .viewer import listed_quantity, pane, scene, scene_section, viewer_script
from .writing import Writer, data_writers

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_PATCH, _CLOSED = "#e3c16f", "#9a86b8"
_MOST_CELLS = 120_000  # of the sole in three dimensions
_DEPTH = DrawnQuantity("channel_depth", "Depth of the channels", 1e-3, "mm", "YlGnBu_r")
_HEIGHT = DrawnQuantity("height", "Height above the sole plane", 1e-3, "mm", "cividis")
PLAN = (1e-4, "cm^2")
"""Unit of a plan form's area."""
_UNITS = {"area": "_m2", "length": "_m", "width": "_m", "depth": "_m", "circle": "_m"}


@dataclass(frozen=True, slots=True)
class OutsoleInspection(Presentable):
    """An outsole file as it was read, with the measures of its tread."""

    kind: ClassVar[str] = "outsole"

    file: Path
    settings: FileSettings
    outsole: FileOutsole
    measures: TreadMeasures

    def __repr__(self) -> str:
        return f"<OutsoleInspection of {self.file.name!r:.100}: {self.outsole.faces} faces>"

    def heading(self) -> str:
        read = {"format": self.outsole.format, "faces": self.outsole.faces}
        return Message("{file}: {format}, {faces} faces", file=self.file.name, **read)

    def headline(self) -> tuple[Message, ...]:
        m = self.measures
        return (
            Message(
                "{size}, land {land:.0%} of {area}, {count} lugs.",
                size=_lengths(m.length, m.width, digits=4), land=m.land_ratio,
                area=_area(m.plan_area, PLAN), count=m.lug_count,
            ),
        )  # fmt: skip

    def table(self) -> Table:
        def spread_text(values: tuple[float, float, float] | None, unit: str) -> str:
            if values is None:
                return "none"
            factor, name = tread_unit(unit)
            low, middle, high = (f"{value / factor:.3g}" for value in values)
            return Message(
                "{middle} {unit}  (10 to 90 %: {low} to {high})",
                middle=middle, unit=name.replace("^2", "²"), low=low, high=high,
            )  # fmt: skip

        m = self.measures
        drained, draft = m.drained_share, self.outsole.draft
        rows = [
            ("Length x width", _lengths(m.length, m.width, digits=4)),
            ("Plan area", _area(m.plan_area, PLAN)),
            ("Land", Message("{land:.0%} of the plan area", land=m.land_ratio)),
            ("Channel depth, median", spread_text(m.channel_depth, "m")),
            ("Channel width, median", spread_text(m.channel_width, "m")),
            ("Draft of the walls", "none" if draft is None else f"{np.degrees(draft):.1f}°"),
            (
                "Channels open to the rim",
                "none" if drained is None else Message("{share:.0%} of area", share=drained),
            ),
            ("Sipes", _sipes(m)),
            ("Lugs", f"{m.lug_count}"),
            ("Lug area, median", spread_text(m.lug_area, "m^2")),
            ("Largest untreaded patch", _area(m.patch_area, tread_unit("m^2"))),
            (Part("length x width"), _lengths(m.patch_length, m.patch_width)),
            (Part("largest circle in it"), _lengths(m.patch_circle)),
            ("Largest circle without channel", _lengths(m.free_circle)),
        ]
        thickness = self.outsole.thickness
        if thickness is not None:
            rows.append(("Thickness over the land, median", _lengths(thickness)))
        return Table("Tread", ("Measure", "Value"), rows)

    def remarks(self) -> dict[str, Sequence[str]]:
        return {"Determined, assumed and repaired": self.outsole.surface.remarks}

    def to_dict(self) -> dict[str, Any]:
        outsole = self.outsole
        return {
            "file": str(self.file),
            "file_format": outsole.format,
            "faces": outsole.faces,
            "unit_m": outsole.unit,
            "down": outsole.down,
            "forward": outsole.forward,
            "foot": outsole.foot or None,
            "whole_length": outsole.whole_length,
            "thickness": outsole.thickness,
            "draft": outsole.draft,
            "mesh": asdict(outsole.soundness),
            "measures": asdict(self.measures),
            "remarks": list(outsole.surface.remarks),
        }

    def data_tables(self) -> dict[str, Table]:
        rows: list[tuple[str, Any]] = []
        for name, value in asdict(self.measures).items():
            unit = next((_UNITS[end] for end in _UNITS if name.endswith(end)), "")
            if isinstance(value, tuple):
                shares = zip(SHARES, value, strict=True)
                rows += [(f"{name}_{share}pct{unit}", each) for share, each in shares]
            else:
                rows.append((f"{name}{unit}", value))
        return {"measures": Table("", ("measure", "value"), rows)}

    def write_heights(self, path: Path) -> None:
        """Write the height map as compressed CSV, rows from the heel to the toe, in mm."""
        surface = self.outsole.surface
        header = (
            "height above the sole plane (mm), nan outside; rows: x from the heel, columns: y from "
            f"right to left seen from above, spacing {surface.spacing * 1e3:g} mm; first row x = "
            f"{surface.x[0] * 1e3:g} mm, first column y = {surface.y[0] * 1e3:g} mm"
        )
        # np.savetxt compresses by the ending
        np.savetxt(path, surface.height * 1e3, fmt="%.4f", delimiter=",", header=header)


def _sipes(measures: TreadMeasures) -> str:
    """Return how many sipes there are and what a run makes of them."""
    if measures.sipe_count == 0:
        return "none"
    return Message(
        "{count}, {length} in all; computed as slits where finer than two cells",
        count=measures.sipe_count, length=_lengths(measures.sipe_length),
    )  # fmt: skip


def _lengths(*values: float, digits: int = 3) -> str:
    """Return lengths (m) in the unit of treads, "290 x 100 mm"."""
    factor, name = tread_unit("m")
    return f"{' x '.join(f'{value / factor:.{digits}g}' for value in values)} {name}"


def _area(area: float, metric: tuple[float, str]) -> str:
    """Return an area (m^2) in a metric unit (factor, name), or in square inches."""
    factor, name = metric if unit_system() == "si" else tread_unit("m^2")
    return f"{area / factor:.4g} {name.replace('^2', '²')}"


def inspect_outsole(file: Path, settings: FileSettings) -> OutsoleInspection:
    """Return an outsole file as it is read with ``settings``, with the measures of its tread."""
    from underfoot.shoe.files import outsole_from_file

    outsole = outsole_from_file(file, settings)
    measures = tread_measures(outsole.surface, outsole.edges)
    return OutsoleInspection(file, settings, outsole, measures)


@figures.register(OutsoleInspection)
def _figures(inspection: OutsoleInspection) -> FigureMakers:
    return {"outsole": partial(outsole_figure, inspection.outsole.surface, inspection.measures)}


@sections.register(OutsoleInspection)
def _sections(
    inspection: OutsoleInspection, pictures: dict[str, bytes]
) -> tuple[Sequence[PageSection], str]:
    drawn = [Picture(name, data_address(data), True) for name, data in pictures.items()]
    return [
        PageSection("The sole in three dimensions", html=scene_section(outsole_scene(inspection))),
        PageSection("Tread, seen from below", pictures=drawn),
        *table_sections(inspection),
        *remark_sections(inspection),
    ], viewer_script()


def outsole_scene(inspection: OutsoleInspection) -> dict[str, Any]:
    """Return the data of the viewer: the sole as it was read, coloured by height and depth."""
    surface = inspection.outsole.surface
    every = math.ceil(math.sqrt(surface.height.size / _MOST_CELLS))
    thinned = (slice(None, None, every), slice(None, None, every))
    height, land = surface.height[thinned], surface.land[thinned]
    everywhere = (slice(0, height.shape[0]), slice(0, height.shape[1]))
    sole = DrawnSole(
        surface.x[::every], surface.y[::every], every * surface.spacing, height, None, land,
        everywhere, everywhere,
    )  # fmt: skip
    depth = np.where(land, np.nan, channel_depth(surface)[thinned])
    coloured = {_DEPTH: depth / 1e-3, _HEIGHT: height / 1e-3}
    shown = pane(
        surface.name,
        sole,
        {quantity.name: values for quantity, values in coloured.items()},
        surface_mesh(surface.x, surface.y, surface.height, surface.land),
        histories={},
    )
    return scene([shown], [listed_quantity(q, [values]) for q, values in coloured.items()])


@files.register(OutsoleInspection)
def _files(inspection: OutsoleInspection) -> dict[str, Writer]:
    return data_writers(inspection) | {"heights.csv.gz": inspection.write_heights}


def outsole_figure(surface: SoleSurface, measures: TreadMeasures) -> Figure:
    """Return height, channel depth and parts of the tread beside each other, as seen from below.

    The heel is at the bottom and the toe at the top, like all maps of results.
    """
    tall = float(np.clip(4.0 * surface.length / max(surface.width, 1e-6), 4.5, 10.0))
    figure = new_figure(12.5, tall)
    heights, depths, parts = figure.subplots(1, 3)
    millimetres = surface.height * 1e3
    shown = millimetres[surface.inside]
    high = max(float(shown.max()), float(shown.min()) + 0.1)
    depth = channel_depth(surface) * 1e3
    deepest = max(float(np.nanmax(depth)), 0.1)
    depth = np.where(surface.land | ~surface.inside, np.nan, depth)
    for axes, values, colours, low, top, title in (
        (heights, millimetres, "viridis", shown.min(), high, "Height above the sole plane"),
        (depths, depth, "Blues", 0.0, deepest, "Depth of the channels"),
    ):
        image = _field(axes, surface, values, colours, low, top)
        bar = figure.colorbar(image, ax=axes, fraction=0.05, pad=0.03)
        bar.ax.set_title("mm", fontsize="small")
        axes.set_title(title)
    _parts(parts, surface, measures)
    for axes in (heights, depths, parts):
        rim = surface.outline * 1e3
        axes.plot(rim[:, 1], rim[:, 0], color="0.25", linewidth=1.0)
        frame_sole(axes, surface.x * 1e3, surface.y * 1e3, surface.inside)
        axes.set(xticks=[], yticks=[])
    figure.suptitle(Message("{name}, seen from below", name=surface.name), fontsize="large")
    return figure


def _field(
    axes: Axes, surface: SoleSurface, values: np.ndarray, colours: Any, low: float, high: float
) -> Any:
    scale: dict[str, Any] = {"cmap": colours, "vmin": low, "vmax": high, "shading": "nearest"}
    shown = np.ma.masked_invalid(values)
    return axes.pcolormesh(surface.y * 1e3, surface.x * 1e3, shown, rasterized=True, **scale)


def _parts(axes: Axes, surface: SoleSurface, measures: TreadMeasures) -> None:
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    channel = surface.inside & ~surface.land
    kinds = {
        "land": ("0.72", surface.land),
        "channels open to the rim": ("#dfeaf3", channel),
        "closed channels": (_CLOSED, channel & ~draining(surface.inside, channel)),
        Message("largest untreaded patch, {area:.3g} mm²", area=measures.patch_area * 1e6): (
            _PATCH,
            largest_patch(surface),
        ),
    }
    parts = np.full(surface.height.shape, np.nan)
    for number, (_, where) in enumerate(kinds.values()):
        parts[where] = number
    _field(axes, surface, parts, ListedColormap([c for c, _ in kinds.values()]), -0.5, 3.5)
    handles = [
        Patch(facecolor=colour, edgecolor="0.5", linewidth=0.5, label=name)
        for number, (name, (colour, _)) in enumerate(kinds.items())
        if (parts == number).any()
    ]
    style: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, 0.0)}
    axes.legend(handles=handles, frameon=False, fontsize=8, **style)
    axes.set_title(Message("Land {share:.0%} of the plan form", share=measures.land_ratio))


_CASE = """\
name = {name}

[shoe]
from = "work_shoe_half_tread"   # stands in for what is not given below

[shoe.material]
shore_a = "62 A"                # set your own; "40 Shore D" and "55 Asker C" are converted
# modulus = "5 MPa"             # measured in compression: goes before the hardness
# [shoe.roughness]              # of the outsole's surface, from a profilometer; without it drawn
# rq = "8 um"

[shoe.outsole]
file = {file}
sha256 = "{sha256}"
{settings}

[shoe.sole]
outsole_thickness = {thickness}

[shoe.sole.midsole]             # assumed, a file of an outsole holds none: foam; set your own
modulus = "2 MPa"
thickness = "15 mm"

# [shoe.wear]                   # how far it is worn: ground off at one angle
# depth = "1 mm"
# angle = "7 deg"

[floor]
from = "vinyl_g4"               # others: underfoot catalogue floor

[contaminant]
from = "glycerol_90pct"         # others: underfoot catalogue fluid
# viscosity = "100 cP"

[motion]
from = "slip_tester_g4"         # others: underfoot catalogue setup
# normal_force = "500 N"
# speed = "0.3 m/s"
# shoe_angle = "7 deg"          # toe up
"""


def case_text(inspection: OutsoleInspection, out: Path) -> str:
    """Return a case file for the folder ``out`` that uses the outsole with the same settings."""
    file, settings, plain = inspection.file, inspection.settings, FileSettings()
    lines = []
    for name in ("unit", "down", "forward", "foot", "region"):
        value = getattr(settings, name)
        mark = "" if value != getattr(plain, name) else "# "
        lines.append(f'{mark}{name} = "{value}"')
    for name in ("mirror", "cut_floor"):
        if getattr(settings, name):
            lines.append(f"{name} = true")
    if settings.solid is not None:
        lines.append(f"solid = {json.dumps(settings.solid, ensure_ascii=False)}")
    if settings.side != plain.side:
        lines.append(f'side = "{settings.side}"')
    if settings.region_length is not None:
        lines.append(f'region_length = "{settings.region_length * 1e3:g} mm"')
    if settings.spacing != plain.spacing:
        lines.append(f'map_spacing = "{settings.spacing * 1e3:g} mm"')
    path = Path(os.path.relpath(file.resolve(), out.resolve())).as_posix()
    thickness = inspection.outsole.thickness
    return _CASE.format(
        name=json.dumps(file.stem, ensure_ascii=False),
        file=json.dumps(path, ensure_ascii=False),
        sha256=checksum(file),
        settings="\n".join(lines),
        thickness='"15 mm"  # not in the file: set your own'
        if thickness is None
        else f'"{thickness * 1e3:.3g} mm"  # with the lugs, as in the file',
    )


def case_shoe(inspection: OutsoleInspection, out: Path) -> dict[str, Any]:
    """Return the shoe of ``case_text`` as plain data: what a case takes from a file."""
    return dict(toml.parse_toml(case_text(inspection, out))["shoe"])
