"""All passes over the programs of a net, in their order: each may look at what those before it have found."""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.lowering.passes.access import with_access
from pn2code.lowering.passes.arena import with_arena
from pn2code.lowering.passes.checks import with_checks
from pn2code.lowering.passes.constants import with_constants
from pn2code.lowering.passes.context import with_context
from pn2code.lowering.passes.counting import with_counts
from pn2code.lowering.passes.direct import with_direct
from pn2code.lowering.passes.effects import with_effects
from pn2code.lowering.passes.move_lists import with_move_lists
from pn2code.lowering.passes.moves import with_moves
from pn2code.lowering.passes.ranges import with_ranges
from pn2code.lowering.passes.reach import Reach
from pn2code.lowering.passes.shared import with_shared
from pn2code.lowering.passes.slots import with_slots
from pn2code.lowering.passes.sums import with_sums
from pn2code.lowering.passes.unseen import with_seen
from pn2code.lowering.passes.used import with_used


def analysed(net: ir.NetIR) -> ir.NetIR:
    """The net, with what all passes find."""
    net = with_checks(with_ranges(with_constants(with_seen(net))))
    reach = Reach(net)
    net = with_sums(with_effects(with_moves(net), reach), reach)
    return bounded(with_used(with_context(with_counts(with_direct(net, reach)))))


def bounded(net: ir.NetIR) -> ir.NetIR:
    """The net, with what passes find that look at how places are kept: again when their bounds have become known."""
    return with_arena(with_shared(with_access(with_move_lists(with_slots(net)))))
