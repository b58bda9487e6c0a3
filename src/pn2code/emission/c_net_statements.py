"""IR statements of transitions and places -> lines of C: searches, tests of tokens, lists of moves."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pn2code.emission.c_expressions import Expressions, PackedPlace
from pn2code.emission.c_statements import INDENT, Statements
from pn2code.emission.c_sums import SumFunction
from pn2code.emission.c_types import Types
from pn2code.emission.names import Scope
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import Ir, Rep, Stmt
from pn2code.lowering.passes.moves import is_pair

_SCALARS = frozenset({Rep.BOOL, Rep.INT, Rep.CHAR, Rep.ENUM})
"""Representations whose values C compares with `==`."""


class NetStatements(Statements):
    """Prints the statements of one C function of a transition or place.

    What it has to know of the net, by number of the place, is assigned to it before the first statement.

    Attributes:
        tables_of_places: C names of the tables of their colour sets.
        multisets: pointers to their own tables, as C.
        timed: which of them are timed.
        slots: those that are kept as slots.
        token_types: types of their tokens.
        sums: by place and multi-set, functions of multi-sets that are known.
        number_of: gives the C function that numbers the colours of a colour set (key); "": it has none.
        moves: C name of the list of moves.
        variable_types: of the binding.
        keeps: the search may leave something in the arena, which is released where no binding refers to it.
        is_flat: the search calls the sink once at most, and last.
        may_fail: the search may have raised an exception before it gives a binding.
        releases: whether anything is released at all.
    """

    def __init__(
        self, types: Types, expressions: Expressions, scope: Scope, real_time: bool
    ) -> None:
        super().__init__(types, expressions, scope, real_time)
        self.tables_of_places: tuple[str, ...] = ()
        self.multisets: tuple[str, ...] = ()
        self.timed: tuple[bool, ...] = ()
        self.slots: frozenset[int] = frozenset()
        self.token_types: tuple[ir.IrType, ...] = ()
        self.sums: Mapping[tuple[int, Ir], SumFunction] = {}
        self.number_of: Callable[[str], str] = lambda key: ""  # "": not by number
        self.moves = "moves"
        self.variable_types: tuple[ir.IrType, ...] = ()
        self.keeps = False
        self.is_flat = False
        self.may_fail = False
        self.releases = True

    def _next(self) -> None:
        """Goes on with the next candidate."""
        if self._loops:
            self.line(INDENT + "continue;")
        else:
            self._depth += 1
            self.finish_search()
            self._depth -= 1
        self.line("}")

    def finish_search(self) -> None:
        """The end of an enumeration that was not stopped."""
        if self.keeps and self.releases and self.is_flat:
            self.line("pn_arena_release(cx->arena, mark);")
        elif self.keeps and self.releases:
            self.line("if (!is_kept) {")
            self.line(INDENT + "pn_arena_release(cx->arena, mark);")
            self.line("}")
        self.line("return;" if self.is_void else "return true;")

    def end_search(self) -> None:
        """What stands last in the function; without loops that is the only call of the sink."""
        if not self.is_flat:
            self.finish_search()

    def _other(self, s: Stmt) -> None:
        match s:
            case ir.ForTokens():
                self._for_tokens(s)
            case ir.ForValues():
                self._for_values(s)
            case ir.Bind(variable=variable, value=value):
                target = self._x.text(ir.Bound(variable, self.variable_types[variable]))
                self.line(f"{target} = {self._x.text(value)};")
            case ir.Unless(condition=condition, note=note):
                test = self._x.text(ir.Op("Bool.not", (condition,), ir.BOOL))
                self.line_with_note(f"if ({test}) {{", note)
                self._next()
            case ir.UnlessLegal(variable=variable, table=table):
                pointer = self._x.address(ir.Bound(variable, self.variable_types[variable]))
                number_of = self.number_of(table)
                if number_of:
                    self.line(f"if ({number_of}({pointer}) == PN_NO_COLOUR) {{")
                else:
                    self.line(f"if (!pn_is_legal(cx, &{self._names.table(table)}, {pointer})) {{")
                self._next()
            case ir.UnlessAvailable():
                self._unless_available(s)
            case ir.UnlessBind():
                self._unless_bind()
            case ir.UnlessHeld():
                if s.place in self.slots:
                    text, pointer = self._x.inside(s.value, 10), self._x.address(s.value)
                    differs = self._differs(s.place, text, pointer)
                    self.line_with_note(f"if ({differs}) {{", s.note)
                    self._next()
                    return
                if s.note:
                    self.note(s.note)
                pointer = self._x.address(s.value)
                if self.timed[s.place]:
                    multiset = self.multisets[s.place]
                    held = f"pn_multiset_count({multiset}, m, {pointer}, {self._x.time(s.limit)})"
                else:
                    held = self._x.call(s.place, "held", pointer)
                self.line(f"if ({held} < {s.count}U) {{")
                self._next()
            case ir.UnlessEmpty(place=place, note=note):
                self.note(note)
                if self.timed[place]:
                    self.line(
                        f"if (pn_multiset_available({self.multisets[place]}, m, cx->now) > 0U) {{"
                    )
                elif self._packed(place):
                    self.line(f"if (!{self._x.call(place, 'is_empty')}) {{")
                elif place in self.slots:
                    self.line(f"if ({self._x.tokens[place]}full) {{")
                else:
                    self.line(f"if ({self._x.tokens[place]}used > 0U) {{")
                self._next()
            case ir.Wanted():
                self._wanted(s)
            case ir.Yield():
                self._yield()
            case ir.Take() | ir.Put():
                self._move(s)
            case ir.TakeAll() | ir.PutAll():
                self._moves(s)
            case ir.Threshold(place=place, delay=delay, note=note):
                self.note(note)
                multiset, time = self.multisets[place], self._x.time(delay)
                self.line(f"pn_multiset_threshold({multiset}, m, cx->now, {time}, found, next);")
            case ir.Reset(place=place, note=note):
                self.note(note)
                self.line(f"pn_moves_reset(&{self.moves}, {self.multisets[place]}, cx->now);")

    def _packed(self, place: int) -> PackedPlace | None:
        return self._x.packed[place] if self._x.packed else None

    def _for_colours(self, s: ir.ForTokens, packed: PackedPlace) -> None:
        """The loop over the tokens of a packed place: over the numbers of the colours of which there are some."""
        i = self._x.local(s.index)
        start, step = (f"{i} = {self._x.call(s.place, 'next', at)}" for at in ("0U", f"{i} + 1U"))
        self.note(s.note)
        self.line(f"for (uint32_t {start}; {i} < {packed.colours}U; {step}) {{")
        self._loops += 1
        if any(isinstance(n, ir.TokenValue) and n.index == s.index for n in ir_nodes(s.body)):
            t = self._types.name(self.token_types[s.place])
            token = self._x.token(s.place, s.index)
            self.line(f"{INDENT}const {t} {token} = {packed.colour_of}({i});")
        self.block(s.body)
        self._loops -= 1
        self.line("}")

    def _for_tokens(self, s: ir.ForTokens) -> None:
        packed = self._packed(s.place)
        if packed:
            self._for_colours(s, packed)
            return
        if s.place in self.slots:
            self.line_with_note(f"if (!{self._x.tokens[s.place]}full) {{", s.note)
            self._next()
            self.body(s.body)
            return
        i = self._x.local(s.index)
        tokens = self._x.tokens[s.place]
        self.note(s.note)
        self.line(f"for (uint32_t {i} = 0U; {i} < {tokens}used; {i}++) {{")
        self._loops += 1
        if self.timed[s.place]:
            self._depth += 1
            self.note(
                "tokens of one value lie together, the earliest first: look at each value once"
            )
            table = self.tables_of_places[s.place]
            token = f"{tokens}token"
            self.line(
                f"if (({i} > 0U) && pn_same(&{table}, &{token}[{i}].value, &{token}[{i} - 1U].value)) {{"
            )
            self._next()
            self._depth -= 1
        self.block(s.body)
        self._loops -= 1
        self.line("}")

    def _for_values(self, s: ir.ForValues) -> None:
        table = self._names.table(s.table)
        i = self._scope.name(("values", s.variable), "number")
        value = self._x.address(ir.Bound(s.variable, self.variable_types[s.variable]))
        self.note(s.note)
        self.line(f"for (uint64_t {i} = 0U; {i} < pn_type_size(&{table}); {i}++) {{")
        self._loops += 1
        self.line(f"{INDENT}pn_type_value(&{table}, {i}, {value});")
        self.block(s.body)
        self._loops -= 1
        self.line("}")

    def _differs(self, place: int, value: str, pointer: str) -> str:
        """Whether a slot does not hold a value, as a C condition: the value is given as C, and by its address."""
        slot = self._x.tokens[place]
        rep = self.token_types[place].rep
        if rep is Rep.UNIT:
            return f"!{slot}full"
        if rep in _SCALARS:
            return f"!{slot}full || ({slot}value != {value})"
        table = self.tables_of_places[place]
        return f"!{slot}full || !pn_same(&{table}, &{slot}value, {pointer})"

    def _unless_available(self, s: ir.UnlessAvailable) -> None:
        if s.place in self.slots:
            return  # there is one
        if self._packed(s.place):
            count = self._x.call(s.place, "count_of", self._x.local(s.index))
            self.line(f"if ({count} < {s.count}U) {{")
            self._next()
            return
        token = f"{self._x.tokens[s.place]}token[{self._x.local(s.index)}]"
        if s.limit is None:
            self.line(f"if ({token}.count < {s.count}U) {{")
        else:
            member = "real" if self._real_time else "integer"
            self.line(f"if ({token}.stamp.{member} > {self._x.inside(s.limit, 10)}) {{")
        self._next()

    def _unless_bind(self) -> None:
        self.line('if (pn_is_raised(cx, "Bind")) {')
        self.line(f"{INDENT}pn_clear_error(cx);")
        self._next()

    def _wanted(self, s: ir.Wanted) -> None:
        takes = s.takes
        if is_pair(takes, self.timed) and not any(
            isinstance(s, ir.Take) and s.place in self.slots for s in takes
        ):
            self._wanted_pair(s)
            return
        holds = self._scope.name(("holds", id(takes)), "holds")
        first = takes[0]
        known = (
            self.sums.get((first.place, first.multiset))
            if len(takes) == 1 and isinstance(first, ir.TakeAll)
            else None
        )
        if known is None:
            self._work_out_wanted(takes, f"const bool {holds}")
        else:
            total = self._scope.name(("sum", id(takes)), "sum")
            self.note(known.of.note)
            self.line(f"const uint64_t *const {total} = {known.name}(cx, &b);")
            self.line(f"bool {holds} = false;")
            self.line(f"if ({total} != NULL) {{")
            self.line(f"{INDENT}{holds} = {self._x.call(known.of.place, 'has_sum', total)};")
            self.line("} else {")
            self._depth += 1
            self._work_out_wanted(takes, holds)
            self._depth -= 1
            self.line("}")
        if s.may_bind:
            self._unless_bind()
        self.line(f"if (!{holds}) {{")
        self._next()

    def _work_out_wanted(self, takes: tuple[Stmt, ...], holds: str) -> None:
        """Assigns to `holds` whether there are all tokens."""
        name = self._scope.name(("wanted", id(takes)), "wanted")
        before, self.moves = self.moves, name
        mark = self._scope.name(("mark", id(takes)), "start")
        if self.releases:
            self.line(f"const size_t {mark} = pn_arena_mark(cx->arena);")
        self.line(f"pn_moves_t {name};")
        self.line(f"pn_moves_init(&{name}, cx);")
        self.body(takes)
        self.line(f"{holds} = pn_moves_are_possible(&{name}, m);")
        if self.releases:
            self.line(f"pn_arena_release(cx->arena, {mark});")
        self.moves = before

    def _wanted_pair(self, wanted: ir.Wanted) -> None:
        takes, values = wanted.takes, []
        for note in dict.fromkeys(s.note for s in takes if isinstance(s, ir.Take) and s.note):
            self.note(note)
        for s in takes:
            if isinstance(s, ir.Take):
                values.append(self._x.address(s.value))
                place = s.place
            else:
                self.statement(s)
        test = self._x.call(place, "holds", *values)
        if wanted.may_bind:
            holds = self._scope.name(("holds", id(takes)), "holds")
            self.line(f"const bool {holds} = {test};")
            self._unless_bind()
            test = holds
        self.line(f"if (!{test}) {{")
        self._next()

    def _yield(self) -> None:
        if self.may_fail:
            self.line("if (!pn_ok(cx)) {")
            self.line(f"{INDENT}return true;")
            self.line("}")
        if self.is_flat:
            self.line("return sink(user, self, &b);")
            return
        if self.keeps and self.releases:
            self.line("is_kept = true;")
        self.line("if (!sink(user, self, &b)) {")
        self.line(f"{INDENT}return false;")
        self.line("}")

    def _move(self, s: ir.Take | ir.Put) -> None:
        if s.note:
            self.note(s.note)
        verb, time = ("take", s.limit) if isinstance(s, ir.Take) else ("put", s.stamp)
        parts = [
            f"&{self.moves}", f"{self.multisets[s.place]}", self._x.address(s.value), self._x.text(s.count),
            self._x.time(time),
        ]  # fmt: skip
        self.line(f"pn_moves_{verb}({', '.join(parts)});")

    def _moves(self, s: ir.TakeAll | ir.PutAll) -> None:
        if s.note:
            self.note(s.note)
        if isinstance(s, ir.TakeAll):
            verb, time = "take_list", s.limit
        else:
            verb, time = ("put_timed" if s.timed else "put_list"), s.stamp
        parts = [
            f"&{self.moves}", f"{self.multisets[s.place]}", f"&{self._names.table(s.table)}",
            self._x.text(s.multiset), self._x.time(time),
        ]  # fmt: skip
        self.line(f"pn_moves_{verb}({', '.join(parts)});")
