#!/usr/bin/env python3
"""Opens reports in a headless Chromium and checks that they load, and that the slider moves the blocks.

Usage: report.py REPORT.html... [--pictures FOLDER] [--dark]
Needs the PyPI package playwright, and a Chromium: the system's, or the one of `playwright install chromium`.
Exit 0: all well, 1: not, 3: the package or the browser is missing.
"""

import argparse
import hashlib
import shutil
import sys
from pathlib import Path

try:
    from playwright.sync_api import Error, sync_playwright
except ImportError as missing:
    print(f"report.py: {missing}")
    sys.exit(3)

BROWSERS = ["chromium", "chromium-browser", "google-chrome"]
# Blocks are drawn by the processor: there may be no graphics card.
FLAGS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
SIZE = {"width": 1440, "height": 900}


class Failure(Exception):
    """What is wrong with a report."""


def require(condition, message):
    if not condition:
        raise Failure(message)


def browser_of(playwright):
    """A Chromium, or None."""
    system = next(filter(None, map(shutil.which, BROWSERS)), None)
    try:
        return playwright.chromium.launch(executable_path=system, args=FLAGS, chromium_sandbox=False)
    except Error as error:
        print(f"report.py: {error}")
        return None


def picture_of(page):
    """What the blocks look like now, as a fingerprint."""
    return hashlib.sha256(page.locator("#view canvas:not(.overlay)").screenshot()).hexdigest()


def go_to(page, frame):
    page.locator("#slider").fill(str(frame))
    page.wait_for_timeout(100)


def check_blocks(page, pictures):
    """The slider moves the blocks, colours change them, and it plays to the end."""
    require(page.locator("#view canvas:not(.overlay)").count() == 1, "no canvas: " + page.locator("#view").inner_text())
    last = int(page.locator("#slider").get_attribute("max"))
    require(page.locator("#slider").input_value() == str(last), "it does not open at the last frame")
    opened = page.locator("#colour").evaluate("choice => choice.selectedOptions[0].textContent")
    require(opened == "displacement", f"it opens coloured by {opened}")
    with page.expect_download() as saved:
        page.locator("#save").click()
    require(saved.value.suggested_filename.endswith(".png"), "no picture is saved")
    require(last > 0, "one frame only: nothing can move")
    go_to(page, 0)
    first, time = picture_of(page), page.locator("#time").inner_text()
    go_to(page, last)
    require(page.locator("#time").inner_text() != time, "the time stays when the slider moves")
    require(picture_of(page) != first, "the blocks stay when the slider moves")
    seen = set()
    choices = page.locator("#colour option").all_inner_texts()
    for index, choice in enumerate(choices):
        page.locator("#colour").select_option(index=index)
        go_to(page, last // 2)
        seen.add(picture_of(page))
        if pictures:
            page.screenshot(path=f"{pictures}_{choice.replace(' ', '_')}.png")
    require(len(seen) > 1, "the blocks look the same whatever they are coloured by")
    page.locator("#colour").select_option(index=0)
    go_to(page, last - 1)
    page.locator("#play").click()
    page.wait_for_selector("#play[aria-label=Play]")
    require(page.locator("#slider").input_value() == str(last), "it does not play to the end")
    return f"{last + 1} frames, colours: {', '.join(choices)}"


def check_narrow(page):
    """Nothing is wider than the screen of a telephone."""
    page.set_viewport_size({"width": 390, "height": 844})
    page.wait_for_timeout(200)
    wide = page.evaluate("document.documentElement.scrollWidth")
    require(wide <= 390, f"on a screen of 390 px the page is {wide} px wide")
    page.set_viewport_size(SIZE)


def check(browser, path, folder, scheme):
    context = browser.new_context(viewport=SIZE, color_scheme=scheme, offline=True)
    page = context.new_page()
    complaints, asked = [], []
    page.on("console", lambda m: complaints.append(m.text) if m.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.on("dialog", lambda dialog: (complaints.append("a dialog: " + dialog.message), dialog.dismiss()))
    page.on("request", lambda request: asked.append(request.url))
    # A machine that does other work as well takes its time.
    page.goto(path.resolve().as_uri(), timeout=180_000)
    page.wait_for_selector("html[data-ready=yes]", state="attached", timeout=60_000)
    pictures = str(folder / f"{path.parent.name}_{scheme}") if folder else None
    found = check_blocks(page, pictures) if page.locator("#view").count() else "no blocks"
    check_narrow(page)
    curves = page.locator("#charts canvas").count()
    require(curves > 0, "no curves are drawn")
    if pictures:
        page.screenshot(path=f"{pictures}_page.png", full_page=True)
    # What a driver says of its speed is not ours.
    complaints = [text for text in complaints if "GPU stall due to ReadPixels" not in text]
    require(not complaints, "the browser complains: " + "; ".join(complaints))
    require(page.title().endswith(" – ndda"), "the title is not that of the page: " + page.title())
    outside = [url for url in asked if not url.startswith(("file:", "blob:", "data:"))]
    require(not outside, "the page asks for " + ", ".join(outside))
    context.close()
    return f"{path}: {found}, {curves} charts"


def main(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("reports", nargs="+", type=Path)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--dark", action="store_true")
    given = parser.parse_args(arguments)
    if given.pictures:
        given.pictures.mkdir(parents=True, exist_ok=True)
    with sync_playwright() as playwright:
        browser = browser_of(playwright)
        if browser is None:
            return 3
        for path in given.reports:
            try:
                print(check(browser, path, given.pictures, "dark" if given.dark else "light"))
            except (Failure, Error) as failure:
                print(f"{path}: {failure}", file=sys.stderr)
                return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
