"""Declared functions that ask for `inst ()`, the number of the page instance: each use has the number of its own.

While one is declared it knows `inst`; then its name stands for its declaration (`InstanceFunction`), which is made
again where an inscription uses it. What is computed while the net is opened, a constant or the bound of a colour set,
has the number 1 there, as in CPN Tools.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager

from pn2code.ml import codes
from pn2code.ml.core.instances import (
    asked_at,
    kept_function,
    opened,
    opened_outside,
    stores_functions,
)
from pn2code.ml.core.terms import Dec, Exp
from pn2code.ml.core.types import TFun
from pn2code.ml.parsing import advice
from pn2code.ml.parsing import syntax as s
from pn2code.ml.typing.context import Context
from pn2code.ml.typing.declared import declared_by, names_in, type_names_in
from pn2code.ml.typing.environment import (
    Entry,
    InstanceEntry,
    InstanceFunction,
    declared_at,
    type_at,
)


class InstanceFunctions:
    """Those of a net.

    Args:
        ctx: of its declarations.
    """

    def __init__(self, ctx: Context) -> None:
        self._ctx = ctx
        self._are_there = False

    def asks(self, dec: s.Dec) -> bool:
        """Whether it is a declaration of functions alone that ask for `inst ()`."""
        if not self.may_ask(dec) or not _is_of_functions(dec):
            return False
        names, bound = names_in(dec)
        free = names - bound
        values = self._ctx.top.values
        return ("inst" in free and "inst" not in values) or any(
            isinstance(values.get(name), InstanceFunction) for name in free
        )

    def may_ask(self, dec: s.Dec) -> bool:
        """Whether it may be that a declaration asks for `inst ()`: of nearly all nothing more has to be looked at."""
        mentions = "inst" in dec.span.text
        if mentions and isinstance(dec, s.FunctorDec):
            self._are_there = True  # whoever applies it need not mention it
        return mentions or self._are_there

    @contextmanager
    def on_page(self, asks: bool) -> Iterator[None]:
        """While something is declared that asks for `inst ()`, it knows it."""
        values = self._ctx.top.values
        is_new = asks and "inst" not in values
        entry = InstanceEntry()
        if is_new:
            values["inst"] = entry
        self._ctx.on_page = asks
        try:
            yield
        finally:
            self._ctx.on_page = False
            if values.get("inst") is entry:  # the declaration may make one of its own
                del values["inst"]

    def declare_anew(self, dec: s.Dec, before: Mapping[str, Entry]) -> None:
        """Keep a declaration of functions that ask for `inst ()`: it is declared again where one of them is used.

        Args:
            dec: the declaration.
            before: what the net's own names stood for before it.
        """
        top = self._ctx.top
        names, bound = names_in(dec)
        own = declared_by(dec)
        known = {name: declared_at(top, name) for name in (names | bound) - own}
        if isinstance(dec, s.ValDec):  # `val f = fn x => f x`: its own names may stand for others
            earlier = {n for b in dec.bindings if not b.recursive for n in names_in(b.value)[0]}
            known |= {name: before.get(name, top.parent) for name in earlier & own}
        types = {name: type_at(top, name) for name in type_names_in(dec)}
        found = (before.get(name) for name in sorted(names - own))
        needs = tuple(entry for entry in found if isinstance(entry, InstanceFunction))
        for name in own:
            top.values[name] = InstanceFunction(name, dec, known, types, bound, needs)
        self._are_there = True

    def at_opening(self, made: Sequence[Dec], before: Sequence[Dec]) -> Sequence[Dec]:
        """Declarations that are computed while the net is opened, with the number that there is then.

        Args:
            made: the declarations; an error says that something of them may ask later.
            before: those before them.
        """
        ctx = self._ctx
        first = next((at for dec in made if (at := asked_at(dec)) is not None), None)
        if first is None:
            return made
        made = [opened_outside(dec) for dec in made]
        for dec in made:
            at = asked_at(dec)
            why = "" if at is None else kept_function(dec, ctx.datatypes)
            if at is not None and not why and stores_functions((*before, *made), ctx.datatypes):
                why = "something that may be given functions"
            if at is not None and why:
                ctx.error(
                    codes.UNSUPPORTED_BUILTIN,
                    f"function `inst` is not supported here: {why} is declared, which may ask for it later, on a page",
                    at,
                    hint=advice.unsupported("inst"),
                )
                return made
        ctx.d.warning(codes.INSTANCE_AT_OPENING, _AT_OPENING, first, hint=_HINT)
        return [opened(dec) for dec in made]

    def bound(self, exp: Exp) -> Exp:
        """A text of a colour set that is computed while the net is opened."""
        at = asked_at(exp)
        if at is None:
            return exp
        if isinstance(exp.type, TFun):
            self._ctx.error(
                codes.UNSUPPORTED_BUILTIN,
                "function `inst` is not supported here: a value would belong to the colour set on one page and not on "
                "another",
                at,
                hint=advice.unsupported("inst"),
            )
        else:
            self._ctx.d.warning(codes.INSTANCE_AT_OPENING, _AT_OPENING, at, hint=_HINT)
        return opened(exp)


_AT_OPENING = (
    "`inst ()` is 1 here; in CPN Tools, too, until this declaration is changed and checked again"
)
_HINT = "no page is looked at while declarations are computed: write 1, or ask in a function that inscriptions call"


def _is_of_functions(dec: s.Dec) -> bool:
    """Whether it declares functions alone."""
    if isinstance(dec, s.LocalDec):
        return all(_is_of_functions(x) for x in (*dec.hidden, *dec.visible))
    return isinstance(dec, s.FunDec) or (
        isinstance(dec, s.ValDec)
        and all(isinstance(b.value, s.FnExp | s.NameExp) for b in dec.bindings)
    )
