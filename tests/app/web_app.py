"""The app as a process on a free port, and its pages in Chromium by Playwright."""

import contextlib
import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import psutil
from chromium import PATIENCE, browser

COMMAND = "from underfoot.cli import main; main()"
REPOSITORY = Path(__file__).resolve().parents[2]
PATHS = [str(REPOSITORY / "src"), str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")]


class Served:
    """A running app: its address with and without the key, its process."""

    def __init__(self, folder, home, *options):
        self.began = time.monotonic()
        environment = {
            **os.environ, "PYTHONPATH": os.pathsep.join(PATHS), "PYTHONUNBUFFERED": "1",
            "XDG_STATE_HOME": str(home), "XDG_CACHE_HOME": str(home),
        }  # fmt: skip
        self.folder = Path(folder)
        self.process = subprocess.Popen(
            [sys.executable, "-c", COMMAND, "app", str(folder), "--no-browser", *options],
            env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        )  # fmt: skip
        self.said = ""
        while "token=" not in self.said:
            line = self.process.stdout.readline()
            assert line, self.said
            self.said += line
        self.link = re.search(r"http\S+", self.said)[0]
        self.base = self.link.partition("?")[0]

    def kill(self):
        """End the server as a power cut does."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        self.process.stdout.close()

    def memory(self):
        """Return the resident memory of the server in MB."""
        text = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", text)[1]) / 1e3

    def shares(self):
        """Return the memory (MB) of the server and each process it started, largest first.

        Pages that several hold are shared out among them, so that the sum counts each once.
        """
        server = psutil.Process(self.process.pid)
        shares = []
        for each in (server, *server.children(recursive=True)):
            with contextlib.suppress(psutil.NoSuchProcess):  # it has ended meanwhile
                shares.append(each.memory_full_info().pss / 1e6)
        return sorted(shares, reverse=True)

    @contextlib.contextmanager
    def memory_watched(self, every=0.2):
        """Yield a list that holds after the block the ``shares`` of when their sum was largest."""
        most, ended = [], threading.Event()

        def watch():
            while not ended.wait(every):
                most[:] = max(most, self.shares(), key=sum)

        watcher = threading.Thread(target=watch)
        watcher.start()
        try:
            yield most
        finally:
            ended.set()
            watcher.join()

    def libraries(self):
        """Return the text that names every library in the server's memory."""
        return Path(f"/proc/{self.process.pid}/maps").read_text()


@contextlib.contextmanager
def served(folder, home, *options):
    """Yield the app on a free port."""
    app = Served(folder, home, "--port", "0", *options)
    try:
        yield app
    finally:
        app.process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            app.process.wait(10)
        app.kill()


@contextlib.contextmanager
def page_of(link, *, width=1366, height=768, dark=False, touch=False, webgl=True):
    """Yield a page in a fresh browser; ``page.complaints`` are errors and outside requests."""
    from playwright.sync_api import sync_playwright

    flags = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    if not webgl:
        flags = ["--no-sandbox", "--disable-gpu", "--disable-3d-apis"]
    own = re.compile(r"http://([\w-]+\.localhost|127\.0\.0\.1):|data:|blob:|about:|file:")
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser(), args=flags)
        context = chromium.new_context(
            viewport={"width": width, "height": height}, has_touch=touch, is_mobile=touch,
            color_scheme="dark" if dark else "light",
        )  # fmt: skip
        page = context.new_page()
        page.complaints = []

        def note(message):
            if message.type in ("error", "warning") and "GPU stall" not in message.text:
                page.complaints.append(message.text)

        def asked(request):
            if not own.match(request.url):
                page.complaints.append(request.url)

        page.on("console", note)
        page.on("pageerror", lambda error: page.complaints.append(str(error)))
        page.on("request", asked)
        page.set_default_timeout(1000 * PATIENCE)
        page.goto(link)
        try:
            yield page
        finally:
            chromium.close()


class Cost:
    """Wall time of a block and processor time of the app and the browser in it, s.

    On a machine where others compute beside, wall time says little: ``least`` is the smaller.
    """

    def __enter__(self):
        self._began, self._cpu = time.monotonic(), self._spent()
        return self

    def __exit__(self, *_):
        self.wall, self.cpu = time.monotonic() - self._began, self._spent() - self._cpu
        self.least = min(self.wall, self.cpu)

    def __str__(self):
        return f"{self.wall:.2f} s wall, {self.cpu:.2f} s of CPU"

    def _spent(self):
        total = 0.0
        for process in psutil.Process().children(recursive=True):
            with contextlib.suppress(psutil.NoSuchProcess):
                total += sum(process.cpu_times()[:4])  # those of its ended children too
        return total


SOLE = ".viewer[data-ready=yes]"


def drawn(page):
    """Wait until a sole is drawn."""
    page.wait_for_selector(SOLE)
    page.evaluate("new Promise((d) => requestAnimationFrame(() => requestAnimationFrame(d)))")


SHOWN = """() => {
  const moving = document.getAnimations().some((each) => each.playState === "running"
    && Number.isFinite(each.effect.getComputedTiming().endTime));
  if (moving || document.querySelector(".viewer:not([data-ready])")) return "";
  const page = document.querySelector(".nicegui-content")?.cloneNode(true);
  page?.querySelectorAll(".task, [role=status]").forEach((each) => each.remove());
  if (page) return window.did_handshake ? page.innerHTML : "";
  return document.readyState === "complete" ? "a report" : "";
}"""
"""What a page shows, without what tells progress; "" while it is not there yet."""
QUIET = 3
"""Rounds in which nothing changes after which a page is taken as settled."""


def settled(page):
    """Wait until a page shows all that it asked for, however long that takes.

    In each round the app answers a question that waits for those which were asked before.
    """
    frame = "new Promise((d) => requestAnimationFrame(() => requestAnimationFrame(d)))"
    rounds, before = 0, ""
    while rounds < QUIET:
        if page.url.startswith("http"):
            page.evaluate("fetch('/api/picture/variant/settled').then((answer) => answer.text())")
        page.evaluate(frame)
        now = page.evaluate(SHOWN)
        rounds = rounds + 1 if now and now == before else 0
        before = now


def unfold(page):
    """Open all that is folded on a page, once there is something."""
    page.wait_for_selector("details.section", state="attached")
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true })")


def begin(page, base, *, coarse=None):
    """Open the design page with the usual work shoe, drawn; ``coarse``: see ``coarsened``."""
    page.goto(base + "design")
    page.get_by_role("button", name="Begin with a work shoe").click()
    page.wait_for_url("**/design?variant=*")
    drawn(page)
    if coarse is not None:
        coarsened(page, coarse)


def helped(page):
    """Wait until the answer says what would help: of every change, with gain or without."""
    page.get_by_role("heading", name="What would help", exact=True).wait_for()


def coarsened(page, app, **changes):
    """Put every variant of an app on a grid that runs in a second, and draw the page anew.

    ``changes`` are made beside.
    """
    from underfoot.app.project import Project

    project = Project(app.folder)
    for name in project.variants():
        project.change(name, COARSE | changes)
    page.reload()
    drawn(page)


def project_of(folder, *names):
    """Return a new project whose variants are each computed in a second."""
    from underfoot.app.project import Project
    from underfoot.app.variant_bar import USUAL
    from underfoot.case.template import template
    from underfoot.core.catalogue import Catalogue

    made = Project(folder)
    for name in names:
        made.add(name, template(**USUAL, catalogue=Catalogue.load(), name=name))
        made.change(name, COARSE)
    return made


COARSE = {
    "numerics.grid_spacing": "1.2 mm",
    "numerics.quick_grid_spacing": "1.2 mm",
    "numerics.tread_positions": 1,
}
"""Makes a run a matter of a second."""


def held(folder, free):
    """Return the changes that hold a case up as long as a folder is, but for ``free`` cases."""
    folder.mkdir()
    return {
        "friction.model": "held_law:Held",
        "friction.hold": str(folder),
        "friction.free": str(free),
    }
