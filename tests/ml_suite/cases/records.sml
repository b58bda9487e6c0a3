{a = 1, b = "x"}
{b = "x", a = 1} = {a = 1, b = "x"}
#a {a = 1, b = 2}
#2 (1, "two", 3.0)
(1, (2, 3), "x")
#1 (#2 (1, (2, 3)))
let val {x, y} = {y = 2, x = 1} in x - y end
let val {x = a, y = (b, _)} = {x = 1, y = (2, "z")} in (b, a) end
let val (a, b) = (1, 2) in (b, a) end
let fun f {name, age : int} = name ^ Int.toString age in f {age = 3, name = "Tom"} end
map #1 [(1, "a"), (2, "b")]
map (fn {k, v} => (v, k)) [{k = 1, v = true}]
()
{1 = "a", 2 = "b"}
{10 = 1, 2 = 2, 1 = 3}
(fn {a, ...} : {a : int, b : int} => a) {a = 5, b = 6}
type point = {x : int, y : int} fun move (p : point, d) = {x = #x p + d, y = #y p + d} ==> move ({x = 1, y = 2}, 10)
let val p as (a, _) = (1, "x") in (p, a) end
{inner = {deep = [1, 2]}, n = NONE : int option}
(1, 2) = (1, 2) andalso (1, "a") <> (1, "b")
