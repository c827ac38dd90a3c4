"""Fields of the app read what people type, in every language: right, asked, or refused."""

import pytest
from test_web_pages import until
from web_app import page_of, project_of, served, settled

from underfoot.case import load

pytest.importorskip("nicegui")
pytest.importorskip("playwright.sync_api")
pytestmark = [pytest.mark.browser, pytest.mark.slow]
VISCOSITY = {
    "en": (("41,5", 0.0415), ("0.12 Pa s", 0.12), ("0,12 Pa·s", 0.12), ("1 234,5", 1.2345),
           ("55,0", 0.055), ("1\u2009234.5 cP", 1.2345), ("83/2", 0.0415),
           ("43\u00bd mPa s", 0.0435), ("1'234.5", 1.2345)),
    "de": (("41,5", 0.0415), ("41.5", 0.0415), ("1.234,5", 1.2345), ("0,12 Pa s", 0.12),
           ("1\u202f234,5 cP", 1.2345)),
}  # fmt: skip
REFUSED = {
    "en": ("abc", "12 34", "1,234", "3 mm", "NaN", "1e400", "\u22125", "0 500", "1e-400"),
    "de": ("1.234", "3 mm", "-", "0"),
}
TAB = {"en": "Spill", "de": "Flüssigkeit"}
LABEL = {"en": "Viscosity", "de": "Viskosität"}


@pytest.mark.parametrize("language", ["en", "de"])
def test_a_viscosity_is_read_as_it_is_typed(tmp_path, language):
    project = project_of(tmp_path / "project", "heel")
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.context.add_cookies([{"name": "language", "value": language, "url": app.base}])
        page.goto(app.base + "design?variant=heel")
        page.get_by_role("tab", name=TAB[language]).click()
        file = project.path("heel")

        def typed(text):
            field = page.get_by_label(LABEL[language], exact=True)
            field.fill(text)
            field.press("Enter")
            field.blur()

        def accepted(text, value):
            """The file has the value, and the form is drawn anew with it."""
            typed(text)
            until(lambda: load(file).value("contaminant.viscosity") == pytest.approx(value))
            shown = f"{1e3 * value:.4g}".replace(".", "," if language == "de" else ".")
            field = page.get_by_label(LABEL[language], exact=True)
            until(lambda: field.input_value() == shown)

        for text, value in VISCOSITY[language]:
            accepted(text, value)
        for text in REFUSED[language]:
            typed(text)
            page.locator(".q-field--error").wait_for()
            assert load(file).value("contaminant.viscosity") == pytest.approx(value), text
            value = 0.0777 if value == 0.0666 else 0.0666
            accepted(f"{value} Pa s", value)
        assert page.locator("input[type=number]").count() == 0
        assert not page.complaints


def test_an_emptied_field_takes_back_what_was_given(tmp_path):
    project = project_of(tmp_path / "project", "heel")
    file = project.path("heel")
    usual = load(file).value("contaminant.viscosity")
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "design?variant=heel")
        page.get_by_role("tab", name="Spill").click()
        field = page.get_by_label("Viscosity", exact=True)
        shown = field.input_value()
        for typed, drawn_anew in (("55 cP", "55"), ("", shown)):
            field.fill(typed)
            field.press("Enter")
            field.blur()
            wanted = pytest.approx(0.055 if typed else usual)
            until(lambda wanted=wanted: load(file).value("contaminant.viscosity") == wanted)
            until(lambda text=drawn_anew: field.input_value() == text)
        field.fill("")  # of the catalogue: nothing to take away
        field.press("Enter")
        field.blur()
        until(lambda: field.input_value() == shown)
        assert load(file).value("contaminant.viscosity") == pytest.approx(usual)
        assert not page.complaints


@pytest.mark.parametrize("leave", ["Enter", "Tab"])
@pytest.mark.parametrize("pause", [0, 250])  # ms: the form is drawn anew after the text, or within
def test_what_is_typed_while_the_form_is_drawn_anew_is_kept(tmp_path, pause, leave):
    project = project_of(tmp_path / "project", "heel")
    file = project.path("heel")
    with served(project.folder, tmp_path / "home") as app, page_of(app.link) as page:
        page.goto(app.base + "design?variant=heel")
        page.get_by_role("tab", name="Motion").click()
        page.get_by_label("Sliding speed", exact=True).fill("0.4")
        page.get_by_label("Load on the shoe", exact=True).click()
        page.keyboard.press("Control+A")
        page.keyboard.type("432", delay=pause)
        until(lambda: load(file).value("motion.speed") == pytest.approx(0.4))
        settled(page)
        assert page.get_by_label("Load on the shoe", exact=True).input_value() == "432"
        page.keyboard.press(leave)
        until(lambda: load(file).value("motion.normal_force") == pytest.approx(432))
        assert not page.complaints
