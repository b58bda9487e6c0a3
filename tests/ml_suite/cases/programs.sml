fun insert (k, v, []) = [(k, v)] | insert (k, v, (k', v') :: r) = if k = k' then (k, v) :: r else (k', v') :: insert (k, v, r)
  fun count ws = foldl (fn (w, m) => insert (w, 1 + getOpt (Option.map #2 (List.find (fn (k, _) => k = w) m), 0), m)) [] ws
  ==> count (String.tokens Char.isSpace "the cat the dog the end")
datatype token = Num of int | Op of char
  fun lex [] = [] | lex (c :: cs) = if Char.isSpace c then lex cs else if Char.isDigit c then number (c :: cs, 0) else Op c :: lex cs
  and number (c :: cs, n) = if Char.isDigit c then number (cs, n * 10 + ord c - 48) else Num n :: lex (c :: cs) | number ([], n) = [Num n]
  fun expr ts = let val (a, r) = term ts in sums (a, r) end
  and sums (a, Op #"+" :: r) = let val (b, r) = term r in sums (a + b, r) end | sums (a, Op #"-" :: r) = let val (b, r) = term r in sums (a - b, r) end | sums x = x
  and term ts = let val (a, r) = factor ts in products (a, r) end
  and products (a, Op #"*" :: r) = let val (b, r) = factor r in products (a * b, r) end | products x = x
  and factor (Num n :: r) = (n, r) | factor (Op #"(" :: r) = (case expr r of (v, Op #")" :: r) => (v, r) | _ => raise Fail "paren") | factor _ = raise Fail "factor"
  ==> (#1 (expr (lex (explode "2 + 3 * (4 - 1) - 10"))), (#1 (expr (lex (explode "(1"))) handle Fail s => String.size s))
fun bfs (graph, start) = let fun go ([], seen) = rev seen | go (n :: queue, seen) = if mem seen n then go (queue, seen) else let val next = List.mapPartial (fn (a, b) => if a = n then SOME b else NONE) graph in go (queue ^^ next, n :: seen) end in go ([start], []) end
  ==> bfs ([(1, 2), (1, 3), (2, 4), (3, 4), (4, 1), (5, 6)], 1)
fun matmul (a, b) = let fun cols m = if null (hd m) then [] else map hd m :: cols (map tl m) fun dot (x, y) = ListPair.foldl (fn (p, q, s) => p * q + s) 0 (x, y) in map (fn r => map (fn c => dot (r, c)) (cols b)) a end
  ==> matmul ([[1, 2], [3, 4]], [[5, 6], [7, 8]])
fun rle s = let fun go ([], _) = "" | go ([c], n) = str c ^ Int.toString n | go (a :: b :: r, n) = if a = b then go (b :: r, n + 1) else str a ^ Int.toString n ^ go (b :: r, 1) in go (explode s, 1) end ==> rle "aaabccd"
fun roman 0 = "" | roman n = let fun first ((v, s) :: r) = if n >= v then (v, s) else first r | first [] = raise Fail "none" val (v, s) = first [(1000, "M"), (900, "CM"), (500, "D"), (400, "CD"), (100, "C"), (90, "XC"), (50, "L"), (40, "XL"), (10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I")] in s ^ roman (n - v) end ==> map roman [4, 1994, 2026]
structure Queue = struct
    type 'a queue = 'a list * 'a list
    val empty = ([], [])
    exception Empty_queue
    fun put ((f, b), x) = (f, x :: b)
    fun get ([], []) = raise Empty_queue | get ([], b) = get (rev b, []) | get (x :: f, b) = (x, (f, b))
  end
  ==> let val q = Queue.put (Queue.put (Queue.empty, 1), 2) val (a, q) = Queue.get q val (b, q) = Queue.get q in (a, b, (#1 (Queue.get q) handle Queue.Empty_queue => 0)) end
fun life cells = let fun near (x, y) = [(x-1,y-1), (x,y-1), (x+1,y-1), (x-1,y), (x+1,y), (x-1,y+1), (x,y+1), (x+1,y+1)] fun alive c = mem cells c fun count c = length (List.filter alive (near c)) val all = remdupl (cells ^^ List.concat (map near cells)) in sort (fn ((a, b), (c, d)) => a < c orelse a = c andalso b < (d : int)) (List.filter (fn c => count c = 3 orelse alive c andalso count c = 2) all) end ==> life [(1, 0), (1, 1), (1, 2)]
datatype 'a heap = E | T of int * 'a * 'a heap * 'a heap
  fun rank E = 0 | rank (T (r, _, _, _)) = r
  fun make (x, a, b) = if rank a >= rank b then T (rank b + 1, x, a, b) else T (rank a + 1, x, b, a)
  fun merge _ (h, E) = h | merge _ (E, h) = h | merge less (a as T (_, x, a1, b1), b as T (_, y, a2, b2)) = if less (x, y) then make (x, a1, merge less (b1, b)) else make (y, a2, merge less (a, b2))
  fun sorted less h = case h of E => [] | T (_, x, a, b) => x :: sorted less (merge less (a, b))
  fun heap_sort less xs = sorted less (foldl (fn (x, h) => merge less (T (1, x, E, E), h)) E xs)
  ==> (heap_sort (op <) [3, 1, 4, 1, 5, 9, 2, 6], heap_sort (op >) ["pear", "apple", "fig"])
fun balance s = let fun go ([], 0) = true | go ([], _) = false | go (#"(" :: r, n) = go (r, n + 1) | go (#")" :: r, n) = n > 0 andalso go (r, n - 1) | go (_ :: r, n) = go (r, n) in go (explode s, 0) end ==> map balance ["(a(b)c)", "(()", ")("]
fun to_base b 0 = "0" | to_base b n = let fun go 0 = "" | go n = go (n div b) ^ str (String.sub ("0123456789ABCDEF", n mod b)) in go n end ==> (to_base 2 10, to_base 16 48879, to_base 8 0)
fun primes n = let fun is_prime k = let fun check d = d * d > k orelse (k mod d <> 0 andalso check (d + 1)) in k > 1 andalso check 2 end in List.filter is_prime (List.tabulate (n, fn i => i)) end ==> primes 40
datatype account = Account of {id : int, balance : int}
  exception Insufficient of int
  fun withdraw (Account {id, balance}, n) = if n > balance then raise Insufficient (n - balance) else Account {id = id, balance = balance - n}
  ==> let val Account {balance, ...} = withdraw (Account {id = 1, balance = 100}, 30) in (balance, (withdraw (Account {id = 2, balance = 5}, 30); 0) handle Insufficient d => d) end
fun simulate (0, state, log) = rev log | simulate (n, state, log) = let val next = (state * 1103 + 12345) mod 65536 in simulate (n - 1, next, next mod 6 + 1 :: log) end ==> simulate (8, 42, [])
fun split_at (0, xs) = ([], xs) | split_at (_, []) = ([], []) | split_at (n, x :: xs) = let val (a, b) = split_at (n - 1, xs) in (x :: a, b) end fun chunks n [] = [] | chunks n xs = let val (a, b) = split_at (n, xs) in a :: chunks n b end ==> chunks 2 [1, 2, 3, 4, 5]
fun topo (nodes, edges) = let fun go ([], _, out) = rev out | go (ns, es, out) = case List.find (fn n => not (List.exists (fn (_, b) => b = n) es)) ns of NONE => raise Fail "cycle" | SOME n => go (rm n ns, List.filter (fn (a, _) => a <> n) es, n :: out) in go (nodes, edges, []) end ==> (topo (["c", "b", "a"], [("a", "b"), ("b", "c")]), topo (["x"], [("x", "x")]) handle Fail s => [s])
val counter = ref 0 fun fresh prefix = (counter := !counter + 1; prefix ^ Int.toString (!counter)) ==> (fresh "v", fresh "w", !counter)
fun csv line = map (fn f => if String.isPrefix "\"" f then substring (f, 1, String.size f - 2) else f) (String.fields (fn c => c = #",") line) ==> csv "a,\"b\",,3"
