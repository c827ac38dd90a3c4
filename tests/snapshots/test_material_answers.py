"""Rubbers: hardness, spectra, fits, master curves, tables and decks as read and written."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from snapshot import held, refusal, tried
from underfoot.material import _hardness, curves, durometer_scales, master_curve, spectrum_fit
from underfoot.material.bs903_1950 import bs903_breaches, youngs_modulus_bs903
from underfoot.material.curves import DynamicSweep, RelaxationCurve, checked_curve, minimum_on
from underfoot.material.decks import is_deck, read_deck
from underfoot.material.durometer_scales import durometer_reading
from underfoot.material.elastomer import (
    Elastomer,
    bulk_modulus,
    plane_strain_modulus,
    poisson_ratio_from_moduli,
    shear_from_young,
    shear_modulus,
    young_from_shear,
    youngs_modulus_from_shear,
)
from underfoot.material.few_terms import (
    power_law_spectrum,
    report_elastomer,
    single_exponential_spectrum,
)
from underfoot.material.gent_1958 import gent_breaches, shore_a_gent, youngs_modulus_gent
from underfoot.material.master_curve import (
    ArrheniusShift,
    WlfShift,
    best_shift,
    dynamic_master_curve,
    fit_arrhenius,
    fit_wlf,
    relaxation_master_curve,
)
from underfoot.material.read import read_dynamic, read_prony, read_relaxation, read_rubber
from underfoot.material.ruess import ruess_breaches, youngs_modulus_ruess
from underfoot.material.spectrum import RelaxationSpectrum
from underfoot.material.spectrum_fit import fit_dynamic, fit_relaxation, reduce_spectrum
from underfoot.material.tables import heading_of, quantity_of, read_tables, without_logarithm
from underfoot.material.write_decks import MOST_TERMS, deck_text, write_deck

SERIES = RelaxationSpectrum(2e6, [3e6, 1e6, 5e5], [1e-3, 0.1, 10.0], source="a test")
W = np.geomspace(1e-2, 1e4, 25)
FORMS = Path(__file__).parents[1] / "data" / "rubber_forms"


def test_hardness(file_regression):
    shore = np.array([0.0, 29.9, 30.0, 40.0, 60.0, 80.1, 95.1, 99.9])
    answers = {
        "gent": youngs_modulus_gent(shore),
        "bs": youngs_modulus_bs903(shore),
        "ruess": youngs_modulus_ruess(shore),
        "back": shore_a_gent(youngs_modulus_gent(shore)),
        "breaches": [
            [each(s) for s in (29.9, 30.0, 39.9, 40.0, 60.1, 80.1, 95.1)]
            for each in (gent_breaches, bs903_breaches, ruess_breaches)
        ],
        "refused": [
            refusal(call, s)
            for call in (youngs_modulus_gent, _hardness.checked_hardness)
            for s in (-0.1, 100.0, [50, np.nan])
        ]
        + [refusal(shore_a_gent, 1e5)],
        "readings": {},
    }
    for text in (
        "62",
        "62 A",
        "Shore A 62",
        "sh-d 40",
        "29 D",
        "30 D",
        "49.5 Shore D",
        "55 Asker C",
        "jis c 76",
        "45°C",
        "62,5 A",
        "0",
        "100",
        "100.5",
        "sixty",
        "60 B",
        "60 60",
        "",
    ):
        reading = tried(durometer_reading, text, where="shoe.hardness")
        answers["readings"][text] = (
            reading
            if isinstance(reading, str)
            else (reading.value, reading.shore_a, reading.note())
        )
    held(file_regression, answers)
    assert len(durometer_scales.SCALES) == 3
    assert answers["back"] == pytest.approx(shore)


def test_moduli_and_spectra(file_regression):
    rubber = Elastomer(SERIES, 0.49, name="r", density=1100.0)
    t = np.array([0.0, 1e-3, 0.1, 5.0, 1e3])
    loose = replace(SERIES, equilibrium_modulus=0.0)
    answers = {
        "moduli": [
            call(5e6, 0.49)
            for call in (
                shear_modulus,
                youngs_modulus_from_shear,
                bulk_modulus,
                plane_strain_modulus,
            )
        ],
        "stiff": (bulk_modulus(5e6, 0.5), bulk_modulus(np.array([1.0, 2.0]), 0.5)),
        "ratio": poisson_ratio_from_moduli(2e9, 1e6),
        "rubber": rubber,
        "of it": (
            rubber.spectrum,
            rubber.equilibrium_modulus,
            rubber.instantaneous_modulus,
            rubber.bulk_modulus,
            rubber.complex_modulus(W),
            rubber.shear_modulus(W),
            rubber.plane_strain_modulus(W),
        ),
        "elastic": (Elastomer(5e6).spectrum, Elastomer(5e6).complex_modulus(3.0)),
        "converted": (young_from_shear(SERIES), shear_from_young(SERIES, 0.45)),
        "relaxed": SERIES.relaxation_modulus(t),
        "complex": SERIES.complex_modulus(W),
        "one": SERIES(2.0),
        "ends": SERIES.complex_modulus([0.0, np.inf, -2.0]),
        "parts": (SERIES.storage_modulus(W), SERIES.loss_modulus(W), SERIES.loss_tangent(W)),
        "text": (repr(SERIES), len(SERIES), SERIES.table().rows, SERIES.table().title),
        "scaled": SERIES.scale_moduli(0.5),
        "shifted": SERIES.shift_times(10.0, source="warm"),
        "cautions": [
            one.cautions()
            for one in (
                SERIES,
                loose,
                replace(SERIES, equilibrium_modulus=5.0),
                replace(SERIES, equilibrium_modulus=4.0),
            )
        ],
        "single": single_exponential_spectrum(3e6, 1e6, 4.0),
        "report": [report_elastomer(name) for name in ("neolite", "rubber")],
        "power law": power_law_spectrum(1e6, 0.12, shortest_time=1e-3, longest_time=1.0),
        "ripple": power_law_spectrum(1e6, 0.3, shortest_time=1e-2, terms_per_decade=1),
        "refused": [
            tried(call)
            for call in (
                lambda: shear_modulus(1.0, 0.51),
                lambda: shear_modulus(1.0, -1.0),
                lambda: poisson_ratio_from_moduli(0.0, 1.0),
                lambda: poisson_ratio_from_moduli(1.0, np.inf),
                lambda: Elastomer(0.0),
                lambda: Elastomer(1.0, density=0.0),
                lambda: Elastomer(1.0, 0.6),
                lambda: replace(SERIES, equilibrium_modulus=-1.0),
                lambda: replace(SERIES, term_moduli=[1.0]),
                lambda: replace(SERIES, term_moduli=[1.0, -2.0, 1.0]),
                lambda: replace(SERIES, relaxation_times=[1.0, 0.0, 2.0]),
                lambda: RelaxationSpectrum(0.0),
                lambda: SERIES.scale_moduli(0.0),
                lambda: SERIES.shift_times(-1.0),
                lambda: SERIES.relaxation_modulus(-1.0),
                lambda: SERIES.complex_modulus(np.nan),
                lambda: single_exponential_spectrum(1.0, 2.0, 1.0),
                lambda: report_elastomer("cork"),
                lambda: single_exponential_spectrum(2.0, 1.0, 0.0),
                lambda: power_law_spectrum(0.0, 0.1),
                lambda: power_law_spectrum(1.0, 1.0),
                lambda: power_law_spectrum(1.0, 0.1, shortest_time=2.0),
                lambda: power_law_spectrum(1.0, 0.1, terms_per_decade=0),
            )
        ],
    }
    single_exponential_spectrum(1.0, 1.0, 1.0)
    Elastomer(1.0, 0.5)
    held(file_regression, answers)
    assert replace(SERIES) == SERIES
    assert hash(SERIES) == hash(replace(SERIES))
    assert replace(SERIES, source="other") != SERIES
    assert SERIES != 1


def _sweep(kelvin, law=WlfShift(8.0, 100.0, 300.0)):  # noqa: B008
    w = np.geomspace(1.0, 300.0, 9)
    shifted = SERIES.shift_times(float(law.shift_factor(kelvin)))
    return DynamicSweep(w, shifted.storage_modulus(w), shifted.loss_modulus(w), kelvin, "a test")


def test_curves_and_fits(file_regression, monkeypatch):
    monkeypatch.setattr(spectrum_fit, "SAMPLES", 6)
    t = np.geomspace(1e-4, 100, 30)
    noise = 1 + 0.01 * np.cos(np.arange(30) ** 1.5)
    relaxed = fit_relaxation(t, SERIES.relaxation_modulus(t) * noise)
    dynamic = fit_dynamic(W, SERIES.storage_modulus(W), SERIES.loss_modulus(W), terms_per_decade=2)
    answers = {
        "relaxed": relaxed,
        "dynamic": dynamic,
        "judged": [
            (one.rms_residual, one.largest_residual, one.quality, str(one))
            for one in (relaxed, dynamic)
        ],
        "band": relaxed.band(np.geomspace(1e-4, 1e6, 6)),
        "narrow": dynamic.band([1.0, 10.0], 0.5),
        "fewer": reduce_spectrum(SERIES, (0.1, 1e3)),
        "more": reduce_spectrum(SERIES, (1.0, 1e3), terms_per_decade=3),
        "runs": [
            spectrum_fit.run_length(one)
            for one in (
                np.sin(np.arange(40) / 5),
                np.cos(3.0 * np.arange(40)),
                np.zeros(9),
                np.arange(5.0),
            )
        ],
        "signs": spectrum_fit.random_signs(12, 3, np.random.default_rng(3)),
        "least": minimum_on(np.linspace(-2, 3, 11), lambda x: (x - 1.234) ** 2, 1e-9),
        "sorted": checked_curve([3, 1, 2, 4], [1, 2, 3, 4], quantity="storage modulus"),
        "refused": [
            tried(call)
            for call in (
                lambda: checked_curve([1, 2, 3], [1, 2]),
                lambda: checked_curve([1, 2, 3], [1, 2, 3]),
                lambda: checked_curve([1, 2, 3, np.nan], [1, 2, 3, 4]),
                lambda: checked_curve([1, 2, 3, 4], [1, 2, 0, 4]),
                lambda: checked_curve([1, 3, 2, 4], [1] * 4),
                lambda: checked_curve([1, 2], [1, 2], quantity="loss modulus", fewest=3),
                lambda: RelaxationCurve([1, 2, 3], [3, 2, 1]),
                lambda: DynamicSweep([1, 2], [1, 2], [1, 2]),
                lambda: DynamicSweep([1, 2, 3], [1, 2, 3], [1, 2, 3], 0.0),
                lambda: fit_relaxation(t, t, terms_per_decade=0),
                lambda: relaxed.band([0.0]),
                lambda: relaxed.band([1.0], 1.0),
                lambda: reduce_spectrum(SERIES, (2.0, 1.0)),
                lambda: reduce_spectrum(RelaxationSpectrum(1.0), (1.0, 2.0)),
            )
        ],
    }
    DynamicSweep([1, 2, 3], [1, 2, 3], [1, 2, 3])
    held(file_regression, answers)
    assert (spectrum_fit.GOOD, spectrum_fit.BAD, curves.checked_curve) == (0.05, 0.2, checked_curve)


def test_master_curves(file_regression):
    sweeps = [_sweep(kelvin) for kelvin in (320.0, 280.0, 300.0)]
    curves_of = [
        RelaxationCurve(t, SERIES.shift_times(a).relaxation_modulus(t), kelvin)
        for kelvin, a in ((290.0, 3.0), (310.0, 1.0 / 3.0))
        for t in [np.geomspace(1e-3, 10, 12)]
    ]
    master, both = (
        dynamic_master_curve(sweeps),
        dynamic_master_curve(sweeps, 290.0, shift_by="both"),
    )
    wlf, arrhenius = WlfShift(8.0, 100.0, 300.0), ArrheniusShift(5e4, 300.0)
    kelvin = np.array([260.0, 300.0, 350.0])
    answers = {
        "master": master,
        "both": both,
        "relaxed": relaxation_master_curve(curves_of),
        "laws": (master.shifts.wlf, master.shifts.arrhenius, master.shifts.law),
        "law of two": relaxation_master_curve(curves_of, 300.0).shifts.law,
        "wlf": (wlf.log10_shift_factor(kelvin), wlf.shift_factor(300.0), str(wlf)),
        "arrhenius": (
            arrhenius.log10_shift_factor(kelvin),
            arrhenius.shift_factor(300.0),
            str(arrhenius),
        ),
        "fitted": (
            fit_wlf(kelvin, wlf.log10_shift_factor(kelvin), 300.0),
            fit_arrhenius(kelvin, arrhenius.log10_shift_factor(kelvin), 300.0),
        ),
        "shift": best_shift(
            np.arange(9.0),
            np.arange(9.0)[None] ** 2,
            np.arange(9.0) + 2,
            np.arange(9.0)[None] ** 2 + 1.0,
        ),
        "flat": best_shift(np.arange(9.0), np.ones((1, 9)), np.arange(9.0), np.ones((1, 9))),
        "spectrum": len(master.spectrum(terms_per_decade=1, noise=0.01).spectrum),
        "refused": [
            tried(call)
            for call in (
                lambda: dynamic_master_curve(sweeps, shift_by="loss"),
                lambda: dynamic_master_curve(sweeps[:1]),
                lambda: dynamic_master_curve(sweeps, 279.0),
                lambda: dynamic_master_curve([*sweeps, sweeps[0]]),
                lambda: dynamic_master_curve([sweeps[0], replace(sweeps[1], temperature=None)]),
                lambda: dynamic_master_curve(
                    [sweeps[0], replace(sweeps[1], storage_modulus=1e4 * sweeps[1].storage_modulus)]
                ),
                lambda: wlf.shift_factor(200.0),
                lambda: arrhenius.shift_factor(0.0),
                lambda: fit_wlf([300.0, 310.0], [0.0, 1.0], 300.0),
                lambda: fit_arrhenius([1.0], [0.0], 1.0),
                lambda: fit_wlf([300.0, 310.0, np.nan], [0, 1, 2], 300.0),
            )
        ],
    }
    held(file_regression, answers)
    assert pytest.approx(2e-3) == master_curve.FLAT
    assert answers["fitted"][0].c1 == pytest.approx(8.0, rel=1e-4)


def test_files_of_rubbers(monkeypatch, file_regression):
    monkeypatch.chdir(FORMS)
    answers = {}
    for path in sorted(Path().iterdir()):
        if path.suffix == ".md":
            continue
        answers[path.name] = tried(read_rubber, path)
        if isinstance(answers[path.name], str) or path.name.startswith("prony"):
            units = {"modulus_unit": "MPa", "instantaneous_modulus": 8e6}
            answers[f"{path.name} of MPa"] = tried(read_rubber, path, **units)
    answers["prony"] = [
        tried(read_prony, Path("prony_fractions.csv"), **levels)
        for levels in (
            {},
            {"instantaneous_modulus": 8e6},
            {"equilibrium_modulus": 2e6},
            {"equilibrium_modulus": 2e6, "shear": True, "poisson_ratio": 0.45},
        )
    ]
    answers["sweeps"] = tried(read_dynamic, Path("reptate_25.osc"))
    answers["curves"] = tried(read_relaxation, Path("reptate.gt"))
    held(file_regression, answers)


HEADINGS = (
    "f (Hz)",
    "f [Hz]",
    "f / Hz",
    "f, Hz",
    "f in Hz",
    "w [rad/s]",
    "omega",
    "T",
    "t",
    "Temp.",
    "E'",
    "E''",
    "G' (MPa)",
    "tan(delta)",
    "tan δ",
    "|E*| [Pa]",
    "log10(omega) [rad/s]",
    "log G' (Pa)",
    "lg(E' / MPa)",
    "ln(t) [s]",
    "Storage Modulus G'",
    "Speichermodul [kPa]",
    "Verlustfaktor tan δ",
    "Zeit [s]",
    "tau_i",
    "beta (1/s)",
    "E_i [MPa]",
    "e_i",
    "E_0",
    "E_inf",
    "Set",
    "strain %",
    "name",
    "complex viscosity (Pa.s)",
    "J'",
    "phase angle [°]",
    "Kreisfrequenz",
    "elapsed time",
    "E/MPa",
)
DYN = "T (C),f (Hz),E' (MPa),E'' (MPa)\n" + "".join(
    f"{t},{f},{10 - t / 10 + f / 5:.3f},{1 + f / 50:.3f}\n"
    for t in (0, 20, 40)
    for f in (1, 3, 10, 30)
)
RELAX = "t (s);E (MPa)\n" + "".join(f"{10.0**k:g};{9 - k:g}\n" for k in range(-2, 4))
PRONY = "tau (s),E_i (MPa)\ninf,2\n0.01,1.5\n1,0.5\n"
FRACTIONS = "tau (s),e_i\n0.01,0.5\n1,0.3\n"
TABLES = {
    "sweeps": DYN,
    "without units": DYN.replace(" (MPa)", ""),
    "semicolons": DYN.replace(",", ";"),
    "decimal commas": DYN.replace(",", ";").replace(".", ","),
    "no loss": DYN.replace("E'' (MPa)", "x"),
    "a word": DYN.replace("0,3,", "0,three,"),
    "a gap": DYN.replace("20,3,", "20,,"),
    "a row short": DYN.replace("20,3,8.600,1.060", "20"),
    "with words": "made by hand\n" + DYN + "the end\n",
    "in rad": DYN.replace("f (Hz)", "w (rad/s)"),
    "contradiction": DYN.replace("f (Hz)", "angular frequency (Hz)"),
    "kHz": DYN.replace("Hz", "kHz"),
    "per second": DYN.replace("Hz", "1/s"),
    "no unit of f": DYN.replace(" (Hz)", ""),
    "furlongs": DYN.replace("MPa", "furlong"),
    "twice": DYN.replace("E'' (MPa)", "E' (MPa)"),
    "units below": "T,f,G',G''\nC,Hz,kPa,kPa\n" + DYN.partition("\n")[2],
    "one frequency": "f (Hz),E' (MPa),E'' (MPa)\n" + "1,9,1\n" * 5,
    "below zero": DYN.replace("0,1,10.200", "0,1,-1"),
    "other loss factor": "f (Hz),E' (MPa),E'' (MPa),tan delta\n"
    + "".join(f"{f},10,1,0.2\n" for f in (1, 3, 10)),
    "loss factor": "f (Hz),E' (MPa),tan delta\n" + "".join(f"{f},10,0.{f}\n" for f in (1, 3, 5)),
    "percent": "f (Hz),E' (MPa),tan delta (%)\n" + "".join(f"{f},10,{f}\n" for f in (1, 3, 5)),
    "strains": "f (Hz),E' (MPa),E'' (MPa),strain (%)\n"
    + "".join(f"{f},{10 - s},1,{s}\n" for f in (1, 3, 10) for s in (1, 2)),
    "held": "Temperature: 25 °C\nf (Hz),E' (MPa),E'' (MPa)\n"
    + "".join(f"{f},{10 + f / 10},1\n" for f in (1, 3, 10)),
    "two runs": "f (Hz),E' (MPa),E'' (MPa)\n" + "".join(f"{f},10,1\n" for f in (1, 3, 10, 30)) * 2,
    "numbered sets": "Set,f (Hz),E' (MPa),E'' (MPa)\n"
    + "".join(f"{k},{f},{10 + k},1\n" for k in (2, 1) for f in (1, 3, 10)),
    "ramp": "T (C),f (Hz),E' (MPa),E'' (MPa)\n"
    + "".join(
        f"{t + 0.1 * k},{f},{10 - t / 10},1\n"
        for t in (0, 10, 20)
        for k, f in enumerate((1, 3, 10))
    ),
    "by frequency": "T (C),f (Hz),E' (MPa),E'' (MPa)\n"
    + "".join(f"{t},{f},{10 - t / 10},1\n" for f in (1, 3, 10) for t in (0, 10, 20)),
    "relaxation": RELAX,
    "backwards": "t (s);E (MPa)\n" + "\n".join(RELAX.split("\n")[:0:-1]),
    "times again": RELAX + RELAX.partition("\n")[2],
    "of shear": RELAX.replace("E (", "G ("),
    "prony": PRONY,
    "negative": PRONY.replace("1.5", "-1.5"),
    "no time": PRONY.replace("tau", "name"),
    "time of zero": PRONY.replace("0.01", "0"),
    "rates": PRONY.replace("tau (s)", "beta (1/s)").replace("inf", "0"),
    "fractions": FRACTIONS,
    "too many": FRACTIONS.replace("0.3", "0.6"),
    "all": FRACTIONS.replace("0.3", "0.5"),
    "with rest": FRACTIONS.replace("e_i", "e_i,E_inf (MPa)")
    .replace("0.5\n", "0.5,2\n")
    .replace("0.3\n", "0.3,2\n"),
    "two levels": FRACTIONS.replace("e_i", "e_i,E_0 (MPa)")
    .replace("0.5\n", "0.5,2\n")
    .replace("0.3\n", "0.3,3\n"),
    "headings alone": "f (Hz),E' (MPa)\n",
    "numbers alone": "1,2,3\n4,5,6\n",
    "nothing": "words\n",
    "other columns": "a,b\n1,2\n3,4\n",
}


def test_tables(tmp_path, monkeypatch, file_regression):
    monkeypatch.chdir(tmp_path)
    answers = {}
    for name, text in TABLES.items():
        path = Path("rubber.csv")
        path.write_text(text, encoding="utf-8")
        tables = tried(read_tables, path)
        answers[name] = {
            "tables": tables
            if isinstance(tables, str)
            else [
                (
                    [(c.name, c.quantity, c.unit, c.base) for c in table.columns],
                    table.lines,
                    table.kelvin,
                    table.shear,
                )
                for table in tables
            ],
            "rubber": tried(read_rubber, path),
        }
        if name in ("without units", "fractions", "too many", "all", "with rest"):
            answers[name]["told"] = tried(
                read_rubber,
                path,
                modulus_unit="MPa",
                units={"temperature": "degC"},
                equilibrium_modulus=2e6,
            )
    answers["headings"] = {
        cell: (heading_of(cell), quantity_of(heading_of(cell)[0]), without_logarithm(cell))
        for cell in HEADINGS
    }
    answers["not there"] = tried(read_rubber, Path("rubbr.csv"))
    held(file_regression, answers)


TOML = """modulus = "young"
equilibrium_modulus = "2 MPa"
[[term]]
modulus = "1 MPa"
relaxation_time = "0.01 s"
[[term]]
modulus = "0.5 MPa"
relaxation_time = "1 s"
"""
TOMLS = {
    "as it is": ("", ""),
    "shear": ('"young"', '"shear"'),
    "ratio": ('"young"', '"shear"\npoisson_ratio = 0.45'),
    "kind": ('"young"', '"bulk"'),
    "no terms": ("[[term]]", "[[part]]"),
    "no time": ("relaxation_time", "time"),
    "mixed": ('modulus = "1 MPa"', "fraction = 0.5"),
    "unit": ("0.5 MPa", "0.5 s"),
    "broken": ("= ", "- "),
    "at once": ("equilibrium", "instantaneous"),
    "too little at once": ('equilibrium_modulus = "2 MPa"', 'instantaneous_modulus = "1 MPa"'),
    "both": ('"2 MPa"', '"2 MPa"\ninstantaneous_modulus = "4 MPa"'),
    "no level": ("equilibrium", "other"),
}
DYNA = (
    "*KEYWORD\n$ a comment\n*MAT_GENERAL_VISCOELASTIC_TITLE\nrubber\n1,1e-9,500\n0,0,0,0\n"
    "2.0,0.0\n1.5,100.\n0.5,1.0\n*END\n"
)
ABAQUS = (
    "*MATERIAL, NAME=R\n*HYPERELASTIC, NEO HOOKE, MODULI=INSTANTANEOUS\n1.5, 0.01\n"
    "*VISCOELASTIC, TIME=PRONY\n0.3, 0., 0.01\n0.2, 0., 1.\n"
)
FEBIO = (
    '<febio_spec><Material><material id="1" type="viscoelastic"><t1>0.01</t1><g1>0.5</g1>'
    '<t2>1</t2><g2>0.25</g2><elastic type="neo-Hookean"><E>3</E><v>0.49</v></elastic>'
    "</material></Material></febio_spec>"
)
DECKS = {
    "k": (
        DYNA,
        {
            "as it is": ("", ""),
            "negative": ("1.5,", "-1.5,"),
            "rate": ("100.", "-1"),
            "words": ("1.5,", "x,"),
            "curve": ("0,0,0,0\n2.0,0.0\n1.5,100.\n0.5,1.0\n", "7,0,0,0\n"),
            "none": ("_GENERAL_VISC", "_ELAST"),
            "columns": ("2.0,0.0\n1.5,100.\n", "       2.0       0.0\n       1.5      1d2\n"),
            "number": ("GENERAL_VISCOELASTIC", "076"),
            "viscoelastic": (
                "GENERAL_VISCOELASTIC_TITLE\nrubber\n1,1e-9,500",
                "VISCOELASTIC\n1,1e-9,500,4,2,10",
            ),
        },
    ),
    "inp": (
        ABAQUS,
        {
            "as it is": ("", ""),
            "at rest": (", MODULI=INSTANTANEOUS", ""),
            "frequency": ("TIME=PRONY", "FREQUENCY"),
            "elastic": (
                "*HYPERELASTIC, NEO HOOKE, MODULI=INSTANTANEOUS\n1.5, 0.01",
                "*ELASTIC\n3.0, 0.49",
            ),
            "mooney": ("NEO HOOKE", "MOONEY-RIVLIN"),
            "yeoh": ("NEO HOOKE", "YEOH"),
            "ogden": ("NEO HOOKE", "OGDEN, N=1"),
            "other": ("NEO HOOKE", "ARRUDA"),
            "before": ("*HYPERELASTIC", "*OTHER"),
            "short": ("0.3, 0., 0.01", "0.3"),
            "too many": ("0.3,", "0.9,"),
            "negative": ("0.3,", "-0.3,"),
            "none": ("*VISCO", "*OTHER"),
            "nothing left": (
                ", MODULI=INSTANTANEOUS\n1.5, 0.01\n*VISCOELASTIC, TIME=PRONY\n0.3",
                "\n1.5, 0.01\n*VISCOELASTIC, TIME=PRONY\n0.8",
            ),
        },
    ),
    "feb": (
        FEBIO,
        {
            "as it is": ("", ""),
            "g0": ("<t1>", "<g0>0.5</g0><t1>"),
            "mooney": ("<E>3</E><v>0.49</v>", "<c1>1</c1><c2>2</c2>"),
            "no elastic": ("<elastic", "<plastic"),
            "other": ("<E>3</E>", ""),
            "negative": ("0.25", "-0.25"),
            "words": ("0.25", "quarter"),
            "broken": ("</febio_spec>", ""),
            "none": ('type="viscoelastic"', 'type="rigid"'),
        },
    ),
}


def test_decks(tmp_path, monkeypatch, file_regression):
    monkeypatch.chdir(tmp_path)
    answers = {}
    for ending, (text, changes) in DECKS.items():
        for name, (old, new) in changes.items():
            assert old in text, name
            path = Path(f"rubber.{ending}")
            path.write_text(text.replace(old, new, 1), encoding="utf-8")
            answers[f"{ending} {name}"] = tried(read_deck, path, "MPa")
        answers[f"{ending} without unit"] = tried(read_deck, path)
        path.write_text(text, encoding="utf-8")
        answers[f"{ending} without unit"] = tried(read_deck, path)
        answers[f"{ending} of seconds"] = tried(read_deck, path, "s")
        assert is_deck(path)
    for name, (old, new) in TOMLS.items():
        path = Path("rubber.toml")
        path.write_text(TOML.replace(old, new), encoding="utf-8")
        answers[f"toml {name}"] = (tried(read_rubber, path), tried(read_prony, path))
    for form in MOST_TERMS:
        answers[f"{form} text"] = deck_text(SERIES, form).splitlines()
        answers[f"{form} of few"] = deck_text(
            replace(SERIES, term_moduli=[0.0, 1e6, 0.0]),
            form,
            poisson_ratio=0.4,
            unit="Pa",
            density=1200.0,
            name="SOLE",
        ).splitlines()
        many = RelaxationSpectrum(1e6, np.ones(19) * 1e5, np.geomspace(1e-6, 1, 19))
        answers[f"{form} of many"] = tried(lambda: len(deck_text(many, form)))  # noqa: B023
    loose = replace(SERIES, equilibrium_modulus=0.0)
    answers["at rest"] = [tried(deck_text, loose, form) for form in ("FEBio", "LS-DYNA")]
    answers["form"] = tried(deck_text, SERIES, "Marc")
    answers["ratios"] = [tried(deck_text, SERIES, "FEBio", poisson_ratio=r) for r in (0.0, 0.5)]
    write_deck(Path("made.INP"), SERIES)
    back = read_deck(Path("made.INP"), "MPa")
    assert young_from_shear(back.series, 0.49).instantaneous_modulus == pytest.approx(6.5e6)
    answers["there"] = tried(write_deck, Path("made.INP"), SERIES)
    answers["ending"] = tried(write_deck, Path("made.txt"), SERIES)
    held(file_regression, answers)
    assert not is_deck(Path("a.csv"))
    assert math.isclose(back.series.relaxation_times[0], 1e-3)
