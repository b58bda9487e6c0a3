fun Misc_a_cmp less (a, b) = if less (a, b) then LESS else if less (b, a) then GREATER else EQUAL

fun Misc_makelist show xs = "[" ^ String.concatWith "," (List.map show xs) ^ "]"

fun Misc_split (0, rest, front) = (rest, List.rev front)
  | Misc_split (n, x :: rest, front) = Misc_split (n - 1, rest, x :: front)
  | Misc_split (_, [], _) = raise Match

fun Misc_isSubstring "" _ = true
  | Misc_isSubstring part s = String.isSubstring part s

fun Misc_basename path =
  let
    fun last ([], found) = String.implode (List.rev found)
      | last ([#"/"], found) = String.implode (List.rev found)
      | last (#"/" :: rest, _) = last (rest, [])
      | last (c :: rest, found) = last (rest, c :: found)
  in
    last (String.explode path, [])
  end

fun Misc_time_of_day () = 0.0
