"""Times of relaxation under either name; how many residuals of a fit stand for one."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from underfoot.core import DataError
from underfoot.material.read import _times, read_dynamic
from underfoot.material.spectrum_fit import run_length


@pytest.mark.parametrize("name", ["relaxation time", "time"])
def test_a_column_of_times_is_read_under_either_name(name):
    column = SimpleNamespace(name=name, quantity=name, cells=("0.1", "2"))
    table = SimpleNamespace(
        find_column=lambda *names: column if name in names else None,
        require_column=lambda *names: pytest.fail(f"asked for {names}"),
        si=lambda one, infinite=False: np.array([0.1, 2.0]) if one is column else None,
        lines=[1, 2], where="made",
    )  # fmt: skip
    assert _times(cast(Any, table)).tolist() == [0.1, 2.0]


@pytest.mark.parametrize(
    ("rho", "size", "low", "high"),
    [(0.0, 4000, 1, 1), (0.8, 4000, 8, 10), (0.99, 4000, 19, 19), (0.99, 40, 5, 5)],
)
def test_residuals_that_follow_each_other_count_as_one(rho, size, low, high):
    """(1 + rho) / (1 - rho) of them, rho at most 0.9, and an eighth of all at most."""
    noise = np.random.default_rng(3).standard_normal(size)
    residual = np.zeros(size)
    for k in range(1, size):
        residual[k] = rho * residual[k - 1] + noise[k]
    assert low <= run_length(residual if rho else noise) <= high


def strain_sweep(path, strains, repeated=True, head="Oscillation strain (%)"):
    """Write a sweep at three temperatures and some strains, softer with each; return its file."""
    lines = [f"{head},T (°C),f (Hz),E' (MPa),E'' (MPa)"]
    for k, strain in enumerate(strains):
        for celsius in (0, 20, 40):
            for n, hertz in enumerate((0.1, 0.3, 1, 3, 10)):
                at = strain if repeated else strain * (1 + n)
                lines.append(f"{at},{celsius},{hertz},{5 - k},{0.5 - 0.1 * k}")
    path.write_text("\n".join(lines))
    return path


@pytest.mark.parametrize("head", ["Strain (%)", "Oscillation strain (%)", "Dehnung [%]"])
def test_frequencies_that_were_tested_at_several_strains_are_refused(tmp_path, head):
    """Both strains were fitted as one rubber, and its poor fit laid to the temperatures."""
    path = strain_sweep(tmp_path / "a.csv", (0.1, 5), head=head)
    with pytest.raises(DataError, match=r"several strains, .* 0\.1 to 5\. Allowed: one strain"):
        read_dynamic(path)


@pytest.mark.parametrize(
    ("strains", "repeated"), [((0.1,), True), ((0.10, 0.11), True), ((0.1,), False)]
)
def test_one_strain_that_a_machine_hardly_holds_or_that_follows_the_frequency_is_read(
    tmp_path, strains, repeated
):
    sweeps = read_dynamic(strain_sweep(tmp_path / "a.csv", strains, repeated))
    assert [round(sweep.temperature or 0.0, 2) for sweep in sweeps] == [273.15, 293.15, 313.15]


def test_one_frequency_that_a_machine_hardly_holds_is_no_sweep(tmp_path):
    rows = [f"{20 + k},{10 + 0.002 * (-1) ** k},{5 - 0.1 * k},0.5" for k in range(6)]
    path = tmp_path / "ramp.csv"
    path.write_text("\n".join(["T (°C),f (Hz),E' (MPa),E'' (MPa)", *rows]))
    with pytest.raises(DataError, match="one frequency, 10 Hz, in all 6 rows"):
        read_dynamic(path)
