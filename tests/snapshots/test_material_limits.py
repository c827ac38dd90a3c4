"""Rubbers: units and names in tables, numbers that are none, and fits of random spectra."""

import math
from dataclasses import replace

import numpy as np
import pytest

from snapshot import held, refusal, tried
from underfoot.core import InputError
from underfoot.material.curves import DynamicSweep, RelaxationCurve, checked_curve, minimum_on
from underfoot.material.elastomer import Elastomer, bulk_modulus, shear_modulus
from underfoot.material.gent_1958 import gent_breaches, shore_a_gent, youngs_modulus_gent
from underfoot.material.master_curve import (
    ArrheniusShift,
    WlfShift,
    best_shift,
    common_polynomial_cost,
    dynamic_master_curve,
    fit_arrhenius,
    fit_wlf,
    own_scatter,
    relaxation_master_curve,
)
from underfoot.material.read import read_rubber
from underfoot.material.spectrum import RelaxationSpectrum
from underfoot.material.spectrum_fit import fit_dynamic, fit_relaxation, reduce_spectrum
from underfoot.material.tables import FileColumn, FileTable, heading_of, quantity_of, read_tables

# numbers that are none


@pytest.mark.parametrize("wrong", [math.nan, math.inf, 0.0, -1.0])
def test_moduli_and_densities_are_finite_and_positive(wrong):
    with pytest.raises(InputError):
        Elastomer(wrong)
    with pytest.raises(InputError):
        Elastomer(1e6, density=wrong)
    for call in (
        lambda: RelaxationSpectrum(1e6, [1e6], [wrong]),
        lambda: RelaxationSpectrum(1e6, [1e6], [1.0]).scale_moduli(wrong),
        lambda: RelaxationSpectrum(1e6, [1e6], [1.0]).shift_times(wrong),
        lambda: shore_a_gent(wrong),
    ):
        with pytest.raises(Exception, match=r"\w"):
            call()
    if wrong != 0.0:
        with pytest.raises(InputError):
            RelaxationSpectrum(1e6, [wrong], [1.0])
        with pytest.raises(InputError):
            RelaxationSpectrum(wrong, [1e6], [1.0])


def test_what_is_just_allowed():
    assert Elastomer(1e-3, 0.5, density=1e-9).modulus == 1e-3
    assert RelaxationSpectrum(0.0, [1.0, 0.0], [1e-9, 1e9]).instantaneous_modulus == 1.0
    assert shear_modulus(3.0, 0.5) == pytest.approx(1.0)
    assert bulk_modulus(3.0, 0.49) == pytest.approx(3.0 / (3 * 0.02))
    assert [len(gent_breaches(shore)) for shore in (39.9, 40.0, 80.0, 80.1)] == [1, 0, 0, 1]
    lowest = float(youngs_modulus_gent(0.0))
    assert shore_a_gent(lowest) == 0.0
    assert "Shore A 0" in refusal(shore_a_gent, 0.999 * lowest)


def test_spectra_by_hand():
    one = RelaxationSpectrum(1e6, [2e6], [0.5], source="s")
    assert one.relaxation_modulus(0.5) == pytest.approx(1e6 + 2e6 / math.e)
    # at w tau = 1 half of the term is stored and half of it lost
    assert one.complex_modulus(2.0) == pytest.approx(2e6 + 1e6j)
    assert one.complex_modulus(-2.0) == pytest.approx(2e6 - 1e6j)
    assert one.loss_tangent(2.0) == pytest.approx(0.5)
    assert one.shift_times(10.0).complex_modulus(0.2) == pytest.approx(one.complex_modulus(2.0))
    assert one.scale_moduli(3.0).complex_modulus(2.0) == pytest.approx(6e6 + 3e6j)
    assert (one.scale_moduli(2.0).source, one.scale_moduli(2.0, source="t").source) == ("s", "t")
    assert len(replace(one, equilibrium_modulus=0.0).cautions()) == 1


# curves


@pytest.mark.parametrize(
    ("values", "taken"),
    [([1, 2, 3, 4], True), ([1, 2, 3, 0.0], False), ([1, 2, 3, -1], False),
     ([1, 2, 3, math.inf], False), ([1, 2, 3, 1e-300], True)],
)  # fmt: skip
def test_curves_hold_positive_numbers(values, taken):
    for x, y in (([1, 2, 3, 4], values), (sorted(values), [1, 2, 3, 4])):
        told = tried(checked_curve, x, y)
        assert isinstance(told, str) is not taken


def test_least_values_of_a_grid_are_refined_between_its_neighbours():
    grid = np.linspace(0.0, 1.0, 5)
    for least in (0.0, 0.13, 0.5, 0.87, 1.0):
        found = minimum_on(grid, lambda x, at=least: (x - at) ** 2, 1e-10)
        assert found == pytest.approx(least, abs=1e-5)


def test_shifts_by_hand(file_regression):
    rng = np.random.default_rng(2)
    x, other = np.linspace(0, 3, 12), np.linspace(0.4, 3.1, 9)

    def curve(at):
        return np.array([6 + 0.3 * at + 0.02 * at**2, 5 + 0.5 * at - 0.04 * at**3])

    told = {}
    for name, shift, noise in (("plain", 0.7, 0.0), ("back", -1.1, 0.0), ("noisy", 0.7, 0.01)):
        y, y_other = curve(x), curve(other + shift)
        y, y_other = (v + noise * rng.normal(size=v.shape) for v in (y, y_other))
        found = best_shift(x, y, other, y_other)
        assert found[0] == pytest.approx(shift, abs=0.1 if noise else 1e-3)
        told[name] = found, own_scatter(x, y), common_polynomial_cost(shift, x, y, other, y_other)
    told["few"] = [own_scatter(x[:n], curve(x[:n])) for n in (3, 4, 5, 6)]
    told["low degree"] = common_polynomial_cost(0.5, x[:3], curve(x[:3]), x[:3], curve(x[:3] + 0.5))
    held(file_regression, told)


@pytest.mark.parametrize("seed", range(3))
def test_laws_of_shifts_are_found_again(seed):
    rng = np.random.default_rng(seed)
    kelvin = np.sort(280 + 60 * rng.random(6))
    wlf = WlfShift(4 + 10 * rng.random(), 60 + 90 * rng.random(), 300.0)
    found = fit_wlf(kelvin, wlf.log10_shift_factor(kelvin), 300.0)
    assert (found.c1, found.c2) == pytest.approx((wlf.c1, wlf.c2), rel=1e-3)
    assert found.tested == (kelvin[0], kelvin[-1])
    own = ArrheniusShift(5e4 + 1e5 * rng.random(), 310.0)
    energy = fit_arrhenius(kelvin, own.log10_shift_factor(kelvin), 310.0)
    assert energy.activation_energy == pytest.approx(own.activation_energy)
    assert own.log10_shift_factor(320.0) == pytest.approx(
        own.activation_energy / 8.314462618 / math.log(10) * (1 / 320 - 1 / 310)
    )
    assert wlf.log10_shift_factor(300.0 + wlf.c2) == pytest.approx(-wlf.c1 / 2)
    noisy = wlf.log10_shift_factor(kelvin) + 0.1 * rng.normal(size=6)
    for fit in (fit_wlf, fit_arrhenius):
        law = fit(kelvin, noisy, 300.0)
        off = law.log10_shift_factor(kelvin) - noisy
        assert law.rms == pytest.approx(float(np.sqrt(np.mean(off**2))))


def spectrum(rng) -> RelaxationSpectrum:
    count = int(rng.integers(2, 6))
    return RelaxationSpectrum(
        1e6 * rng.random() + 1e5, 1e6 * rng.random(count), 10.0 ** rng.uniform(-3, 2, count)
    )


def test_fits_of_random_spectra(file_regression):
    told = {}
    for seed in range(5):
        rng = np.random.default_rng(40 + seed)
        one = spectrum(rng)
        w, t = np.geomspace(0.02, 2e3, 24), np.geomspace(1e-3, 50, 30)
        noise = 1 + rng.choice([0.0, 0.02]) * rng.normal(size=(3, 30))
        dynamic = fit_dynamic(w, one.storage_modulus(w) * noise[0, :24],
                              one.loss_modulus(w) * noise[1, :24])  # fmt: skip
        relaxed = fit_relaxation(t, one.relaxation_modulus(t) * noise[2], terms_per_decade=2)
        fewer = reduce_spectrum(dynamic.spectrum, (0.1, 300.0), terms_per_decade=1)
        told[f"{seed}"] = {
            "dynamic": (dynamic.rms_residual, dynamic.largest_residual, dynamic.quality,
                        dynamic.frequency_range, dynamic.spectrum(5.0)),
            "relaxed": (relaxed.rms_residual, relaxed.quality, relaxed.frequency_range,
                        relaxed.spectrum(5.0), len(relaxed.spectrum)),
            "fewer": fewer,
        }  # fmt: skip
    held(file_regression, told)


def test_master_curves_of_random_sweeps(file_regression):
    told = {}
    for seed in range(4):
        rng = np.random.default_rng(60 + seed)
        one, law = spectrum(rng), WlfShift(6.0, 110.0, 300.0)
        kelvin = [285.0, 295.0, 305.0, 318.0][: 3 + seed % 2]
        w, t = np.geomspace(0.5, 200, 8), np.geomspace(0.02, 20, 9)
        sweeps, curves = [], []
        for k in kelvin:
            there = one.shift_times(float(law.shift_factor(k)))
            off = 1 + rng.choice([0.0, 0.01]) * rng.normal(size=(2, 8))
            sweeps.append(DynamicSweep(w, there.storage_modulus(w) * off[0],
                                       there.loss_modulus(w) * off[1], k))  # fmt: skip
            curves.append(RelaxationCurve(t, there.relaxation_modulus(t), k))
        at = (None, 300.0, 285.0, 310.0)[seed]
        told[f"{seed} dynamic"] = tried(
            dynamic_master_curve, sweeps[::-1], at, shift_by=("storage", "both")[seed % 2]
        )
        told[f"{seed} relaxed"] = tried(relaxation_master_curve, curves, at)
    held(file_regression, told)


# tables


UNITS = ("Hz", "kHz", "MHz", "mHz", "cps", "1/s", "s^-1", "1/min", "min-1", "rad/s", "rad / s",
         "rad·s⁻¹", "radians/sec", "rpm", "s", "")  # fmt: skip


def test_units_of_frequencies(file_regression):
    told = {}
    for unit in UNITS:
        for name, quantity in (("f", "frequency"), ("w", "angular frequency"),
                               ("angular frequency", "angular frequency")):  # fmt: skip
            column = FileColumn(name, quantity, unit, ("1", "2.5"))
            table = FileTable((column,), (2, 3), "a.csv")
            told[f"{name} in {unit!r}"] = tried(table.angular_frequency)
        stated = FileTable((FileColumn("f", "frequency", unit, ("1", "2.5")),), (2, 3), "a.csv",
                           stated={"frequency": "kHz"})  # fmt: skip
        told[f"stated beside {unit!r}"] = tried(stated.angular_frequency)
    for quantity, units in {
        "storage modulus": ("Pa", "kPa", "MPa", "[MPa]", "psi", "N/mm²", "dyn/cm^2", "s", "-", ""),
        "temperature": ("K", "°C", "C", "degF", "Celsius", "kelvin"),
        "time": ("s", "sec", "min", "ms", "h"), "phase angle": ("°", "deg", "Grad", "rad"),
        "complex viscosity": ("Pa s", "mPa.s", "kPa-s", "Pa*s"), "loss factor": ("%", "", "1"),
        "fraction": ("%", "-"), "decay rate": ("1/s", "s⁻¹"),
        "storage compliance": ("1/Pa", "1/MPa"),
    }.items():  # fmt: skip
        for unit in units:
            column = FileColumn("x", quantity, unit, ("0", "10", "inf"))
            table = FileTable((column,), (2, 3, 4), "a.csv")
            told[f"{quantity} in {unit!r}"] = tried(table.si, column, True)
            told[f"{quantity} in {unit!r}, finite"] = tried(table.si, column)
    logs = FileColumn("w", "angular frequency", "rad/s", ("0", "2"), base=10.0)
    told["logarithms"] = FileTable((logs,), (2, 3), "a.csv").numbers(logs)
    held(file_regression, told)


HEADS = (
    "Storage modulus E' [MPa]", "G'' / kPa", "tan(d)", "Temperature, °C", "Zeit in s",
    "log10(f) [Hz]", "ln(E)", "E_i (-)", "J'' (1/Pa)", "eta* (Pa.s)", "delta (t)", "T/°C", "f/Hz",
    "step time (min)", "modulus (t)", "E (w)", "G(t) [Pa]", "strain amplitude (%)", "a, b", "x / y",
    "relaxation time", "beta_i", "Speichermodul in MPa", "phi (deg)", "Dehnung", "(Pa)", "[s]", "1",
)  # fmt: skip
FORMS = {
    "commas": "t (s),E (MPa)\n{rows}", "tabs": "t (s)\tE (MPa)\n{rows}",
    "below": "t,E\ns,MPa\n{rows}", "brackets below": "t,E\n[s],[MPa]\n{rows}",
    "two units": "t (s),E (MPa)\ns,kPa\n{rows}", "same twice": "t (s),E (MPa)\ns,MPa\n{rows}",
    "held": "Sample A\nTemperature: 23,5 °C\nt (s),E (MPa)\n{rows}",
    "parameters": "T=25;chem=PI;\nt\tG\n{rows}", "no number": "T=warm;chem=PI;\nt\tG\n{rows}",
    "wider": "t (s),E (MPa),x\n{rows}", "wide heads": "t (s),E (MPa),\n{rows}",
    "three more": "t (s),E (MPa),x,y,z\n{rows}", "no heads": "{rows}", "words": "a,b\n{rows}",
    "foot": "t (s),E (MPa)\n{rows}mean,5\n", "foot among": "t (s),E (MPa)\n{rows}mean,5\n9,1\n",
    "next": "t (s),E (MPa)\n{rows}\nt (s),E (kPa)\n{rows}",
    "rheometer": "Meas. Pts.,t (s),Modulus (MPa)\n{counted}",
    "both kinds": "t (s),E (MPa),G (MPa)\n{three}",
}  # fmt: skip


def test_forms_of_tables(file_regression, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    numbers = [(10.0**k, 9.0 - k, 3.0 - k / 3) for k in range(-2, 4)]
    parts = {
        "rows": "".join(f"{t:g},{e:g}\n" for t, e, _ in numbers),
        "counted": "".join(f"{k},{t:g},{e:g}\n" for k, (t, e, _) in enumerate(numbers, 1)),
        "three": "".join(f"{t:g},{e:g},{g:g}\n" for t, e, g in numbers),
    }
    told = {}
    for name, form in FORMS.items():
        content = form.format(**parts)
        if "\t" in form:
            content = content.replace(",", "\t")
        (tmp_path / "a.csv").write_text(content, encoding="utf-8")
        tables = tried(read_tables, "a.csv")
        told[name] = tables if isinstance(tables, str) else [
            ([(c.name, c.quantity, c.unit) for c in t.columns], t.lines, t.kelvin, t.shear,
             t.headed_shear, t.rheometer)
            for t in tables
        ]  # fmt: skip
        told[f"{name}, read"] = tried(read_rubber, "a.csv")
    told["heads"] = {cell: (heading_of(cell), quantity_of(heading_of(cell)[0])) for cell in HEADS}
    held(file_regression, told)
