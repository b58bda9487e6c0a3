(* Properties that are put on values; a holder has those of one. Each property has a number, which tells of what type it is. *)
structure PropList = struct
    type holder = (int * exn) list ref

    val made = ref 0
    fun newNumber () = (made := !made + 1; !made)
    fun newHolder () : holder = ref nil
    fun hasProps (holder : holder) = not (List.null (!holder))
    fun clearHolder (holder : holder) = holder := nil
    fun sameHolder (a : holder, b : holder) = a = b
    fun without (number : int, holder : holder) = List.filter (fn (n, _) => n <> number) (!holder)
    fun newProp (holderOf : 'b -> holder, first : 'b -> 'a) =
        let exception Property of 'a
            val number = newNumber ()
            fun own nil = NONE
              | own ((n, e) :: rest) = if n <> number then own rest else case e of Property x => SOME x | _ => own rest
            fun peekFn at = own (!(holderOf at))
            fun clrFn at = let val holder = holderOf at in holder := without (number, holder) end
            fun setFn (at, x) = let val holder = holderOf at in holder := (number, Property x) :: without (number, holder) end
            fun getFn at = case peekFn at of SOME x => x | NONE => let val x = first at in setFn (at, x); x end
        in {peekFn = peekFn, getFn = getFn, setFn = setFn, clrFn = clrFn} end
    fun newFlag (holderOf : 'a -> holder) =
        let val number = newNumber ()
            fun getFn at = List.exists (fn (n, _) => n = number) (!(holderOf at))
            fun setFn (at, x) =
                let val holder = holderOf at
                    val others = without (number, holder)
                in holder := (if x then (number, Fail "") :: others else others) end
        in {getFn = getFn, setFn = setFn} end
end
