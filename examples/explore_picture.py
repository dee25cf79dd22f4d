"""Draws docs/img/explore.png: the page of `make explore` on the record of Pacoima Dam, where McManus's pier rocks most."""

import shutil
from pathlib import Path

from first_run import RECORD, SCALE, TIME_SCALE
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parents[1]

with sync_playwright() as playwright:
    browser = playwright.chromium.launch(executable_path=shutil.which("chromium"))
    page = browser.new_page(viewport={"width": 1300, "height": 720}, reduced_motion="reduce")
    page.goto(f"{(ROOT / 'out' / 'explore.html').as_uri()}#scale={SCALE}&time_scale={TIME_SCALE}&tab=compare")
    page.locator("body[data-ready]").wait_for()
    page.locator("#file").set_input_files(RECORD)
    page.locator("#levels .advised").wait_for()
    page.wait_for_timeout(1000)
    page.locator("#readings [data-name=theta] button").evaluate("button => button.click()")
    page.screenshot(path=ROOT / "docs" / "img" / "explore.png")
