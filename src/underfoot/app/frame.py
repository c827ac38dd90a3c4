"""What every page has: name, doors, jobs, language, light or dark, and where errors are told."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from fastapi import Request
from nicegui import ui

from underfoot.core.unit_text import SYSTEMS

from .jobs import RUNNING, JobQueue, QueuedTask
from .labels import package_label
from .project import Project
from .projects import Servers
from .session import Exchange, Page, Session
from .text import LANGUAGES, Text, as_json, chosen_language

HEAD = """
<link rel="stylesheet" href="/style/palette.css"><link rel="stylesheet" href="/style/viewer.css">
<link rel="stylesheet" href="/static/app.css">
<script src="/static/theme.js"></script>
<script src="/static/language.js"></script>
<script defer src="/viewer/sentences.js"></script>
<script defer src="/viewer/viewer_data.js"></script>
<script defer src="/viewer/viewer_draw.js"></script>
<script defer src="/viewer/viewer_page.js"></script>
<script defer src="/static/app.js"></script>
"""
WORDS = "/words/"
"""Where the scripts with the words of each language are."""
LOOK = 0.5
"""s between two looks at the jobs."""
ui.linear_progress.default_props("instant-feedback")  # gliding, a bar is drawn 60 times a second
MOST_SHOWN = 12
"""Jobs that the menu shows, those that compute first, then those that wait."""


def open_session(
    project: Project,
    jobs: JobQueue,
    exchange: Exchange,
    pages: Sequence[Page],
    elsewhere: Servers | None,
    request: Request,
) -> Session:
    """Return the session of a page that is opened."""
    accepted = request.headers.get("accept-language", "")
    language = chosen_language(request.cookies.get("language"), accepted)
    theme = request.cookies.get("theme", "")
    query = dict(request.query_params)
    chosen = request.cookies.get("units", "")
    units = chosen if chosen in SYSTEMS else SYSTEMS[0]
    text = Text(language)
    return Session(project, jobs, text, query, exchange, pages, theme, units, elsewhere)


def build_framed_page(session: Session, page: Page) -> None:
    """Build a page in its frame."""
    text = session.text
    ui.page_title(f"{text(page.title)} · Underfoot")
    names = as_json(session.project.variants())
    words = f'<script src="{WORDS}{text.script_name}"></script>'
    ui.add_head_html(f"{words}<script>const namesOfUser = {names};</script>{HEAD}")
    ui.on_exception(session.tell)
    ui.colors(primary="#0b6fa4")
    with ui.header(fixed=False).classes("app-bar"):
        home = ui.link("Underfoot", "/").classes("brand")
        home.props(f'aria-label="{text("start.title")}"')
        with ui.element("nav").props(f'aria-label="{text("frame.pages")}"'):
            for each in session.pages:
                if each.door:
                    link = ui.link(text(each.title), each.route).classes("tab")
                    link.props('aria-current="page"' if each is page else "")
        ui.space()
        _jobs_button(session)
        _choice_button(session, "units", SYSTEMS, session.units, text.unit_systems())
        _choice_button(session, "language", LANGUAGES, text.language, LANGUAGES)
        _theme_button(session)
    with ui.element("div").classes("page"):  # the framework's page is the main element
        session.problems = ui.element("div").classes("problems")
        session.problems.props('aria-live="assertive"')
        try:
            page.build(session)
        except Exception as error:
            session.tell(error)


def _theme_button(session: Session) -> None:
    chosen = {"light": False, "dark": True}
    dark = ui.dark_mode(chosen.get(session.theme))

    async def switch() -> None:
        dark.value = await ui.run_javascript("switchTheme()")

    button = ui.button(icon="contrast", on_click=switch)
    button.props(f'flat round dense aria-label="{session.text("frame.theme")}"')


def _choice_button(
    session: Session, cookie: str, codes: Iterable[str], present: str, names: Mapping[str, str]
) -> None:
    """Show a menu whose choice is kept in a cookie; the page is then built anew."""
    button = ui.button(names[present]).props("flat dense no-caps")
    button.props(f'aria-label="{session.text(f"frame.{cookie}")}: {names[present]}"')
    with button, ui.menu():
        for code in codes:
            ui.menu_item(names[code]).on(
                "click",
                js_handler=f'() => {{ document.cookie = "{cookie}={code}; path=/; '
                'max-age=31536000; SameSite=Strict"; location.reload() }',
            )


def _jobs_button(session: Session) -> None:
    """Show how many jobs are open; its menu shows each with its progress and how to stop it."""
    text, jobs = session.text, session.jobs
    button = ui.button(text("jobs.none"), icon="hourglass_empty").props("flat dense no-caps")
    button.props(f'aria-label="{button.text}"').classes("idle")
    with button, ui.menu().classes("jobs").props("auto-close=false"):
        listed = ui.element("div").classes("job-list")
    seen: list[object] = [None]  # also no job at all is to be shown

    def look() -> None:
        now = [(t.number, t.state, t.stage, round(t.fraction, 2)) for t in jobs.tasks.values()]
        if now == seen:
            return
        seen[:] = now
        count = sum(task.open for task in jobs.tasks.values())
        button.text = text("jobs.open", count=count) if count else text("jobs.none")
        button.props(f'aria-label="{button.text}"').classes(
            **{"remove" if count else "add": "idle"}
        )
        listed.clear()
        with listed:
            tasks = sorted(jobs.tasks.values(), key=_place)
            for task in tasks[:MOST_SHOWN]:
                _job_row(session, task)
            if count > 1:
                stop = ui.button(text("jobs.stop_all"), on_click=lambda: jobs.cancel_all())
                stop.props("flat dense no-caps")
            if len(tasks) > MOST_SHOWN:
                ui.label(text("jobs.more", count=len(tasks) - MOST_SHOWN)).classes("soft")
            if not jobs.tasks:
                ui.label(text("jobs.empty")).classes("soft")

    look()
    ui.timer(LOOK, look)


def _place(task: QueuedTask) -> tuple[bool, bool, int]:
    """Return where a job stands: what computes, what waits in its order, then the newest."""
    return task.state != RUNNING, not task.open, task.number if task.open else -task.number


def _job_row(session: Session, task: QueuedTask) -> None:
    text = session.text
    with ui.element("div").classes("job"):
        ui.label(f"{task.title}: {task.about}" if task.about else task.title)
        state = text(f"jobs.{task.state}")
        if task.state == "running":
            state = f"{task.stage or state}, {100 * task.fraction:.0f} %"
        package_label(task.problem or state).classes("soft")
        if task.open:
            stop = ui.button(text("jobs.stop"), on_click=lambda: session.jobs.cancel(task))
            stop.props("flat dense no-caps")
        elif task.state != "done":
            again = ui.button(text("jobs.again"), on_click=lambda: session.jobs.again(task))
            again.props("flat dense no-caps")
