"""What a figure of Matplotlib holds, as plain data: every line, area, picture and text of it."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axes._secondary_axes import SecondaryAxis
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm, to_hex, to_rgba
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import FixedLocator, NullLocator

from snapshot import MOST, snapshot_lines


def figure_lines(figure: Figure | SubFigure) -> dict[str, Any]:
    """Return the size and texts of a figure, and what each of its axes holds."""
    over = {
        name: getattr(figure, f"get_{name}")() for name in ("suptitle", "supxlabel", "supylabel")
    }
    parts = getattr(figure, "subfigs", [])
    inner = {axes for part in parts for axes in part.axes}
    own = [axes for axes in figure.axes if axes not in inner]
    size = {"size": _row(figure.get_size_inches())} if isinstance(figure, Figure) else {}
    return (
        size
        | {name: text for name, text in over.items() if text}
        | {f"legend {k}": _legend(one) for k, one in enumerate(figure.legends)}
        | {f"axes {k}": _axes(axes) for k, axes in enumerate(own)}
        | {f"part {k}": figure_lines(part) for k, part in enumerate(parts)}
    )


def _row(values: Any) -> str:
    """Return numbers, without the noise of a sum that is zero, and names as they are."""
    if np.asarray(values).dtype.kind in "US":
        return " ".join(dict.fromkeys(map(str, values)))
    values = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan)
    known = values[np.isfinite(values)]
    least = 1e-9 * float(np.abs(known).max(initial=0.0))
    values = np.where(np.abs(values) < least, 0.0, values) + 0.0
    if values.size > MOST:
        return snapshot_lines(values).strip()
    return " ".join(f"{one:.6g}" for one in values.ravel())


def _colours(colours: Any) -> str:
    rows = np.atleast_2d(np.asarray(colours, float))[:8]
    shown = (to_hex(one) + (f"/{one[3]:.3g}" if one[3] < 1 else "") for one in rows)
    return " ".join(dict.fromkeys(shown))


def _colour(colour: Any) -> str:
    return "none" if isinstance(colour, str) and colour == "none" else _colours(to_rgba(colour))


def _told(**parts: Any) -> str:
    """Return what is stated of an artist in one line."""
    usual = {None: "", False: ""}
    shown = {
        k: usual.get(v, v) if not isinstance(v, float) else f"{v:.4g}" for k, v in parts.items()
    }
    return " ".join(f"{name}={value}" for name, value in shown.items() if str(value))


def _axes(axes: Axes) -> dict[str, Any]:
    if isinstance(axes, SecondaryAxis):
        labels = axes.get_xticklabels()
        names = " | ".join(one.get_text() for one in labels)
        sizes = [axes.xaxis.label.get_fontsize(), labels[0].get_fontsize()]
        return {"ticks": _row(axes.get_xticks()), "names": names, "label": axes.get_xlabel(),
                "sizes": _row(sizes)}  # fmt: skip
    left, bar = axes.get_title("left"), getattr(axes, "_colorbar", None)
    title = axes._left_title if left else axes.title
    told: dict[str, Any] = {
        "title": _told(title=title.get_text(), size=title.get_fontsize(), left=bool(left)),
        "labels": f"{axes.get_xlabel()} | {axes.get_ylabel()} {axes.xaxis.label.get_fontsize():g}",
    }
    if place := axes.get_subplotspec():
        grid: Any = place.get_gridspec()
        ratios = [_row(one) for one in (grid.get_width_ratios(), grid.get_height_ratios())]
        told["place"] = f"{place.num1} to {place.num2} of {grid.nrows} x {grid.ncols}, {ratios}"
    if bar:  # its steps and frame are those of the library
        limits = _row([bar.vmin, bar.vmax])
        return told | {"bar": _told(extend=bar.extend, map=bar.cmap.name, limits=limits)}
    limits = [*axes.get_xlim(), *axes.get_ylim()]
    spines = [name for name, one in axes.spines.items() if one.get_visible()]
    told["axes"] = _told(
        scale=f"{axes.get_xscale()} {axes.get_yscale()}", limits=_row(limits),
        aspect=axes.get_aspect() if axes.get_aspect() != "auto" else "",
        box=axes.get_box_aspect(), hidden=not axes.get_visible(), off=not axes.axison,
        spines="all" if len(spines) == 4 else ",".join(spines) or "none",
        face=_colour(axes.get_facecolor()),
    )  # fmt: skip
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        if isinstance(axis.get_major_locator(), FixedLocator):
            labels = axis.get_ticklabels() if axis.get_majorticklocs().size else []
            style = [(one.get_fontsize(), one.get_rotation(), one.get_ha()) for one in labels[:1]]
            told[f"ticks {name}"] = (
                f"{_row(axis.get_majorticklocs())}: {' | '.join(one.get_text() for one in labels)} "
                f"{style} {isinstance(axis.get_minor_locator(), NullLocator)}"
            )
    for k, line in enumerate(axes.lines):
        edge = [line.get_linewidth(), line.get_markersize(), line.get_markeredgewidth()]
        told[f"line {k}"] = _told(
            x=_row(line.get_xdata()), y=_row(line.get_ydata()), style=line.get_linestyle(),
            marker=line.get_marker(), sizes=_row(edge), colour=_colour(line.get_color()),
            inner=_colour(line.get_markerfacecolor()), label=_label(line), z=line.get_zorder(),
            alpha=line.get_alpha(),
        )  # fmt: skip
    for k, each in enumerate(axes.collections):
        told[f"area {k}"] = _collection(each)
    for k, each in enumerate(axes.patches):
        path = each.get_patch_transform().transform_path(each.get_path())
        told[f"patch {k}"] = _told(
            at=_row(path.vertices), colour=_colours(each.get_facecolor()), fill=each.get_fill(),
            edge=_colours(each.get_edgecolor()), width=each.get_linewidth(), label=_label(each),
            alpha=each.get_alpha(), z=each.get_zorder(),
        )  # fmt: skip
    for k, each in enumerate(axes.images):
        told[f"image {k}"] = _told(
            values=_row(each.get_array()), at=_row(each.get_extent()), scale=_scale(each),
            masked=int(np.ma.count_masked(np.ma.asarray(each.get_array()))),
            origin=each.origin, between=each.get_interpolation(),
        )  # fmt: skip
    for k, each in enumerate(axes.texts):
        frame = each.get_transform()
        told[f"text {k}"] = _told(
            text=each.get_text(), at=_row(each.get_position()), size=each.get_fontsize(),
            place=f"{each.get_ha()} {each.get_va()}", colour=_colour(each.get_color()),
            to=_row(each.xy) if hasattr(each, "xy") else "",
            frame="" if frame == axes.transData else type(frame).__name__,
        )  # fmt: skip
    if legend := axes.get_legend():
        told["legend"] = _legend(legend)
    return told | {f"child {k}": _axes(each) for k, each in enumerate(axes.child_axes)}


def _label(artist: Any) -> str:
    return "" if str(artist.get_label()).startswith("_") else artist.get_label()


def _scale(shown: Any) -> str:
    colours, log = shown.get_cmap(), isinstance(shown.norm, LogNorm)
    return f"{colours.name} {colours.N}{' log' * log} {_row(shown.get_clim())}"


def _collection(each: Any) -> str:
    own = {"label": _label(each), "z": each.get_zorder(), "alpha": each.get_alpha()}
    if isinstance(each, QuadMesh):
        grid = np.asarray(each._coordinates)
        return _told(x=_row(grid[0, :, 0]), y=_row(grid[:, 0, 1]), values=_row(each.get_array()),
                     scale=_scale(each), pixels=each.get_rasterized(), **own)  # fmt: skip
    paths = [path.vertices for path in each.get_paths() if len(path.vertices)]
    shown = {"kind": type(each).__name__, "paths": len(paths)}
    if paths:
        shown["at"] = _row(np.concatenate(paths))
    for name, colours in (("colour", each.get_facecolor()), ("edge", each.get_edgecolor())):
        shown[name] = _colours(colours) if len(colours) else ""
    styles = [style for _, style in each.get_linestyle()]
    return _told(**shown, width=_row(np.unique(each.get_linewidth())),
                 broken=any(style is not None for style in styles), **own)  # fmt: skip


def _legend(legend: Any) -> str:
    texts = legend.get_texts()
    return _told(
        texts=" | ".join(text.get_text() for text in texts), place=legend._loc,
        size=texts[0].get_fontsize() if texts else "", columns=legend._ncols,
        frame=legend.get_frame_on(),
    )  # fmt: skip
