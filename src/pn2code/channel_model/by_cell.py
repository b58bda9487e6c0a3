"""A cell with its medium where that is large: what the cell as it runs says of it, without a look at the files.

    why_not(partition, rules)                                  # "" if the cell as it runs tells
    shown(partition, rules, storage, limits, options)           # what it tells; None: nothing

In the cell as it runs (`verify.controller.running`) a channel holds its message from when it is put until it is
taken; in the net with its medium (`compose`) the message is written, found, taken, and at last the file is emptied.
Let R be the former, as turns look at it (`Running.of(loose=True)`), and M the latter. *If in R*

  1  no channel ever holds two messages, no script stops, and no inscription raises an exception,
  2  no run goes on for ever, and
  3  wherever nothing can happen any more the supervisor has finished, and no message to it is left (`left_over`),

*and if in the cell*

  4  transitions of a robot that compete for a token need the same messages,

*then M has no fault, and from each of its states an end can be reached.* The steps of the proof; a prefix of a run of
M is meant up to the supervisor's end, and without a fault. A robot *sends* a message in R when its transition puts it;
or, where R writes the messages of a transition one after the other (`staged_channels.staged`), when it writes it. In M
a message is written after it has been sent (or then), before those that its side sends later, and after its side has
emptied what it had taken.

*Files.* What happens to one file is a circle: empty (`0`); written; read, while the message waits in the reader's
memory; consumed; empty. The writer renames into an empty file only, the reader looks only where it has not read,
numbers go along, and a side that has consumed a message empties its file before it does anything but empty others. So
a message is not lost, torn, refused, or taken twice; the only fault is that a writer has a message for a file that is
not empty, or two in one cycle.

*A run of M is one of R.* R does the same as M: what the supervisor does, when M does it, its looks with the step that
looks, its publishing with the step that renames; if a channel is one that R may see late, what a round sees there
comes at the end of the round. What robots do (transitions, and the writing that R knows of) comes as late as possible:
before a look that finds a message come its sending and what this depends on, namely what the robot has done before, and
the sending of each message that it has taken from another robot, and so on; in the order that M has. All of this has
been done in M by then, so what it needs from the supervisor has been published. A robot does what it does in M, because
it chooses among transitions that need the same messages (4), and the one that it takes has all of its own: so have the
others, and what is enabled depends on its own places and on these messages, of which there is one each (1).

If a look finds an empty file, R finds nothing there either. For let its message have been sent in R, that is, let an
earlier look have found a message whose sending depends on it, or is it. If it is another message of the same transition
see below. Else the robot has sent more later, or in the order in which it writes, and in M the message was in its file
before that, so the later look would have found it. What is left when M's prefix ends comes last. Then each side has the
same in its memory, and a channel of R holds what has been put, and not consumed.

*Data and a flag* of one transition that R does not write one after the other go to one reader, and whoever takes the
data takes the flag, too. M writes the flag last; a round looks at flags first. In R this transition comes before the
first look that finds the flag, or what depends on what is sent later; so M may have found the data in an earlier round,
and R not yet. The data alone enable nothing, since whoever takes them needs the flag. It is not there from an earlier
transition either: then this transition could come in R while it is, and the channel would hold two, against 1. So in M
nothing is fired after that round but what would be without it. In R the data are found where the flag is, or in the
same round after it, or, if the transition came for something else, in the round in which M has found them at the latest
or a later one that ends before the flag is found. At the end of the round in which the flag is found both have both.

*No fault.* Take a shortest prefix after which a writer w has a message for a file that is not empty. If the message
before has not been consumed, the channel holds two in R, against 1. If it has, by the reader r, then r has since
emptied other files at most, and written nothing: it empties before it writes. So what r has done from the taking on has
been seen by nobody; without it, and with all that the others have done, this is still a run of R: there it does not
matter whether files have been emptied. After it the channel holds two, against 1.

*The end.* Between two occurrences of the net's own transitions sides do a limited number of steps. So by 2 no run of
M goes on for ever, up to the supervisor's end. Let nothing be possible in M; then all sides are calm, and all
messages have been written and all consumed ones emptied, for each of these steps is possible (there is no fault). If
no final place held a token, R would go on from its state, after the supervisor has come to rest, by 3: by a look that
finds a message, but then M could look as well; by a transition of a robot, but then its messages can be read, or have
been, and M could do this; or by a script that stops, against 1. So it is an end. After it the supervisor of M goes on
looking, that of R does not. By 3 it finds nothing: robots do the same in both, and a message to it would stay in R
for ever.

What each channel holds in M's writers it holds in R as well: so the values of messages are those of R.

This is a reduction by movers (R. Lipton, *Reduction: a method of proving properties of parallel programs*, 1975):
emptying a file moves to the left, up to the taking; writing, and what precedes it, to the right, up to the look.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from pn2code.base.frozen import frozen
from pn2code.cell.partition import Partition
from pn2code.channel_model.rules import Rules
from pn2code.diagnostics import Diagnostics
from pn2code.net.flat import ArcKind, FlatNet, FlatTransition
from pn2code.verify.controller import messages
from pn2code.verify.controller.by_turns import loosened
from pn2code.verify.controller.left_over import questions
from pn2code.verify.controller.not_modelled import NotModelledError
from pn2code.verify.controller.running import Running
from pn2code.verify.exploring.explore import ExploreOptions, explore
from pn2code.verify.exploring.limits import Limits
from pn2code.verify.exploring.programs import Generated, Sizes
from pn2code.verify.exploring.result import Exploration


@frozen
class Shown:
    """That the files do no harm, as a space of the cell as it runs shows.

    Args:
        nodes, arcs: of that space; `places`, `transitions`: of its net.
        is_counted: whether tokens were counted up to a limit (`by_counts`).
    """

    nodes: int
    arcs: int
    places: int
    transitions: int
    is_counted: bool = False

    @staticmethod
    def of(net: FlatNet, found: Exploration) -> Shown:
        """By the space of a net that has shown it."""
        return Shown(
            found.nodes, found.arcs, len(net.places), len(net.transitions), found.is_counted
        )


def why_not(partition: Partition, rules: Rules) -> str:
    """What is against it in the net, a clause; "": nothing."""
    if rules != Rules():
        return "the rules of the protocol are others"
    if partition.net.timed:
        return "the net is timed"
    if not partition.final_places:
        return "the cell has no end"
    return next(_against(partition), "")


def _against(partition: Partition) -> Iterator[str]:
    channels = {c.place for c in partition.channels}

    def inputs(t: FlatTransition) -> set[int]:
        return {a.place for a in t.arcs if a.kind is not ArcKind.OUTPUT}

    for owner in range(1, len(partition.owners)):
        own = [t for t in partition.net.transitions if partition.transition_owner[t.index] == owner]
        for i, t in enumerate(own):
            for u in own[:i]:
                one, other = inputs(t), inputs(u)
                if (one & other) - channels and (one ^ other) & channels:
                    yield f"`{t.name}` and `{u.name}` compete, and need different messages"


def shown(
    partition: Partition,
    rules: Rules,
    storage: Mapping[str, str],
    limits: Limits,
    options: ExploreOptions,
) -> Shown | None:
    """What a look at the cell as it runs, in turns, says; None: nothing."""
    return None if why_not(partition, rules) else looked(partition, storage, limits, options)


def looked(
    partition: Partition, storage: Mapping[str, str], limits: Limits, options: ExploreOptions
) -> Shown | None:
    """The same, whatever is against it in the net."""
    seen = _explored(partition, storage, limits, options)
    if seen is None:
        return None
    running, found = seen
    is_good = all(a["answer"] == "yes" for a in found.answers)
    if not is_good or messages.examine(partition, found, Diagnostics()).answer != "yes":
        return None
    return Shown.of(running.net, found)


def rows(
    partition: Partition, storage: Mapping[str, str], limits: Limits, options: ExploreOptions
) -> list[tuple[str, str]]:
    """What is asked, and the answers; nothing where the cell is not seen to its end."""
    seen = _explored(partition, storage, limits, options)
    if seen is None:
        return []
    running, found = seen
    lines = [x for x in questions(running).split("\n") if x.startswith("? ")]
    return [(x, str(a["answer"])) for x, a in zip(lines, found.answers, strict=True)]


def _explored(
    partition: Partition, storage: Mapping[str, str], limits: Limits, options: ExploreOptions
) -> tuple[Running, Exploration] | None:
    """The net of turns, and its space, all of it; None: that is not seen."""
    try:
        made = loosened(partition)
    except NotModelledError:
        return None
    if made is None:
        return None
    running, table = made
    asked = questions(running)
    own = replace(
        options,
        turns=table,
        questions=asked,
        sizes=Sizes.start(running.net, storage),
        generated=Generated(),
        whole=tuple(c.place for c in partition.channels),
        stem="files",
        quick=False,
    )
    d = Diagnostics()  # what is wrong with this net the whole space tells
    # Turns are a reduction of their own, and what was asked for is about the closed net.
    limits = replace(limits, graph=True, traces=0, approximation=None, reductions=())
    found = explore(running.net, storage, limits, d, own)
    if found is None or not found.complete or not found.seen.arcs or found.error is not None:
        return None
    return (running, found) if len(found.answers) == asked.count("? ") else None
