"""Pages and files of answers that are made by hand: what stands on them and what is written."""

import dataclasses
import errno
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import made_answers as made
from figure_lines import figure_lines
from small_soles import fake, scene_lines, sole
from snapshot import folder_lines, held, refusal
from underfoot.core import InputError, Status
from underfoot.core.presentation import Part, Presentable, Table
from underfoot.questions.comparison import compare
from underfoot.report import figures, page_text, plot, slips, write_report
from underfoot.report.dispatch import files, sections
from underfoot.report.outsole import (
    OutsoleInspection,
    case_shoe,
    case_text,
    inspect_outsole,
    outsole_scene,
)
from underfoot.report.results import designed_surface, map_fields, sole_fields
from underfoot.report.studies_page import _broad, _cell, studies_page, write_study
from underfoot.report.thumbnail import thumbnail
from underfoot.report.writing import json_text, write_folder, write_text
from underfoot.shoe import Heel, Tread, heel_surface
from underfoot.shoe.files import FileSettings
from underfoot.shoe.tread_measures import tread_measures

PACKED = (
    r'"data": "[^"]*"|"(?:viridis|RdBu_r|cividis|YlGnBu_r|Blues)": "[^"]*"|src="data:[^"]*"'
    r"|/[^ ]*underfoot-\w+"
)
WRITTEN = ("*.html", "*.json", "*.csv", "*.toml")


class Answer(Presentable):
    kind = "answer"
    name = "An <answer>"

    def headline(self):
        return ("Forty-two ± 1.",)

    def cautions(self):
        return ("The question is not known.",)

    def table(self):
        rows = [("answer", "42"), (Part("of it"), float("nan"))]
        return Table("Numbers", ("Quantity", "Value"), rows)

    def remarks(self):
        return {"Assumptions": ["first", "second", "third", "fourth [bold]"], "None": []}

    def to_dict(self):
        return {"answer": {"value": 42.0, "spread": float("inf")}, "array": (1, np.float64(2.5)),
                "none": float("-inf"), "path": Path("a/b"), "nan": np.float64("nan")}  # fmt: skip

    def data_tables(self):
        rows = [("a", 1.5), ("=b", None), ("c", float("nan")), (3, np.float64(0.1))]
        return {"numbers": Table("", ("name", "value"), rows)}


def fails(error):
    def write(path):
        path.write_text("half")
        raise error

    return write


def test_any_answer(file_regression, tmp_path):
    written = write_report(Answer(), tmp_path / "a", further={"more.txt": write_text("more")})
    told = {
        "files": folder_lines(tmp_path / "a", "*"), "lines": written.lines(),
        "advice": json_text(Answer(), advice=Answer()),
        "with figures": page_text(Answer(), {"one_two": b"png"}).partition("<body>")[2],
        "refused": [refusal(write_report, 3, tmp_path / "b"), refusal(plot, Answer()),
                    refusal(write_report, Answer(), tmp_path)],
    }  # fmt: skip
    held(file_regression, made.placeless(told, tmp_path), hide=PACKED)


def test_what_can_not_be_written(file_regression, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    told: dict[str, Any] = {}
    errors = [OSError(getattr(errno, name), name) for name in
              ("ENOSPC", "EDQUOT", "EACCES", "EROFS", "ENAMETOOLONG", "EIO")]  # fmt: skip
    errors += [OSError("odd"), ImportError("no module", name="a.b"), ImportError("c.d gone"),
               InputError("bad", remedy="Mend it"), ValueError("odd")]  # fmt: skip
    for k, error in enumerate(errors):
        written = write_folder(tmp_path / f"o{k}", {}, {"a.png": fails(error)}, write_text("p"))
        told[str(k)] = [written.lines()[1:], sorted(os.listdir(written.folder))]
    lost = write_folder(tmp_path / "l", {"a": fails(errors[0]), "b": write_text("b")}, {})
    told["lost"] = [lost.lines(), sorted(os.listdir(lost.folder))]
    told["no page"] = write_folder(tmp_path / "n", {}, {}, fails(errors[2])).lines()
    told["again"] = refusal(write_folder, tmp_path / "n" / "..", {}, {})
    write_folder(tmp_path / "n", {"c": write_text("c")}, {}, overwrite=True)
    told["over"] = sorted(os.listdir(tmp_path / "n"))
    monkeypatch.setenv("UNDERFOOT_DEBUG", "1")
    told["debug"] = refusal(write_folder, tmp_path / "d", {"a": fails(ValueError("odd"))}, {})
    held(file_regression, made.placeless(told, tmp_path), hide=PACKED)


ANSWERS = {
    "risk": lambda: made.assessment(made.change("good"), made.change("worse", 0.05, 0.9),
                                    made.change("x", failure="not converged")),
    "sensitivity": made.sensitivity,
    "no sensitivity": lambda: made.sensitivity(made.FAILED),
    "wear": lambda: made.wear(untreaded=made.outcome(0.05)),
    "no wear": lambda: made.wear((None, None)),
}  # fmt: skip


@pytest.mark.parametrize("name", ANSWERS)
def test_answers_to_questions(file_regression, tmp_path, name):
    shown = ANSWERS[name]()
    drawn = dict.fromkeys(figures(shown), b"png")
    data = files(shown)
    for key, write in data.items():
        write(tmp_path / key)
    told = {"page": page_text(shown, drawn).partition("<body>")[2], "figures": list(drawn),
            "files": list(data), "data": folder_lines(tmp_path, "*.csv")}  # fmt: skip
    held(file_regression, told, hide=PACKED)


def body(page):
    return page.partition("<body>")[2]


def test_a_result(file_regression, tmp_path):
    shown = made.result()
    advice = made.assessment(made.change("good"))
    report = write_report(shown, tmp_path / "a", advice=advice)
    told = {
        "files": folder_lines(tmp_path / "a", "*.json", "*.csv"), "names": sorted(files(shown)),
        "page": body(report.page.read_text("utf-8")),
        "makers": list(figures(shown)),
    }  # fmt: skip
    held(file_regression, told, hide=PACKED)


def test_results_of_other_kinds(file_regression, monkeypatch):
    """Not converged; of one position of the tread; over time; whose sole is gone."""
    data = made.result().data
    time = {"load_history": ("time", np.array([0.0, 500.0])),
            "fluid_load_history": ("time", np.array([0.0, 90.0])),
            "time": ("time", np.array([0.0, 0.02]))}  # fmt: skip
    more = {"cof_tread_position": made.scalars()["cof"], **made.scalars()}
    several = {
        "failed": made.result(status=Status.NOT_CONVERGED),
        "moved": made.result(scalars=more, assumptions=(), breaches=()),
        "over time": made.result(data=data.assign(time)),
        "gone": made.result(case_text="name = 'x'\nnothing"),
    }
    told: dict[str, Any] = {}
    for name, shown in several.items():
        parts, script = sections(shown, {"contact_pressure": b"png", "maps": b"png"})
        told[name] = [[(p.title, p.intro, len(p.html) > 0, p.pictures, p.stage) for p in parts],
                      "WebGL" in script, list(figures(shown))]  # fmt: skip
    held(file_regression, told)


def test_comparisons(file_regression):
    fine = sole(side=5e-3, factor=2.0, sensors=0)
    results = [made.result("a", cof=0.1), made.result("b", cof=0.3, data=fine),
               made.result("c", cof=0.31, slip=0.1)]  # fmt: skip
    told: dict[str, Any] = {}
    for name, shown in (
        ("two", compare(*results[:2])), ("three", compare(*results)),
        ("none", compare(results[0], made.result("d", status=Status.NOT_CONVERGED))),
    ):  # fmt: skip
        drawn = dict.fromkeys(figures(shown), b"png")
        told[name] = [body(page_text(shown, drawn)), list(drawn)]
    held(file_regression, told, hide=PACKED)


def test_soles_of_cases(file_regression):
    case = made.CASE
    surface = designed_surface(case, 2e-3)
    assert designed_surface(case, 2e-3) is surface
    worn = case.replace({"shoe.wear.depth": "1 mm", "shoe.wear.angle": "7 deg"})
    assert designed_surface(worn, 2e-3) is not surface
    told = {
        "surface": [len(surface.points), len(surface.triangles), surface.points.max(axis=0)],
        "coarse": sole_fields(case),
        "finer": sole_fields(case, 3e-3),
        "case": figure_lines(plot(case)),
        "fields": map_fields(
            fake(
                clearance=np.ones((2, 2)),
                inside=np.ones((2, 2)) > 0,
                land=np.eye(2) > 0,
                outline=np.ones((3, 2)),
                x=np.arange(2.0),
                y=np.arange(2.0),
            )
        ),
        "thumbnails": [thumbnail(case), thumbnail(worn)],
    }
    held(file_regression, scene_lines(told))


def inspection(tmp_path, *, pattern="grid", thickness=0.0123, draft=None, **settings) -> Any:
    tread = {"tread": Tread("grid", lug_width=8e-3, channel_width=4e-3, depth=3e-3)}
    heel = Heel(length=0.05, width=0.04, rear_radius=0.015, outsole_thickness=0.02,
                **({} if pattern == "none" else tread))  # fmt: skip
    surface = heel_surface(heel, spacing=1e-3)
    file = tmp_path / "soles" / "mine.stl"
    file.parent.mkdir(exist_ok=True)
    file.write_text("a solid")
    sound: Any = dataclasses.make_dataclass("Sound", ["open_edges"])(2)
    read = fake(surface=surface, thickness=thickness, draft=draft, faces=12, format="STL",
                unit=1e-3, down="-z", forward="+x", foot="left" if draft else "",
                whole_length=0.05, soundness=sound, edges=np.empty((0, 2, 2)))  # fmt: skip
    measures = tread_measures(surface)
    return OutsoleInspection(file, FileSettings(**settings), read, measures)


@pytest.mark.parametrize("units", ["si", "us"])
def test_an_outsole_of_a_file(file_regression, tmp_path, monkeypatch, units):
    monkeypatch.setenv("UNDERFOOT_UNITS", units)
    full = inspection(tmp_path, draft=0.1, unit="mm", down="+z", forward="-x", foot="right",
                      region="forepart", region_length=0.07, mirror=True, cut_floor=True, solid="a",
                      side="left", spacing=0.4e-3)  # fmt: skip
    plain = inspection(tmp_path, pattern="none", thickness=None)
    sipes = dataclasses.replace(full, measures=dataclasses.replace(
        full.measures, sipe_count=3, sipe_length=0.045, drained_share=0.25))  # fmt: skip
    told: dict[str, Any] = {}
    for name, shown in (("full", full), ("plain", plain), ("sipes", sipes)):
        told[name] = [
            repr(shown),
            str(shown.heading()),
            shown.headline(),
            shown.table(),
            shown.remarks(),
            shown.to_dict() | {"file": ""},
            shown.data_tables(),
        ]
    if units == "si":
        told["cases"] = [case_text(full, tmp_path), case_text(plain, tmp_path / "soles"),
                         case_shoe(plain, tmp_path)["outsole"]]  # fmt: skip
        told["scene"] = scene_lines(outsole_scene(full))
        parts, _ = sections(full, {"outsole": b"png"})
        told["sections"] = [(p.title, p.intro, p.pictures, p.stage) for p in parts]
        told["files"] = [list(files(full)), list(figures(full))]
        full.write_heights(tmp_path / "heights.csv")
        told["heights"] = (tmp_path / "heights.csv").read_text().splitlines()[:3]
    held(file_regression, told)


def test_a_file_of_an_outsole_is_read_with_its_settings(file_regression):
    file = Path(__file__).parents[2] / "examples" / "measured" / "heel.stl"
    shown = inspect_outsole(file, FileSettings(spacing=2e-3))
    held(file_regression, {"table": shown.table(), "remarks": shown.remarks()})


def png(width, height):
    return bytes(16) + width.to_bytes(4, "big") + height.to_bytes(4, "big")


def a_study(name):
    from underfoot.studies import (
        Computed,
        ComputedQuantity,
        PublishedStudyResult,
        StudyTable,
        study,
    )
    from underfoot.studies.figure import Figure, Layer, Panel

    asked = {one.quantity: one for one in study(name).statements if one.quantity}
    values = {
        path: ComputedQuantity.of(
            [3.0 - k for k in range(len(one.names))], one.si_unit, names=one.names
        )
        if one.names
        else ComputedQuantity.of(1.0, one.si_unit)
        for path, one in asked.items()
    }
    drawn = Figure((Panel((Layer("points", [1.0], [2.0]),)),), "so <it> is")
    table = StudyTable("t", "A table of <words>", ("x", "y"), (("a", 1.5), ("b", None)))
    computed = Computed(values, (table,), {"made_up": drawn}, ("it holds",), ("n",), ("as",))
    return PublishedStudyResult(study(name), computed, True, 1.0, 1.0)


def test_published_studies(file_regression, tmp_path):
    one, failed = a_study("g3"), dataclasses.replace(a_study("g2"), error="it broke", quick=False)
    images = {("g3", "made_up"): png(26, 10), ("g3", "broad"): png(27, 10)}
    names = write_study(one, tmp_path)
    told = {
        "one": body(studies_page([one], images)),
        "names": names,
        "two": body(studies_page([one, failed], images, quick=True)).partition('id="g2"'),
        "files": folder_lines(tmp_path, "*.csv"),
        "broad": [_broad(png(*size)) for size in ((26, 10), (261, 100), (10, 26))],
        "cells": [
            _cell(value)
            for value in (
                None,
                float("nan"),
                True,
                "a",
                0,
                0.001,
                9.99e-4,
                99999.4,
                1e5,
                -12.34567,
                3,
            )
        ],
    }
    told["two"] = told["two"][2]
    held(file_regression, told, hide=PACKED)


def test_a_page_of_slips(file_regression, monkeypatch):
    monkeypatch.setattr(slips, "animation_data", lambda study: {"a": "</script>", "b": [1, 2.5]})
    told = {}
    for wet in (True, False):
        walker = fake(name="the <median>", mass=70.0, rcof=0.2, heel_speed=0.7)
        monkeypatch.setattr(slips, "shown_motion", lambda study, who=walker: fake(walker=who))
        shown: Any = Answer()
        shown.study, shown.wet = "study", wet
        parts, script = slips._sections(shown, {"slip": b"png"})
        told[str(wet)] = [*((p.title, p.intro, p.html, p.pictures) for p in parts), script]
    held(file_regression, told, hide=PACKED)
