"""Measurements: the folders of trials of a project, and a place for a new one."""

from __future__ import annotations

import json
import secrets
import shutil
from functools import partial
from urllib.parse import urlencode

from nicegui import ui
from nicegui.events import GenericEventArguments

from underfoot.core import InputError
from underfoot.core.errors import UnderfootError

from ..components import title
from ..gate import UPLOADS
from ..session import Session
from ..trials_study import TrialsFolder, free_name, studies
from .trials_folder import STATIC, WORK, FolderView
from .trials_trial import TrialView

ROUTE = "/trials"
ARRIVING = "arriving "
"""Start of the name of a folder whose files are still on their way."""


class FolderDrop(ui.element, component=STATIC / "folder_drop.js"):
    """A place that takes a folder of files into the project; ``arrived`` says how many came."""

    def __init__(self, session: Session, folder: str) -> None:
        super().__init__()
        words = {key: session.text(f"trials.{key}") for key in ("drop", "folder", "files")}
        self._props.update(words=words, address=f"{UPLOADS}trials/{folder}")


def build(session: Session) -> None:
    """Show the folder of the address, or the folders there are and a place for a new one."""
    ui.add_head_html('<link rel="stylesheet" href="/static/trials.css">')
    page = _Trials(session)
    wanted, file = session.query.get("study", ""), session.query.get("trial", "")
    # What waits for an answer stands beside the place that it fills: there it would be removed.
    if wanted in studies(session.project):
        page.study = TrialsFolder(session.project, wanted)
        if file:
            ui.timer(0.01, partial(page.show, file), once=True)
        else:
            page.overview()
    else:
        page.choose()
        if "example" in session.query:
            ui.timer(0.01, page.make_example, once=True)


def example(session: Session) -> None:
    """Open a folder of made-up slips."""
    session.go(ROUTE, example="slips")


class _Trials:
    """The page: all folders, then one folder, then one trial of it."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.place = ui.element("div")

    def choose(self) -> None:
        """Show the folders there are and take a new one."""
        session, text = self.session, self.session.text
        arriving = ARRIVING + secrets.token_hex(4)

        def take_folder(event: GenericEventArguments) -> None:
            name = self._settle_folder(arriving)
            if name:
                self.open(name)
            for words in event.args["refused"][:5]:
                session.tell(InputError(words))

        self._turn()
        with self.place:
            title(text("trials.title"))
            ui.label(text("trials.lead")).classes("lead")
            FolderDrop(session, arriving).on("arrived", take_folder)
            made = ui.button(text("trials.try"), on_click=self.make_example)
            made.props("flat no-caps")
            if studies(session.project):
                title(text("trials.folders"), 2)
            with ui.element("ul").classes("folders"):
                for name in studies(session.project):
                    with ui.element("li"):
                        link = ui.button(name, icon="folder", on_click=partial(self.open, name))
                        link.props("flat no-caps align=left")

    async def make_example(self) -> None:
        """Make a folder of made-up slips and open it."""
        study = TrialsFolder(
            self.session.project,
            free_name(self.session.project, self.session.text("trials.example")),
        )
        await self.session.ask(f"{WORK}:example", str(study.folder))
        study.keep({"protocol": "report_g6"})
        self.open(study.name)

    def open(self, name: str) -> None:
        """Show a folder."""
        self.study = TrialsFolder(self.session.project, name)
        self.overview()

    def overview(self) -> None:
        """Show the folder that is open."""
        self._turn(study=self.study.name)
        with self.place:
            FolderView(self.session, self.study, self.choose, self.show)

    async def show(self, file: str) -> None:
        """Show a trial of the folder that is open; the folder where it can't be shown."""
        try:
            view = await self.session.ask(f"{WORK}:trial_view", self.study.asked, file)
        except UnderfootError as error:
            self.overview()
            self.session.tell(error)
            return
        self._turn(study=self.study.name, trial=file)
        with self.place:
            TrialView(self.session, self.study, view, self.overview, self.show)

    def _turn(self, **query: str) -> None:
        """Make room for what is shown next, and put it into the address."""
        self.place.clear()
        if self.session.problems is not None:
            self.session.problems.clear()
        address = ROUTE + (f"?{urlencode(query)}" if query else "")
        with self.place:  # what was pressed may be gone
            target = json.dumps(address)
            there = f"location.pathname + location.search === {target}"
            ui.run_javascript(f"{there} || history.pushState(null, '', {target})")

    def _settle_folder(self, arriving: str) -> str:
        """Give a folder that has arrived its name; a folder in it alone is the folder meant."""
        inside = self.session.project.inside
        folder = inside("trials", arriving)
        if not folder.is_dir():
            return ""
        files = list(folder.iterdir())
        one = files[0] if len(files) == 1 and files[0].is_dir() else folder
        wanted = self.session.text("trials.unnamed") if one is folder else one.name
        name = free_name(self.session.project, wanted)
        one.rename(inside("trials", name))
        shutil.rmtree(folder, ignore_errors=True)
        return name
