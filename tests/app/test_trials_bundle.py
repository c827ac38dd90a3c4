"""The audit bundle: whole, checked by other tools, signed for its checksums, changes told."""

import hashlib
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from trial_testers import FAULTS, sound_log, write_log
from underfoot.cli.trials import trials_app
from underfoot.core import InputError
from underfoot.trials.pages.court_bundle import bundle_faults, changed_files


def bundled(folder, out, *more):
    arguments = more or (folder, "--protocol", "en_iso_13287", "--out", out)
    return CliRunner().invoke(trials_app, ["bundle", *map(str, arguments)])


@pytest.fixture(scope="module")
def bundle(tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs")
    write_log(FAULTS["two slides in the file"](sound_log(44)), folder, name="two.csv")
    write_log(sound_log(44), folder, name="one.csv")
    (folder / "conditions.csv").write_text(
        "file,shoe,date\none.csv,A,2026-03-12\ntwo.csv,A,2026-03-12\n"
    )
    (folder / "edits.csv").write_text("file,step,edit,value,why\ntwo.csv,1,exclude,,second slide\n")
    out = folder.parent / "bundle"
    done = bundled(folder, out)
    assert done.exit_code == 0, done.output
    return out


def test_the_page_holds_what_a_court_asks_for(bundle):
    page = (bundle / "audit.html").read_text()
    text = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", page))
    for words in (
        "certificate K-117 of 2026-01-15", "second slide", "normal force from 475 N to 525 N",
        "not verified", "EN ISO 13287:2019", "standard uncertainty", "numpy", "Signature",
    ):  # fmt: skip
        assert words in text, words
    data = (bundle / "recordings" / "one.csv").read_bytes()
    assert hashlib.sha256(data).hexdigest() in page
    assert hashlib.sha256((bundle / "SHA256SUMS").read_bytes()).hexdigest() in page
    # Once in the methods and once for each setting or rule in the table of the method, no more.
    assert text.count("Not verified against the text of EN ISO 13287:2019") == 1


def test_other_tools_check_the_files(bundle):
    done = subprocess.run(
        ["sha256sum", "--quiet", "-c", "SHA256SUMS"], cwd=bundle, capture_output=True, check=False
    )
    assert done.returncode == 0, done.stdout


def test_a_bundle_is_as_written_until_it_is_changed(bundle):
    assert bundle_faults(bundle) == []
    path = bundle / "recordings" / "one.csv"
    before = path.read_bytes()
    rows = before.decode().splitlines()
    head = rows[0].split(",")
    normal = next(i for i, name in enumerate(head) if "Fz" in name or "normal" in name)
    for i, row in enumerate(rows[1:], start=1):
        cells = row.split(",")
        cells[normal] = f"{0.99 * float(cells[normal]):.7g}"
        rows[i] = ",".join(cells)
    try:
        path.write_text("\n".join(rows))
        (bundle / "recordings" / "late.csv").write_text("x")
        faults = bundle_faults(bundle)
        done = bundled(None, None, "--check", bundle)
    finally:
        path.write_bytes(before)
        (bundle / "recordings" / "late.csv").unlink()
    assert "recordings/one.csv: changed" in faults
    assert "recordings/late.csv: not in SHA256SUMS" in faults
    assert any("numbers come out differently" in fault for fault in faults)
    assert done.exit_code == 3
    assert "recordings/one.csv: changed" in done.output
    page = (bundle / "audit.html").read_text()
    signed = hashlib.sha256((bundle / "SHA256SUMS").read_bytes()).hexdigest()
    (bundle / "audit.html").write_text(page.replace(signed, 64 * "0"))
    assert any("audit.html" in fault for fault in bundle_faults(bundle))
    (bundle / "audit.html").write_text(page)


def changed(path, content):
    """Write other content into a file (None: take it away); return what puts the file back."""
    before = path.read_bytes() if path.is_file() else None

    def write(data):
        path.unlink(missing_ok=True)
        if data is not None:
            path.write_bytes(data)

    write(content)
    return lambda: write(before)


def test_a_single_changed_byte_of_any_file_is_named(bundle):
    """A walk over all files, 24 bytes of each: every bit pattern comes up, also line ends."""
    assert changed_files(bundle) == []
    rng = np.random.default_rng(3)
    files = sorted(path for path in bundle.rglob("*") if path.is_file())
    assert len(files) > 15
    for path in files:
        content = path.read_bytes()
        places = {0, len(content) - 1, *rng.integers(0, len(content), 22).tolist()}
        for place in places if content else ():
            other = bytearray(content)
            other[place] ^= int(rng.integers(1, 256))
            back = changed(path, bytes(other))
            try:
                faults = {fault.about for fault in changed_files(bundle)}
            except InputError as error:
                faults = {Path(str(error.where)).name}
            finally:
                back()
            # a changed list of checksums is told by the page that names its checksum
            own = path.relative_to(bundle).as_posix()
            assert ("audit.html" if own == "SHA256SUMS" else own) in faults


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [
        ("report/tables/measurements.csv", None, "measurements.csv: missing"),
        ("report/tables/measurements.csv", b"\xff\xfe", "measurements.csv: changed"),
        ("recordings/.hidden.csv", b"1", "recordings/.hidden.csv: not in SHA256SUMS"),
        ("recordings/conditions.csv", b"a\nb\n", "recordings/conditions.csv: changed"),
        ("recordings/edits.csv", b"\xff", "recordings: the analysis can't be made again"),
        ("SHA256SUMS", b"\xff\n", "SHA256SUMS: line 1 is no checksum of a file"),
        ("audit.html", None, "audit.html: missing"),
    ],
)
def test_what_is_damaged_in_a_bundle_is_named(bundle, name, content, told):
    back = changed(bundle / name, content)
    try:
        assert any(told in fault for fault in bundle_faults(bundle))
    finally:
        back()


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "Expecting value"), (b"[]", "no object"), (b"\xff", "can't decode"),
        (b"[" * 100_000, "recursion"),
        (b"{}", "options"), (b'{"options": {"folder": 1}}', "folder"),
    ],
)  # fmt: skip
def test_damaged_settings_are_an_error_with_a_remedy(bundle, content, reason):
    back = changed(bundle / "bundle.json", content)
    late = changed(bundle / "recordings" / "late.csv", b"x")
    try:
        done = bundled(None, None, "--check", bundle)
        with pytest.raises(InputError, match=reason) as error:
            bundle_faults(bundle)
    finally:
        back()
        late()
    assert done.exit_code == 2
    for words in ("bundle.json", "is damaged", "as it was signed", "late.csv: not in SHA256SUMS"):
        assert words in str(error.value), words


@pytest.mark.slow
def test_a_page_changed_after_signing_is_named(bundle):
    sums, page = bundle / "SHA256SUMS", bundle / "audit.html"
    before = {path: path.read_bytes() for path in (sums, page, bundle / "report" / "report.html")}

    def found(*changes):
        try:
            for path, old, new in changes:
                assert old in path.read_bytes()
                path.write_bytes(path.read_bytes().replace(old, new, 1))
            return bundle_faults(bundle)
        finally:
            for path, content in before.items():
                path.write_bytes(content)

    assert found((page, b"<table", b"<table ")) == ["audit.html: changed"]
    signed = hashlib.sha256(before[sums]).hexdigest().encode()
    assert found((page, b"</body>", signed + b"</body>")) == ["audit.html: changed"]
    # the checksums made again, as somebody would who knows of them
    report = bundle / "report" / "report.html"
    other = report.read_bytes().replace(b"COF", b"C0F", 1)
    old = hashlib.sha256(before[report]).hexdigest().encode()
    listed = before[sums].replace(old, hashlib.sha256(other).hexdigest().encode())
    faults = found(
        (report, b"COF", b"C0F"),
        (sums, before[sums], listed),
        (page, signed, hashlib.sha256(listed).hexdigest().encode()),
    )
    assert faults == ["report/report.html: not what the recordings give again"]


def test_no_bundle_is_said(tmp_path):
    with pytest.raises(InputError, match="is no bundle"):
        bundle_faults(tmp_path)
    done = bundled(tmp_path, tmp_path / "inside")
    assert done.exit_code == 2
    assert "can't take the bundle" in done.output
