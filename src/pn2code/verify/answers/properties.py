"""What the explorer has answered, in terms of the properties that were asked."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

from pn2code.base.frozen import frozen
from pn2code.properties import meaning as m
from pn2code.verify.answers import basis
from pn2code.verify.answers.reasons import clause
from pn2code.verify.exploring.limits import REACHED
from pn2code.verify.exploring.result import Exploration

Verdict = Literal["yes", "no", "inconclusive"]


@frozen
class Evidence:
    """A run that shows why.

    Args:
        trace: its file.
        steps: how many.
        loop: so many steps are before the cycle that the run goes round for ever; None: it has none.
        confirmed: whether the token game has played it, and it shows what it should.
    """

    trace: Path
    steps: int
    loop: int | None
    confirmed: bool = False

    def row(self) -> dict[str, Any]:
        """For `--json`."""
        return {
            "trace": str(self.trace),
            "steps": self.steps,
            "loop": self.loop,
            "confirmed": self.confirmed,
        }


@frozen
class Answer:
    """What is known of a property.

    Args:
        about: the property.
        answer: whether it is true.
        why: of "inconclusive": the reason, as a clause.
        evidence: a run, where one shows it.
        value: the number that decides: most tokens of a place, or the longest wait; None: there is none.
        node: of the marking that decides, in the numbering of the report.
        kept: whether a "yes" is kept when the programs of a cell do less than what was looked at.
        cell: the answer is about a cell as it runs.
        net: then what is so of the closed net, where that is known and differs; `net_why` says why it differs.
        net_evidence: a run of the closed net that shows it, where nothing is known of the cell.
        no_run: why there is no run where one would show the answer, and how to get it, as a clause.
    """

    about: m.Property
    answer: Verdict
    why: str = ""
    evidence: Evidence | None = None
    value: float | None = None
    node: int | None = None
    kept: bool = False
    cell: bool = False
    net: Verdict | None = None
    net_why: str = ""
    net_evidence: Evidence | None = None
    no_run: str = ""
    is_pumped: bool = False
    """a run shows it that is too long to be written: it repeats a round that can be repeated for ever"""
    is_of_part: bool = False
    """not all markings were seen, and what was seen decides"""
    assumes: tuple[str, ...] = ()
    """what a "yes" about a cell rests on that no state of it shows"""
    methods: tuple[str, ...] = ()
    """of the unfolded net, which have given it, in the words of the contest; (): it was explored"""
    certificate: Mapping[str, Any] | None = None
    """of the unfolded net, why nothing that decides is reachable (`answers.certificates`); None: there is none"""
    rests: str = ""
    """what it rests on without one, as a clause; "": that is not to be said"""

    @property
    def is_expected(self) -> bool:
        """Whether the answer is the one that the author expects."""
        return self.answer == ("yes" if self.about.expect else "no")

    @property
    def rests_on(self) -> str | None:
        """What has to be seen for this answer: a word of `basis`; None: there is no answer."""
        has_run = self.evidence is not None or self.is_pumped
        if self.methods and not has_run:
            return basis.UNFOLDED
        return basis.of_property(
            self.about, self.answer, has_run=has_run, is_of_part=self.is_of_part
        )

    def row(self) -> dict[str, Any]:
        """For `--json`."""
        return {
            "name": self.about.name,
            "says": self.about.says,
            "holds": self.about.holds,
            "kind": self.about.kind,
            "fair": list(self.about.fair),
            "expect": self.about.expect,
            "answer": self.answer,
            "why": self.why or None,
            "value": self.value,
            "node": self.node,
            "kept": self.kept,
            "about": "cell" if self.cell else "net",
            "net": self._net_row() if self.net else None,
            "evidence": None if self.evidence is None else self.evidence.row(),
            "no_run": self.no_run or None,
            "rests_on": self.rests_on,
            "assumes": list(self.assumes),
            "methods": list(self.methods),
            "certificate": self.certificate,
        }

    def _net_row(self) -> dict[str, Any]:
        run = None if self.net_evidence is None else self.net_evidence.row()
        return {"answer": self.net, "why": self.net_why, "evidence": run}


def answers(
    properties: m.Properties, said: Sequence[Mapping[str, Any]], found: Exploration
) -> tuple[Answer, ...]:
    """One for each property.

    Args:
        properties: what was asked.
        said: what the explorer prints of each question, in order; fewer: it came to nothing.
        found: the exploration.
    """
    nothing: Mapping[str, Any] = {"answer": "unknown", "why": found.why}
    padded = [*said, *[nothing] * (len(properties.properties) - len(said))]
    if found.covering is not None:  # no limit would have been high enough
        padded = [{**one, "why": found.why} if one.get("why") in REACHED else one for one in padded]
    is_part = not found.seen.arcs
    return tuple(
        _answer(p, one, is_part=is_part or bool(one.get("part")))
        for p, one in zip(properties.properties, padded, strict=True)
    )


def _answer(p: m.Property, said: Mapping[str, Any], *, is_part: bool) -> Answer:
    verdict: Verdict = "inconclusive"
    if said["answer"] in ("yes", "no"):
        # Of `reachable` it is asked whether nothing is reached, of `ltl` whether a path violates it.
        turned = isinstance(p.asked, m.Linear) or (
            isinstance(p.asked, m.Invariant) and not p.asked.wanted
        )
        verdict = "yes" if (said["answer"] == "yes") != turned else "no"
    why = said.get("why") or ""
    evidence = None
    if said.get("trace"):
        evidence = Evidence(Path(said["trace"]), said["steps"], said.get("loop"))
    return Answer(
        p,
        verdict,
        clause(why) if verdict == "inconclusive" else "",
        evidence,
        said.get("value"),
        said.get("node"),
        is_of_part=is_part and verdict != "inconclusive",
    )


def from_unfolded(answer: Answer, found: Exploration) -> Answer:
    """With what the unfolded net tells, where exploring has not decided.

    Raises:
        RuntimeError: both have decided, and they contradict each other.
    """
    u = found.unfolded
    if u is None:
        return answer
    if not u.is_asked:
        is_open = u.is_alone and answer.answer == "inconclusive"
        return replace(answer, why=clause(found.why)) if is_open else answer
    one = (u.told or {}).get(answer.about.name)
    if answer.answer != "inconclusive":
        if one is not None and one.holds != (answer.answer == "yes"):
            raise RuntimeError(f"the unfolded net is another one: {answer.about.holds}")
        return answer
    if one is None:
        why = clause(found.why)
        refused = (u.refused or {}).get(answer.about.name)
        if refused:
            more = "" if u.is_alone else f"{why}, and "
            why = f"{more}the unfolded net cannot be asked: {refused}"
        return replace(answer, why=why)
    evidence = None if one.run is None else Evidence(*one.run, None)
    is_shown = isinstance(answer.about.asked, m.Invariant | m.Bound)
    looked = (
        "walks and searches have found none in time"
        if is_shown
        else "none is looked for in the unfolded net"
    )
    has_run = not one.holds and evidence is None
    return Answer(
        answer.about,
        "yes" if one.holds else "no",
        evidence=evidence,
        no_run=looked if has_run and not isinstance(answer.about.asked, m.Branching) else "",
        methods=one.methods,
        certificate=one.certificate,
        rests=one.rests,
    )


def drawn(answer: Answer) -> Answer:
    """What is known where chance decides: only what was found shows that it is possible."""
    if answer.answer == "inconclusive" or answer.rests_on in (basis.MARKING, basis.RUN):
        return answer
    return Answer(answer.about, "inconclusive", clause("chance"))


def counted(answer: Answer) -> Answer:
    """What is known where the number of steps decides: what a run shows that the token game can play."""
    e = answer.evidence
    is_shown = isinstance(answer.about.asked, m.Invariant | m.Bound) and e is not None
    if answer.answer == "inconclusive" or is_shown:
        return answer
    return Answer(answer.about, "inconclusive", clause("steps"))


def kind(a: Answer) -> str:
    """How it came out: "good", "bad" or "open"."""
    return "open" if a.answer == "inconclusive" else "good" if a.is_expected else "bad"


def verdict(found: Sequence[Answer]) -> Verdict:
    """Of all together: "no" if one is not as expected, else "inconclusive" if one is not known."""
    if any(x.answer != "inconclusive" and not x.is_expected for x in found):
        return "no"
    return "inconclusive" if any(x.answer == "inconclusive" for x in found) else "yes"
