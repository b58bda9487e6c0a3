"""Random small cells that follow a conversation, a little wrong: who tells whom what, in one order.

A conversation is a row of messages between the supervisor and two devices. What each of them says and hears is its
program, in which neighbours are put together into one transition: data with their flag, one message to each of two
readers, two messages that are waited for. Then something is changed: a message is not waited for (and is left at the
end), two are heard the other way round, or a transition gets a rival that needs less, or another value.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from random import Random

_HEAD = """net cell
  standard
  colset SAID = int with 1..2;
  var k, j, v, u: SAID;
  page Top
"""
SUPERVISOR, A, B = "S", "A", "B"
MOST_HEARD = 3


@dataclass
class _Step:
    heard: list[str] = field(default_factory=list)
    said: list[str] = field(default_factory=list)


def _reader(channel: str) -> str:
    return channel[1]


def _conversation(r: Random) -> list[str]:
    """The messages: a channel is called by its kind, its reader and its writer (`fSA`: a flag to S from A).

    Mostly whoever has heard something speaks next, and sometimes tells the third one as well.
    """
    found: list[str] = []
    who = SUPERVISOR
    told: set[str] = set()
    """what has been said, and is not known to have been heard"""
    while len(found) < 7:
        reader = r.choice([w for w in (SUPERVISOR, A, B) if w != who])
        found += [kind + reader + who for kind in r.choice(["f", "d", "df", "df"])]
        if r.random() < 0.35:
            (third,) = {SUPERVISOR, A, B} - {who, reader}
            more = [kind + third + who for kind in r.choice(["f", "d", "d", "df"])]
            found += more if not told & {*more} or r.random() < 0.1 else []
            told.update(more)
        who = reader if r.random() < 0.95 else who
        told = {c for c in told if _reader(c) != who}
    return found


def _program(r: Random, who: str, said: list[str]) -> list[_Step]:
    """What one of them does, one transition after the other."""
    steps: list[_Step] = []
    for channel in said:
        is_heard = _reader(channel) == who
        if who not in channel[1:]:
            continue
        last = steps[-1] if steps else None
        if is_heard:
            fits = last is not None and not last.said and channel not in last.heard
            if last is not None and fits and len(last.heard) < MOST_HEARD and r.random() < 0.4:
                last.heard.append(channel)
            else:
                steps.append(_Step(heard=[channel]))
            continue
        fits = last is not None and all(
            c != channel and (who == SUPERVISOR or c[:2] != channel[:2]) for c in last.said
        )
        if last is not None and fits and r.random() < 0.7:
            last.said.append(channel)
        else:
            steps.append(_Step(said=[channel]))
    return steps


def _changed(r: Random, steps: list[_Step]) -> None:
    """A little wrong."""
    hearing = [s for s in steps if s.heard]
    if not hearing:
        return
    step = r.choice(hearing)
    if r.random() < 0.5:
        step.heard.remove(r.choice(step.heard))
    else:
        other = r.choice(hearing)
        step.heard, other.heard = other.heard, step.heard


def _page(r: Random, who: str, steps: list[_Step], channels: list[str]) -> list[str]:
    own = [c for c in channels if who in c[1:]]
    lines = [f"  page P{who}"]
    lines += [f"    place {c} port {'in' if _reader(c) == who else 'out'} : SAID" for c in own]
    lines += ["    place W0 = 1", *(f"    place W{n + 1}" for n in range(len(steps)))]
    if who == SUPERVISOR:
        lines.append("    place Finished")
        steps = [*steps, _Step()]
    for n, step in enumerate(steps):
        is_last = who == SUPERVISOR and n == len(steps) - 1
        after = "Finished" if is_last else f"W{n + 1}"
        value = r.choice(["var", "var", "var", "1"])
        rival = _Step(heard=list(step.heard), said=list(step.said))
        has_rival = bool(step.heard) and r.random() < 0.2
        if has_rival and r.random() < 0.5:
            rival.heard.remove(r.choice(rival.heard))
            value = "var"  # a script that waits for one of several messages does not look into them
        lines += _transition(f"T{n}", f"W{n}", after, step, value)
        lines += _transition(f"R{n}", f"W{n}", after, rival, "var") if has_rival else []
    return lines


def _transition(name: str, before: str, after: str, step: _Step, value: str) -> list[str]:
    heard = [
        f"      in {c} : {'kjvu'[i] if value == 'var' else value}" for i, c in enumerate(step.heard)
    ]
    said = [f"      out {c} : 1" for c in step.said]
    return [
        f"    trans {name}",
        f"      in {before} : ()",
        f"      out {after} : ()",
        *heard,
        *said,
    ]


def talks(r: Random) -> tuple[str, str]:
    """The net and the cell.toml."""
    said = _conversation(r)
    whose = [SUPERVISOR, *(x for x in (A, B) if any(x in c[1:] for c in said))]
    programs = {who: _program(r, who, said) for who in whose}
    for _ in range(r.choice([0, 0, 0, 0, 1, 2])):
        _changed(r, programs[r.choice(whose)])
    used = {c for steps in programs.values() for s in steps for c in (*s.heard, *s.said)}
    heard = {c for steps in programs.values() for s in steps for c in s.heard}
    for steps in programs.values():
        for s in steps:
            s.said = [c for c in s.said if c in heard]
    channels = sorted(used & heard)
    pages: list[str] = []
    tops = [f"    place {c} : SAID" for c in channels]
    for who in whose:
        own = ", ".join(f"{c} -> {c}" for c in channels if who in c[1:])
        tops.append(f"    subst {'Supervisor' if who == SUPERVISOR else who} = P{who} ({own})")
        pages += _page(r, who, programs[who], channels)
    text = '[net]\nfile = "cell.cpn"\n[supervisor]\ninstance = "Supervisor"\n'
    text += 'final = ["Finished"]\norder = "documented"\n'
    owes_nothing = r.random() < 0.6
    for c in r.sample(channels, len(channels)):
        is_data = c[0] == "d" or (owes_nothing and c[2] == SUPERVISOR)
        kind = "data" if is_data else "flag"
        text += f'[[channel]]\nplace = "{c}"\nfile = "{c}.txt"\nkind = "{kind}"\n'
    text += "".join(f'[devices.{x}]\ninstance = "{x}"\n' for x in whose[1:])
    return _HEAD + "\n".join([*tops, *pages]) + "\n", text
