"""A page in a headless browser, driven over the browser's own pipe: nothing but Python needed."""

import base64
import contextlib
import fcntl
import io
import json
import os
import shutil
import subprocess
import tempfile
import time

import numpy as np

from machine import CHROMIUM

PATIENCE = 300
"""s after which a test gives a page up: many, for others may compute on the machine."""


def browser():
    """Return the path of a Chromium; tests with the mark "browser" run only where there is one."""
    return next(path for path in map(shutil.which, CHROMIUM) if path)


@contextlib.contextmanager
def opened(page, *, width=1280, height=800, touch=False, dark=False):
    """Yield a file opened in a window of the given size."""
    to_read, to_write = os.pipe(), os.pipe()
    profile = tempfile.mkdtemp()
    # the browser reads commands from descriptor 3 and answers on 4
    keep = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (to_read[0], to_write[1])]

    def place():
        os.dup2(keep[0], 3)
        os.dup2(keep[1], 4)

    process = subprocess.Popen(
        [
            browser(), "--headless=new", "--no-sandbox", "--remote-debugging-pipe",
            "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run",
            f"--user-data-dir={profile}", "about:blank",
        ],
        pass_fds=(3, 4), preexec_fn=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    for end in (*keep, to_read[0], to_write[1]):
        os.close(end)
    session = Session(to_read[1], to_write[0])
    try:
        session.start(width, height, touch, dark)
        session.go(page)
        yield session
    finally:
        process.kill()
        process.wait()
        os.close(to_read[1])
        os.close(to_write[0])
        shutil.rmtree(profile, ignore_errors=True)


class Session:
    """One tab: evaluate, press, drag, look."""

    def __init__(self, write, read):
        self.write, self.read, self.buffer, self.number = write, read, b"", 0
        self.session, self.complaints = None, []

    def start(self, width, height, touch, dark):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self.session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=1, mobile=touch,
        )  # fmt: skip
        self.call("Emulation.setTouchEmulationEnabled", enabled=touch)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])

    def go(self, page, query=""):
        self.call("Page.navigate", url=page.resolve().as_uri() + query)
        ready = "[...document.querySelectorAll('.viewer')].every((v) => v.dataset.ready)"
        limit = time.monotonic() + PATIENCE
        while not self.value(f"document.readyState === 'complete' && {ready}"):
            assert time.monotonic() < limit, f"the page does not get ready: {self.complaints}"
            time.sleep(0.1)
        self.settle()

    def call(self, method, **params):
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        data = json.dumps(message).encode() + b"\0"
        while data:
            data = data[os.write(self.write, data) :]
        while True:
            answer = self._next()
            if answer.get("id") == self.number:
                assert "error" not in answer, answer
                return answer["result"]
            self._note(answer)

    def _next(self):
        while b"\0" not in self.buffer:
            part = os.read(self.read, 1 << 20)
            assert part, "the browser ended"
            self.buffer += part
        one, _, self.buffer = self.buffer.partition(b"\0")
        return json.loads(one)

    def _note(self, event):
        kind, content = event.get("method"), event.get("params", {})
        if kind == "Runtime.exceptionThrown":
            self.complaints.append(content["exceptionDetails"])
        elif kind == "Runtime.consoleAPICalled" and content["type"] in ("error", "warning"):
            self.complaints.append(content["args"])
        elif kind == "Log.entryAdded" and content["entry"]["level"] in ("error", "warning"):
            # reading the picture back, as screenshots do, is slow and said to be
            if "GPU stall" not in content["entry"]["text"]:
                self.complaints.append(content["entry"])
        elif kind == "Network.requestWillBeSent":
            address = content["request"]["url"]
            if not address.startswith(("file:", "data:", "blob:", "about:")):
                self.complaints.append(address)

    def value(self, expression):
        """Return what a JavaScript expression gives."""
        found = self.call(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def settle(self):
        """Wait until what was asked for is drawn."""
        frame = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
        self.value(f"{frame}.then(() => {frame}).then(() => true)")

    def picture(self, selector=None):
        """Return what the window shows, or one element of it, (height, width, 3), and the PNG."""
        from matplotlib.image import imread

        png = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        seen = np.asarray(imread(io.BytesIO(png)))[..., :3]
        if selector:
            left, top, right, bottom = self.value(
                f"(() => {{ const b = document.querySelector({selector!r}).getBoundingClientRect();"
                " return [b.left, b.top, b.right, b.bottom].map((v) => Math.max(0, Math.round(v)))"
                "})()"
            )
            seen = seen[top:bottom, left:right]
        return seen, png

    def whole_page(self):
        """Return the PNG of the page from top to bottom."""
        shot = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=True)
        return base64.b64decode(shot["data"])

    def key(self, key, modifiers=0):
        """Press a key; modifiers: 1 Alt, 2 Ctrl, 8 Shift."""
        for kind in ("rawKeyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=modifiers)
        self.settle()

    def drag(self, start, end, modifiers=0):
        """Drag with the left button between two points of the window; the same point: a click."""
        at = {"button": "left", "buttons": 1, "clickCount": 1, "modifiers": modifiers}
        places = [start, *([end] if end != start else [])]
        self.call("Input.dispatchMouseEvent", type="mousePressed", x=start[0], y=start[1], **at)
        for x, y in places[1:]:
            self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, **at)
        x, y = places[-1]
        self.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, **at)
        self.settle()

    def touch(self, *moments):
        """Put fingers down, move and lift: each moment is a list of points."""
        kinds = ["touchStart", *["touchMove"] * (len(moments) - 1)]
        for kind, points in zip(kinds, moments, strict=True):
            at = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(points)]
            self.call("Input.dispatchTouchEvent", type=kind, touchPoints=at)
        self.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
        self.settle()
