"""`NetIR` -> `net.c` and `net.h`: the whole net as one C translation unit behind `pn_net`.

All decisions are made before the templates run; they only print. Each transition, place and function of the
net is a `Block` of the file, so that a compiler message or a reader finds the way back to the net.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.how_far import counted
from pn2code.emission import c_rows, c_tables
from pn2code.emission.c_lines import wrap
from pn2code.emission.c_literals import c_big_initialiser
from pn2code.emission.c_proofs import proofs
from pn2code.emission.c_texts import comment_lines, initial, where
from pn2code.emission.c_transitions import Transitions
from pn2code.emission.environment import render
from pn2code.emission.names import stem
from pn2code.emission.output import Block, OutputFile
from pn2code.ir import nodes as ir
from pn2code.ir.nodes import NetIR, Rep
from pn2code.lowering.nets.packing import packed_bits

_MARK = "\x01"


def emit(net: NetIR, version: str) -> tuple[OutputFile, ...]:
    """`net.c` and `net.h`."""
    return _Emitter(net, version).run()


class _Emitter(Transitions):
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

    def _word_mask(self) -> str:
        """What takes away what follows from the rest of the first word of the packed part."""
        has_more = any(p.packed and p.packed.shares and p.packed.bit < 64 for p in self._net.places)
        return f" & 0x{self._key:x}U" if has_more else ""

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
        for p in f.unread:
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
            "title": where(f.origin),
            "source": comment_lines(f.source),
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

    def _global(self, g: ir.Global) -> dict[str, object]:
        s, x, _ = self._printer(g.setup)
        s.body(g.setup)
        name = self._names.value(g.name, g.hint)
        constant = ""
        value = g.constant
        if value is not None and value.type.rep in (Rep.INT, Rep.REAL, Rep.BOOL):
            constant = x.text(value)
        elif value is not None and isinstance(value.value, int) and value.type == ir.BIG:
            constant = c_big_initialiser(value.value)
        return {
            "mark": self._block(g.hint, "declaration", g.origin),
            "title": where(g.origin),
            "source": comment_lines(g.source),
            "type": self._types.name(g.type),
            "name": name,
            "constant": constant,
            "zero": initial(self._types.zero(g.type), g.type.rep),
            "is_root": g.is_held,
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
        member, multiset = self._place_names[p.index], self._names.multiset(p.index, p.name)
        early = f"s_early_{member}"
        return {
            "mark": self._block(p.name, "place", p.origin),
            "index": p.index,
            "name": p.name,
            "is_only_counted": p.is_only_counted,
            "member": member,
            "multiset": multiset,
            "colset": p.colset,
            "origin": p.origin.describe(),
            "type": self._types.name(p.type),
            "packed": p.packed,
            "kind": self._kind(p),
            "is_whole": not p.packed or not self._numbers.members(p.table),
            "number_of": self._numbers.number_of(p.table) if p.packed else "",
            "early": c_rows.early(early, p, self._net.real_time) if p.early else [],
            "multiset_lines": c_rows.multiset(
                multiset,
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
                multiset,
                f"{member}_init" if p.initial else "",
                f"s_shares_of_{member}" if p.packed and p.packed.shares else "",
            ),
            "shares": p.packed.shares if p.packed else (),
            "is_slot": p.index in self._slots,
            "kept": self._kept[p.index],
            "initial": s.lines,
            "initial_text": comment_lines(p.initial_text),
        }

    def _kind(self, p: ir.Place) -> str:
        """The stem of the functions that a packed place has with others; "": it has its own."""
        packed = self._packed[p.index]
        return packed.kind if packed else ""

    def _first_of_kinds(self) -> frozenset[int]:
        """The places at which functions are printed that places share."""
        first: dict[str, int] = {}
        for p in self._net.places:
            if self._kind(p) and not p.is_only_counted:
                first.setdefault(self._kind(p), p.index)
        return frozenset(first.values())

    def _where_kept(self, p: ir.Place, member: str) -> str:
        """The macro for the offsets of what holds the tokens of a place; "": it is packed."""
        if p.packed:
            return ""
        kind = "SLOT" if p.index in self._slots else "STAMPS" if p.timed else "TOKENS"
        return f"PN_MULTISET_{kind}(net_marking_t, {member})"

    def _predicate(self, p: ir.Predicate, number: int) -> dict[str, object]:
        s, _, _ = self._printer(p.body)
        s.body(p.body)
        return {
            "mark": self._block(p.name, "property", p.origin),
            "function": f"predicate_{number}",
            "name": p.name,
            "source": comment_lines(p.text),
            "text": p.text,
            "origin": f"property `{p.name}`",
            "lines": s.lines,
        }

    def run(self) -> tuple[OutputFile, ...]:
        net = self._net
        functions = [self._functions[key] for key in net.used.functions]
        keys = list(net.used.tables)
        wrappers = _wrappers(functions)
        tables = c_tables.Tables(self._types, self._descriptors, wrappers)
        recursive = tables.to_declare(keys)
        groups = counted(net.shared, "writing transitions")
        transitions = [self._transition(g) for g in groups]  # what they call is known then
        rows = sorted(
            (
                (i, self._row(net.transitions[i], g, code), code)
                for g, code in zip(net.shared, transitions, strict=True)
                for i in g.instances
            ),
            key=lambda row: row[0],
        )
        further = [self._functions[key] for key in net.used.further_functions]
        wrappers |= _wrappers(further)
        further_keys = list(net.used.further_tables)
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
            "first_of_kinds": self._first_of_kinds(),
            "places": [self._place(p) for p in net.places],
            "holders": list(
                {self._kept[p.index]: self._holder(p) for p in net.places if not p.packed}.values()
            ),
            "proofs": list(proofs(net.places)),
            "orders": list(self._orders.functions.values()),
            "is_counting": any(t.counts is not None for t in net.transitions),
            "is_all_counting": all(t.counts is not None for t in net.transitions),
            "shares_successors": any(t.get("shares_successors") for t in transitions),
            "packed_words": (packed_bits(net.places) + 63) // 64,
            "packed_size": (packed_bits(net.places) + 31) // 32 * 4,
            "transitions": transitions,
            "place_tables": [self._place_table(x) for x in net.place_tables],
            "rows": [row for _, row, _ in rows],
            "each": c_rows.each(
                (i, str(code["stem"]), bool(code["is_plain"])) for i, _, code in rows
            ),
            "has_thresholds": any(t["thresholds"] for t in transitions),
            "has_words": self._has_words,
            "word_mask": self._word_mask(),
            "inlined": "PN_INLINE" if self._has_inlined else "PN_NET_SEARCH static",
            "multiset_places": c_rows.braces(
                "static const uint32_t s_multiset_places[] = ",
                [f"{p.index}U" for p in net.places if not p.packed],
            )
            if not all(p.packed for p in net.places)
            else [],
            "order": c_rows.braces(
                "static const uint32_t s_order[] = ", [f"{i}U" for i in net.order]
            )
            if net.order
            else [],
            "roots": [
                (self._names.table(g.table), self._names.value(g.name, g.hint))
                for g in net.globals
                if g.name in net.roots
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
            elif (text := line.rstrip()) or (lines and lines[-1]):
                lines.append(text)
        return "\n".join(lines) + "\n", tuple(blocks)


def _wrappers(functions: Iterable[ir.Function]) -> dict[str, str]:
    """By key of the function that decides membership of a subset the name of what the subset's table points to."""
    return {f.key: f"is_{stem(f.hint)}" for f in functions if f.key.startswith("member ")}
