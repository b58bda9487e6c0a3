1 div 0 handle Div => 7
hd [] handle Empty => "none"
(raise Fail "x") : int
(raise Fail "boom") handle Fail s => s
exception E ==> (raise E) handle E => 3
exception E of int ==> (raise E 5) handle E n => n + 1
exception E of int * string ==> (raise E (1, "a")) handle E (n, s) => s ^ Int.toString n
exception A exception B ==> ((raise A) handle B => 1) handle A => 2
(1 div 0 handle Overflow => 1) handle Div => 2
(hd [] handle Div => 1 | Empty => 2)
((raise Fail "a") handle Fail "b" => 1 | Fail _ => 2)
fun f 0 = 1 ==> f 5
fun f 0 = 1 ==> f 5 handle Match => 9
case 3 of 1 => "one" | 2 => "two"
let val [x] = [1, 2] in x end
let val SOME x = (NONE : int option) in x end handle Bind => ~1
exnName Div
exnName (Fail "q")
exception Mine of int ==> exnName (Mine 3)
(valOf NONE; 1) handle Option => 4
String.sub ("", 0) handle Subscript => #"s"
chr 300
fun safe f x = SOME (f x) handle _ => NONE ==> (safe (fn x => 10 div x) 0, safe (fn x => 10 div x) 3)
exception Found of int fun search p xs = (app (fn x => if p x then raise Found x else ()) xs; NONE) handle Found x => SOME x ==> (search (fn x => x > 2) [1, 2, 3, 4], search (fn x => x > 9) [1])
let exception Local in (raise Local) handle Local => "caught" end
let fun f n = if n = 0 then raise Fail "bottom" else 1 + f (n - 1) in f 50 handle Fail _ => ~1 end
(raise Fail "a" ; 1) handle Fail _ => 2
let val log = ref [] in ((log := 1 :: !log; raise Div) handle Div => log := 2 :: !log); !log end
exception E of string fun g () = raise E "in" ==> (g () handle E "out" => 1) handle E s => String.size s
let val e = Fail "later" in (raise e) : int end
let val e = Div in (raise e) handle Div => "same" end
exception A exception B of int fun code A = 1 | code (B n) = n | code Div = 3 | code _ = 4 ==> map code [A, B 2, Div, Empty]
fun f x = (if x < 0.0 then raise Domain else Math.sqrt x) handle Domain => ~1.0 ==> (f 4.0, f ~4.0)
(fn x => x) (1 div 0)
(1 div 0, hd [] : int)
[hd [], 1 div 0]
{b = hd [] : int, a = 1 div 0}
(hd [] : int) + (1 div 0)
