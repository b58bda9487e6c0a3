"""SPIN as a second judge of linear temporal logic: formulas over the Promela export of a net.

The model gets a variable for the transition that occurred last, so that `fires` can be said where SPIN, which has no
`X`, can say it: `G F fires(T)`, and `fires(T) -> X p` (at a marking that T led to, p). SPIN's own first step sets up
the initial marking; the formula is about what comes after it.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from helpers.asked import Net
from helpers.property_nets import DINNER, ENDING, MUTEX
from helpers.thorough import amount
from pn2code.convert import promela
from pn2code.diagnostics import Diagnostics
from pn2code.properties import meaning as m
from pn2code.properties.judge import Graph
from pn2code.unfold.unfold import unfold

pytestmark = pytest.mark.cc

_BOTH = {"and": "&&", "or": "||", "implies": "->", "iff": "<->", "U": "U", "R": "V"}
_ONE = {"not": "!", "F": "<>", "G": "[]"}

FORMULAS: dict[str, tuple[str, list[str]]] = {
    "mutex": (
        MUTEX,
        [
            "ltl G F fires(Enter)",
            "ltl G (tokens(Want) >= 1 -> F tokens(Crit) = 1)",
            "ltl G (fires(Enter) -> X (tokens(Crit) = 1 U tokens(Free) = 1))",
            "ltl tokens(Crit) = 0 U tokens(Want) = 2",
            "ltl tokens(Want) = 0 W tokens(Crit) = 1",
            "ltl G (fires(Ask) -> X (enabled(Enter) || tokens(Crit) = 1))",
            "ltl F G tokens(Idle) <= 1",
            "ltl G F tokens(Idle) = 2 || G F tokens(Want) = 2",
        ],
    ),
    "dinner": (
        DINNER,
        [
            "ltl F dead || G F fires(Down)",
            "ltl G F fires(Left)",
            "ltl G (tokens(Half) = 3 -> G tokens(Half) = 3)",
            "ltl (tokens(Half) < 3 W tokens(Eat) = 1) || F tokens(Half) = 3",
            "ltl G (fires(Right) -> X (tokens(Eat) = 1 U enabled(Left)))",
        ],
    ),
    "ending": (
        ENDING,
        [
            "ltl F tokens(Done) = 1",
            "ltl F (tokens(Done) = 1 || tokens(Lost) = 1)",
            "ltl G (fires(Lose) -> X G dead)",
            "ltl G (fires(Down) -> X !dead)",
            "ltl G (fires(Stop) -> X tokens(Lost) = 1)",
            "ltl tokens(Count) = 1 R tokens(Done) = 0",
        ],
    ),
}


@pytest.fixture(scope="module", autouse=True)
def _spin() -> None:
    if shutil.which("spin") is None or shutil.which("gcc") is None:
        pytest.skip("SPIN is not installed (apt-get install spin)")


class Model:
    """The Promela model of a net, and formulas about it."""

    def __init__(self, net: Net, asked: m.Properties) -> None:
        unfolded = unfold(net.flat, Diagnostics())
        assert unfolded is not None
        text = promela.emit(unfolded, Diagnostics(), source="net", version="test")
        assert text is not None
        self.net = net
        self.asked = asked
        self.counters: dict[str, list[str]] = {}
        for counter, place in re.findall(r"/\* (m\[\d+\])\s+([^*]*?)(?:\[.*\])? \*/", text):
            self.counters.setdefault(place.strip(), []).append(counter)
        self.guards: dict[str, list[str]] = {}
        lines = []
        for line in text.splitlines():
            found = re.match(r"  (?:do|::) ?", line) and re.match(
                r"  :: d_step \{ (.*?) -> (.*) \} /\* (.*?)(?:\[.*\])? \*/", line
            )
            if not found:
                lines.append(line)
                continue
            guard, body, name = found.groups()
            index = next(t.index for t in net.flat.transitions if t.name == name.strip())
            self.guards.setdefault(name.strip(), []).append(f"({guard})")
            lines.append(f"  :: d_step {{ {guard} -> last = {index + 1}; {body} }}")
        assert self.guards
        self.text = "\n".join(lines).replace("init {", "byte last;\nbit begun;\ninit {", 1)
        self.text = self.text.replace("\n  };\n", ";\n    begun = 1\n  };\n", 1)

    def dead(self) -> str:
        return f"!({' || '.join(g for own in self.guards.values() for g in own)})"

    def formula(self, f: m.Formula) -> str:
        if isinstance(f, m.Op):
            match f:
                case m.Op("G", (m.Op("F", (m.Atom("fires", t),)),)):
                    return f"([] <> (last == {t + 1} && !({self.dead()})))"
                case m.Op("implies", (m.Atom("fires", t), m.Op("X", (later,)))):
                    return f"(last == {t + 1} -> {self.formula(later)})"
                case _:
                    pass
            parts = [self.formula(x) for x in f.parts]
            if f.operator == "W":
                return f"(({parts[0]} U {parts[1]}) || ([] {parts[0]}))"
            if f.operator in _ONE:
                return f"({_ONE[f.operator]} {parts[0]})"
            return f"({parts[0]} {_BOTH[f.operator]} {parts[1]})"
        match f.kind:
            case "true":
                return "true"
            case "dead":
                return f"({self.dead()})"
            case "enabled":
                return f"({' || '.join(self.guards[self.net.flat.transitions[f.number].name])})"
            case "pred":
                return self.condition(self.asked.predicates[f.number].text)
            case other:
                raise AssertionError(other)

    def condition(self, text: str) -> str:
        """`tokens(Top'P 1) >= 1`."""
        found = re.fullmatch(r"tokens\((.*)\) (\S+) (\d+)", text)
        assert found is not None
        place = self.asked.predicates[self._number(text)].places[0][1]
        counters = self.counters[self.net.flat.places[place].name]
        operator = {"=": "==", "<>": "!="}.get(found[2], found[2])
        return f"(({' + '.join(counters)}) {operator} {found[3]})"

    def _number(self, text: str) -> int:
        return next(i for i, p in enumerate(self.asked.predicates) if p.text == text)

    def compile(self, folder: Path) -> None:
        """All formulas in one program."""
        claims = [
            f"ltl asked{i} {{ (!begun) U (begun && {self.formula(p.asked.formula)}) }}"
            for i, p in enumerate(self.asked.properties)
            if isinstance(p.asked, m.Linear)
        ]
        (folder / "net.pml").write_text("\n".join([self.text, *claims, ""]), encoding="utf-8")
        for command in (
            ["spin", "-a", "net.pml"],
            ["gcc", "-O0", "-w", "-DNOREDUCE", "-o", "pan", "pan.c"],
        ):
            done = subprocess.run(
                command, cwd=folder, capture_output=True, text=True, timeout=600, check=False
            )
            assert done.returncode == 0, done.stdout + done.stderr

    def holds(self, number: int, folder: Path) -> bool:
        """What SPIN says of a formula."""
        out = subprocess.run(
            ["./pan", "-a", "-m100000", "-w18", "-N", f"asked{number}"],
            cwd=folder, capture_output=True, text=True, timeout=600, check=False,
        ).stdout  # fmt: skip
        errors = re.search(r"errors: (\d+)", out)
        assert errors is not None and "max search depth too small" not in out, out
        # A claim that a prefix violates is an assertion of its own, `!(...)`.
        assert errors[1] == "0" or re.search(r"acceptance cycle|assertion violated +!\(", out), out
        return errors[1] == "0"


@pytest.mark.parametrize("name", [*FORMULAS][: amount(1, 99)])
def test_spin_agrees(name: str, tmp_path: Path) -> None:
    """The explorer agrees with the judge elsewhere; here the judge agrees with SPIN."""
    text, formulas = FORMULAS[name]
    net = Net.of(text)
    asked = net.meaning(formulas)
    model = Model(net, asked)
    graph = Graph.of(net.flat, {}, asked)
    answers = set()
    model.compile(tmp_path)
    for i, p in enumerate(asked.properties):
        assert isinstance(p.asked, m.Linear)
        expected = graph.says(p.asked)
        assert model.holds(i, tmp_path) == expected, p.holds
        answers.add(expected)
    assert answers == {True, False}
