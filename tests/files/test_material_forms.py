"""One rubber in every form that people have: the same numbers, or an error with the remedy."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from underfoot.core import DataError, InputError
from underfoot.material import RelaxationSpectrum, read_dynamic, read_prony, read_relaxation
from underfoot.material.read import read_rubber

FORMS = Path(__file__).parents[1] / "data" / "rubber_forms"
TIMES = np.geomspace(1e-8, 1e4, 25)
TRUTH = RelaxationSpectrum(1e5, 1e6 * np.exp(-(((np.log10(TIMES) + 2) / 3) ** 2)), TIMES)
SERIES = RelaxationSpectrum(
    0.8e6, np.array([0.5e6, 0.7e6, 1.1e6, 1.9e6, 3e6]), 10.0 ** -np.arange(5)
)


@pytest.mark.parametrize(
    "name", ["reptate_25.osc", "abs_phase.csv", "gp_tand.csv", "eta_star.csv", "compliance.csv"]
)
def test_every_pair_of_quantities_gives_the_sweep(name):
    test = read_rubber(FORMS / name)
    (sweep,) = test.sweeps
    assert test.shear is True
    assert sweep.angular_frequency[0] == pytest.approx(0.1, rel=1e-5)
    assert sweep.storage_modulus[0] == pytest.approx(0.95745e6, rel=1e-4)
    assert sweep.loss_modulus[0] == pytest.approx(0.52355e6, rel=1e-4)


def test_reptate_names_temperature_and_units():
    kelvin = [read_dynamic(FORMS / f"reptate_{t}.osc")[0].temperature for t in (5, 25, 45)]
    assert kelvin == pytest.approx([278.15, 298.15, 318.15])
    (curve,) = read_relaxation(FORMS / "reptate.gt")
    assert curve.temperature == pytest.approx(298.15)
    assert curve.modulus[0] == pytest.approx(TRUTH.relaxation_modulus(1e-3), rel=1e-4)


@pytest.mark.parametrize("name", ["prony_tau.csv", "prony_beta.csv"])
def test_a_series_names_its_modulus_at_rest(name):
    found = read_rubber(FORMS / name)
    assert found.shear is True
    assert found.series.equilibrium_modulus == pytest.approx(0.8e6)
    np.testing.assert_allclose(found.series.term_moduli, SERIES.term_moduli)
    np.testing.assert_allclose(found.series.relaxation_times, SERIES.relaxation_times)


@pytest.mark.parametrize("name", ["general_viscoelastic.k", "viscoelastic.inp", "viscoelastic.feb"])
def test_decks_of_solvers_give_the_series_and_ask_for_their_unit(name):
    with pytest.raises(DataError, match="--unit MPa"):
        read_rubber(FORMS / name)
    found = read_rubber(FORMS / name, modulus_unit="MPa")
    assert found.shear is True
    assert found.series.equilibrium_modulus == pytest.approx(0.8e6)
    np.testing.assert_allclose(found.series.term_moduli, SERIES.term_moduli)
    np.testing.assert_allclose(found.series.relaxation_times, SERIES.relaxation_times)


@pytest.mark.parametrize("name", ["prony_csv.csv", "prony_young.csv", "prony_fractions.csv"])
def test_a_series_without_a_level_asks_for_it(name):
    with pytest.raises(DataError, match=r"--at-once .*--at-rest"):
        read_rubber(FORMS / name)
    at_rest = read_rubber(FORMS / name, equilibrium_modulus=0.8e6).series
    assert at_rest.equilibrium_modulus == pytest.approx(0.8e6)
    at_once = read_rubber(FORMS / name, instantaneous_modulus=8e6).series
    assert at_once.instantaneous_modulus == pytest.approx(8e6)


def test_fractions_that_sum_to_one_are_a_caution_with_the_remedy(tmp_path):
    """As pyvisco's default fit writes them, with its column of the modulus at once."""
    whole = tmp_path / "prony.csv"
    whole.write_text("i,E_0 (MPa),tau_i (s),alpha_i (-)\n0,14,0.1,0.6\n1,,10,0.4\n")
    spectrum = read_prony(whole)
    assert spectrum.instantaneous_modulus == pytest.approx(14e6)
    assert "tau = inf" in " ".join(spectrum.cautions())
    rows = "1,0.1,0.3,14.0,4.2\n2,10.0,0.4,14.0,5.6\n"
    whole.write_text(f"i,tau_i,alpha_i,E_0,E_i\n-,s,-,MPa,MPa\n{rows}")
    spectrum = read_prony(whole)
    assert spectrum.equilibrium_modulus == pytest.approx(4.2e6)
    assert spectrum.cautions() == ()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("tau (s),E_i (MPa)\n1,2\n10,-0.5\ninf,1\n", r"line 3.* negative"),
        ("tau (s),E_i (MPa)\n1,2\n0,0.5\ninf,1\n", "relaxation times above 0"),
        ("beta (1/s),G_i (MPa)\n1,2\n-3,0.5\n0,1\n", "above 0"),
        ("tau (s),E_i (MPa),E_0 (MPa)\n1,2,9\n2,0.5,8\n", "more than one modulus"),
    ],
)
def test_series_that_are_none(tmp_path, text, says):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises((DataError, InputError), match=says):
        read_prony(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("heading", "factor"),
    [
        ("Angular Frequency (1/s)", 1.0), ("w (1/s)", 1.0), ("omega [s^-1]", 1.0),
        ("Kreisfrequenz (rad/s)", 1.0), ("ω / rad s^-1", 1.0), ("w [rad.s-1]", 1.0),
        ("Frequency (rad/s)", 1.0), ("Frequency (Hz)", 2 * np.pi), ("Frequency (1/s)", 2 * np.pi),
        ("Frequency [1/min]", np.pi / 30), ("w (min-1)", 1 / 60),
        ("f (s^-1)", 2 * np.pi), ("Frequenz / Hz", 2 * np.pi), ("Frequency, kHz", 2e3 * np.pi),
    ],
)  # fmt: skip
def test_name_and_unit_decide_the_frequency(tmp_path, heading, factor):
    rows = "\n".join(f"{f};2e6;1e5" for f in (1, 2, 4, 8))
    (tmp_path / "a.csv").write_text(f"{heading};Storage Modulus (Pa);Loss Modulus (Pa)\n{rows}\n")
    (sweep,) = read_dynamic(tmp_path / "a.csv")
    np.testing.assert_allclose(sweep.angular_frequency, np.array([1, 2, 4, 8]) * factor)


_W = 10.0 ** np.arange(-1.0, 2.1, 0.5)
_STORAGE, _LOSS = 5e6 * _W**0.1, 1e6 * _W**0.2


@pytest.mark.parametrize(
    ("heads", "columns"),
    [
        (
            "log10(omega) [rad/s];log10(G') [Pa];log10(G'') [Pa]",
            lambda: (np.log10(_W), np.log10(_STORAGE), np.log10(_LOSS)),
        ),
        (
            "log f (Hz);lg E' (MPa);log tan delta",
            lambda: (
                np.log10(_W / 2 / np.pi),
                np.log10(_STORAGE / 1e6),
                np.log10(_LOSS / _STORAGE),
            ),
        ),
        (
            "ln(f / Hz);ln(E' / kPa);E'' / MPa",
            lambda: (np.log(_W / 2 / np.pi), np.log(_STORAGE / 1e3), _LOSS / 1e6),
        ),
        (
            "log10 omega;Speichermodul E';Verlustfaktor tan δ\nrad/s;MPa;",
            lambda: (np.log10(_W), _STORAGE / 1e6, _LOSS / _STORAGE),
        ),
    ],
    ids=["log10", "log and lg", "ln", "a row of units"],
)
def test_logarithms_are_read_as_their_headings_say(tmp_path, heads, columns):
    rows = (";".join(f"{v:.9g}" for v in row) for row in np.column_stack(columns()))
    (tmp_path / "a.csv").write_text("\n".join([heads, *rows]))
    (sweep,) = read_dynamic(tmp_path / "a.csv")
    np.testing.assert_allclose(sweep.angular_frequency, _W, rtol=1e-6)
    np.testing.assert_allclose(sweep.storage_modulus, _STORAGE, rtol=1e-6)
    np.testing.assert_allclose(sweep.loss_modulus, _LOSS, rtol=1e-6)


@pytest.mark.parametrize(
    ("head", "row", "wrong"),
    [
        ("f (Hz);E' (MPa);E'' (MPa)", "Hz;kPa;MPa", 'column E\'.*"MPa" and "kPa"'),
        ("f (Hz);E' (MPa);E'' (MPa)", "rad/s;MPa;MPa", 'column f.*"Hz" and "rad/s"'),
        ("f (Hz);E' (MPa);E'' (MPa)", "[Hz];[N/mm²];[MPa]", None),
    ],
)
def test_two_units_that_contradict_each_other_stop(tmp_path, head, row, wrong):
    lines = (f"{w:g};{s / 1e6:g};{loss / 1e6:g}"
             for w, s, loss in zip(_W, _STORAGE, _LOSS, strict=True))  # fmt: skip
    (tmp_path / "a.csv").write_text("\n".join([head, row, *lines]))
    if wrong is None:
        assert len(read_dynamic(tmp_path / "a.csv")) == 1
        return
    with pytest.raises(DataError, match=wrong):
        read_dynamic(tmp_path / "a.csv")


def test_units_that_stand_in_the_cells_count(tmp_path):
    rows = (f"{w / 2 / np.pi:.9g} Hz;{s / 1e6:.9g} MPa;{100 * loss / s:.9g} %"
            for w, s, loss in zip(_W, _STORAGE, _LOSS, strict=True))  # fmt: skip
    (tmp_path / "a.csv").write_text("\n".join(["Frequency;Storage modulus;Loss factor", *rows]))
    (sweep,) = read_dynamic(tmp_path / "a.csv")
    np.testing.assert_allclose(sweep.angular_frequency, _W, rtol=1e-6)
    np.testing.assert_allclose(sweep.storage_modulus, _STORAGE, rtol=1e-6)
    np.testing.assert_allclose(sweep.loss_modulus, _LOSS, rtol=1e-6)


def test_an_angular_frequency_in_hertz_contradicts_itself(tmp_path):
    rows = "\n".join(f"{f};2e6;1e5" for f in (1, 2, 4, 8))
    (tmp_path / "a.csv").write_text(f"Angular frequency (Hz);G' (Pa);G'' (Pa)\n{rows}\n")
    with pytest.raises(DataError, match="contradict"):
        read_dynamic(tmp_path / "a.csv")


def test_the_two_ways_to_write_an_angular_frequency_agree():
    per_second, radians = (read_dynamic(FORMS / f"d_{name}.csv")[0] for name in ("1s", "rad"))
    np.testing.assert_allclose(per_second.angular_frequency, radians.angular_frequency)


@pytest.mark.parametrize("name", ["rheocompass_utf16.csv", "rheocompass_table.txt"])
def test_a_rheometers_export_as_it_is(name):
    test = read_rubber(FORMS / name)
    (sweep,) = test.sweeps
    assert test.shear is True
    assert test.notes
    assert sweep.angular_frequency.size == 41
    assert sweep.angular_frequency[0] == pytest.approx(0.1)
    assert sweep.storage_modulus[0] == pytest.approx(1.00002e6)


@pytest.mark.parametrize(("name", "count"), [("mt_2K.csv", 41), ("mt_ramp.csv", 91)])
def test_steps_and_ramps_are_sweeps_of_what_the_machine_held(name, count):
    from underfoot.material import dynamic_master_curve

    sweeps = read_dynamic(FORMS / name)
    assert len(sweeps) == count
    master = dynamic_master_curve(sweeps, 296.15)
    celsius = master.shifts.temperatures - 273.15
    law = -8.86 * (celsius - 25) / (101.6 + celsius - 25)
    law -= np.interp(23, celsius, law)
    # 0.1 decades: the readings are 0.1 K off what was held, 0.04 decades a step at the coldest
    np.testing.assert_allclose(master.shifts.log10_shift_factors, law, atol=0.1)
    at_room = np.interp(0.0, np.log10(master.angular_frequency / (2 * np.pi)),
                        master.storage_modulus)  # fmt: skip
    assert at_room == pytest.approx(5.11e6, rel=0.01)


def test_a_ramp_of_three_frequencies_is_a_master_curve_and_one_of_one_is_told(tmp_path):
    from underfoot.material import dynamic_master_curve

    lines = (FORMS / "mt_ramp.csv").read_text().splitlines()
    three = tmp_path / "three.csv"
    three.write_text("\n".join(line for line in lines if not line.startswith("3,")))
    law = dynamic_master_curve(read_dynamic(three), 298.15).shifts.wlf
    assert (law.c1, law.c2) == pytest.approx((8.86, 101.6), rel=0.05)
    one = tmp_path / "one.csv"
    one.write_text("\n".join([lines[0], *(line for line in lines if line.startswith("1,"))]))
    with pytest.raises(DataError, match="one frequency, 1 Hz"):
        read_dynamic(one)


@pytest.mark.parametrize(
    ("content", "size", "shear"),
    [
        ("[step]\nFrequency sweep\nAngular frequency\tStorage modulus\tLoss modulus\tTemperature"
         "\nrad/s\tPa\tPa\t°C\n1\t2e6\t1e5\t25\n2\t2e6\t1e5\t25\n4\t2e6\t1e5\t25\n\n[step]\n"
         "Angular frequency\tStorage modulus\tLoss modulus\tTemperature\nrad/s\tPa\tPa\t°C\n"
         "1\t3e6\t1e5\t5\n2\t3e6\t1e5\t5\n4\t3e6\t1e5\t5\n", 2, None),
        ("Temperatur [°C];Frequenz [Hz];|E*| [MPa];E' [MPa];E\" [MPa];tan delta\n"
         "-20,0;0,1;5,01;5,0;0,25;0,05\n-20,0;1;5,01;5,0;0,25;0,05\n-20,1;10;5,01;5,0;0,25;0,05\n",
         1, False),
        ("Meas. Pts.\tAngular Frequency\tStorage Modulus\tLoss Modulus\tStatus\n\t[1/s]\t[Pa]\t[Pa]"
         "\t[]\n1\t1\t2e6\t1e5\tDy_auto\n2\t2\t2e6\t1e5\tDy_auto\n3\t4\t2e6\t1e5\tWMa\n", 1, True),
    ],
    ids=["several steps", "German", "states in words"],
)  # fmt: skip
def test_exports_of_other_programs(tmp_path, content, size, shear):
    (tmp_path / "a.txt").write_text(content, encoding="utf-8")
    test = read_rubber(tmp_path / "a.txt")
    assert len(test.sweeps) == size
    assert test.shear is shear


@pytest.mark.parametrize(
    ("between", "after", "says"),
    [
        ("-- pause --\n", "", None),
        ("", "Mean;5;3\nEnd of test\n", None),
        ("x;5;1\n", "", '"x" in line 6'),
        ("5;bad;1\n", "", "missing in the column E'"),
        ("5;7x;1\n", "", '"7x" in line 6'),
    ],
)
def test_no_rows_are_lost_between_lines_that_are_none(tmp_path, between, after, says):
    rows = [f"{f};5;1\n" for f in (1, 2, 4, 8, 16, 32, 64, 128)]
    head = "f (Hz);E' (MPa);E'' (MPa)\n"
    path = tmp_path / "a.csv"
    path.write_text("".join([head, *rows[:4], between, *rows[4:], after]))
    if says is not None:
        with pytest.raises(DataError, match=says):
            read_dynamic(path)
        return
    (sweep,) = read_dynamic(path)
    assert sweep.angular_frequency.size == 8


def test_moduli_of_both_kinds_are_not_mixed(tmp_path):
    rows = "".join(f"{f},1,0.1,3,0.3\n" for f in (1, 2, 4, 8))
    (tmp_path / "a.csv").write_text(f"f (Hz),G' (MPa),G'' (MPa),E' (MPa),E'' (MPa)\n{rows}")
    test = read_rubber(tmp_path / "a.csv")
    assert test.shear is False
    assert test.sweeps[0].storage_modulus[0] == pytest.approx(3e6)
    assert test.sweeps[0].loss_modulus[0] == pytest.approx(0.3e6)


def test_a_clock_that_starts_again_starts_a_test(tmp_path):
    rows = "".join(f"{t},{5 - 0.1 * t}\n" for _ in range(3) for t in (1, 2, 4, 8, 16))
    (tmp_path / "a.csv").write_text(f"t (s),E (MPa)\n{rows}")
    assert len(read_relaxation(tmp_path / "a.csv")) == 3


@given(
    st.sampled_from([0.5, 1.0, 2.0, 3.0, 5.0, 10.0]),
    st.integers(4, 9),
    st.sampled_from(["sweeps", "up and down", "frequencies", "cooling"]),
    st.integers(0, 2**31),
)
@settings(deadline=None, max_examples=40)
def test_what_was_held_is_found_in_any_order(tmp_path_factory, step, count, order, seed):
    path = tmp_path_factory.mktemp("held") / "a.csv"
    rng = np.random.default_rng(seed)
    held = -20.0 + step * np.arange(count)
    w = np.geomspace(1, 100, 5)
    rows = [(f, t) for t in (held[::-1] if order == "cooling" else held) for f in w]
    if order == "up and down":
        rows = [(f, t) for t in held for f in (*w, *w[::-1])]
    if order == "frequencies":
        rows = [(f, t) for f in w for t in held]
    jitter = rng.uniform(-0.04, 0.04, len(rows)) * step
    path.write_text(
        "f (Hz),E' (MPa),E'' (MPa),T (degC)\n"
        + "".join(f"{f:.6g},5,1,{t + j:.4f}\n" for (f, t), j in zip(rows, jitter, strict=True))
    )
    sweeps = read_dynamic(path)
    assert len(sweeps) == count
    found = [sweep.temperature - 273.15 for sweep in sweeps]
    np.testing.assert_allclose(found, held, atol=0.05 * step)


def printed(value, decimal, mark):
    """Return a number of seven digits with the signs of a country."""
    shown = f"{value:.6e}" if abs(value) < 1e-2 else f"{value:,.7g}"
    if "e" not in shown:
        shown = f"{value:,.{max(0, 6 - int(np.floor(np.log10(abs(value)))))}f}"
    return shown.replace(",", "\0").replace(".", decimal).replace("\0", mark)


NAMES = {
    "frequency": ["f", "Frequency", "Frequenz", "Prüffrequenz", "FREQ"],
    "angular": ["w", "ω", "omega", "Angular Frequency", "Kreisfrequenz"],
    "storage": ["G'", "G’", "Storage modulus G'", "Storage Modulus (G')", "G_stor"],
    "loss": ["G''", 'G"', "Loss modulus G''", "G_loss"],
    "tangent": ["tan delta", "tan(delta)", "Loss Factor", "Verlustfaktor", "tan δ"],
    "size": ["|G*|", "G*", "Complex shear modulus"],
    "phase": ["phase angle", "Phasenwinkel", "Phase shift"],
    "viscosity": ["Complex Viscosity", "|η*|", "Komplexe Viskosität"],
    "compliance": ["J'"],
    "lost": ["J''", 'J"'],
    "temperature": ["T", "Temperature", "Temperatur"],
}
HEAD = {
    "brackets": lambda name, unit: f"{name} [{unit}]",
    "parentheses": lambda name, unit: f"{name} ({unit})",
    "slash": lambda name, unit: f"{name} / {unit}",
    "row": lambda name, unit: name,
    "bracketed row": lambda name, unit: name,
}


@st.composite
def written_sweeps(draw):
    """Draw a file of a sweep: (text, encoding, angular frequencies, complex shear moduli)."""
    w = np.geomspace(0.1, 1e3, draw(st.integers(5, 25)))
    g = TRUTH(w)
    pair = draw(st.sampled_from(["moduli", "tangent", "size", "viscosity", "compliance"]))
    angular = draw(st.booleans())
    axis_unit = draw(st.sampled_from(["rad/s", "1/s", "s^-1"] if angular else ["Hz", "1/s"]))
    axis = (draw(st.sampled_from(NAMES["angular" if angular else "frequency"])), axis_unit,
            w if angular else w / (2 * np.pi))  # fmt: skip
    kind, size = draw(st.sampled_from([("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6)]))

    def named(key, unit, values):
        return draw(st.sampled_from(NAMES[key])), unit, values

    tangent, degrees = g.imag / g.real, np.degrees(np.angle(g))
    storage, loss, softness = g.real / size, g.imag / size, 1e6 / g
    pairs = {
        "moduli": (("storage", kind, storage), ("loss", kind, loss)),
        "tangent": (("storage", kind, storage), ("tangent", "-", tangent)),
        "size": (("size", kind, abs(g) / size), ("phase", "°", degrees)),
        "viscosity": (("viscosity", "Pa·s", abs(g) / w), ("phase", "deg", degrees)),
        "compliance": (("compliance", "1/MPa", softness.real), ("lost", "1/MPa", -softness.imag)),
    }
    columns = [axis, *(named(*column) for column in pairs[pair])]
    columns.append(named("temperature", "°C", np.full(w.size, 23.5)))
    decimal = draw(st.sampled_from([".", ","]))
    separator = draw(st.sampled_from(["\t", ";", ","]))
    mark = draw(st.sampled_from(["", " ", "'", {".": ",", ",": "."}[decimal]]))
    quoted = draw(st.booleans()) or separator in (decimal, mark)
    style = draw(st.sampled_from(sorted(HEAD)))

    def line(cells):
        return separator.join(
            f'"{c.replace(chr(34), chr(34) * 2)}"' if quoted else c for c in cells
        )

    lines = [line([HEAD[style](name, unit) for name, unit, _ in columns])]
    if style == "row":
        lines.append(line([unit for _, unit, _ in columns]))
    if style == "bracketed row":
        lines.append(line([f"[{unit}]" for _, unit, _ in columns]))
    lines += [
        line([printed(value, decimal, mark) for value in row])
        for row in zip(*(values for *_, values in columns), strict=True)
    ]
    before = draw(st.sampled_from([[], ["Project: sole", "", "Test of 2026-03-02", ""]]))
    after = draw(st.sampled_from([[], ["", "End of test"]]))
    return "\n".join([*before, *lines, *after, ""]), draw(
        st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-le"])
    ), w, g  # fmt: skip


@given(written_sweeps())
@settings(deadline=None, max_examples=100, suppress_health_check=[HealthCheck.too_slow])
def test_a_sweep_gives_its_numbers_in_every_form(tmp_path_factory, sweep):
    content, encoding, w, g = sweep
    path = tmp_path_factory.mktemp("sweep") / "a.txt"
    path.write_bytes(content.encode(encoding))
    test = read_rubber(path)
    (found,) = test.sweeps
    assert test.shear is True
    assert found.temperature == pytest.approx(296.65)
    np.testing.assert_allclose(found.angular_frequency, w, rtol=1e-5)
    np.testing.assert_allclose(found.storage_modulus, g.real, rtol=1e-4)
    np.testing.assert_allclose(found.loss_modulus, g.imag, rtol=1e-4)


@pytest.mark.parametrize(("unit", "stops"), [("MPa", False), ("kPa", True)])
def test_a_loss_factor_that_contradicts_the_moduli_stops(tmp_path, unit, stops):
    """The loss modulus won in silence; with a wrong unit nothing was lost at any frequency."""
    path = tmp_path / "sweep.csv"
    rows = "".join(f"{f},5.0,{0.1 * f},{0.02 * f:.2f}\n" for f in (1, 2, 3, 5, 8))
    path.write_text(f"f (Hz),E' (MPa),E'' ({unit}),tan delta\n{rows}", encoding="utf-8")
    if stops:
        with pytest.raises(DataError, match="6e-05 in the middle"):
            read_rubber(path)
    else:
        (sweep,) = read_rubber(path).sweeps
        np.testing.assert_allclose(sweep.loss_modulus, 1e5 * np.array([1, 2, 3, 5, 8]))


def test_a_unit_in_the_heading_goes_before_the_one_for_columns_without(tmp_path):
    """A file in MPa read with ``--unit kPa`` was a thousand times too soft."""
    (tmp_path / "E.csv").write_text(
        "f (Hz),E_stor (MPa),E_loss (MPa)\n0.1,2,0.2\n1,3,0.4\n10,4,0.6\n"
    )
    (tmp_path / "bare.csv").write_text("f (Hz),E_stor,E_loss\n0.1,2,0.2\n1,3,0.4\n10,4,0.6\n")
    said, bare = (
        read_rubber(tmp_path / name, modulus_unit="kPa").sweeps[0].storage_modulus
        for name in ("E.csv", "bare.csv")
    )
    assert said == pytest.approx([2e6, 3e6, 4e6])
    assert bare == pytest.approx([2e3, 3e3, 4e3])
    # a unit by the column's own name corrects the file
    (sweep,) = read_dynamic(tmp_path / "E.csv", units={"E_stor": "kPa", "E_loss": "kPa"})
    assert sweep.storage_modulus == pytest.approx([2e3, 3e3, 4e3])
