3`5
1`1 ++ 2`2
(1`1 ++ 2`2) == (2`2 ++ 1`1)
(1`1 ++ 2`2) = (2`2 ++ 1`1)
1`1 != 1`2
0`7
(~3)`7
3 ** (1`1 ++ 2`5)
0 ** (1`1)
(3`1 ++ 2`2) -- (1`1 ++ 1`2)
1`1 -- 1`2
(1`1 -- 2`1) handle Subtract => [9]
1`1 << 2`1
2`1 << 2`1
2`1 <<= 2`1
2`1 >> 1`1
1`1 >> 1`2
1`1 >>= (empty : int list)
empty == 0`3
[true, true] % 5
[true, false] % 5
[1 > 0] // (2`3)
[1 < 0] // (2`3)
cf (1, 2`1 ++ 1`3)
cf (9, 2`1)
size (2`1 ++ 1`3)
size empty
ext_col (fn x => x + 1) (1`1 ++ 2`2)
ext_ms (fn x => 2`x) (1`1 ++ 1`2)
filter (fn x => x > 1) (1`1 ++ 2`2)
ms_to_col (1`7)
ms_to_col (2`7)
ms_to_col (empty : int list) handle no_singleton => 0
ms_to_list (2`3 ++ 1`1)
list_to_ms [1, 2]
sort_ms (op <) (1`3 ++ 2`1)
map (fn x => x * 2) (2`1 ++ 1`4)
length (5`"a")
rev (1`1 ++ 1`2)
2`(1, "a") ++ 1`(2, "b")
foldl (fn (n, ms) => ms ++ n`n) empty [1, 2, 3]
(2 + 1)`4
1`(2 + 3)
1`1 ++ [2, 3]
mem (2`1 ++ 1`5) 5
fun support ms = remdupl (sort (op <) ms) ==> support (3`2 ++ 1`1 ++ 2`2)
fun table ms = map (fn x => (x, cf (x, ms))) (sort (op <) (remdupl ms)) ==> table (3`2 ++ 1`1 ++ 2`2)
