# ruff: noqa: E501 - rows of texts
"""What is changed: nets of the collection beside the repository if it is there, the example, nets made for tests."""

from __future__ import annotations

from pathlib import Path

from tests.helpers.netbuilder import cpn

LARGEST = 150_000
"""Bytes; larger nets of the collection cost much time and have nothing that smaller ones lack."""

MIXED = """
    net Mixed
      standard
      colset PART = with screw | nut | bolt timed;
      colset SEAT = index seat with 0..3;
      colset SMALL = int with 0..5;
      colset PAIR = product SMALL * PART;
      colset ITEM = record id: INT * kind: PART * on: BOOL;
      colset ITEMS = list ITEM;
      colset MSG = union Ask: SMALL + Tell: PAIR + Quit;
      fun even n = n mod 2 = 0
      colset EVEN = subset SMALL by even;
      colset FEW = subset SMALL with [1, 2, 3];
      var n, m: SMALL; var s: STRING; var p: PART; var i: ITEM; var l: ITEMS; var c: SEAT; var g: MSG; var b: BOOL;
      val P_HIGH = 100;
      fun put (x : ITEM, nil) = [x] | put (x, y :: r) = if #id x < #id y then x :: y :: r else y :: put (x, r)
      exception Empty
      datatype 'a tree = Leaf | Knot of 'a tree * 'a * 'a tree
      globref count = 0;
      val limit = 5
      page Top
        place A : SMALL = SMALL.all()
        place B : PART = 1`screw@1 ++ 2`nut@3
        place C fusion Shared : ITEMS = 1`[]
        place D : MSG = 1`(Ask 3) ++ 1`Quit
        place E : STRING = "x"
        trans T1 guard [n < m, p <> bolt] delay @+n priority P_HIGH code input (n); output (s); action (count := !count + n; "a" ^ SMALL.mkstr n)
          in A : 1`n ++ 1`m
          both B : p
          out E : s
          inhibit D :
        trans T2
          in D : Ask n
          out D : Tell (n, screw)
          both C : l
          out C : put ({id = n, kind = nut, on = true}, l)
        trans T3
          in D : Tell (n, p)
          out A : if n > 3 then 1`n else empty
          reset E :
        subst Sub = Inner (Inp -> A, Outp -> E)
      page Inner
        place Inp port in : SMALL
        place Outp port out : STRING
        place Seats : SEAT = SEAT.all()
        place F fusion Shared : ITEMS = 1`[]
        trans Move guard [case n of 0 => false | _ => true]
          in Inp : n
          in Seats : c
          out Outp : case n of 1 => "one" | k => Int.toString k
"""
TIMED = """
    net Clock
      standard
      colset JOB = product INT * REAL timed;
      var j: INT; var r: REAL;
      fun next (r : real) = floor (r * 1.5 + exponential 0.5)
      place Start : JOB = 1`(1, 0.5)@2 +++ 1`(2, 2.5)@0
      place Done : JOB
      trans Go delay @+next r
        in Start : (j, r) @+ 1
        out Done : 1`(j + 1, r)@+3
"""


def bases(root: Path, shared: Path) -> list[tuple[str, bytes]]:
    """Names and contents, in a fixed order."""
    found = [("mixed", cpn(MIXED)), ("clock", cpn(TIMED))]
    found.append(("riveting", (root / "examples" / "riveting" / "cell.cpn").read_bytes()))
    for folder in ("corpus/nets", "semantics-suite"):
        for path in sorted((shared / folder).rglob("*.cpn")) if shared.is_dir() else ():
            if path.stat().st_size <= LARGEST:
                found.append((path.relative_to(shared).as_posix(), path.read_bytes()))
    return found
