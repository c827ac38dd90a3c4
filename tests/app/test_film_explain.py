"""Each closure of the film explains itself by name: formula and source."""

import pytest
from typer.testing import CliRunner

from underfoot.cli.app import app

NAMES = {
    "film_pressure": ("theta", "Giacopini"),
    "soft_ehl": ("7.43", "Hamrock and Dowson (1978)"),
    "film_regime": ("g_E", "Esfahanian and Hamrock"),
    "lambda_ratio": ("Rq1^2", "Eq. 21"),
    "lubrication_by_lambda": ("boundary below 1", "rubber runs on a full film"),
    "compare_regimes": ("why they differ", "load share"),
    "squeeze_time_disc": ("3 pi eta R^4", "Stefan"),
    "tapered_wedge": ("eta_s", "Michell"),
    "patir_cheng_pressure_factors": ("gamma", "100:12-17"),
    "patir_cheng_shear_factor": ("Phi_s", "101:220-229"),
}


@pytest.mark.parametrize("name", NAMES)
def test_explained(name):
    shown = CliRunner().invoke(app, ["explain", name])
    assert shown.exit_code == 0
    for part in NAMES[name]:
        assert part in shown.stdout


def test_found_by_author():
    shown = CliRunner().invoke(app, ["explain", "patir_cheng_1979"])
    assert "patir_cheng_shear_flow" in shown.stdout
