"""One transition of a robot as script statements: wait, read, act, mark, consume, publish, remember.

    wait until filled(dadosrobo1)
    read dadosrobo1 into p
    move $joint p
    mark Top.Robot1.MoveJoint with k = k, p = p
    clear dadosrobo1

The transition occurs at the end of its action, at one instant: its mark, the emptying of the files it
takes from and the messages it puts follow each other without time passing. The mark comes first, so that
in a merged trace the cause stands before its effects.
"""

from __future__ import annotations

from collections.abc import Iterable

from pn2code.base.frozen import record
from pn2code.ml.core import terms as core
from pn2code.net.flat import ArcKind
from pn2code.robot_scripts import codes, unread
from pn2code.robot_scripts.assignments import one_after_the_other
from pn2code.robot_scripts.code_segment import Acted
from pn2code.robot_scripts.evaluate import Evaluator
from pn2code.robot_scripts.failing import known_where
from pn2code.robot_scripts.illegal_tokens import stops
from pn2code.robot_scripts.ir import Comment, Line, Node, titled
from pn2code.robot_scripts.machine import Machine, Outcome, Step
from pn2code.robot_scripts.marks import datum
from pn2code.robot_scripts.names import Names
from pn2code.robot_scripts.quantities import lasting
from pn2code.robot_scripts.rounding import rounded
from pn2code.robot_scripts.shapes import Fields, Shape
from pn2code.robot_scripts.situation import Situation
from pn2code.robot_scripts.strict import Owed, Path, open_of, statements, without_repetition
from pn2code.robot_scripts.tokens import delayed_tokens
from pn2code.robot_scripts.unsupported import UnsupportedError
from pn2code.robot_scripts.values import Env, Rec, Scalar, as_quantity, flatten, scalars_in
from pn2code.tdl import tree as t
from pn2code.tdl import types as tdl
from pn2code.tdl.paths import expressions_of


@record
class StepTranslator:
    """Translates the occurrence of transitions.

    Args:
        machine: the program.
        names: of the script.
        pure: computes values.
        place_names: the variables of a local place, in order of its scalars.
        shapes: shapes of places.
        file_names: names of the files of channel places.
    """

    machine: Machine
    names: Names
    pure: Evaluator
    place_names: dict[int, list[str]]
    shapes: dict[int, Shape]
    file_names: dict[int, str]

    def occur(self, situation: Situation, acted: Acted) -> list[Node]:
        """What the transition does, the mark, and the emptying of files.

        Args:
            situation: the transition.
            acted: what its code segment does.
        """
        transition, env = situation.step.transition, acted.env
        binding = tuple(
            (v.name, datum(env[v.uid], v.colset, situation.step.span)) for v in transition.variables
        )
        mark = t.Mark(transition.name, binding)
        outputs = statements(
            open_of(self._outputs(situation, env), None, known_where(self.names, situation.ordered))
        )
        outputs += stops(self.machine, self.pure, situation, env, self.names, self._way)
        out = without_repetition([*acted.nodes, *outputs], situation.ordered, expressions_of(mark))
        out.append(Line(mark))
        out += [Line(t.Clear(t.Target(self.file_names[p]))) for p in situation.channels]
        return out

    def _outputs(self, situation: Situation, env: Env) -> list[Owed]:
        """What CPN ML computes for the tokens that are put: if it fails, the transition does not occur."""
        out: list[Owed] = []
        transition = situation.step.transition
        for arc in transition.arcs:
            if arc.kind not in (ArcKind.OUTPUT, ArcKind.BOTH) or arc.inscription is None:
                continue
            inscription, program = arc.inscription, self.machine.net.program
            found = delayed_tokens(inscription.value, inscription.form, program)
            is_seen = arc.place not in self.machine.sinks and self.shapes[arc.place] != Fields(())
            for conditions, values, delay in found:
                try:
                    place = self.shapes.get(arc.place)
                    out += self._of_alternative(conditions, [*(values or ()), delay], env, place)
                except UnsupportedError as problem:
                    computed = [
                        *(c for c, _ in conditions),
                        *(values or ()),
                        *([delay] if delay else ()),
                    ]
                    if is_seen or values is None:
                        raise
                    if not all(self._is_sure(e, situation, env) for e in computed):
                        raise unread.refused(self.machine.net.places[arc.place], problem) from None
        if transition.delay is not None:
            out += self.pure.owing(transition.delay, env)[1]
        return out

    def _is_sure(self, e: core.Exp, situation: Situation, env: Env) -> bool:
        """Whether the net surely has a value for what a script does not compute."""
        code = situation.step.transition.code
        results = {v.uid for v in code.outputs} if code else set()
        variables = situation.step.transition.variables
        taken = {v.uid for v in variables} - results
        known = known_where(self.names, situation.ordered).with_colours(variables, taken, env)

        def plain(part: core.Exp) -> bool:
            try:
                value, owed = self.pure.owing(part, env)
            except UnsupportedError:
                return False
            return not open_of(owed, None, known) and not any(
                known.fails(x.exp) for x in scalars_in(value)
            )

        return unread.is_sure(e, self.pure.functions, plain)

    def _of_alternative(
        self,
        conditions: Iterable[tuple[core.Exp, bool]],
        values: Iterable[core.Exp | None],
        env: Env,
        shape: Shape | None,
    ) -> list[Owed]:
        """What is computed for some of the ways in which an inscription turns out, for a place of that shape."""
        path, out = self._way(conditions, env)
        if path is not None:
            for e in values:
                if e is not None:
                    value, owed = self.pure.owing(e, env, path)
                    out += owed
                    if shape is not None:
                        out += [Owed(path, x) for x in rounded(value, shape, self.names)]
        return out

    def _way(
        self, conditions: Iterable[tuple[core.Exp, bool]], env: Env
    ) -> tuple[Path | None, list[Owed]]:
        """Where an inscription turns out in some way (None: never), and what is computed to ask that."""
        out: list[Owed] = []
        path: Path = ()
        for condition, holds in conditions:
            value, owed = self.pure.owing(condition, env, path)
            out += owed
            assert isinstance(value, Scalar)
            if isinstance(value.exp, t.Value):
                if value.exp.value is not holds:
                    return None, out
                continue
            path = (*path, (value.exp, holds))
        return path, out

    def put(self, situation: Situation, outcome: Outcome, acted: Acted) -> list[Node]:
        """The messages written, data before flags, and the variables that remember the new tokens."""
        env = acted.env
        writes: list[tuple[int, Node]] = []
        assignments: list[tuple[str, t.Expression]] = []
        order = {c: i for i, c in enumerate(self.machine.channels)}
        for place, exp in outcome.puts:
            if place in self.machine.sinks:
                continue
            shape = self.shapes[place]
            value = self.pure.evaluate(exp, env) if shape != Fields(()) else Rec(())
            scalars = flatten(value, shape, exp.span)
            if place in self.machine.channels:
                target = t.Target(self.file_names[place])
                line = Line(t.Write(target, tuple(x.exp for x in scalars)))
                writes.append((order[place], line))
            else:
                names = self.place_names[place]
                assignments += zip(names, (x.exp for x in scalars), strict=True)
        writes.sort(key=lambda w: w[0])
        waits = self._wait(situation, outcome, acted)
        return [
            *(w for _, w in writes),
            *waits,
            *one_after_the_other(assignments, self.names, situation.step),
        ]

    def _wait(self, situation: Situation, outcome: Outcome, acted: Acted) -> list[Node]:
        """The delay of the control token. Model time is in seconds."""
        place = self.machine.target(outcome)
        transition = situation.step.transition
        flat = self.machine.net.places[place]
        if not flat.colset.timed:
            if transition.delay is not None:
                raise UnsupportedError(
                    f"transition `{transition.short}` has a delay, but `{flat.short}`, where the program "
                    "goes, has no time stamps",
                    transition.delay.span,
                    codes.UNSUPPORTED_TIME,
                    f"give `{flat.short}` a timed colour set, such as "
                    f"`colset {flat.colset.name}_TIMED = {flat.colset.name} timed;`",
                )
            return []
        own = [] if transition.delay is None else [transition.delay]
        out: list[Node] = []
        for delay in [*own, *(e for p, e in outcome.delays if p == place)]:
            value = self.pure.evaluate(delay, acted.env)
            if not (isinstance(value, Scalar) and value.type in tdl.NUMBERS | {tdl.Type.TIME}):
                raise UnsupportedError("this delay is not a number", delay.span)
            if value.exp in (t.Value(0), t.Value(0.0)):
                continue
            wait = lasting(as_quantity(value, tdl.Type.TIME).exp, delay.span, self.names)
            out.append(Line(t.WaitTime(wait)))
        if out and acted.has_commands:
            raise UnsupportedError(
                f"transition `{transition.short}` has both commands and a delay",
                situation.step.span,
                codes.UNSUPPORTED_TIME,
            )
        return out


def header(step: Step, machine: Machine) -> Comment:
    """The comment before a transition's statements: its name, id, and where control goes."""
    places = machine.net.places
    source = next(p for p, *_ in step.takes if p in machine.control)
    targets = dict.fromkeys(places[machine.target(o)].short for o in step.outcomes)
    transition = step.transition
    return Comment(f"{titled(transition)}: {places[source].short} -> {' or '.join(targets)}")
