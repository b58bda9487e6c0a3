"""Random cells whose supervisor sets registers, at which devices look in many ways.

    cell = random_cell(Random(7))
    cell.net, cell.toml, cell.claims

A device is told to look, or looks when it likes; in the state after it was told, or in the transition that takes the
flag; with guards, with a clock, with a choice; at one register or at two.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

from tools.adversary import claims
from tools.adversary.cells import Cell
from tools.adversary.claims import Claim, Moment, Run

KINDS = ("told", "told", "flagged", "chooses", "timed", "free", "waits", "keeps")
"""What a device may be."""
_ORDERED = ("told", "flagged", "chooses", "timed", "keeps")
"""Those that the supervisor tells to look."""
_MOST_CLAIMS = 6


@dataclass(frozen=True)
class _Reader:
    name: str
    kind: str
    has_lamp: bool
    works: bool

    @property
    def page(self) -> str:
        return self.name.title()

    @property
    def is_told(self) -> bool:
        return self.kind in _ORDERED


def random_cell(r: Random) -> Cell:
    """One of them."""
    has_lamp = r.random() < 0.35
    readers = [
        _Reader(name, kind, has_lamp and kind != "waits" and r.random() < 0.6, r.random() < 0.6)
        for name in ("first", "second", "third")[: r.choice((1, 1, 2, 2, 2, 3))]
        for kind in [r.choice(KINDS)]
    ]
    if len(readers) > 2:  # three that look when they like have too many states
        readers = [
            x if i < 2 else _Reader(x.name, "told", False, True) for i, x in enumerate(readers)
        ]
    has_lamp = any(x.has_lamp for x in readers)
    net = "\n".join(["net cell", *(f"  {line}" for line in _net(r, readers, has_lamp=has_lamp))])
    return Cell(
        f"{net}\n", _toml(readers, has_lamp=has_lamp), tuple(_claims(r, readers)), has_sensors=False
    )


# --- what is claimed -----------------------------------------------------------------------------


def fresh(page: str) -> Claim:
    """What a device uses is the value of the moment."""
    used, limit = f"Top.{page}.Used", "Top.limit"

    def broken(run: Run, _: bool) -> int | None:
        return next((i for i, at in enumerate(run) if _is_stale(at, used, limit)), None)

    seen = f"Mark.{page}'Used 1"
    return Claim(
        f"always {{size ({seen}) = 0 orelse {seen} == Mark.Sup'limit 1}}", (used, limit), broken
    )


def seen_late(page: str) -> Claim:
    """A device never has seen another value than that of the moment: mostly false."""
    mine, limit = f"Top.{page}.limit_seen", "Top.limit"

    def broken(run: Run, _: bool) -> int | None:
        return next((i for i, at in enumerate(run) if _is_stale(at, mine, limit)), None)

    return Claim(f"always {{Mark.{page}'limit 1 == Mark.Sup'limit 1}}", (mine, limit), broken)


def _is_stale(at: Moment, place: str, register: str) -> bool:
    return bool(at.tokens[place]) and at.held[place] != at.held[register]


def _claims(r: Random, readers: Sequence[_Reader]) -> Iterator[Claim]:
    for x in readers:
        if x.is_told:
            yield fresh(x.page)
    yield seen_late(r.choice(readers).page)
    places = [f"Top.{x.page}.{p}" for x in readers for p in _places(x)]
    mine = [f"Top.Supervisor.{p}" for p in ("Ready", "Stopping", "Finished", "Left")]
    everywhere = [*places, *mine]
    fires = [f"Top.{x.page}.{t}" for x in readers for t in _transitions(x)]
    made = (
        lambda: claims.never_both(*r.sample(everywhere, 2)),
        lambda: claims.reached(*r.sample(everywhere, 2)),
        lambda: claims.at_most(r.choice(everywhere), r.randint(0, 1)),
        lambda: claims.followed(*r.sample(everywhere, 2)),
        lambda: claims.followed_within(*r.sample(everywhere, 2), r.randint(1, 6)),
        lambda: claims.silent(r.choice(fires)),
        lambda: claims.not_before(*r.sample(fires, 2)),
        lambda: claims.ends_with(r.choice(everywhere)),
    )
    for _ in range(_MOST_CLAIMS):
        yield r.choice(made)()


def _places(x: _Reader) -> tuple[str, ...]:
    return ("Idle", "Told", "Used") if x.is_told else ("Idle", "Ended", "Busy")


def _transitions(x: _Reader) -> tuple[str, ...]:
    if x.kind == "waits":
        return ("End", "See limit in Idle")
    return ("Take", "Work") if x.is_told else ("Begin", "Work", "End")


# --- the net -------------------------------------------------------------------------------------


def _net(r: Random, readers: Sequence[_Reader], *, has_lamp: bool) -> Iterator[str]:
    top, rounds = r.choice((1, 2, 3)), r.choice((1, 1, 2))
    told = [x.name for x in readers if x.is_told]
    lamp = ["lamp"] if has_lamp else []
    flags = [*(f"go_{n}" for n in told), *(f"end_{x.name}" for x in readers)]
    yield from (
        "standard",
        "colset LIMIT = int with 0..3;",
        "colset TOLD = unit timed;",
        "fun work () = ();",
        "var n, k : LIMIT;",
        "var b : BOOL;",
        "var i : INT;",
        "page Top",
        f"  place limit : LIMIT = 1`{top}",
        *(f"  place {p} : BOOL = 1`{r.choice(('true', 'false'))}" for p in lamp),
        *(f"  place {p}" for p in flags),
    )
    ports = [f"{p} -> {p}" for p in ("limit", *lamp, *flags)]
    yield f"  subst Supervisor = Sup ({', '.join(ports)})"
    for x in readers:
        own = ["limit -> limit", f"end -> end_{x.name}"]
        own += [f"go -> go_{x.name}"] if x.is_told else []
        own += ["lamp -> lamp"] if x.has_lamp else []
        yield f"  subst {x.page} = {x.page} ({', '.join(own)})"
    yield from _supervisor(r, readers, told, flags, lamp, top, rounds)
    for x in readers:
        yield from _page(x)


def _supervisor(
    r: Random,
    readers: Sequence[_Reader],
    told: Sequence[str],
    flags: Sequence[str],
    lamp: Sequence[str],
    top: int,
    rounds: int,
) -> Iterator[str]:
    changes = ["in limit : n", f"out limit : if n > 1 then n - 1 else {top}"]
    sets_lamp = ["in lamp : b", "out lamp : not b"] if lamp else []
    early, late = (sets_lamp, []) if r.random() < 0.7 else ([], sets_lamp)
    tells = [x for n in told for x in (f"out go_{n} : ()", f"out Told_{n} : ()")]
    yield from (
        "page Sup",
        "  place limit port io : LIMIT",
        *(f"  place {p} port io : BOOL" for p in lamp),
        *(f"  place {p} port {'in' if p.startswith('end') else 'out'}" for p in flags),
        f"  place Left : INT = 1`{rounds}",
        "  place Ready = ()",
        *(f"  place Told_{n}" for n in told),
        "  place Between",
        "  place Stopping",
        "  place Finished",
    )
    begins = ["in Ready : ()", "in Left : i", "out Left : i - 1"]
    ends = tells if told else ["out Ready : ()"]
    if r.random() < 0.3:  # the value is set in a firing of its own, before or after the flag
        first, then = (changes, ends) if r.random() < 0.6 or not told else (ends, changes)
        yield from _step("Round", [*begins, *first, "out Between : ()"], "[i > 0]")
        yield from _step("Then", ["in Between : ()", *early, *then])
    else:
        yield from _step("Round", [*begins, *changes, *early, *ends], "[i > 0]")
    if told and r.random() < 0.3:  # it sets it while they work, too
        yield from _step(
            "Meanwhile",
            [f"in Told_{told[0]} : ()", f"out Told_{told[0]} : ()", *changes],
            "[n > 2]",
        )
    if told:
        heard = [x for n in told for x in (f"in Told_{n} : ()", f"in end_{n} : ()")]
        yield from _step("Again", [*heard, "out Ready : ()"])
    stops = ["in Left : 0", "in Ready : ()", "in limit : n", "out limit : 0", *late]
    yield from _step("Stop", [*stops, "out Stopping : ()"])
    others = [f"in end_{x.name} : ()" for x in readers if not x.is_told]
    yield from _step("Done", ["in Stopping : ()", "out Finished : ()", *others])


def _step(name: str, arcs: Sequence[str], guard: str = "", code: str = "") -> Iterator[str]:
    yield f"  trans {name}"
    yield from (f"    guard {guard}" for _ in [0] if guard)
    yield from (f"    code {code}" for _ in [0] if code)
    yield from (f"    {arc}" for arc in arcs)


def _page(x: _Reader) -> Iterator[str]:
    yield from (
        f"page {x.page}",
        "  place limit port io : LIMIT",
        *(["  place lamp port io : BOOL"] if x.has_lamp else []),
        "  place end port out",
        "  place Idle = ()",
    )
    code = "action (work ())" if x.works else ""
    lamp = ["both lamp : b"] if x.has_lamp else []
    if x.is_told:
        yield "  place go port in"
        yield f"  place Told{' : TOLD' if x.kind == 'timed' else ''}"
        yield "  place Used : LIMIT"
    else:
        yield "  place Busy"
        yield "  place Ended"
    looks = ["in limit : k", "out limit : k"] if x.kind == "keeps" else ["both limit : k"]
    after = ["in Used : k", "out Idle : ()", "out end : ()"]
    if x.kind == "flagged":
        yield from _step("Take", ["in Idle : ()", "in go : ()", *looks, *lamp, "out Used : k"])
        yield from _step("Work", after, code=code)
    elif x.kind == "chooses":
        yield from _step("Take", ["in Idle : ()", "in go : ()", "out Told : ()"])
        yield from _step("High", ["in Told : ()", *looks, *lamp, "out Used : k"], "[k > 1]")
        yield from _step("Low", ["in Told : ()", *looks, "out Used : k"], "[k <= 1]")
        yield from _step("Work", after, code=code)
    elif x.is_told:
        stamp = "@+1" if x.kind == "timed" else ""
        yield from _step("Take", ["in Idle : ()", "in go : ()", f"out Told : (){stamp}"])
        yield from _step("Use", ["in Told : ()", *looks, *lamp, "out Used : k"])
        yield from _step("Work", after, code=code)
    else:
        if x.kind == "free":
            yield from _step("Begin", ["in Idle : ()", *looks, *lamp, "out Busy : ()"], "[k > 0]")
            yield from _step("Work", ["in Busy : ()", "out Idle : ()"], code="action (work ())")
        yield from _step(
            "End", ["in Idle : ()", "both limit : 0", "out Ended : ()", "out end : ()"]
        )


# --- the cell ------------------------------------------------------------------------------------


def _toml(readers: Sequence[_Reader], *, has_lamp: bool) -> str:
    lines = [
        '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]',
        *(
            f'[[channel]]\nplace = "{name}"\nfile = "{name}.robcad"\nkind = "register"'
            for name in ("limit", *(["lamp"] if has_lamp else []))
        ),
        *(
            f'[[channel]]\nplace = "{name}"\nfile = "{name}.robcad"'
            for x in readers
            for name in (*([f"go_{x.name}"] if x.is_told else []), f"end_{x.name}")
        ),
        '[primitives]\nwork = { command = "tool", action = "work", duration_s = 1.0 }',
        *(f'[devices.{x.name}]\ninstance = "{x.page}"' for x in readers),
    ]
    return "\n".join(lines) + "\n"
