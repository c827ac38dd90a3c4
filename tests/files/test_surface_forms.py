"""One surface in every form that people have: the same heights, or an error that says why."""

import hashlib
import io
import json
import struct
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from commands import called
from underfoot.core import DataError
from underfoot.core.missing import mask_of_codes
from underfoot.surface import (
    HeightMap,
    Profile,
    level_surface,
    profile_roughness,
    profile_spectrum,
    read_instrument,
    read_scan,
    read_surface,
    self_affine,
    square_cells,
    write_surface,
)
from underfoot.surface.lay import texture

EVEN, UNEVEN = (1e-5, 1e-5), (1e-5, 1.6e-5)  # m, the sides of cells
FORMS = Path(__file__).parents[1] / "data" / "surface_forms"
UNITS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9}


def gsf(z, sides, xy_unit="m", z_unit="m"):
    """Return a Gwyddion Simple Field of heights (nx, ny), m."""
    nx, ny = z.shape
    head = (
        f"Gwyddion Simple Field 1.0\nXRes = {nx}\nYRes = {ny}\n"
        f"XReal = {nx * sides[0] / UNITS[xy_unit]!r}\nYReal = {ny * sides[1] / UNITS[xy_unit]!r}\n"
        f"XYUnits = {xy_unit}\nZUnits = {z_unit}\nTitle = floor\n"
    ).encode()
    head += b"\0" * (4 - len(head) % 4)
    return head + (z.T / UNITS[z_unit]).astype("<f4").tobytes()


SDF_TYPES = {3: "<f4", 5: "<i2", 6: "<i4", 7: "<f8"}


def sdf(z, sides, version="ISO-1.0", kind=7, binary=True):
    """Return SDF of ISO 25178-71; a height that is missing is the least value of its type.

    The greatest one in BCR-1.0.
    """
    scale = 1.0 if kind in (3, 7) else 1e-9
    values = np.rint(z.T / scale) if scale < 1 else z.T / scale
    if not binary:
        head = (
            f"a{version}\r\nManufacID = own\r\nCreateDate = 020320261200\r\n"
            f"ModDate = 020320261200\r\nNumPoints = {z.shape[0]}\r\nNumProfiles = {z.shape[1]}\r\n"
            f"Xscale = {sides[0]!r}\r\nYscale = {sides[1]!r}\r\nZscale = {scale!r}\r\n"
            f"Zresolution = -1\r\nCompression = 0\r\nDataType = {kind}\r\nCheckType = 0\r\n*\r\n"
        )
        shown = float if kind in (3, 7) else int
        ordered = values[::-1] if version.startswith("BCR") else values
        rows = ("BAD" if np.isnan(v) else repr(shown(v)) for v in ordered.ravel())
        return (head + "\r\n".join(rows) + "\r\n*\r\n*\r\n").encode()
    dtype = np.dtype(SDF_TYPES[kind])
    bounds = np.finfo(dtype) if kind in (3, 7) else np.iinfo(dtype)
    bad = bounds.max if version.startswith("BCR") else bounds.min
    values = np.where(np.isnan(values), bad, values).astype(dtype)
    if version.startswith("BCR"):
        values = values[::-1]
    counts = "II" if version == "ISO-2.0" else "HH"
    head = struct.pack(
        f"<8s10s12s12s{counts}ddddBBB",
        f"b{version}".encode(), b"own".ljust(10), b"020320261200", b"020320261200",
        z.shape[0], z.shape[1], *sides, scale, -1.0, 0, kind, 0,
    )  # fmt: skip
    return head + values.tobytes()


def x3p(z, sides, revision="ISO5436 - 2000", kind="D", feature="SUR", wrong_sum=False):
    """Return X3P of ISO 25178-72."""
    scale = 1e-9 if kind in "IL" else 1.0
    values = (np.rint(z.T / scale) if scale < 1 else z.T).astype(
        {"D": "<f8", "F": "<f4", "L": "<i4", "I": "<i2"}[kind]
    )
    data = values.tobytes()
    shape = z.shape if z.ndim == 2 else (z.size, 1)

    def axis(name, sort, kind, step):
        return (f"<{name}><AxisType>{sort}</AxisType><DataType>{kind}</DataType>"
                f"<Increment>{step!r}</Increment><Offset>0</Offset></{name}>")  # fmt: skip

    main = (
        '<?xml version="1.0" encoding="UTF-8"?><p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/'
        f'ISO5436_2"><Record1><Revision>{revision}</Revision><FeatureType>{feature}</FeatureType>'
        f"<Axes>{axis('CX', 'I', 'D', sides[0])}{axis('CY', 'I', 'D', sides[-1])}"
        f"{axis('CZ', 'A', kind, scale)}</Axes></Record1><Record2><Date>2026-03-02T00:00:00</Date>"
        "<Instrument><Manufacturer>own</Manufacturer><Model>none</Model><Serial>1</Serial><Version>"
        "1</Version></Instrument><CalibrationDate>2026-01-01T00:00:00</CalibrationDate>"
        "<ProbingSystem><Type>NonContacting</Type><Identification>1</Identification>"
        f"</ProbingSystem></Record2><Record3><MatrixDimension><SizeX>{shape[0]}</SizeX>"
        f"<SizeY>{shape[1]}</SizeY><SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>"
        f"bindata/data.bin</PointDataLink><MD5ChecksumPointData>{hashlib.md5(data).hexdigest()}"
        "</MD5ChecksumPointData></DataLink></Record3><Record4><ChecksumFile>md5checksum.hex"
        "</ChecksumFile></Record4></p:ISO5436_2>"
    ).encode()
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("main.xml", main)
        archive.writestr("bindata/data.bin", data)
        meant = data if wrong_sum else main
        archive.writestr("md5checksum.hex", f"{hashlib.md5(meant).hexdigest()} *main.xml")
    return stream.getvalue()


def gwyddion_text(z, sides, words=("Channel", "Width", "Height", "Value units")):
    lines = [
        f"# {words[0]}: floor",
        f"# {words[1]}: {1e6 * sides[0] * z.shape[0]!r} µm",
        f"# {words[2]}: {1e6 * sides[1] * z.shape[1]!r} µm",
        f"# {words[3]}: m",
    ]
    return "\n".join([*lines, *("\t".join(f"{v!r}" for v in row) for row in z.T.tolist())]).encode()


def xyz(z, sides, separator="\t", decimal=".", order=(0, 1), quoted=False):
    rows = []
    for i, j in sorted(np.ndindex(z.shape), key=lambda at: [at[k] for k in order]):
        cells = [f"{1e3 * i * sides[0]:.7f}", f"{1e3 * j * sides[1]:.7f}", f"{1e6 * z[i, j]:.7f}"]
        cells = [cell.replace(".", decimal) for cell in cells]
        rows.append(separator.join(f'"{cell}"' if quoted else cell for cell in cells))
    head = separator.join(["x [mm]", "y [mm]", "z [um]"])
    return "\n".join([head, *rows]).encode()


@st.composite
def written_maps(draw):
    """Draw a file of a map: (bytes, suffix, heights, distances, tolerance in m)."""
    nx, ny = draw(st.integers(3, 12)), draw(st.integers(3, 12))
    rng = np.random.default_rng(draw(st.integers(0, 2**31)))
    z = np.round(rng.normal(0.0, 5e-6, (nx, ny)), 9)
    sides = draw(st.sampled_from([(1e-5, 1e-5), (1.6e-5, 3.2e-5), (4e-6, 1e-6)]))
    form = draw(st.sampled_from(["gsf", "sdf", "x3p", "gwyddion", "xyz"]))
    suffix = draw(st.sampled_from([f".{form}", ".dat", ".txt", ".bin", ""]))
    if form == "gsf":
        units = draw(st.sampled_from(sorted(UNITS))), draw(st.sampled_from(sorted(UNITS)))
        return gsf(z, sides, *units), suffix, z, sides, 1e-11
    if form == "sdf":
        version = draw(st.sampled_from(["ISO-1.0", "ISO-2.0", "BCR-1.0"]))
        kind = draw(st.sampled_from([5, 6, 7] if version == "ISO-1.0" else [3, 5, 6, 7]))
        return sdf(z, sides, version, kind, draw(st.booleans())), suffix, z, sides, 1e-11
    if form == "x3p":
        revision = draw(
            st.sampled_from(["ISO5436 - 2000", "ISO5436 – 2000", "ISO25178-72:2017/DAM1"])
        )
        made = x3p(z, sides, revision, draw(st.sampled_from("DFLI")), wrong_sum=draw(st.booleans()))
        return made, suffix, z, sides, 1e-11
    suffix = draw(st.sampled_from([".txt", ".dat", ".asc", ".xyz"]))
    if form == "gwyddion":
        german = ("Kanal", "Breite", "Höhe", "Werteinheiten")
        words = draw(st.sampled_from([("Channel", "Width", "Height", "Value units"), german]))
        return gwyddion_text(z, sides, words), suffix, z, sides, 1e-12
    decimal = draw(st.sampled_from(".,"))
    separator = draw(st.sampled_from("\t;,"))
    quoted = draw(st.booleans()) or separator == decimal
    order = draw(st.sampled_from([(0, 1), (1, 0)]))
    return xyz(z, sides, separator, decimal, order, quoted), suffix, z, sides, 1e-12


@given(written_maps())
@settings(deadline=None, max_examples=120)
def test_a_map_gives_its_heights_in_every_form(tmp_path_factory, made):
    data, suffix, z, sides, close = made
    path = tmp_path_factory.mktemp("map") / f"floor{suffix}"
    path.write_bytes(data)
    found = read_surface(path)
    assert isinstance(found, HeightMap)
    assert found.spacings == pytest.approx(sides, rel=1e-5)
    np.testing.assert_allclose(found.heights, z, atol=close)


@pytest.mark.parametrize("version", ["ISO-1.0", "ISO-2.0", "BCR-1.0"])
@pytest.mark.parametrize("kind", [5, 6, 7])
@pytest.mark.parametrize("binary", [True, False])
def test_missing_points_of_sdf_are_missing(tmp_path, version, kind, binary):
    z = np.random.default_rng(1).normal(0.0, 5e-6, (12, 12))
    z[3, 4] = np.nan
    (tmp_path / "a.sdf").write_bytes(sdf(z, (1e-5, 1e-5), version, kind, binary))
    with pytest.raises(DataError, match="1 of 144 heights are missing"):
        read_surface(tmp_path / "a.sdf")
    filled = read_surface(tmp_path / "a.sdf", fill_missing=True)
    assert np.abs(filled.heights).max() < 1e-4


def test_profiles_of_x3p_and_quoted_text():
    profile = read_surface(FORMS / "profile.x3p")
    assert isinstance(profile, Profile)
    assert profile.spacing == pytest.approx(16e-6)
    assert np.std(level_surface(profile).heights) == pytest.approx(5.29e-6, rel=1e-3)
    quoted = read_surface(FORMS / "quoted_decimal_comma.csv")
    assert quoted.spacing == pytest.approx(2e-6)
    assert quoted.heights[:2] == pytest.approx([1.2811e-6, 2.1374e-6])


def test_an_archive_that_unpacks_to_far_more_than_its_size_is_refused(tmp_path):
    path = tmp_path / "a.x3p"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("main.xml", "<a/>")
        archive.writestr("bindata/data.bin", bytes(70_000_000))
    with pytest.raises(DataError, match="times its size"):
        read_surface(path)


def test_words_above_and_below_a_profile_are_left_out(tmp_path):
    rows = "".join(f"{i / 100:.2f};{i * 3.1:.1f}\n" for i in range(9)).replace(".", ",")
    path = tmp_path / "a.csv"
    path.write_text(f"Instrument;X\nCutoff;0,8 mm\nPosition [mm];Height [µm]\n{rows}Ra;1,5\n")
    found = read_surface(path)
    assert found.heights.size == 9
    assert "lines of words below the numbers left out: 1" in found.processing
    path.write_text(f"x [mm];z [µm]\n{rows}Ra;1,5\n0,09;3\n")
    with pytest.raises(DataError, match='"Ra" in line 11'):
        read_surface(path)


def test_two_units_of_the_heights_stop(tmp_path):
    rows = "\n".join(f"{i * 0.01:.2f};{i % 7}" for i in range(300))
    for row, fits in (("mm;nm", False), ("mm;µm", True)):
        (tmp_path / "a.csv").write_text(f"Distance [mm];Height [um]\n{row}\n{rows}\n")
        if fits:
            assert np.ptp(read_surface(tmp_path / "a.csv").heights) == pytest.approx(6e-6)
            continue
        with pytest.raises(DataError, match='"nm" and "um"'):
            read_surface(tmp_path / "a.csv")


def test_a_pure_sine_has_no_spread_of_rounding():
    scan = read_scan(FORMS / "sine_profile.csv")
    assert scan.values["rq"].value == pytest.approx(3.42e-6, rel=2e-3)
    assert scan.values["rq"].uncertainty is None


@pytest.mark.parametrize(
    ("name", "data", "says"),
    [
        ("a.dat", b"\x88\x1b\x03o\0\0\0\1" + bytes(range(256)), "format is not known"),
        ("a.sdf", b"%PDF-1.7 \0\0", "PDF"),
        ("a.x3p", b"\x89PNG\r\n\x1a\n\0\0", "picture"),
        ("a.sdf", sdf(np.ones((4, 4)) * 1e-6, (1e-5, 1e-5))[:-20], "damaged SDF"),
        ("a.gsf", gsf(np.ones((4, 4)) * 1e-6, (1e-5, 1e-5))[:-4], "cut short"),
        ("a.gsf", gsf(np.ones((4, 4)), (1e-5, 1e-5)).replace(b"ZUnit", b"AUnit"), "ZUnits"),
        ("a.x3p", x3p(np.ones((4, 4)), (1e-5, 1e-5))[:-30], "damaged archive"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_named_in_one_line(tmp_path, name, data, says):
    pytest.importorskip("SurfaceTopography")
    (tmp_path / name).write_bytes(data)
    with pytest.raises(DataError, match=says) as raised:
        read_surface(tmp_path / name)
    message = str(raised.value)
    assert len(message) < 350 + len(str(tmp_path))
    assert message.isprintable()
    for other in ("AL3D", "OPDx", "JPK", "Reader"):
        assert other not in message


def ridges(degrees, nx=256, ny=160, sides=(1e-5, 1e-5)):
    """Return a sine of 5 um and 320 um whose crests are at an angle from x."""
    x, y = np.arange(nx)[:, None] * sides[0], np.arange(ny)[None, :] * sides[1]
    across = np.radians(degrees - 90)
    u = x * np.cos(across) + y * np.sin(across)
    return HeightMap(5e-6 * np.sin(2 * np.pi * u / 320e-6), sides[0], spacing_y=sides[1])


@pytest.mark.parametrize("code", ["-9999", "9999.0", "-32768", "1e30"])
@pytest.mark.parametrize("count", [1, 4])
def test_codes_for_missing_heights_are_no_heights(tmp_path, code, count):
    x = np.arange(200) * 5.0
    z = 3.0 * np.sin(2 * np.pi * x / 100.0)
    lost = range(50, 50 + count)
    rows = [f"{a:.1f},{code if n in lost else f'{b:.5f}'}" for n, (a, b) in
            enumerate(zip(x, z, strict=True))]  # fmt: skip
    (tmp_path / "a.csv").write_text("x (um),z (um)\n" + "\n".join(rows))
    with pytest.raises(DataError, match=f"{count} of 200 heights are missing"):
        read_surface(tmp_path / "a.csv")
    filled = read_surface(tmp_path / "a.csv", fill_missing=True)
    assert filled.heights.std() == pytest.approx(3e-6 / np.sqrt(2), rel=0.01)


@pytest.mark.parametrize("heights", [[0, 1, 2, 3, 9], [0, 5, 5, 0], [1, 1, 1], [0, 1, 2, 9, 9]])
def test_steps_and_peaks_are_no_codes(heights):
    assert not mask_of_codes(np.array(heights, dtype=float)).any()


@pytest.mark.parametrize(
    ("heading", "along", "up"),
    [
        ("x (inch),z (mil)", 0.0254, 25.4e-6),
        ("x (inches),z (µin)", 0.0254, 25.4e-9),
        ("Lateral (mm),Raw (Å)", 1e-3, 1e-10),
        ("Lateral [mm],Height [Angstrom]", 1e-3, 1e-10),
        ("x (in),z (uin)", 0.0254, 25.4e-9),
        ("x (cm),z (um)", 0.01, 1e-6),
    ],
)
def test_units_of_other_workshops(tmp_path, heading, along, up):
    x = np.arange(200) * 5e-6
    z = 3e-6 * np.sin(2 * np.pi * x / 1e-4)
    rows = "\n".join(f"{a / along:.9f},{b / up:.9f}" for a, b in zip(x, z, strict=True))
    (tmp_path / "a.csv").write_text(f"{heading}\n{rows}\n")
    profile = read_surface(tmp_path / "a.csv")
    assert profile.spacing == pytest.approx(5e-6, rel=1e-4)
    assert profile.heights.std() == pytest.approx(3e-6 / np.sqrt(2), rel=1e-4)


@pytest.mark.parametrize("first", [0, 1])
def test_a_column_that_counts_the_rows_is_no_position(tmp_path, first):
    x = np.arange(200) * 5e-6
    z = 3e-6 * np.sin(2 * np.pi * x / 1e-4)
    rows = "\n".join(
        f"{n},{a * 1e3:.6f},{b * 1e6:.6f}" for n, (a, b) in enumerate(zip(x, z, strict=True), first)
    )
    (tmp_path / "a.csv").write_text(f"Point,x (mm),z (um)\n{rows}\n")
    profile = read_surface(tmp_path / "a.csv")
    assert profile.spacing == pytest.approx(5e-6, rel=1e-4)
    assert profile.heights.std() == pytest.approx(3e-6 / np.sqrt(2), rel=1e-4)
    (tmp_path / "a.csv").write_text(f"x (um),a (um),b (um)\n{rows}\n")
    with pytest.raises(DataError, match="are no map"):
        read_surface(tmp_path / "a.csv")


@pytest.mark.parametrize(
    ("degrees", "sides"),
    [(0, EVEN), (30, UNEVEN), (45, EVEN), (90, UNEVEN), (135, UNEVEN), (160, EVEN)],
)
def test_a_lay_is_named_and_numbers_are_across_it(tmp_path, degrees, sides):
    made = ridges(degrees, 256, 256, sides)
    (tmp_path / "a.gsf").write_bytes(gsf(made.heights, sides))
    scan = read_scan(tmp_path / "a.gsf")
    # five points of the coarser axis to a wave: of 80 um, the filter takes 2.6 % more of 320 um
    close = 0.02 if sides[0] == sides[1] else 0.04
    assert scan.texture.has_lay
    assert np.degrees(scan.texture.direction) == pytest.approx(degrees, abs=1.5)
    assert scan.texture.ratio < 0.3
    assert scan.values["ra"].value == pytest.approx(3.07e-6, rel=close)
    assert scan.values["rq"].value == pytest.approx(3.42e-6, rel=close)
    assert scan.values["rt"].value == pytest.approx(9.67e-6, rel=close)
    assert "lay" in " ".join(scan.headline())


@pytest.mark.parametrize(
    ("first", "second", "ratio", "sides"),
    [
        (0, 90, 1.0, EVEN),
        (0, 90, 0.5, UNEVEN),
        (20, 110, 0.5, UNEVEN),
        (30, 150, 1.0, UNEVEN),
        (45, 100, 0.5, UNEVEN),
        (45, 100, 1.0, EVEN),
    ],
)
def test_crossed_lays_are_named_and_both_count(tmp_path, first, second, ratio, sides):
    one, other = (ridges(angle, 256, 256, sides).heights for angle in (first, second))
    (tmp_path / "a.gsf").write_bytes(gsf(one + ratio * other, sides))
    scan = read_scan(tmp_path / "a.gsf")
    found = np.degrees(scan.texture.lays)
    assert found.size == 2
    for lay in (first, second):
        assert abs((found - lay + 90) % 180 - 90).min() < 2
    heights = one + ratio * other
    assert scan.values["rq"].value == pytest.approx(3.42e-6 * np.hypot(1, ratio), rel=0.04)
    # a stylus between the lays meets longer waves: of 452 um the filter takes 11 %, not 3 %
    assert 0.8 < scan.values["ra"].value / np.abs(heights).mean() < 1.01
    assert scan.values["rt"].value < np.ptp(heights)
    assert "crossed lays" in " ".join(scan.headline())


@pytest.mark.parametrize("waves", [0.8, 1.2, 1.5, 2.5, 4.5])
@pytest.mark.parametrize("degrees", [0, 90, 30])
def test_a_lay_of_few_waves_is_one_lay(waves, degrees):
    # a window over so few waves turns some of their power by tens of degrees
    x, y = np.meshgrid(np.arange(176) * 1e-5, np.arange(48) * 1e-5, indexing="ij")
    across = np.radians(degrees + 90)
    phase = 2 * np.pi * waves / 48e-5 * (x * np.cos(across) + y * np.sin(across))
    found = texture(HeightMap(5e-6 * np.sin(phase), 1e-5))
    assert found is not None
    assert len(found.lays) <= 1
    if waves > 1:
        turned = (np.degrees(found.lays[0]) - degrees + 90) % 180 - 90
        assert turned == pytest.approx(0.0, abs=6.0)


def test_noise_of_single_points_has_no_lay():
    heights = np.random.default_rng(1).standard_normal((128, 160)) * 1e-6
    assert not texture(HeightMap(heights, 1e-5)).has_lay


@pytest.mark.parametrize("seed", range(4))
def test_a_random_isotropic_map_has_no_lay(seed):
    made = self_affine(256, 1e-5, 5e-6, 0.8, 1e-3, 8e-5, seed)
    found = texture(HeightMap(made.heights[:200, :200], 1e-5))
    assert not found.has_lay


def test_sliding_along_a_lay_loses_less_than_across(tmp_path):
    from underfoot.material import power_law_spectrum
    from underfoot.rough_contact import persson

    rubber = power_law_spectrum(1.3e6, 0.12)
    q = np.geomspace(2 * np.pi / 0.6e-3, 2 * np.pi / 5e-5, 60)
    losses = {}
    for degrees in (0, 90):
        (tmp_path / "a.gsf").write_bytes(gsf(ridges(degrees).heights, (1e-5, 1e-5)))
        scan = read_scan(tmp_path / "a.gsf")
        given = (1e6, q, scan.density(q), rubber.complex_modulus, 0.3, 0.49)
        losses[degrees] = persson(*given, directions=scan.directions_at(q)).cof_hysteresis[0]
        alike = persson(*given).cof_hysteresis[0]
    assert losses[90] > 1.3 * alike
    assert losses[0] < 0.3 * alike


def test_a_case_slides_along_the_x_of_a_scanned_floor(tmp_path):
    from underfoot.calibrate.compound import compound_from_files
    from underfoot.case import Case
    from underfoot.compute.resolve import resolve_context

    dma = Path(__file__).parents[2] / "examples" / "measured" / "dma.csv"
    (tmp_path / "compound.toml").write_text(compound_from_files([dma]).toml())
    losses = {}
    for degrees in (0, 90):
        (tmp_path / f"{degrees}.gsf").write_bytes(gsf(ridges(degrees).heights, (1e-5, 1e-5)))
        (tmp_path / "case.toml").write_text(
            'file_version = 2\nshoe.from = "work_shoe_half_tread"\nfloor.from = "vinyl_g4"\n'
            'contaminant = "detergent"\nmotion = "slip_tester_g4"\n'
            f'shoe.material.file = "compound.toml"\nfloor.roughness.file = "{degrees}.gsf"\n'
        )
        case = Case.load(tmp_path / "case.toml")
        assert case.value("floor.roughness.rq") == pytest.approx(3.42e-6, rel=0.01)
        assert case.value("floor.roughness.rt") == pytest.approx(9.67e-6, rel=0.01)
        losses[degrees] = case.friction.build(resolve_context(case)).pair.hysteresis
    assert losses[90] > 5 * losses[0] > 0


def test_shares_of_all_directions_alike_are_the_isotropic_integral():
    from underfoot.material import power_law_spectrum
    from underfoot.rough_contact import persson

    rubber = power_law_spectrum(1.3e6, 0.12)
    q = np.geomspace(1e4, 1e6, 40)
    density = 1e-22 * (q / 1e4) ** -3.6
    angles = (np.arange(400) + 0.5) * np.pi / 800
    given = (1e6, q, density, rubber.complex_modulus, 0.3, 0.49)
    directions = (np.tile(np.cos(angles), (40, 1)), np.full((40, 400), 1 / 400))
    alike, shared = persson(*given), persson(*given, directions=directions)
    np.testing.assert_allclose(shared.cof_hysteresis, alike.cof_hysteresis, rtol=1e-4)
    np.testing.assert_allclose(shared.real_contact_fraction, alike.real_contact_fraction, rtol=1e-4)


def test_oblong_cells_keep_their_axes_and_can_be_made_square(tmp_path):
    made = ridges(0, 128, 128, (1e-5, 2e-5))
    (tmp_path / "a.x3p").write_bytes(x3p(made.heights, (1e-5, 2e-5)))
    found = read_instrument(tmp_path / "a.x3p")
    spectrum = profile_spectrum(found, axis=1)
    highest = spectrum.wavenumber[np.argmax(spectrum.density)]
    assert 2 * np.pi / highest == pytest.approx(320e-6, rel=0.02)
    square = square_cells(found)
    assert square.spacings == pytest.approx((1e-5, 1e-5))
    y = np.arange(square.shape[1]) * 1e-5
    wave = 5e-6 * np.sin(2 * np.pi * -y / 320e-6)
    inside = slice(4, -4)
    np.testing.assert_allclose(abs(square.heights[0, inside]), abs(wave[inside]), atol=2e-9)
    line = Profile(square.heights[0], square.spacing, resolution=4e-5)
    assert profile_roughness(line, 0.8e-3, sections=1).rq == pytest.approx(3.42e-6, rel=0.03)


@pytest.mark.parametrize("ending", ["x3p", "sdf"])
@pytest.mark.parametrize("sides", [(4e-6, 4e-6), (4e-6, 6e-6), (4e-6,)])
def test_heights_that_are_written_are_read_by_us_and_by_surface_topography(tmp_path, ending, sides):
    rng, shape = np.random.default_rng(3), (30, 20)[: len(sides)]
    heights = 1e-6 * rng.standard_normal(shape)
    surface = HeightMap(heights, *sides[:1], spacing_y=sides[1]) if len(sides) > 1 else Profile(
        heights, *sides)  # fmt: skip
    path = tmp_path / f"floor.{ending}"
    write_surface(surface, path)
    found = read_surface(path)
    np.testing.assert_allclose(found.heights, heights, rtol=1e-12)
    assert found.spacings == pytest.approx(sides, rel=1e-12)
    if ending == "x3p" and len(sides) == 1:
        return  # SurfaceTopography reads no profiles of X3P
    other = pytest.importorskip("SurfaceTopography").read_topography(str(path))
    metres = {"m": 1.0, "mm": 1e-3, "µm": 1e-6}[other.unit]
    theirs = np.squeeze(other.heights()) * metres
    np.testing.assert_allclose(theirs, heights, atol=1e-18)
    assert np.multiply(other.physical_sizes, metres)[0] == pytest.approx(30 * sides[0], rel=1e-9)


def test_the_command_writes_the_heights_it_read(tmp_path):
    scan = tmp_path / "scan.csv"
    z = np.sin(np.arange(400) / 3)
    scan.write_text("x [um];z [um]\n" + "".join(f"{4 * k};{v:.6f}\n" for k, v in enumerate(z)))
    out = tmp_path / "scan.x3p"
    assert called("surface", str(scan), "--out", str(out)).returncode == 0
    np.testing.assert_allclose(read_surface(out).heights, 1e-6 * z.round(6), atol=1e-15)
    again = called("surface", str(scan), "--out", str(out))
    assert again.returncode == 2
    assert "exists" in again.stderr


@pytest.mark.parametrize("shape", [(40,), (40, 30)])
def test_an_array_of_numpy_needs_spacing_and_unit(tmp_path, shape):
    heights = np.random.default_rng(5).standard_normal(shape)
    path = tmp_path / "heights.npy"
    np.save(path, heights.astype("f4"))
    found = read_surface(path, spacing=4e-6, height_unit="um")
    np.testing.assert_allclose(found.heights, 1e-6 * heights, rtol=1e-6)
    assert found.spacing == 4e-6
    with pytest.raises(DataError, match="no spacing"):
        read_surface(path, height_unit="um")
    with pytest.raises(DataError, match="without a unit"):
        read_surface(path, spacing=4e-6)
    np.save(path, heights.astype(complex))
    with pytest.raises(DataError, match="real heights"):
        read_surface(path, spacing=4e-6, height_unit="um")
    path.write_bytes(path.read_bytes()[:90])
    with pytest.raises(DataError, match="damaged"):
        read_surface(path, spacing=4e-6, height_unit="um")


def dump(path, fields, size):
    """As tamaas 2.9.0 writes a model: NumpyDumper (attributes as JSON text) and H5Dumper."""
    attributes = {"model_type": "model_type.basic_2d", "program": "Tamaas 2.9.0"}
    if path.suffix == ".npz":
        text = json.dumps(attributes | {"system_size": size})
        np.savez(path, attrs=np.asarray(text), **fields)
        return
    with h5py.File(path, "w") as file:
        file.attrs.update(attributes | {"system_size": np.array(size)})
        for name, values in fields.items():
            file[name] = values


@pytest.mark.parametrize("ending", ["npz", "h5"])
def test_the_surface_of_a_model_that_tamaas_dumped(tmp_path, ending):
    rng = np.random.default_rng(3)
    fields = {name: rng.standard_normal((32, 16)) for name in ("gap", "surface", "traction")}
    path = tmp_path / f"model.{ending}"
    dump(path, fields, [1.0, 2.0])
    found = read_surface(path, length_unit="mm", height_unit="um")
    np.testing.assert_allclose(found.heights, 1e-6 * fields["surface"])
    assert found.spacings == pytest.approx((1e-3 / 32, 2e-3 / 16))
    with pytest.raises(DataError, match="without a unit"):
        read_surface(path, length_unit="mm")
    with pytest.raises(DataError, match="size without a unit"):
        read_surface(path, height_unit="mm")
    assert "--length-unit" in called("surface", str(path), "--height-unit", "mm").stderr
    del fields["surface"]
    dump(path, fields, [1.0, 2.0])
    with pytest.raises(DataError, match="gap, traction"):
        read_surface(path, length_unit="mm", height_unit="um")
    dump(path, {"gap": fields["gap"]}, [1.0, 2.0])
    assert read_surface(path, length_unit="m", height_unit="m").heights.shape == (32, 16)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(DataError, match="damaged"):
        read_surface(path, length_unit="m", height_unit="m")


def forms_of_a_matrix(z):
    """Lines of a 40 by 30 map (um, cells of 5 by 4 um) with its positions, by the head."""
    x = [f"{5 * i}" for i in range(40)]
    lines = [",".join([f"{4 * j}", *(f"{v:.6f}" for v in z[:, j])]) for j in range(30)]
    heads = {"corner 0": "0", "empty corner": "", "names": "y/x"}
    return {name: "\n".join([",".join([head, *x]), *lines, ""]) for name, head in heads.items()}


@pytest.mark.parametrize("head", ["corner 0", "empty corner", "names"])
def test_positions_beside_a_matrix_are_no_heights(tmp_path, head):
    z = np.random.default_rng(4).standard_normal((40, 30))
    path = tmp_path / "map.csv"
    path.write_text(forms_of_a_matrix(z)[head])
    found = read_surface(path, length_unit="um", height_unit="um")
    np.testing.assert_allclose(found.heights, 1e-6 * z, atol=1e-12)
    assert found.spacings == pytest.approx((5e-6, 4e-6))
    assert "positions" in " ".join(found.processing)


def test_a_plane_has_no_positions_beside_it(tmp_path):
    np.savetxt(tmp_path / "a.csv", np.add.outer(np.arange(9), np.arange(12)), delimiter=",")
    found = read_surface(tmp_path / "a.csv", spacing=1e-6, height_unit="um")
    assert found.heights.shape == (12, 9)


@pytest.mark.parametrize("order", ["xyz", "yxz", "zxy", "zyx"])
def test_the_heading_says_which_column_is_which(tmp_path, order):
    z = np.random.default_rng(4).standard_normal((6, 5))
    cells = [{"x": 5 * i, "y": 4 * j, "z": 1e3 * z[i, j]} for i in range(6) for j in range(5)]
    units = {"x": "um", "y": "um", "z": "nm"}
    path = tmp_path / "map.csv"
    rows = [",".join(f"{name} [{units[name]}]" for name in order)]
    path.write_text("\n".join(rows + [",".join(f"{c[n]:.9g}" for n in order) for c in cells]))
    found = read_surface(path)
    np.testing.assert_allclose(found.heights, 1e-6 * z, atol=1e-13)
    assert found.spacings == pytest.approx((5e-6, 4e-6))


@pytest.mark.parametrize("units", [("mm", "cm", "nm"), ("um", "mm", "um"), ("in", "mm", "mil")])
def test_each_column_of_a_map_has_its_own_unit(tmp_path, units):
    z = np.random.default_rng(4).standard_normal((6, 5))
    size = {"um": 1e-6, "mm": 1e-3, "cm": 1e-2, "nm": 1e-9, "in": 25.4e-3, "mil": 25.4e-6}
    cells = [(5e-6 * i, 4e-6 * j, 1e-6 * z[i, j]) for i in range(6) for j in range(5)]
    rows = [";".join(f"{name} ({unit})" for name, unit in zip("xyz", units, strict=True))]
    rows += [";".join(f"{v / size[u]:.12g}" for v, u in zip(c, units, strict=True)) for c in cells]
    (tmp_path / "map.csv").write_text("\n".join(rows))
    found = read_surface(tmp_path / "map.csv")
    np.testing.assert_allclose(found.heights, 1e-6 * z, atol=1e-12)
    assert found.spacings == pytest.approx((5e-6, 4e-6))


def test_a_profile_may_have_its_heights_first(tmp_path):
    z = np.random.default_rng(4).standard_normal(40)
    rows = "\n".join(f"{v:.6f}\t{0.005 * i:g}" for i, v in enumerate(z))
    (tmp_path / "a.txt").write_text(f"z [um]\tx [mm]\n{rows}\n")
    found = read_surface(tmp_path / "a.txt")
    np.testing.assert_allclose(found.heights, 1e-6 * z, atol=1e-12)
    assert found.spacing == pytest.approx(5e-6)
