"""Figures and tiles of curves by hand and at random: each line, mark, limit, legend and title."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from figure_lines import figure_lines
from snapshot import held
from underfoot.trials.pages import figures
from underfoot.trials.pages.figures import Tile, TileSheet, contact_sheets, sheets, trial_figures
from underfoot.trials.study.file_result import FileResult, Number

GROUPS: dict[str, Any] = {
    "one and two": {"a": {"p": 0.2}, "b": {"p": 0.25, "q": 0.3}},
    "none repeats": {"a": {"p": 0.2, "q": 0.25}, "b": {"r": 0.3, "s": 0.2}},
    "long names": {"a very long name": {"p": 1.0}, "other, of two": {"p": 2.0, "q": 0.5}},
    "at 13": {"thirteen char": {"p": 1.0}, "b": {"p": 2.0}, "c": {"p": 3.0}, "d": {"p": 1.0}},
}


@pytest.mark.parametrize("name", GROUPS)
def test_groups(file_regression, name):
    finding: Any = SimpleNamespace(
        values=GROUPS[name], marks={"a": "a", "b": "ab"}, response="rcof" if "one" in name else
        "some_force", factor="shoe", by_person=name != "at 13", name="n",
    )  # fmt: skip
    made = figures._groups(finding)
    held(file_regression, {"name": made.name, "caption": made.caption,
                           "figure": figure_lines(made.figure)}, f"groups {name}")  # fmt: skip


def risk(rng, name, half):
    grid = np.linspace(-0.1, 0.1, 9)
    return {
        "name": name, "grid": grid, "risk": 1 / (1 + np.exp(60 * grid)), "low": 0.1 + 0 * grid,
        "high": 0.9 + grid, "x": 0.05 * rng.normal(size=6), "y": [0, 1, 0, 1, 1, 0],
        "half": half, "slope": -61.26, "method": "firth",
    }  # fmt: skip


def fit(rng, group, verdict):
    speed = np.array([0.05, 0.1, 0.3, 0.6, 1.0])
    return {"group": group, "verdict": verdict, "speed": speed, "mean": 0.21,
            "cof": 0.1 + 0.2 * np.exp(-speed / 0.2) + 0.005 * rng.normal(size=5),
            "raw": (0.31, 0.22, 0.09)}  # fmt: skip


def test_figures_of_a_folder(file_regression):
    rng = np.random.default_rng(4)
    scans = [
        {"lateral": [-0.01, 0.0, 0.02], "along": np.linspace(0, 0.06, 4), "label": f"map {k}",
         "pressure": 1e4 * rng.random((3, 4)) * (k + 1), "peak_lateral": 0.01 * k,
         "peak_along": 0.02, "load": 12.34 + k, "peak": 9876.5}
        for k in range(2)
    ]  # fmt: skip
    labels = ["oil", "oil", "water", "soap", "water"]
    made = {
        "risk": figures._risk([risk(rng, "acof", 0.0), risk(rng, "margin", 0.2),
                               risk(rng, "rcof", -0.1)]),
        "one": figures._risk([risk(rng, "acof", 0.05)]),
        "maps": figures._maps(scans),
        "fits": figures._fits([fit(rng, "a", "identified"), fit(rng, "a", "mean"),
                               fit(rng, "", "identified"), fit(rng, "c", "mean"),
                               fit(rng, "d", "bounds")]),
        "two": figures._fits([fit(rng, "a", "identified"), fit(rng, "b", "mean")]),
        "master": figures._master({"product": np.geomspace(1e-4, 1, 5), "cof": rng.random(5),
                                   "label": labels, "grid": [1e-4, 1e-2, 1], "r_squared": 0.9567,
                                   "fitted": [0.3, 0.2, 0.1], "residual_sd": 0.0123}),
        "line": figures._line({"x": [1.0, 2.0, 4.0], "y": [0.1, 0.3, 0.5], "intercept": 0.02,
                               "slope": 0.12, "r": 0.987}),
        "alpha": figures._alpha_beta({"fluid": labels, "dry": rng.random(5), "wet": rng.random(5),
                                      "lines": [("oil", 0.1, 0.5), ("water", 0.2, 0.3)]}),
    }  # fmt: skip
    held(file_regression, {name: figure_lines(one) for name, one in made.items()})


def step(rng, **changes):
    time = np.linspace(0, 0.7, 41)
    normal = 700 * np.sin(np.pi * time / 0.7)
    return {"step": "step 1", "number": 1, "time": time, "normal": normal, "along": -0.2 * normal,
            "across": 0.03 * normal, "ratio": 0.2 + 0.05 * rng.random(41), "gate": 0.021,
            "peak_time": 0.12, "peak": 0.2345, "verdict": "caution"} | changes  # fmt: skip


def heel(rng, **changes):
    time = np.linspace(-0.1, 0.6, 71)
    return {"time": time, "speed": np.abs(np.sin(5 * time)) + 0.01 * rng.random(71), "start": 0.02,
            "end": 0.3, "peak": 0.9, "peak_time": 0.2, "threshold": 0.25} | changes  # fmt: skip


def slide(rng, last=0.4):
    time = np.linspace(0, last, 21)
    return {"time": time, "normal": 200 * np.sqrt(time), "shear": 50 * np.sqrt(time),
            "ratio": 0.25 + 0.01 * rng.random(21), "begin": 0.1, "end": 0.2}  # fmt: skip


def run(cof, last=0.4):
    time = np.linspace(0, last, 11)
    return {"time": time, "ratio": [None, *(0.2 + 0.1 * time[1:])], "begin": 0.1, "end": 0.3,
            "cof": cof}  # fmt: skip


def hold(last=0.9):
    time = np.linspace(0, last, 12)
    return {"time": time, "force": 40.0 + 10 * np.exp(-time), "final": 41.5}


def files(rng):
    """Return a file of each kind, some odd, one refused."""

    def one(name, main=None, verdict="accepted", reasons=(), **curves):
        numbers = tuple(Number(k, v, main=k) for k, v in (main or {}).items())
        return FileResult(name, numbers=numbers, verdict=verdict, reasons=reasons, curves=curves)

    rejected = {"step": "step 2", "number": 2, "time": np.linspace(0, 1.0, 9), "reason": "partial",
                "normal": np.full(9, 49.0), "ratio": np.ones(9)}  # fmt: skip
    return [
        one("walk #2.c3d", {"rcof": 0.23}, steps=[step(rng), step(rng, peak=0.45, step="step 3"),
            step(rng), step(rng)], rejected=[rejected]),
        one("slip.c3d", {"slip": 1.0}, verdict="caution",
            heel=[heel(rng), heel(rng, end=None, peak=None, start=None)]),
        one("still.c3d", {"slip": 0.0}, heel=[heel(rng, peak=0.31, peak_time=0.3, end=0.1)]),
        one("slide.csv", {"cof": 0.26}, slide=[slide(rng)]),
        one("slide too.csv", slide=[slide(rng, 0.9)]),
        one("run.csv", run=[run(0.22), run(0.31, 0.7), run(0.0)]),
        one("hold.csv", hold=[hold(), hold(1.4)], verdict="refused", reasons=("bad", "worse")),
        one("gone.csv", verdict="refused", reasons=("no numbers", "x")),
    ]  # fmt: skip


def test_figures_of_single_files(file_regression):
    rng = np.random.default_rng(5)
    these = files(rng)
    study = SimpleNamespace(curves={}, findings=[])
    whole: Any = SimpleNamespace(files=these, study=study)
    told = {}
    for details in (0, 1, 2, 3, 9):
        made = trial_figures(whole, details=details)
        told[f"{details}"] = [one.name for one in made]
    told["figures"] = {one.name: figure_lines(one.figure) for one in made}
    told["captions"] = [one.caption for one in made]
    held(file_regression, told)


def test_tiles_of_all_files(file_regression):
    rng = np.random.default_rng(6)
    told = {}
    for sheet in sheets(files(rng)):
        told[sheet.kind] = (sheet.title, sheet.x_range, sheet.y_range, sheet.line)
        told[f"{sheet.kind} tiles"] = [
            [name, one.label, one.verdict, one.marks, one.remark, one.reason, one.y, one.x]
            for name, one in sheet.tiles
        ]
    held(file_regression, told)


def test_pages_of_tiles(file_regression):
    """Pages of 60; rows of 6; labels of 34; reasons of four lines; marks and curves kept inside."""
    rng = np.random.default_rng(7)

    def tile(k, count=5, **changes):
        x = np.linspace(-0.1, 1.1, count)
        given: dict[str, Any] = {"label": f"f{k}", "verdict": "accepted", "x": x,
                                 "y": x + 0.1 * rng.random(count)}  # fmt: skip
        return Tile(**(given | changes))

    odd = (
        tile(0, label=34 * "a"), tile(1, label="abcdefghijkl" + 23 * "z", verdict="odd"),
        tile(2, 181, verdict="caution"), tile(3, 90, remark="0.2 <b>"),
        tile(4, reason="a reason that is so long that it goes over " * 4, verdict="rejected"),
        tile(5, marks=((0.5, 0.5), (0.2, np.nan), (3.0, -2.0))), tile(6, y=np.full(5, np.nan)),
        tile(7, x=np.empty(0), y=np.empty(0)),
    )  # fmt: skip

    def sheet(tiles, line=None):
        return TileSheet("run", "COF <all>", tuple((t.label, t) for t in tiles), (0.0, 0.8),
                         (-0.25, 1.5), line)  # fmt: skip

    told: dict[str, Any] = {
        name: list(contact_sheets(one))
        for name, one in (("few", sheet(odd[:2])), ("odd", sheet(odd, 0.5)))
    }
    for count in (6, 7, 60, 61, 121):
        pages = list(contact_sheets(sheet([tile(k) for k in range(count)], 0.2)))
        told[f"{count}"] = [(page.name, page.svg[:400], page.svg.count("<g ")) for page in pages]
    held(file_regression, told)
