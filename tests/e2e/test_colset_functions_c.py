"""Functions of colour sets and enumeration of their values, compiled: the same as in the token game."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

NET = """
    net Colours
      standard
      colset E = with red | green | blue;
      colset SMALL = int with 0..3;
      colset PAIR = product SMALL * E;
      colset REC = record n: SMALL * s: STRING;
      colset SHORT = list E with 1..2;
      colset WORD = string with "a".."c" and 1..2;
      colset U = union Nothing + Num: SMALL + Words: WORD;
      colset TEXTS = list STRING;
      fun is_even n = n mod 2 = 0
      colset EVEN = subset SMALL by is_even;
      colset SOME_E = subset E with [blue, red];
      colset MIX = product EVEN * SOME_E;
      colset TE = E timed;
      fun strings xs = "[" ^ String.concatWith "," xs ^ "]"
      fun all_of (mkstr, xs) = strings (List.map mkstr xs)
      fun read_back f text = f (TextIO.openString text)
      var e: E;
      var p: PAIR;
      var s: SHORT;
      var w: WORD;
      var m: MIX;
      var u: U;
      var t: STRING;
      place Texts : STRING = 1`PAIR.mkstr_ms (2`(1, red) ++ 1`(0, blue) ++ 1`(1, red))
        ++ 1`REC.mkstr {n = 1, s = "x"} ++ 1`E.mkstr_ms empty
        ++ 1`TE'timed.mkstr_ms (1`red @ 3 +++ 2`red @ 5 +++ 1`green @ 1)
        ++ 1`all_of (SHORT.mkstr, SHORT.all ())
        ++ 1`all_of (WORD.mkstr, WORD.all ())
        ++ 1`all_of (U.mkstr, U.all ())
        ++ 1`all_of (MIX.mkstr, MIX.all ())
        ++ 1`Int.toString (SHORT.size () + 100 * MIX.size () + 10000 * MIX.ord (2, blue))
        ++ 1`WORD.mkstr (WORD.col 4) ++ 1`SHORT.mkstr (SHORT.base) ++ 1`WORD.mkstr WORD.base
        ++ 1`U.illegal_msg (Num 9) ++ 1`SMALL.illegal_msg 2
        ++ 1`PAIR.mkstr (read_back PAIR.input " ( 2 , green )")
        ++ 1`REC.mkstr (read_back REC.input "{s=\\"a b\\",n=3}")
        ++ 1`U.mkstr (read_back U.input "Words(\\"ab\\")")
        ++ 1`TEXTS.mkstr (read_back TEXTS.input "[\\"a\\", \\"\\"]")
        ++ 1`E.mkstr_ms (read_back E.input_ms "2`red ++\\n1`blue")
        ++ 1`TE'timed.mkstr_ms (read_back TE'timed.input_ms "1`red@3 +++ 1`blue@0")
        ++ 1`(SMALL.mkstr (read_back SMALL.input "x") handle _ => "no number")
        ++ 1`(Int.toString (SHORT.ord []) handle CPN'Error _ => "no position")
      place Start : UNIT = 6`()
      place Ends : TEXTS
      place Drawn : WORD
      trans Free
        in Start : ()
        out Ends : [SHORT.mkstr s, WORD.mkstr w]
        out Drawn : WORD.ran ()
      trans Mixed guard [#1 m > 0]
        in Start : ()
        out Ends : [MIX.mkstr m]
      trans Union
        in Start : ()
        out Ends : [U.mkstr u]
"""


def test_compiled_and_token_game_agree(workshop: Workshop, tmp_path: Path) -> None:
    net = flat(NET)
    ir, d = lowered(net)
    assert ir is not None, [(e.code, e.message, e.origin.describe()) for e in d.errors]
    program = workshop.build(ir, tmp_path / "net")
    for seed in (1, 2, 3):
        assert agrees(net, program, seed=seed, steps=10) == 6
