"""Fingers on the screen of a phone, as Chromium passes them on to a page."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from helpers.browser import Page

Point = tuple[float, float]
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
STEPS = 6
HELD = "() => { window.laterOn = window.setTimeout; window.setTimeout = () => 0; }"
"""A finger on its way does not rest, however long a busy machine takes from one of its points to the next."""
FREE = "() => { window.setTimeout = window.laterOn; }"


class Fingers:
    """What a person does with one finger or two."""

    def __init__(self, page: Page) -> None:
        self._page = page
        self._session = page.page.context.new_cdp_session(page.page)

    def _say(self, kind: str, points: list[Point]) -> None:
        rows = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        self._session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": rows})

    def move(self, *ways: tuple[Point, Point]) -> None:
        """Each finger goes from one point to another, all at the same time; until the page has followed."""
        self._page.ask(HELD)
        self._say("touchStart", [a for a, _ in ways])
        for k in range(1, STEPS + 1):
            share = k / STEPS
            self._say(
                "touchMove",
                [(a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share) for a, b in ways],
            )
        self._say("touchEnd", [])
        self._page.settled()
        self._page.ask(FREE)

    @contextmanager
    def resting(self, at: Point) -> Iterator[None]:
        """A finger rests as long as something is waited for, and is taken away."""
        self._say("touchStart", [at])
        yield
        self._say("touchEnd", [])
        self._page.settled()
