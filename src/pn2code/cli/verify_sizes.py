"""How large a state space is, in rows: markings, what is dead or live, bounds, and how the cell as it runs differs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from pn2code.cli.verify_rows import count_of, row
from pn2code.net.engine_names import EngineNames
from pn2code.net.flat import FlatNet
from pn2code.verdict.whole import Said
from pn2code.verify.answers import basis
from pn2code.verify.exploring.result import Exploration, Known
from pn2code.verify.report import control_text, swarm_text, sweep_text, unfolded_text
from pn2code.verify.report.text import bounded_places

MOST_NAMES = 6
MOST_DIFFERENCES = 4
"""Of the cell as it runs from the closed net, on one screen."""


def sizes_of(said: Said) -> Iterator[str]:
    """How large the state space is, and what its graph and its places are like."""
    net, found = said.net, said.found
    if found.known is not None:
        yield from _of_counted(said, found.known)
        return
    is_explored = found.unfolded is None or not found.unfolded.is_alone
    for name, what in basis.complete(found) if is_explored else ():
        more = ""
        if name == "Markings":
            more = f", in {found.seconds:.2f} s; compiled in {found.compile_seconds:.1f} s"
        if name == "Components" and found.graph is not None:
            more = f": {found.graph.scc_nodes:,}"
        yield from row(name, what + more)
    if found.swarm is not None:
        yield from row("Swarm", swarm_text.seen(found.swarm))
        cell = said.control.found if said.control is not None else None
        if cell is not None and cell.swarm is not None:
            yield from row("Cell as it runs", swarm_text.seen(cell.swarm))
    elif found.approximation is not None:
        kind, omitted = found.approximation["kind"], found.approximation["omission_probability"]
        yield from row(
            "Approximate",
            f"{kind}: the probability that a marking was omitted is about {omitted:.2g}",
        )
    if found.reductions:
        yield from row("Reduced by", ", ".join(found.reductions))
    if found.sweep is not None:
        yield from row("Swept", sweep_text.known(found))
    for name, what in unfolded_text.rows(net, found):
        yield from row(name, what)
    if found.unfolded is not None and (found.unfolded.is_asked or found.unfolded.is_alone):
        if not found.knows_whole:
            yield from _growing(net, found)
        return
    yield from row("Dead markings", dead_markings(found))
    if found.graph is not None:
        every = found.graph.home_count == found.nodes
        yield from row("Home markings", "all" if every else f"{found.graph.home_count:,}")
    if found.knows_dead_transitions:
        names = EngineNames(net)
        dead = [names.transition(i) for i in found.dead_transitions()]
        name = "Dead transitions" if found.seen.markings else "Transitions not seen"
        yield from row(name, _listed(dead, len(net.transitions)))
    if found.graph is not None:
        live = len(found.live_transitions())
        yield from row("Live transitions", f"{live} of {len(net.transitions)}")
    if found.bounds is not None:
        yield from row("Bounds", _most(net, found))
    yield from _growing(net, found)


def _growing(net: FlatNet, found: Exploration) -> Iterator[str]:
    for line in growing_lines(net, found):
        yield from row("Grows, perhaps", line)


def _of_counted(said: Said, known: Known) -> Iterator[str]:
    """Of a closed net whose markings were not counted to the end."""
    net, found = said.net, said.found
    more = f"{known.nodes:,} states stand for all of them, {known.seconds:.2f} s"
    yield from row("Markings", f"more than {found.nodes:,}, {found.seconds:.2f} s; {more}")
    ends = "each has a token in a final place" if known.ends else "not known whether each is an end"
    yield from row("Dead markings", ends)
    names = EngineNames(net)
    never = [names.transition(i) for i in known.never]
    yield from row("Dead transitions", _listed(never, len(net.transitions)))
    others = [names.transition(i) for i in found.dead_transitions() if i not in known.never]
    if others:
        yield from row("Transitions not seen", _listed(others, len(net.transitions)))


def crowd_of(said: Said) -> Iterator[str]:
    """What makes a cell so large that not all of its states were seen."""
    crowd = said.control.crowd if said.control is not None else None
    if crowd is not None:
        yield from (line for name, what in crowd.lines() for line in row(name, what))


def growing_lines(net: FlatNet, found: Exploration) -> Iterator[str]:
    """What may be the reason that there is no end of markings."""
    growing = found.growing()
    is_said = found.covering is not None and not found.covering.grows
    if growing is not None and not is_said:
        place, count = net.places[growing[0]], growing[1]
        what = "a number, text or list in a token may grow for ever"
        so = "so that there is no end of markings; is there a guard that limits it?"
        if place.colset.timed and "time" in found.reductions:
            what += ", or long delays are gone through in small steps"
            so = "so that there are very many markings, or no end of them"
        elif place.colset.timed:
            what += ", or the time of a token does"
            so = (
                "so that there is no end of markings (`--reduce time`, where it is possible, counts those that differ "
                "in the time alone as one)"
            )
        yield (
            f"place `{place.name}` has held {count:,} different multi-sets of tokens: {what}, {so}"
        )


def as_it_runs(said: Said) -> Iterator[str]:
    """Which of the sizes above, of the closed net, are others in the cell as it runs: a remark on them, no failure."""
    control = said.control
    differing = [] if control is None else [*control_text.differences(control)]
    if control is None or not differing:
        return
    yield ""
    yield "In the cell as it runs, other than in the closed net (no failure; `--full` says why):"
    for title, what in differing[:MOST_DIFFERENCES]:
        yield from row(title, what)
    if len(differing) > MOST_DIFFERENCES:
        yield from row("", f"and {len(differing) - MOST_DIFFERENCES} more")
    never, only = control.other_dead()
    if said.found.knows_dead_transitions and (never or only):
        names = EngineNames(said.net)
        both = [names.transition(i) for i in said.found.dead_transitions() if i not in only]
        yield from row("Dead in both", _listed(both, len(said.net.transitions)))


def counted_remarks(said: Said) -> Iterator[str]:
    """In place of them, where there is no room."""
    count = 0 if said.control is None else len([*control_text.differences(said.control)])
    if count:
        does = "differs" if count == 1 else "differ"
        yield ""
        yield (
            f"In the cell as it runs {count_of(count, 'size')} {does} from the closed net's (no failure; `--full` "
            "says which)."
        )


def dead_markings(found: Exploration) -> str:
    """How many dead markings there are, and the first of them."""
    if not found.told:
        return "not known"
    if not found.dead_count:
        return "none" if found.seen.markings else "none was seen"
    first = ", ".join(map(str, found.dead[:MOST_NAMES]))
    more = ", ..." if found.dead_count > len(found.dead[:MOST_NAMES]) else ""
    return f"{found.dead_count:,}" + (
        f" (node{'s' * (found.dead_count != 1)} {first}{more})" if first else ""
    )


def _listed(names: Sequence[str], of: int) -> str:
    if not names:
        return "none"
    if len(names) == of:
        return f"all {of}"
    more = f", and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return f"{len(names)}: {', '.join(names[:MOST_NAMES])}{more}"


def _most(net: FlatNet, found: Exploration) -> str:
    """The places that hold most tokens at a time."""
    assert found.bounds is not None
    rows = [(name, found.bounds[place.index].upper) for name, place in bounded_places(net)]
    most = max((upper for _, upper in rows), default=0)
    names = [name for name, upper in rows if upper == most]
    is_long = len(names) > MOST_NAMES // 2
    where = f"{len(names)} of {len(rows)} places" if is_long else ", ".join(names)
    seen = "" if found.seen.markings else "seen so far: "
    return f"{seen}at most {most:,} token{'s' * (most != 1)} in a place (in {where})"
