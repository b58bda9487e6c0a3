"""The document `docs/conformance.md`: totals, then net by net."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from pn2code.engine_comparison import intended
from pn2code.engine_comparison.compare import QUESTIONS, Compared
from pn2code.engine_comparison.engine import ENGINE
from pn2code.engine_comparison.finding import NOTHING, Finding, State

HEAD = """# Conformance

This page compares, net by net, what pn2code does with published nets and what the engine of CPN Tools does with them.
It is made by `./dev conformance`; the nets themselves are not part of this project.

| column | question |
|---|---|
| verdict | do both accept the net, or both reject it? |
| elements | if it is rejected, are the same declarations and inscriptions wrong? |
| initial marking | is it the same for every place instance, character for character? |
| run | is a recorded random run of the engine (up to 40 steps) possible here, with the same final marking? |
| state space | are the numbers of nodes, arcs and dead markings the same, if the engine computed the whole space? |
| explorer | is the report of `pn2code verify` the engine's, line by line, from sizes and bounds to fairness? |
| compiled | does the compiled net agree with the reference token game on random walks? |

`yes`: agrees. `random`: the net draws random numbers (or reads files), which are not in a recording; everything that
does not depend on them agrees. `intended`: the engine has a known bug, or leaves the choice to chance. `unsupported`:
pn2code reports that it does not support the net. `NO`: differs. `–`: nothing to compare.
"""


def document(
    nets: Sequence[Compared],
    walks: Mapping[str, Finding],
    suite: Mapping[str, Finding],
    expressions: Mapping[str, Finding],
    about_walks: str = "",
    spaces: Mapping[str, Finding] = {},
) -> str:
    """The whole text, the same for the same findings.

    Args:
        nets: the nets of the corpus.
        walks: `corpus/nets/PATH` or `semantics-suite/NAME.cpn` -> whether the compiled net agrees with the token
            game; empty where that was not tried.
        suite: name -> finding, of the semantics suite.
        expressions: of CPN ML -> finding.
        about_walks: a sentence about the walks.
        spaces: path of a net of the corpus -> whether the compiled explorer agrees with the engine.
    """
    parts = [HEAD, "## Totals\n", *_totals(nets, walks, suite, expressions, spaces)]
    parts += ["", about_walks] if about_walks else []
    parts.append("")
    notes = [
        n
        for n in nets
        if n.state is not State.AGREES
        or _worse(_walk(n, walks))
        or _worse(spaces.get(n.path, NOTHING))
    ]
    parts += ["## Nets that need an explanation\n", *_notes(notes, walks, spaces), ""]
    parts += [ENGINE, intended.TEXT]
    parts += ["## Net by net\n", *_table(nets, walks, spaces), ""]
    parts += ["## The semantics suite\n", *_suite(suite, walks), ""]
    parts += ["## Expressions\n", *_expressions(expressions), ""]
    return "\n".join(parts)


def _worse(walk: Finding) -> bool:
    return walk.state not in (State.AGREES, State.NOTHING)


def _walk(net: Compared, walks: Mapping[str, Finding]) -> Finding:
    """Of nets that both accept."""
    found = walks.get(f"corpus/nets/{net.path}", NOTHING)
    return found if net.accepted else NOTHING


def _totals(
    nets: Sequence[Compared],
    walks: Mapping[str, Finding],
    suite: Mapping[str, Finding],
    expressions: Mapping[str, Finding],
    spaces: Mapping[str, Finding],
) -> Iterable[str]:
    accepted = [n for n in nets if n.accepted]
    runs = [n for n in accepted if n.runs]
    yield f"* {len(nets)} nets; the engine accepts {len(accepted)} of them."
    yield f"* Of these {len(runs)} are accepted and run here: {_percent(len(runs), len(accepted))}."
    absent = [n for n in accepted if n.surroundings]
    if absent:
        reason = "need a file (`use`) that is missing here; the engine had it"
        yield f"* {len(absent)} that the engine accepts {reason}."
    wrong = [
        n
        for n in nets
        if State.DIFFERS in (n.state, _walk(n, walks).state, spaces.get(n.path, NOTHING).state)
    ]
    yield f"* Nets with an answer that differs: {len(wrong)}."
    yield "\n| question | compared | yes | random | intended | unsupported | NO |\n|---|---|---|---|---|---|---|"
    for question in QUESTIONS:
        yield _count(question, [n.findings[question] for n in nets])
    if spaces:
        yield _count("explorer", spaces.values())
    if walks:
        yield _count("compiled", [_walk(n, walks) for n in nets])
    yield _count("semantics suite", suite.values())
    yield _count("expressions", expressions.values())


def _percent(part: int, whole: int) -> str:
    return f"{100 * part / whole:.1f} %" if whole else "–"


def _count(name: str, findings: Iterable[Finding]) -> str:
    states: list[State] = [f.state for f in findings if f.state is not State.NOTHING]
    order = (State.AGREES, State.RANDOM, State.INTENDED, State.UNSUPPORTED, State.DIFFERS)
    numbers = [len(states), *(states.count(s) for s in order)]
    return f"| {name} | {' | '.join(map(str, numbers))} |"


def _table(
    nets: Sequence[Compared], walks: Mapping[str, Finding], spaces: Mapping[str, Finding]
) -> Iterable[str]:
    columns = ["net", "engine", *QUESTIONS, "explorer", "compiled"]
    yield f"| {' | '.join(columns)} |\n|{'---|' * len(columns)}"
    for net in nets:
        findings = [net.findings[q] for q in QUESTIONS]
        findings += [spaces.get(net.path, NOTHING), _walk(net, walks)]
        cells = [_code(net.path), "accepts" if net.accepted else "rejects"]
        cells += [f.state.value for f in findings]
        yield f"| {' | '.join(cells)} |"


def _notes(
    nets: Sequence[Compared], walks: Mapping[str, Finding], spaces: Mapping[str, Finding]
) -> Iterable[str]:
    for net in nets:
        yield f"* {_code(net.path)}"
        named = [*net.findings.items(), ("explorer", spaces.get(net.path, NOTHING))]
        named.append(("compiled", _walk(net, walks)))
        for question, finding in named:
            if finding.note and finding.state not in (State.AGREES, State.NOTHING):
                yield f"  * {question}, {finding.state.value}: {_text(finding.note)}"
    if not nets:
        yield "Nothing."


def _suite(suite: Mapping[str, Finding], walks: Mapping[str, Finding]) -> Iterable[str]:
    yield "Each net asks one question; all markings and all binding elements of its state space are compared.\n"
    yield "| net | agrees | compiled | |\n|---|---|---|---|"
    for name, finding in sorted(suite.items()):
        walk = walks.get(f"semantics-suite/{name}.cpn", NOTHING)
        cells = [_code(name), finding.state.value, walk.state.value, _text(finding.note)]
        yield f"| {' | '.join(cells)} |"


def _expressions(found: Mapping[str, Finding]) -> Iterable[str]:
    others = {e: f for e, f in found.items() if f.state is not State.AGREES}
    yield f"{len(found)} expressions of CPN ML; {len(found) - len(others)} have the engine's value."
    for expression, finding in others.items():
        yield f"* {_code(expression)}, {finding.state.value}: {_text(finding.note)}"


def _code(text: str) -> str:
    return "`" + text.replace("|", "\\|") + "`"


def _text(note: str) -> str:
    return " ".join(note.split()).replace("|", "\\|")
