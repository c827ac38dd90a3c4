"""The server of the app: one project, one person, this machine."""

from __future__ import annotations

import asyncio
import secrets
import socket
import sys
import webbrowser
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI, Request, Response
from nicegui import app as pages_app
from nicegui import ui
from platformdirs import user_state_path

from underfoot.core import InputError
from underfoot.core.files import whole_file
from underfoot.core.remark import Message

from .frame import WORDS, build_framed_page, open_session
from .gate import UPLOADS, Gate, own_name
from .inputs import read_in_unit
from .jobs import JobQueue
from .pages import PAGES
from .project import Project
from .projects import Servers, remember
from .session import PICTURES, Exchange, Page, problem_parts
from .text import LANGUAGES, Text
from .uploads import MOST_BYTES, receive_file

PORT = 8642
"""The port that is tried where none is named."""
LOOPBACK = ("127.0.0.1", "localhost", "::1")
PRELOAD = ("underfoot.app.work",)
"""What the computing processes import before the first question."""


def serve(
    folder: Path | str,
    host: str = "127.0.0.1",
    port: int = PORT,
    open_browser: bool = True,
    say: Callable[[str], object] = print,
) -> None:
    """Serve the app on a project's folder until it is stopped.

    Args:
        folder: The project; it is made if it is missing.
        host: Where to listen. Anything but this machine itself is told with a warning.
        port: 0 takes any that is free.
        open_browser: Open the first page in the person's browser.
        say: Told the address.

    Raises:
        InputError: A folder that can't be used; a port that is taken.
    """
    project = Project(folder)
    listening = _socket(host, port)
    port = listening.getsockname()[1]
    token = _token()
    jobs = JobQueue(project.folder, PRELOAD)
    name = own_name(token)
    elsewhere = Servers() if host in LOOPBACK else None
    server = _server(_application(project, jobs, elsewhere), token, port, name)
    remember(project.folder)
    shown = host if host not in ("0.0.0.0", "::") else _own_address()
    if host in LOOPBACK[:2] and _is_this_machine(name):
        shown = name
    place = f"[{shown}]" if ":" in shown else shown
    link = f"http://{place}:{port}/?token={token}"
    say(f"Underfoot shows the project {project.folder} at\n\n    {link}\n")
    if host not in LOOPBACK:
        say(
            "Warning: other machines of this network can reach the app. The key in the address is "
            "not encrypted on the way: use --host only in a network that you trust."
        )
    say("Stop it with Ctrl-C; what was computed stays in the folder.")
    if open_browser:
        webbrowser.open(link)
    try:
        server.run(sockets=[listening])
    finally:
        jobs.close()
        if elsewhere is not None:
            elsewhere.close()


def _application(project: Project, jobs: JobQueue, elsewhere: Servers | None) -> FastAPI:
    application = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
    exchange = Exchange()
    running: list[asyncio.Task[None]] = []

    async def start() -> None:
        running.append(asyncio.create_task(jobs.run()))
        jobs.live.start()

    pages_app.on_startup(start)
    pages_app.add_static_files("/static", str(files("underfoot.app") / "static"))
    for route, package in (("/style", "underfoot.core"), ("/viewer", "underfoot.report")):
        pages_app.add_static_files(route, str(files(package) / "templates"))
    for page in PAGES:
        _route(page, project, jobs, exchange, elsewhere)

    @application.get(WORDS + "{name}")
    async def language_script(name: str) -> Response:
        language = name.partition("-")[0]
        if language not in LANGUAGES or name != (text := Text(language)).script_name:
            return Response(status_code=404)
        headers = {"cache-control": "private, max-age=31536000, immutable"}
        return Response(text.script(), media_type="text/javascript", headers=headers)

    @application.get("/api/content/{key}")
    async def content(key: str) -> Response:
        if key not in exchange.content:
            return Response(status_code=410)
        text, media = exchange.content[key]
        return Response(text, media_type=media, headers={"cache-control": "no-store"})

    @application.get(PICTURES + "{kind}/{name}")
    async def picture(kind: str, name: str) -> Response:
        try:
            variant, folder = project.path(name), project.result_folder(name)
        except InputError:
            return Response(status_code=404)
        case = variant if kind == "variant" else folder / "case.toml"
        svg = await jobs.live.ask("underfoot.app.work_table:picture", str(case))
        headers = {"cache-control": "no-cache"}
        return Response(svg, media_type="image/svg+xml", headers=headers)

    @application.post("/api/ask/{key}")
    async def ask(key: str, request: Request) -> Any:
        handler = exchange.handlers.get(key)
        if handler is None:
            return Response(status_code=410)
        try:
            return await handler(await request.json())
        except Exception as error:
            words = " ".join(words for _, words in problem_parts(error))
            return {"problem": words, "again": isinstance(error, OSError)}

    @application.post("/api/quantity")
    async def quantity(request: Request) -> Any:
        """Read what was typed into a field of a script: ``text``, ``unit``, ``comma``."""
        asked = await request.json()
        try:
            text, unit = str(asked["text"]), str(asked["unit"])
            return {"value": read_in_unit(text, unit, comma=bool(asked["comma"]))}
        except InputError as error:
            return {"problem": str(error)}

    @application.post(UPLOADS + "{place:path}")
    async def upload(place: str, request: Request) -> Any:
        try:
            path = await receive_file(project, place, request.stream())
        except Exception as error:
            return {"problem": " ".join(words for _, words in problem_parts(error))}
        return {"path": path.relative_to(project.folder).as_posix()}

    # pages say themselves what they wait for; a bar over all requests has no name to be read aloud
    pages_app.config.quasar_config["loadingBar"]["skipHijack"] = True
    ui.run_with(
        application,
        title="Underfoot",
        dark=None,
        tailwind=False,
        reconnect_timeout=30.0,
        binding_refresh_interval=None,
        show_welcome_message=False,
    )
    return application


def _route(
    page: Page, project: Project, jobs: JobQueue, exchange: Exchange, elsewhere: Servers | None
) -> None:
    @ui.page(page.route)
    def show(request: Request) -> None:
        session = open_session(project, jobs, exchange, PAGES, elsewhere, request)
        build_framed_page(session, page)


def _server(application: FastAPI, token: str, port: int, name: str) -> uvicorn.Server:
    gate = Gate(application, token, port, MOST_BYTES, name)
    config = uvicorn.Config(gate, log_level="warning", timeout_graceful_shutdown=2, lifespan="on")
    return uvicorn.Server(config)


def _socket(host: str, port: int) -> socket.socket:
    """Return a listening socket; a second server must not share the port of the first."""
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    if sys.platform != "win32":
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((host, port))
        listening.listen(128)
    except OSError as error:
        listening.close()
        raise InputError(
            Message(
                "port {port} of {host} can't be used: {strerror}",
                port=port,
                host=host,
                strerror=(error.strerror or str(error)).lower(),
            ),
            where="--port",
            remedy="Perhaps the app runs already: look for its page in your browser. Or take "
            "another port: --port 0 takes any that is free",
        ) from error
    return listening


def _token() -> str:
    """Return the secret of this person on this machine; pages stay open over a restart."""
    path = user_state_path("underfoot") / "app-token"
    try:
        token = path.read_text(encoding="ascii").strip()
        if len(token) >= 32:
            return token
    except OSError:
        pass
    token = secrets.token_urlsafe(32)
    try:
        with whole_file(path) as part:
            part.touch(mode=0o600)
            part.write_text(token, encoding="ascii")
    except OSError:
        pass  # a home that can't be written: the secret lasts as long as the server
    return token


def _is_this_machine(name: str) -> bool:
    """Return whether browsers take a name below localhost for this machine; Safari asks macOS."""
    if sys.platform != "darwin":
        return True
    try:
        return bool(socket.getaddrinfo(name, None))
    except OSError:
        return False


def _own_address() -> str:
    """Return the address by which others of the network reach this machine, as far as it knows."""
    with socket.socket(type=socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # of the documentation: nothing is sent
            return probe.getsockname()[0]
        except OSError:
            return socket.gethostbyname(socket.gethostname())
