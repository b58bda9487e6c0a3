"""Programs of CPN ML for compiled nets: declarations, and expressions over `n` by the colour set of their values."""

from __future__ import annotations

import textwrap

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
        datatype tree = Leaf | Knot of tree * int * tree
        fun build 0 = Leaf | build n = Knot (build (n - 1), n, build (n - 2 + (if n < 2 then 1 else 0)))
        fun sum Leaf k = k 0 | sum (Knot (l, x, r)) k = sum l (fn a => sum r (fn b => k (a + x + b)))
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
        val every = [A, B 3, Div, Fail "f", B 4]
        fun weight A = 1 | weight (B n) = n | weight (Fail s) = String.size s | weight _ = 100
        val last = ref (NONE : exn option)
        fun tried f = f () handle e => (last := SOME e; 0)
        fun how NONE = "none" | how (SOME (B n)) = Int.toString n | how (SOME e) = exnName e
        exception Wrap of exn
        fun unwrap (Wrap e) = unwrap e | unwrap e = e
        """,
        {
            INTS: [
                "foldl (op +) 0 (List.map weight every)",
                "tried (fn () => if n > 5 then raise B n else if n > 2 then 1 div 0 else n)",
                "weight (unwrap (Wrap (Wrap (B n))))",
                "(raise Wrap (B n)) handle Wrap (B k) => k | Wrap _ => 0",
                "(raise List.nth (every, n mod 5)) handle B k => k | Fail _ => 7 | Div => 8 | A => 9",
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
        datatype 'a tree = Leaf | Knot of 'a tree * 'a * 'a tree
        fun insert less (x, Leaf) = Knot (Leaf, x, Leaf)
          | insert less (x, t as Knot (l, y, r)) =
              if less (x, y) then Knot (insert less (x, l), y, r)
              else if less (y, x) then Knot (l, y, insert less (x, r)) else t
        fun flat Leaf = [] | flat (Knot (l, x, r)) = flat l ^^ (x :: flat r)
        fun fold f z Leaf = z | fold f z (Knot (l, x, r)) = fold f (f (x, fold f z l)) r
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
                "loop (if n = 3 then 100000 else n, 0)",
                "let val s = ref 0 in (each (fn x => s := !s + x) (build 300); !s) end",
                "gcd (n * 12, 18)",
            ]
        },
    ),
    "functions of many kinds": (
        """
        datatype 'a box = Box of 'a | Two of 'a * 'a
        exception B of int
        fun app0 f = f ()
        val units = [fn () => 1, fn () => 2]
        val makers = [Box, fn x => Two (x, x)]
        val folds = [foldl (op +) 0, foldr (op -) 0, length]
        val ops = [("plus", op +), ("minus", op -), ("times", op * )]
        val maps = [List.map (fn x => x + 1), List.filter (fn x => x > 2), rev]
        fun find k = case List.find (fn (s, _) => s = k) ops of SOME (_, f) => f | NONE => (fn (a, b) => a)
        fun tags (Box x) = x | tags (Two (x, y)) = x + y
        val conses = [op ::, fn (x, l) => l ^^ [x]]
        val showers = [INT.mkstr, Int.toString, fn x => "<" ^ Int.toString x ^ ">"]
        val exns = List.map B [1, 2, 3]
        fun nested (f, {g, h = (k, l)}) x = f (g (k (l x)))
        val unitary = [print, fn s => ()]
        """,
        {
            INTS: [
                "foldl (fn (f, s) => s + f ()) 0 units",
                "foldl (fn (f, s) => s + tags (f n)) 0 makers",
                "foldl (fn (f, s) => s * 10 + f [1, n, 3]) 0 folds",
                'find "minus" (n, 3) + find "times" (n, 3) + find "x" (n, 1)',
                "length (foldl (fn (f, l) => f l) [1, n, 3, 2] maps)",
                "hd (foldl (fn (f, l) => f (n, l)) [7] conses) + length (List.map (fn f => f (n, [])) conses)",
                "foldl (fn (B k, s) => s + k | (_, s) => s) 0 exns",
                "nested (fn x => x + 1, {g = ~, h = (fn x => x * n, fn x => x - 1)}) 4",
                '(List.app (fn f => f "") unitary; n)',
                "app0 (fn () => n) + app0 (hd units)",
            ],
            STRINGS: [
                "String.concat (List.map (fn f => f n) showers)",
            ],
        },
    ),
    "colours": (
        """
        colset COL = with red | green | blue
        colset PAIR = product INT * COL
        colset REC = record a: INT * b: COL
        colset LST = list PAIR
        colset UNI = union num: INT + col: COL + non
        fun flip red = green | flip green = blue | flip blue = red
        val flips = [flip, flip o flip, fn c => c]
        fun total (num n) = n | total (col c) = COL.ord c | total non = ~1
        val pick = {a = fn (n, c) => n, b = fn (n, c : COL) => COL.ord c}
        fun update f {a, b} = {a = f a, b = b} : REC
        val updates = [update (fn x => x + 1), fn r => REC.set_b r blue]
        """,
        {
            INTS: [
                "COL.ord (foldl (fn (f, c) => f c) red flips)",
                "foldl (fn (u, s) => s + total u) 0 [num n, col green, non]",
                "#a pick (n, red) + #b pick (n, blue)",
                "#a (foldl (fn (f, r) => f r) {a = n, b = red} updates)",
            ],
            STRINGS: [
                "COL.mkstr (#b (foldl (fn (f, r) => f r) {a = n, b = red} updates))",
                "LST.mkstr (List.map (fn c => (n, c)) (COL.all ()))",
            ],
        },
    ),
    "more references": (
        """
        val grid = List.tabulate (3, fn i => List.tabulate (3, fn j => ref (i * 3 + j)))
        fun at (i, j) = List.nth (List.nth (grid, i), j)
        fun f (ref x) = x
        fun memo g = let val known = ref [] in fn x => case List.find (fn (y, _) => y = x) (!known) of
            SOME (_, v) => v | NONE => let val v = g x in (known := (x, v) :: !known; v) end end
        val calls = ref 0
        val slow = memo (fn x => (calls := !calls + 1; x * x))
        val self = ref (fn (x : int) => x)
        fun fact n = if n = 0 then 1 else n * (!self) (n - 1)
        datatype 'a cell = Empty | Cell of {value: 'a, next: 'a cell ref}
        fun push r x = r := Cell {value = x, next = ref (!r)}
        fun every r = case !r of Empty => [] | Cell {value, next} => value :: every next
        val names = ref ["a"]
        val point = ref {x = 1, y = 2.5}
        val pp = ref (ref 3)
        fun swap (a as ref x, b as ref y) = (a := y; b := x)
        """,
        {
            INTS: [
                "(at (1, 1) := n; !(at (1, 1)) + !(at (2, 2)))",
                "f (ref n)",
                "slow n + slow n + !calls",
                "(self := fact; (!self) (n mod 7))",
                "let val r = ref Empty in (push r n; push r 2; List.app (push r) [3, 4]; foldl (op +) 0 (every r)) end",
                "(point := {x = n + #x (!point), y = 1.0}; #x (!point))",
                "(!pp := n + !(!pp); pp := ref (!(!pp) + 1); !(!pp))",
                "let val a = ref n val b = ref 2 in (swap (a, b); !a * 10 + !b) end",
                "(inc calls; dec calls; calls += 2; calls -= 1; !calls)",
                "let val r = ref [n] in (r ::= 4; length (!r)) end",
            ],
            STRINGS: [
                "(names := !names ^^ [Int.toString n]; String.concat (!names))",
            ],
        },
    ),
    "patterns": (
        """
        fun kind "a" = 1 | kind "bc" = 2 | kind s = String.size s
        fun chars [] = 0 | chars (#"x" :: r) = 1 + chars r | chars (_ :: r) = chars r
        fun deep ((a, SOME b) :: (c, NONE) :: _, {k, ...} : {k: int, l: int}) = a + b + c + k
          | deep ([(a, NONE)], _) = a
          | deep (l as _ :: _, {l = k, ...}) = length l * k
          | deep ([], {k, l}) = k - l
        fun both (x as (a, b), y as [_, _]) = a + b + length y + #1 x | both ((a, _), l) = a - length l
        fun bools (true, false) = 1 | bools (false, _) = 2 | bools _ = 3
        fun curried 0 _ [] = 1 | curried n s (x :: r) = n + x + curried (n - 1) s r | curried n s [] = String.size s
        fun ors x = case x of (1 | 2) => 10 | (3 | 5) => 20 | _ => 30
        """,
        {
            INTS: [
                'kind (if n > 4 then "bc" else "a") + kind "xyz"',
                'chars (explode "axbxx")',
                "deep ([(n, SOME 1), (2, NONE)], {k = 3, l = 4})",
                "deep ([(n, NONE)], {k = 3, l = 4})",
                "deep ([(n, SOME 1), (2, SOME 3)], {k = 3, l = 4}) + deep ([], {k = n, l = 1})",
                "both ((n, 2), [1, 2]) + both ((n, 2), [1])",
                "bools (n > 3, n > 6)",
                'curried (n mod 3) "abc" [1, 2]',
                'curried 5 "abc" [1, n]',
            ],
        },
    ),
    "closures over closures": (
        """
        fun const x _ = x
        fun pipe fs = fn x => foldl (fn (f, y) => f y) x fs
        fun tower 0 = [] | tower n = let val rest = tower (n - 1) in (fn x => x + n) :: (pipe rest) :: rest end
        fun choose p f g = fn x => if p x then f x else g x
        val classify = choose (fn x => x > 5) (fn x => "big " ^ Int.toString x) (choose
            (fn x => x > 2) (const "mid") (fn _ => "small"))
        fun fix f x = f (fix f) x
        datatype 'a rec_fn = R of 'a rec_fn -> 'a
        fun y f = let fun g (R h) = f (fn a => h (R h) a) in g (R (fn (R h) => f (fn a => h (R h) a))) end
        fun parser s = let val pos = ref 0 val text = explode s fun peek () = if !pos < length text then
            SOME (List.nth (text, !pos)) else NONE fun next () = (pos := !pos + 1) fun num acc = case peek ()
            of SOME c => if Char.isDigit c then (next (); num (acc * 10 + ord c - 48)) else acc | NONE => acc
            fun term () = (case peek () of SOME #"(" => (next (); let val v = sum () in (next (); v) end)
            | _ => num 0) and prod () = let fun more v = case peek () of
            SOME #"*" => (next (); more (v * term ())) | _ => v in more (term ()) end and sum () = let
            fun more v = case peek () of SOME #"+" => (next (); more (v + prod ())) |
            SOME #"-" => (next (); more (v - prod ())) | _ => v in more (prod ()) end in sum () end
        fun state f = fn s => let val (a, s') = f s in (a, s' + 1) end
        fun bind m k s = let val (a, s') = m s in k a s' end
        fun return x s = (x, s)
        fun count 0 = return 0 | count n = bind (state (fn s => (s, s))) (fn a => bind (count (n - 1))
            (fn b => return (a + b)))
        """,
        {
            INTS: [
                "pipe (tower 3) n",
                "fix (fn f => fn 0 => 1 | k => k * f (k - 1)) n",
                "y (fn f => fn 0 => 1 | k => k * f (k - 1)) (n mod 6)",
                'parser ("2*(3+" ^ Int.toString n ^ ")-4*5+1")',
                "#1 (count n 10) + #2 (count 3 n)",
                "(const n o const 3) 4",
            ],
            STRINGS: [
                "classify n",
            ],
        },
    ),
    "modules": (
        """
        structure S = struct val base = 10 fun f x = x + base exception Bad of int val fs = [f,
            fn x => x * 2] structure T = struct fun g x = f (f x) end end
        functor Sort (O : sig type t val less : t * t -> bool end) = struct fun insert (x, []) = [x]
            | insert (x, y :: r) = if O.less (x, y) then x :: y :: r else y :: insert (x, r)
            fun sort l = foldl insert [] l end
        structure IntSort = Sort (struct type t = int val less = op < end)
        structure Back = Sort (struct type t = int fun less (a, b) = a > b end)
        local val hidden = ref 3 in fun peek () = !hidden fun poke x = hidden := x end
        abstype counter = C of int with fun make n = C n fun up (C n) = C (n + 1) fun value (C n) = n end
        """,
        {
            INTS: [
                "S.T.g n + hd S.fs n",
                "hd (IntSort.sort [3, n, 2]) + hd (Back.sort [3, n, 2])",
                "(poke (n + peek ()); peek ())",
                "value (up (up (make n)))",
                "(raise S.Bad n) handle S.Bad k => k + 1",
            ],
        },
    ),
    "after errors": (
        """
        datatype tree = Knot of tree * int * tree | Leaf
        datatype t = T of t option
        datatype u = U of v and v = V of u * int | W
        datatype box = Box of {f: int -> int, r: int ref, l: int list, s: string}
        fun bad s = if s = "" then Leaf else raise Fail s
        fun badt s = if s = "" then T NONE else raise Fail s
        fun badu s = if s = "" then U W else raise Fail s
        fun badbox s = if s = "" then Box {f = ~, r = ref 1, l = [], s = ""} else raise Fail s
        fun badfn s = if s = "" then ~ else raise Fail s
        fun badref s = if s = "" then ref 1 else raise Fail s
        fun badlist s = if s = "" then [1] else raise Fail s
        fun badopt s = if s = "" then SOME (fn x => x + 1) else raise Fail s
        fun top t = case t of Leaf => 0 | Knot (l, x, r) => x
        exception E of int * string
        """,
        {
            INTS: [
                '(case bad "x" of Leaf => 0 | Knot (l, x, r) => x) handle Fail s => String.size s',
                '(case badt "x" of T NONE => 1 | T (SOME (T y)) => 2) handle Fail s => 7',
                '(case badt "x" of T x => (case x of SOME (T y) => 3 | NONE => 4)) handle Fail s => 7',
                '(case badu "x" of U (V (U z, n)) => n | U W => 0) handle Fail _ => 8',
                '(case badbox "x" of Box {f, r, l, s} => (r := 5; f (!r) + hd l + String.size (s ^ s '
                '^ "x"))) handle Fail _ => 9',
                '(badfn "x" 3 + (badfn "yy") 4) handle Fail s => String.size s',
                '(!(badref "x") + (badref "y" := 3; 4)) handle Fail s => String.size s',
                '(hd (badlist "x") + length (tl (badlist "y"))) handle Fail s => String.size s | Empty => 100',
                '((valOf (badopt "x")) n) handle Fail s => 5',
                'top (bad "abc") handle Fail s => String.size s',
                'top (Knot (bad "", n, bad "zz")) handle Fail s => String.size s',
                '(raise E (1 div 0, "x")) handle Div => 3 | E (k, s) => k',
                "(List.nth ([1, 2], n) + (1 div 0)) handle Div => 1 | Subscript => 2",
                "((fn SOME x => x) (List.find (fn x => x > n) [6, 2])) handle Match => ~1 | Option => ~2",
                'foldl (fn (x, s) => if x > 2 then raise E (s, "f") else s + x) 0 [1, 2, 3, 4] handle E (k, _) => k',
                "length (List.map (fn x => (10 div (x - 1)) handle Div => 0) [1, 2, n])",
                'hd (List.map (fn x => if x = n then raise E (x, "m") else x) [1, 5, 9]) handle E (k, s) => k * 100',
            ],
            STRINGS: [
                '(substring ("abc", n, 1)) handle Subscript => "sub" | e => exnName e',
                '(str (chr (n * 100))) handle Chr => "chr" | e => exnName e',
                '(Int.toString (valOf NONE)) handle Option => "opt"',
                '(let val (x :: _) = List.filter (fn k => k > n) [4] in Int.toString x end) handle Bind => "bind"',
                '(case n of 1 => "one" | 5 => "five") handle Match => "match"',
            ],
        },
    ),
    "units": (
        """
        val u = ()
        val us = [(), (), ()]
        val r = ref ()
        fun f () = ()
        fun g (x, ()) = x
        val log = ref 0
        fun tick () = log := !log + 1
        val acts = [tick, fn () => (), fn () => tick ()]
        fun seq [] = () | seq (a :: rest) = (a (); seq rest)
        datatype d = D of unit | E of unit * int
        fun h (D ()) = 1 | h (E ((), n)) = n
        val o1 = SOME ()
        fun ignoreit (_ : int) = ()
        val ifun = [fn (x : int) => (), ignoreit]
        exception X of unit
        """,
        {
            INTS: [
                "length us + (f (); n)",
                "g (n, f ())",
                "(seq acts; !log)",
                "h (D ()) + h (E (u, n))",
                "(case o1 of SOME () => n | NONE => 0)",
                "(r := f (); !r; n)",
                "(List.app (fn a => a n) ifun; n)",
                "(raise X ()) handle X () => n",
                "length (List.map (fn () => 1) us)",
                "foldl (fn ((), s) => s + 1) n us",
                "(if u = () andalso us = [(), (), ()] then 1 else 0)",
                "(let val () = tick () val _ = tick () in !log end)",
                "(while !log > 0 do log := !log - 1; !log)",
            ],
        },
    ),
    "equality": (
        """
        datatype s = A | B of int * string | C of s list
        datatype node = N of int * node ref | Z
        fun member eq (x, []) = false | member eq (x, y :: r) = eq (x, y) orelse member eq (x, r)
        fun count x l = length (List.filter (fn y => y = x) l)
        fun same (a : ''a, b) = if a = b then 1 else 0
        fun assoc (x, []) = NONE | assoc (x, (y, v) :: r) = if x = y then SOME v else assoc (x, r)
        val r1 = ref Z
        """,
        {
            INTS: [
                'if member (op =) ((n, "a"), [(1, "a"), (5, "b")]) then 1 else 0',
                'count (B (n, "x")) [A, B (5, "x"), B (5, "y"), C [A]]',
                'same ([SOME n], [SOME 5]) + same (C [B (n, "")], C [B (n, "")])',
                'same (#"a", #"b") + same ("x", "x") + same ({a = n, b = true}, {a = 1, b = true})',
                "(case assoc ([n], [([1], 10), ([5], 50)]) of SOME v => v | NONE => 0)",
                "let val a = N (n, r1) val b = N (n, r1) val c = N (n, ref Z) in same (a, b) * 10 + same (a, c) end",
                "if (op <>) (n, 5) then 1 else 2",
                "let val f = op = in if f (n, 1) then 1 else 0 end",
                "let val eqs = [op =, op <>, fn (a : int, b) => a > b] in length (List.filter (fn f "
                "=> f (n, 5)) eqs) end",
            ],
        },
    ),
    "local functions": (
        """
        fun outer n = let fun inner 0 = n | inner k = inner (k - 1) + helper k and helper k = if k > n then
            inner (k - n) else k in inner (n + 2) end
        fun count p l = let fun go ([], c) = c | go (x :: r, c) = go (r, if p x then c + 1 else c) in go (l, 0) end
        fun sort less l = let fun ins (x, []) = [x] | ins (x, y :: r) = if less (x, y) then x :: y :: r else
            y :: ins (x, r) in foldr ins [] l end
        fun poly x = let fun dup y = (y, y) val (a, b) = dup x val (c, d) = dup "s" in (a, c) end
        fun shadow x = let val x = x + 1 val x = x * 2 fun f x = x + 1 in f x end
        fun mutual n = let val total = ref 0 fun down 0 = () | down k = (total := !total + k; up (k - 1))
            and up 0 = () | up k = (total := !total * 2; down (k - 1)) in (down n; !total) end
        fun curry3 a = let val b = a + 1 in fn c => let val d = b + c in fn e => d * e end end
        fun build n = let fun mk 0 = [] | mk k = (fn x => x + k * n) :: mk (k - 1) in mk 3 end
        val partial = curry3 1
        val partial2 = partial 2
        fun gen () = let val c = ref 0 in (fn () => (c := !c + 1; !c), fn () => c := 0) end
        val (next, reset) = gen ()
        fun vararg x = let fun more acc 0 = acc | more acc y = more (acc + y) (y - 1) in more 0 x end
        infix 6 plus
        fun a plus b = a + b
        infixr 5 ---
        fun x --- y = x - y
        """,
        {
            INTS: [
                "outer (n mod 4 + 1)",
                "count (fn x => x > n) [1, 5, 7, 9]",
                "hd (sort (op >) [3, n, 2])",
                "#1 (poly n) + String.size (#2 (poly 1))",
                "shadow n",
                "mutual n",
                "curry3 n 2 3 + partial2 n + partial n 1",
                "foldl (fn (f, x) => f x) 0 (build n)",
                "next () + next ()",
                "(reset (); next ())",
                "vararg n",
                "(n plus 2 --- 3 --- 1)",
            ],
        },
    ),
    "interpreter": (
        """
        datatype term = Lam of string * term | App of term * term | Id of string | Int of int | Prim of
            string * term list | Cond of term * term * term | Fix of string * term
        datatype value = VInt of int | VFun of value -> value | VErr of string
        exception Type of string * value
        fun get x env = case env x of SOME v => v | NONE => raise Type ("unbound " ^ x, VErr x)
        fun extend env x v = fn y => if x = y then SOME v else env y
        fun num (VInt n) = n | num v = raise Type ("not an int", v)
        fun prim "+" [VInt a, VInt b] = VInt (a + b) | prim "*" [VInt a, VInt b] = VInt (a * b) | prim "-"
            [VInt a, VInt b] = VInt (a - b) | prim p (v :: _) = raise Type (p, v) | prim p [] = VErr p
        fun ev env (Int n) = VInt n
          | ev env (Id x) = get x env
          | ev env (Lam (x, b)) = VFun (fn v => ev (extend env x v) b)
          | ev env (App (f, a)) = (case ev env f of VFun g => g (ev env a) | v => raise Type ("not a function", v))
          | ev env (Prim (p, l)) = prim p (List.map (ev env) l)
          | ev env (Cond (c, a, b)) = if num (ev env c) <> 0 then ev env a else ev env b
          | ev env (Fix (f, b)) = let val r = ref (VErr f) val v = ev (fn y => if y = f then SOME (!r) else
              env y) b in (r := v; v) end
        fun empty_env (x : string) = NONE : value option
        fun run t = num (ev empty_env t) handle Type (s, VInt k) => k * 1000 | Type (s, _) => ~ (String.size s)
        fun fact n = App (Fix ("f", Lam ("n", Cond (Id "n", Prim ("*", [Id "n", App (Id "f", Prim ("-", [Id
            "n", Int 1]))]), Int 1))), Int n)
        """,
        {
            INTS: [
                "run (fact (n mod 7))",
                'run (App (Lam ("x", Prim ("+", [Id "x", Id "x"])), Int n))',
                "run (App (Int n, Int 1))",
                'run (Id "zz")',
                'run (Prim ("+", [Int n]))',
                'run (App (App (Lam ("f", Lam ("x", App (Id "f", App (Id "f", Id "x")))), Lam ("y", Prim '
                '("*", [Id "y", Int 3]))), Int n))',
            ],
        },
    ),
    "queues and heaps": (
        """
        datatype 'a heap = E | T of int * 'a * 'a heap * 'a heap
        fun rank E = 0 | rank (T (r, _, _, _)) = r
        fun mk (x, a, b) = if rank a >= rank b then T (rank b + 1, x, a, b) else T (rank a + 1, x, b, a)
        fun merge le (h, E) = h | merge le (E, h) = h
          | merge le (h1 as T (_, x, a1, b1), h2 as T (_, y, a2, b2)) = if le (x, y) then mk (x, a1, merge
              le (b1, h2)) else mk (y, a2, merge le (h1, b2))
        fun ins le (x, h) = merge le (T (1, x, E, E), h)
        fun drain le E = [] | drain le (T (_, x, a, b)) = x :: drain le (merge le (a, b))
        type 'a queue = 'a list * 'a list
        val emptyq = ([], []) : int queue
        fun enq (x, (f, r)) = (f, x :: r) : int queue
        fun deq (([], []) : int queue) = NONE | deq ([], r) = deq (rev r, []) | deq (x :: f, r) = SOME (x, (f, r))
        fun bfs (next : int -> int list) start goal =
          let fun go (q, seen, k) = if k > 200 then ~1 else case deq q of NONE => ~2 | SOME (x, q') =>
                if x = goal then k else let val new = List.filter (fn y => not (List.exists (fn z => z = y)
                    seen)) (next x) in go (foldl enq q' new, new ^^ seen, k + 1) end
          in go (enq (start, emptyq), [start], 0) end
        fun dijkstra edges s = let val dist = ref [(s, 0)] val work = ref [(0, s)]
            fun best v = case List.find (fn (u, _) => u = v) (!dist) of SOME (_, d) => SOME d | NONE => NONE
            fun relax (v, d) = case best v of SOME d' => if d < d' then (dist := (v, d) :: List.filter (fn
                (u, _) => u <> v) (!dist); work := (d, v) :: !work) else () | NONE => (dist := (v, d) :: !dist;
                work := (d, v) :: !work)
          in (while not (null (!work)) do let val (d, v) = hd (!work) in (work := tl (!work); List.app (fn
              (a, b, c) => if a = v then relax (b, d + c) else ()) edges) end; fn v => best v) end
        val net = [(1, 2, 7), (1, 3, 9), (1, 6, 14), (2, 3, 10), (2, 4, 15), (3, 4, 11), (3, 6, 2), (4, 5,
            6), (6, 5, 9)]
        """,
        {
            INTS: [
                "hd (drain (op <=) (foldl (ins (op <=)) E [7, n, 3, 8]))",
                "length (drain (op >=) (foldl (ins (op >=)) E [7, n, 3, 8]))",
                "bfs (fn x => [x + 3, x * 2]) 1 (n + 7)",
                "case dijkstra net 1 (n mod 6 + 1) of SOME d => d | NONE => ~1",
            ],
            STRINGS: [
                "String.concat (List.map (fn (a, s) => s) (drain (fn ((a, _), (b, _)) => a <= b) (foldl "
                '(ins (fn ((a : int, _ : string), (b, _)) => a <= b)) E [(n, "n"), (3, "c"), (7, "g")])))',
            ],
        },
    ),
    "state machines": (
        """
        datatype event = Key of char | Tick of int | Quit
        datatype state = State of {name: string, step: event -> state, out: int}
        fun idle n = State {name = "idle", out = n, step = fn Key #"s" => running (n, 0) | Quit => stopped n
            | _ => idle n}
        and running (n, t) = State {name = "run", out = t, step = fn Tick k => if t + k > 10 then idle (n +
            t + k) else running (n, t + k) | Key c => running (n + ord c mod 3, t) | Quit => stopped (n * 100 +
            t)}
        and stopped n = State {name = "stop", out = n, step = fn _ => stopped n}
        fun play (s, []) = s | play (State {step, ...}, e :: r) = play (step e, r)
        fun show (State {name, out, ...}) = name ^ Int.toString out
        val handlers = ref ([] : (string * (int -> int option)) list)
        fun on name f = handlers := (name, f) :: !handlers
        fun fire name x = let fun go [] = NONE | go ((n, f) :: r) = if n = name then (case f x of NONE => go
            r | some => some) else go r in go (!handlers) end
        val _ = on "a" (fn x => if x > 3 then SOME (x * 2) else NONE)
        val _ = on "b" (fn x => SOME (x + 1))
        val _ = on "a" (fn x => if x > 8 then SOME 0 else NONE)
        fun getopt (SOME x) = x | getopt NONE = ~1
        """,
        {
            STRINGS: [
                'show (play (idle n, [Tick 1, Key #"s", Tick n, Tick 4, Key #"x", Tick 3, Quit, Tick 9]))',
                'show (play (idle n, List.tabulate (n, fn i => if i mod 3 = 0 then Key #"s" else Tick i)))',
            ],
            INTS: [
                'getopt (fire "a" n) * 100 + getopt (fire "b" n) + getopt (fire "c" n)',
            ],
        },
    ),
}


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
    starts = (
        "fun ", "val ", "exception ", "datatype ", "globref ", "colset ", "structure ", "signature ", "functor ",
        "local ", "abstype ", "infix ", "infixr ", "type ",
    )  # fmt: skip
    for line in textwrap.dedent(declarations).strip("\n").rstrip().splitlines():
        if line.startswith(starts):
            out.append(f"{line};" if line.startswith("colset ") else line)
        else:
            out.append(f"    {line}")
    return out
