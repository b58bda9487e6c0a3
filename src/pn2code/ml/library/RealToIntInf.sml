exception RealToIntInfExn
fun RealToIntInf decimals x =
    if decimals < 0 then raise RealToIntInfExn
    else if not (Real.isFinite x) then raise InternalError "Internal error in RealToIntInf"
    else
        let val text = Real.fmt (StringCvt.FIX (SOME decimals)) x
        in valOf (IntInf.fromString (String.translate (fn c => if c = #"." then "" else str c) text))
        end
