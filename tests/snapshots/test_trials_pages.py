"""Figures of single trials and of folders, drawn from curves written by hand."""

import numpy as np

from figure_lines import figure_lines
from snapshot import held
from trial_studies import EDITED, main
from underfoot.trials.pages import figures as drawn
from underfoot.trials.study.file_result import FileResult

TIME = np.linspace(0.0, 0.6, 31)


def two(make):
    """Two curves that differ in every number: the first is the one of a figure of one."""
    return [make(1.0), make(1.3)]


def step(scale):
    return {
        "step": f"step {scale:g}",
        "time": (scale * TIME).tolist(),
        "normal": (700 * scale * np.sin(5 * TIME)).tolist(),
        "along": (90 * scale * np.cos(9 * TIME)).tolist(),
        "across": (20 * scale * np.sin(9 * TIME)).tolist(),
        "ratio": [None, *(0.2 * scale * np.cos(4 * TIME[1:]))],
        "gate": 0.03 * scale,
        "peak_time": 0.1 * scale,
        "peak": 0.21 * scale,
        "verdict": "caution",
        "reason": "partial",
    }


def heel(scale, **more):
    speed = scale * np.exp(-(((TIME - 0.2) / 0.1) ** 2))
    return {
        "time": (TIME - 0.1).tolist(),
        "speed": speed.tolist(),
        "threshold": 0.5 * scale,
        "start": 0.02 * scale,
        "end": 0.3 * scale,
        "peak": 0.9 * scale,
        "peak_time": 0.1 * scale,
        **more,
    }


def track(scale):
    pulses = [
        {
            "sensor": f"S{n}",
            "along": 0.02 * (n // 2) * scale,
            "across": 0.015 * (n % 2) * scale,
            "time": TIME[:9].tolist(),
            "kPa": (scale * (n + 1) * np.sin(5 * TIME[:9])).tolist(),
        }
        for n in range(4)
    ]
    return {
        "along": (0.3 * scale * TIME).tolist(),
        "across": (0.01 * scale + 0.02 * TIME).tolist(),
        "pulses": pulses,
    }


def slide(scale):
    return {
        "time": (scale * TIME).tolist(),
        "normal": (500 * scale + 9 * TIME).tolist(),
        "shear": (90 * scale * TIME).tolist(),
        "ratio": (0.3 * scale * TIME).tolist(),
        "begin": 0.2 * scale,
        "end": 0.4 * scale,
        "cof": 0.14 * scale,
    }


def hold(scale):
    return {
        "time": (scale * TIME).tolist(),
        "force": (90 * scale * (1 + TIME) ** -0.2).tolist(),
        "final": 80 * scale,
    }


def result(**curves):
    numbers = (main("cof", 0.14), main("slip", 1.0)) if "slide" in curves else ()
    return FileResult("a trial #2.c3d", numbers=numbers, curves=curves)


def test_figures_of_single_trials(file_regression):
    curves = {
        "steps": [step(1.0), step(1.3), step(1.6), step(2.0)],
        "heel": two(heel),
        "track": two(track),
        "slide": two(slide),
        "run": two(slide),
        "hold": two(hold),
    }
    makers = {key: getattr(drawn, f"_{key}") for key in curves}
    whole = {
        key: figure_lines(make(curves[key], result(slide=two(slide))))
        for key, make in makers.items()
    }
    whole["one step"] = figure_lines(drawn._steps([step(1.3)], EDITED))
    whole["no slip"] = figure_lines(
        drawn._heel([heel(1.0, start=None, end=None, peak=None, peak_time=None)], EDITED)
    )
    whole["no COF"] = figure_lines(drawn._slide([slide(1.0)], result()))
    held(file_regression, whole)


def test_tiles_of_single_trials(file_regression):
    files = [
        result(slide=two(slide)),
        result(steps=[step(1.0)], rejected=[step(1.3)]),
        result(hold=[hold(1.0)]),
        result(run=[slide(1.0)]),
        result(heel=[heel(1.0), heel(0.4, peak=None)]),
        EDITED,
    ]
    found = []
    for sheet in drawn.sheets(files):
        tiles = [
            [
                name,
                tile.label,
                tile.verdict,
                f"{np.nansum(tile.x):.5g} {np.nansum(tile.y):.5g} {len(tile.x)}",
                tile.marks,
                tile.remark,
                tile.reason,
            ]
            for name, tile in sheet.tiles
        ]
        found.append([sheet.kind, sheet.title, sheet.x_range, sheet.y_range, sheet.line, tiles])
    held(
        file_regression,
        {"sheets": found, "chosen": [one.verdict for one in drawn._choose_files(files, 3)]},
    )


def test_figures_of_a_folder(file_regression):
    def risk(scale):
        grid = np.linspace(0.1, 0.4, 7) * scale
        chance = 1 / (1 + np.exp(40 * (grid - 0.2)))
        return {
            "name": "acof",
            "grid": grid,
            "low": 0.8 * chance,
            "high": np.minimum(1.2 * chance, 1),
            "risk": chance,
            "x": grid[::2],
            "y": [1, 1, 0, 0],
            "slope": -40.0 * scale,
            "half": 0.2 if scale == 1 else 0.9,
            "method": "m",
        }

    def scan(scale):
        return {
            "lateral": [0.0, 0.01 * scale, 0.02 * scale],
            "along": [0.0, 0.03 * scale],
            "pressure": (1e5 * scale * np.arange(6).reshape(3, 2)).tolist(),
            "peak_lateral": 0.02 * scale,
            "peak_along": 0.03 * scale,
            "peak": 5e5 * scale,
            "load": 90 * scale,
            "label": f"shoe {scale:g}",
        }

    def fit(group, verdict, scale):
        speed = np.array([0.1, 0.3, 0.6, 1.0]) * scale
        return {
            "group": group,
            "verdict": verdict,
            "mean": 0.3 * scale,
            "raw": (0.5, 0.3 * scale, 0.1),
            "speed": speed,
            "cof": 0.5 - 0.3 * speed,
        }

    fits = [
        fit("", "fitted", 1.0),
        fit("water", "mean", 1.2),
        fit("water", "fitted", 0.8),
        fit("oil", "fitted", 1.1),
        fit("soap", "mean", 0.9),
    ]
    master = {
        "product": [1e-4, 1e-3, 1e-2],
        "cof": [0.4, 0.3, 0.2],
        "label": ["a", "b", "a"],
        "grid": [1e-4, 1e-2],
        "fitted": [0.41, 0.19],
        "r_squared": 0.987,
        "residual_sd": 0.0123,
    }
    straight = {
        "x": [10.0, 20.0, 40.0],
        "y": [0.2, 0.5, 0.9],
        "intercept": 0.01,
        "slope": 0.023,
        "r": 0.95,
    }
    adhesion = {
        "fluid": ["w", "w", "o"],
        "dry": [10.0, 12.0, 15.0],
        "wet": [8.0, 9.0, 7.0],
        "lines": [("w", 1.0, 0.7), ("o", 0.5, 0.4)],
    }
    held(
        file_regression,
        {
            "risk": figure_lines(drawn._risk([risk(1.0), risk(1.2)])),
            "maps": figure_lines(drawn._maps([scan(1.0), scan(1.5)])),
            "fits": figure_lines(drawn._fits(fits)),
            "master": figure_lines(drawn._master(master)),
            "line": figure_lines(drawn._line(straight)),
            "adhesion": figure_lines(drawn._alpha_beta(adhesion)),
        },
    )
