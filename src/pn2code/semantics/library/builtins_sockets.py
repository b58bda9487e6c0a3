"""Built-in functions of Comms/CPN: what they do where a run may open connections, and what they say elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from pn2code.ml.library.builtins import BUILTINS
from pn2code.semantics.evaluation.connections import ConnectionProblem, Connections
from pn2code.semantics.values.data import NONE, UNIT, MlException, MlUnavailable, Value, exception

if TYPE_CHECKING:
    from pn2code.semantics.evaluation.evaluate import Evaluator
    from pn2code.semantics.evaluation.tasks import Task

Function = Callable[..., Any]


def _raised(problem: ConnectionProblem) -> MlException:
    """The exception of CPN Tools."""
    if problem.exception == "SysErr":
        return MlException(exception("SysErr", (problem.message, NONE)))
    if problem.message is None:
        return MlException(exception(problem.exception))
    return MlException(exception(problem.exception, problem.message))


def _connections(e: Evaluator, name: str) -> Connections:
    found = e.files.connections
    if found is None:
        raise MlUnavailable(f"`{name}` is not available here: {BUILTINS[name].unsupported}")
    return found


def _simple(name: str, work: Callable[[Connections, Any], Value | None]) -> Function:
    """A function that calls nothing."""

    def function(e: Evaluator, argument: Any) -> Value:
        try:
            found = work(_connections(e, name), argument)
        except ConnectionProblem as problem:
            raise _raised(problem) from None
        return UNIT if found is None else found

    return function


def _send(e: Evaluator, p: tuple[str, Value, Value]) -> Task:
    name, value, encode = p
    connections = _connections(e, "ConnManagementLayer.send")
    try:
        connections.known(name, "sending data")
    except ConnectionProblem as problem:
        raise _raised(problem) from None
    data = yield e.call(encode, value)
    try:
        connections.send(name, bytes(data))
    except ConnectionProblem as problem:
        raise _raised(problem) from None
    return UNIT


def _receive(e: Evaluator, p: tuple[str, Value]) -> Task:
    name, decode = p
    try:
        data = _connections(e, "ConnManagementLayer.receive").receive(name)
    except ConnectionProblem as problem:
        raise _raised(problem) from None
    return (yield e.call(decode, tuple(data)))


_SIMPLE: dict[str, Callable[[Connections, Any], Value | None]] = {
    "openConnection": lambda c, p: c.open(*p),
    "acceptConnection": lambda c, p: c.accept(*p),
    "closeConnection": lambda c, name: c.close(name),
    "canreceive": lambda c, name: c.can_receive(name),
}

FUNCTIONS: dict[str, tuple[int, Function]] = {
    **{
        f"ConnManagementLayer.{name}": (1, _simple(f"ConnManagementLayer.{name}", work))
        for name, work in _SIMPLE.items()
    },
    "ConnManagementLayer.send": (1, _send),
    "ConnManagementLayer.receive": (1, _receive),
}
"""Full name -> number of curried arguments, function."""
