"""Declared functions that ask for `inst ()`, the number of the page instance: each use has the number of its own.

While one is declared it knows `inst`; then its name stands for its declaration (`InstanceFunction`), which is made
again where an inscription uses it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager

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
        is_of_functions = isinstance(dec, s.FunDec) or (
            isinstance(dec, s.ValDec)
            and all(isinstance(b.value, s.FnExp | s.NameExp) for b in dec.bindings)
        )
        if not is_of_functions:
            return False
        if isinstance(dec, s.FunDec) and not self._are_there and "inst" not in dec.span.text:
            return False  # of nearly all functions nothing more has to be looked at
        names, bound = names_in(dec)
        free = names - bound
        values = self._ctx.top.values
        return ("inst" in free and "inst" not in values) or any(
            isinstance(values.get(name), InstanceFunction) for name in free
        )

    @contextmanager
    def on_page(self, asks: bool) -> Iterator[None]:
        """While functions that ask for `inst ()` are declared, they know it."""
        values = self._ctx.top.values
        is_new = asks and "inst" not in values
        if is_new:
            values["inst"] = InstanceEntry()
        self._ctx.on_page = asks
        try:
            yield
        finally:
            self._ctx.on_page = False
            if is_new:
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
