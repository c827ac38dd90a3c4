"""``underfoot outsole make`` and ``underfoot wear``, and the shipped outsoles."""

import json
from pathlib import Path

import pytest

from commands import called, process
from underfoot.case import Case
from underfoot.compute.sole import new_sole, read_outsole
from underfoot.core import InputError
from underfoot.questions.worn_states import measures_of, worn_cases

OUTSOLES = Path(__file__).parents[2] / "examples" / "outsoles"
SPECS = sorted(path for path in OUTSOLES.glob("*.toml") if not path.stem.endswith("_glycerol"))
CASES = sorted(OUTSOLES.glob("*_glycerol.toml"))


def test_make_writes_a_sole_and_says_how_it_reads_back(tmp_path):
    out = tmp_path / "sole.stl"
    sizes = ("--lug", "14 mm", "--channel", "4 mm", "--depth", "3 mm")
    done = called("outsole", "make", "--pattern", "grid", *sizes, "--out", out, "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["file_volume_m3"] == pytest.approx(found["volume_m3"], rel=0.01)
    assert found["triangles"] > 100
    assert out.stat().st_size > 1000
    again = called("outsole", "make", "--pattern", "grid", *sizes, "--out", out)
    assert again.returncode == 2
    assert "--overwrite" in again.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--pattern", "hexagons", "--lug", "6 mm", "--pitch", "5 mm"), "no channel"),
        (("--pattern", "hexagon"), "hexagons"),
        (("--pattern", "circles", "--lug", "6", "--channel", "2 mm", "--depth", "2 mm"), "no unit"),
        ((), "an outsole file"),
    ],
)
def test_make_refuses(arguments, words):
    done = called("outsole", "make", *arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_shipped_outsoles_are_sound(path):
    from underfoot.shoe import heel_surface
    from underfoot.shoe.parametric.solid import check_printable

    shape = read_outsole(path).shape()
    check_printable(shape)
    assert 0.3 < heel_surface(shape, spacing=0.5e-3).land_ratio < 0.85


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_case_and_outsole_file_describe_the_same_sole(path):
    spec = OUTSOLES / path.name.replace("_glycerol", "")
    assert new_sole(Case.load(path)) == read_outsole(spec).shape()


def test_the_outsole_file_of_the_guide_is_the_shipped_one(tmp_path):
    guide = (OUTSOLES.parents[1] / "docs" / "guide" / "parametric_soles.md").read_text()
    path = tmp_path / "guide.toml"
    path.write_text(guide.split("```toml\n")[1].split("```")[0])
    assert read_outsole(path).shape() == read_outsole(OUTSOLES / "heel_hexagons.toml").shape()


def test_outsole_file_tells_where_it_is_wrong(tmp_path):
    path = tmp_path / "sole.toml"
    path.write_text('[tread]\npattern = "bars"\nlug_widht = "5 mm"\n')
    with pytest.raises(InputError, match=r"line 3.*lug_width"):
        read_outsole(path)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (
            {
                "shoe.wear.mode": "patch",
                "shoe.wear.depth": "2 mm",
                "shoe.wear.patch_length": "70 mm",
                "shoe.wear.patch_width": "20 mm",
            },
            "larger than the shoe",
        ),
        ({"shoe.wear.depth": "30 mm"}, "goes through the outsole"),
        ({"shoe.wear.mode": "archard", "shoe.wear.depth": "1 mm"}, "shoe angle at which"),
        (
            {
                "shoe.tread.sipes.depth": "9 mm",
                "shoe.tread.sipes.width": "0.5 mm",
                "shoe.tread.sipes.spacing": "4 mm",
            },
            "deeper than the lug",
        ),
        ({"shoe.tread.arm_length": "9 mm"}, 'not used by pattern = "hexagons"'),
        ({"shoe.tread.lug_width": "1 mm"}, "too narrow for the grid"),
    ],
)
def test_cases_refuse_soles_that_can_not_be(settings, words):
    with pytest.raises(InputError, match=words):
        Case.load(OUTSOLES / "heel_hexagons_glycerol.toml", settings=settings)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--limit", "600 N"), "below the load"),
        (("--limit", "much"), "not a number with a unit"),
        (("--mode", "sanding"), "archard"),
        (("--mode", "plane", "--to", "40 mm"), "deeper than the sole"),
        (("--mode", "patch", "--to", "9000 mm^2"), "larger than the shoe"),
        (("--set", "shoe.tread.pattern=none"), "no tread"),
    ],
)
def test_wear_refuses(arguments, words):
    done = called("wear", OUTSOLES / "heel_hexagons_glycerol.toml", *arguments)
    assert done.returncode == 2
    assert words in done.stderr.replace("\n", " ")
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_wear_of_a_hexagon_heel(tmp_path):
    case = OUTSOLES / "heel_hexagons_glycerol.toml"
    coarse = ("--set", "numerics.quick_grid_spacing=1.2 mm")
    done = process(
        "wear",
        case,
        "--mode",
        "plane",
        "--steps",
        "2",
        "--no-band",
        *coarse,
        "--out",
        tmp_path / "wear",
        "--json",
    )
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    states = found["states"]
    assert [round(state["removed_depth"] * 1e3, 1) for state in states[1:]] == [1.2, 2.5]
    # worn through, the sensors see a film that lugs with channels around them never showed
    assert states[-1]["fluid_load_sensor"] > states[0]["fluid_load_sensor"] + 1
    page = (tmp_path / "wear" / "report.html").read_text()
    assert "Published trends" in page
    assert "a larger worn region goes with a higher peak fluid pressure" in page
    assert (tmp_path / "wear" / "wear.csv").read_text().count("\n") == 4


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pattern", "bevel"),
    [
        ("transverse", "25 mm"),
        ("transverse", "45 mm"),  # of the default heel: channels run out over the rounded rim
        ("longitudinal", "45 mm"),
        ("hexagons", "45 mm"),
        ("grid", "45 mm"),  # channels cross on the bevel
    ],
)
def test_a_bevelled_sole_from_a_file_wears_as_that_of_its_lengths(tmp_path, pattern, bevel):
    setting = {
        "shoe": "work_shoe_half_tread",
        "floor": "vinyl_g4",
        "contaminant": "glycerol_90pct",
        "motion": "slip_tester_g4",
    }
    bars = {
        "shoe.tread.pattern": pattern,
        "shoe.tread.lug_width": "6 mm",
        "shoe.tread.channel_width": "4 mm",
        "shoe.tread.depth": "3.5 mm",
        "shoe.heel.profile.length": bevel,
    }
    lengths, stl = Case(**setting).replace(bars), tmp_path / "sole.stl"
    (tmp_path / "lengths.toml").write_text(lengths.to_toml())
    done = called("outsole", "make", tmp_path / "lengths.toml", "--out", stl)
    assert done.returncode == 0, done.stderr
    file = Case(**setting).replace(
        {
            **dict.fromkeys(("shoe.heel", "shoe.tread")),
            "shoe.outsole": {"file": str(stl)},
            "shoe.sole.outsole_thickness": "25 mm",
        }
    )
    one, other = (
        [measures_of(worn) for worn in worn_cases(case, "plane", 3, 2e-3)]
        for case in (lengths, file)
    )
    assert [each.removed_depth for each in one] == pytest.approx([0, 2e-3 / 3, 4e-3 / 3, 2e-3])
    # 0.02 mm is aimed at; the mean of the bevel of 25 mm is off by 0.0203 mm
    near = {"removed_depth": 0.02e-3, "tread_left": 0.02e-3, "mean_tread_left": 0.01 * 3.5e-3}
    for name, tolerance in near.items():
        seen, expected = ([getattr(each, name) for each in made] for made in (other, one))
        assert seen == pytest.approx(expected, abs=tolerance), name
