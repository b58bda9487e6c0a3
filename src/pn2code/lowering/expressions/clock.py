"""Model time: an INT or a REAL for the clock, stamps and delays; in ML an `IntInf.int` or a real."""

from __future__ import annotations

from pn2code.ir import nodes as ir
from pn2code.ir.nodes import Ir, IrType


def clock(real_time: bool) -> IrType:
    """The type of model time."""
    return ir.REAL if real_time else ir.INT


def in_clock(real_time: bool, time: Ir) -> Ir:
    """A time or delay, an `int` or a model time of ML, in the type of the clock."""
    if real_time:
        return ir.Op("Real.fromInt", (time,), ir.REAL) if time.type == ir.INT else time
    if time.type != ir.BIG:
        return time
    match time:
        case ir.Const(value=int() as number) if abs(number) < 2**63:
            return ir.Const(number, ir.INT)
        case ir.Op(name="IntInf.fromInt" | "Int.toLarge" | "time.to_large", arguments=(inner,)):
            return inner
    return ir.Op("time.of_large", (time,), ir.INT)


def now(real_time: bool) -> Ir:
    """Model time as ML has it."""
    if real_time:
        return ir.Now(ir.REAL)
    return ir.Op("time.to_large", (ir.Now(ir.INT),), ir.BIG)


def after_now(real_time: bool, delay: Ir) -> Ir:
    """Model time plus a delay."""
    return plus(ir.Now(clock(real_time)), in_clock(real_time, delay))


def plus(a: Ir, b: Ir) -> Ir:
    """The sum of two times."""
    if isinstance(b, ir.Const) and b.value == 0:
        return a
    return ir.Op("Real.+" if a.type == ir.REAL else "time.+", (a, b), a.type)


def accepted(real_time: bool, delay: Ir) -> Ir:
    """The latest stamp that an input arc with a delay accepts: the last with stamp - delay <= now, as it is rounded."""
    early = in_clock(real_time, delay)
    if real_time and not (isinstance(early, ir.Const) and early.value == 0):
        return ir.Op("time.latest", (ir.Now(ir.REAL), early), ir.REAL)
    return plus(ir.Now(clock(real_time)), early)


def timed_part(token: Ir, label: str, t: IrType) -> Ir:
    """The value of a timed token, or its stamp as ML has it."""
    if t == ir.BIG and label == "stamp":
        return ir.Op("time.to_large", (ir.Member(token, label, ir.INT),), ir.BIG)
    return ir.Member(token, label, t)
