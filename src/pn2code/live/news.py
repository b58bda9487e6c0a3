"""Pictures of a run become updates for its pages.

    news = News(partition, config, near)
    for update in news.updates(pictures):   # pictures: an iterator, in order
        ...

The lines of supervisor and robots are put into one order, and the token game repeats them: so the marking on the page
is the net's, and a step that the net does not allow is an alarm. An update is a JSON-able object that the page adds to
what it has; all updates one after the other are the run.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.live.alarms import Alarms
from pn2code.live.player import Player
from pn2code.replay import happenings
from pn2code.replay.growing import GrowingCourse
from pn2code.robot.backend import Clearance
from pn2code.run.record import APART
from pn2code.semantics.game.marking import BindingElement
from pn2code.semantics.game.token_game import Game
from pn2code.trace.merge import Merger
from pn2code.trace.replay import replay_lines
from pn2code.trace.replay_result import ReplayResult

Json = dict[str, Any]

MOST_MARKS = 2000
"""That a page gets when it begins in the middle."""


class News:
    """Makes updates.

    Args:
        partition, config: the cell.
        near: clearances below this are warned of (m).
    """

    def __init__(self, partition: Partition, config: CellConfig, near: float) -> None:
        self._partition, self._config = partition, config
        self._merger = Merger(partition, 2)
        self._course = GrowingCourse(partition.net)
        self._alarms = Alarms(config.report.warn_condition, near)
        self._pairs: dict[tuple[str, str], int] = {}
        self._near: dict[tuple[str, str], tuple[float, Clearance]] = {}
        self._transition = {t.name: t.index for t in partition.net.transitions}
        self._party = {o.name: o.index for o in partition.owners}
        self._counts = dict.fromkeys(dict(config.report.count), 0)
        self._game: Game | None = None
        self._is_fresh = True
        self._marks: list[Json] = []
        self._parts: dict[str, Json] = {}
        self._latest = 0.0
        self._messages = 0

    def updates(self, pictures: Iterable[Json]) -> Iterator[Json]:
        """An update for each picture, as soon as it is there; nothing before the first, which has the header."""
        net, storage = self._partition.net, self._config.storage

        def watch(game: Game, occurred: BindingElement | None, line: Mapping[str, Any]) -> None:
            self._game = game
            if occurred is None:
                self._course.begin(game)
            else:
                self._course.step(game, occurred, float(line["t"]))

        with Player(lambda lines: replay_lines(lines, net, storage, watch=watch)) as player:
            for picture in pictures:
                if "header" in picture:
                    self._play(player, picture["header"])
                self._merger.add(0, picture["fired"])
                self._merger.add(1, (n for n in picture["noted"] if "transition" in n))
                for line in (
                    self._merger.rest() if picture.get("verdict") else self._merger.fitting()
                ):
                    self._latest = max(self._latest, float(line["t"]))
                    plain = {k: v for k, v in line.items() if k != "step"}
                    self._play(player, {**plain, "t": self._latest})
                yield self._update(picture)

    def begin_again(self) -> None:
        """The next update is for pages that know nothing: it begins with how things are now."""
        self._course = GrowingCourse(self._partition.net)
        if self._game is not None:
            self._course.begin(self._game)
        self._pairs = {}
        self._is_fresh = True

    def _play(self, player: Player[ReplayResult], line: Json) -> None:
        result = player.play(json.dumps(line))
        if result is not None and not result.ok:
            text = f"step {result.steps + 1}, {result.transition}: the net does not allow it: {result.why}"
            self._alarms.fault(self._latest, "", text)

    # --- an update -------------------------------------------------------------------------------

    def _update(self, picture: Json) -> Json:
        t = picture["t"]
        verdict = picture.get("verdict")
        self._alarms.look(t, picture)
        if verdict is not None:
            self._alarms.ended(t, verdict)
        for mark in picture["marks"]:
            self._counts[mark["label"]] = self._counts.get(mark["label"], 0) + 1
        self._messages += len(picture["traffic"])
        marks, parts = self._standing(picture)
        events = [n for line in picture["noted"] if (n := happenings.noted(line)) is not None]
        is_fresh, self._is_fresh = self._is_fresh, False
        standing = list(self._near.values()) if is_fresh else []
        return {
            "fresh": is_fresh,
            "t": max(t, self._latest),
            "course": self._course.news(),
            "bars": happenings.bars(picture["actions"], self._partition),
            "doing": [self._bar(d) for d in picture["doing"]],
            "activities": [
                {"name": a.name, "start": a.start, "end": a.end} for a in picture["activities"]
            ],
            "activity": picture["activity"],
            "messages": happenings.messages(picture["traffic"], self._partition),
            "events": [*events, *self._alarms.news()],
            "marks": marks,
            "parts": parts,
            "gaps": self._gaps([*standing, *picture["gaps"]]),
            "joints": picture["joints"],
            "series": picture["series"],
            "limits": {
                "condition": self._config.report.warn_condition,
                "clearance": self._alarms.near,
            },
            "sides": picture["sides"],
            "now": {
                "punctuality": picture["punctuality"],
                "left_out": picture["left_out"],
                "messages": self._messages,
                "alarms": self._alarms.count,
                "counts": dict(self._counts),
            },
            "verdict": verdict,
            "broken": picture["broken"],
            "hand": picture.get("hand"),
        }

    def _standing(self, picture: Json) -> tuple[list[Json], list[Json]]:
        """Marks and states of parts that are new; in a fresh update all that still stand."""
        self._marks = [*self._marks, *picture["marks"]][-MOST_MARKS:]
        for change in picture["places"]:
            self._parts[change["name"]] = change
        if self._is_fresh:
            return self._marks, list(self._parts.values())
        return picture["marks"], picture["places"]

    def _bar(self, doing: Json) -> Json:
        bar = {k: v for k, v in doing.items() if k != "robot"}
        bar["party"] = self._party[doing["robot"]]
        bar["transition"] = self._transition.get(doing["transition"], -1)
        return bar

    def _gaps(self, gaps: list[tuple[float, Clearance]]) -> Json:
        pairs = []
        rows: Json = {"t": [], "pair": [], "distance": [], "points": []}
        for t, gap in gaps:
            pair = (gap.a, gap.b)
            if gap.distance < APART:
                self._near[pair] = (t, gap)
            else:
                self._near.pop(pair, None)
            if pair not in self._pairs:
                self._pairs[pair] = len(self._pairs)
                pairs.append(list(pair))
            rows["t"].append(float(t))
            rows["pair"].append(self._pairs[pair])
            rows["distance"].append(float(gap.distance))
            rows["points"] += [float(v) for v in (*gap.point, *gap.other)]
        return {**rows, "pairs": pairs}
