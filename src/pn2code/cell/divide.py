"""Partition: each transition gets its owner, each place that two owners share becomes a channel.

In: a `FlatNet` and a `CellConfig` (or None: the supervisor owns the whole net). Out: a `Partition` or diagnostics.

    places        Top.Robot1.Waiting -> robot1     Top.flag1_interno -> channel supervisor -> robot1
    transitions   Top.Robot1.Accept  -> robot1     Top.Supervisor.Approach.Send -> supervisor
"""

from __future__ import annotations

from pn2code.cell.config import CellConfig
from pn2code.cell.final_places import failed_places, final_places
from pn2code.cell.inputs import inputs_of
from pn2code.cell.limits import report_limits
from pn2code.cell.owners import owners_of, owners_of_transitions, touching
from pn2code.cell.partition import Owner, OwnerKind, Partition
from pn2code.cell.place_finder import PlaceFinder
from pn2code.cell.shared_places import channels_of, report_undeclared
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import FlatNet


def divide(net: FlatNet, config: CellConfig | None, d: Diagnostics) -> Partition | None:
    """Divides the net among the owners of a cell; None when an error was reported."""
    if config is None:
        owner = Owner(0, "supervisor", OwnerKind.SUPERVISOR, "")
        return Partition(
            net, (owner,), (0,) * len(net.transitions), (0,) * len(net.places), (), (), ()
        )
    before = len(d.errors)
    owners = owners_of(net, config, d)
    if len(d.errors) != before:
        return None
    transition_owner = owners_of_transitions(net, owners, d)
    if len(d.errors) != before:
        return None
    writers, readers = touching(net, transition_owner)
    find = PlaceFinder(net, d)
    channels = tuple(channels_of(net, config, owners, writers, readers, find, d))
    report_undeclared(net, owners, writers, readers, config, find, d)
    inputs = tuple(inputs_of(config, writers, readers, find, d))
    final = final_places(net, config, owners, transition_owner, find, d)
    failed = failed_places(config, final, find, d)
    if len(d.errors) != before:
        return None
    report_limits(net, channels, inputs, config, d)
    if len(d.errors) != before:
        return None
    shared = {c.place for c in channels}
    place_owner = tuple(
        None if i in shared else next(iter(sorted(writers[i] | readers[i])), 0)
        for i in range(len(net.places))
    )
    primitives = {
        net.program.globals[name].uid: primitive
        for name, primitive in config.primitives.items()
        if name in net.program.globals
    }
    return Partition(
        net,
        owners,
        transition_owner,
        place_owner,
        channels,
        inputs,
        final,
        primitives,
        config,
        failed,
    )
