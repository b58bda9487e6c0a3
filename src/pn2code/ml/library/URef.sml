(* References that can be made one. *)
structure URef = struct
    datatype 'a urefC = ECR of 'a * int | PTR of 'a urefC ref
    type 'a uref = 'a urefC ref

    fun uRef x = ref (ECR (x, 0))
    fun found p =
        case !p of
            ECR _ => p
          | PTR next => let val last = found next in (p := PTR last; last) end
    fun !! p = case !(found p) of ECR (x, _) => x | PTR next => !! next
    fun equal (p, q) = found p = found q
    fun update (p, x) =
        case found p of last => case !last of ECR (_, rank) => last := ECR (x, rank) | PTR _ => ()
    fun link (p, q) =
        let val (p, q) = (found p, found q) in if p = q then false else (p := PTR q; true) end
    fun joined (p, q, x) =
        case (!p, !q) of
            (ECR (_, r), ECR (_, s)) =>
            if r = s then (q := ECR (x, s + 1); p := PTR q)
            else if r < s then (q := ECR (x, s); p := PTR q)
            else (p := ECR (x, r); q := PTR p)
          | _ => ()
    fun unify f (p, q) =
        let val (a, b) = (found p, found q)
        in if a = b then false else (joined (a, b, f (!! a, !! b)); true) end
    fun union (p, q) =
        let val (a, b) = (found p, found q)
        in if a = b then false else (joined (a, b, !! b); true) end
end
