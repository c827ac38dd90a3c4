"""Heights: read, filled, levelled, filtered, their numbers, spectra, lays; made surfaces."""

import io
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from snapshot import held, refusal, tried
from underfoot.surface import (
    arrays,
    filter,
    generate,
    heights,
    instruments,
    lay,
    prepare,
    roughness,
    scan,
    spectrum,
)
from underfoot.surface import read as reading
from underfoot.surface.arrays import is_array, read_array
from underfoot.surface.filter import (
    holds,
    long_waves,
    mean_line,
    short_waves,
    weights,
    within_cutoffs,
)
from underfoot.surface.generate import (
    checkerboard,
    self_affine,
    sinusoidal,
    surface_from_spectrum,
    surface_of_density,
)
from underfoot.surface.heights import (
    HeightMap,
    Profile,
    profile_from_positions,
    shortest_derivable_wavelength,
    shortest_reliable_wavelength,
)
from underfoot.surface.instruments import is_instrument, is_text, length_factor, read_instrument
from underfoot.surface.lay import directions, lines_across, lines_along_axes, texture
from underfoot.surface.prepare import (
    fill_missing_heights,
    held_level,
    level_surface,
    make_periodic,
    square_cells,
    without_spikes,
)
from underfoot.surface.read import read_dektak, read_map, read_numbers, read_profile, read_surface
from underfoot.surface.roughness import (
    areal_roughness,
    height_numbers,
    profile_roughness,
    rms_slope,
)
from underfoot.surface.scan import height_cautions, read_scan, unlikely_height
from underfoot.surface.spectrum import (
    ProfileSpectrum,
    asperities,
    autocorrelation,
    average_by_band,
    correlation_length,
    isotropic_from_profile,
    isotropic_spectrum,
    power_law,
    profile_spectrum,
    rises_text,
    smooth_spectrum,
    spectral_moments,
    spectrum_by_decades,
)
from underfoot.surface.write import write_surface

N = np.arange(600)
LINE = 1e-6 * (3 * np.sin(N / 7) + np.cos(N / 31) + 0.4 * np.sin(N**1.3)) + 4e-9 * N
PROFILE = Profile(LINE, 10e-6)
FINE = replace(PROFILE, spacing=2e-6, tip_radius=2e-6)
ROUND = Profile(3e-6 * np.sin(2 * np.pi * np.arange(512) / 32), 1e-6, periodic=True)
ROUGH = self_affine((48, 40), 2e-6, 1e-6, 0.7, 60e-6, 8e-6, seed=3)
ALONG, ACROSS = np.meshgrid(np.arange(64.0), np.arange(52.0), indexing="ij")
GROUND = HeightMap(
    1e-6
    * (
        np.sin(ALONG / 2 + ACROSS / 3)
        + 0.3 * np.sin(0.7 * ALONG)
        + 0.02 * ACROSS
        + 0.2 * np.cos(ALONG * ACROSS)
    ),
    20e-6,
)
STRIPES = replace(GROUND, heights=np.sin(ALONG / 2), periodic=True)
OBLONG = replace(GROUND, spacing_y=30e-6)
CROSSED = HeightMap(
    1e-6 * (np.sin(ALONG / 1.1) + np.sin(ACROSS / 1.3)) + 1e-9 * np.cos(ALONG * ACROSS), 20e-6
)


def test_filters(file_regression):
    answers = {"weights": weights(1e-6, 8e-6, 0.5), "few": weights(1e-6, 0.5e-6, 1.0)}
    for name, surface, ends in (
        ("profile", PROFILE, ("drop", "regression")),
        ("round", ROUND, filter.ENDS),
        ("map", GROUND, ("drop", "regression")),
        ("oblong", OBLONG, ("drop", "regression")),
        ("rough", ROUGH, ("periodic",)),
    ):
        cutoff = 12 * max(surface.spacings)
        for each in ends:
            answers[f"{name} {each}"] = (
                long_waves(surface, cutoff, each),
                short_waves(surface, cutoff, each),
            )
    for ends in filter.ENDS:
        answers[f"mean {ends}"] = mean_line(LINE[:40], 1e-5, 1e-4, ends)
    answers["within"] = within_cutoffs(GROUND, 60e-6, 0.3e-3)
    answers["short left"] = within_cutoffs(GROUND, 0.1e-3, 0.3e-3)
    answers["rims left"] = within_cutoffs(GROUND, 60e-6, 0.8e-3)
    assert within_cutoffs(GROUND, 60e-6, 2e-3) is GROUND
    assert [holds(1.0, 1.0 + d) for d in (0.9e-5, 1.1e-5)] == [True, False]
    answers["refused"] = {
        "ends": refusal(long_waves, PROFILE, 1e-4, "mirror"),
        "not periodic": refusal(long_waves, PROFILE, 1e-4, "periodic"),
        "short": refusal(long_waves, PROFILE, 1.99e-5),
        "long": refusal(long_waves, PROFILE, 6.1e-3, "regression"),
        "long for drop": refusal(long_waves, PROFILE, 6.0e-3),
        "no length": refusal(long_waves, PROFILE, 0.0),
    }
    long_waves(PROFILE, 2e-5)
    long_waves(PROFILE, 6e-3, "regression")
    held(file_regression, answers)
    for ends in ("drop", "regression"):
        np.testing.assert_allclose(
            (long_waves(PROFILE, 1e-4, ends).heights + short_waves(PROFILE, 1e-4, ends).heights),
            LINE[5:-5] if ends == "drop" else LINE,
        )


def test_roughness(file_regression):
    answers = {}
    for standard in roughness.STANDARDS:
        found = profile_roughness(PROFILE, 0.8e-3, 80e-6, standard=standard)
        answers[standard] = (found, str(found))
    answers["without short"] = profile_roughness(PROFILE, 0.8e-3, sections=3, ends="regression")
    answers["periodic"] = profile_roughness(ROUND, 64e-6, sections=2, ends="periodic")
    answers["flat"] = profile_roughness(replace(PROFILE, heights=0 * LINE), 0.8e-3)
    answers["text of flat"] = str(answers["flat"])
    answers["few points"] = profile_roughness(replace(PROFILE, resolution=2e-5), 1.0e-4, 5e-5)
    answers["areal"] = {
        "plain": areal_roughness(GROUND),
        "long": areal_roughness(GROUND, 0.4e-3),
        "both": areal_roughness(GROUND, 0.4e-3, 0.1e-3, ends="regression"),
        "periodic": areal_roughness(ROUGH),
        "oblong": areal_roughness(OBLONG, None, 0.15e-3),
        "unresolved": areal_roughness(replace(GROUND, resolution=50e-6)),
        "resolved": areal_roughness(replace(GROUND, resolution=0.1e-3)),
        "small": areal_roughness(replace(GROUND, heights=GROUND.heights[:8], resolution=0.1e-3)),
        "flat": areal_roughness(replace(GROUND, heights=0 * GROUND.heights)),
    }
    answers["slopes"] = [rms_slope(one) for one in (ROUGH, GROUND, OBLONG)]
    answers["numbers"] = [height_numbers(one) for one in (LINE, GROUND.heights, [1.0, 1.0])]
    answers["elements"] = [
        roughness.element_spacing(np.sin(N / 9), 1e-6, t) for t in (0.1, 0.99, 1.1)
    ] + [roughness.element_spacing(np.sin(N[:100] / 9), 1e-6, 0.5)]
    answers["derivatives"] = (roughness.slope(LINE, 1e-5), roughness.curvature(LINE, 1e-5))
    answers["refused"] = {
        "standard": refusal(profile_roughness, PROFILE, 0.8e-3, standard="DIN"),
        "sections": refusal(profile_roughness, PROFILE, 0.8e-3, sections=0),
        "long": refusal(profile_roughness, PROFILE, 99e-6),
        "order": refusal(profile_roughness, PROFILE, 0.8e-3, 0.8e-3),
        "short": refusal(profile_roughness, PROFILE, 0.8e-3, 49e-6),
        "length": refusal(profile_roughness, PROFILE, 0.8e-3, sections=7),
        "areal": refusal(areal_roughness, GROUND, None, 99e-6),
        "missing": refusal(height_numbers, [1.0, np.nan, np.inf]),
    }
    profile_roughness(PROFILE, 0.8e-3, 50e-6, sections=6)
    held(file_regression, answers)
    x = np.linspace(0, 1, 400)
    assert roughness.slope(x**3, x[1]) == pytest.approx(3 * x[3:-3] ** 2, rel=1e-6, abs=1e-6)
    assert roughness.curvature(x**3, x[1]) == pytest.approx(6 * x[3:-3], rel=1e-5, abs=1e-5)


def test_spectra(file_regression):
    by_profile, by_map = profile_spectrum(PROFILE), isotropic_spectrum(GROUND)
    isotropic = isotropic_from_profile(profile_spectrum(FINE))
    rising = ProfileSpectrum(
        np.geomspace(1e3, 1e6, 80),
        1e-16 * np.geomspace(1, 1e-4, 80) * (1 + 0.9 * np.cos(np.arange(80))),
        (1e3, 1e6),
    )
    levelled = isotropic_from_profile(rising)
    moments = spectral_moments(isotropic)
    answers = {
        "profile": by_profile,
        "area": by_profile.area,
        "periodic": profile_spectrum(ROUND),
        "none": profile_spectrum(PROFILE, window="none"),
        "lines": profile_spectrum(GROUND, axis=1),
        "odd": profile_spectrum(replace(PROFILE, heights=LINE[:-1])),
        "map": by_map,
        "oblong": isotropic_spectrum(OBLONG),
        "of map none": isotropic_spectrum(GROUND, window="none"),
        "rough": isotropic_spectrum(ROUGH),
        "hann": isotropic_spectrum(ROUGH, window="hann"),
        "isotropic": isotropic,
        "levelled": levelled,
        "within": by_map.within(2e4, 1e5),
        "bands": average_by_band(by_map),
        "decades": spectrum_by_decades(by_map),
        "smooth": smooth_spectrum(by_map),
        "law": power_law(by_map, spectrum_by_decades(by_map)),
        "law of a profile": power_law(by_profile, isotropic),
        "law of a rise": power_law(rising, levelled),
        "moments": (
            moments,
            moments.bandwidth,
            spectral_moments(by_profile),
            spectral_moments(by_map, (3e4, 9e4)),
        ),
        "asperities": asperities(moments),
        "correlation": [autocorrelation(one) for one in (PROFILE, ROUND, GROUND)],
        "across": autocorrelation(OBLONG, axis=1),
        "lengths": [
            correlation_length(PROFILE),
            correlation_length(PROFILE, 0.2),
            correlation_length(OBLONG, axis=1),
        ],
        "rises": [rises_text(share) for share in (0.123, 9.99, 10.0, 50.0)],
        "refused": {
            "window": refusal(profile_spectrum, PROFILE, window="box"),
            "within": refusal(by_map.within, 1e9, 2e9),
            "short": refusal(isotropic_from_profile, profile_spectrum(Profile(LINE[:12], 1e-5))),
            "band": refusal(spectral_moments, by_map, (1.0, 2.0)),
            "flat": refusal(autocorrelation, replace(PROFILE, heights=0 * LINE)),
            "level": refusal(correlation_length, PROFILE, 1.0),
            "not reached": refusal(correlation_length, STRIPES, axis=1),
            "wave": refusal(asperities, replace(moments, m4=1.49 * moments.m2**2 / moments.m0)),
            "shapes": refusal(replace, by_profile, density=by_profile.density[1:]),
            "falling": refusal(replace, by_profile, wavenumber=by_profile.wavenumber[::-1]),
            "negative": refusal(replace, by_profile, density=-by_profile.density),
        },
    }
    asperities(replace(moments, m4=1.5 * moments.m2**2 / moments.m0))
    held(file_regression, answers)
    kept = np.sum(isotropic_spectrum(ROUGH).density * isotropic_spectrum(ROUGH).area)
    assert kept == pytest.approx(ROUGH.rms_height**2)


def test_lays(file_regression):
    answers = {}
    for name, one in {
        "ground": GROUND,
        "oblong": OBLONG,
        "rough": ROUGH,
        "crossed": CROSSED,
        "x": replace(GROUND, heights=np.sin(ALONG / 2)),
        "y": replace(GROUND, heights=np.sin(ACROSS / 2)),
        "one wave": replace(GROUND, heights=np.sin(ALONG / 20)),
    }.items():
        found = texture(one)
        answers[name] = {
            "texture": found,
            "text": str(found),
            "has": found.has_lay,
            "named": found.named_lays,
            "across": found.across if found.lays else None,
            "lines": [
                (len(lines), lines[0], lines[-1])
                for lines in (
                    lines_across(one, angle, 5) for angle in (0.0, 0.5 * math.pi, 0.7, 2.0, 3.12)
                )
            ],
            "along": [len(lines_along_axes(one, n)) for n in (1, 4, 99)],
            "directions": directions(one, np.geomspace(2e4, 2e5, 5)),
        }
    answers["at"] = directions(GROUND, np.geomspace(2e4, 2e5, 5)).at(np.array([1e3, 6e4, 1e7]))
    assert texture(replace(GROUND, heights=0 * ALONG)) is None
    assert lines_along_axes(PROFILE, 3) == [PROFILE]
    held(file_regression, answers)


def test_heights_prepared(file_regression):
    gaps = GROUND.heights.copy()
    gaps[3, 4:9] = gaps[20:24, 30] = gaps[0, 0] = np.nan
    line = LINE.copy()
    line[[0, 7, 8, 100]] = np.nan
    spiked = GROUND.heights.copy()
    spiked[30, 20], spiked[10, 11] = 40e-6, -60e-6
    clipped = np.minimum(LINE, 2e-6)
    answers = {
        "filled": fill_missing_heights(gaps),
        "line": fill_missing_heights(line),
        "none": fill_missing_heights(LINE),
        "many": refusal(fill_missing_heights, [1, np.nan, 2]),
        "shared": fill_missing_heights([1, np.nan, 2, 3], largest_share=0.25),
        "levels": [held_level(one) for one in (clipped, LINE, [1, 1, 1, 2, 3], np.round(LINE, 6))],
        "flat": [level_surface(GROUND, degree) for degree in range(4)],
        "flat line": [level_surface(PROFILE, degree) for degree in range(3)],
        "negative": refusal(level_surface, PROFILE, -1),
        "too many": refusal(level_surface, Profile([1.0, 2.0], 1e-6), 1),
        "spikes": without_spikes(replace(GROUND, heights=spiked)),
        "no spikes": without_spikes(PROFILE)[0].processing,
        "square": square_cells(OBLONG),
        "square across": square_cells(replace(OBLONG, spacing_y=9e-6)),
        "square round": square_cells(replace(ROUGH, spacing_y=3e-6, resolution=None)),
        "periodic": [
            make_periodic(GROUND, **how) for how in ({}, {"method": "mirror"}, {"share": 0.5})
        ],
        "method": refusal(make_periodic, GROUND, "fold"),
        "share": refusal(make_periodic, GROUND, share=0.51),
        "no share": refusal(make_periodic, GROUND, share=0.0),
    }
    assert make_periodic(ROUGH) is ROUGH
    assert square_cells(GROUND) is GROUND
    held(file_regression, answers)


def test_surfaces_and_what_they_resolve(file_regression):
    x = np.array([0.0, 1.0, 2.0, 3.005, 4.0]) * 1e-6
    z = np.arange(5.0) ** 2 * 1e-7
    uneven = np.array([0.0, 1.0, 2.0, 3.4, 4.0]) * 1e-6
    answers = {
        "map": (OBLONG, OBLONG.spacings, OBLONG.shape, OBLONG.size, OBLONG.rms_height),
        "profile": (PROFILE.positions, PROFILE.length, PROFILE.spacings),
        "section": [PROFILE.section(1e-3, 2e-3), PROFILE.section(0.0, 5.99e-3)],
        "sections refused": [
            refusal(PROFILE.section, *ends) for ends in ((-1e-4, 1e-3), (0.0, 7e-3), (1e-3, 1e-3))
        ],
        "even": profile_from_positions(x, z),
        "back": profile_from_positions(x[::-1], z),
        "rounded": profile_from_positions(np.round(x, 6) * 1.0, z, rounding=0.5e-6),
        "printed": profile_from_positions([0, 0, 1e-6, 1e-6, 2e-6], z, rounding=0.6e-6),
        "resampled": profile_from_positions(uneven, z, resample=True, tip_radius=1e-6, source="s"),
        "two": profile_from_positions([0, 2e-6], [0, 1e-6]),
        "refused": {
            "uneven": refusal(profile_from_positions, uneven, z),
            "number": refusal(profile_from_positions, x[1:], z),
            "one": refusal(profile_from_positions, [1.0], [1.0]),
            "missing": refusal(profile_from_positions, [0, np.nan, 1], [0, 1, 2]),
            "twice": refusal(profile_from_positions, [0, 1e-6, 1e-6], [0, 1, 2]),
            "heights": refusal(profile_from_positions, uneven, z * np.nan, resample=True),
            "spacing": refusal(Profile, [1, 2], 0.0),
            "axes": refusal(Profile, ALONG, 1e-6),
            "points": refusal(HeightMap, ALONG[:1], 1e-6),
            "across": refusal(HeightMap, ALONG, 1e-6, spacing_y=-1.0),
            "nan": refusal(HeightMap, ALONG * np.where(ALONG == 3, np.nan, 1), 1e-6),
            "tip": refusal(Profile, [1, 2], 1e-6, tip_radius=0.0),
        },
    }
    for name, one in {
        "line": PROFILE,
        "tip": FINE,
        "blunt": replace(FINE, tip_radius=2e-4),
        "oblong": OBLONG,
        "known": replace(PROFILE, resolution=1e-6),
        "coarse": replace(PROFILE, resolution=90e-6),
    }.items():
        answers[name] = (shortest_reliable_wavelength(one), shortest_derivable_wavelength(one))
    assert heights.POINTS_PER_WAVE == 5
    held(file_regression, answers)


def test_generated(file_regression):
    known = isotropic_spectrum(self_affine(64, 2e-6, 1e-6, 0.7, 120e-6, 8e-6, seed=1))
    answers = {
        "wave": sinusoidal((16, 4), 1e-6, 2e-6, 8e-6),
        "board": checkerboard(16, 1e-6, 2e-6, 8e-6),
        "straight": checkerboard((16, 24), 1e-6, 2e-6, 8e-6, form="triangular"),
        "affine": self_affine(32, 1e-6, 1e-6, 0.8, 32e-6, 4e-6, seed=1),
        "rolled": self_affine((32, 48), 1e-6, 1e-6, 0.5, 32e-6, 4e-6, seed=2, roll_off=16e-6),
        "ridges": self_affine(32, 1e-6, 1e-6, 0.8, 32e-6, 4e-6, seed=1, anisotropy=3.0),
        "flat": self_affine(32, 1e-6, 0.0, 0.8, 32e-6, 4e-6, seed=1).heights.max(),
        "spectrum": surface_from_spectrum(known, (32, 48), 2e-6, 5),
        "density": surface_of_density(lambda q: 1e-20 / q, (40e-6, 8e-6), (32, 40), 2e-6, 4),
        "phases": generate.random_phases(np.ones((4, 3)), (4, 4), 7),
        "refused": {
            "spectrum": refusal(surface_from_spectrum, known, 4, 1e-3, 1),
            "density": refusal(surface_of_density, lambda q: q, (1e-9, 1e-10), 8, 1e-6, 1),
            "form": refusal(checkerboard, 16, 1e-6, 1e-6, 8e-6, form="saw"),
            "wave": refusal(sinusoidal, 16, 1e-6, 1e-6, 7e-6),
            "short wave": refusal(sinusoidal, 16, 1e-6, 1e-6, 1e-6),
            "across": refusal(checkerboard, (16, 20), 1e-6, 1e-6, 8e-6),
            "grid": refusal(self_affine, 3, 1e-6, 1e-6, 0.8, 3e-6, 2e-6, seed=1),
        }
        | {
            name: refusal(
                self_affine,
                32,
                1e-6,
                **(
                    {
                        "rms_height": 1e-6,
                        "hurst": 0.8,
                        "long_cutoff": 32e-6,
                        "short_cutoff": 4e-6,
                        "seed": 1,
                    }
                    | change
                ),
            )
            for name, change in {
                "anisotropy": {"anisotropy": 0.0},
                "height": {"rms_height": -1e-6},
                "hurst": {"hurst": 1.01},
                "long": {"long_cutoff": 32.1e-6},
                "short": {"short_cutoff": 1.9e-6},
                "roll": {"roll_off": 33e-6},
                "rolled": {"roll_off": 3.9e-6},
                "cutoff": {"long_cutoff": 0.0},
                "order": {"long_cutoff": 3e-6},
                "nothing": {"long_cutoff": 5.05e-6, "short_cutoff": 5e-6},
            }.items()
        },
    }
    self_affine(32, 1e-6, 1e-6, 1.0, 32e-6, 2e-6, seed=1, roll_off=2e-6)
    self_affine(4, 1e-6, 1e-6, 0.0, 4e-6, 2e-6, seed=1)
    sinusoidal(16, 1e-6, 1e-6, 2e-6)
    held(file_regression, answers)


HEAD = "x [mm]; z [um]\n"
ROWS = [f"{k * 0.01:.2f}; {3 * math.sin(k):.3f}" for k in range(40)]


def _placed(j):
    return f"{0.2 * j:.1f} " + " ".join(str((i * i + j * j * j) % 7) for i in range(5))


GRID = [(i, j) for j in range(4) for i in range(5)]
TEXTS = {
    "plain": HEAD + "\n".join(ROWS),
    "decimal commas": (HEAD + "\n".join(ROWS)).replace(".", ","),
    "tabs": HEAD + "\n".join(ROWS).replace("; ", "\t"),
    "blanks": "# x [mm] z [um]\n" + "\n".join(ROWS).replace(";", " "),
    "closing separators": HEAD + "\n".join(row + ";" for row in ROWS),
    "words below": HEAD + "\n".join(ROWS) + "\nend of file\n",
    "other order": "z [um]; x [mm]\n" + "\n".join("; ".join(row.split("; ")[::-1]) for row in ROWS),
    "numbered": "no; x [mm]; z [um]\n" + "\n".join(f"{k}; {row}" for k, row in enumerate(ROWS)),
    "counted from 1": HEAD + "\n".join(f"{k + 1}; {row}" for k, row in enumerate(ROWS)),
    "one unit": "z [um]\n" + "\n".join(ROWS),
    "no unit": "\n".join(ROWS),
    "metres": "x [m]; z [m]\n" + "\n".join(ROWS[:5]),
    "microns": "x [microns]; z [nm]\n" + "\n".join(ROWS),
    "inches": "x [in]; z [mils]\n" + "\n".join(ROWS),
    "heights alone": "z [um]\n" + "\n".join(f"{math.sin(k):.4f}" for k in range(20)),
    "missing": HEAD + "\n".join([*ROWS[:20], "0.20; -", *ROWS[21:]]),
    "codes": HEAD + "\n".join([*ROWS[:20], "0.20; -9999", *ROWS[21:]]),
    "uneven": HEAD + "\n".join(ROWS[:20] + ROWS[23:]),
    "a row short": HEAD + "\n".join([*ROWS[:20], "0.20", *ROWS[21:]]),
    "a word": HEAD + "\n".join([*ROWS[:20], "0.20; high", *ROWS[21:]]),
    "thousands": HEAD + "\n".join(f"{k * 0.01:.2f}; 1.234.567,{k:02d}" for k in range(20)),
    "map": "x [mm]; y [mm]; z [um]\n" + "\n".join(f"{i / 10}; {j / 5}; {i * j}" for i, j in GRID),
    "map of two units": "x, y [mm]; z [um]\n" + "\n".join(f"{i}; {j}; {i + j}" for i, j in GRID),
    "a point twice": "x [mm]; y [mm]; z [um]\n"
    + "\n".join(f"{i}; {j}; {i}" for i, j in [*GRID, GRID[3]]),
    "a point less": "x [mm]; y [mm]; z [um]\n" + "\n".join(f"{i}; {j}; {i}" for i, j in GRID[1:]),
    "no map": "x [mm]; y [mm]; z [um]\n" + "\n".join(f"{i}; {i}; {i}" for i in range(9)),
    "one line": "x [mm]; y [mm]; z [um]\n" + "\n".join(f"{i}; 0; {i * i}" for i in range(9)),
    "off the grid": "x [mm]; y [mm]; z [um]\n"
    + "\n".join(f"{i + 0.3 * (i == 2) * (j == 1)}; {j}; {i}" for i, j in GRID),
    "matrix": "heights [um]\n"
    + "\n".join(" ".join(str((i * j) % 7) for i in range(6)) for j in range(5)),
    "matrix with places": "z [um]\n0 0.0 0.1 0.2 0.3 0.4\n"
    + "\n".join(_placed(j) for j in range(5)),
    "places above": "x [mm]; z [um]\n# 0.0 0.1 0.2 0.3 0.4\n"
    + "\n".join(_placed(j) for j in range(5)),
    "Gwyddion": "# Channel: floor\n# Width: 0.50 mm\n# Height: 0,30 mm\n# Value units: um\n"
    + "\n".join("\t".join(f"{(i * j) % 5}.0" for i in range(5)) for j in range(3)),
    "no numbers": "only words\nhere\n",
    "empty": "",
    "five columns": HEAD + "\n".join(f"{k}; {k}; 1; 2; {k * k % 9}" for k in range(12)),
    "quoted": '"x [mm]","z [um]"\n'
    + "\n".join('"{}","{}"'.format(*row.replace(".", ",").split("; ")) for row in ROWS),
}
WAYS = {
    "as it is": {},
    "filled": {"fill_missing": True},
    "told": {"length_unit": "um", "height_unit": "nm", "spacing": 2e-6},
}


def test_texts(tmp_path, monkeypatch, file_regression):
    monkeypatch.chdir(tmp_path)
    tmp_path = Path()
    answers = {}
    for name, content in TEXTS.items():
        path = tmp_path / "made.csv"
        path.write_text(content, encoding="utf-8")
        answers[name] = {"numbers": tried(read_numbers, path)}
        for way, options in WAYS.items():
            if way == "filled" and name not in ("missing", "codes", "a point less"):
                continue
            answers[name][way] = tried(read_surface, path, **options)
    path.write_text(TEXTS["plain"], encoding="utf-8")
    for name, options in {
        "unit": {"length_unit": "furlong"},
        "height unit": {"height_unit": "kg"},
        "long unit": {"height_unit": "a very long word for a unit"},
        "resampled": {"resample": True},
        "tip": {"tip_radius": 2e-6},
    }.items():
        answers[f"plain, {name}"] = tried(read_profile, path, **options)
    path.write_text(TEXTS["uneven"], encoding="utf-8")
    answers["uneven resampled"] = tried(read_profile, path, resample=True)
    path.write_text(TEXTS["map"], encoding="utf-8")
    answers["map as profile"] = tried(read_profile, path)
    path.write_text(TEXTS["plain"], encoding="utf-8")
    answers["profile as map"] = tried(read_map, path)
    held(file_regression, answers)


DEKTAK = (
    "Scan Parameters,\nLength,0.2 mm\nStylus Type,Radius: 12.5 um\nFunction,L,,R,,Value\n"
    "Ra,0.0 um,,50.0 um,,1.25 um\nRq,0 um,,50 um,,0.5\nRsk,0 um,,50 um,,none\nend\n"
    "Lateral um,Total Profile nm,\n"
    + "".join(f"{k * 0.5:.1f},{100 * math.sin(k):.2f},\n" for k in range(12))
)


def test_other_files(tmp_path, monkeypatch, file_regression):
    monkeypatch.chdir(tmp_path)
    tmp_path = Path()
    path = tmp_path / "made.csv"
    answers = {}
    for name, (old, new) in {
        "dektak": ("", ""),
        "a word": ("1.5,", "x,"),
        "no unit": ("Lateral um", "Lateral"),
        "another head": ("Scan P", "P"),
        "no radius": ("Stylus", "Styl"),
        "no results": ("Function", "F"),
    }.items():
        path.write_bytes(DEKTAK.replace(old, new, 1).encode("latin-1"))
        answers[name] = tried(read_dektak, path)
    assert reading.is_dektak(path)
    z = GROUND.heights[:9, :7] * 1e6
    stream = io.BytesIO()
    np.savez(stream, surface=z, other=z, attrs=json.dumps({"system_size": [9e-3, 3.5e-3]}))
    several, one = io.BytesIO(), io.BytesIO()
    np.savez(several, a=z, b=z)
    np.savez(one, a=z[0], words=np.array(["x"]))
    plain = io.BytesIO()
    np.save(plain, z)
    cube = io.BytesIO()
    np.save(cube, np.zeros((2, 2, 2)))
    for name, data in {
        "dump": stream.getvalue(),
        "several": several.getvalue(),
        "one of them": one.getvalue(),
        "plain": plain.getvalue(),
        "cube": cube.getvalue(),
        "cut": plain.getvalue()[:-9],
        "damaged": stream.getvalue()[:-40],
    }.items():
        file = tmp_path / "made.npz"
        file.write_bytes(data)
        answers[f"array {name}"] = {
            "is": is_array(file),
            "bare": tried(read_array, file),
            "unit": tried(read_array, file, height_unit="um"),
            "both": tried(read_array, file, height_unit="um", length_unit="m"),
            "all": tried(read_surface, file, height_unit="um", spacing=1e-6),
        }
    head = (
        b"Gwyddion Simple Field 1.0\nXRes = 5\nYRes = 4\nXReal = 5e-5\nYReal = 8e-5\n"
        b"XYUnits = m\nZUnits = um\n"
    )
    field = np.arange(20, dtype="<f4").tobytes()
    for name, (old, new) in {
        "as it is": (b"", b""),
        "no resolution": (b"XRes", b"Res"),
        "a word": (b"= 5\n", b"= five\n"),
        "no unit": (b"ZUnits = um\n", b""),
        "no side": (b"XReal = 5e-5\n", b""),
        "one row": (b"YRes = 4", b"YRes = 1"),
        "large": (b"5e-5", b"500"),
        "no length": (b"5e-5", b"0"),
    }.items():
        start = head.replace(old, new, 1) if old else head
        data = start + b"\0" * (4 - len(start) % 4)
        file = tmp_path / "made.gsf"
        file.write_bytes(data + (field[:20] if name == "one row" else field))
        answers[f"GSF {name}"] = (
            tried(read_instrument, file),
            tried(read_instrument, file, height_unit="nm"),
        )
    file.write_bytes(data + field[:-4])
    answers["GSF cut"] = tried(read_instrument, file)
    for name, data in {
        "a.pdf": b"%PDF-1.4 \0",
        "a.png": b"\x89PNG\0",
        "a.stl": b"solid a \0",
        "a.zip": b"PK\3\4 \0",
    }.items():
        (tmp_path / f"made{name}").write_bytes(data)
        answers[name] = tried(read_instrument, tmp_path / f"made{name}")
    (tmp_path / "made.sdf").write_bytes(b"bISO-1.0\0")
    answers["SDF damaged"] = tried(read_instrument, tmp_path / "made.sdf")
    answers["unit of SDF"] = tried(read_instrument, tmp_path / "made.sdf", height_unit="um")
    answers["spacing of SDF"] = tried(read_surface, tmp_path / "made.sdf", spacing=1e-6)
    assert is_instrument(tmp_path / "made.sdf")
    assert not is_text(tmp_path / "made.sdf")
    assert is_text(path)
    for ending in (".x3p", ".sdf", ".X3P"):
        for name, surface in {"map": replace(OBLONG, heights=z * 1e-6), "line": PROFILE}.items():
            written = tmp_path / f"heights{ending}"
            write_surface(surface, written)
            answers[f"{ending} {name}"] = read_surface(written)
    answers["ending"] = refusal(write_surface, PROFILE, tmp_path / "heights.csv")
    answers["not there"] = tried(read_surface, tmp_path / "floor.csv")
    answers["units"] = [
        length_factor(unit, "w")
        for unit in ("um", "µm", "Microns", "mm", "inch", "Mils", "Å", "nm ", "m")
    ]
    answers["spacings"] = [instruments.spacings_of(s) for s in ([1.0, 1.004], [1.0, 1.006], [2, 1])]
    answers["complete"] = [
        instruments.complete(np.array([1.0, 2.0]), False, "w"),
        instruments.complete(np.r_[np.nan, np.arange(30.0)], True, "w"),
        refusal(instruments.complete, np.array([1.0, np.nan]), False, "w", 7),
    ]
    held(file_regression, answers)


def _scan_file(folder, surface, name="floor.x3p"):
    write_surface(surface, folder / name)
    return folder / name


def test_scans(tmp_path, monkeypatch, file_regression):
    monkeypatch.chdir(tmp_path)
    tmp_path = Path()
    long = Profile(np.r_[LINE, LINE[::-1]], 4e-6)
    short = Profile(LINE[:200], 2e-6)
    joint = long.heights.copy()
    joint[300:420] *= 9
    clipped = np.minimum(long.heights, 2.4e-6)
    wide = HeightMap(np.tile(GROUND.heights, (2, 2)), 8e-6)
    answers = {}
    for name, surface, options in (
        ("long", long, {}),
        ("cut-off", long, {"cutoff": 0.25e-3}),
        ("short", short, {}),
        ("joint", replace(long, heights=joint), {}),
        ("clipped", replace(long, heights=clipped), {}),
        ("nanometres", replace(long, heights=1e-3 * long.heights), {}),
        ("metres", replace(long, heights=1e3 * long.heights), {}),
        ("strict", replace(long, heights=1e3 * long.heights), {"strict": True}),
        ("ground", wide, {}),
        ("crossed", replace(CROSSED, spacing=8e-6), {}),
        ("oblong", replace(wide, heights=wide.heights[::-1].T @ np.eye(128), spacing_y=12e-6), {}),
        ("too long", long, {"cutoff": 6e-3}),
        ("none", Profile(LINE[:30], 1e-6), {}),
        ("rough", HeightMap(np.tile(ROUGH.heights, (3, 3)), 4e-6), {}),
    ):
        try:
            found = read_scan(_scan_file(tmp_path, surface), **options)
        except Exception as error:  # which one is held
            answers[name] = f"{type(error).__name__}: {error}"
            continue
        q = np.geomspace(1e3, 1e7, 6)
        content = found.to_dict()
        answers[name] = {
            "scan": found,
            "said": (repr(found), found.headline(), found.cautions()),
            "table": found.table().rows,
            "remarks": found.remarks(),
            "content": content,
            "waves": found.waves,
            "density": found.density(q),
            "directions": found.directions_at(q),
            "data": {
                key: (one.columns, np.array(one.rows)) for key, one in found.data_tables().items()
            },
        }
    answers["heights"] = [
        (unlikely_height(rq), height_cautions(rq)) for rq in (49e-9, 51e-9, 299e-6, 301e-6, 0.0)
    ]
    held(file_regression, answers)
    assert scan.CUTOFFS[0] == 0.8e-3
    assert (lay.DECAY, prepare.SPIKE, spectrum.POINTS_PER_DECADE) == (0.2, 10.0, 12)
    assert arrays.is_array(tmp_path / "floor.x3p") is False
