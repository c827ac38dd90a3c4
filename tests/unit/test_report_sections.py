"""Sections of pages and files of other programs: which there are, of what, and in which order."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import xarray

from underfoot.case import load
from underfoot.core import SourcedValue
from underfoot.core.fields import from_xarray
from underfoot.core.page import PageSection
from underfoot.core.presentation import Presentable, Table
from underfoot.report import (
    compound,
    design_study,
    dispatch,
    question_figures,
    results,
    slips,
    sole_export,
    thumbnail,
    wear_page,
)
from underfoot.report.designed_sole import DesignedSole
from underfoot.report.drawn_sole import DrawnSole
from underfoot.report.quantities import DrawnQuantity
from underfoot.report.solver_input import _wrap_numbers
from underfoot.report.surface_mesh import DRAWN, TOLERANCE
from underfoot.report.writing import json_text

CASE = load(Path(__file__).parents[2] / "examples" / "work_shoe_full_tread_glycerol.toml")


def fake(**parts) -> Any:
    return SimpleNamespace(**parts)


def xy(line):
    return tuple(np.asarray(part, dtype=float) for part in line.get_data())


# a compound


def test_relaxation_shifts_and_holds_are_drawn_with_their_fits():
    time = np.array([0.1, 1.0, 10.0])
    modulus = np.array([5e6, 4e6, 3e6])
    spectrum = fake(relaxation_modulus=lambda t: 1e6 * t)
    shown = fake(relaxation=fake(time=time, modulus=modulus), spectrum=spectrum, sweep=None)
    (axes,) = compound._relaxation(shown).axes
    assert xy(axes.lines[0]) == (pytest.approx(time), pytest.approx(modulus / 1e6))
    assert xy(axes.lines[1]) == (pytest.approx(time), pytest.approx(time))
    assert axes.get_ylim()[0] == 0
    labels = [text.get_text() for text in cast(Any, axes.get_legend()).get_texts()]
    swept = compound._relaxation(fake(**vars(shown) | {"sweep": 1})).axes[0]
    assert labels != [text.get_text() for text in cast(Any, swept.get_legend()).get_texts()]

    class Law:
        def log10_shift_factor(self, kelvin):
            return -0.1 * (kelvin - 293.15)

        def __str__(self):
            return "the law"

    table = fake(temperatures=np.array([273.15, 293.15, 333.15]), log10_errors=np.full(3, 0.2),
                 log10_shift_factors=np.array([2.0, 0.0, -4.0]), law=Law())  # fmt: skip
    (axes,) = compound._shifts(fake(shifts=table)).axes
    bars: Any = axes.containers[0]
    assert xy(bars[0]) == (pytest.approx([0, 20, 60]), pytest.approx([2, 0, -4]))
    reach = [(low[1], high[1]) for low, high in bars[2][0].get_segments()]
    assert reach == [pytest.approx((y - 0.2, y + 0.2)) for y in (2, 0, -4)]
    law = next(line for line in axes.lines if line.get_label() == "the law")
    celsius, factor = xy(law)
    assert (celsius[0], celsius[-1]) == pytest.approx((0, 60))
    assert factor == pytest.approx(-0.1 * (celsius - 20))

    tests = [
        fake(name=f"test {k}", reading=fake(
            time=time, force=k * time, force_2_percent=SourcedValue(k),
            peak_force=SourcedValue(2 * k), final_force=SourcedValue(0.7)))
        for k in (1, 2)
    ]  # fmt: skip
    (axes,) = compound._hold(fake(compressions=tests)).axes
    curves = [line for line in axes.lines if str(line.get_label()).startswith("test")]
    assert [xy(line)[1].tolist() for line in curves] == [time.tolist(), (2 * time).tolist()]
    levels = [line.get_ydata()[0] for line in cast(Any, axes.lines) if line not in curves]
    assert levels == [1, 2, 0.7, 2, 4, 0.7]


@pytest.mark.parametrize("present", ["sweep", "relaxation", "shifts", "compressions"])
def test_a_compound_has_the_figures_of_what_was_measured(present):
    parts = dict.fromkeys(("sweep", "relaxation", "shifts", "compressions"))
    makers = compound._(fake(**parts | {present: [1]}))
    names = {"shifts": "shift_factors", "compressions": "hold"}
    assert list(makers) == [names.get(present, present)]


# pages


class Shown(Presentable):
    kind = "shown"
    name = "shown"

    def __init__(self, **parts):
        for name, value in parts.items():
            object.__setattr__(self, name, value)

    def headline(self):
        return ()

    def table(self):
        return Table("Ranking", ("a",), [("b",)])

    def tables(self):
        return (self.table(), Table("Inputs", ("a",), [("b",)]))

    def remarks(self):
        return {}

    def to_dict(self):
        return {"whole": np.float64(1.5), "count": np.int64(3), "none": np.float64("nan"),
                "path": Path("a/b")}  # fmt: skip


Compared: Any = type("Compared", (Shown,), {"usable": True})  # said by what is made of it


@pytest.mark.parametrize("usable", [True, False])
def test_a_comparison_has_its_soles_first_and_its_differences_last(monkeypatch, usable):
    made = [fake(name=name, data=name, provenance=fake(case_hash=f"{name}" * 30, created="now"))
            for name in "xy"]  # fmt: skip
    shown: Any = Compared(results=made, letters=("A", "B"), usable=usable)
    monkeypatch.setattr(results, "_viewer", lambda several: f"viewer of {len(several)}")
    monkeypatch.setattr(results, "grid_note", lambda data: f"note of {''.join(data)}.")
    quantity = DrawnQuantity("p", "Pressure", 1.0, "Pa")
    monkeypatch.setattr(results, "quantities", lambda data: (quantity,))
    monkeypatch.setattr(results, "viewer_script", lambda: "script")
    pictures = {"p": b"png"} if usable else {}
    parts, script = results._comparison_sections(shown, pictures)
    titles = [part.title for part in parts]
    if not usable:
        assert titles == ["Results compared"]
        assert script == ""
        return
    assert titles == ["Under the soles", "Ranking", "Inputs", "Maps and differences", "Pressure",
                      "Results compared"]  # fmt: skip
    assert parts[0].html == "viewer of 2"
    assert (parts[0].stage, parts[1].first, parts[2].first) == (True, True, False)
    assert "note of xy." in parts[3].intro
    (picture,) = parts[4].pictures
    assert picture is not None
    assert [item[:5] for item in parts[5].items] == ["A: x,", "B: y,"]
    assert "x" * 16 in parts[5].items[0]
    assert "x" * 17 not in parts[5].items[0]
    assert script == "script"
    monkeypatch.setattr(results, "comparison_figure", lambda data, q: (data, q))
    makers = results._comparison_figures(shown)
    assert list(makers) == ["p"]
    assert cast(Any, makers["p"]()) == (["x", "y"], quantity)
    assert results._comparison_figures(cast(Any, Compared(usable=False))) == {}


@pytest.mark.parametrize("soles", [True, False])
def test_wear_is_shown_on_its_sole_where_that_is_kept(monkeypatch, soles):
    monkeypatch.setattr(wear_page, "wear_scene", lambda series: "scene")
    monkeypatch.setattr(wear_page, "scene_section", lambda scene: f"html of {scene}")
    monkeypatch.setattr(wear_page, "viewer_script", lambda: "script")
    series: Any = Shown(soles=soles, fields=lambda: fake(to_netcdf=lambda path: None))
    parts, script = wear_page._wear_sections(series, {"wear": b"png"})
    titles = [part.title for part in parts]
    assert titles[-3:] == ["Over the wear", "Ranking", "Inputs"]
    assert (len(titles), script) == ((4, "script") if soles else (3, ""))
    if soles:
        assert (parts[0].html, parts[0].stage) == ("html of scene", True)
    assert ("wear.nc" in wear_page._wear_files(series)) is soles


def test_a_page_of_slips_has_its_player_with_data_that_end_no_script(monkeypatch):
    given = {}

    def render(**parts):
        given.update(parts)
        return "player"

    monkeypatch.setattr(slips, "environment", lambda _: fake(
        get_template=lambda name: fake(render=render)))  # fmt: skip
    monkeypatch.setattr(slips, "animation_data", lambda study: {"a": "</script>", "b": [1, 2]})
    walker = fake(name="the median")
    monkeypatch.setattr(slips, "shown_motion", lambda study: fake(walker=walker))
    shown: Any = Shown(study="study", wet=True)
    parts, script = slips._sections(shown, {"slip": b"png"})
    assert "<" not in given["data"]
    assert json.loads(given["data"]) == {"a": "</script>", "b": [1, 2]}
    assert (given["wet"], given["walker"]) == (True, walker)
    assert "the median" in parts[0].title
    assert parts[0].html == "player"
    assert [part.title for part in parts[1:3]] == ["Ranking", "Inputs"]
    assert len(parts[3].pictures) == 1
    assert script == ""
    assert list(slips._figures(shown)) == ["slip"]


@pytest.mark.parametrize("kind", ["sensitivity", "optimise"])
@pytest.mark.parametrize("best", [1, 3])
def test_a_page_of_a_study_has_what_there_is_of_it(monkeypatch, kind, best):
    monkeypatch.setattr(design_study, "explorer", lambda result, designs: f"plots of {designs}")
    designs = [fake(number=n) for n in range(best)]
    index = fake(heading=lambda: "Index", headline=lambda: ("one", "two"), output="cof",
                 table=lambda: Table("", ("a",), [("b",)]))  # fmt: skip
    models = [fake(name="cof", reliability="good")] if kind == "optimise" else []

    class Study(Shown):
        shown = designs = "all"

        def best(self, count):
            assert count == 8
            return designs_of

        def higher_cof(self, one, other):
            return {0: 0.75, 1: None}[one.number]

    ready: Any = type("Ready", (Study, design_study.ShownStudy), {})
    designs_of = designs
    made = object.__new__(ready)
    for name, value in {"indices": [index] if kind == "sensitivity" else [], "models": models,
                        "missing": "none yet", "plan": fake(text="toml")}.items():  # fmt: skip
        object.__setattr__(made, name, value)
    pictures = {"effects_0": b"a", "slices": b"b"}
    monkeypatch.setattr(design_study, "viewer_script", lambda *further: "script")
    parts, _ = design_study._study_sections(made, pictures)
    titles = [part.title for part in parts]
    assert titles[0] == "Designs"
    assert parts[0].html == "plots of all"
    assert ("How sure the order by COF is" in titles) is (best > 1)
    if best > 1:
        table = parts[titles.index("How sure the order by COF is")].table
        assert table is not None
        assert table.rows == [("Design 0 above design 1", "75 %"),
                              ("Design 1 above design 2", "not estimated")]  # fmt: skip
    if kind == "sensitivity":
        assert titles[titles.index("Index") + 1] == "cof: indices"
        assert parts[titles.index("cof: indices")].folded
        assert "Surrogates" in titles
    else:
        assert titles[titles.index("Slices") + 1] == "Error of the surrogates"
        assert list(parts[titles.index("Error of the surrogates")].items) == ["cof: good"]
        assert "Surrogates" not in titles
    assert (titles[-1], parts[-1].folded, parts[-1].text) == ("Study file (TOML)", True, "toml")
    assert all(isinstance(part, PageSection) for part in parts)


def test_numbers_of_numpy_are_plain_in_json():
    told = json.loads(json_text(Shown()))
    assert (told["whole"], told["count"], told["none"], told["path"]) == (1.5, 3, None, "a/b")


def test_a_thumbnail_is_drawn_once(monkeypatch):
    stored, drawn = {}, []
    cache = fake(load=stored.get, store=stored.__setitem__)
    monkeypatch.setattr(thumbnail, "Cache", lambda name: cache)
    monkeypatch.setattr(thumbnail, "_draw_sole", lambda case: drawn.append(case) or "<svg>")
    assert [thumbnail.thumbnail(CASE) for _ in range(2)] == ["<svg>"] * 2
    assert len(drawn) == 1
    thumbnail.thumbnail(CASE.replace({"shoe.wear.depth": "1 mm", "shoe.wear.angle": "7 deg"}))
    assert len(drawn) == 2
    thumbnail.thumbnail(CASE.replace("motion.speed", "0.1 m/s"))
    assert len(drawn) == 2


@pytest.mark.parametrize("usable", [True, False])
def test_a_rough_contact_is_drawn_and_written_where_there_is_one(tmp_path, usable):
    floor = fake(heights=np.arange(4.0).reshape(2, 2), spacing=1e-6)
    contact = fake(pressure=np.ones((2, 2)), gap=np.zeros((2, 2)))
    shown: Any = Compared(floor=floor, contact=contact, usable=usable, answer="a title")
    assert list(question_figures._contact(shown)) == ["contact"] * usable
    written = question_figures._contact_files(shown)
    assert ("contact.npz" in written) is usable
    if usable:
        written["contact.npz"](tmp_path / "contact.npz")
        again = np.load(tmp_path / "contact.npz")
        assert again["heights"].tolist() == floor.heights.tolist()
        assert (again["spacing"], again["pressure"][0, 0], again["gap"][0, 0]) == (1e-6, 1, 0)


# soles for other programs


@pytest.mark.parametrize("kind", ["cells", "designed", "scan", "faces"])
def test_a_surface_says_within_what_its_lugs_are_of_the_drawing(monkeypatch, kind):
    whole = slice(0, 4), slice(0, 4)
    flat = np.zeros((4, 4))
    sole = DrawnSole(1e-3 * np.arange(4.0), 1e-3 * np.arange(4.0), 1e-3, flat, None, flat == 0,
                     whole, whole)  # fmt: skip
    asked = []
    monkeypatch.setattr(sole_export, "surface_mesh", lambda *given: "of cells")
    monkeypatch.setattr(sole_export, "spacing_for", lambda sole, designed: asked.append(designed)
                        or 0.2e-3)  # fmt: skip
    monkeypatch.setattr(sole_export, "designed_surface", lambda case, side: ("designed", side))
    edges = np.zeros((3, 2, 2)) if kind == "faces" else np.zeros((0, 2, 2))
    monkeypatch.setattr(sole_export, "file_outsole", lambda case: fake(edges=edges))
    outsole = None if kind in ("cells", "designed") else fake(map_spacing=0.4e-3)
    case = None if kind == "cells" else fake(shoe=fake(outsole=outsole))
    scene = sole_export._Scene("n", sole, False, {}, {}, fake(), case, "")
    made, within = scene.surface()
    if kind == "cells":
        assert (made, within) == ("of cells", (pytest.approx((TOLERANCE + 0.5) * 1e-3),))
        return
    assert cast(Any, made) == ("designed", 0.2e-3)
    assert asked == [kind == "designed"]
    on_cells = pytest.approx((TOLERANCE + 0.5) * 0.4e-3)
    assert within == {"designed": (pytest.approx(max(DRAWN, TOLERANCE * 0.2e-3)),),
                      "scan": (on_cells,), "faces": (DRAWN, on_cells)}[kind]  # fmt: skip


def test_colours_of_cells_are_those_of_the_page_and_rubber_where_there_is_none():
    values = np.array([[1.0, 10.0], [100.0, np.nan]])
    plain = DrawnQuantity("p", "", 1.0, "", "viridis")
    log = DrawnQuantity("f", "", 1.0, "", "viridis", logarithmic=True)
    linear, logarithmic = (sole_export._colours(values, q) for q in (plain, log))
    import matplotlib

    table = matplotlib.colormaps["viridis"]
    for colours, shares in ((linear, (0.01, 0.1, 1.0)), (logarithmic, (0.0, 0.5, 1.0))):
        got = colours.reshape(-1, 4)
        for colour, share in zip(got[:3], shares, strict=True):
            assert tuple(colour) == tuple(table(share, bytes=True))
        assert tuple(got[3]) == sole_export.RUBBER


def test_a_field_between_cells_is_linear_to_the_rim_and_of_its_own_kind():
    """Fine cells of half the size over 6 by 5 cells, land on one side."""
    x, y = np.arange(6.0), np.arange(5.0)
    rising = 10 + 2 * x[:, None] + 3 * y
    land = np.broadcast_to((x < 3)[:, None], (6, 5)) * 1.0
    data = from_xarray(
        xarray.Dataset(
            {"film_thickness": (("x", "y"), np.where(land > 0, rising, rising + 100)),
             "land": (("x", "y"), land), "inside": (("x", "y"), np.ones((6, 5), bool))},
            coords={"x": x, "y": y},
        )
    )  # fmt: skip
    fine_x, fine_y = np.arange(-0.25, 5.5, 0.5), np.arange(-0.25, 4.5, 0.5)
    fine_land = np.broadcast_to((fine_x < 2.5)[:, None], (fine_x.size, fine_y.size))
    shape = fake(inside=np.ones(fine_land.shape, bool), clearance=np.zeros(fine_land.shape),
                 land=fine_land, x=fine_x, y=fine_y, spacing=0.5, whole=None)  # fmt: skip
    made = DesignedSole(data, cast(Any, shape)).field("film_thickness")
    edge_x, edge_y = np.clip(fine_x, 0, 5)[:, None], np.clip(fine_y, 0, 4)
    edge_x = np.where(fine_land, np.minimum(edge_x, 2), np.maximum(edge_x, 3))
    wanted = 10 + 2 * edge_x + 3 * edge_y + 100 * ~fine_land
    np.testing.assert_allclose(made, wanted)


@pytest.mark.parametrize("count", [1, 16, 17, 40])
def test_each_number_of_a_set_stands_once_sixteen_a_line(count):
    lines = [line.split(", ") for line in _wrap_numbers(list(range(count)))]
    assert [int(each) for line in lines for each in line] == list(range(count))
    assert {len(line) for line in lines[:-1]} <= {16}


def test_a_type_of_another_package_is_asked_for_by_the_name_of_its_package(monkeypatch):
    asked = []
    monkeypatch.setattr(dispatch, "find_offer", lambda *given: asked.append(given))
    alien: Any = type("Alien", (), {"__module__": "other_package.inner.module"})
    assert dispatch.figures(alien()) == {}
    assert asked == [("reports", "other_package")]
