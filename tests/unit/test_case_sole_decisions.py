"""Lengths of a sole at the edge of what fits; what of an entry a given value stands in for."""

import math

import numpy as np
import pytest

from underfoot import rough_contact
from underfoot.case import Case, friction
from underfoot.compute.resolve import resolve_context
from underfoot.core import InputError
from underfoot.core.catalogue import Catalogue

REST = {"contaminant": "glycerol_90pct", "motion": "slip_tester_g4", "name": "one"}
OWN = """\
[shoe.with_rq]
title = "Shoe whose roughness is told as Rq"
from = "work_shoe_untreaded"
source = "made"
roughness = {rq = "3 um"}
"""


def heel(**lengths):
    sizes = {"length": "60 mm", "width": "50 mm", "rear_radius": "20 mm"}
    shoe = {"from": "work_shoe_full_tread", "heel": {**sizes, **lengths}}
    return Case.from_mapping({**REST, "shoe": shoe, "floor": "vinyl_g4"})


@pytest.mark.parametrize("name", ["rear_radius", "front_radius"])
def test_a_radius_fits_to_half_of_the_smaller_side(name):
    assert heel(**{name: "25 mm"}).value(f"shoe.heel.{name}") == 0.025
    with pytest.raises(InputError, match="does not fit the plan form"):
        heel(**{name: "25.1 mm"})


def test_a_tread_has_a_depth():
    case = heel()
    assert case.replace("shoe.tread.depth", "1 mm").shoe.tread.depth == 1e-3
    with pytest.raises(InputError, match="no tread"):
        case.replace("shoe.tread.depth", "0 mm")


@pytest.mark.parametrize("part", ["shoe", "floor"])
def test_a_given_ra_stands_in_for_the_rq_of_the_entry(part, tmp_path):
    (tmp_path / "own.toml").write_text(OWN)
    told = {"shoe": {"from": "with_rq"}, "floor": {"from": "vinyl_g4"}}
    given = {**told, part: {**told[part], "roughness": {"ra": "9 um"}}}
    known = Catalogue.load([tmp_path])
    before, after = (Case.from_mapping({**REST, **one}, catalogue=known) for one in (told, given))
    assert before.value(f"{part}.roughness.rq") is not None
    assert after.value(f"{part}.roughness.rq") is None
    assert after.value(f"{part}.roughness.ra") == 9e-6


def test_hysteresis_of_a_floor_without_a_scan_is_of_waves_up_to_the_longest(monkeypatch):
    """Its usual form: level up to the roll-off, then falling; scaled to the floor's slope."""
    context = resolve_context(heel())
    told = {}

    def persson(pressure, wavenumber, spectrum, *given, **named):
        told.update(wavenumber=wavenumber, spectrum=spectrum)
        raise StopIteration

    monkeypatch.setattr(rough_contact, "persson", persson)
    monkeypatch.setattr(friction, "_loss_tested", lambda context: True)
    with pytest.raises(StopIteration):
        friction._hysteresis(context)
    shortest, roll_off, longest = friction.HYSTERESIS_WAVES
    q, density = told["wavenumber"], told["spectrum"]
    assert 2 * math.pi / q[[0, -1]] == pytest.approx([longest, shortest])
    level = q < 2 * math.pi / roll_off
    assert density[level] == pytest.approx(density[0])
    falling = np.polyfit(np.log(q[~level]), np.log(density[~level]), 1)[0]
    assert falling == pytest.approx(-2 * (1 + context.interface.hurst))
