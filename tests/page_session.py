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
