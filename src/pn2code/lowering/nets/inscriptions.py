"""What arcs and initial markings put: multi-set expressions taken apart into single moves where that is possible.

``1`x ++ n`y`` becomes two `Put`s, `if c then 1`x else empty` an
`If` around one; only what is left (a function that returns a multi-set) is computed as a list and put element
by element.
"""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir
from pn2code.lowering.expressions.body import Body
from pn2code.lowering.expressions.clock import after_now, clock, in_clock, plus
from pn2code.lowering.expressions.values import Env
from pn2code.lowering.nets import arc_lists
from pn2code.ml.core import terms as core
from pn2code.net.flat import Form

ONE = ir.Const(1, ir.INT)


class Putter:
    """Puts into one place.

    Args:
        stamp: the stamp of what has none of its own; None in an untimed place.
        delay: the transition's delay, which is added to stamps of their own; None: 0.
    """

    def __init__(
        self, body: Body, place: int, env: Env, stamp: Ir | None, delay: Ir | None, note: str
    ) -> None:
        self._body = body
        self._place = place
        self._env = env
        self._stamp = stamp
        self._delay = delay
        self._note = note

    def put(self, exp: core.Exp, form: Form) -> None:
        """Put the value of an expression."""
        match form:
            case Form.TOKEN:
                self._token(ONE, self._body.ir(exp, self._env), self._stamp)
            case Form.MULTISET:
                self._multiset(exp, self._stamp)
            case Form.TIMED_TOKEN:
                self._timed_token(exp)
            case Form.TIMED_MULTISET:
                self._timed_multiset(exp)

    def _note_once(self) -> str:
        note, self._note = self._note, ""
        return note

    def _token(self, count: Ir, value: Ir, stamp: Ir | None) -> None:
        value = self._body.addressable(value, "token")
        self._body.emit(ir.Put(self._place, count, value, stamp, self._note_once()))

    def _multiset(self, exp: core.Exp, stamp: Ir | None) -> None:
        body, env = self._body, self._env
        match exp:
            case core.Apply(
                function=core.Builtin(name="Ms.++" | "List.@"),
                argument=core.RecordExp(fields=((_, a), (_, b))),
            ):
                self._multiset(a, stamp)
                self._multiset(b, stamp)
            case core.Apply(
                function=core.Builtin(name="Ms.`"), argument=core.RecordExp(fields=((_, n), (_, v)))
            ):
                count = body.ir(n, env)
                self._token(count, body.ir(v, env), stamp)
            case core.ListExp(items=items):
                for item in items:
                    self._token(ONE, body.ir(item, env), stamp)
            case core.If():
                condition = body.ir(exp.condition, env)
                note = self._note_once()
                if note:
                    body.emit(ir.Note(note))
                with body.block() as then:
                    self._multiset(exp.then, stamp)
                with body.block() as otherwise:
                    self._multiset(exp.otherwise, stamp)
                body.emit(ir.If(condition, tuple(then), tuple(otherwise)))
            case _:
                value = arc_lists.multiset(body, exp, env)
                table = body.program.types.plain(value.type)
                body.emit(ir.PutAll(self._place, value, table, stamp, False, self._note_once()))

    def _timed_token(self, exp: core.Exp) -> None:
        body, env = self._body, self._env
        match exp:
            case core.Apply(
                function=core.Builtin(name="Time.token@+" | "Time.token@++" | "Time.@" as name),
                argument=core.RecordExp(fields=((_, v), (_, d))),
            ):
                value = body.ir(v, env)
                stamp_of = in_clock if name == "Time.@" else after_now
                stamp = stamp_of(body.program.real_time, body.ir(d, env))
                self._token(ONE, value, self._shifted(stamp))
            case _:
                token = body.atomic(body.ir(exp, env), "token")
                definition = body.program.types.definition(token.type)
                assert isinstance(definition, ir.StructDef)
                inner = dict(definition.fields)["value"]
                own = ir.Member(token, "stamp", clock(body.program.real_time))
                self._token(ONE, ir.Member(token, "value", inner), self._shifted(own))

    def _timed_multiset(self, exp: core.Exp) -> None:
        body, env = self._body, self._env
        match exp:
            case core.Apply(
                function=core.Builtin(name="Time.+++"),
                argument=core.RecordExp(fields=((_, a), (_, b))),
            ):
                self._timed_multiset(a)
                self._timed_multiset(b)
            case core.Apply(
                function=core.Builtin(name="Time.@+" | "Time.@++"),
                argument=core.RecordExp(fields=((_, ms), (_, d))),
            ):
                self._multiset(
                    ms, self._shifted(after_now(body.program.real_time, body.ir(d, env)))
                )
            case core.Apply(
                function=core.Builtin(name="Ms.`"), argument=core.RecordExp(fields=((_, n), (_, v)))
            ) if (
                isinstance(v, core.Apply)
                and isinstance(v.function, core.Builtin)
                and v.function.name == "Time.@"
            ):
                value, time = body.components(body.exp(v.argument, env), 2)
                count = body.ir(n, env)
                stamp = in_clock(body.program.real_time, body.code(time))
                self._token(count, body.code(value), self._shifted(stamp))
            case core.ListExp(items=()):
                pass
            case core.If():
                condition = body.ir(exp.condition, env)
                with body.block() as then:
                    self._timed_multiset(exp.then)
                with body.block() as otherwise:
                    self._timed_multiset(exp.otherwise)
                body.emit(ir.If(condition, tuple(then), tuple(otherwise)))
            case _:
                value = body.ir(exp, env)
                table = body.program.types.plain(value.type)
                body.emit(
                    ir.PutAll(self._place, value, table, self._delay, True, self._note_once())
                )

    def _shifted(self, stamp: Ir) -> Ir:
        return stamp if self._delay is None else plus(stamp, self._delay)
