"""Tokens that are not in the colour set of their place: where the net raises an exception a script stops.

place Count : SMALL (int with 0..3), and an arc `out Count : s + 1`
->  if not s + 1 <= 3 then stop "Report: colour set SMALL of place Count does not have", s + 1 end if
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from pn2code.ml.core import terms as core
from pn2code.ml.core.colsets import Colset
from pn2code.net.flat import ArcKind, FlatPlace
from pn2code.robot_scripts import membership, unread
from pn2code.robot_scripts.evaluate import Evaluator
from pn2code.robot_scripts.failing import Known, known_where
from pn2code.robot_scripts.ir import Chain, Line, Node
from pn2code.robot_scripts.machine import Machine
from pn2code.robot_scripts.names import Names
from pn2code.robot_scripts.operations import logical_not
from pn2code.robot_scripts.situation import Situation
from pn2code.robot_scripts.strict import Owed, Path
from pn2code.robot_scripts.tokens import delayed_tokens
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import FALSE, TRUE, Env, Value, conjunction, scalars_in
from pn2code.tdl import tree as t

PathTo = Callable[[Iterable[tuple[core.Exp, bool]], Env], tuple[Path | None, list[Owed]]]
"""On which path an inscription has an outcome with these conditions; None: on none."""


def stops(
    machine: Machine,
    pure: Evaluator,
    situation: Situation,
    env: Env,
    names: Names,
    path_to: PathTo,
) -> list[Node]:
    """A stop for each token that a transition puts, unless it is known to be in the colour set of its place.

    Args:
        machine: the program.
        pure: computes values.
        situation: the transition.
        env: its variables, with the outputs of its code segment.
        names: of the script.
        path_to: of an inscription.
    """
    transition = situation.step.transition
    # What a code segment gives may be outside the colour set of its variable, as in CPN Tools.
    results = {v.uid for v in transition.code.outputs} if transition.code else set()
    taken = {v.uid for v in transition.variables} - results
    known = known_where(names, situation.ordered).with_colours(transition.variables, taken, env)
    out: dict[Node, None] = {}

    def where(known: Known) -> membership.Where:
        return membership.Where(taken, known, lambda e: pure.evaluate(e, env))

    for arc in transition.arcs:
        if arc.kind not in (ArcKind.OUTPUT, ArcKind.BOTH) or arc.inscription is None:
            continue
        place = machine.net.places[arc.place]
        inscription = arc.inscription
        outcomes = delayed_tokens(inscription.value, inscription.form, machine.net.program)
        for conditions, values, _ in outcomes:
            try:
                path, _ = path_to(conditions, env)
                if path is None:
                    continue
                there = known
                for condition, holds in path:
                    there = there.with_condition(condition, holds)
                for e in values or ():
                    asked = membership.of_token(place.colset, e, where(there))
                    if asked:
                        value = pure.evaluate(e, env)
                        out[_stop(transition.short, place, value, path, asked)] = None
            except UnsupportedError as problem:
                if arc.place not in machine.sinks:
                    raise

                def plain(part: Colset, e: core.Exp) -> bool:
                    try:
                        return not membership.of_token(part, e, where(known))
                    except UnsupportedError:
                        return False

                if not all(unread.is_member(place.colset, e, plain) for e in values or ()):
                    raise unread.refused(place, problem) from None
    return list(out)


def _stop(
    transition: str, place: FlatPlace, value: Value, path: Path, asked: list[t.Expression]
) -> Node:
    way = Owed(path, FALSE).condition if path else TRUE
    test = conjunction([way, logical_not(conjunction(asked))])
    text = f"{transition}: colour set {place.colset.name} of place {place.short} does not have"
    stop = Line(t.Stop((t.Value(text), *(x.exp for x in scalars_in(value)))))
    return Chain(((test, (stop,)),), None)
