"""Every page by keyboard alone: each control is reached, focus is seen, nothing traps."""

import pytest
from web_app import coarsened, drawn, page_of, served, settled

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")
pytestmark = [pytest.mark.browser, pytest.mark.slow]

CONTROLS = """() => [...document.querySelectorAll(
    "a[href], button, input, select, textarea, summary, [tabindex]")].filter((e) =>
    e.tabIndex >= 0 && !e.disabled && e.checkVisibility({ visibilityProperty: true })
    && !e.closest("[inert], [aria-hidden=true], [aria-disabled=true]") && e.type !== "radio")
    .map((e, k) => { e.dataset.control ??= `${k} ${e.tagName} ${e.getAttribute("aria-label")
      || e.innerText || e.name || e.className}`.slice(0, 80).replaceAll("\\n", " ");
      return e.dataset.control; })"""
FOCUS = """() => {
    const e = document.activeElement, style = getComputedStyle(e);
    const field = e.closest(".q-field--focused"), helper = e.querySelector(".q-focus-helper");
    const knob = e.querySelector(".knob");
    const marked = (style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2)
      || style.boxShadow.includes("rgb(11, 111, 164)")
      || field !== null || (knob && getComputedStyle(knob).strokeWidth === "3px")
      || (helper !== null && parseFloat(getComputedStyle(helper).opacity) > 0.1);
    return [e === document.body ? "" : e.dataset.control || e.tagName, Boolean(marked)];
}"""
TO_START = """() => {
    document.body.tabIndex = -1; document.body.focus(); document.body.removeAttribute("tabindex");
}"""
MOST = 250
"""Controls of a page, at most: a walk that is longer is caught somewhere."""


def walked(page):
    """Return what Tab does not reach, and what has no visible focus, on the page as it is."""
    settled(page)
    wanted = page.evaluate(CONTROLS)
    page.evaluate(TO_START)
    reached, unseen = [], []
    for _ in range(MOST):
        page.keyboard.press("Tab")
        name, seen = page.evaluate(FOCUS)
        if reached and name in ("", reached[0]):
            break  # round once
        reached.append(name)
        if not seen:
            unseen.append(name)
    else:
        pytest.fail(f"Tab does not leave {reached[-6:]}")
    return sorted({*wanted} - {*reached}), unseen


def tabbed(page, role, name):
    """Press Tab until a control has the focus."""
    target = page.get_by_role(role, name=name).first
    target.wait_for()
    for _ in range(MOST):
        if target.evaluate("e => e === document.activeElement"):
            return target
        page.keyboard.press("Tab")
    raise AssertionError(f"Tab does not reach {name}")


def test_the_first_answer_and_every_page_without_a_mouse(tmp_path):
    faults = {}
    with (
        served(tmp_path / "project", tmp_path / "home") as app,
        page_of(app.link) as page,
    ):

        def walk(name):
            missed, unseen = walked(page)
            if missed or unseen:
                faults[name] = {"not reached": missed, "focus not seen": unseen}

        page.get_by_role("button", name="Skip").first.wait_for()
        page.keyboard.press("Escape")  # the tour
        page.get_by_role("button", name="Skip").first.wait_for(state="hidden")
        walk("start")
        tabbed(page, "link", "Design")
        page.keyboard.press("Enter")
        tabbed(page, "button", "Begin with a work shoe")
        page.keyboard.press("Enter")
        page.wait_for_url("**/design?variant=*")
        drawn(page)
        tabbed(page, "tab", "Sole")
        for _ in page.get_by_role("tab").all():
            walk(f"design, {page.get_by_role('tab', selected=True).inner_text()}")
            tabbed(page, "tab", page.get_by_role("tab", selected=True).inner_text())
            page.keyboard.press("ArrowRight")
            page.keyboard.press("Enter")
            settled(page)
        coarsened(page, app)
        slider = page.locator("input[name='shoe.tread.lug_width']")
        before = slider.input_value()
        slider.focus()
        page.keyboard.press("ArrowRight")
        page.wait_for_function("document.querySelector('[data-step=undo]').disabled === false")
        page.keyboard.press("Control+z")
        page.wait_for_function(
            "v => document.querySelector(\"input[name='shoe.tread.lug_width']\").value === v",
            arg=before,
        )
        drawn(page)
        tabbed(page, "button", "Compute friction")
        page.keyboard.press("Enter")
        page.wait_for_selector(".big")
        drawn(page)
        page.get_by_role("button", name="Make this variant").first.wait_for(timeout=480_000)
        walk("answer")
        for name in ("compare", "project", "studies", "place", "trials"):
            page.goto(app.base + name)
            walk(name)
        tabbed(page, "button", "Try it with made-up slips")
        page.keyboard.press("Enter")
        page.locator(".trial-card").first.wait_for()
        walk("folder of trials")
        tabbed(page, "button", "slip_001.c3d")
        page.keyboard.press("Enter")
        page.locator(".step-words").wait_for()
        walk("trial")
        assert not faults
