"""Pages of the app in the process of a test: a session, what stands on a page, what is pressed."""

import asyncio
import json
from importlib import import_module
from types import SimpleNamespace
from typing import Any, cast

from nicegui import ui
from nicegui.events import handle_event
from nicegui.testing.user_simulation import user_simulation

from underfoot.app.jobs import JobQueue
from underfoot.app.pages import PAGES
from underfoot.app.project import Project
from underfoot.app.projects import Servers
from underfoot.app.session import Exchange, Session
from underfoot.app.text import Text
from underfoot.app.variant_bar import new_variant
from underfoot.core.remark import MARK

RUN = "underfoot.app.work:computed"


class Here:
    """Answers in this process what a page asks."""

    async def ask(self, function, *args, units, language, **options):
        module, _, name = function.partition(":")
        return getattr(import_module(module), name)(*args, progress=lambda *_: None, **options)

    def stop(self):
        """Nothing that is asked here can be stopped."""


def session_of(folder, language="en", **query):
    jobs, text = JobQueue(folder), Text(language)
    jobs.live = jobs.reading = cast(Any, Here())
    project, elsewhere = Project(folder), Servers()
    return Session(project, jobs, text, query, Exchange(), PAGES, elsewhere=elsewhere)


def session_of_a_variant(folder):
    """Return a session of a project with a half worn shoe in detergent, "a"."""
    made = session_of(folder)
    new_variant(made, "a", shoe="work_shoe_half_tread", contaminant="detergent")
    return made


def shown(build, look):
    """Return what ``look`` finds on a page that ``build`` fills."""

    async def run():
        async with user_simulation(root=build) as user:
            await user.open("/")
            await asyncio.sleep(0.05)  # timers that begin at once
            found = look(cast(Any, user.client).elements.values())
            return await found if asyncio.iscoroutine(found) else found

    return asyncio.run(run())


async def until(holds):
    """Wait until something holds, for 20 s at most."""
    for _ in range(40):
        if holds():
            return
        await asyncio.sleep(0.05)


def words_of(elements):
    return [each.text for each in elements if isinstance(each, ui.label | ui.button)]


def keydown(element, key):
    """Return what a key does in an element."""
    (pressed,) = (
        each for each in element._event_listeners.values() if each.type == f"keydown.{key}"
    )
    return cast(Any, pressed.handler)


def computed(session, name):
    """Write what a page reads of a result in short."""
    result = session.project.result_folder(name)
    result.mkdir(parents=True)
    stored = {"status": {"value": "converged"}, "cof": {"value": 0.3},
              "provenance": {"case_hash": "a", "created": "now"}}  # fmt: skip
    (result / "result.json").write_text(json.dumps(stored), encoding="utf-8")


def press(element, kind="click", args=None):
    """Do what a person does with an element."""
    for each in list(element._event_listeners.values()):
        if each.type == kind:
            given = SimpleNamespace(sender=element, client=element.client, args=args or {})
            handle_event(each.handler, cast(Any, given))


def button(elements, text):
    """Return the button of a text."""
    (found,) = (each for each in elements if isinstance(each, ui.button) and each.text == text)
    return found


def answering(monkeypatch, session, **answers):
    """Let the session answer by the name of what it is asked; return what it was asked.

    A list of (name, arguments, options); an answer that is an error is raised, one that can be
    called is called with the arguments.
    """
    asked = []

    async def ask(function, *args, **options):
        options.pop("heard", None)
        name = function.partition(":")[2]
        asked.append((name, args, options))
        made = answers[name]
        if isinstance(made, Exception):
            raise made
        return made(*args) if callable(made) else made

    monkeypatch.setattr(session, "ask", ask)
    return asked


MOVING = (
    r"/api/(?:content|ask)/[\w-]+|\bc\d+\b|slider-\d+|\?\d{16,}|arriving \w+"
    r"|/words/\w+-\w+\.js"
)
"""What of a page is another one each time it is opened."""
USUAL = {"value", "options", "innerHTML", "for"}
MUTE = {"loopback", "id", "key", MARK}


def element_lines(element, depth=0):
    """Yield what stands in an element of a page, a line an element."""
    if isinstance(element, ui.timer):
        yield f"{'  ' * depth}timer {element.interval:g} {element.active}"
        return
    props = {k: v for k, v in element._props.items() if k not in MUTE}
    listed = getattr(element, "options", None)
    told = [
        type(element).__name__ if element.tag.startswith("nicegui") else element.tag,
        *(f".{name}" for name in sorted(element._classes)),
        *([f"style={dict(element._style)}"] if element._style else []),
        *(f"{k}={_prop(v)}" for k, v in sorted(props.items()) if k not in USUAL and v != ""),
        *([f"value={_prop(element.value)}"] if hasattr(element, "value") else []),
        *([f"options={_options(listed)}"] if listed is not None else []),
        *(f"on-{kind}" for kind in sorted({one.type for one in element._event_listeners.values()})
          if "update:" not in kind),
        *([] if element.visible else ["HIDDEN"]),
        *([] if getattr(element, "enabled", True) else ["DISABLED"]),
    ]  # fmt: skip
    words = getattr(element, "text", "") or getattr(element, "content", "")
    yield f"{'  ' * depth}{' '.join(told)}{f' | {words}' if words else ''}"
    for slot in element.slots.values():
        if slot.template:
            yield f"{'  ' * depth}  slot {slot.name}: {slot.template}"
        for each in slot.children:
            yield from element_lines(each, depth + 1)


def _prop(value):
    if isinstance(value, float):
        return f"{value:g}"
    return (
        json.dumps(value, ensure_ascii=False, default=str) if not isinstance(value, str) else value
    )


def _options(listed):
    shown = list(listed.items()) if isinstance(listed, dict) else list(listed)
    return _prop(shown if len(shown) < 14 else [len(shown), *shown[:3], *shown[-2:]])


def pages_shown(monkeypatch, builds, act=None):
    """Return what stands on pages, by name, and in ``sent`` what they told the browser.

    ``builds``: what fills each of them, one below the other; ``act`` is awaited with the element of
    each by name before they are read.
    """
    sent, places, lines = [], {}, {}

    def telling(name):
        def tell(*words, **_):
            sent.append(f"{name}: {' '.join(map(str, words))}")

        return tell

    async def answered(script, **_):
        sent.append(f"script: {script}")

    def run(script, **_):
        sent.append(f"script: {script}")
        return answered("") if script == "switchTheme()" else None

    def listen():
        monkeypatch.setattr(ui, "run_javascript", run)
        monkeypatch.setattr(ui, "notify", telling("notify"))
        monkeypatch.setattr(ui.navigate, "to", telling("go"))
        monkeypatch.setattr(ui.download, "file", telling("download"))

    def build():
        listen()
        for name, fill in builds.items():
            if name == "whole":  # a page with its frame
                places[name] = ui.context.client.layout
                fill()
                continue
            places[name] = ui.element("div")
            with places[name]:
                fill()

    async def look(elements):
        listen()  # the simulation puts its own in place as it opens a page

        async def settled():  # what a page asks as soon as it is open, and lines of tasks
            before = None
            for _ in range(40):
                now = {name: "\n".join(element_lines(place)) for name, place in places.items()}
                begun = [e for e in elements if isinstance(e, ui.timer) and e.interval < 0.05]
                if now == before and not begun:
                    break
                before = now
                await asyncio.sleep(0.15)
            dialogs = (e for e in elements if isinstance(e, ui.dialog))
            opened = ["\n".join(element_lines(each)) for each in dialogs]
            lines.update(now | ({"dialogs": "\n".join(opened)} if opened else {}))

        await settled()
        if act is not None:
            await act(places)
            await settled()

    shown(build, look)
    return {**lines, "sent": [one.replace("\n", " ") for one in sent]}
