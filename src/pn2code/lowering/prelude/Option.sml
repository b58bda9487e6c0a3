fun Option_mapPartial f NONE = NONE
  | Option_mapPartial f (SOME x) = f x

fun Option_filter p x = if p x then SOME x else NONE

fun Option_join (SOME x) = x
  | Option_join NONE = NONE

fun Option_app f NONE = ()
  | Option_app f (SOME x) = f x

fun Option_compose (f, g) x = case g x of SOME y => SOME (f y) | NONE => NONE

fun Option_composePartial (f, g) x = case g x of SOME y => f y | NONE => NONE
