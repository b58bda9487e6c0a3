"""CPN ML that looks at markings: `Mark.Page'Place 1` stands for the multi-set of a place instance.

The number may be left out when the page has one instance. Only places that are named so are looked at, so no function
of the whole marking is needed: each becomes a variable of the condition.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field, fields, is_dataclass, replace
from typing import Any

from pn2code.base.frozen import record
from pn2code.diagnostics import Diagnostics, SourceText
from pn2code.ml.core.terms import Exp, Symbol, Var
from pn2code.ml.core.types import Type
from pn2code.ml.elaborate import Elaborator
from pn2code.ml.parsing import syntax as s
from pn2code.net import generative
from pn2code.net.flat import FlatNet, FlatTransition
from pn2code.net.predicate import marking_type
from pn2code.net.uses import walk
from pn2code.properties import codes
from pn2code.properties.names import Names

_STRUCTURE = "Mark."

Looks = tuple[tuple[Symbol, int], ...]
"""The places that an expression looks at, each with what stands for its multi-set."""


@record
class Marks:
    """Types conditions on markings.

    Args:
        net: the net.
        elaborator: knows its declarations.
        names: resolves the names of places.
        d: where errors go that are found after typing.
    """

    net: FlatNet
    elaborator: Elaborator
    names: Names
    d: Diagnostics
    _symbols: dict[int, Symbol] = field(default_factory=dict)

    def symbol(self, place: int) -> Symbol:
        """What stands for the multi-set of a place; the same in all conditions. Nobody can write its name."""
        if place not in self._symbols:
            t = marking_type(self.net.places[place])
            name = f"Mark {self.names.place_text(place)}"
            self._symbols[place] = self.elaborator.symbol(name, t)
        return self._symbols[place]

    def condition(self, text: SourceText) -> tuple[Exp, Looks] | None:
        """The typed condition and the places it looks at; None after a diagnostic."""
        used: dict[int, Symbol] = {}
        exp = self.elaborator.condition(text, self._prepare(used))
        return None if exp is None or self._is_refused(exp) else (exp, _looks(used))

    def expression(self, text: SourceText) -> tuple[Exp, Type, Looks] | None:
        """An expression of any type, its type, and the places it looks at; None after a diagnostic."""
        used: dict[int, Symbol] = {}
        found = self.elaborator.evaluation(text, self._prepare(used))
        return None if found is None or self._is_refused(found[0]) else (*found, _looks(used))

    def _is_refused(self, exp: Exp) -> bool:
        """Whether it may use exceptions of functions in a way that is not possible here."""
        return generative.refuse_beside(self.net.program.declarations, [exp], self.d)

    def _prepare(
        self, used: dict[int, Symbol]
    ) -> Callable[[s.Exp], tuple[s.Exp, dict[str, Symbol]] | None]:
        """What puts variables for markings into a syntax tree, and notes them in `used`."""
        failed = False

        def prepare(exp: s.Exp) -> tuple[s.Exp, dict[str, Symbol]] | None:
            changed = _rewritten(exp, mark)
            return None if failed else (changed, {x.name: x for x in used.values()})

        def mark(node: Any) -> Any:
            """The variable for `Mark.P` and `Mark.P 1`; None for all else."""
            nonlocal failed
            number: int | None = None
            name: Any = node
            if isinstance(node, s.ApplyExp) and isinstance(node.argument, s.LitExp):
                literal = node.argument
                if literal.kind is s.LitKind.INT and isinstance(literal.value, int):
                    name, number = node.function, literal.value
            if not isinstance(name, s.NameExp) or not name.name.startswith(_STRUCTURE):
                return None
            place = self.names.marked(name.name.removeprefix(_STRUCTURE), number, node.span)
            if place is None:
                failed = True
                return name
            used[place] = self.symbol(place)
            return s.NameExp(used[place].name, False, node.span)

        return prepare

    def of_binding(self, text: SourceText, t: FlatTransition, d: Diagnostics) -> Exp | None:
        """A typed condition on the variables of a transition; None after a diagnostic."""
        declared = {symbol.name: symbol for symbol in t.variables}
        exp = self.elaborator.condition(text, lambda parsed: (parsed, declared))
        if exp is None or self._is_refused(exp):
            return None
        late = {symbol.uid for symbol in t.code.outputs} if t.code else set()
        for part in walk(exp):
            if isinstance(part, Var) and part.symbol.uid in late:
                d.error(
                    codes.FORM,
                    f"`{part.symbol.name}` gets its value from the code segment, when `{t.short}` has been chosen",
                    part.span,
                    hint="write the condition about the place into which the value is put",
                )
                return None
        return exp


def _looks(used: dict[int, Symbol]) -> Looks:
    return tuple((used[place], place) for place in sorted(used))


def _rewritten(node: Any, change: Callable[[Any], Any]) -> Any:
    """A syntax tree with parts replaced by what `change` gives for them (None: look inside)."""
    if isinstance(node, tuple):
        made = tuple(_rewritten(x, change) for x in node)
        return node if all(a is b for a, b in zip(made, node, strict=True)) else made
    if not is_dataclass(node) or not s.is_node(node):
        return node
    changed = change(node)
    if changed is not None:
        return changed
    parts: dict[str, Any] = {}
    for f in fields(node):
        own = getattr(node, f.name)
        other = _rewritten(own, change)
        if other is not own:
            parts[f.name] = other
    return replace(node, **parts) if parts else node  # type: ignore[type-var]  # terms are dataclasses
