fun fact 0 = 1 | fact n = n * fact (n - 1) ==> fact 12
fun fact 0 = 1 | fact n = n * fact (n - 1) ==> fact 13
fun fib n = if n < 2 then n else fib (n - 1) + fib (n - 2) ==> map fib [0, 1, 2, 3, 10, 15]
fun even 0 = true | even n = odd (n - 1) and odd 0 = false | odd n = even (n - 1) ==> (even 100, odd 100, odd 77)
fun ack (0, n) = n + 1 | ack (m, 0) = ack (m - 1, 1) | ack (m, n) = ack (m - 1, ack (m, n - 1)) ==> ack (2, 3)
fun loop (0, acc) = acc | loop (n, acc) = loop (n - 1, acc + n) ==> loop (20000, 0)
fun down 0 = 0 | down n = 1 + down (n - 1) ==> down 20000
fun hanoi (0, _, _, _) = [] | hanoi (n, a, b, c) = hanoi (n - 1, a, c, b) ^^ [(a, c)] ^^ hanoi (n - 1, b, a, c) ==> hanoi (3, "a", "b", "c")
fun binary 0 = "0" | binary 1 = "1" | binary n = binary (n div 2) ^ (if n mod 2 = 0 then "0" else "1") ==> map binary [0, 5, 10, 255]
fun hofs 0 = 0 | hofs n = n - hofm (hofs (n - 1)) and hofm 0 = 0 | hofm n = n - hofs (hofm (n - 1)) ==> hofs 20 handle _ => ~1
fun queens n = let fun ok (_, _, []) = true | ok (q, d, p :: ps) = q <> p andalso q + d <> p andalso q - d <> p andalso ok (q, d + 1, ps) fun place (0, qs) = 1 | place (k, qs) = let fun try (0, total) = total | try (q, total) = try (q - 1, if ok (q, 1, qs) then total + place (k - 1, q :: qs) else total) in try (n, 0) end in place (n, []) end ==> map queens [1, 4, 5, 6]
fun choose (_, 0) = 1 | choose (n, k) = if k = n then 1 else choose (n - 1, k - 1) + choose (n - 1, k) ==> (choose (5, 2), choose (10, 5))
fun change (0, _) = 1 | change (_, []) = 0 | change (n, c :: cs) = if n < 0 then 0 else change (n - c, c :: cs) + change (n, cs) ==> change (50, [25, 10, 5, 1])
fun lcs ([], _) = [] | lcs (_, []) = [] | lcs (x :: xs, y :: ys) = if x = y then x :: lcs (xs, ys) else let val a = lcs (x :: xs, ys) val b = lcs (xs, y :: ys) in if length a >= length b then a else b end ==> implode (lcs (explode "abcbdab", explode "bdcaba"))
fun run [] = [] | run (x :: xs) = case run xs of (y, n) :: r => if x = y then (y, n + 1) :: r else (x, 1) :: (y, n) :: r | [] => [(x, 1)] ==> run [1, 1, 2, 1]
fun f x = if x > 100 then x - 10 else f (f (x + 11)) ==> map f [50, 99, 100, 101]
fun pascal 0 = [1] | pascal n = let val p = pascal (n - 1) in ListPair.map (op +) (0 :: p, p ^^ [0]) end ==> pascal 6
fun gray 0 = [""] | gray n = let val g = gray (n - 1) in map (fn s => "0" ^ s) g ^^ map (fn s => "1" ^ s) (rev g) end ==> gray 3
