let val x = 1 val x = x + 1 val x = x * 10 in x end
let val x = 1 in let val x = 2 in x end + x end
let fun f x = x + 1 fun f x = f' x and f' x = x * 2 in f 5 end
let val a = 1 and b = 2 in let val a = b and b = a in (a, b) end end
local val secret = 42 in fun reveal () = secret end ==> reveal ()
local fun helper n = n * 2 in fun double n = helper n fun quad n = helper (helper n) end ==> (double 3, quad 3)
let val x = 5 fun f y = x + y val x = 100 in f 1 end
let fun f x = let val y = x * 2 fun g z = y + z in g 1 end in f 10 end
let in 5 end
let val _ = 3 in 4 end
let val () = () in "unit" end
let val x : int = 3 val f : int -> int = fn y => y + x in f 4 end
let val (x, [y, z], {a, b = _}) = (1, [2, 3], {a = 4, b = 5}) in x + y + z + a end
let infix 6 plus fun a plus b = a + b * 10 in 1 plus 2 plus 3 end
let infixr 5 ++> fun x ++> xs = x :: xs in 1 ++> 2 ++> [] end
let infix 4 isin fun x isin xs = List.exists (fn y => y = x) xs in (3 isin [1, 2, 3], 9 isin []) end
let infix 7 ^^^ fun x ^^^ 0 = 1 | x ^^^ n = x * (x ^^^ (n - 1)) in 2 ^^^ 10 + 1 end
let fun op +++++ (a, b) = a - b infix +++++ in 10 +++++ 3 end
let nonfix div in div (7, 2) end
let val op + = fn (a, b) => a * b : int in 3 + 4 end
structure Counter = struct val start = 5 fun next n = n + 1 end ==> Counter.next Counter.start
structure A = struct val x = 1 structure B = struct val y = 2 end end ==> A.x + A.B.y
structure S = struct datatype t = P of int | Q fun value (P n) = n | value Q = 0 end ==> S.value (S.P 3) + S.value S.Q
structure M = struct exception Bad of string fun f 0 = raise Bad "zero" | f n = n end ==> (M.f 0 handle M.Bad s => String.size s)
let open List in (length [1], nth ([1, 2], 1)) end
structure T = struct val a = 1 val b = 2 end open T ==> a + b
let type t = int * string val x : t = (1, "a") in #2 x end
let val f = fn 0 => "zero" | 1 => "one" | _ => "many" in map f [0, 1, 2] end
let val x = 3 in if x > 2 then if x > 5 then "big" else "middle" else "small" end
let val xs = [1, 2, 3] val n = length xs in (n, hd xs, List.last xs) end
