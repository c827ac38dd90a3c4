"""A plugin of pytest that notes which lines of the source each test runs, and how long it takes.

``python tests/mutants.py`` records with it what is not yet known. A file of tests has a file of its
own in out/mutants/map. What it says of a file of the source counts until that one, or the file of
tests, changes; a change elsewhere may lead a test past other lines (remove the folder to be sure).
"""

import hashlib
import json
import time
import warnings
from collections.abc import Iterable
from pathlib import Path

import coverage
import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
SOURCE = REPOSITORY / "src" / "underfoot"
MAPS = REPOSITORY / "out" / "mutants" / "map"


def digest(path: Path) -> str:
    """Return what changes with the text of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16] if path.exists() else ""


def map_path(tests: str) -> Path:
    """Return where the lines of a file of tests (relative to the repository) are written."""
    return MAPS / (tests.replace("/", "-") + ".json")


def known_map(tests: str, files: Iterable[str] = ()) -> dict | None:
    """Return the lines that the tests of a file run, or None where they must be recorded.

    ``files``: of the source (relative to its folder), of which the lines must be those of today.
    """
    path = map_path(tests)
    if not path.exists():
        return None
    found = json.loads(path.read_text(encoding="utf-8"))
    alike = found["of"] == digest(REPOSITORY / tests) and all(
        found["sources"].get(file) in (None, digest(SOURCE / file)) for file in files
    )
    return found if alike else None


def write_map(file: str, tests: list[dict], lines: dict[str, dict[int, list[int]]]) -> None:
    """Write the tests of a file, and the numbers of those that run each line of the source."""
    MAPS.mkdir(parents=True, exist_ok=True)
    sources = {path: digest(SOURCE / path) for path in lines}
    entry = {"of": digest(REPOSITORY / file), "sources": sources, "tests": tests, "lines": lines}
    map_path(file).write_text(json.dumps(entry), encoding="utf-8")


class Recorder:
    """Traces the source, one context a test; writes a map when the last test of a file is done."""

    def __init__(self) -> None:
        self.tracer = coverage.Coverage(
            data_file=None, config_file=False, include=[f"{SOURCE}/*"], messages=False
        )
        self.tracer.start()
        self.tests: dict[str, dict] = {}

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item, nextitem):
        self.tracer.switch_context(item.nodeid)
        begun = time.process_time()
        answer = yield
        entry = self.tests.setdefault(item.nodeid, {"passed": True})
        entry["seconds"] = round(time.process_time() - begun, 3)
        self.tracer.switch_context("")
        file = item.nodeid.partition("::")[0]
        if nextitem is None or nextitem.nodeid.partition("::")[0] != file:
            self.write(file)
        return answer

    def pytest_runtest_logreport(self, report):
        if report.failed:
            self.tests.setdefault(report.nodeid, {})["passed"] = False

    def write(self, file: str) -> None:
        self.tracer.stop()
        with warnings.catch_warnings():  # of a file of tests that runs no line
            warnings.simplefilter("ignore")
            data = self.tracer.get_data()
        names = list(self.tests)
        lines: dict[str, dict[int, list[int]]] = {}
        for number, name in enumerate(names):
            data.set_query_context(name)
            for path in data.measured_files():
                of_file = lines.setdefault(Path(path).relative_to(SOURCE).as_posix(), {})
                for line in data.lines(path) or ():
                    of_file.setdefault(line, []).append(number)
        lines = {path: of_file for path, of_file in lines.items() if of_file}
        write_map(file, [{"name": name, **self.tests[name]} for name in names], lines)
        self.tests = {}
        self.tracer.erase()
        self.tracer.start()


def pytest_configure(config):
    if not config.pluginmanager.has_plugin("dsession"):  # it runs nothing itself
        config.pluginmanager.register(Recorder())
