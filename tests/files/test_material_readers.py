"""Text tables and Prony series, well and badly formed."""

import numpy as np
import pytest

from underfoot.core import DataError, InputError
from underfoot.material import read_dynamic, read_prony, read_relaxation


def _write(tmp_path, text, name="test.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


ROWS = "\n".join(f"{t},{e}" for t, e in ((1, 8), (10, 6), (100, 5), (1000, 4.5)))


def test_units_in_headings_rows_and_arguments_agree(tmp_path):
    heading = _write(tmp_path, "t (s),E_relax [MPa]\n" + ROWS, "a.csv")
    row = _write(tmp_path, "t,E_relax\ns,MPa\n" + ROWS, "b.csv")
    bare = _write(tmp_path, "t,E_relax\n" + ROWS, "c.csv")
    expected = [8e6, 6e6, 5e6, 4.5e6]
    for curves in (
        read_relaxation(heading),
        read_relaxation(row),
        read_relaxation(bare, units={"t": "s", "E_relax": "MPa"}),
    ):
        np.testing.assert_allclose(curves[0].modulus, expected)
        np.testing.assert_allclose(curves[0].time, [1, 10, 100, 1000])
    with pytest.raises(DataError, match="no unit"):
        read_relaxation(bare)
    with pytest.raises(DataError, match="kg"):
        read_relaxation(bare, units={"t": "s", "E_relax": "kg"})


def test_decimal_commas_semicolons_tabs_and_latin_1(tmp_path):
    text = "f;E_stor;E_loss;T\nHz;MPa;MPa;°C\n" + "\n".join(
        f"{f};{e};{v};20,5"
        for f, e, v in (
            ("0,1", "10,5", "1,5"),
            ("1", "11", "1,6"),
            ("10", "12", "1,7"),
            ("100", "13,5", "1,8"),
        )
    )
    (sweep,) = read_dynamic(_write(tmp_path, text, encoding="latin-1"))
    assert sweep.temperature == pytest.approx(293.65)
    assert sweep.storage_modulus[0] == pytest.approx(10.5e6)
    assert sweep.angular_frequency[0] == pytest.approx(0.2 * np.pi)
    (tabbed,) = read_dynamic(_write(tmp_path, text.replace(";", "\t"), "t.txt"))
    np.testing.assert_array_equal(tabbed.loss_modulus, sweep.loss_modulus)


def test_sets_are_found_by_temperature(tmp_path):
    rows = [(w, 10 + k, 1, 20 + 10 * k) for k in range(3) for w in (1, 2, 4, 8)]
    text = "omega (rad/s),E_stor (MPa),E_loss (MPa),T (degC)\n" + "\n".join(
        ",".join(map(str, row)) for row in rows
    )
    sweeps = read_dynamic(_write(tmp_path, text))
    assert [round(s.temperature - 273.15) for s in sweeps] == [20, 30, 40]
    np.testing.assert_allclose(sweeps[0].angular_frequency, [1, 2, 4, 8])


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("t (s),E_relax (MPa)\n1,8\n2,\n3,6\n4,5", "missing in the column E_relax.*line 3"),
        ("t (s),E_relax (MPa)\n1,8\n2,nan\n3,6\n4,5", "missing in the column E_relax"),
        ("t (s),E_relax (MPa),T (C),Set\n1,8,20,1\n2,7,20,\n3,6,20,1", "the column Set.*line 3"),
        ("t (s),E_relax (MPa)\n1,8\n2,x7\n3,6\n4,5", '"x7" in line 3'),
        ("t (s),E_relax (MPa)\n1,8,1,5\n2,0,7,3\n3,0,6,1\n4,0,5,2", "both separator and decimal"),
        ("t (s),E_relax (MPa)\n1,8,2\n2,7,3", "3 values for 2 headings"),
        ("1,8\n2,7\n3,6\n4,5", "no headings"),
        ("t (s),E_relax (MPa)\n", "no table"),
        ("t,E_relax\ns,MPa\n", "no numbers"),
        ("time (s),force (N)\n1,8\n2,7\n3,6\n4,5", "no column for relaxation modulus"),
        ("t (s),t (s)\n1,8\n2,7", "twice"),
        ("t (s),E_relax (MPa)\n1,8\n2,7\n2,6\n4,5", "time goes from"),
        ("t (s),E_relax (MPa)\n1,8\n2,-7\n3,6\n4,5", "row 2 is -7"),
    ],
)
def test_bad_tables_are_refused(tmp_path, text, says):
    with pytest.raises(DataError, match=says):
        read_relaxation(_write(tmp_path, text))


def test_no_file(tmp_path):
    with pytest.raises(DataError, match="no such file"):
        read_relaxation(tmp_path / "none.csv")
    with pytest.raises(DataError, match="no such file"):
        read_prony(tmp_path / "none.toml")


def test_prony_absolute_normalised_shear_and_toml_agree(tmp_path):
    absolute = read_prony(
        _write(tmp_path, "tau (s),E_i (MPa)\n0.1,2\n10,1", "a.csv"), equilibrium_modulus=1e6
    )
    fractions = read_prony(
        _write(tmp_path, "tau (s),e_i\n0.1,0.5\n10,0.25", "b.csv"), instantaneous_modulus=4e6
    )
    from_equilibrium = read_prony(tmp_path / "b.csv", equilibrium_modulus=1e6)
    shear = read_prony(
        _write(tmp_path, "tau (s),G_i (MPa)\n0.1,1\n10,0.5", "c.csv"),
        instantaneous_modulus=2e6,
        poisson_ratio=0.0,
    )
    toml = read_prony(
        _write(
            tmp_path,
            'modulus = "shear"\npoisson_ratio = 0.0\ninstantaneous_modulus = "2 MPa"\n'
            'source = "me"\n[[term]]\nrelaxation_time = "100 ms"\nfraction = 0.5\n'
            '[[term]]\nrelaxation_time = "10 s"\nfraction = 0.25\n',
            "d.toml",
        )
    )
    for spectrum in (absolute, fractions, from_equilibrium, shear, toml):
        assert spectrum.equilibrium_modulus == pytest.approx(1e6)
        np.testing.assert_allclose(spectrum.term_moduli, [2e6, 1e6])
        np.testing.assert_allclose(spectrum.relaxation_times, [0.1, 10.0])
    assert toml.source == "me"


@pytest.mark.parametrize(
    ("text", "name", "settings", "says"),
    [
        ("tau (s),e_i\n1,0.7\n2,0.7", "a.csv", {"instantaneous_modulus": 1e6}, "sum to 1.4"),
        ("tau (s),e_i\n1,-0.2", "a.csv", {"instantaneous_modulus": 1e6}, "fractions"),
        ("tau (s),e_i\n1,0.2", "a.csv", {}, "either"),
        ("tau (s),e_i\n1,1.0", "a.csv", {"equilibrium_modulus": 1e6}, "sum to 1"),
        ("tau (s),E_i (MPa)\n1,-2", "a.csv", {"equilibrium_modulus": 1e6}, "term 1"),
        ("tau (s),E_i (MPa)\n1,2", "a.csv", {"instantaneous_modulus": 1e6}, "more than"),
        ("tau (s),x\n1,2", "a.csv", {"equilibrium_modulus": 1e6}, "no column of terms"),
        ("tau,E_i (MPa)\n1,2", "a.csv", {"equilibrium_modulus": 1e6}, "no unit"),
        ("x = [", "a.toml", {}, "not valid TOML"),
        ("x = 1", "a.toml", {}, "term"),
        ('modulus = "bulk"', "a.toml", {}, "kind of modulus"),
        ('[[term]]\nmodulus = "1 MPa"', "a.toml", {}, "no relaxation_time"),
        ('[[term]]\nrelaxation_time = "1 s"', "a.toml", {}, "no modulus"),
        ('[[term]]\nrelaxation_time = "1 kg"\nfraction = 0.1', "a.toml", {}, "relaxation_time"),
    ],
)
def test_bad_prony_series_are_refused(tmp_path, text, name, settings, says):
    with pytest.raises((DataError, InputError), match=says):
        read_prony(_write(tmp_path, text, name), **settings)
