Vector.fromList [1, 2, 3]
Vector.tabulate (4, fn i => i * i)
Vector.length (Vector.fromList ["a"])
Vector.sub (Vector.fromList [1, 2], 1)
Vector.sub (Vector.fromList [1, 2], 2)
Vector.update (Vector.fromList [1, 2], 0, 9)
Vector.concat [Vector.fromList [1], Vector.fromList [2, 3]]
Vector.map (fn x => x + 1) (Vector.fromList [1, 2])
Vector.mapi (fn (i, x) => i * x) (Vector.fromList [5, 6, 7])
Vector.foldl (op +) 0 (Vector.fromList [1, 2, 3])
Vector.foldr (op ::) [] (Vector.fromList [1, 2, 3])
Vector.foldli (fn (i, x, a) => a + i * x) 0 (Vector.fromList [1, 2, 3])
Vector.find (fn x => x > 1) (Vector.fromList [1, 2, 3])
Vector.findi (fn (i, x) => i > 0) (Vector.fromList [7, 8])
Vector.exists (fn x => x = 2) (Vector.fromList [1, 2])
Vector.all (fn x => x > 1) (Vector.fromList [1, 2])
Vector.collate Int.compare (Vector.fromList [1], Vector.fromList [1, 2])
Vector.fromList [1, 2] = Vector.fromList [1, 2]
Array.array (3, 0)
Array.fromList [1, 2]
let val a = Array.array (3, 0) in Array.update (a, 1, 5); a end
let val a = Array.tabulate (3, fn i => i) in Array.modify (fn x => x * 2) a; Array.vector a end
let val a = Array.fromList [1, 2, 3] in (Array.length a, Array.sub (a, 2)) end
Array.sub (Array.fromList [1], 1) handle Subscript => 0
Array.update (Array.fromList [1], 1, 2) handle Subscript => ()
let val a = Array.fromList [1, 2, 3] in Array.foldl (op +) 0 a end
let val a = Array.array (4, 0) in Array.copy {src = Array.fromList [7, 8], dst = a, di = 1}; a end
let val a = Array.fromList [3, 1, 2] fun swap (i, j) = let val t = Array.sub (a, i) in Array.update (a, i, Array.sub (a, j)); Array.update (a, j, t) end fun pass i = if i > 1 then () else (if Array.sub (a, i) > Array.sub (a, i + 1) then swap (i, i + 1) else (); pass (i + 1)) in pass 0; pass 0; a end
let val a = Array.fromList [1] in (a = a, a = Array.fromList [1]) end
let val s = ref 0 in Array.appi (fn (i, x) => s := !s + i * x) (Array.fromList [1, 2, 3]); !s end
let val n = 30 val sieve = Array.array (n, true) fun mark (p, m) = if m >= n then () else (Array.update (sieve, m, false); mark (p, m + p)) in app (fn p => if Array.sub (sieve, p) then mark (p, p * p) else ()) [2, 3, 5]; Array.foldri (fn (i, b, l) => if b andalso i > 1 then i :: l else l) [] sieve end
