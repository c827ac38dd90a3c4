"""What a page is given: the project, what computes, the words, and ways to talk to the browser."""

from __future__ import annotations

import math
import secrets
import time
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass, field
from inspect import isawaitable
from typing import Any
from urllib.parse import quote, urlencode

from nicegui import ui

from underfoot.core.errors import Cancelled, UnderfootError, error_text
from underfoot.core.unit_text import SYSTEMS

from .jobs import JobQueue, Lane, QueuedTask
from .labels import package_label
from .project import Project
from .projects import Servers
from .text import Text

Handler = Callable[[dict[str, Any]], Awaitable[Any]]
PICTURES = "/api/picture/"
"""Where the small pictures of soles are."""
LOOK = 1.0
"""s between two looks at what other pages and programs did."""
SETTLED = 5.0
"""s after a page was shown anew in which what a person does there may be of the page before."""
MOST_KEPT = 64
"""Pieces of data that the server keeps for its pages, the newest."""


@dataclass
class Exchange:
    """Data that pages fetch, and questions that their scripts ask, by a key in the address."""

    content: OrderedDict[str, tuple[str, str]] = field(default_factory=OrderedDict)
    handlers: dict[str, Handler] = field(default_factory=dict)

    def keep(self, text: str, media: str) -> str:
        """Keep a text for a page and return its address."""
        key = secrets.token_urlsafe(9)
        self.content[key] = (text, media)
        while len(self.content) > MOST_KEPT:
            self.content.popitem(last=False)
        return f"/api/content/{key}"


@dataclass(frozen=True, slots=True)
class Page:
    """One page of the app.

    Attributes:
        door: Name of the section that lists the page; "" for a page that no section lists.
        route: Its address.
        title: Key of its name in the text files.
        icon: Name of a Material icon.
        build: Puts the page's elements below the frame.
        example: Opens a worked example of its door; the first one of a door stands on its card.
    """

    door: str
    route: str
    title: str
    icon: str
    build: Callable[[Session], None]
    example: Callable[[Session], None] | None = None


@dataclass
class Session:
    """One open page.

    Attributes:
        project: The folder that is worked on.
        jobs: Long jobs (``jobs.submit``) and the warm process (``ask``).
        text: The words: ``text("design.title")``.
        query: What stands behind the ``?`` of the address.
        pages: All pages of the app.
        theme: "light", "dark", or "" for what the system has.
        units: Units that are shown, "si" or "us".
        elsewhere: Opens other projects; None where others of the network may ask.
        problems: Where errors are told; made by the frame.
    """

    project: Project
    jobs: JobQueue
    text: Text
    query: Mapping[str, str]
    exchange: Exchange
    pages: Sequence[Page]
    theme: str = ""
    units: str = SYSTEMS[0]
    elsewhere: Servers | None = None
    problems: ui.element | None = None

    @property
    def variant(self) -> str | None:
        """Return the variant of the address, else the one changed last, None without any."""
        names = self.project.variants()
        wanted = self.query.get("variant", "")
        return wanted if wanted in names else next(iter(names), None)

    def go(self, route: str, **query: str) -> None:
        """Open another page."""
        ui.navigate.to(address(route, **query))

    async def ask(self, function: str, *args: Any, lane: Lane | None = None, **options: Any) -> Any:
        """Return what a function ("module:name") answers, computed in the warm process or ``lane``.

        Its errors pass through; raised in a handler of a page they are told there.
        """
        return await (lane or self.jobs.live).ask(function, *args, **self._shown, **options)

    def submit(self, title: str, function: str, *args: Any, **options: Any) -> QueuedTask:
        """Queue a long job, whose texts are in units and language of the page; return its task."""
        return self.jobs.submit(title, function, *args, **self._shown, **options)

    @property
    def _shown(self) -> dict[str, str]:
        return {"units": self.units, "language": self.text.language}

    def follow(
        self,
        state: Callable[[], object],
        changed: Callable[[], object],
        busy: Callable[[], bool] = lambda: False,
    ) -> Callable[..., None]:
        """Call ``changed`` when ``state`` has another value: a page shows what another one did.

        It waits while the page is ``busy``. Returns a function that takes the present state as
        shown; given what this page does itself it does that, and what another page did just before
        is still to be shown.
        """
        shown, filled = [state()], [-math.inf]

        def take(action: Callable[[], object] | None = None) -> None:
            # what a person did on the page before it was shown anew is not on it
            settled = time.monotonic() - filled[0] > SETTLED
            current = action is None or (settled and state() == shown[0])
            if action is not None:
                action()
            if current:
                shown[0] = state()

        async def look() -> None:
            if state() != shown[0] and not busy():
                take()
                filled[0] = time.monotonic()
                followed = changed()
                if isawaitable(followed):
                    await followed

        ui.timer(LOOK, look)
        return take

    def keep(self, text: str, media: str = "text/html; charset=utf-8") -> str:
        """Keep a text for a script of the page and return the address to fetch it from."""
        return self.exchange.keep(text, media)

    def picture(self, name: str, kind: str = "variant") -> dict[str, str]:
        """Return source and words of the small picture of the sole of a variant or a "result".

        The source is another one when the case has changed.
        """
        case = self.project.path(name)
        if kind == "result":
            case = self.project.result_folder(name) / "case.toml"
        changed = case.stat().st_mtime_ns if case.exists() else 0
        source = f"{PICTURES}{kind}/{quote(name)}?{changed}"
        return {"src": source, "alt": self.text("sole.picture", name=name)}

    def answers(self, handler: Handler) -> str:
        """Return an address whose questions ``handler`` answers while the page is open.

        The script of the page posts JSON; the handler gets it as a dictionary and returns data for
        JSON. Its errors go back as ``{"problem": words}``.
        """
        key = secrets.token_urlsafe(9)
        handlers = self.exchange.handlers
        handlers[key] = handler
        ui.context.client.on_delete(lambda: handlers.pop(key, None))
        return f"/api/ask/{key}"

    def tell(self, error: BaseException) -> None:
        """Show an error on the page as it is written: where, what, what is allowed, the remedy."""
        if isinstance(error, Cancelled) or self.problems is None:
            return
        with self.problems, ui.element("div").classes("problem") as box:
            box.props('role="alert"')
            for kind, words in problem_parts(error):
                package_label(words).classes(f"problem-{kind}")
            close = ui.button(icon="close", on_click=box.delete).props("flat round dense")
            close.props(f'aria-label="{self.text("frame.close")}"')


def address(route: str, **query: str) -> str:
    """Return the address of a page."""
    return route + (f"?{urlencode(query)}" if query else "")


def problem_parts(error: BaseException) -> list[tuple[str, str]]:
    """Return what an error says as (kind, words): where, what, then what helps; of several, all."""
    if not isinstance(error, UnderfootError):
        return [("what", error_text(error))]
    problems: list[tuple[str, str]] = []
    for each in getattr(error, "errors", (error,)):
        problems += [("where", each.where)] if each.where else []
        problems += [*{**each.sentences, "what": each.what}.items()]
    return problems
