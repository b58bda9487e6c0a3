(* Values that are computed when they are first needed. *)
structure SMLofNJ = struct
    open SMLofNJ

    structure Susp = struct
        datatype 'a state = Delayed of unit -> 'a | Done of 'a
        datatype 'a susp = Susp of 'a state ref

        fun delay f = Susp (ref (Delayed f))
        fun force (Susp state) =
            case !state of
                Done x => x
              | Delayed f => let val x = f () in (state := Done x; x) end
    end
end
