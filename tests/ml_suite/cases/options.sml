SOME 3
NONE : int option
valOf (SOME 3)
valOf (NONE : int option)
isSome (SOME 1)
isSome (NONE : int option)
getOpt (NONE, 5)
getOpt (SOME 1, 5)
Option.map (fn x => x + 1) (SOME 2)
Option.map (fn x => x + 1) NONE
Option.mapPartial (fn x => if x > 0 then SOME (x * 2) else NONE) (SOME 0)
Option.filter (fn x => x > 1) 2
Option.filter (fn x => x > 1) 1
Option.join (SOME (SOME 1))
Option.join (SOME (NONE : int option))
Option.compose (fn x => x + 1, Int.fromString) "41"
Option.composePartial (fn x => if x > 9 then SOME x else NONE, Int.fromString) "4"
SOME (SOME 1) = SOME (SOME 1)
SOME 1 = NONE
case SOME (1, "a") of SOME (n, s) => s ^ Int.toString n | NONE => "none"
fun lookup (k : string) [] = NONE | lookup k ((k', v) :: r) = if k = k' then SOME v else lookup k r ==> (lookup "b" [("a", 1), ("b", 2)], lookup "c" [("a", 1)])
let val r = ref 0 in Option.app (fn x => r := x) (SOME 7); !r end
