(* Trees whose root is what was looked for last. *)
structure SplayTree = struct
    datatype 'a splay = SplayNil | SplayObj of {value : 'a, right : 'a splay, left : 'a splay}

    fun tree (left, value, right) = SplayObj {value = value, right = right, left = left}
    fun splay (side, root) =
        let (* How the new root compares, and its parts. *)
            fun turned (left, x, right, c) =
                case (c, left, right) of
                    (EQUAL, _, _) => (EQUAL, x, left, right)
                  | (GREATER, SplayObj {value, left = inner, right = between}, _) =>
                    lifted (inner, value, between, x, right)
                  | (LESS, _, SplayObj {value, left = between, right = inner}) =>
                    raised (left, x, between, value, inner)
                  | _ => (c, x, left, right)
            (* From the left of x. *)
            and lifted (a, y, b, x, right) =
                case (side y, a, b) of
                    (GREATER, SplayObj {value, left, right = r}, _) =>
                    let val (c, z, l, r) = turned (left, value, r, side value)
                    in (c, z, l, tree (r, y, tree (b, x, right))) end
                  | (LESS, _, SplayObj {value, left, right = r}) =>
                    let val (c, z, l, r) = turned (left, value, r, side value)
                    in (c, z, tree (a, y, l), tree (r, x, right)) end
                  | (c, _, _) => (c, y, a, tree (b, x, right))
            (* From the right of x. *)
            and raised (left, x, a, y, b) =
                case (side y, a, b) of
                    (LESS, _, SplayObj {value, left = l, right}) =>
                    let val (c, z, l, r) = turned (l, value, right, side value)
                    in (c, z, tree (tree (left, x, a), y, l), r) end
                  | (GREATER, SplayObj {value, left = l, right}, _) =>
                    let val (c, z, l, r) = turned (l, value, right, side value)
                    in (c, z, tree (left, x, l), tree (r, y, b)) end
                  | (c, _, _) => (c, y, tree (left, x, a), b)
        in
            case root of
                SplayNil => (GREATER, SplayNil)
              | SplayObj {value, left, right} =>
                let val (c, x, l, r) = turned (left, value, right, side value) in (c, tree (l, x, r)) end
        end
    fun join (SplayNil, right) = right
      | join (left, SplayNil) = left
      | join (SplayObj {value, left, right = SplayNil}, right) = tree (left, value, right)
      | join (SplayObj {value, left, right = SplayObj {value = next, left = between, right = inner}}, right) =
        join (tree (tree (left, value, between), next, inner), right)
end
