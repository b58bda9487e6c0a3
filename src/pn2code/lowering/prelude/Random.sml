fun prim_do_random_below (n : IntInf.int) : IntInf.int = n
fun prim_do_random_unit () : real = 0.0

fun Random_rand (a : int, b : int) = 0
fun Random_randInt (generator : int) = IntInf.toInt (IntInf.- (prim_do_random_below 2147483648, 1073741824))
fun Random_randNat (generator : int) = IntInf.toInt (prim_do_random_below 1073741824)
fun Random_randReal (generator : int) = prim_do_random_unit ()

fun Random_randRange (low, high) (generator : int) =
    if high < low then raise Fail "Random.randRange: hi < lo"
    else
        let val first = IntInf.fromInt low
        in IntInf.toInt (IntInf.+ (first, prim_do_random_below (IntInf.+ (IntInf.- (IntInf.fromInt high, first), 1)))) end
