"""Reading heights: a real stylus file (MIT, see tests/data) and files well and badly formed."""

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from underfoot.core import DataError, MissingExtraError
from underfoot.surface import (
    HeightMap,
    Profile,
    height_numbers,
    level_surface,
    profile_roughness,
    profile_spectrum,
    read_dektak,
    read_instrument,
    read_map,
    read_profile,
    read_surface,
    shortest_reliable_wavelength,
)

DEKTAK = Path(__file__).parents[1] / "data" / "roughness" / "dektak-1.csv"


def _write(tmp_path, text, name="heights.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def test_the_stylus_file_gives_its_instruments_own_numbers():
    profile, results = read_dektak(DEKTAK)
    assert profile.heights.size == 9600
    assert profile.spacing == pytest.approx(0.15625e-6, rel=1e-6)
    assert profile.tip_radius == pytest.approx(2.5e-6)
    assert "rounded in print" in profile.processing[0]
    printed = {result.name: result for result in results}
    part = printed["Ra"]
    numbers = height_numbers(level_surface(profile.section(part.start, part.end)).heights)
    # The header prints Ra 0.00525 um, Rq 0.01143 um, skewness 6.96: half a digit.
    assert numbers.ra == pytest.approx(printed["Ra"].value, abs=0.9e-11)
    assert numbers.rq == pytest.approx(printed["Rq"].value, abs=0.9e-11)
    assert numbers.rsk == pytest.approx(printed["Skew"].value, abs=0.006)
    # Its largest deviation from the mean line, printed as WMaxDev.
    assert numbers.rp == pytest.approx(printed["WMaxDev"].value, abs=1e-11)


def test_the_stylus_file_has_limits():
    profile = read_surface(DEKTAK)
    assert isinstance(profile, Profile)
    limit = shortest_reliable_wavelength(profile)
    assert limit.wavelength > 5 * profile.spacing
    assert "tip" in limit.reason
    spectrum = profile_spectrum(profile)
    assert spectrum.reliable[1] == pytest.approx(2 * np.pi / limit.wavelength)
    numbers = profile_roughness(profile, 80e-6, 2.5e-6)
    assert numbers.evaluation_length == pytest.approx(400e-6)
    assert "80 um / 2.5 um" in str(numbers)


def test_the_stylus_file_through_surface_topography_is_the_same():
    pytest.importorskip("SurfaceTopography")
    ours, _ = read_dektak(DEKTAK)
    with pytest.raises(DataError, match="uneven"):
        read_instrument(DEKTAK)  # it keeps the printed, rounded positions
    theirs = read_instrument(DEKTAK, resample=True)
    assert "resampled" in " ".join(theirs.processing)
    np.testing.assert_allclose(theirs.heights, ours.heights, atol=2e-8)


def test_an_instruments_map_through_surface_topography(tmp_path):
    topography = pytest.importorskip("SurfaceTopography")
    z = np.random.default_rng(0).standard_normal((12, 10))
    made = topography.Topography(z, (24.0, 20.0), unit="µm")
    made.to_x3p(str(tmp_path / "a.x3p"))
    found = read_surface(tmp_path / "a.x3p")
    assert isinstance(found, HeightMap)
    assert found.spacing == pytest.approx(2e-6)
    np.testing.assert_allclose(found.heights, z * 1e-6, atol=1e-12)
    skewed = topography.Topography(z, (24.0, 40.0), unit="µm")
    skewed.to_x3p(str(tmp_path / "b.x3p"))
    oblong = read_instrument(tmp_path / "b.x3p")
    assert oblong.spacings == pytest.approx((2e-6, 4e-6))
    assert oblong.size == pytest.approx((24e-6, 40e-6))


def test_no_surface_topography_is_a_missing_extra(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "SurfaceTopography", None)
    path = _write(tmp_path, "x\0", "a.plux")
    with pytest.raises(MissingExtraError, match="instruments"):
        read_surface(path)


def test_what_no_instrument_wrote(tmp_path):
    pytest.importorskip("SurfaceTopography")
    with pytest.raises(DataError, match="can't be read"):
        read_instrument(_write(tmp_path, "hello", "a.sdf"))


def test_profile_with_units_decimal_commas_and_header(tmp_path):
    text = "Instrument: X\nDate: 1.2.2024 10:00\nx [mm]; z [µm]\n" + "\n".join(
        f"{str(0.01 * i).replace('.', ',')};{str(round(0.1 * i % 0.7, 3)).replace('.', ',')}"
        for i in range(20)
    )
    profile = read_surface(_write(tmp_path, text, encoding="latin-1"))
    assert profile.spacing == pytest.approx(1e-5)
    assert profile.heights[3] == pytest.approx(0.3e-6)
    assert "decimal commas" in profile.processing[0]
    same = read_profile(
        _write(tmp_path, "\n".join(f"{0.01 * i:.2f} {i % 3}" for i in range(9)), "b.txt"),
        length_unit="mm",
        height_unit="um",
    )
    assert same.heights[2] == pytest.approx(2e-6)
    blanks = read_profile(_write(tmp_path, "x mm z um\n0,0 1,5\n0,1 2,5\n0,2 3,5", "c.txt"))
    np.testing.assert_allclose(blanks.heights, [1.5e-6, 2.5e-6, 3.5e-6])


def test_one_column_and_matrix_need_a_spacing(tmp_path):
    column = _write(tmp_path, "z (nm)\n1\n2\n3\n", "a.txt")
    with pytest.raises(DataError, match="spacing"):
        read_profile(column)
    np.testing.assert_allclose(read_profile(column, spacing=1e-6).heights, [1e-9, 2e-9, 3e-9])
    matrix = _write(tmp_path, "height in um\n1 2 3 4\n5 6 7 8\n", "b.txt")
    with pytest.raises(DataError, match="spacing"):
        read_map(matrix)
    found = read_map(matrix, spacing=1e-6)
    assert found.shape == (4, 2)  # a line of the file runs along x
    assert found.heights[2, 1] == pytest.approx(7e-6)


def test_xyz_in_any_order(tmp_path):
    rows = [(0.5 * i, 0.5 * j, i + 10 * j) for j in range(3) for i in range(4)]
    text = "x [mm],y [mm],z [um]\n" + "\n".join(",".join(map(str, row)) for row in rows)
    found = read_surface(_write(tmp_path, text, "a.xyz"))
    assert found.shape == (4, 3)
    assert found.spacing == pytest.approx(0.5e-3)
    assert found.heights[3, 2] == pytest.approx(23e-6)
    hole = "\n".join(line for line in text.splitlines() if not line.startswith("0.5,0.5"))
    with pytest.raises(DataError, match="1 of 12 heights are missing"):
        read_map(_write(tmp_path, hole, "b.xyz"))


def test_missing_heights_are_counted_and_filled_on_request(tmp_path):
    lines = [f"{i},{'nan' if i == 7 else i}" for i in range(50)]
    path = _write(tmp_path, "x um,z nm\n" + "\n".join(lines))
    with pytest.raises(DataError, match="1 of 50 heights are missing, the first in line 9"):
        read_profile(path)
    whole = read_profile(path, fill_missing=True)
    assert whole.heights[7] == pytest.approx(7e-9)
    assert "1 of 50 missing heights interpolated" in whole.processing
    many = _write(
        tmp_path, "x um,z nm\n" + "\n".join(f"{i},{'' if i % 2 else 1}" for i in range(50))
    )
    with pytest.raises(DataError, match="up to 5 %"):
        read_profile(many, fill_missing=True)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x,z\n1,2\n2,3\n3,4", "no unit of length"),
        ("Length 12.5 mm\nx,z\n1,2\n2,3\n3,4", "no unit of length"),
        ("x [mm],z\n1,2\n2,3\n3,4", "one unit"),
        ("nothing here", "no rows of numbers"),
        ("x um,z nm\n1,2\n2,3\n3,4\n9,6", "uneven"),
        ("x um,z nm\n1,2\n2,3\n1,4\n5,6", "does not follow"),
        ("x um,z nm\n1,2\n2,3,4\n", "3 values"),
        ("x um,z nm\n1,2\n2,x\n", '"x" in line 3'),
        ("a um,b,c,d nm\n1,2,3,4\n", "4 columns"),
    ],
)
def test_bad_profiles_are_refused(tmp_path, text, says):
    with pytest.raises(DataError, match=says):
        read_profile(_write(tmp_path, text))


def test_uneven_positions_are_resampled_only_on_request(tmp_path):
    path = _write(
        tmp_path, "x um,z nm\n" + "\n".join(f"{i + 0.3 * (i % 2)},{i}" for i in range(12))
    )
    with pytest.raises(DataError, match="resample"):
        read_profile(path)
    even = read_profile(path, resample=True)
    assert "resampled linearly" in even.processing[0]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x mm,y mm,z um\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n1,1,2", "more than once"),
        ("x mm,y mm,z um\n0,0,1\n0,1,1\n1,0,1\n1.3,1,1\n2,1,3\n2,0,3", "uneven"),
        ("x mm,y mm,z um\n0,0,1\n0,1,1\n0,2,1\n0,3,1", "same x"),
        ("z um\n1\n2\n3", "one column"),
    ],
)
def test_bad_maps_are_refused(tmp_path, text, says):
    with pytest.raises(DataError, match=says):
        read_map(_write(tmp_path, text))


def test_files_that_are_none(tmp_path):
    for reader in (read_profile, read_map, read_surface, read_dektak, read_instrument):
        with pytest.raises(DataError, match="no such file"):
            reader(tmp_path / "none.txt")
    with pytest.raises(DataError, match="binary"):
        read_profile(_write(tmp_path, "\0\0\0", "a.txt"))
    with pytest.raises(DataError, match="not a Dektak"):
        read_dektak(_write(tmp_path, "x um,z nm\n1,2"))
    with pytest.raises(DataError, match=r"line 2: .* has no unit"):
        read_dektak(_write(tmp_path, "Scan Parameters\nLateral um\n1,2"))
    with pytest.raises(DataError, match="length"):
        read_profile(_write(tmp_path, "1 2\n2 3\n"), length_unit="kg", height_unit="um")


def test_a_map_of_another_library_keeps_which_side_is_which(tmp_path, monkeypatch):
    """A stand-in for the library: 3 by 2 points, 6 µm by 8 µm, heights in nm."""
    heights = np.array([[1.0, 2.0], [3.0, 5.0], [8.0, 13.0]])
    topography = SimpleNamespace(
        heights=lambda: heights, dim=2, unit="nm", physical_sizes=(6000.0, 8000.0),
        is_periodic=True,
    )  # fmt: skip
    library = SimpleNamespace(read_topography=lambda _: topography)
    monkeypatch.setitem(sys.modules, "SurfaceTopography", library)
    read = read_surface(_write(tmp_path, "x\0", "a.plux"))
    assert isinstance(read, HeightMap)
    assert read.heights == pytest.approx(1e-9 * heights)
    assert read.spacings == pytest.approx((2e-6, 4e-6))
    assert read.periodic
