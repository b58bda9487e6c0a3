1+2
1 (* a (* nested *) comment *) + 2
(fn _ => 3) ()
[(1, 2), (3, 4)]
(((1)))
~ 5
~(1 + 2)
let val x' = 1 val x'' = 2 in x' + x'' end
let val it = 5 in it end
"a" ^ "b" ^ "c" = "abc"
1 :: ([2] ^^ [3])
not (1 = 2)
if 1 = 1 andalso 2 = 2 then "y" else "n"
(op +) (1, 2)
op :: (1, [2])
foldl op + 0 [1, 2]
(fn x => fn y => x) 1 2
(fn (x, y) : int * int => x + y) (1, 2)
1 : int
[1 : int, 2]
(1, 2) : int * int
#"a" = chr 97
let fun f (x : int) : string = Int.toString x in f 3 end
let val f = fn x : int => x + 1 in f 3 end
(raise Fail "a") handle Fail _ => 1
case 1 of 1 => case 2 of 2 => "in" | _ => "?" | _ => "out"
(case 1 of 2 => "a" | _ => "b") ^ "c"
1 - 2 - 3
2 * 3 div 4 mod 5
1 < 2 = true
"x" ^ (if true then "y" else "z")
let val {a, b} = {a = 1, b = 2}; val c = a + b; in c end
(1; 2; 3)
let val x = 1; in x; x + 1 end
true andalso false orelse true
1.5e2
1E2
0x7F
#"\\"
"\\\\"
while false do ()
