let val r = ref 1 in r := !r + 1; !r end
let val r = ref [1] in r := 0 :: !r; !r end
ref 5
ref (1, "a")
let val a = ref 1 val b = a in b := 5; (!a, a = b, ref 1 = ref 1) end
let val r = ref 0 in app (fn x => r := !r + x) [1, 2, 3]; !r end
let val r = ref 10 and s = ref 0 in while !r > 0 do (s := !s + !r; r := !r - 1); !s end
let val r = ref 5 in (inc r; inc r; dec r; !r) end
let val r = ref 5 in (r += 3; r -= 1; r *= 2; !r) end
let val r = ref [1, 2] in (r ::= 9; !r) end
let fun counter () = let val n = ref 0 in fn () => (n := !n + 1; !n) end val c = counter () val d = counter () in (c (), c (), d (), c ()) end
let val r = ref (fn x => x + 1) in r := (fn x => x * 2); (!r) 21 end
let val fact = ref (fn _ => 0) in fact := (fn n => if n = 0 then 1 else n * !fact (n - 1)); !fact 5 end
let val rs = [ref 1, ref 2] in app (fn r => r := !r * 10) rs; map ! rs end
let val r = ref NONE in r := SOME 3; !r end
(ref 1, ref "x")
let val (a, b) = (ref 1, ref 2) fun swap (x, y) = let val t = !x in x := !y; y := t end in swap (a, b); (!a, !b) end
let val r = ref 1 val f = fn () => (r := !r * 2; !r) in f () + f () * 10 end
let val r = ref 0 fun note x = (r := !r * 10 + x; x) in (note 1, note 2, note 3); !r end
let val r = ref 0 fun note x = (r := !r * 10 + x; x) in {c = note 1, a = note 2, b = note 3}; !r end
let val r = ref 0 fun note x = (r := !r * 10 + x; x) in note 1 + note 2 * note 3; !r end
let val r = ref 0 fun note x = (r := !r * 10 + x; x) in [note 3, note 2]; !r end
let val r = ref 0 fun note x = (r := !r * 10 + x; fn y => y) in (note 1) (r := !r * 10 + 2); !r end
let val r = ref 0 in (r := 1; 5) before (r := 2); !r end
let val r = ref 7 in ignore (r := 8); !r end
let val m = ref [] fun memo f x = case List.find (fn (k, _) => k = x) (!m) of SOME (_, v) => v | NONE => let val v = f x in m := (x, v) :: !m; v end fun fib n = if n < 2 then n else memo fib (n - 1) + memo fib (n - 2) in fib 30 end
