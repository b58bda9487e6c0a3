exception E of int ==> let val e1 = E 1 in (raise e1) handle E n => n end
let exception Stop of int fun go xs = app (fn x => if x < 0 then raise Stop x else ()) xs in (go [1, ~2, 3]; 0) handle Stop x => x end
let val trace = ref "" fun t s x = (trace := !trace ^ s; x) in (t "a" 1 + t "b" 2, [t "c" 3, t "d" 4], {y = t "e" 5, x = t "f" 6}); !trace end
let val trace = ref "" fun t s x = (trace := !trace ^ s; x) in (t "f" (fn x => fn y => x + y)) (t "x" 1) (t "y" 2); !trace end
let val trace = ref "" fun t s x = (trace := !trace ^ s; x) in if t "c" true andalso t "d" false then t "e" 1 else t "g" 2; !trace end
let val trace = ref "" fun t s x = (trace := !trace ^ s; x) in map (fn x => t (Int.toString x) x) [1, 2, 3]; List.app (fn x => (t "." x; ())) [1]; foldr (fn (x, _) => t (Int.toString x) x) 0 [1, 2]; !trace end
let val trace = ref "" fun t s x = (trace := !trace ^ s; x) in (t "r" (ref 0)) := t "v" 5; !trace end
let val trace = ref "" fun t s x = (trace := !trace ^ s; x) in t "a" 1 :: t "b" [2]; !trace end
let val trace = ref [] in (List.tabulate (4, fn i => (trace := i :: !trace; i)); !trace) end
let val trace = ref [] in (List.filter (fn i => (trace := i :: !trace; true)) [1, 2, 3]; !trace) end
let val trace = ref [] in (List.exists (fn i => (trace := i :: !trace; i = 2)) [1, 2, 3]; !trace) end
let val trace = ref [] in (String.map (fn c => (trace := c :: !trace; c)) "abc"; !trace) end
let val trace = ref [] in (ListPair.foldr (fn (a, b, c) => (trace := a :: !trace; c)) 0 ([1, 2], [3, 4]); !trace) end
datatype t = A | B fun f A = 1 | f B = 2 datatype u = A of int ==> case A 5 of A n => n
fun f (x, y) = let val (x, y) = (y, x) in (x, y) end ==> f (1, 2)
let val x = 1 fun f () = x val x = 2 in (f (), x) end
let fun f 0 = "zero" | f n = if n < 0 then "neg" else f' n and f' 1 = "one" | f' _ = "many" in map f [0, 1, 2, ~3] end
fun f [] = "nil" | f (("a", n) :: _) = "a" ^ Int.toString n | f ((s, _) :: rest) = s ^ f rest ==> f [("x", 1), ("a", 2), ("y", 3)]
fun f (x as SOME (y as (a, _))) = (x, y, a) | f NONE = (NONE, (0, ""), 0) ==> f (SOME (1, "q"))
fun depth (xs : int list list) = foldl Int.max 0 (map length xs) ==> depth [[1], [1, 2, 3], []]
let val rec f = fn 0 => [] | n => n :: f (n - 1) in f 3 end
let val f = let val n = ref 0 in fn () => (n := !n + 1; !n) end in (f (), f (), f ()) end
let val id = fn x => x in (id 1, id "a") end
let val pairs = map (fn f => (f 1, f 2)) [fn x => x + 1, fn x => x * 10] in pairs end
(fn {f, g = (h, k)} => f (h k)) {f = fn x => x + 1, g = (fn y => y * 2, 5)}
(fn f => fn g => fn x => g (f x)) (fn x => x + 1) (fn s => Int.toString s ^ "!") 4
let fun compose fs = foldl (fn (f, g) => f o g) (fn x => x) fs in compose [fn x => x + 1, fn x => x * 2, fn x => x - 3] 10 end
let datatype 'a seq = Nil | Cons of 'a * (unit -> 'a seq) fun from n = Cons (n, fn () => from (n + 1)) fun take (0, _) = [] | take (_, Nil) = [] | take (n, Cons (x, r)) = x :: take (n - 1, r ()) fun filter p Nil = Nil | filter p (Cons (x, r)) = if p x then Cons (x, fn () => filter p (r ())) else filter p (r ()) in take (5, filter (fn x => x mod 3 = 0) (from 1)) end
let datatype t = T of {get : unit -> int, set : int -> unit} fun cell n = let val r = ref n in T {get = fn () => !r, set = fn m => r := m} end val T c = cell 1 in #set c 7; #get c () end
let fun cps_fact (0, k) = k 1 | cps_fact (n, k) = cps_fact (n - 1, fn r => k (n * r)) in cps_fact (8, fn x => x + 1) end
let fun fold_tree f e = fn NONE => e | SOME (l, x, r) => f (l, x, r) in fold_tree (fn (a, b, c) => a + b + c) 0 (SOME (1, 2, 3)) end
let fun walk (f, []) = () | walk (f, x :: xs) = (f x; walk (f, xs)) val s = ref 0 in walk (fn x => s := !s + x, [1, 2, 3]); !s end
let val i = ref 0 val out = ref [] in while !i < 5 do (out := !i * !i :: !out; i := !i + 1); rev (!out) end
let val i = ref 10 in while (i := !i - 3; !i > 0) do (); !i end
let fun f n = (if n > 3 then raise Fail (Int.toString n) else n) handle Fail s => f (n - 1) + String.size s in f 6 end
let fun f x = (g x handle Div => ~1) and g x = 100 div x in (f 5, f 0) end
(let val x = hd [] in x : int end) handle Empty => 3
let val f = fn x => (fn y => x div y) in (f 1 0) handle Div => 9 end
let val y = (fn x => x div 0) 1 handle Div => 4 in y + 1 end
(case (raise Fail "a") : int of 1 => 1 | _ => 2) handle Fail s => 5
((fn () => raise Fail "thunk") () : int) handle Fail s => String.size s
(raise (if 1 < 2 then Fail "x" else Empty)) handle Empty => 1 | Fail _ => 2
let exception A of int exception B in map (fn f => (f () handle A n => n | B => 0 | _ => ~1)) [fn () => raise A 4, fn () => raise B, fn () => raise Div, fn () => 7] end
case (1, 2, 3) of (a, b, c) => if a > b then "x" else if b > c then "y" else "z"
case "x" of "a" => 1 | x => String.size x
case [(1, "a"), (2, "b")] of [(_, s), (n, _)] => s ^ Int.toString n | _ => ""
case {x = [1, 2], y = SOME "s"} of {x = a :: _, y = SOME s} => (a, s) | {x, y} => (0, "")
case ref 5 of r => !r + 1
case (fn x => x + 1) of f => f 1
(case 1.5 > 1.0 of true => "gt" | false => "le")
length [(), (), ()]
((), ((), ()))
[[], [[]], [[], []]] = [[], [[]], [[], [] : int list]]
(1, "a", [SOME 2, NONE]) = (1, "a", [SOME 2, NONE])
SOME [1] <> NONE
{a = 1, b = [2]} = {b = [2], a = 1}
let val r = ref 1 val s = r in (r = s, r = ref 1, !r = !s) end
let val a = [1, 2] val b = 1 :: [2] in a = b end
fun ++++ (a, b) = a * 10 + b infix 5 ++++ ==> 1 ++++ 2 ++++ 3
infixr 5 @@@ fun a @@@ b = a ^ "(" ^ b ^ ")" ==> "x" @@@ "y" @@@ "z"
let val op ^ = fn (a, b) => String.concat [b, a] in "a" ^ "b" end
let val (op +, op -) = (op -, op +) in (5 + 3, 5 - 3) end
let fun size_of (x : string) = String.size x in size_of "four" end
let fun f (x : int, y : real) = real x + y in f (1, 2.5) end
let val (f : int -> int -> int) = fn a => fn b => a - b in f 5 2 end
let val ((a, b), c) = ((1, 2), 3) and [d, e] = [4, 5] in a + b + c + d + e end
let type 'a pair = 'a * 'a fun sum ((a, b) : int pair) = a + b in sum (3, 4) end
let fun pow x 0 = 1 | pow x n = let val h = pow x (n div 2) in if n mod 2 = 0 then h * h else x * h * h end in (pow 3 13, pow 2 10) end
let fun count p = foldl (fn (x, n) => if p x then n + 1 else n) 0 in (count (fn x => x > 1) [1, 2, 3], count Char.isAlpha (explode "a1b")) end
let fun mapi f xs = let fun go (_, []) = [] | go (i, x :: r) = f (i, x) :: go (i + 1, r) in go (0, xs) end in mapi (fn (i, s) => s ^ Int.toString i) ["a", "b"] end
let fun partition3 (p, xs) = foldr (fn (x, (l, e, g)) => case Int.compare (x, p) of LESS => (x :: l, e, g) | EQUAL => (l, x :: e, g) | GREATER => (l, e, x :: g)) ([], [], []) xs in partition3 (3, [5, 3, 1, 4, 3, 2]) end
let fun last [x] = x | last (_ :: xs) = last xs | last [] = raise Empty in (last [1, 2, 3], last ["z"]) end
let fun interleave x [] = [[x]] | interleave x (y :: ys) = (x :: y :: ys) :: map (fn zs => y :: zs) (interleave x ys) in interleave 0 [1, 2] end
let fun nub [] = [] | nub (x :: xs) = x :: nub (List.filter (fn y => y <> x) xs) in nub [1, 2, 1, 3, 2] end
let fun zipWith3 f (a :: b, c :: d, e :: g) = f (a, c, e) :: zipWith3 f (b, d, g) | zipWith3 _ _ = [] in zipWith3 (fn (a, b, c) => a + b * c) ([1, 2], [3, 4], [5, 6]) end
fun loop i acc = if i > 5000 then acc else loop (i + 1) (acc + i mod 7) ==> loop 0 0
fun build 0 = [] | build n = n :: build (n - 1) ==> length (build 5000)
fun sum [] = 0 | sum (x :: xs) = x + sum xs ==> sum (List.tabulate (3000, fn i => i))
abstype counter = C of int with fun new () = C 0 fun tick (C n) = C (n + 1) fun read (C n) = n end ==> read (tick (tick (new ())))
structure P = struct fun f x = x + 1 structure Q = struct fun g x = f x * 2 end end open P ==> (f 1, Q.g 1)
