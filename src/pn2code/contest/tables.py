"""A net and questions about it, as the text that the engine for place/transition nets reads (`cnative`: tables_read.c).

    tables = Tables.of(unfolding)
    tables.text([Reach(0, formula), ...])

Formulas of the contest speak of ids; here they become formulas about numbers of places and transitions. A coloured
place is the sum of its colours, a coloured transition is enabled if one of its bindings is.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from types import MappingProxyType

from pn2code.base.frozen import frozen
from pn2code.contest.formulas import (
    AtMost,
    Constant,
    Fireable,
    Formula,
    FormulaError,
    Op,
    Tokens,
    Truth,
)
from pn2code.net.flat import FlatNet
from pn2code.unfold.net import Unfolding
from pn2code.unfold.plain import PlainNet

_LONG = 1000
"""Characters from which on a list of transitions is written as ranges."""
MOST = 1 << 30
"""The largest number of tokens, and weight, that the engine reads (`cnative/src/tables/tables_read.c`)."""


@frozen
class Tables:
    """A place/transition net.

    Args:
        initial: tokens by place.
        pre: by transition, what it takes: place -> tokens.
        post: by transition, what it puts.
        places: id of a place in the file -> its places here.
        transitions: id of a transition in the file -> its transitions here.
        at_first: of a net without colours (uncoloured.py): what is enabled in the initial marking of the coloured one.
        enabled: that one of some transitions is enabled, in the engine's own words, once it was asked for.
        ranges: words for what is enabled -> the same, shorter.
        written: "arcs" -> the arcs, and the same in the engine's own words, once they were asked for.
    """

    initial: tuple[int, ...]
    pre: tuple[Mapping[int, int], ...]
    post: tuple[Mapping[int, int], ...]
    places: Mapping[str, tuple[int, ...]]
    transitions: Mapping[str, tuple[int, ...]]
    at_first: frozenset[str] | None = None
    enabled: dict[tuple[str, ...], str] = field(default_factory=dict, compare=False, repr=False)
    ranges: dict[str, str] = field(default_factory=dict, compare=False, repr=False)
    written: dict[str, tuple[object, str]] = field(default_factory=dict, compare=False, repr=False)

    def fits(self) -> bool:
        """Whether the engine can read it: reductions multiply weights, and put the tokens of places together."""
        weights = (n for t in (*self.pre, *self.post) for n in t.values())
        return max((*self.initial, *weights), default=0) <= MOST

    @staticmethod
    def of(unfolding: Unfolding) -> Tables:
        """The tables of an unfolded net.

        Raises:
            ValueError: it has inhibitor or reset arcs, or priorities, or lacks bindings that raise exceptions.
        """
        if unfolding.faults:
            raise ValueError("bindings that raise exceptions are not in the tables")
        if unfolding.has_priorities or any(t.inhibitors or t.resets for t in unfolding.transitions):
            raise ValueError("inhibitor arcs, reset arcs and priorities are not in the tables")
        made = PlainNet(
            unfolding.initial,
            tuple(t.pre for t in unfolding.transitions),
            tuple(t.post for t in unfolding.transitions),
            tuple(t.transition for t in unfolding.transitions),
            unfolding.of_place,
        )
        return Tables.of_plain(unfolding.net, made)

    @staticmethod
    def of_plain(net: FlatNet, unfolded: PlainNet) -> Tables:
        """The tables of a net that was unfolded without names."""
        of: dict[int, list[int]] = {t.index: [] for t in net.transitions}
        for i, t in enumerate(unfolded.transition):
            of[t].append(i)
        return Tables(
            unfolded.initial,
            unfolded.pre,
            unfolded.post,
            {name: unfolded.of_place[p.index] for p in net.places for name, _ in p.member_ids},
            {t.id: tuple(of[t.index]) for t in net.transitions},
        )

    def text(self, questions: Sequence[str], order: Sequence[int] = ()) -> str:
        """The net with questions in the engine's own words, for diagrams with an order of all places."""
        initial = " ".join(map(str, self.initial))
        lines = [f"{len(self.initial)} {len(self.pre)}", initial, *self._all_arcs()]
        lines += [str(len(questions)), *map(self._shortened, questions)]
        lines += [f"order {' '.join(map(str, order))}"] if order else []
        return "\n".join(lines) + "\n"

    def _shortened(self, question: str) -> str:
        """With long lists of bindings as ranges: they are numbered one after the other."""
        for words in list(self.enabled.values()):
            if len(words) > _LONG and len(words) <= len(question):
                short = self.ranges.get(words)
                if short is None:
                    short = self.ranges[words] = min(_as_ranges(words), words, key=len)
                question = f"{question} ".replace(f"{words} ", f"{short} ")[:-1]
        return question

    def _all_arcs(self) -> list[str]:
        """A line for each transition, all as one text: it is wanted for each task anew, and may be long."""
        key = (self.pre, self.post)
        made, text = self.written.get("arcs", (None, ""))
        if made != key:
            arcs = zip(self.pre, self.post, strict=True)
            text = "\n".join(f"{_arcs(pre)} {_arcs(post)}" for pre, post in arcs)
            self.written["arcs"] = key, text
        return [text] if self.pre else []

    def reach(self, number: int, formula: Formula) -> str:
        """The question whether a marking is reachable in which a formula without operators of time is true."""
        return f"{number} reach {self.formula(formula)}"

    def ctl(self, number: int, formula: Formula) -> str:
        """The question whether a formula of CTL holds in the initial marking."""
        return f"{number} ctl {self.formula(formula)}"

    def bound(self, number: int, tokens: Tokens) -> str:
        """The question for the most tokens that places hold together."""
        return f"{number} bound {self.sum(dict.fromkeys(self._places(tokens), 1), 0)}"

    def formula(self, f: Formula, written: Mapping[Formula, str] = MappingProxyType({})) -> str:
        """A formula of CTL in the engine's own words.

        Args:
            f: the formula.
            written: parts of it for which there are words.

        Raises:
            FormulaError: it is of another kind, or names a place or transition that the net does not have.
        """
        if f in written:
            return written[f]
        match f:
            case Truth(value):
                return "true" if value else "false"
            case AtMost(left, right):
                return self._comparison(left, right)
            case Fireable(names):
                if names not in self.enabled:
                    self.enabled[names] = self._one_enabled(names)
                return self.enabled[names]
            case Op("not", (part,)):
                return f"not {self.formula(part, written)}"
            case Op("and" | "or" as operator, parts):
                return f"{operator} {len(parts)} {self._all(parts, written)}"
            case Op("A" | "E" as path, (Op("X" | "F" | "G" | "U" as operator, parts),)):
                return f"{path}{operator} {self._all(parts, written)}"
        raise FormulaError(f"{f} is not a formula of CTL")

    def _one_enabled(self, names: Sequence[str]) -> str:
        found = sorted({t for name in names for t in self._of(self.transitions, name)})
        return f"enabled {len(found)} {' '.join(map(str, found))}".rstrip()

    def _all(self, parts: Sequence[Formula], written: Mapping[Formula, str]) -> str:
        return " ".join(self.formula(p, written) for p in parts)

    def _comparison(self, left: Constant | Tokens, right: Constant | Tokens) -> str:
        factors: dict[int, int] = {}
        limit = 0
        for side, sign in ((left, 1), (right, -1)):
            if isinstance(side, Constant):
                limit -= sign * side.value
            else:
                for p in self._places(side):
                    factors[p] = factors.get(p, 0) + sign
        return self.sum(factors, limit)

    @staticmethod
    def sum(factors: Mapping[int, int], limit: int) -> str:
        """The comparison `sum of factor * tokens <= limit`; `factors` by place."""
        terms = [f"{p} {n}" for p, n in sorted(factors.items()) if n]
        return f"sum {len(terms)} {' '.join(terms)} {limit}".replace("  ", " ")

    def _places(self, tokens: Tokens) -> Iterable[int]:
        return (p for name in tokens.places for p in self._of(self.places, name))

    @staticmethod
    def _of(known: Mapping[str, tuple[int, ...]], name: str) -> tuple[int, ...]:
        if name not in known:
            raise FormulaError(f"the net has no `{name}`")
        return known[name]


def _as_ranges(words: str) -> str:
    """`enabled` with transitions in ascending order as `among`, with ranges of them."""
    found = list(map(int, words.split()[2:]))
    first = [i for i, t in enumerate(found) if i == 0 or t != found[i - 1] + 1]
    ranges = [f"{found[a]} {b - a}" for a, b in zip(first, [*first[1:], len(found)], strict=True)]
    return f"among {len(found)} {len(ranges)} {' '.join(ranges)}"


def _arcs(tokens: Mapping[int, int]) -> str:
    return " ".join([str(len(tokens)), *(f"{p} {n}" for p, n in tokens.items())])
