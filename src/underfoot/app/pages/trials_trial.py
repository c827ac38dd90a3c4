"""One trial: its signals with marks to move, its steps, and edits by hand with their reasons."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from functools import partial
from typing import Any

from nicegui import ui
from nicegui.events import GenericEventArguments

from underfoot.core.errors import UnderfootError
from underfoot.core.remark import Message

from ..components import sentences, title
from ..labels import package_label
from ..session import Session
from ..trials_study import TrialsFolder
from .trials_folder import STATIC, WORK

PLOT_WORDS = (
    "plot", "step", "time", "force", "ratio", "speed", "cof", "contact", "toe off", "gate", "rcof",
    "slip start", "slip end", "slip peak", "begin", "end", "normal", "shear", "left", "right",
    "unknown",
)  # fmt: skip
"""What a plot names: itself, its panels, lines and events."""


class TrialPlot(ui.element, component=STATIC / "trial.js"):
    """Signals with events that may be moved (``moved``) and steps that may be chosen."""

    def __init__(self, session: Session, *, choosing: bool = False, panel: int = 104) -> None:
        super().__init__()
        words = {id: session.text(f"trials.plot.{id.replace(' ', '_')}") for id in PLOT_WORDS}
        self._props.update(words=words, choosing=choosing, panel=panel, revision=0)

    def show(self, plot: Mapping[str, Any], chosen: int | None) -> None:
        """Draw a plot; what was being moved is where the plot says."""
        self._props.update(plot=plot, chosen=chosen, revision=self._props["revision"] + 1)
        self.update()


class TrialView:
    """A trial in the element that is open; ``back`` and ``show`` lead to its folder, to others.

    An edit is shown as it would be and written when its reason is said.
    """

    def __init__(
        self,
        session: Session,
        study: TrialsFolder,
        view: dict[str, Any],
        back: Callable[[], None],
        show: Callable[[str], Awaitable[None]],
    ) -> None:
        self.session, self.study, self.view, self.show = session, study, view, show
        self.pending: dict[str, Any] | None = None
        self.text = text = session.text
        with ui.element("div").classes("trial-bar"):
            leave = ui.button(text("trials.all_trials"), icon="arrow_back", on_click=back)
            leave.props("flat no-caps dense")
            title(view["file"])
            ui.space()
            self._beside(-1, "navigate_before", "trials.before")
            self._beside(1, "navigate_next", "trials.after")
            self.undo = self._tool("undo", "trials.undo", self._undo)
            self.redo = self._tool("redo", "trials.redo", self._redo)
        self.head = ui.element("div")
        if view["whole"]:
            self.whole = TrialPlot(session, choosing=True, panel=46)
            self.whole.on("chosen", lambda e: self.choose_step(e.args))
        self.bar = ui.element("div").classes("edit-bar").props('aria-live="polite"')
        if view["plot"]:
            self.plot = TrialPlot(session).on("moved", self._drag_mark)
        self.log = ui.element("div")
        self._fill(view)

    def _tool(self, icon: str, key: str, on_click: Any) -> ui.button:
        made = ui.button(icon=icon, on_click=on_click).props("flat round dense")
        return made.props(f'aria-label="{self.text(key)}"').tooltip(self.text(key))

    def _beside(self, by: int, icon: str, key: str) -> None:
        names, file = self.study.files, self.view["file"]
        at = names.index(file) + by if file in names else -1
        there = 0 <= at < len(names)
        self._tool(icon, key, partial(self.show, names[at] if there else "")).set_enabled(there)

    async def choose_step(self, number: int) -> None:
        """Show another step of the trial; an edit that was not kept is gone."""
        self.pending = None
        args = self.study.asked, self.view["file"], number
        self._fill(await self.session.ask(f"{WORK}:trial_view", *args))

    def _fill(self, view: Mapping[str, Any]) -> None:
        """Show a view of the trial in the elements that are there."""
        self.view = view
        if view["whole"]:
            self.whole.show(view["whole"], view["chosen"])
        if view["plot"]:
            self.plot.show(view["plot"], view["chosen"])
        self.undo.set_enabled(bool(self.study.done))
        self.redo.set_enabled(bool(self.study.undone))
        self.head.clear()
        with self.head:
            self._summary()
        self.bar.clear()
        with self.bar:
            self._edit_bar()
        self.log.clear()
        with self.log:
            self._log()

    def _summary(self) -> None:
        view, text = self.view, self.text
        with ui.element("div").classes("trial-summary"):
            ui.label(text(f"trials.{view['verdict']}")).classes(f"tag is-{view['verdict']}")
            for words in view["numbers"]:
                package_label(words).classes("number")
            ui.label(", ".join(f"{n}: {v}" for n, v in view["conditions"].items())).classes("soft")
            self._step_chips()
        sentences(view["reasons"], "reason")

    def _step_chips(self) -> None:
        view, text = self.view, self.text
        with ui.element("div").classes("chips"):
            for step in sorted(view["steps"], key=lambda each: each["number"]):
                number = "–" if step["rcof"] is None else f"{step['rcof']:.3f}"
                words = f"{step['number']} {text('trials.side_' + step['side'])}: {number}"
                chip = ui.button(words, color=None).classes(f"chip is-{step['verdict']}")
                chip.on_click(partial(self.choose_step, step["number"]))
                chip.props("flat no-caps dense")
                chip.props(f'aria-pressed="{str(step["number"] == view["chosen"]).lower()}"')

    def _chosen_step(self) -> dict[str, Any] | None:
        return next((s for s in self.view["steps"] if s["number"] == self.view["chosen"]), None)

    def _edit_bar(self) -> None:
        """Show the chosen step and what may be done with it, or the edit that lacks a reason."""
        step = self._chosen_step()
        if self.pending is not None:
            self._reason()
            return
        if step is not None:
            words = Message("{item}: {words}", item=step["item"], words=_step_words(step))
            package_label(words).classes("step-words")
            sentences(step["cautions"], "reason")
            self._offer(step)
        elif self.view["kind"] != "readings" and not self.view["edits"] and self.view["plot"]:
            change = {"step": self.view["run"], "what": "exclude"}
            self._change_button("trials.exclude_run", change)

    def _offer(self, step: Mapping[str, Any]) -> None:
        number = step["number"]
        if "exclude" in step["by_hand"]:
            return
        self._change_button("trials.exclude", {"step": number, "what": "exclude"})
        other = {"left": "right", "right": "left"}.get(step["side"])
        for side in [other] if other else ["left", "right"]:
            change = {"step": number, "what": "side", "value": side}
            self._change_button(f"trials.is_{side}", change)
        near = [s for s in self.view["steps"] if abs(s["contact"] - step["contact"]) < 0.1]
        if len(near) > 1:
            change = {"step": number, "what": "plate", "value": step["plate"]}
            self._change_button("trials.this_plate", change)
        ui.label(self.text("trials.drag")).classes("soft")

    def _change_button(self, key: str, change: dict[str, Any]) -> None:
        made = ui.button(self.text(key), on_click=lambda: self.try_change(change))
        made.props("outline no-caps dense")

    def _reason(self) -> None:
        """Show what the edit would do and ask for its reason."""
        text, entry = self.text, self.view["edits"][-1]
        words = Message("{step}: {edit}", step=entry["step"], edit=_edit_words(entry))
        package_label(words).classes("step-words").props('role="status"')
        why = ui.input(text("trials.why"), validation={text("trials.why_missing"): bool})
        why.without_auto_validation()
        past = dict.fromkeys(each["why"] for each in self.view["edits"][:-1])
        why.set_autocomplete(list(past))
        why.props("autofocus dense hide-bottom-space").classes("why")

        async def keep() -> None:
            if why.validate():
                await self._keep_edit({**(self.pending or {}), "why": (why.value or "").strip()})

        why.on("keydown.enter", keep)
        why.on("keydown.escape", self._discard)
        ui.button(text("trials.keep"), on_click=keep).props("unelevated no-caps")
        ui.button(text("trials.discard"), on_click=self._discard).props("flat no-caps")

    def _log(self) -> None:
        text, edits = self.text, self.view["edits"]
        if not edits or self.pending is not None:
            return
        title(text("trials.edits"), 2)
        for number, entry in enumerate(edits):
            with ui.element("div").classes("edit"):
                told = {"step": entry["step"], "edit": _edit_words(entry), "why": entry["why"]}
                package_label(Message("{step}: {edit}. {why}", **told))
                take = ui.button(text("trials.take_back"))
                take.on_click(partial(self._keep_edit, {"step": number, "what": "take back"}))
                take.props("flat no-caps dense")

    async def _drag_mark(self, event: GenericEventArguments) -> None:
        value = f"{event.args['time']:.4f} s"
        await self.try_change(
            {"step": self.view["chosen"], "what": event.args["id"], "value": value}
        )

    async def try_change(self, change: dict[str, Any]) -> None:
        """Show what an edit would do; it is not written."""
        if await self._ask_change(change, keep=False):
            self.pending = change
            self._fill(self.view)

    async def _keep_edit(self, change: dict[str, Any]) -> None:
        if await self._ask_change(change, keep=True):
            self.study.done.append((self.view["before"], self.view["after"]))
            self.pending, self.study.undone = None, []
            self._fill(self.view)

    async def _ask_change(self, change: dict[str, Any], *, keep: bool) -> bool:
        arguments = self.study.asked, self.view["file"], self.view["chosen"]
        options = {"change": change, "keep": keep}
        try:
            self.view = await self.session.ask(f"{WORK}:trial_view", *arguments, **options)
        except UnderfootError as error:
            self.session.tell(error)
            await self._discard()
            return False
        return True

    async def _discard(self) -> None:
        await self.choose_step(self.view["chosen"])

    async def _undo(self) -> None:
        await self._put(self.study.done, self.study.undone, 0)

    async def _redo(self) -> None:
        await self._put(self.study.undone, self.study.done, 1)

    async def _put(
        self, source: list[tuple[str, str]], target: list[tuple[str, str]], to: int
    ) -> None:
        """Make ``edits.csv`` what it was before (0) or after (1) the last edit of ``source``."""
        texts = source.pop()
        await self.session.ask(f"{WORK}:put_edits", self.study.asked, texts[to], texts[1 - to])
        target.append(texts)
        await self._discard()


def _step_words(step: Mapping[str, Any]) -> str:
    """Return a step's number with its uncertainty, or why it has none."""
    parts = []
    if step["rcof"] is not None:
        rcof = Message("RCOF {rcof:.4f}", rcof=step["rcof"])
        if spread := step["rcof_uncertainty"]:
            rcof = Message("{rcof} ± {spread:.4f}", rcof=rcof, spread=spread)
        parts.append(rcof)
    if step["peak_slipping_speed"] is not None:
        speed = step["peak_slipping_speed"]
        parts.append(Message("peak slipping speed {speed:.3f} m/s", speed=speed))
    if step["outcome"]:
        distance = 1e3 * step["slip_distance"]
        slip = Message("{outcome}, {distance:.0f} mm", outcome=step["outcome"], distance=distance)
        parts.append(slip)
    return Message("{parts}", parts=parts) if parts else step["reason"] or "–"


def _edit_words(entry: Mapping[str, Any]) -> Message:
    """Return what an edit did: the event and the number before and after."""
    changed = {name: entry[name] for name in ("what", "before", "after")}
    event = Message("{what} {before} → {after}", **changed)
    if not entry["quantity"]:
        return event
    numbers = (entry["number_before"], entry["number_after"])
    before, after = ("–" if number is None else f"{number:.4f}" for number in numbers)
    name = Message("RCOF")
    if entry["quantity"] != "rcof":
        name = Message("{quantity} (m/s)", quantity=entry["quantity"])
    number = Message("{name} {before} → {after}", name=name, before=before, after=after)
    return Message("{event}, {number}", event=event, number=number)
