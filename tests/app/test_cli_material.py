"""From tests of a rubber to the compound of a case: what is printed and taken; bad tests."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from commands import called
from underfoot.calibrate.compound import compound_from_files
from underfoot.case import Case
from underfoot.compute.resolve import resolve_context
from underfoot.core import InputError, RangeError, to_si
from underfoot.material import power_law_spectrum, shear_modulus

ROOT = Path(__file__).parents[2]
MEASURED = ROOT / "examples" / "measured"
SWEEPS = ROOT / "tests" / "data" / "viscoelastic" / "pyvisco" / "freq_user_raw.csv"
CASE = """file_version = 2
shoe.from = "work_shoe_half_tread"
floor = "vinyl_g4"
contaminant = "detergent"
motion = "slip_tester_g4"
"""
TRUTH = power_law_spectrum(4e6, 0.1, shortest_time=1e-6, longest_time=1e4)


def written(path, heads, *columns):
    rows = [",".join(f"{x:.6g}" for x in row) for row in zip(*columns, strict=True)]
    path.write_text("\n".join([heads, *rows, ""]))
    return path


def relaxation(path, time=None, factor=1.0):
    time = np.geomspace(1e-2, 1e3, 60) if time is None else time
    return written(path, "t (s),E (MPa)", time, TRUTH.relaxation_modulus(time) * factor / 1e6)


def test_sweeps_become_a_compound_that_a_case_takes(tmp_path):
    shutil.copy(MEASURED / "dma.csv", tmp_path)
    done = called("material", "dma.csv", "--out", "compound.toml", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "Shift factors to 23 °C (WLF C1 4." in done.stdout
    assert 'file = "compound.toml"' in done.stdout
    assert {path.name for path in (tmp_path / "compound").iterdir()} >= {
        "report.html", "prony.csv", "sweep.csv", "shift_factors.csv", "sweep.png",
        "shift_factors.png",
    }  # fmt: skip
    (tmp_path / "case.toml").write_text(CASE + '[shoe.material]\nfile = "compound.toml"\n')
    case = Case.load(tmp_path / "case.toml")
    assert case.origins["shoe.material.modulus"].kind == "file"
    assert case.shoe.material.shore_a is None  # the catalogue's hardness is not beside a modulus
    # 5 MPa at 1 Hz and 25 C is what the file was made of: 5.1 MPa at 23 C
    rubber = resolve_context(case).rubber()
    assert float(rubber.complex_modulus(2 * np.pi).real) == pytest.approx(5.1e6, rel=0.02)
    tangent = [rubber.spectrum.loss_tangent(2 * np.pi * f) for f in (1, 1e3, 1e5)]
    assert tangent == pytest.approx([0.19] * 3, abs=0.005)
    assert not resolve_context(case).modulus_breaches  # tested to 1e8 rad/s
    assert "relaxation" not in case.to_toml()


def test_another_compound_takes_the_place_of_the_first_and_its_content_is_the_hash(tmp_path):
    (tmp_path / "case.toml").write_text(CASE + '[shoe.material]\nfile = "a.toml"\n')
    for name, factor in (("a", 1.0), ("b", 2.0)):
        made = compound_from_files([relaxation(tmp_path / f"{name}.csv", factor=factor)])
        (tmp_path / f"{name}.toml").write_text(made.toml())
    case = Case.load(tmp_path / "case.toml")
    other = case.replace("shoe.material.file", str(tmp_path / "b.toml"))
    ratio = other.value("shoe.material.modulus") / case.value("shoe.material.modulus")
    assert ratio == pytest.approx(2.0, rel=1e-3)
    spectra = [one.shoe.material.relaxation.equilibrium_shear_modulus for one in (case, other)]
    assert spectra[1] / spectra[0] == pytest.approx(2.0, rel=1e-2)
    assert case.hash != other.hash
    none = case.replace("shoe.material.file", None)
    assert none.shoe.material.relaxation is None
    assert none.value("shoe.material.shore_a") == 71


def test_young_and_shear_are_told_by_their_headings(tmp_path):
    w = np.geomspace(0.1, 1e3, 30)
    shear = shear_modulus(TRUTH(w), 0.49) / 1e6
    young = TRUTH(w) / 1e6
    hertz = w / (2 * np.pi)
    one = written(tmp_path / "g.csv", "f (Hz),G' (MPa),G'' (MPa)", hertz, shear.real, shear.imag)
    two = written(tmp_path / "e.csv", "f (Hz),E' (MPa),E'' (MPa)", hertz, young.real, young.imag)
    moduli = [compound_from_files([file]).modulus().value for file in (one, two)]
    assert moduli[0] == pytest.approx(moduli[1], rel=1e-3)
    assert moduli[0] == pytest.approx(TRUTH.relaxation_modulus(0.1), rel=0.02)


def test_a_compression_test_ends_in_moduli(tmp_path):
    """Eq. 13 to 16 of a made-up record whose forces are known, and of the protocol of G.1."""
    assert called("trials", "simulate", "relaxation", "--count", "2", "--out", "made",
                  folder=tmp_path).returncode == 0  # fmt: skip
    peak, final, low = 2.0 * np.array([1.0, 0.67, 0.1])
    done = called("material", "made/rubber_01.csv", "--thickness", "5.5 mm", "--area", "161 mm^2",
                  "--json", folder=tmp_path)  # fmt: skip
    import json

    read = json.loads(done.stdout)
    truth = (tmp_path / "made" / "truth.csv").read_text().splitlines()
    heads, row = truth[0].split(","), next(line for line in truth if "rubber_01" in line).split(",")
    forces = dict(zip(heads, row, strict=True))
    peak, final = (float(forces[name]) for name in ("peak_force", "final_force"))
    low = 0.1 * peak  # the ramp is straight: 0.02 T of 0.2 T
    to_modulus = 2 * 5.5e-3 / 161e-6 / (0.18 * 5.5e-3)
    assert read["short_time_modulus_Pa"][0] == pytest.approx((peak - low) * to_modulus, rel=0.02)
    assert read["long_time_modulus_Pa"][0] == pytest.approx((final - low) * to_modulus, rel=0.02)
    factor = 1 + 2 * 0.75 * (np.sqrt(161e-6) / (4 * 5.5e-3)) ** 2
    assert read["modulus_Pa"] == pytest.approx(read["short_time_modulus_Pa"][0] / factor, rel=0.02)
    assert called("trials", "analyse", "made", "--protocol", "report_g1_relaxation", "--out", "an",
                  folder=tmp_path).returncode == 0  # fmt: skip
    measurements = (tmp_path / "an" / "tables" / "measurements.csv").read_text()
    for name in ("short-time modulus", "long-time modulus", "short-time Young's modulus"):
        assert f"test,{name}," in measurements
    conditions = (tmp_path / "an" / "tables" / "conditions.csv").read_text()
    assert "short-time modulus (MPa)" in conditions


def test_a_series_takes_its_level_and_unit_from_the_command(tmp_path):
    forms = ROOT / "tests" / "data" / "rubber_forms"
    for name, options in (
        ("prony_csv.csv", ("--at-rest", "0.8 MPa")),
        ("viscoelastic.inp", ("--unit", "MPa")),
    ):
        refused = called("material", forms / name, folder=tmp_path)
        assert refused.returncode != 0
        assert options[0] in " ".join(refused.stderr.split())
        done = called("material", forms / name, *options, folder=tmp_path)
        assert done.returncode == 0, done.stderr
        assert "Young's modulus 4.5 MPa after 100 ms" in " ".join(done.stdout.split())


def test_hardness_alone(tmp_path):
    done = called("material", "--shore", "40 Shore D", "--out", "h.toml", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    (tmp_path / "case.toml").write_text(CASE + '[shoe.material]\nfile = "h.toml"\n')
    case = Case.load(tmp_path / "case.toml")
    assert case.value("shoe.material.shore_a") == 90
    assert case.shoe.material.sourced_value("shore_a").uncertainty == 5


def test_one_temperature_and_rates_never_tested_are_told(tmp_path):
    w = np.geomspace(0.6, 600, 13)
    values = TRUTH(w) / 1e6
    heads = "f (rad/s),E' (MPa),E'' (MPa)"
    written(tmp_path / "dma.csv", heads, w, values.real, values.imag)
    done = called("material", "dma.csv", "--out", "c.toml", folder=tmp_path)
    assert "One temperature was tested: no shift factors" in done.stdout.replace("\n", " ")
    assert "Its loss there is extrapolated" in done.stdout.replace("\n", " ")
    (tmp_path / "case.toml").write_text(CASE + '[shoe.material]\nfile = "c.toml"\n')
    context = resolve_context(Case.load(tmp_path / "case.toml"))
    assert [str(breach).split(":")[0] for breach in context.modulus_breaches] == ["compound"]
    # sliding starts at 5500 rad/s: the loss is that of a compound without a spectrum
    law = context_law(tmp_path)
    assert law.pair.hysteresis is None


@pytest.mark.parametrize("form", ["sweep", "sweeps", "relaxation"])
@pytest.mark.parametrize(("use", "said"), [(None, 23), ("room", 23), ("tested", None)])
def test_moduli_of_another_temperature_than_that_of_use_are_told(tmp_path, form, use, said):
    """Sweeps at 60 °C alone, or at 60 and 70, or a relaxation: none knows the modulus at 23 °C."""
    w, temperatures = np.geomspace(0.6, 600, 13), [60.0, 70.0] if form == "sweeps" else [60.0]
    if form == "relaxation":
        heads, columns = (
            "T (°C),t (s),E (MPa)",
            (1 / w[::-1], TRUTH.relaxation_modulus(1 / w[::-1])),
        )
    else:
        heads = "T (°C),f (rad/s),E' (MPa),E'' (MPa)"
        columns = (w, TRUTH(w).real, TRUTH(w).imag)
    rows = [
        [
            np.full(13, at),
            columns[0],
            *(part / 1e6 * (333.15 / (at + 273.15)) for part in columns[1:]),
        ]
        for at in temperatures
    ]
    path = written(tmp_path / "test.csv", heads, *np.concatenate(rows, axis=1))
    kelvin = {None: None, "room": 296.15, "tested": 333.15}[use]
    if form == "sweeps" and use == "room":
        with pytest.raises(RangeError, match="the temperatures tested"):
            compound_from_files([path], temperature=kelvin)
        return
    told = [
        line
        for line in compound_from_files([path], temperature=kelvin).warnings
        if line.startswith("Tested at ")
    ]
    assert [line.split(",")[1] for line in told] == [f" used at {said} °C: not shifted."] * bool(
        said
    )


@pytest.mark.parametrize("form", ["sweep", "relaxation", "series"])
@pytest.mark.parametrize(("use", "at"), [(None, 23), (296.15, 23), (278.15, 5)])
def test_a_test_that_names_no_temperature_is_told(tmp_path, form, use, at):
    """It counts as one at the temperature of use: a note at 23 °C, elsewhere a warning."""
    w = np.geomspace(0.6, 600, 13)
    heads, columns = {
        "sweep": ("f (rad/s),E' (MPa),E'' (MPa)", (w, TRUTH(w).real / 1e6, TRUTH(w).imag / 1e6)),
        "relaxation": ("t (s),E (MPa)", (1 / w[::-1], TRUTH.relaxation_modulus(1 / w[::-1]) / 1e6)),
        "series": ("tau (s),E_i (MPa)", (np.array([0.01, 1.0, np.inf]), np.array([2.0, 1.0, 3.0]))),
    }[form]
    found = compound_from_files([written(tmp_path / "test.csv", heads, *columns)], temperature=use)
    told = f"no test names its temperature: that of use is assumed, {at} °C"
    assert (told in found.notes, told in found.warnings) == (at == 23, at != 23)


def context_law(folder):
    case = Case.load(folder / "case.toml")
    return case.friction.build(resolve_context(case))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda path: relaxation(path, factor=np.linspace(1.0, 3.0, 60)),
            "a relaxation falls. Allowed: rises of at most 5%",
        ),
        (
            lambda path: written(path, "a (mm),b (N)", [1, 2, 3], [1, 2, 3]),
            "is no test of a rubber",
        ),
        (
            lambda path: written(path, "t (s),E", [1, 2, 3, 4, 5], [5, 4, 3, 2, 1]),
            "no unit is given",
        ),
    ],
    ids=["rises", "no test", "no unit"],
)
def test_tests_that_cannot_be_used_are_told_and_nothing_is_written(tmp_path, make, words):
    make(tmp_path / "test.csv")
    done = called("material", "test.csv", "--out", "c.toml", folder=tmp_path)
    assert done.returncode != 0
    assert words in " ".join(done.stderr.split())
    assert not (tmp_path / "c.toml").exists()


def test_superposition_that_fails_is_told(tmp_path):
    done = called("material", SWEEPS, folder=tmp_path)
    assert "follows the readings roughly" in " ".join(done.stdout.split())


def test_a_compound_of_another_form_is_refused(tmp_path):
    (tmp_path / "c.toml").write_text('modulos = "5 MPa"\n')
    (tmp_path / "case.toml").write_text(CASE + '[shoe.material]\nfile = "c.toml"\n')
    with pytest.raises(InputError, match=r"a compound has no modulos.*modulus"):
        Case.load(tmp_path / "case.toml")


def test_units_of_the_file_are_those_of_a_case(tmp_path):
    made = compound_from_files([relaxation(tmp_path / "a.csv")])
    line = next(row for row in made.toml().splitlines() if row.startswith("fastest_tested"))
    assert to_si(line.split('"')[1], "rad/s", where="") == pytest.approx(100.0)
