"""`NetIR` -> `net.c` and `net.h`: the whole net as one C translation unit behind `pn_net`.

All decisions are made before the templates run; they only print. Each transition, place and function of the
net is a `Block` of the file, so that a compiler message or a reader finds the way back to the net.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.diagnostics import Origin
from pn2code.emission import c_packed, c_places, c_rows, c_sums, c_tables
from pn2code.emission.c_effects import Effects, is_assignment, is_draw
from pn2code.emission.c_expressions import (
    Expressions,
    Types,
    c_big_initialiser,
    c_integer,
    op_needs_table,
)
from pn2code.emission.c_firing import DirectFiring
from pn2code.emission.c_lines import mentions, wrap
from pn2code.emission.c_needs import used_locals, uses_context
from pn2code.emission.c_own import OwnPlaces
from pn2code.emission.c_proofs import proofs
from pn2code.emission.c_shared import PlaceTable, Shared, path_of, share, tables
from pn2code.emission.c_slots import slots
from pn2code.emission.c_statements import Statements
from pn2code.emission.c_sums import Sum
from pn2code.emission.environment import c_comment, c_string, render
from pn2code.emission.names import Members, Names, Scope, stem
from pn2code.emission.output import Block, OutputFile
from pn2code.lowering import ir
from pn2code.lowering.calls import called, ir_nodes
from pn2code.lowering.ir import NetIR, Rep
from pn2code.lowering.packing import KEY_BITS, key_bits, packed_bits

_MARK = "\x01"
_MOST_INLINED = 150
"""Transitions of a net for which the compiler is told to put searches where they are called."""


def emit(net: NetIR, version: str) -> tuple[OutputFile, ...]:
    """`net.c` and `net.h`."""
    return _Emitter(net, version).run()


class _Emitter:
    def __init__(self, net: NetIR, version: str) -> None:
        self._net = net
        self._version = version
        self._names = Names()
        self._definitions = {d.name: d for d in net.definitions}
        self._types = Types(self._names, self._definitions)
        self._descriptors = {d.name: d for d in net.descriptors}
        self._functions = {f.key: f for f in net.functions}
        self._blocks: dict[str, tuple[str, str, Origin]] = {}
        self._place_names = tuple(self._names.place(p.index, p.name) for p in net.places)
        for t in net.transitions:
            self._names.transition(t.index, t.name)
        for definition in net.definitions:
            self._names.type(definition.name)
        self._bags = tuple(f"&{self._names.bag(p.index, p.name)}" for p in net.places)
        self._tokens = tuple(f"m->{name}." for name in self._place_names)
        self._holders = tuple(f"&m->{name}" for name in self._place_names)
        self._tables = tuple(self._names.table(p.table) for p in net.places)
        self._timed = tuple(p.timed for p in net.places)
        self._slots = slots(net)
        self._needs_context = self._context_users()
        self._effects = Effects(net, self._types.holds_reference)
        self._orders = c_places.Orders(self._types, self._names, self._descriptors)
        self._numbers = c_packed.Numbers(self._types, self._names, self._descriptors)
        self._packed = self._numbers.of_places(
            net.places, lambda key: self._effects.is_pure(self._functions[key].body)
        )
        self._has_inlined = net.has_successors and len(net.transitions) <= _MOST_INLINED
        self._has_words = (
            self._has_inlined
            and not net.timed
            and all(p.packed for p in net.places)
            and 0 < key_bits(net.places) <= KEY_BITS
        )
        self._sums_found: dict[int, dict[tuple[int, ir.Ir], Sum]] = {}
        self._referring = tuple(p.index for p in net.places if self._refers(p.table))
        self._kept = tuple(map(self._kept_in, net.places))
        self._room = self._rooms_of_arrays()
        # Explorers have a function for each instance, so that the compiler can put it where it is called.
        self._shared = share(
            net.transitions, lambda a, b: not net.has_successors and self._agree(a, b)
        )
        self._place_tables = tables(self._shared)

    def _agree(self, a: int, b: int) -> bool:
        """Whether two places are kept in the same way, and hold the same colours."""
        return a == b or (self._kept[a] != "" and self._kept[a] == self._kept[b])

    def _kept_in(self, p: ir.Place) -> str:
        """The stem of the C type that holds the tokens of a place, and of its functions; "": it is packed."""
        if p.packed:
            return ""
        if p.index in self._slots:
            return self._names.kept(p.table, "slot")
        kind = "timed_array" if p.timed else "array"
        return self._names.kept(p.table, f"{kind}_{p.capacity}")

    def _rooms_of_arrays(self) -> dict[str, int]:
        """By what holds the tokens: entries of untimed arrays behind their capacity, for what an occurrence adds."""
        found: dict[str, int] = {}
        for p, most in zip(self._net.places, c_places.rooms(self._net), strict=True):
            if not p.timed:
                # gcc warns of loops that would go through an array of one, though they never do.
                kept = self._kept[p.index]
                found[kept] = max(found.get(kept, 0), most, 2 - p.capacity)
        return found

    def _holder(self, p: ir.Place) -> dict[str, object]:
        """The C type that holds the tokens of a place."""
        is_slot = p.index in self._slots
        return {
            "name": self._kept[p.index],
            "type": self._types.name(p.type),
            "is_slot": is_slot,
            "timed": p.timed,
            "capacity": p.capacity,
            "room": self._room.get(self._kept[p.index], 0),
            "order": "" if p.timed or is_slot else self._orders.name(p.table),
        }

    def _refers(self, table: str) -> bool:
        """Whether values of a type refer into the arena."""
        found = (self._descriptors[key].type.rep for key in self._closure({table}))
        return any(rep in (Rep.STRING, Rep.LIST, Rep.UNION, Rep.BIG) for rep in found)

    def _word_mask(self) -> str:
        """What takes away what follows from the rest of the first word of the packed part."""
        has_more = any(p.packed and p.packed.shares and p.packed.bit < 64 for p in self._net.places)
        return f" & 0x{(1 << key_bits(self._net.places)) - 1:x}U" if has_more else ""

    def _closure(self, roots: set[str]) -> set[str]:
        return c_tables.Tables(self._types, self._descriptors, {}).needed(roots)

    def _context_users(self) -> frozenset[str]:
        """The functions that take the context: those that may raise, directly or through what they call."""
        users = {f.key for f in self._net.functions if f.loops or f.recursive}
        while True:
            more = {
                f.key
                for f in self._net.functions
                if f.key not in users and uses_context(f.body, frozenset(users), self._definitions)
            }
            if not more:
                return frozenset(users)
            users |= more

    # --- pieces --------------------------------------------------------------------------------

    def _printer(
        self, statements: tuple[ir.Stmt, ...], binding: str = "", own: OwnPlaces | None = None
    ) -> tuple[Statements, Expressions, Scope]:
        scope = Scope()
        x = Expressions(self._types, self._net.real_time, scope, binding)
        x.functions = self._functions
        x.int_bits = self._net.int_bits
        x.needs_context = self._needs_context
        x.place_names = self._place_names
        x.tokens, x.holders, x.kept = self._tokens, self._holders, self._kept
        x.bags = self._bags
        x.packed = self._packed
        x.slots = self._slots
        x.global_hints = {g.name: g.hint for g in self._net.globals}
        s = Statements(self._types, x, scope, self._net.real_time)
        s.used = used_locals(statements)
        s.bags = self._bags
        s.timed = self._timed
        s.slots = self._slots
        if any(self._packed):
            s.number_of = self._numbers.if_whole
        s.token_types = tuple(p.type for p in self._net.places)
        s.tables_of_places = self._tables
        if own:
            own.reserve(scope)
            x.place_names = own.names(x.place_names)
            x.tokens, x.holders = own.tokens(x.tokens), own.holders(x.holders)
            s.bags = x.bags = own.bags(x.bags)
        return s, x, scope

    def _function(self, f: ir.Function) -> dict[str, object]:
        s, x, scope = self._printer(f.body)
        name = self._names.function(f.key, f.hint)
        has_context = f.key in self._needs_context
        parameters = [f"{self._types.name(p.type)} {x.local(p)}" for p in f.parameters]
        if has_context:
            parameters.insert(0, "pn_ctx_t *cx")
        is_void = f.result.rep is Rep.UNIT
        result = "void" if is_void else self._types.name(f.result)
        s.self_parameters, s.self_call, s.is_void = f.parameters, name, is_void
        s.is_looping = f.loops
        zero = "" if is_void else self._types.zero(f.result)
        for p in f.parameters:
            if p.uid not in s.used:
                s.line(f"(void){x.local(p)};")
        if f.recursive:
            s.result = "" if is_void else scope.name("result", "result")
            if not is_void:
                s.line(f"{result} {s.result} = {zero};")
            s.line("if (pn_enter(cx)) {")
            s.block(f.body)
            s.line("    pn_leave(cx);")
            s.line("}")
            if not is_void:
                s.line(f"return {s.result};")
        elif f.loops:
            s.line("while (pn_goes_on(cx)) {")
            s.block(f.body)
            s.line("}")
            if not is_void:
                s.line(f"return {zero};")
        else:
            body = f.body[:-1] if is_void and f.body and f.body[-1] == ir.Return(None) else f.body
            s.body(body)
        head = wrap(f"static {result} {name}({', '.join(parameters) or 'void'})")
        return {
            "mark": self._block(f.hint, "declaration", f.origin),
            "title": _where(f.origin),
            "source": _comment_lines(f.source),
            "head": head,
            "prototype": "\n".join(head) + ";",
            "is_recursive": f.recursive,
            "lines": s.lines,
        }

    def _member(self, f: ir.Function, wrappers: dict[str, str]) -> dict[str, object]:
        """A function that decides membership of a subset, and its wrapper for the subset's table."""
        return {
            **self._function(f),
            "wrapper": wrappers[f.key],
            "call": self._names.function(f.key, f.hint),
            "has_context": f.key in self._needs_context,
            "type": self._types.name(f.parameters[0].type),
        }

    def _block(self, element: str, kind: str, origin: Origin) -> str:
        number = str(len(self._blocks))
        self._blocks[number] = (element, kind, origin)
        return number

    def _global(self, g: ir.Global) -> dict[str, object]:
        s, x, _ = self._printer(g.setup)
        s.body(g.setup)
        name = self._names.value(g.name, g.hint)
        constant = ""
        if (
            len(g.setup) == 1
            and isinstance(g.setup[0], ir.SetGlobal)
            and not (g.is_reference or g.setup[0].is_reference)
        ):
            value = g.setup[0].value
            if isinstance(value, ir.Const) and value.type.rep in (Rep.INT, Rep.REAL, Rep.BOOL):
                constant = x.text(value)
            elif (
                isinstance(value, ir.Const)
                and isinstance(value.value, int)
                and value.type == ir.BIG
            ):
                constant = c_big_initialiser(value.value)
        return {
            "mark": self._block(g.hint, "declaration", g.origin),
            "title": _where(g.origin),
            "source": _comment_lines(g.source),
            "type": self._types.name(g.type),
            "name": name,
            "constant": constant,
            "zero": _initial(self._types.zero(g.type), g.type.rep),
            "is_root": g.is_reference or self._types.holds_reference(g.type),
            "setup": [] if constant else s.lines,
            "has_locals": any(
                isinstance(n, ir.Let | ir.Declare | ir.SetContents)
                or (isinstance(n, ir.SetGlobal) and n.is_reference)
                for n in g.setup
            ),
            "table": self._names.table(g.table),
            "is_reference": g.is_reference,
        }

    def _place(self, p: ir.Place) -> dict[str, object]:
        s, _, _ = self._printer(p.initial)
        s.body(p.initial)
        member, bag = self._place_names[p.index], self._names.bag(p.index, p.name)
        early = f"s_early_{member}"
        return {
            "mark": self._block(p.name, "place", p.origin),
            "name": p.name,
            "member": member,
            "bag": bag,
            "colset": p.colset,
            "origin": p.origin.describe(),
            "type": self._types.name(p.type),
            "packed": p.packed,
            "is_whole": not p.packed or not self._numbers.members(p.table),
            "number_of": self._numbers.number_of(p.table) if p.packed else "",
            "early": c_rows.early(early, p, self._net.real_time) if p.early else [],
            "bag_lines": c_rows.bag(
                bag,
                p,
                table=self._names.table(p.table),
                where=self._where_kept(p, member),
                real_time=self._net.real_time,
                early_name=early,
                numbering=(self._numbers.finder(p.table), self._numbers.maker(p.table))
                if p.packed
                else ("", ""),
            ),
            "row": c_rows.place(
                p,
                bag,
                f"{member}_init" if p.initial else "",
                f"s_shares_of_{member}" if p.packed and p.packed.shares else "",
            ),
            "shares": p.packed.shares if p.packed else (),
            "is_slot": p.index in self._slots,
            "kept": self._kept[p.index],
            "initial": s.lines,
            "initial_text": _comment_lines(p.initial_text),
        }

    def _where_kept(self, p: ir.Place, member: str) -> str:
        """The macro for the offsets of what holds the tokens of a place; "": it is packed."""
        if p.packed:
            return ""
        kind = "SLOT" if p.index in self._slots else "STAMPS" if p.timed else "TOKENS"
        return f"PN_BAG_{kind}(net_marking_t, {member})"

    def _own_places(self, shared: Shared) -> OwnPlaces | None:
        """How the code of a transition of several instances reaches the places that each has for its own."""
        for table in self._place_tables:
            if shared.varying and (table.page, table.paths) == (shared.page, shared.paths):
                kept = {p: self._kept[p] for p in shared.varying}
                return OwnPlaces(
                    self._names.page_places(table.page, table.paths),
                    {p: self._member_of(table, shared, p) for p in shared.varying},
                    kept,
                )
        return None

    def _member_of(self, table: PlaceTable, shared: Shared, place: int) -> str:
        own = tuple(row[shared.varying.index(place)] for row in shared.at)
        return self._member_names(table)[list(zip(*table.rows, strict=True)).index(own)]

    def _member_names(self, table: PlaceTable) -> tuple[str, ...]:
        members = Members()
        return tuple(members.name(i, name) for i, name in enumerate(table.names))

    def _place_table(self, table: PlaceTable) -> dict[str, object]:
        """The struct of a page, and what it is for each of its instances."""
        members = self._member_names(table)
        struct = self._names.page_places(table.page, table.paths)
        return {
            "page": table.page,
            "struct": struct,
            "members": members,
            "instances": [
                {
                    "path": path,
                    "name": self._names.instance(path, struct),
                    "fields": [(m, self._bags[p]) for m, p in zip(members, row, strict=True)],
                }
                for path, row in zip(table.paths, table.rows, strict=True)
            ],
        }

    def _stem(self, shared: Shared) -> str:
        """The stem of the names of what is printed for a transition."""
        t = shared.model
        if len(shared.instances) == 1:
            return self._names.transition(t.index, t.name)
        return self._names.page_transition(t.index, shared.page, t.name.rsplit(".", 1)[-1])

    def _row(self, t: ir.Transition, shared: Shared, code: dict[str, object]) -> dict[str, object]:
        """What the tables of hosts say of one instance."""
        own = self._own_places(shared)
        stem, flags = self._stem(shared), ("looks", "looks_outside", "assigns", "search_assigns")
        affected = self._effects.affected(t.index)
        further = [f".places = &{self._names.instance(path_of(t), own.struct)}"] if own else []
        further += [f".successors = {stem}_successors"] if self._net.has_successors else []
        further += [f".words = {stem}_words"] if self._has_words else []
        if len(affected) < len(self._net.transitions):
            further += c_rows.indices("affected", affected)
        further += c_rows.indices("touched", self._effects.touched(t.index))
        further += c_rows.indices("read", self._effects.read(t.index))
        further += [f".{flag} = true" for flag in flags if code[flag]]
        return {
            "index": t.index,
            "code": code,
            "lines": c_rows.transition(t, stem, further),
        }

    def _binding_name(self, shared: Shared) -> str:
        """The name of the instance, or of the page's transition where there are several."""
        t = shared.model
        is_one = len(shared.instances) == 1
        return t.name if is_one else f"{shared.page}.{t.name.rsplit('.', 1)[-1]}"

    def _title(self, shared: Shared) -> list[str]:
        """The element of the net, and all of its instances that the code is of."""
        t = shared.model
        where = f"{t.origin.describe()}, {_where(t.origin)}"
        if len(shared.instances) == 1:
            return [c_comment(f"transition {t.name}: {where}")]
        instances = [f"    {c_comment(x.name)}" for x in shared.instances]
        return [c_comment(f"transition: {where}, at all of these:"), *instances]

    def _transition(self, shared: Shared) -> dict[str, object]:
        t = shared.model
        name, own = self._stem(shared), self._own_places(shared)
        members = Members()
        variables = tuple(members.name(i, v.name) for i, v in enumerate(t.variables))
        search, x, _ = self._printer(t.enumerate, "b.", own)
        x.variables = variables
        search.variable_types = tuple(v.type for v in t.variables)
        search.keeps = uses_context(
            _without_wanted(t.enumerate), self._needs_context, self._definitions
        )
        search.is_flat = c_places.is_flat(t.enumerate, self._slots)
        search.releases = not self._effects.reaches(t.enumerate, is_assignment)
        search.may_fail = search.keeps or any(
            isinstance(n, ir.Wanted | ir.UnlessLegal) for n in ir_nodes(t.enumerate)
        )
        search.sums = self._sums(t)
        search.body(t.enumerate)
        search.end_search()
        is_direct = self._is_direct(t)
        fire = self._firing(t, is_direct, variables, own, name)
        sums = self._sums(t)
        has_lists = is_direct and any(isinstance(s, ir.TakeAll | ir.PutAll) for s in t.fire)
        lists = self._firing(t, False, variables, own, name) if has_lists else None
        thresholds = self._thresholds(t, variables, own)
        text = "\n".join(fire.lines)
        roots = self._effects.roots()
        search_draws = self._effects.reaches(t.enumerate, is_draw)
        fire_draws = self._effects.reaches(t.fire, is_draw)
        return {
            "marks": [self._block(x.name, "transition", x.origin) for x in shared.instances],
            "index": t.index,
            "search_draws": search_draws,
            "fire_draws": fire_draws,
            "draws_between": search_draws and fire_draws,
            "name": t.name,
            "stem": name,
            "title": self._title(shared),
            "binding": c_rows.binding(
                name,
                self._binding_name(shared),
                [
                    (self._types.name(v.type), member, v, self._names.table(v.table))
                    for v, member in zip(t.variables, variables, strict=True)
                ],
            ),
            "guard": c_comment(f"guard [{t.guard_text}]") if t.guard_text else "",
            "origin": t.origin.describe(),
            "is_plain": c_places.is_plain(t.enumerate),
            "keeps": search.keeps and search.releases,
            "is_flat": search.is_flat,
            "search": search.lines,
            "search_reach": own.reach(search.lines, is_const=True) if own else [],
            "thresholds": thresholds,
            "thresholds_reach": own.reach(thresholds, is_const=True) if own else [],
            "thresholds_draw": self._effects.reaches(t.thresholds, is_draw),
            "searches_marking": mentions("m", "\n".join(search.lines)),
            "fire": fire.lines,
            "fire_reach": own.reach(fire.lines, is_const=False) if own else [],
            "is_direct": is_direct,
            "sums": [
                self._sum_function(s, t, name, variables)
                for s in sums.values()
                if any(f"{s.name}(" in line for line in search.lines + fire.lines)
            ],
            "lists": lists.lines if lists else [],
            "lists_reach": own.reach(lists.lines, is_const=False) if own and lists else [],
            "lists_use_binding": lists is not None and mentions("b", "\n".join(lists.lines)),
            "uses_binding": mentions("b", text),
            "touched_bags": [
                self._place_names[i]
                for i in self._effects.touched(t.index)
                if not self._net.places[i].packed
            ],
            "looks": self._effects.looks((t.enumerate, t.fire)),
            "looks_outside": self._effects.looks_outside((t.enumerate, t.fire)),
            "assigns": bool(roots) and self._effects.reaches(t.fire, is_assignment),
            "search_assigns": bool(roots)
            and self._effects.reaches((t.enumerate, t.thresholds), is_assignment),
        }

    def _predicate(self, p: ir.Predicate, number: int) -> dict[str, object]:
        s, _, _ = self._printer(p.body)
        s.body(p.body)
        return {
            "mark": self._block(p.name, "property", p.origin),
            "function": f"predicate_{number}",
            "name": p.name,
            "source": _comment_lines(p.text),
            "text": p.text,
            "origin": f"property `{p.name}`",
            "lines": s.lines,
        }

    def _thresholds(
        self, t: ir.Transition, variables: tuple[str, ...], own: OwnPlaces | None
    ) -> list[str]:
        """The search for the times at which tokens become available, without its preamble."""
        if not t.thresholds:
            return []
        search, x, _ = self._printer(t.thresholds, "b.", own)
        x.variables = variables
        search.variable_types = tuple(v.type for v in t.variables)
        search.is_void = True
        search.body(t.thresholds)
        return search.lines

    def _is_direct(self, t: ir.Transition) -> bool:
        """Whether it can be printed with the functions of its places; what is taken must be what was found."""
        takes = tuple(s.value for s in t.fire if isinstance(s, ir.Take))
        return c_places.is_direct(self._net, t, self._sums(t)) and self._effects.is_pure(takes)

    def _sums(self, t: ir.Transition) -> dict[tuple[int, ir.Ir], Sum]:
        if t.index not in self._sums_found:
            stem = self._names.transition(t.index, t.name)
            self._sums_found[t.index] = c_sums.find(
                self._net, t, stem, self._descriptors, self._effects
            )
        return self._sums_found[t.index]

    def _sum_function(
        self, s: Sum, t: ir.Transition, name: str, variables: tuple[str, ...]
    ) -> list[str]:
        _, x, _ = self._printer((), "b->")
        x.variables = variables
        return c_sums.function(
            s,
            f"{name}_binding_t",
            self._bags[s.place],
            self._names.table(s.table),
            self._numbers,
            x.text,
            lambda i: x.address(ir.Bound(i, t.variables[i].type)),
        )

    def _firing(
        self,
        t: ir.Transition,
        is_direct: bool,
        variables: tuple[str, ...],
        own: OwnPlaces | None,
        name: str,
    ) -> Statements:
        printer, x, scope = self._printer(t.fire, "b->", own)
        x.variables = variables
        if is_direct:
            scope.reserve("is_taken", "fits")
            direct = DirectFiring(
                self._types,
                x,
                scope,
                self._net.real_time,
                descriptors=self._descriptors,
                tables=tuple("" if v.is_output else v.table for v in t.variables),
                place_tables=tuple(p.table for p in self._net.places),
            )
            direct.used, direct.bags, direct.timed = printer.used, printer.bags, printer.timed
            direct.tables_of_places = printer.tables_of_places
            direct.token_types = printer.token_types
            direct.slots = self._slots
            direct.references = frozenset(g.name for g in self._net.globals if g.is_reference)
            direct.sums = self._sums(t)
            direct.otherwise = f"{name}_fire_lists(cx, m, self, b)"
            direct.variable_types = tuple(v.type for v in t.variables)
            direct.fire(t.fire, uses_context(t.fire, self._needs_context, self._definitions))
            return direct
        printer.variable_types = tuple(v.type for v in t.variables)
        printer.body(t.fire)
        return printer

    # --- the whole -----------------------------------------------------------------------------

    def _used_functions(self, *, with_predicates: bool) -> list[ir.Function]:
        roots: list[str] = []
        for predicate in self._net.predicates if with_predicates else ():
            roots += called(predicate.body)
        for t in self._net.transitions:
            roots += called(t.enumerate) + called(t.fire) + called(t.thresholds)
        for p in self._net.places:
            roots += called(p.initial)
        for g in self._net.globals:
            roots += called(g.setup)
        found: set[str] = set()
        while True:
            while roots:
                key = roots.pop()
                if key not in found:
                    found.add(key)
                    roots += called(self._functions[key].body)
            functions = [f for f in self._net.functions if f.key in found]
            tables = self._used_tables(functions, self._net.predicates if with_predicates else ())
            roots = [m for key in tables if (m := self._descriptors[key].member) and m not in found]
            if not roots:
                return functions

    def _used_tables(
        self, functions: Iterable[ir.Function], predicates: Iterable[ir.Predicate] = ()
    ) -> list[str]:
        """Keys in order of dependence."""
        roots = {p.table for p in self._net.places}
        bodies: list[object] = [f.body for f in functions]
        bodies += [p.body for p in predicates]
        for t in self._net.transitions:
            roots |= {v.table for v in t.variables}
            bodies += [t.enumerate, t.fire, t.thresholds]
        bodies += [p.initial for p in self._net.places] + [g.setup for g in self._net.globals]
        roots |= {
            g.table
            for g in self._net.globals
            if g.is_reference or self._types.holds_reference(g.type)
        }
        for b in bodies:
            for node in ir_nodes(b):
                table = getattr(node, "table", "")
                is_looked_at = not isinstance(node, ir.Op) or op_needs_table(node)
                if isinstance(table, str) and table and is_looked_at:
                    roots.add(table)
                if isinstance(node, ir.Op) and node.name == "Colset.all":
                    roots.add(f"type {node.type}")
        needed = self._closure(roots)
        return [key for key in self._descriptors if key in needed]

    def run(self) -> tuple[OutputFile, ...]:
        net = self._net
        functions = self._used_functions(with_predicates=False)
        keys = self._used_tables(functions)
        wrappers = _wrappers(functions)
        tables = c_tables.Tables(self._types, self._descriptors, wrappers)
        recursive = tables.to_declare(keys)
        transitions = [self._transition(g) for g in self._shared]  # what they call is known then
        rows = sorted(
            (
                (t.index, self._row(t, g, code))
                for g, code in zip(self._shared, transitions, strict=True)
                for t in g.instances
            ),
            key=lambda row: row[0],
        )
        further = [f for f in self._used_functions(with_predicates=True) if f not in functions]
        wrappers |= _wrappers(further)
        further_keys = [
            k for k in self._used_tables([*functions, *further], net.predicates) if k not in keys
        ]
        variables = [self._global(g) for g in net.globals]
        values = {
            "version": self._version,
            "net": net,
            "stem": stem(net.name),
            "functions": [self._function(f) for f in functions if f.key not in wrappers],
            "members": [self._member(f, wrappers) for f in functions if f.key in wrappers],
            "globals": variables,
            "forwards": [x for d in net.definitions if (x := c_tables.forward(d, self._types))],
            "bodies": [
                {"name": d.name, "lines": c_tables.body(d, self._types)} for d in net.definitions
            ],
            "recursive_tables": [self._names.table(k) for k in recursive],
            "tables": [tables.print(k) for k in keys],
            "places": [self._place(p) for p in net.places],
            "holders": list(
                {self._kept[p.index]: self._holder(p) for p in net.places if not p.packed}.values()
            ),
            "proofs": list(proofs(net.places)),
            "orders": list(self._orders.functions.values()),
            "packed_words": (packed_bits(net.places) + 63) // 64,
            "packed_size": (packed_bits(net.places) + 31) // 32 * 4,
            "transitions": transitions,
            "place_tables": [self._place_table(x) for x in self._place_tables],
            "rows": [row for _, row in rows],
            "each": c_rows.each(
                (i, str(row["code"]["stem"]), bool(row["code"]["is_plain"])) for i, row in rows
            ),
            "has_thresholds": any(t["thresholds"] for t in transitions),
            "has_words": self._has_words,
            "word_mask": self._word_mask(),
            "inlined": "PN_INLINE" if self._has_inlined else "PN_NET_SEARCH static",
            "bag_places": c_rows.braces(
                "static const uint32_t s_bag_places[] = ",
                [f"{p.index}U" for p in net.places if not p.packed],
            )
            if not all(p.packed for p in net.places)
            else [],
            "order": c_rows.braces(
                "static const uint32_t s_order[] = ", [f"{i}U" for i in net.order]
            ),
            "roots": [
                (self._names.table(g.table), self._names.value(g.name, g.hint))
                for g in self._effects.roots()
            ],
            "referring": ", ".join(f"{i}U" for i in self._referring),
            "held": [v for v in variables if v["is_root"]],
            "slot_members": frozenset(self._place_names[i] for i in self._slots),
            "has_arena_values": bool(self._referring) or any(v["is_root"] for v in variables),
        }
        # After all that belongs to the net, so that it looks the same with and without them.
        values["further_functions"] = [self._function(f) for f in further if f.key not in wrappers]
        values["further_members"] = [
            self._member(f, wrappers) for f in further if f.key in wrappers
        ]
        values["further_recursive_tables"] = [
            self._names.table(k) for k in tables.to_declare(further_keys)
        ]
        values["further_tables"] = [tables.print(k) for k in further_keys]
        values["predicates"] = [self._predicate(p, i) for i, p in enumerate(net.predicates)]
        # Compilers warn of constants that nobody looks at.
        values["globals"] = [
            g for g in variables if not g["constant"] or g["name"] in self._names.read
        ]
        # After the transitions, which want numbers of colours of their own.
        values["numbers"] = self._numbers.functions + [
            self._numbers.pointers(t)
            for t in dict.fromkeys(p.table for p in net.places if p.packed)
        ]
        source, blocks = self._extract(render("c/net.c.j2", **values))
        header, _ = self._extract(render("c/net.h.j2", **values))
        return (OutputFile("net.c", source, blocks), OutputFile("net.h", header))

    def _extract(self, text: str) -> tuple[str, tuple[Block, ...]]:
        """Take the marks of blocks out of the text and note the lines between them."""
        lines: list[str] = []
        blocks: list[Block] = []
        start: dict[str, int] = {}
        for line in text.splitlines():
            if line.startswith(_MARK):
                verb, number = line[1:].split()
                if verb == "begin":
                    start[number] = len(lines) + 1
                else:
                    element, kind, origin = self._blocks[number]
                    blocks.append(Block(element, kind, origin, start[number], len(lines)))
            elif line.strip() or (lines and lines[-1].strip()):
                lines.append(line.rstrip())
        return "\n".join(lines) + "\n", tuple(blocks)


def _wrappers(functions: Iterable[ir.Function]) -> dict[str, str]:
    """By key of the function that decides membership of a subset the name of what the subset's table points to."""
    return {f.key: f"is_{stem(f.hint)}" for f in functions if f.key.startswith("member ")}


def _without_wanted(statements: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
    """The statements that may leave something in the arena: the demands clean up after themselves."""
    out: list[ir.Stmt] = []
    for s in statements:
        if isinstance(s, ir.Wanted):
            out.extend(x for x in s.takes if not isinstance(x, (ir.Take, ir.TakeAll)))
        elif isinstance(s, ir.ForTokens):
            out.append(ir.ForTokens(s.place, s.index, _without_wanted(s.body), s.note))
        elif isinstance(s, ir.ForValues):
            out.append(ir.ForValues(s.variable, s.table, _without_wanted(s.body), s.note))
        else:
            out.append(s)
    return tuple(out)


def _where(origin: Origin) -> str:
    """File, without its folder, and line."""
    name = origin.file.replace("\\", "/").rsplit("/", 1)[-1]
    return c_comment(f"{name}:{origin.line}" if origin.line else name)


def _comment_lines(source: str) -> list[str]:
    """The ML text as comment lines, blank lines left out."""
    return [
        c_comment(line) if not line.startswith(" ") else _indented(line)
        for line in source.expandtabs(4).splitlines()
        if line.strip()
    ]


def _indented(line: str) -> str:
    text = line.lstrip()
    return " " * (len(line) - len(text)) + c_comment(text)


def _initial(zero: str, rep: Rep) -> str:
    """The harmless value as the initialiser of a static variable."""
    if rep is Rep.STRING:
        return '{ "", 0U }'
    if rep is Rep.BIG:
        return c_big_initialiser(0)
    return "{ 0 }" if rep in (Rep.STRUCT, Rep.UNION) else zero
