"""Report G.2: friction against speed under six fluids, predicted from one of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from underfoot.calibrate import CofPoints, Pin
from underfoot.core import SourcedValue, display
from underfoot.core.catalogue import Catalogue
from underfoot.friction import (
    BoundaryFriction,
    Pair,
    Propagated,
    propagate_spread,
    stribeck_cof,
    viscous_decay,
)
from underfoot.reference import soft_ehl_film

from .default_law import (
    FAMILIES,
    chance_of_order,
    cof_draws,
    draws_without_report,
    with_reading_error,
)
from .figure import (
    COLOURS,
    GREY,
    MARKERS,
    OURS,
    PRINTED,
    Figure,
    Layer,
    Panel,
    line,
    points,
)
from .mechanisms import (
    CALIBRATION_FLUID,
    BlindTest,
    MechanismComparison,
    calibrated_mechanism,
    compare_mechanisms,
    predict_cof,
)
from .runner import Computed, Options, StudyTable
from .verdict import ComputedQuantity

STATEMENTS = Path(__file__).with_name("g2.toml")

LABELS: dict[str, str] = {
    "water_g2": "water",
    "detergent_g2": "detergent",
    "glycerol_25pct": "25 % glycerol",
    "glycerol_50pct": "50 % glycerol",
    "glycerol_75pct": "75 % glycerol",
    "canola_oil": "canola",
}
INPUTS = ("boundary", "viscosity")
"""Of a prediction: COF_BL where it is measured, or the viscosity alone."""
SAMPLES, QUICK_SAMPLES = 200, 100
PIN_HARDNESS = 42.0
"""Shore A of the pin: Gent's relation of the printed 2.0 MPa."""
EXAMPLE = (0.839, 0.184, 0.164)
"""COF_BL, tau (m/s) and asymptote in the caption of Fig. 14."""


@dataclass(frozen=True, slots=True)
class DefaultPrediction:
    """COF of one fluid by the law of the pair without the report's readings.

    ``cof`` and the ends of the 95 % interval are over the speeds, ``mean`` (draws,) is over them;
    ``median`` is at the medians of the law's inputs.
    """

    points: CofPoints
    cof: np.ndarray
    low: np.ndarray
    high: np.ndarray
    mean: np.ndarray
    kappa: np.ndarray

    @property
    def median(self) -> float:
        """Mean over the speeds at the medians."""
        return float(self.cof.mean())


def compute(options: Options) -> Computed:
    """Return what the chosen mechanism predicts, all mechanisms' errors, and Fig. 14 to 20."""
    comparison = compare_mechanisms(Catalogue.load())
    options.progress("intervals", 0.6)
    default = default_predictions(comparison, options.seed)
    test = comparison.chosen.fluids[0]
    samples = QUICK_SAMPLES if options.quick else SAMPLES
    spread = intervals(comparison, test, samples, options.seed)
    master, fit = master_curve(list(comparison.points.values()), comparison.pin)
    lambdas = lambda_ratios(comparison)
    quantities = {
        **_default_quantities(default),
        **_means(comparison),
        **_decay(comparison.fluids),
        **{
            f"lambda.{name}.{end}": ComputedQuantity.of(values[i])
            for name, values in lambdas.items()
            for i, end in ((0, "slowest"), (-1, "fastest"))
        },
        **{
            f"error.{on}.{inputs}": ComputedQuantity.of(getattr(comparison.chosen, on)[k].error)
            for on in ("fluids", "roughness")
            for k, inputs in enumerate(INPUTS)
        },
        "error.one_from_five": ComputedQuantity.of(comparison.chosen.one_from_five),
        "coverage": ComputedQuantity.of(_coverage(comparison.points, spread)),
        "master.r_squared": ComputedQuantity.of(fit["r_squared"]),
    }
    return Computed(
        quantities,
        (
            _default_table(default),
            _mechanism_table(comparison),
            _fluid_table(comparison),
            _curve_table(comparison, spread),
        ),
        {
            "fig14_example": _example_figure(comparison, default),
            "fig15_profile": _profile_figure(comparison.pin),
            "fig17_default_law": _default_figure(default),
            "fig16_master_curve": _master_figure(comparison.points, master, fit),
            "blind_predictions": _blind_figure(comparison.points, spread),
            "blind_errors": _error_figure(comparison),
            "fig18_20_levels": _levels_figure(comparison.fluids),
            "fig19_film": _film_figure(lambdas),
        },
        (*_default_conclusions(default), *_conclusions(comparison, fit)),
    )


def default_predictions(
    comparison: MechanismComparison, seed: int = 0
) -> dict[str, DefaultPrediction]:
    """Return the six fluids and Table 3 by the law of the pair without the report's readings."""
    draws, pin = draws_without_report(seed), comparison.pin
    every = dict(comparison.points) | {
        _rough_name(one): one
        for one in (p.points for p in comparison.chosen.roughness[0].predictions)
    }
    predictions = {}
    for name, cof_points in every.items():
        pair = Pair(
            PIN_HARDNESS,
            (cof_points.rq, cof_points.rq),
            (pin.floor_rq, pin.floor_rq),
            FAMILIES[cof_points.fluid],
        )
        drawn, _, median = cof_draws(
            pair, cof_points.viscosity, cof_points.speed, pin.pressure, draws, seed=seed
        )
        drawn = with_reading_error(drawn, draws, name, seed)
        low, high = np.quantile(drawn, [0.025, 0.975], axis=0)
        kappa = pair.draw_inputs(draws, seed)["kappa"]
        predictions[name] = DefaultPrediction(
            cof_points, median, low, high, drawn.mean(axis=1), kappa
        )
    return predictions


def _rough_name(cof_points: CofPoints) -> str:
    share = cof_points.fluid.removeprefix("glycerol_").removesuffix("pct")
    return f"{share}_{1e6 * cof_points.rq:.1f}"


def _default_quantities(default: Mapping[str, DefaultPrediction]) -> dict[str, ComputedQuantity]:
    """Return mean COF over the speeds, the order of the fluids and the decay speed of water."""
    quantities = {
        f"{'mean' if name in LABELS else 'rough'}.default.{name}": ComputedQuantity.of(
            prediction.median, draws=prediction.mean
        )
        for name, prediction in default.items()
    }
    printed = sorted(LABELS, key=lambda name: -default[name].points.cof.mean())
    order = [default[name] for name in printed]
    quantities["order.default"] = ComputedQuantity.of(
        [prediction.median for prediction in order],
        names=[LABELS[name] for name in printed],
        chance=chance_of_order([prediction.mean for prediction in order]),
    )
    thin, thick = (
        [default[name] for name in LABELS if (1e3 * default[name].points.viscosity > 10) is side]
        for side in (False, True)
    )
    least = (
        np.min([prediction.mean for prediction in thin], axis=0),
        min(prediction.median for prediction in thin),
    )
    most = (
        np.max([prediction.mean for prediction in thick], axis=0),
        max(prediction.median for prediction in thick),
    )
    quantities["thin_and_thick.default"] = ComputedQuantity.of(
        [least[1], most[1]],
        names=("thin fluids", "thick fluids"),
        chance=chance_of_order([least[0], most[0]]),
    )
    water = default["water_g2"]
    taus = water.kappa / water.points.viscosity
    quantities["tau.default"] = ComputedQuantity.of(float(np.median(taus)), "m/s", draws=taus)
    return quantities


def _default_table(default: Mapping[str, DefaultPrediction]) -> StudyTable:
    rows = []
    for name, prediction in default.items():
        low, high = np.quantile(prediction.mean, [0.025, 0.975])
        label = LABELS.get(
            name, f"{LABELS[prediction.points.fluid]}, sole Rq {1e6 * prediction.points.rq:.1f} µm"
        )
        rows.append(
            {
                "fluid": label,
                "viscosity, mPa s": 1e3 * prediction.points.viscosity,
                "COF printed": prediction.points.cof.mean(),
                "COF of the default law": prediction.median,
                "95 % from": low,
                "to": high,
            }
        )
    title = "Mean COF over the speeds by the law of the pair, fitted without the report's readings"
    return StudyTable.of("default_law", title, rows)


def _default_conclusions(default: Mapping[str, DefaultPrediction]) -> tuple[str, ...]:
    ratios = np.log(
        [prediction.points.cof.mean() / prediction.median for prediction in default.values()]
    )
    widths = [
        np.subtract(*np.log(np.quantile(prediction.mean, [0.975, 0.025])))
        for prediction in default.values()
    ]
    return (
        "The law of the pair, which no reading of the report's laboratory has entered: mean COF of "
        f"ten pairs within a factor of {math.exp(np.abs(ratios).max()):.2f} of the printed ones, "
        f"{math.exp(math.sqrt(np.mean(ratios**2))):.2f} on average. Its 95 % interval spans a "
        f"factor of {math.exp(np.median(widths)):.0f}: the level of one laboratory's pair is not "
        "known better than that before a reading of it.",
    )


def _means(comparison: MechanismComparison) -> dict[str, ComputedQuantity]:
    """Return mean COF over the speeds, predicted with COF_BL and from the viscosity alone."""
    found = {}
    for k, inputs in enumerate(INPUTS):
        for prediction in comparison.chosen.fluids[k].predictions:
            found[f"mean.{inputs}.{prediction.points.fluid}"] = ComputedQuantity.of(
                prediction.cof.mean()
            )
        for prediction in comparison.chosen.roughness[k].predictions:
            one = prediction.points
            share = one.fluid.removeprefix("glycerol_").removesuffix("pct")
            name = f"rough.{inputs}.{share}_{1e6 * one.rq:.1f}"
            found[name] = ComputedQuantity.of(prediction.cof.mean())
    return found


def _decay(fluids: Mapping[str, BoundaryFriction]) -> dict[str, ComputedQuantity]:
    """Return tau (m/s) of each fitted fluid from viscosity x tau of the others."""
    fitted = [fluid for fluid in fluids.values() if fluid.tau_hydro is not None]
    found = {}
    for friction in fitted:
        rest = viscous_decay([other for other in fitted if other is not friction])
        found[f"tau.{friction.fluid}"] = ComputedQuantity.of(
            float(rest) / friction.viscosity,
            "m/s",
            deviation=(rest.uncertainty or 0.0) / friction.viscosity,
            scale="log",
        )
    return found


def intervals(
    comparison: MechanismComparison, test: BlindTest, samples: int, seed: int
) -> Propagated:
    """Return the predictions of all fluids with 95 % intervals, (fluids, speeds).

    Drawn are the three published numbers of 50 % glycerol with their spreads (each draw is
    calibrated anew), COF_BL of the fluid where it is an input, and the model's own error.
    """
    base, given = comparison.points[CALIBRATION_FLUID], comparison.fluids[CALIBRATION_FLUID]
    assert given.tau_hydro is not None
    assert given.cof_asymptote is not None
    inputs: dict[str, SourcedValue] = {"cof_bl": given.cof_boundary}
    inputs |= {"tau": given.tau_hydro, "asymptote": given.cof_asymptote}
    for name, point in comparison.points.items():
        if point.cof_boundary is not None and name != CALIBRATION_FLUID:
            inputs[name] = comparison.fluids[name].cof_boundary

    def all_fluids(values: Mapping[str, float]) -> np.ndarray:
        cof = stribeck_cof(base.speed, values["cof_bl"], values["tau"], values["asymptote"])
        drawn = replace(base, cof=np.asarray(cof), cof_boundary=None, label="")
        fit = calibrated_mechanism(test.mechanism, (drawn,), comparison.pin).values
        found = []
        for name, point in comparison.points.items():
            own = values.get(name)
            point = replace(point, cof_boundary=own)
            found.append(
                predict_cof(
                    test.mechanism, fit, point, comparison.pin, own_boundary=own is not None
                )
            )
        return np.array(found)

    return propagate_spread(
        all_fluids, inputs, model_deviation=test.deviation, samples=samples, seed=seed, shares=False
    )


def _coverage(points_of: Mapping[str, CofPoints], spread: Propagated) -> float:
    inside = [
        np.mean((cof_points.cof >= spread.low[i]) & (cof_points.cof <= spread.high[i]))
        for i, (name, cof_points) in enumerate(points_of.items())
        if name != CALIBRATION_FLUID
    ]
    return float(np.mean(inside))


def master_curve(
    chosen_points: Sequence[CofPoints], pin: Pin
) -> tuple[tuple[np.ndarray, np.ndarray], dict[str, float]]:
    """Return Fig. 16's one curve of viscosity x speed (Pa m) fitted to all fluids, and its fit."""
    from scipy.optimize import isotonic_regression

    from .mechanisms import mechanism

    chosen = mechanism("asperity_ehl")
    fit = calibrated_mechanism(chosen, tuple(chosen_points), pin)
    product = np.geomspace(0.52e-3 * 0.03, 74.6e-3 * 1.2, 200)
    one = CofPoints("", 1.0, product, product, "fit", pin.sole_rq, None)
    curve = predict_cof(chosen, fit.values, one, pin, own_boundary=False)
    place = np.concatenate([p.viscosity * p.speed for p in chosen_points])
    cof = np.concatenate([p.cof for p in chosen_points])
    order = np.argsort(place)
    best = np.asarray(isotonic_regression(cof[order], increasing=False).x)
    return (product, curve), {
        "mean_absolute": fit.mean_absolute_error,
        "best_possible": float(np.mean(np.abs(best - cof[order]))),
        "r_squared": 1 - float(np.sum(fit.residuals**2) / np.sum((cof - cof.mean()) ** 2)),
    }


def lambda_ratios(comparison: MechanismComparison, count: int = 30) -> dict[str, np.ndarray]:
    """Return film over roughness (Eq. 18, 21) of each fluid from 0.05 to 1 m/s, (count,)."""
    pin = comparison.pin
    sigma = float(np.hypot(pin.sole_rq, pin.floor_rq))
    speeds = np.geomspace(0.05, 1.0, count)
    film = {"load": pin.normal_force, "radius": pin.radius, "effective_modulus": pin.modulus}
    return {
        name: np.array(
            [
                soft_ehl_film(
                    viscosity=comparison.points[name].viscosity, entrainment_speed=float(v), **film
                )[1]
                / sigma
                for v in speeds
            ]
        )
        for name in LABELS
    }


def _mechanism_table(comparison: MechanismComparison) -> StudyTable:
    rows = []
    for name, test in comparison.tests.items():
        given = test.calibration.parameters.get("parameter")
        number = "-" if given is None or given.value is None else display(given.value, given.unit)
        rows.append(
            {
                "mechanism": name,
                "what it is": test.mechanism.label,
                "calibrated": number,
                "50 % glycerol": test.calibration.mean_absolute_error,
                "5 fluids, COF_BL": test.fluids[0].error,
                "5 fluids, viscosity": test.fluids[1].error,
                "Table 3, COF_BL": test.roughness[0].error,
                "Table 3, viscosity": test.roughness[1].error,
                "1 from 5": test.one_from_five,
            }
        )
    return StudyTable.of(
        "mechanisms",
        "Mean absolute error of COF. On 50 % glycerol: of the fit itself; 5 fluids and Table 3: "
        "predicted with COF_BL as input or from viscosity alone; 1 from 5: each fluid by viscosity "
        f"from a fit to the other five (StribeckLaw by the same rule: {comparison.peer:.3f})",
        rows,
    )


def _fluid_table(comparison: MechanismComparison) -> StudyTable:
    rows = [
        {
            "mechanism": name,
            "input": inputs,
            **{LABELS[p.points.fluid]: p.error for p in test.fluids[k].predictions},
            "all five": test.fluids[k].error,
        }
        for name, test in comparison.tests.items()
        for k, inputs in enumerate(("COF_BL", "viscosity"))
    ]
    return StudyTable.of("fluids", "Mean absolute error of COF over the 11 speeds, by fluid", rows)


def _curve_table(comparison: MechanismComparison, spread: Propagated) -> StudyTable:
    rows = [
        {
            "fluid": LABELS[name],
            "viscosity mPa s": 1e3 * cof_points.viscosity,
            "speed m/s": cof_points.speed[k],
            "published": cof_points.cof[k],
            "as": cof_points.curve,
            "predicted": spread.value[i, k],
            "low": spread.low[i, k],
            "high": spread.high[i, k],
        }
        for i, (name, cof_points) in enumerate(comparison.points.items())
        for k in range(cof_points.speed.size)
    ]
    title = "COF of each fluid: published (fit of Eq. 17 or mean) and predicted, 95 %"
    return StudyTable.of("curves", title, rows)


def _conclusions(comparison: MechanismComparison, fit: Mapping[str, float]) -> tuple[str, ...]:
    tests = comparison.tests

    def error(name: str) -> str:
        return f"{tests[name].fluids[0].error:.3f}"

    def number(name: str) -> float:
        return tests[name].calibration.values["parameter"]

    return (
        f"Rejected: area lost to stiffening rubber ({error('viscoelastic_area')}; it knows no "
        f"fluid) and the film of the pin against the measured roughness of both surfaces "
        f"({error('mean_film_both')} and, with the report's own film, "
        f"{error('mean_film_both_printed')}).",
        f"Supported: films at asperities ({error('asperity_ehl')}), with a fine roughness of "
        f"{1e9 * number('asperity_ehl'):.0f} nm. The self-affine spectrum, continued below the "
        "stylus' resolution, would have 83 nm: the number is calibrated, not predicted.",
        "These data do not tell three explanations apart: the film of the pin against a "
        f"roughness of {1e6 * number('mean_film_free'):.2f} um ({error('mean_film_free')}; "
        "measured: 8.3 um both, 1.34 um the floor); the floor's roughness with the report's film "
        f"({error('mean_film_floor_printed')}, nothing of the film calibrated; with half the "
        f"sliding speed and E' = 2 E*: {error('mean_film_floor')}); and a formula without "
        f"mechanism ({error('one_constant')}). Differences of 0.002 mean nothing where COF_BL is "
        "known to 0.03.",
        "What would decide: a change of the pin's radius or load (a film of the pin follows it, a "
        "film of asperities does not), or of the floor's roughness.",
        f"For a fluid of which only the viscosity is known, films at asperities "
        f"({tests['asperity_ehl'].one_from_five:.3f}) and StribeckLaw ({comparison.peer:.3f}) are "
        "equally good.",
        f"One curve of viscosity x speed through the published fits leaves "
        f"{fit['mean_absolute']:.3f} on average; the best falling curve there is leaves "
        f"{fit['best_possible']:.3f}.",
    )


def _master_figure(
    points_of: Mapping[str, CofPoints],
    master: tuple[np.ndarray, np.ndarray],
    fit: Mapping[str, float],
) -> Figure:
    above = [line(1e3 * master[0], master[1], "one curve, all fluids", colour="0.1")]
    below = [Layer("level", y=0.0, colour="0.1")]
    for i, (name, cof_points) in enumerate(points_of.items()):
        place = cof_points.viscosity * cof_points.speed
        style = {"colour": COLOURS[i], "marker": MARKERS[i]}
        label = LABELS[name] + (" (mean)" if cof_points.curve == "mean" else "")
        above.append(points(1e3 * place, cof_points.cof, label, **style))
        fitted = np.interp(np.log(place), np.log(master[0]), master[1])
        below.append(points(1e3 * place, cof_points.cof - fitted, **style))
    axis: dict[str, Any] = {"x_label": "viscosity × speed (mPa m)", "x_scale": "log"}
    title = f"mean residual {fit['mean_absolute']:.3f}, R² {fit['r_squared']:.2f}"
    label = "COF (published fits and means)"
    return Figure(
        (
            Panel(above, y_label=label, title=title, y_limits=(0.0, None), **axis),
            Panel(below, y_label="published − curve", legend="", **axis),
        ),
        "Fig. 16: all fluids over viscosity × speed",
        columns=2,
        size=(5.2, 4.0),
    )


def _blind_figure(points_of: Mapping[str, CofPoints], spread: Propagated) -> Figure:
    panels = []
    for i, (name, cof_points) in enumerate(points_of.items()):
        own = name == CALIBRATION_FLUID
        colour = GREY if own else OURS
        error = float(np.mean(np.abs(spread.value[i] - cof_points.cof)))
        what = "calibrated on" if own else f"error {error:.3f}"
        mean = ", published mean" if cof_points.curve == "mean" else ""
        layers = (
            Layer("band", cof_points.speed, low=spread.low[i], high=spread.high[i], colour=colour),
            line(cof_points.speed, spread.value[i], colour=colour),
            points(cof_points.speed, cof_points.cof, colour=PRINTED),
        )
        title = f"{LABELS[name]}: {what}{mean}"
        panels.append(Panel(layers, "sliding speed (m/s)", "COF", title, y_limits=(0.0, None)))
    return Figure(
        panels,
        "Films at asperities: line and 95 % interval; points: published fits of Eq. 17",
        columns=3,
        size=(3.4, 2.8),
        share_x=True,
        share_y=True,
    )


def _default_figure(default: Mapping[str, DefaultPrediction]) -> Figure:
    panels = []
    for name, label in LABELS.items():
        one = default[name]
        layers = (
            Layer("band", one.points.speed, low=one.low, high=one.high, colour=OURS, label="95 %"),
            line(one.points.speed, one.cof, "law of the pair"),
            points(one.points.speed, one.points.cof, "report", colour=PRINTED, marker="o"),
        )
        mean = ", published mean" if one.points.curve == "mean" else ""
        panels.append(
            Panel(
                layers,
                "sliding speed (m/s)",
                "COF",
                f"{label}{mean}",
                y_scale="log",
                y_limits=(0.03, 2.0),
                legend="best" if name == "water_g2" else "",
            )
        )
    return Figure(
        panels,
        "Fig. 17: the default law of a case, fitted without any reading of the report",
        columns=3,
        size=(3.4, 2.8),
        share_x=True,
        share_y=True,
    )


def _example_figure(
    comparison: MechanismComparison, default: Mapping[str, DefaultPrediction]
) -> Figure:
    """Return Fig. 14: the example's printed fit, the same condition in Table 3, and ours."""
    prediction = default["glycerol_25pct"]
    speed = np.linspace(0.05, 1.0, 60)
    fluid = comparison.fluids["glycerol_25pct"]
    boundary, spread = float(fluid.cof_boundary), fluid.cof_boundary.uncertainty or 0.0
    layers = (
        Layer(
            "band",
            prediction.points.speed,
            low=prediction.low,
            high=prediction.high,
            label="law of the pair, 95 %",
        ),
        line(prediction.points.speed, prediction.cof, "law of the pair"),
        line(
            speed,
            stribeck_cof(speed, *EXAMPLE),
            "printed fit of the example (Fig. 14)",
            colour=PRINTED,
        ),
        points(
            prediction.points.speed,
            prediction.points.cof,
            "printed fit of the condition (Table 3)",
            colour=PRINTED,
            marker="o",
        ),
        points(
            [0.0],
            [boundary],
            f"COF_BL {boundary:g} ± {spread:g} (printed)",
            low=[boundary - spread],
            high=[boundary + spread],
            colour=PRINTED,
            marker="s",
        ),
    )
    panel = Panel(layers, "sliding speed (m/s)", "COF", y_limits=(0.0, 1.05))
    title = "Fig. 14: 25 % glycerol, sole Rq 8.2 µm; the report prints no single readings"
    return Figure([panel], title, size=(6.8, 4.4))


def _profile_figure(pin: Pin) -> Figure:
    """Return Fig. 15: the parabola h = B r^2 whose R' = 1 / (2 B) the report prints."""
    r = np.linspace(-5e-3, 5e-3, 101)
    layers = []
    for radius, label, colour, style in (
        (pin.radius, f"R' = {1e3 * pin.radius:.1f} mm (used)", OURS, "-"),
        (2 * pin.radius, "twice and half of it", GREY, ":"),
        (0.5 * pin.radius, "", GREY, ":"),
    ):
        layers.append(line(1e3 * r, 1e6 * r**2 / (2 * radius), label, colour=colour, style=style))
    panel = Panel(layers, "distance from the pin's middle (mm)", "height (µm)")
    title = "Fig. 15: profile of the pin by Eq. 19 and 20; the scan itself is in the figure only"
    return Figure([panel], title, size=(6.2, 3.8))


def _error_figure(comparison: MechanismComparison) -> Figure:
    tests = list(comparison.tests.values())[::-1]
    layers = [
        Layer(
            "across",
            [test.fluids[k].error for test in tests],
            np.arange(len(tests)) + side,
            label=label,
            colour=colour,
            width=0.36,
        )
        for k, side, label, colour in (
            (0, 0.19, "with COF_BL where measured", OURS),
            (1, -0.19, "viscosity only", "#9dc3dc"),
        )
    ]
    label = "mean absolute error of COF, five fluids not calibrated on"
    panel = Panel(layers, label, y_ticks=[test.mechanism.label for test in tests])
    return Figure([panel], "All mechanisms", size=(8.2, 5.0))


def _levels_figure(fluids: Mapping[str, BoundaryFriction]) -> Figure:
    decay = viscous_decay([fluid for fluid in fluids.values() if fluid.tau_hydro is not None])
    left, right = [], []
    for k, (name, label) in enumerate(LABELS.items()):
        one = fluids[name]
        rest, error = float(one.cof_boundary), one.cof_boundary.uncertainty or 0.0
        ends: dict[str, Any] = {"low": rest - error, "high": rest + error}
        left.append(Layer("bars", k, rest, **ends, colour=COLOURS[k], width=0.7))
        if one.tau_hydro is not None:
            tau, spread = float(one.tau_hydro), one.tau_hydro.uncertainty or 0.0
            ends = {"low": tau - spread, "high": tau + spread}
            style = {"colour": COLOURS[k], "marker": "o"}
            right.append(points(1e3 * one.viscosity, tau, label, **ends, **style))
    x = np.geomspace(0.4, 8, 50)
    product = 1e3 * float(decay)
    right.append(line(x, product / x, f"viscosity × tau = {product:.2f} mPa m", colour="0.3"))
    return Figure(
        (
            Panel(
                left, y_label="COF at rest (printed ± sd)", x_ticks=[*LABELS.values()], legend=""
            ),
            Panel(
                right,
                "viscosity (mPa s)",
                "decay speed tau (m/s)",
                x_scale="log",
                x_ticks=(0.5, 1, 2, 4, 8),
                y_limits=(0.0, None),
            ),
        ),
        "Fig. 18 and 20: friction at rest and decay speed; one product fits all four",
        columns=2,
        size=(5.4, 3.8),
    )


def _film_figure(lambdas: Mapping[str, np.ndarray]) -> Figure:
    speeds = np.geomspace(0.05, 1.0, len(next(iter(lambdas.values()))))
    layers = [
        line(speeds, values, LABELS[name], colour=COLOURS[k])
        for k, (name, values) in enumerate(lambdas.items())
    ]
    layers.append(
        Layer("level", y=1.0, label="boundary below, mixed above", colour="0.5", style="--")
    )
    panel = Panel(layers, "speed (m/s)", "film over roughness, lambda", y_limits=(0.0, None))
    title = "Fig. 19: film of the pin by Eq. 18 (W = w / (E' R'²), R' in mm)"
    return Figure([panel], title, size=(6.6, 4.4))
