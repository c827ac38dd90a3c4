"""``underfoot doctor``: versions, libraries in use, missing packages and their remedy, cache."""

import os
import subprocess
import sys

import pytest

from underfoot.core import MissingExtraError, installation, sparse
from underfoot.core.identity import package_version
from underfoot.core.optional import optional_module
from underfoot.core.provenance import Provenance


def test_doctor_as_a_process(tmp_path):
    given = {"UNDERFOOT_CACHE": str(tmp_path / "c"), "UNDERFOOT_SPARSE": "superlu"}
    environment = {**os.environ, **given, "MKL_NUM_THREADS": "3"}
    environment.pop("OMP_NUM_THREADS", None)
    ended = subprocess.run(
        [sys.executable, "-c", "from underfoot.cli import main; main()", "doctor"],
        env=environment,
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    lines = {line[:20].strip(): line[21:] for line in ended.stdout.splitlines()}
    assert lines["h5py"] == package_version("h5py")
    assert lines["sparse solver"].startswith("superlu")
    assert f"{tmp_path / 'c'}: writable" in lines["cache"]
    assert (lines["OMP_NUM_THREADS"], lines["MKL_NUM_THREADS"]) == ("1", "3")


def test_missing_package_is_named_with_its_remedy(monkeypatch):
    monkeypatch.setattr(installation, "find_spec", lambda name: None)
    monkeypatch.setattr(installation, "mkl_library", lambda: None)
    monkeypatch.setattr(sparse, "mkl_library", lambda: None)
    rows = dict(installation.installation())
    assert rows["ngsolve"].endswith('remedy: pip install "underfoot[cad]"')
    assert rows["mkl"].endswith('remedy: pip install "underfoot[fast]"')
    assert rows["sparse solver"].startswith("superlu; MKL would save")


def test_cache_that_cannot_be_written_is_told(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path / "file" / "cache"))
    assert "CANNOT BE WRITTEN" in dict(installation.installation())["cache"]


def test_version_that_is_not_recorded_is_unknown_and_no_error(monkeypatch):
    def none(name):
        raise installation.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(installation.metadata, "version", none)
    monkeypatch.setattr(installation.metadata, "requires", none)
    assert dict(installation.installation())["numpy"] == "unknown"
    assert Provenance.now("hash", grid=1e-3, closures={}).versions["scipy"] == "unknown"


def test_optional_module_loads_or_names_the_extra():
    assert optional_module("json.decoder", "cad", "Reading").JSONDecoder
    with pytest.raises(MissingExtraError, match=r"Reading STEP needs the package nowhere.*\[cad\]"):
        optional_module("nowhere.occ", "cad", "Reading STEP")
