(fn x => x + 1) 2
map (fn f => f 10) (map (fn x => fn y => x - y) [1, 2])
fun twice f x = f (f x) ==> twice (fn x => x * 3) 7
fun compose f g x = f (g x) ==> compose (fn x => x + 1) (fn x => x * 2) 5
((fn x => x + 1) o (fn x => x * 2)) 5
map (op +) [(1, 2), (3, 4)]
map (op ^) [("a", "b")]
fun curry f x y = f (x, y) fun uncurry f (x, y) = f x y ==> (curry (op +) 1 2, uncurry (fn x => fn y => x - y) (5, 3))
fun add x y = x + y val inc3 = add 3 ==> map inc3 [1, 2]
fun iterate f 0 x = x | iterate f n x = iterate f (n - 1) (f x) ==> iterate (fn x => 2 * x) 10 1
val fs = [fn x => x + 1, fn x => x * 2, fn x => x - 3] ==> map (fn f => f 10) fs
foldr (fn (f, g) => f o g) (fn x => x) [fn x => x + 1, fn x => x * 2] 5
fun flip f x y = f y x ==> flip (fn a => fn b => a - b) 1 10
let fun k x _ = x in k 1 "ignored" end
let val (f, g) = (fn x => x + 1, fn s => s ^ "!") in (f 1, g "a") end
fun fix f x = f (fix f) x ==> fix (fn self => fn 0 => 1 | n => n * self (n - 1)) 6
fun sum f 0 = 0 | sum f n = f n + sum f (n - 1) ==> (sum (fn x => x) 10, sum (fn x => x * x) 4)
fun all p = List.all p ==> all (fn x => x > 0) [1, 2]
map (fn (x, f) => f x) [(1, fn x => x + 1), (2, fn x => x * x)]
List.foldl (fn (c, n) => n * 10 + ord c - ord #"0") 0 (explode "2026")
fun church 0 f x = x | church n f x = f (church (n - 1) f x) ==> church 5 (fn s => "a" ^ s) ""
fun pipe [] x = x | pipe (f :: fs) x = pipe fs (f x) ==> pipe [fn x => x + 1, fn x => x * 10] 4
(if 1 < 2 then (fn x => x + 1) else (fn x => x)) 5
(case 3 of 0 => (fn x => x) | n => (fn x => x + n)) 10
let fun make n = {get = fn () => n, add = fn m => n + m} val r = make 5 in (#get r (), #add r 3) end
List.map (fn f => f ()) (List.tabulate (3, fn i => fn () => i * i))
fun apply (f : int -> int, x) = f x ==> apply (fn y => y * y, 9)
let val rec even = fn 0 => true | n => odd (n - 1) and odd = fn 0 => false | n => even (n - 1) in (even 10, odd 7) end
fun unfold f s = case f s of NONE => [] | SOME (x, s') => x :: unfold f s' ==> unfold (fn n => if n > 5 then NONE else SOME (n * n, n + 1)) 1
fun memo_sum xs = foldl (op +) 0 (map (fn x => let val y = x * x in y + 1 end) xs) ==> memo_sum [1, 2, 3]
