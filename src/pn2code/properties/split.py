"""Conditions on bindings: a net in which each transition that they speak of is several, for each way they can turn out.

    split = Split.of(net, properties, group)   # fires(Drill, { r = 3 }): Drill with guard r = 3, and with not (r = 3)
    split.net, split.properties                # nothing in these speaks of bindings
    split.restore(trace)                       # a run of it becomes one of the net

The markings are those of the net, and so are the arcs between them: a condition is a guard more. A transition has as
many parts as its conditions can turn out together, so questions come in groups that do not need too many.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path

from pn2code.base.frozen import frozen
from pn2code.base.unused_name import unused_name
from pn2code.base.whole_file import whole_file
from pn2code.ml.core import terms as core
from pn2code.ml.core.types import BOOL, TFun
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.properties import meaning as m

MOST = 4
"""Conditions on one transition that one net is made for."""


class NoSplitError(Exception):
    """A property that cannot be asked so; the text says why.

    Args:
        about: the property.
    """

    def __init__(self, about: m.Property) -> None:
        super().__init__(
            f"`{about.name}` has more than {MOST} conditions on the bindings of one transition"
        )
        self.about = about


def is_about_bindings(p: m.Property) -> bool:
    """Whether a property has a condition on a binding."""
    return bool(_conditions(p))


def _conditions(p: m.Property) -> list[int]:
    found = (a.number for f in m.formulas(p.asked) for a in m.atoms(f) if a.kind == "fires so")
    return list(dict.fromkeys(found))


def groups(properties: m.Properties) -> Iterator[tuple[m.Property, ...]]:
    """Properties about bindings, those together that one net is made for.

    Raises:
        NoSplitError: a property has too many conditions on one transition.
    """
    group: list[m.Property] = []
    for p in filter(is_about_bindings, properties.properties):
        if _most(properties, [p]) > MOST:
            raise NoSplitError(p)
        if _most(properties, [*group, p]) > MOST:
            yield tuple(group)
            group = []
        group.append(p)
    if group:
        yield tuple(group)


def _most(properties: m.Properties, group: Sequence[m.Property]) -> int:
    """The most conditions on one transition."""
    used = {k for p in group for k in _conditions(p)}
    of = [properties.steps[k].transition for k in used]
    return max(map(of.count, of), default=0)


@frozen
class Split:
    """A net for some properties.

    Args:
        net: with the parts.
        names: of each part, that of the transition.
        properties: what is asked of it.
    """

    net: FlatNet
    names: tuple[str, ...]
    properties: m.Properties

    @staticmethod
    def of(net: FlatNet, properties: m.Properties, group: Sequence[m.Property]) -> Split:
        """For some of the properties."""
        used = dict.fromkeys(k for p in group for k in _conditions(p))
        made: list[FlatTransition] = []
        names: list[str] = []
        taken = {t.name for t in net.transitions}
        parts: dict[int, list[int]] = {}
        holds: dict[int, list[int]] = {k: [] for k in used}
        for t in net.transitions:
            own = [k for k in used if properties.steps[k].transition == t.index]
            for number, outcome in enumerate(product((True, False), repeat=len(own))):
                index = len(made)
                guards = [
                    properties.steps[k].exp if is_so else _negated(properties.steps[k].exp)
                    for k, is_so in zip(own, outcome, strict=True)
                ]
                name = t.name
                if own:
                    name = unused_name(f"{t.name}#{number + 1}", taken, "{}#{}")
                    taken.add(name)
                made.append(replace(t, index=index, name=name, guards=(*t.guards, *guards)))
                names.append(t.name)
                parts.setdefault(t.index, []).append(index)
                for k, is_so in zip(own, outcome, strict=True):
                    if is_so:
                        holds[k].append(index)
        translator = _Translator(parts, holds)
        asked = tuple(replace(p, asked=translator.asked(p)) for p in group)
        changed = m.Properties(asked, properties.predicates)
        return Split(replace(net, transitions=tuple(made)), tuple(names), changed)

    def restore(self, trace: Path) -> None:
        """Makes a trace of the parts one of the transitions.

        Raises:
            OSError: it cannot be read or written.
        """
        of = {t.name: name for t, name in zip(self.net.transitions, self.names, strict=True)}
        lines = []
        whole = trace.read_text(encoding="utf-8", errors="surrogateescape")
        for text in whole.rstrip("\n").split("\n"):  # other ends of lines may stand in tokens
            line = json.loads(text)
            if line.get("transition") in of:
                line["transition"] = of[line["transition"]]
            lines.append(json.dumps(line, ensure_ascii=False) + "\n")
        with whole_file(trace) as beside:
            beside.write_text("".join(lines), encoding="utf-8", errors="surrogateescape")


def _negated(exp: core.Exp) -> core.Exp:
    function = core.Builtin("Bool.not", TFun(BOOL, BOOL), exp.span, ())
    return core.Apply(function, exp, BOOL, exp.span)


@frozen
class _Translator:
    """Questions about transitions and conditions -> questions about parts.

    Args:
        parts: of a transition.
        holds: the parts in which a condition holds.
    """

    parts: dict[int, list[int]]
    holds: dict[int, list[int]]

    def asked(self, p: m.Property) -> m.Asked:
        match p.asked:
            case m.Linear(formula, fair):
                return self._linear(self.formula(formula), fair)
            case m.Response(first, second) as response:
                return replace(response, first=self.formula(first), second=self.formula(second))
            case other:
                return other

    def _linear(self, formula: m.Formula, fair: Sequence[m.Fairness]) -> m.Linear:
        """Fairness is of the whole transition: of one with parts it is said in the formula."""
        kept = []
        for one in fair:
            own = self.parts[one.transition]
            if len(own) == 1:
                kept.append(m.Fairness(one.strong, own[0]))
                continue
            enabled, fires = (
                m.disjunction(*(m.Atom(kind, i) for i in own)) for kind in ("enabled", "fires")
            )
            often = ("G", "F") if one.strong else ("F", "G")
            enabled = m.Op(often[0], (m.Op(often[1], (enabled,)),))
            again = m.Op("G", (m.Op("F", (fires,)),))
            formula = m.Op("implies", (m.Op("implies", (enabled, again)), formula))
        return m.Linear(formula, tuple(kept))

    def formula(self, f: m.Formula) -> m.Formula:
        if isinstance(f, m.Atom):
            if f.kind == "fires so":
                return m.disjunction(*(m.Atom("fires", i) for i in self.holds[f.number]))
            if f.kind in ("fires", "enabled"):
                return m.disjunction(*(m.Atom(f.kind, i) for i in self.parts[f.number]))
            return f
        return m.Op(f.operator, tuple(map(self.formula, f.parts)), f.step)
