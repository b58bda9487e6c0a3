"""The life of a party: how it starts, joins, stops, finishes and crashes (I7 to I10)."""

from __future__ import annotations

from collections.abc import Sequence

from pn2code.channel_model.faults import Fault
from pn2code.channel_model.places import ABSENT, FINISHED, RUNNING, STOPPED, Parts
from pn2code.ml.core.terms import Exp
from pn2code.net.builder import Arc


class LifeCycle(Parts):
    """The transitions of status files, locks and processes."""

    # --- the ends of a process -------------------------------------------------------------------

    def _stopping(self, o: int) -> None:
        """I10: nothing more is written but the status; then the lock is given up."""
        b, side = self.b, self.sides[o]
        s = self.number("s")
        last, leaving = self.memory(o, "last word"), self.memory(o, "leaving")
        ended = self.memory(o, "has finished")
        self.leaving.append(leaving)
        self.ended.append(ended)
        self.step(
            f"{side.name}.stops in fair weather",
            f"{side.name} stops although nobody has crashed",
            self.off(side.stopping),
            self.has(self.fair),
            self.wrong(Fault.STOP),
            at=self.local,
        )
        self.step(
            f"{side.name}.stops",
            "",
            self.off(side.stopping),
            b.absent(self.fair),
            *self._forgets(o, last),
            self.on(last),
            at=self.local,
        )
        said = [b.take(side.status, self.state("x", "w")), b.test(side.session, s)]
        self.step(
            f"{side.name}.says stopped",
            f"{side.name} writes `stopped` to {side.name}.status",
            self.off(last),
            *said,
            b.put(side.status, self.state(STOPPED)),
            self.on(leaving),
        )
        gone = [b.empties(side.locked), self.off(side.alive)]
        forgets = [b.empties(side.session)] if o else []
        self.step(
            f"{side.name}.leaves",
            f"{side.name} ends, and its lock is free",
            self.off(leaving),
            *gone,
            *forgets,
            self.on(side.off),
        )
        self.step(
            f"{side.name}.leaves in peace",
            f"{side.name} ends, and its lock is free",
            self.off(ended),
            *gone,
            *forgets,
            self.on(side.off if o else self.done),
        )

    def _finish(self, o: int, says: str, *why: Arc) -> None:
        b, side = self.b, self.sides[o]
        self.step(
            f"{side.name}.finishes",
            f"{side.name} {says}: it writes `finished` to {side.name}.status",
            self.off(side.calm),
            *why,
            b.take(side.status, self.state("x", "w")),
            b.test(side.session, self.number("s")),
            b.put(side.status, self.state(FINISHED)),
            *self._forgets(o, self.ended[o]),
            self.on(self.ended[o]),
        )

    def _crashing(self, o: int) -> None:
        b, side, k = self.b, self.sides[o], self.number("k")
        if (self.crashes.robots if o else self.crashes.supervisor) == 0:
            return
        self.step(
            f"{side.name}.crashes",
            f"{side.name} crashes: its memory is lost, its lock is free, the files stay",
            self.off(side.alive),
            b.take(self.budgets[o], k),
            b.put(self.budgets[o], b.plus(k, b.number(-1))),
            b.empties(self.fair),
            b.empties(side.locked),
            *([b.empties(side.session)] if o else []),
            *self._forgets(o),
            self.on(side.off),
            guard=b.less(b.number(0), k),
        )

    # --- the supervisor's life -------------------------------------------------------------------

    def _supervisor(self) -> None:
        b, side, robots = self.b, self.sides[0], self.sides[1:]
        name, s = side.name, self.number("s")
        here = self.memory(0, "started")
        self.step(
            f"{name}.starts",
            f"{name} is started",
            self.off(side.off),
            b.test(side.session, s),
            self.on(side.alive),
            self.on(here),
            guard=b.less(s, b.number(self.crashes.all_sessions)),
        )

        def then(what: str, says: str, *arcs: Arc, into: int | None = None) -> int:
            after = self.memory(0, what) if into is None else into
            self.step(f"{name}.{what}", f"{name} {says}", self.off(here), *arcs, self.on(after))
            return after

        nothing = b.pair(b.number(ABSENT), b.number(0))
        unsays = (
            "takes back its old status",
            f"empties {name}.status",
            b.take(side.status, self.state("x", "w")),
            b.put(side.status, nothing),
        )
        locks = ("locks", f"locks {name}.status", self.on(side.locked))
        for act in (unsays, locks) if self.rules.unsays_first else (locks, unsays):
            here = then(*act)
            self.begun.append(here)
        for robot in robots if self.rules.awaits_peers else ():
            self.step(
                f"{name}.gives up before {robot.name}",
                f"{name} finds {robot.name} of an earlier session alive, and gives up",
                self.off(here),
                self.has(robot.locked),
                self.on(self.leaving[0]),
            )
            here = then(
                f"finds no {robot.name}",
                f"finds that nobody holds the lock of {robot.name}.status",
                b.absent(robot.locked),
            )
            here = then(
                f"removes the status of {robot.name}",
                f"removes {robot.name}.status",
                b.take(robot.status, self.state("x", "w")),
                b.put(robot.status, nothing),
            )
        for f in self.files if self.rules.cleans else ():
            after = self.memory(0, f"cleaned {f.channel.file}")
            contents = [
                [self.off(f.zero)],
                [b.take(f.file, self.message(f, "w", "k"))],
                *([] if self.rules.renames else [[self.off(f.half)]]),
            ]
            for arcs in contents:
                what, says = f"cleans {f.channel.file}", f"empties {f.channel.file}"
                then(what, says, *arcs, self.on(f.zero), into=after)
            here = after
        self.step(
            f"{name}.announces itself",
            f"{name} writes `running` and its session to {name}.status",
            self.off(here),
            b.take(side.status, self.state("x", "w")),
            b.take(side.session, s),
            b.put(side.session, b.plus(s, b.number(1))),
            b.put(side.status, b.pair(b.number(RUNNING), b.plus(s, b.number(1)))),
            *self._begins(0),
        )
        for i, place in enumerate(self.partition.final_places):
            self._finish(0, f"holds a token in its final place {i + 1}", self.any(place))
        for robot in robots if self.rules.looks_after else ():
            seen = [self.off(side.calm), b.test(side.session, s), self.on(side.stopping)]
            self.step(
                f"{name}.sees {robot.name} stopped",
                f"{name} reads `stopped` in {robot.name}.status",
                *seen,
                b.test(robot.status, self.state(STOPPED)),
            )
            self.step(
                f"{name}.sees {robot.name} dead",
                f"{name} finds the lock of {robot.name}.status free, which says `running`",
                *seen,
                b.test(robot.status, self.state(RUNNING)),
                b.absent(robot.locked),
            )

    # --- a robot's life --------------------------------------------------------------------------

    def _robot(self, o: int) -> None:
        b, side, boss = self.b, self.sides[o], self.sides[0]
        name, s, w, x = side.name, self.number("s"), self.number("w"), self.number("x")
        seen, locked, emptied, sure = (
            self.memory(o, n) for n in ("saw the supervisor", "locked", "emptied", "joins")
        )
        runs = [b.test(boss.status, self.state(RUNNING)), self.has(boss.locked)]
        fresh = [b.test(side.status, self.state("x", "w"))] if self.rules.joins_once else []
        self.step(
            f"{name}.starts",
            f"{name} is started, and sees {boss.name} running",
            self.off(side.off),
            *runs,
            *fresh,
            b.put(side.session, s),
            self.on(side.alive),
            self.on(seen),
            guard=b.less(w, s) if fresh else None,
        )
        if not self.rules.unsays_first:  # the lock is that of the next supervisor
            self.step(
                f"{name}.starts in a dead session",
                f"{name} is started; it finds the lock of {boss.name}.status held, and an old `running` in it",
                self.off(side.off),
                *runs,
                self.has(self.begun[0]),
                self.wrong(Fault.DEAD),
            )
        self.step(
            f"{name}.locks",
            f"{name} locks {name}.status",
            self.off(seen),
            self.on(side.locked),
            self.on(locked),
        )
        self.step(
            f"{name}.takes back its old status",
            f"{name} empties {name}.status",
            self.off(locked),
            b.take(side.status, self.state("x", "w")),
            b.put(side.status, b.pair(b.number(ABSENT), b.number(0))),
            self.on(emptied),
        )
        same = b.test(side.session, s)
        if not self.rules.looks_again:
            self.step(f"{name}.is sure", "", self.off(emptied), self.on(sure), at=self.local)
        else:
            self.step(
                f"{name}.looks again",
                f"{name} sees {boss.name} still running in the same session",
                self.off(emptied),
                same,
                *runs,
                self.on(sure),
            )
            elsewhere = b.test(boss.status, self.state("x", "w"))
            changes: Sequence[tuple[list[Arc], Exp | None]] = (
                ([b.absent(boss.locked)], None),
                ([same, elsewhere], b.less(w, s)),
                ([same, elsewhere], b.less(s, w)),
                ([same, b.test(boss.status, self.state("x"))], b.less(b.number(RUNNING), x)),
            )
            for arcs, guard in changes:
                self.step(
                    f"{name}.does not join",
                    f"{name} sees that {boss.name} does not run in that session any more",
                    self.off(emptied),
                    *arcs,
                    self.on(self.leaving[o]),
                    guard=guard,
                )
        self.step(
            f"{name}.joins",
            f"{name} writes `running` and the session to {name}.status",
            self.off(sure),
            b.take(side.status, self.state("x", "w")),
            same,
            b.put(side.status, self.state(RUNNING)),
            *self._begins(o),
        )
        self._finish(
            o, f"reads `finished` in {boss.name}.status", b.test(boss.status, self.state(FINISHED))
        )
        if not self.rules.looks_after:
            return
        looks: Sequence[tuple[str, list[Arc], Exp | None]] = (
            ("stopped", [b.test(boss.status, self.state(STOPPED))], None),
            ("dead", [b.test(boss.status, self.state(RUNNING)), b.absent(boss.locked)], None),
            ("replaced", [b.test(boss.status, self.state("x", "w"))], b.less(w, s)),
            ("replaced", [b.test(boss.status, self.state("x", "w"))], b.less(s, w)),
        )
        words = {
            "stopped": f"reads `stopped` in {boss.name}.status",
            "dead": f"finds the lock of {boss.name}.status free, which says `running`",
            "replaced": f"does not find its session in {boss.name}.status",
        }
        for what, arcs, guard in looks:
            self.step(
                f"{name}.sees {boss.name} {what}",
                f"{name} {words[what]}",
                self.off(side.calm),
                same,
                *arcs,
                self.on(side.stopping),
                guard=guard,
            )
