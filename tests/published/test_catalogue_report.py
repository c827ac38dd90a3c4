"""The catalogue against the report: printed values, and errata applied with the reason beside."""

import pytest

from underfoot.core.catalogue import Catalogue

BOOK = Catalogue.load()


@pytest.mark.parametrize(
    ("shoe", "channel", "depth", "shore_a", "ra"),
    [  # report, Table 6
        ("work_shoe_full_tread", 2.5e-3, 3.0e-3, 58, 7.24e-6),
        ("work_shoe_half_tread", 2.4e-3, 1.5e-3, 71, 5.74e-6),
        ("work_shoe_untreaded", None, None, 68, 4.44e-6),
        ("athletic_shoe_full_tread", 5.5e-3, 4.0e-3, 85, 5.05e-6),
        ("athletic_shoe_half_tread", 3.5e-3, 2.0e-3, 83, 5.24e-6),
        ("athletic_shoe_untreaded", None, None, 79, 4.43e-6),
    ],
)
def test_the_six_shoes_of_table_6(shoe, channel, depth, shore_a, ra):
    entry = BOOK.entry("shoe", shoe)
    assert entry.sourced_value("material.shore_a").value == shore_a
    assert entry.sourced_value("roughness.ra").value == ra
    if channel is None:
        assert entry.text("tread.pattern") == "none"
    else:
        assert entry.sourced_value("tread.channel_width").value == channel
        assert entry.sourced_value("tread.depth").value == depth


@pytest.mark.parametrize(
    ("fluid", "viscosity", "cof_bl", "alpha", "beta"),
    [  # report, G.2.1, G.2.2 and Table 5
        ("water_g2", 0.52e-3, 0.69, 4.3263, 0.0531),
        ("detergent_g2", 1.8e-3, 0.58, 2.6125, 0.0399),
        ("glycerol_25pct", 1.9e-3, 0.65, 2.5707, 0.0822),
        ("glycerol_50pct", 5.54e-3, 0.47, 2.8006, 0.1027),
        ("glycerol_75pct", 41e-3, 0.16, 2.3826, 0.0927),
        ("canola_oil", 74.6e-3, 0.10, 1.7556, 0.0106),
    ],
)
def test_the_fluids_of_g2_and_g3(fluid, viscosity, cof_bl, alpha, beta):
    entry = BOOK.entry("fluid", fluid)
    assert entry.sourced_value("viscosity").value == viscosity
    assert entry.sourced_value("boundary.cof_bl").value == cof_bl
    assert entry.sourced_value("boundary.alpha").value == alpha
    assert entry.sourced_value("boundary.beta").value == beta


def test_viscosity_grows_with_glycerol():
    names = [f"glycerol_{share}pct" for share in (25, 50, 75, 90)]
    values = [BOOK.entry("fluid", name).sourced_value("viscosity").value for name in names]
    assert values == sorted(values)


def test_errata_are_applied_and_say_what_was_printed():
    # the report's rule for neolite, K = 2 Ginf (1 + nu) / (3 (1 - 2 nu)), gives both
    for name in ("neolite", "rubber_50a"):
        entry = BOOK.entry("material", name)
        ginf = entry.sourced_value("relaxation.equilibrium_shear_modulus").value
        nu = entry.sourced_value("poisson_ratio").value
        rule = 2 * ginf * (1 + nu) / (3 * (1 - 2 * nu))
        assert entry.sourced_value("bulk_modulus").value == pytest.approx(rule, rel=2e-3)
    assert "2180 MPa" in BOOK.entry("material", "rubber_50a").leaf("bulk_modulus").erratum
    radius = BOOK.entry("setup", "pin_on_disk_g2").sourced_value("method.reduced_radius")
    assert radius.value == 23.3e-3
    assert "micrometres" in radius.note
    waves = BOOK.entry("setup", "micro_fe_g1")
    assert waves.sourced_value("method.wavelength_shoe").value == 0.5e-3
    assert "5 mm" in waves.leaf("method.wavelength_shoe").erratum


def test_the_relaxation_of_table_2():
    # G0 = Ginf + G1; beta = 1 / time
    for name, g0, beta in (("neolite", 30.24e6, 0.013), ("rubber_50a", 0.59e6, 0.025)):
        entry = BOOK.entry("material", name)
        (term,) = entry.leaf("relaxation.terms").given
        ginf = entry.sourced_value("relaxation.equilibrium_shear_modulus").value
        assert ginf + float(term["shear_modulus"].split()[0]) * 1e6 == pytest.approx(g0)
        assert 1 / float(term["time"].split()[0]) == pytest.approx(beta, rel=1e-4)


def test_the_set_up_and_results_of_g4():
    motion = BOOK.entry("setup", "slip_tester_g4")
    assert motion.sourced_value("motion.speed").value == 0.7
    assert motion.sourced_value("motion.normal_force").value == 500
    assert motion.sourced_value("sensor.inlet_diameter").value == 10e-3
    results = BOOK.entry("published", "slip_tester_g4")
    assert results.sourced_value("fluid_load_work_shoe_untreaded_glycerol").value == 201
    assert results.sourced_value("peak_pressure_athletic_shoe_untreaded_glycerol").value == 214e3


def test_the_risk_model_of_g6_gives_its_own_extremes():
    entry = BOOK.entry("published", "slip_risk_g6")
    assert entry.sourced_value("logistic_slope").value == -49.2
    assert entry.sourced_value("logistic_half").value == -0.06
    assert entry.numbers("risk_at_lowest_median_highest_rcof") == (0.03, 0.26, 0.83)
