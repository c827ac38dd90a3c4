"""Figures of laws and tables: friction over speed, pressure over gap, contact, slip, relaxation."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from underfoot.core.html import new_figure
from underfoot.friction import UncertainInputs
from underfoot.friction.law import PIN_PRESSURE
from underfoot.material import RelaxationSpectrum
from underfoot.rough_contact import ContactTable, SteadySliding
from underfoot.rough_contact.pressure_gap_law import _PresentableLaw
from underfoot.slip import SlipRisk, slip_model
from underfoot.slip._checks import PresentableModel
from underfoot.surface import Profile, Scan, level_surface

from .dispatch import figures

THICK_FILM = 1e-3  # m: the viscous part is next to nothing
Draw = Callable[[Any, Figure], None]


def _draws(
    kind: type, name: str, width: float = 6.4, height: float = 4.0
) -> Callable[[Draw], Draw]:
    """Register a function that draws an object of a type into a figure (inches) of a name."""

    def register(draw: Draw) -> Draw:
        def make(shown: Any) -> Figure:
            figure = new_figure(width, height)
            draw(shown, figure)
            return figure

        figures.register(kind, lambda shown: {name: partial(make, shown)})
        return draw

    return register


@_draws(UncertainInputs, "cof")
def _friction_law(law: Any, figure: Figure) -> None:
    """COF of the contact over sliding speed, adhesion on hysteresis."""
    speed = np.geomspace(1e-2, 2.0, 200)
    parts = law(np.full(speed.size, PIN_PRESSURE), speed, np.full(speed.size, THICK_FILM))
    hysteresis = parts.hysteresis / PIN_PRESSURE
    cof = hysteresis + parts.adhesion / PIN_PRESSURE
    axes = figure.subplots()
    axes.fill_between(speed, 0.0, hysteresis, alpha=0.5, label="hysteresis")
    axes.fill_between(speed, hysteresis, cof, alpha=0.5, label="adhesion")
    axes.plot(speed, cof, "k")
    axes.set(xscale="log", xlabel="Sliding speed, m/s", ylabel="COF of the contact")
    axes.set(title=f"{law.name}, {PIN_PRESSURE * 1e-3:.0f} kPa", ylim=(0.0, None))
    axes.legend()


@_draws(_PresentableLaw, "pressure")
def _pressure_gap_law(law: Any, figure: Figure) -> None:
    """Contact pressure and flow factor over the mean gap."""
    gap = np.linspace(0.0, 1.2 * float(law.mean_gap(1e3)), 300)
    axes = figure.subplots()
    axes.semilogy(1e6 * gap, law.pressure(gap), "k", label="contact pressure")
    axes.set(xlabel="Mean gap, µm", ylabel="Contact pressure, Pa", title=law.name)
    right = axes.twinx()
    right.plot(1e6 * gap, law.flow_factor(gap), "C0--")
    right.set_ylabel("Flow factor (dashed)", color="C0")
    right.set_ylim(0.0, 1.1)


@_draws(ContactTable, "contact", 9.6, 3.4)
def _contact_table(table: ContactTable, figure: Figure) -> None:
    """Real contact fraction, hysteresis COF and mean gap over pressure, a line a speed."""
    quantities = (
        ("real_contact_fraction", 1.0, "Real contact fraction"),
        ("cof_hysteresis", 1.0, "Hysteresis COF"),
        ("mean_gap", 1e6, "Mean gap, µm"),
    )
    pressure = 1e-3 * table.pressure
    ticks = pressure[:: max(1, pressure.size // 4)]
    panels = figure.subplots(1, 3)
    for axes, (name, scale, label) in zip(panels, quantities, strict=True):
        for column, speed in enumerate(table.speed):
            spread = scale * np.nan_to_num(table.deviation[name][:, column])
            values = scale * table.values[name][:, column]
            axes.errorbar(pressure, values, spread, fmt=".-", label=f"{speed:g} m/s")
        axes.set(xscale="log", xlabel="Pressure, kPa", ylabel=label)
        axes.set_xticks(ticks, [f"{tick:.3g}" for tick in ticks])
        axes.xaxis.set_minor_locator(NullLocator())
    panels[-1].legend(fontsize=8)


@_draws(SteadySliding, "contact", 8.0, 3.6)
def _steady_sliding(contact: SteadySliding, figure: Figure) -> None:
    """Maps of contact pressure and gap, sliding to the right."""
    maps = (1e-6 * np.asarray(contact.pressure), 1e6 * np.asarray(contact.gap))
    labels = ("Contact pressure, MPa", "Gap, µm")
    for axes, values, label in zip(figure.subplots(1, 2), maps, labels, strict=True):
        image = axes.imshow(values.T, origin="lower")
        axes.set(xlabel="node along sliding", ylabel="node across")
        figure.colorbar(image, ax=axes, label=label)


@_draws(PresentableModel, "probability")
def _slip_model(model: Any, figure: Figure) -> None:
    """Probability of a slip over ACOF - RCOF, the tested range shaded where there is one."""
    rcof, difference = 0.3, np.linspace(-0.2, 0.2, 401)
    axes = figure.subplots()
    axes.plot(difference, 100.0 * model(rcof + difference, rcof), "k")
    tested = getattr(model, "tested", None)
    if tested is not None:
        axes.axvspan(tested.low, tested.high, color="C0", alpha=0.2, label="tested range")
        axes.legend()
    axes.set(xlabel="ACOF - RCOF", ylabel="Probability of a slip, %", title=model.name)


@_draws(SlipRisk, "probability")
def _slip_risk(risk: SlipRisk, figure: Figure) -> None:
    """The population's probability over ACOF, with the one asked for."""
    acof = np.linspace(0.0, 0.6, 301)
    share = slip_model(risk.model).population(acof, risk.rcof.mean, risk.rcof.sd)
    axes = figure.subplots()
    axes.plot(acof, 100.0 * share, "k")
    axes.axhline(100.0 * float(risk.probability), color="C1", label="this risk")
    if risk.low is not None and risk.high is not None:
        axes.axhspan(100.0 * risk.low, 100.0 * risk.high, color="C1", alpha=0.2)
    axes.set(xlabel="Available COF", ylabel="Probability of a slip, %", title=risk.model)
    axes.legend()


@_draws(Scan, "scan", 9.6, 3.6)
def _scan(scan: Scan, figure: Figure) -> None:
    """Heights, and the spectrum with the power law that continues it."""
    left, right = figure.subplots(1, 2, width_ratios=(1.2, 1))
    heights = 1e6 * level_surface(scan.surface).heights
    if isinstance(scan.surface, Profile):
        left.plot(1e3 * scan.surface.positions, heights, lw=0.8)
        left.set(xlabel="Position, mm", ylabel="Height, µm")
    else:
        sides = [1e3 * side for side in scan.surface.size]
        image = left.imshow(heights.T, origin="lower", extent=(0, sides[0], 0, sides[1]))
        left.set(xlabel="x, mm", ylabel="y, mm")
        figure.colorbar(image, ax=left, label="Height, µm")
    low, high = scan.spectrum.reliable
    q = np.geomspace(low / 3, 3 * high, 300)
    right.loglog(2e3 * np.pi / q, scan.density(q), "k--", lw=1, label="taken on by its power law")
    inside = (q >= low) & (q <= high)
    right.loglog(2e3 * np.pi / q[inside], scan.density(q[inside]), "C0", label="measured")
    right.axvline(1e3 * scan.cutoff, color="0.6", lw=0.8, ls=":", label="cut-off of Ra, Rq")
    right.invert_xaxis()
    right.set_title(f"Hurst {scan.hurst.value:.2f}")
    right.set(xlabel="Wavelength, mm", ylabel="C(q), m⁴")
    right.legend(fontsize=8)


@_draws(RelaxationSpectrum, "modulus")
def _relaxation_spectrum(spectrum: RelaxationSpectrum, figure: Figure) -> None:
    """Storage and loss modulus over frequency."""
    times = spectrum.relaxation_times if len(spectrum) else np.ones(1)
    frequency = np.geomspace(0.01 / times.max(), 100.0 / times.min(), 300)
    axes = figure.subplots()
    axes.loglog(frequency, spectrum.storage_modulus(frequency), label="storage modulus E'")
    axes.loglog(frequency, spectrum.loss_modulus(frequency), label="loss modulus E''")
    axes.set(xlabel="Angular frequency, rad/s", ylabel="Modulus, Pa")
    axes.legend()
