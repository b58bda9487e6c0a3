"""`Partition` -> `NetIR`: places, initial marking, and for each transition how to enumerate its bindings and
how to fire.

`lower(partition, storage, d)`; what cannot be compiled is one diagnostic `unsupported-...` per net element,
and then there is no `NetIR`.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property, partial
from typing import TypeVar

from pn2code.base.frozen import replace
from pn2code.base.how_far import counted
from pn2code.cell.partition import Partition
from pn2code.diagnostics import Diagnostics, Origin
from pn2code.ir import nodes as ir
from pn2code.ir.calls import ir_nodes
from pn2code.lowering.codes import STORAGE_COLSET, UnsupportedError
from pn2code.lowering.expressions.body import Body
from pn2code.lowering.expressions.builtins import Builtins
from pn2code.lowering.expressions.functions import Program
from pn2code.lowering.expressions.types import Types
from pn2code.lowering.nets.inscriptions import Putter
from pn2code.lowering.nets.packing import Packing, packed
from pn2code.lowering.nets.predicates import lower_predicate
from pn2code.lowering.nets.transitions import lower_transition
from pn2code.lowering.passes.analysis import analysed
from pn2code.ml.core.colsets import Colset, Kind
from pn2code.ml.core.terms import Exp
from pn2code.ml.core.types import BOOL
from pn2code.net.flat import FlatNet, FlatPlace, FlatTransition
from pn2code.net.predicate import Predicate

T = TypeVar("T")

DEFAULT_CAPACITY = 64
MOST_CAPACITY = 4096
UNKNOWN_ENTRIES = 128


def lower(
    partition: Partition,
    storage: Mapping[str, str],
    d: Diagnostics,
    *,
    capacity: Mapping[str, int] | None = None,
    packing: Packing | None = None,
    digest: str = "",
    predicates: Sequence[Predicate] = (),
) -> ir.NetIR | None:
    """Lower the whole net.

    Args:
        partition: the typed net and its owners.
        storage: colour set -> "float32", from cell.toml.
        capacity: by place name (full or short), how many entries (distinct colours; timed: with distinct
        stamps) it has room
            for; all others see `_Lowering._room`.
        packing: which places are packed, and how; None: none is.
        digest: SHA-256 of the net and of what the cell contributes; the net's own by default.
        predicates: what is asked of markings, beside the net.
    """
    return _Lowering(partition, storage, d, capacity or {}, packing, digest, predicates).run()


class _Lowering:
    def __init__(
        self,
        partition: Partition,
        storage: Mapping[str, str],
        d: Diagnostics,
        capacity: Mapping[str, int],
        packing: Packing | None,
        digest: str,
        predicates: Sequence[Predicate],
    ) -> None:
        self._partition = partition
        self._net: FlatNet = partition.net
        self._storage = storage
        self._d = d
        self._capacity = capacity
        self._packing = packing
        self._predicates = predicates
        self._digest = digest or self._net.sha256
        self._types = Types(self._net.program, storage)
        builtins = Builtins(self._net.real_time)
        self._program = Program(self._net.program, self._types, builtins, self._net.real_time, Body)
        self._program.lists_are_functions = packing is not None
        channels, inputs = partition.channels, partition.inputs
        self._arriving = {c.place for c in channels} | {i.place for i in inputs}
        self._failed = False

    def run(self) -> ir.NetIR | None:
        self._check_storage()
        places = [self._guarded(p.origins[0], partial(self._place, p)) for p in self._net.places]
        transitions: list[ir.Transition | None] = []
        if not self._failed:
            transitions = [
                self._guarded(t.origin, partial(self._transition, t))
                for t in counted(self._net.transitions, "translating transitions")
            ]
        predicates = [
            self._guarded(p.exp.span.origin, partial(self._predicate, p)) for p in self._predicates
        ]
        functions = self._guarded(Origin(self._net.file), self._functions) or ()
        if self._failed:
            return None
        room = self._room([p for p in places if p is not None])
        order = sorted(
            range(len(transitions)), key=lambda i: (self._net.transitions[i].priority, i)
        )
        net = ir.NetIR(
            name=self._net.name,
            source=self._net.file.replace("\\", "/").rsplit("/", 1)[-1],
            sha256=self._net.sha256,
            digest=self._digest,
            timed=self._net.timed,
            real_time=self._net.real_time,
            definitions=self._types.definitions(),
            descriptors=tuple(self._types.descriptors.values()),
            globals=self._program.globals(),
            functions=functions,
            places=self._packed(
                [replace(p, capacity=p.capacity or room) for p in places if p is not None]
            ),
            transitions=tuple(t for t in transitions if t is not None),
            owners=tuple(o.name for o in self._partition.owners),
            order=tuple(order),
            int_bits=self._net.program.int_bits,
            has_successors=self._packing is not None and self._packing.successors,
            predicates=tuple(p for p in predicates if p is not None),
        )
        return analysed(net)

    def _packed(self, places: list[ir.Place]) -> tuple[ir.Place, ...]:
        if self._packing is None:
            return tuple(places)
        return packed(places, self._types.descriptors, self._packing)

    def _guarded(self, origin: Origin, make: Callable[[], T]) -> T | None:
        self._program.position = origin
        try:
            return make()
        except UnsupportedError as e:
            at = e.at if e.at != Origin("") else origin
            self._d.error(e.code, e.message, at, hint=e.hint)
            self._failed = True
            return None

    def _check_storage(self) -> None:
        for name, form in self._storage.items():
            colset = self._net.program.colsets.get(name)
            if colset is None or colset.resolved.kind is not Kind.REAL or form != "float32":
                self._d.error(
                    STORAGE_COLSET,
                    f'`[storage]` says `{name} = "{form}"`, but '
                    + (
                        "there is no such colour set"
                        if colset is None
                        else "that is not a real colour set stored as float32"
                    ),
                    colset.origin if colset is not None else Origin(self._net.file),
                    hint="name a colour set of kind real, and `float32`",
                )
                self._failed = True

    def _transition(self, t: FlatTransition) -> ir.Transition:
        return lower_transition(
            self._program, self._net, t, self._partition.transition_owner[t.index]
        )

    def _predicate(self, p: Predicate) -> ir.Predicate:
        return lower_predicate(self._program, self._net, p)

    def _place(self, place: FlatPlace) -> ir.Place:
        self._types.lower(place.colset.type, place.colset.origin)
        table = self._types.colset(place.colset)
        body = Body(self._program)
        text = ""
        if place.initial is not None:
            exp, form = place.initial
            zero = ir.Const(0.0, ir.REAL) if self._net.real_time else ir.Const(0, ir.INT)
            stamp = zero if place.colset.timed else None
            Putter(body, place.index, {}, stamp, None, "").put(exp, form)
            text = exp.span.source.text
        owner = self._partition.place_owner[place.index]
        return ir.Place(
            index=place.index,
            name=place.name,
            colset=place.colset.name,
            origin=place.origins[0],
            owner=-1 if owner is None else owner,
            type=self._types.lower(place.colset.type),
            table=table,
            timed=place.colset.timed,
            capacity=self._capacity.get(place.name, self._capacity.get(place.short, 0)),
            initial=tuple(body.statements),
            initial_text=text,
            early=self._early(place),
            arrives=place.index in self._arriving,
        )

    def _room(self, places: list[ir.Place]) -> int:
        """Entries for each place that nothing is declared for: twice what the initial markings hold together,
        since tokens gather where they like, but at least `DEFAULT_CAPACITY` and at most `MOST_CAPACITY`."""
        entries = 0
        for place in places:
            for node in ir_nodes(place.initial):
                if isinstance(node, ir.Put):
                    entries += 1
                elif isinstance(node, ir.PutAll):
                    entries += self._entries(node.multiset)
        return min(max(2 * entries, DEFAULT_CAPACITY), MOST_CAPACITY)

    def _entries(self, multiset: ir.Ir) -> int:
        if isinstance(multiset, ir.Op) and multiset.name == "Colset.all":
            return self._types.count(multiset.table)
        return UNKNOWN_ENTRIES

    def _early(self, place: FlatPlace) -> tuple[int | float, ...]:
        """The constant delays of input arcs from a place, which decide when time goes on."""
        found = {self._program.constant(delay) for delay in self._delays.get(place.index, ())}
        return tuple(sorted(value for value in found if value))

    @cached_property
    def _delays(self) -> Mapping[int, list[Exp]]:
        """Of the arcs of each place, in order."""
        found: dict[int, list[Exp]] = defaultdict(list)
        for t in self._net.transitions:
            for arc in t.arcs:
                for term in () if arc.inscription is None else arc.inscription.terms:
                    if term.delay is not None:
                        found[arc.place].append(term.delay)
        return found

    def _functions(self) -> tuple[ir.Function, ...]:
        """All functions, and those that decide membership of subsets: each of these may bring in others of both."""
        members: list[ir.Function] = []
        seen = 0
        while True:
            while seen < len(self._types.subsets):
                key, colset = self._types.subsets[seen]
                seen += 1
                function = self._guarded(colset.origin, partial(self._member, key, colset))
                if function is not None:
                    members.append(function)
            self._program.position = Origin(self._net.file)
            self._program.make_pending()
            if seen == len(self._types.subsets):
                return (*self._program.finish(), *members)

    def _member(self, key: str, colset: Colset) -> ir.Function:
        t = self._types.lower(colset.type)
        value = ir.Local(-1, "value", t)
        body = Body(self._program)
        if colset.predicate is not None:
            predicate = body.exp(colset.predicate, {})
            result = body.code(body.apply(predicate, ir.Use(value), BOOL, colset.predicate.span))
        else:
            assert colset.members is not None
            members = body.ir(colset.members, {})
            result = ir.Op(
                "List.mem", (members, ir.Use(value)), ir.BOOL, self._types.plain(members.type)
            )
        body.emit(ir.Return(result))
        source = colset.predicate or colset.members
        assert source is not None
        return ir.Function(
            f"member {key}", f"member_{colset.name}", (value,), ir.BOOL, tuple(body.statements), False, False,
            source.span.text, colset.origin,
        )  # fmt: skip
