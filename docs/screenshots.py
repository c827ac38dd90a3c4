"""Pictures of the app and of the pages that commands write, for ``docs/images``.

``.venv/bin/python docs/screenshots.py`` makes them anew (some minutes), with names only those:
``app``, ``measured``, ``run``, ``place``, ``designer``, ``ergonomist``. Tutorials: pages of their
blocks.
Chromium is needed (``make chromium``).
"""

import io
import shutil
import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path

from PIL import Image, ImageChops

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "app"))
sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "docs"))

from pages import ROOT, blocks_of, command_output, reader
from web_app import begin, drawn, helped, page_of, served

from underfoot.places.choice import choose_shoe
from underfoot.places.place import read_place

IMAGES = ROOT / "docs" / "images"

FIRST = "work_shoe_untreaded_glycerol"
MOST = 150_000
"""Bytes of a picture."""
FILM_WIDTH, FRAME = 800, 2500  # px, ms
PAGES = {
    "designer": {
        "designer_outsole": "bars/outsole.png",
        "designer_run": "out/bars/report.html",
        "designer_compare": "out/compared/report.html",
        "designer_wear": "out/wear/report.html",
    },
    "ergonomist": {
        "ergonomist_trials": "walks_done/report.html",
        "ergonomist_study": "study_done/report.html",
        "ergonomist_slip": "slip/report.html",
    },
}
"""Tutorial: picture: the page that its blocks leave."""


def store(name: str, png: bytes, width: int | None = None) -> None:
    """Write a picture without empty rows below as PNG of few colours, the most its bytes allow."""
    image = Image.open(io.BytesIO(png)).convert("RGB")
    below = Image.new("RGB", image.size, image.getpixel((0, image.height - 1)))
    _, _, _, end = ImageChops.difference(image, below).getbbox() or (0, 0, 0, image.height)
    image = image.crop((0, 0, image.width, min(end + 20, image.height)))
    if width and image.width > width:
        image = image.resize((width, round(image.height * width / image.width)), Image.LANCZOS)
    for colours in (256, 128, 64, 32):
        written = io.BytesIO()
        few = image.quantize(colours, dither=Image.Dither.NONE)
        few.save(written, format="PNG", optimize=True)
        if written.tell() <= MOST:
            break
    (IMAGES / f"{name}.png").write_bytes(written.getvalue())
    print(f"{name}.png: {written.tell() / 1e3:.0f} kB, {colours} colours", flush=True)


def film(name: str, frames: list[bytes]) -> None:
    """Write pictures as an animated GIF."""
    small = []
    for frame in frames:
        image = Image.open(io.BytesIO(frame)).convert("RGB")
        height = round(image.height * FILM_WIDTH / image.width)
        image = image.resize((FILM_WIDTH, height), Image.LANCZOS)
        small.append(image.quantize(64, dither=Image.Dither.NONE))
    path = IMAGES / f"{name}.gif"
    small[0].save(path, save_all=True, append_images=small[1:], duration=FRAME, loop=0)
    print(f"{path.name}: {path.stat().st_size / 1e3:.0f} kB, {len(small)} frames", flush=True)


@contextmanager
def project():
    """Yield a page of the app on a new project, its address and a folder."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        with served(place / "project", place / "home") as app, page_of(app.link) as page:
            yield page, app.base, place


def app_pictures() -> None:
    """Begin with a work shoe, change it, compute, ask what if, compare, read recordings."""
    frames: list[bytes] = []
    with project() as (page, base, place):

        def seen(name: str = "") -> None:
            page.mouse.move(5, 400)
            page.wait_for_timeout(600)
            frames.append(page.screenshot())
            if name:
                store(name, frames[-1])

        page.get_by_role("button", name="Skip").first.click()
        page.get_by_role("heading", name="I design outsoles").wait_for()
        seen("app_start")
        begin(page, base)
        seen("app_design")
        slider = page.locator("input[name='shoe.tread.lug_width']")
        slider.focus()
        for _ in range(20):
            page.keyboard.press("ArrowRight")
        page.wait_for_timeout(1500)
        drawn(page)
        seen()
        for tab in ("Floor", "Spill", "Assumptions"):
            page.get_by_role("tab", name=tab).click()
            page.wait_for_timeout(500)
            seen()
        page.get_by_role("tab", name="Sole").click()
        slider.focus()
        for _ in range(20):
            page.keyboard.press("ArrowLeft")
        page.wait_for_timeout(1500)
        page.get_by_role("button", name="Compute friction").click()
        page.wait_for_timeout(1500)
        seen()
        page.wait_for_selector(".big")
        drawn(page)
        helped(page)
        seen("app_answer")
        for field in ("Fluid pressure", "Film thickness"):
            page.locator(".choice label", has_text=field).click()
            drawn(page)
            seen()
        viscosity = page.locator("input[name='contaminant.viscosity']")
        viscosity.focus()
        while float((viscosity.get_attribute("aria-valuetext") or "").removesuffix(" cP")) > 120:
            page.keyboard.press("ArrowLeft")
        page.wait_for_function("document.querySelector('.sliders').dataset.asked > 0")
        page.wait_for_timeout(1500)
        seen("app_what_if")
        page.get_by_text("the full run differs by").wait_for()
        seen()
        with page.expect_navigation():  # the page before shows a number, too
            page.get_by_role("button", name="Keep it as a variant").click()
        page.wait_for_selector(".big")
        drawn(page)
        seen()
        both = sorted(path.stem for path in (place / "project" / "variants").glob("*.toml"))
        page.goto(f"{base}compare?variants={'|'.join(both)}")
        drawn(page)
        seen("app_compare")

        walks = ROOT / "tests" / "data" / "trials" / "biomechzoo"
        shutil.copytree(walks, place / "project" / "trials" / "my walks")
        page.goto(base + "trials?study=my walks")
        page.locator(".trial-card").nth(3).wait_for()
        page.wait_for_timeout(2000)
        seen("app_trials")
        page.locator(".trial-card", has_text="HC030A05").click()
        page.get_by_text("step 1 on plate 2: RCOF").wait_for()
        page.wait_for_timeout(1000)
        seen("app_trial")
    film("app", frames)


def measured_picture() -> None:
    """Drop a scan and a rubber test on the design page."""
    with project() as (page, base, _):
        begin(page, base)
        measured = ROOT / "examples" / "measured"
        for label, file, words in (
            ("Drop a scan of the sole", "sole.csv", "Scan of the sole: sole.csv"),
            ("Drop a test of the rubber", "dma.csv", "Compound: dma.toml"),
        ):
            zone = page.locator(f".drop[aria-label^='{label}'] input[type=file]")
            zone.set_input_files(measured / file)
            page.get_by_text(words).wait_for()
        page.get_by_text("Compound: dma.toml").scroll_into_view_if_needed()
        page.wait_for_timeout(1000)
        store("app_measured", page.screenshot())


def page_picture(name: str, file: Path) -> None:
    """Look at a page that a command left."""
    if file.suffix == ".png":
        store(name, file.read_bytes(), width=1000)
        return
    with page_of(file.resolve().as_uri(), width=1000, height=900) as page:
        page.wait_for_timeout(2000)
        store(name, page.screenshot())


def run_picture() -> None:
    """Run the case of the first page and look at its report."""
    with tempfile.TemporaryDirectory() as folder, reader(Path(folder)):
        case = ROOT / "examples" / f"{FIRST}.toml"
        command_output(f"underfoot run {case} --out out --no-advice")
        with page_of(Path("out/report.html").resolve().as_uri(), width=960, height=1080) as page:
            page.wait_for_timeout(2000)
            store(FIRST, page.screenshot())


def place_picture() -> None:
    """Choose a shoe for the hospital corridor of the examples."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "place"
        file = ROOT / "examples" / "places" / "hospital_corridor.toml"
        choose_shoe(read_place(file)).report(out)
        page_picture("place_hospital", out / "report.html")


def tutorial_pictures(tutorial: str) -> None:
    """Run the blocks of a tutorial and look at each page as soon as it is there."""
    waiting = dict(PAGES[tutorial])
    with tempfile.TemporaryDirectory() as folder, reader(Path(folder)) as session:
        for block in blocks_of(ROOT / "docs" / "tutorials" / f"{tutorial}.md"):
            if not waiting:
                break
            if block.language != "{plot}":
                session.output(block)
            for name, file in list(waiting.items()):
                if Path(file).is_file():
                    page_picture(name, Path(file))
                    del waiting[name]


if __name__ == "__main__":
    others = {
        "app": app_pictures, "measured": measured_picture, "run": run_picture,
        "place": place_picture,
    }  # fmt: skip
    for name in sys.argv[1:] or [*others, *PAGES]:
        others[name]() if name in others else tutorial_pictures(name)
