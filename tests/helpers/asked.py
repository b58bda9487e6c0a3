"""Properties in tests: asked of the compiled explorer and of the judge, their runs looked at again.

net = Net.of(MUTEX)                       # or Net.load(path)
found = net.ask(explorers, ["deadlock free", "ltl G F fires(Enter)"], "mutex")
found[0].answer                           # "yes"
net.judge(found)                          # fails when the judge or the token game says something else
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from helpers import netbuilder
from helpers.explored import Explorers
from pn2code.diagnostics import Diagnostics
from pn2code.diagnostics.render import report
from pn2code.ml.elaborate import Elaborator
from pn2code.net import front
from pn2code.net.flat import FlatNet
from pn2code.properties import sources
from pn2code.properties.judge import Graph
from pn2code.properties.meaning import Properties
from pn2code.properties.questions import questions
from pn2code.verify.answers import confirm
from pn2code.verify.answers.properties import Answer, answers
from pn2code.verify.exploring.programs import Sizes, generated
from pn2code.verify.exploring.result import Exploration


@dataclass(frozen=True, slots=True)
class Found:
    """What was asked, the answers, and the exploration they come from."""

    properties: Properties
    answers: tuple[Answer, ...]
    exploration: Exploration


@dataclass(frozen=True, slots=True)
class Net:
    """A net whose properties can be asked."""

    flat: FlatNet
    elaborator: Elaborator

    @staticmethod
    def of(text: str) -> Net:
        """From the short form of `netbuilder`."""
        with tempfile.TemporaryDirectory() as folder:
            return Net.load(netbuilder.write(text, Path(folder) / "net.cpn"))

    @staticmethod
    def load(path: Path, values: Mapping[str, str] | None = None) -> Net:
        """From a file."""
        d = Diagnostics()
        found = front.examine(path, d, values)
        assert found.flat is not None and found.typed is not None, report(d)
        assert found.typed.elaborator is not None
        return Net(found.flat, found.typed.elaborator)

    def meaning(self, texts: Sequence[str]) -> Properties:
        """What properties mean."""
        d = Diagnostics()
        written = [sources.from_option(text, i) for i, text in enumerate(texts, 1)]
        bound = sources.bind(written, self.flat, self.elaborator, d)
        assert not d.items, report(d)
        return bound

    def ask(self, explorers: Explorers, texts: Sequence[str], name: str, *options: object) -> Found:
        """What the compiled explorer answers; all in one run."""
        asked = self.meaning(texts)
        folder = explorers.folder / name
        folder.mkdir(exist_ok=True)
        file = folder / "questions"
        file.write_text(questions(asked), encoding="ascii")
        sizes = Sizes.start(self.flat, {})
        while True:
            d = Diagnostics()
            files = generated(self.flat, {}, sizes, d, asked.predicates)
            assert files is not None, report(d)
            for one in files:
                (folder / one.path).write_text(one.text)
            explorers.compile_net(folder)
            more = ("--queries", file, "--query-trace-to", folder / "run-")
            said = explorers.said(folder, *more, *options).report
            error = said["error"]
            if not error or error["kind"] not in ("capacity", "memory"):
                break
            index = error["place"] if error["kind"] == "capacity" else None
            larger = sizes.larger(None if index is None else self.flat.places[index].name)
            assert larger is not None
            sizes = larger
        found = Exploration.of(self.flat, said, 0.0)
        return Found(asked, answers(asked, found.answers, found), found)

    def judge(self, found: Found, most: int = 3_000) -> None:
        """Compares with the judge; runs that are given as evidence must show what they should."""
        graph = Graph.of(self.flat, {}, found.properties, most=most)
        for answer in found.answers:
            expected = "yes" if graph.says(answer.about.asked) else "no"
            assert answer.answer == expected, (answer.about.holds, answer)
            assert confirm.problem(self.flat, {}, found.properties, answer) is None, answer
