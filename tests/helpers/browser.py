"""A browser for tests: Debian's Chromium, driven by Playwright; without it tests skip, and say why.

`.ci/run` sets PN2CODE_BROWSER_NEEDED: there a missing browser is an error.
"""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
"""The first has no windows, and takes half the time of the others for the same pages."""
ARGUMENTS = (
    "--no-sandbox",  # containers run as root, and the pages are our own
    "--enable-unsafe-swiftshader",  # WebGL without a GPU
)
"""What draws the page is left to the browser, which does it itself where there is no GPU."""
WHOLE = (*ARGUMENTS, "--use-gl=angle", "--use-angle=swiftshader")
"""The same, but all of the page is drawn as with a GPU, by SwiftShader. That takes the processor two fifths longer."""
PATIENCE_MS = 240_000
"""Ends what hangs."""


def chromium() -> str:
    """The browser's program; skips when it is not there."""
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    lacks = [] if found else ["no Chromium"]
    if importlib.util.find_spec("playwright") is None:
        lacks.append("no package `playwright`")
    if not lacks and found:
        return found
    why = f"there is {' and '.join(lacks)}"
    if os.environ.get("PN2CODE_BROWSER_NEEDED"):
        pytest.fail(f"{why}, but PN2CODE_BROWSER_NEEDED is set")
    pytest.skip(why)


@contextmanager
def launched(arguments: Sequence[str] = ARGUMENTS) -> Iterator[Any]:
    """A browser, for the tests of a module (Playwright allows one at a time in a thread)."""
    program = chromium()
    from playwright.sync_api import sync_playwright

    with sync_playwright() as play:
        browser = play.chromium.launch(
            executable_path=program, args=list(arguments), timeout=PATIENCE_MS
        )
        try:
            yield browser
        finally:
            browser.close()


@contextmanager
def opened(browser: Any, **how: Any) -> Iterator[Page]:
    """A page in a context of its own; `how` as for a context of Playwright."""
    context = browser.new_context(**{"viewport": {"width": 1280, "height": 720}, **how})
    context.set_default_timeout(PATIENCE_MS)
    try:
        yield Page(context.new_page())
    finally:
        context.close()


class Page:
    """A replay page that is open.

    Attributes:
        errors: what the console and the page complained of.
        asked: addresses that were asked for, beside the file itself.
    """

    def __init__(self, page: Any) -> None:
        self.page = page
        self.errors: list[str] = []
        self.asked: list[str] = []
        self.dialogues: list[str] = []
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("request", lambda request: self.asked.append(request.url))
        page.on("dialog", self._dialogue)

    def _console(self, message: Any) -> None:
        if message.type == "error":
            self.errors.append(message.text)

    def _dialogue(self, dialogue: Any) -> None:
        self.dialogues.append(dialogue.message)
        dialogue.dismiss()

    def open(self, file: Path, moment: str = "") -> None:
        """From the file, until it is ready."""
        self.page.goto(f"{file.resolve().as_uri()}{moment}")
        try:
            self.page.wait_for_selector("body[data-ready=true]")
        except Exception as problem:
            raise AssertionError(f"the page is not ready: {self.errors}") from problem

    def wait(self, condition: str) -> None:
        """Until a condition holds (the page's own policy forbids Playwright's way to wait); an error if it does not."""
        most = PATIENCE_MS
        try:
            self.ask(
                f"""() => new Promise((done, fail) => {{
                  setTimeout(() => fail(new Error("{most} ms have not been enough")), {most});
                  (function f() {{
                    try {{ ({condition}) ? done() : requestAnimationFrame(f); }} catch (error) {{ fail(error); }}
                  }})();
                }})"""
            )
        except Exception as problem:
            raise AssertionError(f"{condition}: {problem}; errors: {self.errors}") from problem

    def settled(self) -> None:
        """Until the page has taken what has happened: two frames, so that it has seen sizes, and drawn."""
        self.ask(
            "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
        )

    def listen(self, selector: str) -> None:
        """From now on the page keeps the texts of an element, so that none of them can be there too shortly."""
        self.ask(
            """(selector) => {
              const [node, kept] = [document.querySelector(selector), (window.kept = [])];
              const options = { childList: true, characterData: true, subtree: true };
              new MutationObserver(() => kept.push(node.textContent)).observe(node, options);
            }""",
            selector,
        )

    def hear(self, text: str) -> None:
        """Waits until the element of `listen` has said something."""
        self.wait(f"window.kept.some((said) => said.includes({json.dumps(text)}))")

    def ask(self, script: str, value: Any = None) -> Any:
        """The value of a script."""
        return self.page.evaluate(script, value)
