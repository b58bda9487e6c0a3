fun ListPair_zip (xs, ys) =
    let fun loop (x :: xs, y :: ys, out) = loop (xs, ys, (x, y) :: out)
          | loop (_, _, out) = rev out
    in loop (xs, ys, nil) end

fun ListPair_unzip pairs =
    let fun loop (nil, xs, ys) = (rev xs, rev ys)
          | loop ((x, y) :: rest, xs, ys) = loop (rest, x :: xs, y :: ys)
    in loop (pairs, nil, nil) end

fun ListPair_map f (xs, ys) =
    let fun loop (x :: xs, y :: ys, out) = loop (xs, ys, f (x, y) :: out)
          | loop (_, _, out) = rev out
    in loop (xs, ys, nil) end

fun ListPair_app f (x :: xs, y :: ys) = (f (x, y); ListPair_app f (xs, ys))
  | ListPair_app f _ = ()

fun ListPair_all p (x :: xs, y :: ys) = if p (x, y) then ListPair_all p (xs, ys) else false
  | ListPair_all p _ = true

fun ListPair_exists p (x :: xs, y :: ys) = if p (x, y) then true else ListPair_exists p (xs, ys)
  | ListPair_exists p _ = false

fun ListPair_foldl f z (x :: xs, y :: ys) = ListPair_foldl f (f (x, y, z)) (xs, ys)
  | ListPair_foldl f z _ = z

fun ListPair_foldr f z (xs, ys) =
    let fun pairs (x :: xs, y :: ys, out) = pairs (xs, ys, (x, y) :: out)
          | pairs (_, _, out) = out
        fun fold (nil, z) = z
          | fold ((x, y) :: rest, z) = fold (rest, f (x, y, z))
    in fold (pairs (xs, ys, nil), z) end

fun unequal (nil, nil) = false
  | unequal (_ :: xs, _ :: ys) = unequal (xs, ys)
  | unequal _ = true

fun ListPair_zipEq pair = if unequal pair then raise ListPair.UnequalLengths else ListPair_zip pair

fun ListPair_mapEq f (xs, ys) =
    let fun loop (x :: xs, y :: ys, out) = loop (xs, ys, f (x, y) :: out)
          | loop (nil, nil, out) = rev out
          | loop _ = raise ListPair.UnequalLengths
    in loop (xs, ys, nil) end

fun ListPair_appEq f (x :: xs, y :: ys) = (f (x, y); ListPair_appEq f (xs, ys))
  | ListPair_appEq f (nil, nil) = ()
  | ListPair_appEq f _ = raise ListPair.UnequalLengths

fun ListPair_allEq p (x :: xs, y :: ys) = if p (x, y) then ListPair_allEq p (xs, ys) else false
  | ListPair_allEq p (nil, nil) = true
  | ListPair_allEq p _ = false

fun ListPair_foldlEq f z (x :: xs, y :: ys) = ListPair_foldlEq f (f (x, y, z)) (xs, ys)
  | ListPair_foldlEq f z (nil, nil) = z
  | ListPair_foldlEq f z _ = raise ListPair.UnequalLengths

fun ListPair_foldrEq f z pair =
    if unequal pair then raise ListPair.UnequalLengths else ListPair_foldr f z pair
