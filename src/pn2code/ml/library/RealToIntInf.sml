exception RealToIntInfExn
fun RealToIntInf decimals x =
    if decimals < 0 then raise RealToIntInfExn
    else Real.toLargeInt IEEEReal.TO_NEAREST (x * Math.pow (10.0, real decimals))
