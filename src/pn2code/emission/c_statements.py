"""IR statements of functions -> lines of C; those of transitions are printed by `c_net_statements`."""

from __future__ import annotations

from pn2code.emission.c_expressions import Expressions
from pn2code.emission.c_lines import WIDTH, wrap
from pn2code.emission.c_literals import c_bytes
from pn2code.emission.c_types import Types
from pn2code.emission.environment import c_comment
from pn2code.emission.names import Names, Scope
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, Rep, Stmt
from pn2code.lowering.expressions.values import is_atomic

INDENT = "    "
_DEEPEST = 24
"""Levels that are indented: with all of them the C of a transition with n arcs has n * n blanks."""
_MANY = 50
"""Elements of a list literal from which a loop puts them in: with as many temporary objects compilers take minutes."""
_PLAIN = frozenset({Rep.INT, Rep.REAL, Rep.BOOL, Rep.CHAR})


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
        self._loops = 0

    @property
    def _indent(self) -> str:
        return INDENT * min(self._depth, _DEEPEST)

    def line(self, text: str) -> None:
        """One line at the present depth, broken if it is long."""
        self.lines.extend(wrap(self._indent + text))

    def note(self, text: str) -> None:
        """A comment line, shortened if it is very long."""
        clean = c_comment(text)
        if clean:
            room = WIDTH - len(self._indent) - 6
            self.line(f"/* {clean if len(clean) <= room else clean[: room - 4] + ' ...'} */")

    def line_with_note(self, text: str, note: str) -> None:
        """One line with its comment behind it, or before it where that is too long."""
        clean = c_comment(note)
        whole = f"{text} /* {clean} */" if clean else text
        if len(self._indent + whole) <= WIDTH:
            self.line(whole)
        else:
            self.note(note)
            self.line(text)

    def _list(self, local: ir.Local, value: Ir, heads: list[Ir]) -> None:
        """`head :: head :: ... :: tail`, by a loop over an array of the heads."""
        tail = value
        for _ in heads:
            assert isinstance(tail, ir.Op)
            tail = tail.arguments[1]
        assert isinstance(value, ir.Op)
        items = self._scope.name(("items", local.uid), "items")
        left = self._scope.name(("left", local.uid), "left")
        name = self._x.local(local)
        are_plain = all(
            isinstance(e, ir.EnumValue) or (isinstance(e, ir.Const) and e.type.rep in _PLAIN)
            for e in heads
        )
        texts = ", ".join(map(self._x.text, heads))
        kind = f"{'static ' if are_plain else ''}const {self._types.name(heads[0].type)}"
        self.line(f"{kind} {items}[] = {{ {texts} }};")
        self.line(f"{self._declaration(local)} = {self._x.text(tail)};")
        self.line(f"for (size_t {left} = {len(heads)}U; {left} > 0U; {left}--) {{")
        table = self._names.table(value.table)
        cell = f"pn_list_cons(cx, &{table}, &{items}[{left} - 1U], {name})"
        self.line(f"{INDENT}{name} = {cell};")
        self.line("}")

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

    def _declaration(self, local: ir.Local) -> str:
        return f"{self._types.name(local.type)} {self._x.local(local)}"

    def statement(self, s: Stmt) -> None:
        """Print one statement."""
        match s:
            case ir.Let(local=local, value=value) if len(heads := _heads(value)) >= _MANY:
                self._list(local, value, heads)
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
                self.line(f"{INDENT}if (!({self._x.text(s.condition)})) {{")
                self.line(f"{INDENT * 2}break;")
                self.line(f"{INDENT}}}")
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
                self._other(s)

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
        self.line(f"{INDENT}{name} = {fresh};")
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
        self.line(f"{INDENT}{target} = {text};")
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

    def _other(self, s: Stmt) -> None:
        """A statement that functions do not have."""
        raise AssertionError(f"not a statement of a function: {type(s).__name__}")


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


def _heads(value: Ir) -> list[Ir]:
    """The elements that a list is built of, before what comes from elsewhere."""
    heads: list[Ir] = []
    while isinstance(value, ir.Op) and value.name == "list.cons":
        head, value = value.arguments
        heads.append(head)
    return heads
