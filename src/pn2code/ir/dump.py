"""A readable dump of `NetIR`: what people and tests look at.

transition 0 Top.Pick   (ID7) owner 0 priority 1000
  variables n: int
  enumerate
    for i in Top.Buffer   -- Buffer: n (ID9)
      bind n = Top.Buffer[i]
      unless n > 0: next   -- guard [n > 0]
      yield
  fire
    take Top.Buffer 1 ` n
    put Top.Out 1 ` n
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields

from pn2code.ir import nodes as ir
from pn2code.ir.effects import Effects
from pn2code.ir.nodes import Ir, NetIR, Stmt


def dump(net: NetIR, only: str = "") -> str:
    """The whole net, or only the elements whose name contains `only`."""
    return "\n".join(_Dump(net).lines(only)) + "\n"


class _Dump:
    def __init__(self, net: NetIR) -> None:
        self._net = net
        self._variables: tuple[ir.Variable, ...] = ()

    def lines(self, only: str) -> Iterator[str]:
        net = self._net
        if not only:
            yield f"net {net.name} from {net.source}" + (" timed" if net.timed else "")
            yield from (self._definition(d) for d in net.definitions)
            yield from self._globals()
            yield from self._used()
        for f in net.functions:
            if only in f.hint:
                yield from self._function(f)
        for p in net.places:
            if only in p.name:
                yield from self._place(p)
        for t in net.transitions:
            if only in t.name:
                yield from self._transition(t)
        yield from self._shared(only)

    def _shared(self, only: str) -> Iterator[str]:
        """Which transitions have one C function, and which places stand in it for others."""
        for shared in self._net.shared:
            names = [self._net.transitions[i].name for i in shared.instances]
            if len(names) == 1 or not any(only in name for name in names):
                continue
            yield f"shared by {', '.join(names)}"
            if shared.table is None:
                continue
            table = self._net.place_tables[shared.table]
            for column in shared.columns:
                places = (self._place_name(row[column]) for row in table.rows)
                yield f"  {table.names[column]} is {', '.join(places)}"

    @staticmethod
    def _definition(d: ir.Definition) -> str:
        match d:
            case ir.EnumDef(name=name, constructors=constructors):
                return f"enum {name} = {' | '.join(constructors)}"
            case ir.StructDef(name=name, fields=fields):
                return f"struct {name} {{{', '.join(f'{label}: {t}' for label, t in fields)}}}"
            case ir.ListDef(name=name, element=element):
                return f"list {name} of {element}"
            case ir.UnionDef(name=name, constructors=union):
                parts = [c if a is None else f"{c} of {'@' * boxed}{a}" for c, a, boxed in union]
                return f"union {name} = {' | '.join(parts)}"
            case ir.RefDef(name=name, target=target):
                return f"ref {name} to {target}"

    def _globals(self) -> Iterator[str]:
        for g in self._net.globals:
            flags = _flags(held=g.is_held, constant=g.constant is not None)
            yield f"{'ref' if g.is_reference else 'val'} {g.name}: {g.type}{flags}"
            yield from self._block(g.setup, 1)
        if self._net.roots:
            yield f"state besides the marking {', '.join(self._net.roots)}"

    def _used(self) -> Iterator[str]:
        used = self._net.used
        for what, keys in (("tables", used.tables), ("tables of predicates", used.further_tables)):
            if keys:
                yield f"{what} {', '.join(keys)}"
        if used.files:
            yield "reads or writes files"
        if used.makers:
            yield f"allocates in {', '.join(used.makers)}"
        if self._net.has_moves:
            yield "has lists of moves"
        arena = self._net.arena
        if arena.bytes is None:
            yield f"arena not proven: {arena.why}"
        else:
            yield f"arena {arena.bytes:,} bytes"

    def _use(self, f: ir.Function) -> str:
        used = self._net.used
        if f.key in used.functions:
            return ""
        return " of predicates" if f.key in used.further_functions else " unused"

    def _function(self, f: ir.Function) -> Iterator[str]:
        parameters = ", ".join(f"{_local(p)}: {p.type}" for p in f.parameters)
        flags = (" loops" if f.loops else "") + (" recursive" if f.recursive else "")
        flags += ("" if f.is_pure else " impure") + (" context" if f.needs_context else "")
        flags += self._use(f) + (f" unread {', '.join(map(_local, f.unread))}" if f.unread else "")
        yield f"function {f.key}({parameters}): {f.result}{flags}"
        yield from self._block(f.body, 1)

    def _place(self, p: ir.Place) -> Iterator[str]:
        timed = " timed" if p.timed else ""
        added = f" + {p.added}" if p.added else ""
        flags = _flags(slot=p.is_slot, refers=p.refers, arrives=p.arrives)
        yield f"place {p.index} {p.name} : {p.colset}{timed} capacity {p.capacity}{added} owner {p.owner}{flags}"
        yield from self._block(p.initial, 1)

    def _transition(self, t: ir.Transition) -> Iterator[str]:
        self._variables = t.variables
        yield f"transition {t.index} {t.name}   ({t.id}) owner {t.owner} priority {t.priority}"
        if t.variables:
            parts = [f"{v.name}: {v.type}{' output' if v.is_output else ''}" for v in t.variables]
            yield f"  variables {', '.join(parts)}"
        if t.staying:
            yield f"  stays {', '.join(self._staying(t))}"
        yield from self._effects(t.effects)
        for what, access in (
            ("search", t.search_access),
            ("fire", t.fire_access),
            ("fire by lists", t.lists_access),
            ("thresholds", t.thresholds_access),
        ):
            if access is not None and (said := self._access(access)):
                yield f"  {what} names {said}"
        for found in t.sums:
            place, x = self._place_name(found.place), self._expression
            yield f"  once for each of {found.count} {place} {x(found.multiset)}{_note(found.note)}"
        yield f"  enumerate{_flags(plain=t.is_plain, flat=t.is_flat, context=t.search_needs_context)}"
        yield from self._block(t.enumerate, 2)
        yield f"  fire{_flags(direct=t.is_direct, context=t.fire_needs_context)}"
        yield from self._block(t.fire, 2)
        if t.counts is not None:
            yield "  counts"
            for c in t.counts:
                name = self._place_name(c.place)
                yield f"    {name} needs {c.needs} takes {c.takes} puts {c.puts}"
        if t.thresholds:
            yield "  thresholds"
            yield from self._block(t.thresholds, 2)

    def _staying(self, t: ir.Transition) -> Iterator[str]:
        for position, _ in t.staying:
            take = t.fire[position]
            assert isinstance(take, ir.Take)
            yield self._move(take.place, take.count, take.value, None)

    def _access(self, a: ir.Access) -> str:
        """What a program names in C; "": nothing."""
        parts = [self._place_name(p) for p in a.holders]
        parts += [f"table of {self._place_name(p)}" for p in a.tables]
        parts += [f"sum {number + 1}" for number in a.sums]
        return ", ".join([*parts, "binding"] if a.binding else parts)

    def _effects(self, e: Effects) -> Iterator[str]:
        for verb, places in (("reads", e.read), ("touches", e.touched)):
            if places:
                yield f"  {verb} {', '.join(map(self._place_name, places))}"
        if e.affected:
            yield f"  affects {', '.join(self._net.transitions[i].name for i in e.affected)}"
        if found := [f.name.replace("_", " ") for f in fields(e) if getattr(e, f.name) is True]:
            yield f"  also {', '.join(found)}"

    # --- statements ----------------------------------------------------------------------------

    def _block(self, statements: tuple[Stmt, ...], depth: int) -> Iterator[str]:
        for s in statements:
            yield from self._statement(s, depth)

    def _statement(self, s: Stmt, depth: int) -> Iterator[str]:
        pad = "  " * depth
        x = self._expression
        match s:
            case ir.If():
                yield f"{pad}if {x(s.condition)}"
                yield from self._block(s.then, depth + 1)
                if s.otherwise:
                    yield f"{pad}else"
                    yield from self._block(s.otherwise, depth + 1)
            case ir.While():
                yield f"{pad}while"
                yield from self._block(s.setup, depth + 1)
                yield f"{pad}  holds {x(s.condition)}"
                yield from self._block(s.body, depth + 1)
            case ir.ForList():
                until = f" until {_local(s.until)}" if s.until else ""
                yield f"{pad}for cell {_local(s.cell)} of {x(s.list)}{until}"
                yield from self._block(s.body, depth + 1)
            case ir.ForCount():
                yield f"{pad}for {_local(s.local)} below {x(s.count)}"
                yield from self._block(s.body, depth + 1)
            case ir.ForTokens():
                yield f"{pad}for {_local(s.index)} in {self._place_name(s.place)}{_note(s.note)}"
                yield from self._block(s.body, depth + 1)
            case ir.ForValues():
                yield f"{pad}for {self._variables[s.variable].name} over {s.table}{_note(s.note)}"
                yield from self._block(s.body, depth + 1)
            case ir.Wanted():
                yield f"{pad}unless there is{' and no Bind' if s.may_bind else ''}: next"
                yield from self._block(s.takes, depth + 1)
            case _:
                yield pad + self._simple(s)

    def _simple(self, s: Stmt) -> str:
        x = self._expression
        match s:
            case ir.Let():
                return f"{'var' if s.mutable else 'let'} {_local(s.local)} = {x(s.value)}"
            case ir.Declare(local=local):
                return f"var {_local(local)}: {local.type}"
            case ir.Assign():
                return f"{_local(s.local)} := {x(s.value)}"
            case ir.Fill():
                return f"{_local(s.local)} := {s.table}.{s.name}({', '.join(map(x, s.arguments))})"
            case ir.SetGlobal():
                return f"{s.name} := {x(s.value)}"
            case ir.Do():
                return f"do {x(s.value)}"
            case ir.Return(value=value):
                return "return" if value is None else f"return {x(value)}"
            case ir.SelfCall():
                return f"again({', '.join(map(x, s.arguments))})"
            case ir.Raise(name=name):
                return f"raise {name}"
            case ir.RaiseValue(value=value):
                return f"raise value {x(value)}"
            case ir.SetContents():
                return f"{x(s.reference)} := {x(s.value)}"
            case ir.ClearError():
                return "handled"
            case ir.Note(text=text):
                return f"-- {text}"
            case ir.Bind():
                return f"bind {self._variables[s.variable].name} = {x(s.value)}"
            case ir.Unless():
                return f"unless {x(s.condition)}: next{_note(s.note)}"
            case ir.UnlessLegal():
                return f"unless {self._variables[s.variable].name} in {s.table}: next"
            case ir.UnlessAvailable():
                limit = f" by {x(s.limit)}" if s.limit is not None else ""
                token = f"{self._place_name(s.place)}[{_local(s.index)}]"
                return f"unless {s.count} of {token}{limit}: next"
            case ir.UnlessBind():
                return "unless no Bind: next"
            case ir.UnlessHeld():
                move = self._move(s.place, ir.Const(s.count, ir.INT), s.value, s.limit)
                return f"unless {move}: next{_note(s.note)}"
            case ir.UnlessEmpty():
                return f"unless {self._place_name(s.place)} is empty: next{_note(s.note)}"
            case ir.Yield():
                return "yield"
            case ir.Take():
                flags = _flags(found=s.is_found)
                return (
                    f"take {self._move(s.place, s.count, s.value, s.limit)}{flags}{_note(s.note)}"
                )
            case ir.Put():
                flags = _flags(legal=s.is_legal)
                return f"put {self._move(s.place, s.count, s.value, s.stamp)}{flags}{_note(s.note)}"
            case ir.TakeAll():
                return f"take all {self._place_name(s.place)} {x(s.multiset)}{_note(s.note)}"
            case ir.PutAll():
                return f"put all {self._place_name(s.place)} {x(s.multiset)}{_note(s.note)}"
            case ir.Threshold():
                return f"threshold {self._place_name(s.place)} - {x(s.delay)}{_note(s.note)}"
            case ir.Reset():
                return f"reset {self._place_name(s.place)}{_note(s.note)}"
            case _:
                raise AssertionError(f"a statement with a block: {type(s).__name__}")

    def _move(self, place: int, count: Ir, value: Ir, time: Ir | None) -> str:
        x = self._expression
        stamp = f" @ {x(time)}" if time is not None else ""
        return f"{self._place_name(place)} {x(count)} ` {x(value)}{stamp}"

    def _place_name(self, index: int) -> str:
        return self._net.places[index].name

    # --- expressions ---------------------------------------------------------------------------

    def _expression(self, e: Ir) -> str:
        x = self._expression
        match e:
            case ir.Const(value=value):
                return "()" if value is None else repr(value)
            case ir.Use(local=local):
                return _local(local)
            case ir.GlobalUse(name=name):
                return name
            case ir.Bound(index=index):
                return self._variables[index].name
            case ir.TokenValue():
                return f"{self._place_name(e.place)}[{_local(e.index)}]"
            case ir.PlaceTokens(place=place):
                return f"tokens of {self._place_name(place)}"
            case ir.PlaceTotal(place=place):
                return f"number of tokens of {self._place_name(place)}"
            case ir.Now():
                return "now"
            case ir.FunCall():
                return f"{e.function}({', '.join(map(x, e.arguments))})"
            case ir.Op(name=name, arguments=(a, b)) if not name[-1].isalpha():
                return f"({x(a)} {name} {x(b)})"
            case ir.Op():
                return f"{e.name}({', '.join(map(x, e.arguments))})"
            case ir.Member():
                return f"{x(e.record)}.{e.label}"
            case ir.MakeStruct():
                fields = ", ".join(f"{label} = {x(v)}" for label, v in e.fields)
                return f"{e.type}{{{fields}}}"
            case ir.EnumValue():
                return f"{e.type}#{e.tag}"
            case ir.MakeUnion():
                return f"{e.type}#{e.tag}" + (f"({x(e.argument)})" if e.argument else "")
            case ir.IsTag():
                return f"{x(e.value)} is #{e.tag}"
            case ir.Argument():
                return f"{x(e.value)}#{e.tag}"
            case ir.Select():
                return f"({x(e.condition)} ? {x(e.then)} : {x(e.otherwise)})"
            case ir.Head(list=inner):
                return f"{x(inner)}.head"
            case ir.Tail(list=inner):
                return f"{x(inner)}.tail"
            case ir.IsNil(list=inner):
                return f"{x(inner)} is nil"
            case ir.Ok():
                return "no error"
            case ir.HasError(name=name):
                return f"error is {name or 'any'}"
            case ir.NewRef(value=inner):
                return f"ref({x(inner)})"
            case ir.AddressOf(name=name):
                return f"&{name}"
            case ir.Contents(reference=inner):
                return f"!{x(inner)}"
            case ir.HasPacket():
                return "error has a value"
            case ir.Packet():
                return "error value"


def _local(local: ir.Local) -> str:
    return f"{local.hint}{'' if local.uid < 0 else f'_{local.uid}'}"


def _flags(**flags: bool) -> str:
    return "".join(f" {name}" for name, holds in flags.items() if holds)


def _note(text: str) -> str:
    return f"   -- {text}" if text else ""
