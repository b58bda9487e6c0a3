(* A substring is its text, where it starts in it, and its length. *)
fun Substring_full s = (s, 0, String.size s)
fun Substring_all s = Substring_full s

fun Substring_substring (s, i, n) =
    if i < 0 orelse n < 0 orelse i > String.size s orelse n > String.size s - i then raise Subscript else (s, i, n)

fun Substring_extract (s, i, NONE) =
    if i < 0 then raise Subscript else Substring_substring (s, i, String.size s - i)
  | Substring_extract (s, i, SOME n) = Substring_substring (s, i, n)

fun Substring_slice ((s, i, n), j, m) =
    let val length = case m of SOME m => m | NONE => if j < 0 then 0 else n - j
    in if j < 0 orelse length < 0 orelse j > n orelse length > n - j then raise Subscript else (s, i + j, length) end

fun Substring_string (s, i, n) = substring (s, i, n)
fun Substring_base (s : string, i : int, n : int) = (s, i, n)
fun Substring_size (_ : string, _ : int, n : int) = n
fun Substring_isEmpty (_ : string, _ : int, n) = n = 0

fun Substring_sub ((s, i, n), j) = if j < 0 orelse j >= n then raise Subscript else String.sub (s, i + j)

fun Substring_getc (s, i, n) = if n = 0 then NONE else SOME (String.sub (s, i), (s, i + 1, n - 1))

fun Substring_first (s, i, n) = if n = 0 then NONE else SOME (String.sub (s, i))

fun Substring_triml k (s : string, i, n) =
    if k < 0 then raise Subscript else if k >= n then (s, i + n, 0) else (s, i + k, n - k)

fun Substring_trimr k (s : string, i : int, n) =
    if k < 0 then raise Subscript else if k >= n then (s, i, 0) else (s, i, n - k)

fun Substring_concat parts = concat (List.map Substring_string parts)
fun Substring_concatWith separator parts = String.concatWith separator (List.map Substring_string parts)
fun Substring_explode part = explode (Substring_string part)
fun Substring_isPrefix s part = String.isPrefix s (Substring_string part)
fun Substring_isSuffix s part = String.isSuffix s (Substring_string part)
fun Substring_isSubstring s part = String.isSubstring s (Substring_string part)
fun Substring_compare (a, b) = String.compare (Substring_string a, Substring_string b)
fun Substring_collate cmp (a, b) = List.collate cmp (Substring_explode a, Substring_explode b)

fun left (p, s, i, n) =
    let fun loop k = if k < n andalso p (String.sub (s, i + k)) then loop (k + 1) else k
    in loop 0 end

fun right (p, s, i, n) =
    let fun loop k = if k > 0 andalso p (String.sub (s, i + k - 1)) then loop (k - 1) else k
    in loop n end

fun Substring_splitl p (s, i, n) = let val k = left (p, s, i, n) in ((s, i, k), (s, i + k, n - k)) end
fun Substring_splitr p (s, i, n) = let val k = right (p, s, i, n) in ((s, i, k), (s, i + k, n - k)) end

fun Substring_splitAt ((s : string, i, n), k) =
    if k < 0 orelse k > n then raise Subscript else ((s, i, k), (s, i + k, n - k))

fun Substring_takel p part = #1 (Substring_splitl p part)
fun Substring_dropl p part = #2 (Substring_splitl p part)
fun Substring_taker p part = #2 (Substring_splitr p part)
fun Substring_dropr p part = #1 (Substring_splitr p part)

fun Substring_position wanted (s, i, n) =
    let val m = String.size wanted
        fun loop k =
            if k + m > n then n
            else if substring (s, i + k, m) = wanted then k
            else loop (k + 1)
        val k = loop 0
    in ((s, i, k), (s, i + k, n - k)) end

fun Substring_span ((s, i, n), (s', i', n')) =
    if s = s' andalso i <= i' + n' then (s, i, i' + n' - i) else raise Span

fun Substring_translate f part = String.translate f (Substring_string part)

fun Substring_fields p (s, i, n) =
    let fun loop (k, from, out) =
            if k = n then rev ((s, i + from, k - from) :: out)
            else if p (String.sub (s, i + k)) then loop (k + 1, k + 1, (s, i + from, k - from) :: out)
            else loop (k + 1, from, out)
    in loop (0, 0, nil) end

fun Substring_tokens p part = List.filter (fn (_, _, n) => n > 0) (Substring_fields p part)

fun Substring_app f part = List.app f (Substring_explode part)
fun Substring_foldl f z part = List.foldl f z (Substring_explode part)
fun Substring_foldr f z part = List.foldr f z (Substring_explode part)
