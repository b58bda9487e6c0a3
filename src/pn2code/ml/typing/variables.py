"""The variables of a net, and what their names mean where the net declares something else of that name."""

from __future__ import annotations

from collections.abc import Sequence, Set

from pn2code.diagnostics import Origin, Span
from pn2code.ml import codes
from pn2code.ml.core.colsets import Colset
from pn2code.ml.core.terms import Symbol
from pn2code.ml.typing.context import Context, suggestion
from pn2code.ml.typing.environment import Binding, BrokenEntry, ConEntry, HiddenEntry, Scope
from pn2code.ml.typing.inference import from_type


class Variables:
    """Those of a net.

    Args:
        ctx: of its declarations.
        library: what it may use without having declared it.

    Attributes:
        symbols: the variables by name.
        scope: what they are in arcs, guards and code segments.
    """

    def __init__(self, ctx: Context, library: Scope) -> None:
        self._ctx = ctx
        self._library_top = library
        self.symbols: dict[str, Symbol] = {}
        self.scope = Scope(ctx.top)

    def declare(self, names: Sequence[str], colset_name: str, origin: Origin) -> None:
        """`var names : colset_name`."""
        colset = self._ctx.colsets.get(colset_name)
        if colset_name not in self._ctx.colsets:
            self._ctx.errors += 1
            self._ctx.d.error(
                codes.UNKNOWN_COLOUR_SET,
                f"there is no colour set `{colset_name}`",
                origin,
                hint=suggestion(colset_name, self._ctx.colsets)
                or self._ctx.announced_hint(colset_name),
            )
        self._ctx.net_variables.update(names)
        for name in names:
            if colset is None:
                self.scope.values[name] = BrokenEntry()
                self.symbols.pop(name, None)
                continue
            declared = self._ctx.top.values.get(name)
            if declared is self._library_top.values.get(name):
                declared = None  # what the library has hides no variable
            if isinstance(declared, Binding | ConEntry) and name not in self.symbols:
                self._clash(name, origin, "inscriptions mean the value, which was declared first")
                continue
            old = self.symbols.get(name)
            if old is None:
                self._variable(name, colset)
            elif old.colset is not None and old.colset != colset:
                self._ctx.d.warning(
                    codes.VARIABLE_CLASH,
                    f"variable `{name}` of colour set `{old.colset.name}` is declared again, "
                    f"now of `{colset.name}`",
                    origin,
                    hint="rename one of them: as in CPN Tools, the first declaration counts everywhere",
                )

    def _variable(self, name: str, colset: Colset) -> None:
        """A variable of the net in arcs, guards and code segments."""
        symbol = self._ctx.fresh_symbol(name, colset.type, colset)
        self.symbols[name] = symbol
        self.scope.values[name] = Binding(
            name, from_type(colset.type, []), symbol=symbol, colset=colset
        )

    def redeclared(self, colset: Colset) -> None:
        """Variables get the colour set that has their colour set's name in the end, as in CPN Tools."""
        for name, symbol in list(self.symbols.items()):
            old = symbol.colset
            known = isinstance(self.scope.values.get(name), Binding)
            if known and old is not None and old.name == colset.name and old != colset:
                self._variable(name, colset)

    def hide(self, names: Set[str], at: Origin | Span) -> None:
        """Variables of the net that have become constructors: CPN Tools refuses the transitions that use them."""
        for name in sorted(names & self.symbols.keys()):
            if isinstance(self._ctx.top.values.get(name), ConEntry):
                self.scope.values[name] = HiddenEntry()
                self._clash(name, at, "the variable, which was declared first, cannot be used")

    def meet(self, names: Set[str], at: Origin | Span) -> None:
        """Variables of the net whose names are declared as values: each means what was declared first."""
        for name in sorted(names & self.symbols.keys()):
            if isinstance(self._ctx.top.values.get(name), Binding):
                self._clash(
                    name,
                    at,
                    "inscriptions mean the variable, which was declared first; "
                    "initial markings and declarations mean the value",
                )

    def forget_lost(self) -> None:
        """Takes variables away whose colour set has been taken away."""
        for name, symbol in list(self.symbols.items()):
            if symbol.colset is not None and symbol.colset.name not in self._ctx.colsets:
                del self.symbols[name]
                self.scope.values.pop(name, None)

    def _clash(self, name: str, at: Origin | Span, meaning: str) -> None:
        """What is declared first counts in arcs, guards and code segments, as in CPN Tools."""
        self._ctx.d.warning(
            codes.VALUE_CLASH,
            f"`{name}` is both a variable of the net and a value or function: {meaning}",
            at,
            hint="rename one of them",
        )
