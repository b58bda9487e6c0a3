"""Compiled explorers: a net and the host `explore`.

with program(net, {}, Sizes.start(net, {}), d) as built:      # None after a diagnostic
    subprocess.run([built, "--threads", "2"])
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field, replace
from pathlib import Path

import pn2code
from pn2code.base.frozen import frozen, record
from pn2code.cell.divide import divide
from pn2code.diagnostics import Diagnostics
from pn2code.emission import c as emit_c
from pn2code.emission.output import OutputFile
from pn2code.ir import nodes as ir
from pn2code.lowering.nets import net as lower_net
from pn2code.lowering.nets.packing import Packing, choose
from pn2code.net.flat import FlatNet
from pn2code.net.predicate import Predicate
from pn2code.semantics.evaluation.files import Files
from pn2code.semantics.game.token_game import Game
from pn2code.structure import Sum, bounds_and_sums
from pn2code.structure.bounds import PlaceBound
from pn2code.toolchain import programs
from pn2code.toolchain.programs import Host

HOST = Host("explore", flags=("-pthread",), own=("-march=native",), libraries=("-pthread", "-lm"))
"""Explorers run where they are compiled, so the search and its store may use all that the processor has. The net,
and the runtime that computes its values, are compiled as everywhere else."""
QUICK = replace(HOST, net=("-O0",))
"""For small spaces: compiled in a fifth of the time. Only the net is slower, up to three times; the explorer is not."""
LARGE = replace(HOST, net=("-DPN_MANY", "-Og", "-finline"))
"""For nets of many transitions: a quarter of the compiler's time, and the explorer is as fast (docs/benchmarks.md).
Functions may be put where they are called: it is compiled for large spaces only."""
MANY = 40
"""Transitions of a net that is worth to be compiled quickly first."""
FIRST_STATES = 100_000
"""So many states are soon seen also by what was compiled quickly."""
ROOM = 16
"""Different tokens that a place can hold at first; what proves too little is made more, place by place."""
MOST_ROOM = 1 << 20
MEMORY = 1 << 26
"""Bytes for the lists and strings of one thread, at first."""
MOST_MEMORY = 1 << 32
GROWTH = 4
Structure = tuple[Mapping[int, PlaceBound], tuple[Sum, ...]]
"""What `bounds_and_sums` gives."""
FEW = 2
"""Places that get more one by one, before all do that may need it."""


@frozen
class Sizes:
    """What the places of a compiled net hold.

    Args:
        packing: the widths of counters.
        room: by name of the place, different tokens; all others `ROOM`.
        memory: bytes for lists and strings.
        proven: places whose counters are wide enough for all that can come.
        enlarged: how often a place turned out to hold more.
        bounds: by place (index), most tokens, where the structure proves it; None: it was not looked at.
    """

    packing: Packing
    room: Mapping[str, int] = field(default_factory=dict)
    memory: int = MEMORY
    proven: frozenset[str] = frozenset()
    enlarged: int = 0
    bounds: Mapping[int, int] | None = None

    @staticmethod
    def start(net: FlatNet, storage: Mapping[str, str], known: Structure | None = None) -> Sizes:
        """From what the places hold at first, and what the structure proves (unless that is `known`).

        Raises:
            GameError: a declaration or an initial marking raises an exception.
        """
        marking = Game(net, storage, files=Files(None)).marking
        counts = [Counter(tokens).values() for tokens in marking.places]
        room = {
            p.name: max(ROOM, 2 * len(tokens)) for p, tokens in zip(net.places, counts, strict=True)
        }
        bounds, sums = known or bounds_and_sums(net, storage=storage)
        proven = {k: b.per_colour for k, b in bounds.items() if b.per_colour is not None}
        more = {k: n for k, n in room.items() if n > ROOM}
        return Sizes(
            choose(net, counts, proven, sums),
            more,
            proven=frozenset(net.places[i].name for i in proven),
            bounds={k: b.bound for k, b in bounds.items() if b.bound is not None},
        )

    def held(self, place: str) -> int:
        """How many tokens of one colour, or (of a place that is not packed) different tokens, it has room for."""
        width = self.packing.of(place)
        return (1 << width) - 1 if width > 0 else self.room.get(place, ROOM)

    def larger(self, place: str | None) -> Sizes | None:
        """With more for a place, or (None) for lists and strings; None at the end of all sizes."""
        if place is None:
            return replace(self, memory=self.memory * GROWTH) if self.memory < MOST_MEMORY else None
        room = self.room.get(place, ROOM) * GROWTH
        if room > MOST_ROOM:
            return None
        packing = self.packing.wider(place)
        width = packing.of(place)
        if self.enlarged >= FEW and width > 0:
            # Others will be next. To find that out one by one would take longer than their counters are worth.
            wider = {
                name: max(own, width) if own > 0 and name not in self.proven else own
                for name, own in packing.width.items()
            }
            packing = replace(packing, width=wider)
        return replace(
            self,
            room={**self.room, place: room},
            packing=packing,
            enlarged=self.enlarged + 1,
        )


@record
class Generated:
    """What was generated last for a net and its predicates; those who explore both again need not generate it again.

    Args:
        sizes: what the places of that program hold; None: nothing has been generated yet.
        files: its C.
        host: what it is compiled with for a large space.
        is_quick: whether it was compiled quickly instead.
    """

    sizes: Sizes | None = None
    files: tuple[OutputFile, ...] = ()
    host: Host = HOST
    is_quick: bool = False

    def generate(
        self,
        net: FlatNet,
        storage: Mapping[str, str],
        sizes: Sizes,
        d: Diagnostics,
        predicates: Sequence[Predicate] = (),
    ) -> bool:
        """Whether the net can be compiled with places of these sizes; if not, that was reported."""
        lowered = _lowered(net, storage, sizes, d, predicates)
        if lowered is None:
            return False
        self.files = emit_c.emit(lowered, pn2code.__version__)
        self.host, self.sizes = _host(lowered), sizes
        return True


def generated(
    net: FlatNet,
    storage: Mapping[str, str],
    sizes: Sizes,
    d: Diagnostics,
    predicates: Sequence[Predicate] = (),
) -> tuple[OutputFile, ...] | None:
    """net.c and net.h; None when the net cannot be compiled, which was reported."""
    found = _lowered(net, storage, sizes, d, predicates)
    return None if found is None else emit_c.emit(found, pn2code.__version__)


def _lowered(
    net: FlatNet,
    storage: Mapping[str, str],
    sizes: Sizes,
    d: Diagnostics,
    predicates: Sequence[Predicate],
) -> ir.NetIR | None:
    partition = divide(net, None, d)
    if partition is None:
        return None
    capacity = {p.name: sizes.room.get(p.name, ROOM) for p in net.places}
    found = lower_net.lower(
        partition, storage, d, capacity=capacity, packing=sizes.packing, predicates=predicates
    )
    return None if d.has_errors else found


def _host(net: ir.NetIR) -> Host:
    """What a net is compiled with for a large space: by those of its transitions that have code, not only tables."""
    if sum(t.counts is None for t in net.transitions) <= MANY:
        return HOST
    return LARGE


@contextmanager
def program(
    net: FlatNet,
    storage: Mapping[str, str],
    sizes: Sizes,
    d: Diagnostics,
    predicates: Sequence[Predicate] = (),
    *,
    interrupted: Callable[[], bool] = lambda: False,
    quick: bool = False,
    made: Generated | None = None,
) -> Iterator[Path | None]:
    """The explorer of a net, as long as the block lasts; None after a diagnostic, or when it was interrupted.

    Args:
        net: the net.
        storage: as for `Game`.
        sizes: how much its places hold.
        d: gets the errors.
        predicates: what can be asked of its markings.
        interrupted: asked while compilers run.
        quick: rather compile quickly than run quickly, unless it has been compiled already, or a large net consists
            of tables, which are compiled at once.
        made: what was generated for the same net and predicates; gets what is generated here.
    """
    made = Generated() if made is None else made
    if made.sizes != sizes and not made.generate(net, storage, sizes, d, predicates):
        yield None
        return
    is_soon = made.host == HOST and len(net.transitions) > MANY
    made.is_quick = quick and not is_soon and not programs.is_kept(made.host, made.files)
    host = QUICK if made.is_quick else made.host
    with programs.program(host, made.files, d, interrupted=interrupted) as found:
        yield found
