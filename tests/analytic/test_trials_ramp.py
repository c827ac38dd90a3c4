"""Ramps: forces resolved along the walking surface, body weight on a slope, what is refused."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from commands import called
from underfoot.core import InputError
from underfoot.trials import read_trial
from underfoot.trials.recording.axes import LEVEL, Direction, DirectionSource, Ramp, ramp_from
from underfoot.trials.recording.protocols import protocol
from underfoot.trials.recording.trial import Plate, Trial
from underfoot.trials.simulator import Defects, SlipTruth, walk_c3d, walk_with_slip
from underfoot.trials.study import analyse_folder
from underfoot.trials.walking.events import Stance
from underfoot.trials.walking.gait import RcofDefinition, required_friction, required_frictions
from underfoot.trials.walking.walkway import walkway_of

WEIGHT = 700.0
FORWARD, UP = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
ANY = RcofDefinition(peak="plain-maximum", braking=False)


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    """A made-up walk, read back; its forces are normal and tangential to the surface."""
    path = tmp_path_factory.mktemp("walk") / "walk.c3d"
    recording = walk_with_slip(SlipTruth(peak_speed=0.05), Defects(), np.random.default_rng(3))
    path.write_bytes(walk_c3d(recording))
    return read_trial(path)


def turned(force, angle):
    """Forces of a ramp that rises along x, as a levelled plate gives them."""
    x, z = force[:, 0], force[:, 2]
    cos, sin = math.cos(angle), math.sin(angle)
    return np.column_stack((cos * x - sin * z, force[:, 1], sin * x + cos * z))


def standing(force):
    forces = np.tile(force, (1000, 1))
    way = Direction(FORWARD, DirectionSource.GIVEN, "given")
    stance = Stance("plate 1", 100, 900, 0.1, 0.9, WEIGHT, direction=way)
    return Trial("still", plates=(Plate("plate 1", forces, 1000.0),)), stance


@pytest.mark.parametrize("degrees", [-12.0, -5.0, 0.0, 3.0, 5.0, 10.0, 20.0])
def test_a_body_at_rest_on_a_ramp_needs_the_tangent_of_its_angle(degrees):
    angle = math.radians(degrees)
    trial, stance = standing([0.0, 0.0, WEIGHT])
    way = walkway_of(trial, vertical="z", walking="x", ramp=Ramp(angle, "horizontal"))
    found = required_friction(way, stance, ANY, checked=False)
    assert found.measurement.value == pytest.approx(math.tan(abs(angle)), abs=1e-12)
    assert found.normal == pytest.approx(WEIGHT * math.cos(angle), rel=1e-9)
    assert way.weight.newtons == pytest.approx(WEIGHT)
    # The same body on a plate that is mounted in the ramp.
    force = [WEIGHT * math.sin(angle), 0.0, WEIGHT * math.cos(angle)]
    trial, stance = standing(force)
    way = walkway_of(trial, vertical="z", walking="x", ramp=Ramp(angle, "surface"))
    found = required_friction(way, stance, ANY, checked=False)
    assert found.measurement.value == pytest.approx(math.tan(abs(angle)), abs=1e-12)
    assert way.weight.newtons == pytest.approx(WEIGHT)
    if degrees > 3:  # without the angle the push along the ramp is no quiet standing
        assert walkway_of(trial, vertical="z", walking="x").weight is None


@pytest.mark.parametrize("degrees", [-8.0, 5.0])
def test_both_frames_give_the_number_of_the_walking_surface(walk, degrees):
    angle = math.radians(degrees)
    first = required_frictions(walkway_of(walk))[0]
    plates = tuple(
        replace(p, force=turned(p.force, angle), corners=turned(p.corners, angle))
        for p in walk.plates
    )
    level = replace(walk, plates=plates)
    stance = first.stance
    results = {
        frame: required_friction(walkway_of(trial, vertical="z", ramp=ramp), stance)
        for frame, trial, ramp in (
            ("surface", walk, Ramp(angle, "surface")),
            ("horizontal", level, Ramp(angle, "horizontal")),
            ("level", level, LEVEL),
        )
    }
    expected = first.measurement.value
    assert results["surface"].measurement.value == pytest.approx(expected, rel=1e-12)
    assert results["horizontal"].measurement.value == pytest.approx(expected, rel=1e-3)
    named = {key: [f.name for f in one.measurement.flags] for key, one in results.items()}
    assert "plate slope" not in named["surface"] + named["horizontal"]
    # Taken as level the number is wrong by about the angle, and the plate's corners say so.
    wrong = results["level"].measurement
    assert wrong.value is None or abs(wrong.value - expected) > 0.05
    assert wrong.value is None or "plate slope" in named["level"]


def test_level_is_what_it_was(walk):
    plain = required_frictions(walkway_of(walk))[0].measurement
    zero = walkway_of(walk, ramp=ramp_from("0 deg", "horizontal"))
    assert required_frictions(zero)[0].measurement.value == plain.value
    assert plain.conventions["surface"] == "level"


@pytest.mark.parametrize(
    ("angle", "frame", "where"),
    [
        ("5 deg", "", "plate_frame"),
        ("5 deg", "surfaces", "plate_frame"),
        ("45 deg", "surface", "ramp"),
        ("5 mm", "surface", "ramp"),
        ("steep", "surface", "ramp"),
        (5, "surface", "ramp"),
    ],
)
def test_what_is_no_ramp_is_refused(angle, frame, where):
    with pytest.raises(InputError) as refused:
        ramp_from(angle, frame)
    assert refused.value.where == where


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("ramp")
    recording = walk_with_slip(SlipTruth(peak_speed=0.05), Defects(), np.random.default_rng(3))
    (place / "walk.c3d").write_bytes(walk_c3d(recording))
    return place


def test_a_protocol_names_the_ramp_in_the_methods(folder):
    plain = protocol("level_walking")
    ramp = plain.with_settings({"ramp": "5 deg", "plate_frame": "surface"})
    assert ramp.key != plain.key
    texts = {}
    for name, one in (("level", plain), ("ramp", ramp)):
        analysis = analyse_folder(folder, one, processes=1)
        texts[name] = " ".join(analysis.methods)
        assert analysis.files[0].verdict != "refused"
    assert "Surface: level." in texts["level"]
    assert "Surface: ramp of 5 deg, walking up; plates that measure normal" in texts["ramp"]
    with pytest.raises(InputError, match="axes of the force plates"):
        analyse_folder(folder, plain.with_settings({"ramp": "5 deg"}), processes=1)
    with pytest.raises(InputError, match="only walking"):
        analyse_folder(folder, protocol("report_g4").with_settings({"ramp": "5 deg"}), processes=1)


def test_the_words_name_the_direction():
    assert Ramp(math.radians(-5), "surface").description.startswith("ramp of 5 deg, walking down")


def test_commands_take_the_ramp(folder):
    file = folder / "walk.c3d"
    options = ("--ramp", "5 deg", "--plate-frame")
    described = {
        frame: json.loads(called("trials", "describe", file, *options, frame, "--json").stdout)[0]
        for frame in ("surface", "horizontal")
    }
    plain = json.loads(called("trials", "describe", file, "--json").stdout)[0]
    value = {k: d["stances"][0]["rcof"]["value"] for k, d in described.items()}
    assert value["surface"] == plain["stances"][0]["rcof"]["value"]
    assert value["horizontal"] != pytest.approx(value["surface"], abs=0.03)
    assert "walking up" in described["surface"]["axes"]["surface"]
    refused = called("trials", "describe", file, "--ramp", "5 deg")
    assert refused.returncode == 2
    assert "plate_frame" in refused.stderr
    assert "Traceback" not in refused.stderr
    out = folder.parent / "ramp_report"
    done = called(
        "trials",
        "analyse",
        folder,
        "--processes",
        1,
        "--protocol",
        "level_walking",
        *options,
        "surface",
        "--out",
        out,
    )
    assert done.returncode == 0, done.stderr
    assert "ramp of 5 deg, walking up" in (out / "report.html").read_text(encoding="utf-8")
