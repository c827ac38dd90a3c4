"""What several tests share."""

import gc
import hashlib
import os
import shutil
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from machine import CHROMIUM, cpu_seconds
from positive_bounds import bounds_below_zero

QUICK = "not costly and not slow and not study"
LONG = 3  # s of CPU, above which a test should be costly or slow
COSTLY = Path(__file__).with_name("costly.txt")
CPU = pytest.StashKey[list[float]]()
UNTIL = float(os.environ.get("SLOW_TESTS_UNTIL") or "inf")  # Unix time
OUT_OF_TIME = "slow, and the time of this run is over (make test-slow runs all)"
NO_BROWSER = "no Chromium on this machine (Debian, Ubuntu: apt-get install chromium)"

# the same examples in every run, on every machine; make fuzz draws others
settings.register_profile("fuzz", settings.get_profile("default"), deadline=None, print_blob=True)
settings.load_profile("ci")
# started in the background of a shell, the programs of the tests would ignore Ctrl-C
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


APPROX = pytest.approx


def approx(expected, rel=None, abs=None, nan_ok=False):
    """pytest's; but its absolute 1e-12 does not decide of films, volumes and chances below it."""
    if abs is None:
        values = list(expected.values()) if isinstance(expected, dict) else expected
        with suppress(TypeError, ValueError):
            sizes = np.abs(np.asarray(values)).astype(float)  # of complex numbers too
            largest = float(np.max(sizes, where=np.isfinite(sizes), initial=0.0))
            rel = 1e-6 if rel is None else rel  # pytest leaves its own out beside an absolute one
            abs = min(largest * rel, 1e-12) if largest else None
    return APPROX(expected, rel=rel, abs=abs, nan_ok=nan_ok)


pytest.approx = approx


@pytest.fixture(scope="session", autouse=True)
def no_page_has_a_positive_quantity_below_zero(tmp_path_factory):
    """Reads every page that the tests of this process left: no COF, share or distance below 0."""
    yield
    pages = sorted(tmp_path_factory.getbasetemp().rglob("*.html"))
    found = [f"{page.parent}: {line}" for page in pages for line in bounds_below_zero(page)]
    assert not found, found


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Marks the costly ones; where a run may leave slow ones out, each version has other files."""
    costly = costly_tests()
    for item in items:
        if item.nodeid.partition("[")[0] in costly:
            item.add_marker("costly")
    seed = os.environ.get("SLOW_TESTS_SEED", "")
    if seed and config.option.markexpr.startswith("slow"):
        items.sort(key=lambda item: hashlib.sha256(f"{seed} {item.path.name}".encode()).digest())


def costly_tests():
    """Return the names (file::test) of the tests of ``costly.txt``."""
    names, file = set(), ""
    for line in COSTLY.read_text(encoding="utf-8").splitlines():
        if line.startswith("tests/"):
            file = line
        elif not line.startswith("#"):
            names.add(f"{file}::{line.strip()}")
    return names


def pytest_configure():
    """statsmodels collects garbage at each adjustment of p: half a second among all tests."""
    whole = gc.collect

    def collect(generation=2):
        asks = sys._getframe(1).f_globals.get("__name__", "")
        return 0 if asks.startswith("statsmodels.") else whole(generation)

    gc.collect = collect


def pytest_collection_finish():
    """All tests and their modules stay to the end: no collection of garbage walks through them."""
    gc.collect()
    gc.freeze()


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item, nextitem):
    """What a file leaves stays too: NiceGUI collects garbage twice for each test of a page."""
    if nextitem is not None and nextitem.path != item.path:
        gc.collect()
        gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Tests in a browser fail in CI where there is none; on a desk they are skipped, and say so."""
    if item.get_closest_marker("browser") and not any(map(shutil.which, CHROMIUM)):
        # a desk without a browser can run all other tests; CI installs one (make chromium)
        (pytest.fail if os.environ.get("CI") == "true" else pytest.skip)(NO_BROWSER)
    if item.get_closest_marker("slow") and time.time() > UNTIL:
        # a machine at a third of the usual speed needs two hours for all of them
        pytest.skip(OUT_OF_TIME)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    before = cpu_seconds()
    answer = yield
    item.user_properties.append(("cpu", cpu_seconds() - before))
    return answer


def pytest_sessionfinish(session):
    if hasattr(session.config, "workeroutput"):  # of a worker of pytest-xdist, read below
        session.config.workeroutput["cpu"] = cpu_seconds()


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    node.config.stash.setdefault(CPU, []).append(getattr(node, "workeroutput", {}).get("cpu", 0.0))


def pytest_terminal_summary(terminalreporter, config):
    cpu = sum(config.stash.get(CPU, [])) or cpu_seconds()
    terminalreporter.line(f"{cpu:.0f} s of CPU ({cpu / 60:.1f} min)")
    passed = terminalreporter.stats.get("passed", []) if config.option.markexpr == QUICK else []
    long = sorted(
        ((dict(report.user_properties).get("cpu", 0.0), report.nodeid) for report in passed),
        reverse=True,
    )
    if long and long[0][0] > LONG:
        terminalreporter.section(f"more than {LONG} s of CPU, neither costly nor slow")
        for cpu, name in long:
            if cpu > LONG:
                terminalreporter.line(f"{cpu:5.0f} s {name}")
    skipped = terminalreporter.stats.get("skipped", [])
    for head, reason in (("BROWSER", NO_BROWSER), ("SLOW", OUT_OF_TIME)):
        if count := sum(reason in str(report.longrepr) for report in skipped):
            terminalreporter.section(f"{head} TESTS DID NOT RUN", sep="!", yellow=True, bold=True)
            terminalreporter.line(f"{count} tests: {reason}", yellow=True)


@pytest.fixture(scope="session", autouse=True)
def _one_thread():
    """The workers fill the cores: threads of BLAS would wait for each other, at full load."""
    from underfoot.core.threads import threads_limited

    with threads_limited(1):
        yield


@pytest.fixture(autouse=True)
def _own_cache(tmp_path_factory, monkeypatch):
    """Keep every test out of the user's cache."""
    monkeypatch.setenv("UNDERFOOT_CACHE", str(tmp_path_factory.getbasetemp() / "cache"))


@pytest.fixture(scope="session")
def worn_shoe_case():
    """The untreaded work shoe in glycerol on a coarse grid."""
    from underfoot.case import Case

    return Case.from_mapping(
        {
            "name": "worn work shoe",
            "shoe": "work_shoe_untreaded",
            "floor": "vinyl_g4",
            "contaminant": "glycerol_90pct",
            "motion": {"from": "slip_tester_g4"},
            "sensor": {"from": "slip_tester_g4"},
            "numerics": {"grid_spacing": "2 mm", "quick_grid_spacing": "3 mm"},
        }
    )


@pytest.fixture(scope="session")
def worn_shoe_result(worn_shoe_case):
    """Its result."""
    from underfoot.compute.run import run

    return run(worn_shoe_case)
