"""What the engine of CPN Tools said of texts of reals and of functions of colour sets: compiled nets say the same."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from tools.oracle.recorded import rows
from tools.oracle.texts import NET

from helpers.compiled import Workshop, agrees, lowered, run
from helpers.netbuilder import flat, load
from helpers.thorough import THOROUGH
from pn2code.semantics.game.token_game import Game

pytestmark = [
    pytest.mark.cc,
    pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler"),
]
TEXTS = {
    "string": "({})", "int": "Int.toString ({})", "bool": "Bool.toString ({})",
    "order": '(case {} of LESS => "LESS" | EQUAL => "EQUAL" | GREATER => "GREATER")',
}  # fmt: skip
IN_A_PLACE = 40


def cases() -> list[tuple[str, str]]:
    """An expression of type string, and its value; a text for an exception. One in four, without `make thorough`."""
    found = []
    reals = [row for row in rows("numbers") if row[0].startswith(("Real.fmt", "Real.toString"))]
    for expression, answer in reals + rows("colsets")[:: 1 if THOROUGH else 4]:
        value = re.fullmatch(r"value: (.*) : (\w+)", answer)
        if value:
            text = value[1]
            if value[2] == "string":
                text = re.sub(
                    r"\\(.)", lambda m: {"n": "\n", "t": "\t"}.get(m[1], m[1]), text[1:-1]
                )
            found.append((TEXTS[value[2]].format(expression), text))
        elif answer == "raised: CPN'Error":
            found.append(
                (f'(ignore ({expression}); "nothing") handle CPN\'Error _ => "error"', "error")
            )
    return found + FOUND


FOUND = [
    ('String.concatWith "," (map Int.toString (map Word8.toInt (Word8Vector.toList (Base64.decode "TWFuTQ=="))))',
     "77,97,110,77"),
    ('Base64.encode (Byte.stringToBytes "pleasure.")', "cGxlYXN1cmUu"),
    ('String.concatWith "," (map Word.toString (UTF8.explode "a\\195\\164\\226\\130\\172")) ^ UTF8.toString 0wx20AC',
     "61,E4,20AC\\u20AC"),
    ("let fun all q = case FifoQueue.peek q of NONE => nil | SOME x => x :: all (#1 (FifoQueue.dequeue q)) in "
     'String.concatWith "," (map Int.toString (#2 (Stack.dequeue (Stack.enqueue (Stack.empty, 9))) '
     ":: all (List.foldl (fn (x, q) => FifoQueue.enqueue (q, x)) FifoQueue.empty [1, 2, 3]))) end", "9,1,2,3"),
    ("let structure Q = LeftPriorityQFn (struct type priority = int val compare = Int.compare "
     "type item = int * string fun priority (n : int, _ : string) = n end) "
     'fun all q = case Q.next q of SOME ((_, s), rest) => s ^ all rest | NONE => "" '
     'in all (Q.insert ((2, "d"), Q.fromList [(1, "a"), (3, "b"), (2, "c")])) end', "bdca"),
    ("let structure S = HashSetFn (struct type hash_key = int fun hashVal n = Word.fromInt (7 * n) "
     "fun sameKey (a, b : int) = a = b end) val s = S.mkFromList [5, 3, 5, 40] "
     'in S.without (s, 3); String.concatWith "," (map Int.toString (S.listItems s)) end', "40,5"),
    ('valOf (Option.map Date.toString (Date.fromString "Sat Jan 32 12:30:45 1000"))', "Sat Feb  1 12:30:45 1000"),
    ("Date.toString (Date.date {year = 0, month = Date.Dec, day = 31, hour = 12, minute = 0, second = 0, "
     'offset = NONE}) handle Date.Date => "no date"', "no date"),
    ("IntInf.toString (Time.toSeconds (Date.toTime (Date.date {year = 2038, month = Date.Jan, day = 19, hour = 3, "
     'minute = 14, second = 8, offset = NONE}))) handle Date.Date => "no time"', "no time"),
    ("ANSITerm.toString [ANSITerm.BF, ANSITerm.BG ANSITerm.Cyan] ^ \"x\"", "\033[1;46mx"),
    ("Real.toString (RealOrderStats.median (Array.fromList [4.0, 1.0, 3.0, 9.0]))", "3.5"),
    ("let open UnivariateStats val e = evaluate (foldl hadd (hempty ()) [1.0, 2.0, 6.0]) "
     'in Int.toString (N e) ^ " " ^ Real.toString (mean e) ^ " " ^ Real.toString (variance e) ^ " " '
     "^ Real.toString (median e) end", "3 3.0 7.0 2.0"),
    ("let val a = SimpleURef.uRef 1 val b = SimpleURef.uRef 2 in "
     "(ignore (SimpleURef.unify (op +) (a, b)); Int.toString (SimpleURef.!! a)) end", "3"),
    ('getOpt (PathUtil.existsFile (fn p => p = "b/f") ["a", "b/"] "f", "none")', "b/f"),
    ("let open FormatComb in format (pad left 5 int o text \"/\" o list bool o option char) 12 [true] NONE end",
     "   12/[true]NONE"),
    ("let val (xs, rest) = GetOpt.getOpt {argOrder = GetOpt.Permute, errFn = fn _ => (), options = "
     '[{short = "v", long = ["verbose"], desc = GetOpt.NoArg (fn () => "V"), help = ""}, {short = "o", '
     'long = ["out"], desc = GetOpt.ReqArg (fn s => "O" ^ s, "F"), help = ""}]} ["-v", "a", "--out=b", "--ver"] '
     'in String.concatWith "," (xs ^^ rest) end', "V,Ob,V,a"),
    ("case SplayTree.splay (fn x => Int.compare (x, 3), SplayTree.SplayObj {value = 5, left = SplayTree.SplayObj "
     "{value = 3, left = SplayTree.SplayNil, right = SplayTree.SplayNil}, right = SplayTree.SplayNil}) of "
     '(EQUAL, SplayTree.SplayObj {value, ...}) => Int.toString value | _ => "?"', "3"),
    ('String.concatWith "," (map (fn i => UE.mkstr (UE.col i) handle _ => "x") [0, 1, 2, 3, 4, 5, 6])',
     "EvenOf(2),x,x,FewOf(5),FewOf(3),FewOf(9),x"),
    ('String.concatWith "," (map (fn i => MIX.mkstr (MIX.col i) handle _ => "x") [0, 2, 3])', "(2,5),(2,9),x"),
    ("Int.toString (case [] of x :: _ => 1 | nil => 2)", "2"),
    ("Int.toString (case #[1, 3] of #[a] => a | #[a, 2] => a | #[_, b] => b | _ => 0)", "3"),
    ("let val #[a, b] = Vector.fromList [\"x\", \"y\"] in b ^ a end", "yx"),
    ('getOpt (Option.map str (Char.fromString "\\\\ \\\\b"), "none")', "b"),
    ('String.concat (map (fn c => Word32.toString (PackWord32Little.subVec (Byte.stringToBytes c, 0))) ["abcd"])',
     "64636261"),
    ("Int.toString (SMLofNJ.Susp.force (SMLofNJ.Susp.delay (fn () => 7)))", "7"),
    ("Int.toString (case [] of x :: y :: _ => y + 1 | _ => 2)", "2"),
    ('PH.mkstr (PH.col 1073741823) handle Overflow => "too large"', "too large"),
    ('(case Real.compare (0.0 / 0.0, 1.0) of LESS => "less" | _ => "more") handle IEEEReal.Unordered => "none"',
     "none"),
    ("Real.toString (Math.pow (1.0, 1.0 / 0.0))", "nan"),
    ('(ignore (hd (UNIT.all ())); "unit")', "unit"),
    ('String.concatWith "," (map (fn f => Int32.toString (f (valOf Int32.minInt, ~1)) handle e => exnName e) '
     "[op div, op mod, Int32.quot, Int32.rem])", "Div,Div,Div,Div"),
    ('String.concatWith "," (map (fn f => Int64.toString (f (valOf Int64.minInt, ~1)) handle e => exnName e) '
     "[op div, op mod, Int64.quot, Int64.rem])", "Overflow,Overflow,Overflow,Overflow"),
    ('String.concatWith "," (map Int.toString (List.mapi (fn (i, x) => i * x) [5, 6, 7]))', "0,6,14"),
    ('Format.format "%05d;%+08x;%6s;%b%%" [Format.INT ~3, Format.INT 255, Format.STR "ab", Format.BOOL true]',
     "-0003;+00000ff;    ab;true%"),
    ('Format.format "%8.3f;%.0f;%e;%g;%g" (map Format.REAL [9.9996, 2.5, 0.00012, 1E20, 100.0])',
     "  10.000;3;1.200000e-04;1e20;100"),
    ('(Format.format "%d" [Format.STR "x"]) handle Format.BadFmtList => "wrong"', "wrong"),
    ('CharVector.tabulate (3, fn i => chr (65 + i)) ^ CharVector.mapi (fn (i, c) => chr (ord c + i)) "aaa"', "ABCabc"),
    ('case Word8.fromInt 257 of 0w1 => Word8.toString 0wxAB ^ str (Byte.byteToChar 0wx41) | _ => "no"', "ABA"),
    ('case Scan.sscanf "%s x %d" " ab x-12" of SOME [Format.STR s, Format.INT n] => s ^ Int.toString n | _ => "no"',
     "ab~12"),
    ('String.concat (map Atom.toString (AtomSet.listItems (AtomSet.fromList (map Atom.atom ["zebra", "a", "c"]))))',
     "aczebra"),
]  # fmt: skip
"""What `./dev oracle --compiled` has found, and the library: the engine's answers."""


def test_compiled_nets_say_the_same(fast_workshop: Workshop, tmp_path: Path) -> None:
    all_cases = cases()
    places = [all_cases[i : i + IN_A_PLACE] for i in range(0, len(all_cases), IN_A_PLACE)]
    text = NET + "".join(
        f'  place P{i} : STRING = 1`(String.concatWith "|" [{", ".join(f"({e})" for e, _ in some)}])\n'
        for i, some in enumerate(places)
    )
    ir, d = lowered(flat(text))
    assert ir is not None, [e.message for e in d.errors]
    [line] = run(fast_workshop.build(ir, tmp_path / "net", "walk", "-O0"), 1, 0)
    assert "error" not in line, line
    for i, some in enumerate(places):
        found = line["marking"][f"Top.P{i}"][0][1].split("|")
        assert list(zip([e for e, _ in some], found, strict=True)) == some


LIBRARY = """
net Library
  standard
  structure Names = RedBlackMapFn (struct type ord_key = string val compare = String.compare end);
  structure Texts = SplaySetFn (struct type ord_key = string val compare = String.compare end);
  var n: INT;
  val known = List.foldl Names.insert' Names.empty [("b", 2), ("a", 1), ("c", 3)];
  val day = Date.date {year = 2024, month = Date.Feb, day = 30, hour = 25, minute = 2, second = 3, offset = NONE};
  fun empty_table () = HashTable.mkTable (HashString.hashString, op =) (4, Fail "none");
  fun count t k = HashTable.insert t (k, getOpt (HashTable.find t k, 0) + 1);
  fun counted l = let val t = empty_table () in (List.app (count t) l; HashTable.listItemsi t) end;
  place P : INT = 1`1++1`2++1`3
  place Q : STRING
  trans T
    in P : n
    out Q : String.concat (List.map (fn (k, x) => k ^ Int.toString (x * n)) (Names.listItemsi known))
    out Q : String.concat (Texts.listItems (Texts.fromList ["z", "y", Int.toString n]))
    out Q : String.concat (map (fn (k, x) => k ^ Int.toString (x * n)) (counted ["z", "ab", "z", "q"]))
    out Q : Date.toString day ^ Int.toString (Date.yearDay day + n)
    out Q : ListFormat.listToString Int.toString (ListMergeSort.sort Int.> [3, n, 2])
    out Q : IntInf.toString (RealToIntInf n 20737418.245)
    out Q : IntInf.toString (RealToIntInf n 3.14159) ^ Real.toString (IntInfToReal n 314)
    out Q : Int.toString (IntBinaryMap.lookup (IntBinaryMap.singleton (2, 7), n) handle LibBase.NotFound => n)
    out Q : Int.toString (Fifo.head (#1 (Fifo.dequeue (Fifo.enqueue (Fifo.enqueue (Fifo.empty, 1), n)))))
"""


def test_the_utility_library_is_compiled(fast_workshop: Workshop, tmp_path: Path) -> None:
    net = flat(LIBRARY)
    ir, d = lowered(net)
    assert ir is not None, [e.message for e in d.errors]
    program = fast_workshop.build(ir, tmp_path / "net")
    assert agrees(net, program, seed=1, steps=5) == 3
    game = Game(net)
    game.fire(game.enabled()[0])
    [found] = [game.marking_text(p.name) for p in net.places if p.short == "Q"]
    wanted = (
        '"q1ab1z2"',
        '"1yz"',
        '"207374182"',
        '"3131.4"',
        '"Sat Mar  2 01:02:03 202462"',
        '"[1,2,3]"',
        '"a1b2c3"',
    )
    assert all(f"1`{text}" in found for text in wanted), found
    assert '2`"1"' in found


def test_what_is_not_there_is_named() -> None:
    net, d = load(
        "net N\n  standard\n  val t = fn () => SMLofNJ.Cont.callcc ();\n  place P : INT = 1`1"
    )
    assert net is not None
    assert [(w.code, w.message) for w in d] == [
        (
            "unsupported-function",
            "`SMLofNJ.Cont.callcc` is not available here: pn2code does not have this part of the library",
        )
    ]
