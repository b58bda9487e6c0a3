"""Random cells with registers: a supervisor that sets them, and devices that look in different ways."""

from __future__ import annotations

from pathlib import Path
from random import Random

FRESH = "a told device has the value of the moment"
"""The name of a property that is true where there is a device that looks when it is told to."""


def write(folder: Path, seed: int) -> str:
    """Writes a cell; the property that holds of it, or "" where there is none."""
    r = Random(seed)
    names = ["first", "second", "third"][: r.choice((1, 2, 2, 3))]
    kinds = {name: r.choice(("told", "free", "waits")) for name in names}
    top, rounds = r.choice((1, 2, 3)), r.choice((1, 2))
    told = [n for n, kind in kinds.items() if kind == "told"]
    more = [_second(r)] if r.random() < 0.3 and told else []
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cell.cpnt").write_text(_net(r, kinds, told, top, rounds, more), encoding="utf-8")
    (folder / "cell.toml").write_text(_cell(kinds, told, more), encoding="utf-8")
    seen = (
        f"(size (Mark.{n.title()}'Used 1) = 0 orelse Mark.{n.title()}'Used 1 == Mark.Sup'limit 1)"
        for n in told
    )
    return f"always {{{' andalso '.join(seen)}}}" if told else ""


def _second(r: Random) -> str:
    return r.choice(("true", "false"))


def _net(
    r: Random, kinds: dict[str, str], told: list[str], top: int, rounds: int, more: list[str]
) -> str:
    ports = [
        "limit",
        *(["lamp"] if more else []),
        *(f"go_{n}" for n in told),
        *(f"end_{n}" for n in kinds),
    ]
    lines = [
        "standard",
        "colset LIMIT = int with 0..3;",
        "fun work () = ();",
        "var n, k : LIMIT;",
        "var b : BOOL;",
        "var i : INT;",
        "page Top",
        f"  place limit : LIMIT = 1`{top}",
        *([f"  place lamp : BOOL = 1`{more[0]}"] if more else []),
        *(f"  place {p}" for p in ports if p not in ("limit", "lamp")),
        f"  subst Supervisor = Sup ({', '.join(f'{p} -> {p}' for p in ports)})",
    ]
    for name, kind in kinds.items():
        own = ["limit -> limit", f"end -> end_{name}"]
        own += [f"go -> go_{name}", *(["lamp -> lamp"] if more else [])] if kind == "told" else []
        lines.append(f"  subst {name.title()} = {name.title()} ({', '.join(own)})")
    lines += [
        "page Sup",
        "  place limit port io : LIMIT",
        *(["  place lamp port io : BOOL"] if more else []),
        *(
            f"  place {p} port {'in' if p.startswith('end') else 'out'}"
            for p in ports
            if p not in ("limit", "lamp")
        ),
        f"  place Left : INT = 1`{rounds}",
        "  place Ready = ()",
        *(f"  place Told_{n}" for n in told),
        "  place Stopping",
        *(f"  place Ended_{n}" for n in kinds),
        "  place Finished",
        "  trans Round",
        "    guard [i > 0]",
        "    in Left : i",
        "    out Left : i - 1",
        "    in Ready : ()",
        "    in limit : n",
        f"    out limit : if n > 1 then n - 1 else {top}",
        *(["    in lamp : b", "    out lamp : not b"] if more and r.random() < 0.5 else []),
        *(f"    out go_{n} : ()" for n in told),
        *(f"    out Told_{n} : ()" for n in told),
    ]
    lines += [] if told else ["    out Ready : ()"]
    if told:
        lines += ["  trans Again", *(f"    in Told_{n} : ()\n    in end_{n} : ()" for n in told)]
        lines += ["    out Ready : ()"]
    others = [n for n in kinds if n not in told]
    lines += [
        "  trans Stop",
        "    in Left : 0",
        "    in Ready : ()",
        "    in limit : n",
        "    out limit : 0",
    ]
    lines += [
        "    out Stopping : ()",
        "  trans Done",
        "    in Stopping : ()",
        "    out Finished : ()",
    ]
    lines += [f"    in end_{n} : ()" for n in others]
    for name, kind in kinds.items():
        lines += [
            f"page {name.title()}",
            "  place limit port io : LIMIT",
            "  place end port out",
            "  place Idle = ()",
            *_READERS[kind](r, more),
        ]
    return "\n".join(lines) + "\n"


def _told(r: Random, more: list[str]) -> list[str]:
    looks = ["    both limit : k", *(["    both lamp : b"] if more else [])]
    return [
        "  place go port in",
        *(["  place lamp port io : BOOL"] if more else []),
        "  place Told",
        "  place Used : LIMIT",
        "  trans Take",
        "    in Idle : ()",
        "    in go : ()",
        "    out Told : ()",
        "  trans Use",
        "    in Told : ()",
        *looks,
        "    out Used : k",
        "  trans Work",
        *(["    code action (work ())"] if r.random() < 0.7 else []),
        "    in Used : k",
        "    out Idle : ()",
        "    out end : ()",
    ]


def _free(r: Random, more: list[str]) -> list[str]:
    return [
        "  place Busy",
        "  place Ended",
        "  trans Begin",
        "    guard [k > 0]",
        "    in Idle : ()",
        "    both limit : k",
        "    out Busy : ()",
        "  trans Work",
        "    code action (work ())",
        "    in Busy : ()",
        "    out Idle : ()",
        "  trans End",
        "    guard [k = 0]",
        "    in Idle : ()",
        "    in limit : k",
        "    out limit : k",
        "    out Ended : ()",
        "    out end : ()",
    ]


def _waits(r: Random, more: list[str]) -> list[str]:
    return [
        "  place Ended",
        "  trans End",
        "    in Idle : ()",
        "    both limit : 0",
        "    out Ended : ()",
        "    out end : ()",
    ]


_READERS = {"told": _told, "free": _free, "waits": _waits}


def _cell(kinds: dict[str, str], told: list[str], more: list[str]) -> str:
    lines = [
        '[net]\nfile = "cell.cpnt"\n[supervisor]\ninstance = "Supervisor"\nfinal = ["Finished"]'
    ]
    for name in ["limit", *(["lamp"] if more else [])]:
        lines.append(f'[[channel]]\nplace = "{name}"\nfile = "{name}.robcad"\nkind = "register"')
    for name in [*(f"go_{n}" for n in told), *(f"end_{n}" for n in kinds)]:
        lines.append(f'[[channel]]\nplace = "{name}"\nfile = "{name}.robcad"')
    lines.append('[primitives]\nwork = { command = "tool", action = "work", duration_s = 1.0 }')
    lines += [f'[devices.{n}]\ninstance = "{n.title()}"' for n in kinds]
    return "\n".join(lines) + "\n"
