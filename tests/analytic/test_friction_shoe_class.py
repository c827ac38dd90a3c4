"""A slip class or certificate as a reading of the sole: what it changes, what contradicts it."""

from dataclasses import replace

import numpy as np
import pytest

from underfoot.case import Case
from underfoot.compute.run import run
from underfoot.core import InputError
from underfoot.friction import Pair, PairContactLaw, packaged_pair_draws
from underfoot.friction.shoe_class import (
    ShoeClass,
    certificate_line,
    of_class,
    shoe_class,
    shoe_classes,
)

ON_VINYL = Pair(58, (5e-6, 12e-6), (1e-6, 3e-6), "aqueous")
PLACE = np.array([4.4, 2.4, 2.0, 0.0, 0.0, 0.6])
ONE_PLACE = {"tread_positions": 1}
CASE = {
    "name": "classed",
    "shoe": {"from": "work_shoe_full_tread"},
    "floor": "vinyl",
    "contaminant": "glycerol_90pct",
    "motion": {"from": "whole_shoe_g6"},
}


def cof(law):
    """Draws of the contact's COF on the case's own floor, with every error but the tread's."""
    drawn = law.joint_draws(1000, 0)
    shed = np.exp(-law.viscosity * 0.3 / drawn["kappa"])
    adhesion = drawn["rest"] * shed + drawn["film"] * (1 - shed)
    return (adhesion + drawn["hysteresis"]) * drawn["laboratory"] * drawn["pair"]


def test_a_class_raises_and_its_absence_lowers_and_both_are_every_shoe():
    law = PairContactLaw(ON_VINYL, 0.2)
    passed = of_class(law, shoe_class("EN ISO 20345 SR"), PLACE, 0)
    failed = of_class(law, shoe_class("not slip-resistant"), PLACE, 0)
    before, above, below = (np.median(cof(x)) for x in (law, passed.law, failed.law))
    assert below < before < above
    assert passed.passing + failed.passing == pytest.approx(1.0)
    assert 0.05 < passed.passing < 0.6
    assert "EN ISO 20345 SR" in passed.law.spread_basis
    assert law.spread_basis == "without a measurement of this sole on this floor"
    assert any("at least 0.19" in line for line in passed.law.assumptions)
    stricter = replace(shoe_class("EN ISO 20345 SR"), readings=(
        certificate_line("tile_glycerine", 0.27, "lower", None, "here"),
    ))  # fmt: skip
    assert np.median(cof(of_class(law, stricter, PLACE, 0).law)) > before


def test_the_laboratory_of_a_certificate_is_another_one():
    """A bound read elsewhere leaves the error of the case's own laboratory as it was."""
    law = PairContactLaw(ON_VINYL, 0.2)
    found = of_class(law, shoe_class("EN ISO 20345 SR"), PLACE, 0).law
    assert not any(name.startswith("laboratory") for name in found.draws.errors)
    before, after = (np.std(np.log(x.joint_draws(1000, 0)["laboratory"])) for x in (law, found))
    assert after == pytest.approx(before, rel=0.15)


def test_a_value_draws_the_sole_towards_itself_from_either_side():
    law = PairContactLaw(ON_VINYL, 0.2)
    medians = []
    for value in (0.08, 0.15, 0.30):
        line = certificate_line("tile_glycerine", value, "value", 0.02, "here")
        found = of_class(law, ShoeClass("certified", "a test", (line,)), PLACE, 0)
        assert not found.contradicted
        medians.append(float(np.median(cof(found.law))))
    assert medians == sorted(medians)


def test_readings_of_the_own_tester_go_before_a_class_that_contradicts_them():
    draws = packaged_pair_draws()
    low = replace(draws.constants, film_aqueous=0.02 * draws.constants.film_aqueous)
    low = replace(low, dry=0.02 * low.dry, film_oil=0.02 * low.film_oil)
    read = replace(draws, constants=low, errors={"laboratory": np.full(draws.count, -0.5)})
    law = PairContactLaw(ON_VINYL, 0.2, read)
    found = of_class(law, shoe_class("EN ISO 20345 SR"), PLACE, 0)
    assert found.contradicted
    np.testing.assert_array_equal(cof(found.law), cof(law))
    (line,) = (line for line in found.law.assumptions if line.startswith("shoe.class"))
    assert "contradicted" in line
    assert "your own tester" in line
    assert "at least 0.19" in line


@pytest.mark.parametrize(
    ("shoe", "message"),
    [
        ({"class": "EN ISO 20345 SRD"}, 'unknown slip class.*Did you mean "EN ISO 20345 SR'),
        ({"certificate": [{"test": "tile_glycerin", "cof": 0.2}]}, 'Did you mean "tile_glycerine"'),
        ({"certificate": [{"test": "tile_glycerine", "cof": 0.0}]}, "shoe.certificate"),
        (
            {"certificate": [{"test": "tile_glycerine", "cof": 0.2, "kind": "least"}]},
            "certificate.kind",
        ),
        (
            {
                "certificate": [
                    {"test": "tile_glycerine", "cof": 0.27},
                    {"test": "tile_glycerine", "cof": 0.20, "kind": "upper"},
                ]
            },
            "exclude each other",
        ),
    ],
)
def test_bad_classes_and_certificates_are_named(shoe, message):
    with pytest.raises(InputError, match=message):
        Case.from_mapping({**CASE, "shoe": {**CASE["shoe"], **shoe}})


def test_a_class_is_part_of_the_case():
    plain = Case.from_mapping(CASE)
    classed = Case.from_mapping({**CASE, "shoe": {**CASE["shoe"], "class": "EN ISO 20345 SR"}})
    assert plain.shoe.known_class() is None
    assert plain.hash != classed.hash
    assert 'class = "EN ISO 20345 SR"' in classed.to_toml()
    assert classed.shoe.known_class().name in shoe_classes()
    assert Case.from_mapping({**CASE, "shoe": "slip_resistant_shoe_treaded"}).shoe.known_class()


@pytest.mark.slow
def test_the_answer_of_a_run_knows_the_class_and_a_worn_sole_keeps_some_of_it():
    def answer(**shoe):
        case = Case.from_mapping({**CASE, "shoe": {**CASE["shoe"], **shoe}, "numerics": ONE_PLACE})
        result = run(case, quick=True)
        return result.value("cof"), result.headline()[0]

    any_shoe, words = answer()
    classed, class_words = answer(**{"class": "EN ISO 20345 SR"})
    assert classed > 1.1 * any_shoe
    assert "without a measurement of this sole" in words
    assert "class EN ISO 20345 SR" in class_words
    worn, worn_classed = (
        answer(wear={"depth": "2.5 mm"}, **known)[0] for known in ({}, {"class": "EN ISO 20345 SR"})
    )
    assert 1.0 < worn_classed / worn < classed / any_shoe
