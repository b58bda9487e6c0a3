"""What an exploration has known of its markings at a time that forgets those that cannot come back, in words."""

from __future__ import annotations

from pn2code.verify.exploring.result import Exploration

_MOST_TEXT = 120


def known(found: Exploration) -> str:
    """The measure, and how many markings were known at a time, without a full stop; of a sweep."""
    assert found.sweep is not None
    layers, most = found.sweep["layers"], found.sweep["most_known"]
    part = most / found.nodes if found.nodes else 1.0
    measure = found.measure
    if len(measure) > _MOST_TEXT:
        measure = f"{measure[:_MOST_TEXT].rsplit(' ', 1)[0]} ..."
    values = "one value" if layers == 1 else f"{layers:,} values"
    lost = (
        "; there was no room for the file from which runs are made (`--spill DIR` says where)"
        if found.sweep["runs_lost"]
        else ""
    )
    return (
        f"{most:,} markings ({part:.0%}) were known at a time, in the order of {values} of a measure that never "
        f"becomes smaller ({measure}); what needs the graph is not known{lost}"
    )
