"""A course that grows says, piece by piece, what a whole course says at once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from helpers import netbuilder
from pn2code.diagnostics import Diagnostics
from pn2code.net.front import load
from pn2code.replay.growing import GrowingCourse
from pn2code.semantics.game.token_game import Game
from pn2code.semantics.values.colours import TEXTS
from pn2code.semantics.values.multiset import MultiSet

# Each value lies between the two before it, so that their ranks come ever nearer to each other.
NESTED = """
net Nested
  standard
  var n : INT;
  page Top
    place Next : INT = 1`(~70)
    place Held : INT
    trans Put
      in Next : n
      out Next : ~n + (if n < 0 then ~1 else 1)
      out Held : n
"""


class Page:
    """What a page makes of the news."""

    def __init__(self) -> None:
        self.place: list[int] = []
        self.text: list[str] = []
        self.rank: list[float] = []
        self.texts: list[str] = []
        self.held: dict[int, int] = {}
        self.steps = 0

    def add(self, news: dict[str, Any]) -> None:
        self.texts += news["texts"]
        tokens = news["tokens"]
        self.place += tokens["place"]
        self.text += [self.texts[i] for i in tokens["text"]]
        self.rank += tokens["rank"]
        for token, rank in tokens["again"]:
            self.rank[token] = rank
        for token, n in news.get("first", ()):
            self.held[token] = n
        for row in news["changes"]:
            for token, n in zip(row[::2], row[1::2], strict=True):
                self.held[token] = self.held.get(token, 0) + n
        self.steps += len(news["changes"])
        assert self.steps == news["steps"]

    def shown(self, place: int) -> list[str]:
        own = [t for t, n in self.held.items() if n and self.place[t] == place]
        return [self.text[t] for t in sorted(own, key=self.rank.__getitem__)]


@pytest.mark.parametrize("at_a_time", [1, 7])
def test_the_page_has_the_marking_in_the_order_of_cpn_tools(tmp_path: Path, at_a_time: int) -> None:
    d = Diagnostics()
    net = load(netbuilder.write(NESTED, tmp_path / "net.cpn"), d)
    assert net is not None, [e.message for e in d.errors]
    game = Game(net)
    course, page = GrowingCourse(net), Page()
    course.begin(game)
    is_ranked_again = False
    for step in range(60):
        if step % at_a_time == 0:
            news = course.news()
            is_ranked_again = is_ranked_again or bool(news["tokens"]["again"])
            page.add(news)
        course.step(game, game.fire(game.enabled()[0]), float(step))
    page.add(course.news())
    assert is_ranked_again
    held = next(p for p in net.places if p.short == "Held")
    tokens = game.marking.places[held.index]
    assert isinstance(tokens, MultiSet)
    values = sorted(tokens.counts)
    assert len(values) == 60
    assert page.shown(held.index) == [TEXTS.text(held.colset, v) for v in values]
