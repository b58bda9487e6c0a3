"""CPN ML in compiled nets: functions, references, exceptions and data types as values, against the token game.

Each program is a net with one transition, whose output arcs are the expressions, for three values of `n`. Compiled
with all warnings as errors, run under sanitizers.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from helpers.compiled import Workshop, agrees, lowered
from helpers.netbuilder import flat

pytestmark = pytest.mark.cc

INTS = "INT"
STRINGS = "STRING"

PROGRAMS: dict[str, tuple[str, dict[str, list[str]]]] = {
    "functions in lists": (
        """
        fun add k x = x + k
        val fs = [fn x => x + 1, fn x => x * 2, Int.abs, add 10, ~]
        fun table k = [fn x => x + k, fn x => x - k, op div o (fn x => (x, k + 1))]
        """,
        {
            INTS: [
                "foldl (fn (f, s) => f s) n fs",
                "hd (List.map (fn f => f n) (rev fs))",
                "List.nth (table n, n mod 3) 20",
                "length (List.filter (fn f => f n > 3) fs)",
                "case fs of f :: g :: _ => f (g n) | _ => 0",
                "let val [a, b, c] = table 2 in a (b (c n)) end",
            ]
        },
    ),
    "functions that are chosen": (
        """
        fun pick n = if n > 4 then fn x => x + n else fn x => x * n
        fun named 0 = Int.abs | named 1 = pick 3 | named n = (fn x => if x > n then x else n)
        fun twice f x = f (f x)
        fun sign n = case Int.compare (n, 5) of LESS => ~ | EQUAL => (fn x => 0) | GREATER => (fn x => x)
        """,
        {
            INTS: [
                "pick n 7",
                "twice (pick n) 2",
                "named (n mod 3) n",
                "(if n > 1 then op + else op * ) (n, 3)",
                "sign n n",
                "((case n of 1 => hd | _ => List.last) [1, 2, n])",
                "(sign n o pick n o sign 9) 3",
                "(pick 1 handle Div => pick 2) n",
            ]
        },
    ),
    "functions returned by recursive functions": (
        """
        fun compose [] = (fn x => x) | compose (f :: r) = fn x => f (compose r x)
        fun times 0 f = (fn x => x) | times n f = f o times (n - 1) f
        fun adder 0 = (fn x => x) | adder n = let val g = adder (n - 1) in fn x => g x + 1 end
        fun even 0 = (fn () => "even") | even n = odd (n - 1)
        and odd 0 = (fn () => "odd") | odd n = even (n - 1)
        """,
        {
            INTS: [
                "compose [fn x => x + 1, fn x => x * n, fn x => x - 3] 5",
                "times n (fn x => x * 2) 1",
                "adder n 100",
            ],
            STRINGS: ["even n ()"],
        },
    ),
    "continuations": (
        """
        fun fact 0 k = k 1 | fact n k = fact (n - 1) (fn r => k (n * r))
        fun fib 0 k = k 0 | fib 1 k = k 1 | fib n k = fib (n - 1) (fn a => fib (n - 2) (fn b => k (a + b)))
        datatype tree = Leaf | Node of tree * int * tree
        fun build 0 = Leaf | build n = Node (build (n - 1), n, build (n - 2 + (if n < 2 then 1 else 0)))
        fun sum Leaf k = k 0 | sum (Node (l, x, r)) k = sum l (fn a => sum r (fn b => k (a + x + b)))
        fun find p [] found none = none () | find p (x :: r) found none = if p x then found x else find p r found none
        """,
        {
            INTS: [
                "fact n (fn x => x)",
                "fib n (fn x => x + 1)",
                "sum (build n) (fn x => x)",
                "find (fn x => x > n) [1, 3, 5, 7] (fn x => x * 2) (fn () => ~1)",
            ]
        },
    ),
    "lazy values and streams": (
        """
        datatype 'a lazy = Thunk of unit -> 'a | Value of 'a
        fun force (Thunk f) = f () | force (Value v) = v
        datatype 'a stream = Nil | Cons of 'a * (unit -> 'a stream)
        fun from n = Cons (n, fn () => from (n + 1))
        fun take (0, _) = [] | take (_, Nil) = [] | take (n, Cons (x, r)) = x :: take (n - 1, r ())
        fun keep p Nil = Nil | keep p (Cons (x, r)) = if p x then Cons (x, fn () => keep p (r ())) else keep p (r ())
        fun mapped f Nil = Nil | mapped f (Cons (x, r)) = Cons (f x, fn () => mapped f (r ()))
        fun sieve Nil = Nil | sieve (Cons (p, r)) = Cons (p, fn () => sieve (keep (fn x => x mod p <> 0) (r ())))
        fun text s = String.concat (List.map (fn x => Int.toString x ^ ".") s)
        """,
        {
            INTS: ["force (if n > 5 then Thunk (fn () => n * n) else Value n)"],
            STRINGS: [
                "text (take (n, sieve (from 2)))",
                "text (take (3, mapped (fn x => x * x) (from n)))",
                "String.concat (take (2, mapped Int.toString "
                "(keep (fn x => x mod 3 = 0) (from n))))",
            ],
        },
    ),
    "objects of functions": (
        """
        fun counter start = let val r = ref start in {get = fn () => !r, step = fn k => r := !r + k} end
        fun stack () = let val s = ref ([] : int list)
          in (fn x => s := x :: !s, fn () => case !s of [] => ~1 | x :: r => (s := r; x)) end
        datatype shape = Shape of {area: int -> int, name: string}
        val shapes = [Shape {area = fn x => x * x, name = "square"}, Shape {area = fn x => 3 * x * x, name = "disc"}]
        fun area k (Shape {area, ...}) = area k
        """,
        {
            INTS: [
                "let val c = counter n in (#step c 3; #step c 4; #get c ()) end",
                "let val c = counter n val d = counter 1 val both = [c, d, c] "
                "in (List.app (fn x => #step x 5) both; foldl (fn (x, s) => s + #get x ()) 0 both) end",
                "let val (push, pop) = stack () in (push n; push 2; push 3; pop () * 100 + pop () * 10 + pop ()) end",
                "foldl (op +) 0 (List.map (area n) shapes)",
            ],
            STRINGS: ["String.concat (List.map (fn Shape s => #name s) shapes)"],
        },
    ),
    "state at top level": (
        """
        globref total = 0;
        val log = ref ([] : string list)
        val cells = [ref 1, ref 2, ref 3]
        val (first, second) = (ref 10, ref "x")
        val alias = first
        val hook = ref (fn x => x + 1)
        val next = let val r = ref 0 in fn () => (r := !r + 1; !r) end
        fun note s = log := s :: !log
        fun bump i = let val c = List.nth (cells, i mod 3) in (c := !c + i; !c) end
        """,
        {
            INTS: [
                "(total := !total + n; !total)",
                "bump n + bump n",
                "(alias := !alias + n; !first)",
                "(hook := (let val old = !hook in fn x => old x * 2 + n end); (!hook) n mod 1000)",
                "next () * 10 + next ()",
                "(note (Int.toString n); length (!log))",
                "if hd cells = hd cells andalso hd cells <> List.nth (cells, 1) then 1 else 0",
                "if alias = first then 1 else 0",
            ],
            STRINGS: ["(second := !second ^ Int.toString n; !second)", "String.concat (!log)"],
        },
    ),
    "local references": (
        """
        fun loop n = let val i = ref 0 val s = ref 0 in (while !i < n do (s := !s + !i; inc i); !s) end
        fun summed l = let val s = ref 0 in (List.app (fn x => s := !s + x) l; !s) end
        fun swap (a, b) = let val t = !a in (a := !b; b := t) end
        fun swapped (x, y) = let val a = ref x val b = ref y in (swap (a, b); (!a, !b)) end
        fun made f = let val r = ref (f 1) in (r := f (!r); r) end
        datatype node = End | Link of int * node ref
        fun ring n = let val last = ref End val head = Link (n, ref (Link (n + 1, last))) in (last := head; head) end
        fun walk (_, End) = 0 | walk (0, Link (x, _)) = x | walk (k, Link (_, r)) = walk (k - 1, !r)
        fun guarded r = ((r := 1; r := 10 div (!r - 1); !r) handle Div => !r)
        """,
        {
            INTS: [
                "loop n",
                "summed [1, n, 3]",
                "let val (a, b) = swapped (n, 2) in a * 10 + b end",
                "!(made (fn x => x * n))",
                "walk (n, ring n)",
                "guarded (ref n)",
                "let val r = ref n in (r := (!r + 1 ; r := !r * 2; !r); !r) end",
                "let val rs = List.tabulate (n, fn i => ref i) "
                "in (List.app (fn r => r := !r * !r) rs; foldl (fn (r, s) => !r + s) 0 rs) end",
            ]
        },
    ),
    "exceptions with values": (
        """
        exception Small
        exception Big of int
        exception Pair of {a: int, b: string}
        fun f n = if n < 3 then raise Small else if n > 6 then raise Big (n * 2) else n
        fun g n = f n handle Big k => k + 1
        fun h n = g n handle Small => ~1
        fun again n = (f n handle Small => raise Big 7 | e => raise e) handle Big k => k | _ => 0
        fun name e = (raise e) handle Small => "small" | Big k => "big " ^ Int.toString k | e => exnName e
        fun inner n = let exception Inner of int
          in (if n > 3 then raise Inner n else raise Fail "no") handle Inner k => k end
        """,
        {
            INTS: [
                "h n",
                "again n",
                '(raise Pair {a = n, b = "x"}) handle Pair {a, b} => a + String.size b',
                "(10 div (n - 1)) handle Div => 99",
                "inner n handle Fail s => String.size s",
                "(hd [] + 1) handle Empty => 5 | Div => 6",
                "(f n handle Small => 3 | Big k => k) + (f (n + 5) handle Big k => k)",
                "(case f n of 5 => 50 | k => k) handle e => (case e of Small => 1 | Big k => k | _ => 0)",
            ],
            STRINGS: [
                "name (if n > 5 then Big n else Small)",
                "name Div",
                'name (Fail "x")',
                "(Int.toString (f n)) handle e => exnName e",
                "(Int.toString (n div 0)) handle e => exnName e",
                "(Int.toString (List.nth ([1, 2], n))) handle e => exnName e",
                '(raise Fail (Int.toString n)) handle Fail s => s ^ "!"',
                '(raise Fail "a") handle e => exnMessage e',
            ],
        },
    ),
    "exceptions as values": (
        """
        exception A
        exception B of int
        val all = [A, B 3, Div, Fail "f", B 4]
        fun weight A = 1 | weight (B n) = n | weight (Fail s) = String.size s | weight _ = 100
        val last = ref (NONE : exn option)
        fun tried f = f () handle e => (last := SOME e; 0)
        fun how NONE = "none" | how (SOME (B n)) = Int.toString n | how (SOME e) = exnName e
        exception Wrap of exn
        fun unwrap (Wrap e) = unwrap e | unwrap e = e
        """,
        {
            INTS: [
                "foldl (op +) 0 (List.map weight all)",
                "tried (fn () => if n > 5 then raise B n else if n > 2 then 1 div 0 else n)",
                "weight (unwrap (Wrap (Wrap (B n))))",
                "(raise Wrap (B n)) handle Wrap (B k) => k | Wrap _ => 0",
                "(raise List.nth (all, n mod 5)) handle B k => k | Fail _ => 7 | Div => 8 | A => 9",
            ],
            STRINGS: ["how (!last)"],
        },
    ),
    "exceptions of one name": (
        """
        exception E of int
        fun first n = raise E n
        exception E of string
        fun second s = raise E s
        fun both f = f () handle E s => s
        fun local_one n = let exception E in (if n > 3 then raise E else raise (Fail "x")) handle E => "mine" end
        """,
        {
            STRINGS: [
                "both (fn () => second (Int.toString n))",
                '(both (fn () => first n)) handle e => "other " ^ exnName e',
                "local_one n handle Fail s => s",
            ]
        },
    ),
    "data types": (
        """
        datatype exp = Num of int | Add of exp * exp | Mul of exp * exp | Neg of exp
          | Let of string * exp * exp | Var of string
        exception Unbound of string
        fun lookup (x, []) = raise Unbound x | lookup (x, (y, v) :: r) = if x = y then v else lookup (x, r)
        fun eval env (Num n) = n
          | eval env (Add (a, b)) = eval env a + eval env b
          | eval env (Mul (a, b)) = eval env a * eval env b
          | eval env (Neg a) = ~ (eval env a)
          | eval env (Let (x, a, b)) = eval ((x, eval env a) :: env) b
          | eval env (Var x) = lookup (x, env)
        datatype 'a tree = Leaf | Node of 'a tree * 'a * 'a tree
        fun insert less (x, Leaf) = Node (Leaf, x, Leaf)
          | insert less (x, t as Node (l, y, r)) =
              if less (x, y) then Node (insert less (x, l), y, r)
              else if less (y, x) then Node (l, y, insert less (x, r)) else t
        fun flat Leaf = [] | flat (Node (l, x, r)) = flat l ^^ (x :: flat r)
        fun fold f z Leaf = z | fold f z (Node (l, x, r)) = fold f (f (x, fold f z l)) r
        datatype a = A of b list | Stop and b = B of a * int
        fun deep Stop = 0 | deep (A bs) = foldl (fn (B (x, n), s) => s + n + deep x) 0 bs
        datatype ('k, 'v) map = Map of ('k * 'v) list
        fun put (Map l) k v = Map ((k, v) :: l)
        fun get (Map l) k = case List.find (fn (k', _) => k' = k) l of SOME (_, v) => SOME v | NONE => NONE
        """,
        {
            INTS: [
                'eval [] (Let ("x", Num n, Add (Var "x", Mul (Num 3, Neg (Var "x")))))',
                'eval [("y", n)] (Var "z") handle Unbound s => String.size s',
                "foldl (op +) 0 (flat (foldl (insert (op <)) Leaf [3, n, 1, 2]))",
                "fold (fn (x, s) => s * 2 + x) 0 (foldl (insert (op >)) Leaf [n, 5, 6])",
                "deep (A [B (A [B (Stop, n)], 2), B (Stop, 3)])",
                'valOf (get (put (put (Map []) "a" 1) "b" n) "b")',
                "if Num n = Num 5 then 1 else 0",
                "length (flat (Leaf : int tree))",
            ],
            STRINGS: [
                'String.concat (flat (foldl (insert (op <)) Leaf ["b", "a", Int.toString n]))'
            ],
        },
    ),
    "polymorphism": (
        """
        fun id x = x
        fun pair x = (x, x)
        fun apply (f, x) = f x
        fun swap (a, b) = (b, a)
        fun zip ([], _) = [] | zip (_, []) = [] | zip (x :: r, y :: s) = (x, y) :: zip (r, s)
        fun curry f a b = f (a, b)
        fun uncurry f (a, b) = f a b
        fun flip f a b = f b a
        fun repeat 0 f = id | repeat n f = f o repeat (n - 1) f
        fun member eq (x, []) = false | member eq (x, y :: r) = eq (x, y) orelse member eq (x, r)
        val none = []
        fun poly x = let fun k y = (x, y) in (k 1, k "a") end
        val twice = fn f => fn x => f (f x)
        val church = fn n => twice (twice n)
        """,
        {
            INTS: [
                "id id n",
                "#1 (swap (pair n))",
                "apply (curry (op +) 3, n)",
                "uncurry (fn a => fn b => a * b) (n, 2)",
                "repeat n (fn x => x + 2) 0",
                "flip (fn a => fn b => a - b) 1 n",
                "length none + length (n :: none)",
                "if member (op =) (n, [1, 5]) then 1 else 0",
                '#1 (#1 (poly n)) + String.size (#2 (#2 (poly "x")))',
                "church (fn x => x + n) 0",
                "foldr (fn (f, x) => f x) n (List.map (curry (op * )) [2, 3])",
                "length [] + n",
            ],
            STRINGS: [
                '#2 (hd (zip ([n], ["z"])))',
                'id "s" ^ #1 (pair "t")',
                'if null [] then "null" else "not"',
            ],
        },
    ),
    "effects in order": (
        """
        globref trail = "";
        fun see s x = (trail := !trail ^ s; x)
        fun reset () = trail := ""
        fun order f g = f () + g ()
        val fs = [fn () => see "p" 1, fn () => see "q" 2]
        """,
        {
            STRINGS: [
                '(reset (); see "a" 1 + see "b" 2; !trail)',
                '(reset (); (see "x" (fn a => see "y" a)) (see "z" n); !trail)',
                '(reset (); let val {b, a} = {b = see "1" 1, a = see "2" 2} in !trail end)',
                '(reset (); (see "1" n = 1 andalso see "2" true) orelse see "3" true; !trail)',
                "(reset (); List.map (fn f => f ()) fs; !trail)",
                "(reset (); order (hd fs) (List.last fs); !trail)",
                '(reset (); [see "i" 1, see "j" 2, see "k" 3]; !trail)',
                '(reset (); (see "1" 1; raise Fail "s"; see "2" 2) handle Fail s => see s 3; !trail)',
                '(reset (); (see "1" 1 div see "0" 0 + see "n" 3) handle Div => see "d" 3; !trail)',
            ]
        },
    ),
    "deep calls": (
        """
        fun count 0 = 0 | count n = 1 + count (n - 1)
        fun build 0 = [] | build n = n :: build (n - 1)
        fun ev 0 = true | ev n = od (n - 1) and od 0 = false | od n = ev (n - 1)
        fun loop (0, acc) = acc | loop (n, acc) = loop (n - 1, acc + 1)
        fun each f [] = () | each f (x :: r) = (f x; each f r)
        fun gcd (a, 0) = a | gcd (a, b) = gcd (b, a mod b)
        """,
        {
            INTS: [
                "count (n * 500)",
                "length (build (n * 500))",
                "if ev (n * 501) then 1 else 0",
                "loop (n * 100000, 0)",
                "let val s = ref 0 in (each (fn x => s := !s + x) (build 300); !s) end",
                "gcd (n * 12, 18)",
            ]
        },
    ),
}


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Workshop:
    if shutil.which("gcc") is None and shutil.which("cc") is None:
        pytest.skip("needs a C compiler")
    return Workshop.open(tmp_path_factory.mktemp("runtime"))


def net_of(declarations: str, expressions: dict[str, list[str]]) -> str:
    """A net whose only transition puts the value of each expression into a place of its own."""
    lines = ["net Cell", "  standard"]
    lines += [
        f"  {line.strip()}" if line.strip().startswith("globref") else f"  {line}"
        for line in _grouped(declarations)
    ]
    lines += ["  var n: INT;", "  place P : INT = 1`1 ++ 1`5 ++ 1`9"]
    number = 0
    arcs = []
    for colset, texts in expressions.items():
        for text in texts:
            number += 1
            lines.append(f"  place R{number} : {colset}")
            arcs.append(f"    out R{number} : 1`({text})")
    return "\n".join([*lines, "  trans T", "    in P : n", *arcs])


def _grouped(declarations: str) -> list[str]:
    """The declarations, each with its continuation lines deeper."""
    out = []
    starts = ("fun ", "val ", "exception ", "datatype ", "globref ", "and ")
    for raw in declarations.strip().splitlines():
        line = raw.strip()
        if line.startswith(starts) and not line.startswith("and "):
            out.append(line)
        else:
            out.append(f"    {line}")
    return out


@pytest.mark.parametrize("name", PROGRAMS)
def test_programs(name: str, workshop: Workshop, tmp_path: Path) -> None:
    net = flat(net_of(*PROGRAMS[name]))
    compiled, d = lowered(net)
    assert compiled is not None, [f"{e.message} ({e.origin.describe()})" for e in d.errors]
    program = workshop.build(compiled, tmp_path)
    for seed in (1, 2):
        assert agrees(net, program, seed=seed, steps=10) == 3
