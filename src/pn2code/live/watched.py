"""One session of a cell that runs elsewhere, as updates for the page (in the form of `news`).

    with Watched(cell, session, began, is_from_start=True) as watched:
        watched.take(tails)                      # what is new in the traces
        watched.see(1.25, texts)                 # what the shared files hold
        watched.update(1.25, seen)               # an update

What is observed and what is inferred is part of each update (`basis`).
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from pn2code.base.closing import Closing
from pn2code.base.frozen import frozen
from pn2code.cell.config import CellConfig
from pn2code.cell.partition import Partition
from pn2code.channels import specs_of
from pn2code.emission.output import Block
from pn2code.live.alarms import Alarms
from pn2code.live.follower import Follower
from pn2code.live.messages import StepMessages, channel_texts
from pn2code.live.observed import Observed
from pn2code.live.robots import Robots
from pn2code.live.seen import Life, Seen
from pn2code.live.tails import Tail
from pn2code.properties.failing import Failing
from pn2code.replay.growing import GrowingCourse
from pn2code.robot.robot_cell import RobotCell
from pn2code.semantics.game.marking import BindingElement, Marking
from pn2code.semantics.game.token_game import Game

Json = dict[str, Any]

MOST_KEPT = 5000
"""Entries of one kind that pages get which come after the marking has become another one."""
LOST_S = 3.0
"""Files that nothing explains for so long: what the marking is, is not known any more."""
_STALE_S = 2.0
"""A trace that was written so long before the supervisor began is an older one's."""
NO_STOP = "this page only watches: the cell is stopped where it was started"
LONGEST = 400
"""Characters of a reason."""


@frozen
class WatchedCell:
    """What is watched.

    Args:
        partition, config, robot_cell: the cell.
        blocks: of each script by the robot's name: which lines implement which net element.
        initial: what input files bring, in the form of a trace's header.
    """

    partition: Partition
    config: CellConfig
    robot_cell: RobotCell
    blocks: Mapping[str, tuple[Block, ...]]
    initial: Json
    failing: Failing = Failing()


class Watched(Closing):
    """A session.

    Args:
        cell: what is watched.
        session: of the supervisor.
        began: when (s, as `time.time` counts).
        is_from_start: whether this watch has seen the session begin.

    Attributes:
        is_late: whether a trace has come after its steps were inferred: the session is to be watched anew, with all
            traces from their beginnings.
    """

    def __init__(
        self, cell: WatchedCell, session: str, began: float, *, is_from_start: bool
    ) -> None:
        self._cell = cell
        self.session, self._began = session, began
        self._is_from_start = is_from_start
        partition = cell.partition
        self._party = {o.name: o.index for o in partition.owners}
        self._course = GrowingCourse(partition.net)
        self._course.begin_unknown()
        self._follower = Follower(partition, cell.config.storage, self._occurred)
        self._steps = StepMessages(partition)
        self._observed = Observed(specs_of(partition), session)
        self.is_late = False
        self._robots = Robots(cell.config, cell.robot_cell, partition, cell.blocks)
        near = cell.robot_cell.scene.warning_clearance
        self.alarms = Alarms(cell.config.report.warn_condition, near)
        self._has_supervisor_trace = self._left_out = False
        self._places: tuple[Any, ...] = ()
        self._activity, self._activity_since = "", 0.0
        self._new: Json = {"messages": [], "events": [], "activities": []}
        self._latest = self._noted = 0.0
        self._has_looked = False
        self._messages = 0
        self._answers: dict[int, float] = {}
        self._answer: float | None = None
        self._longest: float | None = None
        self._is_fresh = True
        self._lost = ""
        self._unexplained_since: float | None = None
        self._held: dict[str, str] = {}
        self._arrived: dict[str, int] = {}
        self._explained: dict[str, int] = {}
        self._kept: dict[str, list[Json]] = {}
        self.last_word: Json = {}
        self._broken: Json | None = None

    def failed(self, final: Iterable[str]) -> list[str]:
        """Which of some final places mean that the cell has failed."""
        final = list(final)
        names = self._cell.partition.failed(final)
        failing, game = self._cell.failing, self._follower.game
        if not failing or not final:
            return names
        if self._lost or game is None:
            return [*names, *failing.not_known("the marking is not known")]
        return [*names, *failing.in_(game, game.marking)]

    # --- what comes ------------------------------------------------------------------------------

    def take(self, tails: Sequence[Tail]) -> None:
        """What is new in the traces, of those that are of this session."""
        ours = [tail for tail in tails if tail.header and self._is_ours(tail)]
        for tail in ours:  # who writes one decides what is done with the lines of all
            self._traced_by(tail)
        for tail in ours:
            for line in tail.lines:
                self._line(tail, line)

    def _traced_by(self, tail: Tail) -> None:
        """Who writes a trace, from its first line."""
        owners = self._cell.partition.owners
        named = {"supervisor": [0], "robots": range(1, len(owners))}
        parties = named.get(tail.by) or [o.index for o in owners if o.name == tail.by]
        new = {index for index in parties if index not in self._follower.traced}
        self._follower.traced |= new
        if 0 in new:
            self._has_supervisor_trace = True
            self.is_late |= self._follower.game is not None or bool(self._lost) or self._left_out
            if not self.is_late:
                self._follower.begin(tail.header)
        elif new and self._follower.inferred:
            self.is_late = True

    def _is_ours(self, tail: Tail) -> bool:
        if tail.session:
            return tail.session == self.session
        return tail.by == "supervisor" and tail.written >= self._began - _STALE_S

    def _line(self, tail: Tail, line: Json) -> None:
        if "transition" in line:
            if not self._has_supervisor_trace:
                self._left_out = True  # the messages alone explain what all have done
            elif not self._follower.add(line):
                tail.unreadable += 1
            return
        if line.get("event") == "end" and tail.by == "supervisor":
            self.last_word = line
            return
        try:
            if line.get("event") == "zone" and self._broken is None:
                self._broken = self._zone(line)
            event = self._robots.take(line)
        except (KeyError, TypeError, ValueError):
            tail.unreadable += 1
            return
        if event is not None:
            self._new["events"].append(event)
        if line.get("event") == "said" and not self.last_word:
            self.last_word = line
        if isinstance(line.get("t"), int | float):
            self._noted = max(self._noted, float(line["t"]))

    def _zone(self, line: Json) -> Json:
        """The zone in which something was too fast, as the page has it."""
        if line["zone"] not in self._cell.robot_cell.zones:
            raise ValueError(line["zone"])
        t, speed, *point = (float(v) for v in (line["t"], line["speed"], *line["point"]))
        if len(point) != len("xyz") or not all(math.isfinite(v) for v in (t, speed, *point)):
            raise ValueError(line)
        link = str(line["link"])[:LONGEST]
        return {"zone": line["zone"], "t": t, "link": link, "speed": speed, "point": point}

    def see(
        self, t: float, texts: Mapping[str, str | None], turns: Mapping[str, int] | None
    ) -> None:
        """What the shared files hold now.

        Args:
            t: when.
            texts: of each channel.
            turns: how often each channel's file was replaced since the last call; None: that is not known.
        """
        if not self._has_looked:
            self._has_looked = True
            first = dict.fromkeys(texts, "0") if self._is_from_start else texts
            self._observed.begin(first, knows_turns=turns is not None)
        for name, times in (turns or {}).items():
            self._observed.turned(name, times)
        rows = list(self._observed.look(t, texts))
        self._observed.count()
        if self._has_supervisor_trace:
            return
        places = {c.name: c for c in self._cell.partition.channels}
        for row in rows:
            channel = places[row.channel]
            self._new["messages"].append(
                {
                    "t": row.t,
                    "channel": row.channel,
                    "place": channel.place,
                    "from": channel.writer,
                    "to": channel.reader,
                    "what": "seen",
                    "text": row.text,
                }
            )
        self._messages += len(rows)
        self._noted = max(self._noted, t if rows else 0.0)
        self._infer(t, texts)

    def _infer(self, t: float, texts: Mapping[str, str | None]) -> None:
        """Without any trace: a shortest run that explains the files, from the initial marking on."""
        if self._lost or self._follower.wrong:
            return
        if not self._is_from_start:
            self._lose("the cell ran before this watch began, and its supervisor writes no trace")
            return
        if self._observed.missed and not self._observed.knows_turns:
            self._lose(f"messages came and went unseen, the first before {t:.2f} s")
            return
        held = {name: (text or "").partition("\n")[0].strip() for name, text in texts.items()}
        if self._follower.game is None:
            self._follower.begin({"trace": 1, "by": "run", "initial": self._cell.initial})
        partition = self._cell.partition

        def is_seen(marking: Marking) -> bool:
            return channel_texts(partition, marking.places) == held

        arrivals = self._observed.arrivals()
        if held != self._held or arrivals != self._arrived:
            self._held, self._arrived = held, arrivals
            new = {
                c.place: arrivals[c.name] - self._explained.get(c.name, 0)
                for c in partition.channels
            }
            if self._follower.infer(t, is_seen, new):
                self._unexplained_since = None
                self._explained = arrivals
            elif self._unexplained_since is None:
                self._unexplained_since = t
        since = self._unexplained_since
        if since is not None and t - since > LOST_S:
            self._lose(f"nothing explains what the files hold since {since:.2f} s")

    def _occurred(
        self, game: Game, occurred: BindingElement | None, line: Mapping[str, Any]
    ) -> None:
        if occurred is None:
            self._places = game.marking.places
            if self._is_fresh:
                self._course.begin(game)
            else:  # pages have been told that nothing is known
                self._anew()
            return
        self._latest = t = max(self._latest, float(line["t"]))
        self._course.step(game, occurred, t)
        before, self._places = self._places, game.marking.places
        partition = self._cell.partition
        is_inferred = bool(line.get("inferred"))
        rows = list(self._steps.of(occurred, before, self._places, t, is_inferred))
        if self._has_supervisor_trace:
            self._new["messages"] += rows
            self._messages += len(rows)
            for row in rows:
                self._punctual(row)
        if partition.transition_owner[occurred.transition] == 0:
            self._enter(partition.net.transitions[occurred.transition].name, t)

    def _punctual(self, row: Json) -> None:
        """An answer of the supervisor: from a message of a robot to the next one that it takes."""
        if row["what"].startswith("written"):
            self._answers[row["from"]] = row["t"]
        elif (since := self._answers.pop(row["to"], None)) is not None and row["from"] == 0:
            self._answer = row["t"] - since
            self._longest = max(self._longest or 0.0, self._answer)

    def _enter(self, transition: str, t: float) -> None:
        path = transition.split(".")
        depth = self._cell.partition.owners[0].instance.count("/") + 1
        activity = path[depth] if len(path) > depth + 1 else ""
        if activity != self._activity:
            self._leave(t)
            self._activity, self._activity_since = activity, t

    def _leave(self, t: float) -> None:
        if self._activity:
            row = {"name": self._activity, "start": self._activity_since, "end": t}
            self._new["activities"].append(row)
        self._activity = ""

    # --- what is told ----------------------------------------------------------------------------

    def update(
        self, t: float, seen: Seen, verdict: Json | None, left: Iterable[list[str]] = ()
    ) -> Json:
        """All that is new.

        Args:
            t: the moment (s of the session).
            seen: the last look.
            verdict: how it has ended; None while it goes on.
            left: more to say of what is observed.
        """
        self._follower.advance(t if verdict is None else t + 1e6)
        t = max(t, self._latest, self._noted)
        names = {o.index: o.name for o in self._cell.partition.owners}
        if self._follower.wrong:
            self.alarms.fault(t, "", self._follower.wrong)
        for who, why in self._observed.oddities(t) if verdict is None else ():
            self.alarms.fault(t, who, why)
        for name, side in seen.sides.items():
            if side.state is Life.DIED:
                self.alarms.fault(t, name, "has died: its process is gone")
            elif side.state is Life.STOPPED:
                self.alarms.fault(t, name, f"has stopped: {side.reason[:LONGEST]}")
        if verdict is not None:
            self._leave(t)
            self.alarms.ended(t, verdict)
        robots = self._robots.news(t)
        self.alarms.look(t, {"series": robots["series"], "gaps": [], "warnings": []})
        new, self._new = self._new, {"messages": [], "events": [], "activities": []}
        rows = {
            "bars": robots["bars"],
            "activities": new["activities"],
            "messages": new["messages"],
            "events": [*new["events"], *self.alarms.news()],
        }
        kept = {n: [*self._kept.get(n, []), *own][-MOST_KEPT:] for n, own in rows.items()}
        self._kept = kept
        is_fresh, self._is_fresh = self._is_fresh, False
        return {
            "fresh": is_fresh,
            "t": t,
            "course": self._course.news(),
            **(kept if is_fresh else rows),
            "doing": robots["doing"],
            "activity": self._activity,
            "marks": robots["marks"],
            "parts": [],
            "gaps": {"pairs": [], "t": [], "pair": [], "distance": [], "points": []},
            "joints": robots["joints"],
            "series": robots["series"],
            "limits": {"condition": self.alarms.condition, "clearance": self.alarms.near},
            "sides": [self._side(i, names[i], seen, t) for i in sorted(names)],
            "now": {
                "punctuality": {"answer": self._answer, "longest": self._longest, "noticed": None},
                "left_out": None,
                "messages": self._messages,
                "alarms": self.alarms.count,
                "counts": robots["counts"],
            },
            "basis": [*self._basis(), *self._files(seen), *left],
            "verdict": verdict,
            "broken": self._broken,
        }

    def _side(self, index: int, name: str, seen: Seen, t: float) -> Json:
        side = seen.sides[name]
        doing = self._robots.doing(index) if side.state is Life.RUNS else None
        row: Json = {"name": name, "state": side.state.value, "line": 0, "since": None}
        if doing is not None:
            return {**row, "state": "works", **doing}
        if index == 0 and side.state is Life.RUNS:
            return {**row, "text": self._activity}
        if side.state is Life.RUNS and self._robots.is_recorded(index):
            return {**row, "state": "waits", "text": ""}
        return {**row, "text": side.reason[:LONGEST]}

    def _files(self, seen: Seen) -> list[list[str]]:
        """What the files hold, where no trace says it."""
        if self._has_supervisor_trace:
            return []
        rows = ((n, t.partition("\n")[0].strip()) for n, t in seen.texts.items() if t is not None)
        return [[f"file {name}", text[:LONGEST]] for name, text in rows if text != "0"]

    def _basis(self) -> list[list[str]]:
        """What is observed and what is inferred, in words."""
        owners = self._cell.partition.owners
        traced = [o.name for o in owners if o.index in self._follower.traced]
        other = [o.name for o in owners if o.index not in self._follower.traced]
        inferred = self._follower.inferred
        if self._has_supervisor_trace and not other:
            marking = "replayed: all sides write traces"
        elif self._has_supervisor_trace:
            marking = (
                f"replayed from the trace of {' and '.join(traced)}; what {' and '.join(other)} did is inferred, as a "
                f"shortest run that makes the next step possible ({inferred} steps so far)"
            )
        elif self._lost:
            marking = f"not known: {self._lost}"
        else:
            marking = (
                f"inferred from the messages alone, as a shortest run that explains them ({inferred} steps so far): "
                "the supervisor writes no trace"
            )
        if self._follower.wrong:
            marking += "; it stands still since a step that the net does not allow"
        messages = (
            "from the traces"
            if self._has_supervisor_trace
            else f"{self._observed.seen} seen in the shared files, {self._observed.missed} that came and went unseen"
        )
        recorded = [o.name for o in owners[1:] if self._robots.has_moved(o.index)]
        arms = (
            f"as recorded by {' and '.join(recorded)}"
            if recorded
            else "not recorded: they are drawn at HOME (`pn2code robot --trace` records them)"
        )
        rows = [["marking", marking], ["messages", messages], ["stop", NO_STOP]]
        return [*rows, ["arms", arms]] if self._cell.robot_cell.moving else rows

    def begin_again(self) -> None:
        """The next update is for pages that know nothing, and begins with how things are now."""
        self._kept = {name: [] for name in self._kept}
        self._anew()

    def _anew(self) -> None:
        """The same with what is kept of the past: only the marking is another one."""
        self._course = GrowingCourse(self._cell.partition.net)
        self._course.begin_unknown()
        if self._follower.game is not None and not self._lost:
            self._course.begin(self._follower.game)
        self._robots.begin_again()
        self._is_fresh = True

    def _lose(self, why: str) -> None:
        """The marking is not known any more."""
        self._lost = why
        self._anew()

    def close(self) -> None:
        """The session is over."""
        self._follower.close()


def nothing_yet(cell: WatchedCell, seen: Seen, why: str) -> Json:
    """The update of a cell that has not started."""
    with Watched(cell, "", 0.0, is_from_start=False) as watched:
        update = watched.update(0.0, seen, None)
    verdict = {"word": "has not started", "reason": why, "final": []}
    return {**update, "basis": [["cell", why]], "verdict": verdict}


def initial_of(given: Iterable[tuple[str, str]]) -> Json:
    """The markings of input files (name, JSON) in the form of a trace's header."""
    return {name: json.loads(text) for name, text in given}
