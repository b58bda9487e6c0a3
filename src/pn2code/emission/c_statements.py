"""IR statements -> lines of C."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from pn2code.emission.c_expressions import Expressions, PackedPlace
from pn2code.emission.c_lines import WIDTH, wrap
from pn2code.emission.c_literals import c_bytes
from pn2code.emission.c_sums import SumFunction
from pn2code.emission.c_types import Types
from pn2code.emission.environment import c_comment
from pn2code.emission.names import Names, Scope
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.ir.nodes import Ir, Rep, Stmt
from pn2code.lowering.expressions.values import is_atomic
from pn2code.lowering.passes.moves import is_pair

_INDENT = "    "
_SCALARS = frozenset({Rep.BOOL, Rep.INT, Rep.CHAR, Rep.ENUM})
"""Representations whose values C compares with `==`."""


class Statements:
    """Prints the statements of one C function."""

    def __init__(
        self, types: Types, expressions: Expressions, scope: Scope, real_time: bool
    ) -> None:
        self._types = types
        self._names: Names = types.names
        self._x = expressions
        self._scope = scope
        self._real_time = real_time
        self.lines: list[str] = []
        self._depth = 1
        self.self_parameters: tuple[ir.Local, ...] = ()
        self.self_call = ""
        self.result: str | None = None
        self.is_looping = False
        self.is_void = False
        self.tables_of_places: tuple[str, ...] = ()
        self.bags: tuple[str, ...] = ()
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
        self._loops = 0

    def line(self, text: str) -> None:
        """One line at the present depth, broken if it is long."""
        self.lines.extend(wrap(_INDENT * self._depth + text))

    def note(self, text: str) -> None:
        """A comment line, shortened if it is very long."""
        clean = c_comment(text)
        if clean:
            room = WIDTH - 4 * self._depth - 6
            self.line(f"/* {clean if len(clean) <= room else clean[: room - 4] + ' ...'} */")

    def line_with_note(self, text: str, note: str) -> None:
        """One line with its comment behind it, or before it where that is too long."""
        clean = c_comment(note)
        whole = f"{text} /* {clean} */" if clean else text
        if len(_INDENT * self._depth + whole) <= WIDTH:
            self.line(whole)
        else:
            self.note(note)
            self.line(text)

    def block(self, statements: tuple[Stmt, ...]) -> None:
        """Statements one level deeper."""
        self._depth += 1
        for s in statements:
            self.statement(s)
        self._depth -= 1

    def body(self, statements: tuple[Stmt, ...]) -> None:
        """Statements at the present depth."""
        for s in statements:
            self.statement(s)

    def _next(self) -> None:
        """Goes on with the next candidate."""
        if self._loops:
            self.line(_INDENT + "continue;")
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
            self.line(_INDENT + "pn_arena_release(cx->arena, mark);")
            self.line("}")
        self.line("return;" if self.is_void else "return true;")

    def end_search(self) -> None:
        """What stands last in the function; without loops that is the only call of the sink."""
        if not self.is_flat:
            self.finish_search()

    def _declaration(self, local: ir.Local) -> str:
        return f"{self._types.name(local.type)} {self._x.local(local)}"

    # --- statements ----------------------------------------------------------------------------

    def statement(self, s: Stmt) -> None:
        """Print one statement."""
        match s:
            case ir.Let(local=local, value=value, mutable=mutable):
                text = self._x.text(value)
                self.line(f"{'' if mutable else 'const '}{self._declaration(local)} = {text};")
            case ir.Declare(local=local):
                self.line(f"{self._declaration(local)} = {self._types.zero(local.type)};")
            case ir.Assign(local=local, value=value):
                self.line(f"{self._x.local(local)} = {self._x.text(value)};")
            case ir.Fill():
                parts = ["cx", f"&{self._names.table(s.table)}", f"&{self._x.local(s.local)}"]
                parts += [self._x.text(a) for a in s.arguments]
                self.line(f"pn_colset_{s.name}({', '.join(parts)});")
            case ir.SetGlobal():
                self._set_global(s)
            case ir.Do(value=value):
                self._discard(value)
            case ir.If():
                self._if(s)
            case ir.While():
                self.line("while (pn_goes_on(cx)) {")
                self.block(s.setup)
                self.line(f"{_INDENT}if (!({self._x.text(s.condition)})) {{")
                self.line(f"{_INDENT * 2}break;")
                self.line(f"{_INDENT}}}")
                self.block(s.body)
                self.line("}")
            case ir.ForList():
                self._for_list(s)
            case ir.ForCount(local=local, count=count):
                i = self._x.local(local)
                self.line(
                    f"for (int64_t {i} = 0; ({i} < {self._x.condition(count)}) && pn_ok(cx); {i}++) {{"
                )
                self.block(s.body)
                self.line("}")
            case ir.Return(value=value):
                self._return(value)
            case ir.SelfCall():
                self._self_call(s)
            case ir.Raise(name=name):
                self.line(f"pn_raise(cx, {_error(name)}, {c_bytes(name)});")
            case ir.RaiseValue(value=value, table=table):
                pointer = self._x.address(value)
                self.line(f"pn_raise_value(cx, &{self._names.table(table)}, {pointer});")
            case ir.SetContents():
                self._set_contents(s)
            case ir.ClearError():
                self.line("pn_clear_error(cx);")
            case ir.Note(text=text):
                self.note(text)
            case _:
                self._net_statement(s)

    def _discard(self, value: Ir) -> None:
        """Evaluate for what it does."""
        text = self._x.inside(value, 14)
        is_call = value.type.rep is Rep.UNIT and text.endswith(")") and not text.startswith("(")
        self.line(f"{text};" if is_call else f"(void){text};")

    def _set_global(self, s: ir.SetGlobal) -> None:
        name = self._names.value(s.name, self._x.global_hints.get(s.name, s.name))
        if not s.is_reference:
            self.line(f"{name} = {self._x.text(s.value)};")
            return
        value = self._x.text(s.value)
        t = self._types.name(s.value.type)
        fresh = self._scope.name(("new value", id(s)), "new_value")
        self.line(f"const {t} {fresh} = {value};")
        self.line("if (pn_ok(cx)) {")
        self.line(f"{_INDENT}{name} = {fresh};")
        self.line("}")

    def _set_contents(self, s: ir.SetContents) -> None:
        star = "*" if s.reference.type.rep is Rep.REF and s.value.type != s.reference.type else ""
        target = f"{star}{self._x.inside(s.reference, 13)}"
        text = self._x.text(s.value)
        if not is_atomic(s.value):
            fresh = self._scope.name(("new value", id(s)), "new_value")
            self.line(f"const {self._types.name(s.value.type)} {fresh} = {text};")
            text = fresh
        self.line("if (pn_ok(cx)) {")
        self.line(f"{_INDENT}{target} = {text};")
        self.line("}")

    def _if(self, s: ir.If, prefix: str = "") -> None:
        condition, then, otherwise = s.condition, s.then, s.otherwise
        if not then:
            condition, then, otherwise = ir.Op("Bool.not", (condition,), ir.BOOL), otherwise, ()
        self.line(f"{prefix}if ({self._x.text(condition)}) {{")
        self.block(then)
        if self.result is None and isinstance(then[-1], ir.Return) and otherwise and not prefix:
            # What follows a return needs no else.
            self.line("}")
            self.body(otherwise)
            return
        if len(otherwise) == 1 and isinstance(otherwise[0], ir.If):
            inner = otherwise[0]
            if inner.then:
                self._if(inner, "} else ")
                return
        if otherwise:
            self.line("} else {")
            self.block(otherwise)
        self.line("}")

    def _for_list(self, s: ir.ForList) -> None:
        cell = self._x.local(s.cell)
        t = self._types.name(s.cell.type)
        until = f" && !{self._x.local(s.until)}" if s.until is not None else ""
        start = self._x.text(s.list)
        head = f"for ({t} {cell} = {start}; ({cell} != NULL){until} && pn_ok(cx); {cell} = {cell}->tail) {{"
        self.line(head)
        self._loops += 1
        self.block(s.body)
        self._loops -= 1
        self.line("}")

    def _return(self, value: Ir | None) -> None:
        if self.result is not None:
            if value is not None:
                self.line(f"{self.result} = {self._x.text(value)};")
        elif value is None:
            self.line("return;")
        else:
            self.line(f"return {self._x.text(value)};")

    def _self_call(self, s: ir.SelfCall) -> None:
        if not self.is_looping:
            parts = ["cx", *(self._x.text(a) for a in s.arguments)]
            text = f"{self.self_call}({', '.join(parts)});"
            way = f"{self.result} = " if self.result else "return "
            target = "" if self.is_void else way
            self.line(target + text)
            return
        changed = [
            (p, a)
            for p, a in zip(self.self_parameters, s.arguments, strict=True)
            if not (isinstance(a, ir.Use) and a.local == p)
        ]
        if len(changed) == 1:
            p, a = changed[0]
            self.line(f"{self._x.local(p)} = {self._x.text(a)};")
            return
        fresh: list[tuple[ir.Local, str]] = []
        for p, a in changed:
            name = self._scope.name(("next", id(s), p.uid), f"next_{p.hint}")
            fresh.append((p, name))
            self.line(f"const {self._types.name(p.type)} {name} = {self._x.text(a)};")
        for p, name in fresh:
            self.line(f"{self._x.local(p)} = {name};")

    # --- statements of transitions -------------------------------------------------------------

    def _net_statement(self, s: Stmt) -> None:
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
                self.line('if (pn_is_raised(cx, "Bind")) {')
                self.line(f"{_INDENT}pn_clear_error(cx);")
                self._next()
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
                    bag = self.bags[s.place]
                    held = f"pn_bag_count({bag}, m, {pointer}, {self._x.time(s.limit)})"
                else:
                    held = self._x.call(s.place, "held", pointer)
                self.line(f"if ({held} < {s.count}U) {{")
                self._next()
            case ir.UnlessEmpty(place=place, note=note):
                self.note(note)
                if self.timed[place]:
                    self.line(f"if (pn_bag_available({self.bags[place]}, m, cx->now) > 0U) {{")
                elif self._packed(place):
                    self.line(f"if (!{self._x.place_names[place]}_is_empty(m)) {{")
                elif place in self.slots:
                    self.line(f"if ({self._x.tokens[place]}full) {{")
                else:
                    self.line(f"if ({self._x.tokens[place]}used > 0U) {{")
                self._next()
            case ir.Wanted(takes=takes):
                self._wanted(takes)
            case ir.Yield():
                self._yield()
            case ir.Take() | ir.Put():
                self._move(s)
            case ir.TakeAll() | ir.PutAll():
                self._moves(s)
            case ir.Threshold(place=place, delay=delay, note=note):
                self.note(note)
                bag, time = self.bags[place], self._x.time(delay)
                self.line(f"pn_bag_threshold({bag}, m, cx->now, {time}, found, next);")
            case ir.Reset(place=place, note=note):
                self.note(note)
                self.line(f"pn_moves_reset(&{self.moves}, {self.bags[place]}, cx->now);")

    def _packed(self, place: int) -> PackedPlace | None:
        return self._x.packed[place] if self._x.packed else None

    def _for_colours(self, s: ir.ForTokens, packed: PackedPlace) -> None:
        """The loop over the tokens of a packed place: over the numbers of the colours of which there are some."""
        i = self._x.local(s.index)
        place = self._x.place_names[s.place]
        start, step = f"{i} = {place}_next(m, 0U)", f"{i} = {place}_next(m, {i} + 1U)"
        self.note(s.note)
        self.line(f"for (uint32_t {start}; {i} < {packed.colours}U; {step}) {{")
        self._loops += 1
        if any(isinstance(n, ir.TokenValue) and n.index == s.index for n in ir_nodes(s.body)):
            t = self._types.name(self.token_types[s.place])
            token = self._x.token(s.place, s.index)
            self.line(f"{_INDENT}const {t} {token} = {packed.colour_of}({i});")
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
        self.line(f"{_INDENT}pn_type_value(&{table}, {i}, {value});")
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
            count = f"{self._x.place_names[s.place]}_count_of(m, {self._x.local(s.index)})"
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

    def _wanted(self, takes: tuple[Stmt, ...]) -> None:
        if is_pair(takes, self.timed) and not any(
            isinstance(s, ir.Take) and s.place in self.slots for s in takes
        ):
            self._wanted_pair(takes)
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
            place = self._x.place_names[known.of.place]
            total = self._scope.name(("sum", id(takes)), "sum")
            self.note(known.of.note)
            self.line(f"const uint64_t *const {total} = {known.name}(cx, &b);")
            self.line(f"bool {holds} = false;")
            self.line(f"if ({total} != NULL) {{")
            self.line(f"{_INDENT}{holds} = {place}_has_sum(m, {total});")
            self.line("} else {")
            self._depth += 1
            self._work_out_wanted(takes, holds)
            self._depth -= 1
            self.line("}")
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

    def _wanted_pair(self, takes: tuple[Stmt, ...]) -> None:
        values = []
        for note in dict.fromkeys(s.note for s in takes if isinstance(s, ir.Take) and s.note):
            self.note(note)
        for s in takes:
            if isinstance(s, ir.Take):
                values.append(self._x.address(s.value))
                place = s.place
            else:
                self.statement(s)
        self.line(f"if (!{self._x.call(place, 'holds', *values)}) {{")
        self._next()

    def _yield(self) -> None:
        if self.may_fail:
            self.line("if (!pn_ok(cx)) {")
            self.line(f"{_INDENT}return true;")
            self.line("}")
        if self.is_flat:
            self.line("return sink(user, self, &b);")
            return
        if self.keeps and self.releases:
            self.line("is_kept = true;")
        self.line("if (!sink(user, self, &b)) {")
        self.line(f"{_INDENT}return false;")
        self.line("}")

    def _move(self, s: ir.Take | ir.Put) -> None:
        if s.note:
            self.note(s.note)
        verb, time = ("take", s.limit) if isinstance(s, ir.Take) else ("put", s.stamp)
        parts = [
            f"&{self.moves}", f"{self.bags[s.place]}", self._x.address(s.value), self._x.text(s.count),
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
            f"&{self.moves}", f"{self.bags[s.place]}", f"&{self._names.table(s.table)}",
            self._x.text(s.multiset), self._x.time(time),
        ]  # fmt: skip
        self.line(f"pn_moves_{verb}({', '.join(parts)});")


_ERRORS = {
    "Match": "PN_ERR_MATCH",
    "Bind": "PN_ERR_BIND",
    "Div": "PN_ERR_DIV",
    "Overflow": "PN_ERR_OVERFLOW",
    "Subscript": "PN_ERR_SUBSCRIPT",
    "Empty": "PN_ERR_EMPTY",
    "Domain": "PN_ERR_DOMAIN",
    "Size": "PN_ERR_DOMAIN",
    "Chr": "PN_ERR_DOMAIN",
    "Subtract": "PN_ERR_SUBTRACT",
}


def _error(name: str) -> str:
    return _ERRORS.get(name, "PN_ERR_RAISED")
