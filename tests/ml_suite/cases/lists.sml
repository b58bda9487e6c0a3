[1, 2, 3]
1 :: 2 :: []
[] = ([] : int list)
hd [1, 2]
tl [1, 2]
hd ([] : int list) handle Empty => 0
tl ([] : int list) handle Empty => [0]
hd ([] : int list)
null []
null [1]
length [1, 2, 3]
rev [1, 2, 3]
[1, 2] ^^ [3]
List.nth ([1, 2, 3], 1)
List.nth ([1, 2, 3], 3) handle Subscript => ~1
List.nth ([1, 2, 3], ~1)
List.take ([1, 2, 3], 2)
List.take ([1, 2, 3], 0)
List.take ([1], 2)
List.drop ([1, 2, 3], 2)
List.drop ([1], 2) handle Subscript => [9]
List.last [1, 2, 3]
List.last ([] : int list)
List.concat [[1], [], [2, 3]]
List.revAppend ([1, 2], [3])
map (fn x => x * x) [1, 2, 3]
List.mapPartial (fn x => if x > 1 then SOME (x * 10) else NONE) [1, 2, 3]
List.filter (fn x => x mod 2 = 0) [1, 2, 3, 4]
List.partition (fn x => x > 2) [1, 2, 3, 4]
List.find (fn x => x > 2) [1, 2, 3, 4]
List.find (fn x => x > 9) [1, 2]
List.exists (fn x => x = 2) [1, 2]
List.exists (fn _ => true) ([] : int list)
List.all (fn x => x > 0) [1, 2]
List.all (fn _ => false) ([] : int list)
foldl (op +) 0 [1, 2, 3]
foldr (op ::) [] [1, 2, 3]
foldl (op ::) [] [1, 2, 3]
foldl (fn (x, a) => a - x) 10 [1, 2, 3]
foldr (fn (x, a) => x - a) 10 [1, 2, 3]
List.tabulate (5, fn i => i * i)
List.tabulate (0, fn i => i)
List.tabulate (~1, fn i => i)
List.getItem [1, 2]
List.getItem ([] : int list)
List.collate Int.compare ([1, 2], [1, 3])
List.collate Int.compare ([1, 2], [1])
List.collate Int.compare ([], [1])
[[1], [2, 3]] = [[1], [2, 3]]
[1, 2] <> [2, 1]
mem [1, 2, 3] 2
mem ["a"] "b"
remdupl [1, 2, 1, 3, 2]
rm 2 [1, 2, 3, 2]
rm 9 [1, 2]
rmall 2 [1, 2, 3, 2]
contains [1, 2, 3] [3, 1, 1]
contains [1, 2, 3] [4]
contains_all [1, 2, 3] [2, 2]
contains_all [1, 2, 2] [2, 2]
intersect [1, 2, 2, 3] [2, 3, 4]
union [1, 2] [2, 3]
listsub [1, 2, 3, 2] [2]
listsub [1] [2]
ins [1, 2] 3
ins_new [1, 2] 2
ins_new [1, 2] 3
pos 3 [1, 2, 3]
pos 4 [1, 2, 3]
fmap (fn x => [x, x + 10]) [1, 2]
sort (op <) [3, 1, 2, 1]
sort (op >) [3, 1, 2, 1]
sort (fn (a, b) => String.size a < String.size b) ["ccc", "a", "bb"]
ListPair.zip ([1, 2, 3], ["a", "b"])
ListPair.unzip [(1, "a"), (2, "b")]
ListPair.map (op +) ([1, 2], [10, 20])
ListPair.foldl (fn (a, b, c) => a * b + c) 0 ([1, 2], [3, 4])
ListPair.foldr (fn (a, b, c) => (a, b) :: c) [] ([1, 2], [3, 4, 5])
ListPair.all (op <) ([1, 2], [2, 3])
ListPair.exists (op =) ([1, 2], [2, 2])
ListPair.zipEq ([1], [1, 2])
ListPair.mapEq (op +) ([1, 2], [3, 4])
ListPair.allEq (op <) ([1], [2, 3])
fun flatten xss = foldr (op ^^) [] xss ==> flatten [[1, 2], [], [3]]
fun range (a, b) = if a > b then [] else a :: range (a + 1, b) ==> range (3, 7)
fun zip_with f (x :: xs) (y :: ys) = f (x, y) :: zip_with f xs ys | zip_with _ _ _ = [] ==> zip_with (op * ) [1, 2, 3] [4, 5]
fun insert x [] = [x] | insert x (y :: ys) = if x <= y then x :: y :: ys else y :: insert x ys
  fun isort xs = foldl (fn (x, s) => insert x s) [] xs ==> isort [5, 2, 8, 1, 9, 3]
fun quicksort [] = [] | quicksort (p :: xs) = let val (a, b) = List.partition (fn x => x < p) xs in quicksort a ^^ [p] ^^ quicksort b end ==> quicksort [3, 6, 1, 8, 2, 9, 2]
fun powerset [] = [[]] | powerset (x :: xs) = let val p = powerset xs in p ^^ map (fn s => x :: s) p end ==> powerset [1, 2, 3]
fun perms [] = [[]] | perms xs = List.concat (map (fn x => map (fn p => x :: p) (perms (rm x xs))) xs) ==> perms [1, 2, 3]
fun split [] = ([], []) | split [x] = ([x], []) | split (x :: y :: r) = let val (a, b) = split r in (x :: a, y :: b) end
  fun merge ([], ys) = ys | merge (xs, []) = xs | merge (x :: xs, y :: ys) = if x <= y then x :: merge (xs, y :: ys) else y :: merge (x :: xs, ys)
  fun msort [] = [] | msort [x] = [x] | msort xs = let val (a, b) = split xs in merge (msort a, msort b) end ==> msort [4, 2, 7, 1, 9, 0]
fun sieve [] = [] | sieve (p :: xs) = p :: sieve (List.filter (fn x => x mod p <> 0) xs) ==> sieve (List.tabulate (30, fn i => i + 2))
fun transpose ([] :: _) = [] | transpose rows = map hd rows :: transpose (map tl rows) ==> transpose [[1, 2, 3], [4, 5, 6]]
