"""Why something was not seen, or is not known: the explorer says it in one word, people want a clause."""

from __future__ import annotations

_CLAUSES = {
    "states": "the limit of states was reached",
    "seconds": "the limit of time was reached",
    "memory": "the limit of memory was reached",
    "interrupted": "it was interrupted",
    "error": "an inscription raised an exception",
    "exception": "an inscription raised an exception",
    "decided": "all properties were decided by then",
    "truncated": "not all markings were seen",
    "approximation": "the exploration is approximate, so markings may have been taken for others and missed",
    "reduction": "the reduction of the state space does not keep it",
    "endless": "the response is not finite",
    "speeds": "the order of events decides, and durations decide that",
    "commands": "a script may go round without a command or a wait, if it never takes the branches with commands",
    "chance": "random numbers or files decide: other ones than those that were drawn may lead elsewhere",
    "compiler": "there is no C compiler",
}


def clause(why: str) -> str:
    """For a sentence; what is no such word stays as it is."""
    return _CLAUSES.get(why, why)
