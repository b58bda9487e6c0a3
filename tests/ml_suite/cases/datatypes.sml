datatype colour = Red | Green | Blue fun next Red = Green | next Green = Blue | next Blue = Red ==> next Blue = Red
datatype shape = Circle of real | Rect of real * real fun area (Circle r) = 3.0 * r * r | area (Rect (a, b)) = a * b ==> map area [Circle 1.0, Rect (2.0, 3.5)]
datatype tree = Leaf | Node of tree * int * tree
  fun insert (Leaf, x) = Node (Leaf, x, Leaf) | insert (t as Node (l, y, r), x) = if x < y then Node (insert (l, x), y, r) else if x > y then Node (l, y, insert (r, x)) else t
  fun walk Leaf = [] | walk (Node (l, x, r)) = walk l ^^ [x] ^^ walk r
  ==> walk (foldl (fn (x, t) => insert (t, x)) Leaf [5, 2, 8, 1, 9, 2])
datatype 'a tree = Leaf | Node of 'a tree * 'a * 'a tree
  fun depth Leaf = 0 | depth (Node (l, _, r)) = 1 + Int.max (depth l, depth r) ==> (depth (Node (Leaf, 1, Node (Leaf, 2, Leaf))), depth (Node (Leaf, "x", Leaf)))
datatype exp = Num of int | Add of exp * exp | Mul of exp * exp | Neg of exp
  fun eval (Num n) = n | eval (Add (a, b)) = eval a + eval b | eval (Mul (a, b)) = eval a * eval b | eval (Neg a) = ~(eval a)
  ==> eval (Add (Num 2, Mul (Num 3, Neg (Num 4))))
datatype exp = Num of int | Var of string | Plus of exp * exp
  fun show (Num n) = Int.toString n | show (Var v) = v | show (Plus (a, b)) = "(" ^ show a ^ " + " ^ show b ^ ")"
  fun simplify (Plus (Num 0, e)) = simplify e | simplify (Plus (e, Num 0)) = simplify e | simplify (Plus (a, b)) = Plus (simplify a, simplify b) | simplify e = e
  ==> (show o simplify) (Plus (Plus (Num 0, Var "x"), Plus (Num 1, Num 0)))
datatype even = Zero | S of odd and odd = T of even fun count Zero = 0 | count (S n) = 1 + countodd n and countodd (T n) = 1 + count n ==> count (S (T (S (T Zero))))
datatype ('a, 'b) either = Left of 'a | Right of 'b fun lefts xs = List.mapPartial (fn Left x => SOME x | Right _ => NONE) xs ==> lefts [Left 1, Right "a", Left 3]
datatype t = A of int | B of {x : int, y : string} fun f (A n) = n | f (B {x, y}) = x + String.size y ==> f (B {x = 1, y = "abc"}) + f (A 10)
datatype t = A | B of int ==> (B 1 = B 1, A = A, A = B 1, B 1 = B 2)
datatype 'a stack = Empty_stack | Push of 'a * 'a stack
  fun pop Empty_stack = NONE | pop (Push (x, s)) = SOME (x, s) fun push s x = Push (x, s)
  ==> (case pop (push (push Empty_stack 1) 2) of SOME (x, _) => x | NONE => 0)
datatype nat = Z | S of nat fun add (Z, n) = n | add (S m, n) = S (add (m, n)) fun int Z = 0 | int (S n) = 1 + int n fun nat 0 = Z | nat n = S (nat (n - 1)) ==> int (add (nat 3, nat 4))
datatype t = F of int -> int fun app (F f) x = f x ==> map (app (F (fn x => x * x))) [1, 2, 3]
datatype instr = Push of int | AddI | MulI
  fun run ([], [x]) = x | run (Push n :: c, s) = run (c, n :: s) | run (AddI :: c, a :: b :: s) = run (c, a + b :: s) | run (MulI :: c, a :: b :: s) = run (c, a * b :: s) | run _ = raise Fail "stuck"
  ==> (run ([Push 2, Push 3, AddI, Push 4, MulI], []), run ([AddI], []) handle Fail s => String.size s)
datatype t = datatype order ==> (LESS, GREATER)
datatype rose = Rose of int * rose list fun sum (Rose (n, ts)) = n + foldl (op +) 0 (map sum ts) ==> sum (Rose (1, [Rose (2, []), Rose (3, [Rose (4, [])])]))
