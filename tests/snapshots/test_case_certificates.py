"""A shoe with the readings of a certificate and no class of its own."""

from underfoot.case import Case


def test_readings_of_a_certificate_are_a_class_as_certified():
    case = Case(
        shoe={
            "from": "work_shoe_half_tread",
            "certificate": [{"test": "tile_glycerine", "cof": 0.2}],
        },
        floor="vinyl_g4", contaminant="detergent", motion="slip_tester_g4",
    )  # fmt: skip
    known = case.shoe.known_class()
    assert known is not None
    assert (known.name, known.source) == ("as certified", "shoe.certificate")
