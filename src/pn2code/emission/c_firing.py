"""An occurrence printed with the inline functions of its places (pn_place.h), and with slots (`passes.slots`).

First everything is worked out, so that whatever raises leaves the marking alone. Then it is looked whether the slots
have room, then tokens are taken from the other places and put there; if one is missing, or a place turns out to be
full, all is put back. The slots change last. What the search has found in a slot is not looked at again: only enabled
bindings occur. From the other places tokens may be missing, since an inscription may give another value than it gave in
the search (random numbers, files, references).
"""

from __future__ import annotations

from pn2code.base.frozen import frozen
from pn2code.emission.c_expressions import Expressions
from pn2code.emission.c_net_statements import NetStatements
from pn2code.emission.c_types import Types
from pn2code.emission.names import Scope
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Rep, Stmt
from pn2code.lowering.passes.moves import is_count


@frozen
class _Move:
    """A take or put that is worked out.

    Args:
        verb: "take" or "add".
        place: its number.
        value: a pointer to the value, as C.
        count: as C; "": the value is a sum of tokens.
        note: what it is in the net.
        is_packed: whether the place is.
    """

    verb: str
    place: int
    value: str
    count: str
    note: str
    is_packed: bool


@frozen
class _SlotMove:
    """A take from a slot or a put into it that is worked out.

    Args:
        is_take: or it is a put.
        tokens: the place, with what leads to its members.
        multiset: a pointer to its table.
        value: a put: the token as C, "" where values say nothing (`()`).
        differs: a take: whether the token is not there, as C; "": the search has found it.
        count: "" for one; otherwise the C variable that says how many tokens.
        is_one: there is never more than one.
        note: what it is in the net.
    """

    is_take: bool
    tokens: str
    multiset: str
    value: str
    count: str
    note: str
    differs: str = ""
    is_one: bool = True


class DirectFiring(NetStatements):
    """Prints the `fire` of a transition that `is_direct`.

    Args:
        puts_back: whether the marking is as before where a place is full; without, the caller throws it away.
    """

    def __init__(
        self,
        types: Types,
        expressions: Expressions,
        scope: Scope,
        real_time: bool,
        *,
        puts_back: bool,
    ) -> None:
        super().__init__(types, expressions, scope, real_time)
        self._puts_back = puts_back
        self._moves_made: list[_Move] = []
        self._slot_moves: list[_SlotMove] = []
        self._declared: list[str] = []
        self._staying: set[int] = set()
        self._sums_used: dict[str, str] = {}
        self.otherwise = ""
        self.has_checks = False

    def fire(
        self, statements: tuple[Stmt, ...], staying: tuple[tuple[int, int], ...], may_fail: bool
    ) -> None:
        """The whole body after the preamble; `staying`: as of a transition."""
        self._staying = {id(statements[i]) for pair in staying for i in pair}
        self.body(statements)
        self.lines[:0] = [*self._sum_lines(), *self._declared]
        if may_fail or self.has_checks:
            self.line("if (!pn_ok(cx)) {")
            self.line("    return false;")
            self.line("}")
        takes = [m for m in self._moves_made if m.verb == "take"]
        puts = [m for m in self._moves_made if m.verb == "add"]
        for take in (statements[position] for position, _ in staying):
            assert isinstance(take, ir.Take)
            self.note(f"{take.note or self._x.place_names[take.place]}: stays where it is")
        self._look_at_slots()
        self._take(takes)
        if self._puts_back:
            self._put_all(puts, takes)
        elif puts:
            self._put_in_turn(puts)
            if not self._slot_moves:
                self.line("return fits;")
                return
            self.line("if (!fits) {")
            self.line("    return false;")
            self.line("}")
        self._change_slots()
        self.line("return true;")

    def _put_all(self, puts: list[_Move], takes: list[_Move]) -> None:
        if not puts:
            return
        done = self._put(puts)
        self.line("if (!fits) {")
        self._depth += 1
        if done or takes:
            self.note("a place is full: everything is put back")
        for move, is_done in reversed(done):
            undo = f"{self._call(move, 'undo')};"
            if move.is_packed:
                undo = f"(void){self._call(move, 'take')};"
            if is_done:
                self.line(f"if ({is_done}) {{")
                self.line(f"    {undo}")
                self.line("}")
            else:
                self.line(undo)
        for move in reversed(takes):
            self.line(f"(void){self._call(move, 'add')};")
        self.line("return false;")
        self._depth -= 1
        self.line("}")

    def _call(self, move: _Move, verb: str = "") -> str:
        """The call that does it, or that undoes it."""
        done = verb or move.verb
        if not move.count:
            return self._x.call(move.place, f"{done}_sum", move.value)
        return self._x.call(move.place, done, move.value, move.count)

    def _look_at_slots(self) -> None:
        """Whether the tokens are there, and whether there is room."""
        taken = [m for m in self._slot_moves if m.is_take]
        tests = list(dict.fromkeys(m.differs for m in taken if m.differs))
        if tests:
            self.line(f"if ({' || '.join(tests)}) {{")
            self.line("    return pn_fail_missing(cx);")
            self.line("}")
        rooms = []
        emptied = {m.tokens for m in taken}
        for move in self._slot_moves:
            if move.is_take or (move.tokens in emptied and move.is_one):
                continue
            full = f"{move.tokens}full"
            if move.count and move.tokens in emptied:
                test = f"{move.count} > 1U"
            elif move.count and move.is_one:
                test = f"({move.count} > 0U) && {full}"
            elif move.count:
                test = f"({move.count} > 1U) || (({move.count} == 1U) && {full})"
            else:
                test = full
            rooms.append(f"!pn_has_room(cx, {test}, {move.multiset})")
        if rooms:
            self.line(f"if ({' || '.join(rooms)}) {{")
            self.line("    return false;")
            self.line("}")

    def _change_slots(self) -> None:
        """Takes, then puts; a slot from which a token is taken and into which one is put stays full."""
        taken = {m.tokens for m in self._slot_moves if m.is_take}
        filled = {m.tokens for m in self._slot_moves if not (m.is_take or m.count)}
        for move in (m for m in self._slot_moves if m.is_take):
            if move.tokens in filled:
                self.note(f"{move.note}: replaced below")
            else:
                self.line_with_note(f"{move.tokens}full = false;", move.note)
        for move in (m for m in self._slot_moves if not m.is_take):
            is_full = move.tokens in taken and not move.count
            lines = [] if is_full else [f"{move.tokens}full = true;"]
            if move.value:
                lines.insert(0, f"{move.tokens}value = {move.value};")
            if move.count:
                lines = [f"if ({move.count} > 0U) {{", *(f"    {line}" for line in lines), "}"]
            if not lines:
                self.note(move.note)
                continue
            self.line_with_note(lines[0], move.note)
            for line in lines[1:]:
                self.line(line)

    def _put(self, puts: list[_Move]) -> list[tuple[_Move, str]]:
        """Puts, and says in `fits` whether all had room.

        Gives what is to be undone if not, and what tells that it has been done: a packed place that is full does not
        change.
        """
        if not any(move.is_packed for move in puts):
            self._put_in_turn(puts)
            return [(move, "") for move in puts]
        if len(puts) == 1:
            self._put_in_turn(puts)
            return []
        done = []
        for i, move in enumerate(puts):
            name = self._scope.name(("fits", i), f"fits_{self._x.place_names[move.place]}")
            self.note(move.note)
            self.line(f"const bool {name} = {self._call(move)};")
            done.append((move, name))
        self.line(f"const bool fits = {' && '.join(name for _, name in done)};")
        return [(move, name if move.is_packed else "") for move, name in done]

    def _put_in_turn(self, puts: list[_Move]) -> None:
        for i, move in enumerate(puts):
            self.note(move.note)
            if len(puts) == 1:
                self.line(f"const bool fits = {self._call(move)};")
            else:
                start = "bool fits = " if i == 0 else "fits = "
                self.line(f"{start}{self._call(move)}{' && fits' if i else ''};")

    def _moves(self, s: ir.TakeAll | ir.PutAll) -> None:
        known = self.sums[s.place, s.multiset]
        name = self._scope.name(("sum", known.name), "sum")
        self._sums_used[known.name] = name
        verb = "take" if isinstance(s, ir.TakeAll) else "add"
        self._moves_made.append(_Move(verb, s.place, name, "", s.note or known.of.note, True))

    def _sum_lines(self) -> list[str]:
        """The sums, and the way to go when one is not known: list by list."""
        lines = [
            f"    const uint64_t *const {name} = {function}(cx, b);"
            for function, name in self._sums_used.items()
        ]
        if lines:
            tests = [f"{name} == NULL" for name in self._sums_used.values()]
            condition = tests[0] if len(tests) == 1 else " || ".join(f"({t})" for t in tests)
            lines += [f"    if ({condition}) {{", f"        return {self.otherwise};", "    }"]
        return lines

    def _take(self, takes: list[_Move]) -> None:
        if not takes:
            return
        done: list[tuple[str, _Move]] = []
        for i, move in enumerate(takes):
            is_last = i == len(takes) - 1
            name = "is_taken"
            if not is_last:
                place = self._x.place_names[move.place]
                name = self._scope.name(("taken", i), f"is_taken_{place}")
            before = f"{done[-1][0]} && " if done else ""
            self.note(move.note)
            self.line(f"const bool {name} = {before}{self._call(move)};")
            if not is_last:
                done.append((name, move))
        self.line("if (!is_taken) {")
        if self._puts_back and done:
            self._depth += 1
            self.note("a token is missing: those before it are put back")
            for name, move in done:
                self.line(f"if ({name}) {{")
                self.line(f"    (void){self._call(move, 'add')};")
                self.line("}")
            self._depth -= 1
        self.line("    return pn_fail_missing(cx);")
        self.line("}")

    def _slot_move(self, s: ir.Take | ir.Put) -> None:
        place, tokens, multiset = (
            texts[s.place] for texts in (self._x.place_names, self._x.tokens, self.multisets)
        )
        if isinstance(s, ir.Take):
            self._slot_moves.append(
                _SlotMove(True, tokens, multiset, "", "", s.note, self._is_missing(s))
            )
            return
        key = ("add", id(s))
        is_nested = self._depth > 1
        must_check = not s.is_legal
        value = ""
        if is_nested or must_check or not isinstance(s.value, ir.Const | ir.Bound | ir.Use):
            value = self._worked_out(s, is_nested, must_check)
        elif s.value.type.rep is not Rep.UNIT:
            value = self._x.text(s.value)
        is_one = is_count(s.count) and isinstance(s.count, ir.Const) and s.count.value == 1
        count = "" if is_one and not is_nested else self._count(s, key, place, is_nested)
        if count.endswith("U"):  # a constant: more than one
            number = self._scope.name((*key, "number"), f"{place}_tokens")
            self.line(f"const uint32_t {number} = {count};")
            count = number
        if must_check:
            self.has_checks = True
            self._check(s, f"&{value}", count or "1U")
        self._slot_moves.append(
            _SlotMove(False, tokens, multiset, value, count, s.note, is_one=is_one)
        )

    def _worked_out(self, s: ir.Take | ir.Put, is_nested: bool, must_check: bool) -> str:
        """The variable that holds the value that is taken or put; a check may change it."""
        verb = "take" if isinstance(s, ir.Take) else "add"
        fresh = self._scope.name((verb, id(s), "value"), f"{self._x.place_names[s.place]}_token")
        t = self._types.name(s.value.type)
        if is_nested:
            self._declared.append(f"    {t} {fresh} = {self._types.zero(s.value.type)};")
            self.line(f"{fresh} = {self._x.text(s.value)};")
        else:
            constant = "" if must_check else "const "
            self.line(f"{constant}{t} {fresh} = {self._x.text(s.value)};")
        return fresh

    def _is_missing(self, s: ir.Take) -> str:
        """Whether the token is not there, as C; "": the search has found it."""
        if s.is_found:
            return ""
        fresh = self._worked_out(s, is_nested=False, must_check=False)
        return self._differs(s.place, fresh, f"&{fresh}")

    def _move(self, s: ir.Take | ir.Put) -> None:
        if id(s) in self._staying:
            return
        if s.place in self.slots:
            self._slot_move(s)
            return
        place = self._x.place_names[s.place]
        verb = "take" if isinstance(s, ir.Take) else "add"
        key = (verb, id(s))
        is_nested = self._depth > 1
        is_plain = isinstance(s.value, ir.Bound | ir.Use)
        must_check = isinstance(s, ir.Put) and not s.is_legal
        if is_plain and not is_nested and not must_check:
            value = self._x.address(s.value)
        else:
            value = f"&{self._worked_out(s, is_nested, must_check)}"
        count = self._count(s, key, place, is_nested)
        if must_check:
            self.has_checks = True
            self._check(s, value, count)
        self._moves_made.append(
            _Move(verb, s.place, value, count, s.note, self._packed(s.place) is not None)
        )

    def _check(self, s: ir.Take | ir.Put, value: str, count: str) -> None:
        """Of no tokens at all (``0`v``) the value may be any."""
        packed = self._packed(s.place)
        if packed and packed.is_pure:
            check = f"{self._x.call(s.place, 'check', value)};"
        else:
            check = f"pn_multiset_check(cx, {self.multisets[s.place]}, {value});"
        if is_count(s.count):
            self.line(check)
        else:
            self.line(f"if ({count} > 0U) {{")
            self.line(f"    {check}")
            self.line("}")

    def _count(self, s: ir.Take | ir.Put, key: tuple[str, int], place: str, is_nested: bool) -> str:
        if is_count(s.count) and not is_nested:
            return f"{self._x.text(s.count)}U"
        number = self._scope.name((*key, "count"), f"{place}_tokens")
        if is_count(s.count):
            text = f"{self._x.text(s.count)}U"
        else:
            self.has_checks = True
            text = f"pn_token_count(cx, {self._x.text(s.count)})"
        if is_nested:
            self._declared.append(f"    uint32_t {number} = 0U;")
            self.line(f"{number} = {text};")
        else:
            self.line(f"const uint32_t {number} = {text};")
        return number
