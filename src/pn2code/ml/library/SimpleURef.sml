(* References that can be made one, without ranks. *)
structure SimpleURef = struct
    datatype 'a urefC = ECR of 'a | PTR of 'a urefC ref
    type 'a uref = 'a urefC ref

    fun uRef x = ref (ECR x)
    fun found p =
        case !p of
            ECR _ => p
          | PTR next => let val last = found next in (p := PTR last; last) end
    fun !! p = case !(found p) of ECR x => x | PTR next => !! next
    fun equal (p, q) = found p = found q
    fun update (p, x) = found p := ECR x
    fun link (p, q) =
        let val (p, q) = (found p, found q) in if p = q then false else (p := PTR q; true) end
    fun union (p, q) = link (p, q)
    fun unify f (p, q) =
        let val x = f (!! p, !! q)
            val joined = link (p, q)
        in update (q, x); joined end
end
