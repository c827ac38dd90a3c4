"""The audit bundle: whole, checked by other tools, signed for its checksums, changes told."""

import hashlib
import re
import subprocess

import pytest
from typer.testing import CliRunner

from trial_testers import FAULTS, sound_log, write_log
from underfoot.cli.trials import trials_app
from underfoot.core import InputError
from underfoot.trials.pages.court_bundle import bundle_faults


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
