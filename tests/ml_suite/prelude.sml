(* Poly/ML as CPN Tools has ML: int of 31 bits as far as results and the functions of Int go, multi-sets, lists. *)
fun check_int i = if i > 1073741823 orelse i < ~1073741824 then raise Overflow else (i : int);
structure Int = struct
  open Int
  val maxInt = SOME 1073741823  val minInt = SOME ~1073741824  val precision = SOME 31
  fun c2 f (a, b) = check_int (f (a, b))
  val op + = c2 Int.+  val op - = c2 Int.-  val op * = c2 Int.*
  val op div = c2 Int.div  val quot = c2 Int.quot
  val ~ = check_int o Int.~  val abs = check_int o Int.abs
  val fromLarge = check_int o Int.fromLarge
  fun fromString s = Option.map check_int (Int.fromString s)
  fun scan r g s = Option.map (fn (i, s) => (check_int i, s)) (Int.scan r g s)
end;
structure IntInf = struct open IntInf val toInt = check_int o IntInf.toInt end;
structure Real = struct
  open Real
  val floor = check_int o Real.floor  val ceil = check_int o Real.ceil
  val round = check_int o Real.round  val trunc = check_int o Real.trunc
end;
val floor = Real.floor  val ceil = Real.ceil  val round = Real.round  val trunc = Real.trunc;
exception Subtract;
exception no_singleton;
infix 8 `; infix 7 ** // %; infix 6 ++ --; infix 5 ^^; infix 3 == != <><> << <<= <<== >> >>= >>==;
infix 0 ::= += -= *=;
fun a ^^ b = List.@ (a, b);
fun mem xs x = List.exists (fn y => y = x) xs;
fun rm _ [] = [] | rm x (y :: ys) = if x = y then ys else y :: rm x ys;
fun rmall x ys = List.filter (fn y => y <> x) ys;
fun remdupl [] = [] | remdupl (x :: xs) = if mem xs x then remdupl xs else x :: remdupl xs;
fun contains xs ys = List.all (mem xs) ys;
fun contains_all _ [] = true | contains_all xs (y :: ys) = mem xs y andalso contains_all (rm y xs) ys;
fun intersect [] _ = [] | intersect (x :: xs) ys = if mem ys x then x :: intersect xs (rm x ys) else intersect xs ys;
fun union xs ys = xs ^^ ys;
fun listsub xs [] = xs | listsub xs (y :: ys) = if mem xs y then listsub (rm y xs) ys else raise Subtract;
fun ins xs x = xs ^^ [x];
fun ins_new xs x = if mem xs x then xs else ins xs x;
fun pos x xs = let fun at (_, []) = raise Match | at (n, y :: ys) = if x = y then n else at (n + 1, ys) in at (0, xs) end;
fun fmap f xs = List.concat (List.map f xs);
fun sort less [] = []
  | sort less (x :: xs) =
      let fun put (x, []) = [x] | put (x, y :: ys) = if less (y, x) then y :: put (x, ys) else x :: y :: ys
      in put (x, sort less xs) end;
fun n ` x = if n <= 0 then [] else x :: ((n - 1) ` x);
fun a ++ b = a ^^ b;
fun a -- b = listsub a b;
fun n ** ms = if n <= 0 then [] else List.concat (List.map (fn x => List.tabulate (n, fn _ => x)) ms);
fun bs % x = if List.all (fn b => b) bs then [x] else [];
fun bs // ms = if List.all (fn b => b) bs then ms else [];
fun a <<= b = contains_all b a;
fun a >>= b = contains_all a b;
fun a == b = length a = length b andalso contains_all a b;
fun a != b = not (a == b);
fun a <><> b = not (a == b);
fun a << b = length a < length b andalso contains_all b a;
fun a >> b = b << a;
fun a <<== b = a <<= b;
fun a >>== b = a >>= b;
val empty = [];
fun cf (x, ms) = length (List.filter (fn y => y = x) ms);
fun size ms = length ms;
fun ext_col f ms = List.map f ms;
fun ext_ms f ms = List.concat (List.map f ms);
fun filter p ms = List.filter p ms;
fun ms_to_col [x] = x | ms_to_col _ = raise no_singleton;
fun ms_to_list ms = ms;
fun list_to_ms xs = xs;
fun sort_ms less ms = sort less ms;
fun r ::= x = r := x :: !r;
fun r += n = r := check_int (!r + n);
fun r -= n = r := check_int (!r - n);
fun r *= n = r := check_int (!r * n);
fun inc r = r += 1;
fun dec r = r -= 1;
