"""Slots: what an option does not use is refused; laws of others enter without a change."""

import subprocess
import sys
from importlib import metadata
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest

from underfoot.case import Case, CaseError
from underfoot.case.friction import FrictionOption
from underfoot.case.quantity import Friction, required
from underfoot.case.section import Option
from underfoot.compute.run import run
from underfoot.core import InputError
from underfoot.friction import ConstantLaw

BASE = {
    "shoe": "work_shoe_untreaded",
    "floor": "vinyl_g4",
    "contaminant": "glycerol_90pct",
    "motion": "slip_tester_g4",
    "numerics": {
        "grid_spacing": "3 mm",
        "quick_grid_spacing": "4 mm",
        "cells_along": 1,
        "tread_positions": 1,
    },
}


@pytest.fixture(autouse=True)
def options_of_the_package_afterwards():
    """Options that a test defines are gone after it."""
    known = {slot: dict(options) for slot, options in Option._known.items()}
    yield
    Option._known.clear()
    Option._known.update(known)


COMMAND = "from underfoot.cli import main; main()"
LAW = '''
"""A law of twenty lines."""
from typing import ClassVar
from underfoot.case.friction import FrictionOption
from underfoot.case.quantity import Friction, required
from underfoot.case.section import Option
from underfoot.friction import ConstantLaw

class Sticky(FrictionOption):
    """COF that grows with viscosity."""
    name: ClassVar[str] = "sticky"
    source: ClassVar[str] = "made up"
    at_water: Friction = required("COF under water")

    def build(self, context):
        cof = self.at_water * (context.viscosity_value / 1e-3) ** 0.1
        return ConstantLaw(cof, 0.0, self.source, context.viscosity_value)
'''


@pytest.mark.parametrize(
    ("path", "value", "remedy"),
    [
        ("friction.alpha", "2 N", 'write model = "adhesion_blocking"'),
        ("friction.shear_strength", "1 MPa", 'write model = "bowden_tabor"'),
        ("friction.cof", 0.4, 'write model = "constant"'),
        ("friction.shear_strenght", "1 MPa", 'Did you mean "shear_strength"? shear_strength bel'),
        ("interface.hurst", 0.7, 'rough_contact.model = "contact_table"'),
        ("interface.shortest_wave", "1 um", 'friction.model = "bowden_tabor"'),
        ("shoe.tread.lug_length", "5 mm", 'write pattern = "blocks"'),
        ("shoe.wear.patch_length", "5 mm", 'write mode = "patch"'),
        ("motion.history_points", [], "history_points"),
        ("rough_contact.model", "exponentail", 'Did you mean "exponential"?'),
        ("film.model", "navier_stokes", "Allowed: reynolds, none"),
    ],
)
def test_what_no_chosen_option_uses_is_refused_where_it_stands(path, value, remedy):
    tree = {key: {"from": item} if isinstance(item, str) else item for key, item in BASE.items()}
    *parents, key = path.split(".")
    table = tree
    for parent in parents:
        table = table.setdefault(parent, {})
    table[key] = value
    with pytest.raises(CaseError) as caught:
        Case.from_mapping({"file_version": 2, **tree})
    assert remedy in str(caught.value)
    assert path in str(caught.value)


def test_a_measured_modulus_leaves_hardness_no_say():
    case = Case(**BASE).replace("shoe.material.modulus", 5e6)
    assert case.hardness is None
    assert "hardness.model" not in case.to_toml(complete=True)
    with pytest.raises(CaseError, match="the modulus of the compound is given"):
        Case(
            **{**BASE, "shoe": {"from": BASE["shoe"], "material": {"modulus": 5e6}}},
            hardness="gent",
        )


def test_switching_an_option_takes_the_old_ones_parameters_along():
    case = Case(**BASE, friction={"model": "constant", "cof": 0.3})
    back = case.replace("friction.model", "pair")
    assert back == Case(**BASE)
    assert Case.from_text(back.to_toml()) == back


def test_a_law_of_ones_own_is_a_class_of_a_few_lines():
    class Doubled(FrictionOption):
        """Twice what is given."""

        name: ClassVar[str] = "doubled"
        half: Friction = required("half of it")

        def build(self, context):
            return ConstantLaw(2 * self.half, 0.0, "given", context.viscosity_value)

    case = Case(**BASE, friction=Doubled(half=0.1))
    assert case == Case(**BASE, friction={"model": "doubled", "half": 0.1})
    assert case.hash != Case(**BASE, friction={"model": "constant", "cof": 0.2}).hash
    with pytest.raises(CaseError, match=r"friction\.half: is missing"):
        Case(**BASE, friction="doubled")
    assert Case.from_text(case.to_toml()) == case
    result = run(case, quick=True)
    assert result.provenance.closures["friction"] == "constant"
    with pytest.raises(InputError, match="defined by Underfoot"):
        type("Doubled", (FrictionOption,), {"name": "stribeck", "__module__": "mine"})
    with pytest.raises(InputError, match="does not define build"):
        type("Empty", (FrictionOption,), {"name": "empty", "__module__": "mine"})
    assert "empty" not in FrictionOption.options()


def test_a_law_of_another_package_registers_by_entry_point(tmp_path, monkeypatch):
    (tmp_path / "sticky_package.py").write_text(LAW)
    info = tmp_path / "sticky_package-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: sticky-package\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[underfoot.friction]\nsticky = sticky_package:Sticky\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert any(e.name == "sticky" for e in metadata.entry_points(group="underfoot.friction"))
    case = Case(**BASE, friction={"model": "sticky", "at_water": 0.1})
    assert case.friction.name == "sticky"
    assert case.value("friction.at_water") == 0.1
    assert "sticky_package:Sticky" in repr(case.hash) or case.hash != Case(**BASE).hash


def test_a_law_in_a_file_of_ones_own_enters_the_command(tmp_path):
    (tmp_path / "my_module.py").write_text(LAW)
    case = Case(**BASE)
    file = tmp_path / "case.toml"
    file.write_text(case.to_toml() + '\n[friction]\nmodel = "my_module:Sticky"\nat_water = 0.1\n')
    source = Path(__file__).parents[2] / "src"
    done = subprocess.run(
        [sys.executable, "-c", COMMAND, "run", str(file), "--quick", "--json"],
        cwd=tmp_path,
        env={"PYTHONPATH": f"{source}:{tmp_path}", "PATH": "", "UNDERFOOT_CACHE": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    import json

    shown = json.loads(done.stdout)
    assert shown["provenance"]["closures"]["friction"] == "constant"
    lost = subprocess.run(
        [sys.executable, "-c", COMMAND, "check", str(file)],
        cwd=tmp_path,
        env={"PYTHONPATH": str(source), "PATH": "", "PYTHONSAFEPATH": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert lost.returncode == 2
    assert "friction.model" in lost.stderr
    assert "PYTHONPATH" in lost.stderr


@pytest.mark.parametrize("address", ["os:path", "json:loads", "nowhere:Law", "my module", "x:"])
def test_an_address_that_is_no_option_is_refused(address):
    with pytest.raises(CaseError, match=r"friction\.model"):
        Case(**BASE, friction={"model": address})


@pytest.mark.slow
def test_an_object_in_a_slot_is_used_named_and_hashed():
    case = Case(**BASE)
    law = ConstantLaw(0.25, 0.05, "my own pin", 0.219)
    own, plain = run(case, quick=True, friction=law), run(case, quick=True)
    share = 1 - own.value("fluid_load") / 500
    assert own.value("cof_adhesion") == pytest.approx(0.25 * share, rel=1e-6)
    assert own.provenance.case_hash not in (case.hash, plain.provenance.case_hash)
    assert "ConstantLaw" in own.provenance.objects["friction"]
    assert "friction" in repr(own)
    assert any("object given to run" in line for line in own.assumptions)
    assert "ConstantLaw" in own.labels["objects"]
    again = run(case, quick=True, friction=ConstantLaw(0.3, 0.05, "my own pin", 0.219))
    assert again.provenance.case_hash != own.provenance.case_hash
    option = run(case, quick=True, friction={"model": "constant", "cof": 0.3})
    assert option.provenance.objects == {}
    assert (
        option.provenance.case_hash
        == case.replace("friction", {"model": "constant", "cof": 0.3}).hash
    )
    assert run(case, quick=True, viscosity=0.02).value("fluid_load") < plain.value("fluid_load")


def test_an_object_that_does_not_fit_is_refused_before_the_work():
    case = Case(**BASE)
    with pytest.raises(InputError, match=r"int is no FrictionLaw: it has no .*breaches"):
        run(case, friction=3)
    with pytest.raises(InputError, match='unknown slot "frictoin"'):
        run(case, frictoin=3)
    rough = type("Rough", (), {"name": "mine"})()
    with pytest.raises(InputError, match="no PressureGapLaw"):
        run(case, rough_contact=rough)


def test_without_film_the_fluid_changes_friction_only():
    wet = Case(**BASE, film="none")
    result = run(wet, quick=True)
    assert result.value("fluid_load") == 0.0
    assert np.isfinite(result.value("cof"))
    assert "builds up no pressure" in result.provenance.closures["film"]
