"""The pages of the app, one module each, in one table.

A page is a function ``build(session: Session) -> None`` in a module of its own. The frame (title,
doors, jobs, errors) is there already; ``build`` puts NiceGUI elements below it. To add a page,
write the module and its line in ``PAGES``; nothing else names it.

    def build(session: Session) -> None:
        ui.label(session.text("answer.live"))                      # words: text/en.toml, de.toml

        async def analyse() -> None:
            answer = await session.ask("underfoot.app.work_trials:analysed", str(folder))
            ...                                                     # raise freely: errors are told

        def run() -> None:                                          # minutes: the queue
            session.submit(session.text("answer.job"), "module:function", argument, about=name)

- ``session.ask("module:function", *args)`` (the warm process, while a person waits) and
  ``session.submit(title, "module:function", *args)`` (the queue) compute in another process:
  ``function(*args, progress=...)`` takes and returns plain data (text, numbers, lists; HTML or JSON
  as text) and stands in ``underfoot.app.work`` or a module ``work_NAME`` beside it. A page never
  imports that module: the server must stay free of SciPy, xarray, pandas and Matplotlib.
- A task of the queue: ``task.state``, ``task.fraction``, ``task.answer``; ``await
  session.jobs.wait_for(task)``. What lasts is written into the project's folder by the function.
- ``session.project``: folders and variants (``project.case(name)``, ``.copy(name, wanted,
  {path: value})``, ``.result_folder(name)``, ``.results()``). ``session.variant`` is the one shown.
- ``session.go("/answer", variant=name)`` opens a page; ``session.query["variant"]`` reads it there.
- ``components.sole_view()`` shows soles in 3-D; ``components.table(table)`` a table of text;
  ``components.drop_zone(session, "trials/mine", on_files)`` takes files into the project.
- ``session.answers(handler)``: an address that a script of the page asks, for sliders.
- ``session.tell(error)`` shows an error; errors of handlers and of ``build`` are shown by
  themselves. Words that a person reads come from the text files; units stand beside numbers.
"""

from __future__ import annotations

from ..session import Page
from . import answer, compare, design, place, project, start, studies, trials

DESIGN, SAFETY, SCIENCE = "design", "safety", "science"
"""The doors: who comes in. Their words are ``doors.NAME`` in the text files."""

PAGES = (
    Page("", "/", "start.title", "home", start.build),
    Page("", project.ROUTE, "project.title", "summarize", project.build),
    Page(DESIGN, "/design", "design.title", "straighten", design.build, design.example),
    Page(DESIGN, "/answer", "answer.title", "query_stats", answer.build),
    Page(DESIGN, "/compare", "compare.title", "compare", compare.build),
    Page(SAFETY, trials.ROUTE, "trials.title", "directions_walk", trials.build, trials.example),
    Page(SAFETY, place.ROUTE, "place.title", "storefront", place.build),
    Page(SCIENCE, "/studies", "studies.title", "scatter_plot", studies.build, studies.example),
)
