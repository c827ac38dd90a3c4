"""Print a page as PDF with Chromium, once its formulas stand: ``print_manual.py PAGE.html PDF``."""

import shutil
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

FOOT = """<div style="font-size:8px;width:100%;text-align:center">
<span class="title"></span>, page <span class="pageNumber"></span> of
<span class="totalPages"></span></div>"""


def main(page: Path, pdf: Path) -> None:
    """Print; ends with a sentence where there is no Chromium."""
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    browser = next(filter(None, map(shutil.which, names)), None)
    if browser is None:
        sys.exit("no Chromium: make chromium installs it (Debian, Ubuntu)")
    with sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        sheet = chromium.new_page()
        sheet.goto(page.resolve().as_uri())
        sheet.evaluate("MathJax.startup.promise.then(() => true)")
        sheet.pdf(
            path=pdf, format="A4", display_header_footer=True, header_template="<span></span>",
            footer_template=FOOT,
            margin={"top": "15mm", "bottom": "18mm", "left": "15mm", "right": "15mm"},
        )  # fmt: skip
        chromium.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
