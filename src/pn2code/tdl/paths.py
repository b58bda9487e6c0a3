"""What follows from the paths through a script: unreachable statements, variables without a value."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from pn2code.diagnostics import Diagnostics
from pn2code.tdl import codes, flow
from pn2code.tdl import tree as t


def unreachable(body: flow.Body, d: Diagnostics) -> None:
    """Warn of the first statement of each stretch that no path reaches."""
    seen = body.reachable()
    previous = True
    for at, instruction in enumerate(body.instructions):
        reached = at in seen
        # Jumps at the ends of blocks and the end of the body were written by nobody.
        own = isinstance(instruction, flow.Jump | flow.End) and not instruction.written
        if not reached and previous and not own:
            d.warning(
                codes.UNREACHABLE,
                "this statement can never be reached",
                instruction.span,
                hint="remove it, or set a label before it",
            )
        if not own:
            previous = reached


def unassigned(
    program: t.Program,
    bodies: Mapping[str, flow.Body],
    variables: Mapping[str, t.Variable],
    d: Diagnostics,
) -> None:
    """Warn of variables that are read although some path to that place assigns nothing.

    Procedures are looked at with what is assigned at *every* call; a call assigns what the procedure
    surely assigns.
    """
    initial = frozenset(v.name for v in variables.values() if v.initial is not None)
    everything = frozenset(variables)
    order = _callees_first(program, bodies)
    gives: dict[str, frozenset[str]] = {}
    for name in order:
        before = _before(bodies[name], frozenset(), everything, gives)
        ends = [
            before[at]
            for at, i in enumerate(bodies[name].instructions)
            if isinstance(i, flow.End) and at in before
        ]
        gives[name] = frozenset.intersection(*ends) if ends else everything
    entry: dict[str, frozenset[str]] = {"": initial}
    warned: set[str] = set()
    for name in reversed(order):
        if name not in entry:
            continue  # never called
        body = bodies[name]
        before = _before(body, entry[name], everything, gives)
        for at, instruction in enumerate(body.instructions):
            if at not in before:
                continue
            if isinstance(instruction, flow.CallProcedure):
                known = entry.get(instruction.name, everything)
                entry[instruction.name] = known & before[at]
            for use in _uses(instruction):
                if use.name in everything - before[at] and use.name not in warned:
                    warned.add(use.name)
                    d.warning(
                        codes.UNASSIGNED,
                        f"variable `{use.name}` may have no value here",
                        use.span,
                        hint=f"give it one where it is declared: `var {use.name} : ... := ...`",
                    )


def _callees_first(program: t.Program, bodies: Mapping[str, flow.Body]) -> list[str]:
    done: list[str] = []
    for procedure in program.procedures:
        _after_callees(procedure.name, bodies, done)
    _after_callees("", bodies, done)
    return done


def _after_callees(name: str, bodies: Mapping[str, flow.Body], done: list[str]) -> None:
    """Appends a procedure behind those that it calls: none calls itself, the checker has seen to that."""
    if name in done:
        return
    for i in bodies[name].instructions:
        if isinstance(i, flow.CallProcedure):
            _after_callees(i.name, bodies, done)
    done.append(name)


def _before(
    body: flow.Body,
    entry: frozenset[str],
    everything: frozenset[str],
    gives: Mapping[str, frozenset[str]],
) -> dict[int, frozenset[str]]:
    """Which variables surely have a value before each reachable instruction."""
    before = {0: entry}
    todo = [0]
    while todo:
        at = todo.pop()
        after = before[at] | _assigns(body.instructions[at], gives)
        for n in body.next(at):
            merged = before.get(n, everything) & after
            if before.get(n) != merged:
                before[n] = merged
                todo.append(n)
    return before


def _assigns(i: flow.Instruction, gives: Mapping[str, frozenset[str]]) -> frozenset[str]:
    match i:
        case flow.Do(t.Assign(target) | t.Measure(_, target) | t.Sense(_, target)):
            return frozenset({target.name})
        case flow.Do(t.Read(_, targets)):
            return frozenset(x.name for x in targets)
        case flow.CallProcedure(name):
            return gives.get(name, frozenset())
        case _:
            return frozenset()


def _uses(i: flow.Instruction) -> Iterator[t.Name]:
    match i:
        case flow.BranchIf(condition) | flow.BranchUnless(condition):
            yield from names_in(condition)
        case flow.Do(s):
            for e in expressions_of(s):
                yield from names_in(e)
        case _:
            pass


def expressions_of(s: t.Simple) -> tuple[t.Expression, ...]:
    """The expressions that a statement evaluates."""
    match s:
        case t.Move(_, target, _, speed, via, acceleration, along, _, elbow, zone):
            goal = target.angles if isinstance(target, t.Axes) else (target,)
            others = (*via, *(a.position for a in along), elbow, zone, speed, acceleration)
            return tuple(e for e in (*goal, *others) if e is not None)
        case t.Speed(_, value):
            return () if value is None else (value,)
        case t.WaitTime(e) | t.WaitUntil(e) | t.Assign(_, e) | t.Tool(_, e) | t.Measure(e):
            return (e,)
        case t.Write(_, values) | t.Compute(values):
            return values
        case t.Stop(message):
            return message
        case t.Mark(_, binding):
            return tuple(e for _, x in binding for e in data(x))
        case _:
            return ()


def data(x: t.Datum) -> Iterator[t.Expression]:
    """The expressions that a value in a `mark` is made of."""
    match x:
        case t.RecordDatum(fields):
            for _, inner in fields:
                yield from data(inner)
        case t.TupleDatum(items):
            for inner in items:
                yield from data(inner)
        case t.EachDatum(item):
            yield from data(item)
        case t.NullDatum():
            return
        case _:
            yield x


def children(e: t.Expression) -> tuple[t.Expression, ...]:
    """The direct parts of an expression."""
    match e:
        case t.Field(record):
            return (record,)
        case t.Unary(_, operand):
            return (operand,)
        case t.Binary(_, left, right):
            return (left, right)
        case t.CallExpression(_, arguments):
            return arguments
        case t.Conditional(condition, then, otherwise):
            return (condition, then, otherwise)
        case _:
            return ()


def names_in(e: t.Expression) -> Iterator[t.Name]:
    """The variables and constants an expression uses (not the files it asks for)."""
    if isinstance(e, t.Name):
        yield e
    elif not (isinstance(e, t.CallExpression) and e.function == "filled"):
        for c in children(e):
            yield from names_in(c)


def files_in(e: t.Expression) -> tuple[str, ...]:
    """The files whose message an expression asks for, each once, in order."""
    out: dict[str, None] = {}
    todo = [e]
    while todo:
        match x := todo.pop():
            case t.CallExpression("filled", (t.Name(name),)):
                out.setdefault(name)
            case _:
                todo += reversed(children(x))
    return tuple(out)


def all_names(expressions: Iterable[t.Expression]) -> set[str]:
    """The names used by any of the expressions."""
    return {n.name for e in expressions for n in names_in(e)}
