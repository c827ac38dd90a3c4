"""Figures of a compound: sweeps, relaxation, shift factors and the hold, each with its fit."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from underfoot.calibrate.compound import Compound
from underfoot.core.html import new_figure

from .dispatch import FigureMakers, figures


@figures.register(Compound)
def _(shown: Compound) -> FigureMakers:
    makers = {
        "sweep": (_sweep, shown.sweep is not None),
        "relaxation": (_relaxation, shown.relaxation is not None),
        "shift_factors": (_shifts, shown.shifts is not None),
        "hold": (_hold, bool(shown.compressions)),
    }
    return {name: partial(draw, shown) for name, (draw, present) in makers.items() if present}


def _sweep(shown: Compound) -> Figure:
    """Storage and loss modulus and loss tangent over frequency, with the band of the fit."""
    figure = new_figure(9.6, 4.0)
    left, right = figure.subplots(1, 2)
    measured, fit = shown.sweep, shown.fit
    assert measured is not None
    assert fit is not None
    w = measured.angular_frequency
    fine = np.geomspace(w.min(), w.max(), 200)
    band, hertz = fit.band(fine), fine / (2 * math.pi)
    own = w / (2 * math.pi)
    tangent = measured.loss_modulus / measured.storage_modulus
    left.loglog(own, measured.storage_modulus / 1e6, "C0.", ms=4, label="storage, measured")
    left.loglog(own, measured.loss_modulus / 1e6, "C1.", ms=4, label="loss, measured")
    left.loglog(hertz, fit.spectrum.storage_modulus(fine) / 1e6, "C0")
    left.loglog(hertz, fit.spectrum.loss_modulus(fine) / 1e6, "C1")
    left.fill_between(hertz, band.loss_low / 1e6, band.loss_high / 1e6, color="C1", alpha=0.3)
    left.set(xlabel="Frequency, Hz", ylabel="Young's modulus, MPa", title="Lines: fit, 95 % band")
    left.legend(fontsize=8)
    right.semilogx(own, tangent, "k.", ms=4, label="measured")
    right.semilogx(hertz, fit.spectrum.loss_tangent(fine), "C3", label="fit")
    right.set(xlabel="Frequency, Hz", ylabel="Loss tangent", ylim=(0, 1.2 * tangent.max()))
    right.legend(fontsize=8)
    return figure


def _relaxation(shown: Compound) -> Figure:
    """Young's modulus over time, measured and of the spectrum."""
    figure = new_figure(6.4, 4.0)
    axes, measured = figure.subplots(), shown.relaxation
    assert measured is not None
    assert shown.spectrum is not None
    axes.semilogx(measured.time, measured.modulus / 1e6, "k.", ms=4, label="measured")
    values = shown.spectrum.relaxation_modulus(measured.time)
    label = "fit" if shown.sweep is None else "spectrum of the sweep"
    axes.semilogx(measured.time, values / 1e6, "C0", label=label)
    axes.set(xlabel="Time, s", ylabel="Young's modulus, MPa", ylim=(0, None))
    axes.legend(fontsize=8)
    return figure


def _shifts(shown: Compound) -> Figure:
    """Shift factors over temperature with the law through them."""
    figure = new_figure(6.4, 4.0)
    axes, table = figure.subplots(), shown.shifts
    assert table is not None
    celsius = table.temperatures - 273.15
    axes.errorbar(celsius, table.log10_shift_factors, table.log10_errors, fmt="k.", label="shifts")
    fine = np.linspace(table.temperatures[0], table.temperatures[-1], 200)
    law = table.law
    axes.plot(fine - 273.15, law.log10_shift_factor(fine), "C0", label=str(law))
    axes.set(xlabel="Temperature, °C", ylabel="log10 of the shift factor")
    axes.legend(fontsize=8)
    return figure


def _hold(shown: Compound) -> Figure:
    """Force of every compression test over time, with the three forces of Eq. 13 and 15."""
    figure = new_figure(6.4, 4.0)
    axes = figure.subplots()
    for number, test in enumerate(shown.compressions):
        reading, color = test.reading, f"C{number}"
        axes.plot(reading.time, reading.force, color, lw=1, label=test.name)
        for force in (reading.force_2_percent, reading.peak_force, reading.final_force):
            axes.axhline(float(force), color=color, ls=":", lw=0.9)
    axes.set(xlabel="Time, s", ylabel="Force, N", title="Dotted: force at 2 %, peak, end of hold")
    axes.legend(fontsize=8)
    return figure
