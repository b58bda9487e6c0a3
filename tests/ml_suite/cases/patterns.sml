case [1, 2] of [] => 0 | x :: _ => x
case (1, "a") of (1, s) => s | _ => "?"
case [1, 2, 3] of [a, b, c] => a + b + c | _ => 0
case [1, 2, 3] of [a, b] => a + b | a :: rest => length rest | [] => 0
case "abc" of "abd" => 1 | "abc" => 2 | _ => 3
case #"x" of #"y" => 1 | #"x" => 2 | _ => 3
case ~5 of ~5 => "minus" | _ => "other"
case (1, (2, [3, 4])) of (a, (b, c :: _)) => a + b + c | _ => 0
case SOME [] of SOME [] => "empty" | SOME (x :: _) => x | NONE => "none"
case {a = 1, b = 2} of {a = 1, b} => b | {a, ...} => a
case () of () => "unit"
case true of true => 1 | false => 0
case (true, false) of (false, _) => 1 | (_, true) => 2 | _ => 3
case [[1], [2, 3]] of [[a], b :: c :: _] => a + b * 10 | _ => 0
fun f (x as (a, _)) = (x, a) ==> f (1, "b")
fun f (all as x :: rest) = (all, rest, x : int) | f [] = ([], [], 0) ==> (f [1, 2], f [])
fun f 1 _ = "a" | f _ 1 = "b" | f _ _ = "c" ==> (f 1 1, f 2 1, f 2 2)
fun f ([], _) = 1 | f (_, []) = 2 | f (x :: _, y :: _) = x + y ==> (f ([], [1]), f ([1], []), f ([3], [4]))
fun f (SOME (x, y)) = x + y | f NONE = 0 ==> f (SOME (3, 4))
fun classify n = case Int.compare (n, 0) of LESS => "neg" | EQUAL => "zero" | GREATER => "pos" ==> map classify [~1, 0, 1]
(fn [] => "e" | [_] => "one" | [_, _] => "two" | _ => "more") [1, 2]
let val x :: y :: _ = [1, 2, 3] in (y, x) end
let val (a as SOME b) = SOME 3 in (a, b) end
case 5 of n => n + 1
case 1 + 1 of 2 => "two" | _ => "?"
case (case 1 of 1 => "x" | _ => "y") of "x" => 10 | _ => 20
fun days 2 y = if y mod 4 = 0 then 29 else 28 | days m _ = if mem [4, 6, 9, 11] m then 30 else 31 ==> (days 2 2024, days 2 2025, days 4 1, days 12 1)
fun f {x = 0, y} = y | f {x, y = 0} = x | f {x, y} = x * y ==> (f {x = 0, y = 5}, f {x = 3, y = 0}, f {x = 3, y = 4})
fun eq3 (a, b, c) = if a = b andalso b = c then "all" else if a = b orelse b = c orelse a = c then "two" else "none" ==> map eq3 [(1, 1, 1), (1, 2, 1), (1, 2, 3)]
if true then 1 else 2
true andalso (false orelse true)
false andalso (1 div 0 = 0)
true orelse (1 div 0 = 0)
not true
(print ""; 5)
(1; "a"; 2.5)
