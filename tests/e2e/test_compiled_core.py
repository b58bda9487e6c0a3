"""The compiled net and the reference token game: the same enabled binding elements and markings everywhere.

Everything is compiled with all warnings as errors, and runs under the address and undefined-behaviour sanitizers.
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered, run
from helpers.netbuilder import flat
from helpers.thorough import THOROUGH, amount
from pn2code.cell.load import load as load_cell
from pn2code.diagnostics import Diagnostics
from pn2code.net import front

pytestmark = pytest.mark.cc

NETS: dict[str, str] = {
    "two arcs from one place sum up": """
        net Cell
          standard
          var x, y: INT;
          place P : INT = 1`1 ++ 2`2
          place Q : INT
          trans T
            in P : x
            in P : 1`y
            out Q : 1`(x + y) ++ (y - x)`y
    """,
    "coefficients, tests and repeated variables": """
        net Cell
          standard
          colset PAIR = product INT * INT;
          var x, y: INT;
          place P : PAIR = 1`(1, 1) ++ 1`(1, 2) ++ 3`(2, 2)
          place N : INT = 3`2 ++ 1`1
          place Q : PAIR
          trans Same guard [x > 0]
            in P : 2`(x, x)
            in N : 1`x
            out Q : (x, x + 1)
          trans Test
            in P : (x, y)
            both N : 1`(y * 1)
            out Q : (y, x)
    """,
    "no token taken, but an available one is wanted": """
        net Cell
          standard
          colset T = int timed;
          var x: T;
          place A : T = 1`1@3 +++ 1`2@1
          place B : T
          place C : INT = 3`0
          trans Go
            in A : 0`x
            in C : 0
            out B : x@+2
    """,
    "inhibitor and reset arcs": """
        net Cell
          standard
          var n: INT;
          place P : INT = 1`1 ++ 1`2 ++ 1`3
          place Full : INT
          place Out : INT
          trans Fill
            in P : n
            inhibit Out
            out Full : n
            out Out : n
          trans Drain
            in Out : n
            reset Full
            out Full : 7
    """,
    "records, reals, unit and functions": """
        net Cell
          standard
          colset POSE = record x: REAL * y: REAL * a: REAL;
          fun cosine d = Math.cos (d * Math.pi / 180.0)
          fun turned (p : POSE) = {x = #x p * cosine (#a p), y = ~ (#y p) / 3.0, a = #a p + 37.5}
          var p: POSE;
          var n: INT;
          place P : POSE = 1`{x = 1.5, y = 2.25, a = 10.0} ++ 1`{x = 0.1, y = 1E~7, a = 200.0}
          place Go = 4
          trans Turn guard [#x p > ~1000.0, #a p <> 11.0]
            in P : p
            in Go : ()
            out P : turned p
    """,
    "code segments with outputs": """
        net Cell
          standard
          globref made = 0;
          fun next n = (made := !made + n; (!made, n * 2))
          var n, m, k: INT;
          place P : INT = 1`1 ++ 1`2 ++ 1`5
          place Q : INT
          trans T code input (n); output (m, k); action next n
            in P : n
            out Q : 1`m ++ 1`k
    """,
    "timed tokens": """
        net Cell
          standard
          colset JOB = int timed;
          var n, k: INT;
          var j, i: JOB;
          place P : JOB = 1`(1@3) +++ 1`(2@1) +++ (2`4)@+0
          place Q : JOB
          place R : JOB = (2`9)@+2
          trans Work delay @+5 guard [j < 40]
            in P : j
            out Q : (j * 3)@+2
          trans Join
            in Q : 1`j
            in R : 1`i@+1
            out P : 1`(i + j)
            out R : 1`i@+4
    """,
    "both arcs and early tokens in time": """
        net Cell
          standard
          colset JOB = int timed;
          var j: JOB;
          place P : JOB = 1`(1@5) +++ 1`(2@9)
          place N : INT = 1`3
          var n: INT;
          trans Early guard [n > 0]
            both P : 1`j@+3
            in N : n
            out N : n - 1
    """,
    "priorities": """
        net Cell
          standard
          var n: INT;
          place P : INT = 1`1 ++ 1`2
          place Q : INT
          trans Low priority 2000
            in P : n
            out Q : n
          trans High priority 10 guard [n = 2]
            in P : n
            out Q : n + 10
    """,
    "small colour sets are enumerated": """
        net Cell
          standard
          colset SMALL = int with 1..3;
          colset COLOUR = with red | green | blue;
          colset BOTH = product SMALL * COLOUR;
          colset EVEN = subset SMALL by even;
          fun even n = n mod 2 = 0
          var s: SMALL;
          var c, d: COLOUR;
          var b: BOTH;
          place Go = 3
          place Q : BOTH
          trans All guard [s <> 2, c <> red]
            in Go : ()
            out Q : (s, c)
          trans Whole
            in Q : (s, red)
            out Q : b
    """.replace("colset EVEN = subset SMALL by even;\n", ""),
    "subsets": """
        net Cell
          standard
          fun even n = n mod 2 = 0
          colset SMALL = int with 1..9;
          colset EVEN = subset SMALL by even;
          colset FEW = subset INT with [30, 10, 20];
          var e: EVEN;
          var s: FEW;
          var n: INT;
          place P : INT = 1`4 ++ 1`5 ++ 1`6
          place Go = 2
          place Q : FEW
          trans Pick
            in P : e
            in Go : ()
            out Q : s
    """,
    "guards that bind": """
        net Cell
          standard
          colset PAIR = product INT * INT;
          fun split n = (n div 3, n mod 3)
          var n, a, b: INT;
          place P : INT = 1`7 ++ 1`(~7) ++ 1`8
          place Q : PAIR
          trans T guard [(a, b) = split n, b = 1 orelse a < 0]
            in P : n
            out Q : (a, b)
    """,
    "Bind in a guard is no match": """
        net Cell
          standard
          colset LIST = list INT;
          fun second l = let val (_ :: x :: _) = l in x end
          var l: LIST;
          var n: INT;
          place P : LIST = 1`[3, 1, 2] ++ 1`[] ++ 1`[5]
          place R : LIST = 1`[1] ++ 1`[7, 8]
          place Q : INT
          trans T guard [second l > 0]
            in P : l
            out Q : second l
          trans U guard [n = second l]
            in R : l
            out Q : n
    """,
    "Bind on input arcs is no match": """
        net Cell
          standard
          colset PR = product INT * STRING;
          fun g n = let val (x :: _) = if n > 1 then [n] else [] in x end;
          fun pair n = let val (x :: _) = if n > 1 then [(n, "a")] else [] in x end;
          fun yes n = let val true = n > 1 in () end;
          fun raises n = if n > 1 then n else raise Bind;
          var n: INT;
          place P : INT = 1`1 ++ 1`2 ++ 1`3
          place Q : INT = 3`3 ++ 2`2 ++ 1`4
          place S : PR = 2`(3, "a") ++ 1`(2, "b")
          place U : UNIT = 5`()
          place R : INT
          trans One
            in P : n
            in Q : g n
            out R : n
          trans Two
            in P : n
            in Q : 1`(g n) ++ 1`(g (n + 1))
            out R : 10 * n
          trans Count
            in P : n
            in U : (g n)`()
          trans Struct
            in P : n
            in S : pair n
          trans Unit
            in P : n
            in U : yes n
            out R : 100 * n
          trans Raised guard [raises (n + 1) > 1]
            in P : n
            in Q : raises n
    """,
    "Bind in delays of input arcs is no match": """
        net Cell
          standard
          colset TIM = int timed;
          fun g n = let val (x :: _) = if n > 1 then [n] else [] in x end;
          var n: INT;
          var m: TIM;
          place P : INT = 1`1 ++ 1`2 ++ 1`3
          place Q : TIM = 1`1@2 +++ 1`3@3 +++ 1`2@9
          place Own : TIM = 1`1@2 +++ 1`2@4
          place R : INT
          trans T
            in P : n
            in Q : m @+ g n
            out R : n
          trans V
            in P : n
            in Own : 1`1 @+ g n +++ 1`2 @+ g (n + 1)
            out R : n
    """,
    "lists and closures": """
        net Cell
          standard
          colset LIST = list INT;
          fun twice f x = f (f x)
          fun scaled k l = List.map (fn x => twice (fn y => y * k) x) l
          fun keep p [] = [] | keep p (x :: r) = if p x then x :: keep p r else keep p r
          fun sum l = foldl (fn (x, s) => x + s) 0 l
          var l: LIST;
          var n: INT;
          place P : LIST = 1`[3, 1, 2] ++ 1`[] ++ 1`[5, 5]
          place Q : LIST
          place N : INT
          trans T guard [List.all (fn x => x < 100) l]
            in P : l
            out Q : 1`(scaled 2 l) ++ 1`(keep (fn x => x > sum l div 4) l ^^ [length l])
            out N : l
          trans U guard [List.exists (fn x => x > 4) l orelse null l]
            in Q : l
            out N : sum l
            out Q : if length l > 3 then empty
                    else 1`(sort (op <) (rev (List.filter (fn x => x mod 2 = 0) l) ^^ [7, 3]))
    """,
    "recursion, deep and in the tail": """
        net Cell
          standard
          fun count (0, acc) = acc | count (n, acc) = count (n - 1, acc + n mod 7)
          fun fact 0 = 1 | fact n = n * fact (n - 1)
          fun even 0 = true | even n = odd (n - 1) and odd 0 = false | odd n = even (n - 1)
          var n: INT;
          place P : INT = 1`5 ++ 1`9 ++ 1`11
          place Q : INT
          trans T guard [even n orelse odd n]
            in P : n
            out Q : 1`(count (n * 300, 0)) ++ 1`(fact n)
    """,
    "exceptions end both": """
        net Cell
          standard
          fun fact 0 = 1 | fact n = n * fact (n - 1)
          var n: INT;
          place P : INT = 1`13 ++ 1`3
          place Q : INT
          trans T
            in P : n
            out Q : fact n
    """,
    "handled exceptions": """
        net Cell
          standard
          exception Odd
          fun half n = if n mod 2 = 0 then n div 2 else raise Odd
          fun safe (a, b) = a div b handle Div => 0
          fun other n = half n handle Overflow => 1 | _ => ~1
          var n: INT;
          place P : INT = 1`4 ++ 1`5 ++ 1`0
          place Q : INT
          trans T
            in P : n
            out Q : 1`(safe (10, n)) ++ 1`(other n) ++ 1`(hd (List.tl [1]) handle Empty => n)
    """,
    "unions, options and strings": """
        net Cell
          standard
          colset NO = int with 0..9;
          colset MSG = union Data: STRING + Ack: NO + Stop;
          datatype tree = Leaf | Knot of tree * int * tree
          fun insert (Leaf, x) = Knot (Leaf, x, Leaf)
            | insert (t as Knot (a, y, b), x) =
                if x < y then Knot (insert (a, x), y, b) else if x > y then Knot (a, y, insert (b, x)) else t
          fun total Leaf = 0 | total (Knot (a, x, b)) = total a + x + total b
          fun text (Data s) = s ^ "!" | text (Ack n) = "ack " ^ Int.toString (~ n) | text Stop = "stop"
          fun first l = case List.find (fn x => x > 2) l of SOME x => x | NONE => 0
          var m: MSG;
          var s: STRING;
          var n: NO;
          place P : MSG = 1`Data "a\\"b" ++ 1`Ack 3 ++ 1`Stop ++ 1`Ack 1
          place T : STRING
          place Q : INT
          trans Show
            in P : m
            out T : text m
            out Q : total (foldl (fn (x, t) => insert (t, x)) Leaf [3, size [1, 2], 9, 3]) + first [1, 2, 3]
          trans Only
            in P : Ack n
            in T : s
            out T : substring (s, 0, String.size s - 1)
            out Q : n
    """,
    "index, bool and strings as colours": """
        net Cell
          standard
          colset PH = index ph with 0..2;
          colset FLAG = bool with (off, on);
          var i, j: PH;
          var f: FLAG;
          fun next (ph k) = ph ((k + 1) mod 3)
          place P : PH = PH.all()
          place F : FLAG = 1`off ++ 1`on
          place Q : PH
          trans T guard [j = next i]
            in P : 1`i ++ 1`(next i)
            in F : f
            out Q : if f then 1`i else 2`j
    """,
    "values of the declarations": """
        net Cell
          standard
          colset VEC = product REAL * REAL;
          val limit = 2 + 3
          val (a, b) = (limit * 2, [1, limit])
          val half = 0.1 + 0.2
          val scale = fn x => x * half
          var n: INT;
          place P : INT = 1`1 ++ 1`7
          place Q : VEC
          trans T guard [n < limit orelse mem b (n - 2)]
            in P : n
            out Q : (scale (real n), real (a + length b))
    """,
    "structs returned and compared": """
        net Cell
          standard
          colset PAIR = product INT * STRING;
          colset PAIRS = list PAIR;
          fun make n = (n, "p" ^ Int.toString n)
          fun bump (n, s) = (n + 1, s)
          var p, q: PAIR;
          var l: PAIRS;
          var n: INT;
          place P : PAIR = 1`make 1 ++ 1`bump (make 1)
          place L : PAIRS = 1`[make 3]
          trans T guard [bump p <> make 2]
            in P : p
            in L : l
            out L : make (#1 p) :: bump p :: l
            out P : make 9
    """,
    "functions that call each other, of which one changes a reference": """
        net Cell
          standard
          globref changed = 0;
          fun even n = if n > 0 then odd (n - 1) else (changed := !changed + 7; true)
              and odd n = if n > 0 then even (n - 1) else false;
          var n, m, k: INT;
          var b: BOOL;
          place A : INT = 1`2 ++ 1`4
          place B : BOOL
          place C : INT
          trans T
            code
              input (n);
              output (b, m, k);
              action let val _ = even n; val x = (!changed, odd (n + 1), !changed) in (#2 x, #1 x, #3 x) end;
            in A : n
            out B : b
            out C : 1`m ++ 1`k
    """,
    "awkward names": """
        net Cell
          standard
          var int', cx, m, b, result: INT;
          fun floor' x = x + 1
          fun main x = floor' x
          place "for" : INT = 1`1 ++ 1`2
          place "a b" : INT
          place "a-b" : INT
          place "*/ é" : INT
          trans "while" guard [cx < 5]
            in "for" : cx
            out "a b" : main cx
            out "a-b" : cx
          trans "for"
            in "a b" : m
            in "a-b" : b
            out "*/ é" : m + b
    """,
}


@pytest.mark.parametrize("name", NETS)
def test_compiled_net_and_token_game_agree(
    name: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    """With sanitizers one in three, but in `make thorough`."""
    is_sanitized = THOROUGH or [*NETS].index(name) % 3 == 0
    workshop: Workshop = request.getfixturevalue("workshop" if is_sanitized else "fast_workshop")
    net = flat(NETS[name])
    compiled, d = lowered(net)
    assert compiled is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(compiled, tmp_path)
    steps = [agrees(net, program, seed=seed, steps=40) for seed in (1, 2, 3)]
    if "exception" not in name:
        assert max(steps) > 0


def test_float32_storage(workshop: Workshop, tmp_path: Path) -> None:
    net = flat(
        """
        net Cell
          standard
          colset FLOAT = real;
          colset POINT = record x: FLOAT * w: REAL;
          colset POINTS = list POINT;
          var p: POINT;
          place P : POINT = 1`{x = 0.1, w = 0.1} ++ 1`{x = 16777217.0, w = 1.0}
          place L : POINTS
          place R : REAL
          trans T
            in P : p
            out L : [p, {x = #x p / 3.0, w = #x p / 3.0}]
            out R : #x p
        """
    )
    storage = {"FLOAT": "float32"}
    compiled, _ = lowered(net, storage=storage)
    assert compiled is not None
    program = workshop.build(compiled, tmp_path)
    assert agrees(net, program, seed=1, steps=5, storage=storage) == 2
    first = run(program, 1, 0)[0]["marking"]["Top.P"]
    assert [1, {"x": 0.10000000149011612, "w": 0.1}] in first


def test_a_full_place_is_an_error_and_nothing_is_lost(workshop: Workshop, tmp_path: Path) -> None:
    net = flat(
        """
        net Cell
          standard
          var n: INT;
          place P : INT = 1`1 ++ 1`2 ++ 1`3
          place Narrow : INT
          trans T
            in P : n
            out Narrow : 1`n ++ 1`(n + 10)
        """
    )
    compiled, _ = lowered(net, capacity={"Narrow": 3})
    assert compiled is not None
    program = workshop.build(compiled, tmp_path)
    *_, last, error = run(program, 1, 9)
    assert len(last["marking"]["Top.Narrow"]) == 2
    assert error["error"] == "place is full"
    assert "place `Narrow`" in error["where"]


@pytest.mark.parametrize(
    ("expression", "error"),
    [
        ("n + 1073741823", "Overflow"),
        ("n div 0", "Div"),
        ("hd (tl [n])", "Empty"),
        ("List.nth ([n], 1)", "Subscript"),
        ("case n of 2 => 3", "Match"),
        ("let val (x :: _) = tl [n] in x end", "Bind"),
        ("valOf (NONE : int option)", "Option"),
        ("let fun deep x = 1 + deep x in deep n end", "recursion too deep"),
    ],
)
def test_errors_have_their_names(
    expression: str, error: str, workshop: Workshop, tmp_path: Path
) -> None:
    net = flat(
        f"""
        net Cell
          standard
          var n: INT;
          place P : INT = 1`1
          place Q : INT
          trans T
            in P : n
            out Q : {expression}
        """
    )
    compiled, d = lowered(net)
    assert compiled is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(compiled, tmp_path)
    assert run(program, 1, 3)[-1]["error"] == error


def test_simulate(workshop: Workshop, tmp_path: Path) -> None:
    net = flat(NETS["timed tokens"])
    compiled, _ = lowered(net)
    assert compiled is not None
    program = workshop.build(compiled, tmp_path, "simulate")
    enabled = run(program, "--enabled")
    assert enabled == [{"transition": "Top.Work", "binding": {"j": 4}}]
    first = run(
        program, "--steps", 50, "--seed", 3, "--trace", tmp_path / "a.trace.jsonl", "--marking"
    )
    again = run(
        program, "--steps", 50, "--seed", 3, "--trace", tmp_path / "b.trace.jsonl", "--marking"
    )
    assert first == again
    assert set(first[0]) == {p.name for p in net.places}
    a, b = ((tmp_path / f"{x}.trace.jsonl").read_text() for x in "ab")
    assert a == b
    lines = [json.loads(line) for line in a.splitlines()]
    assert lines[0]["by"] == "simulate"
    assert lines[0]["source"] == "Cell.cpn"
    assert [x["step"] for x in lines[1:-1]] == list(range(1, len(lines) - 1))
    assert lines[-1]["event"] == "end"
    refused = subprocess.run([program, "--steps", "x"], capture_output=True, text=True, check=False)
    assert refused.returncode == 2
    assert "--steps" in refused.stderr


def test_static_analysis_finds_nothing(workshop: Workshop, tmp_path: Path) -> None:
    compiled, _ = lowered(flat(NETS["unions, options and strings"]))
    assert compiled is not None
    workshop.build(compiled, tmp_path, "walk", "-fanalyzer")


@pytest.mark.parametrize("faults", ["false", "true"])
def test_the_riveting_cell(workshop: Workshop, tmp_path: Path, root: Path, faults: str) -> None:
    """With faults a random walk soon comes to its end: some short ones instead of a whole seam."""
    d = Diagnostics()
    config = load_cell(root / "examples" / "riveting", d)
    assert config is not None
    net = front.load(config.net_path, d, {**config.values, "faults": faults})
    assert net is not None
    compiled, d = lowered(net, storage=config.storage, config=config)
    assert compiled is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(compiled, tmp_path)
    walks = [
        agrees(net, program, seed=5 + k, steps=1000, storage=config.storage)
        for k in range(amount(4 if faults == "true" else 1, 4))
    ]
    assert len(set(walks)) > 1 if faults == "true" else set(walks) == {385}


SUITE = (
    "E1_reset_out", "E1b_reset_timed", "E2_inhib_timed", "E4_prio", "E5_preempt", "E6b_both_timed",
    "E20_same_colour", "E23_list_as_ms", "E24_two_arcs", "E27_subrange_var", "E28b_prio_time",
    "E32_timed_coef2", "E34_nonlinear", "E35_code_time", "E37_overflow", "E44_func_arc",
    "E46b_if_at_fix", "E50_rec", "E51_union", "E60_out_fix", "E61c", "E65", "E66b_guardvar_small",
    "E70_reset_in", "E71_eager", "E72_code_free", "E13_exn_guard", "E13b_exn_out",
)  # fmt: skip


@pytest.mark.shared
@pytest.mark.parametrize("name", SUITE[:: amount(3, 1)])
def test_nets_of_the_semantics_suite(
    name: str, workshop: Workshop, tmp_path: Path, shared: Path
) -> None:
    d = Diagnostics()
    net = front.load(shared / "semantics-suite" / f"{name}.cpn", d)
    assert net is not None
    compiled, d = lowered(net)
    assert compiled is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(compiled, tmp_path)
    agrees(net, program, seed=1, steps=30)


CORPUS = (
    "SmartFactory.cpn", "conference_fragments_knowledge_intensive.cpn", "case_based.cpn",
    "HierarchicalProtocol.cpn", "ProtocolWithTimer.cpn", "DYMO.cpn", "DistributedDataBase.cpn",
    "hoponhopoff-individuals.cpn", "DiningPhilosophers.cpn",
)  # fmt: skip


@pytest.mark.shared
@pytest.mark.parametrize("name", CORPUS[:: amount(3, 1)])
def test_real_nets(name: str, workshop: Workshop, tmp_path: Path, shared: Path) -> None:
    """Real nets without random functions (with them, the two have other numbers)."""
    d = Diagnostics()
    path = sorted((shared / "corpus" / "nets").rglob(name))[0]
    net = front.load(path, d)
    assert net is not None
    compiled, d = lowered(net)
    assert compiled is not None, [(e.code, e.message) for e in d.errors]
    program = workshop.build(compiled, tmp_path)
    agrees(net, program, seed=2, steps=30)
