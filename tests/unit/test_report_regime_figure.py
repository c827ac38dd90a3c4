"""The picture of lubrication regimes shows what the map holds."""

import numpy as np
import pytest

from underfoot.core import InputError
from underfoot.film import regime_map, soft_ehl
from underfoot.report import plot
from underfoot.report.regime_figure import regime_figure
from underfoot.rough_contact import ExponentialLaw

PIN = {"load": 20.9, "radius": 23.3e-3, "effective_modulus": 2.0e6}
RQ = {"rq_first": 8.2e-6, "rq_second": 1.34e-6}


def drawn(**more):
    return regime_map(np.geomspace(1e-3, 1.0, 25), np.geomspace(0.05, 1.0, 20), **PIN, **RQ, **more)


def test_curves_are_lambda_of_each_fluid():
    figure = regime_figure(drawn(), {"oil": 74.6e-3, "thin": 2e-3}, "Pin on disk")
    lines = {line.get_label(): line for line in figure.axes[0].get_lines()}
    for name, viscosity in (("oil", 74.6e-3), ("thin", 2e-3)):
        speeds, curve = (np.asarray(part) for part in lines[name].get_data())
        film = soft_ehl(viscosity=viscosity, speed=speeds, **PIN)
        assert curve == pytest.approx(film.lambda_ratio(8.2e-6, 1.34e-6), rel=1e-6)
    assert figure.get_suptitle() == "Pin on disk"
    # what the formula was not fitted to stands on the picture
    assert "outside the tested range" in figure.get_supxlabel()


def test_load_share_limits_are_drawn_when_known():
    law = ExponentialLaw(2e6, 0.5, 8.3e-6)
    with_share = regime_figure(drawn(law=law, mean_pressure=266e3), {"oil": 74.6e-3})
    texts = [text.get_text() for text in with_share.axes[1].get_legend().get_texts()]
    assert texts == ["λ = 1 and 3", "fluid carries 10% and 90%"]
    assert len(regime_figure(drawn()).axes[1].get_legend().get_texts()) == 1


def test_a_map_is_drawn_by_plot(tmp_path):
    path = tmp_path / "regimes.png"
    plot(drawn(), {"oil": 74.6e-3}, title="Pin").savefig(path)
    assert path.read_bytes()[:4] == b"\x89PNG"


def test_what_can_not_be_drawn_is_refused():
    with pytest.raises(InputError, match="not on the map"):
        regime_figure(drawn(), {"honey": 10.0})
    point = regime_map(0.1, [0.1, 1.0], **PIN, **RQ)
    with pytest.raises(InputError, match="two viscosities"):
        regime_figure(point)
