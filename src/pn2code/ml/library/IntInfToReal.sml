exception IntInfToRealExn
fun IntInfToReal decimals n =
    if decimals < 0 then raise IntInfToRealExn else Real.fromLargeInt n / Math.pow (10.0, real decimals)
