"""Prony series written as decks: read back, they are the same rubber."""

import os
import re
import shutil
import subprocess

import numpy as np
import pytest

from commands import called
from underfoot.core import InputError
from underfoot.material import RelaxationSpectrum
from underfoot.material.decks import read_deck
from underfoot.material.elastomer import shear_from_young
from underfoot.material.write_decks import FORMS, deck_text, write_deck

SERIES = RelaxationSpectrum(2e6, [3e6, 1e6, 0.5e6], [1e-4, 0.05, 3.0])
SHEAR = shear_from_young(SERIES, 0.49)


@pytest.mark.parametrize("ending", [".inp", ".k", ".feb"])
@pytest.mark.parametrize("unit", ["MPa", "Pa"])
def test_a_deck_is_read_back_as_the_same_series(tmp_path, ending, unit):
    path = tmp_path / f"rubber{ending}"
    write_deck(path, SERIES, unit=unit)
    deck = read_deck(path, unit)
    assert deck.shear
    assert deck.series.equilibrium_modulus == pytest.approx(SHEAR.equilibrium_modulus, rel=1e-7)
    np.testing.assert_allclose(deck.series.term_moduli, SHEAR.term_moduli, rtol=1e-7)
    np.testing.assert_allclose(deck.series.relaxation_times, SHEAR.relaxation_times, rtol=1e-7)
    with pytest.raises(InputError, match="exists"):
        write_deck(path, SERIES)


def test_ansys_has_fractions_of_moduli_at_once():
    text = deck_text(SERIES, "ANSYS")
    values = {line.split(",")[1]: float(line.split(",")[3]) for line in text.splitlines()
              if line.startswith("MP")}  # fmt: skip
    rows = [[float(one) for one in line.split(",")[2:]] for line in text.splitlines()
            if line.startswith("TBDATA")]  # fmt: skip
    assert values["EX"] == pytest.approx(6.5, rel=1e-6)
    assert values["PRXY"] == pytest.approx(0.49, rel=1e-6)
    left = 1.0 - sum(share for share, _ in rows)
    assert left * values["EX"] == pytest.approx(2.0, rel=1e-6)
    assert [tau for _, tau in rows] == pytest.approx([1e-4, 0.05, 3.0])


def test_what_a_program_cannot_hold_is_refused(tmp_path):
    many = RelaxationSpectrum(1e6, np.ones(7) * 1e5, np.logspace(-3, 3, 7))
    with pytest.raises(InputError, match=r"7 terms.*at most 6"):
        deck_text(many, "FEBio")
    with pytest.raises(InputError, match="nothing is left at rest"):
        deck_text(RelaxationSpectrum(0.0, [1e6], [1.0]), "FEBio")
    with pytest.raises(InputError, match="has no bulk modulus"):
        deck_text(SERIES, "Abaqus", poisson_ratio=0.5)
    with pytest.raises(InputError, match=r"\.inp \(Abaqus\)"):
        write_deck(tmp_path / "a.txt", SERIES)


def test_the_command_writes_a_deck(tmp_path):
    given = tmp_path / "prony.csv"
    given.write_text("tau (s),E_i (MPa)\n0.05,3\ninf,2\n")
    for ending in FORMS:
        out = tmp_path / f"deck_of{ending[1:]}{ending}"
        assert called("material", str(given), "--young", "--out", str(out)).returncode == 0
        assert out.stat().st_size > 100
    deck = read_deck(tmp_path / "deck_ofinp.inp", "MPa")
    assert deck.series.instantaneous_modulus == pytest.approx(5e6 / 2 / 1.49, rel=1e-6)


# a check by the program itself, which desks and CI seldom have; the numbers are held above
@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
@pytest.mark.parametrize(("stretched", "right"), [(False, SHEAR.instantaneous_modulus / 1e6),
                                                  (True, 6.5 * 0.51 / (1.49 * 0.02))])  # fmt: skip
def test_calculix_finds_the_moduli_at_once(tmp_path, stretched, right):
    """A brick of 1 mm, its top moved by 1e-4 mm along it or away from it: G, and E at held width.

    CalculiX knows no *VISCOELASTIC: what stands above it is the material at once.
    """
    material = deck_text(SERIES, "Abaqus").split("*VISCOELASTIC")[0]
    material = material.replace(", MODULI=INSTANTANEOUS", "")
    corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    lines = ["*NODE, NSET=ALL", *(f"{n}, {x}., {y}., {z}." for n, (x, y, z) in
                                  enumerate(corners, start=1))]  # fmt: skip
    lines += ["*ELEMENT, TYPE=C3D8, ELSET=BRICK", "1, 1, 2, 3, 4, 5, 6, 7, 8"]
    lines += [material.strip(), "*SOLID SECTION, ELSET=BRICK, MATERIAL=RUBBER"]
    axis = 3 if stretched else 1
    fixed = [f"{n}, {k}, {k}, {1e-4 if n > 4 and k == axis else 0.0}"
             for n in range(1, 9) for k in (1, 2, 3)]  # fmt: skip
    lines += ["*STEP, NLGEOM", "*STATIC", "*BOUNDARY", *fixed]
    lines += ["*NODE PRINT, NSET=ALL", "RF", "*END STEP"]
    (tmp_path / "a.inp").write_text("\n".join(lines) + "\n")
    subprocess.run(["ccx", "a"], cwd=tmp_path, check=True, capture_output=True, timeout=60,
                   env={**os.environ, "OMP_NUM_THREADS": "1"})  # fmt: skip
    rows = re.findall(r"^ +([5-8])" + r" +(\S+)" * 3, (tmp_path / "a.dat").read_text(), re.M)
    force = sum(float(row[axis]) for row in rows)
    assert force / 1e-4 == pytest.approx(right, rel=2e-3)
