"""Questions to the explorer: random graphs and formulas against the definitions, and runs that prove the answers."""

from __future__ import annotations

from random import Random

import pytest

from helpers.explored import Explorers
from helpers.questions import Asked, Automaton, Items, Lts, accepts, ask, is_run, longest_wait
from helpers.thorough import amount

pytestmark = pytest.mark.cc

LABELS = 4
CONDITIONS = 4
OPERATORS = ("not", "and", "or", "ex", "ax", "ef", "af", "eg", "ag", "eu", "au", "exa")


def graph_net(random: Random, *, timed: bool, long: int = 0) -> tuple[str, list[str]]:
    """A net that walks through a random graph with labelled arcs (timed: without cycles), and random conditions.

    There is a way through the first `long` nodes.
    """
    nodes = max(random.randint(2, 9), long)
    many = random.choice([1.0, 1.6, 2.5]) if not long else 0.6
    arcs = {(random.randrange(LABELS), u, u + 1) for u in range(long - 1)}
    for _ in range(int(nodes * many)):
        u, v = random.randrange(nodes), random.randrange(nodes)
        if timed and u == v:
            continue
        arcs.add((random.randrange(LABELS), min(u, v) if timed else u, max(u, v) if timed else v))
    lines = [
        "net Walk",
        f"colset N = int with 0..{nodes}{' timed' if timed else ''};",
        "var u, v : N;",
        "place S : N = 1`0",
    ]
    for t in range(LABELS):
        pairs = ", ".join(f"({u}, {v})" for label, u, v in sorted(arcs) if label == t) or "(~1, ~1)"
        delay = f" @+ {random.randint(0, 3)}" if timed else ""
        lines += [
            f"trans T{t} guard [List.exists (fn (a, b) => a = u andalso b = v) [{pairs}]]",
            "  in S : u",
            f"  out S : v{delay}",
        ]
    text = "\n".join([lines[0], *("  " + line for line in lines[1:])]) + "\n"
    conditions = []
    for _ in range(CONDITIONS):
        chosen = sorted(random.sample(range(nodes), random.randint(1, nodes)))
        tokens = "(ms S)" if timed else "S"
        conditions.append(f"List.all (fn x => List.exists (fn y => x = y) {chosen}) {tokens}")
    return text, conditions


def leaves_of(lts: Lts, conditions: list[str]) -> list[set[int]]:
    """Where the conditions hold, from the markings."""
    found = []
    for c in conditions:
        chosen = {int(x) for x in c[c.index("[") + 1 : c.index("]")].split(",")}
        found.append({i for i, m in enumerate(lts.markings) if m["Top.S"][0][1] in chosen})
    return found


def random_items(random: Random, count: int) -> list[str]:
    lines = ["true", "dead", "initial"]
    lines += [f"pred {i}" for i in range(CONDITIONS)] + [f"enabled {t}" for t in range(LABELS)]
    while len(lines) < count:
        a, b = random.randrange(len(lines)), random.randrange(len(lines))
        word = random.choice(OPERATORS)
        match word:
            case "exa":
                lines.append(f"exa {random.randrange(LABELS)} {a}")
            case "and" | "or" | "eu" | "au":
                lines.append(f"{word} {a} {b}")
            case _:
                lines.append(f"{word} {a}")
    return lines


def random_automaton(random: Random, items: int) -> Automaton:
    states = random.randint(1, 3)
    edges = []
    for _ in range(random.randint(1, 2 * states + 2)):
        literals = []
        for _ in range(random.choice([0, 0, 1, 1, 2])):
            sign = random.choice("+-")
            literals.append(
                f"{sign}f{random.randrange(LABELS)}"
                if random.random() < 0.4
                else f"{sign}{random.randrange(items)}"
            )
        edges.append((random.randrange(states), random.randrange(states), tuple(literals)))
    labels = random.sample(range(LABELS), LABELS)
    fair = random.choice([0, 0, 1, 2])
    accepting = frozenset(s for s in range(states) if random.random() < 0.6)
    return Automaton(
        states, accepting, tuple(edges), tuple(labels[:fair]), tuple(labels[fair : fair * 2])
    )


def event(random: Random, items: int) -> str:
    return random.choice([f"s{random.randrange(items)}", f"f{random.randrange(LABELS)}"])


def check_ctl(asked: Asked, conditions: list[str], random: Random) -> None:
    """`initially` and `invariant` of random items."""
    lines = random_items(random, 40)
    found, answers = asked.say([*lines, *(f"? initially {i}" for i in range(len(lines))),
                                *(f"? invariant {i}" for i in range(len(lines)))])  # fmt: skip
    lts = Lts.of(found)
    items = Items(lts, leaves_of(lts, conditions))
    for line in lines:
        items.add(line)
    for i, line in enumerate(lines):
        first, second = answers[i], answers[len(lines) + i]
        assert first["answer"] == ("yes" if 0 in items.sets[i] else "no"), (i, line, lines)
        outside = sorted(items.all - items.sets[i])
        assert second["answer"] == ("no" if outside else "yes"), (i, line, lines)
        assert second["node"] == (outside[0] + 1 if outside else None)
        if outside:
            nodes, _ = lts.follow(second["trace"])
            assert nodes[-1] == outside[0] and second["steps"] == len(nodes) - 1
        check_evidence(lts, items, line, 0 in items.sets[i], first)


def check_part(asked: Asked, conditions: list[str], random: Random) -> int:
    """`initially` and runs in a part of the graph: known is only what is so in the whole; gives how much is known."""
    lines = random_items(random, 40)
    automata = [random_automaton(random, len(lines)) for _ in range(10)]
    asks = [f"? initially {i}" for i in range(len(lines))] + [
        x for a in automata for x in a.lines()
    ]
    found, whole = asked.say([*lines, *asks])
    lts = Lts.of(found)
    items = Items(lts, leaves_of(lts, conditions))
    for line in lines:
        items.add(line)
    known = 0
    for order in ("bfs", "bfs", "dfs", "dfs"):
        most = random.randint(2, max(2, len(lts.arcs) - 1))
        options = ("--max-states", most, "--threads", 1, "--order", order)
        _, part = asked.say([*lines, *asks], *options)
        for i, (one, of_part) in enumerate(zip(whole, part, strict=True)):
            assert of_part["answer"] in (one["answer"], "unknown"), (i, lines, most, order)
            known += of_part["answer"] != "unknown"
            if i < len(lines) and of_part["answer"] != "unknown":
                check_evidence(lts, items, lines[i], 0 in items.sets[i], of_part)
            elif i >= len(lines) and of_part["answer"] == "yes":
                nodes, labels = lts.follow(of_part["trace"])
                assert is_run(lts, items, automata[i - len(lines)], nodes, labels, of_part["loop"])
    return known


def check_early(asked: Asked, conditions: list[str], random: Random) -> None:
    """Invariants that one state decides, alone: the exploration ends early, with the same answer."""
    leaves = random_items(random, 3 + CONDITIONS + LABELS)
    local = ["not 8", "not 1", "or 3 12", "and 5 11", "or 4 9", "not 10"]
    found, _ = asked.say(["true", "ef 0", "? initially 1"])
    lts = Lts.of(found)
    items = Items(lts, leaves_of(lts, conditions))
    for line in [*leaves, *local]:
        items.add(line)
    for i in random.sample(range(1, len(items.sets)), 5):
        found, (answer,) = asked.say([*leaves, *local, f"? invariant {i}"], "--threads", 2)
        outside = sorted(items.all - items.sets[i])
        assert answer["answer"] == ("no" if outside else "yes")
        assert found.report["why"] == ("decided" if outside else "complete")
        assert answer["node"] == (outside[0] + 1 if outside else None)
        if outside:
            nodes, _ = lts.follow(answer["trace"])
            assert nodes[-1] == outside[0]


def check_evidence(
    lts: Lts, items: Items, line: str, holds: bool, answer: dict[str, object]
) -> None:
    """The run of an outermost operator that one run can show."""
    word, *numbers = line.split()
    shows = (word in ("ag", "af", "ax", "au") and not holds) or (
        word in ("ef", "eg", "ex", "eu", "exa") and holds
    )
    if not shows:
        return
    assert answer["trace"] is not None, line
    nodes, labels = lts.follow(str(answer["trace"]))
    assert answer["steps"] == len(labels)
    loop = answer["loop"]
    if loop is not None:
        assert isinstance(loop, int) and nodes[loop] == nodes[-1] and loop < len(labels)
    ends = not lts.arcs[nodes[-1]] or loop is not None
    sets = items.sets
    a, b = sets[int(numbers[-2 if word in ("au", "eu") else -1])], sets[int(numbers[-1])]
    match word:
        case "ag" | "ef":
            assert any((n in a) == holds for n in nodes)
        case "eg" | "af":
            assert all((n in a) == holds for n in nodes) and ends
        case "ex" | "ax":
            assert (nodes[1] in a) == holds
        case "exa":
            assert nodes[1] in a and labels[0] == int(numbers[0])
        case "eu":
            at = next(i for i, n in enumerate(nodes) if n in b)
            assert all(n in a for n in nodes[:at])
        case "au":
            before = [n for n in nodes if n not in b]
            assert len(before) == len(nodes) and (nodes[-1] not in a or ends)


def check_runs(asked: Asked, conditions: list[str], random: Random, count: int) -> int:
    """Random automata; gives how many of them accept a run."""
    lines = random_items(random, 14)
    automata = [random_automaton(random, len(lines)) for _ in range(count)]
    found, answers = asked.say([*lines, *(line for a in automata for line in a.lines())])
    lts = Lts.of(found)
    items = Items(lts, leaves_of(lts, conditions))
    for line in lines:
        items.add(line)
    yes = 0
    for a, answer in zip(automata, answers, strict=True):
        assert answer["answer"] == ("yes" if accepts(lts, items, a) else "no"), a.lines()
        if answer["answer"] == "yes":
            yes += 1
            nodes, labels = lts.follow(answer["trace"])
            assert len(labels) == answer["steps"]
            assert is_run(lts, items, a, nodes, labels, answer["loop"]), (a.lines(), nodes, answer)
    return yes


def check_waits(asked: Asked, conditions: list[str], random: Random, *, timed: bool) -> None:
    lines = random_items(random, 14)
    kind = "within-time" if timed else "within-firings"
    asks = [
        (event(random, 14), event(random, 14), random.choice(["-", "0", "1", "2", "4"]))
        for _ in range(40)
    ]
    found, answers = asked.say([*lines, *(f"? {kind} {f} {g} {n}" for f, g, n in asks)])
    lts = Lts.of(found)
    items = Items(lts, leaves_of(lts, conditions))
    for line in lines:
        items.add(line)
    for (f, g, n), answer in zip(asks, answers, strict=True):
        ends, longest = longest_wait(lts, items, f, g, time=timed)
        if not ends:
            assert (answer["answer"], answer["value"]) == ("no", None), (f, g, n)
            nodes, labels = lts.follow(answer["trace"])
            check_endless(lts, items, f, g, nodes, labels, answer["loop"])
            continue
        too_long = n != "-" and longest is not None and longest > float(n)
        assert answer["answer"] == ("no" if too_long else "yes"), (f, g, n, longest)
        assert answer["value"] == longest, (f, g)
        if too_long:
            nodes, labels = lts.follow(answer["trace"])
            check_too_long(lts, items, f, g, nodes, labels, float(n), timed=timed)


def happenings(items: Items, e: str, nodes: list[int], labels: list[int]) -> set[tuple[int, int]]:
    """When an event happens in a run: (i, 1) at marking i, (i, 0) at firing i."""
    number = int(e[1:])
    if e[0] == "s":
        return {(i, 1) for i, n in enumerate(nodes) if n in items.sets[number]}
    return {(i + 1, 0) for i, t in enumerate(labels) if t == number}


def check_endless(
    lts: Lts, items: Items, f: str, g: str, nodes: list[int], labels: list[int], loop: int | None
) -> None:
    if loop is None:
        assert not lts.arcs[nodes[-1]]
    else:  # once more around
        nodes, labels = nodes + nodes[loop + 1 :], labels + labels[loop:]
    ends = happenings(items, g, nodes, labels)
    same = 0 if f[0] == g[0] == "s" else 1
    assert any(
        not any(y > x or (y == x and same == 0) for y in ends)
        for x in happenings(items, f, nodes, labels)
    )


def check_too_long(
    lts: Lts, items: Items, f: str, g: str, nodes: list[int], labels: list[int], most: float, *, timed: bool
) -> None:  # fmt: skip
    times = [lts.times[n] if timed else float(i) for i, n in enumerate(nodes)]
    ends = happenings(items, g, nodes, labels)
    same = f[0] == g[0] == "s"
    assert any(
        times[-1] - times[x[0]] > most
        and not any(
            (y > x or (same and y == x)) and times[y[0]] - times[x[0]] <= most for y in ends
        )
        for x in happenings(items, f, nodes, labels)
    )


@pytest.mark.parametrize("part", range(3))
def test_random_graphs(explorers: Explorers, part: int) -> None:
    yes = 0
    for number in range(amount(4, 60)):
        random = Random(1000 * part + number)
        text, conditions = graph_net(random, timed=False)
        asked = ask(explorers, text, conditions, f"graph{part}", width=number % 2)
        check_ctl(asked, conditions, random)
        check_early(asked, conditions, random)
        yes += check_runs(asked, conditions, random, 40)
        check_waits(asked, conditions, random, timed=False)
    assert yes > 20


def test_parts_of_random_graphs(explorers: Explorers) -> None:
    """What a part decides, whatever the rest is; too bold versions of it are wrong here."""
    known = 0
    for number in range(amount(5, 60)):
        random = Random(9000 + number)
        text, conditions = graph_net(random, timed=False, long=14)
        asked = ask(explorers, text, conditions, "part", width=number % 2)
        known += check_part(asked, conditions, random)
    assert known > 300


FORK = """net Fork
  colset N = int with 0..2;
  place S : N = 1`0
  trans Left
    in S : 0
    out S : 1
  trans Right
    in S : 0
    out S : 2
"""


def test_a_successor_that_is_missing(explorers: Explorers) -> None:
    """One way comes to it; the other one, which was not seen, does not."""
    asked = ask(explorers, FORK, ["S = [1]"], "fork")
    lines = ["pred 0", "af 0", "ef 0", "not 0", "eg 3", "ax 0"]
    asks = [f"? initially {i}" for i in (1, 2, 4, 5)]
    _, part = asked.say([*lines, *asks], "--max-states", 2, "--threads", 1)
    assert [x["answer"] for x in part] == ["unknown", "yes", "unknown", "unknown"]
    _, whole = asked.say([*lines, *asks])
    assert [x["answer"] for x in whole] == ["no", "yes", "yes", "no"]


def test_random_timed_graphs(explorers: Explorers) -> None:
    for number in range(amount(3, 40)):
        random = Random(7000 + number)
        text, conditions = graph_net(random, timed=True)
        asked = ask(explorers, text, conditions, "timed")
        check_ctl(asked, conditions, random)
        check_early(asked, conditions, random)
        check_waits(asked, conditions, random, timed=True)
        check_waits(asked, conditions, random, timed=False)
