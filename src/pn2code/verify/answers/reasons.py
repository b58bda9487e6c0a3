"""Why something was not seen, or is not known: the explorer says it in one word, people want a clause."""

from __future__ import annotations

import re

_CLAUSES = {
    "states": "the limit of states was reached",
    "seconds": "the limit of time was reached",
    "memory": "the limit of memory was reached",
    "processor": "the explorer computed for too long",
    "messages": "in the closed net more and more messages gather in a channel",
    "infinite": "the state space is infinite",
    "interrupted": "it was interrupted",
    "error": "an inscription raised an exception",
    "exception": "an inscription raised an exception",
    "decided": "all properties were decided before the end",
    "unfolded": "the unfolded net was asked alone, and has not told it in time",
    "not unfolded": "nothing was explored, and the unfolded net cannot be asked",
    "counted": "not all markings of the closed net were counted",
    "truncated": "not all markings were seen",
    "approximation": "the exploration is approximate, so markings may have been taken for others and missed",
    "swarm": "a swarm of searches looks at many markings, and cannot know whether it has seen all",
    "graphless": "the searches of a swarm keep no graph, which this answer needs",
    "colourless": "the searches of a swarm do not keep the values of tokens, which this answer needs",
    "sweep": "markings were forgotten on the way, and it is about runs, which need the graph between all of them",
    "reduction": "the reduction of the state space does not preserve it",
    "endless": "the response is not finite",
    "speeds": "it depends on the order of events, and so on their durations",
    "late": "an answer may be owed for longer than `reply_timeout_s`, and that stops the cell",
    "moves": "an arm may be told a move that it cannot make from where it is",
    "stops": "another check says that the supervisor stops",
    "commands": "a script may loop without a command or a wait that takes time: its commands and waits may be on "
    "branches that it never takes, or may take no time, as a move to where the arm already is",
    "moments": "the cell may exchange so many messages, or carry out so many commands, without time passing that a run "
    "in lock-step stops",
    "poses": "it is not known whether the cell comes to a move that an arm cannot make",
    "chance": "it depends on random numbers or files, and other values than those drawn may lead to another answer",
    "order": "CPN Tools may ask conditions in another order, and stop with an exception",
    "ways": "there are too many orders in which conditions may be asked",
    "steps": "it depends on the number of steps (`step ()`), which is no part of a state",
    "compiler": "there is no C compiler",
}


def clause(why: str) -> str:
    """For a sentence; what is no such word stays as it is."""
    return _CLAUSES.get(why, why)


def raised(message: str) -> str:
    """An exception as it stands in a sentence: in back-ticks, unless its text has some of its own."""
    return message if "`" in message else f"`{message}`"


_NO_EXCEPTIONS = {
    "colour outside its colour set": "gives a value that is not in its colour set",
    "place is full": "puts more tokens into a place than there is room for",
    "memory for lists and strings is full": "needs more memory for lists and strings than there is",
    "recursion too deep": "calls functions too deep within each other",
    "an evaluation without end": "does not come to an end",
    "a model time beyond 64 bits": "gives a model time beyond 64 bits",
    "a function that is not available here": "calls a function that is not available here",
}
"""What the compiled net says, in words of its own (`pn_error_name`), where no exception of CPN ML is raised."""

_ILLEGAL = re.compile(r"illegal colour (.*): it is not in (the colour set `[^`]*`)", re.DOTALL)
"""The same about a value: `pn_raise_colour`, in the words of the token game."""

_ABSENT = re.compile(r"(`[^`]*`) is not available here: (.*)", re.DOTALL)
"""Of a function that is not available, with its name and the reason."""


def _no_exception(message: str) -> str:
    illegal = _ILLEGAL.fullmatch(message)
    if illegal:
        return f"gives the illegal colour {illegal[1]}, which is not in {illegal[2]}"
    absent = _ABSENT.fullmatch(message)
    if absent:
        return f"calls {absent[1]}, which is not available here ({absent[2]})"
    return _NO_EXCEPTIONS.get(message, "")


OUTSIDE = "gives a variable a value outside its colour set"


def raises(message: str) -> str:
    """What is wrong, behind what does it: `raises `Div``, `puts more tokens into a place than there is room for`."""
    return _no_exception(message) or f"raises {raised(message)}"


def raised_there(message: str, by: str) -> str:
    """The same as a clause about a place that has been named, and the expression that does it, if that is known."""
    if wrong := _no_exception(message):
        return f"{by or 'it'} {wrong}"
    return f"{raised(message)} is raised there" + (f" by {by}" if by else "")
