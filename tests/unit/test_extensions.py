"""What other packages add, each in at most forty lines; a broken one touches nobody else."""

import importlib
import json
import subprocess
import sys
import textwrap
from functools import cache
from importlib import metadata
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from underfoot.case import Case, CaseError
from underfoot.case.section import Option
from underfoot.compute.run import run
from underfoot.core import InputError, registry
from underfoot.core.catalogue import Catalogue, offered_catalogues
from underfoot.core.registry import all_offers, broken_offers, find_offer
from underfoot.questions.ask import ask
from underfoot.questions.method import method_name
from underfoot.shoe.files import outsole_from_file
from underfoot.studies import Options, run_study, study
from underfoot.trials.readers import read_trial

COMMAND = "from underfoot.cli import main; main()"
PARTS = {
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
EXTENSIONS = {
    "law": """
        from typing import ClassVar
        from underfoot.case.friction import FrictionOption
        from underfoot.case.quantity import Friction, required
        from underfoot.friction import ConstantLaw

        class Sticky(FrictionOption):
            name: ClassVar[str] = "sticky"
            source: ClassVar[str] = "made up"
            at_water: Friction = required("COF under water")

            def build(self, context):
                cof = self.at_water * (context.viscosity_value / 1e-3) ** 0.1
                return ConstantLaw(cof, 0.0, self.source, context.viscosity_value)
    """,
    "fluid": """
        import math
        from typing import Annotated, ClassVar
        from underfoot.case.contaminant import ContaminantSection
        from underfoot.case.quantity import Quantity
        from underfoot.core import SourcedValue

        class Andrade(ContaminantSection):
            name: ClassVar[str] = "andrade"
            source: ClassVar[str] = "Andrade 1930"
            chosen_by: ClassVar[tuple[str, ...]] = ("activation",)
            activation: Annotated[float, Quantity("K", 0.0, 1e4)]
            temperature: Annotated[float, Quantity("K", 250.0, 400.0)] = 293.15

            def build(self):
                return SourcedValue(1e-5 * math.exp(self.activation / self.temperature), "Pa*s")
    """,
    "asperities": """
        from typing import ClassVar
        from underfoot.case.contact import RoughContactOption
        from underfoot.rough_contact import ExponentialLaw

        class Stiffer(RoughContactOption):
            name: ClassVar[str] = "stiffer"
            source: ClassVar[str] = "made up"

            def build(self, context):
                return ExponentialLaw(2 * context.youngs_modulus, 0.49, context.rq_value)
    """,
    "bedding": """
        from typing import ClassVar
        import numpy as np
        from underfoot.case.contact import ComplianceOption

        class Winkler:
            def __init__(self, sole, softness):
                self.self_compliance = np.full(sole.clearance.shape, softness)

            def apply(self, pressure):
                return self.self_compliance * pressure

            def symbol(self, wavenumber):
                return self.self_compliance.flat[0] * np.ones_like(wavenumber)

        class WinklerBedding(ComplianceOption):
            name: ClassVar[str] = "winkler"
            source: ClassVar[str] = "Winkler 1867"

            def build(self, context, sole):
                return Winkler(sole, context.shoe.sole.outsole_thickness / context.youngs_modulus)
    """,
    "thinning": """
        from dataclasses import dataclass
        from typing import Annotated, ClassVar
        import numpy as np
        from underfoot.case.contact import FilmOption
        from underfoot.case.quantity import Quantity
        from underfoot.film import Conductance

        @dataclass(frozen=True)
        class PowerLawFilm:
            viscosity: float
            exponent: float
            name: str = "shear thinning"
            source: str = "power law above 1 / s"

            def thinned(self, rate):
                return np.maximum(rate, 1.0) ** (self.exponent - 1)

            def flow_factor(self, gap, speed):
                rate = speed / gap
                value = 1 / self.thinned(rate)
                slope = np.where(rate > 1, (self.exponent - 1) / gap, 0.0) * value
                return Conductance(value, slope)

            def shear(self, speed, film_thickness):
                rate = speed / film_thickness
                return self.viscosity * self.thinned(rate) * rate

        class Thinning(FilmOption):
            name: ClassVar[str] = "thinning"
            source: ClassVar[str] = "power law"
            exponent: Annotated[float, Quantity("1", 0.1, 1.0)] = 0.8

            def build(self, context):
                return PowerLawFilm(context.viscosity_value, self.exponent)
    """,
    "recorder": """
        import numpy as np

        def read(draft):
            if draft.data[:4] != b"TRIB":
                raise draft.error("this is no recording of the tribometer")
            values = np.frombuffer(draft.data[4:], dtype="<f8").reshape(-1, 2)
            draft.rate = 100.0
            draft.channel("normal force", values[:, 0], unit="N")
            draft.channel("friction force", values[:, 1], unit="N")
            return draft.trial("TRIB, read by tribo_ext")
    """,
    "scanner": """
        import numpy as np
        from underfoot.shoe.files.mesh import Mesh

        def read(path):
            triangles = np.load(path, allow_pickle=False).astype(np.float32)
            return Mesh(triangles, "NPY", 1e-3, ("Read by tribo_ext.",))
    """,
    "paper": """
        from pathlib import Path
        from underfoot.studies import Computed, ComputedQuantity

        STATEMENTS = Path(__file__).with_name("paper.toml")

        def compute(options):
            return Computed({"answer": ComputedQuantity.of(0.31)}, conclusions=("It agrees.",))
    """,
    "question": """
        from dataclasses import dataclass
        from underfoot.compute.run import run
        from underfoot.core.presentation import Presentable, Table

        @dataclass(frozen=True)
        class Halved(Presentable):
            name: str
            cof: float

            def table(self):
                return Table("COF at half the speed", ("COF",), [(f"{self.cof:.3f}",)])

        def halved(case, *, quick, processes=1, progress):
            slow = case.replace("motion.speed", case.motion.speed / 2)
            return Halved(case.name, run(slow, quick=quick, progress=progress).value("cof"))
    """,
}
FILES = {
    "paper.toml": """
        title = "A paper"
        source = "nobody 2026"
        [[statement]]
        id = "level"
        text = "COF of the pin"
        place = "Table 1"
        claim = "value"
        printed = "0.30"
        tolerance = 0.02
        reason = "scatter of three repeats"
        quantity = "answer"
    """,
    "entries/own.toml": """
        [fluid.soap_own]
        title = "Soap"
        source = "own measurement"
        viscosity = "18 cP"
        family = "detergent"

        [fluid.water]
        title = "Water, that would hide ours"
        source = "none"
        viscosity = "5 Pa*s"

        [setup.own_method]
        title = "Own method"
        source = "own"
        [setup.own_method.motion]
        speed = "0.2 m/s"
        normal_force = "300 N"
        shoe_angle = "5 deg"
        duration = "200 ms"
        [setup.own_method.method]
        floor = "vinyl_g4"
        contaminant = "soap_own"
        averaging_from = "sliding"
        averaging_start = "0.1 s"
        averaging_end = "0.2 s"
    """,
}
DOORS = {
    "friction": {"sticky": "tribo_ext.law:Sticky"},
    "contaminant": {"andrade": "tribo_ext.fluid:Andrade"},
    "rough_contact": {"stiffer": "tribo_ext.asperities:Stiffer"},
    "compliance": {"winkler": "tribo_ext.bedding:WinklerBedding"},
    "film": {"thinning": "tribo_ext.thinning:Thinning"},
    "trial_readers": {"trib": "tribo_ext.recorder:read"},
    "outsole_readers": {"npy": "tribo_ext.scanner:read"},
    "studies": {"paper": "tribo_ext.paper"},
    "questions": {"halved": "tribo_ext.question:halved"},
    "catalogues": {"tribo": "tribo_ext:entries"},
}


def install(folder, name, modules, doors, files=(), version="1.0"):
    """Write a package with its entry points into a folder on Python's path."""
    package = folder / name
    package.mkdir()
    (package / "__init__.py").write_text("")
    for module, text in modules.items():
        (package / f"{module}.py").write_text(textwrap.dedent(text))
    for path, text in dict(files).items():
        (package / path).parent.mkdir(exist_ok=True)
        (package / path).write_text(textwrap.dedent(text))
    info = folder / f"{name}-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    lines = [
        line
        for door, entries in doors.items()
        for line in (f"[underfoot.{door}]", *(f"{key} = {at}" for key, at in entries.items()))
    ]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    importlib.invalidate_caches()
    all_offers.cache_clear()


@pytest.fixture
def site(tmp_path, monkeypatch):
    """A folder for packages that is on Python's path; what they define is gone afterwards."""
    known = {slot: dict(options) for slot, options in Option._known.items()}
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(str(folder))

    def ours():  # what else is installed on this machine is not tested here
        return [metadata.distribution("underfoot"), *metadata.distributions(path=[str(folder)])]

    monkeypatch.setattr(registry, "metadata", SimpleNamespace(distributions=ours))
    all_offers.cache_clear()
    yield folder
    for name in [name for name in sys.modules if name.startswith(("tribo_ext", "broken_ext"))]:
        del sys.modules[name]
    Option._known.clear()
    Option._known.update(known)
    all_offers.cache_clear()
    study.cache_clear()


@pytest.fixture
def tribo(site):
    install(site, "tribo_ext", EXTENSIONS, DOORS, FILES)


def command(*arguments, path, cwd):
    return subprocess.run(
        [sys.executable, "-c", COMMAND, *map(str, arguments)],
        cwd=cwd,
        env={"PYTHONPATH": ":".join(map(str, path)), "PATH": "", "UNDERFOOT_CACHE": str(cwd)},
        capture_output=True,
        text=True,
        check=False,
    )


def test_each_extension_is_at_most_forty_lines():
    assert len(DOORS) >= 9
    for name, text in {**EXTENSIONS, **FILES}.items():
        assert len(text.strip().splitlines()) <= 40, name


@cache
def plain_cof():
    return run(Case(**PARTS), quick=True).value("cof")


@pytest.mark.parametrize(
    "given",
    [
        {"friction": {"model": "sticky", "at_water": 0.1}},
        {"contaminant": {"model": "andrade", "activation": "2800 K"}},
        {"contaminant": {"activation": "2800 K", "model": "andrade", "temperature": "25 degC"}},
        {"rough_contact": "stiffer"},
        {"compliance": "winkler"},
        {"film": "thinning"},
    ],
    ids=str,
)
def test_physics_of_another_package_is_computed_and_counts(tribo, given):
    case, plain = Case(**{**PARTS, **given}), Case(**PARTS)
    result = run(case, quick=True)
    assert result.usable
    assert result.value("cof") != plain_cof()
    assert result.provenance.case_hash == case.hash != plain.hash
    assert Case.from_text(case.to_toml(complete=True)).hash == case.hash


@pytest.mark.slow
def test_a_film_is_an_object(tribo):
    """A power law of exponent 1 is a Newtonian film; thinning takes load off the film."""
    case = Case(**PARTS)
    newtonian = run(case, quick=True)
    even, thin = (
        run(case.replace("film", {"model": "thinning", "exponent": n}), quick=True)
        for n in (1.0, 0.8)
    )
    for name in ("fluid_load", "cof_adhesion"):
        assert even.value(name) == pytest.approx(newtonian.value(name), rel=1e-6)
    assert even.value("cof_viscous") == pytest.approx(newtonian.value("cof_viscous"), rel=1e-6)
    assert thin.value("fluid_load") < 0.7 * newtonian.value("fluid_load")
    assert thin.provenance.closures["film"] == "power law above 1 / s"
    film = case.replace("film", "thinning").film.build(SimpleNamespace(viscosity_value=0.219))
    given = run(case, quick=True, film=film)
    assert given.value("cof") == pytest.approx(thin.value("cof"), rel=1e-6)
    assert given.provenance.case_hash not in (case.hash, thin.provenance.case_hash)
    with pytest.raises(InputError, match=r"no FilmModel: it has no flow_factor, .*viscosity"):
        run(case, quick=True, film=3.0)


def test_a_recording_of_another_tribometer(tribo, tmp_path):
    rows = np.column_stack([np.full(50, 20.0), np.linspace(2.0, 4.0, 50)])
    (tmp_path / "pin.trib").write_bytes(b"TRIB" + rows.astype("<f8").tobytes())
    trial = read_trial(tmp_path / "pin.trib")
    assert trial.channel("friction force").values[-1] == 4.0
    assert trial.source == "TRIB, read by tribo_ext"
    (tmp_path / "wrong.trib").write_bytes(b"text")
    with pytest.raises(InputError.__mro__[1], match="no recording of the tribometer"):
        read_trial(tmp_path / "wrong.trib")


def sole_block():
    """Return the triangles of a block of 135 x 53 x 10 mm with an oval plan, narrower behind."""
    angle = np.linspace(0, 2 * np.pi, 91)
    width = 22.5 - 4 * np.cos(angle)
    rim = np.column_stack([67.5 * np.cos(angle), width * np.sin(angle), 0 * angle])
    up = np.array([0.0, 0.0, 10.0])
    faces = []
    for one, other in pairwise(rim):
        faces += [(one, other, other + up), (one, other + up, one + up)]
        faces += [(0 * up, other, one), (up, one + up, other + up)]
    return np.array(faces)


@pytest.mark.slow
def test_an_outsole_file_of_another_format(tribo, tmp_path):
    path = tmp_path / "sole.npy"
    np.save(path, sole_block())
    sole = outsole_from_file(path)
    assert sole.format == "NPY"
    assert sole.surface.length == pytest.approx(0.135, abs=2e-3)
    shoe = {
        "outsole": {"file": str(path)},
        "material": {"shore_a": 60},
        "roughness": {"ra": "5 um"},
    }
    case = Case(**{**PARTS, "shoe": shoe})
    assert case.hash == Case(**{**PARTS, "shoe": shoe}).hash


def test_a_study_of_another_package(tribo):
    result = run_study(study("paper"), Options())
    (one,) = result.judgements
    assert str(one.verdict) == "agrees"
    assert result.headline()[0].startswith("Of 1 independent statements: 1 agrees")


def test_entries_and_a_test_method_of_another_package(tribo):
    case = Case(**{**PARTS, "contaminant": "soap_own", "motion": "own_method"})
    assert case.value("contaminant.viscosity") == 0.018
    assert method_name("own-method", case) == "own_method"
    assert Catalogue.load().entry("fluid", "water").sourced_value("viscosity").value < 2e-3
    (line,) = offered_catalogues()
    assert "the fluid water stays as Underfoot has it" in line


def test_a_question_of_another_package(tribo, tmp_path, site):
    case = Case(**PARTS)
    found = ask("halved", case, quick=True, progress=lambda *_: None)
    slow = run(case.replace("motion.speed", 0.35), quick=True)
    assert found.cof == pytest.approx(slow.value("cof"))
    with pytest.raises(InputError, match=r'question "halvd".*halved'):
        ask("halvd", case)
    case.save(tmp_path / "case.toml")
    src = importlib.import_module("underfoot").__path__[0]
    given = ("ask", "halved", tmp_path / "case.toml", "--quick", "--json")
    done = command(*given, path=[f"{src}/..", site], cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["rows"][0]["COF"] == f"{found.cof:.3f}"


BROKEN = {
    "raises": "raise RuntimeError('no licence\\nsecond line')",
    "leaves": "raise SystemExit(3)",
    "missing": "import no_such_module_anywhere",
    "wrong": "Law = 3",
    "ours": """
        from typing import ClassVar
        from underfoot.case.friction import FrictionOption

        class Pair(FrictionOption):
            name: ClassVar[str] = "pair"

            def build(self, context):
                raise AssertionError
    """,
}
BROKEN_DOORS = {
    "friction": {
        "raises": "broken_ext.raises:Law",
        "leaves": "broken_ext.leaves:Law",
        "missing": "broken_ext.missing:Law",
        "wrong": "broken_ext.wrong:Law",
        "absent": "broken_ext.wrong:Nothing",
        "pair": "broken_ext.ours:Pair",
    },
    "contaminant": {"raises": "broken_ext.raises:Fluid"},
    "film": {"missing": "broken_ext.missing:Film"},
    "studies": {"missing": "broken_ext.missing:study", "g2": "broken_ext.raises:study"},
    "catalogues": {"torn": "broken_ext:torn", "none": "broken_ext:nowhere", "gone": "gone_ext:x"},
    "outsole_readers": {"obj": "broken_ext.raises:read"},
    "trial_readers": {"c3d": "broken_ext.raises:read"},
    "questions": {"raises": "broken_ext.raises:ask"},
}
TORN = {"torn/own.toml": "[fluid.soap_torn]\nviscosity =", "torn2/x.toml": ""}


def test_a_broken_package_changes_no_byte_of_a_run(site, tmp_path):
    src = f"{importlib.import_module('underfoot').__path__[0]}/.."
    Case(**PARTS).save(tmp_path / "case.toml")
    given = ("run", tmp_path / "case.toml", "--quick", "--out")
    plain = command(*given, "plain", path=[src], cwd=tmp_path)
    install(site, "broken_ext", BROKEN, BROKEN_DOORS, TORN)
    beside = command(*given, "beside", path=[src, site], cwd=tmp_path)
    assert (plain.returncode, beside.returncode) == (0, 0), beside.stderr
    told = [  # a run of more than two seconds says how far it is
        [line for line in each.stderr.splitlines() if " so far" not in line]
        for each in (beside, plain)
    ]
    assert told[0] == told[1]
    for name in ("case.toml", "summary.csv"):
        written = [(tmp_path / folder / name).read_bytes() for folder in ("plain", "beside")]
        assert written[0] == written[1], name
    kept = [
        {**json.loads((tmp_path / folder / "result.json").read_text()), "folder": folder}
        for folder in ("plain", "beside")
    ]
    for each in kept:
        each["provenance"] = {
            k: v for k, v in each["provenance"].items() if k not in ("timings", "created")
        }
        fields = xr.load_dataset(tmp_path / each.pop("folder") / "result.nc", engine="h5netcdf")
        del fields.attrs["history"], each["fields_sha256"]  # both hold when it was made
        each["fields"] = fields.to_dict()
    np.testing.assert_equal(kept[0], kept[1])


def test_who_asks_for_a_broken_package_is_told_in_one_line(site):
    install(site, "broken_ext", BROKEN, BROKEN_DOORS, TORN)
    for name, why in {
        "raises": "RuntimeError: no licence",
        "leaves": "SystemExit: 3",
        "missing": "no_such_module_anywhere",
        "wrong": "is no option of friction",
        "absent": "Nothing",
    }.items():
        with pytest.raises(CaseError, match=why) as told:
            Case(**PARTS, friction=name)
        assert "broken_ext" in str(told.value)
        assert "\n" not in str(told.value)
    assert Case(**PARTS, friction="pair").friction.__class__.__module__.startswith("underfoot.")
    with pytest.raises(InputError, match=r"friction\.dry.*package.*broken_ext.*no licence"):
        Case(**PARTS).replace("friction.dry", 0.4)
    with pytest.raises(CaseError, match=r'unknown choice "stciky"'):
        Case(**PARTS, friction="stciky")
    with pytest.raises(InputError, match="no_such_module_anywhere"):
        study("missing")
    assert study("g2").name == "g2"
    lines = [*broken_offers(), *offered_catalogues()]
    assert all("\n" not in line for line in lines)
    for part in ("licence", "no_such_module_anywhere", "torn", "nowhere", "gone_ext"):
        assert any(part in line for line in lines), part


def test_two_packages_of_one_name(site):
    law = {"law": EXTENSIONS["law"]}
    install(site, "tribo_ext", law, {"friction": {"sticky": "tribo_ext.law:Sticky"}})
    install(site, "broken_ext", law, {"friction": {"sticky": "broken_ext.law:Sticky"}})
    with pytest.raises(
        CaseError, match=r'two packages offer the friction "sticky".*broken_ext.*tribo'
    ):
        Case(**PARTS, friction={"model": "sticky", "at_water": 0.1})
    assert Case(**PARTS).friction.name == "pair"
    own = Case(**PARTS, friction={"model": "tribo_ext.law:Sticky", "at_water": 0.1})
    assert type(own.friction).__module__ == "tribo_ext.law"
    with pytest.raises(CaseError, match="is defined by tribo_ext"):
        Case(**PARTS, friction={"model": "broken_ext.law:Sticky", "at_water": 0.1})


def test_a_package_without_a_version_is_computed_and_counts(site):
    install(site, "tribo_ext", {"law": EXTENSIONS["law"]}, {"friction": DOORS["friction"]})
    next(site.glob("*.dist-info/METADATA")).write_text("Metadata-Version: 2.1\nName: tribo_ext\n")
    case = Case(**PARTS, friction={"model": "sticky", "at_water": 0.1})
    assert run(case, quick=True).provenance.case_hash == case.hash != Case(**PARTS).hash


def test_nobody_offers_what_nobody_offers(site):
    assert find_offer("friction", "sticky") is None
    assert list(broken_offers()) == []
