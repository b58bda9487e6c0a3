(* As SML/NJ gives it: of most exceptions only the name. *)
fun General_exnMessage e =
    case e of
        Bind => "nonexhaustive binding failure"
      | Match => "nonexhaustive match failure"
      | Div => "divide by zero"
      | Overflow => "overflow"
      | Subscript => "subscript out of bounds"
      | Size => "size"
      | Domain => "domain error"
      | Fail text => "Fail: " ^ text
      | CPN'Error text => text
      | IO.Io {name, function, cause} => "Io: " ^ function ^ " failed on \"" ^ name ^ "\", " ^ reason cause
      | OS.SysErr _ => "SysErr: " ^ reason e
      | _ => exnName e
and reason e = case e of OS.SysErr (text, _) => text | _ => General_exnMessage e
